"""Cases that are composed in Python of odd values, changed in odd orders, and used from elsewhere."""

import copy
import os
import pickle
import tomllib
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

import numpy as np
import pandas
import pint
import pytest

import alula
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.reports.study.page import write_study

UNITS = pint.UnitRegistry()
BAR = {"shape": "bar", "material": "aluminium-6061-t6", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}


def lever(**entries: object) -> alula.Case:
    """Return a lever on a pin."""
    case = alula.Case("Lever", **entries)
    case = case.with_link("base", ground=True, points={"O": ("0 mm", "0 mm")})
    case = case.with_link("lever", part="bar", points={"O": ("0 mm", "0 mm"), "P": ("60 mm", "0 mm")}, end_patch="8 mm")
    case = case.with_joint("O", links=("base", "lever"), pin_diameter="3 mm").with_part("bar", **BAR)
    case = case.with_pose(coordinate="lever", angle="0 deg").with_drive(link="lever", joint="O")
    return case.with_load_case("grip", forces=[{"link": "lever", "at": "P", "force": ("0 N", "-5 N")}])


def _in_itself() -> tuple[object, ...]:
    one: list[object] = []
    one += [one, one]
    array = np.empty(2, dtype=object)
    array[:] = [array, array]
    table: dict[str, object] = {}
    table["a"] = table["b"] = table
    return one, array, table


ODD = (
    *(None, {1}, (i for i in "a"), 3, 3.0, 3j, True, b"3 mm", Decimal(3), object(), range(3), 10**5000, float("nan")),
    *(
        np.array([1.0, 2.0]),
        pandas.DataFrame({"a": [1]}),
        pandas.NA,
        pandas.NaT,
        [[]],
        {"a": 1},
        {3: 4},
        "\ud800",
        "\0",
    ),
    *_in_itself(),
)
TAKERS: dict[str, Callable[[object], object]] = {
    "thickness": lambda value: lever().with_part("bar", replace=True, **(BAR | {"thickness": value})),
    "value": lambda value: lever().with_values({"parts.bar.thickness": value}),
    "values": lambda value: lever().with_values(value),  # type: ignore[arg-type]
    "point": lambda value: lever().with_link("more", part="bar", points={"A": value, "B": ("1 mm", "0 mm")}),
    "points": lambda value: lever().with_link("more", part="bar", points=value),
    "name": lambda value: lever().with_part(value, **BAR),  # type: ignore[arg-type]
    "replace": lambda value: lever().with_part("bar", replace=value, **BAR),  # type: ignore[arg-type]
    "table": lambda value: lever().with_entries(links=value),
    "folder": lambda value: alula.Case("Lever", folder=value),  # type: ignore[arg-type]
    "folder of tables": lambda value: lever().to_dict(folder=value),  # type: ignore[arg-type]
    "tables": alula.Case.from_dict,  # type: ignore[dict-item]
    "a table": lambda value: alula.Case.from_dict(lever().to_dict() | {"links": value}),
    "version": lambda value: alula.Case.from_dict(lever().to_dict() | {"schema_version": value}),
    "path": lambda value: lever().without(value),  # type: ignore[arg-type]
    "file": lambda value: lever().to_toml(value),  # type: ignore[arg-type]
    "case": alula.read_case,  # type: ignore[dict-item]
    "checked": alula.check,  # type: ignore[dict-item]
    "study": lambda value: alula.study(lever(), value, "study"),  # type: ignore[arg-type]
    "size": lambda value: alula.size(lever(), {"parts.bar.thickness": value}),  # type: ignore[dict-item]
    "ranges": lambda value: alula.size(lever(), value),  # type: ignore[arg-type]
}
TAKEN = {
    *(("thickness", "NoneType"), ("value", "NoneType"), ("points", "NoneType"), ("table", "NoneType")),
    *(("replace", "bool"), ("file", "NoneType")),
}
"""What is left out where it is None, and a truth value."""


@pytest.mark.parametrize("taker", TAKERS)
def test_odd_values_give_one_sentence(taker: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for value in ODD:
        if (taker, type(value).__name__) in TAKEN or (taker == "ranges" and value is None):
            continue
        if taker == "point" and isinstance(value, np.ndarray) and value.dtype == float:
            continue
        with pytest.raises((CaseError, CannotRunError)) as told:
            TAKERS[taker](value)
        text = str(told.value)
        assert ": " in text
        assert "\n" not in text
        assert len(text) < 600
    assert not list(tmp_path.iterdir())


def test_a_name_that_no_disk_takes_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    for name in ("", ".", "/", "folder", "x" * 300, "no/such/folder"):
        for replace in (False, True):
            with pytest.raises((CaseError, CannotRunError)):
                lever().to_toml(name, replace=replace)
    assert list(tmp_path.rglob("*")) == [tmp_path / "folder"]


def test_a_linked_file_stays_linked(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("old")
    (tmp_path / "link.toml").symlink_to("case.toml")
    lever().to_toml(tmp_path / "link.toml", replace=True)
    assert (tmp_path / "link.toml").is_symlink()
    assert alula.read_case(tmp_path / "case.toml") == lever()


def test_points_are_in_mm_wherever_they_are_stated() -> None:
    place = np.array([70.0, 0.0])
    stated = lever().to_dict()
    stated["links"]["lever"]["points"]["P"] = place
    link = {"part": "bar", "points": {"O": np.zeros(2), "P": place}, "end_patch": "8 mm"}
    for case in (
        lever().with_values({"links.lever.points.P": place}),
        lever().with_link("lever", replace=True, **link),
        lever().with_entries(links=lever().to_dict()["links"] | {"lever": link}),
        lever().with_values({"links.lever.points.P": pandas.Series(place)}),
        lever().with_values({"links.lever.points.P": place * UNITS.mm}),
        lever().with_values({"links.lever.points.P": place / 10.0 * UNITS.cm}),
        alula.Case.from_dict(stated),
    ):
        assert case.links["lever"].points["P"] == pytest.approx((70.0, 0.0))


def test_messages_of_whole_tables_name_the_entry_as_the_file_does() -> None:
    stated = lever().to_dict()
    stated["parts"]["bar"]["thickness"] = {1}
    with pytest.raises(CaseError, match=r"^parts\.bar\.thickness: "):
        alula.Case.from_dict(stated)


def test_a_case_does_not_change_with_what_it_was_made_of_or_gave() -> None:
    forces = [{"link": "lever", "at": "P", "force": ["0 N", "-5 N"]}]
    place = np.array([60.0, 0.0])
    case = lever().with_load_case("more", forces=forces).with_values({"links.lever.points.P": place})
    kept = copy.deepcopy(case)
    forces[0]["force"][1] = "-9 N"  # type: ignore[index]
    place[0] = 7.0
    case.to_dict()["links"].clear()
    case.links.pop("lever")
    case.load_cases.clear()
    assert case == kept == pickle.loads(pickle.dumps(case))
    assert case.load_cases["more"].forces[0].force == (0.0, -5.0)


def test_removing_from_a_list_keeps_changes_of_the_others() -> None:
    case = alula.read_case("spring-pedal").with_values({"load_cases.foot.forces.1.force": ["-55 N", "0 N"]})
    [force] = case.without("load_cases.foot.forces.0").load_cases["foot"].forces
    assert [*case.without("load_cases.foot.forces.0", "load_cases.foot.forces.1").load_cases["foot"].forces] == []
    assert (force.link, force.force) == ("piston", (-55.0, 0.0))


def test_what_a_change_added_can_be_removed() -> None:
    case = alula.read_case("spring-pedal")
    changed = case.with_values({"parts.rod.eye_diameter": "14 mm"})
    assert changed.without("parts.rod.eye_diameter") == case


def test_what_stands_in_a_changed_table_can_be_removed() -> None:
    case = alula.read_case("owl-wing-static").with_values({"parts.tube": "rod-4mm"})
    without = case.without("parts.tube.eye_diameter")
    assert without.parts["tube"].outer_diameter == 4.0
    assert without.parts["tube"].eye_diameter == pytest.approx(1.6 * 4.0)
    assert without.parts["rod-4mm"].eye_diameter == 8.0


def test_more_can_be_added_to_a_changed_table() -> None:
    force = {"forces": [{"link": "lever", "at": "P", "force": ["0 N", "-5 N"]}]}
    case = lever().with_values({"load_cases": {"a": force}})
    assert list(case.with_load_case("grip", **force).load_cases) == ["a", "grip"]
    with pytest.raises(CaseError, match="there is one of that name already"):
        case.with_load_case("a", **force)


def test_replacing_drops_changes_however_their_path_is_written() -> None:
    case = lever().with_values({'parts."bar".thickness': "5 mm"})
    assert case.with_part("bar", replace=True, **BAR).parts["bar"].thickness == 4.0
    assert case.without('load_cases."grip"') == case.without("load_cases.grip")


def test_what_the_ornithopter_sets_stays_when_its_table_is_removed() -> None:
    case = alula.read_case("ornithopter").with_values({"ornithopter.wing_angle": "30 deg"})
    assert case.without("ornithopter").links == case.links
    assert alula.read_case("ornithopter").links != case.links


def test_a_table_that_would_set_entries_again_is_refused(tmp_path: Path) -> None:
    case = alula.read_case("ornithopter").with_values({"links.base.points.guide": ["0 mm", "11 mm"]})
    for use in (
        case.to_dict,
        case.to_toml,
        lambda: alula.study(case, {"pose.angle": ["10 deg", "20 deg"]}, tmp_path / "study", fidelity="beam"),
    ):
        with pytest.raises(CaseError, match=r'remove it with without\("ornithopter"\)'):
            use()
    without = case.without("ornithopter")
    assert without.links == case.links
    assert alula.Case.from_dict(tomllib.loads(without.to_toml())) == without


def test_a_case_keeps_the_folder_that_it_was_made_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    step = alula.read_case("step").to_dict()
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "crank.step").write_bytes(Path(step["parts"]["bell-crank"]["file"]).read_bytes())
    step["parts"]["bell-crank"]["file"] = "parts/crank.step"
    monkeypatch.chdir(tmp_path)
    case = alula.Case.from_dict(step)
    case.to_toml("step.toml")
    read = alula.read_case("step.toml")
    (tmp_path / "elsewhere").mkdir()
    os.chdir(tmp_path / "elsewhere")
    for one in (case, read):
        assert one.with_values({"parts.bar.thickness": "6 mm"}).parts["bar"].thickness == 6.0
        assert one.to_dict()["parts"]["bell-crank"]["file"] == str(tmp_path / "parts" / "crank.step")
        one.to_toml(f"{'read' if one is read else 'made'}.toml")
        assert one == alula.read_case("made.toml")


@pytest.mark.parametrize("entry", ["title", "description"])
@pytest.mark.parametrize(
    "told",
    [
        "\nfirst",
        'a"""b\nc',
        'q"\n"',
        "a\\\nb",
        "\\",
        "é µ 漢字",
        "trail \n\n",
        "'''\n\"\"\"",
        "\\n\n\\u00e9",
        "c:\\new\nx",
    ],
)
def test_text_comes_back_from_the_file(entry: str, told: str) -> None:
    case = lever().with_entries(**{entry: told})
    assert getattr(alula.Case.from_dict(tomllib.loads(case.to_toml())), entry) == told


def test_quantities_of_pint_are_taken_by_studies_and_searches(tmp_path: Path) -> None:
    thicknesses, wider = [4 * UNITS.mm, 0.5 * UNITS.cm], {"parts.bar.width": 9 * UNITS.mm}
    path = "parts.bar.thickness"
    found = alula.study(lever(), {path: thicknesses}, tmp_path, values=wider, fidelity="beam", threads=1)
    assert [row[path] for row in found.table()] == ["4 mm", "0.5 cm"]
    sized = alula.size(lever(), {path: "4 mm..5 mm"}, step="1 mm", values=wider, fidelity="beam", threads=1)
    assert "4 mm" in str(sized)


def test_pages_name_no_file_where_there_is_none(tmp_path: Path) -> None:
    alula.check(lever(), fidelity="beam").write(tmp_path / "out")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<code></code>" not in page
    assert "alula statics CASE --matrix" in page
    case = lever().with_entries(title="four-bar")
    alula.study(case, {"parts.bar.thickness": ["5 mm", "6 mm"]}, tmp_path / "study", fidelity="beam", threads=1)
    page = write_study(tmp_path / "study", tmp_path / "out").read_text(encoding="utf-8")
    assert "alula check four-bar" not in page
