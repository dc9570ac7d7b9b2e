import dataclasses

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import LineReference
from alula.fea.refine.error_estimate import energy_density
from alula.fea.solid import solution as solid
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import BodyForce, LineLoad, PartMass
from alula.loads.records.bearing import WIDE
from alula.reports.sentences import told

E, NU, RHO = 2900.0, 0.38, 1.2e-9
L = 20.0
MATERIAL = {"E": E, "nu": NU, "density": RHO, "line": ("bore:A", "bore:B"), "threads": 1}


def pin(name, *wrench):
    return PinLoad(name=name, centre=np.array([0.0 if name == "A" else L, 0, 0]), diameter=1.5, wrench=np.array(wrench))


def driven(fx=1.0, fy=2.0):
    """A carries the drive; B is pushed: moment about A of B's force is −L fy."""
    return LinkLoads(
        name="driven",
        pins=(pin("A", fx, fy, 0.0, 0, 0, 0), pin("B", -fx, -fy, 0.0, 0, 0, 0)),
        couples=(DriveCouple(pin="A", torque=L * fy),),
    )


OUT_OF_PLANE = LinkLoads(
    name="out of plane", pins=(pin("A", 0.0, 0, 0.5, 3.0, -0.5 * L - 2.0, 0), pin("B", 0.0, 0, -0.5, -3.0, 2.0, 0))
)


@pytest.fixture(scope="module")
def mesh():
    return solid_meshes.bar(tail=4.0)


@pytest.fixture(scope="module")
def solution(mesh):
    return solve_solid(mesh, loads=[driven(), OUT_OF_PLANE], **MATERIAL)


def test_every_variant_is_there_once(solution):
    assert [(c.load, c.span, c.transfer) for c in solution.cases] == [
        ("driven", 180, "eye-faces"),
        ("driven", 180, "bore-shear"),
        ("driven", 90, "eye-faces"),
        ("driven", 90, "bore-shear"),
        ("out of plane", 180, None),
        ("out of plane", 90, None),
    ]
    energies = [c.strain_energy for c in solution.cases]
    assert len(set(energies)) == len(energies)
    assert solution.notes == ()


def test_loads_balance_and_supports_do_not_react(solution):
    assert len(solution.cases) == 6, "two spans of pressure of two loads, one of them with two ways of the torque"
    for case in solution.cases:
        assert case.imbalance < 1e-12
        assert case.reaction < 1e-9


def test_work_of_the_loads_is_the_energy_of_the_stresses(solution):
    # Two ways: half the work of the load vector, and the integral of the stresses of straight and curved elements.
    for case in solution.cases:
        field = stress_field(solution.space, case.displacement, E=E, nu=NU)
        stored = float((field.weights * energy_density(field.at_points, E, NU)).sum()) / 2.0
        assert stored == pytest.approx(case.strain_energy, rel=1e-4)


def test_displacement_is_relative_to_the_line_through_the_pins(solution):
    first, last = (surface_quadrature(solution.space, name) for name in ("bore:A", "bore:B"))
    for case in solution.cases:
        size = case.displacement_max
        assert np.abs(first.mean(case.displacement)).max() < 1e-12 * size
        assert np.abs(last.mean(case.displacement)[1:]).max() < 1e-12 * size
        twist = sum(
            np.einsum("kq,kqi,kqi->", hole.w, np.cross([1.0, 0, 0], hole.x), moved(hole, case.displacement))
            for hole in (first, last)
        )
        assert abs(twist) < 1e-11 * size


def moved(hole, field):
    return np.einsum("qb,kbi->kqi", hole.phi, field[hole.nodes])


def test_result_does_not_depend_on_how_the_link_lies(mesh, solution):
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([5.0, -3.0, 0.0])
    turned = dataclasses.replace(mesh, points=mesh.points @ turn.T + shift)
    loads = dataclasses.replace(
        driven(),
        pins=tuple(
            dataclasses.replace(
                p,
                centre=turn @ p.centre + shift,
                wrench=np.concatenate([turn @ p.wrench[:3], turn @ p.wrench[3:]]),
            )
            for p in driven().pins
        ),
    )
    other = solve_solid(turned, loads=[loads], **MATERIAL)
    for one, two in zip(solution.cases[:4], other.cases, strict=True):
        np.testing.assert_allclose(two.displacement, one.displacement @ turn.T, atol=1e-9 * one.displacement_max)


def test_loads_superpose_where_the_pins_do_not_change_sides(mesh):
    single = solve_solid(mesh, loads=[driven(1.0, 2.0)], **MATERIAL)
    double = solve_solid(mesh, loads=[driven(2.0, 4.0)], **MATERIAL)
    for one, two in zip(single.cases, double.cases, strict=True):
        np.testing.assert_allclose(two.displacement, 2.0 * one.displacement, atol=1e-9 * two.displacement_max)


def test_torque_of_a_pin_enters_like_a_drive_couple(mesh):
    held = dataclasses.replace(driven(), pins=(pin("A", 1.0, 2.0, 0, 0, 0, 2.0 * L), driven().pins[1]), couples=())
    one = solve_solid(mesh, loads=[driven()], **MATERIAL)
    other = solve_solid(mesh, loads=[held], **MATERIAL)
    for a, b in zip(one.cases, other.cases, strict=True):
        np.testing.assert_allclose(b.displacement, a.displacement, atol=1e-10 * a.displacement_max)


def test_weight_end_and_line_loads_balance_against_the_pins(mesh):
    volume = volume_quadrature(displacement_space(mesh))
    weight = RHO * volume.measure * 9810.0
    tip, spread = np.array([26.5, 0.0, 0.0]), 0.02 * 12.0
    # Moments about A of weight, tip load and spread load, borne by B; forces by A.
    moment = -weight * volume.centroid[0] - 0.3 * tip[0] - spread * 10.0
    up_b = -moment / L
    up_a = weight + 0.3 + spread - up_b
    mass = PartMass(mass=weight / 9810.0, centroid=volume.centroid[:2])
    even = np.array([0, -0.02, 0])
    loads = LinkLoads(
        name="all",
        pins=(pin("A", 0.0, up_a, 0, 0, 0, 0), pin("B", 0.0, up_b, 0, 0, 0, 0)),
        ends=(EndLoad(name="T", point=tip, wrench=np.array([0.0, -0.3, 0, 0, 0, 0])),),
        inertia=BodyForce(link="bar", mass=mass, specific_force=np.array([0.0, -9810.0, 0.0]), axes="link"),
        lines=(LineLoad(link="bar", start=4.0, end=16.0, at_start=even, at_end=even, axes="link"),),
    )
    case = solve_solid(mesh, loads=[loads], laws=(WIDE,), **MATERIAL).cases[0]
    assert case.imbalance < 1e-9
    assert case.reaction < 1e-9


def test_loads_that_do_not_balance_are_refused_with_the_numbers(mesh):
    wrong = dataclasses.replace(driven(), couples=(DriveCouple(pin="A", torque=39.0),))
    with pytest.raises(CannotRunError, match=r"'driven' do not balance.*\(.*\) N and a moment of \(.*, -1\) N mm"):
        solve_solid(mesh, loads=[wrong], **MATERIAL)


def test_small_imbalance_is_let_through_and_told(mesh, monkeypatch):
    slight = dataclasses.replace(driven(), couples=(DriveCouple(pin="A", torque=39.7),))
    monkeypatch.setattr(solid, "IMBALANCE_LIMIT", 1.0)
    solution = solve_solid(mesh, loads=[slight], laws=(WIDE,), transfers=("bore-shear",), **MATERIAL)
    assert "the supports react with" in told(solution.notes[0])
    assert 1e-3 < solution.cases[0].reaction < 1e-2


def test_reacting_supports_are_refused(mesh, monkeypatch):
    wrong = dataclasses.replace(driven(), couples=(DriveCouple(pin="A", torque=20.0),))
    monkeypatch.setattr(solid, "IMBALANCE_LIMIT", 1.0)
    with pytest.raises(CannotRunError, match=r"supports of the free body react with"):
        solve_solid(mesh, loads=[wrong], **MATERIAL)


def test_case_without_load_is_refused(mesh):
    with pytest.raises(CannotRunError, match=r"'idle' puts no load on the link"):
        solve_solid(mesh, loads=[LinkLoads(name="idle")], **MATERIAL)


def test_the_line_of_a_single_bore_moves_and_turns_with_it(mesh):
    space = displacement_space(mesh)
    nodes = space.nodes
    reference = LineReference(space, ("bore:A", "bore:A"))
    moved = np.array([1.0, -2.0, 3.0]) + np.cross([0.01, -0.03, 0.02], nodes)
    assert reference.relative(moved) == pytest.approx(np.zeros_like(nodes), abs=1e-9)
    centre = surface_quadrature(space, "bore:A").centroid
    beyond = np.linalg.norm(nodes[:, :2] - centre[:2], axis=1) > np.ptp(nodes[:, 0]) / 4.0
    bent = np.where(beyond[:, None], [[0.0, 0.4, 0.1]], 0.0)  # nothing moves at the bore
    assert reference.relative(bent + moved) == pytest.approx(bent, abs=1e-9)


def test_inputs_stay_as_they_were(mesh):
    points, loads = mesh.points.copy(), driven()
    wrenches = [p.wrench.copy() for p in loads.pins]
    solve_solid(mesh, loads=[loads], laws=(WIDE,), **MATERIAL)
    np.testing.assert_array_equal(mesh.points, points)
    for p, before in zip(loads.pins, wrenches, strict=True):
        np.testing.assert_array_equal(p.wrench, before)
