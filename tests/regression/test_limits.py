"""Cases that are too large are refused before they are computed, with the limit and the remedy."""

import time
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from geometry.errors import CaseError
from loads.case_file import LARGEST_FILE, read_case, validate
from loads.case_rules import MOST_RESULTS

OWL = "owl-wing-static"
HOLES = '{count=%d,diameter="1 mm",first="40 mm",last="60 mm",along="z"}'


def refused(*overrides: str) -> str:
    with pytest.raises(CaseError) as error:
        read_case(OWL, overrides)
    return str(error.value)


def test_the_size_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    for size, words in ((LARGEST_FILE + 1, "larger than 1 MiB"), (LARGEST_FILE, "schema_version")):
        path.write_bytes(b"#" * size)
        with pytest.raises(CaseError, match=words):
            read_case(str(path))


def test_the_number_of_poses() -> None:
    motion = {"coordinate": "crank0", "range": ["0 deg", "90 deg"]}
    tables = _row_of_four_bars(10)
    with pytest.raises(CaseError, match="at most 100000"):
        validate(tables | {"motion": motion | {"poses": 100_001}})
    with pytest.raises(CaseError, match=r"poses: 100,000 poses of 30 moving links .* about 36 GB") as error:
        validate(tables | {"motion": motion | {"poses": 100_000}})
    allowed = int(str(error.value).rpartition("at most ")[2].split()[0].replace(",", ""))
    assert validate(tables | {"motion": motion | {"poses": allowed}}).motion.poses == allowed
    with pytest.raises(CaseError, match=r"^motion\.poses"):
        validate(tables | {"motion": motion | {"poses": allowed + 1}})


def test_load_cases_times_links() -> None:
    tables = _row_of_four_bars(10)

    def laden(count: int) -> dict[str, Any]:
        return tables | {"load_cases": {f"c{i}": {"own_weight": True} for i in range(count)}}

    assert len(validate(laden(MOST_RESULTS // 30)).load_cases) == MOST_RESULTS // 30
    with pytest.raises(CaseError, match=r"load_cases: 67 load cases of 30 links .* at most 2,000"):
        validate(laden(MOST_RESULTS // 30 + 1))
    with pytest.raises(CaseError, match="must hold at most 100"):
        validate(laden(101))


def _row_of_four_bars(count: int) -> dict[str, Any]:
    """Tables of so many four-bars on one base, bonded, so that no drive is needed: three moving links each."""
    tables = tomllib.loads(files("loads.cases").joinpath("starter.toml.txt").read_text(encoding="utf-8"))
    links, joints = {"base": tables["links"]["base"]}, {}
    for i in range(count):
        names = {name: f"{name}{i}" for name in ("crank", "coupler", "rocker")} | {"base": "base"}
        links |= {names[name]: tables["links"][name] for name in ("crank", "coupler", "rocker")}
        for name, joint in tables["joints"].items():
            own = {"links": [names[link] for link in joint["links"]], "points": [name, name]}
            joints[f"{name}{i}"] = joint | own
    del tables["drive"], tables["pose"], tables["checks"]
    return tables | {
        "links": links, "joints": joints, "joint_model": "bonded", "load_cases": {"weight": {"own_weight": True}}
    }  # fmt: skip


def test_rows_of_holes() -> None:
    """Every hole is compared with every other: a million of them took for ever."""
    ten = ",".join([HOLES % 200] * 10)
    begun = time.process_time()
    assert "overlap" in refused(f"links.CH.holes=[{ten}]") or "holes" in refused(f"links.CH.holes=[{ten}]")
    assert time.process_time() - begun < 2.0
    assert "must hold at most 10" in refused(f"links.CH.holes=[{ten},{HOLES % 1}]")
    assert "at most 200" in refused(f"links.CH.holes=[{HOLES % 201}]")


def many(entry: str, count: int) -> str:
    """Return so many entries, ``#`` standing for the number of each."""
    return ",".join(entry.replace("#", str(i)) for i in range(count))


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("solid.mesh_size=0.01", "at least 0.1"),
        ("links={" + many('l#={points={A=["0 mm","0 mm"],B=["1 mm","0 mm"]}}', 201) + "}", "at most 200"),
        ("joints={" + many('j#={links=["AG","GF"]}', 401) + "}", "at most 400"),
        ("links.AG.points={" + many('p#=["# mm","0 mm"]', 101) + "}", "at most 100"),
        ("claims=[" + many('{name="a",stated="1",published="1",source="s"}', 1001) + "]", "at most 1000"),
    ],
)
def test_counts(override: str, words: str) -> None:
    assert words in refused(override)
