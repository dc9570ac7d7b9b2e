"""Bending that grows with compression: second-order theory of one link, brought into the loads that act on it.

On a link that bends by v, a compression P has a moment as well. It equals that of a transverse load -(P v')' on the
straight link. The deflection v is that under all loads, this one included: E I v'''' + (P v')' = q. It is solved with
cubic elements, as the buckling factor is (``alula.fea.beam.column_factor``). With that load added, hand calculation,
frame and solid bear the second-order moments, each with its own stress concentrations. Tension straightens a link and
is left out; so is compression that adds less than ``NEGLIGIBLE``.

References
----------
Timoshenko & Gere, Theory of Elastic Stability, 2nd ed., section 1.2.
"""

import itertools
import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.column_factor import GAUSS, MERGED, Stretch, slopes, stiffness_matrices
from alula.fea.beam.cut_beam import curving_forces
from alula.fea.beam.piecewise import Piecewise, Side
from alula.fea.beam.theory import internal_forces
from alula.fea.buckling.holding import columns, holding
from alula.fea.common.link_loads import LinkLoads, stacked
from alula.fea.links.on_axis import on_axis
from alula.geometry.bodies.body import no_beam
from alula.loads.case.case import Case
from alula.loads.records.applied import LineLoad, shifted

Real = NDArray[np.float64]

ELEMENTS = 6
"""Along a link, at least; two at least between neighbouring stations."""
NEGLIGIBLE = 0.01
"""Growth of bending below which it is left out: compression over the load that buckles the link."""


@dataclass(frozen=True, kw_only=True)
class Bend:
    """How a link bends in one plane.

    Attributes
    ----------
    stiffness : float
        E I [N mm²].
    stretches : sequence of Stretch
        Softer ones, as shares of the same E I.
    """

    stiffness: float
    stretches: Sequence[Stretch] = ()


def second_order_loads(case: Case, link: str, loads: LinkLoads, *, stays: bool) -> LinkLoads:
    """Return the loads of a link with what its bending under compression adds.

    Parameters
    ----------
    case : Case
    link : str
    loads : LinkLoads
        At one pose.
    stays : bool
        True where all loaded places stay where they are, as on the deformed shape of a frame. Else the outermost pins
        stay; a link held by the drive or one bonded joint keeps its place and angle there, and its other joints move.

    Returns
    -------
    LinkLoads
    """
    body, material = case.body(link), case.material_of(link)
    if no_beam(body):
        return loads
    forces = curving_forces(internal_forces(on_axis(loads, body, material.density)), body.cuts)
    young = material.youngs_modulus
    planes = [Bend(stiffness=young * inertia, stretches=soft) for inertia, soft in columns(body, free=True)]
    on_arms = {pin.name for pin in body.pins if pin.foot is not None}
    if stays:
        return between_stations(loads, forces, planes[0], planes[1], on_arms)
    where = holding(case, link)
    held = where.alone if len(where.alone) == 1 else where.outermost
    return on_its_pins(loads, forces, planes[0], planes[1], held, on_arms)


def on_tilting_pins(case: Case, link: str, states: Sequence[LinkLoads]) -> tuple[LinkLoads, ...]:
    """Return the loads of a link between layers with its bending out of the plane, free to turn on its outermost pins.

    Pins that tilt keep no angle, as those of the spatial frame do. In the plane the frame tells how bending grows.

    Parameters
    ----------
    case : Case
    link : str
    states : sequence of LinkLoads
        At one pose each.

    Returns
    -------
    tuple of LinkLoads
        Unchanged where compression is negligible or buckles the link.
    """
    body, material = case.body(link), case.material_of(link)
    if no_beam(body):
        return tuple(states)
    inertia, soft = columns(body, free=True)[1]
    across = Bend(stiffness=material.youngs_modulus * inertia, stretches=soft)
    on_arms = {pin.name for pin in body.pins if pin.foot is not None}
    held, found = holding(case, link).outermost, list(states)
    for alike, loads in stacked(states):
        marks = _marks(loads, on_arms)
        if len(marks) > 1 and {*held} <= {*marks}:
            forces = curving_forces(internal_forces(on_axis(loads, body, material.density)), body.cuts)
            share = _shares(*_system(forces, across, _nodes(marks, _ends(soft)), held)[:3])
            for k in np.flatnonzero((share >= NEGLIGIBLE) & (share < 1.0)).tolist():
                found[alike[k]] = on_its_pins(states[alike[k]], forces.state(k), None, across, held, on_arms)
    return tuple(found)


def between_stations(
    loads: LinkLoads, forces: Piecewise, in_plane: Bend, across: Bend, on_arms: Collection[str] = ()
) -> LinkLoads:
    """Return the loads of a link whose pins and loaded ends stay where they are, with its bending between them.

    This is for a link on the deformed shape of its frame: the movement of these places is in the frame's moments.

    Parameters
    ----------
    loads : LinkLoads
        At one pose.
    forces : Piecewise
        Internal forces of these loads.
    in_plane, across : Bend
        Bending in the linkage's plane, and out of it.
    on_arms : collection of str
        Pins that are not on the axis.

    Returns
    -------
    LinkLoads
        Unchanged between places where compression buckles the link.
    """
    found, stations = loads, _stations(loads, on_arms)
    for a, b in itertools.pairwise(stations):
        found = _bowed(found, forces, (in_plane, across), [a, b], (a, b))
    return found


def on_its_pins(
    loads: LinkLoads,
    forces: Piecewise,
    in_plane: Bend | None,
    across: Bend,
    held: Sequence[float],
    on_arms: Collection[str] = (),
) -> LinkLoads:
    """Return the loads of a link with its bending, where the places ``held`` stay.

    A single place is held in its angle too: the other joints of a driven link move, and the drive takes the moment that
    their forces get by that.

    Parameters
    ----------
    loads, forces, in_plane, across, on_arms
        As for ``between_stations``; without ``in_plane`` it bends out of the plane alone.
    held : sequence of float
        Stations along the axis [mm].

    Returns
    -------
    LinkLoads
        Unchanged where compression buckles the link, and where a held place is no pin or loaded end on the axis.
    """
    stations = _marks(loads, on_arms)
    return _bowed(loads, forces, (in_plane, across), stations, held) if {*held} <= {*stations} else loads


def _marks(loads: LinkLoads, on_arms: Collection[str]) -> list[float]:
    """Stations of pins that stay at their place, and of loaded ends, on the axis."""
    return _stations(loads, {*on_arms, *(pin.name for pin in loads.pins if pin.slotted)})


def _stations(loads: LinkLoads, on_arms: Collection[str]) -> list[float]:
    pins = {float(pin.place[0]) for pin in loads.pins if pin.name not in on_arms}
    return sorted(pins | {float(end.point[0]) for end in loads.ends})


def _bowed(
    loads: LinkLoads, forces: Piecewise, planes: tuple[Bend | None, Bend], marks: Sequence[float], held: Sequence[float]
) -> LinkLoads:
    if len(marks) < 2:
        return loads
    bends = {axis: bend for axis, bend in enumerate(planes, start=1) if bend is not None}
    nodes = _nodes(marks, _ends([stretch for bend in bends.values() for stretch in bend.stretches]))
    intensity, point, left = np.zeros((len(nodes) - 1, 2, 3)), np.zeros((len(marks), 3)), np.zeros(3)
    for axis, bend in bends.items():
        found = _transverse(forces, bend, _MOMENT[axis], nodes, marks, held)
        if found is None:
            return loads
        intensity[:, :, axis], point[:, axis], left[axis] = found
    if not (intensity.any() or point.any() or left.any()):
        return loads
    extra = {x: np.concatenate([force, np.zeros(3)]) for x, force in zip(marks, point, strict=True)}
    first, last = min(held), max(held)
    if first < last:
        extra[first][:3] += left / (last - first)
        extra[last][:3] -= left / (last - first)
    else:
        extra[first][4:] += left[2], -left[1]

    def at(place: Real) -> Real:
        """What acts on the axis beside a pin or a loaded end, about its own place."""
        return shifted(extra.pop(float(place[0]), np.zeros(6)), -place * [0.0, 1.0, 1.0])

    pins = [replace(pin, wrench=pin.wrench + at(pin.centre)) for pin in loads.pins]
    rest = [replace(end, wrench=end.wrench + at(end.point)) for end in loads.ends]
    lines = [
        LineLoad(link=loads.link, start=float(a), end=float(b), at_start=q[0], at_end=q[1], axes="link")
        for a, b, q in zip(nodes[:-1], nodes[1:], intensity, strict=True)
        if np.any(q != 0.0)
    ]
    return replace(loads, pins=tuple(pins), ends=tuple(rest), lines=(*loads.lines, *lines))


_MOMENT: dict[int, Callable[[Real], float]] = {1: lambda f: float(f[5]), 2: lambda f: -float(f[4])}
"""E I times the curvature of v and of w."""


def _ends(stretches: Sequence[Stretch]) -> list[float]:
    return [x for stretch in stretches for x in (stretch.first, stretch.last)]


def _nodes(marks: Sequence[float], others: Sequence[float]) -> Real:
    first, last = marks[0], marks[-1]
    breaks = sorted({*marks, *(x for x in others if all(abs(x - mark) > MERGED * (last - first) for mark in marks))})
    breaks = [x for x in breaks if first <= x <= last]
    found = [first]
    for a, b in itertools.pairwise(breaks):
        found += list(np.linspace(a, b, max(2, math.ceil(ELEMENTS * (b - a) / (last - first))) + 1)[1:])
    return np.array(found)


def _transverse(
    forces: Piecewise,
    bend: Bend,
    moment: Callable[[Real], float],
    nodes: Real,
    marks: Sequence[float],
    held: Sequence[float],
) -> tuple[Real, Real, float] | None:
    """Return -(P v')' between nodes (n - 1, 2) [N/mm] and at marks (m,) [N], and the moment that is left over [N mm].

    None where the compression P buckles the link.
    """
    points, weights = GAUSS
    length = float(nodes[-1] - nodes[0])
    K, every, free, at, across = _system(forces, bend, nodes, held)
    share, G, pressed = float(_shares(K, every, free)[0]), every[0], across[0]
    if share >= 1.0:
        return None
    cells, at_marks = np.zeros((len(nodes) - 1, 2)), np.zeros(len(marks))
    if share < NEGLIGIBLE:
        return cells, at_marks, 0.0
    inner, load = forces.along(at), np.zeros(len(K))
    for e, h in enumerate(np.diff(nodes) / length):
        bending = np.array([moment(f) for f in inner[e]])
        load[2 * e : 2 * e + 4] += (weights * h * bending) @ _curvatures(h, points)
    v = np.zeros(len(K))
    v[free] = np.linalg.solve((K - G)[np.ix_(free, free)], load[free])
    total = 0.0

    def thrust(node: int, side: Side) -> float:
        """P v' at a node [N]."""
        return max(-float(forces.at(float(nodes[node]), side)[0]), 0.0) * float(v[2 * node + 1]) / length

    numbers = {int(np.argmin(np.abs(nodes - x))): i for i, x in enumerate(marks)}
    for e, h in enumerate(np.diff(nodes)):
        # A jump of P at a node that is no mark goes with the load before it.
        end = thrust(e + 1, "before" if e + 1 in numbers else "after")
        force = thrust(e, "after") - end
        turning = float((weights * h * pressed[e]) @ slopes(h / length, points) @ v[2 * e : 2 * e + 4]) / length
        first = turning - h * end
        cells[e] = 4.0 * force / h - 6.0 * first / h**2, 6.0 * first / h**2 - 2.0 * force / h
        total += turning
    for node, i in numbers.items():
        at_marks[i] = (thrust(node, "before") if i else 0.0) - (thrust(node, "after") if i < len(marks) - 1 else 0.0)
    return cells, at_marks, total


def _system(
    forces: Piecewise, bend: Bend, nodes: Real, held: Sequence[float]
) -> tuple[Real, Real, NDArray[np.int64], Real, Real]:
    """Return the bending stiffness K (k, k), what compression takes of it G (n, k, k), and its free unknowns.

    Then stations (e, 4) of each element's Gauss points [mm], and the compression (n, e, 4) there [N].
    """
    length = float(nodes[-1] - nodes[0])
    at = nodes[:-1, None] + np.diff(nodes)[:, None] * GAUSS[0]
    pressed = np.maximum(-forces.along(at)[..., 0], 0.0).reshape(-1, *at.shape)
    K, G = stiffness_matrices(nodes, np.moveaxis(pressed, 0, -1), bend.stretches)
    fixed = [2 * int(np.argmin(np.abs(nodes - x))) for x in held]
    fixed += [fixed[0] + 1] if len(held) == 1 else []
    return K * bend.stiffness / length**2, G, np.setdiff1d(np.arange(len(K)), fixed), at, pressed


def _shares(K: Real, G: Real, free: NDArray[np.int64]) -> Real:
    """Compression over that which buckles the link, in every state (n,)."""
    inverse = np.linalg.inv(np.linalg.cholesky(K[np.ix_(free, free)]))
    return np.asarray(np.linalg.eigvalsh(inverse @ G[:, free[:, None], free] @ inverse.T)[:, -1])


def _curvatures(h: float, t: Real) -> Real:
    """V'' (n, 4) of the shape functions of a cubic element of length h at shares t (n,) of it."""
    return np.stack(
        [(12.0 * t - 6.0) / h**2, (6.0 * t - 4.0) / h, (6.0 - 12.0 * t) / h**2, (6.0 * t - 2.0) / h], axis=1
    )
