"""The points of a study: by number, so that no list of a million is held and a stopped study finds its place."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from alula.loads.plans.axis import Axis, plain
from alula.loads.plans.plan import Sample

Point = dict[str, object]
"""Entry -> value."""


class Points(Sequence[Point]):
    """Every point of a table, combined with every value of the axes or with a sample of them.

    The last axis changes fastest. A sample is the same for equal seeds.

    Parameters
    ----------
    axes : sequence of Axis
    table : sequence of mapping
        Points of a file; one without entries where there is none.
    sample : Sample or None
        In place of the grid.
    """

    def __init__(
        self, axes: Sequence[Axis], table: Sequence[Mapping[str, object]], sample: Sample | None = None
    ) -> None:
        self.axes, self._table = tuple(axes), table
        self._shares = None if sample is None else _shares(len(self.axes), sample)
        self._inner = math.prod(len(a.values) for a in self.axes) if self._shares is None else len(self._shares)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._table) * self._inner

    def __getitem__(self, number: int) -> Point:  # type: ignore[override]  # no slices
        """Return one point."""
        if not 0 <= number < len(self):
            raise IndexError(number)
        row, rest = divmod(number, self._inner)
        point = {p: plain(value) if isinstance(value, str) else value for p, value in self._table[row].items()}
        return point | (self._of_grid(rest) if self._shares is None else self._of_sample(rest))

    def __iter__(self) -> Iterator[Point]:
        """Yield every point in order."""
        return (self[number] for number in range(len(self)))

    @property
    def paths(self) -> tuple[str, ...]:
        """The entries that differ between points."""
        return (*(self._table[0] if self._table else ()), *(axis.path for axis in self.axes))

    def _of_grid(self, number: int) -> Point:
        found: list[tuple[str, object]] = []
        for axis in reversed(self.axes):
            number, place = divmod(number, len(axis.values))
            found.append((axis.path, axis.values[place]))
        return dict(reversed(found))

    def _of_sample(self, number: int) -> Point:
        assert self._shares is not None
        return {a.path: a.at(float(share)) for a, share in zip(self.axes, self._shares[number], strict=True)}


def _shares(dimensions: int, sample: Sample) -> NDArray[np.float64]:
    """Return points of the unit cube (count, dimensions), by scipy.stats.qmc."""
    from scipy.stats import qmc

    if sample.method == "sobol":
        power = max(math.ceil(math.log2(sample.count)), 0)  # its balance holds for powers of two; the rest is cut off
        return np.asarray(qmc.Sobol(dimensions, rng=sample.seed).random_base2(power)[: sample.count])
    return np.asarray(qmc.LatinHypercube(dimensions, rng=sample.seed).random(sample.count))
