"""A load that changes over a cycle: at each pose as the row of the table states it."""

from dataclasses import replace
from typing import Any

import numpy as np

from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import Load


class RowLoad(Acting):
    """One load at every row of a cycle's table.

    Parameters
    ----------
    now : Acting
        At the instant at which the case is checked: at poses that belong to no row.
    *rows : Acting
        At each row, of the same kind and at the same place.
    """

    def __init__(self, now: Acting, *rows: Acting) -> None:
        self.now, self.rows = now, rows

    def loads(self, place: Placement) -> tuple[Load, ...]:
        """As ``Acting.loads``: at the rows of the poses."""
        if place.rows is None:
            return self.now.loads(place)
        if not place.shape:
            return self.rows[int(place.rows)].loads(place)
        every = [self.rows[row].loads(place.chosen(i)) for i, row in np.ndenumerate(place.rows)]
        return tuple(_together(same, place.shape) for same in zip(*every, strict=True))


def _together(loads: tuple[Any, ...], shape: tuple[int, ...]) -> Any:
    """Return a load at n poses from itself at each."""
    first = loads[0]
    every = {x: np.stack([getattr(one, x) for one in loads]) for x in (*first.VECTORS, *first.SCALARS)}
    return replace(first, **{x: values.reshape(*shape, *values.shape[1:]) for x, values in every.items()})
