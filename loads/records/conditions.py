"""How long, how often and how warm: what a material bears and how stiff it is under the conditions of a case."""

from typing import Annotated

from pydantic import model_validator

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, refusal
from alula.geometry.base.units import POSITIVE, Number, Temperature, Time
from alula.geometry.materials.material import Fatigue, Material
from alula.geometry.materials.temperature import covered, factor_at

_LAYERS = "strength_across_layers", "shear_strength_between_layers"
_BRITTLE = "inherent_strength", "inherent_strength_range", "fracture_toughness", "fracture_toughness_range"
_STRENGTHS = ("yield_strength", "ultimate_strength", "sustained_stress", "strength_range", *_LAYERS, *_BRITTLE,
              *(f"{entry}_range" for entry in _LAYERS), "fatigue", "fatigue_across_layers")  # fmt: skip
_MODULI = "youngs_modulus", "youngs_modulus_range", "sustained_modulus"


class Conditions(CaseModel):
    """The conditions under which every load case acts."""

    duration: Annotated[Time, POSITIVE] | None = None
    """How long the loads stay; where stated, links creep (``sustained_modulus``) and their stress is set
    against ``sustained_stress``."""
    cycles: Number | None = None
    """How often each load case comes and goes: in a pose from nothing to its load and back, over a motion once with
    each repetition. Where stated, links are checked for fatigue."""
    reverses: bool = False
    """True where in a pose each load goes to its opposite in place of nothing, unless its load case states least."""
    temperature: Temperature | None = None
    """Where stated, strengths and moduli are multiplied by the factors of the material's card; what needs a strength or
    a modulus that the card does not tell at this temperature is undecided."""

    @model_validator(mode="after")
    def _reversing_cycles(self) -> "Conditions":
        if self.reverses and self.cycles is None:
            raise refusal("reverses = true says how cycles go, but none are stated; add cycles or leave reverses out")
        return self


def strength_unknown(material: Material, conditions: Conditions) -> str:
    """Return why a material's strength is not known at the stated temperature.

    Parameters
    ----------
    material : Material
        The card.
    conditions : Conditions

    Returns
    -------
    str
        "" where it is known.
    """
    return _unknown(material, conditions, "temperature_factors", "strength")


def modulus_unknown(material: Material, conditions: Conditions) -> str:
    """Return why a material's modulus is not known at the stated temperature.

    Parameters
    ----------
    material : Material
        The card.
    conditions : Conditions

    Returns
    -------
    str
        "" where it is known.
    """
    return _unknown(material, conditions, "modulus_temperature_factors", "modulus")


def _unknown(material: Material, conditions: Conditions, entry: str, what: str) -> str:
    temperature, points = conditions.temperature, getattr(material, entry)
    if temperature is None or factor_at(points, temperature) is not None:
        return ""
    lost = f"so its {what} at {temperature:g} degC is not known; add them to its card"
    if not points:
        return f"'{material.title}' states no {entry}, {lost}"
    first, last = covered(points)
    side = f"above {last:g}" if temperature > last else f"below {first:g}"
    return f"{temperature:g} degC is {side} degC, where the {entry} of '{material.title}' end, {lost}"


def at_temperature(material: Material, conditions: Conditions) -> Material:
    """Return a material as it is at the stated temperature; what its card does not tell is as at room temperature.

    Strengths of all kinds, those of fatigue too, have the factor of the strength, moduli that of Young's modulus
    (assumed of sustained stress, creep modulus, fatigue and fracture toughness).

    Parameters
    ----------
    material : Material
        The card.
    conditions : Conditions

    Returns
    -------
    Material
        The card with other values.
    """
    if conditions.temperature is None:
        return material
    changed: dict[str, object] = {}
    for points, entries in (
        (material.temperature_factors, _STRENGTHS),
        (material.modulus_temperature_factors, _MODULI),
    ):
        factor = factor_at(points, conditions.temperature)
        if factor is not None and factor != 1.0:
            stated = {entry: value for entry in entries if (value := getattr(material, entry)) is not None}
            changed |= {entry: _times(value, factor) for entry, value in stated.items()}
    return material.model_copy(update=changed) if changed else material


def _times(value: float | tuple[float, float] | Fatigue, factor: float) -> float | tuple[float, float] | Fatigue:
    if isinstance(value, Fatigue):
        return value.times(factor)
    return (factor * value[0], factor * value[1]) if isinstance(value, tuple) else factor * value


def under(material: Material, conditions: Conditions) -> Material:
    """Return a material as it is under the conditions: warm, its modulus after creep.

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
        Where the card lacks what a load that lasts needs.
    """
    warm = at_temperature(material, conditions)
    if conditions.duration is None:
        return warm
    for entry in ("sustained_stress", "sustained_modulus"):
        if getattr(material, entry) is None:
            raise CaseError(
                f"conditions.duration: '{material.title}' states no {entry}, which a load that lasts needs; "
                "add it to its card or leave the duration out"
            )
    return warm.model_copy(update={"youngs_modulus": warm.sustained_modulus, "youngs_modulus_range": None})
