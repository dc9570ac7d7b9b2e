"""Whether the values of a material card are usual for what it is: a slip of a unit is a factor of ten or a thousand.

Name or title say what it is; where neither does, it is bounded loosely by whether it is light or heavy. The ranges are
those of Ashby, Materials Selection in Mechanical Design, 4th ed., appendix A, rounded outwards, and wider for wire,
printed parts and plastics filled with metal (assumed).
"""

import re
from dataclasses import dataclass

from alula.geometry.materials.material import Material

Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class MaterialClass:
    """Usual values of a class of materials.

    Attributes
    ----------
    title : str
        Name of the class, with its article.
    words : tuple of str
        Of which one begins a word of a material's name or title; one of up to four letters is the whole word.
    density : tuple of float
        Least and greatest [kg/m³].
    modulus : tuple of float
        Least and greatest of Young's modulus [GPa].
    strength : tuple of float
        Least and greatest, of yield or ultimate strength [MPa].
    """

    title: str
    words: tuple[str, ...]
    density: Range
    modulus: Range
    strength: Range


DECIDING = (
    MaterialClass(
        title="a filled or fibre-reinforced plastic",
        words=("fibre", "fiber", "filled", "reinforced", "laminate", "cfrp", "gfrp"),
        density=(1000, 4200),
        modulus=(1, 400),
        strength=(10, 4000),
    ),
    MaterialClass(title="a foam", words=("foam", "honeycomb"), density=(10, 1500), modulus=(1e-4, 20),
                  strength=(0.01, 100)),
    MaterialClass(
        title="a ceramic",
        words=("ceramic", "oxide", "nitride", "carbide", "alumina", "zirconia", "porcelain"),
        density=(1800, 16000),
        modulus=(40, 800),
        strength=(10, 7000),
    ),
    MaterialClass(title="a bronze or brass", words=("bronze", "brass"), density=(7300, 9000), modulus=(80, 160),
                  strength=(30, 1500)),
)  # fmt: skip
"""A word of these decides: aluminium oxide is a ceramic, and aluminium bronze a bronze."""
CLASSES = (
    MaterialClass(title="steel", words=("steel",), density=(7500, 8200), modulus=(180, 220), strength=(100, 3500)),
    MaterialClass(
        title="an aluminium alloy",
        words=("aluminium", "aluminum", "alu"),
        density=(2500, 2900),
        modulus=(65, 85),
        strength=(20, 800),
    ),
    MaterialClass(
        title="a titanium alloy", words=("titan",), density=(4300, 4900), modulus=(85, 130), strength=(150, 1700)
    ),
    MaterialClass(title="copper", words=("copper",), density=(7300, 9000), modulus=(80, 160), strength=(30, 1500)),
    MaterialClass(
        title="a magnesium alloy", words=("magnes",), density=(1700, 2000), modulus=(40, 50), strength=(50, 500)
    ),
    MaterialClass(
        title="a plastic",
        words=("pvc", "pla", "abs", "pom", "peek", "petg", "ptfe", "nylon", "polya", "polyc", "polye", "polyl", "polyp",
               "acetal", "resin", "epoxy", "plastic", "hdpe"),
        density=(850, 2300),
        modulus=(0.1, 6),
        strength=(5, 200),
    ),
)  # fmt: skip
"""Of these the first that is named counts: aluminium magnesium alloy is aluminium."""
PLASTIC, FILLED = CLASSES[-1], DECIDING[0]
STRENGTHS = ("yield_strength", "ultimate_strength", "strength_across_layers", "shear_strength_between_layers")
FILLERS = ("glass", "carbon")
"""Make a plastic a filled one; carbon steel is steel."""
LIGHT = MaterialClass(
    title="a material lighter than 2300 kg/m³", words=(), density=(20, 2300), modulus=(0.001, 400), strength=(0.1, 4000)
)
HEAVY = MaterialClass(
    title="a material heavier than 2300 kg/m³", words=(), density=(2300, 23000), modulus=(10, 1100), strength=(5, 6000)
)


def class_of(name: str, material: Material) -> MaterialClass:
    """Return the class that name or title tell, else that of its density.

    Parameters
    ----------
    name : str
        Name of the material's card.
    material : Material
        The card.

    Returns
    -------
    MaterialClass
        One of ``DECIDING``, else the first of ``CLASSES`` that is named.
    """
    told = re.findall(r"[a-z]+", f"{name} {material.title}".lower())
    for known in DECIDING:
        if any(_names(token, known) for token in told):
            return known
    for token in told:
        for known in CLASSES:
            if _names(token, known):
                return FILLED if known is PLASTIC and set(FILLERS) & set(told) else known
    return LIGHT if material.density * 1e12 < LIGHT.density[1] else HEAVY


def _names(token: str, known: MaterialClass) -> bool:
    return any(token == word if len(word) <= 4 else token.startswith(word) for word in known.words)


def unusual(name: str, material: Material) -> tuple[str, ...]:
    """Return one sentence for each value of a card that is unusual for its class.

    Parameters
    ----------
    name : str
        Name of the material's card.
    material : Material
        The card.

    Returns
    -------
    tuple of str
        Sentences for a warning.
    """
    usual = class_of(name, material)
    values = (
        ("density", 1e12 * material.density, usual.density, "kg/m³"),
        ("youngs_modulus", 1e-3 * material.youngs_modulus, usual.modulus, "GPa"),
        *((entry, getattr(material, entry), usual.strength, "MPa") for entry in STRENGTHS),
    )
    return tuple(
        f"materials.{name}.{entry} is {value:.4g} {unit}, but {usual.title} usually has {least:g} to {most:g} {unit}; "
        "check the value and its unit"
        for entry, value, (least, most), unit in values
        if value is not None and not least <= value <= most
    )


def untold(name: str, material: Material) -> tuple[str, ...]:
    """Return the sentence that lists all values of a card without source or status.

    Parameters
    ----------
    name : str
        Name of the material's card.
    material : Material
        The card.

    Returns
    -------
    tuple of str
        One sentence for a warning, or none.
    """
    left = material.untold
    example = {"sources": '"data sheet of its maker"', "status": '"datasheet"'}
    line = " and ".join(f"{where}.{entries[0]} = {example[where]}" for where, entries in left.items())
    if len({*left.values()}) == 1:
        left = {" and ".join(left): next(iter(left.values()))}
    lists = " and ".join(f"{where} of {', '.join(entries)}" for where, entries in left.items())
    said = f"materials.{name} does not state {lists}; write under [materials.{name}] for example {line}"
    return (said,) if lists else ()


def is_plastic(name: str, material: Material) -> bool:
    """Return whether a material creeps and may be printed: a plastic, or what is light.

    Parameters
    ----------
    name : str
        Name of the material's card.
    material : Material
        The card.

    Returns
    -------
    bool
    """
    return class_of(name, material) in (PLASTIC, FILLED, LIGHT)
