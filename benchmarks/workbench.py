"""How soon numbers follow a drag in the workbench; writes benchmarks/results/workbench.json.

python benchmarks/workbench.py [--case owl-wing-static ornithopter knee] [--rate 30]

A drag is 40 changes of the place of a pin or of the angle of the pose, so many a second, through the processes of the
workbench, warm. A number has followed a change when the first answer to this text or to a newer one is there.
"""

import argparse
import asyncio
import json
import re
import statistics
import time
from pathlib import Path
from typing import Any

from record import save

from alula.loads.case.case_file import read_text
from alula.reports.workbench.live.answers import pose_answer
from alula.reports.workbench.live.verdicts import linear_answer
from alula.reports.workbench.live.workers import Workers

CHANGES = 40
DRAGS = {
    "owl-wing-static": {
        "pin": (r'(points\.C = \[")150( mm)', 150.0, 0.1),
        "pose": (r'(angle = ")228.15( deg)', 228.15, -0.5),
    },
    "ornithopter": {"pin": (r'(throw = ")3( mm)', 3.0, 0.01), "pose": (r'(angle = ")90( deg)', 90.0, 1.0)},
    "knee": {
        "pin": (r'(points\.D = \[")95.25( mm)', 95.25, -0.02),
        "pose": (r'(angle = ")-25( deg)', -25.0, 0.2),
    },
}
"""Case -> what is dragged: the entry, its value, and by how much each change moves it (the knee's, from its stop)."""
ANSWERS = {"pose and joint forces": ("drawn", None), "linear verdict": ("verdict", "linear")}


class Page:
    """When each answer to each revision came first."""

    def __init__(self) -> None:
        self.came: dict[str, dict[int, float]] = {name: {} for name in ANSWERS}

    def tell(self, event: str, data: dict[str, Any]) -> None:
        """Note when an answer came; one of poses counts with its joint forces."""
        for name, (kind, stage) in ANSWERS.items():
            if (event, data.get("stage")) == (kind, stage) and (event != "drawn" or data["forces"]):
                self.came[name].setdefault(data["revision"], time.perf_counter())

    async def until(self, name: str, revision: int) -> None:
        """Wait for an answer."""
        while revision not in self.came[name]:
            await asyncio.sleep(0.01)

    def after(self, name: str, asked: dict[int, float]) -> list[float]:
        """Milliseconds from each change to the first answer to it or to a later one."""
        came = self.came[name]
        return [1e3 * (min(at for r, at in came.items() if r >= revision) - when) for revision, when in asked.items()]


async def drag(case: str, what: str, rate: float) -> dict[str, Any]:
    """One drag, after the same answers to the text as it stands."""
    pattern, value, step = DRAGS[case][what]
    text, page = read_text(case)[0], Page()
    texts = [re.sub(pattern, rf"\g<1>{value + k * step:.6f}\g<2>", text, count=1) for k in range(1, CHANGES + 1)]
    assert len({text, *texts}) == CHANGES + 1, f"{case}: nothing to drag by {pattern}"
    workers = Workers(page.tell, Path())
    workers.ask(0, text, case)
    await page.until("linear verdict", 0)
    asked = {}
    for revision, changed in enumerate(texts, 1):
        asked[revision] = time.perf_counter()
        workers.ask(revision, changed, case)
        await asyncio.sleep(max(0.0, 1.0 / rate - (time.perf_counter() - asked[revision])))
    for name in ANSWERS:
        await page.until(name, CHANGES)
    row: dict[str, Any] = {"case": case, "drag": what, "changes": CHANGES, "rate": rate}
    for name in ANSWERS:
        times = sorted(page.after(name, asked))
        row[name] = {"median_ms": round(statistics.median(times)), "p95_ms": round(times[int(0.95 * (len(times) - 1))])}
        row[name]["answers"] = sum(revision > 0 for revision in page.came[name])
        row[name]["cpu_ms"] = round(processor(name, case, texts[::4]))
    await workers.close()
    return row


def processor(name: str, case: str, texts: list[str]) -> float:
    """Milliseconds of processor time that one answer takes, warm: the median of some, in this process."""
    answer, spent = {"pose and joint forces": pose_answer, "linear verdict": linear_answer}[name], []
    for text in texts:
        before = time.process_time()
        answer(text, case)
        spent.append(1e3 * (time.process_time() - before))
    return statistics.median(spent[1:])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", nargs="+", choices=list(DRAGS), default=list(DRAGS))
    parser.add_argument("--rate", type=float, default=30.0)
    options = parser.parse_args()
    rows = []
    for case in options.case:
        for what in DRAGS[case]:
            rows.append(asyncio.run(drag(case, what, options.rate)))
            print(json.dumps(rows[-1]), flush=True)
    print(save("workbench", {"rows": rows}))


if __name__ == "__main__":
    main()
