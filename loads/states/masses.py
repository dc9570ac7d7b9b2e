"""What each link weighs: its part, from volume and density, and what it carries."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np

from alula.geometry.base.errors import AlulaError
from alula.geometry.meshing.mesh import MassProperties, mass_properties
from alula.geometry.parts.part import Body
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses
from alula.loads.records.applied import PartMass
from alula.loads.records.carried import Carried, mass_of


@lru_cache(maxsize=256)
def _measured(body: Body) -> MassProperties:
    """Return volume and inertia of a body; equal bodies are measured once."""
    return mass_properties(body)


def _of_shape(body: Body) -> MassProperties:
    """Return the same, measured once of bodies that differ in the names of their pins alone."""
    pins = tuple(replace(pin, name=str(number)) for number, pin in enumerate(body.pins))
    try:
        return _measured(replace(body, pins=pins))
    except AlulaError:
        return _measured(body)  # its sentence has the names


def part_mass(case: Case, link: str) -> PartMass:
    """Return mass, centroid and moment of inertia of a link's part, by the geometry kernel; of a pair, of both plates.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    PartMass
        With each hole in the middle of what the case states of it.

    Raises
    ------
    CaseError
        For a link without part or a body that cannot be built.
    CannotRunError
        Where the kernel fails.
    """
    solid, weight = _solid(case, link, case.body_to_make(link)), case.links[link].count * case.material_of(link).density
    return PartMass(
        mass=solid.volume * weight,
        centroid=np.asarray(solid.centroid)[:2],
        inertia=float(solid.inertia[2, 2]) * weight,
    )


def _solid(case: Case, link: str, body: Body) -> MassProperties:
    try:
        return _of_shape(body)
    except AlulaError as error:
        raise type(error)(f"{link}: {error}") from None


def masses_by_holes(case: Case) -> tuple[float, float]:
    """Return what all parts weigh with the widest holes that the case allows, and with the narrowest.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of 2 float
        Least and largest mass [tonne].

    Raises
    ------
    CaseError, CannotRunError
        As ``part_mass``.
    """
    least = most = 0.0
    for link in case.checked_links:
        weight = case.links[link].count * case.material_of(link).density
        least += weight * _solid(case, link, case.body(link)).volume
        most += weight * _solid(case, link, case.narrowest_body(link)).volume
    return least, most


def part_masses(case: Case) -> dict[str, PartMass]:
    """Return the mass of every moving link's part.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict of str to PartMass
        By link; links without part are left out.
    """
    return {link: part_mass(case, link) for link in case.checked_links}


def rough_masses(case: Case) -> dict[str, float]:
    """Return the mass of every moving link's part by length and section, within some percent of that by the kernel.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict of str to float
        [tonne] by link; by the kernel for a part that is no bar with eyes, where equal bodies are measured once.
    """
    found = {}
    for link in case.checked_links:
        body = case.body_to_make(link)
        volume = body.part.rough_volume(body)
        weight = case.links[link].count * case.material_of(link).density
        found[link] = part_mass(case, link).mass if volume is None else volume * weight
    return found


def all_carried(case: Case, *, stated: bool = True) -> tuple[Carried, ...]:
    """Return the masses that links carry besides their parts: the pins between layers, and what the case states.

    Parameters
    ----------
    case : Case
    stated : bool, optional
        False where a load case leaves out what the case states; pins are always there.

    Returns
    -------
    tuple of CarriedSpread or CarriedBody
    """
    return (*pin_masses(case).values(), *(case.carried if stated else ()))


def laden_masses(case: Case, masses: Mapping[str, PartMass], *, stated: bool = True) -> dict[str, PartMass]:
    """Return the masses of the links, each of its part and what it carries.

    Parameters
    ----------
    case : Case
    masses : mapping of str to PartMass
        Of the parts alone, by link.
    stated : bool, optional
        As for ``all_carried``.

    Returns
    -------
    dict of str to PartMass
        By link.
    """
    found = dict(masses)
    for carried in all_carried(case, stated=stated):
        own, more = found.get(carried.link), mass_of(carried, case.links[carried.link].points)
        found[carried.link] = more if own is None else together(own, more)
    return found


def together(one: PartMass, other: PartMass) -> PartMass:
    """Return two masses as one, by the parallel-axis theorem.

    Parameters
    ----------
    one, other : PartMass
        About the same origin.

    Returns
    -------
    PartMass
    """
    total = one.mass + other.mass
    centre = np.asarray((one.mass * one.centroid + other.mass * other.centroid) / total)
    inertia = sum(part.inertia + part.mass * float(np.sum((part.centroid - centre) ** 2)) for part in (one, other))
    return PartMass(mass=total, centroid=centre, inertia=float(inertia))
