"""``docs/result.md`` and what the commands write name the same keys, of the same types."""

import re

import pytest
from bars_in_layers import parallel_bars
from edited_cases import PLANAR
from result_paths import DOCUMENT, compare, documented
from slotted_cases import piston_entries
from told_motion import record as motion_record

from alula.fea.common.source import SourceKind
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.commands.synthesis import PUBLISHED_GROUND, PUBLISHED_POINTS, read_synthesis
from alula.reports.renderers.record import as_brief_record
from alula.reports.tools.synthesis import synthesis_section


def moved(name, *overrides):
    return motion_record(solve_case_motion(read_case(name, overrides)), name)


def test_a_motion():
    wing = moved("flapping-wing-chosen", PLANAR, "motion.poses=3", "load_cases.held.own_weight=false")
    piston = motion_record(solve_case_motion(validate(piston_entries())), "piston")
    rubbed = moved("owl-wing-static", "motion.poses=3", "joints.A.friction=0.2", "motion.instant_centre=CF")
    bars = motion_record(solve_case_motion(parallel_bars()), "bars")
    loose = moved("owl-wing-static", "motion.poses=3", 'joints.C.clearance="0.1 mm"')
    entries = piston_entries()
    entries["joints"]["P"]["clearance"] = "0.1 mm"
    pushed = motion_record(solve_case_motion(validate(entries)), "piston")
    compare("motion", wing, loose, piston, pushed, rubbed, bars)


def synthesised():
    return as_brief_record([synthesis_section(read_synthesis(PUBLISHED_POINTS, PUBLISHED_GROUND))])


def test_a_synthesis():
    compare("synth", synthesised())


def test_every_kind_of_source_is_named():
    told = DOCUMENT.read_text(encoding="utf-8").partition("sources of error: ")[2].partition(". The ends")[0]
    assert re.findall(r"`(\w+)`", told) == [kind.name.lower() for kind in SourceKind]


def test_the_comparison_can_fail():
    record = synthesised()
    with pytest.raises(AssertionError, match="more is not described"):
        compare("synth", record | {"more": 1})
    with pytest.raises(AssertionError, match="described, but in none"):
        compare("synth", {key: value for key, value in record.items() if key != "condition"})
    with pytest.raises(AssertionError, match=r"condition is 'x', described as number"):
        compare("synth", record | {"condition": "x"})
    assert documented("envelope")["checks.value"] == {"band"}
    with pytest.raises(CaseError):
        read_synthesis(PUBLISHED_POINTS[:2], PUBLISHED_GROUND)
