"""The linkage as a whole for the browser: its bodies in their layers, its poses, and a value for each link."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.case.case import Case
from alula.loads.case.forks import levels, outer_link
from alula.loads.case.layers import on_one_axis, slab
from alula.loads.records.applied import LineLoad, PointLoad, in_axes
from alula.loads.records.load_case import LoadCase
from alula.loads.states.actions import lasting, stated_loads
from alula.reports.figures.figures import COLOURS
from alula.reports.figures.outlines.assembly import LAYERS
from alula.reports.turnable.bodies import PlateBody, plate_body
from alula.reports.turnable.pack import quantised, shades
from alula.reports.words.numbers import plain

Real = NDArray[np.float64]

TOWARD = (-0.28, -0.5, 0.82)
"""Direction from the linkage to the viewer at first: from above, a little from below and from the left."""
_BARE = 0.012
"""Radius of what stands for a link without part or a pin without diameter, over the size of the linkage."""
_ROOM = 1.25
"""Distance of links that are pulled apart, over the greatest height of one."""
_FAR = 0.12
"""Their distance at the far end of the slider, over the size of the linkage, at least."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Poses:
    """The poses that are drawn, and what is told of each.

    Attributes
    ----------
    place : Placement
        At n poses.
    texts : sequence of str
        The coordinate's value with its unit, for each.
    first : int
        The one that is shown at first.
    start : int
        The first one of the motion: 1 where the stated pose stands before it, else 0.
    returns : bool
        True where the last pose is followed by the first; else the motion is played there and back.
    """

    place: Placement
    texts: Sequence[str]
    first: int = 0
    start: int = 0
    returns: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class Along:
    """Values along a link, in stretches of one length of its x axis.

    Attributes
    ----------
    first, last : float
        x between which the stretches lie [mm].
    values : array (n, stretches)
        For each pose.
    """

    first: float
    last: float
    values: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class Values:
    """What colours the links.

    Attributes
    ----------
    label, title : str
        What the values are, in a word or two and in full.
    unit : str
    links, pins : mapping of str to array (n,)
        Link, or joint -> a value for each pose, or a single one; NaN where there is none.
    texts : mapping of str to str
        Link -> what is told of it besides.
    along : mapping of str to Along
        Link -> the values along it, which colour it in place of its one value.
    top : float
        The value of the last colour; the largest value where it is left out.
    """

    label: str
    title: str
    unit: str
    links: Mapping[str, Real]
    pins: Mapping[str, Real]
    texts: Mapping[str, str]
    along: Mapping[str, Along] = field(default_factory=dict)
    top: float | None = None


def linkage_record(case: Case, poses: Poses, values: Sequence[Values]) -> dict[str, Any]:
    """Return all that the browser needs to draw a linkage in motion.

    Parameters
    ----------
    case : Case
    poses : Poses
    values : sequence of Values
        Among which the reader chooses; the first is shown at first.

    Returns
    -------
    dict
        Plain data; lengths in mm, arrays packed.
    """
    bodies = {link: [plate_body(case.body(link), z) for z in levels(case, link)] for link in case.checked_links}
    ranks = _ranks(case, poses.place)
    size = _size(poses.place)
    tallest = max([plate.high - plate.low for plates in bodies.values() for plate in plates] + [0.1 * _BARE * size])
    far = max(_FAR * size, _ROOM * tallest)
    built = case.layered or all(
        steps in ([0], [-1, 1]) for steps in ranks.values()
    )  # as it is, no two are in each other
    return {
        "title": case.title,
        "size": _short(size),
        "layered": case.layered,
        "apart": {"far": _short(far), "first": 0.0 if built else _short(_ROOM * tallest / far)},
        "links": [_link(case, link, bodies.get(link, []), ranks[link], size) for link in case.links],
        "pins": _pins(case, ranks, size),
        "loads": _loads(case),
        "drive": _drive(case),
        "springs": _springs(case),
        "motion": _motion(case, poses),
        "values": [_values(found) for found in values],
        "colours": [colour.removeprefix("#") for colour in COLOURS],
        "layers": LAYERS,
        "view": {"toward": TOWARD, "up": (0.0, 1.0, 0.0)},
    }


def _short(value: float) -> float:
    """Return a number with as many digits as are seen."""
    return float(f"{value:.6g}")


def _size(place: Placement) -> float:
    """Return the greatest extent of all points over the poses [mm]."""
    at = [place.position(link, point) for link, record in place.linkage.links.items() for point in record.points]
    every = np.concatenate([np.atleast_1d(z) for z in at])
    return max(float(np.ptp(every.real)), float(np.ptp(every.imag)), 1e-9)


def _ranks(case: Case, place: Placement) -> dict[str, list[int]]:
    """Return link -> how many steps each of its plates moves along z when the layers are pulled apart.

    Without layers no link has a height of its own: each gets the lowest step at which no link stands that it meets, at
    a joint or because they cross at some pose. Links in a fork stay where the fork is. Plates of pairs lie on either
    side of all single links.
    """
    if case.layered:
        heights = sorted({round(z, 9) for link in case.links for z in levels(case, link)})
        return {link: [heights.index(round(z, 9)) for z in levels(case, link)] for link in case.links}
    forked = {frozenset(joint.links) for name, joint in case.joints.items() if outer_link(case, name) is not None}
    paired = {link: len(levels(case, link)) > 1 for link in case.links}
    found: dict[str, int] = {}
    for link in case.links:
        others = [(other, frozenset((link, other))) for other in found if paired[other] == paired[link]]
        taken = {found[other] for other, pair in others if pair not in forked and _meet(case, place, pair)}
        found[link] = next(k for k in range(len(taken) + 1) if k not in taken)
    most = max((step for link, step in found.items() if not paired[link]), default=0)
    return {link: [-1 - step, most + 1 + step] if paired[link] else [step] for link, step in found.items()}


def _meet(case: Case, place: Placement, pair: frozenset[str]) -> bool:
    """Return True for two links that share a joint, or whose lines cross at some pose."""
    import shapely

    if any(pair == set(joint.links) for joint in case.joints.values()):
        return True
    lines = []
    if not all(case.linkage.links[link].pieces for link in pair):
        return False  # a single point crosses nothing
    for link in pair:
        ends = [[place.position(link, point) for point in piece] for piece in case.linkage.links[link].pieces]
        z = np.moveaxis(np.array(ends), -1, 0)  # (poses, pieces, ends)
        lines.append(shapely.multilinestrings(shapely.linestrings(np.stack([z.real, z.imag], axis=-1))))
    return bool(shapely.intersects(*lines).any())


def _link(case: Case, link: str, plates: Sequence[PlateBody], ranks: Sequence[int], size: float) -> dict[str, Any]:
    """Return a link: its plates, or without a part the lines between its points."""
    record = case.links[link]
    height = f"mid-plane at z = {plain(_short(case.heights[link]))} mm"
    layer = f"layer {record.layer}, {height}" if record.layer is not None else height
    pieces = [[np.array(record.points[p]) for p in ends] for ends in case.linkage.links[link].pieces]
    longest = max(pieces, key=lambda ends: float(np.linalg.norm(ends[1] - ends[0])), default=[np.zeros(2)] * 2)
    found: dict[str, Any] = {
        "name": link,
        "along": [_short(v) for at in longest for v in at],
        "ground": link == case.linkage.ground,
        "layer": layer if case.layered else "",
        "plates": [_plate(plate, rank) for plate, rank in zip(plates, ranks, strict=False)],
    }
    if not plates:
        ends = [[_short(v) for at in ends for v in at] for ends in pieces]
        points = [[_short(v) for v in at] for at in record.points.values()]
        found["lines"] = {
            "ends": ends,
            "points": points,
            "z": _short(case.heights[link]),
            "radius": _short(_BARE * size / 2.0),
        }
        found["lines"]["rank"] = ranks[0]
    return found


def _plate(plate: PlateBody, rank: int) -> dict[str, Any]:
    """Return the faces of the material about one mid-plane: rings of corners, walls and caps that name them."""
    rings: list[Real] = []
    walls: list[list[Any]] = []
    caps: list[list[Any]] = []
    for s in plate.slabs:
        walls += [[_add(rings, polygon), _short(s.low), _short(s.high)] for polygon in _polygons(s.area)]
        for z, up, faces in ((s.low, 0, s.below), (s.high, 1, s.above)):
            caps += [[_add(rings, polygon), _short(z), up] for polygon in _polygons(faces)]
    corners = np.vstack([*rings, np.zeros((0, 2))])
    return {
        "rank": rank,
        "counts": [len(ring) for ring in rings],
        "corners": quantised(corners) if rings else None,
        "walls": walls,
        "caps": caps,
        "rods": [[_short(v) for v in (*r.start, plate.plane, r.angle, r.length, r.radius, r.bore)] for r in plate.rods],
    }


def _polygons(area: Any) -> list[list[Real]]:
    """Return the polygons of an area as lists of rings, the outer one first, each without its last corner."""
    import shapely
    from shapely.geometry.polygon import orient

    parts = [orient(p) for p in shapely.get_parts(area) if p.geom_type == "Polygon" and not p.is_empty]
    return [[np.asarray(ring.coords)[:-1] for ring in (p.exterior, *p.interiors)] for p in parts]


def _add(rings: list[Real], polygon: Sequence[Real]) -> list[int]:
    """Return the numbers of a polygon's rings, each of which is kept once."""
    found = []
    for ring in polygon:
        same = (k for k, known in enumerate(rings) if known.shape == ring.shape and np.array_equal(known, ring))
        k = next(same, len(rings))
        if k == len(rings):
            rings.append(ring)
        found.append(k)
    return found


def _pins(case: Case, ranks: Mapping[str, Sequence[int]], size: float) -> list[dict[str, Any]]:
    """Return the pins: cylinders from the lowest face to the highest of the links that each joins."""
    found = []
    for names in on_one_axis(case):
        own = [name for name in names if case.joints[name].kind.has_pin]
        if not own:
            continue
        links = list(dict.fromkeys(link for name in own for link in case.joints[name].links))
        faces = {link: slab(case, link) for link in links}
        low, high = min(faces.values())[0], max(f[1] for f in faces.values())
        steps = [rank for link in links for rank in ranks[link]]
        joint = case.joints[own[0]]
        link, point = joint.links[1], case.linkage.joint_points(own[0])[1]
        diameters = [d for name in own if (d := case.joints[name].pin_diameter) is not None]
        radius = max(diameters) / 2.0 if diameters else _BARE * size / 2.0
        told = f"pin {', '.join(own)}, " + (
            f"diameter {plain(_short(2.0 * radius))} mm" if diameters else "diameter not stated"
        )
        if all(case.joints[name].clamped for name in own):
            held = joint.clamp_length
            told = f"clamp {', '.join(own)}" + ("" if held is None else f" over {plain(_short(held))} mm")
        found.append(
            {
                "names": own,
                "text": f"{told}: joins {', '.join(links)}",
                "link": link,
                "at": [_short(v) for v in case.links[link].points[point]],
                "radius": _short(radius),
                "low": _short(low),
                "high": _short(high),
                "steps": [min(steps), max(steps)],
            }
        )
    return found


def _loads(case: Case) -> list[dict[str, Any]]:
    """Return the stated forces, as arrows at the points of links."""
    found, several = [], len(case.load_cases) > 1
    for name, load_case in case.load_cases.items():
        told = f", {name}" if several else ""
        if load_case.rows and case.cycle is not None:  # which changes, while arrows do not
            told += f" at {plain(case.cycle.instant)} % of the cycle"
        for load in (*stated_loads(case, load_case.model_copy(update={"air": ()})), *_on_lines(case, load_case)):
            if isinstance(load, PointLoad):
                force, (x, y) = load.wrench[:3], case.links[load.link].points[load.point]
            elif isinstance(load, LineLoad):
                force, x, y = load.force, (load.start + load.end) / 2.0, 0.0
            else:
                continue
            size = float(np.linalg.norm(force))
            if size > 0.0:
                found.append(
                    {
                        "case": name,
                        "link": load.link,
                        "place": [_short(x), _short(y)],
                        "force": [_short(float(v)) for v in force],
                        "turns": load.axes == "link",
                        "text": f"{plain(float(f'{size:.4g}'))} N{told}",
                    }
                )
    return found


def _on_lines(case: Case, load_case: LoadCase) -> Iterator[PointLoad]:
    """Yield the loads of load lines where they enter, in axes of their link where the line turns with it."""
    place = case.stated_pose.placement
    for line in load_case.load_lines:
        for load in ForceOnLine(line).loads(place):
            yield in_axes(load, line.axes, place) if load.link == line.link else load


def _drive(case: Case) -> dict[str, Any] | None:
    """Return which link is driven, and where; None where nothing is."""
    drive = None if case.pose.equilibrium else case.pinned_drive
    if drive is None:
        return None
    x, y = case.links[drive.link].points[case.linkage.point_of(drive.joint, drive.link)]
    return {"link": drive.link, "joint": drive.joint, "at": [_short(x), _short(y)]}


def _springs(case: Case) -> list[dict[str, Any]]:
    """Return springs and tendons: kind, and the points of links from one end to the other."""
    return [
        {"name": mark.name, "kind": mark.kind, "route": [_fastened(case, *end) for end in mark.ends]}
        for one in lasting(case)
        for mark in one.marks(case.stated_pose.placement)
    ]


def _fastened(case: Case, link: str, point: str) -> dict[str, Any]:
    """Return a point at which something is fastened, in the frame of its link."""
    return {"link": link, "at": [_short(v) for v in case.links[link].points[point]]}


def _motion(case: Case, poses: Poses) -> dict[str, Any]:
    """Return the frames of the moving links at all poses, pose by pose."""
    place, moving = poses.place, list(case.linkage.moving)
    frames = [column for link in moving for column in _frame(place, link)]
    return {
        "links": moving,
        "texts": list(poses.texts),
        "first": poses.first,
        "start": poses.start,
        "returns": poses.returns,
        "frames": quantised(np.column_stack(frames)) if moving else None,
    }


def _frame(place: Placement, link: str) -> tuple[Real, Real, Real]:
    """Return direction [rad] and origin x, y [mm] of a link at n poses; the direction goes on where it passes 180°."""
    origin = place.origin(link)
    return np.unwrap(np.angle(place.direction(link))), origin.real, origin.imag


def _values(found: Values) -> dict[str, Any]:
    """Return the values as numbers of four digits, None where there is none."""
    every = np.concatenate([np.ravel(v) for of in (found.links, found.pins) for v in of.values()] or [np.zeros(0)])
    known = every[np.isfinite(every)]
    top = found.top or float(known.max(initial=0.0)) or 1.0
    return {
        "label": found.label,
        "title": found.title,
        "unit": found.unit,
        "top": _digits(top),
        "beyond": bool(known.max(initial=0.0) > top),
        "links": {link: [_digits(v) for v in np.ravel(values)] for link, values in found.links.items()},
        "pins": {joint: [_digits(v) for v in np.ravel(values)] for joint, values in found.pins.items()},
        "texts": dict(found.texts),
        "along": {
            link: {
                "ends": [_short(along.first), _short(along.last)],
                "stretches": along.values.shape[1],
                "shades": shades(along.values / top),
            }
            for link, along in found.along.items()
        },
    }


def _digits(value: float) -> float | None:
    """Return a number with four digits; None for one that is not known."""
    return float(f"{value:.4g}") if math.isfinite(value) else None
