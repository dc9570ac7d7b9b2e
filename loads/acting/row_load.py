"""A load that changes over a cycle: at each pose as the row of the table states it."""

import numpy as np

from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import Load, reshaped, together


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
        return tuple(reshaped(together(same), place.shape) for same in zip(*every, strict=True))
