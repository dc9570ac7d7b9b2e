"""Stress plots of links: the stress that decides on the deformed shape, and a close view of the hottest spot.

The bodies are rendered in a child process (``figures_worker.py``), since the graphics library can crash
where no display or no software renderer is to be had; then the pictures are left out with one warning.
Scales, labels and the colour bar are drawn around the renderings by matplotlib.
"""

import json
import math
import subprocess
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.outcomes.result import LinkResult, SolidResult
from fea.refine.discretisation import Discretisation, Status
from fea.solid.stress import StressField
from geometry.base import child
from geometry.parts.material import stress_measure
from geometry.parts.part import Section
from reports.figures.drawings import DPI, INK, STYLE, WIDTH, as_png
from reports.figures.labels import heights, stacked, write_stacked
from reports.words.wording import fixed, number, plain

Real = NDArray[np.float64]
Int = NDArray[np.int64]

TIME_LIMIT = 180.0
"""Seconds for the renderings of one check."""
COLOUR_MAP = "YlOrRd"
STATUS_NOTES: dict[Status, str] = {
    "singular": "singular at a sharp edge",
    "edge": "a sharp edge may be singular",
    "growing": "still growing with every mesh",
    "unresolved": "the mesh is too coarse",
}
"""Why a link's largest stress is no result, by the state of its meshes."""
_STRIP_WIDTH = 2200
_CLOSE_SIZE = 880
_WORKERS = 2
"""Children that render at the same time."""
_TOWARD = np.array([0.0, -0.42, 0.91]) / np.hypot(0.42, 0.91)
"""From where a link is looked at: pins point at the viewer, tilted so that its side shows."""
_VISIBLE_SHIFT = 0.08
"""Largest displacement in the picture as a share of the link's length."""
_CORNERS_AND_EDGES = ((0, 4, 6, 7), (1, 5, 4, 8), (2, 6, 5, 9), (3, 7, 9, 8), (4, 9, 5, 6), (4, 9, 6, 7), (4, 9, 7, 8),
                      (4, 9, 8, 5))  # fmt: skip
"""A quadratic tetrahedron as eight linear ones through its nodes."""


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """A parallel projection: right, up and toward the viewer (3,), what is in the middle, and how much of it.

    half_width, half_height  [mm]; ``size`` in pixels; ``cut`` the height z [mm] above which the body is cut away
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
        """Where points (..., 3) appear, as shares of width (from the left) and height (from below)."""
        arm = points - self.focus
        return np.stack(
            [0.5 + arm @ self.right / (2.0 * self.half_width), 0.5 + arm @ self.up / (2.0 * self.half_height)], axis=-1
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """What the plot of one link shows, in its frame: surface, stress, deformation and two views.

    points, displacement  (n, 3) nodes and their displacements [mm]
    values                (n,) the stress that decides [MPa], called ``measure``
    triangles             (k, 3) of the surface
    cells                 (m, 4) tetrahedra near the hottest node
    hottest               number of the hottest node
    top                   upper end of the colours [MPa]
    doubt                 why the largest stress is no result, in a few words; "" where it is one
    scale                 factor on the displacements in the picture
    far_side              True where the body hides the hottest node in the strip view
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


def stress_plots(
    links: Mapping[str, LinkResult], points: Mapping[str, Mapping[str, float]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Return a PNG for every link that ran as a solid, and what to warn of.

    points   link -> name -> x of its pins and load points [mm], to be named in the picture

    No picture is worth failing for: where rendering fails there are fewer pictures and one warning.
    """
    scenes = {name: scene_of(link) for name, link in links.items() if isinstance(link, SolidResult)}
    return plots_of(scenes, points, time_limit=time_limit)


def plots_of(
    scenes: Mapping[str, Scene], points: Mapping[str, Mapping[str, float]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Return a PNG for every scene by name, and what to warn of; ``points`` as for ``stress_plots``."""
    if not scenes:
        return {}, ()
    renderings: dict[str, tuple[Real, Real]] = {}
    try:
        renderings, trouble = _rendered(scenes, time_limit)
    except OSError as error:  # the disk of temporary files is full, or may not be written
        trouble = f"rendering had no room for its files ({error.strerror or error})"
    found = {
        name: _composed(scene, *renderings[name], points[name]) for name, scene in scenes.items() if name in renderings
    }
    missing = [name for name in scenes if name not in found]
    return found, (f"no stress plot of {', '.join(missing)}: {trouble}",) if missing else ()


def scene_of(link: SolidResult) -> Scene:
    """Prepare the plot of a link that ran as a solid."""
    displacement, section = link.governing_case.displacement, link.beam.section
    return scene_from(link.stress, displacement, link.discretisation, section, brittle=link.brittle)


def scene_from(
    stress: StressField, displacement: Real, meshes: Discretisation | None, section: Section, *, brittle: bool
) -> Scene:
    """Prepare the plot of a stress field with its displacements (n, 3) [mm].

    section  of the link, by whose size the close view is chosen: arms and eyes would make it as large as the link
    brittle  True where the largest principal stress decides
    meshes   what is known of its error. A singular peak does not set the colours: their upper end is the largest
             stress at a distance from sharp edges.
    """
    doubt = "" if meshes is None else STATUS_NOTES.get(meshes.status, "")
    space, values = stress.space, stress.decisive(brittle=brittle)
    faces = space.boundary
    triangles = faces if faces.shape[1] == 3 else faces[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    length = float(np.ptp(space.nodes[:, 0]))
    largest = float(np.linalg.norm(displacement, axis=1).max())
    scale = round_scale(_VISIBLE_SHIFT * length / largest) if largest > 0.0 else 1.0
    hottest = int(np.argmax(values))
    reach = 0.65 * min(2.0 * max(section.half_y, section.half_z), float(np.ptp(space.nodes[:, 1:], axis=0).max()))
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
        strip=_strip_view(np.vstack([space.nodes, space.nodes + scale * displacement])),
        close=_close_view(space.nodes, triangles, hottest, reach),
    )


def round_scale(value: float) -> float:
    """Largest 1, 2 or 5 times a power of ten not above a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-9)))


def _axes_of(toward: Real) -> tuple[Real, Real]:
    """Right and up (3,) of a view, the link's axis pointing right if it can."""
    axis = np.array([1.0, 0.0, 0.0]) if abs(toward[0]) < 0.95 else np.array([0.0, 1.0, 0.0])
    right = axis - (axis @ toward) * toward
    right /= np.linalg.norm(right)
    return right, np.cross(toward, right)


def _strip_view(points: Real) -> View:
    right, up = _axes_of(_TOWARD)
    u, v = points @ right, points @ up
    middle = (u.min() + u.max()) / 2.0 * right + (v.min() + v.max()) / 2.0 * up
    # A link as tall as long, such as a disc, stands in the middle of a picture half as tall as wide.
    half_width = max(0.515 * float(np.ptp(u)), 2.0 * 0.54 * float(np.ptp(v)))
    half_height = max(0.54 * float(np.ptp(v)), half_width / 16.0)
    size = (_STRIP_WIDTH, round(_STRIP_WIDTH * half_height / half_width))
    return View(right=right, up=up, toward=_TOWARD, focus=middle, half_width=half_width,
                half_height=half_height, size=size, cut=None)  # fmt: skip


def _close_view(points: Real, triangles: Int, hottest: int, reach: float) -> View:
    """Look at the hottest node from where nothing stands before it; cut the body open if there is no such place."""
    toward = _free_direction(points, triangles, hottest, reach)
    cut = None if toward is not None else float(points[hottest, 2])
    toward = _TOWARD if toward is None else toward
    right, up = _axes_of(toward)
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
        if facing[i] > 0.25 and not _hits(start, directions[i], a, ab, ac):
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
    return bool(facing.any()) and not _hits(start, toward, a[others], (b - a)[others], (c - a)[others])


def _hits(start: Real, direction: Real, a: Real, ab: Real, ac: Real) -> bool:
    """Return True if a ray meets a triangle (Möller & Trumbore, J. Graphics Tools 2 (1997) 21-28)."""
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


def _limits(scene: Scene) -> tuple[float, float]:
    return 0.0, scene.top if scene.top > 0.0 else 1.0


def _rendered(scenes: Mapping[str, Scene], time_limit: float) -> tuple[dict[str, tuple[Real, Real]], str]:
    """Render both views of every scene; returns the images that came out, and what went wrong with the others."""
    trouble = ""
    with tempfile.TemporaryDirectory(prefix="alula-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        views = {}
        for i, scene in enumerate(scenes.values()):
            for kind, view, points, outline in (
                ("strip", scene.strip, scene.deformed, scene.points),
                ("close", scene.close, scene.points, np.zeros((0, 3))),
            ):
                np.savez(
                    folder / f"{kind}{i}.npz",
                    points=points,
                    outline=outline,
                    triangles=scene.triangles,
                    values=scene.values,
                    cells=scene.cells,
                )
                views[f"{kind}{i}"] = {
                    "arrays": f"{kind}{i}.npz",
                    "size": view.size,
                    "focus": view.focus.tolist(),
                    "toward": view.toward.tolist(),
                    "up": view.up.tolist(),
                    "half_height": view.half_height,
                    "limits": _limits(scene),
                    "colours": COLOUR_MAP,
                    "cut": view.cut,
                }
        # Software rendering first: it gives the same picture with and without a display.
        choices: tuple[dict[str, str], ...] = ({"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"}, {})
        for choice in choices:
            left = {key: view for key, view in views.items() if not (folder / f"{key}.npy").exists()}
            shares = [dict(list(left.items())[i::_WORKERS]) for i in range(_WORKERS)]

            def run(share: dict[str, Any], choice: dict[str, str] = choice) -> str:
                return _run_worker(folder, share, choice, time_limit)

            with ThreadPoolExecutor(max_workers=_WORKERS) as pool:
                troubles = list(pool.map(run, filter(None, shares)))
            trouble = next(filter(None, troubles), "")
            if not trouble:
                break
        found = {}
        for i, scene_name in enumerate(scenes):
            pair = [folder / f"{kind}{i}.npy" for kind in ("strip", "close")]
            if all(path.exists() for path in pair):
                found[scene_name] = (np.load(pair[0]), np.load(pair[1]))
    return found, trouble


def _command(folder: Path) -> list[str]:
    return child.module_command("reports.figures.figures_worker", str(folder))


def _run_worker(folder: Path, views: dict[str, Any], choice: dict[str, str], time_limit: float) -> str:
    """Run a child on some of the views; returns what went wrong, or nothing."""
    request = f"{next(iter(views))}.json"
    try:
        (folder / request).write_text(json.dumps(views), encoding="utf-8")
        environment = child.environment(PYVISTA_OFF_SCREEN="true", **choice)
        status, told = child.run([*_command(folder), request], environment=environment, time_limit=time_limit)
    except subprocess.TimeoutExpired:
        return f"rendering was stopped after {time_limit:g} s"
    except OSError as error:
        return f"rendering could not be started ({error.strerror})"
    if status < 0:
        return f"rendering crashed (signal {-status}); check that the system libraries in the README are there"
    return f"rendering failed ({told})" if status else ""


def _composed(scene: Scene, strip: Any, close: Any, points: Mapping[str, float]) -> bytes:
    """Put both renderings, the colour bar and the labels on one sheet."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    low, high = _limits(scene)
    with rc_context(STYLE):
        side, margin, below, gap = 2.9, 0.1, 0.1, 0.5  # inches
        wide = WIDTH - 2.0 * margin
        shares = scene.strip.share(np.array([[x, 0.0, 0.0] for x in points.values()]).reshape(-1, 3))[:, 0]
        names = stacked(points, wide * shares)
        top = 0.17 + heights(names)
        tall = wide * scene.strip.half_height / scene.strip.half_width
        height = top + tall + gap + side + below
        figure = Figure(figsize=(WIDTH, height), dpi=DPI)
        FigureCanvasAgg(figure)

        def box(left: float, bottom: float, width: float, tallness: float) -> Any:
            return figure.add_axes((left / WIDTH, bottom / height, width / WIDTH, tallness / height))

        upper = box(margin, below + side + gap, wide, tall)
        upper.imshow(strip, extent=(0, 1, 0, 1), aspect="auto", interpolation="lanczos")
        write_stacked(upper, names, wide)
        _scale_bar(upper, scene.strip, wide, below_image=True)
        lower = box(margin, below, side, side)
        lower.imshow(close, extent=(0, 1, 0, 1), aspect="auto", interpolation="lanczos")
        _scale_bar(lower, scene.close, side, below_image=False)
        lower.set_title(
            "around the largest stress" + ("" if scene.close.cut is None else ", cut open"), fontsize=8.5, pad=4.0
        )
        for axes, view, spots in ((upper, scene.strip, scene.deformed), (lower, scene.close, scene.points)):
            at = view.share(spots[scene.hottest])
            faint = 0.45 if axes is upper and scene.far_side else 1.0
            for colour, width in (("white", 3.0), (INK, 1.2)):
                axes.plot(*at, marker="o", markersize=11.0, markerfacecolor="none", markeredgecolor=colour,
                          markeredgewidth=width, alpha=faint, clip_on=False)  # fmt: skip
            axes.set_xlim(0.0, 1.0)
            axes.set_ylim(0.0, 1.0)
            axes.set_xticks([])
            axes.set_yticks([])
            axes.spines[:].set_visible(axes is lower)
        bar = figure.add_axes(((margin + side + 0.55) / WIDTH, (below + side - 0.45) / height,
                               (WIDTH - margin - side - 1.0) / WIDTH, 0.17 / height))  # fmt: skip
        legend = figure.colorbar(
            ScalarMappable(norm=Normalize(low, high), cmap=COLOUR_MAP),
            cax=bar,
            orientation="horizontal",
            extend="max" if scene.top < scene.values.max() else "neither",
        )
        legend.set_label(f"{scene.measure} [MPa]")
        legend.outline.set_linewidth(0.6)
        largest = float(np.linalg.norm(scene.displacement, axis=1).max())
        figure.text(
            (margin + side + 0.55) / WIDTH,
            (below + side - 1.1) / height,
            "\n".join(
                (
                    *peak_lines(scene),
                    "    (faint above: on the far side)\n" if scene.far_side else "",
                    f"upper picture: deformed, × {plain(scene.scale)}",
                    f"    largest displacement {number(largest, 3)} mm",
                    "    grey line: undeformed",
                    "lower picture: undeformed",
                )
            ),
            va="top",
            linespacing=1.45,
        )
        return as_png(figure)


def peak_lines(scene: Scene) -> tuple[str, ...]:
    """What the picture says of the largest stress: its value and place, or why there is no value."""
    x, y, z = (_place(value) for value in scene.points[scene.hottest])
    place = f"    at x = {x}, y = {y}, z = {z} mm"
    if not scene.doubt:
        return (f"largest: {number(float(scene.values.max()))} MPa (circles)", place)
    found = [f"largest: no result, {scene.doubt}", f"{place} (circles)"]
    if scene.top < scene.values.max():
        found.append("    colours end at the screening stress")
    return tuple(found)


def _place(value: float) -> str:
    return fixed(float(value), 1)


def _scale_bar(axes: Any, view: View, wide: float, *, below_image: bool) -> None:
    from matplotlib.patheffects import withStroke

    length = round_scale(0.45 * view.half_width)
    share = length / (2.0 * view.half_width)
    y = 0.04 if not below_image else -0.08 / (wide * view.half_height / view.half_width)
    left = 0.04 if not below_image else 0.012
    axes.plot([left, left + share], [y, y], color=INK, linewidth=2.0, clip_on=False, solid_capstyle="butt")
    axes.annotate(
        f"{plain(length)} mm", (left + share, y), xytext=(4, 0), textcoords="offset points", va="center", fontsize=8.5,
        annotation_clip=False, path_effects=[withStroke(linewidth=2.0, foreground="white")],
    )  # fmt: skip
