"""Play of pins over a motion: against closed forms of the four-bar, and against linkages with other lengths."""

import json
import math
import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
from edited_cases import edited
from numpy.typing import NDArray
from rocker_case import TOML
from told_motion import record, rows, texts

from alula.fea.asked.asked import asked
from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity
from alula.fea.doubts.load_growth import Growths
from alula.fea.doubts.narrow_holes import narrower
from alula.fea.findings.of_motion import motion_findings
from alula.fea.links.link_by_hand import HandStates
from alula.fea.motion.envelope import envelope_case
from alula.fea.motion.envelope_outcomes import _at_worst_pose
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.loading import loading_over
from alula.fea.motion.loosened import joint_growth, loosened
from alula.fea.refine.refinement import Effort
from alula.fea.whole.motor import motor_outcomes
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import EyeCheck
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.loads.states.loose_motion import LooseMotion, loose_motion
from alula.reports.motion.play import drive_with_play, play_record

Real = NDArray[np.float64]
A, B, C, D = 40.0, 120.0, 80.0, 100.0
FORCE = complex(4.0, -7.0)


@cache
def moved(play: str = "0.4 mm", driven: str = "crank", ground: complex = D, **joints: str) -> CaseMotion:
    """The four-bar of 40, 120, 80 and 100 mm with a force at its rocker's pin C and play at B, over a turn."""
    pairs = {"A": ["base", "crank"], "B": ["crank", "coupler"], "C": ["coupler", "rocker"], "D": ["base", "rocker"]}
    play_of = {"B": play, **joints}
    data: dict[str, Any] = {
        "schema_version": 1,
        "title": "four-bar",
        "links": {
            "base": {
                "ground": True,
                "points": {"A": ["0 mm", "0 mm"], "D": [f"{ground.real} mm", f"{ground.imag} mm"]},
            },
            "crank": {"points": {"A": ["0 mm", "0 mm"], "B": [f"{A} mm", "0 mm"]}},
            "coupler": {"points": {"B": ["0 mm", "0 mm"], "C": [f"{B} mm", "0 mm"]}},
            "rocker": {"points": {"D": ["0 mm", "0 mm"], "C": [f"{C} mm", "0 mm"]}},
        },
        "joints": {n: {"links": pair, "clearance": play_of.get(n, "0 mm")} for n, pair in pairs.items()},
        "pose": {"coordinate": "crank", "angle": "40 deg", "near": {"coupler": "20 deg", "rocker": "70 deg"}},
        "drive": {"link": driven, "joint": "A" if driven == "crank" else "D"},
        "motion": {"turn": True, "poses": 73},
        "load_cases": {"load": {"forces": [{"link": "rocker", "at": "C", "force": ["4 N", "-7 N"]}]}},
    }
    return solve_case_motion(validate(data))


def loose(of: CaseMotion) -> LooseMotion:
    found = loose_motion(of)
    assert found is not None
    return found


def place_of_c(pin: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Where two circles meet: about the coupler's pin with its length, about D with the rocker's."""
    across = D - pin
    far = np.abs(across)
    along = (B**2 - C**2 + far**2) / (2.0 * far)
    return pin + across / far * (along + 1j * np.sqrt(B**2 - along**2))


def torque(crank: Real, offset: complex = 0.0) -> Real:
    """The coupler bears a force along itself: the rocker's moments about D give it, those of the crank the torque."""
    pin = A * np.exp(1j * crank) + offset
    c = place_of_c(pin)
    along = (c - pin) / B
    tension = (np.conj(c - D) * FORCE).imag / (np.conj(c - D) * along).imag
    return -tension * (np.conj(pin) * along).imag


def test_drive_torque_at_all_poses() -> None:
    """Play at B sets the coupler's pin beside the crank's."""
    of = moved()
    angles = of.motion.angles
    assert of.torque["load"] == pytest.approx(torque(angles), rel=1e-9, abs=1e-9)
    least, most = loose(of).effort("load")
    slopes = [(torque(angles, 0.01 * way) - torque(angles, -0.01 * way)) / 0.02 for way in (1.0, 1j)]
    assert (most - least) / 2.0 == pytest.approx(0.2 * np.hypot(*slopes), rel=1e-4, abs=1e-4)
    value, pose = loose(of).extreme_effort("load", 1.0)
    solved = max(torque(angles[pose], 0.2 * np.exp(1j * way)) for way in np.linspace(0.0, 2.0 * math.pi, 721))
    assert value == pytest.approx(solved, rel=1e-5)
    assert value >= most.max()
    value, pose = loose(of).extreme_effort("load", -1.0)
    solved = min(torque(angles[pose], 0.2 * np.exp(1j * way)) for way in np.linspace(0.0, 2.0 * math.pi, 721))
    assert value == pytest.approx(min(solved, least.min()), rel=1e-5)
    assert pose == int(np.argmin(least))


def test_free_motion_at_all_poses() -> None:
    """The rocker's end strays by half of the play over the sine of the transmission angle; B by half of it."""
    of = moved()
    to_c = place_of_c(A * np.exp(1j * of.motion.angles))
    sine = np.abs(np.sin(np.angle((to_c - D) / (to_c - A * np.exp(1j * of.motion.angles)))))
    assert loose(of).free_motion("rocker", "C") == pytest.approx(0.2 / sine, rel=1e-4)
    assert np.all(loose(of).free_motion("crank", "B") == 0.0)
    reach = np.abs(loose(of).outline("coupler", "B")).max(axis=-1)
    assert reach == pytest.approx(np.full(73, 0.2), rel=1e-4)


def test_distance_to_a_dead_point_at_all_poses() -> None:
    """Without play it is that of the constraints' Jacobian; play at D is as if its pin stood elsewhere."""
    of = moved("0 mm", D="0.2 mm")
    value, least = loose(of).distance
    expected = [of.drive.dead_point_distance(of.motion.pose(i)) for i in range(73)]
    assert value == pytest.approx(expected, rel=1e-9)
    tried = []
    for way in np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False)):
        other = moved("0 mm", ground=D + 0.1 * way)
        tried.append([other.drive.dead_point_distance(other.motion.pose(i)) for i in range(73)])
    changes = np.min(tried, axis=0) - value
    assert np.all(least <= value + 0.99 * changes)
    assert np.all(least >= value + 1.03 * changes)
    nearest, pose = loose(of).nearest()
    assert 0.0 < nearest <= least[pose] < value[pose]


def test_at_a_dead_point_of_the_drive_nothing_has_an_end() -> None:
    """The rocker drives: it turns back where crank and coupler are in line, twice in a turn."""
    of = moved("2 mm", "rocker")
    assert len(of.dead_points) == 2
    least, most = loose(of).effort("load")
    for angle in of.dead_points:
        beside = np.argsort(np.abs(of.motion.angles - angle))[:2]
        assert np.all(np.isinf(most[beside]))
        assert np.all(np.isinf(least[beside]))
    assert 4 <= int(loose(of).passes.sum()) < 40
    found = play_record(motion_findings(of))
    assert found is not None
    assert len(found["through_dead_point"]) == 2
    assert found["dead_point_distance"]["smallest"] == 0.0
    told = drive_with_play(of, found, "load").text
    assert told == "With play of pins the drive torque has no end next to a dead point."
    assert any("through a dead point of rocker at" in line for line in texts(of, "play"))


def test_the_whole_motion_agrees_with_single_poses() -> None:
    of = moved("0.5 mm", A="0.2 mm", C="0.4 mm", D="0.3 mm")
    least, most = loose(of).effort("load")
    for pose in range(0, 73, 18):
        play = loose(of).play("load", pose)
        assert play is not None
        single = play.effort
        assert (least[pose], most[pose]) == pytest.approx((single.low, single.high), abs=0.02 * (most - least)[pose])
        for link, point in (("coupler", "C"), ("rocker", "C")):
            free = play.free_motion(link, point)
            assert loose(of).free_motion(link, point)[pose] == pytest.approx(free, rel=0.02)


def test_friction_is_solved_with_play() -> None:
    """The torque without play that bands are about is that of the motion, friction and inertia included."""
    for entries in (["joints.C.friction=0.3"], []):
        case = edited("owl-wing-static", ["motion.poses=25", 'joints.B.clearance="0.1 mm"', *entries])
        of = solve_case_motion(case)
        for name, play in loose(of).plays.items():
            here = play.solved({})
            sound = here.sound
            assert sound.any()
            assert here.effort[sound] == pytest.approx(of.torque[name][loose(of).poses][sound], rel=1e-9)


def test_record_and_tables_tell_it() -> None:
    of = moved()
    told = record(of)["play"]
    assert json.loads(json.dumps(told)) == told
    assert told["clearances"] == {"B": 0.4}
    assert told["points"]["C"]["largest"] == pytest.approx(float(loose(of).free_motion("rocker", "C").max()), rel=2e-2)
    torque = rows(of, "torque.csv")
    least, most = loose(of).effort("load")
    assert float(torque[5]["least torque with play [N mm]"]) == pytest.approx(least[5])
    assert float(torque[5]["largest torque with play [N mm]"]) == pytest.approx(most[5])
    assert "C play to either side [mm]" in rows(of, "points.csv")[0]
    assert record(moved("0 mm"))["play"] is None


def test_a_motor_covers_what_play_makes_of_the_torque() -> None:
    """A lever's pivot that stands half of the play aside asks for no more than the bands, and for more than without."""
    motor = ['checks.motor.rated_torque="0.002 N*mm"', 'checks.motor.no_load_speed="3500 rpm"']
    motor.append('checks.motor.stall_torque="0.01 N*mm"')

    def outcomes(entry: str) -> dict[str, Any]:
        case = edited("ornithopter", [*motor, entry], fits=False)
        case = case.model_copy(update={"load_cases": {"wings-12": case.load_cases["wings-12"]}})
        return {o.quantity.value: o.value for o in motor_outcomes(case, "motor", case.checks["motor"])["wings-12"]}

    loose = outcomes('joints.R.clearance="0.1 mm"')
    aside = [
        outcomes(f'links.base.points.R=["{x!r} mm", "10 mm"]') for x in (7.06755709747 - 0.05, 7.06755709747 + 0.05)
    ]
    assert len(loose) == 4
    for what in loose.keys() - {"drive speed"}:
        assert loose[what].value < max(one[what].high for one in aside) <= loose[what].high
        assert loose[what].low <= min(one[what].low for one in aside)
        assert SourceKind.PLAY in {source.kind for source in loose[what].sources}


def rocker(play: str, coupler: str = "60 mm", pin: float | None = None, **more: Any) -> Case:
    """The four-bar of 20, 60, 40 and 60 mm with a force at its rocker's end, over a sixth of a turn."""
    data = tomllib.loads(TOML) | more
    data["joints"]["B"] |= {"clearance": play} | ({} if pin is None else {"pin_diameter": f"{pin} mm"})
    data["links"]["coupler"]["points"]["B"] = [coupler, "0 mm"]
    data["load_cases"] = {"push": {"forces": [{"link": "rocker", "at": "P", "force": ["1 N", "-3 N"]}]}}
    data["checks"] = {"bearing": {"type": "bearing", "minimum": 2.0, "joints": ["B"]}} | data.get("checks", {})
    return validate(data)


def test_an_envelope_holds_the_linkage_with_another_coupler() -> None:
    """Beside it one whose pin is as wide as the hole: of the same stress, and of less pressure by 3.8 over 3."""
    cases = rocker("0.8 mm", pin=3.0), rocker("0 mm", pin=3.8)
    loose, plain = (envelope_case(case, threads=1, effort=Effort(max_meshes=1)) for case in cases)
    stress, without = (one.links["rocker"].load_cases["push"].stress for one in (loose, plain))
    assert stress.value == pytest.approx(without.value)
    assert SourceKind.PLAY in {source.kind for source in stress.sources}
    assert SourceKind.PLAY not in {source.kind for source in without.sources}
    [bearing], [joint] = ([c for c in one.checks if c.name == "bearing"] for one in (loose, plain))
    assert bearing.value.low < joint.value.low * 3.0 / 3.8

    def greatest(case: Case) -> tuple[float, float]:
        """Stress by hand and force at B, the most of all poses, of a linkage without play."""
        of = solve_case_motion(case)
        every = [link_loads("push", "rocker", case.body("rocker"), of.forces["push"], of.loads["push"])]
        poses = [(every[0].chosen(pose),) for pose in range(len(of.motion.angles))]
        return float(HandStates(case, "rocker", poses).stress.max()), float(
            np.linalg.norm(of.forces["push"].forces["B"], axis=1).max()
        )

    of, every = solve_case_motion(rocker("0.8 mm")), np.ones(7, dtype=np.bool_)
    shares = loosened(of, every)["push", "rocker"], joint_growth(of, "push", "B", every)
    nominal = greatest(rocker("0 mm"))
    for length in ("59.6 mm", "60.4 mm"):
        for share, other, own in zip(shares, greatest(rocker("0 mm", length)), nominal, strict=True):
            assert share.low * own <= other * (1.0 + 1e-3)
            assert other <= share.high * own * (1.0 + 1e-3)
    holes = narrower(of.case, "rocker").high
    assert stress.high == pytest.approx(without.high * shares[0].high * holes, rel=1e-6)


def test_an_envelope_that_play_takes_through_a_dead_point_is_refused() -> None:
    """The rocker drives; it turns back where crank and coupler are in line, and play of 2.9 mm takes it there."""
    drive = {"link": "rocker", "joint": "O4"}
    case = rocker("2.9 mm", drive=drive)
    of = solve_case_motion(case)
    with pytest.raises(
        CaseError, match=r"joints\.B\.clearance: with 2\.9 mm play .* dead point of the driven link rocker"
    ):
        loosened(of, np.ones(7, dtype=np.bool_))


SWUNG = """
schema_version = 1
title = "An eye that is judged across its shank, away from the largest force"
large_displacement = "off"
links.base = { ground = true, points.O2 = ["0 mm", "0 mm"], points.O4 = ["140 mm", "-34 mm"] }
links.crank = { part = "bar", points.O2 = ["0 mm", "0 mm"], points.A = ["22 mm", "0 mm"] }
links.coupler = { part = "bar", points.A = ["0 mm", "0 mm"], points.B = ["140 mm", "0 mm"] }
[links.rocker]
part = "bar"
points = { O4 = ["0 mm", "0 mm"], B = ["34 mm", "0 mm"], P = ["60 mm", "0 mm"] }
[joints]
O2 = { links = ["base", "crank"], pin_diameter = "3 mm", clearance = { base = "2 mm" } }
A = { links = ["crank", "coupler"], pin_diameter = "3 mm", clearance = { crank = "0.5 mm", coupler = "0.5 mm" } }
B = { links = ["coupler", "rocker"], pin_diameter = "3 mm", clearance = { coupler = "0.5 mm", rocker = "0.5 mm" } }
O4 = { links = ["base", "rocker"], pin_diameter = "3 mm", clearance = { base = "2 mm" } }
[pose]
coordinate = "crank"
angle = "90 deg"
near = { coupler = "-9 deg", rocker = "90 deg" }
[drive]
link = "crank"
joint = "O2"
[motion]
turn = true
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "6 mm"
thickness = "4 mm"
fillet_radius = "1 mm"
[load_cases]
pull.forces = [{ link = "rocker", at = "P", force = ["-15 N", "26 N"] }]
push.forces = [{ link = "rocker", at = "P", force = ["-10.3 N", "28.2 N"] }]
[checks.eyes]
type = "eye"
minimum = 2.4
"""


def test_eyes_over_a_motion_bear_as_little_as_in_any_of_its_poses() -> None:
    """Across its shank an eye bears less, where its force may grow by more than the largest of the motion does."""
    tables = tomllib.loads(SWUNG)
    case = validate(tables)
    of = solve_case_motion(case)
    loaded = {link: link_histories(of, link) for link in case.checked_links}
    every = np.ones(len(of.motion.angles), dtype=np.bool_)
    lows = {}
    for load_case in case.load_cases:
        over = loading_over(of, load_case, every, loaded, Growths())
        for one in asked(case, EyeCheck):
            lows[load_case, one.subject.name] = _at_worst_pose(of, over, one).value.low
    for angle in (165, 285, 300):
        tables["pose"]["angle"] = f"{angle} deg"
        for load_case, result in check_case(validate(tables), fidelity="beam").load_cases.items():
            for check in result.checks:
                if check.quantity is Quantity.EYES:
                    assert lows[load_case, check.link] <= 1.007 * check.value.low
