"""The child process that renders views with VTK: ``python -m reports.figures.figures_worker FOLDER REQUEST``.

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


def render(view: dict[str, Any], arrays: dict[str, NDArray[Any]], path: Path) -> None:
    """Render one view in parallel projection and save it.

    Parameters
    ----------
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
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - brings the renderer that the next line names
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkRenderingCore import vtkLightKit, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter

    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.SetBackground(1.0, 1.0, 1.0)
    vtkLightKit().AddLightsToRenderer(renderer)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*view["size"])
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    focus, toward = np.array(view["focus"]), np.array(view["toward"])
    distance = 20.0 * max(view["half_height"], float(np.ptp(arrays["points"], axis=0).max()))
    camera.SetFocalPoint(*focus)
    camera.SetPosition(*(focus + distance * toward))
    camera.SetViewUp(*view["up"])
    camera.SetParallelScale(view["half_height"])
    renderer.AddActor(_body(view, arrays))
    if len(arrays["outline"]):
        renderer.AddActor(_silhouette(arrays, camera))
    renderer.ResetCameraClippingRange()
    window.Render()
    pixels = vtkWindowToImageFilter()
    pixels.SetInput(window)
    pixels.ReadFrontBufferOff()
    pixels.Update()
    wide, tall = view["size"]
    image = vtk_to_numpy(pixels.GetOutput().GetPointData().GetScalars()).reshape(tall, wide, -1)[::-1]
    window.Finalize()
    if np.ptp(image) == 0:
        raise RuntimeError("the picture came out blank")
    # By renaming, so that a crash leaves no half of an image.
    draft = path.with_suffix(".part.npy")
    np.save(draft, image)
    draft.rename(path)


def _surface(points: NDArray[Any], triangles: NDArray[Any]) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    places, faces, surface = vtkPoints(), vtkCellArray(), vtkPolyData()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    faces.SetData(triangles.shape[1], numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    surface.SetPoints(places)
    surface.SetPolys(faces)
    return surface


def _cut(points: NDArray[Any], cells: NDArray[Any], values: Any, height: float) -> Any:
    """Return the surface of what is below a height of tetrahedra."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkPlane, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

    places, corners, grid = vtkPoints(), vtkCellArray(), vtkUnstructuredGrid()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    corners.SetData(4, numpy_to_vtkIdTypeArray(cells.astype(np.int64).ravel(), deep=True))
    grid.SetPoints(places)
    grid.SetCells(VTK_TETRA, corners)
    grid.GetPointData().SetScalars(values)
    plane, clip, skin = vtkPlane(), vtkTableBasedClipDataSet(), vtkDataSetSurfaceFilter()
    plane.SetOrigin(0.0, 0.0, height)
    plane.SetNormal(0.0, 0.0, 1.0)
    clip.SetInputData(grid)
    clip.SetClipFunction(plane)
    clip.InsideOutOn()
    skin.SetInputConnection(clip.GetOutputPort())
    skin.Update()
    return skin.GetOutput()


def _body(view: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> Any:
    """Return the body in its colours, smooth but for sharp edges."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkLookupTable
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    values = numpy_to_vtk(np.ascontiguousarray(arrays["values"], dtype=np.float64), deep=True)
    if view["cut"] is None:
        body = _surface(arrays["points"], arrays["triangles"])
        body.GetPointData().SetScalars(values)
    else:
        body = _cut(arrays["points"], arrays["cells"], values, view["cut"])
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(view["colours"]))
    for k, colour in enumerate(view["colours"]):
        table.SetTableValue(k, [*(part / 255.0 for part in colour), 1.0])
    normals, mapper, actor = vtkPolyDataNormals(), vtkPolyDataMapper(), vtkActor()
    normals.SetInputData(body)
    normals.SplittingOn()
    normals.SetFeatureAngle(SMOOTH_BELOW)
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(*view["limits"])
    mapper.InterpolateScalarsBeforeMappingOn()
    actor.SetMapper(mapper)
    surface = actor.GetProperty()
    surface.SetInterpolationToPhong()
    surface.SetAmbient(0.5)
    surface.SetDiffuse(0.55)
    surface.SetSpecular(0.0)
    return actor


def _silhouette(arrays: dict[str, NDArray[Any]], camera: Any) -> Any:
    """Return the outline of the undeformed body."""
    from vtkmodules.vtkFiltersHybrid import vtkPolyDataSilhouette
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    edges, mapper, actor = vtkPolyDataSilhouette(), vtkPolyDataMapper(), vtkActor()
    # A little nearer to the viewer than the body, so that the lines on its faces are whole.
    nearer = 0.02 * camera.GetParallelScale() * np.array(camera.GetViewPlaneNormal())
    edges.SetInputData(_surface(arrays["outline"] + nearer, arrays["triangles"]))
    edges.SetCamera(camera)
    edges.SetEnableFeatureAngle(1)
    edges.SetFeatureAngle(SMOOTH_BELOW + 20.0)
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*(part / 255.0 for part in (0x5D, 0x6B, 0x78)))
    actor.GetProperty().SetLineWidth(2.0)
    return actor


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
    for name, view in json.loads((folder / request).read_text(encoding="utf-8")).items():
        with np.load(folder / view["arrays"]) as stored:
            render(view, dict(stored), folder / f"{name}.npy")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
