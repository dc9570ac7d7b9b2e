"""Equilibrium of a linkage's frame on its deformed shape where its loads, or what gives in its links, are others.

A frame of linear material has the shape that load over modulus gives it. So loads times a factor and moduli divided by
it make the same shape, and forces that differ by that factor.
"""

import math
from copy import copy
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.nonlinear.corotational import solve_large_displacement, subdivide
from alula.fea.nonlinear.equilibrium_path import CorotationalSolution, EquilibriumPath, NoEquilibriumError, State

Floats = NDArray[np.float64]

PATH_SUBDIVISIONS = 2
LEAST_STEP = 1.0 / 512.0
MOST_ITERATIONS = 15


def displaced(frame: LinkageFrame, link: str, point: str, factor: float) -> float:
    """Return the distance by which a point moves on the deformed shape.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    link : str
        On which the point lies.
    point : str
        Its name.
    factor : float
        Load over modulus, relative to the case.

    Returns
    -------
    float
        Distance [mm]; infinite where nothing holds.
    """
    if not math.isfinite(factor):
        return math.inf
    try:
        found = followed(frame, factor).displacements if frame.model.springs else _displacements(frame, factor)
    except NoEquilibriumError:
        return math.inf
    return float(np.linalg.norm(frame.at_points(found)[link, point]))


def _displacements(frame: LinkageFrame, factor: float) -> Floats:
    """Displacements (n, 3) of the nodes of a frame without springs, on from the nearest load that it was followed to.

    Points of one linkage differ little in their factors, and all of its paths are one.
    """
    start, known = _path(frame)
    nearest = max(one for one in known if one <= factor)
    path = copy(start)
    path.state, path.reached = known[nearest], nearest
    try:
        path.follow(LEAST_STEP * factor, MOST_ITERATIONS, stable=True, to=factor)
    finally:
        known[path.reached] = path.state
    return path.state.displacements


@lru_cache(maxsize=32)
def _path(frame: LinkageFrame) -> tuple[EquilibriumPath, dict[float, State]]:
    """Return the path of a frame at its start, and its states by the factors on the loads that it was followed to."""
    path = EquilibriumPath(subdivide(frame.model, PATH_SUBDIVISIONS))
    return path, {0.0: path.state}


def followed(frame: LinkageFrame, factor: float) -> CorotationalSolution:
    """Return the stable equilibrium under another load over modulus.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    factor : float
        Load over modulus, relative to the case: a frame of linear material has the shape that this gives it.

    Returns
    -------
    CorotationalSolution
        With forces over that factor.

    Raises
    ------
    NoEquilibriumError
        Where the path of stable equilibrium ends on the way.
    """
    elements = tuple(replace(element, young=element.young / factor) for element in frame.model.elements)
    springs = tuple(spring.softened(factor) for spring in frame.model.springs)
    return solve_large_displacement(
        replace(frame.model, elements=elements, springs=springs),
        PATH_SUBDIVISIONS,
        least_step=LEAST_STEP,
        most_iterations=MOST_ITERATIONS,
        stable=True,
    )
