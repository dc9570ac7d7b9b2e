"""Linkages in layers whose pins run in their holes, and the free motion of such rigid links by linear programming."""

import math
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

FOUR_BAR = """
schema_version = 1
title = "Four-bar in layers"
layer_spacing = "4.5 mm"
links.base = { ground = true, layer = 0, points = { O2 = ["0 mm", "0 mm"], O4 = ["100 mm", "0 mm"] } }
links.crank = { part = "bar", layer = 1, points = { O2 = ["0 mm", "0 mm"], A = ["40 mm", "0 mm"] } }
links.coupler = { part = "bar", layer = 2, points = { A = ["0 mm", "0 mm"], B = ["120 mm", "0 mm"] } }
links.rocker.part = "bar"
links.rocker.layer = 1
links.rocker.points = { O4 = ["0 mm", "0 mm"], B = ["80 mm", "0 mm"], P = ["120 mm", "0 mm"] }
joints.O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
joints.A = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
joints.B = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
joints.O4 = { links = ["base", "rocker"], pin_diameter = "3 mm" }
pose = { coordinate = "crank", angle = "40 deg", near = { coupler = "20 deg", rocker = "57 deg" } }
drive = { link = "crank", joint = "O2" }
parts.bar = { shape = "bar", material = "m", width = "8 mm", thickness = "4 mm", fillet_radius = "2 mm" }
[materials.m]
title = "aluminium"
youngs_modulus = "70000 MPa"
poissons_ratio = 0.33
density = "1200 kg/m^3"
strength = "yield"
yield_strength = "240 MPa"
[load_cases]
l = { forces = [{ link = "rocker", at = "P", force = ["0 N", "-20 N"] }] }
"""
"""Bars of 8 x 4 mm, 0.5 mm apart, with pins of 3 mm."""

ALUMINIUM = {"youngs_modulus": "70000 MPa", "poissons_ratio": 0.33, "yield_strength": "240 MPa"}
PLA = {"youngs_modulus": "2500 MPa", "poissons_ratio": 0.36, "yield_strength": "50 MPa"}
TIGHT = {"O2": "crank", "A": "crank", "B": "rocker", "O4": "rocker"}
LOOSE = {"O2": "base", "A": "coupler", "B": "coupler", "O4": "base"}
"""The other links of the joints."""
_CORNERS = 64


def four_bar(
    *, tight: Mapping[str, str | Sequence[str]] = TIGHT, play: str | None = None, **further: Any
) -> dict[str, Any]:
    """Return the data of the four-bar, with pins tight in one link or in both, and play in all joints."""
    data = tomllib.loads(FOUR_BAR)
    material = data["materials"]["m"]
    entries = ("youngs_modulus", "poissons_ratio", "density", "yield_strength")
    material |= {table: dict.fromkeys(entries, "assumed") for table in ("sources", "status")}
    for name, links in tight.items():
        data["joints"][name]["tight_in"] = links if isinstance(links, str) else list(links)
    for joint in data["joints"].values() if play else ():
        joint["clearance"] = play
    return {**data, **further}


def in_one_layer(*, forks: bool = True, **further: Any) -> dict[str, Any]:
    """Return the data of the four-bar in one layer: the ends of its coupler are forks of unequal gaps."""
    data = four_bar(tight={}, **further)
    del data["layer_spacing"]
    for link in data["links"].values():
        del link["layer"]
    data["links"]["base"]["thickness"] = "5 mm"
    if forks:
        data["parts"]["thick"] = data["parts"]["bar"] | {"thickness": "10 mm"}
        eyes = {
            at: {"fork": gap, "fork_depth": "16 mm", "fork_radius": "0.8 mm"}
            for at, gap in (("A", "4.4 mm"), ("B", "5 mm"))
        }
        data["links"]["coupler"] |= {"part": "thick", "eyes": eyes}
    return data


def loaded(
    material: Mapping[str, object], force: list[str], tight: Mapping[str, str | Sequence[str]] | None = None
) -> Case:
    """The four-bar of a material under a force at its rocker, with a check of its strength."""
    data = four_bar(tight=tight or {}, checks={"s": {"type": "safety-factor", "minimum": 2.0}})
    data["materials"]["m"] |= material
    data["load_cases"]["l"]["forces"][0]["force"] = force
    return checked(data)


def place_of(case: Case, link: str, point: str) -> NDArray[np.float64]:
    """Return where a point of a link stands (3,) [mm]."""
    return np.array([*case.solve_pose().position(link, point), case.linkage.heights[link]])


def rigid_motion(
    case: Case,
    link: str,
    where: NDArray[np.float64],
    along: NDArray[np.float64],
    *,
    holes: Mapping[str, str],
    play: float,
    length: float,
    against: str = "",
    tilt: float = math.inf,
) -> float:
    """Return how far a place of rigid links goes along a direction, or against another link, to first order.

    Six unknowns of every moving link; at both rims of every hole the axis of the other link's pin stays in a polygon
    about a circle of half the play, in every hole its tilt in one about a circle, links do not shift along the pins,
    and the drive holds its link.
    """
    from scipy.optimize import linprog

    moving = case.linkage.moving

    def moved(link: str, where: NDArray[np.float64]) -> NDArray[np.float64]:
        found = np.zeros((3, 6 * len(moving)))
        if link in moving:
            k, (x, y, z) = 6 * moving.index(link), where
            found[:, k : k + 3] = np.eye(3)
            found[:, k + 3 : k + 6] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
        return found

    turns = np.arange(_CORNERS) * 2.0 * np.pi / _CORNERS
    sides = np.column_stack([np.cos(turns), np.sin(turns)])
    within, held = [], []
    for name, hole in holes.items():
        [other] = [link for link in case.joints[name].links if link != hole]
        middle = place_of(case, hole, case.linkage.point_of(name, hole))
        edges = [middle + np.array([0.0, 0.0, rim]) for rim in (-length / 2.0, length / 2.0)]
        low, high = (moved(other, edge)[:2] - moved(hole, edge)[:2] for edge in edges)
        within += [sides @ low, sides @ high, sides @ (high - low)]
        held.append((moved(other, middle) - moved(hole, middle))[2])
    assert case.drive is not None
    turn = np.zeros(6 * len(moving))
    turn[6 * moving.index(case.drive.link) + 5] = 1.0
    found = linprog(
        -along @ (moved(link, where) - moved(against, where)),
        A_ub=np.vstack(within),
        b_ub=np.tile(np.repeat([play / 2.0, play / 2.0, min(play, length * tilt)], _CORNERS), len(holes)),
        A_eq=np.vstack([*held, turn]),
        b_eq=np.zeros(len(held) + 1),
        bounds=(None, None),
    )
    assert found.status == 0
    return float(-found.fun)


def checked(data: Mapping[str, Any]) -> Case:
    """Return the case of some data."""
    return validate(dict(data))
