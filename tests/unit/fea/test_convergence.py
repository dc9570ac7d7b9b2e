import math

import pytest

from alula.fea.refine.convergence import grid_convergence, observed_order, williams_exponent
from alula.fea.refine.discretisation import discretisation_source
from alula.geometry.base.errors import CannotRunError
from alula.reports.sentences import told

SIZES = (1.0, 0.6, 0.4)
SAFETY = 1.25  # Roache (1998), section 5.6
ALONE, SEVERAL = 4.0, 2.25  # of the estimate, as docs/verification.md states them


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


def around(found):
    return found.value - found.low, found.high - found.value


@pytest.mark.parametrize("share", [2.0, -2.0])
def test_band_of_a_clean_series_is_its_error_times_the_factor(share):
    """f = f* + C h² is extrapolated exactly."""
    found = grid_convergence(SIZES, power(2.0, share=share), estimate=0.1)
    reach = SAFETY * 2.0 * 0.4**2
    assert found.kind == "monotone"
    assert around(found) == pytest.approx((reach, reach))
    assert found.index == pytest.approx(reach / found.value)
    assert told(found.rule) == "index with factor 1.25"


@pytest.mark.parametrize("last", [10.9 + 1e-9, 10.8])
def test_accidental_agreement_of_two_meshes_does_not_narrow_the_band(last):
    found = grid_convergence((0.9, 0.6, 0.4), [10.0, 10.9, last], estimate=0.0)
    left = 0.9 * 0.4**2 / (0.9**2 - 0.6**2)  # of the first two alone, on a mesh of 0.4
    assert around(found) == pytest.approx((SAFETY * left, SAFETY * left))


def test_the_last_step_counts_where_it_is_large():
    found = grid_convergence((0.9, 0.6, 0.4), [10.0, 10.1, 9.5], estimate=0.0)
    assert (found.kind, found.order) == ("irregular", None)
    assert found.high - found.value == pytest.approx(SAFETY * 0.6 / (1.5**2 - 1.0))


def test_estimate_bounds_the_index_from_below():
    found = grid_convergence(SIZES, power(2.0, share=1e-6), estimate=0.1)
    assert found.index == pytest.approx(SEVERAL * 0.1 / found.value)
    assert told(found.rule) == "2.25 times the estimate at the place"


def test_only_the_three_finest_count():
    three = grid_convergence(SIZES, power(1.5), estimate=0.1)
    four = grid_convergence((2.0, *SIZES), [50.0, *power(1.5)], estimate=0.1)
    assert (four.low, four.high, four.order) == (three.low, three.high, three.order)


def test_two_meshes_have_the_index_or_the_fourfold_estimate():
    found = grid_convergence((1.0, 0.5), [10.0, 14.0], estimate=0.1)
    assert (found.kind, found.order) == ("two meshes", None)
    reach = SAFETY * 4.0 / 3.0
    assert around(found) == pytest.approx((reach, reach))
    text = "discretisation (two meshes, no observed order: index with factor 1.25)"
    assert told(discretisation_source(found).text) == text
    least = grid_convergence((1.0, 0.5), [10.0, 10.1], estimate=0.5)
    assert around(least) == pytest.approx((ALONE * 0.5, ALONE * 0.5))
    text = "discretisation (two meshes, no observed order: 4 times the estimate at the place)"
    assert told(discretisation_source(least).text) == text


def test_one_mesh_is_given_four_times_its_estimate():
    found = grid_convergence([1.0], [10.0], estimate=0.4)
    assert (found.low, found.high) == pytest.approx((10.0 - 1.6, 10.0 + 1.6))


def test_growing_number_has_no_limit():
    values = [size**-0.4555 for size in SIZES]
    found = grid_convergence(SIZES, values, estimate=0.1, sharp=True)
    assert found.kind == "growing"
    assert found.order == pytest.approx(-0.4555)
    assert math.isinf(found.index)
    assert math.isinf(found.high)


def test_away_from_edges_a_fourth_mesh_must_show_that_a_number_grows():
    three = grid_convergence(SIZES, [size**-0.4555 for size in SIZES], estimate=0.1)
    assert three.kind == "monotone"
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
    assert found.kind == "monotone"
    assert found.low < true < found.high


@pytest.mark.parametrize(
    ("sizes", "values", "estimate", "true"),
    [
        ((1.654, 0.955, 0.638, 0.422), (20.511, 24.080, 24.401, 26.101), 0.494, 26.347),  # 90° of the hole
        ((1.661, 0.948, 0.632), (16.982, 19.942, 20.295), 0.757, 21.823),  # 180°, order 5
    ],
)
def test_a_thin_ring_is_held_although_its_order_misleads(sizes, values, estimate, true):
    """A crank's 10.5 mm pin in its 12 mm eye; true: on 123,000 elements (bore 36, size 0.25 mm, fillet 0.3 mm)."""
    found = grid_convergence(sizes, values, estimate=estimate)
    assert found.kind != "growing"
    assert found.low < true < found.high


def test_band_names_the_sharp_edges_that_it_leaves_out():
    found = grid_convergence([1.0], [10.0], estimate=0.4)
    assert told(discretisation_source(found).text) == "discretisation (estimated on one mesh, fourfold)"
    sharp = discretisation_source(found, sharp_edges=3)
    assert "without the stress at sharp edges (3), below 50% of the peak" in told(sharp.text)


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
