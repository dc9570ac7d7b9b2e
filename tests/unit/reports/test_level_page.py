"""``level.html``: what all numbers stand on, the set-up, test by test, signatures, and of which files."""

import json
import re
from html import unescape

import numpy as np
import pytest
from levels import CYCLIC, PROOF, pylon
from told import ends_of, flat, numbers_of, values_of

from alula.fea.check.level import check_level
from alula.loads.compose.stated_case import StatedCase
from alula.reports.figures.set_up import set_up_drawing
from alula.reports.level.page import level_page, level_sections
from alula.reports.level.tests import level_record
from alula.reports.renderers.page import as_page
from alula.reports.renderers.record import as_json
from alula.reports.sections.section import Table, Text, parts_of

TESTS = {"proof": PROOF, "cyclic": CYCLIC | {"source": "invented as well"}}


def checked(level=None, **changes):
    return check_level(
        StatedCase.from_dict(pylon(level={"tests": TESTS, **(level or {})}, **changes)).record, fidelity="beam"
    )


@pytest.fixture(scope="module")
def result():
    return checked()


@pytest.fixture(scope="module")
def words(result):
    page = as_page(level_page(result, level_sections(result)))
    return flat(unescape(re.sub("<[^>]+>", " ", page.partition("</style>")[2])))


def test_every_number_of_the_page_stands_in_result_json(result, words):
    sections = level_sections(result)
    known = {f"{x:.9g}" for x in values_of(json.loads(as_json(level_record(result, sections))))}
    seen = [
        number
        for section in sections[1:]
        for part in parts_of(section.parts)
        if isinstance(part, Text | Table)
        for number in numbers_of([part])
    ]
    assert len(seen) > 25
    for number in seen:
        assert flat(number.figures) in words
        assert number.derived or all(f"{end:.9g}" in known for end in ends_of(number)), number


def test_what_the_numbers_stand_on_comes_first_and_says_of_which_test_it_is(words):
    """A proof test is a static load; of the cyclic one fatigue was looked at. Each test has its source."""
    titles = "What all numbers stand on", "Materials Alu", "Set-up Load", "Test by test", "Signatures", "Made with what"
    places = [words.rindex(title) for title in titles]
    assert places == sorted(places)
    first = words[places[0] : places[1]]
    for text in (
        "Assumed Rigid lever between load lines and T of pylon.",
        "Not checked Sockets and soft parts at T of pylon (they are not modelled).",
        "No joint states friction.",
        "Fatigue (proof) The loads are static.",
        "Fatigue (cyclic) Links that a check names were checked",
        "Assumed (proof) Steps of 200 N",
    ):
        assert text in first
    materials = words[places[1] : places[2]]
    assert "fatigue strength, 5e+08 cycles of stress ratio −1 96.5 MPa not stated Aluminum Association" in materials
    assert "Scatter of the fatigue strength of aluminium-6061-t6 (no strength_range" in first
    tests = words[places[3] : places[4]]
    assert "Source of its numbers: invented round numbers, of no standard." in tests
    assert "Source of its numbers: invented as well." in tests


def test_numbers_lead_into_the_report_of_their_test(result):
    html = as_page(level_page(result, level_sections(result)))
    assert set(re.findall(r'href="(tests/[^"]+)"', html)) == {
        "tests/proof/report.html#link-pylon",
        "tests/cyclic/report.html#link-pylon",
    }


def test_a_set_up_that_is_turned_and_shifted_is_drawn_alike(result):
    """By -90° and (7, 5, 3) mm, with the axes of the standard."""
    turned = pylon()
    turned["links"]["foot"]["points"]["O"] = ["87 mm", "5 mm"]
    turned["joints"]["O"]["angle"] = "0 deg"
    placed = {"forward": "-y", "up": "+x", "origin": ["7 mm", "5 mm", "0 mm"]}
    other = checked(placed, links=turned["links"], joints=turned["joints"])
    marks, alike = (set_up_drawing(one).marks for one in (result, other))
    assert len(marks) == len(alike) > 30
    for mark, its in zip(marks, alike, strict=True):
        np.testing.assert_allclose(its.points, mark.points, atol=1e-6)
    lines = [mark.points for mark in marks if getattr(mark, "width", 0.0) == 1.6 and len(mark.points) == 2]
    across, up = np.ptp(np.array(lines[0]), axis=0)
    assert across / up == pytest.approx((50.0 + 40.0) / 400.0)  # seen from the side, of the proof test
