import math
from itertools import pairwise

import numpy as np
import pytest
from planar_linkages import (
    OPEN_WING,
    deg,
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
from alula.geometry.linkage.pose import CLOSED, Pose, constraint_jacobian, nearest_pose, solve_pose

ANGLE = math.radians(40)


def _degrees(pose: Pose, name: str) -> float:
    return math.degrees(pose.angles[name])


def _wing(angle: float = 228.15) -> Pose:
    return solve_pose(six_bar(), coordinate="GF", angle=math.radians(angle), near=OPEN_WING)


def _turned(a: float, b: float) -> float:
    return abs((a - b + 180.0) % 360.0 - 180.0)


@pytest.mark.parametrize(
    ("near", "coupler", "rocker"),
    [({"coupler": 0.3, "rocker": 1.0}, 20.2979, 57.3249), ({"coupler": -1.0, "rocker": -1.7}, -60.9780, -98.0050)],
)
def test_four_bar_open_and_crossed(near: dict[str, float], coupler: float, rocker: float) -> None:
    """Norton, Design of Machinery, 5th ed., example 4-1: a 40, b 120, c 80, d 100, θ2 40°."""
    pose = solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=ANGLE, near=near)
    assert _degrees(pose, "coupler") == pytest.approx(coupler, abs=1e-4)
    assert _degrees(pose, "rocker") == pytest.approx(rocker, abs=1e-4)
    assert pose.residual <= CLOSED


@pytest.mark.parametrize(
    ("near", "coupler", "travel"), [(math.radians(-27), -27.087, 126.838), (math.radians(207), 207.087, -86.838)]
)
def test_offset_slider_crank(near: float, coupler: float, travel: float) -> None:
    """Norton, example 4-2: a 40, b 120, offset -20, θ2 60°. Its θ3 points from slider to crank: 152.913°, 27.087°."""
    linkage = slider_crank(40, 120, -20)
    pose = solve_pose(linkage, coordinate="crank", angle=math.radians(60), near={"coupler": near})
    assert _turned(_degrees(pose, "coupler"), coupler) < 6e-4
    np.testing.assert_allclose(pose.position("block", "C"), [travel, -20.0], atol=6e-4)
    assert pose.angles["block"] == pytest.approx(0.0, abs=1e-12)


def test_scotch_yoke_is_harmonic() -> None:
    for angle in np.linspace(0.1, 6.2, 9):
        pose = solve_pose(scotch_yoke(30), coordinate="crank", angle=float(angle))
        assert pose.position("yoke", "Y")[0] == pytest.approx(30 * math.cos(angle), abs=1e-9)
        assert pose.residual <= CLOSED


def test_quick_return_points_at_the_pin() -> None:
    for angle in np.linspace(0.0, 6.0, 7):
        pose = solve_pose(quick_return(30, 80), coordinate="crank", angle=float(angle), near={"lever": math.pi / 2})
        lever = math.atan2(80 + 30 * math.sin(angle), 30 * math.cos(angle))
        assert _turned(_degrees(pose, "lever"), math.degrees(lever)) < 1e-9
        travel = math.hypot(80 + 30 * math.sin(angle), 30 * math.cos(angle))
        assert pose.q[-1] == pytest.approx(travel, abs=1e-9)


@pytest.mark.parametrize("bent", [0.0, 0.4])
def test_a_slider_between_two_moving_links_keeps_its_angle(bent: float) -> None:
    for angle in (0.5, 2.0, 4.0):
        pose = solve_pose(
            oscillating_cylinder(30, 80, bent), coordinate="crank", angle=angle, near={"cylinder": math.pi}
        )
        pin = 30 * np.exp(1j * angle) - 80
        assert _turned(_degrees(pose, "cylinder"), math.degrees(np.angle(pin))) < 1e-9
        assert _turned(_degrees(pose, "rod"), math.degrees(np.angle(pin) + bent)) < 1e-9
        assert pose.q[-1] == pytest.approx(abs(pin), abs=1e-9)


def test_a_slider_whose_second_link_is_the_ground() -> None:
    """The second link keeps the angle to the first: the ground stands 30° on from the block."""
    links = slider_crank(40, 120, -20).links
    joints = dict(slider_crank(40, 120, -20).joints)
    joints["S"] = joint("block", "ground", type="slider", points=("C", "S"), angle=deg(30.0), direction=deg(30.0))
    pose = solve_pose(Linkage(links, joints), coordinate="crank", angle=math.pi / 3, near={"coupler": -0.47})
    assert _degrees(pose, "block") == pytest.approx(-30.0)
    np.testing.assert_allclose(pose.position("block", "C"), [126.838, -20.0], atol=6e-4)


def test_a_structure_has_a_pose_without_coordinate() -> None:
    triangle = Linkage(
        {"0": link(ground=True, A=(0, 0), E=(96, 0)), "1": link(A=(0, 0), B=(80, 0)), "2": link(E=(0, 0), B=(80, 0))},
        {"A": joint("0", "1"), "B": joint("1", "2"), "E": joint("0", "2")},
    )
    pose = solve_pose(triangle, coordinate=None, near={"1": 1.0})
    np.testing.assert_allclose(pose.points["B"], [48.0, 64.0], atol=1e-9)
    assert pose.coordinate is None


def test_points_rotation_and_origins_agree() -> None:
    pose = _wing()
    for name, record in pose.linkage.links.items():
        for point, xy in record.points.items():
            np.testing.assert_allclose(
                pose.origins[name] + pose.rotation(name) @ xy, pose.position(name, point), atol=1e-10
            )
    assert set(pose.points) == set("ABCDEFGH")


def test_points_of_one_name_at_different_places_are_told_apart() -> None:
    linkage = Linkage(
        {"0": link(ground=True, A=(0, 0), E=(96, 0), P=(1, 1)), "1": link(A=(0, 0), P=(80, 0), X=(9, 0))},
        {"A": joint("0", "1"), "X": joint("0", "1", type="pin-in-slot", points=("A", "X"))},
    )
    assert linkage.mobility == 0
    pose = solve_pose(linkage, coordinate=None, near={"1": 0.1})
    assert {"0.P", "1.P", "A"} <= set(pose.points)


# ---- poses that cannot be had ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lengths", "degrees"), [((40, 120, 80, 300), 40), ((40, 120, 80, 241.5), 40), ((40, 120, 30, 100), 10)]
)
def test_an_open_four_bar_names_the_loop_and_its_gap(lengths: tuple[float, ...], degrees: float) -> None:
    a, b, c, d = lengths
    reach = abs(d - a * np.exp(1j * math.radians(degrees)))
    gap = max(reach - (b + c), abs(b - c) - reach)  # stretched or folded back
    with pytest.raises(CaseError) as caught:
        solve_pose(four_bar(a, b, c, d), coordinate="crank", angle=math.radians(degrees))
    assert f"with crank at {degrees} deg: loop A-B-C-D stays open by {gap:.4g} mm;" in str(caught.value)


def test_the_loop_that_is_open_is_named_not_its_neighbour() -> None:
    """The owl wing's second loop with ED cut down to 2 mm: |EC| 80.787 mm is 1.787 mm more than CD + ED."""
    pose = _wing()
    gap = float(np.linalg.norm(pose.points["E"] - pose.points["C"])) - 77.0 - 2.0
    wing = six_bar()
    short = Linkage(dict(wing.links) | {"ED": link(E=(0, 0), D=(2, 0))}, wing.joints)
    with pytest.raises(CaseError, match=f"loop B-C-D-E stays open by {gap:.4g} mm"):
        solve_pose(short, coordinate="GF", angle=math.radians(228.15), near=OPEN_WING)


def test_an_open_first_loop_is_named() -> None:
    wing = six_bar()
    long = Linkage(dict(wing.links) | {"GF": link(G=(0, 0), F=(400, 0))}, wing.joints)
    reach = abs(125j + 400 * np.exp(1j * math.radians(228.15)))
    with pytest.raises(CaseError, match=f"loop G-F-B-A stays open by {reach - 112 - 60:.4g} mm"):
        solve_pose(long, coordinate="GF", angle=math.radians(228.15), near=OPEN_WING)


def test_an_open_slider_crank_names_the_gap() -> None:
    with pytest.raises(CaseError, match=r"loop A-B-C-S stays open by 5 mm"):
        solve_pose(slider_crank(40, 115, -80), coordinate="crank", angle=math.pi / 2)


def test_without_near_both_assemblies_are_listed() -> None:
    with pytest.raises(CaseError) as caught:
        solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=ANGLE)
    text = str(caught.value)
    assert "2 assemblies fit" in text
    assert "coupler 20.3 deg, rocker 57.3 deg" in text
    assert "coupler 299.0 deg, rocker 262.0 deg" in text


def test_the_owl_wing_has_four_assemblies() -> None:
    with pytest.raises(CaseError, match="4 assemblies fit it"):
        solve_pose(six_bar(), coordinate="GF", angle=math.radians(228.15))


def test_one_direction_can_be_enough() -> None:
    pose = solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=ANGLE, near={"rocker": 1.2})
    assert _degrees(pose, "rocker") == pytest.approx(57.3249, abs=1e-4)


def test_directions_that_no_assembly_has() -> None:
    with pytest.raises(CaseError, match="no assembly lies within 90 deg of all its directions; there are: coupler"):
        solve_pose(four_bar(40, 120, 80, 100), coordinate="crank", angle=ANGLE, near={"coupler": 3.0, "rocker": 3.0})


@pytest.mark.parametrize(
    ("coordinate", "near", "words"),
    [
        ("ground", {}, "'ground' is not a moving link; the moving links are crank, coupler, rocker"),
        ("nobody", {}, "'nobody' is not a moving link"),
        ("crank", {"nobody": 0.0}, "'nobody' is not a moving link"),
        (None, {}, "mobility 1 \\(Gruebler\\) but 0 pose coordinate.*state pose.coordinate"),
    ],
)
def test_names_and_mobility_are_checked(coordinate: str | None, near: dict[str, float], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        solve_pose(four_bar(40, 120, 80, 100), coordinate=coordinate, near=near)


# ---- dead points ------------------------------------------------------------------------------------------


def test_the_dead_point_distance_of_ae_vanishes_where_ae_turns_back() -> None:
    """AE turns back where FB and GF fall into one line: there GF moves AE not at all."""
    # |AF|² at the angle where F, B are in line with G: triangle AGB with |GB| = 50 + 60.
    cosine = (125**2 + 110**2 - 112**2) / (2 * 125 * 110)
    angle = 270.0 - math.degrees(math.acos(cosine))
    assert angle == pytest.approx(213.51, abs=0.01)
    near = {k: v for k, v in OPEN_WING.items() if k != "CF"} | {"CF": math.radians(angle)}
    pose = solve_pose(six_bar(), coordinate="GF", angle=math.radians(angle), near=near)
    assert pose.dead_point_distance(Coordinate("AE")) < 1e-12
    assert pose.dead_point_distance(Coordinate("GF")) > 0.05
    distances = [_wing(angle + away).dead_point_distance(Coordinate("AE")) for away in (2.0, 1.0, 0.5)]
    for wider, closer in pairwise(distances):
        assert closer / wider == pytest.approx(0.5, abs=0.02)  # it falls linearly to zero


def test_a_toggle_is_a_dead_point_of_the_rocker_alone() -> None:
    """Crank and coupler in line: the rocker stands still, so it cannot drive the crank."""
    a, c = 40.0, 80.0
    rocker = math.radians(70)
    end = np.array([100 + c * math.cos(rocker), c * math.sin(rocker)])
    angle = math.atan2(end[1], end[0])
    linkage = four_bar(a, float(np.linalg.norm(end)) - a, c, 100)
    pose = solve_pose(linkage, coordinate="crank", angle=angle, near={"coupler": angle, "rocker": rocker})
    assert pose.dead_point_distance(Coordinate("rocker")) < 1e-7
    assert pose.dead_point_distance(Coordinate("crank")) > 0.05


def test_the_constraint_jacobian_is_the_derivative_of_the_constraints() -> None:
    """Every joint's constraint by a small motion of one link, from the points alone."""
    for linkage, near in (
        (six_bar(), OPEN_WING),
        (slider_crank(40, 120, -20), {"coupler": -0.45}),
        (quick_return(30, 80), {"lever": 1.5}),
        (scotch_yoke(30), {}),
        (oscillating_cylinder(30, 80, 0.4), {"cylinder": 3.0}),
    ):
        pose = solve_pose(linkage, coordinate=linkage.moving[0], angle=4.0, near=near)
        matrix, scale, h = constraint_jacobian(pose), linkage.longest, 1e-6
        for k in range(matrix.shape[1]):
            plus, minus = (_constraints(pose, k, sign * h * scale) for sign in (1.0, -1.0))
            np.testing.assert_allclose(matrix[:, k], (plus - minus) / (2 * h * scale), atol=1e-8)


def _constraints(pose: Pose, coordinate: int, step: float) -> np.ndarray:
    """All joint constraints [mm] with one coordinate (x, y, L phi) of one link moved by ``step``."""
    linkage = pose.linkage
    moved = linkage.moving[coordinate // 3]
    values: list[float] = []

    def placed(name: str, point: str) -> tuple[np.ndarray, float]:
        origin, angle = pose.origins[name].copy(), pose.angles[name]
        if name == moved and coordinate % 3 == 2:
            angle += step / linkage.longest
        elif name == moved:
            origin[coordinate % 3] += step
        x, y = linkage.links[name].points[point]
        turned = complex(x, y) * np.exp(1j * angle)
        return np.add(origin, [turned.real, turned.imag]), angle

    for name, record in linkage.joints.items():
        (p1, a1), (p2, a2) = (placed(i, p) for i, p in zip(record.links, linkage.joint_points(name), strict=True))
        if record.type == "revolute":
            values.extend(p2 - p1)
            continue
        along = a1 + record.direction
        values.append(float((p2 - p1) @ [-math.sin(along), math.cos(along)]))
        if record.type == "slider":
            values.append((a2 - a1) * linkage.longest)
    return np.array(values)


def test_inputs_are_left_unchanged() -> None:
    linkage, near = six_bar(), dict(OPEN_WING)
    before = linkage.links.copy(), linkage.joints.copy()  # type: ignore[attr-defined]
    pose = solve_pose(linkage, coordinate="GF", angle=math.radians(228.15), near=near)
    q = pose.q.copy()
    constraint_jacobian(pose), pose.dead_point_distance(Coordinate("AE")), pose.points
    assert near == OPEN_WING
    assert (linkage.links, linkage.joints) == before
    np.testing.assert_array_equal(pose.q, q)


def test_the_nearest_pose_starts_from_rough_directions_and_is_none_where_the_loop_stays_open() -> None:
    linkage, near = four_bar(40.0, 120.0, 80.0, 100.0), {"crank": 0.8, "coupler": 0.5, "rocker": 0.9}
    solved = solve_pose(linkage, coordinate="crank", angle=0.7, near=near)
    found = nearest_pose(linkage, coordinate="crank", angle=0.7, near=near)
    assert found is not None
    assert found.q == pytest.approx(solved.q, abs=1e-9)
    free = nearest_pose(linkage, coordinate=None, near=near)  # of any mobility
    assert free is not None
    assert free.residual < CLOSED
    assert nearest_pose(four_bar(40.0, 500.0, 80.0, 100.0), coordinate="crank", angle=0.7, near=near) is None
