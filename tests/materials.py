"""Cases with a changed material card."""

from geometry.material import Material
from loads.case import Case


def with_material(case: Case, name: str, card: Material) -> Case:
    """Return the case with a card of that name; what the case has cached of the old one is dropped."""
    changed = case.model_copy(update={"materials": {**case.materials, name: card}})
    vars(changed).pop("all_materials", None)
    return changed
