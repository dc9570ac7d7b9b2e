"""What is rounding in an equilibrium is told as zero: on the console, in the picture, on the page, in tables."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from legible import written
from told import print_result, render

from alula.fea.check.run import check_case
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.study.numbers import of_check
from alula.loads.case.case_file import validate
from alula.loads.statics.rounding import size_of, without_rounding
from alula.reports.commands.statics import statics_sections
from alula.reports.commands.telling import tell
from alula.reports.figures import drawings
from alula.reports.notebook.check_report import CheckReport

FAR = re.compile(r"\d(?:·10⁻1?[¹⁰-⁹]{2}|e-[1-9]\d)")
"""A number of size 1e-10 or less."""


def stained(forces):
    """The joint forces with 1e-16 of their size in the drive's torque and in what the guide bears along itself."""
    reactions = forces.reactions
    guide = replace(reactions.joints["S"], wrench=reactions.joints["S"].wrench + 1.7e-15 * np.eye(6)[0])
    return replace(
        forces,
        reactions=replace(reactions, drive_torque=-1.2e-13, joints={**reactions.joints, "S": guide}),
    )


@pytest.fixture(scope="module")
def straight(slider_text):
    """The slider-crank with crank and rod in one line and the force along it: nothing turns the crank."""
    text = slider_text.replace('"60 deg"', '"180 deg"').replace('rod = "-20 deg"', 'rod = "0 deg"')
    return validate(tomllib.loads(text.replace('["-20 N", "5 N"]', '["-20 N", "0 N"]')))


@pytest.fixture(scope="module")
def checked(straight):
    found = check_case(straight, name="straight", fidelity="beam")
    cases = {name: replace(case, forces=stained(case.forces)) for name, case in found.load_cases.items()}
    return replace(found, load_cases=cases)


def test_without_rounding(checked):
    told = without_rounding(checked.load_cases["push"].reactions)
    assert told.drive_torque == 0.0
    np.testing.assert_array_equal(told.joints["O"].wrench, [20.0, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(told.joints["S"].wrench, np.zeros(6))
    np.testing.assert_array_equal(size_of(told), [20.0] * 3 + [20.0 * 80.0] * 3)


def test_console_and_picture_tell_zero(checked, capsys):
    from rich.console import Console

    print_result(checked, console=Console(width=200))
    text = capsys.readouterr().out
    assert "Drive torque on crank about O: 0 N·mm (none; counter-clockwise is positive)" in text
    assert not FAR.search(text)
    shown = written(drawings._Drawing(checked, "push").draw())
    assert "O: 20.0 N\non crank" in shown
    assert not any("N·mm" in label or label == "drive torque" for label in shown)


def test_page_and_tables_tell_zero(checked, straight, capsys):
    page = re.sub(r"<[^>]+>", "", render(checked, {}).split('<section id="statics">')[1].split("Residual")[0])
    assert "0 N·mm" in page
    assert not FAR.search(page)
    assert [row["size [N]"] for row in CheckReport(checked).table("joints")] == [20.0, 20.0, 20.0, 0.0]
    found = solve_case_statics(straight)
    tell(statics_sections(replace(found, forces={"push": stained(found.forces["push"])}), matrix=False))
    text = capsys.readouterr().out.split("System")[0]
    assert "Drive torque on crank about O: 0 N·mm" in text
    assert re.search(r"^ *S +frame → piston +0 +0 +0 *$", text, flags=re.MULTILINE)


def test_a_study_keeps_zero(checked):
    _, numbers = of_check(checked, weighs=False)
    assert [one.value for one in numbers if one.quantity == "drive torque"] == [0.0]


def test_a_couple_alone_is_no_rounding(slider_text):
    text = slider_text.replace('forces = [{ link = "piston", at = "Q", force = ["-20 N", "5 N"] }]', "")
    text += 'moments = [{ link = "crank", at = "O", moment = "1e-7 N*mm" }]'
    [found] = solve_case_statics(validate(tomllib.loads(text))).reactions.values()
    assert without_rounding(found).drive_torque == pytest.approx(-1e-7, rel=1e-12)


def test_a_study_keeps_the_force_of_a_driven_slider():
    """In N, of either load case; it exerts no torque."""
    press = Path(__file__).parents[3] / "docs" / "examples" / "entries" / "press.toml"
    found = check_case(validate(tomllib.loads(press.read_text(encoding="utf-8"))), name="press", fidelity="frame")
    _, numbers = of_check(found, weighs=False)
    forces = {one.load_case: (one.quantity, one.unit, one.value) for one in numbers if one.subject == "the drive"}
    solved = {name: case.forces.reactions.drive_force for name, case in found.load_cases.items()}
    assert forces == {name: ("drive force", "N", pytest.approx(force)) for name, force in solved.items()}
    assert min(map(abs, solved.values())) > 1.0
