"""Lines that stand for springs and stops in the drawing of a linkage."""

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.pose import Pose
from alula.loads.acting.acting import ActingMark

Real = NDArray[np.float64]

_COILS = 6


def mark_line(mark: ActingMark, pose: Pose, size: float) -> Real:
    """Return the line of something that acts.

    Parameters
    ----------
    mark : ActingMark
    pose : Pose
        In which it is drawn.
    size : float
        Of the linkage [mm].

    Returns
    -------
    ndarray, shape (n, 2)
        [mm]
    """
    if mark.kind == "wall":
        middle = mark.at + 0.14 * size * mark.aside
        return stop_mark(np.array([middle.real, middle.imag]), float(np.angle(mark.behind)), 0.05 * size)
    route = np.array([pose.position(*end) for end in mark.ends])
    if mark.kind == "coil":
        return coil(route[0], route[-1], 0.016 * size)
    if mark.kind == "spiral":
        return spiral(route[0], pose.angles[mark.ends[0][0]], 0.035 * size)
    return route


def coil(start: Real, end: Real, half: float) -> Real:
    """Return a zigzag between two points.

    Parameters
    ----------
    start, end : ndarray, shape (2,)
    half : float
        Of its width.

    Returns
    -------
    ndarray, shape (n, 2)
    """
    way = end - start
    length = float(np.linalg.norm(way))
    if length == 0.0:
        return np.array([start, end])
    across = half * np.array([-way[1], way[0]]) / length
    shares = np.linspace(0.2, 0.8, 2 * _COILS + 1)
    sides = np.where(np.arange(len(shares)) % 2 == 1, 1.0, -1.0)
    sides[[0, -1]] = 0.0
    inner = start + shares[:, None] * way + sides[:, None] * across
    return np.vstack([start, inner, end])


def spiral(at: Real, angle: float, radius: float) -> Real:
    """Return a spiral of two turns about a point.

    Parameters
    ----------
    at : ndarray, shape (2,)
    angle : float
        At which it ends [rad].
    radius : float
        At its end.

    Returns
    -------
    ndarray, shape (n, 2)
    """
    turn = np.linspace(0.0, 4.0 * np.pi, 73)
    reach = radius * (0.4 + 0.6 * turn / turn[-1])
    return np.asarray(at + reach[:, None] * np.column_stack([np.cos(turn + angle), np.sin(turn + angle)]))


def stop_mark(at: Real, behind: float, size: float) -> Real:
    """Return a wall with hatches on its far side.

    Parameters
    ----------
    at : ndarray, shape (2,)
        Its middle.
    behind : float
        Direction of the far side [rad].
    size : float
        Of the wall.

    Returns
    -------
    ndarray, shape (n, 2)
    """
    far = np.array([np.cos(behind), np.sin(behind)])
    wall = np.array([-far[1], far[0]])
    line: list[Real] = []
    for share in (-0.5, -0.17, 0.17, 0.5):
        foot = at + share * size * wall
        line += [foot, foot + 0.35 * size * (far - 0.6 * wall), foot]
    return np.array(line)
