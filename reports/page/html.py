"""``report.html``: one file with all text and pictures, which loads nothing from elsewhere."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from alula.fea.common.verdict import CheckOutcome, Subject, by_nearness, worst_of_each
from alula.fea.outcomes.result import CheckResult, LinkResult, LoadCaseResult, SolidResult
from alula.geometry.linkage.pose import NEAR_DEAD_POINT
from alula.geometry.materials.material import Material
from alula.loads.case.forks import forked_link
from alula.loads.statics.rounding import without_rounding
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.page.coverage import not_covered
from alula.reports.page.decided import held, meaning, reasons
from alula.reports.page.frequencies_page import frequencies_view
from alula.reports.page.pictures import (
    ASSEMBLY,
    BOX,
    CONTACT,
    diagram_name,
    flapping_name,
    governing_load_cases,
    layers_name,
    linkage_name,
    stress_name,
)
from alula.reports.page.template import fill
from alula.reports.tables.clearance import MOST, clearance_line, clearance_record
from alula.reports.tables.data import change_records
from alula.reports.tables.frames import AXES, linkage_line, play_line, shown_components, thrust_line, tips
from alula.reports.tables.friction import friction_sentence
from alula.reports.tables.layers import BuildDirections, build_directions_of
from alula.reports.tables.loads import air_lines, air_record, anchor_record, case_air_record, weight_sentence
from alula.reports.tables.mechanism import design_of
from alula.reports.tables.meshes import solver_sentence
from alula.reports.tables.record import worst_load_case
from alula.reports.tables.springs import holding_sentence, spring_sentences
from alula.reports.tables.whole import whole_table
from alula.reports.turnable.link import link_name
from alula.reports.turnable.moving import CHECK_CAPTION, LINKAGE
from alula.reports.turnable.script import viewer
from alula.reports.words.numbers import plain, turning
from alula.reports.words.wording import agreement, apart, checks_of, headline, named

MOST_CHECKS = 8
"""That the first page shows; the others stand below."""
_PROPERTIES = (
    ("density", "density", "kg/m³", 1e12),
    ("youngs_modulus", "Young's modulus E", "GPa", 1e-3),
    ("poissons_ratio", "Poisson's ratio ν", "", 1.0),
    ("yield_strength", "yield strength", "MPa", 1.0),
    ("ultimate_strength", "ultimate strength", "MPa", 1.0),
    ("strength_across_layers", "strength across layers", "MPa", 1.0),
    ("shear_strength_between_layers", "shear strength between layers", "MPa", 1.0),
)


def render(
    result: CheckResult,
    figures: Mapping[str, Drawing],
    published: str = "",
    models: Mapping[str, str] = MappingProxyType({}),
) -> str:
    """Return the report as one HTML page.

    Parameters
    ----------
    result : CheckResult
    figures : mapping
        Drawings by the names of ``alula.reports.page.pictures``; the page omits missing ones.
    published : str, optional
        How many published figures ``claims.html`` beside the page has, in a sentence; "" where there is none.
    models : mapping, optional
        Data blocks of the models that a reader can turn, by the names of ``alula.reports.turnable``; the page omits
        missing ones.

    Returns
    -------
    str
    """
    first, layers = next(iter(result.load_cases.values())), build_directions_of(result)
    checks, worst = by_nearness(checks_of(result)), worst_of_each(checks_of(result))
    several = len(result.load_cases) > 1
    return fill(
        "report.html.jinja",
        styles=("report.css", "turnable.css"),
        script=viewer() if models else "",
        result=result,
        case=result.case,
        pose=result.pose,
        first=first,
        several=several,
        verdict=result.verdict.value,
        headline=headline(result, short=True),
        meaning=meaning(result.verdict, "In this pose"),
        checks=checks,
        most_checks=MOST_CHECKS,
        applicable=sum(check.applies for check in checks),
        worst=worst,
        worst_reasons=reasons(worst),
        bands=held(checks_of(result)),
        reasons=reasons(checks),
        drawings=_drawings(result, checks, figures),
        assembly=figures.get(ASSEMBLY),
        contact=figures.get(CONTACT),
        frequencies=frequencies_view(result.frequencies, figures),
        clearance=clearance_record(result.clearance),
        clearance_line=clearance_line(result.clearance),
        most_gaps=MOST,
        whole=whole_table(result),
        box=figures.get(BOX),
        dead_points=_dead_points(result),
        near_dead_point=NEAR_DEAD_POINT,
        anchors={name: anchor_record(case) for name, case in result.load_cases.items()},
        air={name: found for name in result.load_cases if (found := air_record(result, name))},
        flapping={
            name: {**found, "picture": figures.get(flapping_name(name)), "lines": air_lines(found)}
            for name, found in case_air_record(result.in_air).items()
        },
        turning=turning,
        axes=AXES,
        tips=tips(result.case),
        shown_components=shown_components,
        without_rounding=without_rounding,
        weight_sentence=weight_sentence,
        friction_sentence=friction_sentence,
        holding_sentence=holding_sentence,
        linkage_line=linkage_line,
        thrust_line=thrust_line,
        play_line=play_line,
        solver_sentence=solver_sentence,
        named=named,
        changes=change_records(result),
        spring_sentences=spring_sentences,
        bonded=" and ".join(
            f"{kind} joints ({', '.join(names)})"
            for kind, clamped in (("bonded", False), ("clamped", True))
            if (names := [n for n, j in result.pose.linkage.joints.items() if j.bonded and j.clamped == clamped])
        ),
        forked=any(forked_link(result.case, name) is not None for name in result.case.joints),
        guided=[name for name, joint in result.pose.linkage.joints.items() if joint.type == "slider"],
        links=[_link(result, link, figures, layers, models) for link in first.links],
        agreement=agreement,
        materials=_materials(result),
        published=published,
        not_covered=not_covered(result),
        design=design_of(result.case),
        linkage_model=models.get(LINKAGE),
        linkage_caption=CHECK_CAPTION,
        linkage_still="",
    )


def _drawings(
    result: CheckResult, checks: Sequence[CheckOutcome], figures: Mapping[str, Drawing]
) -> list[tuple[str, Drawing | None, str]]:
    """Return (load case, picture of the linkage, its caption), that of the check nearest to its limit first."""
    names = list(governing_load_cases(result))
    decisive = checks[0].load_case if checks else ""
    names.sort(key=lambda name: name != decisive)
    return [(name, figures.get(linkage_name(name)), _caption(result, name)) for name in names]


def _caption(result: CheckResult, name: str) -> str:
    """Return the caption of a load case's picture of the linkage: what it shows and what it leaves out."""
    stated = result.case.load_cases[name]
    told = [
        f"Load case “{name}”{f': {stated.title}' if stated.title else ''}. To scale.",
        "Each joint force is drawn as it acts on the link in its label; "
        "the other link of the joint bears the opposite force.",
    ]
    if stated.own_weight:
        told.append("The own weight of the links acts as well; it is not drawn.")
    if stated.speed:
        told.append("The inertia of the links acts as well; it is not drawn.")
    if len(shown_components(result.load_cases[name].reactions)) > 3:
        told.append("Forces and moments out of the plane are not drawn.")
    if stated.air:
        told.append("The air’s force is drawn as far as it lies in the plane.")
    return " ".join(told)


def _dead_points(result: CheckResult) -> list[tuple[str, str, float]]:
    """(what, link, distance from its dead point)."""
    pose, drive = result.pose, None if result.case.pose.equilibrium else result.case.pinned_drive
    found = []
    if pose.coordinate is not None:
        distance = pose.dead_point_distance(pose.coordinate, slides=pose.slides)
        found.append(("the pose coordinate", pose.coordinate, distance))
    if drive is not None:
        found.append(("the driven link", drive.link, drive.dead_point_distance(pose)))
    return found


def _link(
    result: CheckResult,
    name: str,
    figures: Mapping[str, Drawing],
    layers: Mapping[str, BuildDirections],
    models: Mapping[str, str],
) -> dict[str, Any]:
    """Return the entries of one link under its governing load case."""
    worst: LoadCaseResult = worst_load_case(result, name)
    found: LinkResult = worst.links[name]
    return {
        "name": name,
        "load_case": worst.name,
        "gives_way": worst.gives_way,
        "found": found,
        "material": result.case.material_of(name),
        "part": result.case.part_of(name),
        "plot": figures.get(stress_name(name)),
        "model_data": models.get(link_name(name)),
        "layers": layers.get(name),
        "build_map": figures.get(layers_name(name)),
        "diagram": figures.get(diagram_name(name)),
        "solid": found if isinstance(found, SolidResult) else None,
        "apart": apart(found.comparisons) if isinstance(found, SolidResult) else [],
        "model": _model(found),
        "checks": [c for c in worst.checks if c.subject == Subject.link(name)],
        "others": [(case.name, case.links[name]) for case in result.load_cases.values() if case is not worst],
    }


def _model(found: LinkResult) -> str:
    """Return the model of a link's numbers; beam theory that decides is called hand calculation."""
    if isinstance(found, SolidResult):
        return "Solid model"
    return "Hand calculation" if found.decided_by else "Beam theory"


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
