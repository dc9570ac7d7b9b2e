import math
import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from arm_case import ARM, BAR
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import COUPLES, Source, SourceKind
from alula.fea.common.verdict import Verdict
from alula.fea.judging.bearing import grown, in_own_eyes, most_grown, weakest_eye
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.statics.joint_reaction import JointReaction
from alula.reports.sentences import told


def bearing(lines, force=-2.0):
    text = ARM.format(part=BAR, fillet=1.0, force=force, minimum=3.0, thickness=3.0)
    case = validate(tomllib.loads(f'{text}[checks.bearing]\ntype = "bearing"\n{lines}\n'))
    result = check_case(case, fidelity="beam")
    return {check.link: check for check in result.load_cases["tip"].checks if check.name == "bearing"}


def test_arm_by_hand():
    # Lever of two spans: the strut pushes with 4 N at B, the frame pulls with 2 N at O; eyes 3 mm, pins 2 mm,
    # ultimate strength 52 MPa.
    found = bearing("")
    assert set(found) == {"pin O", "pin B"}
    assert found["pin B"].value.value == pytest.approx(52.0 / (4.0 / 6.0))
    assert found["pin O"].value.value == pytest.approx(52.0 / (2.0 / 6.0))
    assert found["pin B"].limit == 3.33
    assert found["pin B"].verdict is Verdict.PASS
    assert "eye of arm" in told(found["pin B"].reason)


def test_limits_and_verdict():
    found = bearing('flight_depends = true\njoints = ["B"]', force=-46.0)
    assert set(found) == {"pin B"}
    assert found["pin B"].limit == 6.67
    assert found["pin B"].value.value == pytest.approx(52.0 * 6.0 / 92.0)
    assert found["pin B"].verdict is Verdict.FAIL
    assert bearing("minimum = 3.0", force=-46.0)["pin B"].verdict is Verdict.PASS


def test_a_pin_bears_on_the_flank_of_its_slot():
    """F/(d t) with the lever's 3.5 mm and the pin's 2 mm; the rod's hole, which slots share, is left to solids."""
    case = edited("ornithopter", ['checks.bearing={type="bearing"}'])
    asked = {"checks": {"bearing": case.checks["bearing"]}, "load_cases": {"wings-12": case.load_cases["wings-12"]}}
    case = case.model_copy(update=asked)
    result = check_case(case, fidelity="beam").load_cases["wings-12"]
    found = {check.link: check for check in result.checks if check.name == "bearing"}
    assert set(found) == {"pin O", "pin A", "pin R", "pin L", "pin slot-right", "pin slot-left"}
    force = result.reactions.joints["slot-right"].magnitude
    strength = case.material_of("lever-right").ultimate_strength
    assert found["pin slot-right"].value.value == pytest.approx(strength / (force / (2.0 * 3.5)))
    assert "eye of lever-right" in told(found["pin slot-right"].reason)


BAR_OF = """
[parts.{name}]
shape = "bar"
material = "pvc-paredes-2018"
width = "4 mm"
thickness = "{thickness} mm"
eye_diameter = "8 mm"
eye_thickness = "{thickness} mm"
fillet_radius = "1 mm"
"""


@pytest.mark.parametrize(("arm", "strut", "weaker"), [(1.5, 3.0, "arm"), (3.0, 1.5, "strut")])
def test_the_weaker_of_two_eyes_decides(arm, strut, weaker):
    """4 N on the pin of 2 mm at B: the eye of 1.5 mm decides, whichever link it belongs to."""
    head, _, rest = ARM.partition("[parts.arm]")
    text = head.replace("[links.strut]", '[links.strut]\npart = "rod"').format()
    text += BAR_OF.format(name="arm", thickness=arm) + BAR_OF.format(name="rod", thickness=strut)
    text += ("[load_cases" + rest.partition("[load_cases")[2]).format(force=-2.0, minimum=3.0)
    checks = check_case(validate(tomllib.loads(text + '[checks.eyes]\ntype = "bearing"\n')), fidelity="beam")
    (found,) = (c for c in checks.load_cases["tip"].checks if (c.name, c.link) == ("eyes", "pin B"))
    assert found.value.value == pytest.approx(52.0 / (4.0 / 3.0))
    assert f"eye of {weaker}" in told(found.reason)


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 2, 0), (2, 0, 1)])
def test_an_eye_bears_the_largest_force_of_all_ways_of_sharing(order):
    """3 and 4 N are 5 N on 2 mm by 3 mm, at 1.2 times the load; 2 N are least, so that 0.3 N more may be missed."""
    case = validate(tomllib.loads(ARM.format(part=BAR, fillet=1.0, force=-2.0, minimum=3.0, thickness=3.0)))
    wrenches = np.zeros((3, 6))
    wrenches[:, :2] = (2.0, 0.0), (3.0, 4.0), (0.0, -4.0)
    scatter = Scatter(low=0.9, high=1.2, sources=(Source(kind=SourceKind.LOAD),))
    eye, factor = weakest_eye(
        case,
        "bearing",
        "B",
        [{"arm": wrenches[k], "strut": -wrenches[k]} for k in order],
        dict.fromkeys(("arm", "strut"), scatter),
    )
    assert eye == "arm"
    assert (factor.value, factor.low) == pytest.approx((52.0 / (5.0 / 6.0), 52.0 / (1.2 * 5.3 / 6.0)))


def test_a_guide_presses_in_no_eye():
    """It holds the slider at its own pin, whose eye bears the rod alone: of 40 N along it and what stands across."""
    case = read_case("slider-crank")
    joints = solve_case_statics(case).reactions["push forward"].joints
    guided, pinned = (joints[name].wrench[:2] for name in ("guide", "B"))
    assert np.linalg.norm(guided) > 0.05 * np.linalg.norm(pinned) > 0.0
    for link, sense in (("rod", -1.0), ("slider", 1.0)):
        assert in_own_eyes(case, "B", joints)[link][:2] == pytest.approx(sense * pinned)


def test_what_two_joints_press_in_one_eye_grows_by_what_each_of_them_does():
    """One pulls with 10 N and may with 9 to 12, the other against it with 6 N and may with 4.5 to 6.6: 0.5 to 7.5 N.

    Two poses later they pull alike, where 16 N may be 12.5 to 19.5; a link of one joint grows as that does.
    """
    case, loads = read_case("flapping-wing-chosen"), (Source(kind=SourceKind.LOAD),)
    own = {"AR": Scatter(low=0.9, high=1.2, sources=COUPLES), "AL": Scatter(low=0.75, high=1.1, sources=loads)}
    wrenches = {"AR": np.zeros((3, 6)), "AL": np.zeros((3, 6))}
    wrenches["AR"][:, 1] = 10.0, 0.0, 10.0
    wrenches["AL"][:, 1] = -6.0, 0.0, 6.0
    whole = {
        name: JointReaction(joint=name, by="crank", on=case.joints[name].links[1], wrench=of)
        for name, of in wrenches.items()
    }
    poses = [{name: replace(one, wrench=one.wrench[k]) for name, one in whole.items()} for k in range(3)]
    over = SimpleNamespace(joint_growth=own.get, most_growth=lambda joint: np.full(3, own[joint].high))
    for joint in own:
        against, free, alike = (grown(case, joint, "crank", pose, own.get) for pose in poses)
        assert (against.low, against.high) == pytest.approx((0.5 / 4.0, 7.5 / 4.0))
        assert (alike.low, alike.high) == pytest.approx((12.5 / 16.0, 19.5 / 16.0))
        assert against.sources == alike.sources == (*loads, *COUPLES)
        assert free == own[joint]
        found = most_grown(case, joint, "crank", whole, over)
        assert found == pytest.approx([against.high, free.high, alike.high])
        alone = case.joints[joint].links[1]
        assert grown(case, joint, alone, poses[0], own.get) == own[joint]
        assert most_grown(case, joint, alone, whole, over) == pytest.approx(own[joint].high)


def test_joint_that_does_not_exist():
    with pytest.raises(CaseError, match=r"checks\.bearing\.joints: 'X'"):
        bearing('joints = ["X"]')


def test_a_stated_clearance_tells_what_presses_in_the_middle_of_contact():
    """4 N by a steel pin of 2 mm in an eye of 3 mm, by Hertz (Johnson, equation 4.45): p0² = P E*/(π R')."""
    text = ARM.format(part=BAR, fillet=1.0, force=-2.0, minimum=3.0, thickness=3.0)
    case = validate(tomllib.loads(f'{text}[checks.bearing]\ntype = "bearing"\njoints = ["B"]\n'))

    def reason(clearance):
        joint = case.joints["B"].model_copy(update={"clearance": clearance, "tight_in": ("strut",)})
        loose = case.model_copy(update={"joints": {**case.joints, "B": joint}})
        result = check_case(loose, fidelity="beam")
        (found,) = (check for check in result.load_cases["tip"].checks if check.name == "bearing")
        return found.reason

    assert "presses" not in told(reason(None))
    found = dict(reason(0.1).facts)
    young, pin = case.material_of("arm").youngs_modulus, case.pin_material("B").youngs_modulus
    effective = 1.0 / (1.0 / young + 1.0 / pin)
    hertz = math.sqrt(4.0 / 3.0 * effective / (math.pi * 1.0**2 / 0.05))
    assert found["high"] == pytest.approx(hertz, rel=0.02)
    assert found["low"] == found["high"]
    assert not found["yields"]
    assert "presses" in told(reason(0.1))
