"""``level.html``: one page for all tests of a level, what they stand on first, as it is printed and signed."""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any
from urllib.parse import quote

from alula.fea.common.verdict import Verdict
from alula.fea.level.check_level import LevelResult, Statement, TestResult
from alula.fea.outcomes.fatigue import LinkFatigue
from alula.loads.case.level_case import Demand
from alula.loads.stated.level_spec import LevelStep
from alula.reports.check.folder import REPORT
from alula.reports.check.stated import materials_section
from alula.reports.check.whole_check import check_sections
from alula.reports.figures.set_up import profile_drawing, set_up_drawing
from alula.reports.level.tests import (
    OWN,
    TESTS,
    at_state,
    by_tests,
    level_besides,
    level_section,
    level_warnings,
    statement_words,
)
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.page import Page
from alula.reports.sections.checks import JUDGED, against
from alula.reports.sections.data import entries
from alula.reports.sections.markup import code, headed, link
from alula.reports.sections.section import Group, Items, Part, Picture, Section, Text
from alula.reports.sections.table import Cell, Column, Mark, Number, Table, words
from alula.reports.sentences import told
from alula.reports.sentences.caveats import caveat
from alula.reports.words.numbers import joined, number, plain, sentence

PAGE = "level.html"
SET_UP = "set-up"
_AXES = ("forward", "outward", "up")
_SIGN = ("Calculated by", "Checked by", "Released by")


def level_sections(result: LevelResult) -> tuple[Section, ...]:
    """Return all that is told of a level.

    Parameters
    ----------
    result : LevelResult

    Returns
    -------
    tuple of Section
        What each test says first, as consoles and ``result.json`` have it; with what it was made last.
    """
    date = max(test.result.date for test in result.tests.values())
    return (
        level_section(result),
        _stands_on(result),
        materials_section(next(iter(result.tests.values())).result),
        _set_up(result),
        _tests(result),
        _signatures(),
        provenance_section(result.case, date),
    )


def level_page(result: LevelResult, sections: tuple[Section, ...]) -> Page:
    """Return the page of a level.

    Parameters
    ----------
    result : LevelResult
    sections : tuple of Section
        As ``level_sections``.

    Returns
    -------
    Page
    """
    each = [
        f"{name}: {test.verdict}; {', '.join(statement_words(test, one) for one in _asked(test))}"
        for name, test in result.tests.items()
    ]
    if result.own is not None:
        each.append(f"Load cases of the case itself, of no test: {result.own.verdict}, {link(OWN, f'{OWN}/{REPORT}')}.")
    return Page(
        title=f"{result.verdict.value.capitalize()}: {result.case.title}",
        kind=f"Tests of a level: {result.level.title}",
        heading=result.case.title,
        verdict=result.verdict.value,
        lead=(f"{result.level.title}: {result.verdict}.", *map(headed, each), " ".join(level_besides(result))),
        sections=sections[1:],
        footer=(f"Units: mm, N, N·mm, MPa, s. All numbers as data: {code('result.json')} in the same folder.",),
    )


def _asked(test: TestResult) -> Iterator[Statement]:
    """Yield the statements of a test, without what passes unasked."""
    for one in test.statements:
        if one.demand is not Demand.BESIDES or one.verdict is not Verdict.PASS:
            yield one


def _stands_on(result: LevelResult) -> Section:
    """Return what all numbers stand on, and what no check looks at."""
    case = result.case
    rubs = [f"{name} {plain(joint.friction)}" for name, joint in case.joints.items() if joint.friction]
    friction = (
        f"Coefficients of friction: {joined(rubs)}; other joints have none." if rubs else "No joint states friction."
    )
    besides_it = _shared(result, lambda test: [(str(one.heading), caveat(one)) for one in test.result.caveats])
    limits = _shared(result, lambda test: [one for part in check_sections(test.result) for one in part.not_covered])
    parts: list[Part] = [Items(besides_it), Items((friction, *case.assumptions))]
    if warnings := level_warnings(result):
        parts.append(Items(warnings, "warnings"))
    parts += [Text("What no check looks at:"), Items(limits, "columns2")]
    return Section(key="assumptions", title="What all numbers stand on", short="Assumptions", parts=tuple(parts))


def _shared(
    result: LevelResult, told_of: Callable[[TestResult], Iterable[tuple[str, str]]]
) -> tuple[tuple[str, str], ...]:
    """Return what is told of all tests under titles, each once; with the names of its tests where not all have it."""
    texts: dict[str, list[str]] = {}
    for (title, text), names in by_tests(result, told_of).items():
        of = "" if len(names) == len(result.tests) else f" ({joined(names)})"
        texts.setdefault(f"{title[:1].upper()}{title[1:]}{of}", []).append(sentence(text))
    return tuple((title, " ".join(own)) for title, own in texts.items())


def _set_up(result: LevelResult) -> Section:
    """Return the load lines of all tests, drawn and as they are stated."""
    rows = list[tuple[Cell, ...]]()
    for name, test in result.tests.items():
        ends = (getattr(end, axis) for end in (test.spec.top, test.spec.bottom) for axis in _AXES)
        rows.append((name, *(Number(value, stated=True) for value in ends)))
    columns = [Column(f"{end} {axis}", "mm") for end in ("top", "bottom") for axis in _AXES]
    about = [
        Text(
            f"The load line of test {name} is tilted about an axis along outward through "
            f"forward {plain(point.forward)} mm, up {plain(point.up)} mm."
        )
        for name, test in result.tests.items()
        if (point := test.spec.tilts_about) is not None
    ]
    table = Table(
        columns=(words("test"), *columns),
        rows=tuple(rows),
        caption="Load lines, from the origin of the standard's axes",
    )
    picture = Picture(
        name=SET_UP,
        alt="The load lines of all tests about the links, from the side and from the front",
        caption="Arrows show the force; tests with one load line share a colour. Of one that tilts, the ends of its "
        "way are drawn, and where it lies under forces that do not tilt.",
        draw=lambda: set_up_drawing(result),
    )
    return Section(key=SET_UP, title="Set-up", short="Set-up", parts=(picture, table, *about))


def _tests(result: LevelResult) -> Section:
    """Return test by test its steps, what it asks for, and what was found."""
    records = {
        name: {
            "steps": [_step(step) for step in test.spec.steps],
            "harm": list(_harm(test)),
            "offsets": {
                end: entries(point, " ".join(_AXES))
                for end in ("top", "bottom", "tilts_about")
                if (point := getattr(test.spec, end)) is not None
            },
        }
        for name, test in result.tests.items()
    }
    return Section(
        key="tests",
        title="Test by test",
        short="Tests",
        parts=tuple(_test(result, name, test) for name, test in result.tests.items()),
        data={"level": {"tests": records}},
    )


def _step(step: LevelStep) -> dict[str, Any]:
    """Return a step as data; with the rows of its profile, where it has one."""
    rows = [{"time": row.time, "force": row.force, "tilt": math.degrees(row.tilt)} for row in step.rows]
    found = entries(step, "force least cycles duration profile scale")
    return found | ({"rows": rows} if rows else {})


def _harm(test: TestResult) -> tuple[float, ...]:
    """Return the share of the harm that each step with cycles does, and the whole test; empty of one step alone."""
    decides = next((one.decides for one in test.statements if one.demand is Demand.LASTS), None)
    if decides is None or len(test.spec.counted) < 2:
        return ()
    found = test.result.load_cases[decides.load_case].of_links(LinkFatigue).get(decides.link)
    return () if found is None else found.life.harm


def _harm_words(test: TestResult) -> Iterator[Text]:
    """Yield what part of the harm of its cycles each step does."""
    if harm := _harm(test):
        names = [f"step {k}" for k, step in test.spec.counted if step.cycles]
        names.append("the whole test from no load and back, once")
        told = (f"{name} {number(100.0 * share, 3)} %" for name, share in zip(names, harm, strict=True))
        yield Text(f"Harm of its cycles, by Miner's sum: {'; '.join(told)}.", "note")


def _profile(test: str, number: int, step: LevelStep) -> Picture:
    """Return force and tilt of the profile of a step over time."""
    scaled = "" if step.scale is None else f", its forces times {plain(step.scale)}"
    return Picture(
        name=f"profile-{test}-{number}",
        alt=f"Force and tilt over time of step {number} of test {test}",
        caption=f"Step {number}: {step.profile}{scaled}.",
        draw=lambda: profile_drawing(step),
    )


def _test(result: LevelResult, name: str, test: TestResult) -> Group:
    """Return one test; the places of its numbers lead into its own report."""
    steps = Table.by_columns(
        {
            words("step"): [str(k) for k in range(1, len(test.spec.steps) + 1)],
            Column("largest force" if test.spec.profiled else "force", "N"): [
                Number(step.most, stated=True) for step in test.spec.steps
            ],
            Column("least force", "N"): [Number(step.least, stated=True) for step in test.spec.steps],
            Column("cycles"): [Number(step.cycles, digits=3) for step in test.spec.steps],
            Column("held for", "s"): [Number(step.duration, stated=True) for step in test.spec.steps],
        }
    )
    rows, below = list[tuple[Cell, ...]](), dict[int, str]()
    for one in _asked(test):
        decides, mark = one.decides, Mark(one.verdict.value, one.verdict.value)
        if decides is None:
            rows.append((statement_words(test, one), "nothing to judge it by", "–", "–", mark, ""))
            continue
        if one.verdict is not Verdict.PASS:
            below[len(rows)] = sentence(told(decides.reason))
        place = f"#link-{quote(decides.link)}" if decides.link in result.case.links else ""
        where = link(decides.link, f"{TESTS}/{quote(name)}/{REPORT}{place}")
        by = f"{decides.quantity}{at_state(test, decides)}"
        rows.append((statement_words(test, one), by, *against(decides), mark, where))
    columns = (words("says", role="what", wraps=True), words("by", wraps=True), *JUDGED, words("where"))
    profiles = [_profile(name, k, step) for k, step in enumerate(test.spec.steps, 1) if step.rows]
    return Group(
        f"Test {name}",
        (
            Text(f"Source of its numbers: {test.spec.source or result.level.source}.", "note"),
            steps,
            *_harm_words(test),
            *profiles,
            Table(columns=columns, rows=tuple(rows), below=below, kind="keep"),
        ),
        key=f"test-{name}",
        remark=f"{test.verdict}{f'; {test.spec.title}' if test.spec.title else ''}",
    )


def _signatures() -> Section:
    """Return lines to sign on."""
    columns = (words(""), *map(words, ("name", "date", "signature")))
    table = Table(columns=columns, rows=tuple((who, "", "", "") for who in _SIGN), kind="signs")
    return Section(key="signatures", title="Signatures", parts=(table,))
