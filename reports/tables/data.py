"""Results as plain data that JSON can hold."""

import math
from collections.abc import Iterable, Mapping
from enum import Enum
from typing import Any

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome
from alula.fea.outcomes.result import CheckResult
from alula.reports.check.changes import change_sentences, change_title, size_command


def data(value: Any) -> Any:
    """Return a value as plain data.

    Parameters
    ----------
    value : object
        A band becomes an object with its sources of error, an array or tuple a list, an enumeration its text.

    Returns
    -------
    object
        Of dict, list, str, int, float, bool and None.
    """
    if isinstance(value, Band):
        kinds = [source.kind.name.lower() for source in value.sources]
        return entries(value.told, "value low high") | {"holds": list(value.texts), "kinds": kinds}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): data(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [data(item) for item in value]
    return value.value if isinstance(value, Enum) else value


def entries(record: object, names: str) -> dict[str, Any]:
    """Return some fields of a record as plain data.

    Parameters
    ----------
    record : object
        Any record, such as a dataclass.
    names : str
        Names of its fields, separated by spaces.

    Returns
    -------
    dict
        Name -> value as plain data.
    """
    return {name: data(getattr(record, name)) for name in names.split()}


def check_records(checks: Iterable[CheckOutcome]) -> list[dict[str, Any]]:
    """Return the outcomes of checks as plain data.

    Parameters
    ----------
    checks : iterable of CheckOutcome

    Returns
    -------
    list of dict
        One entry per check; the unit of a pure number is ``"1"``.
    """
    names = "name link load_case quantity value limit margin verdict applies reason"
    return [entries(check, names) | {"unit": check.unit or "1"} for check in checks]


def change_records(result: CheckResult) -> list[dict[str, Any]]:
    """Return what would change the verdict of the checks that decide it.

    Parameters
    ----------
    result : CheckResult
        With what ``alula.fea.findings.of_check`` finds besides.

    Returns
    -------
    list of dict
    """
    several = len(result.load_cases) > 1
    return [
        {
            **entries(change.check, "name link load_case quantity verdict margin"),
            "load_factor": change.load,
            "faster": change.faster,
            "linear_until": change.until,
            "material": None if change.material is None else entries(change.material, "what material stated needed"),
            "widest": [source.kind.name.lower() for source in change.widest],
            "size": None if change.size is None else entries(change.size, "entry first last"),
            "title": change_title(change, several=several),
            "sentences": change_sentences(change, result),
            "command": size_command(change, result) or None,
        }
        for change in result.changes
    ]


def finite(value: Any, nulls: dict[str, str], path: str = "") -> Any:
    """Return data in which None replaces every infinite or undefined number.

    Parameters
    ----------
    value : object
        Plain data.
    nulls : dict
        Receives, for every number that was replaced, its path and what it was.
    path : str, optional
        Where the value stands in the whole data.

    Returns
    -------
    object
        A copy.
    """
    if isinstance(value, Mapping):
        return {key: finite(item, nulls, f"{path}.{key}" if path else str(key)) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item, nulls, f"{path}.{i}") for i, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        nulls[path] = "not a number" if math.isnan(value) else "infinite" if value > 0.0 else "minus infinite"
        return None
    return float(value) if isinstance(value, float) else value
