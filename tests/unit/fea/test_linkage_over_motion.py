"""The linkage as a whole over a motion: of several poses the worst counts, by stubs whose numbers differ in each."""

from types import SimpleNamespace

import numpy as np
import pytest

from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import friction_source
from alula.fea.motion import linkage_history
from alula.fea.nonlinear.stability import SNAP
from alula.geometry.base.errors import CannotRunError
from alula.geometry.linkage.coordinate import Coordinate
from alula.reports.sentences import told


def test_value_and_ends_of_a_limit_load_are_each_the_least_of_all_poses_and_of_a_displacement_the_largest():
    """They lie in three different poses each; the pose that is told is that of the value."""
    limits = [
        Band(value=5.0, low=4.0, high=9.0),
        Band(value=6.0, low=2.0, high=8.0),
        Band(value=7.0, low=5.0, high=7.5),
    ]
    moves = [Band(value=1.0, low=0.9, high=3.0), Band(value=2.0, low=0.5, high=2.5), Band(value=1.5, low=1.4, high=1.6)]
    found = linkage_history._over([3, 7, 9], list(zip(limits, moves, ("H", "E", "D"), strict=True)))
    assert (found.limit_load.value, found.limit_load.low, found.limit_load.high) == (5.0, 2.0, 7.5)
    assert (found.displacement.value, found.displacement.low, found.displacement.high) == (2.0, 1.4, 3.0)
    assert (found.limit_pose, found.displacement_pose, found.where) == (3, 7, "E")


@pytest.mark.parametrize("unknown", [0, 1, 2])
def test_one_pose_whose_numbers_are_not_known_leaves_those_over_the_motion_unknown(unknown):
    at = [(Band.exact(5.0), Band.exact(1.0), "H")] * 3
    at[unknown] = (Band.unknown("blind"), Band.unknown("lost"), "")
    found = linkage_history._over([3, 7, 9], at)
    assert (found.limit_load.without, found.displacement.without) == ("blind", "lost")
    assert (found.limit_pose, found.displacement_pose, found.where) == (-1, -1, "")


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_of_two_poses_the_one_counts_that_may_hold_less_with_what_eyes_do(monkeypatch, order):
    """20 times the load in stiff links holds more than 24 times in links up to six times as soft."""
    factors, eyes = (20.0, 24.0), (1.0, 6.0)
    stubs = {
        "blind_link": lambda case: "",
        "_worst": lambda *_: order,
        "build_frame": lambda case, pose, loads, held: SimpleNamespace(model=None, pose=pose, pin_beams={}),
        "linkage_factor": lambda frame: factors[frame.pose],
        "solve_frame": lambda model: None,
        "compliance_range": lambda case, frame, solution: Scatter(high=eyes[frame.pose]),
        "dead_point_factor": lambda frame, solution: 100.0,
        "stated_scatter": lambda case, load_case: Scatter(),
        "causes_over": lambda *_: (),
    }
    for name, stub in stubs.items():
        monkeypatch.setattr(linkage_history, name, stub)
    moved = SimpleNamespace(
        case=SimpleNamespace(large_displacement="auto"),
        motion=SimpleNamespace(
            coordinate=Coordinate("crank"),
            angles=np.radians([10.0, 20.0]),
            pose=lambda i: i,
            progress=np.array([10.0, 20.0]),
            instants=None,
        ),
        loads={"push": ()},
        held=object(),
    )
    [found] = linkage_history.linkage_outcomes(moved, np.ones(2, dtype=bool))
    assert "at crank = 20 deg" in told(found.reason)
    assert (found.value.value, found.value.low) == pytest.approx((24.0, 24.0 / SNAP / 6.0))

    # Friction that makes it a tenth at the other pose turns that round; what makes it more changes nothing.
    def rubbed(share):
        other = SimpleNamespace(
            case=None,
            motion=SimpleNamespace(pose=lambda i: SimpleNamespace(share=share[i], i=i)),
            loads={"push": ()},
            held=None,
        )
        return [Alternatives(source=friction_source({}), others=(other,))]

    def factor(frame):
        return frame.pose.share * factors[frame.pose.i] if hasattr(frame.pose, "share") else factors[frame.pose]

    monkeypatch.setattr(linkage_history, "linkage_factor", factor)
    for share, (value, low) in (((0.1, 1.0), (20.0, 2.0 / SNAP)), ((2.0, 2.0), (24.0, 24.0 / SNAP / 6.0))):
        monkeypatch.setattr(linkage_history, "causes_over", lambda *_, share=share: rubbed(share))
        [found] = linkage_history.linkage_outcomes(moved, np.ones(2, dtype=bool))
        assert (found.value.value, found.value.low) == pytest.approx((value, low))

    # An answer that cannot be told leaves the pose open, and does not take it away.
    def lost(frame):
        raise CannotRunError("no frame")

    monkeypatch.setattr(linkage_history, "causes_over", lambda *_: rubbed((1.0, 1.0)))
    monkeypatch.setattr(
        linkage_history, "linkage_factor", lambda frame: lost(frame) if hasattr(frame.pose, "share") else factor(frame)
    )
    [found] = linkage_history.linkage_outcomes(moved, np.ones(2, dtype=bool))
    assert (found.value.low, found.verdict.value) == (0.0, "undecided")
