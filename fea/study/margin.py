"""How far a variant is from its limits, and which check is the nearest to its own."""

import math

from alula.fea.common.verdict import Quantity, Sense
from alula.fea.study.numbers import VariantNumber, VariantResult


def sense_of(number: VariantNumber) -> Sense:
    """Return on which side of its limit a checked number must be.

    Parameters
    ----------
    number : VariantNumber
        Of a check.

    Returns
    -------
    Sense
    """
    return _quantity_of(number).sense


def _quantity_of(number: VariantNumber) -> Quantity:
    return next(quantity for quantity in Quantity if quantity.value == number.quantity)


def margin(number: VariantNumber, *, worst: bool = True) -> float:
    """Return by what factor a check keeps its limit: 1 at the limit.

    Parameters
    ----------
    number : VariantNumber
        Of a check.
    worst : bool
        With the worse end of its band; with its value otherwise.

    Returns
    -------
    float
        0 where the number is not known; infinite for a share of the load that is held in full, which says no more.
    """
    value, low, _ = margin_band(number)
    found = low if worst else value
    return 0.0 if math.isnan(found) else found


def margin_band(number: VariantNumber) -> tuple[float, float, float]:
    """Return the margin of a check with its band.

    Parameters
    ----------
    number : VariantNumber
        Of a check.

    Returns
    -------
    tuple of float
        Value, low and high, as ``Quantity.margins``.
    """
    return _quantity_of(number).margins(number.value, number.low, number.high, number.limit)


def least_margin(result: VariantResult) -> tuple[float, float, float]:
    """Return the least margin of all checks that apply: by the values, and the interval that it may lie in.

    The interval lies above 1 where all checks pass, below 1 where one fails, and holds 1 where values leave it open.

    Parameters
    ----------
    result : VariantResult
        With checks.

    Returns
    -------
    tuple of float
        Value, low and high; the value is NaN where that of a check is not known, which may be the least.
    """
    values, lows, highs = zip(
        *(margin_band(number) for number in result.numbers if number.verdict is not None), strict=True
    )
    return math.nan if any(map(math.isnan, values)) else min(values), min(lows), min(highs)


def counterpart(result: VariantResult, number: VariantNumber) -> VariantNumber | None:
    """Return the number of another variant that says the same of it.

    Parameters
    ----------
    result : VariantResult
        The other one.
    number : VariantNumber

    Returns
    -------
    VariantNumber or None
        None where it has none.
    """
    named = (number.check, number.subject, number.load_case, number.quantity)
    return next((n for n in result.numbers if (n.check, n.subject, n.load_case, n.quantity) == named), None)


def nearest(result: VariantResult, *, worst: bool = True) -> VariantNumber | None:
    """Return the check that is nearest to its limit, or farthest beyond.

    Parameters
    ----------
    result : VariantResult
    worst : bool
        By the worse ends of the bands, among the checks that make the verdict what it is; by the values of all checks
        otherwise.

    Returns
    -------
    VariantNumber or None
        None where nothing was checked.
    """
    checked = [number for number in result.numbers if number.verdict is not None]
    deciding = [number for number in checked if number.verdict is result.verdict] if worst else []
    return min(deciding or checked, key=lambda number: margin(number, worst=worst), default=None)
