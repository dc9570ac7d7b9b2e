"""Masses that a link carries besides its own part, such as feathers, a membrane or a wing."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Discriminator, Tag

from alula.geometry.base.model import CaseModel, Name
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length, Mass
from alula.loads.records.applied import PartMass


class CarriedSpread(CaseModel):
    """A mass spread evenly along the axis of a link between two of its points."""

    link: Name
    """The link that carries it."""
    start: Name
    """The point at which it begins."""
    end: Name
    """The point at which it ends."""
    mass: Annotated[Mass, POSITIVE]
    """The whole mass, spread evenly."""


class CarriedBody(CaseModel):
    """A rigid body held at one point of a link, through which its weight and inertia enter the part."""

    link: Name
    """The link that carries it."""
    at: Name
    """The point at which it is held."""
    mass: Annotated[Mass, POSITIVE]
    """Its mass."""
    centroid: tuple[Length, Length] | None = None
    """In the link's frame; at the point itself when left out."""
    radius_of_gyration: Annotated[Length, NOT_NEGATIVE] = 0.0
    """About the centroid; a thin rod's is its length over the root of 12. Natural frequencies take the body for a rod
    along the link's axis."""


def _kind(stated: Any) -> str:
    keys = stated if isinstance(stated, dict) else vars(stated) if isinstance(stated, CaseModel) else ()
    return "spread" if "start" in keys or "end" in keys else "body"


Carried = Annotated[Annotated[CarriedSpread, Tag("spread")] | Annotated[CarriedBody, Tag("body")], Discriminator(_kind)]


def mass_of(carried: CarriedSpread | CarriedBody, points: Mapping[str, tuple[float, float]]) -> PartMass:
    """Return what a link carries as a mass of its own; a spread one is a thin rod along the link's axis.

    Parameters
    ----------
    carried : CarriedSpread or CarriedBody
        What is carried.
    points : mapping of str to (x, y)
        The link's points [mm].

    Returns
    -------
    PartMass
        In the link's frame.
    """
    if isinstance(carried, CarriedSpread):
        start, end = points[carried.start][0], points[carried.end][0]
        centroid, inertia = np.array([(start + end) / 2.0, 0.0]), carried.mass * (end - start) ** 2 / 12.0
    else:
        centroid = np.array(points[carried.at] if carried.centroid is None else carried.centroid)
        inertia = carried.mass * carried.radius_of_gyration**2
    return PartMass(mass=carried.mass, centroid=centroid, inertia=inertia)
