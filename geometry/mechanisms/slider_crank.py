"""The slider-crank, in line or offset, in closed form.

Names follow R. L. Norton, Design of Machinery, 5th ed., chapters 4, 6 and 7: crank a at angle θ2,
connecting rod b at angle θ3 (measured at the slider, towards the crank pin), offset c of the slider's line,
slider position d along that line from the foot of the crank's pivot. Angles are rad, from the line.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geometry.base.errors import CaseError
from geometry.linkage.dyad import CLOSURE_TOLERANCE, FloatArray
from geometry.mechanisms.fourbar import DEAD_POINT_SINE, Branch


@dataclass(frozen=True, kw_only=True, eq=False)
class SliderCrankPosition:
    """Rod angle (rad) and slider position, in the shape of the crank angles; masked where the rod is too short."""

    theta2: FloatArray
    theta3: FloatArray
    d: FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class SliderCrankMotion:
    """Rod speed and acceleration (rad/s, rad/s²), slider speed and acceleration (lengths/s, lengths/s²)."""

    position: SliderCrankPosition
    omega3: FloatArray
    d_dot: FloatArray
    alpha3: FloatArray
    d_ddot: FloatArray


@dataclass(frozen=True, kw_only=True)
class SliderCrank:
    """A slider-crank; crank ``a`` and rod ``b`` are positive, the offset ``c`` has a sign.

    Raises CaseError for other lengths, and where the rod can never reach the slider's line.
    """

    a: float
    b: float
    c: float = 0.0

    def __post_init__(self) -> None:
        for name, length in (("a", self.a), ("b", self.b)):
            if not (math.isfinite(length) and length > 0):
                raise CaseError(f"slider-crank length {name} = {length:g} must be positive; give the link's length.")
        if not math.isfinite(self.c):
            raise CaseError(f"slider-crank offset c = {self.c:g} must be finite; give the offset of the slider's line.")
        if abs(self.c) > self.a + self.b:
            raise CaseError(
                f"slider-crank offset c = {self.c:g} exceeds crank and rod together by "
                f"{abs(self.c) - self.a - self.b:.4g}; lengthen the rod or reduce the offset."
            )

    @property
    def full_turn(self) -> bool:
        """Whether the crank turns fully: b ≥ a + |c|."""
        return self.b >= self.a + abs(self.c)

    def stroke_ends(self, *, branch: Branch = "open") -> tuple[float, float]:
        """Return the least and the greatest slider position of a crank that turns fully.

        There crank and rod are collinear: d² = (b ± a)² - c². Raises CaseError for a crank that cannot turn fully.
        """
        if not self.full_turn:
            raise CaseError(
                f"the crank cannot turn fully, since the rod b = {self.b:g} is shorter than a + |c| = "
                f"{self.a + abs(self.c):g}; its stroke is bounded by dead points instead, so give a longer rod."
            )
        near, far = (
            math.sqrt(max(0.0, (r - abs(self.c)) * (r + abs(self.c)))) for r in (self.b - self.a, self.b + self.a)
        )
        return (near, far) if branch == "open" else (-far, -near)

    def position(self, theta2: ArrayLike, *, branch: Branch = "open") -> SliderCrankPosition:
        """Return rod angle and slider position for crank angles of any shape (rad).

        Norton, 5th ed., chapter 4: ``open`` is the slider on the side of +d. A single angle
        at which the rod is too short raises CaseError; in arrays such angles are masked.
        """
        theta2 = np.asarray(theta2, dtype=float)
        rise = self.a * np.sin(theta2) - self.c
        gap = np.abs(rise) - self.b
        closes = gap <= CLOSURE_TOLERANCE * self.b
        if theta2.ndim == 0 and not closes:
            raise CaseError(
                f"the slider-crank cannot be assembled at crank angle {math.degrees(float(theta2)):.4f}°: the rod is "
                f"too short by {float(gap):.4g}; lengthen it or drive the crank to another angle."
            )
        run = np.sqrt(np.maximum((self.b - rise) * (self.b + rise), 0.0))
        if branch == "crossed":
            run = -run
        theta3, d = np.arctan2(rise, -run), self.a * np.cos(theta2) + run
        if theta2.ndim > 0:
            theta3, d = (np.ma.masked_array(values, mask=~closes) for values in (theta3, d))
        return SliderCrankPosition(theta2=theta2, theta3=theta3, d=d)

    def motion(
        self, theta2: ArrayLike, omega2: ArrayLike, alpha2: ArrayLike = 0.0, *, branch: Branch = "open"
    ) -> SliderCrankMotion:
        """Return speeds and accelerations for crank speeds ω2 (rad/s) and accelerations α2 (rad/s²); all broadcast.

        Norton, 5th ed., chapters 6 and 7. Where the rod stands square to the
        slider's line they have no definite value: CaseError for a single pose, masked in arrays.
        """
        theta2, omega2, alpha2 = np.broadcast_arrays(
            *(np.asarray(value, dtype=float) for value in (theta2, omega2, alpha2))
        )
        position = self.position(theta2, branch=branch)
        theta3 = np.asarray(position.theta3)
        dead = np.abs(np.cos(theta3)) < DEAD_POINT_SINE
        if theta2.ndim == 0 and dead:
            raise CaseError(
                f"the slider-crank stands at a dead point at crank angle {math.degrees(float(theta2)):.4f}°: the rod "
                "is square to the slider's line and speeds have no definite value; drive it at another angle."
            )
        cosine = np.where(dead, 1.0, self.b * np.cos(theta3))
        along, across = self.a * np.cos(theta2), self.a * np.sin(theta2)
        rise = self.b * np.sin(theta3)
        omega3 = along * omega2 / cosine
        d_dot = -across * omega2 + rise * omega3
        alpha3 = (along * alpha2 - across * omega2**2 + rise * omega3**2) / cosine
        d_ddot = -across * alpha2 - along * omega2**2 + rise * alpha3 + self.b * np.cos(theta3) * omega3**2
        if theta2.ndim > 0:
            mask = np.ma.getmaskarray(position.d) | dead
            omega3, d_dot, alpha3, d_ddot = (
                np.ma.masked_array(values, mask=mask) for values in (omega3, d_dot, alpha3, d_ddot)
            )
        return SliderCrankMotion(position=position, omega3=omega3, d_dot=d_dot, alpha3=alpha3, d_ddot=d_ddot)
