"""With what a result was made, and of which files: so that a file can be shown later to be what was checked."""

import platform
from datetime import UTC, datetime
from pathlib import Path

from alula.geometry.base.version import alula_version
from alula.geometry.keeping.kept import library_versions, sources_digest
from alula.loads.case.case import Case
from alula.loads.text.explain import printable
from alula.reports.sections.markup import code
from alula.reports.sections.section import Items, Section

_BRIEF = 16
"""Digits of a digest at the foot of each sheet; the page ends with all 64."""


def provenance_section(case: Case, date: datetime | None = None) -> Section:
    """Return date, versions and digests of a result.

    Parameters
    ----------
    case : Case
    date : datetime, optional
        When it was found; now unless given.

    Returns
    -------
    Section
        Its running line stands at the foot of each printed sheet.
    """
    date = datetime.now(UTC) if date is None else date
    libraries, system = library_versions(), f"{platform.system()} {platform.machine()}"
    name, at = printable(Path(case.origin).name), f"{date:%Y-%m-%d %H:%M} UTC"
    used = ", ".join(f"{library} {version}" for library, version in libraries.items())
    items = [
        ("Made", f"{at} by alula {alula_version()}, Python {platform.python_version()} on {system}; {used}."),
        ("alula", f"SHA-256 of its sources {code(sources_digest())}."),
        ("Case", _of_case(case, name)),
        *(("Read for it", f"{code(printable(file))}, SHA-256 {code(digest)}.") for file, digest in case.files.items()),
    ]
    if case.changes:
        changes = ", ".join(code(f"{path} = {value}") for path, value in case.changes)
        items.append(("Changed beside the file", f"{changes}."))
    if case.digest:
        items.append(("To compare", f"{code('sha256sum FILE')} prints the SHA-256 of a file."))
    brief = f"SHA-256 {case.digest[:_BRIEF]}…" if case.digest else ""
    return Section(
        key="provenance",
        title="Made with what, of which files",
        short="Files",
        parts=(Items(tuple(items), "note"),),
        data={
            "provenance": {
                "date": date.isoformat(timespec="seconds"),
                "sources": sources_digest(),
                "python": platform.python_version(),
                "system": system,
                "libraries": libraries,
                "case": case.digest or None,
                "files": dict(case.files),
                "changes": dict(case.changes),
            }
        },
        running=" · ".join(filter(None, (name, brief, at, f"alula {alula_version()}"))),
    )


def _of_case(case: Case, name: str) -> str:
    """Return what the case was read from."""
    if not case.digest:
        return f"{code(name) if name else 'it'} was changed in Python after it was read."
    if not name:
        return f"put together in Python; SHA-256 of its tables as JSON with sorted keys {code(case.digest)}."
    return f"{code(name)}, SHA-256 {code(case.digest)}."
