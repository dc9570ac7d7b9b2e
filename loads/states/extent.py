"""The box that a linkage takes up along the global axes: at its pose, and over its motion."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from alula.geometry.clearance.least import Spot
from alula.geometry.clearance.reach import Sides, Standing, reaches, reaches_at
from alula.geometry.clearance.shape import point_shape
from alula.geometry.linkage.motion import Motion, ends_of
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.layers import slab
from alula.loads.records.check_spec import SizeCheck
from alula.loads.states.actions import lasting
from alula.loads.states.clearance import Assembly, Clearance, along, assembly, start_of, way_of
from alula.loads.states.flapping import wing_span
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import Reason, reason

_NEAR = 1e-6
"""Share of the longest link to which the box over a motion is found."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Extent:
    """The box about all outlines of a linkage, over all poses.

    Attributes
    ----------
    assembly : Assembly
        The outlines of links with a part, and of pins.
    pose : Pose
        The stated one.
    motion : Motion or None
        Over which the box is; None where the case states none, and it is that of the pose.
    reaches : tuple of (Outermost, Outermost)
        Along x, y and z: how far outlines reach to the side of small values, and to that of large ones.
    """

    assembly: Assembly
    pose: Pose
    motion: Motion | None
    reaches: Sides

    @cached_property
    def outlines(self) -> tuple[Standing, ...]:
        """What the box is about."""
        return tuple(_outlines(self.assembly))

    @property
    def stated(self) -> Placement:
        """The stated pose, as one of one."""
        return Placement(closure=self.pose.closure, q=self.pose.q[None])

    def shown(self, count: int) -> Placement:
        """Return poses for a picture: some over the motion, and those at which it reaches furthest.

        Parameters
        ----------
        count : int
            Of poses that are evenly spread.

        Returns
        -------
        Placement
            The stated pose alone where there is no motion.
        """
        if self.motion is None:
            return self.stated
        first, last = ends_of(self.motion.angles)
        furthest = [side.at for sides in self.reaches for side in sides if side.at is not None]
        return along(self.motion)(np.array([*np.linspace(first, last, count), *furthest]))


def extent(case: Case, pose: Pose, known: Clearance | None = None) -> Extent:
    """Return the box about the outlines of a case over its motion, or at its pose where it states none.

    Parameters
    ----------
    case : Case
    pose : Pose
        The stated one, or where the linkage balances if it is let go.
    known : Clearance, optional
        Of the case, with its outlines and its motion, where it was found before.

    Returns
    -------
    Extent

    Raises
    ------
    CaseError
        Where the motion does not exist.
    """
    found = assembly(case) if known is None else known.assembly
    outlines = tuple(_outlines(found))
    if not case.sweeps:
        at_rest = Placement(closure=pose.closure, q=pose.q[None])
        return Extent(assembly=found, pose=pose, motion=None, reaches=reaches_at(outlines, at_rest))
    motion = way_of(case, pose) if known is None or known.motion is None else known.motion
    near = _NEAR * case.linkage.longest
    told = reaches(outlines, along(motion), start_of(motion), near=near)
    return Extent(assembly=found, pose=pose, motion=motion, reaches=told)


def _outlines(found: Assembly) -> Iterator[Standing]:
    """Yield the outlines of links, pins and wings; those of links without a part are their points.

    A wing is a plate along its link's axis, with its chord to either side of the link's mid-plane.
    """
    case = found.case
    for link, record in case.links.items():
        if link in found.links:
            yield found.links[link], Spot(link=link)
        else:
            yield point_shape(f"link {link}", list(record.points.values()), *slab(case, link)), Spot(link=link)
    for joint, pin in found.pins.items():
        yield pin, found.spot(joint)
    for wing in case.wings:
        first, last, chord = wing_span(wing, case)
        level, half = case.heights[wing.link], max(chord) / 2.0
        ends = [(first, 0.0), (last, 0.0)]
        yield point_shape(f"wing of {wing.link}", ends, level - half, level + half, joined=True), Spot(link=wing.link)


def unmeasured(case: Case) -> tuple[Reason, ...]:
    """Return what the box of a case does not hold, or not all of.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of Reason
    """
    found = [reason("beyond_points", link=link) for link in case.links if case.links[link].part is None]
    winged = {wing.link for wing in case.wings}
    carrying = [link for link in dict.fromkeys(carried.link for carried in case.carried) if link not in winged]
    found += [reason("what_links_carry", links=carrying)] if carrying else []
    return (*found, *(reason("spring_or_tendon", kind=one.kind, name=one.name) for one in lasting(case)))


def size_caveats(case: Case) -> Iterator[Caveat]:
    """Yield what a check of the size leaves out.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    if any(isinstance(check, SizeCheck) for check in case.all_checks.values()):
        yield from (Caveat(topic=Topic.SIZE, what=reason("size_of", what=what)) for what in unmeasured(case))
