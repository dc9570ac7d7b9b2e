"""The mean motion of a bore, and the flexibility of a link between its pins."""

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import rigid_motions
from alula.fea.solid.bore_motion import flexibility, mean_motion, work
from alula.fea.solid.solution import solve_free, solve_solid
from alula.fea.solid.virtual_work import virtual_work
from alula.fea.tractions.traction import wrench_density
from alula.geometry.meshing.mirror import mirrored

E, NU = 2900.0, 0.38
PLACES = {"bore:A": np.zeros(3), "bore:B": np.array([20.0, 0.0, 0.0])}


@pytest.fixture(scope="module")
def bar():
    return displacement_space(mirrored(solid_meshes.half_bar(tail=4.0, layers=1)))


@pytest.fixture(scope="module")
def between_bores(bar):
    return flexibility(bar, PLACES, E=E, nu=NU)


def test_the_mean_motion_is_the_least_squares_rigid_motion_about_any_point(bar):
    field = np.random.default_rng(3).normal(size=bar.nodes.shape)
    bore, point = surface_quadrature(bar, "bore:B"), np.array([17.0, 2.0, -1.0])
    root = np.sqrt(bore.w.ravel())
    moved = np.einsum("qb,kbi->kqi", bore.phi, field[bore.nodes]).reshape(-1, 3)
    columns = rigid_motions(bore.x.reshape(-1, 3), point) * root[:, None]
    expected = np.linalg.lstsq(columns.reshape(6, -1).T, (moved * root[:, None]).ravel(), rcond=None)[0]
    np.testing.assert_allclose(mean_motion(bore, point, field), expected, rtol=1e-9)


def test_a_rigid_motion_is_its_own_mean(bar):
    motion, point = np.array([0.3, -0.2, 0.5, 0.02, 0.03, -0.04]), PLACES["bore:B"]
    field = np.tensordot(motion, rigid_motions(bar.nodes, point), axes=1)
    np.testing.assert_allclose(mean_motion(surface_quadrature(bar, "bore:B"), point, field), motion, rtol=1e-10)


def test_the_dual_traction_does_the_work_of_its_wrench_on_the_mean_motion(bar):
    rng = np.random.default_rng(5)
    field, wrench, point = rng.normal(size=bar.nodes.shape), rng.normal(size=6), np.array([0.4, 0.1, 0.2])
    bore = surface_quadrature(bar, "bore:A")
    by_traction = work(bore, wrench_density(bore, point, wrench), field)
    assert by_traction == pytest.approx(float(wrench @ mean_motion(bore, point, field)), rel=1e-11)
    load = bore.load_vector(wrench_density(bore, point, wrench), len(bar.nodes))
    assert by_traction == pytest.approx(float(load @ field.ravel()), rel=1e-11)


def test_the_flexibility_is_symmetric_and_has_six_rigid_motions_in_its_null_space(between_bores):
    F = between_bores
    assert F.shape == (12, 12)
    np.testing.assert_allclose(F, F.T, atol=1e-11 * np.abs(F).max())
    size = np.sqrt(np.outer(F.diagonal(), F.diagonal()))
    scaled = np.linalg.eigvalsh(F / size)
    assert np.abs(scaled[:6]).max() < 1e-10
    assert scaled[6] > 1e-4


def test_balanced_wrenches_get_the_motions_of_their_solution(bar, between_bores):
    """A pull, bending and torsion that balance: relative motions are those of the solved field."""
    wrench = np.array([3.0, -2.0, 1.0, 4.0, 5.0, -60.0, -3.0, 2.0, -1.0, -4.0, -25.0, 20.0])
    assert np.abs(wrench[:6] + wrench[6:])[:3].max() == 0.0
    arm = np.array([20.0, 0.0, 0.0])
    np.testing.assert_allclose(wrench[3:6] + wrench[9:] + np.cross(arm, wrench[6:9]), 0.0, atol=1e-12)
    load = sum(
        surface.load_vector(wrench_density(surface, place, w), len(bar.nodes))
        for (name, place), w in zip(PLACES.items(), np.split(wrench, 2), strict=True)
        for surface in [surface_quadrature(bar, name)]
    )
    field = solve_free(bar, load[:, None], E=E, nu=NU).displacement[:, 0].reshape(-1, 3)
    solved = np.concatenate([mean_motion(surface_quadrature(bar, n), p, field) for n, p in PLACES.items()])
    assert float(wrench @ between_bores @ wrench) == pytest.approx(float(wrench @ solved), rel=1e-8)
    gap = between_bores @ wrench - solved
    moved = np.array([gap[:3], gap[6:9] - np.cross(gap[3:6], arm)])  # a rigid motion is left between both
    np.testing.assert_allclose(moved[0], moved[1], atol=1e-7 * np.abs(solved).max())
    np.testing.assert_allclose(gap[3:6], gap[9:], atol=1e-7 * np.abs(solved).max())


def test_the_ends_of_a_box_stretch_and_turn_as_a_prismatic_bar_does():
    """Even tension and linear bending stress are exact solutions: F L/(E A) and M L/(E I)."""
    length, wide, high = 3.0, 1.1, 0.9
    space = displacement_space(solid_meshes.box(upper=(length, wide, high), amount=0.05))
    middle = np.array([0.0, wide / 2.0, high / 2.0])
    F = flexibility(space, {"end:0": middle, "end:1": middle + np.array([length, 0.0, 0.0])}, E=E, nu=NU)
    pair = np.concatenate([-np.eye(6), np.eye(6)])
    inertia = wide**3 * high / 12.0
    assert float(pair[:, 0] @ F @ pair[:, 0]) == pytest.approx(length / (E * wide * high), rel=1e-9)
    assert float(pair[:, 5] @ F @ pair[:, 5]) == pytest.approx(length / (E * inertia), rel=1e-9)


@pytest.mark.parametrize(
    ("at_a", "at_b", "torque", "slotted"),
    [
        ([3.0, -1.0, 0.0, 0.0, 0.0, 0.0], [-3.0, 1.0, 0.0, 0.0, 0.0, 0.0], -20.0, False),
        ([0.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.0, -2.0, 0.0, 0.0, 0.0, 0.0], 40.0, True),
    ],
)
def test_pins_that_sink_do_the_work_of_their_own_pressure(at_a, at_b, torque, slotted):
    """With the real loads as virtual ones, mean motions and all that pins sink make twice the strain energy."""
    pins = tuple(
        PinLoad(name=name, centre=PLACES[f"bore:{name}"], diameter=1.5, wrench=np.array(wrench), slotted=s)
        for name, wrench, s in (("A", at_a, False), ("B", at_b, slotted))
    )
    loads = LinkLoads(name="own", pins=pins, couples=(DriveCouple(pin="A", torque=torque),))
    assert np.abs(loads.resultant()).max() < 1e-12
    mesh = mirrored(solid_meshes.half_bar(tail=4.0, layers=1))
    solved = solve_solid(mesh, E=E, nu=NU, density=1e-9, loads=[loads], line=("bore:A", "bore:B"), threads=1)
    (work,) = virtual_work(solved, loads, [loads], transfer="eye-faces", error=0.0)
    energies = [case.strain_energy for case in solved.cases]
    assert work.band(sunk=True).high == pytest.approx(2.0 * max(energies), rel=1e-8)
    assert work.mean.value < 2.0 * min(energies)
    assert work.mean.high < 2.0 * max(energies)
