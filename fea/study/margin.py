"""How far a variant is from its limits, and which check is the nearest to its own."""

import math

from fea.common.verdict import Quantity, Sense
from fea.study.numbers import VariantNumber, VariantResult


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
    return next(quantity.sense for quantity in Quantity if quantity.value == number.quantity)


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
    if number.quantity == Quantity.LOAD_SHARE.value and number.low >= number.limit:
        return math.inf
    at_least = sense_of(number) is Sense.AT_LEAST
    end = (number.low if at_least else number.high) if worst else number.value
    over, under = (end, number.limit) if at_least else (number.limit, end)
    if math.isnan(over) or math.isnan(under):
        return 0.0
    return over / under if under > 0.0 else math.inf


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
        By the worse ends of the bands; by the values otherwise.

    Returns
    -------
    VariantNumber or None
        None where nothing was checked.
    """
    checked = [number for number in result.numbers if number.check]
    return min(checked, key=lambda number: margin(number, worst=worst), default=None)
