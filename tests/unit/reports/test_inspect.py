"""``alula inspect``: what it prints and writes of a STEP file."""

import io
import json
import shutil
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from result_paths import compare
from typer.testing import CliRunner

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.read import part_facts, part_surface
from alula.geometry.parts.step import StepPart
from alula.geometry.placement.fit import Wanted
from alula.geometry.placement.match import place, points_of_part
from alula.geometry.placement.placed_body import bores_of
from alula.loads.exchange.part import part_entries
from alula.reports.commands.cli import app
from alula.reports.figures import figures
from alula.reports.figures.part_picture import part_picture
from alula.reports.figures.sheet import style
from alula.reports.renderers.record import as_brief_record
from alula.reports.tools.part import inspect_file, part_section

FILES = Path(__file__).parents[2] / "data" / "step"


def parse_length(text: str) -> float:
    value, unit = text.split()
    assert unit == "mm"
    return float(value)


def inspect(*arguments: object):
    return CliRunner().invoke(app, ["inspect", *map(str, arguments)])


def test_it_lists_the_solid_its_mass_and_every_bore():
    """PLA of the library has 1240 kg/m³, so that 3526.124 mm³ are 4.372 g."""
    done = inspect(FILES / "bell_crank.step", "--material", "pla-fdm-xy")
    assert done.exit_code == 0
    told = " ".join(done.stdout.split())
    assert "Size 49.50 × 39.50 × 12.00 mm along x, y, z of the file" in told
    assert "Volume 3526.124 mm³, surface 2689.29 mm²." in told
    assert "Centroid (11.265, 6.225, 3.099) mm." in told
    assert "Mass 4.372 g of PLA" in told
    assert "bore 1 C 6 12 0.000 0.000 6.000 0.0000 0.0000 1.0000 through, coaxial with the outside" in told
    assert "Middles of the bores along z of the link [mm]: A 0.000, B 0.000 and C 3.500; they are not in one" in told


@pytest.mark.parametrize(
    ("name", "sentences"),
    [
        ("fork", ["through, 2 walls (fork)"]),
        ("slotted", ["slot, 10 mm between the centres of its ends, through", "blind, coaxial with bore 8"]),
        ("open_bores", ["through, 89% of the circle is there"]),
        ("cross_tube", ["bore 2 stands at 90.00° to bore 1.", "No point of the link: bore 2."]),
        ("sleeve", ["No two bores are parallel: a link of this part has a single pin, and needs `along`."]),
    ],
)
def test_it_says_what_kinds_of_holes_there_are(name, sentences):
    told = " ".join(inspect(FILES / f"{name}.step").stdout.split())
    for sentence in sentences:
        assert sentence in told


def test_the_entries_name_part_points_and_bores(tmp_path):
    file = tmp_path / "Kniehebel 1ß.step"
    shutil.copy(FILES / "bell_crank.step", file)
    assert tomllib.loads(part_entries(inspect_file(file, None))) == {
        "parts": {
            "Kniehebel 1ß": {
                "shape": "step",
                "file": "Kniehebel 1ß.step",
                "material": "aluminium-6061-t6",
                "bores": {"A": "bore 2", "B": "bore 3", "C": "bore 1"},
            }
        },
        "links": {
            "Kniehebel 1ß": {
                "part": "Kniehebel 1ß",
                "points": {"A": ["0 mm", "0 mm"], "B": ["50 mm", "0 mm"], "C": ["18 mm", "-24 mm"]},
            }
        },
    }


@pytest.mark.parametrize("name", ["plate", "bell_crank", "fork", "slotted", "lever", "cross_tube", "splines", "inch"])
def test_a_link_with_these_entries_has_its_part_where_they_say(name):
    """A case finds how the part lies from points and diameters by least squares; here it is the frame of the list."""
    found = inspect_file(FILES / f"{name}.step", None)
    tables = tomllib.loads(part_entries(found))
    stated = tables["parts"][found.name]
    part = StepPart.model_validate(stated, context={"folder": str(FILES)})
    slots = tables["links"][found.name].get("slots", {})
    ends = {point: (parse_length(slot["first"]), parse_length(slot["last"])) for point, slot in slots.items()}
    wanted = tuple(
        Wanted(
            name=point,
            place=tuple(map(parse_length, at)),
            diameter=found.frame.bores[point].diameter,
            slot=ends.get(point),
        )
        for point, at in tables["links"][found.name]["points"].items()
    )
    fit = place(part, bores_of(part), wanted)
    assert {point: bore.name for point, bore in fit.bores.items()} == stated["bores"]
    assert np.allclose(fit.turn, found.frame.axes, atol=1e-6)
    assert {point: fit.span(point) for point in slots} == {point: pytest.approx(at) for point, at in ends.items()}
    assert points_of_part(part, bores_of(part)) == {
        point: pytest.approx(at) for point, at in found.frame.points.items()
    }


@pytest.mark.parametrize("name", ["sleeve", "cross_tube"])
def test_a_part_with_a_single_pin_gets_entries_with_along(name, tmp_path):
    """Both reach farthest along x of their files; a link of these entries has its pin and its far end there."""
    shutil.copy(FILES / f"{name}.step", tmp_path / "own.step")
    found = inspect_file(tmp_path / "own.step", None)
    text = part_entries(replace(found, facts=replace(found.facts, bores=found.facts.bores[-1:])))
    tables = tomllib.loads(text)
    part = StepPart.model_validate(tables["parts"]["own"], context={"folder": str(tmp_path)})
    [(point, bore)], link = part.bores.items(), tables["links"]["own"]["points"]
    [stated] = [one for one in found.facts.bores if one.name == bore]
    fit = place(part, bores_of(part), (Wanted(name=point, place=(0.0, 0.0), diameter=stated.diameter),))
    assert fit.middle(point) == pytest.approx(np.zeros(3), abs=1e-9)
    corners = np.array(np.meshgrid(*zip(found.facts.low, found.facts.high, strict=True))).reshape(3, -1).T
    assert parse_length(link["P"][0]) == pytest.approx((corners @ fit.turn.T + fit.shift)[:, 0].max(), abs=1e-5)
    assert np.abs(fit.turn[2] @ stated.axis) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("file", "name"), [("knee.step", "knee"), ("(v2) knee.stp", "v2- knee"), ("..step", "part"), ("k" * 99, "k" * 60)]
)
def test_the_name_of_the_part_is_that_of_the_file_as_far_as_it_is_a_name(file, name, tmp_path):
    shutil.copy(FILES / "inch.step", tmp_path / file)
    assert list(tomllib.loads(part_entries(inspect_file(tmp_path / file, None)))["parts"]) == [name]


def test_record_entries_and_picture_go_to_the_folder(tmp_path):
    done = inspect(FILES / "plate.step", "-o", tmp_path, "--json")
    assert done.exit_code == 0
    folder = tmp_path / "inspect"
    assert {path.name for path in folder.iterdir()} == {".alula-inspect.json", "result.json", "parts.toml", "part.png"}
    written = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert written == json.loads(done.stdout)
    assert (folder / "parts.toml").read_text(encoding="utf-8") == written["entries"]
    assert written["link_points"] == {"A": [0.0, 0.0], "B": [40.0, 0.0]}
    image = imread(io.BytesIO((folder / "part.png").read_bytes()))[..., :3]
    assert image.shape[1] == round(style.WIDTH * style.DPI)
    blue = image[..., 2] - image[..., 0] > 0.3
    half = image.shape[0] // 2
    assert blue[:half].mean() > 0.003  # the bores, from both sides
    assert blue[half:].mean() > 0.003
    for edge in (image[0], image[-1], image[:, 0], image[:, -1]):
        assert np.all(edge > 0.99)  # nothing is cut


def test_the_record_is_as_documented():
    compare(
        "inspect", *(as_brief_record([part_section(inspect_file(FILES / f"{name}.step", material))])
                     for name, material in (("slotted", "pla-fdm-xy"), ("sleeve", None)))
    )  # fmt: skip


def test_without_a_renderer_there_is_no_picture_and_a_reason(tmp_path, monkeypatch):
    monkeypatch.setattr(figures, "_ask", lambda *arguments: ({}, "rendering crashed (signal 11)"))
    file = FILES / "inch.step"
    assert part_picture(part_facts(file), part_surface(file)) == (None, "rendering crashed (signal 11)")
    assert f"Record and entries: {tmp_path}" in inspect(file, "-o", tmp_path).stdout


def test_triangles_close_about_the_volume():
    """The divergence theorem; chords cut a little off the holes' walls, so that the volume is a little larger."""
    file = FILES / "inch.step"
    surface = part_surface(file)
    a, b, c = np.moveaxis(surface.points[surface.triangles], 1, 0)
    volume = abs(float(np.einsum("ij,ij->", a, np.cross(b, c)))) / 6.0
    assert part_facts(file).volume < volume < 1.001 * part_facts(file).volume


def test_wrong_input_is_refused():
    with pytest.raises(CaseError, match="--material: there is no material 'unobtainium'; the library has"):
        inspect_file(FILES / "inch.step", "unobtainium")
    with pytest.raises(CaseError, match="--unit: it is that of a mesh, but a STEP file states its own unit"):
        inspect_file(FILES / "inch.step", None, "mm")
    with pytest.raises(CaseError, match="--unit: 'ft' is no unit of a mesh; name one of um, mm, cm, m, in"):
        inspect_file(Path("knee.msh"), None, "ft")
    done = inspect(FILES / "none.step")
    assert isinstance(done.exception, CaseError)
