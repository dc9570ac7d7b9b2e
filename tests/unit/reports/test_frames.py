"""What the report and the record say of frames: models, large displacement, pins, ways to hold."""

import html
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import solved
from edited_cases import PLANAR, edited
from told import flat, printed, render, result_record
from told import section as section_of

from alula.fea.check.anchor import anchor_loads
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, read_text, validate
from alula.reports.sections.section import parts_of
from alula.reports.sections.table import Table
from alula.reports.sentences import told as in_words

WING = "owl-wing-static"


def checked(*overrides):
    return check_case(edited(WING, [PLANAR, *overrides]), name=WING, fidelity="beam")


def section(result):
    page = render(result, {})
    start = page.index('<section id="displacement">')
    text = re.sub(r"<[^>]+>", " ", page[start : page.index("</section>", start)])
    return re.sub(r"\s+", " ", html.unescape(text))


@pytest.fixture
def wing():
    return solved.by_hand(WING, PLANAR)


def test_the_wings_page_sets_the_ways_to_hold_it_side_by_side(wing):
    words = section(wing)
    for row in (
        "pinned, held at AE −5.71 −47.53 0.00 47.9",
        "pinned, held at GF −1.44 −4.75 0.00 4.97",
        "bonded, A, G built in −0.96 −3.59 0.00 3.72",
        "published: Paredes (2018), table 14: finite elements, A and G fixed 2",
    ):
        assert row in words
    assert "belong to the undeformed pose" in words
    assert "it gives way at 20.3 % of it" in words
    assert "A steel-wire 1.5 7 3.86 (0 to 3.86) 11.6 (0 to 11.6) 0.779" in words


def test_a_published_displacement_stands_with_its_own_load_case_alone():
    """The source ran as-published; complete is none of its loads."""
    case = read_case("owl-wing-flight", [PLANAR])
    loads = {name: case.load_cases[name] for name in ("as-published", "complete")}
    result = check_case(case.model_copy(update={"load_cases": loads}), name="owl-wing-flight", fidelity="beam")
    words = section(result)
    parts = re.split(r"Load case (as-published|complete)", words)
    told = dict(zip(parts[1::2], parts[2::2], strict=True))
    assert {name: "published: Paredes" in text for name, text in told.items()} == {
        "as-published": True,
        "complete": False,
    }
    tables = {
        dict(part.under)["load case"]: part
        for part in parts_of(section_of(result, "displacement").parts)
        if isinstance(part, Table) and part.key == "ways to hold"
    }
    for name, load_case in result.load_cases.items():
        held = [row["held"] for row in tables[name].records]
        assert held[: len(load_case.ways_to_hold)] == [one.name for one in load_case.ways_to_hold]
        assert len(held) == len(load_case.ways_to_hold) + (name == "as-published")
    assert tables["as-published"].records[-1]["total [mm]"] == pytest.approx(3.2)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ("other", ["ways_to_hold.load_case", "'other'", "as-published, complete"]),
        (None, ["ways_to_hold.load_case", "missing", "as-published"]),
    ],
)
def test_a_published_displacement_needs_its_load_case(stated, words):
    tree = tomllib.loads(read_text("owl-wing-flight")[0])
    del tree["ways_to_hold"]["load_case"]
    tree["ways_to_hold"] |= {} if stated is None else {"load_case": stated}
    with pytest.raises(CaseError) as error:
        validate(tree)
    assert all(word in str(error.value) for word in words)


def test_the_bands_are_told_check_by_check(wing):
    """Where a model gives stresses no band, pins and buckling have theirs in the same table."""
    load_case = wing.load_cases["weight"]
    bare = [
        replace(check, value=Band.exact(check.value.value, "beam theory without stress concentration"))
        if check.name == "strength"
        else check
        for check in load_case.checks
    ]
    result = replace(wing, load_cases={"weight": replace(load_case, checks=tuple(bare))})
    words = re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]+>", " ", render(result, {}))))
    start = words.index("Sources of error in the band of each check")
    told = words[start : start + 1000]
    assert "strength: nothing (beam theory without stress concentration)." in told
    assert "pins: load sharing between the two eyes of a pin and play of pins." in told
    assert re.search(
        "buckling: .*geometric imperfection,? .*restraint by the neighbouring links and play of pins[.]", told
    )


def test_forces_of_the_undeformed_pose_are_called_so(wing):
    load_case = wing.load_cases["weight"]
    assert load_case.large_displacement.state == "no equilibrium"
    assert result_record(wing)["load_cases"]["weight"]["anchor"]["unstable"] is True
    page = html.unescape(render(wing, {}))
    assert "On the ground, in the undeformed pose, since no stable equilibrium was found on the deformed one" in page
    text = printed(wing)
    shape = "in the undeformed pose, since no stable equilibrium was found on the deformed one"
    assert f"Loads on the ground On the ground, {shape} at Fx [N]" in flat(text)
    # Forces in the plane leave no force along z and no moment about x and y, whatever rounding says.
    total = anchor_loads(load_case).total
    assert total[2] == total[3] == total[4] == 0.0


def test_rounding_of_the_anchor_is_zero(wing):
    """Components of 1e-13 of the rest, of either sign, are what rounding leaves of nothing."""
    load_case = wing.load_cases["weight"]
    noisy = {
        name: replace(joint, wrench=joint.wrench + 1e-14 * np.array([0, 0, -1, 1, -1, 0]))
        for name, joint in load_case.reactions.joints.items()
    }
    reactions = replace(load_case.reactions, joints=noisy)
    anchor = anchor_loads(replace(load_case, forces=replace(load_case.forces, reactions=reactions)))
    for wrench in (*anchor.joints.values(), anchor.total):
        assert wrench[2] == wrench[3] == wrench[4] == 0.0
        assert np.abs(wrench[:2]).min() > 0.0 or wrench is anchor.total


def test_the_record_keeps_both_shapes():
    result = checked('drive.link="GF"', 'drive.joint="G"', 'load_cases.weight.forces.0.force=["0 N","-1.5 N"]')
    record = result_record(result)
    found = record["load_cases"]["weight"]
    assert found["large_displacement"]["state"] == "deformed"
    undeformed = {r["joint"]: r["magnitude"] for r in record["reactions"]}
    deformed = {r["joint"]: r["magnitude"] for r in found["large_displacement"]["reactions"]}
    assert undeformed.keys() == deformed.keys() == set("ABCDEFG")
    assert undeformed["D"] == pytest.approx(6.0 * 0.3730, abs=1e-3)
    assert deformed["D"] == pytest.approx(2.5769, abs=5e-4)
    assert undeformed["D"] != pytest.approx(deformed["D"], rel=0.05)
    words = section(result)
    assert "Joint forces in the undeformed and in the deformed pose" in words
    assert "D [N] 2.238 2.577" in words
    assert "D [N] 2.238 2.577" in flat(printed(result))


def test_forces_out_of_the_plane_name_their_model():
    result = checked('load_cases.weight.forces.0.force=["0 N","0 N","0.001 N"]')
    record = result_record(result)["load_cases"]["weight"]
    assert record["joint_forces"]["model"].startswith("spatial frame")
    wrench = next(r["wrench"] for r in result_record(result)["reactions"] if r["joint"] == "A")
    assert wrench[2] != 0.0
    assert wrench[3] != 0.0
    assert "Joint forces by a spatial frame" in flat(printed(result))
    assert "Joint forces by a spatial frame" in section(result)
    assert sum("spatial frame" in in_words(warning) for warning in result.warnings) == 1


def test_conditions_stand_in_the_record():
    result = checked(
        'parts.tube.material="pvc-u"', 'conditions={duration="1 day",temperature="30 degC"}', 'large_displacement="off"'
    )
    assert result_record(result)["conditions"] == {
        "duration": 86400.0,
        "temperature": pytest.approx(30.0),
        "cycles": None,
        "reverses": False,
    }
    assert "was not checked" in section(result)
