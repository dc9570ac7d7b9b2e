"""The child process that renders views with pyvista: ``python -m alula.reports.figures.figures_worker``.

A request is pickled: a view and its arrays. So is its answer: ("done", image) or ("failed", sentence).
"""

import pickle
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.child_server import ChildService

SMOOTH_BELOW = 40.0
"""Angle between faces [degrees] above which an edge is drawn sharp."""


def render(plotter: Any, view: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> NDArray[np.uint8]:
    """Render one view in parallel projection.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Takes one view after another: a window of its own for each would double the time.
    view : dict
        ``size`` (width, height) in pixels, ``focus`` and ``toward`` (3,) where the camera looks and from which
        direction, ``up`` (3,), ``half_height`` [mm], ``limits`` of the colours [MPa], ``colours`` (k, 3) from 0 to 255,
        ``cut`` a height z [mm] above which the body is cut away, or None.
    arrays : dict
        ``points`` (n, 3), ``triangles`` (k, 3), ``values`` (n,), ``outline`` (n, 3) of the undeformed body (empty for
        none), and ``cells`` (m, 4) tetrahedra to be cut.

    Returns
    -------
    array
        Red, green and blue (height, width, 3) from 0 to 255.

    Raises
    ------
    RuntimeError
        For a blank picture.
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
    return np.asarray(image)


def main() -> None:
    """Answer requests until the parent ends."""
    service = ChildService()
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, lighting="light kit")
    plotter.set_background("white")

    def answer(request: bytes) -> None:
        told: tuple[str, object]
        try:
            told = "done", render(plotter, *pickle.loads(request))
        except Exception as error:
            told = "failed", f"{type(error).__name__}: {error}"
        service.reply(pickle.dumps(told))

    service.run(answer)


if __name__ == "__main__":
    main()
