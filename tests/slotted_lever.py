"""A lever on a pin and on a pin of the ground that stands in its slot, loaded at its free end, as a case."""

import tomllib
from typing import Any

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

LEVER = """
schema_version = 1
title = "Slotted lever"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["{at} mm", "0 mm"]
[links.lever]
part = "lever"
points.O = ["0 mm", "0 mm"]
points.S = ["{middle} mm", "0 mm"]
points.H = ["{tip} mm", "0 mm"]
slots.S = {{ first = "{first} mm", last = "{last} mm" }}
[joints]
O = {{ links = ["frame", "lever"], pin_diameter = "3 mm" }}
P = {{ links = ["lever", "frame"], type = "pin-in-slot", points = ["S", "P"], pin_diameter = "4 mm" }}
[pose.near]
lever = "0 deg"
[parts.lever]
shape = "bar"
material = "pvc-paredes-2018"
width = "9.9 mm"
thickness = "{thickness} mm"
eye_diameter = "10 mm"
eye_thickness = "{thickness} mm"
fillet_radius = "1 mm"
[solid]
mesh_size = {mesh_size}
[load_cases.tip]
forces = [{{ link = "lever", at = "H", force = ["{pull} N", "{force} N"] }}]
[checks.stiff]
type = "displacement"
link = "lever"
at = "H"
maximum = "1 mm"
"""


def slotted_lever(**changes: Any) -> Case:
    """Return the case; the pin stands in the middle of a slot from 12 to 50 mm where nothing else is said."""
    first, last = changes.get("first", 12.0), changes.get("last", 50.0)
    entries = {"first": first, "last": last, "middle": (first + last) / 2.0, "at": 31.0, "tip": 80.0}
    entries |= {"thickness": 5.0, "force": -1.0, "pull": 0.0, "mesh_size": 1.0} | changes
    return validate(tomllib.loads(LEVER.format(**entries)))
