"""Models that a reader can turn: what the page holds of them is what the solid's solution says."""

import base64
import json
import re
import shutil

import numpy as np
import pytest

from reports.turnable.pack import data_block, indices, quantised
from reports.turnable.script import FOLDER, built_from, sources_digest, viewer
from reports.turnable.surface import cut_surface


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
