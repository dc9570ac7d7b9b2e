"""Displacement and stress of all that a link undergoes, in many states, from as few solutions as span it.

Where the states are those of a motion or of samples, loads are sums of unit loads, of which they span a small part,
since the force on an eye follows one curve. Singular value decompositions of the coefficients find that part. The
pressure fields, which have no resultant, have one of their own, truncated by ``TRUNCATION``; that of all other unit
loads is kept whole. Where they are some single states, their load vectors themselves are taken, without the error of a
series; most are sums of a few, which their Gram matrix tells. Either way one factorisation and one solution per mode
serve every state.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common import memory
from alula.fea.common.reason import Reason
from alula.fea.elements.elasticity import jacobians, lame_constants, reference_basis
from alula.fea.elements.space import DisplacementSpace, upper_half
from alula.fea.elements.supports import rigid_motions
from alula.fea.solid.solution import FreeSolution, solve_free
from alula.fea.solid.stress import PAIRS, carry_to_nodes
from alula.fea.tractions.link_tractions import LinkTractions

Real = NDArray[np.float64]

TRUNCATION = 1e-3
"""Part of a load's pressure fields that may be left out, by the norm of their nodal forces."""
LEFT_OUT = 1e-5
"""Norm of the nodal forces that a mode left out may have in loads, over that of the largest mode."""
_EXACT = 1e-11
_CHUNK = 128
"""Elements whose stresses are recovered at once: their numbers stay in the cache, at half the time of 1024."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UnitSolutions:
    """Modes of a link and what they add up to.

    Attributes
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    displacement : ndarray, shape (3 nodes, modes)
        Supported isostatically [mm].
    nodes : ndarray of int, shape (h,)
        Those that tell all stress: all, or those of the upper half of a body and loads that are their own image.
    stress : ndarray, shape (h, 6, modes)
        Recovered at these nodes [MPa].
    combination : ndarray, shape (modes, N)
        Of the modes under N loads.
    reaction : ndarray, shape (N,)
        Largest support reaction relative to the load.
    imbalance : ndarray, shape (N,)
        Resultant of the load vectors relative to the load.
    projection : ndarray, shape (modes, unit loads)
        Turns coefficients of the unit loads into a combination of the modes, of these loads and of any other.
    solver : str
    solver_reason : Reason
        Its name, and why it was chosen.
    solver_error : float
        Largest relative error of a mode (energy norm).
    """

    space: DisplacementSpace
    displacement: Real
    nodes: NDArray[np.int64]
    stress: Real
    combination: Real
    reaction: Real
    imbalance: Real
    projection: Real
    solver: str
    solver_reason: Reason
    solver_error: float

    def field(self, load: int) -> Real:
        """Return the displacements under one of the loads.

        Parameters
        ----------
        load : int
            Its number.

        Returns
        -------
        ndarray, shape (nodes, 3)
            [mm]
        """
        return np.asarray((self.displacement @ self.combination[:, load]).reshape(-1, 3))


def solve_units(
    units: LinkTractions, coefficients: Real, scale: Real, *, E: float, nu: float, threads: int | None = None
) -> UnitSolutions:
    """Solve for the modes of N loads that are sums of unit loads.

    Parameters
    ----------
    units : LinkTractions
    coefficients : ndarray, shape (units, N)
        Of the unit loads.
    scale : ndarray, shape (N,)
        What resultants are compared with [N].
    E, nu : float
        Of the material [MPa, -].
    threads : int, optional

    Returns
    -------
    UnitSolutions

    Raises
    ------
    CannotRunError
        Where memory does not suffice or a solver fails.
    """
    space = units.space
    modes, projection = _modes(units, coefficients, scale)
    _require_memory(space, modes.shape[1], 2.0)
    F = np.empty((space.unknowns, modes.shape[1]), order="F")  # as solvers take it
    for mode, column in zip(modes.T, F.T, strict=True):
        column[:] = units.vectors @ mode
    return _solved(space, F, projection, projection @ coefficients, scale, E=E, nu=nu, threads=threads)


def solve_loads(
    space: DisplacementSpace, loads: Real, scale: Real, *, E: float, nu: float, threads: int | None = None
) -> UnitSolutions:
    """Solve for the modes of N loads; each is a unit load of its own.

    Parameters
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    loads : ndarray, shape (N, 3 nodes)
        Consistent nodal forces [N].
    scale, E, nu, threads
        As of ``solve_units``.

    Returns
    -------
    UnitSolutions

    Raises
    ------
    CannotRunError
        Where memory does not suffice or a solver fails.
    """
    _require_memory(space, len(loads), 4.0)
    size = np.linalg.norm(loads, axis=1)
    values, vectors = np.linalg.eigh(loads @ loads.T / np.outer(size, size))
    kept = vectors[:, values > LEFT_OUT**2 * values[-1]]  # the loads are sums of the eigenvectors' sums of loads
    combination = (size[:, None] * kept).T
    return _solved(
        space, ((kept / size[:, None]).T @ loads).T, combination, combination, scale, E=E, nu=nu, threads=threads
    )


def _require_memory(space: DisplacementSpace, count: int, fields: float) -> None:
    memory.require(
        8.0 * count * (fields * space.unknowns + 6.0 * len(space.nodes)),
        f"the stress of {count} loads at {len(space.nodes):,} nodes",
        None,
    )


def _solved(
    space: DisplacementSpace,
    F: Real,
    projection: Real,
    combination: Real,
    scale: Real,
    *,
    E: float,
    nu: float,
    threads: int | None,
) -> UnitSolutions:
    """Solve for modes (3 nodes, m), which loads are combinations of."""
    size = np.linalg.norm(np.ptp(space.nodes, axis=0))
    whole = rigid_motions(space.nodes, space.nodes.mean(axis=0)).reshape(6, -1) @ F @ combination
    free = solve_free(space, F, E=E, nu=nu, threads=threads)
    nodes, stress = _stress(space, free, E=E, nu=nu)
    return UnitSolutions(
        space=space,
        displacement=free.displacement,
        nodes=nodes,
        stress=stress,
        combination=combination,
        reaction=np.abs(free.reactions @ combination).max(axis=0) / scale,
        imbalance=np.maximum(np.linalg.norm(whole[:3], axis=0), np.linalg.norm(whole[3:], axis=0) / size) / scale,
        projection=projection,
        solver=free.solver,
        solver_reason=free.reason,
        solver_error=free.error,
    )


def _stress(space: DisplacementSpace, free: FreeSolution, *, E: float, nu: float) -> tuple[NDArray[np.int64], Real]:
    """Return the nodes that tell all stress, those of the upper half if it can, and the stress there."""
    half = upper_half(space)
    if half is None or not free.symmetric.all():
        return np.arange(len(space.nodes)), nodal_stress(space, free.displacement, E=E, nu=nu)
    upper = free.displacement.reshape(-1, 3, len(free.symmetric))[half.nodes].reshape(half.space.unknowns, -1)
    stress = nodal_stress(half.space, upper, E=E, nu=nu)
    stress[half.on_plane, 4:] = 0.0  # yz and xz have the other sign in the images of the elements there
    return half.nodes, stress


def _modes(units: LinkTractions, coefficients: Real, scale: Real) -> tuple[Real, Real]:
    """Return modes (units, m), and what turns coefficients into their combinations (m, units)."""
    norm = np.sqrt(np.asarray(units.vectors.multiply(units.vectors).sum(axis=0)).ravel())
    norm[norm == 0.0] = 1.0
    found, parts = [], []
    for members, tolerance in ((~units.local, _EXACT), (units.local, TRUNCATION)):
        M = norm[members, None] * coefficients[members]
        # Every load counts by itself, or the small ones of a motion would be lost beside the large ones.
        weight = np.linalg.norm(M, axis=0) if tolerance == TRUNCATION else scale
        shares = M / np.where(weight > 0.0, weight, 1.0)
        left, values, right = np.linalg.svd(shares, full_matrices=False)
        rest = np.sqrt(np.cumsum((values[:, None] * right)[::-1] ** 2, axis=0))[::-1].max(axis=1, initial=0.0)
        keep = int(np.count_nonzero(rest > tolerance * (rest[0] if len(rest) else 0.0)))
        mode, part = np.zeros((units.count, keep)), np.zeros((keep, units.count))
        mode[members] = left[:, :keep] / norm[members, None]
        part[:, members] = left[:, :keep].T * norm[members]
        found.append(mode)
        parts.append(part)
    return np.hstack(found), np.vstack(parts)


def nodal_stress(space: DisplacementSpace, displacement: Real, *, E: float, nu: float) -> Real:
    """Return the stress recovered at the nodes from m displacement fields, as ``stress_field`` does.

    Parameters
    ----------
    space : DisplacementSpace
    displacement : ndarray, shape (3 nodes, m)
        [mm]
    E, nu : float
        Of the material [MPa, -].

    Returns
    -------
    ndarray, shape (nodes, 6, m)
        [MPa]
    """
    from scipy.sparse import csr_array

    X, _, _, gradient = reference_basis(space, space.order)
    carry = carry_to_nodes(X, space.cells.shape[1])
    m = displacement.shape[1]
    fields = np.ascontiguousarray(displacement).reshape(-1, 3 * m)
    sums = np.zeros((len(space.nodes), 6 * m))
    for start in range(0, len(space.cells), _CHUNK):
        cells = space.cells[start : start + _CHUNK]
        k, b = cells.shape
        inverse, _ = jacobians(space.nodes[cells], gradient)
        q = inverse.shape[1]
        slopes = (inverse @ gradient.transpose(0, 2, 1)).reshape(k, 3 * q, b)
        G = (slopes @ fields[cells]).reshape(k, q, 3, 3, m)
        nodes, row = np.unique(cells, return_inverse=True)
        mean = csr_array(
            (
                np.broadcast_to(carry, (k, b, q)).ravel(),
                (np.repeat(row.ravel(), q), np.broadcast_to(np.arange(k * q).reshape(k, 1, q), (k, b, q)).ravel()),
            ),
            shape=(len(nodes), k * q),
        )
        sums[nodes] += mean @ _components(G, E, nu).reshape(k * q, 6 * m)
    sums /= np.bincount(space.cells.ravel(), minlength=len(space.nodes))[:, None]
    return sums.reshape(-1, 6, m)


def _components(G: Real, E: float, nu: float) -> Real:
    """Stresses (..., 6, m) of displacement gradients (..., 3, 3, m), ∂u_j/∂x_i at [i, j]."""
    lam, mu = lame_constants(E, nu)
    found = np.empty((*G.shape[:-3], 6, G.shape[-1]))
    dilatation = lam * (G[..., 0, 0, :] + G[..., 1, 1, :] + G[..., 2, 2, :])
    for n, (i, j) in enumerate(PAIRS):
        found[..., n, :] = mu * (G[..., i, j, :] + G[..., j, i, :])
        if i == j:
            found[..., n, :] += dilatation
    return found
