"""Whether a linkage as a whole may buckle or snap through at some pose of a motion, by its linear frame."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.scatter import compliance_scatter, load_scatter
from fea.common.verdict import BUCKLING_FACTOR, LINKAGE, CheckOutcome, Verdict, at_least
from fea.frame.large_displacement import linkage_factor
from fea.frame.linear import solve_frame
from fea.frame.linkage_frame import build_frame
from fea.frame.toggle import SNAP, dead_point_factor
from fea.outcomes.buckling import NAME
from geometry.base.errors import CannotRunError, CaseError
from geometry.linkage.pose import Pose
from loads.states.case_motion import CaseMotion
from loads.states.inertia import acting_loads


def linkage_outcomes(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> Iterator[CheckOutcome]:
    """Yield an outcome for every load case under which the linkage may give way at a pose that was looked at.

    Looked at are the pose next to a dead point of the driven link and that of the largest drive torque.
    By the rule of single poses (``fea.outcomes.buckling.linkage_outcome``). Inertia is that of a constant speed.
    """
    case, motion = moved.case, moved.motion
    if case.large_displacement == "off":
        return
    poses = {
        int(i): Pose(linkage=motion.linkage, q=motion.q[i], coordinate=motion.coordinate, residual=0.0)
        for i in np.flatnonzero(evaluated)
    }
    nearest = min(poses, key=lambda i: moved.drive.dead_point_distance(poses[i]))
    slack = max((compliance_scatter(case.material_of(link)).high for link in case.checked_links), default=1.0)
    for title, load_case in case.load_cases.items():
        found = []
        hardest = max(poses, key=lambda i: abs(float(moved.torque[title][i])))
        for i in dict.fromkeys((nearest, hardest)):
            pose = poses[i]
            try:
                loads = acting_loads(case, load_case, pose, moved.masses)
                frame = build_frame(case, pose, loads, held=moved.drive)
                factor = linkage_factor(frame)
                found.append((min(factor, dead_point_factor(frame, solve_frame(frame.model))), factor, i))
            except (CaseError, CannotRunError):
                continue
        if not found:
            continue
        least, factor, i = min(found)
        band = Band(value=least, low=least / SNAP / slack, high=factor, holds=("snap-through of a shallow toggle",))
        band = load_scatter(case, title).inverse.on(band)
        verdict = at_least(band, 1.0)
        if verdict is Verdict.PASS:
            continue
        where = f"{motion.coordinate} = {np.degrees(motion.angles[i]):.5g} deg"
        yield CheckOutcome(
            name=NAME,
            link=LINKAGE,
            load_case=title,
            quantity=BUCKLING_FACTOR,
            unit="",
            value=band,
            limit=1.0,
            verdict=verdict,
            reason=(
                f"at {where} linear theory finds it unstable or at a dead point at {least:.3g} times the load; it may "
                "snap through: check that pose with alula check, which follows the deformed shape"
            ),
        )
