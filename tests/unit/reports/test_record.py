import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
import solved
from told import as_json, result_record

from alula.fea.common.band import Band
from alula.geometry.base.version import RESULT_SCHEMA_VERSION, alula_version
from alula.reports.renderers.record import field_units

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def record(result):
    return json.loads(as_json(result), parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))


def test_the_published_keys_are_there(record):
    assert (record["schema_version"], record["version"]) == (RESULT_SCHEMA_VERSION, alula_version())
    assert record["case"] == "owl-wing-static"
    assert record["verdict"] == "pass"
    assert set(record["pose"]) >= {"points", "mobility", "closure_residual"}
    assert set(record["statics"]) >= {"size", "condition", "residual"}
    assert set(record["reactions"][0]) >= {"joint", "on", "by", "force", "magnitude", "load_case"}
    assert set(record["links"]["AE"]) >= {
        "fidelity", "von_mises_max", "safety_factor", "displacement_max", "location", "elements", "unknowns",
    }  # fmt: skip
    assert set(record["checks"][0]) >= {"name", "link", "value", "limit", "verdict"}
    assert set(record["hand_calculations"][0]) >= {"name", "link", "hand", "solid", "difference"}
    assert record["timings"] == {"pose and statics": 0.01, "solid models": 1.5}


def test_bands_are_objects(record):
    band = record["links"]["GF"]["safety_factor"]
    assert set(band) == {"value", "low", "high", "holds", "kinds"}
    assert band["low"] <= band["value"] <= band["high"]
    assert band["holds"] == ["pin pressure (over 180° and over 90°)"]
    assert band["kinds"] == ["pin_pressure"]
    assert set(record["checks"][0]["value"]) == set(band)


def test_the_statics_are_those_of_the_owl_wing(record):
    forces = {r["joint"]: r["magnitude"] for r in record["reactions"] if r["load_case"] == "weight"}
    wanted = {"A": 0.9520, "B": 0.6978, "C": 0.3709, "D": 0.3730, "E": 0.3730, "F": 0.7511, "G": 0.7511}
    assert forces == pytest.approx(wanted, abs=5e-5)
    assert record["drive_torque"] == pytest.approx(-130.58, abs=5e-3)
    assert record["load_cases"]["idle"]["drive_torque"] == 0.0
    assert record["pose"]["link_angles"]["AE"] == pytest.approx(143.204, abs=5e-4)
    assert record["pose"]["dead_points"]["driven_link"]["link"] == "AE"


def test_the_force_is_what_the_first_named_body_does_to_the_other(record):
    # On the whole linkage the ground's two forces balance the 0.25 N at H.
    ground = [r for r in record["reactions"] if r["by"] == "AG" and r["load_case"] == "weight"]
    assert {r["on"] for r in ground} == {"AE", "GF"}
    assert sum(r["force"][0] for r in ground) == pytest.approx(0.0, abs=1e-12)
    assert sum(r["force"][1] for r in ground) == pytest.approx(0.25, abs=1e-12)


def test_solid_sizes_are_null_where_no_solid_ran(record, result):
    assert record["links"]["AE"]["elements"] is None
    assert record["links"]["AE"]["unknowns"] is None
    solid = result.load_cases["weight"].links["GF"]
    assert record["links"]["GF"]["elements"] == solid.elements > 0
    assert record["links"]["GF"]["solver"] == solid.solution.solver
    assert "unknowns" in record["links"]["GF"]["solver_reason"]
    assert 0.0 <= record["links"]["GF"]["solver_error"] < 1e-8
    assert [record["links"]["AE"][key] for key in ("solver", "solver_reason", "solver_error")] == [None] * 3


def test_links_hold_the_worst_load_case_and_say_which(record, result):
    assert {link["load_case"] for link in record["links"].values()} == {"weight"}
    idle = result.load_cases["idle"]
    moved = replace(idle.links["CH"], displacement_max=Band.exact(9.0))
    cases = result.load_cases | {"idle": replace(idle, links=idle.links | {"CH": moved})}
    changed = result_record(replace(result, load_cases=cases))["links"]["CH"]
    assert (changed["load_case"], changed["displacement_load_case"]) == ("weight", "idle")
    assert changed["displacement_max"]["value"] == 9.0


def test_infinite_numbers_are_null_and_named(record):
    idle = record["load_cases"]["idle"]["links"]["GF"]["safety_factor"]
    assert idle["value"] is None
    assert record["nulls"]["load_cases.idle.links.GF.safety_factor.value"] == "infinite"


def test_what_is_no_number_is_null_and_named(result):
    record = result_record(replace(result, timings={"solid models": math.nan, "pose": -math.inf}))
    assert record["timings"] == {"solid models": None, "pose": None}
    assert record["nulls"]["timings.solid models"] == "not a number"
    assert record["nulls"]["timings.pose"] == "minus infinite"


def test_hand_calculations_hold_the_cantilever_and_the_sections(record):
    by_name = {entry["name"]: entry for entry in record["hand_calculations"]}
    assert by_name["whole-wing: moment at the root"]["hand"] == pytest.approx(33.75)
    assert by_name["whole-wing: bending stress at the root"]["hand"] == pytest.approx(2.934, abs=5e-4)
    assert by_name["whole-wing: safety factor"]["hand"] == pytest.approx(14.11, abs=5e-3)
    section = by_name["axial stress of GF at x = 35.0 mm"]
    assert (section["link"], section["difference"], section["unit"]) == ("GF", 0.0706, "MPa")


def test_the_audit_names_the_rows_that_are_no_equilibrium(record):
    rows = record["published_statics"]["rows"]
    assert [row["number"] for row in rows if not row["valid"]] == [6, 9, 13]
    assert record["published_statics"]["reproduced"] is True


def test_the_audit_is_null_where_nothing_was_published(result):
    assert result_record(replace(result, audit=None))["published_statics"] is None


def paths(value, prefix=""):
    """Paths of all numbers, with * for names and without the indices of lists."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from paths(item, f"{prefix}.{key}" if prefix else key)
    elif isinstance(value, list):
        for item in value:
            yield from paths(item, prefix)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield prefix


def test_every_number_has_a_unit(record):
    named = ("links", "load_cases", "materials")
    missing = set()
    of_layers = json.loads(as_json(solved.told("owl-wing-static")))
    unmarked = ("schema_version", "units")
    for path in {path for each in (record, of_layers) for path in paths(each) if path.split(".")[0] not in unmarked}:
        parts = path.split(".")
        if parts[0] == "load_cases":
            parts = parts[2:]
        if parts[0] in named:
            parts[1] = "*"
        candidates = [".".join(parts[:n]) for n in range(len(parts), 0, -1)]
        candidates += [c.replace("pose_coordinate", "*").replace("driven_link", "*") for c in candidates]
        if not any(c in field_units()["fields"] for c in candidates):
            missing.add(path)
    assert missing == set()


def test_every_top_level_key_is_documented(record):
    text = (ROOT / "docs" / "result.md").read_text(encoding="utf-8")
    documented = set(re.findall(r"^\| `(\w+)", text, flags=re.MULTILINE))
    assert set(record) <= documented


def test_the_result_is_left_unchanged(result):
    before = as_json(result)
    result_record(result)
    assert as_json(result) == before
