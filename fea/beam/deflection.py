"""Deflection of a beam's axis by Timoshenko's theory, flanks of slots included."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_beam import cells, cut_flexibility, nearest
from alula.fea.beam.flanks import Flanks
from alula.fea.beam.piecewise import Piecewise, divided, integral, values
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.parts.part import Section

Floats = NDArray[np.float64]
_GAUSS = 6
_DIRECT = [0, 3, 4, 5]
"""Displacements that are integrals of their own strain alone: u, φ, θ_y, θ_z."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Deflection:
    """Displacement of a beam's axis relative to the line through two of its stations, in one state or in n.

    Attributes
    ----------
    functions : Piecewise
        u, v, w [mm] and the rotations φ, θ_y, θ_z [rad] about x, y, z; u and φ are relative to the first of the two
        stations.
    """

    functions: Piecewise

    @property
    def each(self) -> Floats:
        """The largest √(v² + w²) in every state (n,) [mm]."""
        return self.functions.peaks(lambda f: np.hypot(f[:, 1], f[:, 2])).value

    @property
    def largest(self) -> float:
        """The largest √(v² + w²) of all [mm]."""
        return float(self.each.max())


def deflection(
    forces: Piecewise,
    section: Section,
    *,
    young: float,
    poisson: float,
    line: tuple[float, float],
    flanks: Sequence[Flanks] = (),
    cuts: Sequence[CutSection] = (),
) -> Deflection:
    """Integrate the internal forces to the deflection relative to the line through two stations.

    Timoshenko's beam with Cowper's shear coefficient κ: θ_z' = M_z/(E I_z), v' = θ_z + V_y/(κ G A), θ_y' = M_y/(E I_y),
    w' = -θ_y + V_z/(κ G A), u' = N/(E A), φ' = T/(G J).

    Along a slot both flanks bend alike. Their moment is M_z less that of their pair of forces, (∫M_z dx/L) S/(S + I),
    with S the pair's second moment and I the flanks' own. The additional bending of the flank that the pin pushes is
    left out.

    Parameters
    ----------
    forces : Piecewise
        N, V_y, V_z, T, M_y, M_z along the beam, of one state or of n.
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.
    line : tuple of 2 float
        x of the two stations; one station twice is a line through it that turns with the section there, as where a
        single joint holds the link [mm].
    flanks : sequence of Flanks, optional
        That take the section's place along slots.
    cuts : sequence of CutSection, optional
        Sections of a part from a file, which take the section's place all along.

    Returns
    -------
    Deflection
        Exact for the polynomial loads of ``BeamLoads``.

    References
    ----------
    Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 5.6.
    """
    x_a, x_b = line
    stretches = [*((slot.first, slot.last) for slot in flanks), *((start, end) for start, end, _ in cells(cuts))]
    forces = divided(forces, [x for stretch in stretches for x in stretch])
    middles = (forces.breaks[:-1] + forces.breaks[1:]) / 2.0
    each = np.moveaxis(forces.coefficients, -3, 0)
    out = np.zeros((*each.shape[:-2], 6, 6))
    state = np.zeros(each.shape[1:-1])
    for i, (c, x, h) in enumerate(zip(each, middles, np.diff(forces.breaks), strict=True)):
        slot = next((slot for slot in flanks if slot.first < x < slot.last), None)
        if cuts:
            strain = cut_flexibility(nearest(cuts, x), young, poisson) @ c
        else:
            strain = c * flexibility(section if slot is None else slot.together, young, poisson)[:, None]
        if slot is not None:
            own = slot.together.i_z
            mean = _moment_between(forces, slot.first, slot.last) / slot.length
            strain[..., 5, 0] -= mean * slot.pair / (slot.pair + own) / (young * own)
        out[i][..., _DIRECT, :5] = integral(strain[..., _DIRECT, :], state[..., _DIRECT])
        slope = out[i][..., [5, 4], :5] * np.array([[1.0], [-1.0]])
        slope[..., :4] += strain[..., [1, 2], :]
        out[i][..., [1, 2], :] = integral(slope, state[..., [1, 2]])
        state = values(out[i], h)
    free = Piecewise(breaks=forces.breaks, coefficients=np.moveaxis(out, 0, -3))
    at_a, at_b = free.at(x_a), free.at(x_b)
    tilts = (at_a[..., 5], -at_a[..., 4]) if x_a == x_b else np.moveaxis(at_b - at_a, -1, 0)[1:3] / (x_b - x_a)
    relative, starts = free.coefficients.copy(), forces.breaks[:-1]
    relative[..., [0, 3], 0] -= at_a[..., None, [0, 3]]
    for row, angle in zip((1, 2), tilts, strict=True):
        relative[..., row, 0] -= at_a[..., row, None] + angle[..., None] * (starts - x_a)
        relative[..., row, 1] -= angle[..., None]
    relative[..., 5, 0] -= tilts[0][..., None]
    relative[..., 4, 0] += tilts[1][..., None]
    return Deflection(functions=Piecewise(breaks=forces.breaks, coefficients=relative))


def virtual_work(real: Piecewise, virtual: Piecewise, section: Section, *, young: float, poisson: float) -> float:
    """Return the work of virtual internal forces on the strains of a beam under real ones.

    Parameters
    ----------
    real, virtual : Piecewise
        N, V_y, V_z [N], T, M_y, M_z [N·mm] along one and the same beam; beyond the ends of either there are none.
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.

    Returns
    -------
    float
        Work [N·mm]; per unit of the virtual load, how far its point moves [mm].
    """
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    work = np.zeros(6)
    first, last = (end(real.breaks[k], virtual.breaks[k]) for end, k in ((max, 0), (min, -1)))
    for start, end in itertools.pairwise(np.unique(np.clip([*real.breaks, *virtual.breaks], first, last))):
        for x, w in zip((start + end) / 2.0 + (end - start) / 2.0 * nodes, (end - start) / 2.0 * weights, strict=True):
            work += w * real.at(float(x)) * virtual.at(float(x))
    return float(work @ flexibility(section, young, poisson))


def flexibility(section: Section, young: float, poisson: float) -> Floats:
    """Return the strains of a section per unit of N, V_y, V_z, T, M_y, M_z.

    Parameters
    ----------
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (6,)
        Strains per unit force [1/N, 1/(N·mm²)].
    """
    shear_modulus = young / (2.0 * (1.0 + poisson))
    shear = 1.0 / (section.shear_coefficient(poisson) * shear_modulus * section.area)
    return np.array(
        [
            1.0 / (young * section.area),
            shear,
            shear,
            1.0 / (shear_modulus * section.torsion),
            1.0 / (young * section.i_y),
            1.0 / (young * section.i_z),
        ]
    )


def _moment_between(forces: Piecewise, first: float, last: float) -> Floats:
    """∫M_z dx (...) between two stations that are breaks or lie beyond the beam, where there is none [N·mm²]."""
    total = np.zeros(forces.coefficients.shape[:-3])
    each = np.moveaxis(forces.coefficients[..., 5, :], -2, 0)
    for c, x, h in zip(each, forces.breaks[:-1], np.diff(forces.breaks), strict=True):
        if first <= x < last:
            total = total + values(integral(c, np.zeros(total.shape)), float(h))
    return total
