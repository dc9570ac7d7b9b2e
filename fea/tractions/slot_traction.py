"""The push of a pin on the flank of the slot in which it slides, as a traction whose resultant is the load's.

Without friction the pin is free along the slot, so its force is normal to it: p(s) = p0 cos(π s/w) over a length w of
the flank about the place where the pin stands, even along the pin. True contact is a line, so w stands for it
(``PressureLaw.patch``); tests/verification/test_slotted_bar.py holds what that choice is worth. Friction is a traction
along the flank in proportion to that pressure.
"""

import math

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.fea.tractions.bore_wall import LARGEST_CORRECTION, bore_middle
from alula.fea.tractions.traction import wrench_density
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import shifted
from alula.loads.records.bearing import PressureLaw

Density = NDArray[np.float64]

DEGREE = 16
"""Of the integration over a slot's wall, since a patch may be as short as an element: it then misses its moment by up
to 0.5 % of force times half its length before that is mended, with degree 8 by 2.3 %."""


def flank_pressure(wall: SurfaceQuadrature, centre: NDArray[np.float64], length: float, side: float) -> Density:
    """Return the pressure on one flank of a slot.

    It counts per projected area, so that a patch that reaches round the end of the slot still pushes along y alone.

    Parameters
    ----------
    wall : SurfaceQuadrature
        Of the slot.
    centre : ndarray, shape (3,)
        Of the pressure [mm].
    length : float
        Of the pressure along the slot [mm].
    side : float
        1 for the flank at y > 0, -1 for that at y < 0.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Pressure of unit peak.
    """
    along = wall.x[..., 0] - centre[0]
    near = np.abs(along) < length / 2.0
    size = np.where(near, np.cos(math.pi * along / length), 0.0) * np.maximum(-side * wall.normals[..., 1], 0.0)
    return np.asarray(size[..., None] * np.array([0.0, side, 0.0]))


def slot_traction(wall: SurfaceQuadrature, pin: PinLoad, law: PressureLaw) -> Density:
    """Return the pressure of a pin in a slot that delivers its wrench, but for Fz.

    The force Fy and the moment Mx about the slot's axis are one pressure that varies linearly along the pin, so that it
    is on one flank up to a moment of Fy t/6, and beyond on both; friction along the flank is even along the pin.
    Amplitude and slopes along slot and pin are solved on the meshed flank, so that force and moment are exact. In a
    slot whose middle lies off the link's plane of forces, heights count from its middle, and the force's moment about
    it is added. What else the wrench holds is rounding, or small on a deformed shape, and comes as a traction of the
    rigid-body fields.

    Parameters
    ----------
    wall : SurfaceQuadrature
        Of the slot.
    pin : PinLoad
        What the pin does to the link.
    law : PressureLaw
        Of the pressure's length.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Traction [MPa].

    Raises
    ------
    CannotRunError
        For a wrench that a slot cannot take, or a flank meshed too coarsely.
    """
    middle = bore_middle(wall, pin.centre)
    length = law.patch(pin.diameter)
    rubbed = _rubbed(wall, pin, middle, length)
    pushed_with = about_middle(wall, pin) - wall.wrench(rubbed, middle)
    refuse_what_slides(pin, pushed_with[None])
    fx, fy, _, mx, my, mz = pushed_with
    # From -1 to 1 over the pressure's length, and over the height of the wall.
    arm = (wall.x - middle) / np.array([length / 2.0, 1.0, np.abs(wall.x[..., 2] - middle[2]).max()])

    density = rubbed + wrench_density(wall, middle, np.array([fx, 0.0, 0.0, 0.0, my, mz]))
    if fy == 0.0 and mx == 0.0:
        return density
    per_length = along_pin(wall, pushed_with, arm[..., 2:])
    sides = [flank_pressure(wall, middle, length, side) for side in (1.0, -1.0)]
    pushed = np.abs(per_length) * np.where(per_length > 0.0, *sides)
    even = float(np.abs(per_length).max()) * sides[0 if (fy or -mx) > 0.0 else 1]
    return density + _exact(wall, pin, middle, pushed, [even, arm[..., 2:] * even, arm[..., :1] * even], (fy, mx))


def about_middle(wall: SurfaceQuadrature, pin: PinLoad) -> NDArray[np.float64]:
    """Return the wrench of a pin about the middle of its slot's wall, at the place where it stands.

    Parameters
    ----------
    wall : SurfaceQuadrature
        Of the slot.
    pin : PinLoad
        At one or more poses.

    Returns
    -------
    ndarray, shape (..., 6)
        [N, N mm]
    """
    place = pin.centre.reshape(-1, 3)[0]
    return shifted(pin.wrench, place - bore_middle(wall, place))


def along_pin(wall: SurfaceQuadrature, pushed: NDArray[np.float64], height: NDArray[np.float64]) -> Density:
    """Return the force along y at heights of a slot's wall, over its mean: it varies linearly.

    Parameters
    ----------
    wall : SurfaceQuadrature
        Of the slot.
    pushed : ndarray, shape (..., 6)
        Wrenches of the pin about the middle [N, N mm].
    height : ndarray
        From -1 to 1, of a shape that goes with that of the wrenches.

    Returns
    -------
    ndarray
        [N]
    """
    half = float(np.ptp(wall.x[..., 2])) / 2.0
    return np.asarray(pushed[..., 1] - 3.0 * pushed[..., 3] / half * height)


def refuse_what_slides(pin: PinLoad, pushed: NDArray[np.float64]) -> None:
    """Refuse what a pin that is free to slide along its slot and to turn in it cannot do.

    Parameters
    ----------
    pin : PinLoad
        At one or n poses.
    pushed : ndarray, shape (n, 6)
        Its wrenches without friction, about the middle of the wall [N, N mm].

    Raises
    ------
    CannotRunError
        For a push along the slot, or a moment about y or z.
    """
    every = pin.wrench.reshape(-1, 6)
    size = np.linalg.norm(every[:, :3], axis=1) + np.linalg.norm(every[:, 3:], axis=1) / pin.diameter
    taken = np.abs(pushed[:, [0, 4, 5]] / [1.0, pin.diameter, pin.diameter]).max(axis=1)
    bad = np.flatnonzero(taken > LARGEST_CORRECTION * size)
    if bad.size:
        fx, _, _, _, my, mz = pushed[bad[0]]
        raise CannotRunError(
            f"the pin in the slot at {pin.name} would have to push along it with {fx:.4g} N or turn it with "
            f"{my:.4g} N mm about y and {mz:.4g} N mm about z, which a pin free to slide and turn cannot do"
        )


def _rubbed(wall: SurfaceQuadrature, pin: PinLoad, middle: NDArray[np.float64], length: float) -> Density:
    """Return the traction of friction along the flank that the pin pushes on."""
    across, friction = float(pin.wrench[1]), float(pin.friction)
    if friction == 0.0 or across == 0.0:
        return np.zeros_like(wall.x)
    side = math.copysign(1.0, across)
    along = np.abs(flank_pressure(wall, middle, length, side))[..., [1, 0, 2]]
    return np.asarray(along * (friction / wall.wrench(along, middle)[0]))


def _exact(
    wall: SurfaceQuadrature,
    pin: PinLoad,
    middle: NDArray[np.float64],
    pushed: Density,
    mended_by: list[Density],
    target: tuple[float, float],
) -> Density:
    """Return a pressure, scaled and mended by three fields along y so that it delivers Fy and Mx and no Mz."""

    def delivered(field: Density) -> NDArray[np.float64]:
        return np.asarray(wall.wrench(field, middle)[[1, 3, 5]] / [1.0, pin.diameter, pin.diameter])

    wanted, got = np.array([target[0], target[1] / pin.diameter, 0.0]), delivered(pushed)
    columns = np.array([delivered(field) for field in mended_by]).T
    if got.any() and np.linalg.cond(columns) < 1e9:
        scale = float(wanted @ got) / float(got @ got)
        factors = np.linalg.solve(columns, wanted - scale * got)
        if np.abs(factors).max() <= LARGEST_CORRECTION * scale:
            return np.asarray(scale * pushed + sum(f * field for f, field in zip(factors, mended_by, strict=True)))
    raise CannotRunError(
        f"the slot at {pin.name} is meshed too coarsely at x = {pin.centre[0]:.4g} mm to carry the pin's pressure; "
        "refine it"
    )
