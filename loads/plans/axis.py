"""One entry of a case that is varied: a list of values, or a range with its unit."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import BODY_WEIGHT, TYPOGRAPHY
from alula.loads.sources.quantity import UNIT, unit_of
from alula.loads.text.explain import printable

MOST_VALUES = 1_000_000
"""Values of one range."""
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_RANGE = re.compile(r"(?P<first>.+?)\.\.(?P<last>.+?)(?:\s+by\s+(?P<step>.*))?", re.DOTALL)
_STEP = re.compile(r"\s+by\s")
_FITS = 1e-6
"""Share of a step by which a range may miss a whole number of them."""


@dataclass(frozen=True, kw_only=True)
class Axis:
    """The values of one entry.

    Attributes
    ----------
    path : str
        The entry, as for ``--set``.
    values : tuple
        All of them, as a case file states them; empty for a range without count.
    ends : tuple of float
        First and last of a range, in its unit; NaN for a list.
    unit : str
        Of a range; "" for pure numbers.
    """

    path: str
    values: tuple[object, ...] = ()
    ends: tuple[float, float] = (math.nan, math.nan)
    unit: str = ""

    @property
    def is_range(self) -> bool:
        """True for a range, which has a value at every share of its length."""
        return not math.isnan(self.ends[0])

    def at(self, share: float) -> object:
        """Return the value at a share of the whole: of a range between its ends, of a list the one that lies there.

        Parameters
        ----------
        share : float
            From 0 up to, not including, 1.

        Returns
        -------
        object
            As a case file states it.
        """
        if not self.is_range:
            return self.values[int(share * len(self.values))]
        first, last = self.ends
        return self.stated(first + share * (last - first))

    def divided(self, steps: int) -> "Axis":
        """Return a range with the values at the ends of so many equal steps.

        Parameters
        ----------
        steps : int

        Returns
        -------
        Axis
        """
        first, last = self.ends
        return replace(self, values=tuple(self.stated(first + (last - first) * i / steps) for i in range(steps + 1)))

    def stated(self, number: float) -> object:
        """Return a number of the range's unit as a case file states it.

        Parameters
        ----------
        number : float
            In ``unit``.

        Returns
        -------
        str or float
            Twelve digits, so that 0.1 and 0.30000000000000004 - 0.2 are one value.
        """
        rounded = float(f"{number:.12g}")
        if self.unit:
            return f"{rounded!r} {self.unit}" if rounded % 1.0 else f"{int(rounded)} {self.unit}"
        return rounded


def axis(path: str, stated: object) -> Axis:
    """Read the values of an entry.

    Parameters
    ----------
    path : str
        The entry, as for ``--set``.
    stated : object
        A list of values, text that lists them with commas, or a range: ``"2 mm..8 mm/7"`` (seven values),
        ``"2 mm..8 mm by 1 mm"``, or ``"2 mm..8 mm"`` where a sample or a search chooses values.

    Returns
    -------
    Axis

    Raises
    ------
    CaseError
        For an empty list, a value twice, a range that turns round, and a step or a count that does not fit.
    """
    if isinstance(stated, str) and ".." in stated:
        return _range(path, stated)
    values: Sequence[object]
    if isinstance(stated, str):
        values = [text.strip() for text in stated.split(",")]
        values = [plain(text) for text in values if isinstance(text, str)]
    else:
        values = list(stated) if isinstance(stated, list | tuple) else [stated]
    if not values or "" in values:
        raise CaseError(f'{_named(path, stated)} a value is missing; write for example "2 mm, 3 mm"')
    if len(set(map(repr, values))) < len(values):
        raise CaseError(f"{_named(path, stated)} a value stands there twice; state each once")
    return Axis(path=path, values=tuple(values))


def _range(path: str, text: str) -> Axis:
    named = _named(path, text)
    ends, count = _without_count(text.translate(TYPOGRAPHY).strip())
    parts = _RANGE.fullmatch(ends)
    if parts is None:
        raise CaseError(f'{named} this is no range; write for example "2 mm..8 mm/7"')
    (first, unit), (last, other) = (_quantity(parts[end], named) for end in ("first", "last"))
    if not unit and other:  # "2..8 mm"
        unit = other
    last *= _factor(other, unit, named)
    if not last > first:
        raise CaseError(f"{named} its last value must be larger than its first; exchange or correct them")
    found = Axis(path=path, ends=(first, last), unit=unit)
    if count is not None:
        steps = _count(count, named) - 1
    elif parts["step"] is not None:
        size, of = _quantity(parts["step"], named)
        size *= _factor(of, unit, named)
        if not size > 0.0:
            raise CaseError(f"{named} the step must be greater than zero; make it larger")
        if size > (last - first) * (1.0 + _FITS):
            raise CaseError(f"{named} the step is longer than the range; make it smaller")
        steps = _steps((last - first) / size, named)
    else:
        return found
    return found.divided(steps)


def _without_count(text: str) -> tuple[str, str | None]:
    """Return a range, and what stands behind its last slash where that is no unit, as it is in N/mm."""
    ends, slash, last = text.rpartition("/")
    if slash and ".." in ends and not _STEP.search(text):
        try:
            unit_of(last.strip() or "?")
        except CaseError:
            return ends, last
    return text, None


def _quantity(text: str, named: str) -> tuple[float, str]:
    """Number and unit of a text such as ``2 mm``."""
    found = number_of(text)
    if found is None:
        raise CaseError(
            f"{named} '{printable(text.strip())}' is no number with a unit; write for example \"2 mm..8 mm/7\""
        )
    return found


def number_of(stated: object) -> tuple[float, str] | None:
    """Return number and unit of a value such as ``"2 mm"``.

    Parameters
    ----------
    stated : object
        As a case file states it.

    Returns
    -------
    tuple or None
        The unit is "" for a pure number; None for what is no finite number.
    """
    if isinstance(stated, int | float) and not isinstance(stated, bool):
        return (float(stated), "") if math.isfinite(stated) else None
    if not isinstance(stated, str):
        return None
    text = stated.strip()
    number = _NUMBER.match(text)
    unit = text[number.end() :].strip() if number else ""
    if number is None or (unit and not UNIT.fullmatch(_as_force(unit))) or not math.isfinite(float(number[0])):
        return None
    return float(number[0]), unit


def _factor(unit: str, to: str, named: str) -> float:
    """How many of one unit another is."""
    if unit == to:
        return 1.0
    (size, what), (other, expected) = unit_of(_as_force(unit)), unit_of(_as_force(to))
    if what != expected or (BODY_WEIGHT in unit) != (BODY_WEIGHT in to):  # how much a body weighs, the case says
        raise CaseError(f"{named} '{printable(unit) or 'no unit'}' and '{printable(to)}' differ in kind; use one unit")
    return size / other


def _as_force(unit: str) -> str:
    """Return a unit in which newton stands for the weight of the body."""
    return unit.replace(BODY_WEIGHT, "N", 1)


def _count(text: str, named: str) -> int:
    if not (text.strip().isascii() and text.strip().isdigit() and 2 <= int(text) <= MOST_VALUES):
        raise CaseError(f"{named} behind '/' stands how many values: a whole number from 2 to {MOST_VALUES}")
    return int(text)


def _steps(steps: float, named: str) -> int:
    if steps >= MOST_VALUES:
        raise CaseError(f"{named} the range has more than {MOST_VALUES} values; make the step larger")
    if abs(steps - round(steps)) > _FITS:
        raise CaseError(f"{named} the step does not divide the range into whole steps; correct the step or an end")
    return round(steps)


def plain(text: str) -> object:
    """Return what a word of a list or a table stands for.

    Parameters
    ----------
    text : str

    Returns
    -------
    object
        A number or a truth where it reads as one, else the text.
    """
    if text in ("true", "false"):
        return text == "true"
    if _NUMBER.fullmatch(text):
        return int(text) if text.lstrip("+-").isdigit() else float(text)
    return text


def _named(path: str, stated: object) -> str:
    return f"vary {printable(path)}: '{printable(str(stated))}':"
