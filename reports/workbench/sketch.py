"""What is drawn of a case that is not whole yet: places of its links as they were drawn, without pose, forces or parts."""

import itertools
import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.reports.workbench.moves import Plane, size

Plain = dict[str, Any]

_BAR = 0.022
"""Width of a link, as a share of the linkage's size: that of the drawings of reports."""


def sketched(tables: Mapping[str, Any]) -> Plain | None:
    """Return what is drawn of a case that cannot be solved.

    Parameters
    ----------
    tables : mapping
        Of the case file.

    Returns
    -------
    dict
        As of ``alula.reports.workbench.drawn.drawn``, with ``sketch`` true; None where links or joints cannot be read.
    """
    try:
        plane = Plane(tables)
        places = {key: plane.place(*key) for key in plane.local}
        corners = np.array([[at.real, at.imag] for at in places.values()]).reshape(-1, 2)
        extent = float(np.linalg.norm(np.ptp(corners, axis=0))) if len(corners) else 0.0
        cases = tables.get("load_cases", {})
        return {
            "links": [_link(plane, name, extent) for name in plane.links],
            "joints": [_joint(plane, name) for name in plane.joints if plane.ends(name)[1] in places],
            "loads": [load for name, one in cases.items() for load in _loads(plane, name, one)],
            "springs": [],
            "coordinate": None,
            "drive": None,
            "size": extent or 100.0,
            "load_cases": list(cases),
            "sketch": True,
        }
    except (CaseError, AttributeError, LookupError, TypeError, ValueError):  # tables of any form
        return None


def _link(plane: Plane, name: str, extent: float) -> Plain:
    record, (origin, angle) = plane.links[name], plane.frames[name]
    own, arms = [point for link, point in plane.local if link == name], record.get("arms", {})
    chain = [point for point in own if point not in arms]
    return {
        "name": name,
        "ground": name == plane.ground,
        "part": record.get("part"),
        "layer": record.get("layer"),
        "angle": math.degrees(angle),
        "origin": [origin.real, origin.imag],
        "straight": plane.straight(name),
        "points": [{"name": point, "at": _pair(plane.place(name, point)), "local": _pair(plane.local[name, point])} for point in own],
        "pieces": [*map(list, itertools.pairwise(chain)), *([foot, point] for point, foot in arms.items())],
        "width": _width(plane, record) or _BAR * extent,
        "thickness": 0.0,
        "outline": None,
        "holes": [],
    }


def _width(plane: Plane, record: Mapping[str, Any]) -> float:
    part = plane.tables.get("parts", {}).get(record.get("part"), {})
    with suppress(CaseError):
        return size(part.get("width", part.get("outer_diameter", "0 mm")), "length")
    return 0.0


def _joint(plane: Plane, name: str) -> Plain:
    joint = plane.joints[name]
    return {
        "name": name,
        "kind": {"pin-in-slot": "slot", "slider": "slider"}.get(joint.type, "bonded" if joint.fixed else "pin"),
        "links": list(joint.links),
        "at": _pair(plane.place(*plane.ends(name)[1])),
        "way": None,
        "diameter": joint.pin_diameter,
    }


def _loads(plane: Plane, name: str, stated: Mapping[str, Any]) -> Iterator[Plain]:
    for i, load in enumerate(stated.get("forces", ())):
        link, point = load["link"], load["at"]
        if (link, point) in plane.local:
            vector = complex(*(size(one, "force") for one in load["force"][:2]))
            axes = load.get("axes", "global")
            turned = vector * complex(math.cos(angle := plane.frames[link][1]), math.sin(angle)) if axes == "link" else vector
            yield {
                "path": ["load_cases", name, "forces", i],
                "load_case": name,
                "kind": "force",
                "link": link,
                "point": point,
                "at": _pair(plane.place(link, point)),
                "vector": _pair(turned),
                "moment": 0.0,
                "axes": axes,
            }


def _pair(at: complex) -> list[float]:
    return [at.real, at.imag]
