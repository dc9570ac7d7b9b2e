"""Eyes of tubes and bars: the round ends about pin holes, the room that they take up, and the rules for them."""

import itertools
import math
from dataclasses import replace

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import ON_AXIS, Body, extent
from alula.geometry.bodies.features import Pin

EYE_WIDTH = 1.6
"""Diameter of an eye over the width of its tube or bar, where none is stated: a proportion often met, no standard."""
RIM = 2.05
"""Fillet radii that an eye must rise in all above what it is filleted to: 2 by geometry, and the kernel fails on a
fillet that just touches the eye's rim."""
PLAIN_EYE = 1.01
"""Eye over width of a bar up to which the eye is built as wide as the bar: the kernel cannot round so low a step, and
a narrower eye bears no less stress."""
ROUNDING = 1e-9
"""Share by which lengths that are meant to be equal may differ, such as "0.3 in" and "7.62 mm"."""
TOUCHING = 1e-4
"""Share by which fillets must stay clear of one another. Measured: the kernel fails on two neighbouring eyes at 1e-7
and on a thick eye at an arm's foot at 1e-5; from 1e-4 on no build failed."""


def flush(body: Body, pin: Pin) -> bool:
    """Return whether an eye is as thick as its flat bar or arm.

    Parameters
    ----------
    body : Body
        The body.
    pin : Pin
        One of its pins.

    Returns
    -------
    bool
        False of tubes, and of thicker eyes of bars.
    """
    section = body.part.section if pin.foot is None else body.part.arm_section
    return not section.round and body.ring(pin).height <= (1.0 + ROUNDING) * section.height


def plain_eye(body: Body, pin: Pin) -> bool:
    """Return whether an eye is but a hole and, where the bar ends, a round end.

    Parameters
    ----------
    body : Body
        The body.
    pin : Pin
        One of its pins.

    Returns
    -------
    bool
        Whether the eye is no thicker and no wider than its bar or arm.
    """
    width = body.part.section.width
    within = flush(body, pin) and body.ring(pin).diameter <= PLAIN_EYE * width
    return within and (pin.foot is not None or abs(pin.y) <= ON_AXIS * width)


def arm_angle(pin: Pin) -> float:
    """Return the angle between an arm and the link's axis.

    Parameters
    ----------
    pin : Pin
        The pin at the arm's end.

    Returns
    -------
    float
        At most a right angle [rad].
    """
    assert pin.foot is not None
    return math.atan2(abs(pin.y - pin.foot[1]), abs(pin.x - pin.foot[0]))


def eye_reach(body: Body, pin: Pin) -> float:
    """Return half the length of x that an eye with its fillet, and the gap of a fork, take up on the part.

    The fillet's centre lies at the radii's sum from the pin and at one fillet radius off the surface. Where an arm
    starts, the fillet between its side and the bar's reaches further if the angle between them is small.

    Parameters
    ----------
    body : Body
        The body.
    pin : Pin
        One of its pins.

    Returns
    -------
    float
        The half length [mm], that of the hole where no eye is about it; 0 for an eye at the end of an arm.
    """
    if pin.foot is not None:
        return 0.0
    part, half = body.part, body.part.section.width / 2.0
    if body.ring(pin).diameter == 0.0:
        return pin.diameter / 2.0 + pin.slot / 2.0
    radius = body.ring(pin).diameter / 2.0 + (0.0 if plain_eye(body, pin) else part.fillet_radius)
    across = max(0.0, abs(pin.y) - half)
    corners = [
        (half + part.fillet_radius) / math.tan(arm_angle(arm) / 2.0) for arm in body.pins if arm.foot == (pin.x, pin.y)
    ]
    root = 0.0 if pin.fork is None else pin.fork.depth
    return max([math.sqrt(max(radius**2 - across**2, 0.0)), root, *corners]) + pin.slot / 2.0


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
    if at_foot or not flush(body, pin):
        return eye_reach(body, pin)
    radius, across = body.ring(pin).diameter / 2.0, part.section.width / 2.0 + part.fillet_radius - side * pin.y
    if across - part.fillet_radius >= radius:
        return 0.0
    return max(radius, math.sqrt(max((radius + part.fillet_radius) ** 2 - across**2, 0.0))) + pin.slot / 2.0


def check_flat_eyes(body: Body) -> None:
    """Refuse eyes that are not as thick as the flat part in which they lie.

    Parameters
    ----------
    body : Body
        A body whose part is a disc or plate.

    Raises
    ------
    CaseError
        With the pin.
    """
    shape, thick = body.part.shape, body.part.eye_thickness
    for pin in body.pins:
        own = body.ring(pin).height
        if abs(own - thick) > ROUNDING * thick:
            raise CaseError(
                f"the eye at {pin.name} is {own:.4g} mm thick, but an eye of a {shape} is as thick as the {shape}, "
                f"{thick:.4g} mm; leave its thickness out"
            )


def check_eyes(body: Body) -> None:
    """Refuse eyes that do not cover the axis, and eyes that overlap or whose fillets do.

    Parameters
    ----------
    body : Body
        A body whose part is a tube or bar.

    Raises
    ------
    CaseError
        With the pins and the least distance.
    """
    part, width = body.part, body.part.section.width
    first, last = extent(body)
    on_axis = [pin for pin in body.pins if pin.foot is None]
    for pin in on_axis:
        at_end = pin.span[0] == first or pin.span[1] == last
        eye = body.ring(pin).diameter
        most = (eye - width) / 2.0 if at_end else eye / 2.0
        if abs(pin.y) >= most and abs(pin.y) > ON_AXIS * width:
            what = f"cover the end of the {part.shape}" if at_end else f"reach over the axis of the {part.shape}"
            least = 2.0 * abs(pin.y) + (width if at_end else 0.0)
            arm = ", or let an arm reach it (arms)" if "arms" in part.takes else ""
            raise CaseError(
                f"pin {pin.name} is {abs(pin.y):.4g} mm off the link's axis, so its eye does not {what}: move the pin "
                f"to less than {most:.4g} mm off the axis, or set eye_diameter above {least:.4g} mm{arm}"
            )
    pairs = list(itertools.combinations(on_axis, 2))
    pairs += [(foot, arm) for arm in body.pins for foot in on_axis if arm.foot == (foot.x, foot.y)]
    for (one, other), side in itertools.product(pairs, (1.0, -1.0)):
        distance = math.hypot(other.x - one.x, other.y - one.y if other.foot else 0.0)
        shoulders = _shoulder(body, one, side), _shoulder(body, other, side)
        if min(shoulders) > 0.0 and distance <= (1.0 + TOUCHING) * sum(shoulders):
            eyes = " and ".join(dict.fromkeys(f"{body.ring(pin).diameter:.4g} mm" for pin in (one, other)))
            raise CaseError(
                f"the eyes at {one.name} and {other.name}, or their fillets, overlap: move the points more than "
                f"{sum(shoulders):.4g} mm apart (now {distance:.4g} mm), or reduce eye_diameter "
                f"{eyes} or fillet_radius {part.fillet_radius:.4g} mm"
            )
