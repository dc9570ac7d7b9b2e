"""Stress over the cross-section of a prismatic beam: Saint-Venant's exact elastic fields and their largest von Mises.

σ = N/A - M_z y/I_z + M_y z/I_y; the shear stress τ = (τ_y, τ_z) has no part across the rim and satisfies

    div τ = -V_y y/I_z - V_z z/I_y,   curl τ = 2 G θ - ν/(1+ν) (V_y z/I_z - V_z y/I_y)

(Timoshenko & Goodier, Theory of Elasticity, 3rd ed., sections 104 to 109 and 120 to 124; Love, Mathematical Theory of
Elasticity, 4th ed., sections 229 to 231). It is closed for tubes and rods, and a series for rectangles. Forces pass
through the section's centre. Lengths in mm, forces in N, moments in N·mm, stresses in MPa.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.parts.part import Section

Floats = NDArray[np.float64]

_ACROSS = 41
"""Points across a rectangle, either way: Chebyshev's, which crowd at the rim."""
_RADIAL, _AROUND = 17, 120
_TERMS = 600
"""Of a rectangle's series; what is left falls with the square of their number at the rim, exponentially inside."""


@dataclass(frozen=True, kw_only=True)
class SectionStress:
    """Stresses of one section under N, V, T, M [MPa], the first four each by itself.

    Attributes
    ----------
    axial : float
        N/A, tension positive.
    bending : float
        At the extreme fibre: round √(M_y² + M_z²) c/I, rectangular |M_z| c_y/I_z + |M_y| c_z/I_y (a corner).
    torsion : float
        Largest shear stress of T.
    shear : float
        Largest shear stress of V_y and V_z.
    equivalent : float
        Largest von Mises stress √(σ² + 3 τ²) over the section, of all of them together.
    """

    axial: float
    bending: float
    torsion: float
    shear: float
    equivalent: float


def section_stress(section: Section, forces: Floats, poisson: float = 0.3) -> SectionStress:
    """Return the stresses of a section under internal forces.

    Parameters
    ----------
    section : Section
        Of the beam.
    forces : ndarray, shape (6,)
        N, V_y, V_z [N], T, M_y, M_z [N·mm].
    poisson : float, optional
        Poisson's ratio, which tells how the shear stress of V is spread.

    Returns
    -------
    SectionStress
        Each by itself and all together.
    """
    n, v_y, v_z, t, m_y, m_z = map(float, forces)
    root = math.sqrt(3.0)
    alone = np.array([[0.0, 0.0, 0.0, t, 0.0, 0.0], [0.0, v_y, v_z, 0.0, 0.0, 0.0], [n, v_y, v_z, t, m_y, m_z]])
    twist, shear, together = equivalent_stress(section, alone, poisson)
    return SectionStress(
        axial=n / section.area,
        bending=float(bending_stress(section, m_y, m_z)),
        torsion=float(twist) / root,
        shear=float(shear) / root,
        equivalent=float(together),
    )


def bending_stress(section: Section, m_y: ArrayLike, m_z: ArrayLike) -> Floats:
    """Return the largest bending stress over a section.

    Parameters
    ----------
    section : Section
        Of the beam.
    m_y, m_z : array
        Bending moments [N·mm].

    Returns
    -------
    ndarray
        Stress [MPa].
    """
    if section.round:
        return np.hypot(m_y, m_z) * section.half_y / section.i_z
    return np.abs(m_z) * section.half_y / section.i_z + np.abs(m_y) * section.half_z / section.i_y


def equivalent_stress(section: Section, forces: Floats, poisson: float = 0.3) -> Floats:
    """Return the largest von Mises stress over a section at n stations, the best of a grid refined by parabolas.

    Parameters
    ----------
    section : Section
        Of the beam.
    forces : ndarray, shape (n, 6)
        N, V_y, V_z [N], T, M_y, M_z [N·mm].
    poisson : float, optional
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (n,)
        Stress [MPa].
    """
    fields = _fields(section, poisson)
    _, rows, columns, _ = fields.shape
    squares = fields.reshape(-1, 6) @ forces.T
    squares *= squares  # in place: a new array of this size takes longer than its numbers
    normal, along_y, along_z = squares.reshape(3, rows * columns, -1)
    square = normal + 3.0 * (along_y + along_z)
    best, each = np.argmax(square, axis=0), np.arange(square.shape[1])
    i, j = np.unravel_index(best, (rows, columns))
    square = square.reshape(rows, columns, -1)
    peak = square[i, j, each]
    down, up = square[abs(i - 1), j, each], square[np.where(i + 1 < rows, i + 1, i - 1), j, each]
    if section.round:
        left, right = square[i, j - 1, each], square[i, (j + 1) % columns, each]
    else:
        left, right = square[i, abs(j - 1), each], square[i, np.where(j + 1 < columns, j + 1, j - 1), each]
    return np.sqrt(peak + _rise(down, peak, up) + _rise(left, peak, right))


def equivalent_bound(section: Section, sizes: Floats, poisson: float = 0.3) -> Floats:
    """Return what ``equivalent_stress`` does not exceed under internal forces that do not exceed some sizes.

    Normal stress and shear stress are each at their largest, wherever that is over the section, and so are the
    parabolas between points.

    Parameters
    ----------
    section : Section
        Of the beam.
    sizes : ndarray, shape (n, 6)
        Of N, V_y, V_z [N], T, M_y, M_z [N·mm]; not negative.
    poisson : float, optional
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (n,)
        Stress [MPa].
    """
    shear, rises = _largest_fields(section, poisson)
    normal = sizes[:, 0] / section.area + bending_stress(section, sizes[:, 4], sizes[:, 5])
    rise = np.einsum("ni,ij,nj->n", sizes, rises, sizes)
    return np.asarray(np.sqrt(normal**2 + 3.0 * (sizes @ shear) ** 2 + rise))


def rim_shear(section: Section, nu: float) -> tuple[float, float]:
    """Return the shear stress at the middle of a rectangle's rim.

    Parameters
    ----------
    section : Section
        A rectangle.
    nu : float
        Poisson's ratio.

    Returns
    -------
    tuple of 2 float
        Per unit V_y at (0, ±half_z) and per unit V_z at (±half_y, 0) [1/mm²].
    """
    fields, middle = _fields(section, nu), _ACROSS // 2
    return float(fields[1, middle, 0, 1]), float(fields[2, 0, middle, 2])


def _rise(before: Floats, peak: Floats, after: Floats) -> Floats:
    """Height of a parabola through three neighbours above the middle one, the largest."""
    curved = before - 2.0 * peak + after
    return np.where(curved < 0.0, (after - before) ** 2 / np.where(curved < 0.0, -8.0 * curved, 1.0), 0.0)


@lru_cache(maxsize=64)
def _fields(section: Section, nu: float) -> Floats:
    """σ, τ_y, τ_z (3, i, j, 6) at the points (i, j) of a section under unit forces, read-only.

    Along i and j a function that is smooth over the section is smooth and, at a rim, even: so its largest value
    between points is that of a parabola.
    """
    fields = _round(section, nu) if section.round else _rectangle(section, nu)
    fields.setflags(write=False)
    return fields


@lru_cache(maxsize=64)
def _largest_fields(section: Section, nu: float) -> tuple[Floats, Floats]:
    """Largest shear stress (6,) under each unit force, and the form (6, 6) of sizes that ``_rise`` adds at most.

    A parabola through three neighbours rises above the middle one, where that is the largest, by an eighth of their
    second difference at most: (a - b)²/(8 (a + b)) with a, b the steps down to either side.
    """
    fields = _fields(section, nu)
    weighted = fields * np.sqrt(np.array([1.0, 3.0, 3.0]))[:, None, None, None]
    square = np.einsum("cijk,cijl->ijkl", weighted, weighted)
    across = np.pad(square, ((1, 1), (0, 0), (0, 0), (0, 0)), mode="reflect")
    along = np.pad(square, ((0, 0), (1, 1), (0, 0), (0, 0)), mode="wrap" if section.round else "reflect")
    second = np.abs(np.diff(across, 2, axis=0)), np.abs(np.diff(along, 2, axis=1))
    return np.hypot(fields[1], fields[2]).max(axis=(0, 1)), sum(one.max(axis=(0, 1)) for one in second) / 8.0


def _normal(section: Section, y: Floats, z: Floats) -> Floats:
    """σ (i, j, 6) under unit forces."""
    one, nought = np.ones_like(y), np.zeros_like(y)
    return np.stack([one / section.area, nought, nought, nought, z / section.i_y, -y / section.i_z], axis=-1)


def _round(section: Section, nu: float) -> Floats:
    """Tube or rod, in polar coordinates r, φ from y: under V_y τ_r = R(r) cos φ, τ_φ = S(r) sin φ.

    R' + R/r + S/r = -V r/I and S' + S/r + R/r = -κ r with κ = ν/(1+ν) V/I, and R = 0 at both walls a < b, give
    R = A (a² + b² - r² - a²b²/r²), S = (V/I - 3κ) r²/8 - A (a² + b² + a²b²/r²), A = (3V/I - κ)/8.
    """
    outer = section.half_y
    inner = outer * section.radius_ratio
    r = (outer + inner) / 2.0 + (outer - inner) / 2.0 * np.cos(np.linspace(0.0, np.pi, _RADIAL))
    angle = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    bore = inner**2 * (outer / r) ** 2 if inner > 0.0 else np.zeros_like(r)
    unit, kappa = 1.0 / section.i_z, nu / (1.0 + nu) / section.i_z
    a = (3.0 * unit - kappa) / 8.0
    radial = (a * (inner**2 + outer**2 - r**2 - bore))[:, None]
    around = ((unit - 3.0 * kappa) / 8.0 * r**2 - a * (inner**2 + outer**2 + bore))[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    fields = np.zeros((3, _RADIAL, _AROUND, 6))
    fields[0] = _normal(section, r[:, None] * cos, r[:, None] * sin)
    fields[1, ..., 1], fields[2, ..., 1] = radial * cos**2 - around * sin**2, (radial + around) * sin * cos
    fields[1, ..., 2], fields[2, ..., 2] = (radial + around) * sin * cos, radial * sin**2 - around * cos**2
    fields[1, ..., 3], fields[2, ..., 3] = -r[:, None] * sin / section.torsion, r[:, None] * cos / section.torsion
    return fields


def _rectangle(section: Section, nu: float) -> Floats:
    """Flexure both ways and torsion of a rectangle."""
    points = np.cos(np.linspace(0.0, np.pi, _ACROSS))
    a, b = section.half_y, section.half_z
    y, z = a * points, b * points
    fields = np.zeros((3, _ACROSS, _ACROSS, 6))
    fields[0] = _normal(section, *np.meshgrid(y, z, indexing="ij"))
    kappa = nu / (1.0 + nu)
    along, across = _flexure(a, b, y, z, kappa)
    fields[1, ..., 1], fields[2, ..., 1] = along / section.i_z, across / section.i_z
    along, across = _flexure(b, a, z, y, kappa)
    fields[2, ..., 2], fields[1, ..., 2] = along.T / section.i_y, across.T / section.i_y
    if a <= b:
        along, across = _twist(a, b, y, z)
        fields[1, ..., 3], fields[2, ..., 3] = along / section.torsion, across / section.torsion
    else:
        along, across = _twist(b, a, z, y)
        fields[2, ..., 3], fields[1, ..., 3] = -along.T / section.torsion, -across.T / section.torsion
    return fields


def _flexure(a: float, b: float, s: Floats, r: Floats, kappa: float) -> tuple[Floats, Floats]:
    """Shear stresses times I (i, j) along s (half-side a) and r (half-side b) under a unit force along s.

    Timoshenko & Goodier, section 124: τ_s = (a² - s²)/2 + ∂φ/∂r, τ_r = -∂φ/∂s with ∇²φ = κ r and φ = 0 at the rim, here
    φ = -κ Σ 2(-1)^m/(a λ³) (r - b sinh λr/sinh λb) cos λs, λ = (2m + 1)π/2a.
    """
    rate, sign = _rates(a)
    decay = np.exp(-rate * b)
    up, down = np.exp(rate * (r[:, None] - b)), np.exp(-rate * (r[:, None] + b))
    weight = 2.0 * b * sign / (a * rate**2) / (1.0 - decay**2)
    bracket = (a**2 - s[:, None] ** 2) / 2.0
    along = (1.0 - kappa) * bracket + kappa * (np.cos(s[:, None] * rate) * weight) @ (up + down).T
    across = kappa * ((np.sin(s[:, None] * rate) * weight) @ (up - down).T - s[:, None] * r)
    return along, across


def _twist(a: float, b: float, s: Floats, r: Floats) -> tuple[Floats, Floats]:
    """Shear stresses times J (i, j) along s and r under a unit torque from s towards r; half-sides a and b.

    Timoshenko & Goodier, section 109: τ_s = ∂ψ/∂r, τ_r = -∂ψ/∂s with
    ψ = a² - s² - Σ 4(-1)^m/(a λ³) cosh λr/cosh λb cos λs.
    """
    rate, sign = _rates(a)
    decay = np.exp(-rate * b)
    up, down = np.exp(rate * (r[:, None] - b)), np.exp(-rate * (r[:, None] + b))
    weight = 4.0 * sign / (a * rate**2) / (1.0 + decay**2)
    along = -(np.cos(s[:, None] * rate) * weight) @ (up - down).T
    across = 2.0 * s[:, None] - (np.sin(s[:, None] * rate) * weight) @ (up + down).T
    return along, across


def _rates(a: float) -> tuple[Floats, Floats]:
    """λ and (-1)^m of a series in cos λs that vanishes at s = ±a."""
    number = np.arange(_TERMS, dtype=np.float64)
    return (2.0 * number + 1.0) * np.pi / (2.0 * a), 1.0 - 2.0 * (number % 2)
