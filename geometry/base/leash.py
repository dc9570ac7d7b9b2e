"""Become another program that ends with its parent.

Usage: ``python -m alula.geometry.base.leash PARENT PROGRAM ARGUMENT ...``.

alula's own children notice by themselves that the parent has gone. For others the system is asked to kill them (Linux;
elsewhere a program that outlives its parent runs to its end).
"""

import ctypes
import os
import signal
import sys

_SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of <linux/prctl.h>; it outlives exec


def main(parent: int, command: list[str]) -> None:
    """Replace this process by a command that ends with another process.

    Parameters
    ----------
    parent : int
        Number of the process that it must not outlive.
    command : list of str
        Program and arguments.
    """
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(_SET_DEATH_SIGNAL, int(signal.SIGKILL))
        if os.getppid() != parent:  # it went before that
            sys.exit(1)
    os.execv(command[0], command)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])
