"""What checks found besides the numbers that they judge: a table and entries of ``result.json`` for each kind."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, Subject
from alula.fea.modes.connection_modes import ConnectionFactors
from alula.fea.modes.eye_modes import EyeFactors
from alula.fea.modes.line_contact import LineContact
from alula.fea.modes.notches import NotchFactor
from alula.fea.modes.wall_modes import WallFactor, WallMode
from alula.fea.outcomes.result import LoadCaseResult
from alula.fea.whole.permanent_set import LinkSet
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part
from alula.reports.sections.table import Cell, Column, Number, Table, words

Row = Sequence[Cell]


@dataclass(frozen=True, kw_only=True)
class Telling:
    """How one kind of numbers is told.

    Attributes
    ----------
    of : type
        Of the numbers.
    columns : tuple of Column
        After those of the check and its subject.
    rows : callable
        The cells of one record in them, in one row or several.
    entries : callable
        Its entries of ``result.json``, after those of the check and its subject.
    caption : str
    ordered : bool
        True where the records are ordered by the low ends of their factors.
    """

    of: type[Any]
    columns: tuple[Column, ...]
    rows: Callable[[Any], Sequence[Row]]
    entries: Callable[[Any], dict[str, Any]]
    caption: str
    ordered: bool = False


def _modes(head: Row, factors: Mapping[Any, Band]) -> list[Row]:
    """Return a row for each mode, ordered by low ends; first those that are not known."""
    every = sorted(factors.items(), key=lambda of: (not of[1].unknowable, of[1].low))
    return [(*head, str(mode), Number(factor)) for mode, factor in every]


def _listed(mode: str, factors: Mapping[Any, Band]) -> list[dict[str, Any]]:
    return [{mode: str(one), "factor": data(factor)} for one, factor in factors.items()]


KINDS = {
    "eyes": Telling(
        of=EyeFactors,
        columns=(words("eye"), Column("force", "N"), Column("angle", "°"), words("mode"), Column("factor")),
        rows=lambda eye: _modes((eye.eye, Number(eye.force), Number(eye.angle, decimals=0)), eye.factors),
        entries=lambda eye: entries(eye, "eye force angle") | {"modes": _listed("mode", eye.factors)},
        caption="Eyes: what each mode bears over the force of the pin, ordered by low ends; the angle is that from the "
        "pull straight off the shank, 180° where the pin presses into it, so that bearing alone is left",
    ),
    "notches": Telling(
        of=NotchFactor,
        columns=(
            Column("surface", "MPa"),
            Column("at L/2", "MPa"),
            Column("mean over 2 L", "MPa"),
            *(Column(title) for title in ("by point", "by line", "by volume", "factor")),
        ),
        rows=lambda one: [
            [
                Number(size)
                for size in (one.surface, one.point, one.line, one.by_point, one.by_line, one.by_volume, one.factor)
            ]
        ],
        entries=lambda one: entries(
            one,
            "location surface distance point line relieved by_point by_line by_volume effective_volume factor",
        ),
        caption="Notches: largest principal stress of the surface where the link comes nearest to breaking, and ahead "
        "of it by the critical distance L; the factor holds both methods and all that leaves it open, and the lower of "
        "distance and volume counts",
    ),
    "walls": Telling(
        of=WallFactor,
        columns=(
            words("mode"),
            Column("R/t"),
            Column("compression", "N"),
            Column("moment", "N·mm"),
            Column("moment that it bears alone", "N·mm"),
            Column("factor"),
        ),
        rows=lambda of: [
            (str(of.mode), *map(Number, (of.ratio, of.compression, of.moment, of.bears)), Number(of.factor))
        ],
        entries=lambda of: entries(of, "mode x compression moment bears ratio factor"),
        caption="Thin walls and deep strips: by what loads may grow until a link buckles, ordered by low ends; of a "
        "strip R/t is its depth over its thickness",
        ordered=True,
    ),
    "contacts": Telling(
        of=LineContact,
        columns=(
            Column("load", "N/mm"),
            Column("pressure", "MPa"),
            Column("half width", "mm"),
            words("against"),
            Column("factor"),
        ),
        rows=lambda one: [
            (*map(Number, (one.line_load, one.pressure, one.half_width)), what, Number(factor))
            for what, factor in one.factors.items()
        ],
        entries=lambda one: entries(one, "line_load pressure half_width") | {"against": _listed("what", one.factors)},
        caption="Pins in slots, along their line of contact: force over length, largest pressure by Hertz, half the "
        "width of contact, and the safety factor against yield of pin and flank, or on a stated pressure",
    ),
    "connections": Telling(
        of=ConnectionFactors,
        columns=(words("link"), Column("torque", "N·mm"), Column("force", "N"), words("mode"), Column("factor")),
        rows=lambda one: _modes((one.link, Number(float(one.load.torque)), Number(float(one.load.force))), one.factors),
        entries=lambda one: (
            {"link": one.link}
            | {name: float(size) for name, size in vars(one.load).items()}
            | {"modes": _listed("mode", one.factors)}
        ),
        caption="Connections: what each mode bears over what goes through the joint, ordered by low ends",
    ),
    "permanent_sets": Telling(
        of=LinkSet,
        columns=(
            words("link"),
            Column("adds along the load", "mm"),
            Column("bears times its loads"),
            Column("plastic strain"),
        ),
        rows=lambda one: [(one.link, *map(Number, (one.set, one.factor, one.strain)))],
        entries=lambda one: entries(one, "link set factor strain regained"),
        caption="Permanent set: what each link that yields adds to it, along the line of the load; others add nothing",
    ),
}
"""Key of the table and of the entries -> how what was found is told; a new kind of numbers is an entry here."""


def _subject(subject: Subject) -> dict[str, str]:
    """Return the name of a subject by what it is, a pin by its joint; nothing of the linkage."""
    return {} if subject == LINKAGE else {"link" if subject.kind == "link" else "joint": subject.name}


def mode_parts(case: LoadCaseResult) -> Iterator[Part]:
    """Yield a table of what checks found under a load case, for each kind.

    Parameters
    ----------
    case : LoadCaseResult

    Yields
    ------
    Part
    """
    for key, how in KINDS.items():
        found = case.found_of(how.of)
        if how.ordered:
            found = tuple(sorted(found, key=lambda one: one.numbers.factor.low))
        rows = [(one.check, *_subject(one.subject).values(), *row) for one in found for row in how.rows(one.numbers)]
        if rows:
            yield Table.of(
                (words("check"), *map(words, _subject(found[0].subject)), *how.columns),
                rows,
                key=key,
                caption=f"{how.caption}{_beside(case) if key == 'walls' else ''}",
                under=(("load case", case.name),),
            )


def _beside(case: LoadCaseResult) -> str:
    known = case.large_displacement.buckling
    if known is None or not any(of.numbers.mode is WallMode.LATERAL for of in case.found_of(WallFactor)):
        return ""
    return f"; the frame of the linkage turns aside and twists as well: it buckles at {known:.3g} times its load"


def mode_records(case: LoadCaseResult) -> dict[str, list[dict[str, Any]]]:
    """Return what checks found as entries of ``result.json``.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    dict of str to list of dict
        Without kinds of which nothing was found.
    """
    return {
        key: [{"check": one.check} | _subject(one.subject) | how.entries(one.numbers) for one in found]
        for key, how in KINDS.items()
        if (found := case.found_of(how.of))
    }
