"""The templates of pages, and how they write numbers."""

import math
from collections.abc import Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

from alula.fea.common.reason import Reason
from alula.fea.common.verdict import CheckOutcome
from alula.geometry.base.version import alula_version
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.page.policy import sealed
from alula.reports.sentences import told
from alula.reports.words.numbers import band, fixed, joined, number, percent, plain, sentence

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup


def fill(template: str, *, styles: tuple[str, ...] = ("report.css",), script: str = "", **entries: Any) -> str:
    """Return a page with the policy that seals it.

    Parameters
    ----------
    template : str
        Name of a file of ``reports/templates``.
    styles : tuple of str, optional
        Names of its style sheets there.
    script : str, optional
        What it runs.
    **entries
        What it shows; a reason is told, and text is escaped.

    Returns
    -------
    str
    """
    environment = _environment()
    own = {"version": alula_version(), "embed": embed, **sealed(*styles, script=script)}
    return environment.get_template(template).render(**entries, **own)


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, PackageLoader, StrictUndefined

    from alula.reports.renderers.compiled import CompiledTemplates

    environment = Environment(
        loader=PackageLoader("alula.reports"),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_told,
        trim_blocks=True,
        lstrip_blocks=True,
        bytecode_cache=CompiledTemplates(),
    )
    environment.filters |= {
        "number": number,
        "plain": plain,
        "fixed": fixed,
        "band": band,
        "percent": percent,
        "joined": lambda texts: joined([told(text) for text in texts]),
        "told": told,
        "sentence": lambda text: sentence(told(text)),
        "capitalize_first": lambda text: told(text)[:1].upper() + told(text)[1:],
        "complex": complex,
        "by_reason": _by_reason,
        "breakable": lambda path: path.replace(".", ".\u200b"),
        "degrees": lambda angle: number(math.degrees(angle) % 360.0, 6),
    }
    return environment


def _by_reason(checks: Iterable[CheckOutcome]) -> list[tuple[str, list[CheckOutcome]]]:
    """Return checks with one reason together, in the order of what it says."""
    found: dict[str, list[CheckOutcome]] = {}
    for check in checks:
        found.setdefault(told(check.reason), []).append(check)
    return sorted(found.items())


def _told(value: Any) -> Any:
    """Return a reason in words, and anything else as it is."""
    return told(value) if isinstance(value, Reason) else value


def embed(drawn: Drawing, alt: str) -> "Markup":
    """Return a picture as an element of a page, as its template asks for it.

    Parameters
    ----------
    drawn : Drawing
    alt : str
        What it shows, for who does not see it.

    Returns
    -------
    Markup
        What is not escaped again.
    """
    from markupsafe import Markup

    return Markup(drawn.element(alt))
