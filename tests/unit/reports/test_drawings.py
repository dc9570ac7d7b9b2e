import io
import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.image import imread

from fea.beam.loads import BeamLoads, PointLoad
from fea.beam.theory import check_beam
from loads.records.load_case import LoadCase
from reports.figures import diagrams, drawings
from reports.figures.labels import along, place_labels


@pytest.fixture
def sheets(monkeypatch):
    """The figures themselves instead of their PNG."""
    found = []

    def keep(figure):
        figure.canvas.draw()
        found.append(figure)
        return b""

    monkeypatch.setattr(drawings, "as_png", keep)
    monkeypatch.setattr(diagrams, "as_png", keep)
    return found


def boxes(figure):
    """(text, box in pixels) of everything written on the axes, axis labels apart."""
    renderer = figure.canvas.get_renderer()
    return [
        (text.get_text(), text.get_window_extent(renderer))
        for axes in figure.axes
        for text in axes.texts
        if text.get_text()
    ]


def overlaps(first, second):
    return (
        min(first.x1, second.x1) - max(first.x0, second.x0) > 0.5
        and min(first.y1, second.y1) - max(first.y0, second.y0) > 0.5
    )


def assert_legible(figure):
    page = figure.bbox
    found = boxes(figure)
    for text, box in found:
        assert box.x0 >= 0, text
        assert box.y0 >= 0, text
        assert box.x1 <= page.width, text
        assert box.y1 <= page.height, text
    clashes = [(a, b) for (a, first), (b, second) in itertools.combinations(found, 2) if overlaps(first, second)]
    assert clashes == []


def test_the_linkage_shows_joints_links_forces_and_torque(result, sheets):
    drawings.linkage_drawing(result, "weight")
    [figure] = sheets
    texts = {text for text, _ in boxes(figure)}
    assert texts >= set("ABCDEFGH")
    assert texts >= {"link GF", "link AE", "link CF", "link CH", "link ED"}
    assert texts >= {"A: 0.952 N\non AE", "B: 0.698 N\non CF", "0.250 N\non CH", "130.6 N·mm\nclockwise on AE"}
    assert_legible(figure)


def loaded(result, **loads):
    """The same result with other stated loads in its load case, whose own forces are left out."""
    case = LoadCase.model_validate({"title": "", **loads})
    return replace(result, case=result.case.model_copy(update={"load_cases": {"weight": case}}))


def arrows(figure, colour):
    """(start, end) of the arrows of a colour."""
    wanted = to_rgba(colour)
    return [
        (np.array(text.xyann), np.array(text.xy))
        for text in figure.axes[0].texts
        if getattr(text, "arrow_patch", None) is not None and text.arrow_patch.get_edgecolor() == wanted
    ]


@pytest.mark.parametrize(("axes", "turned"), [("global", 0.0), ("link", 1.0)])
@pytest.mark.parametrize("kind", ["forces", "spread"])
def test_a_load_points_where_it_acts(result, sheets, axes, turned, kind):
    """A load in its link's axes was once drawn in global ones: 142 degrees off for the owl wing's outer link."""
    where = {"forces": {"at": "H", "force": ["0 N", "-0.25 N"]},
             "spread": {"start": "C", "end": "D", "total": ["0 N", "-0.25 N"]}}[kind]  # fmt: skip
    drawings.linkage_drawing(loaded(result, **{kind: [{"link": "CH", "axes": axes, **where}]}), "weight")
    [(start, end)] = arrows(sheets[0], drawings.LOAD)
    at = result.pose.points
    assert start == pytest.approx(at["H"] if kind == "forces" else (at["C"] + at["D"]) / 2.0)
    away = at["H"] - at["C"]
    expected = turned * math.atan2(away[1], away[0]) - math.pi / 2.0
    assert (end - start) / np.linalg.norm(end - start) == pytest.approx([math.cos(expected), math.sin(expected)])


@pytest.mark.parametrize(("moment", "sense"), [("5 N*mm", "counter-clockwise"), ("-5 N*mm", "clockwise")])
def test_a_stated_moment_is_drawn_in_its_sense(result, sheets, moment, sense):
    drawings.linkage_drawing(loaded(result, moments=[{"link": "CH", "at": "H", "moment": moment}]), "weight")
    assert f"5.000 N·mm\n{sense} on CH" in {text for text, _ in boxes(sheets[0])}
    [(start, end)] = arrows(sheets[0], drawings.LOAD)
    arm = (start + end) / 2.0 - result.pose.points["H"]
    turn = arm[0] * (end - start)[1] - arm[1] * (end - start)[0]
    assert (turn > 0.0) == (sense == "counter-clockwise")


def test_the_linkage_is_drawn_to_scale_and_whole(result, sheets):
    drawings.linkage_drawing(result, "weight")
    [axes] = sheets[0].axes
    low, high = axes.transData.transform([(0.0, 0.0), (100.0, 100.0)])
    assert high[0] - low[0] == pytest.approx(high[1] - low[1], rel=1e-9)
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    for x, y in result.pose.points.values():
        assert x0 < x < x1
        assert y0 < y < y1


@pytest.mark.parametrize("name", ["result", "slider"])
def test_no_text_stands_on_the_arc_of_a_torque(name, sheets, request):
    checked = request.getfixturevalue(name)
    drawings.linkage_drawing(checked, next(iter(checked.load_cases)))
    [figure] = sheets
    [arc] = [line for line in figure.axes[0].lines if line.get_color() == drawings.TORQUE]
    drawn = figure.axes[0].transData.transform(np.column_stack([arc.get_xdata(), arc.get_ydata()]))
    for text, box in boxes(figure):
        inside = ((drawn > (box.x0, box.y0)) & (drawn < (box.x1, box.y1))).all(axis=1)
        assert not inside.any(), text


def test_a_linkage_without_load_has_no_arrows(result, sheets):
    drawings.linkage_drawing(result, "idle")
    texts = {text for text, _ in boxes(sheets[0])}
    assert not any(" N" in text for text in texts)


def test_equal_drawings_are_equal_bytes(result):
    first = drawings.linkage_drawing(result, "idle")
    assert first == drawings.linkage_drawing(result, "idle")
    assert imread(io.BytesIO(first)).shape[1] == round(drawings.WIDTH * drawings.DPI)


@pytest.mark.parametrize(("value", "rounded"), [(0.952, 0.5), (0.25, 0.2), (1.0, 1.0), (19.9, 10.0), (0.0, 0.0)])
def test_the_scale_arrow_is_round_and_not_larger(value, rounded):
    assert drawings._round_down(value) == pytest.approx(rounded)


def test_labels_of_one_anchor_stand_apart_and_off_the_lines():
    figure = Figure(figsize=(5.0, 4.0), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0.0, 100.0)
    axes.set_ylim(0.0, 80.0)
    line = along(np.array([0.0, 40.0]), np.array([100.0, 40.0]), 400)
    place_labels(axes, [(np.array([[50.0, 40.0]]), f"label {i}", "black") for i in range(6)], line, fontsize=10.0)
    assert_legible(figure)
    drawn = axes.transData.transform(line)
    for _, box in boxes(figure):
        assert not ((drawn > (box.x0, box.y0)) & (drawn < (box.x1, box.y1))).all(axis=1).any()


def test_a_label_at_the_edge_stays_on_the_sheet():
    figure = Figure(figsize=(3.0, 3.0), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    place_labels(axes, [(np.array([[1.0, 1.0]]), "a rather long label", "black")], np.zeros((0, 2)), fontsize=10.0)
    assert_legible(figure)


def test_the_diagram_marks_extreme_values_and_points(result, sheets):
    beam = result.load_cases["weight"].links["CH"].beam
    diagrams.internal_force_diagram(beam, {"C": 0.0, "D": 77.0, "H": 124.0})
    [figure] = sheets
    texts = [text for text, _ in boxes(figure)]
    assert texts == ["−0.3509", "C", "D", "H", "0.1968", "−0.1201", "9.249"]
    assert [axes.get_ylabel() for axes in figure.axes] == ["N [N]", "V [N]", "M [N·mm]"]
    assert figure.axes[-1].get_xlabel() == "x along the link [mm]"
    assert_legible(figure)


def test_what_is_nil_is_drawn_as_zero_not_as_rounding(result, sheets):
    diagrams.internal_force_diagram(result.load_cases["weight"].links["GF"].beam, {"G": 0.0, "F": 50.0})
    texts = [text for text, _ in boxes(sheets[0])]
    assert texts.count("zero all along") == 2
    assert "−0.7511" in texts


def test_forces_out_of_the_plane_get_panels_of_their_own(result, sheets):
    section = result.case.parts["tube"].section
    loads = BeamLoads(
        points=(
            PointLoad(point=np.array([0.0, 0.0]), wrench=np.array([0.0, 0.0, -1.0, -2.0, 10.0, 0.0])),
            PointLoad(point=np.array([10.0, 0.0]), wrench=np.array([0.0, 0.0, 1.0, 2.0, 0.0, 0.0])),
        )
    )
    diagrams.internal_force_diagram(check_beam(loads, section, 40.0), {"A": 0.0})
    labels = [axes.get_ylabel() for axes in sheets[0].axes]
    assert labels[3:] == ["V out of\nplane [N]", "M out of\nplane [N·mm]", "torque [N·mm]"]


def test_the_worst_load_case_is_drawn(result):
    from reports.page.pictures import governing_load_cases

    assert governing_load_cases(result) == ("weight",)
    turned = {name: result.load_cases[name] for name in ("idle", "weight")}
    assert governing_load_cases(replace(result, load_cases=turned)) == ("idle", "weight")


def test_a_label_takes_the_anchor_that_has_room():
    figure = Figure(figsize=(4.0, 2.0), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    crowd = np.stack(np.meshgrid(np.linspace(0.0, 0.6, 100), np.linspace(0.0, 1.0, 100)), axis=-1).reshape(-1, 2)
    place_labels(axes, [(np.array([[0.2, 0.5], [0.7, 0.5]]), "here", "black")], crowd, fontsize=10.0)
    [(_, box)] = boxes(figure)
    assert box.x0 > 0.6 * figure.bbox.width


def test_a_slider_runs_in_its_guide(slider, sheets):
    drawings.linkage_drawing(slider, "push")
    [figure] = sheets
    texts = {text for text, _ in boxes(figure)}
    assert {"piston.S", "frame.S", "20.6 N\non piston", "622.6 N·mm\nclockwise on crank"} <= texts
    assert_legible(figure)
    x, y = slider.pose.position("piston", "S")
    sides = [
        line.get_ydata()[0]
        for line in figure.axes[0].lines
        if len(line.get_xdata()) > 50 and np.allclose(line.get_ydata(), line.get_ydata()[0]) and line.get_xdata()[0] < x
    ]
    assert min(sides) < y < max(sides)


CROWD = {"A": 0.0, "pin-left": 10.0, "pin-right": 10.0, "next-to-it": 12.0, "D": 100.0}


def test_names_of_one_place_and_of_near_ones_are_not_written_over_each_other(result, sheets):
    """Two pins of one arm stand at the same x along their link."""
    section = result.case.parts["tube"].section
    loads = BeamLoads(
        points=(
            PointLoad(point=np.array([0.0, 0.0]), wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0])),
            PointLoad(point=np.array([100.0, 0.0]), wrench=np.array([0.0, 1.0, 0.0, 0.0, 0.0, -100.0])),
        )
    )
    diagrams.internal_force_diagram(check_beam(loads, section, 40.0), CROWD)
    [figure] = sheets
    texts = {text for text, _ in boxes(figure)}
    assert {"A", "pin-left, pin-right", "next-to-it", "D"} <= texts
    assert_legible(figure)
