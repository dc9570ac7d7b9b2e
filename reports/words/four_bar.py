"""Angles, branches and lengths of a four-bar in words, for its tables and its drawing."""

from alula.geometry.mechanisms.synthesis import Drive, PrecisionPoint, Synthesis

ANGLES = {"a": "φ", "b": "θ", "c": "ψ"}
"""Direction of each link."""


def seen(point: PrecisionPoint, drive: Drive) -> str:
    """Return on which branch a precision point lies, as seen from a driven link.

    Parameters
    ----------
    point : PrecisionPoint
    drive : Drive

    Returns
    -------
    str
    """
    return point.branches[drive] or "dead point"


def unit_of(synthesis: Synthesis) -> tuple[str, float]:
    """Return the unit in which lengths are told, and the mm in it.

    Parameters
    ----------
    synthesis : Synthesis

    Returns
    -------
    tuple[str, float]
    """
    return ("m", 1000.0) if synthesis.four_bar.d >= 1000.0 else ("mm", 1.0)
