"""Under loads that the linkage gives way to no solid is solved, unless solids are asked for."""

import tomllib

import pytest

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.loads.case.case_file import validate
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
