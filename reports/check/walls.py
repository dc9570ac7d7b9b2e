"""Thin walls and deep strips: by what a link's loads may grow until it buckles in each of their modes."""

from collections.abc import Iterator
from typing import Any

from alula.fea.outcomes.result import LoadCaseResult
from alula.fea.outcomes.wall_modes import WallMode
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part
from alula.reports.sections.table import Column, Number, Table, words


def wall_parts(case: LoadCaseResult) -> Iterator[Part]:
    """Yield the factors of every mode of every checked link under a load case.

    Parameters
    ----------
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    rows = [
        (of.check, of.link, str(of.mode), Number(of.ratio), Number(of.compression), Number(of.moment),
         Number(of.bears), Number(of.factor))
        for of in sorted(case.walls, key=lambda of: of.factor.low)
    ]  # fmt: skip
    frame, known = "", case.large_displacement.buckling
    if known is not None and any(of.mode is WallMode.LATERAL for of in case.walls):
        frame = f"; the frame of the linkage, whose beams turn aside and twist as well, buckles at {known:.3g} times its load"
    if rows:
        yield Table.of(
            (
                *map(words, ("check", "link", "mode")),
                Column("R/t"),
                Column("compression", "N"),
                Column("moment", "N·mm"),
                Column("moment that it bears alone", "N·mm"),
                Column("factor"),
            ),
            rows,
            key="walls",
            caption="Thin walls and deep strips: by what all loads may grow until a link buckles in each mode, by low ends; "
            f"of a strip R/t is its depth over its thickness{frame}",
            under=(("load case", case.name),),
        )


def wall_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return the factors of thin walls as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    return [
        entries(of, "check link mode x compression moment bears ratio") | {"factor": data(of.factor)}
        for of in case.walls
    ]
