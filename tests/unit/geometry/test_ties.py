import math

import numpy as np
import pytest

from alula.fea.beam.piecewise import Piecewise
from alula.geometry.base.ties import first_largest, first_least, ranked


@pytest.mark.parametrize(
    ("values", "first"),
    [
        ([1.0, 3.0, 3.0 + 1e-12, 2.0], 1),
        ([1.0, 3.0, 3.0 + 1e-6], 2),
        ([-2.0, -1.0 - 1e-12, -1.0], 1),
        ([1.0, math.inf, math.inf], 1),
        ([-math.inf, -math.inf], 0),
        ([0.0, 0.0], 0),
    ],
)
def test_rounding_does_not_choose_among_equals(values, first):
    assert first_largest(values) == first


@pytest.mark.parametrize("rounding", [-1e-15, 0.0, 1e-15])
def test_a_constant_has_its_peak_at_the_first_end_of_a_beam(rounding):
    """Where a two-force link is stressed most once depended on the last digit of its forces."""
    constant = Piecewise(
        breaks=np.array([0.0, 20.0, 50.0]), coefficients=np.array([[[-7.0, rounding]], [[-7.0 - rounding, 0.0]]])
    )
    assert constant.largest(lambda f: abs(f[:, 0]))[:2] == (0.0, "after")
    assert constant.largest(lambda f: f[:, 0])[:2] == (0.0, "after")


@pytest.mark.parametrize("rounding", [-1e-12, 0.0, 1e-12])
def test_order_and_least_by_the_size_of_what_values_are_differences_of(rounding):
    """Gaps of some 1e-4 mm between links of 100 mm have a rounding of 1e-9 of themselves."""
    values = [3e-4, 1e-4 + rounding, 2.0, 1e-4, 3e-4 - rounding, math.nan]
    assert first_least(values, 100.0) == 1
    assert ranked(values[:5], 100.0) == [1, 3, 0, 4, 2]
