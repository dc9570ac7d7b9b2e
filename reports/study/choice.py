"""Which pictures a study gets, by what varies in it, and how each is to be read."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from alula.fea.common.verdict import Verdict
from alula.reports.figures.study.points import MOST_LINES, MOST_MARKS, Parameter, Real, Response, marked
from alula.reports.sections.section import Column, Number, Part, Picture, Section, Table, Text, say, words
from alula.reports.study.columns import StudyColumns
from alula.reports.study.regression import regression

MOST_PANELS = 6
"""Combinations of words that have a panel each; with more of them the study is drawn in parallel coordinates."""
MOST_COMBINATIONS = 40
"""Combinations of words that stand below each other in one picture."""


def picture_sections(study: StudyColumns) -> Iterator[Section]:
    """Yield a section for each picture of a study, and one on what is not drawn.

    Parameters
    ----------
    study : StudyColumns

    Yields
    ------
    Section
    """
    quantities = [one for one in study.parameters if not one.words]
    named = [one for one in study.parameters if one.words]
    panels = _panels(named, len(study.outcome))
    few = len(quantities) <= 2 and len(panels) <= (MOST_PANELS if quantities else MOST_COMBINATIONS)
    for i, response in enumerate(study.responses):
        ending = "" if i == 0 else f"-{i + 1}"
        if few and quantities:
            yield _over(study, quantities, named, panels, response, ending)
        elif few and named and len(study.outcome) == len(panels):
            yield _by_words(study, named, panels, response, ending)
        elif not few and len(study.parameters) > 1:
            yield _sensitivities(study, response, ending)
        if response is not study.margin:
            title, caption = f"Distribution: {response.label}", "Over all points that have the number."
            facts: dict[str, Any] = {"label": response.label, "outcome": study.outcome}
            yield _shown(f"histogram{ending}", title, caption, "histogram", response.value, **facts)
    if not few:
        yield _parallel(study)
    margin = study.margin
    if margin is not None and np.isfinite(margin.value).any():
        caption = (
            "How often the nearest check keeps its limit by which factor. A bar left of the limit holds points whose "
            "value misses it; the verdict is decided on the whole band."
        )
        facts = {"label": margin.label, "outcome": study.outcome}
        title = "Distribution of the least margin"
        yield _shown("margins", title, caption, "histogram", margin.value, margin.limit, **facts)
        if study.mass is not None and _differ(study.mass[np.isfinite(margin.value)]):
            yield _pareto(study, margin, study.mass)
    notes = [] if study.responses else ["No number varies between the points that have one, so nothing is drawn."]
    if study.left_out:
        notes.append(f"{study.left_out} more numbers vary; --number with a part of a name draws others.")
    if notes:
        yield Section(key="not-drawn", title="Not drawn", parts=tuple(Text(note, "note") for note in notes))


def _shown(
    name: str, title: str, caption: str, figure: str, *args: Any, above: tuple[Part, ...] = (), **facts: Any
) -> Section:
    """Return the section of a picture; what draws it is imported when it is drawn."""

    def draw() -> Any:
        from alula.reports.figures.study import curves, many, maps, spread, style

        drawing = (
            *(curves.curves, maps.verdict_map, many.categories, many.parallel, many.pareto),
            *(spread.histogram, spread.tornado),
        )
        return style.chart({one.__name__: one for one in drawing}[figure](*args, **facts))

    picture = Picture(name=name, alt=title, caption=caption, draw=draw)
    return Section(key=name, title=title, short=title, parts=(*above, picture))


def _panels(named: Sequence[Parameter], count: int) -> list[tuple[str, Any]]:
    """One panel for every combination of words that some point has: its title, and which points stand in it."""
    found = []
    for places in itertools.islice(itertools.product(*(range(len(one.words)) for one in named)), 10_000):
        chosen = list(zip(named, places, strict=True))
        here = np.all([np.ones(count, dtype=bool), *(one.values == place for one, place in chosen)], axis=0)
        if here.any():
            found.append((", ".join(one.words[place] for one, place in chosen), here))
    return found


def _over(
    study: StudyColumns,
    quantities: Sequence[Parameter],
    named: Sequence[Parameter],
    panels: list[tuple[str, Any]],
    response: Response,
    ending: str,
) -> Section:
    """The number over one or two quantities, with a panel for each combination of words."""
    each = f" One panel for each value of {' and '.join(one.path for one in named)}." if named else ""
    each += _marked(study)
    panels = [(name, marked(here, MOST_MARKS // len(panels))) for name, here in panels]
    verdicts, known = study.margin is not None, np.isfinite(response.value).any()
    if len(quantities) == 1:
        caption = f"A mark is a point.{' Marks and colours are verdicts.' if verdicts else ''}"
        if np.any(response.low < response.high):
            caption += " The shaded band may hold the value; bands that end far away are cut off."
        title = f"{response.title} over {quantities[0].path}"
        caption += _edge(study) + each
        return _shown(f"curve{ending}", title, caption, "curves", quantities[0], response, study.outcome, panels)
    least, (first, second) = response is study.margin, quantities
    what = "the least margin (1 at the limit, a thick line)" if least else response.label
    lines = f" Lines are contours of {what}, interpolated linearly between the values of neighbouring points."
    caption = (
        f"A mark is a point{', its shape and colour the verdict' if verdicts else ''}.{lines if known else ''}{each}"
    )
    title = f"{'Verdict' if least else response.title} over {first.path} and {second.path}"
    return _shown(f"map{ending}", title, caption, "verdict_map", (first, second), response, study.outcome, panels)


def _by_words(
    study: StudyColumns, named: Sequence[Parameter], panels: list[tuple[str, Any]], response: Response, ending: str
) -> Section:
    order = np.array([int(np.flatnonzero(here)[0]) for _, here in panels])
    shown = replace(response, value=response.value[order], low=response.low[order], high=response.high[order])
    paths, names = [one.path for one in named], [name for name, _ in panels]
    title, caption = f"{response.title} by {' and '.join(paths)}", "The bar is the band that may hold the value."
    outcome, label = study.outcome[order], ", ".join(paths)
    return _shown(f"values{ending}", title, caption + _edge(study), "categories", names, shown, outcome, label=label)


def _sensitivities(study: StudyColumns, response: Response, ending: str) -> Section:
    """What a number depends on, by regression."""
    name, title = f"sensitivity{ending}", f"{response.title}: what it depends on"
    found = regression(study.parameters, response)
    if isinstance(found, str):
        return Section(key=name, title=title, parts=(Text(found),))
    share = Number(found.r_squared, decimals=2, derived=True)
    fitted = say(
        "A linear model of {what}, fitted to {points} points, holds R² = {share} of its variance{doubt}",
        what="the logarithm of the number" if found.logarithm else "the number",
        points=found.points,
        share=share,
        doubt=", so that the coefficients say little" if found.r_squared < 0.5 else "",
    )
    sizes = found.coefficients.tolist()
    order = sorted(range(len(sizes)), key=lambda i: -abs(sizes[i]))
    rows = tuple((found.names[i], Number(sizes[i], decimals=2, derived=True)) for i in order)
    table = Table(key=name, columns=(words("entry"), Column("standardised coefficient")), rows=rows)
    caption = (
        "A bar is the standardised coefficient: by how many standard deviations the number moves where the entry moves "
        "by one of its own. It speaks of the ranges of this study."
    )
    if any(found.unsigned):
        caption += " Entries that are words have dotted bars without direction."
    label = f"standardised coefficient of {response.label.partition(' (')[0]} (linear, R² = {share})"
    facts: dict[str, Any] = {"label": label, "unsigned": found.unsigned, "above": (fitted, table)}
    return _shown(name, title, caption, "tornado", found.names, found.coefficients, **facts)


def _parallel(study: StudyColumns) -> Section:
    more, count, mass = list(study.responses), len(study.outcome), study.mass
    if mass is not None and _differ(mass):
        more.append(Response(label="mass [g]", value=mass, low=mass, high=mass))
    part = f" {MOST_LINES} of {count} points are drawn, evenly through the study." if count > MOST_LINES else ""
    limit = " The thick stroke is the limit." if study.margin is not None else ""
    caption = f"A line is a point; it ends where a number is not known.{limit}{part}"
    title = "All points in parallel coordinates"
    return _shown("parallel", title, caption, "parallel", study.parameters, more, study.outcome)


def _pareto(study: StudyColumns, margin: Response, mass: Real) -> Section:
    known = np.isfinite(mass) & np.isfinite(margin.value)
    caption = (
        "Numbers are those of points on the front: no other point is lighter with as high a lower end of its band. "
        "Points that fail are left out of it."
    )
    if not (study.outcome[known] != Verdict.FAIL.value).any():
        caption = "Every point fails, so that there is no front."
    caption += _marked(study).replace("drawn,", "drawn besides the front,")
    title = "Mass and least margin"
    return _shown("pareto", title, caption, "pareto", mass, margin, study.outcome, study.position)


def _edge(study: StudyColumns) -> str:
    lost = np.isin(study.outcome, ("refused", "crashed")).any()
    return " Points that were refused or crashed have a mark at the edge." if lost else ""


def _differ(values: Real) -> bool:
    return np.unique(values[np.isfinite(values)]).size > 1


def _marked(study: StudyColumns) -> str:
    count = len(study.outcome)
    return f" At most {MOST_MARKS} of the {count} points are drawn, chosen at random." if count > MOST_MARKS else ""
