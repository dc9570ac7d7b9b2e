"""What leaves the page as a file: the report of a check, and links as STEP files."""

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Literal

from alula.geometry.base.errors import CaseError
from alula.geometry.base.tidying import scratch_folder
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.text.explain import printable


def report(text: str, name: str, folder: Path, fidelity: Literal["beam", "solid"]) -> bytes:
    """Check a case and return its report, as ``alula check -o`` writes it; what was computed before is taken.

    Parameters
    ----------
    text : str
        The case file.
    name : str
        What the report calls the case.
    folder : Path
        Of the case, where files of its parts stand.
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

    case = _case(text, folder)
    found = with_findings(check_case(case, name=name, fidelity=fidelity, effort=effort_of(case)))
    return _written(lambda target: write_report(found, target, claims=claims_of(found)), REPORT)


def step(text: str, link: str, folder: Path) -> bytes:
    """Return the solid of a link as a STEP file.

    Parameters
    ----------
    text : str
        The case file.
    link : str
        A link with a part.
    folder : Path
        Of the case.

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

    case = _case(text, folder)
    if link not in case.links:
        raise CaseError(f"there is no link '{printable(link)}'; the case has {', '.join(case.links)}")
    with scratch_folder("alula-") as scratch:
        [file] = export_step({"link": case.body(link)}, scratch)
        return file.read_bytes()


def _case(text: str, folder: Path) -> Case:
    try:
        return validate(tomllib.loads(text), str(folder))
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"the text is no TOML ({error}); mend it first") from None


def _written(write: Callable[[Path], None], name: str) -> bytes:
    with scratch_folder("alula-") as scratch:
        write(scratch / "out")
        return (scratch / "out" / name).read_bytes()
