import pytest

from fea.common.band import Band
from fea.common.verdict import Verdict, at_least, at_most, overall


def band(low: float, value: float, high: float) -> Band:
    return Band(value=value, low=low, high=high, holds=("a test",))


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
    assert at_least(band(low, low, high), 3.0) is least
    assert at_most(band(low, high, high), 3.0) is most


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


def test_strength_over_a_stress_band_turns_it_round() -> None:
    factor = band(10.0, 12.0, 16.0).inverse(48.0)
    assert (factor.low, factor.value, factor.high) == (3.0, 4.0, 4.8)
    assert Band.exact(0.0).inverse(48.0).value == float("inf")


def test_a_band_around_variants_reaches_the_outermost() -> None:
    found = Band.around(12.0, (11.0, 12.5), "two models")
    assert (found.low, found.value, found.high, found.holds) == (11.0, 12.0, 12.5, ("two models",))
