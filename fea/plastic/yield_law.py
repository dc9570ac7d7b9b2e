"""The plastic law of an isotropic ductile material: stress and tangent at points, for a strain and what went before.

Von Mises, or where compression yields later than tension Raghava's paraboloid (Raghava, Caddell & Yeh, J. Mater. Sci.
8, 1973, 225-232): with q the von Mises stress, I = tr σ, t the yield stress in tension and m t in compression,

    q² + (m - 1) t I = m t²

which is von Mises for m = 1. Flow is normal to it, the work-conjugate plastic strain ε̄ is that of a tension test,
t = t(ε̄), and the step is implicit Euler's. So a step minimises a convex energy of the strain, and its tangent is
symmetric (Simo & Hughes, Computational Inelasticity, 1998, sections 2.6 and 3.3).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.elasticity import lame_constants
from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]

_TRACE = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
_SHEAR_TWICE = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
_DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]) - np.outer(_TRACE, _TRACE) / 3.0
"""From strains, whose shears are the engineer's, to the deviator as a tensor."""
_FLAT = 1e3
"""Plastic strain up to which a curve is carried on flat; far beyond any that a small-strain path reaches."""
_STEPS = 80
"""At most, of Newton's method inside a bracket; bisection alone takes 50 to double precision."""


@dataclass(frozen=True, kw_only=True, eq=False)
class YieldLaw:
    """Elastic constants and the yield stress in tension over the plastic strain.

    Attributes
    ----------
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    strength : float
        Yield stress in tension before any plastic strain [MPa].
    compression : float
        Yield stress in compression over that in tension, at least 1.
    hardening : tuple of tuple of 2 float
        (plastic strain, yield stress over ``strength``), rising in strain; straight between, flat beyond. None of them
        for perfect plasticity.
    """

    E: float
    nu: float
    strength: float
    compression: float = 1.0
    hardening: tuple[tuple[float, float], ...] = ()
    _curve: tuple[Real, Real] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Lay out the curve, from no strain to a flat end."""
        rows = [(0.0, 1.0), *(row for row in self.hardening if row[0] > 0.0)]
        strain, factor = np.array([*rows, (_FLAT, rows[-1][1])]).T
        object.__setattr__(self, "_curve", (strain, self.strength * factor))

    def yield_stress(self, strain: Real) -> Real:
        """Return the yield stress in tension.

        Parameters
        ----------
        strain : ndarray
            Equivalent plastic strain.

        Returns
        -------
        ndarray
            [MPa]
        """
        return np.asarray(np.interp(strain, *self._curve))

    def hardens_beyond(self, strain: float, share: float) -> bool:
        """Return whether the yield stress still rises by more than a share of it, as behind a plateau.

        Parameters
        ----------
        strain : float
            Equivalent plastic strain.
        share : float

        Returns
        -------
        bool
        """
        return bool(self._curve[1][-1] > (1.0 + share) * self.yield_stress(np.array(strain)))

    def _slope(self, strain: Real) -> Real:
        at, stress = self._curve
        number = np.clip(np.searchsorted(at, strain, side="right") - 1, 0, len(at) - 2)
        return np.asarray((np.diff(stress) / np.diff(at))[number])

    @property
    def stiffness(self) -> Real:
        """The elastic law (6, 6) [MPa]."""
        lam, mu = lame_constants(self.E, self.nu)
        return lam * np.outer(_TRACE, _TRACE) + mu * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])

    def share(self, stress: Real) -> Real:
        """Return the equivalent stress over ``strength``: 1 where an elastic stress begins to yield.

        Parameters
        ----------
        stress : ndarray, shape (..., 6)
            [MPa]

        Returns
        -------
        ndarray, shape (...)
        """
        trace, deviator, m = stress @ _TRACE, stress - (stress @ _TRACE)[..., None] / 3.0 * _TRACE, self.compression
        square = 1.5 * (deviator**2 @ _SHEAR_TWICE)
        slope = (m - 1.0) * trace
        return np.asarray((slope + np.sqrt(slope**2 + 4.0 * m * square)) / (2.0 * m) / self.strength)

    def respond(self, strain: Real, past: "Past", *, tangent: bool = True) -> "PointResponse":
        """Return what a strain makes of the points.

        Parameters
        ----------
        strain : ndarray, shape (n, 6)
            Total strain; shears are the engineer's.
        past : Past
            What went before.
        tangent : bool, optional
            Whether the tangent is wanted.

        Returns
        -------
        PointResponse
        """
        lam, mu = lame_constants(self.E, self.nu)
        bulk, m = lam + 2.0 * mu / 3.0, self.compression
        elastic = strain - past.strain
        trial, trace = 2.0 * mu * (elastic @ _DEVIATOR), 3.0 * bulk * (elastic @ _TRACE)
        square = 1.5 * (trial**2 @ _SHEAR_TWICE)
        t = self.yield_stress(past.equivalent)
        plastic = square + (m - 1.0) * t * trace > m * t * t
        stress = trial + trace[:, None] / 3.0 * _TRACE
        C = np.broadcast_to(self.stiffness, (len(strain), 6, 6)).copy() if tangent else None
        new, equivalent = past.strain.copy(), past.equivalent.copy()
        if plastic.any():
            at = np.flatnonzero(plastic)
            S, J, before = square[at], trace[at], past.equivalent[at]
            d = self._flow(S, J, before)
            t, H = self.yield_stress(before + d), self._slope(before + d)
            amount = self._amount(d, J, t)
            A, M = 1.0 + 6.0 * mu * amount, 9.0 * bulk * (m - 1.0)
            s, first = trial[at] / A[:, None], J - M * t * amount
            stress[at] = s + first[:, None] / 3.0 * _TRACE
            new[at] += amount[:, None] * (3.0 * s * _SHEAR_TWICE + ((m - 1.0) * t)[:, None] * _TRACE)
            equivalent[at] += d
            if C is not None:
                C[at] = self._tangent(trial[at], S, first, amount, t, H)
        return PointResponse(stress=stress, tangent=C, past=Past(strain=new, equivalent=equivalent), plastic=plastic)

    def _amount(self, d: Real, J: Real, t: Real) -> Real:
        """Return γ of the plastic strain γ (3 s + (m - 1) t 1): the root of d = γ (2 m t - (m - 1) I(γ))."""
        lam, mu = lame_constants(self.E, self.nu)
        m = self.compression
        a = 9.0 * (lam + 2.0 * mu / 3.0) * (m - 1.0) ** 2 * t
        b = 2.0 * m * t - (m - 1.0) * J
        root = np.sqrt(b * b + 4.0 * a * d)
        with np.errstate(divide="ignore", invalid="ignore"):  # of the two forms the one that keeps its digits is taken
            return np.where(b > 0.0, 2.0 * d / (b + root), (root - b) / (2.0 * a))

    def _flow(self, S: Real, J: Real, before: Real) -> Real:
        """Return the increments of the equivalent plastic strain that bring the stress back onto the yield surface."""
        _, mu = lame_constants(self.E, self.nu)
        m = self.compression
        if m == 1.0:  # q - 3 G d = t: the curve of t + 3 G ε̄ is read the other way round
            at, stress = self._curve
            return np.interp(np.sqrt(S) + 3.0 * mu * before, stress + 3.0 * mu * at, at) - before
        lam, _ = lame_constants(self.E, self.nu)
        M = 9.0 * (lam + 2.0 * mu / 3.0) * (m - 1.0)

        def beyond(d: Real) -> Real:
            t = self.yield_stress(before + d)
            amount = self._amount(d, J, t)
            return S / (1.0 + 6.0 * mu * amount) ** 2 + (m - 1.0) * t * (J - M * t * amount) - m * t * t

        low, high = np.zeros_like(S), np.full_like(S, self.strength / self.E)
        while (short := beyond(high) > 0.0).any():
            low, high = np.where(short, high, low), np.where(short, 2.0 * high, high)
            if high.max() > _FLAT:
                raise CannotRunError("the yield law finds no stress on the yield surface; the step is too large")
        # Regula falsi, Illinois (Dowell & Jarratt, BIT 11, 1971), keeps the bracket.
        f_low, f_high = beyond(low), beyond(high)
        for _ in range(_STEPS):
            d = np.where(
                f_low > f_high, (low * f_high - high * f_low) / np.where(f_high == f_low, 1.0, f_high - f_low), low
            )
            f = beyond(d)
            right = f < 0.0
            low, f_low, high, f_high = (
                np.where(right, low, d),
                np.where(right, 0.5 * f_low, f),
                np.where(right, d, high),
                np.where(right, f, 0.5 * f_high),
            )
            if (np.abs(f) <= 1e-13 * m * self.strength**2).all() or (high - low <= 1e-15 * high).all():
                return d
        return 0.5 * (low + high)

    def _tangent(self, trial: Real, S: Real, first: Real, amount: Real, t: Real, H: Real) -> Real:
        """Return ∂σ/∂ε (n, 6, 6).

        The two equations of γ and d are differentiated by S = q² and J = I of the trial stress; ``first`` is I of the
        stress itself.
        """
        lam, mu = lame_constants(self.E, self.nu)
        m, bulk = self.compression, lam + 2.0 * mu / 3.0
        c, A = m - 1.0, 1.0 + 6.0 * mu * amount
        I_g, I_d = -9.0 * bulk * c * t, -9.0 * bulk * c * amount * H
        # yielding: S/A² + c t I - m t² = 0;  conjugate strain: d - γ (2 m t - c I) = 0
        y_g, y_d = -12.0 * mu * S / A**3 + c * t * I_g, c * H * first + c * t * I_d - 2.0 * m * t * H
        w_g, w_d = -(2.0 * m * t - c * first) + amount * c * I_g, 1.0 - 2.0 * m * amount * H + amount * c * I_d
        y_S, y_J, w_J = 1.0 / A**2, c * t, amount * c
        det = y_g * w_d - y_d * w_g
        g_S = -y_S * w_d / det
        g_J, d_J = -(y_J * w_d - w_J * y_d) / det, -(w_J * y_g - y_J * w_g) / det
        ss = -6.0 * mu / A**2 * 6.0 * mu * g_S
        sv = -6.0 * mu / A**2 * 3.0 * bulk * g_J  # = that of (1 ⊗ s), since the tangent is symmetric
        vv = bulk * (1.0 - 9.0 * bulk * c * (t * g_J + amount * H * d_J))
        mixed = trial[:, :, None] * _TRACE
        return np.asarray(
            (2.0 * mu / A)[:, None, None] * _DEVIATOR
            + ss[:, None, None] * trial[:, :, None] * trial[:, None, :]
            + sv[:, None, None] * (mixed + mixed.transpose(0, 2, 1))
            + vv[:, None, None] * np.outer(_TRACE, _TRACE)
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Past:
    """What points have gone through.

    Attributes
    ----------
    strain : ndarray, shape (n, 6)
        Plastic strain; shears are the engineer's.
    equivalent : ndarray, shape (n,)
        Equivalent plastic strain, which never falls.
    """

    strain: Real
    equivalent: Real

    @classmethod
    def none(cls, count: int) -> "Past":
        """Return points that have not yielded.

        Parameters
        ----------
        count : int
            Their number.

        Returns
        -------
        Past
        """
        return cls(strain=np.zeros((count, 6)), equivalent=np.zeros(count))


@dataclass(frozen=True, kw_only=True, eq=False)
class PointResponse:
    """What a strain makes of points.

    Attributes
    ----------
    stress : ndarray, shape (n, 6)
        [MPa]
    tangent : ndarray or None, shape (n, 6, 6)
        Its derivative by the strain [MPa].
    past : Past
        What has then gone before.
    plastic : ndarray of bool, shape (n,)
        Where it flows.
    """

    stress: Real
    tangent: Real | None
    past: Past
    plastic: NDArray[np.bool_]
