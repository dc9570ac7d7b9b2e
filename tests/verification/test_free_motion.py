"""Free motion by play at the rims of holes: closed forms of a lever, and rigid four-bars by linear programming."""

import math
import tomllib
from typing import Any

import numpy as np
import pytest
from tilting_pins import LOOSE, TIGHT, checked, four_bar, place_of, rigid_motion

from alula.fea.check.run import check_case
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.outcomes.free_motion import FreeMotion, free_motion
from alula.fea.standing.joint_forces import solved_frame
from alula.loads.case.case import Case
from alula.reports.sentences import told

LIMIT = {"type": "displacement", "at": "P", "maximum": "2 mm"}
LEVER = """
schema_version = 1
title = "lever beside its ground"
links.base = { ground = true, z = "0 mm", points = { O = ["0 mm", "0 mm"], R = ["9 mm", "0 mm"] } }
links.arm = { part = "bar", z = "7 mm", points = { O = ["0 mm", "0 mm"], P = ["60 mm", "0 mm"] } }
joints.O = { links = ["base", "arm"], pin_diameter = "3 mm", clearance = "0.2 mm" }
pose = { coordinate = "arm", angle = "0 deg" }
drive = { link = "arm", joint = "O" }
load_cases.tip = { forces = [{ link = "arm", at = "P", force = ["0 N", "-2 N"] }] }
parts.bar = { shape = "bar", material = "pvc-paredes-2018", width = "8 mm", thickness = "4 mm", fillet_radius = "2 mm" }
"""


HEADS = {"diameter": "5 mm", "gap": ["0 mm", "0.1 mm"]}


def lever(**entries: Any) -> Case:
    """A lever 7 mm above its ground, with a play of 0.2 mm and a part of 4 mm."""
    data = tomllib.loads(LEVER)
    data["joints"]["O"] |= {k: v for k, v in entries.items() if k == "tight_in"}
    data["joints"]["O"] |= {k: v for k, v in entries.items() if k == "heads"}
    data["links"]["base"] |= {k: v for k, v in entries.items() if k == "thickness"}
    return checked(data)


def free(case: Case, link: str, point: str) -> FreeMotion:
    frame, _ = solved_frame(case, case.solve_pose(), (), case.pinned_drive)
    return free_motion(case, frame, link, point)


@pytest.mark.parametrize(
    ("entries", "plane", "across"),
    [
        ({"tight_in": "base"}, 0.1, 0.2 / 4.0 * 60.0),  # the hole of the arm, 4 mm long, about its own mid-plane
        ({"tight_in": "arm", "thickness": "8 mm"}, 0.2 / 8.0 * 7.0, 0.2 / 8.0 * 60.0),  # 7 mm above that of the base
        ({"tight_in": "arm", "thickness": "20 mm"}, 0.1, 0.2 / 20.0 * 60.0),
        ({"tight_in": "arm"}, 0.2 / 4.0 * 7.0, 0.2 / 4.0 * 60.0),  # as long as that of the arm
        ({"thickness": "8 mm"}, 0.2 / 8.0 * 7.0, 0.2 / 4.0 * 60.0),  # either: each direction has its worst
        ({"tight_in": "base", "heads": HEADS}, 0.1, 0.1 / 5.0 * 60.0),
        ({"tight_in": "arm", "thickness": "20 mm", "heads": HEADS}, 0.1, 0.2 / 20.0 * 60.0),  # rims touch first
        ({"tight_in": "arm", "thickness": "8 mm", "heads": HEADS}, 0.1 + 0.1 / 5.0 * 3.0, 0.1 / 5.0 * 60.0),
    ],
)
def test_a_lever_tilts_by_its_play_over_the_length_of_the_hole(entries, plane, across):
    """Along the arm by c/2, or c h/t where the hole is in the ground; across by c/t times the length of the arm.

    Between heads by g/D in place of c/t, and along it about the upper rim, 4 mm above the ground: by c/2 and 3 g/D.
    """
    found = free(lever(**entries), "arm", "P")
    along = found.plane.support(np.array([1.0 + 0j, -1.0 + 0j]))
    assert along == pytest.approx([plane, plane], rel=1e-9)
    assert found.across == pytest.approx(across, rel=1e-9)


@pytest.mark.parametrize(
    ("loose", "tilt"),
    [(LOOSE, None), (TIGHT, None), ({**LOOSE, "A": "crank", "O4": "rocker"}, None), (LOOSE, 0.01), (TIGHT, 0.001)],
)
def test_rigid_links_stay_within_the_free_motion_and_fill_most_of_it(loose, tilt):
    """Forces of the elastic frame are one equilibrium of many, so that their sum bounds that of rigid links."""
    both = {name: {LOOSE[name], TIGHT[name]} for name in LOOSE}
    tight = {name: next(iter(both[name] - {link})) for name, link in loose.items()}
    data = four_bar(tight=tight, play="0.1 mm")
    for joint in data["joints"].values() if tilt else ():
        joint["heads"] = {"diameter": "5 mm", "gap": f"{5.0 * tilt} mm"}
    case = checked(data)
    for point in ("P", "B"):
        found, where = free(case, "rocker", point), place_of(case, "rocker", point)
        rigid = [
            rigid_motion(
                case, "rocker", where, np.array(along), holes=loose, play=0.1, length=4.0, tilt=tilt or math.inf
            )
            for along in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, 1.0])
        ]
        bound = [*found.plane.support(np.array([1.0, 1j, 0.6 - 0.8j])), found.across]
        for least, most in zip(rigid, bound, strict=True):
            assert least <= most * (1.0 + 2e-3)  # polygons about circles are larger by 0.12 %
            assert most < 1.5 * least


def test_holes_of_either_link_are_no_better_than_the_worse_of_them():
    either = free(checked(four_bar(tight={}, play="0.1 mm")), "rocker", "P")
    for tight in (TIGHT, LOOSE):
        one = free(checked(four_bar(tight=tight, play="0.1 mm")), "rocker", "P")
        assert one.across <= either.across * (1.0 + 1e-9)
        assert one.plane.largest() <= either.plane.largest() * (1.0 + 1e-9)


def displacement(**entries: Any) -> CheckOutcome:
    case = checked(four_bar(checks={"d": LIMIT}, **entries))
    [found] = [one for one in check_case(case, fidelity="beam").load_cases["l"].checks if one.name == "d"]
    return found


def test_the_band_of_a_point_holds_what_its_pins_do():
    """A frame of its own, with both rims of every hole in their circles, moves P by this more than with tight pins."""
    plain, found = displacement(), displacement(play="0.1 mm")
    assert plain.verdict is Verdict.PASS
    known = math.hypot(0.689 + 0.103, 0.564 + 0.071, 2.587 + 0.167)  # tight: (0.103, -0.071, 0.167) mm
    assert found.value.low <= known <= found.value.high < 2.0 * known
    assert found.verdict is Verdict.FAIL  # even where the pins stand best
    assert "by up to 4.35 mm across it; without play the verdict would be pass" in told(found.reason)
    assert "the holes of base are taken to be as long as the shortest of the others, 4 mm" in told(found.reason)
    assert displacement(play="0.01 mm").verdict is Verdict.PASS
