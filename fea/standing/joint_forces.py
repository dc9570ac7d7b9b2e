"""Joint forces of a case: from equilibrium alone where it gives them, from the spatial frame where it does not."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.frame.linkage_frame import out_of_plane
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.states.play import Play, free_motion
from alula.loads.statics.statics import Drive, Reactions, assemble, refuse_dead_point, solve_statics

if TYPE_CHECKING:
    from alula.fea.frame.condensed import LinkFlexibility
    from alula.fea.frame.linear import FrameSolution
    from alula.fea.frame.linkage_frame import LinkageFrame
    from alula.fea.pins.states import PinStates

Real = NDArray[np.float64]

PINNED_STATICS = "equilibrium of pinned links"
BONDED_STATICS = "equilibrium of links, some of them bonded"
PINNED_FRAME = "spatial frame with pins free about their own axis"
BONDED_FRAME = "spatial frame with bonded joints"
LAYERED_FRAME = "spatial frame of links in layers, with pins as beams between them"
OF_SOLIDS = {
    PINNED_FRAME: "spatial frame of the links' solids with pins free about their own axis",
    BONDED_FRAME: "spatial frame of the links' solids with bonded joints",
    LAYERED_FRAME: "spatial frame of the links' solids in layers, with pins as beams between them",
}
"""The same where links are no beams but condensed solids."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Deviation:
    """The answer with one cause of doubt about the links' stiffness at its end.

    Attributes
    ----------
    source : Source or None
        The cause; None for a pin that sinks into its bore, which no band holds.
    reactions : Reactions
        Joint forces and drive torque.
    points : mapping of tuple of 2 str to ndarray
        (link, point) -> its displacement (3,) [mm].
    """

    source: Source | None
    reactions: Reactions
    points: Mapping[tuple[str, str], Real]


@dataclass(frozen=True, kw_only=True, eq=False)
class JointForces:
    """Joint forces of one load case in the pose as it stands.

    Attributes
    ----------
    reactions : Reactions
        Joint forces and drive torque; between layers with pins that stand in their holes as their clearances are.
    model : str
        Which one gave them.
    reason : Reason
        Why.
    frame : LinkageFrame or None
        Of the linkage where the model is a frame; None for equilibrium alone.
    solution : FrameSolution or None
        Of that frame, with pins that are tight; None for equilibrium alone.
    solids : tuple of str
        Links that are condensed solids in the frame.
    deviations : tuple of Deviation
        What the stiffness of condensed solids leaves open; empty where no link is one.
    play : Play or None
        What the play of pins does under the load case; None where no joint has play.
    pins : PinStates or None
        How pins stand between layers; None where none may run.
    """

    reactions: Reactions
    model: str
    reason: Reason | str
    frame: "LinkageFrame | None" = None
    solution: "FrameSolution | None" = None
    solids: tuple[str, ...] = ()
    deviations: tuple[Deviation, ...] = ()
    play: Play | None = None
    pins: "PinStates | None" = None

    @cached_property
    def sharings(self) -> tuple[Reactions, ...]:
        """Joint forces with pins that stand otherwise in their holes, in which links and pins bear most and least.

        Empty without layers, and where nothing is open. Solved where they are asked for, since they are dozens.
        """
        return () if self.pins is None else self.pins.ends

    @cached_property
    def on_tight_pins(self) -> Reactions:
        """Joint forces with pins that are tight in both links, of which ``deviations`` tell what stiffness changes."""
        if self.pins is None or self.frame is None or self.solution is None:
            return self.reactions
        return self.frame.reactions(self.solution.joint_wrenches, self.solution.residual)

    @property
    def beside_tight_pins(self) -> "JointForces":
        """The same, told as what pins that run change of tight ones: numbers on the deformed shape have tight pins."""
        return replace(self, reactions=self.on_tight_pins)

    @property
    def by_equilibrium(self) -> bool:
        """True where equilibrium alone gave them, or all of them that acts in the plane."""
        return self.frame is None or self.model == LAYERED_FRAME

    @property
    def open_by(self) -> tuple[Deviation, ...]:
        """The deviations that bands hold: all but the sinking of pins."""
        return tuple(one for one in self.deviations if one.source is not None)

    @property
    def sources(self) -> tuple[Source, ...]:
        """What makes joint forces uncertain that depend on the links' stiffness."""
        return distinct(tuple(one.source for one in self.deviations if one.source is not None))

    def displaced(self, link: str, point: str, *, meshes: float = 1.0, sunk: bool = False) -> Band:
        """Return how far a point moves by a frame of solids on tight pins, with all that stiffness leaves open.

        Parameters
        ----------
        link : str
            On which the point lies.
        point : str
            Its name.
        meshes : float, optional
            Share of what meshes of solids leave open that the band holds.
        sunk : bool, optional
            Whether pins may sink into their bores.

        Returns
        -------
        Band
            [mm]
        """
        assert self.frame is not None
        assert self.solution is not None
        moved = self.frame.at_points(self.solution.displacements)[link, point]
        size = float(np.linalg.norm(moved))
        along = moved / (size or 1.0)
        every = self.deviations if sunk else self.open_by
        kinds = [one.source and one.source.kind for one in every]
        parts = [meshes if kind is SourceKind.DISCRETISATION else 1.0 for kind in kinds]
        steps = np.array(parts) * [float(along @ one.points[link, point]) - size for one in every]
        low, high = float(np.minimum(steps, 0.0).sum()), float(np.maximum(steps, 0.0).sum())
        return Band(value=size, low=max(size + low, 0.0), high=size + high)

    @property
    def condition(self) -> float:
        """Condition number of the scaled equations that gave the forces (2-norm; of a frame, 1-norm)."""
        return self.reactions.system.condition if self.solution is None else self.solution.condition


def joint_forces(case: Case, pose: Pose, loads: Sequence[Load], like: "PinStates | None" = None) -> JointForces:
    """Return the joint forces under loads, by the simplest model that has them.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.
    like : PinStates, optional
        How pins may stand in a pose, and under loads, like these: where the search for how they do here starts.

    Returns
    -------
    JointForces
        With the model that gave them.

    Raises
    ------
    CaseError
        Where no model has them, such as at a dead point of the driven link.
    """
    bonded = [name for name, joint in case.linkage.joints.items() if joint.fixed]
    which = reason("all_joints_bonded") if case.joint_model == "bonded" else _named(case, bonded)
    model = BONDED_FRAME if bonded else PINNED_FRAME
    system = assemble(pose.placement, case.pinned_drive, ())
    rows, columns = system.matrix.shape
    if out_of_plane(loads):
        why = reason("load_out_of_plane")
    elif columns > rows:
        why = reason("more_constraints")
        if bonded:
            why = reason("case_says_and_so", which=which, why=why)
    elif case.layered:
        model, why = LAYERED_FRAME, reason("layers_make_couples")
    else:
        why = reason("loads_in_plane")
        return JointForces(
            reactions=solve_statics(pose, case.pinned_drive, loads),
            model=BONDED_STATICS if bonded else PINNED_STATICS,
            reason=reason("case_says", which=which, why=why) if bonded else why,
        )
    refuse_dead_point(system, case.pinned_drive)
    frame, solution = solved_frame(case, pose, loads, case.pinned_drive)
    return on_pins(
        case,
        JointForces(
            reactions=frame.reactions(solution.joint_wrenches, solution.residual),
            model=model,
            reason=together(why, *frame.notes),
            frame=frame,
            solution=solution,
        ),
        like,
    )


def on_pins(case: Case, tight: JointForces, like: "PinStates | None" = None) -> JointForces:
    """Return joint forces with pins that stand in their holes between layers.

    Parameters
    ----------
    case : Case
    tight : JointForces
        By a frame, with pins that are tight.
    like : PinStates, optional
        As of ``joint_forces``.

    Returns
    -------
    JointForces
    """
    if tight.frame is None or tight.solution is None:
        return tight
    reactions, pins = stood(case, tight.frame, tight.solution)
    if pins is None:
        return tight
    return replace(tight, reactions=reactions, pins=pins if like is None else pins.beside(like))


def stood(case: Case, frame: "LinkageFrame", solution: "FrameSolution") -> "tuple[Reactions, PinStates | None]":
    """Return what joints bear as pins stand in their holes, and how else they may.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
    solution : FrameSolution
        Of that frame, with pins that are tight.

    Returns
    -------
    tuple of (Reactions, PinStates or None)
        None where no pin between layers may run.
    """
    from alula.fea.pins.states import pin_states

    pins = pin_states(case, frame)
    if pins is None:
        return frame.reactions(solution.joint_wrenches, solution.residual), None
    return pins.reactions(pins.value), pins


def solved_frame(
    case: Case,
    pose: Pose,
    loads: Sequence[Load],
    held: Drive | None,
    *,
    bonded: bool = False,
    solids: "Mapping[str, LinkFlexibility] | None" = None,
) -> "tuple[LinkageFrame, FrameSolution]":
    """Return the frame of the linkage and its solution; most linkages need none, and do not import it.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.
    held : Drive or None
        The drive that holds a link.
    bonded : bool, optional
        True where all pins carry moments about their own axis as well, and not only bonded joints.
    solids : mapping of str to LinkFlexibility, optional
        Links that are condensed solids.

    Returns
    -------
    tuple of LinkageFrame and FrameSolution
    """
    from alula.fea.frame.build import build_frame
    from alula.fea.frame.linear import solve_frame

    frame = build_frame(case, pose, loads, held=held, bonded=bonded, solids=solids)
    return frame, solve_frame(frame.model)


def _named(case: Case, bonded: Sequence[str]) -> Reason:
    """Return which joints are bonded, and which clamped."""
    held = [name for name in bonded if case.linkage.joints[name].clamped]
    return reason("joints_bonded", bonded=[name for name in bonded if name not in held], clamped=held)


@dataclass(frozen=True, kw_only=True)
class WayToHold:
    """How far a point moves with the linkage held in one way.

    Attributes
    ----------
    name : str
        Of the way.
    displacement : ndarray, shape (3,)
        Global axes [mm].
    play : float
        How far play lets the point go to either side beside that [mm].
    """

    name: str
    displacement: Real
    play: float = 0.0

    @property
    def size(self) -> float:
        """Length of the displacement [mm]."""
        return float(np.linalg.norm(self.displacement))


def ways_to_hold(case: Case, pose: Pose, loads: Sequence[Load]) -> tuple[WayToHold, ...]:
    """Return how far the point that the case names moves: held at each link on the ground, and bonded all over.

    Linear frames in the pose as it stands.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.

    Returns
    -------
    tuple of WayToHold
        One per way; none where the case does not ask.
    """
    asked = case.ways_to_hold
    if asked is None:
        return ()
    found = []
    ground = case.linkage.ground
    drives: Mapping[str, Drive] = {
        link: Drive(link=link, joint=name)
        for name, joint in case.joints.items()
        if not joint.slides and ground in joint.links
        for link in joint.links
        if link != ground
    }
    names = ", ".join(drive.joint for drive in drives.values())
    ways = [(f"pinned, held at {link}", drive, False) for link, drive in drives.items()]
    ways.append((f"bonded, {names} built in", next(iter(drives.values())), True))
    for name, drive, bonded in ways:
        frame, solution = solved_frame(case, pose, loads, drive, bonded=bonded)
        moved = frame.at_points(solution.displacements)
        loose = 0.0 if bonded else free_motion(case, pose.placement, drive, asked.link, asked.at)
        found.append(WayToHold(name=name, displacement=moved[asked.link, asked.at], play=loose))
    return tuple(found)
