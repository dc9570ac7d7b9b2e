"""Linkages shared by the tests, built from plain numbers (mm, rad)."""

import math
from typing import Any

import numpy as np

from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage


def link(*, ground: bool = False, **points: tuple[float, float]) -> Link:
    return Link(ground=ground, points={name: (mm(x), mm(y)) for name, (x, y) in points.items()})  # type: ignore[misc]


def mm(length: float) -> str:
    """A length as text; what is smaller than any that a case may state is none."""
    return f"{float(length) if abs(length) > 1e-15 else 0.0!r} mm"


def joint(first: str, second: str, **entries: Any) -> Joint:
    return Joint(links=(first, second), **entries)


def deg(angle: float) -> str:
    return f"{float(angle) if abs(angle) > 1e-15 else 0.0!r} deg"


def four_bar(a: float, b: float, c: float, d: float) -> Linkage:
    """Crank a, coupler b (with a point P off its axis), rocker c, ground d; crank pin A at the origin."""
    return Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), D=(d, 0.0)),
            "crank": link(A=(0.0, 0.0), B=(a, 0.0)),
            "coupler": link(B=(0.0, 0.0), C=(b, 0.0), P=(0.4 * b, 0.3 * b)),
            "rocker": link(D=(0.0, 0.0), C=(c, 0.0)),
        },
        {
            "A": joint("ground", "crank"),
            "B": joint("crank", "coupler"),
            "C": joint("coupler", "rocker"),
            "D": joint("ground", "rocker"),
        },
    )


def slider_crank(a: float, b: float, offset: float) -> Linkage:
    """Crank a, coupler b, block that slides along x at the height ``offset``."""
    return Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), S=(0.0, offset)),
            "crank": link(A=(0.0, 0.0), B=(a, 0.0)),
            "coupler": link(B=(0.0, 0.0), C=(b, 0.0)),
            "block": link(C=(0.0, 0.0), Q=(10.0, 5.0)),
        },
        {
            "A": joint("ground", "crank"),
            "B": joint("crank", "coupler"),
            "C": joint("coupler", "block"),
            "S": joint("ground", "block", type="slider", points=("S", "C")),
        },
    )


def scotch_yoke(a: float) -> Linkage:
    """Crank a whose pin B runs in the upright slot of a yoke that slides along x."""
    return Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), S=(0.0, 0.0)),
            "crank": link(A=(0.0, 0.0), B=(a, 0.0)),
            "yoke": link(Y=(0.0, 0.0), Z=(30.0, 0.0)),
        },
        {
            "A": joint("ground", "crank"),
            "S": joint("ground", "yoke", type="slider", points=("S", "Y")),
            "B": joint("yoke", "crank", type="pin-in-slot", points=("Y", "B"), direction=deg(90.0)),
        },
    )


def quick_return(a: float, d: float) -> Linkage:
    """Crank a about A whose pin B runs along the slot of a lever about O, which stands d below A."""
    return Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), O=(0.0, -d)),
            "crank": link(A=(0.0, 0.0), B=(a, 0.0)),
            "lever": link(O=(0.0, 0.0), E=(3.0 * d, 0.0)),
        },
        {
            "A": joint("ground", "crank"),
            "O": joint("ground", "lever"),
            "B": joint("lever", "crank", type="pin-in-slot", points=("O", "B")),
        },
    )


def oscillating_cylinder(a: float, d: float, bent: float = 0.0) -> Linkage:
    """Crank a whose pin B carries a rod; the rod slides in a cylinder about O, at d from the crank's pin A.

    ``bent`` is the fixed angle of the rod to the cylinder [rad]: a slider between two moving links.
    """
    return Linkage(
        {
            "ground": link(ground=True, A=(0.0, 0.0), O=(d, 0.0)),
            "crank": link(A=(0.0, 0.0), B=(a, 0.0)),
            "cylinder": link(O=(0.0, 0.0), M=(20.0, 3.0)),
            "rod": link(B=(0.0, 0.0), N=(15.0, -4.0)),
        },
        {
            "A": joint("ground", "crank"),
            "O": joint("ground", "cylinder"),
            "B": joint("crank", "rod"),
            "S": joint("cylinder", "rod", type="slider", points=("O", "B"), angle=deg(math.degrees(bent))),
        },
    )


def six_bar(scale: float = 1.0, ground_turn: float = 0.0, mirror: float = 1.0, shift: complex = 0.0) -> Linkage:
    """The owl wing (Paredes 2018, table 7); its ground may be scaled, mirrored, turned and moved."""

    def at(z: complex) -> tuple[float, float]:
        z = z.conjugate() if mirror < 0 else z
        z = z * np.exp(1j * ground_turn) * scale + shift
        return float(z.real), float(z.imag)

    def along(**stations: float) -> Link:
        return link(**{name: (x * scale, 0.0) for name, x in stations.items()})

    return Linkage(
        {
            "AG": link(ground=True, A=at(0j), G=at(125j)),
            "GF": along(G=0.0, F=50.0),
            "AE": along(A=0.0, B=112.0, E=190.0),
            "CF": along(F=0.0, B=60.0, C=150.0),
            "CH": along(C=0.0, D=77.0, H=124.0),
            "ED": along(E=0.0, D=88.0),
        },
        {
            "A": joint("AG", "AE"),
            "B": joint("AE", "CF"),
            "C": joint("CF", "CH"),
            "D": joint("CH", "ED"),
            "E": joint("AE", "ED"),
            "F": joint("GF", "CF"),
            "G": joint("AG", "GF"),
        },
    )


OPEN_WING = {name: math.radians(angle) for name, angle in {"AE": 143, "CF": 200, "CH": 142, "ED": 200}.items()}
"""Rough directions of the owl wing's links with the wing open (F at 228.15° from G)."""
