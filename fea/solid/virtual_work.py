"""The work of virtual forces on the displacements of a link's solid: what the link adds to how far a point moves.

Where equilibrium gives the joint forces, a point of a linkage moves along a unit load there by the sum, over all links,
of the work that the unit load's forces do on the links' own deformation (the unit-load method; Budynas & Nisbett,
Shigley's Mechanical Engineering Design, 10th ed., section 4-8). They enter a link at its pins, whose motions are those
of their bores (``fea.solid.bore_motion``) in the solution under the real loads, whatever these are. They balance on
each link, so that rigid motions of the solution do no work.

A pin that fits closely moves as its bore does on average. One with clearance follows the side on which it presses, and
so sinks into the bore beyond that: along its force F by s, with F s + F · (mean motion) the work of its own pressure.
Every pin counts as either, at its worst. The torque that holds a link does work on what it enters through: the flat
faces of an eye, or the bore.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.link_loads import LinkLoads
from fea.elements.quadrature import surface_quadrature
from fea.elements.space import DisplacementSpace
from fea.solid.bore_motion import mean_motion, work
from fea.solid.solution import SolidSolution
from fea.tractions.slot_traction import DEGREE, slot_traction
from fea.tractions.traction import Transfer, couple_traction, pin_traction
from loads.records.bearing import NARROW, WIDE, PressureLaw, Span

Real = NDArray[np.float64]

LAWS: dict[Span, PressureLaw] = {law.span: law for law in (WIDE, NARROW)}
NO_FORCE = 1e-9
"""Share of the largest pin force on a link below which a pin does not press: its direction is rounding."""


def virtual_work(
    solution: SolidSolution, real: LinkLoads, virtual: Sequence[LinkLoads], *, transfer: Transfer, error: float
) -> tuple[Band, ...]:
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
        Relative, of displacements: what the mesh leaves open.

    Returns
    -------
    tuple of Band
        One per set of virtual loads [N mm]: the value for mean motions under the pressure over 180°; the ends with the
        error, for pins that sink or do not, under all variants.
    """
    surfaces = _Surfaces(solution.space, real, {end.name: end.point for loads in virtual for end in loads.ends})
    found: list[tuple[Span, Transfer, list[Band]]] = []
    for case in (case for case in solution.cases if case.load == real.name):
        for way in (case.transfer,) if case.transfer else get_args(Transfer):
            law = LAWS[case.span]
            mean = surfaces.mean(case.displacement, way, law)
            sunk = surfaces.sunk(case.displacement, mean, law)
            found.append((case.span, way, [_band(_work(loads, mean), _work(loads, sunk), error) for loads in virtual]))
    _, _, chosen = min(found, key=lambda one: (one[0] != WIDE.span, one[1] != transfer))
    return tuple(
        Band(value=band.value, low=min(other.low for other in every), high=max(other.high for other in every))
        for band, every in zip(chosen, zip(*(bands for *_, bands in found), strict=True), strict=True)
    )


def _band(terms: Real, sinking: Real, error: float) -> Band:
    """Band of a sum of terms (places, 6), each within a relative error, where any of the places may sink or not."""
    total, open_by = float(terms.sum()), error * float(np.abs(terms).sum() + np.abs(sinking).sum())
    deep = sinking.sum(axis=1)
    low, high = float(np.minimum(deep, 0.0).sum()), float(np.maximum(deep, 0.0).sum())
    return Band(value=total, low=total + low - open_by, high=total + high + open_by)


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

    def __init__(self, space: DisplacementSpace, real: LinkLoads, ends: Mapping[str, Real]) -> None:
        self._pins, self._ends = real.pins, ends
        self._largest = max(float(np.linalg.norm(pin.wrench[:3])) for pin in real.pins)
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
        found = {name: mean_motion(patch, self._ends[name], field) for name, patch in self._patches.items()}
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
                pressed = work(bore, pin_traction(bore, replace(pin, wrench=along), law), field)
                found[pin.name] = (pressed - float(along @ mean[pin.name])) * along
        return found
