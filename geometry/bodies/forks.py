"""Fork ends: an eye with a gap in the middle of its thickness, in which the eye of the other link lies.

The gap is cut by a cylinder about the pin's axis, as a slotting cutter leaves it: it clears the other link's eye
whatever its angle, and its root is a circular arc. ``radius`` rounds the edges between root and cheeks.
"""

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body, apart
from alula.geometry.bodies.features import Fork

ROOM = 1.05
"""Depth of a gap, less what rounds its root, over the radius of the larger eye, where none is stated: assumed."""
ROUNDEST = 0.49
"""Largest radius at the root over the gap: two of half the gap would meet, where the kernel fails."""
THINNEST = 0.05
"""Least cheek over the thickness of the part: assumed, a thinner one is hardly made."""


def depth_of(eyes: tuple[float, float], radius: float) -> float:
    """Return the depth of a gap that clears two eyes.

    Parameters
    ----------
    eyes : tuple of float
        Diameters of the fork's own eye and of the one in its gap [mm].
    radius : float
        That rounds the root [mm].

    Returns
    -------
    float
        From the pin's axis to the root [mm].
    """
    return ROOM * max(eyes) / 2.0 + radius


def check_forks(body: Body) -> None:
    """Refuse forks whose gap does not go with the part.

    Parameters
    ----------
    body : Body
        The body.

    Raises
    ------
    CaseError
        With the point, the value, the rule and a remedy.
    """
    for pin in body.pins:
        fork, thick = pin.fork, body.part.section.height
        if fork is None:
            continue
        if pin.slot > 0.0:
            raise CaseError(f"a fork at {pin.name}: its pin slides in a slot, and a slot has no fork; leave one out")
        most = (1.0 - 2.0 * THINNEST) * thick
        if fork.gap > most:
            raise CaseError(
                f"the fork at {pin.name} has a gap of {fork.gap:.4g} mm in a {body.part.shape} {thick:.4g} mm thick, "
                f"whose cheeks would be too thin: set fork to at most {most:.4g} mm, or make the part thicker"
            )
        if fork.radius > ROUNDEST * fork.gap:
            raise CaseError(
                f"the fork at {pin.name} has a fork_radius of {fork.radius:.4g} mm, but it must be at most "
                f"{ROUNDEST * fork.gap:.4g} mm, {ROUNDEST:g} of the gap; reduce it"
            )
        least = body.ring(pin).diameter / 2.0 + fork.radius
        if fork.depth < least:
            raise CaseError(
                f"the fork at {pin.name} is {fork.depth:.4g} mm deep, less than the radius of its eye and fork_radius; "
                f"set fork_depth to at least {least:.4g} mm, or leave it out"
            )
        _check_beside(body, pin.name, fork)


def _check_beside(body: Body, name: str, fork: Fork) -> None:
    """Refuse a gap that reaches into the eye of another pin."""
    own = body.pin(name)
    for pin in body.pins:
        least = fork.depth + max(body.ring(pin).diameter, pin.diameter) / 2.0
        if pin is not own and apart(own, pin) <= least:
            raise CaseError(
                f"the gap of the fork at {name}, {fork.depth:.4g} mm deep, reaches the eye at {pin.name}: move the "
                f"points more than {least:.4g} mm apart (now {apart(own, pin):.4g} mm), or reduce fork_depth"
            )


def fork_places(body: Body, size: float, share: float) -> list[tuple[float, str]]:
    """Return where elements must be small at forks, as ``PartKind.fine_places``.

    Parameters
    ----------
    body : Body
        The body.
    size : float
        Element edge elsewhere, in the unit of the body.
    share : float
        Element edge along a fillet over its radius.

    Returns
    -------
    list of tuple
        Element edge, and the distance as a formula: in the cheeks, and along the edges of the root.
    """
    places = []
    for pin in body.pins:
        if (fork := pin.fork) is not None:
            cheek = (body.part.section.height - fork.gap) / 2.0
            places.append((min(cheek, size), f"Max({pin.distance_formula}-{fork.depth:.12g},0)"))
            away = f"({pin.distance_formula}-{fork.depth - fork.radius:.12g})"
            above = f"(Fabs(z)-{fork.gap / 2.0 - fork.radius:.12g})"
            edge = min((fork.radius or size) * share, size)
            places.append((edge, f"Fabs(Sqrt({away}^2+{above}^2)-{fork.radius:.12g})"))
    return places
