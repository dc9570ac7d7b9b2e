"""Operations of the drawing on built-in cases: what is moved, drawn, renamed and removed, and all that follows it."""

import math
from importlib.resources import files
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize
from solved import ALIKE, by_hand

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, changed_tables, folder_of, read_case, validate
from alula.reports.workbench.editing.document import Document
from alula.reports.workbench.editing.edits import EMPTY
from alula.reports.workbench.editing.plane import Plane
from alula.reports.workbench.editing.references import BY_KEY, BY_VALUE, NAMED, references

CASES = [name for name in built_in_cases() if name not in ALIKE]


def opened(name: str) -> Document:
    return Document(files("alula.loads.cases").joinpath(f"{name}.toml").read_text(encoding="utf-8"))


def stated(document: Document, name: str) -> Case:
    return validate(changed_tables(document.tables(), ()), folder_of(name))


def pin(case: Case, joint: str) -> tuple[str, str]:
    """Link and point of what is dragged at a joint: the pin, not the slot."""
    side = int(case.joints[joint].slides)
    return case.joints[joint].links[side], case.linkage.joint_points(joint)[side]


def in_line(case: Case) -> set[str]:
    """Joints that give way: those of bars and tubes with three or more on the axis, and all that slide."""
    found: set[str] = {name for name, joint in case.joints.items() if joint.slides or joint.links[1] in case.massless}
    for link in case.checked_links:
        own = [j for j in case.linkage.joints_of(link) if case.linkage.point_of(j, link) not in case.links[link].arms]
        places = {case.linkage.point_of(j, link) for j in own}
        found |= set(own) if len(places) > 2 else set()
    return found


@pytest.mark.parametrize("name", CASES)
def test_a_dragged_joint_stands_where_it_was_put_and_the_others_where_they_were(name: str) -> None:
    case = read_case(name)
    pose, give = case.solve_pose(), in_line(case)
    step = pose.linkage.longest / 100.0 * np.array([1.2, 0.7])
    moved = 0
    for joint in case.joints:
        document, to = opened(name), pose.position(*pin(case, joint)) + step
        try:
            document.apply([{"op": "move", "joint": joint, "to": to.tolist()}], pose)
            new = stated(document, name).solve_pose()
        except CaseError as refused:
            told = str(refused)
            assert any(word in told for word in ("come from the file", "ornithopter sets", "put the crank's"))
            continue
        moved += 1
        assert joint in give or new.position(*pin(case, joint)) == pytest.approx(to, abs=1e-7 * pose.linkage.longest)
        for other in set(case.joints) - give - {joint}:
            at = pose.position(*pin(case, other))
            assert new.position(*pin(case, other)) == pytest.approx(at, abs=1e-7 * pose.linkage.longest), (joint, other)
        assert {k: v for k, v in document.tables().items() if k not in ("links", "pose")} == {
            k: v for k, v in opened(name).tables().items() if k not in ("links", "pose")
        }
    assert moved or name in ("ornithopter", "pylon")


def test_joints_in_line_give_way_by_about_the_least() -> None:
    case = read_case("owl-wing-static")
    pose, document = case.solve_pose(), opened("owl-wing-static")
    names = "BCEF"
    start = np.array([pose.position(*pin(case, joint)) for joint in names])
    to = start[0] + np.array([1.2, 0.7])
    document.apply([{"op": "move", "joint": "B", "to": to.tolist()}], pose)
    new = stated(document, "owl-wing-static").solve_pose()
    found = np.array([new.position(*pin(case, joint)) for joint in names])

    def off(x: Any) -> Any:
        (c, e, f), a = x.reshape(3, 2), pose.position("AG", "A")
        return [np.linalg.det([to - a, e - a]) / 100.0, np.linalg.det([to - f, c - f]) / 100.0]

    least = minimize(
        lambda x: np.sum((x - start[1:].ravel()) ** 2), start[1:].ravel(), constraints={"type": "eq", "fun": off}
    )
    assert found[0] == pytest.approx(to, abs=1e-5)
    assert np.sum((found[1:] - start[1:]) ** 2) == pytest.approx(least.fun, rel=0.02)


def test_a_drag_in_steps_follows_although_the_pose_shown_is_of_an_earlier_step() -> None:
    case = read_case("four-bar")
    pose, document = case.solve_pose(), opened("four-bar")
    for n in range(1, 11):
        to = pose.position("coupler", "B") + np.array([1.0, -0.5]) * n
        document.apply([{"op": "move", "joint": "B", "to": to.tolist()}], pose, "drag")
    new = stated(document, "four-bar").solve_pose()
    assert new.position("coupler", "B") == pytest.approx(to, abs=1e-5)
    assert new.position("crank", "A") == pytest.approx(pose.position("crank", "A"), abs=1e-5)
    document.undo()
    assert document.text == opened("four-bar").text


def test_a_drag_after_a_turn_that_the_pose_shown_does_not_have_yet() -> None:
    pose, document = read_case("four-bar").solve_pose(), opened("four-bar")
    document.apply([{"op": "turn", "to": 60}], pose)
    document.apply([{"op": "move", "joint": "B", "to": [130.0, 80.0]}], pose)
    new = stated(document, "four-bar").solve_pose()
    assert new.position("crank", "A") == pytest.approx([20.0, 40.0 * math.sin(math.pi / 3.0)], abs=1e-5)
    assert new.position("coupler", "B") == pytest.approx([130.0, 80.0], abs=1e-5)


def test_points_without_joint_keep_their_distance_and_slide_along_a_bar() -> None:
    case = read_case("four-bar")
    pose, document = case.solve_pose(), opened("four-bar")
    document.apply([{"op": "move", "joint": "O4", "to": [90.0, 0.0]}], pose)
    points = {name: at[0] for name, at in stated(document, "four-bar").links["rocker"].points.items()}
    assert points["O4"] == 0.0
    assert points["P"] - points["B"] == pytest.approx(40.0, abs=1e-6)
    document = opened("four-bar")
    along = pose.rotation("rocker") @ (130.0, 7.0) + pose.origins["rocker"]
    document.apply([{"op": "move", "link": "rocker", "point": "P", "to": along.tolist()}], pose)
    assert document.tables()["links"]["rocker"]["points"]["P"] == ["130 mm", "0 mm"]


def test_the_origin_of_a_plate_stays_its_origin() -> None:
    case = read_case("finger")
    pose, document = case.solve_pose(), opened("finger")
    to = pose.position("distal", "D") + np.array([2.0, 1.0])
    document.apply([{"op": "move", "joint": "D", "to": to.tolist()}], pose)
    new = stated(document, "finger")
    assert new.links["distal"].points["D"] == (0.0, 0.0)
    assert new.solve_pose().position("distal", "T") == pytest.approx(pose.position("distal", "T"), abs=1e-5)


def test_slots_and_holes_move_with_the_origin_of_their_link() -> None:
    case = read_case("owl-wing-static")
    pose, document = case.solve_pose(), opened("owl-wing-static")
    to = pose.position("CH", "C") - 3.0 * pose.rotation("CH")[:, 0]  # away from D, along CH
    document.apply([{"op": "move", "joint": "C", "to": to.tolist()}], pose)
    link = stated(document, "owl-wing-static").links["CH"]
    assert link.points["C"] == (0.0, 0.0)
    shift = link.points["D"][0] - 77.0
    assert shift == pytest.approx(3.0, abs=0.3)  # D gives way a little, in line with its own links
    assert link.points["H"][0] == pytest.approx(124.0 + shift, abs=1e-6)
    assert link.holes[0].first == pytest.approx(10.0 + shift, abs=1e-6)


def test_what_is_welded_on_keeps_its_places_and_its_angle_follows() -> None:
    document = opened("four-bar")
    weld = (
        'W = { links = ["rocker", "arm"], points = ["P", "P"], bonded = true, angle = "5 deg", pin_diameter = "3 mm" }'
    )
    arm = 'massless = ["arm"]\n[links.arm]\npoints = { P = ["0 mm", "0 mm"], Q = ["9 mm", "40 mm"] }\n\n[links.base]'
    document.replace(document.text.replace("[joints]", f"[joints]\n{weld}").replace("[links.base]", arm))
    pose = stated(document, "four-bar").solve_pose()
    to = pose.position("rocker", "P") + np.array([3.0, 4.0])
    document.apply([{"op": "move", "joint": "W", "to": to.tolist()}], pose)
    new = stated(document, "four-bar").solve_pose()
    assert new.position("rocker", "P") == pytest.approx(to, abs=1e-5)
    assert new.position("arm", "Q") == pytest.approx(pose.position("arm", "Q"), abs=1e-5)
    assert new.angles["arm"] == pytest.approx(pose.angles["arm"], abs=1e-8)
    assert abs(new.angles["rocker"] - pose.angles["rocker"]) > 1e-3


def test_a_pin_in_slots_is_moved_along_its_guide() -> None:
    text = opened("ornithopter").text
    document = Document(
        text[: text.index("[ornithopter]")] + text[text.index("# ---- links") : text.index("[checks.motor]")]
    )
    pose = stated(document, "ornithopter").solve_pose()
    document.apply([{"op": "move", "joint": "guide", "to": [0.5, 13.2]}], pose)
    new = stated(document, "ornithopter").solve_pose()
    assert new.position("rod", "C") == pytest.approx([0.0, 13.2], abs=1e-6)
    assert new.position("crank", "A") == pytest.approx(pose.position("crank", "A"), abs=1e-6)


def test_units_stay_as_they_were_written() -> None:
    document = Document(opened("four-bar").text.replace('A = ["40 mm", "0 mm"]', 'A = ["4.0 cm", "0.0 in"]'))
    case = read_case("four-bar")
    pose = case.solve_pose()
    to = 1.25 * pose.position("crank", "A")
    document.apply([{"op": "move", "joint": "A", "to": to.tolist()}], pose)
    assert document.tables()["links"]["crank"]["points"]["A"] == ["5 cm", "0.0 in"]
    assert document.tables()["pose"]["angle"] == "40 deg"


def test_a_length_is_typed_and_the_pose_turned() -> None:
    document = opened("four-bar")
    document.apply([{"op": "length", "link": "crank", "points": ["O2", "A"], "value": "4.5 cm"}], None)
    document.apply([{"op": "length", "link": "rocker", "points": ["P", "B"], "value": "30 mm"}], None)
    document.apply([{"op": "turn", "to": 42.5}], None)
    case = stated(document, "four-bar")
    assert document.tables()["links"]["crank"]["points"]["A"] == ["4.5 cm", "0 mm"]
    assert case.links["rocker"].points["B"] == (90.0, 0.0)
    assert math.degrees(case.pose.angle) == pytest.approx(42.5)
    document = Document('[pose]\ncoordinate = "guide"\ntravel = "1 cm"\n')
    document.apply([{"op": "turn", "to": 25}], None)
    assert document.tables()["pose"]["travel"] == "2.5 cm"


def test_a_four_bar_is_drawn_from_an_empty_case() -> None:
    document = Document(EMPTY)
    with pytest.raises(CaseError, match="at least 2"):
        stated(document, "")
    steps: list[dict[str, Any]] = [
        {"op": "ground", "at": [110, 5]},
        {"op": "link", "name": "crank", "from": {"link": "base", "point": "O2"}, "to": {"at": [30, 25]}},
        {"op": "link", "name": "coupler", "from": {"link": "crank", "point": "B"}, "to": {"at": [140, 70]}},
        {"op": "move", "link": "coupler", "point": "C", "to": [150, 70]},
        {"op": "link", "name": "rocker", "from": {"ground": [100, 0]}, "to": {"link": "coupler", "point": "C"}},
        {"op": "set", "path": ["links", "rocker", "points", "P"], "value": ["120 mm", "0 mm"]},
        {"op": "remove", "path": ["links", "base", "points", "A"]},
    ]
    for step in steps:
        document.apply([step], None)
        with pytest.raises(CaseError, match=r"\A[^\n]+\Z"):
            stated(document, "")
        placed = Plane(document.tables()).at
        assert placed.get(("crank", "B"), 30 + 25j) == pytest.approx(30 + 25j, abs=1e-5)
    assert placed["coupler", "C"] == pytest.approx(150 + 70j, abs=1e-5)
    load = {"op": "load", "load_case": "lift", "link": "rocker", "point": "P", "force": ["0 N", "-5 N"]}
    document.apply([load], None)
    case = stated(document, "")
    assert case.solve_pose().position("rocker", "C") == pytest.approx([150, 70], abs=1e-5)
    assert (case.pose.coordinate, case.drive and case.drive.joint) == ("crank", "O2")
    assert case.load_cases["lift"].forces[0].force == (0.0, -5.0)
    assert check_case(case, fidelity="beam").verdict is Verdict.PASS
    for _ in range(8):
        document.undo()
    assert document.text == EMPTY


def test_a_link_is_drawn_onto_a_joint_and_takes_what_its_pin_has() -> None:
    case, document = read_case("six-bar"), opened("six-bar")
    pose = case.solve_pose()
    at = pose.position("coupler", "B")
    document.apply([{"op": "link", "name": None, "from": {"joint": "B"}, "to": {"ground": [60, 120]}}], pose)
    links, joints = document.tables()["links"], document.tables()["joints"]
    length = float(links["link-1"]["points"]["E"][0].removesuffix(" mm"))
    assert length == pytest.approx(float(np.hypot(*(at - (60, 120)))))
    assert joints["F"] == {
        "links": ["coupler", "link-1"],
        "points": ["B", "F"],
        "pin_diameter": "3 mm",
        "fit": {"coupler": "H8/f7", "link-1": "press"},
    }
    assert joints["E"]["links"] == ["base", "link-1"]
    assert links["link-1"]["layer"] == 1  # neither the coupler's nor the base's
    with pytest.raises(CaseError, match="mobility 0"):
        stated(document, "six-bar")


@pytest.mark.parametrize(
    ("tight_in", "taken"), [("rocker", ["link-1"]), (["rocker", "coupler"], ["link-1", "coupler"])]
)
def test_a_pin_is_tight_in_the_new_link_as_in_the_one_that_it_stands_for(tight_in: Any, taken: list[str]) -> None:
    document = opened("six-bar")
    document.apply([{"op": "remove", "path": ["joints", "B", "fit"]}], None)
    document.apply([{"op": "set", "path": ["joints", "B", "tight_in"], "value": tight_in}], None)
    link = {"op": "link", "name": None, "from": {"joint": "B"}, "to": {"ground": [60, 120]}}
    document.apply([link], read_case("six-bar").solve_pose())
    assert document.tables()["joints"]["F"]["tight_in"] == taken


def test_points_are_joined_and_a_joint_is_split() -> None:
    case, document = read_case("four-bar"), opened("four-bar")
    document.apply([{"op": "remove", "path": ["joints", "B"]}], case.solve_pose())
    assert "B" not in document.tables()["joints"]
    ends = [{"link": "coupler", "point": "B"}, {"link": "rocker", "point": "B"}]
    document.apply([{"op": "join", "ends": ends}], None)
    again = stated(document, "four-bar")
    assert again.joints["B"].pin_diameter == 3.0
    assert again.solve_pose().position("rocker", "O4") == pytest.approx([100.0, 0.0], abs=1e-5)


def test_a_layer_is_set_where_none_was() -> None:
    document = opened("four-bar")
    document.apply([{"op": "layer", "link": "crank", "to": 1}], None)
    layers = {name: link.layer for name, link in stated(document, "four-bar").links.items()}
    assert layers == {"base": 0, "crank": 1, "coupler": 0, "rocker": 0}


def named(document: Document) -> list[tuple[str, ...]]:
    """Paths of all that has a name, points of links among them."""
    tables = document.tables()
    points = [("links", link, "points", point) for link, table in tables["links"].items() for point in table["points"]]
    return [*points, *((table, name) for table in NAMED for name in tables.get(table, {}))]


def meant(document: Document, path: tuple[str, ...]) -> list[Any]:
    """What refers to something that has a name."""
    kind, link = ("points", {path[1]}) if len(path) == 4 else (path[0], set())
    found = [one for one in references(document.tables()) if one.kind == kind and one.name == path[-1]]
    return [one for one in found if not link or set(one.links) == link]


@pytest.mark.parametrize("name", CASES)
def test_a_renamed_thing_is_renamed_everywhere_and_the_pose_is_the_same(name: str) -> None:
    pose, document = read_case(name).solve_pose(), opened(name)
    before, done = document.text, 0
    for path in named(document):
        try:
            document.apply([{"op": "rename", "path": path, "to": "new name"}], None)
        except CaseError as refused:
            assert "ornithopter sets it" in str(refused)  # noqa: PT017
            continue
        done += 1
        assert not meant(document, path)
        if done % 4 == 0:
            assert stated(document, name).solve_pose().q == pytest.approx(pose.q, abs=1e-12)
        document.undo()
        assert document.text == before
    assert done > 10


def test_numbers_of_the_verdict_stay_and_its_subjects_are_renamed() -> None:
    document, names = opened("finger"), {"distal": "tip of it", "D": "knuckle"}
    document.apply([{"op": "rename", "path": ["joints", "D"], "to": "knuckle"}], None)
    document.apply([{"op": "rename", "path": ["links", "distal"], "to": "tip of it"}], None)
    new = stated(document, "finger")
    assert new.joints["knuckle"].links == ("middle", "tip of it")
    assert list(new.links["tip of it"].points) == ["knuckle", "Q", "H", "T"]
    before, after = (
        {(one.name, one.subject.kind, one.subject.name): one.value.value for one in result.load_cases["grip"].checks}
        for result in (by_hand("finger"), check_case(new, fidelity="beam"))
    )
    renamed = {(check, kind, names.get(name, name)): value for (check, kind, name), value in before.items()}
    assert renamed == pytest.approx(after, rel=1e-12, nan_ok=True)


def test_paths_of_tolerances_are_renamed_and_a_removed_heading_leaves_one_empty_line() -> None:
    document = Document(opened("four-bar").text + '\n[tolerances]\n"links.crank.points.A" = "0.2 mm"\n')
    document.apply([{"op": "rename", "path": ["links", "crank", "points", "A"], "to": "Q"}], None)
    document.apply([{"op": "rename", "path": ["links", "crank"], "to": "arm"}], None)
    assert document.tables()["tolerances"] == {"links.arm.points.Q": "0.2 mm"}
    document.apply([{"op": "remove", "path": ["links", "coupler"]}], None)
    assert "\n\n\n" not in document.text


@pytest.mark.parametrize("name", CASES)
def test_what_is_removed_is_named_nowhere(name: str) -> None:
    document = opened(name)
    before = document.text
    for path in named(document):
        if path[0] == "materials":
            continue
        document.apply([{"op": "remove", "path": path}], None)
        assert not meant(document, path)
        joints = document.tables().get("joints", {}).values()
        assert all(link in document.tables()["links"] for joint in joints for link in joint["links"])
        document.undo()
        assert document.text == before


def test_a_load_line_goes_with_either_of_its_links_and_does_not_end_in_the_ground_instead() -> None:
    line = """
[[load_cases.lift.load_lines]]
from = ["0 mm", "9 mm"]
to = ["5 mm", "0 mm"]
force = "1 N"
link = "rocker"
at = "P"
leaves = { link = "crank", at = "A" }
"""
    for link, left in (("crank", 1), ("rocker", 0), ("coupler", 1)):
        document = Document(opened("four-bar").text + line + line.replace("crank", "coupler"))
        document.apply([{"op": "rename", "path": ["links", link], "to": "other"}], None)
        document.apply([{"op": "remove", "path": ["links", "other"]}], None)
        lines = document.tables()["load_cases"]["lift"].get("load_lines", [])
        assert len(lines) == left
        assert all("leaves" in one for one in lines)


def test_every_name_of_the_records_is_known() -> None:
    schema = Case.model_json_schema()

    def by_text(entry: Any) -> bool:
        inner = entry.values() if isinstance(entry, dict) else entry if isinstance(entry, list) else ()
        own = isinstance(entry, dict) and entry.get("format") == "name"
        return own or any(map(by_text, inner))

    own = {("Claim", "case"), ("LevelSpec", "tests"), ("LevelSpec", "test")}  # of names that nothing else states
    for record, table in [("case", schema), *schema["$defs"].items()]:
        for key, entry in table.get("properties", {}).items():
            keyed = by_text(entry.get("propertyNames"))
            plain = by_text({k: v for k, v in entry.items() if k not in ("propertyNames", "additionalProperties")})
            if record == "case":
                assert not keyed or key in NAMED, key
            elif record not in ("Link", "Claim") or key != "points":
                assert not keyed or key in BY_KEY or (record, key) in own, (record, key)
                assert not plain or keyed or key in BY_VALUE or (record, key) in own, (record, key)


@pytest.mark.parametrize(
    ("operation", "sentence"),
    [
        ({"op": "link", "from": {"at": [0, 0]}, "to": {"at": [9, 9]}}, "hangs nowhere"),
        ({"op": "link", "from": {"joint": "A"}, "to": {"link": "crank", "point": "O2"}}, "both ends are on"),
        ({"op": "link", "from": {"joint": "X"}, "to": {"at": [9, 9]}}, "no such joint"),
        ({"op": "link", "name": "crank", "from": {"joint": "A"}, "to": {"at": [9, 9]}}, "is there already"),
        ({"op": "rename", "path": ["links", "crank"], "to": "rocker"}, "is there already"),
        ({"op": "rename", "path": ["links", "crank"], "to": "a.b"}, "a name is made of"),
        ({"op": "rename", "path": ["pose", "angle"], "to": "x"}, "nothing of this name"),
        ({"op": "move", "link": "crank", "point": "X", "to": [1, 1]}, "no such point"),
        ({"op": "move", "joint": "A", "to": [0, 0]}, "no length"),
        ({"op": "move", "joint": "A", "to": ["x", None]}, "does not fit"),
        ({"op": "length", "link": "crank", "points": ["O2", "A"], "value": "0 mm"}, "greater than zero"),
        ({"op": "length", "link": "crank", "points": ["O2", "A"], "value": "40"}, "unit"),
        ({"op": "load", "load_case": "lift", "link": "crank", "point": "X", "force": ["0 N", "1 N"]}, "no such point"),
        ({"op": "join", "ends": [{"joint": "A"}, {"link": "crank", "point": "O2"}]}, "both points are of"),
        ({"op": "layer", "link": "X", "to": 1}, "no such link"),
        ({"op": "explode"}, "no operation"),
    ],
)
def test_what_cannot_be_drawn_is_refused(operation: dict[str, Any], sentence: str) -> None:
    document = opened("four-bar")
    with pytest.raises(CaseError, match=sentence) as refused:
        document.apply([operation], read_case("four-bar").solve_pose())
    assert "\n" not in str(refused.value)
    assert (document.text, document.can_undo) == (opened("four-bar").text, False)


def test_a_point_is_given_to_another_link_with_its_load() -> None:
    document = opened("four-bar")
    pose = stated(document, "four-bar").solve_pose()
    before = pose.position("rocker", "P")
    document.apply([{"op": "hand", "link": "rocker", "point": "P", "to": "coupler"}], pose)
    tables = document.tables()
    assert "P" not in tables["links"]["rocker"]["points"]
    assert tables["load_cases"]["lift"]["forces"] == [{"link": "coupler", "at": "P", "force": ["0 N", "-5 N"]}]
    after = stated(document, "four-bar").solve_pose()
    axis = after.rotation("coupler")[:, 0]
    assert axis @ (after.position("coupler", "P") - before) == pytest.approx(0.0, abs=1e-6)  # the nearest of its axis
    document.undo()
    assert document.text == opened("four-bar").text


def test_tolerances_go_with_what_they_are_of() -> None:
    """With a point to another link; away with a force, of which those behind it keep theirs; away with a link."""
    entries = {"links.rocker.points.P": "0.2 mm", "links.coupler.points.B": "0.1 mm"}
    entries |= {f"load_cases.lift.forces.{n}": f"{n + 1} %" for n in range(3)}
    text = opened("four-bar").text + "\n[tolerances]\n" + "\n".join(f'"{k}" = "{v}"' for k, v in entries.items())
    document = Document(text + "\n")
    forces = [{"link": "rocker", "at": "P", "force": ["0 N", f"-{n} N"]} for n in (1, 2, 3)]
    document.apply([{"op": "set", "path": ["load_cases", "lift", "forces"], "value": forces}], None)
    document.apply([{"op": "remove", "path": ["load_cases", "lift", "forces", 0]}], None)
    left = {"load_cases.lift.forces.0": "2 %", "load_cases.lift.forces.1": "3 %"}
    assert document.tables()["tolerances"] == {**{k: v for k, v in entries.items() if "points" in k}, **left}
    pose = stated(document, "four-bar").solve_pose()
    document.apply([{"op": "hand", "link": "rocker", "point": "P", "to": "coupler"}], pose)
    assert document.tables()["tolerances"]["links.coupler.points.P"] == "0.2 mm"
    stated(document, "four-bar")
    document.apply([{"op": "remove", "path": ["links", "coupler"]}], None)
    assert not any("coupler" in entry for entry in document.tables().get("tolerances", {}))


def test_points_of_a_part_from_a_file_are_handed_neither_way() -> None:
    document = opened("step")
    links = document.tables()["links"]
    parts = document.tables()["parts"]
    [imported] = [name for name, one in links.items() if "file" in parts.get(one.get("part"), {})]
    other = next(name for name in links if name != imported)
    point = next(iter(links[imported]["points"])) if isinstance(links[imported]["points"], dict) else "A"
    for link, place, to in ((imported, point, other), (other, next(iter(links[other]["points"])), imported)):
        with pytest.raises(CaseError, match="come from its bores"):
            document.apply([{"op": "hand", "link": link, "point": place, "to": to}], None)
    assert document.text == opened("step").text


def test_a_joint_is_given_to_a_third_link_and_not_to_its_own() -> None:
    document = opened("six-bar")
    pose = stated(document, "six-bar").solve_pose()
    joint, [first, second] = next((name, one["links"]) for name, one in document.tables()["joints"].items())
    third = next(name for name in document.tables()["links"] if name not in (first, second))
    with pytest.raises(CaseError, match="to itself"):
        document.apply([{"op": "hand", "link": second, "point": joint, "to": first}], pose)
    document.apply([{"op": "hand", "link": second, "point": joint, "to": third}], pose)
    made = document.tables()["joints"][joint]
    assert made["links"] == [first, third]
    for link, point in zip(made["links"], made.get("points", [joint, joint]), strict=True):
        assert point in document.tables()["links"][link]["points"]
    for wrong in ("nobody", third):
        with pytest.raises(CaseError, match="no other link"):
            document.apply([{"op": "hand", "link": third, "point": joint, "to": wrong}], None)
