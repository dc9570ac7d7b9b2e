"""A link's result from its solid model: the peaks of every variant, their bands and what these hold."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from alula.fea.asked.asked import asked_of
from alula.fea.beam.theory import BeamCheck
from alula.fea.buckling.solid_holding import solid_holding
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import CONTACT, Source, SourceKind, pin_sources
from alula.fea.links.clamp_edge import CLAMP, EDGE, edge_stress
from alula.fea.outcomes.compare import compare_sections
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.outcomes.limits import displacement_limits, layer_limits, layers_of, stress_limits
from alula.fea.outcomes.result import SolidResult, VariantPeak
from alula.fea.refine.convergence import GridConvergence
from alula.fea.refine.discretisation import Discretisation, discretisation_source, judged
from alula.fea.refine.link_series import STRESS, CasePrecision, Measure, PeakQuantity
from alula.fea.refine.link_task import ElasticLink, LinkTask
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.refine.singular import LOADED
from alula.fea.solid.layers import Layers, best_directions, on_plane
from alula.fea.solid.solution import SolidCase
from alula.fea.solid.stress import stress_field
from alula.geometry.bodies.body import clamped_end
from alula.loads.case.case import Case
from alula.loads.records.check_spec import NotchCheck

NO_NUMBER = reason("no_mesh_tells")


def link_task(case: Case, link: str, loads: Sequence[LinkLoads]) -> LinkTask:
    """Return what is to be solved for a link under all its load cases, and the limits that its numbers must clear.

    Parameters
    ----------
    case : Case
    link : str
    loads : sequence of LinkLoads
        One record per load case.

    Returns
    -------
    LinkTask
    """
    body = case.body(link)
    return LinkTask(
        **vars(ElasticLink.of(body, case.material_of(link), layers_of(case, link))),
        loads=tuple(loads),
        stress_limits=stress_limits(case, link),
        displacement_limits=displacement_limits(case, link),
        layer_limits=layer_limits(case, link),
        beyond_peak=link in asked_of(case, NotchCheck),
        holding=None if body.part.is_beam else solid_holding(case, link),
    )


def solid_result(
    case: Case,
    link: str,
    load_case: str,
    beam: BeamCheck,
    refined: RefinedSolid,
    *,
    why: Reason | str,
    remarks: Sequence[Reason | str],
) -> SolidResult:
    """Return the result of a link under a load case that was solved.

    Parameters
    ----------
    case : Case
    link : str
    load_case : str
        Its name, or that of the loads on one plate of a pair.
    beam : BeamCheck
        The hand calculation.
    refined : RefinedSolid
        The series of meshes, solved under all load cases of the link.
    why : Reason or str
        Why a solid decides the link.
    remarks : sequence of Reason or str
        What the reader must know, besides what model and meshes have to say.

    Returns
    -------
    SolidResult
    """
    material, solid = case.material_of(link), refined.solution
    solved = [number for number, found in enumerate(solid.cases) if found.load == load_case]
    own = [number for number in solved if solid.cases[number].transfer in (None, case.torque_transfer)]

    def decisive(number: int) -> GridConvergence:
        return refined.precision[number].series(STRESS[material.brittle])

    governing = max(own, key=lambda number: decisive(number).value)
    variant = solid.cases[governing]
    stress = stress_field(solid.space, variant.displacement, E=solid.E, nu=solid.nu)
    body = case.body(link)
    sources = pin_sources(driven=variant.transfer is not None) if body.pins else ()

    def precision_of(measure: Measure, largest: int) -> Discretisation:
        # A peak without limit under one variant leaves none for the link.
        found = {number: judged(refined, number, measure) for number in solved}
        return found[max(solved, key=lambda number: (not found[number].known, number == largest))]

    precision = precision_of(STRESS[material.brittle], governing)

    def band(quantity: PeakQuantity) -> Band:
        every = [refined.precision[number] for number in solved]
        if not all(found.known(quantity) for found in every):
            return Band.unknown(NO_NUMBER)
        value = max(refined.precision[number].series(quantity).value for number in own)
        most = max(value, *(found.high(quantity) for found in every))
        edge = 0.0
        if quantity == "layers" and clamped_end(body) is not None:
            edge = EDGE * most  # beam theory does not tell which way the layers lie
        elif quantity != "displacement":
            edge = edge_stress(body, beam, most)
        return Band(
            value=value,
            low=max(min(value, *(found.low(quantity) for found in every)), 0.0),
            high=max(most, edge),
            sources=(
                *((replace(CLAMP, width=edge / most),) if edge > most else ()),
                *(
                    replace(source, width=_width(source, quantity, refined, solved))
                    for source in sources
                    if source != CONTACT or quantity != "displacement"
                ),
                discretisation_source(
                    refined.precision[governing].series(quantity),
                    sharp_edges=0 if quantity == "displacement" else refined.sharp_edges,
                ),
            ),
        )

    deciding = band(STRESS[material.brittle])
    layers = layers_of(case, link)
    return SolidResult(
        link=link,
        von_mises_max=band("von_mises"),
        principal_max=band("principal"),
        safety_factor=deciding.inverse(material.allowable),
        displacement_max=band("displacement"),
        location=solid.space.nodes[int(np.argmax(stress.decisive(brittle=material.brittle)))].copy(),
        beam=beam,
        solution=solid,
        variants=tuple(_peak(solid.cases[number], refined.precision[number]) for number in solved),
        governing=_peak(variant, refined.precision[governing]),
        governing_case=variant,
        stress=stress,
        comparisons=compare_sections(body, beam, stress),
        notes=(*solid.notes, precision.reason, *_edge_notes(refined, solved), *remarks),
        decided_by="solid",
        why=why,
        brittle=material.brittle,
        discretisation=precision,
        buckling=refined.buckling.get(load_case),
        layers=None
        if layers is None
        else _layer_stress(refined, own, layers, band("layers"), lambda number: precision_of("layers", number)),
    )


def _width(source: Source, quantity: PeakQuantity, refined: RefinedSolid, solved: Sequence[int]) -> float:
    """Return by what ratio the variants of one kind differ at most, the others alike; as it is for other kinds."""
    names = {SourceKind.PIN_PRESSURE: "transfer", SourceKind.TORQUE_TRANSFER: "span"}
    if source.kind not in names:
        return source.width
    alike: dict[object, list[float]] = {}
    for number in solved:
        value = refined.precision[number].series(quantity).value
        alike.setdefault(getattr(refined.solution.cases[number], names[source.kind]), []).append(value)
    return max(max(values) / min(values) if min(values) > 0.0 else math.inf for values in alike.values())


def _layer_stress(
    refined: RefinedSolid,
    own: Sequence[int],
    layers: Layers,
    stress: Band,
    precision_of: Callable[[int], Discretisation],
) -> LayerStress:
    """Return what a load case does to layers; ``own`` are the cases that its value comes from."""
    solid = refined.solution
    fields = {n: stress_field(solid.space, solid.cases[n].displacement, E=solid.E, nu=solid.nu).nodal for n in own}
    largest = max(own, key=lambda number: refined.precision[number].series("layers").value)
    node = int(np.argmax(layers.stress(fields[largest])))
    tension, shear = on_plane(fields[largest][node], layers.normal)
    factor = stress.inverse(layers.across)
    known = layers.between is not None and not stress.unknowable
    if layers.between is None and not stress.unknowable:
        factor = replace(factor, low=0.0)  # shear may take all of it
    return LayerStress(
        layers=layers,
        safety_factor=factor,
        location=solid.space.nodes[node].copy(),
        tension=float(tension),
        shear=float(shear),
        discretisation=precision_of(largest),
        scan=best_directions(fields.values(), layers) if known else None,
    )


def _edge_notes(refined: RefinedSolid, solved: Sequence[int]) -> tuple[Reason, ...]:
    if refined.sharp_edges == 0 or any(refined.precision[number].sharp for number in solved):
        return ()
    return (reason("sharp_edges_left", edges=refined.sharp_edges, share=LOADED),)


def _peak(variant: SolidCase, precision: CasePrecision) -> VariantPeak:
    """Peaks of one variant; NaN for one without limit, which no number stands for."""

    def known(quantity: PeakQuantity) -> float:
        return precision.series(quantity).value if precision.known(quantity) else math.nan

    return VariantPeak(
        span=variant.span,
        transfer=variant.transfer,
        von_mises=known("von_mises"),
        principal=known("principal"),
        displacement=known("displacement"),
    )
