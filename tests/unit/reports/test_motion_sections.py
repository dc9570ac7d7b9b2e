"""What is told of a motion stands with the same digits on the page, on the console and in ``result.json``."""

import json
import re
from html import unescape

import pytest
import told_motion
from edited_cases import PLANAR, edited
from told import console_parts, ends_of, flat, numbers_of, values_of

import alula
from alula.fea.findings.of_motion import motion_findings
from alula.fea.whole.rubbed_motion import rubbed_motion
from alula.reports.motion.whole_motion import motion_page
from alula.reports.notebook.motion_report import MotionReport
from alula.reports.renderers.page import as_page
from alula.reports.sections.section import Text, parts_of
from alula.reports.sections.table import Table

CASES = (
    ("flapping-wing-chosen", [PLANAR, "motion.poses=4"]),
    ("owl-wing-static", ["motion.poses=3", 'joints.C.clearance="0.1 mm"', "joints.A.friction=0.2"]),
    ("spring-pedal", ["motion.poses=8"]),
    ("slider-crank", ["motion.poses=4"]),
)


@pytest.mark.parametrize(("name", "overrides"), CASES, ids=[case[0] for case in CASES])
def test_every_number_of_a_motion_is_told_alike(name, overrides):
    moved = rubbed_motion(edited(name, overrides, fits=name != "flapping-wing-chosen"))  # the others have play
    sections = told_motion.sections(moved)
    page = as_page(motion_page(motion_findings(moved), sections))
    page = flat(unescape(re.sub("<[^>]+>", " ", page)))
    console = flat(told_motion.printed(moved, width=400).replace("\u00a0", " "))
    known = {f"{value:.9g}" for value in values_of(json.loads(json.dumps(told_motion.record(moved, name))))} | {"0"}
    report, checked = MotionReport(moved), 0
    for section in sections:
        for part in parts_of(section.parts):
            if not isinstance(part, Text | Table):
                continue
            for number in numbers_of([part]):
                if not number.derived:
                    assert all(f"{end:.9g}" in known for end in ends_of(number)), (section.key, number)
            for number in numbers_of([part.shown if isinstance(part, Table) else part]):
                assert flat(number.figures) in page, (section.key, number)
                checked += 1
            if isinstance(part, Table) and part.key:
                assert len(report.table(part.key)) >= len(part.rows)
        for part in console_parts(section.parts):
            if isinstance(part, Text | Table):
                for number in numbers_of([part.shown if isinstance(part, Table) else part]):
                    assert flat(number.figures) in console, (section.key, number)
    assert checked > 20


def test_every_number_of_natural_frequencies_is_in_the_record():
    from alula.reports.renderers.record import as_brief_record
    from alula.reports.sections.frequencies import frequencies_section

    found = alula.frequencies("slider-crank", poses=3, count=2).result
    section = frequencies_section(found)
    known = {f"{value:.9g}" for value in values_of(as_brief_record([section]))} | {"0"}
    numbers = list(numbers_of(section.parts))
    assert len(numbers) > 5
    for number in numbers:
        if not number.derived:
            assert all(f"{end:.9g}" in known for end in ends_of(number)), number
