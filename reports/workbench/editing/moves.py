"""Moves of pins and points: the sizes and directions that their links then have.

A joint's place is that of all points which its pin, and pins through the same hole, bring together: a node.
"""

import cmath
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.loads.stated.part_points import KINDS
from alula.reports.workbench.editing.plane import SAME, Frame, Plane, Point, size, told
from alula.reports.workbench.editing.toml_text import Path, TomlText, value_at


def move(draft: TomlText, plane: Plane, key: Point, to: complex) -> None:
    """Let a point, with all that its pin joins, stand at another place of the pose; other joints stay where they are.

    Points of plates, of the ground and of links without a part take the place in the frame of their link. A straight
    link keeps its points on its axis: with one other joint it gets a new length and a new direction, and its points
    without a joint keep their distance from that joint. Where three or more joints stand on one axis, the others give
    way by about as little as keeps them in line (joints of the ground do not), so these alone are not where they were.
    Where that cannot be, and on a guide, the joint itself stands at the nearest place that it can have; so does a load
    point on the axis of a link that two joints hold. Slots and rows of holes follow the origin of their link; centroids
    of masses and spans of wings stay as they are stated.

    Parameters
    ----------
    draft : TomlText
        The case.
    plane : Plane
        Where its links lie.
    key : tuple of str
        Link and point.
    to : complex
        The place [mm].

    Raises
    ------
    CaseError
        For points that come from the file of a part, and where a link would have no length.
    """
    at = {one: plane.at[one] for one in plane.node.values()}
    root, links = plane.node[key], {link for link, point in plane.local if plane.node[link, point] == plane.node[key]}
    for link in links:
        if plane.shapes[link] in KINDS:
            raise CaseError(f"links.{link}.points: they come from the file of its part; move the bore in that file")
    pins = {plane.node[end] for name in plane.joints for end in plane.ends[name] if end in plane.local}
    axes = {link: _axis(plane, link, pins | {root}) for link in plane.links if link in plane.straight}
    if root not in pins and len(axes.get(key[0], ())) > 2:  # a load point: it slides along the axis of its link
        angle = cmath.rect(1.0, plane.frames[key[0]][1])
        to = at[root] + angle * ((to - at[root]) / angle).real
        _write(draft, plane, key, plane.local[key] + ((to - at[root]) / angle).real)
        return
    new = _settled(plane, at, axes, root, to)
    frames = dict(plane.frames)
    for link in plane.links:
        if any(abs(new[plane.node[key]] - at[plane.node[key]]) > SAME for key in plane.local if key[0] == link):
            frames[link] = _reshaped(draft, plane, link, axes.get(link), at, new)
    _turned(draft, plane, frames, new)


def _axis(plane: Plane, link: str, nodes: set[Point]) -> list[Point]:
    """Return the joints on the axis of a straight link, and the point that is moved, by their place along it."""
    arms = plane.links[link].get("arms", {})
    own = [key for key in plane.local if key[0] == link and key[1] not in arms and plane.node[key] in nodes]
    return sorted((key for key in own if abs(plane.local[key].imag) < SAME), key=lambda key: plane.local[key].real)


def _settled(
    plane: Plane, at: Mapping[Point, complex], axes: Mapping[str, list[Point]], root: Point, to: complex
) -> dict[Point, complex]:
    """Return all nodes after one was moved: near places that keep joints in line, by Newton's steps of least norm."""
    names, held = list(at), {plane.node[key] for key in plane.local if key[0] == plane.ground}
    held |= {plane.node[key] for key in plane.local if plane.shapes[key[0]] in KINDS}
    lines: list[tuple[int, int, int, complex | None]] = []
    for axis in axes.values():
        first, *middles, last = (names.index(plane.node[key]) for key in axis) if len(axis) > 2 else (0, 0)
        lines += [(first, last, middle, None) for middle in middles]
    for name, joint in plane.joints.items():
        (carrier, slot), pin = plane.ends[name]
        fixed = joint.slides and (carrier == plane.ground or joint.fixes_angle)
        if fixed and {(carrier, slot), pin} <= plane.local.keys():
            way = cmath.rect(1.0, plane.frames[carrier][1] + joint.direction)
            first, second = names.index(plane.node[carrier, slot]), names.index(plane.node[pin])
            lines.append((first, first, second, way))
    start = np.array([to if name == root else at[name] for name in names])

    def off(z: Any) -> tuple[Any, Any]:
        gaps, slopes = np.zeros(len(lines)), np.zeros((len(lines), 2 * len(names)))
        for row, (first, last, middle, way) in enumerate(lines):
            u, v = way or z[last] - z[first], z[middle] - z[first]
            length = abs(u) or 1.0
            gaps[row] = (u.conjugate() * v).imag / length
            for n, by in ((middle, 1j * u / length), (last, 0j if way else -1j * v / length)):
                slopes[row, 2 * n : 2 * n + 2] += by.real, by.imag
                slopes[row, 2 * first : 2 * first + 2] -= by.real, by.imag
        return gaps, slopes

    for still in ({*held, root}, held - {root}):
        z, free = start.copy(), np.repeat([name not in still for name in names], 2)
        for _ in range(20):
            gaps, slopes = off(z)
            if np.max(np.abs(gaps), initial=0.0) < 1e-10:
                return dict(zip(names, map(complex, z), strict=True))
            step = np.zeros(2 * len(names))
            step[free] = np.linalg.lstsq(slopes[:, free], -gaps, rcond=1e-9)[0]
            z = z + step[::2] + 1j * step[1::2]
    raise CaseError("edit: the joint cannot stand there with straight links and its guide; move another")


def _reshaped(
    draft: TomlText,
    plane: Plane,
    link: str,
    axis: list[Point] | None,
    at: Mapping[Point, complex],
    new: Mapping[Point, complex],
) -> Frame:
    """Write the points of a link whose joints moved; return its new frame."""
    own = {key: plane.node[key] for key in plane.local if key[0] == link}
    origin, angle = plane.frames[link]
    shift, slid = 0j, 0.0
    if link != plane.ground:
        zero = next((key for key in axis or own if abs(plane.local[key]) < SAME), None)
        if axis and len(axis) > 1:
            span = new[own[axis[-1]]] - new[own[axis[0]]]
            if abs(span) < SAME:
                raise CaseError(f"links.{link}: it would have no length; move the joint elsewhere")
            angle += math.remainder(cmath.phase(span) - angle, math.tau)
            still = min(axis, key=lambda key: abs(new[own[key]] - at[own[key]]))
            base = zero or still
            origin = new[own[base]] - plane.local[base] * cmath.rect(1.0, angle)
            shift = (new[own[still]] - origin) / cmath.rect(1.0, angle) - plane.local[still]
            slid = shift.real
        elif axis:
            origin = new[own[axis[0]]] - plane.local[axis[0]] * cmath.rect(1.0, angle)
        elif zero:
            slid = ((origin - new[own[zero]]) / cmath.rect(1.0, angle)).real
            origin = new[own[zero]]
    held = {end for ends in plane.ends.values() for end in ends}
    for key, node in own.items():
        there = (new[node] - origin) / cmath.rect(1.0, angle)
        if axis is not None and key in axis:
            there = complex(there.real)
        elif axis is not None and (abs(plane.local[key].imag) < SAME or key not in held):
            there = plane.local[key] + shift.real
        _write(draft, plane, key, there)
    for entry in (("slots", point) for point in plane.links[link].get("slots", {})):
        _shifted(draft, ("links", link, *entry), slid)
    for number in range(len(plane.links[link].get("holes", ()))):
        _shifted(draft, ("links", link, "holes", number), slid)
    return origin, angle


def _write(draft: TomlText, plane: Plane, key: Point, local: complex) -> None:
    path = ("links", key[0], "points", key[1])
    old = value_at(draft.tables, path) or (None, None)
    draft.put(path, [told(value, "length", like) for value, like in zip((local.real, local.imag), old, strict=True)])


def _shifted(draft: TomlText, path: Path, by: float) -> None:
    """Move a slot or a row of holes along its link, whose origin moved."""
    for end in ("first", "last"):
        if (old := value_at(draft.tables, (*path, end))) is not None and abs(by) > SAME:
            draft.put((*path, end), told(size(old, "length", (*path, end)) + by, "length", old))


def _turned(draft: TomlText, plane: Plane, frames: Mapping[str, Frame], new: Mapping[Point, complex]) -> None:
    """Write the directions of links that turned: the pose's, rough ones, and fixed angles between links."""
    pose = draft.tables.get("pose", {})
    for link, (_, angle) in frames.items():
        turn = angle - plane.frames[link][1]
        if abs(turn) < 1e-10:
            continue
        if link == pose.get("coordinate") and "travel" not in pose:
            old = pose.get("angle", "0 deg")
            exact = size(old, "angle", ("pose", "angle")) + turn if not pose.get("equilibrium") else angle
            draft.put(("pose", "angle"), told(exact, "angle", old))
        elif (old := pose.get("near", {}).get(link)) is not None:
            rough = size(old, "angle", ("pose", "near", link))
            rough += math.remainder(angle - rough, math.tau)
            digits = len(str(old).partition(".")[2].split(" ")[0])
            if "deg" in str(old):
                rough = math.radians(round(math.degrees(rough), digits))
            draft.put(("pose", "near", link), told(rough, "angle", old))
    for name, joint in plane.joints.items():
        (first, slot), (second, pin) = plane.ends[name]
        if not {(first, slot), (second, pin)} <= plane.local.keys():
            continue
        was = plane.frames[second][1] - plane.frames[first][1]
        turn = frames[second][1] - frames[first][1] - was
        if joint.fixes_angle and abs(turn) > 1e-10:
            old = value_at(draft.tables, ("joints", name, "angle"))
            draft.put(("joints", name, "angle"), told(joint.angle + turn, "angle", old))
        if name == pose.get("coordinate") and "travel" in pose:
            way = cmath.rect(1.0, frames[first][1] + joint.direction)
            travel = ((new[plane.node[second, pin]] - new[plane.node[first, slot]]) / way).real
            draft.put(("pose", "travel"), told(travel, "length", pose["travel"]))


def lengthen(draft: TomlText, plane: Plane, link: str, points: tuple[str, str], value: str) -> None:
    """Set the distance of two points of a link: the second moves on their line; the pose follows.

    A first point is moved in its stead where the second is the origin of the link's frame.

    Parameters
    ----------
    draft : TomlText
        The case.
    plane : Plane
        Where its links lie.
    link : str
        Name of the link.
    points : tuple of str
        Names of the points.
    value : str
        The length with its unit.

    Raises
    ------
    CaseError
        For a length that is none, or of a link whose points come from a file.
    """
    first, second = ((link, point) for point in points)
    plane.place(*first), plane.place(*second)
    if plane.shapes[link] in KINDS:
        raise CaseError(f"links.{link}.points: they come from the file of its part; change the length in that file")
    if abs(plane.local[second]) < SAME:
        first, second = second, first
    span, length = plane.local[second] - plane.local[first], size(value, "length", ("links", link))
    if length <= 0.0 or abs(span) < SAME:
        raise CaseError(f'links.{link}: the length must be greater than zero; write for example "40 mm"')
    path, old = ("links", link, "points", second[1]), plane.local[second]
    if abs(plane.local[first]) < SAME and abs(old.imag) < SAME and old.real > 0.0:
        draft.put((*path, 0), value)
    else:
        _write(draft, plane, second, plane.local[first] + span / abs(span) * length)


def turn(draft: TomlText, to: float) -> None:
    """Set the coordinate of the pose.

    Parameters
    ----------
    draft : TomlText
        The case.
    to : float
        Angle [deg], or travel [mm] where the coordinate is that of a slider.

    Raises
    ------
    CaseError
        Where the pose has no coordinate.
    """
    pose = draft.tables.get("pose", {})
    if "coordinate" not in pose:
        raise CaseError("pose.coordinate: the pose has none, so nothing can be turned; name a link there")
    if "travel" in pose:
        draft.put(("pose", "travel"), told(to, "length", pose["travel"]))
    else:
        draft.put(("pose", "angle"), told(math.radians(to), "angle", pose.get("angle")))
