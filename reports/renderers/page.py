"""Sections as one HTML page, which loads nothing from elsewhere."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from alula.geometry.base.version import alula_version
from alula.reports.figures.sheet.drawing import data_uri
from alula.reports.page.policy import sealed
from alula.reports.sections.markup import as_html, code
from alula.reports.sections.section import Beside, Cell, Column, Group, Mark, Part, Picture, Section
from alula.reports.turnable.script import viewer

if TYPE_CHECKING:
    from jinja2 import Environment

STYLES = ("report.css", "turnable.css")


@dataclass(frozen=True, kw_only=True)
class Page:
    """A page.

    Attributes
    ----------
    title : str
        In the browser's tab.
    kind : str
        What kind of page it is, above its heading.
    heading : str
    verdict : str
        ``pass``, ``fail``, ``undecided``, or "" for a page without one.
    lead : tuple of str
        What it comes to, one paragraph each.
    first : tuple of Section
        The first screen, beside one another.
    opening : tuple of Section
        What stands above the contents.
    sections : tuple of Section
    footer : tuple of str
    """

    title: str
    kind: str
    heading: str
    verdict: str = ""
    lead: tuple[str, ...] = ()
    first: tuple[Section, ...] = ()
    opening: tuple[Section, ...] = ()
    sections: tuple[Section, ...]
    footer: tuple[str, ...] = ()

    @property
    def every(self) -> tuple[Section, ...]:
        """All sections."""
        return (*self.first, *self.opening, *self.sections)


def page_footer(tables: str) -> tuple[str, ...]:
    """Return what stands below a page.

    Parameters
    ----------
    tables : str
        File of the numbers besides ``result.json``.

    Returns
    -------
    tuple of str
    """
    return (f"All numbers as data: {code('result.json')} and {code(tables)} in the same folder.",)


def as_page(
    page: Page, pictures: Mapping[str, Any] = MappingProxyType({}), models: Mapping[str, str] = MappingProxyType({})
) -> str:
    """Return a page as HTML.

    Parameters
    ----------
    page : Page
    pictures : mapping, optional
        Drawings, or PNG or WebP files, by the names of the pictures; the page omits missing ones.
    models : mapping, optional
        Data blocks of the models that a reader can turn, by their names; the page omits missing ones.

    Returns
    -------
    str
    """
    running = "; ".join(section.running for section in page.every if section.running)
    return (
        _environment()
        .get_template("page.html.jinja")
        .render(
            page=page,
            images=pictures,
            models=models,
            contents=list(_contents(page)),
            version=alula_version(),
            **sealed(*STYLES, script=viewer() if models else "", running=running),
        )
    )


@cache
def _environment() -> "Environment":
    """Return the templates and what they call; compiled once, however many pages there are."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    from alula.reports.renderers.compiled import CompiledTemplates

    environment = Environment(
        loader=PackageLoader("alula.reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        bytecode_cache=CompiledTemplates(),
    )
    safe = environment.filters["safe"]
    environment.filters |= {
        "marked": lambda text: safe(as_html(text)),
        "drawn": lambda picture, alt: safe(drawn(picture, alt)),
        "shown": lambda cell: safe(_shown(cell)),
        "classes": lambda cell, column: safe(_classes(cell, column)),
        "capital": _capital,
        "part_kind": lambda part: type(part).__name__,
        "beside": _beside,
        "model_name": lambda name: name.removeprefix("link-"),
    }
    return environment


def _contents(page: Page) -> Iterator[tuple[str, str, bool]]:
    """Yield title, address, and whether it is within another, of all that the contents list."""
    for section in page.sections:
        if not (section.short and section.parts):
            continue
        yield section.short, f"#{section.key}", False
        for part in section.parts:
            if isinstance(part, Group) and part.key:
                yield part.title.split(" ", 1)[-1], f"#{part.key}", True


def _capital(head: str) -> str:
    """Return the head of a column with a capital, unless it begins with a symbol."""
    return head[:1].upper() + head[1:] if head[:3].replace("-", "").isalpha() and len(head.split(" ")[0]) > 2 else head


def _beside(part: Beside, pictures: Mapping[str, Any], models: Mapping[str, str]) -> str:
    """Return the class of what stands beside one another; none for one part alone."""

    def there(one: Part) -> bool:
        return not isinstance(one, Picture) or one.name in pictures or one.model in models

    return part.kind if sum(map(there, part.parts)) > 1 else ""


def _shown(cell: Cell) -> str:
    if isinstance(cell, Mark):
        return f'<span class="{f"mark {cell.kind}" if cell.kind else "small"}">{as_html(cell.text)}</span>'
    return as_html(str(cell))


def _classes(cell: Cell, column: Column) -> str:
    """Return the classes of a cell, as an attribute."""
    names = [] if column.text else ["num"]
    if column.role:
        names.append(column.role)
    elif column.text and not column.wraps and isinstance(cell, str) and len(cell) < 24:
        names.append("nowrap")
    return f' class="{" ".join(names)}"' if names else ""


def drawn(picture: Any, alt: str) -> str:
    """Return a picture as it stands in a page.

    Parameters
    ----------
    picture : object
        A drawing, which knows its element of a page, or the bytes of a PNG or WebP file.
    alt : str
        What it shows.

    Returns
    -------
    str
    """
    if hasattr(picture, "element"):
        return str(picture.element(alt))
    return f'<img src="{data_uri(picture)}" alt="{as_html(alt)}">'
