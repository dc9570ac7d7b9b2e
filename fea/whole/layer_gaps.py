"""Whether deflection and tilting pins close the gap between links that pass over each other.

Links of different layers keep a gap along the pins. Under load they bend and twist across the plane, and with play
their pins tilt in their holes. Where two outlines lie over each other in the pose, the gap at every corner of what they
share is reduced by how far the lower link rises there against the upper one: by the linear frame of beams, in the band
of its flexibility, of the load, the moduli, air and friction, and by the play at all rims at its worst
(``alula.fea.outcomes.free_motion``), for links that do not bend by it. Pins of which nothing is stated run.
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import distinct, play_source
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.frame.displacement_band import compliance_range
from alula.fea.frame.linear import FrameSolution
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import NodeLoad
from alula.fea.nonlinear.large_displacement import LargeDisplacement, stated_scatter
from alula.fea.nonlinear.stability import ON_RIMS
from alula.fea.outcomes.free_motion import rim_forces
from alula.fea.pins.clearances import apart_at_rims, furthest, loose_holes
from alula.geometry.clearance.shape import TOUCHING
from alula.loads.case.case import Case
from alula.loads.case.joint_rules import clearances
from alula.loads.records.check_spec import ClearanceCheck
from alula.loads.states.clearance import Assembly

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Overlap:
    """Where two links of different layers lie over each other.

    Attributes
    ----------
    lower, upper : str
        The links.
    gap : float
        Between them along the pins [mm].
    places : ndarray, shape (n, 2)
        Corners of what they share as seen along the pins, global axes [mm].
    """

    lower: str
    upper: str
    gap: float
    places: Real


def overlaps(frame: LinkageFrame, assembly: Assembly) -> Iterator[Overlap]:
    """Yield where links of different layers lie over each other in a pose.

    Parameters
    ----------
    frame : LinkageFrame
        In the pose.
    assembly : Assembly
        With the links' outlines.

    Yields
    ------
    Overlap
        For every two pieces of two links, but for links on one slider, bonded ones, and faces that touch as they are.
    """
    import shapely

    pose = frame.pose
    together = {frozenset(joint.links) for joint in pose.linkage.joints.values() if joint.bears_moment}
    placed = {
        link: [
            (core, shapely.transform(core.polygon, lambda xy, at=link: xy @ pose.rotation(at).T + pose.origins[at]))
            for core in shape.cores
        ]
        for link, shape in assembly.links.items()
    }
    for one, other in itertools.permutations(placed, 2):
        for core, outline in placed[one] if frozenset((one, other)) not in together else ():
            for upper, over in placed[other]:
                gap = upper.low - core.high
                common = outline.intersection(over) if gap > TOUCHING * (core.high - core.low) else None
                if common is not None and common.area > 0.0:
                    yield Overlap(lower=one, upper=other, gap=gap, places=shapely.get_coordinates(common))


@dataclass(frozen=True, kw_only=True, eq=False)
class Raised:
    """How far places of links move across the plane by the linear frame.

    Attributes
    ----------
    frame : LinkageFrame
    solution : FrameSolution
        Of it.
    """

    frame: LinkageFrame
    solution: FrameSolution

    def at(self, link: str, places: Real) -> Real:
        """Return the displacement of places of a link along z.

        Between the stations of a beam its axis is the cubic that their displacements and slopes give; the section turns
        with the twist between them.

        Parameters
        ----------
        link : str
            A link whose beam the frame has; another one stands still.
        places : ndarray, shape (n, 2)
            Global axes [mm].

        Returns
        -------
        ndarray, shape (n,)
            [mm]
        """
        if link not in self.frame.stations:
            return np.zeros(len(places))
        pose, stations = self.frame.pose, self.frame.stations[link]
        x, y = ((places - pose.origins[link]) @ pose.rotation(link)).T
        at, nodes = np.array([station[0] for station in stations]), [node for _, node in stations]
        moved = self.solution.displacements[nodes]
        arms = np.array([self.frame.arms.get(node, np.zeros(3)) for node in nodes])
        axis = moved[:, 2] + np.cross(moved[:, 3:], arms)[:, 2]
        twist, tilt = (moved[:, 3:5] @ pose.rotation(link)).T
        inside = np.clip(x, at[0], at[-1])
        along = np.interp(inside, at, -tilt)
        return np.asarray(_cubic(inside, at, axis, -tilt) + (x - inside) * along + np.interp(x, at, twist) * y)


def _cubic(x: Real, at: Real, values: Real, slopes: Real) -> Real:
    """Return the cubics between stations that have their values and slopes, as ``CubicHermiteSpline`` of SciPy does.

    Its module takes longer to import than a frame to solve.
    """
    i = np.clip(np.searchsorted(at, x, side="right") - 1, 0, len(at) - 2)
    sizes = np.diff(at)
    rises = np.diff(values) / sizes
    third = (slopes[:-1] + slopes[1:] - 2.0 * rises) / sizes
    second, third = (rises - slopes[:-1]) / sizes - third, third / sizes
    s = x - at[i]
    return np.asarray(values[i] + slopes[i] * s + second[i] * (s * s) + third[i] * (s * s * s))


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerGap:
    """The gap that is left between two links, at the place where its low end is least.

    Attributes
    ----------
    names : tuple of str
        The lower link and the upper one.
    gap : float
        Between them without load [mm].
    left : Band
        What is left of it [mm].
    place : tuple of float
        (x, y) in global axes [mm].
    """

    names: tuple[str, str]
    gap: float
    left: Band
    place: tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerGaps:
    """The gaps between the layers of a linkage under a load case.

    Attributes
    ----------
    case : Case
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it; its frame is in small displacements.
    assembly : Assembly
        With the links' outlines.
    """

    case: Case
    load_case: str
    moved: LargeDisplacement
    assembly: Assembly

    @cached_property
    def least(self) -> LayerGap | None:
        """The gap of which least is left, by the low end of its band; None where no link passes over another."""
        loose, causes = clearances(self.case), self.moved.of_loads
        pins = (play_source(loose),) if loose else (ON_RIMS,) if self._run else ()
        told = (*(cause.source for cause in causes), *pins)
        sources = distinct(self._soft.sources, told)
        found = []
        for over, closed, freed in zip(self._overlaps, self._closed, self._freed, strict=True):
            free = freed.sum(axis=0)
            least, most = closed.min(axis=0), closed.max(axis=0)
            k = int(np.argmax(most + free))
            left = Band(
                value=over.gap - float(closed[0, k]),
                low=-math.inf if any(cause.endless for cause in causes) else over.gap - float(most[k] + free[k]),
                high=over.gap - float(least[k] - free[k]),
                sources=sources,
            )
            place = float(over.places[k, 0]), float(over.places[k, 1])
            found.append(LayerGap(names=(over.lower, over.upper), gap=over.gap, left=left, place=place))
        return min(found, key=lambda one: one.left.low, default=None)

    @property
    def remedy(self) -> Reason | str | None:
        """What keeps all gaps open, as tried: less play of one joint, else of all, and heads; None where nothing does.

        Where deflection alone may close a gap, that is told.
        """
        frame, joints = self.moved.frame, tuple(self.case.joints)
        loose = clearances(self.case)
        if frame is None or not self._run or any(cause.endless for cause in self.moved.of_loads):
            return None
        free = self._freed
        if min(float(left.min()) for left, _ in self._beside(free)) < 0.0:
            return reason("deflection_closes_gap")
        if not loose:  # nothing is stated, or play in the plane is not followed
            holes = [hole for name in joints for hole in self.case.linkage.pin_holes(name).holes]
            return None if all(hole.stated for hole in holes) else reason("state_fits")
        alone = {
            name: self._share([np.delete(each, i, axis=0) for each in free], [each[i] for each in free])
            for i, name in enumerate(joints)
            if name in loose
        }
        name = max(alone, key=lambda one: alone[one])
        rows = np.array([alone[name] if one == name else 1.0 for one in joints])
        if not alone[name] > 0.0:
            every = self._share([each[:0] for each in free], [each.sum(axis=0) for each in free])
            name, rows = "", np.full(len(joints), every)
        share = float(rows.min())
        less = share > 0.0 and self._opens([self._free(over, rows) for over in self._overlaps])
        held = not name and self._opens([self._free(over, held=True) for over in self._overlaps])
        told = together(
            reason("less_play_keeps_gap", joint=name, share=share) if less else None,
            reason("heads_keep_gap") if held else None,
        )
        return told or None

    def _share(self, others: Sequence[Real], own: Sequence[Real]) -> float:
        """The share of its own play, in hundredths, that leaves every gap open beside what others take; 0 for none."""
        found = 1.0
        for (left, beside), one in zip(self._beside(others), own, strict=True):
            room = left - beside.sum(axis=0)
            every = np.divide(room, one, out=np.where(room < 0.0, 0.0, np.inf), where=one > 0.0)
            found = min(found, float(every.min()))
        return max(math.floor(100.0 * found) / 100.0, 0.0)

    def _opens(self, free: Sequence[Real]) -> bool:
        """Whether all gaps stay open where play closes them by so much, an ndarray (joints, n) of each."""
        return all(bool((left >= each.sum(axis=0)).all()) for left, each in self._beside(free))

    def _beside(self, free: Sequence[Real]) -> Iterator[tuple[Real, Real]]:
        """What deflection leaves of each gap, and by what play closes it."""
        left = (over.gap - closed.max(axis=0) for over, closed in zip(self._overlaps, self._closed, strict=True))
        return zip(left, free, strict=True)

    @property
    def _frame(self) -> LinkageFrame:
        assert self.moved.frame is not None
        return self.moved.frame

    @cached_property
    def _overlaps(self) -> list[Overlap]:
        return list(overlaps(self._frame, self.assembly))

    @cached_property
    def _freed(self) -> list[Real]:
        """By what the play of each joint closes every overlap's gap at its places: (joints, n)."""
        return [self._free(over) for over in self._overlaps]

    @property
    def _run(self) -> bool:
        """Whether pins let links come nearer at all."""
        return any(bool(free.any()) for free in self._freed)

    @cached_property
    def _soft(self) -> Scatter:
        """Load over stiffness, over what it is."""
        frame, solution = self.moved.frame, self.moved.solution
        assert frame is not None
        assert solution is not None
        return compliance_range(self.case, frame, solution).times(stated_scatter(self.case, self.load_case))

    @cached_property
    def _closed(self) -> list[Real]:
        """By what deflection closes every overlap's gap at its places: (m, n), first as stated, then as it may."""
        every = [
            np.array([one.at(over.lower, over.places) - one.at(over.upper, over.places) for one in self._shapes])
            for over in self._overlaps
        ]
        return [np.vstack([one, self._soft.low * one, self._soft.high * one]) for one in every]

    @cached_property
    def _shapes(self) -> list[Raised]:
        """As stated first, then with other air and friction that may be."""
        known = [(one.frame, one.solution) for one in self.moved.shapes]
        return [Raised(frame=frame, solution=solution) for frame, solution in known if frame and solution]

    def _free(self, over: Overlap, shares: Real | None = None, *, held: bool = False) -> Real:
        """How far play of joints, or shares of it, lets both links come nearer at places (J, n), by forces at rims.

        ``held`` is with heads without a gap, between which no link tilts.
        """
        total = np.zeros((len(self.case.joints), len(over.places)))
        units = {link: self._units[node] for link, node in self._nearest(over).items()}
        for i, group in self._loose:
            each = []
            for hole, whole, most in group:
                play, force = whole if shares is None else shares[i] * whole, np.zeros((len(over.places), 2, 2))
                for link, sign in ((over.lower, 1.0), (over.upper, -1.0)):
                    if link in units:
                        origin, (push, about_x, about_y) = units[link]
                        x, y = (over.places - origin).T[..., None, None]
                        force += sign * (push[hole] + y * about_x[hole] - x * about_y[hole])
                apart = 0.0 if held else min(play, most)
                each.append(furthest(play / 2.0 * force, np.array(apart / (play / 2.0))))
            total[i] += np.max(each, axis=0)
        return total

    @cached_property
    def _loose(self) -> list[tuple[int, list[tuple[tuple[str, str], float, float]]]]:
        """Holes that share a play, with the number of their joint: each with it, and how far its rims may be apart."""
        found = []
        for i, name in enumerate(self.case.joints):
            for group in loose_holes(self.case, name):
                alone = len(group) == 1
                most = [apart_at_rims(self.case, name, link, math.inf) if alone else math.inf for link, _ in group]
                found.append((i, [((name, link), play, far) for (link, play), far in zip(group, most, strict=True)]))
        return found

    def _nearest(self, over: Overlap) -> dict[str, int]:
        """The node of either link that is nearest to where they pass over each other."""
        frame, middle = self._frame, over.places.mean(axis=0)
        nodes = frame.model.nodes
        return {
            link: min((float(np.linalg.norm(nodes[n][:2] - middle)), n) for _, n in frame.stations[link])[1]
            for link in (over.lower, over.upper)
            if link in frame.stations
        }

    @cached_property
    def _units(self) -> dict[int, tuple[Real, Sequence[Mapping[tuple[str, str], Real]]]]:
        """Of nodes: place, and forces at rims by a unit force across the plane and unit moments about x and y."""
        frame = self._frame
        nodes = list(dict.fromkeys(n for over in self._overlaps for n in self._nearest(over).values()))
        loads = [NodeLoad(node=node, wrench=unit) for node in nodes for unit in np.eye(6)[2:5]]
        found = rim_forces(self.case, frame, loads)
        return {n: (frame.model.nodes[n][:2], found[3 * k : 3 * k + 3]) for k, n in enumerate(nodes)}


def layer_gap_outcomes(
    case: Case, load_case: str, moved: LargeDisplacement, assembly: Assembly | None
) -> Iterator[CheckOutcome]:
    """Yield the outcome of every check of clearance, between layers, under a load case.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it.
    assembly : Assembly or None
        The links' outlines; None where they have no layers.

    Yields
    ------
    CheckOutcome
        Against 0: washers may fill the gap, so that what a check asks for in the plane is no measure of it.
    """
    every = [*asked(case, ClearanceCheck, quantity=Quantity.LAYER_GAP)]
    if not every or assembly is None or moved.frame is None or moved.solution is None:
        return
    gaps = LayerGaps(case=case, load_case=load_case, moved=moved, assembly=assembly)
    found = gaps.least
    if found is None:
        return
    x, y = (0.0 if abs(end) < 1e-6 * case.linkage.longest else end for end in found.place)
    why = reason("layers_come_nearest", links=tuple(found.names), gap=found.gap, x=x, y=y)
    for one in every:
        outcome = one.outcome(load_case, found.left, why)
        yield outcome.because(together(why, gaps.remedy)) if outcome.verdict is Verdict.UNDECIDED else outcome
