"""The picture of an imported part: both sides of its surface, with the names of its bores."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from alula.geometry.imported.arrangement import LinkFrame, viewing_frame
from alula.geometry.imported.facts import Bore, PartFacts, PartSurface
from alula.reports.figures.face_labels import FaceSpot, face_spot, is_seen
from alula.reports.figures.figures import rendered, scale_bar
from alula.reports.figures.scene import Rendering, View, axes_of
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.labels import place_labels
from alula.reports.figures.sheet.letters import SIZE
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.sheet.style import GROUND, INK, LOAD, WIDTH

Real = NDArray[np.float64]

_SIDES = {"from above (z towards you)": 1.0, "from below (z away from you)": -1.0}
_TILT = np.array([0.24, -0.42, 0.875])
"""From where the part is looked at from above, in its own frame: walls show, and no axis covers another. From below it
is the opposite, so that each wall shows in one of the two views unless something stands before it."""
_COLOURS = np.array([[190, 200, 210], [0, 103, 168]], dtype=np.uint8)
"""Of the part and of its bores."""
_PIXELS = 1600
_MARGIN, _TITLE, _BELOW = 7.2, 20.0, 50.0
"""Room about a view, above and below it [points]."""
_FACES, _FACE_SIZE = 24, 7.5
"""Flat faces that are named at most, the largest; size of these names [points]."""
_HIDDEN = 0.55
"""How strong the name of a bore is on the side where it cannot be seen."""


def part_picture(facts: PartFacts, surface: PartSurface) -> tuple[Canvas | None, str]:
    """Draw a part from above and from below, with its bores coloured and named.

    Parameters
    ----------
    facts : PartFacts
        What is found in its file.
    surface : PartSurface
        Triangles of its surface.

    Returns
    -------
    tuple
        Canvas, or None, and what went wrong.
    """
    frame = viewing_frame(facts)
    points = frame.place(surface.points)
    values = _bore_walls(facts.bores, surface)
    views = {title: _view(points, side) for title, side in _SIDES.items()}
    images, trouble = rendered(
        {
            title: Rendering(
                view=view,
                points=points,
                triangles=surface.triangles,
                values=values,
                limits=(0.0, 1.0),
                colours=_COLOURS,
            )
            for title, view in views.items()
        }
    )
    if len(images) < len(views):
        return None, trouble or "rendering failed"
    return _composed(facts, frame, points[surface.triangles], surface.faces, views, images), ""


def _bore_walls(bores: tuple[Bore, ...], surface: PartSurface) -> Real:
    """Return 1.0 for points (n,) of triangles that lie on the wall of a bore, else 0.0."""
    values = np.zeros(len(surface.points))
    for bore in bores:
        axis, along = np.array(bore.axis), np.array(bore.slot_axis)
        arm = surface.points - bore.centre
        height = arm @ axis
        flat = arm - height[:, None] * axis
        shift = np.clip(flat @ along, -bore.slot / 2.0, bore.slot / 2.0)
        distance = np.linalg.norm(flat - shift[:, None] * along, axis=1)
        near = 1e-3 * bore.diameter
        on_wall = (abs(distance - bore.diameter / 2.0) < near) & (abs(height) < bore.length / 2.0 + near)
        upright = np.ptp(height[surface.triangles], axis=1) > near  # not of a hole's flat bottom
        values[surface.triangles[on_wall[surface.triangles].all(axis=1) & upright]] = 1.0
    return values


def _view(points: Real, side: float) -> View:
    toward = side * _TILT / np.linalg.norm(_TILT)
    right, up = axes_of(toward)
    u, v = points @ right, points @ up
    middle = (u.min() + u.max()) / 2.0 * right + (v.min() + v.max()) / 2.0 * up
    half_width = max(0.58 * float(np.ptp(u)), 2.0 * 0.62 * float(np.ptp(v)))
    half_height = max(0.62 * float(np.ptp(v)), half_width / 4.0)
    size = (_PIXELS, round(_PIXELS * half_height / half_width))
    return View(right=right, up=up, toward=toward, focus=middle, half_width=half_width,
                half_height=half_height, size=size, cut=None)  # fmt: skip


def _composed(
    facts: PartFacts,
    frame: LinkFrame,
    corners: Real,
    faces: NDArray[np.int64],
    views: Mapping[str, View],
    images: Mapping[str, Real],
) -> Canvas:
    """Put both views on one sheet."""
    wide = 72.0 * WIDTH - 2.0 * _MARGIN
    tall = [wide * view.half_height / view.half_width for view in views.values()]
    sheet = Canvas(72.0 * WIDTH, sum(tall) + len(tall) * (_TITLE + _BELOW))
    names = {bore.name: point for point, bore in frame.bores.items()}
    ends = {title: {b.name: _nearest_end(frame, b, view.toward) for b in facts.bores} for title, view in views.items()}
    seen = {title: {name for name, at in ends[title].items() if is_seen(at, corners, views[title])} for title in views}
    nowhere = {bore.name for bore in facts.bores} - set().union(*seen.values())
    spots = {title: _face_spots(facts, frame, corners, faces, view) for title, view in views.items()}
    top = 0.0
    for (title, view), height in zip(views.items(), tall, strict=True):
        top += _TITLE
        box = (_MARGIN, top, _MARGIN + wide, top + height)
        axes = Axes(box=box, x=(0.0, 1.0), y=(0.0, 1.0))
        sheet.picture(images[title], box)
        sheet.write(title, (_MARGIN, top - 4.0), anchor="left bottom")
        labels = [
            (
                axes.at(view.share(ends[title][bore.name]))[None],
                f"{names[bore.name]} = {bore.name}" if bore.name in names else bore.name,
                INK if bore.name in seen[title] else faint(GROUND, _HIDDEN),
            )
            for bore in facts.bores
            if bore.name in seen[title] | nowhere
        ]
        drawn = _drawn(images[title], box)
        for name, spot in spots[title].items():
            at = axes.at(view.share(spot.at))
            if spot.fits:
                sheet.write(name, at, size=_FACE_SIZE, halo=1.5)
            elif not any(name in others and others[name].fits for others in spots.values()):
                labels.append((at[None], name, INK))
        place_labels(sheet, box, labels, drawn, size=SIZE)
        _directions(sheet, view, (box[0] + 26.0, box[3] + 12.0))
        scale_bar(sheet, axes, view, (0.16, 0.0), 14.0)
        top += height + _BELOW
    told = f"x, y, z: axes of the {'link' if frame.bores else 'view'}; bores are blue"
    if nowhere:
        told += "; faint names: hidden inside"
    sheet.write(told, (72.0 * WIDTH - _MARGIN, top - 12.0), anchor="right bottom")
    return sheet


def _face_spots(
    facts: PartFacts, frame: LinkFrame, corners: Real, faces: NDArray[np.int64], view: View
) -> dict[str, FaceSpot]:
    """Return where the names of the largest flat faces go, of those that are seen."""
    found = {}
    for face in sorted(facts.faces, key=lambda one: -one.area)[:_FACES]:
        centre = frame.place(np.array(face.centre))
        scale = (72.0 * WIDTH - 2.0 * _MARGIN) / (2.0 * view.half_width)
        spot = face_spot(face.name, corners[faces == face.tag], centre, corners, view, scale, _FACE_SIZE)
        if spot is not None:
            found[face.name] = spot
    return found


def _nearest_end(frame: LinkFrame, bore: Bore, toward: Real) -> Real:
    """Return the middle (3,) of the end of a bore that faces the viewer."""
    axis = frame.axes @ np.array(bore.axis)
    return np.asarray(
        frame.place(np.array(bore.centre)) + math.copysign(0.5 * bore.length, float(axis @ toward)) * axis
    )


def _drawn(image: Real, box: tuple[float, float, float, float]) -> Real:
    """Return points (n, 2) on the sheet where an image is not white."""
    rows, columns = np.nonzero((image[::4, ::4, :3] < 250).any(axis=2))
    tall, wide = image.shape[:2]
    return np.column_stack(
        [
            box[0] + (4.0 * columns + 2.0) / wide * (box[2] - box[0]),
            box[1] + (4.0 * rows + 2.0) / tall * (box[3] - box[1]),
        ]
    )


def _directions(sheet: Canvas, view: View, at: tuple[float, float]) -> None:
    """Draw the axes of the frame as a view shows them."""
    for name, axis in zip("xyz", np.eye(3), strict=True):
        way = np.array([axis @ view.right, -(axis @ view.up)])
        if np.linalg.norm(way) > 0.05:
            sheet.arrow(at, np.array(at) + 20.0 * way, LOAD, 1.2)
            sheet.write(name, np.array(at) + 20.0 * way + 6.0 * way / np.linalg.norm(way), size=8.5, halo=2.0)
