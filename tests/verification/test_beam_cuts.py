"""Internal forces and deflection of the beam against ways of their own: a cut with quadrature, and virtual work."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, LineLoad, PointLoad
from alula.fea.beam.theory import internal_forces
from alula.geometry.parts.part import rectangle

SECTION = rectangle(7.0, 3.0)
number = st.floats(-10, 10).map(lambda v: round(v, 3))
vector = st.tuples(number, number, number).map(np.array)
station = st.floats(0, 100).map(lambda v: round(v, 2))


@st.composite
def balanced(draw: st.DrawFn) -> BeamLoads:
    points = [
        PointLoad(point=np.array([draw(station), draw(number), draw(number)]), wrench=draw(vector).repeat(2))
        for _ in range(draw(st.integers(1, 4)))
    ]
    lines = []
    for _ in range(draw(st.integers(0, 3))):
        start, length = draw(station), draw(st.floats(0.5, 40))
        lines.append(LineLoad(start=start, end=start + length, first=draw(vector), last=draw(vector)))
    total = wrench_beyond(points, lines, -np.inf, about=0.0)
    closing = PointLoad(point=np.array([0.0, 2.0, 0.0]), wrench=np.zeros(6))
    arm = np.array([0.0, 2.0, 0.0])
    wrench = np.concatenate([-total[:3], -total[3:] + np.cross(arm, total[:3])])
    far = PointLoad(point=np.array([150.0, 0, 0]), wrench=np.zeros(6))
    points += [PointLoad(point=closing.point, wrench=wrench), far]
    return BeamLoads(points=tuple(points), lines=tuple(lines))


def wrench_beyond(points: list[PointLoad], lines: list[LineLoad], x: float, about: float) -> np.ndarray:
    """Wrench about (about, 0, 0) of all that acts beyond x, by Gauss quadrature of the line loads."""
    total = np.zeros(6)
    centre = np.array([about, 0.0, 0.0])
    for p in points:
        if p.point[0] > x:
            total[:3] += p.wrench[:3]
            total[3:] += p.wrench[3:] + np.cross(p.point - centre, p.wrench[:3])
    nodes, weights = np.polynomial.legendre.leggauss(4)
    for q in lines:
        low = max(q.start, x)
        if low < q.end:
            for s, w in zip(nodes, weights, strict=True):
                at = low + (q.end - low) * (1 + s) / 2
                fraction = (at - q.start) / (q.end - q.start)
                force = (q.first * (1 - fraction) + q.last * fraction) * w * (q.end - low) / 2
                total[:3] += force
                total[3:] += np.cross([at - about, 0.0, 0.0], force)
    return total


@given(balanced(), st.floats(0, 1))
def test_a_cut_anywhere_carries_what_acts_beyond_it(loads: BeamLoads, fraction: float) -> None:
    forces = internal_forces(loads)
    x = fraction * 150.0
    beyond = wrench_beyond(list(loads.points), list(loads.lines), x, about=x)
    tolerance = 1e-12 * max(loads.scale, 1e-9) * loads.size
    assert forces.at(x)[:3] == pytest.approx(beyond[:3], abs=tolerance)
    assert forces.at(x)[3:] == pytest.approx(beyond[3:], abs=tolerance)


@given(balanced(), st.floats(0.01, 0.99))
def test_deflection_agrees_with_virtual_work(loads: BeamLoads, fraction: float) -> None:
    """Unit load at x on supports at 0 and 150: v(x) = ∫ (M m/(E I) + V v/(κ G A)) dx, by quadrature."""
    e, nu, length = 2400.0, 0.35, 150.0
    forces = internal_forces(loads)
    x = fraction * length
    found = deflection(forces, SECTION, young=e, poisson=nu, line=(0.0, length)).functions.at(x)
    shear = SECTION.shear_coefficient(nu) * e / (2 + 2 * nu) * SECTION.area
    nodes, weights = np.polynomial.legendre.leggauss(5)
    cuts = np.unique([*forces.breaks, x])
    v = w = size = 0.0
    for low, high in pairwise(cuts):
        for s, weight in zip(nodes, weights, strict=True):
            at = low + (high - low) * (1 + s) / 2
            # The unit force along +y or +z at x, held by its two reactions: forces beyond a cut at ``at``.
            unit_v = -(x / length) + (1.0 if at < x else 0.0)
            unit_m = -(x / length) * (length - at) + (x - at if at < x else 0.0)
            f = forces.at(at)
            dx = weight * (high - low) / 2
            v += dx * (f[5] * unit_m / (e * SECTION.i_z) + f[1] * unit_v / shear)
            w += dx * (-f[4] * unit_m / (e * SECTION.i_y) + f[2] * unit_v / shear)
            size += dx * (abs(f[4]) + abs(f[5])) * length / (e * SECTION.i_y)
    assert found[1:3] == pytest.approx([v, w], abs=1e-10 * size + 1e-15)
