"""The owl wing (Paredes 2018) as a frame: in the plane its pinned joints carry what equilibrium alone says.

Lengths of the six-bar from its Table 7; F stands 50 mm from G in the direction 228.15°; 0.25 N down at the free tip
H. The joint forces are those of the 15 x 15 equilibrium equations of this pose.
"""

from dataclasses import replace

import numpy as np
import pytest

from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import ring

TUBE = ring(5.0, 2.5)
PIN = ALL_DOFS - {"rz"}
NAMES = ("G", "F2", "A", "B3", "E3", "F4", "B4", "C4", "C5", "D5", "H", "E6", "D6")
JOINTS = {"F": ("F2", "F4"), "B": ("B3", "B4"), "E": ("E3", "E6"), "C": ("C4", "C5"), "D": ("D5", "D6")}
PUBLISHED = {"A": 0.9520, "B": 0.6978, "C": 0.3709, "D": 0.3730, "E": 0.3730, "F": 0.7511, "G": 0.7511}


def meeting(p: np.ndarray, r: float, q: np.ndarray, s: float, side: float) -> np.ndarray:
    """Point at distance r from p and s from q, to the left (1) or right (-1) of the way from p to q."""
    d = q - p
    distance = np.hypot(*d)
    a = (r**2 - s**2 + distance**2) / (2 * distance)
    return p + (a * d + side * np.sqrt(r**2 - a**2) * np.array([-d[1], d[0]])) / distance


def wing(held: str, *, bonded: bool = False) -> FrameModel:
    at = {"A": np.zeros(2), "G": np.array([0.0, 125.0])}
    at["F"] = at["G"] + 50 * np.array([np.cos(np.radians(228.15)), np.sin(np.radians(228.15))])
    at["B"] = meeting(at["A"], 112, at["F"], 60, 1)
    at["E"] = at["B"] * 190 / 112
    at["C"] = at["F"] + (at["B"] - at["F"]) * 150 / 60
    at["D"] = meeting(at["E"], 88, at["C"], 77, -1)
    at["H"] = at["C"] + (at["D"] - at["C"]) * 124 / 77
    assert np.hypot(*(at["H"] - at["G"])) == pytest.approx(272.07, abs=5e-3)
    number = {name: i for i, name in enumerate(NAMES)}
    links = [
        ("G", "F2"),
        ("A", "B3"),
        ("B3", "E3"),
        ("F4", "B4"),
        ("B4", "C4"),
        ("C5", "D5"),
        ("D5", "H"),
        ("E6", "D6"),
    ]
    shared = ALL_DOFS if bonded else PIN
    return FrameModel(
        nodes=np.array([[*at[name[0]], 0.0] for name in NAMES]),
        elements=tuple(
            FrameElement(nodes=(number[a], number[b]), section=TUBE, young=2400.0, poisson=0.38) for a, b in links
        ),
        supports=tuple(
            Support(node=number[name], dofs=ALL_DOFS if bonded or name == held else PIN) for name in ("A", "G")
        ),
        ties=tuple(Tie(nodes=(number[a], number[b]), dofs=shared) for a, b in JOINTS.values()),
        loads=(NodeLoad(node=number["H"], wrench=np.array([0, -0.25, 0, 0, 0, 0])),),
        names=NAMES,
    )


def test_joint_forces_are_those_of_equilibrium() -> None:
    out = solve_frame(wing("A"))
    for joint, force in PUBLISHED.items():
        first = JOINTS.get(joint, (joint,))[0]
        assert np.hypot(*out.joint_wrenches[NAMES.index(first), :2]) == pytest.approx(force, abs=5e-5), joint
    assert out.reactions[NAMES.index("A"), 5] == pytest.approx(-130.58, abs=5e-3)
    assert out.residual < 1e-13


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_joint_forces_do_not_depend_on_stiffness(factor: float) -> None:
    model = wing("A")
    stiff = tuple(replace(e, young=e.young * (factor if i % 2 else 1.0)) for i, e in enumerate(model.elements))
    a, b = solve_frame(model), solve_frame(replace(model, elements=stiff))
    assert b.joint_wrenches == pytest.approx(a.joint_wrenches, abs=1e-9 * 0.25 * 272)
    assert b.joint_wrenches[:, :3] == pytest.approx(a.joint_wrenches[:, :3], abs=1e-9 * 0.25)


def test_tip_falls_as_far_as_the_joints_let_it() -> None:
    """47 mm pinned and held at AE, 4.8 mm held at GF instead, 3.6 mm bonded with A and G built in (rounded figures)."""
    tip = NAMES.index("H")
    falls = [-solve_frame(model).displacements[tip, 1] for model in (wing("A"), wing("G"), wing("A", bonded=True))]
    assert falls == pytest.approx([47, 4.8, 3.6], rel=0.02)


def test_large_displacement_keeps_pins_and_balance() -> None:
    """Held at AE under a fifth of the load: the tip falls 1.5 times as far as the linear frame says."""
    model = wing("A")
    load = NodeLoad(node=NAMES.index("H"), wrench=np.array([0, -0.05, 0, 0, 0, 0]))
    out = solve_large_displacement(replace(model, loads=(load,)), 2)
    tip, g = NAMES.index("H"), NAMES.index("G")
    assert out.stable
    assert out.displacements[tip, 2] == pytest.approx(0.0, abs=1e-9)
    linear = solve_frame(model).displacements[tip, 1] / 5
    assert out.displacements[tip, 1] / linear == pytest.approx(1.5, abs=0.05)
    assert out.joint_wrenches[:, :2].sum(axis=0) == pytest.approx([0, 0.05], abs=1e-9)
    # The drive torque is what the joint at G and the load, both where they are now, turn about A.
    place = model.nodes + out.displacements[: len(NAMES)]
    moment = np.cross(place[tip], [0, -0.05, 0])[2] + np.cross(place[g], out.joint_wrenches[g, :3])[2]
    assert out.joint_wrenches[NAMES.index("A"), 5] == pytest.approx(-moment, abs=1e-6)


def test_wing_held_at_ae_reaches_a_limit_load_and_held_at_gf_does_not() -> None:
    """The links' bending lets F run towards the dead point of AE (G to F at 213.51°), where AE holds nothing more."""
    with pytest.raises(CannotRunError, match=r"gives way at 20\.3 % of its load \(a limit load"):
        solve_large_displacement(wing("A"), 2)
    held = solve_large_displacement(wing("G"), 2)
    assert held.stable
    assert held.displacements[NAMES.index("H"), 1] == pytest.approx(-4.8055, abs=5e-4)
