"""When a displacement is large, and what acts on each link on the deformed shape."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import PLANAR, edited

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import internal_forces
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import EndLoad, LineLoad, LinkLoads, PinLoad
from alula.fea.common.verdict import LINKAGE, Verdict
from alula.fea.frame.build import build_frame
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.deformed_links import balanced, bent, in_slots
from alula.fea.nonlinear.equilibrium_path import NoEquilibriumError
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR, examine, with_growth
from alula.fea.nonlinear.softened import PATH_SUBDIVISIONS, displaced, followed
from alula.fea.nonlinear.stability import LARGE, span
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.joint_forces import joint_forces
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.parts.part import Pin
from alula.loads.case.case_file import read_case
from alula.loads.states.actions import acting_loads
from alula.reports.sentences import told

HELD_AT_GF = ('drive.link="GF"', 'drive.joint="G"')


def under(load, *overrides, fits=False):
    """The wing's case with its one load replaced, as [x, y] or [x, y, z] in N; without what it states of its pins."""
    components = ", ".join(f'"{x} N"' for x in load)
    return edited(
        "owl-wing-static",
        [f'load_cases.weight.forces=[{{link="CH", at="H", force=[{components}]}}]', PLANAR, *overrides],
        fits=fits,
    )


def examined(case):
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["weight"], pose.placement, {})
    return examine(case, "weight", joint_forces(case, pose, loads), loads), loads


def test_the_span_is_the_largest_distance_of_two_points():
    pose = read_case("owl-wing-static").solve_pose()
    assert span(pose) == pytest.approx(np.linalg.norm(pose.points["A"] - pose.points["H"]))
    assert span(pose) == pytest.approx(294.2, abs=0.05)


def test_displacements_under_several_loads_are_those_of_a_path_of_its_own_to_each():
    frame = examined(under([0, -0.25]))[0].frame
    factors = (0.12, 0.1, 0.17, 0.1, 0.15, 1.0, 0.18)  # it gives way before the sixth
    alone = [np.linalg.norm(frame.at_points(followed(frame, x).displacements)["CH", "H"]) for x in factors if x < 1.0]
    found = [displaced(frame, "CH", "H", x) for x in factors]
    assert found[5] == math.inf
    assert found[:5] + found[6:] == pytest.approx(alone, rel=1e-7)


def test_small_displacements_leave_the_undeformed_pose_alone():
    found, _ = examined(under([0, -0.125], *HELD_AT_GF))
    assert (found.state, found.held, found.reactions, dict(found.links)) == ("small", 1.0, None, {})
    assert found.points["CH", "H"][1] == pytest.approx(-2.375, abs=0.005)
    assert "accurate enough" in told(found.reason)


@pytest.mark.parametrize(
    ("limit", "of"),
    [
        ({"LARGE": 0.05, "LEAST_FACTOR": 0.0}, lambda one: 0.05 * one.span / one.linear),
        ({"LARGE": np.inf, "LEAST_FACTOR": 10.0}, lambda one: one.factor / 10.0),
    ],
)
@pytest.mark.parametrize("largest", [1.0, 1.5])
def test_the_limits_are_five_percent_of_the_span_and_ten_times_the_load(monkeypatch, limit, of, largest):
    """Of the largest load that is stated; the least one has no part in it."""
    assert (LARGE, LEAST_FACTOR) == (0.05, 10.0)
    for name, value in limit.items():
        monkeypatch.setattr(f"alula.fea.nonlinear.large_displacement.{name}", value)
    stated = (*HELD_AT_GF, f"load_cases.weight.scatter=[0.6,{largest}]")
    one, _ = examined(under([0, -0.01], *stated))
    for share, state in ((0.99, "small"), (1.01, "deformed")):
        assert examined(under([0, -0.01 * share / largest * of(one)], *stated))[0].state == state


def test_the_wing_held_at_ae_does_not_hold_its_weight():
    found, _ = examined(under([0, -0.25]))
    assert (found.state, found.reactions) == ("no equilibrium", None)
    assert found.held == pytest.approx(0.203, abs=5e-4)
    assert found.linear == pytest.approx(47.9, abs=0.05)
    assert "it gives way at 20.3 % of it" in told(found.reason)


@pytest.mark.parametrize("times", [3.0, 20.0])
def test_no_load_is_so_large_that_its_path_jumps_over_the_snap_through(times):
    """Under twenty times its weight the wing once held: the first step landed on a shape beyond the snap-through."""
    found, _ = examined(under([0, -0.25 * times]))
    assert found.state == "no equilibrium"
    assert times * found.held == pytest.approx(0.203, rel=0.03)
    assert times * found.held < 0.205 <= times * found.lost + 1e-3


def test_what_gives_way_against_linear_theory_is_not_told_to_be_too_near_for_it(monkeypatch):
    case = under([0, -0.125], *HELD_AT_GF)
    small, loads = examined(case)

    def snaps(frame, factor):
        raise NoEquilibriumError(0.25, 0.5, buckled=False)

    monkeypatch.setattr("alula.fea.nonlinear.large_displacement.followed", snaps)
    found = told(with_growth(case, "weight", small, loads).reason)
    assert found.startswith("linear theory finds the linkage far from buckling and from a dead point; on its deformed")
    assert "too near" not in found


def test_its_verdict_is_fail_and_the_undeformed_figures_stay():
    case = under([0, -0.25])
    result = check_case(case, name="owl-wing-static", fidelity="beam")
    assert result.verdict is Verdict.FAIL
    (check,) = [c for c in result.load_cases["weight"].checks if c.name == "large displacement"]
    assert (check.verdict, check.limit, check.at_least) == (Verdict.FAIL, 1.0, True)
    assert result.load_cases["weight"].reactions.joints["A"].magnitude == pytest.approx(0.9520, abs=5e-5)
    assert any("does not hold the load" in told(warning) for warning in result.warnings)
    off = check_case(under([0, -0.25], 'large_displacement="off"'), name="owl-wing-static", fidelity="beam")
    assert off.verdict is not Verdict.FAIL
    assert not any(c.name == "large displacement" for c in off.load_cases["weight"].checks)
    assert any("large_displacement = off" in told(warning) for warning in off.warnings)


@pytest.mark.parametrize(
    ("overrides", "load", "lost"),
    [((), -0.25, True), (HELD_AT_GF, -0.25, False), (('large_displacement="off"',), -5.0, True)],
)
def test_no_link_passes_where_the_linkage_gives_way(overrides, load, lost):
    """Links once passed, by the forces of the undeformed pose, beside a linkage that does not hold the load."""
    limits = 'checks.each={type="displacement", maximum="5 mm"}', 'checks.eyes={type="bearing"}'
    case = under([0, load], *overrides, *limits)
    checks = check_case(case, name="owl-wing-static", fidelity="beam").load_cases["weight"].checks
    asked = [check for check in checks if check.subject != LINKAGE]
    assert {check.name for check in asked} >= {"strength", "each", "pins", "eyes", "buckling"}
    assert any(check.verdict is Verdict.PASS for check in asked) is not lost
    assert {"gives way" in told(check.reason) for check in asked} == {lost}
    if load < -1.0:  # what fails in the pose as it stands still fails
        assert any(check.verdict is Verdict.FAIL for check in asked)


def test_an_elastic_answer_beyond_the_strength_says_that_it_is_void():
    for load, void in ((-3.0, False), (-4.0, True)):
        result = check_case(under([0, load], *HELD_AT_GF), name="owl-wing-static", fidelity="beam").load_cases["weight"]
        worst = result.links["AE"].beam
        assert (worst.worst.equivalent > worst.strength) is void
        about = {c.link: told(c.reason) for c in result.checks if c.name in ("buckling", "large displacement")}
        assert ("AE bears 43.8 MPa by beam theory where its strength is 41.4 MPa" in about["the linkage"]) is void
        assert ("void" in about["AE"]) is void
        assert "void" not in about["CH"]


def test_the_drive_torque_keeps_its_axis_where_the_driven_link_tilts(monkeypatch):
    """Pushed out of the plane the driven link leaves the axis of the torque: taken about its own z, 5 % is missing."""
    monkeypatch.setattr("alula.fea.nonlinear.deformed_links.LARGEST_SHIFT", 0.01)
    case = read_case("owl-wing-braking")
    statics = solve_case_statics(case, "owl-wing-braking")
    found = examine(case, "complete", statics.forces["complete"], statics.loads["complete"])
    assert found.state == "deformed"


def tip(maximum, *overrides, load=(0, -0.25), fits=False):
    """What becomes of a check of the wing's tip."""
    case = under(load, f'checks.tip={{type="displacement", at="H", maximum="{maximum} mm"}}', *overrides, fits=fits)
    result = check_case(case, name="owl-wing-static", fidelity="beam").load_cases["weight"]
    (found,) = [c for c in result.checks if c.name == "tip"]
    assert (found.link, found.quantity, found.unit) == ("point H of CH", "displacement", "mm")
    return result, found


def test_a_point_is_checked_with_the_whole_linkage_and_a_link_from_its_own_pins():
    limit = 'checks.each={type="displacement", maximum="5 mm"}'
    load = (0, -0.125)
    result, found = tip(2.5, *HELD_AT_GF, limit, load=load)
    moved = result.large_displacement
    size = np.linalg.norm(moved.points["CH", "H"])
    assert found.value.value == pytest.approx(size)
    # Linear theory leaves out that displacements grow towards a limit load, for a toggle as x (1 - x)(2 - x)/2 = 1/n.
    growth = moved.factor * np.roots([0.5, -1.5, 1.0, -1.0 / moved.factor]).real.min()
    # Eyes make it stiffer, bores and holes softer; what is softer is nearer to the limit load as well.
    assert 0.75 * size < found.value.low < 0.95 * size
    assert found.value.high > 1.02 * growth * size
    assert found.value.low < 2.5 < found.value.high
    assert found.verdict is Verdict.UNDECIDED
    assert tip(3.5, *HELD_AT_GF, load=load)[1].verdict is Verdict.PASS
    assert tip(2.0, *HELD_AT_GF, load=load)[1].verdict is Verdict.FAIL
    each = [c for c in result.checks if c.name == "each"]
    assert len(each) == 5
    assert {c.quantity for c in each} == {"deflection from its pins"}
    (link,) = [c for c in each if c.link == "CH"]
    assert link.value.value < 0.3


@pytest.mark.parametrize("load", [-0.125, -1.5])
def test_play_that_a_case_states_lets_a_point_of_either_shape_come_to_rest_further_off(load):
    """By nearly all of its free motion, as its pins lie where the load pushes them; its band goes as far either way."""
    result, loose = tip(5.0, *HELD_AT_GF, load=(0, load), fits=True)
    _, plain = tip(5.0, *HELD_AT_GF, load=(0, load))
    assert result.large_displacement.state == ("small" if load > -1.0 else "deformed")
    free = result.forces.play.free_motion("CH", "H")
    for off in (
        loose.value.value - plain.value.value,
        loose.value.high - plain.value.high,
        plain.value.low - loose.value.low,
    ):
        assert 0.98 * free < off < 1.005 * free


def test_a_point_that_moves_far_is_checked_on_the_deformed_shape():
    result, found = tip(5.0, *HELD_AT_GF, load=(0, -1.5))
    moved = result.large_displacement
    assert moved.state == "deformed"
    assert found.value.value == pytest.approx(np.linalg.norm(moved.points["CH", "H"]))
    assert found.value.value != pytest.approx(moved.linear, rel=1e-2)
    assert found.verdict is Verdict.FAIL
    assert "on its deformed shape" in told(found.reason)


def test_a_point_without_equilibrium_or_beyond_linear_theory_is_left_open():
    _, found = tip(1000.0)
    assert found.verdict is Verdict.UNDECIDED
    assert found.value.unknowable
    assert not found.applies
    assert told(found.reason).startswith("the linkage gives way")
    _, found = tip(1000.0, 'large_displacement="off"')
    assert found.verdict is Verdict.UNDECIDED
    assert "may give way at 0.807 times the load or less, below 5.2" in told(found.reason)
    _, found = tip(1000.0, *HELD_AT_GF, 'large_displacement="off"', load=(0, -1.0))
    assert found.verdict is Verdict.UNDECIDED
    assert "above 5 % of the span" in told(found.reason)
    _, found = tip(6.5, *HELD_AT_GF, 'large_displacement="off"')
    assert found.verdict is Verdict.PASS
    _, found = tip(6.5, *HELD_AT_GF, 'large_displacement="off"', fits=True)
    assert found.verdict is Verdict.UNDECIDED
    assert "without play the verdict would be pass" in told(found.reason)


def test_a_card_with_a_range_of_moduli_widens_the_band_of_a_point():
    sharp, wide = (tip(5.0, *HELD_AT_GF, f'parts.tube.material="{m}"')[1] for m in ("pvc-paredes-2018", "pvc-u"))
    material = edited("owl-wing-static", ['parts.tube.material="pvc-u"']).material_of("CH")
    least, largest = material.youngs_modulus_range
    low, high = (
        getattr(wide.value, end) / wide.value.value / (getattr(sharp.value, end) / sharp.value.value)
        for end in ("low", "high")
    )
    assert low == pytest.approx(material.youngs_modulus / largest, rel=0.02)
    assert high > material.youngs_modulus / least


@pytest.mark.parametrize("load", [[0, -1.5], [0, -1.2, 0.4]])
def test_links_carry_what_the_deformed_frame_says(load):
    """Bending moments at every pin, from the link's own loads and from the co-rotational elements beside it."""
    case = under(load, *HELD_AT_GF)
    found, loads = examined(case)
    assert found.state == "deformed"
    frame = build_frame(case, case.solve_pose(), loads, held=case.pinned_drive)
    solution = solve_large_displacement(frame.model, PATH_SUBDIVISIONS, least_step=1 / 512)
    assert found.reactions.drive_torque == pytest.approx(solution.joint_wrenches[frame.points["GF", "G"], 5], rel=1e-6)
    checked = 0
    for link, acting in found.links.items():
        on_axis = beam_loads(acting, case.body(link), 0.0)
        assert on_axis.imbalance < 1e-12
        forces = internal_forces(on_axis)
        own = [i for i, e in enumerate(frame.model.elements) if e.nodes[0] in [n for _, n in frame.stations[link]]]
        for (x, _), element in zip(frame.stations[link][:-1], own, strict=True):
            expected = solution.end_forces[element * PATH_SUBDIVISIONS, 0]
            got = forces.at(x, "after")
            # The chord is turned against the element, and twisted: lengths of vectors are compared.
            assert np.linalg.norm(got[3:]) == pytest.approx(np.linalg.norm(expected[3:]), rel=6e-3, abs=0.1), (link, x)
            assert np.linalg.norm(got[:3]) == pytest.approx(np.linalg.norm(expected[:3]), rel=0.05), (link, x)
            checked += 1
    assert checked == 8
    result = check_case(case, name="owl-wing-static", fidelity="beam")
    assert result.load_cases["weight"].large_displacement.state == "deformed"
    undeformed = check_case(
        under(load, *HELD_AT_GF, 'large_displacement="off"'), name="owl-wing-static", fidelity="beam"
    )
    stresses = [r.load_cases["weight"].links["CF"].von_mises_max.value for r in (result, undeformed)]
    assert abs(stresses[0] / stresses[1] - 1.0) > 0.005


def bar(*wrenches, lines=()):
    pins = tuple(
        PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.0, wrench=np.array(wrench, dtype=float))
        for name, x, wrench in wrenches
    )
    return LinkLoads(name="one", pins=pins, lines=lines)


def test_a_bent_strut_has_the_moment_of_its_axial_force():
    """P = 10 N compression, middle 2 mm above and 1 mm beside the chord: M = P e in the middle, about both axes."""
    straight = bar(("a", 0, [10, 0, 0, 0, 0, 0]), ("b", 40, [0] * 6), ("c", 100, [-10, 0, 0, 0, 0, 0]))
    moved = {"a": np.zeros(3), "b": np.array([0.0, 2.0, 1.0]), "c": np.zeros(3)}
    body = SimpleNamespace(pins=[SimpleNamespace(name=name, foot=None) for name in moved], ends=())
    on_axis = beam_loads(bent(straight, moved), body, 0.0)
    found = internal_forces(on_axis).at(40.0)
    # Cut at the middle: the force at a, 2 mm below the cut, has the moment 2 x 10 about z on the part before it.
    assert found[5] == pytest.approx(-20.0)
    assert found[4] == pytest.approx(10.0)
    assert on_axis.imbalance < 1e-15


def test_what_spread_loads_leave_goes_to_the_strongest_pin():
    ends = np.array([[0, -0.1, 0], [0, -0.3, 0]])
    line = LineLoad(link="bar", start=0.0, end=100.0, at_start=ends[0], at_end=ends[1], axes="link")
    loads = bar(("a", 0, [0, 10.0, 0, 0, 0, 0]), ("c", 100, [0.1, 10.2, 0, 0, 0, 0]), lines=(line,))
    fixed = balanced(loads)
    assert fixed.pins[0].wrench == pytest.approx(loads.pins[0].wrench)
    # 20 N down with its centroid at 58.3 mm.
    assert fixed.pins[1].wrench == pytest.approx([0, 10.0, 0, 0, 0, 20 * 175 / 3 - 1000])
    with pytest.raises(CannotRunError, match=r"leave .* unbalanced .*stiffen the link"):
        balanced(bar(("a", 0, [0, 10, 0, 0, 0, 0]), ("c", 100, [0, 10, 0, 0, 0, 0]), lines=(line,) * 2))


def test_plain_ends_take_part():
    loads = LinkLoads(
        name="one",
        pins=bar(("a", 0, [0, 1.0, 0, 0, 0, -50.0])).pins,
        ends=(EndLoad(name="h", point=np.array([50.0, 0, 0]), wrench=np.array([0, -1.0, 0, 0, 0, 0])),),
    )
    # 50 N mm of the end's force about a, taken by 100 at a: half too little.
    with pytest.raises(CannotRunError, match="unbalanced"):
        balanced(loads)


def test_what_has_no_frame_is_not_looked_into():
    case = read_case("owl-wing-static", [PLANAR])
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["weight"], pose.placement, {})
    forces = joint_forces(case, pose, loads)
    slot = case.joints["B"].model_copy(update={"type": "pin-in-slot"})
    found = examine(case.model_copy(update={"joints": case.joints | {"B": slot}}), "weight", forces, loads)
    assert (found.state, found.held) == ("unknown", 1.0)
    assert "the frame is a mechanism" in told(found.reason)


def test_a_pin_that_has_slid_pushes_across_its_slot():
    """8 N across, 4 N mm about where it stood: it has slid by 0.5 mm, and the other pin takes the 0.2 N along."""
    slot = PinLoad(
        name="s", centre=np.array([30.0, 0, 0]), diameter=2.0, wrench=np.array([0.2, 8, 0, 1, 0, 4.0]), slotted=True
    )
    other = bar(("a", 0, [-0.2, -8, 0, -1, 0, -244])).pins
    body = SimpleNamespace(pins=[Pin(name="s", x=30.0, y=0.0, diameter=2.0, slot=3.0)], ends=())
    found = in_slots(LinkLoads(name="one", pins=(*other, slot)), body, "lever")
    assert found.pins[0] is other[0]
    assert found.pins[1].centre == pytest.approx([30.5, 0, 0])
    assert found.pins[1].wrench == pytest.approx([0, 8, 0, 1, 0, 0])
    assert balanced(found).pins[0].wrench == pytest.approx([0, -8, 0, -1, 0, -244])
    with pytest.raises(CaseError, match="lengthen the slot"):
        in_slots(LinkLoads(name="one", pins=(replace(slot, wrench=np.array([0, 1.0, 0, 0, 0, 4])),)), body, "lever")
