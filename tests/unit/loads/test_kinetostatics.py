"""Joint forces and drive torque over a motion: single poses, closed forms, superposition, virtual work."""

import math
import tomllib

import numpy as np
import pytest
from closed_forms import slider_crank_motion
from motion_poses import (
    CRANK,
    drive_of,
    forces_of,
    four_bar_pose,
    kinetostatics,
    masses_of,
    parallelogram_pose,
    quick_return_pose,
    scotch_yoke_pose,
    slider_crank_pose,
    virtual_work,
    weights_of,
    wing_pose,
)
from planar_linkages import four_bar
from rocker_case import TOML

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.loads.case.case_file import validate
from alula.loads.records.applied import PartMass, PointLoad
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.dead_point_reach import way_to_dead_point
from alula.loads.states.kinetostatics import is_determinate
from alula.loads.statics.statics import Drive, solve_statics

TURN = CRANK + np.linspace(0.0, 2.0 * math.pi, 49)
WING = np.radians(np.linspace(228.15, 124.62, 49))
SYSTEMS = pytest.mark.parametrize(
    ("pose", "angles"),
    [
        (four_bar_pose(), TURN),
        (slider_crank_pose(), TURN),
        (quick_return_pose(), TURN),
        (scotch_yoke_pose(), TURN),
        (wing_pose(), WING),
    ],
    ids=["four-bar", "slider-crank", "pin-in-slot", "scotch-yoke", "six-bar"],
)


def force_at(link, point, x, y, axes="global"):
    return PointLoad(link=link, point=point, wrench=np.array([x, y, 0.0, 0.0, 0.0, 0.0]), axes=axes)


@SYSTEMS
def test_a_single_pose_is_that_of_statics(pose, angles):
    motion, drive = solve_motion(pose, angles), drive_of(pose)
    stated = forces_of(pose) + weights_of(pose)
    found = kinetostatics(motion, drive, stated)
    for i in range(0, len(angles), 6):
        if found.leverage[i] < 0.02:
            continue
        here = motion.pose(i)
        one = solve_statics(here, drive, stated)
        size = np.max(np.abs(one.unknowns))
        assert found.drive_torque[i] == pytest.approx(one.drive_torque, abs=1e-12 * size)
        for joint, reaction in one.joints.items():
            np.testing.assert_allclose(found.forces[joint][i], reaction.wrench[:2], rtol=0, atol=1e-12 * size)
            if joint in found.moments:
                assert found.moments[joint][i] == pytest.approx(reaction.wrench[5], abs=1e-12 * size)
    assert np.nanmax(found.residual) < 1e-10


@SYSTEMS
def test_drive_torque_by_virtual_work(pose, angles):
    """The joint forces do no work, so the torque follows from velocities alone."""
    motion, drive = solve_motion(pose, angles, speed=9.0, acceleration=20.0), drive_of(pose)
    stated, masses = forces_of(pose) + weights_of(pose), masses_of(pose)
    found = kinetostatics(motion, drive, stated, masses)
    other = virtual_work(motion, drive, stated, masses)
    clear = found.leverage > 1e-3
    np.testing.assert_allclose(
        found.drive_torque[clear], other[clear], rtol=0, atol=1e-10 * np.max(np.abs(other[clear]))
    )


@SYSTEMS
def test_loads_and_inertia_superpose(pose, angles):
    motion, drive = solve_motion(pose, angles, speed=9.0), drive_of(pose)
    forces, weights, masses = forces_of(pose), weights_of(pose), masses_of(pose)
    both = kinetostatics(motion, drive, forces + weights, masses)
    parts = [
        kinetostatics(motion, drive, forces),
        kinetostatics(motion, drive, weights),
        kinetostatics(motion, drive, [], masses),
    ]
    clear = both.leverage > 1e-3
    for joint, force in both.forces.items():
        total = sum(part.forces[joint] for part in parts)
        np.testing.assert_allclose(force[clear], total[clear], rtol=0, atol=1e-10 * np.max(np.abs(force[clear])))
    total = sum(part.drive_torque for part in parts)
    np.testing.assert_allclose(
        both.drive_torque[clear], total[clear], rtol=0, atol=1e-10 * np.max(np.abs(total[clear]))
    )


def test_a_turning_crank_pulls_at_its_bearing():
    """A mass m at radius r turns with m r omega² and m r alpha; the torque is I alpha."""
    pose = four_bar_pose()
    omega, alpha, mass, radius, inertia = 30.0, 12.0, 2e-5, 25.0, 3e-3
    motion = solve_motion(pose, TURN, speed=omega, acceleration=alpha)
    own = {"crank": PartMass(mass=mass, centroid=np.array([radius, 0.0]), inertia=inertia)}
    found = kinetostatics(motion, drive_of(pose), [], own)
    z = np.exp(1j * TURN) * mass * radius * (1j * alpha - omega**2)
    np.testing.assert_allclose(found.forces["A"], np.stack([z.real, z.imag], axis=1), atol=1e-12)
    np.testing.assert_allclose(found.drive_torque, (inertia + mass * radius**2) * alpha, atol=1e-12)
    np.testing.assert_allclose(found.forces["C"], 0.0, atol=1e-14)


def test_the_block_of_a_slider_crank_pushes_the_rod():
    """With mass in the block alone the rod is a two-force link; its force is m a / cos of its slope."""
    pose = slider_crank_pose(offset=0.0)
    mass, omega = 4e-5, 25.0
    motion = solve_motion(pose, TURN, speed=omega)
    own = {"block": PartMass(mass=mass, centroid=np.zeros(2), inertia=1.0)}
    found = kinetostatics(motion, drive_of(pose), [], own)
    norton = min(
        (slider_crank_motion(40.0, 130.0, 0.0, TURN, omega, branch=branch) for branch in ("open", "crossed")),
        key=lambda m: np.max(np.abs(m.d - motion.travel("S"))),
    )
    push = mass * np.asarray(norton.d_ddot)
    np.testing.assert_allclose(found.forces["C"][:, 0], push, atol=1e-10)
    np.testing.assert_allclose(found.forces["S"][:, 0], 0.0, atol=1e-14)
    slope = motion.angle("coupler")
    np.testing.assert_allclose(found.forces["C"][:, 1], push * np.tan(slope), atol=1e-10)
    np.testing.assert_allclose(found.forces["S"][:, 1], -push * np.tan(slope), atol=1e-10)
    np.testing.assert_allclose(found.moments["S"], 0.0, atol=1e-10)
    np.testing.assert_allclose(found.drive_torque * omega, push * np.asarray(norton.d_dot), atol=1e-8)


def test_an_uncentred_force_on_the_block_is_held_by_the_slide():
    pose = slider_crank_pose()
    found = kinetostatics(solve_motion(pose, TURN), drive_of(pose), [force_at("block", "Q", 3.0, 0.0)])
    np.testing.assert_allclose(found.moments["S"], 3.0 * 5.0, atol=1e-10)


def test_owl_wing_closed():
    """Under 0.25 N at H with F at 124.62°: joint A 0.2157 N, D and E 0.4121 N, drive torque 19.90 N mm."""
    motion = solve_motion(wing_pose(), WING)
    found = kinetostatics(motion, Drive(link="AE", joint="A"), [force_at("CH", "H", 0.0, -0.25)])
    sizes = {joint: float(np.hypot(*force[-1])) for joint, force in found.forces.items()}
    assert sizes["A"] == pytest.approx(0.2157, abs=5e-5)
    assert sizes["D"] == pytest.approx(0.4121, abs=5e-5)
    assert sizes["E"] == pytest.approx(0.4121, abs=5e-5)
    assert abs(found.drive_torque[-1]) == pytest.approx(19.90, abs=5e-3)
    [dead] = found.dead_points
    assert math.degrees(dead) == pytest.approx(213.51, abs=5e-3)


def test_at_a_dead_point_of_the_driven_link_the_torque_is_unbounded():
    pose, drive, load = wing_pose(), Drive(link="AE", joint="A"), [force_at("CH", "H", 0.0, -0.25)]
    [dead] = solve_motion(pose, WING).turning_points("AE")
    motion = solve_motion(pose, [dead - 1e-3, dead, dead + 1e-3])
    found = kinetostatics(motion, drive, load)
    assert np.isnan(found.drive_torque).tolist() == [False, True, False]
    assert np.isnan(found.forces["A"][1]).all()
    assert np.isnan(virtual_work(motion, drive, load)[1])
    assert found.drive_torque[0] * found.drive_torque[2] < 0.0
    assert min(abs(found.drive_torque[[0, 2]])) > 100.0 * 19.90
    # Driven at GF instead the same pose is an ordinary one.
    other = kinetostatics(motion, Drive(link="GF", joint="G"), load)
    assert np.ptp(other.drive_torque) < 0.01 * abs(other.drive_torque[1])
    assert other.dead_points == ()


def test_leverage_bounds_the_smallest_singular_value():
    pose = wing_pose()
    motion, drive = solve_motion(pose, WING), drive_of(pose)
    found = kinetostatics(motion, drive, [])
    for i in range(0, len(WING), 8):
        smallest = solve_statics(motion.pose(i), drive, []).system.singular_values[-1]
        assert smallest <= found.leverage[i] * (1.0 + 1e-9) <= 1.0


def test_a_force_in_the_axes_of_its_link_turns_with_it():
    pose = four_bar_pose()
    motion = solve_motion(pose, TURN)
    found = kinetostatics(motion, drive_of(pose), [force_at("crank", "B", 0.0, 2.0, axes="link")])
    np.testing.assert_allclose(found.drive_torque, -2.0 * 40.0, atol=1e-11)


def test_redundant_linkages_have_a_torque_but_no_joint_forces():
    pose = parallelogram_pose()
    motion = solve_motion(pose, TURN, speed=5.0)
    drive = Drive(link="crank", joint="P")
    load, own = [force_at("top", "V", 1.0, -2.0)], {"top": PartMass(mass=1e-5, centroid=np.array([50.0, 0.0]))}
    assert not is_determinate(pose.linkage)
    with pytest.raises(CaseError, match="12 equilibrium equations for 13 unknowns"):
        kinetostatics(motion, drive, load, own)
    # Without the third crank the joint forces follow, and the torque is the same.
    plain = solve_pose(
        four_bar(30.0, 100.0, 30.0, 100.0), coordinate="crank", angle=CRANK, near={"coupler": 0.0, "rocker": CRANK}
    )
    span = np.linspace(CRANK, 3.0, 9)
    half = kinetostatics(
        solve_motion(plain, span, speed=5.0),
        Drive(link="crank", joint="A"),
        [force_at("coupler", "C", 1.0, -2.0)],
        {"coupler": PartMass(mass=1e-5, centroid=np.array([50.0, 0.0]))},
    )
    torque = virtual_work(solve_motion(pose, span, speed=5.0), drive, load, own)
    np.testing.assert_allclose(torque, half.drive_torque, atol=1e-10)


def test_a_link_that_does_not_turn_cannot_drive():
    pose, drive = wing_pose(), Drive(link="AE", joint="A")
    [dead] = solve_motion(pose, WING).turning_points("AE")
    with pytest.raises(CaseError, match=r"drive\.link: 'AE' does not move at joint 'A'"):
        kinetostatics(solve_motion(pose, [dead]), drive, [])


def test_a_drive_between_two_moving_links():
    """The block turned against the rod: the same power as a torque at the crank's bearing gives."""
    pose = slider_crank_pose()
    motion, stated = solve_motion(pose, TURN, speed=3.0), forces_of(pose)
    found = kinetostatics(motion, Drive(link="block", joint="C"), stated)
    crank = kinetostatics(motion, Drive(link="crank", joint="A"), stated)
    clear = found.leverage > 1e-2
    np.testing.assert_allclose(found.drive_power[clear], crank.drive_power[clear], atol=1e-9 * 3e3)
    assert len(found.dead_points) == 2


def test_without_drive():
    with pytest.raises(CaseError, match="nothing drives it"):
        kinetostatics(solve_motion(four_bar_pose(), TURN), None, [])


def test_loads_on_the_ground_do_nothing():
    pose = four_bar_pose()
    motion, drive = solve_motion(pose, TURN), drive_of(pose)
    stated = forces_of(pose)
    ground = PointLoad(link="ground", point="D", wrench=np.arange(6.0))
    both, alone = kinetostatics(motion, drive, [*stated, ground]), kinetostatics(motion, drive, stated)
    np.testing.assert_array_equal(both.drive_torque, alone.drive_torque)


LOWER, UPPER = (
    180.0 - math.degrees(math.acos((60.0**2 + 40.0**2 - (60.0 + way * 20.0) ** 2) / (2.0 * 60.0 * 40.0)))
    for way in (1.0, -1.0)
)
"""Directions of the rocker where coupler and crank, 60 and 20 mm, are in line: 75.5 and 138.6 degrees."""


@pytest.mark.parametrize(("ends", "way"), [((90.0, 120.0), 90.0 - LOWER), ((100.0, 130.0), UPPER - 130.0)])
@pytest.mark.parametrize("back", [False, True])
def test_the_way_to_a_dead_point_is_that_from_the_nearer_end_of_the_range(ends, way, back):
    """A rocker that drives turns between crank and coupler stretched out and folded, by the law of cosines."""
    data = tomllib.loads(TOML)
    for entry in ("parts", "solid"):
        del data[entry]
    data["links"]["rocker"] = {"points": data["links"]["rocker"]["points"]}
    data["pose"] = {"coordinate": "rocker", "angle": "100 deg", "near": {"crank": "100 deg", "coupler": "19 deg"}}
    data["drive"] = {"link": "rocker", "joint": "O4"}
    first, last = ends[::-1] if back else ends
    data["motion"] = {"range": [f"{first} deg", f"{last} deg"], "poses": 7}
    moved = solve_case_motion(validate(data))
    assert math.degrees(way_to_dead_point(moved)) == pytest.approx(way, abs=1e-6)
