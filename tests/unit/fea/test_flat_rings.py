"""A hole without a flat ring about it has no named flat faces: thrust and torque enter through its bore."""

import numpy as np
import pytest

from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.meshing.mesh import mesh_body
from alula.geometry.meshing.mesh_settings import COARSE
from alula.geometry.parts.part import Bar, Body, Pin, Ring
from alula.geometry.solids.solid_model import scaled
from alula.loads.records.bearing import WIDE

L, TORQUE, THRUST = 30.0, 6.0, 4.0
NO_RING = Ring(diameter=0.0, low=-2.0, high=2.0)
BAR = Bar.model_validate(
    {"shape": "bar", "material": "resin", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "1 mm"}
)


@pytest.fixture(scope="module")
def body():
    pins = (Pin(name="A", x=0.0, y=0.0, diameter=3.0, ring=NO_RING), Pin(name="B", x=L, y=0.0, diameter=3.0))
    return Body(part=BAR, pins=pins, ends=(), holes=())


@pytest.fixture(scope="module")
def space(body):
    return displacement_space(mesh_body(body, COARSE))


def loads(driven):
    """Thrust along z at both pins, and a torque about one that a couple of forces balances."""
    a, b = np.array([0.0, TORQUE / L, THRUST, 0, 0, 0]), np.array([0.0, -TORQUE / L, -THRUST, 0, -THRUST * L, 0])
    pins = [
        PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=3.0, wrench=wrench)
        for name, x, wrench in (("A", 0.0, a), ("B", L, b))
    ]
    return LinkLoads(name="driven", pins=tuple(pins), couples=(DriveCouple(pin=driven, torque=TORQUE),))


def variants(space, driven):
    pose = loads(driven).chosen(None)
    return list(LinkTractions.of(space, [pose], density=0.0).variants(pose, (WIDE,), TRANSFERS))


def test_only_the_pin_with_a_ring_has_flat_faces(space):
    assert set(space.surfaces) == {"bore:A", "bore:B", "top:B", "bottom:B"}


def test_thrust_and_torque_enter_the_bore_without_a_moment_of_their_own(space):
    (variant,) = variants(space, "A")
    assert variant.transfer is None
    force = variant.load.reshape(-1, 3)
    bore = np.unique(space.faces("bore:A"))
    moment = np.cross(space.nodes[bore], force[bore]).sum(axis=0)
    assert force[bore].sum(axis=0) == pytest.approx([0.0, TORQUE / L, THRUST], abs=1e-9)
    assert moment == pytest.approx([0.0, 0.0, TORQUE], abs=1e-9)
    assert force.sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_torque_where_there_is_a_ring_has_both_variants(space):
    assert [variant.transfer for variant in variants(space, "B")] == list(TRANSFERS)


@pytest.mark.parametrize(("driven", "transfers"), [("A", (None,)), ("B", TRANSFERS)])
def test_the_unit_loads_of_a_motion_do_alike(space, driven, transfers):
    history = loads(driven).chosen(None)
    units = LinkTractions.of(space, [history], density=0.0)
    assert units.transfers(history) == transfers
    resultants = [units.wrenches @ units.coefficients(history, WIDE, transfer) for transfer in transfers]
    assert np.abs(resultants).max() < 1e-9


def test_rings_are_scaled_with_their_body(body):
    small = scaled(body, 0.5)
    assert small.ring(small.pins[0]) == Ring(diameter=0.0, low=-4.0, high=4.0)
    assert small.ring(small.pins[1]) == Ring(diameter=2.0 * 1.6 * 8.0, low=-4.0, high=4.0)
