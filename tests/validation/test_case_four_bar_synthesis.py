"""The four-bar of Arango and Hurtado as a built-in case: lengths, precision points, sag by hand."""

import math

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.commands.synthesis import PUBLISHED_GROUND, PUBLISHED_POINTS, read_synthesis


@pytest.fixture(scope="module")
def case():
    return read_case("four-bar-synthesis")


@pytest.fixture(scope="module")
def synthesis():
    return read_synthesis(PUBLISHED_POINTS, PUBLISHED_GROUND)


def test_the_case_has_the_synthesised_lengths(case, synthesis) -> None:
    bar, ground = synthesis.four_bar, case.links["d"].points
    assert ground["O4"][0] - ground["O2"][0] == bar.d
    for link, end in (("a", "A"), ("b", "B"), ("c", "B")):
        assert case.links[link].points[end][0] == pytest.approx(getattr(bar, link), abs=1e-9)


def test_the_published_lengths_hold_to_their_digits(case) -> None:
    """Arango and Hurtado: a, b, c [m] for d = 10 m."""
    found = [case.links[link].points[end][0] / 1e3 for link, end in (("a", "A"), ("b", "B"), ("c", "B"))]
    np.testing.assert_allclose(found, [1.708728038, 10.34391129, 1.997889664], rtol=0, atol=5.1e-9)


def test_the_motion_passes_all_three_points_on_one_branch(case, synthesis) -> None:
    """By the general solver, from the first point on; a drive at O2 needs no other configuration."""
    pose = case.solve_pose()
    angles = np.mod([point.phi for point in synthesis.points], 2 * math.pi)
    assert case.motion.range == pytest.approx((angles[0], angles[1]), abs=1e-12)
    assert angles[0] < angles[2] < angles[1]
    motion = solve_motion(pose, angles)
    for link, wanted in (("b", "theta"), ("c", "psi")):
        stated = [getattr(point, wanted) for point in synthesis.points]
        np.testing.assert_allclose(motion.angle(link), stated, atol=1e-9)
    assert not solve_case_motion(case).dead_points


@pytest.mark.converged
def test_the_check_ends_in_pass_and_the_sag_is_that_of_a_beam() -> None:
    """Link b as a simple beam under its weight: 5 q L^4 / (384 E I); couples of layers bend it across, too."""
    case = edited("four-bar-synthesis", ['layer_spacing="0 mm"'])
    result = check_case(case, fidelity="solid")
    assert result.verdict is Verdict.PASS
    part, material = case.parts["bar"], case.material_of("b")
    weight = part.width * part.thickness * material.density * 9810.0
    length = case.links["b"].points["B"][0]
    sag = 5 * weight * length**4 / (384 * material.youngs_modulus * part.thickness * part.width**3 / 12)
    found = result.load_cases["weight"].links["b"]
    assert found.fidelity == "solid"
    assert found.displacement_max.value == pytest.approx(sag, rel=0.01)
