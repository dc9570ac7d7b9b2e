"""Second-order forward differentiation of arrays: value, gradient and Hessian carried through the arithmetic.

A ``Jet`` stands for c functions of k variables at m points at once. Sums and products are differentiated by the
product rule and nothing is cut off, so that gradients and Hessians are exact to rounding (Griewank & Walther,
Evaluating Derivatives, 2nd ed., 2008, chapter 13).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Jet:
    """Values of functions with their first two derivatives.

    Attributes
    ----------
    value : ndarray, shape (m, c)
        Of c functions at m points.
    gradient : ndarray, shape (m, c, k)
        By k variables.
    hessian : ndarray, shape (m, c, k, k)
        By k variables.
    """

    value: Floats
    gradient: Floats
    hessian: Floats

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(
            value=self.value + other.value,
            gradient=self.gradient + other.gradient,
            hessian=self.hessian + other.hessian,
        )

    def __sub__(self, other: "Jet") -> "Jet":
        return self + other.times(-1.0)

    def __mul__(self, other: "Jet") -> "Jet":
        """Component by component; a single component spreads over the others."""
        a, b = self, other
        mixed = a.gradient[..., :, None] * b.gradient[..., None, :]
        return Jet(
            value=a.value * b.value,
            gradient=a.value[..., None] * b.gradient + b.value[..., None] * a.gradient,
            hessian=a.value[..., None, None] * b.hessian
            + b.value[..., None, None] * a.hessian
            + mixed
            + np.swapaxes(mixed, -1, -2),
        )

    def __getitem__(self, components: list[int]) -> "Jet":
        return Jet(
            value=self.value[:, components], gradient=self.gradient[:, components], hessian=self.hessian[:, components]
        )

    def times(self, factor: float | Floats) -> "Jet":
        """Multiply by constants.

        Parameters
        ----------
        factor : float or ndarray
            A number, or an array that spreads over (m, c).

        Returns
        -------
        Jet
            The product.
        """
        f = np.asarray(factor, dtype=np.float64)
        return Jet(
            value=self.value * f,
            gradient=self.gradient * (f[..., None] if f.ndim else f),
            hessian=self.hessian * (f[..., None, None] if f.ndim else f),
        )

    def apply(self, f: Floats, slope: Floats, curvature: Floats) -> "Jet":
        """Apply a function to each component.

        Parameters
        ----------
        f : ndarray, shape (m, c)
            Its value at each component.
        slope : ndarray, shape (m, c)
            Its first derivative.
        curvature : ndarray, shape (m, c)
            Its second derivative.

        Returns
        -------
        Jet
            The function of each component.
        """
        outer = self.gradient[..., :, None] * self.gradient[..., None, :]
        return Jet(
            value=f,
            gradient=slope[..., None] * self.gradient,
            hessian=slope[..., None, None] * self.hessian + curvature[..., None, None] * outer,
        )

    def power(self, exponent: float) -> "Jet":
        """Raise each component to a constant power.

        Parameters
        ----------
        exponent : float
            Constant.

        Returns
        -------
        Jet
            The powers.
        """
        x, n = self.value, exponent
        return self.apply(x**n, n * x ** (n - 1.0), n * (n - 1.0) * x ** (n - 2.0))

    def map(self, matrices: Floats) -> "Jet":
        """Combine the components linearly.

        Parameters
        ----------
        matrices : ndarray, shape (m, d, c) or (d, c)
            Constants.

        Returns
        -------
        Jet
            d components.
        """
        return Jet(
            value=np.matmul(matrices, self.value[..., None])[..., 0],
            gradient=np.matmul(matrices, self.gradient),
            hessian=_combined(matrices, self.hessian),
        )

    def form(self, matrices: Floats) -> "Jet":
        """Return the quadratic form of the components.

        Parameters
        ----------
        matrices : ndarray, shape (m, c, c) or (c, c)
            Constant, symmetric.

        Returns
        -------
        Jet
            One component.
        """
        slope = np.matmul(matrices, self.value[..., None]).swapaxes(1, 2)
        curvature = self.gradient.swapaxes(1, 2) @ np.matmul(matrices, self.gradient)
        return Jet(
            value=slope @ self.value[..., None],
            gradient=2.0 * slope @ self.gradient,
            hessian=2.0 * (_combined(slope, self.hessian) + curvature[:, None]),
        ).flat()

    def flat(self) -> "Jet":
        """Return the same with its components in one row."""
        m, k = len(self.value), self.gradient.shape[-1]
        return Jet(
            value=self.value.reshape(m, -1),
            gradient=self.gradient.reshape(m, -1, k),
            hessian=self.hessian.reshape(m, -1, k, k),
        )

    def rows(self, count: int) -> "Jet":
        """Share the components of every point out to several points.

        Parameters
        ----------
        count : int
            Components of each of the new points.

        Returns
        -------
        Jet
            ``count`` components at more points, or the other way round.
        """
        k = self.gradient.shape[-1]
        return Jet(
            value=self.value.reshape(-1, count),
            gradient=self.gradient.reshape(-1, count, k),
            hessian=self.hessian.reshape(-1, count, k, k),
        )


def _combined(matrices: Floats, hessian: Floats) -> Floats:
    """Combine the components (m, c) of Hessians by matrices (m, d, c) or (d, c)."""
    m, c, k, _ = hessian.shape
    return np.asarray(np.matmul(matrices, hessian.reshape(m, c, k * k)).reshape(m, -1, k, k))


def stack(*parts: Jet) -> Jet:
    """Put the components of several jets one after the other.

    Parameters
    ----------
    *parts : Jet
        One after the other.

    Returns
    -------
    Jet
        All components.
    """
    return Jet(
        value=np.concatenate([p.value for p in parts], axis=1),
        gradient=np.concatenate([p.gradient for p in parts], axis=1),
        hessian=np.concatenate([p.hessian for p in parts], axis=1),
    )


def dot(a: Jet, b: Jet) -> Jet:
    """Return the scalar product over the components.

    Parameters
    ----------
    a : Jet
        First factor.
    b : Jet
        Second factor.

    Returns
    -------
    Jet
        One component.
    """
    first, second = a.value[:, None], b.value[:, None]
    mixed = a.gradient.swapaxes(1, 2) @ b.gradient
    return Jet(
        value=(a.value * b.value).sum(axis=1, keepdims=True),
        gradient=first @ b.gradient + second @ a.gradient,
        hessian=_combined(first, b.hessian) + _combined(second, a.hessian) + (mixed + mixed.swapaxes(1, 2))[:, None],
    )


@dataclass(frozen=True, eq=False)
class Bilinear:
    """Sums of products of components of two jets.

    Attributes
    ----------
    tensor : ndarray, shape (d, c, e)
        Weight of the product of component c of the first and e of the second jet in sum d.
    """

    tensor: Floats

    def __call__(self, a: Jet, b: Jet) -> Jet:
        """Return the sums."""
        d, c, e = self.tensor.shape
        by_a = (b.value @ self.tensor.reshape(d * c, e).T).reshape(-1, d, c)
        by_b = (a.value @ self.tensor.transpose(1, 0, 2).reshape(c, d * e)).reshape(-1, d, e)
        first, second = self._pairs
        weights = self.tensor[np.arange(d)[:, None], first, second][..., None]
        mixed = (a.gradient[:, first] * weights).swapaxes(2, 3) @ b.gradient[:, second]
        return Jet(
            value=np.matmul(by_a, a.value[..., None])[..., 0],
            gradient=by_a @ a.gradient + by_b @ b.gradient,
            hessian=_combined(by_a, a.hessian) + _combined(by_b, b.hessian) + mixed + mixed.swapaxes(2, 3),
        )

    def of(self, a: Floats, b: Floats) -> Floats:
        """Return the sums without derivatives.

        Parameters
        ----------
        a, b : ndarray, shape (m, c) and (m, e)
            Values.

        Returns
        -------
        ndarray, shape (m, d)
        """
        return np.asarray(np.einsum("dce,mc,me->md", self.tensor, a, b, optimize=True))

    @cached_property
    def _pairs(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """(d, n) each: the components whose products stand in each sum; all sums have as many."""
        sums, first, second = np.nonzero(self.tensor)
        count = len(sums) // len(self.tensor)
        return first.reshape(-1, count), second.reshape(-1, count)


def cross(a: Jet, b: Jet) -> Jet:
    """Return the vector product of three components each.

    Parameters
    ----------
    a : Jet
        First factor.
    b : Jet
        Second factor.

    Returns
    -------
    Jet
        Three components.
    """
    return _CROSS(a, b)


EPSILON = np.zeros((3, 3, 3))
"""The permutation symbol: (a × b)_i is the sum of EPSILON[i, j, k] a_j b_k."""
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    EPSILON[_i, _j, _k], EPSILON[_i, _k, _j] = 1.0, -1.0
_CROSS = Bilinear(EPSILON)


def unit(a: Jet) -> Jet:
    """Return the direction of a vector.

    Parameters
    ----------
    a : Jet
        Vector.

    Returns
    -------
    Jet
        Of length one.
    """
    return a * dot(a, a).power(-0.5)
