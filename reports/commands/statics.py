"""Output of ``alula statics``: pose, reactions and equations."""

import json as jsonlib
import math

import numpy as np

from alula.fea.frame.case_statics import CaseStatics, with_ends
from alula.geometry.base.version import result_stamp
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.rounding import rounded, size_of, without_rounding
from alula.loads.statics.statics import Reactions
from alula.loads.statics.system import System
from alula.reports.renderers.record import finite
from alula.reports.sections.friction import friction_record, friction_sentence
from alula.reports.sections.springs import holding_sentence, spring_sentences, standing_record
from alula.reports.tables.frames import (
    AXES,
    play_line,
    play_record,
    reaction_records,
    shown_components,
    thrust_line,
    thrust_records,
    tips,
)


def print_statics(statics: CaseStatics, *, matrix: bool, json: bool) -> None:
    """Print pose and reactions of every load case.

    Parameters
    ----------
    statics : CaseStatics
    matrix : bool
        True to print [A] and [b] as well.
    json : bool
        True to print JSON.
    """
    if json:
        print(jsonlib.dumps(_record(statics, matrix=matrix), indent=2))
        return
    pose = statics.pose
    print(f"Mobility (Gruebler): degrees of freedom {pose.linkage.mobility}")
    print(f"Closure residual: {pose.residual:.1e} of the longest link")
    left = max(12, *map(len, pose.points), *map(len, pose.linkage.moving))
    for link in pose.linkage.moving:
        print(f"  {link:<{left}} at {math.degrees(pose.angles[link]) % 360.0:9.4f} deg")
    for name, (x, y) in pose.points.items():
        print(f"  {name:<{left}} at ({_column(x, pose.linkage.longest)}, {_column(y, pose.linkage.longest)}) mm")
    for title, reactions in statics.reactions.items():
        print(f"\nLoad case {title}")
        shown, clean = shown_components(reactions), without_rounding(reactions)
        width = max(4, *map(len, reactions.joints))
        places = [AXES.index(axis) for axis in shown]
        forces, moments = [i for i in places if i < 3], [i for i in places if i >= 3]
        for joint in clean.joints.values():
            force = ", ".join(_column(joint.wrench[i]) for i in forces)
            size = _column(joint.magnitude).strip()
            turned = "".join(f", {AXES[i]} {joint.wrench[i]:.4g}" for i in moments)
            print(
                f"  {joint.joint:<{width}} {joint.by} pushes {joint.on} with ({force}) N, {size} N"
                f"{turned}{' N·mm' if turned else ''}"
            )
        if told := thrust_line(statics.forces[title]):
            print(f"  {told}")
        standing = statics.standing[title]
        held = holding_sentence(standing)
        for line in (*filter(None, [held]), *spring_sentences(standing)):
            print(f"  {line}")
        if reactions.drive and not held:
            drive = reactions.drive
            if drive.pushes(reactions.pose.linkage):
                print(f"  drive force on {drive.link}: {clean.drive_force:.5g} N (along {drive.joint} +)")
            else:
                print(f"  drive torque on {drive.link}: {clean.drive_torque:.5g} N·mm (counter-clockwise +)")
        if (work := with_ends(statics, title)) is not None:
            print(f"  {friction_sentence(work, reactions)}")
            for name, rubbed in friction_wrenches(statics.loads[title]).items():
                wrench = rounded(rubbed, size_of(reactions))
                joint, force = reactions.joints[name], ", ".join(_column(x).strip() for x in wrench[:2])
                by = f"({force}) N, " if np.any(wrench[:2]) else ""
                print(f"  {name:<{width}} {joint.by} rubs {joint.on} with {by}{wrench[5]:.4g} N·mm")
        if (play := statics.forces[title].play) is not None:
            print(f"  {play_line(play)}")
            for link, point in tips(statics.case):
                free = play.free_motion(link, point)
                print(f"    {point} of {link}: {free:.4g} mm to either side, {2.0 * free:.4g} mm both ways")
        system = reactions.system
        print(f"  system {len(system.rows)}×{len(system.columns)}, condition number {system.condition:.4g} (scaled),")
        print(f"  residual {reactions.residual:.1e} of the load")
        if matrix:
            _print_matrix(reactions)


def _print_matrix(reactions: Reactions) -> None:
    """Print [A] and [b]; every unknown is what a joint's first link does to its second."""
    system = reactions.system
    labels = [f"{link} {kind}" for link, kind in system.rows]
    left = max(map(len, labels))
    largest = float(np.abs(system.matrix).max())
    widths = [max(10, len(name) + 1) for name in system.columns]
    print("\n  [A][R] = [b]; force rows in N, moment rows (about the first point of the link) in N·mm")
    print(" " * (left + 2) + "".join(f"{n:>{w}}" for n, w in zip(system.columns, widths, strict=True)) + f"{'b':>12}")
    for label, row, b in zip(labels, system.matrix, system.rhs, strict=True):
        cells = "".join(f"{_cell(x, largest):>{w}}" for x, w in zip(row, widths, strict=True))
        print(f"  {label:<{left}}{cells}{b:>12.5g}")
    nil = 1e-12 * float(np.abs(reactions.unknowns).max())
    told = np.where(np.abs(reactions.unknowns) <= nil, 0.0, reactions.unknowns)
    solution = "".join(f"{x:>{w}.4g}" for x, w in zip(told, widths, strict=True))
    print(f"  {'[R]':<{left}}{solution}")


def _column(value: float, beside: float = 0.0) -> str:
    """Four decimals, or four digits where these would lose the number; what is rounding ``beside`` another is zero."""
    shown = 0.0 if abs(value) <= 1e-12 * beside else float(value)
    return f"{shown:10.4f}" if shown == 0.0 or 0.1 <= abs(shown) < 1e5 else f"{shown:10.4g}"


def _cell(value: float, beside: float) -> str:
    if value == 0.0:
        return "."
    if abs(value) == 1.0 or abs(value) <= 1e-12 * beside:
        return f"{value:.0f}"
    return f"{value:.3f}" if 1e-2 <= abs(value) < 1e4 else f"{value:.3g}"


def _record(statics: CaseStatics, *, matrix: bool) -> dict[str, object]:
    pose = statics.pose
    return {
        **result_stamp(),
        "units": {"length": "mm", "force": "N", "moment": "N*mm", "angle": "deg"},
        "pose": {
            "mobility": pose.linkage.mobility,
            "closure_residual": pose.residual,
            "angles": {link: math.degrees(angle) % 360.0 for link, angle in pose.angles.items()},
            "points": {name: point.tolist() for name, point in pose.points.items()},
        },
        "load_cases": {
            title: {
                "reactions": reaction_records(reactions),
                "drive_torque": reactions.driving[0],
                "drive_force": reactions.driving[1],
                "thrust": thrust_records(statics.forces[title]),
                **standing_record(statics.standing[title]),
                "residual": reactions.residual,
                "condition": reactions.system.condition,
                **(
                    {"friction": friction_record(work, statics.loads[title])}
                    if (work := with_ends(statics, title)) is not None
                    else {}
                ),
                "play": finite(play_record(statics.forces[title].play), {}),
                **({"system": _system(reactions.system)} if matrix else {}),
            }
            for title, reactions in statics.reactions.items()
        },
    }


def _system(system: System) -> dict[str, object]:
    return {
        "rows": [f"{link} {kind}" for link, kind in system.rows],
        "columns": list(system.columns),
        "matrix": np.asarray(system.matrix).tolist(),
        "rhs": np.asarray(system.rhs).tolist(),
    }
