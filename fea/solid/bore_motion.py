"""The motion of a pin as its bore has it, and the flexibility of a link between its pins.

A bore does not stay round, so its motion is the rigid one that is nearest to its displacements, in the mean square over
its area. The tractions dual to it, a + b × r with unit resultants (``alula.fea.tractions.traction.wrench_density``), do
the work wrench · motion on any displacement. A flexibility that is made of both is therefore symmetric.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.quadrature import SurfaceQuadrature, surface_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import rigid_motions
from alula.fea.solid.solution import solve_free
from alula.fea.tractions.traction import wrench_density

Real = NDArray[np.float64]


def work(surface: SurfaceQuadrature, traction: Real, field: Real) -> float:
    """Return the work that a traction does on displacements.

    Parameters
    ----------
    surface : SurfaceQuadrature
        On which it acts.
    traction : ndarray, shape (k, q, 3)
        At the points of the quadrature [MPa].
    field : ndarray, shape (n, 3)
        Displacements of all nodes [mm].

    Returns
    -------
    float
        Work [N mm].
    """
    return float(np.einsum("kq,qb,kqi,kbi->", surface.w, surface.phi, traction, field[surface.nodes], optimize=True))


def mean_motion(surface: SurfaceQuadrature, point: Real, field: Real) -> Real:
    """Return the rigid motion that is nearest to the displacements of a surface, in the mean square over its area.

    Its components are the work of the six unit wrenches about the point, each as the traction a + b × r: with the
    Gram matrix G of the rigid-body fields N these are N G⁻¹, and the least-squares motion is G⁻¹ ∫ Nᵀ u.

    Parameters
    ----------
    surface : SurfaceQuadrature
        Such as a bore.
    point : ndarray, shape (3,)
        That moves with the surface [mm].
    field : ndarray, shape (n, 3)
        Displacements of all nodes [mm].

    Returns
    -------
    ndarray, shape (6,)
        Displacement of the point [mm] and rotation [rad].
    """
    return np.array([work(surface, wrench_density(surface, point, unit), field) for unit in np.eye(6)])


def flexibility(space: DisplacementSpace, places: Mapping[str, Real], *, E: float, nu: float) -> Real:
    """Return the flexibility of a free link between its pins: the mean motions of bores under wrenches on them.

    Only wrenches that balance deform a free body. What of given ones does not balance is taken off first, by the part
    that would move the places as a rigid body, rotations counted over the link's size; the same part is taken off the
    motions. So no wrench of the supports is left, and rigid motions are the null space.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    places : dict of str to ndarray
        Surface, such as ``bore:A``, and point (3,) about which its wrench and its motion count [mm].
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.

    Returns
    -------
    ndarray, shape (6 p, 6 p)
        From wrenches [N, N mm] to motions [mm, rad], in the order of the places; symmetric.
    """
    return condensed(space, places, np.zeros((space.unknowns, 0)), E=E, nu=nu)[0]


def condensed(
    space: DisplacementSpace,
    places: Mapping[str, Real],
    loads: Real,
    *,
    E: float,
    nu: float,
    threads: int | None = None,
) -> tuple[Real, Real]:
    """Return the mutual work of a free link's unit wrenches at its places and of other loads, and their displacements.

    Each load is balanced by wrenches at the places, the part of ``flexibility`` that would move them as a rigid body.
    Loads and wrenches that balance together so have the sum of their displacements.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.
    places : dict of str to ndarray
        Surface, and point (3,) about which its wrench and its motion count [mm].
    loads : ndarray, shape (3n, k)
        Nodal forces [N].
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    tuple of 2 ndarray
        Work (6 p + k, 6 p + k) of each on the displacements of each, wrenches first; and these displacements
        (3n, 6 p + k) [mm].
    """
    size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))
    unit = np.tile([1.0, 1.0, 1.0, size, size, size], len(places))
    dual, rigid = [], []
    for name, point in places.items():
        surface = surface_quadrature(space, name)
        dual += [surface.load_vector(wrench_density(surface, point, w), len(space.nodes)) for w in np.eye(6)]
        rigid.append(_of_body(point))
    # Wrenches over ``unit`` and motions times it have one measure each; Q is a basis of rigid motions in it.
    Q, R = np.linalg.qr(np.vstack(rigid) * unit[:, None])
    wrenches = np.array(dual).T
    resultants = rigid_motions(space.nodes, np.zeros(3)).reshape(6, -1) @ loads
    borne = unit[:, None] * (Q @ np.linalg.solve(R.T, resultants))
    balanced = (np.eye(len(unit)) - Q @ Q.T) * unit[:, None] / unit
    F = np.hstack([wrenches @ balanced, loads - wrenches @ borne])
    moved = solve_free(space, F, E=E, nu=nu, threads=threads).displacement
    return np.asarray(F.T @ moved), np.asarray(moved)


def _of_body(point: Real) -> Real:
    """Motion (6, 6) of a point, and of what is about it, under the six rigid motions about the origin."""
    moved = np.zeros((6, 6))
    moved[:3] = rigid_motions(point[None], np.zeros(3))[:, 0].T
    moved[3:, 3:] = np.eye(3)
    return moved
