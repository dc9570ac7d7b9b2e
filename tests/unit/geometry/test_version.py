"""The command that adds an extra: by pip, and by uv where the environment has no pip."""

import importlib.util
import sys

import pytest

from alula.geometry.base.version import extra_command


def test_extra_is_added_by_pip_where_it_is_and_else_by_uv(monkeypatch: pytest.MonkeyPatch) -> None:
    """``uv tool install`` and ``uv venv`` make environments without pip."""
    monkeypatch.setattr(sys, "executable", "/my tools/bin/python")
    for pip, told in (
        (object(), "'/my tools/bin/python' -m pip install 'alula[pandas]'"),
        (None, "uv pip install --python '/my tools/bin/python' 'alula[pandas]'"),
    ):
        monkeypatch.setattr(importlib.util, "find_spec", {"pip": pip}.__getitem__)
        assert extra_command("pandas") == told
