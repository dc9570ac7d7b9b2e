"""Cost of a 360-pose envelope of a link beside one direct static solution of it, in one run; prints JSON.

Links: AE of the owl wing (three pins, driven at GF) and the crank of a crank-rocker that turns fully at
1500 rpm under weight and inertia (its force goes all round, and the drive torque enters in two ways). The
direct solution is one load case with one law of pin pressure: space, loads, assembly, factorisation, solution
and recovered stress; once by a factorisation, and once by the solver that is chosen for it. That may be the
two-level one, cheaper for one load and dearer for the fifty that a motion asks for. The envelope is 360 poses
with both laws, both transfers, all nodes searched, from the same mesh; meshing is in none. All are taken in turn
and the best of each counts; on a machine that does other work beside, the processor's seconds on one thread are
the ones to go by. Prints JSON and writes benchmarks/results/envelope.json.

    python benchmarks/envelope.py [--sizes 2 1] [--threads 2]

Sizes are factors on the mesher's own element sizes.
"""

import argparse
import math
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from record import save

from alula.fea.common.threads import bounded
from alula.fea.elements.space import displacement_space
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.motion.link_history import link_histories
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.solvers.solve import Method, available_methods
from alula.geometry.materials.material import Material
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.records.bearing import WIDE
from alula.loads.states.case_motion import solve_case_motion

POSES = 360
REPEATS = 3
SIZES = {"AE": (2.0, 1.0), "crank": (2.0, 1.0, 0.6)}
OWL_WING = ("owl-wing-static", ['layer_spacing="0 mm"', "drive.link=GF", "drive.joint=G", f"motion.poses={POSES}"])
CRANK_ROCKER = f"""
schema_version = 1
title = "Crank and rocker"
links.base = {{ ground = true, points = {{ O2 = ["0 mm", "0 mm"], O4 = ["60 mm", "0 mm"] }} }}
links.crank = {{ part = "bar", points = {{ O2 = ["0 mm", "0 mm"], A = ["20 mm", "0 mm"] }} }}
links.coupler = {{ part = "bar", points = {{ A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] }} }}
links.rocker = {{ part = "bar", points = {{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] }} }}
joints.O2 = {{ links = ["base", "crank"], pin_diameter = "3 mm" }}
joints.A = {{ links = ["crank", "coupler"], pin_diameter = "3 mm" }}
joints.B = {{ links = ["coupler", "rocker"], pin_diameter = "3 mm" }}
joints.O4 = {{ links = ["base", "rocker"], pin_diameter = "3 mm" }}
pose = {{ coordinate = "crank", angle = "40 deg", near = {{ coupler = "20 deg", rocker = "60 deg" }} }}
drive = {{ link = "crank", joint = "O2" }}
motion = {{ turn = true, speed = "1500 rpm", inertia = true, poses = {POSES} }}
load_cases.run = {{ own_weight = true }}
[parts.bar]
shape = "bar"
material = "pvc-u"
width = "8 mm"
thickness = "4 mm"
eye_diameter = "12 mm"
eye_thickness = "4 mm"
fillet_radius = "2 mm"
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", nargs="+", type=float, help="instead of those of each link")
    parser.add_argument("--threads", type=int, default=2)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "crank-rocker.toml"
        path.write_text(CRANK_ROCKER, encoding="utf-8")
        cases = {"AE": read_case(*OWL_WING), "crank": read_case(str(path))}
    with bounded(asked.threads):
        runs = [r for link, case in cases.items() for r in _runs(case, link, asked.sizes or SIZES[link], asked.threads)]
    record = {
        "benchmark": f"envelope over {POSES} poses beside one direct static solution",
        "limit_ratio": 3.0,
        "runs": runs,
        "threads": asked.threads,
    }
    path = save("envelope", record)
    print(path.read_text(encoding="utf-8"))


def _runs(case: Case, link: str, sizes: Sequence[float], threads: int) -> list[dict[str, Any]]:
    moved, material = solve_case_motion(case), case.material_of(link)
    (history,) = link_histories(moved, link)
    first, last = (f"bore:{case.body(link).pins[i].name}" for i in (0, -1))
    found = []
    for size in sizes:
        mesh = mesh_body(case.body(link), MeshSettings().scaled(size))

        def direct(method: Method | None) -> tuple[float, int]:
            solution = solve_solid(
                mesh,  # noqa: B023
                E=material.youngs_modulus,
                nu=material.poissons_ratio,
                density=material.density,
                loads=[history.chosen(0)],
                line=(first, last),
                laws=[WIDE],
                transfers=["eye-faces"],
                method=method,
                threads=threads,
            )
            field = stress_field(solution.space, solution.cases[0].displacement, E=solution.E, nu=solution.nu)
            return field.peak.value, solution.space.unknowns

        def envelope(own: Material) -> tuple[float, int]:
            result = LinkMotion(
                displacement_space(mesh),  # noqa: B023
                link=link,
                body=case.body(link),
                material=own,
                histories=[history],
                evaluated=np.ones(history.poses, dtype=np.bool_),
                stated="eye-faces",
                returns=moved.motion.returns,
            ).envelope()
            return next(v.stress[0] for v in result.worst.variants if v.span == 180), result.modes

        factorised, chosen, whole, fatigued = Best(), Best(), Best(), Best()
        for _ in range(REPEATS):
            factorised(lambda: direct(available_methods()[0]))
            peak, unknowns = chosen(lambda: direct(None))
            same, modes = whole(lambda: envelope(material.model_copy(update={"fatigue": None})))
            if material.fatigue:
                fatigued(lambda: envelope(material))
        found.append(
            {
                "link": link,
                "mesh_size": size,
                "unknowns": unknowns,
                "solutions": modes,
                "factorised": factorised.seconds,
                "chosen": chosen.seconds,
                "envelope": whole.seconds,
                "envelope_with_fatigue": fatigued.seconds if material.fatigue else None,
                "ratio_to_factorised": whole.over(factorised),
                "ratio_to_chosen": whole.over(chosen),
                "ratio_to_factorised_with_fatigue": fatigued.over(factorised) if material.fatigue else None,
                "ratio_to_chosen_with_fatigue": fatigued.over(chosen) if material.fatigue else None,
                "peak_difference_at_first_pose": same / peak - 1.0,
            }
        )
    return found


class Best:
    """Least wall and processor seconds of several runs of a task."""

    def __init__(self) -> None:
        self.wall = self.cpu = math.inf

    @property
    def seconds(self) -> dict[str, float]:
        """Both times [s]."""
        return {"wall": self.wall, "cpu": self.cpu}

    def over(self, other: "Best") -> dict[str, float]:
        """Both times as ratios to another task's."""
        return {"wall": self.wall / other.wall, "cpu": self.cpu / other.cpu}

    def __call__(self, task: Callable[[], tuple[float, int]]) -> tuple[float, int]:
        """Run the task and note its times."""
        wall, cpu = time.perf_counter(), time.process_time()
        result = task()
        self.wall = min(self.wall, time.perf_counter() - wall)
        self.cpu = min(self.cpu, time.process_time() - cpu)
        return result


if __name__ == "__main__":
    main()
