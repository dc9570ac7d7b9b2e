"""Masses that a link carries besides its own part, such as feathers, a membrane or a wing."""

from typing import Annotated

from geometry.model import CaseModel, Name
from geometry.units import NOT_NEGATIVE, POSITIVE, Length, Mass


class CarriedSpread(CaseModel):
    """A mass spread evenly along the axis of a link between two of its points."""

    link: Name
    start: Name
    end: Name
    mass: Annotated[Mass, POSITIVE]


class CarriedBody(CaseModel):
    """A rigid body held at one point of a link, through which its weight and inertia enter the part."""

    link: Name
    at: Name
    mass: Annotated[Mass, POSITIVE]
    centroid: tuple[Length, Length]
    """In the link's frame."""
    radius_of_gyration: Annotated[Length, NOT_NEGATIVE] = 0.0
    """About the centroid; a thin rod's is its length over the root of 12."""
