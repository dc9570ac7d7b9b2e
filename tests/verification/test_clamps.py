"""Clamped joints: closed forms of built-in beams, by statics, by hand, in the frame and as solids."""

import copy
import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from alula.fea.beam.cut_free import link_loads
from alula.fea.buckling.buckling import column
from alula.fea.buckling.solid_holding import solid_holding
from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.elements.mouth import mouth_motion
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.fea.links.clamp_edge import EDGE, edge_stress
from alula.fea.links.link_by_hand import link_by_hand
from alula.fea.motion.envelope import envelope_case
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.standing.joint_forces import BONDED_FRAME, BONDED_STATICS, joint_forces, solved_frame
from alula.fea.tolerance.analysis import tolerance_case
from alula.fea.vibration.link_modes import link_modes
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.actions import acting_loads
from alula.reports.sentences import told
from alula.reports.sentences.caveats import not_checked
from docs.extensions.examples import FOLDER

FORCE, FREE, HELD = 100.0, 180.0, 20.0
OUTER, INNER = 20.0, 16.0
SECOND, AREA = math.pi / 64.0 * (OUTER**4 - INNER**4), math.pi / 4.0 * (OUTER**2 - INNER**2)
SOFT = 1.0 / 70.0
"""What shear may add to the displacement of a beam that is nine diameters long, as a share."""
ENTRY = tomllib.loads((FOLDER / "clamped.toml").read_text(encoding="utf-8"))


def data(**tables):
    """The cantilever of the example, with tables merged into it."""
    found = copy.deepcopy(ENTRY)
    for name, table in tables.items():
        if isinstance(table, dict):
            found.setdefault(name, {}).update(table)
        else:
            found[name] = table
    return found


def case(**tables):
    return validate(data(**tables))


def pushed(*force):
    return {"push": {"forces": [{"link": "beam", "at": "tip", "force": [f"{f} N" for f in force]}]}}


def points(**places):
    return {name: [f"{x} mm", "0 mm"] for name, x in places.items()}


def forces(of):
    """Joint forces and loads of the only load case."""
    pose, [load_case] = of.solve_pose(), of.load_cases.values()
    loads = acting_loads(of, load_case, pose.placement, {})
    return joint_forces(of, pose, loads), loads


def by_hand(of, link="beam"):
    found, loads = forces(of)
    return link_by_hand(of, link, link_loads("push", link, of.body(link), found.reactions, loads))


def young(of, link="beam"):
    return of.material_of(link).youngs_modulus


def outcome(result, quantity, name="beam"):
    every = [one for load_case in result.load_cases.values() for one in load_case.checks]
    return next(one for one in every if one.quantity is quantity and one.subject.name.endswith(name))


@pytest.fixture(scope="module")
def solid():
    """The cantilever as a solid, with checks of its strength, and of its tip with and without room."""
    checks = {
        "strength": {"type": "safety-factor", "minimum": 1.5},
        "tip": {"type": "displacement", "at": "tip", "maximum": "1 mm"},
    }
    return check_case(case(checks=checks), name="cantilever")


def test_a_cantilever_needs_one_point_of_ground_and_neither_pose_nor_drive():
    """Its reaction is F and F L about the joint, by equilibrium alone."""
    found, _ = forces(case())
    assert found.model == BONDED_STATICS
    wrench = found.reactions.joints["O"].wrench
    assert wrench == pytest.approx([0.0, FORCE, 0.0, 0.0, 0.0, FORCE * (FREE + HELD)])
    assert found.reactions.pose.linkage.mobility == 0


@pytest.mark.parametrize("at", ["first", "last"])
def test_by_hand_the_free_length_begins_at_the_mouth(at):
    """M = F L and F L³/(3 E I) with the free length, at either end of the link."""
    places = points(O=0.0, tip=FREE + HELD) if at == "first" else points(tip=-FREE - HELD, O=0.0)
    of = case(links=data()["links"] | {"beam": {"part": "tube", "points": places}})
    hand = by_hand(of)
    assert hand.worst[1].bending == pytest.approx(FORCE * FREE * OUTER / 2.0 / SECOND)
    assert abs(hand.worst[0]) == pytest.approx(HELD)
    bent = FORCE * FREE**3 / (3.0 * young(of) * SECOND)
    assert bent < hand.displacement < (1.0 + 2.0 * SOFT) * bent
    _, loads = forces(of)
    frame, solution = solved_frame(of, of.solve_pose(), loads, None)
    moved = frame.at_points(solution.displacements)["beam", "tip"]
    assert np.linalg.norm(moved) == pytest.approx(hand.displacement, rel=1e-5)  # what is held does not give there


def test_axial_force_torque_and_moment_out_of_the_plane_reach_the_mouth():
    """N/A, and M_y = F L of a force along z, by the spatial frame."""
    hand = by_hand(case(load_cases=pushed(FORCE, 0.0)))
    assert hand.worst[1].axial == pytest.approx(FORCE / AREA)
    found, _ = forces(of := case(load_cases=pushed(0.0, 0.0, FORCE)))
    assert found.model == BONDED_FRAME
    assert by_hand(of).worst[1].bending == pytest.approx(FORCE * FREE * OUTER / 2.0 / SECOND, rel=1e-6)
    assert found.reactions.joints["O"].wrench[4] == pytest.approx(FORCE * (FREE + HELD), rel=1e-6)


def test_own_weight_of_a_cantilever_is_whole():
    """M = q L²/2 at the mouth by hand, and the reaction is the whole weight, with what the clamp holds."""
    still = {"push": pushed(0.0, -1e-3)["push"] | {"own_weight": True}}
    of = case(load_cases=still, checks={"strength": {"type": "safety-factor", "minimum": 1.5}})
    weight = of.material_of("beam").density * AREA * 9810.0
    result = check_case(of, name="weight")
    [found] = result.load_cases.values()
    assert found.reactions.joints["O"].wrench[1] == pytest.approx(weight * (FREE + HELD) + 1e-3, rel=1e-4)
    moment = weight * FREE**2 / 2.0 + 1e-3 * FREE
    own = found.links["beam"]
    assert own.beam.worst.bending == pytest.approx(moment * OUTER / 2.0 / SECOND, rel=1e-3)
    assert own.von_mises_max.low < moment * OUTER / 2.0 / SECOND < own.von_mises_max.high


def test_the_solid_bears_what_beam_theory_has_at_the_mouth(solid):
    """M/W within the band of the mesh, and the edge of the clamp at its upper end."""
    [load_case] = solid.load_cases.values()
    own, nominal = load_case.links["beam"], FORCE * FREE * OUTER / 2.0 / SECOND
    stress = own.von_mises_max
    assert own.decided_by == "solid"
    assert stress.value == pytest.approx(nominal, rel=0.05)
    assert stress.low < nominal
    assert stress.high == pytest.approx(EDGE * nominal, rel=1e-3)
    assert any(source.kind is SourceKind.CLAMP for source in stress.sources)
    assert abs(own.location[0] - HELD) < OUTER / 2.0


def test_the_solid_moves_from_the_section_at_the_mouth(solid):
    """F L³/(3 E I) with shear, in the band of the tip of the linkage and near that of the link by itself."""
    bent = FORCE * FREE**3 / (3.0 * young(solid.case) * SECOND)
    tip = outcome(solid, Quantity.DISPLACEMENT, "tip of beam").value
    assert tip.low < bent * (1.0 + SOFT) < tip.high
    assert tip.value == pytest.approx(bent * (1.0 + SOFT), rel=0.02)
    [load_case] = solid.load_cases.values()
    assert load_case.links["beam"].displacement_max.value == pytest.approx(tip.value, rel=0.02)


def test_what_holds_is_told_and_no_pin_is(solid):
    said = " ".join(not_checked(solid.caveats))
    assert "clamps O" in said
    assert "pin" not in said


def two(**joints):
    """Two tubes clamped at a right angle, the lower one on the ground."""
    tables = data()
    tables["links"] = {
        "ground": {"ground": True, "points": points(O=0.0)},
        "low": {"part": "tube", "points": points(O=0.0, A=200.0)},
        "high": {"part": "tube", "points": points(A=0.0, tip=150.0)},
    }
    tables["joints"] = {
        "O": {"links": ["ground", "low"], "clamped": True, "clamp_length": "20 mm", "angle": "90 deg"},
        "A": {"links": ["low", "high"], "clamped": True, "clamp_length": "15 mm", "angle": "-90 deg"} | joints,
    }
    tables["load_cases"] = {"push": {"forces": [{"link": "high", "at": "tip", "force": ["0 N", "-100 N"]}]}}
    return validate(tables)


def test_two_links_clamped_together_are_a_bent_cantilever():
    """The moment passes the joint, and the tip moves as a frame of two beams that are rigid where they are held."""
    of = two()
    found, loads = forces(of)
    assert found.reactions.joints["A"].wrench[5] == pytest.approx(100.0 * 150.0)
    assert by_hand(of, "low").worst[1].bending == pytest.approx(100.0 * 150.0 * OUTER / 2.0 / SECOND)
    assert by_hand(of, "high").worst[1].bending == pytest.approx(100.0 * 135.0 * OUTER / 2.0 / SECOND)
    frame, solution = solved_frame(of, of.solve_pose(), loads, None)
    moved = frame.at_points(solution.displacements)["high", "tip"]
    stiff = young(of, "low") * SECOND
    turned = 100.0 * 150.0 * 165.0 / stiff  # of the low link, whose ends are held over 20 and 15 mm
    assert -moved[1] == pytest.approx(turned * 150.0 + 100.0 * 135.0**3 / (3.0 * stiff), rel=0.02)
    assert moved[0] == pytest.approx(turned * (165.0 / 2.0 + 15.0), rel=0.02)


def test_the_angle_of_a_clamp_is_stated_or_none():
    pose = two().solve_pose()
    assert math.degrees(pose.angles["low"]) == pytest.approx(90.0)
    assert math.sin(pose.angles["high"]) == pytest.approx(0.0, abs=1e-12)
    assert case().solve_pose().angles["beam"] == pytest.approx(0.0, abs=1e-12)


def propped():
    """Held over 20 mm at one end, on a pin at the other, 380 mm between them."""
    tables = data()
    tables["links"] = {
        "ground": {"ground": True, "points": points(O=0.0, B=400.0)},
        "beam": {"part": "bar", "points": points(O=0.0, M=210.0, B=400.0)},
    }
    tables["joints"]["B"] = {"links": ["ground", "beam"], "pin_diameter": "4 mm"}
    tables["parts"] = {
        "bar": {
            "shape": "bar",
            "material": "aluminium-6061-t6",
            "width": "10 mm",
            "thickness": "6 mm",
            "fillet_radius": "2 mm",
        }
    }
    tables["load_cases"] = {"push": {"forces": [{"link": "beam", "at": "M", "force": ["0 N", "-100 N"]}]}}
    return tables


def test_a_propped_cantilever_shares_its_load():
    """11/16 and 5/16 of a force in the middle of the free length (Roark, table 8.1, case 1c), and 3 P L/16 there."""
    found, _ = forces(of := validate(propped()))
    assert found.model == BONDED_FRAME
    joints = found.reactions.joints
    assert joints["O"].wrench[1] == pytest.approx(100.0 * 11.0 / 16.0, rel=1e-3)
    assert joints["B"].wrench[1] == pytest.approx(100.0 * 5.0 / 16.0, rel=2e-3)
    assert by_hand(of).check.forces.at(20.0)[5] == pytest.approx(-3.0 / 16.0 * 100.0 * 380.0, rel=3e-3)


def portal(held):
    """A portal of three equal tubes, all four joints clamped, pushed at its upper left corner."""
    tables = data()
    tables["parts"]["tube"] |= {"outer_diameter": "10 mm", "inner_diameter": "8 mm"}
    tables["links"] = {
        "ground": {"ground": True, "points": points(A=0.0, D=300.0)},
        "left": {"part": "tube", "points": points(A=0.0, B=200.0)},
        "beam": {"part": "tube", "points": points(B=0.0, C=300.0)},
        "right": {"part": "tube", "points": points(C=0.0, D=200.0)},
    }
    pairs = {"A": "ground left", "B": "left beam", "C": "beam right", "D": "ground right"}
    tables["joints"] = {
        name: {"links": pair.split(), "clamped": True, "clamp_length": f"{held} mm"}
        | {"angle": "90 deg" if name == "A" else "-90 deg"}
        for name, pair in pairs.items()
    }
    tables["load_cases"] = {"push": {"forces": [{"link": "beam", "at": "B", "force": ["10 N", "0 N"]}]}}
    return validate(tables)


def test_a_portal_frame_has_the_moments_of_the_slope_deflection_method():
    """Feet: P h/2 (3 k + 1)/(6 k + 1) with k = h/l of equal sections (Kleinlogel, Rahmenformeln, frame 1)."""
    found, loads = forces(of := portal(1.0))
    ratio = 200.0 / 300.0
    foot = 10.0 * 200.0 / 2.0 * (3.0 * ratio + 1.0) / (6.0 * ratio + 1.0)
    joints = found.reactions.joints
    assert joints["A"].wrench[5] == pytest.approx(foot, rel=0.01)
    assert joints["D"].wrench[5] == pytest.approx(foot, rel=0.01)
    moved = examine(of, "push", found, loads)
    assert moved.state == "small"
    assert not moved.gives_way


def test_short_clamps_are_followed_on_the_deformed_shape():
    """A clamp of a tenth of the diameter is no stiffer than the iteration bears; longer ones hold more."""
    factors = []
    for held in (1.0, 20.0):
        tables = portal(held)
        loaded = tables.model_copy(update={"load_cases": {"push": tables.load_cases["push"]}})
        found, loads = forces(loaded)
        larger = [replace(load, wrench=300.0 * load.wrench) for load in loads]
        more = replace(found, frame=None, solution=None)
        moved = examine(loaded, "push", more, larger)
        assert moved.state == "deformed"
        factors.append(moved.buckling)
    assert factors[1] > 1.1 * factors[0]


def slender(*force):
    tables = data(load_cases=pushed(*force))
    tables["parts"]["tube"] |= {"outer_diameter": "10 mm", "inner_diameter": "8 mm"}
    return validate(tables)


def test_a_clamped_column_buckles_at_eulers_load():
    """π² E I/(4 L²) with the free length, as a link and in the frame."""
    of = slender(-100.0, 0.0)
    euler = math.pi**2 * young(of) * math.pi / 64.0 * (10.0**4 - 8.0**4) / (4.0 * FREE**2) / 100.0
    found = column(of, "beam", by_hand(of).check)
    assert found.value == pytest.approx(euler, rel=1e-4)
    joints, loads = forces(of)
    assert examine(of, "push", joints, loads).buckling == pytest.approx(euler, rel=0.01)


def test_a_cantilever_far_from_its_straight_shape_is_the_elastica():
    """F L²/(E I) = 2 moves the tip by 0.494 L across and 0.161 L back (Bisshopp & Drucker, Q. Appl. Math. 3, 1945)."""
    tables = data()
    tables["parts"]["tube"] |= {"outer_diameter": "2 mm", "inner_diameter": "1 mm", "fillet_radius": "0.2 mm"}
    stiff = 68900.0 * math.pi / 64.0 * (2.0**4 - 1.0)
    tables["load_cases"] = pushed(0.0, -2.0 * stiff / FREE**2)
    of = validate(tables)
    assert young(of) == pytest.approx(68900.0)
    moved = examine(of, "push", *forces(of))
    assert moved.state == "deformed"
    tip = moved.points["beam", "tip"]
    assert -tip[1] == pytest.approx(0.4935 * FREE, rel=0.005)
    assert -tip[0] == pytest.approx(0.1606 * FREE, rel=0.01)
    bending = link_by_hand(of, "beam", moved.links["beam"]).worst[1].bending
    moment = 2.0 * stiff / FREE**2 * (FREE + tip[0])  # of the force, whose arm is shorter
    assert bending == pytest.approx(moment / (stiff / 68900.0), rel=0.002)


def test_a_cantilever_rings_at_its_natural_frequencies():
    """(1.8751, 4.6941)² √(E I/(ρ A L⁴))/2π of a slender one, in the plane and out of it alike."""
    tables = data()
    tables["parts"]["tube"] |= {"outer_diameter": "4 mm", "inner_diameter": "3 mm", "fillet_radius": "0.2 mm"}
    of = validate(tables)
    material, second, area = of.material_of("beam"), math.pi / 64.0 * (256.0 - 81.0), math.pi / 4.0 * 7.0
    found = [mode.frequency.value for mode in link_modes(of, "beam").modes]
    for number, root in enumerate((1.8751, 1.8751, 4.6941, 4.6941)):
        speed = math.sqrt(material.youngs_modulus * second / (material.density * area * FREE**4))
        assert found[number] == pytest.approx(root**2 * speed / (2.0 * math.pi), rel=0.01)


def built_in(at):
    """Clamped at both ends over 10 and 30 mm, with a force at ``at`` of the 360 mm between the mouths."""
    tables = data(load_cases={"push": {"forces": [{"link": "beam", "at": "M", "force": ["0 N", "-100 N"]}]}})
    tables["links"] = {
        "ground": {"ground": True, "points": points(O=0.0, B=400.0)},
        "beam": {"part": "tube", "points": points(O=0.0, M=10.0 + at, B=400.0)},
    }
    tables["joints"] = {
        "O": {"links": ["ground", "beam"], "clamped": True, "clamp_length": "10 mm"},
        "B": {"links": ["ground", "beam"], "clamped": True, "clamp_length": "30 mm"},
    }
    return validate(tables)


@pytest.mark.parametrize("at", [90.0, 270.0])
def test_of_two_clamps_the_worse_mouth_counts(at):
    """P a b²/L² at the nearer one (Roark, table 8.1, case 1d), whichever it is; its edge is the upper end."""
    of = built_in(at)
    hand, nearer = by_hand(of), min(at, 360.0 - at)
    moment = 100.0 * nearer * (360.0 - nearer) ** 2 / 360.0**2
    assert hand.worst[0] == pytest.approx(10.0 if at < 180.0 else 370.0)
    assert hand.worst[1].bending == pytest.approx(moment * OUTER / 2.0 / SECOND, rel=0.01)
    nominal = hand.worst[1].equivalent
    assert edge_stress(of.body("beam"), hand.check, 0.0) == pytest.approx(EDGE * nominal, rel=1e-6)


def test_a_part_that_is_no_beam_has_the_edge_on_its_largest_stress():
    parts = {"tube": {"shape": "plate", "material": "aluminium-6061-t6", "thickness": "6 mm", "eye_diameter": "40 mm"}}
    of = case(parts=parts)
    hand = by_hand(of)
    assert edge_stress(of.body("beam"), hand.check, 50.0) == pytest.approx(EDGE * 50.0)
    assert edge_stress(of.body("beam"), hand.check, 70.0) == pytest.approx(EDGE * 70.0)
    assert edge_stress(pressed().body("lever"), hand.check, 50.0) == 0.0


def test_a_clamped_plate_is_built_in_where_it_is_held():
    """As a solid against buckling, it is built in at its clamp alone, and held there by its faces."""
    parts = {"tube": {"shape": "plate", "material": "aluminium-6061-t6", "thickness": "6 mm", "eye_diameter": "40 mm"}}
    held = solid_holding(case(parts=parts), "beam")
    assert list(held.places) == ["end:O"]
    assert told(held.how) == "built in at O"
    assert held.value == pytest.approx(np.eye(6))
    assert len(held.alone) == 1


def pressed(**changes):
    """A lever pressed on a shaft of the ground."""
    tables = data(load_cases={"push": {"forces": [{"link": "lever", "at": "tip", "force": ["0 N", "-50 N"]}]}})
    tables["links"] = {
        "ground": {"ground": True, "points": points(O=0.0)},
        "lever": {"part": "bar", "points": points(O=0.0, tip=80.0)},
    }
    tables["joints"] = {"O": {"links": ["ground", "lever"], "clamped": True, "pin_diameter": "8 mm"}}
    tables["parts"] = {
        "bar": {
            "shape": "bar",
            "material": "aluminium-6061-t6",
            "width": "10 mm",
            "thickness": "6 mm",
            "fillet_radius": "2 mm",
        }
    }
    return validate(tables | changes)


def test_a_shaft_that_is_pressed_in_turns_its_bore_by_shear():
    """All of the moment is shear in the bore, as friction's is, and none of it enters by flat faces."""
    of = pressed()
    found, loads = forces(of)
    [pin] = link_loads("push", "lever", of.body("lever"), found.reactions, loads).pins
    assert pin.wrench[5] == pytest.approx(50.0 * 80.0)
    assert pin.friction == pytest.approx(pin.wrench[5])
    assert pin.torque == pytest.approx(0.0, abs=1e-9)
    assert of.pinned_joints == ()


def motion(clamp):
    """A crank with an arm, over a quarter of a turn."""
    tables = data(load_cases={"push": {"forces": [{"link": "arm", "at": "tip", "force": ["0 N", "-50 N"]}]}})
    tables["links"] = {
        "ground": {"ground": True, "points": points(O=0.0)},
        "crank": {"points": points(O=0.0, A=60.0)},
        "arm": {"part": "tube", "points": points(A=0.0, tip=100.0)},
    }
    tables["joints"] = {"O": {"links": ["ground", "crank"]}, "A": {"links": ["crank", "arm"]} | clamp}
    tables["pose"] = {"coordinate": "crank", "angle": "0 deg"}
    tables["drive"] = {"link": "crank", "joint": "O"}
    tables["motion"] = {"coordinate": "crank", "range": ["0 deg", "90 deg"], "poses": 3}
    return validate(tables)


def test_over_a_motion_the_edge_is_on_the_largest_stress():
    of = motion({"clamped": True, "clamp_length": "10 mm"})
    result = envelope_case(of)
    [found] = result.links["arm"].load_cases.values()
    nominal = 50.0 * 90.0 * OUTER / 2.0 / SECOND
    assert found.stress.value == pytest.approx(nominal, rel=0.1)
    assert found.stress.high >= EDGE * found.stress.value
    assert any(source.kind is SourceKind.CLAMP for source in found.stress.sources)


WRONG = {
    "no length": ({"clamp_length": None}, "needs the length over which"),
    "two ways": ({"pin_diameter": "4 mm"}, "both are stated"),
    "not clamped": ({"clamped": False, "pin_diameter": "4 mm"}, "joint O is not clamped"),
    "slides": ({"type": "slider"}, "a joint of type slider slides"),
    "rubs": ({"friction": 0.1}, "does not turn"),
    "has play": ({"clearance": "0.1 mm"}, "has no play"),
    "has a tight pin": ({"tight_in": "beam"}, "has no pin"),
    "too long": ({"clamp_length": "220 mm"}, "set clamp_length below 200 mm"),
    "too short": ({"clamp_length": "1 mm"}, "holds no moment"),
}


@pytest.mark.parametrize(("change", "rule"), WRONG.values(), ids=list(WRONG))
def test_what_a_clamp_cannot_be_is_refused_by_name(change, rule):
    tables = data()
    tables["joints"]["O"] |= change
    tables["joints"]["O"] = {key: value for key, value in tables["joints"]["O"].items() if value is not None}
    with pytest.raises(CaseError, match=rule):
        validate(tables)


def test_a_clamp_holds_an_end():
    links = data()["links"] | {"beam": {"part": "tube", "points": points(Z=-50.0, O=0.0, tip=200.0)}}
    with pytest.raises(CaseError, match="the clamp at O lies between the ends of the tube"):
        case(links=links)


def test_one_point_of_a_link_is_held_in_one_way():
    found = data()
    found["links"]["other"] = {"points": points(O=0.0, far=10.0)}
    found["joints"]["P"] = {"links": ["beam", "other"], "points": ["O", "O"], "clamped": True, "clamp_length": "5 mm"}
    with pytest.raises(CaseError, match=r"joints\.P\.clamp_length: joint 'O' is at the same point of link 'beam'"):
        validate(found)


def test_a_link_that_moves_needs_two_points():
    links = data()["links"] | {"beam": {"part": "tube", "points": points(O=0.0)}}
    with pytest.raises(CaseError, match=r"links\.beam\.points: it has 1, but at least 2 must be there"):
        case(links=links, load_cases={"push": {"forces": []}})


@pytest.mark.parametrize("kind", ["pins", "bearing"])
@pytest.mark.parametrize("named", [True, False])
def test_a_check_of_pins_on_clamps_alone_is_refused(kind, named):
    check = {"type": kind, "minimum": 2.0} | ({"joints": ["O"]} if named else {})
    with pytest.raises(CaseError, match=r"checks\.held: joint 'O' is clamped and has no pin"):
        case(checks={"held": check})


def test_a_drive_at_a_clamp_is_refused():
    tables = data(drive={"link": "beam", "joint": "O"})
    with pytest.raises(CaseError, match=r"drive\.joint: joint 'O' is clamped"):
        validate(tables)


def test_tolerances_of_clamps_are_refused():
    with pytest.raises(CannotRunError, match="joint O is clamped"):
        tolerance_case(case(tolerances={"pins": "0.2 mm"}), name="cantilever", samples=100)


def test_by_hand_alone_a_clamp_decides_nothing():
    checks = {"strength": {"type": "safety-factor", "minimum": 1.5}}
    result = check_case(case(checks=checks), name="cantilever", fidelity="beam")
    found = outcome(result, Quantity.SAFETY_FACTOR)
    assert found.verdict is Verdict.UNDECIDED
    assert "it is clamped" in told(found.reason)


def test_the_mouth_of_a_field_that_bends_is_found():
    """A field of sections that turn and shift as cubics along the clamp, with the warp of Poisson's ratio beside it."""
    rng = np.random.default_rng(1)
    x, turn = rng.uniform(0.0, 20.0, (40, 6)), rng.uniform(0.0, 2.0 * math.pi, (40, 6))
    places = np.stack([x, 10.0 * np.cos(turn), 10.0 * np.sin(turn)], axis=-1)
    surface = SurfaceQuadrature(
        nodes=np.arange(240).reshape(40, 6), phi=np.eye(6), x=places, w=np.ones((40, 6)), normals=np.zeros((40, 6, 3))
    )
    for mouth, along in ((20.0, 1.0), (0.0, -1.0)):
        s = along * (mouth - places[..., 0].ravel())
        y = places[..., 1].ravel()
        tilt, lift = 1e-3 + 2e-4 * s - 3e-6 * s**2, 0.1 + 0.02 * s**2 - 1e-4 * s**3
        field = np.stack([-y * tilt, lift, np.zeros_like(s)], axis=-1)
        found = mouth_motion(surface, np.array([mouth, 0.0, 0.0]), field)
        assert found == pytest.approx([0.0, 0.1, 0.0, 0.0, 0.0, 1e-3], abs=1e-10)
