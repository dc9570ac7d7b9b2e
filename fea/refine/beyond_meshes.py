"""Whether a finer mesh could decide a check, given what else leaves it open: couples, growth, play, scatter.

A check of a link is open while its number, with the band of the meshes and all other causes, is on both sides of the
limit. Written on the number of the mesh alone, the other causes make a range of the limit: a number within it is open
however exact it is. A finer mesh brings the number to some place in its present band. Where no place of the band is
outside the range, no mesh decides the check, and none is made for it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from alula.fea.refine.link_series import PeakQuantity

Ends = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class OpenRanges:
    """The limits of a link under one load case, each as the range in which its check is open for other causes.

    Attributes
    ----------
    limits : mapping of PeakQuantity to tuple of tuple of 2 float
        [MPa], [mm]
    """

    limits: Mapping[PeakQuantity, tuple[Ends, ...]]


def is_open(bands: Sequence[Ends], limit: Ends) -> bool:
    """Return whether a check is open.

    Parameters
    ----------
    bands : sequence of tuple of 2 float
        Ends of the number by every variant of the load, all of which count.
    limit : tuple of 2 float
        Range of its limit.

    Returns
    -------
    bool
    """
    return min(low for low, _ in bands) <= limit[1] and limit[0] <= max(high for _, high in bands)


def mesh_may_decide(bands: Sequence[Ends], limit: Ends) -> bool:
    """Return whether exact numbers somewhere in their bands could decide a check.

    Parameters
    ----------
    bands, limit
        As of ``is_open``.

    Returns
    -------
    bool
        True where all variants may lie below the range, or all above it.
    """
    return max(low for low, _ in bands) < limit[0] or min(high for _, high in bands) > limit[1]


def none_decides(limits: Sequence[tuple[Sequence[Ends], Ends]]) -> bool:
    """Return whether all checks of a link under a load case are open whatever its meshes tell.

    Parameters
    ----------
    limits : sequence of tuple of (bands, limit)
        As of ``is_open``, one for each check.

    Returns
    -------
    bool
        False where there is no check.
    """
    return bool(limits) and all(is_open(*one) and not mesh_may_decide(*one) for one in limits)
