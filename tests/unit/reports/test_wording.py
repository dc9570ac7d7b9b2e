import math
from dataclasses import replace

import pytest

from alula.fea.asked.tiers import TierVerdict
from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Tier, Verdict, by_nearness, reason_for
from alula.fea.study.numbers import VariantNumber
from alula.reports.sections.checks import check_table
from alula.reports.sentences import told
from alula.reports.sentences import verdicts as wording
from alula.reports.study.rows import number_text
from alula.reports.words import numbers
from alula.reports.words.terminal import KEPT


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.952, 4, "0.9520"),
        (130.584, 4, "130.6"),
        (-130.584, 4, "−130.6"),
        (9.9996, 4, "10.00"),
        (0.0, 4, "0"),
        (-0.0, 4, "0"),
        (1.5e-16, 2, "1.5·10⁻¹⁶"),
        (123456.0, 3, "1.23·10⁵"),
        (float("inf"), 4, "∞"),
        (float("-inf"), 4, "−∞"),
        (float("nan"), 4, "not known"),
    ],
)
def test_a_number_has_its_significant_digits(value, digits, text):
    assert numbers.number(value, digits) == text


def test_what_rounding_leaves_of_a_sum_is_zero_beside_its_parts():
    assert numbers.number(8e-16, 3, beside=0.05) == "0"
    assert numbers.number(8e-10, 3, beside=0.05) == "8.00·10⁻¹⁰"


@pytest.mark.parametrize(("value", "text"), [(-0.0004, "0.00"), (-1.0, "−1.00"), (2.345, "2.35")])
def test_a_fixed_number_has_no_negative_zero(value, text):
    assert numbers.fixed(value, 2) == text


def test_a_band_is_spelled_out_where_it_shows():
    assert numbers.band(Band(value=3.21, low=2.44, high=3.21)) == "3.21 (2.44 to 3.21)"
    assert numbers.band(Band(value=3.2101, low=3.2100, high=3.2102)) == "3.21"


@pytest.mark.parametrize(
    ("words", "text"), [([], ""), (["a"], "a"), (["a", "b"], "a and b"), (["a", "b", "c"], "a, b and c")]
)
def test_words_are_joined(words, text):
    assert numbers.joined(words) == text


@pytest.mark.parametrize(("torque", "sense"), [(-1.0, "clockwise"), (1.0, "counter-clockwise"), (0.0, "none")])
def test_positive_torque_is_counter_clockwise(torque, sense):
    assert numbers.turning(torque) == sense


def test_the_headline_of_a_pass_names_the_check_nearest_to_its_limit(result):
    beams = result.load_cases["weight"].links["AE"]
    assert wording.headline(result).replace(KEPT, " ") == (
        "Pass: all 20 checks keep their limits over the whole error band. "
        f"Stays elastic: PASS, safety factor of AE (weight) {beams.safety_factor.value:.2f} (no band) ≥ 3. "
        "Does not break: not asked; a check of type plastic-collapse asks for it. "
        "Not checked: pins (no check); drive shaft at A; collisions of links and couples of their pins; "
        "creep under loads that stay (no conditions.duration)."
    )


def test_the_headline_of_a_fail_names_what_is_missed(result, changed):
    def change(check):
        missed = check.link == "CH" and check.quantity == "displacement" and check.load_case == "weight"
        return replace(check, value=Band.exact(12.5), verdict=Verdict.FAIL) if missed else check

    text = wording.headline(changed(change))
    assert text.startswith("Fail: 1 of 20 checks misses its limit over the whole error band: displacement of CH.")
    assert "Worst: displacement of link CH under load case weight, 12.5 mm; limit ≤ 10 mm." in text


def test_the_worst_of_a_fail_is_one_that_failed(result, changed):
    def change(check):
        unknown = Band(value=math.nan, low=math.nan, high=math.nan)
        if check.link == "AE":
            return replace(check, value=unknown, verdict=Verdict.UNDECIDED, reason="its peak has no limit")
        missed = check.link == "CH" and check.quantity == "displacement" and check.load_case == "weight"
        return replace(check, value=Band.exact(12.5), verdict=Verdict.FAIL) if missed else check

    assert "Worst: displacement of link CH" in wording.headline(changed(change))


@pytest.mark.parametrize("at_least", [True, False])
def test_the_unfavourable_end_of_a_band_says_which_check_is_nearest_to_its_limit(result, changed, at_least):
    """CH has the better value and the wider band: its unfavourable end is the nearer one."""
    quantity = Quantity.SAFETY_FACTOR if at_least else Quantity.DISPLACEMENT
    bands = {"CH": Band(value=2.0, low=1.1, high=2.9), "CF": Band(value=1.6, low=1.5, high=1.7)}
    if not at_least:
        bands = {name: Band(value=2.0 - b.value / 2, low=2.0 - b.high / 2, high=2.0 - b.low / 2)
                 for name, b in bands.items()}  # fmt: skip

    def change(check):
        value = bands.get(check.link, Band.exact(100.0 if at_least else 0.01))
        return replace(check, quantity=quantity, value=value, limit=1.0 if at_least else 1.5)

    assert by_nearness(wording.checks_of(changed(change)))[0].link == "CH"


def test_percentages_and_sentences():
    assert [numbers.percent(x) for x in (0.0123, -0.0123, -1e-5, 1e-5)] == ["+1.2 %", "−1.2 %", "0.0 %", "0.0 %"]
    assert numbers.sentence("load case a: it holds") == numbers.sentence("Load case a: it holds.")


def test_the_headline_of_an_open_answer_gives_the_reason(result, changed):
    def change(check):
        return replace(check, verdict=Verdict.UNDECIDED, reason="its band straddles the limit")

    text = wording.headline(changed(change))
    open_yet = (
        "Undecided: 20 of 20 checks are open: safety factor of GF, AE, CF, CH and ED (weight, idle); displacement of"
    )
    assert text.startswith(open_yet)
    assert "Safety factor of AE: its band straddles the limit." in text  # the nearest to its limit


@pytest.mark.parametrize(
    ("share", "low", "text"),
    [
        (0.203, 0.203, "gives way at 20 % of its load"),
        (0.203, 0.18, "gives way at 20 % (18 to 20 %) of its load"),
        (0.9996, 0.9996, "gives way at 99 % of its load"),
    ],
)
def test_a_linkage_that_gives_way_comes_first_with_its_share_of_the_load(result, changed, share, low, text):
    def change(check):
        if check.link != "CH" or check.load_case != "weight":
            return check
        if check.quantity is Quantity.SAFETY_FACTOR:
            return replace(check, value=Band.exact(0.1), verdict=Verdict.FAIL)
        held = Band(value=share, low=low, high=share)
        return replace(check, quantity=Quantity.LOAD_SHARE, value=held, limit=1.0, verdict=Verdict.FAIL)

    found = wording.headline(changed(change))
    assert found.startswith(f"Fail: under load case weight the linkage {text}. 2 of 20 checks miss their limits")
    assert "safety factor of CH and share of the load that the linkage holds" in found


def test_nothing_checked_is_undecided(result):
    empty = {name: replace(case, checks=()) for name, case in result.load_cases.items()}
    text = wording.headline(replace(result, load_cases=empty, verdict=Verdict.UNDECIDED))
    assert text.startswith("Undecided: the case contains no check.")


def test_no_headline_is_about_what_is_not_applicable(changed):
    """Where one share of the load is open and leaves a case undecided, the headline is about that alone."""

    def lost(check):
        if (check.link, check.name, check.load_case) == ("GF", "strength", "weight"):
            return check.left_open("its band straddles the limit")
        return check.not_applicable("gone") if check.link in ("AE", "CF") else check

    text = wording.headline(changed(lost))
    assert text.startswith("Undecided: 1 of 20 checks is open: safety factor of GF. Safety factor of GF: its band")


def test_what_is_not_known_has_no_unit(result, changed):
    """A headline said "displacement of ED not known mm"."""
    assert numbers.measured(Band.unknown("gone"), "mm") == "not known"
    assert numbers.measured(Band(value=2.0, low=1.0, high=math.inf), "mm") == "2.00 (1.00 to ∞) mm"
    assert numbers.measured(Band.exact(2.0), "") == "2.00"


@pytest.mark.parametrize(
    ("ends", "limit", "text"),
    [
        ((0.116, math.inf), 2.0, "its band 0.116 to ∞ holds the limit 2, so it may pass or fail"),
        ((-math.inf, 1.0), 0.0, "its band −∞ to 1 holds the limit 0, so it may pass or fail"),
        ((3.0, math.inf), 2.0, "its band 3 to ∞ lies wholly on the safe side of the limit 2"),
        ((1.9, 1.996), 2.0, "its band 1.9 to 1.996 lies wholly on the wrong side of the limit 2"),
        ((0.1, 0.2), 2.0, "its band 0.1 to 0.2 lies wholly on the wrong side of the limit 2"),
    ],
)
def test_why_a_band_gives_its_verdict(ends, limit, text):
    """It said "inf straddles"."""
    low, high = ends
    value = high if math.isinf(low) else low
    assert told(reason_for(Band(value=value, low=low, high=high), limit, Quantity.SAFETY_FACTOR)) == text


def test_no_number_beside_its_limit_is_rounded_to_the_limit_or_beyond_it():
    """A size at 1.996 was told as "2.00 (2.00 to 2.00) (≥ 2)"."""
    assert numbers.digits_beside(Band(value=1.9, low=1.0, high=2.1), 2.0) == 3
    assert numbers.digits_beside(Band(value=2.1, low=2.0, high=math.inf), 2.0) == 3
    assert numbers.digits_beside(Band(value=2.1, low=2.0004, high=math.inf), 2.0) == 5
    assert numbers.digits_beside(Band.unknown("gone"), 2.0) == 3
    assert numbers.digits_beside(Band.exact(-1e-9), 0.0) == 3
    ends, told_ends = {"value": 1.99, "low": 1.98, "high": 1.996}, "1.990 (1.980 to 1.996)"
    stepped = VariantNumber(quantity="safety factor", subject="GF", unit="1", limit=2.0, **ends)
    assert number_text(stepped) == f"safety factor of GF {told_ends} (≥{KEPT}2)"
    check = CheckOutcome.of("strength", Subject.link("GF"), "rest", Quantity.SAFETY_FACTOR, Band(**ends), 2.0)
    assert str(check_table([check], several=False).rows[0][4]) == told_ends
    assert told_ends in wording.decision(Verdict.FAIL, [check], several=False)
    tier = TierVerdict(tier=Tier.BREAK, links=("GF",), unasked=(), decides=check, asks="strength")
    [line] = wording.tier_lines([tier], several=False)
    assert f"{told_ends} <{KEPT}2." in line


def test_a_number_that_is_not_known_is_open_for_its_reason():
    """It said "its band nan to nan holds the limit 2"."""
    unknown = Band(value=math.nan, low=math.nan, high=math.nan, without="no beam stands for this link")
    assert reason_for(unknown, 2.0, Quantity.SAFETY_FACTOR) == "no beam stands for this link"
