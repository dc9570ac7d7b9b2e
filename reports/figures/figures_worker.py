"""The child process that renders views with pyvista: ``python -m reports.figures.figures_worker FOLDER REQUEST``.

Reads from the folder the request, a JSON object name -> view, and the arrays in the ``.npz`` file that each view
names; writes the image of each as ``<view>.npy``.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.base.child import end_with_parent

SMOOTH_BELOW = 40.0
"""Angle between faces [degrees] above which an edge is drawn sharp."""


def render(plotter: Any, view: dict[str, Any], arrays: dict[str, NDArray[Any]], path: Path) -> None:
    """Render one view in parallel projection and save it.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Takes one view after another: a window of its own for each would double the time.
    view : dict
        ``size`` (width, height) in pixels, ``focus`` and ``toward`` (3,) where the camera looks and from which
        direction, ``up`` (3,), ``half_height`` [mm], ``limits`` of the colours [MPa], ``colours`` (k, 3) from 0 to 255,
        ``cut`` a height z [mm] above which the body is cut away, or null.
    arrays : dict
        ``points`` (n, 3), ``triangles`` (k, 3), ``values`` (n,), ``outline`` (n, 3) of the undeformed body (empty for
        none), and ``cells`` (m, 4) tetrahedra to be cut.
    path : Path
        The image, as a NumPy file.
    """
    import pyvista

    plotter.suppress_rendering = True  # until all is in its place
    plotter.clear_actors()
    plotter.window_size = list(view["size"])
    if view["cut"] is None:
        body = pyvista.PolyData.from_regular_faces(arrays["points"], arrays["triangles"])
        body["values"] = arrays["values"]
    else:
        cells = arrays["cells"]
        grid = pyvista.UnstructuredGrid({pyvista.CellType.TETRA: cells}, arrays["points"])
        grid["values"] = arrays["values"]
        cut = grid.clip(normal="z", origin=(0.0, 0.0, view["cut"]), invert=True)
        body = cut.extract_surface(algorithm="dataset_surface")
    plotter.add_mesh(
        body,
        scalars="values",
        cmap=["#{:02x}{:02x}{:02x}".format(*colour) for colour in view["colours"]],
        clim=view["limits"],
        show_scalar_bar=False,
        smooth_shading=True,
        split_sharp_edges=True,
        feature_angle=SMOOTH_BELOW,
        ambient=0.5,
        diffuse=0.55,
        specular=0.0,
    )
    if len(arrays["outline"]):
        still = pyvista.PolyData.from_regular_faces(arrays["outline"], arrays["triangles"])
        plotter.add_silhouette(still, color="#5d6b78", line_width=2.0, feature_angle=SMOOTH_BELOW + 20.0)
    plotter.enable_parallel_projection()
    focus, toward = np.array(view["focus"]), np.array(view["toward"])
    distance = 20.0 * max(view["half_height"], float(np.ptp(arrays["points"], axis=0).max()))
    plotter.camera.focal_point = tuple(focus)
    plotter.camera.position = tuple(focus + distance * toward)
    plotter.camera.up = tuple(view["up"])
    plotter.camera.parallel_scale = view["half_height"]
    plotter.camera.reset_clipping_range()
    plotter.suppress_rendering = False
    plotter.render()
    image = plotter.screenshot(None, return_img=True)
    if np.ptp(image) == 0:
        raise RuntimeError("the picture came out blank")
    # By renaming, so that a crash leaves no half of an image.
    draft = path.with_suffix(".part.npy")
    np.save(draft, image)
    draft.rename(path)


def main(folder: Path, request: str) -> None:
    """Render every view of a request.

    Parameters
    ----------
    folder : Path
        Contains the request and its arrays; receives the images.
    request : str
        Name of a JSON file.
    """
    end_with_parent(folder)
    views = json.loads((folder / request).read_text(encoding="utf-8"))
    if not views:
        return
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, lighting="light kit")
    plotter.set_background("white")
    for name, view in views.items():
        with np.load(folder / view["arrays"]) as stored:
            render(plotter, view, dict(stored), folder / f"{name}.npy")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
