"""What is meshed of a solid, whole or half, and the kernel's measures that the mesh is checked against.

A body that is symmetric about z = 0 is cut there, and its upper half meshed. Lengths are in the solid's unit. Runs in a
child process only (see ``alula.geometry.meshing.mesh``).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import Body, patch_span
from alula.geometry.bodies.features import PlainEnd
from alula.geometry.bodies.kernel import ON_SURFACE
from alula.geometry.solids.patches import patch_faces, pieces_of_face
from alula.geometry.solids.solid_model import Solid

SAME = 1e-3
"""Distance of two centroids, and relative difference of two areas or volumes, up to which a face and the image of
another are the same: a ten-thousandth of the section. The kernel's integrals are good to some 1e-5."""


@dataclass(frozen=True, kw_only=True)
class MeshTarget:
    """What is meshed.

    Attributes
    ----------
    solid : Solid
        The body, in whose unit all is.
    tag : int
        Tag of what is meshed: that solid, or its upper half.
    cut : list of int
        Tags of its faces at z = 0 where it is the upper half; empty for the whole.
    areas : dict of int to float
        Areas of its other faces by tag.
    surfaces : dict of str to list of int
        Tags of the faces of each named surface.
    volume : float
        Its volume.
    centroid : ndarray
        Its centroid (3,).
    """

    solid: Solid
    tag: int
    cut: list[int]
    areas: dict[int, float]
    surfaces: dict[str, list[int]]
    volume: float
    centroid: NDArray[np.float64]

    @property
    def half(self) -> bool:
        """Whether the upper half is meshed."""
        return bool(self.cut)


def mesh_target(gmsh: Any, solid: Solid, *, halves: bool) -> MeshTarget:
    """Return what is to be meshed of a solid.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid alone in its present model.
    solid : Solid
        The solid.
    halves : bool
        Whether the upper half will do where the solid is symmetric.

    Returns
    -------
    MeshTarget
        Half of a symmetric solid, otherwise the whole.

    Raises
    ------
    CannotRunError
        Where a surface is missing.
    """
    occ, body = gmsh.model.occ, solid.body
    areas = _areas(gmsh, solid.tag)
    volume, centroid = occ.getMass(3, solid.tag), np.asarray(occ.getCenterOfMass(3, solid.tag))
    halves = halves and abs(centroid[2]) < SAME and all(_is_own_image(end) for end in body.ends)
    half = _upper_half(gmsh, solid, areas) if halves else None
    if half is None:
        surfaces = _surfaces(gmsh, body, areas, ("bore", "top", "bottom"))
        return MeshTarget(
            solid=solid, tag=solid.tag, cut=[], areas=areas, surfaces=surfaces, volume=volume, centroid=centroid
        )
    areas = _areas(gmsh, half)
    cut = [face for face in areas if _on_plane(gmsh, face)]
    for face in cut:
        del areas[face]
    surfaces = _surfaces(gmsh, body, areas, ("bore", "top"))
    return MeshTarget(
        solid=solid, tag=half, cut=cut, areas=areas, surfaces=surfaces, volume=volume / 2.0, centroid=centroid
    )


def _is_own_image(end: PlainEnd) -> bool:
    """Return whether the load of an end is on both sides of z = 0 alike: not on a single face elsewhere."""
    return end.face is None or end.face.centre[2] == end.face.normal[2] == 0.0


def _areas(gmsh: Any, tag: int) -> dict[int, float]:
    faces = [face for _, face in gmsh.model.getBoundary([(3, tag)], oriented=False)]
    return {face: gmsh.model.occ.getMass(2, face) for face in faces}


def _upper_half(gmsh: Any, solid: Solid, areas: dict[int, float]) -> int | None:
    """Cut a copy of a solid at z = 0 and return the tag of its upper half; None where the solid is not symmetric."""
    occ = gmsh.model.occ
    if not _symmetric(gmsh, areas):
        return None
    low, high = np.reshape(gmsh.model.getBoundingBox(3, solid.tag), (2, 3))
    margin = high - low
    box = occ.addBox(*(low - margin)[:2], 0.0, *(3.0 * margin[:2]), 2.0 * margin[2])
    try:
        pieces, _ = occ.intersect(occ.copy([(3, solid.tag)]), [(3, box)])
    except Exception:  # the kernel's own
        return None
    occ.synchronize()
    halved = sum(area for dim, tag in pieces for face, area in _areas(gmsh, tag).items() if not _on_plane(gmsh, face))
    if len(pieces) == 1 and abs(2.0 * halved - sum(areas.values())) < SAME * halved:
        return int(pieces[0][1])
    occ.remove(pieces, recursive=True)
    occ.synchronize()
    return None


def _symmetric(gmsh: Any, areas: dict[int, float]) -> bool:
    """Return whether each face has one of the same area whose centroid is the image of its own."""
    centres = np.array([gmsh.model.occ.getCenterOfMass(2, face) for face in areas])
    sizes = np.array(list(areas.values()))
    reach = SAME * (1.0 + 1e-3 * np.abs(centres).max())
    distances = np.linalg.norm(centres[:, None] - centres * (1.0, 1.0, -1.0), axis=2)
    alike = (distances < reach) & (np.abs(sizes[:, None] - sizes) < SAME * sizes)
    return bool(alike.any(axis=1).all())


def _on_plane(gmsh: Any, face: int) -> bool:
    return bool(np.abs(_points_on_face(gmsh, face)[:, 2]).max() < ON_SURFACE)


def _points_on_face(gmsh: Any, tag: int) -> NDArray[np.float64]:
    """Return points (n, 3) of the surface that carries a face (they may lie outside its borders)."""
    low, high = gmsh.model.getParametrizationBounds(2, tag)
    at = np.array([[a, b] for a in (0.1, 0.45, 0.8) for b in (0.2, 0.6, 0.9)])
    uv = np.asarray(low) + at * (np.asarray(high) - np.asarray(low))
    return np.asarray(gmsh.model.getValue(2, tag, uv.ravel())).reshape(-1, 3)


def _surfaces(gmsh: Any, body: Body, tags: Iterable[int], kinds: tuple[str, ...]) -> dict[str, list[int]]:
    """Return those of some faces that make up each named surface."""
    flat_rings = [pin for pin in body.pins if body.ring(pin).diameter > 0.0]
    names = [f"{kind}:{pin.name}" for pin in body.pins for kind in kinds if kind == "bore" or pin in flat_rings]
    faces: dict[str, list[int]] = {name: [] for name in names + [f"end:{end.name}" for end in body.ends]}
    for tag in tags:
        points, box = _points_on_face(gmsh, tag), gmsh.model.getBoundingBox(2, tag)
        centre = np.add(box[:3], box[3:]) / 2.0
        flat = gmsh.model.getType(2, tag) == "Plane"
        for pin in sorted(flat_rings, key=lambda p: float(p.distance(centre[0], centre[1])))[:1]:
            # The middle of a large face with a hole may lie in an eye as well, but not its borders.
            corners = (max(float(pin.distance(x, pin.y)) for x in box[0::3]), max(abs(y - pin.y) for y in box[1::3]))
            off = max(float(pin.distance(centre[0], centre[1])), *(corner - 1e-3 for corner in corners))
            ring = body.ring(pin)
            for side, height in (("top", ring.high), ("bottom", ring.low)):
                if (
                    side in kinds
                    and flat
                    and np.abs(points[:, 2] - height).max() < ON_SURFACE
                    and off < body.part.flat_diameter(body, pin) / 2.0
                ):
                    faces[f"{side}:{pin.name}"].append(tag)
        for pin in body.pins:
            distance = pin.distance(points[:, 0], points[:, 1])
            if (pin.slot > 0.0 or not flat) and np.abs(distance - pin.diameter / 2.0).max() < ON_SURFACE:
                faces[f"bore:{pin.name}"].append(tag)
        for end in () if body.part.patches_anywhere else body.ends:
            low, high = patch_span(body, end)
            if low < centre[0] < high and _on_outside(body, points):
                faces[f"end:{end.name}"].append(tag)
    for end in body.ends if body.part.patches_anywhere else ():
        faces[f"end:{end.name}"] = (
            patch_faces(gmsh, tags, end, body.part.patch_height)
            if end.face is None
            else pieces_of_face(gmsh, tags, body, end.face)
        )
    for name, tags in faces.items():
        if not tags:
            raise CannotRunError(f"the part came out without surface '{name}'; change its dimensions a little")
    return faces


def _on_outside(body: Body, points: NDArray[np.float64]) -> bool:
    """Return whether a face belongs to the outer surface of a round part, or to the four sides of a flat one.

    The top of an arm lies in the plane of the bar's, but beyond its width.
    """
    section = body.part.section
    if section.round:
        return bool(np.abs(np.hypot(points[:, 1], points[:, 2]) - section.half_y).max() < ON_SURFACE)
    beyond = np.abs(points[:, 1]) - [body.part.half_width(body, x) for x in points[:, 0]]
    on_side = np.abs(beyond).max() < ON_SURFACE and np.ptp(np.sign(points[:, 1])) == 0.0
    on_face = abs(abs(points[:, 2].mean()) - section.half_z) < ON_SURFACE > np.ptp(points[:, 2])
    return bool(on_side or (on_face and beyond.max() < ON_SURFACE))
