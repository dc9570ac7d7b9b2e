"""How joints hold a link that is no beam, for the buckling of its solid: conditions on the mean motions of its bores.

As a column is held (``alula.fea.buckling.buckling``), with bores in place of stations:

value  no more than its rigid motions are taken, by joints that stay where they are: one of the two bores that lie
       farthest apart does not move in the plane, the other not across the line through both; out of the plane neither
       moves, and a third one off that line does not either; without such a third both together do not turn about the
       line. All angles are free beyond that. What other joints prevent makes the link stiffer. A link with one joint
       is built in there, and the ground where its support holds it.
alone  a driven or bonded link may be built in at one of its joints and be free elsewhere.
most   every bore stays where it is and keeps whatever angle it can.
"""

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.loads.case.case import Case

Real = NDArray[np.float64]
ALL = tuple(range(6))
"""Translations and rotations of a place."""
TURN_Z = 5
OFF_LINE = 0.1
"""Distance of a third bore from the line through two others, over their distance, from which it holds the link."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidHolding:
    """Ways to hold a link, each as conditions on the mean motions of its p places.

    Attributes
    ----------
    places : mapping of str to ndarray
        Surface, such as ``bore:A``, and point (3,) about which its mean motion counts [mm].
    value : ndarray, shape (k, 6 p)
        Its rigid motions are taken.
    alone : tuple of ndarray
        Where it may be built in and free elsewhere, each by itself; empty where its joints stay in place.
    most : ndarray or None
        Joints hold it as well as they can; None where that is not known.
    how : Reason
        How ``value`` holds it, for people.
    """

    places: Mapping[str, Real]
    value: Real
    alone: tuple[Real, ...]
    most: Real | None
    how: Reason


def solid_holding(case: Case, link: str) -> SolidHolding:
    """Return how joints hold a link.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    SolidHolding
    """
    linkage, body = case.linkage, case.body(link)
    joints = {name: linkage.point_of(name, link) for name in linkage.joints_of(link)}
    carried = {point for name, point in joints.items() if linkage.joints[name].carrier == link}
    places = {f"bore:{pin.name}": np.array([pin.x, pin.y, 0.0]) for pin in body.pins}
    places |= {f"end:{end.name}": np.array([end.x, end.y, 0.0]) for end in body.ends if end.clamped}
    support = case.links[link].held_at
    if support is not None:
        [end] = [end for end in body.ends if end.name == support]
        places[f"end:{support}"] = np.array([end.x, end.y, 0.0])
    held = _Conditions(places)
    held_joints = [point for point in joints.values() if point not in carried] or list(joints.values())
    drive = case.drive.joint if case.drive is not None and case.drive.link == link else None
    kept = {point for name, point in joints.items() if linkage.joints[name].fixed or name == drive}
    most = [held.kept(held.surface(p), ALL if p in kept else ALL[:TURN_Z]) for p in joints.values()]
    if support is not None:
        value, how = held.kept(f"end:{support}", ALL), reason("built_in_at", place=support)
        return SolidHolding(places=places, value=value, alone=(), most=np.vstack([*most, value]), how=how)
    value, how = held.in_place(held_joints)
    return SolidHolding(
        places=places,
        value=value,
        alone=tuple(held.kept(held.surface(point), ALL) for point in sorted(kept)),
        most=None if carried else np.vstack(most),
        how=how,
    )


class _Conditions:
    """Rows on the mean motions of places."""

    def __init__(self, places: Mapping[str, Real]) -> None:
        self._places, self._names = places, list(places)

    def row(self, *terms: tuple[str, Iterable[float]]) -> Real:
        """One condition: a sum of places' motions, each with its six factors."""
        found = np.zeros((len(self._names), 6))
        for name, factors in terms:
            found[self._names.index(name)] = [*factors]
        return found.ravel()

    def surface(self, point: str) -> str:
        """Name of the surface at a point: its bore, or what a clamp holds."""
        return f"end:{point}" if f"end:{point}" in self._places else f"bore:{point}"

    def kept(self, name: str, motions: Iterable[int]) -> Real:
        """Conditions (k, 6 p) that these motions of a place are zero."""
        return np.array([self.row((name, np.eye(6)[motion])) for motion in motions])

    def in_place(self, points: list[str]) -> tuple[Real, Reason]:
        """Conditions that take the rigid motions by bores that stay where they are, and the reason that tells it."""
        at = {point: self._places[self.surface(point)][:2] for point in points}
        pairs = list(itertools.combinations(points, 2))
        lengths = [float(np.linalg.norm(at[b] - at[a])) for a, b in pairs]
        if not pairs or max(lengths) <= 1e-9 * float(np.abs(list(self._places.values())).max()):
            return self.kept(self.surface(points[0]), ALL), reason("built_in_at", place=points[0])
        first, last = pairs[int(np.argmax(lengths))]
        along = (at[last] - at[first]) / max(lengths)
        one, other = self.surface(first), self.surface(last)
        off = {p: abs(float(along[0] * (at[p] - at[first])[1] - along[1] * (at[p] - at[first])[0])) for p in points}
        third = max(points, key=off.__getitem__)
        if off[third] > OFF_LINE * max(lengths):
            last_row = self.row((self.surface(third), np.eye(6)[2]))
            how = reason("on_pins_and_third", first=first, last=last, third=third)
        else:
            turn = [0.0, 0.0, 0.0, *along, 0.0]
            last_row = self.row((one, turn), (other, turn))
            how = reason("on_pins", first=first, last=last)
        rows = [
            *self.kept(one, (0, 1, 2)),
            self.row((other, [-along[1], along[0], 0.0, 0.0, 0.0, 0.0])),
            *self.kept(other, (2,)),
            last_row,
        ]
        return np.array(rows), how
