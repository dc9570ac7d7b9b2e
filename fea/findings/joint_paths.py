"""Paths of the joints and points of a moving linkage, for tables, figures and the animation."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.of_motion import PlayOverMotion
from alula.geometry.linkage.motion import Motion

Real = NDArray[np.float64]
_SAME = 1e-9
"""Points nearer than this share of the longest link are one."""


def moving_points(motion: Motion) -> dict[str, Real]:
    """Return the paths of all points that move.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    dict
        Name -> path (n, 2) [mm]; ``link.point`` where points of one name differ.
    """
    groups: dict[str, list[tuple[str, Real]]] = {}
    for link, point in motion.closure.point_names:
        groups.setdefault(point, []).append((link, motion.position(link, point)))
    found: dict[str, Real] = {}
    near = _SAME * motion.linkage.longest
    for point, members in groups.items():
        same = all(float(np.max(np.abs(xy - members[0][1]))) <= near for _, xy in members)
        for link, xy in members[:1] if same else members:
            if float(np.max(np.abs(xy - xy[0]))) > near:
                found[point if same else f"{link}.{point}"] = xy
    return found


def path_length(xy: Real) -> float:
    """Return the length of a path.

    Parameters
    ----------
    xy : array
        (n, 2).

    Returns
    -------
    float
        In the unit of the path.
    """
    return float(np.sum(np.linalg.norm(np.diff(xy, axis=0), axis=1)))


def owners(motion: Motion, label: str) -> tuple[tuple[str, str], ...]:
    """Return the moving links and points that a path is of.

    Parameters
    ----------
    motion : Motion
    label : str
        As ``moving_points`` has it.

    Returns
    -------
    tuple of (str, str)
        Links and points: several where links share a pin.
    """
    names = motion.closure.point_names
    return tuple(
        pair for pair in names if label in (pair[1], f"{pair[0]}.{pair[1]}") and pair[0] != motion.linkage.ground
    )


def loosest(motion: Motion, play: PlayOverMotion, label: str) -> tuple[str, str]:
    """Return the link and point of a path that play lets move furthest.

    Parameters
    ----------
    motion : Motion
    play : PlayOverMotion
    label : str
        As ``moving_points`` has it.

    Returns
    -------
    tuple of (str, str)
    """
    ends = {pair: np.max(np.where(play.passes, 0.0, play.points[pair].free)) for pair in owners(motion, label)}
    return max(ends, key=lambda pair: float(ends[pair]))
