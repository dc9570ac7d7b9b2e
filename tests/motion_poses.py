"""Assembled linkages from which the tests start a motion, and masses and loads for them."""

import math

import numpy as np
from planar_linkages import OPEN_WING, four_bar, joint, link, quick_return, scotch_yoke, six_bar, slider_crank

from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import Motion
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.acting.weight import Weight, inertia_loads
from alula.loads.records.applied import BodyForce, LineLoad, Load, PartMass, PointLoad
from alula.loads.states.kinetostatics import Kinetostatics, energies, solve_kinetostatics, torque_by_virtual_work
from alula.loads.statics.statics import Drive

CRANK = math.radians(40.0)


def four_bar_pose(a=40.0, b=120.0, c=80.0, d=100.0, *, angle=CRANK, up=True) -> Pose:
    """The four-bar with its rocker above (up) or below the ground."""
    return solve_pose(four_bar(a, b, c, d), coordinate="crank", angle=angle, near={"rocker": 1.2 if up else -2.0})


def slider_crank_pose(a=40.0, b=130.0, offset=10.0) -> Pose:
    return solve_pose(slider_crank(a, b, offset), coordinate="crank", angle=CRANK, near={"coupler": 0.0, "block": 0.0})


def quick_return_pose() -> Pose:
    return solve_pose(quick_return(15.0, 40.0), coordinate="crank", angle=CRANK, near={"lever": math.pi / 2})


def scotch_yoke_pose() -> Pose:
    return solve_pose(scotch_yoke(25.0), coordinate="crank", angle=CRANK, near={"yoke": 0.0})


def wing_pose(linkage: Linkage | None = None) -> Pose:
    return solve_pose(linkage or six_bar(), coordinate="GF", angle=math.radians(228.15), near=OPEN_WING)


def parallelogram(third=(50.0, 20.0), length=30.0) -> Linkage:
    """Three equal cranks under one coupler: mobility 0 by count, yet it moves.

    With the third pivot off the line of the other two no pose lets the cranks choose.
    """
    return Linkage(
        {
            "base": link(ground=True, P=(0.0, 0.0), Q=(100.0, 0.0), R=third),
            "crank": link(P=(0.0, 0.0), U=(30.0, 0.0)),
            "second": link(Q=(0.0, 0.0), V=(30.0, 0.0)),
            "third": link(R=(0.0, 0.0), W=(length, 0.0)),
            "top": link(U=(0.0, 0.0), V=(100.0, 0.0), W=third),
        },
        {
            "P": joint("base", "crank"),
            "Q": joint("base", "second"),
            "R": joint("base", "third"),
            "U": joint("crank", "top"),
            "V": joint("second", "top"),
            "W": joint("third", "top"),
        },
    )


def parallelogram_pose(linkage: Linkage | None = None) -> Pose:
    near = {"second": CRANK, "third": CRANK, "top": 0.0}
    return solve_pose(linkage or parallelogram(), coordinate="crank", angle=CRANK, near=near)


def drive_of(pose: Pose) -> Drive:
    """The wing is driven at AE, all others at the link that fixes the pose."""
    link = "AE" if str(pose.coordinate) == "GF" else str(pose.coordinate)
    assert link is not None
    return Drive(
        link=link,
        joint=next(j for j in pose.linkage.joints_of(pose.linkage.ground) if j in pose.linkage.joints_of(link)),
    )


def masses_of(pose: Pose) -> dict[str, PartMass]:
    """Some mass on every moving link, centroid off its axis [tonne, mm]."""
    return {
        name: PartMass(mass=(2.0 + i) * 1e-5, centroid=np.array([11.0 + 3.0 * i, 4.0 - i]), inertia=(1.5 + i) * 1e-2)
        for i, name in enumerate(pose.linkage.moving)
    }


def weights_of(pose: Pose) -> list[Load]:
    """The weight of those masses, along a slanted direction so that both axes count [mm/s²]."""
    gravity = np.array([1200.0, -9700.0, 0.0])
    return [BodyForce(link=name, mass=own, specific_force=gravity) for name, own in masses_of(pose).items()]


def forces_of(pose: Pose) -> list[Load]:
    """Every kind of load on every moving link, in global axes and in the link's."""
    found: list[Load] = []
    for i, name in enumerate(pose.linkage.moving):
        point = list(pose.linkage.links[name].points)[-1]
        wrench = np.array([1.0 - i, 0.7 + 0.2 * i, 0.3, 0.0, 0.0, 5.0 * i - 3.0])
        ends = np.array([[0.02, -0.05, 0.0], [-0.01, 0.03 * i, 0.0]])
        for axes in ("global", "link"):
            found.append(PointLoad(link=name, point=point, wrench=wrench, axes=axes))
            found.append(LineLoad(link=name, start=3.0, end=21.0, at_start=ends[0], at_end=ends[1], axes=axes))
    return found


def kinetostatics(motion: Motion, drive: Drive | None, loads, masses=None) -> Kinetostatics:
    """Joint forces over a motion under loads and weights, with the inertia of the masses."""
    own = masses or {}
    inertia = inertia_loads(motion.placement, own, np.zeros(3))
    pulled = [one for one in loads if isinstance(one, BodyForce)]
    weights = [Weight(link=one.link, mass=one.mass, gravity=np.atleast_2d(one.specific_force)[0]) for one in pulled]
    power = energies(motion.placement, weights, [one for one in loads if not isinstance(one, BodyForce)], own)
    return solve_kinetostatics(motion, drive, [*loads, *inertia], power)


def virtual_work(motion: Motion, drive: Drive, loads, masses=None) -> np.ndarray:
    """Drive torque of the same by virtual work."""
    return torque_by_virtual_work(motion, drive, [*loads, *inertia_loads(motion.placement, masses or {}, np.zeros(3))])
