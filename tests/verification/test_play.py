"""Play of pins: against closed forms, against the forces of unit loads, and against assembled linkages."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from planar_linkages import OPEN_WING, deg, four_bar, quick_return, six_bar, slider_crank

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.play import LooseJoints
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import PointLoad
from alula.loads.states.play import Displaced, Play, held_rows, play_of
from alula.loads.statics.statics import Drive, solve_statics

PLAY = {"A": 0.1, "B": 0.2, "C": 0.3, "D": 0.05}


def loose(pose: Pose, play: dict[str, float]) -> LooseJoints:
    held = np.zeros(pose.closure.unknowns)
    held[pose.held_column] = 1.0 / pose.coordinate.measure.scale(pose.linkage)
    return LooseJoints(place=pose.placement, radii={name: c / 2.0 for name, c in play.items()}, held=held[None])


def turned(joints: LooseJoints, link: str, near: str, far: str) -> float:
    """Return how far a link may turn by play [rad], from the places of two of its points."""
    names, place = joints.place.closure.point_names, joints.place
    a, b = names.index((link, near)), names.index((link, far))
    arm = complex(place.position(link, far) - place.position(link, near))
    rates = {n: tuple(((one[b] - one[a]) / arm).imag + 0j for one in by) for n, by in joints.rates.items()}
    return joints.reach_of(rates).largest()


@pytest.mark.parametrize("angle", [20.0, 75.0, 140.0])
def test_output_angle_of_a_four_bar(angle: float) -> None:
    """The rocker errs by the sum of the half plays over c sin µ: each is like a change of the coupler's length."""
    pose = solve_pose(
        four_bar(40, 120, 80, 100), coordinate="crank", angle=math.radians(angle), near={"coupler": 0.2, "rocker": 1.2}
    )
    transmission = pose.angles["rocker"] - pose.angles["coupler"]
    expected = sum(PLAY.values()) / 2.0 / (80.0 * abs(math.sin(transmission)))
    assert turned(loose(pose, PLAY), "rocker", "D", "C") == pytest.approx(expected, rel=2e-5)


def test_output_angle_of_a_parallelogram() -> None:
    """The rocker of a parallelogram at 50° errs by the sum of the half plays over its height."""
    pose = solve_pose(
        four_bar(60, 100, 60, 100), coordinate="crank", angle=math.radians(50), near={"coupler": 0.0, "rocker": 0.9}
    )
    expected = sum(PLAY.values()) / 2.0 / (60.0 * math.sin(math.radians(50)))
    assert turned(loose(pose, PLAY), "rocker", "D", "C") == pytest.approx(expected, rel=2e-5)


def test_a_lever_in_a_slot() -> None:
    """A pin that has play across the slot lets the lever turn by half of it over the travel, to either side."""
    pose = solve_pose(quick_return(30, 50), coordinate="crank", angle=math.radians(25), near={"lever": 1.2})
    expected = 0.15 / pose.travels["B"]
    assert turned(loose(pose, {"B": 0.3}), "lever", "O", "E") == pytest.approx(expected, rel=1e-9)
    for side in (0.15j, -0.15j):
        place, closed = loose(pose, {"B": 0.3}).moved({"B": side})
        assert closed
        error = float(place.angle("lever")) - pose.angles["lever"]
        travel = math.hypot(pose.travels["B"], 0.0)
        assert abs(error) == pytest.approx(math.asin(0.15 / travel), rel=1e-6)
        assert error * side.imag < 0.0


LINKAGES: list[tuple[Linkage, dict[str, Any], Drive, tuple[str, str]]] = [
    (
        four_bar(40, 120, 80, 100),
        {"coordinate": "crank", "angle": 0.7, "near": {"coupler": 0.3, "rocker": 1.0}},
        Drive(link="crank", joint="A"),
        ("coupler", "P"),
    ),
    (
        quick_return(30, 50),
        {"coordinate": "crank", "angle": 0.4, "near": {"lever": 1.2}},
        Drive(link="crank", joint="A"),
        ("lever", "E"),
    ),
    (
        slider_crank(30, 90, 5),
        {"coordinate": "crank", "angle": 0.9, "near": {"coupler": -0.2}},
        Drive(link="crank", joint="A"),
        ("block", "Q"),
    ),
    (
        six_bar(),
        {"coordinate": "GF", "angle": math.radians(228.15), "near": OPEN_WING},
        Drive(link="GF", joint="G"),
        ("CH", "H"),
    ),
]


@pytest.mark.parametrize(("linkage", "stated", "drive", "at"), LINKAGES)
def test_rates_are_joint_forces_of_unit_loads(
    linkage: Linkage, stated: dict[str, Any], drive: Drive, at: tuple[str, str]
) -> None:
    """By virtual work, a point moves along u by minus the joint's force under a unit load along u, for an offset."""
    pose = solve_pose(linkage, **stated)
    joints = loose(pose, {name: 0.1 for name, joint in linkage.joints.items() if joint.type != "slider"})
    number = pose.closure.point_names.index(at)
    for unit in (1.0, 1.0j):
        load = PointLoad(link=at[0], point=at[1], wrench=np.array([unit.real, unit.imag, 0.0, 0.0, 0.0, 0.0]))
        forces = solve_statics(pose, drive, [load]).joints
        for name, rates in joints.rates.items():
            carrier = pose.placement.direction(linkage.joints[name].links[0])
            turn = complex(carrier) if linkage.joints[name].type == "pin-in-slot" else 1.0
            for direction, rate in zip(joints.directions(name), rates, strict=True):
                force = complex(forces[name].wrench[0], forces[name].wrench[1])
                expected = -(np.conj(turn * direction) * force).real
                assert (np.conj(unit) * rate[number]).real == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("linkage", "stated", "drive", "at"), LINKAGES)
def test_assembled_linkages_stay_within_reach(
    linkage: Linkage, stated: dict[str, Any], drive: Drive, at: tuple[str, str]
) -> None:
    """Offsets drawn at random move the point by no more than the reach, and the worst ones by all of it."""
    pose = solve_pose(linkage, **stated)
    joints = loose(pose, {name: 2e-4 for name, joint in linkage.joints.items() if joint.type != "slider"})
    reach, rng, start = joints.reach(*at), np.random.default_rng(1), pose.placement.position(*at)
    for _ in range(40):
        angles = rng.uniform(0.0, 2.0 * math.pi, len(joints.radii))
        shares = {n: np.array([math.cos(a), math.sin(a)]) for n, a in zip(joints.radii, angles, strict=True)}
        place, closed = joints.moved(joints.offsets(shares))
        assert closed
        assert abs(place.position(*at) - start) <= (1.0 + 1e-4) * reach.largest()
    place, _ = joints.moved(joints.offsets(reach.shares()))
    assert abs(place.position(*at) - start) == pytest.approx(reach.largest(), rel=1e-4)


@pytest.mark.parametrize(("linkage", "stated", "drive", "at"), LINKAGES)
def test_states_at_many_offsets_are_those_at_each_alone(
    linkage: Linkage, stated: dict[str, Any], drive: Drive, at: tuple[str, str]
) -> None:
    """At one pose and at two; the second of four offsets cannot be reached, and the others know nothing of it."""
    pose = solve_pose(linkage, **stated)
    joints = loose(pose, {name: 0.1 for name, joint in linkage.joints.items() if joint.type != "slider"})
    sizes = np.array([0.3, -400.0, -0.2, 0.1])
    offsets = {n: sizes * (1.0 + k) * joints.directions(n)[-1] for k, n in enumerate(joints.radii)}
    place, closed = joints.moved(offsets)
    assert closed.tolist() == [True, False, True, True]
    twice = replace(joints, place=replace(joints.place, q=np.stack([pose.q, pose.q])))
    both, closed = twice.moved({n: offset[:, None] for n, offset in offsets.items()})
    assert closed.tolist() == [[True] * 2, [False] * 2, [True] * 2, [True] * 2]
    for i in (0, 2, 3):
        alone, closed = joints.moved({n: complex(offset[i]) for n, offset in offsets.items()})
        assert closed
        for many in (place, both.chosen((slice(None), 1)), both.listed.chosen(slice(None, None, 2))):
            one = many.chosen(i)
            assert one.position(*at) == pytest.approx(complex(alone.position(*at)), rel=1e-12)
            assert one.closure.offsets == alone.closure.offsets
            assert np.abs(one.closure.residual(one.q)).max() < 1e-10


def test_a_pose_in_line_to_the_last_digit_leaves_the_other_its_play() -> None:
    """With the travel held and crank and coupler in line the matrix is singular; it is the second of both poses."""
    pose = solve_pose(slider_crank(30, 90, 0), coordinate="crank", angle=0.9, near={"coupler": -0.2})
    stretched = np.zeros_like(pose.q)
    stretched[-1] = 120.0
    assert np.abs(pose.closure.residual(stretched)).max() == 0.0
    held = np.zeros((1, len(pose.q)))
    held[0, -1] = 1.0 / pose.linkage.longest
    both = LooseJoints(place=replace(pose.placement, q=np.stack([pose.q, stretched])), radii={"B": 0.1}, held=held)
    alone = replace(both, place=pose.placement)
    for offset in (0.1, 0.1j):
        place, closed = both.moved({"B": offset})
        assert closed.tolist() == [True, False]
        assert place.q[0] == pytest.approx(alone.moved({"B": offset})[0].q, rel=1e-12)


def arm_case(play: str, force: tuple[str, str] = ("0 N", "-5 N")) -> Case:
    """A lever of 80 mm on a pin with play, at 30°, held by a drive."""
    return validate(
        {
            "schema_version": 1,
            "title": "lever",
            "links": {
                "base": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "R": ["10 mm", "0 mm"]}},
                "arm": {"points": {"O": ["0 mm", "0 mm"], "P": ["80 mm", "0 mm"]}},
            },
            "joints": {"O": {"links": ["base", "arm"], "clearance": play, "pin_diameter": "3 mm"}},
            "pose": {"coordinate": "arm", "angle": "30 deg"},
            "drive": {"link": "arm", "joint": "O"},
            "load_cases": {"tip": {"title": "tip", "forces": [{"link": "arm", "at": "P", "force": list(force)}]}},
        }
    )


def played(case: Case, load_case: str) -> Play:
    found = play_of(case, load_case, case.solve_pose(), {})
    assert found is not None
    return found


@pytest.mark.parametrize("force", [("0 N", "-5 N"), ("3 N", "4 N")])
def test_a_lever_goes_where_its_load_pushes_it(force: tuple[str, str]) -> None:
    """It moves as a whole by half of the play along the load; the drive holds its angle and needs the same torque."""
    found = played(arm_case("0.4 mm", force), "tip")
    load = complex(float(force[0][:-2]), float(force[1][:-2]))
    assert complex(found.shift("arm", "P")) == pytest.approx(0.2 * load / abs(load), abs=1e-12)
    assert found.free_motion("arm", "P") == pytest.approx(0.2, rel=1e-9)
    assert found.effort.low == pytest.approx(found.effort.high, rel=1e-9)
    assert not found.through_dead_point


def linkage_case(play: dict[str, str], force: tuple[str, str], angle: str = "40 deg") -> Case:
    """The four-bar of 40, 120, 80 and 100 mm, driven at its crank, with a force at the rocker's pin C."""
    links = {
        "base": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "D": ["100 mm", "0 mm"]}},
        "crank": {"points": {"A": ["0 mm", "0 mm"], "B": ["40 mm", "0 mm"]}},
        "coupler": {"points": {"B": ["0 mm", "0 mm"], "C": ["120 mm", "0 mm"]}},
        "rocker": {"points": {"D": ["0 mm", "0 mm"], "C": ["80 mm", "0 mm"]}},
    }
    pairs = {"A": ["base", "crank"], "B": ["crank", "coupler"], "C": ["coupler", "rocker"], "D": ["base", "rocker"]}
    joints = {name: {"links": pair, "clearance": play.get(name, "0 mm")} for name, pair in pairs.items()}
    return validate(
        {
            "schema_version": 1,
            "title": "four-bar",
            "links": links,
            "joints": joints,
            "pose": {"coordinate": "crank", "angle": angle, "near": {"coupler": "20 deg", "rocker": "70 deg"}},
            "drive": {"link": "crank", "joint": "A"},
            "load_cases": {"load": {"title": "l", "forces": [{"link": "rocker", "at": "C", "force": list(force)}]}},
        }
    )


@pytest.mark.parametrize(("push", "sign"), [(("9 N", "0 N"), 1.0), (("-9 N", "0 N"), -1.0)])
def test_tension_draws_a_coupler_out_and_compression_pushes_it_in(push: tuple[str, str], sign: float) -> None:
    """The pins that it joins stand L + (c1 + c2)/2 apart in tension, and L - (c1 + c2)/2 in compression."""
    found = played(linkage_case({"B": "0.3 mm", "C": "0.5 mm"}, push), "load")
    assert found.settled is not None
    place = found.settled.place
    apart = abs(place.position("rocker", "C") - place.position("crank", "B"))
    assert apart == pytest.approx(120.0 + sign * 0.4, rel=1e-12)


def test_at_rest_the_load_is_as_low_as_play_lets_it() -> None:
    """Of all offsets the linkage takes those of least potential energy; to first order that falls by sum c/2 |F|."""
    play = {"A": "0.02 mm", "B": "0.05 mm", "C": "0.04 mm", "D": "0.03 mm"}
    found = played(linkage_case(play, ("4 N", "-7 N")), "load")
    assert found.settled is not None
    assert found.nominal is not None
    load = complex(4.0, -7.0)

    def work(offsets: dict[str, complex]) -> float:
        place, closed = found.loose.moved(offsets)
        assert closed
        moved = complex(place.position("rocker", "C") - found.loose.place.position("rocker", "C"))
        return (np.conj(load) * moved).real

    radii, here = found.loose.radii, dict(found.settled.offsets)
    most = work(here)
    expected = sum(radius * abs(complex(found.nominal.force(name))) for name, radius in radii.items())
    assert most == pytest.approx(expected, rel=2e-3)
    for name in radii:
        for turn in (0.05, -0.05):
            assert work({**here, name: here[name] * np.exp(1j * turn)}) < most


ALL_LOOSE = {"A": "0.2 mm", "B": "0.5 mm", "C": "0.4 mm", "D": "0.3 mm"}


def test_bands_hold_what_any_offsets_give() -> None:
    found, rng = played(linkage_case(ALL_LOOSE, ("4 N", "-7 N")), "load"), np.random.default_rng(2)
    tried = []
    for _ in range(300):
        angles = rng.uniform(0.0, 2.0 * math.pi, 4)
        tried.append(
            found.at({n: r * np.exp(1j * a) for (n, r), a in zip(found.loose.radii.items(), angles, strict=True)})
        )
    for span, values in (
        (found.effort, [float(one.effort) for one in tried if one]),
        (found.distance, [float(one.distance) for one in tried if one]),
        *((found.forces[n], [abs(complex(one.force(n))) for one in tried if one]) for n in found.forces),
    ):
        slack = 1e-3 * (span.high - span.low)
        assert span.low - slack <= min(values)
        assert max(values) <= span.high + slack
        assert max(values) - min(values) > 0.6 * (span.high - span.low)


@pytest.mark.parametrize("push", [("4 N", "-7 N"), ("-4 N", "7 N")])
def test_bands_reach_as_far_as_gradients_do_and_as_far_as_solved_extremes(push: tuple[str, str]) -> None:
    """What bends one way lies within the first-order reach at one end and beyond it at the other: the outer one counts.

    The reach is the sum of half of the play times the gradient, here by differences of solved linkages.
    """
    found, step = played(linkage_case(ALL_LOOSE, push), "load"), 1e-4

    def gradients(number: Callable[[Displaced], Any]) -> dict[str, np.ndarray]:
        return {
            name: np.array([(number(solved({name: step * u})) - number(solved({name: -step * u}))) / (2.0 * step)
                            for u in (1.0, 1j)])
            for name in found.loose.radii
        }  # fmt: skip

    def solved(offsets: dict[str, complex]) -> Displaced:
        here = found.at(offsets)
        assert here is not None
        return here

    for span, number in (
        (found.effort, lambda one: float(one.effort)),
        (found.distance, lambda one: float(one.distance)),
    ):
        by = gradients(number)
        reach = sum(radius * float(np.linalg.norm(by[name])) for name, radius in found.loose.radii.items())
        worst = {name: complex(*(g / np.linalg.norm(g))) * found.loose.radii[name] for name, g in by.items()}
        ends = [number(solved({name: sign * offset for name, offset in worst.items()})) for sign in (-1.0, 1.0)]
        assert span.low == pytest.approx(min(span.value - reach, *ends), rel=1e-5)
        assert span.high == pytest.approx(max(span.value + reach, *ends), rel=1e-5)
        assert abs(ends[1] - span.value - reach) > 1e-3 * reach  # the two ways differ
    for name, span in found.forces.items():
        nominal = solved({}).force(name)
        way = nominal / abs(nominal)
        along = gradients(lambda one, name=name, way=way: (np.conj(way) * one.force(name)).real)
        reach = sum(radius * float(np.linalg.norm(along[at])) for at, radius in found.loose.radii.items())
        worst = {at: complex(*(g / np.linalg.norm(g))) * found.loose.radii[at] for at, g in along.items()}
        assert span.high >= max(span.value + reach, abs(solved(worst).force(name))) * (1.0 - 1e-6)
        assert span.low <= span.value - 0.99 * reach  # the force turns as well


def test_a_dead_point_within_the_first_order_reach_counts_though_no_solved_end_passes_it() -> None:
    """With its gradients made larger, which way it goes is the same, and how far it may go is not."""
    found = played(toggle("0.2 mm", 120.0 - 0.4), "twist")
    assert not found.through_dead_point
    nominal = found.nominal
    assert nominal is not None
    far = 1.01 * float(nominal.distance) / float(found.slack("distance"))
    for share, through in ((0.98 * far, False), (far, True)):
        larger = {n: tuple({k: share * g for k, g in one.items()} for one in by) for n, by in found.gradients.items()}
        other = replace(found)
        other.__dict__["gradients"] = larger
        assert other.through_dead_point is through
        assert (other.nearest is None) is through
        assert (other.distance.low == 0.0) is through


def toggle(play: str, travel: float, guide: str = "0 mm") -> Case:
    """A crank of 30 mm and a coupler of 90 mm on a slider that is driven, with a moment on the crank."""
    twist = ["0 N*mm", "0 N*mm", "50 N*mm"]
    crank = math.degrees(math.acos((30.0**2 + travel**2 - 90.0**2) / (60.0 * travel)))
    near = {"crank": deg(crank), "coupler": deg(-crank / 3.0), "block": "0 deg"}
    return validate(
        {
            "schema_version": 1,
            "title": "toggle",
            "links": {
                "base": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "S": ["0 mm", "0 mm"]}},
                "crank": {"points": {"A": ["0 mm", "0 mm"], "M": ["15 mm", "0 mm"], "B": ["30 mm", "0 mm"]}},
                "coupler": {"points": {"B": ["0 mm", "0 mm"], "C": ["90 mm", "0 mm"]}},
                "block": {"points": {"C": ["0 mm", "0 mm"], "Q": ["10 mm", "0 mm"]}},
            },
            "joints": {
                "A": {"links": ["base", "crank"]},
                "B": {"links": ["crank", "coupler"], "clearance": play},
                "C": {"links": ["coupler", "block"]},
                "S": {"links": ["base", "block"], "type": "slider", "points": ["S", "C"], "clearance": guide},
            },
            "pose": {"coordinate": "S", "travel": f"{travel!r} mm", "near": near},
            "drive": {"link": "block", "joint": "S"},
            "load_cases": {"twist": {"title": "t", "moments": [{"link": "crank", "at": "M", "moment": twist}]}},
        }
    )


@pytest.mark.parametrize(("left", "through"), [(0.09, True), (0.11, False)])
def test_a_toggle_snaps_through_where_its_play_is_what_is_left_of_it(left: float, through: bool) -> None:
    """Crank and coupler are in line 120 mm from the pin: half of the play beyond what is left takes them there."""
    assert played(toggle("0.2 mm", 120.0 - left), "twist").through_dead_point is through


def test_a_slider_crank_near_its_dead_point() -> None:
    """A longer coupler turns the crank by db/cos φ over dx/dθ; the drive's force has that slope as its lever."""
    found, a, b = played(toggle("0.02 mm", 119.0), "twist"), 30.0, 90.0
    angle = found.case.solve_pose().angles["crank"]
    root = math.sqrt(b**2 - (a * math.sin(angle)) ** 2)
    slope = a * math.sin(angle) * (1.0 + a * math.cos(angle) / root)  # -dx/dθ
    assert turned(found.loose, "crank", "A", "B") == pytest.approx(0.01 * b / root / slope, rel=2e-5)
    assert abs(found.effort.value) == pytest.approx(50.0 / slope, rel=1e-9)

    def force(longer: float) -> float:
        """The drive's force with a coupler of another length, from the triangle of crank, coupler and travel."""
        length = b + longer
        other = math.acos((a**2 + 119.0**2 - length**2) / (2.0 * a * 119.0))
        root = math.sqrt(length**2 - (a * math.sin(other)) ** 2)
        return 50.0 / (a * math.sin(other) * (1.0 + a * math.cos(other) / root))

    ends = sorted((abs(found.effort.low), abs(found.effort.high)))
    assert ends == pytest.approx([force(0.01), force(-0.01)], rel=2e-3)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("3 mm", r"joints\.O\.clearance: it is 3 mm, but must stay below the pin's diameter, 3 mm"),
        ("-0.1 mm", r"joints\.O\.clearance.* must not be negative"),
        ("0.1", r"joints\.O\.clearance"),
    ],
)
def test_play_that_no_pin_has_is_refused(entry: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        arm_case(entry)


def test_play_without_pin_diameter_is_less_than_its_links() -> None:
    with pytest.raises(
        CaseError, match=r"joints\.B\.clearance: it is 40 mm, but must stay below the shortest distance"
    ):
        linkage_case({"B": "40 mm"}, ("1 N", "0 N"))


def test_play_of_a_slider_is_refused() -> None:
    with pytest.raises(CaseError, match=r"joints\.S\.clearance: a slider has no pin"):
        toggle("0 mm", 110.0, guide="0.1 mm")


def test_no_play_no_result() -> None:
    case = arm_case("0 mm")
    assert play_of(case, "tip", case.solve_pose(), {}) is None


def test_the_drive_is_held_and_not_the_coordinate() -> None:
    """The pose may be stated by another link than the one that the drive holds."""
    case = linkage_case({"B": "0.3 mm"}, ("1 N", "0 N"))
    assert held_rows(case.solve_pose().placement, case.pinned_drive).tolist() == [[1.0, 0.0, 0.0]]
