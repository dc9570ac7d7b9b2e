"""A linkage as a spatial frame: links as Timoshenko beams, pins that carry all moments but the one about themselves.

Every link with a part is a beam of its section along the x axis of its frame, at the height of its layer; a pin off
the axis sits on a rigid arm, or where the link states an arm to it, on a beam of the same section. Along a slot the two
flanks are beams of their own (``alula.fea.beam.flanks``), of which the pin pushes one. Links without a part are rigid.
The link that the drive holds keeps its angle to the other link at the drive's joint, where the moment about z is the
drive torque; at a slider it keeps its place, and the force along the guide is the drive force. A bonded joint carries
all six components. Between layers a pin is a beam from the one mid-plane to the other.

A pin in a slot stands at a station of its own of the slotted link. It presses on the slot's flanks: they take a force
normal to the slot in the linkage's plane, and the moment about the slot of a pin that would tilt between them. It is
free to slide along the slot, which turns with that station, to turn about its own axis and, having no heads, to shift
along it and to tilt along the slot. A slider is free to slide, and carries all else.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason
from alula.fea.frame.model import FrameModel
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.records.applied import FrictionLoad, LineLoad, Load, PointLoad, shifted
from alula.loads.statics.joint_reaction import JointReaction, travelled
from alula.loads.statics.statics import Drive, Reactions, assemble, unknowns_of
from alula.loads.statics.system import System

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LinkBeam:
    """Which part of a link an element of the frame is.

    Attributes
    ----------
    link : str
        Its name.
    start : float
        x along the link's axis, or along its arm from the arm's foot [mm].
    end : float
        The same beyond ``start`` [mm].
    arm : str
        Name of the point at the arm's end; "" for the link's axis.
    flank : bool
        True for one flank of a slot.
    """

    link: str
    start: float
    end: float
    arm: str = ""
    flank: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageFrame:
    """The frame of a linkage in one pose under one set of loads.

    Attributes
    ----------
    pose : Pose
        The linkage's pose.
    held : Drive or None
        The link that the drive holds, and where; None where nothing is driven.
    bonded : frozenset of str
        Joints whose pins carry moments about their own axis as well.
    loads : tuple of Load
        That act on the links, global axes.
    model : FrameModel
        Nodes, beams, ties, guides and loads.
    points : dict of tuple of 2 str to int
        (link, point) -> node.
    pins : dict of str to tuple of 2 int or None
        Joint -> nodes of its first and its second link, where the pin stands; None on the ground.
    pin_ends : dict of str to int
        Joint between links at different heights -> node at the far end of its pin, where the link is that the pin is
        not built into.
    pin_beams : dict of str to int
        The same joints -> element that is the pin, or what of it goes on from a shorter joint.
    pin_eyes : dict of str to tuple of 2 tuples of 2 str
        The same joints -> (link, point) at either end of that element.
    stations : dict of str to tuple of tuple of float and int
        Link with a part -> (x in the link's frame, node) along its axis; the node may stand off the axis.
    arms : dict of int to ndarray
        Node -> (3,) from it to its link's axis at that station, global axes [mm]; left out where zero.
    beams : dict of int to LinkBeam
        Element -> which part of a link it is; rigid ones are left out, but for beams that a clamp holds.
    notes : tuple of str
        What the reader must know about this frame.
    """

    pose: Pose
    held: Drive | None
    bonded: frozenset[str]
    loads: tuple[Load, ...]
    model: FrameModel
    points: Mapping[tuple[str, str], int]
    pins: Mapping[str, tuple[int | None, int | None]]
    pin_ends: Mapping[str, int]
    pin_beams: Mapping[str, int]
    pin_eyes: Mapping[str, tuple[tuple[str, str], tuple[str, str]]]
    stations: Mapping[str, tuple[tuple[float, int], ...]]
    arms: Mapping[int, Real]
    beams: Mapping[int, LinkBeam]
    notes: tuple[Reason, ...]

    def reactions(self, joint_wrenches: Real, residual: float, displacements: Real | None = None) -> Reactions:
        """Return joint reactions and drive torque of a solution.

        Parameters
        ----------
        joint_wrenches : ndarray, shape (n, 6)
            What all joints together do to each node, global axes [N, N·mm].
        residual : float
            Of the solution, relative.
        displacements : ndarray or None, shape (n, 3), optional
            Of the nodes, where equilibrium holds on the deformed shape [mm].

        Returns
        -------
        Reactions
            The moment about z at the drive's joint is the drive torque, and not in the joint's wrench.
        """
        shape = np.zeros((len(self.model.nodes), 3)) if displacements is None else displacements
        on_link = _joint_by_joint(self, joint_wrenches, shape)
        value = unknowns_of(self.pose.placement, self.held, on_link)
        if self.held is not None and "T" in value:
            on_link[self.held.joint][5] = 0.0
        joints = {
            name: JointReaction(
                joint=name, on=joint.links[1], by=joint.links[0], wrench=on_link[name], arm=self._arm(name, shape)
            )
            for name, joint in self.pose.linkage.joints.items()
        }
        return Reactions(
            pose=self.pose,
            drive=self.held,
            system=self._equilibrium,
            unknowns=np.array(list(value.values())),
            joints=joints,
            drive_torque=float(value.get("T", 0.0)),
            drive_force=float(value.get("P", 0.0)),
            residual=residual,
        )

    @cached_property
    def _equilibrium(self) -> System:
        """Of the moving links in the plane: the same for all solutions of the frame."""
        return assemble(self.pose.placement, self.held, self.loads)

    def meets_first(self, name: str) -> bool:
        """Return whether the pin of a joint between layers ends at its first link, which it is not built into.

        Parameters
        ----------
        name : str

        Returns
        -------
        bool
        """
        return self.pin_eyes[name][1][0] == self.pose.linkage.joints[name].links[0]

    def _arm(self, name: str, shape: Real) -> Real:
        """From the point of a joint's first link to its pin (3,), with the nodes displaced by ``shape`` (n, 3)."""
        linkage, arm = self.pose.linkage, travelled(self.pose.placement, name)
        if not linkage.joints[name].slides and name not in self.pin_beams:
            return arm  # one place in both links
        first, second = linkage.joints[name].links
        if second != linkage.ground:
            arm = arm + shape[self.points[second, linkage.point_of(name, second)]]
        if first != linkage.ground:
            arm = arm - shape[self.points[first, linkage.point_of(name, first)]]
        return arm

    def at_points(self, displacements: Real) -> dict[tuple[str, str], Real]:
        """Return the displacement of every link's point.

        Parameters
        ----------
        displacements : ndarray, shape (n, 3 or more)
            Of the nodes [mm].

        Returns
        -------
        dict of tuple of 2 str to ndarray
            (link, point) and its displacement (3,) [mm].
        """
        return {key: np.asarray(displacements[node, :3]) for key, node in self.points.items()}


def out_of_plane(loads: Sequence[Load]) -> bool:
    """Return True if any load but friction has a force along z or a moment about x or y.

    Parameters
    ----------
    loads : sequence of Load
        Global axes.

    Returns
    -------
    bool
        Whether any acts out of the linkage's plane.
    """
    for load in loads:
        if isinstance(load, FrictionLoad):
            continue  # between layers, which are a frame anyway
        if isinstance(load, PointLoad):
            found = load.wrench[..., 2:5]
        elif isinstance(load, LineLoad):
            found = np.array([load.at_start[..., 2], load.at_end[..., 2]])
        else:
            found = load.specific_force[..., 2]
        if np.any(found != 0.0):
            return True
    return False


def _joint_by_joint(frame: LinkageFrame, joint_wrenches: Real, shape: Real) -> dict[str, Real]:
    """What each joint does to its second link (6,), told apart where several joints share a node.

    A node with one joint gives that joint; taking it off the other link's node may leave one joint there, and so on.
    Where a pin has slid in its slot by what the nodes are displaced (``shape``), its force is moved along.
    """
    linkage = frame.pose.linkage
    left = joint_wrenches.copy()
    ends = {
        name: {link: node for link, node in zip(linkage.joints[name].links, nodes, strict=True) if node is not None}
        for name, nodes in frame.pins.items()
    }

    def moved(wrench: Real, start: int | None, end: int | None) -> Real:
        away = [np.zeros(3) if node is None else shape[node] for node in (start, end)]
        return shifted(wrench, away[0] - away[1])

    found: dict[str, Real] = {}
    for name, end in frame.pin_ends.items():
        held_by, wrench = frame.pins[name][1], -left[end]
        found[name] = wrench
        if frame.meets_first(name):
            held_by = frame.pins[name][0]
            found[name] = shifted(-wrench, np.array([0.0, 0.0, -linkage.rise(name)]))
        if held_by is not None:
            left[held_by] -= wrench
    while len(found) < len(ends):
        open_at: dict[int, list[tuple[str, str]]] = {}
        for name, nodes in ends.items():
            for link, node in nodes.items() if name not in found else ():
                open_at.setdefault(node, []).append((name, link))
        single = next((at for at in open_at.items() if len(at[1]) == 1), None)
        if single is None:
            names = sorted({name for at in open_at.values() for name, _ in at})
            raise CaseError(
                f"joints: {', '.join(names)} join the same links at one pin in a ring, so their forces cannot be told "
                "apart; remove one of them"
            )
        node, [(name, link)] = single
        wrench = left[node].copy()
        first, second = frame.pins[name]
        found[name] = wrench if link == linkage.joints[name].links[1] else moved(-wrench, first, second)
        for other, other_node in ends[name].items():
            left[other_node] += -wrench if other == link else moved(wrench, node, other_node)
    return found
