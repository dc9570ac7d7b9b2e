"""The ornithopter's case by its rules: what the table ``[ornithopter]`` makes of the entries of its case file."""

import math

from alula.geometry.mechanisms.ornithopter import OrnithopterRules

_LEVERS = {"lever-right": ("R", 1.0), "lever-left": ("L", -1.0)}


def ornithopter_entries(rules: OrnithopterRules) -> dict[str, object]:
    """Work out the entries of the built-in case that the rules decide; wings, loads and checks stay as they are.

    Parameters
    ----------
    rules : OrnithopterRules
        The table ``[ornithopter]``.

    Returns
    -------
    dict of str to object
        Path of an entry -> its value, as the case file states it.

    Raises
    ------
    CaseError
        Where the rules leave no pin or no wall.
    """
    sizes, bodies = rules.dimensions(), rules.bodies("-")
    low, high = bodies["lever"].pins[0].span
    height = _mm(sizes.pivot_height)
    found: dict[str, object] = {
        "links.base.points.guide": ["0 mm", height],
        "links.crank.points.A": [_mm(rules.throw), "0 mm"],
        "links.rod.points.C": [_mm(sizes.link_length), "0 mm"],
        "joints.O.pin_diameter": _mm(bodies["crank"].pins[0].diameter),
    }
    for joint in ("A", "R", "L", "guide", "slot-right", "slot-left"):
        found[f"joints.{joint}.pin_diameter"] = _mm(sizes.hole_diameter)
    for link, (pivot, side) in _LEVERS.items():
        angle = math.degrees(-rules.wing_angle if side > 0.0 else math.pi + rules.wing_angle)
        found |= {
            f"links.base.points.{pivot}": [_mm(side * sizes.pivot_offset), height],
            f"links.{link}.points.slot": [_mm(-sizes.slot_reach), "0 mm"],
            f"links.{link}.slots.slot": {"first": _mm(low), "last": _mm(high), "clearance": _mm(0.0)},
            f"pose.near.{link}": f"{angle!r} deg",
        }
    for part, body in bodies.items():
        sizes_of_part = body.part.model_dump(exclude_unset=True, exclude={"shape", "material"})
        found |= {f"parts.{part}.{name}": _mm(length) for name, length in sizes_of_part.items()}
    return found


def _mm(length: float) -> str:
    return f"{length!r} mm"
