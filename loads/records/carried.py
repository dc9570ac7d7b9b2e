"""Masses that a link carries besides its own part, such as feathers, a membrane or a wing."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Discriminator, Tag

from geometry.base.model import CaseModel, Name
from geometry.base.units import NOT_NEGATIVE, POSITIVE, Length, Mass


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
    centroid: tuple[Length, Length] | None = None
    """In the link's frame; at the point itself when left out."""
    radius_of_gyration: Annotated[Length, NOT_NEGATIVE] = 0.0
    """About the centroid; a thin rod's is its length over the root of 12."""

    def place(self, points: Mapping[str, tuple[float, float]]) -> tuple[float, float]:
        """Return where the body's centroid is.

        Parameters
        ----------
        points : mapping of str to tuple of float
            The link's points in its frame [mm].

        Returns
        -------
        tuple of float
            Centroid in the link's frame [mm].
        """
        return points[self.at] if self.centroid is None else self.centroid


def _kind(stated: Any) -> str:
    keys = stated if isinstance(stated, dict) else vars(stated) if isinstance(stated, CaseModel) else ()
    return "spread" if "start" in keys or "end" in keys else "body"


Carried = Annotated[Annotated[CarriedSpread, Tag("spread")] | Annotated[CarriedBody, Tag("body")], Discriminator(_kind)]
