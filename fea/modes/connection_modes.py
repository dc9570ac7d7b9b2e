"""What fixes a link to a shaft, a horn or another link bears, way by way, over what goes through it.

``docs/theory/connections.md`` has every formula with its source, and says what was derived here. All stresses are
nominal ones of closed forms, in proportion to what goes through the connection.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.geometry.materials.material import Material
from alula.loads.records.connection import Bond, CrossPin, Flat, Press, Screws

Real = NDArray[np.float64]
BESIDE_ROARK = 1.06
"""By what the stress of numerical solutions is above Roark's polynomial of a shaft with a flat, at the most: 1.059, at
flats of 0.01 to 0.04 of the radius (``tests/unit/fea/test_connection_modes.py``)."""
ROUNDING = 1e-6
"""Share of the other loads below which a load that nothing holds is taken for rounding."""


def _over(borne: float, stress: Any) -> Any:
    """Return what is borne over a stress; infinity where there is none."""
    some = stress > 0.0
    return np.where(some, borne / np.where(some, stress, 1.0), np.inf)


class ConnectionMode(StrEnum):
    """A way in which a connection gives way; its value says for people what it is."""

    BOND = "shear of the bond"
    SLIP = "slip of the shaft"
    GAP = "gap between shaft and hole on one side"
    FLAT = "pressure on the flat"
    CROSS_PIN = "shear of the cross pin"
    HUB = "pressure of the cross pin on the hub"
    IN_SHAFT = "pressure of the cross pin on the shaft"
    SCREWS = "tension and shear of the screws"
    HOLES = "pressure of the screws on their holes"
    SHAFT = "torsion of the shaft"
    NOT_HELD = "a load that it is not made to hold"


@dataclass(frozen=True, kw_only=True)
class Transmitted:
    """What goes through a connection, about its axis; sizes alone, at one pose or at n.

    Attributes
    ----------
    torque : array
        About the axis [N mm].
    force : array
        Across the axis [N].
    thrust : array
        Along the axis [N].
    couple : array
        About axes across it, in the middle of the link [N mm].
    """

    torque: Real
    force: Real
    thrust: Real
    couple: Real


@dataclass(frozen=True, kw_only=True)
class ConnectionFactors:
    """By what a connection bears more than what goes through it.

    Attributes
    ----------
    link : str
        That is fixed.
    load : Transmitted
        In one pose.
    factors : mapping of ConnectionMode to Band
        Of the modes that arise; none where nothing goes through it.
    """

    link: str
    load: Transmitted
    factors: Mapping[ConnectionMode, Band]


@dataclass(frozen=True, kw_only=True)
class Strength:
    """What one material bears.

    Attributes
    ----------
    stress : float
        The strength of its safety factor [MPa].
    brittle : bool
        Whether that is set against the largest principal stress, in place of von Mises'.
    """

    stress: float
    brittle: bool

    @classmethod
    def of(cls, material: Material, share: float = 1.0) -> "Strength":
        """Return that of a material.

        Parameters
        ----------
        material : Material
        share : float, optional
            Of its strength.

        Returns
        -------
        Strength
        """
        return cls(stress=share * material.allowable, brittle=material.brittle)

    def over(self, shear: Any, tension: Any = 0.0) -> Any:
        """Return the strength over the equivalent of a shear stress and a tension.

        Parameters
        ----------
        shear, tension : float or array
            [MPa]

        Returns
        -------
        float or array
        """
        if self.brittle:
            return _over(self.stress, tension / 2.0 + np.hypot(tension / 2.0, shear))
        return _over(self.stress, np.sqrt(tension**2 + 3.0 * shear**2))


def bond(way: Bond, shaft: float, strength: float, load: Transmitted) -> dict[ConnectionMode, Any]:
    """Return by what a bond bears more: a sleeve about the shaft, or a glued face.

    Parameters
    ----------
    way : Bond
    shaft : float
        Its diameter [mm].
    strength : float
        In shear [MPa].
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array
    """
    if way.length is not None:
        area = math.pi * shaft * way.length
        return {ConnectionMode.BOND: _over(strength, np.hypot(2.0 * load.torque / shaft, load.thrust) / area)}
    assert way.outer_diameter is not None
    outer, inner = way.outer_diameter, way.inner_diameter
    area, polar = math.pi / 4.0 * (outer**2 - inner**2), math.pi / 32.0 * (outer**4 - inner**4)
    used = (load.force / area + load.torque * outer / 2.0 / polar) / strength
    pulled = load.thrust / area + load.couple * outer / polar
    if way.tensile_strength is None:
        return {ConnectionMode.BOND: _over(1.0, used), **_not_held(pulled / strength, used)}
    return {ConnectionMode.BOND: _over(1.0, used + pulled / way.tensile_strength)}


def _not_held(share: Any, of: Any) -> dict[ConnectionMode, Any]:
    """Return a factor of infinity where a load is none but for rounding, and NaN, not known, elsewhere."""
    return {ConnectionMode.NOT_HELD: np.where(share > ROUNDING * of, np.nan, np.inf)}


def press(way: Press, shaft: float, pressure: float, friction: float, load: Transmitted) -> dict[ConnectionMode, Any]:
    """Return by what a press fit or a clamp bears more before it slips, or leaves its shaft on one side.

    Parameters
    ----------
    way : Press
    shaft : float
        Its diameter [mm].
    pressure : float
        [MPa]
    friction : float
        Its coefficient.
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array
    """
    area = math.pi * shaft * way.length
    sideways = 2.0 * load.force / area + 12.0 * load.couple / (area * way.length)
    return {
        ConnectionMode.SLIP: _over(friction * pressure, np.hypot(2.0 * load.torque / shaft, load.thrust) / area),
        ConnectionMode.GAP: _over(pressure, sideways),
    }


def flat(way: Flat, shaft: float, strength: float, load: Transmitted) -> dict[ConnectionMode, Any]:
    """Return by what the flat of a D-shaped shaft bears more.

    Parameters
    ----------
    way : Flat
    shaft : float
        Its diameter [mm].
    strength : float
        Of the softer of link and shaft [MPa].
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array
    """
    width = 2.0 * math.sqrt((shaft - way.across) * way.across)
    used = (12.0 * load.torque / width + load.force) / (way.length * width) / strength
    along = load.thrust / (way.length * width) / strength
    return {ConnectionMode.FLAT: _over(1.0, used), **_not_held(along, used)}


def cross_pin(
    way: CrossPin, shaft: float, pin: Strength, in_hub: float, in_shaft: float, load: Transmitted
) -> dict[ConnectionMode, Any]:
    """Return by what a cross pin bears more, in double shear, and what it presses on.

    Parameters
    ----------
    way : CrossPin
    shaft : float
        Its diameter [mm].
    pin : Strength
        Of the pin.
    in_hub, in_shaft : float
        Strength of hub and shaft against its pressure, or of the pin where that is less [MPa].
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array

    References
    ----------
    INGGO, cross pin under torque (TEDATA, 2023), in words; written out in ``docs/theory/connections.md``.
    """
    size, hub = way.diameter, way.hub_diameter
    sheared = np.hypot(load.torque / shaft, load.thrust / 2.0) / (math.pi / 4.0 * size**2)
    on_shaft = np.hypot(6.0 * load.torque / shaft**2, load.thrust / shaft) / size
    on_hub = np.hypot(4.0 * load.torque / (hub**2 - shaft**2), load.thrust / (hub - shaft)) / size
    return {
        ConnectionMode.CROSS_PIN: pin.over(sheared),
        ConnectionMode.IN_SHAFT: _over(in_shaft, on_shaft),
        ConnectionMode.HUB: _over(in_hub, on_hub),
    }


def screws(way: Screws, screw: Strength, in_hole: float, load: Transmitted) -> dict[ConnectionMode, Any]:
    """Return by what screws on a circle bear more, and their holes.

    Parameters
    ----------
    way : Screws
    screw : Strength
        Of one of them.
    in_hole : float
        Strength of the link against their pressure, or of the screws where that is less [MPa].
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array
    """
    radius, area = way.circle_diameter / 2.0, math.pi / 4.0 * way.diameter**2
    across = load.force / way.count + load.torque / (way.count * radius)
    along = load.thrust / way.count
    tilting = load.couple / (way.count * radius)
    found = {ConnectionMode.HOLES: _over(in_hole, across / (way.diameter * way.length))}
    if way.count == 2:  # they hold no couple about the line through both
        found |= _not_held(tilting, across)
    else:
        along = along + 2.0 * tilting
    return found | {ConnectionMode.SCREWS: screw.over(across / area, along / area)}


def beside_hole(hole: float) -> float:
    """Return what a hole across a round shaft leaves of the polar moment of its section.

    Parameters
    ----------
    hole : float
        Its diameter over the shaft's.

    Returns
    -------
    float
        Share of the full section's, which a strip as wide as the hole is cut from; integrated here.
    """
    angle = math.asin(hole)
    return 1.0 - 2.0 / math.pi * (angle + math.sin(2.0 * angle) / 3.0 - math.sin(4.0 * angle) / 12.0)


def shaft_torsion(
    way: Bond | Press | Flat | CrossPin, shaft: float, strength: Strength, load: Transmitted
) -> dict[ConnectionMode, Any]:
    """Return by what the shaft bears more in torsion: beside a cross pin's hole, without its notch or that of a flat.

    Parameters
    ----------
    way : Bond, Press, Flat or CrossPin
    shaft : float
        Its diameter [mm].
    strength : Strength
        Of the shaft.
    load : Transmitted

    Returns
    -------
    dict of ConnectionMode to array

    References
    ----------
    Roark's Formulas for Stress and Strain, table of torsion, circular shaft with one flat: T B/r³, as quoted elsewhere.
    """
    radius = shaft / 2.0
    if isinstance(way, Flat):
        cut = (shaft - way.across) / radius
        shape = BESIDE_ROARK * np.polynomial.Polynomial([0.6366, 1.7598, -5.4897, 14.062, -14.510, 6.434])(cut)
    else:
        bore = way.shaft_bore / shaft if isinstance(way, Press) else 0.0
        left = 1.0 - bore**4 if not isinstance(way, CrossPin) else beside_hole(way.diameter / shaft)
        shape = 2.0 / math.pi / left
    return {ConnectionMode.SHAFT: strength.over(shape * load.torque / radius**3)}
