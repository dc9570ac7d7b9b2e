"""Sections of any shape: their properties against closed forms, and the rectangles, rods and tubes among them."""

import math

import numpy as np
import pytest

from alula.geometry.bodies.cut_section import CutSection, convex, joined
from alula.geometry.bodies.section import rectangle, ring
from alula.geometry.meshing.surface_section import section_of_surface


def box(low, high) -> CutSection:
    (y0, z0), (y1, z1) = low, high
    wide, tall = y1 - y0, z1 - z0
    return CutSection(
        x=0.0,
        area=wide * tall,
        centre=((y0 + y1) / 2.0, (z0 + z1) / 2.0),
        i_y=wide * tall**3 / 12.0,
        i_z=tall * wide**3 / 12.0,
        i_yz=0.0,
        hull=((y0, z0), (y1, z0), (y1, z1), (y0, z1)),
    )


def prism(outline, length=10.0):
    """Triangles of a prism along x over a convex outline (k, 2), counter-clockwise as seen from +x."""
    start, end = (np.column_stack([np.full(len(outline), x), outline]) for x in (0.0, length))
    found = []
    for i in range(len(outline)):
        j = (i + 1) % len(outline)
        found += [(start[i], start[j], end[j]), (start[i], end[j], end[i])]
    for i in range(1, len(outline) - 1):
        found += [(end[0], end[i], end[i + 1]), (start[0], start[i + 1], start[i])]
    return np.array(found)


def test_a_right_triangle_has_its_closed_form():
    """Legs b along y and h along z: b h/2, b h³/36, h b³/36 and -b²h²/72 (Gere & Goodno, 8th ed., appendix E)."""
    b, h = 6.0, 4.0
    found = section_of_surface(prism(np.array([(1.0, 2.0), (1.0 + b, 2.0), (1.0, 2.0 + h)])), 3.7)
    assert found.area == pytest.approx(b * h / 2.0)
    assert found.centre == pytest.approx((1.0 + b / 3.0, 2.0 + h / 3.0))
    assert (found.i_y, found.i_z) == pytest.approx((b * h**3 / 36.0, h * b**3 / 36.0))
    assert found.i_yz == pytest.approx(-(b**2) * h**2 / 72.0)
    assert (found.low, found.high, found.pieces) == (pytest.approx((1.0, 2.0)), pytest.approx((1.0 + b, 2.0 + h)), 1)
    assert len(set(found.hull)) >= 3
    assert found.plain is None


def test_principal_second_moments_are_the_eigenvalues():
    found = joined([box((0.0, 0.0), (16.0, 2.0)), box((0.0, 2.0), (2.0, 10.0))])
    least, greatest = found.principal
    matrix = [[found.i_y, -found.i_yz], [-found.i_yz, found.i_z]]
    assert (least, greatest) == pytest.approx(tuple(np.linalg.eigvalsh(matrix)))
    assert found.free == pytest.approx(tuple(1.0 / np.diag(np.linalg.inv(matrix))))


def test_pieces_of_a_surface_are_counted_and_holes_are_not():
    square = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    two = np.concatenate([prism(square), prism(square + np.array([0.0, 5.0]))])
    hollow = np.concatenate([prism(3.0 * square), prism(square)[:, ::-1]])
    assert section_of_surface(two, 4.0).pieces == 2
    found = section_of_surface(hollow, 4.0)
    assert (found.pieces, found.area) == (1, pytest.approx(32.0))
    assert found.plain is None  # a hollow square is no rectangle


def test_rectangles_rods_and_tubes_are_known():
    assert box((3.0, 1.0), (9.0, 5.0)).plain == rectangle(6.0, 4.0)
    angle = np.linspace(0.0, 2.0 * math.pi, 129)[:-1]
    for outer, inner in ((8.0, 0.0), (8.0, 5.0)):
        exact = ring(outer, inner)
        found = CutSection(
            x=0.0,
            area=exact.area,
            centre=(1.0, 2.0),
            i_y=exact.i_y,
            i_z=exact.i_z,
            i_yz=0.0,
            hull=convex(zip(1.0 + outer / 2.0 * np.cos(angle), 2.0 + outer / 2.0 * np.sin(angle), strict=True)),
        )
        assert found.plain.round
        assert found.plain.torsion == pytest.approx(exact.torsion)
        assert found.plain.radius_ratio == pytest.approx(inner / outer, abs=1e-6)
