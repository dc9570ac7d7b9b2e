"""Geometry of a link's stress plot: its surface, deformation and two views."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import SolidResult
from alula.fea.refine.discretisation import Discretisation, MeshStatus
from alula.fea.solid.stress import StressField
from alula.geometry.materials.material import stress_measure
from alula.geometry.parts.part import Section
from alula.reports.figures.sheet.style import DPI, WIDTH

Real = NDArray[np.float64]
Int = NDArray[np.int64]

STATUS_NOTES: dict[MeshStatus, str] = {
    "singular": "singular at a sharp edge",
    "edge": "a sharp edge may be singular",
    "growing": "still growing with every mesh",
    "unresolved": "the mesh is too coarse",
}
"""Why a link's largest stress is no result, by the state of its meshes."""
MARGIN, SIDE = 7.2, 209.0
"""Room about the views on their sheet, and size of the close one [points]."""
_STRIP_WIDTH, _CLOSE_SIZE = (round(length * DPI / 72.0) for length in (72.0 * WIDTH - 2.0 * MARGIN, SIDE))
"""Pixels, as many as there are on the sheet: the renderer takes several samples of each."""
_TOWARD = np.array([0.0, -0.42, 0.91]) / np.hypot(0.42, 0.91)
"""From where a link is looked at: pins point at the viewer, tilted so that its side shows."""
_VISIBLE_SHIFT = 0.08
"""Largest displacement in the picture as a share of the link's length."""
_CORNERS_AND_EDGES = ((0, 4, 6, 7), (1, 5, 4, 8), (2, 6, 5, 9), (3, 7, 9, 8), (4, 9, 5, 6), (4, 9, 6, 7), (4, 9, 7, 8),
                      (4, 9, 8, 5))  # fmt: skip
"""A quadratic tetrahedron as eight linear ones through its nodes."""


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """A parallel projection.

    Attributes
    ----------
    right : array
        Direction (3,) to the right of the picture.
    up : array
        Direction (3,) up.
    toward : array
        Direction (3,) towards the viewer.
    focus : array
        Point (3,) in the middle [mm].
    half_width : float
        Of what is shown [mm].
    half_height : float
        Of what is shown [mm].
    size : tuple
        Width and height in pixels.
    cut : float, optional
        Height z above which the body is cut away [mm]; None to show all of it.
    """

    right: Real
    up: Real
    toward: Real
    focus: Real
    half_width: float
    half_height: float
    size: tuple[int, int]
    cut: float | None

    def share(self, points: Real) -> Real:
        """Return where points appear in the picture.

        Parameters
        ----------
        points : array
            (..., 3).

        Returns
        -------
        array
            (..., 2), as shares of width from the left and of height from the bottom.
        """
        arm = points - self.focus
        return np.stack(
            [0.5 + arm @ self.right / (2.0 * self.half_width), 0.5 + arm @ self.up / (2.0 * self.half_height)], axis=-1
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Rendering:
    """A coloured body and how it is looked at.

    Attributes
    ----------
    view : View
    points : array
        (n, 3) [mm].
    triangles : int array
        (k, 3) of the surface.
    values : array
        (n,), which the colours show.
    limits : tuple of 2 float
        Values of the first and the last colour.
    colours : int array
        (m, 3), red, green and blue from 0 to 255.
    outline : array
        (n, 3) [mm], points of the same body at rest, whose outline is drawn; none by default.
    cells : int array
        (m, 4) tetrahedra, for a view that cuts the body open; none by default.
    """

    view: View
    points: Real
    triangles: Int
    values: Real
    limits: tuple[float, float]
    colours: NDArray[np.uint8]
    outline: Real = field(default_factory=lambda: np.zeros((0, 3)))
    cells: Int = field(default_factory=lambda: np.zeros((0, 4), dtype=np.int64))


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Surface, stress and views of the plot of one link, in the frame of the link.

    Attributes
    ----------
    points : array
        Nodes (n, 3) [mm].
    displacement : array
        (n, 3) [mm].
    values : array
        Decisive stress (n,) [MPa].
    measure : str
        Name of that stress.
    triangles : int array
        (k, 3) of the surface.
    cells : int array
        (m, 4) tetrahedra near the hottest node.
    hottest : int
        Number of the hottest node.
    top : float
        Upper end of the colours [MPa].
    doubt : str
        Why the largest stress is no result, in a few words; "" where it is one.
    scale : float
        Factor on the displacements in the picture.
    far_side : bool
        True where the body hides the hottest node in the strip view.
    strip : View
        View of the whole link.
    close : View
        View around the largest stress.
    """

    points: Real
    displacement: Real
    values: Real
    measure: str
    triangles: Int
    cells: Int
    hottest: int
    top: float
    doubt: str
    scale: float
    far_side: bool
    strip: View
    close: View

    @property
    def deformed(self) -> Real:
        """Nodes (n, 3) as drawn."""
        return self.points + self.scale * self.displacement


def scene_of(link: SolidResult) -> Scene:
    """Prepare the plot of a link that was solved as a solid.

    Parameters
    ----------
    link : SolidResult

    Returns
    -------
    Scene
    """
    displacement, section = link.governing_case.displacement, link.beam.section
    return scene_from(link.stress, displacement, link.discretisation, section, brittle=link.brittle)


def scene_from(
    stress: StressField, displacement: Real, meshes: Discretisation | None, section: Section, *, brittle: bool
) -> Scene:
    """Prepare the plot of a stress field.

    A singular peak does not set the colours: their upper end is the largest stress away from sharp edges.

    Parameters
    ----------
    stress : StressField
    displacement : array
        (n, 3) [mm].
    meshes : Discretisation, optional
        What is known of the discretisation error.
    section : Section
        Of the link; its size sets the close view.
    brittle : bool
        True where the largest principal stress decides.

    Returns
    -------
    Scene
    """
    doubt = "" if meshes is None else STATUS_NOTES.get(meshes.status, "")
    space, values = stress.space, stress.decisive(brittle=brittle)
    triangles = surface_triangles(space.boundary)
    scale = shown_scale(space.nodes, displacement)
    hottest = int(np.argmax(values))
    reach = 0.65 * min(
        2.0 * max(section.half_y, section.half_z),
        8.0 * min(section.half_y, section.half_z),
        float(np.ptp(space.nodes[:, 1:], axis=0).max()),
    )
    near = np.linalg.norm(space.nodes[space.cells[:, :4]].mean(axis=1) - space.nodes[hottest], axis=1) < 3.0 * reach
    cells = space.cells[near]
    return Scene(
        points=space.nodes,
        displacement=displacement,
        values=values,
        measure=f"{stress_measure(brittle=brittle)} stress",
        triangles=triangles,
        cells=cells if cells.shape[1] == 4 else cells[:, list(map(list, _CORNERS_AND_EDGES))].reshape(-1, 4),
        hottest=hottest,
        top=meshes.sharp.screening if doubt and meshes is not None and meshes.sharp else float(values.max()),
        doubt=doubt,
        scale=scale,
        far_side=not _seen(space.nodes, triangles, hottest, _TOWARD),
        strip=strip_view(np.vstack([space.nodes, space.nodes + scale * displacement])),
        close=_close_view(space.nodes, triangles, hottest, reach),
    )


def surface_triangles(faces: Int) -> Int:
    """Return the faces of a body as triangles.

    Parameters
    ----------
    faces : int array
        (k, 3), or (k, 6) of quadratic elements.

    Returns
    -------
    int array
        (m, 3); four of each quadratic face.
    """
    return faces if faces.shape[1] == 3 else faces[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)


def shown_scale(nodes: Real, displacement: Real) -> float:
    """Return the factor with which displacements are drawn.

    Parameters
    ----------
    nodes : array
        (n, 3) of a link in its frame [mm].
    displacement : array
        (n, 3) [mm].

    Returns
    -------
    float
    """
    largest = float(np.linalg.norm(displacement, axis=1).max())
    return round_scale(_VISIBLE_SHIFT * float(np.ptp(nodes[:, 0])) / largest) if largest > 0.0 else 1.0


def round_scale(value: float) -> float:
    """Return the largest 1, 2 or 5 times a power of ten that is not above a value.

    Parameters
    ----------
    value : float

    Returns
    -------
    float
    """
    power = 10.0 ** math.floor(math.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-9)))


def axes_of(toward: Real) -> tuple[Real, Real]:
    """Return right and up of a view, the link's axis pointing right if it can.

    Parameters
    ----------
    toward : array
        Direction (3,) towards the viewer.

    Returns
    -------
    tuple of array
        (3,) each.
    """
    axis = np.array([1.0, 0.0, 0.0]) if abs(toward[0]) < 0.95 else np.array([0.0, 1.0, 0.0])
    right = axis - (axis @ toward) * toward
    right /= np.linalg.norm(right)
    return right, np.cross(toward, right)


def strip_view(points: Real) -> View:
    """Return the view of a whole link, its pins pointing at the viewer.

    Parameters
    ----------
    points : array
        (n, 3) of all that is to be seen [mm].

    Returns
    -------
    View
    """
    right, up = axes_of(_TOWARD)
    u, v = points @ right, points @ up
    middle = (u.min() + u.max()) / 2.0 * right + (v.min() + v.max()) / 2.0 * up
    # A link as tall as long, such as a disc, stands in the middle of a picture half as tall as wide.
    half_width = max(0.515 * float(np.ptp(u)), 2.0 * 0.54 * float(np.ptp(v)))
    tall = math.ceil(_STRIP_WIDTH * max(0.54 * float(np.ptp(v)) / half_width, 1.0 / 16.0))
    return View(right=right, up=up, toward=_TOWARD, focus=middle, half_width=half_width,
                half_height=half_width * tall / _STRIP_WIDTH, size=(_STRIP_WIDTH, tall), cut=None)  # fmt: skip


def _close_view(points: Real, triangles: Int, hottest: int, reach: float) -> View:
    """Look at the hottest node from where nothing stands before it; cut the body open if there is no such place."""
    toward = _free_direction(points, triangles, hottest, reach)
    cut = None if toward is not None else float(points[hottest, 2])
    toward = _TOWARD if toward is None else toward
    right, up = axes_of(toward)
    return View(right=right, up=up, toward=toward, focus=points[hottest], half_width=reach, half_height=reach,
                size=(_CLOSE_SIZE, _CLOSE_SIZE), cut=cut)  # fmt: skip


def _free_direction(points: Real, triangles: Int, node: int, reach: float) -> Real | None:
    """Direction (3,) from which a surface node is seen at a good angle; None where there is none."""
    corners = points[triangles]
    around = (triangles == node).any(axis=1)
    if not around.any():
        return None
    near = (np.linalg.norm(corners.mean(axis=1) - points[node], axis=1) < 8.0 * reach) & ~around
    a, ab, ac = corners[near, 0], corners[near, 1] - corners[near, 0], corners[near, 2] - corners[near, 0]
    normal = np.cross(corners[around, 1] - corners[around, 0], corners[around, 2] - corners[around, 0]).sum(axis=0)
    normal /= np.linalg.norm(normal)
    k = np.arange(200) + 0.5
    height, turn = 1.0 - k / 100.0, k * math.pi * (1.0 + math.sqrt(5.0))
    round_ = np.sqrt(1.0 - height**2)
    directions = np.vstack([_TOWARD, np.column_stack([round_ * np.cos(turn), round_ * np.sin(turn), height])])
    facing = directions @ normal
    order = np.argsort(-(facing + 0.4 * (directions @ _TOWARD)))
    start = points[node] + 1e-4 * reach * normal
    for i in order:
        if facing[i] > 0.25 and not hits(start, directions[i], a, ab, ac):
            return np.asarray(directions[i])
    return None


def _seen(points: Real, triangles: Int, node: int, toward: Real) -> bool:
    """Return True if nothing stands between a surface node and a viewer far away in a direction."""
    around = (triangles == node).any(axis=1)
    if not around.any():
        return False
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    facing = np.cross(b[around] - a[around], c[around] - a[around]) @ toward > 0.0
    others = ~around
    start = points[node] + 1e-6 * float(np.ptp(points[:, 0])) * toward
    return bool(facing.any()) and not hits(start, toward, a[others], (b - a)[others], (c - a)[others])


def hits(start: Real, direction: Real, a: Real, ab: Real, ac: Real) -> bool:
    """Return True if a ray meets a triangle.

    Parameters
    ----------
    start, direction : array
        Of the ray (3,).
    a, ab, ac : array
        Corners (k, 3) of the triangles, and two sides of each from there.

    Returns
    -------
    bool

    References
    ----------
    Möller & Trumbore, J. Graphics Tools 2 (1997) 21-28.
    """
    p = np.cross(direction, ac)
    determinant = np.einsum("ij,ij->i", ab, p)
    crossing = np.abs(determinant) > 1e-14
    safe = np.where(crossing, determinant, 1.0)
    arm = start - a
    u = np.einsum("ij,ij->i", arm, p) / safe
    q = np.cross(arm, ab)
    v = q @ direction / safe
    t = np.einsum("ij,ij->i", ac, q) / safe
    return bool((crossing & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > 0.0)).any())
