"""What a search may leave beyond the ends that it found."""

from collections.abc import Collection

LEFT = 0.1
"""Share of what lies between the ends found by which a number may lie beyond them: where pins stand is sought among
clearances, and no search proves that it found the largest. The most that 10,000 draws on each of 20 random linkages
showed, rounded up; it was tried on ten others (``benchmarks/draws.py``)."""


def sought(found: Collection[float]) -> tuple[float, float]:
    """Return the ends of what a search looked for.

    Parameters
    ----------
    found : collection of float
        Numbers at all places where it ended.

    Returns
    -------
    tuple of (float, float)
        Least and largest, with what may lie beyond.
    """
    low, high = min(found), max(found)
    left = LEFT * (high - low)
    return low - left, high + left
