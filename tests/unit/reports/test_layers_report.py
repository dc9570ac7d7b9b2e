"""What console, page, picture and record say of the layers of a printed link."""

import io
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from html_pages import Page
from programs import ROOT
from rich.console import Console
from told import as_json, flat, not_covered, print_result, render

from alula.fea.common.band import Band
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.solid.layers import Layers, best_directions, build_directions
from alula.fea.whole.build_directions import build_directions_of
from alula.reports.figures.build_map import _project, build_map
from alula.reports.sections.layers import layer_text
from alula.reports.words.numbers import direction

LINK = "GF"


def with_layers(result, **changed):
    """The solid link of the fixture as a part printed along its length."""
    layers = Layers(normal=(2.0, 0.0, 0.0), across=12.0, between=6.0)
    weight = result.load_cases["weight"]
    link = weight.links[LINK]
    factor = float(12.0 / layers.stress(link.stress.nodal).max())
    found = LayerStress(
        layers=layers,
        safety_factor=Band(value=factor, low=0.9 * factor, high=1.1 * factor),
        location=link.location,
        tension=1.25,
        shear=0.5,
        discretisation=link.discretisation,
        scan=best_directions([link.stress.nodal], layers),
    )
    links = dict(weight.links) | {LINK: replace(link, layers=replace(found, **changed))}
    return replace(result, load_cases=dict(result.load_cases) | {"weight": replace(weight, links=links)})


def sentence_of(found):
    return flat(layer_text(found).text)


def printed(result):
    stream = io.StringIO()
    print_result(result, Console(file=stream, width=2000, color_system=None))
    return stream.getvalue()


@pytest.mark.parametrize(
    ("vector", "text"),
    [((2.0, 0.0, 0.0), "(1, 0, 0)"), ((0.0, -1.0, 0.0), "(0, −1, 0)"), ((1.0, 0.0, 1.0), "(0.71, 0, 0.71)")],
)
def test_a_direction_in_words(vector, text):
    assert direction(vector) == text


def test_the_sentence_is_on_console_and_page(result):
    marked = with_layers(result)
    [found] = build_directions_of(marked).values()
    way, factor = found.best
    assert factor == found.scan.max() > 1.05 * found.safety_factor.value
    assert found.layers.across / Layers(normal=way, across=12.0, between=6.0).stress(
        marked.load_cases["weight"].links[LINK].stress.nodal
    ).max() == pytest.approx(factor)
    assert f"built along {direction(way)} it would be" in sentence_of(found)
    assert sentence_of(found) in flat(printed(marked))
    page = render(marked, {f"layers-{LINK}": build_map(found)})
    assert sentence_of(found) in flat(Page(page).words)
    assert "over the direction of building" in page
    assert "over the direction of building" not in render(result, {})


def test_no_direction_is_proposed_where_none_is_better_or_known(result):
    [found] = build_directions_of(with_layers(result)).values()
    even = replace(found, scan=np.full_like(found.scan, 1.04 * found.safety_factor.value))
    assert sentence_of(even).endswith("no direction of building holds noticeably more.")
    assert sentence_of(replace(found, scan=None)).endswith("since the card has no shear strength.")


def test_the_record_has_what_the_document_says(result):
    links = json.loads(as_json(with_layers(result)))["links"]
    record = links[LINK]["layers"]
    assert (record["build_direction"], record["tension"], record["shear"]) == ([2.0, 0.0, 0.0], 1.25, 0.5)
    text = (ROOT / "docs" / "result.md").read_text(encoding="utf-8")
    [row] = re.findall(r"^\| `layers` \|(.*)$", text, flags=re.MULTILINE)
    assert {key for key in (*record, *record["best"]) if f"`{key}`" not in row} == set()
    assert {name for name, link in links.items() if link["layers"] is None} == links.keys() - {LINK}


def test_the_map_has_every_direction_in_its_place(result):
    [found] = build_directions_of(with_layers(result)).values()
    assert build_map(found).png().startswith(b"\x89PNG")
    assert build_map(found).png() != build_map(replace(found, scan=found.scan[:, ::-1])).png()
    middle = _project(np.array([0.0, 0.0, 1.0]))
    radii = [np.linalg.norm(_project(row[0]) - middle) for row in build_directions()]
    polar = np.radians(np.arange(0.0, 90.1, 5.0))
    assert radii == pytest.approx(100.0 * np.sqrt(2.0) * np.sin(polar / 2.0))  # Lambert's equal areas
    assert _project(np.array([0.0, 1.0, 0.1]))[1] < middle[1]  # y is up
    assert _project(np.array([1.0, 2.0, -3.0])) == pytest.approx(_project(np.array([-1.0, -2.0, 3.0])))
    unloaded = replace(found, scan=np.full_like(found.scan, np.inf))
    assert build_map(unloaded).png().startswith(b"\x89PNG")


def test_links_whose_layers_may_have_any_direction_are_named(result):
    assert "no build_direction" not in dict(not_covered(result))["Manufacture and scatter"]
    case = result.case
    card = case.material_of(LINK).model_copy(update={"strength_across_layers": 12.0})
    name = case.part_of(LINK).material
    layered = replace(result, case=case.model_copy(update={"materials": dict(case.materials) | {name: card}}))
    assert "Safety factors of GF" in dict(not_covered(layered))["Manufacture and scatter"]
