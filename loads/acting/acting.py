"""What acts on links: the questions that statics, standing, frames and pictures ask of each kind."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Literal

from alula.geometry.linkage.placement import Placement
from alula.loads.records.applied import Load

End = tuple[str, str]
"""Link and point."""
MarkKind = Literal["coil", "cord", "spiral", "wall"]


@dataclass(frozen=True, kw_only=True)
class ActingMark:
    """How something that acts stands in a picture.

    Attributes
    ----------
    name : str
        As it is told there.
    kind : {"coil", "cord", "spiral", "wall"}
        A zigzag or a line through its ends, a spiral about its one end, a hatched wall.
    ends : tuple of End
        The points of links that it is fastened to, from one end to the other; none for a wall.
    effort : float
        What it does [N, N mm].
    turns : bool
        True where that is a moment.
    at, aside, behind : complex
        Of a wall: where it stands [mm], which way it may be drawn off there (0: no way), and its far side.
    """

    name: str
    kind: MarkKind
    ends: tuple[End, ...] = ()
    effort: float = 0.0
    turns: bool = False
    at: complex = 0j
    aside: complex = 0j
    behind: complex = 0j


class Acting(ABC):
    """Something that acts on links.

    Attributes
    ----------
    lasting : bool
        True where it belongs to the linkage and acts in every load case; no factor on the loads of one changes it.
    """

    lasting: ClassVar[bool] = False

    @abstractmethod
    def loads(self, place: Placement) -> tuple[Load, ...]:
        """Return what it does to the links.

        Parameters
        ----------
        place : Placement
            Where the links stand, at one pose or at n; where it has rates, how they move.

        Returns
        -------
        tuple of Load
            At one pose or at those of ``place``.
        """

    def marks(self, place: Placement) -> tuple[ActingMark, ...]:
        """Return how it is drawn; loads without a mark of their own are drawn as arrows.

        Parameters
        ----------
        place : Placement
            Where the links stand, at one pose.

        Returns
        -------
        tuple of ActingMark
        """
        return ()


def loads_of(acting: Iterable[Acting], place: Placement) -> tuple[Load, ...]:
    """Return what some that act do to the links, one after the other.

    Parameters
    ----------
    acting : iterable of Acting
    place : Placement
        Where the links stand.

    Returns
    -------
    tuple of Load
    """
    return tuple(load for one in acting for load in one.loads(place))
