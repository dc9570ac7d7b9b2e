"""Whether what is told to change a verdict does so: the case is checked again with it, by hand calculation.

Loads times a factor are moduli and strengths over it: shape, and safety factors, are those under the larger loads.
A number that solids gave is taken as many times as large as hand calculation finds its own at the changed value.
Of a size all checks count, under every load case, since ``alula size`` asks for a pass of all.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from alula.fea.beam.calibration import uncalibrated
from alula.fea.check.run import check_case
from alula.fea.common.verdict import (
    LINKAGE,
    MOTOR_QUANTITIES,
    UNLOADED_QUANTITIES,
    CheckOutcome,
    Quantity,
    Subject,
    Verdict,
)
from alula.fea.outcomes.result import CheckResult, HandResult, LoadCaseResult
from alula.fea.whole.outcomes import KINDS
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.records.check_spec import MotorCheck

MODULI = ("youngs_modulus", "sustained_modulus")
STRENGTHS = (
    "yield_strength",
    "ultimate_strength",
    "strength_across_layers",
    "shear_strength_between_layers",
    "sustained_stress",
    "ultimate_strength_by_diameter",
    "strength",
)
"""Entries of a card, each with its range where it has one."""
_IN_CHECKS = ("pressure", "shear_strength", "shear_strength_range", "tensile_strength", "clamping_force")
"""What checks of contact and connections state of strengths and pressures beside cards."""
_OF_LINKAGE = (Quantity.LOAD_SHARE, Quantity.BUCKLING_FACTOR)
"""One or the other says whether the linkage as a whole holds the load."""
_Key = tuple[str, Quantity, Subject]
_EXACT = 1e-9


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A change of a case.

    Attributes
    ----------
    modulus, strength : float
        Factors on moduli and on strengths.
    material : str
        Name of the one that changes; "" for all of them.
    """

    modulus: float = 1.0
    strength: float = 1.0
    material: str = ""

    @classmethod
    def loads(cls, factor: float) -> "Scaled":
        """Return the change that stands for a factor on all loads.

        Parameters
        ----------
        factor : float

        Returns
        -------
        Scaled
        """
        return cls(modulus=1.0 / factor, strength=1.0 / factor)

    def on(self, case: Case) -> Case:
        """Return the changed case.

        Parameters
        ----------
        case : Case

        Returns
        -------
        Case
        """
        every = case.all_materials
        names = [self.material] if self.material else list(every)
        changed: dict[str, object] = {"materials": {**every, **{name: self._on(every[name]) for name in names}}}
        if not self.material:
            changed["checks"] = {name: _weaker(check, self.strength) for name, check in case.checks.items()}
        return case.model_copy(update=changed)

    def _on(self, material: Material) -> Material:
        factors = {**dict.fromkeys(MODULI, self.modulus), **dict.fromkeys(STRENGTHS, self.strength)}
        entries = {entry: factor for key, factor in factors.items() for entry in (key, f"{key}_range")}
        return material.model_copy(
            update={
                entry: _times(value, factor)
                for entry, factor in entries.items()
                if (value := getattr(material, entry, None)) is not None and not isinstance(value, str)
            }
        )


@dataclass(frozen=True, kw_only=True)
class Resized:
    """A case with another size.

    Attributes
    ----------
    entry : str
        Its path, such as ``parts.tube.outer_diameter``.
    value : str
        With its unit.
    """

    entry: str
    value: str

    def on(self, case: Case) -> Case:
        """Return the changed case.

        Parameters
        ----------
        case : Case

        Returns
        -------
        Case

        Raises
        ------
        CaseError
            Where the rules of the case refuse the value.
        """
        return case.with_values({self.entry: self.value})


Change = Scaled | Resized


def _weaker(check: CaseModel, factor: float) -> CaseModel:
    """Return a check, or what it holds, with the strengths and pressures that it states by itself times a factor."""
    held = {entry: getattr(check, entry) for entry in type(check).model_fields}
    changed: dict[str, object] = {
        entry: _weaker(value, factor) for entry, value in held.items() if isinstance(value, CaseModel)
    }
    changed |= {entry: _times(held[entry], factor) for entry in _IN_CHECKS if held.get(entry) is not None}
    return check.model_copy(update=changed)


def _times(value: object, factor: float) -> object:
    if isinstance(value, float):
        return value * factor
    assert isinstance(value, tuple)
    if value and isinstance(value[0], tuple):  # (diameter, strength)
        return tuple((diameter, strength * factor) for diameter, strength in value)
    return tuple(end * factor for end in value)


@dataclass(frozen=True, kw_only=True, eq=False)
class Trials:
    """Checks of the load cases of a result with something changed.

    Attributes
    ----------
    result : CheckResult
    """

    result: CheckResult
    _done: dict[tuple[str, Change, tuple[str, ...] | None], LoadCaseResult | None] = field(default_factory=dict)

    def share(self, check: CheckOutcome, change: Scaled) -> float:
        """Return by which factor a check and all that passes beside it keep their limits with a change, the least.

        Parameters
        ----------
        check : CheckOutcome
        change : Scaled

        Returns
        -------
        float
            1 or more where the change holds; 0 where hand calculation has no answer.
        """
        if change.modulus == 1.0:  # a strength changes no stress and no equilibrium
            lost = self.result.load_cases[check.load_case].gives_way
            return 0.0 if lost else min(1.0, check.margin * change.strength)
        told = self.result.load_cases[check.load_case].checks
        compared = [
            one
            for one in told
            if goes_with_load(one) and not _whole(one) and (_key(one) == _key(check) or one.verdict is Verdict.PASS)
        ]
        plain, found = self._plain(check.load_case), self._checked(check.load_case, change, _links(compared))
        if plain is None or found is None or (found.gives_way and check.subject != LINKAGE):
            return 0.0
        whole = [one for one in told if _whole(one)]
        after, least = _outcomes(found), [1.0]
        if _whole(check) or all(one.verdict is Verdict.PASS for one in whole):
            least += [one.margin for one in after.values() if _whole(one)]
        return min((*least, *(x for one in compared for x in _margins(one, _outcomes(plain), after))))

    def expected(self, check: CheckOutcome, change: Change) -> float:
        """Return by which factor a check keeps its limit with a change.

        Parameters
        ----------
        check : CheckOutcome
        change : Scaled or Resized

        Returns
        -------
        float
            1 or more where it keeps it; 0 where hand calculation does not judge it then.
        """
        wanted = None if _whole(check) else _links([check])  # a linkage that holds its load is looked at in full next
        plain, found = self._plain(check.load_case), self._checked(check.load_case, change, wanted)
        if plain is None or found is None or (found.gives_way and check.subject != LINKAGE):
            return 0.0
        after = _outcomes(found).get(_key(check))
        if not _whole(check) and (after is None or after.value.unknowable):
            return 0.0
        margins = _margins(check, _outcomes(plain), _outcomes(found))
        return min(margins, default=0.0 if after is None else after.margin)

    def holds(self, size: Resized) -> bool:
        """Return whether every check of the case is expected to keep its limit with another size.

        Parameters
        ----------
        size : Resized

        Returns
        -------
        bool
            What hand calculation does not judge is left aside.
        """
        plain, found = self._every, self._whole_check(size)
        return (
            plain is not None
            and found is not None
            and all(
                not after.gives_way
                and all(
                    margin >= 1.0 - _EXACT
                    for one in told.checks
                    for margin in _margins(one, _outcomes(before), _outcomes(after))
                )
                for told, before, after in zip(
                    *(one.load_cases.values() for one in (self.result, plain, found)), strict=True
                )
            )
        )

    def beyond(self, load_case: str, size: Resized) -> bool:
        """Return whether a size takes a link out of what hand calculation was calibrated for: then it does not hold.

        It is told by the link alone, whatever acts on it, so that nothing is solved.

        Parameters
        ----------
        load_case : str
            Its name.
        size : Resized
            That the rules of the case take.

        Returns
        -------
        bool
            Of a link that hand calculation decides as it is; False where a solid was taken for any.
        """
        found, case = self.result.load_cases[load_case], self.result.case
        if not _by_hand(found):
            return False
        changed = size.on(case)
        decided = {
            one.subject.name
            for one in found.checks
            if one.subject.kind == "link"
            and one.quantity in (Quantity.SAFETY_FACTOR, Quantity.DEFLECTION)
            and 0.0 < one.margin < math.inf
            and not _left_open(one)
        }
        return any(_uncalibrated(changed, link) and not _uncalibrated(case, link) for link in decided)

    @cached_property
    def _every(self) -> CheckResult | None:
        """The whole case as it is, by hand."""
        by_hand = all(map(_by_hand, self.result.load_cases.values()))
        return self.result if by_hand else self._whole_check(Scaled())

    def _whole_check(self, change: Change) -> CheckResult | None:
        """All load cases with all checks, also those of what no load makes; None where one refuses the change."""
        try:
            return check_case(change.on(self.result.case), name=self.result.name, fidelity="beam", threads=1)
        except (CaseError, CannotRunError):
            return None

    def _plain(self, load_case: str) -> LoadCaseResult | None:
        """The case as it is, by hand."""
        case = self.result.load_cases[load_case]
        return case if _by_hand(case) else self._checked(load_case, Scaled())

    def _checked(self, load_case: str, change: Change, wanted: tuple[str, ...] | None = None) -> LoadCaseResult | None:
        """A load case with a change, with the whole bands of some links, or of all."""
        key = (load_case, change, None if (load_case, change, None) in self._done else wanted)
        if key not in self._done:
            self._done[key] = self._check(*key)
        return self._done[key]

    def _check(self, load_case: str, change: Change, wanted: tuple[str, ...] | None) -> LoadCaseResult | None:
        try:
            case = change.on(self.result.case)
        except CaseError:
            return None
        checks = {name: check for name, check in case.all_checks.items() if not isinstance(check, (*KINDS, MotorCheck))}
        alone = case.model_copy(update={"load_cases": {load_case: case.load_cases[load_case]}, "checks": checks})
        try:
            found = check_case(alone, name=self.result.name, fidelity="beam", threads=1, bare=True, told=wanted)
        except (CaseError, CannotRunError):
            return None
        return found.load_cases[load_case]


def _by_hand(result: LoadCaseResult) -> bool:
    return all(isinstance(link, HandResult) for link in result.links.values())


def _uncalibrated(case: Case, link: str) -> bool:
    return bool(uncalibrated(case.body(link), case.material_of(link).poissons_ratio))


def _links(compared: Sequence[CheckOutcome]) -> tuple[str, ...] | None:
    """Return the links whose numbers are compared; None where others may hold those of any link."""
    if any(one.subject.kind not in ("link", "pin", "joint") and not _whole(one) for one in compared):
        return None
    return tuple(dict.fromkeys(one.subject.name for one in compared if one.subject.kind == "link"))


def _margins(
    check: CheckOutcome, plain: Mapping[_Key, CheckOutcome], found: Mapping[_Key, CheckOutcome]
) -> Iterator[float]:
    """Yield the margin that a check is expected to have with a change; none where hand calculation does not tell it."""
    before, after = plain.get(_key(check)), found.get(_key(check))
    if _whole(check):  # by its share of the load or by its factor; none of both where no load that counts bends it
        yield min((one.margin for one in found.values() if _whole(one)), default=math.inf)
        return
    if before is None or after is None or (after.margin == math.inf and not _left_open(after)):
        return  # not compressed any more, or not told by hand
    if _left_open(after) and not _left_open(before):
        yield 0.0  # beyond what hand calculation was calibrated for
    elif 0.0 < before.margin < math.inf:
        yield check.margin * after.margin / before.margin
    elif before.margin == 0.0 and not before.value.unknowable:
        yield after.margin if check.margin == 0.0 else 0.0
    elif before.margin == math.inf and not _left_open(before):
        yield after.margin
    # Else no beam tells, and the number goes with the change by definition.


def _left_open(check: CheckOutcome) -> bool:
    """True of a check that its model may not decide, wherever its band lies: not calibrated, or kept from it."""
    return check.verdict is Verdict.UNDECIDED and (bool(check.value.without) or check.margin >= 1.0)


def _outcomes(result: LoadCaseResult) -> dict[_Key, CheckOutcome]:
    return {_key(one): one for one in result.checks}


def _key(check: CheckOutcome) -> _Key:
    return check.name, check.quantity, check.subject


def _whole(check: CheckOutcome) -> bool:
    return check.subject == LINKAGE and check.quantity in _OF_LINKAGE


def goes_with_load(check: CheckOutcome) -> bool:
    """Return True of a number that loads, moduli and strengths make in one pose, so that it can be tried.

    Parameters
    ----------
    check : CheckOutcome

    Returns
    -------
    bool
        False of motors, whose linkage is rigid, of fatigue, and of what comes from no load.
    """
    others = (*MOTOR_QUANTITIES, *UNLOADED_QUANTITIES, Quantity.FATIGUE_STRESS, Quantity.FATIGUE_LIFE)
    return check.quantity not in others
