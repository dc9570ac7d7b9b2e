"""Newton's method along the equilibrium path of a frame in large displacement."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.model import FrameModel, Guide
from alula.fea.frame.spring import FrameSpring
from alula.fea.nonlinear.corotational_element import CorotationalElements, ElementResponse, guide_gap
from alula.fea.nonlinear.jet import Jet
from alula.fea.nonlinear.kinematic_chain import KinematicChain, Places, changes_of
from alula.fea.nonlinear.springs import SpringForces
from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]

_TOLERANCE = 1e-9
_MOST_ROUNDING = 1e-6
_ROUNDINGS = 128.0
"""Roundings of one element's force that add up where Newton's method stagnates: some 110 on a four-bar in layers."""
_LARGEST_TURN = 0.3
_DIVERGED = 100.0
_DENSE = 100
"""Unknowns up to which a dense factorisation is quicker than a sparse one, and has no threads."""
_ROUGH = 0.3
"""Share of a step's displacement by which the tangents at its ends may miss it: beyond that it left the path.

The mean of both tangents (trapezoidal rule) misses a step half-way to a limit point by 3 %, one of nine tenths of the
way by 37 %, and a step over a snap-through by more: a shallow toggle's by 41 % even where it lands on the line of the
first tangent.
"""
_RESOLUTION = 1.0 / 64.0
"""Step over the load that was reached, below which ``least_step`` gives way to it: a limit load far below the load."""
_BEND = 1.0 / 3.0
"""Share by which the rate of no unknown may change in a step.

A shallow toggle then starts with three quarters of its limit load, and a path goes nine tenths of the way that is left
to a limit point at a time.
"""
_SLOW = 0.3
"""Share of the largest rate that is added to each, so that an unknown which happens to stand still bounds no step."""
_DIFFERENCE = 1e-3
"""Turn [rad], or displacement over the frame's size, by which the bend of the path is measured."""
_IDLE = 2
"""Iterations in a row that may fail to halve what is left over; those of steps that converge do, but for one."""
MOST_STEPS = 200
"""Of a path, tried ones as well: ten times what a cantilever takes that its load bends along itself. Each length goes
with what the path bends, so that a load in which rounding alone bends it could be followed for ever."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CorotationalSolution:
    """A frame in equilibrium on its deformed shape.

    Attributes
    ----------
    model : FrameModel
        The divided frame: the given nodes first, the new ones after them.
    displacements : ndarray, shape (n, 3)
        Global axes [mm].
    rotations : ndarray, shape (n, 3, 3)
        Rotation matrices of the nodes.
    end_forces : ndarray, shape (m, 2, 6)
        What the nodes do to each element, global axes, moments about the nodes [N, N·mm].
    joint_wrenches : ndarray, shape (n, 6)
        What ties, guides and supports together do to the part of the frame at each node, global axes.
    residual : float
        Largest force left over, over the sum of the loads (moments over the frame's size).
    stable : bool
        True where every small motion stores energy (on the symmetric part of the tangent): otherwise the frame has
        buckled on its way here, and this shape will not be seen.
    springs : tuple of (FrameSpring, ndarray of shape (k, 6))
        What each spring does to its k points more than as the frame stands [N, N·mm].
    """

    model: FrameModel
    displacements: Floats
    rotations: Floats
    end_forces: Floats
    joint_wrenches: Floats
    residual: float
    stable: bool
    springs: tuple[tuple[FrameSpring, Floats], ...] = ()


class NoEquilibriumError(CannotRunError):
    """The path of stable equilibrium ends before the whole load acts.

    ``reached`` is the share of it that was held, ``failed`` the least that was not, ``buckled`` whether equilibrium
    goes on there but is not stable.
    """

    def __init__(self, reached: float, failed: float, *, buckled: bool) -> None:
        super().__init__(
            f"the frame gives way at {100.0 * reached:.3g} % of its load (a limit load or a snap-through); reduce the "
            "load or stiffen the frame"
        )
        self.reached, self.failed, self.buckled = reached, failed, buckled


class UnfollowedError(NoEquilibriumError):
    """The path of stable equilibrium was not followed to the whole load in ``MOST_STEPS``.

    ``reached`` is the share of it that was held, ``failed`` is infinite.
    """

    def __init__(self, reached: float) -> None:
        super().__init__(reached, np.inf, buckled=False)
        self.args = (
            f"the path of the frame's equilibrium bends so much that {MOST_STEPS} steps of load reach "
            f"{100.0 * reached:.3g} % of the whole load; reduce the load or stiffen the frame",
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Course:
    """How a path goes on: change of the unknowns by the load factor, its own change, and how far it bends little."""

    rate: Floats
    bend: Floats
    length: float


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Displacements and rotations of the nodes, and forces of the guides.

    Attributes
    ----------
    displacements : ndarray, shape (n, 3)
        Of the nodes [mm].
    rotations : ndarray, shape (n, 3, 3)
        Of the nodes.
    guide_forces : ndarray, shape (g,)
        Of the guides [N, N·mm].
    """

    displacements: Floats
    rotations: Floats
    guide_forces: Floats


class EquilibriumPath:
    """The equilibrium path of a frame from load factor 0 on.

    Its elements may be those of another frame, where these differ by the nodes alone that they end at.
    """

    def __init__(self, model: FrameModel, elements: CorotationalElements | None = None) -> None:
        n = len(model.nodes)
        self.model = model
        self.chain = KinematicChain(model)
        self.elements = elements or CorotationalElements(model)
        self.springs = SpringForces(model.springs, self.chain)
        self.pairs = np.array([e.nodes for e in model.elements])
        guided = [[-1 if node is None else node for node in (g.carrier, g.pin)] for g in model.guides]
        self.size = self.chain.count + len(guided)
        self.places = Places(self.chain, self.pairs, self.size)
        self.guided = Places(self.chain, np.array(guided, dtype=np.int64).reshape(-1, 2), self.size)
        self.state = State(
            displacements=np.zeros((n, 3)),
            rotations=np.tile(np.eye(3), (n, 1, 1)),
            guide_forces=np.zeros(len(model.guides)),
        )
        self._start = self.state
        self.scale = model.load_scale or 1.0
        stiffness = float(np.median(self.elements.stiffness[:, 0, 0]))
        moving = np.where(self.chain.is_turn, 1.0 / model.size, 1.0)
        self.gap_unit = np.array([1.0 / model.size if guide.axis is None else 1.0 for guide in model.guides])
        self.unit = np.concatenate([moving, stiffness * model.size * self.gap_unit])
        self.units = np.outer(self.unit, self.unit)
        self.reached = 0.0
        self._at: tuple[State, tuple[Jet, Jet]] | None = None
        self._balanced: dict[float, tuple[Floats, Floats]] = {}
        self._factorised: tuple[Floats, Callable[[Floats], Floats]] | None = None

    def respond(self, state: State, factor: float) -> ElementResponse:
        """Return what the elements answer in a state.

        Parameters
        ----------
        state : State
            Of the frame.
        factor : float
            Share of the line loads.

        Returns
        -------
        ElementResponse
            Forces and tangent of all elements.
        """
        natural, placed = self._natural(state), (state.displacements[self.pairs], state.rotations[self.pairs])
        return self.elements.loaded(natural, *placed, factor)

    def _natural(self, state: State) -> tuple[Jet, Jet]:
        """Natural deformations and axes of the elements, which the last state keeps for other factors."""
        if self._at is None or self._at[0] is not state:
            placed = state.displacements[self.pairs], state.rotations[self.pairs]
            natural = self.elements.undeformed if state is self._start else self.elements.natural(*placed)
            self._at, self._balanced = (state, natural), {}
        return self._at[1]

    def follow(self, least_step: float, most_iterations: int, *, stable: bool = False, to: float = 1.0) -> None:
        """Go on to a load in steps over which the path bends little, halved where Newton's method fails.

        Parameters
        ----------
        least_step : float
            Of the load.
        most_iterations : int
            Of Newton's method in one step.
        stable : bool, optional
            Whether the path ends where it is not stable any more.
        to : float, optional
            Factor on the load.

        Raises
        ------
        NoEquilibriumError
            Where the step falls below ``least_step`` and a 64th of the load that was reached.
        UnfollowedError
            Where ``MOST_STEPS`` do not reach it.
        """
        course = self._course()
        step = first = course.length
        for _ in range(MOST_STEPS):
            if self.reached >= to:
                return
            finest = min(least_step, _RESOLUTION * (self.reached or first))
            target = min(to, self.reached + max(step, finest))
            found = self._newton(target, course, most_iterations)
            buckled = found is not None and stable and not self.is_stable(found[0], target)
            if found is None or buckled:
                step = (target - self.reached) / 2.0
                if step < finest:
                    raise NoEquilibriumError(self.reached, target, buckled=buckled)
                continue
            self.state, iterations = found
            self.reached = target
            if target < to:
                course = self._course()
                step = min(2.0 * step if iterations <= 6 else step, course.length)
        if self.reached < to:
            raise UnfollowedError(self.reached)

    def _course(self) -> _Course:
        """Return how the path goes on, and the share of the load that lies ahead before it bends much, however large.

        With the rates u' of the unknowns and their change u'', both by the load factor, |u''| h is at most a share of
        |u'|. The forces left over where the frame goes on along u' by t are -t² K u''/2.
        """
        state, factor, unit = self.state, self.reached, self.unit[: self.chain.count]
        left, tangent = self.balance(state, factor)
        rate = -self._solve(tangent, self.balance(state, factor + 1.0)[0] - left)
        largest = float(np.abs(rate[: len(unit)] / unit).max(initial=0.0))
        if largest == 0.0:  # as of a force straight into the ground
            return _Course(rate=rate, bend=np.zeros_like(rate), length=1.0)
        t, kept = _DIFFERENCE / largest, (self._at, self._balanced)
        moved = [self._moved(state, d * rate) for d in (t, -t)]
        ahead, behind = (self.balance(one, factor + d)[0] for one, d in zip(moved, (t, -t), strict=True))
        self._at, self._balanced = kept
        parted = ahead - 2.0 * left + behind
        if self._measure(parted) <= self._rounding(moved[0]):
            return _Course(rate=rate, bend=np.zeros_like(rate), length=1.0)
        bend = -self._solve(tangent, parted) / t**2
        allowed = np.abs(rate[: len(unit)] / unit) + _SLOW * largest
        sharpest = float((np.abs(bend[: len(unit)] / unit) / allowed).max())
        return _Course(rate=rate, bend=bend, length=_BEND / max(sharpest, _BEND))

    def _newton(self, factor: float, course: _Course, most_iterations: int) -> tuple[State, int] | None:
        """Equilibrium at a load factor from the present state, with the iterations it took; None where it fails.

        The forces in elements are unknowns of their own, which follow from k v to first order and are eliminated: the
        tangent has those that go with the last change, k (v + B δ), and what is left over has k v. Turns whose
        first-order change is a stretch too so leave no forces behind, and a step takes five iterations, not nine. It
        starts on the course of the path, with forces that grow as they do there.
        """
        h = factor - self.reached
        tangents, change, further = h * course.rate, h * course.rate, h**2 / 2.0 * course.bend
        state, best, idle = self.state, np.inf, 0
        for iteration in range(1, most_iterations):
            turn = float(np.abs((change + further)[: self.chain.count][self.chain.is_turn]).max(initial=0.0))
            if not np.isfinite(change).all() or turn > _DIVERGED:
                return None
            share = min(1.0, _LARGEST_TURN / turn if turn > 0.0 else 1.0)
            ahead = self._strains(state, share * change)
            state = self._moved(state, share * (change + further))
            try:
                residual, tangent = self._ahead(state, factor, ahead)
                size = self._measure(residual)
                if size <= max(_TOLERANCE * factor, min(self._rounding(state), _MOST_ROUNDING)):
                    _, tangent = self.balance(state, factor)
                    tangents = (tangents + self._solve(tangent, self.balance(state, self.reached)[0])) / 2.0
                    moved = state.displacements - self.state.displacements
                    missed = float(np.linalg.norm(moved - self._displacements(tangents)))
                    most = max(_ROUGH * float(np.linalg.norm(moved)), _TOLERANCE * self.model.size)
                    return (state, iteration) if missed <= most else None
                best, idle = (size, 0) if size < best / 2.0 else (best, idle + 1)
                if idle == _IDLE:
                    return None
                change, further = -self._solve(tangent, residual), np.zeros(self.size)
            except CannotRunError:
                return None
        return None

    def _strains(self, state: State, change: Floats) -> Floats:
        """Natural deformations (m, 6) of the elements after a change of the unknowns, to first order."""
        natural, _ = self._natural(state)
        moved = self._displacements(change)[self.pairs]
        spins = self.chain.spins(state.rotations, change[: self.chain.count])[self.pairs]
        nine = np.concatenate([moved[:, 1] - moved[:, 0], spins[:, 0], spins[:, 1]], axis=1)
        return np.asarray(natural.value + (natural.gradient @ nine[:, :, None])[:, :, 0])

    def _ahead(self, state: State, factor: float, strains: Floats) -> tuple[Floats, Floats]:
        """As ``balance``, but the derivative has the forces of other natural deformations (m, 6) in the elements."""
        natural, _ = self._natural(state)
        pressed = self.elements.pressed(natural, strains - natural.value)
        return self.assemble(self.respond(state, factor), state, factor, pressed)

    def balance(self, state: State, factor: float) -> tuple[Floats, Floats]:
        """Return the out-of-balance forces and gaps of the guides, with their derivative.

        Parameters
        ----------
        state : State
            Of the frame.
        factor : float
            Share of the loads.

        Returns
        -------
        tuple of 2 ndarray
            What is left over (k + g,) and its derivative (k + g, k + g). Those of the last state are kept.
        """
        self._natural(state)
        if factor not in self._balanced:
            self._balanced[factor] = self.assemble(self.respond(state, factor), state, factor)
        return self._balanced[factor]

    def _solve(self, tangent: Floats, right: Floats) -> Floats:
        if self._factorised is None or self._factorised[0] is not tangent:
            self._factorised = tangent, _factorised(tangent * self.units)
        return np.asarray(self._factorised[1](right * self.unit) * self.unit)

    def _displacements(self, change: Floats) -> Floats:
        """Displacements (n, 3) of all nodes in a change of the unknowns."""
        places = self.chain.translations
        return np.where(places >= 0, change[places], 0.0)

    def _rounding(self, state: State) -> float:
        """What rounding of displacements and rotations leaves of forces in the stiffest element, over the loads."""
        k = self.elements.stiffness
        stretched = k[:, 0, 0].max() * np.abs(state.displacements).max()
        bent = (k[:, [1, 3], [1, 3]].max(axis=1) / self.elements.lengths).max()
        turned = np.abs(changes_of(state.rotations)).max()
        return _ROUNDINGS * float(np.finfo(float).eps * (stretched + bent * turned)) / self.scale

    def _measure(self, residual: Floats) -> float:
        """Largest force left over, over the sum of the loads; or gap of a guide, over the frame's size or in rad."""
        count = self.chain.count
        forces = float(np.abs(residual[:count] * self.unit[:count]).max(initial=0.0)) / self.scale
        return max(forces, float(np.abs(residual[count:] * self.gap_unit).max(initial=0.0)))

    def _moved(self, state: State, change: Floats) -> State:
        return State(
            displacements=state.displacements + self._displacements(change),
            rotations=self.chain.turned(state.rotations, change[: self.chain.count]),
            guide_forces=state.guide_forces + change[self.chain.count :],
        )

    def assemble(
        self, answer: ElementResponse, state: State, factor: float, pressed: ElementResponse | None = None
    ) -> tuple[Floats, Floats]:
        """Return the out-of-balance forces and gaps, with their derivative, from what the elements answer.

        Parameters
        ----------
        answer : ElementResponse
            Of the elements.
        state : State
            Of the frame.
        factor : float
            Share of the loads.
        pressed : ElementResponse, optional
            What the elements answer besides in the derivative alone.

        Returns
        -------
        tuple of 2 ndarray
            What is left over (k + g,) and its derivative (k + g, k + g).
        """
        count, model = self.chain.count, self.model
        axes = self.chain.axes(state.rotations)
        residual, tangent = np.zeros(self.size), np.zeros((self.size, self.size))
        moments = np.zeros((len(model.nodes) + 1, 3))  # the last row is that of the ground

        def add(places: Places, forces: Floats, stiffness: Floats) -> Floats:
            T = places.matrices(axes)
            np.add(residual, places.gathered((T @ forces[..., None])[..., 0]), out=residual)
            np.add(tangent, places.gathered(T @ stiffness @ T.swapaxes(1, 2)), out=tangent)
            np.add.at(moments, places.nodes, forces.reshape(-1, 2, 6)[..., 3:])
            return T

        add(self.places, answer.forces, answer.tangent if pressed is None else answer.tangent + pressed.tangent)
        if pressed is not None:
            np.add.at(moments, self.places.nodes, pressed.forces.reshape(-1, 2, 6)[..., 3:])
        if model.guides:
            gaps, units = zip(*(self._gap(guide, state) for guide in model.guides), strict=True)
            unit = np.concatenate([u.forces for u in units])
            bent = np.concatenate([u.tangent for u in units])
            T = add(self.guided, state.guide_forces[:, None] * unit, state.guide_forces[:, None, None] * bent)
            ways = np.zeros((len(gaps), self.size + 1))
            np.add.at(ways, (np.arange(len(gaps))[:, None], self.guided.numbers), (T @ unit[..., None])[..., 0])
            tangent[:, count:] += ways[:, :-1].T
            tangent[count:] += ways[:, :-1]
            residual[count:] = gaps

        def push(node: int, wrench: Floats) -> None:
            places = self.chain.translations[node]
            np.add.at(residual, places[places >= 0], -wrench[:3][places >= 0])
            numbers = [step.number for step in self.chain.nodes[node]]
            np.add.at(residual, numbers, -(axes[numbers] @ wrench[3:]))
            moments[node] -= wrench[3:]

        for load in model.loads:
            now = load.turned(state.rotations[load.node])
            push(load.node, factor * now.wrench)
            if now.lever.any():
                turns = [step.number for step in self.chain.nodes[load.node]]
                np.add.at(tangent, np.ix_(turns, turns), factor * axes[turns] @ now.stiffness @ axes[turns].T)
        for spring, wrenches in self.springs.changes(state.displacements, state.rotations, factor):
            for node, wrench in zip(spring.nodes, wrenches, strict=True):
                if node is not None:
                    push(node, wrench)
        if model.springs:
            tangent[:count, :count] += self.springs.tangent(state.displacements, state.rotations, axes, factor)
        pin, before, gain = self.chain.carried(axes, moments)
        np.add.at(tangent, (pin, before), gain)
        return residual, tangent

    def _gap(self, guide: Guide, state: State) -> tuple[float, ElementResponse]:
        """Gap of a guide, and what a unit of its force does; what the latter does to the ground stands for nothing."""
        nodes = [guide.carrier, guide.pin]
        displacements = np.array([np.zeros(3) if node is None else state.displacements[node] for node in nodes])
        rotations = np.array([np.eye(3) if node is None else state.rotations[node] for node in nodes])
        return guide_gap(guide, displacements, rotations)

    def allowed(self, bordered: Floats) -> Floats:
        """Return the motions that the guides allow.

        Parameters
        ----------
        bordered : ndarray, shape (k + g, k + g)
            Derivative with the guides' rows and columns.

        Returns
        -------
        ndarray, shape (k + g, c)
            Independent motions, in unknowns of like size.
        """
        from scipy.linalg import null_space

        count = self.chain.count
        if count == self.size:
            return np.diag(self.unit)
        Z = null_space(bordered[count:, :count] * self.unit[:count])
        return np.vstack([self.unit[:count, None] * Z, np.zeros((self.size - count, Z.shape[1]))])

    def free(self, bordered: Floats) -> Floats:
        """Return the scaled stiffness of the motions that the guides allow.

        Parameters
        ----------
        bordered : ndarray, shape (k + g, k + g)
            Derivative with the guides' rows and columns.

        Returns
        -------
        ndarray
            Square matrix over the motions that are left.
        """
        if self.chain.count == self.size:
            return bordered * self.units
        Z = self.allowed(bordered)
        return np.asarray(Z.T @ bordered @ Z)

    def is_stable(self, state: State, factor: float) -> bool:
        """Return True where every small motion stores energy.

        Parameters
        ----------
        state : State
            Of the frame, in equilibrium.
        factor : float
            Share of the loads.

        Returns
        -------
        bool
            On the symmetric part of the tangent.
        """
        return self._stores_energy(self.balance(state, factor)[1])

    def _stores_energy(self, tangent: Floats) -> bool:
        scaled = self.free(tangent)
        try:
            np.linalg.cholesky((scaled + scaled.T) / 2.0)
        except np.linalg.LinAlgError:
            return False
        return True

    def record(self) -> CorotationalSolution:
        """Return the present state as the frame's solution."""
        model, state = self.model, self.state
        answer = self.respond(state, 1.0)
        residual, tangent = self.assemble(answer, state, 1.0)
        joints = np.zeros((len(model.nodes), 6))
        ends = answer.forces.reshape(-1, 2, 6)
        np.add.at(joints, self.pairs, ends)
        for load in model.loads:
            joints[load.node] -= load.turned(state.rotations[load.node]).wrench
        changes = tuple(self.springs.changes(state.displacements, state.rotations, 1.0))
        for spring, wrenches in changes:
            for node, wrench in zip(spring.nodes, wrenches, strict=True):
                if node is not None:
                    joints[node] -= wrench
        return CorotationalSolution(
            model=model,
            displacements=state.displacements,
            rotations=state.rotations,
            end_forces=ends,
            joint_wrenches=joints,
            residual=self._measure(residual),
            stable=self._stores_energy(tangent),
            springs=changes,
        )


def _factorised(matrix: Floats) -> Callable[[Floats], Floats]:
    """Return what solves a system for right-hand sides.

    Single-threaded either way: threads that wait for each other cost more than matrices this small.
    """
    from scipy.linalg.lapack import dgetrf, dgetrs
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import splu

    if len(matrix) <= _DENSE:
        dense, pivots, singular = dgetrf(matrix)
        if singular:
            raise CannotRunError("the tangent stiffness of the frame is singular")
        return lambda right: np.asarray(dgetrs(dense, pivots, right)[0])
    try:
        factors = splu(csc_matrix(matrix))
    except RuntimeError as error:
        raise CannotRunError(f"the tangent stiffness of the frame is singular: {error}") from None
    return lambda right: np.asarray(factors.solve(right))
