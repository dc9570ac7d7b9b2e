"""Numbers that alula itself gave for the owl wing: they guard against change, they validate nothing."""

import numpy as np
import pytest

from loads.case.case_file import read_case, read_companion
from loads.sources.published_statics import audit
from loads.states.actions import actions
from loads.statics.statics import solve_statics


def test_numbers_of_the_open_wing() -> None:
    case = read_case("owl-wing-static")
    pose = case.solve_pose()
    loads = actions(case, case.load_cases["weight"], pose, {})
    reactions = solve_statics(pose, case.pinned_drive, loads)
    assert pose.dead_point_distance("AE") == pytest.approx(0.0374196, rel=1e-5)
    assert reactions.system.condition == pytest.approx(64.0273, rel=1e-5)
    published = case.published_statics
    assert published is not None
    texts = [read_companion("owl-wing-static", name) for name in (published.exact, published.printed)]
    found = audit(published, texts[0], texts[1], pose, loads)
    np.testing.assert_allclose(
        [row.defect for row in found.rows if not row.valid], [0.54665, 0.23348, 0.70195], atol=1e-5
    )
    assert found.rounding_bound == pytest.approx(0.0124624, rel=1e-4)
    moments = [left.moment for left in found.imbalances]
    np.testing.assert_allclose(moments, [-0.0011, -17.2879, 51.8948, -0.0284, -56.0332], atol=1e-4)
    assert reactions.drive_torque == pytest.approx(-130.58393, abs=1e-5)
