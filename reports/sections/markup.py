"""Bold, code and subscripts within a text, as marks that no case file can write."""

import re
from html import escape

_MARKS = {"b": ("\ue000", "\ue001"), "code": ("\ue002", "\ue003"), "sub": ("\ue004", "\ue005")}
_BREAK = "\ue009"
_NOTHING = str.maketrans("", "", _BREAK + "".join(mark for pair in _MARKS.values() for mark in pair))
_LINK = re.compile("\ue006([^\ue007]*)\ue007([^\ue008]*)\ue008")


def bold(text: object) -> str:
    """Return a text in bold letters.

    Parameters
    ----------
    text : object

    Returns
    -------
    str
    """
    return _within("b", text)


def headed(text: str) -> str:
    """Return a text with what stands before its first colon in bold letters.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    head, colon, rest = text.partition(":")
    return bold(head) + colon + rest


def code(text: object) -> str:
    """Return a text in letters of equal width: a command, an entry of a file.

    Parameters
    ----------
    text : object

    Returns
    -------
    str
    """
    return _within("code", text)


def entry(path: str) -> str:
    """Return the path of an entry as code, of which a line may be broken after dots.

    Parameters
    ----------
    path : str

    Returns
    -------
    str
    """
    return code(path.replace(".", f".{_BREAK}"))


def sub(text: object) -> str:
    """Return a text as a subscript.

    Parameters
    ----------
    text : object

    Returns
    -------
    str
    """
    return _within("sub", text)


def link(text: str, address: str) -> str:
    """Return a text that leads to another place of a page, or to a file beside it.

    Parameters
    ----------
    text : str
    address : str

    Returns
    -------
    str
    """
    return f"\ue006{address}\ue007{text}\ue008"


def _within(tag: str, text: object) -> str:
    first, last = _MARKS[tag]
    return f"{first}{text}{last}"


def as_plain(text: str) -> str:
    """Return a text without its marks.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    return _LINK.sub(r"\2", text).translate(_NOTHING)


def as_html(text: str) -> str:
    """Return a text as HTML: its marks as elements, all else escaped.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
    """
    found = _LINK.sub(r'<a href="\1">\2</a>', escape(text))
    for tag, (first, last) in _MARKS.items():
        found = found.replace(first, f"<{tag}>").replace(last, f"</{tag}>")
    return found.replace(_BREAK, "<wbr>")
