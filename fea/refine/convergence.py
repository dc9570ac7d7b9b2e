"""What a series of ever finer meshes says about a number: its order, its error band, or that it has no limit.

Observed order and grid convergence index after I. B. Celik et al., Procedure for estimation and reporting
of uncertainty due to discretization in CFD applications, J. Fluids Eng. 130 (2008) 078001, in the form that
keeps the sign of the order: with f(h) = f* + C h^p through the three finest meshes, h1 < h2 < h3,

    (f3 − f2)/(f2 − f1) = (h3^p − h2^p)/(h2^p − h1^p)

whose right-hand side rises with p. The index is F |f2 − f1|/((h2/h1)^p − 1) with F = 1.25 where the order
makes sense, else F = 3 with the elements' own order in place of p (P. J. Roache, Verification and Validation
in Computational Science and Engineering, 1998, sec. 5.6 to 5.9).
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from geometry.base.errors import CannotRunError

FORMAL_ORDER = 2.0
"""Of the stress of quadratic elements."""
LEAST_ORDER, ABOVE_FORMAL = 0.5, 1.0
"""Least sensible order, and how far above the elements' own one may be: a higher one is an accidental agreement of the
last two meshes. In a thin ring 16.98, 19.94, 20.15 MPa (order 5.5) went on to 21.72 and, on 123,000 elements, 21.82."""
SAFETY, WIDE_SAFETY = 1.25, 3.0
"""Factors on the extrapolated error where the observed order makes sense, and where it does not."""
LEAST_RATIO = 1.15
"""Of the sizes of successive meshes: the order of meshes that are closer than this means nothing."""
BACKWARD = 0.2
"""Share of the index by which the band of a monotone series reaches back from its last value."""
SERIES = 3
"""Meshes in the least series with an observed order."""
NO_LIMIT = 0.2
"""Observed order below which a rising peak may have no limit; a crack's peak has −0.5."""
SIGNIFICANT = 0.02
"""Step over the value, above the estimate as well, that must be exceeded for a rise to count: what a peak gains at a
right-angled notch with size ratio 1.15 is 6 %, while a converged one moves by less from mesh to mesh."""
NOISE_RATIO = 1.3
"""Least size ratio (Celik et al.) in the index of an irregular series: scatter of a peak is no error that a
small ratio hides."""

FLOOR, CEILING, TOO_HIGH, ALONE = 1.5, 3.0, 2.4, 4.0
"""Bounds of a series' band in multiples of the recovery-based estimate at the peak (the upper one of monotone series;
of those whose order is too high, measured 1.0 at a hole and 2.2 in a thin ring; none for other irregular series), and
the least band of one or two meshes, which have no order.
Measured as the true error of the peak over that estimate, in cylinders under pressure and at holes in tension: 0 to
1.8 where that error is below 15 %, up to 2.4 on meshes of 12 and 3.1 on one of 8 elements round a hole."""

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
        Observed order p; None where too few meshes or an oscillation give none.
    kind : Kind
        "monotone": p makes sense; "irregular": it does not; "growing": no limit is in sight; "one mesh", "two meshes":
        there is no order yet.
    factor : float
        Safety factor F in the index.
    low : float
        Lower end of the interval that holds the limit; infinite where ``kind`` is "growing".
    high : float
        Its upper end.
    multiple : float or None
        Of the estimate that the band is, where that and not the index set it; else None.
    """

    sizes: tuple[float, ...]
    values: tuple[float, ...]
    order: float | None
    kind: SeriesKind
    factor: float
    low: float
    high: float
    multiple: float | None = None

    @property
    def rule(self) -> str:
        """What the width of the interval follows from."""
        if self.multiple is None:
            return f"factor {self.factor:g}"
        return f"{self.multiple:g} times the estimate at the place"

    @property
    def step(self) -> float:
        """Size of the last step over the value; 0 for one mesh."""
        return abs(self.values[-1] - self.values[-2]) / abs(self.value) if len(self.values) > 1 and self.value else 0.0

    @property
    def suspect(self) -> bool:
        """Whether a further mesh must tell if the number has a limit: it rises as fast as before over three meshes."""
        return (
            self.kind == "irregular"
            and len(self.values) == 3
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
    formal_order: float = FORMAL_ORDER,
    sharp: bool = False,
) -> GridConvergence:
    """Judge a series of meshes, coarse to fine, by its three finest.

    A number grows where its last step is significant (``SIGNIFICANT``, and above the estimate) and the order below
    ``NO_LIMIT``. A monotone series of an order up to the elements' own has its limit beyond its last value, so the
    interval reaches ``BACKWARD`` of the index the other way. A higher order is that of an error about to change its
    sign: such an interval is symmetric, as is that of a series that oscillates; both count what the step before would
    leave at the elements' own order, since two values may agree by accident.

    Parameters
    ----------
    sizes : sequence of float
        Element sizes where the number is taken, coarse to fine [mm].
    values : sequence of float
        The number on these meshes.
    estimate : float
        Of the error on the finest mesh, from the recovered stress where the number is taken. One mesh alone is given
        ``ALONE`` times that, two at least that. The index of more is not taken for less than ``FLOOR`` times that, nor,
        for a monotone series and while the number moves by less, for more than ``CEILING`` times (``TOO_HIGH`` where
        the order is). An irregular one of low order or none has no ceiling.
    formal_order : float, optional
        Order of the elements for this number.
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

    order, kind, factor, reach, back = _reach(h, f, estimate, formal_order, sharp)
    least, most, multiple = ALONE if len(f) < SERIES else FLOOR, math.inf, None
    if order is not None and order >= LEAST_ORDER:
        most = max((TOO_HIGH if kind == "irregular" else CEILING) * estimate, abs(f[-1] - f[-2]))
    if kind == "one mesh" or reach < least * estimate:
        reach, multiple = least * estimate, least
    elif reach > most:
        reach, multiple = most, most / estimate if estimate > 0.0 else None
    rises = len(f) > 1 and f[-1] >= f[-2]
    below, above = (back * reach, reach) if rises else (reach, back * reach)
    low, high = f[-1] - below, f[-1] + above
    return GridConvergence(
        sizes=h, values=f, order=order, kind=kind, factor=factor, low=low, high=high, multiple=multiple
    )


def _reach(
    h: Sequence[float], f: Sequence[float], estimate: float, formal_order: float, sharp: bool
) -> tuple[float | None, SeriesKind, float, float, float]:
    """Return order, kind and factor of a series, its index, and the share of it by which its band reaches back."""
    if len(f) == 1:
        return None, "one mesh", ALONE, 0.0, 1.0
    step, ratio = f[-1] - f[-2], h[-2] / h[-1]
    if len(f) == 2:
        return None, "two meshes", WIDE_SAFETY, WIDE_SAFETY * abs(step) / (math.pow(ratio, formal_order) - 1.0), 1.0
    order = observed_order(h[-3:], f[-3:])
    if abs(step) > max(estimate, SIGNIFICANT * abs(f[-1])) and _rises(h, f) and (sharp or _rises(h[:-1], f[:-1])):
        return order, "growing", WIDE_SAFETY, math.inf, 1.0
    left = max(abs(step), abs(f[-2] - f[-3]) * _share(h, formal_order))
    if order is None or not LEAST_ORDER <= order <= formal_order + ABOVE_FORMAL:
        index = WIDE_SAFETY * left / (math.pow(max(ratio, NOISE_RATIO), formal_order) - 1.0)
        # The limit of a slow series lies beyond its last value; a negative order is scatter, and tells no side.
        slow = order is not None and 0.0 <= order < LEAST_ORDER
        return order, "irregular", WIDE_SAFETY, index, BACKWARD if slow else 1.0
    if order > formal_order:
        return order, "monotone", SAFETY, SAFETY * left / (math.pow(ratio, formal_order) - 1.0), 1.0
    return order, "monotone", SAFETY, SAFETY * abs(step) / (math.pow(ratio, order) - 1.0), BACKWARD


def _rises(sizes: Sequence[float], values: Sequence[float]) -> bool:
    """Whether the last three meshes, if there are so many, rise with an order below ``NO_LIMIT``."""
    if len(values) < 3 or abs(values[-1]) <= abs(values[-2]):
        return False
    order = observed_order(sizes[-3:], values[-3:])
    return order is not None and order < NO_LIMIT


def _share(h: Sequence[float], order: float) -> float:
    """Step between the two finest sizes over the step before, for errors that fall with that order."""
    h3, h2, h1 = (math.pow(size, order) for size in h[-3:])
    return (h2 - h1) / (h3 - h2)


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
