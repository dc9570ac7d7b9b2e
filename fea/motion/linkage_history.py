"""Whether a linkage as a whole may buckle or snap through at some pose of a motion, by its linear frame."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fea.buckling.linkage import by_linear_theory
from fea.common.verdict import CheckOutcome, Verdict
from fea.frame.build import build_frame
from fea.frame.linear import solve_frame
from fea.nonlinear.stability import dead_point_factor, linkage_factor
from geometry.base.errors import CannotRunError, CaseError
from geometry.linkage.pose import Pose
from loads.records.applied import chosen
from loads.states.case_motion import CaseMotion


def linkage_outcomes(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> Iterator[CheckOutcome]:
    """Yield an outcome for every load case under which the linkage may give way at one of two poses.

    They are the pose next to a dead point of the driven link and that of the largest drive torque. The rule is that of
    single poses (``fea.buckling.linkage``).

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
    poses = {
        int(i): Pose(linkage=motion.linkage, q=motion.q[i], coordinate=motion.coordinate, residual=0.0)
        for i in np.flatnonzero(evaluated)
    }
    nearest = min(poses, key=lambda i: moved.drive.dead_point_distance(poses[i]))
    for load_case, acting in moved.loads.items():
        found = []
        hardest = max(poses, key=lambda i: abs(float(moved.torque[load_case][i])))
        for i in dict.fromkeys((nearest, hardest)):
            pose = poses[i]
            try:
                loads = [chosen(load, i) for load in acting]
                frame = build_frame(case, pose, loads, held=moved.drive)
                factor = linkage_factor(frame)
                found.append((min(factor, dead_point_factor(frame, solve_frame(frame.model))), factor, i))
            except (CaseError, CannotRunError):
                continue
        if not found:
            continue
        least, factor, i = min(found)
        where = f"{motion.coordinate} = {np.degrees(motion.angles[i]):.5g} deg"
        how = f"at {where} linear theory finds it unstable or at a dead point at {least:.3g} times the load"
        remedy = "check that pose with alula check, which follows the deformed shape"
        outcome = by_linear_theory(case, load_case, least, factor, how, remedy)
        if outcome.verdict is not Verdict.PASS:
            yield outcome
