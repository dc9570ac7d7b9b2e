"""In which ways the eyes of a ductile link end, and what force each of them takes.

``docs/theory/eyes.md`` has every formula with its source, what of it was derived here, and what could not be read.
Sizes are those along and across the force; a round eye has the same in every direction. R is its outer radius, D_h its
hole, D_p its pin, t its thickness, and b = R - D_h/2 the material about the hole.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason

Real = NDArray[np.float64]

SNUG = 0.9
"""Pin over hole from which on a pin counts as one that fits (ASME BTH-1, section 3-3.3.1)."""
INTO_SHANK = math.radians(30.0)
"""Angle from the middle of a shank within which a force presses the pin into it, where no edge lies ahead; assumed.
Within it what lies across the shank counts, as a share of what lies across it at this angle."""
STRAIGHT = 1e-9
"""Sine of the angle below which a force is along the shank but for rounding."""


class EyeMode(StrEnum):
    """A way in which an eye ends; its value says for people what it is."""

    NET_SECTION = "tension beside the hole"
    DISHING = "dishing of a thin eye"
    FRACTURE = "fracture on one plane beyond the pin"
    SHEAR_OUT = "shear on two planes beyond the pin"
    BEARING = "bearing of the pin"
    END = "distance from hole to end"
    SIDE = "distance from hole to side"


@dataclass(frozen=True, kw_only=True)
class RoundEye:
    """A round eye about a pin.

    Attributes
    ----------
    radius : float
        Its outer radius R [mm].
    hole, pin : float
        Diameters [mm].
    thickness : float
        Length of the hole's walls together [mm].
    wall : float
        The thinnest of these walls [mm]: a cheek of a fork.
    """

    radius: float
    hole: float
    pin: float
    thickness: float
    wall: float

    @property
    def beside(self) -> float:
        """From the hole to the edge, b [mm]."""
        return self.radius - self.hole / 2.0

    @property
    def loose(self) -> float:
        """By what share of its strength a pin that fits is better than this one, C_r."""
        share = self.pin / self.hole
        return 1.0 if share > SNUG else 1.0 - 0.275 * math.sqrt(1.0 - share * share)

    @property
    def shear_plane(self) -> float:
        """Length of one of the two planes on which what lies beyond the pin shears off, up to the round edge [mm]."""
        angle = math.radians(55.0) * self.pin / self.hole
        to_side = self.pin / 2.0 * math.sin(angle)
        straight = self.beside + self.pin / 2.0 * (1.0 - math.cos(angle))
        return straight - (self.radius - math.sqrt(self.radius**2 - to_side**2))


def asme_bth_1(eye: RoundEye, yield_strength: float, ultimate_strength: float) -> dict[EyeMode, float]:
    """Return what an eye bears in each mode by the strengths that ASME BTH-1 divides by its design factor.

    The standard divides bearing by its design factor N_d, and all others by 1.20 N_d.

    Parameters
    ----------
    eye : Eye
    yield_strength, ultimate_strength : float
        [MPa]

    Returns
    -------
    dict of EyeMode to float
        Forces [N].

    References
    ----------
    ASME BTH-1, Design of Below-the-Hook Lifting Devices, section 3-3.3.1, equations 3-45 to 3-53 (2014), and equation
    C3-2 of its commentary for the round edge.
    """
    one_mm = eye.thickness * ultimate_strength
    about = eye.beside
    effective = min(about, about * 0.6 * ultimate_strength / yield_strength * math.sqrt(eye.hole / about))
    return {
        EyeMode.NET_SECTION: eye.loose * 2.0 * effective * one_mm,
        EyeMode.DISHING: eye.loose * 2.0 * 4.0 * eye.wall * one_mm,
        EyeMode.FRACTURE: eye.loose * (1.13 * about + 0.92 * about / (1.0 + about / eye.hole)) * one_mm,
        EyeMode.SHEAR_OUT: 0.70 * 2.0 * eye.shear_plane * one_mm,
        EyeMode.BEARING: 1.25 * yield_strength * eye.pin * eye.thickness,
    }


def en_1993_1_8(eye: RoundEye, yield_strength: float, pin_yield: float) -> dict[EyeMode, float]:
    """Return what an eye bears by EN 1993-1-8, without partial factors.

    Table 3.9, type A, asks for a ≥ F/(2 t f_y) + 2 d_0/3 from the hole to the end and c ≥ F/(2 t f_y) + d_0/3 to the
    side. Solved for F these are forces; both distances are b of a round eye. Table 3.10 has bearing, 1.5 t d f_y.

    Parameters
    ----------
    eye : Eye
    yield_strength : float
        Of the eye [MPa].
    pin_yield : float
        Of its pin [MPa]; bearing is on the weaker of both.

    Returns
    -------
    dict of EyeMode to float
        Forces [N].

    References
    ----------
    EN 1993-1-8:2005, tables 3.9 (type A, given thickness) and 3.10.
    """
    one_mm = 2.0 * eye.thickness * yield_strength
    return {
        EyeMode.END: one_mm * max(eye.beside - 2.0 * eye.hole / 3.0, 0.0),
        EyeMode.SIDE: one_mm * max(eye.beside - eye.hole / 3.0, 0.0),
        EyeMode.BEARING: 1.5 * eye.thickness * eye.pin * min(yield_strength, pin_yield),
    }


@dataclass(frozen=True, kw_only=True)
class EyeStrength:
    """What an eye of a link bears.

    Attributes
    ----------
    name : str
        Of its point.
    modes : mapping of EyeMode to Band
        Forces along its shank [N].
    shanks : tuple of (float, float)
        Unit vectors from its hole to what holds it, in the link's frame; one of an eye that ends a bar, none of a hole
        that is as well held all about.
    across : float
        Largest share that a force across the shank takes off, as so much times the sine of its angle.
    without : mapping of EyeMode to Reason
        Why nothing is known of how far the formulas of these modes may be off.
    relieved : bool
        Whether a force into a shank has no edge ahead, so that straight into it bearing alone is left.
    undrawn : Reason or None
        Which of its proportions limit analysis has not tried, so that no check of it passes.
    """

    name: str
    modes: Mapping[EyeMode, Band]
    shanks: tuple[tuple[float, float], ...]
    across: float
    without: Mapping[EyeMode, Reason] = field(default_factory=dict)
    relieved: bool = True
    undrawn: Reason | None = None

    def _off_shanks(self, force: Real) -> tuple[Real, Real]:
        """Return the angles [rad] between a force and the pull off the shank that it draws straightest, and least."""
        to = np.arctan2(force[..., 1], force[..., 0])
        if not self.shanks:
            return np.zeros_like(to), np.zeros_like(to)
        angles = np.stack([np.abs(np.angle(np.exp(1j * (to - math.atan2(-y, -x))))) for x, y in self.shanks])
        return angles.min(axis=0), angles.max(axis=0)

    def off_shank(self, force: Real) -> Real:
        """Return the angle between a pin's force and the pull that draws the eye straight off its shank.

        Parameters
        ----------
        force : ndarray, shape (..., 2)
            On the eye, in the link's frame [N].

        Returns
        -------
        ndarray, shape (...)
            [rad]; of several shanks from that into which the force presses least off its middle, else from that which
            the force draws straightest.
        """
        drawn, pressed = self._off_shanks(force)
        return np.asarray(np.where(self.relieved & (pressed >= math.pi - INTO_SHANK), pressed, drawn))

    def factors(self, force: Real) -> tuple[dict[EyeMode, Real], Real]:
        """Return by what each mode bears more than a pin's force, and the angle of the force.

        Parameters
        ----------
        force : ndarray, shape (..., 2)
            On the eye, in the link's frame [N].

        Returns
        -------
        tuple of (dict, ndarray)
            EyeMode -> value, least and largest of its factor (3, ...), ∞ where it does not arise; ``off_shank`` (...).
        """
        size, (drawn, pressed) = np.linalg.norm(force, axis=-1), self._off_shanks(force)
        into = self.relieved & (pressed >= math.pi - INTO_SHANK)
        beside = np.where(into, np.sin(pressed) / math.sin(INTO_SHANK), 1.0)
        found = {}
        for mode, strength in self.modes.items():
            acts = size
            bears = np.stack([np.full_like(size, x) for x in (strength.value, strength.low, strength.high)])
            if mode is not EyeMode.BEARING:
                acts = np.where(beside > STRAIGHT, beside * size, 0.0)
                bears[1] *= 1.0 - self.across * np.sin(drawn)
            found[mode] = np.divide(bears, acts, out=np.full_like(bears, np.inf), where=acts > 0.0)
        return found, self.off_shank(force)


@dataclass(frozen=True, kw_only=True)
class EyeFactors:
    """By what an eye bears more than the force of its pin.

    Attributes
    ----------
    eye : str
        Name of its point.
    force : float
        Of the pin [N].
    angle : float
        From the pull straight off the shank [degrees].
    factors : mapping of EyeMode to Band
        Of the modes that arise; none without a force.
    undrawn : Reason or None
        As of ``EyeStrength``.
    """

    eye: str
    force: float
    angle: float
    factors: Mapping[EyeMode, Band]
    undrawn: Reason | None = None

    @property
    def worst(self) -> tuple[EyeMode, Band] | None:
        """The mode whose least factor is the least, and the band of the least of all; None without a force."""
        if not self.factors:
            return None
        mode = min(self.factors, key=lambda one: self.factors[one].low)
        return mode, Band.least(tuple(self.factors.values()))
