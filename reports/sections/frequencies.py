"""Natural frequencies over the motion, the harmonics of the drive that meet them, and those of links by themselves."""

from collections.abc import Iterator
from typing import Any

from alula.fea.vibration.frequency_outcomes import (
    deciding_load_case,
    least_at,
    least_frequency,
    lowest_frequency,
    most_moved,
    nearest_or_met,
    told,
    unit,
)
from alula.fea.vibration.harmonics import HIGHEST, meetings
from alula.fea.vibration.over_motion import CaseFrequencies, FrequencyHistory
from alula.loads.case.case import Case
from alula.reports.figures.vibration.campbell import campbell_diagram
from alula.reports.figures.vibration.shapes import shapes_drawing
from alula.reports.sections.data import data, entries
from alula.reports.sections.markup import bold
from alula.reports.sections.section import Folded, Part, Picture, Section, Series, Text, say
from alula.reports.sections.table import Cell, Column, Number, Table, words
from alula.reports.sentences import told as in_words
from alula.reports.sentences.places import directions
from alula.reports.words.numbers import joined, sentence

LEFT_OUT = (
    "damping",
    "friction of joints",
    "play of pins",
    "Coriolis and gyroscopic forces of the motion",
    "mass of the air that moves along",
)
"""What natural frequencies leave out."""


def frequencies_section(found: CaseFrequencies | None, *, alone: bool = False) -> Section:
    """Return natural frequencies.

    Parameters
    ----------
    found : CaseFrequencies or None
        None where they were not computed.
    alone : bool, optional
        True on a page of their own: pictures of all load cases in place of those of the one that decides, and its
        tables open.

    Returns
    -------
    Section
        Without parts where they were not computed.
    """
    if found is None:
        return Section(key="frequencies", data={"frequencies": None})
    return Section(
        key="frequencies",
        title="Natural frequencies",
        short="" if alone else "Natural frequencies",
        parts=tuple(_parts(found, alone=alone)),
        data={"frequencies": _record(found)},
        series=(_series(found),),
    )


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
    lowest = in_words(lowest_frequency(case, history))
    return sentence(f"{lowest}; {in_words(nearest_or_met(case, history))}" if history.driving else lowest)


def _parts(found: CaseFrequencies, *, alone: bool) -> Iterator[Part]:
    case, first, several = found.case, deciding_load_case(found), len(found.histories) > 1
    over = ", at poses over the motion" if case.motion is not None else ""
    yield Text(
        f"Frequencies at which the linkage vibrates by itself{over}, with its drive held (with the stiffness that is "
        "stated, if any) and its links flexible. A harmonic is a multiple of the driving frequency, the turns of the "
        "drive per second.",
        "note",
    )
    for name, history in sorted(found.histories.items(), key=lambda item: item[0] != first):
        yield Text((f"{bold(f'Load case {name}:')} " if several else "") + history_sentence(case, history))
        if alone or name == first:
            yield from _pictures(found, name)
    for note in dict.fromkeys(note for history in found.histories.values() for note in history.lowest.notes):
        yield say("{note}", "small", note=note)
    own = ", and those of links by themselves" if found.links else ""
    yield Folded(f"All natural frequencies{own}", (_table(found),), opened=alone, told=True)
    yield Text(
        f"The joint forces of the pose tighten or slacken the links (prestress included). Left out: "
        f"{joined(LEFT_OUT)}.",
        "small",
    )


def _pictures(found: CaseFrequencies, name: str) -> Iterator[Picture]:
    """Yield the pictures of a load case."""
    case, history, moves = found.case, found.histories[name], found.case.motion is not None

    coordinate = case.motion_coordinate.name if moves else "pose"
    lines = [f"Load case “{name}”."]
    if moves:
        lines.append("Left: natural frequencies with their bands over the motion.")
    if history.driving:
        side, over = ("Right: the", " over the motion") if moves else ("The", "")
        lines.append(
            "Dashed lines are harmonics of the drive; orange marks where one lies within the band of a natural "
            f"frequency. {side} range of each natural frequency{over} and the harmonics over the speed of the drive; "
            "the upright line is the stated speed. The natural frequencies are those at the stated speed."
        )
    yield Picture(
        name=f"campbell-{name}",
        alt=f"Natural frequencies over the motion and over the speed of the drive, load case {name}",
        caption=" ".join(lines),
        draw=lambda: campbell_diagram(history, coordinate=coordinate, unit=unit(case), load_case=name),
    )
    pose = " in the pose where the lowest is least" if moves else ""
    yield Picture(
        name=f"shapes-{name}",
        alt=f"Shapes in which the linkage vibrates, load case {name}",
        caption=f"Load case “{name}”: shapes of the lowest natural frequencies [Hz]{pose}, with their bands. "
        "Displacements are enlarged, each shape by a factor of its own. Shapes in the plane are seen along the pins, "
        "others from the side.",
        draw=lambda: shapes_drawing(history.lowest),
    )


def _table(found: CaseFrequencies) -> Table:
    """Return every natural frequency: of the linkage where the lowest is least, and of links by themselves."""
    rows: list[tuple[Cell, ...]] = []
    below: dict[int, str] = {}

    def row(k: int, *cells: Cell) -> tuple[Cell, ...]:
        return (*cells[:2], Number(k + 1, stated=True, derived=True), *cells[2:])

    for name, history in found.histories.items():
        for k, mode in enumerate(history.lowest.modes):
            ratio = Number(mode.frequency.times(1.0 / history.driving) if history.driving else None, derived=True)
            moves = (directions(mode.in_plane), most_moved(history.lowest, mode))
            rows.append(row(k, name, "the linkage", Number(mode.frequency), ratio, *moves))
    for link, own in found.links.items():
        modes = enumerate(own.modes)
        rows += [
            row(k, "", link, Number(mode.frequency), Number(None), directions(mode.in_plane), "") for k, mode in modes
        ]
        below[len(rows) - 1] = f"By itself, {link} is {in_words(own.held)}."
    several, driven = len(found.histories) > 1, any(history.driving for history in found.histories.values())
    pose = " in the pose where the lowest is least" if found.case.motion is not None else ""
    return Table.of(
        (
            words("load case") if several else None,
            words("subject"),
            Column("number"),
            Column("frequency (band)", "Hz"),
            Column("over the driving one") if driven else None,
            words("shape"),
            words("moves most"),
        ),
        rows,
        key="frequencies",
        caption=f"Natural frequencies of the linkage{pose}{', and of links by themselves' if found.links else ''}",
        below=below,
        under=() if several else (("load case", next(iter(found.histories), "")),),
    )


def _series(found: CaseFrequencies) -> Series:
    """Return natural frequencies over the motion, one load case below the other."""
    case = found.case
    at = "pose" if case.motion is None else f"{case.motion_coordinate} [{unit(case)}]"
    return Series.below(
        "frequencies.csv",
        {
            name: {at: [told(case, float(value)) for value in history.at]}
            | {
                f"{n + 1} {what} [Hz]": values[:, n]
                for n in range(history.frequencies.shape[1])
                for what, values in (("frequency", history.frequencies), ("low", history.low), ("high", history.high))
            }
            for name, history in found.histories.items()
        },
    )


def _record(found: CaseFrequencies) -> dict[str, Any]:
    case, links = found.case, found.links.items()
    return {
        "coordinate": None if case.motion is None else case.motion_coordinate.name,
        "unit": None if case.motion is None else unit(case),
        "prestress": "included",
        "left_out": list(LEFT_OUT),
        "highest_harmonic": HIGHEST,
        "load_cases": {name: _history(case, history) for name, history in found.histories.items()},
        "links": {
            name: entries(own, "model held") | {"modes": [entries(mode, "frequency in_plane") for mode in own.modes]}
            for name, own in links
        },
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
        "notes": data(list(lowest.notes)),
        "sentence": history_sentence(case, history),
    }
