"""Published elasticity solutions of round bodies, on meshes coarse enough for every run."""

import numpy as np
import pytest
import solid_meshes

from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports, rigid_motions
from alula.fea.solid.stress import stress_field, von_mises
from alula.fea.solvers.solve import factorise


def solved(space, load, fixed, E, nu):
    rhs = load.copy()
    rhs[fixed] = 0.0
    K = assemble_stiffness(space, E=E, nu=nu)
    return factorise(K.with_fixed(fixed), threads=1).solve(rhs).reshape(-1, 3)


def cylinder(around, radial, layers):
    """Lamé's cylinder, Code_Aster SSLV04: a 100 mm, b 200 mm, 60 MPa inside, E 200 GPa, ν 0.3, ends free.

    Returns hoop stress at the bore and outside, and the radial displacement of the bore, as errors
    relative to 100 MPa, 40 MPa and 0.059 mm (plane stress).
    """
    E, nu = 200_000.0, 0.3
    space = displacement_space(solid_meshes.ring(100.0, 200.0, 60.0, around=around, radial=radial, layers=layers))
    bore = surface_quadrature(space, "bore:A")
    load = bore.load_vector(-60.0 * bore.normals, len(space.nodes))
    u = solved(space, load, isostatic_supports(space.nodes, space.corners), E, nu)
    # The supports leave a rigid motion: take it out by least squares against the nodes' motions.
    x, y, _ = space.nodes.T
    radius = np.hypot(x, y)
    motions = rigid_motions(space.nodes, np.zeros(3)).reshape(6, -1).T
    shape = np.concatenate([motions, breathing(space)], axis=1)
    u = u - (motions @ np.linalg.lstsq(shape, u.ravel(), rcond=None)[0][:6]).reshape(-1, 3)
    nodal = stress_field(space, u, E=E, nu=nu).nodal
    cos, sin = x / radius, y / radius
    hoop = nodal[:, 0] * sin**2 + nodal[:, 1] * cos**2 - 2.0 * nodal[:, 3] * sin * cos
    radial_u = u[:, 0] * cos + u[:, 1] * sin
    inside, outside = radius < 100.0 + 1e-6, radius > 200.0 - 1e-6
    return np.array(
        [
            np.abs(hoop[inside] - 100.0).max() / 100.0,
            np.abs(hoop[outside] - 40.0).max() / 40.0,
            np.abs(radial_u[inside] - 0.059).max() / 0.059,
        ]
    )


def breathing(space):
    """Radial fields r, 1/r and the axial field z, of which Lamé's solution is made (3n, 3)."""
    x, y, z = space.nodes.T
    square = x**2 + y**2
    fields = [np.column_stack([x, y, 0 * z]), np.column_stack([x / square, y / square, 0 * z])]
    fields.append(np.column_stack([0 * x, 0 * y, z]))
    return np.array(fields).reshape(3, -1).T


def kirsch_stress(x, tension):
    """Stress of Kirsch's infinite plate with a hole of radius 1 (Timoshenko-Goodier, 3rd ed., art. 35), plane."""
    r2 = x[..., 0] ** 2 + x[..., 1] ** 2
    angle = np.arctan2(x[..., 1], x[..., 0])
    cos2, sin2 = np.cos(2.0 * angle), np.sin(2.0 * angle)
    rr = tension / 2.0 * ((1.0 - 1.0 / r2) + (1.0 - 4.0 / r2 + 3.0 / r2**2) * cos2)
    tt = tension / 2.0 * ((1.0 + 1.0 / r2) - (1.0 + 3.0 / r2**2) * cos2)
    rt = -tension / 2.0 * (1.0 + 2.0 / r2 - 3.0 / r2**2) * sin2
    cos, sin = np.cos(angle), np.sin(angle)
    xx = rr * cos**2 + tt * sin**2 - 2.0 * rt * sin * cos
    yy = rr * sin**2 + tt * cos**2 + 2.0 * rt * sin * cos
    return xx, yy, (rr - tt) * sin * cos + rt * (cos**2 - sin**2)


def hole(around, radial, layers):
    """Ring of radii 1 and 5 under Kirsch's tractions in plane strain; relative error of the peak von Mises stress."""
    E, nu, tension = 2900.0, 0.38, 10.0
    mesh = solid_meshes.ring(1.0, 5.0, 0.5, around=around, radial=radial, layers=layers, grading=1.6)
    space = displacement_space(mesh)
    edge = surface_quadrature(space, "outside")
    xx, yy, xy = kirsch_stress(edge.x, tension)
    n = edge.normals
    traction = np.stack([xx * n[..., 0] + xy * n[..., 1], xy * n[..., 0] + yy * n[..., 1], 0.0 * xx], axis=-1)
    load = edge.load_vector(traction, len(space.nodes))
    faces = np.flatnonzero(np.abs(np.abs(space.nodes[:, 2]) - 0.25) < 1e-9)
    right, left = int(np.argmax(space.nodes[:, 0])), int(np.argmin(space.nodes[:, 0]))
    fixed = np.unique([*(3 * faces + 2), 3 * right, 3 * right + 1, 3 * left + 1])
    u = solved(space, load, fixed, E, nu)
    # Peak at the hole across the tension: 3 S along x, ν 3 S along z in plane strain.
    exact = float(von_mises(np.array([3.0 * tension, 0.0, nu * 3.0 * tension, 0.0, 0.0, 0.0])))
    peak = stress_field(space, u, E=E, nu=nu).peak
    assert np.hypot(*peak.location[:2]) == pytest.approx(1.0, abs=0.02)
    return peak.value / exact - 1.0


def test_lame_cylinder():
    inside, outside, moved = cylinder(24, 4, 2)
    assert inside < 0.025
    assert outside < 0.025
    assert moved < 0.005


def test_kirsch_hole():
    assert abs(hole(24, 8, 1)) < 0.04


@pytest.mark.converged
def test_lame_cylinder_converged():
    errors = cylinder(48, 12, 4)
    assert (errors < 0.005).all()


@pytest.mark.converged
def test_kirsch_hole_converged():
    assert abs(hole(64, 24, 2)) < 0.01
