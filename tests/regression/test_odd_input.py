"""What a user may type or have set: each time one sentence and the status that goes with it, or the usual output."""

from pathlib import Path

import programs
import pytest

from geometry.base.errors import CaseError
from loads.case.case_file import read_case, validate
from loads.plans.plan import plan_of
from loads.plans.variants import Variants
from loads.text.nesting import DEEPEST

CASE = "four-bar-synthesis"
DOTS = ".".join(["a"] * 500)
BRACKETS = "[" * 200 + "]" * 200
TABLES = "{a=" * 100 + "1" + "}" * 100


def refused(*arguments: str) -> str:
    """Return the sentence with which the command refuses its input."""
    done = programs.inside(*arguments)
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
