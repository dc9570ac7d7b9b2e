"""An arm on two pins, loaded at its free end, as a case: the smallest one that has a solid model."""

import tomllib
from functools import cache

from alula.fea.check.run import check_case
from alula.loads.case.case_file import validate

ARM = """
schema_version = 1
title = "Arm on a strut"
large_displacement = "off"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["15 mm", "-10 mm"]
[links.arm]
part = "arm"
points.O = ["0 mm", "0 mm"]
points.B = ["15 mm", "0 mm"]
points.H = ["30 mm", "0 mm"]
[links.strut]
points.P = ["0 mm", "0 mm"]
points.B = ["10 mm", "0 mm"]
[joints]
O = {{ links = ["frame", "arm"], pin_diameter = "2 mm" }}
B = {{ links = ["arm", "strut"], pin_diameter = "2 mm" }}
P = {{ links = ["frame", "strut"], pin_diameter = "2 mm" }}
[pose.near]
arm = "0 deg"
strut = "90 deg"
[parts.arm]
material = "pvc-paredes-2018"
{part}
eye_diameter = "8 mm"
eye_thickness = "{thickness} mm"
fillet_radius = "{fillet} mm"
[load_cases.tip]
forces = [{{ link = "arm", at = "H", force = ["0 N", "{force} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = {minimum}
"""
BAR = 'shape = "bar"\nwidth = "4 mm"\nthickness = "3 mm"'
TUBE = 'shape = "tube"\nouter_diameter = "5 mm"\ninner_diameter = "2.5 mm"'


def arm(*, part=BAR, fillet=1.0, force=-1.0, minimum=3.0, solid=""):
    """Return the case; ``solid`` are further lines of the [solid] section."""
    thickness = 3.0 if part is BAR else 7.0
    text = ARM.format(part=part, fillet=fillet, force=force, minimum=minimum, thickness=thickness)
    return validate(tomllib.loads(text + (f"[solid]\n{solid}\n" if solid else "")))


@cache
def checked(effort=None, **changes):
    """Return what is found for the arm as a solid and the outcome of its check; the same arm is solved once."""
    found = check_case(arm(**changes), fidelity="solid", effort=effort, threads=1).load_cases["tip"]
    return found.links["arm"], found.checks[0]
