"""Outcome of the check of a connection: each mode of what fixes a link, under what goes through the joint."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.beam.pin_between import first_moment
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, load_scatter, strength_scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import COUPLES, Source, SourceKind, distinct
from alula.fea.common.verdict import CheckOutcome
from alula.fea.judging.bearing import pressing
from alula.fea.judging.loading import ByHand, Judged, Loading, OverMotion
from alula.fea.modes.connection_modes import (
    ConnectionFactors,
    ConnectionMode,
    Strength,
    Transmitted,
    bond,
    cross_pin,
    flat,
    press,
    screws,
    shaft_torsion,
)
from alula.fea.outcomes.pins import on_links
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import connected_link
from alula.loads.case.forks import apart
from alula.loads.records.check_spec import ConnectionCheck
from alula.loads.records.conditions import at_temperature
from alula.loads.records.connection import Bond, CrossPin, Ends, Flat, Press, Screws

Real = NDArray[np.float64]
VALUE, LOW, HIGH = range(3)
WITHOUT = reason("nominal_stresses_of_connection")


def transmitted(case: Case, check: ConnectionCheck, wrench: Real, drive_torque: Any) -> Transmitted:
    """Return what goes through a connection; of a pair of plates, through the worse one.

    Parameters
    ----------
    case : Case
    check : ConnectionCheck
    wrench : ndarray, shape (..., 6)
        What the joint's first link does to its second, about the point of the second [N, N mm].
    drive_torque : float or ndarray, shape (...)
        Of the drive, unless a stop stands in its place [N mm].

    Returns
    -------
    Transmitted
    """
    joint, link, rise = case.linkage.joints[check.joint], connected_link(case, check), case.linkage.rise(check.joint)
    plates = _plates(case, check)
    torque = wrench[..., 5] if joint.fixed else np.broadcast_to(drive_torque, wrench.shape[:-1])
    levels = (rise, 0.0) if not check.on_shaft else (rise,) if link == joint.links[0] else (0.0,)
    across = first_moment(wrench)
    couples = [np.linalg.norm(across + level * wrench[..., :2], axis=-1) for level in levels]
    return Transmitted(
        torque=np.abs(torque) / plates,
        force=pressing(case, link, on_links(case, check.joint, wrench)[link]) / plates,
        thrust=np.abs(wrench[..., 2]) / plates,
        couple=np.max(couples, axis=0) * (plates == 1),  # forces on the plates of a pair have it
    )


def _plates(case: Case, check: ConnectionCheck) -> int:
    return 1 if apart(case, connected_link(case, check)) is None else 2


def _factors(case: Case, check: ConnectionCheck, load: Transmitted, end: int) -> dict[ConnectionMode, Any]:
    """Return the factors of all modes: as stated, or at the low or the high end of what may be."""
    way, shaft = check.way, case.joints[check.joint].pin_diameter or math.nan
    cards = {role: _at(card, end) for role, card in _cards(case, check).items()}
    soft = {role: min(one.stress, cards.get("pin", one).stress) for role, one in cards.items()}
    match way:
        case Bond():
            low, high = way.shear_strength_range or (way.shear_strength, way.shear_strength)
            found = bond(way, shaft, (way.shear_strength, low, high)[end], load)
        case Press():
            pressure, friction = _ends(_pressures(case, check, way))[end], _ends(way.friction)[end]
            found = press(way, shaft, pressure, friction, load)
        case Flat():
            found = flat(way, shaft, min(cards["link"].stress, cards["shaft"].stress), load)
        case CrossPin():
            found = cross_pin(way, shaft, cards["pin"], soft["link"], soft["shaft"], load)
        case Screws():
            return screws(way, cards["pin"], soft["link"], load)
    if not check.on_shaft:
        return found
    whole = replace(load, torque=_plates(case, check) * load.torque)  # both plates of a pair are on one shaft
    return found | shaft_torsion(way, shaft, cards["shaft"], whole)


def _ends(stated: Ends) -> tuple[float, float, float]:
    low, high = stated
    return (low + high) / 2.0, low, high


def _pressures(case: Case, check: ConnectionCheck, way: Press) -> Ends:
    diameter, hub = case.joints[check.joint].pin_diameter, None
    assert diameter is not None
    if way.interference is not None:
        hub = case.material_of(connected_link(case, check))
    return way.pressures(diameter, hub, case.pin_material(check.joint))


def _cards(case: Case, check: ConnectionCheck) -> dict[str, Material]:
    """Return the materials on whose strength a connection stands, by what is of them."""
    way, found = check.way, dict[str, Material]()
    if isinstance(way, Flat | CrossPin | Screws):
        found["link"] = case.material_of(connected_link(case, check))
    if isinstance(way, CrossPin | Screws):
        card = case.all_materials[way.material].drawn(f"{way.material} of {check.joint}", way.diameter)
        found["pin"] = at_temperature(card, case.conditions)
    if check.on_shaft:
        found["shaft"] = case.pin_material(check.joint)
    return found


def _at(card: Material, end: int) -> Strength:
    scatter = strength_scatter(card)
    return Strength.of(card, (1.0, scatter.low, scatter.high)[end])


def _sources(case: Case, check: ConnectionCheck) -> tuple[Source, ...]:
    found = distinct(*(strength_scatter(card).told for card in _cards(case, check).values()))
    way = check.way
    if isinstance(way, Bond) and way.shear_strength_range is not None:
        low, high = way.shear_strength_range
        found += (Source(kind=SourceKind.STRENGTH, detail=reason("range_of_stress", low=low, high=high)),)
    if isinstance(way, Press):
        detail = reason("ranges_of_grip", pressure=_pressures(case, check, way), friction=way.friction)
        found += (Source(kind=SourceKind.GRIP, detail=detail),)
    return found


def least_factor(case: Case, check: ConnectionCheck, load: Transmitted) -> Real:
    """Return by what a connection bears more at each pose, at the least; minus infinity where it is not made for it.

    Parameters
    ----------
    case : Case
    check : ConnectionCheck
    load : Transmitted
        At n poses.

    Returns
    -------
    ndarray, shape (n,)
    """
    found = np.min([np.broadcast_to(x, load.torque.shape) for x in _factors(case, check, load, LOW).values()], axis=0)
    return np.where(np.isnan(found), -np.inf, found)


def connection_factors(
    case: Case, load_case: str, one: Asked, ways: Sequence[Transmitted], growth: Scatter | None = None
) -> ConnectionFactors:
    """Return by what a connection bears more than what goes through it in a pose.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of a joint.
    ways : sequence of Transmitted
        In all ways in which pins may share couples, first that which stands.
    growth : Scatter, optional
        Of the joint's force, beside scattered loads (``alula.fea.doubts.load_growth``).

    Returns
    -------
    ConnectionFactors
    """
    check = one.check
    assert isinstance(check, ConnectionCheck)
    spread = load_scatter(case, load_case).times(growth or Scatter()).inverse
    every = [[_factors(case, check, load, end) for end in (VALUE, LOW, HIGH)] for load in ways]
    sources, bands = _sources(case, check), {}
    for mode in every[0][VALUE]:
        values = [[float(end[mode]) for end in way] for way in every]
        shared = any(of != values[0] for of in values)
        value, (low, high) = values[0][VALUE], _sought(values) if shared else values[0][LOW:]
        if any(math.isnan(end) for of in values for end in of):
            bands[mode] = Band.unknown(_not_held(one.name, check))
        elif low < math.inf:
            told = distinct(sources, COUPLES if shared else ())
            # Of ways alike but for rounding the ends, inverted twice, may miss the value by as much.
            band = Band(value=value, low=min(low, value), high=max(high, value), sources=told, without=WITHOUT)
            bands[mode] = spread.on(band)
    return ConnectionFactors(link=connected_link(case, check), load=ways[0], factors=bands)


def _sought(values: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Return the ends of a factor in all ways; loads are in proportion to its inverse, of which ends were sought."""
    most, least = sought([1.0 / of[LOW] for of in values])[1], sought([1.0 / of[HIGH] for of in values])[0]
    return (1.0 / most if most > 0.0 else math.inf), (1.0 / least if least > 0.0 else math.inf)


def _not_held(name: str, check: ConnectionCheck) -> Any:
    kinds = {Bond: "bond_is_pulled_open", Flat: "flat_is_pushed_along", Screws: "two_screws_tilt"}
    return reason(kinds[type(check.way)], check=name)


def judge_connection(here: Loading, one: Asked) -> Judged:
    """Return what a connection bears.

    Parameters
    ----------
    here : Loading
    one : Asked
        Of a joint.

    Returns
    -------
    Judged
    """
    case, check = here.case, one.check
    assert isinstance(check, ConnectionCheck)

    def demand(other: Case, wrench: Real, torque: Any) -> Real:
        return 1.0 / least_factor(other, check, transmitted(other, check, wrench, torque))

    ways = [transmitted(case, check, way.joints[check.joint].wrench, way.driving[0]) for way in here.ways()]
    growth = here.growth_through(check.joint, demand)
    found = connection_factors(case, here.load_case, one, ways, growth)
    return Judged(outcome=connection_outcome(here.load_case, one, found), numbers=(found,))


def least_of_connection(over: OverMotion, one: Asked) -> Real:
    """Return by what a connection bears more than what goes through it at each pose.

    Parameters
    ----------
    over : OverMotion
    one : Asked
        Of a joint.

    Returns
    -------
    ndarray, shape (n,)
    """
    check = one.check
    assert isinstance(check, ConnectionCheck)
    [way] = over.ways()
    return least_factor(over.case, check, transmitted(over.case, check, way.joints[check.joint].wrench, way.driving[0]))


def connection_outcome(load_case: str, one: Asked, found: ConnectionFactors) -> CheckOutcome:
    """Return the outcome of a connection: the least factor of all of its modes.

    Parameters
    ----------
    load_case : str
        Its name.
    one : Asked
        Of a joint.
    found : ConnectionFactors

    Returns
    -------
    CheckOutcome
        The reason names the mode whose least factor is the least.
    """
    if not found.factors:
        return one.outcome(load_case, Band.exact(math.inf, WITHOUT), reason("nothing_through_connection"))
    worst = Band.least(list(found.factors.values()))
    if worst.unknowable:
        return one.outcome(load_case, worst)
    mode = min(found.factors, key=lambda mode: found.factors[mode].low)
    outcome = one.outcome(load_case, replace(worst, without=WITHOUT))
    torque, force = float(found.load.torque), float(found.load.force)
    return outcome.because(reason("mode_of_connection", mode=str(mode), torque=torque, force=force, why=outcome.reason))


CONNECTION = ByHand(judge=judge_connection, least=least_of_connection)
