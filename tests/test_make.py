"""`make demo` tells a verdict from a crash, set-up without root ends in one command, CI installs a browser."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def make(*arguments: str, path: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run make in the checkout, with programs in `path` before those of the system."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    if path:
        environment["PATH"] = f"{path}{os.pathsep}{environment['PATH']}"
    command = ["make", "--no-print-directory", *arguments]
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60)


def program(folder: Path, name: str, *lines: str) -> Path:
    """Write a shell script that stands in for a real program."""
    file = folder / name
    file.write_text("\n".join(["#!/bin/sh", *lines, ""]), encoding="utf-8")
    file.chmod(0o755)
    return file


@pytest.mark.parametrize(
    ("status", "succeeds"), [(0, True), (1, True), (3, True), (2, False), (4, False), (139, False)]
)
def test_the_demo_succeeds_whenever_the_check_ran(tmp_path, status, succeeds):
    program(tmp_path, "alula", f'echo "$@" > {tmp_path}/arguments', f"exit {status}")
    installed = tmp_path / "installed"
    installed.touch()
    result = make("demo", f"BIN={tmp_path}", f"INSTALLED={installed}", f"DEMO={tmp_path}/demo", "PYTHON=true")
    assert (result.returncode == 0) == succeeds, result.stderr
    assert ("report.html" in result.stdout) == succeeds
    assert (
        tmp_path / "arguments"
    ).read_text() == f"check owl-wing-static --fidelity solid --fresh -o {tmp_path}/demo\n"


@pytest.mark.parametrize("failing", ["", "ruff", "mypy", "pytest"])
def test_the_test_fails_where_any_of_its_parts_does(tmp_path, failing):
    """Types are checked beside the tests, so that the status of either is easily lost; both run to their ends."""
    for name in ("ruff", "mypy", "pytest"):
        program(tmp_path, name, f'echo "{name} ran"', f"exit {int(name == failing)}")
    (tmp_path / "installed").touch()
    result = make("test", f"BIN={tmp_path}", f"INSTALLED={tmp_path}/installed", "PYTHON=true")
    assert (result.returncode == 0) == (not failing)
    assert "pytest ran" in result.stdout
    assert ("mypy ran" in result.stdout) == (failing != "ruff")


def test_others_may_read_and_run_what_set_up_installs(tmp_path):
    """With a umask of 077 pip leaves all it installs to its user alone."""
    venv = tmp_path / "venv"
    (venv / "bin").mkdir(parents=True)
    install = f"umask 077; mkdir -p {venv}/lib; touch {venv}/lib/module.py; install -m 700 /bin/true {venv}/bin/alula"
    program(venv / "bin", "python", f'case "$*" in *requirements.lock*) {install};; esac')
    result = make(f"{venv}/.installed", f"VENV={venv}", "PYTHON=true")
    assert result.returncode == 0, result.stderr
    modes = {path.name: path.stat().st_mode & 0o777 for path in venv.rglob("*")}
    assert (modes["lib"], modes["module.py"], modes["alula"]) == (0o755, 0o644, 0o755)


def test_type_checkers_find_the_packages_of_a_checkout_with_a_space_in_its_path(tmp_path):
    checkout = tmp_path / "a check out"
    names = ("Makefile", "requirements.lock", "pyproject.toml", "setup.py", "alula/__init__.py", "alula/py.typed")
    for name in (*names, *(f"{room}/__init__.py" for room in ("geometry", "loads", "fea", "reports"))):
        (checkout / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, checkout / name)
    (checkout / ".venv" / "bin").mkdir(parents=True)
    program(checkout / ".venv" / "bin", "python", "exit 0")
    for _ in range(2):
        result = make("-C", str(checkout), "setup", "PYTHON=true")
        assert result.returncode == 0, result.stderr
        (checkout / "pyproject.toml").touch()
    links = {path.name: path.resolve() for path in (checkout / ".venv" / "types" / "alula").iterdir()}
    rooms = {room: checkout / room for room in ("geometry", "loads", "fea", "reports")}
    assert links == rooms | {name: checkout / "alula" / name for name in ("__init__.py", "py.typed")}


@pytest.fixture
def python(tmp_path) -> Path:
    """Stand in for a Python on a system that lacks libGLU."""
    return program(
        tmp_path,
        "fake-python",
        'case "$*" in',
        '  *--advice*) echo "apt-get install libglu1-mesa" ;;',
        '  *system_libraries*) echo "libglu1-mesa" ;;',
        "esac",
    )


def test_without_root_one_command_is_printed(tmp_path, python):
    program(tmp_path, "id", "echo 1000")
    program(tmp_path, "apt-get", f"touch {tmp_path}/touched")
    result = make("libraries", f"PYTHON={python}", path=tmp_path)
    assert result.returncode != 0
    assert "apt-get install libglu1-mesa\n" in result.stderr
    assert not (tmp_path / "touched").exists()


def test_root_installs_what_is_missing(tmp_path, python):
    program(tmp_path, "id", "echo 0")
    program(tmp_path, "apt-get", f'echo "$@" >> {tmp_path}/commands')
    result = make("libraries", f"PYTHON={python}", path=tmp_path)
    assert result.returncode == 0, result.stderr
    update, install = (tmp_path / "commands").read_text().splitlines()
    assert update.startswith("update")
    assert install.endswith(" libglu1-mesa")


def test_a_failed_installation_stops_the_set_up(tmp_path, python):
    program(tmp_path, "id", "echo 0")
    program(tmp_path, "apt-get", "exit 100")
    assert make("libraries", f"PYTHON={python}", path=tmp_path).returncode != 0


def test_a_python_of_another_version_is_refused(tmp_path):
    old = program(tmp_path, "old-python", "exit 1")
    result = make("libraries", f"PYTHON={old}")
    assert result.returncode != 0
    assert "alula needs Python 3.11 to 3.13" in result.stderr


@pytest.mark.parametrize(
    ("user", "installed", "told"),
    [
        (0, 0, "Installing what pages are tested in: chromium chromium-driver"),
        (0, 100, "chromium chromium-driver cannot be installed here, so pages are not tested in a browser."),
        (1000, None, "since only root may install it: apt-get install chromium chromium-driver"),
    ],
)
def test_continuous_integration_installs_a_browser_where_it_may_and_tests_in_any_case(tmp_path, user, installed, told):
    for name in ("bash", "dirname"):
        (tmp_path / name).symlink_to(shutil.which(name))
    program(tmp_path, "id", f"echo {user}")
    program(tmp_path, "make", 'echo "make $@"')
    program(tmp_path, "apt-get", f'echo "$@" >> {tmp_path}/commands', f"exit {installed}")
    done = subprocess.run(
        ["bash", ROOT / ".ci" / "run"], env={"PATH": str(tmp_path)}, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "make test"
    assert told in done.stdout + done.stderr
    commands = (tmp_path / "commands").read_text() if (tmp_path / "commands").exists() else ""
    assert ("install -qq --yes --no-install-recommends chromium chromium-driver" in commands) == (installed == 0)
