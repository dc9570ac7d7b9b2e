"""A round link with eyes, fillets and a plain end, meshed by the geometry kernel, against the beam."""

import numpy as np
import pytest

from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.meshing.mesh import mesh_body
from alula.geometry.meshing.mesh_settings import COARSE
from alula.geometry.parts.part import Body, Pin, PlainEnd, Tube

E, NU, RHO = 2900.0, 0.38, 1.2e-9
FORCE, TIP, SPAN = 0.25, 77.5, 30.0


@pytest.fixture(scope="module")
def tube():
    return Tube(
        shape="tube", material="resin", outer_diameter="5 mm", inner_diameter="2.5 mm", eye_diameter="8 mm",
        eye_thickness="7 mm", fillet_radius="0.5 mm",
    )  # fmt: skip


def pin(name, x, *wrench):
    return PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=np.array(wrench))


@pytest.fixture(scope="module")
def mesh(tube):
    pins = (Pin(name="C", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=SPAN, y=0.0, diameter=1.5))
    return mesh_body(Body(part=tube, pins=pins, ends=(PlainEnd(name="H", x=80.0, patch=5.0),), holes=()), COARSE)


@pytest.fixture(scope="module")
def solution(mesh):
    """Tip load in the plane, carried by both pins; tip load out of the plane, carried by their moments."""
    lever, moment = FORCE * TIP / SPAN, FORCE * TIP / 2.0
    end = np.array([TIP, 0.0, 0.0])
    in_plane = LinkLoads(
        name="in plane",
        pins=(pin("C", 0.0, 0.0, FORCE - lever, 0.0, 0, 0, 0), pin("B", SPAN, 0.0, lever, 0, 0, 0, 0)),
        ends=(EndLoad(name="H", point=end, wrench=np.array([0.0, -FORCE, 0, 0, 0, 0])),),
    )
    across = LinkLoads(
        name="across",
        pins=(pin("C", 0.0, 0.0, 0, -FORCE, 0, moment, 0), pin("B", SPAN, 0.0, 0, 0, 0, moment, 0)),
        ends=(EndLoad(name="H", point=end, wrench=np.array([0.0, 0, FORCE, 0, 0, 0])),),
    )
    return solve_solid(mesh, E=E, nu=NU, density=RHO, loads=[in_plane, across], line=("bore:C", "bore:B"), threads=1)


def test_mesh_has_the_measure_of_the_geometry(mesh, solution):
    assert volume_quadrature(solution.space).measure == pytest.approx(mesh.volume, rel=2e-3)
    for name, area in mesh.areas.items():
        assert surface_quadrature(solution.space, name).measure == pytest.approx(area, rel=2e-3)


def test_sections_agree_with_the_beam_within_three_percent(tube, solution):
    fibre = 2.5 / tube.section.i_z
    largest = FORCE * (TIP - SPAN) * fibre
    stations = {15.0: 15.0 / SPAN * (TIP - SPAN), 45.0: TIP - 45.0, 60.0: TIP - 60.0}
    across = {15.0: TIP / 2.0 - 15.0, 45.0: TIP - 45.0, 60.0: TIP - 60.0}
    for case in solution.cases:
        assert case.reaction < 1e-6
        field = stress_field(solution.space, case.displacement, E=E, nu=NU)
        for x in stations:
            found = field.section(x=x, half_length=2.5, half_y=2.5, half_z=2.5)
            plane = case.load == "in plane"
            hand = FORCE * (stations[x] if plane else across[x]) * fibre
            bending = found.bending_z if plane else -found.bending_y
            assert bending == pytest.approx(hand, abs=0.03 * largest)
            assert abs(found.bending_y if plane else found.bending_z) < 0.01 * largest
            assert abs(found.axial) < 0.01 * largest
            assert found.scatter < 0.05
