"""``alula envelope`` as a user meets it."""

import json
import subprocess
from pathlib import Path

import programs
import pytest
from rocker_case import TOML


def envelope(*arguments: str) -> subprocess.CompletedProcess[str]:
    return programs.inside("envelope", *arguments)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("case") / "bar.toml"
    path.write_text(TOML, encoding="utf-8")
    return str(path)


def test_the_verdict_is_the_exit_status_and_the_record_names_pose_and_place(path: str) -> None:
    done = envelope(path, "--json", "--max-unknowns", "1000")
    record = json.loads(done.stdout)
    assert done.returncode == {"pass": 0, "fail": 1, "undecided": 3}[record["verdict"]]
    found = record["links"]["rocker"]["load_cases"]["turn"]
    assert 40.0 <= found["at"]["coordinate"] <= 80.0
    assert found["safety_factor"]["value"] == pytest.approx(41.4 / found["stress"]["value"])
    assert "no fatigue data" in record["links"]["rocker"]["no_fatigue"]
    assert record["motion"]["evaluated"] == record["motion"]["poses"] == 7


def test_a_weak_link_fails(path: str) -> None:
    moment = 'load_cases.turn.moments=[{link="rocker", at="P", moment="9000 N*mm"}]'
    done = envelope(path, "--max-unknowns", "1000", "--set", moment)
    assert done.returncode == 1
    assert "FAIL" in done.stdout
    assert "7 of 7 poses" in done.stdout


def test_a_case_without_motion_is_bad_input(path: str) -> None:
    assert envelope(path, "--growth", "0.5").returncode == 2  # growth is at least 1
    still = Path(path).with_name("still.toml")
    still.write_text(TOML.replace('motion = { range = ["40 deg", "80 deg"], poses = 7 }', ""), encoding="utf-8")
    done = envelope(str(still))
    assert done.returncode == 2
    assert done.stderr.startswith("alula: motion: the case states no motion")


def test_too_little_memory_is_refused_before_solving_with_estimate_and_remedy(path: str, monkeypatch) -> None:
    monkeypatch.setattr("alula.fea.common.memory.with_libraries", lambda: 0.0)
    done = envelope(path, "--memory", "50 MB")
    assert done.returncode == 4
    assert done.stdout == ""
    last = done.stderr.strip().splitlines()[-1]
    assert "the stress of 10 loads at" in last
    assert "GB of memory and 0 GB are left of the limit of 0.05 GB" in last
    assert "use a coarser mesh, raise the limit" in last
    assert "Solving" not in done.stderr
