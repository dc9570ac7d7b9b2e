"""Results as plain data that JSON can hold."""

from collections.abc import Mapping
from enum import Enum
from typing import Any

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.reports.sentences import told


def data(value: Any) -> Any:
    """Return a value as plain data.

    Parameters
    ----------
    value : object
        A band becomes an object with its sources of error, an array or tuple a list, an enumeration its text, a reason
        its sentence.

    Returns
    -------
    object
        Of dict, list, str, int, float, bool and None.
    """
    if isinstance(value, Reason):
        return told(value)
    if isinstance(value, Band):
        kinds = [source.kind.name.lower() for source in value.sources]
        return entries(value.told, "value low high") | {"holds": [told(text) for text in value.texts], "kinds": kinds}
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
