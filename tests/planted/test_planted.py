"""The kept mistakes fit the code as it is, and the command that plants them tells which tests notice."""

import ast
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from planted import __main__ as command
from planted.mistakes import ROOT, Mistake, kept

KEPT = list(kept())


def mistake(**changed: object) -> Mistake:
    entries = {
        "kind": "k",
        "file": "sum.py",
        "before": "a + b",
        "after": "a - b",
        "wrong": "w",
        "tests": ("test_sum.py",),
    }
    return Mistake(**{**entries, **changed})  # type: ignore[arg-type]


@pytest.mark.parametrize("one", KEPT, ids=str)
def test_a_kept_mistake_can_still_be_planted(one: Mistake) -> None:
    """Where its place has changed, look whether the mistake is still possible, and mend or drop its entry."""
    compile(one.planted((ROOT / one.file).read_text(encoding="utf-8")), one.file, "exec")
    assert one.tests
    for name in one.tests:
        path, _, function = name.partition("::")
        tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
        assert function in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}, name


def test_no_mistake_is_kept_twice() -> None:
    assert len({(one.file, one.before, one.after) for one in KEPT}) == len(KEPT) > 0


@pytest.mark.parametrize(("text", "places"), [("a * b", 0), ("a + b, a + b", 2)])
def test_a_place_that_is_gone_or_no_longer_the_only_one_is_told(text: str, places: int) -> None:
    with pytest.raises(ValueError, match=f"sum.py has {places} places of 'a \\+ b'"):
        mistake().planted(text)


SUM = "def total(a, b):\n    return a + b\n"
TESTS = {
    "test_sum.py": "from sum import total\ndef test_of_one_and_two():\n    assert total(1, 2) == 3\n",
    "test_nought.py": "from sum import total\ndef test_of_nought():\n    assert total(1, 0) == 1\n",
}


@pytest.mark.parametrize(
    ("tests", "status", "told"),
    [
        (("test_sum.py::test_of_one_and_two",), 0, ["noticed: sum.py: w", "    by test_sum.py::test_of_one_and_two"]),
        (("test_nought.py::test_of_nought",), 1, ["UNNOTICED: sum.py: w", "    NOT by test_nought.py::test_of_nought"]),
    ],
)
def test_the_command_tells_what_notices_and_leaves_the_checkout_alone(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tests: tuple[str, ...],
    status: int,
    told: list[str],
) -> None:
    for name, text in {"sum.py": SUM, **TESTS}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.setattr(command, "ROOT", tmp_path)
    monkeypatch.setattr(command, "kept", lambda: iter([mistake(tests=tests), mistake(file="other.py")]))
    monkeypatch.setattr(sys, "argv", ["planted", "sum"])
    assert command.main() == status
    assert capsys.readouterr().out.splitlines()[: len(told)] == told
    assert (tmp_path / "sum.py").read_text(encoding="utf-8") == SUM


def test_a_test_that_fails_anyway_notices_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], failing_always: Callable[..., list[str]]
) -> None:
    monkeypatch.setattr(command, "failing", failing_always)
    monkeypatch.setattr(command.shutil, "copytree", lambda *_, **__: None)
    monkeypatch.setattr(command, "noticing", failing_always)
    monkeypatch.setattr(command, "kept", lambda: iter([mistake()]))
    monkeypatch.setattr(sys, "argv", ["planted"])
    assert command.main() == 1
    assert "UNNOTICED" in capsys.readouterr().out


@pytest.fixture
def failing_always() -> Callable[..., list[str]]:
    return lambda *_: ["test_sum.py"]


def test_tests_that_cannot_run_are_no_notice(tmp_path: Path) -> None:
    (tmp_path / "test_broken.py").write_text("import nothing_like_this\n", encoding="utf-8")
    with pytest.raises(SystemExit, match="the tests did not run"):
        command.failing(tmp_path, ["test_broken.py"])
