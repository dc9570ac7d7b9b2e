"""Mechanisms that pylinkage saved: the JSON of its ``mechanism_to_json`` (1.3, ``mechanism/serialization.py``)."""

import json
import math
from collections.abc import Mapping
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.loads.exchange.sketch import MALFORMED, Rider, Sketch, plain_name
from alula.loads.text.explain import printable

_LEGACY = {"Static", "Crank", "Revolute", "Fixed", "Prismatic"}
_SAVE = "save it with pylinkage.mechanism.mechanism_to_json"


def read_pylinkage(text: str, name: str, millimetres: float) -> Sketch:
    """Read a mechanism of pylinkage.

    Parameters
    ----------
    text : str
        Of the file.
    name : str
        Of the file, for sentences.
    millimetres : float
        Length of one of its units, which the file does not state [mm].

    Returns
    -------
    Sketch

    Raises
    ------
    CaseError
        For a file that is no mechanism, has no motor, or no position for a joint.
    """
    try:
        return _read(json.loads(text), name, millimetres)
    except MALFORMED as error:
        raise CaseError(f"'{name}': it is no mechanism of pylinkage ({printable(repr(error))}); {_SAVE}") from None


def _read(data: Mapping[str, Any], name: str, millimetres: float) -> Sketch:
    joints = {joint["id"]: joint for joint in data["joints"]}
    if any(joint.get("type") in _LEGACY for joint in joints.values()):
        raise CaseError(f"'{name}': it is a linkage of pylinkage in its older format; {_SAVE}")
    short: dict[str, str] = {}
    for long in joints:
        short[long] = plain_name(long, list(short.values()))
    points = {short[long]: _place(joint, name) * millimetres for long, joint in joints.items()}
    links: dict[str, list[str]] = {}
    ground = [short[long] for long, joint in joints.items() if joint["type"] == "ground"]
    driven = None
    for link in data["links"]:
        own = [short[long] for long in link["joints"]]
        if link["type"] == "ground":
            ground += [point for point in own if point not in ground]
            continue
        called = plain_name(link["id"], ["ground", *links])
        links[called] = own
        if link["type"] in ("driver", "arc_driver"):
            if driven is not None:
                raise CaseError(
                    f"'{name}': links '{printable(driven[0])}' and '{printable(called)}' have motors; leave one of them"
                )
            driven = called, short[link["motor_joint"]]
    if driven is None:
        raise CaseError(f"'{name}': no link has a motor; make one a DriverLink, since it fixes the pose")
    for long, joint in joints.items():
        if joint["type"] == "tracker":
            ends = {short[joint["ref_joint1_id"]], short[joint["ref_joint2_id"]]}
            own = next(own for own in links.values() if ends <= set(own))
            own += [short[long]] if short[long] not in own else []
    riders = [
        Rider(point=short[long], through=complex(*joint["line_point"]) * millimetres, along=complex(*joint["axis"]))
        for long, joint in joints.items()
        if joint["type"] == "prismatic"
    ]
    return Sketch(
        title=str(data.get("name") or name),
        origin=f"pylinkage, {name}",
        points=points,
        links=links,
        ground=ground,
        driven=driven,
        riders=riders,
    )


def _place(joint: Mapping[str, Any], name: str) -> complex:
    x, y = joint["position"]
    if x is None or y is None or not (math.isfinite(x) and math.isfinite(y)):
        shown = printable(str(joint["id"]))
        raise CaseError(f"'{name}': joint '{shown}' has no position; assemble the mechanism before it is saved")
    return complex(x, y)
