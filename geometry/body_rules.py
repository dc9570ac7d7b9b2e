"""What a body must obey before it can be built: checked by closed form, without the geometry kernel."""

import itertools
import math

from geometry.errors import CaseError
from geometry.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube


def extent(body: Body) -> tuple[float, float]:
    """Return the least and greatest x of the body's pins and ends: where its tube or bar begins and ends [mm]."""
    stations = [p.x for p in body.pins] + [e.x for e in body.ends]
    return min(stations), max(stations)


def section_width(part: Tube | Bar) -> float:
    """Return the section's size along y, in the linkage's plane [mm]."""
    return part.outer_diameter if isinstance(part, Tube) else part.width


def section_height(part: Tube | Bar) -> float:
    """Return the section's size along z, along the pins [mm]."""
    return part.outer_diameter if isinstance(part, Tube) else part.thickness


def patch_span(body: Body, end: PlainEnd) -> tuple[float, float]:
    """Return the x between which the patch of a plain end lies: at an end of the link inwards, else about its x."""
    first, last = extent(body)
    if end.x == last:
        return end.x - end.patch, end.x
    if end.x == first:
        return end.x, end.x + end.patch
    return end.x - end.patch / 2.0, end.x + end.patch / 2.0


def eye_reach(body: Body, pin: Pin) -> float:
    """Return half the length of x that an eye with its fillet takes up on the tube or bar [mm].

    The fillet's centre lies at the radii's sum from the pin and at one fillet radius off the surface.
    """
    part = body.part
    radius, fillet = part.eye_diameter / 2.0, part.fillet_radius
    across = max(0.0, abs(pin.y) - section_width(part) / 2.0)
    return math.sqrt(max((radius + fillet) ** 2 - across**2, 0.0))


def check_body(body: Body) -> None:
    """Raise ``CaseError`` naming the entry, the value, the rule and the remedy if the body cannot be built."""
    first, last = extent(body)
    if not body.pins:
        raise CaseError("the link has 0 pins, but a part needs at least 1; give it a pin")
    if not last > first:
        raise CaseError(f"the link's pins and ends all lie at x = {first:g} mm, so it has no length; move them apart")
    for pin in body.pins:
        _check_pin(body, pin, first, last)
    for one, other in itertools.combinations(body.pins, 2):
        if math.hypot(one.x - other.x, one.y - other.y) <= (one.diameter + other.diameter) / 2.0:
            raise CaseError(
                f"the pin holes at {one.name} and {other.name} run into each other; move the pins apart "
                "or make their holes smaller"
            )
    for end in body.ends:
        _check_end(body, end)
    for number, row in enumerate(body.holes, start=1):
        _check_row(body, number, row, first, last)


def _check_pin(body: Body, pin: Pin, first: float, last: float) -> None:
    part = body.part
    if not 0.0 < pin.diameter < part.eye_diameter:
        raise CaseError(
            f"the pin hole at {pin.name} has a diameter of {pin.diameter:g} mm, but must be positive and less than "
            f"eye_diameter {part.eye_diameter:g} mm to leave a wall; make the hole smaller or the eye wider"
        )
    width = section_width(part)
    at_end = pin.x in (first, last)
    reach = (part.eye_diameter - width) / 2.0 if at_end else part.eye_diameter / 2.0
    if abs(pin.y) >= reach:
        what = "cover the whole end of the" if at_end else "reach past the axis of the"
        raise CaseError(
            f"pin {pin.name} lies {pin.y:g} mm off the link's axis, but its eye must {what} {part.shape}, which "
            f"allows less than {reach:g} mm; move the pin towards the axis or widen eye_diameter"
        )


def _check_end(body: Body, end: PlainEnd) -> None:
    low, high = patch_span(body, end)
    first, last = extent(body)
    if not end.patch > 0.0 or low < first or high > last:
        raise CaseError(
            f"the loaded patch of {end.name} is {end.patch:g} mm long and would run from x = {low:g} to {high:g} mm, "
            f"but must lie between {first:g} and {last:g} mm; shorten the patch"
        )
    for pin in body.pins:
        if _apart(low, high, pin.x - eye_reach(body, pin), pin.x + eye_reach(body, pin)) <= 0.0:
            raise CaseError(
                f"the loaded patch of {end.name}, x = {low:g} to {high:g} mm, runs into the eye at {pin.name}; "
                "shorten the patch or move the point away from the eye"
            )
    for other in body.ends:
        if other is not end and _apart(low, high, *patch_span(body, other)) < 0.0:
            raise CaseError(
                f"the loaded patches of {end.name} and {other.name} overlap; shorten a patch or move a point away"
            )


def _apart(low: float, high: float, low2: float, high2: float) -> float:
    return max(low2 - high, low - high2)


def _check_row(body: Body, number: int, row: HoleRow, first: float, last: float) -> None:
    part = body.part
    name = f"holes[{number}] ({row.count} holes of {row.diameter:g} mm along {row.along})"
    across = section_width(part) if row.along == "z" else section_height(part)
    if row.diameter >= across:
        raise CaseError(
            f"{name} cut the link through, because its section is {across:g} mm across; make the holes smaller"
        )
    radius = row.diameter / 2.0
    for x in row.positions:
        if x - radius <= first or x + radius >= last:
            raise CaseError(
                f"{name} has a hole at x = {x:g} mm, but holes must lie within the link, x = {first:g} to {last:g} mm; "
                "move the row inwards"
            )
        for pin in body.pins:
            if abs(x - pin.x) <= eye_reach(body, pin) + radius:
                raise CaseError(
                    f"{name} has a hole at x = {x:g} mm that runs into the eye or fillet at {pin.name}, which needs "
                    f"{eye_reach(body, pin) + radius:g} mm from x = {pin.x:g} mm; move or shorten the row"
                )
    spacing = abs(row.last - row.first) / max(row.count - 1, 1)
    if row.count > 1 and spacing <= row.diameter:
        raise CaseError(f"{name} are {spacing:g} mm apart and overlap; use fewer or smaller holes")
    for second, other in enumerate(body.holes[number:], start=number + 1):
        for x in row.positions:
            for x2 in other.positions:
                if abs(x - x2) <= radius + other.diameter / 2.0:
                    raise CaseError(
                        f"{name} has a hole at x = {x:g} mm that runs into one of holes[{second}] at x = {x2:g} mm; "
                        "shift one of the rows"
                    )
