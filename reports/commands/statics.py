"""Output of ``alula statics``: pose, joint forces and equations."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from alula.fea.standing.case_statics import CaseStatics, with_ends
from alula.fea.standing.thrust import thrusts
from alula.loads.statics.statics import Reactions
from alula.loads.statics.system import System
from alula.reports.page.provenance import provenance_section
from alula.reports.sections.data import data
from alula.reports.sections.play import play_parts, play_record
from alula.reports.sections.reactions import friction_record, pose_tables, reaction_parts, reaction_records
from alula.reports.sections.section import Cell, Column, Group, Number, Part, Section, Table, say, words
from alula.reports.sections.springs import standing_record

UNITS = {"length": "mm", "force": "N", "moment": "N*mm", "angle": "deg"}


def statics_sections(statics: CaseStatics, *, matrix: bool) -> tuple[Section, ...]:
    """Return pose, joint forces of every load case, and with what they were found.

    Parameters
    ----------
    statics : CaseStatics
    matrix : bool
        True for [A] and [b] as well.

    Returns
    -------
    tuple of Section
    """
    pose = statics.pose
    closed = say(
        "Degrees of freedom after Gruebler: {mobility}. Closure residual {residual} of the longest link",
        mobility=pose.linkage.mobility,
        residual=Number(pose.residual, "", 2),
    )
    record = {
        "mobility": pose.linkage.mobility,
        "closure_residual": pose.residual,
        "angles": {link: math.degrees(pose.angles[link]) % 360.0 for link in pose.angles},
        "points": {name: point.tolist() for name, point in pose.points.items()},
    }
    tables = pose_tables(pose, statics.case)
    return (
        Section(key="pose", title="Pose", parts=(closed, *tables), data={"pose": record}),
        Section(
            key="statics",
            title="Statics",
            parts=tuple(
                Group(f"Load case {name}", tuple(_parts(statics, name, matrix=matrix))) for name in statics.reactions
            ),
            data={"load_cases": {name: _record(statics, name, matrix=matrix) for name in statics.reactions}},
        ),
        provenance_section(statics.case),
    )


def _parts(statics: CaseStatics, name: str, *, matrix: bool) -> Iterator[Part]:
    reactions, forces = statics.reactions[name], statics.forces[name]
    work = with_ends(statics, name)
    yield from reaction_parts(name, reactions, forces, statics.standing[name], work, statics.loads[name])
    yield from play_parts(statics.case, name, forces.play)
    system = reactions.system
    size = f"{len(system.rows)}×{len(system.columns)}"
    yield say(
        "System {size}, condition number {condition} (scaled), residual {residual} of the load",
        size=size,
        condition=Number(system.condition),
        residual=Number(reactions.residual, "", 2),
    )
    if matrix:
        yield _matrix(reactions)


def _matrix(reactions: Reactions) -> Table:
    """Return [A] and [b]; every unknown is what a joint's first link does to its second."""
    system = reactions.system
    largest = float(np.abs(system.matrix).max())
    nil = 1e-12 * float(np.abs(reactions.unknowns).max())
    rows = [
        (f"{link} {kind}", *(_cell(float(x), largest) for x in row), Number(float(b), "", 5))
        for (link, kind), row, b in zip(system.rows, system.matrix, system.rhs, strict=True)
    ]
    solution: tuple[Cell, ...] = ("[R]", *(Number(0.0 if abs(x) <= nil else float(x)) for x in reactions.unknowns), "")
    return Table(
        columns=(words("row"), *map(Column, system.columns), Column("b")),
        rows=(*rows, solution),
        caption="[A][R] = [b]; force rows in N, moment rows (about the first point of the link) in N·mm",
        kind="whole",
    )


def _cell(value: float, beside: float) -> str | Number:
    if value == 0.0:
        return "."
    return Number(value, decimals=0) if abs(value) in (0.0, 1.0) else Number(value, beside=beside)


def _record(statics: CaseStatics, name: str, *, matrix: bool) -> dict[str, Any]:
    reactions, work = statics.reactions[name], with_ends(statics, name)
    return {
        "reactions": reaction_records(reactions),
        "drive_torque": reactions.driving[0],
        "drive_force": reactions.driving[1],
        "thrust": [{"joint": at, "force": data(thrust)} for at, thrust in thrusts(statics.forces[name]).items()],
        **standing_record(statics.standing[name]),
        "residual": reactions.residual,
        "condition": reactions.system.condition,
        **({} if work is None else {"friction": friction_record(work, statics.loads[name])}),
        "play": play_record(statics.forces[name].play),
        **({"system": _system(reactions.system)} if matrix else {}),
    }


def _system(system: System) -> dict[str, Any]:
    return {
        "rows": [f"{link} {kind}" for link, kind in system.rows],
        "columns": list(system.columns),
        "matrix": np.asarray(system.matrix).tolist(),
        "rhs": np.asarray(system.rhs).tolist(),
    }
