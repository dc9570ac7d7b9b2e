"""The templates of pages, and how they write numbers."""

import math
from functools import cache
from typing import TYPE_CHECKING, Any

from alula.geometry.base.version import alula_version
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.page.policy import sealed
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
        What it shows; its text is escaped.

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

    from alula.reports.page.compiled import CompiledTemplates

    environment = Environment(
        loader=PackageLoader("alula.reports"),
        autoescape=True,
        undefined=StrictUndefined,
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
        "joined": joined,
        "sentence": sentence,
        "capitalize_first": lambda text: text[:1].upper() + text[1:],
        "complex": complex,
        "breakable": lambda path: path.replace(".", ".\u200b"),
        "degrees": lambda angle: number(math.degrees(angle) % 360.0, 6),
    }
    return environment


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
