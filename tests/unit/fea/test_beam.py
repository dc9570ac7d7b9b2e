import numpy as np
import pytest

from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, LineLoad, PointLoad
from alula.fea.beam.theory import check_beam, internal_forces, section_stress, uniform_cantilever
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import rectangle, ring

TUBE = ring(5.0, 2.5)
BAR = rectangle(6.0, 2.0)


def point(x: float, *force: float, y: float = 0.0, z: float = 0.0, moment: tuple[float, ...] = (0, 0, 0)) -> PointLoad:
    fx, fy, fz = (*force, 0.0, 0.0, 0.0)[:3]
    return PointLoad(point=np.array([x, y, z]), wrench=np.array([fx, fy, fz, *moment], dtype=float))


THREE_POINT = BeamLoads(points=(point(0, 0, 1), point(50, 0, -2), point(100, 0, 1)))


def test_three_point_bending_has_its_textbook_diagrams() -> None:
    check = check_beam(THREE_POINT, TUBE, 41.4)
    assert check.x.tolist() == [0, 50, 50, 100]
    # What lies beyond a cut left of the middle carries +1 N of the 2 N, less the -2 N: -1 N in all.
    assert check.v_y.tolist() == [-1, -1, 1, 1]
    assert check.m_z == pytest.approx([0, 50, 50, 0], abs=1e-12)
    assert check.worst_x == 50
    assert check.worst.bending == pytest.approx(50 * 2.5 / TUBE.i_z)
    assert check.safety_factor == pytest.approx(41.4 * TUBE.i_z / 125)


def test_sagging_moment_pulls_the_lower_side() -> None:
    # A load downwards between supports sags the beam: the side y < 0 is in tension, so -M_z y/I_z > 0 there.
    m_z = internal_forces(THREE_POINT).at(50.0)[5]
    assert -m_z * (-TUBE.half_y) / TUBE.i_z > 0


def test_tension_is_positive() -> None:
    check = check_beam(BeamLoads(points=(point(0, -3), point(80, 3))), BAR, 30.0)
    assert check.n.tolist() == [3, 3]
    assert check.axial == pytest.approx([0.25, 0.25])
    assert check.safety_factor == pytest.approx(120.0)


def test_values_on_both_sides_of_a_jump() -> None:
    forces = internal_forces(THREE_POINT)
    assert forces.at(50.0, "before")[1] == -1
    assert forces.at(50.0, "after")[1] == 1
    assert forces.at(0.0, "before")[1] == forces.at(0.0, "after")[1] == -1


def test_force_off_the_axis_brings_its_moment() -> None:
    # 4 N along x at y = 3 on the left, -4 N at y = 0 on the right: the couple of 12 N·mm is held by a pair of 0.12 N.
    loads = BeamLoads(points=(point(0, 4, -0.12, y=3), point(100, -4, 0.12)))
    forces = internal_forces(loads)
    assert forces.at(0.0)[5] == pytest.approx(12.0)  # M_z > 0 presses y > 0, where the push acts
    assert forces.at(100.0, "before")[5] == pytest.approx(0.0, abs=1e-12)


def test_drive_couple_and_torque() -> None:
    loads = BeamLoads(points=(point(0, moment=(5, 0, 7)), point(60, moment=(-5, 0, -7))))
    check = check_beam(loads, TUBE, 41.4)
    assert check.t.tolist() == [-5, -5]
    assert check.m_z.tolist() == [-7, -7]
    bending, torsion = 7 * 2.5 / TUBE.i_z, 5 * 2.5 / TUBE.torsion
    assert check.worst.equivalent == pytest.approx(np.sqrt(bending**2 + 3 * torsion**2))


def test_triangular_load_on_supports() -> None:
    # Gere & Goodno, appendix G: q rising from 0 to q0 has its largest moment q0 L²/(9√3) at L/√3.
    q0, length = 0.3, 90.0
    loads = BeamLoads(
        points=(point(0, 0, q0 * length / 6), point(length, 0, q0 * length / 3)),
        lines=(LineLoad(start=0, end=length, first=np.zeros(3), last=np.array([0, -q0, 0])),),
    )
    x, _, largest = internal_forces(loads).largest(lambda f: abs(f[:, 5]))
    assert largest == pytest.approx(q0 * length**2 / (9 * np.sqrt(3)), rel=1e-12)
    assert x == pytest.approx(length / np.sqrt(3), rel=1e-6)


def test_unbalanced_loads_are_refused_with_their_resultant() -> None:
    loads = BeamLoads(points=(point(0, 0, 1), point(100, 0, -0.9)))
    with pytest.raises(CannotRunError, match=r"resultant force \(0, 0\.1, 0\) N, moment \(0, 0, -95\)"):
        internal_forces(loads)


def test_unbalanced_moment_alone_is_refused() -> None:
    with pytest.raises(CannotRunError, match="do not balance"):
        internal_forces(BeamLoads(points=(point(0, 0, 1), point(100, 0, -1))))


def test_imbalance_just_below_the_limit_passes() -> None:
    assert internal_forces(BeamLoads(points=(point(0, 1), point(100, -1 - 1.9e-6)))).at(50.0)[0] < 0
    with pytest.raises(CannotRunError, match="do not balance"):
        internal_forces(BeamLoads(points=(point(0, 1), point(100, -1 - 2.1e-6))))


def test_line_load_counts_in_the_balance() -> None:
    line = LineLoad(start=0, end=10, first=np.array([0, -1, 0]), last=np.array([0, -3, 0]))
    with pytest.raises(CannotRunError, match="do not balance"):
        internal_forces(BeamLoads(points=(point(0, 0, 10), point(10, 0, 10)), lines=(line,)))
    good = BeamLoads(points=(point(0, 0, 25 / 3), point(10, 0, 35 / 3)), lines=(line,))
    assert good.imbalance < 1e-15


def test_unloaded_beam_is_infinitely_safe() -> None:
    check = check_beam(BeamLoads(points=(point(0), point(10))), TUBE, 41.4)
    assert check.safety_factor == np.inf


@pytest.mark.parametrize("x", [-0.1, 100.1])
def test_station_off_the_beam_is_refused(x: float) -> None:
    with pytest.raises(CannotRunError, match="off the beam"):
        internal_forces(THREE_POINT).at(x)


def test_bad_records_are_refused() -> None:
    with pytest.raises(CannotRunError, match="6 finite numbers"):
        PointLoad(point=np.zeros(2), wrench=np.zeros(5))
    with pytest.raises(CannotRunError, match="finite"):
        PointLoad(point=np.array([np.nan, 0.0]), wrench=np.zeros(6))
    with pytest.raises(CannotRunError, match="start < end"):
        LineLoad(start=2, end=2, first=np.zeros(3), last=np.zeros(3))
    with pytest.raises(CannotRunError, match="two stations"):
        internal_forces(BeamLoads(points=(point(3, 1), point(3, -1))))


def test_records_keep_their_own_copies() -> None:
    place = np.zeros(3)
    load = PointLoad(point=place, wrench=np.zeros(6))
    place[0] = 7.0
    assert load.point[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        load.point[0] = 1.0


def test_section_stress_of_a_solid_round_and_a_rectangle() -> None:
    solid = ring(4.0, 0.0)
    stress = section_stress(solid, np.array([0, 3.0, 4.0, 2.0, 6.0, 8.0]))
    assert stress.bending == pytest.approx(32 * 10 / (np.pi * 64))
    assert stress.torsion == pytest.approx(16 * 2 / (np.pi * 64))
    flat = section_stress(BAR, np.array([12.0, 3.0, 0, 2.0, 6.0, 8.0]))
    assert flat.axial == 1.0
    assert flat.bending == pytest.approx(6 * 8 / (2 * 6**2) + 6 * 6 / (6 * 2**2))
    # Timoshenko & Goodier, table of section 109: b/a = 3 has τ = T/(0.267 (2a)² (2b)).
    assert flat.torsion == pytest.approx(2.0 / (0.267 * 2**2 * 6), rel=2e-3)


def test_thin_tube_under_everything_together() -> None:
    """Thin-walled: σ = N/A + M r cos/I, τ = T/(2 π r² t) + V sin/(π r t), their von Mises over the circumference."""
    r, t = 10.0, 0.02
    thin = ring(2.0 * r + t, 2.0 * r - t)
    n, v, twist, m = 7.0, 4.0, 60.0, 80.0
    around = np.linspace(0.0, 2.0 * np.pi, 100_001)
    normal = n / thin.area - m / (np.pi * r**2 * t) * np.cos(around)
    shear = twist / (2.0 * np.pi * r**2 * t) - v / (np.pi * r * t) * np.sin(around)
    expected = np.sqrt(normal**2 + 3.0 * shear**2).max()
    found = section_stress(thin, np.array([n, v, 0, twist, 0, m]))
    assert found.equivalent == pytest.approx(expected, rel=2e-3)
    assert found.shear == pytest.approx(2.0 * v / thin.area, rel=2e-3)
    rim = np.hypot(n / thin.area + found.bending, np.sqrt(3.0) * found.torsion)
    axis = np.hypot(n / thin.area, np.sqrt(3.0) * (found.torsion + found.shear))
    assert found.equivalent > 1.05 * max(rim, axis)


def test_whole_wing_as_a_cantilever() -> None:
    check = uniform_cantilever(0.25, 270.0, TUBE, 41.4)
    assert check.moment == 33.75
    assert check.stress == pytest.approx(2.934, abs=5e-4)
    assert check.safety_factor == pytest.approx(14.11, abs=5e-3)
    with pytest.raises(CannotRunError, match="length above zero"):
        uniform_cantilever(0.25, 0.0, TUBE, 41.4)


def test_deflection_of_timoshenkos_cantilever_mirrored() -> None:
    # Half of a beam on two supports, loaded by 2 N in the middle, is the cantilever of 88 mm under 1 N.
    loads = BeamLoads(points=(point(0, 0, 1), point(88, 0, -2), point(176, 0, 1)))
    result = deflection(internal_forces(loads), TUBE, young=2900.0, poisson=0.38, line=(0.0, 176.0))
    assert result.largest == pytest.approx(2.732449, abs=5e-7)
    assert result.functions.at(88.0)[1] == pytest.approx(-2.732449, abs=5e-7)


def test_deflection_of_a_uniformly_loaded_beam() -> None:
    # Gere & Goodno, appendix G: 5 q L⁴/(384 E I); with shear q L²/(8 κ G A) more (their section 9.5 for the method).
    q, length, e, nu = 0.02, 100.0, 2400.0, 0.35
    line = LineLoad(start=0, end=length, first=np.array([0, 0, -q]), last=np.array([0, 0, -q]))
    end = point(0, 0, 0, q * length / 2)
    loads = BeamLoads(points=(end, point(length, 0, 0, q * length / 2)), lines=(line,))
    result = deflection(internal_forces(loads), BAR, young=e, poisson=nu, line=(0.0, length))
    shear = q * length**2 / (8 * BAR.shear_coefficient(nu) * e / (2 + 2 * nu) * BAR.area)
    assert result.functions.at(50.0)[2] == pytest.approx(-(5 * q * length**4 / (384 * e * BAR.i_y) + shear), rel=1e-12)


def test_deflection_under_pull_and_torque() -> None:
    loads = BeamLoads(points=(point(0, -3, moment=(-4, 0, 0)), point(80, 3, moment=(4, 0, 0))))
    result = deflection(internal_forces(loads), TUBE, young=2400.0, poisson=0.35, line=(0.0, 80.0))
    at_end = result.functions.at(80.0)
    assert at_end[0] == pytest.approx(3 * 80 / (2400 * TUBE.area))
    assert at_end[3] == pytest.approx(4 * 80 / (2400 / 2.7 * TUBE.torsion))
    assert result.largest == 0.0


def test_deflection_from_the_section_at_one_station() -> None:
    """A cantilever from x = 0: F x² (3 L - x)/(6 E I) and the shear's F x/(κ G A), both ways out of the axis."""
    loads = BeamLoads(
        points=(point(0, 0, -3, -2, moment=(0, 2 * 80, -3 * 80)), point(80, 0, 3, 2)),
    )
    line = deflection(internal_forces(loads), TUBE, young=2400.0, poisson=0.35, line=(0.0, 0.0)).functions
    shear = TUBE.shear_coefficient(0.35) * 2400 / 2.7 * TUBE.area
    for x in (20.0, 80.0):
        per_force = x**2 * (240 - x) / (6 * 2400 * TUBE.i_z) + x / shear
        assert line.at(x)[1:3] == pytest.approx([3 * per_force, 2 * per_force])
    assert line.at(0.0)[4:] == pytest.approx([0.0, 0.0], abs=1e-12)
