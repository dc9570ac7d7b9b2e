"""Dead points of sampled linkages: a four-bar's by the law of cosines, and the poses beside them."""

import math

import numpy as np
import pytest

from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.linkage.sampled import SampledClosure, _at_dead_points, assemble_samples
from alula.geometry.linkage.sampled_dead_points import own_dead_point

GROUND, CRANK, COUPLER, ROCKER = 100.0, 60.0, 50.0, 40.0
"""No link turns fully [mm]."""
COLUMN = 0


def dead_angle(rocker):
    """The crank's angle where coupler and rocker are in line: (b + c)² = a² + d² - 2 a d cos."""
    return np.arccos((CRANK**2 + GROUND**2 - (COUPLER + rocker) ** 2) / (2.0 * CRANK * GROUND))


def four_bar(angle):
    """Its pose with the joint of coupler and rocker above."""

    def link(length, first, last, **more):
        return Link.model_validate(
            {"points": {first: ["0 mm", "0 mm"], last: [f"{length} mm", "0 mm"]}, **more}
        )  # fmt: skip

    links = {
        "ground": link(GROUND, "O", "Q", ground=True),
        "crank": link(CRANK, "O", "A"),
        "coupler": link(COUPLER, "A", "B"),
        "rocker": link(ROCKER, "Q", "B"),
    }
    pairs = {"O": "ground crank", "A": "crank coupler", "B": "coupler rocker", "Q": "ground rocker"}
    joints = {name: Joint.model_validate({"links": pair.split()}) for name, pair in pairs.items()}
    near = {"coupler": math.radians(0.0), "rocker": math.radians(120.0)}
    return solve_pose(Linkage(links, joints), coordinate="crank", angle=angle, near=near)


@pytest.fixture(scope="module")
def pose():
    found = four_bar(math.radians(60.0))
    assert found.q[COLUMN] == pytest.approx(math.radians(60.0))
    return found


def test_the_dead_point_of_a_four_bar_is_where_coupler_and_rocker_are_in_line(pose):
    there = own_dead_point(pose)
    assert there is not None
    assert there[COLUMN] == pytest.approx(float(dead_angle(ROCKER)), abs=1e-9)


def test_samples_beyond_their_own_dead_points_are_told_by_how_much(pose):
    """Longer rockers reach further; angles lie on both sides of their ends, some a thousandth of a degree off."""
    longer = np.array([0.0, 0.5, -0.5, 1.0, -1.0, 0.3])
    off = np.radians([0.5, 1.0, 0.001, -0.001, -0.3, -1e-5])
    wanted = dead_angle(ROCKER + longer) + off
    shifts = {("rocker", "B"): longer.astype(complex)}
    place, done, short = assemble_samples(pose, shifts, wanted - pose.q[COLUMN])
    assert done.tolist() == [False, False, False, True, True, True]
    assert short[:3] == pytest.approx(off[:3], abs=1e-9)
    assert np.isnan(short[3:]).all()
    gap = place.closure.residual(place.q)[done]
    assert np.abs(gap).max() < 1e-9


def test_poses_beside_dead_points_are_those_of_newtons_iteration(pose):
    longer = np.random.default_rng(0).uniform(-0.5, 0.5, 50)
    value = np.radians(np.linspace(-3.0, 0.0, 50))
    shifts = {("rocker", "B"): longer.astype(complex)}
    free = np.arange(len(pose.q)) != COLUMN
    q, done, _ = _at_dead_points(pose, SampledClosure.of(pose.linkage, shifts), value, free)
    place, closed, _ = assemble_samples(pose, shifts, value)
    assert done.all()
    assert closed.all()
    assert q == pytest.approx(place.q, abs=1e-9)


def test_a_linkage_without_dead_point_has_none():
    """A crank that turns fully is nowhere at the end of its branch."""
    pose = four_bar(math.radians(60.0))
    full = pose.linkage.links["ground"].model_copy(update={"points": {"O": (0.0, 0.0), "Q": (45.0, 0.0)}})
    crank = pose.linkage.links["crank"].model_copy(update={"points": {"O": (0.0, 0.0), "A": (10.0, 0.0)}})
    turning = Linkage({**pose.linkage.links, "ground": full, "crank": crank}, pose.linkage.joints)
    found = solve_pose(turning, coordinate="crank", angle=1.0, near={"coupler": 0.5, "rocker": 2.0})
    assert own_dead_point(found) is None
