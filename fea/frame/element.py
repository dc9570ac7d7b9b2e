"""The Timoshenko beam element in its natural mode: what it resists once rigid motion is taken out.

Local axes: x from the first end to the second, z as the model says, y = z × x. Each end has three displacements
and three rotations about the local axes (right-hand rule), in this order, and so have the forces at it.

The six natural forces and the deformations that they work on (Przemieniecki, Theory of Matrix Structural Analysis,
1968, chapters 5 and 6; the simply supported beam as the basic system):

    N           normal force, tension positive             lengthening
    M_z1, M_z2  end moments about z, right-hand rule       rotations of the end sections relative to the chord
    M_y1, M_y2  end moments about y                        the same about y
    T           torque, that on the second end             twist
"""

import numpy as np
from numpy.typing import NDArray

from geometry.parts.part import Section

Floats = NDArray[np.float64]


def natural_deformations(length: float) -> Floats:
    """(6, 12) matrix G from the displacements of both ends to the natural deformations; Gᵀ gives end forces."""
    G = np.zeros((6, 12))
    G[0, [0, 6]] = -1.0, 1.0
    for row, rotation in ((1, 5), (2, 11)):
        G[row, rotation] = 1.0
        G[row, [1, 7]] = 1.0 / length, -1.0 / length
    for row, rotation in ((3, 4), (4, 10)):
        G[row, rotation] = 1.0
        G[row, [2, 8]] = -1.0 / length, 1.0 / length
    G[5, [3, 9]] = -1.0, 1.0
    return G


def natural_flexibility(section: Section, young: float, poisson: float, length: float) -> Floats:
    """(6, 6) natural flexibility of a Timoshenko beam, exact for any slenderness [mm/N, 1/(N·mm)].

    End rotations under end moments: L/(3EI) M1 - L/(6EI) M2 + (M1 + M2)/(κ G A L), by virtual work (inverse of
    Przemieniecki, 1968, eq. 5.116, with Cowper's κ in the shear parameter).
    """
    shear_modulus = young / (2.0 * (1.0 + poisson))
    shear = 1.0 / (section.shear_coefficient(poisson) * shear_modulus * section.area * length)
    F = np.zeros((6, 6))
    F[0, 0] = length / (young * section.area)
    for first, inertia in ((1, section.i_z), (3, section.i_y)):
        bending = length / (6.0 * young * inertia)
        F[first : first + 2, first : first + 2] = np.array([[2.0, -1.0], [-1.0, 2.0]]) * bending + shear
    F[5, 5] = length / (shear_modulus * section.torsion)
    return F


def line_load_effect(
    section: Section, young: float, length: float, first: Floats, last: Floats
) -> tuple[Floats, Floats]:
    """Natural deformations (6,) and end forces (12,) of the basic system under a linearly varying line load.

    first, last  (3,) force per length at both ends, in local axes [N/mm]. The basic system is simply supported and
    held along x at its first end. End rotations 8, 7 (360ths of q L³/(E I)) after Gere & Goodno, Mechanics of
    Materials, 8th ed., appendix G, table G-2, cases 1 and 11; shear does not turn the end sections.
    """
    v0, p0 = np.zeros(6), np.zeros(12)
    v0[0] = length**2 * (first[0] + 2.0 * last[0]) / (6.0 * young * section.area)
    p0[0] = -(first[0] + last[0]) * length / 2.0
    for axis, row, sign, inertia in ((1, 1, 1.0, section.i_z), (2, 3, -1.0, section.i_y)):
        q1, q2 = first[axis], last[axis]
        slope = sign * length**3 / (360.0 * young * inertia)
        v0[row] = slope * (8.0 * q1 + 7.0 * q2)
        v0[row + 1] = -slope * (7.0 * q1 + 8.0 * q2)
        p0[axis] = -(2.0 * q1 + q2) * length / 6.0
        p0[6 + axis] = -(q1 + 2.0 * q2) * length / 6.0
    return v0, p0
