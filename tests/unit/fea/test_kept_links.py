"""Links that were solved before are found by all that enters their solutions, and judged anew."""

import copy
import dataclasses
from dataclasses import replace

import eye_link
import numpy as np
import pytest
import solid_meshes
from pydantic import BaseModel

from alula.fea.buckling.solid_holding import SolidHolding
from alula.fea.common.link_loads import DriveCouple, EndLoad
from alula.fea.common.reason import reason
from alula.fea.refine import refinement
from alula.fea.refine.link_task import ElasticLink, LinkTask
from alula.fea.refine.refinement import START, Effort, refine_links
from alula.fea.solid.layers import Layers
from alula.geometry.bodies.seat import Seat
from alula.geometry.keeping.content import digest
from alula.geometry.keeping.kept import keeping
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.parts.part import HoleRow
from alula.loads.records.applied import BodyForce, LineLoad, PartMass

EFFORT = Effort(accuracy=0.01, stated=True, max_meshes=2)
TASK = replace(eye_link.task(limit=3.0), line=("bore:A", "bore:B"))


def pulled(force=1.0, **changes):
    """The task of a bar in tension, with pins where the mesh has them."""
    pins = tuple(
        replace(pin, centre=np.array([x, 0.0, 0.0]), wrench=np.array([f, 0.0, 0.0, 0.0, 0.0, 0.0]))
        for pin, x, f in zip(TASK.loads[0].pins, (0.0, 20.0), (-force, force), strict=False)
    )
    return replace(TASK, loads=(replace(TASK.loads[0], pins=pins),), **changes)


@pytest.fixture
def solved(tmp_path, monkeypatch):
    """Forces of what was solved, on meshes that are there already; it is kept where that is asked for."""
    monkeypatch.setenv("ALULA_CACHE", str(tmp_path))
    mesh = replace(mirrored(solid_meshes.half_bar(layers=1)), volume=250.0)
    monkeypatch.setattr(refinement, "mesh_body", lambda body, settings: mesh)
    monkeypatch.setattr(refinement, "reentrant_edges", lambda body: [])
    found, solve = [], refinement.solve_solid

    def told(mesh, *, loads, **options):
        found.append(float(loads[0].pins[-1].wrench[0]))
        return solve(mesh, loads=loads, **options)

    monkeypatch.setattr(refinement, "solve_solid", told)
    return found


def content(links):
    """All that was found of links but the time that it took."""
    return digest(
        {
            name: replace(one, meshes=tuple(replace(mesh, seconds=0.0) for mesh in one.meshes), kept=False)
            for name, one in links.items()
        }
    )


def test_a_changed_link_alone_is_solved_anew_and_an_undone_change_costs_nothing(solved):
    before, after = ({"one": pulled(1.0), "two": pulled(force)} for force in (2.0, 3.0))
    fresh = [content(refine_links(tasks, START, EFFORT)) for tasks in (before, after, before)]
    assert len(solved) == 12, "two meshes of two links, three times"
    told = []
    for tasks, expected, anew, kept in zip(
        (before, after, before), fresh, ({1.0, 2.0}, {3.0}, set()), ((), ("one",), ("one", "two")), strict=True
    ):
        solved.clear()
        told.clear()
        with keeping():
            found = refine_links(tasks, START, EFFORT, watch=lambda link, one: told.append((link, one is not None)))
        assert set(solved) == anew
        assert content(found) == expected, "to the last bit"
        assert [name for name, one in found.items() if one.kept] == [*kept]
        assert sorted(told) == [("one", False), ("one", True), ("two", False), ("two", True)]


OTHER = [
    *({"effort": replace(EFFORT, **one)} for one in ({"max_meshes": 1}, {"accuracy": 0.5}, {"time_limit": 0.0})),
    *({"task": one} for one in ({"stress_limits": ((1e3, 1e3),)}, {"displacement_error": 1e-9}, {"beyond_peak": True})),
]


@pytest.mark.parametrize("other", OTHER, ids=str)
def test_limits_and_efforts_judge_anew_what_was_solved(solved, other):
    task, effort = pulled(**other.get("task", {})), other.get("effort", replace(EFFORT, stated=False))
    fresh = refine_links({"one": task}, START, effort)
    with keeping():
        refine_links({"one": pulled()}, START, EFFORT)
        solved.clear()
        found = refine_links({"one": task}, START, effort)
    assert content({"one": found["one"]}) == content(fresh)
    assert not solved


def test_what_a_solution_depends_on_is_the_link_and_its_loads():
    """A new entry of a task has to be weighed: does it enter a solution, or only how that is judged?"""
    judging = {"stress_limits", "displacement_limits", "layer_limits", "displacement_error", "holding", "beyond_peak"}
    every = {one.name for one in dataclasses.fields(LinkTask)}
    assert every == {one.name for one in dataclasses.fields(ElasticLink)} | {"loads", "open_ranges"} | judging
    assert {one.name for one in dataclasses.fields(TASK.link)} == {one.name for one in dataclasses.fields(ElasticLink)}


def everything():
    """A task in which all kinds of records stand, its effort and the settings of its mesh."""
    [loads] = TASK.loads
    seat = Seat(young=1.0, pin_young=2.0, diameter=1.5, length=4.0, eye=3.0, clearance=(0.0, 0.1))
    mass = PartMass(mass=1.0, centroid=np.zeros(2), inertia=2.0)
    along = LineLoad(link="link", start=0.0, end=9.0, at_start=np.ones(3), at_end=np.zeros(3))
    weight = BodyForce(
        link="link", mass=mass, specific_force=np.ones(3), angular_acceleration=0.0, angular_speed_squared=1.0
    )
    pins = (replace(loads.pins[0], seat=seat), *loads.pins[1:])
    full = replace(
        loads,
        pins=pins,
        couples=(DriveCouple(pin="A", torque=1.0),),
        ends=(EndLoad(name="P", point=np.zeros(3), wrench=np.ones(6)),),
        lines=(along,),
        inertia=weight,
    )
    task = replace(
        eye_link.task(holes=(HoleRow(diameter="1 mm", first="30 mm", last="40 mm", count=3, along="z"),)),
        loads=(full,),
        layers=Layers(normal=(0.0, 0.0, 1.0), across=10.0, between=None),
        holding=SolidHolding(places={"A": np.zeros(3)}, value=np.eye(2), alone=(), most=None, how=reason("idle_link")),
    )
    return [task, EFFORT, START]


def records(value):
    """Yield all records within a value, and what sets a field of one to something else."""
    if isinstance(value, BaseModel):
        yield value, list(type(value).model_fields)
        inner = [getattr(value, name) for name in type(value).model_fields]
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        yield value, [one.name for one in dataclasses.fields(value)]
        inner = [getattr(value, one.name) for one in dataclasses.fields(value)]
    elif isinstance(value, dict):
        inner = [*value.values()]
    else:
        inner = [*value] if isinstance(value, list | tuple) else []
    for one in inner:
        yield from records(one)


def test_every_field_of_every_record_that_enters_changes_the_key():
    whole = everything()
    before, seen = digest(whole), set()
    for record, names in records(whole):
        for name in names:
            value = vars(record)[name]
            vars(record)[name] = "something else"
            assert digest(whole) != before, f"{type(record).__name__}.{name}"
            vars(record)[name] = value
            seen.add(f"{type(record).__name__}.{name}")
    assert digest(copy.deepcopy(whole)) == before
    kinds = "Body BodyForce DriveCouple Effort EndLoad HoleRow Layers LineLoad LinkLoads LinkTask"
    kinds += " MeshSettings PartMass Pin PinLoad Seat SolidHolding Tube"
    assert {name.partition(".")[0] for name in seen} >= {*kinds.split()}
