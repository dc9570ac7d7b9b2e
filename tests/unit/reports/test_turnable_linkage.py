"""The linkage that a reader can turn: its bodies, heights and poses are those of the case."""

import base64
import json

import numpy as np
import pytest
import solved

from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case_file import read_case
from alula.loads.case.layers import slab
from alula.loads.states.case_motion import drive_angles, solve_case_motion
from alula.loads.states.masses import part_masses
from alula.reports.turnable.moving import check_linkage, motion_linkage
from alula.reports.turnable.pack import data_block

MOVING = ("flapping-wing-chosen", "ornithopter", "four-bar-synthesis", "spring-pedal", "owl-wing-static")


def unpacked(packed, columns):
    """Decode quantised numbers as a browser does."""
    steps = np.frombuffer(base64.b64decode(packed["data"]), dtype="<u2").reshape(-1, columns)
    low, high = np.array(packed["low"]), np.array(packed["high"])
    return low + steps * (high - low) / 65535


def records(name):
    return {link["name"]: link for link in json.loads(data_block(check_linkage(solved.by_hand(name))))["links"]}


def polygons(plate):
    """Areas of the rings of a plate, those of holes negative."""
    corners, areas, first = unpacked(plate["corners"], 2), [], 0
    for count in plate["counts"]:
        x, y = corners[first : first + count].T
        areas.append(0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
        first += count
    return areas


def placed(frames, moving, case):
    """Places of all joints at all poses: (link, point, place by the first link, place by the second), complex."""
    at = {link: (frames[:, 3 * k], frames[:, 3 * k + 1] + 1j * frames[:, 3 * k + 2]) for k, link in enumerate(moving)}
    at[case.linkage.ground] = (np.zeros(len(frames)), np.zeros(len(frames), dtype=complex))
    for name, joint in case.linkage.joints.items():
        if joint.type == "revolute":
            ends = [
                origin + np.exp(1j * angle) * complex(*case.links[link].points[point])
                for link, point in zip(joint.links, case.linkage.joint_points(name), strict=True)
                for angle, origin in [at[link]]
            ]
            yield joint.links[0], case.linkage.joint_points(name)[0], *ends


@pytest.mark.parametrize("name", MOVING)
def test_links_meet_at_their_joints_in_every_pose_and_pass_by_the_stated_one(name):
    result = solved.by_hand(name)
    record = check_linkage(result)
    motion, case = record["motion"], result.case
    moving = motion["links"]
    frames = unpacked(motion["frames"], 3 * len(moving))
    assert len(frames) == len(motion["texts"]) <= 125
    steps = (np.array(motion["frames"]["high"]) - motion["frames"]["low"]) / 65535
    reach = max(np.hypot(*at) for link in case.links.values() for at in link.points.values())
    slack = 1.01 * (steps[1::3].max() + steps[2::3].max() + reach * steps[::3].max())
    assert slack < 1e-3 * record["size"]
    for link, point, first, second in placed(frames, moving, case):
        assert np.abs(first - second).max() < slack, point
        assert abs(first[motion["first"]] - complex(*result.pose.position(link, point))) < slack, point


def test_poses_are_those_of_the_motion_for_the_values_that_are_told():
    case = read_case("ornithopter")
    motion = motion_linkage(solve_case_motion(case))["motion"]
    frames = unpacked(motion["frames"], 3 * len(motion["links"]))
    told = np.radians([float(text.split()[2].replace("−", "-")) for text in motion["texts"]])
    found = solve_motion(case.solve_pose(), drive_angles(case, case.solve_pose()), coordinate=case.motion_coordinate)
    crank = motion["links"].index(case.motion_coordinate.name)
    assert np.angle(np.exp(1j * (frames[:, 3 * crank] - told))) == pytest.approx(0.0, abs=1e-3)
    assert frames[0, ::3] == pytest.approx(found.q[0, : len(motion["links"])] % (2 * np.pi), abs=1e-3) or np.allclose(
        np.exp(1j * frames[0, ::3]), np.exp(1j * found.q[0, : len(motion["links"])]), atol=1e-3
    )


@pytest.mark.parametrize("name", ["four-bar-synthesis", "knee"])
def test_bodies_have_the_volume_of_their_parts_and_are_closed(name):
    """Their solids in the kernel tell the mass; chords of arcs leave some volume, and fillets across it."""
    case, links = solved.by_hand(name).case, records(name)
    for link, mass in part_masses(case).items():
        volume = 0.0
        for plate in links[link]["plates"]:
            areas = polygons(plate)
            volume += sum(sum(areas[k] for k in rings) * (high - low) for rings, low, high in plate["walls"])
            up, down = (
                sum(sum(areas[k] for k in rings) for rings, _, side in plate["caps"] if side == s) for s in (1, 0)
            )
            assert up == pytest.approx(down, rel=1e-3)
        assert volume == pytest.approx(mass.mass / case.material_of(link).density, rel=0.02), link


@pytest.mark.parametrize("name", ["owl-wing-static", "owl-wing-closed"])
def test_bodies_stand_at_the_heights_of_their_layers(name):
    case, links = solved.by_hand(name).case, records(name)
    assert case.layered
    for link in case.checked_links:
        found = [z for p in links[link]["plates"] for _, low, high in p["walls"] for z in (low, high)]
        found += [
            z + side * radius
            for p in links[link]["plates"]
            for _, _, z, _, _, radius, _ in p["rods"]
            for side in (-1, 1)
        ]
        assert (min(found), max(found)) == pytest.approx(slab(case, link)), link
    pins = check_linkage(solved.by_hand(name))["pins"]
    for pin in pins:
        faces = [z for joint in pin["names"] for link in case.joints[joint].links for z in slab(case, link)]
        assert (pin["low"], pin["high"]) == pytest.approx((min(faces), max(faces)))


def test_a_tube_is_round_between_its_eyes():
    [plate] = records("owl-wing-closed")["AE"]["plates"]
    [rod] = plate["rods"]
    assert rod[:2] == [0.0, 0.0]
    assert rod[3:6] == [0.0, 190.0, 2.5]
    eyes = [high - low for _, low, high in plate["walls"]]
    assert eyes == pytest.approx([7.0] * 3)


def test_both_plates_of_a_pair_are_pulled_to_either_side_of_what_lies_between():
    links = records("knee")
    pairs = [[plate["rank"] for plate in link["plates"]] for link in links.values() if len(link["plates"]) == 2]
    single = {plate["rank"] for link in links.values() if len(link["plates"]) == 1 for plate in link["plates"]}
    assert len(pairs) == 2
    assert all(low < rank < high for low, high in pairs for rank in single)
    assert check_linkage(solved.by_hand("knee"))["apart"]["first"] == 0.0  # they lie on both sides as built


def test_without_layers_links_that_share_a_joint_are_drawn_apart():
    case = read_case("owl-wing-static").in_one_plane()
    assert not case.layered
    record = motion_linkage(solve_case_motion(case))
    steps = {link["name"]: (link["plates"] or [link["lines"]])[0]["rank"] for link in record["links"]}
    assert record["apart"]["first"] > 0.0
    for joint in case.joints.values():
        one, other = joint.links
        assert steps[one] != steps[other]


@pytest.mark.parametrize("name", MOVING)
def test_the_record_is_small(name):
    assert len(data_block(check_linkage(solved.by_hand(name)))) < 60_000
    assert len(data_block(motion_linkage(solve_case_motion(read_case(name))))) < 100_000


def test_colours_are_the_use_of_strength_up_to_the_limit_of_the_check():
    result = solved.by_hand("four-bar-synthesis")
    [values] = check_linkage(result)["values"]
    [case] = result.load_cases.values()
    for link, found in case.links.items():
        assert values["links"][link] == [
            pytest.approx(100.0 * found.decisive.value / result.case.material_of(link).allowable, rel=1e-3)
        ]
    assert values["top"] == pytest.approx(50.0)  # its check asks for a factor of 2
    assert values["beyond"] is False


def test_shades_are_bytes_of_shares():
    from alula.reports.turnable.pack import shades

    assert list(base64.b64decode(shades(np.array([[0.0, 0.5], [1.0, 7.0]])))) == [0, 128, 255, 255]
