"""Answers of a linkage with one cause of doubt at its end, beside the answer that stands."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.source import Source
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Deviation:
    """The answer with one cause of doubt about the links' stiffness at its end.

    Attributes
    ----------
    source : Source or None
        The cause; None for a pin that sinks into its bore, which no band holds.
    reactions : Reactions
        Joint forces and drive torque.
    points : mapping of tuple of 2 str to ndarray
        (link, point) -> its displacement (3,) [mm].
    """

    source: Source | None
    reactions: Reactions
    points: Mapping[tuple[str, str], Real]
