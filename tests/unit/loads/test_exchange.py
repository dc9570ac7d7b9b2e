"""Linkages from pylinkage and PMKS+ become cases with the same pins, joints and forces."""

import json
import math
import os
import string
import tomllib
from pathlib import Path

import numpy as np
import programs
import pytest

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.exchange.pmks import read_pmks
from alula.loads.exchange.pylinkage import read_pylinkage
from alula.loads.exchange.sketch import case_text

DATA = Path(__file__).resolve().parents[2] / "data" / "exchange"
"""Written by pylinkage 1.3.0: ``fourbar(1, 3, 3, 4, initial_angle=0.7)``, ``slider_crank(1, 3, initial_angle=0.9)``;
those of PMKS+ are templates of its own (PMKS-Web/PMKSWeb, ``template-linkages.ts``)."""
FOUR_BAR, PUNCH, WATT = (
    (DATA / f"pmks-{name}.txt").read_text(encoding="utf-8").strip() for name in ("four-bar", "punch", "watt")
)


def whole(code: str, *changes: tuple[str, str]) -> str:
    """A link of PMKS+ with texts changed, whose last letter tells its length anew, as ``string-transcoder.ts`` does."""
    for old, new in changes:
        assert old in code
        code = code.replace(old, new)
    return code[:-1] + (string.digits + string.ascii_uppercase + string.ascii_lowercase)[len(code[:-1]) % 62]


def case_of(sketch):
    return validate(tomllib.loads(case_text(sketch)))


def test_a_four_bar_of_pylinkage_stands_where_its_pins_stand():
    data = json.loads((DATA / "pylinkage-four-bar.json").read_text(encoding="utf-8"))
    case = case_of(read_pylinkage(json.dumps(data), "four-bar.json", 25.4))
    pose = case.solve_pose()
    for joint in data["joints"]:
        place = pose.points[joint["id"].replace(".", "-").replace("_", "-")]
        assert list(place) == pytest.approx([25.4 * x for x in joint["position"]], abs=1e-9)
    assert (case.drive.link, pose.linkage.mobility) == ("crank", 1)
    lengths = {name: max(x for x, _ in case.links[name].points.values()) for name in ("crank", "coupler", "rocker")}
    assert lengths == pytest.approx({"crank": 25.4, "coupler": 76.2, "rocker": 76.2}, rel=1e-11)


def test_a_slider_crank_of_pylinkage_holds_its_force_by_virtual_work():
    case = case_of(
        read_pylinkage((DATA / "pylinkage-slider-crank.json").read_text(encoding="utf-8"), "slider.json", 10.0)
    )
    pose = case.solve_pose()
    assert pose.linkage.mobility == 1
    [load] = case.load_cases["load"].forces
    # The end of the rod slides along y = 2 mm, so that a force down does no work: no torque.
    assert list(load.force)[:2] == [0.0, -1.0]
    reactions = solve_case_statics(case, "slider").reactions["load"]
    assert reactions.drive_torque == pytest.approx(0.0, abs=1e-12)
    [guide] = [joint for name, joint in reactions.joints.items() if name.startswith("slide-")]
    assert abs(guide.force[1]) == pytest.approx(1.0, abs=1e-12)


def test_a_four_bar_of_pmks_stands_where_its_pins_stand():
    """Its joints in centimetres: 0mv is -(48 x 64 + 57)/1000."""
    pose = case_of(read_pmks(f"https://app.pmksplus.com/?{FOUR_BAR}", "link.txt")).solve_pose()
    expected = {"A": (-31.29, -20.14), "B": (-26.22, 9.02), "C": (30.09, 20.8), "D": (33.41, -16.46)}
    for name, place in expected.items():
        assert list(pose.points[name]) == pytest.approx(place, abs=1e-6), name


def test_pins_of_three_links_have_two_joints():
    case = case_of(read_pmks(WATT, "watt.txt"))
    assert case.solve_pose().linkage.mobility == 1
    assert set(case.joints) == set("ABCDEFG")
    assert {name for name, link in case.links.items() if not link.ground} == {"AB", "BCD", "DE", "EF", "FCG"}


def test_a_punch_of_pmks_presses_with_its_force():
    """In line with its crank the 400 N go straight through it: no torque, and 400 N in every pin.

    The direction of its guide is rounded to a thousandth of a radian.
    """
    case = case_of(read_pmks(PUNCH, "punch.txt"))
    [force] = case.load_cases["load"].forces
    assert (force.link, list(force.force)[:2]) == ("BC", [0.0, 400.0])
    reactions = solve_case_statics(case, "punch").reactions["load"]
    assert abs(reactions.drive_torque) < 400.0 * 1e-3 * abs(case.links["AB"].points["B"][0])
    assert {name: reactions.joints[name].magnitude for name in "AB"} == pytest.approx({"A": 400.0, "B": 400.0})
    assert math.hypot(*reactions.joints["slide-C"].force[:2]) < 0.4


def test_a_force_of_pmks_may_press_and_may_turn_with_its_link():
    """First the two flags: local, and outward, without which the arrow leads to where the force acts."""
    pressing = case_of(read_pmks(whole(PUNCH, (".2F1,", ".0F1,")), "punch.txt"))
    assert list(pressing.load_cases["load"].forces[0].force)[:2] == [0.0, -400.0]
    turning = case_of(read_pmks(whole(PUNCH, (".2F1,", ".3F1,")), "punch.txt"))
    [force] = turning.load_cases["load"].forces
    assert force.axes == "link"
    axes = turning.solve_pose().rotation("BC")
    assert axes @ np.array(list(force.force)[:2]) == pytest.approx([0.0, 400.0], abs=1e-3)
    old = whole(PUNCH, (".2F1,BC,", ".2F1,BCold,"), ("B,C,", "B,C,,BCold"))
    assert case_of(read_pmks(old, "punch.txt")).load_cases["load"].forces[0].link == "BC"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no whole link of PMKS"),
        (FOUR_BAR[:-9], "no whole link of PMKS"),
        ("x" * 62 + "0", "no link of PMKS"),
        (FOUR_BAR.replace(".MA,", ".KA,"), "the input has to be one pin on the ground"),
        (whole(PUNCH, (".LP,P,", ".HP,P,")), "joint P slides on a moving link"),
        (whole(PUNCH, (".GC,C,", ".OC,C,")), "pin C is welded to its block"),
        (whole(PUNCH, (".LP,P,", ".TP,P,")), "pin C is welded to its block"),
        (PUNCH.replace("0r8,0,0bW", "0r8,0,0r8"), "no link of PMKS"),  # a force without direction
        (whole(PUNCH, ("YRAB,Crank,VG,o,0,9O,c5cae9,A,B", "YRAB,Crank,VG,o,0,9O,c5cae9," + "A" * 9000)), "no link of"),
        (
            whole(PUNCH, (",A,B,,", ",A\x1b[2J,B,,"), ("MA,A,", "MA\x1b[2J,A,"), ("GB,", "MB,")),
            r"it is A\?\[2J, B; change it",
        ),
        (whole(PUNCH, ("YPCP,CP,1Tm,0,0,0,,C,P", "YPCP,CP,1Tm,0,0,0,,C,B\x1b")), "no link of PMKS"),
    ],
)
def test_what_is_no_mechanism_of_pmks_is_refused(text, words):
    with pytest.raises(CaseError, match=words) as told:
        read_pmks(text, "link.txt")
    assert str(told.value).isprintable()
    assert len(str(told.value)) < 400


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "no mechanism of pylinkage"),
        ("[1]", "no mechanism of pylinkage"),
        ('{"joints": [{"id": "A", "type": "Static"}], "links": []}', "older format"),
        ('{"joints": [], "links": []}', "no link has a motor"),
        ("[" * 100_000, "no mechanism of pylinkage"),
        (
            '{"joints": [{"id": "A\\n", "type": "ground", "position": [null, 0]}], "links": []}',
            r"joint 'A\?' has no position",
        ),
        ('{"joints": [], "links": [{"id": "c", "type": "link", "joints": ["' + "A" * 9000 + '"]}]}', "no mechanism of"),
        (
            '{"joints": [{"id": "A", "type": "ground", "position": [0, 0]}, {"id": "B", "type": "tracker", "position": '
            '[1, 0], "ref_joint1_id": "A", "ref_joint2_id": "B"}], "links": [{"id": "c", "type": "driver", "joints": '
            '["A"], "motor_joint": "A"}]}',
            "no mechanism of pylinkage",
        ),
    ],
)
def test_what_is_no_mechanism_of_pylinkage_is_refused(text, words):
    with pytest.raises(CaseError, match=words) as told:
        read_pylinkage(text, "mechanism.json", 1.0)
    assert str(told.value).isprintable()
    assert len(str(told.value)) < 400


def test_the_name_of_a_file_stays_a_name(tmp_path: Path) -> None:
    """It stands in a comment of the case, which a line break in it would end."""
    (tmp_path / "a\nschema_version = 7.txt").write_text(FOUR_BAR, encoding="utf-8")
    done = programs.inside("new", "--from-pmks", "a\nschema_version = 7.txt", "case.toml", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert tomllib.loads((tmp_path / "case.toml").read_text(encoding="utf-8"))["schema_version"] == 1


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("nowhere.json", "there is no such file"),
        ("bytes.json", "it is not UTF-8 text"),
        ("bad.json", "no mechanism of pylinkage"),
        ("large.json", "larger than 1 MiB"),
        (os.devnull, "it is no regular file"),  # a reader of /dev/zero would never end
    ],
)
def test_a_file_that_is_none_ends_in_one_sentence(name: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "bytes.json").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "bad.json").write_text('{"joints": 3}', encoding="utf-8")
    (tmp_path / "large.json").write_bytes((DATA / "pylinkage-four-bar.json").read_bytes() + b" " * 2**20)
    done = programs.inside("new", "--from-pylinkage", name, "case.toml", folder=tmp_path)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert words in done.stderr
    assert not (tmp_path / "case.toml").exists()
