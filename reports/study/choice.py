"""Which pictures a study gets, by what varies in it, and how each is to be read."""

import itertools
from collections.abc import Callable, Iterator, Sequence
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
        if few:
            yield from _over(study, quantities, named, panels, response, ending)
        elif len(study.parameters) > 1:
            yield _sensitivities(study, response, ending)
        if response is not study.margin:
            caption = "Over all points that have the number."
            drawn = _later("histogram", response.value, label=response.label, outcome=study.outcome)
            yield _shown(f"histogram{ending}", f"Distribution: {response.label}", caption, drawn)
    if not few:
        yield _parallel(study)
    margin = study.margin
    if margin is not None and margin.limit == 1.0 and np.isfinite(margin.value).any():
        caption = (
            "How often the nearest check keeps its limit by which factor. A bar left of the limit holds points whose "
            "value misses it; the verdict is decided on the whole band."
        )
        drawn = _later("histogram", margin.value, margin.limit, label=margin.label, outcome=study.outcome)
        yield _shown("margins", "Distribution of the least margin", caption, drawn)
    yield from _pareto(study)
    notes = []
    if not study.responses:
        notes.append("No number varies between the points that have one, so that nothing is drawn over the entries.")
    if study.left_out:
        notes.append(f"{study.left_out} more numbers vary; --number with a part of a name draws others.")
    if notes:
        yield Section(key="not-drawn", title="Not drawn", parts=tuple(Text(note, "note") for note in notes))


def _shown(name: str, title: str, caption: str, draw: Callable[[], Any], *above: Part) -> Section:
    picture = Picture(name=name, alt=title, caption=caption, draw=draw)
    return Section(key=name, title=title, short=title, parts=(*above, picture))


def _later(figure: str, *args: Any, **options: Any) -> Callable[[], Any]:
    """Return what draws a picture when it is wanted: what draws is imported then."""

    def draw() -> Any:
        from alula.reports.figures.study import curves, many, maps, spread, style

        drawing: dict[str, Callable[..., Any]] = {
            "curve": curves.curves,
            "map": maps.verdict_map,
            "values": many.categories,
            "parallel": many.parallel,
            "pareto": many.pareto,
            "histogram": spread.histogram,
            "tornado": spread.tornado,
        }
        return style.chart(drawing[figure](*args, **options))

    return draw


def _panels(named: Sequence[Parameter], count: int) -> list[tuple[str, Any]]:
    """One panel for every combination of words that some point has: its title, and which points stand in it."""
    found = []
    for places in itertools.islice(itertools.product(*(range(len(one.words)) for one in named)), 10_000):
        here = np.ones(count, dtype=bool)
        for one, place in zip(named, places, strict=True):
            here &= one.values == place
        if here.any():
            found.append((", ".join(one.words[place] for one, place in zip(named, places, strict=True)), here))
    return found


def _over(
    study: StudyColumns,
    quantities: Sequence[Parameter],
    named: Sequence[Parameter],
    panels: list[tuple[str, Any]],
    response: Response,
    ending: str,
) -> Iterator[Section]:
    """The number over one or two quantities, or over words alone."""
    together = " and ".join(one.path for one in named)
    verdicts, lost = study.margin is not None, bool(np.isin(study.outcome, ("refused", "crashed")).any())
    edge = " Points that were refused or crashed have a mark at the edge." if lost else ""
    each = f" One panel for each value of {together}." if named else ""
    each += _marked(study)
    if not quantities:
        if not (named and len(study.outcome) == len(panels)):
            return
        order = np.array([int(np.flatnonzero(here)[0]) for _, here in panels])
        shown = replace(response, value=response.value[order], low=response.low[order], high=response.high[order])
        label = ", ".join(one.path for one in named)
        drawn = _later("values", [name for name, _ in panels], shown, study.outcome[order], label=label)
        caption = f"The bar is the band that may hold the value.{edge}"
        yield _shown(f"values{ending}", f"{response.title} by {together}", caption, drawn)
        return
    panels = [(name, marked(here, MOST_MARKS // len(panels))) for name, here in panels]
    if len(quantities) == 1:
        wide = bool(np.any(response.low < response.high))
        band = " The shaded band may hold the value; bands that end far away are cut off." if wide else ""
        caption = f"A mark is a point.{' Marks and colours are verdicts.' if verdicts else ''}{band}{edge}{each}"
        drawn = _later("curve", quantities[0], response, study.outcome, panels)
        yield _shown(f"curve{ending}", f"{response.title} over {quantities[0].path}", caption, drawn)
        return
    least = response is study.margin
    what = "the least margin (1 at the limit, a thick line)" if least else response.label
    lines = f" Lines are contours of {what}, interpolated linearly between the values of neighbouring points."
    caption = f"A mark is a point{', its shape and colour the verdict' if verdicts else ''}."
    caption += f"{lines if np.isfinite(response.value).any() else ''}{each}"
    title = f"{'Verdict' if least else response.title} over {quantities[0].path} and {quantities[1].path}"
    drawn = _later("map", (quantities[0], quantities[1]), response, study.outcome, panels)
    yield _shown(f"map{ending}", title, caption, drawn)


def _sensitivities(study: StudyColumns, response: Response, ending: str) -> Section:
    """What a number depends on, by regression."""
    name, title = f"sensitivity{ending}", f"{response.title}: what it depends on"
    found = regression(study.parameters, response)
    if isinstance(found, str):
        return Section(key=name, title=title, parts=(Text(found),))
    fitted = say(
        "A linear model of {what}, fitted to {points} points, holds R² = {share} of its variance{doubt}",
        what="the logarithm of the number" if found.logarithm else "the number",
        points=found.points,
        share=Number(found.r_squared, decimals=2),
        doubt=", so that the coefficients say little" if found.r_squared < 0.5 else "",
    )
    sizes = found.coefficients.tolist()
    order = sorted(range(len(sizes)), key=lambda i: -abs(sizes[i]))
    table = Table(
        key=name,
        columns=(words("entry"), Column("standardised coefficient")),
        rows=tuple((found.names[i], Number(sizes[i], decimals=2)) for i in order),
    )
    caption = (
        "A bar is the standardised coefficient: by how many standard deviations the number moves where the entry moves "
        "by one of its own. It speaks of the ranges of this study."
    )
    if any(found.unsigned):
        caption += " Entries that are words have dotted bars without direction."
    label = f"standardised coefficient of {response.label.partition(' (')[0]} (linear, R² = {fitted.numbers[0]})"
    drawn = _later("tornado", found.names, found.coefficients, label=label, unsigned=found.unsigned)
    return _shown(name, title, caption, drawn, fitted, table)


def _parallel(study: StudyColumns) -> Section:
    more, count = list(study.responses), len(study.outcome)
    if study.mass is not None and _differ(study.mass):
        more.append(Response(label="mass [g]", value=study.mass, low=study.mass, high=study.mass))
    part = f" {MOST_LINES} of {count} points are drawn, evenly through the study." if count > MOST_LINES else ""
    limit = " The thick stroke is the limit." if study.margin is not None else ""
    caption = f"A line is a point; it ends where a number is not known.{limit}{part}"
    drawn = _later("parallel", study.parameters, more, study.outcome)
    return _shown("parallel", "All points in parallel coordinates", caption, drawn)


def _pareto(study: StudyColumns) -> Iterator[Section]:
    over = study.safety_factor or study.margin
    if study.mass is None or over is None:
        return
    known = np.isfinite(study.mass) & np.isfinite(over.value)
    if not _differ(study.mass[known]):
        return
    caption = (
        "Numbers are those of points on the front: no other point is lighter with as high a lower end of its band. "
        "Points that fail are left out of it."
    )
    if not (study.outcome[known] != Verdict.FAIL.value).any():
        caption = "Every point fails, so that there is no front."
    caption += _marked(study).replace("drawn,", "drawn besides the front,")
    drawn = _later("pareto", study.mass, over, study.outcome, study.position)
    yield _shown("pareto", f"Mass and {over.label.partition(' (')[0]}", caption, drawn)


def _differ(values: Real) -> bool:
    return np.unique(values[np.isfinite(values)]).size > 1


def _marked(study: StudyColumns) -> str:
    count = len(study.outcome)
    return f" At most {MOST_MARKS} of the {count} points are drawn, chosen at random." if count > MOST_MARKS else ""
