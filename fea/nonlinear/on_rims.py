"""Small motions and linear stability of a frame whose pins stand in their holes, as the rims leave them free.

Where a pin's ends move by S v against the nodes that they stand on, its beam stores ½ (u + S v)ᵀ k (u + S v). The rims
leave the motions v = N w, which the forces at them resist by T (``alula.fea.pins.tangent``). With its stiffness k and
the geometric stiffness k_g of its forces, and with K and K_g of the whole frame, the unknowns u and w have

    | K        k S N      |     | K_g              (k_g + W) S N    |
    | Nᵀ Sᵀ k  Nᵀ Sᵀ k S N | + λ | Nᵀ Sᵀ (k_g + W)ᵀ  Nᵀ Sᵀ k_g S N + T |

at the factor λ on all loads, since T grows with the load as the geometric stiffness does. W is there since rims turn
with their link: a turn θ of a node takes along the shift s and the tilt ρ of the pin's end against it, so that the
end's force f and moment M work f · (θ × s) + M · (θ × ρ)/2 more (turns that follow one another: Argyris, Computer
Methods in Applied Mechanics and Engineering 32, 1982). So a tie that rolls about the line through the rims that it
hangs on has exactly no stiffness.

Where motions are left that nothing but T holds, the frame may be unstable under any load: then it leans until further
rims touch. Yet with every pin in its discs it has a stable state at every factor below that with tight pins, since the
discs are bounded and the frame is stable for each place in them. How far it leans on the way there the discs bound as
well: wherever pins stand, virtual work tells up to how far a point moves (``alula.fea.outcomes.free_motion``). Where
that is small, by the ``LARGE`` of the span that parts small displacements from large ones, the lean changes no shape
and ends, and such clearances cannot lose the linkage: the low end knows only wider ones, beside the value, of which a
lean that is small counts as stopped.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linear import FrameSolution
from alula.fea.frame.system import natural_deformations
from alula.fea.nonlinear.corotational import SUBDIVISIONS, subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import (
    COARSE_SUBDIVISIONS,
    LARGE,
    NEAR_BUCKLING,
    geometric_stiffness,
    largest_eigenvalue,
    pressed_beams,
    span,
)
from alula.fea.pins.holes import RimFrame
from alula.fea.pins.states import PinStates
from alula.fea.pins.tangent import RimTangent

Floats = NDArray[np.float64]

STARTS = (1.0, 0.1, 0.01, 1e-3)
"""Factors on the load from which on the least one is sought; a frame that is unstable at all of them leans at once."""
FLOATING = 1e-10
"""Stiffness, over the largest, below which a pin floats between its holes."""
FREE = 1e-10
"""Stiffness, over the largest of pins, below which nothing but forces at rims holds a motion."""
IDLE = 1e-7
"""Work of forces in a motion that strains nothing, over that of all of its parts, below which it is rounding, such as
that of a tie that rolls about the line through the rims that it hangs on."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Extended:
    """The stiffness of a frame in the k scaled motions that guides allow, and in c of its pins against their links.

    Attributes
    ----------
    allowed : ndarray, shape (u, k)
        These motions in the unknowns of the path.
    plain, pressed : ndarray, shape (k + c, k + c)
        Of its material, and by its forces; symmetric.
    free : ndarray, shape (k + c, f)
        Motions that strain nothing.
    """

    allowed: Floats
    plain: Floats
    pressed: Floats
    free: Floats

    def factor(self, *, stopped: bool = False, below: float = np.inf) -> float:
        """Return the least factor on the load at which the frame becomes unstable.

        Parameters
        ----------
        stopped : bool, optional
            Whether the motions in which it leans are closed.
        below : float, optional
            One that is known already. The factors at which the frame is stable are an interval, as the stiffness is
            linear in them, so that where it is stable at the least of ``STARTS`` and at this, its own is no less.

        Returns
        -------
        float
            0 where it is unstable at all of ``STARTS``; ``below`` where it is no less. Motions that strain nothing and
            that no load drives do not count.
        """
        size = np.diag(self.plain)
        unit = 1.0 / np.sqrt(np.where(size > 0.0, size, 1.0))
        plain, pressed = self.plain * np.outer(unit, unit), self.pressed * np.outer(unit, unit)
        Z, _ = np.linalg.qr(self.free / unit[:, None])
        work, own = np.linalg.eigh(Z.T @ pressed @ Z)
        Z = Z @ own
        idle = np.abs(work) <= IDLE * (np.abs(Z) * (np.abs(pressed) @ np.abs(Z))).sum(axis=0)
        leans = ~idle & (work < 0.0)
        if leans.any() and not stopped:
            return 0.0
        closed = Z[:, idle | leans]
        along = pressed @ closed
        lost = closed @ (along - closed @ (closed.T @ along) / 2.0).T
        plain, pressed = plain + closed @ closed.T, pressed - lost - lost.T

        def held(factor: float) -> Floats | None:
            try:
                return np.linalg.cholesky(plain + factor * pressed)
            except np.linalg.LinAlgError:
                return None

        if below < np.inf and held(STARTS[-1]) is not None and held(below) is not None:
            return below
        for start in STARTS:
            root = held(start)
            if root is not None:
                largest = largest_eigenvalue(-pressed, root)
                return min(start + 1.0 / largest, below) if largest > 1e-12 else below
        return 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Condensed:
    """A frame condensed to where its pins stand at the rims of h holes, by u unknowns of its path.

    Attributes
    ----------
    tight : ndarray, shape (u,)
        Its motion under the loads with tight pins.
    by_rims : ndarray, shape (u, 4 h)
        What the variables of the rims add.
    K : ndarray, shape (4 h, 4 h)
        Stiffness [N/mm]; with negative eigenvalues where forces drive pins away.
    g : ndarray, shape (4 h,)
        Forces at the rims with tight pins [N].
    """

    tight: Floats
    by_rims: Floats
    K: Floats
    g: Floats

    def moved(self, v: Floats) -> Floats:
        """Return its motion with pins as they stand.

        Parameters
        ----------
        v : ndarray, shape (4 h,)
            [mm].

        Returns
        -------
        ndarray, shape (u,)
        """
        return np.asarray(self.tight + self.by_rims @ v)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Pressed:
    """Geometric stiffness: of the k motions of a frame, between these and 4 h variables of the rims, and of those."""

    frame: Floats
    pulls: Floats
    own: Floats


class RimPath:
    """The small motions of a frame whose pins are as rims leave them.

    Parameters
    ----------
    rims : RimFrame
        Of the path's model.
    path : EquilibriumPath
        At its start.
    further : ndarray, shape (k + g, k + g), optional
        Stiffness beside that of the path's model.
    """

    def __init__(self, rims: RimFrame, path: EquilibriumPath, further: Floats | None = None) -> None:
        self.rims, self.path = rims, path
        self._pins = list(rims.frame.pin_beams.values())
        self._moved = path.places.matrices(path.chain.axes(path.state.rotations))[self._pins]
        plain = path.respond(path.state, 0.0)
        K, k = path.assemble(plain, path.state, 0.0)[1], plain.tangent[self._pins]
        K = K if further is None else K + further
        self._motions, self._stiffness, self._own_stiffness = path.allowed(K), path.free(K), self._own(k)
        self._pulls = self._motions[: path.chain.count].T @ self._coupled(k)
        self._follows = -np.linalg.solve(self._stiffness, self._pulls)

    def forces(self, tangent: RimTangent) -> FrameSolution:
        """Return the forces in the frame.

        Parameters
        ----------
        tangent : RimTangent
            Of the state.

        Returns
        -------
        FrameSolution
        """
        return self.rims.solved.solved(self.rims.opened @ tangent.v)

    def extended(self, tangent: RimTangent, state: FrameSolution | None = None) -> Extended:
        """Return stiffness and geometric stiffness in a state, with the motions that rims leave.

        Parameters
        ----------
        tangent : RimTangent
            Of the state.
        state : FrameSolution, optional
            Its forces, where they are known.

        Returns
        -------
        Extended
        """
        ways, pressed = tangent.ways, self._pressed_by(state or self.forces(tangent))
        own_pressed = ways.T @ pressed.own @ ways + np.diag(tangent.stiffness)
        felt = _felt(ways.T @ self._own_stiffness @ ways, own_pressed)
        taken = ways @ felt
        coupled, by_pins, own = self._pulls @ taken, self._follows @ taken, taken.T @ self._own_stiffness @ taken
        alone, freed = np.linalg.eigh(own + coupled.T @ by_pins)
        freed = freed[:, alone < FREE * np.abs(own).max(initial=0.0)]
        return Extended(
            allowed=self._motions,
            plain=_bordered(self._stiffness, coupled, own),
            pressed=_bordered(pressed.frame, pressed.pulls @ taken, felt.T @ own_pressed @ felt),
            free=np.vstack([by_pins @ freed, freed]),
        )

    def condensed(self, forces: FrameSolution | None = None, factor: float = 1.0) -> Condensed | None:
        """Return how the frame answers its loads, and its pins where they stand, in small motions.

        Parameters
        ----------
        forces : FrameSolution, optional
            Whose geometric stiffness counts; none without.
        factor : float, optional
            Of these forces.

        Returns
        -------
        Condensed or None
            None where it is unstable with its pins held.
        """
        A, C, own = self._stiffness, self._pulls, self._own_stiffness
        if forces is not None:
            pressed = self._pressed_by(forces)
            A, C, own = A + factor * pressed.frame, C + factor * pressed.pulls, own + factor * pressed.own
        A = (A + A.T) / 2.0
        try:
            np.linalg.cholesky(A)
        except np.linalg.LinAlgError:
            return None
        loads = -self._motions.T @ self.path.balance(self.path.state, 1.0)[0]
        solved = np.linalg.solve(A, np.column_stack([loads, -C]))
        tight, follows = solved[:, 0], solved[:, 1:]
        K = own + C.T @ follows
        return Condensed(
            tight=self._motions @ tight, by_rims=self._motions @ follows, K=(K + K.T) / 2.0, g=-C.T @ tight
        )

    def at_nodes(self, moved: Floats, nodes: Sequence[int]) -> Floats:
        """Return how nodes of links move.

        Parameters
        ----------
        moved : ndarray, shape (u, c)
            Motions, in the unknowns of the path.
        nodes : sequence of n int

        Returns
        -------
        ndarray, shape (n, 3, c)
            Along the global axes.
        """
        path, ends = self.path, dict[int, tuple[int, int]]()
        for i, element in enumerate(self.rims.frame.model.elements):
            if i not in self._pins:  # a pin's end stands in its hole
                ends |= {node: (i, end) for end, node in enumerate(element.nodes)}
        matrices = path.places.matrices(path.chain.axes(path.state.rotations))
        unknowns = np.vstack([moved, np.zeros_like(moved[:1])])
        return np.array(
            [
                matrices[i][:, 6 * end : 6 * end + 3].T @ unknowns[path.places.numbers[i]]
                for i, end in (ends[node] for node in nodes)
            ]
        ).reshape(-1, 3, moved.shape[1])

    def natural_forces(self, moved: Floats, v: Floats) -> Floats:
        """Return the natural forces of all beams in a small motion, without those that hold line loads.

        Parameters
        ----------
        moved : ndarray, shape (u,)
            In the unknowns of the path.
        v : ndarray, shape (4 h,)
            Of the pins at the rims [mm].

        Returns
        -------
        ndarray, shape (6 m,)
            In the order of ``alula.fea.frame.system.natural_deformations``.
        """
        path, system = self.path, self.rims.solved.system
        unknowns = np.append(moved, 0.0)[path.places.numbers]
        ends = (path.places.matrices(path.chain.axes(path.state.rotations)) * unknowns[:, :, None]).sum(axis=1)
        ends[self._pins] += self.rims.ends @ v
        deformed = natural_deformations(system.lengths) @ system.matrices @ ends[:, :, None]
        return np.asarray((path.elements.stiffness @ deformed).ravel())

    def _pressed_by(self, state: FrameSolution) -> _Pressed:
        path, pins = self.path, self._pins
        pressed = pressed_beams(path, state.end_forces)
        k_g = (pressed.tangent[pins] + pressed.tangent[pins].swapaxes(1, 2)) / 2.0
        work = np.zeros_like(k_g)
        for end in (0, 1):
            local = state.end_forces[pins, end].reshape(-1, 2, 3, 1)
            forces, moments = (path.elements.axes[pins, None] @ local)[..., 0].swapaxes(0, 1)
            moments = moments + np.cross(path.elements.arms[pins, end], forces)  # about the node
            turn, shift = slice(6 * end + 3, 6 * end + 6), slice(6 * end, 6 * end + 3)
            work[:, turn, shift] = _turning(forces)
            work[:, turn, turn] = _turning(moments) / 2.0
        return _Pressed(
            frame=path.free(geometric_stiffness(path, pressed, state.guide_forces)),
            pulls=self._motions[: path.chain.count].T @ self._coupled(k_g + work),
            own=self._own(k_g),
        )

    def _own(self, stiffness: Floats) -> Floats:
        """(4 h, 4 h) of pins' beams by the variables of the rims."""
        ends = self.rims.ends
        width = ends.shape[2]
        return np.asarray(ends.reshape(-1, width).T @ (stiffness @ ends).reshape(-1, width))

    def _coupled(self, stiffness: Floats) -> Floats:
        """(k, 4 h) forces on the frame's unknowns by the variables of the rims."""
        found = np.zeros((self.path.size + 1, self.rims.ends.shape[2]))
        np.add.at(found, self.path.places.numbers[self._pins], self._moved @ stiffness @ self.rims.ends)
        return found[: self.path.chain.count]


def _turning(vectors: Floats) -> Floats:
    """X (n, 3, 3) of vectors f, by which f · (θ × r) = θᵀ X r."""
    x, y, z = vectors.T
    o = np.zeros_like(x)
    return np.array([[o, z, -y], [-z, o, x], [y, -x, o]]).transpose(2, 0, 1)


def _felt(own: Floats, pressed: Floats) -> Floats:
    """Directions (k, c) of rims' motions that bend a pin, or in which forces at rims do work."""
    sizes = (np.abs(own).max(initial=0.0) or 1.0, np.abs(pressed).max(initial=0.0) or 1.0)
    values, vectors = np.linalg.eigh(own @ own / sizes[0] ** 2 + pressed @ pressed / sizes[1] ** 2)
    return np.asarray(vectors[:, values > FLOATING**2])


def _bordered(whole: Floats, coupled: Floats, own: Floats) -> Floats:
    return np.block([[(whole + whole.T) / 2.0, coupled], [coupled.T, own]])


@dataclass(frozen=True, kw_only=True)
class RimFactors:
    """Factors on all loads at which a linkage becomes unstable with its pins in their holes.

    Attributes
    ----------
    value : float
        Of the stated clearances; 0 where it leans at once, by more than is small.
    low : float
        The least, of all that clearances may be, but for those that let no point move by more than is small.
    """

    value: float
    low: float

    def within(self, tight: float) -> "RimFactors":
        """Return the same, but no larger than with tight pins.

        Parameters
        ----------
        tight : float

        Returns
        -------
        RimFactors
        """
        return replace(self, value=min(self.value, tight), low=min(self.low, tight))

    def lowered(self, factor: float, tight: float) -> float:
        """Return a factor that holds with tight pins, lowered by what linear theory makes of pins in their holes.

        Parameters
        ----------
        factor : float
        tight : float
            That of linear theory with tight pins.

        Returns
        -------
        float
        """
        return factor * self.low / tight if math.isfinite(tight) else min(factor, self.low)


def divided(pins: PinStates, subdivisions: int) -> RimPath:
    """Return the small motions of a frame with divided beams.

    Parameters
    ----------
    pins : PinStates
    subdivisions : int
        Elements per beam; pins are one each.

    Returns
    -------
    RimPath
    """
    frame = pins.rims.frame
    stiff = set(frame.pin_beams.values())
    parts = [1 if i in stiff else subdivisions for i in range(len(frame.model.elements))]
    model = subdivide(frame.model, parts)
    return RimPath(pins.rims.divided(model, np.repeat(np.arange(len(parts)), parts)), EquilibriumPath(model))


@lru_cache(maxsize=32)
def rim_factors(pins: PinStates) -> RimFactors:
    """Return the factors at which a linkage becomes unstable with its pins in their holes.

    Parameters
    ----------
    pins : PinStates

    Returns
    -------
    RimFactors
    """
    small, first = LARGE * span(pins.rims.frame.pose), pins.tangent(pins.radii.value, pins.value)
    stopped, wide = True, [first]
    if pins.reaches(pins.radii.largest)[0] > small:  # else no other state counts: none is sought
        stopped = bool(pins.reaches(pins.radii.of(pins.radii.value[None])[0])[0] <= small)
        wide += pins.leaning(small)
    coarse = divided(pins, COARSE_SUBDIVISIONS)
    found = list[float]()
    for one in wide:  # what is no less than the least so far is not told
        if found and min(found) <= 0.0:
            break
        found.append(coarse.extended(one).factor(stopped=stopped and one is first, below=min(found, default=np.inf)))
    least = int(np.argmin(found))
    ends = found[0], found[least]
    if 0.0 < ends[1] < NEAR_BUCKLING:
        fine = divided(pins, SUBDIVISIONS)
        ends = fine.extended(first).factor(stopped=stopped), found[least]
        if least > 0:
            ends = ends[0], fine.extended(wide[least]).factor()
    return RimFactors(value=ends[0], low=min(ends))
