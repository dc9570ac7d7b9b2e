"""``claims.html``: which published figures hold, on a page of its own beside the report."""

from collections.abc import Sequence
from pathlib import Path

from alula.fea.claims.audit import ClaimResult
from alula.fea.outcomes.result import CheckResult
from alula.loads.sources.published_statics import StaticsAudit
from alula.reports.page.template import fill
from alula.reports.tables.claims import as_records, count

CLAIMS = "claims.html"


def claims_page(
    found: Sequence[ClaimResult],
    *,
    title: str,
    name: str,
    audit: StaticsAudit | None = None,
    tolerance: float = 0.0,
    report: str = "",
) -> str:
    """Return the page of published figures.

    Parameters
    ----------
    found : sequence of ClaimResult
    title, name : str
        Of the case or the source document.
    audit : StaticsAudit, optional
        Of published statics.
    tolerance : float, optional
        On a row of these.
    report : str, optional
        Address of the report of the same case, if there is one.

    Returns
    -------
    str
    """
    claims = {"count": count(found), "rows": as_records(found)} if found else None
    return fill(
        "claims.html.jinja",
        title=title,
        name=name,
        claims=claims,
        audit=audit,
        tolerance=tolerance,
        report=report,
    )


def write_claims(result: CheckResult, found: Sequence[ClaimResult], folder: Path, report: str) -> str:
    """Write the page of a case that was checked, if anything was published of it.

    Parameters
    ----------
    result : CheckResult
    found : sequence of ClaimResult
        Of the figures that were published of it.
    folder : Path
    report : str
        Name of the report in that folder.

    Returns
    -------
    str
        How many figures there are, in a sentence or two; "" where there is no page.
    """
    audit, statics = result.audit, result.case.published_statics
    if not found and audit is None:
        return ""
    page = claims_page(
        found,
        title=result.case.title,
        name=result.name,
        audit=audit,
        tolerance=0.0 if statics is None else statics.tolerance,
        report=report,
    )
    (folder / CLAIMS).write_text(page, encoding="utf-8")
    told = [f"Published figures: {count(found)}"] if found else []
    if audit is not None:
        wrong = sum(not row.valid for row in audit.rows)
        told.append(f"Published statics: {wrong} of {len(audit.rows)} equations are not equilibrium equations.")
    return " ".join(told)
