"""Shared libraries that the mesher and the off-screen renderer expect from the system, and how to get them.

The wheels of gmsh and VTK do not carry them, and a bare system lacks them: ``import gmsh`` then raises ``OSError``,
and rendering ends in a segmentation fault.  This module uses the standard library alone, because the set-up asks it
before anything is installed: ``python3 geometry/base/system_libraries.py`` prints the Debian packages that are missing.
"""

import ctypes
import shutil
import sys

# What `objdump -p libgmsh.so.4.15` lists as needed and a Debian minbase does not have, with the package that has it.
_MESHER = {
    "libGL.so.1": "libgl1",
    "libGLU.so.1": "libglu1-mesa",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXcursor.so.1": "libxcursor1",
    "libXfixes.so.3": "libxfixes3",
    "libXft.so.2": "libxft2",
    "libfontconfig.so.1": "libfontconfig1",
    "libXinerama.so.1": "libxinerama1",
    "libXrender.so.1": "libxrender1",
    "libgomp.so.1": "libgomp1",
}

# Without a display VTK renders through EGL, or else OSMesa; Mesa dropped the latter in 25.1, so EGL is what we ask for.
OSMESA = "libOSMesa.so.8"
_RENDERERS = ("libEGL.so.1", OSMESA)
_RENDERER_PACKAGE = "libegl1"


def loads(library: str) -> bool:
    """Return whether the dynamic loader finds a library and everything that it needs.

    Parameters
    ----------
    library : str
        File name, such as ``"libGL.so.1"``.

    Returns
    -------
    bool
        Whether it loads.
    """
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def missing_packages() -> list[str]:
    """Return the Debian packages whose libraries do not load; none on other systems, whose wheels need none."""
    if not sys.platform.startswith("linux"):
        return []
    missing = [package for library, package in _MESHER.items() if not loads(library)]
    if not any(loads(library) for library in _RENDERERS):
        missing.append(_RENDERER_PACKAGE)
    return missing


def install_command(packages: list[str]) -> str:
    """Return the one command that installs packages on Debian and its relatives.

    Parameters
    ----------
    packages : list of str
        Names of the packages.

    Returns
    -------
    str
        A line for the shell.
    """
    command = f"apt-get update && apt-get install --yes --no-install-recommends {' '.join(packages)}"
    return f"sudo sh -c '{command}'" if shutil.which("sudo") else f"su -c '{command}'"


def advice() -> str:
    """Return one sentence that says what to run when gmsh or VTK cannot load a shared library.

    All packages are named when none is found missing: what failed may be a library that this list does not test.
    """
    packages = missing_packages() or [*_MESHER.values(), _RENDERER_PACKAGE]
    return f"install the system libraries with: {install_command(packages)}"


def main() -> None:
    """Print the missing packages on one line, or with ``--advice`` the command that installs them."""
    missing = missing_packages()
    if missing:
        print(install_command(missing) if "--advice" in sys.argv[1:] else " ".join(missing))


if __name__ == "__main__":
    main()
