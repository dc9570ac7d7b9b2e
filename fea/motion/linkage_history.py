"""The linkage as a whole over a motion: whether it may give way by its linear frame, and its numbers at some poses."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asked, asks
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import air_source, friction_source
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.doubts.play_doubt import shaken
from alula.fea.frame.build import build_frame
from alula.fea.frame.displacement_band import compliance_range
from alula.fea.frame.linear import solve_frame
from alula.fea.judging.linkage import by_linear_theory
from alula.fea.judging.linkage_numbers import limit_load_outcome, linkage_numbers
from alula.fea.motion.layered import forces_at
from alula.fea.nonlinear.large_displacement import LargeDisplacement, blind_link, examine, stated_scatter
from alula.fea.nonlinear.on_rims import rim_factors
from alula.fea.nonlinear.stability import dead_point_factor, linkage_factor
from alula.fea.standing.joint_forces import JointForces
from alula.fea.whole.air_range import air_range
from alula.fea.whole.rubbed_motion import friction_range
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.ties import first_largest, first_least
from alula.loads.case.joint_rules import friction_ranges
from alula.loads.records.applied import chosen
from alula.loads.records.check_spec import LimitLoadCheck
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.loose_motion import loose_motion

SPREAD = 5
"""Poses over the range, both ends included, at which the numbers of the linkage are computed besides the worst two."""

FAR = 100.0
"""Factor on the loads beyond which it does not matter what air and friction make of it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageOverMotion:
    """The linkage under a load case over a motion, by its frame at some poses.

    Attributes
    ----------
    poses : tuple of int
        Numbers of the poses that were looked at.
    limit_load : Band
        The least factor on all loads at which it gives way.
    limit_pose : int
        Number of its pose; -1 where it is not known.
    displacement : Band
        The largest of any place [mm]; not known where it gives way at a pose.
    where : Reason or str
        That place; "" where it is not known.
    displacement_pose : int
        Number of its pose; -1 where it is not known.
    """

    poses: tuple[int, ...]
    limit_load: Band
    limit_pose: int
    displacement: Band
    where: Reason | str
    displacement_pose: int


def when(moved: CaseMotion, pose: int) -> Reason:
    """Tell which pose of a motion one is.

    Parameters
    ----------
    moved : CaseMotion
    pose : int
        Its number.

    Returns
    -------
    Reason
    """
    motion, at = moved.motion, float(moved.motion.progress[pose])
    if motion.instants is not None:
        return reason("instant_of_cycle", value=at)
    return reason("pose_of_motion", coordinate=motion.coordinate.name, value=at, unit=motion.coordinate.measure.unit)


def linkage_outcomes(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> Iterator[CheckOutcome]:
    """Yield an outcome for every load case under which the linkage may give way at one of two poses.

    They are the pose next to a dead point of the driven link and that of the largest drive torque. The rule is that of
    single poses (``alula.fea.judging.linkage``).

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Yields
    ------
    CheckOutcome
    """
    case, motion = moved.case, moved.motion
    if case.large_displacement == "off":
        return
    blind = blind_link(case)
    for load_case, acting in moved.loads.items():
        found = []
        for i in _worst(moved, load_case, evaluated):
            pose = motion.pose(i)
            try:
                loads = [chosen(load, i) for load in acting]
                frame = build_frame(case, pose, loads, held=moved.held)
                factor, solution = linkage_factor(frame), solve_frame(frame.model)
                eyes = Scatter() if blind else compliance_range(case, frame, solution)
                least = min(factor, dead_point_factor(frame, solution))
                doubt = _otherwise(moved, load_case, evaluated, i, min(least, FAR))
                found.append((min(least, FAR) if doubt.sources else least, factor, i, eyes.times(doubt)))
            except (CaseError, CannotRunError):
                continue
        if not found:
            continue
        least, factor, i, slack = found[first_least([one[0] / one[3].high for one in found])]
        how, remedy = reason("unstable_at_pose", pose=when(moved, i), factor=least), reason("check_that_pose")
        slack = stated_scatter(case, load_case).times(slack)
        pins = forces_at(moved, load_case, i).pins if frame.pin_beams else None
        rims = None if pins is None else rim_factors(pins)
        outcome = by_linear_theory(load_case, least, factor, slack, how, remedy, rims)
        if outcome.verdict is not Verdict.PASS:
            yield outcome


def _otherwise(moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_], i: int, least: float) -> Scatter:
    """Return what air and friction may make of the inverse of the least factor at a pose, itself at most ``FAR``."""

    def inverse(one: CaseMotion) -> float:
        loads = [chosen(load, i) for load in one.loads[load_case]]
        try:
            frame = build_frame(one.case, one.motion.pose(i), loads, held=one.held)
            return 1.0 / min(linkage_factor(frame), dead_point_factor(frame, solve_frame(frame.model)), FAR)
        except (CaseError, CannotRunError):  # the stated answer is known, and may not pass by it alone
            return math.inf

    found = Scatter()
    for cause in causes_over(moved, load_case, evaluated):
        found = found.times(cause.of(1.0 / least, [inverse(one) for one in cause.others]))
    return found


def over_motion(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> dict[str, LinkageOverMotion]:
    """Return the numbers of the linkage over a motion, by its frame.

    They are computed at ``SPREAD`` poses over the range, next to a dead point of the driven link and where its torque
    is largest, each as a check of that pose has them without solids.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of str to LinkageOverMotion
        By load case.
    """
    found = {}
    for load_case in moved.loads:
        poses = looked_at(moved, load_case, evaluated)
        found[load_case] = _over(poses, [_at(moved, load_case, i) for i in poses])
    return found


def looked_at(moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_]) -> list[int]:
    """Return the numbers of the poses at which the linkage as a whole is looked at.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
        Its name.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    list of int
        In order.
    """
    counted = np.flatnonzero(evaluated)
    spread = counted[np.linspace(0, len(counted) - 1, SPREAD).round().astype(int)]
    return sorted({*map(int, spread), *_worst(moved, load_case, evaluated)})


@lru_cache(maxsize=128)
def shape_at(moved: CaseMotion, load_case: str, pose: int) -> LargeDisplacement:
    """Return what becomes of a load case at one pose in large displacement.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
        Its name.
    pose : int
        Its number.

    Returns
    -------
    LargeDisplacement
    """
    loads = [chosen(load, pose) for load in moved.loads[load_case]]
    return examine(moved.case, load_case, forces_at(moved, load_case, pose), loads)


@lru_cache(maxsize=1)
def asked_over_motion(moved: CaseMotion) -> dict[str, LinkageOverMotion]:
    """Return the numbers of ``over_motion`` at all poses where a check asks for the limit load; else nothing.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    dict of str to LinkageOverMotion
        By load case.
    """
    balanced = np.all([np.isfinite(torque) for torque in moved.torque.values()], axis=0)
    return over_motion(moved, balanced) if asks(moved.case, LimitLoadCheck) and balanced.any() else {}


def limit_load_outcomes(moved: CaseMotion, found: Mapping[str, LinkageOverMotion]) -> Iterator[CheckOutcome]:
    """Yield the outcome of every check of the limit load over a motion.

    Parameters
    ----------
    moved : CaseMotion
    found : mapping of str to LinkageOverMotion
        By load case.

    Yields
    ------
    CheckOutcome
    """
    for one in asked(moved.case, LimitLoadCheck):
        for load_case, over in found.items():
            pose = when(moved, over.limit_pose) if over.limit_pose >= 0 else None
            counts = {"looked_at": len(over.poses), "poses": len(moved.motion.angles)}
            where = reason("least_of_poses", **counts, pose=pose)
            yield limit_load_outcome(one, load_case, over.limit_load, where)


def _worst(moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_]) -> list[int]:
    """Numbers of the pose next to a dead point of the driven link and of that with the largest torque.

    Of a cycle, whose loads change, that of the largest joint forces too.
    """
    counted, found = [int(i) for i in np.flatnonzero(evaluated)], list[int]()
    if moved.held is not None:
        distances = [moved.held.dead_point_distance(moved.motion.pose(i)) for i in counted]
        torques = np.abs(moved.torque[load_case][counted])
        found = [counted[first_least(distances)], counted[first_largest(torques)]]
    if moved.motion.instants is not None:
        forces = [np.linalg.norm(one[counted], axis=1) for one in moved.forces[load_case].forces.values()]
        found.append(counted[first_largest(np.sum(forces, axis=0))])
    return list(dict.fromkeys(found))


def _at(moved: CaseMotion, load_case: str, i: int) -> tuple[Band, Band, Reason | str]:
    """Limit-load factor and largest displacement at a pose, and the place of the latter."""
    try:
        forces, shape = _in_doubt(moved, load_case, i)
        numbers = linkage_numbers(moved.case, load_case, shape, forces)
        return numbers.limit_load, numbers.displacement, numbers.where
    except (CaseError, CannotRunError) as error:
        return Band.unknown(str(error)), Band.unknown(str(error)), ""


def _in_doubt(moved: CaseMotion, load_case: str, i: int) -> tuple[JointForces, LargeDisplacement]:
    """Joint forces and shape at a pose, with what play, C_N and friction may make of them as a check has it."""
    forces, shape, loose = forces_at(moved, load_case, i), shape_at(moved, load_case, i), loose_motion(moved)
    here = np.arange(len(moved.motion.angles)) == i
    found = [cause.told_by(lambda one: shape_at(one, load_case, i)) for cause in causes_over(moved, load_case, here)]
    shape = replace(shape, causes=tuple(found))
    if loose is not None:
        forces = replace(forces, play=loose.play(load_case, i))
        shape = shaken(moved.case, load_case, forces, shape)
    return forces, shape


def causes_over(moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_]) -> Iterator[Alternatives[CaseMotion]]:
    """Yield the causes that change what acts over a motion: the range of C_N, and friction.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
        Its name.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Yields
    ------
    Alternatives of CaseMotion
        Motions at the ends of what may be, but for those that lock themselves at a pose that counts.
    """
    air, airs = moved.case.load_cases[load_case].flapping, air_range(moved)
    if air is not None and airs is not None and (others := airs.at(load_case)):
        coefficients = (air.normal_coefficient, *air.ends)
        yield Alternatives(source=air_source(*air.ends), others=others, coefficients=coefficients)
    if moved.rubbing:
        every = friction_range(moved)
        rubbed = tuple(one for one in every if np.isfinite(one.torque[load_case][evaluated]).all())
        source = friction_source(friction_ranges(moved.case))
        yield Alternatives(source=source, others=rubbed, endless=len(rubbed) < len(every))


def _over(poses: list[int], at: list[tuple[Band, Band, Reason | str]]) -> LinkageOverMotion:
    limits, moves, places = zip(*at, strict=True)
    least, most = Quantity.LIMIT_LOAD.sense.worst(limits), Quantity.DISPLACEMENT.sense.worst(moves)
    where, least_at, most_at = "", -1, -1
    if not least.unknowable:
        least_at = poses[min(range(len(poses)), key=lambda k: (limits[k].value, limits[k].low))]
    if not most.unknowable:
        k = max(range(len(poses)), key=lambda k: moves[k].value)
        where, most_at = places[k], poses[k]
    return LinkageOverMotion(
        poses=tuple(poses),
        limit_load=least,
        limit_pose=least_at,
        displacement=most,
        where=where,
        displacement_pose=most_at,
    )
