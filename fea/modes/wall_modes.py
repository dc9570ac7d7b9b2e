"""In which ways thin walls and deep strips buckle, and at what factor."""

from dataclasses import dataclass
from enum import StrEnum

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason


class WallMode(StrEnum):
    """A way in which a thin link buckles though it stays straight as a column; its value says for people what it is."""

    WALL = "buckling of the wall"
    FLATTENING = "flattening of the bent tube"
    LATERAL = "lateral-torsional buckling"


@dataclass(frozen=True, kw_only=True)
class WallFactor:
    """By what all loads on a link may grow until it buckles in one mode.

    Attributes
    ----------
    mode : WallMode
    x : float
        Station that bears most in this mode; of lateral buckling that of the largest moment [mm].
    compression : float
        Normal force there; 0 in tension [N].
    moment : float
        Bending moment there [N·mm].
    bears : float
        The moment that this mode bears by itself, without compression [N·mm].
    ratio : float
        Radius of the wall's middle over its thickness; of a strip depth over thickness.
    factor : Band
    told : Reason or str
        What the reader must know about it; "" where there is nothing.
    """

    mode: WallMode
    x: float
    compression: float
    moment: float
    bears: float
    ratio: float
    factor: Band
    told: Reason | str = ""
