"""Following one branch of a linkage from a start pose, step by step, and refining poses in batches.

The unknowns q of the loop closure G(q) = 0 become functions of one of them, the angle theta of the
driven link (or the travel of a driven slider, measured in the longest link). With J the Jacobian,
J_f its columns of the other unknowns and J_c the driven one's,

    J_f q_f' = -J_c,        J_f q_f'' = -Q(q')

where ' is d/dtheta and Q the part of the second derivative that is quadratic in the rates: the
first- and second-order kinematic coefficients (Norton, Design of Machinery, 5th ed., chapters 6
and 7, for loops of any number). Each step predicts by Taylor's formula to second order and corrects by
Newton; it is halved until prediction and correction agree and the determinant keeps its sign
(Allgower & Georg, Introduction to Numerical Continuation Methods, 2003, chapters 2 and 6).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.driven import DrivenClosure

Real = NDArray[np.float64]

LONGEST_STEP = 0.1
SHORTEST_STEP = 1e-8
"""Steps of the driven angle [rad], or travel [longest link]; below the shortest one the branch has come to its end."""
_AGREEMENT = 1e-3
_SHARE = 0.1
_ROUNDING = 1e-12
"""Agreement [rad] that is not asked for in steps so short that rounding is all that is left."""
_PROBE = 1e-4
"""Distance [rad] from a stop at which branches are told apart; nearer to it rates are lost in rounding."""
_BLOCK = 1024
"""Poses refined at once, so that the arrays stay in the processor's cache."""


class DeadPointError(CaseError):
    """The driven link cannot go on (or not in one way only) at ``angle`` [rad], or travel [mm] of a slider."""

    def __init__(self, sentence: str, angle: float) -> None:
        super().__init__(sentence)
        self.angle = angle


@dataclass(frozen=True, kw_only=True, eq=False)
class Track:
    """One branch as a chain of nodes, dense enough to interpolate between them.

    Attributes
    ----------
    driven : DrivenClosure
        The driven closure.
    angles : ndarray
        Rising driven angles (k,) [rad], or travels [mm].
    q : ndarray
        Unknowns (k, unknowns).
    first, second : ndarray
        Their derivatives by the driven angle (k, unknowns).
    """

    driven: DrivenClosure
    angles: Real
    q: Real
    first: Real
    second: Real

    def at(self, angles: ArrayLike) -> Real:
        """Return the unknowns (n, unknowns) at driven angles (n,) [rad] within the track, closed to rounding.

        Parameters
        ----------
        angles : array_like
            Driven angles (n,) [rad], or travels [mm].

        Returns
        -------
        ndarray
            Unknowns (n, unknowns).
        """
        wanted = np.asarray(angles, dtype=float)
        out = np.empty((len(wanted), self.q.shape[1]))
        for i in range(0, len(wanted), _BLOCK):
            block = slice(i, i + _BLOCK)
            guess = self._interpolate(wanted[block])
            refined, settled = self.driven.correct(guess)
            if not settled or np.max(np.abs((refined - guess) / self.driven.sizes), initial=0.0) > _AGREEMENT:
                raise CannotRunError(
                    f"motion: a pose between {self.driven.told(wanted[block].min())} and "
                    f"{self.driven.told(wanted[block].max())} of "
                    f"{self.driven.coordinate} could not be closed on the branch; keep the range away from dead points"
                )
            out[block] = refined
        return out

    def _interpolate(self, angles: Real) -> Real:
        """Quintic Hermite interpolation between the nodes."""
        if len(self.angles) == 1:
            return np.repeat(self.q, len(angles), axis=0)
        i = np.clip(np.searchsorted(self.angles, angles) - 1, 0, len(self.angles) - 2)
        h = (self.angles[i + 1] - self.angles[i])[:, None]
        t = (angles - self.angles[i])[:, None] / h
        a, b, c = self.q[i], h * self.first[i], 0.5 * h**2 * self.second[i]
        rise = self.q[i + 1] - a - b - c
        slope = h * self.first[i + 1] - b - 2.0 * c
        bend = 0.5 * h**2 * self.second[i + 1] - c
        d = 10.0 * rise - 4.0 * slope + bend
        e = -15.0 * rise + 7.0 * slope - 2.0 * bend
        f = 6.0 * rise - 3.0 * slope + bend
        out = a + t * (b + t * (c + t * (d + t * (e + t * f))))
        out[:, self.driven.column] = angles
        return np.asarray(out)


def follow(driven: DrivenClosure, start: Real, low: float, high: float) -> Track:
    """Follow the branch of the closed pose ``start`` (unknowns,) until it covers driven angles low to high [rad].

    Parameters
    ----------
    driven : DrivenClosure
        The driven closure.
    start : ndarray
        Unknowns (unknowns,) of a closed pose.
    low : float
        Least driven angle [rad], or travel [mm].
    high : float
        Greatest driven angle [rad], or travel [mm].

    Returns
    -------
    Track
        The branch.

    Raises
    ------
    DeadPointError
        Where the branch ends before, naming the angle.
    """
    back = _chain(driven, start, low)
    ahead = _chain(driven, start, high)
    nodes = back[::-1] + ahead[1:] if low <= start[driven.column] else ahead
    if high < start[driven.column]:
        nodes = back[::-1]
    q, first, second = (np.array([node[k] for node in nodes]) for k in range(3))
    return Track(driven=driven, angles=q[:, driven.column], q=q, first=first, second=second)


Node = tuple[Real, Real, Real]


def _chain(driven: DrivenClosure, start: Real, end: float) -> list[Node]:
    """Nodes from the start to the driven angle ``end``, in the order in which they are passed."""
    column = driven.column
    nodes = [_node(driven, start, end)]
    longest, shortest = LONGEST_STEP * driven.size, SHORTEST_STEP * driven.size
    step = longest
    while (left := end - nodes[-1][0][column]) != 0.0:
        here = nodes[-1]
        size = min(step, abs(left))
        angle = end if size == abs(left) else float(here[0][column]) + math.copysign(size, left)
        new = _advance(driven, here, angle)
        if new is not None:
            nodes.append(new)
            step = min(1.6 * size, longest)
        elif size > shortest:
            step = size / 2.0
        else:
            raise _stopped(driven, nodes, end)
    return nodes


def _node(driven: DrivenClosure, start: Real, end: float) -> Node:
    try:
        return (start, *driven.coefficients(start))
    except np.linalg.LinAlgError:
        raise _error(driven, float(start[driven.column]), end, "stands at a dead point") from None


def _taylor(node: Node, by: float) -> Real:
    return np.asarray(node[0] + by * node[1] + 0.5 * by**2 * node[2])


def _advance(driven: DrivenClosure, here: Node, angle: float) -> Node | None:
    """Return the next node, or None where the step is too long to be sure of the branch."""
    by = angle - float(here[0][driven.column])
    guess = _taylor(here, by)
    guess[driven.column] = angle
    try:
        q, settled = driven.correct(guess)
        if not settled:
            return None
        new = (q, *driven.coefficients(q))
    except np.linalg.LinAlgError:
        return None
    moved = float(np.max(np.abs((q - here[0]) / driven.sizes)))
    tolerance = max(min(_AGREEMENT, _SHARE * moved), _ROUNDING)
    for first, second in ((guess, q), (_taylor(new, -by), here[0])):
        if not np.max(np.abs((first - second) / driven.sizes)) <= tolerance:
            return None
    complement = driven.complement(here[0])
    if driven.orientation(q, complement) != driven.orientation(here[0], complement):
        return None
    return new


def _stopped(driven: DrivenClosure, nodes: Sequence[Node], end: float) -> DeadPointError:
    """Tell a dead point, where the branch turns back, from a point where two branches cross.

    Next to a dead point every unknown goes with the square root of the distance left, so that the
    distance is x' / (2 x''). A crossing is told by the branch's going on beyond it, as seen from before it.
    """
    last, column = nodes[-1], driven.column
    here = float(last[0][column])
    sense = math.copysign(1.0, end - here)
    fastest = int(np.argmax(np.abs(last[1] / driven.sizes)))
    probe = _PROBE * driven.size
    before = next((n for n in reversed(nodes) if abs(here - float(n[0][column])) > probe), nodes[0])
    beyond = _taylor(before, 2.0 * (here - float(before[0][column])) + sense * probe)
    try:
        q, settled = driven.correct(beyond)
        crossed = settled and float(np.max(np.abs((q - beyond) / driven.sizes))) < _AGREEMENT
    except np.linalg.LinAlgError:
        crossed = False
    if crossed:
        return _error(driven, here, end, "stands where two branches cross, so that the links may go on in two ways,")
    distance = last[1][fastest] / (2.0 * last[2][fastest]) if last[2][fastest] != 0.0 else 0.0
    if not abs(distance) < 10.0 * SHORTEST_STEP * driven.size:
        distance = 0.0
    return _error(driven, here + float(distance), end, "comes to a dead point")


def _error(driven: DrivenClosure, angle: float, end: float, what: str) -> DeadPointError:
    return DeadPointError(
        f"motion: driven by {driven.coordinate}, the linkage {what} at {driven.coordinate} = {driven.told(angle)} "
        f"before it reaches {driven.told(end)}; keep the range on one side of that "
        f"{driven.coordinate.measure.word} or drive another link",
        angle,
    )
