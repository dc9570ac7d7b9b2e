"""The child process in which the geometry kernel and the mesher run: ``python -m alula.geometry.meshing.mesh_worker``.

A request is pickled: a limit of memory [bytes], the name of a task, a body (or, for a task about a file, its path and
digest) and further arguments. So is its answer:
("done", result), ("case", sentence) or ("cannot", sentence) for an error, ("failed", gmsh's words), or ("memory", "").
Solids that have been built serve later requests.
"""

import ctypes
import math
import os
import pickle
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from alula.geometry.base.child_memory import MemoryGuard
from alula.geometry.base.child_server import ChildService
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.system_libraries import advice
from alula.geometry.bodies.body import Body
from alula.geometry.imported.solid import facts_of_file, surface_of_file
from alula.geometry.meshing.file_mesh import MESH_TASKS, facts_of_mesh, surface_of_mesh
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.meshing.mesh_target import MeshTarget, mesh_target
from alula.geometry.solids.solid_model import Solid, build, initialised, present, volume_centroid_inertia, write_step

MOST_SOLIDS = 16
"""Solids that are kept at most; each takes a few megabytes."""


@dataclass
class _Built:
    """A body that has been built in a model of gmsh's, and what is meshed of it where halves are allowed, or not."""

    model: str
    solid: Solid
    targets: dict[bool, MeshTarget] = field(default_factory=dict)


def _mesh(gmsh: Any, built: _Built, settings: MeshSettings) -> object:
    from alula.geometry.meshing.mesher import mesh_solid

    present(gmsh, built.solid.tag)
    if settings.halves not in built.targets:
        built.targets[settings.halves] = mesh_target(gmsh, built.solid, halves=settings.halves)
    try:
        return mesh_solid(gmsh, built.targets[settings.halves], settings)
    finally:
        gmsh.model.mesh.clear()
        with suppress(OSError, AttributeError):  # glibc alone keeps what was freed, and has this to give it back
            ctypes.CDLL(None).malloc_trim(0)


def _mass(gmsh: Any, built: _Built) -> object:
    return volume_centroid_inertia(gmsh, built.solid)


def _reentrant(gmsh: Any, built: _Built) -> object:
    from alula.geometry.solids.reentrant import find_reentrant_edges

    present(gmsh, built.solid.tag)
    return find_reentrant_edges(gmsh, built.solid)


def _step(gmsh: Any, built: _Built, path: str) -> None:
    os.chdir(Path(path).parent)  # gmsh takes names in UTF-8 alone, and a path need not be
    draft = Path(".draft.step")  # no body's, since a name begins with a letter or a digit
    write_step(gmsh, built.solid, draft)
    draft.rename(Path(path).name)


def _sections(gmsh: Any, built: _Built, stations: tuple[float, ...]) -> object:
    from alula.geometry.solids.sections import cut_sections, ring_diameters

    present(gmsh, built.solid.tag)
    return cut_sections(gmsh, built.solid, stations), ring_diameters(gmsh, built.solid)


TASKS: dict[str, Callable[..., object]] = {
    "mesh": _mesh,
    "mass": _mass,
    "step": _step,
    "reentrant": _reentrant,
    "sections": _sections,
}
"""What the worker does with gmsh, a body that has been built, and further arguments."""
FILE_TASKS: dict[str, Callable[..., object]] = {
    "facts": facts_of_file,
    "surface": surface_of_file,
    "facts of mesh": facts_of_mesh,
    "surface of mesh": surface_of_mesh,
}
"""What it does with gmsh, in a model of its own, with the path and the digest of a file, and further arguments."""


class _Worker:
    """gmsh, loaded at the first request, and the bodies that have been built."""

    def __init__(self) -> None:
        self._gmsh: Any = None
        self._built: dict[tuple[Body, bool], _Built] = {}
        self._count = 0

    def answer(self, task: str, subject: Any, *arguments: Any) -> tuple[str, object]:
        """Do a task and return its answer, with every error as a sentence."""
        try:
            import_module("gmsh")
        except (ImportError, OSError) as error:
            return "cannot", f"gmsh could not be loaded ({error}); {advice()}"
        try:
            self._gmsh = self._gmsh or initialised()
            if task in FILE_TASKS:
                return "done", self._about_file(FILE_TASKS[task], *subject, *arguments)
            if subject.part.is_fixed:
                return "done", MESH_TASKS[task](subject, *arguments)
            return "done", TASKS[task](self._gmsh, self._of(subject, task), *arguments)
        except CaseError as error:
            return "case", str(error)
        except CannotRunError as error:
            return "cannot", str(error)
        except MemoryError:
            return "memory", ""
        except Exception as error:
            # gmsh raises bare Exceptions that carry its last message.
            return "failed", str(error) or type(error).__name__

    def _about_file(self, task: Callable[..., object], *arguments: Any) -> object:
        """Do a task in a model of its own."""
        self._gmsh.model.add("file")
        try:
            return task(self._gmsh, *arguments)
        finally:
            self._gmsh.model.remove()

    def _of(self, body: Body, task: str) -> _Built:
        """Return a body as it was built or is now, and make its model the present one."""
        model = self._gmsh.model
        key = body, task == "step"  # a model that is written to a file must hold no half
        if key in self._built:
            model.setCurrent(self._built[key].model)
            return self._built[key]
        if len(self._built) == MOST_SOLIDS:
            model.setCurrent(self._built.pop(next(iter(self._built))).model)
            model.remove()
        self._count += 1
        model.add(name := str(self._count))
        try:
            self._built[key] = _Built(name, build(self._gmsh, body))
        except BaseException:
            model.remove()
            raise
        return self._built[key]


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
