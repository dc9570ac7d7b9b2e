"""``alula tolerance`` as a user meets it: what it prints and writes, and one sentence per mistake."""

import json
from io import StringIO
from pathlib import Path

import numpy as np
import programs
import pytest
from rich.console import Console
from told import ends_of, numbers_of, values_of

import alula
from alula.reports.renderers.console import print_sections
from alula.reports.renderers.record import as_record
from alula.reports.sections.section import parts_of
from alula.reports.sections.table import Number
from alula.reports.study.tolerance import tolerance_sections

LOAD = "load_cases.lift.forces.0=10 %"
ONE_LINK = 'checks={strength={type="safety-factor",minimum=1.5,links=["crank"]}}'


def test_a_starter_is_sampled_printed_and_written(tmp_path: Path) -> None:
    """The record and the samples say the same; the same seed gives the same samples."""
    assert programs.inside("new", "bar.toml", folder=tmp_path).returncode == 0
    stated = ("--tolerance", LOAD, "--tolerance", "pins=0.1 mm", "--set", ONE_LINK)
    command = ("tolerance", "bar.toml", *stated, "--samples", "500")
    done = programs.inside(*command, "-o", "out", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    for words in ("500 samples of 9 tolerances", "passes with a probability", "Sobol' indices", "Worst corner"):
        assert words in done.stdout
    record = json.loads((tmp_path / "out" / "tolerance" / "result.json").read_text(encoding="utf-8"))
    left = "stress of coupler, rocker"
    assert left in " ".join(done.stdout.split())
    assert left in [one["what"] for one in record["caveats"]]
    assert "tolerances" not in [one["topic"] for one in record["caveats"]]
    with np.load(tmp_path / "out" / "tolerance" / "samples.npz") as samples:
        values = samples["values"]
        assert samples["deviations"].shape == (500, 17)
    assert values.shape == (len(record["numbers"]), 500)
    for number, row in zip(record["numbers"], values, strict=True):
        assert number["percentiles"]["50"] == pytest.approx(np.median(row))
    pictures = {path.name for path in (tmp_path / "out" / "tolerance").glob("*.png")}
    assert {"spread-strength-crank-lift.png", "causes-strength-crank-lift.png"} <= pictures
    least, most = (record["every_check_passes"][which]["value"] for which in ("certain", "possible"))
    assert 0.0 <= least <= most <= 1.0
    heaviest = max(zip(record["numbers"][-1]["total"], record["tolerances"], strict=True))
    assert heaviest[1] == "load_cases.lift.forces.0"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("owl-wing-closed",), ["states none", "[tolerances]"]),
        (("owl-wing-closed", "--tolerance", "pins"), ["--tolerance", "entry="]),
        (("owl-wing-closed", "--tolerance", "parts.tube.outer_diameter=5 mm"), ["as large as the size", "5 mm"]),
        (("owl-wing-closed", "--tolerance", "pins=0.1"), ["pins", "unit"]),
    ],
)
def test_mistakes_are_told_in_one_sentence(arguments: tuple[str, ...], words: list[str], tmp_path: Path) -> None:
    done = programs.inside("tolerance", *arguments, folder=tmp_path)
    assert done.returncode == 2
    assert all(word in done.stderr for word in words), done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


@pytest.mark.converged
def test_console_record_and_notebook_tell_the_same_of_samples() -> None:
    """Two checks of one number are named apart; a probability near 1 is not told as certain."""
    case = alula.read_case("four-bar").with_values({
        "checks": {
            "strength": {"type": "safety-factor", "minimum": 6.0, "links": ["crank"]},
            "more": {"type": "safety-factor", "minimum": 9.0, "links": ["crank"]},
        }
    })  # fmt: skip
    report = alula.tolerance(case, {"load_cases.lift.forces.0": "10 %"}, samples=200, accuracy="50 %")
    sections = tolerance_sections(report.result)
    record, rows = as_record(sections), list(report.table())
    assert [row["number"] for row in rows] == list(report.numbers)
    assert {"strength: safety factor of crank, lift", "more: safety factor of crank, lift"} <= set(report.numbers)
    for told, kept in zip(rows, record["numbers"], strict=True):
        assert (told["nominal"], told["median"]) == (kept["nominal"][0], kept["percentiles"]["50"])
        assert told["limit"] == kept["limit"]
        assert told["passes"] == (kept["certain"] and kept["certain"]["value"])
    [first, *_] = report.table("causes")
    assert first["in all"] == pytest.approx(max(record["numbers"][-1]["total"]), abs=0.2)
    with Console(file=StringIO(), width=200, color_system=None) as console:
        print_sections(sections, console)
    printed = console.file.getvalue().replace("\xa0", " ")
    parts = [part for section in sections for part in parts_of(section.parts)]
    assert all(str(number).replace("\xa0", " ") in printed for number in numbers_of(parts))
    known = set(values_of(record)) | {0.0}
    assert all(known.issuperset(ends_of(number)) for number in numbers_of(parts))
    assert str(Number(0.99999, probable=True)) == "> 99.99 %"
    assert [str(Number(share, probable=True)) for share in (0.0, 1e-6, 0.5, 1.0)] == [
        "0 %",
        "< 0.01 %",
        "50 %",
        "100 %",
    ]
