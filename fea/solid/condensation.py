"""A link's solid condensed to the places where forces enter it: what a frame needs of it as an element.

Static condensation (Guyan, AIAA Journal 3 (1965) 380): the displacements within the link follow from the forces at its
places, which are its bores and the patches of its load points. Kept is the flexibility between them
(``alula.fea.solid.bore_motion``), which a frame of natural forces takes as it is; a stiffness would be its
pseudo-inverse. Weight and other spread loads move the places too, by their work on the unit displacements.

A pin presses on one side of its bore, while the wrenches of the flexibility act all round. What this adds to the motion
of a pin along its force, and how far the pin sinks beyond the bore's mean motion, goes with the size of the force and
with its direction; both are tabulated over directions, for both pressures.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.space import DisplacementSpace
from alula.fea.solid.bore_motion import condensed
from alula.fea.tractions.link_tractions import SPREAD, LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.geometry.keeping.kept import kept
from alula.geometry.parts.part import Body
from alula.loads.records.applied import shifted
from alula.loads.records.bearing import NARROW, WIDE

Real = NDArray[np.float64]
DIRECTIONS = 12
"""In which the pressure of a pin is solved; between them its give is interpolated."""


@dataclass(frozen=True, kw_only=True)
class Give:
    """How far a pin moves along a unit force, beyond what the flexibility tells.

    Attributes
    ----------
    value : float
        With its bore's mean motion under the pressure over 180° [mm/N].
    narrow : float
        The same under that over 90° [mm/N].
    sunk : float
        For a pin that sinks into its bore, the most under either pressure [mm/N].
    """

    value: float
    narrow: float
    sunk: float


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedSolid:
    """A link's solid on one mesh, condensed to p places.

    Attributes
    ----------
    space : DisplacementSpace
        Of the mesh.
    E, nu : float
        Young's modulus [MPa] and Poisson's ratio.
    places : tuple of str
        Names of the points where forces enter, pins first.
    flexibility : ndarray, shape (6 p, 6 p)
        From wrenches that balance to motions of the places, in the link's axes; rigid motions are its null space.
    moved : mapping of str to ndarray
        Load case -> motions (6 p,) of the places under its spread loads, balanced at the places; cases without any are
        left out.
    displacement : ndarray, shape (3n, 6 p)
        Of the nodes, under unit wrenches at the places [mm].
    spread : mapping of str to ndarray
        Load case -> displacement (3n,) of the nodes under its spread loads [mm].
    gives : mapping of str to ndarray
        Pin -> (4, DIRECTIONS) how far it moves along a unit force in each direction of the plane, beyond the
        flexibility: mean motion and sunk under the pressure over 180°, then over 90° [mm/N].
    """

    space: DisplacementSpace
    E: float
    nu: float
    places: tuple[str, ...]
    flexibility: Real
    moved: Mapping[str, Real]
    displacement: Real
    spread: Mapping[str, Real]
    gives: Mapping[str, Real]

    def give(self, pin: str, force: Real) -> Give:
        """Return how far a pin moves along its force beyond what the flexibility tells.

        Parameters
        ----------
        pin : str
            Its name.
        force : ndarray, shape (2,)
            In the link's axes; its direction counts.

        Returns
        -------
        Give
        """
        at = math.atan2(force[1], force[0]) / (2.0 * math.pi) * DIRECTIONS
        first, share = math.floor(at) % DIRECTIONS, at - math.floor(at)
        table = self.gives[pin]
        found = (1.0 - share) * table[:, first] + share * table[:, (first + 1) % DIRECTIONS]
        return Give(value=float(found[0]), narrow=float(found[2]), sunk=float(found.max()))

    def under(self, wrenches: Real, load_case: str) -> Real:
        """Return the displacement of the nodes under wrenches at the places that balance a load case's spread loads.

        Parameters
        ----------
        wrenches : ndarray, shape (6 p,)
            In the link's axes [N, N mm].
        load_case : str
            Its name.

        Returns
        -------
        ndarray, shape (n, 3)
            Displacements [mm].
        """
        found = self.displacement @ wrenches + self.spread.get(load_case, 0.0)
        return np.asarray(found.reshape(-1, 3))


@kept(but=("threads",))
def condense(
    space: DisplacementSpace,
    body: Body,
    loads: Sequence[LinkLoads],
    *,
    E: float,
    nu: float,
    density: float,
    threads: int | None = None,
) -> CondensedSolid:
    """Condense a link's solid to its pins and load points.

    Parameters
    ----------
    space : DisplacementSpace
        On its mesh.
    body : Body
        Geometry of the link.
    loads : sequence of LinkLoads
        One per load case; of these the spread loads count.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    density : float
        Of the material [tonne/mm³].
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    CondensedSolid
    """
    points = {pin.name: np.array([pin.x, pin.y, 0.0]) for pin in body.pins}
    places = {f"bore:{name}": point for name, point in points.items()}
    places |= {f"end:{end.name}": np.array([end.x, end.y, 0.0]) for end in body.ends}
    spread = {case.name: case for case in loads if case.lines or case.inertia is not None}
    poses = [case.chosen(None) for case in spread.values()]
    tractions = LinkTractions.of(space, poses, density=density, kinds=SPREAD)
    columns = [np.zeros((space.unknowns, 0)), *(tractions.exact(pose) for pose in poses)]
    angles = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    along = np.column_stack([np.cos(angles), np.sin(angles), np.zeros((DIRECTIONS, 4))])
    for pin in body.pins:
        centre = np.tile(points[pin.name], (DIRECTIONS, 1))
        around = PinLoad(name=pin.name, centre=centre, diameter=pin.diameter, wrench=along)
        pushed = LinkLoads(name=pin.name, pins=(around,))
        press = LinkTractions.of(space, [pushed], density=density, kinds=(PinPressure,))
        columns += [press.exact(pushed, law) for law in (WIDE, NARROW)]
    extra = np.hstack(columns)
    work, moved = condensed(space, places, extra, E=E, nu=nu, threads=threads)
    p, own = 6 * len(places), 6 * len(places) + len(spread)
    gives = {}
    for k, pin in enumerate(body.pins):
        unit = np.zeros((p, DIRECTIONS))
        unit[6 * k : 6 * k + 6] = along.T
        table = []
        for number in range(2):
            at = own + (2 * k + number) * DIRECTIONS + np.arange(DIRECTIONS)
            # What pressure and dual wrench differ by balances at the bore alone, and moves it beside the others.
            beyond = work[:p, at] - work[:p, :p] @ unit
            mean = np.einsum("id,id->d", _against(list(places.values()), k, along), beyond)
            sunk = np.diagonal(work[np.ix_(at, at)] - unit.T @ work[:p, at]) - np.einsum("id,id->d", unit, beyond)
            table += [mean, 2.0 * mean + sunk]
        gives[pin.name] = np.array(table)
    return CondensedSolid(
        space=space,
        E=E,
        nu=nu,
        places=tuple(name.partition(":")[2] for name in places),
        flexibility=work[:p, :p],
        moved={name: work[:p, p + i] for i, name in enumerate(spread)},
        displacement=moved[:, :p],
        spread={name: moved[:, p + i] for i, name in enumerate(spread)},
        gives=gives,
    )


def _against(points: Sequence[Real], own: int, wrenches: Real) -> Real:
    """Return wrenches (6 p, k) that balance: those (k, 6) at a place, and their opposite at the farthest other one."""
    other = max(range(len(points)), key=lambda i: float(np.linalg.norm(points[i] - points[own])))
    found = np.zeros((6 * len(points), len(wrenches)))
    found[6 * own : 6 * own + 6] = wrenches.T
    found[6 * other : 6 * other + 6] -= shifted(wrenches, points[own] - points[other]).T
    return found
