"""What ``alula motion`` found, as plain data for ``result.json``."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.of_motion import MotionFindings
from alula.geometry.base.version import result_stamp
from alula.loads.states.case_motion import with_inertia
from alula.reports.motion.joint_paths import moving_points, path_length
from alula.reports.motion.play import motion_play_record
from alula.reports.motion.rates import QUANTITIES, Series, extremes, finite_or_none, rates_record, series, told
from alula.reports.renderers.record import finite
from alula.reports.sections.air import motion_air_record
from alula.reports.sections.assembly import clearance_record
from alula.reports.sections.friction import motion_friction_record
from alula.reports.tables.frames import motion_linkage_record
from alula.reports.tables.mechanism import design_record

Real = NDArray[np.float64]

UNITS = {
    "angle": "deg",
    "length": "mm",
    "force": "N",
    "moment": "N*mm",
    "time": "s",
    "power": "W",
    "mass": "g",
    **{key: unit.replace("·", "*").replace("²", "^2") for key, unit in QUANTITIES.items()},
}


def record(found: MotionFindings, name: str) -> dict[str, Any]:
    """Return the result of a motion as plain data.

    Parameters
    ----------
    found : MotionFindings
    name : str
        Of the case, as the command was given it.

    Returns
    -------
    dict
        Angles in degrees; unbounded torques are None.
    """
    result = found.moved
    motion, own = result.motion, series(result)
    return {
        **result_stamp(),
        "case": name,
        "title": result.case.title,
        "units": UNITS,
        "motion": {
            "coordinate": motion.coordinate,
            "unit": motion.unit,
            "first": float(motion.told(motion.angles[0])),
            "last": float(motion.told(motion.angles[-1])),
            "poses": len(motion.angles),
            "speed_mm_per_s" if motion.slides else "speed_rad_per_s": [float(motion.speed[0]), float(motion.speed[-1])],
            "duration": None if motion.times is None else float(motion.times[-1]),
            "closure_residual": motion.residual,
            "returns_to_start": motion.returns,
            "inertia": result.case.inert,
            "links": {
                link: {
                    "first": _degrees(motion.angle(link)[0]),
                    "last": _degrees(motion.angle(link)[-1]),
                    "smallest": _degrees(motion.angle(link).min()),
                    "largest": _degrees(motion.angle(link).max()),
                    **_rates(own, "links", link, "angular_speed", "angular_acceleration"),
                }
                for link in motion.linkage.moving
            },
            "points": {
                label: {"path_length": path_length(xy), **_rates(own, "points", label, "speed", "acceleration")}
                for label, xy in moving_points(motion).items()
            },
        },
        "drive": {
            "link": result.drive.link,
            "joint": result.drive.joint,
            "dead_points": [float(result.motion.told(a)) for a in result.dead_points],
            "least_distance": found.dead_point_distance,
            "way_to_dead_point": finite_or_none(float(result.motion.told(found.way_to_dead_point))),
        },
        "design": design_record(result.case),
        "load_cases": {load_case: _case_record(found, load_case) for load_case in result.torque},
        "play": finite(motion_play_record(found), {}),
        "clearance": finite(clearance_record(found.clearance), {}),
        "linkage": {n: finite(motion_linkage_record(result, over), {}) for n, over in found.linkage.items()},
    }


def _rates(own: Series | None, of: str, name: str, *quantities: str) -> dict[str, Any]:
    """Extremes of some rates of a link or point at the motion's own speed; None without one."""
    if own is None:
        return dict.fromkeys(quantities)
    return told(own.motion, {key: getattr(own, of)[name][key] for key in quantities})


def _case_record(found: MotionFindings, load_case: str) -> dict[str, Any]:
    result = found.moved
    moved, power, unbounded = result.moved[load_case], result.power[load_case], bool(result.dead_points)
    speed = result.case.load_cases[load_case].speed or float(moved.speed[0])

    def over(values: Real) -> dict[str, Any]:
        return extremes(result.motion, values, unbounded=unbounded)

    data: dict[str, Any] = {"inertia": with_inertia(result.case, load_case)}
    data |= {"speed_mm_per_s" if result.motion.slides else "speed_rad_per_s": speed}
    data |= {f"drive_{result.effort[0]}": over(result.torque[load_case])}
    if result.rubbing:
        data["friction"] = motion_friction_record(result, found.work[load_case], load_case)
    data["joints"] = None
    if result.forces:
        forces = result.forces[load_case].forces
        data["joints"] = {joint: over(np.linalg.norm(force, axis=1)) for joint, force in forces.items()}
    if np.any(moved.speed):
        drive = result.drive_power(load_case)
        imbalance = drive + power.applied - power.kinetic_rate - power.potential_rate
        scale = max(float(np.nanmax(np.abs(drive), initial=0.0)), math.ulp(0.0))
        data["drive_power"] = over(drive / 1000.0)
        data["energy_imbalance"] = float(np.nanmax(np.abs(imbalance), initial=0.0)) / scale
    if (air := motion_air_record(found.air, load_case)) is not None:
        data["flapping"] = air
    return data | {"rates": rates_record(result, load_case)}


def _degrees(angle: float) -> float:
    return math.degrees(float(angle))
