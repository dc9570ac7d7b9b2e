"""The contents of the site: `docs/index.md` lists every page under the heading of its section, once.

The list is plain Markdown, so that it serves in a repository browser as well. The tables of contents are made from it.
"""

import re
from dataclasses import dataclass

GENERATED_PAGES = {
    "Reference": (
        ("The case file", "generated/case-file/index.md", "every entry with type, unit, default, rule and an example."),
        ("The plan of a study", "generated/study-plan.md", "every entry of `study.toml`."),
        ("The command line", "generated/commands.md", "every command with its options."),
        ("Python", "generated/python.rst", "the functions of `alula` and what they return."),
    )
}
"""Section -> title, path and description of the pages that exist in the site alone."""

_FOLDER = re.compile(r"^This page lists all pages of this folder\..*?\n\n", re.S | re.M)
"""What the index says of the site to those who read it in a repository browser."""
_SITE = """To state something in a case file, search for its word, such as *fork*: first come the recipe and the entry.

"""


@dataclass(frozen=True, kw_only=True)
class Section:
    """One section of the index.

    Attributes
    ----------
    title : str
        Its heading.
    pages : dict of str to str
        Path of a page, as the index states it -> the text of its link.
    """

    title: str
    pages: dict[str, str]


def sections(index: str) -> list[Section]:
    """Read the sections of the index.

    Parameters
    ----------
    index : str
        Text of `docs/index.md`.

    Returns
    -------
    list of Section
        In the order of the text.
    """
    parts = re.split(r"^## +(.+)\n", index, flags=re.M)
    link = re.compile(r"^\* +\[([^\]]+)\]\(([^)#]+\.(?:md|rst))\)", re.M)
    return [
        Section(title=title, pages={path: text for text, path in link.findall(body)})
        for title, body in zip(parts[1::2], parts[2::2], strict=True)
    ]


def with_contents(index: str) -> str:
    """Add the generated pages and the tables of contents to the index.

    Parameters
    ----------
    index : str
        Its text, with links as the site has them.

    Returns
    -------
    str
        For Sphinx.
    """
    index = _FOLDER.sub(_SITE, index)
    for title, pages in GENERATED_PAGES.items():
        lines = "".join(f"* [{name}]({path}): {text}\n" for name, path, text in pages)
        index = index.replace(f"## {title}\n\n", f"## {title}\n\n{lines}", 1)
    trees = [
        "\n".join(["```{toctree}", ":hidden:", f":caption: {section.title}", "", *_entries(section), "```"])
        for section in sections(index)
        if section.pages
    ]
    return "\n\n".join([index, *trees]) + "\n"


def _entries(section: Section) -> list[str]:
    """Return the lines of a section's table of contents."""
    return [f"{text} <{path}>" for path, text in section.pages.items()]
