"""Linkages with slots and sliders as cases with parts, as a user writes them; and their links' balance."""

from typing import Any

import numpy as np

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import shifted

BAR = {
    "shape": "bar",
    "material": "pvc-paredes-2018",
    "width": "4 mm",
    "thickness": "3 mm",
    "eye_diameter": "7 mm",
    "eye_thickness": "3 mm",
    "fillet_radius": "0.2 mm",
}


def points(**places: tuple[float, float]) -> dict[str, Any]:
    return {name: [f"{float(x)!r} mm", f"{float(y)!r} mm"] for name, (x, y) in places.items()}


def joint(first: str, second: str, **entries: Any) -> dict[str, Any]:
    return {"links": [first, second], "pin_diameter": "2 mm"} | entries


def case_of(links: dict[str, Any], joints: dict[str, Any], pose: dict[str, Any], drive: str, *bare: str) -> Case:
    """Return a case in which every moving link but the ``bare`` ones is a bar; its ground is called ground.

    Parts are put in last: frames take beams along the axis, whatever the solids' rules say of slots in them.
    """
    ground, *moving = links
    data = {
        "schema_version": 1,
        "title": "a linkage with slots",
        "links": {ground: {"ground": True, "points": links[ground]}}
        | {name: {"points": links[name]} for name in moving},
        "joints": joints,
        "pose": pose,
        "drive": {"link": pose["coordinate"], "joint": drive},
        "parts": {"bar": BAR},
        "load_cases": {"none": {}},
    }
    case = validate(data)
    parts = {name: case.links[name].model_copy(update={"part": "bar"}) for name in moving if name not in bare}
    return case.model_copy(update={"links": case.links | parts})


def slider_crank(angle: float = 60.0, a: float = 40.0, b: float = 110.0, offset: float = 12.0) -> Case:
    """Crank a, rod b and a block without part that slides along x at the height ``offset``."""
    return case_of(
        {
            "ground": points(A=(0, 0), S=(0, offset)),
            "crank": points(A=(0, 0), B=(a, 0)),
            "rod": points(B=(0, 0), M=(b / 2, 0), C=(b, 0)),
            "block": points(C=(0, 0), Q=(10, 5)),
        },
        {
            "A": joint("ground", "crank"),
            "B": joint("crank", "rod"),
            "C": joint("rod", "block"),
            "S": joint("ground", "block", type="slider", points=["S", "C"]),
        },
        {"coordinate": "crank", "angle": f"{angle} deg", "near": {"rod": "-15 deg", "block": "0 deg"}},
        "A",
        "block",
    )


def quick_return(angle: float = 30.0, a: float = 30.0, d: float = 60.0, end: float = 150.0) -> Case:
    """Crank a about A whose pin B runs along the slot of a lever about O, which stands d below A; E is its tip."""
    return case_of(
        {
            "ground": points(A=(0, 0), O=(0, -d)),
            "crank": points(A=(0, 0), B=(a, 0)),
            "lever": points(O=(0, 0), E=(end, 0)),
        },
        {
            "A": joint("ground", "crank"),
            "O": joint("ground", "lever"),
            "B": joint("lever", "crank", type="pin-in-slot", points=["O", "B"]),
        },
        {"coordinate": "crank", "angle": f"{angle} deg", "near": {"lever": "75 deg"}},
        "A",
    )


def scotch_yoke(angle: float = 35.0, a: float = 30.0) -> Case:
    """Crank a whose pin B runs in the upright slot of a yoke that slides along x; the slot lies off the yoke's axis."""
    return case_of(
        {
            "ground": points(A=(0, 0), S=(0, 0)),
            "crank": points(A=(0, 0), B=(a, 0)),
            "yoke": points(Y=(0, 0), Z=(30, 0)),
        },
        {
            "A": joint("ground", "crank"),
            "S": joint("ground", "yoke", type="slider", points=["S", "Y"]),
            "B": joint("yoke", "crank", type="pin-in-slot", points=["Y", "B"], direction="90 deg"),
        },
        {"coordinate": "crank", "angle": f"{angle} deg", "near": {"yoke": "0 deg"}},
        "A",
    )


def oscillating_cylinder(angle: float = 70.0, a: float = 25.0, d: float = 80.0, bent: float = 0.0) -> Case:
    """Crank a whose pin B carries a rod, which slides in a cylinder about O: a slider between two moving links."""
    return case_of(
        {
            "ground": points(A=(0, 0), O=(d, 0)),
            "crank": points(A=(0, 0), B=(a, 0)),
            "cylinder": points(O=(0, 0), M=(50, 0)),
            "rod": points(B=(0, 0), N=(-45, 0)),
        },
        {
            "A": joint("ground", "crank"),
            "O": joint("ground", "cylinder"),
            "B": joint("crank", "rod"),
            "S": joint("cylinder", "rod", type="slider", points=["O", "B"], angle=f"{bent} deg"),
        },
        {"coordinate": "crank", "angle": f"{angle} deg", "near": {"cylinder": "160 deg"}},
        "A",
    )


def pin_on_the_ground(angle: float = 30.0) -> Case:
    """A crank's end carries a lever whose slot slides over a pin that stands on the ground."""
    return case_of(
        {
            "ground": points(A=(0, 0), P=(70, 5)),
            "crank": points(A=(0, 0), B=(25, 0)),
            "lever": points(B=(0, 0), E=(120, 0)),
        },
        {
            "A": joint("ground", "crank"),
            "B": joint("crank", "lever"),
            "P": joint("lever", "ground", type="pin-in-slot", points=["B", "P"]),
        },
        {"coordinate": "crank", "angle": f"{angle} deg", "near": {"lever": "-10 deg"}},
        "A",
    )


def piston_entries() -> dict[str, Any]:
    """Return the entries of a case whose piston is driven by its travel and turns a crank, as a user writes them."""
    bar = {
        "shape": "bar",
        "material": "pla-fdm-xy",
        "width": "8 mm",
        "thickness": "4 mm",
        "eye_diameter": "12 mm",
        "eye_thickness": "4 mm",
        "fillet_radius": "2 mm",
    }
    return {
        "schema_version": 1,
        "title": "a piston that drives its crank",
        "links": {
            "ground": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "S": ["0 mm", "-20 mm"]}},
            "crank": {
                "part": "bar",
                "points": {"O": ["0 mm", "0 mm"], "M": ["20 mm", "0 mm"], "P": ["40 mm", "0 mm"]},
            },
            "rod": {"part": "bar", "points": {"P": ["0 mm", "0 mm"], "C": ["120 mm", "0 mm"]}},
            "piston": {"points": {"C": ["0 mm", "0 mm"], "Q": ["10 mm", "0 mm"]}},
        },
        "joints": {
            "O": {"links": ["ground", "crank"], "pin_diameter": "3 mm"},
            "P": {"links": ["crank", "rod"], "pin_diameter": "3 mm"},
            "C": {"links": ["rod", "piston"], "pin_diameter": "3 mm"},
            "S": {"type": "slider", "links": ["ground", "piston"], "points": ["S", "C"]},
        },
        "pose": {
            "coordinate": "S",
            "travel": "130 mm",
            "near": {"crank": "60 deg", "rod": "-25 deg", "piston": "0 deg"},
        },
        "drive": {"link": "piston", "joint": "S"},
        "motion": {"travel": ["90 mm", "150 mm"], "travel_speed": "400 mm/s", "poses": 13, "inertia": False},
        "parts": {"bar": bar},
        "load_cases": {
            "brake": {"moments": [{"link": "crank", "at": "M", "moment": "-300 N*mm"}]},
        },
    }


def imbalance(reactions, loads, place=None) -> float:
    """Largest sum of forces, or of moments over the longest link, on any link; ``place`` (link, point) -> (3,)."""
    pose, worst = reactions.pose, 0.0
    if place is None:
        place = {(link, p): np.array([*pose.position(link, p), 0.0]) for link, p in pose.closure.point_names}
    for link in pose.linkage.moving:
        total = np.array([0.0, 0.0, 0.0, 0.0, 0.0, reactions.torque_on(link)])
        for point, wrench in reactions.on_link(link):
            total += shifted(wrench, place[link, point])
        for load in loads:
            if load.link == link:
                total += shifted(load.wrench, place[link, load.point])
        worst = max(worst, np.abs(total[:3]).max(), np.abs(total[3:]).max() / pose.linkage.longest)
    return float(worst)
