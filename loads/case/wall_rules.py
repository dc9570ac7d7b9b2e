"""Of which links the buckling of thin walls can be told: tubes, and bars of one section."""

from alula.geometry.base.errors import CaseError
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.tube import Tube
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import WallCheck
from alula.loads.text.explain import require


def check_wall_check(case: CoreCase, name: str, check: WallCheck) -> None:
    """Check that a check of walls asks for links that it has formulas for.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : WallCheck

    Raises
    ------
    CaseError
        For a link of another shape, of varying section, or with a slot.
    """
    for link in check.links:
        require(f"checks.{name}.links", link, case.checked_links, "is no link with a part")
    if not case.checked_links:
        raise CaseError(f"checks.{name}: no link has a part, so nothing buckles; give a link a part")
    for link in check.links or case.checked_links:
        part = case.part_of(link)
        slotted = any(pin.slot > 0.0 for pin in case.body(link).pins)
        if isinstance(part, Tube | Bar) and not (slotted or (isinstance(part, Bar) and part.widths)):
            continue
        what = "has a slot" if slotted else f"is a {part.shape}{' of varying width' if isinstance(part, Bar) else ''}"
        raise CaseError(
            f"checks.{name}.links: its formulas are those of tubes and of bars of one section, but link '{link}' "
            f"{what}; name the other links alone"
        )
