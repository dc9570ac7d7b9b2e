"""Speed of a motion: the six-bar (owl wing) at 100,000 poses, with kinetostatics, on one core; prints JSON.

Run it with OMP_NUM_THREADS=1 in the environment, or the linear algebra may use more cores.
"""

import json
import math
import os
import platform
import time

import numpy as np

from alula.geometry.linkage.motion import solve_motion
from alula.loads.acting.weight import inertia_loads
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PartMass, PointLoad
from alula.loads.states.kinetostatics import energies, solve_kinetostatics

POSES = 100_000
REPEATS = 3


def main() -> None:
    case = read_case("owl-wing-static")
    pose = case.solve_pose()
    angles = np.radians(np.linspace(228.15, 124.62, POSES))
    load = PointLoad(link="CH", point="H", wrench=np.array([0.0, -0.25, 0.0, 0.0, 0.0, 0.0]))
    masses = {
        name: PartMass(mass=2.23e-6, centroid=np.array([40.0, 0.0]), inertia=1e-3) for name in pose.linkage.moving
    }
    best = {"motion": math.inf, "statics": math.inf, "total": math.inf, "total_cpu": math.inf}
    for _ in range(REPEATS):
        start, cpu = time.perf_counter(), time.process_time()
        motion = solve_motion(pose, angles, speed=-15.0)
        moved = time.perf_counter()
        place = motion.placement
        acting = [load, *inertia_loads(place, masses, np.zeros(3))]
        found = solve_kinetostatics(motion, case.pinned_drive, acting, energies(place, [], [load], masses))
        end, cpu = time.perf_counter(), time.process_time() - cpu
        for key, seconds in zip(best, (moved - start, end - moved, end - start, cpu), strict=True):
            best[key] = min(best[key], seconds)
    print(
        json.dumps(
            {
                "benchmark": "motion of the six-bar with kinetostatics",
                "poses": POSES,
                "seconds": best,
                "limit_seconds": 2.0,
                "closure_residual": motion.residual,
                "energy_imbalance": float(np.nanmax(np.abs(found.imbalance)) / np.nanmax(np.abs(found.drive_power))),
                "threads": os.environ.get("OMP_NUM_THREADS", "not set"),
                "machine": f"{platform.machine()}, {os.cpu_count()} cores",
                "versions": f"Python {platform.python_version()}, numpy {np.__version__}",
            },
            indent=2,
        )
    )


if __name__ == "__main__":
    main()
