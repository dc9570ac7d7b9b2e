"""Large displacement and stability against published solutions."""

from dataclasses import replace

import numpy as np
import pytest
from euler_column import euler_load
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc

from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.stability import buckling_factor
from alula.geometry.parts.part import rectangle, ring

ROD = ring(0.5, 0.25)
E, NU, LENGTH = 1e4, 0.3, 100.0
STIFFNESS = E * ROD.i_z
FIXED = Support(node=0)


def rod(wrench: list[float], supports: tuple[Support, ...] = (FIXED,)) -> FrameModel:
    return FrameModel(
        nodes=np.array([[0.0, 0, 0], [LENGTH, 0, 0]]),
        elements=(FrameElement(nodes=(0, 1), section=ROD, young=E, poisson=NU),),
        supports=supports,
        loads=(NodeLoad(node=1, wrench=np.array(wrench)),),
    )


def elastica(alpha: float) -> tuple[float, float]:
    """Tip deflection and shortening over L at P L²/(E I) = alpha, by elliptic integrals (Bisshopp & Drucker)."""

    def integrals(slope: float) -> tuple[float, float, float]:
        m = (1 + np.sin(slope)) / 2
        start = np.arcsin(1 / np.sqrt(2 * m))
        return (
            ellipkinc(np.pi / 2, m) - ellipkinc(start, m),
            ellipeinc(np.pi / 2, m) - ellipeinc(start, m),
            np.sqrt(2 * np.sin(slope)),
        )

    slope = brentq(lambda s: integrals(s)[0] - np.sqrt(alpha), 1e-6, np.pi / 2 - 1e-9, xtol=1e-14)
    _, e, root = integrals(slope)
    return 1 - 2 * e / np.sqrt(alpha), 1 - root / np.sqrt(alpha)


@pytest.mark.parametrize(
    ("alpha", "deflection", "shortening"),
    [(1, 0.30172, 0.05643), (2, 0.49346, 0.16064), (5, 0.71379, 0.38763), (10, 0.81061, 0.55500)],
)
def test_cantilever_under_a_tip_load(alpha: float, deflection: float, shortening: float) -> None:
    """Mattiasson, Int. J. Numer. Methods Engrg. 17 (1981) 145-153, table 1; Bisshopp & Drucker, Quart. Appl. Math. 3

    (1945) 272-275. The published figures agree with the elliptic integrals to every digit; the frame, whose slender
    rod (L/d = 200) also stretches and shears a little, to 5e-5 of L.
    """
    assert elastica(alpha) == pytest.approx((deflection, shortening), abs=6e-6)
    tip = solve_large_displacement(rod([0, alpha * STIFFNESS / LENGTH**2, 0, 0, 0, 0])).displacements[1] / LENGTH
    assert tip[1] == pytest.approx(deflection, abs=5e-5)
    assert -tip[0] == pytest.approx(shortening, abs=5e-5)


def test_error_falls_with_the_fourth_power_of_the_element() -> None:
    load = [0, 10 * STIFFNESS / LENGTH**2, 0, 0, 0, 0]
    tips = [solve_large_displacement(rod(load), n).displacements[1, 1] for n in (4, 8, 16)]
    assert (tips[0] - tips[1]) / (tips[1] - tips[2]) == pytest.approx(16, rel=0.35)


def test_end_moment_rolls_the_rod_to_a_circle() -> None:
    """Pure bending: curvature M/(E I) all along, so 2π E I/L closes the circle (closed form)."""
    moment = 2 * np.pi * STIFFNESS / LENGTH
    out = solve_large_displacement(rod([0, 0, 0, 0, 0, moment]), 16)
    assert out.displacements[1] == pytest.approx([-LENGTH, 0, 0], abs=1e-6 * LENGTH)
    assert out.rotations[1] == pytest.approx(np.eye(3), abs=1e-6)
    assert out.end_forces[:, :, 5] == pytest.approx(np.array([[-moment, moment]] * 16), rel=1e-6)
    half = solve_large_displacement(rod([0, 0, 0, 0, 0, moment / 2]), 16)
    assert half.displacements[1] == pytest.approx([-LENGTH, 2 * LENGTH / np.pi, 0], abs=2e-5 * LENGTH)


def test_bent_cantilever_in_space() -> None:
    """Bathe & Bolourchi, Int. J. Numer. Methods Engrg. 14 (1979) 961-986: 45° bend of radius 100, square section 1 x 1,

    E 1e7, ν 0, eight straight elements, load out of its plane. Tip at (15.9, 47.2, 53.4) under 600; Simo & Vu-Quoc,
    Comput. Methods Appl. Mech. Engrg. 58 (1986) 79-116, have (15.79, 47.23, 53.37). They take the polar moment 1/6
    as torsion constant, and so does this test. 0.5 % of the tip's displacement.
    """
    angle = np.linspace(0, np.pi / 4, 9)
    nodes = 100 * np.column_stack([1 - np.cos(angle), np.sin(angle), 0 * angle])
    section = replace(rectangle(1.0, 1.0), torsion=1 / 6)
    model = FrameModel(
        nodes=nodes,
        elements=tuple(FrameElement(nodes=(i, i + 1), section=section, young=1e7, poisson=0.0) for i in range(8)),
        supports=(FIXED,),
        loads=(NodeLoad(node=8, wrench=np.array([0, 0, 600.0, 0, 0, 0])),),
    )
    out = solve_large_displacement(model, 1)
    tip = nodes[8] + out.displacements[8]
    size = np.linalg.norm(out.displacements[8])
    assert tip == pytest.approx([15.79, 47.23, 53.37], abs=0.005 * size)
    assert tip == pytest.approx([15.9, 47.2, 53.4], abs=0.005 * size)


@pytest.mark.parametrize(
    ("name", "k", "first", "second"),
    [
        ("pinned at both ends", 1.0, {"ux", "uy", "uz", "rx", "ry"}, {"uy", "uz"}),
        ("built in and free", 2.0, {"ux", "uy", "uz", "rx", "ry", "rz"}, set()),
        ("built in and pinned", 0.699156, {"ux", "uy", "uz", "rx", "ry", "rz"}, {"uy", "uz"}),
        ("built in at both ends", 0.5, {"ux", "uy", "uz", "rx", "ry", "rz"}, {"uy", "uz", "ry", "rz"}),
    ],
)
def test_eulers_columns(name: str, k: float, first: set, second: set) -> None:
    """Gere & Goodno, Mechanics of Materials, 8th ed., table 11-1 (k of the third from tan x = x)."""
    supports = (Support(node=0, dofs=frozenset(first)), *([Support(node=1, dofs=frozenset(second))] if second else []))
    factor = buckling_factor(rod([-1, 0, 0, 0, 0, 0], supports))
    # Shear takes P/(κ G A) off, some 8e-5 for the pinned rod and 3e-4 for the one built in.
    assert factor == pytest.approx(euler_load(E, ROD.i_z, LENGTH, k), rel=1e-3), name
    assert buckling_factor(rod([1, 0, 0, 0, 0, 0], supports)) == np.inf, name
