"""Ways in which a link is fixed to a shaft, a horn or another link, as a check of a connection states one of them."""

import math
from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Force, Length, Stress
from alula.geometry.joints.joint import Coefficient
from alula.geometry.materials.material import Material, Range

Ends = tuple[float, float]


def _rising(value: Ends) -> Ends:
    if value[0] > value[1]:
        raise refusal("the first value of a range must not exceed the second; swap them")
    return value


Size = Annotated[Length, POSITIVE]
LengthRange = Annotated[tuple[Size, Size], AfterValidator(_rising)]
ForceRange = Annotated[tuple[Annotated[Force, POSITIVE], Annotated[Force, POSITIVE]], AfterValidator(_rising)]
Grip = Annotated[Coefficient, Field(gt=0.0)]
FrictionRange = Annotated[tuple[Grip, Grip], AfterValidator(_rising)]


class Bond(CaseModel):
    """Glue: a sleeve about the shaft (``length``), or a ring between two flat faces (``outer_diameter``)."""

    shear_strength: Annotated[Stress, POSITIVE]
    """Shear strength of the cured adhesive, by its data sheet or a lap shear test."""
    shear_strength_range: Range | None = None
    """Its scatter."""
    length: Size | None = None
    """Length of a sleeve along the shaft."""
    outer_diameter: Size | None = None
    """Outer diameter of a glued face across the joint's axis."""
    inner_diameter: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Inner diameter of a glued face."""
    tensile_strength: Annotated[Stress, POSITIVE] | None = None
    """Of a glued face: what it bears of a force or couple that pulls its faces apart, by a butt joint test. Left out,
    a connection with such loads is undecided."""

    @model_validator(mode="after")
    def _one_shape(self) -> "Bond":
        ends = self.shear_strength_range
        if ends and not ends[0] <= self.shear_strength <= ends[1]:
            raise refusal("shear_strength_range leaves out shear_strength; correct one of them")
        if (self.length is None) == (self.outer_diameter is None):
            raise refusal("a bond is a sleeve with a length or a face with an outer_diameter; state one of the two")
        if self.outer_diameter is not None and self.inner_diameter >= self.outer_diameter:
            raise refusal("inner_diameter must be less than outer_diameter; swap them")
        if self.outer_diameter is None and (self.inner_diameter > 0.0 or self.tensile_strength is not None):
            raise refusal("inner_diameter and tensile_strength are of a glued face; leave them out of a sleeve")
        return self


class Press(CaseModel):
    """A press or shrink fit, or a clamp about a shaft: friction under pressure holds it."""

    length: Size
    """Length over which the shaft is gripped."""
    friction: FrictionRange
    """Least and largest coefficient of friction; steel on steel some 0.1 to 0.2."""
    interference: LengthRange | None = None
    """Least and largest excess of the shaft's diameter over its hole's; the pressure follows from the moduli of link
    and shaft."""
    pressure: Range | None = None
    """Least and largest pressure between shaft and hole."""
    clamping_force: ForceRange | None = None
    """Least and largest force of all screws of a split hub together. The band reaches from jaws that touch the shaft
    along two lines to jaws that fit all round."""
    hub_diameter: Size | None = None
    """Outer diameter of the link about the shaft, for an interference."""
    shaft_bore: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Inner diameter of a hollow shaft."""

    @model_validator(mode="after")
    def _one_grip(self) -> "Press":
        stated = [x for x in ("interference", "pressure", "clamping_force") if getattr(self, x) is not None]
        if len(stated) != 1:
            raise refusal(
                f"a press states one of interference, pressure and clamping_force, not {' and '.join(stated) or 'none'}"
                "; keep one"
            )
        if (self.interference is None) != (self.hub_diameter is None):
            raise refusal("interference and hub_diameter make the pressure together; state both, or a pressure")
        return self

    def pressures(self, diameter: float, hub: Material | None, shaft: Material) -> Ends:
        """Return the least and the largest pressure between shaft and hole.

        Parameters
        ----------
        diameter : float
            Of the shaft [mm].
        hub, shaft : Material
            The hub's is needed for an interference alone.

        Returns
        -------
        tuple of 2 float
            [MPa]; of a clamp whose jaws touch along two lines, the even pressure that holds as much.
        """
        if self.pressure is not None:
            return self.pressure
        if self.clamping_force is not None:
            low, high = (force / (diameter * self.length) for force in self.clamping_force)
            return 2.0 / math.pi * low, high
        assert self.interference is not None
        assert self.hub_diameter is not None
        assert hub is not None
        inner = self.shaft_bore / diameter, diameter / self.hub_diameter
        young = [card.youngs_modulus_range or (card.youngs_modulus, card.youngs_modulus) for card in (hub, shaft)]
        ratios = hub.poissons_ratio, shaft.poissons_ratio
        low, high = (
            lame_pressure(excess / diameter, inner, (young[0][end], young[1][end]), ratios)
            for end, excess in enumerate(self.interference)
        )
        return low, high


def lame_pressure(excess: float, inner: Ends, young: Ends, poisson: Ends) -> float:
    """Return the pressure between a shaft and a hub that is too tight for it, both thick cylinders in plane stress.

    Parameters
    ----------
    excess : float
        Of diameters, over the shaft's.
    inner : tuple of 2 float
        Bore of the shaft over its diameter, and that over the hub's outer one.
    young, poisson : tuple of 2 float
        Of hub and shaft [MPa, -].

    Returns
    -------
    float
        [MPa]

    References
    ----------
    Lamé's thick cylinder; ``docs/theory/connections.md`` derives it.
    """
    (bore, hole), (of_hub, of_shaft) = inner, young
    hub = ((1.0 + hole**2) / (1.0 - hole**2) + poisson[0]) / of_hub
    shaft = ((1.0 + bore**2) / (1.0 - bore**2) - poisson[1]) / of_shaft
    return excess / (hub + shaft)


class Flat(CaseModel):
    """A D-shaped shaft in a hole like it: the flat turns the link."""

    length: Size
    """Length of the flat in the link."""
    across: Size
    """Thickness of the shaft across the flat, from it to the round side: 4.5 mm of a shaft of 5 mm, for example."""


class CrossPin(CaseModel):
    """A pin through hub and shaft, across the shaft's axis."""

    diameter: Size
    """Of the pin."""
    material: Name
    """Of the pin."""
    hub_diameter: Size
    """Outer diameter of the link about the shaft."""


class Screws(CaseModel):
    """Screws or pins evenly on a circle about the joint's axis, as in a horn; friction below heads is left out."""

    count: Annotated[int, Field(ge=2, le=100)]
    """How many."""
    circle_diameter: Size
    """Diameter of the circle of their axes."""
    diameter: Size
    """Of the cross-section that shears: the core of a thread in the joint's plane, else the shank."""
    material: Name
    """Of the screws."""
    length: Size
    """Length over which each bears on the link."""


Way = Bond | Press | Flat | CrossPin | Screws
