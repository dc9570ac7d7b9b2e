"""Run every published benchmark and write the table of docs/verification.md: ``python benchmarks/verification.py``."""

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "verification.md"
START, END = "<!-- measured: begin -->\n", "<!-- measured: end -->\n"
KNOWN = ("test_nafems", "test_macneal_harder", "test_cook", "test_lame", "test_howland", "test_timoshenko_solid")
HANDBOOK = ("test_lug", "test_cross_drilled_tube")


def known_rows() -> Iterator[str]:
    yield (
        "| problem | quantity | target | source | ours, coarse | error | unknowns "
        "| ours, converged | error | unknowns |\n"
        "|---|---|--:|---|--:|--:|--:|--:|--:|--:|\n"
    )
    for module in map(importlib.import_module, KNOWN):
        for benchmark in module.BENCHMARKS:
            print(benchmark, file=sys.stderr, flush=True)
            (n, coarse), (m, fine) = benchmark.run("coarse"), benchmark.run("converged")
            for name, (target, unit) in benchmark.targets.items():
                yield (
                    f"| {benchmark} | {name} | {target:g} {unit} | {benchmark.source} "
                    f"| {coarse[name]:.6g} | {percent(coarse[name] / target - 1.0)} | {n:,} "
                    f"| {fine[name]:.6g} | {percent(fine[name] / target - 1.0)} | {m:,} |\n"
                )


def band_rows() -> Iterator[str]:
    yield (
        "| problem | quantity | densities | true error of the finest | band about the target | kind | observed order "
        "| estimated over true error in energy |\n|---|---|---|--:|---|---|--:|---|\n"
    )
    for module in map(importlib.import_module, KNOWN):
        for benchmark in module.BENCHMARKS:
            print(f"{benchmark}: bands", file=sys.stderr, flush=True)
            for study in benchmark.studies():
                ends = sorted((study.band.low / study.target - 1.0, study.band.high / study.target - 1.0))
                order = "-" if study.band.order is None else f"{study.band.order:.2f}"
                ratios = ", ".join(f"{ratio:.2f}" for ratio in study.estimates) or "-"
                yield (
                    f"| {benchmark} | {study.quantity} | {', '.join(map(str, benchmark.series))} "
                    f"| {percent(study.error)} | {percent(ends[0])} to {percent(ends[1])} "
                    f"| {study.band.kind} | {order} | {ratios} |\n"
                )


def handbook_rows() -> Iterator[str]:
    yield "| problem | handbook | ours, converged | difference | unknowns |\n|---|--:|--:|--:|--:|\n"
    for module in map(importlib.import_module, HANDBOOK):
        for name, unknowns, ours, theirs in module.comparisons("converged"):
            print(name, file=sys.stderr, flush=True)
            yield f"| {name} | {theirs:.3f} | {ours:.3f} | {percent(ours / theirs - 1.0)} | {unknowns:,} |\n"


def percent(share: float) -> str:
    return f"{100.0 * share:+.3f} %" if abs(share) < 0.001 else f"{100.0 * share:+.2f} %"


def main() -> None:
    sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "validation")]
    measured = "\n".join(
        (
            "### Known answers\n\n" + "".join(known_rows()),
            "### Error bands and estimates\n\n" + "".join(band_rows()),
            "### Handbook factors\n\n" + "".join(handbook_rows()),
        )
    )
    before, rest = PAGE.read_text(encoding="utf-8").split(START)
    PAGE.write_text(before + START + "\n" + measured + "\n" + END + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    main()
