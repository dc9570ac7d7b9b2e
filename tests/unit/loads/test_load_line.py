"""Forces along lines in space: where they enter, what of them reaches joints, and how they stay where links move."""

from dataclasses import replace

import numpy as np
import pytest

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.motion.link_history import link_histories
from alula.fea.outcomes.unchecked import caveats
from alula.fea.outcomes.unloaded import stated_size
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import CaseError
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.case.case_file import validate
from alula.loads.case.toleranced import toleranced
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.text.caveat import Topic
from alula.reports.sentences.caveats import caveat

FIRST = {
    "from": ["260 mm", "90 mm", "40 mm"],
    "to": ["-30 mm", "-20 mm", "-25 mm"],
    "force": "1.2 kN",
    "link": "pylon",
    "at": "T",
}
SECOND = {
    "from": ["10 mm", "70 mm", "0 mm"],
    "to": ["300 mm", "-60 mm", "15 mm"],
    "force": "-300 N",
    "link": "foot",
    "at": "B",
    "leaves": {"link": "pylon", "at": "M"},
}


BAR = {
    "shape": "bar",
    "material": "pvc-paredes-2018",
    "width": "6 mm",
    "thickness": "4 mm",
    "fillet_radius": "0.2 mm",
    "eye_diameter": "9 mm",
    "eye_thickness": "4 mm",
}


def two(*lines, **tables):
    """A pylon glued to the ground at O, 25° up from x, and a foot glued to it at T, in two layers."""
    return validate(
        {
            "schema_version": 1,
            "title": "A pylon with a foot",
            "layer_spacing": "8 mm",
            "links": {
                "ground": {"ground": True, "layer": 0, "points": {"O": ["20 mm", "10 mm"]}},
                "pylon": {
                    "layer": 0,
                    "part": "bar",
                    "points": {"O": ["0 mm", "0 mm"], "M": ["90 mm", "0 mm"], "T": ["200 mm", "0 mm"]},
                },
                "foot": {"layer": 1, "part": "bar", "points": {"T": ["0 mm", "0 mm"], "B": ["60 mm", "0 mm"]}},
            },
            "joints": {
                "O": {"links": ["ground", "pylon"], "pin_diameter": "3 mm", "bonded": True, "angle": "25 deg"},
                "T": {"links": ["pylon", "foot"], "pin_diameter": "3 mm", "bonded": True, "angle": "-70 deg"},
            },
            "parts": {"bar": BAR},
            "load_cases": {"stand": {"load_lines": list(lines or (FIRST, SECOND))}},
            **tables,
        }
    )


def lever(*lines, **motion):
    return validate(
        {
            "schema_version": 1,
            "title": "A lever",
            "links": {
                "ground": {"ground": True, "points": {"O": ["0 mm", "0 mm"]}},
                "lever": {"points": {"O": ["0 mm", "0 mm"], "P": ["60 mm", "20 mm"]}},
            },
            "joints": {"O": {"links": ["ground", "lever"]}},
            "pose": {"coordinate": "lever", "angle": "30 deg"},
            "load_cases": {"line": {"load_lines": list(lines)}},
            **(motion if "springs" in motion else {"drive": {"link": "lever", "joint": "O"}} | motion),
        }
    )


def along(line):
    """Both ends [mm] and the force [N], read anew."""
    start, end = (np.array([*(float(x.split()[0]) for x in line[key]), 0.0][:3]) for key in ("from", "to"))
    size, unit = line["force"].split()
    return start, end, float(size) * {"N": 1.0, "kN": 1e3}[unit] * (end - start) / np.linalg.norm(end - start)


@pytest.mark.parametrize("lines", [(FIRST,), (SECOND,), (FIRST, SECOND), (SECOND, FIRST)])
def test_the_ground_bears_the_moment_of_the_line_wherever_it_enters(lines):
    """About O: r × F of each line that does not leave again, whichever point of the line is taken."""
    reactions = solve_case_statics(two(*lines)).forces["stand"].reactions
    expected = np.zeros(6)
    for line in (line for line in lines if "leaves" not in line):
        start, end, force = along(line)
        arm = start + 0.7 * (end - start) - [20.0, 10.0, 0.0]
        expected += np.concatenate([force, np.cross(arm, force)])
    assert reactions.joints["O"].wrench == pytest.approx(-expected, rel=1e-9, abs=1e-6)


def test_what_leaves_by_another_link_goes_through_the_joint_between_them():
    """The foot alone: its joint bears the force that enters it, about the joint in the foot's plane."""
    statics = solve_case_statics(two(SECOND, FIRST))
    start, _, force = along(SECOND)
    reaction = statics.forces["stand"].reactions.joints["T"]
    assert reaction.on == "foot"
    arm = start - [*statics.pose.position("foot", "T"), 8.0]
    assert reaction.wrench == pytest.approx(-np.concatenate([force, np.cross(arm, force)]))


def test_without_z_both_ends_lie_in_the_planes_of_their_links():
    """As all loads in the plane do: none makes a moment about x or y, in whichever layer its link is."""
    flat = {**SECOND, "from": SECOND["from"][:2], "to": SECOND["to"][:2]}
    case = two(flat)
    [line] = case.load_cases["stand"].load_lines
    found = ForceOnLine(line).loads(case.stated_pose.placement)
    assert [load.link for load in found] == ["foot", "pylon"]
    for load in found:
        assert load.wrench[2:5] == pytest.approx([0.0, 0.0, 0.0], abs=0.0)


def test_its_wrench_is_about_the_plane_of_the_link():
    case = two()
    place = case.stated_pose.placement
    for line, record in zip((FIRST, SECOND), case.load_cases["stand"].load_lines, strict=True):
        start, end, force = along(line)
        for load, sense, at in zip(ForceOnLine(record).loads(place), (1.0, -1.0), (start, end), strict=False):
            point = place.position(load.link, load.point)
            arm = at - [point.real, point.imag, case.heights[load.link]]
            assert load.arm == pytest.approx(arm)
            assert load.wrench == pytest.approx(np.concatenate([sense * force, np.cross(arm, sense * force)]))


LINE = {
    "from": ["80 mm", "70 mm", "9 mm"],
    "to": ["30 mm", "-40 mm", "0 mm"],
    "force": "50 N",
    "link": "lever",
    "at": "P",
}
STRUT = {**LINE, "from": ["10 mm", "-90 mm"], "to": ["30 mm", "-40 mm"], "force": "-20 N"}
MOTION = {"motion": {"speed": "1 rad/s", "range": ["-20 deg", "170 deg"], "poses": 39, "inertia": False}}


@pytest.mark.parametrize("lines", [(LINE, STRUT), (STRUT, LINE)])
def test_a_line_in_space_stays_there_while_the_link_turns(lines):
    """The torque about O is the moment of the lines about it: the same at every pose."""
    expected = -sum(np.cross(along(line)[0], along(line)[2])[2] for line in lines)
    moved = solve_case_motion(lever(*lines, **MOTION))
    assert moved.torque["line"] == pytest.approx(np.full(39, expected))
    assert moved.forces["line"].imbalance == pytest.approx(np.zeros(39), abs=1e-9 * abs(expected))


def test_a_line_in_axes_of_its_link_moves_along():
    """Its force turns, its moment about O does not; the other line stays in space."""
    own = {**LINE, "axes": "link"}
    moved = solve_case_motion(lever(own, STRUT, **MOTION))
    turned = moved.motion.placement.axes("lever") @ along(LINE)[2]
    assert moved.forces["line"].forces["O"] == pytest.approx(-(turned + along(STRUT)[2])[:, :2])
    expected = -sum(np.cross(along(line)[0], along(line)[2])[2] for line in (LINE, STRUT))
    assert moved.torque["line"] == pytest.approx(np.full(39, expected))


@pytest.mark.parametrize("lines", [(LINE, STRUT), (STRUT, LINE)])
def test_over_a_motion_the_line_pushes_its_link_where_it_stands(lines):
    """In the link's axes the force turns back and its arm changes from pose to pose; all that acts balances."""
    flat = [{**line, "from": line["from"][:2], "to": line["to"][:2]} for line in lines]
    points = {"O": ["0 mm", "0 mm"], "P": ["60 mm", "0 mm"]}
    links = {"ground": {"ground": True, "points": {"O": ["0 mm", "0 mm"]}}, "lever": {"points": points, "part": "bar"}}
    joints = {"O": {"links": ["ground", "lever"], "pin_diameter": "3 mm"}}
    moved = solve_case_motion(lever(*flat, **MOTION, links=links, joints=joints, parts={"bar": BAR}))
    [history] = link_histories(moved, "lever")
    [end] = history.ends
    turn = moved.motion.placement.axes("lever")
    push = np.zeros((39, 6))
    for line in flat:
        start, _, force = along(line)
        arm = start - turn @ [60.0, 0.0, 0.0]
        push[:, :3] += np.einsum("nij,i->nj", turn, force)
        push[:, 5] += np.cross(arm, force)[:, 2]
    assert end.wrench == pytest.approx(push, abs=1e-6)
    assert history.resultant() == pytest.approx(np.zeros((39, 6)), abs=1e-6)


def test_an_envelope_does_not_follow_a_line_out_of_the_plane():
    with pytest.raises(CaseError, match=r"load_cases\.line: a load on link 'lever' acts out of the linkage's plane"):
        link_histories(solve_case_motion(lever(STRUT, LINE, **MOTION)), "lever")


def test_a_linkage_that_is_let_go_stands_where_a_spring_balances_the_line():
    """It is no potential in the plane, but one of the coordinate: the torque M of a line in space turns it by M/k."""
    flat = {**LINE, "from": LINE["from"][:2], "to": LINE["to"][:2]}
    torque = np.cross(along(flat)[0], along(flat)[2])[2]
    spring = {"joint": "O", "stiffness": "20 N*m/rad", "free_angle": "30 deg"}
    case = lever(flat, pose={"coordinate": "lever", "angle": "30 deg", "equilibrium": True}, springs={"s": spring})
    [standing] = solve_case_statics(case).standing.values()
    assert standing.pose.angles["lever"] == pytest.approx(np.radians(30.0) + torque / 20e3)
    assert standing.stiffness == pytest.approx(20e3)


def test_the_tolerance_of_a_line_changes_its_loads_alone():
    """Of two lines, one of which leaves by another link, and a force: each draw is that of its own."""
    force = {"link": "pylon", "at": "M", "force": ["70 N", "20 N"]}
    first, second = ({**line, "from": line["from"][:2], "to": line["to"][:2]} for line in (FIRST, SECOND))
    stand = {"load_lines": [second, first], "forces": [force]}
    tolerances = {f"load_cases.stand.{entry}": "10 %" for entry in ("load_lines.0", "load_lines.1", "forces.0")}
    case = two(load_cases={"stand": stand}, tolerances=tolerances)
    sampler = Sampler(case=case, pose=case.solve_pose(), masses={}, variables=toleranced(case))
    place, rows = case.solve_pose().placement, 0.1 * np.vstack([np.eye(3), np.zeros(3)])
    sampled = sampler._loads("stand", case.load_cases["stand"], replace(place, q=np.tile(place.q, (4, 1))), rows)
    stated = [record for line in case.load_cases["stand"].load_lines for record in ForceOnLine(line).loads(place)]
    assert [load.link for load in sampled] == ["foot", "pylon", "pylon", "pylon"]
    for load, before, grown in zip(sampled, stated, (0, 0, 1), strict=False):
        factors = 1.0 + 0.1 * (np.arange(4) == grown)
        assert load.wrench == pytest.approx(factors[:, None] * before.wrench)
        assert load.arm == pytest.approx(np.tile(before.arm, (4, 1)))
    assert sampled[3].wrench[:, 0] == pytest.approx(70.0 * np.array([1.0, 1.0, 1.1, 1.0]))


def test_the_place_of_a_line_is_varied_by_a_study_and_has_no_tolerance():
    with pytest.raises(CaseError, match=r'vary them with alula study --vary "load_cases.stand.load_lines.0.to.1='):
        two(tolerances={"load_cases.stand.load_lines.0.to.1": "1 mm"})


def test_of_lines_that_cancel_nothing_is_asked():
    """Two that are opposed, at one point, wherever along the line they begin; each alone is a load."""
    back = {**FIRST, "from": FIRST["to"], "to": FIRST["from"]}
    result = check_case(two(FIRST, back), fidelity="beam")
    told = [one for case in result.load_cases.values() for one in case.checks if one.quantity is Quantity.SAFETY_FACTOR]
    assert [(one.verdict, one.reason.kind) for one in told] == [(Verdict.UNDECIDED, "nothing_acts")] * 2
    assert stated_size(two(FIRST), "stand") >= 1200.0


def test_rigid_levers_and_what_is_not_modelled_are_told_once():
    case = two(load_cases={"stand": {"load_lines": [FIRST, SECOND]}, "lift": {"load_lines": [SECOND, FIRST]}})
    told = [caveat(one) for one in caveats(case) if one.topic is Topic.LOADS]
    assert told == [
        "rigid levers between load lines and T of pylon, B of foot, M of pylon",
        "sockets and soft parts at T of pylon, B of foot, M of pylon (they are not modelled)",
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"to": FIRST["from"]}, r"load_cases\.stand\.load_lines\.1: from and to are the same point"),
        ({"to": ["260 mm", "90 mm", "40.0000000001 mm"]}, "the same point"),
        ({"leaves": {"link": "pylon", "at": "T"}}, "enters and leaves at one point"),
        ({"to": ["1 mm", "2 mm"]}, r"load_lines\.1: one of from and to has no z"),
        ({"from": ["1 mm"]}, r"load_lines\.1\.from: the list has too few|it has 1"),
        ({"from": ["1 mm"] * 4}, r"load_lines\.1\.from"),
        ({"from": None}, r"load_lines\.1\.from"),
        ({"force": "3 mm"}, r'load_lines\.1\.force.*"mm" is not a unit of force'),
        ({"link": "ground"}, r"load_lines\.1\.link: 'ground' is not a moving link; choose one of pylon, foot"),
        ({"at": "X"}, r"load_lines\.1: link 'pylon' has no point 'X'; its points are O, M, T"),
        ({"leaves": {"link": "foot", "at": "X"}}, r"load_lines\.1\.leaves: link 'foot' has no point 'X'"),
        ({"leaves": {"link": "ground", "at": "O"}}, r"load_lines\.1\.leaves\.link: 'ground' is not a moving link"),
    ],
)
def test_refused(change, message):
    wrong = {key: value for key, value in {**FIRST, **change}.items() if value is not None}
    with pytest.raises(CaseError, match=message):
        two(FIRST, wrong)


@pytest.mark.parametrize("place", [{"at": "P"}, {"leaves": {"link": "strut", "at": "P"}}])
def test_no_lever_stands_on_a_pin_that_turns_freely(place):
    """As for stated moments; on the lever beside it one may."""
    points = {"O": ["0 mm", "0 mm"], "P": ["60 mm", "0 mm"], "Q": ["20 mm", "-60 mm"], "free": ["30 mm", "0 mm"]}
    line, tables = {**LINE, "at": "free"}, {"schema_version": 1, "title": "A bracket"}
    links = {
        "ground": {"ground": True, "points": {name: points[name] for name in "OQ"}},
        "lever": {"points": {name: points[name] for name in ("O", "P", "free")}},
        "strut": {"points": {"Q": ["0 mm", "0 mm"], "P": ["70 mm", "0 mm"]}},
    }
    ends = {"O": ["ground", "lever"], "P": ["lever", "strut"], "Q": ["ground", "strut"]}
    tables |= {"links": links, "joints": {name: {"links": pair} for name, pair in ends.items()}}
    tables |= {"pose": {"near": {"lever": "0 deg", "strut": "60 deg"}}}
    assert validate({**tables, "load_cases": {"line": {"load_lines": [line]}}})
    with pytest.raises(CaseError, match=r"load_lines\.1.*: the pin at 'P' turns freely"):
        validate({**tables, "load_cases": {"line": {"load_lines": [line, {**line, **place}]}}})
