"""What a card tells of the strength of a brittle material at notches: critical distance, and strength by volume.

Theory of critical distances (D. Taylor, The Theory of Critical Distances, 2007): a notch breaks where the stress at L/2
from its root, or its mean over 2 L, reaches the inherent strength σ0, with L = (K_Ic/σ0)²/π. A crack then breaks at
K_Ic by both: σ = K/√(2πr) is K/√(πL) at L/2, and so is its mean over 2 L.
"""

import math
from dataclasses import dataclass

from alula.geometry.base.model import CaseModel, refusal

AGREE = 0.10
"""Relative difference of a stated critical distance from that of the toughness: it goes with the square of values that
are given to two digits."""
_LENGTHS = "critical_distance", "fracture_toughness"
_ENTRIES = ("inherent_strength", *_LENGTHS, "weibull_modulus", "weibull_volume")


@dataclass(frozen=True, kw_only=True)
class NotchStrength:
    """How a brittle material bears notches.

    Attributes
    ----------
    distance : float
        Critical distance L [mm].
    inherent : float
        Inherent strength σ0 [MPa].
    ultimate : float
        Tensile strength [MPa].
    """

    distance: float
    inherent: float
    ultimate: float


def critical_distance(toughness: float, strength: float) -> float:
    """Return L = (K_Ic/σ0)²/π.

    Parameters
    ----------
    toughness : float
        K_Ic [MPa √mm].
    strength : float
        Inherent strength σ0 [MPa].

    Returns
    -------
    float
        [mm]
    """
    return (toughness / strength) ** 2 / math.pi


def notch_strengths(card: CaseModel) -> tuple[NotchStrength, NotchStrength, NotchStrength] | None:
    """Return how a material bears notches as its card states, at its weakest and at its strongest.

    What a notch bears rises with the toughness, the critical distance, and either strength where the others stay. An
    inherent strength without a range of its own scatters as the tensile strength does.

    Parameters
    ----------
    card : Material

    Returns
    -------
    tuple of 3 NotchStrength or None
        None where its card does not tell.
    """
    if "inherent_strength" not in _stated(card):
        return None
    return _at(card, None), _at(card, 0), _at(card, 1)


def _at(card: CaseModel, end: int | None) -> NotchStrength:
    """Return what a card states, or the low (0) or high (1) ends of the ranges that it has."""

    def stated(entry: str, scatter: str = "") -> float:
        ends = getattr(card, scatter or f"{entry}_range")
        return float(getattr(card, entry) if end is None or ends is None else ends[end])

    inherent, ultimate = stated("inherent_strength"), stated("ultimate_strength", "strength_range")
    if dict(card)["inherent_strength_range"] is None:
        inherent *= ultimate / float(dict(card)["ultimate_strength"])
    if "critical_distance" in _stated(card):
        distance = stated("critical_distance")
    else:
        distance = critical_distance(stated("fracture_toughness"), inherent)
    return NotchStrength(distance=distance, inherent=inherent, ultimate=ultimate)


def check_brittle(card: CaseModel) -> None:
    """Refuse entries on notches that do not fit each other.

    Parameters
    ----------
    card : Material

    Raises
    ------
    PydanticCustomError
    """
    stated = _stated(card)
    if stated and dict(card)["strength"] != "ultimate":
        raise refusal(f'{stated[0]} is of a brittle material; leave it out, or set strength = "ultimate"')
    lengths = [entry for entry in _LENGTHS if entry in stated]
    if bool(lengths) != ("inherent_strength" in stated):
        has, lacks = (lengths[0], "inherent_strength") if lengths else ("inherent_strength", " or ".join(_LENGTHS))
        raise refusal(f"{has} needs {lacks}; state it too")
    if ("weibull_modulus" in stated) != ("weibull_volume" in stated):
        raise refusal("weibull_modulus and weibull_volume need each other; state both")
    for entry in _ENTRIES[:3]:
        if entry not in stated and getattr(card, f"{entry}_range") is not None:
            raise refusal(f"{entry}_range needs {entry}; state it too")
    if not lengths:
        return
    found = _at(card, None)
    if found.inherent < found.ultimate:
        raise refusal(
            f"inherent_strength {found.inherent:g} MPa is below ultimate_strength {found.ultimate:g} MPa, that of a "
            "bar without a notch; correct one of them"
        )
    if len(lengths) == 2:
        follows = critical_distance(dict(card)["fracture_toughness"], found.inherent)
        if abs(found.distance / follows - 1.0) > AGREE:
            raise refusal(
                f"critical_distance is {found.distance:g} mm, but {follows:.3g} mm follow from fracture_toughness and "
                "inherent_strength; correct one of them, or leave one out"
            )


def _stated(card: CaseModel) -> list[str]:
    """Return which of the entries on notches a card states."""
    return [entry for entry in _ENTRIES if getattr(card, entry) is not None]
