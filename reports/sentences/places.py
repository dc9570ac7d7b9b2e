"""How facts are written in the places of a sentence: what follows the colon, such as ``{share:percent}``.

=====================  ==================================================================================
``4``                  four significant digits
``short3``             three at most
``share2``             a share in percent, with two digits at most
``fixed2``             two decimals
``span3``              a pair of numbers with ``short3``, ``2.5 to 3``; one number where they are equal
``percent``            as of ``words.numbers``; so ``plain`` and ``ordinal``
``banded``, ``stated`` three digits without a power of ten, of a band and of a number
``directions``         of a share of kinetic energy in the plane: ``mostly in the plane``
``and``                a list as ``a, b and c``
``&``, ``;``, ``+``    a list with ``and``, a semicolon, or nothing between; after it, how each is written
``|s``, ``is|are``     words for one and for several: of a list, a whole number, or something true or false
``?, at {pose}|.``     words that stand where there is the fact; after the stroke, those where there is none
=====================  ==================================================================================

Other lists have commas between, each of them written by itself. A band is written with its ends; nothing stands in the
place of a fact that there is not.
"""

import math
import string
from collections.abc import Callable
from typing import Any

from alula.fea.common.band import Band
from alula.reports.words.numbers import band, fixed, joined, number, ordinal, percent, plain, short

_BETWEEN = {"&": " and ", ";": "; ", "+": ""}


def directions(in_plane: float) -> str:
    """Say in which directions a shape moves.

    Parameters
    ----------
    in_plane : float
        Share of its kinetic energy in the plane of the linkage.

    Returns
    -------
    str
    """
    if in_plane > 0.9:
        return "in the plane"
    if in_plane < 0.1:
        return "out of the plane"
    return "mostly in the plane" if in_plane >= 0.5 else "mostly out of the plane"


def _banded(value: Band) -> str:
    """Return ``43.2 (38.0 to 47.0)``, without powers of ten."""
    if math.isinf(value.high):
        return f"{_three(value.value)} (no band)" if math.isfinite(value.value) else "unknown"
    shown, low, high = (_three(end) for end in (value.value, value.low, value.high))
    return shown if low == high else f"{shown} ({low} to {high})"


def _three(value: float) -> str:
    """Return a number with three digits, and without a power of ten."""
    return f"{value:#.3g}".rstrip(".") if value < 999.5 else _stated(value)


def _stated(value: float) -> str:
    """Return a stated number with three digits, without padding zeros."""
    return f"{float(f'{value:.3g}'):g}"


_NAMED: dict[str, Callable[[Any], str]] = {
    "percent": percent,
    "plain": plain,
    "ordinal": ordinal,
    "banded": _banded,
    "stated": _stated,
    "directions": directions,
}
_WITH_DIGITS: dict[str, Callable[[Any, int], str]] = {
    "short": short,
    "fixed": fixed,
    "share": lambda value, digits: f"{short(100.0 * value, digits)} %",
    "span": lambda ends, digits: " to ".join(short(end, digits) for end in dict.fromkeys(ends)),
}


class FactFormatter(string.Formatter):
    """Writes facts in the places of a sentence."""

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return a fact as text.

        Parameters
        ----------
        value : object
        format_spec : str
            As above.

        Returns
        -------
        str
        """
        if format_spec.startswith("?"):
            there, _, missing = format_spec[1:].partition("|")
            return missing if value is None or value in ("", ()) else there
        if "|" in format_spec:
            one, several = format_spec.split("|")
            return one if (len(value) if isinstance(value, tuple) else value) == 1 else several
        if value is None:
            return ""
        name, digits = format_spec.rstrip("0123456789"), format_spec.lstrip(string.ascii_letters)
        if name == "span":
            return _WITH_DIGITS[name](value, int(digits))
        if isinstance(value, tuple):
            return self._listed(value, format_spec)
        if isinstance(value, Band) and format_spec not in _NAMED:
            return band(value, int(format_spec) if format_spec.isdigit() else 3)
        if format_spec.isdigit():
            return number(value, int(digits))
        if name in _WITH_DIGITS:
            return _WITH_DIGITS[name](value, int(digits))
        return _NAMED[format_spec](value) if format_spec in _NAMED else format(value, format_spec)

    def _listed(self, every: tuple[Any, ...], how: str) -> str:
        if how == "and":
            return joined(every)
        between = _BETWEEN.get(how[:1], ", ")
        return between.join(self.format_field(one, how.lstrip("&;+")) for one in every)
