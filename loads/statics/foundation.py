"""Pressure along a hole by a pin that bends in it: a beam on an elastic foundation, with closed forms.

The wall of the hole answers the pin's sinking w by q = k w per length, with k in proportion to the link's modulus
(``STIFFNESS``). The pin, of modulus E_p and second moment I = π d⁴/64, obeys

    E_p I w'''' + k w = 0,    β⁴ = k/(4 E_p I),    q = Re(A e^{λx} + B e^{λ(L-x)}),    λ = β (-1 + i)

(Hetényi, Beams on Elastic Foundation, 1946, chapter 3). Loads enter at the rims. So four conditions give q: its
resultant F and first moment D about the middle of the wall, and

* for a pin that is loaded from one side, no moment and no shear force at the far rim: q'' = q''' = 0 there;
* for one that is loaded from both sides alike, no moment at either rim: q'' = 0.

For β L → 0 both become the linear pressure q = F/L + D z/I of a stiff pin.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.geometry.bodies.seat import Seat, Side

Real = NDArray[np.float64]

STIFFNESS = 1.5
"""k over the modulus of the link, of a pin that bends.

Measured by ``benchmarks/bore_stiffness.py`` on eyes as solids (D/d of 2 to 4, t/d of 1.2 to 2.4, pins of one material
with them): the pressure away from the rims fits k of 0.7 to 2.5 moduli best. A plane eye as a whole gives way by about
half a modulus; of that, what is alike all along the bore does not bend the pin. At the rims solids have still more
pressure."""
STIFF = 1.5
"""β L below which the linear pressure holds: its peak is at most 1.18 times too low there."""


_NODES, _WEIGHTS = (a / 2.0 for a in np.polynomial.legendre.leggauss(48))


@dataclass(frozen=True, kw_only=True)
class Foundation:
    """A pin that bends in the wall of a hole.

    Attributes
    ----------
    length : float
        L of the wall [mm].
    softness : float
        β L.
    side : {-1, 0, 1}
        Rim at which the pin is loaded: the lower one, both, or the upper one.
    """

    length: float
    softness: float
    side: Side

    @classmethod
    def of(cls, seat: Seat | None) -> "Foundation | None":
        """Return the foundation of a pin in its hole.

        Parameters
        ----------
        seat : Seat or None
            How it sits.

        Returns
        -------
        Foundation or None
            None for a stiff pin, whose pressure is linear, and where nothing tells from where it is loaded.
        """
        if seat is None or seat.side is None:
            return None
        second = math.pi * seat.diameter**4 / 64.0
        softness = (STIFFNESS * seat.young / (4.0 * seat.pin_young * second)) ** 0.25 * seat.length
        return cls(length=seat.length, softness=softness, side=seat.side) if softness >= STIFF else None

    @cached_property
    def _coefficients(self) -> Real:
        """Coefficients (4, 2) of the terms for F = 1 and for D = L, in z/L."""
        rim = 0.5 * (self.side or 1)
        (_, _, far, further), (_, _, near, _) = self._terms(-rim), self._terms(rim)
        free = (far, further / self.softness) if self.side else (far, near)
        terms = self._terms(_NODES)[0]
        conditions = np.vstack(
            [*(row / self.softness**2 for row in free), _WEIGHTS @ terms, (_WEIGHTS * _NODES) @ terms]
        )
        return np.asarray(np.linalg.solve(conditions, np.eye(4)[:, 2:]), dtype=np.float64)

    def _terms(self, z: ArrayLike) -> list[Real]:
        """The four terms (..., 4) and their first three derivatives at z/L."""
        rate, place = self.softness * complex(-1.0, 1.0), np.asarray(z, dtype=np.float64)
        up, down = np.exp(rate * (0.5 + place)), np.exp(rate * (0.5 - place))
        pairs = ((rate**order * up, (-rate) ** order * down) for order in range(4))
        return [np.stack([a.real, a.imag, b.real, b.imag], axis=-1) for a, b in pairs]

    def shapes(self, z: ArrayLike) -> tuple[Real, Real]:
        """Return the pressure's resultant per length of a unit force, and of a unit first moment.

        Parameters
        ----------
        z : array_like
            Above the middle of the wall [mm].

        Returns
        -------
        tuple of ndarray
            [1/mm] and [1/mm²]; of a stiff pin 1/L and 12 z/L³.
        """
        height = np.asarray(z, dtype=np.float64)
        found = self._terms(height / self.length)[0] @ self._coefficients
        return found[..., 0] / self.length, found[..., 1] / self.length**2
