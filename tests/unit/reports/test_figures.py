import io
import sys
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

from alula.reports.figures import figures
from alula.reports.figures import scene as scenes
from alula.reports.figures.sheet import style

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
# Seen from outside counter-clockwise.
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]]
)  # fmt: skip
POINTS = {"GF": {"G": (0.0, 0.0), "F": (50.0, 0.0)}}


@pytest.fixture
def solid(result):
    return {"GF": result.load_cases["weight"].links["GF"]}


def test_a_solid_link_gets_a_picture(solid):
    pictures, warnings = figures.stress_plots(solid, POINTS)
    assert warnings == ()
    image = imread(io.BytesIO(pictures["GF"].png()))[..., :3]
    assert image.shape[1] == round(style.WIDTH * style.DPI)
    # The body's colours: red against blue, which neither ink nor paper nor grey has.
    coloured = (image[..., 0] - image[..., 2]) > 0.15
    assert coloured[: image.shape[0] // 3].mean() > 0.05


def test_a_beam_gets_none(result):
    assert figures.stress_plots({"AE": result.load_cases["weight"].links["AE"]}, {}) == ({}, ())


@pytest.mark.parametrize(
    ("program", "trouble"),
    [
        ("import os; os.abort()", "rendering crashed (signal 6)"),
        ("raise RuntimeError('no renderer')", "rendering failed (RuntimeError: no renderer)"),
        ("import time; time.sleep(60)", "rendering was stopped after 0.5 s"),
    ],
)
def test_a_renderer_that_fails_costs_one_warning(solid, monkeypatch, program, trouble):
    monkeypatch.setattr(figures, "_command", lambda: [sys.executable, "-c", program])
    pictures, warnings = figures.stress_plots(solid, POINTS, time_limit=0.5 if "sleep" in program else 60.0)
    assert pictures == {}
    [warning] = warnings
    assert warning.startswith(f"no stress plot of GF: {trouble}")


def test_a_missing_library_is_tried_again_with_another_renderer(solid, monkeypatch):
    tried = []

    def ask(requests, choice, time_limit):
        tried.append(choice)
        return {}, "rendering crashed"

    monkeypatch.setattr(figures, "_ask", ask)
    monkeypatch.setattr(figures, "loads", lambda library: True)
    figures.stress_plots(solid, POINTS)
    software = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"}
    assert tried == [software, {}]


def test_a_renderer_whose_library_is_missing_is_not_tried(monkeypatch):
    monkeypatch.setattr(figures, "loads", lambda library: False)
    assert figures._renderers() == ({},)


def test_the_scene_states_a_round_scale_that_shows(solid):
    scene = scenes.scene_of(solid["GF"])
    shown = scene.scale * np.linalg.norm(scene.displacement, axis=1).max()
    length = np.ptp(scene.points[:, 0])
    assert 0.02 * length < shown <= 0.0801 * length
    assert scene.values[scene.hottest] == scene.values.max()
    for spots in (scene.points, scene.deformed):
        share = scene.strip.share(spots)
        assert share.min() > 0.0
        assert share.max() < 1.0
    assert scene.close.share(scene.points[scene.hottest]) == pytest.approx([0.5, 0.5])


def test_the_close_view_is_as_wide_as_the_section_whatever_stands_out_of_it(solid):
    """An arm once made the close view as large as the link."""
    link = solid["GF"]
    slender = replace(link.beam.section, half_y=0.5, half_z=0.4)
    scene = scenes.scene_of(replace(link, beam=replace(link.beam, section=slender)))
    assert scene.close.half_width == pytest.approx(0.65 * 1.0)
    assert scene.close.half_width < 0.25 * np.ptp(scene.points[:, 1])


def test_the_stress_that_decides_is_plotted(solid):
    link = solid["GF"]
    ductile, brittle = scenes.scene_of(link), scenes.scene_of(replace(link, brittle=True))
    nodal = link.stress.nodal
    tensors = nodal[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    largest = np.linalg.eigvalsh(tensors)[:, -1]
    assert brittle.values == pytest.approx(largest)
    assert brittle.hottest == np.argmax(largest)
    assert (ductile.measure, brittle.measure) == ("von Mises stress", "largest principal stress")
    assert figures.peak_lines(brittle)[0].startswith(f"largest: {largest.max():.4g}"[:12])


def test_a_body_that_does_not_move_is_drawn_as_it_is(solid):
    link = solid["GF"]
    still = replace(link.governing_case, displacement=np.zeros_like(link.governing_case.displacement))
    assert scenes.scene_of(replace(link, governing_case=still)).scale == 1.0


def test_quadratic_cells_are_split_without_gaps(solid):
    space = solid["GF"].stress.space
    cells = space.cells[:50]

    def volume(tetrahedra):
        a, b, c, d = np.moveaxis(space.nodes[tetrahedra], 1, 0)
        return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0

    parts = volume(cells[:, list(map(list, scenes._CORNERS_AND_EDGES))].reshape(-1, 4)).reshape(-1, 8)
    straight = np.abs(parts.sum(axis=1) - volume(cells[:, :4])) < 1e-12
    assert (parts > 0.0).all()
    assert straight.any()


def test_triangles_cover_the_surface(solid):
    scene, space = scenes.scene_of(solid["GF"]), solid["GF"].stress.space
    assert len(scene.triangles) == 4 * len(space.boundary)
    a, b, c = np.moveaxis(scene.points[scene.triangles], 1, 0)
    # A closed surface: its area vectors sum to nothing.
    assert np.cross(b - a, c - a).sum(axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(("value", "rounded"), [(2500.0, 2000.0), (5.0, 5.0), (0.99, 0.5), (1.0, 1.0), (11.0, 10.0)])
def test_scales_are_round(value, rounded):
    assert scenes.round_scale(value) == pytest.approx(rounded)


def test_a_corner_is_seen_from_its_side_alone():
    toward = np.array([1.0, 1.0, 1.0]) / np.sqrt(3.0)
    assert scenes._seen(CUBE, FACES, 7, toward)
    assert not scenes._seen(CUBE, FACES, 7, -toward)
    assert scenes._seen(CUBE, FACES, 0, -toward)


def test_the_close_view_finds_a_free_direction():
    direction = scenes._free_direction(CUBE, FACES, 7, 1.0)
    assert direction @ np.ones(3) > 0.0
    assert scenes._free_direction(CUBE, FACES, 3, 1.0)[0] < 0.9


def test_what_is_walled_in_is_cut_open():
    shell = np.vstack([CUBE, 4.0 * CUBE - 1.5])
    walled = np.vstack([FACES, FACES + 8])
    assert scenes._free_direction(shell, walled, 7, 1.0) is None
    assert scenes._close_view(shell, walled, 7, 1.0).cut == 1.0


def test_a_view_is_right_handed():
    for toward in (scenes._TOWARD, np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])):
        right, up = scenes.axes_of(toward)
        assert np.cross(right, up) == pytest.approx(toward)
