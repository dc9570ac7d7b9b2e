"""The flapping wing with one crank and two rockers, in closed form, and its design metrics.

Two mirrored four-bars hang on one crank at the origin. The right one has crank a, coupler b, rocker c and
rocker pivot O4 at (x, y); the left one the same with (-x, y). Source: Freitas (2022), position analysis
and design criteria; the published form divides by Ax - x and by (Ay - y)/(Ax - x), this one by nothing.

Angles of the left side are measured in the mirror, so that equal angles of both sides are symmetric poses.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.dyad import FloatArray, close_dyad, triangle_angle, wrap
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.grashof import Grashof
from alula.geometry.mechanisms.periodic import periodic_maximum, periodic_minimum

Side = Literal["right", "left"]

SAMPLES = 361
"""Crank positions from 0 to 360° over which the source takes its extremes."""
OUTER_WING_OFFSET = math.radians(100)
"""The source's program sets φ = ψ - 100°, which holds the outer wing at a fixed angle to the coupler."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FlappingPose:
    """One side over the crank angles: angles in rad (left side in the mirror), points in mm, shape (..., 2).

    Attributes
    ----------
    theta2 : ndarray
        Crank angle, the same for both sides.
    theta3 : ndarray
        Coupler angle.
    beta : ndarray
        Rocker (oscillation) angle, of the direction from B to O4, in which the inner wing goes on.
    psi : ndarray
        Angle between coupler and rocker (transmission angle), in [0, π].
    phi : ndarray
        Angle from the outer to the inner wing, ψ - 100°.
    lambda_ : ndarray
        Angle of the outer wing to the horizontal, β - φ.
    crank_pin : ndarray
        Place of the crank pin A, in the frame of the whole mechanism.
    coupler_pin : ndarray
        B, in the frame of the whole mechanism.
    """

    theta2: FloatArray
    theta3: FloatArray
    beta: FloatArray
    psi: FloatArray
    phi: FloatArray
    lambda_: FloatArray
    crank_pin: FloatArray
    coupler_pin: FloatArray


@dataclass(frozen=True, kw_only=True)
class PublishedMetrics:
    """The metrics as the source's program defines them (rad), over 361 crank positions.

    Attributes
    ----------
    phase_lag : float
        |Σβ_left - Σβ_right|; the sums over a turn cancel but for the crank angle 0, which is counted twice.
    oscillation : float
        max β + |min β|.
    asymmetry : float
        ((max ψ - 90°) + (90° - min ψ)) / 2.
    """

    phase_lag: float
    oscillation: float
    asymmetry: float


@dataclass(frozen=True, kw_only=True)
class FlappingMetrics:
    """The metrics as their names say (rad).

    Attributes
    ----------
    phase_lag : float
        Largest crank angle between the reversals of the two sides: the time by which one wing lags.
    side_difference : float
        Largest difference between the rocker angles of the two sides over the turn.
    mean_side_difference : float
        Mean size of that difference over the turn.
    side_difference_at_zero : float
        The same at crank angle 0, which is the published phase lag.
    oscillation : float
        max β - min β, from the poses in which crank and coupler are collinear.
    beta_min : float
        Least rocker angle.
    beta_max : float
        Greatest rocker angle.
    asymmetry : float
        Largest deviation of the transmission angle from 90°.
    transmission_min : float
        Least transmission angle.
    transmission_max : float
        Greatest transmission angle.
    lambda_min : float
        Least angle of the outer wing.
    lambda_max : float
        Greatest angle of the outer wing.
    """

    phase_lag: float
    side_difference: float
    mean_side_difference: float
    side_difference_at_zero: float
    oscillation: float
    beta_min: float
    beta_max: float
    asymmetry: float
    transmission_min: float
    transmission_max: float
    lambda_min: float
    lambda_max: float


@dataclass(frozen=True, kw_only=True)
class Criterion:
    """One design criterion of the source and whether the design meets it.

    Attributes
    ----------
    name : str
        Name of the criterion.
    fulfilled : bool
        Whether the design meets it.
    sentence : str
        Value and limit in words.
    """

    name: str
    fulfilled: bool
    sentence: str


@dataclass(frozen=True, kw_only=True)
class FlappingWing:
    """A flapping wing; lengths in mm. Raises CaseError for lengths that are not positive or never close.

    Attributes
    ----------
    crank : float
        Length of the crank.
    coupler : float
        Length of the coupler.
    rocker : float
        Length of the rocker.
    width : float
        x of the right rocker's pivot.
    height : float
        y of both rockers' pivots.
    """

    crank: float
    coupler: float
    rocker: float
    width: float
    height: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.width) and self.width > 0):
            raise CaseError(f"flapping wing width = {self.width:g} mm must be positive; give x of the right pivot.")
        if not math.isfinite(self.height):
            raise CaseError(f"flapping wing height = {self.height:g} mm must be finite; give y of the pivots.")
        _ = self.four_bar

    @property
    def ground(self) -> float:
        """Distance of the rocker's pivot from the crank's: d = sqrt(x² + y²), in mm."""
        return math.hypot(self.width, self.height)

    @property
    def four_bar(self) -> FourBar:
        """The right side's four-bar, its ground turned into +x."""
        return FourBar(a=self.crank, b=self.coupler, c=self.rocker, d=self.ground)

    @property
    def grashof(self) -> Grashof:
        """Grashof's sums and class of each side."""
        return self.four_bar.grashof

    @property
    def turns_fully(self) -> bool:
        """Whether the crank can turn fully on both sides."""
        return self.four_bar.input_range().full_turn

    def scaled(self, factor: float) -> "FlappingWing":
        """Return the same design at another size.

        Parameters
        ----------
        factor : float
            By which all lengths are multiplied.

        Returns
        -------
        FlappingWing
            The scaled wing.
        """
        return FlappingWing(
            crank=self.crank * factor,
            coupler=self.coupler * factor,
            rocker=self.rocker * factor,
            width=self.width * factor,
            height=self.height * factor,
        )

    def pose(self, theta2: ArrayLike, side: Side = "right") -> FlappingPose:
        """Return one side's angles and pins.

        B lies to the left of the line from the crank pin to the right pivot, and mirrored on the left side: that is
        the root with the larger y wherever the crank pin stays inside of the pivots, and it does not jump where
        the crank is longer than x.

        Parameters
        ----------
        theta2 : array_like
            Crank angles of any shape, from +x [rad].
        side : {"right", "left"}
            Side of the wing.

        Returns
        -------
        FlappingPose
            The poses.

        Raises
        ------
        CaseError
            Where the side cannot be assembled at some of the angles.
        """
        theta2 = np.asarray(theta2, dtype=float)
        mirror = 1.0 if side == "right" else -1.0
        pin = np.stack([self.crank * np.cos(theta2), self.crank * np.sin(theta2)], axis=-1)
        dx, dy = self.width - mirror * pin[..., 0], self.height - pin[..., 1]
        dyad = close_dyad(dx, dy, self.coupler, self.rocker, 1)
        if not dyad.closes.all():
            worst = int(np.argmax(dyad.gap))
            angle, gap = math.degrees(theta2.reshape(-1)[worst]), float(dyad.gap.reshape(-1)[worst])
            raise CaseError(
                f"the {side} side of the flapping wing cannot be assembled at crank angle {angle:.4g}°: its loop stays "
                f"open by {gap:.4g} mm; {self.grashof.sentence} Change a length so that the crank turns fully."
            )
        beta = wrap(dyad.second + np.pi)
        phi = dyad.between - OUTER_WING_OFFSET
        coupler_pin = np.stack(
            [mirror * (self.width - self.rocker * np.cos(beta)), self.height - self.rocker * np.sin(beta)], axis=-1
        )
        return FlappingPose(
            theta2=theta2,
            theta3=dyad.first,
            beta=beta,
            psi=dyad.between,
            phi=phi,
            lambda_=wrap(beta - phi),
            crank_pin=pin,
            coupler_pin=coupler_pin,
        )

    @cached_property
    def _turn(self) -> tuple[FlappingPose, FlappingPose]:
        theta2 = np.linspace(0.0, 2 * np.pi, SAMPLES)
        return self.pose(theta2, "right"), self.pose(theta2, "left")

    def published_metrics(self) -> PublishedMetrics:
        """Return the metrics by the source's definitions; CaseError where the crank does not turn fully."""
        right, left = self._turn
        return PublishedMetrics(
            phase_lag=abs(float(left.beta.sum() - right.beta.sum())),
            oscillation=float(right.beta.max() + abs(right.beta.min())),
            asymmetry=float((right.psi.max() - np.pi / 2) + (np.pi / 2 - right.psi.min())) / 2,
        )

    def reversals(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return (crank angle, β) in rad of the right side's lower and upper reversal, in closed form.

        There crank and coupler are collinear, so B lies at the distance b + a or |b - a| from the crank's pivot.
        Raises CaseError where the crank does not turn fully.
        """
        self._require_full_turn()
        ground = math.atan2(self.height, self.width)
        found = []
        for reach, folded in ((self.coupler + self.crank, False), (abs(self.coupler - self.crank), True)):
            line = ground + float(triangle_angle(self.ground, reach, self.rocker))
            # Folded with the longer coupler, the crank points away from B.
            theta2 = line + math.pi if folded and self.coupler > self.crank else line
            found.append((float(wrap(theta2)), float(self.pose(theta2).beta)))
        lower, upper = sorted(found, key=lambda reversal: reversal[1])
        return lower, upper

    def metrics(self) -> FlappingMetrics:
        """Return the metrics as their names say; CaseError where the crank does not turn fully."""
        (low_at, low), (high_at, high) = self.reversals()
        right, left = self._turn
        difference = wrap(left.beta - right.beta)
        transmission = self.four_bar.transmission_range()
        # The left side stands at crank angle θ as the right one at π - θ.
        lags = [abs(float(wrap(math.pi - 2 * at))) for at in (low_at, high_at)]
        return FlappingMetrics(
            phase_lag=max(lags),
            side_difference=periodic_maximum(np.abs(difference[:-1])),
            mean_side_difference=float(np.abs(difference[:-1]).mean()),
            side_difference_at_zero=abs(float(difference[0])),
            oscillation=high - low,
            beta_min=low,
            beta_max=high,
            asymmetry=transmission.worst_deviation,
            transmission_min=transmission.minimum,
            transmission_max=transmission.maximum,
            lambda_min=periodic_minimum(right.lambda_[:-1]),
            lambda_max=periodic_maximum(right.lambda_[:-1]),
        )

    def _require_full_turn(self) -> None:
        if not self.turns_fully:
            raise CaseError(
                f"the crank of the flapping wing cannot turn fully: {self.grashof.sentence} "
                "Shorten the crank or change the pivots."
            )

    def criteria(self) -> tuple[Criterion, ...]:
        """Judge the design by the source's criteria, each by the metric that its name says.

        Grashof; phase lag ≤ 3°; oscillation ≤ 40°, and 70.6° from where flight is said to tremble;
        60° ≤ ψ ≤ 120°; |λ| ≤ 40°; rocker not longer than x. The limit of the phase lag is applied
        to the difference between the sides, which is what the source computed.
        """
        grashof = Criterion(name="grashof", fulfilled=self.grashof.satisfied, sentence=self.grashof.sentence)
        collision = Criterion(
            name="collision",
            fulfilled=self.rocker <= self.width,
            sentence=f"The rocker is {self.rocker:g} mm long and the pivots lie {self.width:g} mm off the middle: the "
            + ("sides stay clear." if self.rocker <= self.width else "sides can collide."),
        )
        if not self.turns_fully:
            return grashof, collision
        metrics = self.metrics()
        steepest = max(abs(metrics.lambda_min), abs(metrics.lambda_max))
        return (
            grashof,
            collision,
            _limit("side difference", metrics.side_difference, 3.0, "The sides differ by at most"),
            _limit("oscillation", metrics.oscillation, 40.0, "The inner wing swings over"),
            _limit("tremor", metrics.oscillation, 70.6, "Flight is said to tremble from 70.6° on; the swing is"),
            _limit("transmission", metrics.asymmetry, 30.0, "The transmission angle leaves 90° by at most"),
            _limit("outer wing", steepest, 40.0, "The outer wing stands to the horizontal at up to"),
        )


def _limit(name: str, value: float, limit: float, text: str) -> Criterion:
    """Judge an angle in rad against a limit in degrees."""
    degrees = math.degrees(value)
    fulfilled = degrees <= limit
    verdict = "within" if fulfilled else "beyond"
    return Criterion(
        name=name, fulfilled=fulfilled, sentence=f"{text} {degrees:.4g}°, {verdict} the limit of {limit:g}°."
    )
