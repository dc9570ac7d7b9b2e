import io
import math
from dataclasses import replace

import numpy as np
import pytest
from legible import assert_legible, written
from PIL import Image
from solved import by_hand

from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.theory import check_beam
from alula.loads.records.load_case import LoadCase
from alula.reports.figures import diagrams, drawings
from alula.reports.figures.sheet import plot, style
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.labels import along, place_labels
from alula.reports.figures.sheet.marks import Area, Stroke
from alula.reports.turnable.linkage import _loads as model_loads


def drawn(result, load_case="weight"):
    """The drawing and its sheet."""
    drawing = drawings._Drawing(result, load_case)
    return drawing, drawing.draw()


def covered(points, box):
    return ((points > box[:2]) & (points < box[2:])).all(axis=1).any()


def strokes(sheet, colour):
    return [mark for mark in sheet.marks if isinstance(mark, Stroke) and mark.colour == colour]


def test_the_linkage_shows_joints_links_forces_and_torque(result):
    _, sheet = drawn(result)
    texts = written(sheet)
    assert texts >= set("ABCDEFGH")
    assert texts >= {"link GF", "link AE", "link CF", "link CH", "link ED"}
    assert texts >= {"A: 0.952 N\non AE", "B: 0.698 N\non CF", "0.250 N\non CH", "130.6 N·mm\nclockwise on AE"}
    assert texts >= {"x [mm]", "y [mm]", "−300", "0", "150", "applied load", "drive torque"}
    assert "joint force; 0.5 N is 31 mm long" in texts
    assert_legible(sheet)


def loaded(result, **loads):
    """The same result with other stated loads in its load case, whose own forces are left out."""
    case = LoadCase.model_validate({"title": "", **loads})
    return replace(result, case=result.case.model_copy(update={"load_cases": {"weight": case}}))


def arrows(sheet, colour):
    """(start, tip) on the sheet of the arrows of a colour, the tip from their heads."""
    heads = [mark for mark in sheet.marks if isinstance(mark, Area) and mark.colour == colour]
    shafts = [sheet.marks[sheet.marks.index(head) - 1] for head in heads]
    return [(shaft.points[0], head.points[0]) for shaft, head in zip(shafts, heads, strict=True)]


@pytest.mark.parametrize(("axes", "turned"), [("global", 0.0), ("link", 1.0)])
@pytest.mark.parametrize("kind", ["forces", "spread"])
def test_a_load_points_where_it_acts(result, axes, turned, kind):
    """A load in its link's axes was once drawn in global ones: 142 degrees off for the owl wing's outer link."""
    where = {"forces": {"at": "H", "force": ["0 N", "-0.25 N"]},
             "spread": {"start": "C", "end": "D", "total": ["0 N", "-0.25 N"]}}[kind]  # fmt: skip
    drawing, sheet = drawn(loaded(result, **{kind: [{"link": "CH", "axes": axes, **where}]}))
    [(start, end)] = arrows(sheet, style.LOAD)
    at = result.pose.points
    assert start == pytest.approx(drawing.axes.at(at["H"] if kind == "forces" else (at["C"] + at["D"]) / 2.0))
    away = at["H"] - at["C"]
    expected = -(turned * math.atan2(away[1], away[0]) - math.pi / 2.0)  # y runs down on the sheet
    assert (end - start) / np.linalg.norm(end - start) == pytest.approx([math.cos(expected), math.sin(expected)])


def test_a_load_line_is_drawn_with_its_force_its_way_and_its_levers(result):
    """Two of them, far off the links; each force is told in space and begins where its lever does, not at the link."""
    one = {"from": ["-90 mm", "200 mm", "0 mm"], "to": ["40 mm", "-80 mm", "60 mm"], "force": "0.25 N"}
    other = {"from": ["-320 mm", "-60 mm"], "to": ["10 mm", "180 mm"], "force": "0.2 N"}
    ends = {"link": "CH", "at": "H"}, {"link": "AE", "at": "E", "leaves": {"link": "CH", "at": "H"}}
    drawing, sheet = drawn(loaded(result, load_lines=[one | ends[0], other | ends[1]]))
    assert written(sheet) >= {"0.250 N\non CH", "0.200 N\non AE", "0.200 N\non CH"}
    at = {name: drawing.axes.at(result.pose.position(*name.split())) for name in ("CH H", "AE E")}
    lines = [[drawing.axes.at([float(v.split()[0]) for v in line[key][:2]]) for key in ("from", "to")]
             for line in (one, other)]  # fmt: skip
    expected = [lines[0], (lines[0][0], at["CH H"]), lines[1], (lines[1][0], at["AE E"]), (lines[1][1], at["CH H"])]
    dashed = [mark for mark in strokes(sheet, style.LOAD) if mark.dashes is not None]
    assert np.array([mark.points for mark in dashed]) == pytest.approx(np.array(expected))
    ways = {(0.0, 1.0): lines[0], (1.0, 1.0): lines[1], (1.0, -1.0): lines[1]}
    for (start, tip), ((end, sense), line) in zip(arrows(sheet, style.LOAD), ways.items(), strict=True):
        assert start == pytest.approx(line[int(end and sense < 0.0)])
        way = sense * (line[1] - line[0])
        assert (tip - start) / np.linalg.norm(tip - start) == pytest.approx(way / np.linalg.norm(way))
    assert_legible(sheet)


def test_the_model_of_the_linkage_has_load_lines_where_they_enter(result):
    """One turns with its link, so that its force is in the link's axes; what leaves by another link does not."""
    line = {"from": ["-90 mm", "0 mm"], "to": ["-90 mm", "50 mm"], "force": "2 N", "link": "CH", "at": "H"}
    leaving = {**line, "axes": "link", "leaves": {"link": "AE", "at": "E"}}
    stated = loaded(result, load_lines=[line, leaving]).case
    found = [(one["link"], one["place"], one["turns"], one["force"]) for one in model_loads(stated)]
    points = result.case.link_points
    assert [one[:3] for one in found] == [
        ("CH", list(points["CH"]["H"]), False),
        ("CH", list(points["CH"]["H"]), True),
        ("AE", list(points["AE"]["E"]), False),
    ]
    turned = -2.0 * result.pose.rotation("CH")[:, 1]
    for one, force in zip(found, ([0.0, 2.0, 0.0], [0.0, 2.0, 0.0], [*turned, 0.0]), strict=True):
        assert one[3] == pytest.approx(force, abs=1e-3)


@pytest.mark.parametrize(("moment", "sense"), [("5 N*mm", "counter-clockwise"), ("-5 N*mm", "clockwise")])
def test_a_stated_moment_is_drawn_in_its_sense(result, moment, sense):
    drawing, sheet = drawn(loaded(result, moments=[{"link": "CH", "at": "H", "moment": moment}]))
    assert f"5.000 N·mm\n{sense} on CH" in written(sheet)
    [(start, end)] = arrows(sheet, style.LOAD)
    arm = (start + end) / 2.0 - drawing.axes.at(result.pose.points["H"])
    turn = arm[1] * (end - start)[0] - arm[0] * (end - start)[1]
    assert (turn > 0.0) == (sense == "counter-clockwise")


def test_the_linkage_is_drawn_to_scale_and_whole(result):
    drawing, sheet = drawn(result)
    low, high = drawing.axes.at([(0.0, 0.0), (100.0, 100.0)])
    assert high[0] - low[0] == pytest.approx(low[1] - high[1], rel=1e-9)
    left, top, right, bottom = drawing.axes.box
    for x, y in drawing.axes.at(list(result.pose.points.values())):
        assert 0.0 < left < x < right < sheet.width
        assert 0.0 < top < y < bottom < sheet.height


@pytest.mark.parametrize("name", ["result", "slider"])
def test_no_text_stands_on_the_arc_of_a_torque(name, request):
    checked = request.getfixturevalue(name)
    _, sheet = drawn(checked, next(iter(checked.load_cases)))
    [arc] = [line for line in strokes(sheet, style.TORQUE) if len(line.points) > 20]
    for text in sheet.texts:
        assert not covered(arc.points, text.box), text


def test_a_linkage_without_load_has_no_arrows(result):
    _, sheet = drawn(result, "idle")
    assert not any(" N" in text for text in written(sheet))
    assert arrows(sheet, style.JOINT_FORCE) == arrows(sheet, style.LOAD) == []


def test_equal_drawings_are_equal_bytes(result):
    one, other = (drawings.linkage_drawing(result, "idle") for _ in range(2))
    assert one.png() == other.png()
    assert one.svg() == other.svg()
    assert Image.open(io.BytesIO(one.png())).width == round(style.WIDTH * style.DPI)


def test_what_is_drawn_is_in_the_picture():
    sheet = Canvas(72.0, 36.0)
    sheet.area([(0.0, 0.0), (36.0, 0.0), (36.0, 36.0), (0.0, 36.0)], "#9fb1c1")
    sheet.line([(54.0, 0.0), (54.0, 36.0)], "#c8460b", 3.6)
    sheet.picture(np.full((2, 2, 3), (0, 103, 168)), (60.0, 0.0, 72.0, 36.0))
    sheet.write("H", (18.0, 18.0), colour="#000000", size=20.0)
    pixels = np.asarray(Image.open(io.BytesIO(sheet.png())).convert("RGB")).astype(int)
    assert pixels.shape == (style.DPI // 2, style.DPI, 3)
    assert tuple(pixels[5, 5]) == (0x9F, 0xB1, 0xC1)
    assert tuple(pixels[50, 150]) == (0xC8, 0x46, 0x0B)
    assert tuple(pixels[50, 120]) == (255, 255, 255)
    assert tuple(pixels[50, 180]) == (0, 103, 168)
    # The line is 3.6 points wide, ten pixels; the letter stands within its box.
    assert (pixels[50] == (0xC8, 0x46, 0x0B)).all(axis=1).sum() == pytest.approx(10, abs=1)
    dark = np.argwhere(pixels.sum(axis=2) < 60)
    left, top, right, bottom = np.array(sheet.texts[0].box) * style.DPI / 72.0
    assert len(dark) > 100
    assert dark.min(axis=0) == pytest.approx([top, left], abs=8)
    assert (dark.max(axis=0) <= [bottom, right]).all()


@pytest.mark.parametrize(
    ("low", "high", "most", "texts", "power"),
    [
        (-300.0, 55.0, 9, ["−300", "−250", "−200", "−150", "−100", "−50", "0", "50"], 0),
        (-0.1, 0.27, 4, ["−0.1", "0.0", "0.1", "0.2"], 0),
        (0.0, 0.9, 4, ["0.00", "0.25", "0.50", "0.75"], 0),
        (0.0, 2.6e7, 4, ["0", "10", "20"], 6),
        (0.0, 4.1e-5, 4, ["0", "20", "40"], -6),
        (-1.0, 1.0, 1, ["0"], 0),
    ],
)
def test_ticks_are_round_and_few(low, high, most, texts, power):
    assert plot.numbers(plot.ticks(low, high, most=most)) == (texts, power)


@pytest.mark.parametrize(("value", "rounded"), [(0.952, 0.5), (0.25, 0.2), (1.0, 1.0), (19.9, 10.0), (0.0, 0.0)])
def test_the_scale_arrow_is_round_and_not_larger(value, rounded):
    assert drawings._round_down(value) == pytest.approx(rounded)


def test_labels_of_one_anchor_stand_apart_and_off_the_lines():
    sheet = Canvas(360.0, 288.0)
    line = along(np.array([0.0, 144.0]), np.array([360.0, 144.0]), 400)
    labels = [(np.array([[180.0, 144.0]]), f"label {i}", "#000000") for i in range(6)]
    place_labels(sheet, (0.0, 0.0, 360.0, 288.0), labels, line, size=10.0)
    assert len(sheet.texts) == 6
    assert_legible(sheet)
    assert not any(covered(line, text.box) for text in sheet.texts)


def test_a_label_at_the_edge_stays_on_the_sheet():
    sheet = Canvas(216.0, 216.0)
    label = (np.array([[216.0, 216.0]]), "a rather long label", "#000000")
    place_labels(sheet, (0.0, 0.0, 216.0, 216.0), [label], np.zeros((0, 2)), size=10.0)
    assert_legible(sheet)


def test_a_label_takes_the_anchor_that_has_room():
    sheet = Canvas(288.0, 144.0)
    crowd = np.stack(np.meshgrid(np.linspace(0.0, 173.0, 100), np.linspace(0.0, 144.0, 100)), axis=-1).reshape(-1, 2)
    place_labels(
        sheet,
        (0.0, 0.0, 288.0, 144.0),
        [(np.array([[58.0, 72.0], [202.0, 72.0]]), "here", "#000000")],
        crowd,
        size=10.0,
    )
    [text] = sheet.texts
    assert text.box[0] > 173.0


def test_the_diagram_marks_extreme_values_and_points(result):
    beam = result.load_cases["weight"].links["CH"].beam
    sheet = diagrams.internal_force_diagram(beam, {"C": 0.0, "D": 77.0, "H": 124.0})
    texts = written(sheet)
    assert texts >= {"−0.3509", "C", "D", "H", "0.1968", "−0.1201", "9.249"}
    assert texts >= {"N [N]", "V [N]", "M [N·mm]", "x along the link [mm]", "120"}
    assert_legible(sheet)
    assert diagrams.internal_force_diagram(beam, {}).png().startswith(b"\x89PNG")


def test_what_is_nil_is_drawn_as_zero_not_as_rounding(result):
    sheet = diagrams.internal_force_diagram(result.load_cases["weight"].links["GF"].beam, {"G": 0.0, "F": 50.0})
    texts = [text.text for text in sheet.texts]
    assert texts.count("zero all along") == 2
    assert "−0.7511" in texts
    assert_legible(sheet)


def test_forces_out_of_the_plane_get_panels_of_their_own(result):
    section = result.case.parts["tube"].section
    loads = BeamLoads(
        points=(
            PointLoad(point=np.array([0.0, 0.0]), wrench=np.array([0.0, 0.0, -1.0, -2.0, 10.0, 0.0])),
            PointLoad(point=np.array([10.0, 0.0]), wrench=np.array([0.0, 0.0, 1.0, 2.0, 0.0, 0.0])),
        )
    )
    sheet = diagrams.internal_force_diagram(check_beam(loads, section, 40.0), {"A": 0.0})
    assert written(sheet) >= {"V out\nof plane\n[N]", "M out\nof plane\n[N·mm]", "torque\n[N·mm]"}
    assert_legible(sheet)


def test_six_rows_with_powers_of_ten_at_their_axes_are_legible(result):
    wrenches = np.array([[1.0, 2.0, -3.0, -40.0, 50.0, 60.0], [-1.0, -2.0, 3.0, 40.0, -20.0, -40.0]])  # in balance
    ends = tuple(PointLoad(point=np.array([x, 0.0]), wrench=1e-5 * w) for x, w in zip((0, 10.0), wrenches, strict=True))
    sheet = diagrams.internal_force_diagram(
        check_beam(BeamLoads(points=ends), result.case.parts["tube"].section, 40.0), {"A": 0.0}
    )
    assert sum("10⁻" in text.text for text in sheet.texts) >= 5
    assert_legible(sheet)


def test_extreme_values_have_the_unit_of_their_axis(result):
    pull = np.array([6.3e-4, 0.0, 0.0, 0.0, 0.0, 0.0])
    loads = BeamLoads(
        points=tuple(PointLoad(point=np.array([x, 0.0]), wrench=s * pull) for x, s in ((0.0, -1.0), (10.0, 1.0)))
    )
    texts = written(
        diagrams.internal_force_diagram(check_beam(loads, result.case.parts["tube"].section, 40.0), {"A": 0.0})
    )
    assert texts >= {"N [10⁻⁶ N]", "500", "630.0"}


def test_the_worst_load_case_is_drawn(result):
    from alula.reports.check.linkage import governing_load_cases

    assert governing_load_cases(result) == ("weight",)
    turned = {name: result.load_cases[name] for name in ("idle", "weight")}
    assert governing_load_cases(replace(result, load_cases=turned)) == (
        "weight",
        "idle",
    )  # that of the nearest check first
    unchecked = {name: replace(load_case, checks=()) for name, load_case in turned.items()}
    assert governing_load_cases(replace(result, load_cases=unchecked)) == ("idle", "weight")


@pytest.mark.parametrize(
    ("load_case", "words"),
    [
        ("held", "Own weight of the links acts as well and is not drawn."),
        ("flapping", "Own weight and inertia of the links act as well and are not drawn."),
    ],
)
def test_a_picture_says_what_acts_and_is_not_drawn(load_case, words):
    from alula.reports.check.linkage import linkage_picture

    assert words in linkage_picture(by_hand("flapping-wing-chosen"), load_case).caption


def test_a_slider_runs_in_its_guide(slider):
    drawing, sheet = drawn(slider, "push")
    assert {"piston.S", "frame.S", "20.6 N\non piston", "622.6 N·mm\nclockwise on crank"} <= written(sheet)
    assert_legible(sheet)
    x, y = drawing.axes.at(slider.pose.position("piston", "S"))
    sides = [line.points for line in strokes(sheet, style.GROUND) if line.width == 1.1]
    level = [points[0, 1] for points in sides if points[0, 1] == points[1, 1] and points[0, 0] < x < points[1, 0]]
    assert min(level) < y < max(level)


CROWD = {"A": 0.0, "pin-left": 10.0, "pin-right": 10.0, "next-to-it": 12.0, "D": 100.0}


def test_names_of_one_place_and_of_near_ones_are_not_written_over_each_other(result):
    """Two pins of one arm stand at the same x along their link."""
    section = result.case.parts["tube"].section
    loads = BeamLoads(
        points=(
            PointLoad(point=np.array([0.0, 0.0]), wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0])),
            PointLoad(point=np.array([100.0, 0.0]), wrench=np.array([0.0, 1.0, 0.0, 0.0, 0.0, -100.0])),
        )
    )
    sheet = diagrams.internal_force_diagram(check_beam(loads, section, 40.0), CROWD)
    assert {"A", "pin-left, pin-right", "next-to-it", "D"} <= written(sheet)
    assert_legible(sheet)


def test_labels_keep_off_the_whole_symbol_of_a_support(result):
    """Both slanted sides and the hatching were once open to labels, whose rims hid them."""
    drawing = drawings._Drawing(result, "weight")
    before = len(drawing.sheet.marks)
    points = drawing._support(("AG",), np.array([0.0, 0.0]))
    drawn = [mark.points for mark in drawing.sheet.marks[before:] if isinstance(mark, Stroke)]
    kept = drawing.axes.at(points)
    for line in drawn:
        middle = line[:2].mean(axis=0)
        assert np.hypot(*(kept - middle).T).min() < 4.0  # points on the sheet: less than half a letter is high
