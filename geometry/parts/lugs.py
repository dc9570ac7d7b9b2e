"""Arms of tubes: flat lugs square on the wall, with a round end about a pin off the axis, and a fillet at the foot.

Slanting lugs are refused: the kernel's fillets about them came out with a volume 1 % off.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import ON_AXIS, Body, patch_span
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.bodies.features import Pin
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel


def without_lugs(body: Body) -> Body:
    """Return a tube without its arms.

    Parameters
    ----------
    body : Body
        A body whose part is a tube.

    Returns
    -------
    Body
        The same with the pins on its axis alone.
    """
    return replace(body, pins=tuple(pin for pin in body.pins if pin.foot is None))


def _lugs(body: Body) -> list[Pin]:
    return [pin for pin in body.pins if pin.foot is not None]


def check_lugs(body: Body, reach: tuple[float, float]) -> None:
    """Refuse lugs that do not fit on the plain wall of the tube, and pins too close to it.

    Parameters
    ----------
    body : Body
        A body whose part is a tube.
    reach : tuple of float
        The x between which the tube lies [mm].

    Raises
    ------
    CaseError
        With the arm, the rule and a remedy.
    """
    lugs = _lugs(body)
    if not lugs:
        return
    fillet, tube = body.part.fillet_radius, body.part.section.width
    width, thick = body.part.arm_section.width, body.part.arm_section.height
    if thick + 2.0 * fillet >= tube:
        raise CaseError(
            f"arm_thickness {thick:.4g} mm and two fillets of {fillet:.4g} mm are not narrower than outer_diameter "
            f"{tube:.4g} mm; reduce arm_thickness or fillet_radius"
        )
    for pin in lugs:
        assert pin.foot is not None
        if pin.ring is not None:
            raise CaseError(
                f"the eye stated at {pin.name} has no meaning: an arm of a tube ends as wide as arm_width; leave it out"
            )
        if abs(pin.x - pin.foot[0]) > ON_AXIS * tube:
            raise CaseError(
                f"the arm to {pin.name} starts at x = {pin.foot[0]:.6g} mm, but an arm of a tube stands square on it: "
                f"let it start at x = {pin.x:.6g} mm"
            )
        least = (tube + width) / 2.0 + fillet
        if abs(pin.y) <= least:
            raise CaseError(
                f"{pin.name} is too close to the tube: move it more than {least:.4g} mm off the link's axis (now "
                f"{abs(pin.y):.4g} mm), or reduce arm_width or fillet_radius"
            )
    _check_room(body, lugs, reach)


def _check_room(body: Body, lugs: list[Pin], reach: tuple[float, float]) -> None:
    """Refuse feet that reach an eye, a pin, a hole, a loaded patch, an end of the tube or one another."""
    first, last = reach
    half = body.part.arm_section.width / 2.0 + body.part.fillet_radius
    taken = [(-math.inf, first, "the end of the tube"), (last, math.inf, "the end of the tube")]
    for pin in without_lugs(body).pins:
        own = eye_reach(body, pin)
        taken.append((pin.x - own, pin.x + own, f"the eye or pin hole at {pin.name}"))
    taken += [(*patch_span(body, end), f"the loaded patch of {end.name}") for end in body.ends]
    taken += [
        (x - row.diameter / 2.0, x + row.diameter / 2.0, f"a hole at x = {x:.4g} mm")
        for row in body.holes
        for x in row.positions
    ]
    for pin in lugs:
        low, high = pin.x - half, pin.x + half
        for start, end, what in taken:
            if low < end and start < high:
                raise CaseError(
                    f"the arm to {pin.name}, which takes x = {low:.4g} to {high:.4g} mm of the tube with its fillets, "
                    f"runs into {what}; let it start elsewhere, or reduce arm_width or fillet_radius"
                )
        taken.append((low, high, f"the arm to {pin.name}"))


def with_lugs(kernel: Kernel, body: Body, tube: Entity) -> Entity:
    """Build the lugs onto a tube that is solid yet.

    Parameters
    ----------
    kernel : Kernel
        The geometry kernel.
    body : Body
        The body, in the kernel's unit.
    tube : Entity
        The tube.

    Returns
    -------
    Entity
        Both in one, with fillets between them.

    Raises
    ------
    FilletError
        Where a fillet does not fit.
    """
    lugs = _lugs(body)
    if not lugs:
        return tube
    section, radius = body.part.arm_section, body.part.section.half_y
    for pin in lugs:
        corner = (pin.x - section.half_y, min(pin.y, 0.0), -section.half_z)
        lug = kernel.box(corner, (section.width, abs(pin.y), section.height))
        end = kernel.upright(pin, section.width, section.height)
        tube = kernel.fuse([tube, kernel.fuse([lug, *end], unify=True)])

    def to_fillet(p: NDArray[np.float64]) -> bool:
        """Return whether a point lies where a lug leaves the wall."""
        return abs(math.hypot(p[1], p[2]) - radius) < ON_SURFACE and any(_on_side(body, pin, p) for pin in lugs)

    if body.part.fillet_radius == 0.0:
        return tube
    return kernel.fillet(tube, kernel.curves(to_fillet), body.part.fillet_radius)


def _on_side(body: Body, pin: Pin, p: NDArray[np.float64]) -> bool:
    section = body.part.arm_section
    on_side = abs(max(abs(p[0] - pin.x) - section.half_y, abs(p[2]) - section.half_z)) < ON_SURFACE
    return bool(p[1] * pin.y > 0.0) and on_side


def fine_at_lugs(body: Body, size: float, share: float) -> list[tuple[float, str]]:
    """Return where elements must be small at the feet of lugs, as ``PartKind.fine_places``.

    Parameters
    ----------
    body : Body
        The body, in the kernel's unit.
    size : float
        Element edge elsewhere.
    share : float
        Element edge along a fillet over its radius.

    Returns
    -------
    list of tuple
        Element edge, and the distance from the fillet as a formula of the mesher.
    """
    if not _lugs(body):
        return []
    fillet, found = body.part.fillet_radius, []
    edge, wall = min((fillet or size) * share, size), f"(Sqrt(y^2+z^2)-{body.part.section.half_y:.12g})"
    section = body.part.arm_section
    for pin in _lugs(body):
        side = f"Max(Fabs(x-({pin.x:.12g}))-{section.half_y:.12g},Fabs(z)-{section.half_z:.12g})"
        below = f"Max({-math.copysign(1.0, pin.y):g}*y,0)"
        found.append((edge, f"Max(Sqrt(({side})^2+{wall}^2+({below})^2)-{fillet:.12g},0)"))
    return found
