"""A tube of any number of diameters as a case: on a pin at one end and a strut in the middle, loaded at the other."""

from alula.loads.case.case_file import validate

DIAMETER = 5.0


def text(ratio, *, force=-1e-3, solid=""):
    """Return the case file; ``ratio`` is length over diameter, ``solid`` further lines of the [solid] section."""
    half, whole = DIAMETER * ratio / 2.0, DIAMETER * ratio
    return f"""
schema_version = 1
title = "Tube of {ratio} diameters"
large_displacement = "off"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["{half} mm", "-100 mm"]
[links.tube]
part = "tube"
points.O = ["0 mm", "0 mm"]
points.B = ["{half} mm", "0 mm"]
points.H = ["{whole} mm", "0 mm"]
[links.strut]
points.P = ["0 mm", "0 mm"]
points.B = ["100 mm", "0 mm"]
[joints]
O = {{ links = ["frame", "tube"], pin_diameter = "2 mm" }}
B = {{ links = ["tube", "strut"], pin_diameter = "2 mm" }}
P = {{ links = ["frame", "strut"], pin_diameter = "2 mm" }}
[pose.near]
tube = "0 deg"
strut = "90 deg"
[parts.tube]
shape = "tube"
material = "pvc-paredes-2018"
outer_diameter = "{DIAMETER} mm"
inner_diameter = "{DIAMETER / 2.0} mm"
eye_diameter = "8 mm"
eye_thickness = "7 mm"
fillet_radius = "0.8 mm"
[load_cases.tip]
forces = [{{ link = "tube", at = "H", force = ["0 N", "{force} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 3.0
[solid]
{solid}
"""


def case(ratio, **options):
    """Return the case itself."""
    import tomllib

    return validate(tomllib.loads(text(ratio, **options)))


def tip_deflection(ratio, young, second_moment, force=1e-3):
    """Deflection of the overhanging end by bending alone [mm], span l = a: F a² (l + a)/(3EI) (Roark, table 8.1)."""
    half = DIAMETER * ratio / 2.0
    return force * half**2 * (2.0 * half) / (3.0 * young * second_moment)
