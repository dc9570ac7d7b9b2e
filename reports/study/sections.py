"""A study for people: what became of its points, what varies, pictures, what limits, and the points themselves."""

import json
import math
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from alula.loads.case.case_file import built_in_cases
from alula.reports.figures.study.points import OUTCOMES, Parameter
from alula.reports.sections.markup import bold, code, entry
from alula.reports.sections.section import (
    Cell,
    Column,
    Command,
    Items,
    Mark,
    Number,
    Part,
    Section,
    Table,
    Text,
    say,
    words,
)
from alula.reports.study.choice import picture_sections
from alula.reports.study.columns import StudyColumns
from alula.reports.study.rows import Row, checked, title
from alula.reports.words.numbers import joined, plain

ALIKE = "No point is best or worst: each is open by a check that is not known, or whose band leaves no margin."
_MOST_WORDS = 12
_MOST_SENTENCES = 10
_MOST_POSITIONS = 20


def study_sections(study: StudyColumns) -> tuple[Section, ...]:
    """Return what is told of a study.

    Parameters
    ----------
    study : StudyColumns

    Returns
    -------
    tuple of Section
        The first one is what a page begins with.
    """
    plan = study.facts["plan"]
    return (
        Section(key="outcome", title=f"Study of {plan['case']} ({plan['analysis']})", parts=_outcome(study)),
        Section(key="varies", title="What varies", short="What varies", parts=_varies(study)),
        *picture_sections(study),
        Section(key="limits", title="What limits", short="What limits", parts=_limits(study)),
        Section(key="lost", title="Points without result", short="Without result", parts=_lost(study)),
        Section(key="points", title="Points", short="Points", parts=_points(study)),
    )


def headline(counts: Mapping[str, int], total: int) -> str:
    """Return how many points there are, and what became of them.

    Parameters
    ----------
    counts : mapping of str to int
        Points by verdict, or by state where there is none.
    total : int
        Points of the plan.

    Returns
    -------
    str
        Such as ``40 points: 12 pass, 3 undecided and 25 fail.``
    """
    here = sum(counts.values())
    told = joined([f"{counts[name]} {name}" for name in OUTCOMES if name in counts])
    return f"{here} points: {told}." if here == total else f"{here} of {total} points: {told or 'none yet'}."


def _outcome(study: StudyColumns) -> tuple[Part, ...]:
    found: list[Part] = [Text(bold(headline(Counter(study.outcome.tolist()), study.facts["points"])))]
    for which, row in study.extremes.items():
        assert row.nearest is not None
        facts = {"end": f"{which}, point {row.position}", "outcome": row.outcome, "stated": row.stated}
        found.append(say("{end}: {outcome}, {what} {value} ({limit}); {stated}", **facts, **checked(row.nearest)))
    if len(study.undecided) > 1 and not study.extremes:
        found.append(Text(ALIKE))
    if study.undecided:
        found.append(say("Undecided: {positions}", positions=_named(study.undecided)))
    return tuple(found)


def _named(positions: Sequence[int]) -> str:
    """Such as ``points 0, 1 and 4``."""
    shown, more = [str(position) for position in positions[:_MOST_POSITIONS]], len(positions) - _MOST_POSITIONS
    return f"point{'s' if len(positions) > 1 else ''} {joined([*shown, f'{more} more'] if more > 0 else shown)}"


def _varies(study: StudyColumns) -> tuple[Part, ...]:
    plan = study.facts["plan"]
    rows: list[tuple[Cell, ...]] = [(entry(one.path), *_values(one)) for one in study.parameters]
    rows += [(entry(path), f"= {expression}", "") for path, expression in plan["link"].items()]
    rows += [(entry(path), str(value), _count(1)) for path, value in plan["set"].items()]
    columns = (words("entry"), words("values", wraps=True), Column("how many"))
    model = f" with fidelity {plan['fidelity']}" if plan["analysis"] == "check" else ""
    method = (
        f"The {bold('margin')} of a check is the factor by which it keeps its limit: the number over a least limit, or "
        "the largest allowed over the number; it is 1 at the limit. Pictures show that of the value with its band, the "
        f"table that of the worse end. The verdict is decided on the whole {bold('band')}: pass if all of it keeps the "
        "limit, fail if none of it does, undecided otherwise or where no model that ran can decide."
    )
    return (
        Table(key="entries", columns=columns, rows=tuple(rows)),
        say("Every point was computed as by {command}{model}", command=code(f"alula {plan['analysis']}"), model=model),
        *((Text(method, "note"),) if study.margin is not None else ()),
    )


def _values(one: Parameter) -> tuple[str, Number]:
    """The values of an entry, and how many there are."""
    values = list(one.words) or [plain(value) for value in np.unique(one.values).tolist()]
    told = ", ".join(values[:_MOST_WORDS])
    if len(values) > _MOST_WORDS:
        told = f"{told} ..." if one.words else f"{values[0]} to {values[-1]}"
    return f"{told} {one.unit}".rstrip(), _count(len(values))


def _count(number: int) -> Number:
    return Number(float(number), decimals=0, derived=True)


def _limits(study: StudyColumns) -> tuple[Part, ...]:
    caption = "The check that is nearest to its limit, or farthest beyond, by the unfavourable end of its band"
    rows = tuple((name, _count(count)) for name, count in study.limiting.items())
    columns = (words("check"), Column("points"))
    return (Table(key="limits", columns=columns, rows=rows, caption=caption),) if rows else ()


def _lost(study: StudyColumns) -> tuple[Part, ...]:
    told = [f"{state.capitalize()}, {_named(positions)}: {why}." for (state, why), positions in study.sentences.items()]
    if len(told) > _MOST_SENTENCES:
        command = code("alula study show FOLDER --csv FILE")
        told[_MOST_SENTENCES:] = [f"{len(told) - _MOST_SENTENCES} further sentences: {command}."]
    return (Items(tuple(told)),) if told else ()


def points_table(
    rows: Sequence[Row], numbers: Sequence[str] = (), *, margins: bool = True, weighed: bool = True
) -> Table:
    """Return a table of points.

    Parameters
    ----------
    rows : sequence of Row
    numbers : sequence of str, optional
        Titles of numbers to be shown besides.
    margins, weighed : bool, optional
        Whether there is a margin, with the check that it is of, and a mass.

    Returns
    -------
    Table
    """
    paths = dict.fromkeys(path for row in rows for path in row.parameters)
    nearest = (Column("margin"), words("nearest to its limit"), Column("value"), Column("limit"))
    columns = (
        Column("point"),
        *(words(entry(path)) for path in paths),
        words("verdict"),
        *(column if margins else None for column in nearest),
        *(Column(name) for name in numbers),
        Column("mass", "g") if weighed else None,
    )

    def cells(row: Row) -> tuple[Cell | None, ...]:
        facts = {} if row.nearest is None else checked(row.nearest)
        known = {title(one).removesuffix(" [1]"): one.value for one in row.answer.numbers}
        return (
            Number(float(row.position), decimals=0),
            *(str(row.parameters.get(path, "")) for path in paths),
            Mark(row.outcome, str(row.answer.verdict or "")),
            Number(row.margin, digits=3, derived=True) if facts else None,
            *(facts.get(key) for key in ("what", "value", "limit")),
            *(None if math.isnan(known.get(name, math.nan)) else Number(known[name]) for name in numbers),
            None if row.mass is None else Number(row.mass),
        )

    return Table.of(columns, map(cells, rows), key="points")


def _points(study: StudyColumns) -> tuple[Part, ...]:
    count, checks = len(study.outcome), study.margin is not None
    more, found = count - len(study.rows), list[Part]()
    if more and checks:
        found.append(Text("The best points by verdict and margin, the first undecided ones, and the worst."))
    labels = [one.label for one in study.numbers]
    found.append(points_table(study.rows, labels, margins=checks, weighed=study.mass is not None))
    if more:
        all_rows, file = (code(f"alula study show FOLDER {option}") for option in (f"--most {count}", "--csv FILE"))
        found.append(Text(f"{more} more points: {all_rows}; {file} writes every number of them with its band."))
    if command := _command(study):
        found.append(Command("The report of the best point:", command))
    return tuple(found)


def _command(study: StudyColumns) -> str:
    """The command that checks the best point; "" where nothing is checked, and for a case that no file states."""
    plan, best = study.facts["plan"], study.extremes.get("best")
    if best is None or plan["analysis"] == "motion" or plan.get("tables"):
        return ""
    changes = {**plan["set"], **best.parameters}
    texts = {path: value if isinstance(value, str) else json.dumps(value) for path, value in changes.items()}
    options = [word for path, text in texts.items() for word in ("--set", f"{path}={text}")]
    case = plan["case"] if plan["case"] in built_in_cases() else Path(plan["case"]).name
    return shlex.join(["alula", plan["analysis"], case, *options, "-o", "out"])
