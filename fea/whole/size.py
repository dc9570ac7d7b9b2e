"""Whether a linkage fits into a box along the global axes."""

from alula.fea.asked.asked import asked, checks_of
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import SIZES, CheckOutcome
from alula.geometry.clearance.reach import Outermost
from alula.loads.case.case import Case
from alula.loads.records.check_spec import SizeCheck
from alula.loads.states.extent import Extent, unmeasured

POSES = Source(kind=SourceKind.POSES, detail=reason("bounded_by_acceleration_of_outlines"))
CHORDS = Source(kind=SourceKind.CHORDS, detail=reason("of_outlines"))
_ROUNDING = 1e-9


def size_band(found: Extent, axis: int) -> Band:
    """Return the length of the box about a linkage.

    Parameters
    ----------
    found : Extent
    axis : int
        0, 1 or 2 of x, y and z.

    Returns
    -------
    Band
        [mm]
    """
    first, last = found.reaches[axis]
    value = last.value - first.value
    less, more = first.less + last.less, first.more + last.more
    sources = ((POSES, more > less + _ROUNDING), (CHORDS, less > 0.0))
    told = tuple(source for source, holds in sources if holds)
    return Band(value=value, low=max(value - less, 0.0), high=value + more, sources=told)


def size_outcomes(case: Case, found: Extent | None) -> tuple[CheckOutcome, ...]:
    """Return three outcomes of every check of size, in the name of the first load case: no load changes them.

    Parameters
    ----------
    case : Case
    found : Extent or None
        The box about the linkage; None where no check asks for it.

    Returns
    -------
    tuple of CheckOutcome
        Along x, y and z.
    """
    if found is None:
        return ()
    every = [(one, SIZES.index(one.quantity)) for one in asked(case, SizeCheck)]
    return tuple(one.for_all(case, size_band(found, axis), size_reason(found, axis)) for one, axis in every)


def size_limits(case: Case) -> tuple[float, ...]:
    """Return the least limits of all checks of size.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of 3 float
        Along x, y and z [mm]; empty where no check of size is stated.
    """
    stated = [check.maximum for _, check in checks_of(case, SizeCheck)]
    return tuple(min(lengths) for lengths in zip(*stated, strict=True))


def size_reason(found: Extent, axis: int) -> Reason:
    """Tell between which outlines a linkage is longest along an axis, and what is not counted.

    Parameters
    ----------
    found : Extent
    axis : int
        0, 1 or 2 of x, y and z.

    Returns
    -------
    Reason
    """
    first, last = (_side(found, side, "xyz"[axis]) for side in found.reaches[axis])
    return reason("from_side_to_side", first=first, last=last, not_counted=tuple(unmeasured(found.assembly.case)))


def _side(found: Extent, side: Outermost, axis: str) -> Reason:
    facts = {"name": side.name, "axis": axis, "value": side.value}
    if side.at is None or found.motion is None:
        return reason("side", **facts)
    value = float(found.motion.told(side.at))
    return reason("side_in_pose", **facts, coordinate=found.motion.coordinate.name, at=value, unit=found.motion.unit)
