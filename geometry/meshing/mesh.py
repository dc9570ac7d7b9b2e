"""From bodies to meshes, mass properties and STEP files, in child processes with limits of time and memory."""

import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import AlulaError
from alula.geometry.base.kernel_child import KernelWords, ask_kernel
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.keeping.kept import kept
from alula.geometry.meshing.mesh_settings import COARSE, MeshSettings
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.part import Body
from alula.geometry.parts.step import ImportedPart
from alula.geometry.solids.reentrant import ReentrantEdge

__all__ = [
    "COARSE",
    "MassProperties",
    "MeshSettings",
    "ReentrantEdge",
    "export_step",
    "mass_properties",
    "mesh_bodies",
    "mesh_body",
    "reentrant_edges",
    "sections_and_rings",
    "step_names",
]

_T = TypeVar("_T")

KERNEL_TIME_LIMIT = 300.0
"""Seconds for tasks of the geometry kernel that mesh nothing."""
KERNEL_MEMORY_LIMIT = MeshSettings.memory_limit
"""Bytes for the same."""
_WORDS = KernelWords(
    who="the mesher",
    late="increase solid.mesh_size or check with --fidelity beam",
    large="increase solid.mesh_size",
    crashed="change the part's dimensions or the mesh size a little",
    failed="a fillet, eye or hole that only just meets another edge leaves edges too short to be meshed: change its "
    "size by a hundredth or more, or solid.mesh_size a little",
)
_IMPORTED = replace(
    _WORDS,
    failed="mend the part in its CAD program (join its faces, remove edges that are too short) and export it anew, or "
    "change solid.mesh_size a little",
)


@dataclass(frozen=True, kw_only=True)
class MassProperties:
    """Volume integrals of a body in its link's frame.

    Attributes
    ----------
    volume : float
        Volume [mm³].
    centroid : ndarray
        Centroid (3,) [mm].
    inertia : ndarray
        Inertia tensor (3, 3) about the centroid for unit density, products of inertia with their minus sign
        (off-diagonal entries -∫xy dV) [mm⁵].
    """

    volume: float
    centroid: NDArray[np.float64]
    inertia: NDArray[np.float64]


def mesh_body(body: Body, settings: MeshSettings | None = None) -> TaggedMesh:
    """Mesh a body into tetrahedra with named surfaces.

    Parameters
    ----------
    body : Body
        The body.
    settings : MeshSettings, optional
        How fine, and what it may cost.

    Returns
    -------
    TaggedMesh
        The mesh, its cells not sorted.

    Raises
    ------
    CaseError
        If the body cannot be built as described.
    CannotRunError
        If the kernel or the mesher fails, crashes or exceeds a limit.
    """
    settings = settings or MeshSettings()
    check_body(body)
    mesh: TaggedMesh = _known("mesh", body, settings, time_limit=settings.time_limit, memory=settings.memory_limit)
    return mesh


def mesh_bodies(
    bodies: Mapping[str, Body], settings: MeshSettings | None = None, *, processes: int | None = None
) -> dict[str, TaggedMesh]:
    """Mesh several bodies at once; errors of ``mesh_body`` begin with the body's name.

    Parameters
    ----------
    bodies : mapping of str to Body
        Bodies by name.
    settings : MeshSettings, optional
        For all of them.
    processes : int, optional
        How many run at once; one for each core unless given.

    Returns
    -------
    dict of str to TaggedMesh
        Meshes by name.
    """

    def one(item: tuple[str, Body]) -> TaggedMesh:
        return _naming(item[0], mesh_body, item[1], settings)

    with ThreadPoolExecutor(max_workers=processes or os.cpu_count() or 1) as pool:
        return dict(zip(bodies, pool.map(one, bodies.items()), strict=True))


def mass_properties(body: Body) -> MassProperties:
    """Return a body's volume, centroid and inertia by the geometry kernel; errors are those of ``mesh_body``.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    MassProperties
        Its volume integrals.
    """
    check_body(body)
    volume, centroid, inertia = _known("mass", body)
    return MassProperties(volume=volume, centroid=centroid, inertia=inertia)


def reentrant_edges(body: Body) -> list[ReentrantEdge]:
    """Return the sharp edges at which the material's angle exceeds 180°, where linear elastic stress is infinite.

    Found on the kernel's own edges; errors are those of ``mesh_body``.

    Parameters
    ----------
    body : Body
        The body.

    Returns
    -------
    list of ReentrantEdge
        The edges.
    """
    check_body(body)
    edges: list[ReentrantEdge] = _known("reentrant", body)
    return edges


def sections_and_rings(body: Body, stations: tuple[float, ...]) -> tuple[list[CutSection], list[float]]:
    """Return sections of a body, and the flat rings about its holes; errors are those of ``mesh_body``.

    The body may lack its load points, so that its rules are not checked here.

    Parameters
    ----------
    body : Body
        The body.
    stations : tuple of float
        The x at which it is cut [mm].

    Returns
    -------
    sections : list of CutSection
        Normal to the link's axis; those that have an area.
    rings : list of float
        Outer diameter of the flat ring about each pin's hole; 0 where there is none [mm].
    """
    sections, rings = _known("sections", body, stations)
    return sections, rings


def export_step(bodies: Mapping[str, Body], folder: Path) -> list[Path]:
    """Write each body as ``<name>.step`` in mm; errors of ``mesh_body`` begin with the body's name.

    Parameters
    ----------
    bodies : mapping of str to Body
        Bodies by name.
    folder : Path
        An existing folder.

    Returns
    -------
    list of Path
        The files.
    """
    paths = []
    for file, (name, body) in zip(step_names(bodies), bodies.items(), strict=True):
        _naming(name, _step, body, folder / file)
        paths.append(folder / file)
    return paths


def step_names(bodies: Iterable[str]) -> list[str]:
    """Return the names of the STEP files of bodies.

    Parameters
    ----------
    bodies : iterable of str
        Names of bodies.

    Returns
    -------
    list of str
        Names of files.
    """
    return [f"{name}.step" for name in bodies]


def _step(body: Body, path: Path) -> None:
    check_body(body)
    _run("step", body, str(path.resolve()))


def _naming(name: str, task: Callable[..., _T], *arguments: Any) -> _T:
    try:
        return task(*arguments)
    except AlulaError as error:
        raise type(error)(f"{name}: {error}") from None


def _run(
    task: str, body: Body, *arguments: Any, time_limit: float = KERNEL_TIME_LIMIT, memory: float = KERNEL_MEMORY_LIMIT
) -> Any:
    words = _IMPORTED if isinstance(body.part, ImportedPart) else _WORDS
    return ask_kernel(task, body, *arguments, words=words, time_limit=time_limit, memory=memory)


_known = kept(but=("time_limit", "memory"))(_run)
