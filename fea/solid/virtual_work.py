"""The work of virtual forces on the displacements of a link's solid: what the link adds to how far a point moves.

Where equilibrium gives the joint forces, a point of a linkage moves along a unit load there by the sum, over all links,
of the work that the unit load's forces do on the links' own deformation (the unit-load method; Budynas & Nisbett,
Shigley's Mechanical Engineering Design, 10th ed., section 4-8). They enter a link at its pins, whose motions are those
of their bores (``alula.fea.solid.bore_motion``) in the solution under the real loads, whatever these are. They balance
on each link, so that rigid motions of the solution do no work.

The motion of a pin is the mean motion of its bore. A stiff pin follows the side on which it presses, and so sinks into
the bore beyond that: along its force F by s, with F s + F · (mean motion) the work of its own pressure. What this could
add is told apart, each pin at its worst. The torque that holds a link does work on what it enters through: the flat
faces of an eye, or the bore.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.link_loads import EndLoad, LinkLoads
from alula.fea.elements.mouth import mouth_motion
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.fea.solid.bore_motion import mean_motion, work
from alula.fea.solid.solution import SolidSolution
from alula.fea.tractions.slot_traction import DEGREE, slot_traction
from alula.fea.tractions.traction import Transfer, couple_traction, pin_traction
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw, Span

Real = NDArray[np.float64]

LAWS: dict[Span, PressureLaw] = {law.span: law for law in (WIDE, NARROW)}
NO_FORCE = 1e-9
"""Share of the largest pin force on a link below which a pin does not press: its direction is rounding."""


@dataclass(frozen=True, kw_only=True)
class Work:
    """Work of virtual loads on a link's solid under real ones [N mm].

    Attributes
    ----------
    mean : Band
        For pins that move as the mean of their bores: under the pressure over 180°, and the ends under all variants.
    sunk : Band
        The same with all that pins may sink into their bores in its ends.
    missing : float
        What the mesh leaves open on either side.
    """

    mean: Band
    sunk: Band
    missing: float

    def band(self, *, meshes: float = 1.0, sunk: bool = False) -> Band:
        """Return the work with a share of what the mesh leaves open.

        Parameters
        ----------
        meshes : float, optional
            That share.
        sunk : bool, optional
            Whether pins may sink.

        Returns
        -------
        Band
        """
        found, missing = self.sunk if sunk else self.mean, meshes * self.missing
        return replace(found, low=found.low - missing, high=found.high + missing)


def virtual_work(
    solution: SolidSolution, real: LinkLoads, virtual: Sequence[LinkLoads], *, transfer: Transfer, error: float
) -> tuple[Work, ...]:
    """Return the work of virtual loads on a link's solid under real ones, over all variants of the solution.

    Parameters
    ----------
    solution : SolidSolution
        With cases of the real loads' name.
    real : LinkLoads
        Loads that the solid was solved for.
    virtual : sequence of LinkLoads
        Each a set that balances, at pins, ends and as drive torque.
    transfer : Transfer
        Of torques, by which the value goes.
    error : float
        Relative, of displacements: what the mesh leaves open of every component of every pin's motion.

    Returns
    -------
    tuple of Work
        One per set of virtual loads.
    """
    surfaces = _Surfaces(solution.space, real, {end.name: end for loads in virtual for end in loads.ends})
    found: list[tuple[Span, Transfer, list[tuple[Real, Real]]]] = []
    for case in (case for case in solution.cases if case.load == real.name):
        for way in (case.transfer,) if case.transfer else get_args(Transfer):
            law = LAWS[case.span]
            mean = surfaces.mean(case.displacement, way, law)
            sunk = surfaces.sunk(case.displacement, mean, law)
            found.append((case.span, way, [(_work(loads, mean), _work(loads, sunk)) for loads in virtual]))
    _, _, chosen = min(found, key=lambda one: (one[0] != WIDE.span, one[1] != transfer))
    every = zip(*(terms for _, _, terms in found), strict=True)
    return tuple(_band(float(own.sum()), terms, error) for (own, _), terms in zip(chosen, every, strict=True))


def _band(value: float, variants: Sequence[tuple[Real, Real]], error: float) -> Work:
    """Work over variants: terms (places, 6) of mean motions, and of sinking, of which each place has all or nothing."""
    sums = np.array([terms.sum() for terms, _ in variants])
    deep = [sinking.sum(axis=1) for _, sinking in variants]
    lower = sums + [np.minimum(depth, 0.0).sum() for depth in deep]
    upper = sums + [np.maximum(depth, 0.0).sum() for depth in deep]
    return Work(
        mean=Band(value=value, low=float(sums.min()), high=float(sums.max())),
        sunk=Band(value=value, low=float(lower.min()), high=float(upper.max())),
        missing=error * max(float(np.abs(terms).sum()) for terms, _ in variants),
    )


def _work(loads: LinkLoads, motion: Mapping[str, Real]) -> Real:
    """Work (places, 6) of virtual loads on the motions (6,) of the places where they enter, component by component."""
    wrenches = {name: np.zeros(6) for name in motion}
    for pin in loads.pins:
        wrenches[pin.name] += pin.wrench
    for end in loads.ends:
        wrenches[end.name] += end.wrench
    for couple in loads.couples:
        wrenches[couple.pin][5] += couple.torque
    return np.array([wrenches[name] * moved for name, moved in motion.items()])


class _Surfaces:
    """The surfaces through which loads enter a link; each is integrated once."""

    def __init__(self, space: DisplacementSpace, real: LinkLoads, ends: Mapping[str, EndLoad]) -> None:
        self._pins, self._ends = real.pins, ends
        self._largest = max((float(np.linalg.norm(pin.wrench[:3])) for pin in real.pins), default=0.0)
        self._bores = {
            pin.name: surface_quadrature(space, f"bore:{pin.name}", degree=DEGREE if pin.slotted else 8)
            for pin in real.pins
        }
        self._patches = {name: surface_quadrature(space, f"end:{name}") for name in ends}
        self._faces = {
            name: surface_quadrature(space, *space.flat_faces(name)) if space.flat_faces(name) else bore
            for name, bore in self._bores.items()
        }

    def mean(self, field: Real, transfer: Transfer, law: PressureLaw) -> dict[str, Real]:
        """Mean motion (6,) of every place; torque turns what it enters through, and a slot gives where its pin pushes.

        A pin in a slot moves across it alone, as the work of its own pressure says: the wall as a whole bends.
        """
        found = {}
        for name, patch in self._patches.items():
            moved = mouth_motion if self._ends[name].clamped else mean_motion
            found[name] = moved(patch, self._ends[name].point, field)
        for pin in self._pins:
            bore = self._bores[pin.name]
            if pin.slotted:
                side = 1.0 if pin.wrench[1] >= 0.0 else -1.0
                push = replace(pin, wrench=np.array([0.0, side, 0.0, 0.0, 0.0, 0.0]))
                across = side * work(bore, slot_traction(bore, push, law), field)
                found[pin.name] = np.array([0.0, across, 0.0, 0.0, 0.0, 0.0])
            else:
                through = self._faces[pin.name] if transfer == "eye-faces" else bore
                found[pin.name] = mean_motion(bore, pin.centre, field)
                found[pin.name][5] = work(through, couple_traction(through, pin.centre, 1.0), field)
        return found

    def sunk(self, field: Real, mean: Mapping[str, Real], law: PressureLaw) -> dict[str, Real]:
        """How far (6,) every pin sinks into its bore along its force, beyond the bore's mean motion."""
        found = {name: np.zeros(6) for name in mean}
        for pin in self._pins:
            size = float(np.hypot(*pin.wrench[:2]))
            if not pin.slotted and size > NO_FORCE * self._largest:
                along = np.array([*pin.wrench[:2] / size, 0.0, 0.0, 0.0, 0.0])
                bore = self._bores[pin.name]
                pressed = work(bore, pin_traction(bore, replace(pin, wrench=along, seat=None), law), field)
                found[pin.name] = (pressed - float(along @ mean[pin.name])) * along
        return found
