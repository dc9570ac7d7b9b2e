import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.synthesis import DRIVES, driven, freudenstein_residual, synthesise


def pairs(bar: FourBar, phis, branch="open"):
    """Return (θ, ψ) of a known four-bar at three input angles."""
    position = bar.position(np.asarray(phis), branch=branch)
    return [float(x) for x in position.theta3], [float(x) for x in position.theta4]


@given(
    st.floats(0.5, 5), st.floats(0.5, 5), st.floats(0.5, 5), st.floats(0.5, 5),
    st.lists(st.floats(0.05, 0.95), min_size=3, max_size=3, unique=True), st.sampled_from(["open", "crossed"]),
)  # fmt: skip
def test_three_poses_of_a_four_bar_give_it_back(a, b, c, d, fractions, branch):
    assume(2 * max(a, b, c, d) < (a + b + c + d) * 0.999)
    bar = FourBar(a=a, b=b, c=c, d=d)
    low, high = bar.input_range().intervals[0]
    phis = [low + (high - low) * fraction for fraction in fractions]
    assume(min(math.hypot(a * math.cos(phi) - d, a * math.sin(phi)) for phi in phis) > 1e-6)
    theta, psi = pairs(bar, phis, branch)
    matrix = np.column_stack([np.cos(psi), -np.cos(theta), np.ones(3)])
    assume(np.linalg.cond(matrix) < 1e4)
    found = synthesise(theta, psi, d)
    np.testing.assert_allclose([found.four_bar.a, found.four_bar.b, found.four_bar.c], [a, b, c], rtol=1e-8, atol=0)
    assert (found.b_turned, found.c_turned) == (False, False)
    for point, phi in zip(found.points, phis, strict=True):
        assert math.cos(point.phi - phi) == pytest.approx(1.0, abs=1e-9)
        assert point.branches["a"] in (branch, None)


def test_rotation_of_the_drawing_does_not_enter_but_scale_does():
    theta, psi = np.radians([0, 20, 5]), np.radians([30, 110, 130])
    one, ten = synthesise(theta, psi, 1.0).four_bar, synthesise(theta, psi, 10.0).four_bar
    np.testing.assert_allclose([10 * one.a, 10 * one.b, 10 * one.c], [ten.a, ten.b, ten.c], rtol=1e-12)
    mirrored = synthesise(-theta, -psi, 10.0).four_bar
    np.testing.assert_allclose([mirrored.a, mirrored.b, mirrored.c], [ten.a, ten.b, ten.c], rtol=1e-12)


def test_negative_lengths_are_links_turned_by_half_a_turn():
    bar = FourBar(a=2.0, b=4.0, c=3.5, d=5.0)
    theta, psi = pairs(bar, [0.4, 1.1, 1.9])
    found = synthesise([angle + math.pi for angle in theta], psi, bar.d)
    assert found.K[0] < 0 < found.K[1]
    assert (found.b_turned, found.c_turned) == (True, False)
    np.testing.assert_allclose([found.four_bar.a, found.four_bar.b, found.four_bar.c], [2.0, 4.0, 3.5], rtol=1e-9)
    assert [point.phi for point in found.points] == pytest.approx([0.4, 1.1, 1.9], abs=1e-9)
    assert any(finding.kind == "sign" and "link b" in finding.sentence for finding in found.findings)


def test_a_turned_coupler_changes_theta_alone():
    bar = FourBar(a=2.0, b=4.0, c=3.5, d=5.0)
    theta, psi = pairs(bar, [0.7, 1.1, 0.9])
    plain, found = synthesise(theta, psi, bar.d), synthesise([angle + math.pi for angle in theta], psi, bar.d)
    assert (found.b_turned, found.c_turned) == (True, False)
    for turned, lock in zip(found.lock_ups, plain.lock_ups, strict=True):
        assert (turned.phi, turned.psi) == pytest.approx((lock.phi, lock.psi), abs=1e-6)
        assert math.cos(turned.theta - lock.theta) == pytest.approx(-1.0, abs=1e-9)
    defects = [[(f.kind, f.drive) for f in x.findings if "defect" in f.kind] for x in (found, plain)]
    assert defects[0] == defects[1]
    assert ("order-defect", "b") in defects[0]


def test_a_turned_output_changes_psi_alone():
    bar = FourBar(a=6.0, b=3.0, c=5.0, d=7.5)
    theta, psi = pairs(bar, [0.7, 0.9, 1.1])
    plain, found = synthesise(theta, psi, bar.d), synthesise(theta, [angle + math.pi for angle in psi], bar.d)
    assert (found.b_turned, found.c_turned) == (False, True)
    assert any(finding.kind == "sign" and "link c" in finding.sentence for finding in found.findings)
    for turned, point in zip(found.points, plain.points, strict=True):
        assert turned.phi == pytest.approx(point.phi, abs=1e-9)
        assert turned.branches == point.branches
    for turned, lock in zip(found.lock_ups, plain.lock_ups, strict=True):
        assert (turned.phi, turned.theta) == pytest.approx((lock.phi, lock.theta), abs=1e-6)
        assert math.cos(turned.psi - lock.psi) == pytest.approx(-1.0, abs=1e-9)
    defects = [[(f.kind, f.drive) for f in x.findings if "defect" in f.kind] for x in (found, plain)]
    assert defects[0] == defects[1]


def test_a_turned_output_keeps_its_order():
    bar = FourBar(a=6.0, b=3.0, c=5.0, d=7.5)
    theta, psi = pairs(bar, [0.7, 1.1, 0.9])
    found = synthesise(theta, [angle + math.pi for angle in psi], bar.d)
    plain = synthesise(theta, psi, bar.d)
    defects = [[(f.kind, f.drive) for f in x.findings if "defect" in f.kind] for x in (found, plain)]
    assert defects[0] == defects[1]
    assert ("order-defect", "c") in defects[0]


def test_nearly_equal_pairs_are_told_as_ill_conditioned():
    bar = FourBar(a=2.0, b=4.0, c=3.5, d=5.0)
    found = synthesise(*pairs(bar, [0.4, 0.401, 0.402]), bar.d)
    assert found.condition > 1e6
    (finding,) = [finding for finding in found.findings if finding.kind == "conditioning"]
    assert "digits at best" in finding.sentence


def test_lock_ups_satisfy_freudenstein_and_end_the_range():
    found = synthesise(np.radians([0, 20, 5]), np.radians([30, 110, 130]), 10.0)
    bar = found.four_bar
    assert {lock.drive for lock in found.lock_ups} == set(DRIVES)
    for lock in found.lock_ups:
        assert abs(freudenstein_residual(found.K, lock.theta, lock.psi)) < 1e-12
        loop = bar.a * np.exp(1j * lock.phi) + bar.b * np.exp(1j * lock.theta) - bar.c * np.exp(1j * lock.psi) - bar.d
        assert abs(loop) < 1e-12
    theta = max(lock.theta for lock in found.lock_ups if lock.drive == "b")
    turned, at = driven(bar, "b"), theta + math.pi * found.b_turned
    opened, crossed = (float(turned.position(at - 1e-9, branch=branch).theta4) for branch in ("open", "crossed"))
    assert math.cos(opened - crossed) == pytest.approx(1.0, abs=1e-6)
    with pytest.raises(CaseError, match="stays open by"):
        turned.position(at + 1e-6)


def test_branch_defect_names_the_points():
    bar = FourBar(a=2.0, b=4.0, c=3.5, d=5.0)
    first, second = pairs(bar, [0.4, 1.1], "open"), pairs(bar, [1.9], "crossed")
    found = synthesise(first[0] + second[0], first[1] + second[1], bar.d)
    assert [point.branches["a"] for point in found.points] == ["open", "open", "crossed"]
    (defect,) = [f for f in found.findings if (f.drive, f.kind) == ("a", "branch-defect")]
    assert "open: 1, 2; crossed: 3" in defect.sentence


def test_order_defect_where_the_input_rocks():
    bar = FourBar(a=6.0, b=3.0, c=5.0, d=7.5)
    in_order, turned_back = (
        synthesise(*pairs(bar, [0.7, 0.9, 1.1]), 7.5),
        synthesise(*pairs(bar, [0.7, 1.1, 0.9]), 7.5),
    )
    assert not [f for f in in_order.findings if (f.drive, f.kind) == ("a", "order-defect")]
    (defect,) = [f for f in turned_back.findings if (f.drive, f.kind) == ("a", "order-defect")]
    assert "1, 3, 2" in defect.sentence


def test_circuit_defect_where_the_input_has_two_ranges():
    bar = FourBar(a=7.0, b=2.0, c=6.0, d=9.0)
    low, high = bar.input_range().intervals[0]
    middle = (low + high) / 2
    theta, psi = pairs(bar, [middle, middle + 0.05, -middle + 0.02])
    found = synthesise(theta, psi, bar.d)
    assert [finding.kind for finding in found.findings if finding.drive == "a" and "defect" in finding.kind] == [
        "circuit-defect"
    ]


@pytest.mark.parametrize(
    ("theta", "psi", "reason"),
    [
        ([0.1, 0.1, 0.5], [0.7, 0.7, 0.9], "pairs 1 and 2 have the same cosines"),
        ([0.1, 0.5, -0.1], [0.7, 0.9, -0.7], "pairs 1 and 3 have the same cosines"),
        (np.arccos([0.1, 0.3, 0.5]), np.arccos([0.2, 0.4, 0.6]), "lie on one straight line"),
    ],
)
def test_singular_systems_are_refused_with_the_reason(theta, psi, reason):
    with pytest.raises(CaseError, match=reason):
        synthesise(theta, psi, 10.0)


def test_other_bad_input_is_refused():
    with pytest.raises(CaseError, match="2 values of theta and 3 of psi"):
        synthesise([0.1, 0.2], [0.3, 0.4, 0.5], 1.0)
    with pytest.raises(CaseError, match="give three finite pairs"):
        synthesise([0.1, 0.2, math.nan], [0.3, 0.4, 0.5], 1.0)
    with pytest.raises(CaseError, match="d = -1 must be positive"):
        synthesise([0.1, 0.2, 0.3], [0.3, 0.4, 0.6], -1.0)
    # Pairs made to fulfil the equation with K1 = 0.
    theta = np.array([0.3, 0.7, 1.1])
    with pytest.raises(CaseError, match=r"K1 = .* so link b = d/K1 would be infinitely long"):
        synthesise(theta, theta - np.arccos(0.3 - 0.5 * np.cos(theta)), 1.0)


def test_driven_links_keep_their_angles():
    bar = FourBar(a=2.0, b=4.0, c=3.5, d=5.0)
    position = bar.position(0.7)
    theta, psi = float(position.theta3), float(position.theta4)
    by_b = driven(bar, "b")
    branch = by_b.branch_of(theta, 0.7)
    assert branch is not None
    assert float(by_b.position(theta, branch=branch).theta4) == pytest.approx(psi, abs=1e-12)
    by_c = driven(bar, "c")
    branch = by_c.branch_of(math.pi - psi, -theta)
    assert branch is not None
    assert float(by_c.position(math.pi - psi, branch=branch).theta4) == pytest.approx(math.pi - 0.7, abs=1e-12)
