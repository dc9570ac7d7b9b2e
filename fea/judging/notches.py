"""Notches of brittle links: judged by critical distance and by volume on the stress of their solids."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from alula.fea.asked.asked import Asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import strength_scatter
from alula.fea.common.source import Source, SourceKind, distinct, pin_sources
from alula.fea.judging.link_result import spread
from alula.fea.judging.loading import Judged, SolvedLinks
from alula.fea.judging.solid_buckling import bending_growth
from alula.fea.links.clamp_edge import CLAMP, edge_stress
from alula.fea.links.link_by_hand import LinkByHand
from alula.fea.modes.notches import NotchFactor
from alula.fea.refine.discretisation import discretisation_source, judged
from alula.fea.refine.link_series import CHORD
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.solid.notch_field import NotchField
from alula.fea.solid.stress import stress_field
from alula.geometry.materials.brittle_notch import NotchStrength, notch_strengths
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW

NOT_SOLVED = reason("notch_needs_solid")
NO_TENSION = reason("nowhere_in_tension")


@dataclass(frozen=True, kw_only=True)
class _Use:
    """Share of its strength that a link uses up under one variant of its loads, with the band of mesh and methods."""

    value: float
    low: float
    high: float
    told: NotchFactor


_Found = tuple[tuple[float, float, float], dict[str, Any]]
"""Share of the strength with its band, and what is told of it."""
_NOTHING: _Found = (0.0, 0.0, 0.0), {}


def judge_notches(here: SolvedLinks, one: Asked) -> Judged:
    """Return how near a link comes to breaking at a notch.

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
    solid = here.decided[link].solid if link in here.decided else None
    names = {found.load for found in solid.solution.cases} if solid else set()
    plates = [*zip((loads.name for loads in here.loads(link)), here.hands(link), strict=True)]
    if solid is None or not all(name in names for name, _ in plates):
        return Judged(outcome=one.outcome(load_case, Band.unknown(NOT_SOLVED), NOT_SOLVED))
    every = [notch_factor(case, one, name, hand, solid) for name, hand in plates]
    lost = next((found for found in every if isinstance(found, Reason)), None)
    if lost is not None:
        return Judged(outcome=one.outcome(load_case, Band.unknown(lost), lost))
    worst = min((found for found in every if isinstance(found, NotchFactor)), key=lambda found: found.factor.low)
    grown = bending_growth(case, load_case, link, here.links[link])
    loads = spread(case, link, load_case, "principal", *here.doubts(link), grown)
    worst = replace(worst, factor=loads.inverse.on(worst.factor))
    outcome = one.outcome(load_case, worst.factor)
    why = reason("notch_judged", found=notch_said(worst), judgement=outcome.reason)
    return Judged(outcome=outcome.because(why), numbers=(worst,))


def notch_factor(case: Case, one: Asked, loads: str, hand: LinkByHand, refined: RefinedSolid) -> NotchFactor | Reason:
    """Return by what the loads of a link, or of one of its plates, may grow until it breaks at a notch.

    Parameters
    ----------
    case : Case
    one : Asked
        Of the link.
    loads : str
        Name of its loads.
    hand : LinkByHand
        Of these loads.
    refined : RefinedSolid
        Its solid.

    Returns
    -------
    NotchFactor or Reason
        With the band of mesh, methods, contact, and stated ranges of the card; or why it is not known.
    """
    material, body = case.material_of(one.subject.name), case.body(one.subject.name)
    assert material.ultimate_strength is not None
    solid = refined.solution
    solved = [number for number, found in enumerate(solid.cases) if found.load == loads]
    for number in solved:
        if not refined.precision[number].known("principal"):
            return judged(refined, number, "principal").reason
    plates = case.links[one.subject.name].count
    uses = {number: _use(refined, number, material, plates) for number in solved}
    own = [number for number in solved if solid.cases[number].transfer in (None, case.torque_transfer)]
    governing = max(own, key=lambda number: uses[number].value)
    value, told = uses[governing].value, uses[governing].told
    high = max(use.high for use in uses.values())
    weakest = strength_scatter(material).low * material.ultimate_strength
    edge = edge_stress(body, hand.check, high * weakest) / weakest
    sources = (
        *((CLAMP,) if edge > high else ()),
        *(pin_sources(driven=solid.cases[governing].transfer is not None) if body.pins else ()),
        discretisation_source(refined.precision[governing].principal, sharp_edges=refined.sharp_edges),
        *((Source(kind=SourceKind.NOTCH_METHOD),) if told.distance is not None else ()),
        *_ranges(material),
    )
    use = Band(value=value, low=min(x.low for x in uses.values()), high=max(high, edge), sources=distinct(sources))
    return replace(told, factor=use.inverse(1.0))


def _ranges(material: Material) -> tuple[Source, ...]:
    own = material.inherent_strength_range, material.critical_distance_range, material.fracture_toughness_range
    if own == (None, None, None):
        return strength_scatter(material).told
    return (*strength_scatter(material).told, Source(kind=SourceKind.STRENGTH, detail=reason("ranges_of_notches")))


def _use(refined: RefinedSolid, number: int, material: Material, plates: int) -> _Use:
    """Return what a link uses up of its strength in one case of its solid, which is that of one of its plates."""
    solid = refined.solution
    variant = solid.cases[number]
    field = NotchField(field=stress_field(solid.space, variant.displacement, E=solid.E, nu=solid.nu))
    peak = int(field.surface.argmax())
    facts: dict[str, Any] = {"location": solid.space.nodes[peak], "surface": float(field.surface[peak])}
    found = []
    for ends, more in (
        _by_distance(field, refined, number, material),
        _by_volume(field, refined, number, material, plates),
    ):
        found.append(ends)
        facts |= more
    contact = 1.0 - CONTACT_SHORTFALL if variant.span == NARROW.span else 1.0
    value, low, high = map(max, zip(*found, strict=True))
    told = NotchFactor(factor=Band.unknown(), **facts)
    return _Use(value=value, low=low, high=high / contact, told=told)


def _by_distance(field: NotchField, refined: RefinedSolid, number: int, material: Material) -> _Found:
    """By both methods of the critical distance, at the ends of what the card states; the value is the point's."""
    strengths = notch_strengths(material)
    if strengths is None:
        return _NOTHING
    level = refined.levels[-1]
    missing = refined.precision[number].principal.factor * level.figures[number].estimate.stress
    worst = {strength: field.worst(strength) for strength in strengths}
    stated = worst[strengths[0]]
    if stated is None:
        return (0.0, 0.0, float(missing.max()) / strengths[1].ultimate), {}

    def ends(strength: NotchStrength) -> Iterator[tuple[float, float]]:
        for place in worst[strength] or ():
            reach = float(missing[place.elements].max()) / strength.ultimate + CHORD * level.chord * place.use
            yield max(place.use - reach, 0.0), place.use + reach

    every = [end for strength in strengths for end in ends(strength)]
    point, line = stated
    facts = {
        "distance": strengths[0].distance,
        "location": field.field.space.nodes[point.node],
        "surface": point.surface,
        "point": point.ahead,
        "line": line.ahead,
        "relieved": point.counts and line.counts,
        "by_point": 1.0 / point.use,
        "by_line": 1.0 / line.use,
    }
    return (point.use, min(low for low, _ in every), max(high for _, high in every)), facts


def _by_volume(field: NotchField, refined: RefinedSolid, number: int, material: Material, plates: int) -> _Found:
    """By the volume under tension, of a pair that of both plates; its mesh may miss what the largest stress misses."""
    modulus, volume, peak = material.weibull_modulus, material.weibull_volume, float(field.surface.max())
    if modulus is None or volume is None or peak <= 0.0:
        return _NOTHING
    loaded = plates * field.effective_volume(modulus)
    use = peak / material.allowable * (loaded / volume) ** (1.0 / modulus)
    reach, scatter = refined.precision[number].principal.index, strength_scatter(material)
    ends = use, use * max(1.0 - reach, 0.0) / scatter.high, use * (1.0 + reach) / scatter.low
    return ends, {"by_volume": 1.0 / use, "effective_volume": loaded}


def notch_said(found: NotchFactor) -> Reason | str:
    """Return how near a link comes to breaking at a notch.

    Parameters
    ----------
    found : NotchFactor

    Returns
    -------
    Reason or str
    """
    said = []
    if found.distance is not None:
        where = {"surface": found.surface, "place": tuple(map(float, found.location)), "distance": found.distance}
        ahead = {"point": found.point, "line": found.line}
        said.append(
            reason("notch_by_distance", **where, **ahead) if found.relieved else reason("notch_unrelieved", **where)
        )
    if found.by_volume is not None:
        said.append(reason("notch_by_volume", volume=found.effective_volume, factor=found.by_volume))
    return together(*said) if said else NO_TENSION
