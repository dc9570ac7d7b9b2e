"""What lasts or repeats without a check that judges it: creep of plastics, and fatigue of what repeats."""

from collections.abc import Iterator

from alula.fea.asked.asked import asked_of
from alula.fea.common.reason import reason
from alula.geometry.materials.material import Material
from alula.geometry.materials.plausible import is_plastic
from alula.geometry.materials.printable import is_printed
from alula.loads.case.case import Case
from alula.loads.records.check_spec import FatigueCheck, SustainedCheck
from alula.loads.text.caveat import Caveat, Topic


def creep_caveats(case: Case) -> Iterator[Caveat]:
    """Yield the creep of plastics under loads that stay: for the stated duration, or where the linkage stands still.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    creeping = [x for x in case.checked_links if _is_plastic(case.part_of(x).material, case.material_of(x))]
    stays = any(one.speed == 0.0 for one in case.load_cases.values())
    if case.conditions.duration is not None:
        judged = asked_of(case, SustainedCheck)
        if left := [link for link in creeping if link not in judged]:
            yield Caveat(topic=Topic.CREEP, what=reason("creep_of", links=left), why=reason("no_check"))
    elif creeping and stays:
        yield Caveat(topic=Topic.CREEP, what=reason("creep"), why=reason("no_duration"))


def fatigue_caveats(case: Case, *, over_motion: bool) -> Iterator[Caveat]:
    """Yield the fatigue of what a speed of the drive repeats, or the conditions, as far as no check judges it.

    Parameters
    ----------
    case : Case
    over_motion : bool
        True where stress is followed over the motion, so that fatigue is judged of materials that have data.

    Yields
    ------
    Caveat
    """
    moving, cycles = any(one.speed != 0.0 for one in case.load_cases.values()), case.conditions.cycles
    if not case.checked_links or not (moving or cycles is not None):
        return
    alone = not any(one.blocks for one in case.load_cases.values())  # states of a profile are followed together
    if cycles is not None and len(case.load_cases) > 1 and alone:
        yield Caveat(topic=Topic.FATIGUE, what=reason("fatigue_of_load_cases"), why=reason("each_comes_and_goes_alone"))
    if not over_motion:
        judged = asked_of(case, FatigueCheck)
        if moving:
            yield Caveat(topic=Topic.FATIGUE, what=reason("fatigue"), why=reason("envelope_follows_motion"))
        elif left := [link for link in case.checked_links if link not in judged]:
            yield Caveat(topic=Topic.FATIGUE, what=reason("fatigue_of", links=left), why=reason("no_check"))
        return
    bare = dict.fromkeys(
        case.part_of(link).material for link in case.checked_links if case.material_of(link).fatigue is None
    )
    if bare:
        yield Caveat(
            topic=Topic.FATIGUE, what=reason("fatigue"), why=reason("no_fatigue_data_of", materials=tuple(bare))
        )


def _is_plastic(name: str, material: Material) -> bool:
    return is_printed(material) or is_plastic(name, material)
