"""How far a point moves: the band beside the frame's answer against solids of links, unit loads and net sections."""

import math
from dataclasses import replace

import numpy as np
import pytest
from edited_cases import edited
from slotted_lever import slotted_lever

from alula.fea.check.run import check_case
from alula.fea.common.source import Source, SourceKind
from alula.fea.frame.build import build_frame
from alula.fea.frame.displacement_band import Zone, bounds, flexibility_ranges, point_bounds, zones
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import NodeLoad
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, Tube
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.states.actions import acting_loads
from alula.reports.sentences import told
from benchmarks.displacement_band import FORCE, Link


def two_pins(part, length: float, first: float, last: float, *holes: HoleRow) -> Body:
    pins = (Pin(name="A", x=0.0, y=0.0, diameter=first), Pin(name="B", x=length, y=0.0, diameter=last))
    return Body(part=part, pins=pins, ends=(), holes=holes)


FLAT = Link(
    body=two_pins(
        Bar(shape="bar", material="any", width="13.99 mm", thickness="4 mm", eye_diameter="14 mm",
            eye_thickness="4 mm", fillet_radius="0 mm"),
        70.0, 5.0, 6.5,
    ),
    young=68900.0,
    poisson=0.33,
)  # fmt: skip
TUBE = Link(
    body=two_pins(
        Tube(shape="tube", material="any", outer_diameter="5 mm", inner_diameter="3 mm", eye_diameter="9 mm",
             eye_thickness="7.5 mm", fillet_radius="1 mm"),
        60.0, 2.5, 2.5,
    ),
    young=2400.0,
    poisson=0.38,
)  # fmt: skip


def test_a_flat_bar_pulled_at_two_holes_gives_more_than_its_plain_section() -> None:
    """F L/(E A) is 0.01542 mm at 850 N; on a fine mesh the two bores' mean motion was 0.01912 mm apart."""
    plain, low, high = FLAT.band(0)
    assert plain * 8.5 == pytest.approx(0.01543, rel=1e-3)
    assert low * 8.5 < 0.01912 < high * 8.5
    found = FLAT.solids((0,), 2.5)[0]
    assert found[0] * 8.5 == pytest.approx(0.01912, rel=0.01)
    assert low <= min(found)
    assert max(found) <= high
    assert max(found) > 1.5 * plain


def test_a_clamped_tube_with_eyes_gives_less_than_its_plain_section() -> None:
    plain, low, high = TUBE.band(1)
    found = TUBE.solids((1,), 2.5)[1]
    assert low <= min(found)
    assert max(found) <= high
    assert max(found) < 0.95 * plain


@pytest.mark.parametrize(
    ("case", "link", "point"), [(slotted_lever(), "lever", "H"), (read_case("owl-wing-static"), "CH", "H")]
)
def test_virtual_work_of_plain_beams_is_the_frames_displacement(case: Case, link: str, point: str) -> None:
    pose = case.solve_pose()
    title = next(iter(case.load_cases))
    loads = acting_loads(case, case.load_cases[title], pose.placement, {})
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    solution = solve_frame(frame.model)
    bare = tuple(replace(e, load_first=np.zeros(3), load_last=np.zeros(3)) for e in frame.model.elements)
    node = frame.points[link, point]
    for axis in range(3):
        load = NodeLoad(node=node, wrench=np.eye(6)[axis])
        unit = solve_frame(replace(frame.model, elements=bare, loads=(load,)))
        plain = bounds(solution, unit, {}, [])
        moved = float(solution.displacements[node, axis])
        assert plain.low == plain.value == plain.high == pytest.approx(moved, rel=1e-7, abs=1e-12)
    band = point_bounds(case, frame, solution, link, point)
    assert band.low < band.value < band.high
    assert band.value == pytest.approx(float(np.linalg.norm(solution.displacements[node, :3])), rel=1e-7)


@pytest.mark.parametrize(
    ("case", "link", "point"), [(slotted_lever(), "lever", "H"), (read_case("owl-wing-static"), "CH", "H")]
)
def test_a_load_that_is_turned_round_moves_a_point_as_far_the_other_way(case: Case, link: str, point: str) -> None:
    """Least and largest are distances: the end beyond zero of a point that moves down is no least of 0."""
    pose, title = case.solve_pose(), next(iter(case.load_cases))
    loads = acting_loads(case, case.load_cases[title], pose.placement, {})
    turned = tuple(replace(load, wrench=-load.wrench) for load in loads)
    bands = []
    for acting in (loads, turned):
        frame = build_frame(case, pose, acting, held=case.pinned_drive)
        found = point_bounds(case, frame, solve_frame(frame.model), link, point)
        bands.append((found.low, found.value, found.high))
    assert bands[0] == pytest.approx(bands[1], rel=1e-9)
    assert 0.0 < bands[0][0] < bands[0][1]


def test_the_factors_at_a_cross_hole_are_those_of_its_net_section() -> None:
    """By counting what is left of a section of many small squares."""
    part = TUBE.body.part
    row = HoleRow(count=1, diameter="1.2 mm", first="30 mm", last="30 mm", along="y")
    found = next(z for z in zones(replace(TUBE.body, holes=(row,)), 0.0, 60.0) if z.start < 30.0 < z.end)
    side = np.arange(-2.5, 2.5, 0.005) + 0.0025
    y, z = np.meshgrid(side, side, indexing="ij")
    there = (np.hypot(y, z) < 2.5) & (np.hypot(y, z) > 1.5)
    left = there & (np.abs(z) > 0.6)
    for index, weight in ((0, np.ones_like(y)), (4, z**2), (5, y**2)):
        expected = weight[there].sum() / weight[left].sum()
        assert found.most[index] == pytest.approx(expected, rel=0.08)
    assert part.section.area == pytest.approx(there.sum() * 0.005**2, rel=1e-2)


def test_terms_of_opposite_sign_are_each_taken_at_their_worst() -> None:
    """A beam whose tip the load moves up by its first half and down by its second: softer or stiffer, both count."""
    whole, tip = FLAT.frame(1, FORCE), FLAT.frame(1, 1.0)
    soft = Zone(start=0.0, end=70.0, least=0.5 * np.ones(6), most=2.0 * np.ones(6))
    moved = float(whole.displacements[1, 1])
    with_it = bounds(whole, tip, {0: [soft]}, [])
    assert (with_it.low, with_it.value, with_it.high) == pytest.approx((0.5 * moved, moved, 2.0 * moved), rel=1e-9)
    against = bounds(whole, FLAT.frame(1, -1.0), {0: [soft]}, [])
    assert (against.low, against.value, against.high) == pytest.approx((-2.0 * moved, -moved, -0.5 * moved), rel=1e-9)


def test_what_pins_sink_by_is_taken_at_its_worst_though_it_cancels() -> None:
    """The load lifts the tip as the pin sinks at it, and lowers it by what the pin turns at its clamped bore.

    The unit load is a force and a couple, so that the moment at the clamped bore has the other sign: F L times -L.
    """
    whole, length = FLAT.frame(1, FORCE), FLAT.length
    wrench = np.array([0.0, 1.0, 0.0, 0.0, 0.0, -2.0 * length])
    unit = solve_frame(replace(whole.model, loads=(NodeLoad(node=1, wrench=wrench),)))
    plain = bounds(whole, unit, {}, [])
    sink, turn = 1e-5, 1e-5 / length**2
    across, about = sink * np.eye(6)[1], turn * np.eye(6)[5]
    for bores in ([(1, across), (0, about)], [(0, about), (1, across)]):
        found = bounds(whole, unit, {}, bores)
        assert found.value == plain.value
        assert found.low - plain.value == pytest.approx(-FORCE * turn * length**2, rel=1e-9)
        assert found.high - plain.value == pytest.approx(FORCE * sink, rel=1e-9)
    both = bounds(whole, unit, {}, [(0, across + about)])  # one bore that sinks and turns
    assert both.low - plain.value == pytest.approx(-FORCE * turn * length**2, rel=1e-9)
    assert both.high - plain.value == pytest.approx(FORCE * sink, rel=1e-9)


@pytest.mark.parametrize("force", [-1.0, -40.0])
def test_the_check_of_a_point_has_that_band_by_linear_theory_and_on_the_deformed_shape(force: float) -> None:
    case = slotted_lever(force=force)
    (outcome,) = (o for o in check_case(case, fidelity="beam").load_cases["tip"].checks if o.quantity == "displacement")
    band = outcome.value
    assert ("deformed shape" in told(outcome.reason)) == (force < -10.0)
    assert band.low < 0.97 * band.value
    assert band.high > 1.03 * band.value
    assert Source(kind=SourceKind.EYES) in band.sources
    assert math.isfinite(band.high)


def test_without_a_drive_a_link_with_torques_on_its_deformed_shape_has_a_solid() -> None:
    """A slot that has turned leaves a moment at the other pin; no drive says how it enters, and the check crashed."""
    result = check_case(slotted_lever(force=-40.0), fidelity="solid").load_cases["tip"]
    assert result.large_displacement.state == "deformed"
    assert {variant.transfer for variant in result.links["lever"].variants} == {"eye-faces", "bore-shear"}
    assert math.isfinite(result.links["lever"].displacement_max.value)


def test_a_disc_gives_within_its_band() -> None:
    """The ornithopter's crank, clamped at its shaft and pushed at its pin: solids, whichever way the pin presses."""
    case = read_case("ornithopter")
    body, material = case.body("crank"), case.material_of("crank")
    assert [body.part.wall(body, pin) for pin in body.pins] == pytest.approx([3.0 - 1.0, 4.5 - 3.0])
    disc = Link(body=body, young=material.youngs_modulus, poisson=material.poissons_ratio)
    for direction, found in disc.solids((0, 1, 2), 2.0).items():
        _, low, high = disc.band(direction)
        assert low < min(found) <= max(found) < high


@pytest.mark.parametrize("first", ["crank", "rod"])
def test_the_bore_into_which_a_pin_between_layers_is_built_gives_as_any_other(first: str) -> None:
    """Which link of a joint is named first says into which the pin is built, and changes nothing of what bores give."""
    second = {"crank": "rod", "rod": "crank"}[first]
    smooth = [f"joints.{name}.friction=0.0" for name in ("O2", "A", "B", "guide")]
    case = edited("slider-crank", [f'joints.A.links=["{first}","{second}"]', *smooth])
    [name] = case.load_cases
    pose = case.solve_pose()
    frame = build_frame(
        case, pose, acting_loads(case, case.load_cases[name], pose.placement, {}), held=case.pinned_drive
    )
    built_in, _ = frame.pins["A"]
    assert frame.pin_beams["A"] in [i for i, e in enumerate(frame.model.elements) if built_in in e.nodes]
    ranges = flexibility_ranges(case, frame, solve_frame(frame.model))
    # The rod is a strut: N L/(E A) less eyes, and F/(E t) in two bores, by the formulas of the module's text.
    body, force = case.body("rod"), 1.0
    young = case.material_of("rod").youngs_modulus
    sinks = []
    for pin in body.pins:
        outer, inner = body.ring(pin).diameter / 2.0, pin.diameter / 2.0
        mean = (outer + inner) / 2.0
        sinks.append((1.3 + 1.55 * (mean / (outer - inner)) ** 3) * force / (young * body.ring(pin).thickness))
    plain = 140.0 * force / (young * body.part.section.area)
    soft = (
        sum((zone.end - zone.start) * float(zone.most[0]) for zone in zones(body, 0.0, 140.0))
        * force
        / (young * body.part.section.area)
    )
    assert ranges["rod"][1] == pytest.approx((soft + sum(sinks)) / plain, rel=0.03)
