"""What a body must obey before it can be built: checked by closed form, without the geometry kernel.

Here stand the rules for all kinds of parts; each kind adds its own in ``check``.
"""

import itertools

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import ON_AXIS, Body, apart, extent, patch_span
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.bodies.features import HoleRow, Pin, PlainEnd
from alula.geometry.bodies.forks import check_forks

SLENDEREST = 1e6
"""Largest distance of any part of a link from its origin over the smaller size of its section. Measured: the kernel's
volumes of bars are right to 1e-9 and of tubes to 1e-5 up to 1e8; at 1e9 a bar comes out as two solids."""
SMALLEST, LARGEST = 1e-12, 1e15
"""Of a section's smaller size [mm]. Measured: volumes are right to 1e-13 at both ends; at 1e150 mm the kernel fails."""
SHORTEST_CLAMP = 0.1
"""Least length of a clamp over the smaller size of the section. A choice: a shorter one is a line, which holds no
moment. Frames take what it holds for rigid to 1e-5 of what the beam gives there, at 1e-3 to 10 %."""
FINEST = 1e7
"""Largest distance of any part of a link from its origin over the diameter of a pin hole. Measured: the kernel finds
a hole in a bar that is 1e8 times as long, and loses it in one of 1e9."""


def check_body(body: Body) -> None:
    """Refuse a body that cannot be built.

    Parameters
    ----------
    body : Body
        The body.

    Raises
    ------
    CaseError
        With the entry, the value, the rule and the remedy.
    """
    if not any(pin.foot is None for pin in body.pins) and len(body.ends) < 2:
        raise CaseError("the link has no pin on its axis, but a part needs at least 1; add a joint there")
    _check_features(body)
    _check_range(body)
    if body.part.is_beam:
        check_length(body)
    _check_pins(body)
    check_forks(body)
    body.part.check(body)
    for end in () if body.part.patches_anywhere else body.ends:
        _check_end(body, end)
    for number, row in enumerate(body.holes, start=1):
        _check_row(body, number, row)


def check_length(body: Body) -> None:
    """Refuse a body without length along the x axis, as a beam and any link that moves in a frame must have.

    Parameters
    ----------
    body : Body
        The body.

    Raises
    ------
    CaseError
        Where all of its points lie at one x.
    """
    first, last = extent(body)
    if not last > first:
        raise CaseError(
            f"all pins and load points lie at x = {first:g} mm, so the link has no length along its x axis; move them "
            "apart, or turn the link's frame"
        )


def _check_features(body: Body) -> None:
    """Refuse slots, arms, rows of holes and load points without a pin where the kind of part takes none."""
    part = body.part
    stated = {
        "slots": [pin.name for pin in body.pins if pin.slot > 0.0],
        "arms": [pin.name for pin in body.pins if pin.foot is not None],
        "rows of holes": ["holes"] if body.holes else [],
        "load points without a pin": [end.name for end in body.ends],
        "forks": [pin.name for pin in body.pins if pin.fork is not None],
    }
    for feature, names in stated.items():
        if names and feature not in part.takes:
            raise CaseError(
                f"{' and '.join(names)}: a part of shape {part.shape} takes no {feature}; choose a part of shape bar, "
                "or leave them out"
            )


def _check_range(body: Body) -> None:
    section = body.part.section
    small = min(section.width, section.height)
    sizes = [section.width, section.height]
    sizes += [size for pin in body.pins for size in (body.ring(pin).diameter, body.ring(pin).thickness)]
    sizes += [abs(at) for pin in body.pins for at in (*pin.span, pin.y)]
    reach = max(sizes + [abs(end.x) for end in body.ends])
    if not SMALLEST <= small <= LARGEST:
        raise CaseError(
            f"the part's section is {small:g} mm across, but must be {SMALLEST:g} to {LARGEST:g} mm; correct its sizes"
        )
    if reach > SLENDEREST * small:
        raise CaseError(
            f"the link reaches {reach:g} mm from the origin of its frame, more than {SLENDEREST:g} times its section's "
            f"smaller size; shorten it to {SLENDEREST * small:g} mm, or make the part at least "
            f"{reach / SLENDEREST:.4g} mm thick"
        )
    for pin in body.pins:
        if 0.0 < pin.diameter < reach / FINEST:
            raise CaseError(
                f"the pin hole at {pin.name} has a diameter of {pin.diameter:g} mm, but must have at least "
                f"{reach / FINEST:g} mm in a part that reaches {reach:g} mm; make it larger"
            )


def _check_pins(body: Body) -> None:
    for pin in body.pins:
        eye, entry = body.ring(pin).diameter, body.part.eye_entry
        if eye > 0.0 and not 0.0 < pin.diameter < eye:
            raise CaseError(
                f"the pin hole at {pin.name} has a diameter of {pin.diameter:.4g} mm, but must be positive and less "
                f"than {entry} {eye:.4g} mm; {_smaller(pin)} or increase {entry.removeprefix('2 ')}"
            )
        if pin.slot > 0.0 and body.part.is_beam and abs(pin.y) > ON_AXIS * pin.diameter:
            raise CaseError(
                f"the slot at {pin.name} lies {abs(pin.y):.4g} mm off the link's axis, but must lie on it; turn the "
                "link's frame so that the slot has y = 0"
            )
    for one, other in itertools.combinations(body.pins, 2):
        least = (one.diameter + other.diameter) / 2.0
        if apart(one, other) <= least:
            raise CaseError(
                f"the pin holes at {one.name} and {other.name} overlap: move the pins more than {least:.4g} mm apart "
                f"(now {apart(one, other):.4g} mm), or {_smaller(one, other)}"
            )


def _smaller(*pins: Pin) -> str:
    """Say what makes holes smaller."""
    wider = max(pin.clearance for pin in pins)
    return f"reduce pin_diameter{f' or the clearance, {wider:.4g} mm' if wider else ''}"


def _check_end(body: Body, end: PlainEnd) -> None:
    if end.clamped:
        if body.part.is_beam and end.x not in extent(body):
            raise CaseError(
                f"the clamp at {end.name} lies between the ends of the {body.part.shape}, but a clamp holds an end of "
                f"it; make {end.name} the first or the last point, or the part a plate"
            )
        if body.part.is_beam and end.patch < SHORTEST_CLAMP * body.part.size:
            raise CaseError(
                f"clamp_length {end.patch:.4g} mm at {end.name} is less than {SHORTEST_CLAMP:g} times the smaller size "
                f"of the section, {body.part.size:.4g} mm, and holds no moment; make it longer"
            )
    room, wall = _room(body, end)
    if room <= 0.0:
        raise CaseError(f"{end.name} is no pin, but lies in {wall}; move it out of there, or make it a joint")
    if end.patch >= room:
        raise CaseError(
            f"the loaded patch of {end.name} would run into {wall}: set {end.entry} below {room:.4g} mm (now "
            f"{end.patch:.4g} mm), or move {end.name} away from there"
        )
    low, high = patch_span(body, end)
    for other in body.ends:
        low2, high2 = patch_span(body, other)
        if other is not end and low < high2 and low2 < high:
            raise CaseError(
                f"the loaded patches of {end.name} and {other.name} overlap: reduce {end.entry} {end.patch:.4g} mm, or "
                "move the points further apart"
            )


def _room(body: Body, end: PlainEnd) -> tuple[float, str]:
    """Return the length that a loaded patch must stay below, and what bounds it."""
    first, last = extent(body)
    walls = [(first, first, "the end of the link"), (last, last, "the end of the link")]
    for pin in body.pins:
        if pin.foot is None:
            reach = eye_reach(body, pin)
            what = "the eye at {} and its fillet" if body.ring(pin).diameter > 0.0 else "the pin hole at {}"
            walls.append((pin.x - reach, pin.x + reach, what.format(pin.name)))
    share = 1.0 if end.x in (first, last) else 2.0  # at an end of the link it lies inwards, else on either side
    return min((share * max(low - end.x, end.x - high), what) for low, high, what in walls if not low == high == end.x)


def _check_row(body: Body, number: int, row: HoleRow) -> None:
    name = f"holes[{number}] ({row.count} holes of {row.diameter:g} mm along {row.along})"
    (first, last), across, radius = extent(body), body.part.section.across(row.along), row.diameter / 2.0
    if row.along == "z" and body.cuts:
        across = 2.0 * min(body.part.half_width(body, x + side) for x in row.positions for side in (-radius, radius))
    if row.diameter >= across:
        raise CaseError(f"{name} cut the link through: set diameter below {across:.4g} mm, the size of its section")
    for x in row.positions:
        if x - radius <= first or x + radius >= last:
            raise CaseError(
                f"{name} has a hole at x = {x:g} mm, but holes must lie between x = {first + radius:.4g} and "
                f"{last - radius:.4g} mm; change first or last"
            )
        for pin in body.pins:
            least = eye_reach(body, pin) + radius
            if abs(x - pin.x) <= least:
                what = "eye or fillet" if body.ring(pin).diameter > 0.0 else "pin hole"
                raise CaseError(
                    f"{name} has a hole at x = {x:g} mm that runs into the {what} at {pin.name}: keep it more "
                    f"than {least:.4g} mm from x = {pin.x:g} mm"
                )
    length = abs(row.last - row.first)
    if row.count > 1 and length / (row.count - 1) <= row.diameter:
        raise CaseError(
            f"{name} overlap: set diameter below {length / (row.count - 1):.4g} mm, which is their spacing, or reduce "
            "count"
        )
    for second, other in enumerate(body.holes[number:], start=number + 1):
        least = radius + other.diameter / 2.0
        for x, x2 in itertools.product(row.positions, other.positions):
            if abs(x - x2) <= least:
                raise CaseError(
                    f"{name} has a hole at x = {x:g} mm that runs into one of holes[{second}] at x = {x2:g} mm: shift "
                    f"a row so that they are more than {least:.4g} mm apart"
                )
