"""Force densities on surfaces and in the volume of a link whose resultants are those of the given loads, exactly.

Every function returns a density (k, q, 3) at the points of a quadrature: MPa on surfaces, N/mm³ in the volume.
"""

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import ALONG, PinLoad
from alula.fea.elements.quadrature import Quadrature, SurfaceQuadrature
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.features import OFF_PLANE
from alula.loads.records.applied import BodyForce, LineLoad, shifted
from alula.loads.records.bearing import PressureLaw

Transfer = Literal["eye-faces", "bore-shear"]
Density = NDArray[np.float64]

LARGEST_CORRECTION = 0.1
"""A meshed surface may miss the wrench by this part of the load before its mesh is refused."""
_NOTHING, _CORRECTIONS = 1e-13, 60
"""Share of a wrench that counts for nothing, and the most corrections to reach it."""
_PRESSED = {
    True: np.array([1.0, 1.0, 0.0, 1.0, 1.0, 0.0]),
    False: np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]),
}
"""Components of the wrench that the pressure itself delivers, with a moment and without."""


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

    Force and moment are one pressure p0(z) law(θ − α(z)) n, whose resultant per length varies linearly along the pin,

        q(z) = F/L + D z/I,    D = ∫ z q dz = (My, −Mx),

    with the wall's length L and its second moment I about its middle. So it stands on one side of the hole while a
    moment in the plane of the force is at most F L/6, and beyond that on both. q is corrected until the meshed
    hole, whose facets turn and shorten the resultant, and whose wall may be longer on one side, has the wrench.
    What then remains (a moment of unsymmetric facets) is removed by a traction of the rigid-body fields. In a hole
    whose middle lies off the link's plane of forces, heights count from its middle, and the force's moment about
    that middle is added to the pin's.

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
    angle, height = np.arctan2(arm[..., 1], arm[..., 0]), arm[..., 2]
    pushes = np.array([pin.wrench[0], pin.wrench[1], 0.0, pin.wrench[3], pin.wrench[4], 0.0])
    target = shifted(pushes, pin.centre - middle)
    if not target.any():
        return np.zeros_like(bore.x)
    size = _gap(target, pin.diameter)
    tilts = float(np.hypot(*target[3:5])) > _NOTHING * size * pin.diameter
    around = 2.0 * math.pi * radius
    length, second = float(bore.w.sum()) / around, float((bore.w * height**2).sum()) / around
    unit = law.peak(force=1.0, diameter=pin.diameter, thickness=1.0)
    push, slope = np.zeros(2), np.zeros(2)
    missing, last = target, math.inf
    for _ in range(_CORRECTIONS):
        push = push + missing[:2] / length
        slope = slope + (np.array([missing[4], -missing[3]]) / second if tilts else 0.0)
        per_length = push + height[..., None] * slope
        size_here = np.hypot(per_length[..., 0], per_length[..., 1])
        aimed = np.arctan2(per_length[..., 1], per_length[..., 0])
        density = -(unit * size_here * law.shape(angle - aimed))[..., None] * bore.normals
        missing = target - bore.wrench(density, middle)
        left = _gap(missing * _PRESSED[tilts], pin.diameter)
        if left <= _NOTHING * size or left >= last:
            break
        last = left
    ends = np.array([-0.5, 0.5]) * float(np.ptp(height)) if tilts else np.zeros(1)
    pushed = push + ends[:, None] * slope
    bare = first_opening(angle, np.arctan2(pushed[:, 1], pushed[:, 0]))
    if bare is not None:
        raise CannotRunError(into_opening(pin.name, bare))
    _limit(missing, target, pin.diameter, f"the hole at pin {pin.name}")
    return np.asarray(density + wrench_density(bore, middle, missing))


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
    own, density = line_density_between(volume, load)
    found = np.zeros_like(volume.x)
    found[own] = density
    return found


def line_density_between(volume: Quadrature, load: LineLoad) -> tuple[NDArray[np.bool_], Density]:
    """Return the force per volume of a load spread along the axis in the elements that bear some of it.

    Parameters
    ----------
    volume, load
        As of ``line_density``.

    Returns
    -------
    tuple of ndarray of bool (k,) and ndarray (l, q, 3)
        Which elements bear it, and the density in these [N/mm³].
    """
    length, element = load.end - load.start, volume.measure / len(volume.w)
    places = (volume.x[..., 0] - load.start) / length
    own = np.asarray(((places >= 0.0) & (places < 1.0)).any(axis=1))
    part, place = volume.only(own), places[own]
    inside = (place >= 0.0) & (place < 1.0)
    slices = int(np.clip(length / (2.0 * element ** (1.0 / 3.0)), 1, 40))
    number = np.clip((place * slices).astype(int), 0, slices - 1)
    held = np.bincount(number[inside], weights=part.w[inside], minlength=slices)
    if not (held > 0.0).all():
        raise CannotRunError(
            f"a load spread from x = {load.start:g} mm to {load.end:g} mm lies partly outside of the link"
        )
    weight = np.where(inside, length / slices / held[number], 0.0)
    share = place[..., None]
    density = weight[..., None] * ((1.0 - share) * load.at_start + share * load.at_end)
    origin = np.zeros(3)
    missing = load.about_origin(ALONG) - part.wrench(density, origin)
    return own, np.asarray(density + wrench_density(part, origin, missing, weight))


def first_opening(wall: NDArray[np.float64], directions: NDArray[np.float64]) -> float | None:
    """Return the first direction within ``OPENING`` of which a hole has no wall.

    Parameters
    ----------
    wall : ndarray
        Angles at which there is some [rad].
    directions : ndarray, shape (n,)
        Angles [rad].

    Returns
    -------
    float or None
        None where all have a wall.
    """
    known, wanted = np.sort(np.ravel(wall) % (2.0 * math.pi)), directions % (2.0 * math.pi)
    around = np.concatenate([known[-1:] - 2.0 * math.pi, known, known[:1] + 2.0 * math.pi])
    after = np.searchsorted(around, wanted).clip(1, len(around) - 1)
    nearest = np.minimum(wanted - around[after - 1], around[after] - wanted)
    bare = np.flatnonzero(nearest > OPENING)
    return float(directions[bare[0]]) if bare.size else None


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
