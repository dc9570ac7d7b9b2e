"""A cycle from a table: its motion by differences, its loads row by row, and what is refused in one sentence."""

import re
import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import told_motion

from alula.fea.common.band import Band
from alula.fea.elements.space import displacement_space
from alula.fea.findings.of_motion import motion_findings
from alula.fea.motion import envelope
from alula.fea.motion.layered import with_couples
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import LinkageOverMotion, _worst, when
from alula.fea.outcomes.fatigue import closed_history, repeated_cycles
from alula.fea.outcomes.unloaded import stated_size
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.study.evaluate import evaluate
from alula.fea.study.study import task_of
from alula.fea.whole.motor import motor_outcomes
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import ends_of
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_text, validate
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants
from alula.loads.records.cycle_spec import states
from alula.loads.states.case_motion import solve_case_motion, step_caveats
from alula.loads.states.clearance import way_of
from alula.reports.figures.motion.motion_figures import torque_figure
from alula.reports.motion.linkage import linkage_text
from alula.reports.motion.poses import range_text
from alula.reports.sentences import told as sentence_of
from alula.reports.sentences.verdicts import told_speed
from alula.reports.turnable.moving import motion_linkage

GAIT = """cycle [%];flexion [deg];Fy [N];M [N*m]
0;10;300;-6
12;20;1000;12
30;12;700,5;-5
48;15;1100;-16
62;35;100;2
75;50;0;0
95;12;0;0
"""
STRIDE = {
    "own_weight": False,
    "forces": [{"link": "thigh", "at": "K", "force": ["0 N", "-column Fy"]}],
    "moments": [{"link": "thigh", "at": "K", "moment": "column M"}],
}
CYCLE = {"file": "gait.csv", "angle": "flexion", "zero": "-25 deg"}


def tables(name: str, **entries: Any) -> dict[str, Any]:
    """Return the tables of a built-in case with others in place of its motion and some of its own."""
    data = {key: value for key, value in tomllib.loads(read_text(name)[0]).items() if key not in ("motion", "checks")}
    return data | entries


def knee(folder: Path, table: str = GAIT, load_case: dict[str, Any] | None = None, **entries: Any) -> Case:
    """Return the built-in knee over a cycle; entries of [cycle] in ``entries``, or whole tables."""
    (folder / "gait.csv").write_text(table, encoding="utf-8")
    whole = {name: entries.pop(name) for name in ("motion", "pose", "body_mass") if name in entries}
    cycle = {key: value for key, value in (CYCLE | entries).items() if value is not None}
    data = tables("knee", load_cases={"stride": load_case or STRIDE}, cycle=cycle, **whole)
    return validate(data, str(folder))


def four_bar(folder: Path, degrees: Any, percent: Any, force: Any, cycle: Any = None, **entries: Any) -> Case:
    """Return the built-in four-bar over a cycle of its crank, with a force at the rocker's end."""
    rows = (
        f"{p!r},{a!r},{f!r}"
        for p, a, f in zip(*(np.asarray(x).tolist() for x in (percent, degrees, force)), strict=True)
    )
    (folder / "turn.csv").write_text("cycle [%],crank [deg],F [N]\n" + "\n".join(rows), encoding="utf-8")
    load = {"own_weight": True, "forces": [{"link": "rocker", "at": "P", "force": ["2 N", "column F"]}]}
    data = tables("four-bar", load_cases={"lift": load}, cycle={"file": "turn.csv", "angle": "crank"} | (cycle or {}))
    return validate(deepcopy(data | entries), str(folder))


@pytest.mark.parametrize("periodic", [True, False])
def test_speed_and_acceleration_are_of_second_order(periodic):
    """By a sine: four times as exact with twice as many rows; the speed where rows are uneven as well."""

    def errors(n: int, uneven: float) -> tuple[float, float]:
        t = np.linspace(0.0, 1.0 if periodic else 0.7, n + 1)
        t = t + uneven * np.sin(2.0 * np.pi * t) / (2.0 * np.pi) * periodic
        wave = 2.0 * np.pi * t
        found = states(100.0 * t, np.sin(wave), 2.0, periodic=periodic)
        inside = slice(None) if periodic else slice(1, -1)  # the ends' acceleration is their neighbours'
        exact = np.pi * np.cos(wave), -(np.pi**2) * np.sin(wave)
        return tuple(
            float(np.abs(own - true)[inside].max())
            for own, true in zip((found.speed, found.acceleration), exact, strict=True)
        )

    for coarse, fine in zip(errors(40, 0.0), errors(80, 0.0), strict=True):
        assert coarse / fine == pytest.approx(4.0, rel=0.05)
    assert errors(40, 0.3)[0] / errors(80, 0.3)[0] == pytest.approx(4.0, rel=0.1)


def test_where_the_coordinate_stands_it_has_no_speed_and_the_sense_that_it_had():
    values = np.array([0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0])
    percent = np.linspace(0.0, 100.0, 9)
    found = states(percent, values, None, periodic=True)
    assert found.times is None
    assert not found.speed.any()
    assert found.sense.tolist() == [-1.0, -1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0]
    assert states(percent, values, 1.0, periodic=True).speed[[1, 5]].tolist() == [0.0, 0.0]
    assert states(percent[:5], values[:5], None, periodic=False).sense.tolist() == [1.0] * 5  # as it will move


def test_a_row_is_the_case_at_that_instant(tmp_path):
    """Joint forces and drive torque over the cycle are those of the case checked there, by its own pose and statics."""
    moved = solve_case_motion(knee(tmp_path))
    assert moved.motion.progress.tolist() == [0.0, 12.0, 30.0, 48.0, 62.0, 75.0, 95.0, 100.0]
    forces = moved.forces["stride"]
    for row, percent in enumerate(moved.motion.progress):
        at = solve_case_statics(knee(tmp_path, instant=f"{percent:g} %"))
        assert at.pose.angles["rear"] == pytest.approx(moved.motion.angle("rear")[row], abs=1e-10)
        [found] = at.reactions.values() if hasattr(at, "reactions") else at.joint_forces.values()
        for joint, force in forces.forces.items():
            assert found.joints[joint].wrench[:2] == pytest.approx(force[row], abs=1e-8)
        assert found.drive_torque == pytest.approx(moved.torque["stride"][row], abs=1e-6)


def test_between_rows_the_instant_is_linear(tmp_path):
    at = knee(tmp_path, instant="36 %")  # a third of the way from 30 to 48 %
    assert np.degrees(at.pose.angle) == pytest.approx(-25.0 + 13.0)
    assert at.load_cases["stride"].forces[0].force[1] == pytest.approx(-(700.5 + 399.5 / 3.0))
    assert at.load_cases["stride"].moments[0].moment[2] == pytest.approx(-5000.0 - 11000.0 / 3.0)


@pytest.mark.parametrize("speed", ["120 rpm", "-120 rpm"])
def test_a_table_of_the_ordinary_motion_is_the_ordinary_motion(tmp_path, speed):
    """Even rows of a turn at constant speed: the same loads on every link, inertia and all, and the same motor."""
    motor = {"motor": {"type": "motor", "voltage": "6 V", "current": "0.3 A", "efficiency": 0.6}}
    turn = np.linspace(40.0, 400.0 if speed[0] != "-" else -320.0, 25)
    table = four_bar(tmp_path, turn, np.linspace(0, 100, 25), np.full(25, -5.0), {"period": "0.5 s"}, checks=motor)
    load = {"own_weight": True, "forces": [{"link": "rocker", "at": "P", "force": ["2 N", "-5 N"]}]}
    motion = {"turn": True, "poses": 25, "speed": speed}
    ordinary = validate(tables("four-bar", load_cases={"lift": load}, motion=motion, checks=motor))
    own, other = solve_case_motion(table), solve_case_motion(ordinary)
    assert own.torque["lift"] == pytest.approx(other.torque["lift"], rel=1e-9)
    assert own.power["lift"].kinetic == pytest.approx(other.power["lift"].kinetic, rel=1e-9)
    assert own.motion.times == pytest.approx(other.motion.times, abs=1e-12)
    assert own.motion.returns
    for link in ("crank", "coupler", "rocker"):
        [mine], [theirs] = link_histories(own, link), link_histories(other, link)
        assert mine.size(120.0) == pytest.approx(theirs.size(120.0), rel=1e-9)
    mine, theirs = (motor_outcomes(x, "motor", x.checks["motor"])["lift"][0].value for x in (table, ordinary))
    assert (mine.value, mine.low) == pytest.approx((theirs.value, theirs.low), rel=1e-9)


def test_a_cycle_may_dwell_and_go_back_and_forth(tmp_path):
    """Friction goes with the motion at each row: up as driven forward, down as driven backward."""
    percent, way = (
        np.linspace(0.0, 100.0, 13),
        np.array([50, 60, 70, 80, 90, 90, 90, 80, 70, 60, 50, 50, 50], dtype=float),
    )
    joints = tables("four-bar")["joints"]
    rough = {name: one | {"friction": 0.2} for name, one in joints.items()}
    case = four_bar(tmp_path, way, percent, [*(-5.0 - np.arange(12.0)), -5.0], joints=rough)
    moved = solve_case_motion(case)
    assert list(moved.torque) == ["lift"]
    assert ends_of(moved.motion.angles) == pytest.approx(np.radians([50.0, 90.0]))
    assert way_of(case, case.solve_pose()).angles == pytest.approx(np.radians(np.linspace(50.0, 90.0, 13)))
    assert moved.work("lift").total > moved.work("lift").total_without
    for row, direction in {1: "forward", 3: "forward", 5: "forward", 8: "backward", 11: "backward"}.items():
        load = {"own_weight": True, "direction": direction}
        force = -5.0 - row
        one = tables(
            "four-bar",
            joints=rough,
            load_cases={"lift": load | {"forces": [{"link": "rocker", "at": "P", "force": ["2 N", f"{force} N"]}]}},
            motion={"range": [f"{way[row]} deg", "95 deg"], "poses": 2},
        )
        single = solve_case_motion(validate(one))
        assert moved.torque["lift"][row] == pytest.approx(single.torque["lift"][0], rel=1e-9)
    [caveat] = step_caveats(case)
    assert dict(caveat.why.facts)["degrees"] == pytest.approx(10.0)


def test_cycles_of_stress_are_counted_in_their_order():
    """By hand: 0-100-40-80-0 repeated for ever is one cycle of 100 and one of 40; there and back counts 40 twice."""
    history = np.array([0.0, 100.0, 40.0, 80.0, 0.0])
    cycles = {
        (size, mean): count for size, mean, count in repeated_cycles(closed_history(history, returns=True)).tolist()
    }
    assert cycles == {(100.0, 50.0): 1.0, (40.0, 60.0): 1.0}
    there_and_back = repeated_cycles(closed_history(history, returns=False)).tolist()
    assert (40.0, 60.0, 2.0) in [tuple(one) for one in there_and_back]
    jump = repeated_cycles(closed_history(np.array([20.0, 100.0, 40.0]), returns=True))  # falls from 40 to 20 again
    assert jump.tolist() == [[80.0, 60.0, 1.0]]


def test_loads_may_change_in_a_pose_that_stays(tmp_path):
    """The knee held at its pose under the loads of a stride: at each row the statics of that load."""
    case = knee(tmp_path, angle=None, zero=None, period="1 s")
    moved = solve_case_motion(case)
    assert not moved.motion.speed.any()
    assert case.sweeps is False
    assert np.ptp(moved.motion.angle("rear")) == 0.0
    assert moved.torque["stride"][1] != pytest.approx(moved.torque["stride"][3], rel=0.1)
    at = solve_case_statics(knee(tmp_path, angle=None, zero=None, instant="48 %"))
    assert moved.forces["stride"].at(3).joints["A"].wrench == pytest.approx(
        at.reactions["stride"].joints["A"].wrench, abs=1e-8
    )


def test_instants_between_rows_follow_a_smooth_angle(tmp_path):
    """Of a sine of 16 rows read at 101 instants the spline's acceleration is 4 % off, a straight line's all of it."""
    percent = np.linspace(0.0, 100.0, 17)
    sine = 60.0 + 30.0 * np.sin(2.0 * np.pi * percent / 100.0)
    sine[-1] = sine[0]
    force = np.r_[np.linspace(-5.0, -20.0, 16), -5.0]
    case = four_bar(tmp_path, sine, percent, force, {"instants": 101, "period": "1 s"})
    found = case.motion.states
    wave = 2.0 * np.pi * found.percent / 100.0
    assert len(found.values) == 101
    assert np.degrees(found.values) == pytest.approx(60.0 + 30.0 * np.sin(wave), abs=0.02)
    exact = -np.radians(30.0) * (2.0 * np.pi) ** 2 * np.sin(wave)
    assert np.abs(found.acceleration - exact).max() < 0.04 * np.abs(exact).max()
    straight = states(found.percent, np.radians(np.interp(found.percent, percent, sine)), 1.0, periodic=True)
    assert np.abs(straight.acceleration - exact).max() > np.abs(exact).max()
    forces = [row.forces[0].force[1] for row in case.load_cases["lift"].rows]
    assert forces == pytest.approx(np.interp(found.percent, percent, force))


def test_time_says_when_rows_are_too(tmp_path):
    rows = GAIT.replace("cycle [%]", "time [ms]").replace("95;12", "100;10").replace("100;10;0;0", "100;10;300;-6")
    moved = solve_case_motion(knee(tmp_path, rows))
    assert moved.motion.times == pytest.approx([0.0, 0.012, 0.03, 0.048, 0.062, 0.075, 0.1])
    assert moved.motion.progress == pytest.approx([0.0, 12.0, 30.0, 48.0, 62.0, 75.0, 100.0])
    assert moved.case.inert
    assert not knee(tmp_path, rows, motion={"inertia": False}).inert
    assert not knee(tmp_path).inert  # per cent of what takes no stated time


def test_loads_in_body_weights_and_per_body_mass(tmp_path):
    table = "cycle [%];flexion [deg];Fy [body_weight];M [N*m/kg]\n" + GAIT.partition("\n")[2].replace("1000", "1,1")
    found = knee(tmp_path, table, body_mass="80 kg", instant="12 %").load_cases["stride"]
    assert found.forces[0].force[1] == pytest.approx(-1.1 * 80.0 * 9.80665)
    assert found.moments[0].moment[2] == pytest.approx(12.0 * 80.0 * 1000.0)
    assert found.rows[1].forces == found.forces
    with pytest.raises(CaseError, match=r"column M is in N\*m/kg, per mass of the body, which the case does not state"):
        knee(tmp_path, table)
    with pytest.raises(CaseError, match=r'no body is stated .*body_mass = "80 kg"'):
        knee(tmp_path, table.replace("N*m/kg", "N*m"))


def test_points_of_a_load_line_may_be_columns(tmp_path):
    """Down at 40 mm beside K over a lever that the table moves: the force and its moment about K at each row."""
    table = GAIT.replace("M [N*m]", "x [mm]")
    line = {"link": "thigh", "at": "K", "axes": "link", "force": "column Fy"}
    line |= {"from": ["column x", "100 mm"], "to": ["column x", "0 mm"]}
    moved = solve_case_motion(knee(tmp_path, table, {"own_weight": False, "load_lines": [line]}))
    [load] = [one for one in moved.loads["stride"] if one.link == "thigh"]
    x = np.array([-6.0, 12.0, -5.0, -16.0, 2.0, 0.0, 0.0, -6.0]) - 10.0
    size = np.array([300.0, 1000.0, 700.5, 1100.0, 100.0, 0.0, 0.0, 300.0])
    assert np.linalg.norm(load.wrench[:, :2], axis=1) == pytest.approx(size)
    assert load.wrench[:, 5] == pytest.approx(-x * size)
    short = line | {"from": ["column x", "0 mm"], "to": ["-5 mm", "0 mm"]}
    with pytest.raises(CaseError, match=r"row 4, column Fy and x: load_cases\.stride\.load_lines\.0: from and to are"):
        knee(tmp_path, table, {"own_weight": False, "load_lines": [short]})


@pytest.mark.parametrize(
    ("change", "entries", "told"),
    [
        (("95;12;0;0", "95;12;0;0\n100;10;310;-6"), {}, "row 9, column Fy: 310 at the end of the cycle is not 300 at"),
        (("95;12;0;0", "95;12;0;0\n100;11;300;-6"), {}, "row 9, column flexion: 11 at the end of the cycle is not 10"),
        (("95;12", "105;12"), {}, "row 8, column cycle: the table goes on beyond one cycle, by 5 %"),
        (("12;20", "0;20"), {}, "row 3, column cycle: 0 does not come after 0"),
        (("cycle [%]", "cycle [deg]"), {}, "column cycle: its unit is deg, but it counts in per cent"),
        (("cycle [%]", "share [%]"), {}, r"needs one column that says when .*, but has neither"),
        (("Fy [N]", "time [s]"), {}, r"needs one column that says when .*, but has both"),
        (("Fy [N]", "Fx [N]"), {}, "has no column 'Fy'; its columns are cycle, flexion, Fx, M"),
        (("Fy [N]", "Fy [mm]"), {}, r"row 2, column Fy: load_cases\.stride\.forces\.0\.f.* is not a unit of force"),
        (("M [N*m]", "M [N]"), {}, r"row 2, column M: load_cases\.stride\.moments\.0\.m.* is not a unit of moment"),
        (("flexion [deg]", "flexion [mm]"), {}, "row 2, column flexion: \"mm\" is not a unit of angle"),
        (("30;12", "30;"), {}, "row 4, column flexion: the cell is empty"),
        (("12;20;1000", "12;20;1e30"), {}, r"'gait.csv', row 3, column Fy: load_cases\.stride\..*at most 1e\+20"),
        (("62;35", "62;-170"), {}, "row 6, column flexion: it jumps by -185 deg, more than half a turn; let it go on"),
        (("75;50;0;0\n95;12", "75;205;0;0\n95;195"), {}, "row 8, column flexion: whether it comes back from 195"),
        ((), {"file": "none.csv"}, r"cycle: table '.*': there is no such file"),
        ((), {"angle": "knee"}, "cycle: 'gait.csv' has no column 'knee'"),
        ((), {"zero": "5 mm"}, "cycle: zero: \"mm\" is not a unit of angle"),
        ((), {"instant": "120 %"}, r"cycle\.instant .* share of the cycle from \"0 %\" to \"100 %\""),
        ((), {"instant": 45}, r"cycle\.instant .* share of the cycle"),
        ((), {"instant": "97 %", "periodic": False}, "cycle.instant: 97 % is not in the table, from 0 to 95 %"),
        ((), {"periodic": "no"}, r"cycle\.periodic \(it is 'no'\): it must be true or false"),
        ((), {"instants": True}, r"cycle\.instants \(it is True\): it must be a whole number"),
        ((), {"speed": "1"}, r"cycle\.speed: this key is unknown"),
        ((), {"motion": {"range": ["0 deg", "9 deg"]}}, r"motion\.range: the table of the cycle says how"),
        ((), {"motion": {"instant_centre": "coupler"}}, r"motion\.instant_centre: 'coupler' is not a moving link"),
        ((), {"motion": {"against": "shank"}}, "motion: against is the second link of an instant centre"),
        ((), {"motion": {"coordinate": "rear"}}, r"motion\.coordinate: the cycle moves .* 'thigh'"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_one_sentence(tmp_path, change, entries, told):
    table = GAIT
    if change:
        assert change[0] in table
        table = table.replace(*change, 1)
    with pytest.raises(CaseError) as refused:
        knee(tmp_path, table, **entries)
    assert re.search(told, str(refused.value)), refused.value


def test_a_swing_of_more_than_half_a_turn_comes_back_and_a_crank_goes_on(tmp_path):
    """A row that is left out at the end is the first again: the way that the last step goes, and no full turn more."""
    swing = GAIT.replace("62;35", "62;100").replace("75;50", "75;188")
    assert np.degrees(np.ptp(knee(tmp_path, swing).motion.states.values)) == pytest.approx(178.0)
    crank = "cycle [%];flexion [deg];Fy [N];M [N*m]\n0;-10;0;0\n30;110;0;0\n60;230;0;0\n"
    assert np.degrees(np.diff(knee(tmp_path, crank).motion.states.values)) == pytest.approx([120.0] * 3)


def test_columns_need_a_cycle_and_a_cycle_needs_columns(tmp_path):
    data = tables("knee", load_cases={"stride": STRIDE})
    with pytest.raises(
        CaseError, match=r"load_cases\.stride\.forces\.0\.force\.1: it names a column, but the case states"
    ):
        validate(data)
    plain = tables("knee", cycle={"file": "gait.csv"})
    with pytest.raises(CaseError, match="cycle: nothing names a column of it"):
        validate(plain, str(tmp_path))
    with pytest.raises(CaseError, match=r"^cycle: it must be a table of entries; write it as \[cycle\]"):
        validate(plain | {"cycle": [{"file": "gait.csv"}]}, str(tmp_path))
    titled = {"stride": STRIDE | {"title": "column Fy"}}  # a title is text
    assert knee(tmp_path, load_case=titled["stride"]).load_cases["stride"].title == "column Fy"
    with pytest.raises(CaseError, match=r"load_cases\.stride\.speed: the table of the cycle says how fast"):
        knee(tmp_path, load_case=STRIDE | {"speed": "5 rpm"})


def test_a_study_varies_the_instant_and_the_body(tmp_path):
    """Each variant travels with its table; the rear plates bear in proportion to the body's mass."""
    table = "cycle [%];flexion [deg];Fy [body_weight];M [N*m/kg]\n0;20;0,5;0,1\n50;40;1;-0,2\n100;20;0,5;0,1\n"
    knee(tmp_path, table, body_mass="80 kg")
    data = tables("knee", load_cases={"stride": STRIDE}, cycle=CYCLE, body_mass="80 kg")
    data["cycle"] = CYCLE | {"file": str(tmp_path / "gait.csv")}
    vary = {"cycle.instant": ["0 %", "50 %"], "body_mass": ["60 kg", "80 kg"]}
    variants = Variants(plan_of({"case": "knee", "tables": data, "fidelity": "beam", "vary": vary}), tmp_path)
    contents = {name: path.read_bytes() for name, path in variants.files.items()}
    torque = {}
    for point in variants.points:
        done = evaluate(task_of(variants.plan, variants.tables(point)), contents)
        assert done.state == "done", done.sentence
        torque[point["cycle.instant"], point["body_mass"]] = next(
            x for x in done.numbers if "drive" in x.quantity
        ).value
    assert list(contents) != ["gait.csv"]
    for instant in ("0 %", "50 %"):
        assert torque[instant, "80 kg"] == pytest.approx(torque[instant, "60 kg"] * 8.0 / 6.0)
    assert torque["0 %", "80 kg"] != pytest.approx(torque["50 %", "80 kg"], rel=0.1)


WALK = "cycle [%],F [N],ahead [mm]\n0,50,0\n15,1000,-20\n30,400,10\n45,800,40\n60,50,0\n"


def pylon(folder: Path, table: str = WALK, *, motion: dict[str, str] | None = None, **cycle: Any) -> Case:
    """Return a tube clamped on the ground, upright, under a load line whose place and size change over a cycle."""
    (folder / "walk.csv").write_text(table, encoding="utf-8")
    line = {"from": ["column ahead", "400 mm", "30 mm"], "to": ["column ahead", "-80 mm", "-20 mm"]}
    tube = {"shape": "tube", "material": "aluminium-6061-t6", "outer_diameter": "30 mm", "inner_diameter": "24 mm"}
    points = {"O": ["0 mm", "0 mm"], "T": ["300 mm", "0 mm"]}
    data = {
        "schema_version": 1,
        "title": "A pylon over a stride",
        "links": {
            "ground": {"ground": True, "points": {"O": ["0 mm", "0 mm"]}},
            "pylon": {"part": "tube", "points": points, "end_patch": "40 mm"},
        },
        "joints": {"O": {"links": ["ground", "pylon"], "clamped": True, "clamp_length": "40 mm", "angle": "90 deg"}},
        "parts": {"tube": tube | {"fillet_radius": "1 mm"}},
        "cycle": {"file": "walk.csv"} | cycle,
        "load_cases": {"walk": {"load_lines": [line | {"force": "column F", "link": "pylon", "at": "T"}]}},
        "conditions": {"cycles": 1e6},
    }
    return validate(data | ({} if motion is None else {"motion": motion}), str(folder))


def test_a_structure_bears_a_cycle_of_oblique_loads(tmp_path):
    """It stays in its pose; all six components at its clamp are those of the case at that instant, and r x F."""
    found = solve_case_motion(pylon(tmp_path, period="1.1 s"))
    moved = with_couples(found, np.ones(6, dtype=bool)).moved
    wrench, forces = moved.forces["walk"].joints["O"].wrench, [50.0, 1000.0, 400.0, 800.0, 50.0, 50.0]
    for row, (percent, ahead) in enumerate(zip((0, 15, 30, 45, 60, 100), (0, -20, 10, 40, 0, 0), strict=True)):
        at = solve_case_statics(pylon(tmp_path, instant=f"{percent} %")).reactions["walk"].joints["O"].wrench
        assert wrench[row] == pytest.approx(at, abs=1e-6 * np.abs(at).max())
        along = np.array([0.0, -480.0, -50.0])
        force = forces[row] * along / np.linalg.norm(along)
        assert wrench[row] == pytest.approx(-np.r_[force, np.cross([ahead, 400.0, 30.0], force)], abs=1e-3)
    assert not moved.case.inert
    assert _worst(found, "walk", np.ones(6, dtype=bool)) == [1]  # of 1000 N
    [history] = link_histories(moved, "pylon")
    assert history.size(300.0)[[0, 4, 5]] == pytest.approx([history.size(300.0)[0]] * 3)
    with pytest.raises(CaseError, match="the linkage cannot move"):
        motion_findings(found)
    with pytest.raises(CaseError, match=r"motion\.instant_centre: the case has no coordinate that could move"):
        pylon(tmp_path, motion={"instant_centre": "pylon"})


def test_two_peaks_of_a_cycle_are_two_cycles_of_stress(tmp_path):
    """By hand: of 50-1000-400-800-50 N straight down one cycle of 950 N and one of 400 N, not two as there and back."""
    line = WALK.replace("-20", "0").replace(",10\n", ",0\n").replace(",40\n", ",0\n")
    moved = solve_case_motion(pylon(tmp_path, line, periodic=False))
    n = len(moved.motion.angles)
    over = envelope._Envelope(moved, np.ones(n, dtype=bool), 1, lambda told: None)
    space = displacement_space(mesh_body(moved.case.body("pylon"), COARSE.scaled(3.0)))
    fatigue = over._motion("pylon", space).envelope(repetitions=1e6).load_cases["walk"].fatigue
    sizes, means, counts = np.transpose(fatigue.life.cycles)
    assert counts.tolist() == [1.0, 1.0]
    assert sizes / sizes[0] == pytest.approx([1.0, 400.0 / 950.0])
    assert means[1] / means[0] == pytest.approx(600.0 / 525.0)


def test_no_cycle_goes_there_and_back(tmp_path, monkeypatch):
    """One that ends elsewhere jumps to its first row; a motion over a range goes back."""
    monkeypatch.setattr(envelope, "LinkMotion", lambda space, **stated: stated["returns"])
    ordinary = validate(tables("knee", motion={"range": ["-20 deg", "5 deg"], "poses": 3}))
    for case, returns in ((knee(tmp_path, periodic=False), True), (ordinary, False)):
        moved = solve_case_motion(case)
        assert not moved.motion.returns
        over = envelope._Envelope(moved, np.ones(len(moved.motion.angles), dtype=bool), 1, lambda told: None)
        assert over._motion("rear", None) is returns


def test_a_speed_that_changes_is_told_from_its_least_to_its_largest(tmp_path):
    """By parabolas the crank turns at -20, 80, 20 and -80 deg/s; that of the first row alone is true of no cycle."""
    turned = four_bar(tmp_path, [40, 60, 80, 70, 40], [0, 25, 50, 75, 100], [1] * 5, {"period": "1 s"})
    assert told_speed(solve_case_motion(turned), "lift") == "−13.33 to 13.33 rpm"
    ordinary = validate(tables("knee", motion={"range": ["-20 deg", "5 deg"], "poses": 3, "speed": "6 rpm"}))
    assert told_speed(solve_case_motion(ordinary), "late-stance") == "6 rpm"


def test_a_file_of_a_cycle_may_have_any_name(tmp_path):
    (tmp_path / "gait{1}.csv").write_text(GAIT, encoding="utf-8")
    told = range_text(solve_case_motion(knee(tmp_path, file="gait{1}.csv"))).text
    assert told.startswith("Over the cycle of gait{1}.csv: from thigh = ")


def test_reports_tell_where_in_the_cycle(tmp_path):
    moved = solve_case_motion(knee(tmp_path))
    told = told_motion.record(moved)
    assert stated_size(knee(tmp_path, instant="80 %"), "stride") == stated_size(
        knee(tmp_path, instant="48 %"), "stride"
    )
    assert told["motion"]["cycle"] == moved.motion.progress.tolist()
    assert told["load_cases"]["stride"]["drive_torque"]["largest_at"] == 48.0
    assert [float(row["cycle [%]"]) for row in told_motion.rows(moved, "torque.csv")] == told["motion"]["cycle"]
    assert "1100 N at 48 % of the cycle" in [
        x["text"] for x in motion_linkage(solve_case_motion(knee(tmp_path, instant="48 %")))["loads"]
    ]
    axes = torque_figure(moved).axes[0]
    assert axes.get_xlabel() == "cycle [%]"
    assert axes.get_xlim() == (0.0, 100.0)
    assert axes.lines[0].get_xdata() == pytest.approx(moved.motion.progress)
    assert sentence_of(when(moved, 3)) == "48 % of the cycle"
    over = {"limit_load": Band.exact(5.0), "limit_pose": 3, "displacement": Band.exact(0.25), "displacement_pose": -1}
    text = linkage_text(moved, LinkageOverMotion(poses=(2, 3), where="D of thigh", **over)).text
    assert text.startswith(
        "The linkage as a whole, in 2 of 8 poses: least limit-load factor 5.00 at 48 % of the cycle, "
    )
    assert text.endswith("largest displacement 0.250 mm (D of thigh).")
