"""Draws benchmarks/figures/*.png from what results there are: python -m benchmarks.figures."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

HERE = Path(__file__).resolve().parent
RESULTS, FIGURES = HERE / "results", HERE / "figures"

# Okabe and Ito's palette, told apart by colour-blind readers as well; markers and lines differ too.
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, RED, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
MODELS = {
    "linear, uniform": (ORANGE, "o", "-"),
    "linear, adaptive": (ORANGE, "s", "--"),
    "quadratic, straight, uniform": (BLUE, "^", "-"),
    "quadratic, straight, adaptive": (BLUE, "v", "--"),
    "quadratic, curved, uniform": (GREEN, "D", "-"),
    "quadratic, curved, adaptive": (GREEN, "P", "--"),
}
PROGRAMS = {
    "alula": (BLUE, "o"),
    "alula, PARDISO": (SKY, "s"),
    "NGSolve, direct": (ORANGE, "^"),
    "NGSolve, BDDC": (BLACK, "v"),
    "CalculiX": (RED, "D"),
    "scikit-fem, spsolve": (PURPLE, "P"),
}
STAGES = (BLUE, ORANGE, GREEN, PURPLE, SKY, RED, YELLOW, BLACK, "#999999")
FLOOR = 1e-5
"""Least relative error that is drawn: references are no better."""


def loaded(name: str) -> dict[str, Any] | None:
    """A result, or None where that benchmark has not been run."""
    path = RESULTS / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


def plain(value: float, _: Any = None) -> str:
    """A number as one says it: 0.01, 3, 160,000."""
    return f"{value:,.0f}" if value >= 1 else f"{value:g}"


def log_axes(ax: Axes, x: str, y: str) -> None:
    ax.set(xlabel=x, ylabel=y)
    if not ax.lines:  # every run failed: a logarithm of nothing
        return
    ax.set(xscale="log", yscale="log")
    for axis, (low, high) in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        if high < 100.0 * low:  # decades alone would leave an axis without numbers
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(plain))
        axis.set_minor_formatter(NullFormatter())
    ax.grid(which="major", color="#cccccc", linewidth=0.6)
    ax.grid(which="minor", color="#eeeeee", linewidth=0.4)


def seconds(value: float) -> str:
    """A time with a unit that suits it."""
    unit, size = next(((u, s) for u, s in (("s", 1.0), ("ms", 1e-3)) if value >= s), ("µs", 1e-6))
    return f"{value / size:.0f} {unit}" if value >= 10.0 * size else f"{value / size:.2g} {unit}"


def accuracy(record: dict[str, Any]) -> plt.Figure:
    """Error against processor time, part by part."""
    figure, axes = plt.subplots(len(record["parts"]), 2, figsize=(12, 4.1 * len(record["parts"])), squeeze=False)
    quantities = (("stress_error", "peak von Mises stress"), ("displacement_error", "displacement"))
    for row, part in zip(axes, record["parts"], strict=True):
        for ax, (quantity, title) in zip(row, quantities, strict=True):
            for curve in part["curves"]:
                runs = curve["runs"]
                if curve["model"] in MODELS:
                    colour, marker, line = MODELS[curve["model"]]
                    errors = [max(100.0 * abs(r[quantity]), 100.0 * FLOOR) for r in runs]
                    ax.plot(
                        [r["cpu_s"] for r in runs],
                        errors,
                        line,
                        color=colour,
                        marker=marker,
                        ms=5,
                        label=curve["model"],
                    )
            log_axes(ax, "", "error [%]")
            at = ax.get_xlim()
            low = True
            for curve in part["curves"]:
                if curve["model"] not in MODELS:
                    (r,) = curve["runs"]
                    error = max(100.0 * abs(r[quantity]), 100.0 * FLOOR)
                    ax.axhline(error, color=BLACK, linewidth=1.2, linestyle=":" if curve["model"] == "hand" else "-.")
                    ax.annotate(
                        f"{curve['model']}, {seconds(r['cpu_s'])}",
                        (0.01 if low else 0.99, error),
                        xycoords=("axes fraction", "data"),
                        ha="left" if low else "right",
                        va="bottom",
                        fontsize=8,
                    )
                    low = False
            ax.set_xlim(at)
            for target in (10, 5, 2, 1):
                ax.axhline(target, color="#888888", linewidth=0.5)
            ax.set_title(f"{part['part']}: {title}", fontsize=10)
    for ax in axes[-1]:
        ax.set_xlabel("processor time from geometry to stress [s]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=3, fontsize=9)
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    return figure


def power(x: list[float], y: list[float]) -> float:
    """Slope of log y over log x, least squares."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def growth(record: dict[str, Any]) -> plt.Figure:
    """Time and memory against unknowns, with the fitted power."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.6))
    solvers = list(dict.fromkeys(r["solver"] for r in record["runs"]))
    for solver, (colour, marker) in zip(solvers, PROGRAMS.values(), strict=False):
        done = [r for r in record["runs"] if r["solver"] == solver and "stages" in r]
        if not done:
            continue
        n = [r["unknowns"] for r in done]
        for key, line, named in (("wall_s", "-", "wall"), ("cpu_s", "--", "processor")):
            slope = f", power {power(n, [r[key] for r in done]):.2f}" if len(done) > 2 else ""
            left.plot(
                n, [r[key] for r in done], line, color=colour, marker=marker, label=f"{solver}, {named} time{slope}"
            )
        held = [max(s["peak_gb"] for s in r["stages"]) for r in done]
        slope = f", power {power(n, held):.2f}" if len(done) > 2 else ""
        right.plot(n, held, color=colour, marker=marker, label=f"{solver}{slope}")
    log_axes(left, "unknowns", "time of the whole process [s]")
    log_axes(right, "unknowns", "peak memory [GB]")
    left.legend(fontsize=8)
    right.legend(fontsize=8)
    figure.suptitle(f"From mesh file to displacements and stresses, {record['threads']} threads", fontsize=11)
    figure.tight_layout()
    return figure


def poses(record: dict[str, Any]) -> plt.Figure:
    """Time against poses and against load cases."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.4))
    rows = record["motion"]
    left.plot([r["poses"] for r in rows], [r["cpu_s"] for r in rows], color=BLUE, marker="o")
    log_axes(left, "poses", "processor time [s]")
    left.set_title("motion and forces, the whole linkage", fontsize=10)
    told = record["envelope"]
    once = told["direct"]["cpu_s"]
    ratios = [r["cpu_s"] / once for r in told["runs"]]
    middle.plot([r["poses"] for r in told["runs"]], ratios, color=GREEN, marker="o", label="envelope")
    middle.plot(
        [r["poses"] for r in told["runs"]],
        [r["poses"] for r in told["runs"]],
        "--",
        color="#888888",
        label="one direct solution a pose",
    )
    middle.axhline(3.0, color=RED, linewidth=1.0, label="limit at 360 poses: 3")
    log_axes(middle, "poses", "time over one direct solution")
    middle.set_title(f"envelope of link {told['link']}, {told['unknowns']:,} unknowns", fontsize=10)
    middle.legend(fontsize=8)
    cases = record["load_cases"]
    for method, colour, marker in (("pardiso", BLUE, "o"), ("superlu", RED, "D"), ("two-level", ORANGE, "^")):
        rows = [r for r in cases["runs"] if r["method"] == method]
        if rows:
            total = [r["set_up"]["cpu_s"] + r["solution"]["cpu_s"] for r in rows]
            right.plot([r["load_cases"] for r in rows], total, color=colour, marker=marker, label=method)
    log_axes(right, "load cases", "processor time of set-up and solution [s]")
    right.set_xticks([1, 2, 4, 8, 16])
    right.set_title(f"load cases, {cases['unknowns']:,} unknowns", fontsize=10)
    right.legend(fontsize=8)
    figure.tight_layout()
    return figure


def stacked(ax: Axes, bars: list[tuple[str, dict[str, float]]]) -> None:
    """Horizontal stacked bars in shares of the whole, each whole told at its end."""
    names = list(dict.fromkeys(name for _, parts in bars for name in parts))
    for i, (_, parts) in enumerate(bars):
        whole, left = sum(parts.values()), 0.0
        for name, colour in zip(names, STAGES * 2, strict=False):
            share = 100.0 * parts.get(name, 0.0) / whole
            ax.barh(i, share, left=left, color=colour, edgecolor="white", label=name if i == 0 else None)
            if share > 6.0:
                dark = colour in (BLUE, BLACK, GREEN, RED)
                ax.text(
                    left + share / 2.0, i, seconds(parts[name]), ha="center", va="center", fontsize=8,
                    color="white" if dark else "black",
                )  # fmt: skip
            left += share
        ax.text(101, i, f"{whole:.3g} s", va="center", fontsize=9)
    ax.set_yticks(range(len(bars)), [name for name, _ in bars])
    ax.set(xlim=(0, 112), xlabel="share of the wall time [%]")
    ax.invert_yaxis()
    handles = [plt.Rectangle((0, 0), 1, 1, color=c) for _, c in zip(names, STAGES * 2, strict=False)]
    ax.legend(handles, names, ncols=5, fontsize=8, loc="upper center", bbox_to_anchor=(0.45, -0.85 / len(bars)))


def stages(solvers: dict[str, Any] | None, checks: dict[str, Any] | None) -> plt.Figure | None:
    """Where the time goes: one solution by size, one check by fidelity."""
    solved = [r for r in (solvers or {"runs": []})["runs"] if "stages" in r]
    checked = [r for r in (checks or {"runs": []})["runs"] if "stages" in r]
    groups = []
    if solved:
        bars = []
        for r in solved:
            parts = {s["stage"]: s["wall_s"] for s in r["stages"]}
            parts["start of Python"] = max(r["wall_s"] - sum(parts.values()), 0.0)
            bars.append((f"{r['unknowns']:,} unknowns\n{r['solver']}", parts))
        groups.append(("One solution, from mesh file to stress", bars))
    if checked and checks:
        bars = []
        for r in checked:
            rest = {"start, report and pictures": max(r["wall_s"] - sum(r["stages"].values()), 0.0)}
            bars.append((f"--fidelity {r['fidelity']}", r["stages"] | rest))
        groups.append((f"alula check {checks['case']}", bars))
    if not groups:
        return None
    heights = [1.6 + 0.6 * len(bars) for _, bars in groups]
    figure, axes = plt.subplots(
        len(groups), 1, figsize=(12, sum(heights)), squeeze=False, gridspec_kw={"height_ratios": heights}
    )
    for ax, (title, bars) in zip(axes[:, 0], groups, strict=True):
        stacked(ax, bars)
        ax.set_title(title, fontsize=10)
    figure.tight_layout()
    return figure


def unknowns_of(record: dict[str, Any]) -> dict[str, int]:
    """Size -> unknowns, as any program told, else from the size's name."""
    found = {}
    for row in record["rows"]:
        told = [r["answer"]["unknowns"] for r in row["runs"] if "unknowns" in r.get("answer", {})]
        found.setdefault(row["size"], int(row["size"].split("k")[0]) * 1000)
        if told:
            found[row["size"]] = told[0]
    return found


def peers(record: dict[str, Any]) -> plt.Figure:
    """Time and memory of every program; those without an answer are named. Straight sides alone."""
    figure, axes = plt.subplots(1, 2, figsize=(12, 5))
    unknowns = unknowns_of(record)
    record = record | {"rows": [r for r in record["rows"] if not r["size"].endswith("-curved")]}
    for ax, (key, label) in zip(axes, (("wall_s", "wall time [s]"), ("peak_gb", "peak memory [GB]")), strict=True):
        for name in dict.fromkeys(r["program"] for r in record["rows"]):
            colour, marker = PROGRAMS.get(name, (BLACK, "x"))
            done = [r for r in record["rows"] if r["program"] == name and key in r]
            ax.plot(
                [unknowns[r["size"]] for r in done], [r[key] for r in done], color=colour, marker=marker, label=name
            )
        log_axes(ax, "unknowns", label)
    ended = [
        f"{r['program']} at {r['size']}: {r['end']}" for r in record["rows"] if r.get("end", " at ").find(" at ") < 0
    ]
    if ended:
        axes[0].text(0.03, 0.97, "\n".join(["Without an answer:", *ended]), transform=axes[0].transAxes, va="top",
                     fontsize=8)  # fmt: skip
        axes[0].set_ylim(top=20.0 * axes[0].get_ylim()[1])
    axes[1].legend(fontsize=8, loc="lower right")
    figure.suptitle(f"One mesh, material and load, from mesh file to stress, {record['threads']} threads", fontsize=11)
    figure.tight_layout()
    return figure


def trade(record: dict[str, Any]) -> plt.Figure:
    """Time to a verdict over the accuracy asked for, link by link, beside CalculiX on the last mesh."""
    links = list(dict.fromkeys((r["case"], r["link"]) for r in record["rows"]))
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.8), sharey=True)
    for ax, key, title in zip(axes, ("wall_s", "cpu_s"), ("wall time", "processor time, mesher apart"), strict=True):
        for (case, link), colour, marker in zip(links, (BLUE, ORANGE, GREEN, PURPLE), "o^sD", strict=False):
            rows = [r for r in record["rows"] if (r["case"], r["link"]) == (case, link)]
            asked = [100.0 * r["accuracy"] for r in rows]
            ax.plot(asked, [r[key] for r in rows], "-", color=colour, marker=marker, label=f"{case}, {link}")
            theirs = [(x, r[f"calculix_{key}"]) for x, r in zip(asked, rows, strict=True) if f"calculix_{key}" in r]
            if theirs:
                ax.plot(*zip(*theirs, strict=True), ":", color=colour, marker=marker, mfc="white")
        log_axes(ax, "accuracy asked for [%]", "time [s]")
        ax.set_xticks(sorted({100.0 * r["accuracy"] for r in record["rows"]}))
        ax.invert_xaxis()
        ax.set_title(title, fontsize=10)
    axes[1].plot([], [], ":", color=BLACK, marker="o", mfc="white", label="CalculiX on the last mesh, one load")
    axes[1].legend(fontsize=8)
    figure.suptitle(f"From geometry to a stress of that accuracy, {record['threads']} threads", fontsize=11)
    figure.tight_layout()
    return figure


def drawn() -> Iterator[Path]:
    """Draw what there are results for."""
    FIGURES.mkdir(exist_ok=True)
    makers: dict[str, tuple[Callable[[Any], plt.Figure], str]] = {
        "accuracy": (accuracy, "accuracy"),
        "unknowns": (growth, "solvers"),
        "poses": (poses, "growth"),
        "peers": (peers, "peers"),
        "trade": (trade, "trade"),
    }
    found = {name: make(record) for name, (make, source) in makers.items() if (record := loaded(source))}
    split = stages(loaded("solvers"), loaded("stages"))
    if split is not None:
        found["stages"] = split
    for name, figure in found.items():
        path = FIGURES / f"{name}.png"
        figure.savefig(path, dpi=110, metadata={"Software": None})
        plt.close(figure)
        yield path


if __name__ == "__main__":
    for made in drawn():
        print(made.relative_to(HERE.parent))
