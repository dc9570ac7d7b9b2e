"""``alula new --from-step``: a case that runs, from the bores of a part; and what ``alula inspect`` writes, pasted."""

import tomllib
from dataclasses import replace
from pathlib import Path

import programs
import pytest
import step_files
from imported_case import STEP

from alula.fea.check.run import check_case, effort_of
from alula.fea.common.verdict import Verdict
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.exchange.part import part_case, part_entries
from alula.reports.figures.drawings import _Drawing
from alula.reports.tools.part import inspect_file

LIGHT = ["load_cases.load.own_weight=false"]


@pytest.fixture(scope="module")
def plates(tmp_path_factory):
    return step_files.write(tmp_path_factory.mktemp("plates"))


def written(file: Path, folder: Path, *changes: str):
    """Write the case of a part to a folder and read it."""
    path = folder / "case.toml"
    path.write_text(part_case(inspect_file(file, None), path), encoding="utf-8")
    return read_case(str(path), [*LIGHT, *changes])


def held(case):
    """Joint forces and drive torque of the only load case."""
    [one] = solve_case_statics(case, "case").reactions.values()
    return one


@pytest.mark.parametrize(
    ("file", "arm"), [("plate", 40.0), ("lever", 60.0), ("arm", 52.0), ("bracket", 4500.0**0.5), ("sleeve", 15.0)]
)
def test_a_drive_holds_a_part_of_one_two_or_four_bores_against_10_newtons_across_it(file, arm, plates, tmp_path):
    """Of one bore the force acts at the far end: 52 mm from that of the arm, whose axis is none of its file."""
    case = written(plates / f"{file}.step" if file in step_files.PLATES else STEP / f"{file}.step", tmp_path)
    assert held(case).drive_torque == pytest.approx(10.0 * arm, rel=1e-6)
    assert case.joints["A"].pin_diameter == pytest.approx({"arm": 6.0, "sleeve": 10.0}.get(file, 5.0))


@pytest.mark.parametrize(("file", "arms"), [("bell_crank", (40.0, 30.0)), ("rocker", (40.0, 20.0))])
def test_a_rod_pulls_at_the_short_arm_of_a_part_with_three_bores(file, arms, plates, tmp_path):
    """The pivot is the bore opposite the longest side; moments about it give the rod's pull. No drive is needed."""
    case = written(plates / f"{file}.step" if file in step_files.PLATES else STEP / f"{file}.step", tmp_path)
    found, [pull] = held(case), case.load_cases["load"].forces
    tied = next(name for name in "AB" if name != pull.at)
    rod = complex(*found.joints[tied].force[:2])  # of the rod on the part
    assert case.drive is None
    assert abs(rod) == pytest.approx(10.0 * arms[0] / arms[1], rel=1e-6)
    pose = case.solve_pose()
    way = complex(*pose.points["R"]) - complex(*pose.points[tied])
    assert (rod / way).real > 0.0
    assert (rod / way).imag == pytest.approx(0.0, abs=1e-9)


def test_the_weight_of_the_part_pulls_down(plates, tmp_path):
    """60 x 16 x 5 mm of aluminium (2700 kg/m³); the bore of 6 mm is about the pin, and takes nothing of the moment."""
    case = written(plates / "arm.step", tmp_path, "load_cases.load.own_weight=true")
    assert held(case).drive_torque == pytest.approx(520.0 + 60.0 * 16.0 * 5.0 * 2.70e-9 * 9806.65 * 22.0, abs=2e-3)


def test_the_file_says_what_was_guessed_and_where_its_part_is_and_is_not_overwritten(tmp_path):
    (tmp_path / "cad").mkdir()
    part, case = tmp_path / "cad" / "plate.step", tmp_path / "own" / "plate.toml"
    case.parent.mkdir()
    part.write_bytes((STEP / "plate.step").read_bytes())
    done = programs.inside("new", "--from-step", str(part), str(case))
    assert (done.returncode, "marked GUESS" in done.stdout) == (0, True)
    text = case.read_text(encoding="utf-8")
    guesses = {line.partition("=")[0].split("#")[0].strip() for line in text.splitlines() if "GUESS:" in line}
    assert guesses == {"material", "points.A", "points.B", "angle", "[drive]", "force", "maximum"}
    assert tomllib.loads(text)["parts"]["plate"]["file"] == "../cad/plate.step"
    again = programs.inside("new", "--from-step", str(part), str(case))
    assert (again.returncode, case.read_text(encoding="utf-8")) == (2, text)


def test_the_path_of_the_part_holds_where_a_folder_is_a_link_to_another_place(tmp_path):
    (tmp_path / "deep" / "er").mkdir(parents=True)
    (tmp_path / "short").symlink_to(tmp_path / "deep" / "er", target_is_directory=True)
    (tmp_path / "plate.step").write_bytes((STEP / "plate.step").read_bytes())
    case = written(tmp_path / "plate.step", tmp_path / "short")
    assert Path(case.parts["plate"].file).resolve() == tmp_path.resolve() / "plate.step"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["block.step"], ["'block.step': no round bore was found", "the bore of its pivot in the CAD program"]),
        ([STEP / "two_solids.step"], ["holds 2 solids", "export each part to a file of its own"]),
        (["none.step"], ["there is no file", "name an existing STEP file"]),
        (["scan.stl"], ["is no STEP file", "export the part as STEP"]),
        (["arm.step", "--unit", "in"], ["--unit", "a STEP file states its own unit"]),
        (["arm.step", "--from", "step"], ["--from-step", "keep one of them"]),
    ],
)
def test_what_makes_no_case_ends_in_one_sentence(arguments, words, plates):
    (plates / "scan.stl").write_text("solid scan")
    done = programs.inside("new", "--from-step", *map(str, arguments), "own.toml", folder=plates)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert all(word in done.stderr for word in words)
    assert not (plates / "own.toml").exists()


@pytest.mark.parametrize(("name", "pin"), [("plate", "A"), ("bell_crank", "C"), ("sleeve", "A")])
def test_the_entries_of_inspect_need_only_a_ground_a_joint_and_a_drive(name, pin):
    found = inspect_file(STEP / f"{name}.step", None)
    tables = tomllib.loads(part_entries(found))
    diameter = next(bore.diameter for bore in found.facts.bores if bore.name == tables["parts"][name]["bores"][pin])
    tables["links"]["base"] = {"ground": True, "points": {pin: ["0 mm", "0 mm"]}}
    case = validate(
        {
            "schema_version": 1,
            "title": "pasted",
            **tables,
            "joints": {pin: {"links": ["base", name], "pin_diameter": f"{diameter} mm"}},
            "pose": {"coordinate": name, "angle": "0 deg"},
            "drive": {"link": name, "joint": pin},
            "load_cases": {"turn": {"moments": [{"link": name, "at": pin, "moment": "1 N*mm"}]}},
        },
        str(STEP),
    )
    assert {pin.name for pin in case.body(name).pins} >= set(tables["parts"][name]["bores"])


def test_a_mesh_with_one_bore_cannot_bear_a_load_beside_it(plates):
    found = inspect_file(plates / "arm.step", None)
    with pytest.raises(CaseError, match=r"it is a mesh, .* it has one bore; give the part as a STEP file"):
        part_case(replace(found, unit="mm"), plates / "own.toml")


def test_a_verdict_comes_at_once_with_a_picture_of_the_whole_part(tmp_path):
    """A plate of 60 by 20 by 5 mm whose points are the middles of its bores, 40 mm apart; it bends as a beam does."""
    case = written(STEP / "plate.step", tmp_path, "solid.mesh_size=2")
    result = check_case(case, effort=effort_of(case, None, max_unknowns=600_000, time_limit=0.0))
    checks = result.load_cases["load"].checks
    assert {check.verdict for check in checks} == {Verdict.PASS}
    assert next(check for check in checks if check.name == "collapse").value.least_alone  # no path, which takes time
    peak = result.load_cases["load"].links["plate"].stress.peak
    assert peak.value == pytest.approx(10.0 * (40.0 - peak.location[0]) * 10.0 / (5.0 * 20.0**3 / 12.0), rel=0.1)
    axes = _Drawing(result, "load").axes
    for corner in axes.at([(-10.0, -10.0), (50.0, 10.0)]):
        assert (axes.box[:2] < corner).all()
        assert (corner < axes.box[2:]).all()
