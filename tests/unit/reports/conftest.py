"""Checked cases that need no mesher: the owl wing with one of its links as a solid, and a slider-crank."""

import tomllib

import pytest
import wing_with_solid

from alula.fea.check.run import check_case
from alula.loads.case.case_file import validate


@pytest.fixture(scope="session")
def result():
    """Two load cases: the wing's weight, and a case with no load at all (so that stresses are zero)."""
    return wing_with_solid.result()


SLIDER = """
schema_version = 1
title = "Slider-crank under a piston force"
[links]
frame = { ground = true, points = { O = ["0 mm", "0 mm"], S = ["0 mm", "0 mm"] } }
crank = { points = { O = ["0 mm", "0 mm"], P = ["30 mm", "0 mm"] } }
rod = { points = { P = ["0 mm", "0 mm"], Q = ["80 mm", "0 mm"] } }
piston = { points = { Q = ["0 mm", "0 mm"], S = ["10 mm", "0 mm"] } }
[joints]
O = { links = ["frame", "crank"] }
P = { links = ["crank", "rod"] }
Q = { links = ["rod", "piston"] }
S = { links = ["frame", "piston"], type = "slider" }
[pose]
coordinate = "crank"
angle = "60 deg"
near = { rod = "-20 deg", piston = "0 deg" }
[drive]
link = "crank"
joint = "O"
[load_cases.push]
forces = [{ link = "piston", at = "Q", force = ["-20 N", "5 N"] }]
"""


@pytest.fixture(scope="session")
def slider_text():
    """The file of a slider-crank without parts."""
    return SLIDER


@pytest.fixture
def slider():
    """A slider-crank without parts, checked."""
    return check_case(validate(tomllib.loads(SLIDER)), name="slider", fidelity="beam")


@pytest.fixture
def changed(result):
    """Builds the same result with every check passed through a function."""
    return lambda change: wing_with_solid.with_checks(result, change)
