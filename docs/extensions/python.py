"""The page on the functions for Python, from `alula.__all__` and what those functions return."""

from collections.abc import Callable

import alula
from fea.common.band import Band
from fea.common.verdict import Verdict
from loads.case.case import Case
from loads.case.revisable import Revisable
from reports.notebook.check_report import CheckReport
from reports.notebook.claims_report import ClaimsReport
from reports.notebook.envelope_report import EnvelopeReport
from reports.notebook.motion_report import MotionReport
from reports.notebook.shown import Picture, Table
from reports.notebook.study_report import StudyReport

REPORTS = (CheckReport, MotionReport, EnvelopeReport, StudyReport, ClaimsReport, Table, Picture, Band, Verdict)
"""What the functions return, and what those reports hold."""


def page() -> str:
    """Return the page.

    Returns
    -------
    str
        reStructuredText, whose directives Sphinx fills with the docstrings.
    """
    parts = [_title("Python", "="), ".. automodule:: alula", _title("Functions", "-")]
    parts += [f"{_title(name, '^')}\n\n.. autofunction:: alula.{name}" for name in alula.__all__]
    parts += [_title("What they return", "-"), _class(Case), _method(Revisable.with_values)]
    parts += [_class(kind, ":members:", ":member-order: bysource") for kind in REPORTS]
    return "\n\n".join(parts) + "\n"


def _method(method: Callable[..., object]) -> str:
    return f".. automethod:: {method.__module__}.{method.__qualname__}"


def _title(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}"


def _class(kind: type, *options: str) -> str:
    """Return the section of a class."""
    directive = f".. autoclass:: {kind.__module__}.{kind.__qualname__}"
    return "\n".join([_title(kind.__name__, "^"), "", directive, *(f"   {option}" for option in options)])
