"""Tubes with holes through both walls: bands of links as alula meshes them, against far finer models of two programs.

Pulled by pins: a tube of 8 over 5 mm, 120 N through cross pins of 3 mm, 72 mm apart, pressure a cosine over 180°. The
largest von Mises stress in the bore is 25.95 MPa, the largest axial stress there 25.1. Own eighth model of quadratic
tetrahedra, with the ends 8 mm beyond the pins: 25.60 and 25.74 at 83,133 unknowns, 25.74 and 25.35 at 269,997.

Open hole: stress over that of the whole section (N/A, M D/2I, the hole at the extreme fibre), ν = 0.38. An eighth of a
tube five diameters long by its planes of symmetry, mapped blocks about the hole. Own: quadratic tetrahedra, 306,153 and
147,615 unknowns. CalculiX 2.20: bricks of 20 nodes (C3D20), 71,979 and 77,991 unknowns, stress at the nodes.

    tube, hole     load      von Mises: own, CalculiX    largest principal: own, CalculiX    handbook
    8/5, 3 mm      tension   3.842, 3.846                3.927, 3.929                        4.42
    8/5, 3 mm      bending   3.796, 3.788                3.835, 3.822                        4.24
    8/6, 1.6 mm    tension   3.302, 3.302                3.397, 3.402                        3.47
    8/6, 1.6 mm    bending   3.099, 3.086                3.149, 3.137                        3.18

The handbook (``alula.fea.beam.holes``) has fits to photoelastic tests, of large holes up to some 10 % high.
"""

import math

import numpy as np
import pytest

from alula.fea.beam.holes import tube_hole_factors
from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.refine.refinement import START, Effort, LinkTask, refine_links
from alula.fea.solid.stress import stress_field
from alula.geometry.parts.part import Body, HoleRow, Pin, Tube

NU, TRUST = 0.38, 0.005
"""The truths may be off by this share, as the two programs differ."""
OPEN = {
    (5.0, 3.0): {"pull": (3.844, 3.928), "bend": (3.792, 3.829)},
    (6.0, 1.6): {"pull": (3.302, 3.400), "bend": (3.093, 3.143)},
}
"""Bore and hole of a tube of 8 mm, load: von Mises and largest principal stress over the section's."""


def tube(inner, **sizes):
    return Tube.model_validate(
        {"shape": "tube", "material": "pvc", "outer_diameter": "8 mm", "inner_diameter": f"{inner} mm"} | sizes
    )


def pins(length, diameter):
    return tuple(Pin(name=name, x=x, y=0.0, diameter=diameter) for name, x in (("A", 0.0), ("B", length)))


def pull(body, force):
    """Both pins pulled outwards along the tube."""
    return tuple(
        PinLoad(
            name=pin.name,
            centre=np.array([pin.x, 0.0, 0.0]),
            diameter=pin.diameter,
            wrench=np.array([sign * force, 0.0, 0.0, 0.0, 0.0, 0.0]),
        )
        for pin, sign in zip(body.pins, (-1.0, 1.0), strict=True)
    )


def refined(body, loads, meshes):
    task = LinkTask(
        body=body,
        loads=loads,
        E=2900.0,
        nu=NU,
        density=1e-9,
        line=("bore:A", "bore:B"),
        brittle=False,
        stress_limits=(),
        displacement_limits=(),
    )
    effort = Effort(accuracy=0.02, stated=True, max_unknowns=60_000, time_limit=1e9, max_meshes=meshes)
    return refine_links({"tube": task}, START, effort, threads=1)["tube"]


def holds(series, truth):
    return series.low <= (1.0 + TRUST) * truth and series.high >= (1.0 - TRUST) * truth


@pytest.fixture(scope="module")
def pulled():
    body = Body(part=tube(5.0, eyes="none"), pins=pins(72.0, 3.0), ends=(), holes=())
    return refined(body, (LinkLoads(name="pull", pins=pull(body, 120.0)),), 3)


def test_tube_pulled_by_cross_pins(pulled):
    wide = pulled.precision[0].von_mises
    assert holds(wide, 25.95)
    assert (wide.high - wide.low) / wide.value < 0.5
    # One over 90° bears more, at the rim ahead of the pin: 28.80 MPa on 83,133 unknowns.
    assert holds(pulled.precision[1].von_mises, 28.80)


def test_axial_stress_beside_a_cross_pin(pulled):
    solved = pulled.solution
    (wide,) = (case for case in solved.cases if case.span == 180)
    field = stress_field(solved.space, wide.displacement, E=solved.E, nu=solved.nu)
    assert field.nodal[np.unique(solved.space.faces("bore:A")), 0].max() == pytest.approx(25.1, rel=0.1)


@pytest.mark.parametrize(("inner", "hole"), [pytest.param(5.0, 3.0, marks=pytest.mark.converged), (6.0, 1.6)])
def test_open_cross_holes(inner, hole):
    row = HoleRow(count=1, diameter=f"{hole} mm", first="24 mm", last="24 mm", along="y")
    eyes = {"fillet_radius": "2 mm", "eye_diameter": "16 mm", "eye_thickness": "14 mm"}
    body = Body(part=tube(inner, **eyes), pins=pins(48.0, 4.0), ends=(), holes=(row,))
    section = body.part.section
    moment = section.i_z / section.half_y  # stresses of 1 MPa
    couples = DriveCouple(pin="A", torque=-moment), DriveCouple(pin="B", torque=moment)
    loads = (
        LinkLoads(name="pull", pins=pull(body, section.area)),
        LinkLoads(name="bend", pins=pull(body, 0.0), couples=couples),
    )
    found = refined(body, loads, 4)
    for name, case in zip(("pull", "bend"), (found.precision[0], found.precision[-1]), strict=True):
        von_mises, principal = OPEN[inner, hole][name]
        assert holds(case.von_mises, von_mises), name
        assert holds(case.principal, principal), name
        assert case.von_mises.index < 0.3


@pytest.mark.parametrize(("inner", "hole"), OPEN)
def test_the_truths_are_near_the_handbooks(inner, hole):
    for name, handbook in zip(("pull", "bend"), tube_hole_factors(8.0, inner, hole), strict=True):
        assert 0.88 < OPEN[inner, hole][name][1] / handbook < 1.0


def test_an_open_hole_is_a_net_section_with_a_threefold_peak():
    for (inner, hole), truth in OPEN.items():
        net = 1.0 - 2.0 * hole * (8.0 - inner) / 2.0 / (math.pi / 4.0 * (64.0 - inner**2))
        assert 2.4 < truth["pull"][1] * net < 3.2
