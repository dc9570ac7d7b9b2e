"""Plastic paths beside CalculiX's, on the same meshes; writes benchmarks/results/plastic_peers.json.

A strip with a hole, a bar with two square eyes (``tests/calculix_plasticity.py``) and half of a bar with round eyes on
the first mesh of its check, all perfectly plastic. Some five minutes.

    python -m benchmarks.plastic_peers
"""

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "benchmarks")]

from calculix_plasticity import calculix_path, our_path, pulled, square_eyes, strip  # noqa: E402
from eye_case import eyes  # noqa: E402
from record import save  # noqa: E402

from alula.fea.elements.space import displacement_space  # noqa: E402
from alula.fea.judging.plastic_collapse import yield_law  # noqa: E402
from alula.fea.plastic.load_path import ProportionalLoad  # noqa: E402
from alula.fea.vibration.link_solid import first_mesh  # noqa: E402
from alula.geometry.meshing.mesh import mesh_body  # noqa: E402


def round_eyes() -> ProportionalLoad:
    """Half of a bar of 8 x 2 mm with eyes of 12 mm about pins of 5 mm."""
    case = eyes()
    space = displacement_space(mesh_body(case.body("level"), first_mesh(case)))
    load: ProportionalLoad = pulled(
        space, yield_law(case.material_of("level")), {"O": (0.0, -500.0), "B": (60.0, 500.0)}, 5.0
    )
    return load


def compared(load: ProportionalLoad) -> dict[str, Any]:
    """Return both paths of a body."""
    begun = time.perf_counter()
    states = our_path(load)
    ours = time.perf_counter()
    factors, displacements = calculix_path(load, states)
    theirs = time.perf_counter()
    gaps = [
        float(np.abs(u - state.displacement.reshape(-1, 3)).max() / np.abs(u).max())
        for state, u in zip(states, displacements, strict=True)
    ]
    return {
        "unknowns": load.body.space.unknowns,
        "control": [state.control for state in states],
        "factor": [state.factor for state in states],
        "calculix": factors,
        "displacement_gap": gaps,
        "ours_s": round(ours - begun, 2),
        "calculix_s": round(theirs - ours, 2),
    }


if __name__ == "__main__":
    bodies = {one.__name__: compared(one()) for one in (strip, square_eyes, round_eyes)}
    save("plastic_peers", {"calculix": "2.20"} | bodies)
