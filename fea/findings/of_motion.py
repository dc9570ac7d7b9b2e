"""What a report tells of a motion besides poses, joint forces and torque: gaps, play, air, friction, dead points.

It is found once, before anything is told.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.motion.linkage_history import LinkageOverMotion, asked_over_motion
from alula.fea.whole.air_range import air_range
from alula.fea.whole.rubbed_motion import work_between
from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.loads.states.clearance import Clearance, clearance
from alula.loads.states.dead_point_reach import least_dead_point_distance, way_to_dead_point
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.instant_centre import InstantCentre, instant_centre
from alula.loads.states.loose_motion import loose_motion

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, eq=False)
class PointPlay:
    """How far play lets a point move over a motion, with the drive held.

    Attributes
    ----------
    outline : complex array (n, directions)
        Of where it may be about its place without play [mm]; NaN at a dead point.
    free : array (n,)
        How far it may go to either side [mm]; infinite where play may take the linkage through a dead point.
    farthest : tuple of (float, int)
        The largest of these [mm], solved at the worst offsets there, and the number of its pose.
    """

    outline: Complex
    free: Real
    farthest: tuple[float, int]


@dataclass(frozen=True, kw_only=True, eq=False)
class PlayOverMotion:
    """What play does over the n poses of a motion, as ``LooseMotion`` finds it.

    Attributes
    ----------
    clearances : mapping of str to float
        Joint -> its play [mm].
    passes : ndarray of bool, shape (n,)
        Where it may take the linkage through a dead point.
    distance : tuple of 2 array (n,)
        Distance to a dead point, a ratio: without play, and the least.
    nearest : tuple of (float, int)
        The least of all, solved at the worst offsets, and the number of its pose.
    effort : mapping of str to tuple of 2 array (n,)
        Load case -> least and largest drive torque [N mm], or force [N].
    smallest, largest : mapping of str to tuple of (float, int)
        Load case -> the extreme of these, solved at the worst offsets, and the number of its pose.
    points : mapping of (str, str) to PointPlay
        By link and point, of all moving links.
    """

    clearances: Mapping[str, float]
    passes: NDArray[np.bool_]
    distance: tuple[Real, Real]
    nearest: tuple[float, int]
    effort: Mapping[str, tuple[Real, Real]]
    smallest: Mapping[str, tuple[float, int]]
    largest: Mapping[str, tuple[float, int]]
    points: Mapping[tuple[str, str], PointPlay]


@dataclass(frozen=True, kw_only=True, eq=False)
class MotionFindings:
    """A motion with what a report tells besides.

    Attributes
    ----------
    moved : CaseMotion
    clearance : Clearance or None
        The gaps between links; None where no layers are stated.
    play : PlayOverMotion or None
        None without play.
    air : AirRange or None
        None without air.
    work : mapping of str to DriveWork
        Load case -> what the drive does, with the ends of what friction may be; empty where no joint rubs.
    linkage : mapping of str to LinkageOverMotion
        Load case -> numbers of the linkage as a whole, where a check asks for the limit load.
    centre : InstantCentre or None
        None where the case asks for none.
    dead_point_distance : float
        The least over the motion, a ratio.
    way_to_dead_point : float
        From the nearer end of the motion [rad], or of a slider [mm]; infinite where none was met.
    """

    moved: CaseMotion
    clearance: Clearance | None
    play: PlayOverMotion | None
    air: AirRange | None
    work: Mapping[str, DriveWork]
    linkage: Mapping[str, LinkageOverMotion]
    centre: InstantCentre | None
    dead_point_distance: float
    way_to_dead_point: float


def motion_findings(moved: CaseMotion) -> MotionFindings:
    """Return a motion with what a report tells besides.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    MotionFindings

    Raises
    ------
    CaseError
        Where two links lie in each other in the stated pose.
    """
    return MotionFindings(
        moved=moved,
        clearance=clearance(moved.case),
        play=play_over_motion(moved),
        air=air_range(moved),
        work={name: work_between(moved, name) for name in moved.rubbing},
        linkage=asked_over_motion(moved),
        centre=instant_centre(moved),
        dead_point_distance=least_dead_point_distance(moved),
        way_to_dead_point=way_to_dead_point(moved),
    )


def play_over_motion(moved: CaseMotion) -> PlayOverMotion | None:
    """Return what play does over a motion.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    PlayOverMotion or None
        None where no joint has play, or no pose has a drive torque.
    """
    loose = loose_motion(moved)
    if loose is None:
        return None
    moving = [pair for pair in moved.motion.closure.point_names if pair[0] != moved.motion.linkage.ground]
    return PlayOverMotion(
        clearances=loose.clearances,
        passes=loose.passes,
        distance=loose.distance,
        nearest=loose.nearest(),
        effort={name: loose.effort(name) for name in moved.loads},
        smallest={name: loose.extreme_effort(name, -1.0) for name in moved.loads},
        largest={name: loose.extreme_effort(name, 1.0) for name in moved.loads},
        points={
            pair: PointPlay(outline=loose.outline(*pair), free=loose.free_motion(*pair), farthest=loose.farthest(*pair))
            for pair in moving
        },
    )
