"""The table ``[cycle]`` of a case file: angles and loads of many instants, from a CSV file."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PlainValidator, Strict, WithJsonSchema

from alula.geometry.base.model import CaseModel, Text, refusal
from alula.geometry.base.units import POSITIVE, Time

Real = NDArray[np.float64]


def _share(stated: object) -> float:
    number = stated.removesuffix("%").strip() if isinstance(stated, str) and stated.strip().endswith("%") else ""
    try:
        found = float(number)
    except ValueError:
        found = np.nan
    if not 0.0 <= found <= 100.0:
        raise refusal('it is a share of the cycle from "0 %" to "100 %"; write for example "45 %"')
    return found


Percent = Annotated[
    float,
    PlainValidator(_share),
    WithJsonSchema({"type": "string", "format": "percentage", "examples": ["45 %"]}),
]


class CycleSpec(CaseModel):
    """A table of instants, one a row: of a stride, a grip, a test."""

    file: Annotated[Text, Field(max_length=1000)]
    """Name of the CSV file, relative to the folder of the case file. Its head names every column with its unit, such as
    ``cycle [%],knee flexion [deg],Fy [N]``; one is ``cycle [%]`` or ``time [s]`` and grows from row to row. In load
    cases "column Fy" or "-column Fy" stands for a value of that column, as force, moment, pressure, total, from or
    to."""
    angle: Text | None = None
    """The column of the direction, or of the travel, of the coordinate that fixes the pose; with a minus before its
    name it counts the other way. Left out, the linkage stays in its pose while the loads change."""
    zero: Text | None = None
    """Direction or travel of the coordinate where that column is 0, such as "82 deg" or "5 mm"."""
    instant: Percent = 0.0
    """The instant at which the case is checked, in per cent of the cycle; between two rows linear."""
    period: Annotated[Time, POSITIVE] | None = None
    """How long a cycle takes; with it, or with a column of time, links have speed and inertia."""
    periodic: Annotated[bool, Strict()] = True
    """Whether the cycle goes on into itself: its last row is its first, or 100 % is left out. One that does not is
    repeated all the same, with a jump from its last row to its first."""
    instants: Annotated[int, Strict(), Field(ge=3, le=10_000)] | None = None
    """Number of evenly spaced instants at which the table is read, between its rows: loads linear, the angle as a cubic
    spline. The rows as they stand where it is left out."""

    @property
    def signed_angle(self) -> tuple[float, str]:
        """The column of the angle behind its sign: 1 where the coordinate grows with it, -1 where it falls."""
        plain = (self.angle or "").strip()
        return (-1.0, plain[1:].strip()) if plain[:1] in ("-", "−") else (1.0, plain)


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleMotion:
    """The motion of a cycle, instant by instant; the last of a periodic one is the first again.

    Attributes
    ----------
    percent : array (n,)
        Of the cycle.
    times : array (n,) or None
        Since the first instant [s]; None where the cycle states no period.
    values : array (n,)
        Of the coordinate [rad, mm].
    speed, acceleration : array (n,)
        Of the coordinate [rad/s, rad/s²], or [mm/s, mm/s²]; zero without a period.
    sense : array (n,)
        1 where the coordinate grows, -1 where it falls. Where it stands still, as it moved before; at the beginning of
        a cycle that is not periodic, as it moves then.
    """

    percent: Real
    times: Real | None
    values: Real
    speed: Real
    acceleration: Real
    sense: Real


def states(percent: Real, values: Real, period: float | None, *, periodic: bool) -> CycleMotion:
    """Return the motion of a coordinate by differences between rows.

    Speed and acceleration are those of the parabola through three neighbouring rows, with steps a before and b after:

        v = (a² f₊ + (b² - a²) f - b² f₋) / (a b (a + b)),    w = 2 (a f₊ - (a + b) f + b f₋) / (a b (a + b))

    Both are of second order where rows are even; where they are not, the speed still is, and the acceleration is of
    first order. At the ends of a cycle that is not periodic the parabola is that of the neighbouring row.

    Parameters
    ----------
    percent : array (n,)
        Of the cycle, rising.
    values : array (n,)
        Of the coordinate [rad, mm]; of a periodic cycle the last is the first again, but for full turns.
    period : float or None
        [s]
    periodic : bool

    Returns
    -------
    CycleMotion
    """
    f, t = values, percent
    if periodic:
        f = np.concatenate([[f[-2] - (f[-1] - f[0])], f, [f[1] + (f[-1] - f[0])]])
        t = np.concatenate([[t[-2] - 100.0], t, [t[1] + 100.0]])
    a, b = np.diff(t)[:-1], np.diff(t)[1:]
    down, up = np.diff(f)[:-1] / a, np.diff(f)[1:] / b
    speed, acceleration = (b * down + a * up) / (a + b), 2.0 * (up - down) / (a + b)
    if not periodic:
        before, after = speed[0] - a[0] * acceleration[0], speed[-1] + b[-1] * acceleration[-1]
        speed = np.concatenate([[before], speed, [after]])
        acceleration = acceleration[[0, *range(len(acceleration)), -1]]
    moves = np.flatnonzero(speed)
    last = np.searchsorted(moves, np.arange(len(speed)), side="right") - 1  # -1: as it moved at the end of the cycle
    last = last if periodic else np.maximum(last, 0)
    sense = np.sign(speed[moves[last]]) if len(moves) else np.ones(len(speed))
    rate = 0.0 if period is None else 100.0 / period
    return CycleMotion(
        percent=percent,
        times=None if period is None else (percent - percent[0]) / rate,
        values=values,
        speed=rate * speed,
        acceleration=rate**2 * acceleration,
        sense=sense,
    )
