"""Large displacement of a linkage: whether the pose as it stands is good enough, and what holds on the deformed shape.

Where the linear frame moves by more than 5 % of the linkage's span, equilibrium on the undeformed pose is no longer a
good answer: joint forces then come from the co-rotational frame (``fea.nonlinear.corotational``), and each link is
loaded by what acts on it on the deformed shape, along the chord through its first and last station. So it is where the
frame is within ten times its load of buckling by linear theory, below which EN 1993-1-1:2005, 5.2.1(3), asks for
second-order analysis, or of a dead point by its linear displacements: a shallow toggle snaps through at 5.2 of either
(``fea.nonlinear.stability``). Stated scatter of load and modulus counts at its worst, and what holds is undecided where
the linear factor is below 3: a frame without faults of shape stands straight up to its buckling load.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.link_loads import LinkLoads
from fea.common.scatter import Scatter, compliance_scatter, load_scatter
from fea.common.source import Source, SourceKind, distinct
from fea.frame.build import build_frame
from fea.frame.joint_forces import JointForces
from fea.frame.linear import FrameSolution, solve_frame
from fea.frame.linkage_frame import LinkageFrame
from fea.nonlinear.corotational import solve_large_displacement
from fea.nonlinear.deformed_links import balanced, on_deformed_shape
from fea.nonlinear.equilibrium_path import CorotationalSolution, NoEquilibriumError
from fea.nonlinear.stability import dead_point_factor, linkage_factor
from geometry.base.errors import CannotRunError, CaseError
from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.records.applied import Load
from loads.statics.statics import Reactions

Real = NDArray[np.float64]

LARGE = 0.05
"""Share of the span above which a displacement is large."""
LEAST_FACTOR = 10.0
"""Factor to buckling or to a dead point below which equilibrium is sought on the deformed shape."""
LEAST_LINEAR = 3.0
"""Buckling factor below which small faults of shape, which no frame knows, grow too much to be relied on."""
PATH_SUBDIVISIONS = 2
LEAST_STEP = 1.0 / 512.0
MOST_ITERATIONS = 15
_ALONG = (0.25, 0.5, 0.75)

State = Literal["small", "deformed", "unstable", "no equilibrium", "off", "unknown"]


@dataclass(frozen=True, kw_only=True, eq=False)
class LargeDisplacement:
    """What became of one load case in large displacement.

    Attributes
    ----------
    state : State
        Small: the linear answer is valid. deformed: stable equilibrium was found on the deformed shape. unstable: it
        buckles below the whole load. no equilibrium: equilibrium ends below it. off: the case says not to look.
        unknown: there is no frame of this linkage.
    span : float
        Largest distance between two points of the pose [mm].
    linear : float
        Largest displacement by the linear frame [mm]; 0 where there is no frame.
    where : str
        Place of that displacement, for people.
    held : float
        Share of the load up to which stable equilibrium was found; 1 for all of it.
    lost : float
        The least share at which none was found; infinite where there is none.
    held_band : Band
        ``held`` with the stated scatter of load and modulus; of no meaning unless ``followed``.
    scatter : Scatter
        Of load over modulus, as stated.
    buckling : float or None
        Lowest factor on all loads at which the linear frame becomes unstable; infinite where it never does, None where
        there is no frame.
    dead_point : float
        Factor on the linear displacements that takes the linkage to a dead point; infinite where they lead away.
    points : dict of tuple of 2 str to ndarray
        (link, point) -> displacement (3,) on the deformed shape [mm]; the linear one where small or off; empty where no
        equilibrium or no frame was found.
    reactions : Reactions or None
        On the deformed shape, in global axes; None unless deformed.
    links : dict of str to LinkLoads
        Loads of each link on the deformed shape, in its chord's frame; empty unless deformed.
    sentence : str
        For people.
    frame : LinkageFrame or None
        The undeformed one; None where there is no frame.
    solution : FrameSolution or None
        Linear, of that frame.
    """

    state: State
    span: float
    linear: float = 0.0
    where: str = ""
    held: float = 1.0
    lost: float = math.inf
    held_band: Band = field(default_factory=lambda: Band.exact(1.0))
    scatter: Scatter = field(default_factory=Scatter)
    buckling: float | None = None
    dead_point: float = math.inf
    points: Mapping[tuple[str, str], Real]
    reactions: Reactions | None = None
    links: Mapping[str, LinkLoads]
    sentence: str
    frame: LinkageFrame | None = None
    solution: FrameSolution | None = None

    @property
    def share(self) -> float:
        """Largest linear displacement over the span."""
        return self.linear / self.span

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


def span(pose: Pose) -> float:
    """Return the largest distance between two points of the pose.

    Parameters
    ----------
    pose : Pose
        The linkage's pose.

    Returns
    -------
    float
        Distance [mm].
    """
    xy = np.array(list(pose.points.values()))
    return float(np.linalg.norm(xy[:, None] - xy[None], axis=-1).max())


def examine(
    case: Case,
    title: str,
    forces: JointForces,
    loads: Sequence[Load],
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

    Returns
    -------
    LargeDisplacement
        Which of both shapes is valid, and what it says.
    """
    pose = forces.reactions.pose
    size = span(pose)

    def left(state: State, why: str) -> LargeDisplacement:
        sentence = f"large displacement was not checked{why}"
        return LargeDisplacement(state=state, span=size, points={}, links={}, sentence=sentence)

    off = case.large_displacement == "off"
    as_said = ", because the case says large_displacement = off"
    frame, solution = forces.frame, forces.solution
    try:
        if frame is None or solution is None:
            frame = build_frame(case, pose, loads, held=case.pinned_drive)
            solution = solve_frame(frame.model)
        factor = linkage_factor(frame)
    except (CaseError, CannotRunError) as error:
        return left("off", as_said) if off else left("unknown", f": {error}")
    materials = [compliance_scatter(case.material_of(link)) for link in case.bending_links]
    slack = Scatter(
        low=min(m.low for m in materials),
        high=max(m.high for m in materials),
        sources=distinct(*(m.sources for m in materials)),
    )
    scatter = slack.times(load_scatter(case, title))
    near, points = dead_point_factor(frame, solution), frame.at_points(solution.displacements)
    if off:
        found = left("off", as_said)
        known = replace(found, buckling=factor, dead_point=near, points=points, frame=frame, solution=solution)
        return replace(known, scatter=scatter)
    linear, where = _largest(frame, solution)
    small = LargeDisplacement(
        state="small",
        span=size,
        linear=linear,
        where=where,
        buckling=factor,
        dead_point=near,
        scatter=scatter,
        points=points,
        links={},
        frame=frame,
        solution=solution,
        sentence=(
            f"the linkage moves by at most {linear:.3g} mm ({where}), {100.0 * linear / size:.3g} % of its span of "
            f"{size:.4g} mm (limit {100.0 * LARGE:g} %): equilibrium in the undeformed pose is accurate enough"
        ),
    )
    if scatter.high * linear <= LARGE * size and min(factor, near) >= LEAST_FACTOR * scatter.high:
        return small
    found = _deformed(case, title, frame, small, loads)
    return replace(found, held_band=_held_band(frame, found))


def _held_band(frame: LinkageFrame, found: LargeDisplacement) -> Band:
    """Band of the share of the load that is held, with what load over modulus may be by its scatter.

    A frame of linear material has the shape that load over modulus gives it, so that its limit load scales.
    """
    scatter = found.scatter
    if found.gives_way:
        ends = found.held / scatter.high, found.held / scatter.low
        return Band(value=found.held, low=ends[0], high=ends[1], sources=scatter.sources)
    sources = scatter.sources
    low = _holds(frame, scatter.high) if scatter.high > 1.0 else 1.0
    faults = math.inf if found.buckling is None else found.buckling / scatter.high / LEAST_LINEAR
    if faults < low:
        # A straight linkage keeps its shape up to its buckling load, a real one is never straight.
        near = f"buckling at less than {LEAST_LINEAR:g} times the load"
        low, sources = faults, (*sources, Source(kind=SourceKind.IMPERFECTION, detail=near))
    return Band(value=1.0, low=low, high=1.0, sources=sources)


def _holds(frame: LinkageFrame, factor: float) -> float:
    """Share that is held of ``factor`` times load over modulus."""
    try:
        followed(frame, factor)
    except NoEquilibriumError as error:
        return error.reached
    return 1.0


def displaced(frame: LinkageFrame, link: str, point: str, factor: float) -> float:
    """Return the distance by which a point moves on the deformed shape.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    link : str
        On which the point lies.
    point : str
        Its name.
    factor : float
        Load over modulus, relative to the case.

    Returns
    -------
    float
        Distance [mm]; infinite where nothing holds.
    """
    try:
        found = followed(frame, factor)
    except NoEquilibriumError:
        return math.inf
    return float(np.linalg.norm(frame.at_points(found.displacements)[link, point]))


def followed(frame: LinkageFrame, factor: float) -> CorotationalSolution:
    """Return the stable equilibrium under another load over modulus.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    factor : float
        Load over modulus, relative to the case: a frame of linear material has the shape that this gives it.

    Returns
    -------
    CorotationalSolution
        With forces over that factor.

    Raises
    ------
    NoEquilibriumError
        Where the path of stable equilibrium ends on the way.
    """
    elements = tuple(replace(element, young=element.young / factor) for element in frame.model.elements)
    return solve_large_displacement(
        replace(frame.model, elements=elements),
        PATH_SUBDIVISIONS,
        least_step=LEAST_STEP,
        most_iterations=MOST_ITERATIONS,
        stable=True,
    )


def _deformed(
    case: Case,
    title: str,
    frame: LinkageFrame,
    small: LargeDisplacement,
    loads: Sequence[Load],
) -> LargeDisplacement:
    assert small.buckling is not None
    if small.share > LARGE:
        lead = (
            f"by linear theory the linkage moves by {small.linear:.3g} mm ({small.where}), {100.0 * small.share:.3g} % "
            f"of its span of {small.span:.4g} mm, too far for linear theory (limit {100.0 * LARGE:g} %)"
        )
    elif small.buckling <= small.dead_point:
        lead = (
            f"by linear theory the linkage buckles at {small.buckling:.3g} times its load, too near for linear theory "
            f"(limit {LEAST_FACTOR:g})"
        )
    else:
        lead = (
            f"{small.dead_point:.3g} times its displacements by linear theory take the linkage to a dead point, too "
            f"near for linear theory (limit {LEAST_FACTOR:g})"
        )
    lead = f"{lead}; on its deformed shape "
    try:
        found = followed(frame, 1.0)
    except NoEquilibriumError as error:
        state: State = "unstable" if error.buckled else "no equilibrium"
        how = "buckles" if error.buckled else "gives way"
        kind = "it is unstable beyond" if error.buckled else "a limit load or a snap-through"
        sentence = f"{lead}it does not hold the load: it {how} at {100.0 * error.reached:.3g} % of it ({kind})"
        return replace(small, state=state, held=error.reached, lost=error.failed, points={}, sentence=sentence)
    points = frame.at_points(found.displacements)
    count = len(frame.model.nodes)
    reactions = frame.reactions(found.joint_wrenches[:count], found.residual, found.displacements[:count])
    moved = max((float(np.linalg.norm(d)) for d in points.values()), default=0.0)
    return replace(
        small,
        state="deformed",
        points=points,
        reactions=reactions,
        links={
            link: balanced(
                on_deformed_shape(frame, found, reactions, link, title, case.body(link), loads),
                frame.model.load_scale,
            )
            for link in case.bending_links
        },
        sentence=f"{lead}its points move by up to {moved:.3g} mm; joint forces and verdict come from that shape",
    )


def _largest(frame: LinkageFrame, solution: FrameSolution) -> tuple[float, str]:
    """Largest displacement of nodes and of stations between them [mm], and where."""
    sizes = np.linalg.norm(solution.displacements[:, :3], axis=1)
    node = int(np.argmax(sizes))
    largest, where = float(sizes[node]), frame.model.name(node)
    for i in range(len(frame.model.elements)):
        length = frame.model.length(i)
        between = np.linalg.norm(solution.axis_displacements(i, length * np.array(_ALONG)), axis=1).max()
        if between > largest:
            a, b = frame.model.elements[i].nodes
            largest, where = float(between), f"between {frame.model.name(a)} and {frame.model.name(b)}"
    return largest, where
