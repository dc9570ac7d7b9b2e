"""The resultant of everything that acts on a link, by closed form: what a piece that is cut out lacks of balance."""

import numpy as np
from numpy.typing import NDArray

from fea.common.link_loads import BodyLoad, LineLoad, LinkLoads
from geometry.meshing.mesh import MassProperties
from loads.records.applied import shifted

Real = NDArray[np.float64]


def resultant(loads: LinkLoads, solid: MassProperties, density: float) -> Real:
    """Wrench (6,) of all loads about the link's origin [N, N mm]; density in tonne/mm³."""
    total = np.zeros(6)
    for pin in loads.pins:
        total += shifted(pin.wrench, pin.centre)
    for couple in loads.couples:
        total[5] += couple.torque
    for end in loads.ends:
        total += shifted(end.wrench, end.point)
    for line in loads.lines:
        total += _of_line(line)
    for body in loads.bodies:
        total += _of_body(body, solid, density)
    return total


def _of_line(line: LineLoad) -> Real:
    """Simpson's rule, exact for an intensity that varies linearly."""
    length, total = line.last - line.first, np.zeros(6)
    for share, weight in ((0.0, 1.0), (0.5, 4.0), (1.0, 1.0)):
        force = (1.0 - share) * line.intensity[0] + share * line.intensity[1]
        place = np.array([line.first + share * length, 0.0, 0.0])
        total += weight * length / 6.0 * shifted(np.concatenate([force, np.zeros(3)]), place)
    return total


def _of_body(load: BodyLoad, solid: MassProperties, density: float) -> Real:
    """Weight and inertia of a solid that is symmetric about the linkage's plane, z = 0.

    With the mass m, its centroid c and the moment of inertia I about it, r from the link's origin and d = r − b from
    ``about``: F = m (s − α ẑ × (c − b) + ω² (c − b)) and, about the centroid, −α I ẑ.
    """
    mass, centroid = density * solid.volume, solid.centroid * (1.0, 1.0, 0.0)
    arm = (centroid - load.about) * (1.0, 1.0, 0.0)
    swirl = np.cross([0.0, 0.0, load.angular_acceleration], arm)
    force = mass * (load.specific_force - swirl + load.angular_speed**2 * arm)
    about_centroid = np.array([0.0, 0.0, -load.angular_acceleration * density * solid.inertia[2, 2]])
    return shifted(np.concatenate([force, about_centroid]), centroid)
