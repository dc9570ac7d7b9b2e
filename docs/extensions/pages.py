"""Sphinx's hooks: pages are generated before it reads any, and links are turned while it reads."""

from pathlib import Path
from typing import Any

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

from docs.extensions import case_file, commands, gallery, index, links, python


def _generate(app: Sphinx) -> None:
    """Write the pages that are made from the program and from files outside of docs/."""
    gallery.draw_not_run()
    links.copy_outside_pages()
    written = case_file.pages()
    for path, text in written.items():
        links.write_changed(links.GENERATED / path, text)
    links.remove_others(links.GENERATED / "case-file", {Path(path).stem for path in written})
    links.remove_others(links.GENERATED / "gallery", {"index", *(file.stem for file in gallery.FOLDER.glob("*.py"))})
    links.write_changed(links.GENERATED / "commands.md", commands.page())
    links.write_changed(links.GENERATED / "python.rst", python.page())


def _turn_links(app: Sphinx, name: str, source: list[str]) -> None:
    """Turn links to pages outside of docs/ to their copies."""
    file = app.env.doc2path(name)
    if file.suffix == ".md" and links.GENERATED not in file.parents:
        source[0] = links.moved(source[0], file.parent, file.parent)
    source[0] = gallery.with_note(file, source[0], gallery.not_run())
    if name == app.config.root_doc:
        source[0] = index.with_contents(source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    """Connect the hooks."""
    app.add_lexer("csv", TextLexer)
    app.connect("builder-inited", _generate)
    app.connect("source-read", _turn_links)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
