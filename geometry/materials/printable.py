"""What parts of all kinds, built or imported, state of how they were printed, and what cards tell of printing."""

import re

from alula.geometry.base.model import CaseModel, Direction
from alula.geometry.materials.material import Material

_PRINTED = frozenset(
    ("printed", "printer", "print", "filament", "fdm", "fff", "sla", "sls", "mjf", "dmls", "slm", "resin", "sintered")
)
_OTHERWISE = frozenset(
    ("steel", "aluminium", "aluminum", "brass", "bronze", "copper", "titanium", "magnesium", "iron", "pvc")
)
"""Materials that are rolled, drawn, cast or extruded, where nothing says that they were printed."""


class Printable(CaseModel):
    """A part that may have been printed in layers."""

    build_direction: Direction | None = None
    """Of a printed part: normal of its layers, in its link's frame (x along the link, z along the pins). Where the
    material's card has the strength across layers, tension normal to them and shear along them are checked; left out,
    the safety factor holds the weakest direction."""


def is_printed(material: Material) -> bool:
    """Return whether a card says that its material is printed, by what it knows or by its title.

    Parameters
    ----------
    material : Material

    Returns
    -------
    bool
    """
    return material.strength_across_layers is not None or bool(_PRINTED & _words(material))


def is_solid_stock(material: Material) -> bool:
    """Return whether a card is of a material that has no layers: a metal or PVC, of which nothing says it is printed.

    Parameters
    ----------
    material : Material

    Returns
    -------
    bool
    """
    return not is_printed(material) and bool(_OTHERWISE & _words(material))


def lies_in_layers(part: Printable, material: Material) -> bool:
    """Return whether a part is printed in layers that count, whatever it is printed of.

    Parameters
    ----------
    part : Printable
    material : Material

    Returns
    -------
    bool
        True by the card's strength across layers; by the part's direction of building, unless the material has none.
    """
    stated = part.build_direction is not None and not is_solid_stock(material)
    return stated or material.strength_across_layers is not None


def _words(material: Material) -> frozenset[str]:
    return frozenset(re.findall(r"[a-z]+", material.title.lower()))
