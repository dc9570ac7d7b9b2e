"""What each link weighs: its part, from volume and density, and what it carries."""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from geometry.meshing.mesh import MassProperties, mass_properties
from geometry.parts.part import Body
from loads.case.case import Case
from loads.states.actions import PartMass
from loads.states.inertia import with_carried


@lru_cache(maxsize=256)
def _measured(body: Body) -> MassProperties:
    """Volume and inertia of a body; equal bodies, and one body in several motions, are measured once."""
    return mass_properties(body)


def part_mass(case: Case, link: str) -> PartMass:
    """Return mass, centroid and moment of inertia of a link's part, by the geometry kernel.

    Raises ``CaseError`` for a link without part or a body that cannot be built, ``CannotRunError`` where
    the kernel fails.
    """
    solid, density = _measured(case.body(link)), case.material_of(link).density
    return PartMass(
        mass=solid.volume * density,
        centroid=np.asarray(solid.centroid)[:2],
        inertia=float(solid.inertia[2, 2]) * density,
    )


def part_masses(case: Case) -> dict[str, PartMass]:
    """Return the mass of every moving link's part; links without part are left out."""
    return {link: part_mass(case, link) for link in case.checked_links}


def laden_masses(case: Case, masses: Mapping[str, PartMass]) -> dict[str, PartMass]:
    """Return the masses together with what the case's links carry."""
    found = dict(masses)
    for link in case.linkage.moving:
        carried = tuple(mass for mass in case.carried if mass.link == link)
        if carried:
            found[link] = with_carried(found.get(link), carried, case.links[link].points)
    return found
