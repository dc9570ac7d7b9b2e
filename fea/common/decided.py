"""Which single thing would decide a check whose band holds its limit, in the order of what it costs.

A band of strength over stress is the product of what its sources make of it (``docs/theory/bands.md``). Without a
source k its ends are low/l_k and high/h_k, with the least and the largest factor of k. Where both then lie on one side
of the limit, to know k alone decides the check:

* one of several answers (a solid in place of hand calculation, fits, the direction of building) may be found to be any
  of them. It decides unless the number n that it alone gives has the limit within n low/(l_k v) to n high/(h_k v);
* a range decides as soon as it leaves the end of the band at the limit, with l_k limit/low or h_k limit/high.

What a source makes of the worst of several places or plates follows from the bands of these (``Band.largest``).
"""

import math

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import SourceKind, widest

_ORDER = {
    SourceKind.DISCRETISATION: "decided_by_discretisation",
    SourceKind.CALIBRATION: "decided_by_calibration",
    SourceKind.COUPLES: "decided_by_couples",
    SourceKind.BUILD: "decided_by_build",
    SourceKind.PLAY: "decided_by_play",
    SourceKind.LOAD: "decided_by_load",
    SourceKind.STRENGTH: "decided_by_strength",
    SourceKind.AIR: "decided_by_air",
    SourceKind.FRICTION: "decided_by_friction",
}
"""A finer mesh, a solid, a statement in the case, a narrower range; and how it is told."""
_ANSWERS = (SourceKind.CALIBRATION, SourceKind.COUPLES, SourceKind.BUILD)
"""Those of which one of several answers holds."""
TOLD = 1.05
"""Width below which a source is none of those that most of a band comes from."""


def decided_by(value: Band, limit: float, *, factors: bool) -> Reason | str:
    """Return which single source would decide a check if it were known.

    Parameters
    ----------
    value : Band
        That holds the limit.
    limit : float
        What the number must be at least.
    factors : bool
        Whether the band is a product of what its sources make of it; else the widest are told alone.

    Returns
    -------
    Reason or str
        "" where nothing is known of any source.
    """
    ends = _ends(value)
    if factors and 0.0 < value.value < math.inf:
        for kind in _ORDER:
            found = kind in ends and _by(kind, value, limit, *ends[kind])
            if found:
                return found
    if factors and ends and all(one.kind in ends for one in value.sources):
        widths = {kind: high / low if low > 0.0 else math.inf for kind, (low, high) in ends.items()}
        most = sorted((kind for kind in widths if widths[kind] > TOLD), key=lambda kind: -widths[kind])[:2]
        return reason("decided_by_none", sources=[reason("makes_of_band", kind=x, width=widths[x]) for x in most])
    most = list(
        dict.fromkeys(
            one.kind for one in widest(value.sources, value.high / value.low if value.low > 0.0 else math.inf)
        )
    )
    return reason("most_of_band", sources=most) if most else ""


def _ends(value: Band) -> dict[SourceKind, tuple[float, float]]:
    """Least and largest factor of all sources of a kind, of those that are known."""
    found = dict[SourceKind, tuple[float, float]]()
    for kind in dict.fromkeys(one.kind for one in value.sources):
        low, high = (math.prod(one.ends[i] for one in value.sources if one.kind is kind) for i in (0, 1))
        if low <= 1.0 <= high:
            found[kind] = low, high
    return found


def _by(kind: SourceKind, value: Band, limit: float, least: float, most: float) -> Reason | None:
    """What a source that lies between two factors must be for the check to be decided; None where it does not do."""
    if not 0.0 < least <= most < math.inf:
        return None
    passes, low, high = value.value > limit, value.low / least, value.high / most
    if not (low >= limit if passes else high < limit):
        return None
    name = _ORDER[kind]
    if kind in _ANSWERS:
        return reason(name, ends=(limit * value.value / high, limit * value.value / low if low > 0.0 else math.inf))
    needed = least * limit / value.low if passes else most * limit / value.high
    return reason(name, passes=passes, needed=needed)
