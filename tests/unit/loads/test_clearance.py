"""Gaps between links in layers: closed forms, the bound between poses, and what is refused."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest
from bars_in_layers import bar_on_a_pin, four_bars, parallel_bars

from alula.fea.common.verdict import Verdict
from alula.fea.whole.clearance import clearance_band, clearance_outcomes
from alula.geometry.base.errors import CaseError
from alula.geometry.clearance import least
from alula.geometry.clearance.least import Gap, _bounds, least_gap
from alula.geometry.clearance.shape import gaps
from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case_file import read_case
from alula.loads.states.clearance import along, assembly, clearance
from alula.reports.sentences import told


def test_two_parallel_bars_touch_where_their_distance_is_their_width():
    """Bars along θ through (0, 0) and (100, 0) are 100 sin θ apart."""
    found = clearance(parallel_bars())
    assert found is not None
    assert found.contact is not None
    assert set(found.contact.names) == {"link crank", "link rocker"}
    assert found.contact.at is not None
    assert math.degrees(found.contact.at) == pytest.approx(math.degrees(math.asin(16.0 / 100.0)), abs=1e-3)
    # At 5 degrees they would lie in each other by what is missing: the largest circle in both is as wide.
    assert found.contact.value == pytest.approx(100.0 * math.sin(math.radians(5.0)) - 16.0, rel=1e-3)
    x, y = found.contact.place
    assert math.sin(found.contact.at) * x - math.cos(found.contact.at) * y == pytest.approx(8.0, abs=1e-2)
    [outcome] = clearance_outcomes(found.assembly.case, found)
    assert outcome.verdict is Verdict.FAIL
    assert re.fullmatch(r"link crank and link rocker touch first at crank = 9\.21 deg, x = .*", told(outcome.reason))


def test_the_least_gap_of_two_bars_that_do_not_touch():
    """From 60 to 12 degrees the gap falls to 100 sin 12° - 16 mm; a limit inside of the band is left open."""
    gap = 100.0 * math.sin(math.radians(12.0)) - 16.0
    for limit, verdict in ((0.0, "pass"), (gap - 0.1, "pass"), (gap - 1e-4, "undecided"), (gap + 0.1, "fail")):
        more = f'[checks.apart]\ntype = "clearance"\nminimum = "{limit} mm"\n'
        case = four_bars((0, 1, 2, 1), (120.0, 100.0, 120.0, 100.0), start=60, end=12, near=(0, 60), more=more)
        found = clearance(case)
        assert found is not None
        assert found.contact is None
        least = found.least
        assert least is not None
        assert least.value == pytest.approx(gap, abs=1e-9)
        assert least.low <= gap <= least.high
        assert least.high - least.low < 0.1
        [outcome] = clearance_outcomes(case, found)
        assert (outcome.name, outcome.verdict.value) == ("apart", verdict)


def test_rounding_chooses_neither_pose_nor_place_nor_order_of_the_least_gaps(monkeypatch):
    """The six-bar's halves mirror each other, and pins pass some of its links at one distance over a stretch."""
    case, found = read_case("six-bar"), []
    for seed in (0, 1):
        noise = np.random.default_rng(seed)
        monkeypatch.setattr(
            least, "gaps", lambda *of, noise=noise: gaps(*of) + noise.uniform(-1e-12, 1e-12, len(of[1]))
        )
        told = clearance(case)
        assert told is not None
        found.append([(gap.names, gap.at, *gap.place) for gap in told.gaps])
    assert len(found[0]) > 2
    for one, other in zip(*found, strict=True):
        assert one[0] == other[0]
        assert one[1:] == pytest.approx(other[1:], rel=1e-9)


@pytest.mark.parametrize("wide", [0, 1, 2])
def test_the_band_of_the_least_gap_is_that_of_all_pairs(wide):
    """Another pair than the one of the least value may come nearer, and no pair's upper end counts but the least."""
    ends = [(2.0, 1.9, 2.1), (2.2, 2.05, 2.4), (2.5, 2.45, 2.6)]
    value, _, high = ends[wide]
    ends[wide] = value, 0.5, high
    pairs = [
        Gap(names=(f"link {i}", "pin A"), value=one, low=low, high=high, at=None, place=(0.0, 0.0))
        for i, (one, low, high) in enumerate(ends)
    ]
    band = clearance_band(SimpleNamespace(gaps=tuple(pairs), least=pairs[0], motion=None))
    assert (band.value, band.low, band.high) == (2.0, 0.5, 2.1)


def swung_over_the_pin(poses):
    """The gap of a bar and a pin, looked at in so many poses from 6 to -6 degrees."""
    case = bar_on_a_pin()
    [pair] = [pair for pair in assembly(case).pairs if set(pair.names) == {"link crank", "pin D"}]
    motion = solve_motion(case.solve_pose(), np.radians([60.0, -6.0]))
    at, start = along(motion), np.radians(np.linspace(6.0, -6.0, poses))
    found = least_gap(pair, at, (start, at(start)), near=0.01, step=1e-4)
    assert found is not None
    return found


@pytest.mark.parametrize("poses", [2, 4, 400])
def test_how_deep_two_outlines_lie_in_each_other_between_poses_is_in_the_band(poses):
    """A bar of 16 mm swings over a pin of 8 mm: 1.55 mm deep at -6 and 6 degrees, and over all of the pin between them.

    Of 400 poses, which all touch, not every one is asked how deep.
    """
    found = swung_over_the_pin(poses)
    assert found.at == pytest.approx(math.radians(6.0))
    assert found.low <= -8.0
    if poses == 2:
        assert found.value == pytest.approx(100.0 * math.sin(math.radians(6.0)) - 12.0, abs=0.05)
    else:
        assert found.value == pytest.approx(-8.0, abs=0.05)
    assert found.low >= -8.0 - 200.0 * math.radians(12.0) / (min(poses, 60) - 1)


def test_where_few_poses_are_asked_how_deep_the_band_holds_those_that_are_not(monkeypatch):
    """Of thirteen poses that touch only the first is asked, where the pin lies 1.55 mm deep."""
    monkeypatch.setattr("alula.geometry.clearance.least._DEEPEST", 1)
    found = swung_over_the_pin(13)
    assert found.value == pytest.approx(100.0 * math.sin(math.radians(6.0)) - 12.0, abs=0.05)
    assert found.low <= -8.0


@pytest.mark.parametrize("way", [1, -1])
def test_the_bound_between_poses_knows_how_fast_an_outline_is_at_either_and_that_it_may_come_and_go(way):
    """Gaps of 5 + cos s mm are 4 mm at s = π, which no pose shows; the outline is fastest in the middle of the way.

    From 0 to 2π it stands still at both ends, and what is left is how fast its speed changes.
    """
    for s in (np.array([0.0, 2.0 * math.pi]), np.array([0.0, 1.2 * math.pi]), np.array([1.5, 1.2 * math.pi])):
        at = s[::way]
        [bound] = _bounds(at, 5.0 + np.cos(at), np.abs(np.sin(at)), np.abs(np.cos(at)))
        assert bound <= 4.0
    [bound] = _bounds(
        np.array([0.0, 1.0])[::way], np.array([5.0, 3.0])[::way], np.array([4.0, 0.0])[::way], np.zeros(2)
    )
    assert bound == 2.0  # 4 mm of way at the most: from 5 mm down to 2 mm, and up to 3 mm


def test_a_link_touches_a_pin_that_passes_its_layer():
    """The pin's centre is 100 sin θ off the crank's axis."""
    found = clearance(bar_on_a_pin())
    assert found is not None
    assert found.contact is not None
    assert found.contact.names == ("link crank", "pin D")
    assert found.contact.at is not None
    assert math.degrees(found.contact.at) == pytest.approx(math.degrees(math.asin(12.0 / 100.0)), abs=1e-3)


def test_a_link_outside_the_layers_of_a_pin_passes_it():
    found = clearance(bar_on_a_pin((1, 0, 3, 2)))
    assert found is not None
    assert found.contact is None
    assert not any("pin D" in gap.names and "link crank" in gap.names for gap in found.gaps)


@pytest.mark.parametrize("lengths", [(40.0, 120.0, 90.0, 110.0), (50.0, 95.0, 105.0, 100.0), (30.0, 80.0, 70.0, 60.0)])
def test_no_pose_has_a_smaller_gap_than_the_bound(lengths):
    """Every gap at 4,000 poses lies above the lower end of its band, and the least within the band's width of it."""
    case = four_bars((0, 1, 2, 1), lengths, start=70.0, end=250.0, near=(20.0, 80.0), width=4.0, pin=2.0)
    found = clearance(case)
    assert found is not None
    assert found.motion is not None
    values = np.linspace(float(found.motion.angles[0]), float(found.motion.angles[-1]), 4001)
    place = along(found.motion)(values)
    by_names = {pair.names: pair for pair in found.assembly.pairs}
    assert found.gaps
    for gap in found.gaps:
        dense = gaps(by_names[gap.names].cores, *by_names[gap.names].relative(place))
        assert gap.low <= dense.min() <= gap.high + 1e-4 * case.linkage.longest
        assert gap.high - gap.low < 3e-4 * case.linkage.longest


def test_the_speed_bound_is_that_of_the_fastest_point():
    """Against the movement of points of the smaller outline between two close poses, seen from the other's frame."""
    case = four_bars((0, 1, 2, 1), (40.0, 120.0, 90.0, 110.0), start=70.0, end=200.0, near=(20.0, 80.0))
    found = clearance(case)
    assert found is not None
    assert found.motion is not None
    at, step = along(found.motion), 1e-6
    values = np.linspace(math.radians(80.0), math.radians(190.0), 12)
    for pair in found.assembly.pairs:
        centre, reach = pair.other.circle
        rim = centre + reach * np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 721))
        (t0, d0), (t1, d1) = (pair.relative(at(values + s)) for s in (-step, step))
        if pair.at[1].point is not None:
            rim = np.array([0j])  # a pin that turns about its axis looks the same
        moved = np.abs((t1[:, None] * rim + d1[:, None]) - (t0[:, None] * rim + d0[:, None])).max(axis=1) / (2.0 * step)
        assert pair.speeds(at(values))[0] == pytest.approx(moved, rel=1e-4, abs=1e-4)


def test_a_link_in_a_fork_touches_it_where_its_own_bar_meets_the_root():
    """Of bars w wide, c from the pin to the root, at an angle of 2 asin(w / 2c) between both: 60 degrees."""
    fork, end = 'eyes.B = { fork = "3 mm", fork_depth = "16 mm" }', '["120.0 mm", "0 mm"]\n[links.coupler]'
    edits = {
        'part = "bar"\npoints.B = ["0 mm"': 'part = "thin"\npoints.B = ["0 mm"',
        end: end.replace("\n", f"\n{fork}\n"),
    }
    more = (
        '[parts.thin]\nshape = "bar"\nmaterial = "pla-fdm-xy"\nwidth = "16 mm"\nthickness = "2 mm"\n'
        'fillet_radius = "0 mm"\neye_diameter = "16 mm"\n'
    )
    lengths = (120.0, 100.0, 120.0, 100.0)
    case = four_bars((0, 1, 1, 2), lengths, start=60, end=130, near=(0, 60), more=more, edits=edits)
    found = clearance(case)
    assert found is not None
    assert found.contact is not None
    assert set(found.contact.names) == {"link crank", "link coupler"}
    assert found.contact.at is not None
    assert math.degrees(found.contact.at) == pytest.approx(120.0, abs=0.05)


def test_links_that_share_a_joint_and_a_layer_are_refused():
    with pytest.raises(CaseError, match=r"with layer = 1 of crank and layer = 1 of coupler they share joint B"):
        clearance(parallel_bars((0, 1, 1, 2)))


def test_links_that_lie_in_each_other_in_the_stated_pose_are_refused():
    with pytest.raises(CaseError, match=r"links.crank, links.rocker: .* they lie in each other in the stated"):
        clearance(parallel_bars(start=8.0))


def test_a_pin_through_a_foreign_link_in_the_stated_pose_is_refused():
    case = four_bars((0, 1, 3, 2), (120.0, 80.0, 80.0, 100.0), start=5.0, end=60.0, near=(80.0, 60.0))
    with pytest.raises(CaseError, match=r"links.crank: pin D goes through link crank, which it does not belong to"):
        clearance(case)


def test_without_layers_nothing_is_checked_and_a_check_is_refused():
    assert clearance(read_case("four-bar")) is None
    with pytest.raises(CaseError, match=r"checks.gap: a check of clearance needs to know which links lie at"):
        read_case("four-bar", ['checks={gap={type="clearance"}}'])


def test_links_in_layers_are_checked_unasked():
    assert "clearance" in parallel_bars().all_checks
    assert "clearance" in parallel_bars((0, 0, 0, 0)).all_checks
