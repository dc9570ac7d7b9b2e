"""``level.html``: what all numbers stand on, the set-up, test by test, signatures, and of which files."""

import json
import re
from html import unescape

import numpy as np
import pytest
from levels import CYCLIC, PROOF, pylon
from told import ends_of, flat, numbers_of, values_of

from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.level import check_level as check_level_module
from alula.fea.level.check_level import check_level
from alula.fea.outcomes.fatigue import LinkFatigue
from alula.fea.refine.refinement import Effort
from alula.geometry.base.errors import CaseError
from alula.loads.compose.stated_case import StatedCase
from alula.reports.figures.set_up import set_up_drawing
from alula.reports.level.page import level_page, level_sections
from alula.reports.level.tests import level_record
from alula.reports.renderers.folder import drawn_pictures
from alula.reports.renderers.page import as_page
from alula.reports.renderers.record import as_json
from alula.reports.sections.section import Table, Text, parts_of
from alula.reports.sentences import told
from alula.reports.words.numbers import number

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
    for one in seen:
        assert flat(one.figures) in words
        assert one.derived or all(f"{end:.9g}" in known for end in ends_of(one)), one


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


def rolled(folder, *names):
    """Tests with profiles, one the other backward, and one of two steps with cycles on a card with an exponent."""
    rows = ["0,-10", "900,-15", "700,5", "0,10"]
    for name, own in (("there", rows), ("back", rows[::-1])):
        table = ["time [ms],force [N],tilt [deg]", *(f"{100 * k},{row}" for k, row in enumerate(own))]
        (folder / f"{name}.csv").write_text("\n".join(table), encoding="utf-8")
    about = {"forward": "0 mm", "outward": "0 mm", "up": "80 mm"}
    tests = {
        name: CYCLIC | {"tilts_about": about, "steps": [{"profile": f"{name}.csv", "cycles": 1e5}], "elastic": True}
        for name in ("there", "back")
    }
    tests["held"] = tests["there"] | {"steps": [*tests["there"]["steps"], {"force": "1 kN"}]}
    tests["two"] = CYCLIC | {"steps": [*CYCLIC["steps"], {"force": "900 N", "cycles": 1e4}]}
    case = pylon(level={"tests": {name: tests[name] for name in names}})
    case["materials"] = {"steel": steel()}
    case["parts"]["tube"]["material"] = "steel"
    return StatedCase.from_dict(case, folder=folder).record


def steel():
    values = "density", "youngs_modulus", "poissons_ratio", "yield_strength", "ultimate_strength"
    return {
        "title": "Some steel",
        "density": "7850 kg/m^3",
        "youngs_modulus": "200 GPa",
        "poissons_ratio": 0.3,
        "yield_strength": "300 MPa",
        "ultimate_strength": "450 MPa",
        "strength": "yield",
        "fatigue": {"stress": "100 MPa", "cycles": 1e6, "exponent": 5.0, "stress_ratio": -1.0, "source": "invented"},
        "sources": dict.fromkeys(values, "invented"),
        "status": dict.fromkeys(values, "assumed"),
    }


def test_the_line_of_a_force_beside_a_profile_is_drawn(tmp_path):
    sheet = set_up_drawing(check_level(rolled(tmp_path, "there", "held"), fidelity="beam"))
    lines = [one.text for one in sheet.texts if "held" in one.text]
    assert lines == ["there, tilted by −15°, held, tilted by −15°", "there, tilted by 5°, held, tilted by 5°", "held"]


def test_the_worst_row_of_a_profile_is_told_wherever_it_stands(tmp_path):
    """By hand its cycles are left open, which says what to do; steps with cycles tell what each does of the harm."""
    result = check_level(rolled(tmp_path, "there", "back", "two"), fidelity="beam")
    rows = {name: [one.decides.load_case for one in test.statements] for name, test in result.tests.items()}
    assert (rows["there"][0], rows["back"][0]) == ("row 3", "row 4")
    page = level_page(result, level_sections(result))
    html = as_page(page, drawn_pictures(page))
    words = flat(unescape(re.sub("<[^>]+>", " ", html.partition("</style>")[2])))
    for text in (
        "safety factor, row 3",
        "safety factor, row 4",
        "without level.test and without --fidelity beam",
        "Step 1: there.csv.",
        "The load line of test back is tilted about an axis along outward through forward 0 mm, up 80 mm.",
        "there, tilted by −15°, back, tilted by −15°",
    ):
        assert text in words
    life = result.tests["two"].result.load_cases["two"].of_links(LinkFatigue)["pylon"].life
    first, second, once = (f"{number(100.0 * share, 3)} %" for share in life.harm)
    assert f"Miner's sum: step 1 {first}; step 2 {second}; the whole test from no load and back, once {once}." in words
    record = json.loads(as_json(level_record(result, level_sections(result))))["level"]["tests"]
    assert record["there"]["steps"][0]["rows"][1] == pytest.approx({"time": 0.1, "force": 900.0, "tilt": -15.0})
    assert record["two"]["harm"] == pytest.approx(list(life.harm))
    assert (record["two"]["cycles"], record["there"]["harm"]) == (1.01e6, [])
    assert record["back"]["offsets"]["tilts_about"]["up"] == 80.0


def test_cycles_over_which_no_stress_can_be_followed_are_left_open(tmp_path, monkeypatch):
    """The rows themselves are judged all the same."""

    def refuse(*_, **__):
        raise CaseError("cycle: the structure is redundant")

    monkeypatch.setattr(check_level_module, "envelope_case", refuse)
    result = check_level(rolled(tmp_path, "there"), effort=Effort(max_unknowns=1000)).tests["there"]
    assert result.verdict is Verdict.UNDECIDED
    elastic, lasts, _ = result.statements
    assert elastic.verdict is Verdict.PASS
    assert [(one.quantity, one.verdict) for one in lasts.outcomes] == [(Quantity.FATIGUE_STRESS, Verdict.UNDECIDED)]
    assert "the structure is redundant" in told(lasts.decides.reason)
