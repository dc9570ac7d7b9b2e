"""Thrust along pins: of a link between layers by its equilibrium, of a load out of the plane, and none in one plane."""

import tomllib

import numpy as np
import pytest
from bars_in_layers import four_bars, parallel_bars

from alula.fea.common.sought import LEFT
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.joint_forces import JointForces
from alula.fea.standing.thrust import thrusts
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.reports.sections.reactions import thrust_texts

LEVER = """
schema_version = 1
title = "A lever"
[links.base]
ground = true
points.A = ["0 mm", "0 mm"]
points.D = ["50 mm", "0 mm"]
[links.lever]
part = "bar"
points.A = ["0 mm", "0 mm"]
points.B = ["80 mm", "0 mm"]
[joints]
A = { links = ["base", "lever"], pin_diameter = "4 mm" }
[pose]
coordinate = "lever"
angle = "20 deg"
[drive]
link = "lever"
joint = "A"
[parts.bar]
shape = "bar"
material = "pla-fdm-xy"
width = "12 mm"
thickness = "6 mm"
fillet_radius = "0 mm"
eye_diameter = "12 mm"
[load_cases.push]
[[load_cases.push.forces]]
link = "lever"
at = "B"
force = ["0 N", "-1 N", "2.5 N"]
"""


def forces_of(case: Case) -> JointForces:
    return next(iter(solve_case_statics(case).forces.values()))


def test_pins_on_either_side_of_a_bar_are_pushed_by_its_couple_over_its_length() -> None:
    """The coupler bears P alone; pins are tight in it and run in crank and rocker, in holes of 6 mm, 10 mm beside it.

    Loose ones bear up to P t/2 of each couple, so that P acts 7 to 10 mm off the mid-plane at either end. Where nothing
    but the tight ends is stated, the band holds this.
    """
    bars = {"start": 60.0, "end": 50.0}
    case = four_bars((0, 0, 1, 2), (60.0, 150.0, 120.0, 130.0), near=(15.0, 100.0), **bars)

    def stated(**inner: object) -> JointForces:
        joints = {name: joint.model_copy(update={"tight_in": joint.links}) for name, joint in case.joints.items()}
        joints |= {name: joints[name].model_copy(update={"tight_in": ("coupler",), **inner}) for name in "BC"}
        return forces_of(case.model_copy(update={"joints": joints}))

    forces, loose = stated(), stated(clearance=0.8).reactions.joints
    pull = float(np.hypot(*loose["B"].wrench[:2]))
    told = thrusts(forces)
    for name in "BC":
        thrust = abs(float(loose[name].wrench[2]))
        assert pull * (7.0 + 7.0) / 150.0 <= thrust <= pull * (10.0 + 10.0) / 150.0
        assert told[name].low <= thrust * (1.0 + 1e-9)
        assert thrust <= told[name].high * (1.0 + 1e-9)
        alone = abs(float(forces.reactions.joints[name].wrench[2]))
        assert told[name].value == pytest.approx(alone)
        every = [float(one.joints[name].wrench[2]) for one in (forces.reactions, *forces.sharings)]
        beyond = LEFT * (max(every) - min(every))  # what the search may have left
        assert told[name].high == pytest.approx(max(*every, *(-x for x in every)) + beyond, rel=1e-12)
    [sentence] = thrust_texts(forces)
    assert sentence.text.startswith("Thrust along the pins [N], which heads, washers or rings must hold: ")
    assert [number.value for number in sentence.numbers] == list(told.values())
    assert f"C {sentence.numbers[list(told).index('C')]}" in sentence.text


def test_a_load_out_of_the_plane_pushes_the_pin() -> None:
    found = thrusts(forces_of(validate(tomllib.loads(LEVER))))
    assert list(found) == ["A"]
    assert (found["A"].value, found["A"].low, found["A"].high) == pytest.approx((2.5, 2.5, 2.5))


def test_without_thrust_nothing_is_told() -> None:
    flat = forces_of(parallel_bars().in_one_plane())
    assert thrusts(flat) == {}
    assert list(thrust_texts(flat)) == []
    bonded = validate(tomllib.loads(LEVER.replace('"4 mm" }', '"4 mm", bonded = true }').split("[drive]")[0]
                                    + "[parts.bar]" + LEVER.split("[parts.bar]")[1]))  # fmt: skip
    assert thrusts(forces_of(bonded)) == {}
