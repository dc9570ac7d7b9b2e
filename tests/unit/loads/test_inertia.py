"""Inertia and carried masses at a pose: against kinetostatics, closed forms, and for the balance of a link."""

import math
from pathlib import Path

import numpy as np
import pytest
from motion_poses import kinetostatics

from alula.fea.beam.cut_free import beam_loads, link_loads
from alula.fea.beam.theory import check_beam
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.motion import solve_motion
from alula.loads.acting.weight import inertia_loads
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PartMass
from alula.loads.records.carried import CarriedBody, CarriedSpread, mass_of
from alula.loads.records.load_case import gravity
from alula.loads.states.actions import acting_loads, placed, stated_loads
from alula.loads.states.masses import laden_masses, together
from alula.loads.statics.statics import solve_statics

SPEED = 31.0
FILE = str(Path(__file__).with_name("four-bar-laden.toml"))


@pytest.fixture(scope="module")
def case():
    """A four-bar with inertia, a spread mass and a rigid body hung off its rocker."""
    return read_case(
        FILE,
        [f'load_cases.turning.speed="{SPEED} rad/s"'],
    )


@pytest.fixture(scope="module")
def masses(case):
    """Masses that no geometry kernel has to find; off the axes, so that no term of the moments vanishes."""
    return {
        link: PartMass(mass=(i + 1) * 1e-5, centroid=np.array([20.0 + 7 * i, 1.5 - i]), inertia=0.01 * (i + 1))
        for i, link in enumerate(case.checked_links)
    }


def test_statics_with_inertia_are_kinetostatics_at_the_pose(case, masses) -> None:
    pose, load_case = case.solve_pose(), case.load_cases["turning"]
    found = solve_statics(pose, case.pinned_drive, acting_loads(case, load_case, placed(pose, SPEED), masses))
    laden = laden_masses(case, masses)
    motion = solve_motion(pose, [pose.angles["crank"]], speed=SPEED)
    weights = inertia_loads(motion.placement.at_rest, laden, gravity(load_case))
    other = kinetostatics(motion, case.pinned_drive, [*stated_loads(case, load_case), *weights], laden)
    largest = max(joint.magnitude for joint in found.joints.values())
    for name, reaction in found.joints.items():
        np.testing.assert_allclose(reaction.force[:2], other.forces[name][0], rtol=0, atol=1e-10 * largest)
    assert found.drive_torque == pytest.approx(float(other.drive_torque[0]), rel=1e-10)


def test_carried_masses_can_be_left_out(case, masses) -> None:
    pose = case.solve_pose()
    bare = case.load_cases["turning"].model_copy(update={"carried": False})
    place = placed(pose, SPEED)
    loads = acting_loads(case, bare, place, masses)
    assert len(loads) == len(masses)
    assert len(acting_loads(case, case.load_cases["turning"], place, masses)) == len(loads) + len(case.carried)


def test_rates_follow_from_positions(case) -> None:
    """Central differences of the pose itself, to what they can give."""
    pose = case.solve_pose()
    place = placed(pose, SPEED)
    step = 1e-4
    angle = pose.angles["crank"]
    near = [solve_motion(pose, [angle + k * step]) for k in (-1, 0, 1)]
    for link in case.linkage.moving:
        directions = [float(m.angle(link)[0]) for m in near]
        speed = SPEED * (directions[2] - directions[0]) / (2 * step)
        acceleration = SPEED**2 * (directions[2] - 2 * directions[1] + directions[0]) / step**2
        assert place.spin(link) == pytest.approx(speed, rel=1e-6)
        assert place.spin_rate(link) == pytest.approx(acceleration, rel=1e-5, abs=1e-3 * SPEED**2)


def test_every_link_balances_under_inertia(case, masses) -> None:
    """The beam refuses loads that do not balance to 1e-6; with inertia left out of one term they do not."""
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["turning"], placed(pose, SPEED), masses)
    reactions = solve_statics(pose, case.pinned_drive, loads)
    for link in case.checked_links:
        body, material = case.body(link), case.material_of(link)
        cut = link_loads("turning", link, body, reactions, loads)
        found = beam_loads(cut, body, material.density)
        assert found.imbalance < 1e-12
        assert np.abs(cut.resultant()).max() < 1e-10 * cut.size(1.0)
        assert check_beam(found, body.part.section, material.allowable).worst.equivalent > 0.0


def test_a_spread_mass_and_a_part_make_one_body() -> None:
    """A rod of 1 g over 60 mm beside a point of 2 g: Steiner's rule by hand."""
    own = PartMass(mass=2e-6, centroid=np.array([0.0, 6.0]), inertia=0.0)
    rod = CarriedSpread(link="x", start="A", end="B", mass="1 g")
    found = together(own, mass_of(rod, {"A": (30.0, 0.0), "B": (90.0, 0.0)}))
    assert found.mass == pytest.approx(3e-6)
    np.testing.assert_allclose(found.centroid, [20.0, 4.0])
    expected = 1e-6 * 60**2 / 12 + 1e-6 * (40**2 + 4**2) + 2e-6 * (20**2 + 2**2)
    assert found.inertia == pytest.approx(expected, rel=1e-12)


def test_a_rigid_body_is_a_rod_by_its_radius_of_gyration() -> None:
    rod = CarriedSpread(link="x", start="A", end="B", mass="1 g")
    body = CarriedBody(
        link="x", at="A", mass="1 g", centroid=("60 mm", "0 mm"), radius_of_gyration=f"{60 / math.sqrt(12)} mm"
    )
    points = {"A": (30.0, 0.0), "B": (90.0, 0.0)}
    one, other = mass_of(rod, points), mass_of(body, points)
    np.testing.assert_allclose(one.centroid, other.centroid)
    assert one.inertia == pytest.approx(other.inertia, rel=1e-12)


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ('carried.0.link="base"', "carried.0.link: 'base' is not a moving link"),
        ('carried.0.start="Z"', "link 'rocker' has no point 'Z'"),
        ('carried.0.end="O4"', "same station"),
        ('carried.1.at="Z"', "link 'rocker' has no point 'Z'"),
    ],
)
def test_bad_carried_masses_are_told(override: str, told: str) -> None:
    with pytest.raises(CaseError, match=told):
        read_case(FILE, [override])
