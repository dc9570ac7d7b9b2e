"""What a row of the stability study hands over, and how its tables and figures are made."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import matplotlib as mpl
from matplotlib.figure import Figure

mpl.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "lines.markersize": 4})

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class Row:
    """Table in Markdown and figure of one row."""

    table: str
    figure: Figure


def table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Markdown table; floats with three digits, NaN where the program refuses."""

    def text(value: Any) -> str:
        if value != value:
            return "refused"
        return f"{value:.3g}" if isinstance(value, float) else str(value)

    lines = [head, ["---"] * len(head), *([text(value) for value in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def figure(count: int) -> tuple[Figure, list[Any]]:
    """Return a figure with that many axes side by side."""
    made = Figure(figsize=(4.4 * count, 3.6), layout="constrained")
    axes = made.subplots(1, count, squeeze=False)
    return made, list(axes[0])


def timed(task: Callable[[], T], repeats: int = 1) -> tuple[T, float]:
    """Result and least time [s] of some calls."""
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        found = task()
        best = min(best, time.perf_counter() - start)
    return found, best
