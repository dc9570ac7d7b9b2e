"""Joint forces, what drives or holds the pose, springs, friction, and what the ground bears."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from alula.fea.check.anchor import anchor_loads
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses
from alula.loads.records.carried import CarriedSpread
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.statics import Reactions
from alula.reports.sections.data import entries
from alula.reports.sections.markup import code, sub
from alula.reports.sections.reactions import friction_record, reaction_parts, reaction_records
from alula.reports.sections.section import Folded, Part, Section, Text, say, under_load_cases
from alula.reports.sections.springs import holding_sentence, standing_record
from alula.reports.sections.table import Column, Number, Table, numbers, words
from alula.reports.words.numbers import joined, plain


def statics_section(result: CheckResult) -> Section:
    """Return joint forces of every load case, and what drives or holds the pose.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    first = next(iter(result.load_cases.values()))
    parts = under_load_cases({name: _parts(result, case) for name, case in result.load_cases.items()})
    sprung = result.case.sprung
    return Section(
        key="statics",
        title="Statics",
        short="Statics",
        parts=(*parts, Folded("How they are solved", (_method(result, first),))),
        data={
            "statics": _system(first),
            "reactions": [
                {"load_case": case.name} | reaction | {"moment": reaction["wrench"][5]}
                for case in result.load_cases.values()
                for reaction in reaction_records(case.reactions)
            ],
            **_drive(first.reactions),
            "load_cases": {name: _data(case) for name, case in result.load_cases.items()},
        },
        not_covered=((("Springs and stops", _SPRINGS),) if sprung else ()),
    )


_SPRINGS = (
    "Springs, tendons and stops have no mass, no friction and no give of their own but the stated stiffness. Where "
    "stops, and the legs of springs about joints, touch the links is not modelled: their moment enters at the eye of "
    "the joint."
)


def _parts(result: CheckResult, case: LoadCaseResult) -> Iterator[Part]:
    yield Text(f"{weight_sentence(result.case, case.name)}.")
    deformed = case.large_displacement.reactions
    yield from reaction_parts(case.name, case.reactions, case.forces, case.standing, case.work, case.loads, deformed)


def _method(result: CheckResult, first: LoadCaseResult) -> Text:
    driven = " with the drive torque" if first.reactions.drive and not holding_sentence(first.standing) else ""
    frame = "of the frame that gave the joint forces" if first.forces.frame else "moments divided by the longest link"
    size = len(first.reactions.system.rhs)
    return say(
        f"Each moving link is a free body with three equilibrium equations (ΣF{sub('x')}, ΣF{sub('y')}, ΣM). They are "
        f"assembled in the pose and solved together{driven}. Size {size} × {size}, condition number {{condition}} "
        f"({frame}). The equations are printed by {{command}}",
        condition=Number(first.forces.condition, "", 3),
        command=code(f"alula statics {result.name or 'CASE'} --matrix"),
    )


def weight_sentence(case: Case, name: str) -> str:
    """Return weight, inertia and massless links of a load case in one sentence, without its full stop.

    Parameters
    ----------
    case : Case
    name : str
        Of the load case.

    Returns
    -------
    str
    """
    load_case = case.load_cases[name]
    if not load_case.own_weight and load_case.speed == 0.0:
        return "The links are massless in this load case; weights are among the stated forces"
    kind = "weight" if load_case.speed == 0.0 else "weight and inertia" if load_case.own_weight else "inertia"
    told = [f"The links have {kind} from volume and density of their parts"]
    if pins := pin_masses(case):
        own = [f"{plain(float(f'{pin.mass * 1e6:.3g}'))} g at {joint} on {pin.link}" for joint, pin in pins.items()]
        told.append(f"pins weigh {joined(own)}")
    if case.carried and load_case.carried:
        carried = [
            f"{mass.link} carries {plain(float(f'{mass.mass * 1e6:.4g}'))} g "
            + (f"spread from {mass.start} to {mass.end}" if isinstance(mass, CarriedSpread) else f"at {mass.at}")
            for mass in case.carried
        ]
        told.append(joined(carried))
    elif case.carried:
        told.append("carried masses are left out")
    if load_case.speed != 0.0:
        told.append(f"{case.pose.coordinate} turns at {plain(load_case.speed * 30.0 / math.pi)} rpm")
    if case.massless:
        told.append(f"{joined(list(case.massless))} {'is' if len(case.massless) == 1 else 'are'} massless")
    return "; ".join(told)


def _system(case: LoadCaseResult) -> dict[str, object]:
    return {
        "size": len(case.reactions.system.rhs),
        "condition": case.forces.condition,
        "residual": case.reactions.residual,
    }


def _drive(reactions: Reactions) -> dict[str, float | None]:
    drive = reactions.drive
    force = drive is not None and drive.effort(reactions.pose.linkage) is DriveEffort.FORCE
    return {
        "drive_torque": None if drive is None else reactions.driving[0],
        "drive_force": reactions.driving[1] if force else None,
    }


def _data(case: LoadCaseResult) -> dict[str, object]:
    rubbed = {} if case.work is None else {"friction": friction_record(case.work, case.loads)}
    return {"statics": _system(case), **_drive(case.reactions), **rubbed, **standing_record(case.standing)}


def ground_section(result: CheckResult) -> Section:
    """Return force and moment on the ground, at each of its joints and in total.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    several = len(result.load_cases) > 1
    ground = result.pose.linkage.ground
    parts: list[Part] = [
        Text(
            f"Force and moment that the linkage exerts on its ground {ground}: at each joint, with the moment about "
            "that joint, and in total. The moment about z at the joint of the drive contains the reaction of the drive "
            "torque. Global axes: x and y in the plane of the linkage, z out of it.",
            "note",
        )
    ]
    components = [Column(f"{kind}{sub(axis)}", unit) for kind, unit in (("F", "N"), ("M", "N·mm")) for axis in "xyz"]
    records = {}
    for name, case in result.load_cases.items():
        anchor = anchor_loads(case)
        shape = ", in the deformed pose" if anchor.deformed else ""
        if anchor.unstable:
            shape = ", in the undeformed pose, since no stable equilibrium was found on the deformed one"
        rows = {**anchor.joints, f"total, about {anchor.about}": anchor.total}
        parts.append(
            Table(
                key="ground",
                columns=(words("at"), *components),
                rows=tuple((at, *numbers(wrench)) for at, wrench in rows.items()),
                under=(("load case", name),),
                caption=f"{f'Load case {name}' if several else 'On the ground'}{shape}",
            )
        )
        joints = [{"joint": at} | _wrench(values) for at, values in anchor.joints.items()]
        total = {"about": anchor.about} | _wrench(anchor.total)
        records[name] = {"anchor": {"joints": joints, "total": total, **entries(anchor, "deformed unstable")}}
    return Section(
        key="anchor",
        title="Loads on the ground",
        short="Loads on the ground",
        parts=tuple(parts),
        data={"load_cases": records},
    )


def _wrench(values: NDArray[np.float64]) -> dict[str, list[float]]:
    return {"force": values[:3].tolist(), "moment": values[3:].tolist()}
