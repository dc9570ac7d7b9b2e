"""All that acts on one link as a solid, of every kind: its fields, and the load vectors of a check's variants."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import rigid_motions
from alula.fea.tractions.end_traction import EndTraction
from alula.fea.tractions.line_force import LineForce
from alula.fea.tractions.mass_force import MassForce
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.slot_pressure import SlotPressure
from alula.fea.tractions.surface_load import SurfaceLoad
from alula.fea.tractions.surfaces import Surfaces
from alula.fea.tractions.thrust import Thrust
from alula.fea.tractions.torque import Torque
from alula.fea.tractions.traction import TRANSFERS, Transfer
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.bearing import WIDE, PressureLaw, Span

if TYPE_CHECKING:
    from scipy.sparse import csc_array

Real = NDArray[np.float64]

SPREAD: tuple[type[SurfaceLoad], ...] = (LineForce, MassForce)
"""Kinds that act all over the link, and not where it meets others."""
KINDS: tuple[type[SurfaceLoad], ...] = (PinPressure, SlotPressure, Thrust, Torque, EndTraction, *SPREAD)


@dataclass(frozen=True, kw_only=True, eq=False)
class Variant:
    """One load case under one model of pin pressure and one of torque transfer.

    Attributes
    ----------
    name : str
        Of the load case.
    span : Span
        Loaded angle of the pin holes [degrees].
    transfer : Transfer or None
        How the drive torque enters; None where the link carries no torque, or only where no flat face is.
    load : ndarray, shape (3n,)
        Consistent nodal forces [N].
    scale : float
        Sum of all forces, and of all moments over the link's size [N].
    """

    name: str
    span: Span
    transfer: Transfer | None
    load: Real
    scale: float


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkTractions:
    """The surface loads of one link, side by side.

    A single field need not balance, while the loads of a pose do. So the link is held by six isostatic supports, whose
    reactions cancel in the sum. Displacements and stresses superpose all the same.

    Attributes
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    loads : tuple of SurfaceLoad
    """

    space: DisplacementSpace
    loads: tuple[SurfaceLoad, ...]

    @classmethod
    def of(
        cls,
        space: DisplacementSpace,
        histories: Sequence[LinkLoads],
        *,
        density: float,
        kinds: Sequence[type[SurfaceLoad]] | None = None,
    ) -> "LinkTractions":
        """Return the surface loads that act in some of the histories.

        Parameters
        ----------
        space : DisplacementSpace
            Of the link's mesh.
        histories : sequence of LinkLoads
            Each at n poses, such as one record per load case.
        density : float
            Of the material [tonne/mm³]. It spreads weight and inertia over the volume; their resultants are then
            brought to those of the link's mass.
        kinds : sequence of type, optional
            ``KINDS`` by default.

        Returns
        -------
        LinkTractions
        """
        surfaces = Surfaces(space, density)
        found = (load for kind in kinds or KINDS for load in kind.found(surfaces, histories))
        return cls(space=space, loads=tuple(found))

    @cached_property
    def vectors(self) -> "csc_array":
        """The fields (3 nodes, units)."""
        from scipy.sparse import csc_array, hstack

        nothing = csc_array((self.space.unknowns, 0))
        return hstack([nothing, *(load.fields for load in self.loads)], format="csc")

    @cached_property
    def wrenches(self) -> Real:
        """Resultants (6, units) of the fields about the frame's origin [N, N mm]."""
        motions = rigid_motions(self.space.nodes, np.zeros(3)).reshape(6, -1)
        return np.asarray((self.vectors.T @ motions.T).T)

    @cached_property
    def numbers(self) -> tuple[slice, ...]:
        """Of each load, the numbers of its fields among all."""
        ends = np.cumsum([0, *(load.fields.shape[1] for load in self.loads)]).tolist()
        return tuple(itertools.starmap(slice, itertools.pairwise(ends)))

    @cached_property
    def local(self) -> NDArray[np.bool_]:
        """True (units,) for the fields without a resultant, of which series are made."""
        found = np.zeros(self.count, dtype=np.bool_)
        for load, numbers in zip(self.loads, self.numbers, strict=True):
            found[numbers.start : numbers.start + load.local] = True
        return found

    @property
    def count(self) -> int:
        """Number of the fields."""
        return int(self.vectors.shape[1])

    def transfers(self, loads: LinkLoads) -> tuple[Transfer | None, ...]:
        """Return the ways in which the link's torques may enter.

        Parameters
        ----------
        loads : LinkLoads
            At n poses.

        Returns
        -------
        tuple of Transfer or None
            None alone where no torque acts at a pin with flat faces about its hole.
        """
        return TRANSFERS if any(load.may_enter_otherwise(loads) for load in self.loads) else (None,)

    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """Return what multiplies each field.

        Parameters
        ----------
        loads : LinkLoads
            At n poses.
        law : PressureLaw
            How a pin presses in its hole.
        transfer : Transfer or None
            Of the torques; None where there is no choice (``transfers``).

        Returns
        -------
        ndarray, shape (units, n)
        """
        return np.vstack([load.coefficients(loads, law, transfer) for load in self.loads])

    def exact(self, loads: LinkLoads, law: PressureLaw = WIDE, transfer: Transfer | None = None) -> Real:
        """Return the load vectors themselves, without the error of a series.

        Parameters
        ----------
        loads, law, transfer
            As for ``coefficients``.

        Returns
        -------
        ndarray, shape (3 nodes, n)
            [N]
        """
        nothing = np.zeros((self.space.unknowns, loads.poses))
        return sum((load.exact(loads, law, transfer) for load in self.loads), nothing)

    def variants(
        self, case: LinkLoads, laws: Sequence[PressureLaw], transfers: Sequence[Transfer]
    ) -> Iterator[Variant]:
        """Yield the exact load vectors of a load case at one pose.

        Parameters
        ----------
        case : LinkLoads
            One of the histories, at a single pose.
        laws : sequence of PressureLaw
            Of pin pressure.
        transfers : sequence of Transfer
            Of the drive torque; they count only where the link carries a torque at a pin with flat faces about its
            hole, since else it can enter through the bore alone.

        Yields
        ------
        Variant
            One per law and transfer.

        Raises
        ------
        CannotRunError
            For a load case without any load.
        """
        scale = self._scale(case)
        if scale == 0.0:
            raise CannotRunError(f"load case '{case.name}' puts no load on the link; leave it out")
        choice = [load for load in self.loads if load.may_enter_otherwise(case)]
        rest = replace(self, loads=tuple(load for load in self.loads if load not in choice))
        turning = replace(self, loads=tuple(choice))
        turned = {way: turning.exact(case, transfer=way) for way in (transfers if choice else (None,))}
        for law in laws:
            pushed = rest.exact(case, law)
            for transfer, torque in turned.items():
                load = (pushed + torque).ravel()
                yield Variant(name=case.name, span=law.span, transfer=transfer, load=load, scale=scale)

    def _scale(self, case: LinkLoads) -> float:
        """Sum of all forces, and of all moments over the link's size [N]: what a resultant is compared with."""
        size = float(np.linalg.norm(np.ptp(self.space.nodes, axis=0)))
        spread = replace(self, loads=tuple(load for load in self.loads if isinstance(load, SPREAD))).exact(case)
        met = replace(case, lines=(), inertia=None).size(size)
        return float(np.sum(met) + np.linalg.norm(spread.reshape(-1, 3), axis=1).sum())
