import dataclasses
import math

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import rigid_motions
from alula.fea.tractions.bore_wall import OPENING, first_opening
from alula.fea.tractions.traction import (
    body_density,
    couple_traction,
    line_density,
    pin_traction,
    thrust_traction,
    wrench_density,
)
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.part import Body, Pin, Tube
from alula.loads.records.applied import BodyForce, LineLoad, PartMass
from alula.loads.records.bearing import NARROW, WIDE

CENTRE = np.array([20.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def space():
    return displacement_space(solid_meshes.bar(tail=6.0))


@pytest.fixture(scope="module")
def bore(space):
    return surface_quadrature(space, "bore:B")


def pin(*wrench, diameter=1.5):
    return PinLoad(name="B", centre=CENTRE, diameter=diameter, wrench=np.array(wrench, float))


def delivered(space, quadrature, density, point):
    """Wrench of the consistent load vector by virtual work with the six rigid-body motions."""
    vector = quadrature.load_vector(density, len(space.nodes))
    return rigid_motions(space.nodes, point).reshape(6, -1) @ vector


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 123.4, -90.0, 180.0])
def test_pin_delivers_its_force_exactly_in_every_direction(space, bore, law, degrees):
    force = 3.7 * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    density = pin_traction(bore, pin(*force, 0, 0, 0, 0), law)
    np.testing.assert_allclose(delivered(space, bore, density, CENTRE), [*force, 0, 0, 0, 0], atol=1e-11)


def part_of(bore, *, low, high):
    """The cells of a hole whose middles stand between two angles [degrees], counted from -180 to 180."""
    arm = bore.x.mean(axis=1) - CENTRE
    angle = np.degrees(np.arctan2(arm[:, 1], arm[:, 0]))
    kept = (low < angle) & (angle < high)
    return dataclasses.replace(
        bore, **{name: getattr(bore, name)[kept] for name in ("nodes", "x", "w", "normals")}
    ), kept


def test_the_first_direction_without_a_wall_is_found_wherever_angles_are_cut():
    """The wall is from -100 to 100 degrees, and bears ``OPENING`` beyond; its opening is behind, about 180 degrees."""
    wall, reach = np.radians(np.linspace(-100.0, 100.0, 201)), np.degrees(OPENING)
    borne = np.radians([0.0, 100.0, -100.0, 99.9 + reach, -99.9 - reach, 460.0])
    assert first_opening(wall, borne) is None
    for bare in np.radians([180.0, -180.0, 100.1 + reach, -100.1 - reach, 540.0]):
        assert first_opening(wall, np.array([*borne, bare, np.pi])) == bare


@pytest.mark.parametrize("law", [WIDE, NARROW])
def test_an_opening_behind_the_pin_changes_nothing_and_one_before_it_is_refused(bore, law):
    clip, kept = part_of(bore, low=-121.0, high=121.0)
    assert 0.5 < kept.mean() < 0.8
    ahead = pin(3.7, 0, 0, 0, 0, 0)
    whole = pin_traction(bore, ahead, law)
    assert clip.wrench(pin_traction(clip, ahead, law), CENTRE) == pytest.approx(ahead.wrench, abs=1e-11)
    # The ends of this wall are ragged, along elements, which turns the pressure a little.
    assert pin_traction(clip, ahead, law) == pytest.approx(whole[kept], abs=0.08 * np.abs(whole).max())
    with pytest.raises(CannotRunError, match="pin at B pushes at 180 degrees into the opening of its bore"):
        pin_traction(clip, pin(-3.7, 0, 0, 0, 0, 0), law)


@pytest.mark.parametrize("degrees", [60.0, 90.0, 100.0])
def test_beside_an_opening_the_pressure_turns_until_it_delivers_the_force(bore, degrees):
    clip, _ = part_of(bore, low=-121.0, high=121.0)
    force = 3.7 * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    density = pin_traction(clip, pin(*force, 0, 0, 0, 0), NARROW)
    assert clip.wrench(density, CENTRE) == pytest.approx([*force, 0, 0, 0, 0], abs=1e-11)


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("wrench", [(0, 0, 0, 2.0, 0, 0), (1.0, -2.0, 0, -1.3, 0.7, 0), (0.2, 0.1, 0, 0, 5.0, 0)])
def test_pin_delivers_force_and_tilting_moment(space, bore, law, wrench):
    density = pin_traction(bore, pin(*wrench), law)
    np.testing.assert_allclose(delivered(space, bore, density, CENTRE), wrench, atol=1e-11)


@pytest.mark.parametrize("law", [WIDE, NARROW])
def test_pin_pushes_over_its_span_alone_and_with_the_peak_of_the_formula(bore, law):
    density = pin_traction(bore, pin(4.0, 0, 0, 0, 0, 0), law)
    pressure = -np.einsum("kqi,kqi->kq", density, bore.normals)
    peak = law.peak(force=4.0, diameter=1.5, thickness=3.0)
    angle = np.degrees(np.arctan2(bore.x[..., 1], bore.x[..., 0] - 20.0))
    np.testing.assert_allclose(pressure, peak * law.shape(np.radians(angle)), atol=0.03 * peak)
    assert pressure.max() == pytest.approx(peak, rel=0.03)


def test_tilted_pin_pushes_on_opposite_sides_above_and_below(bore):
    # A moment about +y comes from a pin that pushes towards +x above the mid-plane, towards -x below it.
    density = pin_traction(bore, pin(0, 0, 0, 0, 3.0, 0), WIDE)
    pressure = -np.einsum("kqi,kqi->kq", density, bore.normals)
    x, z = bore.x[..., 0] - 20.0, bore.x[..., 2]
    loaded = pressure > 0.05 * pressure.max()
    assert (x[loaded] * z[loaded] > -1e-6).all()
    assert pressure.min() > -0.02 * pressure.max()


def test_a_pin_off_the_axis_of_a_tube_tilts_by_pressure_alone():
    """Its wall is longer on one side, where a tilted pin pushes more above than it pulls below."""
    part = Tube.model_validate({"shape": "tube", "material": "any", "outer_diameter": "8 mm", "inner_diameter": "0 mm",
                                "eyes": "none"})  # fmt: skip
    pins = tuple(Pin(name=name, x=x, y=1.4, diameter=2.4) for name, x in (("A", 0.0), ("B", 12.0)))
    body = Body(part=part, pins=pins, ends=(), holes=())
    load = PinLoad(name="A", centre=np.array([0.0, 1.4, 0.0]), diameter=2.4,
                   wrench=np.array([0.0, 5.0, 0.0, 40.0, 0.0, 0.0]))  # fmt: skip
    off_axis = surface_quadrature(displacement_space(mesh_body(body, COARSE)), "bore:A")
    density = pin_traction(off_axis, load, WIDE)
    assert off_axis.wrench(density, load.centre) == pytest.approx(load.wrench, abs=1e-9)
    across = density - (density * off_axis.normals).sum(axis=-1, keepdims=True) * off_axis.normals
    assert np.abs(across).max() < 0.01 * np.abs(density).max()


def test_hole_of_another_diameter_is_refused(bore):
    with pytest.raises(CannotRunError, match=r"pin B measures 1\.5 mm on the mesh, not 2 mm"):
        pin_traction(bore, pin(1, 0, 0, 0, 0, 0, diameter=2.0), WIDE)


def test_half_a_hole_is_refused(bore):
    half = (bore.x[..., 0] > 20.0).all(axis=1)
    part = dataclasses.replace(bore, nodes=bore.nodes[half], x=bore.x[half], w=bore.w[half], normals=bore.normals[half])
    with pytest.raises(CannotRunError, match="into the opening of its bore"):
        pin_traction(part, pin(-1, 0, 0, 0, 0, 0), NARROW)


@pytest.mark.parametrize("force", [1.7, -0.4])
def test_thrust_presses_on_the_face_it_meets(space, force):
    face = surface_quadrature(space, "bottom:B" if force > 0.0 else "top:B")
    density = thrust_traction(face, pin(0, 0, force, 0, 0, 0))
    np.testing.assert_allclose(delivered(space, face, density, CENTRE), [0, 0, force, 0, 0, 0], atol=1e-11)
    assert (np.einsum("kqi,kqi->kq", density, face.normals) < 0.0).all()


@pytest.mark.parametrize("names", [("top:B", "bottom:B"), ("bore:B",)])
def test_couple_is_tangential_and_has_no_net_force(space, names):
    surface = surface_quadrature(space, *names)
    density = couple_traction(surface, CENTRE, -130.58)
    np.testing.assert_allclose(delivered(space, surface, density, CENTRE), [0, 0, 0, 0, 0, -130.58], atol=1e-9)
    arm = (surface.x - CENTRE) * (1.0, 1.0, 0.0)
    radial = np.einsum("kqi,kqi->kq", density, arm) / np.linalg.norm(arm, axis=2)
    assert np.abs(radial).max() < 0.05 * np.abs(density).max()


def test_patch_delivers_all_six_components_about_any_point(space):
    patch = surface_quadrature(space, "end:T")
    point, wrench = np.array([3.0, -1.0, 2.0]), np.array([1.0, -2.0, 0.5, 3.0, 4.0, -5.0])
    density = wrench_density(patch, point, wrench)
    np.testing.assert_allclose(delivered(space, patch, density, point), wrench, atol=1e-10)


def test_patch_without_extent_is_refused(space):
    patch = surface_quadrature(space, "end:T")
    needle = dataclasses.replace(patch, x=patch.x * (1.0, 1.0, 0.0))
    with pytest.raises(CannotRunError, match=r"too narrow to carry a moment"):
        wrench_density(needle, CENTRE, np.ones(6))


def test_weight_and_angular_acceleration(space):
    volume = volume_quadrature(space)
    rho = 1.2e-9
    mass = rho * volume.measure
    own = PartMass(mass=mass, centroid=volume.centroid[:2])
    load = BodyForce(link="bar", mass=own, specific_force=np.array([0.0, -9810.0, 0.0]), axes="link")
    got = delivered(space, volume, body_density(volume, load, rho), volume.centroid)
    np.testing.assert_allclose(got, [0, -9810.0 * mass, 0, 0, 0, 0], atol=1e-12)
    (x, y, _), arm = volume.centroid, volume.x - volume.centroid
    about_centroid = 50.0 * np.array([-y, x, 0.0])
    spun = BodyForce(link="bar", mass=own, specific_force=about_centroid, angular_acceleration=50.0, axes="link")
    inertia = rho * float((volume.w * (arm[..., 0] ** 2 + arm[..., 1] ** 2)).sum())
    got = delivered(space, volume, body_density(volume, spun, rho), volume.centroid)
    np.testing.assert_allclose(got, [0, 0, 0, 0, 0, -50.0 * inertia], atol=1e-12)


def test_centrifugal_force_is_that_of_the_centroid(space):
    volume = volume_quadrature(space)
    about, own = np.array([2.0, 1.0, 0.0]), PartMass(mass=1.2e-9 * volume.measure, centroid=volume.centroid[:2])
    load = BodyForce(link="bar", mass=own, specific_force=-900.0 * about, angular_speed_squared=900.0, axes="link")
    got = delivered(space, volume, body_density(volume, load, 1.2e-9), about)
    arm = (volume.centroid - about) * (1.0, 1.0, 0.0)
    np.testing.assert_allclose(got[:3], 1.2e-9 * volume.measure * 900.0 * arm, atol=1e-14)
    assert abs(got[5]) < 1e-14


def test_line_load_has_its_resultant_and_moment(space):
    volume = volume_quadrature(space)
    intensity = np.array([[0.1, -0.3, 0.2], [0.0, 0.5, -0.1]])
    load = LineLoad(link="bar", start=4.0, end=16.0, at_start=intensity[0], at_end=intensity[1], axes="link")
    got = delivered(space, volume, line_density(volume, load), np.zeros(3))
    x = np.linspace(4.0, 16.0, 4001)
    q = intensity[0] + ((x - 4.0) / 12.0)[:, None] * (intensity[1] - intensity[0])
    force = np.trapezoid(q, x, axis=0)
    moment = np.trapezoid(np.cross(np.column_stack([x, 0 * x, 0 * x]), q), x, axis=0)
    np.testing.assert_allclose(got, [*force, *moment], rtol=1e-6, atol=1e-9)


def test_even_line_load_is_even_along_a_link_of_varying_section(space):
    # Past the hole at B the section is smaller; each millimetre still gets its share.
    volume = volume_quadrature(space)
    even = np.array([0, 1.0, 0])
    load = LineLoad(link="bar", start=-2.0, end=26.0, at_start=even, at_end=even, axes="link")
    density = line_density(volume, load)
    x = volume.x[..., 0]
    for start in (-2.0, 5.0, 12.0, 19.0):
        part = (x >= start) & (x < start + 7.0)
        assert (volume.w * density[..., 1])[part].sum() == pytest.approx(7.0, rel=0.1)


def test_line_load_beside_the_link_is_refused(space):
    volume = volume_quadrature(space)
    one = np.ones(3)
    with pytest.raises(CannotRunError, match=r"lies partly outside of the link"):
        line_density(volume, LineLoad(link="bar", start=30.0, end=60.0, at_start=one, at_end=one, axes="link"))
