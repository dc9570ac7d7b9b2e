"""Which pictures a study gets, by what varies in it."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure

from alula.fea.common.verdict import Verdict
from alula.reports.figures.study.curves import Panel, curves
from alula.reports.figures.study.many import MOST_LINES, categories, parallel, pareto
from alula.reports.figures.study.maps import verdict_map
from alula.reports.figures.study.spread import histogram, tornado
from alula.reports.figures.study.style import MOST_MARKS, marked, png
from alula.reports.study.columns import Parameter, Response, StudyColumns
from alula.reports.study.regression import regression

MOST_PANELS = 6
"""Combinations of words that have a panel each; with more of them the study is drawn in parallel coordinates."""
MOST_COMBINATIONS = 40
"""Combinations of words that stand below each other in one picture."""


_Drawn = tuple[str, str, str, Figure]


@dataclass(frozen=True, kw_only=True)
class StudyPicture:
    """A picture of a page.

    Attributes
    ----------
    name : str
        Of its file, without ``.png``.
    title : str
    caption : str
    png : bytes
    """

    name: str
    title: str
    caption: str
    png: bytes


def pictures(study: StudyColumns) -> tuple[tuple[StudyPicture, ...], tuple[str, ...]]:
    """Draw the pictures of a study.

    Parameters
    ----------
    study : StudyColumns

    Returns
    -------
    tuple of StudyPicture
    tuple of str
        Sentences on what cannot be drawn.
    """
    found, notes = [], []
    for one in chosen(study):
        if isinstance(one, str):
            notes.append(one)
        else:
            name, title, caption, figure = one
            found.append(StudyPicture(name=name, title=title, caption=caption, png=png(figure)))
    return tuple(found), tuple(dict.fromkeys(notes))


def chosen(study: StudyColumns) -> Iterator[_Drawn | str]:
    """Yield the pictures of a study, by what varies in it.

    Parameters
    ----------
    study : StudyColumns

    Yields
    ------
    tuple or str
        Name, title, caption and figure; or a sentence on what cannot be drawn.
    """
    quantities = [one for one in study.parameters if not one.words]
    words = [one for one in study.parameters if one.words]
    panels = _panels(words, len(study.outcome))
    few = len(quantities) <= 2 and len(panels) <= (MOST_PANELS if quantities else MOST_COMBINATIONS)
    if not study.responses:
        yield "No number varies between the points that have one, so that there is nothing to draw over the entries."
    for i, response in enumerate(study.responses):
        ending = "" if i == 0 else f"-{i + 1}"
        if few:
            yield from _over(study, quantities, words, panels, response, ending)
        elif len(study.parameters) > 1:
            yield from _sensitivities(study, response, ending)
        if response is not study.margin:
            shown = replace(response, limit=np.nan)
            yield (f"histogram{ending}", f"Distribution: {response.label}", "Over all points that have the number.",
                   histogram(shown.value, label=response.label, outcome=study.outcome))  # fmt: skip
    if not few:
        yield _parallel(study)
    margin = study.margin
    if margin is not None and margin.limit == 1.0 and np.isfinite(margin.value).any():
        yield (
            "margins",
            "Distribution of the least margin",
            "How often the nearest check keeps its limit by which factor. A bar left of the limit holds points whose "
            "value misses it; the verdict is decided on the whole band.",
            histogram(margin.value, margin.limit, label=margin.label, outcome=study.outcome),
        )
    yield from _pareto(study)


def _panels(words: list[Parameter], count: int) -> list[Panel]:
    """One panel for every combination of words that some point has."""
    found: list[Panel] = []
    for places in itertools.islice(itertools.product(*(range(len(one.words)) for one in words)), 10_000):
        here = np.ones(count, dtype=bool)
        for one, place in zip(words, places, strict=True):
            here &= one.values == place
        if here.any():
            found.append((", ".join(one.words[place] for one, place in zip(words, places, strict=True)), here))
    return found


def _over(
    study: StudyColumns,
    quantities: list[Parameter],
    words: list[Parameter],
    panels: list[Panel],
    response: Response,
    ending: str,
) -> Iterator[_Drawn]:
    """The number over one or two quantities, or over words alone."""
    names = [one.path for one in quantities]
    each = f" One panel for each value of {' and '.join(one.path for one in words)}." if words else ""
    verdicts = study.margin is not None
    lost = " Points that were refused or crashed have a mark at the edge." if _lost(study) else ""
    each += _marked(study) if quantities else ""
    panels = [(name, marked(here, MOST_MARKS // len(panels))) for name, here in panels]
    if len(quantities) == 1:
        band = " The shaded band may hold the value; bands that end far away are cut off." if _wide(response) else ""
        colours = " Marks and colours are verdicts." if verdicts else ""
        caption = f"A mark is a point.{colours}{band}{lost}{each}"
        yield (f"curve{ending}", f"{_title(response)} over {names[0]}", caption,
               curves(quantities[0], response, study.outcome, panels))  # fmt: skip
    elif len(quantities) == 2:
        title = f"{'Verdict' if response is study.margin else _title(response)} over {names[0]} and {names[1]}"
        what = "the least margin (1 at the limit, a thick line)" if response is study.margin else response.label
        lines = f" Lines are contours of {what}, interpolated linearly between the values of neighbouring points."
        caption = (
            f"A mark is a point{', its shape and colour the verdict' if verdicts else ''}."
            f"{lines if np.isfinite(response.value).any() else ''}{each}"
        )
        drawn = verdict_map((quantities[0], quantities[1]), response, study.outcome, panels)
        yield f"map{ending}", title, caption, drawn
    elif words and len(study.outcome) == len(panels):
        order = np.array([int(np.flatnonzero(here)[0]) for _, here in panels])
        shown = replace(response, value=response.value[order], low=response.low[order], high=response.high[order])
        yield (f"values{ending}", f"{_title(response)} by {' and '.join(one.path for one in words)}",
               f"The bar is the band that may hold the value.{lost}",
               categories([name for name, _ in panels], shown, study.outcome[order],
                          label=", ".join(one.path for one in words)))  # fmt: skip


def _sensitivities(study: StudyColumns, response: Response, ending: str) -> Iterator[_Drawn | str]:
    found = regression(study.parameters, response)
    if isinstance(found, str):
        yield f"{_title(response)}: {found[:1].lower()}{found[1:]}"
        return
    what = "the logarithm of the number" if found.logarithm else "the number"
    caption = (
        f"A linear model of {what}, fitted to {found.points} points, holds R² = {found.r_squared:.2f} of its variance"
        f"{', so that the bars say little' if found.r_squared < 0.5 else ''}. A bar is the standardised coefficient: "
        "by how many standard deviations the number moves where the entry moves by one of its own. It speaks of the "
        "ranges of this study."
    )
    if any(found.unsigned):
        caption += " Entries that are words have dotted bars without direction."
    label = f"standardised coefficient of {response.label.partition(' (')[0]} (linear, R² = {found.r_squared:.2f})"
    drawn = tornado(found.names, found.coefficients, label=label, unsigned=found.unsigned)
    yield f"sensitivity{ending}", f"{_title(response)}: what it depends on", caption, drawn


def _parallel(study: StudyColumns) -> _Drawn:
    more = list(study.responses)
    if study.mass is not None and np.unique(study.mass[np.isfinite(study.mass)]).size > 1:
        more.append(Response(label="mass [g]", value=study.mass, low=study.mass, high=study.mass))
    count = len(study.outcome)
    part = f" {MOST_LINES} of {count} points are drawn, evenly through the study." if count > MOST_LINES else ""
    limit = " The thick stroke is the limit." if study.margin is not None else ""
    caption = f"A line is a point; it ends where a number is not known.{limit}{part}"
    return "parallel", "All points in parallel coordinates", caption, parallel(study.parameters, more, study.outcome)


def _pareto(study: StudyColumns) -> Iterator[_Drawn]:
    over = study.safety_factor or study.margin
    if study.mass is None or over is None:
        return
    known = np.isfinite(study.mass) & np.isfinite(over.value)
    if np.unique(study.mass[known]).size < 2:
        return
    caption = (
        "Numbers are those of points on the front: no other point is lighter with as high a lower end of its band. "
        "Points that fail are left out of it."
    )
    if not (study.outcome[known] != Verdict.FAIL.value).any():
        caption = "Every point fails, so that there is no front."
    caption += _marked(study).replace("drawn,", "drawn besides the front,")
    drawn = pareto(study.mass, over, study.outcome, study.position)
    yield "pareto", f"Mass and {over.label.partition(' (')[0]}", caption, drawn


def _marked(study: StudyColumns) -> str:
    count = len(study.outcome)
    return f" At most {MOST_MARKS} of the {count} points are drawn, chosen at random." if count > MOST_MARKS else ""


def _title(response: Response) -> str:
    text = response.label.partition(" (")[0]
    return text[:1].upper() + text[1:]


def _wide(response: Response) -> bool:
    return bool(np.any(response.low < response.high))


def _lost(study: StudyColumns) -> bool:
    return bool(np.isin(study.outcome, ("refused", "crashed")).any())
