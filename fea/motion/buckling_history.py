"""Buckling factor of a link at every pose of a motion, by the rules of ``alula.fea.buckling.buckling``."""

import itertools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.column_factor import AxialForce
from alula.fea.beam.cut_free import beam_loads
from alula.fea.buckling.buckling import NO_COMPRESSION, ColumnFactors, link_factors
from alula.fea.common.link_loads import LinkLoads
from alula.fea.links.second_order import second_order_loads
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR
from alula.fea.tractions.mass_force import amounts, unit_forces
from alula.geometry.bodies.body import no_beam
from alula.loads.case.case import Case
from alula.loads.records.applied import LineLoad

Real = NDArray[np.float64]


def factors_over_motion(case: Case, link: str, history: LinkLoads) -> ColumnFactors:
    """Return the buckling factors of a link at every pose; infinite where nothing compresses it.

    Parameters
    ----------
    case : Case
    link : str
    history : LinkLoads
        At the P poses of a motion.

    Returns
    -------
    ColumnFactors
    """
    largest, force = axial_compression(case, link, history)
    pressed = ~(largest <= 0.0)
    found = link_factors(case, link, replace(force, values=force.values[..., pressed]))

    def everywhere(factor: Real) -> Real:
        every = np.full(len(pressed), np.inf)
        every[pressed] = factor
        return every

    return ColumnFactors(value=everywhere(found.value), least=everywhere(found.least), most=everywhere(found.most))


def with_second_order(case: Case, link: str, history: LinkLoads, evaluated: NDArray[np.bool_]) -> LinkLoads:
    """Return a history with what bending under compression adds, at the evaluated poses near to buckling.

    As ``alula.fea.links.second_order.second_order_loads`` does for one pose with ``stays=False``. What it adds at poses
    further from buckling is in the bands (``alula.fea.motion.loosened.motion_growth``).

    Parameters
    ----------
    case : Case
    link : str
    history : LinkLoads
        At the P poses of a motion.
    evaluated : ndarray of bool, shape (P,)
        The poses that count.

    Returns
    -------
    LinkLoads
        At the same poses.
    """
    found = factors_over_motion(case, link, history)
    near = np.flatnonzero(evaluated & (np.minimum(found.value, found.least) < LEAST_FACTOR))
    if not near.size:
        return history
    wrenches = [wrench.copy() for _, wrench in history.wrenches]
    lines: dict[tuple[float, float], Real] = {}
    for pose in near.tolist():
        loads = history.chosen(pose)
        grown = second_order_loads(case, link, loads, stays=False)
        for own, (_, wrench) in zip(wrenches, grown.wrenches, strict=True):
            own[pose] = wrench
        for line in grown.lines[len(loads.lines) :]:
            ends_of_line = lines.setdefault((line.start, line.end), np.zeros((2, history.poses, 3)))
            ends_of_line[:, pose] += line.at_start, line.at_end
    more = [LineLoad(link=link, start=a, end=b, at_start=q[0], at_end=q[1], axes="link") for (a, b), q in lines.items()]
    return replace(history.with_wrenches(wrenches), lines=(*history.lines, *more))


def axial_compression(case: Case, link: str, history: LinkLoads) -> tuple[Real, AxialForce]:
    """Return the largest compression along a link at every pose, and the compression at every station.

    With point loads F at stations and line loads q between them, the compression at x is ΣF + ∫q dx over all that acts
    before x. In each interval it is a parabola, given by its values at both ends and in the middle. Compression within
    rounding of the forces on the link counts as none.

    Parameters
    ----------
    case : Case
    link : str
    history : LinkLoads
        At the P poses of a motion.

    Returns
    -------
    tuple of (ndarray, shape (P,), AxialForce)
        The largest [N], and all of it; none where no beam stands for the link.
    """
    if no_beam(case.body(link)):
        none = np.zeros(history.poses)
        return none, AxialForce(breaks=np.array([0.0, 1.0]), values=np.zeros((1, 3, history.poses)))
    points, lines = _axial_loads(case, link, history)
    breaks = sorted({x for x, _ in points} | {x for line in lines for x in line[:2]})
    poses = history.poses
    size = np.max([np.linalg.norm(wrench[:, :3], axis=1) for _, wrench in history.wrenches], axis=0)
    before, largest, values = np.zeros(poses), np.zeros(poses), []
    for start, end in itertools.pairwise(breaks):
        before = before + sum((force for x, force in points if x == start), np.zeros(poses))
        middle, at_end = (before + _spread(lines, start, x, poses) for x in ((start + end) / 2.0, end))
        here = np.max([before, middle, at_end, _vertex(before, middle, at_end)], axis=0)
        largest = np.maximum(largest, here)
        values.append([before, middle, at_end])
        before = at_end
        size = np.maximum(size, np.abs([before, middle]).max(axis=0))
    largest = np.where(largest <= NO_COMPRESSION * size, 0.0, largest)
    return largest, AxialForce(breaks=np.array(breaks), values=np.array(values))


Line = tuple[float, float, Real, Real]


def _axial_loads(case: Case, link: str, history: LinkLoads) -> tuple[list[tuple[float, Real]], list[Line]]:
    """Forces along the axis (x, (P,)) and line loads (first x, last x, (P,) there and there); as ``cut_free`` does."""
    body, material = case.body(link), case.material_of(link)
    points = [
        (pin.x if pin.foot is None else pin.foot[0], load.wrench[:, 0])
        for pin, load in zip(body.pins, history.pins, strict=True)
        if not pin.slot  # a pin in a slot pushes across it alone
    ]
    points += [(float(end.point[0]), end.wrench[:, 0]) for end in history.ends]
    lines = [(line.start, line.end, line.at_start[:, 0], line.at_end[:, 0]) for line in history.lines]
    if history.inertia is None:
        return points, lines
    own = history.inertia
    for unit, times in zip(unit_forces(own.mass), amounts(own), strict=True):
        # A unit of each of what moves mass, spread over the beam as for one pose.
        acting = beam_loads(LinkLoads(name=history.name, inertia=unit), body, material.density)
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
