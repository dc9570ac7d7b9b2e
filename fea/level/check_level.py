"""The check of a level: every test as a variant of the case, and what it says of each thing that the test asks for."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from alula.fea.asked.asked import asked
from alula.fea.asked.tiers import tier_of, worst_of
from alula.fea.check.deciding import BY_HAND
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import FATIGUE_QUANTITIES, CheckOutcome, Tier, Verdict, overall
from alula.fea.motion.envelope import envelope_case
from alula.fea.outcomes.found import Found
from alula.fea.outcomes.result import CheckResult
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.level_case import Demand, demanded, over_states
from alula.loads.records.check_spec import FatigueCheck
from alula.loads.stated.level_spec import LevelSpec, LevelTest


@dataclass(frozen=True, kw_only=True)
class Statement:
    """What a test says of one thing that it asks for.

    Attributes
    ----------
    demand : Demand
    outcomes : tuple of CheckOutcome
        All that were judged for it; empty where there is nothing to judge it by.
    """

    demand: Demand
    outcomes: tuple[CheckOutcome, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst; undecided where nothing was judged."""
        return overall(one.verdict for one in self.outcomes)

    @property
    def decides(self) -> CheckOutcome | None:
        """The outcome that has this verdict, nearest to its limit; None where nothing was judged."""
        return worst_of(self.outcomes) if self.outcomes else None


@dataclass(frozen=True, kw_only=True)
class TestResult:
    """One test of a level.

    Attributes
    ----------
    name : str
    spec : LevelTest
        As it is stated.
    result : CheckResult
        Of the variant of the case that is this test.
    """

    __test__ = False  # for pytest
    name: str
    spec: LevelTest
    result: CheckResult

    @property
    def verdict(self) -> Verdict:
        """Over all that was judged in it."""
        return self.result.verdict

    @property
    def statements(self) -> tuple[Statement, ...]:
        """One for each thing that it asks for, in the order of ``Demand``; ``BESIDES`` where there is such."""
        case, found = self.result.case, {demand: list[CheckOutcome]() for demand in demanded(self.result.case)}
        names = {name: demand for demand, checks in demanded(case).items() for name in checks}
        for load_case in self.result.load_cases.values():
            for outcome in load_case.checks:
                breaks = Demand.NO_BREAK in found and tier_of(case, outcome) is Tier.BREAK
                demand = names.get(outcome.name, Demand.NO_BREAK if breaks else Demand.BESIDES)
                found.setdefault(demand, []).append(outcome)
        return tuple(Statement(demand=demand, outcomes=tuple(own)) for demand, own in found.items())


@dataclass(frozen=True, kw_only=True)
class LevelResult:
    """What ``alula check`` found of a case with a level.

    Attributes
    ----------
    case : Case
        As it is stated, with all tests.
    name : str
        What the case was called on the command line.
    level : LevelSpec
    tests : mapping of str to TestResult
        In the order in which they are stated.
    own : CheckResult or None
        Of the load cases that the case states besides its level; None where it states none.
    """

    case: Case
    name: str
    level: LevelSpec
    tests: Mapping[str, TestResult]
    own: CheckResult | None = None

    @property
    def verdict(self) -> Verdict:
        """Of the level: the worst of its tests."""
        return overall(test.verdict for test in self.tests.values())

    @property
    def worst(self) -> Verdict:
        """The worst of its tests and of the case's own load cases, by which a command ends."""
        return overall([self.verdict, *([self.own.verdict] if self.own else [])])

    def of_each(self, change: Callable[[CheckResult], CheckResult]) -> Self:
        """Return the level with something done to the result of each test, and of the case's own load cases.

        Parameters
        ----------
        change : callable
            Such as ``with_findings``.

        Returns
        -------
        LevelResult
        """
        tests = {name: replace(test, result=change(test.result)) for name, test in self.tests.items()}
        return replace(self, tests=tests, own=None if self.own is None else change(self.own))


def has_tests(case: Case) -> bool:
    """Return whether a case has a level of which no test is chosen, so that a check goes over all.

    Parameters
    ----------
    case : Case

    Returns
    -------
    bool
    """
    return case.level is not None and case.level.test is None


def check_level(
    case: Case, *, name: str = "", progress: Callable[[str], None] = lambda message: None, **options: Any
) -> LevelResult:
    """Check a case with a level: all tests, each as a variant of the case, and load cases of the case's own.

    Parameters
    ----------
    case : Case
        With a level of which no test is chosen, as it was read.
    name : str, optional
        Path or built-in name of the case.
    progress : callable, optional
        Called with a sentence before every stage that may take long.
    **options
        Others of ``check_case``.

    Returns
    -------
    LevelResult

    Raises
    ------
    CaseError, CannotRunError
        As ``check_case``.
    """
    level = case.level
    assert level is not None
    tests = {}
    for test, spec in level.tests.items():
        progress(f"Test {test} of {level.title} ...")
        variant = case.with_values({"level.test": test})
        result = check_case(variant, name=name, progress=progress, **options)
        if spec.profiled and spec.lasts and options.get("fidelity") not in BY_HAND:
            result = _with_fatigue(result, test, progress, options)
        tests[test] = TestResult(name=test, spec=spec, result=result)
    own = None if case.tests_alone else check_case(case, name=name, progress=progress, **options)
    return LevelResult(case=case, name=name, level=level, tests=tests, own=own)


def _with_fatigue(
    result: CheckResult, test: str, progress: Callable[[str], None], options: Mapping[str, Any]
) -> CheckResult:
    """Return the check of a test with a profile with the fatigue of its states in their order, on solids.

    Each outcome stands with the state in which the link is stressed most. Where no stress can be followed over the
    states, fatigue stays undecided for that reason.
    """
    case, given = result.case, {key: value for key, value in options.items() if key in ("threads", "effort")}
    states = case.level.tests[test].states if case.level else ()
    kept = {
        x: ([one for one in of.checks if one.quantity not in FATIGUE_QUANTITIES], list(of.found))
        for x, of in result.load_cases.items()
    }
    try:
        over = envelope_case(over_states(case), name=result.name, progress=progress, **given)
    except CaseError as error:
        first, why = next(iter(kept)), str(error)
        for one in asked(case, FatigueCheck):
            kept[first][0].append(one.outcome(first, Band.unknown(why), why))
        warnings = result.warnings
    else:
        for outcome in over.checks:
            if outcome.quantity in FATIGUE_QUANTITIES:
                found = over.links[outcome.link].load_cases[test]
                at = states[found.pose].name
                kept[at][0].append(replace(outcome, load_case=at))
                if found.fatigue is not None and outcome.name in case.checks:
                    kept[at][1].append(Found(check=outcome.name, subject=outcome.subject, numbers=found.fatigue))
        warnings = tuple(dict.fromkeys((*result.warnings, *over.warnings)))
    load_cases = {
        x: replace(of, checks=tuple(kept[x][0]), found=tuple(kept[x][1])) for x, of in result.load_cases.items()
    }
    verdict = overall(one.verdict for of in load_cases.values() for one in of.checks)
    return replace(result, load_cases=load_cases, verdict=verdict, warnings=warnings)
