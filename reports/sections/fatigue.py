"""Fatigue of a link as data and in words, in a pose and over a motion."""

from typing import Any

from alula.fea.outcomes.fatigue import LIFE_FACTOR, STRESS_FACTOR, LinkFatigue
from alula.geometry.materials.material import Material
from alula.reports.sections.data import data


def fatigue_record(fatigue: LinkFatigue, material: Material) -> dict[str, Any]:
    """Return the fatigue of a link as an entry of ``result.json``.

    Parameters
    ----------
    fatigue : LinkFatigue
    material : Material
        Of the link.

    Returns
    -------
    dict
    """
    assert material.fatigue is not None
    life = fatigue.life
    return {
        "measure": measure_of(material),
        "rule": material.fatigue.rule,
        "location": fatigue.location.tolist(),
        "smallest": life.smallest,
        "largest": life.largest,
        "range": life.stress_range,
        "cycles": [{"range": size, "mean": mean, "count": count} for size, mean, count in life.cycles],
        "equivalent_peak_stress": data(fatigue.stress),
        "wanted_repetitions": fatigue.wanted,
        "strength_at_wanted": fatigue.strength,
        "repetitions": data(fatigue.repetitions),
        "scatter": scatter_of(material),
        "source": material.fatigue.source,
    }


def measure_of(material: Material) -> str:
    """Return the stress whose cycles count for fatigue.

    Parameters
    ----------
    material : Material

    Returns
    -------
    str
    """
    if material.brittle:
        return "the principal stress of largest magnitude"
    return "the von Mises stress with the sign of the principal stress of largest magnitude"


def scatter_of(material: Material) -> str:
    """Return the uncertainty of a fatigue life, in one sentence.

    Parameters
    ----------
    material : Material
        With fatigue data.

    Returns
    -------
    str
    """
    fatigue = material.fatigue
    assert fatigue is not None
    if fatigue.strength_range is not None:
        low, high = fatigue.strength_range
        return f"bands hold the scatter of the material card, {low:g} to {high:g} MPa at {fatigue.cycles:g} cycles"
    asked = f"the required factors, {STRESS_FACTOR:g} on stress and {LIFE_FACTOR:g} on life by default, must cover it"
    if fatigue.exponent is None:
        return f"the material card states one point of the S-N curve and no scatter; {asked}"
    return (
        f"the material card states no scatter; 10 % more stress shortens the life by a factor of "
        f"{1.1**fatigue.exponent:.2g}; {asked}"
    )
