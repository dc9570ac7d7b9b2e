"""What the workbench answers to a text says the same as commands do, and is plain data."""

import json
import math
import tomllib

import numpy as np
import programs
import pytest
import solved

from alula.fea.findings.of_check import with_findings
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import read_case, read_text
from alula.reports.check.changes import change_records
from alula.reports.commands.statics import statics_sections
from alula.reports.sentences.verdicts import first_lines
from alula.reports.workbench.editing.document import Document
from alula.reports.workbench.editing.edits import EMPTY
from alula.reports.workbench.live import verdicts
from alula.reports.workbench.live.answers import motion_answer, pose_answer
from alula.reports.workbench.live.verdicts import whole_answer


def posed(name, *pairs):
    text, _ = read_text(name)
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    found = pose_answer(text, name)
    return json.loads(json.dumps(found, allow_nan=False))


def test_no_link_in_the_folder_leads_out_of_it(tmp_path):
    """A level file names the files of its profiles itself, so that they are refused where they are read."""
    home, entries = tmp_path / "home", programs.ROOT / "docs/examples/entries"
    home.mkdir()
    stated, begun, tests = (entries / "level.toml").read_text(encoding="utf-8").partition("[level.tests.")
    in_file = ("standard", "name", "condition", "source", "read_from")
    text = "\n".join(line for line in stated.splitlines() if line.partition(" ")[0] not in in_file)
    text = text.replace("[level]", '[level]\nfile = "level.toml"')
    (home / "level.toml").write_text(
        'standard = "x"\nname = "x"\nsource = "x"\n' + (begun + tests).replace("[level.tests", "[tests")
    )
    (home / "heel-to-toe.csv").symlink_to(entries / "heel-to-toe.csv")
    assert "heel-to-toe.csv' is not in the folder" in pose_answer(text, str(home / "mine.toml"))["problem"]
    (home / "heel-to-toe.csv").unlink()
    (home / "heel-to-toe.csv").write_bytes((entries / "heel-to-toe.csv").read_bytes())
    assert pose_answer(text, str(home / "mine.toml"))["problem"] is None


@pytest.mark.parametrize("name", ["owl-wing-static", "four-bar", "knee"])
def test_forces_are_those_of_alula_statics(name):
    answer, case = posed(name), read_case(name)
    pose, told, _ = statics_sections(solve_case_statics(case, name), matrix=False)
    assert answer["problem"] is None
    assert list(answer["forces"]) == answer["drawn"]["load_cases"] == list(told.data["load_cases"])
    for load_case, record in told.data["load_cases"].items():
        found = answer["forces"][load_case]
        for one in record["reactions"]:
            joint = found["joints"][one["joint"]]
            assert (joint["force"], joint["on"], joint["magnitude"]) == (one["force"], one["on"], one["magnitude"])
        assert (found["drive"] or {"torque": 0.0})["torque"] == record["drive_torque"]  # a stop holds the knee
    for link in answer["drawn"]["links"]:
        assert link["angle"] % 360.0 == pytest.approx(pose.data["pose"]["angles"][link["name"]])


def test_links_are_drawn_as_wide_as_their_parts():
    links = {link["name"]: link for link in posed("four-bar")["drawn"]["links"]}
    outline = np.array(links["crank"]["outline"])
    eye = 1.6 * 8.0 / 2.0
    assert outline.min(axis=0) == pytest.approx([-eye, -eye], abs=0.05)
    assert outline.max(axis=0) == pytest.approx([40.0 + eye, eye], abs=0.05)
    assert (links["crank"]["width"], links["base"]["outline"]) == (8.0, None)
    turn, (x, y) = math.radians(links["rocker"]["angle"]), links["rocker"]["origin"]
    end = next(point for point in links["rocker"]["points"] if point["name"] == "P")
    assert end["at"] == pytest.approx([x + 120.0 * math.cos(turn), y + 120.0 * math.sin(turn)])


def test_loads_have_the_path_of_their_entry():
    loads = {load["kind"]: load for load in posed("four-bar")["drawn"]["loads"]}
    assert loads["force"]["path"] == ["load_cases", "lift", "forces", 0]
    assert loads["force"]["vector"] == [0.0, -5.0]
    assert loads["weight"]["vector"][1] < 0.0
    turned = posed("four-bar", ('force = ["0 N", "-5 N"]', 'force = ["0 N", "-5 N"]\naxes = "link"'))["drawn"]
    [force] = [load for load in turned["loads"] if load["kind"] == "force"]
    along = math.radians(next(link["angle"] for link in turned["links"] if link["name"] == "rocker"))
    assert force["vector"] == pytest.approx([5.0 * math.sin(along), -5.0 * math.cos(along)])


LINE = """
[[load_cases.lift.load_lines]]
from = ["150 mm", "200 mm"]
to = ["90 mm", "120 mm"]
force = "10 N"
link = "rocker"
at = "P"
leaves = { link = "coupler", at = "Q" }
"""


def test_both_ends_of_a_load_line_have_the_path_of_its_entry_and_stand_beside_the_links():
    toml = ("[links.coupler]\n", '[links.coupler]\npoints.Q = ["60 mm", "0 mm"]\n')
    answer = posed("four-bar", toml, ("[drive]\n", LINE + "[drive]\n"))
    assert answer["problem"] is None
    entering, leaving = (load for load in answer["drawn"]["loads"] if load["kind"] == "load line")
    for load, link, sense, at in ((entering, "rocker", 1.0, [150.0, 200.0]), (leaving, "coupler", -1.0, [90.0, 120.0])):
        assert (load["path"], load["link"]) == (["load_cases", "lift", "load_lines", 0], link)
        assert (load["at"], load["moment"], load["point"]) == (at, 0.0, None), "not at a point, where the page puts it"
        assert load["vector"] == pytest.approx([-6.0 * sense, -8.0 * sense])
        points = next(one for one in answer["drawn"]["links"] if one["name"] == link)["points"]
        enters = next(one["at"] for one in points if one["name"] == ("P" if link == "rocker" else "Q"))
        assert load["newtons"] == pytest.approx(10.0)
        assert load["line"] == [[150.0, 200.0], [90.0, 120.0]]
        assert load["lever"] == [at, pytest.approx(enters)], "from its end of the line to the point it enters at"


def test_what_balances_by_itself_is_drawn_where_it_stands():
    answer = posed("spring-pedal")
    case = read_case("spring-pedal")
    stands = solve_case_statics(case, "spring-pedal").pose
    pedal = next(link for link in answer["drawn"]["links"] if link["name"] == "pedal")
    assert pedal["angle"] == pytest.approx(math.degrees(stands.angles["pedal"]))
    assert pedal["angle"] != pytest.approx(math.degrees(case.stated_pose.angles["pedal"]), abs=0.1)
    assert {spring["kind"] for spring in answer["drawn"]["springs"]} == {"coil", "wall"}


@pytest.mark.parametrize(
    ("there", "instead", "told"),
    [
        ("[drive]", "[drive]", "load_cases: this entry is missing"),
        (
            '[links.coupler]\npart = "bar"',
            "[links.coupler]",
            "load_cases: this entry is missing",
        ),  # no weight is asked for
        ('joint = "O2"', 'joint = "O9"', "drive.joint: 'O9'"),
        ('coordinate = "crank"', 'coordinate = "crankk"', "pose.coordinate: 'crankk'"),
        ('points.B = ["120 mm"', 'points.B = ["320 mm"', "pose: the linkage cannot be assembled"),
        ('width = "8 mm"', 'widht = "8 mm"', "parts.bar.widht: this key is unknown"),
    ],
)
def test_what_is_wrong_is_told_before_there_is_a_load(there, instead, told):
    text = read_text("four-bar")[0]
    loads = text[text.index("[load_cases.lift]") : text.index("# The checks that")]
    answer = posed("four-bar", (loads, ""), (there, instead))
    assert answer["problem"].startswith(told)
    assert answer["drawn"]["links"]


def test_a_problem_is_one_sentence_and_what_can_be_is_drawn():
    open_loop = posed("four-bar", ('points.B = ["120 mm"', 'points.B = ["320 mm"'))
    assert open_loop["problem"].startswith("pose: the linkage cannot be assembled")
    assert open_loop["forces"] == {}
    links = {link["name"]: link for link in open_loop["drawn"]["links"]}
    assert [links[link]["angle"] for link in ("crank", "coupler", "rocker")] == pytest.approx([40.0, 20.0, 57.0])
    assert np.ptp(links["coupler"]["outline"], axis=0)[0] == pytest.approx(320.0 + 1.6 * 8.0, abs=0.1)
    assert links["coupler"]["origin"] == pytest.approx(links["crank"]["points"][1]["at"])
    assert [load["path"] for load in open_loop["drawn"]["loads"]] == [["load_cases", "lift", "forces", 0]]
    held = posed("four-bar", ("[drive]\n", "[drive]\ntransfer = 5\n"))
    assert held["problem"].startswith("drive.transfer")
    assert {link["name"] for link in held["drawn"]["links"]} == {"base", "crank", "coupler", "rocker"}
    nothing = posed("four-bar", ("schema_version = 1", "schema_version ="))
    assert nothing["problem"].startswith("case: this is not valid TOML")
    assert nothing["drawn"] is None
    assert posed("four-bar", ("schema_version = 1", "links = 5\nschema_version = 1"))["drawn"] is None


def known(value):
    return value if math.isfinite(value) else None


def here(text):
    """Return a sentence as the page has it: the button's name stands for the option."""
    return text.replace("--fidelity solid", "'Check with solids'")


@pytest.mark.parametrize("name", ["four-bar", "knee"])
def test_the_whole_verdict_is_that_of_alula_check(name):
    result, early = solved.by_hand(name), []
    answer = whole_answer(read_text(name)[0], name, early.append)
    told = with_findings(result)
    assert answer["verdict"] == result.verdict
    first, *rest = map(here, first_lines(told))
    *uncalibrated, shown = answer["sentences"][: -len(rest)]
    assert answer["sentences"][-len(rest) :] == rest
    assert all(one.startswith("Hand calculation is not calibrated") for one in uncalibrated)
    why = next(one["text"] for one in answer["checks"])
    assert first.startswith(shown)
    assert (first == shown) == (answer["verdict"] != "undecided")
    assert first == shown or first.lower().endswith(why.lower()), "its reason stands beside the check that decides"
    assert "--fidelity" not in "".join([*answer["sentences"], *(one["text"] for one in answer["checks"])])
    checks = {(one["check"], one["subject"], one["load_case"], one["quantity"]): one for one in answer["checks"]}
    assert len(checks) == sum(len(one.checks) for one in result.load_cases.values())
    for load_case, one in result.load_cases.items():
        for check in one.checks:
            found = checks[check.name, str(check.subject), load_case, check.quantity]
            assert (found["value"], found["low"], found["high"], found["verdict"]) == (
                *map(known, (check.value.value, check.value.low, check.value.high)),
                check.answer,
            )
    for link, one in answer["links"].items():
        kinds = ("safety", "plastic-collapse")
        own = [c for c in checks.values() if c["subject"] == link and c["quantity"].startswith(kinds)]
        if any("not calibrated" in c["text"] for c in own):
            assert one["use"][1] is None, "a number without band tells no upper end"
            continue
        factors = [c for c in own if c["low"]]
        assert one["use"][1] == pytest.approx(max(c["limit"] / c["low"] for c in factors))
        assert one["use"][0] == pytest.approx(max(c["limit"] / c["high"] for c in factors if c["high"]))
    [soon] = early
    assert (soon["changes"], soon["checks"], soon["links"]) == (None, answer["checks"], answer["links"])
    records = {here(f"{one['title']}: {' '.join(one['sentences'])}"): one["command"] for one in change_records(told)}
    for text, command in records.items():
        reasons = [check["text"] for check in answer["checks"] if text.endswith(check["text"])]
        listed = any(one["text"][1:] == text[1:] and one["command"] == command for one in answer["changes"])
        assert listed or reasons, "what a check says of itself is not said twice"
    json.dumps(answer, allow_nan=False)


def test_motion_has_the_places_of_its_poses():
    case, motion = read_case("four-bar"), motion_answer(read_text("four-bar")[0], "four-bar")
    assert (motion["range"], motion["unit"], motion["turns"], motion["problem"]) == ([40.0, 400.0], "deg", True, None)
    turned = case.with_values({"pose.angle": f"{motion['values'][30]} deg"})
    at = turned.stated_pose.position("rocker", "P")
    assert motion["points"]["rocker.P"][30] == pytest.approx(at.tolist(), abs=1e-3)
    assert motion["points"]["crank.A"][0] == motion["points"]["crank.A"][-1]
    assert len(motion["angles"]["coupler"]) == len(motion["values"]) == 361


def test_the_pose_of_an_instant_is_told_where_the_motion_prescribes_another_link():
    text = read_text("four-bar")[0]
    other = 'coordinate = "rocker"\nrange = ["55 deg", "70 deg"]'
    motion = motion_answer(text.replace("turn = true", other), "four-bar")
    for k in (0, 200):
        pose = read_case("four-bar").with_values({"pose.angle": f"{motion['pose'][k]} deg"}).stated_pose
        assert math.degrees(pose.angles["rocker"]) == pytest.approx(motion["values"][k], abs=1e-9)
        assert motion["points"]["rocker.P"][k] == pytest.approx(pose.position("rocker", "P").tolist(), abs=1e-3)
    assert motion_answer(text, "four-bar")["pose"] is None, "it is the motion's own"


def test_motion_goes_as_far_as_the_linkage_does():
    text = read_text("four-bar")[0]
    for old, new in (
        ("turn = true", 'range = ["-180 deg", "180 deg"]'),
        ('points.A = ["40 mm"', 'points.A = ["120 mm"'),
        ('coupler = "20 deg", rocker = "57 deg"', 'coupler = "-60 deg", rocker = "60 deg"'),
    ):
        assert old in text
        text = text.replace(old, new)
    motion = motion_answer(text, "four-bar")
    # Coupler and rocker, 120 and 80 mm, are in line where the crank's pin is 200 or 40 mm from O4.
    ends = [math.degrees(math.acos((120.0**2 + 100.0**2 - far**2) / (2.0 * 120.0 * 100.0))) for far in (40.0, 200.0)]
    assert motion["dead"] == pytest.approx(ends, abs=1e-6)
    assert ends[0] < motion["range"][0] < ends[0] + 1.1
    assert ends[1] - 1.1 < motion["range"][1] < ends[1]
    assert "dead point" in motion["problem"]
    assert not motion["turns"]
    none = motion_answer(text.replace("[motion]", "").replace('range = ["-180 deg", "180 deg"]', ""), "four-bar")
    assert none["problem"].startswith("motion: the case states none")
    assert none["offer"] == {"range": [f"{math.ceil(motion['range'][0])} deg", f"{math.floor(motion['range'][1])} deg"]}
    turns = motion_answer(read_text("four-bar")[0].replace("[motion]\nturn = true", ""), "four-bar")
    assert turns["offer"] == {"turn": True}


DRAWN = EMPTY.replace(
    "[joints]\n\n[pose]\n",
    """\
[links.crank]
part = "bar"
points.O2 = ["0 mm", "0 mm"]
points.A = ["32 mm", "0 mm"]
[links.coupler]
part = "bar"
points.A = ["0 mm", "0 mm"]
points.B = ["81 mm", "0 mm"]
points.P = ["40 mm", "0 mm"]
[links.rocker]
part = "bar"
points.B = ["0 mm", "0 mm"]
points.O4 = ["46 mm", "0 mm"]
[joints]
O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
A = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
O4 = { links = ["base", "rocker"], pin_diameter = "3 mm" }
[pose]
coordinate = "crank"
angle = "72 deg"
near = { coupler = "11 deg", rocker = "-77 deg" }
[drive]
link = "crank"
joint = "O2"
[load_cases.load]
forces = [{ link = "coupler", at = "P", force = ["0 N", "-300 N"] }]
""",
)
"""A four-bar as it is drawn from nothing: its coupler fails, and its crank is too short for a wider bar."""


def pressed(text, change):
    """Return a text after what a change offers was set by its button."""
    document = Document(text)
    document.apply(change["operations"], None)
    return document.text


def test_a_section_that_passes_is_offered_with_all_that_has_to_follow_it():
    """The part is shared with a crank that is too short for it, so the link gets one of its own, with wider pins."""
    answer = whole_answer(DRAWN, "drawn")
    assert answer["verdict"] == "fail"
    offer = answer["changes"][0]
    assert offer["text"].startswith("It passes with a part of its own for coupler, bar-2: width of bar-2 ")
    assert "pin diameter of A" in offer["text"]
    assert "end patch of coupler" in offer["text"]
    text = pressed(DRAWN, offer)
    assert whole_answer(text, "drawn")["verdict"] == "pass"
    tables = tomllib.loads(text)
    assert [tables["links"][link]["part"] for link in ("crank", "coupler", "rocker")] == ["bar", "bar-2", "bar"]
    assert tables["parts"]["bar"] == tomllib.loads(DRAWN)["parts"]["bar"]


def test_a_part_of_its_own_is_tried_beside_the_file_of_the_case(monkeypatch):
    """Where parts from files and tables are sought: by the path of the case, not by the name of the part."""
    names, read = [], verdicts.case_of
    monkeypatch.setattr(verdicts, "case_of", lambda text, name: names.append(name) or read(text, name))
    whole_answer(DRAWN, "folder/drawn.toml")
    assert set(names) == {"folder/drawn.toml"}


def test_a_link_that_is_no_bar_decides_and_no_section_is_offered():
    """Its part is a file: what is reported of it is told alone."""
    answer = whole_answer(read_text("step")[0], "step")
    assert answer["changes"]
    assert not any(one["operations"] for one in answer["changes"])


def test_all_that_hand_calculation_is_not_calibrated_for_is_told_at_once_and_mended_by_one_press():
    text = DRAWN.replace('width = "6 mm"', 'width = "8 mm"').replace('"5 mm"', '"3 mm"').replace('"1.5 mm"', '"0.5 mm"')
    answer = whole_answer(text, "drawn")
    wrong = next(one["text"] for one in answer["checks"] if "not calibrated" in one["text"] and "patch" in one["text"])
    for limit in ("fillet over width 0.0625", "thickness over width 0.375", "patch over width 0.625"):
        assert f"its {limit} is outside the calibrated range" in wrong
    offer = answer["changes"][0]
    assert offer["text"].startswith("Hand calculation is calibrated for links of part bar with: ")
    mended = whole_answer(pressed(text, offer), "drawn")
    assert not any("not calibrated" in one["text"] for one in mended["checks"])


THIN = DRAWN.replace('thickness = "5 mm"', 'thickness = "2 mm"').replace("-300 N", "-20 N")
"""One whose bars are too thin for hand calculation: no number of their strength has a band."""


def test_what_hand_calculation_is_not_calibrated_for_is_said_first_and_its_use_of_strength_has_no_upper_end():
    assert THIN.count("2 mm") > DRAWN.count("2 mm")
    answer = whole_answer(THIN, "drawn")
    assert answer["verdict"] == "undecided"
    first = (
        "Hand calculation is not calibrated for links of part bar: it would be with thickness of bar 2.4 mm (now 2 mm)."
    )
    assert answer["sentences"][0] == first
    assert [one["use"][1] for one in answer["links"].values()] == [None, None, None]
    reasons = [one["text"] for one in answer["checks"] if one["verdict"] == "undecided"]
    told = [*answer["sentences"], *(one["text"] for one in answer["changes"])]
    assert not any(reason.lower() in one.lower() for reason in reasons for one in told), "they stand beside the checks"
    mended = whole_answer(pressed(THIN, answer["changes"][0]), "drawn")
    assert "not calibrated" not in mended["sentences"][0]
    assert all(low <= high for low, high in (one["use"] for one in mended["links"].values()))


def test_where_no_section_passes_that_is_said():
    answer = whole_answer(DRAWN.replace("-300 N", "-3000 N"), "drawn")
    assert answer["verdict"] == "fail"
    assert answer["changes"][0] == {
        "text": "No section that was tried passes by hand.",
        "command": None,
        "operations": None,
    }
    assert not any(one["operations"] for one in answer["changes"])
    passed = whole_answer(DRAWN.replace("-300 N", "-3 N"), "drawn")
    assert (passed["verdict"], [one for one in passed["changes"] if "No section" in one["text"]]) == ("pass", [])
