"""From the load case that a user states to the loads that act on the links."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from geometry.linkage.pose import Pose
from loads.case.case import Case
from loads.records.aero import air_loads
from loads.records.applied import BodyForce, LineLoad, Load, PointLoad
from loads.records.load_case import Axes, LoadCase, gravity, vector3


@dataclass(frozen=True, kw_only=True)
class PartMass:
    """Mass of a link [tonne], its centroid (2,) in the link's frame [mm], its moment of inertia [tonne mm²].

    The moment of inertia is the one about the centroid and the axis z, in which the linkage moves.
    """

    mass: float
    centroid: np.ndarray[tuple[int], np.dtype[np.float64]]
    inertia: float = 0.0


@dataclass(frozen=True, kw_only=True)
class StatedLoad:
    """A load as stated, whatever the pose.

    load  its components in the axes named by ``axes``
    axes  "global", or "link" for a load that turns with its link
    """

    load: Load
    axes: Axes = "global"

    def at(self, pose: Pose) -> Load:
        """Return the load in global axes at a pose."""
        if self.axes == "global" or isinstance(self.load, BodyForce):
            return self.load
        turn = np.eye(3)
        turn[:2, :2] = pose.rotation(self.load.link)
        if isinstance(self.load, PointLoad):
            return replace(self.load, wrench=np.concatenate([turn @ self.load.wrench[:3], turn @ self.load.wrench[3:]]))
        return replace(self.load, at_start=turn @ self.load.at_start, at_end=turn @ self.load.at_end)


def needs_masses(case: Case) -> bool:
    """Return True where a load case lets the parts weigh what they weigh, or moves them."""
    return any(load_case.own_weight or load_case.speed != 0.0 for load_case in case.load_cases.values())


def actions(case: Case, load_case: LoadCase, pose: Pose, masses: Mapping[str, PartMass]) -> tuple[Load, ...]:
    """Return every load of a load case at a pose, in global axes; ``masses`` as for ``stated_loads``."""
    return tuple(stated.at(pose) for stated in stated_loads(case, load_case, masses))


def stated_loads(case: Case, load_case: LoadCase, masses: Mapping[str, PartMass]) -> tuple[StatedLoad, ...]:
    """Return every load of a load case, good for any pose; the links in ``masses`` weigh if any weighs."""
    loads: list[StatedLoad] = []
    for force in load_case.forces:
        wrench = np.concatenate([vector3(force.force), np.zeros(3)])
        loads.append(StatedLoad(load=PointLoad(link=force.link, point=force.at, wrench=wrench), axes=force.axes))
    for moment in load_case.moments:
        wrench = np.array([0.0, 0.0, 0.0, *moment.moment])
        loads.append(StatedLoad(load=PointLoad(link=moment.link, point=moment.at, wrench=wrench)))
    for spread in load_case.spread:
        points = case.links[spread.link].points
        start, end = sorted((points[spread.start][0], points[spread.end][0]))
        density = vector3(spread.total) / (end - start)
        line = LineLoad(link=spread.link, start=start, end=end, at_start=density, at_end=density)
        loads.append(StatedLoad(load=line, axes=spread.axes))
    for i, air in enumerate(load_case.air):
        loads += [StatedLoad(load=load) for load in air_loads(air, f"air.{i}", case.link_points)]
    if load_case.own_weight:
        pull = gravity(load_case)
        loads += [
            StatedLoad(load=BodyForce(link=link, mass=own.mass, centroid=own.centroid, acceleration=pull))
            for link, own in masses.items()
        ]
    return tuple(loads)
