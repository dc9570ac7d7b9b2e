"""Edits of a case, as a drawing asks for them."""

from collections.abc import Mapping
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.pose import Pose
from alula.reports.workbench.toml_text import TomlText, value_at


def perform(draft: TomlText, operation: Mapping[str, Any], pose: Pose | None) -> None:
    """Make one edit."""
    match operation:
        case {"op": "set", "path": path, "value": value}:
            draft.put(path, value)
        case {"op": "append", "path": path, "value": value}:
            draft.put((*path, len(value_at(draft.tables, path) or ())), value)
        case {"op": "remove", "path": path}:
            draft.remove(path)
        case _:
            raise CaseError("edit: no such operation")
