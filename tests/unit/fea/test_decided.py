"""Which single cause would decide a check: what is told does decide it, and a little less does not."""

import random
from dataclasses import replace

import pytest

from alula.fea.common.band import Band
from alula.fea.common.decided import decided_by
from alula.fea.common.reason import Reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity, Sense, Subject, Verdict
from alula.reports.sentences import told

AT_LEAST = Sense.AT_LEAST


def made(value, **factors):
    """A band by what each kind of source makes of it."""
    band = Band.exact(value)
    for name, (low, high) in factors.items():
        source = Source(kind=SourceKind[name.upper()], detail=name)
        band = Scatter(low=low, high=high, sources=(source,)).on(band)
    return band


def outcome(band, limit=2.0):
    return CheckOutcome.of("n", Subject.link("a"), "lift", Quantity.SAFETY_FACTOR, band, limit)


@pytest.mark.parametrize("seed", range(20))
def test_what_is_told_decides_and_a_little_less_does_not(seed):
    """Tried by bands that are made anew, with the one source as told."""
    draw = random.Random(seed)
    tried = 0
    for _ in range(100):
        factors = {
            name: (1.0 / draw.uniform(1.0, 1.5), draw.uniform(1.0, 1.5)) for name in ("calibration", "load", "play")
        }
        value = draw.uniform(1.0, 4.0)
        band = made(value, **factors)
        found = decided_by(band, 2.0, factors=True)
        if AT_LEAST.verdict(band, 2.0) is not Verdict.UNDECIDED or not isinstance(found, Reason):
            continue
        known = {name: AT_LEAST.verdict(made(value, **{**factors, name: (1.0, 1.0)}), 2.0) for name in factors}
        order = [name for name in ("calibration", "play", "load") if known[name] is not Verdict.UNDECIDED]
        assert found.kind == (f"decided_by_{order[0]}" if order else "decided_by_none")
        if order and order[0] == "calibration":
            for number, side in ((found["ends"][0], -1.0), (found["ends"][1], 1.0)):
                for by, opened in ((1.0 + 1e-6 * side, False), (1.0 - 1e-6 * side, True)):
                    told_by = made(number * by, **{**factors, "calibration": (1.0, 1.0)})
                    assert (AT_LEAST.verdict(told_by, 2.0) is Verdict.UNDECIDED) is opened
        elif order:
            end, nearer = found["needed"], 0 if found["passes"] else 1
            for by, opened in ((1.0 - 1e-6, not nearer), (1.0 + 1e-6, bool(nearer))):
                ends = list(factors[order[0]])
                ends[nearer] = end * by
                left = AT_LEAST.verdict(made(value, **{**factors, order[0]: tuple(ends)}), 2.0)
                assert (left is Verdict.UNDECIDED) is opened
        tried += 1
    assert tried > 10


def test_of_stress_and_of_the_worst_of_two_places():
    """Strength over the largest of two stresses; without one's source the other one may be the largest."""
    one, other = made(10.0, calibration=(0.5, 2.0)), made(14.0, calibration=(0.9, 1.1), load=(0.9, 1.1))
    band = Band.largest([one, other]).inverse(30.0)
    [known] = [source for source in band.sources if source.kind is SourceKind.CALIBRATION]
    # Largest: 20, without what calibration makes 14 * 1.1.
    assert known.ends[0] == pytest.approx((14.0 * 1.1) / 20.0)
    assert band.low / known.ends[0] == pytest.approx(30.0 / (14.0 * 1.1))


def test_nothing_is_promised_of_sources_that_are_not_known_one_by_one():
    band = made(3.0, load=(0.5, 1.5))
    both = Scatter(low=0.5, high=1.5, sources=(Source(kind=SourceKind.LOAD), Source(kind=SourceKind.MODULUS)))
    assert decided_by(band, 2.0, factors=True)["needed"] == pytest.approx(2.0 / 3.0)
    assert decided_by(both.on(Band.exact(3.0)), 2.0, factors=True).kind == "most_of_band"
    assert decided_by(band, 2.0, factors=False).kind == "most_of_band"  # a displacement is a sum
    assert decided_by(replace(band, sources=()), 2.0, factors=True) == ""


def test_it_is_told_with_the_reason_rounded_to_what_still_does():
    said = told(outcome(made(3.0, load=(0.5, 1.5))).reason)
    assert said.endswith("; it would pass with a scatter of the load of at most 1.5 times what is stated")
    said = told(outcome(made(3.0, load=(0.9, 1.5), strength=(0.61, 1.0))).reason)
    assert said.endswith("; it would pass with a range of the strength of at least 0.741 times its value")
    said = told(outcome(made(1.5, strength=(0.6, 1.6))).reason)
    assert said.endswith("; it would fail with a range of the strength of at most 1.33 times its value")
    said = told(outcome(made(3.0, calibration=(0.5, 2.0), couples=(0.9, 1.25))).reason)
    assert said.endswith(
        "its solid (--fidelity solid) alone would decide it, unless it comes out at 1.6 to 2.22, all else as stated"
    )
    said = told(outcome(made(3.0, calibration=(0.5, 2.0), couples=(0.5, 1.25))).reason)
    assert "none of the causes of its band is known to decide it alone; the widest are calibration" in said
    assert "(a factor of 4) and sharing of the couples between layers (a factor of 2.5)" in said
