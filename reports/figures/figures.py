"""Stress plots of links: the stress that decides on the deformed shape, and a close view of the hottest spot.

The bodies are rendered in a child process (``figures_worker.py``), since the graphics library can crash
where no display or no software renderer is to be had; then the pictures are left out with one warning, as where
pyvista is not installed.
Scales, labels and the colour bar are drawn around the renderings.
"""

import pickle
import subprocess
import time
from collections.abc import Hashable, Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from importlib.util import find_spec
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.geometry.base import child
from alula.geometry.base.child_server import ChildEndedError, ServerPool
from alula.geometry.base.system_libraries import OSMESA, advice, loads
from alula.geometry.base.version import extra_command
from alula.reports.figures.scene import MARGIN, SIDE, Rendering, Scene, View, round_scale, scene_of
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.labels import heights, stacked, write_stacked
from alula.reports.figures.sheet.letters import SIZE
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.sheet.style import INK, WIDTH
from alula.reports.words.numbers import fixed, number, plain

Real = NDArray[np.float64]

Place = tuple[float, float]
_Key = TypeVar("_Key", bound=Hashable)

TIME_LIMIT = 180.0
"""Seconds for the renderings of one check."""
_POOL = ServerPool()
COLOURS = ("#ffffcc", "#ffeda0", "#fed976", "#feb24c", "#fd8d3c", "#fc4e2a", "#e31a1c", "#bd0026", "#800026")
"""From no stress to the largest: YlOrRd of ColorBrewer (Brewer, Harrower & Penn State University, 2013)."""


def stress_plots(
    links: Mapping[str, LinkResult], points: Mapping[str, Mapping[str, Place]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, Canvas], tuple[str, ...]]:
    """Draw the stress of every link that was solved as a solid.

    Where rendering fails there are fewer pictures and one warning.

    Parameters
    ----------
    links : mapping
        Results by name.
    points : mapping
        Link -> name -> (x, y) of its pins and load points [mm], to be named in the picture.
    time_limit : float, optional
        Of rendering [s].

    Returns
    -------
    tuple
        Link -> Canvas, and warnings.
    """
    scenes = {name: scene_of(link) for name, link in links.items() if isinstance(link, SolidResult)}
    return plots_of(scenes, points, time_limit=time_limit)


def plots_of(
    scenes: Mapping[str, Scene], points: Mapping[str, Mapping[str, Place]], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, Canvas], tuple[str, ...]]:
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
        Name -> Canvas, and warnings.
    """
    if not scenes:
        return {}, ()
    images, trouble = rendered(
        {(name, kind): one for name, scene in scenes.items() for kind, one in _renderings(scene).items()},
        time_limit=time_limit,
    )
    whole = [name for name in scenes if {(name, "strip"), (name, "close")} <= images.keys()]
    found = {
        name: _composed(scenes[name], images[name, "strip"], images[name, "close"], points[name]) for name in whole
    }
    missing = [name for name in scenes if name not in found]
    return found, (f"no stress plot of {', '.join(missing)}: {trouble}",) if missing else ()


def colour_range(scene: Scene) -> tuple[float, float]:
    """Return the values of the first and the last colour.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    tuple of 2 float
        Stress [MPa].
    """
    return 0.0, scene.top if scene.top > 0.0 else 1.0


def _renderings(scene: Scene) -> dict[str, Rendering]:
    """Return both views of a scene."""
    close = Rendering(
        view=scene.close,
        points=scene.points,
        triangles=scene.triangles,
        values=scene.values,
        limits=colour_range(scene),
        colours=colours(),
        cells=scene.cells,
    )
    return {"strip": replace(close, view=scene.strip, points=scene.deformed, outline=scene.points), "close": close}


def rendered(renderings: Mapping[_Key, Rendering], *, time_limit: float = TIME_LIMIT) -> tuple[dict[_Key, Real], str]:
    """Render bodies in a child process.

    Parameters
    ----------
    renderings : mapping
        By name, whatever it is.
    time_limit : float, optional
        Of all of them [s].

    Returns
    -------
    tuple
        Name -> image of those that came out, and what went wrong with the others.
    """
    if not _installed():
        return {}, f"pyvista is not installed; run {extra_command('pictures')}"
    requests = {}
    for key, one in renderings.items():
        asked = asdict(one.view) | {"limits": one.limits, "colours": one.colours}
        arrays = {"points": one.points, "outline": one.outline, "triangles": one.triangles, "values": one.values}
        cells = {} if one.view.cut is None else {"cells": one.cells}
        requests[key] = pickle.dumps((asked, arrays | cells))
    trouble = ""
    images: dict[_Key, Real] = {}
    for choice in _renderers():
        left = {key: request for key, request in requests.items() if key not in images}
        found, trouble = _ask(left, choice, time_limit)
        images |= found
        if not trouble:
            break
    return images, trouble


def _renderers() -> tuple[dict[str, str], ...]:
    """Return the environments to render in, the best first.

    OSMesa gives the same picture with and without a display; where its library is missing, VTK would crash with it.
    """
    own: dict[str, str] = {}
    return ({"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"}, own) if loads(OSMESA) else (own,)


def _installed() -> bool:
    return find_spec("pyvista") is not None


def _command() -> list[str]:
    return child.module_command("alula.reports.figures.figures_worker")


def _environment(choice: Mapping[str, str]) -> dict[str, str]:
    return child.environment(PYVISTA_OFF_SCREEN="true", **choice)


def start_renderer() -> None:
    """Start the child that renders, once, so that it is ready when there is something to render."""
    if _installed():
        with suppress(OSError):  # told where pictures are asked for
            _POOL.start(_command(), _environment(_renderers()[0]))


def _ask(requests: Mapping[_Key, bytes], choice: Mapping[str, str], time_limit: float) -> tuple[dict[_Key, Real], str]:
    """Have a child render views; returns the images that came out, and what went wrong with the others."""
    found: dict[_Key, Real] = {}
    end = time.monotonic() + time_limit
    try:
        with _POOL.server(_command(), _environment(choice), "") as server:
            for key, request in requests.items():
                kind, told = pickle.loads(server.ask(request, max(end - time.monotonic(), 0.0)))
                if kind == "failed":
                    return found, f"rendering failed ({told})"
                found[key] = told
    except subprocess.TimeoutExpired:
        return found, f"rendering was stopped after {time_limit:g} s"
    except ChildEndedError as ended:
        if ended.status < 0:
            return found, f"rendering crashed (signal {-ended.status}); {advice()}"
        return found, f"rendering failed ({ended.told})"
    except OSError as error:
        return found, f"rendering could not be started ({error.strerror})"
    return found, ""


def colours() -> NDArray[np.uint8]:
    """Return 256 colours (256, 3) from no stress to the largest.

    Returns
    -------
    array
        Red, green and blue from 0 to 255.
    """
    fixed = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in COLOURS])
    places = np.linspace(0.0, 1.0, 256)
    mixed = [np.interp(places, np.linspace(0.0, 1.0, len(fixed)), channel) for channel in fixed.T]
    return np.column_stack(mixed).round().astype(np.uint8)


_ON_AXIS = 1e-6
"""Share of half the picture's width within which a point lies on the link's axis; it is named above the picture."""
_GAP = 36.0
"""Room between the views [points]."""


def _composed(scene: Scene, strip: Any, close: Any, points: Mapping[str, Place]) -> Canvas:
    """Put both renderings, the colour bar and the labels on one sheet."""
    wide = 72.0 * WIDTH - 2.0 * MARGIN
    on_axis = {name: at for name, at in points.items() if abs(at[1]) < _ON_AXIS * scene.strip.half_width}
    if len(on_axis) < 2 <= len(points):
        on_axis = {}  # a body across the axis would have that name at its far end
    shares = scene.strip.share(np.array([[x, 0.0, 0.0] for x, _ in on_axis.values()]).reshape(-1, 3))[:, 0]
    names = stacked(on_axis, wide * shares)
    top = 12.0 + heights(names)
    middle = top + wide * scene.strip.half_height / scene.strip.half_width
    sheet = Canvas(72.0 * WIDTH, middle + _GAP + SIDE + MARGIN)
    upper = Axes(box=(MARGIN, top, MARGIN + wide, middle), x=(0.0, 1.0), y=(0.0, 1.0))
    lower = Axes(box=(MARGIN, middle + _GAP, MARGIN + SIDE, middle + _GAP + SIDE), x=(0.0, 1.0), y=(0.0, 1.0))
    sheet.picture(strip, upper.box)
    sheet.picture(close, lower.box)
    lower.frame(sheet)
    write_stacked(sheet, names, MARGIN, top)
    high = float(scene.points[:, 2].max())
    for name, (x, y) in points.items():
        if name not in on_axis:
            at = upper.at(scene.strip.share(np.array([x, y, high])))
            sheet.write(name, at, anchor="center middle", size=9.0, bold=True, halo=2.5)
    title = "around the largest stress" + ("" if scene.close.cut is None else ", cut open")
    sheet.write(title, ((lower.box[0] + lower.box[2]) / 2.0, lower.box[1] - 4.0), anchor="center bottom", size=8.5)
    for axes, view, spots in ((upper, scene.strip, scene.deformed), (lower, scene.close, scene.points)):
        at = axes.at(view.share(spots[scene.hottest]))
        share = 0.45 if axes is upper and scene.far_side else 1.0
        for colour, width in (("#ffffff", 3.0), (INK, 1.2)):
            sheet.ring(at, 5.5, colour if share == 1.0 else faint(colour, share), width)
    scale_bar(sheet, upper, scene.strip, (0.012, 0.0), 5.8)
    scale_bar(sheet, lower, scene.close, (0.04, 0.04), 0.0)
    left, high = MARGIN + SIDE + 39.6, lower.box[1]
    _colour_bar(sheet, scene, (left, high + 20.0, 72.0 * WIDTH - 33.0, high + 32.3))
    largest = float(np.linalg.norm(scene.displacement, axis=1).max())
    lines = (
        *peak_lines(scene),
        "    (faint above: on the far side)\n" if scene.far_side else "",
        f"upper picture: deformed, × {plain(scene.scale)}",
        f"    largest displacement {number(largest, 3)} mm",
        "    grey line: undeformed",
        "lower picture: undeformed",
    )
    for k, line in enumerate("\n".join(lines).split("\n")):
        sheet.write(line.lstrip(), (left + 3.0 * (len(line) - len(line.lstrip())), high + 79.0 + 1.55 * SIZE * k),
                    anchor="left top")  # fmt: skip
    return sheet


def _colour_bar(sheet: Canvas, scene: Scene, box: tuple[float, float, float, float]) -> None:
    """Draw the scale of the colours; it ends in a tip where some stress lies beyond it."""
    _, top, right, bottom = box
    table = colours()
    if scene.top < scene.values.max():
        tip = [(right, top), (right + 8.0, (top + bottom) / 2.0), (right, bottom)]
        sheet.area(tip, "#{:02x}{:02x}{:02x}".format(*table[-1]), INK, 0.6)
    sheet.picture(np.tile(table, (4, 1, 1)), box)
    axes = Axes(box=box, x=colour_range(scene), y=(0.0, 1.0))
    axes.frame(sheet)
    axes.scale_x(sheet, f"{scene.measure} [MPa]", most=7)


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


def scale_bar(sheet: Canvas, axes: Axes, view: View, at: tuple[float, float], below: float) -> None:
    """Draw a round length.

    Parameters
    ----------
    sheet : Canvas
    axes : Axes
        Where the view is on the sheet.
    view : View
    at : tuple of 2 float
        Where the length begins, as shares of the view's width and height.
    below : float
        By how much it is moved down [points].
    """
    length = round_scale(0.45 * view.half_width)
    ends = axes.at([at, (at[0] + length / (2.0 * view.half_width), at[1])]) + np.array([0.0, below])
    sheet.line(ends, INK, 2.0)
    sheet.write(f"{plain(length)} mm", ends[1] + np.array([4.0, 0.0]), anchor="left middle", size=8.5, halo=2.0)
