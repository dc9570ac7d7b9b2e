"""Natural frequencies of the linkage over its motion, and of links by themselves."""

from collections.abc import Iterator
from typing import Any

from alula.fea.vibration.frequency_outcomes import deciding_load_case, unit
from alula.fea.vibration.over_motion import CaseFrequencies, FrequencyHistory
from alula.reports.sections.section import Column, Folded, Number, Part, Picture, Section, Table, Text, say, words
from alula.reports.tables.frequencies import LEFT_OUT, frequencies_record, history_sentence, mode_rows
from alula.reports.words.numbers import joined


def frequencies_section(found: CaseFrequencies | None, *, opened: bool = False) -> Section:
    """Return natural frequencies.

    Parameters
    ----------
    found : CaseFrequencies or None
    opened : bool, optional
        Whether a page shows their tables from the start.

    Returns
    -------
    Section
        Without parts where they were not computed.
    """
    return Section(
        key="frequencies",
        title="Natural frequencies",
        short="Natural frequencies",
        parts=() if found is None else tuple(_parts(found, opened)),
        data={"frequencies": frequencies_record(found)},
    )


def _parts(found: CaseFrequencies, opened: bool) -> Iterator[Part]:
    moves, several = found.case.motion is not None, len(found.histories) > 1
    over = ", at poses over the motion" if moves else ""
    yield Text(
        f"Frequencies at which the linkage vibrates by itself{over}, with its drive held (with the stiffness that is "
        "stated, if any) and its links flexible. A harmonic is a multiple of the driving frequency, the turns of the "
        "drive per second.",
        "note",
    )
    first = deciding_load_case(found)
    for name, history in sorted(found.histories.items(), key=lambda item: item[0] != first):
        under = f"{name}: " if several else ""
        yield Text(f"{under}{history_sentence(found.case, history)}")
        yield from _pictures(found, name, history)
        for note in history.lowest.notes:
            yield say("{note}", "small", note=note)
    every = mode_rows(found)
    tables = [_linkage_modes(found, [row for row in every if row["load_case"]])]
    if own := [row for row in every if not row["load_case"]]:
        tables.append(_link_modes(own))
    title = f"All natural frequencies{', and those of links by themselves' if own else ''}"
    yield Folded(title, tuple(tables), opened=opened, told=True)
    yield Text(
        "The joint forces of the pose tighten or slacken the links (prestress included). Left out: "
        f"{joined(list(LEFT_OUT))}.",
        "small",
    )


def _linkage_modes(found: CaseFrequencies, rows: list[dict[str, Any]]) -> Table:
    least = " in the pose where the lowest is least" if found.case.motion is not None else ""
    return Table.of(
        (
            words("load case") if len(found.histories) > 1 else None,
            Column("no."),
            Column("frequency (band)", "Hz"),
            Column("over the driving one (band)"),
            words("shape"),
            words("moves most"),
        ),
        [
            (row["load_case"], str(row["number"]), Number(row["frequency"]), Number(row["ratio"]), row["moves"],
             row["most"])
            for row in rows
        ],
        key="frequencies",
        caption=f"Natural frequencies of the linkage{least}",
    )  # fmt: skip


def _link_modes(rows: list[dict[str, Any]]) -> Table:
    return Table(
        key="frequencies of links",
        columns=(
            words("link"),
            Column("no."),
            Column("frequency (band)", "Hz"),
            words("shape"),
            words("held", wraps=True),
        ),
        rows=tuple(
            (row["subject"], str(row["number"]), Number(row["frequency"]), row["moves"], row["most"]) for row in rows
        ),
        caption="Natural frequencies of links by themselves",
    )


def _pictures(found: CaseFrequencies, name: str, history: FrequencyHistory) -> Iterator[Picture]:
    """Yield diagram and shapes under a load case."""
    moves = found.case.motion is not None
    over = " over the motion" if moves else ""
    told = [f"Load case “{name}”."]
    if moves:
        told.append("Left: natural frequencies with their bands over the motion.")
    if history.driving:
        told.append(
            "Dashed lines are harmonics of the drive; orange marks where one lies within the band of a natural "
            f"frequency. {'Right: t' if moves else 'T'}he range of each natural frequency{over} and the harmonics over "
            "the speed of the drive; the upright line is the stated speed. The natural frequencies are those at the "
            "stated speed."
        )
    yield Picture(
        name=f"campbell-{name}",
        alt=f"Natural frequencies over the motion and over the speed of the drive, load case {name}",
        caption=" ".join(told),
        draw=lambda: _campbell(found, name, history),
    )
    least = " in the pose where the lowest is least" if moves else ""
    yield Picture(
        name=f"shapes-{name}",
        alt=f"Shapes in which the linkage vibrates, load case {name}",
        caption=f"Load case “{name}”: shapes of the lowest natural frequencies [Hz]{least}, with their bands. "
        "Displacements are enlarged, each shape by a factor of its own. Shapes in the plane are seen along the pins, "
        "others from the side.",
        draw=lambda: _shapes(history),
    )


def _campbell(found: CaseFrequencies, name: str, history: FrequencyHistory) -> Any:
    from alula.reports.figures.vibration.campbell import campbell_diagram

    case = found.case
    coordinate = "pose" if case.motion is None else case.motion_coordinate
    return campbell_diagram(history, coordinate=coordinate, unit=unit(case), load_case=name)


def _shapes(history: FrequencyHistory) -> Any:
    from alula.reports.figures.vibration.shapes import shapes_drawing

    return shapes_drawing(history.lowest)
