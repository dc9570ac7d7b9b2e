"""Inertia and carried masses at one pose, as loads after D'Alembert.

At a constant speed of the pose's coordinate every mass element dm of a link loads it with (g - a) dm, where a
is its acceleration (Norton, Design of Machinery, 5th ed., chapters 10 and 11).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.linkage.motion import solve_motion
from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.records.applied import BodyForce, LineLoad, Load, PointLoad
from loads.records.carried import Carried, CarriedSpread
from loads.records.load_case import LoadCase, gravity
from loads.states.actions import PartMass, actions

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LinkRates:
    """How a link moves at one pose, global axes.

    acceleration          (2,) of the origin of its frame [mm/s²]
    angular_speed         [rad/s]
    angular_acceleration  [rad/s²]
    """

    acceleration: Real
    angular_speed: float
    angular_acceleration: float

    def acceleration_at(self, arm: Real) -> Real:
        """Acceleration (2,) of the point of the link that stands at ``arm`` (2,) from its origin, global axes."""
        across = np.array([-arm[1], arm[0]])
        return np.asarray(self.acceleration + self.angular_acceleration * across - self.angular_speed**2 * arm)


def link_rates(pose: Pose, speed: float) -> dict[str, LinkRates]:
    """Return the rates of every moving link while the pose's coordinate turns at a constant speed [rad/s].

    Raises ``CaseError`` for a pose without coordinate or at a dead point of its coordinate.
    """
    motion = solve_motion(pose, [pose.held], speed=speed)
    rates = {}
    for link in pose.linkage.moving:
        point, (x, y) = next(iter(pose.linkage.links[link].points.items()))
        spin, rate = float(motion.angular_speed(link)[0]), float(motion.angular_acceleration(link)[0])
        arm = pose.rotation(link) @ np.array([x, y])
        turning = rate * np.array([-arm[1], arm[0]]) - spin**2 * arm
        rates[link] = LinkRates(
            acceleration=motion.linear_acceleration(link, point)[0] - turning,
            angular_speed=spin,
            angular_acceleration=rate,
        )
    return rates


def acting_loads(case: Case, load_case: LoadCase, pose: Pose, masses: Mapping[str, PartMass]) -> tuple[Load, ...]:
    """Return everything that acts at a pose, in global axes: stated loads, weight, carried masses and inertia.

    masses  of the parts alone; what links carry comes from the case
    """
    loads = list(actions(case, load_case, pose, masses))
    if load_case.carried and (load_case.own_weight or load_case.speed != 0.0):
        pull = gravity(load_case) if load_case.own_weight else np.zeros(3)
        loads += carried_loads(pose, case.carried, pull, load_case.speed)
    if load_case.speed != 0.0:
        loads += inertia_loads(pose, load_case.speed, masses)
    return tuple(loads)


def inertia_loads(pose: Pose, speed: float, masses: Mapping[str, PartMass]) -> tuple[Load, ...]:
    """Return what the inertia of the parts does at a pose, for a constant speed of its coordinate [rad/s]."""
    rates = link_rates(pose, speed)
    return tuple(
        BodyForce(
            link=link,
            mass=own.mass,
            centroid=own.centroid,
            acceleration=np.array([*-rates[link].acceleration_at(pose.rotation(link) @ own.centroid), 0.0]),
            inertia=own.inertia,
            angular_speed=rates[link].angular_speed,
            angular_acceleration=rates[link].angular_acceleration,
        )
        for link, own in masses.items()
    )


def carried_loads(pose: Pose, carried: tuple[Carried, ...], gravity: Real, speed: float) -> tuple[Load, ...]:
    """Return what carried masses do to their links: weight under ``gravity`` (3,) [mm/s²] and inertia."""
    rates = link_rates(pose, speed) if speed != 0.0 else {}
    found: list[Load] = []
    for mass in carried:
        turn, points = pose.rotation(mass.link), pose.linkage.links[mass.link].points

        def specific_force(at: Real, link: str = mass.link, turn: Real = turn) -> Real:
            """Force per mass (3,) at a point of the link's frame."""
            moved = rates[link].acceleration_at(turn @ at) if link in rates else np.zeros(2)
            return np.asarray(gravity - np.array([*moved, 0.0]))

        if isinstance(mass, CarriedSpread):
            start, end = sorted((points[mass.start][0], points[mass.end][0]))
            density = mass.mass / (end - start)
            first, last = (density * specific_force(np.array([x, 0.0])) for x in (start, end))
            found.append(LineLoad(link=mass.link, start=start, end=end, at_start=first, at_end=last))
            continue
        centroid = np.array(mass.place(points))
        force = mass.mass * specific_force(centroid)
        arm = np.array([*(turn @ (centroid - np.array(points[mass.at]))), 0.0])
        moment = np.cross(arm, force)
        if mass.link in rates:
            moment[2] -= mass.mass * mass.radius_of_gyration**2 * rates[mass.link].angular_acceleration
        found.append(PointLoad(link=mass.link, point=mass.at, wrench=np.concatenate([force, moment])))
    return tuple(found)


def with_carried(
    own: PartMass | None, carried: tuple[Carried, ...], points: Mapping[str, tuple[float, float]]
) -> PartMass:
    """Return mass, centroid and moment of inertia of a part (or of none) together with what it carries.

    Huygens and Steiner's parallel-axis rule; a spread mass is a thin rod along the link's axis.
    """
    pieces = [] if own is None else [own]
    for mass in carried:
        if isinstance(mass, CarriedSpread):
            start, end = points[mass.start][0], points[mass.end][0]
            centroid, inertia = np.array([(start + end) / 2.0, 0.0]), mass.mass * (end - start) ** 2 / 12.0
        else:
            centroid, inertia = np.array(mass.place(points)), mass.mass * mass.radius_of_gyration**2
        pieces.append(PartMass(mass=mass.mass, centroid=centroid, inertia=inertia))
    total = sum(piece.mass for piece in pieces)
    centre = np.asarray(sum(piece.mass * piece.centroid for piece in pieces) / total)
    inertia = sum(piece.inertia + piece.mass * float(np.sum((piece.centroid - centre) ** 2)) for piece in pieces)
    return PartMass(mass=total, centroid=centre, inertia=float(inertia))
