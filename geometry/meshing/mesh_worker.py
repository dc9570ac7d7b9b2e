"""The child process in which the geometry kernel and the mesher run: ``python -m geometry.meshing.mesh_worker``.

A request is pickled: a limit of memory [bytes], the name of a task, a body and further arguments. So is its answer:
("done", result), ("case", sentence) or ("cannot", sentence) for an error, or ("memory", ""). Solids that have been
built serve later requests.
"""

import ctypes
import math
import os
import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from geometry.base.child_memory import MemoryGuard
from geometry.base.child_server import ChildService
from geometry.base.errors import CannotRunError, CaseError
from geometry.base.system_libraries import advice
from geometry.meshing.solid_model import Solid, build, initialised, volume_centroid_inertia, write_step
from geometry.parts.body import Body

MOST_SOLIDS = 16
"""Solids that are kept at most; each takes a few megabytes."""


def _mesh(gmsh: Any, solid: Solid, *arguments: Any) -> object:
    from geometry.meshing.mesher import mesh_solid

    try:
        return mesh_solid(gmsh, solid, *arguments)
    finally:
        gmsh.model.mesh.clear()
        with suppress(OSError, AttributeError):  # glibc alone keeps what was freed, and has this to give it back
            ctypes.CDLL(None).malloc_trim(0)


def _reentrant(gmsh: Any, solid: Solid) -> object:
    from geometry.meshing.reentrant import find_reentrant_edges

    return find_reentrant_edges(gmsh, solid)


def _step(gmsh: Any, solid: Solid, path: str) -> None:
    os.chdir(Path(path).parent)  # gmsh takes names in UTF-8 alone, and a path need not be
    draft = Path(".draft.step")  # no body's, since a name begins with a letter or a digit
    write_step(gmsh, solid, draft)
    draft.rename(Path(path).name)


TASKS: dict[str, Callable[..., object]] = {
    "mesh": _mesh,
    "mass": volume_centroid_inertia,
    "step": _step,
    "reentrant": _reentrant,
}
"""What the worker does with gmsh, the solid of a body and further arguments."""


class _Worker:
    """gmsh, loaded at the first request, and the solids that it holds."""

    def __init__(self) -> None:
        self._gmsh: Any = None
        self._solids: dict[Body, tuple[str, Solid]] = {}
        self._count = 0

    def answer(self, task: str, body: Body, *arguments: Any) -> tuple[str, object]:
        """Do a task and return its answer, with every error as a sentence."""
        try:
            import_module("gmsh")
        except (ImportError, OSError) as error:
            return "cannot", f"gmsh could not be loaded ({error}); {advice()}"
        try:
            self._gmsh = self._gmsh or initialised()
            return "done", TASKS[task](self._gmsh, self._solid(body), *arguments)
        except CaseError as error:
            return "case", str(error)
        except CannotRunError as error:
            return "cannot", str(error)
        except MemoryError:
            return "memory", ""
        except Exception as error:
            # gmsh raises bare Exceptions that carry its last message.
            return "cannot", f"gmsh failed: {error or type(error).__name__}"

    def _solid(self, body: Body) -> Solid:
        """Return the solid of a body, whose model becomes the present one."""
        model = self._gmsh.model
        if body in self._solids:
            name, solid = self._solids[body]
            model.setCurrent(name)
            return solid
        if len(self._solids) == MOST_SOLIDS:
            oldest, _ = self._solids.pop(next(iter(self._solids)))
            model.setCurrent(oldest)
            model.remove()
        self._count += 1
        model.add(name := str(self._count))
        try:
            solid = build(self._gmsh, body)
        except BaseException:
            model.remove()
            raise
        self._solids[body] = name, solid
        return solid


def main() -> None:
    """Answer requests until the parent ends."""
    service, worker = ChildService(), _Worker()

    def tell(told: tuple[str, object]) -> bool:
        return service.reply(pickle.dumps(told))

    guard = MemoryGuard(partial(tell, ("memory", "")))

    def answer(request: bytes) -> None:
        limit, task, *arguments = pickle.loads(request)
        guard.allow(limit)
        tell(worker.answer(task, *arguments))
        guard.allow(math.inf)

    service.run(answer)


if __name__ == "__main__":
    main()
