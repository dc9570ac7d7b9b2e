"""``alula materials``: the cards of the library, as a table, one by one, as TOML to paste, as JSON or Markdown."""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from alula.reports.sections.section import Section

app = typer.Typer()


@app.command()
def materials(
    name: Annotated[str | None, typer.Argument(help="A card to show whole; default: list all.")] = None,
    card: Annotated[
        bool, typer.Option("--card", help="Print the named card as TOML, to paste into a case and edit.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the cards as JSON.")] = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print the list as a table of Markdown.")] = False,
) -> None:
    """List the material library: values, sources, what is assumed and what is missing."""
    from alula.geometry.base.errors import CaseError
    from alula.reports.commands.telling import tell
    from alula.reports.renderers.markdown import table_lines
    from alula.reports.tools.library import library_table

    found = told_materials(name)
    if card:
        if name is None:
            raise CaseError("--card: it needs the name of a card; alula materials lists them")
        print(card_text(name), end="")
    elif markdown and not json:
        print("\n".join(table_lines(library_table())))
    else:
        tell([found], json=json)


def told_materials(name: str | None) -> "Section":
    """Return what the library says of all materials, or of one.

    Parameters
    ----------
    name : str or None
        Of a card.

    Returns
    -------
    Section

    Raises
    ------
    CaseError
        For a name that is not in the library.
    """
    from alula.geometry.base.errors import CaseError
    from alula.geometry.materials.directional import directional
    from alula.geometry.materials.material import library
    from alula.loads.text.explain import require
    from alula.reports.tools.library import card_section, library_section

    if name is None:
        return library_section()
    if why := directional(name):
        raise CaseError(f"materials: '{name}' {why}")
    require("materials", name, library(), "is not in the library")
    return card_section(name)


def card_text(name: str) -> str:
    """Return a card of the library as TOML under ``[materials.NAME]``, as a case states it.

    Parameters
    ----------
    name : str
        Of a card in the library.

    Returns
    -------
    str
        Its lines as they stand in the library.
    """
    from alula.geometry.materials.material import library_text

    lines, inside = [], False
    for line in library_text().splitlines():
        if line.startswith("["):
            inside = line.strip("[]").split(".")[0] == name
            line = f"[materials.{line[1:]}"
        if inside and line:
            lines.append(line)
    return "\n".join(lines) + "\n"
