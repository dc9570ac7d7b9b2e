"""A check as it is told: page, console, ``result.json``, what is not covered."""

import io
import math
from unittest.mock import patch

from rich.console import Console

from alula.fea.common.band import Band
from alula.fea.findings import of_check
from alula.reports.check import screen
from alula.reports.check.whole_check import check_json, check_page, check_record, check_sections
from alula.reports.notebook.check_report import CheckReport
from alula.reports.renderers.page import as_page
from alula.reports.sections.markup import as_plain
from alula.reports.sections.section import Folded, Text, parts_of
from alula.reports.sections.table import Number, Table

_FOUND = {}


def found(result):
    """The result with what a report tells besides, but for what would change it, which takes checks of its own.

    One that has it already stays as it is: ``solved.told`` has all.
    """
    if result.changes or result.motion is not None:
        return result
    if id(result) not in _FOUND:
        with patch.object(of_check, "changes", lambda result: ()):
            _FOUND[id(result)] = result, of_check.with_findings(result)
    return _FOUND[id(result)][1]


def report(result):
    """``CheckReport`` of the same findings; by itself it would find all of them once more."""
    told = CheckReport(result)
    with patch.object(of_check, "with_findings", found):
        assert told.sections
    return told


def sections(result, published=""):
    return check_sections(found(result), published)


def section(result, key):
    [own] = [one for one in sections(result) if one.key == key]
    return own


def tables(result, key):
    return [part for part in parts_of(section(result, key).parts) if type(part).__name__ == "Table"]


def render(result, pictures=None, published="", models=None):
    return as_page(check_page(found(result), sections(result, published)), pictures or {}, models or {})


def result_record(result):
    return check_record(result, sections(result))


def as_json(result):
    return check_json(result, sections(result))


def print_result(result, console):
    screen.print_result(found(result), sections(result), console)


def print_screen(result, console):
    screen.print_screen(found(result), sections(result), console)


def printed(result, width=80):
    stream = io.StringIO()
    print_result(result, Console(file=stream, width=width, color_system=None))
    return stream.getvalue()


def not_covered(result):
    return tuple(entry for one in sections(result) for entry in one.not_covered)


def flat(text):
    return " ".join(as_plain(text).split())


def tables_of(sections):
    """The rows of the tables that have a name, by it; those of tables of one name together."""
    found = {}
    for one in sections:
        for part in parts_of(one.parts):
            if isinstance(part, Table) and part.key:
                found.setdefault(part.key, []).extend(part.records)
    for key, rows in found.items():
        names = dict.fromkeys(name for row in rows for name in row)
        found[key] = [{name: row.get(name) for name in names} for row in rows]
    return found


def numbers_of(parts):
    """Every number that parts tell."""
    for part in parts_of(parts):
        if isinstance(part, Text):
            yield from part.numbers
        elif isinstance(part, Table):
            yield from (cell for row in part.rows for cell in row if isinstance(cell, Number))


def values_of(data):
    """All numbers of a record, however deep."""
    if isinstance(data, dict):
        for item in data.values():
            yield from values_of(item)
    elif isinstance(data, list):
        for item in data:
            yield from values_of(item)
    elif isinstance(data, float | int) and not isinstance(data, bool):
        yield float(data)


def ends_of(number):
    """The value of a number that is told, with the ends of its band, as far as they are finite."""
    value = number.value
    found = (value.told.value, value.told.low, value.told.high) if isinstance(value, Band) else (value,)
    return [float(one) for one in found if one is not None and math.isfinite(one)]


def console_parts(parts):
    """Parts that a console tells."""
    for part in parts:
        if isinstance(part, Folded) and not part.told:
            continue
        if isinstance(part, Text) and "note" in part.kind:
            continue
        yield part
        if hasattr(part, "parts"):
            yield from console_parts(part.parts)
