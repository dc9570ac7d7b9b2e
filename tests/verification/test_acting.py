"""The loads of every kind of thing that acts are the gradient of its energy, and a new kind is one class."""

import itertools
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from sprung_cases import CROWN, FOUR_BAR, HANG, LEVER, case_of
from torque_spring import TorqueCase

from alula.fea.frame.spring import FrameSpring
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.placement import vector
from alula.loads.acting.acting import loads_of
from alula.loads.acting.sizes import places
from alula.loads.acting.springs import TurnSpring
from alula.loads.acting.sprung import Sprung
from alula.loads.acting.stop import Bound
from alula.loads.acting.weight import Weight
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PartMass, PointLoad
from alula.loads.states.actions import acting_on, bounds, lasting
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.kinetostatics import work
from alula.reports.sections.springs import motion_springs, spring_sentences

MORE = """
[springs.coiled]
about = "B"
torque = "25 N*mm"
[tendons.slack]
through = [{ link = "base", at = "E" }, { link = "rocker", at = "Q" }]
stiffness = "0.4 N/mm"
free_length = "400 mm"
[stops.least]
joint = "B"
at_least = "-170 deg"
[[carried]]
link = "rocker"
start = "D"
end = "C"
mass = "30 g"
[[carried]]
link = "coupler"
at = "P"
mass = "50 g"
centroid = ["45 mm", "40 mm"]
[load_cases.own]
own_weight = true
moments = [{ link = "coupler", at = "P", moment = ["0 N*mm", "0 N*mm", "70 N*mm"] }]
[[load_cases.own.forces]]
link = "coupler"
at = "P"
force = ["3 N", "-2 N"]
[[load_cases.own.forces]]
link = "rocker"
at = "Q"
force = ["3 N", "-2 N"]
axes = "link"
[[load_cases.own.spread]]
link = "coupler"
start = "B"
end = "C"
total = ["1 N", "-4 N"]
[[load_cases.own.spread]]
link = "rocker"
start = "D"
end = "C"
total = ["1 N", "-4 N"]
axes = "link"
"""
MASSES = {"coupler": PartMass(mass=4e-5, centroid=np.array([30.0, 8.0]), inertia=0.02)}
FOLLOWING = ("DeadLoad 1", "DeadLoad 4")
STEP = 1e-5


def four_bar():
    stated = FOUR_BAR.replace('load_cases.own.title = "Springs alone"\n', "")
    return TorqueCase.model_validate({**tomllib.loads(stated + MORE), "massless": ["crank"]})


def every():
    """Return one of each kind, by a name that tells it."""
    pose = {"coordinate": "bar", "angle": "40 deg", "near": {"rod": "-40 deg"}, "equilibrium": True}
    case, slider = four_bar(), case_of(CROWN, pose=pose, stops={"wall": {"joint": "T", "at_most": "95 mm"}})
    own = case.load_cases["own"]
    found = [(case, one) for one in (*acting_on(case, own, MASSES, inert=False), *bounds(case).values())]
    found += [(slider, one) for one in bounds(slider).values()]
    return {f"{type(one).__name__} {getattr(one, 'name', n)}": pair for n, pair in enumerate(found) for one in pair[1:]}


EVERY = every()


def energy(one, place):
    """Return what one of each kind stores, but for a constant; None of what turns with its link, which has none."""
    if isinstance(one, Weight):
        return one.potential(place)
    if isinstance(one, Bound):
        return np.zeros(place.shape)
    if isinstance(one, Sprung):
        size, law = one.along.of(place), one.law
        return law.borne(size) ** 2 / (2.0 * law.stiffness) if law.stiffness else law.borne(size) * (size - law.size)
    if one.load.axes == "link":
        return None
    link = one.load.link
    if isinstance(one.load, PointLoad):
        at, wrench = vector(place.position(link, one.load.point)), one.load.wrench
        return -(at @ wrench[:3]) - place.angle(link) * wrench[5]
    at, way = vector(place.origin(link)), vector(place.direction(link))
    return -(at @ one.load.force) - way @ one.load.first_moment


def beside(place, number):
    steps = STEP * np.eye(place.q.shape[-1])[number]
    return (replace(place, q=place.q + sign * steps) for sign in (1.0, -1.0))


@pytest.mark.parametrize("name", EVERY)
def test_loads_are_the_gradient_of_the_energy(name):
    """By every angle and travel, closure left aside; against a moved pose, so that no two points lie in one line."""
    case, one = EVERY[name]
    place = case.stated_pose.placement
    place = replace(place, q=place.q + 0.05 * np.arange(1.0, place.q.shape[-1] + 1.0))
    assert (energy(one, place) is None) == (name in FOLLOWING)
    if name in FOLLOWING:
        return
    for number, qdot in enumerate(np.eye(place.q.shape[-1])):
        ahead, behind = (float(energy(one, at)) for at in beside(place, number))
        done = float(work(one.loads(place), place, replace(place, qdot=qdot)))
        assert done == pytest.approx(-(ahead - behind) / (2.0 * STEP), rel=1e-6, abs=1e-5)


@pytest.mark.parametrize("name", [name for name in EVERY if name.startswith("Sprung")])
def test_the_tangent_is_the_derivative_of_the_loads(name):
    """At a place where no two points lie in one line, by every place and turn of its ends; of a cord that pulls."""
    case, one = EVERY[name]
    place = case.stated_pose.placement
    place = replace(place, q=place.q + 0.05 * np.arange(1.0, place.q.shape[-1] + 1.0))
    at, angles = places(place, one.ends), np.zeros(len(one.ends))
    start = float(one.along.of(place)) - float(one.along.between(at, angles))

    def resisted(moved, turned):
        effort = one.law.wanted(start + float(one.along.between(moved, turned)))
        return (effort * one.along.gradient(moved)).ravel()

    size = float(one.along.of(place))
    found = one.bent(at, float(one.law.wanted(size)), one.law.slope(size))
    for number, (end, axis) in enumerate(itertools.product(range(len(at)), range(3))):
        step = STEP * np.eye(len(at))[end]
        ends = [
            resisted(at + sign * step * (1.0, 1j, 0.0)[axis], sign * step * float(axis == 2)) for sign in (1.0, -1.0)
        ]
        assert found[:, number] == pytest.approx((ends[0] - ends[1]) / (2.0 * STEP), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize("factor", [1.0, 0.4])
@pytest.mark.parametrize("name", [name for name in EVERY if name.startswith("Sprung")])
def test_a_frame_softens_and_shares_what_acts_between_its_nodes(name, factor):
    """λ times the effort as the frame stands, and what it gains over the softness."""
    case, one = EVERY[name]
    pose, soft = case.stated_pose, 3.0
    spring = FrameSpring.of(one, pose, {}).softened(1.5).softened(2.0)
    rng = np.random.default_rng(3)
    moved, turns = rng.uniform(-4.0, 4.0, (len(one.ends), 2)), rng.uniform(-0.2, 0.2, len(one.ends))
    at = places(pose.placement, one.ends)
    grown = one.along.between(at + moved @ [1.0, 1j], turns) - one.along.between(at, np.zeros(len(turns)))
    still, now = (one.law.wanted(size) for size in (spring.size, spring.size + grown))
    start = factor * still if still > 0.0 or not one.law.pulls else still / soft
    effort = start + (now - still) / soft
    if one.law.pulls:
        start, effort = max(start, 0.0), max(effort, 0.0)
    expected = effort * one.along.gradient(at + moved @ [1.0, 1j]) - start * one.along.gradient(at)
    assert spring.resists(moved, turns, factor)[0] == pytest.approx(expected, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("factor", [1.0, 0.4])
def test_a_cord_in_a_frame_comes_taut_where_it_would_without_loads(factor):
    """Slack by 1 mm, it pulls by what is more, whatever the share of the loads; softer, with less."""
    case, slack = EVERY["Sprung slack"]
    length = float(slack.along.of(case.stated_pose.placement))
    one = replace(slack, law=replace(slack.law, size=length + 1.0))
    spring = FrameSpring.of(one, case.stated_pose, {}).softened(2.0)
    way = one.along.gradient(spring.places)
    moved = np.array([[0.0, 0.0], 4.0 * way[1, :2]])
    assert spring.resists(0.2 * moved, np.zeros(2), factor)[0] == pytest.approx(0.0, abs=0.0)
    assert spring.resists(moved, np.zeros(2), factor)[0] == pytest.approx(0.2 * 3.0 * way, rel=1e-9, abs=1e-12)


def test_air_on_wings_follows_from_how_they_move():
    """It has loads with rates alone."""
    case = read_case("flapping-wing-chosen")
    title = next(name for name, one in case.load_cases.items() if one.flapping is not None)
    motion = solve_case_motion(case)
    place = motion.moved[title].placement.chosen(1)
    acting = acting_on(case, case.load_cases[title], motion.masses, inert=True)
    [air] = [one for one in acting if type(one).__name__ == "FlappingAir"]
    assert air.loads(place)
    assert air.loads(place.at_rest) == ()


def lever(**tables):
    """Return a lever of 100 mm that hangs under 2 N, with a spring of constant torque and a weak one."""
    found = tomllib.loads(LEVER + HANG)
    springs = {"coiled": {"about": "O", "torque": "150 N*mm"}, "back": SPRING}
    return TorqueCase.model_validate({**found, "springs": springs, **tables})


SPRING = {"joint": "O", "stiffness": "100 N*mm/rad", "free_angle": "0 deg"}


def test_a_new_kind_goes_from_the_case_to_where_it_stands():
    """150 N mm - 100 N mm/rad t = 200 N mm cos t, of which the lever's angle t is below the horizontal."""
    statics = solve_case_statics(lever())
    [standing] = statics.standing.values()
    t = statics.pose.angles["lever"]
    assert isinstance(standing.case.springs["back"], TurnSpring)
    assert 150.0 - 100.0 * t == pytest.approx(200.0 * np.cos(t), abs=1e-6)
    assert t < -0.1
    assert standing.stiffness == pytest.approx(100.0 - 200.0 * np.sin(t), rel=1e-6)
    assert next(iter(spring_sentences(standing))).endswith("deg, 150.0 N·mm counter-clockwise on lever")
    [force] = statics.forces.values()
    assert force.reactions.drive_torque == pytest.approx(0.0, abs=1e-6)
    assert force.reactions.joints["O"].wrench[:2] == pytest.approx([0.0, 2.0], abs=1e-9)


def test_a_new_kind_is_held_by_the_drive_in_statics_and_over_a_motion():
    """Held level the drive lacks 200 - 150 N mm; over a motion its work is that of the load and of both springs."""
    pose, drive = {"coordinate": "lever", "angle": "0 deg"}, {"link": "lever", "joint": "O"}
    motion = {"speed": "1 rad/s", "range": ["0 deg", "90 deg"], "poses": 91, "inertia": False}
    case = lever(pose=pose, drive=drive, motion=motion)
    [found] = solve_case_statics(case).forces.values()
    assert found.reactions.drive_torque == pytest.approx(50.0, rel=1e-12)
    moved = solve_case_motion(case)
    t, place = moved.motion.angles, moved.motion.placement
    expected = 200.0 * np.cos(t) - 150.0 + 100.0 * t
    assert moved.torque["hang"] == pytest.approx(expected, abs=1e-9)
    stored = sum(np.asarray(energy(one, place)) for one in acting_on(case, case.load_cases["hang"], {}, inert=False))
    gained = np.trapezoid(moved.torque["hang"], t)
    assert stored[-1] - stored[0] == pytest.approx(gained, rel=1e-4)
    assert [name for name, _ in motion_springs(moved)][:2] == ["coiled angle [deg]", "coiled moment [N mm]"]
    assert [mark.kind for one in lasting(case) for mark in one.marks(case.stated_pose.placement)] == ["spiral"] * 2
    assert sum(load.wrench[5] for load in loads_of(lasting(case), case.stated_pose.placement)) == pytest.approx(0.0)


def test_a_new_kind_is_held_against_the_rules_of_its_joint():
    with pytest.raises(CaseError, match=r"springs\.coiled\.joint"):
        lever(springs={"coiled": {"about": "X", "torque": "1 N*mm"}})
