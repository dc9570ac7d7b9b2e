"""Limit-load factor and largest displacement of the linkage over a motion."""

from typing import Any

from alula.fea.motion.linkage_history import LinkageOverMotion, when
from alula.loads.states.case_motion import CaseMotion
from alula.reports.sections.data import data
from alula.reports.sections.section import Number, Text, say
from alula.reports.sentences import told
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

    def at(pose: int) -> float | None:
        return float(moved.motion.progress[pose]) if pose >= 0 else None

    return {
        "poses": [at(pose) for pose in over.poses],
        "limit_load": data(over.limit_load),
        "limit_load_at": at(over.limit_pose),
        "displacement": data(over.displacement),
        "displacement_at": at(over.displacement_pose),
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
    text = f"The linkage as a whole, in {len(over.poses)} of {len(moved.motion.angles)} poses: "
    text += f"least {limit_load(over.limit_load)}"
    if over.limit_pose >= 0:
        text += f" at {told(when(moved, over.limit_pose))}"
    if over.displacement.unknowable:
        return say(text)
    text += f", largest displacement {{displacement}} ({data(over.where) or None})"
    if over.displacement_pose >= 0:
        text += f" at {told(when(moved, over.displacement_pose))}"
    return say(text, displacement=Number(over.displacement, "mm"))
