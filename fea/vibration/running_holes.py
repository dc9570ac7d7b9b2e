"""Hinges at the holes in which pins between layers may run: the low end of natural frequencies.

Nobody knows how a pin stands that is not stated to be tight: seated it holds its link as a tight one does, between its
rims it does not hold it at all. Every frequency lies between those of both (Rayleigh: what gives a frame freedom raises
none of its frequencies). So the value is that of tight pins, and the low end that with a hinge about both axes across
the pin in every hole that may run. Between the layers such a linkage often is a mechanism, at 0 Hz.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import reason
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import ALL_DOFS, Dof, FrameModel, Tie
from alula.fea.pins.clearances import gap_over_diameter
from alula.fea.vibration.modes import Mode
from alula.loads.case.case import Case
from alula.loads.case.forks import in_holes

ACROSS: tuple[Dof, Dof] = ("rx", "ry")
_NOTHING = 1e-4
"""Share of the frequency with tight pins below which that with hinges is rounding."""
RUNNING = Source(kind=SourceKind.COUPLES, detail=reason("tight_or_hinged"))
Hole = tuple[str, str]
"""Joint, and the one of its links in which the pin may run."""


def running_holes(case: Case) -> tuple[Hole, ...]:
    """Return the holes between layers in which pins may run, since nothing states that they are tight there.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of (str, str)
        Joint and link. Slots are among them, but holes between heads without a gap are not, which hold their link as
        it is.
    """
    linkage, found = case.linkage, []
    for name, joint in linkage.joints.items():
        if in_holes(case, name):
            every = ((link, linkage.pin_holes(name)[link].high) for link in joint.links)
            found += [(name, link) for link, play in every if play > 0.0 and _tilts(case, name, link)]
    return tuple(found)


def _tilts(case: Case, joint: str, link: str) -> bool:
    gap = gap_over_diameter(case, joint, link)
    return gap is None or gap[1] > 0.0


def with_hinges(
    frame: LinkageFrame, model: FrameModel, parents: NDArray[np.int64], holes: Sequence[Hole]
) -> FrameModel:
    """Return the model of a linkage with hinges in holes.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    model : FrameModel
        Of the frame with divided beams.
    parents : ndarray of int, shape (m,)
        Element of the frame that each one is part of.
    holes : sequence of (str, str)
        As ``running_holes`` gives them.

    Returns
    -------
    FrameModel
        The elements are those of ``model``; further nodes and guides, which bear nothing, stand after the old ones.
    """
    nodes, elements, ties, guides = list(model.nodes), list(model.elements), list(model.ties), list(model.guides)
    names = [model.name(i) for i in range(len(nodes))]
    for name, link in holes:
        [i] = np.flatnonzero(parents == frame.pin_beams[name])
        ends, eyes = list(elements[i].nodes), [own for own, _ in frame.pin_eyes[name]]
        if link not in eyes:
            continue  # a shorter joint's part of the same pin is there
        side = eyes.index(link)
        # Between a slot and hinges the node there would spin about the way across, which a slot leaves free.
        guides += [
            replace(guide, normal=np.cross(guide.normal, guide.axis))
            for guide in model.guides
            if guide.pin == ends[side] and guide.axis is not None
        ]
        for free in ACROSS:
            ties.append(Tie(nodes=(ends[side], len(nodes)), dofs=ALL_DOFS - {free}))
            ends[side] = len(nodes)
            nodes.append(nodes[elements[i].nodes[side]])
            names.append(f"the pin at {name} in {link}")
        elements[i] = replace(elements[i], nodes=(ends[0], ends[1]))
    return replace(
        model,
        nodes=np.array(nodes),
        names=tuple(names),
        elements=tuple(elements),
        ties=tuple(ties),
        guides=tuple(guides),
    )


def with_low_ends(modes: Sequence[Mode], hinged: Sequence[Mode]) -> tuple[Mode, ...]:
    """Return modes whose bands begin at those with hinges, each at that of its number.

    Parameters
    ----------
    modes : sequence of Mode
        With tight pins, the lowest frequency first.
    hinged : sequence of Mode
        The same with hinges; a mode that is missing there begins at 0.

    Returns
    -------
    tuple of Mode
    """
    found = []
    for k, mode in enumerate(modes):
        band, low = mode.frequency, hinged[k].frequency.low if k < len(hinged) else 0.0
        low = low if low > _NOTHING * band.value else 0.0
        if low < band.low:
            band = replace(band, low=low, sources=distinct(band.sources, (RUNNING,)))
        found.append(replace(mode, frequency=band))
    return tuple(found)
