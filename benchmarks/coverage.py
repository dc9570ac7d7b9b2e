"""Coverage of the error bands of solids: how many hold the truth, and how wide they are.

python -m benchmarks.coverage            series and truths that are not kept yet, then the table
python -m benchmarks.coverage --anew     all of them anew
python -m benchmarks.coverage --table    the table alone, from what is kept
"""

import json
import sys
from pathlib import Path
from typing import Any

from alula.fea.refine import refinement
from alula.fea.refine.link_series import CasePrecision
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import START as FIRST
from alula.fea.refine.refinement import Effort, refine_links
from alula.geometry.base.errors import AlulaError
from benchmarks.coverage_parts import PLANE, YOUNG, Drawn, drawn
from benchmarks.coverage_plane import plane_truths
from benchmarks.coverage_table import HEADER, judged, rows
from benchmarks.coverage_truth import truths
from benchmarks.record import RESULTS, between, save, stamp

PAGE = Path(__file__).resolve().parents[1] / "docs" / "verification.md"
SETS = {"training": (1, 2, 2), "held-out": (2, 7, 3)}
"""Seed, and how often each of the six flat kinds is drawn, and each of the six others."""
EFFORT = {"stated": True, "max_unknowns": 60_000, "max_meshes": 4, "time_limit": 1e9}


def series(link: Drawn) -> list[list[dict[str, Any]]]:
    """Return what is known of every variant after each mesh: sizes, values and estimate of stress and displacement.

    The path is that of a check with a stated accuracy, but it goes on to the last mesh: so a rule can be tried that
    asks for more of them.
    """
    task = LinkTask(
        body=link.body,
        loads=(link.loads,),
        E=YOUNG,
        nu=link.nu,
        density=1e-9,
        line=(f"bore:{link.body.pins[0].name}", f"bore:{link.body.pins[-1].name}"),
        brittle=link.brittle,
        stress_limits=(),
        displacement_limits=(),
    )
    found: list[list[dict[str, Any]]] = []
    original, settled = refinement.precision, refinement._Link._settled

    def recorded(*arguments: Any, **options: Any) -> tuple[CasePrecision, ...]:
        cases = original(*arguments, **options)
        found.append([_kept(case, "principal" if link.brittle else "von_mises") for case in cases])
        return cases

    refinement.precision, refinement._Link._settled = recorded, lambda self: False
    try:
        refine_links({"link": task}, FIRST, Effort(accuracy=link.accuracy, **EFFORT), threads=1)
    finally:
        refinement.precision, refinement._Link._settled = original, settled
    return found


def _kept(case: CasePrecision, measure: str) -> dict[str, Any]:
    kept: dict[str, Any] = {"unreliable": case.unreliable, "sharp": case.sharp is not None}
    for name, one in (("stress", case.series(measure)), ("displacement", case.displacement)):
        kept[name] = [_short(one.sizes), _short(one.values), *_short([one.estimate])]
    return kept


def _short(values: Any) -> list[float]:
    return [float(f"{value:.5g}") for value in values]


def true_peaks(link: Drawn) -> list[list[float]]:
    """Return value and error of the deciding stress for every variant."""
    return plane_truths(link) if link.kind in PLANE else truths(link)


def keep(what: str, names: list[str], anew: bool) -> None:
    """Compute what is not kept yet, link by link."""
    file = RESULTS / f"coverage-{what}.json"
    kept = json.loads(file.read_text()) if file.exists() else {}
    for name in names:
        done = {} if anew else kept.get(name, {})
        for link in drawn(*SETS[name]):
            if link.name in done:
                continue
            try:
                done[link.name] = series(link) if what == "series" else true_peaks(link)
            except AlulaError as error:
                done[link.name] = str(error)
            print(name, what, link.name, flush=True)
            kept[name] = done
            write(file, kept)


def write(file: Path, kept: dict[str, Any]) -> None:
    """Write one line for each link."""
    parts = []
    for name, done in kept.items():
        lines = (f"{json.dumps(key)}: {json.dumps(row, separators=(',', ':'))}" for key, row in done.items())
        parts.append(f"{json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n}")
    file.write_text("{\n" + ",\n".join(parts) + "\n}\n")


def table() -> str:
    """Return the table of both sets and what is left out, by what is kept."""
    kept, known = (json.loads((RESULTS / f"coverage-{what}.json").read_text()) for what in ("series", "truth"))
    text, notes = HEADER, ""
    for name, draw in SETS.items():
        links = list(drawn(*draw))
        found, left = judged(links, kept[name], known[name])
        text += "".join(rows(name, found))
        notes += f"Left out of the {len(links)} links of the {name} set: " + "; ".join(
            f"{count} {reason}" for reason, count in left.items()
        )
        notes += ".\n"
    made = RESULTS / "coverage.json"
    return f"{text}\n{notes}" + (f"\n{stamp(json.loads(made.read_text()))}" if made.exists() else "")


def main() -> None:
    """Compute what is asked for and write the table into the page."""
    if "--table" not in sys.argv[1:]:
        for what in ("truth", "series"):
            keep(what, list(SETS), anew="--anew" in sys.argv[1:])
        if "--anew" in sys.argv[1:]:
            save("coverage", {})
    between(PAGE, "coverage", table())


if __name__ == "__main__":
    main()
