"""Where the names of flat faces stand in the picture of a part: on the face where there is room, else beside it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.scene import View, hits
from alula.reports.figures.sheet.letters import extent

Real = NDArray[np.float64]

_TRIED = 80
"""Places of a face that are tried, those nearest to its centre first."""
_LATTICE = 5
"""Into which the sides of a triangle are divided for places on it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FaceSpot:
    """Where the name of a face that is seen goes.

    Attributes
    ----------
    at : array
        Place on the face (3,) [mm].
    fits : bool
        Whether the name fits on the face there.
    """

    at: Real
    fits: bool


def face_spot(
    name: str, face: Real, centre: Real, corners: Real, view: View, scale: float, size: float
) -> FaceSpot | None:
    """Find where the name of a flat face goes in a view.

    Parameters
    ----------
    name : str
        What is written.
    face : array
        Triangles (n, 3, 3) of the face [mm].
    centre : array
        Its centroid (3,) [mm].
    corners : array
        Triangles (k, 3, 3) of the whole surface [mm].
    view : View
        From where one looks.
    scale : float
        Points on the sheet per mm.
    size : float
        Of the letters [points].

    Returns
    -------
    FaceSpot or None
        None where nothing of the face is seen.
    """
    normal = np.cross(face[:, 1] - face[:, 0], face[:, 2] - face[:, 0]).sum(axis=0)
    toward = float(normal @ view.toward) / float(np.linalg.norm(normal))
    if toward < 0.05:
        return None
    half = (np.array(extent(name, size)) / 2.0 + 1.0) / scale
    arms = [u * half[0] * view.right + v * half[1] * view.up for u in (-1.0, 0.0, 1.0) for v in (-1.0, 1.0)]
    arms = [arm - (normal @ arm) / (normal @ view.toward) * view.toward for arm in arms]  # back onto the face
    steps = [(i, j) for i in range(1, _LATTICE) for j in range(1, _LATTICE - i + 1)]
    shares = np.array([(i, j, _LATTICE + 1 - i - j) for i, j in steps]) / (_LATTICE + 1)
    places = np.vstack([centre, np.einsum("sc,ncx->nsx", shares, face).reshape(-1, 3)])
    nearest = places[np.argsort(np.linalg.norm(places - centre, axis=1), kind="stable")[:_TRIED]]
    seen = [at for at in nearest if _on(at, face, view) and is_seen(at, corners, view)]
    for at in seen:
        if all(_on(at + arm, face, view) and is_seen(at + arm, corners, view) for arm in arms):
            return FaceSpot(at=at, fits=True)
    return FaceSpot(at=seen[0], fits=False) if seen else None


def _on(at: Real, face: Real, view: View) -> bool:
    """Return whether a place on the plane of a face is on it: a ray from before it meets one of its triangles."""
    a, b, c = np.moveaxis(face, 1, 0)
    return hits(at + 1e-3 * view.half_width * view.toward, -view.toward, a, b - a, c - a)


def is_seen(at: Real, corners: Real, view: View) -> bool:
    """Return True if no triangle stands between a place and the viewer.

    Parameters
    ----------
    at : array
        Place (3,) [mm].
    corners : array
        Triangles (k, 3, 3) [mm].
    view : View
        From where one looks.

    Returns
    -------
    bool
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    return not hits(at + 1e-6 * view.half_width * view.toward, view.toward, a, b - a, c - a)
