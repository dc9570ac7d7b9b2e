"""The air's forces and what the anchor must hold, as data for ``result.json`` and for the page."""

from typing import Any

from fea.anchor import anchor_loads
from fea.result import CheckResult, LoadCaseResult
from loads.aero import shares

UNITS = {
    "load_cases.*.anchor.force": "N",
    "load_cases.*.anchor.moment": "N*mm",
    "load_cases.*.air.dynamic_pressure": "MPa",
    "load_cases.*.air.speed": "mm/s",
    "load_cases.*.air.density": "tonne/mm^3",
    "load_cases.*.air.area": "mm^2",
    "load_cases.*.air.lift": "N",
    "load_cases.*.air.drag": "N",
    "load_cases.*.air.force": "N",
}


def anchor_record(case: LoadCaseResult) -> dict[str, Any]:
    """Return force and moment on the ground at each of its joints, and their total."""
    anchor = anchor_loads(case)
    return {
        "joints": {
            name: {"force": [float(x) for x in wrench[:3]], "moment": [float(x) for x in wrench[3:]]}
            for name, wrench in anchor.joints.items()
        },
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
