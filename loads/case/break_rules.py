"""Of which links it can be told whether they break: eyes of ductile metals, collapse of ductile links, brittle notches.

Formulas for eyes are of round ones, and not of printed parts. A refusal names the check that judges the link instead.
"""

from collections.abc import Iterator
from contextlib import suppress

from alula.geometry.base.errors import CaseError
from alula.geometry.materials.plausible import is_plastic
from alula.geometry.materials.printable import is_printed, lies_in_layers
from alula.geometry.parts.disc import Disc
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.straight import Straight
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import BTH_1, EyeCheck, NotchCheck, PlasticCollapseCheck
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import reason

BreakCheck = PlasticCollapseCheck | NotchCheck


def break_links(case: CoreCase, check: BreakCheck) -> tuple[str, ...]:
    """Return the links that a check judges: those that it names, else all of such materials as it is for.

    Parameters
    ----------
    case : CoreCase
    check : PlasticCollapseCheck or NotchCheck

    Returns
    -------
    tuple of str
    """
    if check.links:
        return check.links
    notches = isinstance(check, NotchCheck)
    return tuple(
        link for link in case.checked_links if not (_unlike_brittle if notches else unlike_ductile)(case, link)
    )


def check_break_check(case: CoreCase, name: str, check: BreakCheck) -> None:
    """Check that a check of plastic collapse or notches asks for what can be told.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : PlasticCollapseCheck or NotchCheck

    Raises
    ------
    CaseError
        For a link of another material, also where no link is of one that it is for, and for a card without the data.
    """
    for link in break_links(case, check) or case.checked_links:
        (_check_notched if isinstance(check, NotchCheck) else _check_ductile)(case, name, link)


def unlike_ductile(case: CoreCase, link: str) -> str:
    """Return why a link has no plastic collapse.

    Parameters
    ----------
    case : CoreCase
    link : str

    Returns
    -------
    str
        "" of one that flows before it breaks, alike in all directions.
    """
    part = case.part_of(link)
    material = case.all_materials[part.material]
    if material.brittle:
        return f"'{part.material}' is brittle: it breaks where its stress is largest, before it flows"
    if lies_in_layers(part, material):
        return "it is printed in layers, which come apart before it flows"
    return ""


def _unlike_brittle(case: CoreCase, link: str) -> bool:
    return not case.all_materials[case.part_of(link).material].brittle


def _check_ductile(case: CoreCase, name: str, link: str) -> None:
    if why := unlike_ductile(case, link):
        others = any(not unlike_ductile(case, other) for other in case.checked_links)
        raise CaseError(
            f"checks.{name}: link '{link}' has no plastic collapse, since {why}; check its safety factor, and "
            f"{'name the other links in links' if others else 'leave this check out'}"
        )


def _check_notched(case: CoreCase, name: str, link: str) -> None:
    """Check that a card tells how a link bears notches, and that its layers are judged by themselves."""
    part = case.part_of(link)
    material = case.all_materials[part.material]
    entry = f"checks.{name}.links"
    if not material.brittle:
        others = any(not _unlike_brittle(case, other) for other in case.checked_links)
        raise CaseError(
            f"{entry}: '{part.material}', the material of link '{link}', yields at a notch before it breaks; "
            f"{'name the brittle links alone' if others else 'leave this check out'}"
        )
    if material.inherent_strength is None and material.weibull_modulus is None:
        raise CaseError(
            f"materials.{part.material}: it tells nothing of notches, which '{entry}' asks for in link '{link}'; state "
            "inherent_strength with fracture_toughness or critical_distance, or weibull_modulus with weibull_volume"
        )
    if material.strength_across_layers is not None and part.build_direction is None:
        raise CaseError(
            f"parts.{case.links[link].part}.build_direction: it is missing, and '{entry}' judges notches of link "
            f"'{link}' along its layers alone; state how the part is built"
        )


def check_eye_check(case: CoreCase, name: str, check: EyeCheck) -> None:
    """Check that a check of eyes asks for what its formulas hold for.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the check.
    check : EyeCheck

    Raises
    ------
    CaseError
        For a link of another material or shape, for one without pins, and for a card without the strength.
    """
    entry = f"checks.{name}"
    if not case.checked_links:
        raise CaseError(f"{entry}: no link has a part, so there are no eyes; give a link a part")
    for link in eye_links(case, check) or case.checked_links:
        _check_kind(case, entry, link)
        _check_shape(case, entry, link)
        _check_strength(case, entry, check, link)


def eye_links(case: CoreCase, check: EyeCheck) -> tuple[str, ...]:
    """Return the links whose eyes a check judges: those that it names, else all for which the formulas are.

    Parameters
    ----------
    case : CoreCase
    check : EyeCheck

    Returns
    -------
    tuple of str
    """
    if check.links:
        return check.links
    found = []
    for link in case.checked_links:
        with suppress(CaseError):
            _check_kind(case, "", link)
            _check_shape(case, "", link)
            found.append(link)
    return tuple(found)


def eye_caveats(case: CoreCase) -> Iterator[Caveat]:
    """Yield the links that a check of all eyes leaves out, since its formulas are not for them.

    Parameters
    ----------
    case : CoreCase

    Yields
    ------
    Caveat
    """
    checks = [check for check in case.checks.values() if isinstance(check, EyeCheck)]
    judged = {link for check in checks for link in eye_links(case, check)}
    left = [link for link in case.checked_links if link not in judged]
    if left and any(not check.links for check in checks):
        yield Caveat(topic=Topic.STRESS, what=reason("eyes_of", links=left), why=reason("no_formula_for_eyes"))


def _check_kind(case: CoreCase, entry: str, link: str) -> None:
    part = case.part_of(link)
    card, material = part.material, case.all_materials[part.material]
    layers = lies_in_layers(part, material)
    printed = layers or is_printed(material)
    if printed or material.brittle or is_plastic(card, material):
        what = "printed" if printed else "brittle" if material.brittle else "a plastic"
        how = (
            'a check of type "safety-factor", which sets tension across its layers and shear along them against theirs'
            if layers
            else 'a check of type "safety-factor", since it breaks at its peak of stress'
            if material.brittle
            else 'a check of type "plastic-collapse"'
        )
        raise CaseError(
            f"{entry}.links: the formulas for eyes are those of ductile metals, but link '{link}' is of '{card}', "
            f"which is {what}; name the other links alone, and judge its eyes by {how}"
        )


def _check_strength(case: CoreCase, entry: str, check: EyeCheck, link: str) -> None:
    card = case.part_of(link).material
    material = case.all_materials[card]
    if check.standard == BTH_1 and material.ultimate_strength is None:
        raise CaseError(
            f"materials.{card}.ultimate_strength: it is missing, and '{entry}' sets the eyes of link '{link}' against "
            'it; state it, or take the formulas against yield by standard = "EN 1993-1-8"'
        )


def _check_shape(case: CoreCase, entry: str, link: str) -> None:
    part = case.part_of(link)
    points = [case.linkage.point_of(name, link) for name in case.pinned_joints if link in case.joints[name].links]
    if not points:
        raise CaseError(f"{entry}.links: no pin turns in link '{link}', so it has no eye; name the other links alone")
    if not isinstance(part, Straight | Plate | Disc):
        raise CaseError(
            f"{entry}.links: the formulas for eyes are those of round eyes, but part '{case.links[link].part}' of link "
            f"'{link}' is a file, in which no eye is known; name the other links alone, and judge its eyes by a check "
            'of type "plastic-collapse"'
        )
    body = case.body(link)
    for point in points:
        if body.ring(body.pin(point)).diameter == 0.0:
            raise CaseError(
                f"{entry}.links: the pin at {point} goes through the walls of link '{link}', which has no eye there; "
                "name the other links alone"
            )
