"""Whether deflection and tilting pins close the gap between links that pass over each other.

Links of different layers keep a gap along the pins. Under load they bend and twist across the plane, and with play
their pins tilt in their holes. Where two outlines lie over each other in the pose, the gap at every corner of what they
share is reduced by how far the lower link rises there against the upper one: by the linear frame of beams, in the band
of its flexibility, of the load, the moduli, air and friction, and by the play at all rims at its worst
(``alula.fea.outcomes.free_motion``), for links that do not bend by it. Pins of which nothing is stated run.

Both links may rise far and by much the same, so that the band is that of the difference: the virtual work of opposed
unit forces at both links, term by term. A link takes part where something acts on it under the loads and under these
unit forces; one of the two does under the loads alone. Where the frame's beam does not tell how far such a link gives,
as of a plate, nothing is known of the gap. That is exact for one such link: what bears nothing under either gives
nothing, however soft it is.
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import compliance_scatter, load_scatter
from alula.fea.common.source import Source, SourceKind, distinct, play_source
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.frame.displacement_band import OneModulus, give_of_links, works
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import NodeLoad
from alula.fea.nonlinear.large_displacement import LargeDisplacement, blind_link, stated_scatter
from alula.fea.nonlinear.stability import ON_RIMS
from alula.fea.outcomes.free_motion import rim_forces
from alula.fea.outcomes.point_shares import NOTHING
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
        return sum(
            (share @ self.solution.displacements[node, 2:5] for node, share in rises(self.frame, link, places).items()),
            start=np.zeros(len(places)),
        )

    @cached_property
    def bearing(self) -> NDArray[np.bool_]:
        """Elements (m,) on which something acts."""
        return _bearing(self.solution.end_forces)

    def under(self, node: int) -> list[FrameSolution]:
        """Return the frame's answers to a unit force along z, and unit moments about x and y, at a node alone.

        Parameters
        ----------
        node : int

        Returns
        -------
        list of FrameSolution
        """
        model, none = self.frame.model, np.zeros(3)
        elements = tuple(replace(e, load_first=none, load_last=none) for e in model.elements)
        bare = replace(model, elements=elements)
        return [solve_frame(replace(bare, loads=(NodeLoad(node=node, wrench=unit),))) for unit in np.eye(6)[2:5]]


def rises(frame: LinkageFrame, link: str, places: Real) -> dict[int, Real]:
    """Return what the displacements of nodes make of those of places of a link along z.

    Between the stations of a beam its axis is the cubic that their displacements and slopes give; the section turns
    with the twist between them. By virtual work these are also the loads on nodes that a unit force at a place puts
    there.

    Parameters
    ----------
    frame : LinkageFrame
    link : str
        A link whose beam the frame has; another one stands still.
    places : ndarray, shape (n, 2)
        Global axes [mm].

    Returns
    -------
    dict of int to ndarray
        Node -> (n, 3), by its displacement along z and its turns about x and y [mm per mm, mm per rad].
    """
    if link not in frame.stations:
        return {}
    turn, stations = frame.pose.rotation(link), frame.stations[link]
    x, y = ((places - frame.pose.origins[link]) @ turn).T
    at = np.array([station[0] for station in stations])
    inside = np.clip(x, at[0], at[-1])
    first, sizes = np.clip(np.searchsorted(at, inside, side="right") - 1, 0, len(at) - 2), np.diff(at)
    t, size, beyond = (inside - at[first]) / sizes[first], sizes[first], x - inside
    found = {}
    for i, (_, node) in enumerate(stations):
        share, height, slope = np.zeros((3, len(x)))
        for number, s, sign in ((i, t, 1.0), (i - 1, 1.0 - t, -1.0)):  # at the first end of a beam, and at the last
            own = first == number
            share[own] = (1.0 - s)[own]
            height[own] = ((1.0 - s) ** 2 * (1.0 + 2.0 * s))[own]
            slope[own] = (sign * size * s * (1.0 - s) ** 2)[own]
        slope += beyond * share
        arm = frame.arms.get(node, np.zeros(3))
        about_x, about_y = np.outer(turn[:, 0], y * share) - np.outer(turn[:, 1], slope)
        found[node] = np.column_stack([height, about_x + arm[1] * height, about_y - arm[0] * height])
    return {node: share for node, share in found.items() if share.any()}


def _opposed(frame: LinkageFrame, over: Overlap) -> dict[int, Real]:
    """What the displacements of nodes make of how far the lower link rises against the upper one, as of ``rises``."""
    found = rises(frame, over.lower, over.places)
    return found | {node: -share for node, share in rises(frame, over.upper, over.places).items()}


def _bearing(end_forces: Real) -> NDArray[np.bool_]:
    """Elements (m,) on which more acts than rounding, by their end forces (..., m, 2, 6), in any state."""
    sizes = np.abs(end_forces).max(axis=-2)
    most = sizes.max(axis=-2, keepdims=True, initial=0.0)
    # Forces and moments by themselves: they have other units.
    most = np.repeat(np.stack([most[..., :3].max(axis=-1), most[..., 3:].max(axis=-1)], axis=-1), 3, axis=-1)
    return np.asarray((sizes > NOTHING * most).any(axis=-1).reshape(-1, sizes.shape[-2]).any(axis=0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Closed:
    """By what deflection closes a gap at its places, and which links take part.

    Attributes
    ----------
    ends : ndarray, shape (3, n)
        As the frame has it, at least, at most [mm].
    links : frozenset of str
        Links whose softness changes it.
    """

    ends: Real
    links: frozenset[str]


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
        What is left of it [mm]; not known where a link takes part for which the frame's beam does not tell.
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
        """The gap of which least is left, by the low end of its band; None where no link passes over another.

        One of which nothing is known goes before those that may stay open, and behind those that close.
        """
        loose, causes = clearances(self.case), self.moved.of_loads
        pins = (play_source(loose),) if loose else (ON_RIMS,) if self._run else ()
        slack = stated_scatter(self.case, self.load_case).sources
        sources = distinct((Source(kind=SourceKind.EYES),), slack, tuple(cause.source for cause in causes), pins)
        found = []
        for over, closed, freed, blind in zip(self._overlaps, self._closed, self._freed, self._blind, strict=True):
            free = freed.sum(axis=0)
            least, most = closed.min(axis=0), closed.max(axis=0)
            k = int(np.argmax(most + free))
            left = Band(
                value=over.gap - float(closed[0, k]),
                low=-math.inf if self._endless else over.gap - float(most[k] + free[k]),
                high=over.gap - float(least[k] - free[k]),
                sources=sources,
            )
            if blind:
                left = Band.unknown(reason("frame_is_blind", link=blind, rigid=False))
            place = float(over.places[k, 0]), float(over.places[k, 1])
            found.append(LayerGap(names=(over.lower, over.upper), gap=over.gap, left=left, place=place))
        closes = min((one for one in found if one.left.high < 0.0), key=lambda one: one.left.low, default=None)
        unknown = next((one for one in found if one.left.unknowable), None)
        return closes or unknown or min(found, key=lambda one: one.left.low, default=None)

    @property
    def remedy(self) -> Reason | str | None:
        """What keeps all gaps open, as tried: less play of one joint, else of all, and heads; None where nothing does.

        Where deflection alone may close a gap, that is told.
        """
        frame, joints = self.moved.frame, tuple(self.case.joints)
        loose = clearances(self.case)
        if frame is None or not self._run or self._endless:
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

    @property
    def _endless(self) -> bool:
        """Whether nothing bounds how far deflection closes gaps, in some air or with some friction."""
        return any(cause.endless or len(_solved(cause.others)) < len(cause.others) for cause in self.moved.of_loads)

    @cached_property
    def _closed(self) -> list[Real]:
        """By what deflection closes every overlap's gap at its places: (3, n), as stated, at least, at most.

        Causes are factors. Since two links' deflections may cancel at a place, of which no factor tells then, what one
        cause adds is times what those before it make of the largest of all.
        """
        (stated,), *causes = self._answers
        found, grown = [one.ends.copy() for one in stated], 1.0
        for others in causes:
            for k, own in enumerate(stated):
                every = np.array([own.ends, *(other[k].ends for other in others)])
                for end, change in ((1, every[:, 1].min(axis=0)), (2, every[:, 2].max(axis=0))):
                    added = change - own.ends[end]
                    found[k][end] += np.multiply(grown, added, out=np.zeros_like(added), where=added != 0.0)
            sizes = [max((float(abs(one.ends[0]).max()) for one in each), default=0.0) for each in (stated, *others)]
            if max(sizes) > sizes[0]:
                grown *= max(sizes) / sizes[0] if sizes[0] > 0.0 else math.inf
        load = load_scatter(self.case, self.load_case)
        for ends in found:
            ends[1] = np.minimum(load.low * ends[1], load.high * ends[1])
            ends[2] = np.maximum(load.low * ends[2], load.high * ends[2])
        return found

    @cached_property
    def _blind(self) -> list[str]:
        """Of every overlap a link that takes part and gives as no beam tells; "" where there is none."""
        every = zip(*(one for answers in self._answers for one in answers), strict=True)
        return [blind_link(self.case, frozenset().union(*(one.links for one in each))) for each in every]

    @cached_property
    def _answers(self) -> list[list[list[Closed]]]:
        """Of every overlap: that of the stated loads alone, then the other answers of each cause, air and friction."""
        every = [(self.moved,), *(cause.others for cause in self.moved.of_loads)]
        return [[self._bent(one) for one in _solved(answers)] for answers in every]

    def _bent(self, shape: Raised) -> list[Closed]:
        """How far deflection closes every overlap's gap: the work of opposed unit forces at places of both links.

        As of points (``point_bounds``) each term of it is at its worst, and each material by itself.
        """
        frame = shape.frame
        beams, bores = give_of_links(self.case, frame)
        sinking = [(node, give) for _, node, give in bores]
        of_beams = np.array([frame.beams[i].link if i in frame.beams else "" for i in range(len(shape.bearing))])
        of_bores = np.array([link for link, _, _ in bores], dtype=str)
        opposed = [_opposed(frame, over) for over in self._overlaps]
        units = {node: shape.under(node) for node in dict.fromkeys(node for own in opposed for node in own)}
        work = {
            node: [works(shape.solution, unit, beams, sinking, pins=frame.pin_beams.values()) for unit in each]
            for node, each in units.items()
        }
        found = []
        for over, own in zip(self._overlaps, opposed, strict=True):
            value = shape.at(over.lower, over.places) - shape.at(over.upper, over.places)
            if not own:  # neither is in the frame
                found.append(Closed(ends=np.tile(value, (3, 1)), links=frozenset()))
                continue
            shares = np.hstack(list(own.values()))
            terms, sunk, forces = (
                np.tensordot(shares, each, axes=1)
                for each in (
                    [one.beams for node in own for one in work[node]],
                    [one.bores for node in own for one in work[node]],
                    [one.end_forces for node in own for one in units[node]],
                )
            )
            low = high = value - terms[:, :, 0].sum(axis=(1, 2))  # rounding, and what no beam does
            for one in self._moduli:
                here, there = np.isin(of_beams, list(one.links)), np.isin(of_bores, list(one.links))
                least = terms[:, here].min(axis=2).sum(axis=(1, 2)) + np.minimum(sunk[:, there], 0.0).sum(axis=(1, 2))
                most = terms[:, here].max(axis=2).sum(axis=(1, 2)) + np.maximum(sunk[:, there], 0.0).sum(axis=(1, 2))
                low = low + np.minimum(one.low * least, one.high * least)
                high = high + np.maximum(one.low * most, one.high * most)
            ends = np.array([value, np.minimum(low, value), np.maximum(high, value)])
            near = np.isin(of_beams, [over.lower, over.upper])  # between and beside its nodes it bends as well
            takes = of_beams[shape.bearing & (near | _bearing(forces))]
            found.append(Closed(ends=ends, links=frozenset(takes.tolist()) - {""}))
        return found

    @cached_property
    def _moduli(self) -> list[OneModulus]:
        """The links of every material, and what its modulus may make of their flexibility; what is no link is exact."""
        links: dict[tuple[float, float, float, str], list[str]] = {}
        for link in self.case.bending_links:
            material = self.case.material_of(link)
            soft = compliance_scatter(material)
            links.setdefault((soft.low, soft.high, material.youngs_modulus, material.title), []).append(link)
        every = [((1.0, 1.0), [""]), *(((low, high), own) for (low, high, *_), own in links.items())]
        return [OneModulus(links=own, low=low, high=high) for (low, high), own in every]

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


def _solved(shapes: Sequence[LargeDisplacement]) -> list[Raised]:
    """Those of which there is a frame."""
    known = [(one.frame, one.solution) for one in shapes]
    return [Raised(frame=frame, solution=solution) for frame, solution in known if frame and solution]


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
    if found.left.unknowable:
        yield from (one.outcome(load_case, found.left, found.left.without) for one in every)
        return
    x, y = (0.0 if abs(end) < 1e-6 * case.linkage.longest else end for end in found.place)
    why = reason("layers_come_nearest", links=tuple(found.names), gap=found.gap, x=x, y=y)
    for one in every:
        outcome = one.outcome(load_case, found.left, why)
        yield outcome.because(together(why, gaps.remedy)) if outcome.verdict is Verdict.UNDECIDED else outcome
