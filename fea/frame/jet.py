"""Second-order forward differentiation of arrays: value, gradient and Hessian carried through the arithmetic.

A ``Jet`` stands for c functions of k variables at m points at once. Sums and products are differentiated by the
product rule and nothing is cut off, so that gradients and Hessians are exact to rounding (Griewank & Walther,
Evaluating Derivatives, 2nd ed., 2008, chapter 13).
"""

from dataclasses import dataclass

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

    def sum(self) -> "Jet":
        """Return the sum of the components, as one component."""
        return Jet(
            value=self.value.sum(axis=1, keepdims=True),
            gradient=self.gradient.sum(axis=1, keepdims=True),
            hessian=self.hessian.sum(axis=1, keepdims=True),
        )

    def map(self, matrices: Floats) -> "Jet":
        """Combine the components linearly.

        Parameters
        ----------
        matrices : ndarray, shape (m, d, c)
            Constants.

        Returns
        -------
        Jet
            d components.
        """
        return Jet(
            value=np.einsum("mdc,mc->md", matrices, self.value),
            gradient=np.einsum("mdc,mck->mdk", matrices, self.gradient),
            hessian=np.einsum("mdc,mckl->mdkl", matrices, self.hessian),
        )


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
    return (a * b).sum()


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
    return a[[1, 2, 0]] * b[[2, 0, 1]] - a[[2, 0, 1]] * b[[1, 2, 0]]


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
