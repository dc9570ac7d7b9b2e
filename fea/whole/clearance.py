"""Whether links in one layer, and pins and the links that they pass, stay apart."""

import math

from alula.fea.common.band import Band
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity
from alula.loads.case.case import Case
from alula.loads.records.check_spec import ClearanceCheck
from alula.loads.states.clearance import Clearance

SOURCES = (
    Source(kind=SourceKind.POSES, detail="bounded by the speed of the outlines"),
    Source(kind=SourceKind.CHORDS, detail="of the outlines"),
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
    value, load_case = clearance_band(found), next(iter(case.load_cases))
    return tuple(
        CheckOutcome.of(name, LINKAGE, load_case, Quantity.CLEARANCE, value, check.minimum, clearance_sentence(found))
        for name, check in case.all_checks.items()
        if isinstance(check, ClearanceCheck)
    )


def clearance_sentence(found: Clearance) -> str:
    """Say where the links of an assembly touch first, or come nearest.

    Parameters
    ----------
    found : Clearance
        Its gaps.

    Returns
    -------
    str
    """
    shown = found.shown
    if shown is None:
        return "no two links, and no link and pin that passes it, lie at one height"
    names = " and ".join(shown.names)
    if found.contact is not None:
        return f"{names} touch first {found.where(shown)}"
    return f"{names} come nearest {found.where(shown)}"
