"""Outcome of the check of a pin in its slot: its contact along a line makes neither pin nor flank yield."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.beam.pin_between import first_moment
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, compliance_scatter, load_scatter, strength_scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import COUPLES, distinct, friction_source
from alula.fea.common.verdict import CheckOutcome
from alula.fea.judging.bearing import pressing
from alula.fea.judging.loading import ByHand, Judged, Loading
from alula.fea.modes.line_contact import LineContact, hertz_pressure, most_equivalent
from alula.fea.outcomes.pins import on_links
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.case.forks import apart, eye_of
from alula.loads.records.check_spec import LineContactCheck

Real = NDArray[np.float64]
WITHOUT = reason("line_contact_along_all_of_it")


def line_load(case: Case, joint: str, wrench: Real) -> Real:
    """Return the force over length with which a pin presses on the flank of its slot, where it presses most.

    Parameters
    ----------
    case : Case
    joint : str
        With a slot in a part.
    wrench : ndarray, shape (..., 6)
        What the first link does to the second, about the point of the second [N, N mm].

    Returns
    -------
    ndarray, shape (...)
        [N/mm]; a couple about the slot's direction is linear along the pin.
    """
    link, rise = case.joints[joint].slotted, case.linkage.rise(joint)
    assert link is not None
    length, force = eye_of(case, joint, link).thickness, pressing(case, link, on_links(case, joint, wrench)[link])
    if apart(case, link) is not None:
        return np.asarray(force / length)  # of the worse plate, whose force has the couple
    couple = first_moment(wrench) + rise * wrench[..., :2]
    return np.asarray(force / length + 6.0 * np.linalg.norm(couple, axis=-1) / length**2)


def contact_of(
    case: Case, load_case: str, one: Asked, wrenches: Sequence[Real], growth: Scatter | None = None
) -> LineContact:
    """Return the contact of a joint's pin in its slot.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of the pin.
    wrenches : sequence of ndarray, shape (6,)
        What the first link does to the second, in all ways in which pins may share couples [N, N mm], first that which
        stands.
    growth : Scatter, optional
        By which that force grows beside scattered loads (``alula.fea.doubts.load_growth``).

    Returns
    -------
    LineContact
    """
    check, name = one.check, one.subject.name
    assert isinstance(check, LineContactCheck)
    record = case.joints[name]
    assert record.slotted is not None
    assert record.pin_diameter is not None
    radius = record.pin_diameter / 2.0
    # A load presses most as it comes, before the flank creeps.
    cards = {"pin": case.pin_material(name), "flank": case.fresh_material(record.slotted)}
    loads = [float(line_load(case, name, wrench)) for wrench in wrenches]
    spread = load_scatter(case, load_case).times(growth or Scatter())
    shared = COUPLES if max(loads) > min(loads) else ()
    least, most = sought(loads)
    ends = loads[0], spread.low * max(least, 0.0), spread.high * most
    moduli = [compliance_scatter(card).inverse for card in cards.values()]

    def pressure(end: int) -> float:
        young = [
            card.youngs_modulus * (1.0, scatter.low, scatter.high)[end]
            for card, scatter in zip(cards.values(), moduli, strict=True)
        ]
        pin, flank = ((e, card.poissons_ratio) for e, card in zip(young, cards.values(), strict=True))
        return hertz_pressure(ends[end], radius, pin, flank)

    value, low, high = map(pressure, range(3))
    sources = distinct(spread.told, shared, *(scatter.told for scatter in moduli))
    pressed = Band(value=value, low=low, high=high, sources=sources, without=WITHOUT)
    if check.pressure is not None:
        factors = {"pressure": pressed.inverse(check.pressure)}
    else:
        factors = {what: _against_yield(case, name, card, pressed) for what, card in cards.items()}
    return LineContact(
        line_load=loads[0],
        pressure=value,
        half_width=2.0 * loads[0] / (math.pi * value) if value > 0.0 else 0.0,
        factors=factors,
    )


def _against_yield(case: Case, joint: str, card: Material, pressed: Band) -> Band:
    """Return yield strength over the largest von Mises stress, with all that friction may be."""
    record = case.joints[joint]
    shares = [most_equivalent(card.poissons_ratio, friction) for friction in (record.friction, *record.friction_ends)]
    rubbing = (friction_source({joint: record.friction_ends}),) if record.friction > 0.0 else ()
    stress = replace(
        pressed,
        value=shares[0] * pressed.value,
        low=min(shares) * pressed.low,
        high=max(shares) * pressed.high,
        sources=distinct(pressed.sources, rubbing),
    )
    return strength_scatter(card).on(stress.inverse(card.allowable))


def judge_contact(here: Loading, one: Asked) -> Judged:
    """Return what a joint's pin and its slot bear.

    Parameters
    ----------
    here : Loading
    one : Asked
        Of the pin.

    Returns
    -------
    Judged
    """
    joint = one.subject.name
    found = contact_of(here.case, here.load_case, one, here.wrenches(joint), here.joint_growth(joint))
    return Judged(outcome=contact_outcome(here.load_case, one, found), numbers=(found,))


def contact_outcome(load_case: str, one: Asked, found: LineContact) -> CheckOutcome:
    """Return the outcome of a contact: that of pin or flank, whichever yields first.

    Parameters
    ----------
    load_case : str
        Its name.
    one : Asked
        Of the pin.
    found : LineContact

    Returns
    -------
    CheckOutcome
    """
    weaker = min(found.factors, key=lambda what: found.factors[what].low)
    outcome = one.outcome(load_case, found.factors[weaker])
    return outcome.because(
        reason("line_contact", what=weaker, pressure=found.pressure, load=found.line_load, why=outcome.reason)
    )


LINE_CONTACT = ByHand(
    judge=judge_contact,
    least=lambda over, one: -line_load(over.case, one.subject.name, over.wrenches(one.subject.name)[0]),
)
