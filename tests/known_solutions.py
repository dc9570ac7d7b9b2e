"""Elasticity problems with known stress, solved under the exact tractions on every face of a mesh."""

import numpy as np

from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports
from alula.fea.solvers.solve import factorise

E, NU = 2900.0, 0.38
PRESSURE, INNER, OUTER = 10.0, 1.0, 2.0
TENSION = 10.0


def lame(x):
    """Plane-stress tube under inner pressure (Timoshenko-Goodier, 3rd ed., art. 28), components (..., 6)."""
    radius = np.hypot(x[..., 0], x[..., 1])
    base, share = PRESSURE * INNER**2 / (OUTER**2 - INNER**2), OUTER**2 / radius**2
    return _polar(x, base * (1.0 - share), base * (1.0 + share), 0.0, 0.0)


LAME_PEAK = PRESSURE * np.sqrt(1.0 + 5.0 / 3.0 + 25.0 / 9.0)
"""Von Mises stress at the bore: σr = −p, σθ = p (b² + a²)/(b² − a²) = 5/3 p."""


def kirsch(x):
    """Hole of radius ``INNER`` in a plane-strain plate under tension along x (art. 35), components (..., 6)."""
    radius, angle = np.hypot(x[..., 0], x[..., 1]), np.arctan2(x[..., 1], x[..., 0])
    a2, a4, double = INNER**2 / radius**2, INNER**4 / radius**4, np.cos(2.0 * angle)
    radial = TENSION / 2.0 * ((1.0 - a2) + (1.0 - 4.0 * a2 + 3.0 * a4) * double)
    hoop = TENSION / 2.0 * ((1.0 + a2) - (1.0 + 3.0 * a4) * double)
    shear = -TENSION / 2.0 * (1.0 + 2.0 * a2 - 3.0 * a4) * np.sin(2.0 * angle)
    return _polar(x, radial, hoop, shear, NU * (radial + hoop))


KIRSCH_PEAK = 3.0 * TENSION * np.sqrt(1.0 - NU + NU**2)
"""Von Mises stress at the hole: σθ = 3 S with σz = ν σθ."""


def _polar(x, radial, hoop, shear, axial):
    radius = np.hypot(x[..., 0], x[..., 1])
    c, s = x[..., 0] / radius, x[..., 1] / radius
    out = np.zeros((*x.shape[:-1], 6))
    out[..., 0] = radial * c**2 + hoop * s**2 - 2.0 * shear * s * c
    out[..., 1] = radial * s**2 + hoop * c**2 + 2.0 * shear * s * c
    out[..., 2] = axial
    out[..., 3] = (radial - hoop) * s * c + shear * (c**2 - s**2)
    return out


def law(gradient, E, nu):
    """Stress (..., 3, 3) of displacement gradients: σ = E/(1+ν) (ε + ν/(1−2ν) tr ε I) (Timoshenko-Goodier, art. 6)."""
    strain = (gradient + np.swapaxes(gradient, -1, -2)) / 2.0
    dilatation = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
    return E / (1.0 + nu) * (strain + nu / (1.0 - 2.0 * nu) * dilatation * np.eye(3))


def tensor(sigma):
    """Components (..., 6) as (..., 3, 3)."""
    return sigma[..., [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(*sigma.shape[:-1], 3, 3)


def solved(mesh, exact, *, order=2):
    """Return the space and the displacements (n, 3) under the exact tractions; ``exact`` must be in equilibrium."""
    space = displacement_space(mesh, order=order)
    faces = surface_quadrature(space, *mesh.surfaces)
    traction = np.einsum("kqij,kqj->kqi", tensor(exact(faces.x)), faces.normals)
    load = faces.load_vector(traction, len(space.nodes))
    supports = isostatic_supports(space.nodes, space.corners)
    load[supports] = 0.0
    K = assemble_stiffness(space, E=E, nu=NU)
    return space, factorise(K.with_fixed(supports), threads=1).solve(load).reshape(-1, 3)
