"""One kind of load on a link as a solid: fields on its mesh, and what multiplies them under any loads.

A check of few poses and an envelope of many ask the same object. Its fields are load vectors of the mesh alone; its
coefficients follow from the loads. Where the load is no finite sum of fields (the pressure of a pin turns with its
force), a check takes the load itself (``SurfaceLoad.exact``), and the sum of fields is as near to it as its series.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.tractions.surfaces import Surfaces
from alula.fea.tractions.traction import TRANSFERS, Transfer
from alula.loads.records.bearing import PressureLaw

if TYPE_CHECKING:
    from scipy.sparse import csc_array

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceLoad(ABC):
    """One load of its kind on a link, at one place: k fields, and their coefficients under n states.

    To add a kind: one class in a file of its own, its data in ``LinkLoads``, and the class in ``KINDS``
    (``alula.fea.tractions.link_tractions``).

    Attributes
    ----------
    surfaces : Surfaces
        Of the link.
    """

    surfaces: Surfaces

    @classmethod
    @abstractmethod
    def found(cls, surfaces: Surfaces, histories: Sequence[LinkLoads]) -> "Iterator[SurfaceLoad]":
        """Return the loads of this kind that act in some of the histories.

        Parameters
        ----------
        surfaces : Surfaces
            Of the link.
        histories : sequence of LinkLoads
            Each at n states.

        Returns
        -------
        iterator of SurfaceLoad
            One for each place.
        """

    @abstractmethod
    def vectors(self) -> Iterator[Real]:
        """Yield the fields one by one, first the ``local`` ones.

        Yields
        ------
        ndarray, shape (3 nodes,)
            Nodal forces of a unit coefficient.
        """

    @abstractmethod
    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """Return what multiplies the fields.

        Parameters
        ----------
        loads : LinkLoads
            At n states.
        law : PressureLaw
            How a pin presses.
        transfer : Transfer or None
            How torques enter; None where there is no choice.

        Returns
        -------
        ndarray, shape (k, n)
        """

    @property
    def local(self) -> int:
        """Number of the first fields, which have no resultant: a series of them may be cut short."""
        return 0

    def may_enter_otherwise(self, loads: LinkLoads) -> bool:
        """Return whether the load has several ways in which it may enter (``Transfer``).

        Parameters
        ----------
        loads : LinkLoads
            At n states.

        Returns
        -------
        bool
        """
        return False

    @cached_property
    def fields(self) -> "csc_array":
        """The fields (3 nodes, k)."""
        from scipy.sparse import csc_array

        columns = [(rows, vector[rows]) for vector in self.vectors() for rows in (np.flatnonzero(vector),)]
        ends = np.cumsum([0, *(len(rows) for rows, _ in columns)])
        rows, values = (np.concatenate(parts) for parts in zip(*columns, strict=True))
        return csc_array((values, rows, ends), shape=(self.surfaces.space.unknowns, len(columns)))

    def exact(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """Return the load itself, without the error of a series.

        Parameters
        ----------
        loads, law, transfer
            As for ``coefficients``.

        Returns
        -------
        ndarray, shape (3 nodes, n)
            [N]
        """
        return np.asarray(self.fields @ self.coefficients(loads, law, transfer))


@dataclass(frozen=True, kw_only=True, eq=False)
class LinearLoad(SurfaceLoad):
    """A load that is linear in a few amounts, such as the components of a wrench.

    Attributes
    ----------
    place : str or tuple
        Where it acts, as ``places`` tells it.
    sample : record
        What first acts there: its place and sizes count.
    acting : list of int
        The amounts that are not zero in every history, or always wanted.
    """

    ALWAYS: ClassVar[tuple[int, ...]] = ()
    place: Any
    sample: Any
    acting: list[int]

    @classmethod
    @abstractmethod
    def places(cls, loads: LinkLoads) -> dict[Any, Any]:
        """Return where loads of this kind act, and what acts there.

        Parameters
        ----------
        loads : LinkLoads
            At n states.

        Returns
        -------
        dict of str or tuple to record
        """

    @abstractmethod
    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        """Return how much of each unit acts at the place.

        Parameters
        ----------
        loads : LinkLoads
            At n states.
        transfer : Transfer or None
            How torques enter.

        Returns
        -------
        ndarray, shape (m, n)
        """

    @abstractmethod
    def unit(self, number: int) -> Real:
        """Return the load vector of a unit amount.

        Parameters
        ----------
        number : int
            Which.

        Returns
        -------
        ndarray, shape (3 nodes,)
            [N]
        """

    @classmethod
    def found(cls, surfaces: Surfaces, histories: Sequence[LinkLoads]) -> "Iterator[LinearLoad]":
        """As ``SurfaceLoad.found``: one for each place at which some amount is not zero."""
        places = {place: one for loads in reversed(histories) for place, one in cls.places(loads).items()}
        for place, sample in places.items():
            load = cls(surfaces=surfaces, place=place, sample=sample, acting=[])
            every = np.hstack([load.amounts(loads, way) for loads in histories for way in TRANSFERS])
            acting = sorted({*cls.ALWAYS, *np.flatnonzero(every.any(axis=1)).tolist()})
            if acting:
                yield replace(load, acting=acting)

    def vectors(self) -> Iterator[Real]:
        """Yield the load vectors of the amounts that act."""
        return map(self.unit, self.acting)

    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """As ``SurfaceLoad.coefficients``: the amounts that act."""
        return self.amounts(loads, transfer)[self.acting]


def pins_over(histories: Sequence[LinkLoads], *, slotted: bool) -> Iterator[PinLoad]:
    """Yield the pins in holes or in slots, each with all of its states in a row.

    Parameters
    ----------
    histories : sequence of LinkLoads
        Each at n states.
    slotted : bool
        True for those in slots.

    Yields
    ------
    PinLoad
    """
    pins = [pin for history in histories for pin in history.pins if pin.slotted == slotted]
    for name in dict.fromkeys(pin.name for pin in pins):
        own = [pin for pin in pins if pin.name == name]
        wrench, centre = (np.vstack([getattr(pin, what) for pin in own]) for what in ("wrench", "centre"))
        friction = np.hstack([np.broadcast_to(pin.friction, len(pin.wrench)) for pin in own])
        yield replace(own[0], centre=centre, wrench=wrench, friction=friction)
