"""How wide the holes of pins between layers may be: what a case states, and radii of discs by what is open.

Heads on a pin keep a link between them from tilting, too. A plate of thickness t that tilts by θ between two discs of
diameter D takes up D sin θ + t cos θ of the t + g between them: to first order |θ| <= g/D. That is one more disc, of
the difference of the pin's places at both rims of the hole, with the radius t g/D.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.pins.holes import Hole, known_hole, rims_of, shortest
from alula.fea.pins.programme import NO_TIES
from alula.geometry.joints.holes import HolePlay
from alula.loads.case.case import Case
from alula.loads.case.forks import eye_of, in_holes
from alula.loads.case.layers import joints_of_pin, on_one_axis

Real = NDArray[np.float64]
HoleName = tuple[str, str]
"""Joint and link."""

LOOSE = 0.1
"""Clearance over the pin's diameter up to which a hole is tried of which nothing is stated. From there on forces hardly
depend on it: measured on a four-bar of PLA and of aluminium, 0.1 and 0.02 of the diameter."""


@dataclass(frozen=True, kw_only=True)
class HoleClearance:
    """What the diametral clearance of one or two holes may be.

    Attributes
    ----------
    holes : tuple of (str, str)
        Joint and link of each; two share one clearance in a way that nothing states.
    low, value, high : float
        Of the hole, or of both together [mm].
    stated : bool
        Whether the joint says something of it.
    """

    holes: tuple[HoleName, ...]
    low: float
    value: float
    high: float
    stated: bool = True


TIGHT = HoleClearance(holes=(), low=0.0, value=0.0, high=0.0)


def clearances_of(case: Case, frame: LinkageFrame) -> tuple[HoleClearance, ...]:
    """Return the clearances of all holes between layers in which pins may run.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        Of its linkage.

    Returns
    -------
    tuple of HoleClearance
        Those of slots too, without guides and holes that hold their pin tightly. Where nothing tells how a pin sits in
        a hole, it may be pressed and as loose as ``LOOSE``; the value is a running fit, and a pressed pin in a link,
        such as the ground, whose thickness nothing tells.
    """
    linkage, found = frame.pose.linkage, []
    for name in frame.pin_beams:
        joint = linkage.joints[name]
        if not joint.kind.has_pin or name in frame.bonded:
            continue
        sits = linkage.pin_holes(name)
        if sits.shared is not None:
            low, high = sits.shared
            every = tuple((name, hole.link) for hole in sits.holes)
            found.append(HoleClearance(holes=every, low=low, value=(low + high) / 2.0, high=high))
            continue
        for hole in sits.holes:
            own = ((name, hole.link),)
            if hole.stated:
                found.append(HoleClearance(holes=own, low=hole.low, value=hole.nominal, high=hole.high))
            else:
                value = hole.nominal if known_hole(case, name, hole.link) else 0.0
                most = max(LOOSE * pin_size(case, name), hole.high if math.isfinite(hole.high) else 0.0)
                found.append(HoleClearance(holes=own, low=0.0, value=value, high=most, stated=False))
    return tuple(one for one in found if one.high > 0.0)


def pin_size(case: Case, joint: str) -> float:
    """Return the diameter of a pin; where none is stated, that of a pin as thick as the shortest hole is long.

    Parameters
    ----------
    case : Case
    joint : str

    Returns
    -------
    float
        [mm]
    """
    return case.joints[joint].pin_diameter or shortest(case)


def loose_holes(case: Case, joint: str) -> tuple[tuple[tuple[str, float], ...], ...]:
    """Return the holes in which the play of a joint's pin may lie.

    Parameters
    ----------
    case : Case
    joint : str

    Returns
    -------
    tuple of tuple of (str, float)
        Links with the largest play in their hole [mm]. Of those in one tuple any may have all of it, where nothing
        states in which link the pin is tight; holes in different ones have theirs beside each other. Where nothing is
        stated of a hole between layers, by no joint of its pin, the pin runs.
    """
    sits = case.linkage.pin_holes(joint)
    if sits.shared is not None:
        found = [tuple((hole.link, sits.shared[1]) for hole in sits.holes)]
    else:
        stands = in_holes(case, joint)
        holes = [_as_stated(case, joint, hole) for hole in sits.holes] if stands else sits.holes
        told = [hole for hole in holes if hole.stated or (stands and known_hole(case, joint, hole.link))]
        found = [((hole.link, hole.high),) for hole in told if math.isfinite(hole.high)]
    return tuple(kept for each in found if (kept := tuple(hole for hole in each if hole[1] > 0.0)))


def _as_stated(case: Case, joint: str, hole: HolePlay) -> HolePlay:
    """Return a joint's hole as the joint states it or, where it says nothing, another joint of its pin."""
    linkage, point = case.linkage, case.linkage.point_of(joint, hole.link)
    same = (name for name in linkage.joints_at(hole.link, point) if linkage.joints[name].pivots)
    every = [hole, *(linkage.pin_holes(name)[hole.link] for name in same)]
    return next((one for one in every if one.stated), hole)


def gap_over_diameter(case: Case, joint: str, link: str) -> tuple[float, float] | None:
    """Return by how much a joint's link may tilt on its pin between heads.

    The gaps of all joints of a pin add up, and the smallest face counts: a stack of links that tilt alike may use all
    of the gap, each of them; if they tilt apart they use it up sooner, which is left out.

    Parameters
    ----------
    case : Case
    joint, link : str

    Returns
    -------
    tuple of 2 float or None
        Least and largest [rad]; None where the pin has no heads that hold it, as in a slot.
    """
    if link == case.joints[joint].slotted:
        return None
    every = [case.joints[name].heads for name in joints_of_pin(case, joint) if case.joints[name].pivots]
    stated = [heads for heads in every if heads is not None]
    if not stated or len(stated) < len(every):
        return None
    eye = eye_of(case, joint, link).diameter if case.links[link].part is not None else 0.0
    diameter = min([heads.diameter for heads in stated] + ([eye] if eye > 0.0 else []))
    low, high = (math.fsum(ends) for ends in zip(*(heads.gap_ends for heads in stated), strict=True))
    return low / diameter, high / diameter


def apart_at_rims(case: Case, joint: str, link: str, play: float) -> float:
    """Return how far a pin's places at both rims of a hole may be apart, across it.

    Parameters
    ----------
    case : Case
    joint, link : str
    play : float
        Of the hole [mm].

    Returns
    -------
    float
        [mm]; the play, or less where heads hold the link.
    """
    tilt = gap_over_diameter(case, joint, link)
    if tilt is None:
        return play
    low, high = rims_of(case, joint, link)
    return min(play, (high - low) * tilt[1])


@dataclass(frozen=True, kw_only=True)
class HeadGap:
    """What the gap between the heads of a pin may be.

    Attributes
    ----------
    numbers : tuple of int
        Of the holes of its links, among all.
    low, high : tuple of float
        How far the pin's places at the rims of each may be apart, at the least gap and at the largest [mm].
    """

    numbers: tuple[int, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]


def head_gaps(case: Case, holes: Sequence[Hole]) -> tuple[HeadGap, ...]:
    """Return the gaps between heads of all pins.

    Parameters
    ----------
    case : Case
    holes : sequence of Hole
        In which pins may run.

    Returns
    -------
    tuple of HeadGap
        Of pins with heads.
    """
    found = []
    for names in on_one_axis(case):
        own = [(n, hole) for n, hole in enumerate(holes) if not set(names).isdisjoint(hole.joints)]
        tilts = [(n, h.high - h.low, gap_over_diameter(case, h.joints[0], h.link)) for n, h in own]
        ends = [(n, length * tilt[0], length * tilt[1]) for n, length, tilt in tilts if tilt is not None]
        if ends:
            numbers, low, high = zip(*ends, strict=True)
            found.append(HeadGap(numbers=numbers, low=low, high=high))
    return tuple(found)


@dataclass(frozen=True, kw_only=True, eq=False)
class Radii:
    """The radii of discs in h holes, of which heads hold f, by k shares, each from 0 to 1.

    Attributes
    ----------
    numbers : tuple of tuple of int
        Of each hole of each clearance, its number among the h holes.
    count : int
        h
    clearances : tuple of HoleClearance
    heads : tuple of HeadGap
    """

    numbers: tuple[tuple[int, ...], ...]
    count: int
    clearances: tuple[HoleClearance, ...]
    heads: tuple[HeadGap, ...] = ()

    @property
    def ties(self) -> NDArray[np.int64]:
        """(f, 2) numbers of the rims of each hole that heads hold."""
        held = [number for one in self.heads for number in one.numbers]
        return np.array([(2 * number, 2 * number + 1) for number in held], dtype=np.int64) if held else NO_TIES

    @property
    def value(self) -> Real:
        """(k,) the shares of the values; of a clearance that two holes share, half of it in each."""
        found = []
        for one in self.clearances:
            found += [(one.value - one.low) / (one.high - one.low)] if one.high > one.low else []
            found += [0.5] if len(one.holes) == 2 else []
        return np.array([*found, *(0.5 for one in self.heads if one.high > one.low)])

    @property
    def largest(self) -> Real:
        """(1, 2 h + f) what no disc's radius exceeds: of a clearance that two holes share, all of it in each [mm]."""
        radii = np.zeros(self.count)
        for one, numbers in zip(self.clearances, self.numbers, strict=True):
            radii[list(numbers)] = one.high / 2.0
        apart = [size for head in self.heads for size in head.high]
        return np.concatenate([np.repeat(radii, 2), apart])[None]

    def of(self, shares: Real) -> tuple[Real, Real]:
        """Return the radii of the discs, and how they change with shares.

        Parameters
        ----------
        shares : ndarray, shape (n, k)

        Returns
        -------
        tuple of ndarray
            Radii of both rims of every hole, then of how far the pin's places at them may be apart (n, 2 h + f) [mm],
            and their slopes (n, k, 2 h + f).
        """
        n, k = shares.shape
        radii, slope, at = np.zeros((n, self.count)), np.zeros((n, k, self.count)), 0
        for one, numbers in zip(self.clearances, self.numbers, strict=True):
            size, wide = np.full(n, one.value / 2.0), (one.high - one.low) / 2.0
            parts = [np.ones(n)]
            if wide > 0.0:
                size, of_size, at = one.low / 2.0 + wide * shares[:, at], at, at + 1
            if len(numbers) == 2:
                parts = [shares[:, at], 1.0 - shares[:, at]]
                for number, sign in zip(numbers, (1.0, -1.0), strict=True):
                    slope[:, at, number] = sign * size
                at += 1
            for number, part in zip(numbers, parts, strict=True):
                radii[:, number] = size * part
                if wide > 0.0:
                    slope[:, of_size, number] = wide * part
        apart, of_apart = [np.zeros((n, 0))], [np.zeros((n, k, 0))]
        for head in self.heads:
            least, more = np.array(head.low), np.array(head.high) - head.low
            of_apart.append(np.zeros((n, k, len(least))))
            if head.high > head.low:
                apart.append(least + shares[:, at, None] * more)
                of_apart[-1][:, at] = more
                at += 1
            else:
                apart.append(np.tile(least, (n, 1)))
        return (
            np.hstack([np.repeat(radii, 2, axis=1), *apart]),
            np.concatenate([np.repeat(slope, 2, axis=2), *of_apart], axis=2),
        )


def radii_of(
    clearances: Sequence[HoleClearance], order: Sequence[Sequence[HoleName]], heads: tuple[HeadGap, ...] = ()
) -> Radii:
    """Return the radii of holes by what is open of their clearances.

    Parameters
    ----------
    clearances : sequence of HoleClearance
    order : sequence of sequence of (str, str)
        The names of every hole: where several joints have one pin, it has several.
    heads : tuple of HeadGap, optional

    Returns
    -------
    Radii
        A hole of several names has the clearance that is stated of it alone, else what two holes share, else what is
        open where nothing is stated. Of a shared clearance, what a hole that is known leaves is that of the other.
    """
    number = {name: k for k, names in enumerate(order) for name in names}
    known, kept = dict[int, HoleClearance](), dict[int, tuple[HoleClearance, tuple[int, ...]]]()
    for k in sorted(range(len(clearances)), key=lambda k: (not clearances[k].stated, len(clearances[k].holes))):
        one = clearances[k]
        left = tuple(hole for hole in one.holes if hole in number and number[hole] not in known)
        if len(left) == 1 and len(one.holes) == 2:
            [other] = set(one.holes) - set(left)
            one = _beside(one, left, known[number[other]] if other in number else TIGHT)
        if left:
            own = tuple(number[hole] for hole in left)
            known |= dict.fromkeys(own, one if len(own) == 1 else replace(one, low=0.0, value=one.value / 2.0))
            kept[k] = one, own
    found = [kept[k] for k in sorted(kept)]
    return Radii(
        numbers=tuple(own for _, own in found),
        count=len(order),
        clearances=tuple(one for one, _ in found),
        heads=heads,
    )


def _beside(one: HoleClearance, left: tuple[HoleName, ...], other: HoleClearance) -> HoleClearance:
    """Return what a clearance that two holes share leaves of it for one of them."""
    low, high = max(one.low - other.high, 0.0), max(one.high - other.low, 0.0)
    return replace(one, holes=left, low=low, value=min(max(one.value - other.value, low), high), high=high)


def furthest(forces: Real, apart: Real) -> Real:
    """Return how far holes let a point move, by the forces at their rims that a unit force there makes.

    Parameters
    ----------
    forces : ndarray, shape (..., 2, 2)
        At both rims, times c/2.
    apart : ndarray, shape (...)
        How far a pin's places at both rims may be apart, over c/2.

    Returns
    -------
    ndarray, shape (...)
    """
    each = np.linalg.norm(forces, axis=-1)
    both = np.linalg.norm(forces.sum(axis=-2), axis=-1)
    return np.asarray(np.minimum(each.sum(axis=-1), both + apart * each.min(axis=-1)))
