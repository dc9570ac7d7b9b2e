"""An eye cut out of a link bears what it bears in the whole link, and what it bears when cut twice as far out."""

import eye_link
import pytest

from fea.refinement import LinkTask
from fea.solid import solve_solid
from fea.stress import stress_field
from fea.submodel import CLEAR, submodel
from geometry.mesh import MeshSettings, mesh_body
from loads.bearing import WIDE

MESH = MeshSettings(size=0.5, bore_elements=24, turn_elements=12, fillet_size=0.4, growth=0.5)


def peak(what: LinkTask, low: float, high: float) -> float:
    """Largest von Mises stress between two stations [MPa]."""
    solution = solve_solid(
        mesh_body(what.body, MESH),
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
    near, far = (submodel(whole, (beam,), "B", clear=clear) for clear in (CLEAR, 2.0 * CLEAR))
    assert near is not None
    assert far is not None
    assert far.covered[0] < near.covered[0] < 36.0 < near.covered[1] < far.covered[1]
    reference = peak(whole, *near.covered)
    assert peak(near.task, *near.covered) == pytest.approx(reference, rel=0.02)
    assert peak(far.task, *near.covered) == pytest.approx(reference, rel=0.02)


def test_no_cut_where_there_is_no_room():
    whole = eye_link.task()
    beam = eye_link.beam(whole)
    assert submodel(whole, (beam,), "B", clear=5.0) is None
