"""Imports go one way through the rooms, and each foreign library stays where it belongs."""

import ast
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("geometry", "loads", "fea", "reports")
OUTSIDE = ("tests", "benchmarks")
OWNERS = {
    "gmsh": ("geometry/mesh*.py", "geometry/solid_model.py"),
    "skfem": ("fea/*.py",),
    "pypardiso": ("fea/*.py",),
    "pyvista": ("reports/figures*.py",),
    "vtk": ("reports/figures*.py",),
    "vtkmodules": ("reports/figures*.py",),
    "meshio": ("reports/export.py",),
}


def imported_packages(source: str) -> Iterator[tuple[int, str]]:
    """Yield line and top-level package of every absolute import, at whatever depth, and of import_module("...")."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Import():
                for alias in node.names:
                    yield node.lineno, alias.name.split(".")[0]
            case ast.ImportFrom(module=str(module), level=0):
                yield node.lineno, module.split(".")[0]
            case ast.Call(
                func=ast.Name(id="import_module" | "__import__") | ast.Attribute(attr="import_module"),
                args=[ast.Constant(value=str(module)), *_],
            ):
                yield node.lineno, module.split(".")[0]


def violations(root: Path) -> list[str]:
    """Return one line per import that the house forbids, over all Python files of the four rooms below `root`."""
    found = []
    for level, room in enumerate(ROOMS):
        forbidden = {*ROOMS[level + 1 :], *OUTSIDE}
        for file in sorted((root / room).rglob("*.py")):
            name = file.relative_to(root).as_posix()
            for line, package in imported_packages(file.read_text(encoding="utf-8")):
                if package in forbidden:
                    found.append(f"{name}:{line} imports {package}, a higher room or none")
                if package in OWNERS and not any(fnmatch(name, owner) for owner in OWNERS[package]):
                    found.append(f"{name}:{line} imports {package}, which belongs to {' and '.join(OWNERS[package])}")
    return found


def test_every_room_is_there():
    assert [room for room in ROOMS if list((ROOT / room).glob("*.py"))] == list(ROOMS)


def test_imports_go_one_way_and_libraries_stay_at_home():
    assert violations(ROOT) == []


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("geometry/pose.py", "from loads.case import Case"),
        ("geometry/pose.py", "import fea"),
        ("loads/statics.py", "import numpy, reports.cli"),
        ("loads/cases/__init__.py", "from fea import check"),
        ("fea/check.py", "def late():\n    from reports import html"),
        ("fea/check.py", "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import reports.record"),
        ("fea/check.py", "import importlib\nimportlib.import_module('reports.html')"),
        ("fea/solve.py", "import tests.unit"),
        ("fea/solve.py", "import gmsh"),
        ("geometry/part.py", "def late():\n    import gmsh"),
        ("geometry/tagged_mesh.py", "import meshio"),
        ("loads/bearing.py", "from skfem.helpers import dot"),
        ("reports/html.py", "from pyvista import Plotter"),
        ("reports/cli.py", "from meshio import Mesh"),
    ],
)
def test_a_forbidden_import_is_found(tmp_path, path, source):
    file = tmp_path / path
    file.parent.mkdir(parents=True)
    file.write_text(source, encoding="utf-8")
    [violation] = violations(tmp_path)
    line = len(source.splitlines())
    assert violation.startswith(f"{path}:{line} imports ")


def test_allowed_imports_pass(tmp_path):
    allowed = {
        "geometry/mesh_worker.py": "import gmsh\nfrom . import errors\nfrom geometry.part import Part",
        "geometry/solid_model.py": "import gmsh",
        "loads/statics.py": "from geometry.pose import Pose",
        "fea/check.py": "import geometry, loads.case, skfem, fea.solve",
        "reports/figures_stress.py": "import pyvista",
        "reports/export.py": "import meshio, fea, loads, geometry",
        "tests/test_any.py": "import reports",
    }
    for path, source in allowed.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(source, encoding="utf-8")
    assert violations(tmp_path) == []
