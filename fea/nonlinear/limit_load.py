"""Limit-load factor: by what factor all loads may grow until the linkage gives way.

The path of stable equilibrium is followed to ``MOST`` times the load. It ends at a limit point, from where the linkage
snaps through, or where the deformed shape is not stable any more. Where linear theory finds the linkage so far from
buckling and from a dead point that even a shallow toggle would hold ``MOST`` times the load, nothing is followed. The
material is linear: where a link breaks is no part of the factor.

The band covers the steps of the path; stated scatter of load and modulus; what plain beams do not know of eyes, bores
and holes (all links are then softer by what these add to the work of the loads, as a frame of linear material has the
shape that load over modulus gives it); and faults of shape, by a third of the linear buckling factor, the rule of
``LEAST_LINEAR``.
"""

import math

from fea.common.band import Band
from fea.common.scatter import Scatter
from fea.common.source import Source, SourceKind, distinct
from fea.frame.displacement_band import compliance_range
from fea.nonlinear.equilibrium_path import NoEquilibriumError
from fea.nonlinear.large_displacement import LEAST_LINEAR, LargeDisplacement, followed
from fea.nonlinear.stability import SNAP
from loads.case.case import Case

MOST = 10.0
"""Factor up to which the path is followed."""
_EYES = Source(kind=SourceKind.EYES)


def limit_load(case: Case, moved: LargeDisplacement) -> Band:
    """Return the factor on all loads at which the linkage gives way.

    Parameters
    ----------
    case : Case
        The case.
    moved : LargeDisplacement
        What became of one of its load cases.

    Returns
    -------
    Band
        Without upper end where the linkage holds ``MOST`` times the load; not known where there is no frame.
    """
    if moved.frame is None or moved.solution is None or moved.buckling is None or moved.factor is None:
        return Band.unknown(moved.sentence)
    if blind := [link for link in case.bending_links if not case.part_of(link).has_centre_line(case.body(link))]:
        return Band.unknown(f"the frame takes link {blind[0]} for a beam along its axis, which does not tell")
    soft = compliance_range(case, moved.frame, moved.solution)
    slack = moved.scatter.times(Scatter(low=soft[0], high=soft[1], sources=(_EYES,)))
    sources, faults = slack.sources, moved.buckling / LEAST_LINEAR / slack.high
    if moved.state == "off" or moved.factor / SNAP / slack.high >= MOST:
        value, low, high = moved.factor, moved.factor / SNAP / slack.high, moved.buckling / slack.low
        sources = (*sources, Source(kind=SourceKind.SNAP_THROUGH, detail="linear theory puts it too high"))
    else:
        value, lost = (moved.held, moved.lost) if moved.gives_way else _end(moved)
        low, high = value / slack.high, lost / slack.low
        sources = (Source(kind=SourceKind.PATH, detail="steps of the load"), *sources)
        if faults < low:
            detail = f"buckling at less than {LEAST_LINEAR:g} times the load"
            low, sources = faults, (*sources, Source(kind=SourceKind.IMPERFECTION, detail=detail))
    if value >= MOST:
        return Band(value=MOST, low=min(low, MOST), high=math.inf, sources=distinct(sources))
    return Band(value=value, low=min(low, value), high=max(high, value), sources=distinct(sources))


def _end(moved: LargeDisplacement) -> tuple[float, float]:
    """Return the largest factor that was found to be held, and the least that was not."""
    assert moved.frame is not None
    try:
        followed(moved.frame, MOST)
    except NoEquilibriumError as error:
        held = max(MOST * error.reached, moved.held)  # the steps to the load itself may be finer
        return held, max(MOST * error.failed, held)
    return MOST, math.inf
