"""Fatigue of the layers of a printed part: mean and amplitude of tension across them and of shear along them.

Tension: half the sum and half the difference of the extremes of the normal stress. Compression beyond that of a
reversed cycle neither helps nor harms. Shear: centre and radius of the smallest circle about the path of the shear
stress in the plane of the layers. Either is brought to the stress ratio of the test by the rule of the card; Goodman's
line ends at the static strength, Rn or Rt. Both together count by the quadratic sum of the static criterion, with
fatigue strengths in place of static ones. Assumed: fatigue lowers the strength against shear in the same proportion as
that against tension, since a card has one set of data; the largest tension and shear act together, whenever they occur.

References
----------
A. Bernasconi and I. V. Papadopoulos, Efficiency of algorithms for shear stress amplitude calculation in critical plane
class fatigue criteria, Comput. Mater. Sci. 34 (2005) 355-368: amplitude and mean by the smallest circle.
Z. Hashin and A. Rotem, A fatigue failure criterion for fiber reinforced materials, J. Compos. Mater. 7 (1973) 448-464:
a failure criterion of plies whose strengths are those of S-N curves, one for each component of stress.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.fatigue import NEGLIGIBLE, cycles_to_failure, equivalent_peak, repeated_cycles
from alula.fea.solid.layers import Layers
from alula.fea.superposition.peaks import ModeMeasures
from alula.geometry.materials.material import Fatigue

Real = NDArray[np.float64]

_BLOCK = 512
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class LayerCycle:
    """The cycle of the traction on layers at one place of a motion.

    Attributes
    ----------
    tension : tuple of (float, float)
        Mean and amplitude of the stress normal to the layers [MPa].
    shear : tuple of (float, float)
        Of the shear stress along them, times Rn/Rt [MPa].
    count : float
        Cycles in one repetition of the motion, the negligible ones left out.
    """

    tension: tuple[float, float]
    shear: tuple[float, float]
    count: float

    @classmethod
    def of(cls, traction: Real) -> "LayerCycle":
        """Return the cycle of a closed history.

        Parameters
        ----------
        traction : ndarray, shape (3, n)
            As of ``Layers.parts`` [MPa].

        Returns
        -------
        LayerCycle
        """
        low, high = float(traction[0].min()), float(traction[0].max())
        centre, radius = smallest_circle(traction[1:].T)
        cycles = [repeated_cycles(part) for part in traction]
        largest = max(found[:, 0].max(initial=0.0) for found in cycles)
        return cls(
            tension=((high + low) / 2.0, (high - low) / 2.0),
            shear=(float(np.linalg.norm(centre)), radius),
            count=max(float(found[found[:, 0] >= NEGLIGIBLE * largest, 2].sum()) for found in cycles),
        )

    def stress(self, data: Fatigue, strength: float, factor: float = 1.0) -> float:
        """Return the peak of a cycle of tension with the test's stress ratio that harms as much.

        Parameters
        ----------
        data : Fatigue
            Across the layers.
        strength : float
            Rn [MPa].
        factor : float, optional
            By which the stress is larger.

        Returns
        -------
        float
            [MPa]
        """
        both = factor * np.array([self.tension, self.shear])
        return float(_harm(both[:1], both[1:], data, strength)[0])

    def repetitions(self, data: Fatigue, strength: float, factor: float = 1.0, by: float = 1.0) -> float | None:
        """Return how often the motion is borne, every cycle counted as if it were the worst.

        Parameters
        ----------
        data : Fatigue
        strength : float
        factor : float, optional
            As for ``stress``.
        by : float, optional
            Share of the card's fatigue strength, with which its endurance limit goes as well.

        Returns
        -------
        float or None
            None where the card has no exponent.
        """
        if data.exponent is None:
            return None
        stress = np.array([self.stress(data, strength, factor)]) / by
        return float(cycles_to_failure(stress, data)[0]) / max(self.count, 1.0)


def _harm(tension: Real, shear: Real, data: Fatigue, strength: float) -> Real:
    """Equivalent peaks (k,) from means and amplitudes (k, 2)."""
    high = tension.sum(axis=1)
    low = np.maximum(high - 2.0 * tension[:, 1], -np.maximum(high, 0.0))
    one = np.ones_like(high)
    pull = equivalent_peak(np.column_stack([np.maximum(high - low, 0.0), (high + low) / 2.0, one]), data, strength)
    slip = equivalent_peak(np.column_stack([2.0 * shear[:, 1], shear[:, 0], one]), data, strength)
    return np.asarray(np.hypot(pull, slip))


def smallest_circle(points: Real) -> tuple[Real, float]:
    """Return the smallest circle about points.

    The circle about a few of them is made larger by the farthest point outside until none is outside. That point then
    is on the circle.

    Parameters
    ----------
    points : ndarray, shape (n, 2)

    Returns
    -------
    tuple of (ndarray, float)
        Centre and radius.
    """
    path = (points[:, 0] - points[0, 0]) + 1j * (points[:, 1] - points[0, 1])
    slack = _ROUNDING * float(np.abs(path).max())
    few, centre, radius = [0j], 0j, 0.0
    while True:
        distance = np.abs(path - centre)
        far = int(np.argmax(distance))
        if distance[far] <= radius + slack:
            return points[0] + (centre.real, centre.imag), radius
        few, centre, radius = _circle_through(complex(path[far]), few, slack)


def _circle_through(point: complex, others: list[complex], slack: float) -> tuple[list[complex], complex, float]:
    """Smallest circle through a point about at most three others: the points on it, centre, radius."""
    found = [([point, other], (other - point) / 2.0) for other in others]
    for one, two in itertools.combinations(others, 2):
        a, b = one - point, two - point
        twice = a.conjugate() * b - a * b.conjugate()  # 4i times the area of the triangle
        if twice != 0.0:
            found.append(([point, one, two], (abs(a) ** 2 * b - abs(b) ** 2 * a) / twice))
    holding = [
        (few, offset)
        for few, offset in found
        if max(abs(other - point - offset) for other in others) <= abs(offset) + slack
    ]
    few, offset = min(holding, key=lambda one: abs(one[1]))
    return few, point + offset, abs(offset)


def critical_layer(stress: Real, combination: Real, layers: Layers, data: Fatigue) -> tuple[int, Real]:
    """Return the node whose layers fatigue first.

    The smallest circle about a path of size 2g to 2h, whose points are at most L from the origin, has a radius r from g
    to h and a centre at most √(L² − g²) from the origin. Only nodes that by this bound may be the worst are looked at.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components of modes [MPa].
    combination : ndarray, shape (m, n)
        Of the modes at n poses.
    layers : Layers
    data : Fatigue
        Across the layers.

    Returns
    -------
    tuple of (int, ndarray, shape (3, n))
        The node, and its traction as of ``Layers.parts`` [MPa].
    """
    parts, strength = layers.parts(stress), layers.across
    reach = ModeMeasures(parts=parts).sizes @ np.abs(combination).max(axis=1)
    # √2 times the worst of either: no mean or amplitude exceeds the reach.
    coarse = np.column_stack([reach, reach])
    most = _harm(coarse, coarse, data, strength)
    order, best = np.argsort(-reach), (-1.0, 0, np.zeros((3, combination.shape[1])))
    for start in range(0, len(order), _BLOCK):
        block = order[start : start + _BLOCK]
        if most[block[0]] <= best[0]:
            break
        traction = parts[block] @ combination
        bound = _bounds(traction, data, strength)
        for k in np.argsort(-bound):
            if bound[k] <= best[0]:
                break
            harm = LayerCycle.of(traction[k]).stress(data, strength)
            if harm > best[0]:
                best = harm, int(block[k]), traction[k]
    return best[1:]


def _bounds(traction: Real, data: Fatigue, strength: float) -> Real:
    """Upper bounds (k,) of the harm of tractions (k, 3, n)."""
    low, high = traction.min(axis=2), traction.max(axis=2)
    sides = (high - low)[:, 1:] / 2.0
    least, most = sides.max(axis=1), np.hypot(*sides.T)
    far = np.sqrt((traction[:, 1:] ** 2).sum(axis=1).max(axis=1))
    shear = np.column_stack([np.sqrt(np.maximum(far**2 - least**2, 0.0)), most])
    tension = np.column_stack([(high + low)[:, 0] / 2.0, (high - low)[:, 0] / 2.0])
    return (1.0 + _ROUNDING) * _harm(tension, shear, data, strength)
