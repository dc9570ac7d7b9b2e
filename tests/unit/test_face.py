"""``alula``: what a script and a notebook call, and its docstrings' examples."""

import doctest
import importlib
import io
import shutil
import subprocess
import sys
import tomllib
from concurrent.futures import Future
from contextlib import nullcontext

import numpy as np
import programs
import pytest
from PIL import Image

import alula
from alula.fea.common.verdict import Verdict
from alula.fea.study.engine import Engine
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, read_text, validate

OWL = "owl-wing-static"
TUBE = "parts.tube.outer_diameter"


@pytest.mark.parametrize(
    "module",
    [
        "alula",
        "alula.loads.text.revisable",
        "alula.reports.notebook.claims_report",
        "alula.reports.notebook.motion_report",
    ],
)
def test_examples_of_docstrings(module):
    found = doctest.testmod(importlib.import_module(module))
    assert found.attempted > 0
    assert found.failed == 0


@pytest.mark.parametrize("room", ["geometry", "loads", "fea", "reports"])
def test_a_bare_room_is_not_imported_and_no_module_is_loaded_twice(room):
    with pytest.raises(ImportError, match=f"is alula.{room}"):
        importlib.import_module(room)
    assert not [name for name in sys.modules if name.partition(".")[0] == room]


def test_the_version_is_that_of_the_project():
    stated = tomllib.loads((programs.ROOT / "pyproject.toml").read_text())["project"]["version"]
    run = [sys.executable, "-m", "alula"]
    told = subprocess.run([*run, "--version"], env=programs.environment(), capture_output=True, text=True, check=True)
    assert (alula.__version__, told.stdout) == (stated, f"alula {stated}\n")


def test_all_that_is_offered_is_there():
    assert all(callable(getattr(alula, name)) for name in alula.__all__)
    assert OWL in alula.cases()


@pytest.mark.parametrize("name", [OWL, "copy.toml"])
def test_values_mean_what_they_mean_to_the_command(name, tmp_path):
    if name.endswith(".toml"):
        name = tmp_path / name
        name.write_text(read_text(OWL)[0], encoding="utf-8")
    case = alula.read_case(name)
    before = case.linkage
    changed = case.with_values({TUBE: "6 mm", "links.AE.points.E.0": "191 mm", "solid.mesh_size": 0.9})
    expected = ["parts.tube.outer_diameter=6 mm", "links.AE.points.E.0=191 mm", "solid.mesh_size=0.9"]
    assert changed == read_case(str(name), expected) == alula.read_case(name, {**dict(e.split("=") for e in expected)})
    assert changed.linkage.links["AE"].points["E"][0] == pytest.approx(191.0)
    assert case == read_case(str(name))
    assert case != changed
    assert case.linkage is before
    assert changed.origin == case.origin == str(name)


def test_changes_add_up():
    case = alula.read_case(OWL)
    once = case.with_values({TUBE: "6 mm"})
    assert once.with_values({"title": "thick"}) == case.with_values({"title": "thick", TUBE: "6 mm"})
    assert once.with_values({TUBE: "5 mm"}) == case


def test_rules_of_a_mechanism_are_applied_anew():
    """Dimensions follow from the ornithopter's angle; what is stated outright wins, also over a later change."""
    case = alula.read_case("ornithopter")
    changed = case.with_values({"ornithopter.wing_angle": "30 deg"})
    assert changed == read_case("ornithopter", ["ornithopter.wing_angle=30 deg"])
    assert changed.links != case.links


def test_a_list_stays_the_callers():
    point = ["125 mm", "0 mm"]
    changed = alula.read_case(OWL).with_values({"links.AE.points.B": point, "links.AE.points.B.0": "120 mm"})
    assert changed.links["AE"].points["B"] == pytest.approx((120.0, 0.0))
    assert point == ["125 mm", "0 mm"]


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"parts.tub.outer_diameter": "6 mm"}, "with_values parts.tub.outer_diameter: .* did you mean 'tube'"),
        ({"parts.tube.outer_diametr": "6 mm"}, "did you mean 'outer_diameter'"),
        ({"links.XY.part": "tube"}, "'links' has no 'XY' to change"),
        ({TUBE: 6.0}, "unit"),
        ({TUBE: "6 N"}, "outer_diameter"),
        ({"parts..tube": 1}, "with_values 'parts..tube'"),
        ({"links.AE.points.B.7": "1 mm"}, "does not name one of the 2 entries"),
    ],
)
def test_wrong_values_are_told_in_a_sentence(values, told):
    with pytest.raises(CaseError, match=told):
        alula.read_case(OWL).with_values(values)


def test_only_what_was_read_can_be_read_once_more():
    built = validate(tomllib.loads(read_text(OWL)[0]))
    read = read_case(OWL)
    assert built == read  # where a case comes from makes no difference to what it states
    assert built.origin == ""
    for case in (built, read.model_copy(update={"title": "other"})):
        with pytest.raises(CaseError, match="start from a case that read_case returned"):
            case.with_values({TUBE: "6 mm"})


def test_a_copy_with_other_links_has_their_linkage():
    case = read_case(OWL)
    assert "J" not in case.linkage.links["AE"].points
    link = case.links["AE"]
    longer = link.model_copy(update={"points": {**link.points, "J": (10.0, 0.0)}})
    changed = case.model_copy(update={"links": {**case.links, "AE": longer}})
    assert "J" in changed.linkage.links["AE"].points
    assert "J" not in case.linkage.links["AE"].points


def test_a_case_of_a_file_finds_the_files_beside_it(tmp_path):
    folder = programs.ROOT / "loads" / "cases"
    for file in (f"{OWL}.toml", "owl-wing-statics-exact.csv", "owl-wing-statics-printed.csv"):
        shutil.copy(folder / file, tmp_path)
    case = alula.read_case(tmp_path / f"{OWL}.toml").with_values({"title": "mine"})
    assert alula.check(case, fidelity="beam").result.audit is not None


def test_options_are_those_of_the_command():
    with pytest.raises(CaseError, match="fidelity: 'bem' is unknown"):
        alula.check(OWL, fidelity="bem")
    with pytest.raises(CaseError, match="accuracy"):
        alula.check(OWL, accuracy="5 mm")
    with pytest.raises(CaseError, match="add \\[motion\\]"):
        alula.motion("owl-wing-closed")
    with pytest.raises(CaseError, match="there is no such file or built-in case"):
        alula.check("owl-wing")


def test_a_study_is_kept_and_shown(tmp_path):
    report = alula.study("four-bar-synthesis", {"motion.poses": (3, 5)}, tmp_path / "s", analysis="motion", threads=1)
    assert [row["motion.poses"] for row in report.table()] == ["3", "5"]
    assert dict(report.counts) == {"pass": 2}  # of the clearance between its layers
    assert "<table>" in report._repr_html_()
    assert alula.study("four-bar-synthesis", {"motion.poses": "3, 5"}, tmp_path / "s", analysis="motion") == report


def test_a_size_is_found_and_told(monkeypatch):
    """By a rule in place of checks: 6 mm is the least that passes, and of a choice the lightest."""

    def submit(task):
        diameter = float(task.tables["parts"]["tube"]["outer_diameter"].split()[0])
        verdict = Verdict.PASS if diameter >= 6.0 else Verdict.FAIL
        told = {"subject": "AE", "low": diameter / 6.0, "high": diameter / 6.0, "value": diameter / 6.0}
        factor = VariantNumber(check="strength", quantity="safety factor", unit="1", limit=1.0, verdict=verdict, **told)
        future = Future()
        future.set_result(
            VariantResult(
                state="done", verdict=verdict, numbers=(factor, VariantNumber.exact("mass", "g", diameter, "the links"))
            )
        )
        return future

    engine = Engine(submit=submit, capacity=lambda: 4)
    monkeypatch.setattr("alula.fea.study.compute.engine_for", lambda *_, **__: nullcontext(engine))
    found = alula.size(OWL, {TUBE: "4 mm..8 mm"}, step="1 mm", fidelity="beam")
    assert (found.passing, found.failing) == ({TUBE: "6 mm"}, {TUBE: "5 mm"})
    rows = {row[TUBE]: row for row in found.table()}
    assert rows["5 mm"]["verdict"] == "fail"
    assert rows["5 mm"]["margin"] == pytest.approx(5.0 / 6.0)
    assert str(found).startswith(f"Least {TUBE} that passes: 6 mm.\nThe greatest that fails: 5 mm.")
    assert "6 mm" in repr(found)
    best = alula.size(OWL, choose={TUBE: "7 mm, 6 mm, 5 mm"}, fidelity="beam")
    assert best.passing == {TUBE: "6 mm"}
    assert best.failing is None
    assert "Least mass that passes: 6.000 g" in str(best)
    assert {row[TUBE]: row["verdict"] for row in best.table()}.items() >= {"6 mm": "pass"}.items()
    with pytest.raises(CaseError, match="nothing varies"):
        alula.size(OWL)


def test_inspect_says_what_the_command_says_of_a_file():
    found = alula.inspect(programs.ROOT / "loads" / "cases" / "bell-crank.step", material="aluminium-6061-t6")
    assert [row["diameter [mm]"] for row in found.table()] == pytest.approx([5.0, 4.0, 4.0])
    assert found.mass == pytest.approx(found.volume * 2.7e-3)
    assert tomllib.loads(found.entries)["parts"]["bell-crank"]["shape"] == "step"
    with pytest.raises(CaseError, match="there is no material"):
        alula.inspect("none.step", material="cheese")


def test_synthesise_shows_what_the_command_finds():
    found = alula.synthesise([("26 deg", "60 deg"), ("19 deg", "71 deg"), ("20 deg", "92 deg")], "100 mm")
    assert [row["psi, of c [deg]"] for row in found.table()] == pytest.approx([60.0, 71.0, 92.0])
    with Image.open(io.BytesIO(found.plot_linkage().png)) as picture:
        pixels = np.asarray(picture.convert("L"))
    assert (pixels[:, [0, -1]] == 255).all()  # nothing is cut at the sides: the labels of y were
    assert any("Grashof" in finding for finding in found.findings)
