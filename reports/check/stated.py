"""The case as it was stated: description, assumptions, warnings, materials, hand calculations, and what none covers."""

from collections.abc import Iterator
from typing import Any

from alula.fea.asked.asked import asks
from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.geometry.materials.material import Material
from alula.loads.records.check_spec import FatigueCheck
from alula.loads.sources.published_statics import StaticsAudit
from alula.reports.sections.data import data, entries
from alula.reports.sections.markup import bold, code, link
from alula.reports.sections.section import Group, Items, Part, Section, Text, say
from alula.reports.sections.table import Column, Number, Table, words
from alula.reports.sentences import told
from alula.reports.sentences.caveats import by_heading, not_checked
from alula.reports.words.numbers import joined, plain, sentence

_MATERIAL = "title density youngs_modulus poissons_ratio strength allowable sources status"
_PROPERTIES = (
    ("density", "density", "kg/m³", 1e12),
    ("youngs_modulus", "Young's modulus E", "GPa", 1e-3),
    ("poissons_ratio", "Poisson's ratio ν", "", 1.0),
    ("yield_strength", "yield strength", "MPa", 1.0),
    ("ultimate_strength", "ultimate strength", "MPa", 1.0),
    ("strength_across_layers", "strength across layers", "MPa", 1.0),
    ("shear_strength_between_layers", "shear strength between layers", "MPa", 1.0),
)
_HAND = ("name", "link", "load_case", "kind", "x", "unit", "hand", "solid", "difference")
_FATIGUE_OF_LINKS = "Links that a check names were checked for loads that come and go in this pose; pins were not."
_IMPACT = "A sudden load causes higher stresses than the same load applied slowly."


def case_section(result: CheckResult, published: str = "") -> Section:
    """Return what the case states: description, source, assumptions; and the warnings on it.

    Parameters
    ----------
    result : CheckResult
    published : str, optional
        How many published figures ``claims.html`` has, in a sentence; "" where there is no such page.

    Returns
    -------
    Section
    """
    case, moves = result.case, result.case.motion is not None
    parts: list[Part] = [Text(case.description.strip(), "note")] if case.description else []
    if case.source:
        parts.append(Text(f"Source of the case: {case.source}.", "note"))
    if case.assumptions:
        parts += [Text("Assumptions of the case:", "note"), Items(case.assumptions, "note")]
    else:
        parts.append(Text("The case states no assumptions.", "note"))
    if published:
        page = link("claims.html", "claims.html")
        parts.append(Text(f"{published} They stand on a page of their own, {page} in the same folder.", "note"))
    if result.caveats:
        parts.append(Items(by_heading(result.caveats)))
    if result.warnings:
        parts.append(Items(tuple(f"Warning: {told(warning)}" for warning in result.warnings), "warnings"))
    envelope = code("alula envelope")
    return Section(
        key="case",
        title="The case",
        short="Case",
        parts=tuple(parts),
        data={
            "conditions": entries(case.conditions, "duration cycles reverses temperature"),
            "not_checked": not_checked(result.caveats),
            "caveats": [entries(one, "heading topic what why") for one in result.caveats],
            "assumptions": list(case.assumptions),
            "warnings": data(result.warnings),
            "timings": dict(result.timings),
            "kept": {"results": result.kept[0], "of": result.kept[1]},
        },
        not_covered=(
            ("Other poses", "Only this pose was checked; another pose can give higher stresses"
             + (f". The command {envelope} checks all poses of the motion." if moves else ".")),
            ("Fatigue", _FATIGUE_OF_LINKS) if asks(case, FatigueCheck) else
            ("Fatigue", "The loads are static. Repeated loads break parts at lower stresses"
             + (f". The command {envelope} checks fatigue over the motion." if moves else ".")),
            ("Creep, temperature, moisture, ageing", _conditions(result)),
            ("Impact", _IMPACT),
        ),
    )  # fmt: skip


def _conditions(result: CheckResult) -> str:
    stated = result.case.conditions
    held = "strengths and moduli are those at the stated temperature after the stated time, as far as cards tell"
    if stated.duration is None and stated.temperature is None:
        held = "the case states no conditions, so short-term values at room temperature are used"
    elif stated.temperature is None:
        held = "stiffness and stress are those after the stated time under load, at room temperature"
    elif stated.duration is None:
        held = "strengths and moduli are short-term values at the stated temperature, as far as cards tell"
    return (
        "Plastics lose strength and stiffness with time under load, temperature and age: "
        f"{held}. Moisture and ageing are not modelled."
    )


def materials_section(result: CheckResult) -> Section:
    """Return the materials of the links.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    used: dict[str, list[str]] = {}
    for name in result.case.checked_links:
        used.setdefault(result.case.part_of(name).material, []).append(name)
    cards = {name: result.case.all_materials[name] for name in used}
    level = result.case.level
    repeated = asks(result.case, FatigueCheck) or (level is not None and any(one.lasts for one in level.tests.values()))
    return Section(
        key="materials",
        title="Materials",
        short="Materials",
        parts=tuple(_material(name, card, used[name], repeated=repeated) for name, card in cards.items()),
        data={"materials": {name: entries(card, _MATERIAL) for name, card in cards.items()}},
        not_covered=(("Manufacture and scatter", _scatter(result, list(used))),),
    )


def _material(name: str, material: Material, links: list[str], *, repeated: bool) -> Group:
    factor = "yield strength over von Mises stress (ductile)"
    if material.brittle:
        factor = "ultimate strength over the largest principal stress (brittle)"
    rows = tuple(
        (
            title,
            Number(float(f"{value:.6g}"), unit, stated=True, factor=scale, derived=True),
            material.status.get(key, "not stated"),
            material.sources.get(key, "not stated"),
        )
        for key, title, unit, scale in _PROPERTIES
        for value in [getattr(material, key)]
        if value is not None
    )
    if repeated and (line := material.fatigue) is not None:
        title = f"fatigue strength, {line.cycles:g} cycles of stress ratio {plain(line.stress_ratio)}"
        strength = Number(line.stress, "MPa", stated=True, derived=True)
        rows += ((title, strength, material.status.get("fatigue", "not stated"), line.source),)
    columns = (words("property"), Column("value"), words("status"), words("source", wraps=True))
    table = Table(key="materials", columns=columns, rows=rows, under=(("material", name),), kind="keep")
    return Group(
        material.title,
        (Text(f"Links {joined(links)}. The safety factor is {factor}.", "note"), table),
        remark=code(name),
    )


def _scatter(result: CheckResult, used: list[str]) -> str:
    case = result.case
    bare = {
        "strength": [name for name in used if case.all_materials[name].strength_range is None],
        "modulus": [name for name in used if case.all_materials[name].youngs_modulus_range is None],
        "the loads": [name for name in result.load_cases if len(set(case.load_cases[name].scatter)) == 1],
    }
    whole = {"strength": len(used), "modulus": len(used), "the loads": len(result.load_cases)}
    missing = [
        what if len(names) == whole[what] else f"{what} ({joined(names)})" for what, names in bare.items() if names
    ]
    text = "The safety factor must cover voids, print layers, notches and scatter of dimensions"
    if missing:
        text += f", and scatter of {joined(missing)}, for which the case states no range"
    unknown = [
        name
        for name in case.checked_links
        for part in [case.part_of(name)]
        if part.build_direction is None and case.all_materials[part.material].strength_across_layers is not None
    ]
    text += ". Stated ranges are part of the bands."
    if unknown:
        text += (
            f" Safety factors of {joined(unknown)} hold layers of any direction, since no build_direction is stated."
        )
    return text


def hand_section(result: CheckResult) -> Section:
    """Return the hand calculations that the case asks for, and those beside solids as entries of ``result.json``.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    parts = []
    for name, hand in result.hand.items():
        stated = result.case.hand_calculations[name]
        parts.append(
            say(
                f"{bold(name)}: part “{stated.part}” as one cantilever of L = {{length}} under a uniform load of "
                "W = {load}. Moment at the root M = W L / 2 = {moment}, bending stress σ = M c / I = {stress}, safety "
                "factor n = {factor}. It contains neither joints nor stress concentrations: an order of magnitude, "
                "not a check",
                length=Number(stated.length, "mm", stated=True, derived=True),
                load=Number(stated.load, "N", stated=True, derived=True),
                moment=Number(hand.moment, "N·mm"),
                stress=Number(hand.stress, "MPa"),
                factor=Number(hand.safety_factor),
            )
        )
    return Section(
        key="hand",
        title="Hand calculations of the case",
        short="Hand calculations",
        parts=tuple(parts),
        data={"hand_calculations": [*_cantilevers(result), *_comparisons(result)]},
    )


def _cantilevers(result: CheckResult) -> Iterator[dict[str, Any]]:
    for name, hand in result.hand.items():
        for what, unit, value in (
            ("moment at the root", "N*mm", hand.moment),
            ("bending stress at the root", "MPa", hand.stress),
            ("safety factor", "1", hand.safety_factor),
        ):
            row = {"name": f"{name}: {what}", "kind": "cantilever", "x": 0.0, "unit": unit, "hand": value}
            yield dict.fromkeys(_HAND) | row


def _comparisons(result: CheckResult) -> Iterator[dict[str, Any]]:
    for case in result.load_cases.values():
        for name, found in case.links.items():
            for one in found.comparisons if isinstance(found, SolidResult) else ():
                yield entries(one, "kind x hand solid difference") | {
                    "name": f"{one.kind} stress of {name} at x = {one.x:.1f} mm",
                    "link": name,
                    "load_case": case.name,
                    "unit": "MPa",
                }


def audit_section(result: CheckResult) -> Section:
    """Return whether the published statics of the case are equilibrium equations; ``claims.html`` tells more.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    audit, parts = result.audit, list[Part]()
    if audit is not None:
        wrong = [str(row.number) for row in audit.rows if not row.valid]
        found = f"equations {joined(wrong)} are not equilibrium equations" if wrong else "all are equilibrium equations"
        parts.append(Text(f"Published statics ({audit.source}): {found} of this linkage."))
    record = None if audit is None else audit_record(audit)
    return Section(key="audit", title="Published statics", parts=tuple(parts), data={"published_statics": record})


def audit_record(audit: StaticsAudit) -> dict[str, Any]:
    """Return what was found of published statics as entries of ``result.json``.

    Parameters
    ----------
    audit : StaticsAudit

    Returns
    -------
    dict
    """
    columns = zip(audit.columns, data(audit.published), data(audit.exact), data(audit.printed), strict=True)
    return entries(audit, "source reproduced printed_error rounding_bound") | {
        "columns": [dict(zip(("name", "published", "exact", "printed"), row, strict=True)) for row in columns],
        "rows": [entries(row, "number link defect valid") for row in audit.rows],
        "imbalances": [entries(left, "link force moment") for left in audit.imbalances],
    }


def limits_section(sections: tuple[Section, ...]) -> Section:
    """Return what the verdict does not cover: each section says it of its own feature.

    Parameters
    ----------
    sections : tuple of Section

    Returns
    -------
    Section
    """
    every = tuple((title, sentence(text)) for section in sections for title, text in section.not_covered)
    return Section(
        key="limits",
        title="What the verdict does not cover",
        short="Not covered",
        parts=(Items(every, "columns2 note"),) if every else (),
    )
