"""Torque that goes through a pin: of a drive by its bore, and of a bonded joint."""

import math

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.outcomes.pins import stress_at, twist_of, twisted
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion

LENGTH, DIAMETER = 100.0, 2.0
BAR = {"shape": "bar", "material": "aluminium-6061-t6", "width": "10 mm", "thickness": "5 mm", "fillet_radius": "2 mm"}


def arm(force: float, joint: dict[str, object] | None = None, **tables: object) -> Case:
    """An arm on a pin of 2 mm, under a force at its tip and under twice that."""
    loads = {
        name: {"forces": [{"link": "arm", "at": "T", "force": ["0 N", f"{-times * force} N"]}]}
        for name, times in (("single", 1.0), ("double", 2.0))
    }
    ground = {"ground": True, "points": {"K": ["0 mm", "0 mm"], "L": ["0 mm", "50 mm"]}}
    points = {"K": ["0 mm", "0 mm"], "T": [f"{LENGTH} mm", "0 mm"]}
    return validate(
        {
            "schema_version": 1,
            "title": "arm on a thin pin",
            "links": {"base": ground, "arm": {"part": "bar", "points": points, "end_patch": "10 mm"}},
            "joints": {"K": {"links": ["base", "arm"], "pin_diameter": f"{DIAMETER} mm"} | (joint or {})},
            "parts": {"bar": BAR},
            "load_cases": loads,
            "checks": {"pins": {"type": "pins", "minimum": 2.0}},
        }
        | tables
    )


BONDED = {"joint": {"bonded": True, "angle": "0 deg"}}
POSE = {"coordinate": "arm", "angle": "0 deg"}


def driven(transfer: str) -> dict[str, object]:
    return {"pose": POSE, "drive": {"link": "arm", "joint": "K", "transfer": transfer}}


def pins(case: Case) -> dict[str, object]:
    found = check_case(case, fidelity="beam")
    return {x.load_case: x for name in found.load_cases for x in found.load_cases[name].checks if x.name == "pins"}


@pytest.mark.parametrize(
    ("tables", "verdict"),
    [(BONDED, Verdict.UNDECIDED), (driven("bore-shear"), Verdict.FAIL), (driven("eye-faces"), Verdict.PASS)],
)
def test_torsion_of_a_pin_is_that_of_a_round_shaft(tables, verdict):
    """16 T/(π d³), T = F l: 1,910 MPa under 30 N, where bending and shear are below 30 MPa.

    Faces may take all of a bonded joint's moment; a drive's torque goes through the pin by "bore-shear" alone.
    """
    case = arm(30.0, **tables)
    found = pins(case)
    strength = case.pin_material("K").allowable
    for name, force in (("single", 30.0), ("double", 60.0)):
        by_torque = strength / (math.sqrt(3.0) * 16.0 * force * LENGTH / (math.pi * DIAMETER**3))
        outcome = found[name]
        assert outcome.verdict is verdict
        if verdict is Verdict.PASS:
            assert outcome.value.low > 20.0 * by_torque
        else:
            assert outcome.value.low == pytest.approx(by_torque, rel=0.02)
            assert (outcome.value.high > 20.0 * by_torque) == (verdict is Verdict.UNDECIDED)


def test_bending_shear_and_torsion_are_put_together_by_von_mises():
    case = arm(30.0, **driven("bore-shear"))
    plain = stress_at(case, "K", check_case(case, fidelity="beam").load_cases["single"].forces.reactions.joints)
    for torque in (10.0, 300.0):
        found = twisted(case, "K", plain, twist_of(case, "K", 7.0, -torque))
        tau = 16.0 * torque / (math.pi * DIAMETER**3)
        assert found.torsion.value == pytest.approx(tau)
        fibre, middle = math.hypot(plain.bending.value, math.sqrt(3.0) * tau), math.sqrt(3.0) * (plain.shear + tau)
        assert found.equivalent.value == pytest.approx(max(fibre, middle))
    assert twisted(case, "K", plain, twist_of(arm(30.0, **driven("eye-faces")), "K", 7.0, 300.0)) == plain


def test_over_a_motion_the_worst_pose_counts_the_torque():
    """Its largest torque is not where its largest force is."""
    case = edited(
        "four-bar", ['drive.transfer="bore-shear"', 'checks.pins={type="pins", minimum=2.0}', "motion.poses=25"]
    )
    moved = solve_case_motion(case)
    evaluated = np.ones(25, dtype=bool)
    found = {c.subject.name: c for c in envelope_outcomes(moved, {}, evaluated) if c.name == "pins"}
    forces, torque = moved.forces["lift"], moved.torque["lift"]
    diameter = case.joints["O2"].pin_diameter
    least = [math.sqrt(3.0) * 16.0 * abs(t) / (math.pi * diameter**3) for t in torque]
    assert int(np.argmax(np.abs(torque))) != int(np.argmax(np.linalg.norm(forces.forces["O2"], axis=1)))
    assert found["O2"].value.low <= case.pin_material("O2").allowable / max(least)
    assert found["O2"].value.low < 0.5 * found["A"].value.low


def rubbing(friction: float, least: float) -> Case:
    """The drive's pin itself does not rub, so that friction elsewhere makes more of its torque than of its force."""
    rubs = [
        entry
        for joint in ("A", "B")
        for entry in (f"joints.{joint}.friction={least}", f"joints.{joint}.friction_range=[{least}, {friction}]")
    ]
    moves = "motion.poses=25", 'motion.speed="10 rpm"', "motion.inertia=false"
    return edited("four-bar", ['drive.transfer="bore-shear"', 'checks.pins={type="pins", minimum=2.0}', *rubs, *moves])


def test_what_the_torque_may_be_is_in_the_band():
    """As at the pose, so over the motion: with the largest friction the pin bears no less than the band says."""

    def at_pose(case: Case) -> list[float]:
        found = check_case(case, fidelity="beam").load_cases.values()
        return [x.value for one in found for x in one.checks if x.name == "pins" and x.subject.name == "O2"]

    def moving(case: Case) -> list[float]:
        of = envelope_outcomes(solve_case_motion(case), {}, np.ones(25, dtype=bool))
        return [x.value for x in of if x.name == "pins" and x.subject.name == "O2"]

    for values in (at_pose, moving):
        may, does = min(x.low for x in values(rubbing(0.8, 0.2))), min(x.value for x in values(rubbing(0.8, 0.8)))
        assert 0.9 * does < may <= does
