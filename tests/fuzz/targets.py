"""What is fuzzed: whatever a function is given, it takes it (True) or refuses it in one sentence (False)."""

import json
import os
import tempfile
import tomllib
from collections.abc import Callable
from copy import deepcopy
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import Any

from fuzz.guard import watched
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import EXAMPLES, parse
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_case, read_companion, validate
from alula.loads.exchange.exchange import case_of_linkage
from alula.loads.sources.claim import Claim, read_printed
from alula.loads.sources.expression import Path as NamePath
from alula.loads.sources.expression import evaluate
from alula.loads.sources.quantity import Value
from alula.loads.stated.part_points import KINDS
from alula.loads.text.entries import known_keys
from alula.loads.text.explain import sentence

LONGEST_SENTENCE = 6000
"""Characters: a sentence may list names, but never the file."""
_FOLDER = Path(tempfile.mkdtemp(prefix="alula-fuzz-"))
_FILE = _FOLDER / "case.toml"


def starter() -> str:
    """Return the text of the starter case: the smallest valid one."""
    return files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8")


def seeds() -> dict[str, str]:
    """Return the text of every valid case there is."""
    folder = files("alula.loads.cases")
    return {name: folder.joinpath(f"{name}.toml").read_text(encoding="utf-8") for name in built_in_cases()}


def linkages(program: str) -> list[str]:
    """Return the text of every linkage that another program saved."""
    files_of = sorted((Path(__file__).resolve().parents[1] / "data" / "exchange").glob(f"{program}-*"))
    return [path.read_text(encoding="utf-8") for path in files_of]


_STARTER: dict[str, Any] = tomllib.loads(starter())


def starter_tables() -> dict[str, Any]:
    """Return the tables of the starter case, as a copy."""
    return deepcopy(_STARTER)


def _told(error: CaseError) -> bool:
    """Look at the sentence of a refusal; False, since the input was not accepted."""
    text = str(error)
    if not text or len(text) > LONGEST_SENTENCE or not all(c.isprintable() for c in text):
        raise AssertionError(f"a sentence that no terminal should get: {text!r:.300}") from error
    return False


def _used(case: Case) -> None:
    """Ask a valid case for all that is derived before anything is solved."""
    for link in case.checked_links:
        case.body(link)
        case.material_of(link)
    _ = case.all_checks, case.pinned_joints


def case_bytes(data: bytes) -> bool:
    """A case file of any content."""
    _FILE.write_bytes(data)
    with watched(_FILE):
        try:
            _used(read_case(str(_FILE)))
        except CaseError as error:
            return _told(error)
    return True


def case_tables(tables: dict[str, Any]) -> bool:
    """A case of any tables, as TOML would give them."""
    with watched():
        try:
            _used(validate(tables))
        except CaseError as error:
            return _told(error)
    return True


def override(text: str) -> bool:
    """Any text behind ``--set``."""
    from alula.loads.case import case_file

    tables = starter_tables()
    with watched():
        try:
            case_file._override(tables, case_file._stated(text))
            _used(validate(tables))
        except CaseError as error:
            return _told(error)
    return True


def _name(path: NamePath) -> Value | str:
    """What a path stands for: a word, a quantity or nothing."""
    if path[0] == "word":
        return "open"
    if path[0] == "given":
        return Value.of(0.25, "N")
    raise CaseError(f"'{'.'.join(path)[:80].encode('ascii', 'replace').decode()}' is unknown; name another")


def expression(text: str) -> bool:
    """Any text as an expression, with and without names, and as the parts of a claim."""
    accepted = False
    with watched():
        for names in (_name, None):
            try:
                evaluate(text, names)
                accepted = True
            except CaseError as error:
                _told(error)
    return accepted


def claim(text: str) -> bool:
    """Any text as each part of a claim."""
    accepted = False
    with watched():
        try:
            read_printed(text)
        except CaseError as error:
            _told(error)
        for entry in ("published", "tolerance", "stated", "name", "note"):
            entries = {"name": "c", "published": "0.25 N", "source": "s", "stated": "1 N", entry: text}
            try:
                Claim.model_validate(entries)
                accepted |= entry in ("published", "tolerance")
            except CaseError as error:
                _told(error)
            except ValidationError as error:
                _told(CaseError(sentence(error, Claim)))
    return accepted


def quantity(text: str) -> bool:
    """Any text as a quantity of every dimension."""
    accepted = False
    with watched():
        for dimension in EXAMPLES:
            try:
                parse(text, dimension)
                accepted = True
            except PydanticCustomError:
                pass
    return accepted


def companion(text: str) -> bool:
    """Any text as the name of a file beside the case: nothing outside that folder is opened."""
    with watched():
        try:
            read_companion("owl-wing-static", text)
        except CaseError as error:
            return _told(error)
    return True


def varied(text: str) -> bool:
    """Any text as the values of an entry that a study varies, and as the expression of one that is linked."""
    from alula.loads.plans.axis import axis
    from alula.loads.plans.derived import derived_value

    accepted = False
    with watched():
        try:
            found = axis("parts.bar.width", text)
            accepted = bool(found.values) or found.at(0.5) is not None
        except CaseError as error:
            _told(error)
        try:
            derived_value(_STARTER, "parts.bar.eye_diameter", text)
        except CaseError as error:
            _told(error)
    return accepted


def exchanged(program: str, text: str) -> bool:
    """Any text as the file of a linkage that another program saved."""
    with watched():
        try:
            found = case_of_linkage(program, text, "file", 10.0)
            _used(validate(tomllib.loads(found.encode().decode())))
        except CaseError as error:
            return _told(error)
    return True


def pylinkage(text: str) -> bool:
    """Any text as a mechanism of pylinkage."""
    return exchanged("pylinkage", text)


def pmks(text: str) -> bool:
    """Any text as a link of PMKS+."""
    return exchanged("pmks", text)


TARGETS: dict[str, Callable[[Any], bool]] = {
    f.__name__: f
    for f in (case_bytes, case_tables, override, expression, claim, quantity, companion, varied, pylinkage, pmks)
}


def shown(data: object) -> str:
    """Return an input as text that says exactly what it was."""
    return json.dumps(data, default=repr) if isinstance(data, dict) else ascii(data)


def warm() -> None:
    """Let everything be imported and read that is imported and read late; call it before ``guard.install``."""
    import_module("scipy.optimize")
    for text in seeds().values():
        case_bytes(text.encode())
    for text in ("sqrt(2 N) + given.x", "word", "1 mm", "0.25 N", "?", 'pose.angle="30 deg"'):
        for target in (expression, claim, quantity, override, companion, varied):
            target(text)
    for program in ("pylinkage", "pmks"):
        for text in linkages(program):
            exchanged(program, text)
    case_bytes(b"\xff")
    case_tables({"schema_version": 1})
    for kind in KINDS.values():  # imported parts are validated by themselves too
        known_keys(kind, ())


def clean() -> None:
    """Remove the scratch folder."""
    _FILE.unlink(missing_ok=True)
    if _FOLDER.is_dir():
        os.rmdir(_FOLDER)
