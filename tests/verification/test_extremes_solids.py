"""Solid models at the edges: incompressible materials, slender and thin tubes, slivers.

Figures and tables over the whole range: docs/stability.md.
"""

import time

import arm_case
import numpy as np
import programs
import pytest
import slender_tube
from known_solutions import NU, kirsch, solved
from solid_meshes import bar, box, ring

from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.solid.solution import LARGEST_POISSON_RATIO, solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.solvers.solve import factorise
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.parts.part import Section
from alula.loads.records.bearing import WIDE
from alula.reports.sentences import told


def pulled(nu, **options):
    """Bar pulled between its pins."""

    def pin(name, x, force):
        wrench = np.array([force, 0.0, 0.0, 0.0, 0.0, 0.0])
        return PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=wrench)

    loads = LinkLoads(name="pull", pins=(pin("A", 0.0, -10.0), pin("B", 20.0, 10.0)))
    return solve_solid(
        bar(),
        E=2900.0,
        nu=nu,
        density=1e-9,
        loads=[loads],
        line=("bore:A", "bore:B"),
        laws=(WIDE,),
        threads=1,
        **options,
    )


def test_poisson_ratio_is_refused_beyond_its_boundary():
    for nu, noted in ((0.38, False), (0.495, True), (LARGEST_POISSON_RATIO, True)):
        found = pulled(nu)
        assert any("Poisson" in told(note) for note in found.notes) == noted
    with pytest.raises(CaseError, match=r"poissons_ratio: it is 0\.49995"):
        pulled(0.49995)


def test_two_level_solver_says_that_it_stalls():
    with pytest.raises(CannotRunError, match=r"conjugate gradients|leaves an error|iterations"):
        pulled(LARGEST_POISSON_RATIO, method="two-level")


def bore_displacement(nu, order):
    """Lamé's tube in plane strain, radii 1 and 2: radial displacement of the bore over the exact one."""
    space = displacement_space(ring(1.0, 2.0, 0.5, around=16, radial=4, layers=2), order=order)
    bore = surface_quadrature(space, "bore:A")
    load = bore.load_vector(-10.0 * bore.normals, len(space.nodes))
    # Both ends stay in their planes; rigid motions in the plane are held by three unknowns.
    ends = np.flatnonzero(np.abs(np.abs(space.nodes[:, 2]) - 0.25) < 1e-9)
    on = [int(np.argmin(np.linalg.norm(space.nodes - p, axis=1))) for p in ([2.0, 0.0, 0.25], [-2.0, 0.0, 0.25])]
    fixed = np.unique([*(3 * ends + 2), 3 * on[0] + 1, 3 * on[1] + 1, 3 * on[0]])
    load[fixed] = 0.0
    K = assemble_stiffness(space, E=2900.0, nu=nu).with_fixed(fixed)
    U = factorise(K, threads=1).solve(load).reshape(-1, 3)
    radius = np.hypot(*space.nodes[:, :2].T)
    inner = np.abs(radius - 1.0) < 1e-8
    direction = space.nodes[inner, :2] / radius[inner, None]
    moved = (direction * (U[inner, :2] - (U[on[0], :2] + U[on[1], :2]) / 2.0)).sum(axis=1).mean()
    return moved / ((1.0 + nu) * 10.0 / (3.0 * 2900.0) * (5.0 - 2.0 * nu))


def test_linear_elements_lock_and_quadratic_ones_are_bounded():
    assert bore_displacement(0.3, 1) == pytest.approx(1.0, abs=0.07)
    assert bore_displacement(0.4999, 1) < 0.85
    for nu in (0.3, 0.45, 0.49):
        assert bore_displacement(nu, 2) == pytest.approx(1.0, abs=2e-3)
    assert bore_displacement(LARGEST_POISSON_RATIO, 2) == pytest.approx(1.0, abs=0.035)


def sliver(height):
    """Box beside a hole, one inner node moved until an element has that share of its height."""
    mesh = box((1.2, 0.0, 0.0), (2.2, 1.0, 1.0), (3, 3, 3))
    inner = int(np.argmin(np.linalg.norm(mesh.points - [1.2 + 1 / 3, 1 / 3, 1 / 3], axis=1)))
    cell = mesh.cells[(mesh.cells == inner).any(axis=1)][0]
    a, b, c = mesh.points[cell[cell != inner]]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    mesh.points[inner] -= (1.0 - height) * ((mesh.points[inner] - a) @ normal) * normal
    return mesh


@pytest.mark.parametrize("height", [1.0, 1e-4, 1e-8])
def test_sliver_changes_neither_answer_nor_estimate(height):
    reference = estimate(sliver(1e-2))
    assert estimate(sliver(height)) == pytest.approx(reference, rel=0.15)


def estimate(mesh):
    space, U = solved(mesh, kirsch)
    return estimate_error(stress_field(space, U, E=2900.0, nu=NU), U, E=2900.0, nu=NU).relative


def test_flat_element_is_refused():
    with pytest.raises(CannotRunError, match="flat"):
        displacement_space(sliver(1e-13))


def flexure(ratio):
    """Energy error of the solver for a tube ``ratio`` times as long as wide, bent by a moment."""
    length = 2.0 * ratio
    space = displacement_space(ring(0.5, 1.0, length, around=12, radial=1, layers=40))
    ends = surface_quadrature(space, "top:A", "bottom:A")
    traction = np.zeros_like(ends.x)
    traction[..., 2] = ends.x[..., 0] * ends.normals[..., 2]
    load = ends.load_vector(traction, len(space.nodes))
    fixed = isostatic_supports(space.nodes, space.corners)
    load[fixed] = 0.0
    return factorise(assemble_stiffness(space, E=2900.0, nu=NU).with_fixed(fixed), threads=1).solved(load).error


def test_slenderness_beyond_rounding_is_refused():
    assert flexure(100.0) < 1e-6
    with pytest.raises(CannotRunError, match="slenderness"):
        flexure(30_000.0)


@pytest.mark.parametrize("ratio", [2, 10, 100, 1000])
@pytest.mark.parametrize("wall", [0.5, 0.1, 0.01])
def test_frame_is_timoshenkos_beam(ratio, wall):
    inner, length, nu = 1.0 - wall, 2.0 * ratio, 0.38
    second = np.pi / 4.0 * (1.0 - inner**4)
    section = Section(
        area=np.pi * (1.0 - inner**2), i_y=second, i_z=second, torsion=2.0 * second, half_y=1.0, half_z=1.0, round=True,
        radius_ratio=inner,
    )  # fmt: skip
    model = FrameModel(
        nodes=np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]]),
        elements=(FrameElement(nodes=(0, 1), section=section, young=2900.0, poisson=nu),),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=1, wrench=np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])),),
    )
    shear = 2900.0 / (2.0 * (1.0 + nu)) * section.area * section.shear_coefficient(nu)
    exact = length**3 / (3.0 * 2900.0 * second) + length / shear
    assert solve_frame(model).displacements[1, 1] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 1e3, 1e6])
def test_frame_of_two_materials(ratio):
    section = Section(area=8.0, i_y=2.0, i_z=3.0, torsion=4.0, half_y=1.0, half_z=1.0, round=False)
    model = FrameModel(
        nodes=np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [200.0, 0.0, 0.0]]),
        elements=tuple(
            FrameElement(nodes=(i, i + 1), section=section, young=young, poisson=0.3)
            for i, young in enumerate((2900.0, 2900.0 * ratio))
        ),
        supports=(Support(node=0), Support(node=2)),
        loads=(NodeLoad(node=1, wrench=np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])),),
    )
    found = solve_frame(model)
    assert -found.reactions[0, 0] == pytest.approx(1.0 / (1.0 + ratio), rel=1e-10)
    assert found.residual < 1e-14


def test_a_tube_of_a_thousand_diameters_is_refused_where_it_is_too_fine(tmp_path):
    path = tmp_path / "tube.toml"
    path.write_text(slender_tube.text(1000, solid="mesh_size = 0.1"))
    begun = time.monotonic()
    done = programs.inside("check", str(path), "--fidelity", "solid")
    assert done.returncode == 4
    assert "the mesh would have about" in done.stderr
    assert "increase solid.mesh_size" in done.stderr
    assert time.monotonic() - begun < 60.0


@pytest.mark.parametrize("ratio", [100, 1000])
@pytest.mark.converged
def test_a_slender_tube_through_the_whole_program(ratio):
    case = slender_tube.case(ratio)
    material, section = case.material_of("tube"), case.parts["tube"].section
    by_hand, found = (
        check_case(case, fidelity=fidelity, threads=1).load_cases["tip"].links["tube"] for fidelity in ("beam", "solid")
    )
    exact = slender_tube.tip_deflection(ratio, material.youngs_modulus, section.i_z)
    # The eyes bend less than the tube: a few diameters of its length.
    assert found.displacement_max.value == pytest.approx(exact, rel=max(5.0 / ratio, 5e-3))
    assert by_hand.displacement_max.low < exact < by_hand.displacement_max.high


def test_poissons_ratio_beyond_the_boundary_is_refused_before_anything_is_meshed(monkeypatch):
    monkeypatch.setattr("alula.fea.refine.refinement.mesh_body", lambda *a, **k: pytest.fail("meshed"))
    monkeypatch.setattr("alula.fea.solid.solution.LARGEST_POISSON_RATIO", 0.3)
    with pytest.raises(CaseError, match=r"poissons_ratio: it is 0\.38"):
        check_case(arm_case.arm(), fidelity="solid")
