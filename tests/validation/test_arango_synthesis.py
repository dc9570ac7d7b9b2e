"""Arango and Hurtado, three-point function synthesis of a four-bar: the published figures, and which of them follow."""

import math

import numpy as np
import pytest

from alula.geometry.mechanisms.synthesis import driven, synthesise

THETA, PSI = np.radians([0, 20, 5]), np.radians([30, 110, 130])


@pytest.fixture(scope="module")
def found():
    return synthesise(THETA, PSI, 10.0)


def test_published_coefficients(found):
    np.testing.assert_allclose(found.K, [0.966752, 5.005281, 5.034075], atol=5.1e-7)
    assert found.condition == pytest.approx(76.849, abs=1e-3)
    assert (found.b_turned, found.c_turned) == (False, False)


def test_published_lengths(found):
    bar = found.four_bar
    np.testing.assert_allclose([bar.a, bar.b, bar.c], [1.708728038, 10.34391129, 1.997889664], rtol=0, atol=5.1e-9)


def test_every_precision_point_is_met(found):
    for point in found.points:
        assert abs(point.residual) < 1e-14
    phi = [math.degrees(point.phi) for point in found.points]
    np.testing.assert_allclose(phi, [35.7757, -103.6560, 158.4030], atol=5e-5)


def test_published_grashof_sums_make_a_triple_rocker(found):
    """The source writes the condition as s + l > p + q and calls the linkage Grashof; it is the reverse."""
    grashof = found.four_bar.grashof
    assert grashof.shortest_plus_longest == pytest.approx(12.05263933, abs=1.01e-8)
    assert grashof.other_two == pytest.approx(11.99788966, abs=5.1e-9)
    assert (grashof.inversion, grashof.satisfied) == ("triple-rocker", False)


def test_published_branches_hold_for_a_driven_link_c_alone(found):
    """Published: points 1 and 3 open, point 2 crossed. The source's motor sits at O2, which drives link a."""
    branches = {drive: [point.branches[drive] for point in found.points] for drive in ("a", "b", "c")}
    assert branches["c"] == ["open", "crossed", "open"]
    assert branches["a"] == ["open", "open", "open"]
    assert branches["b"] == ["crossed", "crossed", "crossed"]
    kinds = {drive: {f.kind for f in found.findings if f.drive in (None, drive)} for drive in ("a", "b", "c")}
    assert kinds["c"] == {"grashof", "branch-defect", "lock-up"}
    # The motor at O2 meets point 3 on its way from 1 to 2.
    assert kinds["a"] == {"grashof", "order-defect", "lock-up"}


def test_published_lock_up_is_not_a_pose_of_the_linkage(found):
    """Published: locks at θ = 20.715°, ψ = 102.878°. That pair misses the loop: at 20.715° ψ is 102.186° or 87.960°."""
    psi = [driven(found.four_bar, "b").position(math.radians(20.715), branch=way).theta4 for way in ("open", "crossed")]
    assert np.degrees(psi) == pytest.approx([87.960, 102.186], abs=1e-3)
    limits = {lock.drive: np.degrees([lock.phi, lock.theta, lock.psi]) for lock in found.lock_ups[::2]}
    np.testing.assert_allclose(limits["a"], [13.2583, -2.6913, -2.6913], atol=5e-5)
    np.testing.assert_allclose(limits["b"], [-84.7816, 20.9070, 95.2184], atol=5e-5)
    np.testing.assert_allclose(np.abs(limits["c"]), [170.9946, 9.0054, 137.4262], atol=5e-5)
