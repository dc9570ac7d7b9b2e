"""What a series of ever finer meshes says about a number: its error band, its order, or that it has no limit.

Two things tell of the error, and the larger one is the band. The recovery-based estimate at the place of the number
(``alula.fea.refine.error_estimate``) sees a field that the finest mesh does not resolve. The grid convergence index (P.
J. Roache, Verification and Validation in Computational Science and Engineering, 1998, sec. 5.6 to 5.9) sees a number
that moves from mesh to mesh, 1.25 times its extrapolated error

    δ = |f2 − f1|/((h2/h1)^p − 1)

for mesh sizes h1 < h2 and the elements' own order p. Two values may agree by accident, so δ is taken for the two
finest of three meshes and for the pair before, carried on to the finest, and the larger counts. The observed order
has no part in it: on local meshes without structure it scatters, and bands with it were wider for the same coverage.
The multiples of the estimate were fixed on training links and tried on others (``make coverage``,
docs/verification.md).
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from alula.fea.common.reason import Reason, reason
from alula.geometry.base.errors import CannotRunError

FORMAL_ORDER = 2.0
"""Of the stress of quadratic elements. Displacements have up to 3, but 2.1 was observed in Lamé's cylinder."""
SAFETY = 1.25
"""Factor on the extrapolated error of three meshes (Roache)."""
ALONE, SEVERAL = 4.0, 2.25
"""Least band over the estimate, of one or two meshes and of more: training links needed 3.65 and 2.04, one apart."""
LEAST_RATIO = 1.15
"""Of the sizes of successive meshes: what meshes that are closer than this differ by is scatter."""
SERIES = 3
"""Meshes in the least series with an observed order."""
NO_LIMIT = 0.2
"""Observed order below which a rising peak may have no limit; a crack's peak has −0.5."""
SIGNIFICANT = 0.02
"""Step over the value, above the estimate as well, that must be exceeded for a rise to count: what a peak gains at a
right-angled notch with size ratio 1.15 is 6 %, while a converged one moves by less from mesh to mesh."""

SeriesKind = Literal["one mesh", "two meshes", "monotone", "irregular", "growing"]


@dataclass(frozen=True, kw_only=True)
class GridConvergence:
    """A number on successive meshes, coarse to fine, and what follows for its limit.

    Attributes
    ----------
    sizes : tuple of float
        Representative element sizes where the number is taken [mm].
    values : tuple of float
        The number on these meshes.
    order : float or None
        Observed order of the three finest; None where too few meshes or an oscillation give none.
    kind : Kind
        "monotone": the three finest rise or fall throughout; "irregular": they do not; "growing": no limit is in sight;
        "one mesh", "two meshes".
    factor : float
        On the estimate.
    estimate : float
        Of the error on the finest mesh, from the recovered stress at the place.
    low : float
        Lower end of the interval that holds the limit; infinite where ``kind`` is "growing".
    high : float
        Its upper end.
    """

    sizes: tuple[float, ...]
    values: tuple[float, ...]
    order: float | None
    kind: SeriesKind
    factor: float
    estimate: float
    low: float
    high: float

    @property
    def rule(self) -> Reason:
        """What the width of the interval follows from."""
        if self.high - self.value > (1.0 + 1e-9) * self.factor * self.estimate:
            return reason("by_index", factor=SAFETY)
        return reason("by_estimate", factor=self.factor)

    @property
    def step(self) -> float:
        """Size of the last step over the value; 0 for one mesh."""
        return abs(self.values[-1] - self.values[-2]) / abs(self.value) if len(self.values) > 1 and self.value else 0.0

    @property
    def suspect(self) -> bool:
        """Whether a further mesh must tell if the number has a limit: it rises as fast as before over three meshes."""
        return (
            self.kind != "growing"
            and len(self.values) == SERIES
            and self.order is not None
            and self.order < NO_LIMIT
            and abs(self.values[-1]) > abs(self.values[-2])
            and self.step > SIGNIFICANT
        )

    @property
    def value(self) -> float:
        """The number on the finest mesh."""
        return self.values[-1]

    @property
    def index(self) -> float:
        """Largest distance of an end of the interval from the value, relative to the value."""
        reach = max(self.high - self.value, self.value - self.low)
        return 0.0 if reach == 0.0 else reach / abs(self.value) if self.value != 0.0 else math.inf


def grid_convergence(
    sizes: Sequence[float],
    values: Sequence[float],
    *,
    estimate: float,
    sharp: bool = False,
) -> GridConvergence:
    """Judge a series of meshes, coarse to fine, by its three finest.

    A number grows where its last step is significant (``SIGNIFICANT``, and above the estimate) and the order below
    ``NO_LIMIT``.

    Parameters
    ----------
    sizes : sequence of float
        Element sizes where the number is taken, coarse to fine [mm].
    values : sequence of float
        The number on these meshes.
    estimate : float
        Of the error on the finest mesh, from the recovered stress where the number is taken.
    sharp : bool, optional
        True at a re-entrant edge, where three meshes tell that a number grows without limit. Elsewhere four must: the
        three before the finest have to rise like that as well.

    Returns
    -------
    GridConvergence
        The series with its order and band.

    Raises
    ------
    CannotRunError
        For sizes that do not fall by ``LEAST_RATIO`` each.
    """
    if len(sizes) != len(values) or not sizes:
        raise CannotRunError(f"a series of {len(sizes)} sizes and {len(values)} values shows no convergence")
    h, f = tuple(map(float, sizes)), tuple(map(float, values))
    if any(coarse < LEAST_RATIO * fine for coarse, fine in itertools.pairwise(h)):
        listed = ", ".join(f"{size:.3g}" for size in h)
        raise CannotRunError(f"element sizes of {listed} mm do not fall by {LEAST_RATIO:g} from mesh to mesh")

    few = len(f) < SERIES
    factor, order = (ALONE, None) if few else (SEVERAL, observed_order(h[-3:], f[-3:]))
    reach = max(factor * estimate, SAFETY * _extrapolated(h[-SERIES:], f[-SERIES:]))
    kind: SeriesKind = "irregular" if order is None else "monotone"
    if few:
        kind = "one mesh" if len(f) == 1 else "two meshes"
    elif _rises(h, f, estimate) and (sharp or _rises(h[:-1], f[:-1])):
        reach, kind = math.inf, "growing"
    return GridConvergence(
        sizes=h,
        values=f,
        order=order,
        kind=kind,
        factor=factor,
        estimate=estimate,
        low=f[-1] - reach,
        high=f[-1] + reach,
    )


def _extrapolated(h: Sequence[float], f: Sequence[float]) -> float:
    """Return the largest error on the finest mesh that two successive meshes tell; 0 for a single mesh."""
    powers = [math.pow(size / h[-1], FORMAL_ORDER) for size in h]
    pairs = zip(itertools.pairwise(f), itertools.pairwise(powers), strict=True)
    return max((abs(b - a) / (coarse - fine) for (a, b), (coarse, fine) in pairs), default=0.0)


def _rises(sizes: Sequence[float], values: Sequence[float], estimate: float | None = None) -> bool:
    """Whether the last three meshes, if there are so many, rise with an order below ``NO_LIMIT``.

    With an estimate the last step must be above it, and significant.
    """
    if len(values) < SERIES or abs(values[-1]) <= abs(values[-2]):
        return False
    if estimate is not None and abs(values[-1] - values[-2]) <= max(estimate, SIGNIFICANT * abs(values[-1])):
        return False
    order = observed_order(sizes[-3:], values[-3:])
    return order is not None and order < NO_LIMIT


def observed_order(sizes: Sequence[float], values: Sequence[float]) -> float | None:
    """Return the order p of three meshes, negative for a number that diverges; None where they oscillate.

    Parameters
    ----------
    sizes : sequence of float
        Element sizes of three meshes, coarse to fine [mm].
    values : sequence of float
        The number on them.

    Returns
    -------
    float or None
        The order, from -4 to 12.
    """
    h3, h2, h1 = sizes
    first, second = values[1] - values[0], values[2] - values[1]
    if first * second <= 0.0:
        return 12.0 if second == 0.0 and first != 0.0 else None
    wanted = first / second

    def excess(p: float) -> float:
        if abs(p) < 1e-9:
            return math.log(h3 / h2) / math.log(h2 / h1) - wanted
        a3, a2, a1 = (math.pow(size, p) for size in (h3, h2, h1))
        return (a3 - a2) / (a2 - a1) - wanted

    return _root(excess, -4.0, 12.0)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a rising function; the nearer end where there is none."""
    from scipy.optimize import brentq

    if function(low) >= 0.0:
        return low
    return high if function(high) <= 0.0 else float(brentq(function, low, high, xtol=1e-15))


def williams_exponent(angle: float) -> float:
    """Return the exponent λ of the displacements r^λ at a re-entrant edge with free faces.

    Stress grows as r^(λ−1). λ is the smallest root in (0.5, 1) of sin λβ = −λ sin β, the symmetric field (M. L.
    Williams, J. Appl. Mech. 19 (1952) 526-528; J. R. Barber, Elasticity, 3rd ed., eq. 11.39).

    Parameters
    ----------
    angle : float
        Of the material at the edge, π < angle ≤ 2π [rad].

    Returns
    -------
    float
        The exponent λ, from 0.5 to 1.

    Raises
    ------
    ValueError
        For an angle that is not re-entrant.
    """
    if not math.pi < angle <= 2.0 * math.pi + 1e-12:
        raise ValueError(f"an angle of {math.degrees(angle):g}° is not re-entrant")
    return _root(lambda x: -(math.sin(x * angle) + x * math.sin(angle)), 0.5, 1.0 - 1e-9)
