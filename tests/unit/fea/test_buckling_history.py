"""Euler's factor over a motion, against the check of single poses."""

import numpy as np
import pytest

from fea.beam import BeamCheck, check_beam, euler_load, internal_forces
from fea.buckling_check import column
from fea.buckling_history import axial_compression, buckling_factors, factors_over_motion
from fea.cut_free import beam_loads
from fea.link_history import LinkHistory, link_histories
from geometry.body_rules import hand_section
from loads.case import Case
from loads.case_file import read_case
from loads.case_motion import solve_case_motion

CASES = [
    ("owl-wing-static", ["motion.poses=7", 'motion.range=["228.15 deg", "200 deg"]']),
    ("ornithopter", ["motion.poses=7"]),
    ("flapping-wing-chosen", ["motion.poses=7"]),
]


def at_pose(case: Case, link: str, history: LinkHistory, pose: int) -> BeamCheck:
    material = case.material_of(link)
    loads = beam_loads(history.at(pose), history.body, material.density, history.mass)
    return check_beam(loads, hand_section(history.body), material.allowable)


@pytest.mark.parametrize(("name", "overrides"), CASES)
def test_every_pose_has_the_factor_of_its_own_beam(name: str, overrides: list[str]) -> None:
    case = read_case(name, overrides)
    moved = solve_case_motion(case)
    compared = 0
    for link in case.checked_links:
        if case.links[link].arms:
            continue  # the beam of one pose takes an arm's mass onto the axis, where turning does not balance it
        for history in link_histories(moved, link):
            found = factors_over_motion(case, link, history)
            for pose in np.flatnonzero(np.isfinite(found)):
                beam = at_pose(case, link, history, int(pose))
                expected = column(case, link, beam)
                assert expected is not None
                section = beam.section
                load = euler_load(
                    case.material_of(link).youngs_modulus,
                    min(section.i_y, section.i_z),
                    expected.length,
                    expected.effective_length,
                )
                # The beam is sampled at 33 stations of each interval, the history has the parabola's own extreme.
                assert found[pose] == pytest.approx(load / expected.compression, rel=2e-3)
                compared += 1
            for pose in np.flatnonzero(np.isinf(found)):
                assert column(case, link, at_pose(case, link, history, int(pose))) is None
    assert compared > 10


def test_compression_is_that_of_the_internal_forces() -> None:
    """The largest within an interval, where turning mass makes the force a parabola."""
    case = read_case("ornithopter", ["motion.poses=5"])
    moved = solve_case_motion(case)
    for history in link_histories(moved, "rod"):
        compression, _, (start, end) = axial_compression(case, "rod", history)
        inside = np.linspace(start + 1e-6, end - 1e-6, 400)
        for pose in range(history.poses):
            forces = internal_forces(
                beam_loads(history.at(pose), history.body, case.material_of("rod").density, history.mass)
            )
            sampled = max(-forces.at(float(x))[0] for x in inside)
            assert compression[pose] == pytest.approx(max(sampled, 0.0), rel=1e-3, abs=1e-9 * np.abs(compression).max())


def test_poses_are_told_apart() -> None:
    case = read_case("owl-wing-static")
    factor, load = buckling_factors(
        case, "CH", np.array([1.0, 0.0, np.nan, 2.0]), np.array([False, False, False, True]), (0.0, 124.0)
    )
    assert factor[0] == pytest.approx(load[0])
    assert np.isinf(factor[1])
    assert np.isnan(factor[2])
    # Beyond its pins the link is a cantilever of its whole length, before that a column between its pins at C and D.
    assert load[3] / load[0] == pytest.approx((77.0 / (2.0 * 124.0)) ** 2)
    assert factor[3] == pytest.approx(load[3] / 2.0)
