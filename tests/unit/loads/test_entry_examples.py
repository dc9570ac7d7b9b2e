"""Examples in the JSON Schema of the case file."""

import tomllib

import pytest

from alula.geometry.materials.material import library
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_text
from alula.loads.compose.entry_examples import schema_with_examples
from alula.loads.text.entries import file_schema, options


def entry(table: str, name: str) -> dict:
    return schema_with_examples()["$defs"][table]["properties"][name]


def test_tables_have_examples_that_built_in_cases_state():
    starter = tomllib.loads(read_text("four-bar")[0])
    tables = schema_with_examples()["$defs"]
    assert tables["Bar"]["examples"] == [starter["parts"]["bar"]]
    assert tables["PointForce"]["examples"] == starter["load_cases"]["lift"]["forces"]
    assert tables["Attachment"]["examples"], "of the two ends of a spring, which are a list of tables of a fixed length"
    assert entry("Bar", "width")["examples"] == ["8 mm"]


@pytest.mark.parametrize("kind", ["Tube", "Bar", "Plate", "Disc", "StepPart"])
def test_an_example_is_of_the_kind_that_it_stands_at(kind: str):
    """Parts are told from one another by ``shape``: a bar is no example of a tube."""
    table = schema_with_examples()["$defs"][kind]
    [example] = table["examples"]
    assert example["shape"] == table["properties"]["shape"]["const"]
    assert set(example) <= set(table["properties"])


def test_entries_that_name_something_say_what():
    assert entry("Tube", "material")["examples"] == list(library())
    assert entry("Tube", "material")["x-refers"] == "materials"
    assert entry("Link", "part")["x-refers"] == "parts"
    assert entry("Joint", "points")["x-refers"] == "points"
    assert "x-refers" not in entry("Link", "points"), "points of a link are named here, not referred to"


def test_a_schema_without_examples_stays_as_it_is():
    assert "examples" not in file_schema(Case)["$defs"]["Bar"]
    [bar] = options({"$ref": "#/$defs/Bar"}, file_schema(Case))
    assert bar["title"] == "Bar"
