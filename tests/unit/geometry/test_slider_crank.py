import math

import numpy as np
import pytest

from geometry.base.errors import CaseError
from geometry.mechanisms.slider_crank import SliderCrank


def test_bad_lengths():
    with pytest.raises(CaseError, match="a = 0 must be positive"):
        SliderCrank(a=0.0, b=3.0)
    with pytest.raises(CaseError, match="offset c = 7 exceeds crank and rod together by 2"):
        SliderCrank(a=2.0, b=3.0, c=7.0)
    with pytest.raises(CaseError, match="must be finite"):
        SliderCrank(a=2.0, b=3.0, c=math.nan)


def test_a_short_rod_leaves_part_of_the_turn_out():
    crank = SliderCrank(a=4.0, b=3.0)
    assert not crank.full_turn
    with pytest.raises(CaseError, match="too short by 1;"):
        crank.position(math.pi / 2)
    masked = np.ma.getmaskarray(crank.position(np.linspace(0, np.pi, 181)).d)
    # |4 sin θ| ≤ 3 up to 48.59°
    np.testing.assert_array_equal(np.flatnonzero(~masked), [*range(49), *range(132, 181)])
    with pytest.raises(CaseError, match="cannot turn fully"):
        crank.stroke_ends()


def test_a_rod_square_to_the_line_has_no_speed():
    crank = SliderCrank(a=4.0, b=3.0)
    theta2 = math.asin(0.75)
    with pytest.raises(CaseError, match="dead point"):
        crank.motion(theta2, 1.0)
    assert np.ma.getmaskarray(crank.motion([theta2, 0.1], 1.0).d_dot).tolist() == [True, False]


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_stroke_ends_bound_the_stroke(branch):
    crank = SliderCrank(a=2.0, b=5.0, c=1.5)
    d = crank.position(np.linspace(0, 2 * np.pi, 7201), branch=branch).d
    low, high = crank.stroke_ends(branch=branch)
    assert float(d.min()) == pytest.approx(low, abs=1e-6)
    assert float(d.max()) == pytest.approx(high, abs=1e-6)
