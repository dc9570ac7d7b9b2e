"""Envelopes of a crank-rocker: its loads over the motion, peaks among all nodes, dead points, verdicts, output."""

import csv
import html
import itertools
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import solid_meshes
from edited_cases import edited
from materials import with_material
from result_paths import compare
from told import tables_of

from alula.fea.asked.asked import Asked, asked
from alula.fea.beam.cut_free import beam_loads, link_loads
from alula.fea.beam.theory import check_beam
from alula.fea.buckling.buckling import buckling_outcomes
from alula.fea.check.kinds import BY_HAND
from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, Quantity, Subject, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.elements.space import displacement_space
from alula.fea.judging import bearing
from alula.fea.judging.bearing import bearing_outcome
from alula.fea.motion import envelope
from alula.fea.motion import envelope_outcomes as outcomes_over_motion
from alula.fea.motion.envelope import envelope_case, evaluated_poses
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.motion.envelope_result import LoadCaseEnvelope, VariantCurve
from alula.fea.motion.link_envelope import LinkMotion, _balanced, _scattered
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.loading import loading_over
from alula.fea.motion.mesh_factors import MeshFactors
from alula.fea.outcomes.fatigue import closed_history, missing_data, signed_stress
from alula.fea.outcomes.pins import stress_at, stress_of
from alula.fea.refine.refinement import START, Effort
from alula.fea.solid.stress import principal, stress_field, von_mises
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.superposition.peaks import deviator, largest, of_stress, signed_bounds
from alula.fea.superposition.unit_solutions import nodal_stress
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.meshing.mesh import mesh_body
from alula.loads.case.case_file import read_case
from alula.loads.records.check_spec import BearingCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.sentences import told as in_words

TOML = """
schema_version = 1
title = "Crank and rocker"
massless = ["crank", "coupler"]
[links.base]
ground = true
points.O2 = ["0 mm", "0 mm"]
points.O4 = ["60 mm", "0 mm"]
[links.crank]
points.O2 = ["0 mm", "0 mm"]
points.A = ["20 mm", "0 mm"]
[links.coupler]
points.A = ["0 mm", "0 mm"]
points.B = ["60 mm", "0 mm"]
[links.rocker]
part = "bar"
points.O4 = ["0 mm", "0 mm"]
points.B = ["40 mm", "0 mm"]
points.P = ["60 mm", "0 mm"]
end_patch = "4 mm"
[joints]
O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
A = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
O4 = { links = ["base", "rocker"], pin_diameter = "3 mm" }
[pose]
coordinate = "crank"
angle = "40 deg"
near = { coupler = "20 deg", rocker = "60 deg" }
[drive]
link = "crank"
joint = "O2"
[motion]
turn = true
speed = "300 rpm"
poses = 25
[parts.bar]
shape = "bar"
material = "pvc-u"
width = "8 mm"
thickness = "4 mm"
eye_diameter = "12 mm"
eye_thickness = "4 mm"
fillet_radius = "2 mm"
[[carried]]
link = "rocker"
at = "P"
mass = "3 g"
centroid = ["65 mm", "4 mm"]
radius_of_gyration = "5 mm"
[[carried]]
link = "rocker"
start = "O4"
end = "B"
mass = "2 g"
[load_cases.spin]
own_weight = true
speed = "1500 rpm"
[load_cases.push]
speed = "0 rpm"
carried = false
[[load_cases.push.forces]]
link = "rocker"
at = "P"
force = ["-3 N", "-2 N"]
[[load_cases.push.moments]]
link = "rocker"
at = "P"
moment = "15 N*mm"
[[load_cases.push.spread]]
link = "rocker"
start = "O4"
end = "P"
total = ["2 N", "-1 N"]
axes = "link"
[solid]
mesh_size = 3.0
"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "crank-rocker.toml"
    path.write_text(TOML, encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def moved(path):
    return solve_case_motion(read_case(path))


@pytest.fixture(scope="module")
def result(path):
    return envelope_case(read_case(path), name="crank-rocker", threads=1, effort=Effort(max_meshes=1))


def test_no_link_passes_where_the_linkage_gives_way(result, monkeypatch):
    """Under the one load case of which the linkage is said to fail; the other keeps its verdicts."""
    passed = {one.load_case for one in result.checks if one.verdict is Verdict.PASS and one.subject.kind == "link"}
    assert passed == {"spin", "push"}
    some = next(one for one in result.checks if one.load_case == "push")
    fails = replace(some, subject=LINKAGE, verdict=Verdict.FAIL)
    monkeypatch.setattr(envelope, "linkage_outcomes", lambda moved, evaluated: [fails])
    over = envelope._Envelope(result.moved, result.evaluated, 1, lambda message: None)
    checks = [one for one in over.outcomes(result.links) if one.subject.kind == "link"]
    verdicts = {name: {one.verdict for one in checks if one.load_case == name} for name in ("spin", "push")}
    assert Verdict.PASS in verdicts["spin"]
    assert verdicts["push"] <= {Verdict.UNDECIDED, Verdict.FAIL}


def test_collapse_over_a_motion_is_told_by_first_yield_alone(path, result):
    """Where that does not reach its limit, or poses are left out, the check is open and does not fail."""
    least = {name: over.safety_factor.low for name, over in result.links["rocker"].load_cases.items()}
    assert len(set(least.values())) == 2
    between = math.sqrt(math.prod(least.values()))
    case = edited(path, [f'checks.breaks={{ type = "plastic-collapse", minimum = {between} }}'])
    moved = replace(result.moved, case=case)

    def collapses(evaluated):
        found = envelope_outcomes(moved, result.links, evaluated)
        return {one.load_case: one for one in found if one.quantity is Quantity.PLASTIC_COLLAPSE}

    found = collapses(result.evaluated)
    assert set(found) == set(least)
    for name, one in found.items():
        if least[name] > between:
            assert (one.verdict, one.value.low, one.value.high) == (Verdict.PASS, least[name], math.inf)
        else:
            assert one.verdict is Verdict.UNDECIDED
            assert "in single poses" in in_words(one.reason)
    some = result.evaluated.copy()
    some[0] = False
    assert {one.verdict for one in collapses(some).values()} == {Verdict.UNDECIDED}


def test_loads_at_a_pose_are_those_of_the_statics(path, moved):
    """Weight, inertia, carried masses, forces, moments and spread loads, cut free by the other path of the code."""
    statics = solve_case_statics(read_case(path))
    histories = link_histories(moved, "rocker")
    assert [history.name for history in histories] == ["spin", "push"]
    for history in histories:
        reactions, loads = statics.reactions[history.name], statics.loads[history.name]
        other = link_loads(history.name, "rocker", read_case(path).body("rocker"), reactions, loads)
        found = history.chosen(0)
        close = {"rel": 1e-6, "abs": 1e-7}
        for ours, theirs in zip((*found.pins, *found.ends), (*other.pins, *other.ends), strict=True):
            assert ours.name == theirs.name
            assert ours.wrench == pytest.approx(theirs.wrench, **close)
        for ours, theirs in zip(
            sorted(found.lines, key=lambda line: line.end),
            sorted(other.lines, key=lambda line: line.end),
            strict=True,
        ):
            assert (ours.start, ours.end) == (theirs.start, theirs.end)
            assert [*ours.at_start, *ours.at_end] == pytest.approx([*theirs.at_start, *theirs.at_end], **close)
        assert (found.inertia is None) == (other.inertia is None) == (history.name == "push")
        if found.inertia is not None:
            probe = np.array([33.0, -7.0, 0.0])
            assert found.inertia.per_mass(probe) == pytest.approx(other.inertia.per_mass(probe), **close)


def test_the_driven_link_carries_the_torque_and_the_other_its_reaction(path):
    moved = solve_case_motion(edited(path, ["drive.link=rocker", "drive.joint=O4"]))
    spin, push = link_histories(moved, "rocker")
    assert [couple.pin for couple in spin.couples] == ["O4"]
    assert spin.couples[0].torque == pytest.approx(moved.torque["spin"], nan_ok=True)
    assert np.nanmax(np.abs(push.couples[0].torque)) > 0.0


def test_loads_out_of_the_plane_are_refused(path):
    case = edited(path, ['load_cases.push.forces=[{link="rocker", at="P", force=["0 N", "0 N", "1 N"]}]'])
    with pytest.raises(CaseError, match="out of the linkage's plane"):
        link_histories(solve_case_motion(case), "rocker")


def test_poses_near_a_dead_point_are_left_out():
    moved = solve_case_motion(read_case("owl-wing-static"))
    assert len(moved.dead_points) == 1
    good = evaluated_poses(moved)
    angles = np.degrees(moved.motion.angles)
    dead = math.degrees(moved.dead_points[0])
    assert not good[np.argmin(np.abs(angles - dead))]
    assert good[[0, -1]].all()
    assert np.abs(angles[~good] - dead).max() < 10.0
    assert evaluated_poses(moved, 1e6).sum() > good.sum() > evaluated_poses(moved, 3.0).sum()


def test_a_motion_without_dead_points_keeps_every_pose(moved):
    assert evaluated_poses(moved, 1.0).all()


@pytest.mark.parametrize("loads", [1, 2, 9, 500])
@pytest.mark.parametrize("smooth", [True, False])
def test_peaks_are_those_of_all_nodes_under_all_loads(loads, smooth):
    rng = np.random.default_rng(3)
    stress = rng.normal(size=(1000, 6, 7)) * rng.uniform(0.01, 1.0, size=(1000, 1, 1)) ** 2
    turn = np.linspace(0.0, 2.0 * np.pi, loads)
    combination = np.array([np.cos(n * turn + n) for n in range(7)])
    if not smooth:
        combination = rng.normal(size=(7, loads)) * rng.uniform(0.01, 10.0, size=loads)
    whole = np.einsum("nim,mp->pni", stress, combination)
    for brittle, values in ((False, von_mises(whole)), (True, principal(whole)[..., 0])):
        modes = of_stress(stress, brittle=brittle)
        found = largest(modes, combination)
        assert found.value == pytest.approx(values.max(axis=1), rel=1e-10)
        assert found.node.tolist() == values.argmax(axis=1).tolist()
        low, high = signed_bounds(modes, combination)
        signed = signed_stress(whole, brittle=brittle)
        assert (low <= signed.min(axis=0) + 1e-12).all()
        assert (high >= signed.max(axis=0) - 1e-12).all()
        if smooth and loads > 100:
            assert np.median((high - low) / np.ptp(signed, axis=0)) < 1.25


def test_the_deviators_length_is_the_von_mises_stress():
    stress = np.random.default_rng(1).normal(size=(50, 6, 3))
    assert np.linalg.norm(deviator(stress), axis=1) == pytest.approx(von_mises(stress.swapaxes(1, 2)))


def test_stress_of_a_compressed_link_may_have_no_tension():
    stress = np.zeros((4, 6, 1))
    stress[:, :3, 0] = -np.arange(1.0, 5.0)[:, None]
    peaks = largest(of_stress(stress, brittle=True), np.array([[1.0, 2.0]]))
    assert peaks.value.tolist() == [-1.0, -2.0]
    assert peaks.node.tolist() == [0, 0]


@pytest.mark.parametrize("order", [1, 2])
def test_modal_stress_is_recovered_as_that_of_a_single_field(order):
    space = displacement_space(solid_meshes.ring(1.0, 2.0, 1.0), order=order)
    fields = np.random.default_rng(2).normal(size=(space.unknowns, 3))
    found = nodal_stress(space, fields, E=2000.0, nu=0.3)
    for i in range(3):
        single = stress_field(space, fields[:, i].reshape(-1, 3), E=2000.0, nu=0.3)
        assert found[..., i] == pytest.approx(single.nodal, rel=1e-9, abs=1e-9 * np.abs(single.nodal).max())


def test_a_repetition_is_a_turn_or_there_and_back():
    history = np.array([1.0, 4.0, 2.0, 1.0])
    assert closed_history(history, returns=True).tolist() == [1.0, 4.0, 2.0, 1.0]
    assert closed_history(history, returns=False).tolist() == [1.0, 4.0, 2.0, 1.0, 2.0, 4.0]


def test_the_envelope_says_how_little_when_and_where(result):
    rocker = result.links["rocker"]
    assert list(rocker.load_cases) == ["spin", "push"]
    for load_case in rocker.load_cases.values():
        assert load_case.value.shape == (25,)
        assert (load_case.low <= load_case.value).all()
        assert (load_case.value <= load_case.high).all()
        assert load_case.pose == int(np.argmax(load_case.value))
        assert load_case.safety_factor.value == pytest.approx(rocker.strength / load_case.value.max())
        assert load_case.safety_factor.low == pytest.approx(rocker.strength / load_case.high.max())
        assert any(source.kind is SourceKind.DISCRETISATION for source in load_case.safety_factor.sources)
        assert load_case.value[0] == pytest.approx(load_case.value[-1])  # a full turn
    assert rocker.worst.name == min(rocker.load_cases.values(), key=lambda found: found.safety_factor.low).name
    assert rocker.field.peak.value == pytest.approx(rocker.worst.stress.value, rel=1e-9)
    assert rocker.field.peak.location == pytest.approx(rocker.worst.location)
    assert rocker.imbalance < 1e-6
    assert rocker.reaction < 1e-3
    assert result.idle == ()


def test_every_load_case_is_checked_for_strength_and_fatigue(result):
    asked = {(check.load_case, check.quantity) for check in result.checks}
    every = (Quantity.SAFETY_FACTOR, Quantity.FATIGUE_STRESS, Quantity.FATIGUE_LIFE, Quantity.BUCKLING_FACTOR)
    assert asked == {(n, q) for n in ("spin", "push") for q in every}
    for check in result.checks:
        fatigue = result.links["rocker"].load_cases[check.load_case].fatigue
        if check.quantity == Quantity.FATIGUE_LIFE:
            assert (check.limit, check.quantity.sense.value) == (4.0, "≥")
            assert check.value.value == pytest.approx(fatigue.life.repetitions / 1e6)
        if check.quantity == Quantity.FATIGUE_STRESS:
            assert check.limit == 2.0
            assert check.value.value == pytest.approx(10.9 / fatigue.life.stress)


@pytest.mark.parametrize("lasting", [True, False])
def test_repetitions_that_a_card_knows_nothing_of_leave_the_link_undecided(moved, result, lasting):
    """They passed: a hundred million of a material without fatigue data."""
    bare = result.case.material_of("rocker").model_copy(update={"fatigue": None})
    rocker, why = result.links["rocker"], missing_data(bare)
    unknown = {name: replace(over, fatigue=None) for name, over in rocker.load_cases.items()}
    links = {"rocker": replace(rocker, load_cases=unknown, no_fatigue=why)}
    found = envelope_outcomes(moved, links, np.ones(25, dtype=bool), lasting=lasting)
    known = {c.load_case: (c.verdict, c.reason) for c in found if c.quantity is Quantity.FATIGUE_STRESS}
    assert known == (dict.fromkeys(("spin", "push"), (Verdict.UNDECIDED, why)) if lasting else {})
    assert "add [materials.<name>.fatigue]" in in_words(why)


def test_buckling_is_that_of_the_pose_with_the_least_factor(path, moved, result):
    (history,) = (h for h in link_histories(moved, "rocker") if h.name == "push")
    (found,) = (c for c in result.checks if (c.load_case, c.quantity) == ("push", Quantity.BUCKLING_FACTOR))
    case, body, factors, small = (
        read_case(path),
        read_case(path).body("rocker"),
        [],
        SimpleNamespace(state="small", buckling=math.inf),
    )
    for pose in range(history.poses):
        loads = beam_loads(history.chosen(pose), body, case.material_of("rocker").density)
        beam = check_beam(loads, body.part.section, 1.0)
        factors += [
            (c.value.value, c.value.low, pose) for c in buckling_outcomes(case, "push", {"rocker": beam}, small)
        ]
    value, low, _ = min(factors)
    pose = next(number for factor, _, number in factors if factor <= value * (1.0 + 1e-9))  # a turn ends where it began
    assert found.value.value == pytest.approx(value, rel=2e-3)  # the beam is sampled at stations
    assert found.value.low == pytest.approx(low, rel=2e-3)
    assert found.verdict is Verdict.PASS
    assert f"at crank = {40.0 + 15.0 * pose:.5g} deg" in in_words(found.reason)


def test_pins_and_bearing_are_checked_at_the_pose_of_the_largest_force(path, moved):
    """Against the statics of every pose by itself."""
    checks = ['checks.shear={type="pins", minimum=2.0}', 'checks.eyes={type="bearing"}']
    motion = solve_case_motion(edited(path, checks))
    found = {
        (c.name, c.link): c for c in envelope_outcomes(motion, {}, np.ones(25, dtype=bool)) if c.load_case == "push"
    }
    assert set(found) == {(name, f"pin {joint}") for name in ("shear", "eyes") for joint in ("B", "O4")}
    least: dict[tuple[str, str], list[Band]] = {key: [] for key in found}
    for pose in range(24):
        angles = {link: np.degrees(moved.motion.angle(link)[pose]) for link in ("crank", "coupler", "rocker")}
        near = [f'pose.near.{link}="{angles[link]} deg"' for link in ("coupler", "rocker")]
        case = edited(path, [*checks, f'pose.angle="{angles["crank"]} deg"', *near])
        reactions = solve_case_statics(case).reactions["push"]
        for joint in ("B", "O4"):
            stress = stress_at(case, joint, reactions.joints).equivalent
            least["shear", f"pin {joint}"].append(stress.inverse(case.pin_material(joint).allowable))
            [eye] = asked(case, BearingCheck, subject=Subject.pin(joint))
            outcome = bearing_outcome(case, "push", eye, [reactions.joints])
            least["eyes", outcome.link].append(outcome.value)
    for key, bands in least.items():
        pose = int(np.argmin([band.value for band in bands]))
        value = found[key].value
        assert (value.value, value.low) == pytest.approx((bands[pose].value, bands[pose].low), rel=1e-6)
        assert f"at crank = {40.0 + 15.0 * pose:.5g} deg" in in_words(found[key].reason)


def test_joints_are_judged_at_the_poses_that_count_with_the_scatter_of_the_pins(path):
    """Without the pose of its largest force a joint is judged at the next one; its pin's strength has a range."""
    case = edited(path, ['checks.shear={type="pins", minimum=2.0}', 'checks.eyes={type="bearing"}'])
    card = case.pin_material("O4")
    ranged = card.model_copy(update={"strength_range": (0.8 * card.allowable, 1.1 * card.allowable)})
    case = with_material(case, case.joints["O4"].pin_material, ranged)
    motion = solve_case_motion(case)
    force = np.linalg.norm(motion.forces["push"].forces["O4"], axis=1)
    kept = force < np.sort(force[:-1])[-3] * (1.0 - 1e-9)
    found = {
        check.name: check
        for check in envelope_outcomes(motion, {}, kept)
        if (check.link, check.load_case) == ("pin O4", "push")
    }
    stress = stress_of(case, "O4", force[kept].max()).equivalent
    shear = found["shear"].value
    assert shear.value == pytest.approx(card.allowable / stress.value)
    assert (shear.low, shear.high) == pytest.approx(
        (0.8 * card.allowable / stress.high, 1.1 * card.allowable / stress.low)
    )
    eye = case.material_of("rocker").ultimate_strength / (force[kept].max() / (3.0 * 4.0))
    assert found["eyes"].value.value == pytest.approx(eye)


def pose_of_bearing(monkeypatch, pressed, bears, evaluated):
    """Return the pose at which two eyes are judged that are pressed so, and bear so much."""
    monkeypatch.setattr(bearing, "in_own_eyes", lambda *_: dict(zip("ab", map(np.array, pressed), strict=True)))
    monkeypatch.setattr(bearing, "pressing", lambda case, link, force: force)
    monkeypatch.setattr(bearing, "most_grown", lambda *_: np.ones(4))
    monkeypatch.setattr(
        bearing, "eyes_bear", lambda *_: {eye: (x, Scatter()) for eye, x in zip("ab", bears, strict=True)}
    )
    told, joint = [], SimpleNamespace(wrench=np.zeros((4, 6)))
    judge = SimpleNamespace(least=BY_HAND[BearingCheck].least, judge=lambda here, one: told.append(here) or one)
    monkeypatch.setitem(BY_HAND, BearingCheck, judge)
    monkeypatch.setattr(
        outcomes_over_motion, "_complete", lambda *_: SimpleNamespace(because=lambda why: why, reason="")
    )
    solved = SimpleNamespace(joints={"B": joint}, forces={"B": np.zeros((4, 2))})
    motion = SimpleNamespace(coordinate=Coordinate("crank"), progress=np.zeros(4), instants=None)
    moved = SimpleNamespace(case=None, forces={"push": solved}, motion=motion)
    check = BearingCheck.model_validate({"type": "bearing"})
    eyes_asked = Asked(name="eyes", subject=Subject.pin("B"), quantity=Quantity.SAFETY_FACTOR, limit=3.33, check=check)
    over = replace(loading_over(moved, "push", evaluated, {}, Growths()), at=lambda pose: pose)
    outcomes_over_motion._at_worst_pose(moved, over, SimpleNamespace(**vars(eyes_asked), outcome=None))
    [pose] = told
    return pose


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(("bears", "worst"), [((10.0, 10.0), 2), ((1.0, 10.0), 1)])
def test_a_joint_is_judged_at_the_pose_where_either_eye_bears_least(monkeypatch, order, bears, worst):
    """Not where one is pressed most whose other is weaker, nor at a pose that was left out."""
    pressed = [1.0, 5.0, 2.0, 30.0], [4.0, 3.0, 9.0, 20.0]
    assert pose_of_bearing(monkeypatch, pressed[::order], bears[::order], np.arange(4) < 3) == worst


def test_without_a_force_a_joint_is_judged_at_a_pose_that_counts(monkeypatch):
    assert pose_of_bearing(monkeypatch, ([9.0, 0.0, 0.0, 0.0],) * 2, (10.0, 10.0), np.arange(4) > 0) == 1


def test_no_joint_passes_where_poses_were_left_out(path):
    moved = solve_case_motion(edited(path, ['checks.eyes={type="bearing", minimum=0.001}']))
    every = np.ones(25, dtype=bool)
    assert {c.verdict for c in envelope_outcomes(moved, {}, every)} == {Verdict.PASS}
    every[3] = False
    assert {c.verdict for c in envelope_outcomes(moved, {}, every)} == {Verdict.UNDECIDED}


def test_a_dead_point_of_the_drive_leaves_the_verdict_open(path):
    case = edited(path, ["drive.link=rocker", "drive.joint=O4", 'checks.strength={type="safety-factor", minimum=0.01}'])
    found = envelope_case(case, threads=1, effort=Effort(max_meshes=1))
    assert found.verdict is Verdict.UNDECIDED
    assert 0 < found.evaluated.sum() < 25
    assert any("has a dead point at" in in_words(warning) for warning in found.warnings)
    strength = {check.load_case: check for check in found.checks if check.name == "strength"}
    assert "dead point" in in_words(strength["push"].reason)
    # At one of the poses next to it the soft linkage does not hold its own inertia.
    assert strength["spin"].value.low == 0.0
    assert found.links["rocker"].no_fatigue
    assert np.isnan(found.links["rocker"].worst.value[~found.evaluated]).all()


@pytest.mark.parametrize(("share", "refused"), [(1e-4, False), (0.05, True)])
def test_loads_that_do_not_balance_are_refused(path, moved, share, refused):
    """A push of a pin that equilibrium does not know, as a share of its largest force."""
    case = read_case(path)
    (history,) = (h for h in link_histories(moved, "rocker") if h.name == "push")
    pins = list(history.pins)
    (b,) = (i for i, pin in enumerate(pins) if pin.name == "B")
    wrench = pins[b].wrench.copy()
    wrench[:, 0] += share * np.abs(wrench).max()
    pins[b] = replace(pins[b], wrench=wrench)
    space = displacement_space(mesh_body(case.body("rocker"), START.scaled(4.0)), order=1)

    def solve():
        return LinkMotion(
            space, link="rocker", body=case.body("rocker"), material=case.material_of("rocker"),
            histories=[replace(history, pins=tuple(pins))],
            evaluated=np.ones(25, dtype=bool), stated="eye-faces", returns=True,
        ).envelope()  # fmt: skip

    if refused:
        with pytest.raises(CannotRunError, match="the loads leave a resultant"):
            solve()
    else:
        assert solve().imbalance > 1e-5


@pytest.mark.parametrize("worst", [0, 1, 2])
@pytest.mark.parametrize(
    ("entry", "said"), [("imbalance", "leave a resultant of 50"), ("reaction", "free body react of 50")]
)
def test_one_pose_out_of_balance_is_enough(entry, said, worst):
    """Whichever pose it is, and of loads and supports whichever it is."""
    good = np.full(3, 1e-9)
    bad = np.where(np.arange(3) == worst, 0.5, good)
    _balanced(SimpleNamespace(imbalance=good, reaction=good))
    with pytest.raises(CannotRunError, match=said):
        _balanced(SimpleNamespace(**{"imbalance": good, "reaction": good, entry: bad}))


def test_scatter_of_the_load_widens_tension_and_compression_to_both_sides():
    """Stress between -4 and -2 MPa is between -8 and -1 MPa under half to twice the load, that of 3 to 6 1.5 to 12."""
    own = LoadCaseEnvelope(
        name="push", variants=(), governing=None, value=np.array([-3.0, 4.0]), low=np.array([-4.0, 3.0]),
        high=np.array([-2.0, 6.0]), stress=Band(value=4.0, low=3.0, high=6.0), safety_factor=Band.exact(15.0),
        pose=1, location=np.zeros(3), fatigue=None, discretisation=None,
    )  # fmt: skip
    load = Scatter(low=0.5, high=2.0, sources=(Source(kind=SourceKind.LOAD),))
    found = _scattered(own, SimpleNamespace(allowable=60.0, strength_range=(48.0, 90.0)), load)
    assert found.low == pytest.approx([-8.0, 1.5])
    assert found.high == pytest.approx([-1.0, 12.0])
    assert (found.stress.low, found.stress.high) == (1.5, 12.0)
    factor = found.safety_factor
    assert (factor.value, factor.low, factor.high) == pytest.approx((15.0, 48.0 / 12.0, 90.0 / 1.5))


@pytest.mark.parametrize("order", [[0, 1, 2, 3], [1, 3, 2, 0], [2, 0, 3, 1]])
def test_an_envelope_holds_every_way_in_which_pins_press_and_torque_enters(order):
    """At each pose the least and the largest of four ways; the value is the largest of the two as stated."""
    stresses = {(180.0, "eye-faces"): [5.0, -2.0, 9.0], (180.0, "bore-shear"): [3.0, -6.0, 11.0],
                (100.0, "eye-faces"): [6.0, -1.0, 8.0], (100.0, "bore-shear"): [4.0, -3.0, 10.0]}  # fmt: skip
    every = [
        VariantCurve(span=span, transfer=transfer, stress=np.array(stress), node=np.arange(3), first=0)
        for (span, transfer), stress in stresses.items()
    ]
    motion = SimpleNamespace(
        stated="eye-faces",
        material=SimpleNamespace(allowable=60.0),
        measure=SimpleNamespace(solved=SimpleNamespace(space=SimpleNamespace(nodes=np.eye(3)))),
    )
    motion._governing = lambda variants: LinkMotion._governing(motion, variants)
    found = LinkMotion._by_meshes(motion, "push", [every[i] for i in order], MeshFactors())
    assert found.value == pytest.approx([6.0, -1.0, 9.0])
    assert found.low == pytest.approx([3.0, -6.0, 8.0])
    assert found.high == pytest.approx([6.0, -1.0, 11.0])
    assert (found.stress.value, found.stress.low, found.stress.high, found.pose) == (9.0, 8.0, 11.0, 2)
    assert found.safety_factor.low == pytest.approx(60.0 / 11.0)


def test_what_cannot_be_enveloped_is_refused(path, tmp_path):
    bare = tmp_path / "bare.toml"
    kept = (
        TOML.replace('part = "bar"', "")
        .replace("own_weight = true", "own_weight = false")
        .replace('end_patch = "4 mm"', "")
    )
    bare.write_text(kept, encoding="utf-8")
    with pytest.raises(CaseError, match="no moving link has a part"):
        envelope_case(read_case(str(bare)))
    case = edited(path, ["drive.link=rocker", "drive.joint=O4"])
    with pytest.raises(CannotRunError, match="no pose is left"):
        envelope_case(case, growth=0.5)


def test_curves_and_record_tell_the_same(result):
    from alula.reports.motion.envelope import envelope_record, envelope_sections
    from alula.reports.renderers.csv import files_of

    sections = envelope_sections(result)
    rows = list(csv.DictReader(files_of(sections)["envelope.csv"].splitlines()))
    assert len(rows) == 50
    told = json.loads(json.dumps(envelope_record(result, sections), allow_nan=False))
    compare("envelope", told)
    for name, load_case in told["links"]["rocker"]["load_cases"].items():
        stress = [float(row["rocker von Mises stress [MPa]"]) for row in rows if row["load case"] == name]
        assert max(stress) == pytest.approx(load_case["stress"]["value"])
        assert stress.index(max(stress)) == load_case["at"]["pose"]
        crank = next(
            float(r["crank angle [deg]"]) for r in rows if r["load case"] == name and r["rocker von Mises stress [MPa]"]
        )
        assert crank == pytest.approx(40.0)
    assert told["verdict"] == result.verdict.value
    assert "small enough for a factorisation" in told["links"]["rocker"]["solver_reason"]
    assert 0.0 <= told["links"]["rocker"]["solver_error"] < 1e-8


def test_stress_along_a_link_is_that_of_its_field(result):
    """At the worst pose it is the stress of the nodes of each stretch; at every pose the largest is the curve's."""
    link = result.links["rocker"]
    for found in link.load_cases.values():
        along = found.along
        assert np.array_equal(along.poses, np.arange(25))
        assert along.stress.max(axis=1) == pytest.approx(found.governing.stress, rel=1e-9)
    worst = link.worst.along
    x, stress = link.field.space.nodes[:, 0], link.field.von_mises
    edges = np.linspace(worst.first, worst.last, worst.stress.shape[1] + 1)
    edges[-1] += 1.0
    of_field = [stress[(a <= x) & (x < b)].max() for a, b in itertools.pairwise(edges)]
    assert worst.stress.shape[1] > 10
    assert worst.stress[link.worst.pose] == pytest.approx(of_field, rel=1e-6)


def test_the_folder_holds_curves_figure_and_fields(result, tmp_path, monkeypatch, capsys):
    from alula.reports.commands.motion import tell_envelope
    from alula.reports.figures import figures

    monkeypatch.setattr(figures, "plots_of", lambda scenes, points: ({}, ("no renderer",)))
    tell_envelope(result, tmp_path / "out")
    out = tmp_path / "out" / "envelope"
    assert {p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file()} == {
        ".alula-envelope.json", "result.json", "envelope.csv", "envelope.html", "envelope.png", "vtu/rocker.vtu"
    }  # fmt: skip
    assert (out / "envelope.png").read_bytes().startswith(b"\x89PNG")
    assert "Warning: no renderer\n" in capsys.readouterr().err
    page = (out / "envelope.html").read_text(encoding="utf-8")
    model = json.loads(page.split('data-model="linkage">')[1].split("</script>")[0])
    worst = result.links["rocker"].worst
    [values] = [one for one in model["values"] if one["label"] == worst.name]
    assert values["links"]["rocker"][worst.pose] == pytest.approx(worst.stress.value, rel=1e-3)
    assert max(values["links"]["rocker"]) == values["links"]["rocker"][worst.pose]


def test_the_page_says_why_a_check_is_open_what_is_not_checked_and_lists_the_worst_link_first(result):
    from alula.reports.motion.envelope import envelope_headline, envelope_page, envelope_sections
    from alula.reports.renderers.page import as_page

    strong = result.links["rocker"]
    weak = {name: replace(one, safety_factor=one.safety_factor.times(0.5)) for name, one in strong.load_cases.items()}
    both = replace(result, links={"strong": strong, "weak": replace(strong, load_cases=weak)})
    factors = [row["safety factor"] for row in tables_of(envelope_sections(both))["links"]]
    assert len(factors) == 2 * len(weak)
    assert max(factors[: len(weak)]) < min(factors[len(weak) :])

    first, *others = result.checks
    why = "no model of this part decides"
    opened = replace(first, value=Band.unknown(why), verdict=Verdict.UNDECIDED, reason=why)
    open_result = replace(result, verdict=Verdict.UNDECIDED, checks=(*others, opened))
    assert f"is open: {opened.quantity} of rocker." in " ".join(envelope_headline(open_result))
    assert "Not checked: " in " ".join(envelope_headline(open_result))
    page = as_page(envelope_page(open_result, envelope_sections(open_result)))
    assert f"{why.capitalize()}." in page, "in the row of the check"
    assert all(line in html.unescape(page) for line in envelope_headline(open_result))


def test_console_names_link_angle_and_verdict(result, capsys):
    from alula.reports.commands.motion import tell_envelope

    tell_envelope(result)
    text = capsys.readouterr().out
    assert result.verdict.value.upper() in text
    assert "25 of 25 poses" in text
    assert "at crank" in text
    assert "shortens the life by a factor of 1.6" in " ".join(text.split())


def test_the_figure_is_drawn_over_the_coordinate_where_the_drive_turns_back(result):
    from alula.reports.figures.motion.envelope_figures import abscissa

    angles, label = abscissa(result)
    assert label == "direction of crank (driven) [deg]"
    assert angles[0] == pytest.approx(40.0)
    back = replace(result, drive_angles=np.cos(result.drive_angles))
    assert abscissa(back)[1] == "direction of crank [deg]"
