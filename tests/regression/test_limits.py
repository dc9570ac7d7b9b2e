"""Cases that are too large are refused before they are computed, with the limit and the remedy."""

import json
import time
import tomllib
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from told import as_json

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import LARGEST_FILE, read_case, validate
from alula.loads.case.case_rules import MOST_RESULTS
from alula.loads.states.case_motion import solve_case_motion

OWL = "owl-wing-static"
HOLES = '{count=%d,diameter="1 mm",first="40 mm",last="60 mm",along="z"}'


def refused(*overrides: str) -> str:
    with pytest.raises(CaseError) as error:
        read_case(OWL, overrides)
    return str(error.value)


@pytest.mark.parametrize(
    ("entry", "text", "words"),
    [
        ("load_cases.lift.forces.0.force.1", "1e300 N", "the force must be at most 1e+20 N"),
        ("load_cases.lift.forces.0.force.1", "-1e200 N", "the force must be at most 1e+20 N"),
        ("load_cases.lift.forces.0.force.1", "1e-300 N", "the force must be at least 1e-20 N"),
        ("load_cases.lift.forces.0.force.1", "nan N", "one finite number"),
        ("load_cases.lift.forces.0.force.1", "inf N", "one finite number"),
        ("load_cases.lift.speed", "1e100 rpm", "the angular speed must be at most 1e+20 rad/s"),
        ("load_cases.lift.gravity", "1e-300 m/s^2", "the acceleration must be at least 1e-20 mm/s^2"),
        ("links.rocker.points.P.0", "1e300 mm", "the length must be at most 1e+20 mm"),
        ("links.rocker.points.P.1", "1e-300 mm", "the length must be at least 1e-20 mm"),
        ("pose.angle", "1e-300 deg", "the angle must be at least 1e-20 rad"),
        ("pose.angle", "1e20 deg", "the angle must be at most 1e+06 rad"),
        ("title", "", "it must not be empty; write what it is"),
        ("title", " \n", "it must not be empty; write what it is"),
        ("materials.plate.title", "", "it must not be empty; write what it is"),
        ("materials.plate.density", "1e300 kg/m^3", "the density must be at most 1e+20 tonne/mm^3"),
        ("materials.plate.youngs_modulus", "1e-300 GPa", "the stress must be at least 1e-20 MPa"),
        ("materials.plate.youngs_modulus", "1e300 GPa", "the stress must be at most 1e+20 MPa"),
        ("parts.bar.fillet_radius", "1e300 mm", "the length must be at most 1e+20 mm"),
    ],
)
def test_sizes_that_nothing_has(entry: str, text: str, words: str) -> None:
    """Their squares overflowed or vanished: NumPy warned, or the run ended as a fault of alula's own."""
    with pytest.raises(CaseError) as error:
        validate(_starter({entry: text}))
    sentence = str(error.value)
    assert sentence.startswith(f"{entry} (it is {text!r}): ")
    assert words in sentence
    assert "check the number" in sentence or "write " in sentence


@pytest.mark.parametrize(
    ("entry", "number"),
    [
        ("checks.strength.minimum", 1e308),
        ("checks.strength.minimum", 1e-308),
        ("conditions.cycles", 1e300),
        ("materials.plate.minimum_safety_factor", 1e21),
    ],
)
def test_pure_numbers_that_nothing_has(entry: str, number: float) -> None:
    with pytest.raises(CaseError) as error:
        validate(_starter({entry: number}))
    told = "it must be 1e-20 to 1e+20; check the number"
    assert str(error.value) == f"{entry} (it is {number!r}): {told}"


@pytest.mark.parametrize(
    "changes",
    [
        {"load_cases.lift.forces.0.force.1": "1e20 N", "load_cases.lift.gravity": "1e-20 mm/s^2"},
        {
            "load_cases.lift.forces.0.force.1": "1e-20 N",
            "materials.plate.density": "1e-20 tonne/mm^3",
            "load_cases.lift.speed": "1e20 rad/s",
        },
        {
            "materials.plate.youngs_modulus": "1e20 MPa",
            "load_cases.lift.speed": "1e-20 rad/s",
            "materials.plate.density": "1e20 tonne/mm^3",
        },
        {"materials.plate.youngs_modulus": "1e-20 MPa", "load_cases.lift.forces.0.force.1": "-1e20 N"},
        {
            "materials.plate.density": "1e20 tonne/mm^3",
            "load_cases.lift.speed": "1e20 rad/s",
            "large_displacement": "off",  # followed on its deformed shape by what is lighter
        },
    ],
)
def test_the_ends_of_what_is_read_are_borne_by_all_that_solves(changes: dict[str, str]) -> None:
    """No warning (which is an error in tests) and no number that is not finite."""
    case = validate(_starter(changes))
    for reactions in solve_case_statics(case, "starter").reactions.values():
        assert np.isfinite([reactions.drive_torque, *(joint.magnitude for joint in reactions.joints.values())]).all()
    result = check_case(case, name="starter", fidelity="beam")
    assert result.verdict in set(Verdict)
    json.loads(as_json(result), parse_constant=lambda name: pytest.fail(f"{name} in the record"))
    moved = solve_case_motion(case)
    assert np.isfinite(moved.torque["lift"]).all()


def _starter(changes: Mapping[str, object]) -> dict[str, Any]:
    """Tables of the starter with a material of its own and a motion under inertia; the changes by their paths."""
    tables = tomllib.loads(files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8"))
    card = tomllib.loads(files("alula.geometry.materials").joinpath("materials.toml").read_text(encoding="utf-8"))[
        "pla-fdm-xy"
    ]
    for entry in ("youngs_modulus_range", "sustained_modulus"):  # which the changed modulus would contradict
        card.pop(entry, None)
    tables["materials"] = {"plate": card}
    tables["parts"]["bar"]["material"] = "plate"
    tables["motion"] = {
        "coordinate": "crank", "range": ["0 deg", "90 deg"], "poses": 3, "inertia": True, "speed": "1 rad/s"
    }  # fmt: skip
    for path, value in changes.items():
        *above, last = (int(key) if key.isdigit() else key for key in path.split("."))
        here: Any = tables
        for key in above:
            here = here[key] if isinstance(here, list) else here.setdefault(key, {})
        here[last] = value
    return tables


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
    with pytest.raises(CaseError, match="must hold at most 1000"):
        validate(laden(1001))


def _row_of_four_bars(count: int) -> dict[str, Any]:
    """Tables of so many four-bars on one base, bonded, so that no drive is needed: three moving links each."""
    tables = tomllib.loads(files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8"))
    links, joints = {"base": tables["links"]["base"]}, {}
    for i in range(count):
        names = {name: f"{name}{i}" for name in ("crank", "coupler", "rocker")} | {"base": "base"}
        links |= {names[name]: tables["links"][name] for name in ("crank", "coupler", "rocker")}
        for name, joint in tables["joints"].items():
            own = {"links": [names[link] for link in joint["links"]], "points": [name, name]}
            joints[f"{name}{i}"] = joint | own
    del tables["drive"], tables["pose"], tables["motion"], tables["checks"]
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
