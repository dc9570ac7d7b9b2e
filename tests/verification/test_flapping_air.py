"""Air on wings that flap: closed forms of plates that turn, rock and move, balance of energy, what is refused."""

import math
from typing import Any

import numpy as np
import pytest
import slotted_cases
from edited_cases import edited

from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.whole.air_range import air_range
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.placement import Placement
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.applied import LineLoad, PointLoad
from alula.loads.records.flapping import Wing
from alula.loads.records.load_case import LoadCase
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.flapping import PIECES, flapping_loads, in_air
from alula.loads.states.kinetostatics import work
from alula.reports.figures.motion.air_figures import air_figure
from alula.reports.sections.air import drive_in_air, motion_air_record

RHO, C_N, L, C = 1.2e-12, 2.0, 300.0, 80.0  # tonne/mm^3, -, mm, mm
AIR = {"density": "1.2 kg/m^3", "normal_coefficient": C_N, "added_mass": False}


def fan(wing: dict[str, Any] | None = None, **air: Any) -> Case:
    """A massless plate that turns about its root O, its span along the link's axis."""
    return validate(
        {
            "schema_version": 1,
            "title": "A fan",
            "massless": ["blade"],
            "links": {
                "base": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "G": ["50 mm", "0 mm"]}},
                "blade": {"points": {"O": ["0 mm", "0 mm"], "M": ["100 mm", "0 mm"], "E": [f"{L} mm", "0 mm"]}},
            },
            "joints": {"O": {"links": ["base", "blade"]}},
            "pose": {"coordinate": "blade", "angle": "20 deg"},
            "drive": {"link": "blade", "joint": "O"},
            "motion": {"turn": True, "poses": 5, "speed": "90 rpm"},
            "wings": [{"link": "blade", "start": "O", "end": "E", "chord": f"{C} mm"} | (wing or {})],
            "load_cases": {"air": {"speed": "90 rpm", "flapping": AIR | air}},
        }
    )


def rocking(case: Case, swing: float, rate: float, steps: int = 4001) -> tuple[np.ndarray, Placement]:
    """Times over a cycle, and the fan as it rocks by ``swing`` sin(``rate`` t)."""
    t = np.linspace(0.0, 2.0 * math.pi / rate, steps)
    angles = swing * np.array([np.sin(rate * t), rate * np.cos(rate * t), -(rate**2) * np.sin(rate * t)])[..., None]
    return t, Placement(closure=case.solve_pose().placement.closure, q=angles[0], qdot=angles[1], qddot=angles[2])


def air_power(case: Case, place: Placement) -> np.ndarray:
    return work(flapping_loads(case, case.load_cases["air"], place), place, place)


def mean(values: np.ndarray, t: np.ndarray) -> float:
    return float(np.trapezoid(values, t)) / (t[-1] - t[0])


@pytest.mark.parametrize("chord", [(C, C), (C, 30.0), (0.0, C)])
def test_a_plate_that_turns_about_its_root(chord):
    """T = 1/2 rho C_N omega^2 integral of c x^3; with c = c0 + (c1 - c0) x / L that is L^4 (c0 / 4 + (c1 - c0) / 5)."""
    omega = 3.0 * math.pi
    expected = 0.5 * RHO * C_N * omega**2 * L**4 * (chord[0] / 4.0 + (chord[1] - chord[0]) / 5.0)
    wing = {"chord": [f"{c} mm" for c in chord]}
    case = fan(wing)
    np.testing.assert_allclose(solve_case_motion(case).torque["air"], expected, rtol=1e-12)
    assert solve_case_statics(case).reactions["air"].drive_torque == pytest.approx(expected, rel=1e-12)
    # Stated from its tip to its root it is the same wing.
    mirrored = fan({"chord": wing["chord"][::-1], "start": "E", "end": "O"})
    np.testing.assert_allclose(solve_case_motion(mirrored).torque["air"], expected, rtol=1e-12)
    # The added mass of a plate that turns evenly about its root does nothing.
    even = solve_case_motion(fan(wing, added_mass=True)).torque["air"]
    np.testing.assert_allclose(even, expected, rtol=1e-12)


def test_held_at_a_point_or_spread_the_wing_takes_the_same_torque_and_bends_otherwise():
    spread = solve_case_motion(fan())
    wing = Wing.model_validate({"link": "blade", "at": "M", "span": [f"{L} mm", "0 mm"], "chord": f"{C} mm"})
    moved = solve_case_motion(fan().model_copy(update={"wings": (wing,)}))
    np.testing.assert_allclose(moved.torque["air"], spread.torque["air"], rtol=1e-12)
    [load] = moved.loads["air"]
    assert isinstance(load, PointLoad)
    assert load.point == "M"
    force = 0.5 * RHO * C_N * C * (3.0 * math.pi) ** 2 * L**3 / 3.0
    moment = -force * (0.75 * L - 100.0)  # the force's centre is at three quarters of the span
    np.testing.assert_allclose(load.wrench[0], [0.0, -force, 0.0, 0.0, 0.0, moment], rtol=1e-12)
    assert [type(one) for one in spread.loads["air"]] == [LineLoad] * PIECES


def test_a_plate_that_rocks_takes_the_mean_power_of_its_closed_form():
    """P = 1/2 rho C_N c (swing omega)^3 L^4 / 4 times the mean of |cos|^3, 4 / (3 pi)."""
    case = fan()
    t, place = rocking(case, 0.4, 20.0)
    expected = -0.5 * RHO * C_N * C * (0.4 * 20.0) ** 3 * L**4 / 4.0 * 4.0 / (3.0 * math.pi)
    assert mean(air_power(case, place), t) == pytest.approx(expected, rel=1e-6)


def test_added_mass_of_a_plate_that_rocks_is_an_inertia_and_does_no_work_over_a_cycle():
    """I = rho pi c^2 / 4 L^3 / 3 about the root."""
    case, bare = fan(added_mass=True), fan()
    t, place = rocking(case, 0.4, 20.0)
    power = air_power(case, place) - air_power(bare, place)
    inertia = RHO * math.pi * C**2 / 4.0 * L**3 / 3.0
    np.testing.assert_allclose(power, -inertia * place.qddot[:, 0] * place.qdot[:, 0], atol=1e-12 * np.abs(power).max())
    assert abs(mean(power, t)) < 1e-12 * np.abs(power).max()


def test_an_accelerating_plate_moves_its_added_mass():
    torque = {}
    for added in (True, False):
        case = fan(added_mass=added)
        spec = case.motion.model_copy(update={"inertia": True, "acceleration": 50.0})
        stated = case.load_cases["air"].model_dump(exclude={"speed"})
        quiet = LoadCase.model_construct(**{**vars(case.load_cases["air"]), "speed": 0.0}, _fields_set=set(stated))
        case = case.model_copy(update={"motion": spec, "load_cases": {"air": quiet}})
        torque[added] = solve_case_motion(case).torque["air"]
    np.testing.assert_allclose(torque[True] - torque[False], RHO * math.pi * C**2 / 4.0 * 50.0 * L**3 / 3.0, rtol=1e-9)


def yoke(**air: Any) -> Case:
    """A plate that a slotted yoke moves to and fro, as a crank of 30 mm turns: v = 30 mm omega sin."""
    case = slotted_cases.case_of(
        {
            "ground": slotted_cases.points(A=(0, 0), S=(0, 0)),
            "crank": slotted_cases.points(A=(0, 0), B=(30, 0)),
            "yoke": slotted_cases.points(Y=(0, 0), Z=(200, 0)),
        },
        {
            "A": slotted_cases.joint("ground", "crank"),
            "S": slotted_cases.joint("ground", "yoke", type="slider", points=["S", "Y"], angle="90 deg"),
            "B": slotted_cases.joint("yoke", "crank", type="pin-in-slot", points=["Y", "B"], direction="0 deg"),
        },
        {"coordinate": "crank", "angle": "35 deg", "near": {"yoke": "90 deg"}},
        "A",
        "crank",
        "yoke",
    )
    wing = fan().wings[0].model_copy(update={"link": "yoke", "start": "Y", "end": "Z", "chord": (50.0, 20.0)})
    own = fan(**air).load_cases["air"].model_copy(update={"speed": 25.0})
    motion = fan().motion.model_copy(update={"poses": 721})
    changed = {"wings": (wing,), "load_cases": {"air": own}, "motion": motion, "massless": ("crank", "yoke")}
    return case.model_copy(update=changed)


@pytest.mark.parametrize("added", [False, True])
def test_a_plate_that_moves_to_and_fro(added):
    moved = solve_case_motion(yoke(added_mass=added))
    theta = moved.motion.angles
    v, rate = -30.0 * 25.0 * np.sin(theta), -30.0 * 25.0**2 * np.cos(theta)
    pulled = 0.5 * RHO * C_N * 35.0 * 200.0 * np.abs(v) * v
    if added:  # the mean of c^2 over a linear chord is (c0^2 + c0 c1 + c1^2) / 3
        pulled = pulled + RHO * math.pi / 4.0 * 1300.0 * 200.0 * rate
    expected = pulled * v
    np.testing.assert_allclose(moved.forces["air"].drive_power, expected, atol=1e-9 * np.abs(expected).max())
    mean_power = mean(moved.forces["air"].drive_power, theta)
    assert mean_power == pytest.approx(0.5 * RHO * C_N * 7000.0 * 750.0**3 * 4.0 / (3.0 * math.pi), rel=1e-4)


def test_a_wing_whose_motion_turns_round_within_its_span():
    """Every piece has the force and first moment of a fine sum over strips, at all poses of a coupler."""
    entries = [
        'wings=[{ link = "coupler", start = "A", end = "B", chord = ["50 mm", "20 mm"] }]',
        'load_cases.turning.flapping={ density = "1.2 kg/m^3", normal_coefficient = 2.0 }',
        "motion.turn=true",
        "motion.poses=25",
    ]
    case = edited("tests/unit/loads/four-bar-laden.toml", entries)
    load_case, points = case.load_cases["turning"], case.links["coupler"].points
    place = solve_case_motion(case).forces["turning"].placement
    a, b = sorted((points["A"][0], points["B"][0]))
    c0, c1 = (50.0, 20.0) if points["A"][0] == a else (20.0, 50.0)
    turned, inside = place.direction("coupler"), 0
    pieces = flapping_loads(case, load_case, place)
    for piece in pieces:
        x = np.linspace(piece.start, piece.end, 40001)
        x = 0.5 * (x[1:] + x[:-1])
        chord = c0 + (c1 - c0) * (x - a) / (b - a)
        spin = place.spin("coupler")[:, None]
        velocity = (place.velocity("coupler") * np.conj(turned))[:, None] + 1j * spin * x
        acceleration = (place.acceleration("coupler") * np.conj(turned))[:, None]
        acceleration = acceleration + (1j * place.spin_rate("coupler")[:, None] - spin**2) * x
        v = velocity.imag
        inside += np.count_nonzero(v[:, 0] * v[:, -1] < 0.0)
        f = -0.5 * RHO * C_N * chord * np.abs(v) * v
        f -= RHO * math.pi / 4.0 * chord**2 * (acceleration.imag - spin * velocity.real)
        step = (piece.end - piece.start) / len(x)
        scale = np.abs(f).sum(axis=1).max() * step
        np.testing.assert_allclose(piece.force[:, 1], f.sum(axis=1) * step, atol=1e-8 * scale)
        np.testing.assert_allclose(piece.first_moment[:, 1], (f * x).sum(axis=1) * step, atol=1e-8 * scale * b)
    assert inside > 3  # of the poses, in some piece


@pytest.mark.parametrize("name", ["four-bar-laden", "flapping-wing-chosen"])
def test_energy_is_balanced_and_added_mass_works_in_vain_over_a_cycle(name):
    if name == "four-bar-laden":
        wing = '[{ link = "coupler", start = "A", end = "B", chord = "50 mm" }]'
        case = edited(f"tests/unit/loads/{name}.toml", [f"wings={wing}", "motion.turn=true", "motion.poses=361"])
        title = "turning"
    else:
        wing = '[{ link = "outer-right", start = "DR", end = "ER", chord = ["100 mm", "40 mm"] }]'
        case, title = edited(name, [f"wings={wing}"]), "flapping"
    air = fan(added_mass=True).load_cases["air"].flapping
    case = case.model_copy(update={"load_cases": {title: case.load_cases[title].model_copy(update={"flapping": air})}})
    moved = solve_case_motion(case)
    solved = moved.forces[title]
    assert np.abs(solved.imbalance).max() < 1e-9 * np.abs(solved.drive_power).max()
    place = solved.placement
    quiet = case.load_cases[title].model_copy(update={"flapping": air.model_copy(update={"added_mass": False})})
    plain = work(flapping_loads(case, quiet, place), place, place)
    power = work(flapping_loads(case, case.load_cases[title], place), place, place) - plain
    assert abs(mean(power, moved.motion.angles)) < 1e-9 * np.abs(power).max()
    assert plain.max() <= 0.0  # the air only brakes
    # What the drive gives over a cycle is what the air takes, beside the work of nothing else that lasts.
    still = solve_case_motion(in_air(case, None)).forces[title].drive_power
    given = mean(solved.drive_power - still, moved.motion.angles)
    assert given == pytest.approx(-mean(plain, moved.motion.angles), rel=1e-9)


def test_the_bending_moment_along_a_spread_wing_is_that_of_the_air():
    """Between the pieces' ends it is off by at most 1/48 PIECES^-4 of that at the root, at the ends by nothing."""
    case = fan()
    loads = flapping_loads(case, case.load_cases["air"], solve_case_motion(case).motion.placement.chosen(0))
    k = 0.5 * RHO * C_N * C * (3.0 * math.pi) ** 2
    root = k * L**4 / 4.0
    worst = 0.0
    for at in np.linspace(0.0, L, 81):
        found = 0.0
        for load in loads:
            a = max(load.start, at)
            if a < load.end:
                share = (a - load.start) / (load.end - load.start)
                first = load.at_start[1] + share * (load.at_end[1] - load.at_start[1])
                length = load.end - a
                found += length * (
                    (a - at) * 0.5 * (first + load.at_end[1]) + length * (first + 2 * load.at_end[1]) / 6
                )
        exact = k * (L**4 / 4.0 - at * L**3 / 3.0 + at**4 / 12.0)
        worst = max(worst, abs(found + exact) / root)
    assert 1e-6 < worst < 1.01 / 48.0 / len(loads) ** 4


REFUSED = {
    "load_cases.air.flapping.normal_coefficient_range: it goes from 2.5 to 3, but normal_coefficient is 2;": (
        {},
        {"normal_coefficient_range": [2.5, 3.0]},
    ),
    "load_cases.air.flapping.normal_coefficient: it reaches 9, but the largest plausible one is 8": (
        {},
        {"normal_coefficient": 9.0},
    ),
    "load_cases.air.flapping.density: it is 1200 kg/m^3, but air has about 1.2 kg/m^3": (
        {},
        {"density": "1.2 g/cm^3"},
    ),
    "wings.0.chord: on average it is 700 mm, more than 2 times the wing's span of 300 mm": ({"chord": "700 mm"}, {}),
    "wings.0.chord.1 (it is 5): the length needs its unit": ({"chord": ["60 mm", 5]}, {}),
    "wings.0: its chord is zero at both ends": ({"chord": "0 mm"}, {}),
    "wings.0: state either start and end, two points of the link, or at": ({"at": "M"}, {}),
    "wings.0.link: 'base' is not a moving link": ({"link": "base"}, {}),
    "wings.0: link 'blade' has no point 'X'": ({"end": "X"}, {}),
    "wings.0: start and end lie at the same station": ({"end": "O"}, {}),
}


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_is_no_wing_or_no_air_is_refused(sentence):
    wing, air = REFUSED[sentence]
    with pytest.raises(CaseError) as refused:
        fan(wing, **air)
    assert str(refused.value).startswith(sentence)
    assert "\n" not in str(refused.value)


def test_a_wing_has_a_span():
    with pytest.raises(CaseError, match=r"wings\.0: its span begins and ends at the same station"):
        edited("ornithopter", ['wings.0.span=["6 mm","6 mm"]'])


def test_air_needs_wings_that_move():
    air = 'load_cases.weight.flapping={ density = "1.2 kg/m^3", normal_coefficient = 2.0 }'
    with pytest.raises(CaseError, match="the case states no wings for the air to act on"):
        edited("owl-wing-static", [air])
    with pytest.raises(CaseError, match="stands still in this load case, so its wings do not flap; state its speed"):
        edited("owl-wing-static", [air, 'wings=[{ link = "AE", start = "A", end = "E", chord = "20 mm" }]'])


def test_a_case_in_another_air():
    case = fan(normal_coefficient_range=[1.0, 3.0])
    torque = {share: solve_case_motion(in_air(case, share)).torque["air"][0] for share in (0.0, 0.5, 1.0)}
    assert torque[0.0] * 3.0 == pytest.approx(torque[1.0]) == pytest.approx(1.5 * torque[0.5])
    assert in_air(read_case("owl-wing-static"), None).load_cases == {}


def test_figure_record_and_sentences_tell_the_torque_of_a_fan():
    """A fan at constant speed: T goes with C_N, and nothing is needed without air."""
    omega, low, high = 3.0 * math.pi, 1.2, 5.0
    torque = 0.5 * RHO * omega**2 * C * L**4 / 4.0  # over C_N
    moved = solve_case_motion(fan(normal_coefficient_range=[low, high]))
    airs = air_range(moved)
    record = motion_air_record(airs, "air")
    assert record is not None
    for name, coefficient in {"without": 0.0, "least": low, "stated": C_N, "largest": high}.items():
        asked = record["drive"][name]
        assert asked["peak_effort"] == pytest.approx(coefficient * torque, rel=1e-9)
        assert asked["mean_power"] == pytest.approx(coefficient * torque * omega / 1e3, rel=1e-9)
    assert record["wings"][0]["largest_force"] == pytest.approx(C_N * torque * 4.0 / (3.0 * L), rel=1e-9)
    watts = [f"{coefficient * torque * omega / 1e3:.3g}" for coefficient in (C_N, low, high)]
    assert "0 W without air, {} W with it ({} W to {} W)".format(*watts) in drive_in_air("air", record).text
    figure = air_figure(airs, "air")
    for drawn, label, share in zip(
        figure.axes, ("drive torque [N·mm]", "drive power [W]"), (torque, torque * omega / 1e3), strict=True
    ):
        assert drawn.get_ylabel() == label
        np.testing.assert_allclose(drawn.lines[0].get_ydata(), 0.0, atol=1e-12)
        np.testing.assert_allclose(drawn.lines[1].get_ydata(), C_N * share, rtol=1e-9)
        [band] = drawn.collections
        edges = band.get_paths()[0].vertices[:, 1]
        assert (edges.min(), edges.max()) == pytest.approx((low * share, high * share), rel=1e-9)
    legends = [text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]
    assert legends == ["without air", "C_N 2", "C_N 1.2 to 5"]
