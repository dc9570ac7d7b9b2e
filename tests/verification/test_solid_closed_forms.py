"""Links and simple bodies against closed forms, through the whole of ``solve_solid``."""

import math

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.elements.quadrature import volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.parts.part import Tube
from alula.loads.records.applied import BodyForce, PartMass
from alula.loads.records.bearing import WIDE

E, NU = 2900.0, 0.38


def tube_energy(around, radial, layers, *, curved, order=2):
    """Strain energy of a tube along z, 5 over 2.5 mm, 88 mm long, under 1 N at the tip; and unknowns."""
    length = 88.0
    mesh = solid_meshes.ring(1.25, 2.5, length, around=around, radial=radial, layers=layers, curved=curved)
    mesh = renamed(mesh, {"bottom:A": "end:root", "top:A": "end:tip"})
    root, tip = np.array([0.0, 0.0, -length / 2.0]), np.array([0.0, 0.0, length / 2.0])
    loads = LinkLoads(
        name="cantilever",
        ends=(
            EndLoad(name="tip", point=tip, wrench=np.array([0.0, -1.0, 0, 0, 0, 0])),
            EndLoad(name="root", point=root, wrench=np.array([0.0, 1.0, 0, -length, 0, 0])),
        ),
    )
    solution = solve_solid(
        mesh,
        E=E,
        nu=NU,
        density=1e-9,
        loads=[loads],
        line=("end:root", "end:tip"),
        laws=(WIDE,),
        order=order,
        threads=1,
    )
    return solution.cases[0].strain_energy, solution.space.unknowns


def renamed(mesh, names):
    """Return the mesh with surfaces of other names."""
    from dataclasses import replace

    surfaces = {names.get(k, k): v for k, v in mesh.surfaces.items()}
    return replace(mesh, surfaces=surfaces, areas=dict.fromkeys(surfaces, 0.0))


def timoshenko():
    """Tip deflection PL³/3EI + PL/κGA [mm] of that cantilever, κ after Cowper (1966): 2.732449 mm."""
    tube = Tube(shape="tube", material="resin", outer_diameter="5 mm", inner_diameter="2.5 mm", fillet_radius="0.5 mm")
    section = tube.section
    shear = section.shear_coefficient(NU) * E / (2.0 * (1.0 + NU)) * section.area
    return 88.0**3 / (3.0 * E * section.i_z) + 88.0 / shear


def test_cantilever_tube_agrees_with_timoshenko():
    # Clapeyron: the tip deflects by twice the strain energy over the force. The end tractions are not
    # Saint-Venant's, which costs some 1e-3 at 17.6 diameters.
    assert timoshenko() == pytest.approx(2.732449, rel=1e-6)
    energy, unknowns = tube_energy(12, 1, 22, curved=True)
    assert unknowns < 12_000
    assert 2.0 * energy == pytest.approx(timoshenko(), rel=2e-3)


def test_straight_sides_make_a_round_tube_too_soft():
    curved, _ = tube_energy(12, 1, 22, curved=True)
    straight, _ = tube_energy(12, 1, 22, curved=False)
    assert straight > 1.05 * curved  # a polygon of twelve sides has 9 % less second moment


def test_linear_elements_are_too_stiff():
    quadratic, _ = tube_energy(12, 1, 22, curved=False)
    linear, _ = tube_energy(12, 1, 22, curved=False, order=1)
    assert linear < 0.7 * quadratic


def link(*, pins, couples=(), inertia=None):
    return LinkLoads(name="link", pins=pins, couples=couples, inertia=inertia)


def pin(name, x, *force):
    return PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=np.array([*force, 0.0, 0, 0, 0]))


LENGTH, HALF_WIDTH, HEIGHT = 40.0, 2.5, 3.0


@pytest.fixture(scope="module")
def bar():
    return solid_meshes.bar(length=LENGTH, along=14, layers=2, around=16)


def section(bar, loads, x, density=1.2e-9):
    solution = solve_solid(
        bar, E=E, nu=NU, density=density, loads=[loads], line=("bore:A", "bore:B"), laws=(WIDE,),
        transfers=("eye-faces",), threads=1,
    )  # fmt: skip
    field = stress_field(solution.space, solution.cases[0].displacement, E=E, nu=NU)
    return field.section(x=x, half_length=2.5, half_y=HALF_WIDTH, half_z=HEIGHT / 2.0)


def test_tension_between_pins(bar):
    found = section(bar, link(pins=(pin("A", 0.0, -6.0, 0.0), pin("B", LENGTH, 6.0, 0.0))), 20.0)
    assert found.axial == pytest.approx(6.0 / (2.0 * HALF_WIDTH * HEIGHT), rel=3e-3)
    assert abs(found.bending_z) < 5e-3 * found.axial
    assert abs(found.bending_y) < 5e-3 * found.axial


def test_bending_by_the_drive_torque(bar):
    # Force up at B, couple at A: the moment at x is F (L − x), tension on the side y < 0.
    force, x = 2.0, 15.0
    loads = link(
        pins=(pin("A", 0.0, 0.0, -force), pin("B", LENGTH, 0.0, force)),
        couples=(DriveCouple(pin="A", torque=-force * LENGTH),),
    )
    found = section(bar, loads, x)
    moment, modulus = force * (LENGTH - x), HEIGHT * (2.0 * HALF_WIDTH) ** 2 / 6.0
    assert found.bending_z == pytest.approx(-moment / modulus, rel=3e-3)
    assert abs(found.axial) < 3e-3 * abs(found.bending_z)


def test_own_weight_between_two_pins(bar):
    # Simply supported under its own weight w per length, with overhangs of half an eye at both ends.
    rho, g = 1.2e-9, 9.81e7  # heavy gravity, so that stresses are of order one
    area = 2.0 * HALF_WIDTH * HEIGHT
    volume = volume_quadrature(displacement_space(bar)).measure
    up = rho * g * volume / 2.0
    mass = PartMass(mass=rho * volume, centroid=np.array([LENGTH / 2.0, 0.0]))
    loads = link(
        pins=(pin("A", 0.0, 0.0, up), pin("B", LENGTH, 0.0, up)),
        inertia=BodyForce(link="link", mass=mass, specific_force=np.array([0.0, -g, 0.0]), axes="link"),
    )
    found = section(bar, loads, 20.0, rho)
    w, hole = rho * g * area, rho * g * math.pi * 0.75**2 * HEIGHT
    half = LENGTH / 2.0 + HALF_WIDTH
    moment = up * LENGTH / 2.0 - w * half**2 / 2.0 + hole * LENGTH / 2.0
    assert found.bending_z == pytest.approx(-moment / (HEIGHT * (2.0 * HALF_WIDTH) ** 2 / 6.0), rel=5e-3)
