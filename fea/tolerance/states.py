"""Pose and statics of n samples of a case at once."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.plates import plates
from alula.geometry.linkage.driven import DrivenClosure
from alula.geometry.linkage.pose import Pose
from alula.geometry.linkage.sampled import SampledPlacement, assemble_samples
from alula.loads.case.case import Case
from alula.loads.case.forks import apart
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.case.toleranced import Variable
from alula.loads.records.applied import AnyLoad, BodyForce, Load, PartMass, PointLoad, at_poses, chosen
from alula.loads.records.load_case import LoadCase
from alula.loads.states.actions import acting_on
from alula.loads.states.rubbing import WAYS, friction_at, is_of
from alula.loads.statics.friction import NOTHING_MORE, Presses
from alula.loads.statics.statics import Balance, balance

Real = NDArray[np.float64]

Reach = tuple[float, Mapping[str, PartMass], Mapping[str, PartMass]]
"""How far the ends of a size are from its nominal value [mm], and the masses of links at the low and the high end."""


@dataclass(frozen=True, kw_only=True, eq=False)
class States:
    """Samples that have an equilibrium.

    Attributes
    ----------
    apart : ndarray of bool, shape (N,)
        Samples that do not assemble on the nominal branch.
    short : ndarray, shape (N,)
        By how much the branch of such a sample ends at a dead point before the pose [rad, mm]; NaN where it does not.
    dead : ndarray of bool, shape (N,)
        Those at a dead point of the drive or locked by friction, where joint forces grow without limit.
    forces : mapping of str to Balance
        Load case -> joint forces of the n others.
    loads : mapping of str to tuple of Load
        Load case -> all that acts on their links.
    """

    apart: NDArray[np.bool_]
    short: Real
    dead: NDArray[np.bool_]
    forces: Mapping[str, Balance]
    loads: Mapping[str, tuple[Load, ...]]

    @property
    def good(self) -> NDArray[np.bool_]:
        """The samples (N,) that have an equilibrium."""
        return ~(self.apart | self.dead)


@dataclass(frozen=True, kw_only=True, eq=False)
class Sampler:
    """Solves samples of a case.

    Attributes
    ----------
    case : Case
    pose : Pose
        Nominal.
    masses : mapping of str to PartMass
        Nominal.
    variables : sequence of Variable
        The d columns of the samples.
    reaches : mapping of str to Reach
        Toleranced size -> its ends, between which masses of links are interpolated.
    presses : mapping of str to mapping of str to ndarray, shape (1,)
        Load case -> joint -> what presses on the wall of its bore over its force, in layers, without deviations.
    """

    case: Case
    pose: Pose
    masses: Mapping[str, PartMass]
    variables: Sequence[Variable]
    reaches: Mapping[str, Reach] = field(default_factory=dict)
    presses: Mapping[str, Presses] = field(default_factory=dict)

    def shifts(self, deviations: Real) -> dict[tuple[str, str], NDArray[np.complex128]]:
        """Return the shifts of points in their links' frames.

        Parameters
        ----------
        deviations : ndarray, shape (N, d)

        Returns
        -------
        dict of (str, str) to complex ndarray, shape (N,)
            [mm]
        """
        found: dict[tuple[str, str], Any] = {}
        for variable, column in zip(self.variables, deviations.T, strict=True):
            if variable.kind == "place":
                link, point, axis = variable.target
                at = str(link), str(point)
                found[at] = found.get(at, 0.0) + (1j if axis else 1.0) * column
        return found

    def factor(self, deviations: Real, *target: str) -> Real:
        """Return the factors on an entry of a material.

        Parameters
        ----------
        deviations : ndarray, shape (N, d)
        *target : str
            Material and entry.

        Returns
        -------
        ndarray, shape (N,)
        """
        return 1.0 + sum(
            (
                x
                for v, x in zip(self.variables, deviations.T, strict=True)
                if v.kind == "material" and v.target == target
            ),
            np.zeros(len(deviations)),
        )

    def states(self, deviations: Real) -> States:
        """Solve pose and statics of samples.

        Parameters
        ----------
        deviations : ndarray, shape (N, d)

        Returns
        -------
        States
        """
        angle = sum(
            (x for v, x in zip(self.variables, deviations.T, strict=True) if v.kind == "pose"),
            np.zeros(len(deviations)),
        )
        place, assembled, short = assemble_samples(self.pose, self.shifts(deviations), angle)
        here, own, drive = place.chosen(assembled), deviations[assembled], self.case.pinned_drive
        loads = {name: self._loads(name, load_case, here, own) for name, load_case in self.case.load_cases.items()}
        locked = np.zeros(here.shape, dtype=np.bool_)
        if rubbing_joints(self.case):
            assert self.pose.coordinate is not None
            driven = DrivenClosure(here.closure, self.pose.coordinate)
            for name, acting in loads.items():
                way, presses = WAYS[self.case.load_cases[name].direction], self.presses.get(name, NOTHING_MORE)
                friction, locks = friction_at(driven, here, drive, acting, way, presses)
                loads[name], locked = (*acting, *friction), locked | locks
        forces = {name: balance(here, drive, acting) for name, acting in loads.items()}
        good = ~locked & next(iter(forces.values())).sound
        if not good.all():
            loads = {n: tuple(chosen(at_poses(one, here.shape), good) for one in own) for n, own in loads.items()}
            forces = {name: balance(here.chosen(good), drive, acting) for name, acting in loads.items()}
        dead = assembled.copy()
        dead[assembled] = ~good
        return States(apart=~assembled, short=short, dead=dead, forces=forces, loads=loads)

    def _loads(self, name: str, load_case: LoadCase, place: SampledPlacement, deviations: Real) -> tuple[Load, ...]:
        if load_case.speed != 0.0:
            assert self.pose.coordinate is not None
            first, second = DrivenClosure(place.closure, self.pose.coordinate).coefficients(place.q)
            place = replace(place, qdot=load_case.speed * first, qddot=load_case.speed**2 * second)
        acting = acting_on(self.case, load_case, self.masses, inert=place.qddot is not None)
        found = [[at_poses(load, place.shape) for load in one.loads(place)] for one in acting]
        for variable, column in zip(self.variables, deviations.T, strict=True):
            if variable.kind in ("load", "force") and is_of(name, str(variable.target[0])):
                number = int(variable.target[1])
                every = [i for i, one in enumerate(acting) if not one.lasting]
                for i in every if number < 0 else (number,):
                    found[i] = [_changed(load, variable, column) for load in found[i]]
        loads = itertools.chain.from_iterable(found)
        return tuple(self._weighing(load, deviations) if isinstance(load, BodyForce) else load for load in loads)

    def _weighing(self, load: BodyForce, deviations: Real) -> Load:
        """Return weight and inertia of a link with the mass of each sample: by a parabola through three masses."""
        own, more = self.masses.get(load.link), np.zeros(len(deviations))
        if own is None or own is not load.mass:
            return load
        for variable, column in zip(self.variables, deviations.T, strict=True):
            if variable.tolerance in self.reaches:
                reach, *ends = self.reaches[variable.tolerance]
                low, high = (masses[load.link].mass / own.mass - 1.0 for masses in ends)
                t = column / reach
                more += 0.5 * t * (high - low) + 0.5 * t**2 * (high + low)
        return scaled(load, 1.0 + more) if more.any() else load

    def link_loads(self, states: States, deviations: Real, load_case: str, link: str) -> LinkLoads:
        """Return what acts on a link of each sample, or on one plate of it, moved to the places of its nominal body.

        A pin that is off its nominal place by δ presses there with its force F; about the nominal place this is F and
        the moment δ × F. So the loads balance on the nominal body as they do on the sample's.

        Parameters
        ----------
        states : States
        deviations : ndarray, shape (n, d)
            Of the samples that have an equilibrium.
        load_case, link : str

        Returns
        -------
        LinkLoads
        """
        forces, loads = states.forces[load_case], states.loads[load_case]
        found = link_loads(load_case, link, self.case.body(link), forces, loads)
        own = self.masses.get(link)
        if found.inertia is not None and own is not None and found.inertia.mass is not own:
            share = found.inertia.mass.mass / own.mass  # of another size: the same force on another mass
            spread = scaled(found.inertia, np.full(len(deviations), share))
            found = replace(found, inertia=replace(spread, mass=own))
        shifts = self.shifts(deviations)
        pins = tuple(
            p if p.slotted else replace(p, wrench=_moved(p.wrench, shifts.get((link, p.name)))) for p in found.pins
        )
        ends = tuple(replace(e, wrench=_moved(e.wrench, shifts.get((link, e.name)))) for e in found.ends)
        return plates(replace(found, pins=pins, ends=ends), apart(self.case, link))[0]


def _moved(wrench: Real, shift: Any) -> Real:
    if shift is None:
        return wrench
    found = wrench.copy()
    found[..., 5] += shift.real * wrench[..., 1] - shift.imag * wrench[..., 0]
    return found


def scaled(load: AnyLoad, factor: Real) -> AnyLoad:
    """Return loads times the factors of n samples.

    Parameters
    ----------
    load : PointLoad, LineLoad or BodyForce
        Of n samples.
    factor : ndarray, shape (n,)

    Returns
    -------
    PointLoad, LineLoad or BodyForce
    """
    found: Any = {}
    for name in {*load.VECTORS, *load.SCALARS} - {"arm"}:
        values = np.asarray(getattr(load, name))
        found[name] = values * factor.reshape(-1, *[1] * (values.ndim - 1))
    changed: AnyLoad = replace(load, **found)
    return changed


def _changed(load: Load, variable: Variable, column: Real) -> Load:
    """Return a load times 1 + its deviation, or with a component more."""
    if variable.kind == "load":
        return scaled(load, 1.0 + column)
    assert isinstance(load, PointLoad)
    wrench = load.wrench.copy()
    wrench[..., int(variable.target[2])] += column
    return replace(load, wrench=wrench)
