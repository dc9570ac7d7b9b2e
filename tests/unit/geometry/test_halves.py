"""Bodies that are symmetric about z = 0 are meshed as their upper half and its image; others as a whole."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from lopsided_part import Lopsided
from mesh_measures import volumes_and_moments

from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.disc import Disc
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube

WHOLE = dataclasses.replace(COARSE, halves=False)


def row(along: str, x: float) -> HoleRow:
    span = {"first": f"{x} mm", "last": f"{x + 3.0} mm"}
    return HoleRow.model_validate({"count": 2, "diameter": "1 mm", "along": along} | span)


def tube(**changes: str) -> Tube:
    sizes = {"outer_diameter": "5 mm", "inner_diameter": "2.5 mm", "fillet_radius": "0.8 mm"}
    return Tube.model_validate({"shape": "tube", "material": "m"} | sizes | changes)


def bar(**changes: str) -> Bar:
    sizes = {"width": "5 mm", "thickness": "3 mm", "fillet_radius": "0.5 mm"}
    return Bar.model_validate({"shape": "bar", "material": "m"} | sizes | changes)


A, B, END = Pin(name="A", x=0.0, y=0.0, diameter=2.0), Pin(name="B", x=40.0, y=0.0, diameter=2.0), 4.0
H = PlainEnd(name="H", x=40.0, patch=END)
BODIES = {
    "tube with holes across and a plain end": Body(part=tube(), pins=(A,), ends=(H,), holes=(row("y", 20.0),)),
    "rod with holes along the pins": Body(
        part=tube(inner_diameter="0 mm"), pins=(A, B), ends=(), holes=(row("z", 15.0),)
    ),
    "bar with a slot": Body(
        part=bar(), pins=(A, Pin(name="S", x=20.0, y=0.0, diameter=2.0, slot=6.0), B), ends=(), holes=()
    ),
    "bar with thick eyes and an arm": Body(
        part=bar(eye_thickness="5 mm"),
        pins=(A, B, Pin(name="Q", x=8.0, y=15.0, diameter=2.0, foot=(0.0, 0.0))),
        ends=(),
        holes=(),
    ),
    "bar with holes both ways and a plain end": Body(
        part=bar(fillet_radius="0 mm"), pins=(A,), ends=(H,), holes=(row("y", 12.0), row("z", 20.0))
    ),
    "disc": Body(
        part=Disc.model_validate(
            {"shape": "disc", "material": "m", "diameter": "40 mm", "thickness": "3 mm", "eye_diameter": "6 mm"}
        ),
        pins=(A, Pin(name="P", x=12.0, y=3.0, diameter=2.0)),
        ends=(),
        holes=(),
    ),
}


@pytest.mark.parametrize("name", BODIES)
def test_half_and_image_are_the_body(name: str) -> None:
    mesh, whole = mesh_body(BODIES[name], COARSE), mesh_body(BODIES[name], WHOLE)
    assert whole.mirror is None
    assert mesh.mirror is not None
    assert (mesh.points[mesh.mirror] == mesh.points * (1.0, 1.0, -1.0)).all()
    upper, lower = np.split(mesh.points[mesh.cells[:, :4]].mean(axis=1)[:, 2], 2)
    assert (upper > 0.0).all()
    assert (lower == -upper).all()
    near = np.abs(mesh.points[:, 2]) < 1e-5
    assert (mesh.points[near, 2] == 0.0).all()
    # The kernel's measures of half and whole, which are two solids, and the mesh's own.
    assert mesh.volume == pytest.approx(whole.volume, rel=1e-6)
    assert mesh.centroid == pytest.approx(whole.centroid, abs=1e-4)
    assert mesh.areas == pytest.approx(dict(whole.areas), rel=1e-4)
    volumes, moments = volumes_and_moments(mesh.points, mesh.cells)
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(whole.volume, rel=COARSE.chord_error)
    assert moments.sum(axis=0)[:2] / volumes.sum() == pytest.approx(whole.centroid[:2], abs=0.02)
    for surface in whole.surfaces:
        assert extent_of(mesh, surface) == pytest.approx(extent_of(whole, surface), abs=1e-4), surface
    assert 0.7 < len(mesh.cells) / len(whole.cells) < 1.5


def extent_of(mesh: TaggedMesh, surface: str) -> np.ndarray:
    at = mesh.points[np.unique(mesh.surfaces[surface])]
    lengths = np.concatenate([at.min(axis=0), at.max(axis=0)])
    # A coarse circle has no node at its far sides, so that these are seen along z alone.
    return lengths[[2, 5]] if surface.startswith("bore") else lengths


@pytest.mark.parametrize(("height", "symmetric"), [(0.0, True), (0.3, False), (0.002, False)])
def test_a_body_that_is_not_symmetric_is_meshed_whole(
    height: float, symmetric: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).resolve().parents[2]))  # the child finds the class there
    sizes = {"width": "6 mm", "thickness": "4 mm", "overhang": "3 mm", "bore": "1 mm", "height": f"{height} mm"}
    part = Lopsided.model_validate({"shape": "strip", "material": "m"} | sizes)
    mesh = mesh_body(Body(part=part, pins=(A, B), ends=(), holes=()), COARSE)
    assert (mesh.mirror is not None) == symmetric
    straight = 4.0 * (6.0 * 46.0 - 2.0 * math.pi) - math.pi / 4.0 * 6.0
    assert mesh.volume == pytest.approx(straight, rel=1e-6)
    assert mesh.centroid[2] == pytest.approx(-height * math.pi / 4.0 * 6.0 / straight, abs=1e-9)


def test_a_half_has_the_smaller_sizes_of_both_sides() -> None:
    grid = np.array([[x, y, z] for x in (-10.0, 20.0, 50.0) for y in (-9.0, 9.0) for z in (-9.0, 9.0)])
    below = np.where((grid[:, 0] == 20.0) & (grid[:, 2] < 0.0), 0.4, 2.0)
    both = np.where(grid[:, 0] == 20.0, 0.4, 2.0)
    body = Body(part=bar(), pins=(A, B), ends=(), holes=())
    counts = [
        len(mesh_body(body, dataclasses.replace(COARSE, size_points=grid, size_values=sizes)).cells)
        for sizes in (below, both)
    ]
    assert counts[0] == counts[1]
