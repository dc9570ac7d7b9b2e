"""Friction in whole cases: work and balance over a motion, what a link bears, and what locks."""

import json
from typing import Any

import numpy as np
import pytest
import slotted_cases
from edited_cases import edited
from programs import inside

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.anchor import anchor_loads
from alula.fea.check.run import check_case
from alula.fea.motion.envelope import envelope_case
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.rubbing import presses_of
from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Link
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.case.joint_rules import check_friction
from alula.loads.case.toleranced import toleranced
from alula.loads.records.applied import FrictionLoad, at_poses, shifted
from alula.loads.records.load_case import LoadCase
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.drive_work import efficiency
from alula.loads.states.kinetostatics import torque_by_virtual_work
from alula.loads.states.play import play_of
from alula.loads.states.rubbing import at_one_pose, each_direction
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.statics import Drive

STARTER = "tests/unit/loads/four-bar-laden.toml"
PINS = [f"joints.{name}.friction=0.3" for name in ("O2", "A", "B", "O4")]
TURN = ["motion.turn=true", "motion.poses=73", "load_cases.turning.speed=0 rpm"]


def rubbing(case: Case, friction: float = 0.3, **joints: Any) -> Case:
    """Return a case with friction at every joint, and a load on every point of its links."""
    changed = {
        name: joint.model_copy(update={"friction": friction} | joints.get(name, {}))
        for name, joint in case.joints.items()
    }
    link = case.linkage.moving[-1]
    forces = [{"link": link, "at": next(iter(case.links[link].points)), "force": ["3 N", "-5 N"]}]
    moments = [{"link": link, "at": next(iter(case.links[link].points)), "moment": "40 N*mm"}]
    load = LoadCase.model_validate({"forces": forces, "moments": moments})
    motion = MotionSpec.model_validate({"turn": True, "poses": 61})
    return case.model_copy(update={"joints": changed, "load_cases": {"pull": load}, "motion": motion})


@pytest.mark.parametrize(
    "case",
    [
        slotted_cases.slider_crank(),
        slotted_cases.quick_return(),
        slotted_cases.scotch_yoke(),
        slotted_cases.oscillating_cylinder(),
        slotted_cases.pin_on_the_ground(),
    ],
    ids=["slider-crank", "quick-return", "scotch-yoke", "cylinder", "pin-on-the-ground"],
)
def test_drive_pays_for_what_is_rubbed(case: Case) -> None:
    """By virtual work, which knows no joint forces: the drive's power with friction is that without and what is rubbed.

    The power that is rubbed is summed here from the speed at each contact, of the pin's wall in a slot.
    """
    guided = {name: {"guide_length": 30.0} for name, joint in case.joints.items() if joint.type == "slider"}
    moved = solve_case_motion(rubbing(case, 0.1, **guided))
    assert list(moved.rubbing) == ["pull forward", "pull backward"]
    for name, found in moved.rubbing.items():
        work, free = moved.work(name), ~found.locked
        assert free.sum() > 30
        virtual = torque_by_virtual_work(moved.motion, moved.drive, moved.loads[name])
        assert virtual[free] == pytest.approx(moved.torque[name][free], rel=1e-9, abs=1e-9)
        place, rubbed = moved.motion.virtual, np.zeros(free.size)
        for joint, record in moved.case.joints.items():
            wrench = moved.forces[name].joints[joint].wrench
            turn = place.spin(record.links[1]) - place.spin(record.links[0])
            if record.type == "revolute":
                speed, pressed = 1.0 * turn, np.hypot(wrench[:, 0], wrench[:, 1])
            else:
                along = place.direction(record.links[0]) * np.exp(1j * record.direction)
                across = (np.conj(1j * along) * (wrench[:, 0] + 1j * wrench[:, 1])).real
                speed, pressed = (
                    moved.motion.first[:, len(place.linkage.moving) + place.closure.slots.index(joint)],
                    across,
                )
                if record.type == "slider":
                    pressed = np.maximum(np.abs(across), 2.0 * np.abs(wrench[:, 5]) / 30.0)
                else:  # it touches the flank below the pin that lifts it
                    speed = speed + np.sign(across) * 1.0 * turn
            rubbed += 0.1 * np.abs(pressed) * np.abs(speed)
        assert (work.power - work.power_without)[free] == pytest.approx(rubbed[free], rel=1e-9, abs=1e-9)


def test_links_balance_and_bear_the_couples_of_their_pins() -> None:
    case = edited(STARTER, [*PINS, *TURN])
    moved = solve_case_motion(case)
    for name in moved.forces:
        for link in case.checked_links:
            loads = link_loads(name, link, case.body(link), moved.forces[name], moved.loads[name])
            assert np.abs(loads.resultant()).max() < 1e-9 * loads.size(100.0).max() * 100.0
            for pin in loads.pins:
                size = np.hypot(pin.wrench[:, 0], pin.wrench[:, 1])
                turns = pin.friction != 0.0  # not where the rocker turns back
                assert turns.sum() > 70
                assert np.abs(pin.friction[turns]) == pytest.approx(0.3 * 1.5 * size[turns], rel=1e-9)
                assert pin.wrench[:, 5] == pytest.approx(pin.friction, abs=1e-12)


def test_ground_bears_the_applied_loads_whatever_rubs() -> None:
    """Friction is inside: force and moment on the ground are those of the weight, in both directions."""
    entries = ["load_cases.turning.speed=0 rpm", "large_displacement=off"]
    plain = anchor_loads(check_case(edited(STARTER, entries), fidelity="beam").load_cases["turning"]).total
    result = check_case(edited(STARTER, [*entries, *PINS]), fidelity="beam")
    assert list(result.load_cases) == ["turning forward", "turning backward"]
    for load_case in result.load_cases.values():
        assert anchor_loads(load_case).total == pytest.approx(plain, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("case", [slotted_cases.quick_return(), slotted_cases.slider_crank()], ids=["slot", "slider"])
def test_links_in_layers_balance_with_friction(case: Case) -> None:
    """All six components, with what rubs along a slot or guide at its height; the ground bears the load alone."""
    links = {name: link.model_copy(update={"layer": i}) for i, (name, link) in enumerate(case.links.items())}
    case = rubbing(case, 0.1).model_copy(update={"links": links, "layer_spacing": 6.0})
    statics = solve_case_statics(case)
    for name, reactions in statics.reactions.items():
        for link in case.checked_links:
            loads = link_loads(name, link, case.body(link), reactions, statics.loads[name])
            assert np.abs(loads.resultant()).max() < 1e-9 * 5.0 * 100.0
        total = np.zeros(6)
        for load in statics.loads[name]:
            if isinstance(load, FrictionLoad):
                origin = np.array([*statics.pose.origins[load.link], statics.case.heights[load.link]])
                total += shifted(load.resultant(statics.pose.placement), origin)
        assert total == pytest.approx(np.zeros(6), abs=1e-9)
        planar = solve_case_statics(statics.case.model_copy(update={"links": case.links | flat(links)}))
        work = [one.work[name] for one in (statics, planar)]  # couples between layers press the bores as well
        assert work[0].power_without == pytest.approx(work[1].power_without, rel=1e-9)
        assert work[0].power[0] - work[0].power_without[0] > 1.01 * (work[1].power[0] - work[1].power_without[0])


@pytest.mark.parametrize("friction", [0.05, 0.2, 0.4])
def test_the_path_of_a_stiff_frame_ends_where_rounding_does(friction: float) -> None:
    """In layers, with couples at its pins, it ended at no load at all: Newton's method stagnates above one rounding."""
    entries = [
        *("load_cases.turning.speed=0 rpm", "layer_spacing=6 mm", "links.crank.layer=1", "links.coupler.layer=2"),
        *("links.rocker.layer=1", "links.base.layer=0"),
        'load_cases.turning.forces=[{link="rocker",at="P",force=["0 N","-5 N"]}]',
    ]
    statics = solve_case_statics(edited(STARTER, [*entries, *(pin.replace("0.3", str(friction)) for pin in PINS)]))
    for name, forces in statics.forces.items():
        assert examine(statics.case, name, forces, statics.loads[name]).state == "deformed"


def test_play_moves_pins_against_the_forces_with_friction() -> None:
    """Without play, its drive is that of statics; with it, the drive stays within a hundredth of it."""
    clear = [f"joints.{name}.clearance=0.05 mm" for name in ("A", "B")]
    case = edited(STARTER, [*PINS, *clear, "load_cases.turning.speed=0 rpm"])
    statics = solve_case_statics(case)
    for name, reactions in statics.reactions.items():
        found = play_of(statics.case, name, statics.pose, statics.masses)
        assert found is not None
        assert found.nominal is not None
        assert found.settled is not None
        assert found.nominal.effort == pytest.approx(reactions.drive_torque, rel=1e-9)
        assert found.settled.effort == pytest.approx(reactions.drive_torque, rel=1e-2)


def flat(links: dict[str, Link]) -> dict[str, Link]:
    return {name: link.model_copy(update={"layer": 0}) for name, link in links.items()}


def test_without_friction_and_with_none_all_is_the_same() -> None:
    plain = read_case(STARTER)
    none = edited(STARTER, [entry.replace("0.3", "0") for entry in PINS])
    assert each_direction(none) is none
    first, second = (solve_case_statics(case).reactions["turning"] for case in (plain, none))
    assert np.array_equal(first.unknowns, second.unknowns)


@pytest.mark.parametrize(("speed", "way"), [("60 rpm", "backward"), ("-60 rpm", "forward")])
def test_a_direction_against_the_speed_is_refused(speed: str, way: str) -> None:
    """Friction would help the drive then, whose power goes with its speed."""
    against = [*PINS, f'load_cases.turning.speed="{speed}"', f'load_cases.turning.direction="{way}"']
    with pytest.raises(CaseError, match=rf"load_cases\.turning\.direction: it is {way}, against the speed that"):
        solve_case_statics(edited(STARTER, against))
    other = {"backward": "forward", "forward": "backward"}[way]
    assert set(solve_case_statics(edited(STARTER, [*against[:-1], f'load_cases.turning.direction="{other}"'])).forces)


def test_redundant_linkage_takes_its_friction_from_the_frame() -> None:
    """The frame and its friction settle on forces for which the drive pays, by virtual work, for what is rubbed."""
    parallel = validate(parallel_cranks(friction=0.2))
    assert parallel.linkage.mobility == 0
    solved, drive = solve_case_statics(parallel), Drive(link="crank0", joint="O0")
    assert set(solved.work) == {"lift forward", "lift backward"}
    for name, work in solved.work.items():
        loads = [at_poses(load, (1,)) for load in solved.loads[name]]
        paid = torque_by_virtual_work(at_one_pose(solved.pose), drive, loads)
        assert paid == pytest.approx(work.effort, rel=1e-6)
        assert float(work.power[0] - work.power_without[0]) > 1.0
        turning = {"O": 1.0, "A": -1.0}  # of each pin's second link against its first, forwards
        for joint, wrench in friction_wrenches(solved.loads[name]).items():
            sense = turning[joint[0]] * (1.0 if work.way == "forward" else -1.0)
            force = solved.reactions[name].joints[joint].force[:2]
            assert wrench[5] == pytest.approx(-0.2 * 1.5 * sense * float(np.hypot(*force)), rel=1e-6)


def parallel_cranks(friction: float) -> dict[str, Any]:
    """Three equal cranks that carry one bar: one more than equilibrium can tell apart."""
    bar = {"shape": "bar", "material": "pla-fdm-xy", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}
    cranks = {
        f"crank{i}": {"part": "bar", "points": {f"O{i}": ["0 mm", "0 mm"], f"A{i}": ["40 mm", "0 mm"]}}
        for i in range(3)
    }
    pins = {"pin_diameter": "3 mm", "friction": friction}
    return {
        "schema_version": 1,
        "title": "three parallel cranks",
        "links": {
            "base": {"ground": True, "points": {f"O{i}": [f"{50 * i} mm", "0 mm"] for i in range(3)}},
            **cranks,
            "beam": {"part": "bar", "points": {f"A{i}": [f"{50 * i} mm", "0 mm"] for i in range(3)}},
        },
        "joints": {f"O{i}": {"links": ["base", f"crank{i}"]} | pins for i in range(3)}
        | {f"A{i}": {"links": [f"crank{i}", "beam"]} | pins for i in range(3)},
        "pose": {
            "coordinate": "crank0",
            "angle": "50 deg",
            "near": {"crank1": "50 deg", "crank2": "50 deg", "beam": "0 deg"},
        },
        "drive": {"link": "crank0", "joint": "O0"},
        "parts": {"bar": bar},
        "load_cases": {"lift": {"forces": [{"link": "beam", "at": "A1", "force": ["4 N", "-20 N"]}]}},
    }


def drawer(friction: float, length: str | None) -> dict[str, Any]:
    """A drawer that is pulled 40 mm beside the middle of its guide, against a force in the middle."""
    guide = {} if length is None else {"guide_length": length}
    return {
        "schema_version": 1,
        "title": "a drawer",
        "links": {
            "chest": {"ground": True, "points": {"S": ["0 mm", "0 mm"]} | {"G": ["10 mm", "0 mm"]}},
            "drawer": {"points": {"S": ["0 mm", "0 mm"], "W": ["0 mm", "40 mm"]}},
        },
        "joints": {"S": {"type": "slider", "links": ["chest", "drawer"], "friction": friction} | guide},
        "pose": {"coordinate": "S", "travel": "5 mm"},
        "drive": {"link": "drawer", "joint": "S"},
        "load_cases": {
            "pull": {"forces": [{"link": "drawer", "at": "W", "force": ["-6 N", "0 N"]}], "direction": "forward"}
        },
    }


def test_drawer_sticks_where_its_guide_is_short() -> None:
    """The ends of the guide bear 2 M / L in all: P = F (1 + 2 mu e / L)."""
    pushed = solve_case_statics(validate(drawer(0.3, "50 mm")))
    assert pushed.reactions["pull"].drive_force == pytest.approx(6.0 * (1.0 + 2.0 * 0.3 * 40.0 / 50.0), rel=1e-12)
    assert pushed.work["pull"].efficiency[0] == pytest.approx(1.0 / (1.0 + 2.0 * 0.3 * 40.0 / 50.0), rel=1e-12)
    free = solve_case_statics(validate(drawer(0.3, None)))
    assert free.reactions["pull"].drive_force == pytest.approx(6.0, rel=1e-12)


def piston(*entries: tuple[str, Any]) -> Case:
    data = slotted_cases.piston_entries()
    data["motion"] = {"travel": ["90 mm", "158 mm"], "poses": 69}
    for joint in data["joints"].values():
        joint |= {"friction": 1.5} | ({} if "type" in joint else {"pin_diameter": "6 mm"})
    for path, value in entries:
        above, last = path.split(".")
        data[above][last] = value
    return validate(data)


def test_locked_stretches_are_found_and_named(tmp_path) -> None:
    """Near its end of travel the piston's push no longer clears the friction circles; where, more poses tell finer."""
    coarse, fine = solve_case_motion(piston()), solve_case_motion(piston(("motion.poses", 1301)))
    [name] = [name for name, found in coarse.rubbing.items() if found.spans]
    [(low, high)], [(finer, _)] = coarse.rubbing[name].spans, fine.rubbing[name].spans
    assert low == pytest.approx(finer, abs=0.05)
    assert high == pytest.approx(158.0)
    assert np.isnan(coarse.torque[name][coarse.rubbing[name].locked]).all()
    assert f"locks itself from {low:.4g} to 158 mm of S" in coarse.locks[0]


SPRUNG = [
    *PINS,
    *("load_cases.turning.speed=0 rpm", "stops.end.joint=O2", "stops.end.at_least=40 deg"),
    *("springs.back.joint=O4", "springs.back.free_angle=90 deg"),
]


def test_a_stop_bears_what_the_drive_would() -> None:
    stiffness = "springs.back.stiffness=5 N*mm/rad"
    stopped = solve_case_statics(edited(STARTER, [*SPRUNG, stiffness]))
    driven = solve_case_statics(edited(STARTER, [*SPRUNG, stiffness, "stops.end.at_least=39 deg"]))
    assert not stopped.work
    for name, standing in stopped.standing.items():
        assert standing.contact == pytest.approx(driven.reactions[name].drive_torque, rel=1e-12)
    with pytest.raises(CaseError, match=r"stops\.end: .* friction alone holds the linkage there"):
        solve_case_statics(edited(STARTER, [*SPRUNG, "springs.back.stiffness=19 N*mm/rad"]))


STUCK = "with friction the linkage locks itself in this pose, driven backward \\(the travel of S falls\\)"


def test_a_locked_pose_is_refused_unless_it_never_moves_that_way() -> None:
    stuck = piston(("pose.travel", "157.6 mm"))
    with pytest.raises(CaseError, match=STUCK):
        solve_case_statics(stuck)
    one_way = stuck.model_copy(
        update={"load_cases": {n: c.model_copy(update={"direction": "forward"}) for n, c in stuck.load_cases.items()}}
    )
    assert list(solve_case_statics(one_way).work) == ["brake"]


def test_command_says_where_it_locks(tmp_path) -> None:
    path = tmp_path / "four.toml"
    entries = ["--set", "drive.link=rocker", "--set", "drive.joint=O4"]
    for pin in PINS:
        entries += ["--set", pin]
    inside("new", str(path))
    entries += ["--set", "motion.poses=91"]
    ended = inside("motion", str(path), *entries, "--json")
    record = json.loads(ended.stdout)["load_cases"]["lift backward"]["friction"]
    assert ended.returncode == 3
    assert "locks itself from" in ended.stderr
    [[low, high]] = record["locked"]
    assert low < 231.3 < high  # its dead point
    with pytest.raises(CaseError, match="locks itself"):
        envelope_case(edited(str(path), [entry for entry in entries if entry != "--set"]))
    told = inside("statics", str(path), *entries[4:])
    assert "Friction, driven forward (the angle of crank grows): drive" in told.stdout
    assert "efficiency" in told.stdout


REFUSED = {
    "joints.O2.friction=2.1": "joints.O2.friction .it is 2.1.: it must be at most 2; make it smaller",
    "joints.O2.friction=-0.1": "joints.O2.friction .it is -0.1.: it must be at least 0; make it larger",
    "joints.O2.guide_length=3 mm": "joints.O2.guide_length: joint O2 is no slider",
    "joint_model=bonded": "joints.O2.friction: it is 0.3, but a bonded joint does not turn",
}


@pytest.mark.parametrize("entry", REFUSED)
def test_what_is_refused(entry: str) -> None:
    with pytest.raises(CaseError, match=REFUSED[entry]):
        edited(STARTER, [*PINS, entry])


def test_more_is_refused() -> None:
    twice = parallel_cranks(0.2)
    twice["load_cases"]["lift backward"] = twice["load_cases"]["lift"]
    with pytest.raises(CaseError, match=r"load_cases\.lift backward: with friction, load case 'lift' in one direction"):
        validate(twice)
    moving = parallel_cranks(0.2) | {"motion": {"range": ["40 deg", "60 deg"]}}
    with pytest.raises(CaseError, match=r"joints\.O0\.friction: the linkage is redundant"):
        solve_case_motion(validate(moving))
    with pytest.raises(CaseError, match=r"joints\.O2\.friction: it is 0.3, with which a linkage that is let go"):
        edited(STARTER, [*PINS, "pose.equilibrium=true", "springs.back.joint=O4", "springs.back.stiffness=5 N*mm/rad",
                         "springs.back.free_angle=90 deg", "load_cases.turning.speed=0 rpm"])  # fmt: skip
    held = validate(parallel_cranks(0.2)).model_copy(update={"drive": None})
    with pytest.raises(CaseError, match=r"joints\.O0\.friction: .* nothing drives this linkage"):
        check_friction(held)


def test_efficiency_is_work_out_over_work_in() -> None:
    """Lifting, lowering by the load, lowering by the drive since the load does not, and where nothing is done."""
    found = efficiency(np.array([2.0, -2.0, -2.0, 0.0]), np.array([4.0, -1.0, 1.0, 1.0]))
    assert found[:3].tolist() == [0.5, 0.5, 0.0]
    assert np.isnan(found[3])


def test_a_weight_that_returns_leaves_the_work_that_was_rubbed() -> None:
    moved = solve_case_motion(edited(STARTER, [*PINS, *TURN]))
    for name in moved.rubbing:
        work = moved.work(name)
        assert (work.total_without, np.isnan(work.of_cycle)) == (0.0, True)
        assert work.total == pytest.approx(float(np.trapezoid(work.power - work.power_without, TURNED)), rel=1e-9)


TURNED = np.linspace(0.0, 2.0 * np.pi, 73)


@pytest.mark.parametrize("degrees", [17.0, 33.7, 47.3, 61.9])
def test_a_joint_that_does_not_move_does_not_rub(degrees: float) -> None:
    """A crank pushes two blocks along one inclined guide; the rod between them turns by rounding alone."""
    guide = {"type": "slider", "points": ["A", "B"], "direction": f"{degrees} deg"}
    pins = {"pin_diameter": "8 mm", "friction": 1.0}
    block = {"points": {"B": ["0 mm", "0 mm"], "Q": ["5 mm", "0 mm"]}}
    rod = {"points": {"A": ["0 mm", "0 mm"], "C": ["110 mm", "0 mm"]}}
    case = {
        "schema_version": 1,
        "title": "two blocks",
        "links": {
            "base": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "G": ["9 mm", "0 mm"]}},
            "crank": {"points": {"A": ["0 mm", "0 mm"], "B": ["40 mm", "0 mm"]}},
            "pusher": rod,
            "first": block,
            "rod": rod,
            "second": block,
        },
        "joints": {
            "A": {"links": ["base", "crank"]},
            "B": {"links": ["crank", "pusher"], "points": ["B", "A"]},
            "C": {"links": ["pusher", "first"], "points": ["C", "B"]},
            "S1": guide | {"links": ["base", "first"]},
            "S2": guide | {"links": ["base", "second"]},
            "D": {"links": ["first", "rod"], "points": ["B", "A"]} | pins,
            "E": {"links": ["rod", "second"], "points": ["C", "B"]} | pins,
        },
        "pose": {
            "coordinate": "crank",
            "angle": f"{degrees + 50.0} deg",
            "near": {"pusher": f"{degrees - 16.0} deg", "rod": f"{degrees} deg", "first": "0 deg", "second": "0 deg"},
        },
        "drive": {"link": "crank", "joint": "A"},
        "load_cases": {"push": {"forces": [{"link": "second", "at": "B", "force": ["-3 N", "-8 N"]}]}},
    }
    statics = solve_case_statics(validate(case))
    for loads in statics.loads.values():
        assert [wrench.tolist() for wrench in friction_wrenches(loads).values()] == [[0.0] * 6] * 2


def test_a_pin_without_size_has_no_friction() -> None:
    data = parallel_cranks(0.2)
    del data["joints"]["A1"]["pin_diameter"]
    with pytest.raises(CaseError, match=r"joints\.A1\.friction.*add joints\.A1\.pin_diameter"):
        validate(data)


@pytest.mark.parametrize("layers", [False, True])
def test_samples_of_tolerances_have_friction(layers: bool) -> None:
    """In layers what couples press in bores is that of the linkage without deviations."""
    case = edited(STARTER, [*PINS, "load_cases.turning.speed=0 rpm", "tolerances.pins=0.05 mm"])
    if layers:
        case = edited("slider-crank", ["tolerances.pins=0.05 mm"])
    statics = solve_case_statics(case)
    variables = toleranced(statics.case)
    plane = statics.case.in_one_plane() if layers else statics.case
    presses = {name: presses_of(case, forces) for name, forces in statics.forces.items()}
    assert all(map(bool, presses.values())) is layers
    sampler = Sampler(case=plane, pose=statics.pose, masses=statics.masses, variables=variables, presses=presses)
    states = sampler.states(np.zeros((2, len(variables))))
    for name, reactions in statics.reactions.items():
        assert states.forces[name].drive_torque == pytest.approx(reactions.drive_torque, rel=1e-9)
