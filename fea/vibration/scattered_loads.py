"""What natural frequencies may be since the loads scatter.

All forces grow with the share s of the stated loads, so that λ of (K + s K_g) x = λ M x is sought over its range. By
Rayleigh's quotient the lowest λ is the least of functions that are linear in s: it is concave, and least at an end of
the range, where it is solved. The kth λ is at most the largest of any k shapes together, and no less than the least of
all shapes that k - 1 conditions leave (Courant & Hilbert, Methods of Mathematical Physics, vol. 1, 1953, section I.4).
With the lowest modes under the stated loads as shapes and conditions, the former is convex in s and the latter concave,
so that the ends bound what lies between them: the latter but for modes beyond those found.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.scatter import Scatter
from alula.fea.common.source import distinct
from alula.fea.vibration.modes import Mode, NaturalModes, frequency

Floats = NDArray[np.float64]


def ends_between(found: NaturalModes, work: Floats, ends: Sequence[float], count: int) -> list[tuple[float, float]]:
    """Return bounds of the lowest eigenvalues under all loads of a range.

    Parameters
    ----------
    found : NaturalModes
        Under the stated loads; c of them.
    work : ndarray, shape (c, c)
        Xᵀ K_g X of their vectors X.
    ends : sequence of float
        Least and largest load over the stated one.
    count : int
        Eigenvalues at the most.

    Returns
    -------
    list of tuple of (float, float)
        Least and largest λ [rad²/s²]; the least one of the first is an estimate, to be solved at the ends.
    """
    at = [np.diag(found.values) + (share - 1.0) * (work + work.T) / 2.0 for share in ends]
    return [
        (
            min(float(np.linalg.eigvalsh(A[k:, k:])[0]) for A in at),
            max(float(np.linalg.eigvalsh(A[: k + 1, : k + 1])[-1]) for A in at),
        )
        for k in range(min(count, len(found.values)))
    ]


def with_scatter(
    modes: Sequence[Mode], others: Sequence[Sequence[Mode]], between: Sequence[tuple[float, float]], scatter: Scatter
) -> tuple[Mode, ...]:
    """Return modes whose bands hold the frequencies under all loads of a range.

    Parameters
    ----------
    modes : sequence of Mode
        Under the stated loads, the lowest frequency first.
    others : sequence of sequence of Mode
        The same under the least and the largest load; a mode that is missing there begins at 0.
    between : sequence of tuple of (float, float)
        Those of ``ends_between``.
    scatter : Scatter
        Of the loads.

    Returns
    -------
    tuple of Mode
    """
    found = []
    for k, (mode, bounds) in enumerate(zip(modes, between, strict=True)):
        known = [mode.frequency, *(one[k].frequency for one in others if k < len(one))]
        least, most = min(band.value for band in known), max(band.value for band in known)
        low, high = min(band.low for band in known), max(band.high for band in known)
        # What flexibilities leave open at the ends holds between them as well.
        below, above = least if k == 0 else min(frequency(bounds[0]), least), max(frequency(bounds[1]), most)
        low = low * below / least if least > 0.0 and len(known) > len(others) else 0.0
        high = max(high * above / most, above) if most > 0.0 else max(high, above)
        width = above / below if below > 0.0 else math.inf
        told = tuple(replace(one, width=width) for one in scatter.sources)
        band = replace(mode.frequency, low=low, high=high, sources=distinct(mode.frequency.sources, told))
        found.append(replace(mode, frequency=band))
    return tuple(found)
