"""Outcome of the check of a printed link's layers, and what they leave open where the part states no direction."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from alula.fea.asked.asked import Asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import layer_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.outcomes.limits import in_weakest_direction, layer_limit, may_lie_in_any_direction
from alula.fea.outcomes.result import LinkResult
from alula.fea.refine.discretisation import Discretisation
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case

CHECK = "layers"
"""Name of the check, beside that of the safety factor."""


def layer_outcomes(case: Case, load_case: str, links: Mapping[str, LinkResult]) -> Iterator[CheckOutcome]:
    """Yield the outcome of the layers of every link whose safety factor or notches are checked, where it is printed.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    links : mapping of str to LinkResult

    Yields
    ------
    CheckOutcome
    """
    for link, result in links.items():
        one = asked_of_layers(case, link)
        if one is None:
            continue
        material, found = case.material_of(link), result.layers
        if found is not None:
            yield layers_judged(case, load_case, one, found.safety_factor, found.peak, found.discretisation)
        elif result.beam.idle:
            yield one.outcome(load_case, Band.exact(np.inf), reason("nothing_acts_on_link"))
        elif material.strength_across_layers is None:
            yield one.outcome(load_case, Band.unknown(), no_strength(material.title))
        else:
            yield _bounded(one.outcome(load_case, _by_hand(material, result)))


def asked_of_layers(case: Case, link: str) -> Asked | None:
    """Return what is asked of a link's layers; None where nothing is.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    Asked or None
    """
    limit = layer_limit(case, link)
    if limit is None:
        return None
    return Asked(name=CHECK, subject=Subject.link(link), quantity=Quantity.LAYERS, limit=limit)


def layers_judged(
    case: Case, load_case: str, one: Asked, value: Band, where: Reason, meshes: Discretisation | None = None
) -> CheckOutcome:
    """Return the outcome of a link's layers whose safety factor was sought.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of the layers.
    value : Band
        Of a pose, or the least of a motion.
    where : Reason
        Where the peak is.
    meshes : Discretisation, optional
        What the meshes of the link leave open, where these were refined for its layers.

    Returns
    -------
    CheckOutcome
    """
    outcome, material = with_meshes(one.outcome(load_case, value), meshes), case.material_of(one.subject.name)
    if value.unknowable:
        return outcome
    outcome = outcome.because(together(outcome.reason, where))
    return without_shear(outcome, material.title) if material.shear_strength_between_layers is None else outcome


def with_meshes(outcome: CheckOutcome, meshes: Discretisation | None) -> CheckOutcome:
    """Return an outcome on a link with what its meshes have to do with it where it is open.

    Parameters
    ----------
    outcome : CheckOutcome
    meshes : Discretisation or None
        None where no meshes gave the number.

    Returns
    -------
    CheckOutcome
    """
    if meshes is not None and outcome.value.unknowable:
        return outcome.because(meshes.reason)
    if meshes is not None and outcome.verdict is Verdict.UNDECIDED and meshes.stopped:
        return outcome.because(reason("open_for_meshes", found=outcome.reason, why=meshes.stopped))
    return outcome


def in_any_direction(case: Case, link: str, factor: Band, principal: Band, von_mises: Band) -> Band:
    """Return a link's safety factor for all directions in which it may have been built.

    The upper end is that along the layers. The lower end is that of the weakest direction, by a bound on what tension
    across layers and shear along them make together.

    Parameters
    ----------
    case : Case
    link : str
    factor : Band
        Along the layers.
    principal, von_mises : Band
        Largest stresses, with all that loads may be [MPa].

    Returns
    -------
    Band
        The same where the part states its direction, or the card knows nothing of layers.
    """
    if not may_lie_in_any_direction(case, link) or math.isnan(factor.low):
        return factor
    material = case.material_of(link)
    least = layer_scatter(material).low * in_weakest_direction(material, principal.high, von_mises.high)
    if principal.unknowable or von_mises.unknowable:
        least = 0.0
    if not least < factor.low or factor.low == math.inf:
        return factor
    width = factor.low / least if least > 0.0 else math.inf
    detail = reason("none_is_stated")
    build = Source(kind=SourceKind.BUILD, detail=detail, width=width, ends=(least / factor.low, 1.0))
    # The strength at the low end is that of the layers, so that of the others makes nothing of it.
    others = (
        replace(one, ends=(1.0, one.ends[1])) if one.kind is SourceKind.STRENGTH else one for one in factor.sources
    )
    return replace(factor, low=least, sources=distinct(tuple(others), (build,)))


def _by_hand(material: Material, result: LinkResult) -> Band:
    """Return the least safety factor that the layers can have by hand: a bound for whatever direction they have."""
    principal, von_mises = result.principal_max, result.von_mises_max
    if result.safety_factor.without or principal.unknowable or math.isinf(von_mises.high):
        return Band.unknown()
    value = in_weakest_direction(material, principal.value, von_mises.value)
    least = layer_scatter(material).low * in_weakest_direction(material, principal.high, von_mises.high)
    return Band(value=value, low=least, high=math.inf, sources=result.safety_factor.sources)


def _bounded(outcome: CheckOutcome) -> CheckOutcome:
    if outcome.verdict is Verdict.PASS:
        return outcome.because(reason("least_of_layers_by_hand", found=outcome.reason))
    return outcome.because(reason("layers_by_hand"))


def unless_built_otherwise(case: Case, link: str, outcome: CheckOutcome) -> CheckOutcome:
    """Return the outcome of a safety factor; one that is open for the direction of building says so.

    Parameters
    ----------
    case : Case
    link : str
    outcome : CheckOutcome

    Returns
    -------
    CheckOutcome
    """
    open_yet = outcome.verdict is Verdict.UNDECIDED
    if not (open_yet and any(source.kind is SourceKind.BUILD for source in outcome.value.sources)):
        return outcome
    material, part = case.material_of(link), case.links[link].part
    if material.shear_strength_between_layers is None:
        why = reason("neither_direction_nor_shear_strength", part=part, material=material.title)
    else:
        why = reason("no_build_direction", part=part)
    return outcome.because(together(outcome.reason, why))


def no_strength(title: str) -> Reason:
    """Return why layers are not judged without their strength, and what to do.

    Parameters
    ----------
    title : str
        Of the material.

    Returns
    -------
    Reason
    """
    return reason("no_strength_across_layers", material=title)


def without_shear(outcome: CheckOutcome, title: str) -> CheckOutcome:
    """Return an outcome by tension across the layers alone, which passes nothing.

    Parameters
    ----------
    outcome : CheckOutcome
    title : str
        Of the material, which states no strength against shear.

    Returns
    -------
    CheckOutcome
    """
    if outcome.verdict is not Verdict.FAIL:
        return outcome.left_open(reason("no_shear_strength_of_layers", material=title, by_tension=outcome.reason))
    return outcome
