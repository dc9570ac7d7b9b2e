"""Air loads: lift and drag from dynamic pressure and coefficients, or as given, spread over the links.

    q = rho V^2 / 2,    L = q S C_L,    D = q S C_D

(Anderson, Fundamentals of Aerodynamics, 5th ed., chapter 1). Drag acts along the stream, lift normal to it. Spread
loads keep the resultant force and its first moment along each link exactly, whatever their shape. The forces act on
the links' axes: the chordwise distance between a link and the centre of pressure is left out.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, Text, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Area, Density, Force, Speed
from alula.loads.records.applied import LineLoad, PointLoad

Real = NDArray[np.float64]
Direction = tuple[float, float, float]
Points = Mapping[str, Mapping[str, tuple[float, float]]]

LARGEST_LIFT_COEFFICIENT = 2.0
"""Above this a coefficient is refused; glide measurements of birds give at most 0.8 to 1.6 (Withers, J. Exp. Biol. 90,
1981, 143-162; Tucker and Heine, J. Exp. Biol. 149, 1990, 469-489)."""
LARGEST_DRAG_COEFFICIENT = 2.3
"""Above this a coefficient is refused: a half tube open to the stream has as much, the most of the usual shapes; long
plates across it have 1.98, square ones 1.17 (Matthews, Aeronautical Engineer's Data Book, fig. 5.13b)."""
LARGEST_LIFT_TO_DRAG = 20.0
"""Above this ratio the run warns; bird wings reach 3 to 17 (Withers 1981)."""
_LARGEST = (
    (LARGEST_LIFT_COEFFICIENT, "birds: 0.8 to 1.6"),
    (LARGEST_DRAG_COEFFICIENT, "a wing across the stream: 1.2 to 2"),
)
PIECES = 6
"""Linear pieces by which an elliptic spread is represented."""
_NORMAL = 1e-6


class AirPatch(CaseModel):
    """Where a part of an air load acts: along a link between two of its points, or at one point."""

    link: Name
    """The link on which it acts."""
    at: Name | None = None
    """The point at which it acts, in place of start and end."""
    start: Name | None = None
    """The point at which the stretch begins."""
    end: Name | None = None
    """The point at which it ends."""
    shape: Literal["uniform", "elliptic"] = "uniform"
    """elliptic: as the root of 1 - (place on the span)^2."""
    span: tuple[Annotated[float, Field(ge=0, le=1)], Annotated[float, Field(ge=0, le=1)]] = (0.0, 1.0)
    """Elliptic only: place of ``start`` and ``end`` on the span, 0 at the wing's root, 1 at its tip."""
    share: Annotated[float, Field(gt=0, le=1)] | None = None
    """Share of the load; when left out by all: uniform loads by length, elliptic ones by the area under the one ellipse
    over their spans."""

    @model_validator(mode="after")
    def _place(self) -> "AirPatch":
        if (self.at is None) == (self.start is None) or (self.start is None) != (self.end is None):
            raise refusal("state either the point 'at' or both 'start' and 'end'")
        return self


class AirLoad(CaseModel):
    """Lift and drag of a stream: from coefficients, or as given."""

    title: Text = ""
    """What the load is, for the report."""
    stream: Direction
    """Where the air goes, seen from the wing, in global axes; its length does not count."""
    lift_direction: Direction | None = None
    """Where lift acts, normal to the stream, in global axes."""
    lift_towards: Direction | None = None
    """In its place: lift is normal to the stream, in the plane of the stream and this direction, on its side."""
    speed: Annotated[Speed, POSITIVE] | None = None
    """Speed of the stream; with density it gives the dynamic pressure."""
    density: Annotated[Density, POSITIVE] | None = None
    """Density of the air."""
    area: Annotated[Area, POSITIVE] | None = None
    """The reference area S of the coefficients."""
    lift_coefficient: float | None = None
    """C_L, at most 2 in size; needs speed, density and area."""
    drag_coefficient: Annotated[float, Field(ge=0)] | None = None
    """C_D, at most 2.3; needs speed, density and area."""
    lift: Force | None = None
    """Given instead of its coefficient."""
    drag: Annotated[Force, NOT_NEGATIVE] | None = None
    """Given instead of its coefficient."""
    spread: Annotated[tuple[AirPatch, ...], Field(min_length=1)]
    """Where lift and drag act: along links, or at points."""


@dataclass(frozen=True, kw_only=True)
class AirForces:
    """What a stream does to the wing.

    Attributes
    ----------
    pressure : float or None
        Dynamic pressure q [MPa]; None without speed and density.
    lift, drag : float
        Forces [N].
    coefficients : tuple of float or None
        C_L and C_D, stated or implied by the forces; None without speed, density and area.
    given : bool
        True where the forces were given and the coefficients follow from them.
    lift_direction, drag_direction : array (3,)
        Unit vectors in global axes; the first is zero without lift.
    """

    pressure: float | None
    lift: float
    drag: float
    coefficients: tuple[float, float] | None
    given: bool
    lift_direction: Real
    drag_direction: Real

    @property
    def total(self) -> Real:
        """Force (3,) in global axes [N]."""
        return self.lift * self.lift_direction + self.drag * self.drag_direction

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is unusual about these forces, one sentence each."""
        found = []
        if self.drag > abs(self.lift):
            lift = f"the lift ({abs(self.lift):.3g} N)" if self.lift else "the lift (none is stated)"
            found.append(f"the drag ({self.drag:.3g} N) exceeds {lift}, as on no wing that flies")
        if abs(self.lift) > LARGEST_LIFT_TO_DRAG * self.drag:
            ratio = f"{abs(self.lift) / self.drag:.3g}" if self.drag else "infinite"
            found.append(
                f"the lift-to-drag ratio is {ratio}, above {LARGEST_LIFT_TO_DRAG:g}; wings of birds reach 3 to 17"
            )
        return tuple(found)


def air_forces(air: AirLoad, entry: str) -> AirForces:
    """Work out lift and drag with their directions.

    Parameters
    ----------
    air : AirLoad
        The load as stated.
    entry : str
        Path of the load in the case file, for messages.

    Returns
    -------
    AirForces
        Forces, coefficients and directions.

    Raises
    ------
    CaseError
        For what is missing or stated twice, a lift that is not normal to the stream, |C_L| > 2 and C_D > 2.3.

    References
    ----------
    Anderson, Fundamentals of Aerodynamics, 5th ed., chapter 1: L = q S C_L, D = q S C_D, q = rho V^2 / 2.
    """
    along = _unit(air.stream, f"{entry}.stream")
    q = None if air.speed is None or air.density is None else air.density * air.speed**2 / 2.0
    _need_all(air, entry)
    forces, coefficients = [], []
    for name in ("lift", "drag"):
        force, coefficient = getattr(air, name), getattr(air, f"{name}_coefficient")
        if coefficient is not None:
            assert q is not None
            assert air.area is not None
            force = q * air.area * coefficient
        forces.append(0.0 if force is None else force)
        coefficients.append(None if q is None or air.area is None else forces[-1] / (q * air.area))
    lift, drag = forces
    for name, force, coefficient, (largest, usual) in zip(
        ("lift", "drag"), forces, coefficients, _LARGEST, strict=True
    ):
        if coefficient is not None and abs(coefficient) > largest:
            stated = getattr(air, f"{name}_coefficient") is not None
            how = "it is" if stated else f"{name} {force:g} N over q S implies"
            raise CaseError(
                f"{entry}.{name}_coefficient: {how} {coefficient:.4g}, but the largest plausible one is {largest:g} "
                f"({usual}); correct the coefficient, or speed, density and area"
            )
    return AirForces(
        pressure=q,
        lift=lift,
        drag=drag,
        coefficients=None if coefficients[0] is None or coefficients[1] is None else (coefficients[0], coefficients[1]),
        given=air.lift_coefficient is None and air.drag_coefficient is None,
        lift_direction=_lift_direction(air, along, lift, entry),
        drag_direction=along,
    )


def _need_all(air: AirLoad, entry: str) -> None:
    for name in ("lift", "drag"):
        if getattr(air, name) is not None and getattr(air, f"{name}_coefficient") is not None:
            raise CaseError(f"{entry}.{name}: both a force and a coefficient are stated; keep one of the two")
    if all(getattr(air, name) is None for name in ("lift", "drag", "lift_coefficient", "drag_coefficient")):
        raise CaseError(f"{entry}: neither lift nor drag is stated; add a force or a coefficient")
    if air.lift_coefficient is None and air.drag_coefficient is None:
        return
    for name, example in (("speed", "22 m/s"), ("density", "1.225 kg/m^3"), ("area", "0.05 m^2")):
        if getattr(air, name) is None:
            raise CaseError(
                f"{entry}.{name}: it is missing, and a coefficient gives no force without it; "
                f'add it, for example "{example}"'
            )


def _unit(stated: Direction, entry: str) -> Real:
    vector = np.array(stated)
    largest = float(np.abs(vector).max())
    if largest == 0.0:
        raise CaseError(f"{entry}: it is zero and has no direction; write for example [0.0, 0.0, 1.0]")
    vector /= largest  # so that the squares of huge numbers do not overflow, nor those of tiny ones vanish
    return np.asarray(vector / np.linalg.norm(vector))


def _lift_direction(air: AirLoad, along: Real, lift: float, entry: str) -> Real:
    if air.lift_direction is not None and air.lift_towards is not None:
        raise CaseError(f"{entry}: lift_direction and lift_towards are both stated; keep one of the two")
    if air.lift_direction is not None:
        found = _unit(air.lift_direction, f"{entry}.lift_direction")
        if abs(found @ along) > _NORMAL:
            raise CaseError(
                f"{entry}.lift_direction: it is {math.degrees(math.acos(float(found @ along))):.4g} deg from the "
                "stream, but lift is normal to it; correct it, or write lift_towards for the side on which lift acts"
            )
        return found
    if air.lift_towards is not None:
        side = _unit(air.lift_towards, f"{entry}.lift_towards")
        across = side - (side @ along) * along
        if np.linalg.norm(across) <= _NORMAL:
            raise CaseError(
                f"{entry}.lift_towards: it is parallel to the stream, so it tells no side; choose another direction"
            )
        return np.asarray(across / np.linalg.norm(across))
    if lift != 0.0:
        raise CaseError(f"{entry}.lift_direction: it is missing; add it, for example [0.0, 1.0, 0.0]")
    return np.zeros(3)


def check_air(air: AirLoad, entry: str) -> None:
    """Check an air load and how it is spread.

    Parameters
    ----------
    air : AirLoad
        The load.
    entry : str
        Path of the load in the case file, for the message.

    Raises
    ------
    CaseError
        For whatever ``air_forces`` refuses, and for shares that are missing or do not sum to 1.
    """
    air_forces(air, entry)
    stated = [patch.share is not None for patch in air.spread]
    if any(stated) and not all(stated):
        raise CaseError(f"{entry}.spread: some shares are stated and some are not; state all or none")
    total = sum(patch.share or 0.0 for patch in air.spread)
    if all(stated) and abs(total - 1.0) > _NORMAL:
        raise CaseError(f"{entry}.spread: the shares sum to {total:.6g}, not to 1; correct them")
    for i, patch in enumerate(air.spread):
        if patch.at is not None and patch.share is None:
            raise CaseError(f"{entry}.spread.{i}.share: it is missing, and a point has no length; state every share")
        if patch.at is None and patch.shape == "elliptic" and patch.span[0] == patch.span[1]:
            raise CaseError(
                f"{entry}.spread.{i}.span: start and end stand at one place of the span; name two different places"
            )
    if not any(stated):
        _check_sharing(air.spread, f"{entry}.spread")


def _check_sharing(spread: Sequence[AirPatch], entry: str) -> None:
    """Refuse patches without shares that are not of one shape, or that claim one part of the span twice."""
    if len({patch.shape for patch in spread}) > 1:
        raise CaseError(f"{entry}: uniform and elliptic patches do not share a load by themselves; state every share")
    if spread[0].shape == "uniform":
        return
    inner_first = sorted((sorted(patch.span), i) for i, patch in enumerate(spread))
    for (inner, i), (outer, j) in itertools.pairwise(inner_first):
        if outer[0] < inner[1]:
            raise CaseError(
                f"{entry}.{j}.span: it overlaps that of {entry}.{i}, but one ellipse loads each part of the span once; "
                "state the span's parts one after the other, or every share"
            )


def air_loads(air: AirLoad, entry: str, points: Points) -> tuple[LineLoad | PointLoad, ...]:
    """Spread an air load over the links; together the loads are ``air_forces(air).total``.

    Parameters
    ----------
    air : AirLoad
        The load as stated.
    entry : str
        Path of the load in the case file, for messages.
    points : mapping
        Link -> point -> (x, y) in the link's frame [mm].

    Returns
    -------
    tuple of LineLoad or PointLoad
        Loads in global axes.
    """
    total = air_forces(air, entry).total
    found: list[LineLoad | PointLoad] = []
    for patch, share in zip(air.spread, shares(air, points), strict=True):
        if patch.at is not None:
            wrench = np.concatenate([share * total, np.zeros(3)])
            found.append(PointLoad(link=patch.link, point=patch.at, wrench=wrench))
        else:
            found += _lines(patch, share * total, points)
    return tuple(found)


def shares(air: AirLoad, points: Points) -> tuple[float, ...]:
    """Return the share of the load that each patch takes.

    Parameters
    ----------
    air : AirLoad
        The load as stated.
    points : mapping
        Link -> point -> (x, y) in the link's frame [mm].

    Returns
    -------
    tuple of float
        Shares in the order of the patches; they sum to 1.
    """
    if all(patch.share is not None for patch in air.spread):
        return tuple(patch.share or 0.0 for patch in air.spread)
    sizes = []
    for patch in air.spread:
        x0, x1 = _stations(patch, points)
        # The ellipse stands over the span, whatever the lengths of the links on which its parts are laid.
        sizes.append(abs(x1 - x0) if patch.shape == "uniform" else abs(_moments(*patch.span)[0]))
    return tuple(size / sum(sizes) for size in sizes)


def _stations(patch: AirPatch, points: Points) -> tuple[float, float]:
    assert patch.start is not None
    assert patch.end is not None
    return points[patch.link][patch.start][0], points[patch.link][patch.end][0]


def _lines(patch: AirPatch, total: Real, points: Points) -> list[LineLoad]:
    """Line loads that are linear in pieces; each piece keeps the force and the first moment of the true shape."""
    x0, x1 = _stations(patch, points)
    if patch.shape == "uniform":
        density = total / abs(x1 - x0)
        return [LineLoad(link=patch.link, start=min(x0, x1), end=max(x0, x1), at_start=density, at_end=density)]
    e0, e1 = patch.span
    whole = _moments(e0, e1)[0]
    edges = [float(edge) for edge in np.linspace(e0, e1, PIECES + 1)]
    lines = []
    for a, b in itertools.pairwise(edges):
        x_a, x_b = (x0 + (x1 - x0) * (e - e0) / (e1 - e0) for e in (a, b))
        force, first = (m / whole for m in _moments(a, b))
        middle = first / force - (a + b) / 2.0
        tilt = 6.0 * middle / (b - a)  # of the linear density, as a share of its mean
        ends = [total * force / abs(x_b - x_a) * (1.0 + sign * tilt) for sign in (-1.0, 1.0)]
        if x_a > x_b:
            x_a, x_b, ends = x_b, x_a, ends[::-1]
        lines.append(LineLoad(link=patch.link, start=x_a, end=x_b, at_start=ends[0], at_end=ends[1]))
    return lines


def _moments(a: float, b: float) -> Sequence[float]:
    """Integrals of sqrt(1 - e^2) and of e sqrt(1 - e^2) from a to b."""

    def area(e: float) -> float:
        return (e * math.sqrt(1.0 - e * e) + math.asin(e)) / 2.0

    def first(e: float) -> float:
        return -math.pow(1.0 - e * e, 1.5) / 3.0

    return area(b) - area(a), first(b) - first(a)
