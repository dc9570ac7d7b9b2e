"""Pins in slots along their line of contact, and what fixes links to shafts and to each other."""

from collections.abc import Iterator
from typing import Any

from alula.fea.outcomes.result import LoadCaseResult
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part
from alula.reports.sections.table import Column, Number, Table, words


def connection_parts(case: LoadCaseResult) -> Iterator[Part]:
    """Yield contacts in slots and connections under a load case.

    Parameters
    ----------
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    under = (("load case", case.name),)
    rows = [
        (
            one.check,
            one.joint,
            Number(one.line_load),
            Number(one.pressure),
            Number(one.half_width),
            what,
            Number(factor),
        )
        for one in case.contacts
        for what, factor in one.factors.items()
    ]
    if rows:
        yield Table.of(
            (
                *map(words, ("check", "joint")),
                Column("load", "N/mm"),
                Column("pressure", "MPa"),
                Column("half width", "mm"),
                words("against"),
                Column("factor"),
            ),
            rows,
            key="contacts",
            caption="Pins in slots, along their line of contact: force over length, largest pressure by Hertz, half "
            "the width of contact, and the safety factor against yield of pin and flank, or on a stated pressure",
            under=under,
        )
    held = [
        (
            *(one.check, one.joint, one.link),
            *(Number(float(size)) for size in (one.load.torque, one.load.force)),
            *(str(mode), Number(factor)),
        )
        for one in case.connections
        for mode, factor in sorted(one.factors.items(), key=lambda of: (not of[1].unknowable, of[1].low))
    ]
    if held:
        yield Table.of(
            (
                *map(words, ("check", "joint", "link")),
                Column("torque", "N·mm"),
                Column("force", "N"),
                words("mode"),
                Column("factor"),
            ),
            held,
            key="connections",
            caption="Connections: what each mode bears over what goes through the joint, ordered by low ends",
            under=under,
        )


def contact_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return contacts in slots as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    return [
        entries(one, "check joint line_load pressure half_width")
        | {"against": [{"what": what, "factor": data(factor)} for what, factor in one.factors.items()]}
        for one in case.contacts
    ]


def connection_record(case: LoadCaseResult) -> list[dict[str, Any]]:
    """Return connections as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    list of dict
    """
    return [
        entries(one, "check joint link")
        | {name: float(size) for name, size in vars(one.load).items()}
        | {"modes": [{"mode": str(mode), "factor": data(factor)} for mode, factor in one.factors.items()]}
        for one in case.connections
    ]
