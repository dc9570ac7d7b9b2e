"""How the bores of a part lie to each other: on one axis, parallel, and as the points of a link."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.facts import Bore, PartFacts, PartSurface

Real = NDArray[np.float64]

PARALLEL = math.radians(0.1)
"""Angle between the axes of two bores up to which they are parallel."""
COAXIAL = 1e-3
"""Distance of the axes of two bores, as a share of the smaller diameter, up to which they are one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkFrame:
    """A frame in which parallel bores are the points of a link: z along the bores, x from the first to the second.

    Attributes
    ----------
    origin : array
        Centre (3,) of the first bore, in the file's frame [mm].
    axes : array
        Directions x, y, z as rows (3, 3).
    bores : dict of str to Bore
        Point -> its bore; the first two are those farthest apart.
    """

    origin: Real
    axes: Real
    bores: dict[str, Bore]

    def place(self, point: Real) -> Real:
        """Return where points of the file lie in this frame.

        Parameters
        ----------
        point : array
            (..., 3) [mm].

        Returns
        -------
        array
            (..., 3) [mm].
        """
        return np.asarray((point - self.origin) @ self.axes.T)

    @property
    def points(self) -> dict[str, tuple[float, float]]:
        """Point -> (x, y) of the middle of its bore [mm]."""
        found = {name: self.place(np.array(bore.centre)) for name, bore in self.bores.items()}
        return {name: (round(float(at[0]), 6) + 0.0, round(float(at[1]), 6) + 0.0) for name, at in found.items()}

    @property
    def slots(self) -> dict[str, tuple[float, float]]:
        """Point of a slot -> x of the centres of its round ends [mm]."""
        halves = {name: bore.slot / 2.0 for name, bore in self.bores.items() if bore.slot}
        return {name: (self.points[name][0] - half, self.points[name][0] + half) for name, half in halves.items()}


def angle_between(one: Bore, other: Bore) -> float:
    """Return the angle between the axes of two bores.

    Parameters
    ----------
    one, other : Bore
        The bores.

    Returns
    -------
    float
        From 0 to π/2 [rad].
    """
    across = float(np.linalg.norm(np.cross(one.axis, other.axis)))
    return math.atan2(across, abs(float(np.dot(one.axis, other.axis))))


def distance_between(one: Bore, other: Bore) -> float:
    """Return how far apart two bores are, across the axis of the first one.

    Parameters
    ----------
    one, other : Bore
        The bores.

    Returns
    -------
    float
        [mm].
    """
    return float(np.linalg.norm(np.cross(np.subtract(other.centre, one.centre), one.axis)))


def coaxial(one: Bore, other: Bore) -> bool:
    """Return True if two bores lie on one axis.

    Parameters
    ----------
    one, other : Bore
        The bores.

    Returns
    -------
    bool
    """
    near = COAXIAL * min(one.diameter, other.diameter)
    return angle_between(one, other) <= PARALLEL and distance_between(one, other) <= near


def parallel_groups(bores: Sequence[Bore]) -> list[list[Bore]]:
    """Return groups of parallel bores.

    Parameters
    ----------
    bores : sequence of Bore
        Of one part.

    Returns
    -------
    list of list of Bore
        First the group with the most axes.
    """
    groups: list[list[Bore]] = []
    for bore in bores:
        group = next((group for group in groups if angle_between(group[0], bore) <= PARALLEL), None)
        if group is None:
            groups.append([bore])
        else:
            group.append(bore)
    return sorted(groups, key=lambda group: -len(_one_for_each_axis(group)))


def link_frame(bores: Sequence[Bore]) -> LinkFrame | None:
    """Return the frame of the link that a part may be.

    Its points are the bores of the largest group of parallel ones; of several on one axis that with the longest wall,
    only those that go through if at least two do, and only those that are round all the way likewise. Slots come after
    the round bores, and x runs along the longest of them; one that stands otherwise is no point.

    Parameters
    ----------
    bores : sequence of Bore
        Of the part.

    Returns
    -------
    LinkFrame or None
        None where there are not two axes.
    """
    groups = [_one_for_each_axis(group) for group in parallel_groups(bores)]
    chosen = max(groups, key=lambda group: (sum(not bore.slot for bore in group), len(group)), default=[])
    through = [bore for bore in chosen if bore.through]
    chosen = through if len(through) > 1 else chosen
    slots = sorted((bore for bore in chosen if bore.slot), key=lambda bore: -round(bore.slot, 6))
    slots = [slot for slot in slots if abs(np.dot(slot.slot_axis, slots[0].slot_axis)) > math.cos(PARALLEL)]
    rounds = [bore for bore in chosen if not bore.slot]
    whole = [bore for bore in rounds if bore.share == 1.0]
    rounds = whole if len(whole) > 1 else rounds
    chosen = [*rounds, *slots]
    if len(chosen) < 2:
        return None
    pairs = list(combinations(rounds if len(rounds) > 1 else chosen, 2))
    lengths = [distance_between(*pair) for pair in pairs]
    first, second = next(pair for pair, far in zip(pairs, lengths, strict=True) if far >= max(lengths) * (1.0 - 1e-9))
    rest = [bore for bore in chosen if bore is not first and bore is not second]
    origin, z = np.array(first.centre), np.array(first.axis)
    arm = np.array(second.centre) - origin
    x = along_slot(slots, arm, z)
    named = {_letters(k): bore for k, bore in enumerate([first, second, *rest])}
    return LinkFrame(origin=origin, axes=np.array([x, np.cross(z, x), z]), bores=named)


def along_slot(bores: Iterable[Bore], towards: Real, z: Real) -> Real:
    """Return the direction x of a link: along the first slot among its bores, or else towards another bore.

    Parameters
    ----------
    bores : iterable of Bore
        Of the link.
    towards : array
        (3,), to which a slot's direction is at 90 degrees or less.
    z : array
        Unit vector (3,) along the bores.

    Returns
    -------
    array
        Unit vector (3,), normal to z.
    """
    slot = next((np.array(bore.slot_axis) for bore in bores if bore.slot), None)
    way = towards if slot is None else slot * (1.0 if slot @ towards >= 0.0 else -1.0)
    across = way - (way @ z) * z
    return np.asarray(across / np.linalg.norm(across))


def _one_for_each_axis(bores: Sequence[Bore]) -> list[Bore]:
    """Return of all bores on one axis that with the longest wall."""
    found: list[Bore] = []
    for bore in bores:
        k = next((k for k, other in enumerate(found) if coaxial(other, bore)), None)
        if k is None:
            found.append(bore)
        elif _wall(bore) > _wall(found[k]) * (1.0 + 1e-9):
            found[k] = bore
    return found


def _wall(bore: Bore) -> float:
    return sum(end - start for start, end in bore.spans)


def _letters(number: int) -> str:
    """Return A to Z, then AA, AB, ..."""
    return (_letters(number // 26 - 1) if number >= 26 else "") + chr(ord("A") + number % 26)


def single_frame(facts: PartFacts) -> LinkFrame | None:
    """Return a frame of a link with a single pin: x from the bore towards the centroid of the part.

    Where the centroid lies within the bore, x is the axis of the file across the bore that reaches farthest.

    Parameters
    ----------
    facts : PartFacts
        What is found in its file.

    Returns
    -------
    LinkFrame or None
        Its point is the first bore of the largest group of parallel ones; None without a round bore.
    """
    bore = next((bore for group in parallel_groups(facts.bores) for bore in group if not bore.slot), None)
    if bore is None:
        return None
    z, arms = np.array(bore.axis), np.diag(np.subtract(facts.high, facts.low))
    across = arms - np.outer(arms @ z, z)
    way = across[int(np.argmax(np.round(np.linalg.norm(across, axis=1) / np.linalg.norm(arms), 6)))]
    arm = np.subtract(facts.centroid, bore.centre)
    arm -= (arm @ z) * z
    if np.linalg.norm(arm) > bore.diameter / 2.0:
        way = arm
    x = way / np.linalg.norm(way)
    return LinkFrame(origin=np.array(bore.centre), axes=np.array([x, np.cross(z, x), z]), bores={"A": bore})


def far_end(surface: PartSurface, frame: LinkFrame) -> tuple[float, float]:
    """Return the end of a part along x of a frame.

    Parameters
    ----------
    surface : PartSurface
        Of the part.
    frame : LinkFrame
        The frame.

    Returns
    -------
    tuple of float
        (x, y) of the middle of what lies farthest along x [mm].
    """
    x, y, _ = frame.place(surface.points).T
    last = y[x >= x.max() - COAXIAL * (x.max() - x.min())]
    return float(x.max()), float(last.min() + last.max()) / 2.0


def viewing_frame(facts: PartFacts) -> LinkFrame:
    """Return a frame in which a part is looked at: that of its link, or else one along its longest direction.

    Parameters
    ----------
    facts : PartFacts
        What is found in its file.

    Returns
    -------
    LinkFrame
        Without bores where it is no link's.
    """
    frame = link_frame(facts.bores)
    if frame is not None:
        return frame
    _, directions = np.linalg.eigh(np.array(facts.inertia))  # the least moment is about the longest direction
    z = np.array(facts.bores[0].axis) if facts.bores else directions[:, 2]
    x = next(x for x in directions.T if abs(x @ z) < 0.9)
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    return LinkFrame(origin=np.array(facts.centroid), axes=np.array([x, np.cross(z, x), z]), bores={})
