"""What a user may type or have set: each time one sentence and the status that goes with it, or the usual output."""

from pathlib import Path

import programs
import pytest

from fea.study.store import Store
from geometry.base.errors import CaseError
from loads.case.case_file import read_case, validate
from loads.plans.plan import plan_of
from loads.plans.variants import Variants
from loads.text.nesting import DEEPEST

CASE = "four-bar-synthesis"
DOTS = ".".join(["a"] * 500)
BRACKETS = "[" * 200 + "]" * 200
TABLES = "{a=" * 100 + "1" + "}" * 100


def refused(*arguments: str, folder: Path | None = None) -> str:
    """Return the sentence with which the command refuses its input."""
    done = programs.inside(*arguments, folder=folder)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1), done.stderr
    return done.stderr


@pytest.mark.parametrize(
    "text", [f"[{DOTS}]", f"[[{DOTS}]]", f"[links.{DOTS}]", f"[set.{DOTS}]", f"x = {BRACKETS}", f"x = {TABLES}"]
)
@pytest.mark.parametrize("command", [("statics",), ("study", "-o", "study")], ids=["case", "plan"])
def test_tables_nested_too_deeply_in_a_file(text: str, command: tuple[str, ...], tmp_path: Path) -> None:
    """Python cannot copy them: a RecursionError, which was told as a fault of alula's own."""
    path = tmp_path / "file.toml"
    path.write_text(f'case = "{CASE}"\n{text}\n')
    assert f"file.toml: its tables and lists are nested too deeply, in more than {DEEPEST} levels" in refused(
        command[0], str(path), *command[1:]
    )


@pytest.mark.parametrize(
    "change", [f"x={{{DOTS}=1}}", f"{DOTS}=1", f"parts.bar={BRACKETS}", f"parts.bar={TABLES}", f"links.q={{{DOTS}=1}}"]
)
def test_tables_nested_too_deeply_behind_set(change: str) -> None:
    assert "its tables and lists are nested too deeply" in refused("statics", CASE, "--set", change)


def test_how_deep_tables_may_stand_in_python() -> None:
    """One more level than is read, from a dictionary and from the values of a study."""
    deep: object = 1
    for _ in range(DEEPEST):
        deep = {"a": deep}
    with pytest.raises(CaseError, match=r"^case: its tables and lists are nested too deeply"):
        validate({"x": deep})
    with pytest.raises(CaseError, match=r"^schema_version: it is missing"):
        validate({"x": deep["a"]})  # type: ignore[index]
    with pytest.raises(CaseError, match=r"^with_values x: its tables and lists are nested too deeply"):
        read_case(CASE).with_values({"x": deep})
    with pytest.raises(CaseError, match=r"^set x: its tables and lists are nested too deeply"):
        Variants(plan_of({"case": CASE, "vary": {"parts.bar.thickness": ["9 mm"]}, "set": {"x": deep}}), Path())


T, W = "parts.bar.thickness", "parts.bar.width"


@pytest.mark.parametrize(
    ("links", "circle"),
    [
        ({T: "width/2", W: "2*thickness"}, f"link {T}: it follows from {W}, which follows from {T}; "),
        ({T: "parts.bar.width/2", W: "edge", "parts.bar.edge": "thickness"}, f"{W}, which follows from parts.bar.edge"),
        ({T: "2*thickness"}, f"link {T}: it follows from itself; "),
        ({"parts.bar": "parts.bar.title"}, "link parts.bar: it follows from itself; "),
    ],
)
@pytest.mark.parametrize("turn", [1, -1])
def test_linked_entries_that_follow_from_each_other(links: dict[str, str], circle: str, turn: int) -> None:
    """They were taken one by one as they were stated, so that their order chose the values."""
    plan = plan_of({"case": CASE, "vary": {"pose.angle": ["9 deg"]}, "link": dict([*links.items()][::turn])})
    with pytest.raises(CaseError, match="it follows from") as error:
        Variants(plan, Path())
    assert circle in str(error.value) or turn == -1
    assert str(error.value).endswith("state one of the entries by a value")


@pytest.mark.parametrize("turn", [1, -1])
def test_the_order_of_linked_entries_does_not_matter(turn: int) -> None:
    """Taken first, a width that follows from the thickness was twice the old one."""
    links = {T: "fillet_radius/2", W: "2*thickness"}
    plan = plan_of(
        {"case": CASE, "vary": {"parts.bar.fillet_radius": ["48 mm"]}, "link": dict([*links.items()][::turn])}
    )
    variants = Variants(plan, Path())
    bar = variants.tables(variants.points[0])["parts"]["bar"]
    assert (bar["thickness"], bar["width"]) == ("24 mm", "48 mm")


@pytest.mark.parametrize("begun", ["", "tables"])
@pytest.mark.parametrize("more", [[], ["--json"], ["-o", "pictures"], ["--csv", "all.csv"]])
def test_a_study_that_holds_nothing(begun: str, more: list[str], tmp_path: Path) -> None:
    """An empty file had "all points that were finished"; one without a plan ended as a fault of alula's own."""
    (tmp_path / "study.sqlite").touch()
    if begun:
        with Store.writing(tmp_path):
            pass
    told = refused("study", "show", str(tmp_path), *more, folder=tmp_path)
    assert told.startswith(f"alula: '{tmp_path}' holds no study yet: study.sqlite has no plan and no point; compute")
    assert not {"pictures", "all.csv"} & {path.name for path in tmp_path.iterdir()}
