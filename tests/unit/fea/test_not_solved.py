"""No solid is solved under loads that the linkage gives way to, nor where no mesh decides, unless it is asked for."""

import tomllib

import pytest

from alula.fea.check.run import check_case, effort_of
from alula.fea.common.verdict import Verdict
from alula.loads.case.case_file import read_case, validate
from alula.reports.sentences import told

LEVER = """
schema_version = 1
title = "Thin deep lever"
links.base = { ground = true, points = { K = ["0 mm", "0 mm"], K2 = ["0 mm", "50 mm"] } }
links.arm = { part = "bar", points = { K = ["0 mm", "0 mm"], T = ["300 mm", "0 mm"] }, end_patch = "10 mm" }
joints.K = { links = ["base", "arm"], pin_diameter = "6 mm", bonded = true, angle = "0 deg" }
checks.strength.type = "safety-factor"
[parts.bar]
shape = "bar"
material = "aluminium-7075-t6"
width = "30 mm"
thickness = "1 mm"
fillet_radius = "6 mm"
"""
FORCE = '[[load_cases.{name}.forces]]\nlink = "arm"\nat = "T"\nforce = ["0 N", "{force} N"]\n'


class AskedError(Exception):
    """Names of the load cases under which solids were to be solved."""


@pytest.fixture
def asked(monkeypatch):
    """Returns the load cases of the lever under which its solid is asked for; none is solved."""

    def refuse(tasks, *settings, **more):
        if tasks:
            raise AskedError({loads.name for task in tasks.values() for loads in task.loads})
        return {}

    monkeypatch.setattr("alula.fea.links.fidelity.refine_links", refuse)

    def solids(fidelity, **forces):
        stated = [FORCE.format(name=name, force=force) for name, force in forces.items()]
        case = validate(tomllib.loads(LEVER + "".join(stated)), "")
        try:
            result = check_case(case, fidelity=fidelity)
        except AskedError as found:
            return found.args[0]
        assert result.verdict is Verdict.FAIL
        [link] = [one.links["arm"] for one in result.load_cases.values()]
        assert link.decided_by == ""
        assert "--fidelity solid" in told(link.why)
        assert link.next_cost
        return set()

    return solids


def test_what_cannot_change_the_verdict_is_not_solved(asked):
    """A lever that tips over sideways at a sixth of its load: 418,128 elements were solved for minutes all the same.

    Linear theory, E I_y G J as of a strip: F = 4.013 sqrt(E I_y G J)/L² = 9.7 N (Timoshenko and Gere, Theory of
    Elastic Stability, 2nd ed., section 6.3).
    """
    assert asked("auto", down=-60) == set()
    assert asked("solid", down=-60) == {"down"}


def test_what_holds_is_solved_beside_what_does_not(asked):
    assert asked("auto", down=-60, light=-0.1) == {"light"}
    assert asked("auto", light=-0.1) == {"light"}
    assert asked("solid", down=-60, light=-0.1) == {"down", "light"}


@pytest.fixture
def links_asked(monkeypatch):
    """Returns the links of the folded owl wing whose solids are asked for, and the result where there are none."""

    def refuse(tasks, *settings, **more):
        if tasks:
            raise AskedError(set(tasks))
        return {}

    monkeypatch.setattr("alula.fea.links.fidelity.refine_links", refuse)

    def solids(*changes, fidelity="auto", accuracy=None):
        case = read_case("owl-wing-closed", ["checks.strength.minimum=8", *changes])
        try:
            return set(), check_case(case, fidelity=fidelity, effort=effort_of(case, accuracy))
        except AskedError as found:
            return found.args[0], None

    return solids


WIDE = 'load_cases.weight.scatter=["10 %", "1000 %"]'


def test_a_solid_is_solved_where_it_may_decide_and_not_where_the_load_leaves_all_open(links_asked):
    """By hand the safety factor of AE is 3.6 to 65; with 0.1 to 10 times the load all of it is on both sides of 8.

    Followed on its deformed shape the linkage may give way under so much load, which its solids may decide.
    """
    assert links_asked()[0] == {"AE"}
    assert links_asked('load_cases.weight.scatter=["90 %", "110 %"]')[0] == {"AE"}
    asked, result = links_asked(WIDE, 'large_displacement="off"', 'checks.strength.links=["AE"]')
    assert asked == set()
    link = result.load_cases["weight"].links["AE"]
    assert link.decided_by == "beam"
    assert "so its solid was not solved; --fidelity solid solves it" in told(link.why)
    [check] = [one for one in result.load_cases["weight"].checks if one.name == "strength" and one.link == "AE"]
    assert check.verdict is Verdict.UNDECIDED


def test_solids_and_an_accuracy_that_were_asked_for_are_solved_all_the_same(links_asked):
    every = {"GF", "AE", "CF", "CH", "ED"}
    assert links_asked(WIDE, fidelity="solid")[0] == every
    assert links_asked(WIDE, accuracy="5 %")[0] == every
