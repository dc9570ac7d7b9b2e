"""``result.json``: what a check found, as plain data. ``docs/result.md`` describes every field."""

import json
import math
import tomllib
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from alula.fea.outcomes.result import CheckResult, HandResult, LinkResult, LoadCaseResult, SolidResult
from alula.geometry.base.version import result_stamp
from alula.loads.sources.published_statics import StaticsAudit
from alula.loads.statics.statics import Reactions
from alula.loads.text.caveat import Heading
from alula.reports.sentences import told
from alula.reports.tables.clearance import clearance_record
from alula.reports.tables.data import change_records, check_records, data, entries, finite
from alula.reports.tables.frames import frame_record, reaction_records
from alula.reports.tables.frequencies import frequencies_record
from alula.reports.tables.friction import friction_record
from alula.reports.tables.layers import layer_record
from alula.reports.tables.loads import air_record, anchor_record, case_air_record
from alula.reports.tables.mechanism import design_record
from alula.reports.tables.meshes import discretisation_record, solver_record
from alula.reports.tables.second_opinion import opinion_records
from alula.reports.tables.springs import standing_record
from alula.reports.tables.whole import mass_record, size_record

_MATERIAL = "title density youngs_modulus poissons_ratio strength allowable sources status"


@cache
def field_units() -> dict[str, Any]:
    """Return the unit of every dimension and, under ``fields``, of every field of ``result.json``."""
    found = tomllib.loads(files("alula.reports.tables").joinpath("units.toml").read_text(encoding="utf-8"))
    return {**found["dimensions"], "fields": found["fields"]}


def result_record(result: CheckResult) -> dict[str, Any]:
    """Return a check's result as data that JSON can hold.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    dict
        As ``docs/result.md`` describes it. Infinite and undefined numbers are None, and ``nulls`` lists them.
    """
    first = next(iter(result.load_cases.values()))
    record = {
        **result_stamp(),
        "units": field_units(),
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
        "checks": check_records(check for case in result.load_cases.values() for check in case.checks),
        "changes": change_records(result),
        "hand_calculations": [*_cantilevers(result), *_comparisons(result.load_cases.values())],
        "clearance": clearance_record(result.clearance),
        "flapping": case_air_record(result.in_air) or None,
        "mass": mass_record(result.mass),
        "size": size_record(result.size),
        "frequencies": frequencies_record(result.frequencies),
        "load_cases": {name: _load_case(result, name) for name in result.load_cases},
        "materials": {
            name: entries(result.case.all_materials[name], _MATERIAL)
            for name in dict.fromkeys(result.case.part_of(link).material for link in result.case.checked_links)
        },
        "published_statics": None if result.audit is None else _audit(result.audit),
        "design": design_record(result.case),
        "second_opinions": opinion_records(result.second_opinions),
        "conditions": entries(result.case.conditions, "duration temperature"),
        "not_checked": [str(one) for one in result.caveats if one.heading is Heading.NOT_CHECKED],
        "caveats": [entries(one, "heading topic what why") for one in result.caveats],
        "assumptions": list(result.case.assumptions),
        "warnings": data(result.warnings),
        "timings": dict(result.timings),
    }
    nulls: dict[str, str] = {}
    found = finite(record, nulls)
    assert isinstance(found, dict)
    return found | {"nulls": nulls}


def as_json(result: CheckResult) -> str:
    """Return ``result_record`` as the text of ``result.json``; strict JSON, without NaN or infinity.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    str
    """
    return json.dumps(result_record(result), indent=2, ensure_ascii=False, allow_nan=False)


def worst_load_case(result: CheckResult, link: str) -> LoadCaseResult:
    """Return the load case with the lowest end of a link's safety factor, or with an unknown one.

    Parameters
    ----------
    result : CheckResult
    link : str
        Its name.

    Returns
    -------
    LoadCaseResult
    """
    return min(result.load_cases.values(), key=lambda case: case.links[link].severity)


def _pose(result: CheckResult) -> dict[str, Any]:
    pose = result.pose
    angles = {link: math.degrees(angle) % 360.0 for link, angle in pose.angles.items()}

    drive = None if result.case.pose.equilibrium else result.case.pinned_drive
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
    return None if reactions.drive is None else reactions.driving[0]


def _drive_force(reactions: Reactions) -> float | None:
    drive = reactions.drive
    return None if drive is None or not drive.pushes(reactions.pose.linkage) else reactions.driving[1]


def _reactions(case: LoadCaseResult) -> list[dict[str, Any]]:
    return [
        {"load_case": case.name} | reaction | {"moment": reaction["wrench"][5]}
        for reaction in reaction_records(case.reactions)
    ]


def _link(result: LinkResult) -> dict[str, Any]:
    bands = "von_mises_max principal_max safety_factor displacement_max"
    return entries(result, f"fidelity {bands} location notes") | {
        "decided_by": result.decided_by or None,
        "why": told(result.why) or None,
        "layers": layer_record(result.layers),
        "beam": None
        if result.beam.without
        else {
            "equivalent_max": result.beam.worst.equivalent,
            "x": result.beam.worst_x,
            "safety_factor": result.beam.safety_factor,
        },
        **_by_model(result),
    }


def _by_model(result: LinkResult) -> dict[str, Any]:
    """Return the entries that only one of the models gives; those of the other are None."""
    if isinstance(result, SolidResult):
        return entries(result, "elements unknowns") | {
            "next_cost": None,
            "governing": result.governing.title,
            "variants": [entries(v, "span transfer von_mises principal displacement") for v in result.variants],
            "discretisation": discretisation_record(result.discretisation),
            **solver_record(result.solution),
        }
    assert isinstance(result, HandResult)
    solid = ("elements", "unknowns", "governing", "discretisation", "solver", "solver_reason", "solver_error")
    return {"next_cost": data(result.next_cost), "variants": [], **dict.fromkeys(solid)}


def _worst_link(result: CheckResult, link: str) -> dict[str, Any]:
    """The link under the load case that stresses it most, with the displacement of the one that moves it most."""
    worst = worst_load_case(result, link)
    moved = max(result.load_cases.values(), key=lambda case: case.links[link].displacement_max.high)
    return _link(worst.links[link]) | {
        "load_case": worst.name,
        "displacement_max": data(moved.links[link].displacement_max),
        "displacement_load_case": moved.name,
    }


def _load_case(result: CheckResult, name: str) -> dict[str, Any]:
    case = result.load_cases[name]
    return {
        "title": result.case.load_cases[name].title,
        "statics": _statics(case),
        "drive_torque": _drive_torque(case.reactions),
        "drive_force": _drive_force(case.reactions),
        **({} if case.work is None else {"friction": friction_record(case.work, case.loads)}),
        "anchor": anchor_record(case),
        "air": air_record(result, name),
        **standing_record(case.standing),
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
        entries(comparison, "kind x hand solid difference")
        | {
            "name": f"{comparison.kind} stress of {link} at x = {comparison.x:.1f} mm",
            "link": link,
            "load_case": case.name,
            "unit": "MPa",
        }
        for case in cases
        for link, found in case.links.items()
        if isinstance(found, SolidResult)
        for comparison in found.comparisons
    ]


def _audit(audit: StaticsAudit) -> dict[str, Any]:
    return entries(audit, "source reproduced printed_error rounding_bound") | {
        "columns": [
            {"name": name, "published": float(published), "exact": float(exact), "printed": float(printed)}
            for name, published, exact, printed in zip(
                audit.columns, audit.published, audit.exact, audit.printed, strict=True
            )
        ],
        "rows": [entries(row, "number link defect valid") for row in audit.rows],
        "imbalances": [entries(left, "link force moment") for left in audit.imbalances],
    }
