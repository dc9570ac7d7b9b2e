"""Stress plots of links: the stress that decides on the deformed shape, and a close view of the hottest spot.

The bodies are rendered in a child process (``figures_worker.py``), since the graphics library can crash
where no display or no software renderer is to be had; then the pictures are left out with one warning.
Scales, labels and the colour bar are drawn around the renderings by matplotlib.
"""

import json
import subprocess
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.outcomes.result import LinkResult, SolidResult
from geometry.base import child
from reports.figures.drawings import DPI, INK, STYLE, WIDTH, as_png
from reports.figures.labels import heights, stacked, write_stacked
from reports.figures.scene import Scene, View, round_scale, scene_of
from reports.words.wording import fixed, number, plain

Real = NDArray[np.float64]

TIME_LIMIT = 180.0
"""Seconds for the renderings of one check."""
COLOUR_MAP = "YlOrRd"
_WORKERS = 2
"""Children that render at the same time."""


def stress_plots(
    links: Mapping[str, LinkResult], points: Mapping[str, Mapping[str, float]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Draw the stress of every link that was solved as a solid.

    Where rendering fails there are fewer pictures and one warning.

    Parameters
    ----------
    links : mapping
        Results by name.
    points : mapping
        Link -> name -> x of its pins and load points [mm], to be named in the picture.
    time_limit : float, optional
        Of rendering [s].

    Returns
    -------
    tuple
        Link -> PNG, and warnings.
    """
    scenes = {name: scene_of(link) for name, link in links.items() if isinstance(link, SolidResult)}
    return plots_of(scenes, points, time_limit=time_limit)


def plots_of(
    scenes: Mapping[str, Scene], points: Mapping[str, Mapping[str, float]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Draw scenes.

    Parameters
    ----------
    scenes : mapping
        By name.
    points : mapping
        As for ``stress_plots``.
    time_limit : float, optional
        Of rendering [s].

    Returns
    -------
    tuple
        Name -> PNG, and warnings.
    """
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
    """Return value and place of the largest stress in words, or why there is no value.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    tuple of str
    """
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
