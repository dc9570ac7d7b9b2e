"""How joints hold a link for its own vibration: as if its neighbours, and all pins, did not yield.

A link rings by itself at the frequencies that it has between neighbours that stand still. So what each joint keeps from
moving in the frame of the linkage (``alula.fea.frame.build``) is held here, at the place where its pin stands in the
pose:

pin            the pin's place does not move, and the bore keeps the direction of the pin; it is free to turn about it
drive          at its joint the link does not turn about the pin either, nor slide along the guide
bonded joint   nothing moves
pin in a slot  on the link with the pin and on the one with the slot alike: no displacement across the slot, and no tilt
               about the slot's direction; all else is free
slider         all but the displacement along its guide

Between layers a pin that may run in a hole (``running_holes``) keeps no direction of the bore at the low ends of bands.
A pin that slides in several slots is held in all their directions. The ground's part is held where its support holds
it, and its joints hold nothing: the links there hang on it. What motions of the rigid link are left free by all that
(a link with a single pin turns about it) are no vibration.
"""

from collections.abc import Container, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.geometry.joints.joint_kinds import MOVES, TURNS
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case

Real = NDArray[np.float64]
_SAME = 1e-6
"""Sine of the angle below which two directions count as one, and share of a rigid motion that counts as none."""
X, Y, Z = np.eye(3)


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldPlace:
    """What joints hold at one place of a link.

    Attributes
    ----------
    point : str
        Name of the link's point.
    place : ndarray, shape (3,)
        Where the pin stands, in the link's frame [mm].
    moves : ndarray, shape (k, 3)
        Directions in which it does not move: orthogonal unit vectors in the link's axes.
    turns : ndarray, shape (l, 3)
        Axes about which it does not turn, alike.
    joint : str
        Of a slot or guide that the link has, whose pin stands there; "" at the link's own points.
    flank : bool
        True where that pin bears on the flank of a slot in the part, which is held on average alone.
    """

    point: str
    place: Real
    moves: Real
    turns: Real
    joint: str = ""
    flank: bool = False

    @property
    def conditions(self) -> Real:
        """Rows (k + l, 6) on the translation and the rotation of the rigid link about its origin."""
        moved = np.hstack([self.moves, np.cross(self.place, self.moves)])
        return np.vstack([moved, np.hstack([np.zeros_like(self.turns), self.turns])])


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkHolding:
    """How a link is held.

    Attributes
    ----------
    places : tuple of HeldPlace
        The link's own points once each, and every pin in its slots and guides.
    free : int
        Number of motions of the rigid link that are left.
    how : Reason
        For people.
    """

    places: tuple[HeldPlace, ...]
    free: int
    how: Reason


def link_holding(case: Case, link: str, pose: Pose, *, running: Container[str] = ()) -> LinkHolding:
    """Return how joints hold a link in a pose.

    Parameters
    ----------
    case : Case
    link : str
        With a part.
    pose : Pose
        In which pins stand in slots, and slots in their directions.
    running : container of str, optional
        Joints whose pins tilt freely in a hole.

    Returns
    -------
    LinkHolding
    """
    found: dict[tuple[str, str], tuple[list[Real], list[Real]]] = {}
    at: dict[tuple[str, str], Real] = {}
    support = case.links[link].held_at
    if link == case.linkage.ground:
        if support is not None:
            found[support, ""], at[support, ""] = ([X, Y, Z], [X, Y, Z]), _point(case, link, support)
    else:
        for joint in case.linkage.joints_of(link):
            point = case.linkage.point_of(joint, link)
            carries = case.joints[joint].carrier == link
            key = (point, joint if carries else "")
            moves, turns = found.setdefault(key, ([], []))
            more = _held(case, link, joint, pose)
            moves += more[0]
            turns += [axis for axis in more[1] if joint not in running or axis is Z]
            at[key] = _pin_place(case, link, joint, pose) if key[1] else _point(case, link, point)
    places = tuple(
        HeldPlace(
            point=point,
            place=at[point, joint],
            moves=_basis(moves),
            turns=_basis(turns),
            joint=joint,
            flank=bool(joint) and point in case.links[link].slots,
        )
        for (point, joint), (moves, turns) in found.items()
    )
    free = 6 - _rank(places, case.linkage.longest)
    return LinkHolding(places=places, free=free, how=_how(case, link, places, free))


def _held(case: Case, link: str, joint: str, pose: Pose) -> tuple[list[Real], list[Real]]:
    """Directions in which a joint holds a link, and axes about which it does, in the link's axes."""
    record, drive = case.linkage.joints[joint], case.pinned_drive
    driven = drive is not None and drive.joint == joint and not drive.idle
    ways = record.bears | record.kind.driven if driven else record.bears
    axes = [X, Y, Z]
    if record.carrier is not None:
        angle = pose.angles[record.carrier] + record.direction - pose.angles[link]
        axes[:2] = [np.array([np.cos(at), np.sin(at), 0.0]) for at in (angle, angle + np.pi / 2.0)]
    moves, turns = ([axis for way, axis in zip(every, axes, strict=True) if way in ways] for every in (MOVES, TURNS))
    return moves, turns


def _point(case: Case, link: str, point: str) -> Real:
    return np.array([*case.links[link].points[point], 0.0])


def _pin_place(case: Case, link: str, joint: str, pose: Pose) -> Real:
    """Where a joint's pin stands in its slot, in the frame of the link that has it (3,)."""
    other = case.joints[joint].links[1]
    pin = pose.position(other, case.linkage.point_of(joint, other))
    return np.array([*(pose.rotation(link).T @ (pin - pose.origins[link])), 0.0])


def _basis(rows: Sequence[Real]) -> Real:
    """Orthogonal unit vectors (k, 3) that span the same directions."""
    if not rows:
        return np.zeros((0, 3))
    _, sizes, axes = np.linalg.svd(np.array(rows))
    return np.asarray(axes[: np.count_nonzero(sizes > _SAME)])


def _rank(places: Sequence[HeldPlace], size: float) -> int:
    """Number of the six motions of the rigid link that are held."""
    if not places:
        return 0
    rows = np.vstack([place.conditions for place in places]) * [1.0, 1.0, 1.0, *[1.0 / size] * 3]
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    return int(np.linalg.matrix_rank(rows, tol=_SAME))


def _how(case: Case, link: str, places: Sequence[HeldPlace], free: int) -> Reason:
    drive = case.pinned_drive
    driven = drive is not None and not drive.idle and link in case.joints[drive.joint].links
    drive_point = case.linkage.point_of(drive.joint, link) if drive is not None and driven else None
    groups: dict[str, dict[str | Reason, None]] = {}
    for place in places:
        sizes = len(place.moves), len(place.turns)
        if sizes == (3, 3):
            kind = "built_in"
        elif sizes == (3, 2):
            kind = "on_rigid_pins"
        elif sizes == (2, 3):
            kind = "in_guide"
        elif sizes[0] == 3:
            kind = "on_tilting_pins"
        else:
            kind = "across_slot"
        name = place.joint or place.point
        groups.setdefault(kind, {})[reason("drive_joint", joint=name) if name == drive_point else name] = None
    return reason("held", ways=tuple(reason(kind, at=tuple(names)) for kind, names in groups.items()), free=free)
