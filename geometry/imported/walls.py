"""Cylindrical faces of a solid, as parts of walls that lie on common cylinders.

Runs in the kernel's child process only.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.facts import PartSurface

Real = NDArray[np.float64]
Span = tuple[float, float]

NEAR = 1e-3
"""Share of the radius within which cylinders are the same, and angle [rad] within which axes are parallel."""
FULL_TURN = math.tau - 0.01
"""Angle [rad] from which on a wall is round."""

HALF_TURN = 0.02
"""How much a slot's round end may differ from half a turn [rad]."""

_OTHER_SHAPES = ("Plane", "Cone", "Sphere", "Torus")
"""Shapes of faces that gmsh names, and that are no cylinders."""
_ALONG, _GRID = 65, 9
"""Points of a face: along a line across it, by whose angles its turn is told, and on each side of a grid."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """An axis in space.

    Attributes
    ----------
    point : array
        (3,) [mm].
    axis : array
        (3,), of unit length; its largest component is positive.
    """

    point: Real
    axis: Real

    def along(self, points: Real) -> Real:
        """Return the places of points along the axis, from the line's own point.

        Parameters
        ----------
        points : array
            (..., 3) [mm].

        Returns
        -------
        array
            [mm].
        """
        return np.asarray((points - self.point) @ self.axis)

    def at(self, place: float) -> Real:
        """Return the point at a place along the axis.

        Parameters
        ----------
        place : float
            [mm].

        Returns
        -------
        array
            (3,) [mm].
        """
        return np.asarray(self.point + place * self.axis)

    @cached_property
    def across(self) -> tuple[Real, Real]:
        """Two unit vectors (3,), normal to the axis and to each other."""
        first = np.cross(self.axis, np.eye(3)[int(np.argmin(np.abs(self.axis)))])
        first /= np.linalg.norm(first)
        return first, np.cross(self.axis, first)

    def same(self, other: "Line", within: float) -> bool:
        """Return True if another line is this one.

        Parameters
        ----------
        other : Line
        within : float
            Distance that does not matter [mm].

        Returns
        -------
        bool
        """
        arm = other.point - self.point
        return self.parallel(other) and float(np.linalg.norm(arm - (arm @ self.axis) * self.axis)) < within

    def parallel(self, other: "Line") -> bool:
        """Return True if another line is parallel to this one.

        Parameters
        ----------
        other : Line

        Returns
        -------
        bool
        """
        return float(np.linalg.norm(np.cross(self.axis, other.axis))) < NEAR


@dataclass(frozen=True, kw_only=True, eq=False)
class Wall:
    """What lies on one cylinder without a gap along its axis.

    Attributes
    ----------
    line : Line
        The axis of the cylinder.
    radius : float
        [mm].
    hollow : bool
        True where the material is outside of the cylinder.
    span : tuple of 2 float
        From where to where along the line [mm].
    arcs : tuple of tuple of 2 float
        Where around the line, from ``line.across[0]``: starts in order, from 0 to 2π, and angles [rad].
    """

    line: Line
    radius: float
    hollow: bool
    span: Span
    arcs: tuple[Span, ...]

    @property
    def turn(self) -> float:
        """Angle that the wall takes around its axis [rad]."""
        return sum(angle for _, angle in self.arcs)

    @property
    def round(self) -> bool:
        """True where the wall goes all the way round."""
        return self.turn > FULL_TURN

    @property
    def holds(self) -> bool:
        """True where the wall goes more than half way round, so that a pin does not leave it sideways."""
        return self.turn > math.pi + HALF_TURN


def walls_of(gmsh: Any, solid: int, surface: PartSurface) -> list[Wall]:
    """Return the cylindrical walls of a solid.

    Faces of one cylinder are one wall, as the two halves into which programs cut a hole, unless there is a gap between
    them along the axis.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : int
        Its tag.
    surface : PartSurface
        Triangles of its surface.

    Returns
    -------
    list of Wall
    """
    faces = [_face(gmsh.model, surface, tag) for tag in gmsh.model.getAdjacencies(3, solid)[1]]
    return joined_walls(filter(None, faces))


def joined_walls(faces: Iterable[Wall]) -> list[Wall]:
    """Return the walls that faces make together.

    Parameters
    ----------
    faces : iterable of Wall
        Each a wall of its own.

    Returns
    -------
    list of Wall
        Those of one cylinder have the same ``line``.
    """
    cylinders: list[list[Wall]] = []
    for face in faces:
        for cylinder in cylinders:
            if _one_cylinder(cylinder[0], face):
                cylinder.append(face)
                break
        else:
            cylinders.append([face])
    return [wall for cylinder in cylinders for wall in _joined(cylinder)]


def _one_cylinder(one: Wall, other: Wall) -> bool:
    near = NEAR * one.radius
    return (
        one.hollow == other.hollow and abs(one.radius - other.radius) < near and one.line.same(other.line, within=near)
    )


def _face(model: Any, surface: PartSurface, tag: int) -> Wall | None:
    """Return a cylindrical face as a wall; None for a face of another shape, or so small that it has no triangle."""
    if not (surface.faces == tag).any():
        return None
    cylinder = _cylinder(model, tag)
    if cylinder is None:
        return None
    line, radius = cylinder
    points = np.concatenate([_points(model, tag, counts) for counts in ((_ALONG, 1), (1, _ALONG))])
    angles = np.unwrap(_angles(line, points).reshape(2, -1))
    turns = angles[:, -1] - angles[:, 0]
    longest = int(np.argmax(np.abs(turns)))
    arc = float(angles[longest].min() % math.tau), min(float(abs(turns[longest])), math.tau)
    places = line.along(np.concatenate([points, _points(model, tag, (2, 2))]))
    hollow = _outwards(surface, tag, line) < 0.0
    return Wall(line=line, radius=radius, hollow=hollow, span=(float(places.min()), float(places.max())), arcs=(arc,))


def _cylinder(model: Any, tag: int) -> tuple[Line, float] | None:
    """Return axis and radius of a face; None where it is no cylinder.

    Some programs write cylinders as splines or as sweeps; there the normals tell the axis, and points the radius.
    """
    kind = model.getType(2, tag)
    if kind == "Cylinder":
        values = np.asarray(model.getEntityProperties(2, tag)[1])
        return Line(point=values[:3], axis=upwards(values[3:6])), float(values[6])
    if kind in _OTHER_SHAPES:
        return None
    points, normals = _points(model, tag, (_GRID, _GRID)), _points(model, tag, (_GRID, _GRID), normals=True)
    _, sizes, directions = np.linalg.svd(normals, full_matrices=False)
    if not sizes[2] < NEAR * sizes[0] < sizes[1]:  # curved twice, or flat
        return None
    middle = points.mean(axis=0)
    line = Line(point=middle, axis=upwards(directions[2]))
    first, second = line.across
    flat = np.column_stack([(points - middle) @ first, (points - middle) @ second])
    a, b, radius = fitted_circle(flat)
    if np.abs(np.hypot(flat[:, 0] - a, flat[:, 1] - b) - radius).max() > NEAR * radius:
        return None
    return Line(point=middle + a * first + b * second, axis=line.axis), radius


def fitted_circle(flat: Real) -> tuple[float, float, float]:
    """Return centre and radius of the circle x² + y² = 2 a x + 2 b y + c through points, by least squares.

    I. Kåsa, IEEE Trans. Instrum. Meas. 25 (1976) 8-14.

    Parameters
    ----------
    flat : array
        (n, 2) [mm].

    Returns
    -------
    tuple of float
        x, y, radius [mm].
    """
    (a, b, c), *_ = np.linalg.lstsq(
        np.column_stack([2.0 * flat, np.ones(len(flat))]), (flat**2).sum(axis=1), rcond=None
    )
    return float(a), float(b), math.sqrt(max(c + a * a + b * b, 0.0))


def _points(model: Any, tag: int, counts: tuple[int, int], *, normals: bool = False) -> Real:
    """Return a grid of points (k, 3) of a face's surface within its bounds, or normals there; its middle for 1."""
    low, high = np.asarray(model.getParametrizationBounds(2, tag))
    shares = [np.linspace(0.0, 1.0, count) if count > 1 else np.array([0.5]) for count in counts]
    places = low + (high - low) * np.stack(np.meshgrid(*shares, indexing="ij"), axis=-1).reshape(-1, 2)
    found = model.getNormal(tag, places.ravel()) if normals else model.getValue(2, tag, places.ravel())
    return np.asarray(found, dtype=np.float64).reshape(-1, 3)


def _outwards(surface: PartSurface, tag: int, line: Line) -> float:
    """Return the sum of the areas of a face's triangles, each times how much its material's outside is off the line."""
    a, b, c = np.moveaxis(surface.points[surface.triangles[surface.faces == tag]], 1, 0)
    arms = (a + b + c) / 3.0 - line.point
    arms -= (arms @ line.axis)[:, None] * line.axis
    return float((np.cross(b - a, c - a) * arms).sum())


def _angles(line: Line, points: Real) -> Real:
    """Return where points (..., 3) stand around a line [rad]."""
    first, second = line.across
    arms = points - line.point
    return np.asarray(np.arctan2(arms @ second, arms @ first) % math.tau)


def upwards(axis: Real) -> Real:
    """Return the unit vector along an axis whose largest component is positive.

    Parameters
    ----------
    axis : array
        (3,).

    Returns
    -------
    array
        (3,).
    """
    axis = axis / np.linalg.norm(axis)
    largest = axis[int(np.argmax(np.abs(axis) > np.abs(axis).max() - NEAR))]
    return np.asarray(np.where(np.abs(axis) < 1e-12, 0.0, axis) * math.copysign(1.0, largest))


def _joined(faces: list[Wall]) -> Iterable[Wall]:
    """Yield the walls that faces of one cylinder make: those without a gap between them along the axis."""
    first = faces[0]
    shifts = [float(first.line.along(face.line.point)) for face in faces]
    turns = [float(_angles(first.line, first.line.point + face.line.across[0])) for face in faces]
    pieces = sorted(
        (
            ((face.span[0] + shift, face.span[1] + shift), [((start + turn) % math.tau, a) for start, a in face.arcs])
            for face, shift, turn in zip(faces, shifts, turns, strict=True)
        ),
        key=lambda piece: piece[0],
    )
    (low, high), arcs = pieces[0]
    for (start, end), more in [*pieces[1:], ((math.inf, math.inf), [])]:
        if start > high + NEAR * first.radius:
            yield Wall(line=first.line, radius=first.radius, hollow=first.hollow, span=(low, high), arcs=united(arcs))
            (low, high), arcs = (start, end), []
        high = max(high, end)
        arcs = [*arcs, *more]


def united(arcs: Iterable[Span]) -> tuple[Span, ...]:
    """Return arcs without overlaps, in the order of their starts.

    Parameters
    ----------
    arcs : iterable of tuple of 2 float
        Starts, from 0 to 2π, and angles [rad].

    Returns
    -------
    tuple of tuple of 2 float
        Starts and angles [rad].
    """
    found: list[Span] = []
    for start, angle in sorted(arcs):
        if found and start <= sum(found[-1]) + NEAR:
            found[-1] = found[-1][0], max(sum(found[-1]), start + angle) - found[-1][0]
        else:
            found.append((start, angle))
    if len(found) > 1 and sum(found[-1]) >= found[0][0] + math.tau - NEAR:  # the last one goes on in the first
        start, angle = found.pop()
        found[0] = start, max(start + angle, sum(found[0]) + math.tau) - start
    return tuple((start, min(angle, math.tau)) for start, angle in found)
