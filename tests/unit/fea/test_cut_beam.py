"""Beam theory on sections that are cut from a part: Mohr's stress, eccentric pull, taper, columns, deflection."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from alula.fea.beam.column_factor import AxialForce, column_factors
from alula.fea.beam.cut_beam import beam_sections, curving_forces, cut_flexibility, cut_stress, normal_stress
from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.theory import check_beam
from alula.fea.buckling.holding import columns
from alula.geometry.bodies.cut_section import CutSection, joined
from alula.geometry.bodies.section import rectangle

LENGTH = 100.0
STATIONS = LENGTH * (np.arange(16) + 0.5) / 16.0


def box(x: float, wide: float, tall: float, y: float = 0.0, z: float = 0.0) -> CutSection:
    """A rectangle about (y, z)."""
    return CutSection(
        x=x,
        area=wide * tall,
        centre=(y, z),
        i_y=wide * tall**3 / 12.0,
        i_z=tall * wide**3 / 12.0,
        i_yz=0.0,
        hull=tuple((y + a * wide / 2.0, z + b * tall / 2.0) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))),
    )


def angle(x: float = 0.0) -> CutSection:
    """Legs of 16 and 10 mm, 2 mm thick."""
    return joined([box(x, 16.0, 2.0, 8.0, 1.0), box(x, 2.0, 8.0, 1.0, 6.0)])


def point(x: float, *wrench: float) -> PointLoad:
    return PointLoad(point=np.array([x, 0.0, 0.0]), wrench=np.array(wrench, dtype=float))


def test_the_stress_of_an_angle_is_that_about_its_principal_axes() -> None:
    """The same moments about the two principal axes, each with σ = M c/I, at every corner."""
    cut, moment = angle(), np.array([30.0, -70.0])
    found = normal_stress(cut, np.array([0.0, 0.0, 0.0, 0.0, *moment]))
    second, axes = np.linalg.eigh([[cut.i_y, -cut.i_yz], [-cut.i_yz, cut.i_z]])
    arms = np.array(cut.hull) - cut.centre
    expected = np.zeros(len(arms))
    for inertia, (along_y, along_z) in zip(second, axes.T, strict=True):
        about = moment @ (along_y, along_z)
        expected += about / inertia * (along_y * arms[:, 1] - along_z * arms[:, 0])
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert cut_stress(cut, np.array([0, 0, 0, 0, *moment]), 0.3).bending == pytest.approx(np.abs(expected).max())


def test_a_bar_pulled_beside_its_centroid_bends() -> None:
    """P/A (1 + 6 e/t), and P e L²/(8 E I) in the middle of its pins."""
    pull, off, wide, tall, young = 60.0, 1.5, 8.0, 4.0, 2400.0
    cuts = [box(x, wide, tall, y=off) for x in STATIONS]
    loads = BeamLoads(points=(point(0, -pull, 0, 0, 0, 0, 0), point(LENGTH, pull, 0, 0, 0, 0, 0)))
    check = check_beam(loads, rectangle(wide, tall), 1.0, 0.3, cuts)
    assert check.worst.equivalent == pytest.approx(pull / (wide * tall) * (1.0 + 6.0 * off / wide))
    assert check.m_z == pytest.approx(np.full(len(check.x), pull * off))
    bent = deflection(check.forces, check.section, young=young, poisson=0.3, line=(0.0, LENGTH), cuts=cuts)
    assert bent.largest == pytest.approx(pull * off * LENGTH**2 / (8.0 * young * tall * wide**3 / 12.0))


def test_an_angle_bends_across_the_plane_of_its_moment() -> None:
    """Curvatures by the principal axes: M/(E I) of each; they are those of a parabola M L²/8 high."""
    young, moment = 2400.0, 50.0
    cut = angle()
    cuts = [angle(x) for x in STATIONS]
    loads = BeamLoads(points=(point(0, 0, 0, 0, 0, 0, -moment), point(LENGTH, 0, 0, 0, 0, 0, moment)))
    forces = check_beam(loads, rectangle(1.0, 1.0), 1.0, 0.3, cuts).forces
    bent = deflection(forces, rectangle(1.0, 1.0), young=young, poisson=0.3, line=(0.0, LENGTH), cuts=cuts)
    curved = cut_flexibility(cut, young, 0.3) @ forces.at(50.0)
    assert curving_forces(forces, cuts).at(50.0)[4:] / young / cut.free == pytest.approx(curved[4:])
    second, axes = np.linalg.eigh([[cut.i_y, -cut.i_yz], [-cut.i_yz, cut.i_z]])
    turning = axes @ (axes.T @ [0.0, moment] / second) / young
    assert bent.largest == pytest.approx(float(np.linalg.norm(turning)) * LENGTH**2 / 8.0, rel=1e-9)


def body_of(cuts: list[CutSection], **features: object) -> SimpleNamespace:
    return SimpleNamespace(cuts=tuple(cuts), pins=(), ends=(), **features)


def test_a_pyramid_buckles_at_its_closed_form() -> None:
    """I ∝ x⁴ on pins: v = x sin(k/x + c) gives π² E √(I1 I2)/L², here with sides 6 to 12 mm.

    The least second moment would give a quarter of that, the harmonic mean 0.86 of it.
    """
    side = 6.0 + 6.0 * STATIONS / LENGTH
    (second, stretches), _ = columns(body_of([box(x, s, s) for x, s in zip(STATIONS, side, strict=True)]))
    force = AxialForce(breaks=np.array([0.0, LENGTH]), values=np.ones((1, 3, 1)))
    young = 2000.0
    (found,) = column_factors(force, young * second, held=(0.0, LENGTH), stretches=stretches)
    expected = math.pi**2 * young * math.sqrt(6.0**4 * 12.0**4) / 12.0 / LENGTH**2
    assert found == pytest.approx(expected, rel=5e-3)


def test_beam_theory_holds_away_from_pins_and_where_sections_change_slowly() -> None:
    pin = SimpleNamespace(x=0.0)
    across = {"across": lambda pin: 10.0}

    def held(cuts: list[CutSection]) -> list[float]:
        body = body_of(cuts, **across)
        body.pins = (pin, SimpleNamespace(x=LENGTH))
        return [cut.x for cut in beam_sections(body)]

    even = [box(x, 10.0, 4.0) for x in STATIONS]
    assert held(even) == [x for x in STATIONS if 15.0 < x < 85.0]
    assert held([box(x, 10.0, 4.0, y=0.3 * x) for x in STATIONS]) == []  # off the line
    assert held([box(x, 10.0 + 0.6 * x, 4.0) for x in STATIONS]) == []  # a wedge
    assert held([box(x, 60.0, 4.0) for x in STATIONS]) == []  # a plate
    fork = [joined([box(x, 10.0, 4.0, z=-4.0), box(x, 10.0, 4.0, z=4.0)]) for x in STATIONS]
    assert held(fork) == []
    stepped = [box(x, 10.0 if x < 50.0 else 14.0, 4.0) for x in STATIONS]
    assert held(stepped) == [x for x in held(even) if abs(x - 50.0) > 6.0 and abs(x - 100.0) > 19.0]
