"""Statics of n states at once, against the states one by one and virtual work; states without solution among others."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from planar_linkages import joint, link

from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import Motion, solve_motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.case.toleranced import Variable
from alula.loads.records.applied import PointLoad, chosen
from alula.loads.states.kinetostatics import relative_motion, torque_by_virtual_work, work
from alula.loads.states.play import play_at
from alula.loads.statics.friction import Friction, solve_friction
from alula.loads.statics.statics import Balance, Drive, assemble, balance, solve_statics

Real = NDArray[np.float64]
RANGE = np.linspace(-0.2, 0.2, 7)
A, B, C, D = 40.0, 120.0, 80.0, 100.0


# --- random linkages --------------------------------------------------------------------------------------------------


@st.composite
def linkages(draw) -> Linkage:
    """A crank and one to three pairs of links, each pair between two links of what stands: four to eight bars.

    All frames stand at the origin, so that places in the assembled pose are those in the links' frames.
    """
    pairs = draw(st.integers(1, 3))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    points: dict[str, dict[str, tuple[float, float]]] = {"ground": {}, "crank": {}}
    joints = {}

    def pinned(name: str, first: str, second: str, around: complex = 0.0) -> None:
        at = around + complex(*rng.uniform(-60.0, 60.0, size=2))
        points[first][name] = points[second][name] = (at.real, at.imag)
        joints[name] = joint(first, second, pin_diameter=f"{rng.uniform(3.0, 9.0)!r} mm", friction=rng.uniform(0, 0.1))

    pinned("A", "ground", "crank")
    for i in range(pairs):
        earlier = list(points)
        one, other = ("crank", "ground") if i == 0 else rng.choice(earlier, size=2, replace=False).tolist()
        points |= {f"near{i}": {}, f"far{i}": {}}
        pinned(f"P{i}", one, f"near{i}", complex(80.0 * i, 0.0))
        pinned(f"Q{i}", other, f"far{i}", complex(80.0 * i, 100.0))
        pinned(f"R{i}", f"near{i}", f"far{i}", complex(80.0 * i + 100.0, 50.0))
    links = {name: link(ground=name == "ground", **own, **{f"at_{name}": (9.0, 4.0)}) for name, own in points.items()}
    return Linkage(links, joints)


DRIVE = Drive(link="crank", joint="A")


def moved(linkage: Linkage) -> Motion:
    """Return the linkage over a range about where it stands; others than those that move freely are passed over."""
    near = {name: 0.0 for name in linkage.moving if name != "crank"}
    try:
        motion = solve_motion(solve_pose(linkage, coordinate="crank", angle=0.0, near=near), RANGE)
    except CaseError:
        assume(False)
        raise
    assume(assemble(motion.placement, DRIVE, ()).singular_values[:, -1].min() > 1e-2)
    return motion


def random_loads(linkage: Linkage, shape: tuple[int, ...], seed: int) -> list[PointLoad]:
    """Forces and moments at every link, others in every state."""
    rng = np.random.default_rng(seed)
    size = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 30.0])
    return [
        PointLoad(link=name, point=f"at_{name}", wrench=rng.normal(size=(*shape, 6)) * size) for name in linkage.moving
    ]


def of_one(loads: list[PointLoad], *state: int | slice) -> list[PointLoad]:
    return [chosen(load, state) for load in loads]


@given(linkages(), st.integers(0, 1000))
@settings(max_examples=25, deadline=None)
def test_states_at_once_are_the_states_one_by_one_and_keep_virtual_work(linkage: Linkage, seed: int) -> None:
    motion = moved(linkage)
    place, poses = motion.placement, len(RANGE)
    loads = random_loads(linkage, (2, poses), seed)
    both = balance(Placement(closure=place.closure, q=np.stack([place.q] * 2)), DRIVE, loads)
    assert both.sound.shape == (2, poses)
    assert both.sound.all()
    for case in range(2):
        torque = torque_by_virtual_work(motion, DRIVE, of_one(loads, case))
        size = np.abs(both.unknowns[case]).max()
        assert both.drive_torque[case] == pytest.approx(torque, abs=1e-9 * size)
        for i in range(poses):
            one = solve_statics(motion.pose(i), DRIVE, of_one(loads, case, i))
            assert both.unknowns[case, i] == pytest.approx(one.unknowns, abs=1e-11 * size)
            for name, reaction in one.joints.items():
                assert both.joints[name].wrench[case, i] == pytest.approx(reaction.wrench, abs=1e-11 * size)


@given(linkages(), st.integers(0, 1000), st.sampled_from([1.0, -1.0]))
@settings(max_examples=25, deadline=None)
def test_friction_of_states_at_once_is_that_one_by_one_and_takes_its_power(linkage: Linkage, seed: int, way) -> None:
    motion = moved(linkage)
    loads = random_loads(linkage, RANGE.shape, seed)
    every = solve_friction(motion.virtual, DRIVE, loads, way)
    rubbed = every.loads(motion.virtual)
    acting = (*loads, *rubbed)
    found = balance(motion.placement, DRIVE, acting)
    free = ~every.locked
    size = np.abs(every.unknowns[free]).max(initial=0.0)
    power = -work(acting, motion.placement, motion.virtual) / relative_motion(motion, DRIVE)
    assert found.unknowns[free] == pytest.approx(every.unknowns[free], abs=1e-9 * size)
    assert found.drive_torque[free] == pytest.approx(power[free], abs=1e-9 * size)
    assert np.all(way * work(rubbed, motion.placement, motion.virtual)[free] <= 1e-12 * size)  # it only takes
    for i in range(len(RANGE)):
        one = solve_friction(motion.virtual.chosen([i]), DRIVE, of_one(loads, slice(i, i + 1)), way)
        assert one.lock == pytest.approx(every.lock[i : i + 1], rel=1e-6)
        if free[i]:
            assert one.unknowns[0] == pytest.approx(every.unknowns[i], abs=1e-9 * size)


@given(linkages(), st.floats(-9.0, 0.0))
@settings(max_examples=25, deadline=None)
def test_states_are_told_regular_as_their_singular_values_have_it(linkage: Linkage, power: float) -> None:
    system = assemble(moved(linkage).placement, DRIVE, ())
    assert np.array_equal(system.regular(10.0**power), system.singular_values[:, -1] >= 10.0**power)


# --- states without a solution ----------------------------------------------------------------------------------------


def four_bar(**entries: object) -> Case:
    """A four-bar driven at its rocker, whose dead points lie where crank and coupler are in line."""
    pairs = {"A": ["base", "crank"], "B": ["crank", "coupler"], "C": ["coupler", "rocker"], "D": ["base", "rocker"]}
    loads = {"one": ["4 N", "-7 N"], "two": ["-2 N", "-5 N"]}
    return validate(
        {
            "schema_version": 1,
            "title": "four-bar",
            "links": {
                "base": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "D": [f"{D} mm", "0 mm"]}},
                "crank": {"points": {"A": ["0 mm", "0 mm"], "B": [f"{A} mm", "0 mm"]}},
                "coupler": {"points": {"B": ["0 mm", "0 mm"], "C": [f"{B} mm", "0 mm"]}},
                "rocker": {"points": {"D": ["0 mm", "0 mm"], "C": [f"{C} mm", "0 mm"]}},
            },
            "joints": {n: {"links": pair, **entries} for n, pair in pairs.items()},
            "pose": {"coordinate": "crank", "angle": "60 deg", "near": {"coupler": "20 deg", "rocker": "70 deg"}},
            "drive": {"link": "rocker", "joint": "D"},
            "load_cases": {
                name: {"direction": "forward", "forces": [{"link": "crank", "at": "B", "force": force}]}
                for name, force in loads.items()
            },
        }
    )


def angle_in_triangle(beside: float, other: float, opposite: float) -> float:
    return math.acos((beside**2 + other**2 - opposite**2) / (2.0 * beside * other))


DEAD = (angle_in_triangle(A + B, D, C), math.pi + angle_in_triangle(B - A, D, C))
ANGLES = (1.0, DEAD[0], 2.0, 2.6, DEAD[1], 4.6)
GOOD = np.array([True, False, True, True, False, True])


def placed(case: Case, angles: tuple[float, ...] = ANGLES) -> Placement:
    """The four-bar at some angles of its crank, by Freudenstein's equation."""
    rows = []
    for angle in angles:
        pin = A * np.exp(1j * angle)
        away = D - pin
        bend = math.acos(min((B**2 + abs(away) ** 2 - C**2) / (2.0 * B * abs(away)), 1.0))
        coupler = float(np.angle(away)) + bend
        rocker = float(np.angle(pin + B * np.exp(1j * coupler) - D))
        rows.append([angle, coupler, rocker])
    place = case.stated_pose.placement
    assert place.linkage.moving == ("crank", "coupler", "rocker")
    found = replace(place, q=np.array(rows))
    assert np.abs(place.closure.residual(found.q[0])).max() < 1e-10
    return found


def alone(place: Placement, state: int, case: Case) -> Pose:
    return replace(case.stated_pose, q=place.q[state])


def same_but_lost(found: Balance, of: Placement, case: Case, forces: PointLoad) -> None:
    assert np.array_equal(found.sound, GOOD)
    assert np.isnan(found.unknowns[~GOOD]).all()
    assert np.isnan(found.drive_torque[~GOOD]).all()
    for i in np.flatnonzero(GOOD):
        one = solve_statics(alone(of, int(i), case), found.drive, [forces])
        assert found.drive_torque[i] == pytest.approx(one.drive_torque, rel=1e-12)
        assert found.joints["C"].wrench[i] == pytest.approx(one.joints["C"].wrench, rel=1e-12, abs=1e-12)
    for i in np.flatnonzero(~GOOD):
        with pytest.raises(CaseError, match="dead point of the driven link 'rocker'"):
            solve_statics(alone(of, int(i), case), found.drive, [forces])


@pytest.mark.parametrize("force", [(4.0, -7.0), (-2.0, -5.0)])
def test_dead_points_leave_the_other_states_their_numbers(force: tuple[float, float]) -> None:
    case = four_bar()
    place, load = placed(case), PointLoad(link="crank", point="B", wrench=np.array([*force, 0, 0, 0, 0]))
    same_but_lost(balance(place, case.pinned_drive, [load]), place, case, load)


def exactly_singular(place: Placement) -> Placement:
    """The same with a third state whose matrix has a zero singular value to the last bit: all links along x."""
    return replace(place, q=np.concatenate([place.q, [[0.0, 0.0, 0.0]]]))


def test_a_state_with_an_exactly_singular_matrix_does_so_too() -> None:
    case = four_bar()
    place, load = exactly_singular(placed(case)), PointLoad(link="crank", point="B", wrench=np.eye(6)[1])
    found, without = (balance(one, case.pinned_drive, [load]) for one in (place, placed(case)))
    assert np.array_equal(found.sound, [*GOOD, False])
    assert np.array_equal(found.unknowns[:-1], without.unknowns, equal_nan=True)


def rubbed(case: Case, place: Placement, load: PointLoad, way: float) -> Friction:
    """Friction where the crank's angle moves the linkage."""
    q = place.q
    rows = [case.stated_pose.closure.jacobian(one) for one in q]
    held = np.array([1.0, 0.0, 0.0])
    rates = [np.linalg.lstsq(np.vstack([row, held]), [*np.zeros(len(row)), 1.0], rcond=None)[0] for row in rows]
    return solve_friction(replace(place, qdot=np.array(rates)), case.pinned_drive, [load], way)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_dead_points_and_locked_states_leave_the_others_their_friction(way: float) -> None:
    case = four_bar(pin_diameter="12 mm", friction=0.15)
    beside = tuple(angle + off for angle in DEAD for off in (-0.02, 0.02))
    place = exactly_singular(placed(case, (*ANGLES, *beside)))
    load = PointLoad(link="crank", point="B", wrench=np.array([4.0, -7.0, 0, 0, 0, 0]))
    every = rubbed(case, place, load, way)
    assert every.locked.any()  # beside the dead points, as the rocker drives
    lost = [1, 4, len(place.q) - 1]
    assert not every.locked[lost].any()
    assert np.isnan(every.unknowns[lost]).all()
    assert all(not np.any(wrench[lost]) for wrench in every.wrenches.values())
    assert (~every.locked).sum() >= len(lost) + 2
    for i in np.setdiff1d(np.arange(len(place.q)), lost):
        one = rubbed(case, place.chosen([i]), load, way)
        assert one.lock[0] == pytest.approx(every.lock[i], rel=1e-6)
        assert one.unknowns[0] == pytest.approx(every.unknowns[i], rel=1e-9, nan_ok=True)


@pytest.mark.parametrize("entries", [{}, {"pin_diameter": "12 mm", "friction": 0.1}], ids=["smooth", "rubbing"])
@pytest.mark.parametrize("load_case", ["one", "two"])
def test_dead_points_leave_the_play_of_other_states(load_case: str, entries: dict[str, object]) -> None:
    case = four_bar(clearance="0.04 mm", **entries)
    place = placed(case)
    every = play_at(case, load_case, place, {}, None, 0.0)
    assert every is not None
    here = every.solved({})
    sound = here.sound
    assert not sound[~GOOD].any()
    assert sound.sum() >= 3
    for i in np.flatnonzero(sound):
        one = play_at(case, load_case, place.chosen(i), {}, None, 0.0)
        assert one is not None
        assert here.effort[i] == pytest.approx(float(one.solved({}).effort), rel=1e-9)
        for key in ("effort", "distance", "force B"):
            assert every.slack(key)[i] == pytest.approx(float(one.slack(key)), rel=1e-5), key
    assert np.isinf(every.slack("effort")[~GOOD]).all()


@pytest.mark.parametrize("entries", [{}, {"pin_diameter": "12 mm", "friction": 0.15}], ids=["smooth", "rubbing"])
def test_samples_at_dead_points_leave_the_others_their_forces(entries: dict[str, object]) -> None:
    case = four_bar(**entries)
    off = np.array(ANGLES) - case.stated_pose.held
    angle = Variable(tolerance="pose", kind="pose", half=4.0, distribution="uniform")
    force = Variable(tolerance="load", kind="load", target=("two", -1), half=0.5, distribution="uniform")
    sampler = Sampler(case=case, pose=case.stated_pose, masses={}, variables=(angle, force))
    deviations = np.column_stack([off, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])
    every = sampler.states(deviations)
    assert not every.apart[GOOD].any()
    assert every.dead[~GOOD & ~every.apart].all()
    good = np.flatnonzero(every.good)
    assert len(good) >= 3
    for j, i in enumerate(good):
        one = sampler.states(deviations[i : i + 1])
        for name, forces in every.forces.items():
            assert forces.drive_torque[j] == pytest.approx(float(one.forces[name].drive_torque[0]), rel=1e-9)
            assert forces.sound.all()
            for joint_name, reaction in forces.joints.items():
                single = one.forces[name].joints[joint_name].wrench[0]
                assert reaction.wrench[j] == pytest.approx(single, rel=1e-9, abs=1e-9)
