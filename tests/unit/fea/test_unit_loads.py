import math
from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from turning_load import POSES, RHO, L, history

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import rigid_motions
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.mass_force import MassForce
from alula.fea.tractions.pin_pressure import HIGHEST_ORDER, PinPressure, fourier_coefficients
from alula.fea.tractions.traction import TRANSFERS, couple_traction, pin_traction
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import PartMass, shifted
from alula.loads.records.bearing import NARROW, WIDE

ORIGIN = np.zeros(3)


@pytest.fixture(scope="module")
def space():
    return displacement_space(solid_meshes.bar(around=12, radial=2, along=3, layers=1, tail=4.0))


@pytest.fixture(scope="module")
def units(space):
    return LinkTractions.of(space, [history(space)], density=RHO)


def one(units, kind, name=None):
    """Numbers of the fields of the one load of a kind, of a name."""
    [found] = [
        numbers
        for load, numbers in zip(units.loads, units.numbers, strict=True)
        if isinstance(load, kind) and name in (None, getattr(load, "name", None))
    ]
    return found


@pytest.mark.parametrize("law", [WIDE, NARROW])
def test_fourier_series_is_that_of_the_law(law):
    theta = np.linspace(-math.pi, math.pi, 20001)
    for n, a in enumerate(fourier_coefficients(law, 12)):
        share = np.trapezoid(law.shape(theta) * np.cos(n * theta), theta) / math.pi
        assert a == pytest.approx(share * (0.5 if n == 0 else 1.0), abs=1e-7)
    order = np.arange(201)
    series = fourier_coefficients(law, 200) @ np.cos(order[:, None] * theta)
    assert np.abs(series - law.shape(theta)).max() < 0.01


def test_even_orders_up_to_eight_hold_the_wide_peak():
    a = fourier_coefficients(WIDE, 8)
    assert a[[3, 5, 7]] == pytest.approx(0.0, abs=1e-15)
    assert abs(a.sum() - 1.0) < 0.025  # of the pressure itself; the stress it makes is far closer


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("transfer", TRANSFERS)
def test_every_pose_balances_on_the_meshed_hole(space, units, law, transfer):
    loads = history(space)
    resultant = units.wrenches @ units.coefficients(loads, law, transfer)
    scale = loads.size(30.0)
    assert np.abs(resultant[:3] / scale).max() < 1e-12
    assert np.abs(resultant[3:] / (30.0 * scale)).max() < 1e-12


def test_pressure_fields_have_no_resultant_and_tractions_deliver_the_force(units):
    assert np.abs(units.wrenches[:, units.local]).max() < 1e-12
    delivered = units.wrenches[:, one(units, PinPressure, "B")][:, -2:]
    assert delivered[:, 0] == pytest.approx([1, 0, 0, 0, 0, 0], abs=1e-12)
    assert delivered[:, 1] == pytest.approx([0, 1, 0, 0, 0, L], abs=1e-11)


@pytest.mark.parametrize(("law", "least"), [(WIDE, 2e-3), (NARROW, 4e-3)])
def test_load_vectors_are_those_of_the_pressure_itself(space, units, law, least):
    bore = surface_quadrature(space, "bore:B")
    at_b = history(space).pins[1].wrench[:, [0, 1, 5]]
    loads = history(space, pins={"A": 0.0 * at_b, "B": at_b}, couples={}, ends={}, lines=(), mass=None)
    found = units.vectors @ units.coefficients(loads, law, None)
    for pose, force in enumerate(at_b):
        wrench = np.array([*force[:2], 0, 0, 0, 0])
        pin = PinLoad(name="B", centre=np.array([L, 0, 0]), diameter=1.5, wrench=wrench)
        whole = bore.load_vector(pin_traction(bore, pin, law), len(space.nodes))
        assert np.linalg.norm(found[:, pose] - whole) < least * np.linalg.norm(whole)


@pytest.mark.parametrize(("law", "least"), [(WIDE, 0.03), (NARROW, 0.06)])
def test_a_couple_beside_the_force_is_one_pressure_with_it(space, law, least):
    """Also where it turns over within the bore, and where its direction turns along it."""
    bore, wrenches = surface_quadrature(space, "bore:B"), np.zeros((4, 6))
    wrenches[:, 0], wrenches[:, 1] = [3.0, 3.0, 0.0, -1.0], [0.0, 1.0, 2.0, 0.0]
    wrenches[:, 3], wrenches[:, 4] = [0.0, 2.0, -9.0, 1.5], [0.5, 1.0, 0.0, 0.0]
    plain = history(space)
    given = {"A": np.zeros((4, 6)), "B": wrenches}
    pins = tuple(replace(pin, centre=pin.centre[:4], wrench=given[pin.name]) for pin in plain.pins)
    loads = replace(plain, pins=pins, couples=(), ends=(), lines=(), inertia=None)
    made = LinkTractions.of(space, [loads], density=RHO)
    assert [load.name for load in made.loads] == ["B"]
    coefficients = made.coefficients(loads, law, None)
    found = made.vectors @ coefficients
    assert np.abs(made.wrenches[:, made.local]).max() < 1e-12
    for pose, wrench in enumerate(wrenches):
        pin = PinLoad(name="B", centre=np.array([L, 0, 0]), diameter=1.5, wrench=wrench)
        whole = bore.load_vector(pin_traction(bore, pin, law), len(space.nodes))
        assert np.linalg.norm(found[:, pose] - whole) < least * np.linalg.norm(whole)
        delivered = made.wrenches @ coefficients[:, pose]
        assert delivered == pytest.approx(shifted(wrench, np.array([L, 0.0, 0.0])), abs=1e-10)


def test_friction_is_shear_in_the_bore_however_the_drive_torque_enters(space):
    loads = history(space, couples={"A": np.linspace(1.0, 2.0, POSES)})
    pin = loads.pins[1]
    turned = pin.wrench + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.3])
    rubbed = replace(loads, pins=(loads.pins[0], replace(pin, wrench=turned, friction=np.full(POSES, 0.3))))
    made, bore = LinkTractions.of(space, [rubbed], density=RHO), surface_quadrature(space, "bore:B")
    expected = bore.load_vector(couple_traction(bore, np.array([L, 0.0, 0.0]), 0.3), len(space.nodes))
    for transfer in TRANSFERS:
        more = made.coefficients(rubbed, WIDE, transfer) - made.coefficients(loads, WIDE, transfer)
        for column in (made.vectors @ more).T:
            assert column == pytest.approx(expected, abs=1e-12)
    poses = [one.chosen([3]) for one in (rubbed, loads)]
    for with_it, without in zip(*(made.variants(pose, [WIDE], TRANSFERS) for pose in poses), strict=True):
        assert with_it.load - without.load == pytest.approx(expected, abs=1e-12)


def test_inertia_carries_the_stated_mass(space):
    mass = PartMass(mass=3e-6, centroid=np.array([11.0, 0.3]), inertia=4e-4)
    made = LinkTractions.of(space, [history(space, mass=mass)], density=RHO)
    about = mass.inertia + mass.mass * (11.0**2 + 0.3**2)
    expected = 3e-6 * np.array([[1, 0, -0.3], [0, 1, 11.0], [0.3, -11.0, -about / 3e-6], [11.0, 0.3, 0.0]]).T
    assert made.wrenches[[0, 1, 5]][:, one(made, MassForce)] == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_wrenches_are_those_of_the_vectors(space, units):
    motions = rigid_motions(space.nodes, ORIGIN).reshape(6, -1)
    assert units.wrenches == pytest.approx(motions @ units.vectors.toarray(), abs=1e-12)


def test_only_what_acts_has_a_unit_load(space):
    at_b = history(space).pins[1].wrench[:, [0, 1, 5]]
    loads = history(space, pins={"A": 0.0 * at_b, "B": at_b}, couples={}, ends={}, lines=(), mass=None)
    [pressure] = LinkTractions.of(space, [loads], density=RHO).loads
    assert (pressure.name, pressure.fields.shape[1]) == ("B", 2 * HIGHEST_ORDER + 1 + 2)


def test_hole_of_another_size_is_refused(space):
    loads = history(space)
    loads = replace(loads, pins=(replace(loads.pins[0], diameter=2.5), loads.pins[1]))
    with pytest.raises(CannotRunError, match=r"measures 1\.\d+ mm on the mesh, not 2\.5 mm"):
        LinkTractions.of(space, [loads], density=RHO)


def test_a_hole_that_misses_its_load_is_refused(units):
    [wall] = [load.wall for load in units.loads if isinstance(load, PinPressure) and load.name == "B"]
    uneven = replace(wall, bore=replace(wall.bore, normals=wall.bore.normals + np.array([0.0, 0.0, 0.3])))
    pressure = PinPressure(surfaces=units.loads[0].surfaces, wall=uneven, tilts=False, order=16)
    with pytest.raises(CannotRunError, match="meshed too unevenly"):
        pressure.pressure(np.eye(6)[:1], WIDE)
