"""A motion as it is told: record, tables, console, pictures."""

import csv
import io

from rich.console import Console

from alula.fea.findings.of_motion import motion_findings
from alula.reports.motion.whole_motion import motion_page, motion_record, motion_sections
from alula.reports.renderers.console import print_sections
from alula.reports.renderers.csv import files_of
from alula.reports.renderers.folder import drawn_pictures
from alula.reports.sections.section import parts_of


def sections(moved):
    return motion_sections(motion_findings(moved))


def section(moved, key):
    [own] = [one for one in sections(moved) if one.key == key]
    return own


def texts(moved, key):
    return [part.text for part in parts_of(section(moved, key).parts) if type(part).__name__ == "Text"]


def record(moved, name=""):
    found = motion_findings(moved)
    return motion_record(found, name, motion_sections(found))


def rows(moved, file):
    return list(csv.DictReader(io.StringIO(files_of(sections(moved))[file])))


def pictures(moved):
    found = motion_findings(moved)
    return drawn_pictures(motion_page(found, motion_sections(found)))


def printed(moved, width=200):
    stream = io.StringIO()
    print_sections(sections(moved), Console(file=stream, width=width, color_system=None))
    return stream.getvalue()
