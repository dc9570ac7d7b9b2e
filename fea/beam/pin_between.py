"""Bending and shear of a pin between links in different layers, from what each of its eyes bears.

Each link presses on the pin along the walls of its eye with a force per length that varies linearly and has the joint
force and the link's couple as resultants (a rigid pin in an elastic bore): with A the walls' length, x0 their middle
and I their second moment about it,

    q(z) = F/A + D (z - x0)/I,    D = ∫ (z - x0) q dz,

F and D vectors across the pin. Both add to a beam in equilibrium; its shear force is ∫ q, its bending moment ∫∫ q.
"""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.features import Ring

Real = NDArray[np.float64]

POINTS = 129
"""In every wall and gap, at which the moment is taken; the largest is met within 1e-4."""


def first_moment(wrench: Real) -> Real:
    """Return ∫ z q dz of a force per length across the pin, about the point that a wrench is about.

    Parameters
    ----------
    wrench : ndarray, shape (..., 6)
        [N, N mm]

    Returns
    -------
    ndarray, shape (..., 2)
        Along x and y [N mm].
    """
    return np.stack([wrench[..., 4], -wrench[..., 3]], axis=-1)


def largest_between(
    eyes: Sequence[Ring], levels: Sequence[float], wrenches: Sequence[Real], within: tuple[float, float] | None = None
) -> tuple[Real, Real]:
    """Return the largest bending moment and shear force of a pin, in each of some equilibria.

    Parameters
    ----------
    eyes : sequence of Ring
        Of all links on the pin, about their mid-planes.
    levels : sequence of float
        Heights of these mid-planes [mm].
    wrenches : sequence of ndarray, shape (..., 6)
        What the pin does to each link about the point of its mid-plane [N, N mm]; together they balance.
    within : tuple of 2 float, optional
        Heights between which they are looked for; all along the pin when left out [mm].

    Returns
    -------
    tuple of ndarray, shape (...)
        Moment [N mm] and force [N].
    """
    pieces: list[tuple[float, float, Real, Real]] = []  # from, to [mm]; -q there and its slope
    for eye, level, wrench in zip(eyes, levels, wrenches, strict=True):
        about_middle = first_moment(wrench) - eye.middle * wrench[..., :2]
        slope = about_middle / eye.second
        for low, high in eye.walls:
            at_low = wrench[..., :2] / eye.thickness + slope * (low - eye.middle)
            pieces.append((level + low, level + high, -at_low, -slope))
    lowest, highest = within or (-np.inf, np.inf)
    edges = np.unique([z for low, high, _, _ in pieces for z in (low, high)])
    none = np.zeros((*wrenches[0].shape[:-1], 2))
    shear, moment, most_shear, most_moment = none, none, none[..., 0], none[..., 0]
    for low, high in itertools.pairwise(edges):
        z = np.linspace(0.0, high - low, POINTS)[:, None]
        v, m = shear[..., None, :] + 0.0 * z, moment[..., None, :] + shear[..., None, :] * z
        for start, end, at_start, slope in pieces:
            if start <= low and high <= end:
                here, steep = (at_start + slope * (low - start))[..., None, :], slope[..., None, :]
                v = v + here * z + steep * z**2 / 2.0
                m = m + here * z**2 / 2.0 + steep * z**3 / 6.0
        if lowest <= low and high <= highest:
            most_shear = np.maximum(most_shear, np.linalg.norm(v, axis=-1).max(axis=-1))
            most_moment = np.maximum(most_moment, np.linalg.norm(m, axis=-1).max(axis=-1))
        shear, moment = v[..., -1, :], m[..., -1, :]
    return most_moment, most_shear
