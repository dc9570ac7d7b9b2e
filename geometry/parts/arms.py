"""Arms of flat bars, to pins far off the link's axis: the rules that keep them clear of one another and of the bar."""

import itertools
import math

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body, apart, extent
from alula.geometry.bodies.eyes import TOUCHING, arm_angle, flush

LEAST_ARM_ANGLE = math.radians(30.0)
"""Between an arm and the link's axis: below it, bar and arm run into one another."""
_Point = tuple[float, float]


def check_arms(body: Body) -> None:
    """Refuse arms whose feet, angles, eyes or fillets do not fit.

    Parameters
    ----------
    body : Body
        A body whose part is a bar.

    Raises
    ------
    CaseError
        With the arm, the rule and a remedy.
    """
    part, half = body.part, body.part.section.width / 2.0
    for pin in body.pins:
        if pin.foot is None:
            continue
        if not any((p.x, p.y) == pin.foot and p.slot == 0.0 and p.foot is None for p in body.pins) or pin.foot[1]:
            raise CaseError(
                f"the arm to {pin.name} must start at a pin hole on the link's axis: name a point with y = 0 in arms"
            )
        if arm_angle(pin) < LEAST_ARM_ANGLE:
            run = abs(pin.y - pin.foot[1]) / math.tan(LEAST_ARM_ANGLE)
            raise CaseError(
                f"the arm to {pin.name} stands at {math.degrees(arm_angle(pin)):.3g} degrees to the link's axis, but "
                f"needs at least {math.degrees(LEAST_ARM_ANGLE):g}: let it start at most {run:.4g} mm along the axis "
                f"from {pin.name}"
            )
        least = half + body.ring(pin).diameter / 2.0 + 2.0 * part.fillet_radius
        if abs(pin.y) <= least:
            raise CaseError(
                f"{pin.name} is too close to the bar: move it more than {least:.4g} mm off the link's axis (now "
                f"{abs(pin.y):.4g} mm), or reduce eye_diameter or fillet_radius"
            )
    for foot in {pin.foot for pin in body.pins if pin.foot is not None}:
        _check_foot(body, foot)
    for what, beside, clear in _gaps(body):
        if clear <= 2.0 * part.fillet_radius:
            raise CaseError(
                f"{what} and {beside} are too close: {max(clear, 0.0):.4g} mm apart, where 2 fillet_radius = "
                f"{2.0 * part.fillet_radius:.4g} mm must fit between them; move the points "
                f"{2.0 * part.fillet_radius - clear:.4g} mm further apart, or reduce eye_diameter or fillet_radius"
            )


def _gaps(body: Body) -> list[tuple[str, str, float]]:
    """Return what must stay apart at arms: two names and the gap between them [mm]."""
    half = body.part.section.width / 2.0
    gaps = []
    for one, other in itertools.combinations(body.pins, 2):
        places = (one.x, one.y), (other.x, other.y)
        if (one.foot or other.foot) and one.foot != places[1] and other.foot != places[0]:
            clear = apart(one, other) - (body.ring(one).diameter + body.ring(other).diameter) / 2.0
            gaps.append((f"the eye at {one.name}", f"the eye at {other.name}", clear))
        if one.foot and other.foot and one.foot != other.foot:
            clear = _between((one.foot, places[0]), (other.foot, places[1])) - 2.0 * half
            gaps.append((f"the arm to {one.name}", f"the arm to {other.name}", clear))
    for arm, pin in itertools.product(body.pins, body.pins):
        if arm.foot is not None and pin is not arm and arm.foot != (pin.x, pin.y):
            line = (pin.span[0], pin.y), (pin.span[1], pin.y)
            clear = _between((arm.foot, (arm.x, arm.y)), line) - body.ring(pin).diameter / 2.0 - half
            gaps.append((f"the arm to {arm.name}", f"the eye at {pin.name}", clear))
    return gaps


def _check_foot(body: Body, foot: _Point) -> None:
    """Check each corner α < π between bar and arms at a foot, h = w/2 / sin(α/2) from the pin.

    Sharp corners (f = 0) are built at any angle. Else the eye (a thick one with its fillet) hides in the corner, or its
    own two fillets lie side by side in it, their centres asin((w/2 + f)/(R + f)) from either side's direction. The
    kernel needs just that.
    """
    first, last = extent(body)
    pin = next(pin for pin in body.pins if (pin.x, pin.y) == foot)
    half, radius, fillet = body.part.section.width / 2.0, body.ring(pin).diameter / 2.0, body.part.fillet_radius
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
                f"{math.degrees(LEAST_ARM_ANGLE):g}; move the point of an arm, or let it start at another pin"
            )
        if fillet == 0.0 or angle >= math.pi:
            continue
        sine = math.sin(angle / 2.0)
        corner = half / sine
        hidden = radius + (0.0 if flush(body, pin) else fillet) <= (1.0 - TOUCHING) * corner
        if not hidden and half + fillet >= (1.0 - TOUCHING) * (radius + fillet) * sine:
            most = (radius * sine - half) / (1.0 - sine) if radius > corner else corner - radius
            raise CaseError(
                f"fillet_radius {fillet:.4g} mm is too large for the corner of {math.degrees(angle):.3g} degrees "
                f"between {one} and {other}: set it below {max(most, 0.0):.6g} mm, or move the arm's point"
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
