"""Run every published benchmark and write the table of docs/verification.md: ``python -m benchmarks.verification``."""

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.record import between, stamped

if TYPE_CHECKING:
    from solid_problems import Benchmark, Study

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "verification.md"
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


def studies() -> "list[tuple[Benchmark, Study]]":
    found = []
    for module in map(importlib.import_module, KNOWN):
        for benchmark in module.BENCHMARKS:
            print(f"{benchmark}: bands", file=sys.stderr, flush=True)
            found += [(benchmark, study) for study in benchmark.studies()]
    return found


def band_rows(found: "list[tuple[Benchmark, Study]]") -> Iterator[str]:
    yield (
        "| problem | quantity | true error of the finest | band about the target "
        "| estimated over true error in energy, each mesh alone | with the energies |\n|---|---|--:|---|---|---|\n"
    )
    for benchmark, study in found:
        ends = sorted((study.band.low / study.target - 1.0, study.band.high / study.target - 1.0))
        alone, ratios = (
            ", ".join(f"{ratio:.2f}" for ratio in ratios) or "-" for ratios in (study.alone, study.estimates)
        )
        yield (
            f"| {benchmark} | {study.quantity} | {percent(study.error)} "
            f"| {percent(ends[0])} to {percent(ends[1])} | {alone} | {ratios} |\n"
        )


def convergence_rows(found: "list[tuple[Benchmark, Study]]") -> Iterator[str]:
    yield (
        "| problem | quantity | relative sizes | unknowns | values | kind | observed order | factor on the estimate "
        "| index |\n|---|---|---|--:|--:|---|--:|--:|--:|\n"
    )
    for benchmark, study in found:
        band = study.band
        sizes, unknowns, values = (
            ", ".join(f"{size / band.sizes[-1]:.3g}" for size in band.sizes),
            ", ".join(f"{count:,}" for count in study.unknowns),
            ", ".join(f"{value:.6g}" for value in band.values),
        )
        order = "-" if band.order is None else f"{band.order:.2f}"
        yield (
            f"| {benchmark} | {study.quantity} | {sizes} | {unknowns} | {values} | {band.kind} | {order} "
            f"| {band.factor:g} | {100.0 * band.index:.2g} % |\n"
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
    sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "validation")]
    found = studies()
    measured = "\n".join(
        (
            "### Known answers\n\n" + "".join(known_rows()),
            "### Convergence\n\n" + "".join(convergence_rows(found)),
            "### Error bands and estimates\n\n" + "".join(band_rows(found)),
            "### Handbook factors\n\n" + "".join(handbook_rows()),
        )
    )
    between(PAGE, "measured", f"{measured}\n{stamped('verification')}")


if __name__ == "__main__":
    main()
