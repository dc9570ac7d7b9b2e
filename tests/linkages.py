"""Small linkages that the tests of several rooms share."""

import math

from geometry.linkage import Joint, Link, Linkage
from geometry.pose import Pose, solve_pose


def link(*, ground: bool = False, **points: tuple[float, float]) -> Link:
    """A link with points in mm."""
    return Link(ground=ground, points={n: (f"{float(x)!r} mm", f"{float(y)!r} mm") for n, (x, y) in points.items()})


def fourbar(a: float = 40.0, b: float = 120.0, c: float = 80.0, d: float = 100.0) -> Linkage:
    """Crank-rocker, with a point P off the coupler's axis."""
    return Linkage(
        {
            "base": link(ground=True, O2=(0.0, 0.0), O4=(d, 0.0)),
            "crank": link(O2=(0.0, 0.0), A=(a, 0.0)),
            "coupler": link(A=(0.0, 0.0), B=(b, 0.0), P=(0.5 * b, 0.3 * b)),
            "rocker": link(O4=(0.0, 0.0), B=(c, 0.0)),
        },
        {
            "O2": Joint(links=("base", "crank")),
            "A": Joint(links=("crank", "coupler")),
            "B": Joint(links=("coupler", "rocker")),
            "O4": Joint(links=("base", "rocker")),
        },
    )


def fourbar_pose(angle: float = math.radians(40.0), linkage: Linkage | None = None, *, up: bool = True) -> Pose:
    """The four-bar's open (up) or crossed pose."""
    near = {"rocker": math.radians(60.0 if up else -60.0)}
    return solve_pose(linkage or fourbar(), coordinate="crank", angle=angle, near=near)


def slider_crank(a: float = 40.0, b: float = 130.0, offset: float = 10.0) -> Linkage:
    """Offset slider-crank; the block slides along x on the frame."""
    return Linkage(
        {
            "frame": link(ground=True, O=(0.0, 0.0), S=(0.0, offset)),
            "crank": link(O=(0.0, 0.0), A=(a, 0.0)),
            "rod": link(A=(0.0, 0.0), B=(b, 0.0)),
            "block": link(B=(0.0, 0.0), S=(0.0, 0.0), P=(20.0, 5.0)),
        },
        {
            "O": Joint(links=("frame", "crank")),
            "A": Joint(links=("crank", "rod")),
            "B": Joint(links=("rod", "block")),
            "S": Joint(type="slider", links=("frame", "block")),
        },
    )


def slider_crank_pose(angle: float = math.radians(30.0), linkage: Linkage | None = None) -> Pose:
    """The slider-crank with the rod pointing to the right."""
    return solve_pose(linkage or slider_crank(), coordinate="crank", angle=angle, near={"rod": 0.0, "block": 0.0})


def slotted_lever(crank: float = 15.0, distance: float = 40.0, length: float = 90.0) -> Linkage:
    """Crank pin in the slot of a lever (quick-return): the half joint of the ornithopter's drive."""
    return Linkage(
        {
            "base": link(ground=True, O=(0.0, 0.0), Q=(0.0, -distance)),
            "crank": link(O=(0.0, 0.0), K=(crank, 0.0)),
            "lever": link(Q=(0.0, 0.0), T=(length, 0.0)),
        },
        {
            "O": Joint(links=("base", "crank")),
            "Q": Joint(links=("base", "lever")),
            "K": Joint(type="pin-in-slot", links=("lever", "crank"), points=("Q", "K")),
        },
    )


def slotted_lever_pose(angle: float = 0.4, linkage: Linkage | None = None) -> Pose:
    """The lever points up, to the crank pin."""
    return solve_pose(linkage or slotted_lever(), coordinate="crank", angle=angle, near={"lever": math.pi / 2})


def sixbar() -> Linkage:
    """The owl wing's six-bar: AG ground, H its free tip."""
    return Linkage(
        {
            "AG": link(ground=True, A=(0.0, 0.0), G=(0.0, 125.0)),
            "GF": link(G=(0.0, 0.0), F=(50.0, 0.0)),
            "AE": link(A=(0.0, 0.0), B=(112.0, 0.0), E=(190.0, 0.0)),
            "CF": link(F=(0.0, 0.0), B=(60.0, 0.0), C=(150.0, 0.0)),
            "CH": link(C=(0.0, 0.0), D=(77.0, 0.0), H=(124.0, 0.0)),
            "ED": link(E=(0.0, 0.0), D=(88.0, 0.0)),
        },
        {
            name: Joint(links=links)
            for name, links in {
                "A": ("AG", "AE"),
                "B": ("AE", "CF"),
                "C": ("CF", "CH"),
                "D": ("CH", "ED"),
                "E": ("AE", "ED"),
                "F": ("GF", "CF"),
                "G": ("AG", "GF"),
            }.items()
        },
    )


def sixbar_pose(degrees: float = 228.15) -> Pose:
    """The owl wing, open."""
    near = {"AE": 143.0, "CF": 200.0, "CH": 142.0, "ED": 200.0}
    return solve_pose(
        sixbar(),
        coordinate="GF",
        angle=math.radians(degrees),
        near={name: math.radians(angle) for name, angle in near.items()},
    )


def parallelogram(*, third: tuple[float, float] = (50.0, 20.0)) -> Linkage:
    """Three equal cranks under one coupler: mobility 0 by count, yet it moves.

    With ``third`` off the line of the other two pivots no pose lets the cranks choose.
    """
    x, y = third
    return Linkage(
        {
            "base": link(ground=True, P=(0.0, 0.0), Q=(100.0, 0.0), R=third),
            "first": link(P=(0.0, 0.0), U=(30.0, 0.0)),
            "second": link(Q=(0.0, 0.0), V=(30.0, 0.0)),
            "third": link(R=(0.0, 0.0), W=(30.0, 0.0)),
            "top": link(U=(0.0, 0.0), V=(100.0, 0.0), W=(x, y)),
        },
        {
            "P": Joint(links=("base", "first")),
            "Q": Joint(links=("base", "second")),
            "R": Joint(links=("base", "third")),
            "U": Joint(links=("first", "top")),
            "V": Joint(links=("second", "top")),
            "W": Joint(links=("third", "top")),
        },
    )


def parallelogram_pose(angle: float = 0.7, linkage: Linkage | None = None) -> Pose:
    """All cranks parallel, the coupler level."""
    near = {"second": angle, "third": angle, "top": 0.0}
    return solve_pose(linkage or parallelogram(), coordinate="first", angle=angle, near=near)
