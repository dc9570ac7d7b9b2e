"""What a body must obey before it can be built: checked by closed form, without the geometry kernel."""

import itertools
import math
from dataclasses import replace

from geometry.base.errors import CaseError
from geometry.parts.part import Bar, Body, Disc, HoleRow, Part, Pin, PlainEnd, Section, Tube, rectangle

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
TOUCHING = 1e-4
"""Share by which fillets must stay clear of one another. Measured: the kernel fails on two neighbouring eyes at 1e-7
and on a thick eye at an arm's foot at 1e-5; from 1e-4 on no build failed."""
FINEST = 1e7
"""Largest distance of any part of a link from its origin over the diameter of a pin hole. Measured: the kernel finds
a hole in a bar that is 1e8 times as long, and loses it in one of 1e9."""
_CHORDS = 200
_Point = tuple[float, float]


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
    if not isinstance(body.part, Disc):
        _check_neighbours(body)
    if isinstance(body.part, Bar):
        _check_arms(body, body.part)
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
    for pin in body.pins:
        if 0.0 < pin.diameter < reach / FINEST:
            raise CaseError(
                f"the pin hole at {pin.name} has a diameter of {pin.diameter:g} mm, but the geometry kernel sees "
                f"none below {reach / FINEST:g} mm in a part that reaches {reach:g} mm; make the hole larger"
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


def _shoulder(body: Body, pin: Pin, side: float) -> float:
    """Return half the length that an eye takes up on its tube, bar or arm, up to where its fillet ends [mm].

    As ``eye_reach``, but beside an eye as thick as its bar the fillet ends where it touches the bar's side: its centre
    lies w/2 + f from the axis and R + f from the pin. Off the axis it may stand out on one side (1 or -1) only, and on
    the other take up none. Where an arm starts, there is another fillet.
    """
    part = body.part
    at_foot = any(arm.foot == (pin.x, pin.y) for arm in body.pins)
    if plain_eye(body, pin) and not at_foot:
        return 0.0
    if pin.foot is not None:
        pin = replace(pin, y=0.0, foot=None)
    if at_foot or not isinstance(part, Bar) or part.has_step:
        return eye_reach(body, pin)
    radius, across = part.eye_diameter / 2.0, part.width / 2.0 + part.fillet_radius - side * pin.y
    if across - part.fillet_radius >= radius:
        return 0.0
    return max(radius, math.sqrt(max((radius + part.fillet_radius) ** 2 - across**2, 0.0))) + pin.slot / 2.0


def _check_neighbours(body: Body) -> None:
    """Refuse eyes that overlap along a tube, bar or arm, or whose fillets do: the kernel cannot round what is left."""
    on_axis = [pin for pin in body.pins if pin.foot is None]
    pairs = list(itertools.combinations(on_axis, 2))
    pairs += [(foot, arm) for arm in body.pins for foot in on_axis if arm.foot == (foot.x, foot.y)]
    for (one, other), side in itertools.product(pairs, (1.0, -1.0)):
        distance = math.hypot(other.x - one.x, other.y - one.y if other.foot else 0.0)
        shoulders = _shoulder(body, one, side), _shoulder(body, other, side)
        if min(shoulders) > 0.0 and distance <= (1.0 + TOUCHING) * sum(shoulders):
            raise CaseError(
                f"the eyes at {one.name} and {other.name} overlap, or their fillets do: the points are {distance:g} mm "
                f"apart, but eye_diameter {body.part.eye_diameter:g} mm and fillet_radius "
                f"{fillet_radius(body.part):g} mm need more than {sum(shoulders):g} mm; move the points apart or make "
                "eyes or fillets smaller"
            )


def _check_arms(body: Body, bar: Bar) -> None:
    """Refuse arms that run into other arms or eyes, and corners at their feet that do not hold the fillets."""
    arms = [pin for pin in body.pins if pin.foot is not None]
    for foot in {arm.foot for arm in arms if arm.foot is not None}:
        _check_foot(body, bar, foot)
    eye, half = bar.eye_diameter / 2.0, bar.width / 2.0
    found = []
    for one, other in itertools.combinations(body.pins, 2):
        places = (one.x, one.y), (other.x, other.y)
        if (one.foot or other.foot) and one.foot != places[1] and other.foot != places[0]:
            found.append((f"the eye at {one.name}", f"the eye at {other.name}", apart(one, other) - 2.0 * eye))
        if one.foot and other.foot and one.foot != other.foot:
            clear = _between((one.foot, places[0]), (other.foot, places[1])) - 2.0 * half
            found.append((f"the arm to {one.name}", f"the arm to {other.name}", clear))
    for arm, pin in itertools.product(arms, body.pins):
        if arm.foot is not None and pin is not arm and arm.foot != (pin.x, pin.y):
            line = (pin.span[0], pin.y), (pin.span[1], pin.y)
            clear = _between((arm.foot, (arm.x, arm.y)), line) - eye - half
            found.append((f"the arm to {arm.name}", f"the eye at {pin.name}", clear))
    for what, beside, clear in found:
        if clear <= 2.0 * bar.fillet_radius:
            raise CaseError(
                f"{what} is {max(clear, 0.0):g} mm from {beside}, but needs more than 2 fillet_radius = "
                f"{2.0 * bar.fillet_radius:g} mm; move the points apart or make eyes or fillets smaller"
            )


def _check_foot(body: Body, bar: Bar, foot: _Point) -> None:
    """Check each corner α < π between bar and arms at a foot, h = w/2 / sin(α/2) from the pin.

    Sharp corners (f = 0) are built at any angle. Else the eye (a thick one with its fillet) hides in the corner, or its
    own two fillets lie side by side in it, their centres asin((w/2 + f)/(R + f)) from either side's direction. The
    kernel needs just that.
    """
    first, last = extent(body)
    half, radius, fillet = bar.width / 2.0, bar.eye_diameter / 2.0, bar.fillet_radius
    sides = [(0.0, "the bar")] * (last > foot[0]) + [(math.pi, "the bar")] * (first < foot[0])
    for arm in body.pins:
        if arm.foot == foot:
            angle = math.atan2(arm.y - foot[1], arm.x - foot[0]) % (2.0 * math.pi)
            sides.append((angle, f"the arm to {arm.name}"))
    sides.sort()
    for (start, one), (stop, other) in zip(sides, sides[1:] + sides[:1], strict=True):
        angle = (stop - start) % (2.0 * math.pi)
        if angle < LEAST_ARM_ANGLE:
            raise CaseError(
                f"{one} and {other} stand at {math.degrees(angle):.3g} degrees to each other, but need at least "
                f"{math.degrees(LEAST_ARM_ANGLE):g}; turn the arm or let it start elsewhere"
            )
        if fillet == 0.0 or angle >= math.pi:
            continue
        sine = math.sin(angle / 2.0)
        corner = half / sine
        hidden = radius + (fillet if bar.has_step else 0.0) <= (1.0 - TOUCHING) * corner
        if not hidden and half + fillet >= (1.0 - TOUCHING) * (radius + fillet) * sine:
            most = (radius * sine - half) / (1.0 - sine) if radius > corner else corner - radius
            raise CaseError(
                f"fillet_radius {fillet:g} mm is too large for the corner of {math.degrees(angle):.3g} degrees between "
                f"{one} and {other}, where beside the eye of {bar.eye_diameter:g} mm less than {max(most, 0.0):g} mm "
                "fits; make the fillet smaller or turn the arm"
            )


def _between(one: tuple[_Point, _Point], other: tuple[_Point, _Point]) -> float:
    """Return the distance of two straight lines from end to end, either of which may be a point [mm]."""

    def side(a: _Point, b: _Point, p: _Point) -> float:
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    def to_line(p: _Point, a: _Point, b: _Point) -> float:
        square = math.dist(a, b) ** 2
        along = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / square if square else 0.0
        along = min(max(along, 0.0), 1.0)
        return math.dist(p, (a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1])))

    if side(*one, other[0]) * side(*one, other[1]) < 0.0 > side(*other, one[0]) * side(*other, one[1]):
        return 0.0
    return min(*(to_line(p, *other) for p in one), *(to_line(p, *one) for p in other))


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
