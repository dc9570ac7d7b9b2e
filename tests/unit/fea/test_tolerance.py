"""Tolerances: sampled poses, forces and stresses against direct ones, probabilities against closed forms."""

import math
import tomllib
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import beta
from sprung_cases import FOUR_BAR, HANG, case_of
from sprung_cases import LEVER as LEVER_LET_GO

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject
from alula.fea.refine.refinement import START, Effort
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.tolerance.analysis import _drawn, tolerance_case
from alula.fea.tolerance.link_response import link_response
from alula.fea.tolerance.numbers import covered
from alula.fea.tolerance.result import Probability
from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.continuation import DeadPointError, follow
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.sampled import assemble_samples
from alula.geometry.materials.material import TOLD
from alula.geometry.meshing.mesh import mesh_body
from alula.loads.case.case_file import read_case, validate
from alula.loads.case.toleranced import toleranced
from benchmarks.tolerances import direct_case

LEVER = {
    "schema_version": 1,
    "title": "lever",
    "links": {
        "base": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "Q": ["0 mm", "9 mm"]}},
        "arm": {"part": "bar", "points": {"O": ["0 mm", "0 mm"], "P": ["60 mm", "0 mm"]}},
    },
    "joints": {"O": {"links": ["base", "arm"], "pin_diameter": "3 mm"}},
    "pose": {"coordinate": "arm", "angle": "90 deg"},
    "drive": {"link": "arm", "joint": "O"},
    "parts": {"bar": {"shape": "bar", "material": "m", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}},
    "materials": {
        "m": {
            "title": "m", "strength": "yield", "yield_strength": "40 MPa", "youngs_modulus": "2 GPa",
            "poissons_ratio": 0.3, "density": "1200 kg/m^3", "sources": dict.fromkeys(TOLD, "a test"),
            "status": dict.fromkeys(TOLD, "assumed"),
        }
    },
    "load_cases": {"pull": {"forces": [{"link": "arm", "at": "P", "force": ["10 N", "0 N"]}]}},
    "large_displacement": "off",
    "checks": {"strength": {"type": "safety-factor", "minimum": 1.0}},
}  # fmt: skip
ONE_MESH = Effort(max_meshes=1)


def lever(**changes):
    return validate(LEVER | changes)


@cache
def sampled(entry, half, distribution="uniform", samples=20_000, angle="90 deg", minimum=1.0):
    """The lever under one tolerance."""
    case = lever(
        tolerances={entry: {"plus_minus": half, "distribution": distribution}},
        pose={"coordinate": "arm", "angle": angle},
        checks={"strength": {"type": "safety-factor", "minimum": minimum}},
    )
    return tolerance_case(case, samples=samples, threads=1, effort=ONE_MESH)


CRANK = {f"links.{at}": "0.1 mm" for at in ("base.points.O", "crank.points.A", "rod.points.A")}


@pytest.mark.parametrize(
    ("name", "tolerances"),
    [("owl-wing-static", {"pins": "0.2 mm"}), ("owl-wing-closed", {"pins": "0.2 mm"}), ("ornithopter", CRANK)],
)
def test_samples_have_the_joint_forces_of_direct_checks(name, tolerances):
    """Places and the pose's angle are off; the ornithopter has slots and inertia. All in one plane."""
    case = read_case(name)
    flat = {"layer_spacing": "0 mm"} if case.layered else {}
    case = case.with_values(flat | {"tolerances": tolerances | {"pose.angle": "0.5 deg"}})
    variables = toleranced(case)
    rows = _drawn(variables, 40, np.random.default_rng(3))
    nominal = solve_case_statics(case, name)
    found = Sampler(case=case, pose=nominal.pose, masses=nominal.masses, variables=variables).states(rows)
    compared = 0
    for number, row in enumerate(rows[:8]):
        if not found.good[number]:
            continue
        try:
            direct = solve_case_statics(direct_case(case, variables, row), name)
        except CaseError as error:
            if "near" not in str(error):
                raise
            continue  # rough directions of the case file no longer tell the branch
        place, compared = int(found.good[:number].sum()), compared + 1
        for load_case, reactions in direct.reactions.items():
            scale = max(joint.magnitude for joint in reactions.joints.values())
            weighs = case.load_cases[load_case].own_weight or case.load_cases[load_case].speed
            for joint, reaction in reactions.joints.items():
                wrench = found.forces[load_case].joints[joint].wrench[place]
                off = np.abs(wrench - reaction.wrench).max()
                assert off < (2e-2 if weighs else 1e-8) * scale  # the mass of longer parts is left as it is
    assert compared >= 4


def test_samples_that_do_not_assemble_come_to_a_dead_point_before_the_pose():
    """Next to its dead point the closed owl wing has no assembly in a tenth of the samples.

    Each of them is drawn and followed along its own branch, from where it still assembles.
    """
    case = read_case("owl-wing-closed").with_values({"tolerances": {"pins": "0.2 mm"}})
    variables, pose = toleranced(case), case.solve_pose()
    rows = _drawn(variables, 60, np.random.default_rng(1))
    sampler = Sampler(case=case, pose=pose, masses={}, variables=variables)
    states = sampler.states(rows)
    lost = np.flatnonzero(states.apart)
    assert 1 <= len(lost) <= 20
    assert np.isfinite(states.short[lost]).all()
    assert np.isnan(states.short[~states.apart]).all()
    away = math.radians(4.0)
    further, there, _ = assemble_samples(pose, sampler.shifts(rows[lost]), np.full(len(lost), away))
    assert there.all()
    wanted = float(pose.q[pose.held_column])
    for number, q in list(zip(lost, further.q, strict=True))[:3]:
        drawn = DrivenClosure(LoopClosure(direct_case(case, variables, rows[number]).linkage), Coordinate("GF"))
        with pytest.raises(DeadPointError) as stopped:
            follow(drawn, q, wanted, wanted + away)
        assert stopped.value.angle - wanted == pytest.approx(states.short[number], abs=1e-6)


def test_link_stress_of_samples_equals_direct_solutions_on_the_same_mesh():
    case = lever(tolerances={"pins": "0.2 mm", "links.arm.points.P": "0.2 mm", "pose.angle": "25 deg"})
    variables = toleranced(case)
    sampler = Sampler(case=case, pose=case.solve_pose(), masses={}, variables=variables)
    rng = np.random.default_rng(0)
    rows = np.vstack([np.zeros(len(variables)), _drawn(variables, 300, rng)])
    states, body, card = sampler.states(rows), case.body("arm"), case.material_of("arm")
    loads = sampler.link_loads(states, rows, "pull", "arm")
    assert np.abs(loads.resultant()).max() < 1e-9 * 600.0  # what acts on the nominal body balances
    response = link_response(
        body, card, SimpleNamespace(space=_solid(body, card, loads.chosen(0)).space), [loads.chosen(slice(0, 60))],
        stated="eye-faces",
    )  # fmt: skip
    peaks = response.peaks("von_mises", loads)
    for number in (0, 70, 200, 300):
        direct = _solid(body, card, loads.chosen(number))
        for one in direct.cases:
            largest = stress_field(direct.space, one.displacement, E=direct.E, nu=direct.nu).peak.value
            [found] = [p[number] for v, p in peaks.items() if (v.law.span, v.transfer) == (one.span, one.transfer)]
            assert found == pytest.approx(largest, rel=5e-3)


def _solid(body, card, loads):
    return solve_solid(
        _lever_mesh(), E=card.youngs_modulus, nu=card.poissons_ratio, density=card.density, loads=[loads],
        line=("bore:O", "bore:O"), threads=1,
    )  # fmt: skip


@cache
def _lever_mesh():
    return mesh_body(lever().body("arm"), START)


def test_a_normal_load_gives_its_torque_a_known_mean_and_standard_deviation():
    """T = F l at 90 deg; ±30 % is three standard deviations."""
    result = sampled("load_cases.pull.forces.0", "30 %", "normal")
    torque = result.numbers[-1]
    assert (torque.subject, torque.quantity, torque.title) == ("the drive", "drive torque", "drive torque")
    assert torque.values.mean() == pytest.approx(600.0, rel=4.0 * 0.1 / math.sqrt(20_000))
    assert torque.values.std() == pytest.approx(60.0, rel=4.0 / math.sqrt(2 * 20_000))
    assert torque.first == pytest.approx([1.0])
    assert torque.total == pytest.approx([1.0])


def test_an_angle_gives_the_torque_the_distribution_of_its_sine():
    """A uniform angle about 30 deg: mean F l sin(30 deg) sin(h)/h, and Var by the integral of sin²."""
    result = sampled("pose.angle", "10 deg", angle="30 deg")
    h, middle = math.radians(10.0), math.radians(30.0)
    mean = math.sin(middle) * math.sin(h) / h
    square = 0.5 - math.cos(2.0 * middle) * math.sin(2.0 * h) / (4.0 * h)
    torque = result.numbers[-1].values / 600.0
    deviation = math.sqrt(square - mean**2)
    assert torque.mean() == pytest.approx(mean, abs=4.0 * deviation / math.sqrt(20_000))
    assert torque.std() == pytest.approx(deviation, rel=0.03)


def test_probability_of_strength_under_a_load_follows_from_the_nominal_band():
    """The factor is n/(1 + δ) with δ uniform in ±0.4, so that P(n/(1 + δ) >= 1) = (n - 0.6)/0.8 for each end n."""
    low = sampled("load_cases.pull.forces.0", "40 %").numbers[0]
    factor = low.nominal
    result = sampled("load_cases.pull.forces.0", "40 %", minimum=round(factor[1] * 0.9, 4))
    strength = result.numbers[0]
    for end, found in ((factor[1], strength.certain), (factor[2], strength.possible)):
        exact = min(max((end / strength.limit - 0.6) / 0.8, 0.0), 1.0)
        assert found.low - 0.005 <= exact <= found.high + 0.005
    assert result.certain.count == strength.certain.count
    assert result.possible.count == strength.possible.count
    corner = result.corner
    assert corner.value == pytest.approx(factor[0] / 1.4, rel=1e-6)


def test_no_sample_surely_passes_what_the_nominal_check_left_open(monkeypatch):
    """Two checks keep their limits in every sample, and one of them was left open whatever its band says."""

    def left_open(*arguments, **options):
        found = check_case(*arguments, **options)
        own = found.load_cases["pull"]
        checks = tuple(one.left_open("why") if one.name == "strength" else one for one in own.checks)
        return replace(found, load_cases={"pull": replace(own, checks=checks)})

    monkeypatch.setattr("alula.fea.tolerance.analysis.check_case", left_open)
    case = lever(
        tolerances={"load_cases.pull.forces.0": "10 %"},
        checks={
            "strength": {"type": "safety-factor", "minimum": 0.1},
            "stiff": {"type": "displacement", "maximum": "9 mm"},
        },
    )
    result = tolerance_case(case, samples=200, threads=1, effort=ONE_MESH)
    strength, stiff = result.numbers[:2]
    assert strength.low.min() > strength.limit
    assert (strength.certain.count, strength.possible.count, stiff.certain.count) == (0, 200, 200)
    assert (result.certain.count, result.possible.count) == (0, 200)


def test_a_pair_is_as_far_apart_as_its_layers_hold_it():
    """Samples are in one plane, which does not tell it; a pair that states the same has the same numbers."""
    links = {
        "base": LEVER["links"]["base"] | {"layer": 2, "thickness": "4 mm"},
        "arm": LEVER["links"]["arm"] | {"layer": 0, "count": 2},
    }
    layers = {"layer_spacing": "6 mm", "tolerances": {"load_cases.pull.forces.0": "10 %"}}
    found = [
        tolerance_case(lever(links=links | {"arm": links["arm"] | stated}, **layers), samples=200, effort=ONE_MESH)
        for stated in ({}, {"apart": "12 mm"})
    ]
    own, same = (one.numbers[0].low for one in found)
    assert len(own) == 200
    assert np.array_equal(own, same)


def test_strength_and_modulus_change_the_numbers_in_proportion():
    case = lever(
        tolerances={"materials.m.yield_strength": "10 %", "materials.m.youngs_modulus": "20 %"},
        checks={
            "strength": {"type": "safety-factor", "minimum": 1.0},
            "stiff": {"type": "displacement", "maximum": "1 mm"},
        },
    )
    result = tolerance_case(case, samples=4000, threads=1, effort=ONE_MESH)
    strength, stiff = result.numbers[:2]
    assert strength.values == pytest.approx(strength.nominal[0] * (1.0 + result.deviations[:, 0]))
    assert stiff.values == pytest.approx(stiff.nominal[0] / (1.0 + result.deviations[:, 1]))
    assert strength.first[0] > 0.9
    assert stiff.first[1] > 0.9


def test_confidence_intervals_are_those_of_clopper_and_pearson():
    """Ends by the quantiles of the beta distribution (Clopper and Pearson 1934)."""
    found = Probability.of(np.arange(100) < 7)
    assert (found.low, found.high) == pytest.approx((beta.ppf(0.025, 7, 94), beta.ppf(0.975, 8, 93)))
    nothing = Probability.of(np.zeros(50, dtype=bool))
    assert nothing.low == 0.0
    assert nothing.high == pytest.approx(1.0 - 0.025 ** (1 / 50))


@pytest.mark.parametrize(
    ("tolerances", "said"),
    [
        ({"parts.bar.thickness": "4 mm"}, "as large as the size itself"),
        ({"links.arm.end_patch": "0.1 mm"}, "cannot have a tolerance"),
        ({"load_cases.pull.load_lines.0.to.1": "1 mm"}, "names none of the 0 load_lines"),
        ({"links.arm.points.X": "0.1 mm"}, "'X' is no point of link arm"),
        ({"links.arm.points.P": "10 %"}, "above zero"),
        ({"links.arm.points.P": "0.1 N"}, "not a unit of length"),
        ({"load_cases.pull.forces.1": "10 %"}, "none of the 1 forces"),
        ({"load_cases.pull.forces.0": "1 N"}, "must be a share"),
        ({"materials.m.ultimate_strength": "5 %"}, "states no ultimate_strength"),
        ({"materials.m.yield_strength": "100 %"}, "as large as"),
        ({"drive.link": "5 %"}, "cannot have a tolerance"),
        ({"pins": {"plus_minus": "0.1 mm", "distribution": "cauchy"}}, "uniform"),
    ],
)
def test_entries_that_cannot_be_toleranced_are_refused(tolerances, said):
    with pytest.raises(CaseError, match=said):
        lever(tolerances=tolerances)


def test_a_case_without_tolerances_and_a_redundant_one_are_refused():
    with pytest.raises(CaseError, match="states none"):
        tolerance_case(lever(), effort=ONE_MESH)
    across = {"push": {"forces": [{"link": "arm", "at": "P", "force": ["0 N", "0 N", "10 N"]}]}}
    with pytest.raises(CannotRunError, match="not covered"):
        tolerance_case(lever(load_cases=across, tolerances={"pins": "0.1 mm"}), samples=100, effort=ONE_MESH)


def test_a_linkage_that_is_let_go_is_refused():
    case = case_of(LEVER_LET_GO + HANG, tolerances={"links.lever.points.P": "0.1 mm"})
    with pytest.raises(CannotRunError, match="stands where all that acts"):
        tolerance_case(case, samples=100)


def test_springs_pull_on_samples_as_in_direct_statics():
    """Torques of a four-bar with a spring and tendons; a factor on its load case leaves them alone."""
    line = tomllib.loads(FOUR_BAR)["springs"]["line"]  # the others state a force in the nominal pose
    push = {"own": {"forces": [{"link": "rocker", "at": "C", "force": ["1 N", "-2 N"]}]}}
    case = case_of(
        FOUR_BAR, springs={"line": line}, load_cases=push, tolerances={"pins": "0.3 mm", "load_cases.own": "30 %"}
    )
    variables = toleranced(case)
    rows = _drawn(variables, 4, np.random.default_rng(0))
    sampler = Sampler(case=case, pose=case.stated_pose, masses={}, variables=variables)
    torques = sampler.states(rows).forces["own"].drive_torque
    for row, torque in zip(rows, torques.tolist(), strict=True):
        shifts = {v.target: x for v, x in zip(variables, row.tolist(), strict=True) if v.kind == "place"}
        links = {
            name: link.model_copy(
                update={
                    "points": {
                        at: tuple(c + shifts.get((name, at, axis), 0.0) for axis, c in enumerate(place))
                        for at, place in link.points.items()
                    }
                }
            )
            for name, link in case.links.items()
        }
        force = tuple((1.0 + row[-1]) * c for c in (1.0, -2.0))
        [stated] = case.load_cases["own"].forces
        loaded = case.load_cases["own"].model_copy(update={"forces": (stated.model_copy(update={"force": force}),)})
        drawn = case.model_copy(update={"links": links, "load_cases": {"own": loaded}, "tolerances": {}})
        direct = solve_case_statics(drawn).reactions["own"].drive_torque
        assert torque == pytest.approx(float(direct), rel=1e-9)


def test_a_place_of_its_own_replaces_that_of_all_pins():
    case = lever(
        tolerances={"pins": "0.2 mm", "links.arm.points.O": {"plus_minus": "0.1 mm", "distribution": "worst case"}}
    )
    own = {(v.target[0], v.half, v.distribution) for v in toleranced(case)}
    assert own == {("base", 0.2, "uniform"), ("arm", 0.1, "worst case")}
    drawn = _drawn([v for v in toleranced(case) if v.target[0] == "arm"], 50, np.random.default_rng(0))
    assert set(np.unique(drawn).tolist()) == {-0.1, 0.1}


@pytest.mark.parametrize(("transfer", "known"), [("eye-faces", True), ("bore-shear", False)])
def test_pins_that_pass_a_torque_are_left_out(transfer, known):
    """It turns with the pose, where the force of the joint stays the same."""
    case = lever(
        drive={"link": "arm", "joint": "O", "transfer": transfer},
        checks={"pins": {"type": "pins", "minimum": 1.5}},
    )
    [outcome] = [x for x in check_case(case, fidelity="beam").load_cases["pull"].checks if x.subject.kind == "pin"]
    assert covered(case, outcome) is known


def test_the_buckling_of_plates_is_left_out():
    """It comes from their solids, not from columns."""
    plate = {"shape": "plate", "material": "m", "thickness": "4 mm", "eye_diameter": "12 mm"}
    outcome = CheckOutcome.of("buckling", Subject.link("arm"), "pull", Quantity.BUCKLING_FACTOR, Band.exact(5.0), 1.0)
    assert covered(lever(), outcome)
    assert not covered(lever(parts={"bar": plate}), outcome)
