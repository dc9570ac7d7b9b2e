"""Stress by hand where a pin goes through both walls of a tube or rod: that of the net section.

Lengths in mm, forces in N, moments in N·mm, stresses in MPa.
"""

import itertools
import math

import numpy as np

from alula.fea.beam.section_stress import SectionStress, section_stress
from alula.fea.beam.theory import Floats
from alula.geometry.bodies.section import Section

_SLICES = 33


def holed_tube_stress(
    section: Section, diameter: float, offset: float, forces: Floats, poisson: float = 0.3
) -> SectionStress:
    """Return the stress of what a hole along z leaves of a tube's section, without the concentration at the hole.

    Area and second moments about the net section's own centroid are sums over slices along y (Gauss points). N acts
    on the tube's axis, so that it bends a section with a hole beside it. Shear stresses are those of the whole
    section over the share of the area that is left; they count as if they met the largest direct stress.

    Parameters
    ----------
    section : Section
        Of the tube or rod.
    diameter : float
        Of the hole [mm].
    offset : float
        y of the hole's axis [mm].
    forces : ndarray, shape (6,)
        N, V_y, V_z [N], T, M_y, M_z [N·mm].
    poisson : float, optional
        Poisson's ratio, which tells how the shear stress of V is spread.

    Returns
    -------
    SectionStress
        Of the net section.
    """
    outer, inner = section.half_y, section.radius_ratio * section.half_y
    hole = offset - diameter / 2.0, offset + diameter / 2.0
    edges = sorted({-outer, -inner, inner, outer, *(y for y in hole if abs(y) < outer)})
    nodes, weights = np.polynomial.legendre.leggauss(_SLICES)
    stretches = [(a, b) for a, b in itertools.pairwise(edges) if not hole[0] < (a + b) / 2.0 < hole[1]]
    y = np.concatenate([(a + b) / 2.0 + (b - a) / 2.0 * nodes for a, b in stretches])
    w = np.concatenate([(b - a) / 2.0 * weights for a, b in stretches])
    top, bore = (np.sqrt(np.maximum(radius**2 - y**2, 0.0)) for radius in (outer, inner))
    strips = 2.0 * w * (top - bore)
    area = float(strips.sum())
    centre = float(strips @ y) / area
    i_y, i_z = float(w @ (top**3 - bore**3)) * 2.0 / 3.0, float(strips @ (y - centre) ** 2)
    n, m_y, m_z = float(forces[0]), float(forces[4]), float(forces[5] + forces[0] * centre)
    rim = np.array([edge for stretch in stretches for edge in stretch])
    bending = abs(m_z * (rim - centre)) / i_z + abs(m_y) * np.sqrt(np.maximum(outer**2 - rim**2, 0.0)) / i_y
    inside = abs(m_z * (y - centre)) / i_z + abs(m_y) * top / i_y
    gross, share = section_stress(section, forces, poisson), area / section.area
    most = max(float(bending.max()), float(inside.max()))
    torsion, shear = gross.torsion / share, gross.shear / share
    return SectionStress(
        axial=n / area,
        bending=most,
        torsion=torsion,
        shear=shear,
        equivalent=math.hypot(abs(n) / area + most, math.sqrt(3.0) * (torsion + shear)),
    )
