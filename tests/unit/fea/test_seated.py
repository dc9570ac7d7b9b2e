"""Pins of known clearance press by contact, all others as before."""

import math
from dataclasses import replace

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.seated import NARROWER, NARROWEST, WIDER, contact_coefficients, half_angles
from alula.fea.tractions.traction import pin_traction
from alula.geometry.bodies.seat import Seat
from alula.loads.records.bearing import NARROW, WIDE
from alula.loads.records.contact import pressure

CENTRE = np.array([20.0, 0.0, 0.0])
LAWS = [WIDE, NARROW]
SEAT = Seat(
    young=2500.0, pin_young=200e3, diameter=1.5, length=3.0, eye=5.0, away=1, clearance=(0.001, 0.002)
)  # E c t/F of 2.5 to 5 at 3 N
PULL = np.array([[3.0, 0.5, 0.0, 0.0, 0.0, 0.0]])


@pytest.fixture(scope="module")
def space():
    return displacement_space(solid_meshes.bar(tail=6.0))


def pin(wrench, seat=SEAT):
    return PinLoad(name="B", centre=CENTRE, diameter=1.5, wrench=np.asarray(wrench, float), seat=seat)


def test_both_laws_stand_about_the_half_angle_of_contact_at_the_ends_of_the_clearance():
    """A rigid pin in an eye of D/d = 2.67 touches over 62° at E c t/F = 3 and over 36° at 10, by another solution."""
    for tightness, angle in ((3.0, 62.0), (10.0, 36.0)):
        force = 2500.0 * 0.003 * 3.0 / tightness
        seat = replace(SEAT, eye=4.0, clearance=(0.003, 0.003), pin_young=1e9)
        wide, narrow = (half_angles(seat, law, force * np.eye(6)[:1])[0] for law in LAWS)
        assert math.degrees(wide) == pytest.approx(angle + math.degrees(WIDER), abs=3.0)
        assert math.degrees(narrow) == pytest.approx(max(angle - math.degrees(NARROWER), 36.0), abs=3.0)
    wide, narrow = (half_angles(SEAT, law, PULL)[0] for law in LAWS)
    assert wide - narrow > WIDER + NARROWER


def test_looser_pins_and_smaller_forces_touch_over_less_until_the_narrowest():
    loose = [half_angles(replace(SEAT, clearance=(c, c)), WIDE, PULL)[0] for c in (0.0, 0.001, 0.003, 0.1, 5.0)]
    assert np.all(np.diff(loose) <= 0.0)
    assert loose[-1] == NARROWEST
    light = half_angles(SEAT, NARROW, PULL * np.array([[100.0], [1.0], [0.01], [0.0]]))
    assert light[0] > light[1] >= light[2] == NARROWEST
    assert math.isnan(light[3])  # without a force nothing pulls


def test_a_couple_widens_what_is_wide_and_narrows_what_is_narrow():
    tilted = PULL + 1.5 * np.eye(6)[4]
    assert half_angles(SEAT, WIDE, tilted) > half_angles(SEAT, WIDE, PULL)
    assert half_angles(SEAT, NARROW, tilted) <= half_angles(SEAT, NARROW, PULL)


@pytest.mark.parametrize(
    "seat",
    [
        None,
        replace(SEAT, clearance=None),
        replace(SEAT, away=0),
        replace(SEAT, away=-1),
        replace(SEAT, eye=3.2),
    ],
)
@pytest.mark.parametrize("law", LAWS)
def test_elsewhere_the_pressure_is_that_of_the_span(space, law, seat):
    """Nothing stated, an eye amid the link, one that is pushed on its shank, and a thin one."""
    assert np.isnan(half_angles(seat, law, PULL)).all()
    bore = surface_quadrature(space, "bore:B")
    assert np.array_equal(pin_traction(bore, pin(PULL[0], seat), law), pin_traction(bore, pin(PULL[0], None), law))


def test_across_the_link_it_is_that_of_the_span():
    across = np.array([[1.0, 0.5, 0.0, 0.0, 0.0, 0.0], [1.0, 0.3, 0.0, 0.0, 0.0, 0.0]])
    assert np.isnan(half_angles(SEAT, WIDE, across)).tolist() == [True, False]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("wrench", [PULL[0], (3.0, -0.5, 0, 0.2, 0.4, 0)])
def test_contact_delivers_force_and_couple(space, law, wrench):
    bore = surface_quadrature(space, "bore:B")
    assert bore.wrench(pin_traction(bore, pin(wrench), law), CENTRE) == pytest.approx(np.asarray(wrench), abs=1e-11)


@pytest.mark.parametrize("law", LAWS)
def test_fields_of_an_envelope_give_the_pressure_of_each_state(space, law):
    """States with contact and without, in one history."""
    wrenches = np.array([(3.0, 0.5, 0, 0, 0, 0), (-3.0, 0.5, 0, 0, 0, 0), (0.5, 0.1, 0, 0, 0, 0)])
    load = PinLoad(name="B", centre=np.tile(CENTRE, (3, 1)), diameter=1.5, wrench=wrenches, seat=SEAT)
    history = LinkLoads(name="n", pins=(load,))
    tractions = LinkTractions.of(space, [history], density=1e-9, kinds=(PinPressure,))
    by_fields = tractions.vectors @ tractions.coefficients(history, law, None)
    exact = tractions.exact(history, law)
    assert np.all(np.linalg.norm(by_fields - exact, axis=0) < 0.02 * np.linalg.norm(exact, axis=0))
    alone = LinkTractions.of(space, [history], density=1e-9, kinds=(PinPressure,)).exact(history.chosen([0]), law)
    assert exact[:, [0]] == pytest.approx(alone)


def test_coefficients_are_those_of_the_profile():
    theta = (np.arange(20_000) + 0.5) * 2.0 * np.pi / 20_000
    angles = np.array([0.4, 1.0, 1.9])
    found = contact_coefficients(angles, 16)
    for i, angle in enumerate(angles):
        p = pressure(theta, angle)
        expected = [p.mean(), *(2.0 * np.mean(p * np.cos(k * theta)) for k in range(1, 17))]
        assert found[:, i] == pytest.approx(expected, abs=2e-4)
