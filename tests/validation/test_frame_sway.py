"""Sway of frames against closed forms: portals, and a leaning column beside a built-in one.

Portals after Timoshenko & Gere, Theory of Elastic Stability, 2nd ed., chapter 2, on buckling of frames (columns of
height h and bending stiffness E I1, a beam of length b and E I2 between them, which holds the tops with the moment
6 E I2/b per turn as they sway, a load P on each column, k² = P/(E I1), r = I2 h/(I1 b)):

    bases built in, the top sways     k h / tan(k h) = -6 r
    bases hinged, the top sways       k h tan(k h) = 6 r

A column built in at its base with the load P, beside one that is hinged at both ends and carries Q, tied at the top:
the tip of the first moves by H (tan(k h)/k - h)/P under the force H = Q v/h of the leaning second, hence
tan(k h) = k h (1 + P/Q).
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.stability import buckling_factor
from alula.geometry.parts.part import Section

YOUNG, HEIGHT, WIDTH, INERTIA = 2400.0, 100.0, 150.0, 3.0
PLANE = frozenset({"uz", "rx", "ry"})
HINGE = ALL_DOFS - {"rz"}


def beam(a: int, b: int, inertia: float = INERTIA) -> FrameElement:
    """Slender without shear and lengthening, as the closed forms have it."""
    section = Section(area=1e5, i_y=50.0, i_z=inertia, torsion=50.0, half_y=1.0, half_z=1.0, round=False)
    return FrameElement(nodes=(a, b), section=section, young=YOUNG, poisson=0.0)


def frame(base, top=None, ratio: float = 1.0, loads=(1.0, 1.0), sideways: float = 0.0) -> FrameModel:
    """A portal held in its plane; ``top`` joins the right column to the beam, rigidly where left out."""
    nodes = [[0.0, 0, 0], [0, HEIGHT, 0], [WIDTH, HEIGHT, 0], [WIDTH, 0, 0], [WIDTH, HEIGHT, 0], [0, HEIGHT, 0]]
    tie = ALL_DOFS if top is None else top
    inertia = ratio * INERTIA * WIDTH / HEIGHT
    return FrameModel(
        nodes=np.array(nodes),
        elements=(beam(0, 1), beam(5, 2, inertia), beam(3, 4)),
        supports=(
            Support(node=0, dofs=base[0]),
            Support(node=3, dofs=base[1]),
            Support(node=1, dofs=PLANE),
            Support(node=2, dofs=PLANE),
        ),
        ties=(Tie(nodes=(2, 4), dofs=tie), Tie(nodes=(1, 5), dofs=tie)),
        loads=tuple(
            NodeLoad(node=node, wrench=np.array([push, -load, 0, 0, 0, 0]))
            for node, load, push in ((1, loads[0], sideways), (4, loads[1], 0.0))
        ),
    )


def euler(kh: float) -> float:
    return kh**2 * YOUNG * INERTIA / HEIGHT**2


@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
def test_portals_sway_at_the_published_loads(ratio: float) -> None:
    built_in = brentq(lambda x: x * np.cos(x) + 6.0 * ratio * np.sin(x), np.pi / 2 + 1e-6, np.pi - 1e-6)
    hinged = brentq(lambda x: x * np.sin(x) - 6.0 * ratio * np.cos(x), 1e-6, np.pi / 2)
    assert buckling_factor(frame((ALL_DOFS, ALL_DOFS), ratio=ratio)) == pytest.approx(euler(built_in), rel=1e-3)
    assert buckling_factor(frame((HINGE, HINGE), ratio=ratio)) == pytest.approx(euler(hinged), rel=1e-3)


@pytest.mark.parametrize("leaning", [0.25, 1.0, 4.0])
def test_a_leaning_column_takes_stiffness_from_the_built_in_one(leaning: float) -> None:
    kh = brentq(lambda x: np.sin(x) - x * np.cos(x) * (1.0 + 1.0 / leaning), 1e-3, np.pi / 2)
    model = frame((ALL_DOFS, HINGE), top=HINGE, loads=(1.0, leaning))
    assert buckling_factor(model) == pytest.approx(euler(kh), rel=1e-3)


def test_the_deformed_shape_says_the_same_where_little_moves_before() -> None:
    """A perfect frame becomes unstable at its factor; a push sideways grows as 1/(1 - 1/n) until then."""
    model = frame((ALL_DOFS, HINGE), top=HINGE)
    critical = buckling_factor(model)
    for share, stable in ((0.98, True), (1.02, False)):
        assert solve_large_displacement(loaded(model, share * critical)).stable is stable
    first = sway(frame((ALL_DOFS, HINGE), top=HINGE, loads=(1e-9, 1e-9), sideways=1e-4))
    for share in (0.3, 0.6):
        load = share * critical
        grown = sway(frame((ALL_DOFS, HINGE), top=HINGE, loads=(load, load), sideways=1e-4)) / first
        assert grown == pytest.approx(1.0 / (1.0 - share), rel=0.02)


def loaded(model: FrameModel, factor: float) -> FrameModel:
    return replace(model, loads=tuple(NodeLoad(node=p.node, wrench=factor * p.wrench) for p in model.loads))


def sway(model: FrameModel) -> float:
    return float(solve_large_displacement(model).displacements[1, 0])
