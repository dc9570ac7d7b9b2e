"""The limits that a case states on its links, for what decides whether hand calculation or a mesh is good enough."""

import math
from collections.abc import Iterator
from dataclasses import replace

from alula.fea.asked.asked import asked, asked_of, asks, cards_of, subjects_of
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import (
    Scatter,
    compliance_scatter,
    fatigue_scatter,
    layer_scatter,
    load_scatter,
    strength_scatter,
)
from alula.fea.common.verdict import Quantity, Sense, Subject
from alula.fea.outcomes.fatigue import borne_repeated
from alula.fea.solid.layers import Layers, in_worst_direction
from alula.geometry.materials.material import Material
from alula.geometry.materials.plausible import is_plastic
from alula.geometry.materials.printable import is_printed, is_solid_stock
from alula.loads.case.case import Case
from alula.loads.records.check_spec import (
    DisplacementCheck,
    FatigueCheck,
    FrequencyCheck,
    NotchCheck,
    PermanentSetCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    SustainedCheck,
)
from alula.loads.text.caveat import Caveat, Heading, Topic

Ends = tuple[float, float]
_ON_LOADS = {kind for one in Quantity if one.origin == "loads" and one.sense is Sense.AT_LEAST for kind in one.checks}
"""Types of the checks whose least factor is one on loads or stress."""


def stress_limits(case: Case, link: str, spread: Scatter | None = None) -> tuple[Ends, ...]:
    """Return the limits [MPa] of all checks on a link's deciding stress, each with both ends of its stated scatter.

    Plastic collapse and permanent set are among them: below such a stress no path has to be followed. Where the layers
    may have any direction, the limit of a safety factor goes down to that of a pull in the weakest one.

    Parameters
    ----------
    case : Case
    link : str
    spread : Scatter, optional
        What multiplies the stress; by default the widest scatter of the load of any load case.

    Returns
    -------
    tuple of (float, float)

    Raises
    ------
    CaseError
        Where a check has no limit.
    """
    material, load, found = case.material_of(link), spread or _widest_load(case), []
    for one in asked(case, SafetyFactorCheck, PlasticCollapseCheck, SustainedCheck, subject=Subject.link(link)):
        if one.quantity is not Quantity.SUSTAINED_STRESS:
            strength = strength_scatter(material)
            if one.quantity is Quantity.SAFETY_FACTOR and may_lie_in_any_direction(case, link):
                pulled = layer_scatter(material).low * in_weakest_direction(material, 1.0, 1.0) / material.allowable
                strength = replace(strength, low=min(strength.low, pulled))
            found.append(_spread(material.allowable / one.limit, strength.times(load.inverse)))
        elif not math.isnan(one.limit):
            found.append(_spread(one.limit, load.inverse))
    if asks(case, PermanentSetCheck):
        found.append(_spread(material.allowable, strength_scatter(material).times(load.inverse)))
    repeated = case.conditions
    for one in asked(case, FatigueCheck, subject=Subject.link(link)):
        assert repeated.cycles is not None
        for shares, blocks in dict.fromkeys(map(case.repeated, case.load_cases)):
            limit = borne_repeated(material, repeated.cycles, one.limit, shares, blocks) if shares else None
            if limit is not None:
                found.append(_spread(limit, fatigue_scatter(material.fatigue).times(load.inverse)))
    return tuple(found)


def displacement_limits(case: Case, link: str, spread: Scatter | None = None) -> tuple[Ends, ...]:
    """Return the limits [mm] on a link's displacement from the line through its pins, as ``stress_limits``.

    Parameters
    ----------
    case : Case
    link : str
    spread : Scatter, optional
        What multiplies the displacement besides 1/E.

    Returns
    -------
    tuple of (float, float)
    """
    scatter = compliance_scatter(case.material_of(link)).times(spread or _widest_load(case))
    every = asked(case, DisplacementCheck, subject=Subject.link(link))
    return tuple(_spread(one.limit, scatter.inverse) for one in every)


def layer_limit(case: Case, link: str) -> float | None:
    """Return the least safety factor that the layers of a printed link must have: the greatest of its checks'.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    float or None
        None where the part states no direction of building, or its material has no layers, or no check asks for the
        link's safety factor or notches.

    Raises
    ------
    CaseError
        Where a check has no limit.
    """
    stated = case.part_of(link).build_direction is not None and not is_solid_stock(case.material_of(link))
    limits = [one.limit for one in asked(case, SafetyFactorCheck, NotchCheck, subject=Subject.link(link))]
    return max(limits) if limits and stated else None


def layers_of(case: Case, link: str) -> Layers | None:
    """Return direction and strengths of the layers of a link, where they are checked and their strength is known.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    Layers or None
    """
    material, normal = case.material_of(link), case.part_of(link).build_direction
    if normal is None or material.strength_across_layers is None or layer_limit(case, link) is None:
        return None
    between = material.shear_strength_between_layers
    return Layers(normal=normal, across=material.strength_across_layers, between=between)


def layer_limits(case: Case, link: str, spread: Scatter | None = None) -> tuple[Ends, ...]:
    """Return the limit [MPa] on the stress on a link's layers, as ``stress_limits``.

    Parameters
    ----------
    case : Case
    link : str
    spread : Scatter, optional
        As of ``stress_limits``.

    Returns
    -------
    tuple of (float, float)
        Empty where no layers are checked.
    """
    layers, least = layers_of(case, link), layer_limit(case, link)
    if layers is None or least is None:
        return ()
    scatter = layer_scatter(case.material_of(link)).times((spread or _widest_load(case)).inverse)
    return (_spread(layers.across / least, scatter),)


def may_lie_in_any_direction(case: Case, link: str) -> bool:
    """Return whether a link's layers are the weaker, as its card tells, and may have any direction.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    bool
    """
    known = case.material_of(link).strength_across_layers is not None
    return known and case.part_of(link).build_direction is None


def in_weakest_direction(material: Material, principal: float, von_mises: float) -> float:
    """Return the safety factor of the layers in the weakest direction or less, 0 where shear has no strength.

    Parameters
    ----------
    material : Material
        Its strengths as stated.
    principal, von_mises : float
        Largest stresses of all places [MPa].

    Returns
    -------
    float
    """
    across, between = material.strength_across_layers, material.shear_strength_between_layers
    if across is None or between is None:
        return 0.0
    worst = in_worst_direction(principal, von_mises, across / between)
    return across / worst if worst > 0.0 else math.inf


def _widest_load(case: Case) -> Scatter:
    """Return the widest scatter of any load case: a link's meshes serve all of them."""
    every = [load_scatter(case, load_case) for load_case in case.load_cases]
    return Scatter(low=min(one.low for one in every), high=max(one.high for one in every))


def _spread(limit: float, scatter: Scatter) -> Ends:
    return limit * scatter.low, limit * scatter.high


def limit_caveats(case: Case) -> Iterator[Caveat]:
    """Yield limits that let pass what fails under its own load, of checks or of the cards that stand for them.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    breaks, rings = reason("lets_pass_what_breaks"), reason("lets_pass_what_rings")
    least: dict[str, tuple[float | None, Reason]] = {}
    for name, check in case.checks.items():
        if isinstance(check, FrequencyCheck):
            least[f"checks.{name}.minimum"] = (check.minimum, rings)
        elif check.type in _ON_LOADS:
            least[f"checks.{name}.minimum"] = (vars(check)["minimum"], breaks)
        if isinstance(check, SafetyFactorCheck | PinCheck) and check.minimum is None:
            for card in (x for one in subjects_of(case, name, check) for x in cards_of(case, check, one)):
                own = case.all_materials[card].minimum_safety_factor
                least[f"materials.{card}.minimum_safety_factor"] = (own, breaks)
    for entry, (minimum, why) in least.items():
        if minimum is not None and minimum < 1.0:
            yield Caveat(
                heading=Heading.UNUSUAL, topic=Topic.LIMIT, what=reason("entry_is", entry=entry, value=minimum), why=why
            )


def layer_caveats(case: Case) -> Iterator[Caveat]:
    """Yield the checked links that are or may be printed, of which nothing is known across the layers.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    asked_for = asked_of(case, SafetyFactorCheck, NotchCheck)
    unknown = [link for link in asked_for if case.material_of(link).strength_across_layers is None]
    bare = [link for link in unknown if case.part_of(link).build_direction is None and _may_be_printed(case, link)]
    if bare:
        all_links = len(bare) == len(case.checked_links)
        what = reason("layers") if all_links else reason("layers_of", links=bare)
        yield Caveat(topic=Topic.LAYERS, what=what, why=reason("strength_between_layers_unknown"))


def _may_be_printed(case: Case, link: str) -> bool:
    material = case.material_of(link)
    return is_printed(material) or (is_plastic(case.part_of(link).material, material) and not is_solid_stock(material))
