"""Growth over a motion: what the deformed shape makes of stress, joint forces and columns.

It is sought at some poses, by hand, as a check of each has it (``fea.doubts.load_growth``), without a threshold: where
a link or joint bears most, a link under compression with the growth of a column; where a link is nearest to buckling
as one; and where the linkage as a whole is looked at (``fea.motion.linkage_history``), which is next to a dead point,
at the largest torque and at poses spread over the range. The largest of these numbers on the deformed shape, over the
largest in the undeformed pose, widens the bands of the whole motion. Growth that makes a number largest at a pose
between these is in no band.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fea.buckling.buckling import least_factor
from fea.common.link_loads import LinkLoads
from fea.common.scatter import Scatter
from fea.doubts.load_growth import LEAST, SOURCES, Growths, beyond_undeformed, by_hand_numbers
from fea.links.link_by_hand import plates_by_hand
from fea.motion.buckling_history import factors_over_motion
from fea.motion.layered import forces_at
from fea.motion.linkage_history import looked_at, shape_at
from fea.nonlinear.large_displacement import LEAST_FACTOR, with_growth
from geometry.base.errors import CannotRunError, CaseError
from geometry.base.ties import first_largest
from loads.records.applied import chosen
from loads.states.case_motion import CaseMotion
from loads.states.dead_point_reach import pose_at

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class MotionGrowth:
    """Growth of the largest numbers of a load case over a motion; what does not grow is left out.

    Attributes
    ----------
    stress, columns : mapping of str to Scatter
        Link -> growth of its stress, and of the inverse of its buckling factor.
    joints : mapping of str to Scatter
        Joint -> growth of its force.
    """

    stress: Mapping[str, Scatter] = field(default_factory=dict)
    columns: Mapping[str, Scatter] = field(default_factory=dict)
    joints: Mapping[str, Scatter] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class _Pose:
    """Numbers of a load case in an undeformed pose, and their growth."""

    stress: Mapping[str, float] = field(default_factory=dict)
    inverse: Mapping[str, float] = field(default_factory=dict)
    forces: Mapping[str, float] = field(default_factory=dict)
    growths: Growths = field(default_factory=Growths)


def motion_growth(
    moved: CaseMotion, loaded: Mapping[str, Sequence[LinkLoads]], evaluated: NDArray[np.bool_]
) -> dict[str, MotionGrowth]:
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
    dict of str to MotionGrowth
        By load case.
    """
    found = {}
    for load_case in moved.forces:
        own = {link: [one for one in every if one.name == load_case] for link, every in loaded.items()}
        histories = {link: every for link, every in own.items() if every}
        poses = [_at(moved, load_case, i, histories) for i in _poses(moved, load_case, histories, evaluated)]
        joints = moved.case.linkage.joints_of
        found[load_case] = MotionGrowth(
            stress=_largest([(one.stress, one.growths.stress) for one in poses]),
            columns=_largest(
                [(one.inverse, {x: _worst(one.growths.joints, joints(x)) for x in one.inverse}) for one in poses]
            ),
            joints=_largest([(one.forces, one.growths.joints) for one in poses]),
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
    largest = {first_largest(np.where(evaluated, size, -np.inf)) for size in sizes}
    return sorted({*largest, *looked_at(moved, load_case, evaluated)})


def _at(moved: CaseMotion, load_case: str, i: int, histories: Mapping[str, Sequence[LinkLoads]]) -> _Pose:
    """Numbers of one pose; none that grow where it has no joint forces by its frame."""
    case, pose, loads = moved.case, pose_at(moved.motion, i), [chosen(load, i) for load in moved.loads[load_case]]
    plates = {
        link: plates_by_hand(case, link, [history.chosen(i) for history in every]) for link, every in histories.items()
    }
    hands = {link: found[0][1] for link, found in plates.items()}
    inverse = {link: max(1.0 / least_factor(case, link, hand.check) for _, hand in plates[link]) for link in hands}
    try:
        reactions = forces_at(moved, load_case, i).reactions
        shape = with_growth(case, load_case, shape_at(moved, load_case, i), loads)
    except (CaseError, CannotRunError):
        return _Pose()
    stress, _, forces = by_hand_numbers(hands, reactions)
    found = beyond_undeformed(case, load_case, pose, loads, shape, reactions, hands)
    return _Pose(stress=stress, inverse=inverse, forces=forces, growths=found)


def _worst(found: Mapping[str, Scatter], names: Iterable[str]) -> Scatter:
    """Return one that holds those of several joints."""
    every = [found[name] for name in names if name in found]
    low, high = min((1.0, *(one.low for one in every))), max((1.0, *(one.high for one in every)))
    return Scatter(low=low, high=high, sources=SOURCES)


def _largest(poses: Sequence[tuple[Mapping[str, float], Mapping[str, Scatter]]]) -> dict[str, Scatter]:
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
