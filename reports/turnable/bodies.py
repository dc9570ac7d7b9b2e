"""Links as bodies that a browser can draw: flat pieces between two heights, and round rods."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.body import Body
from alula.geometry.clearance.shape import Core, link_shape
from alula.geometry.parts.lugs import without_lugs
from alula.geometry.parts.tube import Tube

Real = NDArray[np.float64]

_CHORD = 4e-3
"""How far a chord may lie off an arc, over the least width of the piece."""
_GRID = 1.0 / 60_000.0
"""Step to which corners are rounded, over the size of a link: below that of 16 bits."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Slab:
    """What a link covers between two heights, and the faces that are seen of it.

    Attributes
    ----------
    low, high : float
        z of the assembly [mm].
    area : geometry
        Polygons in the link's frame [mm].
    below, above : geometry
        Those of its lower and upper side on which no other slab lies.
    """

    low: float
    high: float
    area: Any
    below: Any
    above: Any


@dataclass(frozen=True, kw_only=True)
class Rod:
    """A straight round piece in the mid-plane of its link.

    Attributes
    ----------
    start : tuple of float
        (x, y) where its axis begins, in the link's frame [mm].
    angle : float
        Direction of its axis [rad].
    length, radius : float
        [mm]
    bore : float
        Radius of the bore that is open at its ends [mm]; 0 where it is closed there.
    """

    start: tuple[float, float]
    angle: float
    length: float
    radius: float
    bore: float


@dataclass(frozen=True, kw_only=True, eq=False)
class PlateBody:
    """The material of a link about one mid-plane.

    Attributes
    ----------
    plane : float
        Its z [mm].
    slabs : tuple of Slab
        From the lowest up.
    rods : tuple of Rod
    """

    plane: float
    slabs: tuple[Slab, ...]
    rods: tuple[Rod, ...]

    @property
    def low(self) -> float:
        """Its least z [mm]."""
        return min([s.low for s in self.slabs] + [self.plane - rod.radius for rod in self.rods])

    @property
    def high(self) -> float:
        """Its greatest z [mm]."""
        return max([s.high for s in self.slabs] + [self.plane + rod.radius for rod in self.rods])


def plate_body(body: Body, plane: float) -> PlateBody:
    """Return what is drawn of a link about one mid-plane.

    Holes for pins and rows of holes along them are cut out. A tube is round between its eyes; one with a fork is as
    wide at every height as at its middle, as outlines are.

    Parameters
    ----------
    body : Body
    plane : float
        z [mm]

    Returns
    -------
    PlateBody
    """
    rods = _rods(body)
    cores = link_shape("", body, [plane], without=len(rods)).cores
    return PlateBody(plane=plane, slabs=tuple(_slabs(body, cores)), rods=rods)


def _rods(body: Body) -> tuple[Rod, ...]:
    """Return the round pieces of a tube, which are the first of its footprints."""
    part = body.part
    if not isinstance(part, Tube) or any(pin.fork is not None for pin in body.pins):
        return ()
    bore = part.inner_diameter / 2.0 if part.eyes == "none" and part.plug_length == 0.0 else 0.0
    return tuple(
        Rod(start=p.start, angle=p.angle, length=p.length, radius=part.outer_diameter / 2.0, bore=bore)
        for p in part.pieces(without_lugs(body))
    )


def _slabs(body: Body, cores: Sequence[Core]) -> Iterator[Slab]:
    """Yield the slabs between all heights at which something of a link begins or ends."""
    import shapely

    if not cores:
        return
    boxes = np.array([core.polygon.bounds for core in cores])
    size = float((boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)).max())
    grid = size * _GRID
    pieces = [(core, _plain(core, grid)) for core in cores]
    cut = _holes(body, grid)
    levels = _levels([z for core in cores for z in (core.low, core.high)], grid)
    areas = []
    for low, high in itertools.pairwise(levels):
        middle = (low + high) / 2.0
        here = [polygon for core, polygon in pieces if core.low < middle < core.high]
        whole = _faces(shapely.union_all(here, grid_size=grid), grid)
        areas.append(_faces(shapely.difference(whole, cut, grid_size=grid), grid))
    nothing = shapely.MultiPolygon()
    around = [nothing, *areas, nothing]
    for k, (low, high) in enumerate(itertools.pairwise(levels)):
        if not areas[k].is_empty:
            others = (around[k], around[k + 2])
            below, above = (_faces(shapely.difference(areas[k], o, grid_size=grid), grid) for o in others)
            yield Slab(low=low, high=high, area=areas[k], below=below, above=above)


def _plain(core: Core, grid: float) -> Any:
    """Return a piece with as few corners as show its arcs."""
    x0, y0, x1, y1 = core.polygon.bounds
    return core.polygon.simplify(max(_CHORD * min(x1 - x0, y1 - y0), grid))


def _levels(heights: Sequence[float], grid: float) -> list[float]:
    """Return heights by size, those once that differ by less than can be seen."""
    found: list[float] = []
    for z in sorted(heights):
        if not found or z - found[-1] > grid:
            found.append(z)
    return found


def _holes(body: Body, grid: float) -> Any:
    """Return what pins, slots and rows of holes along the pins cut out."""
    import shapely

    found = []
    for pin in body.pins:
        line = shapely.LineString([(x, pin.y) for x in pin.span]) if pin.slot else shapely.Point(pin.x, pin.y)
        found.append(line.buffer(pin.diameter / 2.0, quad_segs=8))
    for row in body.holes:
        if row.along == "z":
            found += [shapely.Point(x, 0.0).buffer(row.diameter / 2.0, quad_segs=6) for x in row.positions]
    return shapely.union_all(found, grid_size=grid)


def _faces(found: Any, grid: float) -> Any:
    """Return the polygons of what an operation gave, without lines and slivers that rounding leaves."""
    import shapely

    parts = [p for p in shapely.get_parts(found) if p.geom_type == "Polygon" and p.area > 2.0 * grid * p.length]
    return shapely.MultiPolygon(parts)
