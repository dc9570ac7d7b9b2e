"""Imports go one way through the packages and their sub-packages, and each foreign library stays where it belongs."""

import ast
import graphlib
import re
from collections import Counter
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LAYERS = {
    "geometry": (
        *("base", "keeping", "materials", "imported", "bodies", "parts"),
        *("joints", "linkage", "mechanisms", "solids", "meshing", "placement", "clearance"),
    ),
    "loads": (
        *("text", "records", "acting", "statics", "sources", "stated"),
        *("case", "compose", "states", "plans", "exchange"),
    ),
    "fea": (
        *("common", "asked", "elements", "tractions", "solvers", "solid", "beam", "frame", "pins"),
        *("standing", "nonlinear", "buckling", "modes"),
        *("refine", "plastic", "superposition", "vibration", "outcomes", "links", "doubts", "judging", "whole"),
        *("check", "motion", "level", "calculix", "claims", "study", "sizing", "tolerance", "findings"),
    ),
    "reports": (
        *("words", "sentences", "figures", "turnable", "sections", "page", "renderers"),
        *("check", "level", "motion", "study", "tools", "workbench", "commands", "notebook"),
    ),
}
"""Each package with its sub-packages, in the order in which they may import one another: the first is the lowest."""
JOINT_FORCE = (
    "alula.fea.standing.joint_forces",  # of a pose, by equilibrium or by a frame
    "alula.fea.standing.case_statics",  # of every load case
    "alula.fea.nonlinear.large_displacement",  # on the deformed shape
    "alula.fea.links.link_by_hand",  # each link cut free, with its stress by beams
    "alula.fea.links.fidelity",  # or by its solid
    "alula.fea.doubts.load_growth",  # what leaves it open
    "alula.fea.judging.link_result",  # its band
    "alula.fea.judging.judge",  # held against a limit: its outcome
    "alula.fea.check.run",  # all outcomes: the verdict
)
"""The way of a joint force from the case to the verdict, in the order in which modules hand it on."""
DRAWN = ("sheet", "outlines", "vibration", "motion", "study")
"""The folders of ``reports/figures/``; none imports another but ``sheet``, which imports none."""
PACKAGES = tuple(LAYERS)
OUTSIDE = ("alula", "tests", "benchmarks")
"""What stands above or beside the packages: ``alula/__init__.py`` is their public face, and a bare ``fea`` is none."""
FROM_THE_FACE = ("reports/commands/cli.py", "alula.server.serve")
"""The one command that is made from the public face, and what it imports of it."""
OWNERS = {
    "gmsh": ("geometry/solids/*.py", "geometry/meshing/*.py"),
    "skfem": ("fea/*.py",),
    "pypardiso": ("fea/solvers/*.py",),
    "pyvista": ("reports/figures/*.py",),
    "meshio": ("reports/page/export.py", "geometry/meshing/file_mesh.py"),
}


@cache
def parsed(source: str) -> ast.Module:
    """Return the syntax tree of a source, which several tests look at."""
    return ast.parse(source)


@cache
def imported(source: str) -> tuple[tuple[int, str], ...]:
    """Return line and name of every module that is imported, at whatever depth, and of import_module("...")."""
    return tuple(_imported(source))


def _imported(source: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(parsed(source)):
        match node:
            case ast.Import():
                for alias in node.names:
                    yield node.lineno, alias.name
            case ast.ImportFrom(module=str(module), level=0):
                for alias in node.names:
                    yield node.lineno, f"{module}.{alias.name}"
            case ast.Call(
                func=ast.Name(id="import_module" | "__import__") | ast.Attribute(attr="import_module"),
                args=[ast.Constant(value=str(module)), *_],
            ):
                yield node.lineno, module


def in_room(module: str) -> str:
    """Return the name of a module without ``alula.`` where it stands in one of the packages."""
    below = module.removeprefix("alula.")
    return below if below.partition(".")[0] in PACKAGES else module


def violations(root: Path) -> list[str]:
    """Return one line per import that the house forbids, over all Python files of the four rooms below `root`."""
    found = {}
    for level, (package, layers) in enumerate(LAYERS.items()):
        forbidden = {*PACKAGES[level + 1 :], *OUTSIDE}
        for file in sorted((root / package).rglob("*.py")):
            name = file.relative_to(root).as_posix()
            own = name.split("/")[1]
            above = layers[layers.index(own) + 1 :] if own in layers else ()
            for line, stated in imported(file.read_text(encoding="utf-8")):
                module = in_room(stated)
                other, _, rest = module.partition(".")
                where = f"{name}:{line} imports"
                if (name, stated) == FROM_THE_FACE:
                    continue
                if other in PACKAGES and module == stated:
                    found[f"{where} a bare {other}, whose name is alula.{other}"] = True
                elif other in forbidden:
                    found[f"{where} {other}, a higher package or none"] = True
                if other == package and rest.partition(".")[0] in above:
                    found[f"{where} {package}/{rest.partition('.')[0]}, which stands above {package}/{own}"] = True
                if other in OWNERS and not any(fnmatch(name, owner) for owner in OWNERS[other]):
                    found[f"{where} {other}, which belongs to {' and '.join(OWNERS[other])}"] = True
    return list(found)


def test_the_house_is_as_planned():
    """Every sub-package is there, says what it answers, and holds at most sixteen files."""
    for package, layers in LAYERS.items():
        folders = {path.parent.name for path in (ROOT / package).glob("*/*.py")} - {"cases", "templates"}
        assert folders == set(layers)
        for layer in layers:
            assert ast.get_docstring(ast.parse((ROOT / package / layer / "__init__.py").read_text(encoding="utf-8")))
            assert len(list((ROOT / package / layer).glob("*.py"))) <= 16


def test_all_that_draws_stands_in_one_place():
    """The folders of ``reports/figures/`` are as planned, and share no more than the sheet."""
    home = ROOT / "reports" / "figures"
    assert {path.parent.name for path in home.glob("*/*.py")} == set(DRAWN)
    for folder in DRAWN:
        assert ast.get_docstring(ast.parse((home / folder / "__init__.py").read_text(encoding="utf-8")))
        assert len(list((home / folder).glob("*.py"))) <= 16
        for file in (home / folder).glob("*.py"):
            names = [name.split(".") for _, name in imported(file.read_text(encoding="utf-8"))]
            others = {name[3] for name in names if name[:3] == ["alula", "reports", "figures"]} & set(DRAWN)
            assert others <= ({folder, "sheet"} if folder != "sheet" else {"sheet"}), file


def test_imports_go_one_way_and_libraries_stay_at_home():
    assert violations(ROOT) == []


def module_graph(root: Path) -> dict[str, set[str]]:
    """Return the modules that each module of the packages below `root` imports, for types as well."""
    files = {file for package in PACKAGES for file in (root / package).rglob("*.py")}
    modules = {f"alula.{'.'.join(file.relative_to(root).with_suffix('').parts)}": file for file in files}
    graph = {}
    for module, file in modules.items():
        names = {name for _, name in imported(file.read_text(encoding="utf-8"))}
        graph[module] = {name if name in modules else name.rpartition(".")[0] for name in names} & modules.keys()
    return graph


def test_no_module_imports_itself_by_way_of_others(tmp_path):
    graphlib.TopologicalSorter(module_graph(ROOT)).prepare()
    (tmp_path / "fea").mkdir()
    (tmp_path / "fea" / "a.py").write_text("from alula.fea.b import x", encoding="utf-8")
    (tmp_path / "fea" / "b.py").write_text("if TYPE_CHECKING:\n    import alula.fea.a", encoding="utf-8")
    with pytest.raises(graphlib.CycleError):
        graphlib.TopologicalSorter(module_graph(tmp_path)).prepare()


def reached(graph: dict[str, set[str]], module: str) -> set[str]:
    """Return all modules that a module imports, directly or by way of others."""
    found: set[str] = set()
    left = [module]
    while left:
        new = graph[left.pop()] - found
        found |= new
        left += new
    return found


def test_a_joint_force_goes_to_the_verdict_without_turning_back():
    """No module on its way imports one that comes later, even by way of others, and the last one imports all."""
    graph = module_graph(ROOT)
    for number, module in enumerate(JOINT_FORCE):
        assert not reached(graph, module) & set(JOINT_FORCE[number:]), module
    assert set(JOINT_FORCE[:-1]) <= reached(graph, JOINT_FORCE[-1])
    ranks = [LAYERS["fea"].index(module.split(".")[2]) for module in JOINT_FORCE]
    assert ranks == sorted(ranks)


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("geometry/linkage/pose.py", "from alula.loads.case.case import Case"),
        ("geometry/linkage/pose.py", "import alula.fea"),
        ("reports/page/html.py", "import fea"),
        ("reports/notebook/shown.py", "import alula"),
        ("loads/statics/statics.py", "import numpy, alula.reports.commands.cli"),
        ("loads/cases/__init__.py", "from alula.fea import check"),
        ("fea/check/run.py", "def late():\n    from alula.reports import html"),
        (
            "fea/check/run.py",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import alula.reports.tables.record",
        ),
        ("fea/check/run.py", "import importlib\nimportlib.import_module('alula.reports.renderers.page')"),
        ("fea/solvers/solve.py", "import tests.unit"),
        ("fea/solvers/solve.py", "import gmsh"),
        ("geometry/parts/part.py", "def late():\n    import gmsh"),
        ("geometry/meshing/tagged_mesh.py", "import meshio"),
        ("loads/records/bearing.py", "from skfem.helpers import dot"),
        ("reports/page/html.py", "from pyvista import Plotter"),
        ("reports/commands/cli.py", "from meshio import Mesh"),
        ("fea/beam/theory.py", "from alula.fea.check.run import check_case"),
        ("fea/common/band.py", "from alula.fea import motion"),
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
        "geometry/meshing/mesh_worker.py": "import gmsh\nfrom . import a\nfrom alula.geometry.parts.part import Part",
        "geometry/solids/solid_model.py": "import gmsh",
        "loads/statics/statics.py": "from alula.geometry.linkage.pose import Pose",
        "fea/check/run.py": "import alula.geometry, alula.loads.case.case, skfem, alula.fea.solvers.solve",
        "reports/figures/figures_stress.py": "import pyvista",
        "reports/page/export.py": "import meshio, alula.fea, alula.loads, alula.geometry",
        "tests/test_any.py": "import reports",
    }
    for path, source in allowed.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(source, encoding="utf-8")
    assert violations(tmp_path) == []


SHARED = {"LineLoad", "PointLoad", "Section"}
"""Names of records that still stand for several things; the list may only shrink."""


def classes() -> list[str]:
    """Return the name of every public class of the four packages, as often as there is one of that name."""
    files = [file for package in PACKAGES for file in (ROOT / package).rglob("*.py")]
    nodes = [node for file in files for node in parsed(file.read_text(encoding="utf-8")).body]
    return [node.name for node in nodes if isinstance(node, ast.ClassDef) and not node.name.startswith("_")]


def test_a_class_name_stands_for_one_thing() -> None:
    assert {name for name, count in Counter(classes()).items() if count > 1} == SHARED


def test_the_glossary_names_what_there_is() -> None:
    glossary = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    names = re.findall(r"`([A-Z]\w+)`", glossary)
    assert len(names) > 20
    assert set(names) <= {*classes(), "Part"}
    terms = [term for row in re.findall(r"^\| ([^|]+) \|", glossary, flags=re.MULTILINE) for term in row.split(", ")]
    assert {term for term, count in Counter(terms).items() if count > 1} == {"term"}
