"""How many bands of the drawn links hold the truth, and how wide they are: from stored series, in seconds."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.fea.refine.convergence import ALONE, SERIES, GridConvergence, grid_convergence
from alula.fea.refine.refinement import FAR, ROUGH
from benchmarks.coverage_parts import Drawn

EXACT = 1.0 / 3.0
"""Most error of a truth over the band that it judges."""
LEFT_OUT = ("links not solved", "bands without a number", "bands whose truth is not exact enough")
ROWS = ("one mesh", "far", "two meshes", "decided", "converged", "not reached")


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A band and the truth.

    Attributes
    ----------
    link : str
        Its name.
    status : str
        One of ``ROWS``.
    held : bool
        Whether the band holds the truth.
    claimed : float
        Largest distance of an end from the value, over the truth.
    ratio : float
        The same over the true error.
    low : bool
        Whether the value is below the truth.
    """

    link: str
    status: str
    held: bool
    claimed: float
    ratio: float
    low: bool


def bands(row: list[dict[str, Any]]) -> list[GridConvergence]:
    """Judge every variant after one mesh by the rule of today."""
    return [grid_convergence(r["stress"][0], r["stress"][1], estimate=r["stress"][2]) for r in row]


def stops(link: Drawn, rows: list[list[dict[str, Any]]], truths: list[list[float]]) -> Iterator[tuple[str, int]]:
    """Where a check of the link may end, by its status, with the number of meshes.

    After one and two meshes by a limit of time; with one that decides, with more that decide, where the limit on the
    stress is so much above or below the truth; with the accuracy asked for, or without it.
    """
    after = [bands(row) for row in rows]
    limit = link.limit * max(value for value, _ in truths)
    yield "one mesh", 1
    clear = all(b.high * FAR < limit or max(b.low, 0.0) > FAR * limit for b in after[0])
    if clear and all(b.index <= ALONE * ROUGH for b in after[0]):
        yield "far", 1
    if len(after) > 1:
        yield "two meshes", 2
    ready = [n for n, found in enumerate(after, 1) if n >= SERIES and all(_counts(b) for b in found)]
    narrow = [n for n in ready if all(b.index <= link.accuracy for b in after[n - 1])]
    clear_at = [n for n in ready if all(not b.low <= limit <= b.high for b in after[n - 1])]
    if clear_at and (not narrow or clear_at[0] < narrow[0]):
        yield "decided", clear_at[0]
    if narrow:
        yield "converged", narrow[0]
    elif len(after) >= SERIES:
        yield "not reached", len(after)


def _counts(band: GridConvergence) -> bool:
    return len(band.values) >= SERIES and band.kind != "growing" and not band.suspect


def judged(
    links: list[Drawn], series: Mapping[str, Any], truths: Mapping[str, Any]
) -> tuple[list[Judged], dict[str, int]]:
    """Judge all bands of a set; and count those that are left out, by the reason."""
    found: list[Judged] = []
    left = dict.fromkeys(LEFT_OUT, 0)
    for link in links:
        rows, known = series.get(link.name), truths.get(link.name)
        if not isinstance(rows, list) or not isinstance(known, list):
            left[LEFT_OUT[0]] += 1
            continue
        for status, count in stops(link, rows, known):
            for kept, band, (truth, doubt) in zip(rows[count - 1], bands(rows[count - 1]), known, strict=True):
                reach = band.index * abs(band.value)
                if kept["unreliable"] or kept["sharp"] or not np.isfinite(reach):
                    left[LEFT_OUT[1]] += 1
                elif doubt > EXACT * reach:
                    left[LEFT_OUT[2]] += 1
                else:
                    error = truth - band.value
                    found.append(
                        Judged(
                            link=link.name,
                            status=status,
                            held=band.low <= truth <= band.high,
                            claimed=reach / truth,
                            ratio=reach / max(abs(error), 1e-12),
                            low=error > 0.0,
                        )
                    )
    return found, left


def rows(name: str, found: list[Judged]) -> Iterator[str]:
    """Rows of the table for one set."""
    groups = [(status, [one for one in found if one.status == status]) for status in ROWS]
    groups.append(("three and more meshes", [one for one in found if one.status in ROWS[3:]]))
    for status, group in groups:
        if not group:
            continue
        names = {one.link for one in group}
        missed = {one.link for one in group if not one.held}
        ratio, claimed = [one.ratio for one in group], [one.claimed for one in group]
        held = sum(one.held for one in group)
        yield (
            f"| {name} | {status} | {len(names) - len(missed)} of {len(names)} | {held} of {len(group)} "
            f"| {np.median(ratio):.1f} | {np.quantile(ratio, 0.95):.0f} "
            f"| {100.0 * np.median(claimed):.1f} % | {100.0 * np.mean([one.low for one in group]):.0f} % |\n"
        )


HEADER = (
    "| set | status | links held | bands held | claimed over true error, median | 95th percentile | claimed, median "
    "| value low |\n|---|---|--:|--:|--:|--:|--:|--:|\n"
)
