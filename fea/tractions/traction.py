"""Force densities on surfaces and in the volume of a link whose resultants are those of the given loads, exactly.

Every function returns a density (k, q, 3) at the points of a quadrature: MPa on surfaces, N/mm³ in the volume.
"""

import math
from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fea.common.link_loads import ALONG, PinLoad
from fea.elements.quadrature import Quadrature, SurfaceQuadrature
from geometry.base.errors import CannotRunError
from geometry.bodies.features import OFF_PLANE
from loads.records.applied import BodyForce, LineLoad, shifted
from loads.records.bearing import PressureLaw

Transfer = Literal["eye-faces", "bore-shear"]
Density = NDArray[np.float64]

LARGEST_CORRECTION = 0.1
"""A meshed surface may miss the wrench by this part of the load before its mesh is refused."""
_UNEVEN, _CORRECTIONS = 0.002, 30
"""Part of the load that elements of unequal size may miss (1e-3 was measured), and the most attempts to reach it."""


OPENING = math.radians(15.0)
"""Angle on both sides of a pressure's peak within which a hole must have some wall: half of what the key of a bore of
5 to 50 mm takes of its circle at most (DIN 6885: its width is a third of the diameter or less, mostly a quarter)."""


def wrench_density(
    quadrature: Quadrature, point: NDArray[np.float64], wrench: NDArray[np.float64], weight: Density | None = None
) -> Density:
    """Return the density w(x) (a + b × r) that delivers a wrench exactly.

    With r from the weighted centroid the 6×6 Gram matrix of the rigid-body fields falls apart into the measure A = ∫w
    and the inertia J = ∫w (r² I − r rᵀ), hence a = F/A and J b = M.

    Parameters
    ----------
    quadrature : Quadrature
        Of the surface or volume.
    point : ndarray, shape (3,)
        About which the wrench acts [mm].
    wrench : ndarray, shape (6,)
        Force [N] and moment [N mm].
    weight : ndarray or None, shape (k, q), optional
        w at the points; 1 by default.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Density.

    Raises
    ------
    CannotRunError
        If the surface cannot carry every component.
    """
    measure = (quadrature.w if weight is None else quadrature.w * weight).ravel()
    x = quadrature.x.reshape(-1, 3)
    centre = measure @ x / measure.sum()
    arm = x - centre
    second = arm.T @ (measure[:, None] * arm)
    inertia = np.trace(second) * np.eye(3) - second
    spread = np.linalg.eigvalsh(inertia)
    if spread[0] <= 1e-8 * spread[2]:
        raise CannotRunError("a loaded surface is too narrow to carry a moment about its length; enlarge it")
    moment = wrench[3:] - np.cross(centre - point, wrench[:3])
    turn = np.cross(np.linalg.solve(inertia, moment), np.eye(3))  # rows b × e_i, so that b × r = r @ turn
    density = (wrench[:3] / measure.sum() + arm @ turn).reshape(quadrature.x.shape)
    return np.asarray(density if weight is None else density * weight[..., None])


def pin_traction(bore: SurfaceQuadrature, pin: PinLoad, law: PressureLaw) -> Density:
    """Return the pressure of a pin that delivers Fx, Fy, Mx and My of its wrench, and nothing else.

    The force is a pressure p0 law(θ − α) n, constant along the pin; the moment is that of a pin tilted
    in its hole, pressing in the direction β above the mid-plane and in β + π below it, in proportion
    to the height: p1 |z| law(θ − β). α, p0, β and p1 are solved on the meshed hole, whose facets would
    else turn and shorten the resultant; together where its wall is longer on one side and they miss the
    wrench by more than ``LARGEST_CORRECTION``. What then remains (a moment of unsymmetric facets) is removed
    by a traction of the rigid-body fields. In a hole whose middle lies off the link's plane of forces,
    heights count from its middle, and the force's moment about that middle is added to the pin's.

    Parameters
    ----------
    bore : SurfaceQuadrature
        The hole on the mesh.
    pin : PinLoad
        What the pin does to the link.
    law : PressureLaw
        Of the pressure.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Traction [MPa].

    Raises
    ------
    CannotRunError
        If the surface is not that hole, meshed too coarsely, or open where the pin pushes.
    """
    middle = bore_middle(bore, pin.centre)
    arm = bore.x - middle
    radius = float((bore.w * np.hypot(arm[..., 0], arm[..., 1])).sum() / bore.w.sum())
    if not 0.9 < 2.0 * radius / pin.diameter < 1.1:
        raise CannotRunError(
            f"the hole at pin {pin.name} measures {2.0 * radius:.4g} mm on the mesh, not {pin.diameter:.4g} mm"
        )
    angle = np.arctan2(arm[..., 1], arm[..., 0])
    height = arm[..., 2]

    def pushed(direction: float) -> Density:
        return np.asarray(-law.shape(angle - direction)[..., None] * bore.normals)

    def tilted(direction: float) -> Density:
        pressure = np.abs(height) * law.shape(angle - direction - np.where(height < 0.0, math.pi, 0.0))
        return np.asarray(-pressure[..., None] * bore.normals)

    def force(density: Density) -> NDArray[np.float64]:
        return bore.wrench(density, middle)[:2]

    def moment(density: Density) -> NDArray[np.float64]:
        whole = bore.wrench(density, middle)
        return np.array([whole[4], -whole[3]])

    pushes = np.array([pin.wrench[0], pin.wrench[1], 0.0, pin.wrench[3], pin.wrench[4], 0.0])
    target = shifted(pushes, pin.centre - middle)
    aim, allowed = target.copy(), LARGEST_CORRECTION
    for _ in range(_CORRECTIONS):
        density = _directed(pushed, force, angle, aim[:2], pin.name)
        density = density + _directed(tilted, moment, angle, np.array([aim[4], -aim[3]]), pin.name)
        missing = target - bore.wrench(density, middle)
        if _gap(missing, pin.diameter) <= allowed * _gap(target, pin.diameter):
            break
        # The wall is longer on one side, as off a tube's axis: tilting pushes, and pushing tilts.
        aim, allowed = aim + missing, _UNEVEN
    _limit(missing, target, pin.diameter, f"the hole at pin {pin.name}")
    return density + wrench_density(bore, middle, missing)


def bore_middle(bore: SurfaceQuadrature, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point of a hole's axis at the middle of its wall.

    Parameters
    ----------
    bore : SurfaceQuadrature
        The hole on the mesh.
    centre : ndarray, shape (3,)
        Of the pin, in the plane of the link's forces [mm].

    Returns
    -------
    ndarray, shape (3,)
        The middle; ``centre`` itself where it differs by rounding or by uneven elements alone [mm].
    """
    height, reach = float(bore.centroid[2] - centre[2]), float(np.ptp(bore.x[..., 2]))
    return np.asarray(centre + np.array([0.0, 0.0, height if abs(height) > OFF_PLANE * reach else 0.0]))


def thrust_traction(face: SurfaceQuadrature, pin: PinLoad) -> Density:
    """Return the even pressure on an eye's flat face that delivers Fz of the pin, without a moment about its centre.

    Parameters
    ----------
    face : SurfaceQuadrature
        One flat face of the eye.
    pin : PinLoad
        What the pin does to the link.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Traction [MPa].
    """
    target = np.array([0.0, 0.0, pin.wrench[2], 0.0, 0.0, 0.0])
    unit = -face.normals
    density = unit * (pin.wrench[2] / face.wrench(unit, pin.centre)[2])
    return np.asarray(density + wrench_density(face, pin.centre, target - face.wrench(density, pin.centre)))


def couple_traction(surface: SurfaceQuadrature, centre: NDArray[np.float64], torque: float) -> Density:
    """Return the tangential traction c ẑ × r about the pin that delivers a torque about z and no net force.

    Parameters
    ----------
    surface : SurfaceQuadrature
        Both flat faces of the eye (``eye-faces``) or the bore (``bore-shear``).
    centre : ndarray, shape (3,)
        Of the pin [mm].
    torque : float
        About z [N mm].

    Returns
    -------
    ndarray, shape (k, q, 3)
        Traction [MPa].
    """
    target = np.array([0.0, 0.0, 0.0, 0.0, 0.0, torque])
    swirl = np.cross(np.array([0.0, 0.0, 1.0]), surface.x - centre)
    density = swirl * (torque / surface.wrench(swirl, centre)[5])
    return np.asarray(density + wrench_density(surface, centre, target - surface.wrench(density, centre)))


def body_density(volume: Quadrature, load: BodyForce, density: float) -> Density:
    """Return the weight and inertia per volume of a body.

    Parameters
    ----------
    volume : Quadrature
        Of the link.
    load : BodyForce
        Weight and inertia.
    density : float
        Of the material [tonne/mm³].

    Returns
    -------
    ndarray, shape (k, q, 3)
        Force per volume [N/mm³].
    """
    return np.asarray(density * load.per_mass(volume.x))


def line_density(volume: Quadrature, load: LineLoad) -> Density:
    """Return the force per volume of a load spread along the axis, with its exact resultant and moment.

    The force per length is divided by the area of the cross-section, taken in up to 40 slices
    between the stations, so that a wide eye draws no more load than the tube beside it.

    Parameters
    ----------
    volume : Quadrature
        Of the link.
    load : LineLoad
        Spread along the axis.

    Returns
    -------
    ndarray, shape (k, q, 3)
        Force per volume [N/mm³].
    """
    length = load.end - load.start
    x = volume.x[..., 0]
    place = (x - load.start) / length
    inside = (place >= 0.0) & (place < 1.0)
    element = volume.measure / len(volume.w)
    slices = int(np.clip(length / (2.0 * element ** (1.0 / 3.0)), 1, 40))
    number = np.clip((place * slices).astype(int), 0, slices - 1)
    held = np.bincount(number[inside], weights=volume.w[inside], minlength=slices)
    if not (held > 0.0).all():
        raise CannotRunError(
            f"a load spread from x = {load.start:g} mm to {load.end:g} mm lies partly outside of the link"
        )
    weight = np.where(inside, length / slices / held[number], 0.0)
    share = place[..., None]
    density = weight[..., None] * ((1.0 - share) * load.at_start + share * load.at_end)
    origin = np.zeros(3)
    missing = load.about_origin(ALONG) - volume.wrench(density, origin)
    return np.asarray(density + wrench_density(volume, origin, missing, weight))


def _directed(
    pressure: Callable[[float], Density],
    measure: Callable[[Density], NDArray[np.float64]],
    wall: NDArray[np.float64],
    target: NDArray[np.float64],
    pin: str,
) -> Density:
    """Turn and scale a pressure until its measured plane vector (2,) is the target; refuse to push into an opening."""
    size = float(np.hypot(*target))
    if size == 0.0:
        return np.zeros_like(pressure(0.0))
    wanted = math.atan2(target[1], target[0])
    direction = wanted
    for _ in range(100):
        if is_opening(wall, direction):
            raise CannotRunError(into_opening(pin, direction))
        density = pressure(direction)
        got = measure(density)
        if np.hypot(*got) == 0.0:
            break
        error = math.remainder(wanted - math.atan2(got[1], got[0]), 2.0 * math.pi)
        if abs(error) < 1e-13:
            return np.asarray(density * (size / np.hypot(*got)))
        direction += error
    raise CannotRunError(f"the hole at pin {pin} is meshed too coarsely to carry the pin's pressure; refine it")


def is_opening(wall: NDArray[np.float64], direction: float) -> bool:
    """Return True where a hole has no wall within ``OPENING`` of a direction.

    Parameters
    ----------
    wall : ndarray
        Angles at which there is some [rad].
    direction : float
        Angle [rad].

    Returns
    -------
    bool
    """
    return bool(np.cos(wall - direction).max() < math.cos(OPENING))


def into_opening(pin: str, direction: float) -> str:
    """Say that a pin pushes into the opening of its bore.

    Parameters
    ----------
    pin : str
        Its name.
    direction : float
        Angle of the pressure's peak in the link's frame [rad].

    Returns
    -------
    str
        For a message.
    """
    at = round(math.degrees(direction)) % 360
    return (
        f"the pin at {pin} pushes at {at} degrees into the opening of its bore, where "
        "no wall bears it; turn the part in its link, or close the bore in the CAD program"
    )


def _limit(missing: NDArray[np.float64], target: NDArray[np.float64], diameter: float, what: str) -> None:
    size, gap = _gap(target, diameter), _gap(missing, diameter)
    if gap > LARGEST_CORRECTION * size:
        raise CannotRunError(
            f"{what} is meshed too unevenly: its pressure misses the load by {gap / size:.1%}; refine it"
        )


def _gap(wrench: NDArray[np.float64], diameter: float) -> float:
    """Size of a wrench as a force [N]."""
    return float(np.linalg.norm(wrench[:3]) + np.linalg.norm(wrench[3:]) / diameter)
