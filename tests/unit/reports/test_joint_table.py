"""The joints' forces in the report: plain in the plane, with Fz and moments where loads leave it; and what weighs."""

import html
import json
import re

import pytest
import solved
from edited_cases import PLANAR, edited
from told import render
from typer.testing import CliRunner

from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import read_case
from alula.reports.check.statics import weight_sentence
from alula.reports.sections.reactions import shown_components

WING, FLIGHT = "owl-wing-static", "owl-wing-flight"
BONDED = 'joint_model="bonded"'


def statics_section(name, *overrides):
    result = solved.by_hand(name, *overrides)
    page = render(result, {})
    start = page.index('<section id="statics">')
    text = re.sub(r"<[^>]+>", " ", page[start : page.index("</section>", start)])
    return result, re.sub(r"\s+", " ", html.unescape(text))


@pytest.mark.parametrize(
    ("name", "overrides", "load_case", "components"),
    [
        (WING, [PLANAR], "weight", "Fx Fy"),
        (WING, [PLANAR, BONDED], "weight", "Fx Fy Mz"),
        (FLIGHT, [PLANAR], "planform", "Fx Fy Fz Mx My"),
        (FLIGHT, [PLANAR, BONDED], "complete", "Fx Fy Fz Mx My Mz"),
    ],
)
def test_components_are_those_that_act(name, overrides, load_case, components):
    case = edited(name, overrides, fits=BONDED not in overrides)  # a bonded joint has no play
    reactions = solve_case_statics(case, name).reactions[load_case]
    assert " ".join(shown_components(reactions)) == components


def test_the_table_of_a_plane_case_stays_plain():
    _, words = statics_section(WING, PLANAR)
    head = "Joint forces, global axes Joint by → on F x [N] F y [N] Size [N] "
    assert f"{head}A AG → AE 0.5011 0.8095 0.9520" in words
    assert "The links are massless in this load case" in words


def test_the_table_out_of_the_plane_holds_the_whole_wrench():
    result, words = statics_section(FLIGHT, PLANAR)
    assert "Joint forces and moments about the joint, global axes Joint by → on" in words
    assert "F x [N] F y [N] F z [N] Size [N] M x [N·mm] M y [N·mm]" in words
    wrench = result.load_cases["as-published"].reactions.joints["A"].wrench
    assert wrench[2] == pytest.approx(-0.1393, abs=5e-5)
    assert "A AG → AE 0.5011 0.8095 −0.1393 0.9621 −7.660 −21.85" in words
    assert "CF carries 13.9 g spread from F to C and CH carries 11.58 g spread from C to H" in words


def test_the_terminal_and_its_json_hold_them_too():
    from alula.reports.commands.cli import app

    shown = CliRunner().invoke(app, ["statics", FLIGHT, "--set", PLANAR]).output
    assert "A AG → AE 0.5011 0.8095 −0.1393 0.9621 −7.660 −21.85 " in " ".join(shown.split())
    found = json.loads(CliRunner().invoke(app, ["statics", FLIGHT, "--set", PLANAR, "--json"]).output)
    assert found["load_cases"]["as-published"]["reactions"][0]["wrench"][4] == pytest.approx(-21.85, abs=5e-3)


def test_a_millionth_of_the_load_keeps_its_digits():
    """Forces were once printed with four decimals and torques with two, so that small mechanisms read zero."""
    from alula.reports.commands.cli import app

    small = 'load_cases.weight.forces=[{link="CH", at="H", force=["0 N", "-2.5e-7 N"]}]'
    shown = " ".join(CliRunner().invoke(app, ["statics", WING, "--set", small, "--set", PLANAR]).output.split())
    assert "Drive torque on AE about A: −0.0001306 N·mm" in shown
    assert "A AG → AE 5.011·10⁻⁷ 8.095·10⁻⁷ 9.520·10⁻⁷" in shown


def test_what_weighs_is_said():
    flapping = read_case("flapping-wing-chosen")
    assert "; crank turns at 180 rpm" in weight_sentence(flapping, "flapping")
    assert weight_sentence(flapping, "held").startswith(
        "The links have weight from volume and density of their parts; "
    )
    assert "left out" in weight_sentence(read_case("ornithopter"), "slow")
    bare = read_case("four-bar-synthesis", ["carried=[]"])
    stated = bare.model_copy(update={"massless": ("b", "c")})
    assert weight_sentence(stated, "weight").endswith("; b and c are massless")
