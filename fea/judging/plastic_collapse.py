"""Plastic collapse of links: found where a check asks for it, and decided on its band.

Up to its first yield a link is elastic, and has not collapsed. So where its safety factor, with the whole band, is at
or above what is asked for, no path is followed: the factor is at least the low end of that band.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from alula.fea.asked.asked import Asked, asked
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging.judge import of_link
from alula.fea.judging.link_result import spread
from alula.fea.judging.loading import Collapse, Judged, SolvedLinks
from alula.fea.judging.solid_buckling import bending_growth
from alula.fea.outcomes.result import LinkResult
from alula.fea.plastic.link_collapse import LinkCollapse, collapse_of
from alula.fea.plastic.load_path import NoPlasticStateError
from alula.fea.plastic.yield_law import YieldLaw
from alula.fea.refine.link_task import ElasticLink
from alula.fea.superposition.solid_shares import Shares
from alula.geometry.base.errors import CannotRunError
from alula.geometry.keeping.kept import NotKept, kept
from alula.geometry.materials.material import Material
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case import Case
from alula.loads.records.check_spec import PlasticCollapseCheck

NOT_SOLVED = reason("collapse_needs_solid")
NEGLIGIBLE = 0.005
"""Share of a factor below which what the pins' pressure leaves open is not told."""


def yield_law(material: Material) -> YieldLaw:
    """Return the plastic law that a card states.

    Parameters
    ----------
    material : Material
        Ductile.

    Returns
    -------
    YieldLaw
    """
    return YieldLaw(
        E=material.youngs_modulus,
        nu=material.poissons_ratio,
        strength=material.allowable,
        compression=material.compression_ratio or 1.0,
        hardening=material.hardening_factors,
    )


def largest_strain(material: Material) -> float:
    """Return the plastic strain at which a path ends: the last one of the card's curve, infinite without one.

    Parameters
    ----------
    material : Material

    Returns
    -------
    float
    """
    return material.hardening_factors[-1][0] if material.hardening_factors else math.inf


def find_collapses(
    case: Case,
    loaded: Mapping[str, Mapping[str, Sequence[LinkLoads]]],
    start: MeshSettings,
    first: Mapping[str, TaggedMesh],
    factors: Mapping[tuple[str, str], tuple[float, float]],
    *,
    time_limit: float,
    threads: int | None,
    progress: Callable[[str], None],
) -> dict[str, dict[str, Collapse]]:
    """Return at what factor links collapse whose path is wanted.

    Parameters
    ----------
    case : Case
    loaded : mapping of str to mapping of str to sequence of LinkLoads
        Load case -> link -> what acts on it, on both plates where they bear differently; of links whose path is wanted.
    start : MeshSettings
        Of the first mesh of the elastic check.
    first : mapping of str to TaggedMesh
        Such meshes that are there already.
    factors : mapping of tuple of (str, str) to tuple of 2 float
        Load case and link -> as ``collapse_of`` takes them, where what stays after the load is wanted.
    time_limit : float
        For all of them [s].
    threads : int or None
        Upper bound on the threads of the solver.
    progress : callable
        Called with a sentence before each link.

    Returns
    -------
    dict of str to dict of str to (LinkCollapse or Reason or str)
        Load case -> link -> what was found, the worse of two plates with what stays of both; or why it is not known.
    """
    until = time.perf_counter() + time_limit
    found: dict[str, dict[str, Collapse]] = {load_case: {} for load_case in loaded}
    every = list(dict.fromkeys(link for links in loaded.values() for link in links))
    for link in every:
        body, material = case.body(link), case.material_of(link)

        @cache
        def mesh(coarser: float, link: str = link) -> TaggedMesh:
            if coarser == 1.0 and link in first:
                return first[link]
            return mesh_body(case.body(link), start.scaled(coarser))

        for load_case, links in loaded.items():
            each: list[Collapse] = []
            for loads in links.get(link, ()):
                nth = f"{1 + every.index(link)} of {len(every)}"
                progress(f"Loading {link} ({nth}) until it flows as a whole (plastic collapse), under {load_case} ...")
                try:
                    (one,) = _collapse(
                        ElasticLink.of(body, material),
                        yield_law(material),
                        loads,
                        start,
                        largest_strain(material),
                        factors.get((load_case, link)),
                        mesh=mesh,
                        threads=threads,
                        until=until,
                    )
                except CannotRunError as error:
                    one = str(error)
                each.append(one)
            if each:
                found[load_case][link] = _of_plates(each, case.links[link].count)
    return found


@kept(but=("mesh", "threads", "until"))
def _collapse(
    link: ElasticLink,
    law: YieldLaw,
    loads: LinkLoads,
    start: MeshSettings,
    largest: float,
    factors: tuple[float, float] | None,
    *,
    mesh: Callable[[float], TaggedMesh],
    threads: int | None,
    until: float,
) -> tuple[Collapse] | NotKept[tuple[Collapse]]:
    """Return the only one: as ``collapse_of``, with meshes that settings make; a path that has no state is a sentence.

    What time cut short is not kept.
    """
    found: Collapse
    try:
        found = collapse_of(
            link, law, loads, mesh, largest_strain=largest, factors=factors, threads=threads, until=until
        )
    except NoPlasticStateError as error:
        found = str(error)
    return (found,) if time.perf_counter() < until else NotKept((found,))


def as_elastic(one: Asked) -> Asked:
    """Return the safety factor that a check of plastic collapse asks for in effect: of the same link, as large.

    Parameters
    ----------
    one : Asked

    Returns
    -------
    Asked
    """
    return replace(one, quantity=Quantity.SAFETY_FACTOR)


def above_first_yield(case: Case, one: Asked, elastic: CheckOutcome) -> CheckOutcome | None:
    """Return the outcome of a link whose safety factor says that it bears what is asked for.

    With the von Mises stress within the yield strength everywhere under the loads times a factor, nothing has flowed
    along the path, whatever the material does later; for perfect plasticity that stress is a lower bound of what the
    link bears by the static theorem of limit analysis, too.

    Parameters
    ----------
    case : Case
    one : Asked
        Of a check of plastic collapse.
    elastic : CheckOutcome
        Of ``as_elastic``.

    Returns
    -------
    CheckOutcome or None
        None where only a path can tell: the band of the safety factor is not at or above the limit or holds no error
        of its model, or the material yields earlier than by von Mises where it is pulled from all sides.
    """
    law = yield_law(case.material_of(one.subject.name))
    if elastic.verdict is not Verdict.PASS or elastic.value.without or law.compression > 1.0:
        return None
    least = elastic.value.low
    band = Band.at_least(least, elastic.value.sources)
    return one.outcome(elastic.load_case, band, reason("collapse_above_first_yield", factor=least))


def needs_path(case: Case, load_case: str, link: str, result: LinkResult) -> bool:
    """Return whether the safety factor of a link leaves a check of its plastic collapse open.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    result : LinkResult

    Returns
    -------
    bool
    """
    every = asked(case, PlasticCollapseCheck, subject=Subject.link(link))
    return any(above_first_yield(case, one, of_link(case, load_case, as_elastic(one), result)) is None for one in every)


def _of_plates(found: Sequence[Collapse], count: int) -> Collapse:
    """Return a plate that is not known, else the one that collapses first, with what stays of all of a link's plates.

    Of equal plates one was solved.
    """
    known = [one for one in found if isinstance(one, LinkCollapse)]
    if len(known) < len(found):
        return next(one for one in found if not isinstance(one, LinkCollapse))
    stays, alike = [one.stays for one in known if one.stays is not None], count / len(known)
    whole = None
    if stays:
        value, low, high = (alike * sum(works) for works in zip(*stays, strict=True))
        whole = value, low, high
    return replace(min(known, key=lambda one: one.low), stays=whole, regained=max(one.regained for one in known))


def judge_collapse(here: SolvedLinks, one: Asked) -> Judged:
    """Return at what factor on its loads a link collapses.

    Parameters
    ----------
    here : SolvedLinks
    one : Asked
        Of a link.

    Returns
    -------
    Judged
    """
    case, load_case, link = here.case, here.load_case, one.subject.name
    if link not in here.collapses:
        elastic = above_first_yield(case, one, of_link(case, load_case, as_elastic(one), here.links[link]))
        return Judged(outcome=elastic or one.outcome(load_case, Band.unknown(NOT_SOLVED), NOT_SOLVED))
    known = here.collapses[link]
    if not isinstance(known, LinkCollapse):
        return Judged(outcome=one.outcome(load_case, Band.unknown(known), known))
    grown = bending_growth(case, load_case, link, here.links[link])
    outcome = one.outcome(load_case, collapse_band(case, link, load_case, known, *here.doubts(link), grown))
    why = reason("collapse_judged", found=collapse_said(case, link, known), judgement=outcome.reason)
    return Judged(outcome=outcome.because(why), numbers=(known,))


def collapse_band(
    case: Case,
    link: str,
    load_case: str,
    found: LinkCollapse,
    uneven: Growths,
    shares: Shares,
    grown: Scatter | None = None,
) -> Band:
    """Return the plastic-collapse factor of a link, with all that leaves it open.

    For perfect plasticity it goes with the yield stress exactly, and with loads that grow together. What doubts change
    in the pattern of its loads is taken as they change its largest von Mises stress.

    Parameters
    ----------
    case : Case
    link : str
    load_case : str
        Its name.
    found : LinkCollapse
    uneven, shares, grown
        As ``spread`` takes them.

    Returns
    -------
    Band
    """
    sources = [Source(kind=SourceKind.DISCRETISATION, detail=reason("up_to_share_of_factor", share=found.mesh_error))]
    sources.append(Source(kind=SourceKind.PATH))
    if found.pressure > 1.0 + NEGLIGIBLE:
        detail = reason("pins_may_press_better", factor=found.pressure)
        sources.append(Source(kind=SourceKind.PIN_PRESSURE, detail=detail))
    band = Band(value=found.factor, low=found.low, high=found.high, sources=tuple(sources))
    loads = spread(case, link, load_case, "von_mises", uneven, shares, grown)
    return strength_scatter(case.material_of(link)).times(loads.inverse).on(band)


def collapse_said(case: Case, link: str, found: LinkCollapse) -> Reason:
    """Return how a link collapses.

    Parameters
    ----------
    case : Case
    link : str
    found : LinkCollapse

    Returns
    -------
    Reason
    """
    strain = largest_strain(case.material_of(link))
    return reason(
        "collapses_at",
        factor=found.factor,
        strain=strain if found.ended == "strain" else None,
        unloaded=found.unloaded if found.unloaded >= NEGLIGIBLE else None,
    )
