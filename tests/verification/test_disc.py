"""A crank disc as a solid: a rotating disc with a hole against the closed form, and a driven one in balance."""

import math

import numpy as np
import pytest

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import check_beam
from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.bodies.body import hand_section
from alula.geometry.meshing.mesh import MeshSettings, mass_properties, mesh_body
from alula.geometry.parts.part import Body, Disc, Pin
from alula.loads.records.applied import BodyForce, PartMass
from alula.loads.records.bearing import NARROW

E, NU, RHO, OMEGA, HOLE, RADIUS = 2500.0, 0.38, 1.2e-9, 2000.0, 2.0, 10.0


def disc(thickness: float, *pins: Pin) -> Body:
    part = Disc(
        shape="disc", material="any", diameter=f"{2.0 * RADIUS} mm", thickness=f"{thickness} mm", eye_diameter="3 mm"
    )
    return Body(part=part, pins=pins, ends=(), holes=())


def test_hoop_stress_of_a_rotating_disc_with_a_hole() -> None:
    """Timoshenko & Goodier, Theory of Elasticity, 3rd ed., art. 32: σ = (3+ν)/4 ρω² (b² + (1-ν)/(3+ν) a²) at the hole.

    A second hole of 0.4 mm at 8 mm, which a link needs, leaves the hoop stress a quarter turn from it almost
    alone; its missing mass pulls on the shaft.
    """
    body = disc(0.5, Pin(name="O", x=0.0, y=0.0, diameter=HOLE), Pin(name="A", x=8.0, y=0.0, diameter=0.4))
    mesh = mesh_body(body, MeshSettings(size=1.6, bore_elements=24, turn_elements=24, growth=0.25))
    whole = mass_properties(body)
    pull = -RHO * whole.volume * OMEGA**2 * whole.centroid[0]
    mass = PartMass(mass=RHO * whole.volume, centroid=np.asarray(whole.centroid)[:2])
    spin = BodyForce(link="disc", mass=mass, specific_force=np.zeros(3), angular_speed_squared=OMEGA**2, axes="link")
    shaft = PinLoad(name="O", centre=np.zeros(3), diameter=HOLE, wrench=np.array([pull, 0.0, 0.0, 0.0, 0.0, 0.0]))
    solution = solve_solid(
        mesh, E=E, nu=NU, density=RHO, loads=[LinkLoads(name="spin", pins=(shaft,), inertia=spin)],
        line=("bore:O", "bore:A"), laws=[NARROW], threads=1,
    )  # fmt: skip
    field = stress_field(solution.space, solution.cases[0].displacement, E=E, nu=NU)
    nodes = solution.space.nodes[: len(field.nodal)]
    a, b = HOLE / 2.0, RADIUS
    exact = (3.0 + NU) / 4.0 * RHO * OMEGA**2 * (b**2 + (1.0 - NU) / (3.0 + NU) * a**2)
    for angle in (90.0, 270.0):
        turned = np.array([a * math.cos(math.radians(angle)), a * math.sin(math.radians(angle))])
        near = np.linalg.norm(nodes[:, :2] - turned, axis=1) < 0.1
        assert field.nodal[near, 0].mean() == pytest.approx(exact, rel=0.006)


def test_a_driven_disc_balances_and_its_hand_calculation_is_its_net_section() -> None:
    """A torque at the shaft against a force on the crank pin: M = F (r - x) between them, on the least net chord."""
    body = disc(2.0, Pin(name="O", x=0.0, y=0.0, diameter=1.0), Pin(name="A", x=6.0, y=0.0, diameter=2.0))
    force = np.array([0.0, 3.0, 0.0, 0.0, 0.0, 0.0])
    loads = LinkLoads(
        name="driven",
        pins=(
            PinLoad(name="O", centre=np.zeros(3), diameter=1.0, wrench=-force),
            PinLoad(name="A", centre=np.array([6.0, 0.0, 0.0]), diameter=2.0, wrench=force),
        ),
        couples=(DriveCouple(pin="O", torque=-18.0),),
    )
    mesh = mesh_body(body, MeshSettings().scaled(1.5))
    solution = solve_solid(mesh, E=E, nu=NU, density=RHO, loads=[loads], line=("bore:O", "bore:A"), threads=1)
    assert len(solution.cases) == 4
    assert max(case.imbalance for case in solution.cases) < 1e-9
    assert max(case.reaction for case in solution.cases) < 1e-6
    section = hand_section(body)
    beam = check_beam(beam_loads(loads, body, RHO), section, 1.0)
    assert section.half_y == pytest.approx(math.sqrt(RADIUS**2 - 36.0) - 1.0, rel=1e-3)
    assert beam.worst.bending == pytest.approx(18.0 * section.half_y / section.i_z)
