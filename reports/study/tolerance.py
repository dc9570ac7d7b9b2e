"""A case under its tolerances, for the terminal and as plain data."""

import json
import math
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from alula.fea.tolerance.result import Probability, ToleranceNumber, ToleranceResult
from alula.geometry.base.version import result_stamp
from alula.reports.tables.data import entries, finite
from alula.reports.words.numbers import number
from alula.reports.words.terminal import say, say_table
from alula.reports.words.wording import besides

if TYPE_CHECKING:
    from rich.console import Console

SHARES = (1.0, 50.0, 99.0)
MOST = 8
"""Tolerances that the table names."""


def as_json(result: ToleranceResult) -> str:
    """Return the result as JSON: percentiles in place of samples.

    Parameters
    ----------
    result : ToleranceResult

    Returns
    -------
    str
    """
    names = "check subject load_case quantity unit limit at_least nominal"
    record: dict[str, Any] = {
        "case": result.nominal.name,
        "samples": result.samples,
        "seed": result.seed,
        "every_check_passes": {"certain": _probability(result.certain), "possible": _probability(result.possible)},
        "does_not_assemble": _probability(result.apart),
        "dead_point": _probability(result.dead),
        "tolerances": list(result.tolerances),
        "numbers": [
            entries(one, names)
            | {
                "percentiles": {
                    f"{share:g}": p for share, p in zip(_ALL, one.percentiles(*_ALL).tolist(), strict=True)
                },
                "certain": None if one.certain is None else _probability(one.certain),
                "possible": None if one.possible is None else _probability(one.possible),
                "first_order": one.first.tolist(),
                "total": one.total.tolist(),
            }
            for one in result.numbers
        ],
        "corner": None if result.corner is None else entries(result.corner, "number value low high deviations"),
        "left_out": list(result.left_out),
        "notes": list(result.notes),
        "caveats": [entries(one, "heading topic what why") for one in result.caveats],
        "timings": dict(result.timings),
    }
    nulls: dict[str, str] = {}
    record = finite(record, nulls)
    return json.dumps(result_stamp() | record | {"nulls": nulls}, indent=2, ensure_ascii=False, allow_nan=False)


_ALL = (0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0, 99.9)


def _probability(found: Probability) -> dict[str, Any]:
    return entries(found, "value low high count samples")


def print_tolerance(result: ToleranceResult, console: "Console") -> None:
    """Print the result.

    Parameters
    ----------
    result : ToleranceResult
    console : Console
    """
    titles = (
        ("number", False),
        ("subject", False),
        ("unit", False),
        ("nominal", True),
        ("1 %", True),
        ("median", True),
        ("99 %", True),
    )
    columns = (*titles, ("limit", True), ("passes", True))
    several = len(result.nominal.load_cases) > 1
    alike = Counter((one.quantity, one.subject, one.load_case) for one in result.numbers)
    rows = [
        (
            one.quantity if alike[one.quantity, one.subject, one.load_case] == 1 else f"{one.check}: {one.quantity}",
            one.subject + (f", {one.load_case}" if several else ""),
            "" if one.unit == "1" else one.unit,
            number(one.nominal[0], 3),
            *(number(value, 3) for value in one.percentiles(*SHARES).tolist()),
            "" if math.isnan(one.limit) else f"{'≥' if one.at_least else '≤'} {one.limit:g}",
            "" if one.certain is None or one.possible is None else _between(one.certain, one.possible),
        )
        for one in result.numbers
    ]
    say_table(console, columns, rows, title=f"{result.samples:,} samples of {len(result.tolerances)} tolerances")
    say(console, "")
    every = "Every check that is covered" if result.left_out else "Every check"
    say(console, f"{every} passes with a probability of {_interval(result.certain)}.")
    if result.possible.count > result.certain.count:
        undecided = "with the samples whose bands hold a limit, which are undecided"
        say(console, f"{every} passes possibly with {_interval(result.possible)}, {undecided}.")
    _say_what_matters(result, console)
    _say_corner(result, console)
    for note in result.notes:
        say(console, f"Note: {note}.")
    if left := besides(result.caveats):
        say(console, left)


def _between(certain: Probability, possible: Probability) -> str:
    low, high = _percent(certain.value), _percent(possible.value)
    return low if low == high else f"{low} to {high}"


def _percent(share: float) -> str:
    text = f"{100.0 * share:.2f}"
    if (text == "100.00" and share < 1.0) or (text == "0.00" and share > 0.0):
        return f"{'>' if share > 0.5 else '<'} {'99.99' if share > 0.5 else '0.01'} %"
    return f"{text.rstrip('0').rstrip('.')} %"


def _interval(found: Probability) -> str:
    return f"{_percent(found.value)} (95 % confidence: {_percent(found.low)} to {_percent(found.high)})"


def _closest(result: ToleranceResult) -> ToleranceNumber | None:
    return None if result.corner is None else result.numbers[result.corner.number]


def _say_what_matters(result: ToleranceResult, console: "Console") -> None:
    """Print the Sobol' indices of the check closest to its limit and of the drive."""
    closest = _closest(result)
    shown = [one for one in result.numbers if one is closest or one.certain is None]
    for one in (one for one in shown if np.isfinite(one.total).any()):
        order = [i for i in np.argsort(-one.total).tolist() if one.total[i] >= 0.005][:MOST]
        title = f"What matters for the {one.title} (Sobol' indices, shares of its variance)"
        rows = [(result.tolerances[i], f"{max(one.first[i], 0.0):.2f}", f"{one.total[i]:.2f}") for i in order]
        say_table(console, (("tolerance", False), ("by itself", True), ("in all", True)), rows, title=title)


def _say_corner(result: ToleranceResult, console: "Console") -> None:
    corner, closest = result.corner, _closest(result)
    if corner is None or closest is None:
        return
    what = f"the {closest.title}"
    if math.isnan(corner.value):
        say(console, f"Worst corner for {what}: the linkage has no equilibrium there.")
    else:
        unit = "" if closest.unit == "1" else f" {closest.unit}"
        ends = f"{number(corner.value, 3)} ({number(corner.low, 3)} to {number(corner.high, 3)}){unit}"
        say(console, f"Worst corner for {what}: {ends}, all tolerances at their worse ends.")
