"""Which materials are of one family: polymers, light alloys and heavy metals differ in density by more than a factor.

In charts of strength over density (Ashby, Materials Selection in Mechanical Design, 5th ed., 2017, chapter 3) each
family lies in a narrow range of density, while strengths of all of them overlap.
"""

from collections.abc import Mapping

from alula.geometry.materials.material import Material

ALIKE = 2.0
"""Largest ratio of the densities of one family; on our cards polymers have 0.93 to 1.45, light alloys 2.7 to 2.8, heavy
metals 7.8 to 8.5 g/cm³."""


def most_of_family(every: Mapping[str, Material], card: Material, entry: str) -> float:
    """Return the largest value that a material of a card's family has.

    Parameters
    ----------
    every : mapping of str to Material
        All cards, by name.
    card : Material
        Of the family, itself among its members.
    entry : str
        Of a card, such as ``"yield_strength"``.

    Returns
    -------
    float
        In the unit of the entry; 0 where no member states it.
    """
    family = [
        one for one in (card, *every.values()) if max(one.density / card.density, card.density / one.density) <= ALIKE
    ]
    return max((value for one in family if (value := getattr(one, entry)) is not None), default=0.0)
