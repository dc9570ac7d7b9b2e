"""Solids against closed forms: volumes, named areas and inertia, and their meshes against the solids.

Volumes of tubes are held to 1e-5: the kernel approximates the curve where tube and eye meet by splines.
"""

import math

import numpy as np
import pytest
from mesh_measures import volumes_and_moments
from scipy.integrate import quad
from skfem import Basis, ElementTetP2, Functional, MeshTet2

from alula.geometry.meshing.element_geometry import triangle_areas
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube

LENGTH = 20.0
PINS = (Pin(name="A", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=LENGTH, y=0.0, diameter=1.5))


def bar(fillet: float, thickness: float = 3.0, eye_thickness: float = 3.0) -> Bar:
    return Bar(
        shape="bar",
        material="resin",
        width="5 mm",
        thickness=f"{thickness} mm",
        eye_diameter="9 mm",
        eye_thickness=f"{eye_thickness} mm",
        fillet_radius=f"{fillet} mm",
    )


def tube(fillet: float) -> Tube:
    return Tube(
        shape="tube",
        material="pvc",
        outer_diameter="5 mm",
        inner_diameter="2.5 mm",
        eye_diameter="8 mm",
        eye_thickness="7 mm",
        fillet_radius=f"{fillet} mm",
    )


def row(along: str) -> HoleRow:
    return HoleRow(count=2, diameter="1 mm", first="8.5 mm", last="11.5 mm", along=along)


def corner(radius: float, half: float, fillet: float) -> float:
    """Area between a line at y = half, the circle about the origin and the fillet that touches both."""
    centre = np.array([math.sqrt((radius + fillet) ** 2 - (half + fillet) ** 2), half + fillet])
    start = np.array([math.sqrt(radius**2 - half**2), half])
    touch = np.array([centre[0], half])
    outline = [np.zeros(2), start, touch, centre]
    polygon = 0.5 * sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(outline, outline[1:] + outline[:1], strict=True))
    to_centre, to_start = math.atan2(centre[1], centre[0]), math.atan2(start[1], start[0])
    return polygon - 0.5 * radius**2 * (to_centre - to_start) - 0.5 * fillet**2 * (math.pi / 2.0 - to_centre)


def flat_bar_area(fillet: float) -> float:
    """Area of a 5 mm bar with 9 mm eyes about its ends, seen along the pins; pin holes 1.5 mm."""
    radius, half = 4.5, 2.5
    strip = half * math.sqrt(radius**2 - half**2) + radius**2 * math.asin(half / radius)
    area = 5.0 * LENGTH + 2.0 * (math.pi * radius**2 - strip - math.pi * 0.75**2)
    return area + (4.0 * corner(radius, half, fillet) if fillet else 0.0)


@pytest.mark.parametrize("fillet", [0.0, 1.0])
def test_volume_of_a_flat_bar(fillet: float) -> None:
    found = mass_properties(Body(part=bar(fillet), pins=PINS, ends=(), holes=()))
    assert found.volume == pytest.approx(3.0 * flat_bar_area(fillet), rel=1e-8)
    assert found.centroid == pytest.approx([LENGTH / 2.0, 0.0, 0.0], abs=1e-6)


def test_holes_along_the_pins_take_cylinders_out_of_a_bar() -> None:
    found = mass_properties(Body(part=bar(0.0), pins=PINS, ends=(), holes=(row("z"),)))
    assert found.volume == pytest.approx(3.0 * flat_bar_area(0.0) - 2.0 * 3.0 * math.pi / 4.0, rel=1e-8)


def test_thick_eyes_of_a_bar() -> None:
    found = mass_properties(Body(part=bar(0.0, eye_thickness=5.0), pins=PINS, ends=(), holes=()))
    eyes = 2.0 * (5.0 - 3.0) * math.pi * (4.5**2 - 0.75**2)
    assert found.volume == pytest.approx(3.0 * flat_bar_area(0.0) + eyes, rel=1e-8)


def tube_volume(holes: float = 0.0) -> float:
    """Volume of the tube without fillets: eyes, tube outside the eyes, less bore, pin holes and cross holes."""
    outer, inner, eye = 2.5, 1.25, 4.0
    overlap, _ = quad(lambda y: 2.0 * math.sqrt(outer**2 - y**2) * math.sqrt(eye**2 - y**2), -outer, outer)
    solid = math.pi * outer**2 * LENGTH - 2.0 * overlap + 2.0 * math.pi * 7.0 * (eye**2 - 0.75**2)
    bore = math.pi * inner**2 * (LENGTH - 2.0 * eye)
    return solid - bore - holes


def cross_hole() -> float:
    """Volume that a 1 mm cross hole takes out of the tube's wall."""
    wall, _ = quad(
        lambda u: 2.0 * math.sqrt(0.25 - u**2) * 2.0 * (math.sqrt(6.25 - u**2) - math.sqrt(1.5625 - u**2)), -0.5, 0.5
    )
    return wall


@pytest.mark.parametrize("along", [None, "y", "z"])
def test_volume_of_a_tube(along: str | None) -> None:
    holes = (row(along),) if along else ()
    found = mass_properties(Body(part=tube(0.0), pins=PINS, ends=(), holes=holes))
    assert found.volume == pytest.approx(tube_volume(2.0 * cross_hole() if along else 0.0), rel=1e-5)


def test_bore_is_open_at_a_plain_end() -> None:
    body = Body(part=tube(0.0), pins=PINS[:1], ends=(PlainEnd(name="H", x=LENGTH, patch=5.0),), holes=())
    outer, inner, eye = 2.5, 1.25, 4.0
    overlap, _ = quad(lambda y: 2.0 * math.sqrt(outer**2 - y**2) * math.sqrt(eye**2 - y**2), -outer, outer)
    expected = math.pi * (outer**2 * LENGTH - inner**2 * (LENGTH - eye)) - overlap + math.pi * 7.0 * (eye**2 - 0.75**2)
    assert mass_properties(body).volume == pytest.approx(expected, rel=1e-5)


BODIES = {
    "tube": Body(
        part=tube(0.8),
        pins=(PINS[0],),
        ends=(PlainEnd(name="H", x=LENGTH, patch=5.0), PlainEnd(name="M", x=8.0, patch=2.0)),
        holes=(HoleRow(count=2, diameter="1 mm", first="11 mm", last="13 mm", along="y"),),
    ),
    "bar": Body(
        part=bar(1.0),
        pins=(PINS[0], Pin(name="B", x=12.0, y=1.5, diameter=2.0)),
        ends=(PlainEnd(name="H", x=LENGTH + 3.0, patch=4.0),),
        holes=(),
    ),
}
AREAS = {
    "tube": {
        "bore:A": math.pi * 1.5 * 7.0,
        "top:A": math.pi * (4.0**2 - 0.75**2),
        "bottom:A": math.pi * (4.0**2 - 0.75**2),
        "end:H": math.pi * 5.0 * 5.0,
        "end:M": math.pi * 5.0 * 2.0,
    },
    "bar": {
        "bore:A": math.pi * 1.5 * 3.0,
        "bore:B": math.pi * 2.0 * 3.0,
        "top:A": math.pi * (4.5**2 - 0.75**2),
        "bottom:A": math.pi * (4.5**2 - 0.75**2),
        "top:B": math.pi * (4.5**2 - 1.0),
        "bottom:B": math.pi * (4.5**2 - 1.0),
        "end:H": 2.0 * (5.0 + 3.0) * 4.0,
    },
}


@pytest.mark.parametrize("name", ["tube", "bar"])
def test_mesh_has_the_areas_volume_centroid_and_inertia_of_the_solid(name: str) -> None:
    mesh = mesh_body(BODIES[name], COARSE)
    assert dict(mesh.areas) == pytest.approx(AREAS[name], rel=1e-6)
    for surface, triangles in mesh.surfaces.items():
        # Corner nodes alone: an inscribed polygon of 8 sides and more has at least 0.9 of the circle's area.
        assert 0.85 * mesh.areas[surface] < triangle_areas(mesh.points, triangles).sum() <= 1.001 * mesh.areas[surface]
    volumes, moments = volumes_and_moments(mesh.points, mesh.cells)
    assert volumes.sum() == pytest.approx(mesh.volume, rel=1e-3)
    assert moments.sum(axis=0) / volumes.sum() == pytest.approx(mesh.centroid, abs=0.01)
    solid = mass_properties(BODIES[name])
    assert solid.volume == mesh.volume
    meshed = _inertia(mesh.points, mesh.cells, mesh.centroid)
    assert np.abs(solid.inertia - meshed).max() < 2e-3 * meshed.max()
    if name == "bar":  # its eyes lie off the axis, so the sign of the product shows
        assert solid.inertia[0, 1] == pytest.approx(meshed[0, 1], rel=0.02)
        assert abs(meshed[0, 1]) > 20e-3 * meshed.max()


def _inertia(points: np.ndarray, cells: np.ndarray, about: np.ndarray) -> np.ndarray:
    """Inertia for unit density on curved tetrahedra, integrated by scikit-fem."""
    basis = Basis(MeshTet2((points - about).T, cells.T), ElementTetP2(), intorder=6)
    second = np.array(
        [[Functional(lambda w, i=i, j=j: w.x[i] * w.x[j]).assemble(basis) for i in range(3)] for j in range(3)]
    )
    return np.trace(second) * np.eye(3) - second


@pytest.mark.parametrize(("unit", "length"), [(1.0, 3e6), (2e-12, 60.0), (2e14, 60.0)])
def test_volume_at_the_ends_of_the_range_of_lengths(unit: float, length: float) -> None:
    """Bar of 5 by 3 units: a million times as long as thick, and as small and as large as may be."""
    part = bar(0.0).model_copy(update={n: unit * getattr(bar(0.0), n) for n in ("width", "thickness", "eye_diameter")})
    part = part.model_copy(update={"eye_thickness": part.thickness})
    pins = tuple(Pin(name=n, x=x * unit, y=0.0, diameter=1.5 * unit) for n, x in (("A", 0.0), ("B", length)))
    strip = 2.5 * math.sqrt(4.5**2 - 2.5**2) + 4.5**2 * math.asin(2.5 / 4.5)  # of an eye's half, over the bar
    exact = 3.0 * (5.0 * length + 2.0 * (math.pi * 4.5**2 - strip - math.pi * 0.75**2))
    found = mass_properties(Body(part=part, pins=pins, ends=(), holes=())).volume / unit**3
    assert found == pytest.approx(exact, rel=1e-8)
