"""What samples of loads do to one link on its nominal solid: peaks by unit solutions, as shares of the nominal ones.

Loads are sums of unit loads (``alula.fea.tractions.link_tractions``), so stress and displacement of every sample are
sums of a few modes. A pin's pressure follows from its direction by a spline through the modes' combinations at some
directions. The peak is sought among nodes that come near to it in one of the pilots: some samples, among them corners,
that are evaluated at all nodes.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.refine.link_series import PeakQuantity
from alula.fea.refine.link_task import ElasticLink
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import SolidSolution
from alula.fea.superposition.link_measure import LinkMeasure, LoadVariant
from alula.fea.superposition.peaks import ModeMeasures
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.torque import Torque
from alula.fea.tractions.traction import Transfer
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import Body
from alula.geometry.materials.material import Material
from alula.loads.records.bearing import PressureLaw

Real = NDArray[np.float64]

NEAR = 0.03
"""Share of the peak by which a node may lie below it in every pilot and still bear it in no sample."""
_STEP = math.radians(1.0)
"""Between the directions of a pin's spline; the error of a cubic one is (16 step)⁴/384 of the 16th order's part."""


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
class LinkResponse:
    """A link's unit solutions, ready for any samples near to its pilots.

    Attributes
    ----------
    measure : LinkMeasure
        Of the pilots: for each load case samples that the modes were made for, the first the nominal one.
    stated : Transfer
        How the drive torque enters by the case.
    pilots : mapping of str to LinkLoads
        Load case -> these samples.
    """

    measure: LinkMeasure
    stated: Transfer
    pilots: Mapping[str, LinkLoads]

    @cached_property
    def _splines(self) -> dict[tuple[str, float], Any]:
        return {}

    @cached_property
    def _hot(self) -> dict[tuple[PeakQuantity, int], list[ModeMeasures]]:
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
        units, every = self.measure.units, self.measure.solved.projection
        found = np.zeros((len(every), loads.poses))
        for load, numbers in zip(units.loads, units.numbers, strict=True):
            projection = every[:, numbers]
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

    def shares(self, which: PeakQuantity, loads: LinkLoads) -> PeakShares | None:
        """Return the peaks of samples over the nominal one.

        Parameters
        ----------
        which : {"von_mises", "principal", "layers", "displacement"}
            As of ``LinkMeasure.measures``.
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
        own = [variant for variant in peaks if variant.transfer in (None, self.stated)]
        every = np.array(list(each.values()))
        return PeakShares(
            value=np.max([peaks[variant] for variant in own], axis=0) / max(nominal[variant] for variant in own),
            low=every.min(axis=0),
            high=every.max(axis=0),
        )

    def _nominal(self, which: PeakQuantity, load_case: str) -> dict[LoadVariant, float]:
        first = self.pilots[load_case].chosen(slice(0, 1))
        return {variant: float(peak[0]) for variant, peak in self.peaks(which, first).items()}

    def peaks(self, which: PeakQuantity, loads: LinkLoads) -> dict[LoadVariant, Real]:
        """Return the largest of a number under samples, for every variant.

        Parameters
        ----------
        which, loads
            As for ``shares``.

        Returns
        -------
        dict of LoadVariant to ndarray, shape (n,)
            [MPa or mm]
        """
        found = {}
        for variant in self._variants(loads.name):
            key = which, variant.loads.start
            if key not in self._hot:
                pilots = self.measure.solved.combination[:, variant.loads]
                self._hot[key] = [side.near(pilots, NEAR) for side in self.measure.measures(which)]
            here = self.combination(loads, variant.law, variant.transfer)
            found[variant] = np.max([side.most(here) for side in self._hot[key]], axis=0)
        return found

    def _variants(self, load_case: str) -> list[LoadVariant]:
        number = list(self.pilots).index(load_case)
        return [variant for variant in self.measure.variants if variant.record == number]

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
        units, variant = self.measure.units, self._variants(loads.name)[0]
        turned = [(pin.name, pin.torque) for pin in virtual.pins if not pin.slotted]
        turned += [(couple.pin, couple.torque) for couple in virtual.couples]
        known = {load.place for load in units.loads if isinstance(load, Torque)}
        if any(np.any(torque) and name not in known for name, torque in turned):
            raise CannotRunError(f"no load turns link '{virtual.link}' as the displacement wanted of it would take")
        mean = np.zeros((units.count, virtual.poses))
        for load, numbers in zip(units.loads, units.numbers, strict=True):
            if isinstance(load, PinPressure):
                mean[numbers.start + load.local : numbers.stop] = load.tractions(load.wrench(virtual))
            else:
                mean[numbers] = load.coefficients(virtual, variant.law, variant.transfer)
        return np.asarray(
            np.einsum("un,un->n", mean, self._compliance @ self.combination(loads, variant.law, variant.transfer))
        )

    @cached_property
    def _compliance(self) -> Real:
        return np.asarray(self.measure.units.vectors.T @ self.measure.solved.displacement)


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
    link = ElasticLink.of(body, material, layers)
    measure = LinkMeasure.of_units(link, solution.space, pilots, as_first=True, threads=threads)
    return LinkResponse(measure=measure, stated=stated, pilots={loads.name: loads for loads in pilots})
