"""Laminates of fibres and wood, whose properties depend on the direction, told by a material's name or title."""

import re

_REFUSED = (
    "is {what}: its stiffness and strength depend on the direction, but a material card has one of each for all "
    "directions; choose an isotropic material, or check this part with a program for {programs}"
)
_ALWAYS = frozenset(("cfrp", "cfk", "gfrp", "gfk", "prepreg"))
_FORMS = frozenset(
    ("fibre", "fiber", "fibres", "fibers", "plate", "sheet", "tube", "rod", "strip", "laminate", "composite", "epoxy",
     "weave", "woven", "twill", "fabric")
)  # fmt: skip
"""What carbon is made into, apart from steel."""
_NO_LAMINATE = frozenset(
    ("steel", "iron", "graphite", "black", "filled", "short", "chopped", "milled", "printed", "sintered", "nylon",
     "polyamide", "pa", "pla", "abs", "petg", "pet", "pc", "polycarbonate", "pp", "pom", "asa")
)  # fmt: skip
"""Words of steels, and of plastics with short fibres."""
_WOODS = frozenset(
    ("wood", "wooden", "timber", "plywood", "spruce", "pine", "fir", "larch", "balsa", "birch", "beech", "oak",
     "poplar", "bamboo", "veneer", "basswood", "lvl", "clt")
)  # fmt: skip


def directional(text: str) -> str | None:
    """Return why a material is refused whose properties depend on the direction: carbon fibre, but not carbon steel.

    Parameters
    ----------
    text : str
        Name or title of a material.

    Returns
    -------
    str or None
        What it is and what to do, to follow its name; None for a material that one card describes.
    """
    plain = re.sub(r"\b(low|medium|mild|high)[- _]carbon\b", "", text.lower())
    words = re.findall(r"[a-z]+", plain.replace("carbonfib", "carbon fib"))
    plastic = bool(_NO_LAMINATE & set(words))
    if _WOODS & set(words) and not plastic:
        return _REFUSED.format(what="wood", programs="timber")
    carbon = "carbon" in words and not plastic and (len(words) == 1 or bool(_FORMS & set(words)))
    return (
        _REFUSED.format(what="a laminate of fibres", programs="laminates") if carbon or _ALWAYS & set(words) else None
    )
