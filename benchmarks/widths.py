"""How wide the bands of all built-in cases are, how many checks they leave undecided, and what couples add to them.

    python -m benchmarks.widths [--fidelity auto] [--cases owl-wing-static ...]

A band is wide where its ends lie more than a factor of 3 apart, and couples count where they alone make a factor of
more than 1.5 of it. A check of a linkage that gives way is counted by itself: no band decides it. Wide bands are told
by quantity and by the source of their largest part.
"""

import argparse
import math
from collections import Counter
from typing import Any

import alula
from alula.fea.common.source import SourceKind, widest
from alula.fea.common.verdict import CheckOutcome
from benchmarks.record import save

WIDE = 3.0
BY_COUPLES = 1.5


def ratio(outcome: CheckOutcome) -> float:
    """Return the upper end of a check's band over its lower one; 1 where both are the same."""
    band = outcome.value
    if band.high == band.low:
        return 1.0
    return band.high / band.low if band.low > 0.0 else math.inf


def cause(outcome: CheckOutcome) -> str:
    """Return what the largest part of a band comes from, as its check's quantity and source."""
    most = " or ".join(dict.fromkeys(source.kind for source in widest(outcome.value.sources, ratio(outcome))))
    return f"{outcome.quantity} of a {outcome.subject.kind}: {most or 'no source'}"


def counted(name: str, fidelity: str) -> tuple[Counter[str], Counter[str], list[dict[str, Any]]]:
    """Return how many checks of a case are what, how many are wide by what, and those that couples widen."""
    found, causes, widened = Counter[str](), Counter[str](), []
    report = alula.check(name, fidelity=fidelity)
    gives_way = {one.name for one in report.result.load_cases.values() if one.gives_way}
    for check in [check for one in report.result.load_cases.values() for check in one.checks]:
        found["checks"] += 1
        lost = check.verdict == "undecided" and check.load_case in gives_way
        found["gives way"] += lost
        found["undecided"] += check.verdict == "undecided" and not lost
        if check.value.unknowable:
            found["unknown"] += 1
            continue
        kinds = {one.kind: one.width for one in check.value.sources}
        by_couples = kinds.get(SourceKind.COUPLES, 1.0)
        wide = bool(ratio(check) > WIDE)
        found["wide"] += wide
        if wide:
            causes[cause(check)] += 1
        found["wide, no couples"] += wide and SourceKind.COUPLES not in kinds
        found["couples count"] += bool(by_couples > BY_COUPLES)
        found["couples, width not known"] += math.isnan(by_couples)
        if by_couples > BY_COUPLES:
            widened.append(
                {"check": f"{check.load_case}: {check.subject.name} {check.quantity}", "factor": float(by_couples)}
            )
    return found, causes, widened


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fidelity", default="auto")
    parser.add_argument("--cases", nargs="+", default=alula.cases())
    chosen = parser.parse_args()
    total, every, record = Counter[str](), Counter[str](), {}
    for name in chosen.cases:
        found, causes, widened = counted(name, chosen.fidelity)
        total.update(found)
        every.update(causes)
        record[name] = {**found, "by couples": widened}
        print(f"{name:24}", dict(found), flush=True)
    print(f"{'all':24}", dict(total))
    for what, count in every.most_common():
        print(f"{count:4}  {what}")
    if len(record) == len(alula.cases()):
        save(f"widths_{chosen.fidelity}", {"cases": record, "all": dict(total), "wide by": dict(every)})


if __name__ == "__main__":
    main()
