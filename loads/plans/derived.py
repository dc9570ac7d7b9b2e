"""Entries of a case that follow from others, by the expressions that claims have."""

from collections.abc import Mapping
from typing import Any

from geometry.base.errors import CaseError
from geometry.base.units import INTERNAL_UNITS
from loads.sources.expression import Path, evaluate, evaluate_number
from loads.sources.quantity import Value, describe, unit_of
from loads.text.explain import printable


def derived_value(tables: Mapping[str, Any], path: str, expression: str) -> object:
    """Evaluate the expression of a linked entry.

    Parameters
    ----------
    tables : mapping
        Of the case, with all values so far.
    path : str
        The entry that is linked; names in the expression are entries beside it, or whole paths.
    expression : str
        As of claims, such as ``"outer_diameter + 2*fillet_radius"``.

    Returns
    -------
    str or float
        As a case file states it.

    Raises
    ------
    CaseError
        For an expression that is wrong, and for an entry that the case does not state.
    """
    beside = tuple(path.split(".")[:-1])

    def named(name: Path) -> Value | str:
        for whole in ((*beside, *name), name):
            found = entry(tables, whole)
            if found is not None:
                return _value(found, whole)
        raise CaseError(
            f"link {printable(path)}: the case states no '{printable('.'.join(name))}', neither beside the entry nor "
            "as a whole path; state it in the case, or correct the name"
        )

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
    for unit in INTERNAL_UNITS.values():
        if unit_of(unit)[1] == value.dimensions:
            return f"{value.to(unit):.12g} {unit}"
    if value.dimensions:
        raise CaseError(
            f"link {printable(path)}: no entry is measured in {describe(value.dimensions)}; check the formula"
        )
    return float(f"{value.magnitude:.12g}")
