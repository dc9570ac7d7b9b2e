"""A locale with decimal comma, a folder with spaces and letters beyond ASCII, and one thread or several."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import programs
import pytest

NAME = "Flügel – Prothese, 3. Versuch's"


def numbers(folder: Path) -> dict[str, object]:
    record = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    return {key: record[key] for key in ("reactions", "checks", "pose", "drive_torque", "verdict")}


def copied(folder: Path) -> Path:
    """Copy the owl wing and its tables, so that its path is that of the folder."""
    cases = programs.ROOT / "loads" / "cases"
    folder.mkdir(parents=True)
    for file in cases.glob("owl-wing-stat*"):
        shutil.copy(file, folder)
    return (folder / "owl-wing-static.toml").rename(folder / f"{NAME}.toml")


def test_a_path_with_spaces_and_letters_beyond_ascii(tmp_path: Path) -> None:
    case, scratch = copied(tmp_path / "Eulen und Käuze" / "Снег 雪"), tmp_path / "für Tempo räres"
    out = tmp_path / "mit Abstand" / "Ergebnis ✓"
    done = programs.run("check", str(case), "--fidelity", "beam", "-o", str(out), scratch=scratch)
    assert done.returncode in (0, 1, 3), done.stderr
    assert programs.is_whole(out)
    assert json.loads((out / "result.json").read_text(encoding="utf-8"))["case"] == str(case)
    plain = programs.run(*programs.BEAM, "--json", scratch=scratch)
    record = json.loads(plain.stdout)
    assert {key: record[key] for key in numbers(out)} == numbers(out)


def test_parts_are_exported_beside_such_a_path(tmp_path: Path) -> None:
    """The geometry kernel writes the file itself, so that it has to understand its name."""
    folder = tmp_path / "Teile für Ä 雪"
    folder.mkdir()
    scratch, case = tmp_path / "scratch ü", tmp_path / "Fälle.toml"
    assert programs.run("new", str(case), scratch=scratch).returncode == 0
    done = programs.run("export", str(case), "--step", "-o", str(folder), scratch=scratch)
    assert done.returncode == 0, done.stderr
    assert len(list(folder.glob("*.step"))) == len(done.stdout.splitlines()) > 1
    assert programs.hidden(folder) == []


@pytest.fixture(scope="module")
def german(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Make a locale with decimal comma, or use that of the system."""
    folder = tmp_path_factory.mktemp("locales")
    own: dict[str, str] = {}
    if shutil.which("localedef"):
        command = ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")]
        if subprocess.run(command, capture_output=True, check=False).returncode == 0:
            own["LOCPATH"] = str(folder)
    settings = own | {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
    probe = "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"
    done = subprocess.run(
        [sys.executable, "-c", probe], env=os.environ | settings, capture_output=True, text=True, check=False
    )
    if done.stdout.strip() != ",":
        pytest.skip("this machine has no locale with decimal comma")
    return settings


def test_decimal_comma(tmp_path: Path, german: dict[str, str]) -> None:
    """Even where the whole process has taken it on, which Python by itself never does for numbers."""
    out = tmp_path / "out"
    switch = "import locale; locale.setlocale(locale.LC_ALL, ''); assert locale.str(0.5) == '0,5'; "
    code = switch + "from reports.commands.cli import main; main()"
    command = [sys.executable, "-c", code, *programs.BEAM, "-o", str(out)]
    done = subprocess.run(
        command, env=programs.environment(**german), capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode in (0, 1, 3), done.stderr
    plain = json.loads(programs.run(*programs.BEAM, "--json", scratch=tmp_path / "scratch").stdout)
    assert {key: plain[key] for key in numbers(out)} == numbers(out)


def test_decimal_comma_in_the_mesher(tmp_path: Path, german: dict[str, str]) -> None:
    """gmsh and the geometry kernel write and read numbers in C++, whose locale the environment could set."""
    code = (
        "import locale; locale.setlocale(locale.LC_ALL, '')\n"
        "from pathlib import Path\n"
        "import sys\n"
        "from loads.case.case_file import read_case\n"
        "from geometry.meshing.mesh import COARSE, export_step, mass_properties, mesh_body\n"
        "body = read_case('owl-wing-static').body('GF')\n"
        "export_step({'GF': body}, Path(sys.argv[1]))\n"
        "print(repr(mass_properties(body).volume), len(mesh_body(body, COARSE).cells))\n"
    )
    found = []
    for settings in (german, {}):
        folder = tmp_path / (settings.get("LC_ALL") or "plain")
        folder.mkdir()
        done = subprocess.run(
            [sys.executable, "-c", code, str(folder)],
            env=programs.environment(**settings),
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        data = (folder / "GF.step").read_text().partition("DATA;")[2]  # behind the header with its date
        found.append((done.stdout, data))
    assert found[0] == found[1]
