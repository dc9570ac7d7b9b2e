import math

import pytest

from fea.refine.convergence import grid_convergence, observed_order, williams_exponent
from fea.refine.discretisation import discretisation_source
from geometry.base.errors import CannotRunError

SIZES = (1.0, 0.6, 0.4)
SAFETY, WIDE_SAFETY = 1.25, 3.0  # Roache (1998), section 5.6: with an observed order and without
FLOOR, CEILING, ALONE = 1.5, 3.0, 4.0  # multiples of the estimate, as docs/design.md states them


def power(order, sizes=SIZES, limit=10.0, share=2.0):
    return [limit + share * size**order for size in sizes]


@pytest.mark.parametrize("order", [-0.5, 0.7, 1.0, 2.0, 3.5])
@pytest.mark.parametrize("share", [2.0, -2.0])
def test_order_is_found_on_unequal_ratios(order, share):
    assert observed_order(SIZES, power(order, share=share)) == pytest.approx(order, abs=1e-9)


def test_logarithm_has_order_zero():
    assert observed_order(SIZES, [-math.log(size) for size in SIZES]) == pytest.approx(0.0, abs=1e-6)


def test_oscillation_has_no_order():
    assert observed_order(SIZES, [1.0, 1.2, 1.1]) is None


@pytest.mark.parametrize("share", [2.0, -2.0])
def test_index_of_a_clean_series_is_its_error_times_the_factor(share):
    found = grid_convergence(SIZES, power(1.5, share=share), estimate=0.3)
    error = share * 0.4**1.5
    assert found.kind == "monotone"
    assert found.factor == SAFETY
    reach = SAFETY * abs(error)
    assert found.index == pytest.approx(reach / found.value)
    # The limit lies beyond the last value: below it for a falling series, above it for a rising one.
    ends = (found.value - found.low, found.high - found.value)
    assert ends == pytest.approx((reach, reach / 5.0) if share > 0.0 else (reach / 5.0, reach))
    assert found.low < 10.0 < found.high


def test_order_above_the_elements_own_makes_the_band_symmetric():
    found = grid_convergence(SIZES, power(3.5, share=-2.0), estimate=0.1)
    assert found.value - found.low == pytest.approx(found.high - found.value)


def test_oscillating_series_takes_the_large_factor():
    found = grid_convergence((0.9, 0.6, 0.4), [10.0, 10.4, 10.2], estimate=0.1)
    assert (found.kind, found.factor, found.order) == ("irregular", WIDE_SAFETY, None)
    assert found.high - found.value == pytest.approx(WIDE_SAFETY * 0.2 / (1.5**2 - 1.0))
    assert (found.multiple, found.rule) == (None, "factor 3")


def test_slow_series_takes_the_large_factor():
    found = grid_convergence(SIZES, power(0.3, share=2.0), estimate=1.0)
    assert (found.kind, found.factor) == ("irregular", WIDE_SAFETY)


def test_accidental_agreement_of_two_meshes_does_not_narrow_the_band():
    found = grid_convergence((0.9, 0.6, 0.4), [10.0, 10.9, 10.9 + 1e-9], estimate=1e-6)
    assert found.kind == "irregular"
    assert found.high - found.value == pytest.approx(2.4e-6)  # bounded by the estimate
    assert found.rule == "2.4 times the estimate at the place"
    wide = grid_convergence((0.9, 0.6, 0.4), [10.0, 10.9, 10.9 + 1e-9], estimate=10.0)
    assert wide.high - wide.value >= FLOOR * 10.0


def test_two_meshes_take_the_large_factor_and_the_elements_order():
    found = grid_convergence((1.0, 0.5), [10.0, 11.0], estimate=0.1)
    assert (found.kind, found.order) == ("two meshes", None)
    assert found.index == pytest.approx(WIDE_SAFETY * 1.0 / 3.0 / 11.0)
    assert discretisation_source(found).text == "discretisation (two meshes, no observed order: factor 3)"
    least = grid_convergence((1.0, 0.5), [10.0, 11.0], estimate=0.5)
    assert least.high - least.value == pytest.approx(ALONE * 0.5)
    assert discretisation_source(least).text == "discretisation (two meshes, no observed order: fourfold estimate)"


def test_one_mesh_is_given_four_times_its_estimate():
    found = grid_convergence([1.0], [10.0], estimate=0.4)
    assert (found.low, found.high) == pytest.approx((10.0 - 1.6, 10.0 + 1.6))


def test_estimate_bounds_the_index_from_below_and_above():
    tight = grid_convergence(SIZES, power(2.0, share=1e-6), estimate=0.1)
    assert tight.index == pytest.approx(FLOOR * 0.1 / tight.value)
    wide = grid_convergence(SIZES, power(0.55, share=2.0), estimate=0.2)
    assert wide.index == pytest.approx(CEILING * 0.2 / wide.value)


def test_estimate_does_not_narrow_a_number_that_moves_more_than_it():
    values = power(0.55, share=-8.0)
    found = grid_convergence(SIZES, values, estimate=1e-3)
    assert found.high - found.value >= abs(values[-1] - values[-2])


def test_growing_number_has_no_limit():
    values = [size**-0.4555 for size in SIZES]
    found = grid_convergence(SIZES, values, estimate=0.1, sharp=True)
    assert found.kind == "growing"
    assert found.order == pytest.approx(-0.4555)
    assert math.isinf(found.index)
    assert math.isinf(found.high)


def test_away_from_edges_a_fourth_mesh_must_show_that_a_number_grows():
    three = grid_convergence(SIZES, [size**-0.4555 for size in SIZES], estimate=0.1)
    assert (three.kind, three.factor) == ("irregular", WIDE_SAFETY)
    assert three.suspect
    assert math.isfinite(three.high)
    sizes = (*SIZES, 0.27)
    four = grid_convergence(sizes, [size**-0.4555 for size in sizes], estimate=0.1)
    assert four.kind == "growing"
    assert math.isinf(four.high)


@pytest.mark.parametrize("sharp", [False, True])
@pytest.mark.parametrize(
    ("values", "estimate", "true"),
    [
        ((0.99, 0.9915, 0.9937), 0.02, 0.9949),  # made up to end as the starter's coupler did; 0.9949 is measured
        ((10.0, 10.05, 10.15), 0.01, 10.2),  # above the estimate, but 1 % of the value
        ((10.0, 10.4, 11.2), 1.0, 11.0),  # 7 % of the value, but below the estimate
    ],
)
def test_small_steps_do_not_grow(values, estimate, true, sharp):
    found = grid_convergence((0.9, 0.6, 0.4), values, estimate=estimate, sharp=sharp)
    assert (found.kind, found.factor) == ("irregular", WIDE_SAFETY)
    assert found.low < true < found.high


def test_a_rise_that_did_not_last_is_irregular():
    """A crank's 10.5 mm pin in its 12 mm eye, 90° law; 26.35 MPa on 123,000 elements."""
    sizes, values = (1.654, 0.955, 0.638, 0.422), (20.511, 24.080, 24.401, 26.101)
    found = grid_convergence(sizes, values, estimate=0.494)
    assert (found.kind, found.multiple) == ("irregular", None)
    assert found.low < 26.347 < found.high


def test_an_order_too_high_is_an_accident():
    """The same crank under the 180° law; 21.82 MPa on 123,000 elements (bore 36, size 0.25 mm, fillet 0.3 mm).

    A band of 1.5 times the estimate ended at 21.43; finer meshes went on to 21.14 and 21.72 MPa.
    """
    found = grid_convergence((1.661, 0.948, 0.632), (16.982, 19.942, 20.295), estimate=0.757)
    assert found.order > 3.0
    assert (found.kind, found.factor) == ("irregular", WIDE_SAFETY)
    assert found.low < 21.823 < found.high


def test_band_names_the_sharp_edges_that_it_leaves_out():
    found = grid_convergence([1.0], [10.0], estimate=0.4)
    assert discretisation_source(found).text == "discretisation (estimated on one mesh, fourfold)"
    sharp = discretisation_source(found, sharp_edges=3)
    assert "without the stress at sharp edges (3), below 50% of the peak" in sharp.text


def test_a_constant_is_known_to_its_estimate():
    found = grid_convergence(SIZES, [3.0, 3.0, 3.0], estimate=0.0)
    assert (found.low, found.high) == (3.0, 3.0)


def test_zero_has_no_width():
    assert grid_convergence([1.0], [0.0], estimate=0.0).index == 0.0


def test_meshes_too_alike_are_refused():
    with pytest.raises(CannotRunError, match="do not fall"):
        grid_convergence((1.0, 0.95), (1.0, 1.1), estimate=0.1)
    with pytest.raises(CannotRunError, match="0 sizes"):
        grid_convergence((), (), estimate=0.1)


@pytest.mark.parametrize(
    ("degrees", "exponent"),
    [(270.0, 0.544484), (360.0, 0.5), (225.0, 0.673583), (315.0, 0.505010)],  # as tabulated for sharp notches
)
def test_williams_exponent(degrees, exponent):
    assert williams_exponent(math.radians(degrees)) == pytest.approx(exponent, abs=2e-6)


def test_no_exponent_for_a_convex_edge():
    with pytest.raises(ValueError, match="not re-entrant"):
        williams_exponent(math.radians(90.0))
