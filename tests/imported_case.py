"""A crank rocker whose rocker is a part from a STEP file: a plate with bores of 5 and 6 mm, 40 mm apart."""

from pathlib import Path

STEP = Path(__file__).parent / "data" / "step"
TOML = """
schema_version = 1
title = "An imported rocker"
links.base = {{ ground = true, points = {{ O2 = ["0 mm", "0 mm"], O4 = ["60 mm", "0 mm"] }} }}
links.crank = {{ points = {{ O2 = ["0 mm", "0 mm"], A = ["20 mm", "0 mm"] }} }}
links.coupler = {{ points = {{ A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] }} }}
links.rocker = {{ part = "own", points = {points} }}
joints.O2 = {{ links = ["base", "crank"], pin_diameter = "3 mm" }}
joints.A = {{ links = ["crank", "coupler"], pin_diameter = "3 mm" }}
joints.B = {{ links = ["coupler", "rocker"], pin_diameter = "6 mm" }}
joints.O4 = {{ links = ["base", "rocker"], pin_diameter = "5 mm" }}
pose = {{ coordinate = "crank", angle = "40 deg", near = {{ coupler = "20 deg", rocker = "60 deg" }} }}
drive = {{ link = "crank", joint = "O2" }}
motion = {{ range = ["40 deg", "80 deg"], poses = 5 }}
load_cases.turn = {{ forces = [{{ link = "rocker", at = "B", force = ["30 N", "-20 N"] }}] }}
[parts.own]
shape = "step"
material = "pvc-paredes-2018"
file = "{file}"
{entries}
"""
STATED = '{ O4 = ["0 mm", "0 mm"], B = ["40.02 mm", "0 mm"] }'


def imported_case(folder: Path, *, file: str = "plate.step", points: str = STATED, entries: str = "") -> Path:
    """Write the case and copy its file beside it; return the path of the case."""
    if (STEP / file).exists():
        (folder / file).write_bytes((STEP / file).read_bytes())
    path = folder / "case.toml"
    path.write_text(TOML.format(points=points, file=file, entries=entries), encoding="utf-8")
    return path


def strut_case(folder: Path, *, file: str, length: float) -> Path:
    """Write such a case, as large as its rocker, a part with two bores of 4 mm."""
    points = f'{{ O4 = ["0 mm", "0 mm"], B = ["{length} mm", "0 mm"] }}'
    path = imported_case(folder, file=file, points=points, entries='bores = { O4 = "bore 1", B = "bore 2" }')
    text = path.read_text().replace('pin_diameter = "5 mm"', 'pin_diameter = "4 mm"')
    text = text.replace('pin_diameter = "6 mm"', 'pin_diameter = "4 mm"').replace('["20 mm"', f'["{length / 2} mm"')
    path.write_text(text.replace('["60 mm"', f'["{1.5 * length} mm"'), encoding="utf-8")
    return path
