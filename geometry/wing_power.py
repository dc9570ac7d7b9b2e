"""Inertial power of flapping wings, against what a motor takes in.

Assumptions: rigid wings, the crank at constant speed, neither air nor friction nor elastic storage; so the
figures are a lower bound of the power while a wing is accelerated, and no estimate of the power of flight.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from geometry.errors import CaseError
from geometry.ornithopter import WingDrive
from geometry.periodic import periodic_maximum

_SAMPLES = 3600


@dataclass(frozen=True, kw_only=True)
class InertialPower:
    """Power and torque over a flap; N·mm/s (1e-3 W), N·mm, tonne·mm²."""

    frequency: float
    """Flaps per second, one per turn of the crank, Hz."""
    inertia: float
    """Of one wing about its pivot."""
    wings: int
    peak_power: float
    mean_positive_power: float
    """Work done on the wings while they are accelerated, per second: what the motor spends on inertia where
    nothing stores the work that the wings give back while they are braked. Over a flap both parts cancel."""
    peak_torque: float
    """Greatest drive torque at the crank."""
    peak_wing_torque: float
    """Greatest moment on one wing about its pivot."""
    greatest_energy: float
    """Kinetic energy of all wings at their fastest, N·mm."""

    def largest_mass(self, mass: float, power: float, *, by: Literal["peak", "mean"] = "peak") -> float:
        """Return the wing mass at which the demand reaches ``power`` (N·mm/s), from the ``mass`` of one wing here.

        Power is proportional to the mass as long as its distribution stays. ``peak`` asks the motor for the
        peak, ``mean`` for the mean positive power, as with a flywheel.
        """
        return mass * power / (self.peak_power if by == "peak" else self.mean_positive_power)


def rod_inertia(*, mass: float, span: float, root: float = 0.0) -> float:
    """Return the moment of inertia in tonne·mm² of a uniform thin rod about a pivot ``root`` mm before its start.

    m (l² / 3 + l r + r²); mass in tonne, span and root in mm. Raises CaseError for a mass or span that is not
    positive, or a negative root.
    """
    for name, value in (("mass", mass), ("span", span)):
        if not (math.isfinite(value) and value > 0):
            raise CaseError(f"wing {name} = {value:g} must be positive; give the wing's {name}.")
    if not (math.isfinite(root) and root >= 0):
        raise CaseError(f"wing root = {root:g} mm must not be negative; give the distance from pivot to wing.")
    return mass * (span * span / 3 + span * root + root * root)


def inertial_power(drive: WingDrive, *, inertia: float, frequency: float, wings: int = 2) -> InertialPower:
    """Return the inertial power of ``wings`` wings of the given inertia (tonne·mm²) at a flapping frequency (Hz).

    P = n I φ' φ'', torque at the crank P/ω. The mean positive power is the sum of the rises of the kinetic
    energy over a flap, times the frequency. Raises CaseError for a value that is not positive.
    """
    for name, value in (("inertia", inertia), ("frequency", frequency), ("number of wings", float(wings))):
        if not (math.isfinite(value) and value > 0):
            raise CaseError(f"wing {name} = {value:g} must be positive; give its value.")
    omega = 2 * math.pi * frequency
    motion = drive.motion(np.arange(_SAMPLES) * (2 * np.pi / _SAMPLES), omega)
    power = wings * inertia * motion.wing_speed * motion.wing_acceleration
    energy = 0.5 * wings * inertia * motion.wing_speed**2
    rises = np.maximum(np.diff(energy, append=energy[0]), 0.0)
    return InertialPower(
        frequency=frequency,
        inertia=inertia,
        wings=wings,
        peak_power=periodic_maximum(power),
        mean_positive_power=float(rises.sum()) * frequency,
        peak_torque=periodic_maximum(np.abs(power)) / omega,
        peak_wing_torque=inertia * periodic_maximum(np.abs(motion.wing_acceleration)),
        greatest_energy=periodic_maximum(energy),
    )


def electrical_power(*, voltage: float, current: float) -> float:
    """Return the electrical input in N·mm/s of a motor at a voltage in V and a current in A."""
    return voltage * current * 1e3
