"""Numbers, bands and verdicts in words, for console and page alike."""

import math
from collections.abc import Sequence

from fea.common.band import Band
from fea.common.verdict import CheckOutcome, Quantity, Verdict
from fea.outcomes.result import CheckResult, SectionComparison
from fea.outcomes.unchecked import unchecked

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_ROUNDING = 1e-12
AGREEMENT = 0.03
"""Largest difference between hand calculation and solid model that needs no explanation."""


def number(value: float, digits: int = 4, beside: float = 0.0) -> str:
    """Return a number with so many significant digits; a power of ten outside 1e-4 to 1e5.

    beside   a number of which this one is a part: what is smaller than rounding leaves of it counts as zero
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
    """Return a number with so many decimals; zero has no sign."""
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text.replace("-", "−")


def plain(value: float) -> str:
    """Return a stated number (a limit, a size) without padding zeros."""
    return f"{value:g}".replace("-", "−")


def band(value: Band, digits: int = 3) -> str:
    """Return ``3.21 (2.44 to 3.21)``, or the value alone where the band has no visible width."""
    shown = number(value.value, digits)
    low, high = number(value.low, digits), number(value.high, digits)
    return shown if low == high else f"{shown} ({low} to {high})"


def percent(ratio: float) -> str:
    """Return a ratio as a signed percentage."""
    text = f"{100.0 * ratio:+.1f}"
    return f"{text[1:] if float(text) == 0.0 else text} %".replace("-", "−")


def joined(words: tuple[str, ...] | list[str]) -> str:
    """Return ``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def turning(torque: float) -> str:
    """Return the sense of a torque about z."""
    return "none" if torque == 0.0 else "clockwise" if torque < 0.0 else "counter-clockwise"


def apart(compared: Sequence[SectionComparison]) -> list[SectionComparison]:
    """Return the sections at which hand calculation and solid model differ by more than ``AGREEMENT``."""
    return [c for c in compared if abs(c.difference) > AGREEMENT]


def agreement(compared: Sequence[SectionComparison]) -> str:
    """Say how well hand calculation and solid model agree over some sections."""
    if apart(compared):
        return f"more than {100.0 * AGREEMENT:g} % apart"
    most = max(abs(c.difference) for c in compared)
    return f"they agree within {math.ceil(1000.0 * most - 1e-9) / 10.0:.1f} %"


def checks_of(result: CheckResult) -> tuple[CheckOutcome, ...]:
    """All checks of all load cases."""
    return tuple(check for load_case in result.load_cases.values() for check in load_case.checks)


def tightness(check: CheckOutcome) -> float:
    """How far the unfavourable end of a check's band is inside its limit, as a share of the limit; −∞ if unknown."""
    if check.value.unknowable:
        return -math.inf
    margin = check.value.low - check.limit if check.at_least else check.limit - check.value.high
    return margin / check.limit


def tightest(result: CheckResult) -> CheckOutcome | None:
    """The check nearest to its limit, or furthest beyond it; None where nothing is checked."""
    return min(checks_of(result), key=tightness, default=None)


def headline(result: CheckResult) -> str:
    """Return the verdict, what it means, and what no check looks at, in a few plain sentences."""
    return " ".join(filter(None, (_headline(result), not_checked(unchecked(result.case)))))


def not_checked(what: tuple[str, ...]) -> str:
    """Return what no check looks at as a sentence; empty where every check is there."""
    return f"Not checked: {'; '.join(what)}." if what else ""


def _headline(result: CheckResult) -> str:
    checks = checks_of(result)
    worst = tightest(result)
    if worst is None:
        return "Undecided: the case asks for no check, so nothing was decided."
    total = "the one check" if len(checks) == 1 else f"all {len(checks)} checks"
    if result.verdict is Verdict.PASS:
        kept = "is" if len(checks) == 1 else "are"
        nearest = _nearest(result, worst, "Nearest to its limit")
        return f"Pass: {total} {kept} met over the whole of every error band. {nearest}"
    broken = [c for c in checks if c.verdict is result.verdict]
    names = joined(list(dict.fromkeys(_named(c) for c in broken)))
    if result.verdict is Verdict.FAIL:
        missed = (
            "is missed over its whole error band" if len(broken) == 1 else "are missed over their whole error bands"
        )
        worst = min(broken, key=tightness)
        return f"Fail: {len(broken)} of {len(checks)} checks {missed}: {names}. {_nearest(result, worst, 'Worst')}"
    verb = "is" if len(broken) == 1 else "are"
    return (
        f"Undecided: {len(broken)} of {len(checks)} checks {verb} left open: {names}. "
        f"{broken[0].quantity.capitalize()} of {broken[0].link}: {broken[0].reason}."
    )


def _named(check: CheckOutcome) -> str:
    return f"{check.quantity} {_of(check)} {check.link}"


def _of(check: CheckOutcome) -> str:
    return "by" if check.quantity is Quantity.LOAD_SHARE else "of"


def sentence(text: str) -> str:
    """Return a text that begins with a capital and ends with a full stop."""
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def _nearest(result: CheckResult, check: CheckOutcome, lead: str) -> str:
    unit = f" {check.unit}" if check.unit else ""
    asked = "at least" if check.at_least else "at most"
    under = f" under load case {check.load_case}" if len(result.load_cases) > 1 else ""
    return (
        f"{lead}: the {check.quantity} {_of(check)} {check.subject.long}{under} is {band(check.value)}{unit}, "
        f"where {asked} {plain(check.limit)}{unit} is asked for."
    )
