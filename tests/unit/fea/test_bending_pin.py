"""A pin that bends in its hole presses on the meshed hole as its foundation says."""

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.traction import pin_traction
from alula.geometry.bodies.seat import Seat
from alula.loads.records.bearing import NARROW, WIDE

CENTRE = np.array([20.0, 0.0, 0.0])
SEAT = Seat(young=70e3, pin_young=210e3, diameter=1.5, length=3.0, eye=4.0, side=1)
SOFTNESS = (64.0 * 0.5 / (4.0 * np.pi)) ** 0.25 * 2.0  # β t, t/d = 2, k = 1.5 E and a third of the modulus


@pytest.fixture(scope="module")
def space():
    return displacement_space(solid_meshes.bar(tail=6.0))


def pin(*wrench, seat=SEAT):
    return PinLoad(name="B", centre=CENTRE, diameter=1.5, wrench=np.array(wrench, float), seat=seat)


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("wrench", [(3.0, 0, 0, 0, 0, 0), (0, 0, 0, 2.0, 0, 0), (1.0, -2.0, 0, -1.3, 0.7, 0)])
def test_it_delivers_force_and_couple(space, law, wrench):
    bore = surface_quadrature(space, "bore:B")
    assert bore.wrench(pin_traction(bore, pin(*wrench), law), CENTRE) == pytest.approx(wrench, abs=1e-11)


def test_a_couple_presses_more_on_the_loaded_rim_than_a_stiff_pin(space):
    """Of a couple alone a stiff pin presses both rims alike; a bending one the rim where it is loaded, by Hetényi."""
    bore = surface_quadrature(space, "bore:B")
    z = bore.x[..., 2]
    ends = np.abs(z) > 0.9 * z.max()
    stiff, soft = (pin_traction(bore, pin(0, 0, 0, 0, 2.0, 0, seat=seat), WIDE) for seat in (None, SEAT))
    sh2, s2 = np.sinh(SOFTNESS) ** 2, np.sin(SOFTNESS) ** 2
    expected = SOFTNESS**2 / 3.0 * (sh2 + s2) / (sh2 - s2)  # 2 M β² (...) over 6 M/t²

    def peak(density, rim):
        return np.linalg.norm(density[rim & ends], axis=-1).max()

    upper, lower = z > 0.0, z < 0.0
    assert peak(stiff, upper) == pytest.approx(peak(stiff, lower), rel=0.02)
    assert peak(soft, upper) / peak(stiff, upper) == pytest.approx(expected, rel=0.12)  # points lie within the rim
    assert peak(soft, lower) < 0.7 * peak(stiff, lower)


def test_fields_of_an_envelope_give_the_same_pressure(space):
    """Linear between seven heights: 2 % and 6 % off in nodal forces, where the linear pressure is 0.1 % and 1 %."""
    wrenches = np.array([(3.0, 0, 0, 0, 1.0, 0), (1.0, -2.0, 0, -1.3, 0.7, 0)])
    load = PinLoad(name="B", centre=np.tile(CENTRE, (2, 1)), diameter=1.5, wrench=wrenches, seat=SEAT)
    history = LinkLoads(name="n", pins=(load,))
    tractions = LinkTractions.of(space, [history], density=1e-9, kinds=(PinPressure,))
    by_fields = tractions.vectors @ tractions.coefficients(history, WIDE, None)
    exact = tractions.exact(history, WIDE)
    assert np.all(np.linalg.norm(by_fields - exact, axis=0) < 0.06 * np.linalg.norm(exact, axis=0))
