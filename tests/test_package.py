"""The wheel holds the one package ``alula`` with its data alone, and its command runs from any folder."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
import urllib.request
import zipfile
from importlib.metadata import Distribution, distribution, distributions, packages_distributions, version
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from test_layers import imported

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("geometry", "loads", "fea", "reports")


def canonical(name: str) -> str:
    """Return the name of a distribution as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def run(*command: str | Path, cwd: Path) -> str:
    """Run `command` as a user would, with no trace of this test's environment, and return its standard output."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(
        [str(word) for word in command], cwd=cwd, env=environment, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """Build the wheel as `make dist` does, by way of the archive of sources, from a copy of the checkout."""
    source = tmp_path_factory.mktemp("source")
    for folder in ("alula", *PACKAGES, "tests", "benchmarks"):
        if (ROOT / folder).is_dir():
            shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for file in ROOT.iterdir():
        if file.is_file() and not file.name.startswith("."):
            shutil.copy(file, source)
    target = tmp_path_factory.mktemp("wheel")
    build = "import sys; from setuptools.build_meta import build_sdist; build_sdist(sys.argv[1])"
    run(sys.executable, "-c", build, target, cwd=source)
    [archive] = target.glob("alula-*.tar.gz")
    options = ("--quiet", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", target)
    run(sys.executable, "-m", "pip", "wheel", *options, archive, cwd=target)
    [built] = target.glob("alula-*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Path:
    """Install the wheel alone into a fresh environment that borrows its dependencies from this one, and no extra's."""
    environment = tmp_path_factory.mktemp("environment")
    run(sys.executable, "-m", "venv", "--without-pip", environment, cwd=environment)
    python = environment / "bin" / "python"
    options = ("--quiet", "--no-deps", "--no-index")
    run(sys.executable, "-m", "pip", "--python", python, "install", *options, wheel, cwd=environment)
    [site] = environment.glob("lib/python*/site-packages")
    # A folder named in a .pth file has its own .pth files ignored: the checkout stays out of reach.
    [alula] = (found for found in distributions(path=[str(site)]) if found.name == "alula")
    (site / "dependencies.pth").write_text(f"{borrowed(alula, tmp_path_factory.mktemp('borrowed'))}\n")
    return environment


def borrowed(alula: Distribution, folder: Path) -> Path:
    """Link what a distribution needs, without extras, and what that needs in turn, as an installer lays it out."""
    ours = folder / "lib" / "python" / "site-packages"
    ours.mkdir(parents=True)
    waiting, there = [Requirement(line) for line in alula.requires or ()], set[str]()
    while waiting:
        one = waiting.pop()
        extras = one.extras or {""}
        if canonical(one.name) in there or not (one.marker is None or one.marker.evaluate({"extra": ""})):
            continue
        there.add(canonical(one.name))
        found = distribution(one.name)
        waiting += [
            more
            for more in map(Requirement, found.requires or ())
            if more.marker is None or any(more.marker.evaluate({"extra": extra}) for extra in extras)
        ]
        for top in {file.parts[0] for file in found.files or () if ".." not in file.parts}:
            if top not in ("__pycache__", ".."):
                link(found.locate_file(top), ours / top)
        for file in found.files or ():
            if file.parts[:4] == ("..", "..", "..", "lib") and len(file.parts) == 5:  # that of gmsh
                link(file.locate(), folder / "lib" / file.name)
    return ours


def link(there: object, here: Path) -> None:
    """Link a file or a folder that may be linked already."""
    if not here.exists():
        here.symlink_to(str(there))


def test_the_wheel_holds_the_rooms_with_their_data_and_no_tests(wheel):
    with zipfile.ZipFile(wheel) as archive:
        shipped = {name for name in archive.namelist() if ".dist-info/" not in name}
    tracked = {
        file.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for file in (ROOT / package).rglob("*")
        if file.is_file() and "__pycache__" not in file.parts
    }
    face = {file.name for file in (ROOT / "alula").iterdir() if file.is_file()}
    assert face == {"__init__.py", "__main__.py", "py.typed", "server.py"}
    assert shipped == {f"alula/{name}" for name in tracked | face}
    assert "alula/geometry/materials/materials.toml" in shipped


def test_alula_is_the_only_name_that_an_installation_adds(installed):
    [site] = installed.glob("lib/python*/site-packages")
    added = {path.name for path in site.iterdir() if path.name not in ("dependencies.pth", "__pycache__")}
    assert {name for name in added if not name.endswith(".dist-info")} == {"alula"}


def test_the_wheel_carries_the_licence(wheel):
    with zipfile.ZipFile(wheel) as archive:
        [metadata] = [name for name in archive.namelist() if name.endswith(".dist-info/METADATA")]
        assert "License-Expression: GPL-3.0-or-later" in archive.read(metadata).decode()
        carried = {
            name.partition(".dist-info/licenses/")[2]: archive.read(name).decode()
            for name in archive.namelist()
            if ".dist-info/licenses/" in name
        }
        script = archive.read("alula/reports/turnable/viewer.js").decode()
    assert carried.keys() == {"LICENSE", "reports/turnable/LICENSE.three.txt"}
    assert "GNU GENERAL PUBLIC LICENSE" in carried["LICENSE"]
    three = carried["reports/turnable/LICENSE.three.txt"]
    assert "three.js authors" in three
    assert " ".join(three.split()) in " ".join(script.partition("*/")[0].replace("\n *", "\n").split())


def test_the_licence_of_every_package_is_told():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    offered = [one for name in extras.keys() - {"dev", "docs", "fuzz"} for one in extras[name]]
    told = set(re.findall(r"[\w-]+", (ROOT / "docs" / "licences.md").read_text(encoding="utf-8").lower()))
    assert {canonical(Requirement(one).name) for one in [*project["dependencies"], *offered]} <= told


def test_the_installed_packages_are_those_of_the_wheel(installed, tmp_path):
    files = run(
        installed / "bin" / "python",
        "-c",
        "import alula.fea, alula.geometry, alula.loads, alula.reports\n"
        "for module in (alula, alula.geometry, alula.loads, alula.fea, alula.reports): print(module.__file__)",
        cwd=tmp_path,
    ).splitlines()
    assert [Path(file).parent.name for file in files] == ["alula", *PACKAGES]
    assert all(Path(file).is_relative_to(installed) for file in files)


def test_what_is_installed_is_what_the_metadata_says(installed):
    """Every package that alula needs is there in a version that fits, and every one that it imports is declared."""
    [site] = installed.glob("lib/python*/site-packages")
    [alula] = (found for found in distributions(path=[str(site)]) if found.name == "alula")
    stated = [Requirement(line) for line in alula.requires or ()]
    always = [one for one in stated if "extra ==" not in str(one.marker)]
    for one in always:
        assert one.specifier.contains(version(one.name), prereleases=True), one
    declared = {canonical(one.name) for one in always}
    extra = re.compile(r'extra == "(pictures|pardiso|cluster|pandas|mcp)"')
    optional = {canonical(one.name) for one in stated if extra.search(str(one.marker))}
    owners = packages_distributions()
    modules = {
        name.partition(".")[0]
        for package in PACKAGES
        for file in (ROOT / package).rglob("*.py")
        for _, name in imported(file.read_text(encoding="utf-8"))
    }
    foreign = modules - sys.stdlib_module_names - {"alula"}
    needed = {canonical(name) for module in foreign for name in owners[module][:1]}
    assert needed <= declared | optional
    assert declared <= needed


def test_the_command_runs_from_another_folder(installed, tmp_path):
    alula = installed / "bin" / "alula"
    told = run(alula, "--version", cwd=tmp_path)
    assert told == f"alula {tomllib.loads((ROOT / 'pyproject.toml').read_text())['project']['version']}\n"
    assert run(installed / "bin" / "python", "-m", "alula", "--version", cwd=tmp_path) == told
    assert "check" in run(alula, "--help", cwd=tmp_path)
    listed = {line.split()[0] for line in run(alula, "cases", cwd=tmp_path).splitlines()}
    assert listed == {file.stem for file in (ROOT / "loads" / "cases").glob("*.toml")}
    assert "owl-wing-static" in listed
    assert list(tmp_path.iterdir()) == []


def test_the_wheel_alone_checks_composes_draws_and_serves(installed, tmp_path):
    """No checkout is near: a check with its page and viewer, the composed case of README, the page to work in."""
    alula = installed / "bin" / "alula"
    done = subprocess.run([alula, "check", "four-bar", "--fidelity", "beam", "-o", "out"], cwd=tmp_path, timeout=120)
    assert done.returncode == 3
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "WebGLRenderer" in page
    run(alula, "export", "four-bar", "--step", cwd=tmp_path)
    inspect = [alula, "inspect", "parts/crank.step", "-o", "out"]
    bare = subprocess.run(inspect, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    command = f"uv pip install --python {installed}/bin/python 'alula[pictures]'"  # the environment has no pip
    assert f"pyvista is not installed; run {command}" in bare.stderr
    assert bare.returncode == 0
    snippets = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    [composed] = (text for text in snippets if "alula.Case(" in text)
    (tmp_path / "composed.py").write_text(composed, encoding="utf-8")
    assert run(installed / "bin" / "python", "composed.py", cwd=tmp_path).endswith("2.12, at least 1.04\n")
    command = [alula, "open", "my-case.toml", "--no-browser"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as served:
        try:
            assert served.stdout is not None
            address = served.stdout.readline().split()[-1]
            with urllib.request.urlopen(address, timeout=30) as answer:
                assert "<html" in answer.read().decode()
        finally:
            served.send_signal(signal.SIGINT)
    assert served.returncode == 130


SWEEP = """
import alula
import fea, loads, reports, tests, geometry.mine

case = alula.read_case("four-bar")
case = case.with_values({"checks.strength.links": ["rocker"]})
print(alula.check(case, fidelity="beam").verdict)
study = alula.study("four-bar", {"parts.bar.thickness": ["4 mm", "6 mm"]}, "out", fidelity="beam", threads=2)
print(*(row["verdict"] for row in study.table()))
print(fea.MINE + loads.MINE + reports.MINE + tests.MINE + geometry.mine.MINE)
"""


def test_a_script_stands_beside_files_with_the_names_of_alulas_packages(installed, tmp_path):
    """A check, whose parts are weighed in a child, and a study with two workers; all start in the same folder."""
    for mine in ("fea.py", "loads.py", "geometry/mine.py", "reports.py", "tests/__init__.py"):
        (tmp_path / mine).parent.mkdir(exist_ok=True)
        (tmp_path / mine).write_text("MINE = 1", encoding="utf-8")
    (tmp_path / "sweep.py").write_text(SWEEP, encoding="utf-8")
    told = run(installed / "bin" / "python", "sweep.py", cwd=tmp_path).split()
    assert told == ["undecided", "undecided", "undecided", "5"]


@pytest.mark.parametrize("environment", ["editable", "wheel", "none"])
def test_a_checkout_brings_its_own_packages(environment, installed, tmp_path):
    """Mistakes are planted in a copy of the checkout, whose packages count there whatever else is installed."""
    checkout = tmp_path / "a chéckout"
    shutil.copytree(ROOT / "alula", checkout / "alula")
    shutil.copytree(ROOT / "geometry" / "base", checkout / "geometry" / "base")
    for package in PACKAGES:
        (checkout / package).mkdir(exist_ok=True)
        shutil.copy(ROOT / package / "__init__.py", checkout / package)
    script = f"import alula\nfrom alula import {', '.join(PACKAGES)}\nprint({', '.join(PACKAGES)}, sep='\\n')"
    if environment == "none":
        bare = [sys.executable, "-S", "-c", script]
        done = subprocess.run(bare, cwd=checkout, capture_output=True, text=True, timeout=60)
        assert f"ImportError: alula is not installed for {sys.executable}; 'make setup'" in done.stderr.splitlines()[-1]
        return
    python = sys.executable if environment == "editable" else installed / "bin" / "python"
    told = run(python, "-c", script, cwd=checkout).splitlines()
    assert all(str(checkout / package) in line for package, line in zip(PACKAGES, told, strict=True)), told
    elsewhere = run(python, "-P", "-c", script, cwd=checkout)
    assert str(checkout) not in elsewhere


@pytest.mark.parametrize(
    ("modules", "taken"),
    [("alula.reports.commands.cli", set()), ("alula.fea.check.run", {"numpy", "pydantic"})],
)
def test_the_command_line_the_face_and_a_check_import_late(installed, modules, taken, tmp_path):
    slow = {"numpy", "scipy", "skfem", "gmsh", "pyvista", "matplotlib", "pint", "pydantic", "meshio"} - taken
    script = f"import sys, alula, {modules}\nprint(*sorted({slow!r} & sys.modules.keys()))"
    assert run(installed / "bin" / "python", "-c", script, cwd=tmp_path).split() == []


def test_the_citation_names_this_version_and_licence():
    stated = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (stated["version"], stated["license"]) == (project["version"], project["license"])
    assert stated["cff-version"] == "1.2.0"
    assert {"message", "title", "authors"} <= stated.keys()
