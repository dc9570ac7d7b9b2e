"""A level of tests: what each test says, on the console, in ``result.json`` and in the folder of its reports."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from alula.fea.common.reason import Reason
from alula.fea.common.verdict import FATIGUE_QUANTITIES, CheckOutcome, Verdict
from alula.fea.level.check_level import LevelResult, Statement, TestResult
from alula.loads.case.level_case import Demand
from alula.loads.text.caveat import Caveat
from alula.reports.renderers.console import print_parts, verdict_line
from alula.reports.renderers.record import as_record
from alula.reports.sections.checks import JUDGED, against, check_records
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part, Section, Table, Text
from alula.reports.sections.table import Cell, Mark, words
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import besides
from alula.reports.words.numbers import joined, number, sentence
from alula.reports.words.terminal import say

if TYPE_CHECKING:
    from rich.console import Console

Told = TypeVar("Told")
TESTS, OWN = "tests", "own"
"""Folders of the reports of the tests, and of the case's own load cases."""


def level_section(result: LevelResult) -> Section:
    """Return what each test of a level says of each thing that it asks for.

    Parameters
    ----------
    result : LevelResult

    Returns
    -------
    Section
        With the table ``tests``.
    """
    level = result.level
    own: list[Part] = []
    if result.own is not None:
        text = f"Load cases of the case itself, which are of no test: {result.own.verdict}."
        own.append(Text(text))
    return Section(
        key="level",
        title=level.title,
        short="Tests",
        parts=(_table(result), *own),
        data={
            "level": entries(level, "standard name condition source read_from")
            | {
                "verdict": result.verdict.value,
                "tests": {name: _record(result, test) for name, test in result.tests.items()},
                "own_load_cases": None if result.own is None else result.own.verdict.value,
            }
        },
    )


def _table(result: LevelResult) -> Table:
    rows, below = list[tuple[Cell, ...]](), dict[int, str]()
    for name, test in result.tests.items():
        for statement in test.statements:
            decides = statement.decides
            if decides is None or (statement.demand is Demand.BESIDES and statement.verdict is Verdict.PASS):
                continue
            if statement.verdict is not Verdict.PASS:
                below[len(rows)] = sentence(f"{name}: {told(decides.reason)}")
            subject = f"{decides.quantity} of {decides.subject}{at_state(test, decides)}"
            mark = Mark(statement.verdict.value, statement.verdict.value)
            rows.append((name, statement_words(test, statement), subject, *against(decides), mark))
    heads = words("test", role="under"), words("says", wraps=True), words("by", role="what", wraps=True)
    return Table.of((*heads, *JUDGED), rows, key="tests", below=below, kind="checks")


def statement_words(test: TestResult, statement: Statement) -> str:
    """Return what a test says of one thing that it asks for, such as ``breaks`` or ``lasts 1000000 cycles``.

    Parameters
    ----------
    test : TestResult
    statement : Statement

    Returns
    -------
    str
        What is asked, followed by ``?``, where that is open.
    """
    demand, verdict = statement.demand, statement.verdict
    cycles = f" {number(test.spec.cycles or 0.0, 3)} cycles"
    passed, failed = {
        Demand.ELASTIC: ("stays elastic", "yields"),
        Demand.PERMANENT_SET: ("permanent set kept", "permanent set too large"),
        Demand.NO_BREAK: ("does not break", "breaks"),
        Demand.LASTS: (f"lasts{cycles}", f"does not last{cycles}"),
        Demand.BESIDES: ("else", "else"),
    }[demand]
    return {Verdict.PASS: passed, Verdict.FAIL: failed, Verdict.UNDECIDED: f"{passed}?"}[verdict]


def at_state(test: TestResult, decides: CheckOutcome) -> str:
    """Return at which state of a profile something is decided, with a comma before it; "" of other tests.

    Parameters
    ----------
    test : TestResult
    decides : CheckOutcome

    Returns
    -------
    str
        "" of fatigue as well, which all states make together.
    """
    return f", {decides.load_case}" if test.spec.profiled and decides.quantity not in FATIGUE_QUANTITIES else ""


def _record(result: LevelResult, test: TestResult) -> dict[str, Any]:
    return {
        "title": test.spec.title,
        "source": test.spec.source or result.level.source,
        "verdict": test.verdict.value,
        "force": test.spec.decisive.most,
        "least": test.spec.decisive.least,
        "cycles": test.spec.cycles,
        "hold": test.spec.hold,
        "top": data(result.level.place(test.spec.top)),
        "bottom": data(result.level.place(test.spec.bottom)),
        "statements": [
            {
                "asks": one.demand.value,
                "says": statement_words(test, one),
                "verdict": one.verdict.value,
                "judged": len(one.outcomes),
                "decides": None if one.decides is None else check_records([one.decides])[0],
            }
            for one in test.statements
        ],
    }


def level_besides(result: LevelResult) -> tuple[str, ...]:
    """Return what the verdict of a level stands on besides, each thing once behind the names of its tests.

    Parameters
    ----------
    result : LevelResult

    Returns
    -------
    tuple of str
        Of all tests first, without their names.
    """
    groups: dict[str, list[Caveat]] = {"": []}
    for one, names in by_tests(result, lambda test: test.result.caveats).items():
        of = "" if len(names) == len(result.tests) else f" ({joined(names)})"
        groups.setdefault(of, []).append(one)
    return tuple(line for of, own in groups.items() if (line := besides(own, of)))


def level_warnings(result: LevelResult) -> tuple[str, ...]:
    """Return the warnings of all tests, each once behind the names of its tests.

    Parameters
    ----------
    result : LevelResult

    Returns
    -------
    tuple of str
    """
    found = by_tests(result, lambda test: [plain_warning(test, one) for one in test.result.warnings])
    every = len(result.tests)
    of = {text: "all tests" if len(names) == every > 1 else joined(names) for text, names in found.items()}
    return tuple(sentence(f"warning ({of[text]}): {text}") for text in found)


def by_tests(result: LevelResult, told_of: Callable[[TestResult], Iterable[Told]]) -> dict[Told, list[str]]:
    """Return what is told of tests, each once, with the names of its tests.

    Parameters
    ----------
    result : LevelResult
    told_of : callable
        Takes a test to what is told of it.

    Returns
    -------
    dict
    """
    found: dict[Told, list[str]] = {}
    for name, test in result.tests.items():
        for one in dict.fromkeys(told_of(test)):
            found.setdefault(one, []).append(name)
    return found


def print_level(result: LevelResult, sections: Sequence[Section], console: "Console") -> None:
    """Print what each test says, and the verdict of the level.

    Parameters
    ----------
    result : LevelResult
    sections : sequence of Section
        That of ``level_section``.
    console : rich.console.Console
    """
    verdict_line(result.worst, result.case.title, console)
    say(console, f"{sections[0].title}: {result.verdict}.")
    print_parts(sections[0].parts, console, [])
    for line in level_besides(result):
        say(console, line)
    for warning in level_warnings(result):
        say(console, warning, style="yellow")
    say(console, 'All numbers of a test: --set level.test="..." with its name, and --verbose')


def plain_warning(test: TestResult, warning: Reason | str) -> str:
    """Return a warning without the load cases that it is of, where these are all of the test.

    Parameters
    ----------
    test : TestResult
    warning : Reason or str

    Returns
    -------
    str
    """
    names = tuple(test.result.load_cases)
    return told(warning).removeprefix(f"load case{'s' * (len(names) > 1)} {', '.join(names)}: ")


def level_record(result: LevelResult, sections: Sequence[Section]) -> dict[str, Any]:
    """Return a level as data that JSON can hold.

    Parameters
    ----------
    result : LevelResult
    sections : sequence of Section

    Returns
    -------
    dict
        As ``docs/result.md`` describes it.
    """
    head = {"case": result.name, "title": result.case.title, "source": result.case.source}
    return as_record(sections, **head, verdict=result.worst.value)
