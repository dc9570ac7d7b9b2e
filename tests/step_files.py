"""Plates with bores as STEP files, drawn anywhere in space by the geometry kernel in a child process."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

PLATES: dict[str, dict[str, Any]] = {
    "arm": {"corners": [(-8, -8), (52, -8), (52, 8), (-8, 8)], "bores": [(0, 0, 6)], "turn": (1, 2, 3, 0.9)},
    "bracket": {
        "corners": [(-10, -10), (70, -10), (70, 40), (-10, 40)],
        "bores": [(0, 0, 5), (60, 0, 5), (60, 30, 5), (0, 30, 5)],
        "turn": (0, 1, 0, 1.5707963267948966),
    },
    "rocker": {
        "corners": [(-28, -8), (48, -8), (48, 8), (-28, 8)],
        "bores": [(0, 0, 6), (40, 0, 4), (-20, 0, 4)],
        "turn": (-2, 1, 1, 2.2),
    },
    "block": {"corners": [(0, 0), (30, 0), (30, 10), (0, 10)], "bores": [], "turn": (0, 0, 1, 0.3)},
}
"""Corners and bores (x, y, diameter) in mm; axis and angle of the turn in rad."""
THICKNESS = 5.0
SHIFT = (30.0, -20.0, 55.0)


def write(folder: Path) -> Path:
    """Write every plate as NAME.step; return the folder."""
    subprocess.run([sys.executable, __file__, str(folder), json.dumps(PLATES)], check=True, timeout=300)
    return folder


def main() -> None:
    """Write the files."""
    import gmsh

    folder, plates = Path(sys.argv[1]), json.loads(sys.argv[2])
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    for name, plate in plates.items():
        gmsh.model.add(name)
        points = [occ.addPoint(x, y, 0.0) for x, y in plate["corners"]]
        lines = [occ.addLine(p, q) for p, q in zip(points, points[1:] + points[:1], strict=True)]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        solid = [entity for entity in occ.extrude([(2, face)], 0.0, 0.0, THICKNESS) if entity[0] == 3]
        tools = [(3, occ.addCylinder(x, y, -1.0, 0.0, 0.0, THICKNESS + 2.0, d / 2.0)) for x, y, d in plate["bores"]]
        if tools:
            solid, _ = occ.cut(solid, tools)
        occ.rotate(solid, 0.0, 0.0, 0.0, *plate["turn"])
        occ.translate(solid, *SHIFT)
        occ.synchronize()
        gmsh.write(str(folder / f"{name}.step"))
    gmsh.finalize()


if __name__ == "__main__":
    main()
