"""Whether links in one layer, and pins and the links that they pass, stay apart."""

import math

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome
from alula.loads.case.case import Case
from alula.loads.records.check_spec import ClearanceCheck
from alula.loads.states.clearance import Clearance

SOURCES = (
    Source(kind=SourceKind.POSES, detail=reason("bounded_by_speed_of_outlines")),
    Source(kind=SourceKind.CHORDS, detail=reason("of_outlines")),
)


def clearance_band(found: Clearance) -> Band:
    """Return the least gap of an assembly.

    Parameters
    ----------
    found : Clearance
        Its gaps.

    Returns
    -------
    Band
        [mm]; infinite where nothing lies at one height.
    """
    least = found.least
    if least is None:
        return Band.exact(math.inf)
    low = min(gap.low for gap in found.gaps)
    high = min(gap.high for gap in found.gaps)
    sources = SOURCES if found.motion is not None else SOURCES[1:]
    return Band(value=least.value, low=low, high=max(high, least.value), sources=sources)


def clearance_outcomes(case: Case, found: Clearance | None) -> tuple[CheckOutcome, ...]:
    """Return the outcome of every check of clearance, in the name of the first load case: no load changes it.

    Parameters
    ----------
    case : Case
        The case.
    found : Clearance or None
        Its gaps; None where it has no layers, which is not checked.

    Returns
    -------
    tuple of CheckOutcome
    """
    if found is None:
        return ()
    every = asked(case, ClearanceCheck)
    return tuple(one.for_all(case, clearance_band(found), gap_reason(found)) for one in every)


def gap_reason(found: Clearance) -> Reason:
    """Tell where the links of an assembly touch first, or come nearest.

    Parameters
    ----------
    found : Clearance
        Its gaps.

    Returns
    -------
    Reason
    """
    shown = found.shown
    if shown is None:
        return reason("none_at_one_height")
    kind = "come_nearest" if found.contact is None else "touch_first"
    return reason(kind, names=shown.names, where=found.where(shown))
