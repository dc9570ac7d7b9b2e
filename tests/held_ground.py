"""A cantilever as the ground: a bar held at its end x = L, whose other end bears a strut that is loaded at its far end.

The load at B acts along the strut AB, and so the second strut OB bears nothing: all of it bends and compresses the bar.
"""

import tomllib

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

L, WIDTH, THICKNESS, E, POISSON = 80.0, 8.0, 4.0, 2800.0, 0.38
"""Of the bar from A to base [mm], and of its material, pvc-u [MPa]."""
TOML = """
schema_version = 1
title = "Bracket"
[links.bracket]
ground = true
part = "bar"
held_at = "base"
end_patch = "7 mm"
points = { A = ["0 mm", "0 mm"], O = ["40 mm", "0 mm"], base = ["80 mm", "0 mm"] }
[links.strut]
part = "strut"
points = { A = ["0 mm", "0 mm"], B = ["50 mm", "0 mm"] }
[links.idle]
part = "strut"
points = { O = ["0 mm", "0 mm"], B = ["80.62257748298549 mm", "0 mm"] }
[joints]
A = { links = ["bracket", "strut"], pin_diameter = "3 mm" }
B = { links = ["strut", "idle"], pin_diameter = "3 mm" }
O = { links = ["bracket", "idle"], pin_diameter = "3 mm" }
[pose.near]
strut = "233.13 deg"
idle = "209.74 deg"
[load_cases.push]
forces = [{ link = "strut", at = "B", force = ["1.2 N", "1.6 N"] }]
[checks]
strength = { type = "safety-factor", minimum = 2.0 }
[parts.bar]
shape = "bar"
material = "pvc-u"
width = "8 mm"
thickness = "4 mm"
eye_diameter = "12 mm"
eye_thickness = "4 mm"
fillet_radius = "2 mm"
[parts.strut]
shape = "bar"
material = "steel-s235"
width = "10 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
"""
"""B lies at (-30, -40) mm."""


def bracket(**changes: object) -> Case:
    """Return the case with entries changed, each by its path with ``__`` for dots; None removes one."""
    data = tomllib.loads(TOML)
    for path, value in changes.items():
        *above, last = path.split("__")
        here = data
        for key in above:
            here = here.setdefault(key, {})
        if value is None:
            del here[last]
        else:
            here[last] = value
    return validate(data)
