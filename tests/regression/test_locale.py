"""A locale with decimal comma, a folder with spaces and letters beyond ASCII, and one thread or several."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import programs
import pytest
import solved
from told import as_json

NAME = "Flügel – Prothese, 3. Versuch's"


def test_a_path_with_spaces_and_letters_beyond_ascii(tmp_path: Path, german: dict[str, str]) -> None:
    """And a decimal comma that the whole process has taken on, which Python by itself never does for numbers."""
    scratch, out = tmp_path / "für Tempo räres", tmp_path / "mit Abstand" / "Ergebnis ✓"
    case = tmp_path / "Eulen und Käuze" / "Снег 雪" / f"{NAME}.toml"
    for folder in (scratch, case.parent):
        folder.mkdir(parents=True)
    shutil.copy(programs.ROOT / "loads" / "cases" / "knee.toml", case)
    comma = "import locale; locale.setlocale(locale.LC_ALL, ''); assert locale.str(0.5) == '0,5'; " if german else ""
    code = comma + "from alula.reports.commands.cli import main; main()"
    command = [sys.executable, "-c", code, "check", str(case), "--fidelity", "beam", "-o", str(out)]
    done = subprocess.run(
        command, env=programs.environment(scratch, **german), capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert programs.is_whole(out)
    found = json.loads((out / "result.json").read_text(encoding="utf-8"))
    assert found["case"] == str(case)
    plain = json.loads(as_json(solved.by_hand("knee")))
    for key in ("reactions", "checks", "pose", "drive_torque", "verdict"):
        assert found[key] == plain[key]


def test_parts_are_exported_beside_such_a_path(tmp_path: Path) -> None:
    """The geometry kernel writes the file itself, so that it has to understand its name."""
    folder = tmp_path / "Teile für Ä 雪"
    folder.mkdir()
    scratch, case = tmp_path / "scratch ü", tmp_path / "Fälle.toml"
    assert programs.inside("new", str(case)).returncode == 0
    done = programs.run("export", str(case), "--step", "-o", str(folder), scratch=scratch)
    assert done.returncode == 0, done.stderr
    assert len(list(folder.glob("*.step"))) == len(done.stdout.splitlines()) > 1
    assert programs.hidden(folder) == []


@pytest.fixture(scope="module")
def german(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Make a locale with decimal comma, or use that of the system; empty where there is none."""
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
        return {}
    return settings


def test_decimal_comma_in_the_mesher(tmp_path: Path, german: dict[str, str]) -> None:
    """gmsh and the geometry kernel write and read numbers in C++, whose locale the environment could set."""
    if not german:
        pytest.skip("this machine has no locale with decimal comma")
    code = (
        "import locale; locale.setlocale(locale.LC_ALL, '')\n"
        "from pathlib import Path\n"
        "import sys\n"
        "from alula.loads.case.case_file import read_case\n"
        "from alula.geometry.meshing.mesh import COARSE, export_step, mass_properties, mesh_body\n"
        "body = read_case('four-bar-synthesis').body('a')\n"
        "export_step({'a': body}, Path(sys.argv[1]))\n"
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
        data = (folder / "a.step").read_text().partition("DATA;")[2]  # behind the header with its date
        found.append((done.stdout, data))
    assert found[0] == found[1]
