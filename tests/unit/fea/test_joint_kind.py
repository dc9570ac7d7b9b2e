"""One record is all that a new kind of joint needs, from case file and closure over statics to frame and verdict."""

import math
from typing import Any

import numpy as np
import pytest
from made_joints import MADE
from planar_linkages import joint, link

import alula
from alula.fea.standing.joint_forces import joint_forces
from alula.geometry.base.errors import CaseError
from alula.geometry.joints.joint_kinds import ALL_WAYS, JOINT_KINDS, JointKind, Surface, Way
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.pose import solve_pose
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import PointLoad
from alula.loads.states.actions import acting_loads
from alula.loads.statics.statics import Drive, solve_statics

LENGTH = 200.0
POST = {
    "shape": "bar",
    "material": "pvc-paredes-2018",
    "width": "4 mm",
    "thickness": "3 mm",
    "fillet_radius": "0.2 mm",
    "eye_diameter": "7 mm",
    "eye_thickness": "3 mm",
}


@pytest.fixture(autouse=True)
def _made(monkeypatch: pytest.MonkeyPatch) -> None:
    for kind in MADE:
        monkeypatch.setitem(JOINT_KINDS, kind.name, kind)


def test_in_one_plane_a_collar_is_a_slider_up_to_the_verdict() -> None:
    """The case has friction, a guide that moments press, and a motion; nothing turns its slider about the guide."""
    force = {"link": "slider", "at": "F", "force": ["-40 N", "-15 N"]}
    changes = {"joints.guide.guide_length": "30 mm", "load_cases.push.forces": [force]}
    slider, collar = (
        alula.check(
            alula.read_case("slider-crank").with_values(changes | {"joints.guide.type": kind}).in_one_plane(),
            fidelity="beam",
        )
        for kind in ("slider", "collar")
    )
    assert collar.verdict == slider.verdict
    found, expected = (
        [
            (check.value.value, check.value.low, check.value.high)
            for load_case in report.result.load_cases.values()
            for check in load_case.checks
        ]
        for report in (collar, slider)
    )
    assert len(found) > 10
    np.testing.assert_allclose(found, expected, rtol=1e-7)  # of the factors to buckling, which iterations find
    for name, load_case in slider.result.load_cases.items():
        own = collar.result.load_cases[name].reactions.joints
        for at, reaction in load_case.reactions.joints.items():
            np.testing.assert_array_equal(own[at].wrench, reaction.wrench)
    collar.plot_linkage()


def test_a_weld_closes_at_its_angle_and_bears_the_moment() -> None:
    """Two pieces of 60 and 40 mm, welded at a right angle, turn about O with a weight of 5 N at their end."""
    linkage = Linkage(
        {
            "base": link(ground=True, O=(0.0, 0.0)),
            "arm": link(O=(0.0, 0.0), W=(60.0, 0.0)),
            "hand": link(W=(0.0, 0.0), P=(40.0, 0.0)),
        },
        {"O": joint("base", "arm"), "W": joint("arm", "hand", type="weld", angle="90 deg")},
    )
    assert linkage.mobility == 1
    pose = solve_pose(linkage, coordinate="arm", angle=math.radians(-30.0), near={"hand": math.radians(50.0)})
    assert pose.angles["hand"] == pytest.approx(math.radians(60.0))
    load = PointLoad(link="hand", point="P", wrench=np.array([0.0, -5.0, 0.0, 0.0, 0.0, 0.0]))
    found = solve_statics(pose, Drive(link="arm", joint="O"), [load])
    assert found.joints["W"].wrench[[0, 1, 5]] == pytest.approx([0.0, 5.0, 5.0 * 40.0 * 0.5])
    assert found.drive_torque == pytest.approx(5.0 * (60.0 * math.cos(math.radians(30.0)) + 40.0 * 0.5))


def test_what_a_case_states_of_made_kinds_is_held_to_the_rules() -> None:
    case = alula.read_case("slider-crank")
    with pytest.raises(CaseError, match="one of 'revolute', 'pin-in-slot', 'slider', 'collar', 'ball' or 'weld'"):
        case.with_values({"joints.guide.type": "rope"})
    with pytest.raises(CaseError, match=r"joints.guide.clearance: a slider has no pin with play"):
        case.with_values({"joints.guide.type": "collar", "joints.guide.clearance": "0.1 mm"})
    with pytest.raises(CaseError, match=r"drive.joint: joint 'O2' is bonded"):
        case.with_values({"joints.O2.type": "weld", "joints.O2.friction": 0.0})
    with pytest.raises(CaseError, match=r"joints.A.guide_length: joint A is no slider"):
        case.with_values({"joints.A.type": "ball", "joints.A.guide_length": "5 mm"})


@pytest.mark.parametrize(
    ("bears", "rubs", "wrong"),
    [
        (ALL_WAYS - {Way.ACROSS}, Surface.BORE, "must bear across"),
        (ALL_WAYS - {Way.ALONG}, Surface.BORE, "what slides"),
        (ALL_WAYS, Surface.GUIDE, "what slides"),
    ],
)
def test_a_kind_that_equilibrium_could_not_hold_is_refused(bears: frozenset[Way], rubs: Surface, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        JointKind(name="odd", bears=bears, rubs=rubs)


def beam(end: str, **entries: Any) -> Case:
    """A bar fixed to the ground at A, under forces and a twist at its middle, its end S held as ``end``."""
    return validate(
        {
            "schema_version": 1,
            "title": "a beam",
            "links": {
                "ground": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "S": [f"{LENGTH} mm", "0 mm"]}},
                "bar": {
                    "part": "post",
                    "points": {"A": ["0 mm", "0 mm"], "M": [f"{LENGTH / 2} mm", "0 mm"], "S": [f"{LENGTH} mm", "0 mm"]},
                },
            },
            "joints": {
                "A": {"bonded": True, "links": ["ground", "bar"], "pin_diameter": "2 mm"},
                "S": {"type": end, "links": ["ground", "bar"], "pin_diameter": "2 mm"} | entries,
            },
            "pose": {"near": {"bar": "0 deg"}},
            "parts": {"post": POST},
            "load_cases": {
                "push": {
                    "forces": [{"link": "bar", "at": "M", "force": ["2 N", "-1 N", "3 N"]}],
                    "moments": [{"link": "bar", "at": "M", "moment": ["8 N*mm", "0 N*mm", "0 N*mm"]}],
                }
            },
        }
    )


@pytest.mark.parametrize(
    ("end", "expected"),
    # Of P = 1 N and 3 N: fixed at both ends P/2 and P L/8, simply held at S 5 P/16 (Roark); half of pull and twist.
    [
        ("weld", (-1.0, 1 / 2, -3 / 2, -4.0, -3 * LENGTH / 8, -LENGTH / 8)),
        ("collar", (0.0, 1 / 2, -3 / 2, 0.0, -3 * LENGTH / 8, -LENGTH / 8)),
        ("slider", (0.0, 1 / 2, -3 / 2, -4.0, -3 * LENGTH / 8, -LENGTH / 8)),
        ("ball", (-1.0, 5 / 16, -15 / 16, 0.0, 0.0, 0.0)),
        ("revolute", (-1.0, 5 / 16, -3 / 2, -4.0, -3 * LENGTH / 8, 0.0)),
        ("pin-in-slot", (0.0, 5 / 16, 0.0, -4.0, 0.0, 0.0)),
    ],
)
def test_the_end_of_a_beam_bears_what_its_kind_says(end: str, expected: tuple[float, ...]) -> None:
    case = beam(end)
    pose = case.solve_pose()
    found = joint_forces(case, pose, acting_loads(case, case.load_cases["push"], pose.placement, {}))
    wrench = found.reactions.joints["S"].wrench
    np.testing.assert_allclose(wrench, expected, rtol=5e-3, atol=1e-8)  # slender, but shear bends a little
    kind = JOINT_KINDS[end]
    assert {way for way, part in zip(Way, wrench, strict=True) if abs(part) > 1e-8} <= kind.bears
