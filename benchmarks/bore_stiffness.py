"""A pin in the bore of a solid eye: what stiffness per length the wall answers with, for a pin that bends.

Quadratic bricks of its own about the bore, held on the half of the rim from which the pin pulls. The wall is
pressed by a cosine over 180 degrees, in hats along the bore; the pin is a beam of Euler and Bernoulli. Rigid motions of
the eye do not matter, since force and couple are given. Nothing of alula is used.

    python -m benchmarks.bore_stiffness
"""

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.sparse import coo_array
from scipy.sparse.linalg import splu

Real = NDArray[np.float64]
_G, _WG = np.polynomial.legendre.leggauss(3)


def _line(x: Real) -> tuple[Real, Real]:
    return np.stack([x * (x - 1) / 2, 1 - x**2, x * (x + 1) / 2], -1), np.stack([x - 0.5, -2 * x, x + 0.5], -1)


def wall_compliance(
    length: float, ratio: float, nu: float = 0.3, around: int = 24, radial: int = 5, high: int = 8
) -> Real:
    """Work (n, n) of hats of pressure along the bore on the displacements under hats; E = 1, radius 1."""
    angle = np.linspace(0, 2 * math.pi, 2 * around, endpoint=False)
    radius = ratio ** np.linspace(0, 1, 2 * radial + 1) ** 1.3
    z = length * np.linspace(-0.5, 0.5, 2 * high + 1)
    r, a, h = np.meshgrid(radius, angle, z, indexing="ij")
    places = np.stack([r * np.cos(a), r * np.sin(a), h], -1).reshape(-1, 3)
    shape = r.shape
    i, j, k = (2 * m.ravel() for m in np.meshgrid(range(radial), range(around), range(high), indexing="ij"))
    at = [(p, q, s) for p in range(3) for q in range(3) for s in range(3)]
    cells = np.stack([((i + p) * shape[1] + (j + q) % shape[1]) * shape[2] + k + s for p, q, s in at], 1)
    v, s = _line(_G)
    slope = np.stack([np.einsum("ai,bj,ck->abcijk", *f).reshape(27, 27) for f in ((s, v, v), (v, s, v), (v, v, s))], -1)
    weight = np.einsum("a,b,c->abc", _WG, _WG, _WG).ravel()
    jacobian = np.einsum("ens,qnd->eqsd", places[cells], slope)
    size = np.abs(np.linalg.det(jacobian)) * weight
    grad = np.einsum("qnd,eqds->eqns", slope, np.linalg.inv(jacobian))
    nu = 0.3
    lame, mu = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    local = lame * np.einsum("eqni,eqmj,eq->enimj", grad, grad, size, optimize=True)
    local += mu * np.einsum("eqnj,eqmi,eq->enimj", grad, grad, size, optimize=True)
    local += mu * np.einsum("eqnk,eqmk,eq,ij->enimj", grad, grad, size, np.eye(3), optimize=True)
    dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), 81)
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    n = 3 * len(places)
    stiffness = coo_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n)).tocsc()
    held = (np.hypot(*places[:, :2].T) > ratio - 1e-6) & (places[:, 0] < -1e-6)
    free = np.flatnonzero(np.repeat(~held, 3))
    force = np.zeros((n, high + 1))
    step, turn = length / high, math.pi / around
    for ja in range(around):
        for kz in range(high):
            nodes = np.array([[((2 * ja + q) % shape[1]) * shape[2] + 2 * kz + s for s in range(3)] for q in range(3)])
            theta = angle[2 * ja] + turn * (1 + _G)
            p = 2 / math.pi * np.where(np.cos(theta) > 0, np.cos(theta), 0)  # of a unit force per length, radius 1
            for end, hat in ((0, (1 - _G) / 2), (1, (1 + _G) / 2)):
                share = np.einsum("a,ai,a->i", p * turn * _WG, v, np.ones(3))[:, None] * ((step / 2 * _WG * hat) @ v)
                out = places[nodes][:, :, :2] / 1.0
                for axis in range(2):
                    np.add.at(force[:, kz + end], 3 * nodes + axis, share * out[:, :, axis])
    moved = np.zeros_like(force)
    solver = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    moved[free] = solver.solve(force[free])
    return force.T @ moved


def pressure(compliance: Real, length: float, pin: float, force: float, couple: float) -> Real:
    """Pressure per length at the hats' nodes of a pin of modulus ``pin`` under loads at its upper rim."""
    n = len(compliance)
    h, second = length / (n - 1), math.pi / 4
    stiff, couples = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, n))
    own = pin * second / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2], [-12, -6 * h, 12, -6 * h],
         [6 * h, 2 * h**2, -6 * h, 4 * h**2]]
    )  # fmt: skip
    x, w = (1 + _G) / 2, _WG / 2 * h
    beam = np.stack([1 - 3 * x**2 + 2 * x**3, h * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3, h * (x**3 - x**2)], 1)
    for e in range(n - 1):
        stiff[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += own
        couples[2 * e : 2 * e + 4, e : e + 2] += np.einsum("q,qa,qb->ab", w, beam, np.stack([1 - x, x], 1))
    load = np.zeros(3 * n)
    load[2 * n - 2], load[2 * n - 1] = force, couple
    whole = np.block([[stiff, couples], [couples.T, -compliance]])
    return np.linalg.solve(whole, load)[2 * n :]


def winkler(length: float, n: int, k: float) -> Real:
    """Compliance of a wall that answers by k per length."""
    h = length / (n - 1)
    found = np.zeros((n, n))
    for e in range(n - 1):
        found[e : e + 2, e : e + 2] += h / 6 * np.array([[2.0, 1.0], [1.0, 2.0]])
    return found / k


def best_stiffness(wall: Real, length: float, load: tuple[float, float]) -> float:
    """Return k over E that gives the pressure away from the rims best, of a pin of the eye's modulus."""
    solid = pressure(wall, length, 1.0, *load)

    def off(k: float) -> float:
        found = pressure(winkler(length, len(solid), k), length, 1.0, *load)
        return float(((found - solid)[1:-1] ** 2).sum())

    return float(minimize_scalar(off, bounds=(0.05, 4.0), method="bounded").x)


def main() -> None:
    """Print the loaded rim's pressure over the linear one, of a stiff pin and of one of the eye's modulus, and k."""
    for ratio, slender in itertools.product((2.0, 2.67, 4.0), (1.2, 1.6, 2.4)):
        length = 2 * slender
        wall = wall_compliance(length, ratio)
        for name, load, linear in (("force", (1.0, 0.0), 4 / length), ("couple", (0.0, 1.0), 6 / length**2)):
            stiff, soft = (pressure(wall, length, modulus, *load)[-1] / linear for modulus in (1e4, 1.0))
            k = best_stiffness(wall, length, load)
            print(
                f"D/d {ratio}, t/d {slender}, {name}: stiff {stiff:.2f}, soft {soft:.2f}, best k {k:.2f} E", flush=True
            )


if __name__ == "__main__":
    main()
