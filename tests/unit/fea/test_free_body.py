"""A body solved by halves moves as the same mesh solved as a whole does, under loads of every symmetry."""

import dataclasses

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.elements.space import displacement_space, upper_half
from alula.fea.elements.supports import half_supports, rigid_motions
from alula.fea.solid import solution
from alula.fea.solid.solution import solve_free, solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mirror import mirrored
from alula.loads.records.applied import BodyForce, PartMass
from alula.loads.records.bearing import NARROW
from alula.reports.sentences import told

E, NU, RHO, L = 2900.0, 0.38, 1.2e-9, 20.0
MATERIAL = {"E": E, "nu": NU, "density": RHO, "line": ("bore:A", "bore:B"), "threads": 1, "laws": (NARROW,)}


def pins(at_a, at_b, slotted=False):
    return tuple(
        PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=np.array(wrench, float), slotted=s)
        for name, x, wrench, s in (("A", 0.0, at_a, False), ("B", L, at_b, slotted))
    )


def heavy(volume, force):
    """A body force along (fx, fy, fz) that an end load and pins of B bear, with what centre of mass the mesh has."""
    measure, centre = volume
    total = measure * RHO * np.asarray(force)
    end = EndLoad(name="T", point=centre, wrench=-np.array([*total, 0.0, 0.0, 0.0]))
    own = BodyForce(
        link="bar", mass=PartMass(mass=measure * RHO, centroid=centre[:2]), specific_force=np.array(force), axes="link"
    )
    return LinkLoads(name="heavy", ends=(end,), inertia=own)


@pytest.fixture(scope="module")
def mesh():
    return mirrored(solid_meshes.half_bar(tail=4.0, layers=1))


@pytest.fixture(scope="module")
def loads(mesh):
    from alula.fea.elements.quadrature import volume_quadrature

    volume = volume_quadrature(displacement_space(mesh))
    measured = (volume.measure, volume.centroid)
    torque = LinkLoads(
        name="in plane",
        pins=pins([1, 2, 0, 0, 0, 0], [-1, -2, 0, 0, 0, 0]),
        couples=(DriveCouple(pin="A", torque=40.0),),
    )
    return {
        "in plane": torque,
        "slot": LinkLoads(name="slot", pins=pins([0, 2, 0, 0, 0, 40], [0, -2, 0, 0, 0, 0], slotted=True)),
        "tilt": LinkLoads(name="tilt", pins=pins([0, 0, 0, 3, -2, 0], [0, 0, 0, -3, 2, 0])),
        "twist": LinkLoads(name="twist", pins=pins([0, 0, 0, 3, 0, 0], [0, 0, 0, -3, 0, 0])),
        "thrust": LinkLoads(name="thrust", pins=pins([0, 0, 0.5, 0, -0.5 * L, 0], [0, 0, -0.5, 0, 0, 0])),
        "all": LinkLoads(name="all", pins=pins([1, 0, 0.5, 3, -0.5 * L - 2.0, 0], [-1, 0, -0.5, -3, 2, 0])),
        "weight across": heavy(measured, [0.0, 0.0, -9810.0]),
        "weight": heavy(measured, [0.0, -9810.0, 5000.0]),
    }


@pytest.fixture(scope="module")
def both(mesh, loads):
    """By halves, and as a whole."""
    whole = dataclasses.replace(mesh, mirror=None)
    return tuple(solve_solid(m, loads=list(loads.values()), **MATERIAL) for m in (mesh, whole))


NAMES = ("in plane", "in plane", "slot", "slot", "tilt", "twist", "thrust", "all", "heavy", "heavy")


def test_displacements_stresses_and_energies_are_those_of_the_whole(both):
    halves, whole = both
    assert tuple(case.load for case in halves.cases) == NAMES
    for one, other in zip(halves.cases, whole.cases, strict=True):
        assert np.abs(one.displacement - other.displacement).max() < 1e-8 * other.displacement_max
        assert one.strain_energy == pytest.approx(other.strain_energy, rel=1e-9)
        ours, theirs = (stress_field(halves.space, c.displacement, E=E, nu=NU) for c in (one, other))
        assert np.abs(ours.nodal - theirs.nodal).max() < 1e-8 * np.abs(theirs.nodal).max()
        assert one.reaction < 1e-8
        assert one.imbalance == other.imbalance
    assert told(halves.solver_reason).startswith("half the body, ")


def test_only_the_parts_that_carry_load_are_solved(mesh, loads, both, monkeypatch):
    # A push along the plane is its own image, weight across it minus its image; a tilted pin only pushes: neither.
    assert [case.symmetric for case in both[0].cases] == [True] * 4 + [False] * 6
    assert not any(case.symmetric for case in both[1].cases)
    solved = []
    factorise = solution.factorise
    monkeypatch.setattr(solution, "factorise", lambda K, **options: solved.append(K.size) or factorise(K, **options))
    half = upper_half(displacement_space(mesh))
    for names, systems in (("in plane",), 1), (("weight across",), 1), (("in plane", "slot"), 1), (("tilt",), 2):
        solved.clear()
        solve_solid(mesh, loads=[loads[name] for name in names], **MATERIAL)
        assert solved == [half.space.unknowns] * systems, names


def test_parts_of_a_load_add_up_and_have_their_symmetry(mesh):
    space = displacement_space(mesh)
    half = upper_half(space)
    F = np.random.default_rng(3).normal(size=(len(space.nodes), 3, 2))
    symmetric, antisymmetric = half.parts(F)
    assert half.whole(symmetric, antisymmetric) == pytest.approx(F, abs=1e-15)
    nothing = np.zeros_like(symmetric)
    for part, sign in (half.whole(symmetric, nothing), 1.0), (half.whole(nothing, antisymmetric), -1.0):
        assert part[space.mirror] * np.array([1.0, 1.0, -1.0])[:, None] == pytest.approx(sign * part, abs=1e-15)


def test_the_reactions_of_both_halves_balance_what_the_loads_leave(mesh):
    # Loads that do not balance, against the six equations of the whole: reactions of a half count for both.
    space = displacement_space(mesh)
    half = upper_half(space)
    F = np.zeros((space.unknowns, 2))
    F[[0, 4, 8], [0, 0, 1]] = [1.0, -0.5, 2.0]
    free = solve_free(space, F, E=E, nu=NU, threads=1)
    supports = np.concatenate(half_supports(half.space.nodes, half.space.corners))
    shares = np.where(half.on_plane[supports // 3], 1.0, 0.5)[:, None] * free.reactions  # off the plane, at both images
    fields = np.zeros((2, 3 * len(half.nodes), 2))
    fields[0, supports[:3]], fields[1, supports[3:]] = shares[:3], shares[3:]
    borne = half.whole(*fields.reshape(2, -1, 3, 2)).reshape(-1, 2)
    motions = rigid_motions(space.nodes, np.zeros(3)).reshape(6, -1)
    assert motions @ (F + borne) == pytest.approx(np.zeros((6, 2)), abs=1e-8)


@pytest.mark.parametrize("share", [1e-9, 1e-11])
def test_a_small_part_is_not_lost(mesh, share):
    # Out of the plane by 1e-9 and less of the load in it: the answer is still the sum of both.
    half = upper_half(displacement_space(mesh))
    space = displacement_space(mesh)
    motions = rigid_motions(space.nodes, space.nodes.mean(axis=0)).reshape(6, -1)
    free = np.random.default_rng(5).normal(size=(space.unknowns, 1))
    free -= motions.T @ np.linalg.solve(motions @ motions.T, motions @ free)
    large, small = half.parts(free.reshape(-1, 3, 1))
    nothing = np.zeros_like(large)
    large, small = half.whole(large, nothing).reshape(-1, 1), half.whole(nothing, small).reshape(-1, 1)
    together = solve_free(space, np.hstack([large, small, large + share * small]), E=E, nu=NU, threads=1)
    u = together.displacement.T
    assert together.symmetric.tolist() == [True, False, False]
    lost = u[2] - u[0] - share * u[1]
    assert np.abs(lost).max() < 1e-5 * share * np.abs(u[1]).max()


def test_what_the_plane_leaves_free_is_held():
    space = upper_half(displacement_space(mirrored(solid_meshes.half_bar(layers=1)))).space
    for angle in (0.0, 30.0, 90.0, 135.0):
        turn = np.radians(angle)
        about_z = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        nodes = space.nodes @ about_z.T
        long, wide = 25.0, 5.0  # a lever along the bar, and the area of three points far apart
        for supports, free, least in zip(
            half_supports(nodes, space.corners), ((0, 1, 5), (2, 3, 4)), (0.7 * long, 0.7 * long * wide), strict=True
        ):
            moved = rigid_motions(nodes, nodes.mean(axis=0)).reshape(6, -1)[list(free)][:, supports]
            assert abs(np.linalg.det(moved)) > least


def test_a_half_as_thin_as_a_wire_is_refused():
    nodes = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 1]])
    with pytest.raises(CannotRunError, match="rigid-body motion free"):
        half_supports(nodes, 4)
