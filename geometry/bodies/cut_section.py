"""A section that is cut through a solid across the x axis of its link: of any shape, with its own principal axes."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from alula.geometry.bodies.section import Section, rectangle, ring

Place = tuple[float, float]

ALIKE = 1e-3
"""Share by which area and second moments may differ from those of a rectangle, a rod or a tube that a section is taken
for: the coarseness of a curve's chords."""


@dataclass(frozen=True, kw_only=True)
class CutSection:
    """A section of a solid normal to x.

    Attributes
    ----------
    x : float
        Where it is cut [mm].
    area : float
        Its area [mm²].
    centre : tuple of float
        (y, z) of its centroid [mm].
    i_y, i_z, i_yz : float
        ∫z² dA, ∫y² dA and ∫yz dA about axes through the centroid [mm⁴].
    hull : tuple of (float, float)
        Corners (y, z) of the convex hull of its outline, counter-clockwise: one of them is farthest in any direction
        [mm].
    pieces : int
        Number of separate ones that it consists of.
    """

    x: float
    area: float
    centre: Place
    i_y: float
    i_z: float
    i_yz: float
    hull: tuple[Place, ...]
    pieces: int = 1

    @property
    def low(self) -> Place:
        """Least y and z [mm]."""
        return min(y for y, _ in self.hull), min(z for _, z in self.hull)

    @property
    def high(self) -> Place:
        """Greatest y and z [mm]."""
        return max(y for y, _ in self.hull), max(z for _, z in self.hull)

    @property
    def width(self) -> float:
        """Size along y [mm]."""
        return self.high[0] - self.low[0]

    @property
    def height(self) -> float:
        """Size along z [mm]."""
        return self.high[1] - self.low[1]

    @property
    def principal(self) -> tuple[float, float]:
        """Least and greatest second moment of area about axes through the centroid [mm⁴].

        (I_y + I_z)/2 ± √(((I_y - I_z)/2)² + I_yz²) (Timoshenko, Strength of Materials I, appendix A).
        """
        mean, half = (self.i_y + self.i_z) / 2.0, math.hypot((self.i_y - self.i_z) / 2.0, self.i_yz)
        return mean - half, mean + half

    @property
    def free(self) -> tuple[float, float]:
        """What resists M_y and M_z where it may bend across them as well: I_y - I_yz²/I_z and I_z - I_yz²/I_y [mm⁴]."""
        return self.i_y - self.i_yz**2 / self.i_z, self.i_z - self.i_yz**2 / self.i_y

    @property
    def torsion(self) -> float:
        """Torsion constant [mm⁴]: exact of a rectangle, rod or tube, else A⁴/(40 I_p), which is Saint-Venant's."""
        plain = self.plain
        return self.area**4 / (40.0 * (self.i_y + self.i_z)) if plain is None else plain.torsion

    @cached_property
    def plain(self) -> Section | None:
        """The rectangle along y and z, the rod or the tube that it is; None of any other shape.

        A rectangle fills its bounds. A tube has the diameters D² + d² = 16 I/A and D² - d² = 4 A/π, and ends there.
        """
        wide, high = self.width, self.height
        if abs(wide * high / self.area - 1.0) < ALIKE:
            return rectangle(_even(wide), _even(high))
        second = (self.i_y + self.i_z) / 2.0
        total, less = 16.0 * second / self.area, 4.0 * self.area / math.pi
        outer = math.sqrt((total + less) / 2.0)
        alike = max(abs(self.i_y - second), abs(self.i_z - second), abs(self.i_yz)) < ALIKE * second
        if not alike or max(abs(wide - outer), abs(high - outer)) > ALIKE * outer or total < (1.0 - ALIKE) * less:
            return None
        inner = math.sqrt(max(total - less, 0.0) / 2.0)
        return ring(_even(outer), _even(inner) if inner > ALIKE * outer else 0.0)


def _even(size: float) -> float:
    """Return a size without the kernel's rounding, so that equal sections are equal."""
    return float(f"{size:.9g}")


def joined(parts: Sequence[CutSection]) -> CutSection:
    """Return pieces of one plane as one section, by the parallel-axis theorem.

    Parameters
    ----------
    parts : sequence of CutSection
        At least one.

    Returns
    -------
    CutSection
        The section.
    """
    area = sum(part.area for part in parts)
    y, z = (sum(part.area * part.centre[k] for part in parts) / area for k in (0, 1))
    off = [(part, part.centre[0] - y, part.centre[1] - z) for part in parts]
    return CutSection(
        x=parts[0].x,
        area=area,
        centre=(y, z),
        i_y=sum(part.i_y + part.area * dz**2 for part, _, dz in off),
        i_z=sum(part.i_z + part.area * dy**2 for part, dy, _ in off),
        i_yz=sum(part.i_yz + part.area * dy * dz for part, dy, dz in off),
        hull=convex(place for part in parts for place in part.hull),
        pieces=sum(part.pieces for part in parts),
    )


def convex(places: Iterable[Place]) -> tuple[Place, ...]:
    """Return the corners of the convex hull of places.

    Parameters
    ----------
    places : iterable of (float, float)
        Three or more that lie not on one line.

    Returns
    -------
    tuple of (float, float)
        Counter-clockwise, from the least.

    References
    ----------
    Andrew, Information Processing Letters 9 (1979) 216-219 (monotone chain).
    """
    ordered = sorted(set(places))

    def chain(way: Iterable[Place]) -> list[Place]:
        found: list[Place] = []
        for y, z in way:
            while len(found) > 1:
                (y0, z0), (y1, z1) = found[-2:]
                if (y1 - y0) * (z - z0) - (z1 - z0) * (y - y0) > 0.0:
                    break
                found.pop()
            found.append((y, z))
        return found

    return (*chain(ordered)[:-1], *chain(reversed(ordered))[:-1])
