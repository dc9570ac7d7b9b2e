"""Bending of a pin between layers against statics."""

import math

import numpy as np
import pytest

from alula.fea.beam.pin_between import largest_between
from alula.geometry.bodies.features import Ring

EYE = Ring(diameter=8.0, low=-2.0, high=2.0)


def about_first(wrench: np.ndarray, rise: float) -> np.ndarray:
    """What the first link gets: the opposite, moved down to its mid-plane."""
    found = -wrench
    found[3:] -= np.cross([0.0, 0.0, rise], wrench[:3])
    return found


def test_an_even_pressure_in_the_second_eye_makes_a_cantilever_of_the_pin() -> None:
    """All of the couple in the first: at its face the moment is F (gap + t/2), and inside it grows further."""
    force, rise = 10.0, 5.0
    wrench = np.array([6.0, 8.0, 0.0, 0.0, 0.0, 0.0])
    moment, shear = largest_between((EYE, EYE), (0.0, rise), (about_first(wrench, rise), wrench))
    # Along the first eye, from the face inwards: V = F (1 - x/t)(1 - 6 a x/t²), a = rise (``alula.fea.outcomes.pins``).
    x = np.linspace(0.0, 4.0, 200001)
    v = force * (1.0 - x / 4.0) * (1.0 - 6.0 * rise * x / 16.0)
    inside = force * (1.0 + 2.0) + np.cumsum(v) * (x[1] - x[0])
    assert moment == pytest.approx(inside.max(), rel=1e-4)
    assert shear == pytest.approx(np.abs(v).max(), rel=1e-3)


def test_equal_couples_leave_no_moment_in_the_middle_of_the_gap() -> None:
    """Each eye has F h/2; the largest moment stands inside the eyes, by symmetry alike in both."""
    rise = 6.0
    wrench = np.array([0.0, 10.0, 0.0, 30.0, 0.0, 0.0])  # M2 = h/2 F about x, and M1 the same
    first = about_first(wrench.copy(), rise)
    assert first[3] == pytest.approx(30.0)
    both = largest_between((EYE, EYE), (0.0, rise), (first, wrench))
    # From the middle of the gap of 2 mm, where nothing bends: F g/2 at the face, then inwards.
    x = np.linspace(0.0, 4.0, 200001)
    v = 10.0 * (1.0 - x / 4.0) * (1.0 - 3.0 * rise * x / 16.0)
    inside = 10.0 + np.cumsum(v) * (x[1] - x[0])
    assert both[0] == pytest.approx(np.abs(inside).max(), rel=1e-4)


def test_two_cheeks_bear_as_their_levers() -> None:
    """A mate off the middle of a fork: shear P a/(a + b) in the nearer cheek's gap, its couple as two forces."""
    fork = Ring(diameter=8.0, low=-5.0, high=5.0, gaps=((-4.0, 4.0),))
    thin = Ring(diameter=8.0, low=-0.01, high=0.01)
    wrench = np.array([0.0, 9.0, 0.0, 0.0, 0.0, 0.0])
    moment, shear = largest_between((fork, thin), (0.0, 1.5), (about_first(wrench.copy(), 1.5), wrench))
    arm, second = 4.5, 2.0 * (1.0 / 12.0 + 4.5**2)
    upper = 9.0 / 2.0 + 9.0 * 1.5 / second * arm  # even, and linear about the middle
    assert shear == pytest.approx(upper, rel=1e-6)
    assert moment == pytest.approx(upper * (arm - 1.5), rel=0.01)
    assert math.isfinite(moment)
