"""What lasts or repeats without a check that judges it: creep of plastics, and fatigue of what repeats."""

from collections.abc import Iterator

from geometry.materials.material import Material
from geometry.materials.plausible import FILLED, PLASTIC, class_of
from geometry.materials.printable import is_printed
from loads.case.case import Case
from loads.records.check_spec import SustainedCheck


def unjudged_creep(case: Case) -> Iterator[tuple[str, str]]:
    """Yield the creep of plastics under loads that stay: for the stated duration, or where the case states no motion.

    Parameters
    ----------
    case : Case

    Yields
    ------
    tuple of 2 str
        What is not judged, and why.
    """
    creeping = [x for x in case.checked_links if _is_plastic(case.part_of(x).material, case.material_of(x))]
    stays = case.motion is None and any(one.speed == 0.0 for one in case.load_cases.values())
    if case.conditions.duration is not None:
        checks = [check for check in case.all_checks.values() if isinstance(check, SustainedCheck)]
        judged = {link for check in checks for link in check.links or case.checked_links}
        if left := [link for link in creeping if link not in judged]:
            yield f"creep of {', '.join(left)}", "no check"
    elif creeping and stays:
        yield "creep under loads that stay", "no conditions.duration"


def unjudged_fatigue(case: Case, *, followed: bool) -> Iterator[tuple[str, str]]:
    """Yield the fatigue of what a speed of the drive repeats.

    Parameters
    ----------
    case : Case
    followed : bool
        True where stress is followed over the motion, so that fatigue is judged of materials that have data.

    Yields
    ------
    tuple of 2 str
        What is not judged, and why.
    """
    if not case.checked_links or all(one.speed == 0.0 for one in case.load_cases.values()):
        return
    if not followed:
        yield "fatigue", "alula envelope follows the motion"
        return
    bare = dict.fromkeys(
        case.part_of(link).material for link in case.checked_links if case.material_of(link).fatigue is None
    )
    if bare:
        yield "fatigue", f"no fatigue data of {', '.join(bare)}"


def _is_plastic(name: str, material: Material) -> bool:
    return is_printed(material) or class_of(name, material) in (PLASTIC, FILLED)
