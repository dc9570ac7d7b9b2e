"""Force densities on surfaces and in the volume of a link whose resultants are those of the given loads, exactly.

Every function returns a density (k, q, 3) at the points of a quadrature: MPa on surfaces, N/mm³ in the volume.
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import ALONG, PinLoad
from alula.fea.elements.quadrature import Quadrature, SurfaceQuadrature
from alula.fea.tractions.bore_wall import BoreWall
from alula.fea.tractions.seated import pressing_law
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import BodyForce, LineLoad
from alula.loads.records.bearing import PressureLaw

Transfer = Literal["eye-faces", "bore-shear"]
TRANSFERS: tuple[Transfer, ...] = ("eye-faces", "bore-shear")
Density = NDArray[np.float64]


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

    What the meshed hole leaves of its wrench (a moment of unsymmetric facets; ``BoreWall``) is removed by a traction of
    the rigid-body fields.

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
    wall = BoreWall.of(bore, pin)
    target = wall.pushes(pin.wrench[None])
    if not target.any():
        return np.zeros_like(bore.x)
    own = pressing_law(pin.seat, law, target[0])
    unit = own.peak(force=1.0, diameter=pin.diameter, thickness=1.0)

    def pressure(push: Density, slope: Density) -> Density:
        along = wall.along(push[0], slope[0], wall.height)
        turned = own.shape(wall.angle - np.arctan2(along[..., 1], along[..., 0]))
        return np.asarray(-(unit * np.hypot(along[..., 0], along[..., 1]) * turned)[..., None] * bore.normals)

    density = pressure(
        *wall.per_length(pin.wrench[None], lambda *along: bore.wrench(pressure(*along), wall.middle)[None])
    )
    return np.asarray(density + wrench_density(bore, wall.middle, target[0] - bore.wrench(density, wall.middle)))


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
