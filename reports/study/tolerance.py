"""A case under its tolerances: how its numbers spread, how likely they pass, what matters, and the worst corner."""

import math
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from alula.fea.common.band import Band
from alula.fea.tolerance.result import Probability, ToleranceNumber, ToleranceResult
from alula.reports.page.provenance import provenance_section
from alula.reports.sections.data import entries
from alula.reports.sections.section import Cell, Column, Number, Section, Table, Text, say, words
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import besides
from alula.reports.study.rows import shown_unit
from alula.reports.words.numbers import sentence

MOST = 8
"""Tolerances that a table names."""
_ALL = (0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9)


def names(result: ToleranceResult) -> tuple[str, ...]:
    """Return the names of all numbers: quantity, subject and load case, and the check where two ask the same.

    Parameters
    ----------
    result : ToleranceResult

    Returns
    -------
    tuple of str
    """
    found = [one.title + (f", {one.load_case}" if one.load_case else "") for one in result.numbers]
    alike = Counter(found)
    return tuple(
        f"{one.check}: {name}" if alike[name] > 1 else name for one, name in zip(result.numbers, found, strict=True)
    )


def tolerance_sections(result: ToleranceResult) -> tuple[Section, ...]:
    """Return what is told of a case under its tolerances.

    Parameters
    ----------
    result : ToleranceResult

    Returns
    -------
    tuple of Section
    """
    return (
        Section(
            key="numbers",
            title=f"{result.samples:,} samples of {len(result.tolerances)} tolerances",
            short="Numbers",
            parts=(_numbers(result),),
            data=_record(result),
        ),
        Section(key="passes", title="Probability", short="Probability", parts=tuple(_passes(result))),
        Section(key="causes", title="What matters", short="What matters", parts=tuple(_causes(result))),
        Section(key="notes", title="Not covered", short="Not covered", parts=tuple(_notes(result))),
        provenance_section(result.nominal.case),
    )


def _numbers(result: ToleranceResult) -> Table:
    columns = [words("number"), words("unit")]
    columns += map(Column, ("nominal", "1 %", "median", "99 %", "limit", "passes", "passes possibly"))

    def cells(name: str, one: ToleranceNumber) -> tuple[Cell, ...]:
        sense = "≥" if one.at_least else "≤"
        return (
            name,
            shown_unit(one),
            *(Number(value, digits=3) for value in (one.nominal[0], *one.percentiles(1.0, 50.0, 99.0).tolist())),
            "" if math.isnan(one.limit) else Number(one.limit, stated=True, sense=sense),
            *("" if found is None else Number(found.value, probable=True) for found in (one.certain, one.possible)),
        )

    return Table(key="numbers", columns=tuple(columns), rows=tuple(map(cells, names(result), result.numbers)))


def _passes(result: ToleranceResult) -> Iterator[Text]:
    every = "every check that is covered" if result.left_out else "every check"
    yield _likely(f"{every} passes with a probability of", result.certain)
    if result.possible.count > result.certain.count:
        ending = ", with the samples whose bands hold a limit, which are undecided"
        yield _likely(f"{every} passes possibly with", result.possible, ending)
    corner = result.corner
    if corner is None:
        return
    closest = result.numbers[corner.number]
    what = f"worst corner for the {closest.title}"
    if math.isnan(corner.value):
        yield say("{what}: the linkage has no equilibrium there", what=what)
    else:
        value = Number(Band(value=corner.value, low=corner.low, high=corner.high), shown_unit(closest))
        yield say("{what}: {value}, all tolerances at their worse ends", what=what, value=value)


def _likely(what: str, found: Probability, ending: str = "") -> Text:
    ends = {end: Number(getattr(found, end), probable=True) for end in ("value", "low", "high")}
    return say(f"{what} {{value}} (95 % confidence: {{low}} to {{high}}){ending}", **ends)


def _causes(result: ToleranceResult) -> Iterator[Table]:
    """The Sobol' indices of the check closest to its limit and of the drive."""
    closest = None if result.corner is None else result.numbers[result.corner.number]
    for name, one in zip(names(result), result.numbers, strict=True):
        if (one is not closest and one.certain is not None) or not np.isfinite(one.total).any():
            continue
        order = [i for i in np.argsort(-one.total).tolist() if one.total[i] >= 0.005][:MOST]
        first, total = np.maximum(one.first, 0.0), one.total
        yield Table(
            key="causes",
            columns=(words("tolerance"), Column("by itself"), Column("in all")),
            rows=tuple(
                (result.tolerances[i], *(Number(float(share[i]), decimals=2) for share in (first, total)))
                for i in order
            ),
            caption=f"Sobol' indices of the {one.title}, shares of its variance",
            under=(("number", name),),
        )


def _notes(result: ToleranceResult) -> Iterator[Text]:
    for note in result.notes:
        yield Text(sentence(told(note)))
    if left := besides(result.caveats):
        yield Text(left)


def _record(result: ToleranceResult) -> dict[str, Any]:
    """Percentiles in place of samples."""
    fields = "check subject load_case quantity unit limit at_least nominal"
    return {
        "every_check_passes": {"certain": _probability(result.certain), "possible": _probability(result.possible)},
        "does_not_assemble": _probability(result.apart),
        "dead_point": _probability(result.dead),
        "tolerances": list(result.tolerances),
        "numbers": [
            entries(one, fields)
            | {
                "percentiles": dict(zip(map("{:g}".format, _ALL), one.percentiles(*_ALL).tolist(), strict=True)),
                "certain": _probability(one.certain),
                "possible": _probability(one.possible),
                "first_order": one.first.tolist(),
                "total": one.total.tolist(),
            }
            for one in result.numbers
        ],
        "corner": None if result.corner is None else entries(result.corner, "number value low high deviations"),
        "left_out": [told(one) for one in result.left_out],
        "notes": [told(note) for note in result.notes],
        "caveats": [entries(one, "heading topic what why") for one in result.caveats],
        "timings": dict(result.timings),
    }


def _probability(found: Probability | None) -> dict[str, Any] | None:
    return None if found is None else entries(found, "value low high count samples")
