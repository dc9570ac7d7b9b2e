"""A plastic body under loads that grow in proportion, up to the load that it bears.

The path is led by the work-conjugate displacement: with f the load at factor 1, each state has a given f·u, and the
load factor λ is what its equilibrium asks for. Under a given f·u a state is the least of the convex energy of the
yield law (``alula.fea.plastic.yield_law``), subject to one linear condition, so that it exists at and beyond the load
where the body would flow without end, and Newton's method with a line search finds it from anywhere; λ is the
condition's multiplier. f·u grows along every path of proportional load, since f·Δu is the work of a flowing body.

f·u doubles from state to state. While it does, what is left of a rise that goes like 1/(f·u) is the last increase of λ,
and of a faster one, such as that of beams, 1/(f·u)², less: the path ends where that increase is small.
"""

import math
import time
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.plastic.pin_contact import Bordered, PinContact
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.plastic.yield_law import Past, PointResponse
from alula.fea.solvers.solve import Factor, available_methods, factorise
from alula.geometry.base.errors import CannotRunError

Real = NDArray[np.float64]

RATIO = 2.0
"""By which f·u grows from state to state."""
FLAT = 0.01
"""Increase of λ, relative, in a state with ``RATIO`` times the f·u, at which the limit is reached; the band holds as
much."""
TOLERANCE = 1e-4
"""Forces that are out of balance, over the load's; the error of λ goes with their square."""
ITERATIONS = 40
"""At most, in one state."""
STATES = 20
"""At most: f·u has then grown a million times."""
STIFFENED = 1e-6
"""Share of the elastic stiffness that is added to the tangent, which is singular in a mechanism. The mechanism itself
is led by f·u; all else converges by this factor in each iteration at worst."""
SMALLER = 0.1
"""Slope of the energy along a step, over that at its start, at which the line search leaves it."""
SEARCHES = 8
"""At most, in one line search; the convex energy has one least value on it."""
CLOSER = 6
"""States at most that are sought about the material's largest strain."""
UNLOADED = 0.99
"""Equivalent stress over the yield stress below which a point that has flowed counts as unloaded."""


class NoPlasticStateError(CannotRunError):
    """A state of the path was not found."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticState:
    """A body in equilibrium.

    Attributes
    ----------
    factor : float
        λ, on the loads.
    control : float
        f·u over that of the elastic body at λ = 1.
    displacement : ndarray, shape (3n,) or (3n + 2p,)
        Of the body, and of its pins where they are in contact [mm].
    response : PointResponse
        Of the points.
    residuals : tuple of float
        Forces out of balance over the load's, before each iteration and after the last.
    """

    factor: float
    control: float
    displacement: Real
    response: PointResponse
    residuals: tuple[float, ...] = ()

    @property
    def plastic_strain(self) -> float:
        """Largest equivalent plastic strain of a point."""
        return float(self.response.past.equivalent.max())


class ProportionalLoad:
    """A body, what holds it, and a load that grows in proportion.

    Parameters
    ----------
    body : PlasticBody
    load : ndarray, shape (3n,)
        At factor 1 [N]; what acts on fixed unknowns is borne by them.
    fixed : ndarray of int
        Unknowns that stay.
    threads : int or None, optional
        Upper bound on the threads of the solver.
    until : float, optional
        Time by ``time.perf_counter`` after which no iteration is begun.
    contact : PinContact, optional
        Of pins whose forces grow with the load; their displacements (2p,) follow those of the body in all states.

    Attributes
    ----------
    solves : int
        Linear systems that were factorised so far.
    """

    def __init__(
        self,
        body: PlasticBody,
        load: Real,
        fixed: NDArray[np.int64],
        *,
        threads: int | None = None,
        until: float = np.inf,
        contact: PinContact | None = None,
    ) -> None:
        self.body, self.threads, self.until, self.solves, self.contact = body, threads, until, 0, contact
        of_pins = np.zeros(0) if contact is None else contact.forces.ravel()
        self.free = np.ones(body.space.unknowns + len(of_pins), dtype=np.bool_)
        self.free[fixed] = False
        self.fixed, self.load = fixed, np.where(self.free, np.concatenate([load, of_pins]), 0.0)
        self.size = float(np.linalg.norm(self.load))
        if self.size == 0.0:
            raise CannotRunError("no load acts on the body, so that none can grow")
        law = body.law
        self._elastic = np.broadcast_to(law.stiffness, (body.points, 6, 6))
        self.unit = self._elastic_unit()
        self.work = float(self.load @ self.unit)
        stress = body.strain(self.of_body(self.unit)) @ law.stiffness
        self.first_yield = 1.0 / float(law.share(stress).max())

    def of_body(self, u: Real) -> Real:
        """Return the displacements of the body alone.

        Parameters
        ----------
        u : ndarray
            Of a state [mm].

        Returns
        -------
        ndarray, shape (3n,)
        """
        return u[: self.body.space.unknowns]

    def _overlap(self, u: Real) -> Real:
        assert self.contact is not None
        return self.contact.overlap(self.of_body(u), u[self.body.space.unknowns :])

    def _forces(self, u: Real, stress: Real) -> Real:
        """Return the internal forces on all unknowns, of contact too."""
        inner = self.body.forces(stress)
        if self.contact is not None:
            wall, pins = self.contact.resist(self.of_body(u), u[self.body.space.unknowns :])
            inner = np.concatenate([inner + wall, pins])
        return np.where(self.free, inner, 0.0)

    def _solved(self, tangent: Real, closed: NDArray[np.bool_] | None, rhs: Real) -> Real:
        """Return the solution with a tangent and the walls in contact; a pin that touches nowhere has none."""
        try:
            return self._factor(tangent, closed).solve(rhs)
        except np.linalg.LinAlgError as error:
            raise NoPlasticStateError("a pin is not held by the walls that it touches") from error

    def _factor(self, tangent: Real, closed: NDArray[np.bool_] | None) -> Factor | Bordered:
        if time.perf_counter() > self.until:
            raise NoPlasticStateError("the time limit ended the path")
        self.solves += 1
        K = self.body.stiffness(tangent)
        if self.contact is None or closed is None:
            K.fix(self.fixed)
            return factorise(K, method=available_methods()[0], threads=self.threads)
        coupled, own = self.contact.stiffen(K, closed, self.free[: self.body.space.unknowns])
        K.fix(self.fixed)
        factor = factorise(K, method=available_methods()[0], threads=self.threads)
        return Bordered(factor=factor, coupled=coupled, own=own)

    def _elastic_unit(self) -> Real:
        """Return the elastic displacements at factor 1; those in contact go with the load, since pins fit."""
        if self.contact is None:
            return self._solved(self._elastic, None, self.load)
        closed = (self.contact.forces[self.contact.pins] * self.contact.normals[:, :2]).sum(axis=1) > 0.0
        for _ in range(ITERATIONS):
            unit = self._solved(self._elastic, closed, self.load)
            before, closed = closed, self._overlap(unit) > 0.0
            if np.array_equal(before, closed):
                return unit
        raise NoPlasticStateError(f"no elastic contact of pins was found in {ITERATIONS} iterations")

    def elastic(self, factor: float) -> PlasticState:
        """Return the state under a load at which no point has yielded before.

        Parameters
        ----------
        factor : float
            λ, at most ``first_yield``.

        Returns
        -------
        PlasticState
        """
        u = factor * self.unit
        response = self.body.respond(self.of_body(u), Past.none(self.body.points), tangent=False)
        return PlasticState(factor=factor, control=factor, displacement=u, response=response)

    def _guess(self, before: PlasticState, last: PlasticState | None, control: float) -> Real:
        """Return the displacements of a state: on the line through the last two, or the elastic ones."""
        if last is None or last.control == before.control:
            return before.displacement + (control - before.control) * self.unit
        along = (before.displacement - last.displacement) / (before.control - last.control)
        return before.displacement + (control - before.control) * along

    def led(self, before: PlasticState, control: float, last: PlasticState | None = None) -> PlasticState:
        """Return the state with a given f·u.

        Parameters
        ----------
        before : PlasticState
            From which the points go on.
        control : float
            Its f·u over that of the elastic body at λ = 1.
        last : PlasticState, optional
            The one before ``before``, through which the guess goes.

        Returns
        -------
        PlasticState

        Raises
        ------
        NoPlasticStateError
            Where Newton's method does not find it in ``ITERATIONS``, or in time.
        """
        return self._newton(before, self._guess(before, last, control), None)

    def loaded(self, before: PlasticState, factor: float) -> PlasticState:
        """Return the state under a given load.

        Parameters
        ----------
        before : PlasticState
            From which the points go on.
        factor : float
            λ, below the limit.

        Returns
        -------
        PlasticState

        Raises
        ------
        NoPlasticStateError
            As ``led``.
        """
        return self._newton(before, before.displacement + (factor - before.factor) * self.unit, factor)

    def _newton(self, before: PlasticState, u: Real, factor: float | None) -> PlasticState:
        past, residuals, body = before.response.past, [], self.body
        stiff = STIFFENED * body.law.stiffness
        for _ in range(ITERATIONS):
            response = body.respond(self.of_body(u), past)
            inner = self._forces(u, response.stress)
            assert response.tangent is not None
            # The λ that leaves the least force out of balance tells whether a solution is needed at all.
            load = float(inner @ self.load) / self.size**2 if factor is None else factor
            scale = self.size * max(abs(load), self.first_yield)
            residuals.append(float(np.linalg.norm(inner - load * self.load)) / scale)
            if residuals[-1] <= TOLERANCE:
                return PlasticState(
                    factor=load,
                    control=float(self.load @ u) / self.work,
                    displacement=u,
                    response=response,
                    residuals=tuple(residuals),
                )
            closed = None if self.contact is None else self._overlap(u) > 0.0
            tangent = response.tangent + stiff
            if factor is None:
                a, b = self._solved(tangent, closed, np.column_stack([self.load, inner])).T
                load = float(self.load @ b) / float(self.load @ a)
                step = load * a - b  # f·step = 0: f·u stays
            else:
                step = self._solved(tangent, closed, factor * self.load - inner)
            u = u + self._length(u, step, load, past) * step
        raise NoPlasticStateError(f"no equilibrium was found in {ITERATIONS} iterations")

    def _length(self, u: Real, step: Real, load: float, past: Past) -> float:
        """Return how far to go along a step: to where the convex energy is about least on it."""

        def slope(t: float) -> float:
            there = u + t * step
            inner = self._forces(there, self.body.respond(self.of_body(there), past, tangent=False).stress)
            return float((inner - load * self.load) @ step)

        start = slope(0.0)
        if not start < 0.0:
            return 1.0  # at rounding; the residual tells
        low, high, at_low, at_high = 0.0, 1.0, start, slope(1.0)
        for _ in range(SEARCHES):
            if at_high <= SMALLER * abs(start):
                return high
            t = low + (high - low) * max(at_low / (at_low - at_high), 0.1)
            at = slope(t)
            if abs(at) <= SMALLER * abs(start):
                return t
            if at < 0.0:
                low, at_low = t, at
            else:
                high, at_high = t, at
        return low or high


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadPath:
    """A body on the way to the load that it bears.

    Attributes
    ----------
    states : tuple of PlasticState
        From first yield on.
    ended : {"limit", "strain"}
        By the load that it bears, or the largest strain of its material.
    factor : float
        λ that it bears: of the last state, or where the largest strain is reached.
    low, high : float
        Least and largest λ that it may be on this mesh.
    unloaded : float
        Largest share of the volume that has flowed in which stress fell again while the load grew.
    """

    states: tuple[PlasticState, ...]
    ended: Literal["limit", "strain"]
    factor: float
    low: float
    high: float
    unloaded: float

    @property
    def last(self) -> PlasticState:
        """The state at its end."""
        return self.states[-1]


def follow(load: ProportionalLoad, *, largest_strain: float = math.inf, like: LoadPath | None = None) -> LoadPath:
    """Follow a body to the load that it bears.

    Parameters
    ----------
    load : ProportionalLoad
    largest_strain : float, optional
        Plastic strain of a point at which the path ends.
    like : LoadPath, optional
        A path to the limit of the same body on another mesh, whose values of f·u are taken, so that both compare.

    Returns
    -------
    LoadPath

    Raises
    ------
    NoPlasticStateError
        Where a state was not found, or the load does not level off.
    """
    states = [load.elastic(load.first_yield)]
    unloaded, begin = 0.0, load.first_yield
    if like is not None:
        begin = like.states[0].control
        begin *= RATIO ** math.floor(math.log(load.first_yield / begin, RATIO))  # the next is beyond first yield
    while len(states) < STATES:
        before = states[-1]
        control = RATIO ** len(states) * begin
        state = load.led(before, control, states[-2] if len(states) > 1 else None)
        states.append(state)
        unloaded = max(unloaded, unloaded_share(load.body, before.response, state.response))
        rise = max(state.factor - before.factor, 0.0)
        if state.plastic_strain > largest_strain:
            below, above, part = _about(load, before, state, largest_strain)
            return LoadPath(
                states=tuple(states),
                ended="strain",
                factor=below.factor + part * (above.factor - below.factor),
                low=below.factor,
                high=max(above.factor, below.factor),
                unloaded=unloaded,
            )
        levels = rise <= FLAT * state.factor and not load.body.law.hardens_beyond(state.plastic_strain, FLAT)
        ends = levels if like is None else control >= 0.99 * like.last.control
        if ends:
            return LoadPath(
                states=tuple(states),
                ended="limit",
                factor=state.factor,
                low=state.factor,
                high=state.factor + rise / (RATIO - 1.0),
                unloaded=unloaded,
            )
    raise NoPlasticStateError(f"the load still rises after {STATES} states")


def _about(
    load: ProportionalLoad, before: PlasticState, after: PlasticState, strain: float
) -> tuple[PlasticState, PlasticState, float]:
    """Return the states below and above a plastic strain, close to one another in λ, and where between them it is."""
    below, above = before, after

    def part() -> float:
        return (strain - below.plastic_strain) / (above.plastic_strain - below.plastic_strain)

    for _ in range(CLOSER):
        if above.factor - below.factor <= FLAT * above.factor:
            break
        state = load.led(before, below.control + part() * (above.control - below.control))
        below, above = (below, state) if state.plastic_strain > strain else (state, above)
    return below, above, part()


def what_stays(load: ProportionalLoad, path: LoadPath, factor: float) -> tuple[float, PlasticState | None]:
    """Return the work of the load at factor 1 on what stays after a load, by elastic unloading.

    The path is followed to that load, and what the elastic body would give taken off: f·u - λ f·u_e. For loads on a
    link that balance it is free of how the link is held.

    Parameters
    ----------
    load : ProportionalLoad
    path : LoadPath
        Of the same.
    factor : float
        λ of the load that is taken away.

    Returns
    -------
    tuple of (float, PlasticState or None)
        Work [N mm]: zero up to first yield, infinite above what the path bears; and the state under the load, where
        one was sought.

    Raises
    ------
    NoPlasticStateError
        As ``ProportionalLoad.led``.
    """
    if factor <= path.states[0].factor:
        return 0.0, None
    if factor > path.low:
        return math.inf, None
    before = [state for state in path.states if state.factor <= factor][-1]
    state = load.loaded(before, factor)
    return load.work * max(state.control - factor, 0.0), state


def unloaded_share(body: PlasticBody, before: PointResponse, now: PointResponse) -> float:
    """Return the share of the volume that had flowed in which the stress is below the yield stress again.

    Parameters
    ----------
    body : PlasticBody
    before, now : PointResponse
        In two states, one after the other.

    Returns
    -------
    float
        0 where nothing had flowed.
    """
    flowed = before.past.equivalent > 0.0
    weights = body.weights.reshape(-1)
    stress = body.law.share(now.stress) * body.law.strength / body.law.yield_stress(now.past.equivalent)
    fell = flowed & (stress < UNLOADED)
    volume = float(weights[flowed].sum())
    return float(weights[fell].sum()) / volume if volume > 0.0 else 0.0
