"""Bending that grows with compression: closed forms of beam-columns, a fine second way, and the whole check."""

import math
import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from alula.fea.beam.column_factor import Stretch
from alula.fea.beam.cut_beam import curving_forces
from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import internal_forces
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.common.verdict import Verdict
from alula.fea.links.second_order import Bend, between_stations, on_its_pins
from alula.fea.motion.buckling_history import with_second_order
from alula.fea.motion.link_history import link_histories
from alula.geometry.bodies.cut_section import CutSection
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import LineLoad
from alula.loads.states.case_motion import solve_case_motion

L, EI = 100.0, 1e4
EULER = math.pi**2 * EI / L**2
BEND = Bend(stiffness=EI)
FACTORS = (1.5, 3.19, 9.0)


def loaded(*pins: tuple[float, list[float]], q: float = 0.0, tip: tuple[float, list[float]] | None = None) -> LinkLoads:
    even = np.array([0.0, q, 0.0])
    line = LineLoad(link="bar", start=0.0, end=L, at_start=even, at_end=even, axes="link")
    return LinkLoads(
        name="one",
        pins=tuple(
            PinLoad(name=str(i), centre=np.array([x, 0.0, 0.0]), diameter=1.0, wrench=np.array(wrench, dtype=float))
            for i, (x, wrench) in enumerate(pins)
        ),
        ends=() if tip is None else (EndLoad(name="t", point=np.array([tip[0], 0, 0]), wrench=np.array(tip[1])),),
        lines=(line,) if q else (),
    )


def forces(loads: LinkLoads):
    body = SimpleNamespace(pins=[SimpleNamespace(name=pin.name, foot=None) for pin in loads.pins], ends=())
    return internal_forces(beam_loads(loads, body, 0.0))


def moment(loads: LinkLoads) -> float:
    """Largest bending moment in either plane."""
    return forces(loads).largest(lambda f: np.hypot(f[:, 4], f[:, 5]))[2]


@pytest.mark.parametrize("n", FACTORS)
def test_beam_columns_on_two_pins(n: float) -> None:
    """Timoshenko & Gere, 2nd ed., sections 1.3 to 1.7, u = π/2 √(P/Pe): force in the middle, spread, end moments."""
    P, u = EULER / n, math.pi / 2.0 / math.sqrt(n)
    k = math.sqrt(P / EI)
    middle = loaded((0.0, [P, -1.0, 0, 0, 0, 0]), (50.0, [0, 2.0, 0, 0, 0, 0]), (L, [-P, -1.0, 0, 0, 0, 0]))
    found = moment(on_its_pins(middle, forces(middle), BEND, BEND, (0.0, L)))
    assert found == pytest.approx(2.0 * L / 4.0 * math.tan(u) / u, rel=2e-4)
    spread = loaded((0.0, [P, -5.0, 0, 0, 0, 0]), (L, [-P, -5.0, 0, 0, 0, 0]), q=0.1)
    found = moment(between_stations(spread, forces(spread), BEND, BEND))
    assert found == pytest.approx(0.1 / k**2 * (1.0 / math.cos(u) - 1.0), rel=2e-4)
    for turn in ([0.0, 50.0], [50.0, 0.0]):
        ends = loaded((0.0, [P, 0, 0, 0, *turn]), (L, [-P, 0, 0, 0, *(-x for x in turn)]))
        assert moment(between_stations(ends, forces(ends), BEND, BEND)) == pytest.approx(50.0 / math.cos(u), rel=2e-4)
    one = loaded((0.0, [P, 0.5, 0, 0, 0, 50.0]), (L, [-P, -0.5, 0, 0, 0, 0]))
    largest = 50.0 / math.sin(k * L) if k * L > math.pi / 2.0 else 50.0
    assert moment(between_stations(one, forces(one), BEND, BEND)) == pytest.approx(largest, rel=2e-4)


@pytest.mark.parametrize("n", FACTORS)
@pytest.mark.parametrize("aside", [12.0, -7.0])
def test_pins_beside_the_axis_bend_a_beam_column_as_on_it(n: float, aside: float) -> None:
    """What growth adds across the plane once twisted the beam by that arm, so that its loads did not balance."""
    P = EULER / n
    couple = [2.0 * aside, 0.0, 0.3 * P * aside]
    on_axis = loaded(
        (0.0, [P, 0, -1.0, *(-x for x in couple)]),
        (50.0, [-0.3 * P, 0, 2.0, *couple]),
        (L, [-0.7 * P, 0, -1.0, 0, 0, 0]),
    )
    first, middle, last = on_axis.pins
    beside = replace(middle, centre=np.array([50.0, aside, 0.0]), wrench=middle.wrench * [1, 1, 1, 0, 0, 0])
    plate = replace(on_axis, pins=(first, beside, last))
    expected, found = (on_its_pins(one, forces(one), BEND, BEND, (0.0, L)) for one in (on_axis, plate))
    assert moment(found) == pytest.approx(moment(expected), rel=1e-9)
    assert moment(found) > 1.05 * moment(plate)
    assert forces(found).at(25.0) == pytest.approx(forces(expected).at(25.0), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("n", FACTORS)
def test_a_column_pressed_beside_its_centroid_bears_the_secant_formula(n: float) -> None:
    """M = P e/cos u in the middle (Timoshenko & Gere, 2nd ed., sec. 1.11); P on the axis, 3 mm off the sections."""
    P, u = EULER / n, math.pi / 2.0 / math.sqrt(n)
    second = EI / 2000.0
    cuts = [
        CutSection(x=x, area=20.0, centre=(3.0, 0.0), i_y=second, i_z=second, i_yz=0.0, hull=((0, 0), (1, 0), (0, 1)))
        for x in L * (np.arange(16) + 0.5) / 16.0
    ]
    loads = loaded((0.0, [P, 0, 0, 0, 0, 0]), (L, [-P, 0, 0, 0, 0, 0]))
    found = on_its_pins(loads, curving_forces(forces(loads), cuts), BEND, BEND, (0.0, L))
    about = curving_forces(forces(found), cuts)
    assert about.largest(lambda f: abs(f[:, 5]))[2] == pytest.approx(P * 3.0 / math.cos(u), rel=1e-3)


@pytest.mark.parametrize("n", FACTORS)
def test_a_driven_link_is_a_cantilever(n: float) -> None:
    """H L tan u/u at the drive, u = L √(P/(E I)); the drive takes what the forces at the tip get of moment."""
    P = EULER / 4.0 / n
    u = L * math.sqrt(P / EI)
    loads = loaded((0.0, [P, -2.0, 0, 0, 0, -200.0]), (L, [-P, 2.0, 0, 0, 0, 0]))
    found = on_its_pins(loads, forces(loads), BEND, BEND, (0.0,))
    assert moment(found) == pytest.approx(200.0 * math.tan(u) / u, rel=1e-4)
    assert found.pins[0].wrench[5] == pytest.approx(-200.0 * math.tan(u) / u, rel=1e-4)
    across = loaded((0.0, [P, 0, -2.0, 0, 200.0, 0]), (L, [-P, 0, 2.0, 0, 0, 0]))
    assert moment(on_its_pins(across, forces(across), BEND, BEND, (0.0,))) == pytest.approx(moment(found), rel=1e-9)


def finite_differences(P: float, q: float, soft: float = 1.0) -> float:
    """Largest moment of a strut on two pins under q per length whose half beyond the middle has soft times E I.

    M'' + P M/(E I) = -q with M = 0 at both pins, by central differences: no other code, no other unknown.
    """
    count = 4000
    h = L / count
    x = np.arange(1, count) * h
    stiffness = np.where(x < L / 2.0, EI, soft * EI)
    stiffness[count // 2 - 1] = 2.0 / (1.0 / EI + 1.0 / (soft * EI))
    from scipy.linalg import solve_banded

    bands = np.zeros((3, count - 1))
    bands[0, 1:] = bands[2, :-1] = 1.0 / h**2
    bands[1] = -2.0 / h**2 + P / stiffness
    return float(np.abs(solve_banded((1, 1), bands, np.full(count - 1, -q))).max())


@pytest.mark.parametrize("soft", [1.0, 0.5])
def test_a_strut_with_a_softer_half_against_finite_differences(soft: float) -> None:
    P = EULER / 4.0
    bend = Bend(stiffness=EI, stretches=(Stretch(first=L / 2.0, last=L, bending=soft),) if soft < 1.0 else ())
    loads = loaded((0.0, [P, -5.0, 0, 0, 0, 0]), (L, [-P, -5.0, 0, 0, 0, 0]), q=0.1)
    found = moment(between_stations(loads, forces(loads), bend, bend))
    assert found == pytest.approx(finite_differences(P, 0.1, soft), rel=2e-3)


def test_tension_little_compression_and_what_buckles_are_left_alone() -> None:
    for P in (-EULER / 2.0, EULER / 150.0, 1.01 * EULER):
        loads = loaded((0.0, [P, -5.0, 0, 0, 0, 0]), (L, [-P, -5.0, 0, 0, 0, 0]), q=0.1)
        found = between_stations(loads, forces(loads), BEND, BEND)
        assert moment(found) == pytest.approx(moment(loads), rel=1e-12)


def test_an_overhang_that_is_pushed_bends_the_span_as_well() -> None:
    """Pushed and bent at its tip; E I v'' = M of the bent shape by shooting, held at 0 and 100 mm, tip at 150."""
    from scipy.integrate import solve_bvp

    P, H, reach = 0.3 * EULER, 0.2, 150.0
    loads = loaded(
        (0.0, [0, H * 50.0 / L, 0, 0, 0, 0]), (L, [P, -H * reach / L, 0, 0, 0, 0]), tip=(reach, [-P, H, 0, 0, 0, 0])
    )
    found = forces(on_its_pins(loads, forces(loads), BEND, BEND, (0.0, L)))

    # Span and overhang side by side, each over s from 0 to 1: deflection and slope of both, the tip's deflection p.
    def bent(s, y, p):
        _, slope, beyond, tilt = y
        root = H * 50.0 + P * p[0]
        own = H * 50.0 * (1.0 - s) + P * (p[0] - beyond)
        return np.array([L * slope, L * root * s / EI, 50.0 * tilt, 50.0 * own / EI])

    def ends(a, b, p):
        return np.array([a[0], b[0], a[2], a[3] - b[1], b[2] - p[0]])

    s = np.linspace(0.0, 1.0, 41)
    solved = solve_bvp(bent, ends, s, np.zeros((4, 41)), p=[0.0], tol=1e-8)
    assert solved.success
    assert abs(found.at(L, "before")[5]) == pytest.approx(H * 50.0 + P * abs(solved.p[0]), rel=1e-3)


POST = """
schema_version = 1
title = "Post"
large_displacement = "{way}"
[links.ground]
ground = true
points = {{ A = ["0 mm", "0 mm"], D = ["150 mm", "0 mm"] }}
[links.post]
part = "bar"
points = {{ A = ["0 mm", "0 mm"], B = ["200 mm", "0 mm"] }}
[links.top]
part = "bar"
points = {{ B = ["0 mm", "0 mm"], C = ["150 mm", "0 mm"] }}
[links.right]
part = "bar"
points = {{ D = ["0 mm", "0 mm"], C = ["200 mm", "0 mm"] }}
[joints]
A = {{ links = ["ground", "post"], pin_diameter = "5 mm" }}
B = {{ links = ["post", "top"], pin_diameter = "5 mm" }}
C = {{ links = ["top", "right"], pin_diameter = "5 mm" }}
D = {{ links = ["ground", "right"], pin_diameter = "5 mm" }}
[pose]
coordinate = "post"
angle = "90 deg"
near = {{ top = "0 deg", right = "90 deg" }}
[drive]
link = "post"
joint = "A"
[parts.bar]
shape = "bar"
material = "pvc-paredes-2018"
width = "10 mm"
thickness = "10 mm"
eye_diameter = "16 mm"
eye_thickness = "10 mm"
fillet_radius = "3 mm"
[load_cases.push]
forces = [{{ link = "post", at = "B", force = ["5 N", "{along!r} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 1.5
"""


def post(along: float = -38.6, way: str = "auto") -> Case:
    """A post of 200 mm built in at its foot by the drive, free at its head; the other links bear nothing."""
    return validate(tomllib.loads(POST.format(way=way, along=along)))


@pytest.mark.parametrize(("way", "state"), [("auto", "deformed"), ("off", "off")])
def test_a_post_bears_its_second_order_moment(way: str, state: str) -> None:
    """P/A + (H L/W) tan u/u. Linear theory alone gives a quarter less, and a safety factor a third too high."""
    case = post(way=way)
    found = check_case(case, fidelity="beam").load_cases["push"]
    u = 200.0 * math.sqrt(38.6 / (case.material_of("post").youngs_modulus * 1e4 / 12.0))
    factor = (math.pi / 2.0 / u) ** 2
    assert found.large_displacement.state == state
    assert found.large_displacement.buckling == pytest.approx(factor, rel=0.01)
    assert 3.0 < factor < 3.4
    exact = 38.6 / 100.0 + 6.0 * math.tan(u) / u
    linear = 38.6 / 100.0 + 6.0
    beam = found.links["post"].beam
    # The frame's head comes down as it goes aside: 0.2 % less.
    assert beam.worst.equivalent == pytest.approx(exact, rel=4e-3)
    assert exact / linear > 1.3
    assert beam.safety_factor == pytest.approx(beam.strength / exact, rel=4e-3)
    (column,) = [c for c in found.checks if (c.name, c.link) == ("buckling", "post")]
    assert column.verdict is not Verdict.FAIL


@pytest.mark.parametrize("way", ["auto", "off"])
def test_scattered_loads_bend_a_post_by_more_than_their_share(way: str) -> None:
    """P/A + (H L/W) tan u/u at the ends of the scatter, and the bow of the same beam-column."""
    tables = tomllib.loads(POST.format(way=way, along=-28.0))
    plain = check_case(validate(tables), fidelity="beam").load_cases["push"].links["post"]
    tables["load_cases"]["push"]["scatter"] = {"low": 0.5, "high": 1.9}
    case = validate(tables)
    found = check_case(case, fidelity="beam").load_cases["push"].links["post"]

    def exact(share: float) -> np.ndarray:
        """Stress [MPa], and the largest distance from the chord over H/(P k)."""
        u = 200.0 * math.sqrt(share * 28.0 / (case.material_of("post").youngs_modulus * 1e4 / 12.0))
        kx = np.linspace(0.0, u, 1001)
        v = math.tan(u) * (1.0 - np.cos(kx)) + np.sin(kx) - kx
        return np.array([share * (0.28 + 6.0 * math.tan(u) / u), np.abs(v - v[-1] * kx / u).max() / u])

    ours, theirs = (
        np.array(
            [(one.von_mises_max.low, one.von_mises_max.high), (one.displacement_max.low, one.displacement_max.high)]
        )
        for one in (found, plain)
    )
    ends = np.column_stack([exact(0.5), exact(1.9)]) / exact(1.0)[:, None]
    assert ends[0, 1] / 1.9 > 1.2
    # The frame's head comes down as it goes aside.
    np.testing.assert_allclose(ours / theirs, ends, rtol=0.015)
    assert found.safety_factor.low == pytest.approx(plain.safety_factor.low / ends[0, 1], rel=0.015)


def test_a_post_that_is_pulled_has_no_more_than_linear_theory_gives() -> None:
    found = check_case(post(38.6, "off"), fidelity="beam").load_cases["push"].links["post"].beam
    assert found.worst.equivalent == pytest.approx(6.386, rel=1e-5)


def test_over_a_motion_every_pose_has_its_own_growth() -> None:
    """The post turns from 80 to 100 degrees: along and across it the force differs, and so does tan u/u."""
    tables = tomllib.loads(POST.format(way="auto", along=-38.6))
    tables["motion"] = {"poses": 5, "range": ["80 deg", "100 deg"]}
    case = validate(tables)
    moved = solve_case_motion(case)
    (history,) = link_histories(moved, "post")
    evaluated = np.array([True, True, True, True, False])
    grown = with_second_order(case, "post", history, evaluated)
    stiffness = case.material_of("post").youngs_modulus * 1e4 / 12.0
    for pose, angle in enumerate(moved.motion.angles):
        push = 38.6 * math.sin(angle) - 5.0 * math.cos(angle)
        across = abs(5.0 * math.sin(angle) + 38.6 * math.cos(angle))
        u = 200.0 * math.sqrt(push / stiffness)
        linear, found = (
            internal_forces(beam_loads(own.chosen(pose), case.body("post"), 0.0)).largest(lambda f: abs(f[:, 5]))[2]
            for own in (history, grown)
        )
        assert linear == pytest.approx(200.0 * across, rel=1e-9)
        assert found == pytest.approx(linear * (math.tan(u) / u if evaluated[pose] else 1.0), rel=1e-5)
