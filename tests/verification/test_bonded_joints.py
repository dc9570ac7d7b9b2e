"""Joints bonded one by one: closed forms, a plane frame of stiffness matrices, and links that move as one."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from alula.fea.check.run import check_case
from alula.fea.standing.joint_forces import BONDED_FRAME, BONDED_STATICS, joint_forces
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.actions import acting_loads
from alula.loads.states.case_motion import solve_case_motion

HEIGHT, WIDTH = 120.0, 150.0
BAR = {"shape": "bar", "material": "aluminium-6061-t6", "width": "6 mm", "thickness": "4 mm", "fillet_radius": "1 mm"}


def mm(x, y=0.0):
    return [f"{x} mm", f"{y} mm"]


def joints(pairs, **bonds):
    return {
        name: {"links": links.split(), "pin_diameter": "2 mm"} | bonds.get(name, {}) for name, links in pairs.items()
    }


def reactions(case):
    """Joint forces of its only load case."""
    pose = case.solve_pose()
    [load_case] = case.load_cases.values()
    return joint_forces(case, pose, acting_loads(case, load_case, pose.placement, {}))


def arm(**changes):
    """Two bars of 100 mm on the ground, one after the other, with 1 N across at their end."""
    return validate(
        {
            "schema_version": 1,
            "title": "an arm",
            "links": {
                "base": {"ground": True, "points": {"A": mm(0), "far": mm(1)}},
                "first": {"part": "bar", "points": {"A": mm(0), "B": mm(100)}},
                "second": {"part": "bar", "points": {"B": mm(0), "P": mm(100)}},
            },
            "joints": joints(
                {"A": "base first", "B": "first second"},
                A={"bonded": True, "angle": "0 deg"},
                B={"bonded": True, "angle": "0 deg"},
            ),
            "parts": {"bar": BAR},
            "load_cases": {"push": {"forces": [{"link": "second", "at": "P", "force": ["0 N", "-1 N"]}]}},
        }
        | changes
    )


def test_two_bonded_bars_are_one_cantilever():
    """M = P x from the end, and P L³/(3 E I) there, without a drive."""
    case = arm()
    found = reactions(case)
    assert (found.model, found.by_equilibrium) == (BONDED_STATICS, True)
    assert found.reactions.joints["A"].wrench == pytest.approx([0, 1, 0, 0, 0, 200.0])
    assert found.reactions.joints["B"].wrench == pytest.approx([0, 1, 0, 0, 0, 100.0])
    young, second = case.material_of("first").youngs_modulus, 4.0 * 6.0**3 / 12.0
    check = check_case(case, fidelity="beam").load_cases["push"]
    moved = check.large_displacement.points["second", "P"]
    assert moved[1] == pytest.approx(-(200.0**3) / (3.0 * young * second), rel=3e-3)
    assert check.links["first"].beam.worst.equivalent > 200.0 * 6.0 / (4.0 * 6.0**2)


def test_two_bonded_bars_buckle_and_bend_far_as_one():
    """Euler's column with a free end, and the elastica of a cantilever: EI θ'' = -F cos θ, θ(0) = 0, θ'(L) = 0."""
    length, force = 200.0, 60.0
    young = arm().material_of("first").youngs_modulus
    stiffness, across = young * 72.0, young * 32.0  # the bar gives way across its plane, where it is thinner

    def pushed(*at_end):
        load = {"link": "second", "at": "P", "force": [f"{component} N" for component in at_end]}
        return check_case(arm(load_cases={"push": {"forces": [load]}}), fidelity="beam").load_cases["push"]

    factor = pushed(-50.0, 0.0).large_displacement.buckling
    assert factor == pytest.approx(np.pi**2 * across / (4.0 * length**2) / 50.0, rel=1e-3)

    def bent(start):
        def slope(_, y):
            return [y[1], -force / stiffness * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

        return solve_ivp(slope, (0.0, length), [0.0, start, 0.0, 0.0], rtol=1e-9, atol=1e-12).y[:, -1]

    end = bent(brentq(lambda start: bent(start)[1], 0.0, 2.0 * force * length / stiffness))
    moved = pushed(0.0, -force).large_displacement
    assert moved.state == "deformed"
    assert moved.points["second", "P"] == pytest.approx([end[2] - length, -end[3], 0.0], rel=3e-3)


def test_a_bond_keeps_the_stated_angle():
    bent = arm(
        joints=joints(
            {"A": "base first", "B": "second first"},
            A={"bonded": True, "angle": "30 deg"},
            B={"bonded": True, "angle": "-40 deg"},  # of the first bar to the second
        )
    )
    assert {n: np.degrees(a) for n, a in bent.solve_pose().angles.items()} == pytest.approx(
        {"base": 0.0, "first": 30.0, "second": 70.0}
    )
    wrench = reactions(bent).reactions.joints["A"].wrench
    assert wrench[5] == pytest.approx(100.0 * (np.cos(np.pi / 6.0) + np.cos(np.radians(70.0))))


def portal(bonded, *, drive=False):
    """Two columns and a beam on top; 1 N along the beam. Some joints are bonded as they stand."""
    entries = {
        "schema_version": 1,
        "title": "portal",
        "links": {
            "base": {"ground": True, "points": {"A": mm(0), "D": mm(WIDTH)}},
            "left": {"part": "bar", "points": {"A": mm(0), "B": mm(HEIGHT)}},
            "top": {"part": "bar", "points": {"B": mm(0), "C": mm(WIDTH)}},
            "right": {"part": "bar", "points": {"D": mm(0), "C": mm(HEIGHT)}},
        },
        "joints": joints(
            {"A": "base left", "B": "left top", "C": "top right", "D": "base right"},
            **{name: {"bonded": True} for name in bonded},
        ),
        "pose": {"coordinate": "left", "angle": "90 deg", "near": {"top": "0 deg", "right": "90 deg"}},
        "parts": {"bar": BAR},
        "load_cases": {"push": {"forces": [{"link": "top", "at": "B", "force": ["1 N", "0 N"]}]}},
    }
    return entries | ({"drive": {"link": "left", "joint": "A"}} if drive else {})


def test_one_bonded_foot_bears_it_all_and_two_share_it():
    """Knees that turn leave columns of equal stiffness as cantilevers: H h at one of them, else half of it at each."""
    alone = reactions(validate(portal("A")))
    assert alone.by_equilibrium
    assert alone.reactions.joints["A"].wrench[5] == pytest.approx(HEIGHT)
    assert alone.reactions.joints["D"].wrench == pytest.approx(np.zeros(6), abs=1e-12)
    both = reactions(validate(portal("AD")))
    assert both.model == BONDED_FRAME
    for foot in "AD":
        assert both.reactions.joints[foot].wrench[5] == pytest.approx(HEIGHT / 2.0, rel=1e-3)


def plane_frame(case, bonded):
    """Moments at the joints, on their second links, of a plane frame of Euler-Bernoulli beams with hinges.

    Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 5.6. Each joint has u and v; each beam end a
    rotation of its own, which those of a bonded joint share, or which a bonded foot holds.
    """
    places = {"A": (0.0, 0.0), "B": (0.0, HEIGHT), "C": (WIDTH, HEIGHT), "D": (WIDTH, 0.0)}
    beams = {"left": "AB", "top": "BC", "right": "DC"}
    fixed = [(at, axis) for at in "AD" for axis in "uv"]
    turn = {(beam, at): ("turn", at if at in bonded else beam + at) for beam, ends in beams.items() for at in ends}
    fixed += [("turn", at) for at in "AD" if at in bonded]
    names = sorted({(at, axis) for at in places for axis in "uv"} | set(turn.values()), key=str)
    young, area, second = case.material_of("top").youngs_modulus, 24.0, 72.0
    total, of_beam = np.zeros((len(names), len(names))), {}
    for beam, (one, other) in beams.items():
        (x, y), (x2, y2) = places[one], places[other]
        length = np.hypot(x2 - x, y2 - y)
        c, s = (x2 - x) / length, (y2 - y) / length
        a, b = young * area / length, young * second / length**3
        own = np.array(
            [
                [a, 0, 0, -a, 0, 0],
                [0, 12 * b, 6 * b * length, 0, -12 * b, 6 * b * length],
                [0, 6 * b * length, 4 * b * length**2, 0, -6 * b * length, 2 * b * length**2],
                [-a, 0, 0, a, 0, 0],
                [0, -12 * b, -6 * b * length, 0, 12 * b, -6 * b * length],
                [0, 6 * b * length, 2 * b * length**2, 0, -6 * b * length, 4 * b * length**2],
            ]
        )
        half = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        axes = np.kron(np.eye(2), half)
        at = [(one, "u"), (one, "v"), turn[beam, one], (other, "u"), (other, "v"), turn[beam, other]]
        rows = [names.index(name) for name in at]
        of_beam[beam] = (rows, axes.T @ own @ axes)
        total[np.ix_(rows, rows)] += of_beam[beam][1]
    free = [i for i, name in enumerate(names) if name not in fixed]
    load = np.array([1.0 if name == ("B", "u") else 0.0 for name in names])
    moved = np.zeros(len(names))
    moved[free] = np.linalg.solve(total[np.ix_(free, free)], load[free])
    ends = {beam: stiffness @ moved[rows] for beam, (rows, stiffness) in of_beam.items()}
    return {"A": ends["left"][2], "B": ends["top"][2], "C": ends["right"][5], "D": ends["right"][2]}


@pytest.mark.parametrize("bonded", ["AB", "ABC", "BC", "BCD", "ABCD", "AC"])
def test_bonds_one_by_one_agree_with_a_plane_frame(bonded):
    case = validate(portal(bonded, drive=False))
    found, expected = reactions(case).reactions.joints, plane_frame(case, bonded)
    for name, moment in expected.items():
        assert found[name].wrench[5] == pytest.approx(moment, rel=5e-3, abs=1e-6), name


def test_a_driven_joint_bears_its_torque_beside_bonds():
    """The torque that holds the crank is that of a bonded foot there."""
    held, bonded = (reactions(validate(portal(*how))).reactions for how in (("BC",), ("ABC",)))
    driven = reactions(validate(portal("BC", drive=True))).reactions
    assert driven.drive_torque == pytest.approx(bonded.joints["A"].wrench[5], rel=1e-9)
    assert held.joints["A"].wrench[5] == pytest.approx(0.0, abs=1e-9)


def four_bar(split):
    """A crank that turns, and a coupler with a load at its tip: one link, or two that are bonded at Q."""
    links = {
        "base": {"ground": True, "points": {"O": mm(0), "R": mm(100)}},
        "crank": {"points": {"O": mm(0), "B": mm(30)}},
        "coupler": {"points": {"B": mm(0), "C": mm(90), "P": mm(50, 40)}},
        "rocker": {"points": {"R": mm(0), "C": mm(60)}},
    }
    pairs = {"O": "base crank", "B": "crank coupler", "C": "coupler rocker", "R": "base rocker"}
    at, bonds = "coupler", {}
    if split:
        # The tip's link turns by 90° and sits 50 mm along the coupler.
        links["coupler"]["points"] = {"B": mm(0), "C": mm(90), "Q": mm(50)}
        links["tip"] = {"points": {"Q": mm(0), "P": mm(40)}}
        pairs["Q"], at, bonds = "coupler tip", "tip", {"Q": {"bonded": True, "angle": "90 deg"}}
    return validate(
        {
            "schema_version": 1,
            "title": "four-bar",
            "links": links,
            "joints": joints(pairs, **bonds),
            "pose": {"coordinate": "crank", "angle": "40 deg", "near": {"coupler": "20 deg", "rocker": "60 deg"}},
            "drive": {"link": "crank", "joint": "O"},
            "motion": {"range": ["0 deg", "360 deg"], "poses": 25},
            "load_cases": {"pull": {"forces": [{"link": at, "at": "P", "force": ["2 N", "-3 N"]}]}},
        }
    )


def test_bonded_links_move_as_one():
    whole, split = (solve_case_motion(four_bar(how)) for how in (False, True))
    assert split.torque["pull"] == pytest.approx(whole.torque["pull"], rel=1e-9, abs=1e-9)
    for name, force in whole.forces["pull"].forces.items():
        assert split.forces["pull"].forces[name] == pytest.approx(force, abs=1e-9), name
    # What the tip bears goes through the bond: 40 mm times the pull across it.
    turn = whole.motion.q[:, whole.case.linkage.moving.index("coupler")] + np.pi / 2.0
    across = np.cos(turn) * -3.0 - np.sin(turn) * 2.0
    assert split.forces["pull"].moments["Q"] == pytest.approx(-40.0 * across)


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: validate(portal("A", drive=True)), r"drive\.joint: joint 'A' is bonded"),
        (lambda: solve_case_motion(validate(portal("B", drive=True) | {"motion": {"range": ["90 deg", "80 deg"]}})),
         r"joints\.B\.bonded: links 'left' and 'top' are bonded there, but they would turn"),
        (lambda: arm(joints=joints({"A": "base first", "B": "first second"}, B={"bonded": True})), "mobility 2"),
        (lambda: arm(joints={"A": {"links": ["base", "first"], "type": "slider", "bonded": True}}),
         r"joints\.A\.bonded: a joint of type slider slides"),
    ],
)  # fmt: skip
def test_bonds_that_cannot_be_are_refused(build, said):
    with pytest.raises(CaseError, match=said):
        build().solve_pose()


def test_an_open_chain_beside_its_ground_shares_no_couple():
    """Nothing but the pin of a lever holds it out of its plane; once its statics divided by zero.

    However its pin stands in its holes, it bears the same.
    """
    case = arm(
        joints=joints({"A": "base first", "B": "first second"}, B={"bonded": True, "angle": "0 deg"}),
        pose={"coordinate": "first"},
        drive={"link": "first", "joint": "A"},
        layer_spacing="10 mm",
        links={
            name: link | {"layer": 0 if name == "base" else 1}
            for name, link in {
                "base": {"ground": True, "points": {"A": mm(0), "far": mm(1)}},
                "first": {"part": "bar", "points": {"A": mm(0), "B": mm(100)}},
                "second": {"part": "bar", "points": {"B": mm(0), "P": mm(100)}},
            }.items()
        },
    )
    found = reactions(case)
    [shared] = found.sharings
    for name, joint in found.reactions.joints.items():
        assert shared.joints[name].wrench == pytest.approx(joint.wrench, abs=1e-9)
    assert shared.drive_torque == pytest.approx(200.0)
    assert found.reactions.joints["A"].wrench == pytest.approx([0, 1, 0, 0, 0, 0], abs=1e-9)
    assert found.reactions.joints["B"].wrench == pytest.approx([0, 1, 0, 0, 0, 100.0], abs=1e-9)
    assert found.reactions.drive_torque == pytest.approx(200.0)
