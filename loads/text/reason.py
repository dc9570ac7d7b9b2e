"""Why a result is as it is, as data: a kind and what it needs to be told. ``alula.reports.sentences`` tells it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Reason:
    """Why a result is as it is, or what a reader must know of it.

    Two reasons of one kind with the same facts are equal, so that checks with one reason can be told together.

    Attributes
    ----------
    kind : str
        The name of its sentence in ``alula.reports.sentences``.
    facts : tuple of (str, object)
        What the sentence names: numbers in mm, N, MPa, bands, names, several names, further reasons.
    """

    kind: str
    facts: tuple[tuple[str, Any], ...] = ()

    def __getitem__(self, name: str) -> Any:
        """Return one fact; raises ``KeyError`` for one that it has not."""
        return dict(self.facts)[name]

    def __str__(self) -> str:
        """Refuse to be a part of a text, which only ``alula.reports.sentences`` makes of it."""
        raise TypeError(f"the reason '{self.kind}' is told by alula.reports.sentences")

    def __format__(self, _: str) -> str:
        """Refuse it in a formatted text as well."""
        return str(self)


def reason(kind: str, /, **facts: Any) -> Reason:
    """Return a reason.

    Parameters
    ----------
    kind : str
    **facts
        A list becomes a tuple, so that the reason can be a key.

    Returns
    -------
    Reason
    """
    return Reason(kind, tuple((name, tuple(v) if isinstance(v, list) else v) for name, v in facts.items()))


def together(*reasons: Reason | str | None) -> Reason | str:
    """Return several reasons as one, told one after the other.

    Parameters
    ----------
    *reasons : Reason, str or None
        None and "" say nothing.

    Returns
    -------
    Reason or str
        "" where none says anything.
    """
    said = [one for one in reasons if one]
    return reason("together", reasons=said) if len(said) > 1 else said[0] if said else ""


def under_load_cases(names: Sequence[str], why: Reason | str) -> Reason:
    """Return a reason that holds under some load cases.

    Parameters
    ----------
    names : sequence of str
        Of the load cases, at least one.
    why : Reason or str

    Returns
    -------
    Reason
    """
    return reason("under_load_cases", load_cases=tuple(names), why=why)
