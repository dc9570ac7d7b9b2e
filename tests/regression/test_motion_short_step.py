"""A motion that begins a rounding error off its pose.

Symptom: "the links may go on in two ways at 35.775664 deg before it reaches 35.775664 deg". Cause: the share of a
step by which two estimates may differ fell below rounding when the step itself was rounding.
"""

import numpy as np
import pytest

from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case_file import read_case


@pytest.mark.parametrize("by", [1e-16, -3e-16, 1e-15, 1e-14, -1e-13, 1e-12, 1e-10, -1e-8])
def test_a_motion_may_begin_next_to_its_pose(by: float) -> None:
    case = read_case("four-bar-synthesis")
    pose = case.solve_pose()
    here = pose.angles["a"]
    motion = solve_motion(pose, [here + by, here + 0.5])
    assert motion.residual < 1e-12
    np.testing.assert_allclose(motion.angle("c")[0], pose.angles["c"], atol=1e-7)


def test_a_pose_a_full_turn_away_is_the_same_pose() -> None:
    case = read_case("four-bar-synthesis")
    pose = case.solve_pose()
    here = pose.angles["a"] + 6.0 * np.pi
    motion = solve_motion(pose, [here, here + 0.1])
    assert motion.residual < 1e-12
