import math

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.records.bearing import NARROW, WIDE, bearing_stress


@pytest.mark.parametrize("law", [WIDE, NARROW])
def test_peak_pressure_balances_the_force(law):
    theta = np.linspace(-math.pi, math.pi, 200_001)
    force, diameter, thickness = 7.3, 1.5, 6.2
    pressure = law.peak(force=force, diameter=diameter, thickness=thickness) * law.shape(theta)
    resultant = np.trapezoid(pressure * np.cos(theta), theta) * thickness * diameter / 2.0
    assert resultant == pytest.approx(force, rel=1e-8)


def test_peaks_in_closed_form():
    assert WIDE.peak(force=1.0, diameter=1.5, thickness=6.0) == pytest.approx(4.0 / (math.pi * 9.0), rel=1e-14)
    assert NARROW.peak(force=1.0, diameter=1.5, thickness=6.0) == pytest.approx(3.0 / (math.sqrt(2.0) * 9.0), rel=1e-14)


@pytest.mark.parametrize(("law", "edge"), [(WIDE, 90.0), (NARROW, 45.0)])
def test_pressure_vanishes_at_the_edge_of_its_span_without_a_jump(law, edge):
    just_inside = law.shape(math.radians(edge) - 1e-9)
    assert 0.0 < just_inside < 1e-8
    assert law.shape(math.radians(edge) + 1e-9) == 0.0
    assert law.shape(0.0) == 1.0


def test_angle_may_be_given_in_any_turn():
    theta = np.linspace(-1.0, 1.0, 21)
    for turns in (-3, 1, 7):
        np.testing.assert_allclose(WIDE.shape(theta + 2.0 * math.pi * turns), WIDE.shape(theta), atol=1e-13)


def test_bearing_stress():
    assert bearing_stress(force=0.751, diameter=1.5, thickness=6.0) == pytest.approx(0.751 / 9.0)


@pytest.mark.parametrize(("diameter", "thickness"), [(0.0, 3.0), (1.0, 0.0)])
def test_bearing_on_no_area_is_refused(diameter, thickness):
    with pytest.raises(CaseError, match="above zero"):
        bearing_stress(force=1.0, diameter=diameter, thickness=thickness)
