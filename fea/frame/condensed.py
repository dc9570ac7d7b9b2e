"""A link of a frame that is no beam but the flexibility of its solid between its pins (static condensation).

The element has the natural form of the frame's beams (``alula.fea.frame.system``): its natural forces are the wrenches
at all places but the first, where what balances them acts; its deformations are the motions of these places beside the
rigid motion of the first. So rigid motions strain nothing, exactly, and equilibrium does not depend on the flexibility.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.loads.records.applied import shifted

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkFlexibility:
    """How a link gives between its points, in its own axes.

    Attributes
    ----------
    places : tuple of str
        Names of its p points.
    flexibility : ndarray, shape (6 p, 6 p)
        From wrenches that balance to motions [mm/N, 1/(N·mm)].
    moved : ndarray, shape (6 p,)
        Motions under its spread loads, balanced at the points in such a way that the flexibility gives nothing for what
        balances them [mm, rad].
    """

    places: tuple[str, ...]
    flexibility: Real
    moved: Real

    @classmethod
    def rigid(cls, places: tuple[str, ...]) -> "LinkFlexibility":
        """Return a link that does not give.

        Parameters
        ----------
        places : tuple of str
            Names of its points.

        Returns
        -------
        LinkFlexibility
        """
        size = 6 * len(places)
        return cls(places=places, flexibility=np.zeros((size, size)), moved=np.zeros(size))


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedLink:
    """A link between p nodes.

    Attributes
    ----------
    nodes : tuple of int
        Numbers of its nodes, each on this link alone.
    places : ndarray, shape (p, 3)
        Where they are [mm].
    flexibility : ndarray, shape (6 p, 6 p)
        From wrenches that balance to motions, global axes [mm/N, 1/(N·mm)]; what it gives besides these wrenches, or as
        rigid motion, does not count.
    moved : ndarray, shape (6 p,)
        Motions of the nodes under the link's spread loads and the opposite of their resultant at the first node, global
        axes [mm, rad].
    """

    nodes: tuple[int, ...]
    places: Real
    flexibility: Real
    moved: Real

    @cached_property
    def wrenches(self) -> Real:
        """(6 p, 6 p - 6) at the nodes, of the unit natural forces."""
        found = np.zeros((6 * len(self.nodes), 6 * len(self.nodes) - 6))
        found[6:] = np.eye(6 * len(self.nodes) - 6)
        for k, arm in enumerate((self.places - self.places[0])[1:]):
            found[:6, 6 * k : 6 * k + 6] = -shifted(np.eye(6), arm).T
        return found

    @property
    def natural_flexibility(self) -> Real:
        """(6 p - 6, 6 p - 6) from natural forces to deformations."""
        return np.asarray(self.wrenches.T @ self.flexibility @ self.wrenches)

    @property
    def natural_moved(self) -> Real:
        """(6 p - 6,) deformations under the spread loads."""
        return np.asarray(self.wrenches.T @ self.moved)

    @property
    def columns(self) -> NDArray[np.int64]:
        """(6 p,) numbers of its nodes' displacements."""
        return (6 * np.array(self.nodes)[:, None] + np.arange(6)).ravel()
