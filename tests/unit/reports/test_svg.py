"""A sheet as SVG: well-formed, of presentation attributes alone, with every mark and text where the sheet has it."""

import base64
import io
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.letters import extent

NAMES = "{http://www.w3.org/2000/svg}"
ALLOWED = {
    *("viewBox", "width", "height", "role", "aria-label", "fill", "stroke", "stroke-width", "stroke-dasharray", "d"),
    *("stroke-linejoin", "paint-order", "font-family", "font-size", "font-weight", "text-anchor", "textLength"),
    *("lengthAdjust", "transform", "x", "y", "href", "preserveAspectRatio"),
}


def parsed(sheet, alt=""):
    return ElementTree.fromstring(sheet.svg(alt))


def places(path):
    """Return the corners of the pieces of a path of M, l, h, v and z."""
    found, at = [], np.zeros(2)
    for command, told in re.findall(r"([MlhvzZ])([^MlhvzZ]*)", path):
        values = [float(one) for one in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", told)]
        if command == "z":
            found[-1].append(found[-1][0])
            continue
        steps = {
            "M": lambda v: np.reshape(v, (-1, 2)),
            "l": lambda v: np.reshape(v, (-1, 2)),
            "h": lambda v: np.column_stack([v, np.zeros(len(v))]),
            "v": lambda v: np.column_stack([np.zeros(len(v)), v]),
        }[command](values)
        for step in steps:
            at = step if command == "M" else at + step
            found.append([tuple(at)]) if command == "M" else found[-1].append(tuple(at))
    return [np.array(piece) for piece in found]


def test_lines_and_areas_stand_where_the_sheet_has_them():
    sheet = Canvas(100.0, 50.0)
    line = np.array([[1.234, 2.0], [3.0, -4.567], [3.0, 8.0], [60.0, 8.0], [59.5, 7.5]])
    sheet.line(line, "#123456", 1.25, dashes=(2.0, 1.5))
    triangle = np.array([[10.0, 10.0], [10.0, 30.0], [30.0, 10.0]])  # the other way round than the next
    sheet.area(triangle, "#abcdef")
    sheet.area(triangle[::-1] + 5.0, "#abcdef", "#000000", 0.5)
    drawn = {path.get("fill") or path.get("stroke"): path for path in parsed(sheet).iter(f"{NAMES}path")}
    [found] = places(drawn["#123456"].get("d"))
    np.testing.assert_allclose(found, np.round(line, 2), atol=1e-9)
    assert (drawn["#123456"].get("stroke-width"), drawn["#123456"].get("stroke-dasharray")) == ("1.25", "2 1.5")
    both = places(drawn["#abcdef"].get("d"))
    assert len(both) == 2
    for piece, corners in zip(both, (triangle, triangle + 5.0), strict=True):
        assert {tuple(corner) for corner in piece} == {tuple(corner) for corner in corners}
        x, y = piece.T
        assert np.dot(x[:-1], y[1:]) - np.dot(y[:-1], x[1:]) > 0.0  # where they overlap is no hole
    assert drawn["#000000"].get("stroke-width") == ".5"


def test_what_is_drawn_later_covers_what_is_drawn_earlier():
    sheet = Canvas(10.0, 10.0)
    for colour in ("#111111", "#222222", "#111111"):
        sheet.area([(1, 1), (9, 1), (9, 9)], colour)
    assert re.findall(r'fill="#(\d{6})"', sheet.svg()) == ["111111", "222222", "111111"]


def test_circles_are_arcs():
    sheet = Canvas(100.0, 50.0)
    sheet.disc((20.0, 30.0), 4.0, "#ffffff", "#000000", 1.0)
    told = sheet.svg()
    assert told.count("M16 30a4 4 0 1 1 8 0a4 4 0 1 1 -8 0z") == 2
    np.testing.assert_allclose(np.hypot(*(sheet.marks[0].points - (20.0, 30.0)).T), 4.0)


@pytest.mark.parametrize("side", ["left", "center", "right"])
def test_texts_have_their_place_and_width(side):
    sheet = Canvas(300.0, 100.0)
    words = 'torque\nM < 3 & "W"'
    written = sheet.write(words, (150.0, 50.0), anchor=f"{side} middle", size=8.5, bold=True, halo=2.0)
    group = next(one for one in parsed(sheet).iter(f"{NAMES}g") if one.get("font-size"))
    assert (group.get("font-size"), group.get("font-weight"), group.get("paint-order")) == ("8.5", "bold", "stroke")
    lines = list(group)
    assert [line.text for line in lines] == ["torque", 'M < 3 & "W"']
    for line in lines:
        assert float(line.get("textLength")) == pytest.approx(extent(line.text, 8.5, bold=True)[0], abs=0.01)
        assert written.box[1] < float(line.get("y")) < written.box[3]
    x = {"left": written.box[0], "center": 150.0, "right": written.box[2]}[side]
    assert [float(line.get("x")) for line in lines] == pytest.approx([x, x], abs=0.01)
    anchors = {"left": None, "center": "middle", "right": "end"}
    assert group.get("text-anchor") == anchors[side]


def test_an_upright_text_turns_about_its_middle():
    sheet = Canvas(100.0, 200.0)
    written = sheet.write("M [N·mm]", (20.0, 90.0), turned=True)
    [text] = parsed(sheet).iter(f"{NAMES}text")
    assert text.get("transform") == f"rotate(-90 {text.get('x')} {text.get('y')})"
    assert float(text.get("y")) == pytest.approx(90.0)
    assert written.box[0] < float(text.get("x")) < written.box[2]


def test_a_picture_in_it_loses_nothing():
    pixels = np.random.default_rng(0).integers(0, 255, (20, 30, 3), dtype=np.uint8)
    sheet = Canvas(100.0, 100.0)
    sheet.picture(pixels, (10.0, 20.0, 40.0, 40.0))
    [image] = parsed(sheet).iter(f"{NAMES}image")
    assert [image.get(name) for name in ("x", "y", "width", "height")] == ["10", "20", "30", "20"]
    data = base64.b64decode(image.get("href").removeprefix("data:image/webp;base64,"))
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(data)).convert("RGB")), pixels)


def test_it_has_what_the_policy_of_pages_allows_and_says_what_it_is():
    sheet = Canvas(72.0, 36.0)
    sheet.line(np.zeros((0, 2)), "#000000")
    sheet.line([(0.004, 0.0), (-0.004, 0.0)], "#000000")
    sheet.disc((20.0, 30.0), 4.0, "#ffffff", "#000000")
    sheet.write("<script>alert(1)</script>", (30.0, 20.0), halo=1.0)
    sheet.write("up", (30.0, 20.0), turned=True)
    sheet.picture(np.zeros((2, 2, 3), dtype=np.uint8), (0.0, 0.0, 9.0, 9.0))
    root = parsed(sheet, 'a "picture" <of> what & more')
    assert (root.get("role"), root.get("aria-label")) == ("img", 'a "picture" <of> what & more')
    assert (root.get("viewBox"), root.get("width"), root.get("height")) == ("0 0 72 36", "96", "48")
    assert {name for one in root.iter() for name in one.attrib} <= ALLOWED
    assert {one.tag.removeprefix(NAMES) for one in root.iter()} == {"svg", "g", "path", "text", "image"}
    assert sheet.svg() == sheet.svg()
    assert "-0 " not in sheet.svg()
    assert '-0"' not in sheet.svg()
