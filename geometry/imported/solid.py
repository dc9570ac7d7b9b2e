"""The one solid of a STEP file, in the geometry kernel.

Runs in the kernel's child process only. Lengths are in mm, whatever the unit of the file.
"""

import os
from typing import Any

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.bores import find_bores, in_order
from alula.geometry.imported.facts import Face, PartFacts, PartSurface, Vector
from alula.geometry.imported.walls import walls_of

_TRIANGLE = 2
"""gmsh's number of this shape."""
_SHOWN = 4
"""Solids whose sizes are named at most."""


def import_solid(gmsh: Any, path: str) -> int:
    """Read a STEP file into the present model of the kernel, which is empty.

    Parameters
    ----------
    gmsh : module
        gmsh, initialised to read in mm.
    path : str
        The file.

    Returns
    -------
    int
        Tag of its solid.

    Raises
    ------
    CaseError
        Where the file cannot be read, or holds another number of solids than one.
    """
    occ, name = gmsh.model.occ, os.path.basename(path)
    try:
        with open(path, "rb") as stream:  # gmsh takes names in UTF-8 alone, and a path need not be
            found = occ.importShapes(f"/dev/fd/{stream.fileno()}", highestDimOnly=True, format="step")
    except OSError as error:
        raise CaseError(f"'{name}' cannot be read ({error.strerror})") from None
    except Exception:  # gmsh raises bare Exceptions
        raise CaseError(f"'{name}' cannot be read as STEP by the geometry kernel; export the part anew") from None
    occ.synchronize()
    solids = [tag for dimension, tag in found if dimension == 3]
    if not solids:
        surfaces = sum(dimension == 2 for dimension, _ in found)
        what = f"only surfaces without volume ({surfaces})" if surfaces else "no solid"
        raise CaseError(f"'{name}' holds {what}, and a part is one solid; export the part as a closed solid")
    if len(solids) > 1:
        sizes = [_size(gmsh, tag) for tag in solids[:_SHOWN]] + ["..."] * (len(solids) > _SHOWN)
        raise CaseError(
            f"'{name}' holds {len(solids)} solids ({'; '.join(sizes)}), and a part is one solid; export each part to "
            "a file of its own, or join them in the CAD program"
        )
    if not occ.getMass(3, solids[0]) > 0.0:
        raise CaseError(f"the solid of '{name}' encloses no volume; repair it in the CAD program and export it anew")
    return int(solids[0])


def facts_of_file(gmsh: Any, path: str, digest: str) -> PartFacts:
    """Return what is found in a STEP file.

    Parameters
    ----------
    gmsh : module
        gmsh, its present model empty.
    path : str
        The file.
    digest : str
        SHA-256 of its content.

    Returns
    -------
    PartFacts
        In mm, in the frame of the file.

    Raises
    ------
    CaseError
        As ``import_solid``.
    """
    tag, occ = import_solid(gmsh, path), gmsh.model.occ
    box, inertia = gmsh.model.getBoundingBox(3, tag), occ.getMatrixOfInertia(3, tag)
    surface = surface_of(gmsh, tag)  # after the bounds, which are exact only without triangles
    return PartFacts(
        volume=float(occ.getMass(3, tag)),
        surface=float(sum(occ.getMass(2, face) for face in gmsh.model.getAdjacencies(3, tag)[1])),
        centroid=_vector(occ.getCenterOfMass(3, tag)),
        inertia=(_vector(inertia[:3]), _vector(inertia[3:6]), _vector(inertia[6:])),
        low=_vector(box[:3]),
        high=_vector(box[3:]),
        bores=find_bores(walls_of(gmsh, tag, surface), surface, np.reshape(box, (2, 3))),
        faces=_flat_faces(gmsh, tag, surface, np.reshape(box, (2, 3))),
        digest=digest,
    )


def _flat_faces(gmsh: Any, solid: int, surface: PartSurface, box: Any) -> tuple[Face, ...]:
    """Return the flat faces of a solid; on which side of them the material is, the triangles of its surface tell."""
    occ, found = gmsh.model.occ, []
    for tag in map(int, gmsh.model.getAdjacencies(3, solid)[1]):
        if gmsh.model.getType(2, tag) == "Plane":
            a, b, c = np.moveaxis(surface.points[surface.triangles[surface.faces == tag]], 1, 0)
            normal = np.reshape(gmsh.model.getNormal(tag, [0.0, 0.0]), 3)
            outward = normal * (1.0 if np.cross(b - a, c - a).sum(axis=0) @ normal > 0.0 else -1.0)
            found.append(
                (_vector(np.round(outward, 12)), _vector(occ.getCenterOfMass(2, tag)), float(occ.getMass(2, tag)), tag)
            )
    order = in_order([(centre, area) for _, centre, area, _ in found], box)
    return tuple(
        Face(name=f"face {k}", normal=normal, centre=centre, area=area, tag=tag)
        for k, (normal, centre, area, tag) in enumerate((found[i] for i in order), start=1)
    )


def surface_of_file(gmsh: Any, path: str, digest: str) -> PartSurface:
    """Return triangles of the surface of the solid in a STEP file.

    Parameters
    ----------
    gmsh : module
        gmsh, its present model empty.
    path : str
        The file.
    digest : str
        Not needed here.

    Returns
    -------
    PartSurface
        In mm, in the frame of the file.

    Raises
    ------
    CaseError
        As ``import_solid``.
    """
    return surface_of(gmsh, import_solid(gmsh, path))


def surface_of(gmsh: Any, solid: int) -> PartSurface:
    """Return triangles of the surface of a solid.

    They are the kernel's own, which take a hundredth of the mesher's time, and chords of arcs of 0.2 rad or less.

    Parameters
    ----------
    gmsh : module
        gmsh, with the solid in its present model.
    solid : int
        Its tag.

    Returns
    -------
    PartSurface
        In the frame of the model.
    """
    mesh = gmsh.model.mesh
    gmsh.option.setNumber("Mesh.StlAngularDeflection", 0.2)
    mesh.importStl()
    points, triangles, faces, count = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], [], 0
    for face in gmsh.model.getAdjacencies(3, solid)[1]:
        corners = np.asarray(mesh.getElementsByType(_TRIANGLE, face)[1], dtype=np.int64)
        if corners.size:
            nodes, places, _ = mesh.getNodes(2, face, includeBoundary=True)
            nodes, first = np.unique(np.asarray(nodes, dtype=np.int64), return_index=True)
            points.append(np.asarray(places).reshape(-1, 3)[first])
            triangles.append(count + np.searchsorted(nodes, corners).reshape(-1, 3))
            count += len(nodes)
        faces += [int(face)] * (corners.size // 3)
    mesh.clear()
    return PartSurface(
        points=np.concatenate(points), triangles=np.concatenate(triangles), faces=np.array(faces, dtype=np.int64)
    )


def _vector(values: Any) -> Vector:
    x, y, z = map(float, values)
    return x, y, z


def _size(gmsh: Any, tag: int) -> str:
    box = gmsh.model.getBoundingBox(3, tag)
    return " x ".join(f"{high - low:.4g}" for low, high in zip(box[:3], box[3:], strict=True)) + " mm"
