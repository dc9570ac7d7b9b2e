"""Flat bars whose width varies along them: solid, rules and sections.

The side is a ``Profile``. Round ends have eyes about whose circles fillets run to the sides, as those of any bar.
"""

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import ON_AXIS, Body, extent, patch_span
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.bodies.eyes import PLAIN_EYE, ROUNDING, TOUCHING, check_flat_eyes
from alula.geometry.bodies.features import Pin
from alula.geometry.bodies.footprint import Footprint, eye, of_border
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel
from alula.geometry.parts.profile import Profile
from alula.geometry.parts.straight import CLEAR_EYE

_CELLS = 32
"""Stretches of one section each that stand for the bar, about. Of a cantilever whose depth halves towards its tip, the
deflection is then right to 0.02 %."""


def raised(side: Profile, body: Body, pin: Pin) -> bool:
    """Return whether an eye is wider than the bar.

    Parameters
    ----------
    side : Profile
        The bar's upper side.
    body : Body
        The body.
    pin : Pin
        One of its pins.

    Returns
    -------
    bool
        False where it is but a hole and, at an end of the bar, a round end.
    """
    return body.ring(pin).diameter > PLAIN_EYE * 2.0 * side.half(pin.x)


def widths_solid(kernel: Kernel, body: Body, side: Profile, *, round_ends: bool) -> Entity:
    """Build a bar of varying width with its eyes.

    Parameters
    ----------
    kernel : Kernel
        The geometry kernel.
    body : Body
        The body, in the kernel's unit.
    side : Profile
        Its upper side, in that unit.
    round_ends : bool
        Whether it has eyes.

    Returns
    -------
    Entity
        The solid.
    """
    thickness, fillet = body.part.eye_thickness, body.part.fillet_radius
    solids = [kernel.extruded(side.border, thickness)]
    eyes = [pin for pin in body.pins if round_ends and raised(side, body, pin)]
    for pin in body.pins:
        if pin in eyes:
            solids += kernel.upright(pin, body.ring(pin).diameter, thickness)
        elif round_ends and pin.x in extent(body):
            solids += kernel.upright(pin, 2.0 * side.half(pin.x), thickness)
    solid = kernel.fuse(solids, unify=True)
    if not eyes or fillet == 0.0:
        return solid

    def to_fillet(p: NDArray[np.float64]) -> bool:
        return abs(abs(p[1]) - side.half(p[0])) < ON_SURFACE and any(
            abs(pin.distance(p[0], p[1]) - body.ring(pin).diameter / 2.0) < ON_SURFACE for pin in eyes
        )

    return kernel.fillet(solid, kernel.curves(to_fillet), fillet)


def widths_footprints(body: Body, side: Profile, *, round_ends: bool) -> tuple[Footprint, ...]:
    """Return what a bar of varying width covers.

    Parameters
    ----------
    body : Body
        The body.
    side : Profile
        The bar's upper side.
    round_ends : bool
        Whether it has eyes.

    Returns
    -------
    tuple of Footprint
        Its outline, and the eyes that ``widths_solid`` builds.
    """
    found = [of_border(side.border, body.part.eye_thickness)]
    for pin in body.pins if round_ends else ():
        if raised(side, body, pin):
            found += eye(pin, body.ring(pin), body.ring(pin).diameter)
        elif pin.x in extent(body):
            found += eye(pin, body.ring(pin), 2.0 * side.half(pin.x))
    return tuple(found)


def check_widths(body: Body, side: Profile, *, round_ends: bool) -> None:
    """Refuse what does not fit a bar of varying width.

    Parameters
    ----------
    body : Body
        The body.
    side : Profile
        The bar's upper side.
    round_ends : bool
        Whether it has eyes.

    Raises
    ------
    CaseError
        With the entry, the value, the rule and a remedy.
    """
    for pin in body.pins:
        what = "a slot" if pin.slot > 0.0 else "an arm" if pin.foot is not None else ""
        if what or abs(pin.y) > ON_AXIS * side.half(pin.x):
            found = f"has {what}" if what else "lies off the axis"
            raise CaseError(
                f"{pin.name} {found}, but a bar with widths has round pin holes on its axis alone: state one width, or "
                "take a part of shape plate"
            )
    check_flat_eyes(body)
    side.check("shoulder_radius")
    first, last = extent(body)
    for end in body.ends:
        low, high = patch_span(body, end)
        if not side.even(max(low, first), min(high, last)):
            raise CaseError(
                f"the loaded patch of {end.name} runs from x = {low:.4g} to {high:.4g} mm, over a station of widths or "
                f"its fillet: reduce {end.entry}, or move the station"
            )
    if round_ends:
        reaches = [(pin, *_reach(body, side, pin)) for pin in body.pins]
        for (one, _, high), (other, low, _) in itertools.pairwise(sorted(reaches, key=lambda reach: reach[0].x)):
            if low - high <= TOUCHING * (other.x - one.x):
                raise CaseError(
                    f"the eyes at {one.name} and {other.name}, or their fillets, overlap: move the points more than "
                    f"{high - one.x + other.x - low:.4g} mm apart (now {other.x - one.x:.4g} mm), or reduce the "
                    f"diameters of the eyes or fillet_radius {body.part.fillet_radius:.4g} mm"
                )


def _reach(body: Body, side: Profile, pin: Pin) -> tuple[float, float]:
    """Return the x between which an eye lies with its fillets; refuse one that does not fit its sides."""
    radius, width, ends = body.ring(pin).diameter / 2.0, 2.0 * side.half(pin.x), extent(body)
    low, high = max(pin.x - radius, ends[0]), min(pin.x + radius, ends[1])
    parallel = side.even(low, high) and abs(side.half(low) - side.half(high)) <= ROUNDING * width
    least = (1.0 if parallel else CLEAR_EYE) * width
    if 2.0 * radius < (1.0 - ROUNDING) * least:
        raise CaseError(
            f"the eye at {pin.name} has a diameter of {2.0 * radius:.4g} mm, but must have at least {least:.4g} mm, "
            f"{least / width:g} times the width of the bar there; increase it"
        )
    if not raised(side, body, pin):
        return pin.x - radius, pin.x + radius
    reaches = [pin.x, pin.x]
    for k, way in enumerate((-1, 1)):
        if pin.x == ends[k]:
            continue
        found = side.fillets(pin.x, radius, body.part.fillet_radius, way)
        if len(found) != 1:
            raise CaseError(
                f"the fillet of the eye at {pin.name} (diameter {2.0 * radius:.4g} mm, fillet_radius "
                f"{body.part.fillet_radius:.4g} mm) does not touch a straight side of the bar towards "
                f"{'greater' if way > 0 else 'smaller'} x: move the stations of widths away from the eye, or change "
                "its diameter or fillet_radius"
            )
        reaches[k] = found[0][1][0]
    return min(reaches[0], pin.x - radius), max(reaches[1], pin.x + radius)


def widths_places(body: Body, side: Profile, size: float, share: float) -> list[tuple[float, str]]:
    """Return where elements must be small: along fillets and at sharp corners.

    Parameters
    ----------
    body : Body
        The body.
    side : Profile
        The bar's upper side.
    size : float
        Element edge elsewhere.
    share : float
        Element edge along a fillet over its radius.

    Returns
    -------
    list of tuple
        As ``PartKind.fine_places``.
    """
    balls = list(side.balls)
    fillet = body.part.fillet_radius
    for pin in body.pins:
        if raised(side, body, pin):
            radius = body.ring(pin).diameter / 2.0
            balls += [(centre, fillet) for way in (-1, 1) for centre, _ in side.fillets(pin.x, radius, fillet, way)]
    return [
        (
            min((radius or size) * share, size),
            f"Max(Sqrt((x-({x:.12g}))^2+(Fabs(y)-({y:.12g}))^2)-{radius:.12g},0)",
        )
        for (x, y), radius in balls
    ]


def widths_cuts(body: Body, side: Profile) -> tuple[CutSection, ...]:
    """Return the sections of a bar of varying width, without its eyes, holes and shoulder fillets.

    Stretches between corners begin and end with two short cells of one length, so that the borders of all cells,
    halfway between their sections, fall on the corners, and stress is told close to them.

    Parameters
    ----------
    body : Body
        The body.
    side : Profile
        Its upper side between its outermost pins and load points.

    Returns
    -------
    tuple of CutSection
        By rising x.
    """
    (first, _), (last, _) = side.corners[0], side.corners[-1]
    stretches = [(a, b) for a, b in itertools.pairwise(side.corners) if b[0] - a[0] > ROUNDING * (last - first)]
    pitch = (last - first) / _CELLS
    edge = min(pitch / 4.0, min(b[0] - a[0] for a, b in stretches)) / 8.0
    found = []
    for a, b in stretches:
        count = max(math.ceil((b[0] - a[0] - 8.0 * edge) / pitch), 0)
        low, high = a[0] + 3.0 * edge, b[0] - 3.0 * edge
        inner = [low + (high - low) * i / (count + 1) for i in range(1, count + 1)]
        slope = (b[1] - a[1]) / (b[0] - a[0])
        stations = (a[0] + edge, low, *inner, high, b[0] - edge)
        found += [_section(x, 2.0 * (a[1] + slope * (x - a[0])), body.part.eye_thickness) for x in stations]
    return tuple(found)


def _section(x: float, width: float, thickness: float) -> CutSection:
    y, z = width / 2.0, thickness / 2.0
    return CutSection(
        x=x,
        area=width * thickness,
        centre=(0.0, 0.0),
        i_y=width * thickness**3 / 12.0,
        i_z=thickness * width**3 / 12.0,
        i_yz=0.0,
        hull=((-y, -z), (y, -z), (y, z), (-y, z)),
    )
