"""What is not known at the stated temperature: outcomes that need a strength or a modulus that no card tells."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from alula.fea.asked.asked import asked_of, cards_of
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.geometry.base.errors import CaseError
from alula.geometry.materials.temperature import ROOM
from alula.loads.case.case import Case
from alula.loads.records.check_spec import ConnectionCheck, PinCheck
from alula.loads.records.conditions import modulus_unknown, strength_unknown
from alula.loads.records.connection import Bond, Press
from alula.loads.text.caveat import Caveat, Topic

STRENGTH = (
    Quantity.SAFETY_FACTOR,
    Quantity.LAYERS,
    Quantity.EYES,
    Quantity.WALLS,
    Quantity.LINE_CONTACT,
    Quantity.CONNECTION,
    Quantity.SUSTAINED_STRESS,
    Quantity.PLASTIC_COLLAPSE,
    Quantity.PERMANENT_SET,
    Quantity.NOTCHES,
    Quantity.FATIGUE_STRESS,
    Quantity.FATIGUE_LIFE,
)
"""Quantities that set a stress against a strength."""
STIFFNESS = (
    Quantity.DEFLECTION,
    Quantity.DISPLACEMENT,
    Quantity.BUCKLING_FACTOR,
    Quantity.WALLS,
    Quantity.LOAD_SHARE,
    Quantity.LIMIT_LOAD,
    Quantity.PERMANENT_SET,
    Quantity.LAYER_GAP,
    Quantity.FREQUENCY_RATIO,
)
"""Quantities that go with the moduli of the links."""


def as_known(case: Case, outcomes: Iterable[CheckOutcome], *, stiff: bool = True) -> Iterator[CheckOutcome]:
    """Yield outcomes; undecided and without a number where the stated temperature leaves strength or modulus open.

    Parameters
    ----------
    case : Case
    outcomes : iterable of CheckOutcome
        By what cards tell; what they do not tell is as at room temperature.
    stiff : bool, optional
        True where forces are those of the undeformed linkage by equilibrium, so that stress needs no modulus.

    Yields
    ------
    CheckOutcome
    """
    soft = stiffness_unknown(case)
    for outcome in outcomes:
        reason = _strength_unknown(case, outcome) if outcome.quantity in STRENGTH else ""
        if outcome.quantity in STIFFNESS or (outcome.quantity in STRENGTH and not stiff):
            reason = reason or soft
        bears = outcome.applies and outcome.value.low != float("inf")
        yield replace(outcome, value=Band.unknown(reason)).left_open(reason) if reason and bears else outcome


def stiffness_unknown(case: Case) -> str:
    """Return why the stiffness of a link is not known at the stated temperature.

    Parameters
    ----------
    case : Case

    Returns
    -------
    str
        Of the first such link; "" where all are known.
    """
    cards = [case.all_materials[case.part_of(link).material] for link in case.checked_links]
    return next(filter(None, (modulus_unknown(card, case.conditions) for card in cards)), "")


def require_stiffness(case: Case) -> None:
    """Refuse a case whose links' stiffness is not known at the stated temperature, where no verdict could say so.

    Parameters
    ----------
    case : Case

    Raises
    ------
    CaseError
    """
    if why := stiffness_unknown(case):
        raise CaseError(f"conditions.temperature: {why}")


def _strength_unknown(case: Case, outcome: CheckOutcome) -> str:
    """Say why no strength is known for an outcome; "" where one is, and of pins whose card has no table (a caveat)."""
    check = case.all_checks.get(outcome.name)
    names = cards_of(case, check, outcome.subject)
    if isinstance(check, PinCheck) and not case.all_materials[names[0]].temperature_factors:
        return ""
    return next(filter(None, (strength_unknown(case.all_materials[name], case.conditions) for name in names)), "")


def as_if_cold(case: Case) -> Iterator[Reason]:
    """Yield a reason for each property of links that numbers have as at room temperature, for a warning.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Reason
    """
    for name in dict.fromkeys(case.part_of(link).material for link in case.checked_links):
        for unknown in (strength_unknown, modulus_unknown):
            if why := unknown(case.all_materials[name], case.conditions):
                yield reason("as_at_room_temperature", why=why)


def temperature_caveats(case: Case) -> Iterator[Caveat]:
    """Yield thermal expansion, and what checks judge that nothing tells of the stated temperature: pins, glue, grips.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    stated = case.conditions.temperature
    if stated is not None and not ROOM[0] <= stated <= ROOM[1]:
        why = reason("sizes_as_stated", temperature=stated)
        yield Caveat(topic=Topic.TEMPERATURE, what=reason("thermal_expansion"), why=why)
    used = dict.fromkeys(case.joints[joint].pin_material for joint in asked_of(case, PinCheck))
    left = [
        name
        for name in used
        if not case.all_materials[name].temperature_factors
        and strength_unknown(case.all_materials[name], case.conditions)
    ]
    if left:
        yield Caveat(
            topic=Topic.TEMPERATURE,
            what=reason("pins_at_temperature", temperature=case.conditions.temperature),
            why=reason("no_temperature_factors", materials=left),
        )
    checks = {name: check for name, check in case.checks.items() if isinstance(check, ConnectionCheck)}
    held = [name for name, check in checks.items() if isinstance(check.way, Bond | Press)]
    if stated is not None and held:
        yield Caveat(
            topic=Topic.TEMPERATURE,
            what=reason("connections_at_temperature", temperature=stated),
            why=reason("as_connection_states", checks=held),
        )
