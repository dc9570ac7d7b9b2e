"""Checks in a pose that the linkage does not hold: one group with one reason, wherever checks are told."""

import io
import re

import pytest
import solved
from edited_cases import PLANAR, edited
from html_pages import Page
from rich.console import Console
from told import print_result, render

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Subject, Verdict, by_nearness, deciding, overall
from alula.fea.judging.linkage import NO_EQUILIBRIUM
from alula.fea.outcomes.unloaded import undecided
from alula.fea.sizing.changes import changes
from alula.fea.study.margin import least_margin, nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.loads.case.case_file import read_case
from alula.reports.notebook.check_report import CheckReport
from alula.reports.renderers.console import print_sections
from alula.reports.sections.checks import check_records, checks_section
from alula.reports.sections.section import Folded, Text
from alula.reports.sentences import told as in_words
from alula.reports.sentences.verdicts import checks_of, decision, inapplicable

CASE = read_case("owl-wing-static")
ENTRIES = (
    PLANAR,
    'load_cases.light={forces=[{link="CH", at="H", force=["0 N", "-0.02 N"]}]}',
    'load_cases.heavy={forces=[{link="CH", at="H", force=["0 N", "-3 N"]}]}',
    'checks.tip={type="displacement", at="H", maximum="200 mm"}',
    'checks.knee={type="displacement", at="C", maximum="200 mm"}',
)


@pytest.fixture(scope="module")
def wing():
    """The wing holds a light load and gives way under two others, the heavier of which breaks a link as it stands."""
    return check_case(edited("owl-wing-static", ENTRIES), name="owl-wing-static", fidelity="beam")


def outcome(name, verdict=Verdict.PASS, load_case="a", quantity=Quantity.SAFETY_FACTOR, subject=None):
    value = {Verdict.PASS: 4.0, Verdict.FAIL: 0.5}.get(verdict)
    band = Band.exact(value) if value else Band(value=1.0, low=0.5, high=2.0)
    return CheckOutcome.of("strength", subject or Subject.link(name), load_case, quantity, band, 1.0)


def printed(result):
    console = Console(width=100, record=True, file=io.StringIO())
    print_result(result, console)
    return re.sub(r"\s+", " ", console.export_text())


def test_what_passes_in_a_pose_that_is_not_held_does_not_apply(wing):
    """It stays undecided for programs; what fails in that pose, or is open there by its own band, stays so."""
    kept = {(c.name, c.subject): c for c in wing.load_cases["light"].checks}
    assert all(c.applies for c in kept.values())
    assert {"strength", "pins", "buckling", "tip", "knee"} <= {c.name for c in kept.values() if c.answer == "pass"}
    for name in ("weight", "heavy"):
        load_case = wing.load_cases[name]
        own = {(c.name, c.subject): c for c in load_case.checks}
        idle = {key for key, c in own.items() if not c.applies}
        assert {own[key].verdict for key in idle} == {Verdict.UNDECIDED}
        assert {own[key].reason for key in idle} == {NO_EQUILIBRIUM}
        assert {subject.kind for _, subject in idle} == {"link", "pin", "point"}
        # Of links and pins those whose whole band keeps its limit; of points, which have no number then, all.
        rests = {(name, s): c for (name, s), c in own.items() if s != LINKAGE}
        sides = {key: c.quantity.sense.verdict(c.value, c.limit) for key, c in rests.items()}
        passes = {key for key, side in sides.items() if side is Verdict.PASS}
        assert idle == passes | {key for key in rests if key[1].kind == "point"}
        assert all(rests[key].verdict is sides[key] for key in rests.keys() - idle)
        assert own["large displacement", LINKAGE].applies
    assert any(c.verdict is Verdict.FAIL and c.subject.kind == "link" for c in wing.load_cases["heavy"].checks)
    assert wing.verdict is Verdict.FAIL
    assert wing.verdict is overall(c.verdict for c in checks_of(wing))


def test_the_record_keeps_the_verdict_and_has_the_mark():
    kept, lost = outcome("AE"), outcome("CF").not_applicable("the linkage gives way")
    assert [(r["verdict"], r["applies"], r["reason"]) for r in check_records([kept, lost])] == [
        ("pass", True, in_words(kept.reason)),
        ("undecided", False, "the linkage gives way"),
    ]


def test_they_come_last_and_another_reason_takes_the_mark_away():
    lost = [outcome(name).not_applicable("gone") for name in ("AE", "CF")]
    every = [*lost, outcome("GF"), outcome("ED", Verdict.UNDECIDED), outcome("CH", Verdict.FAIL)]
    assert [c.link for c in by_nearness(every)] == ["CH", "ED", "GF", "AE", "CF"]
    assert [c.answer for c in by_nearness(every)[2:]] == ["pass", "not applicable", "not applicable"]
    [idle] = undecided(lost[:1], "a", 1.0, {})
    assert (idle.applies, idle.verdict) == (True, Verdict.UNDECIDED)


def test_a_group_names_each_quantity_once_with_all_load_cases_that_ask_the_same():
    def gone(*key, reason="gone", **more):
        return outcome(*key, **more).not_applicable(reason)

    buckles = {"quantity": Quantity.BUCKLING_FACTOR}
    every = [
        *(gone(link, load_case=load) for load in ("a", "b") for link in ("AE", "CF")),
        *(gone("AE", load_case="b", **buckles), gone("GF", load_case="b", reason="other"), outcome("GF")),
    ]
    assert inapplicable(every) == [
        "Not applicable, 5 checks: gone. Safety factor of AE and CF under a and b; buckling factor of AE under b.",
        "Not applicable, 1 check: other. Safety factor of GF under b.",
    ]
    assert inapplicable(every[:2]) == ["Not applicable, 2 checks: gone. Safety factor of AE and CF."]
    assert inapplicable([outcome("AE"), outcome("CF", Verdict.UNDECIDED)]) == []


def test_the_console_tells_them_below_the_table(wing):
    text = printed(wing)
    for load_case in wing.load_cases.values():
        assert len(inapplicable(load_case.checks)) == (load_case.name != "light")
    [line] = inapplicable(checks_of(wing))
    assert "under weight and heavy" in line
    assert text.count(re.sub(r"\s+", " ", line)) == 1
    assert text.count(in_words(NO_EQUILIBRIUM) + ". Safety factor of") == 1
    assert "Displacement of point H of CH: the linkage gives way" not in text


def test_the_console_tells_them_once_and_lists_them_last():
    console = Console(width=100, record=True, file=io.StringIO())
    checks = [outcome("AE", Verdict.FAIL), outcome("CF").not_applicable("gone")]
    print_sections([checks_section(CASE, checks, Verdict.FAIL, "In this pose")], console)
    above, group, below = console.export_text().partition("Not applicable, 1 check: gone.")
    assert group
    assert "CF" not in above
    assert len(re.findall(r"safety factor +AE .*\n *safety factor +CF .* not applicable", below)) == 1
    assert below.count("CF") == 2  # in the group's line and in the table


def test_the_page_has_one_group_at_the_end_and_none_of_it_among_the_nearest(wing):
    source = render(wing, {})
    first, rest = (source.split(f'<section id="{name}">')[1].split("</section>")[0] for name in ("nearest", "checks"))
    [line] = inapplicable(checks_of(wing))
    count = sum(not c.applies for c in checks_of(wing))
    assert line.startswith(f"Not applicable, {count} checks: {in_words(NO_EQUILIBRIUM)}. ")
    assert line in first
    assert first.count('<td class="what">') == 8
    assert ">not applicable<" not in first
    head, _, group = rest.partition("<details")
    assert line in head
    assert ">not applicable<" not in head
    assert group.count(">not applicable<") == count
    assert group.rindex(">pass<") < group.index(">not applicable<")


def test_a_section_of_checks_has_one_line_and_then_all_in_order():
    checks = by_nearness([outcome("AE").not_applicable("gone"), outcome("CF"), outcome("CH").not_applicable("gone")])
    parts = checks_section(CASE, checks, Verdict.UNDECIDED, "In this pose").parts
    assert Text("Not applicable, 2 checks: gone. Safety factor of AE and CH.", "small") in parts
    [every] = [part.parts[0] for part in parts if isinstance(part, Folded) and part.told]
    assert [(row[2], str(row[-1])) for row in every.rows] == [
        ("CF", "pass"), ("AE", "not applicable"), ("CH", "not applicable")
    ]  # fmt: skip


def test_a_notebook_tells_them_below_the_table(wing):
    report = CheckReport(wing)
    page, told = Page(report._repr_html_()), inapplicable(checks_of(wing))
    assert len(told) == 1
    assert told[0] in page.words
    assert told[0] in str(report)
    applies = [c for c in checks_of(wing) if c.applies]
    assert report._repr_html_().count("<tr>") == 1 + len(applies)
    rows = report.table()
    assert [row["verdict"] for row in rows] == [c.answer for c in by_nearness(checks_of(wing))]


def test_nothing_would_change_what_does_not_apply():
    """In layers the gap between them, of the linkage as a whole, was told beside the check that fails."""
    result = solved.by_hand("owl-wing-static")
    gaps = [c for c in checks_of(result) if c.quantity is Quantity.LAYER_GAP]
    assert [c.answer for c in gaps] == ["not applicable"]
    assert [(c.check.quantity, c.check.applies) for c in changes(result)] == [(Quantity.LOAD_SHARE, True)]


def test_a_study_measures_how_near_a_limit_is_without_them():
    """A point without equilibrium has no number, and once was the nearest to its limit for that."""
    share = CheckOutcome.of(
        "large displacement", LINKAGE, "a", Quantity.LOAD_SHARE, Band(value=0.9, low=0.8, high=1.0), 1.0
    )
    tip = CheckOutcome.of("tip", Subject.point("H", "CH"), "a", Quantity.DISPLACEMENT, Band.unknown(), 1.0)
    numbers = tuple(VariantNumber.of(c) for c in (tip.not_applicable("gone"), share))
    assert [n.verdict for n in numbers] == [None, Verdict.UNDECIDED]
    found = VariantResult(state="done", verdict=Verdict.UNDECIDED, numbers=numbers)
    assert nearest(found) is numbers[1]
    assert nearest(found, worst=False) is numbers[1]
    assert least_margin(found)[1] == pytest.approx(0.8)


def test_where_nothing_that_is_open_is_applicable_one_of_them_decides():
    """It ended in an internal error."""
    checks = [outcome("AE").not_applicable("gone"), outcome("CF")]
    assert [check.link for check in deciding(checks)] == ["AE"]
    told = decision(Verdict.UNDECIDED, checks, several=False)
    assert told.startswith("Undecided: 1 of 2 checks is open: safety factor of AE.")
