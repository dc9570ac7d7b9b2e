"""Pictures of links in layers: to scale, legible, each layer in its colour, and where two touch."""

import numpy as np
import pytest
import shapely
from bars_in_layers import bar_on_a_pin, four_bars, parallel_bars
from legible import assert_legible, written

from alula.loads.states.clearance import clearance
from alula.loads.states.extent import extent
from alula.reports.figures.outlines.assembly import LAYERS, Placed, assembly_drawing, layer_colours
from alula.reports.figures.outlines.box import box_drawing
from alula.reports.figures.outlines.contact import contact_drawing
from alula.reports.figures.sheet.canvas import faint
from alula.reports.figures.sheet.marks import Area, Stroke
from alula.reports.figures.sheet.style import INK, JOINT_FORCE


@pytest.fixture(scope="module")
def found():
    return clearance(parallel_bars())


def test_the_assembly_shows_links_pins_and_layers(found):
    sheet = assembly_drawing(found)
    texts = written(sheet)
    assert texts >= {"link crank", "link coupler", "link rocker", "link base", "A", "B", "C", "D"}
    assert texts >= {"From above, to scale", "From the side, along y, heights stretched 2 times", "x [mm]", "z [mm]"}
    assert "layer 1, mid-plane at z = 10 mm: crank, rocker" in texts
    assert "layer 0, mid-plane at z = 0 mm: base (without a part, dashed)" in texts
    assert_legible(sheet)


def test_a_link_has_the_colour_of_its_layer(found):
    colours = layer_colours(found.assembly.case)
    assert (colours["crank"], colours["coupler"]) == (colours["rocker"], LAYERS[2])
    sheet = assembly_drawing(found)
    areas = [mark for mark in sheet.marks if isinstance(mark, Area)]
    assert {faint(colours[link], 0.42) for link in ("crank", "coupler")} <= {mark.colour for mark in areas}


def test_outlines_are_drawn_to_scale(found):
    """The crank is 136 mm long and 16 mm wide: an area of 120 x 16 mm and a circle, at one scale along x and y."""
    sheet = assembly_drawing(found)
    colour = faint(layer_colours(found.assembly.case)["crank"], 0.42)
    bars = [shapely.Polygon(m.points) for m in sheet.marks if isinstance(m, Area) and m.colour == colour][:2]
    areas = sorted(bar.area for bar in bars)
    box = shapely.minimum_rotated_rectangle(bars[0]).exterior
    sides = sorted(np.hypot(*np.diff(np.asarray(box.coords), axis=0).T))
    scale = sides[-1] / 136.0
    assert sides[0] == pytest.approx(16.0 * scale, rel=1e-3)
    assert areas == pytest.approx(2 * [(120.0 * 16.0 + np.pi * 64.0) * scale**2], rel=1e-3)


def test_a_hole_is_cut_out_of_what_is_drawn():
    from alula.reports.figures.outlines.assembly import rings

    square = shapely.box(0.0, 0.0, 10.0, 10.0).difference(shapely.box(4.0, 4.0, 6.0, 6.0))
    [ring] = rings(square)
    x, y = ring.T
    assert abs(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) == pytest.approx(96.0)


def test_the_first_contact_is_shown_at_its_pose(found):
    sheet = contact_drawing(found)
    texts = written(sheet)
    assert "first contact of link crank and link rocker" in texts
    assert any(text.startswith("at crank = 9.21 deg, x = ") for text in texts)
    assert {"The whole linkage", "Close-up", "link crank", "link rocker"} <= texts
    assert_legible(sheet)
    placed = Placed(found.assembly, found.placed(found.contact))
    assert placed.links["crank"].distance(placed.links["rocker"]) == pytest.approx(0.0, abs=1e-3)
    assert found.stated.angle("crank") == pytest.approx(np.radians(60.0))


def test_the_least_gap_is_a_line_between_both():
    found = clearance(four_bars((0, 1, 2, 1), (120.0, 100.0, 120.0, 100.0), start=60, end=12, near=(0, 60)))
    sheet = contact_drawing(found)
    assert "least gap, 4.79 mm, of link crank and link rocker" in written(sheet)
    assert_legible(sheet)
    lines = [m for m in sheet.marks if isinstance(m, Stroke) and m.colour == "#c8460b" and len(m.points) == 2]
    assert len(lines) == 2  # on the whole, and on the close-up


def test_a_pin_that_is_touched_has_its_name():
    sheet = contact_drawing(clearance(bar_on_a_pin()))
    assert {"link crank", "pin D", "first contact of link crank and pin D"} <= written(sheet)
    assert_legible(sheet)


def test_the_box_is_drawn_to_scale_with_its_lengths_and_limits():
    """From 60 to 5 degrees: 100 + 120 cos 5° + 16 mm by 120 sin 60° + 16 mm, by 23 mm of layers."""
    case = parallel_bars()
    sheet = box_drawing(extent(case, case.solve_pose()), (230.0, 150.0, 20.0))
    texts = {text.text: text.colour for text in sheet.texts}
    assert texts["235.5 mm of 230 mm"] == texts["23 mm of 20 mm"] == JOINT_FORCE
    assert texts["119.9 mm of 150 mm"] == INK
    assert {"From above, to scale", "the limits, about the middle of the box"} <= texts.keys()
    assert_legible(sheet)
    lines = [mark for mark in sheet.marks if isinstance(mark, Stroke) and len(mark.points) == 5]
    [plan, side] = [mark.points for mark in lines if mark.colour == INK and mark.width == 1.2][:2]
    wide, tall = np.ptp(plan, axis=0)
    lengths = 116.0 + 120.0 * np.cos(np.radians(5.0)), 16.0 + 60.0 * np.sqrt(3.0)
    assert wide / tall == pytest.approx(lengths[0] / lengths[1], rel=1e-4)
    assert np.ptp(side, axis=0)[0] == pytest.approx(wide)
