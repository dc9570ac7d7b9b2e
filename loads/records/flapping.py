"""Wings as plates that flap in air, and the air that a load case has for them.

A plate that beats with its face across its own motion has a force normal to it: ½ ρ C_N v² per area, and the inertia
of the air that it takes along. C_N is not well known, so a load case states its range as well:

* 1.17 to 1.98 for plates that stand still in a stream across them, from square ones to long ones (Matthews,
  Aeronautical Engineer's Data Book, fig. 5.13b);
* 3.46 for a model of a fly's wing that revolves across its motion (Dickinson, Lehmann and Sane, Science 284, 1999,
  1954-1960: C_D = 1.92 - 1.55 cos(2.04 α - 9.82°) at α = 90°);
* 8 K^(-1/3) for long plates that swing to and fro by less than some two chords, K = 2 π swing / chord (Graham, Journal
  of Fluid Mechanics 97, 1980, 331-346).
"""

from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Density, Length, as_text

LARGEST_NORMAL_COEFFICIENT = 8.0
"""Above this a coefficient is refused: by Graham's law that of a plate that swings by a sixth of its chord."""
DENSITIES = (0.05e-12, 10e-12)
"""Densities of gases that may be air [tonne/mm³]: from air at 25 km height to some eight times that at sea level."""
WIDEST = 2.0
"""Mean chord over span above which strips along the span describe no wing."""
VISCOSITY = 1.8e-11
"""Dynamic viscosity of air near 20 °C [MPa s] (1.8e-5 Pa s), for the Reynolds number alone."""


def _both_ends(stated: object) -> object:
    return (stated, stated) if isinstance(stated, str) else stated


_CHORD = {"type": "string", "format": "length", "examples": ["60 mm"]}
Chord = Annotated[
    tuple[Annotated[Length, NOT_NEGATIVE], Annotated[Length, NOT_NEGATIVE]],
    BeforeValidator(_both_ends),
    WithJsonSchema({"anyOf": [_CHORD, {"type": "array", "items": _CHORD, "minItems": 2, "maxItems": 2}]}),
]


class Wing(CaseModel):
    """A plate that a link carries through the air: its span along the link's x axis, its chord across the plane."""

    link: Name
    """The link that carries it."""
    start: Name | None = None
    """The point at which its span begins; its forces are spread along the link from there to ``end``."""
    end: Name | None = None
    """The point at which its span ends."""
    at: Name | None = None
    """In place of both: the point at which the wing is held, through which all its forces enter the link."""
    span: tuple[Length, Length] | None = None
    """Of a wing that is held at a point: where its span begins and ends, along the link's x axis."""
    chord: Chord
    """Its width across the plane of the linkage: one length, or one at either end of the span and linear between."""

    @model_validator(mode="after")
    def _fits(self) -> "Wing":
        held = self.at is not None and self.span is not None
        spread = self.start is not None and self.end is not None
        if held == spread or len(self.model_fields_set & {"start", "end", "at", "span"}) != 2:
            raise refusal(
                "state either start and end, two points of the link, or at, a point, and span, such as "
                '["6 mm", "66 mm"]'
            )
        if self.span is not None and self.span[0] == self.span[1]:
            raise refusal("its span begins and ends at the same station; state two different ones")
        if not any(self.chord):
            raise refusal("its chord is zero at both ends; state one that is not")
        return self


class Flapping(CaseModel):
    """The air in which wings flap: quasi-steady normal force and added mass, strip by strip."""

    density: Annotated[Density, POSITIVE]
    """Density of the air."""
    normal_coefficient: Annotated[float, Field(gt=0)]
    """C_N: normal force over ½ ρ v² and area, where v is the strip's speed across its face."""
    normal_coefficient_range: tuple[Annotated[float, Field(gt=0)], Annotated[float, Field(gt=0)]] | None = None
    """Least and largest C_N that may be; the bands of all that the load case does hold it. 1.2 to 2 for plates in a
    steady stream, 3.5 for wings that revolve, more for those that swing by less than two chords."""
    added_mass: bool = True
    """True: the inertia of the air beside the plates, ρ π chord² / 4 per length, acts as well."""

    @property
    def ends(self) -> tuple[float, float]:
        """Least and largest C_N."""
        return self.normal_coefficient_range or (self.normal_coefficient, self.normal_coefficient)


def check_flapping(air: Flapping, entry: str) -> None:
    """Check that the air of a load case is plausible.

    Parameters
    ----------
    air : Flapping
    entry : str
        Its path in the case file, for messages.

    Raises
    ------
    CaseError
        For a range without its value, a coefficient that no plate has, and a density that air does not have.
    """
    low, high = air.ends
    if not low <= air.normal_coefficient <= high:
        raise CaseError(
            f"{entry}.normal_coefficient_range: it goes from {low:g} to {high:g}, but normal_coefficient is "
            f"{air.normal_coefficient:g}; state the least and the largest coefficient about it"
        )
    if high > LARGEST_NORMAL_COEFFICIENT:
        name = "normal_coefficient" if air.normal_coefficient_range is None else "normal_coefficient_range"
        raise CaseError(
            f"{entry}.{name}: it reaches {high:g}, but the largest plausible one is {LARGEST_NORMAL_COEFFICIENT:g} "
            "(plates in a steady stream: 1.2 to 2; wings that revolve: 3.5); correct it"
        )
    if not DENSITIES[0] <= air.density <= DENSITIES[1]:
        raise CaseError(
            f"{entry}.density: it is {as_text(air.density, 'density')}, but air has about 1.2 kg/m^3; correct the "
            "number or its unit"
        )
