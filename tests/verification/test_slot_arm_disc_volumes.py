"""Slotted bars, bars with arms and discs against closed forms: volume, centroid, inertia, named areas."""

import math
from dataclasses import replace

import numpy as np
import pytest

from alula.geometry.meshing.element_geometry import triangle_areas
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body, reentrant_edges
from alula.geometry.parts.part import Bar, Body, Disc, HoleRow, Pin, PlainEnd

T = 3.0


def bar(fillet: float, eye_thickness: float = T) -> Bar:
    return Bar(
        shape="bar",
        material="resin",
        width="5 mm",
        thickness=f"{T} mm",
        eye_diameter="9 mm",
        eye_thickness=f"{eye_thickness} mm",
        fillet_radius=f"{fillet} mm",
    )


def cap(radius: float, half: float) -> float:
    """Area of a disc outside of the strip |y| < half."""
    return math.pi * radius**2 - 2.0 * (half * math.sqrt(radius**2 - half**2) + radius**2 * math.asin(half / radius))


def slotted(slot: float, fillet: float = 0.0, eye_thickness: float = T) -> Body:
    pins = (
        Pin(name="S", x=10.0, y=0.0, diameter=2.5, slot=slot, clearance=0.5),
        Pin(name="B", x=40.0, y=0.0, diameter=1.5),
    )
    return Body(part=bar(fillet, eye_thickness), pins=pins, ends=(), holes=())


@pytest.mark.parametrize(("slot", "eye"), [(6.0, 3.0), (6.0, 5.0), (0.8, 3.0), (0.8, 5.0)])
def test_volume_of_a_slotted_bar(slot: float, eye: float) -> None:
    """Bar from the slot's first centre to B; eyes of 9 mm, that of the slot drawn out by its length; bored through."""
    length = 40.0 - (10.0 - slot / 2.0)
    ends = 5.0 * length
    strip = 2.5 * math.sqrt(4.5**2 - 2.5**2) + 4.5**2 * math.asin(2.5 / 4.5)  # half of the disc within |y| < 2.5
    outside = 2.0 * (cap(4.5, 2.5) + strip) + 4.0 * slot  # of the eyes, off the bar
    under = 2.0 * strip + 5.0 * slot  # of the eyes, over the bar
    holes = math.pi * 1.25**2 + 2.5 * slot + math.pi * 0.75**2
    volume = T * ends + eye * outside + (eye - T) * under - eye * holes
    assert mass_properties(slotted(slot, eye_thickness=eye)).volume == pytest.approx(volume, rel=1e-7)


def test_a_slot_has_the_area_of_its_wall_and_of_its_eye() -> None:
    mesh = mesh_body(slotted(6.0, fillet=0.8), COARSE)
    assert mesh.areas["bore:S"] == pytest.approx(T * (math.pi * 2.5 + 12.0), rel=1e-8)
    ring = math.pi * 4.5**2 + 9.0 * 6.0 - math.pi * 1.25**2 - 2.5 * 6.0
    assert mesh.areas["top:S"] == pytest.approx(ring, rel=1e-8)
    assert mesh.areas["bottom:S"] == pytest.approx(ring, rel=1e-8)
    assert mesh.areas["bore:B"] == pytest.approx(T * math.pi * 1.5, rel=1e-8)
    wall = mesh.points[np.unique(mesh.surfaces["bore:S"])]
    off = np.hypot(np.maximum(np.abs(wall[:, 0] - 10.0) - 3.0, 0.0), wall[:, 1])
    assert off == pytest.approx(np.full(len(wall), 1.25), abs=1e-6)


def test_filleted_slots_and_arms_leave_no_sharp_inner_edge() -> None:
    assert reentrant_edges(slotted(6.0, fillet=0.8)) == []
    assert len(reentrant_edges(slotted(6.0))) == 4
    assert reentrant_edges(with_arm(80.0, fillet=0.8)) == []
    # Two at B and at Q; at A four where bar and arm meet the eye, three where they meet each other outside of it.
    assert len(reentrant_edges(with_arm(80.0, fillet=0.0))) == 8
    assert len(reentrant_edges(with_arm(60.0, fillet=0.0))) == 7


def with_arm(degrees: float, fillet: float) -> Body:
    far = 30.0 * math.cos(math.radians(degrees)), 30.0 * math.sin(math.radians(degrees))
    pins = (
        Pin(name="A", x=0.0, y=0.0, diameter=1.5),
        Pin(name="B", x=40.0, y=0.0, diameter=1.5),
        Pin(name="Q", x=far[0], y=far[1], diameter=1.5, foot=(0.0, 0.0)),
    )
    return Body(part=bar(fillet), pins=pins, ends=(), holes=())


@pytest.mark.parametrize("degrees", [60.0, 80.0, 130.0])
def test_volume_and_centroid_of_a_bar_with_an_arm(degrees: float) -> None:
    """Against the union of two strips and three circles, counted on a fine grid of points."""
    body = with_arm(degrees, 0.0)
    step = 0.025
    x, y = np.meshgrid(np.arange(-25.0, 46.0, step) + step / 2, np.arange(-6.0, 36.0, step) + step / 2)
    angle = math.radians(degrees)
    u, v = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
    inside = (np.abs(y) < 2.5) & (x > 0.0) & (x < 40.0) | (np.abs(v) < 2.5) & (u > 0.0) & (u < 30.0)
    hole = np.zeros_like(inside)
    for pin in body.pins:
        far = np.hypot(x - pin.x, y - pin.y)
        inside |= far < 4.5
        hole |= far < 0.75
    inside &= ~hole
    found = mass_properties(body)
    assert found.volume == pytest.approx(T * step**2 * np.count_nonzero(inside), rel=1e-4)
    assert found.centroid == pytest.approx([x[inside].mean(), y[inside].mean(), 0.0], abs=2e-3)


def test_a_bar_with_an_arm_meshes_with_its_plain_end() -> None:
    far = 30.0 * math.cos(math.radians(80.0)), -30.0 * math.sin(math.radians(80.0))
    pins = (
        Pin(name="A", x=0.0, y=0.0, diameter=1.5),
        Pin(name="Q", x=far[0], y=far[1], diameter=1.5, foot=(0.0, 0.0)),
    )
    body = Body(part=bar(0.8), pins=pins, ends=(PlainEnd(name="E", x=40.0, patch=4.0),), holes=())
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["end:E"] == pytest.approx(4.0 * 2.0 * (5.0 + T), rel=1e-8)
    for name in ("A", "Q"):
        assert mesh.areas[f"top:{name}"] == pytest.approx(math.pi * (4.5**2 - 0.75**2), rel=1e-8)
    for name, triangles in mesh.surfaces.items():
        assert triangle_areas(mesh.points, triangles).sum() == pytest.approx(mesh.areas[name], rel=0.05), name


def test_an_arm_above_a_patch_and_a_hole_belongs_to_neither() -> None:
    """The patch's four faces are 2 x 4 mm x (5 mm + T); a hole of 1 mm along y goes through the bar of 5 mm alone."""
    turn = math.radians(35.0)
    pins = (*with_arm(35.0, 0.8).pins[:2], Pin(name="Q", x=44.0 * math.cos(turn), y=44.0 * math.sin(turn),
            diameter=1.5, foot=(0.0, 0.0)))  # fmt: skip
    row = HoleRow(count=1, diameter="1 mm", first="14 mm", last="14 mm", along="y")
    plain = Body(part=bar(0.8), pins=pins, ends=(PlainEnd(name="E", x=18.0, patch=4.0),), holes=())
    mesh, drilled = mesh_body(plain, COARSE), mass_properties(replace(plain, holes=(row,)))
    assert mesh.areas["end:E"] == pytest.approx(4.0 * 2.0 * (5.0 + T), rel=1e-8)
    assert mesh.volume - drilled.volume == pytest.approx(math.pi / 4.0 * 5.0, rel=1e-6)


def test_volume_centroid_and_inertia_of_a_disc() -> None:
    """R 4.5 mm, 2 mm thick, a hole of 1 mm in the middle and one of 2 mm at 3 mm: I about the centroid by Steiner."""
    part = Disc(shape="disc", material="resin", diameter="9 mm", thickness="2 mm", eye_diameter="2.6 mm")
    pins = (Pin(name="O", x=0.0, y=0.0, diameter=1.0), Pin(name="A", x=3.0, y=0.0, diameter=2.0))
    body = Body(part=part, pins=pins, ends=(), holes=())
    found = mass_properties(body)
    plate, shaft, pin = 2.0 * math.pi * 4.5**2, 2.0 * math.pi * 0.25, 2.0 * math.pi
    volume = plate - shaft - pin
    at = -3.0 * pin / volume
    about_origin = plate * 4.5**2 / 2.0 - shaft * 0.25 / 2.0 - pin * (1.0 / 2.0 + 9.0)
    assert found.volume == pytest.approx(volume, rel=1e-10)
    assert found.centroid == pytest.approx([at, 0.0, 0.0], abs=1e-9)
    assert found.inertia[2, 2] == pytest.approx(about_origin - volume * at**2, rel=1e-9)
    assert reentrant_edges(body) == []
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["top:A"] == pytest.approx(math.pi * (1.3**2 - 1.0), rel=1e-8)
    assert mesh.areas["bottom:O"] == pytest.approx(math.pi * (1.3**2 - 0.25), rel=1e-8)
