"""Beam theory on the sections of a solid: forces about their centroids, Mohr's bending stress, where beam theory holds.

A part from a file is a beam of as many prismatic stretches as it has stations (``alula.geometry.bodies.cut_section``).
Forces are those on its link's x axis; about the centroid of a section beside that axis the moments are others. The
normal stress σ = N/A + a y + b z, with y and z from the centroid, has the moments

    M_z = -(a I_z + b I_yz),   M_y = a I_yz + b I_y

(Timoshenko, Strength of Materials I, 3rd ed., section 49, in the axes of the link), and is largest at a corner of the
hull of its outline. Rectangles, rods and tubes have Saint-Venant's exact stress (``alula.fea.beam.section_stress``).
Of another section the shear stresses are means, V/A and T/√(A I_p), below the largest: T <= ∫τ r dA <= τ_max √(A I_p),
I_p = ∫r² dA. That its shear centre is not its centroid is left out.
Lengths in mm, forces in N, moments in N·mm, stresses in MPa.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.piecewise import Piecewise, divided
from alula.fea.beam.section_stress import SectionStress, section_stress
from alula.fea.common.reason import Reason, reason
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.cut_section import CutSection

Floats = NDArray[np.float64]

STEEPEST = 0.25
"""Slope of a section's rims or centroid against the axis up to which beam theory holds: with it on both sides, the
exact stress of a wedge in tension is 4 % above N/A (Timoshenko & Goodier, Theory of Elasticity, 3rd ed., sec. 38)."""
SOLID_SHEAR = 5.0 / 6.0
"""Shear coefficient of a section of any shape."""


def nearest(cuts: Sequence[CutSection], x: float) -> CutSection:
    """Return the section that stands for a place.

    Parameters
    ----------
    cuts : sequence of CutSection
        Of the part.
    x : float
        The place [mm].

    Returns
    -------
    CutSection
        The one whose station is nearest.
    """
    return min(cuts, key=lambda cut: abs(cut.x - x))


def cells(cuts: Sequence[CutSection]) -> list[tuple[float, float, CutSection]]:
    """Return the stretches for which the sections stand.

    Parameters
    ----------
    cuts : sequence of CutSection
        By rising x.

    Returns
    -------
    list of (float, float, CutSection)
        Start and end [mm], halfway to the neighbours; none of a single station.
    """
    if not cuts or cuts[0].x == cuts[-1].x:
        return []
    borders = [(a.x + b.x) / 2.0 for a, b in itertools.pairwise(cuts)]
    ends = [2.0 * cuts[0].x - borders[0], *borders, 2.0 * cuts[-1].x - borders[-1]]
    return list(zip(ends[:-1], ends[1:], cuts, strict=True))


def changes(body: Body) -> list[float]:
    """Return where the section of a beam's part changes.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    list of float
        Borders of the stretches for which its sections stand [mm]; none of a part of one section, or that is no beam.
    """
    found = cells(body.cuts) if body.part.is_beam else []
    return [b for (_, b, one), (_, _, other) in itertools.pairwise(found) if one.hull != other.hull]


def about_centre(cut: CutSection) -> Floats:
    """Return the matrix that takes forces on the link's axis to those about a section's centroid.

    Parameters
    ----------
    cut : CutSection
        The section.

    Returns
    -------
    ndarray, shape (6, 6)
        Of N, V_y, V_z, T, M_y, M_z.
    """
    y, z = cut.centre
    found = np.eye(6)
    found[3, 1:3] = z, -y
    found[4, 0], found[5, 0] = -z, y
    return found


def normal_stress(cut: CutSection, forces: Floats) -> Floats:
    """Return the normal stress at the corners of a section's hull.

    Parameters
    ----------
    cut : CutSection
        The section.
    forces : ndarray, shape (6,)
        N, V_y, V_z, T, M_y, M_z about its centroid.

    Returns
    -------
    ndarray, shape (k,)
        Stress, tension positive [MPa].
    """
    slopes = np.linalg.solve([[-cut.i_z, -cut.i_yz], [cut.i_yz, cut.i_y]], [forces[5], forces[4]])
    return np.asarray(forces[0] / cut.area + (np.array(cut.hull) - cut.centre) @ slopes)


def cut_stress(cut: CutSection, forces: Floats, poisson: float) -> SectionStress:
    """Return the stresses of a section.

    Parameters
    ----------
    cut : CutSection
        The section.
    forces : ndarray, shape (6,)
        N, V_y, V_z, T, M_y, M_z about its centroid.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    SectionStress
        Of a section that is no rectangle, rod or tube with mean shear stresses, which count as if they met the largest
        normal stress.
    """
    plain = cut.plain
    if plain is not None:
        return section_stress(plain, forces, poisson)
    axial = float(forces[0] / cut.area)
    normal = normal_stress(cut, forces)
    shear = math.hypot(forces[1], forces[2]) / cut.area
    torsion = abs(float(forces[3])) / math.sqrt(cut.area * (cut.i_y + cut.i_z))
    return SectionStress(
        axial=axial,
        bending=float(np.abs(normal - axial).max()),
        torsion=torsion,
        shear=shear,
        equivalent=math.hypot(float(np.abs(normal).max()), math.sqrt(3.0) * (shear + torsion)),
    )


def cut_flexibility(cut: CutSection, young: float, poisson: float) -> Floats:
    """Return the strains of the link's axis per unit of the forces on it.

    Parameters
    ----------
    cut : CutSection
        The section.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (6, 6)
        Of the axis as if it were fixed to the section, by the section's energy: symmetric.
    """
    shear, plain = young / (2.0 * (1.0 + poisson)), cut.plain
    across = (SOLID_SHEAR if plain is None else plain.shear_coefficient(poisson)) * shear * cut.area
    own = np.diag([1.0 / (young * cut.area), 1.0 / across, 1.0 / across, 1.0 / (shear * cut.torsion), 0.0, 0.0])
    own[4:, 4:] = np.linalg.inv([[cut.i_y, -cut.i_yz], [-cut.i_yz, cut.i_z]]) / young
    turn = about_centre(cut)
    return np.asarray(turn.T @ own @ turn)


def curving_forces(forces: Piecewise, cuts: Sequence[CutSection]) -> Piecewise:
    """Return forces whose moments over E and ``CutSection.free`` are the curvatures of a part.

    Parameters
    ----------
    forces : Piecewise
        N, V_y, V_z, T, M_y, M_z on the link's axis.
    cuts : sequence of CutSection
        Sections of the part; none where the section is symmetric about the axis.

    Returns
    -------
    Piecewise
        With M_y + M_z I_yz/I_z and M_z + M_y I_yz/I_y about each section's centroid.
    """
    if not cuts:
        return forces
    found = divided(forces, [x for start, end, _ in cells(cuts) for x in (start, end)])
    own = [nearest(cuts, x) for x in (found.breaks[:-1] + found.breaks[1:]) / 2.0]
    turns = []
    for cut in own:
        both = np.eye(6)
        both[4, 5], both[5, 4] = cut.i_yz / cut.i_z, cut.i_yz / cut.i_y
        turns.append(both @ about_centre(cut))
    return Piecewise(breaks=found.breaks, coefficients=np.array(turns) @ found.coefficients)


def beam_sections(body: Body) -> tuple[CutSection, ...]:
    """Return the sections of a part from a file at which beam theory holds.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    tuple of CutSection
        Those in one piece, farther from all pins and loaded places than the section is large, and beside which rims and
        centroid are no steeper than ``STEEPEST``.
    """
    return tuple(cut for cut in body.cuts if not _against(body, cut))


def _against(body: Body, cut: CutSection) -> Reason | None:
    """Return what speaks against beam theory at a section; None where nothing does."""
    size = max(cut.width, cut.height)
    reaches = [(pin.x, body.across(pin) / 2.0) for pin in body.pins] + [(end.x, end.patch) for end in body.ends]
    if cut.pieces > 1:
        return reason("sections_in_pieces")
    for other in body.cuts:
        step = abs(other.x - cut.x)
        if 0.0 < step < 1.5 * _pitch(body) and _steep(cut, other, step):
            return reason("sections_change_fast")
    if any(abs(cut.x - x) < reach + size for x, reach in reaches):
        return reason("pins_too_near_for_depth")
    return None


def _pitch(body: Body) -> float:
    cuts = body.cuts
    return (cuts[-1].x - cuts[0].x) / max(len(cuts) - 1, 1)


def _steep(one: CutSection, other: CutSection, step: float) -> bool:
    """Whether outline, centroid or area of neighbouring sections change faster than along rims of that slope."""
    places = np.abs(np.array([one.low, one.high, one.centre]) - [other.low, other.high, other.centre])
    area = 2.0 * (max(one.width, other.width) + max(one.height, other.height)) * step
    return bool(places.max() > STEEPEST * step or abs(one.area - other.area) > STEEPEST * area)


def cut_remark(body: Body) -> Reason | None:
    """Return where the hand calculation of a part from a file holds.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    Reason or None
        None of a part that alula draws.
    """
    cuts = body.cuts
    if not cuts:
        return None
    reasons = [_against(body, cut) for cut in cuts]
    held = [cut.x for cut, why in zip(cuts, reasons, strict=True) if not why]
    if not held:
        return reason("cut_part_is_no_beam", why=max(reasons, key=reasons.count), stations=len(cuts))
    odd = any(cut.plain is None for cut in cuts)
    return reason("cut_part", stations=len(cuts), held=len(held), ends=(held[0], held[-1]), odd_sections=odd)
