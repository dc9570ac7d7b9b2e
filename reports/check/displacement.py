"""What the loads do to the linkage as a whole: model of the joint forces, large displacement, buckling, limit load."""

import math
from collections.abc import Iterator
from typing import Any

from alula.fea.common.verdict import LINKAGE, Quantity, Subject
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.fea.solid.buckling_factor import MOST
from alula.fea.standing.thrust import thrusts
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.rounding import size_of, without_rounding
from alula.reports.check.modes import mode_parts, mode_records
from alula.reports.check.pins import pin_parts, pin_record
from alula.reports.sections.data import data, entries
from alula.reports.sections.fatigue import fatigue_parts, link_fatigue_record
from alula.reports.sections.markup import bold
from alula.reports.sections.play import play_parts, play_record
from alula.reports.sections.reactions import reaction_records
from alula.reports.sections.section import Folded, Part, Section, Text, paragraph, under_load_cases
from alula.reports.sections.table import Column, Number, Table, words
from alula.reports.sentences import told as told_of
from alula.reports.words.numbers import joined, sentence

_LOST = ("no equilibrium", "unstable")


def displacement_section(result: CheckResult) -> Section:
    """Return what the loads do to the linkage as a whole, under every load case.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    parts = under_load_cases({name: _parts(result, case) for name, case in result.load_cases.items()})
    return Section(
        key="displacement",
        title="Displacement of the linkage",
        short="Displacement",
        parts=(*parts, Folded("The frame model", (Text(_model(result)),))),
        data={"load_cases": {name: _data(result, case) for name, case in result.load_cases.items()}},
        not_covered=(("Large displacements", _large(result)), ("Buckling", _buckling(result))),
    )


def _parts(result: CheckResult, case: LoadCaseResult) -> Iterator[Part]:
    moved, forces = case.large_displacement, case.forces
    yield paragraph(f"Joint forces by {'the' if forces.by_equilibrium else 'a'} {forces.model}: ", forces.reason)
    told = paragraph(moved.reason)
    if moved.state in _LOST:
        below = "Forces, stresses and displacements of the links in this report belong to the"
        told = Text(f"{told.text} {below} {bold('undeformed pose')}.", "apart")
    yield told
    yield linkage_text(case)
    yield from play_parts(result.case, case.name, forces.play)
    yield from _deformed(case)
    yield from _ways_to_hold(result, case)
    yield from pin_parts(result.case, case)
    yield from mode_parts(case)
    yield from fatigue_parts(result, case)


def linkage_text(case: LoadCaseResult) -> Text:
    """Return limit-load factor, largest displacement and distance to a dead point of a load case.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    Text
    """
    found, drive = case.linkage, case.reactions.drive
    factor = found.limit_load
    if factor.unknowable or not math.isinf(factor.high):
        told = ["Linkage: limit-load factor ", Number(factor)]
    else:
        told = ["Linkage: limit-load factor at least ", Number(factor.low, "", 3)]
    if not found.displacement.unknowable:
        told += [", largest displacement ", Number(found.displacement, "mm"), f" ({told_of(found.where)})"]
    if found.dead_point_distance is not None and drive is not None:
        told += [f", distance to a dead point of {drive.link} (a ratio) ", Number(found.dead_point_distance, "", 3)]
    return paragraph(*told)


def _deformed(case: LoadCaseResult) -> Iterator[Table]:
    """Yield the joint forces of the deformed pose beside those of the undeformed one, where they count."""
    moved = case.large_displacement.reactions
    if moved is None:
        return
    told, before, size = without_rounding(moved), without_rounding(case.reactions), float(size_of(moved)[0])
    rows = [
        (f"{name} [N]", Number(float(before.joints[name].magnitude), beside=size), Number(float(joint.magnitude)))
        for name, joint in told.joints.items()
    ]
    drive = moved.drive
    if drive is not None and drive.effort(moved.pose.linkage) is DriveEffort.FORCE:
        what = f"force of stop {drive.stop}" if drive.stop else "drive force"
        rows.append((f"{what} [N]", Number(before.drive_force), Number(told.drive_force)))
    elif drive is not None and not drive.idle:
        what = f"moment of stop {drive.stop}" if drive.stop else "drive torque"
        rows.append((f"{what} [N·mm]", Number(before.drive_torque), Number(told.drive_torque)))
    yield Table(
        key="deformed joints",
        columns=(words("joint"), Column("undeformed"), Column("deformed")),
        rows=tuple(rows),
        caption="Joint forces in the undeformed and in the deformed pose",
        under=(("load case", case.name),),
    )


def _ways_to_hold(result: CheckResult, case: LoadCaseResult) -> Iterator[Table]:
    asked, play = result.case.ways_to_hold, case.forces.play is not None
    if asked is None or not case.ways_to_hold:
        return
    rows: list[tuple[str | Number | None, ...]] = [
        (held.name, *(Number(float(x), decimals=2) for x in held.displacement), Number(held.size, "", 3),
         Number(held.play, "", 3))
        for held in case.ways_to_hold
    ]  # fmt: skip
    if asked.published is not None and asked.load_case in (None, case.name):
        source = f"published{f': {asked.source}' if asked.source else ''}"
        rows.append((source, "", "", "", Number(asked.published, stated=True, derived=True), ""))
    yield Table.of(
        (
            words("held"),
            *(Column(axis, "mm") for axis in "xyz"),
            Column("total", "mm"),
            Column("play, to either side", "mm") if play else None,
        ),
        rows,
        key="ways to hold",
        caption=f"Displacement of {asked.at} on {asked.link} by the linear frame, for different supports",
        under=(("load case", case.name),),
    )


def _model(result: CheckResult) -> str:
    joints = result.pose.linkage.joints
    bonded = " and ".join(
        f"{kind} joints ({', '.join(names)})"
        for kind, clamped in (("bonded", False), ("clamped", True))
        if (names := [name for name, joint in joints.items() if joint.fixed and joint.clamped == clamped])
    )
    pins = "The pins rotate freely about their own axis and transmit all other moments"
    pins += f", but for {bonded}, which transmit all." if bonded else "."
    if result.case.joint_model == "bonded":
        pins = "The joints are bonded: they transmit all moments."
    return (
        f"The frame model has Timoshenko beams for the links. {pins} The linear solution is valid while no point moves "
        "by more than 5 % of the span, the largest distance between two points of the pose. Beyond that, equilibrium "
        "is solved in the deformed pose, which then gives joint forces, stresses and the verdict. The limit-load "
        "factor is the factor on all loads at which the path of stable equilibrium ends; it is followed to ten times "
        "the load."
    )


def _data(result: CheckResult, case: LoadCaseResult) -> dict[str, Any]:
    moved = case.large_displacement
    deformed = moved.reactions
    return {
        "joint_forces": entries(case.forces, "model reason"),
        "large_displacement": entries(moved, "state span linear where held")
        | {
            "sentence": data(moved.reason),
            "buckling": None if moved.buckling is None or math.isinf(moved.buckling) else moved.buckling,
            "points": [
                {"link": link, "point": point, "displacement": d.tolist()} for (link, point), d in moved.points.items()
            ],
            "reactions": deformed and reaction_records(deformed),
            "drive_torque": deformed and deformed.drive_torque,
            "drive_force": deformed and deformed.drive_force,
        },
        "linkage": entries(case.linkage, "limit_load displacement where dead_point_distance")
        | {"where": data(case.linkage.where) or None},
        "play": play_record(case.forces.play),
        "thrust": [{"joint": joint, "force": data(thrust)} for joint, thrust in thrusts(case.forces, deformed).items()],
        "pins": pin_record(case),
        "ways_to_hold": [entries(held, "name displacement size play") for held in case.ways_to_hold],
        **mode_records(case),
        **({"fatigue": fatigue} if (fatigue := link_fatigue_record(result, case)) else {}),
    }


def _large(result: CheckResult) -> str:
    states = {name: case.large_displacement for name, case in result.load_cases.items()}
    followed = [name for name, moved in states.items() if moved.followed]
    blind = [name for name, moved in states.items() if moved.state in ("off", "unknown")]
    small = [name for name in states if name not in followed and name not in blind]
    undeformed = "forces are those of the undeformed pose"
    told = []
    if small:
        told.append(f"{_under(result, small)}{undeformed}, since displacements are small")
    if blind:
        told.append(f"{_under(result, blind)}{undeformed}, without check of displacements")
    if followed:
        deformed = "equilibrium is that of the deformed pose under loads of constant direction"
        told.append(f"{_under(result, followed)}{deformed}")
        stated = [result.case.load_cases[name] for name in followed]
        axes = {force.axes for case in stated for force in case.forces}
        axes |= {spread.axes for case in stated for spread in case.spread}
        if result.case.springs or result.case.tendons:
            told.append("springs and tendons follow the points at which they are fastened")
        if "link" in axes:
            told.append("a load in link axes turns with the pose of its link, but not with the deformation")
    return sentence("; ".join(told))


def _under(result: CheckResult, names: list[str]) -> str:
    return "" if len(names) == len(result.load_cases) else f"under {joined(names)} "


def _buckling(result: CheckResult) -> str:
    checks = [check for case in result.load_cases.values() for check in case.checks]
    judged = {check.subject for check in checks if check.quantity is Quantity.BUCKLING_FACTOR}
    links = [link for link in result.case.checked_links if Subject.link(link) in judged]
    columns = [link for link in links if result.case.part_of(link).is_beam]
    solids = [link for link in result.case.checked_links if not result.case.part_of(link).is_beam]
    was = "was" if len(columns) == 1 else "were"
    found = f"{joined(columns)} {was} checked"
    if not columns:
        found = f"No {'beam' if solids else 'link'} is in compression; one that is would be checked"
    found += f" as {'straight elastic columns' if len(columns) > 1 else 'a straight elastic column'}"
    if solids:
        found += f". {joined(solids)} {'is no beam' if len(solids) == 1 else 'are no beams'}: elastic solids are looked"
        found += f" at up to {MOST:g} times the load"
    found += ". Initial curvature is not modelled, nor is local buckling of thin walls of beams"
    followed = all(case.large_displacement.followed for case in result.load_cases.values())
    unseen = [name for name, case in result.load_cases.items() if case.large_displacement.buckling is None]
    if unseen:
        found += f". Buckling of the whole linkage was not checked {_under(result, unseen)}".rstrip()
    elif LINKAGE in judged and not followed:
        found += ". Buckling of the whole linkage was checked by linear theory"
    return f"{found}."
