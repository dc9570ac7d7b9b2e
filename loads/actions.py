"""From the load case that a user states to the loads that act on the links."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry.pose import Pose
from loads.applied import BodyForce, LineLoad, Load, PointLoad
from loads.case import Case, LoadCase, vector3


@dataclass(frozen=True, kw_only=True)
class PartMass:
    """Mass of a link's part [tonne] and its centroid (2,) in the link's frame [mm]."""

    mass: float
    centroid: np.ndarray[tuple[int], np.dtype[np.float64]]


def needs_masses(case: Case) -> bool:
    """Return True where a load case lets the parts weigh what they weigh."""
    return any(load_case.own_weight for load_case in case.load_cases.values())


def actions(case: Case, load_case: LoadCase, pose: Pose, masses: Mapping[str, PartMass]) -> tuple[Load, ...]:
    """Return every load of a load case; ``masses`` must hold the links with a part if they weigh."""
    loads: list[Load] = []
    for force in load_case.forces:
        wrench = np.concatenate([vector3(force.force), np.zeros(3)])
        loads.append(PointLoad(link=force.link, point=force.at, wrench=wrench))
    for moment in load_case.moments:
        wrench = np.array([0.0, 0.0, 0.0, 0.0, 0.0, moment.moment])
        loads.append(PointLoad(link=moment.link, point=moment.at, wrench=wrench))
    for spread in load_case.spread:
        points = case.links[spread.link].points
        start, end = sorted((points[spread.start][0], points[spread.end][0]))
        density = vector3(spread.total) / (end - start)
        loads.append(LineLoad(link=spread.link, start=start, end=end, at_start=density, at_end=density))
    if load_case.own_weight:
        direction = load_case.gravity_direction
        gravity = load_case.gravity * np.array([math.cos(direction), math.sin(direction), 0.0])
        loads += [
            BodyForce(link=link, mass=masses[link].mass, centroid=masses[link].centroid, acceleration=gravity)
            for link in case.checked_links
        ]
    return tuple(loads)
