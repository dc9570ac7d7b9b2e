"""Which mesh comes next, and when one mesh is enough."""

import dataclasses
import math
import threading
from types import SimpleNamespace

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.refine import refinement
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.convergence import grid_convergence
from alula.fea.refine.discretisation import judged
from alula.fea.refine.link_series import CasePrecision
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import NONE_DECIDES, START, Effort, _Link, refine_links
from alula.fea.refine.target_sizes import MOST_RATIO, SERIES_RATIO, series_ratio
from alula.fea.solid.layers import Layers
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh import ReentrantEdge
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.parts.part import Bar, Body, Pin
from alula.reports.sentences import told

EDGE = ReentrantEdge(points=np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]), angle=1.5 * math.pi)


def test_sizes_fall_so_that_the_next_mesh_reaches_the_accuracy():
    found = grid_convergence((1.0, 0.6, 0.4), [10.0 + 6.0 * size**2 for size in (1.0, 0.6, 0.4)], estimate=0.9)
    assert series_ratio(found, found.index / 1.7**2) == pytest.approx(1.7, rel=1e-6)
    assert series_ratio(found, 1e-6) == MOST_RATIO
    assert series_ratio(found, 1.0) == SERIES_RATIO
    assert series_ratio(grid_convergence([1.0], [10.0], estimate=5.0), 0.01) == MOST_RATIO  # on its way to a third


@pytest.mark.parametrize(("share", "enough"), [(0.2, True), (0.3, False)])
def test_one_mesh_is_not_enough_near_a_sharp_edge_that_may_bear_much(share, enough):
    nodes = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    level = SimpleNamespace(nodes=nodes, figures=[SimpleNamespace(von_mises=np.array([share, 1.0]))])
    link = SimpleNamespace(
        precision=[], edges=[EDGE], levels=[level], task=SimpleNamespace(section=3.0), _limits=lambda: ()
    )
    assert _Link._far(link) is enough


BODY = Body(
    part=Bar(
        shape="bar",
        material="resin",
        width="5 mm",
        thickness="3 mm",
        eye_diameter="5 mm",
        eye_thickness="3 mm",
        fillet_radius="0 mm",
    ),
    pins=(Pin(name="A", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=20.0, y=0.0, diameter=1.5)),
    ends=(),
    holes=(),
)


def pulled(force):
    """A bar in tension whose limits no mesh decides, so that the largest number of meshes ends it."""
    pins = tuple(
        PinLoad(name=p.name, centre=np.array([p.x, 0, 0]), diameter=1.5, wrench=np.array([f, 0, 0, 0, 0, 0]))
        for p, f in zip(BODY.pins, (-force, force), strict=True)
    )
    return LinkTask(
        body=BODY,
        loads=(LinkLoads(name="pull", pins=pins),),
        E=2900.0,
        nu=0.38,
        density=1.2e-9,
        line=("bore:A", "bore:B"),
        brittle=False,
        stress_limits=(),
        displacement_limits=(),
    )


@pytest.fixture
def coarse(monkeypatch):
    """Every mesh is the same coarse one, made at once; nothing is sharp."""
    mesh = dataclasses.replace(mirrored(solid_meshes.half_bar(layers=1)), volume=250.0)
    monkeypatch.setattr(refinement, "mesh_body", lambda body, settings: mesh)
    monkeypatch.setattr(refinement, "reentrant_edges", lambda body: [])


EFFORT = Effort(accuracy=0.01, stated=True, max_meshes=2)


def test_links_are_solved_side_by_side_with_the_same_result(coarse, monkeypatch):
    tasks = {name: pulled(force) for name, force in (("one", 1.0), ("two", 2.0), ("three", 3.0))}
    alone = refine_links(tasks, START, EFFORT)
    met, solve = threading.Barrier(2, timeout=60.0), refinement.solve_solid

    def together(*arguments, **options):
        with lock:
            calls.append(None)
            early = len(calls) <= 2
        if early:
            seen.append(met.wait())
        return solve(*arguments, **options)

    lock, calls, seen = threading.Lock(), [], []
    monkeypatch.setattr(refinement, "solve_solid", together)
    beside = refine_links(tasks, START, EFFORT, threads=2)
    assert sorted(seen) == [0, 1], "two links were never solved at once"
    assert list(beside) == list(tasks)
    for name, found in beside.items():
        assert [m.elements for m in found.meshes] == [m.elements for m in alone[name].meshes]
        assert told(found.stopped) == "the largest number of meshes, 2, is reached"
        assert found.precision[0].von_mises.values == pytest.approx(alone[name].precision[0].von_mises.values, rel=1e-9)


@pytest.mark.parametrize("threads", [None, 2])
def test_a_link_that_fails_ends_the_others_with_its_name(coarse, monkeypatch, threads):
    def failing(mesh, *, loads, **options):
        if loads[0].pins[1].wrench[0] == 2.0:
            raise CannotRunError("its loads do not balance")
        return solve(mesh, loads=loads, **options)

    solve = refinement.solve_solid
    monkeypatch.setattr(refinement, "solve_solid", failing)
    with pytest.raises(CannotRunError, match=r"^two: its loads do not balance$"):
        refine_links({"one": pulled(1.0), "two": pulled(2.0)}, START, EFFORT, threads=threads)
    assert refine_links({}, START, EFFORT, threads=2) == {}


@pytest.mark.parametrize(("limit", "narrow"), [(5.0, True), (0.02, False)])
def test_layers_that_bear_next_to_nothing_need_no_finer_mesh_unless_their_limit_is_near(limit, narrow):
    peak = grid_convergence([1.0, 0.6, 0.4], [10.0, 10.01, 10.012], estimate=0.01)
    nothing = grid_convergence([1.0, 0.6, 0.4], [0.001, 0.0012, 0.0011], estimate=0.01)
    assert peak.index < EFFORT.accuracy < 1.0 < nothing.index
    layers = Layers(normal=(0.0, 1.0, 0.0), across=10.0, between=5.0)
    task = dataclasses.replace(pulled(1.0), layers=layers, layer_limits=((limit, limit),))
    case = CasePrecision(von_mises=peak, principal=peak, displacement=peak, edge=None, sharp=None, unreliable="",
                         in_contact={}, layers=nothing)  # fmt: skip
    link = _Link("bar", task, START, EFFORT)
    assert link._narrow(case) is narrow
    assert not link._narrow(dataclasses.replace(case, von_mises=nothing))


def known(low, high):
    """A case whose stress the meshes leave between two ends."""
    peak = dataclasses.replace(
        grid_convergence([1.0, 0.6, 0.4], [(low + high) / 2.0] * 3, estimate=0.01), low=low, high=high
    )
    return CasePrecision(
        von_mises=peak, principal=peak, displacement=peak, edge=None, sharp=None, unreliable="", in_contact={}
    )


def one_of(bands, ranges, effort=None):
    """A link under one load, solved in as many variants as there are bands."""
    task = dataclasses.replace(pulled(1.0), stress_limits=((10.0, 10.0),), open_ranges=ranges)
    link = _Link("bar", task, START, effort or Effort())
    link.precision = tuple(known(*band) for band in bands)
    link.solution = SimpleNamespace(cases=[SimpleNamespace(load="pull")] * len(bands))
    return link


def by_couples(low, high):
    return {"pull": OpenRanges(limits={"von_mises": ((low, high),)})}


@pytest.mark.parametrize(
    ("bands", "limit", "further"),
    [
        ([(8.0, 12.0)], (10.0, 10.0), True),  # nothing but the mesh leaves it open
        ([(8.0, 12.0)], (9.0, 30.0), True),  # below 9 MPa it passes
        ([(8.0, 12.0)], (2.0, 11.0), True),  # above 11 MPa it fails
        ([(8.0, 12.0)], (7.0, 13.0), False),
        ([(8.0, 12.0), (9.5, 12.0)], (9.0, 13.0), False),  # the other pressure of pins keeps it open
        ([(8.0, 12.0), (8.5, 12.0)], (9.0, 13.0), True),
    ],
)
def test_a_mesh_is_made_finer_only_where_it_may_decide(bands, limit, further):
    link = one_of(bands, by_couples(*limit))
    assert link._ends_open() is not further
    assert bool(link._beyond) is not further


def test_an_accuracy_that_was_asked_for_is_reached_all_the_same():
    assert one_of([(8.0, 12.0)], by_couples(7.0, 13.0), EFFORT)._beyond == frozenset()
    assert one_of([(8.0, 12.0)], {})._beyond == frozenset()


@pytest.mark.parametrize(("ranges", "meshes"), [({}, 2), (by_couples(0.0, 1e6), 1), (by_couples(1e5, 1e6), 2)])
def test_refinement_ends_with_the_first_mesh_where_no_other_decides(coarse, ranges, meshes):
    """Numbers that other causes leave open are told with the reason; a point of the linkage may ask for more."""
    task = dataclasses.replace(pulled(1.0), open_ranges=ranges, stress_limits=((1e-3, 1e3),))
    effort = dataclasses.replace(EFFORT, stated=False)
    [found] = refine_links({"bar": task}, START, effort).values()
    assert len(found.meshes) == meshes
    if meshes > 1:
        return
    assert found.stopped == NONE_DECIDES
    assert "no finer one decides them" in told(judged(found, 0, "von_mises").reason)
    closer = dataclasses.replace(task, displacement_error=1e-9)
    [more] = refine_links({"bar": closer}, START, effort, earlier={"bar": found}).values()
    assert found.may_go_on
    assert len(more.meshes) == 2
