"""What no check looks at is named, in the verdict's sentence and in the record."""

import tomllib
from importlib.resources import files

import pytest
from materials import with_material

from fea.check.run import check_case
from fea.outcomes.unchecked import Topic, caveats, unchecked
from loads.case.case_file import validate
from loads.records.check_spec import SafetyFactorCheck, SustainedCheck
from reports.tables.record import result_record
from reports.words.wording import headline

STRENGTH = {"type": "safety-factor", "minimum": 0.01}
PINS = {"type": "pins", "minimum": 0.01}
STIFF = {"type": "displacement", "maximum": "1 m"}
NO_PINS = "pins (no check)"


def starter(checks, *bare):
    """The starter case with these checks, some links without part."""
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    for link in bare:
        del data["links"][link]["part"]
    data["load_cases"]["lift"]["own_weight"] = False
    return validate(data | {"checks": checks})


@pytest.mark.parametrize(
    ("checks", "bare", "left_out"),
    [
        ({"a": STRENGTH, "b": PINS}, (), ()),
        ({"a": STRENGTH, "b": PINS}, ("coupler",), ("coupler (no part)",)),
        ({}, ("coupler",), ("coupler (no part)", NO_PINS)),
        ({"a": STRENGTH | {"links": ["rocker"]}, "b": PINS}, (), ("stress of crank, coupler (no check)",)),
        (
            {"a": STRENGTH | {"links": ["rocker"]}, "b": STRENGTH | {"links": ["crank"]}, "c": PINS},
            (),
            ("stress of coupler (no check)",),
        ),
        ({"a": STIFF, "b": PINS}, (), ("stress of crank, coupler, rocker (no check)",)),
        ({"a": STRENGTH}, (), (NO_PINS,)),
        ({"a": STRENGTH, "b": PINS | {"joints": ["A", "B", "O4"]}}, (), ("pin O2 (no check)",)),
        ({"a": STRENGTH, "b": PINS | {"joints": ["A", "B"]}}, (), ("pins O2, O4 (no check)",)),
        # a pin between two links without part cannot be checked: it is named as well
        (
            {"a": STRENGTH, "b": PINS},
            ("crank", "coupler"),
            ("crank (no part)", "coupler (no part)", "pins O2, A (no check)"),
        ),
    ],
)
def test_what_is_left_out(checks, bare, left_out):
    assert unchecked(starter(checks, *bare)) == left_out


def test_a_sustained_check_looks_at_stress_but_not_in_an_envelope():
    lasting = starter({}).model_copy(update={"checks": {"long": SustainedCheck(type="sustained")}})
    assert unchecked(lasting) == (NO_PINS,)
    assert unchecked(lasting, (SafetyFactorCheck,)) == ("stress of crank, coupler, rocker (no check)", NO_PINS)


def test_verdict_and_record_name_a_link_without_part():
    result = check_case(starter({"a": STRENGTH, "b": PINS}, "coupler"), fidelity="beam")
    assert headline(result).endswith(
        " Assumed: pins of steel-wire (no pin_material stated). Unusual: checks.a.minimum = 0.01 (below 1 it lets pass "
        "what the load breaks); checks.b.minimum = 0.01 (below 1 it lets pass what the load breaks). Not checked: "
        "coupler (no part)."
    )
    assert result_record(result)["not_checked"] == ["coupler (no part)"]


def test_nothing_is_said_where_all_is_checked():
    result = check_case(starter({"a": STRENGTH, "b": PINS}), fidelity="beam")
    assert "Not checked" not in headline(result)
    assert result_record(result)["not_checked"] == []


@pytest.mark.parametrize(("checks", "warned"), [({"a": STRENGTH}, False), ({"a": STRENGTH, "b": PINS}, True)])
def test_an_unusual_material_is_warned_of_where_it_is_used(checks, warned):
    """The pins' material counts where pins are checked."""
    case = starter(checks)
    card = case.all_materials["steel-wire"].model_copy(update={"youngs_modulus": 200.0})
    result = check_case(with_material(case, "steel-wire", card), fidelity="beam")
    said = [text for text in result.warnings if text.startswith("materials.steel-wire.youngs_modulus is 0.2 GPa")]
    assert len(said) == warned


def told(**tables):
    """Caveats of the starter with two load cases, by heading and topic, but for what has tests of its own."""
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    data["load_cases"]["held"] = {"own_weight": True, "speed": "0 rpm"}
    for name, more in tables.items():
        data[name] = more if isinstance(more, list) else data.get(name, {}) | more
    found = caveats(validate(data))
    others = ("stress", "pins", "fatigue")
    return {(one.heading.value, one.topic.value): str(one) for one in found if one.topic not in others}


FAST = {"turn": True, "speed": "600 rpm"}
SPRING = {"type": "frequency", "minimum": 2.0}
INERTIA, VIBRATION = ("not checked", "inertia"), ("not checked", "vibration")


def test_inertia_that_is_left_out_is_told():
    assert told() == told(motion={"turn": True}) == {}
    assert told(motion=FAST) == {VIBRATION: 'vibration (no check of type "frequency")'}
    assert told(motion=FAST, checks={"f": SPRING}) == {}
    assert told(motion=FAST | {"inertia": False}) == {INERTIA: "inertia (motion.inertia is false)"}
    running_up = told(motion=FAST | {"acceleration": "1 rad/s^2"})
    assert running_up == {INERTIA: "inertia in this pose (alula envelope has that of the motion)"}


def test_weight_that_is_left_out_is_told_with_its_load_cases():
    mass = {"link": "rocker", "at": "P", "mass": "50 kg"}
    light = {"light": {"own_weight": False}, "bare": {"own_weight": False, "carried": False}}
    assert told(carried=[mass], load_cases=light) == {
        ("not checked", "weight"): "weight of what links carry (no own_weight in light)"
    }
    assert told(load_cases=light) == {}


def test_what_is_assumed_of_pins_is_told_where_they_are_checked():
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    joints = {name: joint | {"pin_material": "steel-wire"} for name, joint in data["joints"].items()}
    check = {"p": {"type": "pins", "minimum": 2.0}}
    assumed = ("assumed", "material")
    assert told(checks=check) == {assumed: "pins of steel-wire (no pin_material stated)"}
    assert told(checks=check, joints=joints) == {}
    some = told(checks=check, joints={name: joints[name] for name in ("O2", "B")})
    assert some == {assumed: "pins A, O4 of steel-wire (no pin_material stated)"}
    assert told(checks={"p": check["p"] | {"joints": ["O2"]}}, joints={"O2": joints["O2"]}) == {}


def test_bonds_are_told():
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    bonds = {name: data["joints"][name] | {"bonded": True} for name in ("A", "B")}
    assert told(joints=bonds, motion={}) == {("not checked", "bonds"): "bonds A, B (what holds them is not judged)"}


def test_limits_below_one_and_large_play_are_told():
    checks = {"low": {"type": "bearing", "minimum": 0.5}, "whole": {"type": "limit-load", "minimum": 1.0}}
    found = told(checks=checks)
    assert found == {("unusual", "limit"): "checks.low.minimum = 0.5 (below 1 it lets pass what the load breaks)"}
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    loose = {name: data["joints"][name] | {"clearance": play} for name, play in (("A", "2.9 mm"), ("B", "0.3 mm"))}
    assert told(joints=loose) == {("unusual", "play"): "play of 2.9 mm at A (its pin has 3 mm)"}


def of_topic(case, topic, *strength):
    return [str(one) for one in caveats(case, *strength) if one.topic is topic]


def of_material(material, **tables):
    data = tomllib.loads((files("loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    data["parts"]["bar"]["material"] = material
    del data["parts"]["bar"]["build_direction"]
    return validate({key: value for key, value in (data | tables).items() if value is not None})


def test_layers_of_a_print_whose_card_tells_nothing_of_them_are_named():
    said = "layers (strength between the layers of the print is not known)"
    assert of_topic(of_material("resin-tough"), Topic.LAYERS) == [said]
    asked = {"a": STRENGTH | {"links": ["rocker"]}}
    assert of_topic(of_material("resin-tough", checks=asked), Topic.LAYERS) == [
        said.replace("ers (", "ers of rocker (")
    ]
    assert of_topic(of_material("resin-tough", checks={"a": STIFF}), Topic.LAYERS) == []
    for material in ("pla-fdm-xy", "aluminium-6061-t6", "pvc-u"):
        assert of_topic(of_material(material), Topic.LAYERS) == []


def test_creep_of_plastics_is_named_where_loads_stay_and_nothing_judges_it():
    lasting = {"conditions": {"duration": "1 year"}}
    assert of_topic(of_material("pvc-u"), Topic.CREEP) == [], "it moves"
    assert of_topic(of_material("pvc-u", motion=None), Topic.CREEP) == [
        "creep under loads that stay (no conditions.duration)"
    ]
    assert of_topic(of_material("steel-304", motion=None), Topic.CREEP) == []
    assert of_topic(of_material("pvc-u", motion=None, **lasting), Topic.CREEP) == [], "a check of it is added"
    one = {"long": {"type": "sustained", "links": ["rocker"]}}
    assert of_topic(of_material("pvc-u", checks=one, **lasting), Topic.CREEP) == ["creep of crank, coupler (no check)"]


def test_fatigue_is_named_where_a_speed_repeats_it_and_nothing_judges_it():
    turning = {"motion": {"turn": True, "speed": "60 rpm"}}
    envelope = (SafetyFactorCheck,)
    assert of_topic(of_material("steel-s235"), Topic.FATIGUE) == []
    assert of_topic(of_material("steel-s235", **turning), Topic.FATIGUE) == [
        "fatigue (alula envelope follows the motion)"
    ]
    bare, known = (of_material(name, **turning) for name in ("steel-s235", "aluminium-6061-t6"))
    assert of_topic(bare, Topic.FATIGUE, envelope) == ["fatigue (no fatigue data of steel-s235)"]
    assert of_topic(known, Topic.FATIGUE, envelope) == []
