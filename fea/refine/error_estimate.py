"""How far a solution's stress is from the true one: the recovery-based estimate, element by element.

O. C. Zienkiewicz and J. Z. Zhu, A simple error estimator and adaptive procedure for practical
engineering analysis, Int. J. Numer. Methods Eng. 24 (1987) 337-357: the recovered stress σ* is much
closer to the truth than the elements' own σ_h, so their difference stands for the error,

    ‖e‖² = ∫ (σ* − σ_h) : C⁻¹ : (σ* − σ_h) dV    (their eq. 15, for C the elasticity tensor)

σ* is the averaged nodal stress of ``alula.fea.solid.stress``, interpolated with the displacements' own functions.
Measured as the estimate over the true error in the energy norm: 0.76 to 0.82 for quadratic elements,
straight and curved, and 0.93 to 0.97 for linear ones, under a smooth field on distorted meshes; 0.85 in
thick-walled cylinders. A least-squares fit over the whole body in place of averages gave 0.68 to 0.77.
Next to singular edges σ* is too smooth, and 0.41 to 0.54 is left where such an edge holds most of the error;
averages at a curved boundary that bears a pressure gave 1.95. Several meshes tell that factor (``energy_factor``).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.elasticity import reference_basis
from alula.fea.solid.stress import StressField, carry_to_nodes, element_stress, von_mises

DEGREE = 5
"""Of the integration rule: its points are not those at which σ_h is best, where the estimate would be too small."""
APART = 1.15**2
"""Ratio of two estimates from which on their meshes tell the factor: quadratic elements of sizes 1.15 apart have it."""
_CHUNK = 8192


@dataclass(frozen=True, kw_only=True, eq=False)
class ErrorEstimate:
    """Estimated error of one solution.

    Attributes
    ----------
    energy : ndarray, shape (m,)
        Energy norm of the error in each element [√(N mm)].
    stress : ndarray, shape (m,)
        Root mean square of the error's von Mises stress in each element [MPa].
    energy_norm : float
        ‖u_h‖ of the solution, the root of twice its strain energy [√(N mm)].
    """

    energy: NDArray[np.float64]
    stress: NDArray[np.float64]
    energy_norm: float

    @property
    def total(self) -> float:
        """Energy norm of the error of the whole solution [√(N mm)]."""
        return float(np.sqrt((self.energy**2).sum()))

    @property
    def relative(self) -> float:
        """Relative error as estimated on this mesh alone."""
        return relative_error(self.total, self.energy_norm)


def estimate_error(field: StressField, displacement: NDArray[np.float64], *, E: float, nu: float) -> ErrorEstimate:
    """Estimate the error of nodal displacements.

    Parameters
    ----------
    field : StressField
        Stress recovered from the displacements.
    displacement : ndarray, shape (n, 3)
        At the nodes [mm].
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    ErrorEstimate
        The estimated error, element by element.
    """
    space = field.space
    X, *_ = reference_basis(space, space.order)
    _, W, phi, _ = reference_basis(space, DEGREE)
    energy, square = np.empty(len(space.cells)), np.empty(len(space.cells))
    # The stress of a straight-sided element is linear between its points, so the gap has values at its nodes; with
    # the root of the matrix of ∫ φa φb its integral is a sum of squares.
    root = np.linalg.cholesky((phi.T * W) @ phi / W.sum()).T
    carry = root @ carry_to_nodes(X, space.cells.shape[1])
    volume = field.weights.sum(axis=1)
    straight = np.flatnonzero(~space.curved)
    for part in (straight[first : first + _CHUNK] for first in range(0, len(straight), _CHUNK)):
        gap = root @ field.nodal[space.cells[part]] - carry @ field.at_points[part]
        energy[part] = volume[part] * energy_density(gap, E, nu).sum(axis=1)
        square[part] = (von_mises(gap) ** 2).sum(axis=1)
    for part, own, weights in element_stress(space, displacement, DEGREE, np.flatnonzero(space.curved), E=E, nu=nu):
        gap = phi @ field.nodal[space.cells[part]] - own
        energy[part] = (weights * energy_density(gap, E, nu)).sum(axis=1)
        square[part] = (weights * von_mises(gap) ** 2).sum(axis=1) / weights.sum(axis=1)
    total = (field.weights * energy_density(field.at_points, E, nu)).sum()
    return ErrorEstimate(energy=np.sqrt(energy), stress=np.sqrt(square), energy_norm=float(np.sqrt(total)))


def energy_factor(estimates: Sequence[float], energies: Sequence[float]) -> float | None:
    """Return true over estimated error in the energy norm, by the finest mesh and another; None where none tells.

    Under given loads the strain energy lacks half the square of the error, ‖e‖² = 2 (U − U_h) (Szabó & Babuška,
    Finite Element Analysis, 1991, section 4.1), whatever the meshes. So what one mesh gains on another is what the
    error has lost, 2 (U_2 − U_1) = ‖e_1‖² − ‖e_2‖², and if the estimate misses both by the same factor, ‖e‖ = c ‖η‖,
    then c² = 2 (U_2 − U_1)/(‖η_1‖² − ‖η_2‖²). The other mesh is the finest whose estimate is larger by ``APART``, since
    a difference of nearly equal estimates is scatter. Nothing follows where there is none, or where energy falls.

    Parameters
    ----------
    estimates : sequence of float
        ‖η‖ of each mesh, coarse to fine [√(N mm)].
    energies : sequence of float
        Strain energies U_h of their solutions [N mm].

    Returns
    -------
    float or None
        True over estimated error.
    """
    apart = [number for number, estimate in enumerate(estimates) if estimate > APART * estimates[-1]]
    if not apart:
        return None
    gained = 2.0 * (energies[-1] - energies[apart[-1]])
    lost = estimates[apart[-1]] ** 2 - estimates[-1] ** 2
    return float(np.sqrt(gained / lost)) if gained > 0.0 else None


def relative_error(error: float, energy_norm: float) -> float:
    """Return the relative error η = ‖e‖/√(‖u_h‖² + ‖e‖²) in the energy norm (Zienkiewicz and Zhu 1987, eq. 24).

    Parameters
    ----------
    error : float
        ‖e‖ [√(N mm)].
    energy_norm : float
        ‖u_h‖ [√(N mm)].

    Returns
    -------
    float
        Η.
    """
    whole = float(np.hypot(energy_norm, error))
    return error / whole if whole > 0.0 else 0.0


def energy_density(sigma: NDArray[np.float64], E: float, nu: float) -> NDArray[np.float64]:
    """Return twice the energy density of a stress, σ : C⁻¹ : σ = ((1+ν) σ:σ − ν (tr σ)²)/E.

    Parameters
    ----------
    sigma : ndarray, shape (..., 6)
        Stress components [MPa].
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (...)
        Twice the strain energy per volume [MPa].
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(sigma, -1, 0)
    trace = xx + yy + zz
    square = xx**2 + yy**2 + zz**2 + 2.0 * (xy**2 + yz**2 + xz**2)
    return np.asarray(((1.0 + nu) * square - nu * trace**2) / E)
