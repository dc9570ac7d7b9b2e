"""Links by themselves: safety factor, stress, displacement, hand calculation beside the solid, meshes."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from alula.fea.outcomes.result import CheckResult, HandResult, LinkResult, LoadCaseResult, SolidResult
from alula.fea.refine.discretisation import Discretisation
from alula.fea.whole.build_directions import BuildDirections, build_directions_of
from alula.reports.figures.diagrams import internal_force_diagram
from alula.reports.sections.data import data, entries
from alula.reports.sections.layers import layer_parts, layer_record
from alula.reports.sections.markup import bold
from alula.reports.sections.section import Beside, Folded, Group, Items, Part, Picture, Section, Text, say
from alula.reports.sections.table import Column, Number, Table, numbers, words
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
    open_cases = [case.name for case in cases if case.large_displacement.unfollowed]
    lost = [case.name for case in cases if case.gives_way and case.name not in open_cases]
    for how, where in (("gives way", lost), ("was not followed to its load", open_cases)):
        if where:
            under = f" under {joined(where)}" if len(cases) > 1 else ""
            yield Text(
                f"The linkage {how}{under}, so no link passes: numbers of the links are those of the undeformed pose, "
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
    links = [link for _, link in rows]
    sizes = (1000.0 * case.reactions.pose.linkage.longest for case, _ in rows)
    return Table.by_columns(
        {
            words("link"): [link.link for link in links],
            words("load case", hidden=not several): [case.name for case, _ in rows],
            words("model"): [link.model for link in links],
            words("stress"): [link.measure for link in links],
            Column("stress (band)", "MPa"): numbers(link.decisive for link in links),
            Column("safety factor (band)"): numbers(link.safety_factor for link in links),
            Column("displacement (band)", "mm"): [
                Number(link.displacement_max, beside=size) for link, size in zip(links, sizes, strict=True)
            ],
            Column("largest at x", "mm"): numbers((link.location[0] for link in links), decimals=1),
        },
        key=key,
    )


def _group(result: CheckResult, name: str, layers: Mapping[str, BuildDirections]) -> Group:
    """Return all of one link under the load case that stresses it most."""
    worst = result.governing(name)
    found = worst.links[name]
    measure = f"{found.measure[:1].upper()}{found.measure[1:]}"
    case = f", {told(found.governing.title)}" if isinstance(found, SolidResult) else ""
    picture = Picture(
        name=f"stress-{name}",
        model=f"link-{name}",
        alt=f"{measure} stress of link {name} on its deformed shape",
        caption=f"{measure} stress of link {name} [MPa]{case}. The picture states the scale of the displacements.",
    )
    parts = [
        Beside((picture, _numbers(result, found))),
        *_decided(found),
        *(layer_parts(layers[name]) if name in layers else ()),
        *_by_hand(result, found),
        *_meshes(found),
    ]
    remark = f"under load case {worst.name}, which stresses it most" if len(result.load_cases) > 1 else ""
    return Group(f"Link {name}", tuple(parts), key=f"link-{name}", remark=remark)


def _numbers(result: CheckResult, found: LinkResult) -> Table:
    material = result.case.material_of(found.link)
    largest = {"von Mises": found.von_mises_max, "principal": found.principal_max}
    first, second = sorted(largest, reverse=not found.brittle)
    heading = "Solid model" if isinstance(found, SolidResult) else "Hand calculation" if found.decided_by else ""
    strength = f"{material.strength} strength {plain(material.allowable)} MPa"
    rows = {
        f"safety factor n on {strength}": Number(found.safety_factor),
        f"largest {first} stress (decides n) [MPa]": Number(largest[first]),
        f"largest {second} stress [MPa]": Number(largest[second]),
        "largest displacement [mm]": Number(found.displacement_max, beside=1000.0 * result.pose.linkage.longest),
    }
    return Table(
        columns=(words(heading or "beam theory", wraps=True), Column("value (band)")), rows=tuple(rows.items())
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
    compared = _compared(found) if isinstance(found, SolidResult) else ()
    if found.beam.without:
        yield from compared
        return
    worst = found.beam.worst
    stress = say(
        "Largest section stress by beam theory {stress} at x = {x} mm (axial {axial}, bending {bending}), "
        "safety factor {factor} without stress concentration",
        "small",
        stress=Number(worst.equivalent, "MPa"),
        x=Number(found.beam.worst_x, decimals=1),
        axial=Number(worst.axial, "", 3, beside=worst.equivalent, derived=True),
        bending=Number(worst.bending, "MPa", 3, beside=worst.equivalent, derived=True),
        factor=Number(found.beam.safety_factor),
    )
    cut = (
        " Moments are those about the centroids of the sections that were cut; the lowest row is the largest stress of "
        "each."
    )
    stations = {point: x for point, (x, _) in result.case.links[found.link].points.items()}
    diagram = Picture(
        name=f"diagram-{found.link}",
        alt=f"Normal force, shear force and bending moment along link {found.link}",
        caption=f"Hand calculation of link {found.link}: normal force N (tension positive), shear force V and "
        f"bending moment M. A positive M compresses the side y > 0.{cut if found.beam.cuts else ''}",
        draw=lambda: internal_force_diagram(found.beam, stations),
    )
    yield Beside((diagram, stress, *compared))


def _compared(found: SolidResult) -> Iterator[Part]:
    """Yield hand calculation and solid model at some sections."""
    if not found.comparisons:
        what = "one of a beam" if found.beam.cuts else "at least one diameter away from every eye, hole and loaded end"
        yield Text(
            f"No section of this link is {what}, so there is no comparison of hand calculation and solid model.", "note"
        )
        return
    every, kind, far = found.comparisons, found.comparisons[0].kind, apart(found.comparisons)
    yield Table.by_columns(
        {
            Column("x", "mm"): numbers((c.x for c in every), decimals=1),
            Column("hand", "MPa"): numbers(c.hand for c in every),
            Column("solid", "MPa"): numbers(c.solid for c in every),
            Column("difference"): numbers((c.difference for c in every), share=True),
        },
        key="comparisons",
        caption=f"Hand calculation and solid model: {kind} stress at sections away from eyes and holes",
        apart=frozenset(i for i, c in enumerate(every) if c in far),
        under=(("link", found.link), ("kind", kind)),
    )
    text = f"The difference is relative to the largest {kind} stress of the link by hand calculation. "
    told_of = agreement(every)
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
        error, solved = max(found.solution.solver_error, LEAST_TOLD), found.solution
        size = f"{found.elements:,} tetrahedra, {found.unknowns:,} unknowns"
        how = f"{size}. Solved by {{solver}} ({{why}}), relative error below {error:.0e}"
        parts.append(say(how, "small", solver=solved.solver, why=solved.solver_reason))
        if len(found.variants) > 1:
            parts.append(_variants(found))
    if found.notes:
        parts.append(Items(tuple(sentence(told(note)) for note in found.notes), "notes"))
    if parts:
        yield Folded("Mesh, variants and notes" if isinstance(found, SolidResult) else "Notes", tuple(parts))


def _variants(found: SolidResult) -> Table:
    every = found.variants
    return Table.by_columns(
        {
            words("variant"): [f"{told(one.title)}{' (value)' if one is found.governing else ''}" for one in every],
            Column("von Mises", "MPa"): numbers(one.von_mises for one in every),
            Column("principal", "MPa"): numbers(one.principal for one in every),
            Column("displacement", "mm"): numbers((one.displacement for one in every), 3),
        },
        caption="Variants in the band",
    )


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
    bands, beam = "von_mises_max principal_max safety_factor displacement_max", None
    if not result.beam.without:
        beam = {"equivalent_max": result.beam.worst.equivalent, "x": result.beam.worst_x}
        beam |= entries(result.beam, "safety_factor")
    return entries(result, f"fidelity {bands} location notes") | {
        "decided_by": result.decided_by or None,
        "why": data(result.why) or None,
        "layers": layer_record(result.layers),
        "beam": beam,
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
    return sentence("; ".join(found) or "No load acts on any checked link")


def _names(links: Iterable[LinkResult]) -> list[str]:
    return list(dict.fromkeys(link.link for link in links))
