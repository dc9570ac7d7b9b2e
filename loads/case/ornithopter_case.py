"""The ornithopter's case by its rules: what the table ``[ornithopter]`` makes of the entries of its case file."""

import math

from geometry.mechanisms.ornithopter import OrnithopterRules
from geometry.parts.part import Body

_LEVERS = {"lever-right": 1.0, "lever-left": -1.0}


def ornithopter_settings(rules: OrnithopterRules) -> list[str]:
    """Return the entries of the built-in case that the rules decide, each as ``path=value``.

    Wings, loads and checks stay as they are. Raises ``CaseError`` where the rules leave no pin or no wall.
    """
    sizes, bodies = rules.dimensions(), rules.bodies("-")
    low, high = bodies["lever"].pins[0].span
    slot, height = (f'["{_mm(-sizes.slot_reach)}", "0 mm"]', _mm(sizes.pivot_height))
    found = [
        f'links.base.points.guide=["0 mm", "{height}"]',
        f'links.crank.points.A=["{_mm(rules.throw)}", "0 mm"]',
        f'links.rod.points.C=["{_mm(sizes.link_length)}", "0 mm"]',
        f'joints.O.pin_diameter="{_mm(bodies["crank"].pins[0].diameter)}"',
    ]
    joints = ("A", "R", "L", "guide", "slot-right", "slot-left")
    found += [f'joints.{name}.pin_diameter="{_mm(sizes.hole_diameter)}"' for name in joints]
    for link, side in _LEVERS.items():
        pivot = "R" if side > 0.0 else "L"
        angle = math.degrees(-rules.wing_angle if side > 0.0 else math.pi + rules.wing_angle)
        found += [
            f'links.base.points.{pivot}=["{_mm(side * sizes.pivot_offset)}", "{height}"]',
            f"links.{link}.points.slot={slot}",
            f'links.{link}.slots.slot={{first="{_mm(low)}", last="{_mm(high)}"}}',
            f'pose.near.{link}="{angle!r} deg"',
        ]
    for part, body in bodies.items():
        found += [f'parts.{part}.{name}="{value}"' for name, value in _lengths(body).items()]
    return found


def _lengths(body: Body) -> dict[str, str]:
    lengths = body.part.model_dump(exclude={"shape", "material"})
    return {name: _mm(value) for name, value in lengths.items()}


def _mm(length: float) -> str:
    return f"{length!r} mm"
