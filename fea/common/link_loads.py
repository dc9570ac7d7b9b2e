"""What acts on one link as a solid, in the link's own frame: the input of ``solve_solid``."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, kw_only=True, eq=False)
class PinLoad:
    """What the pin in the hole at ``name`` does to the link.

    centre     (3,) point on the pin's axis at the link's mid-plane [mm]
    diameter   of the hole; of the pin where it stands in a slot [mm]
    wrench     (6,) Fx, Fy, Fz [N] and Mx, My, Mz [N mm] about ``centre``; Mz enters like a drive couple
    slotted    True for a pin in a slot along x, which can neither push along x nor turn the link
    """

    name: str
    centre: NDArray[np.float64]
    diameter: float
    wrench: NDArray[np.float64]
    slotted: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class DriveCouple:
    """A torque [N mm] about z, counter-clockwise positive, on the link at the pin ``pin``."""

    pin: str
    torque: float


@dataclass(frozen=True, kw_only=True, eq=False)
class EndLoad:
    """A wrench (6,) [N, N mm] about ``point`` (3,) [mm], spread over the patch ``end:<name>``."""

    name: str
    point: NDArray[np.float64]
    wrench: NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class BodyLoad:
    """Weight and inertia: force per mass s − α ẑ × r + ω² r, with r from ``about`` normal to z.

    specific_force         (3,) s = g − a, gravity less the acceleration of ``about`` [mm/s²]
    about                  (3,) a point of the link [mm]
    angular_acceleration   α about z [rad/s²]
    angular_speed          ω about z [rad/s]
    """

    specific_force: NDArray[np.float64]
    about: NDArray[np.float64]
    angular_acceleration: float = 0.0
    angular_speed: float = 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class LineLoad:
    """A load spread along the link's axis (y = z = 0) between two stations, varying linearly between them.

    first, last   stations [mm], first < last
    intensity     (2, 3) force per length at the first and at the last station [N/mm]
    """

    first: float
    last: float
    intensity: NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkLoads:
    """All loads of one load case on one link; together they must balance."""

    name: str
    pins: tuple[PinLoad, ...] = ()
    couples: tuple[DriveCouple, ...] = ()
    ends: tuple[EndLoad, ...] = ()
    bodies: tuple[BodyLoad, ...] = ()
    lines: tuple[LineLoad, ...] = ()
