"""The links in their layers, seen from above and from the side."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.clearance.least import Spot
from alula.geometry.clearance.shape import Shape
from alula.geometry.linkage.placement import Placement
from alula.loads.case.case import Case
from alula.loads.case.forks import levels
from alula.loads.states.clearance import Assembly, Clearance
from alula.reports.figures.sheet.canvas import Canvas, faint
from alula.reports.figures.sheet.labels import place_labels
from alula.reports.figures.sheet.plot import Axes, ticks, widest
from alula.reports.figures.sheet.style import GROUND, INK, WIDTH
from alula.reports.words.numbers import plain

Real = NDArray[np.float64]

LAYERS = ("#0067a8", "#c8460b", "#00795a", "#8a5a00", "#6b4fa0", "#b0306a", "#4d6b1f", "#3b7d8c")
"""Colours of the layers, from the lowest up; they begin anew after the last."""
FILL = 0.42
"""Share of its layer's colour in the filling of a link."""
_PIN = "#39434d"
_TALLEST, _LOWEST = 430.0, 70.0
"""Height of the view from above at most, and of the view from the side at least [points]."""
_RIGHT, _ABOVE, _BELOW, _LETTERS, _ROW = 16.0, 18.0, 40.0, 8.5, 13.0
_MARGIN = 0.04
"""Room about the outlines over the size of what is drawn."""
_ALONG = np.linspace(0.0, 1.0, 400)
"""Shares of a border at which labels see it."""
_STRETCHES = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)


class Placed:
    """The outlines of an assembly in global axes at one pose.

    Attributes
    ----------
    links : dict of str to geometry
        By link.
    pins : dict of str to geometry
        By joint.
    """

    def __init__(self, assembly: Assembly, place: Placement) -> None:
        self.assembly, self.place = assembly, place
        self.links = {name: self.of(shape.polygon, Spot(link=name)) for name, shape in assembly.links.items()}
        self.pins = {name: self.of(shape.polygon, assembly.spot(name)) for name, shape in assembly.pins.items()}

    def of(self, geometry: Any, spot: Spot) -> Any:
        """Return a geometry of a link's or a pin's frame in global axes.

        Parameters
        ----------
        geometry : shapely geometry
            In that frame [mm].
        spot : Spot
            Where it stands.

        Returns
        -------
        shapely geometry
            [mm]
        """
        from shapely.affinity import affine_transform

        turn, at = complex(self.place.direction(spot.link)[0]), complex(self.place.origin(spot.link)[0])
        at += 0.0 if spot.point is None else complex(self.place.arm(spot.link, spot.point)[0])
        return affine_transform(geometry, [turn.real, -turn.imag, turn.imag, turn.real, at.real, at.imag])

    def points(self, link: str) -> Real:
        """Return the places (n, 2) of a link's points.

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        array (n, 2)
            [mm]
        """
        at = [complex(self.place.position(link, point)[0]) for point in self.place.linkage.links[link].points]
        return np.array([(z.real, z.imag) for z in at])

    def joint(self, name: str) -> Real:
        """Return the place (2,) of a joint.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        array (2,)
            [mm]
        """
        spot = self.assembly.spot(name)
        assert spot.point is not None
        at = complex(self.place.position(spot.link, spot.point)[0])
        return np.array([at.real, at.imag])

    @property
    def bounds(self) -> tuple[Real, Real]:
        """Lower left and upper right corner of all that there is [mm]."""
        corners = [np.reshape(g.bounds, (2, 2)) for g in (*self.links.values(), *self.pins.values())]
        corners += [self.points(link) for link in self.place.linkage.links]
        every = np.vstack(corners)
        return every.min(axis=0), every.max(axis=0)


def rings(geometry: Any) -> Iterator[Real]:
    """Yield every polygon of a geometry as one closed line, along which holes are cut from the border.

    Parameters
    ----------
    geometry : shapely geometry
        Polygons.

    Yields
    ------
    array (n, 2)
    """
    import shapely

    for part in shapely.get_parts(geometry):
        if part.geom_type != "Polygon" or part.is_empty:
            continue
        outer = np.asarray(part.exterior.coords)
        pieces = [outer]
        for hole in part.interiors:
            pieces += [np.asarray(hole.coords), outer[-1:]]
        yield np.vstack(pieces)


def draw(sheet: Canvas, axes: Axes, geometry: Any, fill: str, edge: str, width: float = 0.7) -> None:
    """Draw polygons with their holes.

    Parameters
    ----------
    sheet : Canvas
    axes : Axes
    geometry : shapely geometry
        [mm]
    fill, edge : str
        Colours; no fill where "".
    width : float, optional
        Of the edge [points].
    """
    import shapely

    if fill:
        for ring in rings(geometry):
            sheet.area(axes.at(ring), fill)
    for part in shapely.get_parts(geometry):
        if part.geom_type == "Polygon":
            for ring in (part.exterior, *part.interiors):
                at = np.asarray(ring.coords)
                sheet.line(axes.at(np.vstack([at, at[1:2]])), edge, width)


def layer_colours(case: Case) -> dict[str, str]:
    """Return link -> the colour of its layer.

    Parameters
    ----------
    case : Case
        A case with layers.

    Returns
    -------
    dict of str to str
    """
    every = sorted(set(case.heights.values()))
    return {link: LAYERS[every.index(z) % len(LAYERS)] for link, z in case.heights.items()}


def assembly_drawing(found: Clearance) -> Canvas:
    """Draw the links and pins in the stated pose: from above to scale, and from the side with their heights.

    Parameters
    ----------
    found : Clearance
        Whose outlines are drawn.

    Returns
    -------
    Canvas
    """
    placed = Placed(found.assembly, found.stated)
    low, high = placed.bounds
    along = 0 if high[0] - low[0] >= high[1] - low[1] else 1
    z_low, z_high = _heights(found.assembly)
    margin = _MARGIN * float((high - low).max())
    low, high = low - margin, high + margin
    left = 34.0 + max(widest(ticks(float(low[1]), float(high[1]), most=9)), widest(ticks(z_low, z_high, most=4)))
    wide = 72.0 * WIDTH - left - _RIGHT
    scale = min(wide / (high - low)[0], wide / (high - low)[along], _TALLEST / (high - low)[1])
    tall = scale * float((high - low)[1])
    z_margin = 0.08 * (z_high - z_low)
    z_low, z_high = z_low - z_margin, z_high + z_margin
    stretch = next((s for s in _STRETCHES if s * scale * (z_high - z_low) >= _LOWEST), _STRETCHES[-1])
    deep = stretch * scale * (z_high - z_low)
    rows = _legend_rows(found.assembly.case)
    sheet = Canvas(72.0 * WIDTH, _ABOVE + tall + _BELOW + _ABOVE + deep + _BELOW + _ROW * len(rows) + 6.0)
    half = wide / scale / 2.0
    centre = (low + high) / 2.0
    plan = Axes(
        box=(left, _ABOVE, left + wide, _ABOVE + tall),
        x=(float(centre[0] - half), float(centre[0] + half)),
        y=(float(low[1]), float(high[1])),
    )
    top = _ABOVE + tall + _BELOW + _ABOVE
    side = Axes(
        box=(left, top, left + wide, top + deep),
        x=(float(centre[along] - half), float(centre[along] + half)),
        y=(z_low, z_high),
    )
    sheet.write("From above, to scale", (left, _ABOVE - 4.0), anchor="left bottom")
    told = "to scale" if stretch == 1.0 else f"heights stretched {stretch:g} times"
    sheet.write(f"From the side, along {'yx'[along]}, {told}", (left, top - 4.0), anchor="left bottom")
    _plan(sheet, plan, placed)
    _side(sheet, side, placed, along)
    _legend(sheet, rows, left, top + deep + _BELOW)
    return sheet


def _heights(assembly: Assembly) -> tuple[float, float]:
    """Least and greatest z of links and pins [mm]."""
    shapes: Sequence[Shape] = (*assembly.links.values(), *assembly.pins.values())
    levels = [*assembly.case.heights.values()]
    return min([shape.low for shape in shapes] + levels), max([shape.high for shape in shapes] + levels)


def _plan(sheet: Canvas, axes: Axes, placed: Placed) -> None:
    """Draw the view from above: what is higher covers what is lower."""
    axes.scale_x(sheet, "x [mm]", grid=True)
    axes.scale_y(sheet, "y [mm]", label_at=12.0, grid=True)
    axes.frame(sheet)
    case, colours = placed.assembly.case, layer_colours(placed.assembly.case)
    obstacles: list[Real] = []
    for link in sorted(case.links, key=lambda name: levels(case, name)[-1]):
        if link in placed.links:
            draw(sheet, axes, placed.links[link], faint(colours[link], FILL), colours[link], 0.9)
            obstacles.append(axes.at(border(placed.links[link])))
        else:
            obstacles += _bare(sheet, axes, placed, link)
    for pin in placed.pins.values():
        draw(sheet, axes, pin, "#ffffff", _PIN, 1.0)
        obstacles.append(axes.at(border(pin)))
    names = [(axes.at(placed.joint(name)[None]), name, INK) for name in case.joints]
    names += [(axes.at(_anchors(placed, link)), f"link {link}", _ink(placed, link)) for link in case.links]
    place_labels(sheet, axes.box, names, np.vstack(obstacles), size=_LETTERS)


def _bare(sheet: Canvas, axes: Axes, placed: Placed, link: str) -> list[Real]:
    """Draw a link without a part as dashed lines; returns points of them."""
    record, at = (
        placed.place.linkage.links[link],
        dict(zip(placed.place.linkage.links[link].points, placed.points(link), strict=True)),
    )
    found = []
    for one, other in record.pieces:
        sheet.line(axes.at([at[one], at[other]]), GROUND, 0.9, (4.8, 3.2))
        found.append(axes.at(np.linspace(at[one], at[other], 120)))
    return found


def border(geometry: Any) -> Real:
    """Return points along the border of a geometry, close enough for labels to see them.

    Parameters
    ----------
    geometry : shapely geometry
        Polygons.

    Returns
    -------
    array (n, 2)
    """
    import shapely

    return np.asarray(shapely.get_coordinates(geometry.boundary.interpolate(_ALONG, normalized=True)))


def _anchors(placed: Placed, link: str) -> Real:
    """Places (k, 2) of a link at which its name may stand: along its longest piece."""
    record = placed.place.linkage.links[link]
    at = dict(zip(record.points, placed.points(link), strict=True))
    alone = next(iter(at.values()))
    a, b = max(
        ((at[one], at[other]) for one, other in record.pieces),
        key=lambda ends: float(np.hypot(*(ends[1] - ends[0]))),
        default=(alone, alone),
    )
    return np.array([share * b + (1.0 - share) * a for share in (0.5, 0.3, 0.7)])


def _side(sheet: Canvas, axes: Axes, placed: Placed, along: int) -> None:
    """Draw the view from the side: each piece of a link as a box between its heights, pins as bars."""
    axes.scale_x(sheet, f"{'xy'[along]} [mm]", grid=True)
    axes.scale_y(sheet, "z [mm]", label_at=12.0, most=5, grid=True)
    axes.frame(sheet)
    case, colours = placed.assembly.case, layer_colours(placed.assembly.case)
    across, labels, obstacles = 1 - along, [], []
    away = 1.0 if across == 1 else -1.0  # looked at from the side of small y, or of large x
    order = sorted(placed.links, key=lambda link: -away * placed.links[link].centroid.coords[0][across])
    for link in order:
        shape, spot = placed.assembly.links[link], Spot(link=link)
        for u0, low, u1, high in _slabs(placed, shape, spot, along):
            sheet.area(axes.at(_box(u0, low, u1, high)), faint(colours[link], FILL), colours[link], 0.7)
        bounds = placed.links[link].bounds
        middle = (shape.low + shape.high) / 2.0
        us = bounds[along] + np.array([0.5, 0.3, 0.7, 0.15, 0.85]) * (bounds[along + 2] - bounds[along])
        labels.append((axes.at(np.column_stack([us, np.full(5, middle)])), link, _ink(placed, link)))
    for link in case.links:
        if link not in placed.links:
            at, z = placed.points(link)[:, along], case.heights[link]
            sheet.line(axes.at([(at.min(), z), (at.max(), z)]), GROUND, 0.9, (4.8, 3.2))
            labels.append((axes.at([((at.min() + at.max()) / 2.0, z)]), link, GROUND))
    for name, shape in placed.assembly.pins.items():
        at, half = placed.joint(name)[along], shape.cores[0].radius
        box = axes.at(_box(at - half, shape.low, at + half, shape.high))
        sheet.area(box, _PIN)
        sheet.line(np.vstack([box, box[:2]]), _PIN, 0.8)
        obstacles.append(_filled(box))
        labels.append((axes.at([(at, shape.high), (at, shape.low)]), name, INK))
    place_labels(sheet, axes.box, labels, np.vstack([*obstacles, np.zeros((0, 2))]), size=_LETTERS)


def _slabs(placed: Placed, shape: Shape, spot: Spot, along: int) -> list[tuple[float, float, float, float]]:
    """Return (u0, low, u1, high) of a link as seen from the side, thin ones first; pieces of one height are joined."""
    found: dict[tuple[float, float], list[tuple[float, float]]] = {}
    for core in shape.cores:
        bounds = placed.of(core.polygon, spot).bounds
        found.setdefault((core.low, core.high), []).append((bounds[along], bounds[along + 2]))
    slabs = []
    for (low, high), spans in found.items():
        joined: list[tuple[float, float]] = []
        for start, end in sorted(spans):
            if joined and start <= joined[-1][1]:
                joined[-1] = joined[-1][0], max(end, joined[-1][1])
            else:
                joined.append((start, end))
        slabs += [(start, low, end, high) for start, end in joined]
    return sorted(slabs, key=lambda slab: slab[3] - slab[1])


def _box(x0: float, y0: float, x1: float, y1: float) -> list[tuple[float, float]]:
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def _filled(box: Real) -> Real:
    """Points (n, 2) all over a box on the sheet."""
    low, high = box.min(axis=0), box.max(axis=0)
    x, y = np.meshgrid(np.linspace(low[0], high[0], 4), np.linspace(low[1], high[1], 40))
    return np.column_stack([x.ravel(), y.ravel()])


def _ink(placed: Placed, link: str) -> str:
    """Return the colour of a link's name."""
    return dark(layer_colours(placed.assembly.case)[link]) if link in placed.links else GROUND


def dark(colour: str) -> str:
    """Return a colour mixed with black, for letters.

    Parameters
    ----------
    colour : str
        As ``#rrggbb``.

    Returns
    -------
    str
    """
    parts = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(0.75 * part):02x}" for part in parts)


def _legend_rows(case: Case) -> list[tuple[str, str]]:
    """Colour and text of every layer, the highest first; no colour where no link of it has a part."""
    colours, found = layer_colours(case), []
    for level in sorted(set(case.heights.values()), reverse=True):
        links = [link for link, z in case.heights.items() if z == level]
        layers = {case.links[link].layer for link in links}
        layer = f"layer {next(iter(layers))}, " if len(layers) == 1 and None not in layers else ""
        bare = [link for link in links if case.links[link].part is None]
        names = ", ".join(f"{link} (without a part, dashed)" if link in bare else link for link in links)
        shown = "" if len(bare) == len(links) else colours[links[0]]
        found.append((shown, f"{layer}mid-plane at z = {plain(float(f'{level:.5g}'))} mm: {names}"))
    return found


def _legend(sheet: Canvas, rows: list[tuple[str, str]], left: float, top: float) -> None:
    for k, (colour, text) in enumerate(rows):
        y = top + _ROW * (k + 0.5)
        if colour:
            sheet.area(_box(left, y - 4.0, left + 14.0, y + 4.0), faint(colour, FILL), colour, 0.9)
        else:
            sheet.line([(left, y), (left + 14.0, y)], GROUND, 0.9, (4.0, 2.0))
        sheet.write(text, (left + 20.0, y), anchor="left middle", size=_LETTERS)
