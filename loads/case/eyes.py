"""Eyes of sizes of their own, and forks, as a link states them."""

from collections.abc import Callable, Mapping
from dataclasses import replace

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import Fork, Pin, Ring
from alula.geometry.bodies.forks import depth_of
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.parts.part import Body, FilePart, Part


def with_eye(linkage: Linkage, parts: Mapping[str, Part], body_of: Callable[[str], Body], link: str, pin: Pin) -> Pin:
    """Return the pin hole of a link with the eye that the link states there, and its fork.

    Parameters
    ----------
    linkage : Linkage
    parts : mapping of str to Part
    body_of : callable
        Returns the body of a link with an imported part.
    link : str
        With a part.
    pin : Pin
        Without eye.

    Returns
    -------
    Pin
        As it was where none is stated, and of imported parts, whose file has it.

    Raises
    ------
    CaseError
        For a fork whose depth does not follow from the other link's eye.
    """
    record = linkage.links[link]
    eye, part = record.eyes.get(pin.name), parts[record.part or ""]
    if eye is None or isinstance(part, FilePart):
        return pin
    half, diameter = (eye.thickness or part.eye_thickness) / 2.0, eye.diameter or part.ring(pin).diameter
    if eye.fork is None:
        return replace(pin, ring=Ring(diameter=diameter, low=-half, high=half))
    depth = eye.fork_depth
    if depth is None:
        other = _across(linkage, parts, body_of, joint_of_fork(linkage, link, pin.name), link)
        if other == 0.0:
            raise CaseError(
                f"links.{link}.eyes.{pin.name}.fork_depth: it is missing, and the other link has no eye there from "
                "which it would follow; state how deep the gap is from the pin's axis"
            )
        depth = depth_of((diameter, other or diameter), eye.fork_radius)
    gap = eye.fork / 2.0
    return replace(
        pin,
        ring=Ring(diameter=diameter, low=-half, high=half, gaps=((-gap, gap),)),
        fork=Fork(gap=eye.fork, depth=depth, radius=eye.fork_radius),
    )


def _across(
    linkage: Linkage, parts: Mapping[str, Part], body_of: Callable[[str], Body], joint: str, link: str
) -> float | None:
    """Return the diameter of the other link's eye at a joint [mm]; None where that link has no part."""
    mate = other_link(linkage, joint, link)
    record, point = linkage.links[mate], linkage.point_of(joint, mate)
    if record.part is None or record.part not in parts:
        return None
    part, stated = parts[record.part], record.eyes.get(point)
    if isinstance(part, FilePart):
        body = body_of(mate)
        return body.across(body.pin(point))
    if stated is not None and stated.diameter is not None:
        return stated.diameter
    x, y = record.points[point]
    return part.ring(Pin(name=point, x=x, y=y, diameter=0.0)).diameter


def joint_of_fork(linkage: Linkage, link: str, point: str) -> str:
    """Return the joint at a fork.

    Parameters
    ----------
    linkage : Linkage
    link, point : str
        Of the fork.

    Returns
    -------
    str
        Its name.

    Raises
    ------
    CaseError
        Where the pin does not turn in it, or holds more than one other link.
    """
    here = linkage.joints_at(link, point)
    entry = f"links.{link}.eyes.{point}.fork"
    if len(here) != 1:
        raise CaseError(
            f"{entry}: a fork takes the eye of one link in its gap, but joints {', '.join(here)} are there; leave fork "
            "out, or join the other links elsewhere"
        )
    if linkage.joints[here[0]].slides:
        raise CaseError(f"{entry}: joint '{here[0]}' slides, but a fork has a revolute joint; leave fork out")
    return here[0]


def other_link(linkage: Linkage, joint: str, link: str) -> str:
    """Return the other link of a joint.

    Parameters
    ----------
    linkage : Linkage
    joint, link : str

    Returns
    -------
    str
    """
    first, second = linkage.joints[joint].links
    return second if link == first else first
