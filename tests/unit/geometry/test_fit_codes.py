"""Codes of fits: what is read, and what is refused with what to state in its place."""

import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.fits import fit, parse_fit, tolerance


def test_codes_are_read():
    assert parse_fit("H8/f7") == (8, "f", 7)
    assert parse_fit(" H11 / d 10") == (11, "d", 10)


@pytest.mark.parametrize(
    "code",
    ["", "H7/p6", "H7/js6", "F8/h7", "h7/H6", "H4/f7", "H13/d7", "H8", "H8f7", "H7/c7", "H٨/f7", "H08/f7", "x" * 99],
)
def test_other_fits_are_refused_with_what_to_state(code):
    with pytest.raises(CaseError, match=r'of a hole H and a pin d to h, of grades 5 to 12.* state clearance = \["'):
        fit(code, 3.0)


@pytest.mark.parametrize("diameter", [0.0, -1.0, 500.1, 1e9])
def test_diameters_outside_the_formula_are_refused(diameter):
    with pytest.raises(CaseError, match=r"known up to 500 mm, but the pin has .* state clearance"):
        fit("H8/f7", diameter)


def test_a_step_holds_its_upper_end_and_the_first_all_that_is_smaller():
    assert tolerance(7, 0.3) == tolerance(7, 3.0) < tolerance(7, 3.1) == tolerance(7, 6.0) < tolerance(7, 6.001)
    assert fit("H8/f7", 500.0).clearance[1] > fit("H8/f7", 400.0).clearance[1]


def test_bounds_hold_the_rounding_and_no_interference():
    found = fit("H8/f7", 3.0)
    assert found.bounds == pytest.approx((found.clearance[0] - 0.002, found.clearance[1] + 0.002))
    assert fit("H7/h6", 25.0).bounds[0] == 0.0
