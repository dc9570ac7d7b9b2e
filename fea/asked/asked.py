"""Which checks of a case ask for what: the one place that selects them, and that makes an outcome of a band.

A check asks for a quantity of one or several subjects, each against its limit, whatever the context: a pose, a motion,
samples. A context says how the band of a quantity comes about there, and ``Asked`` decides.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.fea.common.verdict import LINKAGE, SIZES, CheckOutcome, Quantity, Sense, Subject
from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.materials.material import Material
from alula.loads.case.break_rules import break_links, eye_links
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import cards_of_connection
from alula.loads.records.check_spec import (
    BearingCheck,
    ClearanceCheck,
    ConnectionCheck,
    DisplacementCheck,
    EyeCheck,
    FrequencyCheck,
    LineContactCheck,
    MassCheck,
    NotchCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    SizeCheck,
    SustainedCheck,
)

GRAMS = 1e6
"""In a tonne."""
K = TypeVar("K", bound=CaseModel)


@dataclass(frozen=True, kw_only=True)
class Asked:
    """One quantity of one subject that is held against a limit.

    Attributes
    ----------
    name : str
        Of the check.
    subject : Subject
    quantity : Quantity
    limit : float
        In the unit of the quantity.
    check : CaseModel or None
        As the case states it; None of what is checked without being asked.
    """

    name: str
    subject: Subject
    quantity: Quantity
    limit: float
    check: CaseModel | None = None

    def outcome(self, load_case: str, value: Band, why: Reason | str = "") -> CheckOutcome:
        """Decide on the whole band.

        Parameters
        ----------
        load_case : str
            Its name.
        value : Band
            Of the quantity: in a pose, or the worst over a motion.
        why : Reason or str, optional
            By default where the band lies beside the limit.

        Returns
        -------
        CheckOutcome
        """
        return CheckOutcome.of(self.name, self.subject, load_case, self.quantity, value, self.limit, why)

    def for_all(self, case: Case, value: Band, why: Reason | str = "") -> CheckOutcome:
        """Decide on what no load changes, in the name of the first load case.

        Parameters
        ----------
        case : Case
        value, why
            As of ``outcome``.

        Returns
        -------
        CheckOutcome
        """
        return self.outcome(next(iter(case.load_cases)), value, why)


def checks_of(case: Case, kind: type[K]) -> Iterator[tuple[str, K]]:
    """Yield the checks of one kind, stated or not.

    Parameters
    ----------
    case : Case
    kind : type
        Of the entry.

    Yields
    ------
    tuple of (str, CaseModel)
        Name and check.
    """
    yield from ((name, check) for name, check in case.all_checks.items() if isinstance(check, kind))


def asks(case: Case, *kinds: type[CaseModel]) -> bool:
    """Return whether a case has a check of one of some kinds.

    Parameters
    ----------
    case : Case
    *kinds : type
        Of the entries.

    Returns
    -------
    bool
    """
    return any(any(checks_of(case, kind)) for kind in kinds)


def asked(
    case: Case, *kinds: type[CaseModel], quantity: Quantity | None = None, subject: Subject | None = None
) -> Iterator[Asked]:
    """Yield what checks of some kinds ask for, in the order of the checks.

    Parameters
    ----------
    case : Case
    *kinds : type
        Of the entries.
    quantity : Quantity, optional
        The only one that is wanted; by default the one that stands for the kind.
    subject : Subject, optional
        The only one that is wanted; all when left out.

    Yields
    ------
    Asked

    Raises
    ------
    CaseError
        Where neither check nor material states a limit.
    """
    for name, check in case.all_checks.items():
        if isinstance(check, kinds):
            for one in subjects_of(case, name, check):
                if subject in (None, one):
                    for what in _quantities(check, quantity):
                        limit = _limit(case, name, check, one, what)
                        yield Asked(name=name, subject=one, quantity=what, limit=limit, check=check)


def asked_of(case: Case, *kinds: type[CaseModel]) -> tuple[str, ...]:
    """Return the names of all that checks of some kinds are about.

    Parameters
    ----------
    case : Case
    *kinds : type
        Of the entries.

    Returns
    -------
    tuple of str
        Of links or joints, each once.
    """
    checks = [(name, check) for kind in kinds for name, check in checks_of(case, kind)]
    return tuple(dict.fromkeys(one.name for name, check in checks for one in subjects_of(case, name, check)))


def place_of(case: Case, name: str) -> tuple[str, str]:
    """Return the place that a check of displacement is about.

    Parameters
    ----------
    case : Case
    name : str
        Of a check that names a point.

    Returns
    -------
    tuple of (str, str)
        Link and point.
    """
    check = case.all_checks[name]
    assert isinstance(check, DisplacementCheck)
    return case.displaced_point(name, check)


def cards_of(case: Case, check: CaseModel | None, subject: Subject) -> tuple[str, ...]:
    """Return the names of the materials whose strength a check sets against a stress.

    Parameters
    ----------
    case : Case
    check : CaseModel or None
        None where nobody asked for it.
    subject : Subject
        A link, or a joint for its pin.

    Returns
    -------
    tuple of str
        That of the link, or of the pin, of the linkage those of all links; for bearing those of the eyes, for line
        contact those of pin and slot.
    """
    if subject.kind == "link":
        return (case.part_of(subject.name).material,)
    if subject == LINKAGE:
        return tuple(case.part_of(link).material for link in case.checked_links)
    if isinstance(check, ConnectionCheck):
        return cards_of_connection(case, check)
    joint = case.joints[subject.name]
    if isinstance(check, PinCheck):
        return (joint.pin_material,)
    if isinstance(check, LineContactCheck) and joint.slotted is not None:
        return () if check.pressure else (joint.pin_material, case.part_of(joint.slotted).material)
    return tuple(case.part_of(link).material for link in joint.links if link in case.checked_links)


def least_safety_factor(name: str, stated: float | None, material: Material, what: str) -> float:
    """Return the limit on a safety factor: that of the check, else the material's.

    Parameters
    ----------
    name : str
        Of the check.
    stated : float or None
        Its own limit.
    material : Material
    what : str
        What the check is about, for the error.

    Returns
    -------
    float

    Raises
    ------
    CaseError
        Where neither states a limit.
    """
    limit = stated or material.minimum_safety_factor
    if limit is None:
        raise CaseError(f"checks.{name}.minimum: the material of '{what}' has no default; state the limit")
    return limit


def subjects_of(case: Case, name: str, check: CaseModel) -> tuple[Subject, ...]:
    """Return what a check is about: the links or pins that it may name, else the linkage.

    Parameters
    ----------
    case : Case
    name : str
        Of the check, for messages.
    check : CaseModel

    Returns
    -------
    tuple of Subject
    """
    match check:
        case DisplacementCheck(at=str()):
            link, point = case.displaced_point(name, check)
            return (Subject.point(point, link),)
        case EyeCheck():
            return tuple(map(Subject.link, eye_links(case, check)))
        case PlasticCollapseCheck() | NotchCheck():
            return tuple(map(Subject.link, break_links(case, check)))
        case FrequencyCheck():
            return (LINKAGE, *map(Subject.link, check.links or case.checked_links))
        case BearingCheck():
            return tuple(map(Subject.pin, check.joints or case.bearing_joints))
        case LineContactCheck():
            return tuple(map(Subject.pin, check.joints or case.slotted_joints))
        case ConnectionCheck():
            return (Subject.joint(check.joint),)
    stated = vars(check)
    if "links" in stated:
        return tuple(map(Subject.link, stated["links"] or case.checked_links))
    return tuple(map(Subject.pin, stated["joints"] or case.pinned_joints)) if "joints" in stated else (LINKAGE,)


def _quantities(check: CaseModel, wanted: Quantity | None) -> tuple[Quantity, ...]:
    """What a check asks for of each subject; of the gaps between layers only where that is wanted."""
    match check:
        case DisplacementCheck():
            every: tuple[Quantity, ...] = (Quantity.DEFLECTION if check.at is None else Quantity.DISPLACEMENT,)
        case SizeCheck():
            every = SIZES
        case _:
            every = (wanted or Quantity.of_check(str(vars(check)["type"])),)
    return tuple(one for one in every if wanted in (None, one))


def _limit(case: Case, name: str, check: CaseModel, subject: Subject, quantity: Quantity) -> float:
    """Return the limit on a quantity; NaN where only the card could state it, and does not."""
    match check:
        case SafetyFactorCheck():
            return least_safety_factor(name, check.minimum, case.material_of(subject.name), str(subject))
        case PinCheck():
            return least_safety_factor(name, check.minimum, case.pin_material(subject.name), str(subject))
        case SustainedCheck():
            limit = case.material_of(subject.name).sustained_stress
            return math.nan if limit is None else limit
        case BearingCheck():
            return check.limit
        case ClearanceCheck() if quantity is Quantity.LAYER_GAP:
            return 0.0
        case MassCheck():
            return GRAMS * check.maximum
        case SizeCheck():
            return check.maximum[SIZES.index(quantity)]
    return float(getattr(check, "minimum" if quantity.sense is Sense.AT_LEAST else "maximum"))
