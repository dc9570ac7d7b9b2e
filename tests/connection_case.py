"""A lever on the shaft of a drive, with a plate bonded to its tip, and a slotted one: what bears follows by hand."""

import tomllib

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity
from alula.loads.case.case_file import validate

LEVER = """
schema_version = 1
title = "A lever and a plate"
large_displacement = "off"
[links.base]
ground = true
points.O = ["0 mm", "0 mm"]
[links.lever]
part = "bar"
points.O = ["0 mm", "0 mm"]
points.A = ["40 mm", "0 mm"]
[links.plate]
part = "bar"
points.A = ["0 mm", "0 mm"]
points.B = ["30 mm", "0 mm"]
[joints]
O = { links = ["base", "lever"], pin_diameter = "6 mm", pin_material = "steel-wire", clearance = "0 mm" }
A = { links = ["lever", "plate"], pin_diameter = "6 mm", pin_material = "steel-wire", bonded = true, angle = "0 deg" }
[drive]
link = "lever"
joint = "O"
[pose]
coordinate = "lever"
angle = "0 deg"
[motion]
range = ["-30 deg", "60 deg"]
poses = 4
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "10 mm"
thickness = "4 mm"
eye_diameter = "16 mm"
eye_thickness = "4 mm"
fillet_radius = "1 mm"
[load_cases.hang]
forces = [{ link = "plate", at = "B", force = ["0 N", "-20 N"] }]
[load_cases.pull]
forces = [{ link = "plate", at = "B", force = ["0 N", "-50 N"] }]
"""
QUICK_RETURN = """
schema_version = 1
title = "Quick return"
large_displacement = "off"
[links.frame]
ground = true
points.A = ["0 mm", "0 mm"]
points.O = ["0 mm", "-60 mm"]
[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["30 mm", "0 mm"]
[links.lever]
part = "bar"
points.O = ["0 mm", "0 mm"]
points.S = ["60 mm", "0 mm"]
points.E = ["150 mm", "0 mm"]
slots.S = { first = "28 mm", last = "92 mm" }
[joints]
A = { links = ["frame", "crank"], pin_diameter = "5 mm" }
O = { links = ["frame", "lever"], pin_diameter = "5 mm" }
B = { links = ["lever", "crank"], type = "pin-in-slot", points = ["S", "B"], pin_diameter = "5 mm" }
[drive]
link = "crank"
joint = "A"
[pose]
coordinate = "crank"
angle = "30 deg"
near = { lever = "75 deg" }
[motion]
turn = true
poses = 9
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "14 mm"
thickness = "4 mm"
eye_diameter = "14 mm"
eye_thickness = "4 mm"
fillet_radius = "1 mm"
[load_cases.pushed]
forces = [{ link = "lever", at = "E", force = ["-80 N", "0 N"] }]
[load_cases.weakly]
forces = [{ link = "lever", at = "E", force = ["-20 N", "0 N"] }]
[checks.slot]
type = "line-contact"
minimum = 2.0
"""
"""A crank whose pin runs in the slot of a lever with a load at its tip; the crank has no part."""
HORN = {"count": 4, "circle_diameter": "12 mm", "diameter": "1.6 mm", "material": "steel-wire", "length": "2 mm"}


def connected(*changes, at="O", minimum=2.0, **way):
    """Return the case with one check of a connection, changed by functions."""
    tables = tomllib.loads(LEVER)
    tables["checks"] = {"hub": {"type": "connection", "joint": at, "minimum": minimum, **(way or {"screws": HORN})}}
    for change in changes:
        change(tables)
    return validate(tables)


def checked(case, load_case="pull", quantity=Quantity.CONNECTION):
    """Return the result of a load case by hand, and the outcomes of a quantity in it."""
    found = check_case(case, fidelity="beam").load_cases[load_case]
    return found, [one for one in found.checks if one.quantity is quantity]
