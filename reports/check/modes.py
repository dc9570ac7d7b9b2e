"""In which modes eyes, walls, strips and notches end: by what each bears more than what acts."""

from collections.abc import Iterator
from typing import Any

from alula.fea.modes.wall_modes import WallMode
from alula.fea.outcomes.result import LoadCaseResult
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part
from alula.reports.sections.table import Column, Number, Table, words


def eye_parts(case: LoadCaseResult) -> Iterator[Part]:
    """Yield the factors of every mode of every checked eye under a load case.

    Parameters
    ----------
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    rows = [
        (eye.check, eye.link, eye.eye, Number(eye.force), Number(eye.angle, decimals=0), str(mode), Number(factor))
        for eye in case.eyes
        for mode, factor in sorted(eye.factors.items(), key=lambda of: of[1].low)
    ]
    if rows:
        yield Table.of(
            (
                *map(words, ("check", "link", "eye")),
                Column("force", "N"),
                Column("angle", "°"),
                words("mode"),
                Column("factor"),
            ),
            rows,
            key="eyes",
            caption="Eyes: what each mode bears over the force of the pin, ordered by low ends; the angle is that from "
            "the pull straight off the shank, 180° where the pin presses into it, so that bearing alone is left",
            under=(("load case", case.name),),
        )


def eye_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return the factors of eyes as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    return [
        entries(eye, "check link eye force angle")
        | {"modes": [{"mode": str(mode), "factor": data(factor)} for mode, factor in eye.factors.items()]}
        for eye in case.eyes
    ]


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
    known, beside = case.large_displacement.buckling, ""
    if known is not None and any(of.mode is WallMode.LATERAL for of in case.walls):
        beside = f"; the frame of the linkage turns aside and twists as well: it buckles at {known:.3g} times its load"
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
            caption="Thin walls and deep strips: by what loads may grow until a link buckles, ordered by "
            f"low ends; of a strip R/t is its depth over its thickness{beside}",
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


def notch_parts(case: LoadCaseResult) -> Iterator[Part]:
    """Yield what was found of the notches of every checked link under a load case.

    Parameters
    ----------
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    rows = [
        (
            one.check,
            one.link,
            Number(one.surface),
            Number(one.point),
            Number(one.line),
            Number(one.by_point),
            Number(one.by_line),
            Number(one.by_volume),
            Number(one.factor),
        )
        for one in case.notches
    ]
    if rows:
        yield Table.of(
            (
                *map(words, ("check", "link")),
                Column("surface", "MPa"),
                Column("at L/2", "MPa"),
                Column("mean over 2 L", "MPa"),
                Column("by point"),
                Column("by line"),
                Column("by volume"),
                Column("factor"),
            ),
            rows,
            key="notches",
            caption="Notches: largest principal stress of the surface where the link comes nearest to breaking, and "
            "ahead of it by the critical distance L; the factor holds both methods and all that leaves it open, and "
            "the lower of distance and volume counts",
            under=(("load case", case.name),),
        )


def notch_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return what was found of notches as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    every = "check link surface distance point line relieved by_point by_line by_volume effective_volume factor"
    return [entries(one, every) | {"location": data(one.location)} for one in case.notches]
