"""Euler's factor of a link at every pose of a motion: the rules of ``fea.buckling_check``, for all poses at once."""

import itertools

import numpy as np
from numpy.typing import NDArray

from fea.beam import euler_load
from fea.buckling_check import NO_COMPRESSION, held, outermost_pins
from fea.cut_free import beam_loads
from fea.link_history import LinkHistory
from fea.link_loads import BodyLoad, LinkLoads
from geometry.body_rules import hand_section
from loads.case import Case

Real = NDArray[np.float64]


def buckling_factors(
    case: Case, link: str, compression: Real, beyond: NDArray[np.bool_], span: tuple[float, float]
) -> tuple[Real, Real]:
    """Return Euler's load over a link's compression (P,), infinite where nothing compresses it, and that load (P,) [N].

    compression  (P,) largest compression along the link [N]; NaN where it is not known, and so are the factors
    beyond       (P,) whether the link is compressed beyond its outermost pins, so that it is no pinned column there
    span         first and last x of what acts on the link [mm]
    """
    section, young = hand_section(case.body(link)), case.material_of(link).youngs_modulus
    inertia = min(section.i_y, section.i_z)
    load = np.empty(len(compression))
    for outside in (False, True):
        length, effective, _ = held(case, link, span, beyond=outside)
        load[beyond == outside] = euler_load(young, inertia, length, effective)
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.where(compression > 0.0, load / compression, np.inf)
    return np.where(np.isnan(compression), np.nan, factor), load


def factors_over_motion(case: Case, link: str, history: LinkHistory) -> Real:
    """Return Euler's load over a link's largest compression at every pose (P,); infinite where nothing compresses it.

    Multiply by the least ratio of modulus for the lower end, and divide that by ``fea.buckling_check.LEAST_LINEAR``
    for the band that ``alula check`` gives.
    """
    compression, beyond, span = axial_compression(case, link, history)
    return buckling_factors(case, link, compression, beyond, span)[0]


def axial_compression(
    case: Case, link: str, history: LinkHistory
) -> tuple[Real, NDArray[np.bool_], tuple[float, float]]:
    """Return the largest compression (P,) [N] along a link, where it is beyond its outermost pins (P,), and its span.

    With point loads F at stations and line loads q between them the compression at x is ΣF + ∫q dx over all that acts
    before x: in each interval of degree 2, by its values at both ends and in the middle. Compression that is rounding
    beside the forces on the link counts as none.
    """
    points, lines = _axial_loads(case, link, history)
    first, last = (pin[0] for pin in outermost_pins(case, link))
    stations = {x for x, _ in points} | {x for line in lines for x in line[:2]}
    breaks = sorted(stations | {x for x in (first, last) if min(stations) < x < max(stations)})
    poses = history.poses
    size = np.max([np.linalg.norm(load[:, :2], axis=1) for load in (*history.pins.values(), *history.ends.values())], 0)
    slack = 1e-9 * (breaks[-1] - breaks[0])
    before, largest, outside = np.zeros(poses), np.zeros(poses), np.zeros(poses)
    for start, end in itertools.pairwise(breaks):
        before = before + sum((force for x, force in points if x == start), np.zeros(poses))
        middle, at_end = (before + _spread(lines, start, x, poses) for x in ((start + end) / 2.0, end))
        here = np.max([before, middle, at_end, _vertex(before, middle, at_end)], axis=0)
        largest = np.maximum(largest, here)
        if end <= first + slack or start >= last - slack:
            outside = np.maximum(outside, here)
        before = at_end
        size = np.maximum(size, np.abs([before, middle]).max(axis=0))
    rounding = NO_COMPRESSION * size
    largest = np.where(largest <= rounding, 0.0, largest)
    return largest, outside > rounding, (breaks[0], breaks[-1])


Line = tuple[float, float, Real, Real]


def _axial_loads(case: Case, link: str, history: LinkHistory) -> tuple[list[tuple[float, Real]], list[Line]]:
    """Forces along the axis (x, (P,)) and line loads (first x, last x, (P,) there and there); as ``cut_free`` does."""
    body = history.body
    points = [
        (pin.x if pin.foot is None else pin.foot[0], history.pins[pin.name][:, 0])
        for pin in body.pins
        if not pin.slot  # a pin in a slot pushes across it alone
    ]
    points += [(end.x, history.ends[end.name][:, 0]) for end in body.ends if end.name in history.ends]
    lines = [(line.first, line.last, line.intensity[:, 0, 0], line.intensity[:, 1, 0]) for line in history.lines]
    density = case.material_of(link).density
    for i, unit in enumerate(np.eye(4)):
        # A unit of each of what moves mass, spread over the beam as for one pose.
        body_load = BodyLoad(
            specific_force=np.array([unit[0], unit[1], 0.0]),
            about=np.zeros(3),
            angular_acceleration=float(unit[2]),
            angular_speed=float(unit[3]),
        )
        alone = LinkLoads(name=history.load_case, pins=(), bodies=(body_load,))
        acting = beam_loads(alone, body, density, history.mass)
        times = history.acceleration[:, i]
        points += [(float(p.point[0]), p.wrench[0] * times) for p in acting.points]
        lines += [(line.start, line.end, line.first[0] * times, line.last[0] * times) for line in acting.lines]
    return points, lines


def _spread(lines: list[Line], start: float, end: float, poses: int) -> Real:
    """Force (P,) of all line loads between two stations within one interval [N]."""
    total = np.zeros(poses)
    for first, last, q1, q2 in lines:
        if first <= start and end <= last:
            middle = ((start + end) / 2.0 - first) / (last - first)
            total = total + (end - start) * (q1 + (q2 - q1) * middle)
    return total


def _vertex(a: Real, b: Real, c: Real) -> Real:
    """Extreme value within the interval of the parabola with these values at its start, middle and end; else ``a``."""
    slope, bend = (c - a) / 2.0, a - 2.0 * b + c
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -slope / bend
        value = b - slope**2 / (2.0 * bend)
    return np.asarray(np.where((np.abs(t) < 1.0) & np.isfinite(value), value, a))
