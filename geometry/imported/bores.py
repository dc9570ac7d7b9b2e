"""Bores of a solid: round holes, forks and slots, told from bosses and fillets.

Runs in the kernel's child process only.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from alula.geometry.imported.columns import Columns
from alula.geometry.imported.facts import Bore, PartSurface, Vector
from alula.geometry.imported.walls import HALF_TURN, NEAR, Line, Real, Span, Wall, upwards

_BEYOND = 0.02
"""Share of the radius beyond a wall or its end at which material is looked for; chords of the wall are 0.005 off."""
_AXIS = 0.05
"""Share of the radius at which lines stand for the axis, on which corners of triangles would be."""


def find_bores(walls: list[Wall], surface: PartSurface, box: Real) -> tuple[Bore, ...]:
    """Return the bores of a solid.

    A bore is a cylindrical wall, more than half way round empty space that is open, and not narrower at both ends as a
    groove or the bottom of a thread is. Walls of one cylinder with nothing but space between them are one bore, as in a
    fork. Two halves of equal cylinders, open towards each other, are a slot.

    Parameters
    ----------
    walls : list of Wall
        Its cylindrical walls; those of one cylinder have the same ``line``.
    surface : PartSurface
        Triangles of its surface.
    box : array
        Least and greatest coordinates (2, 3) [mm].

    Returns
    -------
    tuple of Bore
        In the order of their names.
    """
    hollow = [wall for wall in walls if wall.hollow]
    outside = [wall for wall in walls if not wall.hollow and wall.round]
    found = [*_round_bores(surface, hollow), *_slots(surface, hollow)]
    order = in_order([(bore.centre, bore.diameter) for bore in found], box)
    return tuple(
        replace(found[i], name=f"bore {k}", around=_is_around(found[i], outside)) for k, i in enumerate(order, start=1)
    )


def _round_bores(surface: PartSurface, hollow: list[Wall]) -> Iterator[Bore]:
    """Yield bores whose walls are round, or more than half way round."""
    walls = sorted((wall for wall in hollow if wall.holds), key=lambda wall: wall.span)
    while walls:
        together = [walls.pop(0)]
        line, radius = together[0].line, together[0].radius
        columns = Columns(surface, line, 1.2 * radius)
        for wall in tuple(walls):
            between = together[-1].span[1], wall.span[0]
            if wall.line is line and wall.radius == radius and _free(columns, radius, between):
                together.append(wall)
                walls.remove(wall)
        spans = [wall.span for wall in together]
        ends = _is_open(columns, radius, spans[0][0], -1.0), _is_open(columns, radius, spans[-1][1], 1.0)
        if any(ends) and not _is_groove(columns, radius, spans) and all(_free(columns, radius, s) for s in spans):
            share = min(1.0 if wall.round else wall.turn / math.tau for wall in together)
            yield replace(_bore(line, radius, spans, through=all(ends)), share=share)


def _bore(line: Line, radius: float, spans: list[Span], *, through: bool) -> Bore:
    low, high = spans[0][0], spans[-1][1]
    middle = (low + high) / 2.0
    return Bore(
        name="",
        axis=_vector(line.axis),
        centre=_vector(line.at(middle)),
        diameter=2.0 * radius,
        length=high - low,
        through=through,
        spans=tuple((start - middle, end - middle) for start, end in spans),
        slot=0.0,
        slot_axis=(0.0, 0.0, 0.0),
    )


def _free(columns: Columns, radius: float, span: Span) -> bool:
    """Return True if there is no material within nine tenths of a radius, between two places."""
    places = np.linspace(*span, 41)[1:-1]
    lines = [*columns.ring(_AXIS * radius), *columns.ring(0.9 * radius)]
    return not any(columns.material(at, places).any() for at in lines)


def _is_open(columns: Columns, radius: float, end: float, way: float) -> bool:
    """Return True if a hole does not end in the material.

    Looking out along its axis, one sees no material, or the hole has widened on at least half of its rim before.
    """
    start = end + way * _BEYOND * radius
    depth = min(columns.first_material(at, start, way) for at in columns.ring(_AXIS * radius))
    if math.isinf(depth):
        return True
    places = start + way * np.linspace(0.0, min(depth, 2.0 * radius), 41)[:-1]
    rim = np.sum([columns.material(at, places) for at in columns.ring((1.0 + 2.0 * _BEYOND) * radius)], axis=0)
    return depth > 0.0 and bool((rim <= 4).any())


def _is_groove(columns: Columns, radius: float, spans: list[Span]) -> bool:
    """Return True if a hole is narrower beyond both of its ends."""
    ends = np.array([spans[0][0] - _BEYOND * radius, spans[-1][1] + _BEYOND * radius])
    return bool(np.all([columns.material(at, ends) for at in columns.ring((1.0 - _BEYOND) * radius)]))


def _slots(surface: PartSurface, hollow: list[Wall]) -> Iterator[Bore]:
    """Yield the slots between half-cylinders."""
    halves = [wall for wall in hollow if len(wall.arcs) == 1 and abs(wall.turn - math.pi) < HALF_TURN]
    for one, other in combinations(halves, 2):
        line, radius = one.line, one.radius
        shift = float(line.along(other.line.point))
        span = max(one.span[0], other.span[0] + shift), min(one.span[1], other.span[1] + shift)
        if abs(radius - other.radius) > NEAR * radius or not line.parallel(other.line) or span[1] <= span[0]:
            continue
        arm = other.line.point - line.point - shift * line.axis
        distance = float(np.linalg.norm(arm))
        if (
            distance < NEAR * radius
            or _outwards(one) @ arm > -0.999 * distance
            or _outwards(other) @ arm < 0.999 * distance
        ):
            continue
        between = Line(point=line.point + arm / 2.0, axis=line.axis)
        columns = Columns(surface, between, distance / 2.0 + 1.2 * radius)
        if _has_sides(columns, np.cross(line.axis, arm / distance), arm, radius, span):
            ends = _is_open(columns, radius, span[0], -1.0), _is_open(columns, radius, span[1], 1.0)
            along = upwards(arm)
            yield replace(_bore(between, radius, [span], through=all(ends)), slot=distance, slot_axis=_vector(along))


def _outwards(half: Wall) -> Real:
    """Return the direction (3,) from the axis of a half-cylinder to the middle of its wall."""
    first, second = half.line.across
    middle = half.arcs[0][0] + half.arcs[0][1] / 2.0
    return np.asarray(math.cos(middle) * first + math.sin(middle) * second)


def _has_sides(columns: Columns, across: Real, arm: Real, radius: float, span: Span) -> bool:
    """Return True if a slot is empty between its flanks and has material behind them."""
    middle = np.array([sum(span) / 2.0])
    for share in (-0.4, 0.003, 0.4):
        free, filled = (
            [columns.material(columns.offset(share * arm + side * radius * across), middle)[0] for side in sides]
            for sides in ((-1.0 + _BEYOND, _AXIS, 1.0 - _BEYOND), (-1.0 - _BEYOND, 1.0 + _BEYOND))
        )
        if any(free) or not all(filled):
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


def in_order(places: Sequence[tuple[Vector, float]], box: Real) -> list[int]:
    """Return in which order places are numbered: along the longest side of the part's bounds, then along the others.

    Parameters
    ----------
    places : sequence of (tuple of 3 float, float)
        Centre and size of each; of equal centres the smaller comes first.
    box : array
        Least and greatest coordinates (2, 3) of the part [mm].

    Returns
    -------
    list of int
        Numbers of the places.
    """
    sizes = box[1] - box[0]
    step = 1e-6 * float(sizes.max())
    order = sorted(range(3), key=lambda k: (-round(float(sizes[k]) / step), k))

    def key(number: int) -> tuple[int | float, ...]:
        centre, size = places[number]
        return (*(round(centre[k] / step) for k in order), size)

    return sorted(range(len(places)), key=key)


def _vector(values: Real) -> Vector:
    x, y, z = (float(value) + 0.0 for value in values)
    return x, y, z
