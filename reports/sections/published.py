"""Published figures, re-derived, and published statics, solved and checked."""

from collections import Counter
from collections.abc import Iterator, Sequence

from alula.fea.claims.audit import ClaimResult, Finding
from alula.loads.sources.published_statics import StaticsAudit
from alula.reports.sections.data import entries
from alula.reports.sections.markup import sub
from alula.reports.sections.section import Folded, Part, Section, Text, say
from alula.reports.sections.table import Column, Number, Table, words
from alula.reports.sentences import told
from alula.reports.words.numbers import sentence

WORDS = {
    Finding.HOLDS: ("holds", "hold"),
    Finding.DOES_NOT_HOLD: ("does not hold", "do not hold"),
    Finding.DOES_NOT_FOLLOW: ("does not follow", "do not follow"),
    Finding.CANNOT_BE_REDERIVED: ("cannot be re-derived", "cannot be re-derived"),
}
_COLUMNS = (
    words("figure", role="what"),
    Column("published", role="who"),
    Column("re-derived", role="value"),
    words("finding", role="found"),
    words("reason", role="note", wraps=True),
)
_LISTS = (
    ("Figures that do not hold or do not follow", (Finding.DOES_NOT_HOLD, Finding.DOES_NOT_FOLLOW)),
    ("Figures that hold", (Finding.HOLDS,)),
    ("Figures that cannot be re-derived", (Finding.CANNOT_BE_REDERIVED,)),
)


def count(results: Sequence[ClaimResult]) -> str:
    """Return the number of claims of each finding, in one sentence.

    Parameters
    ----------
    results : sequence of ClaimResult

    Returns
    -------
    str
    """
    found = Counter(result.finding for result in results)
    each = ", ".join(f"{found[kind]} {one if found[kind] == 1 else several}" for kind, (one, several) in WORDS.items())
    return f"{len(results)} {'claim' if len(results) == 1 else 'claims'}: {each}."


def claims_section(results: Sequence[ClaimResult], title: str = "Published figures") -> Section:
    """Return what became of published figures.

    Parameters
    ----------
    results : sequence of ClaimResult
    title : str, optional

    Returns
    -------
    Section
        Its only entry of data, ``claims``, is what ``alula claims --json`` lists.
    """
    note = Text(
        "A figure that cannot be re-derived from its source is not necessarily wrong. Figures that need a solid model "
        "of the source’s own parts are not judged, since the source states neither eyes nor pins nor meshes.",
        "note",
    )
    claims = [
        entries(result.claim, "name")
        | {"quantity": result.claim.quantity or result.claim.stated, "published": result.claim.published}
        | entries(result, "ours finding")
        | {"source": result.claim.source, "note": note_of(result)}
        for result in results
    ]
    # A console ends with the number, which a long list would carry away.
    parts: tuple[Part, ...] = (Text(count(results), "note"), note, *_lists(results))
    return Section(key="claims", title=title, parts=parts, data={"claims": claims})


def _lists(results: Sequence[ClaimResult]) -> Iterator[Folded]:
    for title, findings in _LISTS:
        if rows := [_row(result) for result in results if result.finding in findings]:
            table = Table(columns=_COLUMNS, rows=tuple(rows), kind="checks claims")
            opened = Finding.DOES_NOT_HOLD in findings
            yield Folded(f"{title} ({len(rows)})", (table,), opened=opened, told=True)


def note_of(result: ClaimResult) -> str:
    """Return what was found of a figure, in plain sentences.

    Parameters
    ----------
    result : ClaimResult

    Returns
    -------
    str
    """
    return " ".join(note if isinstance(note, str) else sentence(told(note)) for note in result.notes)


def _row(result: ClaimResult) -> tuple[str, ...]:
    found, _ = WORDS[result.finding]
    return result.claim.name, result.claim.published, result.ours or "–", found, note_of(result)


def statics_section(audit: StaticsAudit, tolerance: float) -> Section:
    """Return what is wrong with published statics.

    Parameters
    ----------
    audit : StaticsAudit
    tolerance : float
        On a row of the matrix, as a share.

    Returns
    -------
    Section
    """
    wrong = [row for row in audit.rows if not row.valid]
    parts: list[Part] = [
        say(
            "{source}: {size} equations for as many unknowns, solved here. The unrounded coefficients {exact}; "
            "the printed, rounded ones give them within {error}; rounding allows {bound} (N and N·m)",
            source=audit.source,
            size=len(audit.columns),
            exact="give the published reactions to every printed digit"
            if audit.reproduced
            else "do not give the published reactions",
            error=Number(audit.printed_error, digits=2),
            bound=Number(audit.rounding_bound, digits=2),
        ),
        Text(
            f"{statics_count(audit)} No choice of moment point and sign makes {'them' if len(wrong) > 1 else 'it'} one."
            if wrong
            else "Every equation is one of equilibrium of its link."
        ),
    ]
    if wrong:
        part = "part of the row that is not an equilibrium equation"
        rows = tuple((str(row.number), row.link, Number(row.defect, digits=3, factor=100.0)) for row in wrong)
        largest = max((row.defect for row in audit.rows if row.valid), default=0.0)
        parts += [
            Table(key="equations", columns=(Column("equation"), words("link"), Column(part, "%")), rows=rows),
            say(
                "Tolerance {tolerance} %, since the source’s angles differ slightly from those of the assembled pose; "
                "the largest part among the other equations is {largest} %",
                "small",
                tolerance=Number(tolerance, stated=True, factor=100.0),
                largest=Number(largest, digits=2, factor=100.0),
            ),
        ]
    forces, moment = [Column(f"ΣF{sub(axis)}", "N") for axis in "xy"], Column("ΣM about the link’s origin", "N·mm")
    reactions = zip(audit.columns, audit.published, audit.exact, audit.printed, strict=True)
    parts += [
        Table(
            key="imbalances",
            caption="Unbalanced force and moment of the published reactions on each link in the assembled pose",
            columns=(words("link"), *forces, moment),
            rows=tuple(
                (left.link, *(Number(x, decimals=4) for x in left.force[:2]), Number(left.moment, decimals=2))
                for left in audit.imbalances
            ),
        ),
        Table(
            key="reactions",
            caption="Published and re-solved reactions [N; T in N·m], signs as published",
            columns=(words("unknown"), *map(Column, ("published", "unrounded coefficients", "printed coefficients"))),
            rows=tuple((name, *(Number(float(x), decimals=4) for x in values)) for name, *values in reactions),
        ),
    ]
    return Section(key="published", title="Published statics, solved and checked", parts=tuple(parts))


def statics_count(audit: StaticsAudit) -> str:
    """Return how many of the published equations are none of equilibrium, in one sentence.

    Parameters
    ----------
    audit : StaticsAudit

    Returns
    -------
    str
    """
    wrong = sum(not row.valid for row in audit.rows)
    verb = "is not an equilibrium equation" if wrong == 1 else "are not equilibrium equations"
    return f"{wrong} of {len(audit.rows)} equations {verb}."
