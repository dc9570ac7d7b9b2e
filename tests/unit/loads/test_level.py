"""A level of tests: what each makes of the case, where its load line lies, and what is refused in one sentence."""

from copy import deepcopy

import numpy as np
import pytest
import tomlkit
from levels import BOTTOM, CYCLIC, LEVEL, PLACED, PROOF, PYLON, TOP, pylon

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.case.level_case import Demand, demanded, level_caveats, over_states
from alula.loads.compose.stated_case import StatedCase
from alula.loads.records.load_case import Block
from alula.loads.stated.level_spec import LevelSpec
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.sentences.caveats import caveat


def line(case, test):
    [found] = case.load_cases[test].load_lines
    return np.array([found.from_, found.to])


def test_tests_are_load_cases_where_the_case_states_none():
    case = validate(pylon())
    assert list(case.load_cases) == ["proof", "cyclic"]
    assert case.tests_alone
    assert [case.load_cases[x].load_lines[0].force for x in case.load_cases] == [1000.0, 600.0]
    [told] = level_caveats(case)
    assert "alula check goes over all of them" in caveat(told)
    own = validate(pylon(load_cases={"push": {"forces": [{"link": "pylon", "at": "T", "force": ["5 N", "0 N"]}]}}))
    assert list(own.load_cases) == ["push"]
    assert not own.tests_alone


@pytest.mark.parametrize(("loads", "told"), [(False, True), (True, False)])
def test_checks_that_no_test_asks_are_told(loads, told):
    stated = pylon(checks={"stiff": {"type": "displacement", "at": "T", "maximum": "1 mm"}})
    if loads:
        stated["load_cases"] = {"push": {"forces": [{"link": "pylon", "at": "T", "force": ["5 N", "0 N"]}]}}
    for test in ("proof", "cyclic"):
        stated["level"]["test"] = test
        every = [caveat(one) for one in level_caveats(validate(stated))]
        assert any("checks that the case itself states" in one for one in every) is told


def test_without_load_cases_and_level_the_entry_is_missing():
    with pytest.raises(CaseError, match=r"^load_cases: this entry is missing; add it$"):
        validate(deepcopy(PYLON))


def test_a_chosen_test_stands_in_place_of_loads_checks_and_conditions():
    stated = pylon(
        level={"test": "cyclic"},
        load_cases={"push": {"forces": [{"link": "pylon", "at": "T", "force": ["5 N", "0 N"]}]}},
        checks={"stiff": {"type": "displacement", "at": "T", "maximum": "1 mm"}},
        conditions={"cycles": 10, "reverses": True, "temperature": "20 degC"},
        ways_to_hold={"link": "pylon", "at": "T", "load_case": "push"},
        tolerances={f"load_cases.{name}": "5 %" for name in ("push", "cyclic")} | {"parts.tube.outer_diameter": "1 mm"},
    )
    case = validate(stated)
    assert list(case.load_cases) == ["cyclic"]
    assert list(case.tolerances) == ["load_cases.cyclic", "parts.tube.outer_diameter"]
    with pytest.raises(CaseError, match="'pull' is no load case; choose one of cyclic"):
        validate(stated | {"tolerances": {"load_cases.pull": "5 %"}})
    assert case.repeated("cyclic") == ((pytest.approx(0.1), 1.0), (Block((0, 1), 1.0),))
    assert (case.conditions.cycles, case.conditions.reverses, case.conditions.temperature) == (1e6, False, 20.0)
    assert {name: check.type for name, check in case.checks.items()} == {"lasts": "fatigue"}
    assert case.checks["lasts"].minimum == 1.0
    [told] = level_caveats(case)  # the card has a typical strength, and the limit 1 covers nothing
    assert caveat(told).startswith("scatter of the fatigue strength of aluminium-6061-t6 (no strength_range")
    stated["level"]["test"] = "proof"
    case = validate(stated)
    assert case.conditions.cycles is None
    assert {name: check.type for name, check in case.checks.items()} == {"stays elastic": "safety-factor"}
    told = [caveat(one) for one in level_caveats(case)]
    assert told[0].startswith("steps of 200 N (the step of 1000 N is judged")
    assert told[1].startswith("creep while the force is held for 20 s")


@pytest.mark.parametrize(
    ("changed", "top"),
    [
        ({}, [50.0, 400.0, 20.0]),  # up times forward is -z: outward of a left leg that walks along x
        ({"outward": "+z"}, [50.0, 400.0, -20.0]),
        ({"forward": "-x"}, [-50.0, 400.0, -20.0]),
        ({"forward": "+y", "up": "-x", "outward": "-z"}, [-400.0, 50.0, 20.0]),
        ({"forward": "+z", "up": "+y", "outward": "-x"}, [20.0, 400.0, 50.0]),
        ({"origin": ["1 mm", "2 mm", "3 mm"]}, [51.0, 402.0, 23.0]),
    ],
)
def test_axes_of_the_standard_lie_as_the_case_says(changed, top):
    case = validate(pylon(level=changed))
    assert line(case, "proof")[0] == pytest.approx(top)
    level = LevelSpec.model_validate(pylon(level=changed)["level"])
    forward, outward, up = level.axes
    if "outward" not in changed:
        assert np.cross(forward, outward) == pytest.approx(up)


def test_a_file_beside_the_case_states_the_tests(tmp_path):
    """It may have a byte order mark and CRLF; entries of it can be changed, and a case written elsewhere holds them."""
    written(tmp_path, LEVEL, encoding="utf-8-sig", newline="\r\n")
    path = str(tmp_path / "case.toml")
    case, here = read_case(path), validate(pylon())
    assert case.level.tests == here.level.tests
    assert case.level.read_from.startswith("level.toml, SHA-256 ")
    assert case.load_cases == here.load_cases
    heavier = read_case(path, ['level.tests.proof.steps.1.force="1100 N"', "level.test=proof"])
    assert heavier.load_cases["proof"].load_lines[0].force == 1100.0
    assert case.with_values({"level.test": "cyclic"}).conditions.cycles == 1e6
    (tmp_path / "other").mkdir()
    made = StatedCase.from_dict(pylon(), folder=tmp_path).with_entries(level={"file": "level.toml", **PLACED})
    for number, one in enumerate((StatedCase.read(path), made)):
        copy = tmp_path / "other" / f"copy{number}.toml"
        one.to_toml(copy)
        assert read_case(str(copy)).level == case.level


def test_a_force_may_be_a_share_of_the_body_weight():
    test = {"tests": {"proof": {**PROOF, "steps": [{"force": "2 body_weight"}]}}}
    case = validate(pylon(level=test, body_mass="100 kg"))
    assert case.load_cases["proof"].load_lines[0].force == pytest.approx(2.0 * 980.665)


def written(folder, level, *, encoding="utf-8", newline="\n", **placed):
    case = {**PYLON, "level": {"file": "level.toml", **PLACED, **placed}}
    (folder / "case.toml").write_text(tomlkit.dumps(case), encoding="utf-8")
    text = level if isinstance(level, str) else tomlkit.dumps(level)
    (folder / "level.toml").write_text(text, encoding=encoding, newline=newline)


def with_test(test, **changes):
    return {"tests": {"proof": PROOF, "second": {key: x for key, x in (test | changes).items() if x is not None}}}


SECOND = "level.tests.second"


@pytest.mark.parametrize(
    ("level", "sentence"),
    [
        ({"source": None}, "level: test 'proof' does not say where its numbers come from; write source"),
        ({"source": " "}, "level: test 'proof' does not say where its numbers come from"),
        ({"source": None, "tests": {"a": PROOF | {"source": "x"}, "b": PROOF}}, "level: test 'b' does not say where"),
        ({"standard": None}, "level.standard: this entry is missing"),
        ({"enters": None}, "level.enters: this entry is missing"),
        ({"enters": {"link": "pilon", "at": "T"}}, "level.enters.link: 'pilon' is not a moving link; choose one of"),
        ({"enters": {"link": "pylon", "at": "B"}}, "level.enters: link 'pylon' has no point 'B'"),
        ({"leaves": {"link": "foot", "at": "O"}}, "level.leaves.link: 'foot' is not a moving link"),
        ({"leaves": PLACED["enters"]}, "level: its forces would enter and leave at one point"),
        ({"forward": "x"}, "level.forward (it is 'x'): it must be one of '+x', '-x'"),
        ({"up": "-x"}, 'level: two of forward = "+x", up = "-x" lie along one axis'),
        ({"outward": "+y"}, "lie along one axis; give each an axis of its own"),
        ({"test": "prof"}, "level: test = 'prof' is none of its tests; choose one of proof, cyclic"),
        ({"tests": {}}, "level.tests: it has 0, but at least 1 must be there"),
        ({"tests": {"Proof": PROOF, "proof": PROOF}}, "level.tests: 'Proof' and 'proof' differ in case alone"),
        (with_test(PROOF, top=None), f"{SECOND}.top: this entry is missing"),
        (with_test(PROOF, top={"forward": "5 mm", "up": "1 mm"}), f"{SECOND}.top.outward: this entry is missing"),
        (with_test(PROOF, top={**TOP, "up": "4,0 mm"}), f"{SECOND}.top.up (it is '4,0 mm'): "),
        (with_test(PROOF, bottom=TOP), f"{SECOND}: top and bottom are one point"),
        (with_test(PROOF, steps=[]), f"{SECOND}.steps (it is []): it has 0, but at least 1"),
        (with_test(PROOF, steps=[{"duration": "30 s"}]), f"{SECOND}.steps.0: a step is of a force or of a"),
        (with_test(PROOF, steps=[{"force": 1000}]), f"{SECOND}.steps.0.force (it is 1000): "),
        (with_test(PROOF, steps=[{"force": "1.1 body_weight"}]), "no body is stated that weighs so much"),
        (with_test(PROOF, steps=[{"force": "nan N"}]), f"{SECOND}.steps.0.force (it is 'nan N'): "),
        (with_test(PROOF, steps=[{"force": "-5 N"}]), f"{SECOND}.steps.0.force (it is '-5 N'): it must be greater"),
        (with_test(PROOF, elastic="yes"), f"{SECOND}.elastic (it is 'yes'): it must be true or false"),
        (with_test(CYCLIC, lasts=1), f"{SECOND}.lasts (it is 1): it must be true or false"),
        (with_test(CYCLIC, steps=[{"force": "5 N", "cycles": True}]), f"{SECOND}.steps.0.cycles (it is True)"),
        (with_test(CYCLIC, steps=[{"force": "5 N", "cycles": "3e6"}]), f"{SECOND}.steps.0.cycles (it is '3e6')"),
        (with_test(PROOF, elastic=False), f"{SECOND}: it asks for nothing; write elastic = true"),
        (with_test(PROOF, permanent_set="0 mm"), f"{SECOND}.permanent_set (it is '0 mm'): "),
        (with_test(PROOF, lasts=True), f"{SECOND}: lasts = true needs a step with cycles"),
        (with_test(CYCLIC, lasts=False, elastic=True), f"{SECOND}: a step has cycles, but that they are borne"),
        (with_test(CYCLIC, steps=[{"force": "5 N", "cycles": float("nan")}]), f"{SECOND}.steps.0.cycles (it is nan)"),
        (
            with_test(CYCLIC, steps=[{"force": "5 N", "cycles": 2, "least": "5 N"}]),
            f"{SECOND}.steps.0: least is 5 N, but must be below force, 5 N",
        ),
        (with_test(PROOF, steps=[{"force": "5 N", "least": "1 N"}]), f"{SECOND}.steps.0: least is that of cycles"),
        (
            with_test(CYCLIC, steps=[{"force": "5 N", "cycles": 2, "duration": "1 s"}]),
            f"{SECOND}.steps.0: a step is held for a duration or has cycles",
        ),
        (with_test(PROOF, steps=[{"force": "5 N", "scale": 1.1}]), f"{SECOND}.steps.0: scale is that of a profile"),
        (with_test(PROOF, tilts_about=TOP), f"{SECOND}: tilts_about is that of a profile with a tilt"),
    ],
)
def test_what_a_level_must_not_state_is_one_sentence(level, sentence, tmp_path):
    with pytest.raises(CaseError) as caught:
        validate(pylon(level=level))
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "placed", "sentence"),
    [
        ({**LEVEL, "source": ""}, {}, "level: test 'proof' does not say where its numbers come from"),
        (
            {**LEVEL, **with_test(PROOF, steps=[{"force": "1,000 N"}])},
            {},
            "level file 'level.toml': tests.second.steps.0.force (it is '1,000 N'): ",
        ),
        (
            {**LEVEL, **with_test(PROOF, bottom=None, top=None)},
            {},
            "level file 'level.toml': tests.second.top, tests.second.bottom: these entries are missing",
        ),
        ({**LEVEL, "test": "proof"}, {}, "level file 'level.toml': test: this key is unknown; did you mean 'tests'?"),
        ({**LEVEL, "level": LEVEL}, {}, "level file 'level.toml': level: this key is unknown; a level file has"),
        (LEVEL, {"name": "X"}, "level.name: it stands in level file 'level.toml' too; state it in one of the two"),
        (tomlkit.dumps(LEVEL) + "[tests.proof]\n", {}, "level file 'level.toml': this is not valid TOML: "),
        ("standard = \n", {}, "level file 'level.toml': this is not valid TOML: "),
        ("\ufeff\n", {}, "level file '"),
        (LEVEL, {"file": "../level.toml"}, "level.file: '../level.toml' must be the plain name of a file beside"),
        (LEVEL, {"file": "/etc/passwd"}, "level.file: '/etc/passwd' must be the plain name"),
        (LEVEL, {"file": ".hidden"}, "level.file: '.hidden' must be the plain name"),
        (LEVEL, {"file": ""}, "level.file: '' must be the plain name"),
        (LEVEL, {"file": "none.toml"}, "there is no such file beside the case; put it there, or correct level.file"),
        (LEVEL, {"file": 5}, "level.file (it is 5): it must be text"),
        (LEVEL, {"read_from": "mine"}, "level.file: the case has read its level already"),
    ],
)
def test_a_malformed_level_file_is_one_sentence(text, placed, sentence, tmp_path):
    written(tmp_path, text, **placed)
    with pytest.raises(CaseError) as caught:
        read_case(str(tmp_path / "case.toml"))
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_and_latin_text_are_no_level_file(tmp_path):
    written(tmp_path, LEVEL)
    (tmp_path / "level.toml").write_bytes(b'standard = "N\xe4me"\n')
    with pytest.raises(CaseError, match="it is not UTF-8 text"):
        read_case(str(tmp_path / "case.toml"))
    (tmp_path / "level.toml").unlink()
    (tmp_path / "level.toml").mkdir()
    with pytest.raises(CaseError, match="it is a folder"):
        read_case(str(tmp_path / "case.toml"))
    with pytest.raises(CaseError, match=r"level\.file: 'nul\?' must be the plain name"):
        validate(pylon(level=dict.fromkeys(LEVEL) | {"file": "nul\0"}))


def test_each_link_is_asked_whether_it_breaks_by_what_can_be_told_of_it():
    """A ductile tube collapses, a printed one breaks where its layers part, a brittle one at its notches."""
    tests = {"break": PROOF | {"elastic": False, "no_break": True}}
    stated = pylon(level={"tests": tests, "test": "break"}, joint_model="bonded")
    stated["links"] |= {
        name: {"part": name, "points": {"T": ["0 mm", "0 mm"], "E": ["60 mm", "0 mm"]}} for name in ("print", "cast")
    }
    stated["joints"] |= {
        "T": {"links": ["pylon", "print"], "pin_diameter": "4 mm", "angle": "0 deg"},
        "E": {"links": ["print", "cast"], "pin_diameter": "4 mm", "angle": "0 deg"},
    }
    stated["links"]["cast"]["points"] = {"E": ["0 mm", "0 mm"], "F": ["60 mm", "0 mm"]}
    bar = {"shape": "bar", "width": "12 mm", "thickness": "6 mm", "fillet_radius": "1 mm"}
    stated["parts"] |= {
        "print": {**bar, "material": "petg-fdm-xy", "build_direction": [0, 0, 1]},
        "cast": {**bar, "material": "resin-405nm"},
    }
    checks = demanded(validate(stated))[Demand.NO_BREAK]
    asked = {check.type: getattr(check, "links", None) for check in checks.values()}
    assert asked["plastic-collapse"] == ("pylon",)
    assert asked["safety-factor"] == ("print",)
    assert asked["notch"] == ("cast",)
    assert asked["wall"] == ("pylon", "print", "cast")
    assert checks["pins"].joints == ("T", "E")
    assert all(check.minimum == 1.0 for check in checks.values())


ROLL = {
    "top": TOP,
    "bottom": BOTTOM,
    "tilts_about": {"forward": "0 mm", "outward": "0 mm", "up": "80 mm"},
    "steps": [{"profile": "roll.csv", "cycles": 1e6}],
    "lasts": True,
}
FIRST_TILTED = "time [ms],force [N],tilt [deg]\n0,9,-20\n1,8,-10\n"
TABLE = "time [ms],force [N],tilt [deg]\n0,0,-20\n100,900,-15\n300,600,20\n"


def rolled(folder, table=TABLE, *, stated=None, **changes):
    """Return the case whose second test is a profile; ``stated`` is the name of its file."""
    (folder / "roll.csv").write_text(table, encoding="utf-8")
    test = {key: one for key, one in (ROLL | changes).items() if one is not None}
    if stated:
        test["steps"] = [{"profile": stated, "cycles": 1e6}]
    return validate(pylon(level={"tests": {"proof": PROOF, "roll": test}}), str(folder))


@pytest.mark.parametrize(
    "table",
    [
        TABLE,
        "\ufefftilt [rad];force [kN];time [s]\n-0,3490658504;0;5\n-0,2617993878;0,9;5,1\n0,3490658504;0,6;5,3\n",
    ],
)
def test_a_profile_is_read_whatever_its_columns(table, tmp_path):
    """Time counts from its first row; the state of the largest force is shown where no test is chosen."""
    level = rolled(tmp_path, table).level
    rows = level.tests["roll"].states
    assert [row.name for row in rows] == ["row 2", "row 3", "row 4"]
    assert np.array([row[1:] for row in rows]) == pytest.approx(
        np.array([[0.0, np.radians(-20.0), 0.0], [900.0, np.radians(-15.0), 0.1], [600.0, np.radians(20.0), 0.3]])
    )
    assert rolled(tmp_path, table).load_cases["roll"].load_lines[0].force == pytest.approx(900.0)
    chosen = validate(pylon(level={"tests": {"roll": ROLL}, "test": "roll"}), str(tmp_path))
    assert list(chosen.load_cases) == ["row 3", "row 4"]  # without force nothing is judged
    assert (chosen.conditions.cycles, chosen.motion) == (1e6, None)
    over = over_states(chosen)
    assert [row.load_lines[0].force for row in over.load_cases["roll"].rows] == pytest.approx([0.0, 900.0, 600.0])
    assert over.load_cases["roll"].blocks == (Block((0, 1, 2), 1.0),)


def test_a_load_line_is_tilted_about_the_stated_point(tmp_path):
    """By 90 deg less 1e-9 what lies above goes behind; the outward offsets stay, and the force may be scaled."""
    steps = [{"profile": "roll.csv", "scale": 1.1, "cycles": 1e6}]
    level = rolled(tmp_path, TABLE.replace("20\n", "89.999999999\n"), steps=steps).level
    state = level.tests["roll"].states[-1]
    assert state.force == pytest.approx(660.0)
    assert level.line(level.tests["roll"], state) == pytest.approx(
        np.array([[-320.0, 130.0, 20.0], [80.0, 40.0, -10.0]]), abs=1e-6
    )


@pytest.mark.parametrize("order", [1, -1])
def test_states_and_blocks_follow_the_steps(order, tmp_path):
    """Unloaded first; what settles below the largest cycles is left out, but not beside a profile."""
    hold, small, once = {"force": "2 kN"}, {"force": "200 N"}, {"least": "60 N", "force": "600 N", "cycles": 3e5}
    test = LevelSpec.model_validate(
        pylon(level={"tests": {"a": CYCLIC | {"steps": [small, hold, once, *CYCLIC["steps"]][::order]}}})["level"]
    ).tests["a"]
    first = [("step 2", 2000.0), ("step 3 least", 60.0), ("step 3", 600.0), ("step 4 least", 60.0), ("step 4", 600.0)]
    last = [("step 1 least", 60.0), ("step 1", 600.0), ("step 2 least", 60.0), ("step 2", 600.0), ("step 3", 2000.0)]
    assert [state[:2] for state in test.states] == [("unloaded", 0.0), *(first if order == 1 else last)]
    shares = [3e5 / 1.3e6, 1e6 / 1.3e6][::order]
    states = ((2, 3), (4, 5)) if order == 1 else ((1, 2), (3, 4))
    assert [block.states for block in test.blocks] == [*states, (0, 1, 2, 3, 4, 5)]
    assert [block.share for block in test.blocks] == pytest.approx([*shares, 1.0 / 1.3e6])
    assert (test.cycles, test.decisive.most) == (1.3e6, 2000.0)
    mixed = rolled(tmp_path, steps=[small, *ROLL["steps"]]).level.tests["roll"]
    assert [state.name for state in mixed.states] == ["unloaded", "step 1", *(f"step 2 row {k}" for k in (2, 3, 4))]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"table": TABLE.replace("time", "cycle")}, "'roll.csv' has no column 'time'"),
        ({"table": TABLE.partition("\n")[0]}, "it needs a head such as 'time [ms],force [N],tilt [deg]', with columns"),
        ({"table": ""}, "the file is empty; write a head such as 'time [ms],force [N],tilt [deg]', and rows below"),
        ({"table": TABLE.replace("force", "F")}, "'roll.csv' has no column 'force'"),
        ({"table": TABLE.replace("tilt", "tile")}, "'roll.csv', column tile: a profile has time, force and tilt alone"),
        ({"table": TABLE.replace("[N]", "[mm]")}, "'roll.csv', row 2, column force: "),
        ({"table": TABLE.replace("[deg]", "[N]")}, "'roll.csv', row 2, column tilt: "),
        ({"table": TABLE.replace("900", "")}, "'roll.csv', row 3, column force: the cell is empty"),
        ({"table": TABLE.replace("900", "0,9")}, "'roll.csv', row 3: it has 4 values for 3 columns"),
        ({"table": TABLE.replace("900", "-900")}, "'roll.csv', row 3, column force: it pulls, but a load line pushes"),
        ({"table": TABLE.replace("-15", "90")}, "'roll.csv', row 3, column tilt: the line would lie across"),
        ({"table": TABLE.replace("300", "100")}, "'roll.csv', row 4, column time: 100 does not come after 100"),
        ({"table": TABLE.replace("900", "0").replace("600", "0")}, "'roll.csv': all its forces are 0"),
        (
            {"table": TABLE + "".join(f"{k},1,0\n" for k in range(301, 1300))},
            "'roll.csv' has 1002 rows, each of which is",
        ),
        ({"stated": "none.csv"}, "there is no such file"),
        ({"tilts_about": None}, "level.tests.roll: the load line is tilted, but not said about which point it turns"),
        ({"steps": [{"profile": "roll.csv", "force": "5 N"}]}, "steps.0: a step is of a force or of a profile"),
        ({"steps": [{"profile": "roll.csv", "duration": "5 s"}]}, "steps.0: duration is that of a force"),
        ({"steps": [{"profile": "roll.csv", "least": "5 N", "cycles": 5}]}, "steps.0: least is that of a force"),
        ({"steps": [{"profile": "roll.csv", "scale": 0.0}]}, "steps.0.scale (it is 0.0): it must be greater than 0"),
        (
            {"steps": [{"profile": "roll.csv", "scale": 1e18}]},
            "steps.0: profile: 'roll.csv', row 3, column force: with its scale it is 9e+20 N; correct scale or",
        ),
        (
            {"tilts_about": {"forward": "1e19 mm", "outward": "0 mm", "up": "0 mm"}, "table": FIRST_TILTED},
            "level.tests.roll, row 2: load_lines.0: from and to are the same point",
        ),
        (
            {"lasts": False, "elastic": True},
            "level.tests.roll: a step has cycles, but that they are borne is not asked",
        ),
    ],
)
def test_what_a_profile_must_not_be_is_one_sentence(changes, sentence, tmp_path):
    with pytest.raises(CaseError) as caught:
        rolled(tmp_path, **changes)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("level.tests.roll")
    assert "\n" not in str(caught.value)


def test_the_file_of_a_profile_goes_with_its_case(tmp_path):
    """A level file names it plainly; a case written elsewhere finds it, and results tell its digest."""
    (tmp_path / "roll.csv").write_text(TABLE, encoding="utf-8")
    written(tmp_path, LEVEL | {"tests": {"roll": ROLL}})
    case = read_case(str(tmp_path / "case.toml"))
    assert set(case.files) == {"level.toml", "roll.csv"}
    (tmp_path / "other").mkdir()
    for number, source in enumerate(("case.toml", "other/copy0.toml")):
        copy = tmp_path / "other" / f"copy{number}.toml"
        StatedCase.read(tmp_path / source).to_toml(copy)
        assert read_case(str(copy)).level.tests["roll"].states == case.level.tests["roll"].states
    written(tmp_path, LEVEL | {"tests": {"roll": ROLL | {"steps": [{"profile": "../roll.csv", "cycles": 1}]}}})
    with pytest.raises(CaseError, match=r"tests\.roll\.steps\.0\.profile: '\.\./roll\.csv' must be the plain name"):
        read_case(str(tmp_path / "case.toml"))


def test_forces_of_a_profile_may_be_shares_of_the_body_weight(tmp_path):
    (tmp_path / "roll.csv").write_text(TABLE.replace("[N]", "[body_weight]").replace("900", "1.2"), encoding="utf-8")
    stated = pylon(level={"tests": {"roll": ROLL}}, body_mass="100 kg")
    assert validate(stated, str(tmp_path)).level.tests["roll"].states[1].force == pytest.approx(1.2 * 980.665)
    del stated["body_mass"]
    with pytest.raises(CaseError, match="row 2, column force: no body is stated"):
        validate(stated, str(tmp_path))


def test_a_level_without_a_motion_says_which_command_goes_over_its_tests():
    with pytest.raises(CaseError, match=r"^motion: .*; tests of its level stand in the pose: alula check goes over"):
        _ = validate(pylon(level={"test": "cyclic"})).motion_coordinate


def test_a_redundant_structure_under_a_profile_says_what_to_do(tmp_path):
    (tmp_path / "roll.csv").write_text(TABLE, encoding="utf-8")
    stated = pylon(level={"tests": {"roll": ROLL}, "test": "roll"})
    stated["links"]["foot"]["points"]["T"] = ["0 mm", "380 mm"]
    stated["links"]["pylon"]["points"]["M"] = ["150 mm", "0 mm"]
    stated["joints"]["T"] = {"links": ["foot", "pylon"], "pin_diameter": "4 mm"}
    stated["level"]["enters"] = {"link": "pylon", "at": "M"}
    with pytest.raises(CaseError, match=r"redundant.*; take a constraint away, or state the cycles as a step with"):
        solve_case_motion(over_states(validate(stated, str(tmp_path))))
