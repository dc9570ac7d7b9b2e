import base64
import re
from dataclasses import replace

import pytest
from html_pages import Page, stands_alone

from fea.common.verdict import Verdict
from reports.page.coverage import not_covered
from reports.page.html import render
from reports.page.pictures import diagram_name, linkage_name, stress_name

PICTURES = {linkage_name("weight"): b"linkage", diagram_name("AE"): b"diagram", stress_name("GF"): b"stress"}


@pytest.fixture(scope="module")
def source(result):
    return render(result, PICTURES)


@pytest.fixture(scope="module")
def page(source):
    return Page(source)


def test_it_loads_nothing_from_elsewhere_and_links_lead_somewhere(page):
    stands_alone(page)


def test_pictures_are_embedded_and_described(page):
    embedded = {
        base64.b64decode(value.removeprefix("data:image/png;base64,"))
        for tag, name, value in page.attributes
        if (tag, name) == ("img", "src")
    }
    assert embedded == set(PICTURES.values())
    assert sum((tag, name) == ("img", "alt") for tag, name, _ in page.attributes) == len(PICTURES)


def test_it_stands_without_pictures(result):
    assert "<img" not in render(result, {})


@pytest.mark.parametrize(
    "words",
    [
        "Pass: all 20 checks keep their limits",
        "safety factor of link AE under load case weight, 3.65",
        "AG → AE 0.5011 0.8095 0.9520",
        "Drive torque on AE about A: −130.6 N·mm (clockwise",
        "condition number",
        "driven link AE 0.0374",
        "228.150°",
        "33.75 N·mm",
        "2.934 MPa",
        "14.11",
        "3 of the equations are not equilibrium equations",
        "CH 0.7327 0.0000 −56.03",
        "They differ by more than 3 % at x = 35.0 mm",
        "Young's modulus E 2.4 GPa handbook Paredes (2018), table 1, after Shigley",
        "density 1450 kg/m³",
        "Poisson's ratio ν 0.38 assumed",
        "Sources of error in the band of each check: strength: pin pressure",
        "2 elements were straightened",
        "The pose is close to a dead point",
        "The load at H enters over the last 5 mm of the tube.",
        "solid models 1.5 s",
        "right-hand sides: small enough for a factorisation), relative error below 1e-09",
    ],
)
def test_what_a_reader_needs_is_there(page, words):
    assert words in re.sub(r"\s+([.,;:)])", r"\1", page.words)


def test_what_is_not_covered_is_said(page, result):
    for title, text in not_covered(result):
        assert title in page.words
        assert text in page.words


def test_every_link_has_a_section(page, result):
    for link in result.case.checked_links:
        assert f"Link {link}" in page.words


@pytest.mark.parametrize("verdict", list(Verdict))
def test_the_verdict_is_stamped(changed, verdict):
    text = render(changed(lambda check: replace(check, verdict=verdict)), {})
    assert f'<div class="verdict {verdict.value}">' in text
    assert f'<p class="stamp">{verdict.value}</p>' in text


def test_a_check_that_is_not_passed_gives_its_reason(changed):
    text = render(changed(lambda check: replace(check, verdict=Verdict.UNDECIDED, reason="it straddles the limit")), {})
    assert "it straddles the limit" in text


def test_text_of_the_case_is_escaped(result):
    hostile = "<script>alert(1)</script>"
    case = result.case.model_copy(update={"title": hostile, "assumptions": (hostile,), "description": hostile})
    text = render(replace(result, case=case, warnings=(hostile,), name=hostile), {})
    assert "<script" not in text
    assert text.count("&lt;script&gt;") >= 5


def test_a_case_without_the_optional_parts_renders(result):
    case = result.case.model_copy(update={"assumptions": (), "description": "", "source": ""})
    only = {"weight": result.load_cases["weight"]}
    page = Page(render(replace(result, case=case, load_cases=only, hand={}, audit=None, warnings=()), {}))
    assert "published statics" not in page.words
    assert "The case states none." in page.words
    assert "Load case idle" not in page.words


def test_no_zero_has_a_sign(page):
    assert not re.search(r"−0(\.0+)?(?![.\d])", page.words)


def test_what_the_source_published_stands_in_the_report(result, monkeypatch) -> None:
    from reports.page import html

    monkeypatch.setattr(html, "built_in_cases", lambda: ("owl-wing-static",))
    page = html.render(replace(result, name="owl-wing-static"), {})
    assert 'id="claims"' in page
    assert "does not hold" in page
    assert "claims: " in page
    shown = page[page.index('id="claims"') :]
    assert shown.index("<details open>") < shown.index("do not hold or do not follow (")
    assert "<details><summary>Figures that hold (" in shown
    assert 'id="claims"' not in html.render(replace(result, name="elsewhere.toml"), {})
