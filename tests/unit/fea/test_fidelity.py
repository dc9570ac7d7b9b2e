"""The cheapest model that decides: which one does, and that hand calculation is silent where it was not calibrated."""

import math
from dataclasses import replace
from types import SimpleNamespace

import eye_link
import pytest
from edited_cases import edited

from alula.fea.beam.calibration import calibrations
from alula.fea.beam.critical_locations import critical_locations, shoulder_factors
from alula.fea.check import deciding
from alula.fea.check.run import check_case
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.links.fidelity import decide, decided_by_hand, hand_bands
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.refinement import START, Effort
from alula.fea.solid.layers import Layers, in_worst_direction
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import HoleRow
from alula.loads.records.bearing import CONTACT_SHORTFALL
from alula.reports.sentences import told


def decided(limit):
    task = eye_link.task(limit)
    beams = {"AC": {"mixed": eye_link.beam(task)}}
    return decide({"AC": task}, beams, START, Effort(), fidelity="auto", threads=1)["AC"]


def test_a_limit_far_off_is_decided_by_hand_without_a_mesh():
    found = decided(40.0)
    assert (found.decision.model, found.solid) == ("beam", None)
    assert "clear of the limit 40 MPa" in told(found.decision.why)
    assert "at most at the eye at B" in told(found.decision.why)
    assert "elements" in told(found.decision.next_cost)
    assert found.hands["mixed"].von_mises.high < 40.0


def test_a_limit_far_below_fails_by_hand():
    assert decided(2.0).decision.model == "beam"


@pytest.mark.converged
def test_what_hand_calculation_leaves_open_a_solid_decides():
    found = decided(18.0)
    assert found.decision.model == "solid"
    assert "the limit, 18 MPa, lies inside, so finite elements decided" in told(found.decision.why)
    precision = found.solid.precision[0]
    # 7.464 MPa: on 169,000 elements, ten times finer at the peak than the first mesh; 7.466 MPa on 62,000.
    assert precision.low("von_mises") < 7.464 < precision.high("von_mises") < 18.0


def test_frame_is_another_name_of_beam():
    """A structure whose joint forces a frame gives, whichever name was asked for."""
    case = edited("owl-wing-static", ["joint_model=bonded"], fits=False)
    beam, frame = (check_case(case, name="owl-wing-static", fidelity=name) for name in ("beam", "frame"))
    for title, found in frame.load_cases.items():
        assert "frame" in found.forces.model
        assert found.checks == beam.load_cases[title].checks
        for link, result in found.links.items():
            other = beam.load_cases[title].links[link]
            assert (result.decided_by, result.why) == (other.decided_by, other.why)
            assert (result.von_mises_max, result.displacement_max) == (other.von_mises_max, other.displacement_max)
    assert "beam" in {result.decided_by for found in frame.load_cases.values() for result in found.links.values()}


def test_contact_widens_the_hand_bands_of_eyes_alone():
    task = eye_link.task()
    band = hand_bands(task, task.loads[0], eye_link.beam(task))
    factors = calibrations()["tube"].von_mises
    assert sorted(row.location.kind for row in band.locations) == ["eye", "eye", "eye", "section"]
    for row in band.locations:
        contact = 1.0 / (1.0 - CONTACT_SHORTFALL) if row.location.kind == "eye" else 1.0
        assert row.von_mises.high == pytest.approx(contact * factors[row.location.kind].high * row.location.estimate)


def test_a_limit_within_the_band_is_not_decided_by_hand():
    task = eye_link.task(9.0)
    decision, why = decided_by_hand(task, [hand_bands(task, task.loads[0], eye_link.beam(task))])
    assert decision is None
    assert "the limit, 9 MPa, lies inside" in told(why)


@pytest.mark.parametrize(("ends", "by_hand"), [((15.0, 40.0), False), ((4.0, 40.0), True), ((39.0, 41.0), True)])
def test_what_doubts_leave_open_by_hand_is_left_to_a_solid_that_may_decide(ends, by_hand):
    """By hand the stress is 4.5 to 19.6 MPa: partly in the first range, wholly in the second, clear of the third."""
    task = replace(eye_link.task(40.0), open_ranges={"mixed": OpenRanges(limits={"von_mises": (ends,)})})
    hand = hand_bands(task, task.loads[0], eye_link.beam(task))
    assert 4.0 < hand.von_mises.low < 15.0 < hand.von_mises.high < 39.0
    assert (decided_by_hand(task, [hand])[0] is not None) is by_hand
    bare = replace(task, open_ranges={})  # as where solids may hold the linkage
    assert decided_by_hand(bare, [hand])[0] is not None
    assert (decided_by_hand(bare, [hand], task.open_ranges)[0] is not None) is by_hand
    less = replace(task, open_ranges={"mixed": OpenRanges(limits={"von_mises": ((39.0, 40.0),)})})  # so of its solid
    assert (decided_by_hand(less, [hand], task.open_ranges)[0] is not None) is (ends[0] > 15.0)


def two_loads(*, light_first, **changed):
    """The task under its loads and under half of them, and what is known of both by hand."""
    task = replace(eye_link.task(60.0), **changed)
    [heavy] = task.loads
    light = replace(heavy, name="light", pins=tuple(replace(pin, wrench=pin.wrench / 2.0) for pin in heavy.pins))
    task = replace(task, loads=(light, heavy) if light_first else (heavy, light))
    return task, [hand_bands(task, one, eye_link.beam(replace(task, loads=(one,)))) for one in task.loads]


@pytest.mark.parametrize("light_first", [True, False])
def test_what_is_told_of_a_link_that_is_clear_is_the_worst_of_its_loads(light_first):
    task, hands = two_loads(light_first=light_first)
    worst = hands[1 if light_first else 0].von_mises
    decision, _ = decided_by_hand(task, hands)
    assert decision.why["ends"] == (worst.low, worst.high)


@pytest.mark.parametrize("light_first", [True, False])
def test_layers_are_open_by_hand_where_any_limit_is_reached_under_any_loads(light_first):
    """At the least that scatter makes of it, of the ranges of the loads where causes have some."""
    layers = Layers(normal=(0.0, 0.0, 1.0), across=20.0, between=15.0)
    task, hands = two_loads(light_first=light_first, layers=layers)
    most = max(in_worst_direction(one.principal.high, one.von_mises.high, 20.0 / 15.0) for one in hands)
    low, near, far = (0.6 * most, 1.1 * most), (0.9 * most, 1.1 * most), (1.1 * most, 1.2 * most)

    def is_open(limits, ranges=None, of=task):
        every = {name: OpenRanges(limits={"layers": one}) for name, one in (ranges or {}).items()}
        decision, why = decided_by_hand(replace(of, layer_limits=limits), hands, every)
        assert decision or why == reason("layers_open_by_hand")
        return decision is None

    assert [is_open(one) for one in ((far,), (far, near), (near, far), (low,))] == [False, True, True, True]
    assert [is_open((far,), {"mixed": (one,)}) for one in (far, near)] == [False, True]
    assert not is_open((near,), {"mixed": (far,)})  # the lighter loads stay clear of what the task says
    assert is_open((far,), of=replace(task, layers=replace(layers, between=None)))


def test_a_link_keeps_to_the_least_error_that_points_of_any_load_case_want(monkeypatch):
    wanted = {"a": {"crank": 0.1, "rocker": 0.3}, "b": {"crank": 0.2, "rocker": 0.05}, "c": {"coupler": 0.4}}
    monkeypatch.setattr(deciding, "asked", lambda *_, **__: [True])
    monkeypatch.setattr(deciding, "meshes_to_refine", lambda case, name, *_: wanted[name])
    load_cases = [
        SimpleNamespace(case=None, load_case=name, moved=None, links=lambda _: None, free=None, forces=None)
        for name in wanted
    ]
    assert deciding._wanted(load_cases, {}) == {"crank": 0.1, "rocker": 0.05, "coupler": 0.4}


def test_permanent_set_is_read_at_the_stated_load_whatever_else_it_may_be(monkeypatch):
    """Growth near buckling may put all that a load may be above what is stated, and strength below it."""
    ends = {
        "crank": Scatter(low=1.2, high=1.5),
        "rocker": Scatter(low=0.6, high=0.8),
        "coupler": Scatter(low=0.9, high=1.1),
    }
    monkeypatch.setattr(deciding, "asks", lambda *_: True)
    monkeypatch.setattr(deciding, "adds_to_set", lambda *_: True)
    monkeypatch.setattr(deciding, "ends_of_load", lambda case, link, *_: ends[link])
    one = SimpleNamespace(case=None, load_case="l", doubts_on=lambda *_: (None, None))
    here = SimpleNamespace(case=None, load_cases=[one])
    found = deciding.Deciding._set_factors(here, {"l": dict.fromkeys(ends)}, {"l": {}})
    expected = {"crank": (1.0, 1.5), "rocker": (0.6, 1.0), "coupler": (0.9, 1.1)}
    assert found == {("l", link): factors for link, factors in expected.items()}


def test_where_solids_may_hold_the_linkage_a_solid_settles_doubts_too(monkeypatch):
    """Meshes are made finer all the same there: tasks have no ranges, and doubts have, of each load case that holds."""
    seen = {}

    def decided(tasks, *_, doubted, **more):
        seen.update({link: (set(task.open_ranges), set(doubted[link])) for link, task in tasks.items()})
        raise CannotRunError("seen")

    monkeypatch.setattr(deciding, "decide", decided)
    for case, firm in (("finger", set()), ("knee", {"heel-strike", "late-stance"})):
        seen.clear()
        case = edited(case, [])
        with pytest.raises(CannotRunError, match="seen"):
            check_case(case)
        assert set(seen) == set(case.checked_links)
        assert all(ranges == (firm, set(case.load_cases)) for ranges in seen.values())


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"fillet_radius": 0.0}, "sharp"),
        ({"fillet_radius": 0.2}, "fillet over width 0.04 is outside the calibrated range 0.1"),
        ({"inner_diameter": 4.5}, "inner over outer diameter 0.9"),
    ],
)
def test_hand_calculation_says_nothing_outside_of_its_calibration(change, says):
    task = eye_link.task(40.0)
    other = replace(task, body=replace(task.body, part=task.body.part.model_copy(update=change)))
    hand = hand_bands(other, other.loads[0], eye_link.beam(other))
    assert says in told(hand.outside)
    assert hand.von_mises.unknowable
    assert decided_by_hand(other, [hand])[0] is None


def test_every_shape_is_calibrated_with_factors_in_order():
    assert set(calibrations()) == {"tube", "bar"}
    for found in calibrations().values():
        every = [*found.von_mises.values(), *found.principal.values(), found.displacement]
        assert len(every) == 9
        assert all(0.0 < f.low <= f.typical <= f.high for f in every)
        assert found.margin > 1.0
        assert found.parts >= 6


def test_a_cross_hole_bears_the_handbooks_factors():
    """Under the section's N and M_z of a hole along y, with the factors and torsion written out by hand."""
    task = eye_link.task()
    row = HoleRow(count=1, diameter="1 mm", first="20 mm", last="20 mm", along="y")
    beam = eye_link.beam(task)
    found = critical_locations(
        replace(task.body, holes=(row,)), task.loads[0].chosen(None), beam.forces.state(None), task.nu
    )
    [hole] = [s for s in found if s.kind == "hole"]
    r, h = 0.5, 0.2
    tension = 3.0 + (0.427 - 6.770 * r + 22.698 * r**2 - 16.670 * r**3) * h
    tension += (11.357 + 15.665 * r - 60.929 * r**2 + 41.501 * r**3) * h**2
    bending = 3.0 + (-6.250 - 0.585 * r + 3.115 * r**2) * h + (41.000 - 1.071 * r - 6.746 * r**2) * h**2
    bending += (-45.000 + 1.389 * r + 13.889 * r**2) * h**3
    area, second = math.pi * (5.0**2 - 2.5**2) / 4.0, math.pi * (5.0**4 - 2.5**4) / 64.0
    expected = tension * 6.0 / area + bending * 40.0 * 2.5 / second + 4.0 * 5.0 * 2.5 / (2.0 * second)
    assert hole.estimate == pytest.approx(expected, rel=1e-9)


def test_shoulder_factors_are_the_handbooks():
    """Peterson, 3rd ed., charts 3.4, 3.10 and 3.12: D/d = 1.5, r/d = 0.25, hence h/r = 1 and 2h/D = 1/3, by hand."""
    s = 1.0 / 3.0
    tension = 1.984 - 2.063 * s + 1.931 * s**2 - 0.855 * s**3
    bending = 2.022 - 2.468 * s + 2.091 * s**2 - 0.648 * s**3
    torsion = 1.613 - 1.853 * s + 2.052 * s**2 - 0.804 * s**3
    assert shoulder_factors(4.0, 1.0, 1.0) == pytest.approx((tension, bending, torsion), rel=1e-12)


def test_shoulder_factors_of_a_small_fillet_go_on_to_a_step_of_twenty_radii():
    """h/r = 9 and 2h/D = 0.6, root 3: tension and bending by hand; torsion stays at the source's end, h/r = 4."""
    tension, bending, torsion = shoulder_factors(4.0, 3.0, 1.0 / 3.0)
    assert tension == pytest.approx(3.582 - 3.185 * 0.6 + 2.225 * 0.36 - 1.631 * 0.216)
    assert bending == pytest.approx(3.656 - 3.249 * 0.6 + 0.640 * 0.36 - 0.029 * 0.216)
    assert torsion == shoulder_factors(4.0, 3.0, 0.75)[2]
    assert shoulder_factors(4.0, 3.0, 0.15) == pytest.approx(shoulder_factors(4.0, 3.0, 0.1))
    assert shoulder_factors(4.0, 3.0, 0.2)[1] > bending
