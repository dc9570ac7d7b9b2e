"""What is kept of a mesh is the same from its upper half as from the whole, where the load is symmetric."""

import dataclasses

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.refine import level
from alula.fea.refine.level import level_of
from alula.fea.refine.link_series import Eye, precision
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.meshing.mirror import mirrored

MATERIAL = {"E": 2900.0, "nu": 0.38, "density": 1.2e-9, "line": ("bore:A", "bore:B"), "threads": 1}


def loads(*wrench):
    """A pin at B that pushes so, borne by a pin at A and a torque."""
    push = np.array([*wrench, 0.0, 0.0, 0.0])
    turn = -np.cross([20.0, 0.0, 0.0], push[:3])
    held = np.concatenate([-push[:3], [turn[0], turn[1], 0.0]])
    pins = tuple(
        PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=w)
        for name, x, w in (("A", 0.0, held), ("B", 20.0, push))
    )
    couples = (DriveCouple(pin="A", torque=float(turn[2])),) if turn[2] else ()
    return LinkLoads(name="load", pins=pins, couples=couples)


@pytest.fixture(scope="module")
def solutions():
    """In the plane and out of it, on a mesh of two halves."""
    mesh = mirrored(solid_meshes.half_bar(tail=4.0, layers=1))
    return [solve_solid(mesh, loads=[loads(*push)], **MATERIAL) for push in ((1.0, 2.0, 0.0), (1.0, 2.0, 0.3))]


def test_the_half_tells_what_the_whole_does(solutions):
    solution = solutions[0]
    assert all(case.symmetric for case in solution.cases)
    whole = dataclasses.replace(
        solution, cases=tuple(dataclasses.replace(case, symmetric=False) for case in solution.cases)
    )
    ours, theirs = (level_of(s, 300.0) for s in (solution, whole))
    assert ours.chord == pytest.approx(theirs.chord, rel=1e-12)
    np.testing.assert_allclose(ours.volumes, theirs.volumes, rtol=1e-12)
    for one, other in zip(ours.figures, theirs.figures, strict=True):
        size = other.von_mises.max()
        assert np.abs(one.von_mises - other.von_mises).max() < 1e-9 * size
        assert np.abs(one.principal - other.principal).max() < 1e-7 * size
        assert np.abs(one.estimate.stress - other.estimate.stress).max() < 1e-9 * size
        assert np.abs(one.estimate.energy - other.estimate.energy).max() < 1e-9 * other.estimate.energy_norm
        assert one.estimate.energy_norm == pytest.approx(other.estimate.energy_norm, rel=1e-9)
        assert (one.energy, one.displacement, one.span) == (other.energy, other.displacement, other.span)


def test_peaks_of_other_loads_are_sought_in_both_halves(solutions, monkeypatch):
    solution = solutions[1]
    assert not any(case.symmetric for case in solution.cases)
    found = level_of(solution, 300.0)
    case, figures = solution.cases[0], found.figures[0]
    stress = stress_field(solution.space, case.displacement, E=solution.E, nu=solution.nu)
    assert figures.von_mises.max() == pytest.approx(stress.von_mises.max(), rel=1e-12)
    assert figures.principal.max() == pytest.approx(stress.principal[:, 0].max(), rel=1e-7)
    upper = solution.space.nodes[:, 2] >= 0.0
    assert figures.principal[~upper].max() > 1.05 * figures.principal[upper].max() or (
        figures.principal[upper].max() > 1.05 * figures.principal[~upper].max()
    )
    monkeypatch.setattr(level, "upper_half", lambda space: None)
    assert np.array_equal(level_of(solution, 300.0).figures[0].von_mises, figures.von_mises)


def test_layers_of_a_symmetric_case_are_judged_in_both_halves(solutions):
    """Oblique layers are not symmetric: their image has another stress."""
    solution, layers = solutions[0], Layers(normal=(1.0, 0.3, 1.0), across=12.0, between=6.0)
    found = level_of(solution, 300.0, layers)
    for figures, case in zip(found.figures, solution.cases, strict=True):
        nodal = stress_field(solution.space, case.displacement, E=solution.E, nu=solution.nu).nodal
        assert np.abs(figures.layers - layers.stress(nodal)).max() < 1e-9 * figures.von_mises.max()
        upper = solution.space.nodes[:, 2] > 0.0
        assert figures.layers[upper].max() != pytest.approx(figures.layers[~upper].max(), rel=1e-3)
    assert level_of(solution, 300.0).figures[0].layers is None
    weak = level_of(solution, 300.0, Layers(normal=(0.0, 0.0, 1.0), across=12.0, between=1.0))
    [first, *_] = precision([weak], (), section=3.0, eyes=())
    node = int(np.argmax(weak.figures[0].layers))
    beside = weak.figures[0].estimate.stress[(weak.cells == node).any(axis=1)].max()
    chord = 2.0 * weak.chord * first.layers.value
    assert first.layers.estimate == pytest.approx(12.0 / np.sqrt(3.0) * beside + chord)
    everywhere = [Eye(x=0.0, y=0.0, radius=100.0)]
    for one, figures in zip(precision([found], (), section=3.0, eyes=everywhere), found.figures, strict=True):
        contact = 0.94 if figures.span == 90 else 1.0  # it adds up to 6 % to the narrow pressure's
        assert one.high("layers") == pytest.approx(one.layers.high / contact)
