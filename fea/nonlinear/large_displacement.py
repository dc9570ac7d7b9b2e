"""Large displacement of a linkage: whether the pose as it stands is good enough, and what holds on the deformed shape.

Where the linear frame moves by more than 5 % of the linkage's span, equilibrium on the undeformed pose is no longer a
good answer: joint forces then come from the co-rotational frame (``alula.fea.nonlinear.corotational``), and each link
is loaded by what acts on it on the deformed shape, along the chord through its first and last station. So it is where
the frame is within ten times its load of buckling by linear theory, below which EN 1993-1-1:2005, 5.2.1(3), asks for
second-order analysis, or of a dead point by its linear displacements: a shallow toggle snaps through at 5.2 of either
(``alula.fea.nonlinear.stability``). Stated scatter of load and modulus counts at its worst.

The limit-load factor says by what all loads may grow until the linkage gives way. The path of stable equilibrium is
followed to ``MOST`` times the load. It ends at a limit point, from where the linkage snaps through, or where the
deformed shape is not stable any more. Where linear theory finds the linkage so far from buckling and from a dead point
that even a shallow toggle would hold ``MOST`` times the load, nothing is followed. The material is linear: where a link
breaks is no part of the factor. Its band covers the steps of the path; stated scatter of load and modulus; what plain
beams do not know of eyes, bores and holes (all links are then softer by what these add to the work of the loads: for
the owl wing with springs of its own beside every pin this meets the limit load within 4 %); and faults of shape, by a
third of the linear buckling factor: a frame without them stands straight up to its buckling load. Solids of links that
are known take the place of what plain beams do not know (``alula.fea.check.known_stiffness``). The share of the load
that is held is the same number, up to 1.

The path is that of pins which are tight between layers. Where they may run, its low end is times the linear buckling
factor with pins as rims leave them over that with tight ones (``alula.fea.nonlinear.on_rims``), which is assumed.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, compliance_scatter, load_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.frame.build import build_frame
from alula.fea.frame.displacement_band import compliance_range
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.nonlinear.deformed_links import balanced, on_deformed_shape
from alula.fea.nonlinear.equilibrium_path import (
    MOST_STEPS,
    CorotationalSolution,
    NoEquilibriumError,
    UnfollowedError,
)
from alula.fea.nonlinear.softened import followed
from alula.fea.nonlinear.stability import LARGE, ON_RIMS, SNAP, dead_point_factor, linkage_factor, span
from alula.fea.standing.joint_forces import JointForces
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.case import Case
from alula.loads.records.applied import Load, PointLoad, in_axes
from alula.loads.statics.statics import Reactions

if TYPE_CHECKING:
    from alula.fea.nonlinear.on_rims import RimFactors
    from alula.fea.pins.states import PinStates

Real = NDArray[np.float64]

LEAST_FACTOR = 10.0
"""Factor to buckling or to a dead point below which equilibrium is sought on the deformed shape."""
LEAST_LINEAR = 3.0
"""Buckling factor below which small faults of shape, which no frame knows, grow too much to be relied on."""
MOST = 10.0
"""Factor up to which the path to the limit load is followed."""
_ALONG = (0.25, 0.5, 0.75)

State = Literal["small", "deformed", "unstable", "no equilibrium", "off", "unknown"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LargeDisplacement:
    """What became of one load case in large displacement.

    Attributes
    ----------
    state : State
        Small: the linear answer is valid. deformed: stable equilibrium was found on the deformed shape. unstable: it
        buckles below the whole load. no equilibrium: equilibrium ends below it, or was not followed up to it. off: the
        case says not to look. unknown: there is no frame of this linkage.
    span : float
        Largest distance between two points of the pose [mm].
    linear : float
        Largest displacement by the linear frame [mm]; 0 where there is no frame.
    where : Reason or str
        Place of that displacement.
    held : float
        Share of the load up to which stable equilibrium was found; 1 for all of it.
    lost : float
        The least share at which none was found; infinite where there is none.
    scatter : Scatter
        Of load over modulus, as stated.
    eyes : Scatter
        Of how soft the links are under the loads, beside the frame's plain beams.
    softness : Band or None
        The same of the links under the loads with what solids of them are known; None where none is.
    alone : float
        Least factor at which a link that is no beam buckles by itself as a solid; infinite where none is known.
    blind : str
        A link for which the frame's beam does not tell how far it gives; "" where there is none.
    buckling : float or None
        Lowest factor on all loads at which the linear frame becomes unstable; infinite where it never does, None where
        there is no frame, and where linear theory alone was asked for.
    dead_point : float
        Factor on the linear displacements that takes the linkage to a dead point; infinite where they lead away.
    points : dict of tuple of 2 str to ndarray
        (link, point) -> displacement (3,) on the deformed shape [mm]; the linear one where small or off; empty where no
        equilibrium or no frame was found.
    reactions : Reactions or None
        On the deformed shape, in global axes; None unless deformed.
    links : dict of str to LinkLoads
        Loads of each link on the deformed shape, in its chord's frame; empty unless deformed.
    reason : Reason
        Why it was or was not followed on the deformed shape, and what was found there.
    frame : LinkageFrame or None
        The undeformed one; None where there is no frame.
    solution : FrameSolution or None
        Linear, of that frame.
    grown : LargeDisplacement or None
        Of a small one what holds on the deformed shape, where that was asked for and found.
    pins : PinStates or None
        How pins stand between layers; None where none may run.
    causes : tuple of Alternatives
        What may become of it instead: where play brings the linkage nearest to a dead point and furthest off, at other
        coefficients of air, with other friction.
    """

    state: State
    span: float
    linear: float = 0.0
    where: Reason | str = ""
    held: float = 1.0
    lost: float = math.inf
    scatter: Scatter = field(default_factory=Scatter)
    eyes: Scatter = field(default_factory=Scatter)
    softness: Band | None = None
    alone: float = math.inf
    blind: str = ""
    buckling: float | None = None
    dead_point: float = math.inf
    points: Mapping[tuple[str, str], Real]
    reactions: Reactions | None = None
    links: Mapping[str, LinkLoads]
    reason: Reason
    frame: LinkageFrame | None = None
    solution: FrameSolution | None = None
    grown: "LargeDisplacement | None" = None
    pins: "PinStates | None" = None
    causes: "tuple[Alternatives[LargeDisplacement], ...]" = ()

    @property
    def rims(self) -> "RimFactors | None":
        """Factors at which the linear frame becomes unstable with its pins in their holes; None where none may run."""
        if self.pins is None or self.buckling is None:
            return None
        from alula.fea.nonlinear.on_rims import rim_factors

        return rim_factors(self.pins).within(self.buckling)

    @property
    def share(self) -> float:
        """Largest linear displacement over the span."""
        return self.linear / self.span

    @property
    def linear_from(self) -> float:
        """The ``factor`` from which on linear theory is enough, with load over stiffness and eyes at their softest."""
        return max(LEAST_FACTOR, SNAP * self.eyes.high) * self.scatter.high

    @property
    def factor(self) -> float | None:
        """The lesser of the factors to buckling and to a dead point; None where there is no frame."""
        return None if self.buckling is None else min(self.buckling, self.dead_point)

    @property
    def followed(self) -> bool:
        """True where equilibrium was sought on the deformed shape, so that its answer rules."""
        return self.state in ("deformed", "unstable", "no equilibrium")

    @property
    def gives_way(self) -> bool:
        """True where no stable equilibrium was found under the whole load."""
        return self.state in ("unstable", "no equilibrium")

    @property
    def unfollowed(self) -> bool:
        """True where equilibrium was not followed up to the whole load, so that nobody knows whether it is held."""
        return self.gives_way and math.isinf(self.lost)

    @property
    def slack(self) -> Scatter:
        """Scatter of load over stiffness: what is stated, and what plain beams do not know."""
        return self.scatter.times(self.eyes)

    @property
    def limit_load(self) -> Band:
        """Factor on all loads at which the linkage gives way, with all that play, air and friction may make of it."""
        found = self._limit_load
        if not self.causes or found.unknowable:
            return found
        others = [one.limit_load for cause in self.causes for one in cause.others]
        every = [found, *(one for one in others if not one.unknowable)]
        return replace(
            found,
            low=0.0 if any(cause.endless for cause in self.causes) else min(one.low for one in every),
            high=max(one.high for one in every),
            sources=distinct(found.sources, tuple(cause.source for cause in self.causes)),
        )

    def by(self, kind: SourceKind) -> "Alternatives[LargeDisplacement] | None":
        """Return what a cause of some kind may make of it; None where there is no such cause.

        Parameters
        ----------
        kind : SourceKind

        Returns
        -------
        Alternatives or None
        """
        return next((cause for cause in self.causes if cause.source.kind is kind), None)

    @property
    def shapes(self) -> "tuple[LargeDisplacement, ...]":
        """All that may become of it under the loads as they may be: as stated first. Play changes where pins stand."""
        return (self, *(one for cause in self.of_loads for one in cause.others))

    @property
    def of_loads(self) -> "tuple[Alternatives[LargeDisplacement], ...]":
        """Causes that change what acts: air and friction."""
        return tuple(cause for cause in self.causes if cause.source.kind is not SourceKind.PLAY)

    def displaced(self, cause: "Alternatives[LargeDisplacement]", link: str, point: str) -> Scatter:
        """Return what one of its causes makes of the displacement of a point.

        Parameters
        ----------
        cause : Alternatives
        link, point : str
            Their names.

        Returns
        -------
        Scatter
            From nothing to infinity where the point has no displacement in one of the answers.
        """
        if any((link, point) not in one.points for one in (self, *cause.others)):
            return Scatter(low=0.0, high=math.inf, sources=(cause.source,))
        return cause.scatter(self, lambda one: float(np.linalg.norm(one.points[link, point])))

    @cached_property
    def _limit_load(self) -> Band:
        """That with pins in the middle of their holes.

        Without upper end where it holds ``MOST`` times the load; not known where no frame tells.
        """
        if self.frame is None or self.buckling is None or self.factor is None:
            return Band.unknown(self.reason)
        if self.blind:
            return Band.unknown(reason("frame_blind_to_link", link=self.blind))
        known, soft = self.softness, 1.0 if self.softness is None else self.softness.value
        eyes = self.eyes if known is None else Scatter(low=known.low, high=known.high, sources=known.sources)
        slack = self.scatter.times(eyes)
        sources, faults = slack.sources, self.buckling / LEAST_LINEAR / slack.high
        if self.state == "off" or self.factor / SNAP / slack.high >= MOST:
            value, low, high = self.factor / soft, self.factor / SNAP / slack.high, self.buckling / slack.low
            sources = (*sources, Source(kind=SourceKind.SNAP_THROUGH, detail=reason("linear_theory_too_high")))
        else:
            value, lost = (self.held, self.lost) if self.gives_way else _end(self.frame, self.held)
            low, high = value / slack.high, lost / slack.low
            value = value / soft if math.isfinite(lost) else value
            sources = (Source(kind=SourceKind.PATH, detail=reason("steps_of_load")), *sources)
            if faults < low:
                detail = reason("buckling_below", factor=LEAST_LINEAR)
                low, sources = faults, (*sources, Source(kind=SourceKind.IMPERFECTION, detail=detail))
        if self.rims is not None and self.rims.low < self.buckling:
            low, sources = self.rims.lowered(low, self.buckling), (*sources, ON_RIMS)
        by_itself = self.alone / LEAST_LINEAR / self.scatter.high
        if self.alone < value or by_itself < low:
            value, low = min(value, self.alone), min(low, by_itself)
            sources = (*sources, Source(kind=SourceKind.IMPERFECTION, detail=reason("buckling_of_link")))
        if value >= MOST:
            return Band(value=MOST, low=min(low, MOST), high=math.inf, sources=distinct(sources))
        return Band(value=value, low=min(low, value), high=max(high, value), sources=distinct(sources))

    @property
    def held_share(self) -> Band:
        """Share of the load that is held: the limit-load factor, but no more than 1."""
        factor = self.limit_load
        if factor.unknowable:
            return factor
        return replace(factor, value=min(factor.value, 1.0), low=min(factor.low, 1.0), high=min(factor.high, 1.0))


def examine(
    case: Case,
    title: str,
    forces: JointForces,
    loads: Sequence[Load],
    buckling: float | None = None,
    *,
    linear: bool = False,
) -> LargeDisplacement:
    """Solve the linear frame of a load case and, where it moves far or may give way, its deformed shape.

    Parameters
    ----------
    case : Case
        The case.
    title : str
        Of the load case.
    forces : JointForces
        Joint forces in the pose as it stands.
    loads : sequence of Load
        That act on the links, global axes.
    buckling : float, optional
        Lowest factor at which the linear frame becomes unstable, where it is known.
    linear : bool, optional
        True for the linear frame alone, whatever it says: small, and without a factor to buckling or to a dead point.

    Returns
    -------
    LargeDisplacement
        Which of both shapes is valid, and what it says.
    """
    pose = forces.reactions.pose
    size = span(pose)

    def left(state: State, why: Reason) -> LargeDisplacement:
        return LargeDisplacement(state=state, span=size, points={}, links={}, reason=why)

    off, as_said = case.large_displacement == "off", reason("large_displacement_off")
    frame, solution = forces.frame, forces.solution
    try:
        if frame is None or solution is None:
            frame = build_frame(case, pose, loads, held=case.pinned_drive)
            solution = solve_frame(frame.model)
        factor = linkage_factor(frame) if buckling is None and not linear else buckling
    except (CaseError, CannotRunError) as error:
        return left("off", as_said) if off else left("unknown", reason("large_displacement_unknown", error=str(error)))
    scatter = stated_scatter(case, title)
    blind = blind_link(case)
    eyes = Scatter() if blind else compliance_range(case, frame, solution)
    points = frame.at_points(solution.displacements)
    if linear:
        one = LargeDisplacement(state="small", span=size, points=points, links={}, reason=reason("linear_so_far"))
        return replace(one, scatter=scatter, eyes=eyes, blind=blind, frame=frame, solution=solution)
    assert factor is not None
    near = dead_point_factor(frame, solution)
    if off:
        found = left("off", as_said)
        known = replace(found, buckling=factor, dead_point=near, points=points, frame=frame, solution=solution)
        return replace(known, scatter=scatter, eyes=eyes, blind=blind, pins=forces.pins)
    farthest, where = _largest(frame, solution)
    small = LargeDisplacement(
        state="small",
        span=size,
        linear=farthest,
        where=where,
        buckling=factor,
        dead_point=near,
        scatter=scatter,
        eyes=eyes,
        blind=blind,
        points=points,
        links={},
        frame=frame,
        solution=solution,
        pins=forces.pins,
        reason=reason("moves_little", linear=farthest, where=where, share=farthest / size, span=size, limit=LARGE),
    )
    if scatter.high * small.share <= LARGE and min(factor, near) >= small.linear_from:
        return small
    return _deformed(case, title, frame, small, loads)


def with_growth(case: Case, title: str, moved: LargeDisplacement, loads: Sequence[Load]) -> LargeDisplacement:
    """Return what became of a load case, with what a small one becomes on its deformed shape.

    Parameters
    ----------
    case : Case
    title : str
        Of the load case.
    moved : LargeDisplacement
    loads : sequence of Load
        That act on the links, global axes.

    Returns
    -------
    LargeDisplacement
        The same unless small, and where linear theory alone was asked for; the answer on the deformed shape itself
        where that does not hold the load.
    """
    if moved.state != "small" or moved.frame is None or moved.buckling is None:
        return moved
    try:
        grown = _deformed(case, title, moved.frame, moved, loads)
    except (CaseError, CannotRunError):
        return moved
    return grown if grown.gives_way else replace(moved, grown=grown)


def stated_scatter(case: Case, load_case: str) -> Scatter:
    """Return what load over modulus of a linkage may be, over what it is.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.

    Returns
    -------
    Scatter
    """
    materials = [compliance_scatter(case.material_of(link)) for link in case.bending_links]
    slack = Scatter(
        low=min((m.low for m in materials), default=1.0),
        high=max((m.high for m in materials), default=1.0),
        sources=distinct(*(m.sources for m in materials)),
    )
    return slack.times(load_scatter(case, load_case))


def blind_link(case: Case, links: Iterable[str] | None = None) -> str:
    """Return a link for which a beam along its axis does not tell how far it gives; "" where there is none.

    Parameters
    ----------
    case : Case
    links : iterable of str, optional
        Among which it is sought; by default all that bend.

    Returns
    -------
    str
    """
    among = case.bending_links if links is None else links
    return next((link for link in among if not case.part_of(link).has_centre_line(case.body(link))), "")


@lru_cache(maxsize=32)
def _end(frame: LinkageFrame, held: float) -> tuple[float, float]:
    """Return the largest factor that was found to be held, and the least that was not."""
    try:
        followed(frame, MOST)
    except NoEquilibriumError as error:
        found = max(MOST * error.reached, held)  # the steps to the load itself may be finer
        return found, max(MOST * error.failed, found)
    return MOST, math.inf


def _leaning(load: PointLoad, frame: LinkageFrame, found: CorotationalSolution) -> PointLoad:
    """Return what the moment of a load gains as its arm turns with its link."""
    stated = in_axes(load, "global", frame.pose.placement)
    turned = found.rotations[frame.points[load.link, load.point]] @ stated.arm
    gained = np.cross(turned - stated.arm, stated.wrench[:3])
    return PointLoad(link=load.link, point=load.point, wrench=np.concatenate([np.zeros(3), gained]))


def _deformed(
    case: Case,
    title: str,
    frame: LinkageFrame,
    small: LargeDisplacement,
    loads: Sequence[Load],
) -> LargeDisplacement:
    assert small.buckling is not None
    times = small.scatter.high
    if times * small.share > LARGE:
        share, where, limit = small.share, small.where, LARGE / times
        why = reason("moves_too_far", linear=small.linear, where=where, share=share, span=small.span, limit=limit)
    elif min(small.buckling, small.dead_point) >= small.linear_from:
        why = reason("far_by_linear_theory")
    elif small.buckling <= small.dead_point:
        why = reason("buckles_too_near", factor=small.buckling, limit=small.linear_from)
    else:
        why = reason("dead_point_too_near", factor=small.dead_point, limit=small.linear_from)
    try:
        found = followed(frame, 1.0)
    except UnfollowedError as error:
        unknown = reason("not_followed_to_load", why=why, held=error.reached, steps=MOST_STEPS)
        return replace(small, state="no equilibrium", held=error.reached, points={}, reason=unknown)
    except NoEquilibriumError as error:
        state: State = "unstable" if error.buckled else "no equilibrium"
        lost = reason("buckles_below_load" if error.buckled else "gives_way_below_load", why=why, held=error.reached)
        return replace(small, state=state, held=error.reached, lost=error.failed, points={}, reason=lost)
    points = frame.at_points(found.displacements)
    count = len(frame.model.nodes)
    reactions = frame.reactions(found.joint_wrenches[:count], found.residual, found.displacements[:count])
    moved = max((float(np.linalg.norm(d)) for d in points.values()), default=0.0)
    acting = (
        *loads,
        *(
            PointLoad(link=link, point=point, wrench=wrench)
            for spring, wrenches in found.springs
            for (link, point), wrench in zip(spring.acting.ends, wrenches, strict=True)
        ),
        *(_leaning(load, frame, found) for load in loads if isinstance(load, PointLoad) and load.arm.any()),
    )
    return replace(
        small,
        state="deformed",
        points=points,
        reactions=reactions,
        links={
            link: balanced(
                on_deformed_shape(frame, found, reactions, link, title, case.body(link), acting),
                frame.model.load_scale,
            )
            for link in case.bending_links
        },
        reason=reason("holds_on_deformed_shape", why=why, moved=moved),
    )


def _largest(frame: LinkageFrame, solution: FrameSolution) -> tuple[float, Reason | str]:
    """Largest displacement of nodes and of stations between them [mm], and where."""
    sizes = np.linalg.norm(solution.displacements[:, :3], axis=1)
    node = int(np.argmax(sizes))
    largest = float(sizes[node])
    where: Reason | str = frame.model.name(node)
    for i in range(len(frame.model.elements)):
        length = frame.model.length(i)
        between = np.linalg.norm(solution.axis_displacements(i, length * np.array(_ALONG)), axis=1).max()
        if between > largest:
            a, b = frame.model.elements[i].nodes
            largest, where = float(between), reason("between", one=frame.model.name(a), other=frame.model.name(b))
    return largest, where
