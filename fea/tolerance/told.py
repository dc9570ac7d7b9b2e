"""What samples say of a check whose solids are solved: its bands, times what each sample changes.

A sample changes the stress of a link by the share that its unit solutions give (``alula.fea.tolerance.link_response``),
the force on a pin and the compression of a link by statics, strength and modulus by their factors. So the bands keep
their relative width.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import place_of
from alula.fea.buckling.buckling import link_factors
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.judging.bearing import eyes_bear, in_own_eyes
from alula.fea.motion.buckling_history import axial_compression
from alula.fea.outcomes.limits import layers_of
from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.fea.refine.link_series import STRESS, PeakQuantity
from alula.fea.tolerance.link_response import LinkResponse, PeakShares, link_response
from alula.fea.tolerance.states import Sampler, States
from alula.geometry.base.errors import CannotRunError
from alula.geometry.materials.material import Material
from alula.loads.records.applied import PointLoad, at_poses
from alula.loads.records.check_spec import BearingCheck
from alula.loads.statics.statics import balance

Real = NDArray[np.float64]

_STEP = 1e-4
"""Share of the compression by which it is changed for derivatives."""
PEAKS: dict[Quantity, PeakQuantity] = {Quantity.LAYERS: "layers", Quantity.DEFLECTION: "displacement"}
"""What links are checked by, besides the stress that their strength is set against."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SolvedCheck:
    """A check with solids, and the unit solutions of its links.

    Attributes
    ----------
    result : CheckResult
        Of the links that ``responses`` are of, with solids.
    sampler : Sampler
        With the bodies and masses of that check.
    deviation : ndarray, shape (1, d)
        What that check deviates from the nominal one.
    nominal : States
        Its pose and statics, as samples have them.
    responses : mapping of str to LinkResponse
        Link -> its unit solutions.
    reference : SolvedCheck or None
        The nominal one; None for itself.
    """

    result: CheckResult
    sampler: Sampler
    deviation: Real
    nominal: States
    responses: Mapping[str, LinkResponse]
    reference: "SolvedCheck | None" = None

    @classmethod
    def of(
        cls,
        result: CheckResult,
        sampler: Sampler,
        pilots: Real,
        *,
        links: Collection[str],
        reference: "SolvedCheck | None" = None,
        threads: int,
    ) -> "SolvedCheck":
        """Solve what the samples need.

        Parameters
        ----------
        result : CheckResult
        sampler : Sampler
        pilots : ndarray, shape (k, d)
            Deviations, first that of the check itself; corners among them.
        links : collection of str
            That unit solutions are wanted of; those of others are the reference's.
        reference : SolvedCheck, optional
        threads : int

        Returns
        -------
        SolvedCheck

        Raises
        ------
        CannotRunError
            Where its pose has no equilibrium of its own.
        """
        case, found = result.case, dict(reference.responses if reference else {})
        weighed = reference.sampler if reference else sampler
        states, nominal = weighed.states(pilots), weighed.states(pilots[:1])
        if not nominal.good[0]:
            raise CannotRunError("tolerances: the nominal pose is at a dead point of the drive; change the pose")
        own = pilots[states.good]
        for link in links:
            solids = {name: r.links[link] for name, r in result.load_cases.items()}
            solved = {name: one for name, one in solids.items() if isinstance(one, SolidResult)}
            if solved:
                found[link] = link_response(
                    case.body(link),
                    case.material_of(link),
                    next(iter(solved.values())).solution,
                    [sampler.link_loads(states, own, name, link) for name in solved],
                    stated=case.torque_transfer,
                    layers=layers_of(case, link),
                    threads=threads,
                )
        return cls(
            result=result,
            sampler=sampler,
            deviation=pilots[:1],
            nominal=nominal,
            responses=found,
            reference=reference,
        )

    def column_weights(self, link: str, load_case: str) -> Real | None:
        """Return the derivatives of the nominal buckling factors' inverses, times these factors.

        Parameters
        ----------
        link, load_case : str

        Returns
        -------
        ndarray, shape (3, intervals, 3) or None
            Of value, least and most by the compression at start, middle and end of each interval [1/N]; None where the
            nominal pose does not compress the link.
        """
        case = self.result.case
        if (link, load_case) not in self._weights:
            own = self.sampler.link_loads(self.nominal, self.deviation, load_case, link)
            largest, force = axial_compression(case, link, own)
            weights = None
            if largest[0] > 0.0:
                step = _STEP * largest[0]
                moved = force.values + step * np.eye(force.values.size).reshape(*force.values.shape[:2], -1)
                values = np.concatenate([force.values, moved], axis=-1)
                found = link_factors(case, link, replace(force, values=values))
                inverse = 1.0 / np.array([found.value, found.least, found.most])
                usable = np.isfinite(inverse[:, :1]) & (inverse[:, :1] > 0.0)
                inverse = np.where(usable, inverse, inverse[0])  # unknown or endless: as the value
                slopes = (inverse[:, 1:] - inverse[:, :1]) / step / inverse[:, :1]
                weights = slopes.reshape(3, *force.values.shape[:2])
            self._weights[link, load_case] = weights
        return self._weights[link, load_case]

    @cached_property
    def _weights(self) -> dict[tuple[str, str], Real | None]:
        return {}


@dataclass(frozen=True, kw_only=True, eq=False)
class Told:
    """What a block of samples says of each outcome.

    Attributes
    ----------
    check : SolvedCheck
    states : States
    deviations : ndarray, shape (n, d)
        Of the samples that have an equilibrium.
    """

    check: SolvedCheck
    states: States
    deviations: Real

    def bands(self, outcome: CheckOutcome) -> Real:
        """Return value, low and high end of an outcome.

        Parameters
        ----------
        outcome : CheckOutcome
            Of the check.

        Returns
        -------
        ndarray, shape (3, n)
            NaN where the samples cannot be told of.
        """
        scale = self.scale(outcome)
        if scale is None:
            return np.full((3, len(self.deviations)), np.nan)
        band = outcome.value
        with np.errstate(invalid="ignore"):
            return np.array([band.value * scale.value, band.low * scale.low, band.high * scale.high])

    def scale(self, outcome: CheckOutcome) -> PeakShares | None:
        """Return the factors on the band of an outcome.

        Parameters
        ----------
        outcome : CheckOutcome
            Of the check.

        Returns
        -------
        PeakShares or None
            None where the samples cannot be told of.
        """
        case, name = self.check.result.case, outcome.subject.name
        if outcome.value.low == np.inf:
            return _same(np.ones(len(self.deviations)))  # nothing acts
        if outcome.subject.kind == "pin":
            return self._pin(outcome, name)
        if outcome.quantity is Quantity.DISPLACEMENT:
            return self._point(outcome)
        if outcome.quantity is Quantity.BUCKLING_FACTOR:
            return self._column(outcome.load_case, name)
        material, own = case.material_of(name), PEAKS.get(outcome.quantity)
        shares = self._shares(name, own or STRESS[material.brittle], outcome.load_case)
        if shares is None:
            return None
        if outcome.quantity is Quantity.DEFLECTION:
            return _times(shares, 1.0 / self._factor(name, "youngs_modulus"))
        if outcome.quantity is Quantity.SUSTAINED_STRESS:
            return shares
        entry = "strength_across_layers" if own == "layers" else _strength(material)
        inverse = PeakShares(value=1.0 / shares.value, low=1.0 / shares.high, high=1.0 / shares.low)
        return _times(inverse, self._factor(name, entry))

    def _shares(self, link: str, which: PeakQuantity, load_case: str) -> PeakShares | None:
        response = self.check.responses.get(link)
        if response is None or load_case not in response.pilots:
            return None
        with np.errstate(divide="ignore"):
            return response.shares(which, self._loads(link, load_case))

    @cached_property
    def _cut(self) -> dict[tuple[str, str], LinkLoads]:
        return {}

    def _loads(self, link: str, load_case: str) -> LinkLoads:
        if (link, load_case) not in self._cut:
            self._cut[link, load_case] = self.check.sampler.link_loads(self.states, self.deviations, load_case, link)
        return self._cut[link, load_case]

    def _factor(self, link: str, entry: str) -> Real:
        return self.check.sampler.factor(self.deviations, self.check.result.case.part_of(link).material, entry)

    def _pin(self, outcome: CheckOutcome, joint: str) -> PeakShares | None:
        case, sampler = self.check.result.case, self.check.sampler
        if isinstance(case.all_checks[outcome.name], BearingCheck):
            return self._eyes(outcome, joint)
        here, nominal = (
            np.linalg.norm(states.forces[outcome.load_case].joints[joint].wrench[:, :2], axis=1)
            for states in (self.states, self.check.nominal)
        )
        if nominal[0] == 0.0:
            return None
        strength = sampler.factor(self.deviations, case.joints[joint].pin_material, _strength(case.pin_material(joint)))
        with np.errstate(divide="ignore"):
            return _same(strength * nominal[0] / here)

    def _eyes(self, outcome: CheckOutcome, joint: str) -> PeakShares | None:
        """Factors on what the weaker eye of a joint bears, in which all joints of its pin press together."""
        case, found = self.check.result.case, list[Real]()
        nominal, here = (
            in_own_eyes(case, joint, states.forces[outcome.load_case].joints)
            for states in (self.check.nominal, self.states)
        )
        for link, (bears, _) in eyes_bear(case, outcome.name, joint).items():
            card = case.material_of(link)
            strength = self._factor(link, "ultimate_strength" if card.ultimate_strength else _strength(card))
            with np.errstate(divide="ignore"):
                found.append(bears * np.concatenate([[1.0], strength]) / _sizes(nominal[link], here[link]))
        first, *others = np.min(found, axis=0)
        return _same(np.array(others) / first) if np.isfinite(first) else None

    def _column(self, load_case: str, link: str) -> PeakShares | None:
        """Factors on the buckling factors: 1/factor is linear in the compression along the link, to first order."""
        weights = self.check.column_weights(link, load_case)
        if weights is None:
            return None
        _, force = axial_compression(self.check.result.case, link, self._loads(link, load_case))
        inverse = np.einsum("fik,ikn->fn", weights, force.values)
        shifts, body = self.check.sampler.shifts(self.deviations), self.check.result.case.body(link)
        first, last = body.pins[0], body.pins[-1]
        longer = shifts.get((link, last.name), np.zeros(1)).real - shifts.get((link, first.name), np.zeros(1)).real
        length = 1.0 + longer / (last.x - first.x) if last.x != first.x else np.ones(1)
        with np.errstate(divide="ignore"):
            scale = np.where(inverse > 0.0, 1.0 / inverse, np.inf) * self._factor(link, "youngs_modulus") / length**2
        return PeakShares(value=scale[0], low=scale.min(axis=0), high=scale.max(axis=0))

    def _compression(self, link: str, load_case: str) -> Real:
        return axial_compression(self.check.result.case, link, self._loads(link, load_case))[0]

    def pressed(self) -> frozenset[str]:
        """Return the links that a sample compresses although the nominal pose does not."""
        checks = [one for found in self.check.result.load_cases.values() for one in found.checks]
        told = {(o.load_case, o.subject.name) for o in checks if o.quantity is Quantity.BUCKLING_FACTOR}
        return frozenset(
            link
            for link, response in self.check.responses.items()
            for load_case in response.pilots
            if response.measure.link.body.part.is_beam
            and (load_case, link) not in told
            and self._compression(link, load_case).any()
        )

    def _point(self, outcome: CheckOutcome) -> PeakShares | None:
        case = self.check.result.case
        link, point = place_of(case, outcome.name)
        check = self.check.reference or self.check
        nominal = Told(check=check, states=check.nominal, deviations=check.deviation)._moved(
            outcome.load_case, link, point
        )
        if not nominal[0] > 0.0:
            return None
        return _same(self._moved(outcome.load_case, link, point) / nominal[0])

    def _moved(self, load_case: str, link: str, point: str) -> Real:
        """Displacement (n,) of a point by the work of unit loads there on the links' solids [mm]."""
        case, forces = self.check.result.case, self.states.forces[load_case]
        place, found = forces.place, []
        for unit in np.eye(6)[:2]:
            load = at_poses(PointLoad(link=link, point=point, wrench=unit), place.shape)
            virtual = balance(place, case.pinned_drive, (load,))
            states = replace(self.states, forces={load_case: virtual}, loads={load_case: (load,)})
            total = np.zeros(place.shape)
            for name, response in self.check.responses.items():
                if load_case in response.pilots:
                    own = self.check.sampler.link_loads(states, self.deviations, load_case, name)
                    work = response.work(own, self._loads(name, load_case))
                    total += case.links[name].count * work / self._factor(name, "youngs_modulus")
            found.append(total)
        return np.hypot(*found)


def _sizes(*wrenches: Real) -> Real:
    """Forces across the pin of wrenches (n, 6) one after the other."""
    return np.asarray(np.linalg.norm(np.concatenate(wrenches)[:, :2], axis=1))


def _same(factor: Real) -> PeakShares:
    return PeakShares(value=factor, low=factor, high=factor)


def _times(shares: PeakShares, factor: Real) -> PeakShares:
    return PeakShares(value=shares.value * factor, low=shares.low * factor, high=shares.high * factor)


def _strength(material: Material) -> str:
    return f"{material.strength}_strength"
