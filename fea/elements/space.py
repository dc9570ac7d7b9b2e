"""The finite-element space of displacements on a link: nodes, elements and boundary in scikit-fem's numbering."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.tagged_mesh import IMAGE_ORDER, REFLECTION, TaggedMesh

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
"""Corner pairs of the mid-nodes 4 to 9 of a quadratic element."""
# Faces seen from outside a positive tetrahedron: three corners, then the mid-nodes of edges ab, bc, ac.
_FACES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
_STRAIGHT = 1e-9  # of an element's size: meshers leave up to 1e-11 of a straight edge and make curved ones of 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class DisplacementSpace:
    """Vector-valued linear (P1) or quadratic (P2, isoparametric) displacements on tetrahedra.

    Node i carries the unknowns 3i, 3i+1, 3i+2 (x, y, z); corner nodes come first, then edge nodes, as
    in scikit-fem's ``ElementVector(ElementTetP1())`` and ``ElementVector(ElementTetP2())``.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    cells : ndarray of int, shape (m, 4) or (m, 10)
        Node numbers, all of positive volume.
    corners : int
        Number of corner nodes.
    curved : ndarray of bool, shape (m,)
        True where an element is not straight-sided.
    boundary : ndarray of int, shape (b, 3) or (b, 6)
        Nodes of all boundary faces, counter-clockwise seen from outside.
    surfaces : dict of str to ndarray of int
        Name and indices of the faces in ``boundary``.
    mirror : ndarray of int or None, shape (n,)
        Number of every node's image at -z; None where the mesh has no such symmetry (``TaggedMesh.mirror``).
    """

    nodes: NDArray[np.float64]
    cells: NDArray[np.int64]
    corners: int
    curved: NDArray[np.bool_]
    boundary: NDArray[np.int64]
    surfaces: Mapping[str, NDArray[np.int64]]
    mirror: NDArray[np.int64] | None = None

    @property
    def order(self) -> int:
        """Polynomial order of the displacements: 1 or 2."""
        return 1 if self.cells.shape[1] == 4 else 2

    @property
    def unknowns(self) -> int:
        """Number of displacement components, three per node."""
        return 3 * len(self.nodes)

    @property
    def element(self) -> Any:
        """The scalar scikit-fem element of one displacement component."""
        from skfem.element import ElementTetP1, ElementTetP2

        return ElementTetP1() if self.order == 1 else ElementTetP2()

    def flat_faces(self, pin: str) -> tuple[str, ...]:
        """Return the names of the flat faces about a pin's hole, on which a torque or a thrust can enter.

        Parameters
        ----------
        pin : str
            Name of the pin.

        Returns
        -------
        tuple of str
            Of both surfaces; empty where the part has no flat ring there.
        """
        return tuple(name for name in (f"top:{pin}", f"bottom:{pin}") if name in self.surfaces)

    def faces(self, *names: str) -> NDArray[np.int64]:
        """Return the nodes of the boundary faces of the named surfaces together.

        Parameters
        ----------
        *names : str
            Of surfaces.

        Returns
        -------
        ndarray of int, shape (k, 3) or (k, 6)
            Nodes.

        Raises
        ------
        CannotRunError
            For a surface that the mesh does not have.
        """
        for name in names:
            if name not in self.surfaces:
                raise CannotRunError(f"the mesh has no surface '{name}'; it has {', '.join(sorted(self.surfaces))}")
        return np.asarray(self.boundary[np.concatenate([self.surfaces[name] for name in names])])


@dataclass(frozen=True, kw_only=True, eq=False)
class UpperHalf:
    """Half z ≥ 0 of a displacement space that is its own image.

    Attributes
    ----------
    space : DisplacementSpace
        Of the half; its boundary is that of the whole, without the plane z = 0.
    nodes, images : ndarray of int, shape (h,)
        Numbers, in the whole, of its nodes and of their images; the same on the plane z = 0.
    """

    space: DisplacementSpace
    nodes: NDArray[np.int64]
    images: NDArray[np.int64]

    @property
    def on_plane(self) -> NDArray[np.bool_]:
        """True (h,) for the nodes on the plane z = 0."""
        return np.asarray(self.nodes == self.images)

    def parts(self, field: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Split a vector field into the part that is its own image and the one that is minus its image.

        Parameters
        ----------
        field : ndarray, shape (n, 3, k)
            At the nodes of the whole.

        Returns
        -------
        tuple of 2 ndarray
            The symmetric and the antisymmetric part (h, 3, k) at the nodes of the half.
        """
        upper, image = field[self.nodes], field[self.images] * REFLECTION[:, None]
        return (upper + image) / 2.0, (upper - image) / 2.0

    def whole(self, symmetric: NDArray[np.float64], antisymmetric: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the field of which these are the ``parts``.

        Parameters
        ----------
        symmetric, antisymmetric : ndarray, shape (h, 3, k)
            At the nodes of the half.

        Returns
        -------
        ndarray, shape (n, 3, k)
            At the nodes of the whole.
        """
        count = 2 * len(self.nodes) - np.count_nonzero(self.on_plane)
        field = np.empty((count, *symmetric.shape[1:]))
        field[self.images] = (symmetric - antisymmetric) * REFLECTION[:, None]
        field[self.nodes] = symmetric + antisymmetric
        return field

    def both_nodes(self, values: NDArray[np.float64], images: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Return the values at all nodes from those at the nodes of the half and at their images.

        Parameters
        ----------
        values : ndarray, shape (h,)
            At the nodes of the half.
        images : ndarray, shape (h,), optional
            At their images; by default the same.

        Returns
        -------
        ndarray, shape (n,)
            At the nodes of the whole.
        """
        found = np.empty(2 * len(values) - np.count_nonzero(self.on_plane))
        found[self.images] = values if images is None else images
        found[self.nodes] = values
        return found


def upper_half(space: DisplacementSpace) -> UpperHalf | None:
    """Return the half z ≥ 0 of a space.

    Parameters
    ----------
    space : DisplacementSpace
        Displacement space of the link.

    Returns
    -------
    UpperHalf or None
        None where the space is not its own image.
    """
    if space.mirror is None:
        return None
    elements = len(space.cells) // 2
    nodes = np.unique(space.cells[:elements])
    number = np.full(len(space.nodes), -1)
    number[nodes] = np.arange(len(nodes))
    inside = number[space.boundary].min(axis=1) >= 0
    place = np.cumsum(inside) - 1
    half = DisplacementSpace(
        nodes=space.nodes[nodes],
        cells=number[space.cells[:elements]],
        corners=int(np.searchsorted(nodes, space.corners)),
        curved=space.curved[:elements],
        boundary=number[space.boundary[inside]],
        surfaces={name: place[faces[inside[faces]]] for name, faces in space.surfaces.items()},
    )
    return UpperHalf(space=half, nodes=nodes, images=space.mirror[nodes])


def displacement_space(mesh: TaggedMesh, *, order: int = 2) -> DisplacementSpace:
    """Build the space of displacements on a mesh.

    Parameters
    ----------
    mesh : TaggedMesh
        Of the link.
    order : int, optional
        Of the displacements; linear ones (1) take the corner nodes alone.

    Returns
    -------
    DisplacementSpace
        Nodes, elements and boundary.

    Raises
    ------
    CannotRunError
        For an element without positive volume, or a tagged triangle that is no boundary face.
    """
    used, corner = np.unique(mesh.cells[:, :4], return_inverse=True)
    corner = corner.reshape(-1, 4)
    points = mesh.points[used]
    from_point = np.full(len(mesh.points), -1)
    from_point[used] = np.arange(len(used))
    if order == 1:
        nodes, cells = points, corner
    else:
        cells = np.hstack([corner, len(points) + _edge_numbers(corner)])
        nodes = np.empty((int(cells.max()) + 1, 3))
        nodes[: len(points)] = points
        if mesh.curved:
            nodes[cells[:, 4:]] = mesh.points[mesh.cells[:, 4:]]
            from_point[mesh.cells[:, 4:]] = cells[:, 4:]
        else:
            for local, (a, b) in enumerate(EDGES):
                nodes[cells[:, 4 + local]] = (points[corner[:, a]] + points[corner[:, b]]) / 2.0

    spans = nodes[cells[:, 1:4]] - nodes[cells[:, :1]]
    volume = np.linalg.det(spans)
    size = np.abs(spans).max(axis=(1, 2))
    if (np.abs(volume) <= 1e-12 * size**3).any():
        raise CannotRunError(f"{np.count_nonzero(np.abs(volume) <= 1e-12 * size**3)} elements of the mesh are flat")
    cells[volume < 0.0] = cells[volume < 0.0][:, IMAGE_ORDER[: cells.shape[1]]]
    curved = np.zeros(len(cells), dtype=np.bool_)
    if order == 2:
        ends = nodes[cells[:, np.array(EDGES)]]
        middle = ends.mean(axis=2)
        curved = np.abs(nodes[cells[:, 4:]] - middle).max(axis=(1, 2)) > _STRAIGHT * size
        nodes[cells[~curved, 4:]] = middle[~curved]
    boundary = _boundary(cells)
    return DisplacementSpace(
        nodes=nodes,
        cells=cells,
        corners=len(used),
        curved=curved,
        boundary=boundary,
        surfaces=_named(boundary, {name: from_point[t] for name, t in mesh.surfaces.items()}, len(used)),
        mirror=None if mesh.mirror is None else _images(cells),
    )


def _edge_numbers(corner: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the numbers (m, 6) of the elements' edges, in the order of their corners."""
    ends = np.sort(corner[:, EDGES], axis=2)
    _, number = np.unique(ends[..., 0] * (int(corner.max()) + 1) + ends[..., 1], return_inverse=True)
    return np.asarray(number).reshape(-1, len(EDGES))


def _images(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the images of all nodes where the second half of the elements holds those of the first."""
    upper, lower = np.array_split(cells, 2)
    swapped = lower[:, IMAGE_ORDER[: cells.shape[1]]]
    found = np.empty(int(cells.max()) + 1, dtype=np.int64)
    found[upper], found[swapped] = swapped, upper
    return found


def _keys(triangles: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    low, middle, high = np.sort(triangles[:, :3], axis=1).T
    return np.asarray((low * count + middle) * count + high)


def _boundary(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the faces that belong to one element alone, seen from outside."""
    local = _FACES[:, : 3 if cells.shape[1] == 4 else 6]
    faces = cells[:, local].reshape(-1, local.shape[1])
    _, first, count = np.unique(_keys(faces, int(cells[:, :4].max()) + 1), return_index=True, return_counts=True)
    return np.asarray(faces[np.sort(first[count == 1])])


def _named(
    boundary: NDArray[np.int64], surfaces: Mapping[str, NDArray[np.int64]], corners: int
) -> dict[str, NDArray[np.int64]]:
    """Find every tagged triangle among the boundary faces."""
    keys = _keys(boundary, corners)
    order = np.argsort(keys)
    found = {}
    for name, triangles in surfaces.items():
        wanted = _keys(triangles, corners)
        place = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
        if (triangles < 0).any() or not np.array_equal(keys[place], wanted):
            raise CannotRunError(f"surface '{name}' holds triangles that are no boundary faces of the mesh")
        found[name] = place
    return found
