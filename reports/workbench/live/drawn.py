"""What is drawn of a case in its pose: links, joints, loads, springs, and joint forces, as plain data.

Lengths in mm, forces in N, angles in degrees, moments in N·mm; places in global axes unless said.
"""

import cmath
import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from alula.fea.standing.case_statics import CaseStatics
from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import BODY_WEIGHT, parse, weight_of
from alula.geometry.bodies.body import Body
from alula.geometry.clearance.shape import link_shape
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link
from alula.geometry.linkage.pose import Pose
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.case.case import Case
from alula.loads.records.aero import shares
from alula.loads.records.applied import BodyForce, LineLoad, in_axes
from alula.loads.records.load_case import LoadCase, PointForce, vector3
from alula.loads.states.actions import bounds, lasting, stated_loads
from alula.loads.states.rubbing import is_of
from alula.reports.figures.sprung import mark_line
from alula.reports.words.numbers import number
from alula.reports.workbench.editing.plane import Frame, Plane

Real = NDArray[np.float64]
Plain = dict[str, Any]

_BAR = 0.022
"""Width of a link without part, as a share of the linkage's size: that of the drawings of reports."""
_FINE = 5e-4
"""Share of a part's length by which its outline may lie off: less than a pixel where it fills the window."""


def drawn(case: Case, pose: Pose, statics: CaseStatics | None = None) -> Plain:
    """Return what is drawn of a case.

    The outline of a link, and the holes in it, stand in its own frame: turned by ``angle`` and shifted to ``origin``.

    Parameters
    ----------
    case : Case
    pose : Pose
        In which it is drawn.
    statics : CaseStatics, optional
        Tells what links weigh, and how springs stand in a pose that balances by itself.

    Returns
    -------
    dict
        Plain data: links, joints, loads, springs, coordinate, size and the names of load cases.
    """
    linkage, load_cases = pose.linkage, (case if statics is None else statics.case).load_cases
    whole = _size([complex(*pose.position(link, point)) for link, one in case.links.items() for point in one.points])
    frames = {link: (complex(*pose.origins[link]), pose.angles[link]) for link in case.links}
    ends = {name: (joint.links[1], linkage.joint_points(name)[1]) for name, joint in linkage.joints.items()}
    links = [_link(name, one, frames[name], whole, case) for name, one in case.links.items()]
    joints = [
        _joint(name, linkage.joints[name], complex(*pose.position(*end)), complex(pose.placement.along(name)))
        for name, end in ends.items()
    ]
    loads = [load for name, one in load_cases.items() for load in _loads(case, pose, name, one, statics)]
    standing = {"springs": _springs(case, pose, whole, statics), "coordinate": _coordinate(case, pose)}
    return {"links": links, "joints": joints, "loads": loads, **standing, "size": whole, "load_cases": [*load_cases]}


def drawn_loosely(tables: Mapping[str, Any], case: Case | None = None) -> Plain | None:
    """Return what is drawn of a case of which no pose can be solved: links where they lie as far as it is stated.

    Parameters
    ----------
    tables : mapping
        Of the case, whole or not.
    case : Case, optional
        Where they make one: then links have the outlines of their parts.

    Returns
    -------
    dict or None
        As ``drawn``, without springs; None where links, points and joints cannot be read.
    """
    try:
        plane, pose = Plane(tables), tables.get("pose", {})
        links = {name: Link.model_validate(one) for name, one in plane.links.items()}
        joints, frames, at = plane.joints, plane.frames, plane.at
        ends = {name: end for name, (_, end) in plane.ends.items()}
        kind, dimension = ("travel", "length") if "travel" in pose else ("angle", "angle")
        value = parse(pose.get(kind, "0 deg"), dimension) if pose.get("coordinate") else 0.0
        held = {"kind": kind, "value": math.degrees(value) if kind == "angle" else value, "least": None, "most": None}
        weight = {BODY_WEIGHT: weight_of(tables.get("body_mass"))}
        load_cases, whole = tables.get("load_cases", {}), _size([*at.values()])
        return {
            "links": [_link(name, one, frames[name], whole, case) for name, one in links.items()],
            "joints": [
                _joint(name, joint, at[ends[name]], cmath.rect(1.0, frames[joint.links[0]][1] + joint.direction))
                for name, joint in joints.items()
                if ends[name] in at and joint.links[0] in frames
            ],
            "loads": [load for name, one in load_cases.items() for load in _loose_loads(name, one, at, frames, weight)],
            "springs": [],
            "coordinate": {"name": pose["coordinate"], **held} if pose.get("coordinate") else None,
            "size": whole,
            "load_cases": list(load_cases),
        }
    except (CaseError, ValueError, AttributeError, TypeError):  # tables of another form
        return None


def joint_forces(statics: CaseStatics) -> Plain:
    """Return the joint forces of every load case.

    Parameters
    ----------
    statics : CaseStatics

    Returns
    -------
    dict
        Load case -> ``joints``: joint -> ``force`` on the link ``on`` in the plane and ``magnitude``, of all of it; and
        ``drive``: ``torque`` or ``force`` with its link and joint, None where nothing drives.
    """
    found = {}
    for name, reactions in statics.reactions.items():
        drive, driven, (torque, force) = reactions.drive, None, reactions.driving
        if drive is not None and not (drive.stop or drive.idle):
            pushes = drive.coordinate(statics.pose.linkage).slides
            effort = {"force": float(force)} if pushes else {"torque": float(torque)}
            driven = {**effort, "link": drive.link, "joint": drive.joint}
        joints = {
            joint: {"force": one.force[:2].tolist(), "on": one.on, "magnitude": one.magnitude}
            for joint, one in reactions.joints.items()
        }
        found[name] = {"joints": joints, "drive": driven}
    return found


@lru_cache(maxsize=256)
def _outline(body: Body) -> tuple[tuple[tuple[float, float], ...], ...]:
    """Return the borders of a body as it is seen along its pins, with pins, in its link's frame: the largest first."""
    import shapely

    whole = link_shape("", body, [0.0]).polygon
    low_x, low_y, high_x, high_y = whole.bounds
    near = whole.simplify(_FINE * math.hypot(high_x - low_x, high_y - low_y))
    pieces = sorted((one for one in shapely.get_parts(near) if one.geom_type == "Polygon"), key=lambda one: -one.area)
    rings = [ring for piece in pieces for ring in (piece.exterior, *piece.interiors)]
    return tuple(tuple((round(x, 4), round(y, 4)) for x, y in ring.coords) for ring in rings)


def _size(places: list[complex]) -> float:
    return float(np.hypot(np.ptp(np.real(places)), np.ptp(np.imag(places)))) if places else 0.0


def _pair(place: complex) -> list[float]:
    return [place.real, place.imag]


def _link(name: str, record: Link, frame: Frame, whole: float, case: Case | None) -> Plain:
    part = None if record.part is None or case is None else case.part_of(name)
    outline, *holes = (None,) if part is None or case is None else _outline(case.body(name))
    (origin, angle), points = frame, record.points.items()
    return {
        "name": name,
        "ground": record.ground,
        "part": record.part,
        "layer": record.layer,
        "z": 0.0 if case is None else case.heights.get(name, 0.0),
        "angle": math.degrees(angle),
        "origin": _pair(origin),
        "straight": all(abs(y) <= 1e-9 * whole for _, y in record.points.values()),
        "points": [
            {"name": point, "at": _pair(origin + cmath.rect(1.0, angle) * complex(*at)), "local": list(at)}
            for point, at in points
        ],
        "pieces": [list(piece) for piece in record.pieces],
        "width": _BAR * whole if part is None else part.section.width,
        "outline": outline,
        "holes": holes,
    }


def _joint(name: str, joint: Joint, at: complex, way: complex) -> Plain:
    kind = {"pin-in-slot": "slot", "slider": "slider"}.get(joint.type, "pin")
    if joint.fixed:
        kind = "fixed" if joint.clamped else "bonded"
    own = {"name": name, "kind": kind, "links": list(joint.links), "at": _pair(at), "diameter": joint.pin_diameter}
    return own | {"way": _pair(way) if joint.slides else None}


def _coordinate(case: Case, pose: Pose) -> Plain | None:
    if (held := pose.coordinate) is None:
        return None
    spec, told = case.motion, held.measure.told
    ends = None if spec is None or case.motion_coordinate != held else spec.ends
    least, most = (None, None) if ends is None else np.sort(told(ends)).tolist()
    return {"name": held.name, "kind": held.measure.word, "value": float(told(pose.held)), "least": least, "most": most}


def _loads(case: Case, pose: Pose, name: str, stated: LoadCase, statics: CaseStatics | None) -> Iterator[Plain]:
    """Yield what acts under a load case, each with the path of its entry in the file."""
    own = next(one for one in case.load_cases if is_of(name, one))
    kinds = (("force", "forces"), ("moment", "moments"), ("pressure", "pressures"), ("spread", "spread"))
    entries = [(kind, table, i) for kind, table in kinds for i in range(len(getattr(stated, table)))]
    loads = stated_loads(case, stated.model_copy(update={"air": ()}))
    for (kind, *entry), load in zip(entries, loads, strict=True):
        seen, path = in_axes(load, "global", pose.placement), ["load_cases", own, *entry]
        if isinstance(seen, LineLoad):
            at = _at(pose, seen.link, np.array([0.5 * (seen.start + seen.end), 0.0]))
            yield _load(path, name, kind, seen.link, at, seen.force) | {"axes": load.axes}
        else:
            at, point = pose.position(seen.link, seen.point), seen.point
            yield _load(path, name, kind, seen.link, at, seen.wrench, point) | {"axes": load.axes}
    for i, line in enumerate(map(ForceOnLine, stated.load_lines)):
        places = np.array(line.ends(pose.placement))[:, :2]
        for load, at in zip(line.loads(pose.placement), places, strict=False):
            path = ["load_cases", own, "load_lines", i]
            told: Plain = {"line": places.tolist(), "newtons": float(np.linalg.norm(load.wrench[:3]))}
            told["lever"] = [at.tolist(), pose.position(load.link, load.point).tolist()]
            yield _load(path, name, "load line", load.link, at, load.wrench[:3]) | told
    for i, (air, forces) in enumerate(zip(stated.air, case.air_forces(own), strict=True)):
        for patch, share in zip(air.spread, shares(air, case.link_points), strict=True):
            ends = [pose.position(patch.link, p) for p in (patch.at, patch.start, patch.end) if p is not None]
            path, at = ["load_cases", own, "air", i], np.mean(ends, axis=0)
            yield _load(path, name, "air", patch.link, at, share * forces.total, patch.at)
    for body in () if statics is None else statics.loads[name]:
        if isinstance(body, BodyForce):  # own weight, and inertia at a speed
            path, at = ["load_cases", own, "own_weight"], _at(pose, body.link, body.mass.centroid)
            yield _load(path, name, "weight", body.link, at, body.resultant(pose.placement)[:3])


def _loose_loads(
    name: str,
    tables: Mapping[str, Any],
    at: Mapping[tuple[str, str], complex],
    frames: Mapping[str, Frame],
    weight: Mapping[str, float | None],
) -> Iterator[Plain]:
    """Yield the forces of a load case that can be read."""
    for i, stated in enumerate(tables.get("forces", [])):
        try:
            force = PointForce.model_validate(stated, context=dict(weight))
        except ValidationError:
            continue
        if (force.link, force.at) in at:
            place, push = np.array(_pair(at[force.link, force.at])), vector3(force.force)
            if force.axes == "link":
                turned = complex(*push[:2]) * cmath.rect(1.0, frames[force.link][1])
                push = np.array([*_pair(turned), 0.0])
            path = ["load_cases", name, "forces", i]
            yield _load(path, name, "force", force.link, place, push, force.at) | {"axes": force.axes}


def _at(pose: Pose, link: str, local: Real) -> Real:
    return np.asarray(pose.origins[link] + pose.rotation(link) @ local)


def _load(
    path: list[Any], load_case: str, kind: str, link: str, at: Real, wrench: Real, point: str | None = None
) -> Plain:
    what = {"path": path, "load_case": load_case, "kind": kind, "link": link, "point": point, "at": at.tolist()}
    return what | {"vector": wrench[:2].tolist(), "moment": float(wrench[5]) if len(wrench) == 6 else 0.0}


def _springs(case: Case, pose: Pose, whole: float, statics: CaseStatics | None) -> list[Plain]:
    """Return springs, tendons and stops as the drawings of reports show them."""
    standing = case if statics is None else next(iter(statics.standing.values())).case
    marks = [mark for one in (*lasting(standing), *bounds(standing).values()) for mark in one.marks(pose.placement)]
    found = []
    for mark in marks:
        told = f"{number(abs(mark.effort), 3)} {'N·mm' if mark.turns else 'N'}" if mark.effort else "slack"
        line = mark_line(mark, pose, whole).round(4).tolist()
        text = mark.name if mark.kind == "wall" else f"{mark.name}: {told}"
        found.append({"name": mark.name, "kind": mark.kind, "line": line, "text": text})
    return found
