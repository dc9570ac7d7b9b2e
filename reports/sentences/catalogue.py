"""How a reason becomes a sentence.

A sentence is a text with places such as ``{share:percent}`` in one of the TOML files of this folder, by the kind of its
reason, or a function of ``arranged`` where a text with places would not do. ``places`` says how facts are written in
their places. Reasons among the facts are told first.
"""

import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from alula.fea.common.reason import Reason
from alula.reports.sentences.arranged import ARRANGED
from alula.reports.sentences.places import FactFormatter

Sentence = str | Callable[..., str]
FILES = ("bands", "caveats", "claims", "envelopes", "frames", "hand", "links", "linkage", "motion", "runs")


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
    sentence, facts = sentences()[what.kind], {name: _in_words(fact) for name, fact in what.facts}
    return sentence(**facts) if callable(sentence) else FactFormatter().vformat(sentence, (), facts)


def _in_words(fact: Any) -> Any:
    """Return a fact with the reasons in it told."""
    if isinstance(fact, tuple):
        return tuple(map(_in_words, fact))
    return told(fact) if isinstance(fact, Reason) else fact


@cache
def sentences() -> Mapping[str, Sentence]:
    """Return all sentences by kind.

    Returns
    -------
    mapping
    """
    found: dict[str, Sentence] = dict(ARRANGED)
    for name in FILES:
        text = files("alula.reports.sentences").joinpath(f"{name}.toml").read_text(encoding="utf-8")
        own: Mapping[str, str] = tomllib.loads(text)
        twice = found.keys() & own.keys()
        assert not twice, f"two sentences for {sorted(twice)}"
        found |= own
    return found
