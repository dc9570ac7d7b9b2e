"""The four-bar in closed form: poses, speeds, accelerations, limits.

Names follow R. L. Norton, Design of Machinery, 5th ed., chapters 4, 6 and 7: input link a at angle θ2,
coupler b at θ3, output link c at θ4, ground d along +x from the input's pivot O2 to the output's O4.
Lengths share one unit; angles are rad, counter-clockwise from the ground.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.dyad import (
    CLOSURE_TOLERANCE,
    BoolArray,
    Dyad,
    FloatArray,
    close_dyad,
    triangle_angle,
    wrap,
)
from alula.geometry.mechanisms.grashof import EQUALITY_TOLERANCE, Grashof, classify

Branch = Literal["open", "crossed"]

DEAD_POINT_SINE = 1e-7
"""Below this sine of the transmission angle a pose stands at a dead point: speeds have no definite value.
An exact dead point computes to some 1e-8, the square root of the rounding error."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FourBarPosition:
    """Link angles in rad, in the shape of the input angles; masked where the loop does not close.

    Attributes
    ----------
    theta2 : ndarray
        Input angles.
    theta3 : ndarray
        Coupler angles.
    theta4 : ndarray
        Output angles.
    transmission : ndarray
        Angle between coupler and output link, in [0, π] (not folded to the acute angle).
    """

    theta2: FloatArray
    theta3: FloatArray
    theta4: FloatArray
    transmission: FloatArray


@dataclass(frozen=True, kw_only=True)
class DeadPoint:
    """A pose in which coupler and output are collinear: the input can go no further (rad).

    Attributes
    ----------
    theta2 : float
        Input angle.
    theta3 : float
        Coupler angle.
    theta4 : float
        Output angle.
    kind : Literal[extended, folded]
        Whether coupler and output lie stretched or folded.
    """

    theta2: float
    theta3: float
    theta4: float
    kind: Literal["extended", "folded"]


@dataclass(frozen=True, kw_only=True)
class TurningRange:
    """How far a link can turn; intervals run counter-clockwise, in rad.

    Attributes
    ----------
    full_turn : bool
        Whether it turns fully.
    intervals : tuple[tuple[float, float], ...]
        The whole turn is (-π, π); a lower end lies in [-π, π], an upper end above it.
    dead_points : tuple[float, ...]
        Angles at which it stops.
    change_points : tuple[float, ...]
        Angles at which the links become collinear without stopping: there the branches meet.
    """

    full_turn: bool
    intervals: tuple[tuple[float, float], ...]
    dead_points: tuple[float, ...]
    change_points: tuple[float, ...]

    def interval_of(self, angle: float) -> int | None:
        """Return the interval that holds an angle.

        Parameters
        ----------
        angle : float
            Angle of any turn [rad].

        Returns
        -------
        int or None
            Index of the interval, if any.
        """
        slack = 1e-12  # rounding must not put an end outside its own interval
        for index, (low, high) in enumerate(self.intervals):
            if (angle - low + slack) % (2 * math.pi) <= high - low + 2 * slack:
                return index
        return None


@dataclass(frozen=True, kw_only=True)
class TransmissionRange:
    """Extremes of the angle between coupler and output over the input's whole range (rad, in [0, π]).

    Attributes
    ----------
    minimum : float
        Least angle.
    maximum : float
        Greatest angle.
    """

    minimum: float
    maximum: float

    @property
    def worst_deviation(self) -> float:
        """The largest deviation from 90°."""
        return max(abs(self.minimum - math.pi / 2), abs(self.maximum - math.pi / 2))


@dataclass(frozen=True, kw_only=True)
class FourBar:
    """A four-bar of positive lengths in one unit.

    Raises CaseError for a length that is not positive and finite, and where the longest link exceeds
    the other three together.

    Attributes
    ----------
    a : float
        Length of the input.
    b : float
        Length of the coupler.
    c : float
        Length of the output.
    d : float
        Length of the ground.
    """

    a: float
    b: float
    c: float
    d: float

    def __post_init__(self) -> None:
        for name, length in zip("abcd", self._lengths, strict=True):
            if not (math.isfinite(length) and length > 0):
                raise CaseError(f"four-bar length {name} = {length:g} must be positive; give the link's length.")
        longest, total = max(self._lengths), sum(self._lengths)
        if 2 * longest - total > EQUALITY_TOLERANCE * total:
            name = "abcd"[self._lengths.index(longest)]
            raise CaseError(
                f"four-bar length {name} = {longest:g} exceeds the other three together by {2 * longest - total:.4g}, "
                "so the loop can never close; shorten it or lengthen another link."
            )

    @property
    def _lengths(self) -> tuple[float, float, float, float]:
        return self.a, self.b, self.c, self.d

    @property
    def grashof(self) -> Grashof:
        """Grashof's sums, class and inversion, at the default tolerance."""
        return classify(a=self.a, b=self.b, c=self.c, d=self.d)

    def driven_by_output(self) -> "FourBar":
        """Return the mirrored four-bar whose input is this one's output: its θ2 is π - θ4, its θ4 is π - θ2."""
        return FourBar(a=self.c, b=self.b, c=self.a, d=self.d)

    def driven_by_coupler(self) -> "FourBar":
        """Return the four-bar with the first two vectors of the loop in the other order: its θ2 is θ3."""
        return FourBar(a=self.b, b=self.a, c=self.c, d=self.d)

    def _close(self, theta2: FloatArray, branch: Branch) -> Dyad:
        # d - a cos θ2 without cancellation where the input pin comes near O4.
        dx = (self.d - self.a) + 2 * self.a * np.sin(theta2 / 2) ** 2
        return close_dyad(dx, -self.a * np.sin(theta2), self.b, self.c, 1 if branch == "open" else -1)

    def position(self, theta2: ArrayLike, *, branch: Branch = "open") -> FourBarPosition:
        """Return coupler and output angles, in a form without quotients.

        Parameters
        ----------
        theta2 : array_like
            Input angles of any shape [rad].
        branch : {"open", "crossed"}
            Open is the minus sign of Norton's equation for θ4: the pin B lies to the left of the line from the input
            pin A to O4, and stays there for as long as the linkage does not pass a dead point.

        Returns
        -------
        FourBarPosition
            The angles, masked in arrays where the loop does not close.

        Raises
        ------
        CaseError
            Where it does not close at a single angle.
        """
        theta2 = np.asarray(theta2, dtype=float)
        dyad = self._close(theta2, branch)
        if theta2.ndim == 0 and not dyad.closes:
            raise CaseError(self._open_loop(float(theta2), float(dyad.gap)))
        mask = _masker(dyad.closes)
        return FourBarPosition(
            theta2=theta2, theta3=mask(dyad.first), theta4=mask(dyad.second), transmission=mask(dyad.between)
        )

    def _open_loop(self, theta2: float, gap: float) -> str:
        angle = math.degrees(theta2)
        if gap <= CLOSURE_TOLERANCE * (self.b + self.c):
            return (
                f"the four-bar has no definite pose at input angle {angle:.4f}°: the input pin lies on the output's "
                "pivot and the equal coupler and output spin about it; drive it to another angle."
            )
        spans = " and ".join(
            f"{math.degrees(low):.4f}° to {math.degrees(high):.4f}°" for low, high in self.input_range().intervals
        )
        return (
            f"the four-bar cannot be assembled at input angle {angle:.4f}°: the loop stays open by {gap:.4g}; "
            f"keep the input within {spans}."
        )

    def dead_points(self) -> tuple[DeadPoint, ...]:
        """Return the lock-up poses of the input: coupler and output collinear (Norton, 5th ed., chapter 4)."""
        found: list[DeadPoint] = []
        for kind, reach in self._limits():
            size = _pivot_angle(self.a, self.d, reach)
            for theta2 in (size, -size):
                line = math.atan2(-self.a * math.sin(theta2), self.d - self.a * math.cos(theta2))
                # Folded with the output the longer of the two, the coupler points away from O4.
                theta3 = line + (math.pi if kind == "folded" and self.c > self.b else 0.0)
                theta4 = theta3 + (math.pi if kind == "extended" else 0.0)
                found.append(
                    DeadPoint(theta2=theta2, theta3=float(wrap(theta3)), theta4=float(wrap(theta4)), kind=kind)
                )
        return tuple(found)

    def _limits(self) -> list[tuple[Literal["extended", "folded"], float]]:
        """Return the distances A-O4 at which the coupler and the output stop the input, inside its reach."""
        margin = EQUALITY_TOLERANCE * sum(self._lengths)
        limits: list[tuple[Literal["extended", "folded"], float]] = []
        if abs(self.b - self.c) > abs(self.a - self.d) + margin:
            limits.append(("folded", abs(self.b - self.c)))
        if self.b + self.c < self.a + self.d - margin:
            limits.append(("extended", self.b + self.c))
        return limits

    def input_range(self) -> TurningRange:
        """Return the range of θ2, its dead points and its change points."""
        margin = EQUALITY_TOLERANCE * sum(self._lengths)
        limits = {kind: _pivot_angle(self.a, self.d, reach) for kind, reach in self._limits()}
        near, far = limits.get("folded"), limits.get("extended")
        if near is None and far is None:
            intervals: tuple[tuple[float, float], ...] = ((-math.pi, math.pi),)
        elif near is None:
            assert far is not None
            intervals = ((-far, far),)
        elif far is None:
            intervals = ((near, 2 * math.pi - near),)
        else:
            intervals = ((near, far), (-far, -near))
        changes = []
        if abs(abs(self.b - self.c) - abs(self.a - self.d)) <= margin:
            changes.append(0.0)
        if abs(self.b + self.c - self.a - self.d) <= margin:
            changes.append(math.pi)
        return TurningRange(
            full_turn=not limits,
            intervals=intervals,
            dead_points=tuple(sign * angle for angle in limits.values() for sign in (1, -1)),
            change_points=tuple(changes),
        )

    def transmission_range(self) -> TransmissionRange:
        """Return the extremes of the transmission angle over the input's range.

        The angle grows with the distance from the input pin to O4, so its extremes lie at the ends of that
        distance: θ2 = 0 and 180° where the input turns fully (Norton, 5th ed., chapter 4), dead points elsewhere.
        """
        nearest = max(abs(self.a - self.d), abs(self.b - self.c))
        farthest = min(self.a + self.d, self.b + self.c)
        low, high = triangle_angle(self.b, self.c, np.array([nearest, farthest]))
        return TransmissionRange(minimum=float(low), maximum=float(high))

    def branch_of(self, theta2: float, theta3: float) -> Branch | None:
        """Tell the branch of a pose.

        Parameters
        ----------
        theta2, theta3 : float
            Input and coupler angle [rad].

        Returns
        -------
        str or None
            "open" or "crossed"; None at a dead point.
        """
        dx, dy = self.d - self.a * math.cos(theta2), -self.a * math.sin(theta2)
        reach = math.hypot(dx, dy)
        cross = dx * math.sin(theta3) - dy * math.cos(theta3)
        if abs(cross) <= DEAD_POINT_SINE * reach:
            return None
        return "open" if cross > 0 else "crossed"


def _pivot_angle(a: float, d: float, reach: float) -> float:
    """Return |θ2| in [0, π] at which the input pin lies ``reach`` away from O4."""
    return float(triangle_angle(a, d, reach))


def _masker(valid: BoolArray) -> Callable[[FloatArray], FloatArray]:
    """Return a function that masks arrays where ``valid`` is false and leaves single values alone."""

    def mask(values: FloatArray) -> FloatArray:
        if valid.ndim == 0:
            return np.asarray(values)
        return np.ma.masked_array(np.asarray(values), mask=~valid)

    return mask
