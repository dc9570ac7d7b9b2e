import math
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from alula.geometry.bodies.eyes import flush
from alula.geometry.parts.part import Bar, Body, HoleRow, Part, Pin, Section, Tube

TUBE: dict[str, Any] = {
    "shape": "tube",
    "material": "pvc-u",
    "outer_diameter": "5 mm",
    "inner_diameter": "2.5 mm",
    "eye_diameter": "8 mm",
    "eye_thickness": "7 mm",
    "fillet_radius": "0.8 mm",
}
BAR: dict[str, Any] = {
    "shape": "bar",
    "material": "pvc-u",
    "width": "6 mm",
    "thickness": "4 mm",
    "eye_diameter": "9 mm",
    "eye_thickness": "7 mm",
    "fillet_radius": "1 mm",
}
HOLES: dict[str, Any] = {"count": 5, "diameter": "1 mm", "first": "20 mm", "last": "40 mm", "along": "y"}


def _second_moments(inside: Any, reach: float, cells: int = 1200) -> tuple[float, float, float]:
    """Area and second moments of a region by counting small cells."""
    at = (np.arange(cells) + 0.5) / cells * 2 * reach - reach
    y, z = np.meshgrid(at, at)
    cell = (2 * reach / cells) ** 2
    mask = inside(y, z)
    return float(mask.sum() * cell), float((z**2 * mask).sum() * cell), float((y**2 * mask).sum() * cell)


def test_section_of_the_tube_by_counting_cells() -> None:
    section = Tube.model_validate(TUBE).section
    area, i_y, i_z = _second_moments(lambda y, z: (y**2 + z**2 <= 2.5**2) & (y**2 + z**2 >= 1.25**2), 2.6)
    assert section.area == pytest.approx(area, rel=2e-3)
    assert section.i_y == pytest.approx(i_y, rel=2e-3)
    assert section.i_z == pytest.approx(i_z, rel=2e-3)
    assert section.torsion == section.i_y + section.i_z
    assert (section.half_y, section.half_z, section.radius_ratio) == (2.5, 2.5, 0.5)


def test_section_of_the_source() -> None:
    """Paredes (2018): I = π/4 (Ro⁴ - Ri⁴) with 2.5 and 1.25 mm; M 33.75 N mm over it gives 2.934 MPa."""
    section = Tube.model_validate(TUBE).section
    assert section.i_z == pytest.approx(28.7621, abs=1e-4)
    assert 33.75 * section.half_y / section.i_z == pytest.approx(2.934, abs=5e-4)


@pytest.mark.parametrize(
    ("width", "thickness", "size"), [(6, 4, 4), (10, 1, 1), (30, 1, 3), (100, 1, 4), (1, 30, 3), (4, 6, 4)]
)
def test_elements_of_a_sheet_follow_its_width_within_bounds(width: int, thickness: int, size: float) -> None:
    """By its thickness alone the first mesh of a sheet of 300 x 30 x 1 mm had 418,128 elements."""
    part = Bar.model_validate(
        {"shape": "bar", "material": "pvc-u", "width": f"{width} mm", "thickness": f"{thickness} mm",
         "fillet_radius": "0.1 mm"}
    )  # fmt: skip
    assert part.size == pytest.approx(size)
    assert part.scaled(lambda length: 2.0 * length).size == pytest.approx(2.0 * size)


def test_section_of_the_bar_bends_most_easily_out_of_the_plane() -> None:
    section = Bar.model_validate(BAR).section
    area, i_y, i_z = _second_moments(lambda y, z: (abs(y) <= 3.0) & (abs(z) <= 2.0), 3.0)
    assert section.area == pytest.approx(area, rel=1e-3) == 24.0
    assert section.i_y == pytest.approx(i_y, rel=2e-3) == 32.0
    assert section.i_z == pytest.approx(i_z, rel=2e-3) == 72.0
    assert (section.half_y, section.half_z) == (3.0, 2.0)


@pytest.mark.parametrize(("width", "thickness"), [(6.0, 4.0), (4.0, 6.0), (5.0, 5.0), (20.0, 2.0)])
def test_torsion_of_the_bar_against_the_series(width: float, thickness: float) -> None:
    """Timoshenko & Goodier, Theory of Elasticity, 3rd ed., section 109: Saint-Venant's series for a rectangle."""
    bar = BAR | {
        "width": f"{width} mm",
        "thickness": f"{thickness} mm",
        "eye_diameter": "30 mm",
        "eye_thickness": "9 mm",
    }
    long, short = max(width, thickness), min(width, thickness)
    odd = np.arange(1, 60, 2)
    series = float(np.sum(np.tanh(odd * math.pi * long / (2 * short)) / odd**5))
    exact = long * short**3 / 3 * (1 - 192 * short / (math.pi**5 * long) * series)
    assert Bar.model_validate(bar).section.torsion == pytest.approx(exact, rel=5e-3)


def test_shear_coefficients_of_cowper() -> None:
    """Cowper (1966), table 1: solid circle 6(1+ν)/(7+6ν), thin tube 2(1+ν)/(4+3ν), rectangle 10(1+ν)/(12+11ν)."""

    def tube(inner: str, nu: float) -> float:
        return Tube.model_validate(TUBE | {"inner_diameter": inner}).section.shear_coefficient(nu)

    assert tube("0 mm", 0.3) == pytest.approx(6 * 1.3 / (7 + 1.8))
    assert tube("4.9999999 mm", 0.3) == pytest.approx(2 * 1.3 / (4 + 0.9), rel=1e-7)
    assert tube("2.5 mm", 0.38) == pytest.approx(0.626817, abs=5e-7)
    assert Bar.model_validate(BAR).section.shear_coefficient(0.3) == pytest.approx(13 / 15.3)


@pytest.mark.parametrize(
    ("part", "change", "words"),
    [
        (TUBE, {"inner_diameter": "5 mm"}, "inner_diameter 5 mm must be less than outer_diameter 5 mm; reduce"),
        (TUBE, {"inner_diameter": "6 mm"}, "inner_diameter 6 mm must be less"),
        (TUBE, {"outer_diameter": "0 mm"}, "greater than zero"),
        (TUBE, {"eye_diameter": "5 mm"}, "eye_diameter 5 mm must be greater than outer_diameter 5 mm; increase"),
        (TUBE, {"eye_thickness": "6.5 mm"}, "eye_thickness 6.5 mm must be at least .* = 6.64 mm"),
        (TUBE, {"fillet_radius": "-1 mm"}, "must not be negative"),
        (TUBE, {"width": "1 mm"}, "Extra inputs"),
        (BAR, {"eye_diameter": "5.9 mm"}, "eye_diameter 5.9 mm must be at least width 6 mm; increase"),
        (BAR, {"eye_thickness": "3.9 mm"}, "eye_thickness 3.9 mm must be at least the bar's thickness 4 mm"),
        (BAR, {"eye_thickness": "5 mm"}, "eye_thickness 5 mm makes a step too low .* at least .* = 6.05 mm, or leave"),
        (BAR, {"thickness": "0 mm"}, "greater than zero"),
        (BAR, {"shape": "cone"}, "does not match any of the expected tags"),
    ],
)
def test_sizes_that_cannot_be(part: dict[str, Any], change: dict[str, str], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        TypeAdapter(Part).validate_python(part | change)


def test_sizes_at_the_limit_are_allowed() -> None:
    rod = TUBE | {"inner_diameter": "0 mm", "eye_thickness": "6.64 mm"}
    assert Tube.model_validate(rod).section.radius_ratio == 0.0
    assert Bar.model_validate(BAR | {"eye_thickness": "4 mm", "fillet_radius": "0 mm"}).eye_thickness == 4.0
    assert Bar.model_validate(BAR | {"eye_thickness": "6.05 mm"}).eye_thickness == 6.05
    same = Bar.model_validate(BAR | {"thickness": "0.3 in", "eye_thickness": "7.62 mm"})
    pin = Pin(name="A", x=0.0, y=0.0, diameter=2.0)
    assert flush(Body(part=same, pins=(pin,), ends=(), holes=()), pin)


@pytest.mark.parametrize(("outer", "diameter", "thickness"), [("5 mm", 8.0, 7.0), ("6 mm", 9.6, 8.0)])
def test_eyes_follow_from_the_tube(outer: str, diameter: float, thickness: float) -> None:
    """1.6 times the outer diameter wide; 2.5 fillets of 0.8 mm thicker than the tube."""
    sizes = TUBE | {"outer_diameter": outer}
    found = Tube.model_validate({key: sizes[key] for key in sizes if not key.startswith("eye")})
    assert (found.eye_diameter, found.eye_thickness) == (pytest.approx(diameter), pytest.approx(thickness))


def test_eyes_follow_from_the_bar() -> None:
    found = Bar.model_validate({key: BAR[key] for key in BAR if not key.startswith("eye")})
    assert (found.eye_diameter, found.eye_thickness) == (pytest.approx(9.6), 4.0)


def test_holes_are_evenly_spaced() -> None:
    assert HoleRow.model_validate(HOLES).positions == (20.0, 25.0, 30.0, 35.0, 40.0)
    assert HoleRow.model_validate(HOLES | {"count": 1}).positions == (20.0,)
    assert HoleRow.model_validate(HOLES | {"first": "40 mm", "last": "20 mm"}).positions[0] == 40.0


def test_a_section_takes_names_alone() -> None:
    with pytest.raises(TypeError):
        Section(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, True)  # type: ignore[misc]
