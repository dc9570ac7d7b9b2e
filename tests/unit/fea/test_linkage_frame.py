"""Linkages as frames: equilibrium alone in the plane, closed forms of portal frames out of it and bonded."""

from dataclasses import replace

import numpy as np
import pytest
from edited_cases import PLANAR

from alula.fea.frame.build import build_frame
from alula.fea.frame.condensed import LinkFlexibility
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.linkage_frame import out_of_plane
from alula.fea.standing.joint_forces import BONDED_FRAME, PINNED_FRAME, PINNED_STATICS, joint_forces, ways_to_hold
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.applied import BodyForce, LineLoad, PartMass, PointLoad, shifted
from alula.loads.states.actions import acting_loads
from alula.loads.statics.statics import Drive, Reactions, solve_statics
from alula.reports.sentences import told

WING = read_case("owl-wing-static", [PLANAR])
AE, GF = Drive(link="AE", joint="A"), Drive(link="GF", joint="G")
HEIGHT, WIDTH = 60.0, 90.0


def force(link, point, *wrench):
    return PointLoad(link=link, point=point, wrench=np.array([*wrench, *[0.0] * 6][:6]))


def body_force(link, acceleration):
    return BodyForce(
        link=link,
        mass=PartMass(mass=2e-6, centroid=np.array([31.0, 1.5]), inertia=7e-4),
        specific_force=np.array(acceleration),
        angular_speed_squared=9.0,
        angular_acceleration=40.0,
    )


IN_PLANE = (
    force("CH", "H", 0.0, -0.25),
    force("AE", "B", 0.3, 0.1, 0, 0, 0, 25.0),
    LineLoad(link="CF", start=10.0, end=131.0, at_start=np.array([0.0, -0.01, 0]), at_end=np.array([0.02, 0.03, 0])),
    LineLoad(link="CF", start=60.0, end=150.0, at_start=np.array([0.01, 0, 0]), at_end=np.array([0.0, 0.02, 0])),
    body_force("AE", [30.0, -9810.0, 0.0]),
    body_force("GF", [0.0, -9810.0, 0.0]),
)


def solved(case, loads, held, bonded=False):
    frame = build_frame(case, case.solve_pose(), loads, held=held, bonded=bonded)
    return frame, solve_frame(frame.model)


def reactions_of(case, loads, held, bonded=False):
    frame, solution = solved(case, loads, held, bonded)
    return frame.reactions(solution.joint_wrenches, solution.residual)


def assert_links_balance(reactions: Reactions, loads, tolerance=1e-9):
    """All six sums of every link about the origin, from the joint reactions and the loads' own resultants."""
    pose = reactions.pose
    for link in pose.linkage.moving:
        total = np.array([0.0, 0.0, 0.0, 0.0, 0.0, reactions.torque_on(link)])
        for point, wrench in reactions.on_link(link):
            total += shifted(wrench, np.array([*pose.position(link, point), 0.0]))
        for load in loads:
            if load.link == link:
                total += shifted(load.resultant(pose.placement), np.array([*pose.origins[link], 0.0]))
        assert np.abs(total[:3]).max() < tolerance, link
        assert np.abs(total[3:]).max() < tolerance * 300.0, link


@pytest.mark.parametrize("held", [AE, GF])
@pytest.mark.parametrize("loads", [*[(load,) for load in IN_PLANE], IN_PLANE])
def test_in_the_plane_the_frame_repeats_equilibrium(held, loads):
    expected = solve_statics(WING.solve_pose(), held, loads)
    found = reactions_of(WING, loads, held)
    size = max(expected.joints[name].magnitude for name in expected.joints)
    for name, joint in expected.joints.items():
        assert (found.joints[name].on, found.joints[name].by) == (joint.on, joint.by)
        assert np.abs(found.joints[name].wrench - joint.wrench).max() < 1e-9 * size, name
    assert found.drive_torque == pytest.approx(expected.drive_torque, abs=1e-9 * size * 272.0)
    assert found.unknowns == pytest.approx(expected.unknowns, abs=1e-9 * size * 272.0)


def portal():
    """Two cranks of equal length stand on the ground, the coupler lies across: the entries as a user writes them."""
    return {
        "schema_version": 1,
        "title": "portal",
        "links": {
            "ground": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "D": [f"{WIDTH} mm", "0 mm"]}},
            "left": {"part": "rod", "points": {"A": ["0 mm", "0 mm"], "B": [f"{HEIGHT} mm", "0 mm"]}},
            "top": {
                "part": "rod",
                "points": {
                    "B": ["0 mm", "0 mm"],
                    "M": [f"{WIDTH / 2} mm", "0 mm"],
                    "C": [f"{WIDTH} mm", "0 mm"],
                },
            },
            "right": {"part": "rod", "points": {"D": ["0 mm", "0 mm"], "C": [f"{HEIGHT} mm", "0 mm"]}},
        },
        "joints": {
            name: {"links": links, "pin_diameter": "1 mm"}
            for name, links in {
                "A": ["ground", "left"],
                "B": ["left", "top"],
                "C": ["top", "right"],
                "D": ["ground", "right"],
            }.items()
        },
        "pose": {"coordinate": "left", "angle": "90 deg", "near": {"top": "0 deg", "right": "90 deg"}},
        "drive": {"link": "left", "joint": "A"},
        "parts": {
            "rod": {
                "shape": "tube",
                "material": "pvc-paredes-2018",
                "outer_diameter": "2 mm",
                "inner_diameter": "1 mm",
                "eye_diameter": "3 mm",
                "eye_thickness": "3 mm",
                "fillet_radius": "0.2 mm",
            }
        },
        "load_cases": {"one": {"forces": [{"link": "top", "at": "M", "force": ["0 N", "0 N", "0.6 N"]}]}},
    }


def test_out_of_the_plane_a_symmetric_portal_has_a_closed_form():
    """Cranks bend as cantilevers under half the load; the coupler's end moment turns on their torsion.

    Beam with its load P in the middle and rotational springs k = G J/h at both ends: M = P L/8 / (1 + 2 E I/(k L)).
    """
    case = validate(portal())
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["one"], pose.placement, {})
    assert out_of_plane(loads)
    found = joint_forces(case, pose, loads)
    assert found.model == PINNED_FRAME
    assert "out of the linkage's plane" in told(found.reason)
    material, section = case.material_of("top"), case.part_of("top").section
    spring = material.shear_modulus * section.torsion / HEIGHT
    end = 0.6 * WIDTH / 8.0 / (1.0 + 2.0 * material.youngs_modulus * section.i_y / (spring * WIDTH))
    joints = found.reactions.joints
    # The ground holds each crank with half the load down, its bending moment about x, and the coupler's about y.
    assert joints["A"].wrench == pytest.approx([0, 0, -0.3, -0.3 * HEIGHT, end, 0], abs=1e-9)
    assert joints["D"].wrench == pytest.approx([0, 0, -0.3, -0.3 * HEIGHT, -end, 0], abs=1e-9)
    assert joints["B"].wrench == pytest.approx([0, 0, -0.3, 0, end, 0], abs=1e-9)
    assert found.reactions.drive_torque == pytest.approx(0.0, abs=1e-12)
    assert_links_balance(found.reactions, loads)


def test_bonded_the_portal_is_that_of_the_handbooks():
    """Horizontal force at the top of a portal built in at both feet, Kleinlogel: feet H h/2 (3k + 1)/(6k + 1)."""
    case = validate(portal() | {"joint_model": "bonded"})
    pose = case.solve_pose()
    loads = (force("top", "B", 1.0, 0.0),)
    found = joint_forces(case, pose, loads)
    assert found.model == BONDED_FRAME
    k = HEIGHT / WIDTH
    foot = HEIGHT / 2.0 * (3.0 * k + 1.0) / (6.0 * k + 1.0)
    # Axial force and shear, which the handbook leaves out, change the moments by some 0.1 %.
    assert found.reactions.drive_torque == pytest.approx(foot, rel=3e-3)
    assert found.reactions.joints["D"].wrench[5] == pytest.approx(foot, rel=3e-3)
    assert found.reactions.joints["B"].wrench[5] != 0.0
    assert_links_balance(found.reactions, loads)


@pytest.mark.parametrize(("held", "bonded"), [(AE, False), (GF, False), (AE, True)])
def test_links_of_the_wing_balance_in_space(held, bonded):
    loads = (*IN_PLANE, force("CH", "H", 0.1, 0.0, 0.27, 3.0, -5.0, 2.0), force("CF", "B", 0, 0, -0.1))
    reactions = reactions_of(WING, loads, held, bonded)
    assert_links_balance(reactions, loads)
    assert reactions.residual < 1e-9
    free = [abs(j.wrench[5]) for name, j in reactions.joints.items()]
    assert (max(free) > 1.0) if bonded else (max(free) < 1e-9)


def test_the_ground_takes_what_acts():
    loads = (force("CH", "H", 0.0, 0.0, 0.27),)
    reactions = reactions_of(WING, loads, AE)
    pose = reactions.pose
    total = sum(
        shifted(reactions.joints[name].wrench, np.array([*pose.points[name], 0.0])) for name in ("A", "G")
    ) + np.array([0, 0, 0, 0, 0, reactions.drive_torque])
    assert total[2] == pytest.approx(-0.27, abs=1e-12)
    assert total[3:] == pytest.approx(-np.cross([*pose.points["H"], 0.0], [0, 0, 0.27]), abs=1e-9)


def with_dyad():
    """The portal with a stub and a strut on a pin beside the coupler's axis; neither of them has a part."""
    data = portal()
    data["links"]["top"]["points"] |= {"P": ["30 mm", "0.8 mm"]}
    data["links"]["ground"]["points"]["E"] = ["-20 mm", "100 mm"]
    data["links"]["stub"] = {"points": {"P": ["0 mm", "0 mm"], "Q": ["12 mm", "9 mm"], "F": ["25 mm", "5 mm"]}}
    data["links"]["strut"] = {"points": {"F": ["0 mm", "0 mm"], "E": ["60 mm", "0 mm"]}}
    data["joints"]["P"] = {"links": ["top", "stub"], "pin_diameter": "1 mm"}
    data["joints"]["F"] = {"links": ["stub", "strut"]}
    data["joints"]["E"] = {"links": ["strut", "ground"]}
    data["pose"]["near"] |= {"stub": "100 deg", "strut": "190 deg"}
    return data


@pytest.mark.parametrize("offset", ["0.8 mm", "-0.6 mm"])
def test_pins_off_the_axis_and_links_without_part(offset):
    data = with_dyad()
    data["links"]["top"]["points"]["P"] = ["30 mm", offset]
    case = validate(data)
    loads = (force("stub", "Q", 0.3, -0.7), force("top", "C", 0.1, 0.2), body_force("strut", [0.0, -9810.0, 0.0]))
    expected = solve_statics(case.solve_pose(), case.pinned_drive, loads)
    frame, solution = solved(case, loads, case.pinned_drive)
    found = frame.reactions(solution.joint_wrenches, solution.residual)
    for name, joint in expected.joints.items():
        assert found.joints[name].wrench == pytest.approx(joint.wrench, abs=1e-9), name
    assert found.drive_torque == pytest.approx(expected.drive_torque, abs=1e-8)
    (node,) = frame.arms
    assert frame.points["top", "P"] == node
    assert np.linalg.norm(frame.arms[node]) == pytest.approx(abs(float(offset.split()[0])))
    assert any("stub has no part" in told(note) for note in frame.notes)
    spatial = (*loads, force("stub", "Q", 0, 0, 0.4), force("top", "P", 0, 0, 0.1, 2.0, 3.0, 0.0))
    assert_links_balance(reactions_of(case, spatial, case.pinned_drive), spatial)


def test_two_pins_at_one_station():
    data = with_dyad()
    data["parts"]["rod"] = {
        "shape": "bar",
        "material": "pvc-paredes-2018",
        "width": "10 mm",
        "thickness": "2 mm",
        "eye_diameter": "12 mm",
        "eye_thickness": "2 mm",
        "fillet_radius": "1 mm",
    }
    data["links"]["top"]["points"] = {
        "B": ["0 mm", "0 mm"],
        "P": ["45 mm", "3 mm"],
        "R": ["45 mm", "-3 mm"],
        "C": [f"{WIDTH} mm", "0 mm"],
    }
    data["links"]["below"] = {"points": {"R": ["0 mm", "0 mm"], "S": ["25 mm", "0 mm"]}}
    data["links"]["prop"] = {"points": {"S": ["0 mm", "0 mm"], "U": ["30 mm", "0 mm"]}}
    data["links"]["ground"]["points"]["U"] = ["50 mm", "10 mm"]
    data["joints"] |= {
        "R": {"links": ["top", "below"], "pin_diameter": "1 mm"},
        "S": {"links": ["below", "prop"]},
        "U": {"links": ["prop", "ground"]},
    }
    data["pose"]["near"] |= {"below": "-130 deg", "prop": "-50 deg"}
    data["load_cases"]["one"]["forces"] = [{"link": "top", "at": "B", "force": ["0 N", "1 N"]}]
    case = validate(data)
    loads = (force("stub", "Q", 0.3, -0.7), force("below", "S", 0.4, 0.2))
    frame, solution = solved(case, loads, case.pinned_drive)
    expected = solve_statics(case.solve_pose(), case.pinned_drive, loads)
    found = frame.reactions(solution.joint_wrenches, solution.residual)
    for name, joint in expected.joints.items():
        assert found.joints[name].wrench == pytest.approx(joint.wrench, abs=1e-9), name
    assert frame.points["top", "R"] != frame.points["top", "P"]
    assert [round(x, 9) for x, _ in frame.stations["top"]] == [0.0, 45.0, WIDTH]


def test_joints_that_share_a_pin_are_told_apart():
    """The dyad's pin through the same hole as the coupler's end C: what each joint carries is still its own."""
    data = with_dyad()
    del data["links"]["top"]["points"]["P"]
    data["joints"]["P"] |= {"points": ["C", "P"]}
    data["links"]["ground"]["points"]["E"] = ["60 mm", "120 mm"]
    case = validate(data)
    loads = (force("stub", "Q", 0.3, -0.7), force("right", "C", -0.2, 0.1))
    expected = solve_statics(case.solve_pose(), case.pinned_drive, loads)
    found = reactions_of(case, loads, case.pinned_drive)
    for name, joint in expected.joints.items():
        assert found.joints[name].wrench == pytest.approx(joint.wrench, abs=1e-9), name
    assert abs(expected.joints["P"].wrench[:2] - expected.joints["C"].wrench[:2]).max() > 0.01


def test_a_parallelogram_with_a_third_crank_needs_stiffness():
    """Its drive torque follows from virtual work; its joint forces do not follow from equilibrium."""
    data = portal()
    data["links"]["ground"]["points"]["N"] = [f"{WIDTH / 2} mm", "0 mm"]
    data["links"]["third"] = {"part": "rod", "points": {"N": ["0 mm", "0 mm"], "M": [f"{HEIGHT} mm", "0 mm"]}}
    data["joints"] |= {
        "N": {"links": ["ground", "third"], "pin_diameter": "1 mm"},
        "M": {"links": ["top", "third"], "pin_diameter": "1 mm"},
    }
    data["pose"] |= {"angle": "70 deg"}
    data["pose"]["near"] |= {"third": "70 deg", "right": "70 deg"}
    case = validate(data)
    pose = case.solve_pose()
    loads = (force("top", "M", 0.5, -0.2),)
    found = joint_forces(case, pose, loads)
    assert (found.model, "more constraints" in told(found.reason)) == (PINNED_FRAME, True)
    angle = np.radians(70.0)
    work = HEIGHT * (0.5 * -np.sin(angle) - 0.2 * np.cos(angle))
    assert found.reactions.drive_torque == pytest.approx(-work, rel=1e-9)
    assert_links_balance(found.reactions, loads)
    assert found.reactions.joints["M"].magnitude > 0.1


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_a_long_coupler_without_part_does_not_sag_on_short_cranks(share):
    """Three upright cranks are parallel springs under a rigid beam: P/3 each, and more on the side of the load."""
    data, width, load = portal(), 40.0 * HEIGHT, 6.0
    del data["links"]["top"]["part"]
    data["links"]["ground"]["points"] |= {"D": [f"{width} mm", "0 mm"], "N": [f"{width / 2} mm", "0 mm"]}
    data["links"]["top"]["points"] |= {
        "M": [f"{width / 2} mm", "0 mm"],
        "P": [f"{width * (0.5 + share)} mm", "0 mm"],
        "C": [f"{width} mm", "0 mm"],
    }
    data["links"]["third"] = {"part": "rod", "points": {"N": ["0 mm", "0 mm"], "M": [f"{HEIGHT} mm", "0 mm"]}}
    data["joints"] |= {
        "N": {"links": ["ground", "third"], "pin_diameter": "1 mm"},
        "M": {"links": ["top", "third"], "pin_diameter": "1 mm"},
    }
    data["pose"]["near"] |= {"third": "90 deg"}
    case = validate(data)
    found = joint_forces(case, case.solve_pose(), (force("top", "P", 0.0, -load),)).reactions
    # Springs at -1/2, 0, 1/2 of the width: P (1/3 + x_i a / Σ x²), a the share off the middle.
    expected = {name: load * (1.0 / 3.0 + x * share / 0.5) for name, x in (("B", -0.5), ("M", 0.0), ("C", 0.5))}
    assert {name: found.joints[name].magnitude for name in expected} == pytest.approx(expected, rel=1e-4)


def test_in_the_plane_equilibrium_alone_is_used():
    loads = (force("CH", "H", 0.0, -0.25),)
    found = joint_forces(WING, WING.solve_pose(), loads)
    assert (found.model, found.frame) == (PINNED_STATICS, None)
    assert not out_of_plane(loads)
    for load in (
        force("CH", "H", 0, 0, 1e-6),
        force("CH", "H", 0, 0, 0, 1.0),
        force("CH", "H", 0, 0, 0, 0, 1.0),
        LineLoad(link="CF", start=0.0, end=9.0, at_start=np.zeros(3), at_end=np.array([0, 0, 1e-6])),
        body_force("AE", [0.0, 0.0, 1.0]),
    ):
        assert out_of_plane((load,))


def test_ways_to_hold_the_wing():
    pose = WING.solve_pose()
    loads = (force("CH", "H", 0.0, -0.25),)
    found = {held.name: -held.displacement[1] for held in ways_to_hold(WING, pose, loads)}
    assert list(found) == ["pinned, held at AE", "pinned, held at GF", "bonded, A, G built in"]
    assert list(found.values()) == pytest.approx([47.5, 4.8, 3.6], rel=0.02)
    assert ways_to_hold(WING.model_copy(update={"ways_to_hold": None}), pose, loads) == ()


def test_what_no_frame_can_be_made_of():
    data = portal()
    for link in ("left", "top", "right"):
        del data["links"][link]["part"]
    bare = validate(data)
    with pytest.raises(CaseError, match=r"links: no moving link has a part"):
        build_frame(bare, bare.solve_pose(), (), held=bare.pinned_drive)


def test_a_condensed_beam_does_in_the_frame_what_the_beam_does():
    """The left crank as a cantilever's closed form, under a line load across and along: all joint forces are the same.

    Timoshenko's cantilever with end forces, and with even loads p along and q across: p L²/(2EA), q L⁴/(8EI) +
    q L²/(2κGA), q L³/(6EI).
    """
    case = validate(portal() | {"joint_model": "bonded"})
    pose, material, section = case.solve_pose(), case.material_of("left"), case.part_of("left").section
    young, shear, L = material.youngs_modulus, material.shear_modulus, HEIGHT
    stiff = young * section.i_z
    kga = shear * section.area * section.shear_coefficient(material.poissons_ratio)
    F = np.diag([L / (young * section.area), 0.0, 0.0, L / (shear * section.torsion), L / stiff, L / stiff])
    F[1, 1] = F[2, 2] = L**3 / (3.0 * stiff) + L / kga
    F[1, 5] = F[5, 1] = L**2 / (2.0 * stiff)
    F[2, 4] = F[4, 2] = -F[1, 5]
    p, q = 0.03, -0.02
    moved = np.zeros(12)
    moved[6:8] = p * L**2 / (2.0 * young * section.area), q * L**4 / (8.0 * stiff) + q * L**2 / (2.0 * kga)
    moved[11] = q * L**3 / (6.0 * stiff)
    whole = np.zeros((12, 12))
    whole[6:, 6:] = F
    # The crank stands upright: its x is the global y.
    line = np.array([-q, p, 0.0])
    loads = (
        force("top", "M", 0.3, -0.2, 0.6, 4.0, -3.0, 5.0),
        LineLoad(link="left", start=0.0, end=L, at_start=line, at_end=line),
    )
    plain = build_frame(case, pose, loads, held=case.pinned_drive, bonded=True)
    solids = {"left": LinkFlexibility(places=("A", "B"), flexibility=whole, moved=moved)}
    frame = build_frame(case, pose, loads, held=case.pinned_drive, bonded=True, solids=solids)
    assert len(frame.model.elements) == len(plain.model.elements) - 1
    answers = []
    for one in (plain, frame):
        solution = solve_frame(one.model)
        answers.append(
            (one.reactions(solution.joint_wrenches, solution.residual), one.at_points(solution.displacements))
        )
    (expected, places), (found, condensed) = answers
    for name, joint in expected.joints.items():
        assert found.joints[name].wrench == pytest.approx(joint.wrench, abs=1e-8), name
    assert found.drive_torque == pytest.approx(expected.drive_torque, rel=1e-9)
    for key, place in places.items():
        assert condensed[key] == pytest.approx(place, abs=1e-9), key


def test_a_frame_may_have_condensed_links_alone():
    """One rigid link bonded to the ground bears its load there: nothing moves."""
    case = validate(portal())
    pose = case.solve_pose()
    loads = (force("top", "M", 0.3, -0.2, 0.1),)
    solids = {link: LinkFlexibility.rigid(tuple(case.links[link].points)) for link in ("left", "top", "right")}
    solids["top"] = replace(solids["top"], flexibility=np.eye(18) * 1e-6)
    frame = build_frame(case, pose, loads, held=case.pinned_drive, bonded=True, solids=solids)
    assert frame.model.elements == ()
    solution = solve_frame(frame.model)
    reactions = frame.reactions(solution.joint_wrenches, solution.residual)
    total = sum(reactions.joints[name].force for name in "AD")
    assert total == pytest.approx([-0.3, 0.2, -0.1], abs=1e-12)
