"""What drives a linkage over its motion, and its joint forces, for every load case."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from alula.fea.findings.of_motion import MotionFindings
from alula.loads.states.case_motion import with_inertia
from alula.reports.motion.charts import chart, figures
from alula.reports.motion.extremes import extremes, extremes_table
from alula.reports.motion.friction import friction_over_motion, friction_texts
from alula.reports.motion.linkage import linkage_over_motion, linkage_text
from alula.reports.motion.play import drive_with_play, play_record
from alula.reports.sections.section import Group, Number, Part, Section, Text, say
from alula.reports.sentences.verdicts import told_speed


def drive_section(found: MotionFindings) -> Section:
    """Return drive torque or force, its power, and joint forces.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    Section
    """
    moved = found.moved
    records, play, groups = {name: _record(found, name) for name in moved.torque}, play_record(found), []
    for name, record in records.items():
        at = f"with inertia at {told_speed(moved, name)}" if record["inertia"] else "without inertia"
        groups.append(Group(f"Load case {name}", tuple(_parts(found, name, record, play)), remark=at))
    return Section(
        key="drive",
        title="Drive and joint forces",
        short="Drive",
        parts=(
            chart(
                "torque",
                f"Drive {moved.effort.word} on {moved.drive.link}",
                lambda: figures().torque_figure(moved, found.play),
            ),
            *groups,
        ),
        data={
            "load_cases": records,
            "linkage": {name: linkage_over_motion(moved, over) for name, over in found.linkage.items()},
        },
    )


def _parts(
    found: MotionFindings, name: str, record: Mapping[str, Any], play: Mapping[str, Any] | None
) -> Iterator[Part]:
    moved, effort = found.moved, found.moved.effort
    rows = [(f"drive {effort.word} on {moved.drive.link}", effort.unit, record[effort.entry])]
    rows += [("drive power", "W", record["drive_power"])] if "drive_power" in record else []
    rows += [(f"joint {joint}", "N", row) for joint, row in (record["joints"] or {}).items()]
    yield extremes_table("drive", name, rows, moved.motion.progress_unit, ends=True, known=not moved.dead_points)
    if record["joints"] is None:
        yield Text("The linkage is statically indeterminate, so equilibrium alone does not give the joint forces.")
    if "energy_imbalance" in record:
        lacks = Number(record["energy_imbalance"], "", 1)
        yield say("The balance of energy lacks {lacks} of the largest power", "small", lacks=lacks)
    if name in found.linkage:
        yield linkage_text(moved, found.linkage[name])
    if play is not None:
        yield drive_with_play(moved, play, name)
    if moved.rubbing:
        yield from friction_texts(moved, found.work[name], name)
    if name in moved.forces:
        several, number = len(moved.forces) > 1, list(moved.forces).index(name) + 1
        title = f"Joint forces, load case {name}" if several else "Joint forces"
        file = f"joint-forces-{number}" if several else "joint-forces"
        yield chart(file, title, lambda: figures().forces_figure(moved, name))


def _record(found: MotionFindings, load_case: str) -> dict[str, Any]:
    result = found.moved
    moved, power, unbounded = result.moved[load_case], result.power[load_case], bool(result.dead_points)

    def over(values: Any) -> dict[str, Any]:
        return extremes(result.motion, values, unbounded=unbounded)

    data: dict[str, Any] = {
        "inertia": with_inertia(result.case, load_case),
        f"speed_{result.motion.coordinate.measure.symbol}_per_s": result.case.load_cases[load_case].speed
        or float(moved.speed[0]),
        result.effort.entry: over(result.torque[load_case]),
        "joints": None,
    }
    if result.rubbing:
        data["friction"] = friction_over_motion(result, found.work[load_case], load_case)
    if result.forces:
        forces = result.forces[load_case].forces
        data["joints"] = {joint: over(np.linalg.norm(force, axis=1)) for joint, force in forces.items()}
    if np.any(moved.speed):
        drive = result.drive_power(load_case)
        imbalance = drive + power.applied - power.kinetic_rate - power.potential_rate
        scale = max(float(np.nanmax(np.abs(drive), initial=0.0)), math.ulp(0.0))
        data["drive_power"] = over(drive / 1000.0)
        data["energy_imbalance"] = float(np.nanmax(np.abs(imbalance), initial=0.0)) / scale
    return data
