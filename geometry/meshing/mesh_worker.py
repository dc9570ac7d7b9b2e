"""The child process in which the geometry kernel and the mesher run: ``python -m geometry.meshing.mesh_worker FOLDER``.

Reads ``request`` and writes ``answer`` in the folder, both pickled (the folder is private to parent and
child). The answer is ("done", result), ("case", sentence) or ("cannot", sentence) for an error, or ("memory", "").
"""

import os
import pickle
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from geometry.base import child_memory
from geometry.base.child import end_with_parent
from geometry.base.errors import CannotRunError, CaseError
from geometry.base.system_libraries import advice
from geometry.meshing.mesher import mesh_solid
from geometry.meshing.reentrant import find_reentrant_edges
from geometry.meshing.solid_model import Solid, build, kernel, volume_centroid_inertia, write_step
from geometry.parts.body import Body


def _step(gmsh: Any, solid: Solid, path: str) -> None:
    os.chdir(Path(path).parent)  # gmsh takes names in UTF-8 alone, and a path need not be
    draft = Path(".draft.step")  # no body's, since a name begins with a letter or a digit
    write_step(gmsh, solid, draft)
    draft.rename(Path(path).name)


TASKS: dict[str, Callable[..., object]] = {
    "mesh": mesh_solid,
    "mass": volume_centroid_inertia,
    "step": _step,
    "reentrant": find_reentrant_edges,
}
"""What the worker does with gmsh, the solid of a body and further arguments."""


def _answer(task: str, body: Body, *arguments: Any) -> tuple[str, object]:
    """Do a task and return its answer, with every error as a sentence."""
    try:
        import_module("gmsh")
    except (ImportError, OSError) as error:
        return "cannot", f"gmsh could not be loaded ({error}); {advice()}"
    try:
        with kernel() as gmsh:
            return "done", TASKS[task](gmsh, build(gmsh, body), *arguments)
    except CaseError as error:
        return "case", str(error)
    except CannotRunError as error:
        return "cannot", str(error)
    except MemoryError:
        return "memory", ""
    except Exception as error:
        # gmsh raises bare Exceptions that carry its last message.
        return "cannot", f"gmsh failed: {error or type(error).__name__}"


def main(folder: Path) -> None:
    """Answer the request in a folder.

    Parameters
    ----------
    folder : Path
        The folder that the parent made.
    """
    end_with_parent(folder)
    limit, task, *arguments = pickle.loads((folder / "request").read_bytes())
    child_memory.bound(limit, lambda: _write(folder, ("memory", "")))
    _write(folder, _answer(task, *arguments))


def _write(folder: Path, told: tuple[str, object]) -> None:
    """Write the answer, by renaming, so that a crash leaves no half of one."""
    draft = folder / "draft"
    draft.write_bytes(pickle.dumps(told))
    draft.rename(folder / "answer")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
