"""Of which links the modes of eyes can be told: formulas are of round eyes, of ductile metals that are not printed.

A refusal names the check that judges the link instead.
"""

from collections.abc import Iterator
from contextlib import suppress

from alula.geometry.base.errors import CaseError
from alula.geometry.materials.plausible import is_plastic
from alula.geometry.materials.printable import is_printed
from alula.geometry.parts.disc import Disc
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.straight import Straight
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import BTH_1, EyeCheck
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import reason


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
    printed = part.build_direction is not None or is_printed(material)
    if printed or material.brittle or is_plastic(card, material):
        layers = material.strength_across_layers is not None or part.build_direction is not None
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
