"""What the search over where pins stand seeks: ends of thrusts, and most and least stress of links and pins.

Thrusts, and couples on links without a beam, are linear functions of where pins stand. The stress of a plain section is
a convex one, of bending in the plane, bending out of it and torque together; a link's or a pin's is that of the end of
its beams that bears most, for which the sum of high powers stands where it is least.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.pins.holes import BeamEnds

Real = NDArray[np.float64]
Index = NDArray[np.int64]
ALIKE = 1e-6
"""Share by which two linear functions differ."""
POWER = 8.0
"""Of the sum that stands for the largest of a link's stresses, which is smooth."""
NOTHING = 1e-12
"""Stress in place of none [MPa]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Aims:
    """Functions of where pins stand, each to be made as large as it gets.

    Attributes
    ----------
    linear : ndarray, shape (a, v)
        Their first ones.
    ends : BeamEnds
        e ends: those whose stress depends on where pins stand. That of each but those within eyes is a further one.
    of_links : ndarray of bool, shape (l, e)
        Ends of each link and of each pin, whose largest stress is to be least.
    """

    linear: Real
    ends: BeamEnds
    of_links: NDArray[np.bool_]

    @property
    def count(self) -> int:
        """Of all functions."""
        return len(self.linear) + self._alone + len(self.of_links)

    @property
    def _alone(self) -> int:
        """Of ends whose stress is sought by itself."""
        return int((~self.ends.within).sum())

    def values(self, v: Real) -> Real:
        """Return all functions.

        Parameters
        ----------
        v : ndarray, shape (n, v)

        Returns
        -------
        ndarray, shape (n, ``count``)
        """
        each, _ = self._each(v)
        return np.hstack([v @ self.linear.T, each[:, : self._alone], -self._largest(each)])

    def stresses(self, v: Real) -> Real:
        """Return the stress of every end, then what is largest where that of a link or a pin is least.

        Parameters
        ----------
        v : ndarray, shape (n, v)

        Returns
        -------
        ndarray, shape (n, e + l)
            [MPa]
        """
        each, _ = self._each(v)
        return np.hstack([each, -self._largest(each)])

    def slopes(self, v: Real, which: Index) -> Real:
        """Return how functions change with where pins stand.

        Parameters
        ----------
        v : ndarray, shape (n, v)
        which : ndarray of int, shape (n,)
            Of all functions.

        Returns
        -------
        ndarray, shape (n, v)
        """
        found, (first, count) = np.empty_like(v), (len(self.linear), self._alone)
        linear = which < first
        found[linear] = self.linear[which[linear]]
        which, own = which[~linear] - first, v[~linear]
        each, by_forces = self._each(own)
        share = np.zeros_like(each)
        most, least = np.flatnonzero(which < count), np.flatnonzero(which >= count)
        share[most, which[most]] = 1.0
        link = which[least] - count
        largest = self._largest(each[least])[np.arange(len(least)), link]
        share[least] = -1.0 * self.of_links[link] * (each[least] / largest[:, None]) ** (POWER - 1.0)
        found[~linear] = np.einsum("ne,nef,efv->nv", share, by_forces, self.ends.by_rims, optimize=True)
        return found

    def _each(self, v: Real) -> tuple[Real, Real]:
        """Stress (n, e) of every end, and its slope (n, e, 4) by those that add up to it."""
        parts = self.ends.tight + np.einsum("efv,nv->nef", self.ends.by_rims, v)
        axial, inside, across, shear = np.moveaxis(parts, 2, 0)
        bent = np.hypot(inside, across)
        ways = [np.divide(one, bent, out=np.zeros_like(bent), where=bent > 0.0) for one in (inside, across)]
        along, beside = (
            np.where(self.ends.round, w, np.sign(one)) for w, one in zip(ways, (inside, across), strict=True)
        )
        normal = np.abs(axial) + np.where(self.ends.round, bent, np.abs(inside) + np.abs(across))
        stress = np.maximum(np.hypot(normal, shear), NOTHING)
        by_normal = normal / stress
        slope = [by_normal * np.sign(axial), by_normal * along, by_normal * beside, shear / stress]
        return stress, np.stack(slope, axis=2)

    def _largest(self, each: Real) -> Real:
        top = np.where(self.of_links, each[:, None], 0.0).max(axis=2, keepdims=True, initial=NOTHING)
        powers = (np.where(self.of_links, each[:, None], 0.0) / top) ** POWER
        return np.asarray(top[..., 0] * powers.sum(axis=2) ** (1.0 / POWER))


@dataclass(frozen=True, kw_only=True, eq=False)
class Nearest:
    """How far a point moves, less than nothing: functions of where pins stand, each to be made as large as it gets.

    Attributes
    ----------
    tight : ndarray, shape (n, 3)
        What it may move with tight pins [mm].
    by_rims : ndarray, shape (3, v)
        What the variables of the rims add.
    """

    tight: Real
    by_rims: Real

    @property
    def count(self) -> int:
        """Of all functions."""
        return len(self.tight)

    def values(self, v: Real) -> Real:
        """Return all functions.

        Parameters
        ----------
        v : ndarray, shape (m, v)

        Returns
        -------
        ndarray, shape (m, n)
            [mm]
        """
        return np.asarray(-np.linalg.norm(self.tight + (v @ self.by_rims.T)[:, None], axis=2))

    def slopes(self, v: Real, which: Index) -> Real:
        """Return how functions change with where pins stand.

        Parameters
        ----------
        v : ndarray, shape (m, v)
        which : ndarray of int, shape (m,)
            Of all functions.

        Returns
        -------
        ndarray, shape (m, v)
        """
        moved = self.tight[which] + v @ self.by_rims.T
        size = np.linalg.norm(moved, axis=1, keepdims=True)
        return np.asarray(-np.divide(moved, size, out=np.zeros_like(moved), where=size > 0.0) @ self.by_rims)


def aims_of(couples: Real, ends: BeamEnds, noise: float) -> Aims:
    """Return what is sought.

    Parameters
    ----------
    couples : ndarray, shape (c, v)
        Couples and thrusts by where pins stand.
    ends : BeamEnds
    noise : float
        Couple by a unit at a rim below which there is none but by rounding [N].

    Returns
    -------
    Aims
    """
    linear = _unlike(couples[np.abs(couples).max(axis=1) > noise])
    open_ends = np.flatnonzero(ends.by_rims.any(axis=(1, 2)))
    ends = ends.of(open_ends)
    owners = dict.fromkeys(ends.owners)
    return Aims(
        linear=np.vstack([linear, -linear]),
        ends=ends,
        of_links=np.array([[other == one for other in ends.owners] for one in owners], dtype=bool).reshape(
            len(owners), len(ends.owners)
        ),
    )


def _unlike(aims: Real) -> Real:
    """Those rows that are no multiples of others."""
    unit = aims / np.linalg.norm(aims, axis=1, keepdims=True)
    apart = [
        np.minimum(np.abs(unit[:k] - one).max(axis=1), np.abs(unit[:k] + one).max(axis=1)) for k, one in enumerate(unit)
    ]
    return np.asarray(aims[[k for k, one in enumerate(apart) if not (one < ALIKE).any()]])
