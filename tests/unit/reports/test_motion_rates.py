"""Speeds, momentum and energy of a slider-crank in record, tables, lines and notebook, against its closed form.

A block of 50 g is all of its mass: at constant ω, x = r cos φ + √(l² - (r sin φ - e)²) and its derivatives tell all.
"""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from told_motion import pictures, printed, record, rows, texts

from alula.fea.findings.rates import series
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.figures.motion.motion_figures import angles_figure, forces_figure, torque_figure
from alula.reports.figures.motion.rate_figures import energy_figure
from alula.reports.motion.extremes import between, vector_extremes
from alula.reports.notebook.motion_report import MotionReport

CASE = """
schema_version = 1
title = "Slider-crank"
massless = ["crank", "rod"]
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.S = ["0 mm", "10 mm"]
[links.crank]
points.O = ["0 mm", "0 mm"]
points.A = ["40 mm", "0 mm"]
[links.rod]
points.A = ["0 mm", "0 mm"]
points.B = ["130 mm", "0 mm"]
[links.block]
points.B = ["0 mm", "0 mm"]
points.P = ["20 mm", "12 mm"]
[joints]
O = { links = ["frame", "crank"] }
A = { links = ["crank", "rod"] }
B = { links = ["rod", "block"] }
S = { type = "slider", links = ["frame", "block"], points = ["S", "B"], friction = 0.1 }
[springs.back]
between = [{ link = "frame", at = "S" }, { link = "block", at = "P" }]
stiffness = "0.01 N/mm"
free_length = "45 mm"
[pose]
coordinate = "crank"
angle = "30 deg"
near = { rod = "0 deg", block = "0 deg" }
[drive]
link = "crank"
joint = "O"
[motion]
turn = true
poses = 73
[[carried]]
link = "block"
at = "B"
mass = "50 g"
[load_cases.slow]
speed = "60 rpm"
own_weight = true
forces = [{ link = "block", at = "P", force = ["-5 N", "0 N"] }]
[load_cases.empty]
speed = "60 rpm"
carried = false
[load_cases.again]
own_weight = false
speed = "60 rpm"
[load_cases.fast]
own_weight = false
speed = "600 rpm"
[load_cases.still]
own_weight = false
direction = "forward"
"""
GRAMS, MASS = 50.0, 5e-5
R, L, E = 40.0, 130.0, 10.0


@pytest.fixture(scope="module")
def moved():
    return solve_case_motion(validate(tomllib.loads(CASE)))


@pytest.fixture(scope="module")
def told(moved):
    return record(moved)["load_cases"]


def block(omega):
    """Speed and acceleration (73,) of the block along its slide."""
    phi = math.radians(30.0) + np.linspace(0.0, 2.0 * math.pi, 73)
    height, root = R * np.sin(phi) - E, np.sqrt(L**2 - (R * np.sin(phi) - E) ** 2)
    first = -R * np.sin(phi) - height * R * np.cos(phi) / root
    second = -R * np.cos(phi) - (R**2 * np.cos(phi) ** 2 - height * R * np.sin(phi)) / root
    second -= (height * R * np.cos(phi)) ** 2 / root**3
    return omega * first, omega**2 * second


@pytest.mark.parametrize(("load_case", "rpm"), [("slow", 60.0), ("fast", 600.0)])
def test_rates_are_those_of_the_block(told, load_case, rpm):
    speed, rate = block(rpm * math.pi / 30.0)
    found = told[load_case]["rates"]
    point, link, whole = found["points"]["B"], found["links"]["block"], found["whole"]
    assert point["speed"]["largest"] == pytest.approx(np.abs(speed).max())
    assert point["speed"]["x"] == pytest.approx([speed.min(), speed.max()])
    assert point["speed"]["y"] == [0.0, 0.0]
    assert point["acceleration"]["x"] == pytest.approx([rate.min(), rate.max()])
    assert link["mass"] == pytest.approx(GRAMS)
    assert link["momentum"]["largest"] == pytest.approx(np.abs(GRAMS * speed).max() / 1e3)  # g·mm/s to mN·s
    assert link["angular_momentum"]["largest"] == 0.0
    assert whole["kinetic_energy"]["largest"] == pytest.approx(0.5 * MASS * np.max(speed**2))
    assert whole["angular_momentum"]["largest"] == pytest.approx(np.max(-E * MASS * speed))
    assert whole["shaking_force"]["x"] == pytest.approx([(-MASS * rate).min(), (-MASS * rate).max()])
    assert whole["shaking_moment"]["smallest"] == pytest.approx(np.min(E * MASS * rate))
    assert found["about"] == {"joint": "O", "place": [0.0, 0.0]}
    crank = found["links"]["crank"]
    assert crank["angular_speed"]["largest"] == pytest.approx(rpm * math.pi / 30.0)
    assert crank["mass"] is crank["momentum"] is crank["kinetic_energy"] is None


def test_the_ground_bears_load_weight_and_inertia_and_nothing_of_spring_or_friction(moved):
    found, (_, rate) = series(moved, "slow"), block(2.0 * math.pi)
    np.testing.assert_allclose(found.whole["ground_force"], -5.0 - MASS * rate - 1j * MASS * 9810.0, rtol=1e-10)
    place = moved.motion.position("block", "B")[:, 0]
    moment = 5.0 * (E + 12.0) + E * MASS * rate - place * MASS * 9810.0
    np.testing.assert_allclose(found.whole["ground_moment"], moment, rtol=1e-10)


def test_without_speed_or_mass_nothing_is_told(told):
    assert told["still"]["rates"] is None
    assert told["empty"]["rates"]["whole"]["potential_energy"] is None
    assert told["empty"]["rates"]["whole"]["kinetic_energy"]["largest"] == 0.0
    assert told["empty"]["rates"]["links"]["block"]["mass"] is None
    unweighed = (
        CASE.replace("own_weight = true", "own_weight = false")
        .replace('speed = "60 rpm"\n', "")
        .replace('"600 rpm"', '"0 rpm"')
    )
    still = record(solve_case_motion(validate(tomllib.loads(unweighed))))
    assert still["motion"]["points"]["B"]["speed"] is still["motion"]["links"]["rod"]["angular_speed"] is None
    fast = 'poses = 73\nspeed = "60 rpm"\ninertia = false'
    moving = solve_case_motion(validate(tomllib.loads(unweighed.replace("poses = 73", fast))))
    found = record(moving)
    [rates] = {row["rates"]["whole"]["momentum"] for row in found["load_cases"].values()}
    assert rates is None
    assert found["motion"]["points"]["B"]["speed"]["largest"] == pytest.approx(np.abs(block(2.0 * math.pi)[0]).max())
    assert "left out: no load case asks for their weight or inertia" in "".join(texts(moving, "rates"))


def test_tables_hold_every_pose_at_the_speed_of_its_load_case(moved):
    every = rows(moved, "rates.csv")
    for name, rpm in (("slow", 60.0), ("fast", 600.0)):
        mine = [row for row in every if row["load case"] == name]
        speed, rate = block(rpm * math.pi / 30.0)

        def column(head, mine=mine):
            return np.array([float(row[head]) for row in mine])

        np.testing.assert_allclose(column("B speed x [mm/s]"), speed, atol=1e-8 * np.abs(speed).max())
        np.testing.assert_allclose(column("block momentum x [mN s]"), GRAMS / 1e3 * speed, atol=1e-8)
        np.testing.assert_allclose(column("linkage kinetic energy [N mm]"), 0.5 * MASS * speed**2, atol=1e-8)
        np.testing.assert_allclose(column("linkage shaking force x [N]"), -MASS * rate, atol=1e-8)
        assert column("time [s]")[-1] == pytest.approx(60.0 / rpm)
    assert {row["linkage potential energy [N mm]"] for row in every if row["load case"] == "fast"} == {""}
    assert {row["load case"] for row in every} == {"slow", "empty", "again", "fast"}
    torque = rows(moved, "torque.csv")
    assert {row["time [s]"] for row in torque if row["load case"] == "still"} == {""}
    assert float([row["time [s]"] for row in torque if row["load case"] == "fast"][-1]) == pytest.approx(0.1)


def test_lines_say_once_what_load_cases_share(moved):
    text = printed(moved).split("Speeds, momentum and energy")[1]
    again = text.split("Load case again")[1].split("Load case")[0]
    assert "as in load case slow" in again
    assert "angular speed" not in again
    slow = text.split("Load case slow")[1].split("Load case")[0]
    assert "angular speed [rad/s]" in slow
    assert "shaking moment about O" in slow
    assert max(map(len, slow.split("\n"))) < 180


def test_figures_draw_what_tables_tell_in_the_units_of_their_axes(moved):
    """Two load cases at two speeds: power by the torque of virtual work in W, energy in N mm, forces in N."""
    drawn_all = pictures(moved)
    figures = {name: drawn_all[name].figure for name in drawn_all if name.startswith(("link-sp", "point-sp", "energy"))}
    assert sorted(figures) == sorted(["link-speeds", "point-speeds", "energy-1", "energy-2", "energy-3", "energy-4"])
    for name, figure, omega in (("slow", "energy-1", 2.0 * math.pi), ("fast", "energy-4", 20.0 * math.pi)):
        speed, rate = block(omega)
        drawn = {axes.get_ylabel(): axes.lines for axes in figures[figure].axes}
        assert list(drawn) == ["energy [N·mm]", "drive power [W]", "force on the ground [N]"]
        kinetic, power, shaking = (lines[0] for lines in drawn.values())
        np.testing.assert_allclose(kinetic.get_ydata(), 0.5 * MASS * speed**2, atol=1e-12)
        np.testing.assert_allclose(power.get_ydata(), moved.torque[name] * omega / 1e3, rtol=1e-9)
        np.testing.assert_allclose(shaking.get_ydata(), np.abs(MASS * rate), atol=1e-12)
        np.testing.assert_allclose(power.get_xdata(), 30.0 + np.linspace(0.0, 360.0, 73))
    ground, rates = figures["energy-1"].axes[2].lines[2], series(moved, "slow")
    falling = replace(rates, whole=rates.whole | {"potential_energy": np.linspace(7.0, -5.0, 73)})
    above = energy_figure(moved, "slow", falling).axes[0].lines[2]
    assert above.get_label() == "potential, above its least"
    np.testing.assert_allclose(above.get_ydata(), np.linspace(12.0, 0.0, 73), atol=1e-12)
    np.testing.assert_allclose(ground.get_ydata(), np.hypot(5.0 + MASS * block(2.0 * math.pi)[1], MASS * 9810.0))
    speed, rate = block(2.0 * math.pi)
    for axes, expected, unit in zip(figures["point-speeds"].axes, (speed, rate), ("mm/s", "mm/s²"), strict=True):
        assert axes.get_ylabel().endswith(f"[{unit}]")
        [line] = [line for line in axes.lines if "B" in line.get_label().split(", ")]
        np.testing.assert_allclose(line.get_ydata(), np.abs(expected), atol=1e-9)
    [crank] = [line for line in figures["link-speeds"].axes[0].lines if line.get_label() == "crank"]
    np.testing.assert_allclose(crank.get_ydata(), 2.0 * math.pi)


def test_figures_of_a_motion_draw_directions_torques_and_sizes_of_forces(moved):
    """Of a slider-crank with a rod at asin((e - r sin φ)/l), whose load case with friction is drawn without it, too."""
    phi = 30.0 + np.linspace(0.0, 360.0, 73)
    rod = np.degrees(np.arcsin((E - R * np.sin(np.radians(phi))) / L))
    angles = {line.get_label(): line for line in angles_figure(moved).axes[0].lines}
    assert list(angles) == ["crank", "rod", "block"]
    for link, expected in (("crank", phi), ("rod", rod), ("block", 0.0 * phi)):
        np.testing.assert_allclose(angles[link].get_ydata(), expected, atol=1e-9)
    [axes] = torque_figure(moved).axes
    assert axes.get_ylabel() == "drive torque on crank [N·mm]"
    torques = {line.get_label(): line.get_ydata() for line in axes.lines}
    for name, torque in moved.torque.items():
        np.testing.assert_array_equal(torques[name], torque)
    rubbing = {name: torques[f"{name} without friction"] for name in ("slow", "fast")}
    for name, torque in rubbing.items():
        np.testing.assert_array_equal(torque, moved.frictionless[name])
        assert np.all((torques[name] - torque)[1:-1] >= -1e-9)  # turning forwards it drives against friction
    assert np.ptp(torques["slow"] - rubbing["slow"]) > 1.0
    [axes] = forces_figure(moved, "fast").axes
    drawn = {joint: line.get_ydata() for line in axes.lines for joint in line.get_label().split(", ")}
    for joint in "OABS":
        np.testing.assert_allclose(drawn[joint], np.hypot(*moved.forces["fast"].forces[joint].T))


def test_numbers_of_tables():
    extremes = {"smallest": -4.7, "largest": 4.7, "unbounded": False}
    assert between(extremes) == "±4.700"
    assert between(extremes | {"largest": 4.8}) == "−4.700 to 4.800"
    assert between(extremes | {"smallest": 4.7}) == "4.700"
    assert between(extremes | {"smallest": -1e-15}) == "0 to 4.700"
    assert between(None) == "–"


def test_a_vector_is_told_by_its_size_and_components(moved):
    found = vector_extremes(moved.motion, np.linspace(0.0, 72.0, 73) * (3.0 - 4.0j))
    assert found == {"largest": 360.0, "largest_at": pytest.approx(390.0), "x": [0.0, 216.0], "y": [-288.0, 0.0]}


def test_a_notebook_has_the_same(moved, told):
    report = MotionReport(moved)
    links = {(row["load case"], row["link"]): row for row in report.table("links")}
    rod = told["fast"]["rates"]["links"]["rod"]["angular_speed"]
    assert links["fast", "rod"]["angular speed, largest [rad/s]"] == rod["largest"]
    assert links["fast", "rod"]["momentum, largest [mN·s]"] is None
    [point] = [row for row in report.table("points") if (row["load case"], row["point"]) == ("fast", "B")]
    assert point["speed, largest [mm/s]"] == told["fast"]["rates"]["points"]["B"]["speed"]["largest"]
    energy = {(row["load case"], row["quantity"]): row for row in report.table("energy")}
    assert energy["fast", "kinetic energy"]["largest"] == told["fast"]["rates"]["whole"]["kinetic_energy"]["largest"]
    assert ("still", "kinetic energy") not in energy
    assert {row["quantity"] for row in report.table()} >= {"drive torque on crank", "joint A"}
    assert report.plot_energy("fast").png.startswith(b"\x89PNG")
    with pytest.raises(CaseError, match="there is no load case with a speed 'still'"):
        report.plot_energy("still")
    with pytest.raises(CaseError, match="there is no table 'forces'"):
        report.table("forces")
