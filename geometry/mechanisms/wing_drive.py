"""The motion of the ornithopter's wings in closed form: crank, rod, and a pin that runs in the slots of both levers."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.dyad import FloatArray
from alula.geometry.mechanisms.periodic import periodic_maximum, periodic_minimum

_SAMPLES = 3600
"""Crank positions from which extremes are refined; the refinement leaves some 1e-9 of them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WingMotion:
    """Pin and wing over the crank angle, all of one shape; both wings move alike, in the mirror.

    Attributes
    ----------
    crank_angle : ndarray
        From the centre line, 0 with the crank pin nearest to the wings (rad).
    pin_height : ndarray
        Of the sliding pin over the crank's axis, mm.
    pin_speed : ndarray
        Its speed [mm/s].
    pin_acceleration : ndarray
        Its acceleration [mm/s²].
    slot_position : ndarray
        Of the pin in the slot, from the wing's pivot, mm.
    slot_speed : ndarray
        Speed of the pin along the slot [mm/s].
    wing_angle : ndarray
        Of the slot to the horizontal, positive where the pin stands above the pivots, rad.
    wing_speed : ndarray
        Angular speed of the wing [rad/s].
    wing_acceleration : ndarray
        Angular acceleration of the wing [rad/s²].
    """

    crank_angle: FloatArray
    pin_height: FloatArray
    pin_speed: FloatArray
    pin_acceleration: FloatArray
    slot_position: FloatArray
    slot_speed: FloatArray
    wing_angle: FloatArray
    wing_speed: FloatArray
    wing_acceleration: FloatArray


@dataclass(frozen=True, kw_only=True)
class WingExtremes:
    """Extremes over one turn of the crank at constant speed (rad, rad/s, rad/s²; pin mm/s, mm/s²).

    Attributes
    ----------
    highest : float
        Greatest wing angle.
    lowest : float
        Least wing angle.
    stroke : float
        Their difference.
    fastest_up : float
        Greatest wing speed.
    fastest_down : float
        Least wing speed.
    greatest_acceleration : float
        Greatest wing acceleration.
    least_acceleration : float
        Least wing acceleration.
    pin_speed_up : float
        Greatest speed of the pin.
    pin_speed_down : float
        Least speed of the pin.
    pin_acceleration_max : float
        Greatest acceleration of the pin.
    pin_acceleration_min : float
        Least acceleration of the pin.
    """

    highest: float
    lowest: float
    stroke: float
    fastest_up: float
    fastest_down: float
    greatest_acceleration: float
    least_acceleration: float
    pin_speed_up: float
    pin_speed_down: float
    pin_acceleration_max: float
    pin_acceleration_min: float


@dataclass(frozen=True, kw_only=True)
class WingDrive:
    """Crank, rod and wing pivots, in mm. Raises CaseError where the crank cannot turn fully.

    Attributes
    ----------
    throw : float
        Radius of the crank pin.
    rod : float
        Length of the rod between the pins.
    pivot_offset : float
        Of the wing pivots beside the centre line.
    pivot_height : float
        Of the wing pivots over the crank.
    """

    throw: float
    rod: float
    pivot_offset: float
    pivot_height: float

    def __post_init__(self) -> None:
        if not self.rod > self.throw > 0:
            raise CaseError(
                f"ornithopter rod = {self.rod:g} mm must be longer than the throw of {self.throw:g} mm, which must be "
                "positive, or the crank cannot turn; lengthen the rod."
            )
        if not (math.isfinite(self.pivot_offset) and self.pivot_offset > 0 and math.isfinite(self.pivot_height)):
            raise CaseError(
                f"ornithopter pivots at {self.pivot_offset:g} mm beside and {self.pivot_height:g} mm above the crank "
                "must be finite and lie beside the centre line; give a positive offset."
            )

    def motion(self, crank_angle: ArrayLike, speed: ArrayLike) -> WingMotion:
        """Return the motion at constant crank speed.

        The pin of a slider-crank in line, throw r and rod l, stands at d = r cos θ + w, w = √(l² - r² sin² θ). At the
        height s = d - h over the pivots, tan φ = s/X, so φ' = X s'/(X² + s²) and
        φ'' = X (s'' (X² + s²) - 2 s s'²)/(X² + s²)².

        Parameters
        ----------
        crank_angle : array_like
            From the centre line [rad].
        speed : array_like
            Of the crank [rad/s]; broadcasts with the angles.

        Returns
        -------
        WingMotion
            Pin and wing.
        """
        theta, omega = np.broadcast_arrays(np.asarray(crank_angle, dtype=float), np.asarray(speed, dtype=float))
        along, across = self.throw * np.cos(theta), self.throw * np.sin(theta)
        w = np.sqrt((self.rod - across) * (self.rod + across))
        slope = -along * across / w  # dw/dθ
        d, v = along + w, omega * (slope - across)
        a = -(omega**2) * (along + (along**2 - across**2 + slope**2) / w)
        X, s = self.pivot_offset, d - self.pivot_height
        square = X * X + s * s
        reach = np.sqrt(square)
        return WingMotion(
            crank_angle=theta,
            pin_height=d,
            pin_speed=v,
            pin_acceleration=a,
            slot_position=reach,
            slot_speed=s * v / reach,
            wing_angle=np.arctan2(s, X),
            wing_speed=X * v / square,
            wing_acceleration=X * (a * square - 2 * s * v * v) / square**2,
        )

    def extremes(self, speed: float) -> WingExtremes:
        """Return the extremes over one turn at constant crank speed.

        Parameters
        ----------
        speed : float
            Of the crank [rad/s].

        Returns
        -------
        WingExtremes
            Wing and pin.
        """
        motion = self.motion(np.arange(_SAMPLES) * (2 * np.pi / _SAMPLES), speed)
        # The wing follows the pin, whose end positions are those of crank and rod in line.
        highest = math.atan2(self.rod + self.throw - self.pivot_height, self.pivot_offset)
        lowest = math.atan2(self.rod - self.throw - self.pivot_height, self.pivot_offset)
        return WingExtremes(
            highest=highest,
            lowest=lowest,
            stroke=highest - lowest,
            fastest_up=periodic_maximum(motion.wing_speed),
            fastest_down=periodic_minimum(motion.wing_speed),
            greatest_acceleration=periodic_maximum(motion.wing_acceleration),
            least_acceleration=periodic_minimum(motion.wing_acceleration),
            pin_speed_up=periodic_maximum(motion.pin_speed),
            pin_speed_down=periodic_minimum(motion.pin_speed),
            pin_acceleration_max=periodic_maximum(motion.pin_acceleration),
            pin_acceleration_min=periodic_minimum(motion.pin_acceleration),
        )
