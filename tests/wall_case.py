"""A tube that overhangs a strut of another tube and is loaded at its end; a strip in place of the first on request."""

import tomllib

from alula.fea.check.run import check_case
from alula.loads.case.case_file import validate

WALLS = """
schema_version = 1
title = "A tube on a strut"
large_displacement = "off"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["150 mm", "-200 mm"]
[links.arm]
part = "wide"
points.O = ["0 mm", "0 mm"]
points.B = ["150 mm", "0 mm"]
points.H = ["300 mm", "0 mm"]
[links.strut]
part = "narrow"
points.P = ["0 mm", "0 mm"]
points.B = ["200 mm", "0 mm"]
[joints]
O = { links = ["frame", "arm"], pin_diameter = "2 mm", clearance = "0 mm" }
B = { links = ["arm", "strut"], pin_diameter = "2 mm", clearance = "0 mm" }
P = { links = ["frame", "strut"], pin_diameter = "2 mm", clearance = "0 mm" }
[pose.near]
arm = "0 deg"
strut = "90 deg"
[parts.wide]
shape = "tube"
material = "aluminium-7075-t6"
outer_diameter = "40.2 mm"
inner_diameter = "39.8 mm"
eyes = "none"
[parts.narrow]
shape = "tube"
material = "aluminium-7075-t6"
outer_diameter = "20.2 mm"
inner_diameter = "19.8 mm"
eyes = "none"
[load_cases.tip]
forces = [{ link = "arm", at = "H", force = ["-20 N", "-200 N"] }]
[checks.wall]
type = "wall"
minimum = 1.0
"""


def strip(width="40 mm", thickness="2 mm"):
    """Return the change that makes the arm a bar."""

    def change(tables):
        tables["parts"]["wide"] = {
            "shape": "bar", "material": "aluminium-7075-t6", "width": width, "thickness": thickness,
            "eye_diameter": "60 mm", "eye_thickness": thickness, "fillet_radius": "2 mm",
        }  # fmt: skip

    return change


def walls(*changes):
    """Return the case with its tables changed by functions, one after the other."""
    tables = tomllib.loads(WALLS)
    for change in changes:
        change(tables)
    return validate(tables)


def checked(case, load_case="tip"):
    """Return the load case's result by hand."""
    return check_case(case, fidelity="beam").load_cases[load_case]
