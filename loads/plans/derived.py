"""Entries of a case that follow from others, by the expressions that claims have."""

from collections.abc import Callable, Collection, Mapping
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import INTERNAL_UNITS
from alula.loads.sources.expression import Path, evaluate, evaluate_number
from alula.loads.sources.quantity import Value, describe, unit_of
from alula.loads.text.explain import printable


def in_turn(links: Mapping[str, str], value: Callable[[str, Collection[str]], None]) -> None:
    """Evaluate linked entries, each after those that it follows from, in whatever order they are stated.

    Parameters
    ----------
    links : mapping of str to str
        Entry -> expression.
    value : callable
        Evaluates one entry, and raises ``WaitsError`` where it follows from one of those that have no value yet.

    Raises
    ------
    CaseError
        For entries that follow from each other.
    """
    left, asked = dict.fromkeys(links), list[str]()
    while left:
        asked = asked or [next(iter(left))]
        try:
            value(asked[-1], left)
        except WaitsError as wait:
            if wait.path in asked:
                raise CaseError(_in_a_circle(asked[asked.index(wait.path) :])) from None
            asked.append(wait.path)
        else:
            del left[asked.pop()]


class WaitsError(Exception):
    """A linked entry follows from another one, ``path``, that has no value yet."""

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self.path = path


def _in_a_circle(paths: list[str]) -> str:
    first, *others = map(printable, paths)
    way = "".join(f"{path}, which follows from " for path in others)
    return f"link {first}: it follows from {way}{first if others else 'itself'}; state one of the entries by a value"


def derived_value(tables: Mapping[str, Any], path: str, expression: str, waiting: Collection[str] = ()) -> object:
    """Evaluate the expression of a linked entry.

    Parameters
    ----------
    tables : mapping
        Of the case, with all values so far.
    path : str
        The entry that is linked; names in the expression are entries beside it, or whole paths.
    expression : str
        As of claims, such as ``"outer_diameter + 2*fillet_radius"``.
    waiting : collection of str
        Linked entries that have no value yet.

    Returns
    -------
    str or float
        As a case file states it.

    Raises
    ------
    CaseError
        For an expression that is wrong, and for an entry that the case does not state.
    WaitsError
        Where it follows from an entry that waits.
    """
    own = tuple(path.split("."))
    beside, later = own[:-1], {tuple(other.split(".")): other for other in waiting}

    def await_all_above(whole: Path, most: int) -> None:
        for length in range(1, most + 1):
            if whole[:length] in later:
                raise WaitsError(later[whole[:length]])

    def named(name: Path) -> Value | str:
        for whole in ((*beside, *name), name):
            await_all_above(whole, len(whole))
            found = entry(tables, whole)
            if found is not None:
                return _value(found, whole)
        raise CaseError(
            f"link {printable(path)}: the case states no '{printable('.'.join(name))}', neither beside the entry nor "
            "as a whole path; state it in the case, or correct the name"
        )

    await_all_above(own, len(own) - 1)  # a whole part comes before its sizes
    try:
        value = evaluate(expression, named)
    except CaseError as error:
        said = str(error)
        raise CaseError(said if said.startswith("link ") else f"link {printable(path)}: {said}") from None
    return value if isinstance(value, str) else _stated(value, path)


def entry(tables: Any, path: Path) -> object:
    """Return what stands at a path of a case's tables.

    Parameters
    ----------
    tables : mapping
    path : tuple of str
        Keys, and numbers of a list's entries.

    Returns
    -------
    object
        None where nothing stands there.
    """
    here: Any = tables
    for key in path:
        if isinstance(here, list) and key.isascii() and key.isdigit() and int(key) < len(here):
            here = here[int(key)]
        elif isinstance(here, Mapping) and key in here:
            here = here[key]
        else:
            return None
    return here


def _value(stated: object, path: Path) -> Value | str:
    """Return a case file's value as a quantity, or as the word that it is."""
    if isinstance(stated, bool) or not isinstance(stated, str | int | float):
        raise CaseError(
            f"path '{printable('.'.join(path))}': it is no number that can be calculated with; name another"
        )
    if not isinstance(stated, str):
        return Value.of(float(stated))
    try:
        return evaluate_number(stated)
    except CaseError:
        return stated


def _stated(value: Value, path: str) -> object:
    """Return a quantity as a case file states it, in alula's own units."""
    if not value.dimensions:
        number = float(f"{value.magnitude:.12g}")
        return int(number) if number.is_integer() else number  # some entries count
    for unit in ("K" if unit == "degC" else unit for unit in INTERNAL_UNITS.values()):
        if unit_of(unit)[1] == value.dimensions:
            return f"{value.to(unit):.12g} {unit}"
    raise CaseError(f"link {printable(path)}: no entry is measured in {describe(value.dimensions)}; check the formula")
