"""A slider driven by its travel: the inversion of the crank-driven motion, virtual work, and the energy balance.

Norton's offset slider-crank: link 2 40 mm, link 3 120 mm, offset -20 mm (Design of Machinery, 5th ed., example 4-2).
"""

import math

import numpy as np
import pytest
from motion_poses import kinetostatics, virtual_work
from planar_linkages import joint, link, oscillating_cylinder, slider_crank

from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.coordinate import Coordinate, Measure
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.loads.records.applied import PartMass, PointLoad
from alula.loads.statics.statics import Drive, solve_statics

A, B, OFFSET = 40.0, 120.0, -20.0
LINKAGE = slider_crank(A, B, OFFSET)
NEAR = {"crank": 1.0, "coupler": -0.4, "block": 0.0}
CRANK, PISTON = Drive(link="crank", joint="A"), Drive(link="block", joint="S")
LONGEST = math.sqrt((A + B) ** 2 - OFFSET**2)
SHORTEST = math.sqrt((B - A) ** 2 - OFFSET**2)


def crank_driven(angles, **rates):
    pose = solve_pose(LINKAGE, coordinate="crank", angle=1.0, near={"coupler": -0.4, "block": 0.0})
    return solve_motion(pose, angles, **rates)


def piston_driven(travels, **rates):
    pose = solve_pose(LINKAGE, coordinate="S", travel=130.0, near=NEAR)
    return solve_motion(pose, travels, **rates)


def test_the_pose_at_a_travel_is_the_one_whose_crank_gives_it() -> None:
    pose = solve_pose(LINKAGE, coordinate="S", travel=130.0, near=NEAR)
    assert (pose.coordinate, pose.travels["S"]) == (Coordinate("S", Measure.TRAVEL), 130.0)
    again = solve_pose(LINKAGE, coordinate="crank", angle=pose.angles["crank"], near=NEAR | {"crank": 0.0})
    assert again.q == pytest.approx(pose.q, abs=1e-10)
    # The cosine rule about the crank's pin.
    away = math.hypot(130.0, OFFSET)
    turned = math.acos((A**2 + away**2 - B**2) / (2 * A * away))
    assert pose.angles["crank"] == pytest.approx(math.atan2(OFFSET, 130.0) + turned, abs=1e-12)


def test_the_motion_is_the_inverse_of_the_crank_driven_one() -> None:
    """Positions, speeds and accelerations at the travels that the turning crank gives agree to 1e-10."""
    angles = np.linspace(0.3, 2.6, 41)
    cranked = crank_driven(angles, speed=7.0, acceleration=3.0)
    travels = cranked.travel("S")
    column = len(LINKAGE.moving) + cranked.closure.slots.index("S")
    pushed = piston_driven(travels, speed=cranked.qdot[:, column], acceleration=cranked.qddot[:, column])
    size = np.abs(cranked.q).max()
    assert np.abs(pushed.q - cranked.q).max() < 1e-10 * size
    assert np.abs(pushed.qdot - cranked.qdot).max() < 1e-10 * np.abs(cranked.qdot).max()
    assert np.abs(pushed.qddot - cranked.qddot).max() < 1e-10 * np.abs(cranked.qddot).max()
    assert np.abs(pushed.points - cranked.points).max() < 1e-10 * size
    assert pushed.coordinate.slides
    assert pushed.pose(3).coordinate == pushed.coordinate


@pytest.mark.parametrize(("end", "stop"), [(170.0, LONGEST), (60.0, SHORTEST)])
def test_dead_points_are_named_by_their_travel(end: float, stop: float) -> None:
    """Crank and coupler in line, the piston at either end of its stroke, cannot turn the crank."""
    with pytest.raises(DeadPointError, match=r"driven by S, .* dead point at S = [\d.]+ mm before it reaches") as error:
        piston_driven(np.linspace(130.0, end, 5))
    assert error.value.angle == pytest.approx(stop, abs=1e-6)


def test_poses_next_to_a_dead_point_are_told_by_the_piston_and_not_by_the_crank() -> None:
    stretched = math.asin(OFFSET / (A + B))
    pose = solve_pose(LINKAGE, coordinate="crank", angle=stretched + 1e-4, near={"coupler": -0.1, "block": 0.0})
    assert pose.dead_point_distance(Coordinate("S", Measure.TRAVEL)) < 1e-3
    assert pose.dead_point_distance(Coordinate("crank")) > 0.1


def loads():
    return (
        PointLoad(link="block", point="C", wrench=np.array([-50.0, 3, 0, 0, 0, 0])),
        PointLoad(link="coupler", point="B", wrench=np.array([4.0, -9, 0, 0, 0, 60])),
    )


def test_what_the_crank_holds_the_piston_need_not() -> None:
    """The crank's torque put on as a load: the piston's drive force is zero, and all joint forces are the same."""
    pose = solve_pose(LINKAGE, coordinate="S", travel=130.0, near=NEAR)
    held = solve_statics(pose, CRANK, loads())
    torque = PointLoad(link="crank", point="A", wrench=np.array([0, 0, 0, 0, 0, held.drive_torque]))
    found = solve_statics(pose, PISTON, (*loads(), torque))
    assert abs(found.drive_force) < 1e-10 * 50.0
    for name, reaction in held.joints.items():
        assert found.joints[name].wrench == pytest.approx(reaction.wrench, abs=1e-9 * 50.0)


def test_the_drive_force_holds_what_pushes_the_piston() -> None:
    pose = solve_pose(LINKAGE, coordinate="S", travel=130.0, near=NEAR)
    push = (PointLoad(link="block", point="C", wrench=np.array([-50.0, 0, 0, 0, 0, 0])),)
    found = solve_statics(pose, PISTON, push)
    assert (found.drive_force, found.drive_torque) == (pytest.approx(50.0), 0.0)
    assert found.joints["S"].wrench[:2] == pytest.approx([50.0, 0.0], abs=1e-12)
    assert found.torque_on("block") == 0.0
    assert found.residual < 1e-14


@pytest.mark.parametrize("drive", [PISTON, Drive(link="rod", joint="S"), Drive(link="cylinder", joint="S")])
def test_the_drive_force_is_that_of_virtual_work(drive: Drive) -> None:
    """The last two: a cylinder that turns, its rod driven, and itself driven against the rod."""
    if drive.link == "block":
        motion = piston_driven(np.linspace(90.0, 150.0, 9))
        acting = loads()
    else:
        linkage = oscillating_cylinder(30, 80, 0.4)
        pose = solve_pose(linkage, coordinate="crank", angle=0.7, near={"cylinder": 3.0})
        pose = solve_pose(
            linkage, coordinate="S", travel=pose.travels["S"], near={x: pose.angles[x] for x in linkage.moving}
        )
        motion = solve_motion(pose, pose.travels["S"] + np.linspace(-8.0, 8.0, 9))
        acting = (
            PointLoad(link="crank", point="B", wrench=np.array([3.0, -7, 0, 0, 0, 50])),
            PointLoad(link="rod", point="N", wrench=np.array([1.0, 2, 0, 0, 0, 0])),
            PointLoad(link="cylinder", point="M", wrench=np.array([0.0, -4, 0, 0, 0, 0])),
        )
    stated = tuple(load for load in acting)
    force = virtual_work(motion, drive, stated)
    solved = kinetostatics(motion, drive, stated)
    size = np.abs(force).max()
    assert np.all(solved.drive_torque == 0.0)
    assert np.abs(solved.drive_force - force).max() < 1e-10 * size
    assert solved.residual.max() < 1e-12
    for i in (0, 4, 8):
        alone = solve_statics(motion.pose(i), drive, acting)
        assert alone.drive_force == pytest.approx(force[i], abs=1e-10 * size)
        for name, reaction in alone.joints.items():
            assert solved.forces[name][i] == pytest.approx(reaction.wrench[:2], abs=1e-9 * size)


def test_the_pistons_power_is_that_of_the_energies() -> None:
    motion = piston_driven(np.linspace(90.0, 150.0, 31), speed=400.0, acceleration=150.0)
    masses = {
        name: PartMass(mass=m, centroid=np.array([x, y]), inertia=i)
        for name, m, x, y, i in (
            ("crank", 2e-6, 15.0, 1.0, 4e-4),
            ("coupler", 5e-6, 55.0, -2.0, 7e-3),
            ("block", 8e-6, 1.0, 2.0, 1e-4),
        )
    }
    stated = tuple(load for load in loads())
    solved = kinetostatics(motion, PISTON, stated, masses)
    assert np.abs(solved.imbalance).max() < 1e-8 * np.abs(solved.drive_power).max()
    assert solved.dead_points == ()


def test_a_crank_that_carries_the_motion_finds_the_pistons_dead_points() -> None:
    motion = crank_driven(np.linspace(0.3, 0.3 + 2 * math.pi, 181))
    solved = kinetostatics(motion, PISTON, tuple(load for load in loads()))
    travels = motion.track.at(np.array(solved.dead_points))[:, -1]
    assert sorted(travels) == pytest.approx([SHORTEST, LONGEST], abs=1e-9)


def test_the_frame_holds_the_piston_alike() -> None:
    from slotted_cases import slider_crank as case_of

    case = case_of()
    pose = case.solve_pose()
    acting = (
        PointLoad(link="block", point="C", wrench=np.array([-5.0, 1, 0, 0, 0, 0])),
        PointLoad(link="rod", point="M", wrench=np.array([0.5, -2, 0, 0, 0, 8])),
    )
    expected = solve_statics(pose, PISTON, acting)
    frame = build_frame(case, pose, acting, held=PISTON)
    solution = solve_frame(frame.model)
    found = frame.reactions(solution.joint_wrenches, solution.residual)
    assert found.drive_force == pytest.approx(expected.drive_force, rel=1e-9)
    assert found.unknowns == pytest.approx(expected.unknowns, abs=1e-9 * 110.0 * 5.0)
    for name, reaction in expected.joints.items():
        assert found.joints[name].wrench == pytest.approx(reaction.wrench, abs=1e-9 * 110.0 * 5.0)


def test_a_travel_of_what_does_not_slide_is_refused() -> None:
    with pytest.raises(CaseError, match=r"'A' is no slider or slot.*choose among S"):
        solve_pose(LINKAGE, coordinate="A", travel=3.0, near=NEAR)
    with pytest.raises(CaseError, match=r"cannot be assembled with S at a travel of 170 mm: .*change the travel"):
        solve_pose(LINKAGE, coordinate="S", travel=170.0, near=NEAR)
    pose = solve_pose(LINKAGE, coordinate="S", travel=130.0, near=NEAR)
    with pytest.raises(CaseError, match="'crank' is not a slider or slot; choose one of S"):
        solve_motion(pose, [1.0], coordinate=Coordinate("crank", Measure.TRAVEL))


def test_a_link_and_a_slider_may_have_one_name() -> None:
    twin = Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), S=(0.0, OFFSET)),
            "crank": link(A=(0.0, 0.0), B=(A, 0.0)),
            "coupler": link(B=(0.0, 0.0), C=(B, 0.0)),
            "S": link(C=(0.0, 0.0), Q=(10.0, 5.0)),
        },
        {
            "A": joint("ground", "crank"),
            "B": joint("crank", "coupler"),
            "C": joint("coupler", "S"),
            "S": joint("ground", "S", type="slider", points=("S", "C")),
        },
    )
    pose = solve_pose(twin, coordinate="S", travel=130.0, near={"crank": 1.0, "coupler": -0.4, "S": 0.0})
    assert pose.travels["S"] == 130.0
    assert pose.angles["S"] == pytest.approx(0.0, abs=1e-12)
