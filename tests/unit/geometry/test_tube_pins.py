"""Tubes with pins straight through their walls: volumes, rings, and what is refused."""

import math

import pytest
from pydantic import TypeAdapter, ValidationError
from scipy.integrate import quad

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body
from alula.geometry.parts.part import Body, HoleRow, Part, Pin, PlainEnd, Ring, Tube

OUTER, INNER, PIN, LENGTH = 8.0, 5.0, 3.0, 40.0
TUBE = {"shape": "tube", "material": "pvc", "outer_diameter": "8 mm", "inner_diameter": "5 mm", "eyes": "none"}


def tube(**sizes):
    return Tube.model_validate(TUBE | sizes)


def body(*, y=0.0, diameter=PIN, ends=(), holes=(), **sizes):
    pins = tuple(Pin(name=name, x=x, y=y, diameter=diameter) for name, x in (("A", 0.0), ("B", LENGTH)))
    return Body(part=tube(**sizes), pins=pins[: 2 - len(ends)], ends=ends, holes=holes)


def chord(diameter, y):
    return 2.0 * math.sqrt(max((diameter / 2.0) ** 2 - y**2, 0.0))


def hole(y0, walls):
    """Volume that a pin's hole takes out: the walls' length along z over the width of the hole."""
    across = PIN / 2.0
    return quad(lambda y: chord(PIN, y - y0) * walls(y), y0 - across, y0 + across, epsabs=1e-9, limit=200)[0]


def two_walls(y):
    return chord(OUTER, y) - chord(INNER, y)


def bush(diameter):
    """Volume of a cylinder along z inside the bore."""
    return quad(lambda y: chord(diameter, y) * chord(INNER, y), -diameter / 2.0, diameter / 2.0)[0]


PLAIN = math.pi / 4.0 * (OUTER**2 - INNER**2)
FULL = math.pi / 4.0 * OUTER**2


@pytest.mark.parametrize(
    ("sizes", "y", "volume"),
    [
        ({}, 0.0, PLAIN * (LENGTH + 16.0) - 2.0 * hole(0.0, two_walls)),
        ({"overhang": "5 mm"}, 0.7, PLAIN * (LENGTH + 10.0) - 2.0 * hole(0.7, two_walls)),
        ({"inner_diameter": "0 mm"}, 0.0, FULL * (LENGTH + 16.0) - 2.0 * hole(0.0, lambda y: chord(OUTER, y))),
        (
            {"plug_length": "10 mm"},
            0.0,
            PLAIN * (LENGTH + 16.0) + (FULL - PLAIN) * 20.0 - 2.0 * hole(0.0, lambda y: chord(OUTER, y)),
        ),
        (
            {"bush_diameter": "4 mm"},
            0.0,
            PLAIN * (LENGTH + 16.0) + 2.0 * bush(4.0) - 2.0 * hole(0.0, lambda y: chord(OUTER, y)),
        ),
    ],
)
def test_volume(sizes, y, volume):
    found = mass_properties(body(y=y, **sizes))
    assert found.volume == pytest.approx(volume, rel=2e-5)
    assert found.centroid[0] == pytest.approx(LENGTH / 2.0, abs=1e-4)


def test_fillets_fill_the_corners_at_a_plug_and_at_a_bush():
    for sizes in ({"plug_length": "10 mm"}, {"bush_diameter": "3.5 mm"}):
        sharp, filled = (mass_properties(body(**sizes, fillet_radius=f"{radius} mm")).volume for radius in (0.0, 0.3))
        assert 0.0 < filled - sharp < 0.02 * sharp


def test_a_mesh_has_the_walls_as_its_bore_and_no_flat_faces():
    mesh = mesh_body(body(), COARSE)
    assert set(mesh.surfaces) == {"bore:A", "bore:B"}
    # Walls' length along z about the hole's rim.
    wall = quad(lambda a: two_walls(PIN / 2.0 * math.sin(a)) * PIN / 2.0, 0.0, 2.0 * math.pi)[0]
    assert mesh.areas["bore:A"] == pytest.approx(wall, rel=1e-5)


def test_the_overhang_is_past_pins_alone():
    end = PlainEnd(name="H", x=LENGTH, patch=4.0)
    loaded = body(ends=(end,))
    assert loaded.part.reach(loaded) == (-8.0, LENGTH)
    assert set(mesh_body(loaded, COARSE).surfaces) == {"bore:A", "end:H"}


@pytest.mark.parametrize(
    ("sizes", "y", "ring", "wall"),
    [
        ({}, 0.0, Ring(diameter=0.0, low=-4.0, high=4.0, gaps=((-2.5, 2.5),)), 3.0),
        ({}, 1.5, Ring(diameter=0.0, low=-math.sqrt(13.75), high=math.sqrt(13.75), gaps=((-2.0, 2.0),)), 3.416198),
        ({"plug_length": "9 mm"}, 0.0, Ring(diameter=0.0, low=-4.0, high=4.0), 8.0),
        ({"bush_diameter": "4 mm"}, 0.0, Ring(diameter=0.0, low=-4.0, high=4.0), 8.0),
    ],
)
def test_a_pin_bears_on_the_walls(sizes, y, ring, wall):
    shape = body(y=y, **sizes)
    found = shape.ring(shape.pins[0])
    assert found == ring
    assert found.thickness == pytest.approx(wall)
    assert sum(high - low for low, high in found.walls) == pytest.approx(wall)
    assert found.middle == pytest.approx(0.0, abs=1e-12)
    second = quad(lambda z: z * z * any(a < z < b for a, b in found.walls), found.low, found.high,
                  points=[z for gap in found.gaps for z in gap] or None)[0]  # fmt: skip
    assert found.second == pytest.approx(second)


@pytest.mark.parametrize(
    ("sizes", "rule"),
    [
        ({"eye_diameter": "12 mm"}, "eye_diameter has no meaning"),
        ({"plug_length": "9 mm", "bush_diameter": "4 mm"}, "exclude each other"),
        ({"inner_diameter": "0 mm", "plug_length": "9 mm"}, "needs a bore"),
        ({"bush_diameter": "5 mm"}, "must be less than inner_diameter"),
        ({"eyes": "round"}, "fillet_radius is missing"),
        ({"eyes": "round", "fillet_radius": "1 mm", "overhang": "5 mm"}, "overhang has no meaning"),
        ({"overhang": "0 mm"}, "greater than zero"),
    ],
)
def test_sizes_that_make_no_tube(sizes, rule):
    with pytest.raises(ValidationError, match=rule):
        TypeAdapter(Part).validate_python(TUBE | sizes)


@pytest.mark.parametrize(
    ("shape", "rule"),
    [
        (body(diameter=7.5), "leaves too little of the tube's side"),
        (body(y=1.4), "leaves too little of the tube's side: keep it within 2.828 mm"),
        (body(overhang="1.5 mm"), "set overhang above 1.5 mm"),
        (body(bush_diameter="3 mm"), "3.3 mm to 4 mm"),
        (body(bush_diameter="3.5 mm", y=0.6), "3.3 mm to 2.8 mm"),
        (body(holes=(HoleRow(count=1, diameter="2 mm", first="2 mm", last="2 mm", along="y"),)), "runs into"),
    ],
)
def test_bodies_that_cannot_be_built(shape, rule):
    with pytest.raises(CaseError, match=rule):
        check_body(shape)
