"""Cases with a changed material card."""

from alula.geometry.materials.material import TOLD, Material
from alula.loads.case.case import Case

SOURCED_ENTRIES = tuple(
    f"{where}={{" + ",".join(f'{entry}="{said}"' for entry in TOLD) + "}"
    for where, said in (("sources", "a test"), ("status", "assumed"))
)
SOURCED = ",".join(SOURCED_ENTRIES)
"""Source and status of all that a card needs them for, as TOML."""


def stiff(*, density: str, young: str, strength: str) -> str:
    """Return the card of a material named stiff as TOML."""
    return f"""
[materials.stiff]
title = "stiff"
density = "{density}"
youngs_modulus = "{young}"
poissons_ratio = 0.3
strength = "yield"
yield_strength = "{strength}"
{chr(10).join(SOURCED_ENTRIES)}
"""


def with_material(case: Case, name: str, card: Material) -> Case:
    """Return the case with a card of that name."""
    return case.model_copy(update={"materials": {**case.materials, name: card}})
