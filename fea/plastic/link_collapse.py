"""The plastic collapse of a link under its loads, by two meshes.

A pin presses over 180°. While the wall flows, its pressure would spread as it bears best; by the static theorem any
pressure that it can have gives no more than the link bears. How much more a pin that fits would give, contact tells on
the coarser mesh (``alula.fea.plastic.pin_contact``): that is the upper end. It is for links that are their own image,
as their loads are, in which no pin tilts; for others, and where contact finds no state, the ratio of pressures over
180° and 90° is taken, an estimate.

Resultants decide what a link bears, and not the peaks of stress beside its pins, so that coarse meshes do: the finer
one is the first mesh of the elastic check. How far the factor is from that of ever finer meshes, Richardson's
extrapolation tells from the coarser one, with the order 1 of displacements that a mechanism cuts, and with the sizes
where it flows.
"""

import math
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.space import DisplacementSpace, UpperHalf, displacement_space, upper_half
from alula.fea.elements.supports import LineReference, half_supports, isostatic_supports
from alula.fea.plastic.load_path import (
    LoadPath,
    NoPlasticStateError,
    PlasticState,
    ProportionalLoad,
    follow,
    what_stays,
)
from alula.fea.plastic.pin_contact import PinContact
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.plastic.yield_law import YieldLaw
from alula.fea.refine.link_task import ElasticLink
from alula.fea.solid.solution import NO_PART
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.traction import TRANSFERS, Transfer
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.records.bearing import NARROW, WIDE

Real = NDArray[np.float64]

COARSER = 1.6
"""Edges of the coarser mesh over those of the finer one, where nothing bounds them."""
ORDER = 1.0
"""At which the factor converges: displacements have kinks in a mechanism, whatever the order of the elements."""
CAUTION = 1.25
"""On the difference that the order leaves, as Roache's for a grid convergence index."""
LEAST_RATIO = 1.1
"""Of the two meshes' mean sizes; below it least sizes made them alike, as of long tubes, and a finer one is made."""
FINER = 3
"""Times at most that such a finer mesh is made: edges are then a quarter as long. Until then six elements on a turn
bind them round thin walls."""
IDLE = 1e-9
"""Share of the largest force of a link's pins below which a pin does not press: rounding makes no plug of its hole."""
SAME = 1e-6
"""Relative difference of the f·u of two states below which it is the same: rounding."""
NOTHING = 1e-12
"""Plastic strain below which a point has not flowed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkCollapse:
    """At what factor on its loads a link collapses.

    Attributes
    ----------
    factor, low, high : float
        On the finer mesh, and from where to where it may be for the mesh, the path and the pins' pressure.
    mesh_error : float
        Share of the factor by which the mesh may miss it.
    pressure : float
        Factor by which pins may bear more that press otherwise.
    transfer : Transfer or None
        How the torque enters with which it is least.
    ended : {"limit", "strain"}
        By the load that it bears, or by the material's largest strain.
    unloaded : float
        Largest share of the yielded volume in which stress fell while the load grew.
    strain : float or None
        Largest plastic strain under the stated load; None where the link does not bear it, or it was not found.
    residual : float or None
        Largest displacement that stays after the stated load [mm]; None as ``strain``.
    nodes : ndarray, shape (n, 3)
        Of the finer mesh [mm].
    boundary : ndarray of int, shape (b, 6)
        Its faces.
    zone : ndarray, shape (n,)
        Plastic strain at the nodes, at the end of the path.
    shape : ndarray, shape (n, 3)
        Displacements of the nodes there, less the rigid motion [mm]; how far it flowed is where the path ends.
    plastic_share : float
        Of the volume that has flowed then.
    unknowns : int
        Of the finer mesh.
    solves : int
        Linear systems that were solved in all.
    stays : tuple of 3 float or None
        Work of the stated loads on the displacements that stay after them, its least and its largest [N mm]
        (``alula.fea.plastic.load_path.what_stays``); infinite where the link does not bear its loads, None where it
        was not asked for or a state was not found.
    regained : float
        Share of ``stays`` that flow takes back while the load goes.
    """

    factor: float
    low: float
    high: float
    mesh_error: float
    pressure: float
    transfer: Transfer | None
    ended: str
    unloaded: float
    strain: float | None
    residual: float | None
    nodes: Real
    boundary: NDArray[np.int64]
    zone: Real
    shape: Real
    plastic_share: float
    unknowns: int
    solves: int
    stays: tuple[float, float, float] | None = None
    regained: float = 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class _Held:
    """A load on a body, or on the upper half of one that is its own image, as the load is."""

    problem: ProportionalLoad
    half: UpperHalf | None

    @classmethod
    def of(
        cls,
        space: DisplacementSpace,
        law: YieldLaw,
        load: Real,
        threads: int | None,
        until: float,
        contact: PinContact | None = None,
    ) -> "_Held":
        half = upper_half(space)
        if half is not None:
            same, other = half.parts(load.reshape(-1, 3, 1))
            if contact is not None or np.abs(other).sum() < NO_PART * np.abs(same).sum():
                part = same[..., 0].copy()
                part[half.on_plane] /= 2.0
                plane = 3 * np.flatnonzero(half.on_plane) + 2
                fixed = np.concatenate([plane, half_supports(half.space.nodes, half.space.corners)[0]])
                body = PlasticBody.of(half.space, law)
                touch = None if contact is None else contact.upper(half)
                found = ProportionalLoad(body, part.ravel(), fixed, threads=threads, until=until, contact=touch)
                return cls(problem=found, half=half)
        fixed, body = isostatic_supports(space.nodes, space.corners), PlasticBody.of(space, law)
        return cls(problem=ProportionalLoad(body, load, fixed, threads=threads, until=until), half=None)

    @property
    def work(self) -> float:
        """Work of the load on the elastic displacements of the whole at factor 1 [N mm]."""
        return self.problem.work * (1.0 if self.half is None else 2.0)

    def stays(self, path: LoadPath, factor: float) -> tuple[float, PlasticState | None]:
        """Return the work of the load on what stays of the whole, as ``what_stays``."""
        work, state = what_stays(self.problem, path, factor)
        return work / self.problem.work * self.work, state

    def factor_at(self, path: LoadPath, control: float) -> float:
        """Return the load at a given f·u, in a state of a path or between two of them."""
        if control <= path.states[0].control:
            return control
        before = [state for state in path.states if state.control <= (1.0 + SAME) * control][-1]
        return before.factor if before.control >= (1.0 - SAME) * control else self.problem.led(before, control).factor

    def displacement(self, state: PlasticState) -> Real:
        """Return the displacements (n, 3) of the whole."""
        u = self.problem.of_body(state.displacement).reshape(-1, 3)
        return u if self.half is None else self.half.whole(u[..., None], np.zeros_like(u[..., None]))[..., 0]

    def at_nodes(self, values: Real) -> Real:
        """Return the largest value of the points of all elements at each node (n,) of the whole."""
        space = self.problem.body.space
        found = np.zeros(len(space.nodes))
        each = values.reshape(len(space.cells), -1).max(axis=1)
        np.maximum.at(found, space.cells, np.broadcast_to(each[:, None], space.cells.shape))
        return found if self.half is None else self.half.both_nodes(found)


def collapse_of(
    link: ElasticLink,
    law: YieldLaw,
    loads: LinkLoads,
    mesh: Callable[[float], TaggedMesh],
    *,
    largest_strain: float = math.inf,
    transfers: Sequence[Transfer] = TRANSFERS,
    factors: tuple[float, float] | None = None,
    threads: int | None = None,
    until: float = math.inf,
) -> LinkCollapse:
    """Return the factor on its loads at which a link collapses.

    Parameters
    ----------
    link : ElasticLink
    law : YieldLaw
    loads : LinkLoads
        Of one pose.
    mesh : callable
        Returns a mesh of the link with edges that many times as long: 1 for the finer one.
    largest_strain : float, optional
        Of the material.
    transfers : sequence of Transfer, optional
        Of a torque, where the link carries one.
    factors : tuple of 2 float, optional
        Least and largest factor on its loads for which is wanted what stays after them; it is not sought when left out.
    threads : int or None, optional
        Upper bound on the threads of the solver.
    until : float, optional
        Time by ``time.perf_counter`` after which nothing is begun.

    Returns
    -------
    LinkCollapse

    Raises
    ------
    CannotRunError
        Where meshing or the path fails, or time ends.
    """

    def space_of(coarser: float) -> DisplacementSpace:
        if time.perf_counter() > until:
            raise NoPlasticStateError("the time limit ended the path")
        return displacement_space(mesh(coarser))

    pose = loads.chosen(None)

    def tractions_of(space: DisplacementSpace) -> LinkTractions:
        return LinkTractions.of(space, [pose], density=link.density)

    def path(
        space: DisplacementSpace, load: Real, like: LoadPath | None = None, contact: PinContact | None = None
    ) -> tuple[_Held, LoadPath]:
        held = _Held.of(space, law, load, threads, until, contact)
        return held, follow(held.problem, largest_strain=largest_strain, like=like)

    fine, coarse = _two_meshes(space_of)
    each = tractions_of(fine).variants(pose, (WIDE,), transfers)
    found = [(variant, *path(fine, variant.load)) for variant in each]
    variant, held, worst = min(found, key=lambda one: one[2].factor)
    like = worst if worst.ended == "limit" else None
    tractions = tractions_of(coarse)
    way = (variant.transfer,) if variant.transfer is not None else transfers
    load, narrow = (one.load for one in tractions.variants(pose, (WIDE, NARROW), way))
    wide = path(coarse, load, like)
    ratio = _ratio_in_flow(held.problem.body, worst.last, wide[0].problem.body)
    error = CAUTION * abs(wide[1].factor / worst.factor - 1.0) / (ratio**ORDER - 1.0)
    pressing = _pressing(tractions, pose)
    spread = math.nan
    if pressing and wide[0].half is not None:
        bores = [(one.wall.bore, replace(one.wall.pin, wrench=one.wrench(pose))) for one in pressing]
        rest = load - sum(one.exact(pose, WIDE, None)[:, 0] for one in pressing)
        with suppress(NoPlasticStateError):
            other = path(coarse, rest, contact=PinContact.of(bores, len(coarse.nodes), law.E))
            spread = max(other[1].high / wide[1].factor, 1.0)
    if math.isnan(spread):
        other = path(coarse, narrow, like)
        spread = max(wide[1].factor / other[1].factor, 1.0)
    reference = LineReference(fine, link.line)
    strain, residual = _under_the_load(held, worst, reference)
    stays, regained = None, 0.0
    if factors is not None:
        steps = ratio**ORDER - 1.0
        stiff = CAUTION * abs(wide[0].work / held.work - 1.0) / steps
        with suppress(NoPlasticStateError):
            errors = _errors(worst, *wide, steps)
            stays, regained = _stays([one[1:] for one in found], factors, errors, spread, stiff)
    flowed = worst.last.response.past.equivalent
    weights = held.problem.body.weights.reshape(-1)
    return LinkCollapse(
        factor=worst.factor,
        low=min(one[2].low for one in found) * max(1.0 - error, 0.0),
        high=max(one[2].high for one in found) * (1.0 + error) * spread,
        mesh_error=error,
        pressure=spread,
        transfer=variant.transfer,
        ended=worst.ended,
        unloaded=max(one[2].unloaded for one in found),
        strain=strain,
        residual=residual,
        nodes=fine.nodes,
        boundary=fine.boundary,
        zone=held.at_nodes(flowed),
        shape=reference.relative(held.displacement(worst.last)),
        plastic_share=float(weights[flowed > NOTHING].sum() / weights.sum()),
        unknowns=fine.unknowns,
        solves=sum(one.problem.solves for one in (held, wide[0], other[0])),
        stays=stays,
        regained=regained,
    )


def _stays(
    found: Sequence[tuple[_Held, LoadPath]],
    factors: tuple[float, float],
    errors: Sequence[tuple[float, float]],
    spread: float,
    stiff: float,
) -> tuple[tuple[float, float, float], float]:
    """Return the work of the loads on what stays, as ``LinkCollapse.stays``, and the share that flow takes back.

    Mesh and pins change the load that brings the body to a state, so that each end is read at a load of its own:
    ``errors`` are those of the load in the states of a path, each with its load, and never fall. ``stiff`` is the share
    of the elastic displacements by which the mesh may miss them.
    """
    least = factors[0] / (1.0 + next((error for load, error in errors if load >= factors[0]), errors[-1][1])) / spread
    kept = [factors[1] / (1.0 - error) for load, error in errors if load * (1.0 - error) >= factors[1]]
    each, back = [], 0.0
    for held, path in found:
        value, loaded = held.stays(path, 1.0)
        low = math.inf if least > path.high else held.stays(path, min(least, path.low))[0]
        high = held.stays(path, kept[0])[0] if kept else math.inf
        each.append((value, low / (1.0 + stiff), high * (1.0 + stiff)))
        if loaded is not None and value > 0.0:
            left = held.problem.loaded(loaded, 0.0).control * held.work
            back = max(back, 1.0 - left / value)
    value, low, high = (of(ends) for of, ends in zip((max, min, max), zip(*each, strict=True), strict=True))
    return (value, low * (1.0 - back), high), back


def _errors(path: LoadPath, coarse: _Held, other: LoadPath, steps: float) -> list[tuple[float, float]]:
    """Return the load of each state of a path, and the share of it by which the mesh may miss it there at most.

    ``steps`` is what Richardson's extrapolation divides the difference to the coarser mesh by.
    """
    loads = [state.factor for state in path.states]
    misses = [abs(coarse.factor_at(other, state.control) / state.factor - 1.0) for state in path.states]
    return list(zip(loads, np.maximum.accumulate(CAUTION * np.array(misses) / steps).tolist(), strict=True))


def _pressing(tractions: LinkTractions, pose: LinkLoads) -> list[PinPressure]:
    """Return the pins that press on their holes, but for those whose force is rounding."""
    found = [one for one in tractions.loads if isinstance(one, PinPressure)]
    forces = [float(np.linalg.norm(one.wrench(pose)[0, :2])) for one in found]
    return [one for one, force in zip(found, forces, strict=True) if force > IDLE * max(forces)]


def _two_meshes(space_of: Callable[[float], DisplacementSpace]) -> tuple[DisplacementSpace, DisplacementSpace]:
    """Return a finer and a coarser mesh; raises ``CannotRunError`` where all are alike."""
    fine, coarse = space_of(1.0), space_of(COARSER)
    for power in range(1, FINER + 1):
        if _ratio(fine, coarse) >= LEAST_RATIO:
            break
        fine, coarse = space_of(COARSER**-power), fine
    if _ratio(fine, coarse) < LEAST_RATIO:
        raise CannotRunError(
            "meshes of the link are alike whatever size is asked for, so that their error is not known; halve "
            "solid.mesh_size"
        )
    return fine, coarse


def _ratio(fine: DisplacementSpace, coarse: DisplacementSpace) -> float:
    """Return how many times as long the edges of a mesh are on average."""
    return float((len(fine.cells) / len(coarse.cells)) ** (1.0 / 3.0))


def _ratio_in_flow(fine: PlasticBody, state: PlasticState, coarse: PlasticBody) -> float:
    """Return how many times as long edges are where the finer mesh flows, each place by its plastic strain and volume.

    Shanks that bear more, and have the same elements in both meshes, say nothing of the error. It is as long as was
    asked for at most, and ``LEAST_RATIO`` at least.
    """
    from scipy.spatial import cKDTree

    work = (fine.weights.reshape(-1) * state.response.past.equivalent).reshape(len(fine.space.cells), -1).sum(axis=1)
    (own, at), (other, centres) = map(_sizes, (fine, coarse))
    flows = work > 0.0
    there = other[cKDTree(centres).query(at[flows])[1]]
    return float(np.clip((work[flows] @ there) / (work @ own), LEAST_RATIO, COARSER))


def _sizes(body: PlasticBody) -> tuple[Real, Real]:
    """Return how long the edges of elements are (n,) but for a factor, and their middles (n, 3) [mm]."""
    cells = body.space.cells
    return body.weights.reshape(len(cells), -1).sum(axis=1) ** (1.0 / 3.0), body.space.nodes[cells[:, :4]].mean(axis=1)


def _under_the_load(held: _Held, path: LoadPath, reference: LineReference) -> tuple[float | None, float | None]:
    """Return the largest plastic strain under the stated load, and the largest displacement that stays after it."""
    if path.states[0].factor >= 1.0:
        return 0.0, 0.0
    if path.low <= 1.0:
        return None, None
    before = [state for state in path.states if state.factor <= 1.0][-1]
    try:
        loaded = held.problem.loaded(before, 1.0)
        stays = held.problem.loaded(loaded, 0.0)
    except NoPlasticStateError:
        return None, None
    moved = reference.relative(held.displacement(stays))
    return loaded.plastic_strain, float(np.linalg.norm(moved, axis=1).max())
