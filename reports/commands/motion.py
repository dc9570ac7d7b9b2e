"""Output of ``alula motion``: summary, tables and figures of a case's motion."""

import csv
import json as jsonlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.motion.linkage_history import asked_over_motion
from geometry.base.version import result_stamp
from geometry.linkage.motion import Motion
from loads.states.case_motion import CaseMotion, with_inertia
from loads.states.clearance import clearance
from loads.states.dead_point_reach import least_dead_point_distance, way_to_dead_point
from reports.commands.motion_play import drive_line, drive_play, motion_play_record, play_lines, point_play
from reports.figures.joint_paths import moving_points, owners, path_length
from reports.tables.clearance import clearance_line, clearance_record
from reports.tables.data import finite
from reports.tables.frames import motion_linkage_line, motion_linkage_record
from reports.tables.friction import motion_friction_lines, motion_friction_record
from reports.tables.mechanism import design_lines, design_record
from reports.tables.springs import motion_springs

Real = NDArray[np.float64]

UNITS = {"angle": "deg", "length": "mm", "force": "N", "moment": "N*mm", "time": "s", "power": "W"}


def write_motion(result: CaseMotion, folder: Path, name: str) -> None:
    """Write ``motion.html``, ``result.json``, the tables, the figures and the animation.

    Parameters
    ----------
    result : CaseMotion
    folder : Path
        An existing folder.
    name : str
        Of the case, as the command was given it.
    """
    from reports.figures.contact import contact_drawing
    from reports.figures.motion_animation import draw_animation
    from reports.figures.motion_figures import draw_figures
    from reports.page.motion_pages import MOTION, motion_page

    (folder / "result.json").write_text(jsonlib.dumps(record(result, name), indent=2) + "\n", encoding="utf-8")
    write_tables(result, folder)
    drawn = draw_figures(result, folder)
    apart = clearance(result.case)
    if apart is not None and apart.shown is not None:
        drawn.append(folder / "clearance.png")
        drawn[-1].write_bytes(contact_drawing(apart))
    draw_animation(result.motion, folder / "linkage.gif")
    pictures = {path.stem: path.read_bytes() for path in drawn}
    page = motion_page(result, pictures, (folder / "linkage.gif").read_bytes(), name=name)
    (folder / MOTION).write_text(page, encoding="utf-8")


def write_tables(result: CaseMotion, folder: Path) -> None:
    """Write ``links.csv``, ``points.csv``, ``torque.csv`` and ``joint-forces.csv``, with springs ``springs.csv``.

    Torques and joint forces have one load case below the other.

    Parameters
    ----------
    result : CaseMotion
    folder : Path
        An existing folder.
    """
    motion = result.motion
    _write(folder / "links.csv", {**_base(motion), **_link_columns(motion)})
    _write(folder / "points.csv", {**_base(motion), **_point_columns(result)})
    if springs := motion_springs(result):
        _write(folder / "springs.csv", {**_base(motion), **dict(springs)})
    _write_cases(folder / "torque.csv", motion, {n: _torque_columns(result, n) for n in result.torque})
    if result.forces:
        _write_cases(folder / "joint-forces.csv", motion, {n: _force_columns(result, n) for n in result.forces})


def record(result: CaseMotion, name: str) -> dict[str, Any]:
    """Return the result of a motion as plain data.

    Parameters
    ----------
    result : CaseMotion
    name : str
        Of the case, as the command was given it.

    Returns
    -------
    dict
        Angles in degrees; unbounded torques are None.
    """
    motion = result.motion
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
            "inertia": bool(result.case.motion and result.case.motion.inertia),
            "links": {
                link: {
                    "first": _degrees(motion.angle(link)[0]),
                    "last": _degrees(motion.angle(link)[-1]),
                    "smallest": _degrees(motion.angle(link).min()),
                    "largest": _degrees(motion.angle(link).max()),
                }
                for link in motion.linkage.moving
            },
            "points": {label: {"path_length": path_length(xy)} for label, xy in moving_points(motion).items()},
        },
        "drive": {
            "link": result.drive.link,
            "joint": result.drive.joint,
            "dead_points": [float(result.motion.told(a)) for a in result.dead_points],
            "least_distance": least_dead_point_distance(result),
            "way_to_dead_point": _number(float(result.motion.told(way_to_dead_point(result)))),
        },
        "design": design_record(result.case),
        "load_cases": {load_case: _case_record(result, load_case) for load_case in result.torque},
        "play": finite(motion_play_record(result), {}),
        "clearance": finite(clearance_record(clearance(result.case)), {}),
        "linkage": {
            n: finite(motion_linkage_record(result, over), {}) for n, over in asked_over_motion(result).items()
        },
    }


def _case_record(result: CaseMotion, load_case: str) -> dict[str, Any]:
    own = result.case.load_cases[load_case].speed
    speed = own if own != 0.0 else float(result.motion.speed[0])
    data: dict[str, Any] = {"inertia": with_inertia(result.case, load_case)}
    data |= {"speed_mm_per_s" if result.motion.slides else "speed_rad_per_s": speed}
    data |= {f"drive_{result.effort[0]}": _extremes(result, result.torque[load_case])}
    if result.rubbing:
        data["friction"] = motion_friction_record(result, load_case)
    if not result.forces:
        return data | {"joints": None}
    solved = result.forces[load_case]
    data["joints"] = {joint: _extremes(result, np.linalg.norm(force, axis=1)) for joint, force in solved.forces.items()}
    if np.any(solved.motion.speed):
        data["drive_power"] = _extremes(result, solved.drive_power / 1000.0)
        scale = max(float(np.nanmax(np.abs(solved.drive_power), initial=0.0)), math.ulp(0.0))
        data["energy_imbalance"] = float(np.nanmax(np.abs(solved.imbalance), initial=0.0)) / scale
    return data


def _extremes(result: CaseMotion, values: Real) -> dict[str, Any]:
    """First, last and extreme values; extremes next to a dead point of the drive mean nothing, hence are null."""
    ends: dict[str, Any] = {"first": _number(values[0]), "last": _number(values[-1])}
    if result.dead_points or not np.any(np.isfinite(values)):
        return ends | {"smallest": None, "largest": None, "unbounded": True}
    # The first of the poses that differ by rounding alone, as those of a symmetric linkage do.
    low, high, slack = np.nanmin(values), np.nanmax(values), 1e-9 * np.nanmax(np.abs(values))
    for key, extreme, there in (("smallest", low, values <= low + slack), ("largest", high, values >= high - slack)):
        pose = int(np.argmax(there))
        ends |= {key: _number(extreme), f"{key}_at": float(result.motion.told(result.motion.angles[pose]))}
    return ends | {"unbounded": False}


def print_motion(result: CaseMotion, name: str, *, json: bool) -> None:
    """Print the result of a motion.

    Parameters
    ----------
    result : CaseMotion
    name : str
        Of the case, as the command was given it.
    json : bool
        True to print JSON.
    """
    data = record(result, name)
    if json:
        print(jsonlib.dumps(data, indent=2))
        return
    motion, drive = data["motion"], data["drive"]
    print(result.case.title)
    duration = "" if motion["duration"] is None else f", {motion['duration']:.4g} s"
    print(
        f"{motion['coordinate']} from {motion['first']:.6g} to {motion['last']:.6g} {motion['unit']}: "
        f"{motion['poses']} poses{duration}; largest gap of a loop {motion['closure_residual']:.1g} of the longest link"
    )
    if motion["returns_to_start"]:
        print("The linkage returns to its start.")
    width = max(map(len, motion["links"]))
    print("\nLink directions [deg]")
    for link, row in motion["links"].items():
        print(
            f"  {link:<{width}}  {row['first']:9.3f} -> {row['last']:9.3f}   "
            f"(between {row['smallest']:.3f} and {row['largest']:.3f})"
        )
    for angle in drive["dead_points"]:
        print(
            f"\nDead point of the driven link {drive['link']} at {motion['coordinate']} = {angle:.4f} "
            f"{motion['unit']}: {drive['link']} reverses its direction there; drive {result.effort[0]} and joint "
            "forces grow without bound."
        )
    if not drive["dead_points"]:
        way, unit = drive["way_to_dead_point"], motion["unit"]
        beyond = "none was met beyond" if way is None else f"the nearest is {way:.4g} {unit} beyond"
        print(
            f"\nNo dead point of {drive['link']} in the range, {beyond}; least distance (a ratio) "
            f"{drive['least_distance']:.3g}"
        )
    play = motion_play_record(result)
    for told in () if play is None else play_lines(result, play):
        print(told)
    if design := design_lines(result.case):
        print("\n" + "\n".join(design))
    if (line := clearance_line(clearance(result.case))) is not None:
        print("\n" + line)
    for told, values in motion_springs(result):
        ends = [float(f"{value:.4g}") for value in (values[0], values[-1], values.min(), values.max())]
        print("\nSpring {}: {:g} -> {:g}; min {:g}, max {:g}".format(told, *ends), end="")
    if result.case.springs or result.case.tendons:
        print()
    for load_case, row in data["load_cases"].items():
        speed = row.get("speed_mm_per_s", row.get("speed_rad_per_s"))
        at = f"{speed:.4g} mm/s" if result.motion.slides else f"{speed * 30.0 / math.pi:.4g} rpm"
        how = f"with inertia at {at}" if row["inertia"] else "without inertia"
        print(f"\nLoad case {load_case} ({how})")
        what, unit = result.effort
        if load_case in data["linkage"]:
            print(f"  {motion_linkage_line(result, asked_over_motion(result)[load_case])}")
        told = _line(row[f"drive_{what}"], unit, motion["unit"])
        print(f"  drive {what} on {drive['link']} at {drive['joint']}: {told}")
        if play is not None:
            print(f"  {drive_line(result, play, load_case)}")
        for line in motion_friction_lines(result, load_case) if result.rubbing else ():
            print(f"  {line}")
        if row["joints"] is None:
            print("  the linkage is statically indeterminate, so equilibrium alone does not give the joint forces")
            continue
        if "drive_power" in row:
            power = _line(row["drive_power"], "W", motion["unit"])
            print(
                f"  drive power at {at}: {power}; energy imbalance {row['energy_imbalance']:.1g} of the largest power"
            )
        for joint, extremes in row["joints"].items():
            print(f"  joint {joint}: {_line(extremes, 'N', motion['unit'])}")


def _line(row: Mapping[str, Any], unit: str, at: str) -> str:
    keys = ("first", "last", "smallest", "largest")
    scale = max((abs(row[key]) for key in keys if row[key] is not None), default=0.0)
    first, last, smallest, largest = (_text(row[key], scale) for key in keys)
    ends = f"{first} -> {last} {unit}"
    if row["unbounded"]:
        return ends
    least = f"min {smallest} {unit} at {row['smallest_at']:.1f} {at}"
    return f"{ends}; {least}, max {largest} {unit} at {row['largest_at']:.1f} {at}"


def _text(value: float | None, scale: float) -> str:
    """Four digits; what is rounding beside ``scale`` is zero."""
    if value is None:
        return "unbounded"
    return f"{value:.4g}" if abs(value) > 1e-12 * scale else "0"


def _base(motion: Motion) -> dict[str, Real]:
    columns = {
        f"{motion.coordinate} {'travel' if motion.slides else 'angle'} [{motion.unit}]": motion.told(motion.angles)
    }
    return columns if motion.times is None else columns | {"time [s]": motion.times}


def _link_columns(motion: Motion) -> dict[str, Real]:
    columns: dict[str, Real] = {}
    for i, link in enumerate(motion.linkage.moving):
        if motion.slides or link != motion.coordinate:
            columns[f"{link} angle [deg]"] = np.degrees(motion.angle(link))
        columns[f"{link} speed over speed of {motion.coordinate} [{'rad/mm' if motion.slides else '1'}]"] = (
            motion.first[:, i]
        )
        if motion.times is not None:
            columns[f"{link} speed [rad/s]"] = motion.angular_speed(link)
            columns[f"{link} acceleration [rad/s^2]"] = motion.angular_acceleration(link)
    for joint in motion.closure.slots:
        if motion.slides and joint == motion.coordinate:
            continue
        columns[f"{joint} travel [mm]"] = motion.travel(joint)
    return columns


def _point_columns(result: CaseMotion) -> dict[str, Real]:
    motion, columns = result.motion, dict[str, Real]()
    fields = [("", "mm", motion.position)]
    if motion.times is not None:
        fields += [("v", "mm/s", motion.velocity), ("a", "mm/s^2", motion.linear_acceleration)]
    for label in moving_points(motion):
        for prefix, unit, of in fields:
            values = of(*owners(motion, label)[0])
            columns[f"{label} {prefix}x [{unit}]"] = values[:, 0]
            columns[f"{label} {prefix}y [{unit}]"] = values[:, 1]
        columns |= point_play(result, label)
    return columns


def _torque_columns(result: CaseMotion, load_case: str) -> dict[str, Real]:
    what, unit = result.effort
    columns = {f"{what} on {result.drive.link} [{unit.replace('·', ' ')}]": result.torque[load_case]}
    if result.rubbing:
        columns[f"{what} without friction [{unit.replace('·', ' ')}]"] = result.frictionless[load_case]
        columns["efficiency [1]"] = result.work(load_case).efficiency
    columns |= drive_play(result, load_case)
    if any(np.any(solved.motion.speed) for solved in result.forces.values()):
        solved = result.forces[load_case]
        columns["drive power [N mm/s]"] = solved.drive_power
        columns["kinetic energy [N mm]"] = solved.power.kinetic
        columns["potential energy [N mm]"] = solved.power.potential
    return columns


def _force_columns(result: CaseMotion, load_case: str) -> dict[str, Real]:
    columns: dict[str, Real] = {}
    solved = result.forces[load_case]
    for name, force in solved.forces.items():
        first, second = result.case.joints[name].links
        columns[f"{name} Fx of {first} on {second} [N]"] = force[:, 0]
        columns[f"{name} Fy of {first} on {second} [N]"] = force[:, 1]
        columns[f"{name} size [N]"] = np.linalg.norm(force, axis=1)
        if name in solved.moments:
            columns[f"{name} M of {first} on {second} [N mm]"] = solved.moments[name]
    return columns


def _write(path: Path, columns: Mapping[str, Real]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(_rows(columns))


def _write_cases(path: Path, motion: Motion, cases: Mapping[str, Mapping[str, Real]]) -> None:
    base = _base(motion)
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        for i, (name, columns) in enumerate(cases.items()):
            if i == 0:
                writer.writerow(["load case", *base, *columns])
            writer.writerows([name, *row] for row in _rows({**base, **columns}))


def _rows(columns: Mapping[str, Real]) -> Sequence[list[str]]:
    """Rows of a table with twelve digits; an unbounded value is left empty."""
    table = np.column_stack(list(columns.values()))
    return [[f"{v:.12g}" if math.isfinite(v) else "" for v in row] for row in table.tolist()]


def _degrees(angle: float) -> float:
    return math.degrees(float(angle))


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
