"""The flat faces of an imported part that carry loads, in the frame of its link."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import FlatFace
from alula.geometry.imported.facts import Face, Vector
from alula.geometry.imported.read import part_facts
from alula.geometry.parts.step import FilePart

Real = NDArray[np.float64]

ROUNDED = 1e-6
"""Components of a normal, and shares of a face's size by which its centre lies off z = 0, that count as none."""
_SHOWN = 12
"""Faces that a message names at most."""


def load_faces(part: FilePart, turn: Real, shift: Real) -> dict[str, FlatFace]:
    """Return the faces that a part names for load points of its link.

    Parameters
    ----------
    part : FilePart
        The part, as the case states it.
    turn : ndarray
        Rotation (3, 3) from the file to the link.
    shift : ndarray
        Where the origin of the file lies in the link (3,) [mm].

    Returns
    -------
    dict of str to FlatFace
        By point.

    Raises
    ------
    CaseError
        Where it names a face that is not there.
    CannotRunError
        Where the kernel fails.
    """
    if not part.faces:
        return {}
    known = part_facts(Path(part.file), part.mesh_unit).faces
    return {point: _placed(_named(known, point, name), turn, shift) for point, name in part.faces.items()}


def _named(known: Sequence[Face], point: str, name: str) -> Face:
    for face in known:
        if face.name == name:
            return face
    told = [f"{face.name} ({face.area:.4g} mm² at {_at(face.centre)})" for face in known[:_SHOWN]]
    listed = ", ".join(told + ["..."] * (len(known) > _SHOWN))
    raise CaseError(
        f"faces.{point}: the part has no flat face '{name}'; its flat faces are {listed or 'none'}, and curved ones "
        "take loads at a point on them"
    )


def _at(place: Vector) -> str:
    return f"({', '.join(f'{round(value, 3) + 0.0:g}' for value in place)})"


def _placed(face: Face, turn: Real, shift: Real) -> FlatFace:
    normal = turn @ np.asarray(face.normal)
    normal[np.abs(normal) < ROUNDED] = 0.0
    x, y, z = (turn @ np.asarray(face.centre) + shift).tolist()
    a, b, c = (normal / np.linalg.norm(normal)).tolist()
    level = 0.0 if abs(z) < ROUNDED * math.sqrt(face.area) else z
    return FlatFace(centre=(x, y, level), normal=(a, b, c), area=face.area)
