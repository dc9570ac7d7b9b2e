"""Estimates by hand at an eye, term by term, against elementary formulas."""

import math
from dataclasses import replace

import eye_link
import numpy as np
import pytest

from alula.fea.beam.critical_locations import _bore, displacement_estimate
from alula.fea.common.link_loads import PinLoad
from alula.geometry.bodies.seat import Seat
from alula.geometry.parts.part import Bar, Body, Pin

WIDE, THICK, HOLE = 12.0, 4.0, 3.0
BODY = Body(
    part=Bar(
        shape="bar", material="any", width="8 mm", thickness="4 mm", eye_diameter="12 mm", eye_thickness="4 mm",
        fillet_radius="1 mm",
    ),
    pins=(Pin(name="A", x=0.0, y=0.0, diameter=HOLE), Pin(name="B", x=40.0, y=0.0, diameter=HOLE)),
    ends=(),
    holes=(),
)  # fmt: skip
IDLE = PinLoad(name="A", centre=np.zeros((1, 3)), diameter=HOLE, wrench=np.zeros((1, 6)))


def bore(torque=0.0, **through):
    """The estimate under a torque on the bore and forces (N, M_y, M_z, T) that pass through the eye."""
    names = {"n": 0, "t": 3, "m_y": 4, "m_z": 5}
    forces = np.zeros(6)
    for name, value in through.items():
        forces[names[name]] = value
    [found] = _bore(BODY, BODY.pins[0], IDLE, np.array([torque]), forces[None], forces[None])
    return found


def test_a_torque_shears_the_bore_evenly():
    """Shear stress T/(radius times the bore's surface), as von Mises stress."""
    even = 50.0 / (HOLE / 2.0 * math.pi * HOLE * THICK)
    assert bore(torque=-50.0) == pytest.approx(math.sqrt(3.0) * even)


def test_what_passes_through_an_eye_bears_on_its_net_section():
    """N with factor 3, M_z with 2 at the hole's edge, M_y with 3 at the flat face."""
    area, second = (WIDE - HOLE) * THICK, THICK * (WIDE**3 - HOLE**3) / 12.0
    assert bore(n=90.0) == pytest.approx(3.0 * 90.0 / area)
    assert bore(m_z=60.0) == pytest.approx(2.0 * 60.0 * (HOLE / 2.0) / second)
    assert bore(m_y=60.0) == pytest.approx(3.0 * 60.0 * (THICK / 2.0) / ((WIDE - HOLE) * THICK**3 / 12.0))


@pytest.mark.parametrize("soft", [4.0, 8.0])
def test_a_pin_that_bends_presses_on_the_rim_at_which_it_is_loaded(soft):
    """2βF under a force there, 2β²M under a couple, of a long beam (Hetényi, 1946); of a stiff pin 4F/L and 6M/L²."""
    pin_young = 1.5 * 70e3 / (4.0 * (math.pi * HOLE**4 / 64.0) * (soft / THICK) ** 4)
    seat = Seat(young=70e3, pin_young=pin_young, diameter=HOLE, length=THICK, eye=WIDE, side=1)

    def over_stiff(force, couple):
        stiff = replace(IDLE, wrench=np.array([[force, 0.0, 0.0, 0.0, couple, 0.0]]))
        idle = np.zeros((1, 6))
        found = [
            _bore(BODY, BODY.pins[0], load, np.zeros(1), idle, idle) for load in (replace(stiff, seat=seat), stiff)
        ]
        return found[0][0] / found[1][0]

    assert over_stiff(10.0, 10.0 * THICK / 2.0) == pytest.approx(soft / 2.0, rel=0.01)
    assert over_stiff(0.0, 5.0) == pytest.approx(soft**2 / 3.0, rel=0.02)


def test_a_pins_eye_gives_by_its_force_over_modulus_and_thickness():
    task = eye_link.task()
    beam = eye_link.beam(task)

    def at(young, loads=task.loads[0]):
        forces, section = beam.forces.state(None), beam.section
        (moved,) = displacement_estimate(
            task.body, loads.chosen(None), forces, section, young=young, poisson=task.nu, line=(0.0, 72.0)
        )
        return moved * young

    largest = max(float(np.linalg.norm(pin.wrench[:3])) for pin in task.loads[0].pins)
    idle = tuple(
        PinLoad(name=p.name, centre=p.centre, diameter=p.diameter, wrench=np.zeros(6)) for p in task.loads[0].pins
    )
    bare = at(1.0, type(task.loads[0])(name="idle", pins=idle))
    assert at(2400.0) - bare == pytest.approx(largest / 7.0)
