"""Gaps between links in layers, as records and as a line of text."""

from typing import Any

from alula.fea.whole.clearance import clearance_band, gap_reason
from alula.geometry.clearance.least import Gap
from alula.loads.states.clearance import Clearance
from alula.reports.sentences import told as in_words
from alula.reports.tables.data import data
from alula.reports.words.numbers import band, sentence

MOST = 12
"""Gaps that a table shows, the least first."""


def clearance_record(found: Clearance | None) -> dict[str, Any] | None:
    """Return the gaps of an assembly as plain data.

    Parameters
    ----------
    found : Clearance or None
        Its gaps.

    Returns
    -------
    dict or None
        None where no layers are stated.
    """
    if found is None:
        return None
    motion = found.motion
    return {
        "coordinate": None if motion is None else motion.coordinate,
        "unit": None if motion is None else motion.unit,
        "least": data(clearance_band(found)),
        "first_contact": None if found.contact is None else _gap(found, found.contact),
        "gaps": [_gap(found, gap) for gap in found.gaps],
        "heights": dict(found.assembly.case.heights),
    }


def _gap(found: Clearance, gap: Gap) -> dict[str, Any]:
    at = None if gap.at is None or found.motion is None else float(found.motion.told(gap.at))
    return {
        "between": list(gap.names),
        "value": gap.value,
        "low": gap.low,
        "high": gap.high,
        "touches": gap.touches,
        "at": at,
        "place": list(gap.place),
    }


def clearance_line(found: Clearance | None) -> str | None:
    """Return the least gap of an assembly, and its first contact, in a sentence or two.

    Parameters
    ----------
    found : Clearance or None
        Its gaps.

    Returns
    -------
    str or None
        None where no layers are stated.
    """
    if found is None:
        return None
    told = sentence(in_words(gap_reason(found)))
    return (
        told if found.least is None else f"Least gap between links in layers: {band(clearance_band(found))} mm. {told}"
    )
