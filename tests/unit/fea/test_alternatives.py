"""A cause whose answers are alternatives: of every number the worst of them, whichever of several that is."""

import math

import pytest

from alula.fea.common.alternatives import Alternatives
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind

AIR = Source(kind=SourceKind.AIR)


def ends(scatter):
    return scatter.low, scatter.high


@pytest.mark.parametrize("others", [(3.0, 1.0), (1.0, 3.0), (1.0, 2.5, 3.0), (3.0, 1.0, 1.0)])
def test_the_least_and_the_largest_of_all_answers_count_in_any_order(others):
    cause = Alternatives(source=AIR, others=others)
    assert ends(cause.scatter(2.0, lambda one: one)) == (0.5, 1.5)
    assert ends(cause.scatter(2.0, lambda one: 1.0 / one)) == pytest.approx((2.0 / 3.0, 2.0))
    assert ends(cause.told_by(lambda one: 2.0 * one).scatter(2.0, lambda one: one)) == (1.0, 3.0)


def test_the_stated_answer_is_one_of_them():
    assert ends(Alternatives(source=AIR, others=(5.0, 4.0)).of(2.0, (5.0, 4.0))) == (1.0, 2.5)
    assert ends(Alternatives(source=AIR, others=(1.0, 0.5)).of(2.0, (1.0, 0.5))) == (0.25, 1.0)


def test_a_convex_number_may_be_less_between_two_answers():
    """|x - 0.4| is 1.6 at 2, and 0.6 and 0.4 at 1 and 0; between these it is 0."""
    cause = Alternatives(source=AIR, others=(1.0, 0.0), coefficients=(2.0, 1.0, 0.0))
    found = cause.scatter(2.0, lambda x: abs(x - 0.4))
    assert ends(found) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert found.sources == (AIR,)


def test_an_answer_without_end_leaves_no_number_an_end():
    cause = Alternatives(source=AIR, others=(1.0,), endless=True)
    assert ends(cause.of(2.0, (1.0,))) == (0.5, math.inf)


def test_a_number_that_is_zero_as_stated_has_no_end_where_another_is_not():
    cause = Alternatives(source=AIR, others=(0.0, 1.0))
    assert ends(cause.of(0.0, (0.0, 1.0))) == (1.0, math.inf)
    assert cause.of(0.0, (0.0, 0.0)) == Scatter()
