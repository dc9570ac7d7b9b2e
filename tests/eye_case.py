"""Two bars that meet at a pin, pulled there: each bears along its axis what equilibrium of the pin gives it."""

import tomllib

from alula.fea.check.run import check_case
from alula.loads.case.case_file import validate

EYES = """
schema_version = 1
title = "Two bars"
large_displacement = "off"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["0 mm", "-60 mm"]
[links.level]
part = "bar"
points.O = ["0 mm", "0 mm"]
points.B = ["60 mm", "0 mm"]
[links.rising]
part = "bar"
points.P = ["0 mm", "0 mm"]
points.B = ["84.8528137423857 mm", "0 mm"]
[joints]
O = { links = ["frame", "level"], pin_diameter = "5 mm", clearance = "0 mm" }
P = { links = ["frame", "rising"], pin_diameter = "5 mm", clearance = "0 mm" }
B = { links = ["level", "rising"], pin_diameter = "5 mm", clearance = "0 mm" }
[pose.near]
level = "0 deg"
rising = "45 deg"
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "8 mm"
thickness = "2 mm"
eye_diameter = "12 mm"
eye_thickness = "2 mm"
fillet_radius = "1 mm"
[load_cases.pull]
forces = [{ link = "level", at = "B", force = ["500 N", "0 N"] }]
[checks.eye]
type = "eye"
minimum = 2.4
"""


def eyes(*changes, text=EYES):
    """Return the case with its tables changed by functions, one after the other."""
    tables = tomllib.loads(text)
    for change in changes:
        change(tables)
    return validate(tables)


def checked(case, load_case="pull"):
    """Return the load case's result by hand."""
    return check_case(case, fidelity="beam").load_cases[load_case]
