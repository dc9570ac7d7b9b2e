"""The numbers of one link as a solid in any number of states: largest stress, stress on layers and displacement.

A state is what acts on the link: at one pose, in one sample, in one answer of a cause. Envelope, tolerance and causes
build one measure of theirs, from the loads of all states under every model of pin pressure and transfer of torque, and
ask it for the peaks; what they make of these is their own.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import LineReference
from alula.fea.refine.convergence import ALONE
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.refine.link_task import ElasticLink
from alula.fea.solid.layers import Layers
from alula.fea.solid.stress import StressField, stress_field
from alula.fea.superposition.peaks import ModeMeasures, Peaks, largest, of_stress
from alula.fea.superposition.unit_solutions import UnitSolutions, solve_loads, solve_units
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.traction import TRANSFERS, Transfer
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW, WIDE, PressureLaw

Real = NDArray[np.float64]

LAWS = (WIDE, NARROW)


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadVariant:
    """States of one record of loads under one model of pin pressure and one of torque transfer.

    Attributes
    ----------
    record : int
        Number of the record.
    law : PressureLaw
    transfer : Transfer or None
        How torques enter; None where there is no choice.
    loads : slice
        Numbers of the states' loads among all.
    """

    record: int
    law: PressureLaw
    transfer: Transfer | None
    loads: slice


@dataclass(frozen=True, kw_only=True, eq=False)
class StatePeaks(Peaks):
    """The largest number of a link under each of N loads; nodes are those of its mesh.

    Attributes
    ----------
    image : ndarray of bool, shape (N,)
        True where it is at the image of that node in z = 0.
    """

    image: NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkMeasure:
    """A link whose modes are solved, and what they make of its numbers.

    Attributes
    ----------
    link : ElasticLink
    units : LinkTractions
        All that acts on it.
    solved : UnitSolutions
        Of N loads: those of all variants, side by side.
    variants : tuple of LoadVariant
    """

    link: ElasticLink
    units: LinkTractions
    solved: UnitSolutions
    variants: tuple[LoadVariant, ...]

    @classmethod
    def of_units(
        cls,
        link: ElasticLink,
        space: DisplacementSpace,
        records: Sequence[LinkLoads],
        *,
        as_first: bool = False,
        threads: int | None = None,
    ) -> "LinkMeasure":
        """Solve for many states, by unit loads.

        Parameters
        ----------
        link : ElasticLink
        space : DisplacementSpace
            Of the link's mesh.
        records : sequence of LinkLoads
            Each of some states.
        as_first : bool, optional
            True where torques may enter as they may in the first state of each record, which others are compared with.
        threads : int, optional

        Returns
        -------
        LinkMeasure

        Raises
        ------
        CannotRunError
            Where memory does not suffice or a solver fails.
        """
        units = LinkTractions.of(space, records, density=link.density)
        size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))
        variants, columns, scales, first = [], [], [], 0
        for number, loads in enumerate(records):
            scale = loads.size(size)
            for law in LAWS:
                for transfer in units.transfers(loads.chosen(slice(0, 1)) if as_first else loads):
                    own = slice(first, first := first + loads.poses)
                    variants.append(LoadVariant(record=number, law=law, transfer=transfer, loads=own))
                    columns.append(units.coefficients(loads, law, transfer))
                    scales.append(np.where(scale > 0.0, scale, max(float(scale.max()), 1e-300)))
        every = np.hstack(columns), np.concatenate(scales)
        solved = solve_units(units, *every, E=link.E, nu=link.nu, threads=threads)
        return cls(link=link, units=units, solved=solved, variants=tuple(variants))

    @classmethod
    def of_loads(
        cls, link: ElasticLink, space: DisplacementSpace, records: Sequence[LinkLoads], *, threads: int | None = None
    ) -> "LinkMeasure":
        """Solve for some single states, by their load vectors themselves.

        Parameters
        ----------
        link : ElasticLink
        space : DisplacementSpace
            Of the link's mesh.
        records : sequence of LinkLoads
            Each of one state.
        threads : int, optional

        Returns
        -------
        LinkMeasure

        Raises
        ------
        CannotRunError
            Where memory does not suffice or a solver fails.
        """
        states = [loads.chosen(None) for loads in records]
        units = LinkTractions.of(space, states, density=link.density)
        every = [(i, one) for i, loads in enumerate(states) for one in units.variants(loads, LAWS, TRANSFERS)]
        vectors, scale = np.array([one.load for _, one in every]), np.array([one.scale for _, one in every])
        variants = (
            LoadVariant(record=i, law=PressureLaw(span=one.span), transfer=one.transfer, loads=slice(n, n + 1))
            for n, (i, one) in enumerate(every)
        )
        solved = solve_loads(space, vectors, scale, E=link.E, nu=link.nu, threads=threads)
        return cls(link=link, units=units, solved=solved, variants=tuple(variants))

    @property
    def sides(self) -> tuple[tuple[Layers, float], ...]:
        """Layers that the solved nodes have, and the sign of z: where the upper half tells all, its image's too."""
        layers, halved = self.link.layers, len(self.solved.nodes) < len(self.solved.space.nodes)
        assert layers is not None
        return ((layers, 1.0), (layers.mirrored, -1.0)) if halved else ((layers, 1.0),)

    @cached_property
    def decisive(self) -> ModeMeasures:
        """The stress that the strength is set against, of the modes at the solved nodes."""
        return of_stress(self.solved.stress, brittle=self.link.brittle)

    def measures(self, quantity: PeakQuantity) -> tuple[ModeMeasures, ...]:
        """Return the numbers of the modes at the solved nodes; of layers, at their images in z = 0 as well.

        Parameters
        ----------
        quantity : {"von_mises", "principal", "layers", "displacement"}
            A displacement is relative to the line through the pins.

        Returns
        -------
        tuple of ModeMeasures
        """
        if quantity == STRESS[self.link.brittle]:
            return (self.decisive,)
        if quantity == "layers":
            return tuple(of_stress(self.solved.stress, brittle=False, layers=one) for one, _ in self.sides)
        if quantity == "displacement":
            line = LineReference(self.solved.space, self.link.line)
            fields = [line.relative(mode.reshape(-1, 3))[self.solved.nodes] for mode in self.solved.displacement.T]
            return (ModeMeasures(parts=np.stack(fields, axis=-1)),)
        return (of_stress(self.solved.stress, brittle=quantity == "principal"),)

    def peaks(self, quantity: PeakQuantity) -> StatePeaks:
        """Return the largest number of all nodes under every load.

        Parameters
        ----------
        quantity
            As of ``measures``.

        Returns
        -------
        StatePeaks
        """
        sides = [largest(one, self.solved.combination) for one in self.measures(quantity)]
        values = np.array([side.value for side in sides])
        best = np.argmax(values, axis=0)[None]
        node = np.take_along_axis(np.array([side.node for side in sides]), best, axis=0)[0]
        return StatePeaks(value=values.max(axis=0), node=self.solved.nodes[node], image=best[0] == 1)

    def field(self, load: int) -> StressField:
        """Return the stress under one of the loads.

        Parameters
        ----------
        load : int
            Its number.

        Returns
        -------
        StressField
        """
        return stress_field(self.solved.space, self.solved.field(load), E=self.link.E, nu=self.link.nu)

    def ends(self, quantity: PeakQuantity, load: int, node: int, value: float) -> tuple[float, float]:
        """Return the band of a stress by the fourfold estimate beside its node on this mesh alone, and by contact.

        Parameters
        ----------
        quantity
            As of ``measures``; a stress.
        load : int
            Its number.
        node : int
        value : float
            The stress [MPa].

        Returns
        -------
        tuple of (float, float)
            Not below 0 [MPa].
        """
        estimate = estimate_error(self.field(load), self.solved.field(load), E=self.link.E, nu=self.link.nu)
        error = ALONE * float(estimate.stress[(self.solved.space.cells == node).any(axis=1)].max())
        if quantity == "layers" and self.link.layers is not None:
            error *= self.link.layers.sensitivity
        [span] = [one.law.span for one in self.variants if one.loads.start <= load < one.loads.stop]
        contact = 1.0 - CONTACT_SHORTFALL if span == NARROW.span else 1.0
        return max(value - error, 0.0), (value + error) / contact
