import os
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from edited_cases import edited
from hypothesis import given
from hypothesis import strategies as st

from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import LARGEST_FILE, built_in_cases, read_case, read_companion, read_text, validate

OWL = "owl-wing-static"


def sentence(*arguments: object) -> str:
    """The one sentence that reading ends in."""
    return refusal(read_case, *arguments)


def refusal(read: Callable[..., Case], *arguments: object) -> str:
    with pytest.raises(CaseError) as caught:
        read(*arguments)
    text = str(caught.value)
    assert caught.value.exit_status == 2
    assert text.isprintable(), repr(text)  # one line, no control characters
    assert len(text) < 1000
    assert "Traceback" not in text
    assert "pydantic" not in text
    return text


# (override, words that the sentence must hold: entry, value or rule, remedy)
BAD = [
    # unknown keys
    ("bogus=1", ["bogus", "unknown", "correct its name or remove it"]),
    ("links.GF.colour=1", ["links.GF.colour", "unknown"]),
    ("parts.tube.colour=1", ["parts.tube.colour:", "unknown"]),
    ("checks.strength.colour=1", ["checks.strength.colour:", "unknown"]),
    # keys of another kind
    ("parts.tube.shape=bar", ["parts.tube.outer_diameter: shape 'bar' takes no 'outer_diameter'; remove it"]),
    ("parts.tube.shape=step", ["parts.tube.outer_diameter: shape 'step' takes no 'outer_diameter'; remove it"]),
    ("checks.strength.maximum=2", ["checks.strength.maximum: type 'safety-factor' takes no 'maximum'; remove it"]),
    ("materials.m={}", ["materials.m.title, materials.m.density, ", "missing", "add them"]),
    # missing units
    ("pose.angle=228", ["pose.angle", "228", "unit", "30 deg"]),
    ('links.GF.points.F=["50", "0 mm"]', ["links.GF.points.F.0", "'50'", "unit", "125 mm"]),
    ("links.GF.points.F=[50, 0]", ["links.GF.points.F.0", "(it is 50)", "unit as text"]),
    ('checks.x={type="displacement",maximum="2 mm",at="X"}', ["checks.x.at", "'X'", "choose one of"]),
    ('checks.x={type="displacement",maximum="2 mm",at="H",link="AE"}', ["checks.x", "'AE'", "no point 'H'"]),
    (
        'checks.x={type="displacement",maximum="2 mm",link="CH"}',
        ["checks.x.at", "it is missing; add the point of link 'CH'"],
    ),
    (
        'checks.x={type="displacement",maximum="2 mm",at="H",links=["CH"]}',
        ["checks.x: at is about one point", "remove one"],
    ),
    ('checks.x={type="displacement",maximum=2}', ["checks.x.maximum", "(it is 2)", "unit"]),
    # text for a truth or a number, and a number for a truth: in a table, which is taken as a file states it
    *(
        (f"load_cases={{x={{own_weight={stated}}}}}", ["load_cases.x.own_weight", "true or false; write one of them"])
        for stated in ('"no"', '"yes"', "1", "1.0")
    ),
    ('links.CF.holes.1={count="3"}', ["links.CF.holes.1.count", "(it is '3')", "a whole number; write for example 5"]),
    ("links.CF.holes.1={count=true}", ["links.CF.holes.1.count", "a whole number; write for example 5"]),
    ('parts.tube.build_direction=["0", "0", "1"]', ["build_direction.0", "(it is '0')", "a number without unit"]),
    # numbers that are not written as TOML and physics write them
    ("pose.angle=228,15 deg", ["pose.angle", 'use a decimal point: "228.15 deg"']),
    (
        "load_cases.weight.forces.0.force.1=-1,000 N",
        ['use a decimal point: "-1.000 N", or leave out the separator: "-1000'],
    ),
    ("pose.angle=1,234.5 deg", ['leave out the separator: "1234.5 deg"']),
    ("pose.angle=1,,5 deg", ['one finite number and its unit; write for example "30 deg"']),
    (f"solid.accuracy=1{'0' * 400}", ["solid.accuracy", "a share from 0.1 % to 100 %"]),
    (f"load_cases.weight.scatter=1{'0' * 400}", ["load_cases.weight.scatter", "one share below 100 %"]),
    # wrong dimensions
    ("pose.angle=5 mm", ["pose.angle", "5 mm", "not a unit of angle", "30 deg"]),
    ("parts.tube.outer_diameter=5 s", ["parts.tube.outer_diameter", "'5 s'", "not a unit of length"]),
    ('load_cases.weight.forces.0.force=["0 N", "1 mm"]', ["load_cases.weight.forces.0.force.1", "'1 mm'", "0.25 N"]),
    ("parts.tube.material=carbon-plate", ["parts.tube.material", "carbon-plate", "laminate of fibres", "isotropic"]),
    ("parts.tube.material=5 mm", ["parts.tube.material", "5 mm", "unknown", "choose one of", "pvc-u"]),
    # unknown names
    ("pose.coordinate=XX", ["pose.coordinate", "'XX'", "not a moving link", "GF, AE"]),
    ("pose.near.XX=3 deg", ["pose.near", "'XX'", "not a moving link"]),
    ("drive.link=AG", ["drive.link", "'AG'", "not a moving link", "choose one of"]),
    ("drive.joint=C", ["drive.joint", "'C'", "choose one of A, B, E"]),
    ("links.GF.part=rod", ["links.GF.part", "'rod'", "unknown", "choose one of tube"]),
    ('joints.A.links=["AG", "XX"]', ["joints.A", "'XX'", "the links are"]),
    ("load_cases.weight.forces.0.link=XX", ["load_cases.weight.forces.0.link", "'XX'", "not a moving link"]),
    ("load_cases.weight.forces.0.at=XX", ["load_cases.weight.forces.0", "'XX'", "its points are C, D, H"]),
    ('checks.strength.links=["AG"]', ["checks.strength.links", "'AG'", "choose one of"]),
    ('checks.strength.links=["GF", "AE", "GF"]', ["checks.strength.links: 'GF' stands there twice; name each once"]),
    ('checks.x={type="pins",minimum=2,joints=["A", "A"]}', ["checks.x.joints: 'A' stands there twice"]),
    ("hand_calculations.whole-wing.part=x", ["hand_calculations.whole-wing.part", "'x'", "choose one of tube"]),
    ('published_statics.links=["XX"]', ["published_statics.links", "'XX'", "choose one of GF"]),
    ("joints.A.type=weld", ["joints.A.type", "'weld'", "'revolute', 'pin-in-slot' or 'slider'"]),
    ("parts.tube.shape=cone", ["parts.tube.shape", "'cone'", "'tube', 'bar'", "choose"]),
    ("checks.strength.type=x", ["checks.strength.type", "'x'", "'safety-factor', 'displacement'", "choose"]),
    ("drive.transfer=glue", ["drive.transfer", "'glue'", "'eye-faces' or 'bore-shear'"]),
    # links, joints, mobility
    ('links.GF.points={G=["0 mm","0 mm"]}', ["links.GF.points", "has 1", "at least 2", "add"]),
    (
        'links.X={layer=0,points={A=["0 mm","0 mm"],B=["9 mm","0 mm"]}}',
        ["links.X", "no joint", "nothing holds it", "add a joint"],
    ),
    ("links.GF.ground=true", ["2 links have ground = true (AG, GF)", "exactly one"]),
    ("links.AG.ground=false", ["0 links have ground", "exactly one"]),
    ('joints.A.links=["AG"]', ["joints.A.links", "['AG']", "too few values", "add"]),
    ('joints.A.links=["AG","AG"]', ["joints.A", "to itself", "two different links"]),
    ('joints.Z={links=["AG","CH"], points=["A","H"]}', ["mobility -1", "1 drive", "equal", "add or remove"]),
    ('joints.D.type="pin-in-slot"', ["mobility 2", "1 drive", "equal"]),
    # sizes
    ("parts.tube.outer_diameter=0 mm", ["parts.tube.outer_diameter", "'0 mm'", "greater than zero", "larger"]),
    ("parts.tube.inner_diameter=-1 mm", ["parts.tube.inner_diameter", "'-1 mm'", "must not be negative"]),
    ("joints.A.pin_diameter=0 mm", ["joints.A.pin_diameter", "'0 mm'", "greater than zero"]),
    ("joints.A.pin_diameter=8 mm", ["links.AE", "pin hole at A", "less than eye_diameter 8 mm", "reduce"]),
    (
        "parts.tube.inner_diameter=5 mm",
        ["parts.tube", "inner_diameter 5 mm", "less than outer_diameter 5 mm", "reduce"],
    ),
    ("parts.tube.eye_diameter=5 mm", ["parts.tube", "eye_diameter 5 mm", "greater than", "increase"]),
    ("parts.tube.eye_thickness=5 mm", ["parts.tube", "eye_thickness 5 mm", "at least", "6.64 mm"]),
    (
        'parts.tube={shape="bar", material="pvc-u", width="6 mm", thickness="4 mm", eye_thickness="5 mm", '
        'fillet_radius="1 mm"}',
        ["parts.tube", "eye_thickness 5 mm", "step", "6.05 mm", "leave it out"],
    ),
    ("links.CF.holes.0.diameter=5 mm", ["links.CF", "set diameter below 5 mm"]),
    ("links.CF.holes.0.first=-30 mm", ["links.CF", "-30 mm", "between x = 0.5 and 149.5 mm", "change first"]),
    ("links.CF.holes.0.last=60 mm", ["links.CF", "60 mm", "eye or fillet at B", "keep it more than 5.3 mm"]),
    ("links.CF.holes.0.count=0", ["links.CF.holes.0.count", "(it is 0)", "greater than 0", "larger"]),
    ("links.CF.holes.0.count=2.5", ["links.CF.holes.0.count", "2.5", "whole number"]),
    ("links.CF.holes.0.count=201", ["links.CF.holes.0.count", "201", "at most 200", "smaller"]),
    ("links.CH.end_patch=60 mm", ["links.CH", "patch of H", "the eye at D", "set end_patch below 42.2 mm"]),
    ("solid.mesh_size=0", ["solid.mesh_size", "(it is 0)", "at least 0.1", "larger"]),
    ("load_cases.weight.gravity=-1 m/s^2", ["load_cases.weight.gravity", "must not be negative"]),
    ("load_cases={}", ["load_cases", "has 0", "at least 1", "add"]),
    ("links={}", ["links", "has 0", "at least 2", "add"]),
    # not a number
    ("checks.strength.minimum=nan", ["checks.strength.minimum", "nan", "finite"]),
    ("checks.strength.minimum=inf", ["checks.strength.minimum", "inf", "finite"]),
    ("pose.angle=nan deg", ["pose.angle", "nan deg", "finite"]),
    ("pose.angle=1e999 deg", ["pose.angle", "1e999", "finite"]),
    ("joints.A.pin_diameter=inf", ["joints.A.pin_diameter", "inf", "unit"]),
    ("parts.tube.outer_diameter=1e308 km", ["parts.tube.outer_diameter", "1e308 km", "at most 1e+20 mm"]),
    ("published_statics.reactions=[nan]", ["published_statics.reactions.0", "nan", "finite"]),
    # wrong kinds of values
    (
        f"claims=[{{name='a',source='s',published='1',quantity='{501 * chr(49)}'}}]",
        ["claims.0.quantity", "at most 500", "less"],
    ),
    ("title=5", ["title", "(it is 5)", "text", "quotes"]),
    ("links.GF=1", ["links.GF", "(it is 1)", "table", "[links.GF]"]),
    ("links=[]", ["links", "(it is [])", "table"]),
    ("parts.tube=3", ["parts.tube", "(it is 3)", "table"]),
    ('parts.tube={material="pvc-u"}', ["parts.tube.shape", "missing", "add it"]),
    ("drive=", ["drive", "(it is '')", "table"]),
    ("pose.near=3 deg", ["pose.near", "'3 deg'", "table"]),
    ("links.GF.points.F=50 mm", ["links.GF.points.F", "'50 mm'", "list", '["50 mm", ...]']),
    ('links.GF.points.F=["50 mm"]', ["links.GF.points.F", "['50 mm']", "too few"]),
    ('load_cases.weight.forces.0.force=["0 N"]', ["load_cases.weight.forces.0.force", "has 1", "at least 2"]),
    ("load_cases.weight.forces.0.force=1 N", ["load_cases.weight.forces.0.force", "'1 N'", "list"]),
    ("load_cases.weight.own_weight=maybe", ["load_cases.weight.own_weight", "'maybe'", "true or false"]),
    ('published_statics.reactions=["a"]', ["published_statics.reactions.0", "'a'", "number without unit"]),
    ("title=1979-05-27", ["title", "text"]),
    ("schema_version=[]", ["schema_version", "[]", "write schema_version = 1"]),
    # names
    ("links.GF.part=../../etc/passwd", ["links.GF.part", "../../etc/passwd", "letters, digits", "rename"]),
    ("links.GF.part=<script>alert(1)</script>", ["links.GF.part", "<script>", "letters, digits"]),
    ('links.GF.part="a\'b"', ["links.GF.part", "letters, digits"]),
    ('links.GF.part="a\\nb"', ["links.GF.part", "letters, digits"]),
    ('links.GF.part="a\\u0000b"', ["links.GF.part", "letters, digits"]),
    ('links.GF.part="tube "', ["links.GF.part", "ends without a space"]),
    ("links.GF.part=" + "x" * 65, ["links.GF.part", "64 characters"]),
    ('links.GF.part=""', ["links.GF.part", "letters, digits"]),
    ('links.<b>={points={A=["0 mm","0 mm"],B=["1 mm","0 mm"]}}', ["links.<b>", "letters, digits", "rename"]),
    ('title="\\u001b[2J"', ["title", "control characters", "remove"]),
    ('title="\\u0007"', ["title", "control characters"]),
    ('links.GF.points.F=["5 \\u001b[2J", "0 mm"]', ["links.GF.points.F.0", "finite number and its unit"]),
    # materials
    (
        'materials.m={title="m",density="1 g/cm^3",yield_strength="60 MPa",strength="yield",sources={}}',
        ["materials.m.youngs_modulus, materials.m.poissons_ratio, materials.m.status: these entries are missing; add"],
    ),
    (
        'materials.m={title="m",density="1 g/cm^3",youngs_modulus="2 GPa",poissons_ratio=0.3,yield_strength="60 MPa",'
        'ultimate_strength="50 MPa",strength="yield",sources={},status={}}',
        ["materials.m", "yield_strength 60 MPa", "above ultimate_strength 50 MPa", "check the units"],
    ),
]


@pytest.mark.parametrize(("override", "words"), BAD, ids=[override[:50] for override, _ in BAD])
def test_bad_input_ends_in_one_sentence(override: str, words: list[str]) -> None:
    text = refusal(edited, OWL, [override])
    for word in words:
        assert word in text, text
    # A remedy: the sentence goes on after a semicolon, or a colon besides the one after the entry.
    assert ";" in text or text.count(": ") > 1, text


def test_disconnected_links() -> None:
    text = refusal(
        edited,
        OWL,
        [
            'links.x={layer=0,points={P=["0 mm","0 mm"],Q=["9 mm","0 mm"]}}',
            'links.y={layer=0,points={P=["0 mm","0 mm"],Q=["9 mm","0 mm"]}}',
            'joints.P={links=["x","y"]}',
            'joints.Q={links=["x","y"]}',
        ],
    )
    assert "links.x: no chain of joints connects it to the ground link 'AG'; add the missing joint" in text


def test_two_diameters_in_one_hole() -> None:
    text = refusal(
        edited,
        OWL,
        [
            'links.X={layer=0,points={P=["0 mm","0 mm"],Q=["50 mm","0 mm"]}}',
            'links.Y={layer=0,points={Q=["0 mm","0 mm"],R=["50 mm","0 mm"]}}',
            'joints.P={links=["CH","X"],points=["D","P"],pin_diameter="2 mm"}',
            'joints.Q={links=["X","Y"]}',
            'joints.R={links=["AG","Y"],points=["A","R"]}',
        ],
    )
    assert "joints.P.pin_diameter: it differs from that of joint 'D'" in text
    assert "link 'CH'; give both the same diameter" in text


# ---- overrides ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("override", "found"),
    [
        ("pose.angle=180 deg", lambda case: case.pose.angle == pytest.approx(3.141592653589793)),
        ('pose.angle="180 deg"', lambda case: case.pose.angle == pytest.approx(3.141592653589793)),
        (" pose . angle =  180 deg ", lambda case: case.pose.angle == pytest.approx(3.141592653589793)),
        ("title=A wing = a wing", lambda case: case.title == "A wing = a wing"),
        ('title="with # sign"', lambda case: case.title == "with # sign"),
        ("solid.curved=false", lambda case: case.solid.curved is False),
        ("solid.curved=no", lambda case: case.solid.curved is False),
        ("solid.curved=1", lambda case: case.solid.curved is True),
        ('links.CF.holes.1.count="3"', lambda case: case.links["CF"].holes[1].count == 3),
        ("links.CF.holes.1.count=3.0", lambda case: case.links["CF"].holes[1].count == 3),
        ("solid.mesh_size=2", lambda case: case.solid.mesh_size == 2.0),
        ("links.CF.holes.1.count=3", lambda case: case.links["CF"].holes[1].count == 3),
        ("load_cases.weight.forces.0.at=D", lambda case: case.load_cases["weight"].forces[0].at == "D"),
        ("pose.near.GF=228 deg", lambda case: case.pose.near["GF"] == pytest.approx(3.97935069)),
        ("drive.transfer=bore-shear", lambda case: case.drive.transfer == "bore-shear"),
        ("large_displacement=off", lambda case: case.large_displacement == "off"),
        ('joints."A".pin_diameter=2 mm', lambda case: case.joints["A"].pin_diameter == 2.0),
        ("joints.'A'.pin_diameter=2 mm", lambda case: case.joints["A"].pin_diameter == 2.0),
        ("published_statics.rhs.14=0.5", lambda case: case.published_statics.rhs["14"] == 0.5),
    ],
)
def test_overrides_reach_their_entry(override: str, found: object) -> None:
    case = read_case(OWL, [override])
    assert found(case)  # type: ignore[operator]


def test_the_last_override_wins_and_the_built_in_case_stays() -> None:
    assert read_case(OWL, ["title=one", "title=two"]).title == "two"
    assert read_case(OWL).title.startswith("Owl-wing prosthesis")


@pytest.mark.parametrize("override", ["", "=", "pose", "=5", "a..b=1", ".=1", " =1", "pose.=1", ".angle=1"])
def test_overrides_that_are_none(override: str) -> None:
    text = sentence(OWL, [override])
    assert text.startswith("--set")
    assert "write it as path=value" in text


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("title.x=1", ["--set title.x", "'title' is a value", "correct the path"]),
        ("links.CF.holes.7.count=1", ["--set links.CF.holes.7.count", "'7'", "2 entries", "the first one is 0"]),
        ("links.CF.holes.-1.count=1", ["'-1'", "2 entries"]),
        ("links.CF.holes.x.count=1", ["'x'", "2 entries"]),
        ("links.CF.holes.²=1", ["2 entries"]),
        ("links.CF.holes." + "9" * 5000 + "=1", ["2 entries"]),
        ("x=" + "1" * 5000, ["x: this key is unknown"]),
        ("x=" + "[" * 3000, ["x: this key is unknown"]),
        ("x\x1b[2J=1", ["this key is unknown"]),
        ("\n=1", ["write it as path=value"]),
        (".".join("a" * 3000) + "=1", ["nested too deeply"]),
    ],
)
def test_overrides_that_lead_nowhere(override: str, words: list[str]) -> None:
    text = sentence(OWL, [override])
    for word in words:
        assert word in text


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("load_cases.wieght.own_weight=true", ["'load_cases' has no 'wieght' to change; did you mean 'weight'?"]),
        ("load_cases.wieght={own_weight=true}", ["'load_cases' has no 'wieght'", "did you mean 'weight'?"]),
        (
            'checks.slim={type="displacement"}',
            ["'checks' has no 'slim'", "or add 'slim' to the case file"],
        ),
        ('links.CH.points.h=["90 mm", "0 mm"]', ["'links.CH.points' has no 'h'", "did you mean 'H'?"]),
        ("parts.tub.outer_diameter=6 mm", ["'parts' has no 'tub'", "did you mean 'tube'?"]),
        ("load_case.weight.own_weight=true", ["load_case: this key is unknown; did you mean 'load_cases'?"]),
        ("solid.mesh_sise=2", ["solid.mesh_sise: this key is unknown; did you mean 'mesh_size'?"]),
        ("checks.strength.minimun=2", ["checks.strength.minimun", "did you mean 'minimum'?"]),
        ("links.CF.holes.0.cuont=2", ["links.CF.holes.0.cuont", "did you mean 'count'?"]),
        ("load_cases.weight.forces.0.frce=1 N", ["load_cases.weight.forces.0.frce", "did you mean 'force'?"]),
    ],
)
def test_a_mistyped_override_changes_nothing_and_names_what_was_meant(override: str, words: list[str]) -> None:
    text = sentence(OWL, [override])
    for word in words:
        assert word in text


@pytest.mark.parametrize(
    ("table", "right", "wrong"),
    [
        ("parts.tube", "outer_diameter", "outer_diametre"),
        ("parts.tube", "shape", "shap"),  # the kind itself, without which nothing else is known of the table
        ("checks.strength", "type", "typ"),
        ("links.GF", "points", "point"),
        ("joints.A", "links", "Links"),
        ("load_cases.weight.forces.0", "force", "froce"),
        ("", "load_cases", "loadcases"),
        ("", "schema_version", "schema_verion"),
    ],
)
def test_a_mistyped_key_is_named_rather_than_the_one_that_it_leaves_missing(table: str, right: str, wrong: str) -> None:
    data = tomllib.loads(read_text(OWL)[0])
    here: Any = data
    for key in table.split(".") if table else ():
        here = here[int(key) if isinstance(here, list) else key]
    here[wrong] = here.pop(right)
    place = f"{table}.{wrong}" if table else wrong
    assert refusal(validate, data) == f"{place}: this key is unknown; did you mean '{right}'?"


@given(st.text(max_size=40))
def test_any_override_is_taken_or_explained(override: str) -> None:
    said = "taken"
    try:
        read_case(OWL, [override])
    except CaseError as error:
        said = str(error)
    assert said.isprintable()


def test_a_name_that_does_not_print_is_offered_to_nobody(tmp_path: Path) -> None:
    """The fuzzer's case: the rules of the ornithopter set points of the crank, and a link has almost its name."""
    text = read_text("ornithopter")[0]
    assert "[links.crank]" in text
    for renamed, offered in (('"crank\\u0000"', False), ("cranks", True)):
        file = _file(tmp_path, text.replace("[links.crank]", f"[links.{renamed}]").encode())
        with pytest.raises(CaseError, match=r"ornithopter sets links\.crank") as caught:
            read_case(str(file))
        assert str(caught.value).isprintable()
        assert ("did you mean" in str(caught.value)) is offered


# ---- files -------------------------------------------------------------------------------------------------


def _file(folder: Path, content: bytes, name: str = "case.toml") -> str:
    path = folder / name
    path.write_bytes(content)
    return str(path)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ["empty", "alula new"]),
        (b" \n\t\n", ["empty"]),
        (bytes(range(256)), ["not UTF-8", "save it as UTF-8"]),
        (b"\xff\xfet\x00i\x00t\x00", ["not UTF-8"]),
        (b"a" * (LARGEST_FILE + 1), ["larger than 1 MiB"]),
        (b"title = = 1\n", ["not valid TOML", "line 1", "correct that line"]),
        (b'title = "a\nb = 1\n', ["line 1", "correct that line"]),
        (b'b = 1\ntitle = """a', ["at end of document", "correct the end of the file, where something is left open"]),
        (b"a = 1\nb = 2\na = 2\n", ["not valid TOML", "line 3", "takes a heading or an entry once"]),
        (b"[links.a]\nb = 1\n[links.a]\nc = 2\n", ["('links', 'a') twice (at line 3", "under the one that is there"]),
        (b"a = " + b"1" * 5000, ["not valid TOML"]),
        (b"a = " + b"[" * 100_000, ["nested too deeply"]),
        (b"title = 'no version'", ["schema_version: it is missing", "write schema_version = 1"]),
        (b"schema_version = 1", ["title, links, joints: these entries are missing; add them"]),
        (b"\x00", ["not valid TOML"]),
    ],
    ids=lambda x: repr(x[:12]) if isinstance(x, bytes) else "",
)
def test_files_that_are_no_case(tmp_path: Path, content: bytes, words: list[str]) -> None:
    text = sentence(_file(tmp_path, content))
    for word in words:
        assert word in text, text


@pytest.mark.parametrize("name", ["", ".", "..", "nowhere.toml", "a\0b", "x" * 5000, "\x1b[2J", "owl-wing-static.toml"])
def test_names_of_no_file(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = sentence(name)
    assert text.startswith("case '")
    assert OWL in text  # what can be named instead


def test_a_folder_says_so(tmp_path: Path) -> None:
    assert "it is a folder; give a path to a case file" in sentence(str(tmp_path))


def test_a_file_that_may_not_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = _file(tmp_path, b"title = 'x'")

    def refuse(self: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refuse)
    text = sentence(name)
    assert "it cannot be read (Permission denied); check its permissions" in text


def test_a_device_or_pipe_is_no_case_and_is_not_waited_for(tmp_path: Path) -> None:
    pipe = str(tmp_path / "pipe")
    os.mkfifo(pipe)
    assert "it is no regular file" in sentence(pipe)
    assert "it is no regular file" in sentence(os.devnull)


def test_odd_file_names_are_shown_cleaned(tmp_path: Path) -> None:
    text = sentence(_file(tmp_path, b"x = = 1", "a\n\x1b[2Jb.toml"))
    assert text.startswith("a??[2Jb.toml: this is not valid TOML")


def test_a_case_on_disk_equals_the_built_in_one(tmp_path: Path) -> None:
    text, where = read_text(OWL)
    assert where == OWL
    from_disk = read_case(_file(tmp_path, text.encode()))
    assert from_disk == read_case(OWL)
    assert isinstance(from_disk, Case)


def test_byte_order_mark(tmp_path: Path) -> None:
    """Windows editors put one; the case is read nevertheless."""
    text, _ = read_text(OWL)
    assert read_case(_file(tmp_path, b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())).title.startswith("Owl")


def test_built_in_cases_are_all_valid() -> None:
    assert OWL in built_in_cases()
    for name in built_in_cases():
        read_case(name).solve_pose()


@pytest.mark.parametrize("name", built_in_cases())
def test_no_description_of_a_case_to_start_from_tells_a_result_of_it(name: str) -> None:
    """A copy keeps its words when its entries change. Where no source stands behind it, it repeats no number either."""
    case = read_case(name)
    assert not re.search(r"\b(pass|fail|undecided|verdict|safety factor|dead point|MPa)", case.description)
    if not case.source:
        assert not re.search(r"\b\d", f"{case.title} {case.description}")


def test_validate_leaves_its_tables_unchanged() -> None:
    data = {"schema_version": 1, "title": "x", "links": {"a": {"points": {}}}}
    with pytest.raises(CaseError):
        validate(data)  # type: ignore[arg-type]
    assert data == {"schema_version": 1, "title": "x", "links": {"a": {"points": {}}}}


# ---- companions --------------------------------------------------------------------------------------------


def test_companions_of_built_in_and_own_cases(tmp_path: Path) -> None:
    assert read_companion(OWL, "owl-wing-statics-exact.csv").startswith("RAx,RAy")
    case = _file(tmp_path, b"")
    _file(tmp_path, "RAx é".encode(), "m.csv")
    assert read_companion(case, "m.csv") == "RAx é"


@pytest.mark.parametrize(
    "name",
    [
        *["", ".", "..", "../secret.csv", "/etc/passwd", "sub/m.csv", ".hidden", "a\0b", "x" * 5000, "nowhere.csv"],
        *["binary.csv", "huge.csv", "folder", "\x1b[2J"],
    ],
)
@pytest.mark.parametrize("built_in", [True, False])
def test_companions_that_are_none(tmp_path: Path, name: str, built_in: bool) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "secret.csv").write_text("1")
    inner = tmp_path / "cases"
    inner.mkdir()
    _file(inner, b"\xff\xfe", "binary.csv")
    _file(inner, b"1" * (LARGEST_FILE + 1), "huge.csv")
    (inner / "folder").mkdir()
    case = OWL if built_in else _file(inner, b"")
    with pytest.raises(CaseError, match="beside the case file") as caught:
        read_companion(case, name)
    assert str(caught.value).isprintable()


def test_a_part_may_stand_for_another_by_its_name() -> None:
    """Every link of it is made of that one, whatever the order of the overrides; both names may change places."""
    rod = read_case(OWL, ["parts.tube.fillet_radius=0.5 mm", "parts.tube=rod-4mm"])
    assert [rod.body(link).part.section.width for link in rod.checked_links] == [4.0] * 5
    assert rod.parts["tube"].fillet_radius == 0.5
    assert rod.parts["rod-4mm"].fillet_radius == 0.8
    swapped = read_case(OWL, ["parts.tube=rod-4mm", "parts.rod-4mm=tube"])
    assert swapped.parts["rod-4mm"].section.width == 5.0
    assert "choose among rod-4mm, tube" in sentence(OWL, ["parts.tube=rod-5mm"])
