"""The air's forces and what the anchor must hold, as data for ``result.json`` and for the page."""

from typing import Any

from fea.anchor import anchor_loads
from fea.result import CheckResult, LoadCaseResult
from loads.aero import shares

UNITS = {
    "anchor.joints.force": "N",
    "anchor.joints.moment": "N*mm",
    "anchor.total.force": "N",
    "anchor.total.moment": "N*mm",
    "air.speed": "mm/s",
    "air.density": "tonne/mm^3",
    "air.area": "mm^2",
    "air.dynamic_pressure": "MPa",
    "air.lift": "N",
    "air.drag": "N",
    "air.lift_coefficient": "1",
    "air.drag_coefficient": "1",
    "air.lift_direction": "1",
    "air.drag_direction": "1",
    "air.force": "N",
    "air.spread.share": "1",
}


def anchor_record(case: LoadCaseResult) -> dict[str, Any]:
    """Return force and moment on the ground at each of its joints, and their total."""
    anchor = anchor_loads(case)
    return {
        "joints": [
            {"joint": name, "force": [float(x) for x in wrench[:3]], "moment": [float(x) for x in wrench[3:]]}
            for name, wrench in anchor.joints.items()
        ],
        "total": {
            "about": anchor.about,
            "force": [float(x) for x in anchor.total[:3]],
            "moment": [float(x) for x in anchor.total[3:]],
        },
        "deformed": anchor.deformed,
    }


def air_record(result: CheckResult, name: str) -> list[dict[str, Any]]:
    """Return lift and drag of every air load of a load case, with its coefficients and where it acts."""
    points = result.case.link_points
    found = []
    for air, forces in zip(result.case.load_cases[name].air, result.case.air_forces(name), strict=True):
        lift, drag = forces.coefficients or (None, None)
        found.append(
            {
                "title": air.title,
                "given": forces.given,
                "speed": air.speed,
                "density": air.density,
                "area": air.area,
                "dynamic_pressure": forces.pressure,
                "lift": forces.lift,
                "drag": forces.drag,
                "lift_coefficient": lift,
                "drag_coefficient": drag,
                "lift_direction": [float(x) for x in forces.lift_direction],
                "drag_direction": [float(x) for x in forces.drag_direction],
                "force": [float(x) for x in forces.total],
                "spread": [
                    {
                        "link": patch.link,
                        "where": patch.at or f"{patch.start} to {patch.end}",
                        "shape": "point" if patch.at else patch.shape,
                        "share": share,
                    }
                    for patch, share in zip(air.spread, shares(air, points), strict=True)
                ],
                "warnings": list(forces.warnings),
            }
        )
    return found
