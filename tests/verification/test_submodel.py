"""An eye cut out of a link bears what it bears in the whole link, and what it bears when cut twice as far out."""

from dataclasses import replace

import eye_link
import numpy as np
import pytest

from fea.beam.cut_free import beam_loads
from fea.beam.resultant import resultant
from fea.beam.theory import check_beam
from fea.check.submodel import CLEAR, eye_submodel, hole_submodel
from fea.common.link_loads import BodyLoad, LinkLoads
from fea.refine.refinement import LinkTask
from fea.solid.solution import solve_solid
from fea.solid.stress import stress_field
from geometry.meshing.mesh import MeshSettings, mass_properties, mesh_body
from geometry.parts.part import HoleRow
from loads.records.bearing import WIDE
from loads.states.actions import PartMass

MESH = MeshSettings(size=0.5, bore_elements=24, turn_elements=12, fillet_size=0.4, growth=0.5)


ABOUT_A_HOLE = MeshSettings(size=0.6, bore_elements=8, hole_elements=24, turn_elements=8, fillet_size=1.2, growth=0.7)


def peak(what: LinkTask, low: float, high: float, mesh: MeshSettings = MESH) -> float:
    """Largest von Mises stress between two stations [MPa]."""
    solution = solve_solid(
        mesh_body(what.body, mesh),
        E=what.E,
        nu=what.nu,
        density=what.density,
        loads=what.loads,
        line=what.line,
        laws=(WIDE,),
        threads=1,
    )
    stress = stress_field(solution.space, solution.cases[0].displacement, E=what.E, nu=what.nu)
    x = solution.space.nodes[:, 0]
    return float(stress.von_mises[(x >= low) & (x <= high)].max())


def test_an_eye_cut_out_bears_what_it_does_in_the_link():
    whole = eye_link.task()
    beam = eye_link.beam(whole)
    near, far = (eye_submodel(whole, (beam,), "B", clear=clear) for clear in (CLEAR, 2.0 * CLEAR))
    assert near is not None
    assert far is not None
    assert far.covered[0] < near.covered[0] < 36.0 < near.covered[1] < far.covered[1]
    reference = peak(whole, *near.covered)
    assert peak(near.task, *near.covered) == pytest.approx(reference, rel=0.02)
    assert peak(far.task, *near.covered) == pytest.approx(reference, rel=0.02)


def test_an_eye_under_weight_and_inertia_bears_what_it_does_in_the_link():
    """Borne at both ends, swung about the first: the middle eye, cut on both sides, bends under the link's own mass."""
    whole = eye_link.task()
    solid = mass_properties(whole.body)
    swung = BodyLoad(
        specific_force=np.array([2e6, -9e7, 1e7]), about=np.zeros(3), angular_acceleration=8e5, angular_speed=900.0
    )
    acts = LinkLoads(name="swung", bodies=(swung,))
    force, moment = np.split(resultant(acts, solid, whole.density), 2)
    at_c = np.array([0.0, -moment[2] / 72.0, moment[1] / 72.0])
    wrenches = {"A": np.array([*(-force - at_c), -moment[0], 0.0, 0.0]), "C": np.array([*at_c, 0.0, 0.0, 0.0])}
    loads = replace(acts, pins=tuple(replace(p, wrench=wrenches.get(p.name, np.zeros(6))) for p in whole.loads[0].pins))
    assert resultant(loads, solid, whole.density) == pytest.approx(np.zeros(6), abs=1e-9 * np.abs(moment).max())
    mass = PartMass(
        mass=solid.volume * whole.density, centroid=solid.centroid[:2], inertia=solid.inertia[2, 2] * whole.density
    )
    whole = replace(whole, loads=(loads,))
    beam = check_beam(beam_loads(loads, whole.body, whole.density, mass), whole.body.part.section, 1.0)
    cut = eye_submodel(whole, (beam,), "B")
    assert cut is not None
    own = resultant(cut.task.loads[0], mass_properties(cut.body), whole.density)
    assert own == pytest.approx(np.zeros(6), abs=1e-9 * np.abs(moment).max())
    assert peak(cut.task, *cut.covered) == pytest.approx(peak(whole, *cut.covered), rel=0.02)


@pytest.mark.parametrize("along", ["y", "z"])
def test_a_hole_cut_out_bears_what_it_does_in_the_link(along):
    """A cross hole in mid-span, whose submodel has no eye at all."""
    row = HoleRow(count=1, diameter="1.25 mm", first="27 mm", last="27 mm", along=along)
    whole = eye_link.task(stretch=1.5, holes=(row,))
    beam = eye_link.beam(whole)
    near, far = (hole_submodel(whole, (beam,), 27.0, clear=clear) for clear in (CLEAR, 2.0 * CLEAR))
    assert near is not None
    assert far is not None
    assert (near.body.pins, near.name) == ((), "the hole at x = 27 mm")
    assert far.covered[0] < near.covered[0] < 26.0 < 28.0 < near.covered[1] < far.covered[1]
    reference = peak(whole, *near.covered, ABOUT_A_HOLE)
    assert peak(near.task, *near.covered, ABOUT_A_HOLE) == pytest.approx(reference, rel=0.02)
    assert peak(far.task, *near.covered, ABOUT_A_HOLE) == pytest.approx(reference, rel=0.02)


def test_no_cut_where_there_is_no_room():
    whole = eye_link.task()
    beam = eye_link.beam(whole)
    assert eye_submodel(whole, (beam,), "B", clear=5.0) is None
    row = HoleRow(count=1, diameter="1 mm", first="10 mm", last="10 mm", along="y")
    assert hole_submodel(eye_link.task(holes=(row,)), (beam,), 10.0) is None
