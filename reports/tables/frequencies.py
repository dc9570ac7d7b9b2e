"""Natural frequencies as records, and as rows of a table."""

from typing import Any

from alula.fea.vibration.frequency_outcomes import (
    least_at,
    least_frequency,
    lowest_frequency,
    most_moved,
    nearest_or_met,
    told,
    unit,
)
from alula.fea.vibration.harmonics import HIGHEST, meetings
from alula.fea.vibration.link_modes import LinkModes
from alula.fea.vibration.over_motion import CaseFrequencies, FrequencyHistory
from alula.loads.case.case import Case
from alula.reports.sections.data import data, entries
from alula.reports.sentences import told as in_words
from alula.reports.sentences.motion import directions
from alula.reports.words.numbers import sentence

LEFT_OUT = (
    "damping",
    "friction of joints",
    "play of pins",
    "Coriolis and gyroscopic forces of the motion",
    "mass of the air that moves along",
)
"""What natural frequencies leave out."""


def frequencies_record(found: CaseFrequencies | None) -> dict[str, Any] | None:
    """Return natural frequencies as plain data.

    Parameters
    ----------
    found : CaseFrequencies or None

    Returns
    -------
    dict or None
        None where they were not computed.
    """
    if found is None:
        return None
    case = found.case
    return {
        "coordinate": None if case.motion is None else case.motion_coordinate,
        "unit": None if case.motion is None else unit(case),
        "prestress": "included",
        "left_out": list(LEFT_OUT),
        "highest_harmonic": HIGHEST,
        "load_cases": {name: _history(case, history) for name, history in found.histories.items()},
        "links": {name: _link(modes) for name, modes in found.links.items()},
    }


def _history(case: Case, history: FrequencyHistory) -> dict[str, Any]:
    lowest, least, driving = history.lowest, least_frequency(history), history.driving
    poses = case.motion is not None
    return {
        "driving": driving or None,
        "at": [told(case, float(value)) for value in history.at] if poses else None,
        "frequencies": data(history.frequencies),
        "low": data(history.low),
        "high": data(history.high),
        "lowest": {
            "at": told(case, least_at(history)) if poses else None,
            "frequency": data(least),
            "ratio": data(least.times(1.0 / driving)) if driving else None,
            "modes": [
                entries(mode, "frequency in_plane") | {"moves_most": most_moved(lowest, mode) or None}
                for mode in lowest.modes
            ],
        },
        "harmonics": [
            entries(met, "harmonic frequency mode")
            | {"ranges": [[told(case, end) for end in ends] for ends in met.ranges] if poses else None}
            for met in meetings(history)
        ],
        "poses_left_out": [told(case, value) for value in history.left_out],
        "notes": data(lowest.notes),
        "sentence": history_sentence(case, history),
    }


def _link(modes: LinkModes) -> dict[str, Any]:
    return entries(modes, "model held") | {"modes": [entries(mode, "frequency in_plane") for mode in modes.modes]}


def history_sentence(case: Case, history: FrequencyHistory) -> str:
    """Say where the lowest natural frequency is least, and which harmonic meets one.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory

    Returns
    -------
    str
    """
    told_of = in_words(lowest_frequency(case, history))
    return sentence(f"{told_of}; {in_words(nearest_or_met(case, history))}" if history.driving else told_of)


def mode_rows(found: CaseFrequencies) -> list[dict[str, Any]]:
    """Return a row for every natural frequency: of the linkage where the lowest is least, and of links by themselves.

    Parameters
    ----------
    found : CaseFrequencies

    Returns
    -------
    list of dict
        With ``subject``, ``load_case``, ``number``, ``frequency``, ``ratio`` (to the driving frequency, None without
        one), ``moves`` and ``most``.
    """
    rows: list[dict[str, Any]] = []
    for name, history in found.histories.items():
        for k, mode in enumerate(history.lowest.modes):
            rows.append(
                {
                    "subject": "the linkage",
                    "load_case": name,
                    "number": k + 1,
                    "frequency": mode.frequency,
                    "ratio": mode.frequency.times(1.0 / history.driving) if history.driving else None,
                    "moves": directions(mode.in_plane),
                    "most": most_moved(history.lowest, mode),
                }
            )
    for link, modes in found.links.items():
        for k, own in enumerate(modes.modes):
            rows.append(
                {
                    "subject": link,
                    "load_case": "",
                    "number": k + 1,
                    "frequency": own.frequency,
                    "ratio": None,
                    "moves": directions(own.in_plane),
                    "most": in_words(modes.held),
                }
            )
    return rows
