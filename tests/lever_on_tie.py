"""A lever that turns on a wall and hangs on a tie beside its middle: two links of a truss with one force at the tip."""

import tomllib

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

LEVER_ON_TIE = """
schema_version = 1
title = "A lever on a tie"

[links]
wall = { ground = true, points.O = ["0 mm", "0 mm"], points.D = ["40 mm", "120 mm"] }
lever = { part = "lever", points.O = ["0 mm", "0 mm"], points.B = ["100 mm", "0 mm"], points.P = ["160 mm", "0 mm"] }
tie = { part = "tie", points.B = ["0 mm", "0 mm"], points.D = ["134.16407865 mm", "0 mm"] }

[joints]
O = { links = ["wall", "lever"], pin_diameter = "4 mm" }
B = { links = ["lever", "tie"], pin_diameter = "4 mm" }
D = { links = ["wall", "tie"], pin_diameter = "4 mm" }

[pose]
near = { lever = "0 deg", tie = "116.565 deg" }

[parts]
lever = { shape = "bar", material = "own", width = "12 mm", thickness = "5 mm", fillet_radius = "1 mm" }
tie = { shape = "bar", material = "own", width = "4 mm", thickness = "2 mm", fillet_radius = "3 mm" }

[materials.own]
title = "Aluminium"
density = "2700 kg/m^3"
youngs_modulus = "70 GPa"
poissons_ratio = 0.33
yield_strength = "100 MPa"
ultimate_strength = "160 MPa"
strength = "yield"
minimum_safety_factor = 2.0
sources = {}
status = {}

[load_cases.proof]
forces = [{ link = "lever", at = "P", force = ["0 N", "-200 N"] }]

[load_cases.aside]
forces = [{ link = "lever", at = "P", force = ["80 N", "-60 N"] }]

[checks.stays]
type = "permanent-set"
maximum = "5 mm"
"""


def lever_on_tie(edit=lambda tables: None) -> Case:
    """Return the case after ``edit`` has changed its tables."""
    tables = tomllib.loads(LEVER_ON_TIE)
    edit(tables)
    return validate(tables)
