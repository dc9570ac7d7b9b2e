"""Moves of pins and points: where links lie, and the sizes that their links then have.

Places are complex numbers x + iy [mm]. A joint's place is that of all points which its pin, and pins through the same
hole, bring together; it is one node, and links lie between nodes.
"""

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.case.part_points import KINDS
from alula.loads.text.explain import sentence
from alula.reports.workbench.toml_text import Path, TomlText, value_at

Frame = tuple[complex, float]
"""Origin [mm] and angle [rad] of a link's frame."""
SAME = 1e-7
"""Places that are nearer to each other than this [mm] are one: what is written has nine digits."""


def size(text: object, dimension: str, entry: Path = ()) -> float:
    """Read a length or an angle of the case file.

    Parameters
    ----------
    text : object
        What stands there.
    dimension : str
        Such as "length".
    entry : tuple
        Path, for the message.

    Returns
    -------
    float
        In alula's unit.

    Raises
    ------
    CaseError
        Where it is none.
    """
    try:
        return parse(text, dimension)
    except PydanticCustomError as wrong:
        raise CaseError(f"{'.'.join(map(str, entry))}: {wrong.message()}") from None


def told(value: float, dimension: str, like: object = None) -> str:
    """Write a length or an angle in the unit in which it stood so far, and as it stood where it is alike.

    Parameters
    ----------
    value : float
        In alula's unit.
    dimension : str
        Such as "length".
    like : object
        The text so far.

    Returns
    -------
    str
        With nine digits.
    """
    unit = "deg" if dimension == "angle" else "mm"
    try:
        old = parse(like, dimension)
        if math.isclose(old, value, rel_tol=1e-9, abs_tol=SAME if unit == "mm" else 1e-9):
            return str(like)
        unit = str(like).strip().lstrip("+-0123456789.eE \u2212") or unit
        factor = parse(f"1 {unit}", dimension)
    except PydanticCustomError:
        unit, factor = ("deg", math.radians(1.0)) if dimension == "angle" else ("mm", 1.0)
    return f"{round(value / factor, 9):.9g} {unit}".replace("-0 ", "0 ") if abs(value) > 1e-9 else f"0 {unit}"


@dataclass
class Plane:
    """The links of a case in the plane, as far as its tables can be read.

    Attributes
    ----------
    tables : mapping
        Of the case.
    joints : dict of str to Joint
        By name.
    local : dict of (str, str) to complex
        (link, point) -> its place in the link's frame.
    frames : dict of str to Frame
        Link -> where it lies.
    node : dict of (str, str) to (str, str)
        (link, point) -> the first of all points that stand at one place with it.

    Parameters
    ----------
    tables : mapping
        Of the case.
    pose : Pose, optional
        In which the case is shown; one of other sizes or another angle is solved anew.

    Raises
    ------
    CaseError
        Where links, points and joints cannot be read.
    """

    tables: Mapping[str, Any]
    pose: Pose | None = None
    joints: dict[str, Joint] = field(init=False)
    local: dict[tuple[str, str], complex] = field(init=False)
    frames: dict[str, Frame] = field(init=False)
    node: dict[tuple[str, str], tuple[str, str]] = field(init=False)

    def __post_init__(self) -> None:
        """Read links and joints, and find where they lie."""
        for table in ("links", "joints"):
            stated = self.tables.get(table, {})
            if not isinstance(stated, dict) or not all(isinstance(one, dict) for one in stated.values()):
                raise CaseError(f"{table}: they are no tables; correct them in the text first")
        self.joints = {}
        for name, one in self.tables.get("joints", {}).items():
            try:
                self.joints[name] = Joint.model_validate(one)
            except ValidationError as wrong:
                raise CaseError(f"joints.{name}.{sentence(wrong, Joint)}") from None
        self.local = {}
        for name, link in self.links.items():
            points = link.get("points", {})
            for point, at in points.items() if isinstance(points, dict) else ():
                entry = ("links", name, "points", point)
                if not isinstance(at, list) or len(at) != 2:
                    raise CaseError(f"links.{name}.points.{point}: it must be [x, y]; correct it in the text first")
                self.local[name, point] = complex(*(size(one, "length", entry) for one in at))
        self.node = {key: key for key in self.local}
        for name, joint in self.joints.items():
            ends = self.ends(name)
            if not joint.slides and all(end in self.node for end in ends):
                first, second = (self.node[end] for end in ends)
                self.node = {key: first if one == second else one for key, one in self.node.items()}
        self.frames = self._posed() or self.loose()

    @property
    def links(self) -> Mapping[str, Any]:
        """The tables of the links."""
        found: Mapping[str, Any] = self.tables.get("links", {})
        return found

    @property
    def ground(self) -> str:
        """Name of the ground link, "" where there is none."""
        return next((name for name, link in self.links.items() if link.get("ground") is True), "")

    def ends(self, joint: str) -> tuple[tuple[str, str], tuple[str, str]]:
        """Return the two (link, point) that a joint brings together."""
        record = self.joints[joint]
        first, second = record.points or (joint, joint)
        return (record.links[0], first), (record.links[1], second)

    def place(self, link: str, point: str) -> complex:
        """Return where a point stands [mm]."""
        if (link, point) not in self.local:
            raise CaseError(f"links.{link}.points.{point}: there is no such point; choose one of the link's points")
        origin, angle = self.frames[link]
        return origin + cmath.rect(1.0, angle) * self.local[link, point]

    def pinned(self, link: str, point: str) -> list[str]:
        """Return the joints at a point."""
        return [name for name in self.joints if (link, point) in self.ends(name)]

    def shape(self, link: str) -> object:
        """Return the shape of a link's part; None where it has none."""
        return value_at(self.tables, ("parts", self.links[link].get("part", ""), "shape"))

    def straight(self, link: str) -> bool:
        """Whether a link has its points on one line: bars and tubes, and bare links of two points that turn freely."""
        shape, own = self.shape(link), [key for key in self.local if key[0] == link]
        free = all(not joint.slides for joint in self.joints.values() if link in joint.links)
        bare = shape is None and free and len(own) == 2 and all(abs(self.local[key].imag) < SAME for key in own)
        return link != self.ground and (shape in ("bar", "tube") or bare)

    def _posed(self) -> dict[str, Frame] | None:
        """Return the frames of the pose; None where there is none."""
        pose = self.pose
        if not self.joints:
            return None
        try:
            if pose is None or not self._shown(pose):
                links = {name: Link.model_validate(link) for name, link in self.links.items()}
                stated = self.tables.get("pose", {})
                near = {name: size(one, "angle") for name, one in stated.get("near", {}).items()}
                travel = size(stated["travel"], "length") if "travel" in stated else None
                pose = solve_pose(
                    Linkage(links, self.joints),
                    coordinate=stated.get("coordinate"),
                    angle=size(stated.get("angle", "0 deg"), "angle"),
                    near=near,
                    travel=travel,
                )
        except (CaseError, ValidationError, AttributeError):
            return None
        return {name: (complex(*pose.origins[name]), pose.angles[name]) for name in self.links}

    def _shown(self, pose: Pose) -> bool:
        """Whether a pose is of these links and this angle."""
        record = {(name, p): complex(*at) for name, link in pose.linkage.links.items() for p, at in link.points.items()}
        stated = self.tables.get("pose", {})
        same = record.keys() == self.local.keys() and all(
            abs(record[key] - at) < SAME for key, at in self.local.items()
        )
        imported = any(self.shape(link) in KINDS for link in self.links)
        if stated.get("equilibrium") or pose.coordinate is None or pose.linkage.joints.keys() != self.joints.keys():
            return same
        if pose.coordinate.slides:
            return same and abs(pose.held - size(stated.get("travel", "0 mm"), "length")) < SAME
        turned = pose.held - size(stated.get("angle", "0 deg"), "angle")
        return (same or imported) and abs(math.remainder(turned, math.tau)) < SAME

    def loose(self) -> dict[str, Frame]:
        """Return where links lie as far as it is stated while no pose can be solved.

        Each has its stated angle, or the rough one of ``pose.near``, and hangs by the first joint that leads to it from
        the ground; what hangs nowhere lies at the origin.
        """
        pose = self.tables.get("pose", {})
        angles = {**pose.get("near", {}), pose.get("coordinate"): pose.get("angle", "0 deg")}
        frames = {self.ground: (0j, 0.0)} if self.ground else {}
        waiting = list(self.joints)
        while True:
            for name in waiting:
                known = [end for end in self.ends(name) if end[0] in frames]
                new = [end for end in self.ends(name) if end[0] not in frames]
                if len(known) == len(new) == 1 and all(end in self.local for end in (*known, *new)):
                    break
            else:
                name = next((link for link in self.links if link not in frames), "")
                if not name:
                    return frames
                frames[name] = 0j, size(angles.get(name, "0 deg"), "angle", ("pose", "near", name))
                continue
            waiting.remove(name)
            (link, point), (origin, turn) = new[0], frames[known[0][0]]
            angle = size(angles.get(link, "0 deg"), "angle", ("pose", "near", link))
            at = origin + cmath.rect(1.0, turn) * self.local[known[0]]
            frames[link] = at - cmath.rect(1.0, angle) * self.local[link, point], angle


def loose_positions(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return where links lie while no pose can be solved, for the drawing of a case that is not whole yet.

    Parameters
    ----------
    tables : mapping
        Of the case.

    Returns
    -------
    dict of str to object
        Link -> {"origin": [x, y] in mm, "angle" in rad, "points": {point: [x, y] in mm}}.

    Raises
    ------
    CaseError
        Where links, points and joints cannot be read.
    """
    plane = Plane(tables)
    found = {}
    for link, (origin, angle) in plane.frames.items():
        places = {point: plane.place(link, point) for one, point in plane.local if one == link}
        found[link] = {
            "origin": [origin.real, origin.imag],
            "angle": angle,
            "points": {point: [at.real, at.imag] for point, at in places.items()},
        }
    return found


def move(draft: TomlText, plane: Plane, key: tuple[str, str], to: complex) -> None:
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
    at = {one: plane.place(*one) for one in plane.node.values()}
    root, links = plane.node[key], {link for link, point in plane.local if plane.node[link, point] == plane.node[key]}
    for link in links:
        if plane.shape(link) in KINDS:
            raise CaseError(
                f"links.{link}.points: they come from the file of part '{plane.links[link]['part']}'; move the bore in "
                "that file, or give the link another part"
            )
    pins = {plane.node[end] for name in plane.joints for end in plane.ends(name) if end in plane.local}
    axes = {link: _axis(plane, link, pins | {root}) for link in plane.links if plane.straight(link)}
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


def _axis(plane: Plane, link: str, nodes: set[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the joints on the axis of a straight link, and the point that is moved, by their place along it."""
    arms = plane.links[link].get("arms", {})
    own = [key for key in plane.local if key[0] == link and key[1] not in arms and plane.node[key] in nodes]
    return sorted((key for key in own if abs(plane.local[key].imag) < SAME), key=lambda key: plane.local[key].real)


def _settled(
    plane: Plane,
    at: Mapping[tuple[str, str], complex],
    axes: Mapping[str, list[tuple[str, str]]],
    root: tuple[str, str],
    to: complex,
) -> dict[tuple[str, str], complex]:
    """Return all nodes after one was moved: near places that keep joints in line, by Newton's steps of least norm."""
    names, held = list(at), {plane.node[key] for key in plane.local if key[0] == plane.ground}
    held |= {plane.node[key] for key in plane.local if plane.shape(key[0]) in KINDS}
    lines: list[tuple[int, int, int, complex | None]] = []
    for axis in axes.values():
        first, *middles, last = (names.index(plane.node[key]) for key in axis) if len(axis) > 2 else (0, 0)
        lines += [(first, last, middle, None) for middle in middles]
    for name, joint in plane.joints.items():
        (carrier, slot), pin = plane.ends(name)
        if (
            joint.slides
            and (carrier == plane.ground or joint.fixes_angle)
            and {(carrier, slot), pin} <= plane.local.keys()
        ):
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
            for n, (dx, dy) in {middle: (-u.imag, u.real), last: (v.imag, -v.real)}.items() if not way else ():
                slopes[row, 2 * n : 2 * n + 2] += np.array([dx, dy]) / length
                slopes[row, 2 * first : 2 * first + 2] -= np.array([dx, dy]) / length
            if way:
                slopes[row, 2 * middle : 2 * middle + 2] = -u.imag, u.real
                slopes[row, 2 * first : 2 * first + 2] = u.imag, -u.real
        return gaps, slopes

    for fixed in ({*held, root}, held - {root}):
        z, free = start.copy(), np.repeat([name not in fixed for name in names], 2)
        for _ in range(20):
            gaps, slopes = off(z)
            if np.max(np.abs(gaps), initial=0.0) < 1e-10:
                return dict(zip(names, map(complex, z), strict=True))
            step = np.zeros(2 * len(names))
            step[free] = np.linalg.lstsq(slopes[:, free], -gaps, rcond=1e-9)[0]
            z = z + step[::2] + 1j * step[1::2]
    raise CaseError(
        "edit: the joint cannot stand there while its links stay straight and its guide stays; move another"
    )


def _reshaped(
    draft: TomlText,
    plane: Plane,
    link: str,
    axis: list[tuple[str, str]] | None,
    at: Mapping[tuple[str, str], complex],
    new: Mapping[tuple[str, str], complex],
) -> Frame:
    """Write the points of a link whose joints moved; return its new frame."""
    own = {key: plane.node[key] for key in plane.local if key[0] == link}
    origin, angle = plane.frames[link]
    shift = 0j
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
        elif axis:
            origin = new[own[axis[0]]] - plane.local[axis[0]] * cmath.rect(1.0, angle)
        elif zero:
            origin = new[own[zero]]
    for key, node in own.items():
        there = (new[node] - origin) / cmath.rect(1.0, angle)
        if axis is not None and key in axis:
            there = complex(there.real)
        elif axis is not None and (abs(plane.local[key].imag) < SAME or not plane.pinned(*key)):
            there = plane.local[key] + shift.real
        _write(draft, plane, key, there)
    for entry in (("slots", point) for point in plane.links[link].get("slots", {})):
        _shifted(draft, ("links", link, *entry), shift.real)
    for number in range(len(plane.links[link].get("holes", ()))):
        _shifted(draft, ("links", link, "holes", number), shift.real)
    return origin, angle


def _write(draft: TomlText, plane: Plane, key: tuple[str, str], local: complex) -> None:
    path = ("links", key[0], "points", key[1])
    old = value_at(draft.tables, path) or (None, None)
    draft.put(path, [told(value, "length", like) for value, like in zip((local.real, local.imag), old, strict=True)])


def _shifted(draft: TomlText, path: Path, by: float) -> None:
    """Move a slot or a row of holes along its link, whose origin moved."""
    for end in ("first", "last"):
        if (old := value_at(draft.tables, (*path, end))) is not None and abs(by) > SAME:
            draft.put((*path, end), told(size(old, "length", (*path, end)) + by, "length", old))


def _turned(draft: TomlText, plane: Plane, frames: Mapping[str, Frame], new: Mapping[tuple[str, str], complex]) -> None:
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
        (first, slot), (second, pin) = plane.ends(name)
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
    if plane.shape(link) in KINDS:
        raise CaseError(f"links.{link}.points: they come from the file of its part; change the length in that file")
    first, second = ((link, point) for point in points)
    plane.place(*first), plane.place(*second)
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
