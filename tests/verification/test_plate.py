"""Plates and strips against closed forms: what the geometry kernel builds, and what its meshes carry."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from mesh_measures import volumes_and_moments

from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.link_tractions import LinkTractions
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.meshing.mesh import mass_properties, mesh_body, reentrant_edges
from alula.geometry.meshing.mesh_settings import COARSE
from alula.geometry.parts.part import Bar, Pin, PlainEnd, Plate, Ring
from alula.loads.records.bearing import WIDE

T = 3.0


def pin(name, x, y, hole, eye=None):
    ring = None if eye is None else Ring(diameter=eye, low=-T / 2, high=T / 2)
    return Pin(name=name, x=x, y=y, diameter=hole, ring=ring)


def plate(*pins, holes=(), pockets=(), eye=10.0, fillet=0.0):
    sizes = {"shape": "plate", "material": "resin", "thickness": f"{T} mm", "eye_diameter": f"{eye} mm"}
    sizes["fillet_radius"] = f"{fillet} mm"
    sizes["holes"] = [{"x": f"{x} mm", "y": f"{y} mm", "diameter": f"{d} mm"} for x, y, d in holes]
    sizes["pockets"] = pockets
    return Body(part=Plate.model_validate(sizes), pins=pins, ends=(), holes=())


TERNARY = (pin("A", 0.0, 0.0, 5.0, 14.0), pin("B", 60.0, 0.0, 4.0, 12.0), pin("C", 22.0, 34.0, 6.0, 16.0))
BETWEEN = (pin("A", 0.0, 0.0, 4.0), pin("M", 25.0, 1e-7, 4.0), pin("B", 50.0, 0.0, 4.0))
INSIDE = (pin("A", 0.0, 0.0, 4.0, 40.0), pin("B", 8.0, -6.0, 3.0, 6.0))
UPRIGHT = (pin("A", 3.0, 0.0, 4.0), pin("B", 3.0, 30.0, 4.0), pin("C", 25.0, 15.0, 4.0))


def properties(circles, holes):
    """Area, centroid and polar second moment about the origin, of a fine polygon on the tangents of the circles."""
    angle = np.linspace(0.0, 2.0 * math.pi, 400_001)[:-1]
    x, y, r = np.array(circles).T[:, :, None]
    # On the tangent with normal θ the hull is touched where the support is largest.
    far = np.argmax(x * np.cos(angle) + y * np.sin(angle) + r, axis=0)
    px, py = x[far, 0] + r[far, 0] * np.cos(angle), y[far, 0] + r[far, 0] * np.sin(angle)
    qx, qy = np.roll(px, -1), np.roll(py, -1)
    cross = px * qy - qx * py
    area, first = cross.sum() / 2.0, np.array([((px + qx) * cross).sum(), ((py + qy) * cross).sum()]) / 6.0
    polar = ((px**2 + px * qx + qx**2 + py**2 + py * qy + qy**2) * cross).sum() / 12.0
    for hx, hy, d in holes:
        own = math.pi * d**2 / 4.0
        area, first = area - own, first - own * np.array([hx, hy])
        polar -= own * (d**2 / 8.0 + hx**2 + hy**2)
    return area, first / area, polar


@pytest.mark.parametrize(
    ("pins", "holes"), [(TERNARY, ()), (TERNARY, ((25.0, 12.0, 14.0),)), (BETWEEN, ()), (INSIDE, ()), (UPRIGHT, ())]
)
def test_mass_properties_are_those_of_the_hull_less_the_holes(pins, holes):
    body = plate(*pins, holes=holes)
    check_body(body)
    found = mass_properties(body)
    circles = [(p.x, p.y, body.ring(p).diameter / 2.0) for p in pins]
    area, centroid, polar = properties(circles, [*((p.x, p.y, p.diameter) for p in pins), *holes])
    assert found.volume == pytest.approx(area * T, rel=1e-7)
    assert found.centroid == pytest.approx([*centroid, 0.0], abs=1e-5)
    assert found.inertia[2, 2] == pytest.approx(T * (polar - area * (centroid**2).sum()), rel=1e-6)


def test_a_waist_takes_circular_segments_off_a_plate():
    """Two eyes of 16 mm, 30 mm apart, and arcs of 20 mm whose centres lie 28 mm from both eyes'."""
    body = plate(pin("A", 0.0, 0.0, 5.0), pin("B", 30.0, 0.0, 5.0), eye=16.0, fillet=20.0)
    check_body(body)
    height = math.sqrt(28.0**2 - 15.0**2)
    angle = math.atan2(height, 15.0)
    # Two circles, and the triangles of the centres less the arcs' sectors and those of the circles.
    area = 2.0 * 64.0 * (math.pi - angle) + 30.0 * height - 400.0 * (math.pi - 2.0 * angle) - 2.0 * math.pi * 2.5**2
    found = mass_properties(body)
    assert found.volume == pytest.approx(area * T, rel=1e-7)
    assert found.centroid == pytest.approx([15.0, 0.0, 0.0], abs=1e-6)
    neck = 2.0 * (height - 20.0)
    assert body.part.frame_section(body).width == pytest.approx(neck)
    mesh = mesh_body(body, COARSE)
    middle = np.abs(mesh.points[:, 0] - 15.0) < 1.0
    assert np.ptp(mesh.points[middle, 1]) == pytest.approx(neck, rel=0.02)


def test_a_slot_in_a_plate_has_an_eye_as_long_as_it_is():
    sliding = Pin(name="S", x=30.0, y=0.0, diameter=4.0, slot=12.0)
    body = plate(pin("A", 0.0, 0.0, 4.0), pin("C", 10.0, 20.0, 4.0), sliding)
    check_body(body)
    area, *_ = properties([(0.0, 0.0, 5.0), (10.0, 20.0, 5.0), (24.0, 0.0, 5.0), (36.0, 0.0, 5.0)], [])
    holes = 3.0 * math.pi * 4.0 + 12.0 * 4.0
    assert mass_properties(body).volume == pytest.approx((area - holes) * T, rel=1e-7)
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["bore:S"] == pytest.approx((math.pi * 4.0 + 24.0) * T, rel=1e-6)
    flat = 4.0 + 0.75 * 6.0
    assert mesh.areas["top:S"] == pytest.approx(math.pi / 4.0 * (flat**2 - 16.0) + 12.0 * (flat - 4.0), rel=1e-6)
    with pytest.raises(CaseError, match=r"holes\[1\] .* a wall of 0 mm to the eye at S"):
        check_body(plate(*body.pins, holes=((30.0, 5.0, 2.0),)))
    with pytest.raises(CaseError, match=r"fillet_radius 60 mm of a plate with a slot .* at S as well; leave it out"):
        check_body(plate(*body.pins, fillet=60.0))


def pocket(*centres, radius, depth, **changes):
    sizes = {"centres": [[f"{x} mm", f"{y} mm"] for x, y in centres], "radius": f"{radius} mm", "depth": f"{depth} mm"}
    return sizes | changes


@pytest.mark.parametrize("side", ["top", "bottom", "both"])
def test_pockets_take_their_volume_where_they_are(side):
    """A round pocket with a fillet at its floor, and a rounded rectangle with a sharp one."""
    pins, r, d, f = (pin("A", 0.0, 0.0, 4.0), pin("B", 40.0, 0.0, 4.0), pin("C", 20.0, 30.0, 4.0)), 5.0, 1.2, 0.8
    corners = [(10.0, -1.0), (16.0, -1.0), (16.0, 1.5), (10.0, 1.5)]
    cut = [
        pocket((20.0, 14.0), radius=r, depth=d, side=side, floor_radius=f"{f} mm"),
        pocket(*corners, radius=2.0, depth=0.5, side=side),
    ]
    body = plate(*pins, pockets=cut)
    check_body(body)
    assert body.part.may_be_sharp
    # The fillet leaves (1 - π/4) f² of the corner, whose centroid is (10 - 3π)/(12 - 3π) f from either side (Pappus).
    left, off = (1.0 - math.pi / 4.0) * f**2, (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi) * f
    ring = left * 2.0 * math.pi * (r - off)
    round_one, flat = math.pi * r**2 * d, (6.0 * 2.5 + 2.0 * 2.0 * (6.0 + 2.5) + math.pi * 4.0) * 0.5
    number = 2.0 if side == "both" else 1.0
    area, *_ = properties([(p.x, p.y, 5.0) for p in pins], [(p.x, p.y, 4.0) for p in pins])
    volume = area * T - number * (round_one - ring + flat)
    found = mass_properties(body)
    assert found.volume == pytest.approx(volume, rel=1e-6)
    moment = round_one * (T - d) / 2.0 - ring * (T / 2.0 - d + off) + flat * (T - 0.5) / 2.0
    sense = {"top": -1.0, "bottom": 1.0, "both": 0.0}[side]
    assert found.centroid[2] == pytest.approx(sense * moment / volume, abs=1e-5)


def test_a_mesh_has_its_pockets_and_their_sharp_edges():
    cut = [pocket((12.0, 0.0), (22.0, 0.0), radius=2.5, depth=1.0, side="both")]
    body = plate(pin("A", 0.0, 0.0, 4.0), pin("B", 40.0, 0.0, 4.0), pockets=cut)
    mesh = mesh_body(body, COARSE)
    assert volumes_and_moments(mesh.points, mesh.cells)[0].sum() == pytest.approx(
        mass_properties(body).volume, rel=2e-3
    )
    edges = reentrant_edges(body)
    assert len(edges) == 8  # a round end and a side are two edges each, above and below
    assert {round(abs(float(edge.points[:, 2].mean())), 6) for edge in edges} == {0.5}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"depth": "2.9 mm"},
            r"pockets\[1\].depth 2.9 mm leaves a floor of 0.1 mm.* to 2.85 mm or less, or state a hole",
        ),
        ({"depth": "1.6 mm", "side": "both"}, r"a floor of 0 mm.* to 1.425 mm or less"),
        ({"floor_radius": "1.1 mm"}, r"floor_radius 1.1 mm does not fit.*at most the depth 1 mm"),
        ({"radius": "4.9 mm"}, r"pockets\[1\] of the plate leaves a wall of 0.1 mm to the edge"),
        ({"centres": [["6 mm", "0 mm"], ["20 mm", "0 mm"]]}, r"pockets\[1\].* a wall of 0 mm to the eye at A"),
        ({"centres": [["24 mm", "0 mm"], ["30 mm", "0 mm"]]}, r"holes\[1\] of the plate leaves a wall of 0 mm to pock"),
    ],
)
def test_pockets_that_do_not_fit_are_refused(change, message):
    cut = pocket((15.0, 0.0), (22.0, 0.0), radius=3.0, depth=1.0) | change
    body = plate(pin("A", 0.0, 0.0, 4.0), pin("B", 40.0, 0.0, 4.0), holes=((30.0, 0.0, 3.0),), pockets=[cut])
    with pytest.raises(CaseError, match=message):
        check_body(body)


@pytest.mark.parametrize("fillet", [14.4, 5.0])
def test_the_least_fillet_that_is_named_fits(fillet):
    pins = pin("A", 0.0, 0.0, 5.0), pin("B", 40.0, 0.0, 5.0), pin("C", 20.0, 20.0, 5.0)
    with pytest.raises(CaseError, match=r"fillet_radius .* is too small for the distance of the eyes") as error:
        check_body(plate(*pins, fillet=fillet))
    least = float(re.search(r"to ([\d.]+) mm or more", str(error.value)).group(1))
    check_body(plate(*pins, fillet=least))
    with pytest.raises(CaseError):
        check_body(plate(*pins, fillet=0.999 * least))


@pytest.mark.parametrize("pins", [TERNARY, BETWEEN, INSIDE])
def test_the_mesh_has_its_rings_and_bores(pins):
    body = plate(*pins)
    mesh = mesh_body(body, COARSE)
    assert set(mesh.surfaces) == {f"{kind}:{p.name}" for p in pins for kind in ("bore", "top", "bottom")}
    for p in pins:
        walls = [math.hypot(p.x - o.x, p.y - o.y) - (p.diameter + o.diameter) / 2.0 for o in pins if o is not p]
        flat = p.diameter + 0.75 * min(body.ring(p).diameter - p.diameter, *walls)
        assert mesh.areas[f"bore:{p.name}"] == pytest.approx(math.pi * p.diameter * T, rel=1e-6)
        assert mesh.areas[f"top:{p.name}"] == pytest.approx(math.pi / 4.0 * (flat**2 - p.diameter**2), rel=1e-6)


@pytest.mark.parametrize(
    ("pins", "holes", "message"),
    [
        (TERNARY, ((22.0, 14.0, 30.0),), r"holes\[1\] of the plate leaves a wall of .* mm to the (edge|eye)"),
        (TERNARY, ((22.0, 20.0, 14.0),), r"holes\[1\] of the plate leaves a wall of .* mm to the eye at C"),
        (TERNARY, ((70.0, 30.0, 4.0),), r"holes\[1\].* a wall of 0 mm to the edge of the plate.*move it"),
        (TERNARY, ((20.0, 10.0, 8.0), (28.0, 10.0, 7.9)), r"holes\[1\].* 0.05 mm to holes\[2\], but must leave 0.4 mm"),
        (
            (pin("A", 0.0, 0.0, 4.0), replace(pin("B", 30.0, 0.0, 4.0), ring=Ring(diameter=9.0, low=-2.0, high=2.0))),
            (),
            "eye at B is 4 mm thick, but an eye of a plate is as thick as the plate, 3 mm",
        ),
    ],
)
def test_plates_that_cannot_be_built_are_refused(pins, holes, message):
    with pytest.raises(CaseError, match=message):
        check_body(plate(*pins, holes=holes))


def strip(overhang=6.0, **changes):
    sizes = {"shape": "bar", "material": "resin", "width": "10 mm", "thickness": f"{T} mm", "fillet_radius": "0 mm"}
    sizes |= {"ends": "square", "overhang": f"{overhang} mm"}
    return Bar.model_validate(sizes | changes)


@pytest.mark.parametrize("overhang", [3.0, 6.0])
def test_a_strip_with_square_ends_is_a_box_less_its_holes(overhang):
    body = Body(part=strip(overhang), pins=(pin("A", 0.0, 0.0, 4.0), pin("B", 40.0, 0.0, 5.0)), ends=(), holes=())
    check_body(body)
    assert mass_properties(body).volume == pytest.approx(
        T * ((40.0 + 2.0 * overhang) * 10.0 - math.pi / 4.0 * (16.0 + 25.0)), rel=1e-7
    )
    mesh = mesh_body(body, COARSE)
    eye = min(10.0, 2.0 * overhang)
    flat = 4.0 + 0.75 * (eye - 4.0)
    assert mesh.areas["top:A"] == pytest.approx(math.pi / 4.0 * (flat**2 - 16.0), rel=1e-6)
    assert np.ptp(mesh.points[:, 0]) == pytest.approx(40.0 + 2.0 * overhang)


@pytest.mark.parametrize(
    ("overhang", "message"), [(1.9, "less than 2 overhang 3.8 mm; .* increase overhang"), (9.0, "width")]
)
def test_a_hole_that_reaches_the_end_or_the_sides_is_refused(overhang, message):
    hole = 4.0 if overhang < 4.0 else 10.0
    body = Body(part=strip(overhang), pins=(pin("A", 0.0, 0.0, hole), pin("B", 40.0, 0.0, 3.0)), ends=(), holes=())
    with pytest.raises(CaseError, match=message):
        check_body(body)


def test_an_eye_of_its_own_on_a_bar_adds_its_own_volume():
    sizes = {"shape": "bar", "material": "resin", "width": "8 mm", "thickness": "3 mm", "fillet_radius": "0 mm"}
    part = Bar.model_validate(sizes | {"eye_diameter": "8 mm"})
    own = Pin(name="B", x=40.0, y=0.0, diameter=5.0, ring=Ring(diameter=14.0, low=-3.0, high=3.0))
    body = Body(part=part, pins=(pin("A", 0.0, 0.0, 4.0), own), ends=(), holes=())
    check_body(body)
    # A strip with one round end, up to the other eye's circle; x is where the strip's sides meet it.
    x, angle = math.sqrt(49.0 - 16.0), math.asin(4.0 / 7.0)
    segment = 49.0 * angle - 4.0 * x  # of the circle, beyond that chord, within the strip
    area = 8.0 * (40.0 - x) - segment + math.pi * 16.0 / 2.0 - math.pi * 4.0
    volume = 3.0 * area + 6.0 * math.pi * (49.0 - 6.25)
    assert mass_properties(body).volume == pytest.approx(volume, rel=1e-7)


def test_a_load_enters_a_plate_within_a_circle_on_both_faces():
    """A plate thicker than its eyes are wide: its sides are closer to the point than its faces are."""
    ends = (PlainEnd(name="W", x=20.0, y=-15.0, patch=2.0),)
    body = replace(plate(pin("A", 0.0, 0.0, 1.0), pin("B", 40.0, 0.0, 1.0), eye=2.9), ends=ends)
    check_body(body)
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["end:W"] == pytest.approx(2.0 * math.pi * 1.0**2, rel=1e-6)
    area, *_ = properties([(0.0, 0.0, 1.45), (40.0, 0.0, 1.45), (20.0, -15.0, 1.45)], [(0, 0, 1.0), (40, 0, 1.0)])
    assert mass_properties(body).volume == pytest.approx(area * T, rel=1e-7)
    load = LinkLoads(
        name="hung",
        pins=tuple(
            PinLoad(name=n, centre=np.array([x, 0.0, 0.0]), diameter=1.0, wrench=np.array([0.0, f, 0.0, 0.0, 0.0, 0.0]))
            for n, x, f in (("A", 0.0, 3.0), ("B", 40.0, 3.0))
        ),
        ends=(EndLoad(name="W", point=np.array([20.0, -15.0, 0.0]), wrench=np.array([0.0, -6.0, 0.0, 0.0, 0.0, 0.0])),),
    )
    space = displacement_space(mesh)
    pose = load.chosen(None)
    (variant,) = LinkTractions.of(space, [pose], density=0.0).variants(pose, (WIDE,), ())
    force = variant.load.reshape(-1, 3)
    loaded = np.unique(space.faces("end:W"))
    assert force[loaded].sum(axis=0) == pytest.approx([0.0, -6.0, 0.0], abs=1e-9)
    assert np.cross(space.nodes, force).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
