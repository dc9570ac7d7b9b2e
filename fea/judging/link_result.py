"""The result of a link under one load case, from the model that decided it, with all stated scatter in its bands."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, compliance_scatter, layer_scatter, load_scatter, strength_scatter
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging.layers import in_any_direction
from alula.fea.judging.solid_buckling import bending_growth
from alula.fea.links.fidelity import DecidedLink, Decision, HandBands
from alula.fea.links.link_by_hand import LinkByHand
from alula.fea.links.solid_result import solid_result
from alula.fea.outcomes.limits import displacement_limits, layer_limits, stress_limits
from alula.fea.outcomes.result import HandResult, LinkResult, SolidResult
from alula.fea.refine.beyond_meshes import Ends, OpenRanges
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.superposition.solid_shares import Shares
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.case.forks import of_pair

BEAM_ALONE = reason("beam_without_concentration")
NO_BEAM = reason("no_beam")
IDLE = DecidedLink(decision=Decision(model="beam", why=reason("idle_link"), next_cost=None))


def link_result(
    case: Case,
    link: str,
    load_case: str,
    hand: LinkByHand,
    decided: DecidedLink | None,
    uneven: Growths,
    shares: Shares,
    *,
    name: str,
) -> LinkResult:
    """Return what a load case does to a link, or to one plate of it.

    Parameters
    ----------
    case : Case
    link : str
    load_case : str
        Its name.
    hand : LinkByHand
    decided : DecidedLink or None
        None where nothing acts on the link under any load case.
    uneven : Growths
        What grows out of proportion to the scattered load, and what causes make by hand that ``shares`` leave out.
    shares : mapping of PeakQuantity to Scatter
        What causes make of every number; of what is left out nothing.
    name : str
        Of the loads on that plate; that of the load case, or one of their own.

    Returns
    -------
    HandResult or SolidResult
    """
    decided, material = decided or IDLE, case.material_of(link)
    result: LinkResult
    if decided.solid is not None and any(one.load == name for one in decided.solid.solution.cases):
        why, solid = decided.decision.why, decided.solid
        result = solid_result(case, link, name, hand.check, solid, why=why, remarks=hand.remarks)
    else:
        bands = decided.hands.get(name) if name in decided.left or decided.solid is None else None
        decision = decided.left.get(name, decided.decision)
        result = _hand_result(link, material, hand, bands, decision)
    grown = bending_growth(case, load_case, link, result)

    def widened(quantity: PeakQuantity) -> Scatter:
        return spread(case, link, load_case, quantity, uneven, shares, grown)

    layers = result.layers
    if layers is not None:
        factor = layer_scatter(material).times(widened("layers").inverse).on(layers.safety_factor)
        layers = replace(layers, safety_factor=factor)
    von_mises, principal = widened("von_mises").on(result.von_mises_max), widened("principal").on(result.principal_max)
    factor = strength_scatter(material).times(widened(STRESS[material.brittle]).inverse).on(result.safety_factor)
    return replace(
        result,
        layers=layers,
        notes=(*of_pair(case, link), *result.notes),
        von_mises_max=von_mises,
        principal_max=principal,
        safety_factor=in_any_direction(case, link, factor, principal, von_mises),
        displacement_max=compliance_scatter(material).times(widened("displacement")).on(result.displacement_max),
    )


def spread(
    case: Case,
    link: str,
    load_case: str,
    quantity: PeakQuantity,
    uneven: Growths,
    shares: Shares,
    grown: Scatter | None = None,
) -> Scatter:
    """Return what multiplies a number of a link besides its model and its material: scatter of the load, and doubts.

    Parameters
    ----------
    case, link, load_case, uneven, shares
        As of ``link_result``.
    quantity : PeakQuantity
        Which number.
    grown : Scatter, optional
        What bending that goes with the load may exceed that of the solid.

    Returns
    -------
    Scatter
    """
    growth = uneven.displacement if quantity == "displacement" else uneven.stress
    stated = load_scatter(case, load_case).times(grown or Scatter())
    return stated.times(growth.get(link, Scatter())).times(shares.get(quantity, Scatter()))


def open_ranges(case: Case, link: str, load_case: str, uneven: Growths, shares: Shares) -> OpenRanges:
    """Return within what numbers the checks of a link are open whatever its meshes tell.

    Parameters
    ----------
    case, link, load_case, uneven, shares
        As of ``link_result``.

    Returns
    -------
    OpenRanges
    """

    def widened(quantity: PeakQuantity) -> Scatter:
        return spread(case, link, load_case, quantity, uneven, shares)

    deciding = STRESS[case.material_of(link).brittle]
    limits: dict[PeakQuantity, tuple[Ends, ...]] = {
        deciding: stress_limits(case, link, widened(deciding)),
        "layers": layer_limits(case, link, widened("layers")),
        "displacement": displacement_limits(case, link, widened("displacement")),
    }
    return OpenRanges(limits=limits)


def by_hand_shares(shared: Growths, link: str) -> Shares:
    """Return what the ways of sharing couples make of a link by hand: of all its stresses the same.

    Parameters
    ----------
    shared : Growths
        Of all links.
    link : str

    Returns
    -------
    mapping of PeakQuantity to Scatter
    """
    stress = shared.stress.get(link, Scatter())
    bent = shared.displacement.get(link, Scatter())
    return {"von_mises": stress, "principal": stress, "layers": stress, "displacement": bent}


def together_shares(causes: Mapping[str, Shares]) -> Shares:
    """Return what several causes make of a link together: each alone, times one another.

    Parameters
    ----------
    causes : mapping of str to Shares
        At least one, with the same numbers.

    Returns
    -------
    mapping of PeakQuantity to Scatter
    """
    first, *others = causes.values()
    found = dict(first)
    for other in others:
        found = {quantity: one.times(other[quantity]) for quantity, one in found.items()}
    return found


def worse_plate(plates: Sequence[LinkResult]) -> LinkResult:
    """Return the result of a link from those of its plates: the worse one's, with the worst of all in its place.

    Parameters
    ----------
    plates : sequence of LinkResult
        One, or two of a pair whose plates bear differently.

    Returns
    -------
    LinkResult
    """
    worse, *others = sorted(plates, key=lambda result: result.severity)
    for other in others:
        if other.displacement_max.unknowable or other.displacement_max.high > worse.displacement_max.high:
            worse = replace(worse, displacement_max=other.displacement_max)
        if worse.layers is not None and other.layers is not None:
            both = worse.layers, other.layers
            layers = min(both, key=lambda one: -math.inf if one.safety_factor.unknowable else one.safety_factor.low)
            worse = replace(worse, layers=layers)
        if isinstance(worse, SolidResult) and isinstance(other, SolidResult) and other.buckling is not None:
            known = worse.buckling
            if known is None or other.buckling.without or other.buckling.least < known.least:
                worse = replace(worse, buckling=other.buckling)
    return worse


def _hand_result(
    link: str, material: Material, hand: LinkByHand, bands: HandBands | None, decision: Decision
) -> HandResult:
    """Return the hand calculation in its calibrated bands, or beam theory alone where there are none."""
    x, worst = hand.worst
    if bands is not None and not bands.outside:
        von_mises, principal, moved = bands.von_mises, bands.principal, bands.displacement
        rows = sorted(bands.locations, key=lambda row: row.location.x)
        x = rows[first_largest([(r.principal if material.brittle else r.von_mises).high for r in rows])].location.x
        notes: tuple[Reason | str, ...] = ()
    elif hand.check.without:
        von_mises = principal = moved = Band.unknown(NO_BEAM)
        notes = hand.remarks
    else:
        tension = max(worst.axial + worst.bending, worst.bending - worst.axial, 0.0)
        von_mises, principal, moved = (
            Band.exact(value, BEAM_ALONE) for value in (worst.equivalent, tension, hand.displacement)
        )
        alone = reason("idle_in_load_case" if worst.equivalent == 0.0 else "beam_alone")
        notes = (alone, *hand.remarks)
    return HandResult(
        link=link,
        von_mises_max=von_mises,
        principal_max=principal,
        safety_factor=(principal if material.brittle else von_mises).inverse(material.allowable),
        displacement_max=moved,
        location=np.array([x, 0.0, 0.0]),
        beam=hand.check,
        brittle=material.brittle,
        notes=notes,
        decided_by=decision.model,
        why=decision.why,
        next_cost=decision.next_cost,
    )
