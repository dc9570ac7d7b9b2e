"""No page, table or figure solves: what it tells stands in the result, where a command or a notebook had it found."""

import ast
from collections.abc import Iterator
from functools import cache

import pytest
from test_layers import PACKAGES, ROOT, parsed

ASKING = ("reports/commands/", "reports/notebook/", "reports/workbench/")
"""Folders that have things found; the others of ``reports/`` tell them."""
SOLVERS = ("solve", "mesh_")
"""How functions begin whose name says that they solve, beside those of ``WORK``."""
WORK = {
    "check_case": "fea.check.run",
    "least_gap": "geometry.clearance.least",
    "play_at": "loads.states.play",
    "joint_forces": "fea.standing.joint_forces",
    "examine": "fea.nonlinear.large_displacement",
    "mass_properties": "geometry.meshing.mesh",
}
"""Functions that solve, and the modules that they stand in."""
Place = tuple[str, str]


class Sources:
    """The functions and classes of the packages, by module, and what each refers to."""

    def __init__(self) -> None:
        files = [file for package in PACKAGES for file in (ROOT / package).rglob("*.py")]
        self.own = {".".join(file.relative_to(ROOT).with_suffix("").parts): file for file in files}
        self._known: dict[Place, bool] = {}

    @cache  # noqa: B019 - a test's object, which lives as long as its test
    def tree(self, module: str) -> ast.Module:
        return parsed(self.own[module].read_text(encoding="utf-8"))

    def imports(self, node: ast.AST) -> Iterator[tuple[str, Place, int]]:
        """Yield name, place and line of what is imported from the packages, at whatever depth."""
        for found in ast.walk(node):
            if isinstance(found, ast.ImportFrom) and found.module and found.module.startswith("alula."):
                module = found.module.removeprefix("alula.")
                for alias in found.names:
                    yield alias.asname or alias.name, (module, alias.name), found.lineno

    @cache  # noqa: B019
    def names(self, module: str) -> dict[str, Place]:
        """Return what the names of a module stand for."""
        own = {
            node.name: (module, node.name)
            for node in self.tree(module).body
            if isinstance(node, ast.FunctionDef | ast.ClassDef)
        }
        return {name: place for name, place, _ in self.imports(self.tree(module))} | own

    def solves(self, place: Place) -> bool:
        """Return whether a function solves, or calls one that does; a class that it makes counts with its methods."""
        module, name = place
        if module not in self.own:
            return False
        if WORK.get(name) == module or name.startswith(SOLVERS):
            return True
        if place not in self._known:
            self._known[place] = False  # of a circle
            self._known[place] = any(self.solves(one) for one in self._called(place))
        return self._known[place]

    def _called(self, place: Place) -> Iterator[Place]:
        """Yield what a function or a class calls, or hands on to be called."""
        module, name = place
        node = next((one for one in self.tree(module).body if getattr(one, "name", "") == name), None)
        if node is None:
            return
        names = self.names(module)
        called = {id(one.func) for one in ast.walk(node) if isinstance(one, ast.Call)}
        for one in ast.walk(node):
            if isinstance(one, ast.Attribute) and one.attr.startswith(SOLVERS) and id(one) in called:
                yield "geometry.linkage.motion", "solve_motion"  # a method that says it solves
            elif isinstance(one, ast.Name) and one.id in names:
                found = names[one.id]
                if found[1][0].islower() or found[1][0] == "_" or id(one) in called:
                    yield found


def solving(sources: Sources, path: str, source: str) -> list[str]:
    """Return one line per import of a solver, and per call of a method that solves, of a file of ``reports/``."""
    tree = parsed(source)
    imported = [
        (line, f"imports {name}")
        for name, place, line in sources.imports(tree)
        if not place[0].startswith("reports.") and name[0].islower() and sources.solves(place)
    ]
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute))
    called = [(node.lineno, f"calls {node.func.attr}") for node in calls if node.func.attr.startswith(SOLVERS)]
    return (
        [] if path.startswith(ASKING) else [f"{path}:{line} {what}, which solves" for line, what in imported + called]
    )


@pytest.fixture(scope="module")
def sources() -> Sources:
    return Sources()


def test_what_tells_solves_nothing(sources: Sources) -> None:
    files = {file.relative_to(ROOT).as_posix(): file for file in (ROOT / "reports").rglob("*.py")}
    assert len(files) > 100
    assert [one for path, file in files.items() for one in solving(sources, path, file.read_text("utf-8"))] == []


@pytest.mark.parametrize(
    "source",
    [
        "from alula.geometry.linkage.motion import Motion, solve_motion",
        "def late():\n    from alula.loads.states.clearance import clearance",
        "from alula.loads.states.loose_motion import LooseMotion, loose_motion as loose",
        "from alula.fea.sizing.changes import changes",
        "from alula.fea.claims.sources import check_claims",
        "from alula.fea.whole.air_range import motion_in_air",
        "from alula.fea.whole.rubbed_motion import work_between",
        "from alula.fea.motion.linkage_history import asked_over_motion",
        "from alula.fea.calculix.second_opinion import second_opinions",
        "from alula.fea.vibration.harmonics import HIGHEST, nearest_harmonic",
        "from alula.loads.states.dead_point_reach import way_to_dead_point",
        "from alula.fea.findings.of_check import with_findings",
        "from alula.fea.findings.of_motion import MotionFindings, motion_findings",
        "def told(case):\n    return case.solve_pose()",
    ],
)
def test_what_solves_is_found(sources: Sources, source: str) -> None:
    [found] = solving(sources, "reports/page/told.py", source)
    assert found.startswith(f"reports/page/told.py:{len(source.splitlines())} ")
    assert solving(sources, "reports/commands/told.py", source) == []
