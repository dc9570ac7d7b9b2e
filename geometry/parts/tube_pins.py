"""Pins straight through the walls of a tube without eyes: the rules that keep their holes and bushes within it."""

import itertools
import math

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body, apart
from alula.geometry.bodies.eyes import ROUNDING

SHARPEST = math.radians(45.0)
"""Least angle between a pin's hole and the tube's outside, where the hole reaches farthest from the axis.

The stress in a lip of angle β under a pin's pressure p has a limit of 4.7 p for 45°, 8.8 p for 33° and 14 p for 26° (a
wedge under pressure on one side: Barber, Elasticity, 3rd ed., section 11.1). It is that of the lip's very tip, where it
changes from side to side: meshes come near it at first order at best, and with 33° bands of three and four
meshes ended 2 to 6 % below what meshes 36 times as fine gave."""
DEEPEST = math.cos(SHARPEST)
"""Largest reach of a hole across the tube, from the tube's axis, over the outer radius."""
NARROWEST, WIDEST = 1.1, 0.8
"""Least diameter of a bush over that of its pin, and its largest reach from the tube's axis over the bore's radius.

Coarse meshes of thinner bushes fail; fillets beside wider ones are so small that meshing takes minutes."""


def check_pins_through(body: Body, ends: tuple[float, float], bush: float) -> None:
    """Refuse holes that reach a side or an end of the tube, and bushes that do not fit.

    Parameters
    ----------
    body : Body
        A body whose part is a tube without eyes.
    ends : tuple of float
        The x between which the tube lies [mm].
    bush : float
        Outer diameter of the bushes [mm]; 0 without.

    Raises
    ------
    CaseError
        With the pin, the rule and a remedy.
    """
    section = body.part.section
    outer, bore = section.half_y, section.radius_ratio * section.half_y
    for pin in body.pins:
        off = abs(pin.y)
        if pin.ring is not None:
            raise CaseError(f'the eye stated at {pin.name} has no meaning on a tube with eyes = "none"; leave it out')
        if off + pin.diameter / 2.0 > DEEPEST * outer:
            raise CaseError(
                f"the pin hole at {pin.name}, {pin.diameter:.4g} mm wide and {off:.4g} mm off the axis, leaves too "
                f"little of the tube's side: keep it within {DEEPEST * outer:.4g} mm of the axis, by a smaller "
                "pin_diameter, a larger outer_diameter, or a pin on the axis"
            )
        least, most = NARROWEST * pin.diameter, 2.0 * (WIDEST * bore - off)
        if bush > 0.0 and not (1.0 - ROUNDING) * least <= bush <= (1.0 + ROUNDING) * most:
            raise CaseError(
                f"bush_diameter {bush:.4g} mm is out of range at {pin.name}: with its pin of {pin.diameter:.4g} mm, "
                f"{off:.4g} mm off the axis, and the bore it must be {least:.4g} mm to {most:.4g} mm; change it, or "
                "state plug_length instead"
            )
        half = max(pin.diameter, bush) / 2.0
        if pin.x - half <= ends[0] or pin.x + half >= ends[1]:
            raise CaseError(
                f"the hole or bush at {pin.name} reaches the end of the tube: set overhang above {half:.4g} mm"
            )
    for one, other in itertools.combinations(body.pins, 2):
        if apart(one, other) <= bush:
            raise CaseError(
                f"the bushes at {one.name} and {other.name} overlap: set bush_diameter below {apart(one, other):.4g} "
                "mm, or move the pins further apart"
            )
