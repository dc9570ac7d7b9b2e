"""Eyes: by what each of their modes bears more than the force of the pin."""

from collections.abc import Iterator
from typing import Any

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
