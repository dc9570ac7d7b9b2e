import math
from collections.abc import Sequence

import numpy as np
import pytest
from planar_linkages import (
    OPEN_WING,
    four_bar,
    joint,
    link,
    oscillating_cylinder,
    quick_return,
    scotch_yoke,
    six_bar,
    slider_crank,
)

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.pose import Pose, constraint_jacobian, solve_pose
from alula.loads.records.applied import BodyForce, LineLoad, Load, PartMass, PointLoad
from alula.loads.statics.statics import NEARLY_SINGULAR, Drive, Reactions, assemble, check_drive, solve_statics

AE = Drive(link="AE", joint="A")


def force(name: str, point: str, *components: float) -> PointLoad:
    """Fx, Fy and, if given, Mz at a point of a link."""
    fx, fy, mz = (*components, 0.0)[:3]
    return PointLoad(link=name, point=point, wrench=np.array([fx, fy, 0.0, 0.0, 0.0, mz]))


WEIGHT = force("CH", "H", 0.0, -0.25)


def wing(angle: float = 228.15) -> Pose:
    return solve_pose(six_bar(), coordinate="GF", angle=math.radians(angle), near=OPEN_WING)


POSES = {
    "owl wing": (wing(), AE),
    "four-bar": (
        solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=0.7, near={"rocker": 1.0}),
        Drive(link="crank", joint="A"),
    ),
    "slider-crank": (
        solve_pose(slider_crank(40, 120, -20), coordinate="crank", angle=1.0, near={"coupler": -0.45}),
        Drive(link="crank", joint="A"),
    ),
    "scotch yoke": (solve_pose(scotch_yoke(30), coordinate="crank", angle=0.7), Drive(link="crank", joint="A")),
    "quick return": (
        solve_pose(quick_return(30, 80), coordinate="crank", angle=0.7, near={"lever": 1.5}),
        Drive(link="lever", joint="O"),
    ),
    "cylinder": (
        solve_pose(oscillating_cylinder(30, 80, 0.4), coordinate="crank", angle=0.7, near={"cylinder": 3.0}),
        Drive(link="cylinder", joint="O"),
    ),
    "drive between moving links": (
        solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=0.7, near={"rocker": 1.0}),
        Drive(link="coupler", joint="B"),
    ),
}


def random_loads(pose: Pose, seed: int = 0) -> list[Load]:
    """A force and a moment at every point of every moving link, and spread and body forces."""
    rng = np.random.default_rng(seed)
    loads: list[Load] = []
    for name in pose.linkage.moving:
        loads += [force(name, point, *rng.normal(size=3) * [1, 1, 20]) for point in pose.linkage.links[name].points]
        ends = rng.normal(size=(2, 3))
        loads.append(LineLoad(link=name, start=-3.0, end=17.0, at_start=ends[0], at_end=ends[1]))
        mass = PartMass(mass=2e-6, centroid=rng.normal(size=2) * 9)
        loads.append(BodyForce(link=name, mass=mass, specific_force=rng.normal(size=3) * 1e4))
    return loads


def unbalanced(reactions: Reactions, loads: Sequence[Load], name: str) -> tuple[np.ndarray, float, float]:
    """What is left of the forces and of the moments about the global origin on one link, and the forces' size.

    Written from the cut-free link alone: nothing of ``alula.loads.statics.statics`` but its answers is used.
    """
    pose = reactions.pose
    total, moment, size = np.zeros(2), 0.0, 0.0

    def act(at: np.ndarray, f: np.ndarray, m: float) -> None:
        nonlocal total, moment, size
        total = total + f
        moment += at[0] * f[1] - at[1] * f[0] + m
        size = max(size, float(np.linalg.norm(f)))

    for joint_name, reaction in reactions.joints.items():
        if name in (reaction.on, reaction.by):
            # The pin of a slot stands at the second link's point.
            at = pose.position(reaction.on, pose.linkage.point_of(joint_name, reaction.on))
            sign = 1.0 if name == reaction.on else -1.0
            act(at, sign * reaction.wrench[:2], sign * reaction.wrench[5])
    for load in loads:
        if load.link == name and isinstance(load, PointLoad):
            act(pose.position(name, load.point), load.wrench[:2], load.wrench[5])
        elif load.link == name and isinstance(load, BodyForce):
            mass = load.mass
            act(pose.origins[name] + pose.rotation(name) @ mass.centroid, mass.mass * load.specific_force[:2], 0.0)
        elif load.link == name and isinstance(load, LineLoad):
            nodes, weights = np.polynomial.legendre.leggauss(4)
            for t, w in zip((nodes + 1) / 2, weights / 2, strict=True):
                here = load.start + t * (load.end - load.start)
                density = (1 - t) * load.at_start + t * load.at_end
                at = pose.origins[name] + here * pose.rotation(name)[:, 0]
                act(at, w * (load.end - load.start) * density[:2], 0.0)
    return total, moment + reactions.torque_on(name), size


@pytest.mark.parametrize("case", POSES)
def test_every_link_balances(case: str) -> None:
    pose, drive = POSES[case]
    loads = random_loads(pose)
    reactions = solve_statics(pose, drive, loads)
    for name in pose.linkage.moving:
        total, moment, size = unbalanced(reactions, loads, name)
        assert np.linalg.norm(total) < 1e-10 * size
        assert abs(moment) < 1e-10 * size * pose.linkage.longest
    assert reactions.residual < 1e-12


@pytest.mark.parametrize("case", POSES)
def test_the_ground_bears_all_loads(case: str) -> None:
    """Forces and moments on the ground are the sum of all loads on the moving links."""
    pose, drive = POSES[case]
    loads = random_loads(pose)
    reactions = solve_statics(pose, drive, loads)
    total, moment, size = unbalanced(reactions, loads, pose.linkage.ground)
    wrench = np.zeros(6)
    for load in loads:
        resultant = load.resultant(pose.placement)
        at = pose.origins[load.link]
        wrench += [*resultant[:5], resultant[5] + at[0] * resultant[1] - at[1] * resultant[0]]
    np.testing.assert_allclose(total, wrench[:2], atol=1e-10 * size)
    assert moment == pytest.approx(wrench[5], abs=1e-10 * size * pose.linkage.longest)


@pytest.mark.parametrize("case", POSES)
def test_the_matrix_is_the_constraint_jacobian_transposed(case: str) -> None:
    """Duality: joint forces do no work, so the scaled statics matrix is -J^T with a column for the drive."""
    pose, drive = POSES[case]
    system = assemble(pose.placement, drive, [])
    jacobian = constraint_jacobian(pose)
    torque = np.zeros(jacobian.shape[1])
    for name in pose.linkage.joints[drive.joint].links:
        if name != pose.linkage.ground:
            torque[3 * pose.linkage.moving.index(name) + 2] = 1.0 if name == drive.link else -1.0
    np.testing.assert_allclose(system.scaled, np.column_stack([jacobian.T, torque]), atol=1e-13)


def test_the_smallest_singular_value_is_the_dead_point_distance() -> None:
    for angle in (216.0, 222.0, 228.15):
        pose = wing(angle)
        system = assemble(pose.placement, AE, [])
        assert system.singular_values[-1] == pytest.approx(pose.dead_point_distance(Coordinate("AE")), rel=1e-9)


@pytest.mark.parametrize("case", POSES)
def test_the_drive_is_as_far_from_its_dead_point_as_its_equations_say(case: str) -> None:
    """Also between two moving links, where neither angle alone is held."""
    pose, drive = POSES[case]
    system = assemble(pose.placement, drive, [])
    assert drive.dead_point_distance(pose) == pytest.approx(system.singular_values[-1], rel=1e-9)


def test_superposition_and_scaling() -> None:
    pose = wing()
    one, two = random_loads(pose, 1), random_loads(pose, 2)
    solved = [solve_statics(pose, AE, loads).unknowns for loads in (one, two, one + two)]
    np.testing.assert_allclose(solved[0] + solved[1], solved[2], rtol=1e-10, atol=1e-9)
    assert not np.any(solve_statics(pose, AE, []).unknowns)


def test_a_moment_may_be_applied_at_any_point_of_its_link() -> None:
    pose = wing()
    at = [solve_statics(pose, AE, [force("CF", point, 0, 0, 7.0)]).unknowns for point in "FBC"]
    np.testing.assert_allclose(at[0], at[1], atol=1e-12)
    np.testing.assert_allclose(at[0], at[2], atol=1e-12)


def test_an_even_line_load_acts_as_its_resultant_at_the_middle() -> None:
    pose = wing()
    density = np.array([0.01, -0.02, 0.0])
    spread = LineLoad(link="CH", start=0.0, end=124.0, at_start=density, at_end=density)
    middle = BodyForce(link="CH", mass=PartMass(mass=124.0, centroid=np.array([62.0, 0.0])), specific_force=density)
    np.testing.assert_allclose(spread.resultant(pose.placement), middle.resultant(pose.placement), atol=1e-12)


def test_a_triangular_line_load_acts_at_two_thirds() -> None:
    pose = wing()
    spread = LineLoad(link="CH", start=31.0, end=124.0, at_start=np.zeros(3), at_end=np.array([0.0, 2.0, 1.0]))
    mass = PartMass(mass=93.0, centroid=np.array([93.0, 0.0]))
    at = BodyForce(link="CH", mass=mass, specific_force=np.array([0.0, 1.0, 0.5]))
    np.testing.assert_allclose(spread.resultant(pose.placement), at.resultant(pose.placement), atol=1e-10)


def test_loads_on_the_ground_and_out_of_the_plane_do_not_enter() -> None:
    pose = wing()
    aside = PointLoad(link="CH", point="H", wrench=np.array([0.0, 0.0, 5.0, 6.0, 7.0, 0.0]))
    loads = [WEIGHT, force("AG", "G", 3.0, 4.0, 5.0), aside]
    np.testing.assert_array_equal(solve_statics(pose, AE, loads).unknowns, solve_statics(pose, AE, [WEIGHT]).unknowns)


def test_a_two_force_link_pulls_along_its_line() -> None:
    reactions = solve_statics(wing(), AE, [WEIGHT])
    for name, pins in (("GF", "GF"), ("ED", "ED")):
        along = reactions.pose.rotation(name)[:, 0]
        for pin in pins:
            f = reactions.joints[pin].wrench[:2]
            assert abs(along[0] * f[1] - along[1] * f[0]) < 1e-12


def test_wrenches_of_a_link_balance_with_the_torque_on_it() -> None:
    reactions = solve_statics(wing(), AE, [])
    assert reactions.torque_on("AE") == 0.0
    reactions = solve_statics(wing(), AE, [WEIGHT])
    assert reactions.torque_on("AE") == reactions.drive_torque
    assert reactions.torque_on("AG") == -reactions.drive_torque
    assert reactions.torque_on("CH") == 0.0
    total = sum(wrench for _, wrench in reactions.on_link("CH"))
    np.testing.assert_allclose(total[:2], [0.0, 0.25], atol=1e-12)
    assert {point for point, _ in reactions.on_link("AE")} == {"A", "B", "E"}


def test_rows_and_columns_have_names() -> None:
    system = assemble(POSES["slider-crank"][0].placement, POSES["slider-crank"][1], [])
    assert system.columns == ("RAx", "RAy", "RBx", "RBy", "RCx", "RCy", "NS", "M:S", "T")
    assert system.rows[:3] == (("crank", "Fx"), ("crank", "Fy"), ("crank", "Mz"))
    assert system.matrix.shape == (9, 9)


@pytest.mark.parametrize("factor", [1e-3, 0.1, 25.4, 1e3])
def test_the_condition_does_not_depend_on_the_unit_of_length(factor: float) -> None:
    near = dict(OPEN_WING)
    scaled = solve_pose(six_bar(factor), coordinate="GF", angle=math.radians(228.15), near=near)
    one, other = assemble(wing().placement, AE, []), assemble(scaled.placement, AE, [])
    assert other.condition == pytest.approx(one.condition, rel=1e-9)
    np.testing.assert_allclose(other.singular_values, one.singular_values, rtol=1e-9)


# ---- poses and drives that are refused ---------------------------------------------------------------------


def _dead_point() -> float:
    """Direction of GF where B, F and G lie in one line, so that AE stands still [degrees]."""
    return 270.0 - math.degrees(math.acos((125**2 + 110**2 - 112**2) / (2 * 125 * 110)))


@pytest.mark.parametrize("away", [0.0, 1e-6, 1e-4])
def test_at_a_dead_point_of_the_driven_link_statics_is_refused(away: float) -> None:
    angle = _dead_point() + away
    pose = solve_pose(
        six_bar(), coordinate="GF", angle=math.radians(angle), near=OPEN_WING | {"CF": math.radians(angle)}
    )
    assert assemble(pose.placement, AE, []).singular_values[-1] < NEARLY_SINGULAR
    with pytest.raises(CaseError, match=r"dead point of the driven link 'AE'.*change the pose or drive another link"):
        solve_statics(pose, AE, [WEIGHT])


def test_beside_the_dead_point_and_with_the_other_drive_statics_works() -> None:
    """Control: the same pose driven by GF, and a pose one degree away, are answered."""
    angle = _dead_point()
    pose = solve_pose(
        six_bar(), coordinate="GF", angle=math.radians(angle), near=OPEN_WING | {"CF": math.radians(angle)}
    )
    assert solve_statics(pose, Drive(link="GF", joint="G"), [WEIGHT]).residual < 1e-12
    assert solve_statics(wing(angle + 1.0), AE, [WEIGHT]).residual < 1e-12


def test_a_structure_that_can_move_after_all_is_refused() -> None:
    """Two bars in one line between two pins: Gruebler counts 0, but their middle pin is free to start moving."""
    flat = Linkage(
        {"0": link(ground=True, A=(0, 0), E=(100, 0)), "1": link(A=(0, 0), B=(60, 0)), "2": link(B=(0, 0), E=(40, 0))},
        {"A": joint("0", "1"), "B": joint("1", "2"), "E": joint("0", "2")},
    )
    pose = solve_pose(flat, coordinate=None, near={"1": 0.0, "2": 0.0})
    with pytest.raises(CaseError, match="dead point of the structure"):
        solve_statics(pose, None, [force("1", "B", 0, -1)])


def test_a_truss_of_two_bars_bears_its_load() -> None:
    """Control: bars of 80 mm over 96 mm. N = P / (2 sin), with sin = 64/80."""
    truss = Linkage(
        {"0": link(ground=True, A=(0, 0), E=(96, 0)), "1": link(A=(0, 0), B=(80, 0)), "2": link(E=(0, 0), B=(80, 0))},
        {"A": joint("0", "1"), "B": joint("1", "2"), "E": joint("0", "2")},
    )
    pose = solve_pose(truss, coordinate=None, near={"1": 1.0, "2": 2.2})
    reactions = solve_statics(pose, None, [force("1", "B", 0, -10.0)])
    assert reactions.joints["A"].magnitude == pytest.approx(10 / (2 * 0.8))
    np.testing.assert_allclose(reactions.joints["A"].wrench[:2], [3.75, 5.0], atol=1e-12)
    assert reactions.drive_torque == 0.0


def test_without_a_drive_there_are_too_few_unknowns() -> None:
    with pytest.raises(CaseError, match=r"15 equilibrium equations for 14 unknowns.*mobility 1"):
        solve_statics(wing(), None, [WEIGHT])


@pytest.mark.parametrize(
    ("drive", "words"),
    [
        (Drive(link="AG", joint="A"), "drive.link: 'AG' is not a moving link; choose one of GF, AE, CF, CH, ED"),
        (Drive(link="nobody", joint="A"), "drive.link: 'nobody' is not a moving link"),
        (Drive(link="AE", joint="C"), "drive.joint: 'C' is no joint of link 'AE'; choose one of A, B, E"),
        (Drive(link="AE", joint="nowhere"), "drive.joint: 'nowhere'"),
    ],
)
def test_drives_that_do_not_fit(drive: Drive, words: str) -> None:
    with pytest.raises(CaseError, match=words):
        check_drive(six_bar(), drive)


def test_inputs_are_left_unchanged() -> None:
    pose = wing()
    loads = random_loads(pose)
    before = [{k: np.copy(v) for k, v in vars(load).items()} for load in loads]
    q = pose.q.copy()
    solve_statics(pose, AE, loads)
    for load, copy in zip(loads, before, strict=True):
        for key, value in copy.items():
            np.testing.assert_array_equal(getattr(load, key), value)
    np.testing.assert_array_equal(pose.q, q)
