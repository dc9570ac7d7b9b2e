"""``alula motion``: its exit status, tables, figures and animation."""

import csv
import json
import math
import shutil
from pathlib import Path

import numpy as np
import programs
import pytest
from PIL import Image
from told_motion import record, rows

from alula.fea.findings.of_motion import motion_findings
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.commands.motion import tell_motion

CASE = """
schema_version = 1
title = "A slider-crank, 20 $ worth"
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
S = { type = "slider", links = ["frame", "block"], points = ["S", "B"] }
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
speed = "600 rpm"
inertia = true
[[carried]]
link = "block"
at = "B"
mass = "50 g"
[load_cases.push]
own_weight = false
forces = [{ link = "block", at = "P", force = ["-5 N", "0 N"] }]
[load_cases.idle]
own_weight = false
"""


def run(*arguments, cwd):
    return programs.inside("motion", *arguments, folder=cwd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder that the command wrote into; the case file stands two above it."""
    home = tmp_path_factory.mktemp("home")
    (home / "crank.toml").write_text(CASE, encoding="utf-8")
    done = run("crank.toml", "-o", "out", cwd=home)
    assert done.returncode == 0, done.stderr
    assert "A slider-crank" in done.stdout
    assert "The balance of energy lacks" in done.stdout
    return home / "out" / "motion"


@pytest.fixture(scope="module")
def wing():
    return solve_case_motion(read_case("owl-wing-static", ["motion.poses=19"]))


def columns(path):
    with path.open(encoding="utf-8", newline="") as stream:
        head, *rows = csv.reader(stream)
    return {name: [row[i] for row in rows] for i, name in enumerate(head)}


def test_everything_is_there(folder):
    assert {path.name for path in folder.iterdir()} == {
        ".alula-motion.json", "result.json", "links.csv", "points.csv", "torque.csv", "joint-forces.csv",
        "link-angles.png", "paths.png", "torque.png", "joint-forces-1.png", "joint-forces-2.png", "linkage.gif",
        "motion.html", "rates.csv", "link-speeds.png", "point-speeds.png", "energy-1.png", "energy-2.png",
    }  # fmt: skip


def test_power_is_torque_times_speed_in_watts(folder):
    """600 rpm are 20π rad/s; N·mm/s are thousandths of a watt."""
    torque = np.array(columns(folder / "torque.csv")["torque on crank [N mm]"], dtype=float)
    written = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert written["units"]["power"] == "W"
    for name, own in (("push", torque[:73]), ("idle", torque[73:])):
        power = own * 20.0 * math.pi / 1000.0
        told = written["load_cases"][name]["drive_power"]
        assert told["largest"] == pytest.approx(power.max(), rel=1e-9)
        assert told["smallest"] == pytest.approx(power.min(), rel=1e-9)


def test_tables_name_their_units_and_hold_the_motion(folder):
    links, points = columns(folder / "links.csv"), columns(folder / "points.csv")
    assert len(links["crank angle [deg]"]) == 73
    assert float(links["crank angle [deg]"][-1]) == pytest.approx(390.0)
    assert float(links["time [s]"][-1]) == pytest.approx(0.1)
    travel = np.array(links["S travel [mm]"], dtype=float)
    np.testing.assert_allclose(np.array(points["B x [mm]"], dtype=float), travel, atol=1e-9)
    forces = columns(folder / "joint-forces.csv")
    assert forces["load case"] == ["push"] * 73 + ["idle"] * 73
    sizes = np.array(forces["S size [N]"], dtype=float)
    across = np.array(forces["S Fy of frame on block [N]"], dtype=float)
    np.testing.assert_allclose(sizes, np.abs(across), atol=1e-9)
    assert "S M of frame on block [N mm]" in forces
    assert all(name.endswith("]") or name == "load case" for name in [*links, *points, *forces])


def test_the_record_matches_the_tables(folder):
    found = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    torque = columns(folder / "torque.csv")
    push = np.array(torque["torque on crank [N mm]"], dtype=float)[:73]
    assert found["load_cases"]["push"]["drive_torque"]["largest"] == pytest.approx(push.max())
    assert found["load_cases"]["push"]["energy_imbalance"] < 1e-8
    assert found["motion"]["returns_to_start"] is True


@pytest.mark.parametrize(
    "name", ["link-angles", "paths", "torque", "joint-forces-1", "link-speeds", "point-speeds", "energy-2"]
)
def test_pictures_show_something_and_nothing_is_cut_off(folder, name):
    pixels = np.asarray(Image.open(folder / f"{name}.png").convert("L"))
    assert pixels.shape[1] > 800
    assert np.mean(pixels < 128) > 0.002
    border = np.concatenate([pixels[:2].ravel(), pixels[-2:].ravel(), pixels[:, :2].ravel(), pixels[:, -2:].ravel()])
    assert border.min() > 250, "a line or a letter touches the picture's edge"


def test_the_animation_moves_and_is_small(folder):
    path = folder / "linkage.gif"
    assert path.stat().st_size < 2_000_000
    with Image.open(path) as picture:
        assert picture.n_frames == 60
        assert picture.info["loop"] == 0
        frames = []
        for index in (0, 20, 40):
            picture.seek(index)
            frames.append(np.asarray(picture.convert("L"), dtype=int))
    assert np.mean(np.abs(frames[0] - frames[1]) > 60) > 0.002
    assert np.mean(np.abs(frames[1] - frames[2]) > 60) > 0.002
    assert all(frame[2, 2] == 255 for frame in frames)


def test_a_second_run_replaces_the_first_and_nothing_else(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(
        "alula.reports.figures.motion.motion_animation.draw_animation", lambda motion, path: path.write_bytes(b"GIF")
    )
    home = Path(shutil.copytree(folder.parents[1], tmp_path / "home"))
    folder = home / "out" / "motion"
    (folder / "notes.txt").write_text("precious", encoding="utf-8")
    again = run("crank.toml", "-o", "out", "--json", "--set", "motion.poses=37", cwd=home)
    assert again.returncode == 0
    assert json.loads(again.stdout)["motion"]["poses"] == 37
    assert json.loads((folder / "result.json").read_text(encoding="utf-8"))["motion"]["poses"] == 37
    assert (folder / "notes.txt").read_text(encoding="utf-8") == "precious"
    (folder / "links.csv").write_text("edited", encoding="utf-8")
    refused = run("crank.toml", "-o", "out", cwd=home)
    assert refused.returncode == 2
    assert "links.csv' was not written by alula, or was edited since" in refused.stderr
    assert (folder / "links.csv").read_text(encoding="utf-8") == "edited"


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ('motion.speed="600"', "needs its unit"),
        ('motion={turn=true, coordinate="rod"}', "dead point at rod = "),
        ('pose.near={ rod = "90 deg", block = "180 deg" }', "no assembly"),
    ],
)
def test_bad_input_ends_with_status_2_and_one_sentence(folder, override, words):
    done = run("crank.toml", "--set", override, cwd=folder.parents[1])
    assert done.returncode == 2
    assert done.stdout == ""
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_dead_point_of_the_drive_is_told(wing, capsys):
    tell_motion(motion_findings(wing), "owl-wing-static")
    out = capsys.readouterr().out
    assert "Dead point of the driven link AE at GF = 213.5068 deg" in out
    [drive] = [line.split() for line in out.splitlines() if line.startswith("drive torque on AE")]
    assert drive[4:] == ["N·mm", "−130.6", "−19.90"], "extremes mean nothing"
    found = record(wing)
    assert found["load_cases"]["weight"]["drive_torque"]["largest"] is None
    assert found["drive"]["dead_points"] == pytest.approx([213.50682849])
    json.dumps(found, allow_nan=False)


def test_a_load_case_with_a_speed_of_its_own(folder, capsys):
    """Beside a standing motion: power and energies are there for every load case, in one table."""
    overrides = ["motion.inertia=false", 'motion.speed="0 rpm"', 'load_cases.idle.speed="600 rpm"', "motion.poses=25"]
    result = solve_case_motion(read_case(str(folder.parents[1] / "crank.toml"), overrides))
    tell_motion(motion_findings(result), "crank")
    standing, moving = capsys.readouterr().out.split("Load case idle")[:2]
    standing = standing.split("Load case push")[1]
    assert "without inertia" in standing
    assert "drive power" not in standing
    assert "with inertia at 600 rpm" in moving
    assert "drive power" in moving
    again = solve_case_motion(read_case(str(folder.parents[1] / "crank.toml"), ["motion.poses=25"]))
    np.testing.assert_allclose(result.torque["idle"], again.torque["idle"], atol=1e-9)
    power = np.array([row["drive power [N mm/s]"] for row in rows(result, "torque.csv")], dtype=float)
    assert np.all(power[:25] == 0.0)
    assert np.max(power[25:]) > 0.0


def test_a_range_is_shown_there_and_back(wing, tmp_path):
    tell_motion(motion_findings(wing), "owl-wing-static", tmp_path)
    with Image.open(tmp_path / "motion" / "linkage.gif") as picture:
        assert picture.n_frames == 60
