"""Hand calculation against solid model, section by section, clear of holes and eyes."""

import math

import numpy as np

from alula.fea.beam.cut_beam import beam_sections
from alula.fea.beam.section_stress import SectionStress
from alula.fea.beam.theory import BeamCheck
from alula.fea.outcomes.result import SectionComparison
from alula.fea.solid.stress import StressField
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Body

BENDS = 0.1
"""A link counts as bending where its largest bending stress is above this share of its axial stress."""
LARGEST_COUNT = 6


def clear_sections(body: Body) -> tuple[float, ...]:
    """Return the stations at least one diameter (or width) away from every eye, hole and loaded end.

    Parameters
    ----------
    body : Body

    Returns
    -------
    tuple of float
        One in the middle of every stretch that is left [mm], of the longest stretches; none on a disc.
    """
    part, size = body.part, max(body.part.section.width, body.part.section.height)
    if not part.is_beam:
        return ()
    eyes = [pin for pin in body.pins if pin.foot is None]
    blocked = [(pin.span[0] - body.across(pin) / 2, pin.span[1] + body.across(pin) / 2) for pin in eyes]
    # An arm disturbs the section as far as its own width reaches along the axis.
    feet = [(pin.foot[0], body.across(body.foot(pin) or pin)) for pin in body.pins if pin.foot]
    blocked += [(x - across, x + across) for x, across in feet]
    blocked += [(x - row.diameter / 2, x + row.diameter / 2) for row in body.holes for x in row.positions]
    blocked += [(end.x - end.patch, end.x + end.patch) for end in body.ends]
    margins = sorted((low - size, high + size) for low, high in blocked)
    gaps = []
    reach = margins[0][1]
    for low, high in margins[1:]:
        if low > reach:
            gaps.append((low - reach, (low + reach) / 2))
        reach = max(reach, high)
    gaps.sort(reverse=True)
    return tuple(sorted(x for _, x in gaps[:LARGEST_COUNT]))


def compare_sections(body: Body, beam: BeamCheck, stress: StressField) -> tuple[SectionComparison, ...]:
    """Set beam theory's section stress against the solid model's.

    Bending stress on a link that bends, N/A on one that does not, each difference relative to the
    largest section stress of that kind by hand on the link.

    Parameters
    ----------
    body : Body
    beam : BeamCheck
    stress : StressField

    Returns
    -------
    tuple of SectionComparison
    """
    found = _at_cuts(body, beam, stress) if beam.cuts else _at_stations(body, beam, stress)
    if beam.cuts:
        bending, axial = (
            max((abs(getattr(hand, kind)) for _, hand, _, _ in found), default=0.0) for kind in ("bending", "axial")
        )
    else:
        bending, axial = float(beam.bending.max()), float(abs(beam.axial).max())
    bends = bending > BENDS * axial
    kind, scale = ("bending", bending) if bends else ("axial", axial)
    if scale == 0.0:
        return ()
    rows = ((x, getattr(hand, kind), bent if bends else pulled) for x, hand, pulled, bent in found)
    return tuple(
        SectionComparison(x=x, kind=kind, hand=ours, solid=theirs, difference=(theirs - ours) / scale)
        for x, ours, theirs in rows
    )


Found = list[tuple[float, SectionStress, float, float]]
"""Station, stresses by hand, and axial and bending stress of the solid."""


def _at_stations(body: Body, beam: BeamCheck, stress: StressField) -> Found:
    section, found = body.part.section, []
    size = max(section.width, section.height)
    for x in clear_sections(body):
        solid = stress.section(x=x, half_length=size / 4, half_y=section.half_y, half_z=section.half_z)
        bent = abs(solid.bending_y) + abs(solid.bending_z)
        if section.round:
            bent = math.hypot(solid.bending_y, solid.bending_z)
        found.append((x, beam.stress_at(x), solid.axial, bent))
    return found


def _at_cuts(body: Body, beam: BeamCheck, stress: StressField) -> Found:
    """The same at the sections of a part from a file where beam theory holds.

    The solid's stress is linear in y and z as fitted: at the centroid, and at the hull's corner that differs most.
    """
    found = []
    for cut in beam_sections(body):
        try:
            solid = stress.section(
                x=cut.x,
                half_length=max(cut.width, cut.height) / 4,
                half_y=cut.width / 2,
                half_z=cut.height / 2,
            )
        except CannotRunError:  # a mesh from a file is as coarse as it is
            continue
        slopes = np.array([solid.bending_z, solid.bending_y]) / [cut.width / 2, cut.height / 2]
        bending = float(np.abs((np.array(cut.hull) - cut.centre) @ slopes).max())
        found.append((cut.x, beam.stress_at(cut.x), solid.axial + float(slopes @ cut.centre), bending))
    return found
