"""What leaves the page as a file: the report of a check, and links as STEP files."""

from pathlib import Path
from typing import Literal

from alula.geometry.base.errors import CaseError
from alula.geometry.base.tidying import scratch_folder
from alula.loads.text.explain import printable
from alula.reports.workbench.live.answers import case_of


def report(text: str, name: str, fidelity: Literal["beam", "solid"]) -> bytes:
    """Check a case and return its report, as ``alula check -o`` writes it; what was computed before is taken.

    Parameters
    ----------
    text : str
        The case file.
    name : str
        Path of its file, beside which files of its parts stand.
    fidelity : {"beam", "solid"}
        Model that decides.

    Returns
    -------
    bytes
        ``report.html``.

    Raises
    ------
    CaseError, CannotRunError
        As ``check_case``.
    """
    from alula.fea.check.run import check_case, effort_of
    from alula.fea.claims.sources import claims_of
    from alula.fea.findings.of_check import with_findings
    from alula.reports.check.folder import REPORT, write_report

    case = case_of(text, name)
    found = with_findings(check_case(case, name=Path(name).name, fidelity=fidelity, effort=effort_of(case)))
    with scratch_folder("alula-") as scratch:
        write_report(found, scratch / "out", claims=claims_of(found))
        return (scratch / "out" / REPORT).read_bytes()


def step(text: str, name: str, link: str) -> bytes:
    """Return the solid of a link as a STEP file.

    Parameters
    ----------
    text : str
        The case file.
    name : str
        Path of its file.
    link : str
        A link with a part.

    Returns
    -------
    bytes
        In mm, in the link's frame.

    Raises
    ------
    CaseError, CannotRunError
        As ``export_step``, and where there is no such link.
    """
    from alula.geometry.meshing.mesh import export_step

    case = case_of(text, name)
    if link not in case.links:
        raise CaseError(f"there is no link '{printable(link)}'; the case has {', '.join(case.links)}")
    with scratch_folder("alula-") as scratch:
        [file] = export_step({"link": case.body(link)}, scratch)
        return file.read_bytes()
