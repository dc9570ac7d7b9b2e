"""Pictures of a case under its tolerances: how its numbers spread about their limits, and what makes them spread."""

import math
import re

import numpy as np

from alula.fea.tolerance.result import ToleranceNumber, ToleranceResult
from alula.reports.figures.sheet.chart import Chart
from alula.reports.figures.study.spread import histogram, tornado
from alula.reports.figures.study.style import chart

MOST = 6
"""Numbers that are drawn: those that come nearest to their limits."""


def tolerance_pictures(result: ToleranceResult) -> dict[str, Chart]:
    """Draw the numbers of a case under its tolerances.

    Parameters
    ----------
    result : ToleranceResult

    Returns
    -------
    dict of str to Chart
        By the name of the file: a histogram of each number that comes nearest to its limit and of the drive torque,
        with the indices of its tolerances where they are known.
    """
    asked = [one for one in result.numbers if one.certain is not None and not math.isnan(one.closeness)]
    nearest = sorted(asked, key=lambda one: -one.closeness)[:MOST]
    drawn = [*nearest, *(one for one in result.numbers if one.certain is None)]
    found: dict[str, Chart] = {}
    for one in drawn:
        name = _file_name(one)
        found[f"spread-{name}.png"] = spread_picture(one)
        if np.isfinite(one.total).any() and len(result.tolerances) > 1:
            label = f"Sobol' index of the {one.title}"
            texts = "by itself", "in all"
            found[f"causes-{name}.png"] = chart(
                tornado(
                    result.tolerances, one.first, one.total, label=label, texts=texts, unsigned=[True] * len(one.total)
                )
            )
    return found


def spread_picture(one: ToleranceNumber) -> Chart:
    """Draw how a number spreads over the samples.

    Parameters
    ----------
    one : ToleranceNumber

    Returns
    -------
    Chart
        A histogram, with the limit and the verdicts where something is asked of the number.
    """
    outcome = None if one.certain is None else _outcomes(one)
    return chart(
        histogram(one.values, one.limit, label=_title(one), outcome=outcome, at_least=one.at_least, counted="samples")
    )


def _outcomes(one: ToleranceNumber) -> "np.ndarray[tuple[int], np.dtype[np.str_]]":
    """The verdict of each sample over its whole band; one without equilibrium fails."""
    if one.at_least:
        kept, missed = one.low >= one.limit, one.high < one.limit
    else:
        kept, missed = one.high <= one.limit, one.low > one.limit
    lost = ~np.isfinite(one.values)
    return np.select([missed | lost, kept], ["fail", "pass"], "undecided")


def _title(one: ToleranceNumber) -> str:
    unit = "" if one.unit in ("", "1") else f" [{one.unit}]"
    return one.title + (f", {one.load_case}" if one.load_case else "") + unit


def _file_name(one: ToleranceNumber) -> str:
    return re.sub(r"[^\w-]+", "-", f"{one.check or one.quantity}-{one.subject}-{one.load_case}").strip("-")
