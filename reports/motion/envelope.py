"""The least safety factor of each link over a motion, fatigue, and the checks over all poses."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from alula.fea.common.verdict import by_nearness
from alula.fea.motion.envelope_result import EnvelopeResult, LinkEnvelope, LoadCaseEnvelope
from alula.fea.outcomes.unchecked import caveats
from alula.geometry.linkage.motion import ends_of
from alula.geometry.materials.material import Material
from alula.reports.check.links import solver_record
from alula.reports.motion.friction import friction_over_motion, friction_texts
from alula.reports.motion.linkage import linkage_over_motion, linkage_text
from alula.reports.motion.whole_motion import model_section
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.page import Page, page_footer
from alula.reports.renderers.record import as_brief_record
from alula.reports.sections.checks import checks_section
from alula.reports.sections.data import data, entries
from alula.reports.sections.fatigue import fatigue_record, measure_of, scatter_of
from alula.reports.sections.section import (
    Cell,
    Column,
    Group,
    Items,
    Number,
    Part,
    Picture,
    Section,
    Series,
    Table,
    Text,
    say,
    words,
)
from alula.reports.sentences import told
from alula.reports.sentences.caveats import by_heading, not_checked
from alula.reports.sentences.verdicts import besides, opening
from alula.reports.turnable.moving import ENVELOPE_CAPTION
from alula.reports.words.numbers import fixed, sentence

UNITS = {"angle": "deg", "length": "mm", "stress": "MPa"}


def envelope_sections(result: EnvelopeResult) -> tuple[Section, ...]:
    """Return all that is told of an envelope.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    tuple of Section
    """
    return (
        _motion(result),
        model_section(result.case, ENVELOPE_CAPTION),
        checks_section(result.case, result.checks, result.verdict, "Over the motion"),
        _links(result),
        _fatigue(result),
        _linkage(result),
        _limits(result),
        provenance_section(result.case),
    )


def envelope_headline(result: EnvelopeResult) -> tuple[str, ...]:
    """Return the verdict of an envelope, what decides it, its tiers and what it stands on besides.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    tuple of str
        Paragraphs.
    """
    told = opening(result.case, result.verdict, by_nearness(result.checks), several=len(result.moved.forces) > 1)
    return tuple(filter(None, (*told, besides(caveats(result.case, over_motion=True)))))


def envelope_record(result: EnvelopeResult, sections: tuple[Section, ...]) -> dict[str, Any]:
    """Return an envelope as data that JSON can hold.

    Parameters
    ----------
    result : EnvelopeResult
    sections : tuple of Section
        As ``envelope_sections``.

    Returns
    -------
    dict
        As ``docs/result.md`` describes it: angles in degrees.
    """
    head = {"case": result.name, "title": result.case.title, "verdict": result.verdict.value}
    return as_brief_record(sections, **head, units=UNITS, timings_s=dict(result.timings))


def envelope_page(result: EnvelopeResult, sections: tuple[Section, ...]) -> Page:
    """Return the page of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    sections : tuple of Section
        As ``envelope_sections``.

    Returns
    -------
    Page
    """
    return Page(
        title=f"{result.verdict.value.capitalize()} over the motion: {result.case.title}",
        kind="Stress of a planar linkage over its motion",
        heading=result.case.title,
        verdict=result.verdict.value,
        lead=envelope_headline(result),
        sections=sections,
        footer=page_footer("envelope.csv"),
    )


def _motion(result: EnvelopeResult) -> Section:
    """Return which poses were evaluated, and the warnings."""
    motion = result.moved.motion
    ends = np.degrees(ends_of(result.angles))
    first, last = (Number(float(end), stated=True) for end in ends)
    told_range = (
        f"From {motion.coordinate} = {{first}}° to {{last}}°, "
        f"{'standing still' if result.drive is None else f'driven at {result.drive.link}'}; "
        f"{int(result.evaluated.sum())} of {len(result.angles)} poses were evaluated"
    )
    cycle = result.case.cycle
    if cycle is not None:
        told_range = f"Over the cycle of {{file}}: f{told_range[1:]}"
    parts: list[Part] = [say(told_range, first=first, last=last, file="" if cycle is None else cycle.file)]
    if result.idle:
        parts.append(Text(f"Links without load: {', '.join(result.idle)}."))
    if result.warnings:
        parts.append(Items(tuple(sentence(told(warning)) for warning in result.warnings), "warnings"))
    return Section(
        key="motion",
        title="The motion",
        short="Motion",
        parts=tuple(parts),
        data={
            "motion": {
                "coordinate": motion.coordinate.name,
                "first": float(np.degrees(result.angles[0])),
                "last": float(np.degrees(result.angles[-1])),
                "poses": len(result.angles),
                "evaluated": int(result.evaluated.sum()),
                "returns_to_start": motion.returns,
                "cycle": None if motion.instants is None else motion.progress.tolist(),
                "drive": None if result.drive is None else entries(result.drive, "link joint"),
                "dead_points": [math.degrees(angle) for angle in result.moved.dead_points],
            },
            "idle_links": list(result.idle),
            "warnings": [told(warning) for warning in result.warnings],
        },
    )


def _links(result: EnvelopeResult) -> Section:
    """Return the worst pose of every link under every load case, the least safety factor first."""

    def draw() -> Any:
        from alula.reports.figures.motion.envelope_figures import envelope_figure

        return envelope_figure(result)

    coordinate = result.moved.motion.coordinate.name
    drive = coordinate if result.drive is None else result.drive.link
    cycle = result.moved.motion.instants is not None
    columns = (
        words("link"),
        words("load case"),
        Column("safety factor (band)"),
        words("stress"),
        Column("stress", "MPa"),
        Column("at", "% of the cycle", hidden=not cycle),
        # of the driven link itself, both have one direction
        Column(f"{coordinate} at", "deg", hidden=coordinate == drive),
        Column(f"at {drive}", "deg"),
        words("at x, y, z [mm]"),
        Column("repetitions to failure", hidden=True),
    )
    every = [(link, found) for link in result.links.values() for found in link.load_cases.values()]
    rows: list[tuple[Cell, ...]] = []
    for link, found in sorted(every, key=lambda row: row[1].severity):
        at, life = _place(result, found), None if found.fatigue is None else found.fatigue.repetitions
        factor, stress = Number(found.safety_factor), Number(found.stress.value, "", 3)
        angles = (Number(at[key], decimals=1) for key in ("cycle", "coordinate", "drive"))
        place = ", ".join(fixed(x, 1) for x in at["location"])
        repetitions = Number(None if life is None else life.value)
        rows.append((link.link, found.name, factor, link.measure, stress, *angles, place, repetitions))
    caption = "Least safety factor over the motion"
    table = Table(key="links", columns=columns, rows=tuple(rows), caption=caption)
    curves = "Safety factor of each link over the motion, with its error band"
    plots = (
        Picture(name=f"stress-{name}", alt=f"Stress of link {name} in its worst pose",
                caption=f"Link {name} in its worst pose, under its worst load case.")
        for name in result.links
    )  # fmt: skip
    return Section(
        key="links",
        title="The worst pose of each link",
        short="Links",
        parts=(table, Picture(name="envelope", alt=curves, caption=f"{curves}.", draw=draw), *plots) if every else (),
        data={"links": {name: _link_record(result, link) for name, link in result.links.items()}},
        series=(_series(result),),
    )


def _series(result: EnvelopeResult) -> Series:
    """Return the curves over the motion, one load case below the other; omitted poses have nothing."""
    motion = result.moved.motion
    angles = {} if motion.instants is None else {motion.progress_title: motion.progress}
    angles |= {
        f"{motion.coordinate} angle [deg]": np.degrees(result.angles),
        **({} if result.drive is None else {f"{result.drive.link} angle [deg]": np.degrees(result.drive_angles)}),
    }
    columns: dict[str, dict[str, ArrayLike]] = {name: dict(angles) for name in result.case.load_cases}
    for name, of in columns.items():
        for link in result.links.values():
            of |= _curves(link, name, len(result.angles))
    return Series.below("envelope.csv", columns, digits=9)


def _curves(link: LinkEnvelope, load_case: str, count: int) -> dict[str, ArrayLike]:
    found, none = link.load_cases.get(load_case), np.full(count, np.nan)
    value, low, high = (none, none, none) if found is None else (found.value, found.low, found.high)
    with np.errstate(divide="ignore"):
        factor, most, least = (link.strength / np.maximum(stress, 0.0) for stress in (value, low, high))
    history = none if found is None or found.fatigue is None else found.fatigue.history
    columns = {
        f"{link.measure} stress [MPa]": value,
        f"{link.measure} stress low [MPa]": low,
        f"{link.measure} stress high [MPa]": high,
        "safety factor [1]": factor,
        "safety factor low [1]": least,
        "safety factor high [1]": most,
        "signed stress at the critical point [MPa]": history,
    }
    return {f"{link.link} {title}": curve for title, curve in columns.items()}


def _fatigue(result: EnvelopeResult) -> Section:
    """Return the cycles of stress at the critical point of each link, and how many repetitions it bears."""
    rows = [
        (link, found.name, found.fatigue)
        for link in result.links.values()
        for found in link.load_cases.values()
        if found.fatigue is not None
    ]
    stresses = (Column(title, "MPa") for title in ("smallest", "largest", "range"))
    columns = (words("link"), words("load case"), *stresses, Column("repetitions to failure (band)"))
    cells: list[tuple[Cell, ...]] = []
    for link, name, found in rows:
        sizes = (Number(x, "", 3) for x in (found.life.smallest, found.life.largest, found.life.stress_range))
        repeated = "unknown, no exponent" if found.repetitions is None else Number(found.repetitions, "", 2)
        cells.append((link.link, name, *sizes, repeated))
    caption = "Signed stress at the critical point over one motion"
    parts: list[Part] = [Table(key="fatigue", columns=columns, rows=tuple(cells), caption=caption)] if rows else []
    materials = {result.case.part_of(link.link).material: result.case.material_of(link.link) for link, _, _ in rows}
    parts += [
        Text(f"Fatigue of {one.title}: cycles of {measure_of(one)}; {scatter_of(one)}.") for one in materials.values()
    ]
    missing: dict[str, list[str]] = {}
    for name, link in result.links.items():
        if link.no_fatigue:
            missing.setdefault(told(link.no_fatigue), []).append(name)
    parts += [say(f"No fatigue of {', '.join(names)}: {{why}}", why=why) for why, names in missing.items()]
    return Section(key="fatigue", title="Fatigue", short="Fatigue", parts=tuple(parts))


def _linkage(result: EnvelopeResult) -> Section:
    """Return the linkage as a whole and friction, for every load case."""
    several = len(result.linkage) > 1

    def texts(name: str) -> Iterator[Text]:
        if name in result.linkage:
            yield linkage_text(result.moved, result.linkage[name])
        if name in result.work:
            yield from friction_texts(result.moved, result.work[name], name)

    every = {name: tuple(texts(name)) for name in dict.fromkeys((*result.linkage, *result.work))}
    parts = [part for name, own in every.items() for part in ((Group(f"Load case {name}", own),) if several else own)]
    record = {name: friction_over_motion(result.moved, work, name) for name, work in result.work.items()}
    return Section(
        key="linkage",
        title="The linkage as a whole",
        short="Linkage",
        parts=tuple(parts),
        data={
            "linkage": {name: linkage_over_motion(result.moved, over) for name, over in result.linkage.items()},
            **({"friction": record} if record else {}),
        },
    )


def _limits(result: EnvelopeResult) -> Section:
    """Return what the verdict stands on besides, which the headline tells too."""
    found = caveats(result.case, over_motion=True)
    items = by_heading(found)
    return Section(
        key="limits",
        title="What the verdict does not cover",
        short="Not covered",
        parts=(Items(items, "columns2 note"),) if items else (),
        data={
            "not_checked": not_checked(found),
            "caveats": [entries(one, "heading topic what why") for one in found],
        },
    )


def _link_record(result: EnvelopeResult, link: LinkEnvelope) -> dict[str, Any]:
    material = result.case.material_of(link.link)
    return entries(link, "measure strength elements unknowns imbalance notes") | {
        "worst_load_case": link.worst.name,
        "load_cases": {name: _load_case_record(result, found, material) for name, found in link.load_cases.items()},
        "no_fatigue": data(link.no_fatigue) or None,
        "unit_loads": link.units,
        "solutions": link.modes,
        **solver_record(link),
        "support_reaction": link.reaction,
    }


def _load_case_record(result: EnvelopeResult, found: LoadCaseEnvelope, material: Material) -> dict[str, Any]:
    return {
        **entries(found, "stress safety_factor"),
        "at": _place(result, found),
        "fatigue": None if found.fatigue is None else fatigue_record(found.fatigue, material),
    }


def _place(result: EnvelopeResult, found: LoadCaseEnvelope) -> dict[str, Any]:
    """Return where and how the worst stress acts, with directions of coordinate and drive [degrees]."""
    motion = result.moved.motion
    return {
        "pose": found.pose,
        "cycle": None if motion.instants is None else float(motion.progress[found.pose]),
        "coordinate": math.degrees(result.angles[found.pose]),
        "drive": math.degrees(result.drive_angles[found.pose]),
        "location": found.location.tolist(),
        "pin_pressure_span": found.governing.span,
        "transfer": found.governing.transfer,
    }
