"""Sentences on what no check looks at, what is assumed and what is unusual: each in a few words, and why."""

from collections.abc import Iterable

from alula.fea.common.reason import Reason
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.reports.sentences.catalogue import told

_ENTRIES = {
    "no_guide_length": 'under [joints.{joint}]: guide_length = "20 mm"',
    "none_states_friction": "under [joints.{joint}]: friction = 0.15",
    "no_drive_stiffness": 'under [drive]: stiffness = "{usual}"',
    "no_own_weight": "under [load_cases.{first}]: own_weight = true",
}
"""The line that a case may lack, and the table in which it stands, by the kind of the reason."""


def caveat(found: Caveat, *, short: bool = False) -> str:
    """Return a caveat in words, such as ``thigh (no part)``.

    Parameters
    ----------
    found : Caveat
    short : bool, optional
        True for a headline: without the reason where most cases have the same, and without the line to paste.

    Returns
    -------
    str
    """
    if not found.why or (short and found.topic in (Topic.SHAFT, Topic.COLLISIONS)):
        return told(found.what)
    why = told(found.why)
    if not short and isinstance(found.why, Reason) and found.why.kind in _ENTRIES:
        why += f"; {_ENTRIES[found.why.kind].format(**dict(found.why.facts))}"
    return f"{told(found.what)} ({why})"


def not_checked(found: Iterable[Caveat]) -> list[str]:
    """Return what is not checked, each in a few words with the reason.

    Parameters
    ----------
    found : iterable of Caveat
        Of all headings.

    Returns
    -------
    list of str
    """
    return [caveat(one) for one in found if one.heading is Heading.NOT_CHECKED]


def by_heading(found: Iterable[Caveat], *, short: bool = False) -> tuple[tuple[str, str], ...]:
    """Return caveats in words under their headings, with the lines to paste.

    Parameters
    ----------
    found : iterable of Caveat
    short : bool, optional
        As for ``caveat``.

    Returns
    -------
    tuple of (str, str)
        Heading, and its caveats as one sentence.
    """
    headings: dict[Heading, list[str]] = {}
    for one in found:
        headings.setdefault(one.heading, []).append(caveat(one, short=short))
    return tuple((heading.capitalize(), f"{'; '.join(texts)}.") for heading, texts in headings.items())
