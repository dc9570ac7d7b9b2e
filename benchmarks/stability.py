"""Makes every figure and every table of docs/stability.md.

    python -m benchmarks.stability [ROW ...]

Rows: see ``ROWS``; all of them without argument. Times were measured on one core and differ between runs; everything
else repeats. Guards of the program are switched off here, and only here, to show what they guard against.
"""

import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks import stability_frames, stability_linkages, stability_scale, stability_solids
from benchmarks.record import between, stamped
from benchmarks.stability_report import Row

DOCS = Path(__file__).resolve().parent.parent / "docs"
ROWS: dict[str, Callable[[], Row]] = {
    "dead-points": stability_linkages.dead_points,
    "near-grashof": stability_linkages.near_grashof,
    "synthesis": stability_linkages.synthesis,
    "slenderness": stability_solids.slenderness,
    "poisson": stability_solids.poisson,
    "scale": stability_scale.scale,
    "mixed-stiffness": stability_frames.mixed_stiffness,
    "mesh-quality": stability_solids.mesh_quality,
    "rounding": stability_scale.rounding,
    "buckling": stability_frames.buckling,
}


def main() -> None:
    for name in sys.argv[1:] or ROWS:
        row = ROWS[name]()
        row.figure.savefig(DOCS / "images" / f"stability-{name}.png", dpi=110)
        between(DOCS / "stability.md", name, f"{row.table}\n\n{stamped(f'stability-{name}')}")
        print(f"{name}\n{row.table}", flush=True)


if __name__ == "__main__":
    main()
