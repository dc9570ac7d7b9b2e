"""Limit-load factor and largest displacement of the linkage over a motion."""

from typing import Any

from alula.fea.motion.linkage_history import LinkageOverMotion
from alula.loads.states.case_motion import CaseMotion
from alula.reports.sections.data import data
from alula.reports.sections.section import Number, Text, say
from alula.reports.words.numbers import limit_load


def linkage_over_motion(moved: CaseMotion, over: LinkageOverMotion) -> dict[str, Any]:
    """Return limit-load factor and largest displacement over a motion as an entry of ``result.json``.

    Parameters
    ----------
    moved : CaseMotion
    over : LinkageOverMotion
        Of a load case.

    Returns
    -------
    dict
    """

    def told(pose: int) -> float | None:
        return float(moved.motion.progress[pose]) if pose >= 0 else None

    return {
        "poses": [told(pose) for pose in over.poses],
        "limit_load": data(over.limit_load),
        "limit_load_at": told(over.limit_pose),
        "displacement": data(over.displacement),
        "displacement_at": told(over.displacement_pose),
        "where": data(over.where) or None,
    }


def linkage_text(moved: CaseMotion, over: LinkageOverMotion) -> Text:
    """Return limit-load factor and largest displacement over a motion in a sentence.

    Parameters
    ----------
    moved : CaseMotion
    over : LinkageOverMotion
        Of a load case.

    Returns
    -------
    Text
    """
    record, motion = linkage_over_motion(moved, over), moved.motion
    of = "" if motion.instants is not None else f"{motion.coordinate} = "
    unit = motion.progress_unit + (" of the cycle" if motion.instants is not None else "")
    told = f"Linkage in {len(over.poses)} of {len(moved.motion.angles)} poses: least {limit_load(over.limit_load)}"
    facts: dict[str, object] = {}
    if record["limit_load_at"] is not None:
        told += f" at {of}{{limit_at}}"
        facts["limit_at"] = Number(record["limit_load_at"], unit, 5)
    if not over.displacement.unknowable:
        told += f", largest displacement {{displacement}} ({record['where']})"
        facts["displacement"] = Number(over.displacement, "mm")
        if record["displacement_at"] is not None:
            told += f" at {of}{{displacement_at}}"
            facts["displacement_at"] = Number(record["displacement_at"], unit, 5)
    return say(told, **facts)
