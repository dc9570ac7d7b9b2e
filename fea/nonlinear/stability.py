"""How near to giving way a linkage is, by what its linear frame says: to buckling, and to a dead point.

Near a dead point it is a shallow toggle, where the leverage r of the load over whatever gives (a spring, a lever that
bends, the links themselves) falls in proportion to the distance that is left: r = r0 (1 - w/d), where d is the distance
to the dead point and w the way gone. Then the spring has given u = r0 (w - w²/(2d)), and virtual work with stiffness k
gives the load

    P(w) = k u du/dw = (k r0²/(2 d²)) (2 d² w - 3 d w² + w³)

For two bars of half-span L and rise h = d that push a spring, u = (2 h w - w²)/L and P = (2k/L²)(2h²w - 3hw² + w³).
The load is largest where 3w² - 6dw + 2d² = 0, at w = d (1 - 1/√3), and is d k r0²/(3√3) there. Beyond it the toggle
snaps through. Linear theory moves it by w1 = P/(k r0²), 0.19 d at that load, and finds it unstable at the factor d/w1
on the load: 3√3 = 5.2 at the true limit.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel
from alula.fea.nonlinear.corotational import SUBDIVISIONS, subdivide
from alula.fea.nonlinear.corotational_element import ElementResponse
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.geometry.linkage.placement import vector
from alula.geometry.linkage.pose import Pose, constraint_jacobian

Floats = NDArray[np.float64]

ON_RIMS = Source(kind=SourceKind.COUPLES, detail=reason("tight_or_on_rims"))

COARSE_SUBDIVISIONS, NEAR_BUCKLING = 2, 30.0
"""Elements per beam for a first buckling factor, and the factor below which it is computed with ``SUBDIVISIONS``.

By two elements the worst of Euler's columns (clamped and pinned) buckles 2.6 % late, the others up to 0.8 %.
"""
LARGE = 0.05
"""Share of the span above which a displacement is large."""
SNAP = 3.0 * math.sqrt(3.0)
"""Linear factor at which a shallow toggle snaps through."""


def span(pose: Pose) -> float:
    """Return the largest distance between two points of the pose.

    Parameters
    ----------
    pose : Pose
        The linkage's pose.

    Returns
    -------
    float
        Distance [mm].
    """
    xy = np.array(list(pose.points.values()))
    return float(np.linalg.norm(xy[:, None] - xy[None], axis=-1).max())


def growth(factor: float) -> float:
    """Return what a toggle moves over what linear theory gives.

    With the linear factor n it is the lowest root of x (1 - x) (2 - x)/2 = 1/n with x = w/d, times n. It is more than
    1/(1 - 1/n), the growth of a column, for every n.

    Parameters
    ----------
    factor : float
        By linear theory, to the dead point.

    Returns
    -------
    float
        Infinite below ``SNAP``.
    """
    if factor < SNAP:
        return math.inf
    if factor > _FAR:
        return 1.0 + 1.5 / factor
    return factor * (1.0 - 2.0 / math.sqrt(3.0) * math.cos(math.acos(-SNAP / factor) / 3.0))


_MANY, _ROUNDS = 120, 50
"""Unknowns from which on one eigenvalue is sought, in place of all, and restarts that this may take: as long as all."""
_LARGE = 400
"""Unknowns from which on matrices that are nearly all zeros are factorised as such, unless guides fill them."""
_ROUNDING = 1e-9
_FAR = 1e6
"""Factor from which on two terms of the series are exact to rounding."""


def buckling_factor(model: FrameModel, subdivisions: int = SUBDIVISIONS) -> float:
    """Return the factor on all loads at which the frame, as it stands, becomes unstable.

    Linear stability: (K + λ K_g) φ = 0 with the geometric stiffness K_g of the linear solution's forces (Przemieniecki,
    Theory of Matrix Structural Analysis, 1968, chapter 15). Pinned column, eight elements: π² E I/L² within 0.01 %,
    less what shear takes. Bending before buckling is left out, which is right for small deflections.

    Parameters
    ----------
    model : FrameModel
        The frame.
    subdivisions : int, optional
        Elements per beam.

    Returns
    -------
    float
        Infinite where no factor does.
    """
    divided = subdivide(model, subdivisions)
    linear = solve_frame(divided)
    path = EquilibriumPath(divided)
    K, G = (path.free(part) for part in stiffness_parts(path, linear.end_forces, linear.guide_forces))
    largest = _of_sparse(G, K) if len(K) > _LARGE and not model.guides else None
    if largest is None:
        root = np.asarray(np.linalg.cholesky((K + K.T) / 2.0), dtype=np.float64)
        largest = largest_eigenvalue(-(G + G.T) / 2.0, root)
    return 1.0 / largest if largest > 1e-12 else np.inf


def _of_sparse(G: Floats, K: Floats) -> float | None:
    """Return the largest λ of -G x = λ K x by Lanczos, of matrices with few entries; None where that does not tell."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh, splu

    pressed, stiff = ((part + part.T) / 2.0 for part in (csc_matrix(-G), csc_matrix(K)))
    factors = splu(stiff, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    if not (factors.U.diagonal() > 0.0).all():
        return None  # not positive definite
    inverse = LinearOperator(K.shape, matvec=factors.solve, dtype=np.float64)
    options = {"M": stiff, "Minv": inverse, "v0": factors.solve(np.ones(len(K))), "maxiter": _ROUNDS}
    try:
        return float(eigsh(pressed, 1, which="LA", return_eigenvectors=False, **options)[0])
    except ArpackNoConvergence:
        return None  # where nothing buckles, the largest of them lie close together about zero


def largest_eigenvalue(A: Floats, root: Floats) -> float:
    """Return the largest λ of A x = λ L Lᵀ x; of many unknowns by Lanczos.

    Parameters
    ----------
    A : ndarray, shape (n, n)
        Symmetric.
    root : ndarray, shape (n, n)
        L, lower triangular.

    Returns
    -------
    float
    """
    from scipy.linalg import eigh, solve_triangular
    from scipy.linalg.blas import dtrsv
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

    if len(A) > _MANY:
        upper = root.T

        def between(x: Floats) -> Floats:
            """L⁻¹ A L⁻ᵀ x."""
            return np.asarray(dtrsv(upper, A @ dtrsv(upper, x), trans=1))

        operator, start = LinearOperator(A.shape, matvec=between, dtype=float), upper @ np.ones(len(A))
        try:
            found = eigsh(operator, 1, which="LA", v0=start, maxiter=_ROUNDS, return_eigenvectors=False)
            return float(found[0])
        except ArpackNoConvergence:
            pass  # where nothing buckles, the largest of them lie close together about zero
    half = solve_triangular(root, A, lower=True)
    return float(eigh(solve_triangular(root, half.T, lower=True), eigvals_only=True)[-1])


def beam_answers(path: EquilibriumPath, end_forces: Floats) -> tuple[ElementResponse, ElementResponse]:
    """Return what the beams of a frame as it stands answer by their stiffness, and by the forces in them and on them.

    Parameters
    ----------
    path : EquilibriumPath
        Of the frame, at its start.
    end_forces : ndarray, shape (m, 2, 6)
        As of ``stiffness_parts``.

    Returns
    -------
    tuple of 2 ElementResponse
    """
    return path.respond(path.state, 0.0), pressed_beams(path, end_forces)


def pressed_beams(path: EquilibriumPath, end_forces: Floats) -> ElementResponse:
    """Return what the beams of a frame as it stands answer by the forces in them and on them.

    Parameters
    ----------
    path, end_forces
        As of ``beam_answers``.

    Returns
    -------
    ElementResponse
    """
    f = end_forces
    first, last = (path.elements.loads @ path.elements.axes)[..., 0].T
    mean = (f[:, 1, 0] - f[:, 0, 0]) / 2.0 + (last - first) * path.elements.lengths / 12.0
    return path.elements.geometric(np.column_stack([mean, f[:, 0, 5], f[:, 1, 5], f[:, 0, 4], f[:, 1, 4], f[:, 1, 3]]))


def stiffness_parts(
    path: EquilibriumPath,
    end_forces: Floats,
    guide_forces: Floats,
    answers: tuple[ElementResponse, ElementResponse] | None = None,
) -> tuple[Floats, Floats]:
    """Return the stiffness of a frame as it stands, and the geometric stiffness of the forces in it and on it.

    Parameters
    ----------
    path : EquilibriumPath
        Of the frame, at its start.
    end_forces : ndarray, shape (m, 2, 6)
        On the beams' ends, local axes, as ``FrameSolution`` has them [N, N·mm].
    guide_forces : ndarray, shape (g,)
        Of the guides.
    answers : tuple of 2 ElementResponse, optional
        Those of ``beam_answers``, where they are known.

    Returns
    -------
    tuple of 2 ndarray
        K and K_g (k + g, k + g) with the guides' rows and columns, for ``EquilibriumPath.free``.
    """
    plain, pressed = answers or beam_answers(path, end_forces)
    return path.assemble(plain, path.state, 0.0)[1], geometric_stiffness(path, pressed, guide_forces)


def geometric_stiffness(path: EquilibriumPath, pressed: ElementResponse, guide_forces: Floats) -> Floats:
    """Return the geometric stiffness of a frame as it stands.

    Parameters
    ----------
    path : EquilibriumPath
        Of the frame, at its start.
    pressed : ElementResponse
        Of ``pressed_beams``.
    guide_forces : ndarray, shape (g,)
        As of ``stiffness_parts``.

    Returns
    -------
    ndarray, shape (k + g, k + g)
    """
    start = path.state
    bent = path.assemble(pressed, replace(start, guide_forces=guide_forces), 1.0)[1]
    if path.model.springs:
        # Their stiffness is in K already; what their forces make of it is left.
        axes = path.chain.axes(start.rotations)
        elastic = path.springs.tangent(start.displacements, start.rotations, axes, 0.0)
        bent[: path.chain.count, : path.chain.count] -= elastic
    return bent


def linkage_factor(frame: LinkageFrame) -> float:
    """Return the factor on all loads at which the linear frame becomes unstable.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.

    Returns
    -------
    float
        Infinite where it never does.
    """
    factor = buckling_factor(frame.model, COARSE_SUBDIVISIONS)
    return buckling_factor(frame.model) if factor < NEAR_BUCKLING else factor


def dead_point_factor(frame: LinkageFrame, solution: FrameSolution) -> float:
    """Return the factor on linear displacements that takes a linkage to a dead point.

    With every link turned as its points have moved, each singular value of the constraints with the drive held (which
    is 0 at a dead point) has changed; extrapolated in proportion, the first of them vanishes at this factor.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    solution : FrameSolution
        In small displacements.

    Returns
    -------
    float
        Infinite where they lead away.
    """
    if not any(joint.pivots and name not in frame.bonded for name, joint in frame.pose.linkage.joints.items()):
        return math.inf
    matrix = _constraints(frame, frame.pose)
    u, sizes, v = np.linalg.svd(matrix, full_matrices=False)
    after = np.einsum("ri,rc,ic->i", u, _constraints(frame, _moved(frame, solution)), v)
    nearer = float(np.max(1.0 - after / np.maximum(sizes, _ROUNDING)))
    return 1.0 / nearer if nearer > _ROUNDING else math.inf


def _constraints(frame: LinkageFrame, pose: Pose) -> NDArray[np.float64]:
    rows = constraint_jacobian(pose)
    if frame.held is None:
        return rows
    return np.vstack([rows, frame.held.held_motion(pose)])


def _moved(frame: LinkageFrame, solution: FrameSolution) -> Pose:
    """Return the pose with its links turned, and its pins slid, as the linear frame says."""
    pose, moved = frame.pose, frame.at_points(solution.displacements)
    turns = []
    for link in pose.linkage.moving:
        points = pose.linkage.links[link].points
        places = np.array([pose.position(link, point) for point in points])
        moves = np.array([moved[link, point][:2] for point in points])
        arms = places - places.mean(axis=0)
        size = float((arms**2).sum())
        turns.append(float((arms[:, 0] * moves[:, 1] - arms[:, 1] * moves[:, 0]).sum()) / size if size > 0.0 else 0.0)
    slid = []
    for name in pose.closure.slots:
        apart = np.zeros(3)
        for link, point, sign in zip(
            pose.linkage.joints[name].links, pose.linkage.joint_points(name), (-1.0, 1.0), strict=True
        ):
            apart = apart + sign * moved.get((link, point), np.zeros(3))
        slid.append(float(vector(pose.placement.along(name)) @ apart))
    return Pose(
        linkage=pose.linkage,
        q=pose.q + np.array([*turns, *slid]),
        coordinate=pose.coordinate,
        residual=pose.residual,
        among=pose.among,
    )
