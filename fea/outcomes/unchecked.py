"""What no check of a case looks at, and what of its materials is unusual."""

from collections.abc import Sequence

from geometry.materials.plausible import untold, unusual
from loads.case.case import Case
from loads.records.check_spec import MassCheck, PinCheck, SafetyFactorCheck, SizeCheck, SustainedCheck
from loads.states.extent import unmeasured
from loads.states.weighed import unweighed

Strength = type[SafetyFactorCheck] | type[SustainedCheck]


def unchecked(case: Case, strength: Sequence[Strength] = (SafetyFactorCheck, SustainedCheck)) -> tuple[str, ...]:
    """Return what is not checked, each in a few words with the reason: ``thigh (no part)``.

    Parameters
    ----------
    case : Case
    strength : sequence of type
        The kinds of check that set a link's stress against a strength; an envelope knows the first alone.

    Returns
    -------
    tuple of str
    """
    found = [f"{link} (no part)" for link in case.linkage.moving if link not in case.checked_links]
    stressed: set[str] = set()
    pinned: set[str] = set()
    for check in case.all_checks.values():
        if isinstance(check, PinCheck):
            pinned.update(check.joints or case.pinned_joints)
        elif isinstance(check, SafetyFactorCheck | SustainedCheck) and isinstance(check, tuple(strength)):
            stressed.update(check.links or case.checked_links)
        elif isinstance(check, MassCheck) and check.others is None:
            found += [f"mass of {what}" for what in unweighed(case)]
        elif isinstance(check, SizeCheck):
            found += [f"size of {what}" for what in unmeasured(case)]
    left = [link for link in case.checked_links if link not in stressed]
    if left:
        found.append(f"stress of {', '.join(left)} (no check)")
    pins = [name for name, joint in case.joints.items() if joint.type != "slider"]
    loose = [name for name in pins if name not in pinned]
    if loose:
        which = "pins" if loose == pins else f"pin{'s' if len(loose) > 1 else ''} {', '.join(loose)}"
        found.append(f"{which} (no check)")
    return tuple(found)


def unusual_materials(case: Case) -> list[str]:
    """Return a sentence for what is unusual in materials of links and checked pins, and for what lacks a source.

    Parameters
    ----------
    case : Case

    Returns
    -------
    list of str
    """
    used = [case.part_of(link).material for link in case.checked_links]
    for check in case.all_checks.values():
        if isinstance(check, PinCheck):
            used += [case.joints[name].pin_material for name in check.joints or case.pinned_joints]
    cards = {name: case.all_materials[name] for name in dict.fromkeys(used)}
    return [said for name, card in cards.items() for said in (*unusual(name, card), *untold(name, card))]
