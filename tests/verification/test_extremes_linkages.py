"""Dead points, change points, near-Grashof lengths and near-singular synthesis: right up to a boundary, refused beyond.

Figures and tables over the whole range: docs/stability.md.
"""

import math

import numpy as np
import pytest
from planar_linkages import four_bar

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.continuation import DeadPointError, Track
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.grashof import classify
from alula.geometry.mechanisms.synthesis import synthesise
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PointLoad
from alula.loads.statics.statics import Drive, solve_statics

DRIVE = Drive(link="crank", joint="A")


def parallelogram(delta, near=0.0):
    """Statics of a parallelogram ``delta`` [rad] from its change point; the drive torque is exactly a F cos θ."""
    linkage = four_bar(20.0, 50.0, 20.0, 50.0)
    directions = {"coupler": near, "rocker": delta + near}
    pose = solve_pose(linkage, coordinate="crank", angle=delta, near=directions)
    load = PointLoad(link="coupler", point="P", wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
    return solve_statics(pose, DRIVE, [load]).drive_torque, 20.0 * math.cos(delta)


def kite(theta):
    """The same of a folding kite next to the pose in which its equal links fold; the couple on the rocker is 1 N mm."""
    rocker = theta / 2.0 + math.pi / 2.0 - math.acos(math.sin(theta / 2.0) / 2.0)
    end = 30.0 + 60.0 * np.exp(1j * rocker) - 30.0 * np.exp(1j * theta)
    near = {"coupler": float(np.angle(end)), "rocker": rocker}
    pose = solve_pose(four_bar(30.0, 60.0, 60.0, 30.0), coordinate="crank", angle=theta, near=near)
    load = PointLoad(link="rocker", point="C", wrench=np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    slope = 0.5 + math.cos(theta / 2.0) / 4.0 / math.sqrt(1.0 - math.sin(theta / 2.0) ** 2 / 4.0)
    return solve_statics(pose, DRIVE, [load]).drive_torque, -slope


@pytest.mark.parametrize("solve", [parallelogram, kite])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_change_point_is_right_until_it_is_refused(solve, side):
    for distance in (1.0, 1e-1, 1e-2, 1e-3):
        torque, exact = solve(side * math.radians(distance))
        assert torque == pytest.approx(exact, rel=1e-4)
    for distance in (1e-4, 1e-6, 1e-9):
        with pytest.raises(CaseError, match="dead point of the driven link"):
            solve(side * math.radians(distance))


def test_six_bar_grows_as_it_must_and_is_refused():
    case = read_case("owl-wing-static", [])
    pose = case.solve_pose()
    (dead,) = solve_motion(pose, np.radians([200.0, 230.0])).turning_points("AE")
    drive = Drive(link="AE", joint="A")
    load = [PointLoad(link="CH", point="H", wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]))]
    for side in (1.0, -1.0):
        products = []
        for distance in (1e-1, 1e-2, 1e-3):
            delta = side * math.radians(distance)
            products.append(solve_statics(solve_motion(pose, [dead + delta]).pose(0), drive, load).drive_torque * delta)
        assert products[1] == pytest.approx(products[2], rel=5e-3)
        with pytest.raises(CaseError, match="dead point of the driven link"):
            solve_statics(solve_motion(pose, [dead + side * math.radians(1e-4)]).pose(0), drive, load)


@pytest.mark.parametrize("distance", [1.0, 1e-2])
def test_directions_too_rough_for_close_branches_are_refused(distance):
    delta = math.radians(distance)
    torque, exact = parallelogram(delta, near=0.05 * delta)
    assert torque == pytest.approx(exact, rel=1e-9)
    # 17° off, Newton's iteration finds the antiparallelogram, whose torque has another sign and size.
    with pytest.raises(CaseError, match="do not tell apart"):
        parallelogram(delta, near=0.3)


@pytest.mark.parametrize(("start", "end"), [(30.0, -30.0), (-30.0, 30.0)])
def test_motion_neither_jumps_nor_crosses_a_change_point(start, end):
    linkage = four_bar(20.0, 50.0, 20.0, 50.0)
    at = math.radians(start)
    pose = solve_pose(linkage, coordinate="crank", angle=at, near={"coupler": 0.0, "rocker": at})
    with pytest.raises(DeadPointError, match="two branches cross"):
        solve_motion(pose, [math.radians(end)])
    angles = np.radians(np.copysign([1.0, 1e-2, 1e-4, 1e-5], start))
    motion = solve_motion(pose, angles)
    np.testing.assert_allclose(motion.angle("rocker"), angles, atol=1e-8)


def test_a_pose_that_closes_elsewhere_than_the_branch_is_refused(monkeypatch):
    """What the interpolation between the nodes misses by too much may belong to another assembly."""
    pose = solve_pose(four_bar(20.0, 50.0, 40.0, 60.0), coordinate="crank", angle=1.0, near={"rocker": 1.5})
    assert len(solve_motion(pose, [1.0, 1.1]).q) == 2
    interpolate = Track._interpolate
    monkeypatch.setattr(Track, "_interpolate", lambda self, angles: interpolate(self, angles) + 0.05)
    with pytest.raises(CannotRunError, match="could not be closed on the branch"):
        solve_motion(pose, [1.0, 1.1])


@pytest.mark.parametrize(
    ("gap", "relation"), [(1e-12, "equal"), (-1e-12, "equal"), (0.0, "equal"), (1e-8, "greater"), (-1e-8, "less")]
)
def test_nearly_equal_sums(gap, relation):
    bar = FourBar(a=20.0, b=50.0, c=40.0, d=70.0 + 180.0 * gap)
    assert classify(a=bar.a, b=bar.b, c=bar.c, d=bar.d).relation == relation
    assert bool(bar.input_range().dead_points) == (relation == "greater")
    start = bar.position(math.pi / 2.0)
    near = {"coupler": float(start.theta3), "rocker": float(start.theta4)}
    linkage = four_bar(bar.a, bar.b, bar.c, bar.d)
    pose = solve_pose(linkage, coordinate="crank", angle=math.pi / 2.0, near=near)
    if gap < 0.0:
        angles = np.linspace(math.pi / 2.0, 1.5 * math.pi, 60)
        exact = bar.position(angles).theta4
        off = np.angle(np.exp(1j * (solve_motion(pose, angles).angle("rocker") - exact)))
        assert np.abs(off).max() < 1e-9
    else:
        with pytest.raises(DeadPointError):
            solve_motion(pose, [1.5 * math.pi])


@pytest.mark.parametrize(
    ("spread", "finding"), [(0.1, "silent"), (1e-3, "warned"), (1e-5, "warned"), (1e-6, "refused")]
)
def test_synthesis_matrix_nearly_singular(spread, finding):
    truth = FourBar(a=40.0, b=30.0, c=50.0, d=60.0)
    theta = np.radians(70.0) + spread * np.array([-0.5, 0.0, 0.5])
    psi = np.asarray(truth.driven_by_coupler().position(theta).theta4)
    if finding == "refused":
        with pytest.raises(CaseError, match="singular"):
            synthesise(theta, psi, d=60.0)
        return
    found = synthesise(theta, psi, d=60.0)
    lengths = np.array([found.four_bar.a, found.four_bar.b, found.four_bar.c])
    assert np.abs(lengths / np.array([40.0, 30.0, 50.0]) - 1.0).max() < 1e-15 * found.condition
    assert any(f.kind == "conditioning" for f in found.findings) == (finding == "warned")
