"""A four-bar linkage in layers under a force at its rocker, whose pins may tilt in their holes."""

import tomllib
from collections.abc import Mapping, Sequence

from loads.case.case import Case
from loads.case.case_file import validate

FOUR_BAR = """
schema_version = 1
title = "Four-bar in layers"
layer_spacing = "4.5 mm"
[links.base]
ground = true
layer = 0
points = { O2 = ["0 mm", "0 mm"], O4 = ["100 mm", "0 mm"] }
[links.crank]
part = "bar"
layer = 1
points = { O2 = ["0 mm", "0 mm"], A = ["40 mm", "0 mm"] }
[links.coupler]
part = "bar"
layer = 2
points = { A = ["0 mm", "0 mm"], B = ["120 mm", "0 mm"] }
[links.rocker]
part = "bar"
layer = 1
points = { O4 = ["0 mm", "0 mm"], B = ["80 mm", "0 mm"], P = ["120 mm", "0 mm"] }
[joints]
O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
A = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
O4 = { links = ["base", "rocker"], pin_diameter = "3 mm" }
[pose]
coordinate = "crank"
angle = "40 deg"
near = { coupler = "20 deg", rocker = "57 deg" }
[drive]
link = "crank"
joint = "O2"
[parts.bar]
shape = "bar"
material = "m"
width = "8 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
[materials.m]
title = "m"
density = "1200 kg/m^3"
strength = "yield"
minimum_safety_factor = 2.0
[load_cases.l]
[[load_cases.l.forces]]
link = "rocker"
at = "P"
[checks.s]
type = "safety-factor"
minimum = 2.0
"""
ALUMINIUM = {"youngs_modulus": "70000 MPa", "poissons_ratio": 0.33, "yield_strength": "240 MPa"}
PLA = {"youngs_modulus": "2500 MPa", "poissons_ratio": 0.36, "yield_strength": "50 MPa"}


def four_bar(
    material: Mapping[str, object], force: list[str], tight: Mapping[str, Sequence[str]] | None = None
) -> Case:
    """The case of this material, with pins that are tight in these links."""
    data = tomllib.loads(FOUR_BAR)
    known = dict.fromkeys([*material, "density"], "assumed")
    data["materials"]["m"] |= material | {"sources": known, "status": known}
    data["load_cases"]["l"]["forces"][0]["force"] = force
    for name, links in (tight or {}).items():
        data["joints"][name]["tight_in"] = list(links)
    return validate(data)
