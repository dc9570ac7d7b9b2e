"""Sentences whose words are put together from what they are told, where a text with places would not do."""

from collections.abc import Callable
from functools import partial

from alula.fea.common.band import Band
from alula.fea.common.change import rounded
from alula.reports.words.numbers import digits_beside, plain, short

Ends = tuple[float, float]


def _span(ends: Ends) -> str:
    return " to ".join(short(end, 3) for end in ends)


def _limit(ends: Ends) -> str:
    return short(ends[0], 3) if ends[0] == ends[1] else f"{_span(ends)} (with stated scatter)"


def _limit_within(what: str, low: float, high: float, limit: Ends, unit: str) -> str:
    return f"the {what} is {_span((low, high))} {unit}; the limit, {_limit(limit)} {unit}, lies inside"


def _clear_by_hand(ends: Ends, place: str, limits: tuple[Ends, ...], displacement: Ends | None) -> str:
    low, high = (short(end, 3) for end in ends)
    text = f"by hand the peak stress lies between {low} and {high} MPa, at most at {place}"
    if limits:
        text += f", clear of the limit {', '.join(map(_limit, limits))} MPa"
    if displacement is not None:
        text += f"; the displacement, {_span(displacement)} mm, is clear of its limits"
    return text


def _held(ways: tuple[str, ...], free: int) -> str:
    every = " and ".join(ways)
    if not every:
        return "free" if free else ""
    left = "a rigid motion" if free == 1 else f"{free} rigid motions"
    return f"{every}, {left} of it left free" if free else every


def _beside_limit(how: str, low: float, high: float, limit: float) -> str:
    digits = digits_beside(Band(value=low, low=low, high=high), limit)
    return f"its band {short(low, digits)} to {short(high, digits)} {how.format(plain(limit))}"


def _needed(what: str, *, passes: bool, needed: float, inverse: bool = False) -> str:
    """Say which end of a range would decide a check, rounded so that it still does."""
    end, most = (1.0 / needed, passes) if inverse else (needed, not passes)
    verdict, side = "pass" if passes else "fail", "at most" if most else "at least"
    return f"it would {verdict} {what.format(f'{side} {short(rounded(end, up=not most), 3)}')}"


_NO_MORE = "that makes it {} times what it is"
ARRANGED: dict[str, Callable[..., str]] = {
    "band_holds_limit": partial(_beside_limit, "holds the limit {}, so it may pass or fail"),
    "band_keeps_limit": partial(_beside_limit, "lies wholly on the safe side of the limit {}"),
    "band_misses_limit": partial(_beside_limit, "lies wholly on the wrong side of the limit {}"),
    "decided_by_discretisation": partial(_needed, f"with finer meshes (--accuracy), whose error {_NO_MORE[5:]}"),
    "decided_by_play": partial(_needed, f"with a smaller clearance of the joints, {_NO_MORE}"),
    "decided_by_load": partial(_needed, "with a scatter of the load of {} times what is stated", inverse=True),
    "decided_by_strength": partial(_needed, "with a range of the strength of {} times its value"),
    "decided_by_air": partial(_needed, f"with a narrower normal_coefficient_range, {_NO_MORE}"),
    "decided_by_friction": partial(_needed, f"with a narrower friction_range, {_NO_MORE}"),
    "limit_within": _limit_within,
    "clear_by_hand": _clear_by_hand,
    "held": _held,
}
