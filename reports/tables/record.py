"""``result.json``: what a check found, as plain data. ``docs/result.md`` describes every field."""

import json
import math
from collections.abc import Iterable, Mapping
from typing import Any

from fea.outcomes.result import CheckResult, HandResult, LinkResult, LoadCaseResult, SolidResult
from fea.outcomes.unchecked import unchecked
from geometry.base.version import result_stamp
from geometry.parts.material import Material
from loads.sources.published_statics import StaticsAudit
from loads.statics.statics import Reactions
from reports.tables.bands import band_record
from reports.tables.frames import UNITS as FRAME_UNITS
from reports.tables.frames import frame_record, reaction_records
from reports.tables.loads import UNITS as LOAD_UNITS
from reports.tables.loads import air_record, anchor_record
from reports.tables.mechanism import design_record
from reports.tables.meshes import UNITS as MESH_UNITS
from reports.tables.meshes import discretisation_record, solver_record
from reports.tables.second_opinion import UNITS as OPINION_UNITS
from reports.tables.second_opinion import opinion_records

UNITS = {
    "length": "mm",
    "force": "N",
    "moment": "N*mm",
    "stress": "MPa",
    "angle": "deg",
    "time": "s",
    "density": "tonne/mm^3",
}
FIELD_UNITS = {
    "pose.points": "mm",
    "pose.link_angles": "deg",
    "pose.coordinate_angle": "deg",
    "pose.coordinate_travel": "mm",
    "drive_force": "N",
    "pose.closure_residual": "share of the longest link",
    "pose.longest_link": "mm",
    "pose.mobility": "1",
    "pose.dead_points.*.distance": "1",
    "statics.size": "1",
    "statics.condition": "1",
    "statics.residual": "share of the load",
    "reactions.force": "N",
    "reactions.magnitude": "N",
    "reactions.moment": "N*mm",
    "drive_torque": "N*mm",
    "links.*.von_mises_max": "MPa",
    "links.*.principal_max": "MPa",
    "links.*.safety_factor": "1",
    "links.*.displacement_max": "mm",
    "links.*.location": "mm",
    "links.*.elements": "1",
    "links.*.unknowns": "1",
    "links.*.variants.span": "deg",
    "links.*.variants.von_mises": "MPa",
    "links.*.variants.principal": "MPa",
    "links.*.variants.displacement": "mm",
    "links.*.beam.equivalent_max": "MPa",
    "links.*.beam.x": "mm",
    "links.*.beam.safety_factor": "1",
    "checks.value": "named by checks.unit",
    "checks.limit": "named by checks.unit",
    "hand_calculations.x": "mm",
    "hand_calculations.hand": "named by hand_calculations.unit",
    "hand_calculations.solid": "named by hand_calculations.unit",
    "hand_calculations.difference": "ratio",
    "materials.*.density": "tonne/mm^3",
    "materials.*.youngs_modulus": "MPa",
    "materials.*.poissons_ratio": "1",
    "materials.*.allowable": "MPa",
    "published_statics.columns": "N; N*m for T",
    "published_statics.printed_error": "N; N*m for T",
    "published_statics.rounding_bound": "N; N*m for T",
    "published_statics.rows.number": "1",
    "published_statics.rows.defect": "share of the row",
    "published_statics.imbalances.force": "N",
    "published_statics.imbalances.moment": "N*mm",
    "conditions.duration": "s",
    "conditions.temperature": "degC",
    "timings": "s",
} | {**FRAME_UNITS, **LOAD_UNITS, **MESH_UNITS, **OPINION_UNITS}


def result_record(result: CheckResult) -> dict[str, Any]:
    """Return a check's result as data that JSON can hold.

    Infinite and undefined numbers become null; ``nulls`` names each and what it stands for.
    """
    first = next(iter(result.load_cases.values()))
    record = {
        **result_stamp(),
        "units": UNITS | {"fields": FIELD_UNITS},
        "case": result.name,
        "title": result.case.title,
        "source": result.case.source,
        "verdict": result.verdict.value,
        "pose": _pose(result),
        "statics": _statics(first),
        "reactions": [entry for case in result.load_cases.values() for entry in _reactions(case)],
        "drive_torque": _drive_torque(first.reactions),
        "drive_force": _drive_force(first.reactions),
        "links": {name: _worst_link(result, name) for name in first.links},
        "checks": [
            {
                "name": check.name,
                "link": check.link,
                "load_case": check.load_case,
                "quantity": check.quantity,
                "unit": check.unit or "1",
                "value": band_record(check.value),
                "limit": check.limit,
                "verdict": check.verdict.value,
                "reason": check.reason,
            }
            for case in result.load_cases.values()
            for check in case.checks
        ],
        "hand_calculations": [*_cantilevers(result), *_comparisons(result.load_cases.values())],
        "load_cases": {name: _load_case(result, name) for name in result.load_cases},
        "materials": {
            name: _material(result.case.all_materials[name])
            for name in dict.fromkeys(result.case.part_of(link).material for link in result.case.checked_links)
        },
        "published_statics": None if result.audit is None else _audit(result.audit),
        "design": design_record(result.case),
        "second_opinions": opinion_records(result.second_opinions),
        "conditions": {
            "duration": result.case.conditions.duration,
            "temperature": result.case.conditions.temperature,
        },
        "not_checked": list(unchecked(result.case)),
        "assumptions": list(result.case.assumptions),
        "warnings": list(result.warnings),
        "timings": dict(result.timings),
    }
    nulls: dict[str, str] = {}
    finite = _finite(record, "", nulls)
    assert isinstance(finite, dict)
    return finite | {"nulls": nulls}


def as_json(result: CheckResult) -> str:
    """Return ``result_record`` as the text of ``result.json``; strict JSON, without NaN or infinity."""
    return json.dumps(result_record(result), indent=2, ensure_ascii=False, allow_nan=False)


def worst_load_case(result: CheckResult, link: str) -> LoadCaseResult:
    """The load case whose band of the safety factor reaches lowest on a link, or is unknown."""
    return min(result.load_cases.values(), key=lambda case: case.links[link].severity)


def _pose(result: CheckResult) -> dict[str, Any]:
    pose = result.pose
    angles = {link: math.degrees(angle) % 360.0 for link, angle in pose.angles.items()}

    drive = result.case.pinned_drive
    slides = pose.slides

    return {
        "points": {name: [float(x) for x in at] for name, at in pose.points.items()},
        "link_angles": angles,
        "coordinate": pose.coordinate,
        "coordinate_angle": None if pose.coordinate is None or slides else angles[pose.coordinate],
        "coordinate_travel": pose.held if slides else None,
        "mobility": pose.linkage.mobility,
        "closure_residual": pose.residual,
        "longest_link": pose.linkage.longest,
        "dead_points": {
            "pose_coordinate": None
            if pose.coordinate is None
            else {"link": pose.coordinate, "distance": pose.dead_point_distance(pose.coordinate, slides=slides)},
            "driven_link": None if drive is None else {"link": drive.link, "distance": drive.dead_point_distance(pose)},
        },
    }


def _statics(case: LoadCaseResult) -> dict[str, Any]:
    return {
        "size": len(case.reactions.system.rhs),
        "condition": case.forces.condition,
        "residual": case.reactions.residual,
    }


def _drive_torque(reactions: Reactions) -> float | None:
    return None if reactions.drive is None else reactions.drive_torque


def _drive_force(reactions: Reactions) -> float | None:
    drive = reactions.drive
    return None if drive is None or not drive.pushes(reactions.pose.linkage) else reactions.drive_force


def _reactions(case: LoadCaseResult) -> list[dict[str, Any]]:
    return [
        {"load_case": case.name} | reaction | {"moment": reaction["wrench"][5]}
        for reaction in reaction_records(case.reactions)
    ]


def _link(result: LinkResult) -> dict[str, Any]:
    return {
        "fidelity": result.fidelity,
        "decided_by": result.decided_by or None,
        "why": result.why or None,
        "von_mises_max": band_record(result.von_mises_max),
        "principal_max": band_record(result.principal_max),
        "safety_factor": band_record(result.safety_factor),
        "displacement_max": band_record(result.displacement_max),
        "location": [float(x) for x in result.location],
        "beam": {
            "equivalent_max": result.beam.worst.equivalent,
            "x": result.beam.worst_x,
            "safety_factor": result.beam.safety_factor,
        },
        "notes": list(result.notes),
        **_by_model(result),
    }


def _by_model(result: LinkResult) -> dict[str, Any]:
    """What one model alone gives; what the other would give is null."""
    solid = ("elements", "unknowns", "governing", "discretisation", "solver", "solver_reason", "solver_error")
    if isinstance(result, SolidResult):
        return {
            "next_cost": None,
            "elements": result.elements,
            "unknowns": result.unknowns,
            "governing": result.governing.title,
            "variants": [
                {
                    "span": variant.span,
                    "transfer": variant.transfer,
                    "von_mises": variant.von_mises,
                    "principal": variant.principal,
                    "displacement": variant.displacement,
                }
                for variant in result.variants
            ],
            "discretisation": discretisation_record(result.discretisation),
            **solver_record(result.solution),
        }
    assert isinstance(result, HandResult)
    return {"next_cost": result.next_cost or None, "variants": [], **dict.fromkeys(solid)}


def _worst_link(result: CheckResult, link: str) -> dict[str, Any]:
    """The link under the load case that stresses it most, with the displacement of the one that moves it most."""
    worst = worst_load_case(result, link)
    moved = max(result.load_cases.values(), key=lambda case: case.links[link].displacement_max.high)
    return _link(worst.links[link]) | {
        "load_case": worst.name,
        "displacement_max": band_record(moved.links[link].displacement_max),
        "displacement_load_case": moved.name,
    }


def _load_case(result: CheckResult, name: str) -> dict[str, Any]:
    case = result.load_cases[name]
    return {
        "title": result.case.load_cases[name].title,
        "statics": _statics(case),
        "drive_torque": _drive_torque(case.reactions),
        "drive_force": _drive_force(case.reactions),
        "anchor": anchor_record(case),
        "air": air_record(result, name),
        **frame_record(case),
        "links": {link: _link(found) for link, found in case.links.items()},
    }


def _cantilevers(result: CheckResult) -> list[dict[str, Any]]:
    return [
        {
            "name": f"{name}: {what}",
            "link": None,
            "load_case": None,
            "kind": "cantilever",
            "x": 0.0,
            "unit": unit,
            "hand": value,
            "solid": None,
            "difference": None,
        }
        for name, hand in result.hand.items()
        for what, unit, value in (
            ("moment at the root", "N*mm", hand.moment),
            ("bending stress at the root", "MPa", hand.stress),
            ("safety factor", "1", hand.safety_factor),
        )
    ]


def _comparisons(cases: Iterable[LoadCaseResult]) -> list[dict[str, Any]]:
    return [
        {
            "name": f"{comparison.kind} stress of {link} at x = {comparison.x:.1f} mm",
            "link": link,
            "load_case": case.name,
            "kind": comparison.kind,
            "x": comparison.x,
            "unit": "MPa",
            "hand": comparison.hand,
            "solid": comparison.solid,
            "difference": comparison.difference,
        }
        for case in cases
        for link, found in case.links.items()
        if isinstance(found, SolidResult)
        for comparison in found.comparisons
    ]


def _material(material: Material) -> dict[str, Any]:
    return {
        "title": material.title,
        "density": material.density,
        "youngs_modulus": material.youngs_modulus,
        "poissons_ratio": material.poissons_ratio,
        "strength": material.strength,
        "allowable": material.allowable,
        "sources": dict(material.sources),
        "status": dict(material.status),
    }


def _audit(audit: StaticsAudit) -> dict[str, Any]:
    return {
        "source": audit.source,
        "reproduced": audit.reproduced,
        "columns": [
            {"name": name, "published": float(published), "exact": float(exact), "printed": float(printed)}
            for name, published, exact, printed in zip(
                audit.columns, audit.published, audit.exact, audit.printed, strict=True
            )
        ],
        "printed_error": audit.printed_error,
        "rounding_bound": audit.rounding_bound,
        "rows": [
            {"number": row.number, "link": row.link, "defect": row.defect, "valid": row.valid} for row in audit.rows
        ],
        "imbalances": [
            {"link": left.link, "force": [float(x) for x in left.force], "moment": left.moment}
            for left in audit.imbalances
        ],
    }


def _finite(value: Any, path: str, nulls: dict[str, str]) -> Any:
    """Return a copy with every infinite or undefined number replaced by None and written down in ``nulls``."""
    if isinstance(value, Mapping):
        return {key: _finite(item, f"{path}.{key}" if path else str(key), nulls) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item, f"{path}.{i}", nulls) for i, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        nulls[path] = "not a number" if math.isnan(value) else "infinite" if value > 0.0 else "minus infinite"
        return None
    return float(value) if isinstance(value, float) else value
