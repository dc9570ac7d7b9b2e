"""Bores of a solid: round holes, forks and slots, told from bosses and fillets.

Runs in the kernel's child process only.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from geometry.imported.facts import Bore, Vector
from geometry.imported.walls import NEAR, Line, Real, Span, Wall, walls_of

_HALF_TURN = 0.02
"""How much a slot's round end may differ from half a turn [rad]."""
_BEYOND = 0.02, 1.35
"""Share of the radius beyond a hole's end at which it is first looked for material, and the ratio of further places."""


def find_bores(gmsh: Any, solid: int) -> tuple[Bore, ...]:
    """Return the bores of a solid.

    A bore is a cylindrical wall around empty space that is not narrower at both ends, as a groove is. Walls of one
    cylinder with nothing but space between them are one bore, as in a fork. Two halves of equal cylinders, open towards
    each other, are a slot.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : int
        Its tag.

    Returns
    -------
    tuple of Bore
        In the order of their names.
    """
    space = _Space(gmsh, solid)
    walls = walls_of(gmsh, solid)
    hollow = [wall for wall in walls if wall.hollow]
    outside = [wall for wall in walls if not wall.hollow and wall.round]
    found = [*_round_bores(space, hollow), *_slots(space, hollow)]
    return _named([replace(bore, around=_is_around(bore, outside)) for bore in found], space.box)


class _Space:
    """Where the material of a solid is."""

    def __init__(self, gmsh: Any, solid: int) -> None:
        self._model, self._solid = gmsh.model, solid
        self.box = np.asarray(self._model.getBoundingBox(3, solid)).reshape(2, 3)
        self.size = float(np.linalg.norm(self.box[1] - self.box[0]))

    def material(self, point: Real) -> bool:
        """Return True if the material is at a point (3,)."""
        if (point < self.box[0]).any() or (point > self.box[1]).any():
            return False
        return bool(self._model.isInside(3, self._solid, list(point)))

    def ring(self, line: Line, place: float, radius: float) -> Iterator[bool]:
        """Yield at eight points around a line whether material is there."""
        first, second = line.across()
        for angle in math.tau * np.arange(8) / 8.0 + 0.1:
            yield self.material(line.at(place) + radius * (math.cos(angle) * first + math.sin(angle) * second))

    def free(self, line: Line, radius: float, span: Span) -> bool:
        """Return True if there is no material within nine tenths of a radius of a line, between two places."""
        places = [span[0] + share * (span[1] - span[0]) for share in (0.02, 0.25, 0.5, 0.75, 0.98)]
        return not any(self.material(line.at(x)) or any(self.ring(line, x, 0.9 * radius)) for x in places)


def _round_bores(space: _Space, hollow: list[Wall]) -> Iterator[Bore]:
    """Yield bores with round walls."""
    walls = sorted((wall for wall in hollow if wall.round), key=lambda wall: wall.span)
    while walls:
        together = [walls.pop(0)]
        for wall in tuple(walls):
            last = together[-1]
            if (
                wall.line is last.line
                and wall.radius == last.radius
                and space.free(last.line, last.radius, (last.span[1], wall.span[0]))
            ):
                together.append(wall)
                walls.remove(wall)
        line, radius, spans = together[0].line, together[0].radius, [wall.span for wall in together]
        ends = spans[0][0] - _BEYOND[0] * radius, spans[-1][1] + _BEYOND[0] * radius
        if not all(all(space.ring(line, end, (1.0 - _BEYOND[0]) * radius)) for end in ends):  # else it is a groove
            yield _bore(space, line, radius, spans)


def _bore(space: _Space, line: Line, radius: float, spans: list[Span]) -> Bore:
    low, high = spans[0][0], spans[-1][1]
    middle = (low + high) / 2.0
    return Bore(
        name="",
        axis=_vector(line.axis),
        centre=_vector(line.at(middle)),
        diameter=2.0 * radius,
        length=high - low,
        through=_open(space, line, radius, low, -1.0) and _open(space, line, radius, high, 1.0),
        spans=tuple((start - middle, end - middle) for start, end in spans),
        slot=0.0,
        slot_axis=(0.0, 0.0, 0.0),
    )


def _open(space: _Space, line: Line, radius: float, end: float, way: float) -> bool:
    """Return True if a hole does not end in the material.

    Looking out along its axis, one sees no material, or the hole has widened on at least half of its rim before.
    """
    beyond = _BEYOND[0] * radius
    while beyond < 2.0 * space.size:
        place = end + way * beyond
        if space.material(line.at(place)):
            return False
        if beyond < 2.0 * radius and sum(space.ring(line, place, 1.02 * radius + 0.02 * beyond)) <= 4:
            return True
        beyond *= _BEYOND[1]
    return True


def _slots(space: _Space, hollow: list[Wall]) -> Iterator[Bore]:
    """Yield the slots between half-cylinders."""
    halves = [wall for wall in hollow if len(wall.arcs) == 1 and abs(wall.turn - math.pi) < _HALF_TURN]
    for one, other in combinations(halves, 2):
        line, radius = one.line, one.radius
        shift = float(line.along(other.line.point))
        span = max(one.span[0], other.span[0] + shift), min(one.span[1], other.span[1] + shift)
        if abs(radius - other.radius) > NEAR * radius or not line.parallel(other.line) or span[1] <= span[0]:
            continue
        arm = other.line.point - line.point - shift * line.axis
        distance = float(np.linalg.norm(arm))
        if distance < NEAR * radius:
            continue
        along = arm / distance
        first, second = line.across()
        first_other, second_other = other.line.across()
        a, b = (wall.arcs[0][0] + wall.arcs[0][1] / 2.0 for wall in (one, other))
        outwards = math.cos(a) * first + math.sin(a) * second, math.cos(b) * first_other + math.sin(b) * second_other
        if outwards[0] @ along > -0.999 or outwards[1] @ along < 0.999:
            continue
        between = Line(point=line.point + arm / 2.0, axis=line.axis)
        if _has_sides(space, between, np.cross(line.axis, along), along, distance, radius, span):
            bore = _bore(space, between, radius, [span])
            yield replace(bore, slot=distance, slot_axis=_vector(along))


def _has_sides(
    space: _Space, between: Line, across: Real, along: Real, distance: float, radius: float, span: Span
) -> bool:
    """Return True if a slot is empty between its flanks and has material behind them."""
    middle = between.at((span[0] + span[1]) / 2.0)
    for share in (-0.4, 0.0, 0.4):
        place = middle + share * distance * along
        if any(space.material(place + side * 0.98 * radius * across) for side in (-1.0, 0.0, 1.0)):
            return False
        if not all(space.material(place + side * 1.02 * radius * across) for side in (-1.0, 1.0)):
            return False
    return True


def _is_around(bore: Bore, outside: list[Wall]) -> bool:
    """Return True if the part's outside is round about the axis of a bore over half of its length or more."""
    line = Line(point=np.array(bore.centre), axis=np.array(bore.axis))
    together = 0.0
    for wall in outside:
        if wall.line.same(line, within=NEAR * wall.radius):
            low, high = (wall.line.along(line.at(side * bore.length / 2.0)) for side in (-1.0, 1.0))
            together += max(0.0, min(wall.span[1], float(high)) - max(wall.span[0], float(low)))
    return together >= 0.5 * bore.length


def _named(bores: list[Bore], box: Real) -> tuple[Bore, ...]:
    """Return bores with names: along the longest side of the part's bounds, then along the next, then the last."""
    sizes = box[1] - box[0]
    step = 1e-6 * float(sizes.max())
    order = sorted(range(3), key=lambda k: (-round(float(sizes[k]) / step), k))

    def place(bore: Bore) -> tuple[int | float, ...]:
        return (*(round(bore.centre[k] / step) for k in order), bore.diameter)

    return tuple(replace(bore, name=f"bore {k}") for k, bore in enumerate(sorted(bores, key=place), start=1))


def _vector(values: Real) -> Vector:
    x, y, z = (float(value) + 0.0 for value in values)
    return x, y, z
