"""Joint forces and their model, large displacement, play and pins: as plain data and as lines of text."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.source import play_source
from alula.fea.frame.thrust import thrusts
from alula.loads.case.case import Case
from alula.loads.records.check_spec import DisplacementCheck
from alula.loads.states.play import Play, Span
from alula.loads.statics.rounding import without_rounding
from alula.loads.statics.statics import Reactions
from alula.reports.sections.data import data, entries
from alula.reports.sentences import told
from alula.reports.words.numbers import band, fixed, limit_load, number

if TYPE_CHECKING:
    from alula.fea.frame.joint_forces import JointForces
    from alula.fea.outcomes.result import CheckResult, LoadCaseResult

AXES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_ROUNDING = 1e-9


def shown_components(reactions: Reactions) -> tuple[str, ...]:
    """Return the components of the joint forces that a table shows.

    Fx and Fy always; Fz, Mx and My with loads out of the plane; Mz with bonded joints.

    Parameters
    ----------
    reactions : Reactions

    Returns
    -------
    tuple of str
        Of ``AXES``.
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
    """Return the reaction of every joint as plain data: force in the plane, magnitude, and the whole wrench.

    Parameters
    ----------
    reactions : Reactions

    Returns
    -------
    list of dict
        One entry per joint.
    """
    return [
        entries(joint, "joint on by magnitude wrench") | {"force": joint.force[:2].tolist()}
        for joint in reactions.joints.values()
    ]


def frame_record(case: "LoadCaseResult") -> dict[str, Any]:
    """Return what a load case does to the joints and to the linkage as a whole, as plain data.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    dict
        ``joint_forces``, ``large_displacement``, ``linkage``, ``play``, ``thrust``, ``pins`` and ``ways_to_hold``.
    """
    moved = case.large_displacement
    deformed = moved.reactions
    return {
        "joint_forces": entries(case.forces, "model reason"),
        "large_displacement": entries(moved, "state span linear where held")
        | {"sentence": data(moved.reason)}
        | {
            "buckling": None if moved.buckling is None or math.isinf(moved.buckling) else moved.buckling,
            "points": [
                {"link": link, "point": point, "displacement": d.tolist()} for (link, point), d in moved.points.items()
            ],
            "reactions": deformed and reaction_records(deformed),
            "drive_torque": deformed and deformed.drive_torque,
            "drive_force": deformed and deformed.drive_force,
        },
        "linkage": {
            "limit_load": data(case.linkage.limit_load),
            "displacement": data(case.linkage.displacement),
            "where": data(case.linkage.where) or None,
            "dead_point_distance": case.linkage.dead_point_distance,
        },
        "play": play_record(case.forces.play),
        "thrust": thrust_records(case.forces, deformed),
        "pins": [{"joint": joint} | entries(pin, "lever moment bending shear") for joint, pin in case.pins.items()],
        "ways_to_hold": [entries(held, "name displacement size play") for held in case.ways_to_hold],
    }


def linkage_line(case: "LoadCaseResult") -> str:
    """Return limit-load factor, largest displacement and distance to a dead point of a load case as one sentence.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    str
    """
    found, drive = case.linkage, case.reactions.drive
    told = [limit_load(found.limit_load)]
    if not found.displacement.unknowable:
        told.append(f"largest displacement {band(found.displacement)} mm ({data(found.where)})")
    if found.dead_point_distance is not None and drive is not None:
        told.append(f"distance to a dead point of {drive.link} (a ratio) {number(found.dead_point_distance, 3)}")
    return f"Linkage: {', '.join(told)}."


def frame_lines(result: "CheckResult", case: "LoadCaseResult") -> list[str]:
    """Return the lines of the terminal on joint forces and displacements of a load case.

    Parameters
    ----------
    result : CheckResult
    case : LoadCaseResult
        One of its load cases.

    Returns
    -------
    list of str
    """
    lines = []
    if not case.forces.by_equilibrium:
        lines.append(f"Joint forces by a {case.forces.model}: {told(case.forces.reason)}.")
    lines.append(linkage_line(case))
    lines += filter(None, [thrust_line(case.forces, case.large_displacement.reactions)])
    if case.forces.play is not None:
        lines.append(play_line(case.forces.play))
    if case.large_displacement.reactions is not None:
        deformed = without_rounding(case.large_displacement.reactions)
        forces = "  ".join(f"{name} {number(joint.magnitude)}" for name, joint in deformed.joints.items())
        lines.append(f"Joint forces on the deformed shape [N]: {forces}")
        if deformed.drive is not None:
            pushes = deformed.drive.pushes(deformed.pose.linkage)
            what = f"force on the deformed shape: {number(deformed.drive_force)} N"
            if not pushes:
                what = f"torque on the deformed shape: {number(deformed.drive_torque)} N·mm"
            who = f"Stop '{deformed.drive.stop}'," if deformed.drive.stop else "Drive"
            lines.append(f"{who} {what}")
    asked = result.case.ways_to_hold
    if asked is not None:
        ways = [
            f"{held.name}: {', '.join(fixed(float(x), 1) for x in held.displacement)}, total {number(held.size, 3)}"
            f"{f', play {number(held.play, 3)} to either side' if held.play > 0.0 else ''}"
            for held in case.ways_to_hold
        ]
        if asked.published is not None and asked.load_case in (None, case.name):
            ways.append(f"published: total {number(asked.published, 3)}")
        lines.append(f"Displacement of {asked.at} by the linear frame, x, y, z and total [mm]:\n  " + "\n  ".join(ways))
    return lines


def play_record(play: Play | None) -> dict[str, Any] | None:
    """Return what play does under a load case as plain data.

    Parameters
    ----------
    play : Play or None

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without play.
    """
    if play is None:
        return None
    pushes = play.drive is not None and play.drive.pushes(play.case.linkage)
    effort = None if play.drive is None else data(_band(play, play.effort))
    return {
        "clearances": play.clearances,
        "through_dead_point": play.through_dead_point,
        "points": [
            {
                "link": link,
                "point": point,
                "free_motion": play.free_motion(link, point),
                "at_rest": _at_rest(play, link, point),
            }
            for link in play.case.linkage.moving
            for point in play.case.links[link].points
        ],
        "joints": [{"joint": name, "force": data(_band(play, span))} for name, span in play.forces.items()],
        "drive_torque": None if pushes else effort,
        "drive_force": effort if pushes else None,
        "dead_point_distance": None if play.drive is None else data(_band(play, play.distance)),
    }


def _at_rest(play: Play, link: str, point: str) -> list[float] | None:
    if play.settled is None:
        return None
    shift = complex(play.shift(link, point))
    return [shift.real, shift.imag]


def _band(play: Play, span: Span) -> Band:
    if math.isnan(span.value):
        return Band.unknown("the pose is a dead point")
    return Band(value=span.value, low=span.low, high=span.high, sources=(play_source(play.clearances),))


def tips(case: Case) -> tuple[tuple[str, str], ...]:
    """Return the points whose free motion is told: those without joint, and those that checks ask for.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of (str, str)
        Links and points; every pin where all points are pins.
    """
    pinned = {
        pair for name, j in case.joints.items() for pair in zip(j.links, case.linkage.joint_points(name), strict=True)
    }
    every = [(link, point) for link in case.linkage.moving for point in case.links[link].points]
    asked = [case.displaced_point(n, c) for n, c in case.checks.items() if isinstance(c, DisplacementCheck) and c.at]
    if case.ways_to_hold is not None:
        asked.append((case.ways_to_hold.link, case.ways_to_hold.at))
    return tuple(dict.fromkeys([*(pair for pair in every if pair not in pinned), *asked])) or tuple(every)


def play_line(play: Play) -> str:
    """Return what play does under a load case, in a few sentences.

    Parameters
    ----------
    play : Play

    Returns
    -------
    str
    """
    free = {pair: play.free_motion(*pair) for pair in tips(play.case)}
    link, point = max(free, key=lambda pair: free[pair])
    most, drive = free[link, point], play.drive
    held = "" if drive is None else f" with {drive.link} held"
    told = f"Play of pins: {point} of {link} can move by {number(most, 3)} mm to either side{held}"
    told += f", {number(2.0 * most, 3)} mm both ways"
    if play.settled is not None:
        told += f"; under the load it rests {number(abs(complex(play.shift(link, point))), 3)} mm off"
    if play.case.layered:
        told += (
            ". That is with pins along z; where they tilt in their holes points move further, as checks of points hold"
        )
    if drive is None or play.nominal is None:
        return f"{told}."
    pushes = drive.pushes(play.case.linkage)
    what, unit = ("force", "N") if pushes else ("torque", "N·mm")
    return (
        f"{told}. Drive {what} {band(_band(play, play.effort))} {unit}, distance to a dead point of {drive.link} "
        f"(a ratio) {band(_band(play, play.distance))}."
    )


def thrust_records(forces: "JointForces", deformed: Reactions | None = None) -> list[dict[str, Any]]:
    """Return the thrusts along pins as plain data.

    Parameters
    ----------
    forces : JointForces
    deformed : Reactions, optional
        Those of the deformed shape, where that counts.

    Returns
    -------
    list of dict
        One entry per joint with thrust.
    """
    return [{"joint": joint, "force": data(thrust)} for joint, thrust in thrusts(forces, deformed).items()]


def thrust_line(forces: "JointForces", deformed: Reactions | None = None) -> str:
    """Return the thrusts along pins as one sentence; "" where there are none.

    Parameters
    ----------
    forces : JointForces
    deformed : Reactions, optional
        Those of the deformed shape, where that counts.

    Returns
    -------
    str
    """
    found = ", ".join(f"{name} {band(thrust)}" for name, thrust in thrusts(forces, deformed).items())
    return found and f"Thrust along the pins [N], which heads, washers or rings must hold: {found}."
