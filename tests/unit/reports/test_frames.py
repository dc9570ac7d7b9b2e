"""What the report and the record say of frames: models, large displacement, pins, ways to hold."""

import html
import re

import pytest

from fea.check import check_case
from loads.case_file import read_case
from reports.frames import frame_lines, frame_record
from reports.html import render
from reports.record import result_record

WING = "owl-wing-static"


def checked(*overrides):
    return check_case(read_case(WING, list(overrides)), name=WING, fidelity="beam")


def section(result):
    page = render(result, {})
    start = page.index('<section id="displacement">')
    text = re.sub(r"<[^>]+>", " ", page[start : page.index("</section>", start)])
    return re.sub(r"\s+", " ", html.unescape(text))


@pytest.fixture(scope="module")
def wing():
    return checked()


def test_the_wings_page_sets_the_ways_to_hold_it_side_by_side(wing):
    words = section(wing)
    for row in (
        "pinned, held at AE −5.71 −47.53 0.00 47.9",
        "pinned, held at GF −1.44 −4.75 0.00 4.97",
        "bonded, A, G built in −0.96 −3.59 0.00 3.72",
        "published: Paredes (2018), table 14: finite elements, A and G fixed 2",
    ):
        assert row in words
    assert "its equilibrium ends at 0.203 of it" in words
    assert "are those of the undeformed pose" in words
    assert "A steel-wire 1.5 7 6.66 (3.33 to 6.66) 20.1 (10.1 to 20.1) 0.718" in words


def test_the_record_keeps_both_shapes():
    result = checked('drive.link="GF"', 'drive.joint="G"', 'load_cases.weight.forces.0.force=["0 N","-1.5 N"]')
    record = result_record(result)
    found = record["load_cases"]["weight"]
    assert found["large_displacement"]["state"] == "deformed"
    undeformed = {r["joint"]: r["magnitude"] for r in record["reactions"]}
    deformed = {r["joint"]: r["magnitude"] for r in found["large_displacement"]["reactions"]}
    assert undeformed.keys() == deformed.keys() == set("ABCDEFG")
    assert undeformed["D"] == pytest.approx(6.0 * 0.3730, abs=1e-3)
    assert deformed["D"] == pytest.approx(2.5769, abs=5e-4)
    assert undeformed["D"] != pytest.approx(deformed["D"], rel=0.05)
    words = section(result)
    assert "Joint forces [N] in the undeformed pose and on the deformed shape" in words
    assert "D 2.238 2.577" in words
    lines = frame_lines(result, result.load_cases["weight"])
    assert any("D 2.577" in line for line in lines)


def test_forces_out_of_the_plane_name_their_model():
    result = checked('load_cases.weight.forces.0.force=["0 N","0 N","0.001 N"]')
    case = result.load_cases["weight"]
    record = frame_record(case)
    assert record["joint_forces"]["model"].startswith("spatial frame")
    wrench = next(r["wrench"] for r in result_record(result)["reactions"] if r["joint"] == "A")
    assert wrench[2] != 0.0
    assert wrench[3] != 0.0
    assert any("spatial frame" in line for line in frame_lines(result, case))
    assert "Joint forces by a spatial frame" in section(result)
    assert sum("spatial frame" in warning for warning in result.warnings) == 1


def test_conditions_stand_in_the_record():
    result = checked(
        'parts.tube.material="pvc-u"', 'conditions={duration="1 day",temperature="30 degC"}', 'large_displacement="off"'
    )
    assert result_record(result)["conditions"] == {"duration": 86400.0, "temperature": pytest.approx(30.0)}
    assert "was not looked into" in section(result)
