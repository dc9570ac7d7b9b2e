import pytest

from alula.fea.beam.holes import net_tension, tube_hole_factors
from alula.geometry.base.errors import CannotRunError


def test_eye_under_its_pin() -> None:
    assert net_tension(-12.0, 7.0, 1.5, 4.0) == pytest.approx(12 / 22)
    with pytest.raises(CannotRunError, match="leaves no section"):
        net_tension(1.0, 3.0, 3.0, 1.0)


def test_small_hole_triples_the_stress() -> None:
    assert tube_hole_factors(5.0, 2.5, 1e-9) == pytest.approx((3.0, 3.0))


def test_solid_bar_with_a_hole_of_a_fifth() -> None:
    # d_i = 0, d/D = 0.2: 3 + 0.427/5 + 11.357/25 and 3 - 6.25/5 + 41/25 - 45/125.
    assert tube_hole_factors(5.0, 0.0, 1.0) == pytest.approx((3.53968, 3.03))


@pytest.mark.parametrize("sizes", [(5.0, 4.8, 1.0), (5.0, 2.5, 2.5), (5.0, 2.5, 0.0)])
def test_outside_the_fits_there_is_no_factor(sizes: tuple[float, float, float]) -> None:
    with pytest.raises(CannotRunError, match="handbook"):
        tube_hole_factors(*sizes)
