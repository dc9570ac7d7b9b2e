"""How far the links of a layered case stay from one another: at its pose, and over its motion."""

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.base.ties import first_least, ranked
from alula.geometry.clearance.least import Gap, Pair, Spot, gap_at, least_gap, width_at
from alula.geometry.clearance.shape import Shape, link_shape, pin_shape
from alula.geometry.linkage.motion import Motion, ends_of, solve_motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.forks import levels
from alula.loads.case.layers import on_one_axis, slab
from alula.loads.states.case_motion import drive_angles
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import reason

Real = NDArray[np.float64]

_POSES = 181
"""Poses of the motion to begin with."""
_NEAR = 1e-4
"""Share of the longest link to which the least gap over a motion is found."""
_STEP = np.radians(0.01)
"""Of an angle, to which the first contact is found [rad]; of a travel, over the longest link."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Assembly:
    """The outlines of a layered case.

    Attributes
    ----------
    case : Case
        The case.
    links : mapping of str to Shape
        By link, of those that have a part, in their frames.
    pins : mapping of str to Shape
        By joint, of those that state a diameter.
    """

    case: Case
    links: Mapping[str, Shape]
    pins: Mapping[str, Shape]

    def spot(self, joint: str) -> Spot:
        """Return where the pin of a joint stands: in the second of its links.

        Parameters
        ----------
        joint : str
            Its name.

        Returns
        -------
        Spot
        """
        return Spot(link=self.case.joints[joint].links[1], point=self.case.linkage.joint_points(joint)[1])

    @cached_property
    def holders(self) -> dict[str, set[str]]:
        """Joint -> the links that its pin belongs to: those of all joints on one axis."""
        found: dict[str, set[str]] = {}
        for names in on_one_axis(self.case):
            held = {link for name in names for link in self.case.joints[name].links}
            found |= dict.fromkeys(names, held)
        return found

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """All outlines that lie at one height and are not made to touch."""
        return tuple(pair for pair in self._pairs() if pair is not None)

    def _pairs(self) -> Iterator[Pair | None]:
        joints = self.case.linkage.joints.values()
        guided = {frozenset(joint.links) for joint in joints if joint.bears_moment}
        for one, other in itertools.combinations(self.links, 2):
            if frozenset((one, other)) not in guided:
                yield Pair.of((self.links[one], Spot(link=one)), (self.links[other], Spot(link=other)))
        for joint, pin in self.pins.items():
            for link in self.links.keys() - self.holders[joint]:
                yield Pair.of((self.links[link], Spot(link=link)), (pin, self.spot(joint)))


def assembly(case: Case) -> Assembly:
    """Return the outlines of a case.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    Assembly
        Of its links with a part and of its pins.
    """
    slabs = {link: slab(case, link) for link in case.links}
    pins = {}
    for name, joint in case.joints.items():
        if joint.pin_diameter is not None and joint.kind.has_pin:
            ends = [z for link in joint.links for z in slabs[link]]
            pins[name] = pin_shape(f"pin {name}", joint.pin_diameter, min(ends), max(ends))
    links = {link: link_shape(f"link {link}", case.body(link), list(levels(case, link))) for link in case.checked_links}
    return Assembly(case=case, links=links, pins=pins)


@dataclass(frozen=True, kw_only=True, eq=False)
class Clearance:
    """The gaps of an assembly.

    Attributes
    ----------
    assembly : Assembly
        The outlines.
    pose : Pose
        The stated one.
    motion : Motion or None
        Over which the gaps are; None where the case states none, and they are those of the pose.
    gaps : tuple of Gap
        By their size, the least first; those of pairs that stay further apart than any other are left out.
    """

    assembly: Assembly
    pose: Pose
    motion: Motion | None
    gaps: tuple[Gap, ...]

    @property
    def least(self) -> Gap | None:
        """The least gap; None where nothing lies at one height."""
        return self.gaps[0] if self.gaps else None

    @cached_property
    def contact(self) -> Gap | None:
        """The gap of the pair that touches first; None where none does."""
        touching = [gap for gap in self.gaps if gap.touches and gap.at is not None]
        if not touching or self.motion is None:
            return None
        start = float(self.motion.angles[0])
        ways = [abs((gap.at or 0.0) - start) for gap in touching]
        return touching[first_least(ways, self.motion.coordinate.measure.scale(self.motion.linkage))]

    @property
    def shown(self) -> Gap | None:
        """The gap that is worth a picture: the first contact, else the least."""
        return self.contact or self.least

    @property
    def stated(self) -> Placement:
        """The stated pose, as one of one."""
        return _single(self.pose)

    def placed(self, gap: Gap) -> Placement:
        """Return the pose, as one of one, at which a gap was found.

        Parameters
        ----------
        gap : Gap
            One of the gaps.

        Returns
        -------
        Placement
        """
        if gap.at is None or self.motion is None:
            return self.stated
        return along(self.motion)(np.array([gap.at]))

    def where(self, gap: Gap) -> str:
        """Say at which pose and place a gap was found.

        Parameters
        ----------
        gap : Gap
            One of the gaps.

        Returns
        -------
        str
        """
        tiny = 1e-6 * self.assembly.case.linkage.longest
        x, y = (0.0 if abs(value) < tiny else value for value in gap.place)
        at = "in the stated pose"
        if gap.at is not None and self.motion is not None:
            at = f"at {self.motion.coordinate} = {float(self.motion.told(gap.at)):.2f} {self.motion.unit}"
        return f"{at}, x = {x:.4g}, y = {y:.4g} mm".replace("= -", "= −")


def _single(pose: Pose) -> Placement:
    return Placement(closure=pose.closure, q=pose.q[None])


def along(motion: Motion) -> Callable[[Real], Placement]:
    """Return what takes values of a motion's coordinate to poses with rates by it.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    callable
        Of values (n,) [rad, mm].
    """

    def at(values: Real) -> Placement:
        q = motion.track.at(values)
        first, second = motion.track.driven.coefficients(q)
        return Placement(closure=motion.closure, q=q, qdot=first, qddot=second)

    return at


def way_of(case: Case, pose: Pose) -> Motion:
    """Return the motion that a case states, through a pose: once over its range, evenly.

    Parameters
    ----------
    case : Case
        With a motion.
    pose : Pose

    Returns
    -------
    Motion
    """
    assert case.motion is not None
    angles = np.linspace(*ends_of(drive_angles(case, pose)), case.motion.poses)
    return solve_motion(pose, angles, coordinate=case.motion_coordinate)


def start_of(motion: Motion) -> Real:
    """Return the values of a motion's coordinate at which outlines are looked at first.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    array (181,)
        From its first pose to its last, or over all that it goes through [rad, mm].
    """
    return np.linspace(*ends_of(motion.angles), _POSES)


def collision_caveats(case: Case) -> Iterator[Caveat]:
    """Yield that nobody looks if links with a part run into each other, since none states how they lie.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    if not case.stacked and len(case.checked_links) > 1:
        yield Caveat(topic=Topic.COLLISIONS, what=reason("collisions_and_couples"), why=reason("no_layer_stated"))


def clearance(case: Case, pose: Pose | None = None) -> Clearance | None:
    """Return the gaps of a case over its motion, or at its pose where it states none.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose, optional
        The stated one, or where the linkage balances if it is let go; assembled anew when left out.

    Returns
    -------
    Clearance or None
        None where no layers are stated.

    Raises
    ------
    CaseError
        Where two links, or a link and a pin, lie in each other in the stated pose; where the motion does not exist.
    """
    if not case.stacked:
        return None
    found, pose = assembly(case), pose or case.solve_pose()
    at_rest = _single(pose)
    gaps = [] if case.sweeps else [gap_at(pair, at_rest) for pair in found.pairs]
    widths = [width_at(pair, at_rest) for pair in found.pairs] if case.sweeps else [gap.value for gap in gaps]
    for pair, width in zip(found.pairs, widths, strict=True):
        if width < 0.0 and (gap := gap_at(pair, at_rest)).high < 0.0:
            raise CaseError(_through(case, pair, gap))
    if not case.sweeps:
        return Clearance(assembly=found, pose=pose, motion=None, gaps=_sorted(case, gaps))
    motion = way_of(case, pose)
    longest, start, at = case.linkage.longest, start_of(motion), along(motion)
    step, begun = _STEP * motion.coordinate.measure.scale(motion.linkage), (start, at(start))
    over: list[Gap] = []
    for number in ranked(widths, longest):
        pair = found.pairs[number]
        enough = max(min((gap.value for gap in over), default=np.inf), 0.0)
        least = least_gap(pair, at, begun, near=_NEAR * longest, step=step, enough=enough)
        over += [] if least is None else [least]
    return Clearance(assembly=found, pose=pose, motion=motion, gaps=_sorted(case, over))


def _sorted(case: Case, gaps: list[Gap]) -> tuple[Gap, ...]:
    return tuple(gaps[number] for number in ranked([gap.value for gap in gaps], case.linkage.longest))


def _through(case: Case, pair: Pair, gap: Gap) -> str:
    """Say that two outlines lie in each other in the stated pose, and what would part them."""
    x, y = gap.place
    one, other = sorted(pair.at, key=lambda spot: spot.point is not None)
    if other.point is not None:
        return (
            f"links.{one.link}: {pair.other.name if pair.at[1].point else pair.one.name} goes through link {one.link}, "
            f"which it does not belong to, in the stated pose at x = {x:.4g}, y = {y:.4g} mm; give link {one.link} a "
            "layer that the pin does not cross, or move one of them"
        )
    shared = [name for name, joint in case.joints.items() if {one.link, other.link} == set(joint.links)]
    entries = " and ".join(f"{_entry(case, spot.link)}" for spot in (one, other))
    why = f"they share joint {shared[0]}, so their eyes lie in each other" if shared else (
        f"they lie in each other in the stated pose at x = {x:.4g}, y = {y:.4g} mm"
    )  # fmt: skip
    return (
        f"links.{one.link}, links.{other.link}: with {entries} {why}; give one of them another layer, or the "
        "layers more distance"
    )


def _entry(case: Case, link: str) -> str:
    record = case.links[link]
    return f"layer = {record.layer} of {link}" if record.layer is not None else f"z = {record.z or 0.0:g} mm of {link}"
