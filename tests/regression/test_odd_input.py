"""What a user may type or have set: each time one sentence and the status that goes with it, or the usual output."""

import errno
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast
from unittest.mock import patch

import programs
import pytest
import typer

import alula
from alula.fea.sizing.candidates import Objective
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, read_text, validate
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants
from alula.loads.text.nesting import DEEPEST
from alula.reports.commands import ending, size
from alula.reports.commands.cli import app
from alula.reports.notebook.check_report import CheckReport

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


def _options(command: Any, *path: str) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield every option that names a folder, with the command that has it."""
    for name, inner in getattr(command, "commands", {}).items():
        yield from _options(inner, *path, name)
    yield from (
        (path, one.opts[-1]) for one in getattr(command, "params", ()) if {"--output", "--pictures"} & {*one.opts}
    )


FOLDERS = [*_options(typer.main.get_command(app))]


@pytest.mark.parametrize(("command", "option"), FOLDERS, ids=[" ".join((*path, name)) for path, name in FOLDERS])
def test_a_folder_without_a_name(command: tuple[str, ...], option: str, tmp_path: Path) -> None:
    """It meant the current folder, into which the files went."""
    told = refused(*command, "four-bar", option, "", folder=tmp_path)
    assert told == "alula: output: the name of the folder is empty; name a folder, or '.' for the current one\n"
    assert not list(tmp_path.iterdir())


def test_a_folder_without_a_name_in_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    report = CheckReport(cast(Any, None))  # refused before it is looked at
    for call in (
        lambda: report.write(""),
        lambda: alula.study(CASE, {"pose.angle": ["9 deg"]}, ""),
        lambda: alula.size(CASE, {T: "9 mm..10 mm"}, folder=""),
    ):
        with pytest.raises(CaseError, match="the name of the folder is empty"):
            call()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", [("check",), ("open", "--no-browser")])
def test_a_case_in_a_folder_that_may_not_be_entered(
    command: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One command said that there is no such file, the other to free space on the disk."""
    place, stat = tmp_path / "lock" / "f.toml", Path.stat

    def refuse(path: Path, **options: Any) -> Any:
        if path == place:
            raise PermissionError(13, "Permission denied", str(path))
        return stat(path, **options)

    monkeypatch.setattr(Path, "stat", refuse)
    told = refused(command[0], str(place), *command[1:], folder=tmp_path)
    assert told.endswith("it cannot be read (Permission denied); check its permissions\n")


@pytest.mark.parametrize(
    ("number", "remedy"),
    [
        (errno.ENOSPC, "free space on the disk or choose another place"),
        (errno.EACCES, "check its permissions or choose another place"),
        (errno.EIO, "choose another place"),
    ],
)
def test_the_remedy_for_a_file_that_fails(number: int, remedy: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Any failure was told to be a full disk."""

    def fail() -> None:
        raise OSError(number, "broken", "a.csv")

    with pytest.raises(SystemExit) as stop, patch.object(ending, "end_cleanly_on_signals"):
        ending.run(fail)
    assert (stop.value.code, capsys.readouterr().err) == (4, f"alula: 'a.csv' failed (broken); {remedy}\n")


@pytest.mark.parametrize("name", ["COLUMNS", "LINES"])
@pytest.mark.parametrize("size", ["0", "00", "-3", "abc", "1e3", "²", "9" * 5000, ""])
def test_a_terminal_of_no_size(name: str, size: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing at all was printed in 0 columns, and digits that Python does not count with ended as a fault."""
    monkeypatch.delenv(name, raising=False)
    usual = programs.inside("materials")
    monkeypatch.setenv(name, size)
    assert programs.inside("materials").stdout == usual.stdout != ""


def test_a_terminal_of_one_column_shows_every_word(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = programs.inside("materials", "pom-c").stdout.split()
    monkeypatch.setenv("COLUMNS", "1")
    assert programs.inside("materials", "pom-c").stdout.split() == usual


@pytest.mark.parametrize("command", ["check", "envelope", "claims", "tolerance"])
def test_a_limit_of_memory_below_what_is_held_already(command: str) -> None:
    """It had no effect where no solid was solved."""
    told = refused(command, CASE, "--memory", "1 MB")
    assert re.fullmatch(
        r"alula: memory: it is '1 MB', but alula and its libraries hold \d+ MB before anything is solved; "
        r'write more, for example "4 GB"\n',
        told,
    )


def test_an_entry_that_is_varied_and_set() -> None:
    """What was set had no effect."""
    told = refused("size", CASE, "--vary", f"{T}=9 mm..10 mm", "--set", f"{W}=9 mm", "--set", f"{T}=9 mm")
    assert told == f"alula: size: '{T}' is varied and set; leave one of the two out\n"


def test_what_shall_be_least_is_refused_after_one_variant() -> None:
    """All of them were computed first."""
    result = SimpleNamespace(state="done", numbers=[SimpleNamespace(quantity="mass")])
    search = cast(Any, SimpleNamespace(at=lambda points, fidelity, *, roughly: [result for _ in points]))
    for name in ("mass", "safety factor"):
        size._require_number(search, {}, Objective(quantity=name))
    with pytest.raises(CaseError, match=r"^size: no variant has the number 'cost'; choose among mass$"):
        size._require_number(search, {}, Objective(quantity="cost"))


def test_the_old_name_of_threads(tmp_path: Path) -> None:
    """``--workers`` of study and size meant what is called ``--threads`` elsewhere; here nothing varies."""
    for command in ("study", "size"):
        asked = (command, CASE, "-o", "out", "--workers", "1")
        warned, told = programs.inside(*asked, folder=tmp_path).stderr.splitlines()
        assert warned.startswith("Warning: --workers is called --threads now")
        assert "nothing varies" in told
        assert "is the old name of --threads" in refused(*asked, "--threads", "1", folder=tmp_path)
    for call in (alula.study, alula.size):
        with pytest.warns(FutureWarning, match="workers is called threads now"), pytest.raises(CaseError):
            call(CASE, {}, folder=tmp_path / "out", workers=1)  # type: ignore[operator]


@pytest.mark.parametrize(
    ("entry", "value"), [("layer_spacing", "9 mm"), ("washer", "1 mm"), ("checks", {"near": {"type": "clearance"}})]
)
@pytest.mark.parametrize("rename", ["base plate", "Grundplatte"])
def test_what_is_advised_bears_the_names_of_the_case(entry: str, value: object, rename: str) -> None:
    """It spoke of a link A where none was called so."""
    text = read_text("four-bar-synthesis")[0]
    text = text.replace("links.d]", f'links."{rename}"]').replace('["d", ', f'["{rename}", ')
    tables = tomllib.loads(re.sub(r'\bd = "', f'"{rename}" = "', text))  # the fits of its holes
    del tables["layer_spacing"], tables["checks"]
    for link in tables["links"].values():
        del link["layer"]
    with pytest.raises(CaseError) as error:
        validate(tables | {entry: value})
    shown = f'"{rename}"' if " " in rename else rename
    assert f"such as links.{shown}.layer = 0" in str(error.value)


def test_what_a_card_lacks_is_asked_for_with_the_line_to_write() -> None:
    """It said "add them" alone, and no one knew of what form."""
    tables = tomllib.loads(read_text(CASE)[0])
    card = {"title": "Own", "density": "1 g/cm^3", "youngs_modulus": "3 GPa", "poissons_ratio": 0.3}
    card |= {"yield_strength": "40 MPa", "strength": "yield"}
    with pytest.raises(CaseError) as error:
        validate(tables | {"materials": tables["materials"] | {"own": card}})
    told = str(error.value)
    lines = re.findall(r"(?:sources|status) = \{[^}]*\}", told)
    assert told.startswith("materials.own.sources, materials.own.status: these entries are missing; add them: write ")
    assert len(lines) == 2
    written = {name: value for line in lines for name, value in tomllib.loads(line).items()}
    assert validate(tables | {"materials": tables["materials"] | {"own": card | written}}).materials
