"""Links by themselves: safety factor, stress, displacement, hand calculation beside the solid, meshes."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from alula.fea.outcomes.result import CheckResult, HandResult, LinkResult, LoadCaseResult, SolidResult
from alula.fea.refine.discretisation import Discretisation
from alula.fea.whole.build_directions import BuildDirections, build_directions_of
from alula.reports.sections.data import data, entries
from alula.reports.sections.layers import layer_parts, layer_record
from alula.reports.sections.markup import bold
from alula.reports.sections.section import (
    Beside,
    Column,
    Folded,
    Group,
    Items,
    Number,
    Part,
    Picture,
    Section,
    Table,
    Text,
    say,
    words,
)
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import agreement, apart
from alula.reports.words.numbers import joined, number, plain, sentence

LEAST_TOLD = 1e-9
"""Solver error below which its size is not stated."""
_SERIES = "sizes values order kind factor index"


def links_section(result: CheckResult) -> Section:
    """Return each link under the load case that stresses it most.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    names = tuple(next(iter(result.load_cases.values())).links)
    layers = build_directions_of(result)
    drive = f"; the drive torque enters as “{result.case.drive.transfer}”" if result.case.drive else ""
    intro = Text(
        f"Each link is a free body under its joint forces{drive}. x runs along the link from its first point, y in the "
        "plane of the linkage, z along the pins.",
        "lead-in",
    )
    return Section(
        key="links",
        title="Link by link",
        short="Links",
        parts=(intro, *_summary(result, names), *(_group(result, name, layers) for name in names)),
        data={
            "links": {name: _worst(result, name) for name in names},
            "load_cases": {
                name: {
                    "title": result.case.load_cases[name].title,
                    "links": {link: _link(found) for link, found in case.links.items()},
                }
                for name, case in result.load_cases.items()
            },
        },
        not_covered=(("Bands", _bands(result)),),
    )


def _summary(result: CheckResult, names: Sequence[str]) -> Iterator[Part]:
    """Yield a table of all links, each under its worst load case, and one under every load case."""
    cases = result.load_cases.values()
    lost = [case.name for case in cases if case.gives_way]
    if lost:
        under = f" under {joined(lost)}" if len(cases) > 1 else ""
        yield Text(
            f"The linkage gives way{under}, so no link passes: numbers of the links are those of the undeformed pose, "
            "which is no equilibrium.",
            "apart",
        )
    every = [(case, link) for case in cases for link in case.links.values()]
    if len(cases) == 1:
        yield _table(every, several=False, key="links")
        return
    worst = [result.governing(name) for name in names]
    yield _table([(case, case.links[name]) for case, name in zip(worst, names, strict=True)], several=True)
    yield Folded("Under each load case", (_table(every, several=True, key="links"),), told=True)


def _table(rows: Sequence[tuple[LoadCaseResult, LinkResult]], *, several: bool, key: str = "") -> Table:
    return Table.of(
        (
            words("link"),
            words("load case", hidden=not several),
            words("model"),
            words("stress"),
            Column("stress (band)", "MPa"),
            Column("safety factor (band)"),
            Column("displacement (band)", "mm"),
            Column("largest at x", "mm"),
        ),
        [
            (
                link.link,
                case.name,
                link.model,
                link.measure,
                Number(link.decisive),
                Number(link.safety_factor),
                Number(link.displacement_max, beside=1000.0 * case.reactions.pose.linkage.longest),
                Number(float(link.location[0]), decimals=1),
            )
            for case, link in rows
        ],
        key=key,
    )


def _group(result: CheckResult, name: str, layers: Mapping[str, BuildDirections]) -> Group:
    """Return all of one link under the load case that stresses it most."""
    worst = result.governing(name)
    found = worst.links[name]
    parts: list[Part] = []
    picture = Picture(
        name=f"stress-{name}",
        model=f"link-{name}",
        alt=f"{found.measure[:1].upper()}{found.measure[1:]} stress of link {name} on its deformed shape",
        caption=f"{found.measure[:1].upper()}{found.measure[1:]} stress of link {name} [MPa]"
        f"{f', {told(found.governing.title)}' if isinstance(found, SolidResult) else ''}. The picture states the scale "
        "of the displacements.",
    )
    parts.append(Beside((picture, _numbers(result, found))))
    parts += _decided(found)
    if name in layers:
        parts += layer_parts(layers[name])
    parts += _by_hand(result, found)
    parts += _meshes(found)
    several = len(result.load_cases) > 1
    remark = f"under load case {worst.name}, which stresses it most" if several else ""
    return Group(f"Link {name}", tuple(parts), key=f"link-{name}", remark=remark)


def _numbers(result: CheckResult, found: LinkResult) -> Table:
    material = result.case.material_of(found.link)
    size = 1000.0 * result.pose.linkage.longest
    first, second = (found.principal_max, found.von_mises_max)[:: 1 if found.brittle else -1]
    kinds = ("principal", "von Mises")[:: 1 if found.brittle else -1]
    heading = "Solid model" if isinstance(found, SolidResult) else "Hand calculation" if found.decided_by else ""
    rows = (
        (f"safety factor n on {material.strength} strength {plain(material.allowable)} MPa", found.safety_factor, 0.0),
        (f"largest {kinds[0]} stress (decides n) [MPa]", first, 0.0),
        (f"largest {kinds[1]} stress [MPa]", second, 0.0),
        ("largest displacement [mm]", found.displacement_max, size),
    )
    return Table(
        columns=(words(heading or "beam theory", wraps=True), Column("value (band)")),
        rows=tuple((title, Number(value, beside=beside)) for title, value, beside in rows),
    )


def _decided(found: LinkResult) -> Iterator[Part]:
    x, y, z = (Number(float(at), decimals=1) for at in found.location)
    which = found.measure if found.brittle else "largest von Mises"
    held = [told(text) for text in found.safety_factor.texts]
    source = f"Sources of error in the band: {joined(held)}" if held else ""
    if not found.safety_factor.sources:
        source = f"No band: {told(found.safety_factor.without)}"
    yield say(
        "The {which} stress is at x = {x}, y = {y}, z = {z} mm. {source}",
        "small", which=which, x=x, y=y, z=z, source=source,
    )  # fmt: skip
    if found.decided_by:
        how = "hand calculation" if found.decided_by == "beam" else "a solid model"
        saved = f". Saved: {told(found.next_cost)}" if isinstance(found, HandResult) and found.next_cost else ""
        yield say("Decided by {how}: {why}{saved}", "small", how=how, why=found.why, saved=saved)


def _by_hand(result: CheckResult, found: LinkResult) -> Iterator[Part]:
    """Yield diagram and beam stress of a link, beside its solid where there is one."""
    right: list[Part] = []
    if not found.beam.without:
        worst = found.beam.worst
        right.append(
            say(
                "Largest section stress by beam theory {stress} at x = {x} mm (axial {axial}, bending {bending}), "
                "safety factor {factor} without stress concentration",
                "small",
                stress=Number(worst.equivalent, "MPa"),
                x=Number(found.beam.worst_x, decimals=1),
                axial=Number(worst.axial, "", 3, beside=worst.equivalent, derived=True),
                bending=Number(worst.bending, "MPa", 3, beside=worst.equivalent, derived=True),
                factor=Number(found.beam.safety_factor),
            )
        )
    if isinstance(found, SolidResult):
        right += _compared(found)
    if not right:
        return
    if found.beam.without:
        yield from right
        return
    cut = (
        " Moments are those about the centroids of the sections that were cut; the lowest row is the largest stress of "
        "each."
    )
    yield Beside(
        (
            Picture(
                name=f"diagram-{found.link}",
                alt=f"Normal force, shear force and bending moment along link {found.link}",
                caption=f"Hand calculation of link {found.link}: normal force N (tension positive), shear force V and "
                f"bending moment M. A positive M compresses the side y > 0.{cut if found.beam.cuts else ''}",
                draw=lambda: _diagram(result, found),
            ),
            *right,
        )
    )


def _diagram(result: CheckResult, found: LinkResult) -> Any:
    from alula.reports.figures.diagrams import internal_force_diagram

    stations = {point: x for point, (x, _) in result.case.links[found.link].points.items()}
    return internal_force_diagram(found.beam, stations)


def _compared(found: SolidResult) -> Iterator[Part]:
    """Yield hand calculation and solid model at some sections."""
    if not found.comparisons:
        what = "one of a beam" if found.beam.cuts else "at least one diameter away from every eye, hole and loaded end"
        yield Text(
            f"No section of this link is {what}, so there is no comparison of hand calculation and solid model.", "note"
        )
        return
    kind, far = found.comparisons[0].kind, apart(found.comparisons)
    yield Table(
        key="comparisons",
        columns=(Column("x", "mm"), Column("hand", "MPa"), Column("solid", "MPa"), Column("difference")),
        rows=tuple(
            (Number(c.x, decimals=1), Number(c.hand), Number(c.solid), Number(c.difference, share=True))
            for c in found.comparisons
        ),
        caption=f"Hand calculation and solid model: {kind} stress at sections away from eyes and holes",
        apart=frozenset(i for i, c in enumerate(found.comparisons) if c in far),
        under=(("link", found.link), ("kind", kind)),
    )
    text = f"The difference is relative to the largest {kind} stress of the link by hand calculation. "
    told_of = agreement(found.comparisons)
    if far:
        places = joined([number(c.x, 3) for c in far])
        text += bold(f"{told_of[:1].upper()}{told_of[1:]} at x = {places} mm")
        text += ": see the notes." if found.notes else "."
    else:
        text += sentence(told_of)
    yield Text(text, "small")


def _meshes(found: LinkResult) -> Iterator[Part]:
    """Yield mesh, solver, variants and notes."""
    parts: list[Part] = []
    if isinstance(found, SolidResult):
        error = max(found.solution.solver_error, LEAST_TOLD)
        parts.append(
            say(
                f"{found.elements:,} tetrahedra, {found.unknowns:,} unknowns. Solved by {{solver}} ({{why}}), relative "
                f"error below {error:.0e}",
                "small",
                solver=found.solution.solver,
                why=found.solution.solver_reason,
            )
        )
        if len(found.variants) > 1:
            parts.append(
                Table(
                    columns=(
                        words("variant"),
                        Column("von Mises", "MPa"),
                        Column("principal", "MPa"),
                        Column("displacement", "mm"),
                    ),
                    rows=tuple(
                        (
                            f"{told(variant.title)}{' (value)' if variant is found.governing else ''}",
                            Number(variant.von_mises),
                            Number(variant.principal),
                            Number(variant.displacement, "", 3),
                        )
                        for variant in found.variants
                    ),
                    caption="Variants in the band",
                )
            )
    if found.notes:
        parts.append(Items(tuple(sentence(told(note)) for note in found.notes), "notes"))
    if parts:
        yield Folded("Mesh, variants and notes" if isinstance(found, SolidResult) else "Notes", tuple(parts))


def discretisation_record(found: Discretisation) -> dict[str, Any]:
    """Return the convergence of a link over its meshes as entries of ``result.json``.

    Parameters
    ----------
    found : Discretisation

    Returns
    -------
    dict
    """
    return entries(found, "status accuracy") | {
        "sentence": told(found.reason),
        "stress": entries(found.stress, _SERIES),
        "displacement": entries(found.displacement, _SERIES),
        "meshes": [entries(mesh, "elements unknowns error seconds") for mesh in found.meshes],
        "sharp": found.sharp and entries(found.sharp, "place growth theory distance screening"),
    }


def solver_record(answer: object) -> dict[str, Any]:
    """Return the solver of a link's displacements, the reason for its choice and its error.

    Parameters
    ----------
    answer : SolidSolution or LinkEnvelope

    Returns
    -------
    dict
    """
    return entries(answer, "solver solver_reason solver_error")


def _link(result: LinkResult) -> dict[str, Any]:
    bands = "von_mises_max principal_max safety_factor displacement_max"
    return entries(result, f"fidelity {bands} location notes") | {
        "decided_by": result.decided_by or None,
        "why": data(result.why) or None,
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
            "governing": data(result.governing.title),
            "variants": [entries(v, "span transfer von_mises principal displacement") for v in result.variants],
            "discretisation": discretisation_record(result.discretisation),
            **solver_record(result.solution),
        }
    assert isinstance(result, HandResult)
    solid = ("elements", "unknowns", "governing", "discretisation", "solver", "solver_reason", "solver_error")
    return {"next_cost": data(result.next_cost) or None, "variants": [], **dict.fromkeys(solid)}


def _worst(result: CheckResult, link: str) -> dict[str, Any]:
    """The link under the load case that stresses it most, with the displacement of the one that moves it most."""
    worst = result.governing(link)
    moved = max(result.load_cases.values(), key=lambda case: case.links[link].displacement_max.high)
    return _link(worst.links[link]) | {
        "load_case": worst.name,
        "displacement_max": data(moved.links[link].displacement_max),
        "displacement_load_case": moved.name,
    }


def _bands(result: CheckResult) -> str:
    every = [link for case in result.load_cases.values() for link in case.links.values()]
    loaded = [link for link in every if not math.isinf(link.safety_factor.value)]
    alone = _names(link for link in loaded if link.safety_factor.without)
    solid = _names(link for link in loaded if link.link not in alone and isinstance(link, SolidResult))
    hand = _names(link for link in loaded if link.link not in (*alone, *solid))
    found = []
    if solid:
        found.append(f"the discretisation error in the bands of {joined(solid)} is an estimate, not a bound")
    if hand:
        was = "was" if len(hand) == 1 else "were"
        found.append(f"{joined(hand)} {was} not meshed: the bands come from solid models of similar parts")
    if alone:
        reasons = [told(link.safety_factor.without) for link in loaded]
        why = joined(list(dict.fromkeys(filter(None, reasons))))
        found.append(f"{joined(alone)} {'has' if len(alone) == 1 else 'have'} no band for model error ({why})")
    text = "; ".join(found)
    return f"{text[:1].upper()}{text[1:]}." if text else "No load acts on any checked link."


def _names(links: Iterable[LinkResult]) -> list[str]:
    return list(dict.fromkeys(link.link for link in links))
