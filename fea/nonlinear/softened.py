"""Equilibrium of a linkage's frame on its deformed shape where its loads, or what gives in its links, are others.

A frame of linear material has the shape that load over modulus gives it. So loads times a factor and moduli divided by
it make the same shape, and forces that differ by that factor.
"""

import math
from dataclasses import replace

import numpy as np

from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.equilibrium_path import CorotationalSolution, NoEquilibriumError

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
        found = followed(frame, factor)
    except NoEquilibriumError:
        return math.inf
    return float(np.linalg.norm(frame.at_points(found.displacements)[link, point]))


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
