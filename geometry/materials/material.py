"""Material cards with the source of every value, and the library that alula ships."""

import itertools
import tomllib
from collections.abc import Collection
from functools import cache
from importlib.resources import files
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Stated, Text, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Density, Length, Number, Stress, Toughness, Volume
from alula.geometry.materials.brittle_notch import check_brittle
from alula.geometry.materials.directional import directional
from alula.geometry.materials.temperature import TemperatureFactors, check_factors

Status = Literal["measured", "datasheet", "handbook", "assumed"]
TOLD = (
    "density",
    "youngs_modulus",
    "poissons_ratio",
    "yield_strength",
    "ultimate_strength",
    "strength_across_layers",
    "shear_strength_between_layers",
)
"""Entries whose source and status every card should state, where it states the entry."""


def _ordered(value: tuple[float, float]) -> tuple[float, float]:
    if value[0] > value[1]:
        raise PydanticCustomError("range_reversed", "the first value of a range must not exceed the second; swap them")
    return value


Range = Annotated[tuple[Annotated[Stress, POSITIVE], Annotated[Stress, POSITIVE]], AfterValidator(_ordered)]
LengthRange = Annotated[tuple[Annotated[Length, POSITIVE], Annotated[Length, POSITIVE]], AfterValidator(_ordered)]
ToughnessRange = Annotated[
    tuple[Annotated[Toughness, POSITIVE], Annotated[Toughness, POSITIVE]], AfterValidator(_ordered)
]


class Fatigue(CaseModel):
    """Fatigue data: one point of the S-N line, or a power law through it.

    ``stress`` is the largest stress of a cycle from zero (R = 0) unless ``stress_ratio`` says
    otherwise; the law is N = N1 (sigma / sigma1)^(-exponent).
    """

    stress: Annotated[Stress, POSITIVE]
    """Peak stress that the material bears for ``cycles``."""
    cycles: Number
    """Cycles that it bears at that stress."""
    exponent: float | None = None
    """Exponent of the power law, from 1 to 100; none where a single point is known."""
    endurance_cycles: Number | None = None
    """Cycles from which on strength falls no further (endurance limit); left out, the line has no end."""
    strength_range: Range | None = None
    """Scatter of the stress at ``cycles``: least and greatest value."""
    surface_factor: Annotated[float, Field(gt=0, le=1)] = 1.0
    """Strength with the surface and size of the part over that of the specimens."""
    notch_length: Annotated[Length, POSITIVE] | None = None
    """Peterson's length a: beside a hole of radius r the share 1/(1 + a/r) of the concentration counts. Left out, all
    of it counts."""
    stress_ratio: Annotated[float, Field(ge=-1, lt=1)] = 0.0
    """Least over largest stress of the cycle in the test."""
    rule: Literal["goodman", "peak-stress"] = "goodman"
    """How cycles with another mean count: by Goodman's line, or by their peak stress alone, whatever their range."""
    source: Text
    """Where the data come from."""

    @model_validator(mode="after")
    def _consistent(self) -> "Fatigue":
        if self.strength_range and not self.strength_range[0] <= self.stress <= self.strength_range[1]:
            raise refusal("strength_range of fatigue leaves out its stress; correct one of them")
        if self.exponent is not None and not 1.0 <= self.exponent <= 100.0:  # beyond, powers overflow
            raise refusal(
                f"exponent of fatigue is {self.exponent:g}, but must be from 1 to 100; for Basquin's slope b "
                "of the stress state 1/b, for example 11.8 for 0.085"
            )
        return self

    def times(self, factor: float) -> "Fatigue":
        """Return the same with its strength, and the range of it, times a factor.

        Parameters
        ----------
        factor : float

        Returns
        -------
        Fatigue
        """
        ends = self.strength_range and tuple(factor * end for end in self.strength_range)
        return self.model_copy(update={"stress": factor * self.stress, "strength_range": ends})


class Material(CaseModel):
    """An isotropic linear elastic material: density, stiffness, strength and where they come from."""

    title: Stated
    """Name of the material, for the report."""
    density: Annotated[Density, POSITIVE]
    """Mass per volume."""
    youngs_modulus: Annotated[Stress, POSITIVE]
    """Modulus of elasticity (Young's modulus)."""
    poissons_ratio: Annotated[float, Field(gt=-1.0, lt=0.5)]
    """Poisson's ratio."""
    yield_strength: Annotated[Stress, POSITIVE] | None = None
    """Tensile yield strength."""
    ultimate_strength: Annotated[Stress, POSITIVE] | None = None
    """Tensile ultimate strength."""
    strength: Literal["yield", "ultimate"]
    """Which of the two the safety factor uses: yield against von Mises stress (ductile), ultimate
    against the largest principal stress (brittle)."""
    youngs_modulus_range: Range | None = None
    """Scatter of the modulus: least and greatest value."""
    strength_range: Range | None = None
    """Scatter of the strength that the safety factor uses."""
    compression_ratio: Annotated[float, Field(ge=1.0, le=2.0)] | None = None
    """Compressive over tensile yield strength, of plastics some 1.1 to 1.4; plastic collapse uses it, else 1."""
    hardening_factors: tuple[tuple[Annotated[float, Field(ge=0)], Annotated[float, Field(ge=1)]], ...] = ()
    """(plastic strain, yield stress over yield_strength), rising; straight between. Plastic collapse uses them up to
    the last strain, where its path ends; without them the material does not harden."""
    inherent_strength: Annotated[Stress, POSITIVE] | None = None
    """Of a brittle material: what its stress reaches at the critical distance from a notch as it breaks; not below
    ultimate_strength."""
    inherent_strength_range: Range | None = None
    """Its scatter; that of ultimate_strength where left out."""
    critical_distance: Annotated[Length, POSITIVE] | None = None
    """Of a brittle material: L = (fracture_toughness/inherent_strength)²/π, at half of which a notch is judged."""
    critical_distance_range: LengthRange | None = None
    """Its scatter."""
    fracture_toughness: Annotated[Toughness, POSITIVE] | None = None
    """K_Ic, which gives the critical distance where that is not stated."""
    fracture_toughness_range: ToughnessRange | None = None
    """Its scatter."""
    weibull_modulus: Annotated[float, Field(ge=1.0)] | None = None
    """Of a brittle material whose strength falls with its volume."""
    weibull_volume: Annotated[Volume, POSITIVE] | None = None
    """Volume under even tension of the specimens that have ultimate_strength."""
    strength_across_layers: Annotated[Stress, POSITIVE] | None = None
    """Tensile strength of a printed material normal to its layers, measured on specimens built upright."""
    strength_across_layers_range: Range | None = None
    """Its scatter."""
    shear_strength_between_layers: Annotated[Stress, POSITIVE] | None = None
    """Strength of a printed material against shear along its layers."""
    shear_strength_between_layers_range: Range | None = None
    """Its scatter."""
    ultimate_strength_by_diameter: tuple[tuple[Annotated[Length, POSITIVE], Annotated[Stress, POSITIVE]], ...] = ()
    """(largest diameter, least ultimate strength) of drawn wire, rising in diameter. The stated ultimate_strength is
    that of one diameter, and the yield strength keeps its share of it."""
    sustained_stress: Annotated[Stress, NOT_NEGATIVE] | None = None
    """Largest stress under a load that stays."""
    sustained_modulus: Annotated[Stress, POSITIVE] | None = None
    """Modulus under a load that stays (creep modulus)."""
    temperature_factors: TemperatureFactors = ()
    """(temperature, factor on strength), rising in temperature; linear between them, and unknown beyond."""
    modulus_temperature_factors: TemperatureFactors = ()
    """(temperature, factor on the modulus), as temperature_factors."""
    fatigue: Fatigue | None = None
    """Fatigue data; without them nothing is known of the fatigue of links."""
    fatigue_across_layers: Fatigue | None = None
    """Of a printed material: of specimens built upright, so that its stress is tension normal to the layers."""
    minimum_safety_factor: Number | None = None
    """Default limit for a static check of an untested part."""
    minimum_safety_factor_tested: Number | None = None
    """Default limit where parts of the same make were tested."""
    sources: dict[str, Text]
    """Entry -> where its value comes from. A warning lists density, elastic constants and strengths left out."""
    status: dict[str, Status]
    """Entry -> how well it is known. A warning lists density, elastic constants and strengths left out."""

    @model_validator(mode="after")
    def _strengths(self) -> "Material":
        if (self.yield_strength if self.strength == "yield" else self.ultimate_strength) is None:
            raise PydanticCustomError(
                "no_strength",
                "strength = '{which}' needs {which}_strength; add it, or set strength to the other one",
                {"which": self.strength},
            )
        if self.yield_strength and self.ultimate_strength and self.yield_strength > self.ultimate_strength:
            raise PydanticCustomError(
                "yield_above_ultimate",
                "yield_strength {y} MPa is above ultimate_strength {u} MPa; check the units and the decimal points",
                {"y": f"{self.yield_strength:g}", "u": f"{self.ultimate_strength:g}"},
            )
        check_factors("temperature_factors", self.temperature_factors, "strength")
        check_factors("modulus_temperature_factors", self.modulus_temperature_factors, "modulus")
        curve = self.hardening_factors
        if any(a[0] >= b[0] or a[1] > b[1] for a, b in itertools.pairwise(curve)) or (curve and curve[-1][0] == 0.0):
            raise PydanticCustomError(
                "hardening_not_rising",
                "hardening_factors must rise in strain and never fall in stress; state each strain once, in order",
            )
        if (curve or self.compression_ratio) and self.strength != "yield":
            raise refusal("hardening_factors and compression_ratio are of a material that yields; leave them out")
        diameters = [diameter for diameter, _ in self.ultimate_strength_by_diameter]
        if any(a >= b for a, b in itertools.pairwise(diameters)):
            raise PydanticCustomError(
                "diameters_not_rising",
                "ultimate_strength_by_diameter must rise in diameter; sort it and state each diameter once",
            )
        if diameters and self.ultimate_strength is None:
            raise PydanticCustomError(
                "no_strength_to_scale",
                "ultimate_strength_by_diameter needs ultimate_strength, that of one diameter; state it too",
            )
        if why := directional(self.title):
            raise refusal(f"'{self.title}' {why}")
        layers = "strength_across_layers", "shear_strength_between_layers"
        upon = (layers[1], layers[0]), ("fatigue_across_layers", layers[0])
        for entry, needed in (*upon, *((f"{entry}_range", entry) for entry in layers)):
            if getattr(self, entry) is not None and getattr(self, needed) is None:
                raise refusal(f"{entry} needs {needed}; state it too")
        check_brittle(self)
        if unknown := [entry for entry in (*self.sources, *self.status) if entry not in type(self).model_fields]:
            raise PydanticCustomError(
                "no_such_entry",
                "sources or status name '{entry}', but a material has no such entry; correct the name",
                {"entry": unknown[0]},
            )
        return self

    @model_validator(mode="after")
    def _consistent(self) -> "Material":
        """Refuse values of which one contradicts another."""
        own = "yield_strength" if self.strength == "yield" else "ultimate_strength"
        between = {
            "youngs_modulus_range": "youngs_modulus",
            "strength_range": own,
            "inherent_strength_range": "inherent_strength",
            "critical_distance_range": "critical_distance",
            "fracture_toughness_range": "fracture_toughness",
            "strength_across_layers_range": "strength_across_layers",
            "shear_strength_between_layers_range": "shear_strength_between_layers",
        }
        for entry, of in between.items():
            scatter, value = getattr(self, entry), getattr(self, of)
            unit = {"critical_distance": "mm", "fracture_toughness": "MPa*mm^0.5"}.get(of, "MPa")
            if scatter is not None and value is not None and not scatter[0] <= value <= scatter[1]:
                raise refusal(
                    f"{entry} is from {scatter[0]:g} to {scatter[1]:g} {unit}, which leaves out {of}, {value:g} "
                    f"{unit}; correct one of them"
                )
        for entry, of in (("sustained_stress", own), ("sustained_modulus", "youngs_modulus")):
            lasting, brief = getattr(self, entry), getattr(self, of)
            if lasting is not None and brief is not None and lasting > brief:
                raise refusal(
                    f"{entry} is {lasting:g} MPa, above {of}, {brief:g} MPa, though under a load that stays a material "
                    "bears less and gives more; correct one of them"
                )
        return self

    def drawn(self, entry: str, diameter: float) -> "Material":
        """Return the material with the strength that it has as round wire; thicker wire lasts less in proportion.

        Parameters
        ----------
        entry : str
            Entry of the case that states the diameter, for the message.
        diameter : float
            Diameter of the wire [mm].

        Returns
        -------
        Material
            The same material where its card knows no strengths by diameter.

        Raises
        ------
        CaseError
            For wire that is thicker than the card knows.
        """
        points = self.ultimate_strength_by_diameter
        if not points:
            return self
        found = next((strength for limit, strength in points if diameter <= limit * (1.0 + 1e-9)), None)
        if found is None:
            raise CaseError(
                f"{entry}: {diameter:g} mm is thicker than the strengths of '{self.title}' are known for; set at most "
                f"{points[-1][0]:g} mm, or choose another material"
            )
        assert self.ultimate_strength is not None
        ratio = found / self.ultimate_strength
        changed: dict[str, object] = {"ultimate_strength": found}
        if self.yield_strength is not None:
            changed["yield_strength"] = self.yield_strength * ratio
        if self.strength_range is not None:
            changed["strength_range"] = tuple(ratio * bound for bound in self.strength_range)
        less = min(ratio, 1.0)  # thinner wire may bear more for long and often, too, but nothing says so
        if self.sustained_stress is not None:
            changed["sustained_stress"] = less * self.sustained_stress
        if self.fatigue is not None:
            changed["fatigue"] = self.fatigue.times(less)
        return self.model_copy(update=changed)

    @property
    def untold(self) -> dict[str, tuple[str, ...]]:
        """What of density, elastic constants and strengths ``sources`` and ``status`` leave out, by these names."""
        stated = [entry for entry in TOLD if getattr(self, entry) is not None]
        told: dict[str, Collection[str]] = {"sources": self.sources, "status": self.status}
        left = {where: tuple(entry for entry in stated if entry not in known) for where, known in told.items()}
        return {where: entries for where, entries in left.items() if entries}

    @property
    def allowable(self) -> float:
        """The strength that the safety factor uses [MPa]."""
        value = self.yield_strength if self.strength == "yield" else self.ultimate_strength
        assert value is not None
        return value

    @property
    def brittle(self) -> bool:
        """True where the largest principal stress is set against the ultimate strength."""
        return self.strength == "ultimate"

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [MPa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))


def stress_measure(*, brittle: bool) -> str:
    """Return the name of the stress that a strength is set against.

    Parameters
    ----------
    brittle : bool
        As ``Material.brittle``.

    Returns
    -------
    str
        Its name in words.
    """
    return "largest principal" if brittle else "von Mises"


def library_text() -> str:
    """Return the text of the library, ``geometry/materials/materials.toml``."""
    return files("alula.geometry.materials").joinpath("materials.toml").read_text(encoding="utf-8")


@cache
def library() -> dict[str, Material]:
    """Return the materials that alula ships (``geometry/materials/materials.toml``), by name."""
    return {name: Material.model_validate(card) for name, card in tomllib.loads(library_text()).items()}
