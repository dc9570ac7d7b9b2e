"""Natural frequencies of solids against closed forms and CalculiX: bars, a ring, links on their pins."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from calculix_frequencies import calculix_frequencies
from rocker_case import TOML
from slotted_lever import slotted_lever

from alula.fea.calculix import program as calculix
from alula.fea.elements.mass import consistent_mass
from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import rigid_motions
from alula.fea.tractions.traction import wrench_density
from alula.fea.vibration.link_holding import HeldPlace, LinkHolding, link_holding
from alula.fea.vibration.link_solid import LinkSolid, modes_on, refined_modes
from alula.fea.vibration.mass_matrix import body_mass
from alula.fea.vibration.rigid_regions import RigidRegion
from alula.fea.vibration.solid_modes import CarriedOn, solid_modes
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.carried import CarriedBody, CarriedSpread

E, NU, RHO = 3000.0, 0.3, 1.2e-9
needs_ccx = pytest.mark.skipif(calculix.installed() is None, reason="CalculiX (ccx) is not on PATH")


def hertz(squares):
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi)


def modes(mesh, count, *, nu=NU, **options):
    space = displacement_space(mesh)
    mass = consistent_mass(volume_quadrature(space), RHO, len(space.nodes))
    return space, solid_modes(space, mass, E=E, nu=nu, density=RHO, count=count, **options)


def region(space, name, place, held, inertia=None):
    return RigidRegion(
        name=name,
        nodes=np.unique(space.faces(name)),
        place=np.array(place),
        held=np.eye(6)[list(held)],
        inertia=np.zeros((6, 6)) if inertia is None else inertia,
    )


def bending(beta, length, height):
    """Hz of a slender bar (Euler-Bernoulli: Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1)."""
    return beta**2 / (2.0 * math.pi * length**2) * height * math.sqrt(E / RHO / 12.0)


def test_a_free_bar_has_six_rigid_motions_and_rings_as_beams_and_shafts_do():
    """Shear and rotary inertia take 0.2 % of the first, 0.6 % of the second bending frequency at 60 heights."""
    length, width, height = 60.0, 1.5, 1.0
    box = solid_meshes.box((0.0, -width / 2, -height / 2), (length, width / 2, height / 2), (20, 2, 2))
    _, found = modes(box, 18)
    assert (np.abs(found.squares[:6]) < 1e-8 * found.squares[6]).all()
    f, flat = hertz(found.squares)[6:], found.in_plane[6:]
    across = [value for value, share in zip(f, flat, strict=True) if share < 0.3]
    along = [value for value, share in zip(f, flat, strict=True) if share > 0.9]
    assert across[:2] == pytest.approx([bending(beta, length, height) for beta in (4.73004, 7.85320)], rel=0.01)
    assert along[:2] == pytest.approx([bending(beta, length, width) for beta in (4.73004, 7.85320)], rel=0.01)
    # Roark, 7th ed., table 10.1, case 4: J of a rectangle; twist swings about x, in y and z.
    a, b = width / 2.0, height / 2.0
    J = a * b**3 * (16.0 / 3.0 - 3.36 * b / a * (1.0 - b**4 / (12.0 * a**4)))
    polar = width * height * (width**2 + height**2) / 12.0
    twist = math.sqrt(E / (2.0 * (1.0 + NU)) * J / (RHO * polar)) / (2.0 * length)
    assert 0.0 < min(f / twist - 1.0, key=abs) < 0.03  # two elements across twist too stiffly: three are 1 % off


@pytest.mark.parametrize(("tip", "rigid"), [(0.0, True), (5e-6, True), (5e-6, False)])
def test_a_cantilever_with_a_body_at_its_tip(tip, rigid):
    """Without: β L = 1.87510. With a body of many times its mass: by the flexibility at its centroid."""
    length, width, height, reach = 60.0, 2.0, 1.0, 10.0
    box = solid_meshes.box((0.0, -width / 2, -height / 2), (length, width / 2, height / 2), (30, 1, 1))
    space = displacement_space(box)
    own = body_mass(tip, np.array([reach, 0.0, 0.0]), 0.0)
    regions, bodies = [region(space, "end:0", (0.0, 0.0, 0.0), tuple(range(6)))], []
    if tip and rigid:
        regions.append(region(space, "end:1", (length, 0.0, 0.0), (), own))
    elif tip:
        end, at = surface_quadrature(space, "end:1"), np.array([length, 0.0, 0.0])
        rows = [end.load_vector(wrench_density(end, at, unit), len(space.nodes)) for unit in np.eye(6)]
        bodies.append(CarriedOn(motion=np.array(rows), inertia=own))
    _, found = modes(box, 2, nu=0.0, regions=regions, bodies=bodies)
    expected = []
    for size, other in ((height, width), (width, height)):
        stiff = E * other * size**3 / 12.0
        value = bending(1.87510, length, size)
        if tip:
            # Flexibility of the tip: w, θ under a force on the arm; with the bar's mass as 33/140 of it at the tip.
            sunk = (length**3 / 3.0 + length**2 * reach + length * reach**2) / stiff
            mass = tip + 33.0 / 140.0 * RHO * length * width * height * (length / (length + reach)) ** 3
            value = math.sqrt(1.0 / (mass * sunk)) / (2.0 * math.pi)
        expected.append(value)
    assert hertz(found.squares) == pytest.approx(expected, rel=0.01)
    assert found.in_plane == pytest.approx([0.0, 1.0], abs=0.01)


def test_a_ring_rings_in_its_plane():
    """ω² = n² (n² - 1)²/(n² + 1) E I/(ρ A R⁴), twice for n = 2 (Timoshenko, Vibration Problems, 3rd ed., §69)."""
    inner, outer = 9.5, 10.5
    ring = solid_meshes.ring(inner, outer, 1.0, around=32, radial=1, layers=1)
    _, found = modes(ring, 16)
    f = hertz(found.squares)[6:][found.in_plane[6:] > 0.9]
    radius, ratio = (inner + outer) / 2.0, (outer - inner) ** 2 / 12.0
    expected = math.sqrt(4.0 * 9.0 / 5.0 * E * ratio / RHO) / radius**2 / (2.0 * math.pi)
    assert f[:2] == pytest.approx([expected, expected], rel=0.01)


def rocker():
    case = validate(tomllib.loads(TOML))
    return LinkSolid.of(case, "rocker", link_holding(case, "rocker", case.solve_pose()), ())


def on_pins(*turning, free=0):
    """A bar with bores A and B and a tail, held there; A or B alone, or both, which turn about their pins."""
    places = [
        HeldPlace(point=name, place=np.array([x, 0.0, 0.0]), moves=np.eye(3), turns=np.eye(3)[: 2 if turns else 3])
        for name, x, turns in (("A", 0.0, turning[:1]), ("B", 20.0, turning[1:]))
        if turns
    ]
    points = {"A": (0.0, 0.0), "B": (20.0, 0.0), "T": (31.0, 0.0)}
    holding = LinkHolding(places=tuple(places), free=free, how="")
    return replace(rocker(), holding=holding, points=points)


def bar(**options):
    sizes = {"around": 8, "radial": 2, "along": 4, "layers": 1, "tail": 8.5, "curved": False}
    return displacement_space(solid_meshes.bar(**(sizes | options)))


def test_the_mass_of_a_mesh_is_that_of_the_part_and_its_inertia():
    solid = rocker()
    space = displacement_space(mesh_body(solid.body, COARSE))
    known, density = mass_properties(solid.body), solid.material.density
    mass = consistent_mass(volume_quadrature(space), density, len(space.nodes))
    moved = rigid_motions(space.nodes, known.centroid)
    weighed = np.array([[sum(a[:, i] @ (mass @ b[:, i]) for i in range(3)) for a in moved] for b in moved])
    assert weighed[:3, :3] == pytest.approx(known.volume * density * np.eye(3), rel=1e-3, abs=1e-15)
    assert weighed[3:, 3:] == pytest.approx(known.inertia * density, rel=2e-3, abs=1e-3 * density * known.inertia[2, 2])


def test_frequencies_on_two_meshes_or_one_hold_those_of_a_finer_one(monkeypatch):
    """One alone, as of a part that is a mesh from a file, has the estimate by its recovered stress."""
    solid = rocker()
    bands = [refined_modes(solid, COARSE.scaled(3.0), 2, 1).frequencies]
    monkeypatch.setattr(type(solid.body.part), "is_fixed", True)
    bands.append(refined_modes(solid, COARSE.scaled(3.0), 2, 1).frequencies)
    finer = modes_on(solid, displacement_space(mesh_body(solid.body, COARSE.scaled(1.2))), 2, 1)
    for found in bands:
        for band, value in zip(found, hertz(finer.squares), strict=True):
            assert band.low <= value <= band.high < 1.05 * band.low


HELD = {
    ("owl-wing-static", "AE"): ({"A": (3, 3), "B": (3, 2), "E": (3, 2)}, 0),  # the drive at A
    ("owl-wing-static", "CH"): ({"C": (3, 2), "D": (3, 2)}, 0),
    ("ornithopter", "lever-left"): ({"slot": (1, 1), "L": (3, 2)}, 0),
    ("ornithopter", "rod"): ({"A": (3, 2), "C": (2, 2)}, 0),  # its pin runs in three slots
    ("ornithopter", "crank"): ({"O": (3, 3), "A": (3, 2)}, 0),
}


@pytest.mark.parametrize("name", HELD)
def test_links_are_held_as_their_joints_hold_them(name):
    case = read_case(name[0])
    holding = link_holding(case, name[1], case.solve_pose())
    assert ({p.point: (len(p.moves), len(p.turns)) for p in holding.places}, holding.free) == HELD[name]


def test_a_link_with_a_single_pin_turns_freely_and_rings_as_if_it_did_not():
    """The turn about the pin is left out. Out of the plane it makes no difference, in it the bar rings higher."""
    space, one = bar(), on_pins(True, free=1)
    built_in = replace(
        one, holding=replace(one.holding, free=0, places=(replace(one.holding.places[0], turns=np.eye(3)),))
    )
    loose, held = (modes_on(link, space, 3, 1) for link in (one, built_in))
    assert hertz(loose.squares)[0] == pytest.approx(hertz(held.squares)[0], rel=1e-3)
    assert hertz(loose.squares)[loose.in_plane > 0.9][0] > 2.0 * hertz(held.squares)[held.in_plane > 0.9][0]
    with pytest.raises(CannotRunError, match="its solid has 1 rigid motions, where its joints leave 0"):
        modes_on(replace(one, holding=replace(one.holding, free=0)), space, 2, 1)


def test_what_a_link_carries_lowers_its_frequencies_by_its_mass():
    """Of all bending alike: twice the mass of each length divides them by root 2. A body on a held bore is nothing."""
    space, link = bar(), on_pins(True, True)
    bare = hertz(modes_on(link, space, 2, 1).squares)
    still = CarriedBody.model_construct(link="bar", at="B", mass=1e-5, centroid=None, radius_of_gyration=0.0)
    assert hertz(modes_on(replace(link, carried=(still,)), space, 2, 1).squares) == pytest.approx(bare, rel=1e-6)
    along = CarriedSpread.model_construct(link="bar", start="A", end="T", mass=31.0 * 5.0 * 3.0 * link.material.density)
    laden = hertz(modes_on(replace(link, carried=(along,)), space, 2, 1).squares)
    assert laden == pytest.approx(bare / math.sqrt(2.0), rel=0.01)
    pair = hertz(modes_on(replace(link, carried=(along, along), share=0.5), space, 2, 1).squares)
    assert pair == pytest.approx(laden, rel=1e-6)


@needs_ccx
@pytest.mark.parametrize("held", [(), (True, True)])
def test_calculix_agrees_on_a_free_bar_and_on_one_between_its_pins(held):
    """Straight elements: the mass by CalculiX's four points, or exact, is all that differs."""
    link, space = on_pins(*held, free=0 if held else 6), bar()
    assert hertz(modes_on(link, space, 4, 1).squares) == pytest.approx(calculix_frequencies(link, space, 4), rel=1e-3)


@needs_ccx
@pytest.mark.converged
def test_calculix_agrees_on_a_link_with_a_pin_in_its_slot():
    case = slotted_lever()
    link = LinkSolid.of(case, "lever", link_holding(case, "lever", case.solve_pose()), ())
    space = displacement_space(mesh_body(link.body, replace(COARSE, size=1.0, bore_elements=10, growth=2.0)))
    assert hertz(modes_on(link, space, 3, 1).squares) == pytest.approx(calculix_frequencies(link, space, 3), rel=1e-3)


@needs_ccx
@pytest.mark.converged
def test_calculix_finds_the_frequencies_of_an_owl_wing_tube():
    case = read_case("owl-wing-static")
    solid = LinkSolid.of(case, "GF", link_holding(case, "GF", case.solve_pose()), ())
    space = displacement_space(mesh_body(solid.body, replace(COARSE, size=0.8, bore_elements=10, fillet_size=1.6)))
    ours, theirs = hertz(modes_on(solid, space, 4, 1).squares), calculix_frequencies(solid, space, 4)
    assert ours == pytest.approx(theirs, rel=1e-3)
    # Two meshes of a check, once by ``alula frequencies owl-wing-static --solid`` (docs/verification.md).
    assert ours == pytest.approx([1087.1, 2923.9, 3945.4, 7230.4], rel=0.01)
