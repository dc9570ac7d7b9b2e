"""What to run where a package is missing that alula can do without: ``pyproject.toml`` names it in an extra."""

import shlex
import sys


def install_command(extra: str) -> str:
    """Return the command that adds an extra to this installation of alula.

    It names the interpreter, since another's pip would look for alula elsewhere; the version that is here stays.

    Parameters
    ----------
    extra : str
        Its name in ``pyproject.toml``, such as ``"pictures"``.

    Returns
    -------
    str
        A line for the shell.
    """
    return f"{shlex.quote(sys.executable)} -m pip install 'alula[{extra}]'"
