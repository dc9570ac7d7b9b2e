"""What no check looks at is named, in the verdict's sentence and in the record."""

import math
import tomllib
from importlib.resources import files

import pytest
from frequency_cases import lever
from materials import with_material
from told import result_record

from alula.fea.check.run import check_case
from alula.fea.findings.of_check import with_harmonic
from alula.fea.outcomes.unchecked import caveats
from alula.fea.vibration.harmonics import nearest_harmonic
from alula.fea.vibration.over_motion import pose_frequencies
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import SustainedCheck
from alula.loads.text.caveat import Topic
from alula.reports.sentences import told as in_words
from alula.reports.sentences.caveats import caveat, not_checked
from alula.reports.sentences.verdicts import headline

STRENGTH = {"type": "safety-factor", "minimum": 0.01}
PINS = {"type": "pins", "minimum": 0.01}
STIFF = {"type": "displacement", "maximum": "1 m"}
NO_PINS = "pins (no check)"
CREEP = "creep under loads that stay (no conditions.duration)"
SHAFT = (
    'drive shaft at O2 (its torque enters by the flat faces; a check of type "connection" judges it, and with '
    'drive.transfer = "bore-shear" it twists the pin)'
)
COLLISIONS = "collisions of links and couples of their pins (no link states a layer)"


def starter(checks, *bare):
    """The starter case with these checks, some links without part."""
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    for link in bare:
        del data["links"][link]["part"]
    data["load_cases"]["lift"]["own_weight"] = False
    return validate(data | {"checks": checks})


def in_layers(checks, *bare, transfer="eye-faces"):
    """The starter case whose links lie in layers of their own, but for rocker and crank."""
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    for layer, link in enumerate(("base", "crank", "coupler", "rocker")):
        data["links"][link]["layer"] = layer if link != "rocker" else 1
    data["links"]["base"]["thickness"] = "4 mm"
    data["load_cases"]["lift"]["own_weight"] = False
    data["drive"]["transfer"] = transfer
    return validate(data | {"layer_spacing": "5 mm", "checks": checks})


def unchecked(case, **over):
    """What is not checked of a case, as it is told."""
    return tuple(not_checked(caveats(case, **over)))


def left(case, **over):
    """What is not checked of a case, without shaft, collisions and creep, which the starter has always."""
    return tuple(one for one in unchecked(case, **over) if one not in (SHAFT, COLLISIONS, CREEP))


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
    assert left(starter(checks, *bare)) == left_out


def test_the_drive_shaft_is_told_where_its_torque_is_not_in_the_pin():
    checks = {"a": STRENGTH, "b": PINS}
    assert unchecked(starter(checks)) == (SHAFT, COLLISIONS, CREEP)
    assert unchecked(in_layers(checks)) == (SHAFT, CREEP)
    assert unchecked(in_layers(checks, transfer="bore-shear")) == (CREEP,)
    balanced = starter(checks)
    assert unchecked(balanced.model_copy(update={"drive": None})) == (COLLISIONS, CREEP)


def test_collisions_are_told_where_several_links_have_parts_and_none_states_a_layer():
    assert COLLISIONS in unchecked(starter({}))
    assert COLLISIONS not in unchecked(starter({}, "crank", "coupler")), "one part alone meets none"


@pytest.mark.parametrize("build", [starter, in_layers])
@pytest.mark.parametrize("pins", [True, False])
def test_a_pin_of_several_joints_in_one_plane_is_told_where_pins_are_checked(build, pins):
    """A link more on the pin at B, from there to the ground beside O4: another rocker, of another length."""
    case = build({"a": STRENGTH, "p": PINS} if pins else {"a": STRENGTH})
    told_of = "bending of the pin that joints B, B2 share (their links lie in one plane"
    links = case.links | {"arm": case.links["rocker"].model_copy(update={"layer": case.links["base"].layer})}
    joint = case.joints["B"].model_copy(update={"links": ("coupler", "arm"), "points": ("B", "B")})
    with_arm = case.model_copy(update={"links": links, "joints": case.joints | {"B2": joint}})
    told = [one for one in unchecked(with_arm) if one.startswith(told_of)]
    assert len(told) == (pins and build is starter)


def test_a_guide_shares_no_pin():
    """Stated before the pin at its place, which is that of one joint."""
    tables = tomllib.loads((files("alula.loads") / "cases" / "slider-crank.toml").read_text(encoding="utf-8"))
    tables |= {"layer_spacing": "0 mm", "checks": {"pins": PINS}}
    tables["joints"] = {name: tables["joints"][name] for name in ("guide", "O2", "A", "B")}
    assert not [one for one in unchecked(validate(tables)) if "bending of the pin" in one]


def test_a_sustained_check_looks_at_stress_but_not_in_an_envelope():
    lasting = starter({}).model_copy(update={"checks": {"long": SustainedCheck(type="sustained")}})
    assert left(lasting) == (NO_PINS,)
    assert left(lasting, over_motion=True) == ("stress of crank, coupler, rocker (no check)", NO_PINS)


def test_verdict_and_record_name_a_link_without_part():
    result = check_case(starter({"a": STRENGTH, "b": PINS}, "coupler"), fidelity="beam")
    assert headline(result).endswith(
        " Assumed: pins of steel-wire (no pin_material stated). Unusual: checks.a.minimum = 0.01 (below 1 it lets pass "
        "what the load breaks); checks.b.minimum = 0.01 (below 1 it lets pass what the load breaks). Not checked: "
        "coupler (no part); drive shaft at O2; collisions of links and couples of their pins; creep under loads "
        "that stay (no conditions.duration)."
    )
    assert result_record(result)["not_checked"] == ["coupler (no part)", SHAFT, COLLISIONS, CREEP]


def test_nothing_but_creep_is_said_where_all_else_is_checked():
    """In layers, and with the drive's torque in a pin that is checked."""
    case = in_layers({"a": STRENGTH, "b": PINS}, transfer="bore-shear")
    result = check_case(case, fidelity="beam")
    assert headline(result).endswith(f"Not checked: {CREEP}.")
    assert result_record(result)["not_checked"] == [CREEP]


@pytest.mark.parametrize(("checks", "warned"), [({"a": STRENGTH}, False), ({"a": STRENGTH, "b": PINS}, True)])
def test_an_unusual_material_is_warned_of_where_it_is_used(checks, warned):
    """The pins' material counts where pins are checked."""
    case = starter(checks)
    card = case.all_materials["steel-wire"].model_copy(update={"youngs_modulus": 200.0})
    result = check_case(with_material(case, "steel-wire", card), fidelity="beam")
    said = [
        text for text in result.warnings if in_words(text).startswith("materials.steel-wire.youngs_modulus is 0.2 GPa")
    ]
    assert len(said) == warned


def told(**tables):
    """Caveats of the starter with two load cases, by heading and topic, but for what has tests of its own."""
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    data["load_cases"]["held"] = {"own_weight": True, "speed": "0 rpm"}
    for name, more in tables.items():
        data[name] = data.get(name, {}) | more if isinstance(more, dict) else more
    found = caveats(validate(data))
    known = ("stress", "pins", "shaft", "collisions", "fatigue", "creep")
    return {(one.heading.value, one.topic.value): caveat(one) for one in found if one.topic not in known}


FAST = {"turn": True, "speed": "600 rpm"}
SPRING = {"type": "frequency", "minimum": 2.0}
INERTIA, VIBRATION = ("not checked", "inertia"), ("not checked", "vibration")


def test_inertia_that_is_left_out_is_told():
    assert told() == told(motion={"turn": True}) == {}
    assert told(motion=FAST) == {VIBRATION: 'vibration (no check of type "frequency")'}
    assert [key for key in told(motion=FAST, checks={"f": SPRING}) if key[1] != "drive"] == []
    assert told(motion=FAST | {"inertia": False}) == {INERTIA: "inertia (motion.inertia is false)"}
    still = {"own_weight": True, "speed": "0 rpm"}
    assert told(motion=FAST, load_cases={"lift": still}) == {
        INERTIA: "inertia (every load case states that it stands still)"
    }
    running_up = told(motion=FAST | {"acceleration": "1 rad/s^2"})
    assert running_up == {INERTIA: "inertia in this pose (alula envelope has that of the motion)"}


def test_a_pose_in_equilibrium_has_no_inertia_and_says_so():
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    case = validate(data | {"motion": FAST, "pose": data["pose"] | {"equilibrium": True}})
    assert "inertia (the pose is found at rest, pose.equilibrium is true)" in unchecked(case)


def test_weight_that_is_left_out_is_told_with_its_load_cases():
    mass = {"link": "rocker", "at": "P", "mass": "50 kg"}
    light = {"light": {"own_weight": False}, "bare": {"own_weight": False, "carried": False}}
    assert told(carried=[mass], load_cases=light) == {
        ("not checked", "weight"): "weight of what links carry (no own_weight in light; "
        "under [load_cases.light]: own_weight = true)"
    }
    assert told(load_cases=light) == {}
    bare = {name: {"own_weight": True, "carried": False} for name in ("lift", "held")}
    assert told(carried=[mass], load_cases=bare) == {
        ("not checked", "weight"): "what links carry (carried is false in every load case)"
    }


def test_what_is_assumed_of_pins_is_told_where_they_are_checked():
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    joints = {name: joint | {"pin_material": "steel-wire"} for name, joint in data["joints"].items()}
    check = {"p": {"type": "pins", "minimum": 2.0}}
    assumed = ("assumed", "material")
    assert told(checks=check) == {assumed: "pins of steel-wire (no pin_material stated)"}
    assert told(checks=check, joints=joints) == {}
    some = told(checks=check, joints={name: joints[name] for name in ("O2", "B")})
    assert some == {assumed: "pins A, O4 of steel-wire (no pin_material stated)"}
    assert told(checks={"p": check["p"] | {"joints": ["O2"]}}, joints={"O2": joints["O2"]}) == {}


def test_bonds_are_told():
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    bonds = {name: data["joints"][name] | {"bonded": True} for name in ("A", "B")}
    assert told(joints=bonds, motion={}) == {("not checked", "bonds"): 'bonds A, B (no check of type "connection")'}


def test_limits_below_one_and_large_play_are_told():
    checks = {"low": {"type": "bearing", "minimum": 0.5}, "whole": {"type": "limit-load", "minimum": 1.0}}
    found = told(checks=checks)
    assert found == {("unusual", "limit"): "checks.low.minimum = 0.5 (below 1 it lets pass what the load breaks)"}
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    loose = {name: data["joints"][name] | {"clearance": play} for name, play in (("A", "2.9 mm"), ("B", "0.3 mm"))}
    assert told(joints=loose) == {("unusual", "play"): "play of 2.9 mm at A (its pin has 3 mm)"}


def test_limits_of_cards_below_one_are_told_where_they_decide():
    own = "materials.steel-wire.minimum_safety_factor = 0.5 (below 1 it lets pass what the load breaks)"
    case = starter({"a": STRENGTH | {"minimum": 2.0}, "b": {"type": "pins"}})
    weak = case.all_materials["steel-wire"].model_copy(update={"minimum_safety_factor": 0.5})
    assert own in [caveat(one) for one in caveats(with_material(case, "steel-wire", weak))]
    stated = starter({"a": STRENGTH | {"minimum": 2.0}, "b": PINS | {"minimum": 2.0}})
    assert own not in [str(one) for one in caveats(with_material(stated, "steel-wire", weak))]


@pytest.mark.parametrize(
    ("tables", "key", "text"),
    [
        (
            {"motion": FAST, "drive": {"stiffness": "0.1 N*m/rad"}, "checks": {"f": SPRING | {"minimum": 0.01}}},
            ("unusual", "limit"),
            "checks.f.minimum = 0.01 (below 1 it lets pass what rings below its drive)",
        ),
        (
            {"tolerances": {"parts.bar.thickness": {"plus_minus": "0.5 mm"}}},
            ("not checked", "tolerances"),
            "tolerances (alula tolerance looks at them)",
        ),
        (
            {"drive": {"stiffness": "0.1 N*m/rad"}},
            ("assumed", "drive"),
            "a drive that does not give (its stiffness counts for natural frequencies alone)",
        ),
        (
            {"joint_model": "bonded"},
            ("not checked", "bonds"),
            'bonds O2, A, B, O4 (no check of type "connection")',
        ),
        (
            {
                "load_cases": {
                    "push": {
                        "own_weight": False,
                        "forces": [
                            {"link": "rocker", "at": "P", "force": ["0 N", "-5 N"]},
                            {"link": "rocker", "at": "O4", "force": ["0 N", "-5000 N"]},
                        ],
                    }
                }
            },
            ("assumed", "loads"),
            "force at O4 of rocker (the pin there bears it, not the link's eye)",
        ),
    ],
)
def test_what_a_case_states_and_no_check_looks_at_is_told(tables, key, text):
    found = told(**tables)
    assert found.pop(key) == text
    assert {topic for _, topic in found} <= {"drive"}


def test_a_guide_that_rubs_without_a_length_is_told():
    data = tomllib.loads((files("alula.loads") / "cases" / "slider-crank.toml").read_text(encoding="utf-8"))
    guide = (
        "assumed",
        "friction",
        'no couple on guide (no guide_length; under [joints.guide]: guide_length = "20 mm")',
    )
    for length, is_told in (({}, True), ({"guide_length": "30 mm"}, False)):
        joints = data["joints"] | {"guide": data["joints"]["guide"] | length}
        found = [(x.heading.value, x.topic.value, caveat(x)) for x in caveats(validate(data | {"joints": joints}))]
        assert (guide in found) is is_told


@pytest.mark.parametrize(("poses", "found"), [(72, "they are 5.07° apart"), (73, None)])
def test_poses_far_apart_are_told_of_the_motion_alone(poses, found):
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    case = validate(data | {"motion": {"turn": True, "poses": poses}})
    why = [in_words(one.why) for one in caveats(case, over_motion=True) if one.topic == "motion"]
    assert why == ([found] if found else [])
    assert not [one for one in caveats(case) if one.topic == "motion"]


def driven(**loads):
    """A lever without a check, driven by load cases with these speeds."""
    case = lever()
    [turning] = case.load_cases.values()
    each = {name: turning.model_copy(update={"speed": 2.0 * math.pi * hertz}) for name, hertz in loads.items()}
    return case.model_copy(update={"checks": {}, "load_cases": each})


def test_the_harmonic_that_comes_nearest_to_the_lowest_natural_frequency_is_told_in_a_ratio():
    """The 3rd one, of the frequency at that speed, which stiffens; a load case far from it does not hide it."""
    [still] = pose_frequencies(driven(a=1.0)).values()
    lowest = float(still.frequencies[0, 0])
    near = 1.02 * lowest / 3.0
    for loads in ({"near": near, "far": 0.7 * lowest}, {"far": 0.7 * lowest, "near": near}):
        own = float(pose_frequencies(driven(near=near))["near"].frequencies[0, 0])
        assert in_words(nearest_harmonic(driven(**loads))).startswith(
            f"in this pose the 3rd harmonic of {60.0 * near:.4g} rpm is at {3.0 * near / own:.3g} of "
        )
    assert nearest_harmonic(driven(slow=1e-3 * lowest))["harmonic"] == 10
    assert nearest_harmonic(driven(still=0.0)) is nearest_harmonic(lever()) is None


def test_the_verdict_tells_the_nearest_harmonic_where_no_check_asks_for_frequencies():
    result = with_harmonic(check_case(driven(turning=10.0), fidelity="beam"))
    said = f'vibration (no check of type "frequency"; {in_words(nearest_harmonic(result.case))})'
    assert "harmonic of 600 rpm" in said
    assert said in headline(result)
    assert said in result_record(result)["not_checked"]


def of_topic(case, topic, *, over_motion=False):
    return [caveat(one) for one in caveats(case, over_motion=over_motion) if one.topic is topic]


def of_material(material, **tables):
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    data["parts"]["bar"]["material"] = material
    del data["parts"]["bar"]["build_direction"]
    return validate({key: value for key, value in (data | tables).items() if value is not None})


def test_layers_of_a_print_whose_card_tells_nothing_of_them_are_named():
    said = "layers (strength between the layers of a print is not known)"
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
    turning = {"motion": {"turn": True, "speed": "60 rpm"}}
    assert of_topic(of_material("pvc-u", **turning), Topic.CREEP) == [], "it moves"
    assert of_topic(of_material("pvc-u"), Topic.CREEP) == of_topic(of_material("pvc-u", motion=None), Topic.CREEP)
    assert of_topic(of_material("pvc-u", motion=None), Topic.CREEP) == [
        "creep under loads that stay (no conditions.duration)"
    ]
    assert of_topic(of_material("steel-304", motion=None), Topic.CREEP) == []
    assert of_topic(of_material("pvc-u", motion=None, **lasting), Topic.CREEP) == [], "a check of it is added"
    one = {"long": {"type": "sustained", "links": ["rocker"]}}
    assert of_topic(of_material("pvc-u", checks=one, **lasting), Topic.CREEP) == ["creep of crank, coupler (no check)"]


def test_fatigue_is_named_where_a_speed_repeats_it_and_nothing_judges_it():
    turning = {"motion": {"turn": True, "speed": "60 rpm"}}
    assert of_topic(of_material("steel-s235"), Topic.FATIGUE) == []
    assert of_topic(of_material("steel-s235", **turning), Topic.FATIGUE) == [
        "fatigue (alula envelope follows the motion)"
    ]
    bare, known = (of_material(name, **turning) for name in ("brass-cuzn39pb3", "aluminium-6061-t6"))
    assert of_topic(bare, Topic.FATIGUE, over_motion=True) == ["fatigue (no fatigue data of brass-cuzn39pb3)"]
    assert of_topic(known, Topic.FATIGUE, over_motion=True) == []


@pytest.mark.parametrize("title", ["PA6-CF, Bambu Lab", "PLA", "Onyx"])
def test_own_cards_of_light_materials_may_be_printed_and_creep_whatever_their_name(title):
    case = of_material("resin-tough", motion=None)
    bare = {"title": title, "strength_across_layers": None, "shear_strength_between_layers": None}
    case = with_material(case, "resin-tough", case.all_materials["resin-tough"].model_copy(update=bare))
    for topic in (Topic.LAYERS, Topic.CREEP):
        assert len(of_topic(case, topic)) == 1


@pytest.mark.parametrize(("wall", "told"), [("0.05 mm", ["crank, coupler, rocker"]), ("1 mm", [])])
def test_a_wall_that_may_buckle_before_it_yields_is_told(wall, told):
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    inner = f"{12.0 - 2.0 * float(wall.split()[0]):g} mm"
    tube = {"shape": "tube", "material": "aluminium-7075-t6", "outer_diameter": "12 mm", "inner_diameter": inner}
    case = validate(data | {"parts": {"bar": tube | {"eyes": "none"}}})
    found = [in_words(one.what) for one in caveats(case) if one.topic is Topic.BUCKLING]
    assert found == [f"buckling of the wall of {links}" for links in told]
    asked = validate(
        data | {"parts": {"bar": tube | {"eyes": "none"}}, "checks": {"wall": {"type": "wall", "minimum": 1.0}}}
    )
    assert not [one for one in caveats(asked) if one.topic is Topic.BUCKLING]


def test_what_a_temperature_lengthens_is_told():
    for degrees, told in (("22 degC", []), ("40 degC", ["thermal expansion (at 40 degC sizes are taken as stated)"])):
        assert of_topic(of_material("pvc-u", conditions={"temperature": degrees}), Topic.TEMPERATURE) == told


def test_a_drive_and_joints_without_what_their_checks_need_are_told():
    motor = {"type": "motor", "voltage": "6 V", "current": "1 A", "efficiency": 0.5}
    tables = {"motion": {"turn": True, "speed": "60 rpm"}, "checks": {"m": motor, "f": SPRING}}
    case = of_material("pvc-u", **tables)
    assert of_topic(case, Topic.DRIVE) == [
        'a drive that does not give (no drive.stiffness; under [drive]: stiffness = "2 N*m/rad")'
    ]
    assert of_topic(case, Topic.FRICTION) == [
        f"joints without friction (none states any; under [joints.{case.pinned_joints[0]}]: friction = 0.15)"
    ]
    assert of_topic(of_material("pvc-u"), Topic.DRIVE) == of_topic(of_material("pvc-u"), Topic.FRICTION) == []
