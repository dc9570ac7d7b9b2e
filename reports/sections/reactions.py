"""Pose, joint forces, what drives or holds the pose, springs, friction: of a check and of statics alone."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from alula.fea.standing.joint_forces import JointForces
from alula.fea.standing.thrust import thrusts
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.rubbing import told_direction
from alula.loads.states.standing import Standing
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.rounding import rounded, size_of, without_rounding
from alula.loads.statics.statics import Reactions
from alula.reports.sections.data import entries
from alula.reports.sections.markup import bold, sub
from alula.reports.sections.section import Part, Text, paragraph, say
from alula.reports.sections.springs import holding_sentence, spring_sentences
from alula.reports.sections.table import Column, Number, Table, numbers, words
from alula.reports.words.numbers import number, turning

AXES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
_ROUNDING = 1e-9


def reaction_parts(
    name: str,
    reactions: Reactions,
    forces: JointForces,
    standing: Standing,
    work: DriveWork | None,
    loads: Sequence[Load],
    deformed: Reactions | None = None,
) -> Iterator[Part]:
    """Yield joint forces, what drives or holds the pose, springs and friction under a load case.

    Parameters
    ----------
    name : str
        Of the load case.
    reactions : Reactions
    forces : JointForces
    standing : Standing
    work : DriveWork or None
        None without friction.
    loads : sequence of Load
        All of the load case, friction among them.
    deformed : Reactions, optional
        Those of the deformed shape, where that counts: thrusts along pins are theirs.

    Yields
    ------
    Part
    """
    told, linkage, shown = without_rounding(reactions), reactions.pose.linkage, shown_components(reactions)
    yield joint_table(told, shown, name)
    if "Mz" not in shown:
        for joint in told.joints.values():
            if linkage.joints[joint.joint].kind.guided:
                moment = Number(float(joint.wrench[5]), "N·mm")
                yield say(
                    "The guide {joint} also exerts a moment of {moment} ({turns}) on {on}",
                    joint=joint.joint, moment=moment, turns=turning(joint.wrench[5]), on=joint.on,
                )  # fmt: skip
    yield from thrust_texts(forces, deformed)
    for line in spring_sentences(standing):
        yield Text(f"{line}.")
    yield from _driving(reactions, told, standing)
    yield say("Residual of the equilibrium: {share} of the load", "note", share=Number(reactions.residual, "", 2))
    if work is not None:
        yield Text(f"{friction_sentence(work, reactions)}.")
        found = friction_wrenches(loads)
        joints, size = [reactions.joints[name] for name in found], size_of(reactions)
        rubbed = [rounded(wrench, size) for wrench in found.values()]
        yield Table.by_columns(
            {
                words("joint"): found,
                words("by → on"): [f"{joint.by} → {joint.on}" for joint in joints],
                Column(f"F{sub('x')}", "N"): numbers(wrench[0] for wrench in rubbed),
                Column(f"F{sub('y')}", "N"): numbers(wrench[1] for wrench in rubbed),
                Column(f"M{sub('z')}", "N·mm"): numbers(wrench[5] for wrench in rubbed),
            },
            key="friction",
            caption="Friction, part of the joint forces",
            under=(("load case", name),),
        )


def thrust_texts(forces: JointForces, deformed: Reactions | None = None) -> Iterator[Text]:
    """Yield the thrusts along pins as one sentence, where there are any.

    Parameters
    ----------
    forces : JointForces
    deformed : Reactions, optional
        Those of the deformed shape, where that counts.

    Yields
    ------
    Text
    """
    if found := thrusts(forces, deformed):
        told: list[str | Number] = ["Thrust along the pins [N], which heads, washers or rings must hold: "]
        for joint, thrust in found.items():
            told += [f"{joint} ", Number(thrust), ", "]
        yield paragraph(*told[:-1])


def _driving(reactions: Reactions, told: Reactions, standing: Standing) -> Iterator[Text]:
    """Yield what drives or holds the pose."""
    drive = reactions.drive
    if held := holding_sentence(standing):
        yield Text(bold(f"{held}."))
    elif drive is not None and drive.effort(reactions.pose.linkage) is DriveEffort.FORCE:
        yield say(
            "Drive force on {link} along {joint}: {force}, already included in the guide reaction above",
            link=drive.link, joint=drive.joint, force=Number(told.drive_force, "N"),
        )  # fmt: skip
    elif drive is not None:
        torque = Number(told.drive_torque, "N·mm")
        yield say(
            "Drive torque on {link} about {joint}: {torque} ({turns}; counter-clockwise is positive)",
            link=drive.link, joint=drive.joint, torque=torque, turns=turning(told.drive_torque),
        )  # fmt: skip


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
    pinned = [not reactions.pose.linkage.joints[name].slides for name in reactions.joints]
    turned = np.abs(wrenches[pinned, 5]).max(initial=0.0) > _ROUNDING * force * arm
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


def joint_table(told: Reactions, shown: tuple[str, ...], load_case: str) -> Table:
    """Return a table of joint forces.

    Parameters
    ----------
    told : Reactions
        Without rounding errors.
    shown : tuple of str
        Components, of ``AXES``.
    load_case : str

    Returns
    -------
    Table
    """
    forces, moments = (
        {
            Column(f"{axis[0]}{sub(axis[1])}", unit): numbers(
                joint.wrench[AXES.index(axis)] for joint in told.joints.values()
            )
            for axis in shown
            if axis[0] == kind
        }
        for kind, unit in (("F", "N"), ("M", "N·mm"))
    )
    size, joints = float(size_of(told)[0]), told.joints.values()
    return Table.by_columns(
        {
            words("joint"): told.joints,
            words("by", hidden=True): [joint.by for joint in joints],
            words("on", hidden=True): [joint.on for joint in joints],
            words("by → on"): [f"{joint.by} → {joint.on}" for joint in joints],
            **forces,
            Column("size", "N"): numbers((joint.magnitude for joint in joints), beside=size),
            **moments,
        },
        key="joints",
        caption=f"Joint forces{' and moments about the joint' if moments else ''}, global axes",
        under=(("load case", load_case),),
        kind="keep",
    )


def friction_record(work: DriveWork, loads: Sequence[Load]) -> dict[str, Any]:
    """Return friction at one pose as plain data.

    Parameters
    ----------
    work : DriveWork
        At that pose.
    loads : sequence of Load
        All loads of the load case, friction among them.

    Returns
    -------
    dict
        Efforts of the drive [N mm or N], efficiency, and by joint the force [N] and moment [N mm] of its first link on
        its second by friction.
    """
    return {
        "direction": work.way,
        "drive_without": float(work.without[0]),
        "drive": float(work.effort[0]),
        "drive_band": None if work.ends is None else [_finite(end) for end in _ends(work)],
        "efficiency": _finite(work.efficiency[0]),
        "holds_itself": bool(work.holds_itself[0]),
        "joints": {
            joint: {"force": wrench[:2].tolist(), "moment": float(wrench[5])}
            for joint, wrench in friction_wrenches(loads).items()
        },
    }


def friction_sentence(work: DriveWork, reactions: Reactions) -> str:
    """Tell what friction does to the drive at one pose.

    Parameters
    ----------
    work : DriveWork
        At that pose.
    reactions : Reactions
        With friction.

    Returns
    -------
    str
    """
    pose, drive = reactions.pose, reactions.drive
    effort = DriveEffort.TORQUE if drive is None else drive.effort(pose.linkage)
    unit, size = effort.unit, size_of(reactions)[0 if effort is DriveEffort.FORCE else 5]
    assert pose.coordinate is not None
    between = ""
    if work.ends is not None:
        low, high = (
            number(end, beside=size) if math.isfinite(end) else "−∞" if end < 0.0 else "∞" for end in _ends(work)
        )
        between = f" ({low} to {high})"
    found = (
        f"Friction, driven {told_direction(work.way, pose.coordinate)}: drive "
        f"{number(float(work.effort[0]), beside=size)}{between} {unit}, without friction "
        f"{number(float(work.without[0]), beside=size)} {unit}"
    )
    if bool(work.holds_itself[0]):
        return f"{found}; the linkage holds itself: the load does not drive it this way"
    share = float(work.efficiency[0])
    return found if math.isnan(share) else f"{found}; efficiency {100.0 * share:.1f} %"


def _ends(work: DriveWork) -> tuple[float, float]:
    """Return the least and the largest effort of all poses at which it is known as stated."""
    assert work.ends is not None
    known = work.ends[:, np.isfinite(work.effort)]
    return (float(known[0].min()), float(known[1].max())) if known.size else (math.nan, math.nan)


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def pose_tables(pose: Pose, case: Case) -> tuple[Table, Table]:
    """Return points and directions of the links in a pose.

    Parameters
    ----------
    pose : Pose
    case : Case

    Returns
    -------
    tuple of 2 Table
    """
    return (
        Table(
            key="points",
            columns=(words("point"), Column("x", "mm"), Column("y", "mm")),
            rows=tuple((name, *(Number(float(x), decimals=3) for x in at)) for name, at in pose.points.items()),
            caption="Points in global axes",
        ),
        Table(
            key="directions",
            columns=(words("link"), words("from → to"), Column("direction", "deg")),
            rows=tuple(
                (link, f"{names[0]} → {names[-1]}", Number(math.degrees(pose.angles[link]) % 360.0, "", 6))
                for link in pose.linkage.moving
                for names in [list(case.links[link].points)]
            ),
            caption="Directions of the links",
        ),
    )
