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

from geometry.errors import CannotRunError

FORMAL_ORDER = 2.0
"""Of the stress of quadratic elements."""
SENSIBLE_ORDERS = (0.5, 4.0)
SAFETY, DOUBT = 1.25, 3.0
"""Factors on the extrapolated error where the observed order makes sense, and where it does not."""
LEAST_RATIO = 1.15
"""Of the sizes of successive meshes: the order of meshes that are closer than this means nothing."""
BACKWARD = 0.2
"""Share of the index by which the band of a monotone series reaches back from its last value."""
NO_LIMIT = 0.2
"""Observed order below which a rising peak is taken to have no limit; a crack's peak has −0.5."""

FLOOR, CEILING, ALONE = 1.5, 3.0, 4.0
"""Bounds of a series' band in multiples of the recovery-based estimate at the peak, and the band of one mesh alone.
Measured as the true error of the peak over that estimate, in cylinders under pressure and at holes in tension: 0 to
1.8 where that error is below 15 %, up to 2.4 on meshes of 12 and 3.1 on one of 8 elements round a hole."""

Kind = Literal["one mesh", "two meshes", "monotone", "irregular", "growing"]


@dataclass(frozen=True, kw_only=True)
class GridConvergence:
    """A number on successive meshes, coarse to fine, and what follows for its limit.

    sizes     representative element sizes where the number is taken [mm]
    values    the number on these meshes
    order     observed order p; None where too few meshes or an oscillation give none
    kind      "monotone": p makes sense; "irregular": it does not; "growing": no limit is in sight;
              "one mesh", "two meshes": there is no order yet
    factor    safety factor F in the index
    low, high interval that holds the limit; infinite where ``kind`` is "growing"
    """

    sizes: tuple[float, ...]
    values: tuple[float, ...]
    order: float | None
    kind: Kind
    factor: float
    low: float
    high: float

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
    sizes: Sequence[float], values: Sequence[float], *, estimate: float, formal_order: float = FORMAL_ORDER
) -> GridConvergence:
    """Judge a series of meshes, coarse to fine, by its three finest.

    estimate   of the error on the finest mesh, from the recovered stress where the number is taken. One mesh
               alone is given ``ALONE`` times that. The index of several is not taken for less than ``FLOOR`` times
               that, nor, while the number moves by less, for more than ``CEILING`` times.

    A monotone series of an order up to the elements' own has its limit beyond its last value, so the interval
    reaches ``BACKWARD`` of the index the other way. A higher order is that of an error about to change its
    sign: such an interval is symmetric, as is that of a series that oscillates.

    Raises ``CannotRunError`` for sizes that do not fall by ``LEAST_RATIO`` each.
    """
    if len(sizes) != len(values) or not sizes:
        raise CannotRunError(f"a series of {len(sizes)} sizes and {len(values)} values shows no convergence")
    h, f = tuple(map(float, sizes)), tuple(map(float, values))
    if any(coarse < LEAST_RATIO * fine for coarse, fine in itertools.pairwise(h)):
        listed = ", ".join(f"{size:.3g}" for size in h)
        raise CannotRunError(f"element sizes of {listed} mm do not fall by {LEAST_RATIO:g} from mesh to mesh")

    def result(order: float | None, kind: Kind, factor: float, below: float, above: float) -> GridConvergence:
        return GridConvergence(
            sizes=h, values=f, order=order, kind=kind, factor=factor, low=f[-1] - below, high=f[-1] + above
        )

    if len(f) == 1:
        return result(None, "one mesh", ALONE, ALONE * estimate, ALONE * estimate)
    step, ratio = f[-1] - f[-2], h[-2] / h[-1]
    least, most = FLOOR * estimate, max(CEILING * estimate, abs(step))

    def index(factor: float, left: float, order: float) -> float:
        return min(max(factor * left / (math.pow(ratio, order) - 1.0), least), most)

    if len(f) == 2:
        reach = index(DOUBT, abs(step), formal_order)
        return result(None, "two meshes", DOUBT, reach, reach)
    order = observed_order(h[-3:], f[-3:])
    lowest, highest = SENSIBLE_ORDERS
    if order is not None and order < NO_LIMIT and abs(f[-1]) > abs(f[-2]):
        return result(order, "growing", DOUBT, math.inf, math.inf)
    if order is None or order > highest:
        # What the step before would leave at the elements' own order: two values may agree by accident.
        left = max(abs(step), abs(f[-2] - f[-3]) * _share(h, formal_order))
        reach = index(DOUBT, left, formal_order)
        return result(order, "irregular", DOUBT, reach, reach)
    if order > formal_order:
        reach = index(SAFETY, abs(step), formal_order)
        return result(order, "monotone", SAFETY, reach, reach)
    sensible = order >= lowest
    factor = SAFETY if sensible else DOUBT
    reach = index(factor, abs(step), order if sensible else formal_order)
    below, above = (reach, BACKWARD * reach) if step < 0.0 else (BACKWARD * reach, reach)
    return result(order, "monotone" if sensible else "irregular", factor, below, above)


def _share(h: Sequence[float], order: float) -> float:
    """Step between the two finest sizes over the step before, for errors that fall with that order."""
    h3, h2, h1 = (math.pow(size, order) for size in h[-3:])
    return (h2 - h1) / (h3 - h2)


def observed_order(sizes: Sequence[float], values: Sequence[float]) -> float | None:
    """Order p, negative for a number that diverges, of three meshes, coarse to fine; None where they oscillate.

    Limited to −4 to 12.
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
    """Zero of a rising function by bisection; the nearer end where there is none."""
    if function(low) >= 0.0:
        return low
    if function(high) <= 0.0:
        return high
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return (low + high) / 2.0


def williams_exponent(angle: float) -> float:
    """Exponent λ of the displacements r^λ at a re-entrant edge of that material angle [rad], π < angle ≤ 2π.

    Stress grows as r^(λ−1). The smallest root in (0.5, 1) of sin λβ = −λ sin β, the symmetric field with free
    faces (M. L. Williams, J. Appl. Mech. 19 (1952) 526-528; J. R. Barber, Elasticity, 3rd ed., eq. 11.39).
    """
    if not math.pi < angle <= 2.0 * math.pi + 1e-12:
        raise ValueError(f"an angle of {math.degrees(angle):g}° is not re-entrant")
    return _root(lambda x: -(math.sin(x * angle) + x * math.sin(angle)), 0.5, 1.0 - 1e-9)
