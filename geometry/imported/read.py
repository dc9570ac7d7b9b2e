"""What is found in a STEP file or a mesh, asked of the geometry kernel's child process."""

import hashlib
from pathlib import Path
from typing import Any

from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.kernel_child import KernelWords, ask_kernel
from alula.geometry.imported.facts import MESH_FORMATS, PartFacts, PartSurface
from alula.geometry.imported.files_read import note_read, refuse_elsewhere
from alula.geometry.keeping.kept import kept

LARGEST_FILE = 200_000_000
"""Bytes."""
TIME_LIMIT = 120.0
"""Seconds in which the kernel has to read a file and find its bores."""
MEMORY_LIMIT = 3e9
"""Bytes for the same."""
_FIRST, _LAST, _TAIL = b"ISO-10303-21;", b"END-ISO-10303-21;", 4096
"""What a STEP file begins and ends with (ISO 10303-21), and how far from its end that is looked for [bytes]."""
_SIMPLER = "export the part alone, without threads, lettering and other fine details"
_known: dict[tuple[str, float | None], PartFacts] = {}


def part_facts(path: Path, mesh_unit: float | None = None) -> PartFacts:
    """Return what is found in a file of one solid; a file of the same content is read only once.

    Parameters
    ----------
    path : Path
        The file.
    mesh_unit : float or None, optional
        Unit of length of a mesh [mm]; None for a STEP file.

    Returns
    -------
    PartFacts
        Volume, centroid, inertia, bounds and bores.

    Raises
    ------
    CaseError
        Where it holds no single solid.
    CannotRunError
        Where the kernel fails, crashes or exceeds a limit.
    """
    key = file_digest(path, mesh=mesh_unit is not None), mesh_unit
    if key not in _known:
        _known[key] = _ask("facts", path, *key)
    return _known[key]


def part_surface(path: Path, mesh_unit: float | None = None) -> PartSurface:
    """Return triangles of the surface of the solid in a file.

    Parameters
    ----------
    path : Path
        The file.
    mesh_unit : float or None, optional
        Unit of length of a mesh [mm]; None for a STEP file.

    Returns
    -------
    PartSurface
        For pictures.

    Raises
    ------
    CaseError, CannotRunError
        As ``part_facts``.
    """
    found: PartSurface = _ask("surface", path, file_digest(path, mesh=mesh_unit is not None), mesh_unit)
    return found


@kept()
def _ask(task: str, path: Path, digest: str, mesh_unit: float | None) -> Any:
    words = KernelWords(
        who=f"the geometry kernel, reading '{path.name}',",
        late=_SIMPLER,
        large=_SIMPLER,
        crashed="export the part anew",
        failed="mend the part in its CAD program (join its faces, remove edges that are too short) and export it anew",
    )
    subject: tuple[object, ...] = str(path.absolute()), digest
    if mesh_unit is not None:
        task, subject = f"{task} of mesh", (*subject, mesh_unit)
    found = ask_kernel(task, subject, words=words, time_limit=TIME_LIMIT, memory=MEMORY_LIMIT)
    if file_digest(path, mesh=mesh_unit is not None) != digest:  # nothing is kept for the content that it had
        raise CannotRunError(f"the file '{path.name}' changed while it was read; run once more")
    return found


def file_digest(path: Path, *, mesh: bool = False) -> str:
    """Return the SHA-256 of a file's content; refuse what is no STEP file, or no mesh, at first sight.

    Parameters
    ----------
    path : Path
        The file.
    mesh : bool, optional
        True for a mesh.

    Returns
    -------
    str
        In hexadecimal.

    Raises
    ------
    CaseError
        Where there is no such file, or it is too large, of another format or cut off.
    """
    refuse_elsewhere(path)
    kind = "mesh file" if mesh else "STEP file"
    try:
        if path.is_dir():
            raise CaseError(f"'{path}' is a folder; name the {kind} in it")
        if not path.is_file():
            raise CaseError(f"there is no file '{path}'; name an existing {kind}")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise CaseError(f"'{path}' has more than the {LARGEST_FILE / 1e6:.0f} MB that are read; {_SIMPLER}")
        if mesh and path.suffix.lower() not in MESH_FORMATS:
            ends = ", ".join(MESH_FORMATS)
            raise CaseError(f"'{path}' is no mesh file by its name, which must end with {ends}; export the part as one")
        with path.open("rb") as stream:
            if mesh:
                return note_read(path, hashlib.file_digest(stream, "sha256").hexdigest())
            start = stream.read(_TAIL).removeprefix(b"\xef\xbb\xbf").lstrip()
            stream.seek(max(0, size - _TAIL))
            end = stream.read()
            if not start.startswith(_FIRST):
                what = "is empty" if size == 0 else f"is no STEP file: it does not begin with '{_FIRST.decode()}'"
                raise CaseError(f"'{path}' {what}; export the part as STEP (AP203, AP214 or AP242)")
            if _LAST not in end:
                raise CaseError(f"'{path}' is cut off: it does not end with '{_LAST.decode()}'; export the part anew")
            stream.seek(0)
            return note_read(path, hashlib.file_digest(stream, "sha256").hexdigest())
    except OSError as error:
        raise CaseError(f"'{path}' cannot be read ({error.strerror}); check its permissions") from None
