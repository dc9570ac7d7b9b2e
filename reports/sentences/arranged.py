"""Sentences whose words are put together from lists of numbers."""

import math
from collections.abc import Callable

from alula.reports.words.numbers import fixed, plain, short

Ends = tuple[float, float]


def _span(ends: Ends, unit: str) -> str:
    return f"{short(ends[0], 3)} to {short(ends[1], 3)}{unit}"


def _friction(ranges: tuple[tuple[float, float, tuple[str, ...]], ...]) -> str:
    return "; ".join(_span((low, high), f" at {', '.join(joints)}") for low, high, joints in ranges)


def _what_links_carry(links: tuple[str, ...] = ()) -> str:
    return f"what {', '.join(links)} carr{'ies' if len(links) == 1 else 'y'}" if links else "what links carry"


def _solid_buckles(factor: float, most: float, held: str, least: float | None) -> str:
    times = f"at {short(factor, 3)}" if math.isfinite(factor) else f"at more than {plain(most)}"
    lower = "" if least is None else f"; at {short(least, 3)} times where its joints move with it"
    return f"its solid buckles {times} times the load, {held}{lower}"


def _open_bores(bores: tuple[tuple[str, float], ...]) -> str:
    shares = ", ".join(f"{pin} has {share:.0%}" for pin, share in bores)
    return f"bores are not round all the way ({shares} of its circle): pressure acts on the rest"


def _bores_off_plane(bores: tuple[tuple[str, float], ...]) -> str:
    middles = ", ".join(f"{pin} at z = {short(middle, 4)} mm" for pin, middle in bores)
    return (
        f"the middles of bores lie off the plane of forces ({middles}): there the couple of the force about the middle "
        "is a pressure linear along the bore"
    )


def _limit(ends: Ends) -> str:
    return short(ends[0], 3) if ends[0] == ends[1] else _span(ends, " (with stated scatter)")


def _limit_within(what: str, low: float, high: float, limit: Ends, unit: str) -> str:
    return f"the {what} is {_span((low, high), f' {unit}')}; the limit, {_limit(limit)} {unit}, lies inside"


def _clear_by_hand(ends: Ends, place: str, limits: tuple[Ends, ...], displacement: Ends | None) -> str:
    low, high = (short(end, 3) for end in ends)
    text = f"by hand the peak stress lies between {low} and {high} MPa, at most at {place}"
    if limits:
        text += f", clear of the limit {', '.join(map(_limit, limits))} MPa"
    if displacement is not None:
        text += f"; the displacement, {_span(displacement, ' mm')}, is clear of its limits"
    return text


def _peak_of_layers(place: tuple[float, ...], tension: float, shear: float) -> str:
    x, y, z = (fixed(value, 1) for value in place)
    across = f"{short(abs(tension), 3)} MPa of {'compression' if tension < 0.0 else 'tension'} across the layers"
    return f"largest at x = {x}, y = {y}, z = {z} mm: {across}, {short(shear, 3)} MPa of shear along them"


def _solids_and_beams(solids: tuple[str, ...], beams: tuple[str, ...]) -> str:
    if not solids:
        return "the frame of the linkage"
    beside = f" and of the frame's beams of {', '.join(beams)}" if beams else ""
    return f"the solid model{'s' if len(solids) > 1 else ''} of {', '.join(solids)}{beside}"


def _made_up_of(masses: tuple[tuple[str, float], ...], others: float | None, not_counted: tuple[str, ...]) -> str:
    parts, left = ", ".join(f"{kind} {short(mass, 4)} g" for kind, mass in masses), ", ".join(not_counted)
    parts = parts or "no part weighs anything"
    if others is not None:
        return f"{parts}, others as stated {short(others, 4)} g{f', which stand for {left}' if left else ''}"
    return f"{parts}{f'; not counted: {left}' if left else ''}"


def _held(ways: tuple[str, ...], free: int) -> str:
    every = " and ".join(ways)
    if not every:
        return "free" if free else ""
    left = "a rigid motion" if free == 1 else f"{free} rigid motions"
    return f"{every}, {left} of it left free" if free else every


ARRANGED: dict[str, Callable[..., str]] = {
    "friction_at_joints": _friction,
    "what_links_carry": _what_links_carry,
    "solid_buckles": _solid_buckles,
    "open_bores": _open_bores,
    "bores_off_plane": _bores_off_plane,
    "limit_within": _limit_within,
    "clear_by_hand": _clear_by_hand,
    "peak_of_layers": _peak_of_layers,
    "solids_and_beams": _solids_and_beams,
    "made_up_of": _made_up_of,
    "held": _held,
}
