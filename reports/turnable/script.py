"""The script that draws models in a page, as ``make viewer`` built it, and the digest of its sources."""

import hashlib
import re
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

FOLDER = files("alula.reports.turnable")


@cache
def viewer() -> str:
    """Return the script, with three.js and its licence inside.

    Returns
    -------
    str
    """
    return (FOLDER / "viewer.js").read_text(encoding="utf-8")


def built_from() -> str:
    """Return the digest of the sources that the script was built from, as its head states it.

    Returns
    -------
    str
        SHA-256, in hexadecimal digits.
    """
    found = re.search(r"sources sha256 ([0-9a-f]{64})", viewer()[:400])
    return found[1] if found else ""


def sources_digest(folder: Traversable = FOLDER) -> str:
    """Return the digest of the sources: of names and contents, in the order of the names, as ``build.js`` takes it.

    Parameters
    ----------
    folder : Traversable, optional
        Of the sources and what builds them.

    Returns
    -------
    str
        SHA-256, in hexadecimal digits.
    """
    sources = [f"source/{one.name}" for one in (folder / "source").iterdir()]
    digest = hashlib.sha256()
    for name in sorted(["build.js", "package.json", "package-lock.json", *sources]):
        text = folder.joinpath(*name.split("/")).read_text(encoding="utf-8")
        digest.update(f"{name}\n{text}\n".encode())
    return digest.hexdigest()
