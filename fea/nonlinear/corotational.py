"""Frames in large displacement: co-rotational beams in space, Newton's method, load stepping.

The model is that of ``alula.fea.frame.model``, every beam divided into several co-rotational elements
(``alula.fea.nonlinear.corotational_element``); strains are small, displacements and rotations are not. Forces keep
their direction, and so do moments (a moment that keeps its axis in space does no path-independent work unless it turns
about that axis: the tangent is then unsymmetric, and exact all the same). Pins turn with the links that carry them.

A guide holds its pin at d · n = 0, d from the carrier's node to the pin's, n the normal that turns with the carrier's
section there: the slot is a straight line on the deformed link, and the force of a pin that has slid along it has its
moment about the carrier's node. Or it holds the pin's axis a, which turns with the pin's node, at a · n = 0. Its force
is an unknown of its own (a Lagrange multiplier: Bathe, Finite Element Procedures, 1996, section 3.4.1), so that slots
have neither play nor stiffness.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.equations import equations_of
from alula.fea.frame.model import FrameModel
from alula.fea.nonlinear.equilibrium_path import CorotationalSolution, EquilibriumPath

Floats = NDArray[np.float64]

SUBDIVISIONS = 8
"""Elements per beam: a quarter circle then costs 0.1 % of the tip's displacement."""
_MOST_ITERATIONS = 30
_LEAST_STEP = 1.0 / 4096.0


def subdivide(model: FrameModel, parts: int | Sequence[int]) -> FrameModel:
    """Return the frame with every element divided into equal parts, in order; new nodes stand after the old ones.

    Parameters
    ----------
    model : FrameModel
        The frame.
    parts : int or sequence of int
        Per element; a number for each, or one for all.

    Returns
    -------
    FrameModel
        The divided frame.
    """
    nodes, elements = list(model.nodes), []
    names = [model.name(i) for i in range(len(model.nodes))]
    each = [parts] * len(model.elements) if isinstance(parts, int) else parts
    for i, (e, parts) in enumerate(zip(model.elements, each, strict=True)):
        start, end = model.ends(i)
        chain = [e.nodes[0], *range(len(nodes), len(nodes) + parts - 1), e.nodes[1]]
        for k in range(1, parts):
            nodes.append(start + (end - start) * k / parts)
            names.append(f"{k}/{parts} along element {i}")
        for k in range(parts):
            first, last = k == 0, k == parts - 1
            load = [e.load_first + (e.load_last - e.load_first) * j / parts for j in (k, k + 1)]
            elements.append(
                replace(
                    e,
                    nodes=(chain[k], chain[k + 1]),
                    offsets=np.array([e.offsets[0] * first, e.offsets[1] * last]),
                    load_first=load[0],
                    load_last=load[1],
                )
            )
    return replace(model, nodes=np.array(nodes), elements=tuple(elements), names=tuple(names))


def solve_large_displacement(
    model: FrameModel,
    subdivisions: int = SUBDIVISIONS,
    *,
    least_step: float = _LEAST_STEP,
    most_iterations: int = _MOST_ITERATIONS,
    stable: bool = False,
) -> CorotationalSolution:
    """Find the equilibrium of a frame on its deformed shape, following it from the unloaded state.

    A step in load is as long as the path bends little, whatever the load is (``EquilibriumPath.follow``), and halved
    where Newton's method fails (within ``most_iterations``). No unconverged shape is ever returned.

    Parameters
    ----------
    model : FrameModel
        The frame.
    subdivisions : int, optional
        Co-rotational elements per beam.
    least_step : float, optional
        Of the load, below which there is no equilibrium.
    most_iterations : int, optional
        Of Newton's method in one step.
    stable : bool, optional
        Whether the path ends where it is not stable any more.

    Returns
    -------
    CorotationalSolution
        Equilibrium under the whole load.

    Raises
    ------
    CannotRunError
        For mechanisms.
    NoEquilibriumError
        Where the step falls below ``least_step``: a limit load, a snap-through or a divergent shape.
    """
    equations_of(model)  # refuses a mechanism
    path = EquilibriumPath(subdivide(model, subdivisions))
    path.follow(least_step, most_iterations, stable=stable)
    return path.record()
