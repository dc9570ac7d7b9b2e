"""Weight and inertia of a link, spread over its volume."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer, body_density, wrench_density
from alula.loads.records.applied import BodyForce, PartMass

Real = NDArray[np.float64]


class MassForce(LinearLoad):
    """What moves a mass of the link: its amounts are those of the ``unit_forces``.

    Its resultants are those on the link's own mass, which a coarse mesh, with chords in place of arcs, misses.
    """

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[tuple[float, ...], BodyForce]:
        """As ``LinearLoad.places``: the link's mass."""
        return {} if loads.inertia is None else {_told(loads.inertia.mass): loads.inertia}

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """As ``LinearLoad.amounts``: how much of each acts (5, n) [mm/s², rad/s², rad²/s²]."""
        own = loads.inertia
        return amounts(own) if own is not None and _told(own.mass) == self.place else np.zeros((5, loads.poses))

    def unit(self, number: int) -> Real:
        """As ``LinearLoad.unit``: the load vector of a unit force."""
        volume, origin, force = self.surfaces.volume, np.zeros(3), unit_forces(self.sample.mass)[number]
        density = body_density(volume, force, self.surfaces.density)
        missing = LinkLoads(name="", inertia=force).on_mass - volume.wrench(density, origin)
        return self.surfaces.vector(volume, density + wrench_density(volume, origin, missing))


def _told(mass: PartMass) -> tuple[float, ...]:
    return mass.mass, *mass.centroid, mass.inertia


def amounts(body: BodyForce) -> Real:
    """Return how much of each of the ``unit_forces`` moves a mass.

    Parameters
    ----------
    body : BodyForce
        At n poses.

    Returns
    -------
    ndarray, shape (5, n)
        [mm/s², rad/s², rad²/s²]
    """
    turning = np.broadcast_arrays(body.specific_force[:, 0], body.angular_acceleration, body.angular_speed_squared)
    return np.array([*body.specific_force.T, *turning[1:]])


def unit_forces(mass: PartMass) -> tuple[BodyForce, ...]:
    """Return unit specific forces along x, y and z, unit angular acceleration and unit squared angular speed.

    Parameters
    ----------
    mass : PartMass
        Of the link.

    Returns
    -------
    tuple of BodyForce
        The five, in link axes [mm/s², rad/s², rad²/s²].
    """
    return tuple(
        BodyForce(
            link="",
            mass=mass,
            specific_force=unit[:3],
            angular_acceleration=unit[3],
            angular_speed_squared=unit[4],
            axes="link",
        )
        for unit in np.eye(5)
    )
