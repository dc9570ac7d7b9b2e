import pytest

from alula.geometry.mechanisms.grashof import classify


@pytest.mark.parametrize(
    ("lengths", "inversion", "barker"),
    [
        ((2, 7, 9, 6), "crank-rocker", "GCRR"),
        ((7, 9, 6, 2), "double-crank", "GCCC"),
        ((7, 2, 9, 6), "double-rocker", "GRCR"),
        ((7, 9, 2, 6), "rocker-crank", "GRRC"),
        ((2, 3, 4, 5), "change point", "SCRR"),
        ((5, 3, 4, 2), "change point", "SCCC"),
        ((3, 7, 3, 7), "parallelogram", "S2X"),
        ((3, 3, 7, 7), "kite", "S2X"),
        ((3, 7, 7, 3), "kite", "S2X"),
        ((4, 4, 4, 4), "rhombus", "S3X"),
        ((2, 9, 6, 4), "triple-rocker", "RRR3"),
        ((9, 2, 6, 4), "triple-rocker", "RRR2"),
        ((2, 6, 9, 4), "triple-rocker", "RRR4"),
        ((2, 6, 4, 9), "triple-rocker", "RRR1"),
    ],
)
def test_classes_and_inversions(lengths, inversion, barker):
    found = classify(**dict(zip("abcd", lengths, strict=True)))
    assert (found.inversion, found.barker) == (inversion, barker)


def test_equality_is_told_from_inequality_within_the_tolerance():
    def relation(excess, tolerance=1e-9):
        return classify(a=2.0 + excess, b=3.0, c=4.0, d=5.0, tolerance=tolerance).relation

    assert relation(1e-10) == "equal"
    assert relation(1e-6) == "greater"
    assert relation(-1e-6) == "less"
    assert relation(1e-6, tolerance=1e-6) == "equal"


def test_rounded_lengths_that_are_equal_in_decimals_count_as_equal():
    # 0.1 + 0.7 and 0.3 + 0.5 differ in floating point.
    assert 0.1 + 0.7 != 0.3 + 0.5
    assert classify(a=0.1, b=0.3, c=0.5, d=0.7).relation == "equal"


def test_sentences():
    assert "crank-rocker" in classify(a=2, b=7, c=9, d=6).sentence
    assert "change point" in classify(a=2, b=3, c=4, d=5).sentence
    assert "no link turns fully" in classify(a=2, b=9, c=6, d=4).sentence
    assert classify(a=2, b=3, c=4, d=5).satisfied
    assert not classify(a=2, b=9, c=6, d=4).satisfied
