import math

import pytest

from alula.fea.common.band import Band
from alula.fea.common.verdict import Sense, Verdict
from alula.reports.sentences import told


def test_what_is_unknown_decides_nothing():
    unknown = Band.unknown("nothing")
    assert unknown.unknowable
    assert {sense.verdict(unknown, 3.0) for sense in Sense} == {Verdict.UNDECIDED}


def test_an_unknown_stress_gives_no_safety_factor():
    factor = Band.unknown("no mesh tells").inverse(41.4)
    assert factor.unknowable
    assert tuple(map(told, factor.texts)) == ("nothing: no mesh tells",)


def test_half_a_band_is_refused():
    with pytest.raises(ValueError, match="does not hold"):
        Band(value=1.0, low=math.nan, high=2.0)
