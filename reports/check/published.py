"""``claims.html`` and the page of Markdown: which published figures hold, and whether published statics are right."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence

from alula.fea.claims.audit import ClaimResult, Finding
from alula.fea.outcomes.result import CheckResult
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.markdown import cell, table_lines
from alula.reports.renderers.page import Page, as_page
from alula.reports.sections.markup import link
from alula.reports.sections.published import WORDS, claims_section, count, note_of, statics_count, statics_section
from alula.reports.sections.table import Table, words

CLAIMS = "claims.html"
LONGEST_TABLE = 300
"""Claims of one source beyond which its page of Markdown lists those alone that do not hold."""
_HEADS = "claim", "published", "ours", "finding", ""


def published_page(result: CheckResult, found: Sequence[ClaimResult], report: str) -> tuple[str, str]:
    """Return the page of what was published of a case that was checked.

    Parameters
    ----------
    result : CheckResult
    found : sequence of ClaimResult
        Of the figures that were published of it.
    report : str
        Name of the report in the same folder.

    Returns
    -------
    page, told : str
        The page, and how many figures there are in a sentence or two; both empty where nothing was published.
    """
    audit, stated = result.audit, result.case.published_statics
    sections, told = [], []
    if found:
        sections.append(claims_section(found))
        told.append(f"Published figures: {count(found)}")
    if audit is not None:
        sections.append(statics_section(audit, 0.0 if stated is None else stated.tolerance))
        told.append(f"Published statics: {statics_count(audit)}")
    if not sections:
        return "", ""
    page = Page(
        title=f"Published figures: {result.case.title}",
        kind="Published figures, re-derived",
        heading=result.case.title,
        lead=(f"{link('The report of the check', report)} stands in the same folder.",),
        sections=(*sections, provenance_section(result.case, result.date)),
    )
    return as_page(page), " ".join(told)


def as_json(results: Sequence[ClaimResult]) -> str:
    """Return the findings as a JSON list.

    Parameters
    ----------
    results : Sequence[ClaimResult]

    Returns
    -------
    str
    """
    return json.dumps(claims_section(results).data["claims"], indent=2, ensure_ascii=False)


def as_markdown(found: Mapping[str, Sequence[ClaimResult]], titles: Mapping[str, str]) -> str:
    """Return a Markdown page with the counts and a table of findings per source.

    Parameters
    ----------
    found : mapping
        Findings by name of the source.
    titles : mapping
        What each source is called.

    Returns
    -------
    str
    """
    counts = []
    for name, results in found.items():
        kinds = Counter(result.finding for result in results)
        counts.append((f"`{name}`", str(len(results)), *(str(kinds[kind]) for kind in WORDS)))
    heads = ("source", "claims", *(one for one, _ in WORDS.values()))
    lines = [
        "# Published figures, re-derived",
        "",
        "Made by `alula claims --markdown`. A figure *holds* where it is re-derived within its printed digits or a "
        "stated tolerance; it *does not hold* where another number comes out; it *does not follow* where the source's "
        "own figures give another number; it *cannot be re-derived* where the source leaves out what it needs, which "
        "is not the same as wrong.",
        "",
        *table_lines(Table(columns=tuple(map(words, heads)), rows=tuple(counts))),
    ]
    for name, results in found.items():
        shown = [result for result in results if len(results) <= LONGEST_TABLE or result.finding is not Finding.HOLDS]
        lines += ["", f"## {cell(titles[name])}", "", count(results)]
        if len(shown) < len(results):
            lines.append(f"Listed are those that do not hold; `alula claims {name}` lists all.")
        rows = [(r.claim.name, r.claim.published, r.ours or "", WORDS[r.finding][0], note_of(r)) for r in shown]
        lines += ["", *table_lines(Table(columns=tuple(map(words, _HEADS)), rows=tuple(rows)))]
    return "\n".join(lines) + "\n"
