"""Makes every figure and every table of docs/stability.md.

    python -m benchmarks.stability [ROW ...]

Rows: see ``ROWS``; all of them without argument. Times were measured on one core and differ between runs; everything
else repeats. Guards of the program are switched off here, and only here, to show what they guard against.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks import stability_frames, stability_linkages, stability_scale, stability_solids
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
        _replace(DOCS / "stability.md", name, row.table)
        print(f"{name}\n{row.table}", flush=True)


def _replace(path: Path, name: str, table: str) -> None:
    """Put a table between the marks of its name."""
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    text = path.read_text(encoding="utf-8")
    new, count = re.subn(f"{begin}.*{end}", lambda _: f"{begin}\n{table}\n{end}", text, flags=re.DOTALL)
    if count != 1:
        raise SystemExit(f"{path} has {count} places for {name}, not one")
    path.write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main()
