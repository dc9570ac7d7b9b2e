"""What is drawn of a case in its pose: links, joints, loads, springs, and joint forces, as plain data.

Lengths in mm, forces in N, angles in degrees, moments in N·mm; places in global axes unless said.
"""

import math
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.standing.case_statics import CaseStatics
from alula.geometry.bodies.body import Body
from alula.geometry.clearance.shape import link_shape
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.heights import thickness
from alula.loads.records.aero import shares
from alula.loads.records.applied import BodyForce, LineLoad, in_axes
from alula.loads.records.load_case import LoadCase
from alula.loads.states.actions import bounds, lasting, stated_loads
from alula.loads.states.rubbing import is_of
from alula.reports.figures.sprung import mark_line
from alula.reports.words.numbers import number

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
        Plain data: links, joints, loads, springs, coordinate, drive, size and the names of load cases.
    """
    corners = np.array([pose.position(link, point) for link, one in case.links.items() for point in one.points])
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    load_cases = case.load_cases if statics is None else statics.case.load_cases
    return {
        "links": [_link(case, pose, name, size) for name in case.links],
        "joints": [_joint(pose, name) for name in case.joints],
        "loads": [load for name, one in load_cases.items() for load in _loads(case, pose, name, one, statics)],
        "springs": _springs(case, pose, size, statics),
        "coordinate": _coordinate(case, pose),
        "drive": None if case.drive is None else {"link": case.drive.link, "joint": case.drive.joint},
        "size": size,
        "load_cases": list(load_cases),
    }


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
        torque, force = reactions.driving
        drive, driven = reactions.drive, None
        if drive is not None and not (drive.stop or drive.idle):
            effort = (
                {"force": float(force)} if drive.coordinate(statics.pose.linkage).slides else {"torque": float(torque)}
            )
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


def _link(case: Case, pose: Pose, name: str, size: float) -> Plain:
    record = case.links[name]
    part = None if record.part is None else case.part_of(name)
    outline, *holes = (None,) if part is None else _outline(case.body(name))
    return {
        "name": name,
        "ground": record.ground,
        "part": record.part,
        "layer": record.layer,
        "z": case.heights.get(name, 0.0),
        "angle": math.degrees(pose.angles[name]),
        "origin": pose.origins[name].tolist(),
        "straight": all(abs(y) <= 1e-9 * size for _, y in record.points.values()),
        "points": [
            {"name": point, "at": pose.position(name, point).tolist(), "local": list(place)}
            for point, place in record.points.items()
        ],
        "pieces": [list(piece) for piece in record.pieces],
        "width": _BAR * size if part is None else part.section.width,
        "thickness": thickness(record, case.parts),
        "outline": outline,
        "holes": holes,
    }


def _joint(pose: Pose, name: str) -> Plain:
    joint, along = pose.linkage.joints[name], complex(pose.placement.along(name))
    kind = {"pin-in-slot": "slot", "slider": "slider"}.get(joint.type, "pin")
    if joint.fixed:
        kind = "fixed" if joint.clamped else "bonded"
    return {
        "name": name,
        "kind": kind,
        "links": list(joint.links),
        "at": pose.position(joint.links[1], pose.linkage.joint_points(name)[1]).tolist(),
        "way": [along.real, along.imag] if joint.slides else None,
        "diameter": joint.pin_diameter,
    }


def _coordinate(case: Case, pose: Pose) -> Plain | None:
    if (held := pose.coordinate) is None:
        return None
    spec, told = case.motion, held.measure.told
    ends = (None, None) if spec is None or spec.ends is None or case.motion_coordinate != held else spec.ends
    least, most = sorted(ends, key=lambda end: end or 0.0)
    return {
        "name": held.name,
        "kind": held.measure.word,
        "value": float(told(pose.held)),
        "least": None if least is None else float(told(least)),
        "most": None if most is None else float(told(most)),
    }


def _loads(case: Case, pose: Pose, name: str, stated: LoadCase, statics: CaseStatics | None) -> Iterator[Plain]:
    """Yield what acts under a load case, each with the path of its entry in the file."""
    own = next(one for one in case.load_cases if is_of(name, one))
    entries = [
        *(("force", "forces", one.at) for one in stated.forces),
        *(("moment", "moments", one.at) for one in stated.moments),
        *(("pressure", "pressures", one.at) for one in stated.pressures),
        *(("spread", "spread", None) for _ in stated.spread),
    ]
    numbers: dict[str, int] = {}
    loads = stated_loads(case, stated.model_copy(update={"air": ()}))
    for (kind, table, point), load in zip(entries, loads, strict=True):
        i = numbers[table] = numbers.get(table, -1) + 1
        seen = in_axes(load, "global", pose.placement)
        if isinstance(seen, LineLoad):
            at, wrench = (
                _at(pose, load.link, np.array([0.5 * (seen.start + seen.end), 0.0])),
                np.append(seen.force, np.zeros(3)),
            )
        else:
            at, wrench = pose.position(load.link, str(point)), seen.wrench
        yield _load(["load_cases", own, table, i], name, kind, load.link, at, wrench, point) | {"axes": load.axes}
    for i, (air, forces) in enumerate(zip(stated.air, case.air_forces(own), strict=True)):
        for patch, share in zip(air.spread, shares(air, case.link_points), strict=True):
            ends = [pose.position(patch.link, p) for p in (patch.at, patch.start, patch.end) if p is not None]
            at, wrench = np.mean(ends, axis=0), np.append(share * forces.total, np.zeros(3))
            yield _load(["load_cases", own, "air", i], name, "air", patch.link, at, wrench, patch.at)
    for body in () if statics is None else statics.loads[name]:
        if isinstance(body, BodyForce):  # own weight, and inertia at a speed
            force = body.resultant(pose.placement)[:3]
            at = _at(pose, body.link, body.mass.centroid)
            yield _load(
                ["load_cases", own, "own_weight"], name, "weight", body.link, at, np.append(force, np.zeros(3)), None
            )


def _at(pose: Pose, link: str, local: Real) -> Real:
    return np.asarray(pose.origins[link] + pose.rotation(link) @ local)


def _load(path: list[Any], load_case: str, kind: str, link: str, at: Real, wrench: Real, point: str | None) -> Plain:
    return {
        "path": path,
        "load_case": load_case,
        "kind": kind,
        "link": link,
        "point": point,
        "at": at.tolist(),
        "vector": wrench[:2].tolist(),
        "moment": float(wrench[5]),
    }


def _springs(case: Case, pose: Pose, size: float, statics: CaseStatics | None) -> list[Plain]:
    """Return springs, tendons and stops as the drawings of reports show them."""
    standing = case if statics is None else next(iter(statics.standing.values())).case
    found = []
    for one in (*lasting(standing), *bounds(standing).values()):
        for mark in one.marks(pose.placement):
            told = f"{number(abs(mark.effort), 3)} {'N·mm' if mark.turns else 'N'}" if mark.effort else "slack"
            found.append(
                {
                    "name": mark.name,
                    "kind": mark.kind,
                    "line": mark_line(mark, pose, size).round(4).tolist(),
                    "text": mark.name if mark.kind == "wall" else f"{mark.name}: {told}",
                }
            )
    return found
