"""Fills the tables of benchmarks/README.md in from benchmarks/results/*.json: python -m benchmarks.tables."""

from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.figures import HERE, loaded, power, seconds, unknowns_of
from benchmarks.record import between, stamp

PAGE = HERE / "README.md"
MISSING = "Not measured yet.\n"
Record = dict[str, Any]


def table(header: str, rows: list[list[str]]) -> str:
    """A Markdown table: the first column to the left, numbers to the right."""
    names = header.split("|")
    lines = [names, ["---"] + ["--:"] * (len(names) - 1), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def solid(curve: Record) -> bool:
    """Whether a curve is one of finite elements, not a formula or a frame."""
    return curve["model"] not in ("hand", "frame")


def accuracy(record: Record) -> str:
    """Time to reach each target, over that of the fastest solid model, and absolutely."""
    out = []
    for part in record["parts"]:
        targets = list(part["curves"][0]["time_to"]["stress"])
        header = "model|" + "|".join(f"{q} {t}" for q in ("peak stress", "displacement") for t in targets)
        columns = [(quantity, target) for quantity in ("stress", "displacement") for target in targets]
        fastest = {
            (q, t): min((c["time_to"][q][t] for c in part["curves"] if solid(c) and c["time_to"][q][t]), default=None)
            for q, t in columns
        }
        rows = []
        for curve in part["curves"]:
            cells = []
            for quantity, target in columns:
                own, least = curve["time_to"][quantity][target], fastest[quantity, target]
                ratio = f"{own / least:.1f} ({seconds(own)})" if own and least and solid(curve) else None
                cells.append(ratio or (seconds(own) if own else "no"))
            rows.append([curve["model"], *cells])
        out.append(f"**{part['part'].capitalize()}**: {part['about'].split(chr(10))[0]} Reference: {part['source']}.\n")
        out.append(table(header, rows))
    return "\n".join(out) + "\n" + stamp(record)


def peers(record: Record) -> str:
    """Every program's time and memory over alula's, then absolutely."""
    unknowns = unknowns_of(record)
    own = {r["size"]: r for r in record["rows"] if r["program"] == "alula" and "wall_s" in r}
    rows = []
    for row in record["rows"]:
        sides = ", curved" if row["size"].endswith("-curved") else ""
        name = [f"{unknowns[row['size']]:,}{sides}, {row['program']}"]
        ours = own.get(row["size"])
        if "end" in row:
            rows.append([*name, row["end"], "", "", "", "", ""])
            continue
        ratios = ["", "", ""]
        if ours:
            ratios = [f"{ours[key] / row[key]:.2f}" for key in ("wall_s", "cpu_s", "peak_gb")]
        rows.append([*name, *ratios, f"{row['wall_s']:.1f} s", f"{row['cpu_s']:.1f} s", f"{row['peak_gb']:.2f} GB"])
    header = "unknowns, program|alula's wall time over this|processor time|memory|wall time|processor time|peak memory"
    picture = "![Time and memory of every program](figures/peers.png)\n"
    return "\n".join((picture, table(header, rows), stamp(record)))


def unknowns(record: Record) -> str:
    """Time and memory of each size, with the fitted power."""
    rows, said = [], []
    for run in record["runs"]:
        name = f"{run['solver']}, {run['mesh']}"
        if "stages" not in run:
            rows.append([name, run["failed"].rpartition("Error: ")[2], "", "", "", ""])
            continue
        held = max(s["peak_gb"] for s in run["stages"])
        rows.append(
            [
                name,
                f"{run['unknowns']:,}",
                run["name"],
                f"{run['wall_s']:.1f} s",
                f"{run['cpu_s']:.1f} s",
                f"{held:.2f} GB",
            ]
        )
    for solver in dict.fromkeys(r["solver"] for r in record["runs"]):
        done = [r for r in record["runs"] if r["solver"] == solver and "stages" in r]
        if len(done) > 2:
            n = [r["unknowns"] for r in done]
            wall, cpu = (power(n, [r[key] for r in done]) for key in ("wall_s", "cpu_s"))
            said.append(
                f"{solver}: wall time grows with power {wall:.2f} of the unknowns, processor time with {cpu:.2f}."
            )
    header = "solver, mesh|unknowns|solved by|wall time|processor time|peak memory"
    return "\n".join((*(f"{line}\n" for line in said), table(header, rows), stamp(record)))


def envelope(record: Record) -> str:
    """Envelope of 360 poses over one direct solution, with and without fatigue, in processor and in wall time."""
    rows = []
    for run in record["runs"]:
        for what, end in (("", ""), (", with fatigue", "_with_fatigue")):
            if run[f"envelope{end}"] is not None:
                factorised, chosen = run[f"ratio_to_factorised{end}"], run[f"ratio_to_chosen{end}"]
                ratios = [factorised["cpu"], factorised["wall"], chosen["cpu"], chosen["wall"]]
                absolute = [seconds(run[key]["cpu"]) for key in ("factorised", "chosen", f"envelope{end}")]
                size = [f"{run['unknowns']:,}", str(run["solutions"])]
                rows.append([run["link"] + what, *size, *(f"{ratio:.2f}" for ratio in ratios), *absolute])
    header = (
        "link|unknowns|solutions|envelope over one factorised solution, processor time|wall time|over one by the "
        "chosen solver, processor time|wall time|factorised|chosen|envelope"
    )
    return table(header, rows) + "\n" + stamp(record)


def motion(record: Record) -> str:
    """The one number of the motion: seconds for all poses, beside the limit."""
    spent, limit = record["seconds"], record["limit_seconds"]
    wall, cpu = spent["total"], spent["total_cpu"]
    said = (
        f"{wall / limit:.2f} of the limit in wall time, {cpu / limit:.2f} in processor time ({cpu:.2f} of {limit:g} s)"
    )
    return f"{record['poses']:,} poses with their forces: {said}.\n\n{stamp(record)}"


def growth(record: Record) -> str:
    """Poses and load cases."""
    once = record["envelope"]["direct"]["cpu_s"]
    rows = [
        [f"envelope of {r['poses']:,} poses", f"{r['cpu_s'] / once:.2f} direct solutions", seconds(r["cpu_s"])]
        for r in record["envelope"]["runs"]
    ]
    first = record["motion"][0]
    rows += [
        [
            f"motion of {r['poses']:,} poses",
            f"{r['cpu_s'] / first['cpu_s']:.1f} times {first['poses']}",
            seconds(r["cpu_s"]),
        ]
        for r in record["motion"]
    ]
    for method in dict.fromkeys(r["method"] for r in record["load_cases"]["runs"]):
        own = [r for r in record["load_cases"]["runs"] if r["method"] == method]
        spent = [r["set_up"]["cpu_s"] + r["solution"]["cpu_s"] for r in own]
        rows += [
            [f"{method}, load cases: {r['load_cases']}", f"{s / spent[0]:.2f} times one", seconds(s)]
            for r, s in zip(own, spent, strict=True)
        ]
    return table("what|ratio|processor time", rows) + "\n" + stamp(record)


def stages(record: Record) -> str:
    """Whole checks, by fidelity."""
    least = min((r["wall_s"] for r in record["runs"] if "stages" in r), default=1.0)
    rows = []
    for run in record["runs"]:
        if "stages" not in run:
            rows.append([run["fidelity"], run["end"], "", "", ""])
            continue
        most = max(run["stages"], key=run["stages"].__getitem__)
        ratio = f"{run['wall_s'] / least:.1f}"
        rows.append([run["fidelity"], ratio, seconds(run["wall_s"]), seconds(run["cpu_s"]), f"{most}"])
    header = "fidelity|wall time over the fastest|wall time|processor time|longest stage"
    return table(header, rows) + "\n" + stamp(record)


def commits(record: Record) -> str:
    """Whole commands at two commits."""
    rows = []
    for row in record["rows"]:
        ratios = [f"{row[key]['ratio']:.2f}" for key in ("wall_s", "cpu_s")]
        times = [seconds(row[key][name]) for key in ("wall_s", "cpu_s") for name in ("before", "now")]
        rows.append([f"`{row['command']}`", *ratios, *times, f"{row['others']:.0%}"])
    before, now = record["commits"]["before"], record["commits"]["now"]
    header = (
        "command|ratio of wall times|of processor times|wall time before|now|processor time before|now|"
        "others' share of the processors"
    )
    changed = " with changes that are not committed" if record["changed"] else ""
    said = f"Before is commit {before}, now is {now}{changed}; medians of {len(record['rows'][0]['runs']['now'])}.\n"
    return "\n".join((said, table(header, rows), stamp(record)))


def trade(record: Record) -> str:
    """Time to a verdict over the accuracy asked for."""
    rows = []
    for row in record["rows"]:
        theirs = [seconds(row[k]) if k in row else "no" for k in ("calculix_wall_s", "calculix_cpu_s")]
        reached = "none" if row["reached"] is None else f"{100.0 * row['reached']:.2g} %"
        size = [str(row["meshes"]), f"{row['unknowns']:,}", str(row["variants"])]
        own = [seconds(row["wall_s"]), seconds(row["cpu_s"])]
        rows.append([f"{row['case']}, {row['link']}", f"{row['accuracy']:.0%}", reached, *size, *own, *theirs])
    header = (
        "link|accuracy asked for|reached|meshes|unknowns of the last|loads solved|wall time|"
        "processor time, mesher apart|CalculiX on the last mesh, one load, wall time|processor time"
    )
    picture = "![Time to a verdict over accuracy](figures/trade.png)\n"
    return "\n".join((picture, table(header, rows), stamp(record)))


def iterations(record: Record) -> str:
    """Iterations on the last meshes of links."""
    rows = [
        [
            f"{r['case']}, {r['link']}",
            f"{r['unknowns']:,}",
            f"{r['poissons_ratio']:g}",
            str(r["loads"]),
            str(r["iterations"]),
        ]
        for r in record["rows"]
    ]
    header = f"link|unknowns|Poisson's ratio|loads|iterations to {record['tolerance']:g} in energy"
    return table(header, rows) + "\n" + stamp(record)


MILLION, MACHINES, CORES = 1_000_000, 100, 16


def studies(record: Record) -> str:
    """What a study costs beside its checks, and from it on paper a million points on a hundred machines."""
    rows, paper, store = [], [], record["store"]
    for fidelity in dict.fromkeys(run["fidelity"] for run in record["runs"]):
        one, two = (run for run in record["runs"] if run["fidelity"] == fidelity)
        efficiency = one["wall_s"] / (two["workers"] * two["wall_s"])
        slower = max(two["check_cpu_s"] / one["check_cpu_s"], 1.0)
        times = [seconds(run["check_cpu_s"]) for run in (one, two)]
        beside = [seconds(one["parent_cpu_s"]), seconds(max(one["beside_wall_s"], 0.0))]
        others = max(run["others"] or 0.0 for run in (one, two))
        rows.append([fidelity, str(one["points"]), *beside, f"{efficiency:.2f}", *times, f"{others:.0%}"])
        workers = MACHINES * CORES / (one["check_cpu_s"] * slower)  # points a second
        parent = 1.0 / one["parent_cpu_s"]
        first = "the workers" if workers < parent else "the machine that writes"
        hours = [MILLION / rate / 3600.0 for rate in (workers, parent)]
        paper.append([fidelity, *(f"{rate:,.0f}" for rate in (workers, parent)), *(f"{h:.2g} h" for h in hours), first])
    said = (
        f"Into the store go {store['rows_a_second']:,.0f} points a second of {store['numbers_a_row']} numbers, each a "
        f"transaction of {1e3 * store['cpu_s_a_row']:.2f} ms of processor time. A point takes "
        f"{store['bytes_a_row']:,.0f} bytes. {store['read_rows_a_second']:,.0f} a second are read.\n"
    )
    header = (
        "model|points|the study's own processor time a point|wall time a point between checks, one worker|"
        "efficiency of two workers|check's processor time, one worker|two|others' share of the processors"
    )
    size = MILLION * store["bytes_a_row"] / 1e9
    on_paper = (
        f"On paper, {MILLION:,} points on {MACHINES} machines of {CORES} workers each: a file of {size:.1f} GB, and\n"
    )
    limits = "model|workers' points a second|the parent's|time of the workers|of the parent|first bottleneck"
    return "\n".join((table(header, rows), said, on_paper, table(limits, paper), stamp(record)))


def page(record: Record) -> str:
    """Weight of a report, and how soon its models can be turned."""
    parts = dict(record["bytes"])
    aims = {"page": "6.00 MB", "at the linkage": "2 s", "at the first link": "2 s"}
    rows = [["`report.html`", f"{parts.pop('page') / 1e6:.2f} MB", aims["page"]]]
    rows += [[f"{name} in it", f"{size / 1e6:.2f} MB", ""] for name, size in parts.items()]
    for one in record["opened"]:
        middle, times = median(one["ms"]), f"{min(one['ms']) / 1e3:.2f} to {max(one['ms']) / 1e3:.2f} s"
        told = f"{middle / 1e3:.2f} s ({times}, {len(one['ms'])} times)"
        rows.append([f"opened {one['where']}, until its models can be turned", told, aims[one["where"]]])
    return table("what|measured|aim", rows) + "\n" + stamp(record)


def workbench(record: Record) -> str:
    """How soon numbers follow a drag."""
    aims = {"pose and joint forces": "60 ms", "linear verdict": "300 ms"}
    rows = [
        [
            f"{row['case']}, {row['drag']}: {name}",
            *(f"{row[name][key]} ms" for key in ("median_ms", "p95_ms", "cpu_ms")),
            aim,
        ]
        for row in record["rows"]
        for name, aim in aims.items()
    ]
    return (
        table("drag|median|95th percentile|processor time of one answer|aim on the owl wing", rows)
        + "\n"
        + stamp(record)
    )


SECTIONS: dict[str, Callable[[Record], str]] = {
    "accuracy": accuracy,
    "peers": peers,
    "solvers": unknowns,
    "envelope": envelope,
    "growth": growth,
    "motion": motion,
    "stages": stages,
    "studies": studies,
    "commits": commits,
    "trade": trade,
    "iterations": iterations,
    "page": page,
    "workbench": workbench,
}


def told(name: str) -> str:
    """A section as its result has it."""
    record = loaded(name)
    return SECTIONS[name](record) if record else MISSING


def filled_in() -> Path:
    """Write every section between its marks, and return the page."""
    for name in SECTIONS:
        between(PAGE, name, told(name))
    return PAGE


if __name__ == "__main__":
    print(filled_in())
