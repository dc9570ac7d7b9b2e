"""What makes a plate lighter: round holes through it, and pockets that leave a floor."""

import itertools
import math
from collections.abc import Callable
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.base.outline import Outline, outline
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel

LEAST_FLOOR = 0.05
"""Least floor of a pocket over the plate's thickness. Assumed: a thinner one is hardly made."""


class RoundHole(CaseModel):
    """A round hole through a plate that no pin stands in."""

    x: Length
    """Of its centre, in the link's frame."""
    y: Length
    """y of its centre."""
    diameter: Annotated[Length, POSITIVE]
    """Its diameter."""

    @property
    def outline(self) -> Outline:
        """Its circle."""
        return outline([(self.x, self.y, self.diameter / 2.0)])

    def scaled(self, s: Callable[[float], float]) -> Self:
        """Return the hole with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        Self
            The hole.
        """
        return self.model_copy(update={"x": s(self.x), "y": s(self.y), "diameter": s(self.diameter)})


class Pocket(CaseModel):
    """A recess of even depth, whose outline is the convex hull of equal circles about one or more centres.

    One centre makes a round pocket, two a long one, four a rounded rectangle.
    """

    centres: Annotated[tuple[tuple[Length, Length], ...], Field(min_length=1, max_length=20)]
    """Of its rounded corners, in the link's frame."""
    radius: Annotated[Length, POSITIVE]
    """Of its corners, in the plane of the plate."""
    depth: Annotated[Length, POSITIVE]
    """From each face that it is cut into."""
    side: Literal["top", "bottom", "both"] = "top"
    """Faces that it is cut into: top, at positive z, bottom, or both, one pocket above the other."""
    floor_radius: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Fillet between its floor and its walls; 0 leaves the edge sharp, where stress has no finite peak."""

    @property
    def outline(self) -> Outline:
        """The hull of its corners' circles."""
        return outline([(x, y, self.radius) for x, y in self.centres])

    @property
    def cut(self) -> float:
        """How much of the plate's thickness it takes [mm]."""
        return self.depth * (2.0 if self.side == "both" else 1.0)

    def check(self, name: str, thickness: float) -> None:
        """Refuse a pocket that leaves no floor, or whose floor has no room for its fillet.

        Parameters
        ----------
        name : str
            Entry, for the message.
        thickness : float
            Thickness of the plate [mm].

        Raises
        ------
        CaseError
            With the rule and a remedy.
        """
        if thickness - self.cut < LEAST_FLOOR * thickness:
            most = (1.0 - LEAST_FLOOR) * thickness * self.depth / self.cut
            raise CaseError(
                f"{name}.depth {self.depth:.4g} mm leaves a floor of {max(thickness - self.cut, 0.0):.4g} mm, but must "
                f"leave {LEAST_FLOOR:g} of the plate's thickness: set it to {most:.4g} mm or less, or state a hole"
            )
        if self.floor_radius > self.depth or self.floor_radius >= self.radius:
            raise CaseError(
                f"{name}.floor_radius {self.floor_radius:.4g} mm does not fit: it must be at most the depth "
                f"{self.depth:.4g} mm and less than the radius {self.radius:.4g} mm; reduce it"
            )

    def solids(self, kernel: Kernel, thickness: float) -> list[Entity]:
        """Build what it takes out of a plate.

        Parameters
        ----------
        kernel : Kernel
            The geometry kernel, in whose unit the pocket is.
        thickness : float
            Thickness of the plate.

        Returns
        -------
        list of Entity
            Solids that stand out of the plate's faces.
        """
        found = []
        for side in {"top": (1.0,), "bottom": (-1.0,), "both": (1.0, -1.0)}[self.side]:
            floor, height = side * (thickness / 2.0 - self.depth), 2.0 * self.depth
            present = _curves_at(kernel, floor)
            solid = kernel.slab(self.outline, height)
            kernel.occ.translate([solid], 0.0, 0.0, floor + side * height / 2.0)
            if self.floor_radius > 0.0:
                solid = kernel.fillet(solid, sorted(_curves_at(kernel, floor) - present), self.floor_radius)
            found.append(solid)
        return found

    def distance_formula(self, thickness: float) -> str:
        """Return the distance from the edge of its floor as a formula of the mesher in x, y and z.

        Parameters
        ----------
        thickness : float
            Thickness of the plate, in the pocket's unit.

        Returns
        -------
        str
            The formula; it also vanishes along the corners' centre lines at the radius inwards.
        """
        corners = [(arc.x, arc.y) for arc in self.outline.arcs]
        sides = list(itertools.pairwise([*corners, corners[0]])) if len(corners) > 1 else [(corners[0], corners[0])]
        parts = [_from_segment(a, b) for a, b in sides]
        within = parts[0]
        for part in parts[1:]:
            within = f"Min({within},{part})"
        high = thickness / 2.0 - self.depth + self.floor_radius
        along = f"Sqrt(({within}-{self.radius - self.floor_radius:.12g})^2+(Fabs(z)-{high:.12g})^2)"
        return f"Fabs({along}-{self.floor_radius:.12g})"

    def scaled(self, s: Callable[[float], float]) -> Self:
        """Return the pocket with its lengths in another unit.

        Parameters
        ----------
        s : callable
            Takes a length to that unit.

        Returns
        -------
        Self
            The pocket.
        """
        sizes = {name: s(getattr(self, name)) for name in ("radius", "depth", "floor_radius")}
        return self.model_copy(update={**sizes, "centres": tuple((s(x), s(y)) for x, y in self.centres)})


def _curves_at(kernel: Kernel, height: float) -> set[int]:
    """Return the curves of the model that lie at a height."""

    def at_height(p: NDArray[np.float64]) -> bool:
        return bool(abs(p[2] - height) < ON_SURFACE)

    return set(kernel.curves(at_height))


def _from_segment(a: tuple[float, float], b: tuple[float, float]) -> str:
    """Return the distance from a straight line from end to end as a formula in x and y."""
    (x, y), dx, dy = a, b[0] - a[0], b[1] - a[1]
    px, py = f"(x-({x:.12g}))", f"(y-({y:.12g}))"
    square = math.hypot(dx, dy) ** 2
    if square == 0.0:
        return f"Sqrt({px}^2+{py}^2)"
    at = f"Max(0,Min(1,({px}*({dx / square:.12g})+{py}*({dy / square:.12g}))))"
    return f"Sqrt(({px}-({dx:.12g})*{at})^2+({py}-({dy:.12g})*{at})^2)"
