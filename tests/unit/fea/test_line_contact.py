"""Contact of a pin with the flank of its slot: Hertz's pressure, the stress below it, and the check of a case."""

import math
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from connection_case import QUICK_RETURN, checked
from edited_cases import edited
from slotted_lever import slotted_lever
from told import result_record

from alula.fea.asked.asked import asked
from alula.fea.check.run import check_case
from alula.fea.common.sought import LEFT
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.judging.line_contact import contact_of, line_load
from alula.fea.modes.line_contact import LineContact, hertz_pressure, most_equivalent, stress_below
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import LineContactCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.check.pins import pins_left_out
from alula.reports.sentences import told

HERTZ = {"type": "line-contact", "minimum": 2.0}


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_the_field_below_the_line_is_the_sum_of_line_loads(friction):
    """Flamant's field of normal and tangential line loads, integrated over the ellipse of pressure."""
    angle = (np.arange(4000) + 0.5) * math.pi / 4000
    source, weight = np.cos(angle), np.sin(angle) ** 2 * math.pi / 4000
    for x, z in ((0.0, 0.7), (0.5, 0.25), (-0.9, 0.3), (1.3, 0.6)):
        beside = x - source
        radial = -2.0 / math.pi * (z + friction * beside) / (beside**2 + z**2) ** 2 * weight
        along, below, shear = (np.sum(radial * part) for part in (beside**2, z**2, beside * z))
        found = stress_below(np.array(x), np.array(z), friction)
        assert found == pytest.approx((along, below, shear), abs=1e-6)


def test_hertz_pressure_closes_the_gap_between_cylinder_and_flat():
    """Along the line both surfaces bend as the circle asks: u' of the pressure, by its integral, is x/R."""
    pin, flank, load, radius = (206e3, 0.29), (70e3, 0.33), 80.0, 2.0
    most = hertz_pressure(load, radius, pin, flank)
    half = 2.0 * load / (math.pi * most)
    soft = sum((1.0 - ratio**2) / young for young, ratio in (pin, flank))
    angle = (np.arange(2000) + 0.5) * math.pi / 2000
    source, weight = half * np.cos(angle), half * np.sin(angle) * math.pi / 2000
    place = half * math.cos(100 * math.pi / 2000)  # midway between two sources, where the principal value is the sum
    slope = 2.0 * soft / math.pi * np.sum(most * np.sin(angle) / (place - source) * weight)
    assert slope == pytest.approx(place / radius, rel=1e-3)


def test_yield_begins_at_the_known_pressures():
    """1.79 times yield by von Mises at a ratio of 0.3, 0.70 half widths deep; 1.67 by Tresca, 0.78 deep."""
    z = np.linspace(0.0, 1.5, 3001) + 1e-9
    along, below, _ = stress_below(np.zeros_like(z), z, 0.0)
    shear = np.abs(along - below) / 2.0
    assert (shear.max(), z[shear.argmax()]) == pytest.approx((0.300, 0.786), abs=1e-3)
    assert 0.5 / shear.max() == pytest.approx(1.67, abs=0.01)
    assert 1.0 / most_equivalent(0.3) == pytest.approx(1.79, abs=0.005)
    rubbing = [most_equivalent(0.3, friction) for friction in (0.0, 0.1, 0.3, 0.6)]
    assert rubbing == sorted(rubbing)
    fine = np.meshgrid(np.linspace(-1.5, 1.5, 1501), np.linspace(0.0, 1.0, 501) + 1e-9)
    for friction in (0.0, 0.25, 0.5):
        along, below, shear = stress_below(*fine, friction)
        out = 0.3 * (along + below)
        square = ((along - below) ** 2 + (below - out) ** 2 + (out - along) ** 2) / 2.0 + 3.0 * shear**2
        assert most_equivalent(0.3, friction) == pytest.approx(math.sqrt(square.max()), rel=1e-3)


def lever(**check):
    """A slotted lever of PVC on a pin of steel at 31 mm, loaded with 40 N at 80 mm."""
    case = slotted_lever(force=-40.0)
    return case.model_copy(
        update={"large_displacement": "off", "checks": {"slot": LineContactCheck.model_validate(HERTZ | check)}}
    )


def pressed(case, load=40.0 * 80.0 / 31.0 / 5.0, *, stiff=1.0):
    card, pin = case.material_of("lever"), case.pin_material("P")
    return hertz_pressure(
        load, 2.0, (pin.youngs_modulus, pin.poissons_ratio), (stiff * card.youngs_modulus, card.poissons_ratio)
    )


def test_a_slotted_lever_by_hand():
    case = lever()
    result, [outcome] = checked(case, "tip", Quantity.LINE_CONTACT)
    card, contact = case.material_of("lever"), result.found_of(LineContact)[0].numbers
    assert contact.pressure == pytest.approx(pressed(case))
    assert contact.half_width == pytest.approx(2.0 * contact.line_load / (math.pi * contact.pressure))
    assert contact.line_load == pytest.approx(40.0 * 80.0 / 31.0 / 5.0)
    factor = card.allowable / (most_equivalent(card.poissons_ratio) * pressed(case))
    assert outcome.value.value == pytest.approx(factor)
    assert str(outcome.subject) == "pin P"
    assert "flank" in told(outcome.reason)
    assert contact.factors["pin"].low > contact.factors["flank"].low
    _, [own] = checked(lever(pressure="90 MPa"), "tip", Quantity.LINE_CONTACT)
    assert own.value.value == pytest.approx(90.0 / pressed(case))


def test_a_load_that_stays_presses_first_before_links_creep():
    case = lever()
    [one] = asked(case, LineContactCheck)
    name = case.part_of("lever").material
    creeps = {name: case.all_materials[name].model_copy(update={"sustained_modulus": 1e3, "sustained_stress": 9.0})}
    lasting = case.conditions.model_copy(update={"duration": 3.6e6})
    lasting = case.model_copy(update={"conditions": lasting, "materials": {**case.materials, **creeps}})
    assert lasting.material_of("lever").youngs_modulus < 0.8 * case.material_of("lever").youngs_modulus
    short, long = (contact_of(of, "tip", one, [np.array([0.0, 50, 0, 0, 0, 0])]).factors for of in (case, lasting))
    assert short == long


def test_the_band_holds_loads_friction_moduli_and_strength():
    case = lever()
    loads = {"tip": case.load_cases["tip"].model_copy(update={"scatter": (0.8, 1.25)})}
    joints = case.joints | {"P": case.joints["P"].model_copy(update={"friction": 0.3, "friction_range": (0.2, 0.5)})}
    name = case.part_of("lever").material
    card = case.all_materials[name]
    young, strength = card.youngs_modulus, card.allowable
    ranges = {"youngs_modulus_range": (0.9 * young, 1.2 * young), "strength_range": (0.7 * strength, 1.1 * strength)}
    cards = {**case.materials, name: card.model_copy(update=ranges)}
    wide = case.model_copy(update={"load_cases": loads, "joints": joints, "materials": cards})
    [one] = asked(wide, LineContactCheck)
    band = contact_of(wide, "tip", one, [np.array([0.0, 50.0, 0.0, 0.0, 0.0, 0.0])]).factors["flank"]
    kinds = {SourceKind.LOAD, SourceKind.FRICTION, SourceKind.MODULUS, SourceKind.STRENGTH}
    assert kinds == {source.kind for source in band.sources}
    ends = [
        share * strength / (most_equivalent(card.poissons_ratio, friction) * pressed(case, 10.0 * load, stiff=stiff))
        for load, stiff, friction, share in ((1.0, 1.0, 0.3, 1.0), (1.25, 1.2, 0.5, 0.7), (0.8, 0.9, 0.2, 1.1))
    ]
    assert (band.value, band.low, band.high) == pytest.approx(ends)


def test_a_couple_presses_one_end_of_the_line_more():
    case = lever()
    wrench = np.array([0.0, 100.0, 0.0, 40.0, 0.0, 0.0])
    assert line_load(case, "P", wrench) == pytest.approx(100.0 / 5.0 + 6.0 * 40.0 / 5.0**2)
    [one] = asked(case, LineContactCheck)
    wrenches = [np.array([0.0, force, 0.0, 0.0, 0.0, 0.0]) for force in (100.0, 150.0, 120.0)]
    for order in (1, -1):
        found = contact_of(case, "tip", one, [wrenches[0], *wrenches[1:][::order]])
        flank = found.factors["flank"]
        assert flank.low == pytest.approx(flank.value / math.sqrt(1.5 + LEFT * 0.5))  # and what a search may leave
        assert flank.high == pytest.approx(flank.value / math.sqrt(1.0 - LEFT * 0.5))
        assert SourceKind.COUPLES in {source.kind for source in flank.sources}


def test_over_a_motion_the_pose_counts_that_presses_most():
    """The force on the pin is the moment of the load about O over the pin's distance from O; it is largest near it."""
    case = validate(tomllib.loads(QUICK_RETURN))
    moved, card = solve_case_motion(case), case.material_of("lever")
    turn = moved.motion.angles + math.pi / 6.0 - moved.motion.angles[0]
    pin = 30.0 * np.exp(1j * turn) + 60j
    forces = 80.0 * 150.0 * pin.imag / np.abs(pin) / np.abs(pin)
    for evaluated in (np.ones(9, dtype=bool), np.abs(forces) < 0.95 * np.abs(forces).max()):
        strong, weak = envelope_outcomes(moved, {}, evaluated)
        most = np.abs(forces)[evaluated].max() / 4.0
        steel = case.pin_material("B")
        pressure = hertz_pressure(
            most, 2.5, (steel.youngs_modulus, steel.poissons_ratio), (card.youngs_modulus, card.poissons_ratio)
        )
        assert strong.value.value == pytest.approx(240.0 / (most_equivalent(card.poissons_ratio) * pressure))
        assert weak.value.value == pytest.approx(2.0 * strong.value.value)
        assert (strong.verdict is Verdict.PASS) is (strong.value.low >= 2.0 and bool(evaluated.all()))


def test_other_joints_are_refused():
    with pytest.raises(CaseError, match=re.escape("checks.slots.joints: 'O' is no pin in the slot of a link with a")):
        edited("ornithopter", ['checks={slots={type="line-contact", minimum=1.0, joints=["O"]}}'])
    with pytest.raises(CaseError, match=re.escape("checks.slots: no pin slides in the slot of a link with a part")):
        edited("four-bar", ['checks={slots={type="line-contact", minimum=1.0}}'])


def test_a_brittle_flank_needs_the_pressure_that_it_bears():
    with pytest.raises(CaseError, match=re.escape("checks.slots.pressure: it is missing, but 'resin-405nm'")):
        edited("ornithopter", ['checks={slots={type="line-contact", minimum=1.0}}'])


def test_page_and_file_have_the_contact_and_leave_out_what_is_judged():
    result = check_case(lever(), fidelity="beam")
    [one] = result_record(result)["load_cases"]["tip"]["contacts"]
    assert (one["joint"], [against["what"] for against in one["against"]]) == ("P", ["pin", "flank"])
    assert "Contact in slots" not in dict(pins_left_out(result).not_covered)
    case = edited("ornithopter", ['checks.s={type="line-contact", minimum=1, pressure="60 MPa", joints=["slot-left"]}'])
    left_out = dict(pins_left_out(replace(result, case=case)).not_covered)
    assert left_out["Contact in slots"].startswith("Pins in slots at guide and slot-right touch")
