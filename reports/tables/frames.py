"""Which model gave the joint forces, what large displacement changes, and pins: as data and as lines of text."""

import math
from typing import Any

import numpy as np

from fea.frame.joint_forces import PINNED_STATICS
from fea.outcomes.result import CheckResult, LoadCaseResult
from loads.statics.statics import Reactions
from reports.tables.bands import band_record
from reports.words.wording import fixed, number

UNITS = {
    "reactions.wrench": "N; N*mm",
    "large_displacement.span": "mm",
    "large_displacement.linear": "mm",
    "large_displacement.held": "share of the load",
    "large_displacement.buckling": "1",
    "large_displacement.points.displacement": "mm",
    "large_displacement.reactions.wrench": "N; N*mm",
    "large_displacement.reactions.force": "N",
    "large_displacement.reactions.magnitude": "N",
    "large_displacement.drive_torque": "N*mm",
    "large_displacement.drive_force": "N",
    "pins.lever": "mm",
    "pins.moment": "N*mm",
    "pins.bending": "MPa",
    "pins.shear": "MPa",
    "ways_to_hold.displacement": "mm",
    "ways_to_hold.size": "mm",
}


AXES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_ROUNDING = 1e-9


def shown_components(reactions: Reactions) -> tuple[str, ...]:
    """Return the components of the joints' wrenches that a table shows: the plane's, and those beyond it that act.

    In the plane these are Fx and Fy. Fz, Mx and My come with loads out of it, Mz with joints that are bonded.
    """
    wrenches = np.array([joint.wrench for joint in reactions.joints.values()]).reshape(-1, 6)
    sizes = np.abs(wrenches).max(axis=0, initial=0.0)
    force, arm = sizes[:3].max(), reactions.pose.linkage.longest
    acts = sizes > _ROUNDING * np.array([force] * 3 + [force * arm] * 3)
    revolute = [reactions.pose.linkage.joints[name].type == "revolute" for name in reactions.joints]
    turned = np.abs(wrenches[revolute, 5]).max(initial=0.0) > _ROUNDING * force * arm
    spatial = bool(acts[2:5].any())
    shown = {"Fx": True, "Fy": True, "Fz": spatial, "Mx": spatial, "My": spatial, "Mz": bool(turned)}
    return tuple(axis for axis in AXES if shown[axis])


def reaction_records(reactions: Reactions) -> list[dict[str, Any]]:
    """Return every joint's reaction: force in the plane and its size, and the whole wrench."""
    return [
        {
            "joint": joint.joint,
            "on": joint.on,
            "by": joint.by,
            "force": [float(x) for x in joint.force[:2]],
            "magnitude": joint.magnitude,
            "wrench": [float(x) for x in joint.wrench],
        }
        for joint in reactions.joints.values()
    ]


def frame_record(case: LoadCaseResult) -> dict[str, Any]:
    """Return what a load case's ``joint_forces``, ``large_displacement``, ``pins`` and ``ways_to_hold`` are."""
    moved = case.large_displacement
    return {
        "joint_forces": {"model": case.forces.model, "reason": case.forces.reason},
        "large_displacement": {
            "state": moved.state,
            "span": moved.span,
            "linear": moved.linear,
            "where": moved.where,
            "held": moved.held,
            "buckling": None if moved.buckling is None or math.isinf(moved.buckling) else moved.buckling,
            "sentence": moved.sentence,
            "points": [
                {"link": link, "point": point, "displacement": [float(x) for x in d]}
                for (link, point), d in moved.points.items()
            ],
            "reactions": None if moved.reactions is None else reaction_records(moved.reactions),
            "drive_torque": None if moved.reactions is None else moved.reactions.drive_torque,
            "drive_force": None if moved.reactions is None else moved.reactions.drive_force,
        },
        "pins": [
            {
                "joint": joint,
                "lever": pin.lever,
                "moment": band_record(pin.moment),
                "bending": band_record(pin.bending),
                "shear": pin.shear,
            }
            for joint, pin in case.pins.items()
        ],
        "ways_to_hold": [
            {"name": held.name, "displacement": [float(x) for x in held.displacement], "size": held.size}
            for held in case.ways_to_hold
        ],
    }


def frame_lines(result: CheckResult, case: LoadCaseResult) -> list[str]:
    """Return what the terminal says of a load case's joint forces and displacements."""
    lines = []
    if case.forces.model != PINNED_STATICS:
        lines.append(f"Joint forces by a {case.forces.model}: {case.forces.reason}.")
    deformed = case.large_displacement.reactions
    if deformed is not None:
        forces = "  ".join(f"{name} {number(joint.magnitude)}" for name, joint in deformed.joints.items())
        lines.append(f"Joint forces on the deformed shape [N]: {forces}")
        if deformed.drive is not None:
            pushes = deformed.drive.pushes(deformed.pose.linkage)
            what = f"force on the deformed shape: {number(deformed.drive_force)} N"
            if not pushes:
                what = f"torque on the deformed shape: {number(deformed.drive_torque)} N·mm"
            lines.append(f"Drive {what}")
    asked = result.case.ways_to_hold
    if asked is not None:
        ways = [
            f"{held.name}: {', '.join(fixed(float(x), 1) for x in held.displacement)}, total {number(held.size, 3)}"
            for held in case.ways_to_hold
        ]
        if asked.published is not None and asked.load_case in (None, case.name):
            ways.append(f"published: total {number(asked.published, 3)}")
        lines.append(f"Displacement of {asked.at} by the linear frame, x, y, z and total [mm]:\n  " + "\n  ".join(ways))
    return lines
