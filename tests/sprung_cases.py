"""Small linkages with springs, tendons and stops, without parts: statics alone."""

import tomllib
from typing import Any

from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.states.standing import Standing

LEVER = """
schema_version = 1
title = "A lever"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], S = ["100 mm", "0 mm"], E = ["-10 mm", "15 mm"] } }
links.lever = { points = { O = ["0 mm", "0 mm"], H = ["40 mm", "0 mm"], P = ["100 mm", "0 mm"] } }
joints.O = { links = ["base", "lever"] }
pose = { coordinate = "lever", angle = "0 deg", equilibrium = true }
load_cases.hang.title = "Hanging"
"""
HANG = """load_cases.hang.forces = [{ link = "lever", at = "P", force = ["0 N", "-2 N"] }]\n"""
CROWN = """
schema_version = 1
title = "Two bars that push a block against a spring"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], W = ["150 mm", "0 mm"] } }
links.bar = { points = { O = ["0 mm", "0 mm"], B = ["50 mm", "0 mm"] } }
links.rod = { points = { B = ["0 mm", "0 mm"], C = ["50 mm", "0 mm"] } }
links.block = { points = { C = ["0 mm", "0 mm"], D = ["10 mm", "0 mm"] } }
joints.O = { links = ["base", "bar"] }
joints.B = { links = ["bar", "rod"] }
joints.C = { links = ["rod", "block"] }
joints.T = { links = ["base", "block"], type = "slider", points = ["O", "C"] }
load_cases.press = { forces = [{ link = "bar", at = "B", force = ["0 N", "-3 N"] }] }
[springs.wall]
between = [{ link = "block", at = "D" }, { link = "base", at = "W" }]
stiffness = "0.2 N/mm"
free_length = "70 mm"
"""
FOUR_BAR = """
schema_version = 1
title = "A four-bar with springs of all kinds"
links.base.ground = true
links.base.points = { A = ["0 mm", "0 mm"], D = ["90 mm", "0 mm"], S = ["30 mm", "80 mm"], E = ["60 mm", "-20 mm"] }
links.crank = { points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] } }
links.coupler = { points = { B = ["0 mm", "0 mm"], C = ["80 mm", "0 mm"], P = ["40 mm", "25 mm"] } }
links.rocker = { points = { D = ["0 mm", "0 mm"], C = ["60 mm", "0 mm"], Q = ["40 mm", "10 mm"] } }
joints.A = { links = ["base", "crank"] }
joints.B = { links = ["crank", "coupler"] }
joints.C = { links = ["coupler", "rocker"] }
joints.D = { links = ["base", "rocker"] }
pose = { coordinate = "crank", angle = "60 deg", near = { coupler = "20 deg", rocker = "90 deg" } }
drive = { link = "crank", joint = "A" }
load_cases.own.title = "Springs alone"
springs.hinge = { joint = "C", stiffness = "150 N*mm/rad", preload = "-40 N*mm" }
tendons.pull = { through = [{ link = "base", at = "S" }, { link = "rocker", at = "C" }], tension = "2.5 N" }
[springs.line]
between = [{ link = "coupler", at = "P" }, { link = "base", at = "S" }]
stiffness = "0.3 N/mm"
free_length = "25 mm"
[springs.inner]
between = [{ link = "crank", at = "A" }, { link = "rocker", at = "Q" }]
stiffness = "0.1 N/mm"
preload = "4 N"
[tendons.cord]
through = [{ link = "base", at = "E" }, { link = "rocker", at = "Q" }, { link = "coupler", at = "P" }]
stiffness = "0.4 N/mm"
free_length = "85 mm"
"""


def case_of(text: str, **entries: Any) -> Case:
    """Return a case with further or other top-level tables."""
    return validate({**tomllib.loads(text), **entries})


def stands(case: Case) -> tuple[CaseStatics, Standing]:
    """Return the statics of a case, and where it stands under its first load case."""
    statics = solve_case_statics(case)
    return statics, next(iter(statics.standing.values()))
