"""Models that a reader can turn: what the page holds of them is what the solid's solution says."""

import base64
import hashlib
import html.parser
import json
import math
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from mesh_states import state
from plastic_problems import FOUND
from told import as_json, render

from alula.fea.solid.stress import stress_field
from alula.reports.figures.figures import colours
from alula.reports.turnable.link import collapse_models, link_model, link_models, link_name
from alula.reports.turnable.pack import data_block, indices, quantised
from alula.reports.turnable.script import FOLDER, built_from, sources_digest, viewer
from alula.reports.turnable.surface import cut_surface


def unpacked(packed, columns):
    """Decode quantised numbers as a browser does."""
    steps = np.frombuffer(base64.b64decode(packed["data"]), dtype="<u2").reshape(-1, columns)
    low, high = np.array(packed["low"]), np.array(packed["high"])
    return low + steps * (high - low) / 65535


def test_the_script_was_built_from_these_sources(tmp_path):
    assert built_from() == sources_digest(), "run make viewer"
    changed = tmp_path / "turnable"
    shutil.copytree(FOLDER, changed, ignore=shutil.ignore_patterns("__pycache__"))
    assert sources_digest(changed) == built_from()
    with (changed / "source" / "link.js").open("a") as file:
        file.write("\n")
    assert sources_digest(changed) != built_from()


def test_the_script_says_what_it_contains_and_ends_nothing_early():
    head = viewer()[:2000]
    version = json.loads((FOLDER / "package.json").read_text())["devDependencies"]["three"]
    assert f"three.js {version}" in head
    assert "The MIT License" in head
    assert "Permission is hereby granted" in head
    assert not re.search(r"</script|<!--|\r", viewer(), re.IGNORECASE)


@pytest.mark.parametrize("columns", [1, 3])
def test_quantised_numbers_come_back_to_half_a_step(columns):
    values = np.random.default_rng(3).normal(size=(500, columns)) * [1e-6, 1.0, 3e4][:columns]
    error = np.abs(unpacked(quantised(values), columns) - values)
    assert (error <= 0.5001 * np.ptp(values, axis=0) / 65535).all()


def test_a_column_without_range_comes_back():
    assert np.allclose(unpacked(quantised(np.full((4, 3), 7.25)), 3), 7.25, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("largest", "bits"), [(65535, 16), (65536, 32)])
def test_whole_numbers_take_the_bits_that_they_need(largest, bits):
    packed = indices(np.array([[0, 1, largest]]))
    assert packed["bits"] == bits
    assert np.frombuffer(base64.b64decode(packed["data"]), dtype=f"<u{bits // 8}").tolist() == [0, 1, largest]


def test_a_data_block_is_inert_whatever_its_texts_hold():
    hostile = "</script><script>alert(1)</script><!-- ]]> & \u2028 \u2029"
    text = data_block({hostile: hostile})
    assert not set(text) & set("<>&\u2028\u2029")
    assert json.loads(text) == {hostile: hostile}


def cube():
    """Two triangles for each side of a cube, seen from outside."""
    points = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, np.array([triangle for a, b, c, d in sides for triangle in ((a, b, c), (a, c, d))])


def test_a_cube_is_cut_along_its_twelve_edges():
    points, faces = cube()
    cut = cut_surface(points, faces)
    assert len(cut.nodes) == 24  # four corners of each of six sides
    assert (cut.nodes[cut.faces] == faces).all()
    found = {tuple(sorted(pair)) for pair in cut.nodes[cut.edges].tolist()}
    assert len(cut.edges) == 12
    assert found == {(a, b) for b in range(8) for a in range(b) if np.abs(points[a] - points[b]).sum() == 1.0}


def test_a_round_wall_of_few_curved_faces_is_not_cut():
    """Six quadratic faces about a cylinder: their plane triangles are at 60 degrees, the curved faces at hardly any."""
    angles = np.arange(12) * np.pi / 6.0
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    points = np.vstack([np.column_stack([ring, np.full(12, z)]) for z in (0.0, 0.5, 1.0)])

    def node(step, level):
        return level * 12 + step % 12

    faces = []
    for k in range(0, 12, 2):
        a, b, c, d = node(k, 0), node(k + 2, 0), node(k + 2, 2), node(k, 2)
        middle = node(k + 1, 1)
        faces.append([a, b, c, node(k + 1, 0), node(k + 2, 1), middle])
        faces.append([a, c, d, middle, node(k + 1, 2), node(k, 1)])
    curved = cut_surface(points, np.array(faces))
    assert len(curved.nodes) == 36
    assert len(curved.edges) == 2 * 12  # both rims, two pieces for each face
    plane = cut_surface(points, np.array(faces)[:, :3])
    assert len(plane.nodes) > 12


@pytest.fixture(scope="module")
def record(result):
    """The model of the owl wing's link GF as the page holds it."""
    models = link_models(result)
    assert list(models) == [link_name("GF")]  # the others are no solids
    return json.loads(models[link_name("GF")])


def fields(record, place):
    """Positions, displacements and stresses of a variant, as a browser has them."""
    variant = record["variants"][place]
    return (
        unpacked(record["nodes"], 3),
        unpacked(variant["displacement"], 3),
        unpacked(variant["values"], 1)[:, 0],
    )


def test_every_variant_has_its_own_stress_and_displacements_at_the_nodes(record, result):
    link = result.load_cases["weight"].links["GF"]
    solid, space = link.solution, link.solution.space
    cases = [case for case in solid.cases if case.load == link.governing_case.load]
    assert [variant["title"] for variant in record["variants"]] == [peak.title for peak in link.variants]
    for place, case in enumerate(cases):
        nodes, moved, values = fields(record, place)
        near = np.linalg.norm(space.nodes[:, None] - nodes[None], axis=2).argmin(axis=0)
        assert np.abs(space.nodes[near] - nodes).max() < 1e-5 * np.ptp(space.nodes[:, 0])
        stress = stress_field(space, case.displacement, E=solid.E, nu=solid.nu).von_mises
        assert np.abs(values - stress[near]).max() < 1e-5 * stress.max()
        assert np.abs(moved - case.displacement[near]).max() < 1e-5 * np.abs(case.displacement).max()
        hottest = record["variants"][place]["hottest"]
        assert values[hottest] == pytest.approx(link.variants[place].von_mises, rel=1e-4)


def test_the_legend_agrees_with_result_json(record, result):
    told = json.loads(as_json(result))["load_cases"]["weight"]["links"]["GF"]
    assert record["top"] == pytest.approx(told["von_mises_max"]["value"], rel=1e-9)
    governing = record["variants"][record["governing"]]
    assert governing["peak"][0].startswith(f"largest: {told['von_mises_max']['value']:.4f}"[:14])
    assert governing["largest"] == pytest.approx(told["displacement_max"]["value"], rel=1e-9)
    nodes, _, values = fields(record, record["governing"])
    assert np.linalg.norm(nodes[np.argmax(values)] - told["location"]) < 1e-3
    assert (record["measure"], record["unit"]) == ("von Mises stress", "MPa")


def test_a_singular_peak_sets_no_colours_and_is_no_number(result):
    """Colours end at the stress beside the sharp edge, a tip tells that values lie beyond, and no number."""
    link = result.load_cases["weight"].links["GF"]
    beside = 0.5 * float(link.stress.von_mises.max())
    peaks = tuple(replace(peak, von_mises=math.nan, principal=math.nan) for peak in link.variants)
    governing = link.variants.index(link.governing)
    singular = replace(
        link,
        discretisation=state("singular", beside),
        variants=peaks,
        governing=replace(peaks[governing], von_mises=float("nan")),
    )
    record = link_model("GF", singular, {})
    assert record["top"] == pytest.approx(beside)
    for variant in record["variants"]:
        assert variant["peak"][0].startswith("largest: no result, singular at a sharp edge at x = ")
        assert variant["beyond"]


def test_displacements_are_relative_to_the_line_through_the_pins(record):
    """Material about the bores of both pins stays in the mean where it was, across the line through them."""
    nodes, moved, _ = fields(record, record["governing"])
    for x, y in (record["points"]["G"], record["points"]["F"]):
        bore = np.abs(np.hypot(nodes[:, 0] - x, nodes[:, 1] - y) - 0.75) < 0.01
        assert bore.sum() > 8
        assert abs(moved[bore, 1].mean()) < 0.05 * np.abs(moved).max()


def test_the_surface_is_that_of_the_solid(record, result):
    """Its triangles are closed but for the cuts, and enclose the volume of the mesh (Gauss's theorem)."""
    space = result.load_cases["weight"].links["GF"].solution.space
    nodes, _, _ = fields(record, 0)
    faces = np.frombuffer(base64.b64decode(record["faces"]["data"]), dtype="<u2").reshape(len(space.boundary), -1)
    a, b, c = np.moveaxis(nodes[faces[:, :3]], 1, 0)
    p, q, r, s = np.moveaxis(space.nodes[space.cells[:, :4]], 1, 0)
    volume = np.einsum("ij,ij->i", q - p, np.cross(r - p, s - p)).sum() / 6.0
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0 == pytest.approx(volume, rel=1e-4)


@pytest.mark.parametrize(
    ("ended", "measure", "says"),
    [("strain", "plastic strain", "100 % where"), ("limit", "plastic strain over its largest", "without end")],
)
def test_the_plastic_strain_of_a_link_at_its_collapse(result, ended, measure, says):
    """Where a quarter of it flows: nine in ten of its nodes below the last colour, the largest with its place."""
    space = result.load_cases["weight"].links["GF"].solution.space
    span = np.ptp(space.nodes[:, 0])
    share = (space.nodes[:, 0] - space.nodes[:, 0].min()) / span
    zone = np.where(share > 0.75, np.random.default_rng(1).random(len(share)), 0.0)
    shape = share[:, None] * [0.0, span, 0.0]
    flows_on = 7.0 if ended == "limit" else 1.0  # as far as the path was followed
    found = replace(FOUND, ended=ended, nodes=space.nodes, boundary=space.boundary, zone=flows_on * zone, shape=shape)
    record = json.loads(collapse_models({"GF": found}, result.case)["plastic-GF"])
    nodes, moved, values = fields(record, 0)
    near = np.linalg.norm(space.nodes[:, None] - nodes[None], axis=2).argmin(axis=0)
    most = zone[near].max() if ended == "limit" else 1.0
    assert values == pytest.approx(100.0 * zone[near] / most, abs=1e-2)
    assert moved == pytest.approx(shape[near], abs=1e-4 * span)
    assert (record["measure"], record["unit"], record["scale"]) == (measure, "%", 0.05)
    flows = values[values > 1e-2]
    assert np.mean(flows <= record["top"]) == pytest.approx(0.9, abs=0.02)
    [variant] = record["variants"]
    assert variant["beyond"]
    assert says in variant["peak"][0]
    assert values[variant["hottest"]] == values.max()


def test_colours_are_those_of_the_picture(record):
    fixed = np.array([[int(text[k : k + 2], 16) for k in (0, 2, 4)] for text in record["colours"]])
    assert fixed.shape == (9, 3)
    assert (fixed[[0, 4, 8]] == [[255, 255, 204], [253, 141, 60], [128, 0, 38]]).all()  # YlOrRd of ColorBrewer
    assert (colours()[[0, -1]] == fixed[[0, -1]]).all()


class _Sealed(html.parser.HTMLParser):
    """Collects what a policy speaks of: styles, scripts that run, data blocks, and the policy itself."""

    def __init__(self, text):
        super().__init__()
        self.held, self.inside, self.policy, self.inline = {"style": [], "run": [], "data": []}, None, "", []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.inline += [name for name in given if name == "style" or name.startswith("on")]
        if tag == "meta" and given.get("http-equiv") == "Content-Security-Policy":
            self.policy = given["content"]
        if tag == "style":
            self.inside = "style"
        if tag == "script":
            self.inside = "data" if given.get("type") == "application/json" else "run"

    def handle_endtag(self, tag):
        self.inside = None

    def handle_data(self, data):
        if self.inside:
            self.held[self.inside].append(data)


def digest(text):
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def rules_of(page):
    return {name: values for name, *values in (rule.split() for rule in page.policy.split(";"))}


def test_the_page_may_run_and_load_only_what_alula_put_into_it(result):
    page = _Sealed(render(result, {}, models=link_models(result)))
    [style], [script], [_] = page.held["style"], page.held["run"], page.held["data"]
    assert script == viewer()
    assert rules_of(page) == {
        "default-src": ["'none'"],
        "script-src": [digest(script)],
        "style-src": [digest(style)],
        "img-src": ["data:"],
        "base-uri": ["'none'"],
        "form-action": ["'none'"],
    }
    assert page.inline == []


def test_a_page_without_models_runs_nothing(result):
    page = _Sealed(render(result, {}))
    assert page.held["run"] == page.held["data"] == []
    assert rules_of(page)["script-src"] == ["'none'"]


def test_names_in_a_model_run_nothing(result, record):
    """A link of this name is refused where a case is read; here it is in the page all the same."""
    hostile = "</script><script>alert(1)</script><style>*{}</style>"
    block = data_block(record | {"name": hostile, "points": {hostile: [0.0, 0.0]}})
    page = _Sealed(render(result, {}, models={link_name("GF"): block}))
    assert page.held["run"] == [viewer()]
    assert len(page.held["style"]) == 1
    assert json.loads(page.held["data"][0])["name"] == hostile
