"""A tie whose line of force lies beside its mid-plane bears P/A (1 + 6 e/t) (beam theory, eccentric pull)."""

import numpy as np
import pytest

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import check_beam
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature, surface_quadrature
from alula.fea.elements.space import DisplacementSpace, displacement_space
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.tractions.traction import pin_traction
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.part import Body, Pin
from alula.loads.records.bearing import NARROW, WIDE

PULL, WIDTH, THICK, LENGTH = 12.0, 5.0, 2.5, 50.0
BODY = Body(
    part=Bar.model_validate(
        {"shape": "bar", "material": "any", "width": "5 mm", "thickness": "2.5 mm",
         "eye_diameter": "8 mm", "eye_thickness": "2.5 mm", "fillet_radius": "1 mm"}
    ),
    pins=tuple(Pin(name=name, x=x, y=0.0, diameter=3.0) for name, x in (("A", 0.0), ("B", LENGTH))),
    ends=(),
    holes=(),
)  # fmt: skip


def pulled(aside: float, lifted: float = 0.0) -> LinkLoads:
    """A pull whose line lies ``aside`` off the mid-plane at both eyes, and ``lifted`` more at B than at A.

    What is lifted must be balanced: by thrusts along the pins, which bend the link between them.
    """
    thrust = -PULL * lifted / LENGTH
    wrenches = (
        [-PULL, 0.0, thrust, 0.0, -PULL * (aside - lifted / 2.0), 0.0],
        [PULL, 0.0, -thrust, 0.0, PULL * (aside + lifted / 2.0), 0.0],
    )
    pins = [
        PinLoad(name=pin.name, centre=np.array([pin.x, 0.0, 0.0]), diameter=3.0, wrench=np.array(wrench))
        for pin, wrench in zip(BODY.pins, wrenches, strict=True)
    ]
    return LinkLoads(name=f"{aside:g} {lifted:g}", link="tie", pins=tuple(pins))


@pytest.fixture(scope="module")
def mesh() -> TaggedMesh:
    return mesh_body(BODY, COARSE)


@pytest.fixture(scope="module")
def space(mesh: TaggedMesh) -> DisplacementSpace:
    return displacement_space(mesh)


@pytest.fixture(scope="module")
def bore(space: DisplacementSpace) -> SurfaceQuadrature:
    return surface_quadrature(space, "bore:B")


@pytest.mark.parametrize("aside", [0.5, 1.25, 4.0])
def test_by_hand(aside: float) -> None:
    loads = pulled(aside)
    assert loads.resultant() == pytest.approx(np.zeros(6), abs=1e-12)
    check = check_beam(beam_loads(loads, BODY, 0.0), BODY.part.section, 50.0)
    at = check.stress_at(25.0)
    assert at.axial + at.bending == pytest.approx(PULL / (WIDTH * THICK) * (1.0 + 6.0 * aside / THICK), rel=1e-9)


def test_by_solids_away_from_the_eyes(mesh: TaggedMesh, space: DisplacementSpace) -> None:
    """Within 3 % of beam theory under a couple at both eyes, and under one that thrusts along the pins balance."""
    cases = (pulled(1.25), pulled(4.0), pulled(0.0, 5.0))
    solution = solve_solid(
        mesh,
        E=2400.0,
        nu=0.3,
        density=0.0,
        loads=cases,
        line=("bore:A", "bore:B"),
        laws=(WIDE,),
        transfers=("bore-shear",),
    )
    pull = PULL / (WIDTH * THICK)
    for case, bent in zip(solution.cases, ((1.25, 1.25), (4.0, 4.0), (-1.0, 1.0)), strict=True):
        field = stress_field(solution.space, case.displacement, E=2400.0, nu=0.3)
        for x, aside in zip((15.0, 35.0), bent, strict=True):
            found = field.section(x=x, half_length=2.0, half_y=WIDTH / 2.0, half_z=THICK / 2.0)
            assert found.axial == pytest.approx(pull, rel=0.03)
            assert found.bending_y == pytest.approx(6.0 * pull * aside / THICK, rel=0.03, abs=0.03 * pull)


@pytest.mark.parametrize("law", [WIDE, NARROW])
@pytest.mark.parametrize("share", [0.5, 0.99, 3.0])
def test_force_and_couple_are_one_pressure_that_varies_linearly_along_the_bore(bore, law, share: float) -> None:
    """On one side up to a couple of F t/6; p = p0 (1 + 6 M/(F t) · 2 z/t), with p0 of the force alone."""
    moment = share * PULL * THICK / 6.0
    load = PinLoad(
        name="B", centre=np.array([LENGTH, 0.0, 0.0]), diameter=3.0, wrench=np.array([PULL, 0.0, 0.0, 0.0, moment, 0.0])
    )
    density = pin_traction(bore, load, law)
    assert bore.wrench(density, load.centre) == pytest.approx(load.wrench, abs=1e-9)
    pressure = -(density * bore.normals).sum(axis=-1)
    arm = bore.x - load.centre
    ahead, z = np.arctan2(arm[..., 1], arm[..., 0]), arm[..., 2]
    along = law.peak(force=PULL, diameter=3.0, thickness=THICK) * (1.0 + share * 2.0 * z / THICK)
    wanted = np.abs(along) * law.shape(ahead + np.where(along < 0.0, np.pi, 0.0))
    assert pressure == pytest.approx(wanted, abs=0.04 * wanted.max())
    behind = np.abs(np.remainder(ahead, 2.0 * np.pi) - np.pi) < 0.7
    assert (pressure[behind].max() > 0.1 * wanted.max()) == (share > 1.0)
