"""How deep tables and lists of a file may stand in one another."""

from collections.abc import Mapping

from alula.geometry.base.errors import CaseError

DEEPEST = 32
"""Levels; the deepest entry that a case file has stands at the eighth. Beyond some hundred, Python cannot copy them."""


def refuse_deep(value: object, what: str, above: int = 0) -> None:
    """Refuse tables and lists that stand too deep in one another.

    Parameters
    ----------
    value : object
        As ``tomllib`` reads it.
    what : str
        What holds them; it begins the message.
    above : int, optional
        Levels above the value.

    Raises
    ------
    CaseError
        Where there are more than ``DEEPEST`` levels.
    """
    level, depth = [value], above
    while level:
        if depth > DEEPEST:
            raise too_deep(what)
        level = [
            inner
            for outer in level
            if isinstance(outer, Mapping | list | tuple)
            for inner in (outer.values() if isinstance(outer, Mapping) else outer)
        ]
        depth += 1


def too_deep(what: str) -> CaseError:
    """Return the refusal of tables and lists that stand too deep in one another.

    Parameters
    ----------
    what : str
        What holds them; it begins the message.

    Returns
    -------
    CaseError
        To be raised.
    """
    return CaseError(
        f"{what}: its tables and lists are nested too deeply, in more than {DEEPEST} levels, and no entry stands that "
        "deep; remove dots or brackets"
    )
