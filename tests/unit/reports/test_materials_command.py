"""``alula materials``: what it prints is what the library states, and the document's table is what it prints."""

import json
import re
import tomllib

import programs
import pytest

from alula.geometry.materials.material import Material, library, library_text
from alula.reports.commands.materials import card_text
from alula.reports.renderers.markdown import table_lines
from alula.reports.tools.library import library_table, missing

PAGE = (programs.ROOT / "docs" / "materials.md").read_text(encoding="utf-8")


def test_the_document_has_the_library_as_it_is() -> None:
    assert "\n".join(table_lines(library_table())) in PAGE, (
        "replace the table of docs/materials.md by: alula materials --markdown"
    )


def test_the_document_names_every_entry() -> None:
    entries = {entry for entry in Material.model_fields if not entry.endswith("_layers_range")}
    assert {entry for entry in entries if f"`{entry}`" not in PAGE} == set()


@pytest.mark.parametrize("name", library())
def test_a_card_to_paste_is_that_of_the_library(name: str) -> None:
    assert tomllib.loads(card_text(name)) == {"materials": {name: tomllib.loads(library_text())[name]}}


def test_the_list_names_all_and_what_they_lack() -> None:
    listed = programs.inside("materials").stdout
    lines = {line.split()[0]: line for line in listed.splitlines() if line.strip()}
    assert library().keys() <= lines.keys()
    assert re.search(r" 68\.9 .* yield 240 .* sustained load, scatter of strength", lines["aluminium-6061-t6"])
    assert "fatigue" in lines["steel-wire"].rpartition("by diameter")[2]
    assert "fatigue" not in missing(library()["pvc-u"])
    assert missing(library()["pvc-u"].model_copy(update={"sustained_modulus": None})) == (
        "sustained load",
        "scatter of strength",
    )


def test_one_card_whole() -> None:
    shown = programs.inside("materials", "pla-fdm-xy").stdout
    assert re.search(r"strength_across_layers +12 MPa +datasheet +PolyTerra", shown)
    assert "23 MPa to 65 MPa" in shown
    assert "Missing: sustained load, temperature, fatigue of layers." in shown


def test_cards_as_json() -> None:
    record = json.loads(programs.inside("materials", "--json").stdout)
    assert record["materials"].keys() == library().keys()
    [[name, card]] = json.loads(programs.inside("materials", "pvc-u", "--json").stdout)["materials"].items()
    assert (name, card["density"], card["missing"]) == ("pvc-u", "1420 kg/m^3", ["scatter of strength"])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["pvc"], "'pvc' is not in the library; choose one of pvc-paredes-2018, pvc-u"),
        (["\x1b[2J"], "'?[2J' is not in the library; choose one of"),
        (
            ["carbon-plate"],
            "'carbon-plate' is a laminate of fibres: its stiffness and strength depend on the direction",
        ),
        (["--card"], "--card: it needs the name of a card"),
    ],
)
def test_what_it_refuses(words: list[str], said: str) -> None:
    done = programs.inside("materials", *words)
    assert done.returncode == 2
    assert said in done.stderr
