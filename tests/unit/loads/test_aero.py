"""Air loads: forces from coefficients and back, directions, gates, and spreads that keep resultant and moment."""

import math
import tomllib

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, read_text, validate
from alula.loads.records.aero import AirLoad, air_forces, air_loads, check_air, shares
from alula.loads.records.applied import LineLoad, PointLoad
from alula.loads.states.actions import acting_loads

POINTS = {"a": {"P": (0.0, 0.0), "Q": (120.0, 0.0), "M": (40.0, 0.0)}, "b": {"Q": (10.0, 0.0), "R": (90.0, 0.0)}}
STREAM = {"speed": "22 m/s", "density": "1.225 kg/m^3", "area": "0.05 m^2"}
ALL_OF_A = [{"link": "a", "start": "P", "end": "Q"}]


def air(spread=ALL_OF_A, **entries):
    base = {"stream": (0.0, 0.0, 2.0), "lift_direction": (0.0, 3.0, 0.0), "spread": spread}
    return AirLoad.model_validate(base | entries)


def force_and_first_moment(loads, link):
    """Of the loads on a link: total force, and its first moment about x = 0, by quadrature."""
    force, first = np.zeros(3), np.zeros(3)
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for load in loads:
        if load.link != link:
            continue
        if isinstance(load, PointLoad):
            force += load.wrench[:3]
            first += POINTS[link][load.point][0] * load.wrench[:3]
            continue
        assert isinstance(load, LineLoad)
        assert load.start < load.end
        for node, weight in zip(nodes, weights, strict=True):
            part = (1.0 + node) / 2.0
            density = (1.0 - part) * load.at_start + part * load.at_end
            share = weight / 2.0 * (load.end - load.start)
            force += share * density
            first += share * density * (load.start + part * (load.end - load.start))
    return force, first


# ---- forces ------------------------------------------------------------------------------------------------


def test_forces_follow_from_the_dynamic_pressure():
    found = air_forces(air(lift_coefficient=0.5, drag_coefficient=0.1, **STREAM), "air.0")
    q = 1.225 * 22.0**2 / 2.0  # Pa
    assert found.pressure == pytest.approx(q * 1e-6)
    assert found.lift == pytest.approx(q * 0.05 * 0.5)
    assert found.drag == pytest.approx(q * 0.05 * 0.1)
    np.testing.assert_allclose(found.total, [0.0, found.lift, found.drag], atol=1e-12)
    assert not found.given
    assert found.warnings == ()


def test_given_forces_imply_their_coefficients():
    stated = air_forces(air(lift_coefficient=0.5, drag_coefficient=0.1, **STREAM), "air.0")
    back = air_forces(air(lift=f"{stated.lift!r} N", drag=f"{stated.drag!r} N", **STREAM), "air.0")
    assert back.given
    assert back.coefficients == pytest.approx((0.5, 0.1))


def test_forces_alone_have_no_coefficients():
    found = air_forces(air(lift="3 N", drag="1 N"), "air.0")
    assert found.coefficients is None
    assert found.pressure is None
    assert (found.lift, found.drag) == (3.0, 1.0)


def test_lift_towards_a_side_is_normal_to_the_stream():
    angle = math.radians(60.0)
    stream = (0.0, -math.cos(angle), math.sin(angle))
    spec = air(stream=stream, lift_direction=None, lift_towards=(0.0, 0.0, 1.0), lift="1.2 N", drag="2.0785 N")
    found = air_forces(spec, "air.0")
    np.testing.assert_allclose(found.lift_direction, [0.0, math.sin(angle), math.cos(angle)], atol=1e-12)
    assert found.lift_direction @ found.drag_direction == pytest.approx(0.0, abs=1e-12)


def test_the_force_on_a_plate_stands_normal_to_it():
    angle = math.radians(60.0)
    spec = air(
        stream=(0.0, -math.cos(angle), math.sin(angle)),
        lift_direction=None,
        lift_towards=(0.0, 0.0, 1.0),
        lift_coefficient=1.2 * math.cos(angle),
        drag_coefficient=1.2 * math.sin(angle),
        **STREAM,
    )
    normal = 1.225 * 22.0**2 / 2.0 * 0.05 * 1.2
    np.testing.assert_allclose(air_forces(spec, "air.0").total, [0.0, 0.0, normal], atol=1e-9)


def test_negative_lift_pushes_the_other_way():
    assert air_forces(air(lift="-3 N", drag="1 N"), "air.0").total == pytest.approx([0.0, -3.0, 1.0])


# ---- gates -------------------------------------------------------------------------------------------------

GATES = [
    (
        {"lift_coefficient": 2.01, "drag_coefficient": 0.2, **STREAM},
        "it is 2.01, but the largest plausible one is 2 ",
    ),
    (
        {"lift_coefficient": -2.01, "drag_coefficient": 0.2, **STREAM},
        "it is -2.01, but the largest plausible one is 2 ",
    ),
    ({"lift": "50 N", "drag": "5 N", **STREAM}, "lift 50 N over q S implies 3.37"),
    ({"lift_coefficient": 0.5, **STREAM, "speed": None}, r"air\.0\.speed: it is missing"),
    ({"lift_coefficient": 0.5, **STREAM, "density": None}, r"air\.0\.density: it is missing"),
    ({"drag_coefficient": 0.5, **STREAM, "area": None}, r"air\.0\.area: it is missing"),
    ({"lift": "1 N", "lift_coefficient": 0.5, **STREAM}, "both a force and a coefficient"),
    ({}, "neither lift nor drag"),
    ({"lift": "1 N", "lift_direction": None}, "lift_direction: it is missing"),
    ({"lift": "1 N", "lift_direction": (0.0, 1.0, 1.0)}, "45 deg from the stream"),
    ({"lift": "1 N", "lift_towards": (0.0, 1.0, 1.0)}, "both stated"),
    ({"lift": "1 N", "lift_direction": None, "lift_towards": (0.0, 0.0, 1.0)}, "parallel to the stream"),
    ({"drag": "1 N", "stream": (0.0, 0.0, 0.0)}, "it is zero and has no direction"),
]


@pytest.mark.parametrize(("entries", "words"), GATES)
def test_what_no_stream_does_is_refused(entries, words):
    with pytest.raises(CaseError, match=words):
        air_forces(air(**entries), "air.0")


def test_gates_at_their_edges():
    assert air_forces(air(lift_coefficient=2.0, drag_coefficient=0.1, **STREAM), "air.0").warnings == ()
    equal = air_forces(air(lift="1 N", drag="1 N"), "air.0")
    assert equal.warnings == ()
    assert "exceeds the lift (0.99 N)" in air_forces(air(lift="0.99 N", drag="1 N"), "air.0").warnings[0]
    assert "none is stated" in air_forces(air(drag="1 N"), "air.0").warnings[0]
    assert "ratio is 20.1" in air_forces(air(lift="20.1 N", drag="1 N"), "air.0").warnings[0]
    assert "ratio is infinite" in air_forces(air(lift="1 N"), "air.0").warnings[0]


# ---- spreads -----------------------------------------------------------------------------------------------


def test_an_even_spread_is_one_line():
    spec = air(lift="3 N", drag="1 N")
    [line] = air_loads(spec, "air.0", POINTS)
    assert isinstance(line, LineLoad)
    np.testing.assert_allclose(line.at_start * 120.0, [0.0, 3.0, 1.0])
    np.testing.assert_array_equal(line.at_start, line.at_end)


@pytest.mark.parametrize("ends", [("P", "Q"), ("Q", "P")])
def test_a_quarter_ellipse_keeps_force_and_moment(ends):
    spec = air(lift="3 N", drag="1 N", spread=[{"link": "a", "start": ends[0], "end": ends[1], "shape": "elliptic"}])
    loads = air_loads(spec, "air.0", POINTS)
    assert len(loads) > 1
    force, first = force_and_first_moment(loads, "a")
    total = np.array([0.0, 3.0, 1.0])
    np.testing.assert_allclose(force, total, rtol=1e-13)
    centroid = 4.0 * 120.0 / (3.0 * math.pi)  # of a quarter ellipse, from its root
    from_left = centroid if ends == ("P", "Q") else 120.0 - centroid
    np.testing.assert_allclose(first, total * from_left, rtol=1e-12)


def test_the_pieces_follow_the_ellipse():
    spec = air(lift="1 N", drag="0.5 N", spread=[{"link": "a", "start": "P", "end": "Q", "shape": "elliptic"}])
    peak = 4.0 / (math.pi * 120.0)
    lines = air_loads(spec, "air.0", POINTS)
    assert (lines[0].start, lines[-1].end) == (0.0, 120.0)
    for line in lines:
        assert isinstance(line, LineLoad)
        middle = (line.start + line.end) / 2.0
        true = peak * math.sqrt(1.0 - (middle / 120.0) ** 2)
        assert (line.at_start[1] + line.at_end[1]) / 2.0 == pytest.approx(true, rel=0.07)  # the tip is the roundest
        assert line.at_start[1] > line.at_end[1] > 0.0


def test_one_ellipse_over_two_links():
    spread = [
        {"link": "a", "start": "P", "end": "Q", "shape": "elliptic", "span": (0.0, 0.6)},
        {"link": "b", "start": "Q", "end": "R", "shape": "elliptic", "span": (0.6, 1.0)},
    ]
    spec = air(lift="3 N", drag="1 N", spread=spread)
    # 120 mm and 80 mm are 0.6 and 0.4 of one span: the areas under one ellipse.
    inner = (0.6 * 0.8 + math.asin(0.6)) / (math.pi / 2.0)
    assert shares(spec, POINTS) == pytest.approx((inner, 1.0 - inner))
    loads = air_loads(spec, "air.0", POINTS)
    for link, share, (e0, e1), x0 in (("a", inner, (0.0, 0.6), 0.0), ("b", 1.0 - inner, (0.6, 1.0), 10.0)):
        force, first = force_and_first_moment(loads, link)
        np.testing.assert_allclose(force, share * np.array([0.0, 3.0, 1.0]), rtol=1e-12)
        e = np.linspace(e0, e1, 200_001)
        w = np.sqrt(1.0 - e * e)
        centroid = float((e * w).sum() / w.sum())
        assert first[1] / force[1] == pytest.approx(x0 + (centroid - e0) * 200.0, rel=1e-5)


def test_the_ellipse_is_shared_by_the_span_not_by_lengths():
    """Links of 120 and 80 mm bear half of the span each: the inner half has 1/3 + sqrt(3)/(2 pi) of the area."""
    spread = [
        {"link": "b", "start": "R", "end": "Q", "shape": "elliptic", "span": (1.0, 0.5)},  # from tip to middle
        {"link": "a", "start": "P", "end": "Q", "shape": "elliptic", "span": (0.0, 0.5)},
    ]
    spec = air(lift="3 N", drag="1 N", spread=spread)
    check_air(spec, "air.0")
    inner = 1.0 / 3.0 + math.sqrt(3.0) / (2.0 * math.pi)
    assert shares(spec, POINTS) == pytest.approx((1.0 - inner, inner))
    loads = air_loads(spec, "air.0", POINTS)
    # First moments over the span of 1: (1 - 0.75^1.5)/3 inside and 0.75^1.5/3 outside, of an area of pi/4.
    for link, share, first, x0, scale, start in (
        ("a", inner, (1.0 - 0.75**1.5) / 3.0, 0.0, 240.0, 0.0),
        ("b", 1.0 - inner, 0.75**1.5 / 3.0, 10.0, 160.0, 0.5),
    ):
        force, moment = force_and_first_moment(loads, link)
        np.testing.assert_allclose(force, share * np.array([0.0, 3.0, 1.0]), rtol=1e-12)
        centroid = first / (math.pi / 4.0 * share)
        assert moment[1] / force[1] == pytest.approx(x0 + (centroid - start) * scale, rel=1e-12)


@pytest.mark.parametrize(
    ("second", "words"),
    [
        ({"shape": "uniform"}, ["air.0.spread:", "uniform and elliptic", "state every share"]),
        ({"shape": "elliptic", "span": (1.0, 0.4)}, ["air.0.spread.1.span", "overlaps", "air.0.spread.0", "share"]),
    ],
)
def test_patches_that_are_not_one_ellipse_need_shares(second, words):
    spread = [
        {"link": "a", "start": "P", "end": "Q", "shape": "elliptic", "span": (0.0, 0.5)},
        {"link": "b", "start": "Q", "end": "R", **second},
    ]
    with pytest.raises(CaseError) as error:
        check_air(air(lift="3 N", drag="1 N", spread=spread), "air.0")
    assert all(word in str(error.value) for word in words)
    stated = [{**patch, "share": share} for patch, share in zip(spread, (0.6, 0.4), strict=True)]
    check_air(air(lift="3 N", drag="1 N", spread=stated), "air.0")


def test_stated_shares_and_points():
    spread = [{"link": "a", "at": "M", "share": 0.25}, {"link": "b", "start": "Q", "end": "R", "share": 0.75}]
    loads = air_loads(air(lift="4 N", drag="1 N", spread=spread), "air.0", POINTS)
    for link, share, x in (("a", 0.25, 40.0), ("b", 0.75, 50.0)):
        force, first = force_and_first_moment(loads, link)
        np.testing.assert_allclose(force, share * np.array([0.0, 4.0, 1.0]))
        np.testing.assert_allclose(first, x * force)


# ---- in a case ---------------------------------------------------------------------------------------------

FLIGHT = "owl-wing-flight"
COMPLETE = "load_cases.complete.air.0"
BAD = [
    (f"{COMPLETE}.lift_coefficient=2.5", [f"{COMPLETE}.lift_coefficient", "2.5", "plausible one is 2 ", "correct"]),
    (f"{COMPLETE}.drag_coefficient=2.5", [f"{COMPLETE}.drag_coefficient", "2.5", "plausible one is 2.3", "correct"]),
    ('load_cases.as-published.air.0.drag="50 N"', ["as-published.air.0.drag_coefficient", "drag 50 N", "implies 3.29"]),
    (f"{COMPLETE}.drag_coefficient=-0.1", [f"{COMPLETE}.drag_coefficient", "-0.1", "at least 0"]),
    (f"{COMPLETE}.speed=22", [f"{COMPLETE}.speed", "22", "unit", "22 m/s"]),
    (f"{COMPLETE}.speed=22 kg", [f"{COMPLETE}.speed", "22 kg", "not a unit of speed"]),
    (f"{COMPLETE}.area=0.05 m", [f"{COMPLETE}.area", "not a unit of area"]),
    (f"{COMPLETE}.spread.0.link=XX", [f"{COMPLETE}.spread.0.link", "'XX'", "not a moving link"]),
    (f"{COMPLETE}.spread.0.start=X", [f"{COMPLETE}.spread.0", "'CF' has no point 'X'", "F, B, C"]),
    (f"{COMPLETE}.spread.0.end=F", [f"{COMPLETE}.spread.0", "same station"]),
    (f"{COMPLETE}.spread.0.at=B", [f"{COMPLETE}.spread.0", "either the point 'at' or both"]),
    (f"{COMPLETE}.spread.0.share=0.5", [f"{COMPLETE}.spread", "some shares are stated", "state all or none"]),
    (f"{COMPLETE}.spread.0.span=[0.5, 0.5]", [f"{COMPLETE}.spread.0.span", "two different places"]),
    (f'{COMPLETE}.spread=[{{link="CF", at="B"}}]', [f"{COMPLETE}.spread.0.share", "state every share"]),
    (f'{COMPLETE}.spread=[{{link="CF", at="B", share=0.5}}]', [f"{COMPLETE}.spread", "sum to 0.5, not to 1"]),
    (f"{COMPLETE}.stream=[1.0, 0.0]", [f"{COMPLETE}.stream", "too few values"]),
    ("load_cases.as-published.forces.0.at=X", ["load_cases.as-published.forces.0", "'CH' has no point 'X'"]),
    ("carried.0.link=XX", ["carried.0.link", "'XX'", "not a moving link"]),
]


@pytest.mark.parametrize(("override", "words"), BAD)
def test_one_sentence_for_what_is_wrong(override, words):
    with pytest.raises(CaseError) as caught:
        read_case(FLIGHT, [override])
    text = str(caught.value)
    assert caught.value.exit_status == 2
    assert text.isprintable()
    for word in words:
        assert word in text


def test_a_weight_without_any_part_is_refused():
    data = tomllib.loads(read_text(FLIGHT)[0]) | {"layer_spacing": "0 mm"}
    for link in data["links"].values():
        link.pop("part", None)
    del data["carried"], data["checks"]
    with pytest.raises(CaseError, match=r"load_cases\.complete\.own_weight: link 'GF' has neither a part nor a mass"):
        validate(data)


def test_the_loads_of_a_case_are_its_air_forces():
    case = read_case(FLIGHT)
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["planform"], pose.placement, {})
    total = sum(load.resultant(pose.placement)[:3] for load in loads)
    [air_force] = case.air_forces("planform")
    np.testing.assert_allclose(total, air_force.total + np.array([0.0, 0.0, -0.25]), atol=1e-12)
