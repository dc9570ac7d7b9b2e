"""A lever that a motor turns, with a mass at its tip: held by its drive it is a cantilever."""

import math
import tomllib

from scipy.optimize import brentq

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

LEVER = """
schema_version = 1
title = "Driven lever with a mass at its tip"
[links.base]
ground = true
points.X = ["-10 mm", "0 mm"]
points.O = ["0 mm", "0 mm"]
[links.lever]
part = "bar"
points.O = ["0 mm", "0 mm"]
points.T = ["100 mm", "0 mm"]
[joints]
O = { links = ["base", "lever"], pin_diameter = "3 mm" }
[pose]
coordinate = "lever"
angle = "0 deg"
[drive]
link = "lever"
joint = "O"
[motion]
turn = true
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "8 mm"
thickness = "3 mm"
eye_diameter = "8 mm"
fillet_radius = "0 mm"
[[carried]]
link = "lever"
at = "T"
mass = "4 g"
[load_cases.turning]
own_weight = false
speed = "600 rpm"
[checks.resonance]
type = "frequency"
minimum = 4
"""


def lever(*, minimum: float = 4.0, speed: str = "600 rpm") -> Case:
    """Return the case with another limit or speed."""
    text = LEVER.replace("minimum = 4", f"minimum = {minimum!r}").replace("600 rpm", speed)
    return validate(tomllib.loads(text))


def cantilever(width: float, *, tip: float, length: float = 100.0, height: float = 3.0) -> float:
    """Lowest frequency [Hz] of a cantilever of aluminium that bends across its height, with a point mass at its tip.

    1 + cos b cosh b + a b (cos b sinh b - sin b cosh b) = 0 with the ratio a of the masses (Blevins, Formulas for
    Natural Frequency and Mode Shape, 1979, table 8-8).
    """
    young, density = 68900.0, 2.7e-9
    line = density * width * height
    a = tip / (line * length)

    def rest(b: float) -> float:
        return 1.0 + math.cos(b) * math.cosh(b) + a * b * (math.cos(b) * math.sinh(b) - math.sin(b) * math.cosh(b))

    b = brentq(rest, 0.1, 2.5)
    return (b / length) ** 2 * math.sqrt(young * width * height**3 / 12.0 / line) / (2.0 * math.pi)
