"""Curves of pictures, read back from what they tell, against the results they are of, in the units of their labels.

Powers were once drawn in milliwatts over an axis in watts.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from legible import written
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from told_motion import pictures

from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.theory import check_beam
from alula.fea.common.band import Band
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import Quantity, Subject
from alula.fea.findings.rates import series
from alula.fea.tolerance.result import ToleranceNumber
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.figures.diagrams import internal_force_diagram
from alula.reports.figures.motion.envelope_figures import envelope_figure
from alula.reports.figures.set_up import profile_drawing
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.chart import Chart
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.study.curves import curves
from alula.reports.figures.study.style import chart
from alula.reports.figures.study.tolerance_pictures import spread_picture
from alula.reports.study.columns import Parameter, Response

SPEED = 60.0
"""Revolutions per minute of the crank: 2π rad/s."""
PUSHED = "pushed forward by a name that is long"


@pytest.fixture(scope="module")
def moved():
    return solve_case_motion(read_case("slider-crank", ["motion.poses=73", f'load_cases.push.speed="{SPEED:g} rpm"']))


@pytest.fixture(scope="module")
def drawn(moved):
    return pictures(moved)


def curve(picture, name, label):
    """Return the curve of that name, or of several that it is one of, over the axis with that label."""
    [found] = [one for one in picture.plotted if one.y_label == label and name in one.name.split(", ")]
    return found


def test_a_curve_tells_values_and_units_of_its_axes():
    sheet, axes = Canvas(200.0, 100.0), Axes(box=(10.0, 5.0, 190.0, 95.0), x=(-1.0, 3.0), y=(0.0, 4000.0))
    x, y = np.linspace(0.0, 2.0, 5), np.array([0.0, 10.0, 3000.0, 20.0, 4000.0])
    axes.curve(sheet, x, y, "#000000", 1.0, name="a", labels=("time [s]", "power [mW]"))
    [found] = sheet.plotted
    assert (found.name, found.x_label, found.unit) == ("a", "time [s]", "mW")
    np.testing.assert_allclose(found.x, x, atol=1e-12)
    np.testing.assert_allclose(found.y, y, atol=1e-9)
    np.testing.assert_allclose(sheet.marks[0].points, axes.at(np.column_stack([x, y])))


def test_the_drive_of_a_motion(moved, drawn):
    for name, torque in moved.torque.items():
        found = curve(drawn["torque"], name, "drive torque on crank [N·mm]")
        assert found.unit == "N·mm"
        np.testing.assert_allclose(found.y, torque, rtol=1e-12)
        np.testing.assert_allclose(found.x, np.degrees(moved.motion.angles), rtol=1e-12)
        assert found.x_label.endswith("[deg]")
    omega = 2.0 * math.pi * SPEED / 60.0
    [power] = [one for one in drawn["energy"].plotted if one.unit == "W" and len(one.y) > 2]
    assert np.abs(power.y).max() > 0.0
    np.testing.assert_allclose(power.y, moved.torque["push"] / 1000.0 * omega, rtol=1e-9)  # N·m rad/s


def test_forces_speeds_and_energies_of_a_motion(moved, drawn):
    for joint, force in moved.forces["push"].forces.items():
        name = next(one for one in drawn if one.startswith("joint-forces"))
        found = curve(drawn[name], joint, "joint force [N]")
        np.testing.assert_allclose(found.y, np.hypot(*force[:, :2].T), rtol=1e-9)
    crank = curve(drawn["link-speeds"], "crank", "angular speed [rad/s]")
    np.testing.assert_allclose(crank.y, 2.0 * math.pi * SPEED / 60.0)
    rates = series(moved, "push")
    kinetic = curve(drawn["energy"], "kinetic", "energy [N·mm]")
    np.testing.assert_allclose(kinetic.y, rates.whole["kinetic_energy"])
    turned = curve(drawn["link-angles"], "crank", "direction of the link [deg]")
    np.testing.assert_allclose(turned.y, np.degrees(moved.motion.angle("crank")))


def test_the_safety_factor_over_the_motion():
    """Of two links of unlike strength, over the driven angle in degrees; the legend has the bands' colours and room."""
    angles = np.radians(np.linspace(10.0, 350.0, 35))
    source = (Source(kind=SourceKind.DISCRETISATION),)

    def link(name, strength, stress):
        pose = int(np.argmax(stress))
        peak = Band(value=stress[pose], low=0.9 * stress[pose], high=1.2 * stress[pose], sources=source)
        one = SimpleNamespace(value=stress, low=0.9 * stress, high=1.2 * stress, pose=pose, stress=peak,
                              safety_factor=peak.inverse(strength))  # fmt: skip
        return SimpleNamespace(link=name, strength=strength, load_cases={"turn": one, PUSHED: one}, worst=one)

    stresses = {"crank": 12.0 + 3.0 * np.sin(angles), "rod": 20.0 + 5.0 * np.cos(angles)}
    links = {"crank": link("crank", 40.0, stresses["crank"]), "rod": link("rod", 60.0, stresses["rod"])}
    checks = [SimpleNamespace(subject=Subject.link("rod"), quantity=Quantity.SAFETY_FACTOR, limit=1.7)]
    result = SimpleNamespace(
        case=SimpleNamespace(load_cases={"turn": None, PUSHED: None}), links=links, checks=checks,
        drive_angles=angles, angles=angles, drive=SimpleNamespace(link="crank"),
        moved=SimpleNamespace(motion=SimpleNamespace(coordinate="crank", instants=None)),
    )  # fmt: skip
    picture = envelope_figure(result)
    lines = [one for one in picture.plotted if len(one.y) == len(angles)]
    for found, name in zip(lines, np.repeat(list(stresses), 2), strict=True):
        assert (found.y_label, found.unit) == ("safety factor", "")
        assert found.x_label == "direction of crank (driven) [deg]"
        np.testing.assert_allclose(found.x, np.linspace(10.0, 350.0, 35))
        np.testing.assert_allclose(found.y, {"crank": 40.0, "rod": 60.0}[name] / stresses[name])
    levels = [one.y for one in picture.plotted if len(one.y) == 2]
    assert [1.7, 1.7] in [level.tolist() for level in levels]
    assert picture.png().startswith(b"\x89PNG")
    [legend] = picture.figure.legends
    assert [text.get_text() for text in legend.get_texts()][:3] == ["turn", PUSHED, "error band"]
    assert legend.get_window_extent().x0 >= 0.0
    drawn = {area.get_facecolor()[0].tobytes() for axes in picture.figure.axes for area in axes.collections}
    named = {np.array(patch.get_facecolor()).tobytes() for patch in legend.findobj(Rectangle)}
    assert len(drawn) == 2
    assert drawn <= named


def test_a_curve_of_a_study():
    parameter = Parameter(path="parts.bar.thickness", unit="mm", values=np.array([3.0, 1.0, 2.0]))
    value = np.array([9.0, 1.0, 4.0])
    response = Response(label="safety factor of AE", value=value, low=0.8 * value, high=1.5 * value, limit=2.0)
    outcome = np.array(["pass", "fail", "pass"])
    picture = chart(curves(parameter, response, outcome, [("", np.ones(3, dtype=bool))]))
    line = next(one for one in picture.plotted if len(one.y) == 3 and not one.name)
    assert (line.x_label, line.y_label) == ("parts.bar.thickness [mm]", "safety factor of AE")
    np.testing.assert_array_equal(line.x, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(line.y, [1.0, 4.0, 9.0])
    marks = {one.name: one for one in picture.plotted if one.name in ("pass", "fail") and len(one.x)}
    assert sorted(zip(marks["pass"].x, marks["pass"].y, strict=True)) == [(2.0, 4.0), (3.0, 9.0)]
    bands = np.concatenate([one.y for one in picture.plotted if len(one.y) > 3])
    assert (bands.min(), bands.max()) == (pytest.approx(0.8), pytest.approx(13.5))


def test_the_spread_of_a_number_under_tolerances():
    """Of the drive torque, of which nothing is asked: each sample is in one bar."""
    values = np.random.default_rng(1).normal(350.0, 20.0, 500)
    none = np.zeros(0)
    number = ToleranceNumber(
        check="", subject="crank", load_case="lift", quantity="drive torque", unit="N·mm", limit=math.nan,
        at_least=True, nominal=(350.0, 350.0, 350.0), values=values, low=values, high=values, certain=None,
        possible=None, first=none, total=none,
    )  # fmt: skip
    picture = spread_picture(number)
    [bars] = [one for one in picture.plotted if len(one.y) > 2]
    assert bars.x_label == f"{number.title}, lift [N·mm]"
    assert bars.y_label == "samples"
    assert bars.y.sum() == 500
    half = (bars.x[1] - bars.x[0]) / 2.0
    for middle, height in zip(bars.x, bars.y, strict=True):
        assert (
            height == np.sum((values >= middle - half - 1e-9) & (values < middle + half - 1e-9)) or middle == bars.x[-1]
        )
    assert bars.y @ bars.x / 500 == pytest.approx(values.mean(), abs=half)


def test_the_diagram_of_a_link():
    """A bar of 100 mm on two supports with 8 N in its middle: M = F L/4 = 200 N mm, V = 4 N."""
    section = read_case("owl-wing-static").parts["tube"].section
    points = [PointLoad(point=np.array([x, 0.0]), wrench=np.array([0.0, force, 0.0, 0.0, 0.0, 0.0]))
              for x, force in ((0.0, 4.0), (50.0, -8.0), (100.0, 4.0))]  # fmt: skip
    sheet = internal_force_diagram(check_beam(BeamLoads(points=tuple(points)), section, 40.0), {"A": 0.0, "B": 100.0})
    found = {one.name: one for one in sheet.plotted}
    assert [one.unit for one in found.values()] == ["N", "N", "N·mm"]
    assert {one.x_label for one in found.values()} == {"x along the link [mm]"}
    assert np.abs(found["M"].y).max() == pytest.approx(200.0)
    assert found["M"].x[np.argmax(np.abs(found["M"].y))] == pytest.approx(50.0)
    assert np.abs(found["V"].y).max() == pytest.approx(4.0)
    assert np.abs(found["N"].y).max() == pytest.approx(0.0, abs=1e-12)


def test_a_chart_of_bands_tells_their_ends():
    figure = Figure()
    axes = figure.add_subplot()
    axes.set_ylabel("drive power [W]")
    axes.fill_between([0.0, 1.0], [1.0, 2.0], [3.0, 5.0], label="C_N 1 to 2")
    [band] = Chart(figure).plotted
    assert (band.name, band.unit) == ("C_N 1 to 2", "W")
    assert (band.y.min(), band.y.max()) == (1.0, 5.0)


def test_a_profile_with_one_tilt_below_zero_is_drawn_up_to_zero():
    rows = [SimpleNamespace(time=0.6 * k, force=100.0 * k, tilt=np.radians(-10.0)) for k in range(3)]
    assert {"tilt [deg]", "−10", "0"} <= set(written(profile_drawing(SimpleNamespace(rows=rows))))
