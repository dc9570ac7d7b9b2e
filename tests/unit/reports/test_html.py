import re
from dataclasses import replace

import pytest
from html_pages import Page, stands_alone
from told import flat, not_covered, render

from alula.fea.claims import sources
from alula.fea.common.band import Band
from alula.fea.common.verdict import Quantity, Verdict, worst_of_each
from alula.reports.check.published import CLAIMS, published_page
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.sentences.verdicts import checks_of

NAMES = ("linkage-weight", "diagram-AE", "stress-GF")
PICTURES = {name: Canvas(90.0 - 10.0 * k, 60.0) for k, name in enumerate(NAMES)}


@pytest.fixture(scope="module")
def source(result):
    return render(result, PICTURES, "Published statics: 3 of 15 equations do not hold.")


@pytest.fixture(scope="module")
def page(source):
    return Page(source)


def test_it_loads_nothing_from_elsewhere_and_links_lead_somewhere(page, result):
    stands_alone(page, beside=(CLAIMS,))
    stands_alone(Page(render(result, {})))


def test_pictures_are_embedded_and_described(page):
    of = {name: [value for tag, key, value in page.attributes if (tag, key) == ("svg", name)]
          for name in ("viewbox", "role", "aria-label")}  # fmt: skip
    assert sorted(of["viewbox"]) == [f"0 0 {sheet.width:.0f} 60" for sheet in reversed(PICTURES.values())]
    assert of["role"] == ["img"] * len(PICTURES)
    assert len(set(of["aria-label"])) == len(PICTURES)


def test_it_stands_without_pictures(result):
    assert "<svg" not in render(result, {})


@pytest.mark.parametrize(
    "words",
    [
        "Pass: all 20 checks keep their limits",
        "PASS, safety factor of AE (weight) 3.65",
        "AG → AE 0.5011 0.8095 0.9520",
        "Drive torque on AE about A: −130.6 N·mm (clockwise",
        "condition number",
        "driven link AE 0.0374",
        "with the pose coordinate held, or the driven link against the other link of its joint (sliders: the travel);",
        "“What the verdict does not cover” lists what the model leaves out.",
        "228.150°",
        "33.75 N·mm",
        "2.934 MPa",
        "14.11",
        "They differ by more than 3 % at x = 35.0 mm",
        "Young's modulus E 2.4 GPa handbook Paredes (2018), table 1, after Shigley",
        "density 1450 kg/m³",
        "Poisson's ratio ν 0.38 assumed",
        "Sources of error in the band of each check strength: pin pressure",
        "2 elements were straightened",
        "Warning: the pose is close to a dead point",
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
        assert flat(text) in page.words


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
    assert "The case states no assumptions." in page.words
    assert "Load case idle" not in page.words


def test_no_zero_has_a_sign(page):
    assert not re.search(r"−0(\.0+)?(?![.\d])", page.words)


def test_published_figures_and_statics_have_a_page_of_their_own(result, monkeypatch) -> None:
    """The report has their number and the address; a case of which nothing was published has no such page."""
    monkeypatch.setattr(sources, "built_in_cases", lambda: ("owl-wing-static",))
    named = replace(result, name="owl-wing-static")
    text, told = published_page(named, sources.claims_of(named), "report.html")
    page = Page(text)
    stands_alone(page, beside=("report.html",))
    assert "3 of 15 equations are not equilibrium equations" in page.words
    assert "CH 0.7327 0.0000 −56.03" in page.words
    assert page.source.index("<details open>") < page.source.index("do not hold or do not follow (")
    assert "<details><summary>Figures that hold (" in page.source
    assert re.match(r"Published figures: \d+ claims: .* Published statics: 3 of 15 equations are not equ", told)
    plain = replace(result, name="elsewhere.toml", audit=None)
    assert published_page(plain, sources.claims_of(plain), "report.html") == ("", "")
    assert CLAIMS not in render(plain, {})


def test_the_first_page_holds_verdict_picture_and_the_checks_nearest_to_their_limits(result, source, changed):
    """Before the contents: the stamp, the linkage, eight checks in the order of their margins; all of them below."""
    first, rest = source.split("<nav", 1)
    assert first.index('class="stamp"') < first.index("<svg") < first.index('<section id="nearest">')
    every = checks_of(result)
    assert len(every) > 8
    rows = re.findall(r'<td class="what">(.*?)</td>', first)
    assert len(rows) == 8
    grouped, unfolded = rest.split(f"<summary>All {len(every)} checks, under each load case</summary>")
    assert len(re.findall(r'<td class="what">', grouped)) == len(worst_of_each(every)) < len(every)
    assert len(re.findall(r'<td class="what">', unfolded)) == len(every)

    def change(check):  # one check fails by little, another is open by much, and CF passes but just so
        if check.quantity is not Quantity.SAFETY_FACTOR or check.load_case != "weight":
            return replace(check, verdict=Verdict.PASS, value=Band.exact(100.0 if check.at_least else 1e-3))
        low, verdict = {"GF": (2.9, Verdict.FAIL), "CH": (1.0, Verdict.UNDECIDED), "CF": (3.1, Verdict.PASS)}.get(
            check.link, (90.0, Verdict.PASS)
        )
        return replace(check, value=Band.exact(low), limit=3.0, verdict=verdict)

    page = render(changed(change), {})
    shown = [re.sub("<.*?>", "", row) for row in re.findall(r'<td class="what">(.*?)</td>', page)[:3]]
    assert shown == [f"Safety factor of {link}, weight" for link in ("GF", "CH", "CF")]
