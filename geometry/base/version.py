"""The version of alula, from the one place that states it: ``pyproject.toml``, as installed."""


def alula_version() -> str:
    """Return the installed version, such as ``"0.1.0"``."""
    from importlib.metadata import version

    return version("alula")
