"""Stress on the layers of a printed part: tension normal to them, shear along them, and both against their strengths.

Layers part where (⟨σn⟩/Rn)² + (τ/Rt)² = 1, with the positive part ⟨σn⟩ of the normal stress, the resultant shear stress
τ on the plane of the layers, and their strengths Rn and Rt.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Layers:
    """Direction and strengths of the layers of a part.

    The criterion is the quadratic one for the initiation of delamination. Compression normal to the layers neither
    helps nor harms. (Friction would help; crushing is no parting of layers.)

    Attributes
    ----------
    normal : tuple of 3 float
        The direction in which the part was built, in its link's frame; of any length.
    across : float
        Strength against tension normal to the layers, Rn [MPa].
    between : float or None
        Strength against shear along them, Rt [MPa]; None where it is not known, and shear is left out.

    References
    ----------
    The formula is the "quadratic nominal stress" criterion by which cohesive elements begin to part (Abaqus, criterion
    QUADS; LS-DYNA, *MAT_240), checked against descriptions of these. It is ascribed to J. C. Brewer and P. A. Lagace,
    J. Compos. Mater. 22 (1988) 1141-1155, and with the positive part of the normal stress to P. P. Camanho and C. G.
    Davila, NASA/TM-2002-211737; the text of neither was at hand.
    """

    normal: tuple[float, float, float]
    across: float
    between: float | None

    def stress(self, sigma: Real) -> Real:
        """Return the stress that is set against the strength across the layers.

        Parameters
        ----------
        sigma : ndarray, shape (..., 6)
            Components in the order of ``alula.fea.solid.stress.COMPONENTS`` [MPa].

        Returns
        -------
        ndarray, shape (...)
            √(⟨σn⟩² + (Rn/Rt)² τ²) [MPa]: strength over it is the safety factor.
        """
        tension, shear = on_plane(sigma, self.normal)
        share = 0.0 if self.between is None else self.across / self.between
        return np.asarray(np.hypot(np.maximum(tension, 0.0), share * shear))

    @property
    def sensitivity(self) -> float:
        """Largest ratio of what this stress misses to the von Mises stress of the error.

        A deviator of von Mises stress v has at most 2/3 v across a plane and v/√3 along it. As with the principal
        stress, the error's mean stress is taken to be no larger than the rest of v.
        """
        share = 0.0 if self.between is None else self.across / self.between
        return max(1.0, share / math.sqrt(3.0))

    def parts(self, stress: Real) -> Real:
        """Return three numbers, linear in the stress, whose length is at least that of ``stress``.

        Parameters
        ----------
        stress : ndarray, shape (nodes, 6, m)
            Components [MPa].

        Returns
        -------
        ndarray, shape (nodes, 3, m)
            Normal stress, and Rn/Rt times shear along two directions [MPa].
        """
        n = np.asarray(self.normal) / np.linalg.norm(self.normal)
        along = np.linalg.svd(n[None])[2][1:]  # two directions that span the plane
        x, y, z = n
        xx, yy, zz, xy, yz, xz = np.moveaxis(stress, 1, 0)
        traction = np.stack([xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z], axis=1)
        share = 0.0 if self.between is None else self.across / self.between
        return np.asarray(np.vstack([n, share * along]) @ traction)

    @property
    def mirrored(self) -> "Layers":
        """The same layers as the image at z = 0 has them."""
        x, y, z = self.normal
        return replace(self, normal=(x, y, -z))


def on_plane(sigma: Real, normal: ArrayLike) -> tuple[Real, Real]:
    """Return normal and shear stress on planes: t = σ n, σn = n·t, τ = |t − σn n|.

    Parameters
    ----------
    sigma : ndarray, shape (..., 6)
        Components [MPa].
    normal : array, shape (3,) or (d, 3)
        Normals of the planes, of any length.

    Returns
    -------
    tuple of 2 ndarray
        Normal stress, positive in tension, and resultant shear stress (...) or (..., d) [MPa].
    """
    n = np.asarray(normal, dtype=np.float64)
    n = n / np.linalg.norm(n, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(n, -1, 0)
    xx, yy, zz, xy, yz, xz = np.moveaxis(sigma if n.ndim == 1 else sigma[..., None, :], -1, 0)
    traction = xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z
    along = traction[0] * x + traction[1] * y + traction[2] * z
    rest = [t - along * c for t, c in zip(traction, (x, y, z), strict=True)]
    return np.asarray(along), np.sqrt(rest[0] ** 2 + rest[1] ** 2 + rest[2] ** 2)


def in_worst_direction(principal: float, von_mises: float, ratio: float) -> float:
    """Return a bound on the stress of ``Layers.stress`` for layers of any direction.

    For a given normal stress, Mohr's circle of the largest and the least principal stress, of centre c and radius r,
    has the largest shear stress: σn = c + r x and τ² = r² (1 - x²). What it makes is convex in r where c = σ1 - r, so
    that it is largest at r = 0 or at the largest radius, which is at most v/√3 at a von Mises stress v.

    Parameters
    ----------
    principal : float
        Largest principal stress of all places, not negative [MPa].
    von_mises : float
        Largest von Mises stress of all places [MPa].
    ratio : float
        Strength across the layers over that against shear along them, Rn/Rt.

    Returns
    -------
    float
        [MPa]
    """
    r, k = von_mises / math.sqrt(3.0), ratio
    c = principal - r
    x = 1.0 if k * k * r <= r + abs(c) else c / (r * (k * k - 1.0))
    found = [max(c + r * x, 0.0) ** 2 + k * k * r * r * (1.0 - x * x) for x in (x, 0.0, 1.0)]
    return math.sqrt(max(principal**2, *found))


POLAR, AZIMUTH = 19, 72
"""Steps of 5° from the axis of the pins to the linkage's plane, and about it."""
_NODES = 100


def build_directions() -> Real:
    """Return directions over half the sphere, (POLAR, AZIMUTH, 3); each and its opposite have the same layers.

    The angle to the pins' axis z grows along the first axis, from 0 to 90°, the one about it along the second, from x.
    """
    polar = np.linspace(0.0, np.pi / 2.0, POLAR)[:, None]
    about = np.arange(AZIMUTH) * 2.0 * np.pi / AZIMUTH
    x, y = np.sin(polar) * np.cos(about), np.sin(polar) * np.sin(about)
    found = np.stack(np.broadcast_arrays(x, y, np.cos(polar)), axis=-1)
    return np.where(np.abs(found) < 1e-12, 0.0, found)


def best_directions(fields: Iterable[Real], layers: Layers) -> Real:
    """Return the least safety factor of a part for every direction in which it may be built.

    A node's stress on layers of any direction is at most its stress tensor's Frobenius norm times the larger of 1 and
    Rn/Rt. So only nodes that by this bound may matter for some direction are looked at.

    Parameters
    ----------
    fields : iterable of ndarray, shape (n, 6)
        Nodal stress under each load [MPa].
    layers : Layers
        With both strengths; its own direction plays no part.

    Returns
    -------
    ndarray, shape (POLAR, AZIMUTH)
        For ``build_directions``; infinite without stress.
    """
    assert layers.between is not None
    share = layers.across / layers.between
    x, y, z = build_directions().reshape(-1, 3).T
    normal = np.array([x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * x * z])
    worst = np.zeros_like(x)
    for sigma in fields:
        bound = max(1.0, share) * np.sqrt((sigma**2 * (1.0, 1.0, 1.0, 2.0, 2.0, 2.0)).sum(axis=1))
        order = np.argsort(-bound)
        for start in range(0, len(order), _NODES):
            part = order[start : start + _NODES]
            left = np.flatnonzero(worst < bound[part[0]])
            if not left.size:
                break
            along, square = sigma[part] @ normal[:, left], _product(sigma[part]) @ normal[:, left]
            square -= along**2
            found = np.maximum(along, 0.0, out=along) ** 2 + share**2 * np.maximum(square, 0.0, out=square)
            worst[left] = np.maximum(worst[left], np.sqrt(found.max(axis=0)))
    with np.errstate(divide="ignore"):
        return np.asarray(layers.across / worst).reshape(POLAR, AZIMUTH)


def _product(sigma: Real) -> Real:
    """Components (n, 6) of the tensors' squares: n·σ²n is the squared traction on a plane of normal n."""
    xx, yy, zz, xy, yz, xz = sigma.T
    return np.column_stack(
        [xx**2 + xy**2 + xz**2, xy**2 + yy**2 + yz**2, xz**2 + yz**2 + zz**2,
         xx * xy + xy * yy + xz * yz, xy * xz + yy * yz + yz * zz, xx * xz + xy * yz + xz * zz]
    )  # fmt: skip
