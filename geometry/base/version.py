"""The versions of alula and of its formats; ``docs/versions.md`` says what changes them."""

CASE_SCHEMA_VERSION = 1
"""Of the case file: raised when a case of today is no longer read, or means something else."""
RESULT_SCHEMA_VERSION = 2
"""Of ``result.json`` and ``--json``: raised when a key goes, or changes its name, type, unit or meaning."""


def alula_version() -> str:
    """Return the installed version, such as ``"0.2.0"``; ``pyproject.toml`` states it."""
    import sys
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("alula")
    except PackageNotFoundError:
        what = f"alula is not installed for {sys.executable}"
        raise ImportError(f"{what}; 'make setup' in its checkout makes a Python that has it", name="alula") from None


def extra_command(extra: str) -> str:
    """Return the command that adds an extra to this installation of alula.

    It names the interpreter, since another's pip would look for alula elsewhere; the version that is here stays. An
    environment that uv made has no pip.

    Parameters
    ----------
    extra : str
        Its name in ``pyproject.toml``, such as ``"pictures"``.

    Returns
    -------
    str
        A line for the shell.
    """
    import importlib.util
    import shlex
    import sys

    python = shlex.quote(sys.executable)
    pip = f"{python} -m pip install" if importlib.util.find_spec("pip") else f"uv pip install --python {python}"
    return f"{pip} 'alula[{extra}]'"


def result_stamp() -> dict[str, object]:
    """Return what the JSON of every command begins with: the version of its format and that of alula."""
    return {"schema_version": RESULT_SCHEMA_VERSION, "version": alula_version()}
