"""What gmsh says of a shape at which it fails is told with what to do about it; it stood there alone."""

import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from imported_case import STEP

from alula.geometry.base import kernel_child
from alula.geometry.base.errors import CannotRunError
from alula.geometry.imported import read
from alula.geometry.meshing import mesh, mesh_worker
from alula.geometry.parts.step import ImportedPart
from alula.loads.case.case_file import read_case

WIRE = "Could not fix wire in surface 12"


def _fails(*arguments: object) -> None:
    raise Exception(WIRE)  # as gmsh does


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A kernel in this process that fails at whatever it is asked."""
    worker = mesh_worker._Worker()

    class Child:
        def ask(self, request: bytes, time_limit: float) -> bytes:
            _, task, *arguments = pickle.loads(request)
            return pickle.dumps(worker.answer(task, *arguments))

        def end(self) -> None:
            pass

    @contextmanager
    def server(*arguments: object) -> Iterator[Child]:
        yield Child()

    monkeypatch.setattr(kernel_child._workers, "server", server)
    monkeypatch.setattr(mesh_worker, "initialised", lambda: None)
    monkeypatch.setattr(worker, "_of", _fails)
    monkeypatch.setattr(worker, "_about_file", _fails)


def _body(part: object) -> Any:
    return SimpleNamespace(part=part)


@pytest.mark.parametrize(
    ("part", "remedy"),
    [
        (read_case("four-bar").parts["bar"], "a fillet, eye or hole that only just meets another edge"),
        (ImportedPart.model_construct(), "mend the part in its CAD program"),
    ],
    ids=["bar", "imported"],
)
def test_a_body_at_which_gmsh_fails(part: object, remedy: str, failing: None) -> None:
    with pytest.raises(CannotRunError, match=f"^gmsh failed: {WIRE}; {remedy}"):
        mesh._run("mesh", _body(part), None)


def test_a_file_at_which_gmsh_fails(failing: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(read, "_known", {})
    with pytest.raises(CannotRunError, match=f"^gmsh failed: {WIRE}; mend the part in its CAD program .* export it"):
        read.part_facts(Path(STEP) / "plate.step")
