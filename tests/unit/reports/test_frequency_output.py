"""What people see of natural frequencies: shapes, Campbell's diagram, page, tables, notebook."""

import csv
import json
import re
from dataclasses import replace
from functools import cache

import numpy as np
import programs
import pytest
from frequency_cases import LEVER, lever
from legible import assert_legible, written
from result_paths import compare

import alula
from alula.fea.common.band import Band
from alula.fea.vibration.over_motion import case_frequencies
from alula.geometry.base.errors import CaseError
from alula.reports.commands.frequencies import UNITS
from alula.reports.figures.sheet.marks import Area, Stroke
from alula.reports.figures.sheet.style import GROUND, JOINT_FORCE, LINK, LOAD
from alula.reports.figures.vibration.campbell import NO_BANDS, UPPER_ENDS, campbell_diagram
from alula.reports.figures.vibration.shapes import axis_lines, shapes_drawing
from alula.reports.renderers.record import as_brief_record, field_units
from alula.reports.sections.frequencies import frequencies_section


@cache
def found():
    return case_frequencies(lever(), poses=3)


def recorded(of):
    """The record of natural frequencies, as a file holds it."""
    head = {"case": "lever.toml", "title": of.case.title, "units": UNITS}
    return as_brief_record([frequencies_section(of)], **head)


def paths(value, prefix=""):
    """Paths of all numbers, without the indices of lists."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from paths(item, f"{prefix}.{key}".lstrip("."))
    elif isinstance(value, list):
        for item in value:
            yield from paths(item, prefix)
    elif isinstance(value, int | float):
        yield prefix


def strokes(sheet, colour):
    return [mark for mark in sheet.marks if isinstance(mark, Stroke) and mark.colour == colour]


def test_shapes_are_named_by_frequency_band_and_direction():
    modes = found().histories["turning"].lowest
    own = [
        replace(mode, frequency=Band(value=f, low=0.9 * f, high=1.1 * f), in_plane=share)
        for mode, f, share in zip(modes.modes, (43.2, 61.0, 90.3, 210.0), (1.0, 0.7, 0.3, 0.0), strict=True)
    ]
    sheet = shapes_drawing(replace(modes, modes=tuple(own)))
    assert written(sheet) >= {
        "1: 43.2 (38.9 to 47.5) Hz, in the plane",
        "2: 61.0 (54.9 to 67.1) Hz, mostly in the plane",
        "3: 90.3 (81.3 to 99.3) Hz, mostly out of the plane",
        "4: 210 (189 to 231) Hz, out of the plane",
        *("at rest", "at the end of its swing, enlarged", "x", "y", "z"),
    }
    assert_legible(sheet)
    for mark in sheet.marks:
        if isinstance(mark, Stroke):
            assert (mark.points >= 0.0).all()
            assert (mark.points <= [sheet.width, sheet.height]).all()


def test_a_shape_out_of_the_plane_is_seen():
    """The lever, at 0 deg, bends along z: on the sheet its tip stands above or below where it rests, upright."""
    modes = found().histories["turning"].lowest
    first = replace(modes, modes=modes.modes[:1])
    assert modes.modes[0].in_plane < 0.01
    sheet = shapes_drawing(first)
    rest, moved = ([stroke.points for stroke in strokes(sheet, colour)] for colour in (LINK, LOAD))
    tip = max(range(len(modes.model.elements)), key=lambda i: np.abs(moved[i][-1] - rest[i][-1]).max())
    across, up = moved[tip][-1] - rest[tip][-1]
    assert abs(up) > 20.0
    assert abs(across) < 0.01 * abs(up)


def test_between_its_nodes_a_beam_bends_as_a_cubic():
    """w = 3 s² - 2 s³ has no slope at either end: by the end's displacement alone, without rotation."""
    model = found().histories["turning"].lowest.model
    shape = np.zeros((len(model.nodes), 6))
    element = model.elements[1]
    shape[element.nodes[1], 2] = 1.0
    [line, still] = [axis_lines(model, s)[1] for s in (shape, None)]
    s = np.linspace(0.0, 1.0, len(line))
    assert (line - still)[:, 2] == pytest.approx(3.0 * s**2 - 2.0 * s**3)
    assert (line - still)[:, :2] == pytest.approx(0.0)


def history(count=3, poses=25):
    at = np.linspace(0.0, 2.0 * np.pi, poses)
    f = np.column_stack([20.0 + 6.0 * np.sin(at), 38.0 + 5.0 * np.cos(2.0 * at), 300.0 + 0.0 * at])[:, :count]
    return replace(found().histories["turning"], driving=3.0, at=at, frequencies=f, low=0.9 * f, high=1.1 * f)


def test_campbells_diagram_has_units_harmonics_and_marks_where_they_meet():
    sheet = campbell_diagram(history(), coordinate="crank", unit="deg", load_case="flapping")
    assert written(sheet) >= {
        *(
            "crank [deg]",
            "frequency [Hz]",
            "speed of the drive [rpm]",
            "Over the motion",
            "Over the speed of the drive",
        ),
        *("1st", "2nd natural frequency", "harmonic of the drive", "harmonic within the band of a natural frequency"),
        "load case flapping: 180 rpm (upright line), 3 Hz",
        *("2×", "10×"),
    }
    assert "3rd natural frequency" not in written(sheet)  # at 300 Hz the others would lie on the axis
    assert_legible(sheet)
    assert strokes(sheet, JOINT_FORCE)
    apart = replace(history(1), driving=0.1)  # 20 Hz is 200 times that
    quiet = strokes(campbell_diagram(apart, coordinate="crank", unit="deg", load_case="flapping"), JOINT_FORCE)
    assert len(quiet) == 1  # of the legend


def test_harmonics_far_below_the_frequencies_are_one_line_with_the_name_of_the_highest():
    """At 0.05 Hz ten of them lie within 0.5 Hz of a scale of 30 Hz, on 4 of 230 points."""
    slow = replace(history(1), driving=0.05)
    sheet = campbell_diagram(slow, coordinate="crank", unit="deg", load_case="flapping")
    assert "10×" in written(sheet)
    assert not {f"{n}×" for n in range(1, 10)} & written(sheet)
    levels = {float(one.points[0][1]) for one in strokes(sheet, GROUND) if one.dashes and len(one.points) == 2}
    assert len(levels) <= 5


@pytest.mark.parametrize(
    ("end", "told"),
    [(np.inf, f"{NO_BANDS}; any harmonic may meet them."), (1.1, f"{UPPER_ENDS}; any harmonic below may meet them.")],
)
def test_a_band_without_two_ends_is_not_filled(end, told):
    """Of parts from files no beam gives a band, and where pins may run it goes down to 0: it would cover all others."""
    own = history()
    missing = np.where(np.arange(3) < 2, own.frequencies, np.inf)
    sheet = campbell_diagram(
        replace(own, frequencies=missing, low=0.0 * own.low, high=end * own.frequencies),
        coordinate="crank",
        unit="deg",
        load_case="flapping",
    )
    assert_legible(sheet)
    assert told in written(sheet)
    assert not strokes(sheet, JOINT_FORCE), "no harmonic is marked as within a band that is not shown"
    tallest = max(float(np.ptp(mark.points[:, 1])) for mark in sheet.marks if isinstance(mark, Area))
    assert tallest < 60.0, "of 230 points: the range of the values over the motion"
    for mark in sheet.marks:
        assert np.isfinite(mark.points).all()
        assert (mark.points >= 0.0).all()
        assert (mark.points <= [sheet.width, sheet.height]).all()


@pytest.mark.parametrize("change", [{"driving": 0.0}, {"poses": 1}])
def test_without_a_speed_or_a_motion_one_panel_is_left(change):
    own = history(poses=change.get("poses", 25))
    if "driving" in change:
        own = replace(own, driving=0.0)
    sheet = campbell_diagram(own, coordinate="crank", unit="deg", load_case="flapping")
    assert_legible(sheet)
    assert len({"Over the motion", "Over the speed of the drive"} & written(sheet)) == 1


def test_the_command_writes_page_tables_and_pictures(tmp_path):
    (tmp_path / "lever.toml").write_text(LEVER, encoding="utf-8")
    done = programs.inside("frequencies", "lever.toml", "--poses", "3", "-o", "out", folder=tmp_path)
    assert (done.returncode, "over the driving frequency of 10 Hz that is" in " ".join(done.stdout.split())) == (
        0,
        True,
    )
    folder = tmp_path / "out" / "frequencies"
    record = json.loads((folder / "result.json").read_text(encoding="utf-8"))["frequencies"]
    one = record["load_cases"]["turning"]
    assert one["driving"] == pytest.approx(10.0)
    assert one["lowest"]["ratio"]["value"] == pytest.approx(one["lowest"]["frequency"]["value"] / 10.0)
    with (folder / "frequencies.csv").open(encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    assert rows[0][:5] == ["load case", "lever [deg]", "1 frequency [Hz]", "1 low [Hz]", "1 high [Hz]"]
    assert np.array([row[2::3] for row in rows[1:]], dtype=float) == pytest.approx(np.array(one["frequencies"]))
    page = (folder / "frequencies.html").read_text(encoding="utf-8")
    assert page.count("<svg ") == 2
    assert "The lowest natural frequency is" in page


def test_the_document_and_the_record_name_the_same_keys_and_every_number_has_a_unit():
    """Of a lever whose 7th harmonic, 350 Hz, meets its second natural frequency."""
    fast = case_frequencies(lever(speed="3000 rpm"), poses=2)
    record = recorded(fast)
    compare("frequencies", record, recorded(found()))
    [met] = [one for one in record["frequencies"]["load_cases"]["turning"]["harmonics"] if one["mode"] == 2]
    assert (met["harmonic"], met["frequency"]) == (7, pytest.approx(350.0))
    assert met["ranges"] == [[pytest.approx(0.0), pytest.approx(360.0)]]
    every = paths({"frequencies": record["frequencies"]})
    numbers = {re.sub(r"(load_cases|links)\.\w+", r"\1.*", path) for path in every}
    known = field_units()["fields"]
    assert {path for path in numbers if not any(path == k or path.startswith(f"{k}.") for k in known)} == set()


def test_a_notebook_has_table_and_pictures():
    report = alula.frequencies(lever(), poses=3)
    band = report.lowest["turning"]
    first = report.table()[0]
    told = (first["frequency [Hz]"], first["frequency [Hz] low"], first["frequency [Hz] high"])
    assert told == pytest.approx((band.value, band.low, band.high), rel=1e-9)
    with pytest.warns(DeprecationWarning, match=r"the column 'low' is called 'frequency \[Hz\] low' now"):
        assert first["low"] == first["frequency [Hz] low"]
    assert "driving frequency of 10 Hz" in str(report)
    assert report.plot_campbell("turning").png == report.plot_campbell().png
    assert report.plot_shapes().png.startswith(b"\x89PNG")
    with pytest.raises(CaseError, match="there is no load case 'turn'; did you mean 'turning'"):
        report.plot_campbell("turn")


def test_a_linkage_that_departs_still_has_a_diagram():
    """Its lowest natural frequency is 0, and in one pose without a drive nothing else sets the scale."""
    own = replace(history(poses=1), driving=0.0)
    for still in (own.frequencies * [[0.0, 1.0, 1.0]], 0.0 * own.frequencies):
        sheet = campbell_diagram(
            replace(own, frequencies=still, low=still, high=still), coordinate="pose", unit="deg", load_case="flapping"
        )
        assert_legible(sheet)
        assert "In the stated pose" in written(sheet)


def test_campbells_diagram_tells_frequencies_in_hertz_and_speeds_in_revolutions_per_minute():
    one = history()
    sheet = campbell_diagram(one, coordinate="crank", unit="deg", load_case="flapping")
    assert {curve.unit for curve in sheet.plotted} == {"Hz"}
    over = [curve for curve in sheet.plotted if curve.x_label == "crank [deg]"]
    for k, name in enumerate(("1st", "2nd")):
        for told, values in ((name, one.frequencies), (f"{name}, band", one.low), (f"{name}, band", one.high)):
            assert any(
                curve.name == told and len(curve.y) == len(one.at) and np.allclose(curve.y, values[:, k])
                for curve in over
            )
        np.testing.assert_allclose(next(c for c in over if c.name == name).x, np.degrees(one.at), atol=1e-9)
    levels = {curve.name: curve.y for curve in over if curve.name.endswith("×")}
    assert levels["2×"] == pytest.approx([6.0, 6.0])
    speeds = [curve for curve in sheet.plotted if curve.x_label == "speed of the drive [rpm]"]
    rays = {curve.name: curve for curve in speeds if curve.name.endswith("×")}
    assert rays["3×"].y[1] / rays["3×"].x[1] == pytest.approx(3.0 / 60.0)
    [stated] = [curve for curve in speeds if curve.name == "stated speed"]
    assert stated.x == pytest.approx([180.0, 180.0])
