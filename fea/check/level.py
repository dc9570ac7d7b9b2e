"""The check of a level: every test as a variant of the case, and what it says of each thing that the test asks for."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from alula.fea.asked.tiers import tier_of, worst_of
from alula.fea.check.run import check_case
from alula.fea.common.verdict import CheckOutcome, Tier, Verdict, overall
from alula.fea.outcomes.result import CheckResult
from alula.loads.case.case import Case
from alula.loads.case.level_case import Demand, demanded
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
        tests[test] = TestResult(
            name=test, spec=spec, result=check_case(variant, name=name, progress=progress, **options)
        )
    own = None if case.tests_alone else check_case(case, name=name, progress=progress, **options)
    return LevelResult(case=case, name=name, level=level, tests=tests, own=own)
