"""How soft a linkage is under its loads once solids of its links are known, in place of the doubt about their eyes.

A link's solid has the work of its loads as twice its strain energy. Over that of its plain beam under the same loads it
says how much softer the link is than the frame has it. The limit load goes with one over this, summed over the links by
what each takes up of the work of all loads (``alula.fea.nonlinear.large_displacement``). A solid knows its stiffness
under these loads alone, which in a strut is not the bending in which it buckles: so the stiffer end, from which follows
what a linkage holds at the most, stays where it was if that is farther. The other end has faults of shape besides.
Links that are no beams buckle otherwise than the frame's strips do: the factor of their solids bounds the limit load.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.source import PIN_PRESSURE, distinct
from alula.fea.frame.displacement_band import softness, works_of_links
from alula.fea.nonlinear.large_displacement import LargeDisplacement, blind_link
from alula.fea.outcomes.point_shares import MESHES, beam_work
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.standing.joint_forces import JointForces
from alula.geometry.bodies.body import no_beam
from alula.loads.case.case import Case
from alula.loads.records.bearing import WIDE


def with_known_stiffness(
    case: Case,
    moved: LargeDisplacement,
    forces: JointForces,
    links: Mapping[str, LinkResult],
    cut: Mapping[str, LinkLoads],
) -> LargeDisplacement:
    """Return what became of a load case, with the stiffness of the links whose solids are known.

    Parameters
    ----------
    case : Case
    moved : LargeDisplacement
        By the frame's beams.
    forces : JointForces
        In the undeformed pose.
    links : mapping of str to LinkResult
        Under the load case.
    cut : mapping of str to LinkLoads
        What acts on every link, or on its worse plate.

    Returns
    -------
    LargeDisplacement
        The same where no solid is known, or none tells.
    """
    if moved.frame is None or moved.solution is None:
        return moved
    plain = {link: band.value for link, band in works_of_links(case, moved.frame, moved.solution)}
    known, alone = {}, math.inf
    for link, result in links.items():
        if link in plain and isinstance(result, SolidResult) and _tells(case, link, result):
            if result.buckling is not None:
                alone = min(alone, result.buckling.least * (1.0 - result.buckling.error))
            beam = _beams(case, moved, forces, plain[link], cut[link])
            if beam > 0.0:
                known[link] = _solids(result, cut[link].name).times(1.0 / beam)
    blind = blind_link(case, [link for link in case.bending_links if link in plain and link not in known])
    if blind or not known:
        return moved
    soft = softness(case, moved.frame, moved.solution, known)
    soft = replace(soft, low=min(soft.low, moved.eyes.low), sources=distinct((MESHES, PIN_PRESSURE), soft.sources))

    def known_of(one: LargeDisplacement) -> LargeDisplacement:
        return replace(one, softness=soft, alone=alone, blind="")

    return _everywhere(moved, known_of)


def as_stiff_as_may_be(moved: LargeDisplacement) -> LargeDisplacement:
    """Return what becomes of a load case if the solids of its links are as stiff as the frame's beams may be.

    No solid moves the stiffer end of what its links' stiffness is (``with_known_stiffness``). So this tells whether
    solids of links could decide what the linkage holds.

    Parameters
    ----------
    moved : LargeDisplacement
        By the frame's beams.

    Returns
    -------
    LargeDisplacement
    """

    def stiff(one: LargeDisplacement) -> LargeDisplacement:
        return replace(one, softness=Band.exact(one.eyes.low))

    return _everywhere(moved, stiff)


def _everywhere(
    moved: LargeDisplacement, changed: Callable[[LargeDisplacement], LargeDisplacement]
) -> LargeDisplacement:
    """Return a load case changed as stated, and under all conditions that may be."""
    return replace(changed(moved), causes=tuple(cause.told_by(changed) for cause in moved.causes))


def _tells(case: Case, link: str, result: SolidResult) -> bool:
    """Whether a solid has a number for its stiffness, and one for its buckling where no beam has."""
    buckles = case.part_of(link).is_beam or (result.buckling is not None and not result.buckling.without)
    return buckles and not result.displacement_max.unknowable


def _beams(case: Case, moved: LargeDisplacement, forces: JointForces, plain: float, loads: LinkLoads) -> float:
    """Work of a link's loads, or of those on one of its plates, on its plain beam; NaN where no beam tells [N mm]."""
    link, body, count = loads.link, case.body(loads.link), case.links[loads.link].count
    if count > 1 and case.layered:
        return math.nan  # the plates of a pair bear differently
    if moved.state == "small" and forces.by_equilibrium:
        return plain / count
    straight = all(pin.foot is None and pin.slot == 0.0 for pin in body.pins) and not body.cuts
    return beam_work(case, link, loads, loads) if straight and not no_beam(body) else math.nan


def _solids(result: SolidResult, load_case: str) -> Band:
    """Work of the loads on a link's solid: under the pressure over 180°, and the ends under all variants [N mm]."""
    found = [one for one in result.solution.cases if one.load == load_case]
    every = [2.0 * one.strain_energy for one in found]
    value = max(work for work, one in zip(every, found, strict=True) if one.span == WIDE.span)
    error = result.discretisation.displacement.index
    return Band(value=value, low=min(every) * max(1.0 - error, 0.0), high=max(every) * (1.0 + error))
