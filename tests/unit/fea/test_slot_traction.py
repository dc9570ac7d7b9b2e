"""The push of a pin on the flank of its slot: exact resultants, where it acts, what it refuses."""

from dataclasses import replace

import numpy as np
import pytest

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature, surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.slot_pressure import lagrange_weights, places_for
from alula.fea.tractions.slot_traction import DEGREE, slot_traction
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.part import Bar, Body, Pin
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw

SLOT = Pin(name="S", x=6.0, y=0.0, diameter=2.1, slot=4.0, clearance=0.1)
BODY = Body(
    part=Bar(
        shape="bar",
        material="resin",
        width="4 mm",
        thickness="3 mm",
        eye_diameter="6 mm",
        eye_thickness="3 mm",
        fillet_radius="0 mm",
    ),
    pins=(SLOT, Pin(name="B", x=16.0, y=0.0, diameter=2.0)),
    ends=(),
    holes=(),
)


@pytest.fixture(scope="module")
def wall() -> SurfaceQuadrature:
    return surface_quadrature(displacement_space(mesh_body(BODY, COARSE)), "bore:S", degree=DEGREE)


def pin(*wrench: float, x: float = 6.5) -> PinLoad:
    return PinLoad(name="S", centre=np.array([x, 0.0, 0.0]), diameter=2.0, wrench=np.array(wrench), slotted=True)


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("x", [4.0, 4.013, 5.7, 6.5, 8.0])
@pytest.mark.parametrize("wrench", [(0, 3, 0, 0, 0, 0), (0, -3, 0, 0, 0, 0), (0, 3, 0, 2, 0, 0), (0, 0, 0, -2, 0, 0)])
def test_force_and_moment_are_exact(wall: SurfaceQuadrature, law: PressureLaw, x: float, wrench) -> None:
    load = pin(*wrench, x=x)
    assert wall.wrench(slot_traction(wall, load, law), load.centre) == pytest.approx(np.array(wrench, float), abs=1e-12)


def test_in_a_slot_off_the_plane_of_forces_the_pin_tilts_about_its_middle(wall: SurfaceQuadrature) -> None:
    """The slot reaches from 0.5 to 3.5 mm, so that a force of 3 N in the plane tilts the pin by 6 N mm about x.

    Both flanks are pushed then, or one of them alone were pulled where it is lower than the middle.
    """
    off = replace(wall, x=wall.x + np.array([0.0, 0.0, 2.0]))
    load = pin(0.0, 3.0, 0.0, 0.0, 0.0, 0.0)
    density = slot_traction(off, load, WIDE)
    assert off.wrench(density, load.centre) == pytest.approx(load.wrench, abs=1e-12)
    assert slot_traction(wall, pin(0.0, 3.0, 0.0, 6.0, 0.0, 0.0), WIDE) == pytest.approx(density, abs=1e-12)


@pytest.mark.parametrize(("share", "both"), [(0.9, False), (2.0, True)])
def test_force_and_moment_press_on_one_flank_up_to_a_sixth_of_the_wall(wall, share: float, both: bool) -> None:
    force, height = 3.0, float(np.ptp(wall.x[..., 2]))
    push = slot_traction(wall, pin(0.0, force, 0.0, share * force * height / 6.0, 0.0, 0.0), WIDE)[..., 1]
    assert (push.min() < -0.1 * push.max()) == both
    assert push.min() > -0.6 * push.max()


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_pushes_one_flank_about_the_pin_alone(wall: SurfaceQuadrature, law: PressureLaw, side: float) -> None:
    density = slot_traction(wall, pin(0.0, 3.0 * side, 0.0, 0.0, 0.0, 0.0), law)
    pushed = np.abs(density).max(axis=2) > 1e-12
    assert 0.9 * law.patch(2.0) / 2.0 < np.abs(wall.x[pushed][:, 0] - 6.5).max() <= law.patch(2.0) / 2.0
    assert (side * wall.x[pushed][:, 1] > 0.9).all()
    assert (side * density[..., 1] >= 0.0).all()
    assert np.abs(density[..., [0, 2]]).max() == 0.0


def test_a_patch_is_half_or_a_quarter_of_the_pin() -> None:
    assert (WIDE.patch(2.0), NARROW.patch(2.0)) == (1.0, 0.5)


def test_what_is_small_on_a_deformed_shape_is_delivered_too(wall: SurfaceQuadrature) -> None:
    load = pin(0.05, 3.0, 0.0, 0.0, 0.1, 0.2)
    assert wall.wrench(slot_traction(wall, load, WIDE), load.centre) == pytest.approx(load.wrench, abs=1e-12)


@pytest.mark.parametrize("wrench", [(1.0, 3.0, 0, 0, 0, 0), (0, 3.0, 0, 0, 0, 2.0), (0, 3.0, 0, 0, 2.0, 0)])
def test_a_push_along_the_slot_or_a_torque_is_refused(wall: SurfaceQuadrature, wrench) -> None:
    with pytest.raises(CannotRunError, match="pin in the slot at S would have to push along it"):
        slot_traction(wall, pin(*wrench), WIDE)


def test_a_flank_without_points_under_the_pin_is_refused(wall: SurfaceQuadrature) -> None:
    thin = wall.x[..., 0] < 6.3
    few = SurfaceQuadrature(
        nodes=wall.nodes, phi=wall.phi, x=wall.x, w=np.where(thin, wall.w, 0.0), normals=wall.normals
    )
    with pytest.raises(CannotRunError, match=r"slot at S is meshed too coarsely at x = 6.5 mm"):
        slot_traction(few, pin(0.0, 3.0, 0.0, 0.0, 0.0, 0.0), NARROW)


def test_weights_of_places_reproduce_cubics() -> None:
    places, x = np.linspace(4.0, 8.0, 9), np.array([4.0, 4.1, 5.25, 6.6, 7.99, 8.0])
    weights = lagrange_weights(places, x)
    for power in range(4):
        assert places**power @ weights == pytest.approx(x**power, rel=1e-12)
    assert np.count_nonzero(np.abs(weights) > 1e-12, axis=0).max() == 4


def test_places_span_the_travel_and_are_bounded() -> None:
    places = places_for(pin(), NARROW, 4.5, 7.5)
    assert (places[0], places[-1]) == (4.5, 7.5)
    assert np.diff(places).max() <= NARROW.patch(2.0) / 8.0 + 1e-12
    still = places_for(pin(), WIDE, 5.0, 5.0)
    assert still[0] < 5.0 < still[-1]
    with pytest.raises(CannotRunError, match=r"pin at S travels 60 mm in its slot, 30 of its diameters.*alula check"):
        places_for(pin(), NARROW, 0.0, 60.0)
