"""A case composed in Python states what its file would: the same models, units and sentences."""

import pickle
import tomllib
from functools import reduce
from importlib.resources import files
from pathlib import Path

import numpy as np
import pint
import pytest

import alula
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.case_file import built_in_cases, folder_of, read_case, read_tables
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants

UNITS = pint.UnitRegistry()  # a user's own
NAMED = {
    "links": "with_link", "joints": "with_joint", "parts": "with_part", "materials": "with_material",
    "load_cases": "with_load_case", "checks": "with_check", "springs": "with_spring", "tendons": "with_tendon",
    "stops": "with_stop", "hand_calculations": "with_hand_calculation",
}  # fmt: skip
ORIGIN = {"O": ("0 mm", "0 mm")}
PUSH = {"link": "lever", "at": "P", "force": ("0 N", "-5 N")}
BAR = {"shape": "bar", "material": "aluminium-6061-t6", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}


def composed(tables, folder=""):
    """Compose a case entry by entry."""
    case = alula.Case(folder=folder)
    for table, value in tables.items():
        if table in NAMED:
            add = NAMED[table]
            case = reduce(lambda here, item: getattr(here, add)(item[0], **item[1]), value.items(), case)
        elif table != "schema_version":
            case = case.with_entries(**{table: value})
    return case


@pytest.fixture(scope="module")
def lever():
    case = alula.Case("Lever").with_link("base", ground=True, points=ORIGIN)
    case = case.with_link("lever", part="bar", points={**ORIGIN, "P": ("60 mm", "0 mm")})
    case = case.with_joint("O", links=("base", "lever"), pin_diameter="3 mm").with_part("bar", **BAR)
    case = case.with_pose(coordinate="lever", angle="0 deg").with_drive(link="lever", joint="O")
    return case.with_load_case("grip", forces=[PUSH])


@pytest.mark.parametrize("name", built_in_cases())
def test_a_built_in_case_is_composed_and_written_as_it_stands_in_its_file(name, tmp_path):
    """Equal also where files of parts are named from another folder."""
    case = composed(read_tables(name), folder_of(name))
    assert case == alula.read_case(name) == read_case(name)
    assert alula.Case.from_dict(tomllib.loads(case.to_toml())) == case
    case.to_toml(tmp_path / "copy.toml")
    assert alula.read_case(tmp_path / "copy.toml") == case


def test_a_part_below_the_folder_is_named_from_there(tmp_path, monkeypatch):
    (tmp_path / "parts").mkdir()
    step = files("alula.loads.cases").joinpath("bell-crank.step").read_bytes()
    (tmp_path / "parts" / "crank.step").write_bytes(step)
    [part] = [name for name, one in read_tables("step")["parts"].items() if one["shape"] == "step"]
    monkeypatch.chdir(tmp_path)
    path = Path("parts/crank.step")
    entries = read_tables("step")["parts"][part] | {"file": path}
    case = alula.read_case("step").with_part(part, replace=True, **(entries | {"file": tmp_path / path}))
    assert case.to_dict()["parts"][part]["file"] == "parts/crank.step"
    assert 'file = "crank.step"' in case.to_toml("parts/case.toml")
    assert alula.read_case("parts/case.toml") == case
    plan = case.with_entries(title="on/off").of_study() | {"vary": {"load_cases.pull.scatter": ["0 %", "10 %"]}}
    assert [file.read_bytes() for file in Variants(plan_of(plan), Path()).files.values()] == [step]


def test_quantities_and_arrays_are_what_their_text_is(lever):
    case = alula.Case("Lever").with_link("base", ground=True, points={"O": np.zeros(2, dtype=int)})
    case = case.with_link("lever", part="bar", points={"O": np.zeros(2), "P": np.array([6, 0]) * UNITS.cm})
    case = case.with_joint("O", links=np.array(["base", "lever"]), pin_diameter=3 * UNITS.mm, bonded=np.False_)
    case = case.with_part("bar", **(BAR | {"width": UNITS.Quantity(np.float64(0.008), "m"), "build_direction": None}))
    case = case.with_entries(conditions={"temperature": UNITS.Quantity(23, "degC")})
    force = [0.0 * UNITS.N, -5e-3 * UNITS.kN]
    case = case.with_pose(coordinate="lever", angle=UNITS.Quantity(0.0, "rad")).with_drive(link="lever", joint="O")
    case = case.with_load_case(
        "grip", scatter=10 * UNITS.percent, forces=({"link": "lever", "at": "P", "force": force},)
    )
    same = lever.with_load_case("grip", replace=True, forces=[PUSH], scatter="10 %")
    assert case == same.with_entries(conditions={"temperature": "23 degC"})
    assert case.links["lever"].points["P"] == (60.0, 0.0)
    assert case != lever
    printed = lever.with_part("bar", replace=True, **BAR, build_direction=np.array([0.0, 0.0, 2.0]))  # has no unit
    assert printed.parts["bar"].build_direction == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda c: c.with_link("base", points=ORIGIN), "links.base: there is one of that name already"),
        (lambda c: c.with_link("x", replace=True, points=ORIGIN), "links.x: there is none to replace"),
        (lambda c: c.with_link("l/er", points=ORIGIN), "links.l/er: a name is made of letters"),
        (lambda c: c.with_link(5, points=ORIGIN), "links: the name must be text, not int"),
        (lambda c: c.with_link("x", ground=True, ponts={}, points=ORIGIN), "links.x.ponts: .* did you mean 'points'"),
        (lambda c: c.with_link("x", ground=True, points={"O": np.array([0, np.nan])}), "O.1 .it is 'nan mm'.: .*finit"),
        (lambda c: c.with_link("x", ground=True, points={"O": (0, 1)}), r"links.x.points.O.0 \(it is 0\): .* its unit"),
        (lambda c: c.with_link("x", ground=True, points={"O": {1, 2}}), "links.x.points.O: .* not set"),
        (lambda c: c.with_link("x", ground=True, points={7: ("0 mm", "0 mm")}), "points: the key must be text"),
        (lambda c: c.with_part("y", **BAR | {"width": "inf mm"}), r"parts.y.width \(it is 'inf mm'\): .* finite"),
        (lambda c: c.with_part("y", **BAR | {"width": 3 * UNITS.N}), '"N" is not a unit of length'),
        (lambda c: c.with_part("y", **BAR | {"fillet_radius": None}), "parts.y.fillet_radius: this entry is missing"),
        (lambda c: c.with_part("y", **BAR | {"build_direction": [0, 0, np.inf]}), "build_direction.2 .* finite number"),
        (lambda c: c.with_entries(titel="x"), "titel: this key is unknown; did you mean 'title'"),
        (lambda c: c.with_entries(title="a\x07"), "title .* control characters"),
        (lambda c: c.without("links.levr"), "without 'links.levr': links has no 'levr'; did you mean 'lever'"),
        (lambda c: c.without("load_cases.grip.forces.1"), "load_cases.grip.forces has no '1'"),
        (lambda c: c.without(""), "without '': the case has no ''"),
        (lambda c: c.without("drive").record, "drive"),
        (lambda c: c.without("load_cases").record, "load_cases: this entry is missing"),
        (lambda c: c.with_joint("Q", links=("base", "levr"), points=("O", "O")).record, "levr"),
        (lambda c: c.with_values({"parts.bar.width": 4 * UNITS.N}), '"N" is not a unit of length'),
        (lambda c: alula.Case("x").with_values({"title": "y"}), "links, joints: these entries are missing"),
        (lambda c: alula.Case.from_dict({"title": "x"}), "schema_version: it is missing"),
        (lambda c: alula.Case.from_dict("four-bar"), "from_dict: it takes the tables of a case"),
        (lambda c: alula.check(7), "case: it is int; give a case"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_in_the_sentence_of_the_file(lever, change, told):
    with pytest.raises(CaseError, match=told):
        change(lever)


def test_a_case_never_changes(lever):
    point = ["60 mm", "0 mm"]
    case = lever.with_link("lever", replace=True, part="bar", points={**ORIGIN, "P": point})
    point[0] = "1 mm"
    case.to_dict()["links"]["lever"]["points"]["P"][0] = "2 mm"
    assert case == lever
    assert list(case.links) == ["base", "lever"]  # one that is replaced keeps its place
    with pytest.raises(AttributeError):
        case.title = "other"
    with pytest.raises(AttributeError, match="did you mean 'title'"):
        _ = case.titel
    assert {"title", "checked_links", "with_link"} <= set(dir(case))
    assert pickle.loads(pickle.dumps(case)) == case
    assert (repr(case), case.origin) == ("Case('Lever': 2 links, 1 joint, 1 load case)", "")


def test_changes_by_path_hold_until_what_they_changed_is_stated_anew():
    case = alula.read_case("four-bar").with_values({"parts.bar.width": "9 mm", "checks.stiffness.maximum": "2 mm"})
    case = case.without("checks.strength").with_check("second", type="displacement", maximum="3 mm")
    assert case.parts["bar"].width == 9.0
    assert [check.maximum for check in case.checks.values()] == [2.0, 3.0]
    anew = case.with_check("stiffness", replace=True, type="displacement", maximum="1 mm")
    assert (anew.checks["stiffness"].maximum, anew.parts["bar"].width) == (1.0, 9.0)
    assert (case.origin, alula.read_case("four-bar").origin) == ("", "four-bar")
    assert "stiffness" not in case.without("checks.stiffness").checks
    assert alula.read_case("four-bar").with_check("third", type="safety-factor").origin == ""


def test_entries_that_a_mechanism_sets_are_not_written_as_if_they_were_free():
    changed = alula.read_case("ornithopter").with_values({"parts.rod.width": "3 mm", "pose.angle": "17 deg"})
    with pytest.raises(CaseError, match="ornithopter: this table sets entries"):
        changed.to_toml()
    free = changed.without("ornithopter")
    assert alula.Case.from_dict(tomllib.loads(free.to_toml())).parts["rod"].width == 3.0


def test_a_file_is_written_whole_and_over_another_on_request_alone(lever, tmp_path):
    file = tmp_path / "lever.toml"
    lever.to_toml(file)
    with pytest.raises(CaseError, match="is there already"):
        lever.with_entries(title="Other").to_toml(file)
    assert alula.read_case(file) == lever
    lever.with_entries(title="Other", description="two\nlines").to_toml(file, replace=True)
    assert alula.read_case(file).description == "two\nlines"
    with pytest.raises(CannotRunError, match="cannot be written: No such file"):
        lever.to_toml(tmp_path / "none" / "lever.toml", replace=True)
    with pytest.raises(CaseError, match="missing"):
        alula.Case("Lever").to_toml(tmp_path / "part.toml")
    assert [path.name for path in tmp_path.iterdir()] == ["lever.toml"]


def test_studies_and_sizes_take_a_composed_case(lever, tmp_path):
    """Its files of parts would be named from the present folder, and its title is the name of the study."""
    thick = {"parts.bar.thickness": ["4 mm", "8 mm"]}
    found = alula.study(lever, thick, tmp_path, fidelity="beam", threads=1)
    values = found.frame()["value"]
    assert values[1] == pytest.approx(2.0 * values[0], rel=1e-4)
    same = alula.study(lever.with_values({"parts.bar.width": "9 mm"}), thick, tmp_path, fidelity="beam", threads=1)
    assert same.frame()["value"][0] > values[0]  # and not what stood in the folder
    with pytest.raises(CaseError, match=r"another study \(of the case 'Lever'\)"):
        alula.study(lever.with_entries(title="Other"), thick, tmp_path, fidelity="beam", threads=1)
    sized = alula.size(lever, {"parts.bar.thickness": "4 mm..8 mm"}, step="2 mm", fidelity="beam", threads=1)
    assert [row["parts.bar.thickness"] for row in sized.table()] == ["4 mm", "6 mm", "8 mm"]


def test_tables_are_frames_where_pandas_is_installed(lever, monkeypatch):
    report = alula.check(lever.with_load_case("firm", forces=[PUSH, PUSH]), fidelity="beam")
    frame = report.frame("links")
    assert frame["load case"].tolist() == ["grip", "firm"]
    factors = frame.set_index("load case")["safety factor"]
    assert factors["grip"] == pytest.approx(2.0 * factors["firm"])
    assert list(report.frame().columns) == list(report.table().columns)
    assert report.frame("joints").shape[0] == len(report.table("joints"))
    with pytest.raises(CaseError, match="there is no table 'link'; did you mean 'links'"):
        report.frame("link")
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(CannotRunError, match=r"pip install 'alula\[pandas\]'"):
        report.frame()
