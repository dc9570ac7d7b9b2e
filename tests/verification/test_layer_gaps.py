"""The gap that deflection and tilting pins leave between layers: the frame's own axis, rigid links, and verdicts."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from tilting_pins import LOOSE, TIGHT, checked, four_bar, rigid_motion

from alula.fea.check.run import check_case
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.reason import reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.frame.linear import solve_frame
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.standing.joint_forces import solved_frame
from alula.fea.whole.layer_gaps import LayerGaps, Overlap, Raised, overlaps
from alula.loads.case.case import Case
from alula.loads.states.actions import acting_loads
from alula.loads.states.clearance import assembly
from alula.reports.sentences import told

CHECKS = {"c": {"type": "clearance"}, "far": {"type": "clearance", "minimum": "10 mm"}}


@cache
def gap(
    spacing: str, play: str | None = None, force: str = "-20 N", at_b: str | None = None, *, stated: bool = True
) -> CheckOutcome:
    """The gap of pins with a play, else tight in both links; or of which nothing is stated."""
    loads = {
        "l": {"forces": [{"link": "rocker", "at": "P", "force": ["0 N", force]}]},
        "light": {"forces": [{"link": "rocker", "at": "P", "force": ["0 N", "-0.2 N"]}]},
    }
    tight = TIGHT if play else {name: (link, LOOSE[name]) for name, link in TIGHT.items()}
    data = four_bar(tight=tight if stated else {}, play=play, layer_spacing=spacing, load_cases=loads, checks=CHECKS)
    if at_b is not None:
        data["joints"]["B"]["clearance"] = at_b
    found = check_case(checked(data), fidelity="beam").load_cases["l"].checks
    one, other = [check for check in found if check.quantity is Quantity.LAYER_GAP]
    assert (one.value, one.limit) == (other.value, other.limit)  # washers fill what a check asks for in the plane
    return one


def test_places_of_a_link_move_with_its_axis_and_its_twist():
    case = checked(four_bar())
    pose = case.solve_pose()
    frame, solution = solved_frame(
        case, pose, acting_loads(case, case.load_cases["l"], pose.placement, {}), case.pinned_drive
    )
    raised = Raised(frame=frame, solution=solution)
    for i, beam in frame.beams.items():
        length = beam.end - beam.start
        stations = np.linspace(0.0, length, 5)
        along = np.column_stack([beam.start + stations, np.zeros(5)])
        places = along @ pose.rotation(beam.link).T + pose.origins[beam.link]
        own = solution.axis_displacements(i, stations)[:, 2]
        assert raised.at(beam.link, places) == pytest.approx(own, abs=0.02 * np.abs(own).max())  # shear of the beam
        nodes = frame.model.elements[i].nodes
        beside = places[[0, -1]] + pose.rotation(beam.link) @ [0.0, 3.0]
        twists = solution.displacements[list(nodes), 3:5] @ pose.rotation(beam.link)[:, 0]
        assert raised.at(beam.link, beside) - own[[0, -1]] == pytest.approx(3.0 * twists, rel=1e-6)


def test_links_lie_over_each_other_at_their_common_joints_alone():
    case = checked(four_bar())
    frame, _ = solved_frame(case, case.solve_pose(), (), case.pinned_drive)
    found = {(one.lower, one.upper) for one in overlaps(frame, assembly(case))}
    assert found == {("crank", "coupler"), ("rocker", "coupler")}
    assert all(one.gap == pytest.approx(0.5) for one in overlaps(frame, assembly(case)))


def test_play_closes_the_gap_by_no_less_than_that_of_rigid_links():
    """The corner of the rhombus about B that is furthest from it: the least of all equilibria bounds rigid links."""
    plain, loose = gap("4.5 mm"), gap("4.5 mm", play="0.1 mm")
    assert plain.verdict is Verdict.PASS
    assert 0.49 < plain.value.low <= plain.value.value < 0.5
    assert loose.value.value == plain.value.value
    case, taken, rigid = checked(four_bar(play="0.1 mm")), plain.value.low - loose.value.low, []
    frame, _ = solved_frame(case, case.solve_pose(), (), case.pinned_drive)
    for one in overlaps(frame, assembly(case)):
        far = max(one.places, key=lambda at: np.linalg.norm(at - one.places.mean(axis=0)))
        up = rigid_motion(
            case, one.lower, np.array([*far, 4.5]), np.eye(3)[2], holes=LOOSE, play=0.1, length=4.0, against=one.upper
        )
        rigid.append(up)
    assert max(rigid) * (1.0 - 2e-3) < taken < 1.5 * max(rigid)
    small = gap("4.2 mm", play="0.1 mm")
    assert small.verdict is Verdict.UNDECIDED
    assert "links rocker and coupler, 0.2 mm apart along the pins without load" in told(small.reason)


def test_pins_of_which_nothing_is_stated_run_and_may_close_the_gap():
    """H8/f7 in every hole: 10 to 30 um of play in holes for pins of 3 mm, as where that is stated."""
    data = four_bar(tight={}, layer_spacing="4.08 mm", checks=CHECKS)
    for joint in data["joints"].values():
        joint["fit"] = "running"
    every = check_case(checked(data), fidelity="beam").load_cases["l"].checks
    low = min(one.value.low for one in every if one.quantity is Quantity.LAYER_GAP)
    open_, tight = gap("4.08 mm", stated=False), gap("4.08 mm")
    assert tight.verdict is Verdict.PASS
    assert open_.value.low <= low < 0.0
    assert open_.value.value == tight.value.value
    assert open_.verdict is Verdict.UNDECIDED
    assert "state how they sit" in told(open_.reason)
    assert gap("4.5 mm", stated=False).verdict is Verdict.PASS


def test_who_has_stated_all_fits_is_not_asked_for_them(monkeypatch):
    """Where play in the plane is not followed (redundant linkages, or let go), fits are stated all the same."""
    monkeypatch.setattr("alula.fea.whole.layer_gaps.clearances", lambda case: {})
    for fitted in (("O2", "A", "B", "O4"), ("O2", "A", "B")):
        data = four_bar(tight={}, layer_spacing="4.08 mm", checks=CHECKS)
        for name in fitted:
            data["joints"][name]["fit"] = "running"
        found = check_case(checked(data), fidelity="beam").load_cases["l"].checks
        one = next(check for check in found if check.quantity is Quantity.LAYER_GAP)
        assert one.verdict is Verdict.UNDECIDED
        assert ("state how they sit" in told(one.reason)) == ("O4" not in fitted)


def test_what_would_keep_a_gap_open_does_so_where_it_is_done():
    """The share of the clearance that is told keeps it open, and hardly more does not."""
    assert "with 52 % of the clearance at joint B alone it would stay open" in told(gap("4.2 mm", play="0.1 mm").reason)
    assert gap("4.2 mm", play="0.1 mm", at_b="0.052 mm").verdict is Verdict.PASS
    assert gap("4.2 mm", play="0.1 mm", at_b="0.055 mm").verdict is Verdict.UNDECIDED
    every = told(gap("4.05 mm", play="0.1 mm").reason)
    assert "no joint alone keeps it open, but with 14 % of all clearances it would stay open" in every
    assert gap("4.05 mm", play="0.014 mm").verdict is Verdict.PASS
    assert gap("4.05 mm", play="0.017 mm").verdict is Verdict.UNDECIDED
    assert "with heads without a gap on all pins it would stay open" in every
    held = four_bar(play="0.1 mm", layer_spacing="4.05 mm", checks=CHECKS)
    for joint in held["joints"].values():
        joint["heads"] = {"diameter": "7 mm", "gap": "0 mm"}
    found = check_case(checked(held), fidelity="beam").load_cases["l"].checks
    assert {one.verdict for one in found if one.quantity is Quantity.LAYER_GAP} == {Verdict.PASS}
    assert "deflection alone may close it" in told(gap("4.001 mm", play="0.1 mm").reason)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_least_is_left_where_deflection_and_play_together_take_most(order):
    """Of two overlaps: that of the wider gap, at a corner where neither deflection nor play of a joint is largest."""
    gaps = LayerGaps(case=checked(four_bar()), load_case="l", moved=SimpleNamespace(of_loads=()), assembly=None)
    places = np.array([[0.0, 0.0], [1.0, 2.0], [3.0, 4.0]])
    wide = Overlap(lower="crank", upper="coupler", gap=1.0, places=places)
    near = Overlap(lower="rocker", upper="coupler", gap=0.5, places=places)
    closed = [np.outer([1.0, 0.9, 1.2], one) for one in ([0.3, 0.2, 0.0], [0.01, 0.02, 0.03])]
    freed = [np.array([[0.0, 0.3, 0.1], [0.1, 0.3, 0.4]]), np.full((2, 3), 0.01)]
    told = {"_overlaps": [wide, near], "_closed": closed, "_freed": freed}
    vars(gaps).update({name: [each[k] for k in order] for name, each in told.items()}, _blind=["", ""])
    assert gaps.least.names == ("crank", "coupler")
    assert gaps.least.place == (1.0, 2.0)
    left = gaps.least.left
    assert (left.low, left.value, left.high) == pytest.approx((1.0 - 0.24 - 0.6, 1.0 - 0.2, 1.0 - 0.18 + 0.6))
    assert gaps._opens(gaps._freed)
    more = [one + extra for one, extra in zip(gaps._freed, np.array([0.0, 0.25])[list(order)], strict=True)]
    assert not gaps._opens(more)  # a remedy has to keep both open


@pytest.mark.parametrize("tilt", [0.015, 0.003])
def test_heads_keep_links_apart_by_no_more_than_rigid_ones(tilt):
    data, free, rigid = four_bar(play="0.1 mm", tight=TIGHT), [], []
    for joint in data["joints"].values():
        joint["heads"] = {"diameter": "6 mm", "gap": ["0 mm", f"{6.0 * tilt} mm"]}  # at the most that it may be
    case = checked(data)
    frame, _ = solved_frame(case, case.solve_pose(), (), case.pinned_drive)
    gaps = LayerGaps(case=case, load_case="l", moved=SimpleNamespace(frame=frame), assembly=assembly(case))
    for one in overlaps(frame, gaps.assembly):
        far = max(one.places, key=lambda at: np.linalg.norm(at - one.places.mean(axis=0)))
        place, holes = np.array([*far, 4.5]), {"play": 0.1, "length": 4.0, "tilt": tilt, "against": one.upper}
        free.append(gaps._free(one).sum(axis=0).max())
        rigid.append(rigid_motion(case, one.lower, place, np.eye(3)[2], holes=LOOSE, **holes))
    assert max(rigid) * (1.0 - 2e-3) < max(free) < 1.5 * max(rigid)


def test_deflection_that_closes_the_gap_fails_and_goes_with_the_load():
    near, twice = gap("4.5 mm"), gap("4.5 mm", force="-40 N")
    assert 0.5 - twice.value.value == pytest.approx(2.0 * (0.5 - near.value.value), rel=1e-6)
    for one in (near, twice):  # of what deflection takes, as the modulus may be
        assert 0.9 * (0.5 - one.value.value) > 0.5 - one.value.high > 0.0
        assert 1.1 * (0.5 - one.value.value) < 0.5 - one.value.low
    closed = gap("4.0002 mm")
    assert closed.verdict is Verdict.FAIL
    assert closed.value.high < 0.0


PLATE = {"shape": "plate", "material": "m", "thickness": "4 mm", "eye_diameter": "8 mm"}
TIGHT_IN_BOTH = {name: (link, LOOSE[name]) for name, link in TIGHT.items()}


def with_plates(*links: str, force: str = "-20 N") -> LayerGaps:
    """The gaps where some links are plates. A flag is bonded to the rocker and bears a force at its free end."""
    data = four_bar(tight=TIGHT_IN_BOTH, checks={"c": {"type": "clearance"}})
    data["parts"]["plate"] = PLATE
    points = {"P": ["0 mm", "0 mm"], "Q": ["30 mm", "0 mm"]}
    data["links"]["flag"] = {"points": points, "part": "bar", "layer": 2}
    data["joints"]["P"] = {"links": ["rocker", "flag"], "pin_diameter": "3 mm", "bonded": True, "angle": "0 deg"}
    data["pose"]["near"]["flag"] = "57 deg"
    data["load_cases"]["l"]["forces"] = [{"link": "flag", "at": "Q", "force": ["0 N", force]}]
    for link in links:
        data["links"][link]["part"] = "plate"
    return gaps_of(checked(data))


def gaps_of(case: Case, *causes: Alternatives[LargeDisplacement]) -> LayerGaps:
    """The gaps by the linear frame of the load case, with the answers of some causes."""
    return LayerGaps(case=case, load_case="l", moved=replace(moved_by(case), causes=causes), assembly=assembly(case))


def moved_by(case: Case) -> LargeDisplacement:
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["l"], pose.placement, {})
    frame, solution = solved_frame(case, pose, loads, case.pinned_drive)
    known = {"frame": frame, "solution": solution, "points": {}, "links": {}}
    return LargeDisplacement(state="small", span=1.0, reason=reason("linear_so_far"), **known)


def test_a_gap_that_a_plate_takes_part_in_is_undecided():
    data = four_bar(tight=TIGHT_IN_BOTH, checks={"c": {"type": "clearance"}})
    data["parts"]["plate"] = PLATE
    for part, verdict in (("bar", Verdict.PASS), ("plate", Verdict.UNDECIDED)):
        data["links"]["rocker"]["part"] = part
        found = check_case(checked(data), fidelity="beam").load_cases["l"].checks
        one = next(check for check in found if check.quantity is Quantity.LAYER_GAP)
        assert one.verdict is verdict
    assert math.isnan(one.value.value)
    assert "link rocker for a beam along its axis, which does not tell how far it gives" in told(one.reason)


def test_a_plate_takes_part_where_its_softness_moves_the_links():
    """The crank bears both links of the gap at B. What is bonded to a free end changes nothing, whatever it bears."""
    crank = with_plates("crank")
    assert set(crank._blind) == {"crank"}
    assert crank.least.left.unknowable
    assert set(with_plates("crank", force="0 N")._blind) == {""}
    flag, bar = with_plates("flag"), with_plates()
    assert set(flag._blind) == {""}
    assert flag.least.left.low == pytest.approx(bar.least.left.low, rel=1e-3)
    assert flag.moved.solution.end_forces[[i for i, one in flag._frame.beams.items() if one.link == "flag"]].any()


def test_a_gap_that_closes_for_sure_is_told_before_one_of_which_nothing_is_known():
    for times, unknown in ((0.5, True), (2.0, False)):
        gaps = with_plates()
        closed = [np.full((3, len(over.places)), times * over.gap) for over in gaps._overlaps]
        vars(gaps).update(_closed=closed, _blind=["crank", *[""] * (len(closed) - 1)])
        assert gaps.least.left.unknowable == unknown
        assert unknown or gaps.least.left.high < 0.0


def crossing(modulus: Mapping[str, float], share: float = 0.0) -> Case:
    """Crank and rocker of different materials, which cross in neighbouring layers and rise by much the same there."""
    data = four_bar(tight=TIGHT_IN_BOTH)
    links, up = data["links"], {"crank": 1.0, "rocker": 1.1}
    links["base"]["points"]["O4"] = ["60 mm", "0 mm"]
    links["crank"]["points"] = {"O2": ["0 mm", "0 mm"], "M": ["50 mm", "0 mm"], "A": ["100 mm", "0 mm"]}
    links["rocker"]["points"] = {"O4": ["0 mm", "0 mm"], "M": ["50 mm", "0 mm"], "B": ["100 mm", "0 mm"]}
    links["coupler"]["points"] = {"A": ["0 mm", "0 mm"], "B": ["60 mm", "0 mm"]}
    links["rocker"]["layer"], links["coupler"]["layer"] = 2, 3
    data["pose"] = {"coordinate": "crank", "angle": "53 deg", "near": {"coupler": "180 deg", "rocker": "127 deg"}}
    for link, young in modulus.items():
        ends = [f"{(1.0 + sign * share) * young} MPa" for sign in (-1.0, 1.0)]
        entries = {"title": link, "youngs_modulus": f"{young} MPa", "youngs_modulus_range": ends}
        data["materials"][link] = data["materials"]["m"] | entries
        data["parts"][link] = data["parts"]["bar"] | {"material": link}
        links[link]["part"] = link
    loads = [{"link": link, "at": "M", "force": ["0 N", "0 N", f"{force} N"]} for link, force in up.items()]
    data["load_cases"]["l"]["forces"] = loads
    return checked(data)


def test_a_gap_between_links_that_rise_alike_stays_in_its_band_with_moduli_at_their_ends():
    """The difference of two rises changes by more than the rises do, and by more than any modulus may."""
    young = {"crank": 2500.0, "rocker": 2000.0}
    stated = gaps_of(crossing(young, 0.2))
    crossed = [(over.lower, over.upper) for over in stated._overlaps].index(("crank", "rocker"))
    every = []
    for factors in itertools.product((0.8, 1.0, 1.2), repeat=2):
        other = gaps_of(crossing(dict(zip(young, np.multiply(factors, [*young.values()]).tolist(), strict=True))))
        for told_of, solved in zip(stated._closed, other._closed, strict=True):
            assert (told_of[1] <= solved[0] + 1e-12).all()
            assert (solved[0] - 1e-12 <= told_of[2]).all()
        assert stated.least.left.low <= other.least.left.value
        every.append(other._closed[crossed][0])
    value, _, most = stated._closed[crossed]
    assert (np.max(every, axis=0) / value).max() > 2.0
    eyes = gaps_of(crossing(young))._closed[crossed]
    assert (most - eyes[2] > 0.7 * (np.max(every, axis=0) - value)).all()  # beside what eyes and bores may add
    assert SourceKind.MODULUS in {source.kind for source in stated.least.left.sources}


@pytest.mark.parametrize("times", [(1.5, 2.0), (0.5, 1.5), (3.0, 0.5)])
def test_causes_that_change_what_acts_are_factors(times):
    """What air makes of it and what friction makes of it may hold together, one way or the other."""
    case = checked(four_bar(tight=TIGHT_IN_BOTH))
    stated, plain = moved_by(case), gaps_of(case)

    def scaled(factor: float) -> LargeDisplacement:
        frame = stated.frame
        loads = tuple(replace(load, wrench=factor * load.wrench) for load in frame.model.loads)
        model = replace(frame.model, loads=loads)
        return replace(stated, frame=replace(frame, model=model), solution=solve_frame(model))

    kinds = (SourceKind.AIR, SourceKind.FRICTION)
    causes = [Alternatives(source=Source(kind=k), others=(scaled(x),)) for k, x in zip(kinds, times, strict=True)]
    both, one = gaps_of(case, *causes), gaps_of(case, causes[0])
    for factors, gaps in (((1.0, times[0], times[1], times[0] * times[1]), both), ((1.0, times[0]), one)):
        for own, closed in zip(plain._closed, gaps._closed, strict=True):
            ends = np.array([factor * end for factor in factors for end in own])
            assert closed[0] == pytest.approx(own[0])
            assert (closed[1] <= ends.min(axis=0) + 1e-12).all()
            assert (closed[2] >= ends.max(axis=0) - 1e-12).all()
            if gaps is one or min(times) > 1.0:
                assert closed[1:] == pytest.approx(np.array([ends.min(axis=0), ends.max(axis=0)]))
    assert set(kinds) <= {source.kind for source in both.least.left.sources}
