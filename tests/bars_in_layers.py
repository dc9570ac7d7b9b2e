"""A four-bar linkage of plain bars in layers, crank at the origin, whose gaps have closed forms."""

import tomllib
from collections.abc import Mapping
from types import MappingProxyType

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

TEXT = """
schema_version = 1
title = "Bars in layers"
layer_spacing = "10 mm"
[links.base]
ground = true
layer = {layers[0]}
points.A = ["0 mm", "0 mm"]
points.D = ["{d} mm", "0 mm"]
[links.crank]
layer = {layers[1]}
part = "bar"
points.A = ["0 mm", "0 mm"]
points.B = ["{a} mm", "0 mm"]
[links.coupler]
layer = {layers[2]}
part = "bar"
points.B = ["0 mm", "0 mm"]
points.C = ["{b} mm", "0 mm"]
[links.rocker]
layer = {layers[3]}
part = "bar"
points.D = ["0 mm", "0 mm"]
points.C = ["{c} mm", "0 mm"]
[joints]
A = {{ links = ["base", "crank"], pin_diameter = "{pin} mm" }}
B = {{ links = ["crank", "coupler"], pin_diameter = "{pin} mm" }}
C = {{ links = ["coupler", "rocker"], pin_diameter = "{pin} mm" }}
D = {{ links = ["base", "rocker"], pin_diameter = "{pin} mm" }}
[pose]
coordinate = "crank"
angle = "{start} deg"
near = {{ coupler = "{near[0]} deg", rocker = "{near[1]} deg" }}
[drive]
link = "crank"
joint = "A"
[motion]
range = ["{start} deg", "{end} deg"]
[parts.bar]
shape = "bar"
material = "pla-fdm-xy"
width = "{width} mm"
thickness = "6 mm"
fillet_radius = "0 mm"
eye_diameter = "{width} mm"
[load_cases.lift]
own_weight = false
[[load_cases.lift.forces]]
link = "rocker"
at = "C"
force = ["0 N", "-1 N"]
"""


def four_bars(
    layers: tuple[int, int, int, int],
    lengths: tuple[float, float, float, float],
    *,
    start: float,
    end: float,
    near: tuple[float, float],
    width: float = 16.0,
    pin: float = 8.0,
    more: str = "",
    edits: Mapping[str, str] = MappingProxyType({}),
) -> Case:
    """The linkage of base, crank, coupler and rocker in these layers; lengths of crank, coupler, rocker, base."""
    a, b, c, d = lengths
    text = TEXT.format(layers=layers, a=a, b=b, c=c, d=d, start=start, end=end, near=near, width=width, pin=pin)
    for old, new in edits.items():
        assert old in text
        text = text.replace(old, new)
    return validate(tomllib.loads(text + more))


def parallel_bars(layers: tuple[int, int, int, int] = (0, 1, 2, 1), **entries: float) -> Case:
    """Crank and rocker, 120 mm long and 100 mm apart, stay parallel and close on each other from 60 to 5 degrees."""
    bars = {"start": 60.0, "end": 5.0, **entries}
    return four_bars(layers, (120.0, 100.0, 120.0, 100.0), near=(0.0, bars["start"]), **bars)  # type: ignore[arg-type]


def bar_on_a_pin(layers: tuple[int, int, int, int] = (0, 1, 3, 2)) -> Case:
    """The crank lies between the layers that the pin D joins, and swings towards it from 60 to 3 degrees."""
    return four_bars(layers, (120.0, 80.0, 80.0, 100.0), start=60.0, end=3.0, near=(-20.0, 60.0))
