"""Where the links of a case lie in the plane, also while the case is not whole yet.

Places are complex numbers x + iy [mm].
"""

import cmath
import math
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.pose import Pose, nearest_pose
from alula.loads.stated.part_points import KINDS
from alula.loads.text.explain import sentence
from alula.reports.workbench.editing.toml_text import Path, value_at

Frame = tuple[complex, float]
"""Origin [mm] and angle [rad] of a link's frame."""
Point = tuple[str, str]
"""Link and point."""
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


class Plane:
    """Links and joints of a case in the plane, as far as its tables can be read.

    Attributes
    ----------
    tables, links : mapping
        Of the case, and of its links.
    ground : str
        Name of the ground link, "" where there is none.
    joints : dict of str to Joint
        By name.
    ends : dict of str to tuple of Point
        Joint -> the two points that it brings together.
    local, at : dict of Point to complex
        Places of points in the frame of their link, and in the plane [mm].
    frames : dict of str to Frame
        Link -> where it lies: in the pose, or as ``loose`` says.
    node : dict of Point to Point
        Point -> the first of all that stand at its place, by pins through one hole.
    shapes : dict of str to object
        Link -> the shape of its part, None without one.
    straight : set of str
        Links whose points stand on one line: bars and tubes, and bare links of two points that turn freely.

    Parameters
    ----------
    tables : mapping
        Of the case.
    pose : Pose, optional
        In which the case is shown; where the case has other sizes or another angle by now, it is solved anew.

    Raises
    ------
    CaseError
        Where links, points and joints cannot be read.
    """

    def __init__(self, tables: Mapping[str, Any], pose: Pose | None = None) -> None:
        for table in ("links", "joints"):
            stated = tables.get(table, {})
            if not isinstance(stated, dict) or not all(isinstance(one, dict) for one in stated.values()):
                raise CaseError(f"{table}: they are no tables; correct them in the text first")
        self.tables = tables
        self.links: dict[str, Any] = tables.get("links", {})
        self.ground = next((name for name, link in self.links.items() if link.get("ground") is True), "")
        self.joints: dict[str, Joint] = {}
        self.local: dict[Point, complex] = {}
        for name, one in tables.get("joints", {}).items():
            try:
                self.joints[name] = Joint.model_validate(one)
            except ValidationError as wrong:
                raise CaseError(f"joints.{name}.{sentence(wrong, Joint)}") from None
        for name, link in self.links.items():
            points = link.get("points", {})
            for point, at in points.items() if isinstance(points, dict) else ():
                entry = ("links", name, "points", point)
                if not isinstance(at, list) or len(at) != 2:
                    raise CaseError(f"links.{name}.points.{point}: it must be [x, y]; correct it in the text first")
                self.local[name, point] = complex(*(size(one, "length", entry) for one in at))
        named = {name: joint.points or (name, name) for name, joint in self.joints.items()}
        self.ends = {name: tuple(zip(joint.links, named[name], strict=True)) for name, joint in self.joints.items()}
        self.node = {key: key for key in self.local}
        for name, ends in self.ends.items():
            if not self.joints[name].slides and set(ends) <= self.local.keys():
                first, second = (self.node[end] for end in ends)
                self.node = {key: first if one == second else one for key, one in self.node.items()}
        self.shapes = {name: value_at(tables, ("parts", one.get("part"), "shape")) for name, one in self.links.items()}
        self.straight = {name for name in self.links if name != self.ground and self._straight(name)}
        self.frames = self._posed(pose)
        self.at = {
            (link, point): self.frames[link][0] + cmath.rect(1.0, self.frames[link][1]) * at
            for (link, point), at in self.local.items()
        }

    def _straight(self, link: str) -> bool:
        own = [at for key, at in self.local.items() if key[0] == link]
        free = all(not joint.slides for joint in self.joints.values() if link in joint.links)
        bare = self.shapes[link] is None and free and len(own) == 2 and all(abs(at.imag) < SAME for at in own)
        return bare or self.shapes[link] in ("bar", "tube")

    def place(self, link: str, point: str) -> complex:
        """Return where a point stands.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex
            [mm]

        Raises
        ------
        CaseError
            Where there is no such point.
        """
        if (link, point) not in self.at:
            raise CaseError(f"links.{link}.points.{point}: there is no such point; choose one of the link's points")
        return self.at[link, point]

    def _posed(self, pose: Pose | None) -> dict[str, Frame]:
        """Return the frames of the pose, or of one near it while the case is changed or is not whole."""
        if pose is None or not self._shown(pose):
            frames, stated = self._loose(), self.tables.get("pose", {})
            angles = {name: angle for name, (_, angle) in frames.items()}
            if angles.keys() <= {self.ground}:
                return frames
            if pose is not None:
                angles |= {name: angle for name, angle in pose.angles.items() if name not in stated.get("near", {})}
            try:
                pose = nearest_pose(
                    Linkage({name: Link.model_validate(link) for name, link in self.links.items()}, self.joints),
                    coordinate=stated.get("coordinate"),
                    near=angles,
                    angle=size(stated.get("angle", "0 deg"), "angle"),
                    travel=size(stated["travel"], "length") if "travel" in stated else None,
                )
            except (CaseError, ValidationError, ValueError):  # not whole, or a coordinate that is no link
                pose = None
            if pose is None:
                return frames
        return {name: (complex(*pose.origins[name]), pose.angles[name]) for name in self.links}

    def _shown(self, pose: Pose) -> bool:
        """Whether a pose is of these joints and sizes, but for points that files of parts give, and of this angle."""
        shown = {(name, p): complex(*at) for name, link in pose.linkage.links.items() for p, at in link.points.items()}
        own = {key: at for key, at in self.local.items() if self.shapes[key[0]] not in KINDS}
        if pose.linkage.joints.keys() != self.joints.keys() or pose.linkage.links.keys() != self.links.keys():
            return False
        if not all(key in shown and abs(shown[key] - at) < SAME for key, at in own.items()):
            return False
        stated = self.tables.get("pose", {})
        if stated.get("equilibrium") or pose.coordinate is None:
            return True
        if pose.coordinate.slides:
            return abs(pose.held - size(stated.get("travel", "0 mm"), "length")) < SAME
        return abs(math.remainder(pose.held - size(stated.get("angle", "0 deg"), "angle"), math.tau)) < SAME

    def _loose(self) -> dict[str, Frame]:
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
                known = [end for end in self.ends[name] if end[0] in frames]
                new = [end for end in self.ends[name] if end[0] not in frames]
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
