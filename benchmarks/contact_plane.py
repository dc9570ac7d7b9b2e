"""Contact of a pin in an eye in the plane, by finite elements of its own: what the laws of pressure are tried against.

Plane stress, without friction, small displacements, in units of E = 1, the bore's radius = 1 and the thickness = 1,
with F/(d t) = 1. Eye and pin are rings of quadratic quadrilaterals; pressures are hats on the bore, gaps their means.
The compliance of the bore is condensed once, so that every clearance is a small problem:

    min ½ pᵀ S p + g wᵀ p,    p ≥ 0,    Nᵀ p = F    (g = c/2)

Nothing of alula is used.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu

Real = NDArray[np.float64]
Curve = Callable[[Real], Real]

FORCE = 2.0
"""F, with d = 2 and t = 1."""
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_X, _Y = (a.ravel() for a in np.meshgrid(_GAUSS, _GAUSS, indexing="ij"))
_W = np.outer(_WEIGHTS, _WEIGHTS).ravel()


def _line(x: Real) -> tuple[Real, Real]:
    """Quadratic functions (..., 3) of the nodes at -1, 0 and 1, and their slopes."""
    value = np.stack([x * (x - 1.0) / 2.0, 1.0 - x**2, x * (x + 1.0) / 2.0], axis=-1)
    return value, np.stack([x - 0.5, -2.0 * x, x + 0.5], axis=-1)


def angles(finest: float = 0.4, growth: float = 0.06, kinks: tuple[float, ...] = ()) -> Real:
    """Corners about a bore from -π [rad]: fine about 0, and with corners at the kinks of the outline."""
    steps = [0.0]
    while steps[-1] < 180.0:
        steps.append(steps[-1] + finest + growth * steps[-1])
    half = np.radians(np.array(steps) * 180.0 / steps[-1])
    found = np.concatenate([-half[:0:-1], half[:-1]])
    for kink in kinks:
        place = (kink + math.pi) % (2.0 * math.pi) - math.pi
        found[np.argmin(np.abs(found - place))] = place
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class Ring:
    """An elastic ring about the origin, between two curves that are seen from there.

    Attributes
    ----------
    corners : array (n,)
        Angles of the elements' sides, rising from -π [rad].
    inner, outer : callable
        Radius at angles.
    held : callable
        Of x and y of the nodes: True where the ring is held.
    outside : bool
        Whether the pressure acts on the outer curve, as on a pin, or on the inner one. The pressed curve has radius 1.
    young, poisson : float
    layers : int
        Elements along the radius, the thinnest where the pressure acts.
    """

    corners: Real
    inner: Curve
    outer: Curve
    held: Callable[[Real, Real], NDArray[np.bool_]]
    outside: bool = False
    young: float = 1.0
    poisson: float = 0.3
    layers: int = 24

    @cached_property
    def nodes(self) -> Real:
        """Places (2, layers, around) of the nodes."""
        around = np.append(self.corners, self.corners[0] + 2.0 * math.pi)
        angle = np.stack([around[:-1], 0.5 * (around[1:] + around[:-1])], axis=1).ravel()
        depth = np.linspace(0.0, 1.0, 2 * self.layers + 1)[:, None] ** 1.7
        depth = 1.0 - depth[::-1] if self.outside else depth
        low, high = self.inner(angle), self.outer(angle)
        radius = low * (high / low) ** depth
        return np.array([radius * np.cos(angle), radius * np.sin(angle)])

    @cached_property
    def cells(self) -> NDArray[np.int_]:
        """Nodes (k, 9) of the elements: three layers, of three nodes each."""
        around = self.nodes.shape[2]
        i, j = (2 * a.ravel() for a in np.meshgrid(np.arange(self.layers), np.arange(len(self.corners)), indexing="ij"))
        return np.stack([(i + a) * around + (j + b) % around for a in range(3) for b in range(3)], axis=1)

    def gradients(self, x: Real, y: Real) -> tuple[Real, Real, Real]:
        """Slopes (k, q, 9, 2) of the functions at points of the reference square, Jacobians (k, q) and places."""
        (vx, sx), (vy, sy) = _line(x), _line(y)
        value = np.einsum("qa,qb->qab", vx, vy).reshape(-1, 9)
        slope = np.stack([np.einsum("qa,qb->qab", sx, vy), np.einsum("qa,qb->qab", vx, sy)], axis=-1).reshape(-1, 9, 2)
        places = self.nodes.reshape(2, -1)[:, self.cells]  # (2, k, 9)
        jacobian = np.einsum("ikn,qnj->kqij", places, slope)
        inverse = np.linalg.inv(jacobian)
        return (
            np.einsum("qnj,kqji->kqni", slope, inverse),
            np.abs(np.linalg.det(jacobian)),
            np.einsum("ikn,qn->ikq", places, value),
        )

    @cached_property
    def _solver(self) -> tuple[Any, NDArray[np.int_]]:
        slope, size, _ = self.gradients(_X, _Y)
        strain = np.zeros((*slope.shape[:2], 3, 18))
        strain[..., 0, 0::2], strain[..., 1, 1::2] = slope[..., 0], slope[..., 1]
        strain[..., 2, 0::2], strain[..., 2, 1::2] = slope[..., 1], slope[..., 0]
        local = np.einsum("kqai,ab,kqbj,kq->kij", strain, self.elasticity, strain, size * _W, optimize=True)
        dofs = np.stack([2 * self.cells, 2 * self.cells + 1], axis=-1).reshape(-1, 18)
        rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        count = self.nodes[0].size
        whole = coo_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * count, 2 * count)).tocsc()
        free = np.flatnonzero(np.repeat(~self.held(*self.nodes.reshape(2, -1)), 2))
        return splu(whole[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}), free

    @property
    def elasticity(self) -> Real:
        """Hooke's law (3, 3) in plane stress."""
        nu = self.poisson
        return np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, (1.0 - nu) / 2.0]]) * self.young / (1.0 - nu**2)

    @cached_property
    def pressed(self) -> Real:
        """Nodal forces (2 nodes, n) of unit hats of pressure at the corners, outwards."""
        n, around = len(self.corners), self.nodes.shape[2]
        first = (self.nodes.shape[1] - 1 if self.outside else 0) * around
        value, slope = _line(_GAUSS)
        found = np.zeros((2 * self.nodes[0].size, n))
        for cell in range(n):
            nodes = first + (2 * cell + np.arange(3)) % around
            x, along = (np.einsum("in,qn->iq", self.nodes.reshape(2, -1)[:, nodes], f) for f in (value, slope))
            for share, corner in (((1.0 - _GAUSS) / 2.0, cell), ((1.0 + _GAUSS) / 2.0, (cell + 1) % n)):
                force = np.einsum("iq,q,qn->ni", x / np.hypot(*x), share * np.hypot(*along) * _WEIGHTS, value)
                found[2 * nodes, corner] += force[:, 0]
                found[2 * nodes + 1, corner] += force[:, 1]
        return found

    @cached_property
    def moved(self) -> Real:
        """Displacements (2 nodes, n) under unit hats of pressure, outwards."""
        solver, free = self._solver
        found = np.zeros_like(self.pressed)
        found[free] = solver.solve(self.pressed[free])
        return found

    @cached_property
    def compliance(self) -> Real:
        """Work (n, n) of the hats on the displacements under hats."""
        return self.pressed.T @ self.moved

    @cached_property
    def resultants(self) -> Real:
        """Forces (n, 2) of the hats."""
        return self.pressed.reshape(-1, 2, len(self.corners)).sum(axis=0).T

    @cached_property
    def widths(self) -> Real:
        """Integrals (n,) of the hats along the circle."""
        step = np.diff(np.append(self.corners, self.corners[0] + 2.0 * math.pi))
        return 0.5 * (step + np.roll(step, 1))

    def stress(self, pressure: Real) -> tuple[Real, Real]:
        """Stress (3, points) xx, yy, xy under a pressure at the corners, and where (2, points); walls included."""
        ends = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
        x, y = (a.ravel() for a in np.meshgrid(ends, ends, indexing="ij"))
        slope, _, places = self.gradients(x, y)
        field = (self.moved @ pressure).reshape(-1, 2)[self.cells]  # (k, 9, 2)
        e = np.einsum("kni,kqnj->ijkq", field, slope)
        strain = np.array([e[0, 0], e[1, 1], e[0, 1] + e[1, 0]])
        return np.einsum("ab,bkq->akq", self.elasticity, strain).reshape(3, -1), places.reshape(2, -1)


def von_mises(stress: Real) -> Real:
    """Of xx, yy, xy in plane stress."""
    xx, yy, xy = stress
    return np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2)


def principal(stress: Real) -> Real:
    """The largest one."""
    xx, yy, xy = stress
    return 0.5 * (xx + yy) + np.hypot(0.5 * (xx - yy), xy)


def eye(ratio: float, direction: float = 0.0, *, shank: float = 1.0, finest: float = 0.4) -> Ring:
    """Return an eye of ratio D/d whose shank lies at -direction from the force on it and is held 1.5 D away.

    The force points along x; a direction of 0 pulls the eye off its shank, π pushes it on. The shank is ``shank`` times
    D wide.
    """
    half, length = ratio * shank * (1.0 - 1e-9), 3.0 * ratio
    back = direction + math.pi

    def outline(angle: Real) -> Real:
        turn = np.mod(angle - back + math.pi, 2.0 * math.pi) - math.pi
        sine, cosine = np.abs(np.sin(turn)), np.cos(turn)
        with np.errstate(divide="ignore"):
            to_side, to_end = half / sine, np.where(cosine > 0.0, length / cosine, np.inf)
        return np.where(cosine > 0.0, np.maximum(ratio, np.minimum(to_side, to_end)), ratio)

    def held(x: Real, y: Real) -> NDArray[np.bool_]:
        return np.abs(x * math.cos(back) + y * math.sin(back) - length) < 1e-6

    corner, neck = math.atan2(half, length), math.asin(shank * (1.0 - 1e-9))
    kinks = tuple(back + turn for turn in (-neck, -corner, 0.0, corner, neck))
    return Ring(corners=angles(finest, kinks=kinks), inner=np.ones_like, outer=outline, held=held)


def plate(ratio: float = 30.0, finest: float = 0.4) -> Ring:
    """Return a hole in a large disc that is held at its rim."""
    return Ring(
        corners=angles(finest),
        inner=np.ones_like,
        outer=lambda angle: np.full_like(angle, ratio),
        held=lambda x, y: np.hypot(x, y) > ratio - 1e-6,
        layers=40,
    )


def pin(corners: Real, young: float = 1.0, poisson: float = 0.3) -> Ring:
    """Return a pin that is held in its middle, which moves no shape of its rim but by its shift."""
    core = 0.02
    return Ring(
        corners=corners,
        inner=lambda angle: np.full_like(angle, core),
        outer=np.ones_like,
        held=lambda x, y: np.hypot(x, y) < core + 1e-6,
        outside=True,
        young=young,
        poisson=poisson,
        layers=28,
    )


def contact(hole: Ring, tightness: float, shaft: Ring | None = None) -> Real:
    """Return the pressure at the corners in contact with a pin, which is rigid without ``shaft``, at E c t/F.

    By active sets: corners that pull are let go, those that overlap are taken in, until none is left.
    """
    gap = 0.5 * tightness * FORCE * hole.widths
    compliance = hole.compliance + (shaft.compliance if shaft else 0.0)
    towards, n = hole.resultants, len(gap)
    active = np.abs(hole.corners) < 0.5
    for _ in range(200):
        own = np.flatnonzero(active)
        left = np.block([[compliance[np.ix_(own, own)], -towards[own]], [towards[own].T, np.zeros((2, 2))]])
        found = np.linalg.solve(left, np.concatenate([-gap[own], [FORCE, 0.0]]))
        pressure = np.zeros(n)
        pressure[own] = found[:-2]
        open_by = gap + compliance @ pressure - towards @ found[-2:]
        new = np.where(active, pressure > 0.0, open_by < -1e-12)
        if np.array_equal(new, active):
            return pressure
        active = new
    raise RuntimeError("no active set was found")


def half_angle(hole: Ring, pressure: Real) -> float:
    """Return the half angle [rad] at which pressure ends, from its last corners; the mean of both sides."""
    ends = []
    for side in (1.0, -1.0):
        order = np.argsort(side * hole.corners)
        angle, p = side * hole.corners[order], pressure[order]
        last = np.flatnonzero(p > 0.0)[-1]
        if last + 1 == len(p):
            ends.append(math.pi)
            continue
        # The pressure ends as a root: its square is linear there.
        a, b = p[last - 1] ** 2, p[last] ** 2
        step = angle[last] - angle[last - 1]
        ends.append(float(angle[last] + min(step * b / (a - b), 2.0 * step)) if a > b else float(angle[last]))
    return sum(ends) / 2.0
