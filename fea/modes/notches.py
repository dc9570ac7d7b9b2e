"""How near a link of a brittle material comes to breaking at a notch, and by what."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band


@dataclass(frozen=True, kw_only=True, eq=False)
class NotchFactor:
    """By what the loads of a link may grow until it breaks at a notch.

    Attributes
    ----------
    factor : Band
        The lower of those by critical distance and by volume, with all that leaves it open.
    location : ndarray of float, shape (3,)
        Place of the surface that comes nearest to breaking, by the point method; without a critical distance that of
        the largest stress [mm].
    surface : float
        Largest principal stress there [MPa].
    distance : float or None
        Critical distance L [mm]; None where the card has none.
    point, line : float or None
        Stress at L/2, and mean over 2 L where that is nearest to breaking [MPa].
    relieved : bool
        False where stress is even over 2 L or falls straight through the wall, or a line of 4 L leaves the link: then
        the surface stress stands against the tensile strength.
    by_point, by_line, by_volume : float or None
        The factor by each method, as stated; None where the card does not tell.
    effective_volume : float or None
        That would break as often evenly under the largest stress [mm³].
    """

    factor: Band
    location: NDArray[np.float64]
    surface: float
    distance: float | None = None
    point: float | None = None
    line: float | None = None
    relieved: bool = False
    by_point: float | None = None
    by_line: float | None = None
    by_volume: float | None = None
    effective_volume: float | None = None
