"""The motor's demand from a known power, and the heaviest load that it drives."""

import math

import numpy as np
import pytest

from fea.motor_check import demand, largest_factor
from geometry.errors import CaseError
from loads.case_file import read_case


def test_demand_of_a_sine() -> None:
    times = np.linspace(0.0, 2.0, 4001)
    power = 3000.0 * np.sin(2.0 * math.pi * times)
    found = demand(power, -power / 10.0, times)
    assert found.peak_power == pytest.approx(3.0, rel=1e-6)
    assert found.mean_positive_power == pytest.approx(3.0 / math.pi, rel=1e-6)
    assert found.peak_torque == pytest.approx(300.0, rel=1e-6)


def test_the_largest_factor_meets_the_limit_and_not_more() -> None:
    bare, load = np.array([1.0, -2.0, 0.5]), np.array([2.0, 9.0, -4.0])
    k = largest_factor(bare, load, 10.0)
    assert np.max(bare + k * load) == pytest.approx(10.0)
    assert k == pytest.approx(12.0 / 9.0)


def test_no_load_fits_where_the_bare_linkage_asks_too_much() -> None:
    assert largest_factor(np.array([11.0]), np.array([1.0]), 10.0) == 0.0
    assert largest_factor(np.array([1.0]), np.array([-1.0]), 10.0) == math.inf


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["checks.motor.efficiency=1.5"], "efficiency"),
        (['checks.motor.voltage="6 A"'], "not a unit of voltage"),
        (['checks.motor.current="-1 mA"'], "greater than zero"),
        ([f'load_cases.{name}.speed="0 rpm"' for name in ("slow", "fast", "wings-10", "wings-12")], "no load case"),
    ],
)
def test_bad_motors_are_told(overrides: list[str], told: str) -> None:
    with pytest.raises(CaseError, match=told):
        read_case("ornithopter", overrides)
