import math

import pytest

from alula.fea.common.band import Band
from alula.fea.common.source import PIN_PRESSURE, Source, SourceKind
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Sense, Subject, Verdict, overall
from alula.reports.sections.data import data
from alula.reports.sentences import told


def band(low: float, value: float, high: float) -> Band:
    return Band(value=value, low=low, high=high, sources=(Source(kind=SourceKind.LOAD),))


@pytest.mark.parametrize(
    ("low", "high", "least", "most"),
    [
        (3.0, 4.0, Verdict.PASS, Verdict.UNDECIDED),
        (2.0, 2.9, Verdict.FAIL, Verdict.PASS),
        (2.9, 3.1, Verdict.UNDECIDED, Verdict.UNDECIDED),
        (3.1, 3.2, Verdict.PASS, Verdict.FAIL),
        (3.0, 3.0, Verdict.PASS, Verdict.PASS),
    ],
)
def test_the_whole_band_decides(low: float, high: float, least: Verdict, most: Verdict) -> None:
    assert Sense.AT_LEAST.verdict(band(low, low, high), 3.0) is least
    assert Sense.AT_MOST.verdict(band(low, high, high), 3.0) is most


def test_any_fail_fails_and_any_doubt_is_doubt() -> None:
    assert overall([Verdict.PASS, Verdict.UNDECIDED, Verdict.FAIL]) is Verdict.FAIL
    assert overall([Verdict.PASS, Verdict.UNDECIDED]) is Verdict.UNDECIDED
    assert overall([Verdict.PASS, Verdict.PASS]) is Verdict.PASS
    assert overall([]) is Verdict.UNDECIDED


def test_exit_statuses() -> None:
    assert [v.exit_status for v in (Verdict.PASS, Verdict.FAIL, Verdict.UNDECIDED)] == [0, 1, 3]


def test_a_band_must_hold_its_value() -> None:
    with pytest.raises(ValueError, match="does not hold its value"):
        band(2.0, 1.0, 3.0)
    with pytest.raises(ValueError, match="does not hold its value"):
        band(1.0, float("nan"), 3.0)


def test_a_number_without_a_band_is_read_without_ends() -> None:
    """Its ends were those of the value, as if it were exact: solids lay below such a low end by up to 8 times."""
    bare, known = Band(value=2.0, low=1.5, high=2.5, without="no beam stands for it"), band(1.5, 2.0, 2.5)
    assert (bare.told.value, known.told) == (2.0, known)
    assert math.isnan(bare.told.low)
    assert math.isnan(bare.told.high)
    assert (data(bare)["value"], data(known)["low"], data(Band.exact(3.0))["low"]) == (2.0, 1.5, 3.0)
    assert math.isnan(data(bare)["low"])


def test_strength_over_a_stress_band_turns_it_round() -> None:
    factor = band(10.0, 12.0, 16.0).inverse(48.0)
    assert (factor.low, factor.value, factor.high) == (3.0, 4.0, 4.8)
    assert Band.exact(0.0).inverse(48.0).value == float("inf")


def test_a_band_around_variants_reaches_the_outermost() -> None:
    found = Band.around(12.0, (11.0, 12.5), PIN_PRESSURE)
    assert (found.low, found.value, found.high, found.sources) == (11.0, 12.0, 12.5, (PIN_PRESSURE,))


@pytest.mark.parametrize(
    ("quantity", "unit", "sign"),
    [("safety factor", "", "≥"), ("fatigue, life", "", "≥"), ("displacement", "mm", "≤"), ("drive speed", "rpm", "≤")],
)
def test_a_quantity_is_its_name_and_knows_unit_and_sense(quantity: str, unit: str, sign: str) -> None:
    found = Quantity(quantity)
    assert (str(found), found.unit, found.sense.value) == (quantity, unit, sign)


@pytest.mark.parametrize(
    ("subject", "short", "long"),
    [
        (Subject.link("CH"), "CH", "link CH"),
        (Subject.pin("A"), "pin A", "pin A"),
        (Subject.point("H", "CH"), "point H of CH", "point H of CH"),
        (LINKAGE, "the linkage", "the linkage"),
    ],
)
def test_a_subject_in_a_table_and_in_a_sentence(subject: Subject, short: str, long: str) -> None:
    assert (str(subject), subject.long) == (short, long)
    assert Subject.link(short) != subject or subject.kind == "link"  # a link of that name is another subject


def test_an_outcome_is_decided_by_its_quantity_and_stays_open_where_told() -> None:
    stress = CheckOutcome.of("creep", Subject.link("CH"), "rain", Quantity.SUSTAINED_STRESS, band(2.0, 2.5, 3.0), 4.0)
    assert (stress.verdict, stress.unit, told(stress.reason)) == (
        Verdict.PASS, "MPa", "its band 2 to 3 lies wholly on the safe side of the limit 4",
    )  # fmt: skip
    factor = CheckOutcome.of("strength", LINKAGE, "rain", Quantity.SAFETY_FACTOR, band(2.0, 2.5, 3.0), 4.0, "too thin")
    assert (factor.verdict, factor.unit, factor.reason) == (Verdict.FAIL, "", "too thin")
    opened = factor.left_open("no one knows")
    assert (opened.verdict, opened.reason, opened.value) == (Verdict.UNDECIDED, "no one knows", factor.value)
