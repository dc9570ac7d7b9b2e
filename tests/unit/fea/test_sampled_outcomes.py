"""What samples of tolerances say of pins and columns, where two eyes and three factors differ: without a mesh."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
from arm_case import ARM, BAR

from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject
from alula.fea.motion.buckling_history import axial_compression
from alula.fea.tolerance.numbers import covered
from alula.fea.tolerance.states import Sampler
from alula.fea.tolerance.told import SolvedCheck, Told
from alula.geometry.materials.material import TOLD
from alula.loads.case.case_file import validate
from alula.loads.case.toleranced import toleranced

BAND = Band(value=5.0, low=4.0, high=7.0)


def card(name):
    """A material with strengths of its own, whose factors differ in each sample."""
    told = {"sources": dict.fromkeys(TOLD, "a test"), "status": dict.fromkeys(TOLD, "assumed")}
    return {"title": name, "strength": "yield", "yield_strength": "40 MPa", "youngs_modulus": "2 GPa",
            "poissons_ratio": 0.3, "density": "1200 kg/m^3", **told}  # fmt: skip


def samples(rows):
    """The arm on its strut with the deviations of one load, two strengths and a modulus: what they are told by."""
    data = tomllib.loads(ARM.format(part=BAR, fillet=1.0, force=-2.0, minimum=3.0, thickness=3.0))
    data["links"]["strut"]["part"] = "strut"
    data["parts"]["arm"]["material"] = "one"
    data["parts"]["strut"] = data["parts"]["arm"] | {"material": "other"}
    entries = ("load_cases.tip.forces.0", "materials.one.yield_strength", "materials.other.yield_strength",
               "materials.other.youngs_modulus")  # fmt: skip
    more = {
        "materials": {name: card(name) for name in ("one", "other")},
        "checks": {"eyes": {"type": "bearing"}},
        "tolerances": dict.fromkeys(entries, "50 %"),
    }
    case = validate(data | more)
    variables = toleranced(case)
    assert tuple(variable.tolerance for variable in variables) == entries
    sampler = Sampler(case=case, pose=case.solve_pose(), masses={}, variables=variables)
    deviations = np.array(rows)
    none = np.zeros((1, len(entries)))
    check = SolvedCheck(
        result=SimpleNamespace(case=case), sampler=sampler, deviation=none, nominal=sampler.states(none), responses={}
    )
    return Told(check=check, states=sampler.states(deviations), deviations=deviations)


def hanging(layers, **changes):
    """A hanger on the pin by which the arm rests on its strut; each bears a force of its own."""
    data = tomllib.loads(ARM.format(part=BAR, fillet=1.0, force=1.0, minimum=3.0, thickness=3.0))
    data["links"] |= {"hanger": {"part": "arm", "points": {"B": ["0 mm", "0 mm"], "W": ["30 mm", "0 mm"]}}}
    data["links"]["strut"]["part"] = "arm"
    data["joints"]["B"]["points"] = ["B", "B"]
    data["joints"]["C"] = {"links": ["arm", "hanger"], "points": ["B", "B"], "pin_diameter": "2 mm"}
    data["pose"] |= {"coordinate": "hanger", "angle": "-90 deg"}
    data["drive"] = {"link": "hanger", "joint": "C"}
    data["load_cases"]["tip"]["forces"] += [{"link": "hanger", "at": "W", "force": ["0 N", "-4 N"]}]
    data["checks"] = {"eyes": {"type": "bearing"}, "pins": {"type": "pins", "minimum": 1.0}}
    if layers:
        data["layer_spacing"] = "4 mm"
        data["links"]["frame"]["thickness"] = "3 mm"
        for height, link in enumerate(("frame", "arm", "strut", "hanger")):
            data["links"][link]["layer"] = height
    return validate(data | changes)


def safety_factor(name, joint):
    """Of a check of a joint's pin."""
    return CheckOutcome.of(name, Subject.pin(joint), "tip", Quantity.SAFETY_FACTOR, BAND, 3.0)


def test_bearing_is_told_by_all_that_presses_in_an_eye():
    """The hanger pulls by 4 N, the strut takes that less twice what lifts the tip, and the arm the difference of both.

    On the pin that all three have, the link of each joint decides that bears more.
    """
    case = hanging(layers=False, tolerances=dict.fromkeys(("load_cases.tip.forces.0",), "400 %"))
    sampler = Sampler(case=case, pose=case.solve_pose(), masses={}, variables=toleranced(case))
    none, deviations = np.zeros((1, 1)), np.array([[0.0], [-1.0], [-2.0], [-4.0]])
    check = SolvedCheck(
        result=SimpleNamespace(case=case), sampler=sampler, deviation=none, nominal=sampler.states(none), responses={}
    )
    told = Told(check=check, states=sampler.states(deviations), deviations=deviations)
    # Tip 1, 0, -1 and -3 N: the strut bears 2, 4, 6 and 10 N, the hanger 4 N, the arm 2, 0, 2 and 6 N.
    for joint, forces in (("B", [2.0, 4.0, 6.0, 10.0]), ("C", [4.0, 4.0, 4.0, 6.0])):
        expected = np.outer([5.0, 4.0, 7.0], forces[0] / np.array(forces))
        assert told.bands(safety_factor("eyes", joint)) == pytest.approx(expected)


@pytest.mark.parametrize("layers", [False, True])
def test_the_stress_of_a_pin_of_several_joints_is_told_where_it_is_in_proportion_to_one_force(layers):
    """Between layers what the other joint presses on the pin bends it as well; all else is told."""
    case = hanging(layers=layers)
    assert [covered(case, safety_factor("pins", joint)) for joint in "BCOP"] == [not layers, not layers, True, True]
    assert all(covered(case, safety_factor("eyes", joint)) for joint in "BCOP")


ROWS = [
    (0.0, 0.0, 0.0, 0.0),
    (0.25, 0.0, 0.0, 0.0),
    (0.0, 0.2, -0.3, 0.0),
    (0.25, -0.4, 0.1, 0.5),
    (0.0, 0.3, 0.2, 0.2),
]


def test_bearing_is_told_by_the_strength_of_the_worse_eye_of_each_sample():
    """Now the one, now the other material of both links is the weaker one; the force divides."""
    told = samples(ROWS)
    for joint, strength in (("B", [1.0, 1.0, 0.7, 0.6, 1.2]), ("O", [1.0, 1.0, 1.2, 0.6, 1.3])):
        outcome = CheckOutcome.of("eyes", Subject.pin(joint), "tip", Quantity.SAFETY_FACTOR, BAND, 3.0)
        share = np.array(strength) / [1.0, 1.25, 1.0, 1.25, 1.0]
        assert told.bands(outcome) == pytest.approx(np.outer([5.0, 4.0, 7.0], share))


def test_a_column_is_told_by_the_least_and_the_largest_of_its_three_factors():
    """Compression of 4 N and more; value, least and most fall with it unequally: the ends take the outer ones."""
    told = samples(ROWS)
    case = told.check.result.case
    [compression], force = axial_compression(case, "strut", told.check.sampler.link_loads(
        told.check.nominal, told.check.deviation, "tip", "strut"))  # fmt: skip
    assert compression == pytest.approx(4.0)
    share = np.zeros((3, *force.values.shape[:2]))
    share[:, 0, 0] = np.array([1.0, 0.8, 1.3]) / force.values[0, 0, 0]
    told.check._weights["strut", "tip"] = share
    outcome = CheckOutcome.of("b", Subject.link("strut"), "tip", Quantity.BUCKLING_FACTOR, BAND, 1.0)
    more = np.array([1.0, 1.25, 1.0, 1.25, 1.0])
    young = np.array([1.0, 1.0, 1.0, 1.5, 1.2])
    ends = np.array([5.0, 4.0 / 1.3, 7.0 / 0.8])
    assert told.bands(outcome) == pytest.approx(np.outer(ends, young / more))
