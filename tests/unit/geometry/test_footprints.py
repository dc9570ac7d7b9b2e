"""What parts cover as seen along their pins, against volumes and surfaces of the geometry kernel."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from alula.geometry.bodies.body import Body
from alula.geometry.bodies.features import Fork, Pin
from alula.geometry.bodies.footprint import Footprint
from alula.geometry.clearance.shape import Core, gaps, link_shape, meeting, nearest, overlap, pin_shape
from alula.geometry.imported.read import part_facts, part_surface
from alula.geometry.meshing.mesh import mass_properties
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.disc import Disc
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.shadow import shadows
from alula.geometry.parts.tube import Tube

DATA = Path(__file__).resolve().parents[2] / "data" / "step"
FLAT: dict[str, tuple[Any, dict[str, Any], tuple[Pin, ...]]] = {
    "bar with round eyes and an arm": (
        Bar,
        {"shape": "bar", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"},
        (
            Pin(name="A", x=0.0, y=0.0, diameter=3.0),
            Pin(name="B", x=60.0, y=0.0, diameter=3.0),
            Pin(name="C", x=70.0, y=40.0, diameter=3.0, foot=(60.0, 0.0)),
        ),
    ),
    "bar with a slot, round as wide as itself": (
        Bar,
        {"shape": "bar", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "0 mm", "eye_diameter": "8 mm"},
        (Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="S", x=40.0, y=0.0, diameter=3.2, slot=12.0)),
    ),
    "bar with square ends": (
        Bar,
        {
            "shape": "bar",
            "width": "8 mm",
            "thickness": "4 mm",
            "fillet_radius": "0 mm",
            "ends": "square",
            "overhang": "5 mm",
        },
        (Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="B", x=60.0, y=0.0, diameter=3.0)),
    ),
    "bar of varying width": (
        Bar,
        {
            "shape": "bar",
            "widths": [["0 mm", "12 mm"], ["30 mm", "12 mm"], ["30 mm", "8 mm"], ["60 mm", "6 mm"]],
            "shoulder_radius": "1 mm",
            "thickness": "4 mm",
            "fillet_radius": "1 mm",
        },
        (Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="B", x=60.0, y=0.0, diameter=3.0)),
    ),
    "plate with concave sides and a hole": (
        Plate,
        {
            "shape": "plate",
            "thickness": "4 mm",
            "eye_diameter": "12 mm",
            "fillet_radius": "60 mm",
            "holes": [{"x": "20 mm", "y": "12 mm", "diameter": "6 mm"}],
        },
        (
            Pin(name="A", x=0.0, y=0.0, diameter=3.0),
            Pin(name="B", x=50.0, y=0.0, diameter=3.0),
            Pin(name="C", x=15.0, y=35.0, diameter=3.0),
        ),
    ),
    "disc": (
        Disc,
        {"shape": "disc", "diameter": "40 mm", "thickness": "4 mm", "eye_diameter": "6 mm"},
        (Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="B", x=12.0, y=0.0, diameter=3.0)),
    ),
}


def body_of(kind: Any, sizes: dict[str, Any], pins: tuple[Pin, ...]) -> Body:
    part = kind.model_validate({"material": "pla-fdm-xy", **sizes})
    return Body(part=part, pins=pins, ends=(), holes=())


@pytest.mark.parametrize("name", FLAT)
def test_a_flat_part_covers_its_volume_over_its_thickness(name):
    body = body_of(*FLAT[name])
    shape = link_shape("link", body, [0.0])
    assert (shape.low, shape.high) == (-2.0, 2.0)
    holes = sum(math.pi / 4.0 * pin.diameter**2 + pin.diameter * pin.slot for pin in body.pins)
    assert 4.0 * (shape.polygon.area - holes) == pytest.approx(mass_properties(body).volume, rel=1e-3)


@pytest.mark.parametrize(
    ("eyes", "bounds", "half"),
    # Eyes of 1.6 diameters, 2.5 fillets higher than the tube; without them it reaches a diameter past its pins.
    [("round", (-4.8, -4.8, 64.8, 22.5), 4.25), ("none", (-6.0, -3.0, 66.0, 22.5), 3.0)],
)
def test_a_tube_covers_its_eyes_and_arms(eyes, bounds, half):
    sizes = {"shape": "tube", "outer_diameter": "6 mm", "inner_diameter": "3 mm", "fillet_radius": "1 mm"}
    pins = (
        Pin(name="A", x=0.0, y=0.0, diameter=2.0),
        Pin(name="B", x=60.0, y=0.0, diameter=2.0),
        Pin(name="C", x=30.0, y=20.0, diameter=2.0, foot=(30.0, 0.0)),
    )
    body = body_of(Tube, {**sizes, "eyes": eyes, "arm_width": "5 mm", "arm_thickness": "3 mm"}, pins)
    shape = link_shape("link", body, [10.0])
    assert shape.polygon.bounds == pytest.approx(bounds)
    assert (shape.low, shape.high) == (10.0 - half, 10.0 + half)
    arm = [core for core in shape.cores if core.low == 8.5]
    assert max(core.polygon.bounds[3] for core in arm) == pytest.approx(22.5)


def test_a_fork_is_open_between_its_cheeks():
    """Piece by piece the volume of the kernel, holes included: the gap takes 3 mm within 9 mm of the axis."""
    pins = (
        Pin(name="A", x=0.0, y=0.0, diameter=2.0),
        Pin(name="B", x=60.0, y=0.0, diameter=2.0, fork=Fork(gap=3.0, depth=9.0, radius=0.0)),
    )
    sizes = {"shape": "bar", "width": "8 mm", "thickness": "6 mm", "fillet_radius": "0 mm", "eye_diameter": "12 mm"}
    body = body_of(Bar, sizes, pins)
    shape = link_shape("link", body, [0.0])
    heights = sorted({z for core in shape.cores for z in (core.low, core.high)})
    assert heights == [-3.0, -1.5, 1.5, 3.0]
    layers = [shapely.union_all([c.polygon for c in shape.cores if c.low <= low < c.high]) for low in heights[:-1]]
    areas = [layer.area for layer in layers]
    assert areas[1] < areas[0] == pytest.approx(areas[2])
    holes = math.pi * (6.0 + 3.0)
    found = sum(area * (high - low) for area, low, high in zip(areas, heights[:-1], heights[1:], strict=True))
    assert found - holes == pytest.approx(mass_properties(body).volume, rel=1e-3)


def volume(pieces: tuple[Footprint, ...]) -> float:
    return sum((piece.high - piece.low) * shapely.Polygon(piece.corners, piece.holes).area for piece in pieces)


@pytest.mark.parametrize(
    ("name", "axis", "levels"),
    [
        ("angle", 2, [0.0, 2.0, 10.0]),
        ("bell_crank", 2, [0.0, 5.0, 12.0]),
        ("fork", 1, [-10.0, -6.0, 2.0, 6.0]),
        ("inch", 2, [-3.175, 3.175]),
    ],
)
def test_layers_of_a_solid_between_its_flat_faces_make_up_its_volume(name, axis, levels):
    """Seen along the direction in which they are extruded, where the shadow of a layer is its section."""
    surface, facts = part_surface(DATA / f"{name}.step"), part_facts(DATA / f"{name}.step")
    found = shadows(np.roll(surface.points, 2 - axis, axis=1), surface.triangles)
    assert sorted({z for piece in found for z in (piece.low, piece.high)}) == pytest.approx(levels, abs=1e-3)
    assert volume(found) == pytest.approx(facts.volume, rel=3e-4)


def test_a_shadow_covers_every_point_of_a_solid_without_flat_faces():
    surface = part_surface(DATA / "open_bores.step")
    turn = np.linalg.qr(np.array([[1.0, 0.2, 0.3], [0.1, 1.0, 0.4], [0.5, 0.2, 1.0]]))[0]
    points = surface.points @ turn.T * np.sign(np.linalg.det(turn))
    [piece] = shadows(points, surface.triangles)
    around = shapely.Polygon(piece.corners, piece.holes)
    assert shapely.distance(shapely.points(points[:, :2]), around).max() < 0.02
    hull = shapely.convex_hull(shapely.MultiPoint(points[:, :2]))
    assert shapely.convex_hull(around).area == pytest.approx(hull.area, rel=1e-3)


def test_two_discs_lie_apart_by_the_distance_of_their_centres_less_their_radii():
    one, other = pin_shape("pin A", 10.0, 0.0, 5.0), pin_shape("pin B", 4.0, 4.0, 9.0)
    pairs = meeting(one, other)
    turn, shift = np.ones(3, dtype=complex), np.array([10.0 + 0j, 0.0 + 7.0j, 3.0 + 4.0j])
    assert gaps(pairs, turn, shift) == pytest.approx([3.0, 0.0, -2.0])
    assert nearest(pairs, 1.0 + 0j, 10.0 + 0j) == pytest.approx(6.5)
    depth, centre = overlap(pairs, 1.0 + 0j, 3.0 + 4.0j)
    assert depth == pytest.approx(2.0, rel=1e-2)
    assert abs(centre) == pytest.approx(4.0, abs=0.05)  # the lens lies from 3 to 5 mm along the line of the centres


@pytest.mark.parametrize("rounding", [-1e-14, 0.0, 1e-14])
def test_outlines_that_are_as_near_at_two_corners_are_nearest_at_the_first(rounding):
    """Sides that are parallel, and two pieces on either side: which place was told depended on the last digit."""
    box = Core(geometry=shapely.box(0.0, 0.0, 10.0, 10.0), radius=0.0, low=0.0, high=1.0, error=0.0)
    bars = [Core(geometry=shapely.LineString([(0.0, y), (30.0, y)]), radius=1.0, low=0.0, high=1.0, error=0.0)
            for y in (-4.0, 14.0)]  # fmt: skip
    turn, shift = 1.0 + 1j * rounding, complex(0.0, 100.0 * rounding)
    assert gaps([(box, bar) for bar in bars], np.array([turn]), np.array([shift])) == pytest.approx([3.0])
    assert nearest([(box, bar) for bar in bars], turn, shift) == pytest.approx(10.0 - 1.5j)
    assert nearest([(box, bar) for bar in reversed(bars)], turn, shift) == pytest.approx(10.0 + 11.5j)


def test_outlines_that_overlap_here_and_touch_there_have_a_depth():
    """Their intersection is an area and a line; the search for the largest circle stopped at the line."""
    square = shapely.box(0.0, 0.0, 10.0, 10.0)
    hook = shapely.Polygon([(2, 8), (4, 8), (4, 12), (6, 12), (6, 10), (9, 10), (9, 14), (2, 14)])
    one, other = (Core(geometry=each, radius=0.0, low=0.0, high=1.0, error=0.0) for each in (square, hook))
    depth, centre = overlap([(one, other)], 1.0 + 0j, 0j)
    assert depth == pytest.approx(2.0, rel=1e-2)
    assert centre == pytest.approx(3.0 + 9.0j, abs=0.05)


def test_slabs_that_only_lie_on_each_other_do_not_meet():
    assert meeting(pin_shape("pin A", 10.0, 0.0, 4.0), pin_shape("pin B", 4.0, 4.0, 9.0)) == []
