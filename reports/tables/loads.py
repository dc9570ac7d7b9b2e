"""Air forces and loads on the ground, as data for ``result.json`` and for the page."""

import math
from typing import Any

from fea.check.anchor import anchor_loads
from fea.outcomes.result import CheckResult, LoadCaseResult
from loads.case.case import Case
from loads.records.aero import shares
from loads.records.carried import CarriedSpread
from reports.words.wording import joined, plain

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
    "air.spread.span": "1",
}


def weight_sentence(case: Case, name: str) -> str:
    """Return in one sentence what weighs in a load case and what moves, and which links count as massless."""
    load_case = case.load_cases[name]
    if not load_case.own_weight and load_case.speed == 0.0:
        return "The links are massless in this load case; weights are among the stated forces"
    kind = "weight" if load_case.speed == 0.0 else "weight and inertia" if load_case.own_weight else "inertia"
    told = [f"The links have {kind} from volume and density of their parts"]
    if case.carried and load_case.carried:
        carried = [
            f"{mass.link} carries {plain(float(f'{mass.mass * 1e6:.4g}'))} g "
            + (f"spread from {mass.start} to {mass.end}" if isinstance(mass, CarriedSpread) else f"at {mass.at}")
            for mass in case.carried
        ]
        told.append(joined(carried))
    elif case.carried:
        told.append("carried masses are left out")
    if load_case.speed != 0.0:
        told.append(f"{case.pose.coordinate} turns at {plain(load_case.speed * 30.0 / math.pi)} rpm")
    if case.massless:
        told.append(f"{joined(list(case.massless))} {'is' if len(case.massless) == 1 else 'are'} massless")
    return "; ".join(told)


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
        "unstable": anchor.unstable,
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
                        "span": list(patch.span) if patch.at is None and patch.shape == "elliptic" else None,
                        "share": share,
                    }
                    for patch, share in zip(air.spread, shares(air, points), strict=True)
                ],
                "warnings": list(forces.warnings),
            }
        )
    return found
