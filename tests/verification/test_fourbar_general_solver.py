"""The closed forms against the general loop-closure solver: poses of both branches to 1e-10."""

import math

import numpy as np
import pytest

from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.ornithopter import OrnithopterRules


def mm(*values: float) -> tuple[str, str]:
    x, y = values
    return f"{x!r} mm", f"{y!r} mm"


def bar(length: float, first: str, second: str) -> Link:
    return Link(points={first: mm(0.0, 0.0), second: mm(length, 0.0)})


def general(four_bar: FourBar) -> Linkage:
    """Input O2-A, coupler A-B, output O4-B."""
    return Linkage(
        links={
            "frame": Link(ground=True, points={"O2": mm(0.0, 0.0), "O4": mm(four_bar.d, 0.0)}),
            "input": bar(four_bar.a, "O2", "A"),
            "coupler": bar(four_bar.b, "A", "B"),
            "output": bar(four_bar.c, "O4", "B"),
        },
        joints={
            "O2": Joint(links=("frame", "input")),
            "A": Joint(links=("input", "coupler")),
            "B": Joint(links=("coupler", "output")),
            "O4": Joint(links=("frame", "output")),
        },
    )


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize(
    "four_bar",
    [
        FourBar(a=40, b=120, c=80, d=100),
        FourBar(a=6, b=3, c=5, d=7.5),
        FourBar(a=7, b=9, c=6, d=2),
        FourBar(a=1.708728037940447, b=10.34391128670309, c=1.9978896643077524, d=10),
    ],
)
def test_four_bar(four_bar, branch):
    linkage = general(four_bar)
    low, high = four_bar.input_range().intervals[0]
    for theta2 in low + (high - low) * np.linspace(0.05, 0.95, 7):
        ours = four_bar.position(theta2, branch=branch)
        # The start leaves the solver some work and shares no digit with the answer.
        near = {"coupler": float(ours.theta3) + 0.02, "output": float(ours.theta4) - 0.02}
        angles = solve_pose(linkage, coordinate="input", angle=float(theta2), near=near).angles
        assert abs(np.exp(1j * angles["coupler"]) - np.exp(1j * ours.theta3)) < 1e-10
        assert abs(np.exp(1j * angles["output"]) - np.exp(1j * ours.theta4)) < 1e-10


def test_ornithopter_wings():
    rules = OrnithopterRules()
    drive = rules.drive()
    linkage = Linkage(
        links={
            "frame": Link(
                ground=True,
                points={
                    "O": mm(0.0, 0.0),
                    "right pivot": mm(drive.pivot_offset, drive.pivot_height),
                    "left pivot": mm(-drive.pivot_offset, drive.pivot_height),
                },
            ),
            "crank": bar(drive.throw, "O", "P"),
            "rod": bar(drive.rod, "P", "Q"),
            "right lever": bar(8.0, "right pivot", "right end"),
            "left lever": bar(8.0, "left pivot", "left end"),
        },
        joints={
            "O": Joint(links=("frame", "crank")),
            "P": Joint(links=("crank", "rod")),
            "line": Joint(type="pin-in-slot", links=("frame", "rod"), points=("O", "Q"), direction="90 deg"),
            "right pivot": Joint(links=("frame", "right lever")),
            "left pivot": Joint(links=("frame", "left lever")),
            "right slot": Joint(type="pin-in-slot", links=("right lever", "rod"), points=("right pivot", "Q")),
            "left slot": Joint(type="pin-in-slot", links=("left lever", "rod"), points=("left pivot", "Q")),
        },
    )
    for angle in np.linspace(-3.0, 3.0, 9):
        motion = drive.motion(float(angle), 1.0)
        phi = float(motion.wing_angle)
        crank = math.pi / 2 + float(angle)
        rod = math.atan2(float(motion.pin_height) - drive.throw * math.sin(crank), -drive.throw * math.cos(crank))
        near = {"rod": rod + 0.02, "right lever": math.pi - phi - 0.02, "left lever": phi + 0.02}
        pose = solve_pose(linkage, coordinate="crank", angle=crank, near=near)
        np.testing.assert_allclose(pose.position("rod", "Q"), [0.0, float(motion.pin_height)], atol=1e-9)
        assert abs(np.exp(1j * pose.angles["left lever"]) - np.exp(1j * phi)) < 1e-10
        assert abs(np.exp(1j * pose.angles["right lever"]) - np.exp(1j * (math.pi - phi))) < 1e-10
