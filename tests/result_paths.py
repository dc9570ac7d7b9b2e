"""Compare a record with the tables of ``docs/result.md``: every key that stands in one stands in the other."""

import re
from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import Any

DOCUMENT = Path(__file__).resolve().parents[1] / "docs" / "result.md"
NAMED = {
    "links",
    "load_cases",
    "joints",
    "timings_s",
    "motion.points",
    "rates.points",
    "points.branches",
    "link_points",
    "link_bores",
    "link_slots",
    "linkage",
    "provenance.libraries",
    "provenance.files",
    "provenance.changes",
    "clearance.heights",
    "play.clearances",
    "play.points",
    "play.drive_torque",
    "play.drive_force",
}
"""Keys whose own keys are names: by their last part or the last two, or by the whole."""
SHAPES = {
    "extremes": {"first", "last", "smallest", "largest", "unbounded"},
    "vector": {"largest", "largest_at", "x", "y"},
    "band": {"value", "low", "high", "holds", "kinds"},
}
TYPES = {
    "integer": int, "number": int | float, "text": str, "list": list, "null": type(None),
}  # fmt: skip


def documented(command: str) -> dict[str, set[str]]:
    """Return path -> types of the section ``## alula COMMAND``."""
    text = DOCUMENT.read_text(encoding="utf-8")
    return _rows(re.split(r"^## ", text.split(f"\n## alula {command}\n")[1], flags=re.MULTILINE)[0])


def common() -> dict[str, set[str]]:
    """Return path -> types of what stands above all commands."""
    return _rows(re.split(r"^## ", DOCUMENT.read_text(encoding="utf-8"), flags=re.MULTILINE)[0])


def _rows(section: str) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for keys, kind in re.findall(r"^\| (`[^|]+`) \| ([^|]+) \|", section, flags=re.MULTILINE):
        for key in re.findall(r"`([^`]+)`", keys):
            parts = [re.split(r", ", part) for part in re.split(r"\{([^}]+)\}", key)]
            for path in map("".join, product(*parts)):
                assert path not in found, path
                found[path] = {"true or false"} if kind == "true or false" else set(kind.split(" or "))
    return found


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any, str | None]]:
    """Yield (path, value, shape) of everything that is no table, with * for names; a shape is of several keys."""
    if isinstance(value, Mapping):
        shape = next((name for name, keys in SHAPES.items() if keys <= set(value)), None)
        if shape is not None:
            yield path, value, shape
            return
        for key, item in value.items():
            named = path in NAMED or not NAMED.isdisjoint({path.rpartition(".")[2], ".".join(path.split(".")[-2:])})
            yield from leaves(item, f"{path}.{'*' if named else key}".lstrip("."))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for item in value:
            yield from leaves(item, path)
    else:
        yield path, value, None


def compare(command: str, *records: Mapping[str, Any]) -> None:
    """Assert that the records together hold what the document says, each value of a type that it names."""
    own, met = documented(command), set()
    told = common() | own
    for path, value, shape in (leaf for record in records for leaf in leaves(record)):
        assert path in told, f"{path} is not described"
        met.add(path)
        if isinstance(value, bool):
            fits = told[path] == {"true or false"}
        else:
            fits = shape in told[path] or any(isinstance(value, TYPES[k]) for k in told[path] if k in TYPES)
        assert fits, f"{path} is {value!r}, described as {' or '.join(sorted(told[path]))}"
    tables = {path for path, kinds in own.items() if "object" in kinds}
    assert set(own) - met - tables == set(), "described, but in none of the records"
