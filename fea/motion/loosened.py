"""Links with play of pins, in other air, with other friction or on the deformed shape: what a motion's numbers may be.

With play each link is looked at in two poses: that in which most acts on it, and that in which most may act with play,
by the first-order ends of its joint forces at all poses. There it is calculated by hand as a check of one pose does
(``alula.fea.doubts.play_doubt``), and the larger stress of both, over that without play, widens its bands. So it is
with the buckling factor of a link under compression.

So does the range of C_N of wings that flap: a link is calculated by hand at its worst poses with the stated C_N and
with either end of the range, and its largest stress of each is compared, as in a check
(``alula.fea.doubts.air_doubt``). And so does friction, at either end of what it may be.

Growth on the deformed shape is sought at some poses, by hand, as a check of each has it
(``alula.fea.doubts.load_growth``), without a threshold: where the linkage as a whole is looked at
(``alula.fea.motion.linkage_history``), next to a dead point, at the largest torque and at poses spread over the range;
and, where it does not bear nearly as much at one of these, where a link or joint bears most, a link under compression
with the growth of a column, or is nearest to buckling as one. The largest of these numbers on the deformed shape, over
the largest of them in the undeformed pose, widens the bands of the whole motion. Growth that makes a number largest at
a pose between these is in no band.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.buckling.buckling import least_factor
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import distinct, play_source
from alula.fea.doubts.force_doubt import rim_doubt
from alula.fea.doubts.load_growth import LEAST, SOURCES, Growths, beyond_undeformed, by_hand_numbers
from alula.fea.doubts.play_doubt import play_doubt
from alula.fea.links.link_by_hand import HandStates, on_plates, plates_by_hand
from alula.fea.motion.buckling_history import axial_compression, factors_over_motion
from alula.fea.motion.layered import forces_at
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import causes_over, looked_at, shape_at
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR, with_growth
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.ties import first_largest
from alula.loads.case.connection_rules import turned_by_drive
from alula.loads.records.applied import chosen
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.loose_motion import LooseMotion, loose_motion

NEARLY = 0.98
"""Share of the most that a link or joint bears at one of the poses at which growth is sought, at least."""


def loosened(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> dict[tuple[str, str], Scatter]:
    """Return what play makes of the greatest stress of links over a motion.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of tuple of 2 str to Scatter
        (load case, link) -> by what it may differ; empty without play.

    Raises
    ------
    CaseError
        Where play may take the linkage through a dead point at a pose that counts.
    """
    loose = loose_motion(moved)
    if loose is None:
        return {}
    _refuse_dead_points(loose, evaluated)
    return {(n, link): _link(loose, n, link, evaluated) for n in moved.loads for link in moved.case.checked_links}


def _refuse_dead_points(loose: LooseMotion, evaluated: NDArray[np.bool_]) -> None:
    through = np.flatnonzero(loose.passes & evaluated)
    if through.size:
        motion, drive = loose.moved.motion, loose.moved.drive
        at = motion.at_progress(float(motion.progress[through[0]]))
        joint = max(loose.clearances, key=lambda name: loose.clearances[name])
        raise CaseError(
            f"joints.{joint}.clearance: with {loose.clearances[joint]:g} mm play may take the linkage through a dead "
            f"point of the driven link {drive.link} at {at}, where joint forces have no end; "
            "state less play, shorten the motion, or allow less growth of the drive torque"
        )


def otherwise(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> dict[tuple[str, str], Scatter]:
    """Return what the range of C_N and the friction that may be make of the greatest stress of links over a motion.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of tuple of 2 str to Scatter
        (load case, link) -> by what it may differ; empty where neither is in doubt.
    """
    found = {}
    for load_case in moved.loads:
        every = _others(moved, load_case, evaluated)
        for link in moved.case.checked_links if len(every) > 1 else ():
            poses = {first_largest(np.where(evaluated, _size(one, load_case, link), -np.inf)) for one in every}

            def stress(one: CaseMotion, link: str = link, poses: set[int] = poses, load_case: str = load_case) -> float:
                return max(_hand(one, load_case, link, pose) for pose in poses)

            found[load_case, link] = _spread(moved, load_case, evaluated, stress)
    return found


def column_growth(moved: CaseMotion, load_case: str, link: str, evaluated: NDArray[np.bool_]) -> Scatter:
    """Return what play, C_N and friction make of the inverse of a link's least buckling factor over a motion.

    Parameters
    ----------
    moved : CaseMotion
    load_case, link : str
        Their names.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    Scatter
    """

    def histories(one: CaseMotion) -> list[LinkLoads]:
        return [history for history in link_histories(one, link) if history.name == load_case]

    def inverses(one: CaseMotion) -> NDArray[np.float64]:
        every = np.max([1.0 / factors_over_motion(one.case, link, h).value for h in histories(one)], axis=0)
        return np.where(evaluated, every, 0.0)

    found, loose = _spread(moved, load_case, evaluated, lambda one: float(inverses(one).max())), loose_motion(moved)
    if loose is None:
        return found
    own = inverses(moved)
    pressed = max(float(axial_compression(moved.case, link, h)[0][first_largest(own)]) for h in histories(moved))
    return _column(loose, load_case, link, own, pressed).times(found)


def _others(moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_]) -> list[CaseMotion]:
    return [moved, *(one for cause in causes_over(moved, load_case, evaluated) for one in cause.others)]


def _spread(
    moved: CaseMotion, load_case: str, evaluated: NDArray[np.bool_], number: Callable[[CaseMotion], float]
) -> Scatter:
    """Return what the range of C_N and friction make of a number, each alone, times one another."""
    spread = Scatter()
    for cause in causes_over(moved, load_case, evaluated):
        spread = spread.times(cause.scatter(moved, number))
    return spread


def _size(moved: CaseMotion, load_case: str, link: str) -> NDArray[np.float64]:
    """Size of all that acts on a link at every pose."""
    case = moved.case
    loads = link_loads(load_case, link, case.body(link), moved.forces[load_case], moved.loads[load_case])
    return np.asarray(loads.size(case.linkage.longest))


def _hand(moved: CaseMotion, load_case: str, link: str, pose: int) -> float:
    """Upper end of the peak of a link by hand at a pose."""
    case, loads = moved.case, [chosen(load, pose) for load in moved.loads[load_case]]
    forces = forces_at(moved, load_case, pose)
    found = link_loads(load_case, link, case.body(link), forces.reactions, loads)
    return float(HandStates(case, link, [on_plates(case, link, found)]).peaks[1, 0])


def joint_growth(
    moved: CaseMotion,
    load_case: str,
    joint: str,
    evaluated: NDArray[np.bool_],
    demand: Callable[[CaseMotion], NDArray[np.float64]] | None = None,
) -> Scatter:
    """Return what play, C_N and friction make of the most that a joint has to bear over a motion.

    Parameters
    ----------
    moved : CaseMotion
    load_case, joint : str
        Their names.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    demand : callable, optional
        Returns what goes through it over what it bears, at n poses; by default its force alone.

    Returns
    -------
    Scatter
        On what it bears without play, at the stated C_N. Play counts to first order, by what it makes of the joint's
        force and, of a demand where that drives, of the torque.
    """

    def force(one: CaseMotion) -> NDArray[np.float64]:
        return np.asarray(np.linalg.norm(one.forces[load_case].forces[joint], axis=1))

    play = _slack_of(moved, load_case, f"force {joint}", force(moved)[evaluated], evaluated)
    if demand is not None and turned_by_drive(moved.case, joint):
        torque = np.abs(np.broadcast_to(moved.forces[load_case].driving[0], evaluated.shape))[evaluated]
        play = play.either(_slack_of(moved, load_case, "effort", torque, evaluated))
    bears = demand or force
    return play.times(_spread(moved, load_case, evaluated, lambda one: float(bears(one)[evaluated].max())))


def most_at_each(
    moved: CaseMotion, load_case: str, joint: str, evaluated: NDArray[np.bool_], growth: Scatter
) -> NDArray[np.float64]:
    """Return by how much the force of a joint may be larger at each pose, of itself there.

    A force that is not the largest of the motion may grow by more than the largest does (``joint_growth``).

    Parameters
    ----------
    moved : CaseMotion
    load_case, joint : str
        Their names.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    growth : Scatter
        Of the largest force of the motion, which counts at every pose beside it.

    Returns
    -------
    ndarray, shape (n,)
        The high end of ``growth`` where the joint bears nothing, and at poses that do not count.
    """

    def force(one: CaseMotion) -> NDArray[np.float64]:
        return np.asarray(np.linalg.norm(one.forces[load_case].forces[joint], axis=1))

    own, loose = force(moved), loose_motion(moved)
    counts, most = evaluated & (own > 0.0), np.ones(len(own))
    if loose is not None:
        most[counts] += loose.slack(load_case, f"force {joint}")[counts] / own[counts]
    for cause in causes_over(moved, load_case, evaluated):
        others = np.max([own, *map(force, cause.others)], axis=0)
        most[counts] *= np.inf if cause.endless else others[counts] / own[counts]
    return np.where(counts, np.maximum(most, growth.high), growth.high)


def _slack_of(
    moved: CaseMotion, load_case: str, key: str, sizes: NDArray[np.float64], evaluated: NDArray[np.bool_]
) -> Scatter:
    """Return what play makes of the greatest of some sizes, to first order."""
    loose = loose_motion(moved)
    if loose is None or not sizes.max() > 0.0:
        return Scatter()
    slack = loose.slack(load_case, key)[evaluated]
    low, high = (float((sizes + sign * slack).max() / sizes.max()) for sign in (-1.0, 1.0))
    return Scatter(low=max(low, 0.0), high=high, sources=(play_source(loose.clearances),))


def _link(loose: LooseMotion, load_case: str, link: str, evaluated: NDArray[np.bool_]) -> Scatter:
    """Return what play makes of the greatest stress of a link over a motion."""
    moved, size = loose.moved, np.where(evaluated, _size(loose.moved, load_case, link), -np.inf)
    first, second = first_largest(size), first_largest(size + _slack(loose, load_case, link))
    found = {
        pose: (_hand(moved, load_case, link, pose), _doubt(loose, load_case, link, pose).stress.get(link, Scatter()))
        for pose in (first, second)
    }
    return _further(loose, found[first], found[second])


def _column(loose: LooseMotion, load_case: str, link: str, inverse: NDArray[np.float64], pressed: float) -> Scatter:
    """Return what play makes of the largest inverse (n,) of a link's buckling factor, there under ``pressed`` [N]."""
    first = first_largest(inverse)
    if not inverse[first] > 0.0:
        return Scatter()
    second = first_largest(inverse + _slack(loose, load_case, link) * inverse[first] / pressed)
    found = {
        pose: (float(inverse[pose]), _doubt(loose, load_case, link, pose).columns.get(link, Scatter()))
        for pose in (first, second)
    }
    return _further(loose, found[first], found[second])


def _slack(loose: LooseMotion, load_case: str, link: str) -> NDArray[np.float64]:
    """How far the forces of a link's pins may be off in all, at every pose [N]."""
    pins = loose.moved.case.linkage.joints_of(link)
    return np.asarray(np.sum([loose.slack(load_case, f"force {joint}") for joint in pins], axis=0))


def _further(loose: LooseMotion, one: tuple[float, Scatter], other: tuple[float, Scatter]) -> Scatter:
    """Join what play makes of a number at the pose where it is largest and where it may be, over the largest."""
    (plain, own), (second, far) = one, other
    if not plain > 0.0:
        return Scatter()
    sources = distinct(own.sources, far.sources) or (play_source(loose.clearances),)
    return Scatter(low=own.low, high=max(own.high, far.high * second / plain), sources=sources)


def _doubt(loose: LooseMotion, load_case: str, link: str, pose: int) -> Growths:
    """What play makes of a link at a pose."""
    moved = loose.moved
    loads = [chosen(load, pose) for load in moved.loads[load_case]]
    forces = replace(forces_at(moved, load_case, pose), play=loose.play(load_case, pose))
    return play_doubt(moved.case, load_case, forces, loads, links=(link,))


@dataclass(frozen=True, kw_only=True)
class _GrownPose:
    """Numbers of a load case in an undeformed pose, and their growth."""

    stress: Mapping[str, float] = field(default_factory=dict)
    inverse: Mapping[str, float] = field(default_factory=dict)
    forces: Mapping[str, float] = field(default_factory=dict)
    torques: Mapping[str, float] = field(default_factory=dict)
    growths: Growths = field(default_factory=Growths)


def motion_growth(
    moved: CaseMotion, loaded: Mapping[str, Sequence[LinkLoads]], evaluated: NDArray[np.bool_]
) -> dict[str, Growths]:
    """Return what the deformed shape makes of the largest numbers over a motion.

    Parameters
    ----------
    moved : CaseMotion
    loaded : mapping of str to sequence of LinkLoads
        Link -> what acts on it, with the second-order bending that its numbers contain, by load case.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of str to Growths
        By load case.
    """
    found = {}
    for load_case in moved.forces:
        own = {link: [one for one in every if one.name == load_case] for link, every in loaded.items()}
        histories = {link: every for link, every in own.items() if every}
        poses = [_grown_at(moved, load_case, i, histories) for i in _poses(moved, load_case, histories, evaluated)]
        joints = moved.case.linkage.joints_of
        found[load_case] = Growths(
            stress=_largest_grown([(one.stress, one.growths.stress) for one in poses]),
            columns=_largest_grown(
                [
                    (one.inverse, {x: _worst(one.growths.joints.get(name) for name in joints(x)) for x in one.inverse})
                    for one in poses
                ]
            ),
            joints=_largest_grown([(one.forces, one.growths.joints) for one in poses]),
            torques=_largest_grown([(one.torques, one.growths.torques) for one in poses]),
            pins={x: _worst(one.growths.pins.get(x) for one in poses) for x in moved.case.joints},
        )
    return found


def _poses(
    moved: CaseMotion, load_case: str, histories: Mapping[str, Sequence[LinkLoads]], evaluated: NDArray[np.bool_]
) -> list[int]:
    """Numbers of the poses at which growth is sought."""
    sizes = [np.linalg.norm(force, axis=1) for force in moved.forces[load_case].forces.values()]
    for link, every in histories.items():
        for history in every:
            column = factors_over_motion(moved.case, link, history).value
            bent = 1.0 / (1.0 - 1.0 / np.maximum(column, LEAST_FACTOR))
            sizes += [history.size(moved.case.linkage.longest) * bent, 1.0 / column]
    found = set(looked_at(moved, load_case, evaluated))
    for size in sizes:
        counted = np.where(evaluated, size, -np.inf)
        most = first_largest(counted)
        if counted[list(found)].max() < NEARLY * counted[most]:
            found.add(most)
    return sorted(found)


def _grown_at(moved: CaseMotion, load_case: str, i: int, histories: Mapping[str, Sequence[LinkLoads]]) -> _GrownPose:
    """Numbers of one pose; none that grow where it has no joint forces by its frame."""
    case, pose, loads = moved.case, moved.motion.pose(i), [chosen(load, i) for load in moved.loads[load_case]]
    plates = {
        link: plates_by_hand(case, link, [history.chosen(i) for history in every]) for link, every in histories.items()
    }
    hands = {link: found[0][1] for link, found in plates.items()}
    inverse = {link: max(1.0 / least_factor(case, link, hand.check) for _, hand in plates[link]) for link in hands}
    try:
        forces = forces_at(moved, load_case, i)
        shape = with_growth(case, load_case, shape_at(moved, load_case, i), loads)
    except (CaseError, CannotRunError):
        return _GrownPose()
    stress, _, magnitudes, torques = by_hand_numbers(hands, forces.reactions)
    found = beyond_undeformed(case, load_case, pose, loads, shape, forces.reactions, hands)
    found = found.times(rim_doubt(case, load_case, shape, forces, loads, tuple(hands)))
    return _GrownPose(stress=stress, inverse=inverse, forces=magnitudes, torques=torques, growths=found)


def _worst(found: Iterable[Scatter | None]) -> Scatter:
    """Return one that holds several; none is no growth."""
    every = [one for one in found if one is not None]
    low, high = min((1.0, *(one.low for one in every))), max((1.0, *(one.high for one in every)))
    return Scatter(low=low, high=high, sources=SOURCES if every else ())


def _largest_grown(poses: Sequence[tuple[Mapping[str, float], Mapping[str, Scatter]]]) -> dict[str, Scatter]:
    """Return by what the largest of all numbers with their growth differs from the largest without."""
    found = {}
    for name in dict.fromkeys(name for numbers, _ in poses for name in numbers):
        own = [(numbers[name], grown.get(name, Scatter())) for numbers, grown in poses if numbers.get(name, 0.0) > 0.0]
        if own:
            most = max(value for value, _ in own)
            low = max(value * one.low for value, one in own) / most
            high = max(value * one.high for value, one in own) / most
            if low < 1.0 - LEAST or high > 1.0 + LEAST:
                found[name] = Scatter(low=low, high=high, sources=SOURCES)
    return found
