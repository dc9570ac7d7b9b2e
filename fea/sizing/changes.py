"""What would change the verdict: by which factor loads may grow or must fall, which material would do, what to size.

It is told of the one check that the headline names: others may rest on it, as every stress does on a linkage that holds
its load. A number that goes with the loads keeps its limit by a margin (``CheckOutcome.margin``), which is then the
factor on all loads that takes the unfavourable end of its band to the limit, and one over it the factor on strength or
modulus that does the same. That is told where it follows:

* the share of the load that is held, the limit-load factor and the linear buckling factor of a linkage are factors on
  all loads by definition; a frame of linear material has the shape that load over modulus gives it;
* a safety factor is strength over stress, whatever the stress comes from;
* stress, deflection, buckling of a link and motor effort are in proportion to all loads, own weight and inertia among
  them, where the undeformed pose is good enough and no spring acts; displacement and buckling to one over the modulus
  where joint forces follow from equilibrium;
* a natural frequency of a link by itself goes with the root of its modulus, and with no load; that of the linkage holds
  what its joint forces add to its stiffness, so that no factor follows;
* where a band holds what grows faster than the load (``SourceKind.GROWTH``) a load smaller by that factor suffices, and
  a load that may grow may do so by less.

What follows so is tried before it is told (``alula.fea.sizing.tried``), as it is rounded: the check, and all that
passes under its load case, must pass with it. Where it does not, the margin that is left gives the next value,
``TRIES`` in all. No strength is told that no material of the family has, no modulus that none has at all, and no range
of a size in which none was found that passes (``alula.fea.sizing.size_range``).
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from alula.fea.common.change import EXACT, MaterialChange, Property, VerdictChange, rounded
from alula.fea.common.source import SourceKind, widest
from alula.fea.common.verdict import (
    FATIGUE_QUANTITIES,
    LINKAGE,
    MOTOR_QUANTITIES,
    UNLOADED_QUANTITIES,
    CheckOutcome,
    Quantity,
    Verdict,
    deciding,
)
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.nonlinear.stability import LARGE
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.fea.sizing.size_range import size_range
from alula.fea.sizing.tried import Scaled, Trials, goes_with_load
from alula.geometry.materials.family import most_of_family
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.records.check_spec import PinCheck

TRIES = 3
"""Of each load, strength or modulus."""
_CLOSER = 0.99
"""Factor beside the margin that is left, since the path to a limit load is followed in steps."""
_NAMES: Mapping[str, Property] = {"yield": "yield strength", "ultimate": "ultimate strength"}
_ENTRIES: Mapping[Property, str] = {
    "yield strength": "yield_strength",
    "ultimate strength": "ultimate_strength",
    "strength of the layers": "strength_across_layers",
    "sustained strength": "sustained_stress",
    "modulus": "youngs_modulus",
    "all moduli": "youngs_modulus",
}
"""Of a card."""
_BY_DEFINITION = (Quantity.LOAD_SHARE, Quantity.LIMIT_LOAD, Quantity.BUCKLING_FACTOR)


def changes(result: CheckResult) -> tuple[VerdictChange, ...]:
    """Return what would change the verdict of the check that decides it.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of VerdictChange
        Of the check that the headline names; empty where nothing was checked.
    """
    first = deciding(check for case in result.load_cases.values() for check in case.checks)[:1]
    trials = Trials(result=result)
    return tuple(_tried(trials, _change(result, check)) for check in first)


def _tried(trials: Trials, change: VerdictChange) -> VerdictChange:
    """Return a change with what was tried and holds alone."""
    check, material = change.check, change.material
    if change.sizable:
        change = replace(change, size=size_range(trials, check))
    if not goes_with_load(check):
        return change
    load = change.load
    if load is not None:
        load = _held(load, lambda by: trials.share(check, Scaled.loads(rounded(by, up=False))))
    if material is not None and _by_definition(check):  # what holds a share of the loads holds less as well
        needed = math.inf if load is None else material.stated / rounded(load, up=False)
        material = replace(material, needed=needed) if needed <= _most(trials.result.case, material) else None
    elif material is not None:
        stated, name = material.stated, material.material
        stiffer, most = "modul" in material.what, _most(trials.result.case, material)

        def share(by: float) -> float:
            needed = rounded(stated / by, up=True)
            if needed > most:
                return 0.0
            times = needed / stated
            return trials.share(check, Scaled(**{"modulus" if stiffer else "strength": times}, material=name))

        by = _held(stated / material.needed, share)
        material = None if by is None else replace(material, needed=stated / by)
    refuted = (load is None) is not (change.load is None) or (material is None) is not (change.material is None)
    return replace(change, load=load, material=material, refuted=refuted)


def _most(case: Case, change: MaterialChange) -> float:
    """Return the largest strength of a material of that family, or the largest modulus of any."""
    every = case.all_materials
    entry = _ENTRIES[change.what]
    if entry != "youngs_modulus":
        return most_of_family(every, every[change.material], entry)
    most = max(card.youngs_modulus for card in every.values())
    return most if change.material else most / max(case.material_of(link).youngs_modulus for link in case.bending_links)


def _held(first: float, share: Callable[[float], float]) -> float | None:
    """Return the first factor on the load, or on one over a property, with which all limits are kept."""
    factor = first
    for _ in range(TRIES):
        kept = share(factor)
        if kept >= 1.0 - EXACT:
            return factor
        factor *= kept * _CLOSER
        if factor <= 0.0 or (first > 1.0 >= factor):
            return None
    return None


def _change(result: CheckResult, check: CheckOutcome) -> VerdictChange:
    case, load_case = result.case, result.load_cases[check.load_case]
    known = 0.0 < check.margin < math.inf and (check.verdict is not Verdict.UNDECIDED or check.margin < 1.0)
    known = known and not check.value.least_alone
    load = _load(case, load_case, check) if known else None
    width = check.value.high / check.value.low if check.value.low > 0.0 else math.inf
    straddles = check.verdict is Verdict.UNDECIDED and not check.value.unknowable and check.margin < 1.0
    return VerdictChange(
        check=check,
        load=load,
        faster=load is not None and _faster(check),
        until=math.inf if load is None or _by_definition(check) else _linear_until(load_case.large_displacement),
        material=_material(case, load_case, check) if known else None,
        widest=widest(check.value.sources, width) if straddles else (),
        sizable=straddles or _sizable(check),
    )


def _sizable(check: CheckOutcome) -> bool:
    """False of what is open for its reason alone, such as a model that was not run: no other size decides it."""
    return check.verdict is not Verdict.UNDECIDED or check.subject == LINKAGE


def _by_definition(check: CheckOutcome) -> bool:
    """True of a number that is a factor on all loads of the linkage."""
    return check.subject == LINKAGE and check.quantity in _BY_DEFINITION


def _sprung(case: Case) -> bool:
    return case.sprung or case.pose.equilibrium


def _load(case: Case, load_case: LoadCaseResult, check: CheckOutcome) -> float | None:
    """Return the factor on all loads that takes a check to its limit, where it follows."""
    if _sprung(case) or check.quantity in (Quantity.DRIVE_SPEED, *UNLOADED_QUANTITIES):
        return None
    if _by_definition(check) or check.quantity in MOTOR_QUANTITIES:
        return check.margin
    held = load_case.large_displacement.state in ("small", "deformed") and str(check.subject) != case.linkage.ground
    if not held or check.quantity in (*FATIGUE_QUANTITIES, Quantity.PERMANENT_SET):
        return None
    if check.quantity is Quantity.LINE_CONTACT:
        return check.margin**2  # its stress goes with the root of the force
    return None if _loose(check) else check.margin


def _faster(check: CheckOutcome) -> bool:
    """True where a band holds what grows faster than the load."""
    return any(source.kind is SourceKind.GROWTH for source in check.value.sources)


def _loose(check: CheckOutcome) -> bool:
    """True where play of pins, which no load makes less, is part of a displacement."""
    loose = any(source.kind is SourceKind.PLAY for source in check.value.sources)
    return loose and check.quantity is Quantity.DISPLACEMENT


def _linear_until(moved: LargeDisplacement) -> float:
    """Return the factor on the loads from which on equilibrium is sought on the deformed shape."""
    factor, scatter = moved.factor, moved.scatter.high
    far = LARGE * moved.span / (scatter * moved.linear) if moved.linear > 0.0 else math.inf
    return far if factor is None else min(far, factor / moved.linear_from)


def _material(case: Case, load_case: LoadCaseResult, check: CheckOutcome) -> MaterialChange | None:
    """Return the strength or modulus that takes a check to its limit, where it follows."""
    quantity, subject, margin = check.quantity, check.subject, check.margin
    rule = case.all_checks.get(check.name)
    if any(source.kind is SourceKind.BUILD for source in check.value.sources):
        return None  # strengths along the layers and across them share in its ends
    if subject.kind in ("pin", "joint"):
        if not isinstance(rule, PinCheck):
            return None
        joint = subject.name
        pin = case.pin_material(joint)
        return _needed(_NAMES[pin.strength], case.joints[joint].pin_material, pin.allowable, margin)
    if quantity is Quantity.FREQUENCY_RATIO:
        if subject.kind != "link":
            return None  # what the loads make of the links' stiffness does not go with the modulus
        young, card = case.material_of(subject.name).youngs_modulus, case.part_of(subject.name).material
        return _needed("modulus", card, young, margin**2)
    if subject.kind == "link":
        material, name = case.material_of(subject.name), case.part_of(subject.name).material
        stated = _strength(material, quantity)
        if stated is not None:
            return _needed(*stated[:1], name, stated[1], margin)
    elif not (_by_definition(check) or quantity is Quantity.DISPLACEMENT):
        return None
    if _sprung(case) or _loose(check) or quantity not in (*_BY_DEFINITION, Quantity.DISPLACEMENT, Quantity.DEFLECTION):
        return None
    if not _by_definition(check):
        margin = min(margin, _linear_until(load_case.large_displacement))
    if subject.kind != "link":
        follows = _by_definition(check) or load_case.large_displacement.state == "small"
        return _needed("all moduli", "", 1.0, margin) if follows and not _faster(check) else None
    if _faster(check) or _load(case, load_case, check) is None or not load_case.forces.by_equilibrium:
        return None
    return _needed("modulus", case.part_of(subject.name).material, material.youngs_modulus, margin)


def _strength(material: Material, quantity: Quantity) -> tuple[Property, float] | None:
    """Return the strength that a number of a link is in proportion to [MPa]; None where there is none."""
    stated: Mapping[Quantity, tuple[Property, float | None]] = {
        Quantity.SAFETY_FACTOR: (_NAMES[material.strength], material.allowable),
        Quantity.LAYERS: ("strength of the layers", material.strength_across_layers),
        Quantity.SUSTAINED_STRESS: ("sustained strength", material.sustained_stress),
        Quantity.PLASTIC_COLLAPSE: (
            _NAMES[material.strength],
            None if material.hardening_factors else material.allowable,
        ),
    }
    what, value = stated.get(quantity, ("modulus", None))
    return None if value is None else (what, value)


def _needed(what: Property, material: str, stated: float, margin: float) -> MaterialChange:
    return MaterialChange(what=what, material=material, stated=stated, needed=stated / margin)
