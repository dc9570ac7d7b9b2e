"""How a reason becomes a sentence.

A sentence is a text with places such as ``{share:percent}``, or a function of the facts where words depend on them.
What follows the colon is how a fact is written: a whole number for significant digits, ``short3`` for three at most,
``share2`` for a share in percent with two at most, ``percent``, ``plain``, ``fixed2`` for two decimals, ``and`` for a
list of names as ``a, b and c``; each of another list is written by itself, ``a, b, c``. A band and a reason are told in
their place.
"""

import string
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from typing import Any

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.reports.words.numbers import band, fixed, joined, number, percent, plain, short

Sentence = str | Callable[..., str]
FILES = ("bands", "caveats", "envelopes", "frames", "hand", "links", "linkage", "motion", "runs")
"""Of the sentences, each with a table ``SENTENCES``."""


def told(what: Reason | str) -> str:
    """Return a reason in words, without a capital at its beginning and without a full stop.

    Parameters
    ----------
    what : Reason or str
        A text stays as it is: what a case file or a library says of itself.

    Returns
    -------
    str

    Raises
    ------
    KeyError
        For a kind without a sentence, and for a sentence that names a fact which is not given.
    """
    if isinstance(what, str):
        return what
    sentence, facts = sentences()[what.kind], dict(what.facts)
    if callable(sentence):
        return sentence(**facts)
    return _Places().vformat(sentence, (), facts)


@cache
def sentences() -> Mapping[str, Sentence]:
    """Return all sentences by kind.

    Returns
    -------
    mapping
    """
    found: dict[str, Sentence] = {}
    for name in FILES:
        own: Mapping[str, Sentence] = import_module(f"alula.reports.sentences.{name}").SENTENCES
        twice = found.keys() & own.keys()
        assert not twice, f"two sentences for {sorted(twice)}"
        found |= own
    return found


class _Places(string.Formatter):
    """Writes the facts of a sentence as all numbers of a report are written."""

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return a fact as text; ``alula.reports.sentences.catalogue`` says how."""
        if isinstance(value, Reason):
            return told(value)
        if format_spec == "and":
            return joined([told(one) for one in value])
        if isinstance(value, tuple):
            return ", ".join(self.format_field(one, format_spec) for one in value)
        if isinstance(value, Band):
            return band(value, int(format_spec) if format_spec.isdigit() else 3)
        if format_spec.isdigit():
            return number(value, int(format_spec))
        if format_spec.startswith("short"):
            return short(value, int(format_spec.removeprefix("short")))
        if format_spec.startswith("share"):
            return f"{short(100.0 * value, int(format_spec.removeprefix('share')))} %"
        if format_spec.startswith("fixed"):
            return fixed(value, int(format_spec.removeprefix("fixed")))
        if format_spec in ("percent", "plain"):
            return {"percent": percent, "plain": plain}[format_spec](value)
        return format(value, format_spec)
