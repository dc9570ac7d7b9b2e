"""Case files of every version of the format are read as they were meant, or refused with what to change.

``case_format_1.json`` holds what alula 0.1 shipped and knew: its built-in cases as tables (prose shortened), and the
entries of its JSON Schema, each with True where it was required.
"""

import json
import re
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from alula.fea.check.run import check_case
from alula.geometry.base.errors import CaseError
from alula.geometry.base.version import CASE_SCHEMA_VERSION, RESULT_SCHEMA_VERSION
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

HERE = Path(__file__).parent
FORMAT_1 = json.loads((HERE / "case_format_1.json").read_text(encoding="utf-8"))


def entries(schema: dict[str, Any]) -> dict[str, bool]:
    """Return every entry of a JSON Schema by its path, such as ``links.*.points``, with True where it is required."""

    def walk(node: dict[str, Any], path: str, seen: tuple[str, ...]) -> Iterator[tuple[str, bool]]:
        if "$ref" in node and node["$ref"] not in seen:
            name = node["$ref"].rpartition("/")[2]
            yield from walk(schema["$defs"][name], path, (*seen, node["$ref"]))
        kinds = node.get("discriminator", {}).get("mapping", {})
        for kind, reference in kinds.items():
            yield from walk({"$ref": reference}, f"{path}<{kind}>", seen)
        for option in [] if kinds else [*node.get("anyOf", ()), *node.get("oneOf", ()), *node.get("prefixItems", ())]:
            yield from walk(option, path, seen)
        for key, child in node.get("properties", {}).items():
            yield f"{path}.{key}".lstrip("."), key in node.get("required", ())
            yield from walk(child, f"{path}.{key}", seen)
        for key in ("items", "additionalProperties"):
            if isinstance(node.get(key), dict):
                yield from walk(node[key], f"{path}.*", seen)

    return dict(walk(schema, "", ()))


def test_version_1_has_lost_no_entry_and_requires_no_more():
    """Whoever removes or renames an entry, or requires a further one, raises the version, as docs/versions.md says."""
    assert CASE_SCHEMA_VERSION == 1
    known, before = entries(Case.model_json_schema()), FORMAT_1["entries"]
    assert len(before) > 200
    assert before.keys() - known.keys() == set()
    tables = {entry.rpartition(".")[0] for entry in before}
    required = {entry for entry, needed in known.items() if needed and entry.rpartition(".")[0] in tables}
    assert required - {entry for entry, needed in before.items() if needed} == set()


@pytest.mark.parametrize("name", FORMAT_1["cases"])
def test_a_case_of_0_1_means_what_it_meant(name):
    """It is today's case of that name: eyes that 0.1 had to be told follow by themselves, a motor may state more.

    Its links lay in one plane; today's say in which layer, and how pins fit in their holes, which it left open and
    leaves open now. What stands still beside a motion with a speed says so.
    """
    folder = files("alula.loads.cases")
    file = folder / ("four-bar.toml" if name == "starter" else f"{name}.toml")
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    tables["parts"].get("bar", {}).pop("build_direction", None)  # which none stated then
    if name == "starter":
        tables["parts"]["bar"]["eye_diameter"] = "12 mm"  # 1.6 times the width since then
        tables["title"] = FORMAT_1["cases"][name]["title"]
        del tables["motion"]  # which it had not then
    tables.pop("wings", None)  # in whose load cases air acts
    for joint in tables["joints"].values():
        for key in ("fit", "clearance", "tight_in"):
            joint.pop(key, None)
    for slot in (slot for link in tables["links"].values() for slot in link.get("slots", {}).values()):
        slot.pop("clearance", None)
    tables["load_cases"] = {key: one for key, one in tables["load_cases"].items() if "flapping" not in one}
    for one in tables["load_cases"].values():
        if one.get("speed") == "0 rpm":
            del one["speed"]
    known = FORMAT_1["cases"][name].get("checks", {})
    tables["checks"] = {key: one for key, one in tables.get("checks", {}).items() if key in known}
    today = validate(tables)
    later = {"description": True, "source": True, "assumptions": True, "checks": {"motor": {"no_load_speed"}}}
    later |= {"layer_spacing": True, "washer": True, "links": {"__all__": {"layer", "thickness"}}}
    assert validate(FORMAT_1["cases"][name]).model_dump(exclude=later) == today.model_dump(exclude=later)


REST = "youngs_modulus, poissons_ratio, yield_strength, ultimate_strength"


@pytest.mark.parametrize(
    ("left", "told"),
    [
        ({"sources": {}, "status": {}}, f"sources and status of density, {REST}"),
        ({"sources": {"density": "a book"}}, f"sources of {REST}"),
    ],
)
def test_a_card_without_sources_is_read_and_one_sentence_lists_what_it_leaves_out(left, told):
    """0.1 let such cards pass; they were refused, one value at a time."""
    tables = deepcopy(FORMAT_1["cases"]["four-bar-synthesis"])
    [(name, card)] = tables["materials"].items()
    plain = check_case(validate(tables), name="plain", fidelity="beam")
    card |= left
    found = check_case(validate(tables), name="bare", fidelity="beam")
    first = told.partition(" of ")[2].partition(",")[0]
    lines = {"sources": f'sources.{first} = "data sheet of its maker"', "status": f'status.{first} = "datasheet"'}
    line = " and ".join(text for table, text in lines.items() if table in told.partition(" of ")[0])
    [warning] = set(found.warnings) - set(plain.warnings)
    assert warning == (f"materials.{name} does not state {told}; write under [materials.{name}] for example {line}")
    assert [link.safety_factor for link in found.load_cases[next(iter(found.load_cases))].links.values()] == [
        link.safety_factor for link in plain.load_cases[next(iter(plain.load_cases))].links.values()
    ]


def test_what_0_1_let_pass_and_is_a_mistake_is_told_with_its_remedy():
    """A stricter rule is no other format: the case is named, and what to change."""
    flight = deepcopy(FORMAT_1["cases"]["owl-wing-flight"])
    del flight["ways_to_hold"]["load_case"]
    with pytest.raises(CaseError, match=r"^ways_to_hold.load_case: it is missing; name the one .* as-published, "):
        validate(flight)
    ornithopter = deepcopy(FORMAT_1["cases"]["ornithopter"])
    ornithopter["links"]["crank"]["part"] = "rod"
    with pytest.raises(CaseError, match=r"^links.crank: the eyes at O and A, .*overlap: move the points more"):
        validate(ornithopter)


@pytest.mark.parametrize(
    ("stated", "told"),
    [
        (2, "the case is written in version 2 of the format, but this alula reads version 1; install a newer alula"),
        (10**30, "the case is written in version 1000+ of the format, but .*; install a newer alula"),
        (0, "it is 0, but there is no such version of the format; write schema_version = 1"),
        (-1, "it is -1, but there is no such version of the format; write schema_version = 1"),
        ("1", "it is '1', but there is no such version of the format; write schema_version = 1"),
        (True, "it is True, but there is no such version of the format; write schema_version = 1"),
        (1.0, "it is 1.0, but there is no such version of the format; write schema_version = 1"),
    ],
)
def test_another_version_is_refused_with_what_to_do(stated, told):
    with pytest.raises(CaseError) as refused:
        validate(FORMAT_1["cases"]["owl-wing-static"] | {"schema_version": stated})
    assert re.fullmatch(f"schema_version: {told}", str(refused.value))


def test_the_document_names_the_versions():
    text = (HERE.parents[1] / "docs" / "versions.md").read_text(encoding="utf-8")
    assert f"The format of the case file: `schema_version = {CASE_SCHEMA_VERSION}`" in text
    assert f'The format of `result.json`: `"schema_version": {RESULT_SCHEMA_VERSION}`' in text
