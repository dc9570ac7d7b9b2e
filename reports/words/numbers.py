"""Numbers, bands and lists as text: the one way in which console, page, pictures and notebook write them."""

import math

import numpy as np

from alula.fea.common.band import Band

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_ROUNDING = 1e-12


def number(value: float, digits: int = 4, beside: float = 0.0) -> str:
    """Return a number with some significant digits; with a power of ten outside 1e-4 to 1e5.

    Parameters
    ----------
    value : float
    digits : int, optional
        Significant ones.
    beside : float, optional
        A number of which this one is a part: what is smaller than its rounding error is zero.

    Returns
    -------
    str
    """
    if math.isnan(value):
        return "not known"
    if math.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    if abs(value) <= _ROUNDING * abs(beside):
        return "0"
    if 1e-4 <= abs(value) < 1e5:
        exponent = math.floor(math.log10(float(f"{abs(value):.{digits - 1}e}")))
        text = f"{value:.{max(digits - 1 - exponent, 0)}f}"
    else:
        mantissa, _, exponent_text = f"{value:.{digits - 1}e}".partition("e")
        text = f"{mantissa}·10{str(int(exponent_text)).translate(_SUPERSCRIPT)}"
    return text.replace("-", "−")


def fixed(value: float, decimals: int) -> str:
    """Return a number with some decimals; zero has no sign.

    Parameters
    ----------
    value : float
    decimals : int

    Returns
    -------
    str
    """
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text.replace("-", "−")


def plain(value: float) -> str:
    """Return a stated number, such as a limit, without padding zeros.

    Parameters
    ----------
    value : float

    Returns
    -------
    str
    """
    return f"{value:g}".replace("-", "−")


def short(value: float, digits: int) -> str:
    """Return a number with some significant digits at most, without padding zeros.

    Parameters
    ----------
    value : float
    digits : int

    Returns
    -------
    str
    """
    text = f"{value:.{digits}g}"
    return text.replace("-", "−") if math.isfinite(value) and "e" not in text else number(value, digits)


def band(value: Band, digits: int = 3) -> str:
    """Return ``3.21 (2.44 to 3.21)``, the value alone where the band has no visible width, or ``3.21 (no band)``.

    Where only the low end is known it is ``at least 2.44``.

    Parameters
    ----------
    value : Band
    digits : int, optional
        Significant ones.

    Returns
    -------
    str
    """
    shown = number(value.value, digits)
    if value.without and not value.unknowable:
        return f"{shown} (no band)"
    if value.least_alone:
        return f"at least {shown}"
    low, high = number(value.low, digits), number(value.high, digits)
    return shown if low == high else f"{shown} ({low} to {high})"


def digits_beside(value: Band, limit: float) -> int:
    """Return with how many significant digits no number of a band is told as at a limit, or beyond it, that is not.

    Parameters
    ----------
    value : Band
    limit : float
        In its unit.

    Returns
    -------
    int
        From 3, as bands are told, to 17, with which all numbers that differ are told apart.
    """
    ends = [end for end in (value.value, value.low, value.high) if end != limit]
    digits = 3
    while digits < 17 and any((float(f"{end:.{digits - 1}e}") - limit) * (end - limit) <= 0.0 for end in ends):
        digits += 1
    return digits


def measured(value: Band, unit: str, digits: int = 3) -> str:
    """Return a band with its unit, which what is not known has not.

    Parameters
    ----------
    value : Band
    unit : str
        "" for a pure number.
    digits : int, optional
        Significant ones.

    Returns
    -------
    str
        Such as ``3.21 (2.44 to 3.21) mm``, or ``not known``.
    """
    return band(value, digits) if math.isnan(value.value) or not unit else f"{band(value, digits)} {unit}"


def limit_load(factor: Band) -> str:
    """Return a limit-load factor in words, such as ``limit-load factor at least 7.29``.

    Parameters
    ----------
    factor : Band

    Returns
    -------
    str
    """
    if factor.unknowable or not math.isinf(factor.high):
        return f"limit-load factor {band(factor)}"
    return f"limit-load factor at least {number(factor.low, 3)}"


def percent(ratio: float) -> str:
    """Return a ratio as a signed percentage.

    Parameters
    ----------
    ratio : float

    Returns
    -------
    str
    """
    text = f"{100.0 * ratio:+.1f}"
    return f"{text[1:] if float(text) == 0.0 else text} %".replace("-", "−")


def chance(share: float) -> str:
    """Return a probability as a percentage, which is 0 % or 100 % only where it is that exactly.

    Parameters
    ----------
    share : float
        From 0 to 1.

    Returns
    -------
    str
        Such as ``79.31 %`` or ``> 99.99 %``.
    """
    text = f"{100.0 * share:.2f}"
    if (text == "100.00" and share < 1.0) or (text == "0.00" and share > 0.0):
        return "> 99.99 %" if share > 0.5 else "< 0.01 %"
    return f"{text.rstrip('0').rstrip('.')} %"


def joined(words: tuple[str, ...] | list[str]) -> str:
    """Return ``a, b and c``.

    Parameters
    ----------
    words : tuple

    Returns
    -------
    str
    """
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def ordinal(n: int) -> str:
    """Return ``1st``, ``2nd``, ``3rd``, ``4th``.

    Parameters
    ----------
    n : int
        From 1 to 20.

    Returns
    -------
    str
    """
    return f"{n}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(n, 'th') }"


def turning(torque: float) -> str:
    """Return the sense of a torque about z.

    Parameters
    ----------
    torque : float
        Counter-clockwise positive.

    Returns
    -------
    str
    """
    return "none" if torque == 0.0 else "clockwise" if torque < 0.0 else "counter-clockwise"


def sentence(text: str) -> str:
    """Return a text that begins with a capital and ends with a full stop.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def direction(vector: tuple[float, float, float]) -> str:
    """Return a direction as a unit vector in words.

    Parameters
    ----------
    vector : tuple of 3 float
        Of any length.

    Returns
    -------
    str
        Such as ``(0.50, 0, 0.87)``.
    """
    unit = np.asarray(vector) / np.linalg.norm(vector)
    return f"({', '.join(fixed(float(x), 0 if abs(x - round(x)) < 5e-3 else 2) for x in unit)})"
