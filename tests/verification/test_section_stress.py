"""Stress over a section by series and closed form, beside finite elements of Saint-Venant's problem on the section.

τ = ∇F + p with ∫ τ·∇v = ∫ (V_y y/I_z + V_z z/I_y) v for every v, which is equilibrium and a free rim. p has the curl:
κ (z²/2, 0) with κ = ν/(1+ν) V_y/I_z, (0, κ y²/2) likewise for V_z, (-z, y) for torsion. So every force and the torsion
constant come from one scalar problem, which shares nothing with the series.
"""

import functools

import numpy as np
import pytest
from skfem import Basis, ElementQuad2, ElementTriP2, LinearForm, MeshQuad, MeshTri, condense, solve
from skfem.models.poisson import laplace

from alula.fea.beam.piecewise import Piecewise
from alula.fea.beam.section_stress import equivalent_bound, equivalent_stress, rim_shear, section_stress
from alula.geometry.parts.part import rectangle, ring

SECTIONS = {
    "tall": rectangle(10.0, 2.5),
    "square": rectangle(4.0, 4.0),
    "flat": rectangle(2.0, 3.0),
    "very flat": rectangle(2.0, 30.0),
    "rod": ring(5.0, 0.0),
    "tube": ring(5.0, 2.5),
    "thin tube": ring(5.0, 4.75),
}


def meshed(section):
    """Mesh, element, and the corners of the reference cell."""
    if section.round and section.radius_ratio == 0.0:
        mesh = MeshTri.init_circle(5).scaled(section.half_y)
        return mesh, ElementTriP2(), np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    corners = np.array([[0.0, 1.0, 0.0, 1.0, 0.5], [0.0, 0.0, 1.0, 1.0, 0.5]])
    if not section.round:
        crowded = -np.cos(np.linspace(0.0, np.pi, 41))
        return MeshQuad.init_tensor(section.half_y * crowded, section.half_z * crowded), ElementQuad2(), corners
    radii, around = section.half_y * np.linspace(section.radius_ratio, 1.0, 17), 240
    angle = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    points = np.array([np.outer(radii, np.cos(angle)).ravel(), np.outer(radii, np.sin(angle)).ravel()])
    i, j = (n.ravel() for n in np.meshgrid(np.arange(16), np.arange(around), indexing="ij"))
    after = (j + 1) % around
    cells = np.array([i * around + j, (i + 1) * around + j, (i + 1) * around + after, i * around + after])
    return MeshQuad(points, cells), ElementQuad2(), corners


@functools.cache
def fields(name: str, nu: float):
    """σ, τ_y, τ_z (3, points, 6) under unit forces, and the torsion constant."""
    section = SECTIONS[name]
    mesh, element, corners = meshed(section)
    basis = Basis(mesh, element, intorder=5)
    at = Basis(mesh, element, quadrature=(corners, np.ones(corners.shape[1])))
    kappa = nu / (1.0 + nu)

    def source(force, y, z):
        return {1: y / section.i_z, 2: z / section.i_y, 3: 0.0 * y}[force]

    def curled(force, y, z):
        return {
            1: (kappa / section.i_z * z**2 / 2.0, 0.0 * y),
            2: (0.0 * y, kappa / section.i_y * y**2 / 2.0),
            3: (-z, y),
        }[force]

    matrix = laplace.assemble(basis)
    y, z = at.global_coordinates()
    found = np.zeros((3, *y.shape, 6))
    found[0, ..., 0], found[0, ..., 4], found[0, ..., 5] = 1.0 / section.area, z / section.i_y, -y / section.i_z
    constant = 0.0
    for force in (1, 2, 3):

        def right(v, w, force=force):
            p = curled(force, *w.x)
            return source(force, *w.x) * v - p[0] * v.grad[0] - p[1] * v.grad[1]

        values = solve(*condense(matrix, LinearForm(right).assemble(basis), D=np.array([0])))
        gradient = at.interpolate(values).grad
        found[1:, ..., force] = np.stack(curled(force, y, z)) + gradient
        if force == 3:
            inside = basis.global_coordinates()
            twisted = np.stack(curled(3, *inside)) + basis.interpolate(values).grad
            constant = float(((inside[0] * twisted[1] - inside[1] * twisted[0]) * basis.dx).sum())
            found[1:, ..., 3] /= constant
    return found, constant


def loads():
    generator = np.random.default_rng(7)
    yield from np.eye(6)
    for _ in range(40):
        yield generator.normal(size=6) * 10.0 ** generator.uniform(-1.0, 1.0, size=6)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.45])
@pytest.mark.parametrize("name", SECTIONS)
def test_the_largest_von_mises_is_that_of_finite_elements(name, nu):
    section = SECTIONS[name]
    found, _ = fields(name, nu)
    size = np.array([1.0, 1.0, 1.0, *3 * (np.hypot(section.half_y, section.half_z) / 2.0,)])
    for forces in loads():
        normal, along, across = found @ (forces * size)
        expected = np.sqrt((normal**2 + 3.0 * (along**2 + across**2)).max())
        assert equivalent_stress(section, forces[None] * size, nu)[0] == pytest.approx(expected, rel=4e-3), forces


@pytest.mark.parametrize("name", SECTIONS)
def test_no_stress_exceeds_its_bound_and_a_moment_reaches_it(name):
    section = SECTIONS[name]
    forces = np.array([*loads()]) * (1.0, 1.0, 1.0, *3 * (np.hypot(section.half_y, section.half_z) / 2.0,))
    largest = equivalent_stress(section, forces, 0.3)
    bound = equivalent_bound(section, np.abs(forces), 0.3)
    assert np.all(bound >= largest * (1.0 - 1e-12))
    np.testing.assert_allclose(bound[[0, 4, 5]], largest[[0, 4, 5]], rtol=1e-2)


@pytest.mark.parametrize("name", ["tall", "thin tube"])
def test_the_largest_stress_of_a_beam_is_the_same_where_bounds_rule_stations_out(name):
    section, generator = SECTIONS[name], np.random.default_rng(3)

    def stress(forces):
        return equivalent_stress(section, forces, 0.3)

    for _ in range(20):
        coefficients = generator.normal(size=(4, 6, 4)) * 0.2 ** np.arange(4) * generator.uniform(0.1, 1.0, (4, 1, 1))
        coefficients[generator.integers(4), :, 2:] = 0.0  # as between stations without line loads
        beam = Piecewise(breaks=np.array([0.0, 5.0, 8.0, 20.0, 30.0]), coefficients=coefficients)
        found = beam.largest(stress, lambda sizes: equivalent_bound(section, sizes, 0.3))
        x, side, value = beam.largest(stress)
        assert found == (pytest.approx(x, rel=1e-6), side, pytest.approx(value, rel=1e-12))


@pytest.mark.parametrize("name", SECTIONS)
def test_the_torsion_constant_is_that_of_finite_elements(name):
    polygon = 1e-3 if SECTIONS[name].round else 1e-4
    assert SECTIONS[name].torsion == pytest.approx(fields(name, 0.25)[1], rel=polygon)


@pytest.mark.parametrize(("ratio", "middle", "edge"), [(2.0, 0.983, 1.033), (1.0, 0.940, 1.126), (0.5, 0.856, 1.396),
                                                       (0.25, 0.805, 1.988)])  # fmt: skip
def test_shear_of_a_rectangle_is_that_of_timoshenko_and_goodier(ratio, middle, edge):
    """Theory of Elasticity, 3rd ed., section 124, table for ν = 1/4: multiples of 3V/2A, by height over width."""
    section = rectangle(10.0 * ratio, 10.0)
    assert rim_shear(section, 0.25)[0] * section.area / 1.5 == pytest.approx(edge, abs=1e-3)
    assert section_stress(section, np.array([0, 2.0, 0, 0, 0, 0]), 0.25).shear == pytest.approx(
        3.0 / section.area * max(edge, middle), rel=1e-3
    )


def test_shear_of_a_rod_is_loves():
    """Love, Mathematical Theory of Elasticity, section 230: (3 + 2ν)/(8 (1 + ν)) V r²/I in the middle."""
    rod = SECTIONS["rod"]
    found = section_stress(rod, np.array([0, 3.0, 4.0, 0, 0, 0]), 0.3)
    assert found.shear == pytest.approx(3.6 / 10.4 * 5.0 * 2.5**2 / rod.i_z)


def test_shear_of_a_tube_at_its_neutral_axis_is_the_handbooks_on_average():
    """Gere & Goodno, 8th ed., section 5.9: 4V/3A (1 + m + m²)/(1 + m²) over the wall, which τ b I = V Q gives."""
    tube = SECTIONS["tube"]
    found, _ = fields("tube", 0.3)
    mesh, _, corners = meshed(tube)
    y, z = mesh.mapping().F(corners)
    at = np.isclose(y, 0.0, atol=1e-9) & (z > 0.0)
    depth, order = z[at], np.argsort(z[at])
    mean = np.trapezoid(found[1][at][order, 1], depth[order]) / 1.25
    assert mean == pytest.approx(4.0 / 3.0 / tube.area * 1.75 / 1.25, rel=1e-3)
    assert section_stress(tube, np.array([0, 1.0, 0, 0, 0, 0]), 0.3).shear > 1.3 * mean  # at the bore
