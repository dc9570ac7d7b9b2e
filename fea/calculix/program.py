"""CalculiX decks of links, runs of ``ccx`` in a child process, and its printed results.

Keywords, element types and formats: G. Dhondt, CalculiX CrunchiX User's Manual, version 2.20. Tetrahedra of ten nodes
(C3D10) number their edges 12, 23, 13, 14, 24, 34 as ``DisplacementSpace`` does, and have the same four integration
points in another order.
"""

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.space import DisplacementSpace
from alula.geometry.base import child
from alula.geometry.base.errors import CannotRunError

PROGRAM = "ccx"
_JOB = "model"
_A, _B = (5.0 - 5.0**0.5) / 20.0, (5.0 + 3.0 * 5.0**0.5) / 20.0
POINTS = {
    1: np.array([[_A, _A, _A], [_B, _A, _A], [_A, _B, _A], [_A, _A, _B]]),
    0: np.array([[0.25, 0.25, 0.25]]),
}
"""Integration points of C3D10 (key 1) and C3D4 (key 0) on the unit tetrahedron, in CalculiX's order."""
_EXPONENT = re.compile(r"(\d)([+-]\d{3})\b")  # Fortran drops the E of an exponent of three digits


def write_deck(
    path: Path,
    space: DisplacementSpace,
    *,
    E: float,
    nu: float,
    loads: NDArray[np.float64],
    supports: NDArray[np.int64],
    title: str,
) -> None:
    """Write a link's model as a CalculiX input deck (mm, N, MPa).

    Sets: NALL, EALL, SUPPORTS, and the nodes of every named surface (``bore:A`` as BORE_A).

    Parameters
    ----------
    path : Path
        File to be written.
    space : DisplacementSpace
        The link's mesh.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    loads : ndarray, shape (n, 3)
        Nodal forces [N]; those below 1e-12 of the largest are left out.
    supports : ndarray of int
        Fixed unknowns, 3 node + component.
    title : str
        First line of the deck, for people.

    Raises
    ------
    CannotRunError
        If the file cannot be written.
    """
    nodes, components = np.nonzero(np.abs(loads) > 1e-12 * np.abs(loads).max())
    try:
        with path.open("w", encoding="ascii", errors="replace") as deck:
            write_mesh(deck, space, title)
            for name, members in _sets(space, supports).items():
                deck.write(f"*NSET, NSET={name}\n")
                deck.writelines(_lines(members))
            deck.write(f"*MATERIAL, NAME=MATERIAL\n*ELASTIC\n{E!r}, {nu!r}\n")
            deck.write("*SOLID SECTION, ELSET=EALL, MATERIAL=MATERIAL\n*BOUNDARY\n")
            deck.writelines(f"{u // 3 + 1}, {u % 3 + 1}, {u % 3 + 1}\n" for u in supports.tolist())
            deck.write("*STEP\n*STATIC\n*CLOAD\n")
            deck.writelines(
                f"{node + 1}, {c + 1}, {loads[node, c]:.12e}\n"
                for node, c in zip(nodes.tolist(), components.tolist(), strict=True)
            )
            deck.write("*NODE PRINT, NSET=NALL\nU\n*EL PRINT, ELSET=EALL\nS\n")
            deck.write("*NODE FILE\nU\n*EL FILE\nS\n*END STEP\n")
    except OSError as error:
        raise CannotRunError(f"'{path}' cannot be written ({error.strerror}); choose another folder") from None


def write_mesh(deck: TextIO, space: DisplacementSpace, title: str) -> None:
    """Begin a deck with the nodes and elements of a link's mesh, in the sets NALL and EALL.

    Parameters
    ----------
    deck : TextIO
    space : DisplacementSpace
    title : str
        First line of the deck, for people.
    """
    deck.write(f"*HEADING\n{' '.join(title.split())[:80]}\n*NODE, NSET=NALL\n")
    deck.writelines(f"{i}, {x:.12e}, {y:.12e}, {z:.12e}\n" for i, (x, y, z) in enumerate(space.nodes.tolist(), 1))
    deck.write(f"*ELEMENT, TYPE={'C3D4' if space.order == 1 else 'C3D10'}, ELSET=EALL\n")
    deck.writelines(f"{i}, {', '.join(map(str, c))}\n" for i, c in enumerate((space.cells + 1).tolist(), 1))


def _sets(space: DisplacementSpace, supports: NDArray[np.int64]) -> dict[str, list[int]]:
    """Node sets by names that CalculiX takes: letters, digits and underscores; it ignores case."""
    sets = {"SUPPORTS": np.unique(supports // 3 + 1).tolist()}
    for number, name in enumerate(space.surfaces):
        plain = re.sub(r"[^A-Z0-9]", "_", name.upper())[:60]
        plain = plain if plain.isascii() and plain not in sets else f"{plain}_{number}"
        sets[plain] = (np.unique(space.faces(name)) + 1).tolist()
    return sets


def _lines(numbers: list[int]) -> Iterator[str]:
    for start in range(0, len(numbers), 12):
        yield ", ".join(map(str, numbers[start : start + 12])) + ",\n"


def installed() -> str | None:
    """Return the path of ``ccx``, or None where it is not on PATH."""
    return shutil.which(PROGRAM)


def run(deck: Path, folder: Path, *, threads: int, time_limit: float) -> tuple[Path, Path]:
    """Let ``ccx`` solve a deck inside ``folder`` and return its .dat and .frd files.

    Parameters
    ----------
    deck : Path
        The input file.
    folder : Path
        Where ``ccx`` runs and leaves its results.
    threads : int
        That ``ccx`` may use.
    time_limit : float
        Seconds.

    Returns
    -------
    tuple of 2 Path
        The .dat and the .frd file.

    Raises
    ------
    CannotRunError
        If ccx is missing, fails, crashes, takes too long or leaves no result.
    """
    program = installed()
    if program is None:
        raise CannotRunError(f"CalculiX ({PROGRAM}) is not on PATH")
    shutil.copyfile(deck, folder / f"{_JOB}.inp")
    output = folder / f"{_JOB}.out"
    environment = child.environment(OMP_NUM_THREADS=str(threads), CCX_NPROC_EQUATION_SOLVER=str(threads))
    command = child.foreign_command(program, "-i", _JOB)
    try:
        status, told = child.run(command, environment=environment, time_limit=time_limit, folder=folder, output=output)
        lines = output.read_text(encoding="utf-8", errors="replace").splitlines()
    except subprocess.TimeoutExpired:
        raise CannotRunError(f"CalculiX took more than {time_limit:g} s") from None
    except OSError as error:
        raise CannotRunError(f"CalculiX could not be started ({error.strerror})") from None
    said = next((line.strip() for line in lines if "*ERROR" in line), told if status > 0 else "")
    if status != 0 or said:
        raise CannotRunError(f"CalculiX stopped with status {status}{': ' if said else ''}{said}")
    return folder / f"{_JOB}.dat", folder / f"{_JOB}.frd"


def read_dat(path: Path, *, nodes: int, elements: int, points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read the displacements and stresses of a .dat file.

    Stresses in our order xx, yy, zz, xy, yz, xz; points in CalculiX's.

    Parameters
    ----------
    path : Path
        The .dat file.
    nodes : int
        Their number in the deck.
    elements : int
        Their number in the deck.
    points : int
        Integration points of an element.

    Returns
    -------
    tuple of 2 ndarray
        Displacements (nodes, 3) [mm] and stresses (elements, points, 6) [MPa].

    Raises
    ------
    CannotRunError
        For a file that does not hold every node and every point once, with finite values.
    """
    blocks = _blocks(path)
    u = _table(blocks.get("displacements", ()), 4, path)
    s = _table(blocks.get("stresses", ()), 8, path)
    displacement = np.full((nodes, 3), np.nan)
    stress = np.full((elements, points, 6), np.nan)
    node, element, point = u[:, 0].astype(int) - 1, s[:, 0].astype(int) - 1, s[:, 1].astype(int) - 1
    if len(u) != nodes or len(s) != elements * points:
        raise CannotRunError(f"CalculiX's file '{path.name}' is incomplete: {len(u)} nodes, {len(s)} points")
    for number, count in ((node, nodes), (element, elements), (point, points)):
        if number.min(initial=0) < 0 or number.max(initial=0) >= count:
            raise CannotRunError(f"CalculiX's file '{path.name}' names a node, element or point that the deck lacks")
    displacement[node] = u[:, 1:]
    stress[element, point] = s[:, [2, 3, 4, 5, 7, 6]]
    if not (np.isfinite(displacement).all() and np.isfinite(stress).all()):
        raise CannotRunError(f"CalculiX's file '{path.name}' holds values that are missing or not finite")
    return displacement, stress


def _blocks(path: Path) -> dict[str, list[str]]:
    """Lines of numbers under each heading of a .dat file, by the heading's first word."""
    blocks: dict[str, list[str]] = {}
    current: list[str] = []
    try:
        with path.open(encoding="ascii", errors="replace") as file:
            for line in file:
                head = line.lstrip()
                if head[:1].isalpha():
                    current = blocks.setdefault(head.split()[0].lower(), [])
                elif head:
                    current.append(line)
    except OSError:
        raise CannotRunError(f"CalculiX left no file '{path.name}'") from None
    return blocks


def _table(lines: Iterable[str], columns: int, path: Path) -> NDArray[np.float64]:
    """Numbers (k, columns) of lines; what follows the last column is left out."""
    text = _EXPONENT.sub(r"\1E\2", "".join(lines))
    try:
        rows = [line.split()[:columns] for line in text.splitlines()]
        return np.array(rows, dtype=np.float64).reshape(-1, columns)
    except ValueError:
        raise CannotRunError(f"CalculiX's file '{path.name}' holds lines that are no table of numbers") from None


def read_frd_stress(path: Path) -> NDArray[np.float64]:
    """Read the stress at the nodes of the last STRESS block of a .frd file, in our order of components.

    CalculiX carries its integration points' stresses to the nodes and averages them, as we do.

    Parameters
    ----------
    path : Path
        The .frd file.

    Returns
    -------
    ndarray, shape (k, 6)
        Stress at the nodes [MPa].

    Raises
    ------
    CannotRunError
        Where there is no such block.
    """
    rows: list[list[float]] = []
    inside = False
    try:
        with path.open(encoding="ascii", errors="replace") as file:
            for line in file:
                if line.startswith(" -4"):
                    inside = line[3:].split()[:1] == ["STRESS"]
                    rows = [] if inside else rows
                elif line.startswith(" -3"):
                    inside = False
                elif inside and line.startswith(" -1"):
                    # Fixed width: node in 10 columns, then 12 each; numbers may touch.
                    values = _EXPONENT.sub(r"\1E\2", line[13:85])
                    rows.append([float(values[i : i + 12]) for i in range(0, 72, 12)])
    except (OSError, ValueError):
        raise CannotRunError(f"CalculiX's file '{path.name}' cannot be read") from None
    if not rows:
        raise CannotRunError(f"CalculiX's file '{path.name}' holds no stresses")
    return np.array(rows)
