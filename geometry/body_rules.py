"""What a body must obey before it can be built: checked by closed form, without the geometry kernel."""

import itertools
import math

from geometry.errors import CaseError
from geometry.part import Bar, Body, Disc, HoleRow, Part, Pin, PlainEnd, Section, Tube, rectangle

ON_AXIS = 1e-9
"""Share of a slot's or arm's size by which it may lie off the link's axis."""
LEAST_ARM_ANGLE = math.radians(30.0)
"""Between an arm and the link's axis: below it, bar and arm run into one another."""
PLAIN_EYE = 1.01
"""Eye over width of a bar up to which the eye is built as wide as the bar: the kernel cannot round so low a step, and
a narrower eye bears no less stress."""
SLENDEREST = 1e6
"""Largest distance of any part of a link from its origin over the smaller size of its section. Measured: the kernel's
volumes of bars are right to 1e-9 and of tubes to 1e-5 up to 1e8; at 1e9 a bar comes out as two solids."""
SMALLEST, LARGEST = 1e-12, 1e15
"""Of a section's smaller size [mm]. Measured: volumes are right to 1e-13 at both ends; at 1e150 mm the kernel fails."""
_CHORDS = 200


def extent(body: Body) -> tuple[float, float]:
    """Return the least and greatest x of the body's pins and ends: where its tube or bar begins and ends [mm].

    The pins on arms have no say; those of a disc tell what lies between its holes.
    """
    stations = [x for p in body.pins if p.foot is None for x in p.span] + [e.x for e in body.ends]
    return min(stations), max(stations)


def section_width(part: Part) -> float:
    """Return the section's size along y, in the linkage's plane [mm]."""
    if isinstance(part, Disc):
        return part.diameter
    return part.outer_diameter if isinstance(part, Tube) else part.width


def section_height(part: Part) -> float:
    """Return the section's size along z, along the pins [mm]."""
    return part.outer_diameter if isinstance(part, Tube) else part.thickness


def fillet_radius(part: Part) -> float:
    """Return the fillet where the section meets an eye [mm]; a disc has no such place."""
    return 0.0 if isinstance(part, Disc) else part.fillet_radius


def hand_section(body: Body) -> Section:
    """Return the section of which hand calculation takes the link to be made.

    A tube's or bar's own between the eyes. Of a disc the narrowest net section between its holes, the chord
    2 √(R² - x²) less what the holes cut out of it: an estimate, since a disc is as wide as long and no beam.
    """
    part = body.part
    if not isinstance(part, Disc):
        return part.section
    first, last = extent(body)
    stations = [first + (last - first) * i / _CHORDS for i in range(_CHORDS + 1)]
    return rectangle(min(_net_chord(body, part, x) for x in stations), part.thickness)


def _net_chord(body: Body, part: Disc, x: float) -> float:
    cut = sum(2.0 * math.sqrt(max((p.diameter / 2.0) ** 2 - (x - p.x) ** 2, 0.0)) for p in body.pins)
    return 2.0 * math.sqrt(max((part.diameter / 2.0) ** 2 - x**2, 0.0)) - cut


def reference_line(body: Body) -> tuple[float, float]:
    """Return the two stations through which the line runs that hand calculation's displacements refer to [mm].

    The first and last pin on the axis. A link with a single pin has that station twice: the line turns with its bore.
    Where there are pins off the axis besides, the eye of the one on it holds the direction, as does an arm on it.
    """
    on_axis = [pin.x for pin in body.pins if pin.foot is None]
    if len(on_axis) > 1 and on_axis[0] != on_axis[-1]:
        return on_axis[0], on_axis[-1]
    if len(body.pins) == 1:
        return on_axis[0], on_axis[0]
    first, last = extent(body)
    half = body.part.eye_diameter / 2.0
    return on_axis[0], on_axis[0] + (half if last - on_axis[0] >= on_axis[0] - first else -half)


def patch_span(body: Body, end: PlainEnd) -> tuple[float, float]:
    """Return the x between which the patch of a plain end lies: at an end of the link inwards, else about its x."""
    first, last = extent(body)
    if end.x == last:
        return end.x - end.patch, end.x
    if end.x == first:
        return end.x, end.x + end.patch
    return end.x - end.patch / 2.0, end.x + end.patch / 2.0


def plain_eye(body: Body, pin: Pin) -> bool:
    """Whether an eye is no thicker and no wider than its bar (or arm): a hole, and a round end where the bar ends."""
    part = body.part
    within = isinstance(part, Bar) and not part.has_step and part.eye_diameter <= PLAIN_EYE * part.width
    return within and (pin.foot is not None or abs(pin.y) <= ON_AXIS * section_width(part))


def eye_reach(body: Body, pin: Pin) -> float:
    """Return half the length of x that an eye with its fillet takes up on the tube or bar [mm].

    The fillet's centre lies at the radii's sum from the pin and at one fillet radius off the surface. Where an arm
    starts, the fillet between its side and the bar's reaches further if the angle between them is small.
    """
    part, fillet = body.part, fillet_radius(body.part)
    if isinstance(part, Disc):
        return part.eye_diameter / 2.0
    if pin.foot is not None:
        return 0.0
    if plain_eye(body, pin):
        fillet = 0.0
    radius, width = part.eye_diameter / 2.0, section_width(part)
    across = max(0.0, abs(pin.y) - width / 2.0)
    corners = [
        (width / 2.0 + fillet_radius(part)) / math.tan(_arm_angle(arm) / 2.0)
        for arm in body.pins
        if arm.foot == (pin.x, pin.y)
    ]
    return max([math.sqrt(max((radius + fillet) ** 2 - across**2, 0.0)), *corners]) + pin.slot / 2.0


def _arm_angle(pin: Pin) -> float:
    """Return the angle between an arm and the link's axis, at most a right one [rad]."""
    assert pin.foot is not None
    return math.atan2(abs(pin.y - pin.foot[1]), abs(pin.x - pin.foot[0]))


def apart(one: Pin, other: Pin) -> float:
    """Return the distance between the centres of two holes, or the centre lines of slots [mm]."""
    along = max(abs(one.x - other.x) - (one.slot + other.slot) / 2.0, 0.0)
    return math.hypot(along, one.y - other.y)


def check_body(body: Body) -> None:
    """Raise ``CaseError`` naming the entry, the value, the rule and the remedy if the body cannot be built."""
    if not any(pin.foot is None for pin in body.pins) and len(body.ends) < 2:
        raise CaseError("the link has 0 pins, but a part needs at least 1 on its axis; give it a pin")
    _check_range(body)
    first, last = extent(body)
    if isinstance(body.part, Disc):
        _check_disc(body, body.part)
    if not last > first:
        raise CaseError(f"the link's pins and ends all lie at x = {first:g} mm, so it has no length; move them apart")
    for pin in body.pins:
        _check_pin(body, pin, first, last)
    for one, other in itertools.combinations(body.pins, 2):
        if apart(one, other) <= (one.diameter + other.diameter) / 2.0:
            raise CaseError(
                f"the pin holes at {one.name} and {other.name} run into each other; move the pins apart "
                "or make their holes smaller"
            )
    for end in body.ends:
        _check_end(body, end)
    for number, row in enumerate(body.holes, start=1):
        _check_row(body, number, row, first, last)


def _check_range(body: Body) -> None:
    part = body.part
    small = min(section_width(part), section_height(part))
    sizes = [section_width(part), section_height(part), part.eye_diameter, part.eye_thickness]
    sizes += [abs(at) for pin in body.pins for at in (*pin.span, pin.y)]
    reach = max(sizes + [abs(end.x) for end in body.ends])
    if not SMALLEST <= small <= LARGEST:
        raise CaseError(
            f"its section is {small:g} mm across, but the geometry kernel needs {SMALLEST:g} to {LARGEST:g} mm; "
            "correct the part's sizes"
        )
    if reach > SLENDEREST * small:
        raise CaseError(
            f"it reaches {reach:g} mm from the origin of its frame, but the geometry kernel is sound up to "
            f"{SLENDEREST:g} times its section's smaller size, {SLENDEREST * small:g} mm; shorten the link or make its "
            "part thicker"
        )


def _check_pin(body: Body, pin: Pin, first: float, last: float) -> None:
    part = body.part
    if not 0.0 < pin.diameter < part.eye_diameter:
        raise CaseError(
            f"the pin hole at {pin.name} has a diameter of {pin.diameter:g} mm, but must be positive and less than "
            f"eye_diameter {part.eye_diameter:g} mm to leave a wall; make the hole smaller or the eye wider"
        )
    if pin.slot > 0.0:
        _check_slot(body, pin)
    if isinstance(part, Disc):
        return
    if pin.foot is not None:
        _check_arm(body, pin, pin.foot)
        return
    width = section_width(part)
    at_end = pin.span[0] == first or pin.span[1] == last
    reach = (part.eye_diameter - width) / 2.0 if at_end else part.eye_diameter / 2.0
    if abs(pin.y) >= reach and abs(pin.y) > ON_AXIS * width:
        what = "cover the whole end of the" if at_end else "reach past the axis of the"
        raise CaseError(
            f"pin {pin.name} lies {pin.y:g} mm off the link's axis, but its eye must {what} {part.shape}, which "
            f"allows less than {reach:g} mm; move the pin towards the axis or widen eye_diameter"
        )


def _check_slot(body: Body, pin: Pin) -> None:
    if not isinstance(body.part, Bar):
        raise CaseError(f"the slot at {pin.name} needs a part of shape bar, not {body.part.shape}; give the link a bar")
    if abs(pin.y) > ON_AXIS * pin.diameter:
        raise CaseError(
            f"the slot at {pin.name} lies {pin.y:g} mm off the link's axis, but a slot runs along it; "
            "let the axis run through the slot"
        )


def _check_arm(body: Body, pin: Pin, foot: tuple[float, float]) -> None:
    part = body.part
    if not isinstance(part, Bar):
        raise CaseError(f"the arm to {pin.name} needs a part of shape bar, not {part.shape}; give the link a bar")
    if not any((p.x, p.y) == foot and p.slot == 0.0 and p.foot is None for p in body.pins) or foot[1] != 0.0:
        raise CaseError(
            f"the arm to {pin.name} must start at a pin hole on the link's axis (y = 0); name such a point in arms"
        )
    if _arm_angle(pin) < LEAST_ARM_ANGLE:
        raise CaseError(
            f"the arm to {pin.name} stands at {math.degrees(_arm_angle(pin)):.3g} degrees to the link's axis, but "
            f"needs at least {math.degrees(LEAST_ARM_ANGLE):g} to be clear of the bar; let it start nearer to the pin"
        )
    clear = abs(pin.y) - part.eye_diameter / 2.0 - part.width / 2.0
    if clear <= 2.0 * part.fillet_radius:
        raise CaseError(
            f"the eye at {pin.name}, at the end of an arm, is {max(clear, 0.0):g} mm from the bar along the link's "
            f"axis, but needs more than 2 fillet_radius = {2.0 * part.fillet_radius:g} mm; make the arm longer"
        )


def _check_disc(body: Body, disc: Disc) -> None:
    if body.ends:
        raise CaseError(
            f"{body.ends[0].name} is no pin, but every point of a disc needs to be one; make it a joint, or give the "
            "link a bar"
        )
    if body.holes:
        raise CaseError("a disc has no rows of holes along an axis; leave out holes, or give the link a bar")
    for pin in body.pins:
        reach = math.hypot(pin.x, pin.y) + disc.eye_diameter / 2.0
        if pin.foot is not None or reach >= disc.diameter / 2.0:
            raise CaseError(
                f"the ring about the hole at {pin.name} reaches {reach:g} mm from the disc's centre, the origin of the "
                f"link's frame, but the disc ends at {disc.diameter / 2.0:g} mm; widen the disc, narrow eye_diameter "
                "or move the pin"
            )
    for one, other in itertools.combinations(body.pins, 2):
        if apart(one, other) <= disc.eye_diameter:
            raise CaseError(
                f"the rings about the holes at {one.name} and {other.name} run into each other; "
                "move the pins apart or make eye_diameter smaller"
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
