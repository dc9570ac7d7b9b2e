"""What samples of loads do to one link on its nominal solid: peaks by unit solutions, as shares of the nominal ones.

Loads are sums of unit loads (``alula.fea.tractions.link_tractions``), so stress and displacement of every sample are
sums of a few modes. A pin's pressure follows from its direction by a spline through the modes' combinations at some
directions. The peak is sought among nodes that come near to it in one of the pilots: some samples, among them corners,
that are evaluated at all nodes.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.mouth import reference_surfaces
from alula.fea.elements.supports import LineReference
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import SolidSolution
from alula.fea.solid.stress import extreme_principal
from alula.fea.superposition.peaks import deviator
from alula.fea.superposition.unit_solutions import UnitSolutions, solve_units
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.torque import Torque
from alula.fea.tractions.traction import Transfer
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import Body
from alula.geometry.materials.material import Material
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw

Real = NDArray[np.float64]
Variant = tuple[PressureLaw, Transfer | None]
Measure = Callable[[Real], Real]

NEAR = 0.03
"""Share of the peak by which a node may lie below it in every pilot and still bear it in no sample."""
_STEP = math.radians(1.0)
"""Between the directions of a pin's spline; the error of a cubic one is (16 step)⁴/384 of the 16th order's part."""
_BLOCK = 2_000_000
"""Numbers in a block of stresses."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PeakShares:
    """Peaks of n samples over the nominal peak.

    Attributes
    ----------
    value : ndarray, shape (n,)
        Of the variants that the reported value comes from.
    low, high : ndarray, shape (n,)
        The least and the largest of all variants.
    """

    value: Real
    low: Real
    high: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class _Field:
    """What is largest at some node: linear components of the modes, and the number that they make."""

    components: Real
    """(nodes, components, modes)"""
    measure: Measure
    """Of (nodes, components, n) -> (nodes, n)."""

    def at(self, nodes: NDArray[np.int64] | slice, combination: Real) -> Real:
        parts = self.components[nodes]
        k, c, m = parts.shape
        return self.measure((parts.reshape(k * c, m) @ combination).reshape(k, c, -1))

    def hot(self, combination: Real) -> NDArray[np.int64]:
        """Return the nodes that come near to the peak under one of the loads of a combination."""
        step = max(1, _BLOCK // (self.components.shape[1] * combination.shape[1]))
        blocks = [slice(i, i + step) for i in range(0, len(self.components), step)]
        values = np.concatenate([self.at(block, combination) for block in blocks])
        return np.flatnonzero((values >= (1.0 - NEAR) * values.max(axis=0)).any(axis=1))

    def peak(self, nodes: NDArray[np.int64], combination: Real) -> Real:
        step = max(1, _BLOCK // (self.components.shape[1] * len(nodes)))
        count = combination.shape[1]
        return np.concatenate([self.at(nodes, combination[:, i : i + step]).max(axis=0) for i in range(0, count, step)])


def _length(parts: Real) -> Real:
    return np.asarray(np.sqrt(np.einsum("kcn,kcn->kn", parts, parts)))


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkResponse:
    """A link's unit solutions, ready for any samples near to its pilots.

    Attributes
    ----------
    body : Body
    material : Material
    units : LinkTractions
    solved : UnitSolutions
    variants : mapping of str to tuple of (PressureLaw, Transfer or None)
        Load case -> the variants of its nominal solution.
    stated : Transfer
        How the drive torque enters by the case.
    pilots : mapping of str to LinkLoads
        Load case -> the samples that the modes were made for; the first is the nominal one.
    layers : Layers or None
    """

    body: Body
    material: Material
    units: LinkTractions
    solved: UnitSolutions
    variants: Mapping[str, tuple[Variant, ...]]
    stated: Transfer
    pilots: Mapping[str, LinkLoads]
    layers: Layers | None = None

    @cached_property
    def _splines(self) -> dict[tuple[str, float], Any]:
        return {}

    @cached_property
    def _fields(self) -> dict[str, _Field]:
        stress = self.solved.stress
        if self.material.brittle:
            own = _Field(components=stress, measure=lambda s: extreme_principal(s.swapaxes(1, 2))[0])
        else:
            own = _Field(components=deviator(stress), measure=_length)
        found = {"stress": own}
        if self.layers is not None:
            layers = self.layers
            found["layers"] = _Field(components=stress, measure=lambda s: layers.stress(s.swapaxes(1, 2)))
        return found

    @cached_property
    def _displacement(self) -> _Field:
        line = LineReference(self.solved.space, reference_surfaces(self.body))
        modes = self.solved.displacement.T
        fields = np.stack([line.relative(mode.reshape(-1, 3)) for mode in modes], axis=-1)
        return _Field(components=fields, measure=_length)

    def _field(self, which: str) -> _Field:
        return self._displacement if which == "displacement" else self._fields[which]

    @cached_property
    def _hot(self) -> dict[tuple[str, str], NDArray[np.int64]]:
        return {}

    def combination(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """Return the combination of the modes under loads.

        Parameters
        ----------
        loads : LinkLoads
            Of n samples.
        law : PressureLaw
        transfer : Transfer or None

        Returns
        -------
        ndarray, shape (modes, n)
        """
        found = np.zeros((len(self.solved.projection), loads.poses))
        for load, numbers in zip(self.units.loads, self.units.numbers, strict=True):
            projection = self.solved.projection[:, numbers]
            if isinstance(load, PinPressure) and not load.tilts:
                wrench = load.wrench(loads)
                size = np.hypot(wrench[:, 0], wrench[:, 1])
                found += projection[:, load.local :] @ load.tractions(wrench)
                if size.any():
                    found += size * self._pressed(load, projection, law, np.arctan2(wrench[:, 1], wrench[:, 0]))
            else:
                found += projection @ load.coefficients(loads, law, transfer)
        return found

    def _pressed(self, load: PinPressure, projection: Real, law: PressureLaw, direction: Real) -> Real:
        """Modes (m, n) of the pressure of unit forces, without the tractions that deliver them."""
        from scipy.interpolate import CubicSpline

        if (load.name, law.span) not in self._splines:
            first, last = self._range(load.name)
            angles = np.linspace(first, last, max(8, math.ceil((last - first) / _STEP) + 1))
            forces = np.column_stack([np.cos(angles), np.sin(angles), np.zeros((len(angles), 4))])
            fields = projection[:, : load.local] @ load.pressure(forces, law)
            self._splines[load.name, law.span] = first, CubicSpline(angles, fields, axis=1)
        first, spline = self._splines[load.name, law.span]
        return np.asarray(spline(first + np.remainder(direction - first, 2.0 * math.pi)))

    def _range(self, name: str) -> tuple[float, float]:
        """Directions of a pin's force in the pilots with twice as much to either side, at most a whole turn."""
        forces = np.vstack([p.wrench[:, :2] for loads in self.pilots.values() for p in loads.pins if p.name == name])
        forces = forces[np.hypot(forces[:, 0], forces[:, 1]) > 0.0]
        angles = np.arctan2(forces[:, 1], forces[:, 0])
        middle = math.atan2(np.sin(angles).sum(), np.cos(angles).sum())
        off = np.remainder(angles - middle + math.pi, 2.0 * math.pi) - math.pi
        reach = 3.0 * float(np.abs(off).max()) + 2.0 * _STEP
        if reach >= math.pi / 2.0:
            return -math.pi, math.pi + _STEP
        return middle - reach, middle + reach

    def shares(self, which: str, loads: LinkLoads) -> PeakShares | None:
        """Return the peaks of samples over the nominal one.

        Parameters
        ----------
        which : {"stress", "layers", "displacement"}
            The stress that the strength is set against, that on the layers, or the largest displacement from the line
            through the pins.
        loads : LinkLoads
            Of n samples.

        Returns
        -------
        PeakShares or None
            None where nothing acts in the nominal pose.
        """
        peaks, nominal = self.peaks(which, loads), self._nominal(which, loads.name)
        if min(nominal.values()) <= 0.0:
            return None
        each = {variant: peaks[variant] / nominal[variant] for variant in peaks}
        own = [variant for variant in peaks if variant[1] in (None, self.stated)]
        every = np.array(list(each.values()))
        return PeakShares(
            value=np.max([peaks[variant] for variant in own], axis=0) / max(nominal[variant] for variant in own),
            low=every.min(axis=0),
            high=every.max(axis=0),
        )

    def _nominal(self, which: str, load_case: str) -> dict[Variant, float]:
        first = self.pilots[load_case].chosen(slice(0, 1))
        return {variant: float(peak[0]) for variant, peak in self.peaks(which, first).items()}

    def peaks(self, which: str, loads: LinkLoads) -> dict[Variant, Real]:
        """Return the largest of a field under samples, for every variant.

        Parameters
        ----------
        which, loads
            As for ``shares``.

        Returns
        -------
        dict of Variant to ndarray, shape (n,)
            [MPa or mm]
        """
        field, found = self._field(which), {}
        for law, transfer in self.variants[loads.name]:
            key = (which, f"{loads.name}/{law.span}/{transfer}")
            if key not in self._hot:
                self._hot[key] = field.hot(self.combination(self.pilots[loads.name], law, transfer))
            found[law, transfer] = field.peak(self._hot[key], self.combination(loads, law, transfer))
        return found

    def work(self, virtual: LinkLoads, loads: LinkLoads) -> Real:
        """Return the work of virtual loads on the displacements under loads, which both balance.

        Virtual pins move with the mean of their bores, so that their tractions stand for them.

        Parameters
        ----------
        virtual, loads : LinkLoads
            Of n samples each.

        Returns
        -------
        ndarray, shape (n,)
            [N mm]

        Raises
        ------
        CannotRunError
            For a virtual torque about a pin where no load turns the link.
        """
        law, transfer = self.variants[loads.name][0]
        turned = [(pin.name, pin.torque) for pin in virtual.pins if not pin.slotted]
        turned += [(couple.pin, couple.torque) for couple in virtual.couples]
        known = {load.place for load in self.units.loads if isinstance(load, Torque)}
        if any(np.any(torque) and name not in known for name, torque in turned):
            raise CannotRunError(f"no load turns link '{virtual.link}' as the displacement wanted of it would take")
        mean = np.zeros((self.units.count, virtual.poses))
        for load, numbers in zip(self.units.loads, self.units.numbers, strict=True):
            if isinstance(load, PinPressure):
                mean[numbers.start + load.local : numbers.stop] = load.tractions(load.wrench(virtual))
            else:
                mean[numbers] = load.coefficients(virtual, law, transfer)
        return np.asarray(np.einsum("un,un->n", mean, self._compliance @ self.combination(loads, law, transfer)))

    @cached_property
    def _compliance(self) -> Real:
        return np.asarray(self.units.vectors.T @ self.solved.displacement)


def link_response(
    body: Body,
    material: Material,
    solution: SolidSolution,
    pilots: Sequence[LinkLoads],
    *,
    stated: Transfer,
    layers: Layers | None = None,
    threads: int | None = None,
) -> LinkResponse:
    """Solve the modes of a link on the finest mesh of its nominal solid.

    Parameters
    ----------
    body : Body
    material : Material
    solution : SolidSolution
        Of its nominal solid.
    pilots : sequence of LinkLoads
        Of each load case some samples, the nominal one first.
    stated : Transfer
        How the drive torque enters by the case.
    layers : Layers, optional
    threads : int, optional

    Returns
    -------
    LinkResponse
    """
    space = solution.space
    units = LinkTractions.of(space, pilots, density=material.density)
    size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))
    variants: dict[str, tuple[Variant, ...]] = {}
    columns, scales = [], []
    for loads in pilots:
        transfers = units.transfers(loads.chosen(slice(0, 1)))
        variants[loads.name] = tuple((law, transfer) for law in (WIDE, NARROW) for transfer in transfers)
        scale = loads.size(size)
        for law, transfer in variants[loads.name]:
            columns.append(units.coefficients(loads, law, transfer))
            scales.append(np.where(scale > 0.0, scale, max(float(scale.max()), 1e-300)))
    solved = solve_units(
        units,
        np.hstack(columns),
        np.concatenate(scales),
        E=material.youngs_modulus,
        nu=material.poissons_ratio,
        threads=threads,
    )
    return LinkResponse(
        body=body,
        material=material,
        units=units,
        solved=solved,
        variants=variants,
        stated=stated,
        pilots={loads.name: loads for loads in pilots},
        layers=layers,
    )
