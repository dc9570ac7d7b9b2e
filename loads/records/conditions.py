"""How long and how warm: what a material bears and how stiff it is under the conditions of a case."""

import itertools
from typing import Annotated

from geometry.base.errors import CaseError
from geometry.base.model import CaseModel
from geometry.base.units import POSITIVE, Temperature, Time
from geometry.materials.material import Material


class Conditions(CaseModel):
    """The conditions under which every load case acts."""

    duration: Annotated[Time, POSITIVE] | None = None
    """How long the loads stay; where stated, links creep (``sustained_modulus``) and their stress is set
    against ``sustained_stress``."""
    temperature: Temperature | None = None
    """Where stated, strengths are multiplied by the material's temperature factor."""


def temperature_factor(material: Material, temperature: float) -> float:
    """Return the factor on a material's strength, linear between those of its card; 1 below the first of them.

    Parameters
    ----------
    material : Material
        The card.
    temperature : float
        Temperature [°C].

    Returns
    -------
    float
        Factor on the strength.

    Raises
    ------
    CaseError
        For a material without factors, and above the last of them.
    """
    points = material.temperature_factors
    if not points:
        raise CaseError(
            f"conditions.temperature: '{material.title}' states no temperature_factors, so its strength at "
            f"{temperature:g} degC is unknown; add them to its card or leave the temperature out"
        )
    if temperature > points[-1][0]:
        raise CaseError(
            f"conditions.temperature: {temperature:g} degC is above {points[-1][0]:g} degC, the last for which "
            f"'{material.title}' states a factor; use another material or add one to its card"
        )
    if temperature <= points[0][0]:
        return min(1.0, points[0][1])
    for (t0, f0), (t1, f1) in itertools.pairwise(points):
        if temperature <= t1:
            return f0 + (f1 - f0) * (temperature - t0) / (t1 - t0)
    raise AssertionError("the factors rise in temperature")


def under(material: Material, conditions: Conditions) -> Material:
    """Return a material as it is under the conditions: its strengths warm, its modulus after creep.

    Parameters
    ----------
    material : Material
        The card.
    conditions : Conditions
        How long and how warm.

    Returns
    -------
    Material
        The card with other values.

    Raises
    ------
    CaseError
        Where the card lacks what is needed.
    """
    changed: dict[str, object] = {}
    if conditions.temperature is not None:
        factor = temperature_factor(material, conditions.temperature)
        layers = "strength_across_layers", "shear_strength_between_layers"
        for entry in ("yield_strength", "ultimate_strength", "sustained_stress", *layers):
            if getattr(material, entry) is not None:
                changed[entry] = getattr(material, entry) * factor
        for entry in ("strength_range", *(f"{entry}_range" for entry in layers)):
            if getattr(material, entry) is not None:
                changed[entry] = tuple(factor * bound for bound in getattr(material, entry))
    if conditions.duration is not None:
        for entry in ("sustained_stress", "sustained_modulus"):
            if getattr(material, entry) is None:
                raise CaseError(
                    f"conditions.duration: '{material.title}' states no {entry}, which a load that lasts needs; "
                    "add it to its card or leave the duration out"
                )
        changed["youngs_modulus"] = material.sustained_modulus
        changed["youngs_modulus_range"] = None
    return material.model_copy(update=changed) if changed else material
