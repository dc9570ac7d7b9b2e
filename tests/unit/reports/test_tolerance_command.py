"""``alula tolerance`` as a user meets it: what it prints and writes, and one sentence per mistake."""

import json
from pathlib import Path

import numpy as np
import programs
import pytest

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
