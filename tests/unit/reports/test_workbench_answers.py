"""What the workbench answers to a text says the same as commands do, and is plain data."""

import json
import math

import numpy as np
import pytest
import solved

from alula.fea.findings.of_check import with_findings
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import read_case, read_text
from alula.reports.check.changes import change_records
from alula.reports.commands.statics import statics_sections
from alula.reports.sentences.verdicts import first_lines
from alula.reports.workbench.answers import pose_answer
from alula.reports.workbench.verdicts import whole_answer


def posed(name, *pairs):
    text, _ = read_text(name)
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    found = pose_answer(text, name)
    return json.loads(json.dumps(found, allow_nan=False))


@pytest.mark.parametrize("name", ["owl-wing-static", "four-bar", "slider-crank"])
def test_forces_are_those_of_alula_statics(name):
    answer, case = posed(name), read_case(name)
    pose, told = statics_sections(solve_case_statics(case, name), matrix=False)
    assert answer["problem"] is None
    assert list(answer["forces"]) == answer["drawn"]["load_cases"] == list(told.data["load_cases"])
    for load_case, record in told.data["load_cases"].items():
        found = answer["forces"][load_case]
        for one in record["reactions"]:
            joint = found["joints"][one["joint"]]
            assert (joint["force"], joint["on"], joint["magnitude"]) == (one["force"], one["on"], one["magnitude"])
        assert found["drive"]["torque"] == record["drive_torque"]
    for link in answer["drawn"]["links"]:
        assert link["angle"] % 360.0 == pytest.approx(pose.data["pose"]["angles"][link["name"]])


def test_links_are_drawn_as_wide_as_their_parts():
    links = {link["name"]: link for link in posed("four-bar")["drawn"]["links"]}
    outline = np.array(links["crank"]["outline"])
    eye = 1.6 * 8.0 / 2.0
    assert outline.min(axis=0) == pytest.approx([-eye, -eye], abs=0.05)
    assert outline.max(axis=0) == pytest.approx([40.0 + eye, eye], abs=0.05)
    assert (links["crank"]["width"], links["crank"]["thickness"], links["base"]["outline"]) == (8.0, 4.0, None)
    turn, (x, y) = math.radians(links["rocker"]["angle"]), links["rocker"]["origin"]
    end = next(point for point in links["rocker"]["points"] if point["name"] == "P")
    assert end["at"] == pytest.approx([x + 120.0 * math.cos(turn), y + 120.0 * math.sin(turn)])


def test_loads_have_the_path_of_their_entry():
    loads = {load["kind"]: load for load in posed("four-bar")["drawn"]["loads"]}
    assert loads["force"]["path"] == ["load_cases", "lift", "forces", 0]
    assert loads["force"]["vector"] == [0.0, -5.0]
    assert loads["weight"]["vector"][1] < 0.0
    turned = posed("four-bar", ('force = ["0 N", "-5 N"]', 'force = ["0 N", "-5 N"]\naxes = "link"'))["drawn"]
    [force] = [load for load in turned["loads"] if load["kind"] == "force"]
    along = math.radians(next(link["angle"] for link in turned["links"] if link["name"] == "rocker"))
    assert force["vector"] == pytest.approx([5.0 * math.sin(along), -5.0 * math.cos(along)])


def test_what_balances_by_itself_is_drawn_where_it_stands():
    answer = posed("spring-pedal")
    case = read_case("spring-pedal")
    stands = solve_case_statics(case, "spring-pedal").pose
    pedal = next(link for link in answer["drawn"]["links"] if link["name"] == "pedal")
    assert pedal["angle"] == pytest.approx(math.degrees(stands.angles["pedal"]))
    assert pedal["angle"] != pytest.approx(math.degrees(case.stated_pose.angles["pedal"]), abs=0.1)
    assert {spring["kind"] for spring in answer["drawn"]["springs"]} == {"coil", "wall"}


def test_a_problem_is_one_sentence_and_what_can_be_is_drawn():
    open_loop = posed("four-bar", ('points.B = ["120 mm"', 'points.B = ["320 mm"'))
    assert open_loop["problem"].startswith("pose: the linkage cannot be assembled")
    assert open_loop["drawn"] is None
    assert posed("four-bar", ("schema_version = 1", "schema_version ="))["problem"].startswith("this is not valid TOML")
    held = posed("four-bar", ("[drive]\n", "[drive]\ntransfer = 5\n"))
    assert held["problem"].startswith("drive.transfer")


def known(value):
    return value if math.isfinite(value) else None


@pytest.mark.parametrize("name", ["four-bar", "knee"])
def test_the_whole_verdict_is_that_of_alula_check(name):
    result, early = solved.by_hand(name), []
    answer = whole_answer(read_text(name)[0], name, early.append)
    told = with_findings(result)
    assert answer["verdict"] == result.verdict
    assert answer["sentences"] == list(first_lines(told))
    checks = {(one["check"], one["subject"], one["load_case"], one["quantity"]): one for one in answer["checks"]}
    assert len(checks) == sum(len(one.checks) for one in result.load_cases.values())
    for load_case, one in result.load_cases.items():
        for check in one.checks:
            found = checks[check.name, str(check.subject), load_case, check.quantity]
            assert (found["value"], found["low"], found["high"], found["verdict"]) == (
                *map(known, (check.value.value, check.value.low, check.value.high)),
                check.answer,
            )
    [soon] = early
    assert (soon["changes"], soon["checks"], soon["links"]) == ([], answer["checks"], answer["links"])
    assert [one["command"] for one in answer["changes"]][:1] == [one["command"] for one in change_records(told)][:1]
    json.dumps(answer, allow_nan=False)
