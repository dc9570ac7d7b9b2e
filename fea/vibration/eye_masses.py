"""The mass of a link's eyes on its frame: discs about their pins in place of the beams that run into them.

A beam ends at its pin, or runs through it. Its eye is a disc about the pin, which is wider and reaches beyond the pin.
So the disc stands as a rigid body at the pin's node, less the beam within it; of a slot half a disc at either end, as
its flanks are beams. What fillets and the curved end of the beam add to that is at the disc's rim. It matters
where pins hold a link: what lies about them hardly swings.
"""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.features import Pin

Floats = NDArray[np.float64]
_XI, _WEIGHTS = np.array([0.5 - math.sqrt(1.0 / 12.0), 0.5 + math.sqrt(1.0 / 12.0)]), np.array([0.5, 0.5])


def eye_bodies(
    body: Body, density: float, frame: LinkageFrame, link: str, model: FrameModel, elements: Mapping[int, bool]
) -> list[tuple[int, Floats]]:
    """Return what the eyes of a link weigh more than the beams within them.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    density : float
        Of its material, twice that for a pair [tonne/mm³].
    frame : LinkageFrame
        With the link.
    link : str
        Its name.
    model : FrameModel
        Of the frame with divided beams.
    elements : mapping of int to bool
        Elements of the model that are the link's beams; True for flanks of slots.

    Returns
    -------
    list of (int, ndarray of shape (6, 6))
        Nodes with mass matrices for their motion, global axes; none for a part without eyes.
    """
    found = []
    for pin in body.pins if body.part.is_beam else ():
        if body.ring(pin).diameter > 0.0:
            for node, share in _nodes(frame, link, pin):
                disc = density * share * _disc(body, pin)
                for i in (i for i, flank in elements.items() if not flank):
                    disc = disc - density * _within(model, i, model.nodes[node], body.ring(pin).diameter / 2.0)
                found.append((node, disc))
    return found


def with_rims(eyes: list[tuple[int, Floats]], body: Body, mass: float) -> list[tuple[int, Floats]]:
    """Return eyes with a mass on their rims, shared evenly.

    Parameters
    ----------
    eyes : list of (int, ndarray of shape (6, 6))
        Of a link.
    body : Body
        Its geometry.
    mass : float
        Of all of them together [tonne].

    Returns
    -------
    list of (int, ndarray of shape (6, 6))
    """
    radius = max(body.ring(pin).diameter for pin in body.pins) / 2.0
    rim = mass / len(eyes) * np.diag([1.0, 1.0, 1.0, radius**2, radius**2, radius**2])
    return [(node, matrix + rim) for node, matrix in eyes]


def _nodes(frame: LinkageFrame, link: str, pin: Pin) -> Iterator[tuple[int, float]]:
    """Nodes at which an eye stands, with shares of its mass: at its pin, or at both ends of a slot."""
    if pin.slot == 0.0:
        yield frame.points[link, pin.name], 1.0
        return
    for x in pin.span:
        yield min(frame.stations[link], key=lambda station: abs(station[0] - x))[1], 0.5


def _disc(body: Body, pin: Pin) -> Floats:
    """Mass matrix (6, 6) of a disc about its middle, without its hole and the gap of a fork, for unit density."""
    ring = body.ring(pin)
    outer, inner, height = ring.diameter / 2.0, pin.diameter / 2.0, ring.thickness
    area, second = math.pi * (outer**2 - inner**2), math.pi * (outer**4 - inner**4) / 2.0
    volume, about_z, along_z = area * height, second * height, area * height**3 / 12.0
    if pin.fork is not None:
        reach = min(pin.fork.depth, outer)
        cut = math.pi * (reach**2 - inner**2)
        volume -= cut * pin.fork.gap
        about_z -= math.pi * (reach**4 - inner**4) / 2.0 * pin.fork.gap
        along_z -= cut * pin.fork.gap**3 / 12.0
    across = about_z / 2.0 + along_z
    return np.diag([volume, volume, volume, across, across, about_z])


def _within(model: FrameModel, i: int, centre: Floats, radius: float) -> Floats:
    """Mass matrix (6, 6) about a node of the part of a beam within a disc about it, for unit density."""
    start = model.ends(i)[0]
    length, R = model.length(i), model.axes(i)
    along, away = R[0], (start - centre)[:2]
    # |away + s along| = radius, with what lies in the plane
    middle = -float(away @ along[:2])
    half = radius**2 - float(away @ away) + middle**2
    if half <= 0.0:
        return np.zeros((6, 6))
    low, high = max(middle - math.sqrt(half), 0.0), min(middle + math.sqrt(half), length)
    if high <= low:
        return np.zeros((6, 6))
    section = model.elements[i].section
    turning = R.T @ np.diag([section.i_y + section.i_z, section.i_y, section.i_z]) @ R
    found = np.zeros((6, 6))
    for s, weight in zip(low + _XI * (high - low), _WEIGHTS * (high - low), strict=True):
        x, y, z = start + s * along - centre
        move = np.array([[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]])
        found += weight * section.area * move.T @ move
        found[3:, 3:] += weight * turning
    return found
