"""Laminates of fibres, whose properties depend on the direction, told by a material's name or title."""

import re

ANISOTROPIC = (
    "is a laminate of fibres: its stiffness and strength depend on the direction, but a material card has one of each "
    "for all directions; choose an isotropic material, or check this part with a program for laminates"
)
"""Why a laminate is refused and what to do, after its name."""
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


def is_laminate(text: str) -> bool:
    """Return whether a name or title tells of a laminate: of carbon fibre or CFRP, not of carbon steel.

    Parameters
    ----------
    text : str
        Name or title of a material.

    Returns
    -------
    bool
        True for a laminate.
    """
    plain = re.sub(r"\b(low|medium|mild|high)[- _]carbon\b", "", text.lower())
    words = re.findall(r"[a-z]+", plain.replace("carbonfib", "carbon fib"))
    if _ALWAYS & set(words):
        return True
    return "carbon" in words and not _NO_LAMINATE & set(words) and (len(words) == 1 or bool(_FORMS & set(words)))
