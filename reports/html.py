"""``report.html``: one file that holds everything, pictures included, and loads nothing from elsewhere."""

import base64
import math
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

from fea.claims import ClaimResult, check_claims
from fea.result import CheckResult, LinkResult, LoadCaseResult
from fea.verdict import Verdict
from geometry.material import Material
from geometry.pose import NEAR_DEAD_POINT
from loads.case_file import built_in_cases
from reports.claims import as_records, count
from reports.frames import AXES, shown_components
from reports.loads import air_record, anchor_record, weight_sentence
from reports.mechanism import design_of
from reports.meshes import solver_sentence
from reports.pictures import diagram_name, governing_load_cases, linkage_name, stress_name
from reports.record import alula_version, worst_load_case
from reports.wording import (
    AGREEMENT,
    band,
    checks_of,
    fixed,
    headline,
    joined,
    number,
    percent,
    plain,
    sentence,
    turning,
)

MEANING = {
    Verdict.PASS: "In this pose and under these loads every checked link keeps the margin that was asked for, "
    "wherever in its error band the truth lies. What the model leaves out is listed at the end.",
    Verdict.FAIL: "At least one check misses its limit wherever in its error band the truth lies: "
    "change the section, the material, the load, or how the linkage is held.",
    Verdict.UNDECIDED: "At least one answer cannot be given with the models that ran: its error band reaches over "
    "the limit, or the model leaves out what matters there. This is neither a pass nor a fail.",
}
NOT_COVERED = (
    ("Other poses", "One pose was checked. Another pose of the linkage may load a link more."),
    ("Stacking", "All links lie in one plane. In a real linkage they are stacked along the pins, and the offset "
     "bends and twists them."),
    ("Pins and contact", "A pin is a pressure on its hole. Clearance, friction, wear and what happens in the contact "
     "itself are left out; a pin's own strength is checked only where the case asks for it."),
    ("Fatigue", "The loads act once and stay. Loads that come and go break parts at lower stresses."),
    ("Creep, temperature, moisture, ageing", "Plastics lose strength and stiffness under load that lasts, in warmth "
     "and with the years; the material values are short-term ones at room temperature, unless the case states its "
     "conditions. Moisture and ageing are left out in any case."),
    ("Large displacements", "Up to 5 % of the span forces follow from the shape before loading; beyond, from the "
     "deformed one, under loads that keep their direction."),
    ("Buckling and impact", "A slender link in compression may give way sideways; a blow loads it more than the same "
     "load at rest."),
    ("Making", "Voids, layers, notches, scatter of dimensions and of strength are left to the safety factor."),
    ("Discretisation", "The error of the mesh is not in the bands: they hold what their list says and no more."),
)  # fmt: skip
_PROPERTIES = (
    ("density", "density", "kg/m³", 1e12),
    ("youngs_modulus", "Young's modulus E", "GPa", 1e-3),
    ("poissons_ratio", "Poisson's ratio ν", "", 1.0),
    ("yield_strength", "yield strength", "MPa", 1.0),
    ("ultimate_strength", "ultimate strength", "MPa", 1.0),
)


def _claims(result: CheckResult) -> dict[str, Any] | None:
    """Findings on what the source of a case published; None where it published nothing that is entered."""
    if not result.case.claims and result.name not in built_in_cases():
        return None
    found = _findings(result.name)
    return {"count": count(found), "rows": as_records(found)} if found else None


@cache
def _findings(name: str) -> tuple[ClaimResult, ...]:
    return check_claims(name, fidelity="beam")


def render(result: CheckResult, figures: Mapping[str, bytes]) -> str:
    """Return the report as one HTML page.

    figures   PNG pictures by the names of ``reports.pictures``; a missing one is left out of the page
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "number": number,
        "plain": plain,
        "fixed": fixed,
        "band": band,
        "percent": percent,
        "joined": joined,
        "sentence": sentence,
        "solved": solver_sentence,
        "degrees": lambda angle: number(math.degrees(angle) % 360.0, 6),
    }
    first = next(iter(result.load_cases.values()))
    return environment.get_template("report.html.jinja").render(
        result=result,
        case=result.case,
        pose=result.pose,
        first=first,
        several=len(result.load_cases) > 1,
        verdict=result.verdict.value,
        headline=headline(result),
        meaning=MEANING[result.verdict],
        checks=checks_of(result),
        bands=_bands(result),
        drawings=[
            (name, result.load_cases[name], figures.get(linkage_name(name))) for name in governing_load_cases(result)
        ],
        dead_points=_dead_points(result),
        near_dead_point=NEAR_DEAD_POINT,
        anchors={name: anchor_record(case) for name, case in result.load_cases.items()},
        air={name: found for name in result.load_cases if (found := air_record(result, name))},
        turning=turning,
        axes=AXES,
        shown_components=shown_components,
        weight_sentence=weight_sentence,
        guided=[name for name, joint in result.pose.linkage.joints.items() if joint.type == "slider"],
        links=[_link(result, link, figures) for link in first.links],
        agreement=AGREEMENT,
        materials=_materials(result),
        claims=_claims(result),
        not_covered=NOT_COVERED,
        design=design_of(result.case),
        version=alula_version(),
        data_uri=data_uri,
    )


def data_uri(picture: bytes) -> str:
    """Return a PNG as a URI that holds it."""
    return "data:image/png;base64," + base64.b64encode(picture).decode("ascii")


def _bands(result: CheckResult) -> dict[str, tuple[str, ...]]:
    """What the bands in the table of checks hold: name of the check -> each source of error once, without particulars.

    A check without any width stands there only where its values say why (``nothing: ...``).
    """
    checks = checks_of(result)
    wide = {check.name for check in checks if check.value.low < check.value.high}
    found: dict[str, dict[str, None]] = {}
    for check in checks:
        for held in check.value.holds:
            if check.name in wide or held.startswith("nothing"):
                told = held.partition(" (")[0]
                found.setdefault(check.name, {})[re.sub(r"^nothing: (.*)$", r"nothing (\1)", told)] = None
    return {name: tuple(held) for name, held in found.items()}


def _dead_points(result: CheckResult) -> list[tuple[str, str, float]]:
    """(what, link, distance from its dead point)."""
    pose, drive = result.pose, result.case.pinned_drive
    found = []
    if pose.coordinate is not None:
        distance = pose.dead_point_distance(pose.coordinate, slides=pose.slides)
        found.append(("the pose coordinate", pose.coordinate, distance))
    if drive is not None:
        found.append(("the driven link", drive.link, drive.dead_point_distance(pose)))
    return found


def _link(result: CheckResult, name: str, figures: Mapping[str, bytes]) -> dict[str, Any]:
    """What the page tells of one link, under the load case that stresses it most."""
    worst: LoadCaseResult = worst_load_case(result, name)
    found: LinkResult = worst.links[name]
    apart = [c for c in found.comparisons if abs(c.difference) > AGREEMENT]
    return {
        "name": name,
        "load_case": worst.name,
        "found": found,
        "material": result.case.material_of(name),
        "part": result.case.part_of(name),
        "plot": figures.get(stress_name(name)),
        "diagram": figures.get(diagram_name(name)),
        "apart": apart,
        "checks": [c for c in worst.checks if c.link == name],
        "others": [(case.name, case.links[name]) for case in result.load_cases.values() if case is not worst],
    }


def _materials(result: CheckResult) -> list[dict[str, Any]]:
    used: dict[str, list[str]] = {}
    for link in result.case.checked_links:
        used.setdefault(result.case.part_of(link).material, []).append(link)
    return [_material(name, result.case.all_materials[name], links) for name, links in used.items()]


def _material(name: str, material: Material, links: list[str]) -> dict[str, Any]:
    rows = [
        (title, f"{plain(float(f'{value * factor:.6g}'))} {unit}".strip(),
         material.status.get(key, "not stated"), material.sources.get(key, "not stated"))
        for key, title, unit, factor in _PROPERTIES
        for value in [getattr(material, key)]
        if value is not None
    ]  # fmt: skip
    return {"name": name, "title": material.title, "links": links, "rows": rows, "strength": material.strength,
            "allowable": material.allowable, "brittle": material.brittle}  # fmt: skip
