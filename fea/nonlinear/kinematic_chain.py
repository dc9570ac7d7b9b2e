"""Finite rotations of the nodes of a frame: who turns with whom, and about which axes.

Tied nodes form trees. The rotation of a tied node is that of its parent, followed by a turn about the pin's axis,
which the parent carries along. Virtual spins of a node are so the sum of the spins of its chain of steps, each about
its present axis. Displacements are shared or are not, apart from that: a slider turns with what carries it and moves by
itself.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.model import DOFS, FrameModel
from alula.fea.frame.system import FrameSystem
from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """One turn in a chain.

    Attributes
    ----------
    number : int
        Of its unknown.
    axis : ndarray, shape (3,)
        At the start.
    carrier : int or None
        Node that carries the axis; None for an axis in space.
    """

    number: int
    axis: Floats
    carrier: int | None


class KinematicChain:
    """Unknowns of a frame in large displacement: three displacements per place at which nodes are tied, and the turns.

    Attributes
    ----------
    count : int
        Of the unknowns.
    is_turn : ndarray of bool, shape (count,)
        True where the unknown is a turn.
    translations : ndarray of int, shape (n, 3)
        Numbers of each node's displacements, -1 where held.
    nodes : list of list of Step
        Steps of each node.

    Raises
    ------
    CannotRunError
        For supports and ties that make no sense for finite turns, such as a rotation held about one axis alone.
    """

    def __init__(self, model: FrameModel) -> None:
        self.model = model
        self._linear = FrameSystem(model).number
        self._held = {(s.node, DOFS.index(d)) for s in model.supports for d in s.dofs}
        self.turns: list[bool] = []
        n = len(model.nodes)
        self._seen: set[int] = set()
        self.translations = self._translations()
        self.nodes: list[list[Step]] = [[] for _ in range(n)]
        supports = np.bincount([node for node, _ in self._held], minlength=n) if self._held else np.zeros(n)
        for root in sorted(range(n), key=lambda i: (-supports[i], i)):
            if root not in self._seen:
                self._grow(root)
        self.count = len(self.turns)
        self.is_turn = np.array(self.turns, dtype=bool)
        self._table()

    def _table(self) -> None:
        """Set up what ``axes``, ``turned`` and ``carried`` need of all nodes at once."""
        self._axes = np.zeros((self.count, 3))
        self._carriers = np.full(self.count, -1)
        levels: list[tuple[int, int, int]] = []
        pairs: list[tuple[int, int, int]] = []
        for node, steps in enumerate(self.nodes):
            pins = 0
            for j, step in enumerate(steps):
                self._axes[step.number] = step.axis
                if step.carrier is not None:
                    self._carriers[step.number] = step.carrier
                    pins += 1
                    pairs += [(node, before.number, step.number) for before in steps[:j]]
                levels.append((node, pins, step.number))
        self._levels = np.array(levels, dtype=np.int64).reshape(-1, 3).T
        self._pairs = np.array(pairs, dtype=np.int64).reshape(-1, 3).T

    def axes(self, rotations: Floats) -> Floats:
        """Return the present axes of all unknowns; zero for displacements.

        Parameters
        ----------
        rotations : ndarray, shape (n, 3, 3)
            Of the nodes.

        Returns
        -------
        ndarray, shape (count, 3)
        """
        carried = np.einsum("kij,kj->ki", rotations[self._carriers], self._axes)
        return np.where(self._carriers[:, None] >= 0, carried, self._axes)

    def spins(self, rotations: Floats, increments: Floats) -> Floats:
        """Return the spins of the nodes that increments of the unknowns make, to first order.

        Parameters
        ----------
        rotations : ndarray, shape (n, 3, 3)
            Of the nodes.
        increments : ndarray, shape (count,)
            Of the unknowns [rad].

        Returns
        -------
        ndarray, shape (n, 3)
        """
        node, _, number = self._levels
        found = np.zeros((len(rotations), 3))
        np.add.at(found, node, (self.axes(rotations) * increments[:, None])[number])
        return found

    def turned(self, rotations: Floats, increments: Floats) -> Floats:
        """Return the rotations of the nodes after increments of the unknowns; free turns first, then the pins.

        Parameters
        ----------
        rotations : ndarray, shape (n, 3, 3)
            Before.
        increments : ndarray, shape (count,)
            Of the unknowns [rad].

        Returns
        -------
        ndarray, shape (n, 3, 3)
        """
        spins = self.axes(rotations) * increments[:, None]
        node, level, number = self._levels
        after = rotations
        for k in range(int(level.max(initial=-1)), -1, -1):
            vectors = np.zeros((len(rotations), 3))
            np.add.at(vectors, node[level == k], spins[number[level == k]])
            after = rotations_of(vectors) @ after
        return after

    def carried(self, axes: Floats, moments: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats]:
        """Return what moments gain about the pins' axes when the turns before these turn them: (ω × a) · moment.

        Parameters
        ----------
        axes : ndarray, shape (count, 3)
            Present axes of the unknowns.
        moments : ndarray, shape (n, 3)
            On the nodes [N·mm].

        Returns
        -------
        tuple of ndarray
            Numbers of the pins' unknowns, of the turns before them, and the gains.
        """
        node, before, pin = self._pairs
        return pin, before, np.einsum("pi,pi->p", np.cross(axes[before], axes[pin]), moments[node])

    def _unknown(self, *, turn: bool) -> int:
        self.turns.append(turn)
        return len(self.turns) - 1

    def _translations(self) -> NDArray[np.int64]:
        linear = self._linear.reshape(-1, 6)[:, :3]
        numbers = {int(k): self._unknown(turn=False) for k in np.unique(linear[linear >= 0])}
        return np.array([[numbers.get(int(k), -1) for k in row] for row in linear])

    def _own_turns(self, node: int) -> list[Step]:
        held = [k for k in range(3) if (node, 3 + k) in self._held]
        if len(held) == 1:
            raise CannotRunError(
                f"in large displacement a node turns freely, about one axis or not at all; the supports of node "
                f"{self.model.name(node)} hold its rotation about {'xyz'[held[0]]} alone: hold one more or none"
            )
        free = [k for k in range(3) if self._linear[6 * node + 3 + k] >= 0]
        return [Step(number=self._unknown(turn=True), axis=np.eye(3)[k], carrier=None) for k in free]

    def _grow(self, root: int) -> None:
        """Number the tree of nodes tied to a root."""
        self._seen.add(root)
        self.nodes[root] = self._own_turns(root)
        front = [root]
        while front:
            parent = front.pop()
            for tie in self.model.ties:
                if parent not in tie.nodes:
                    continue
                child = tie.nodes[1] if tie.nodes[0] == parent else tie.nodes[0]
                if child not in self._seen:
                    self._seen.add(child)
                    self.nodes[child] = self._tied(parent, child, tie.dofs)
                    front.append(child)

    def _tied(self, parent: int, child: int, dofs: frozenset[str]) -> list[Step]:
        free = [k for k in range(3) if DOFS[3 + k] not in dofs]
        if len({"ux", "uy", "uz"} & dofs) not in (0, 3) or len(free) == 2:
            raise CannotRunError(
                f"in large displacement a tie shares all displacements or none, and all rotations, all but one, or "
                f"none; that of nodes {self.model.name(parent)} and {self.model.name(child)} shares {sorted(dofs)}"
            )
        if len(free) == 3:
            return self._own_turns(child)
        steps = self.nodes[parent]
        for k in free:
            if (child, 3 + k) in self._held:
                if steps:
                    raise CannotRunError(
                        f"in large displacement the ground cannot hold the turn of node {self.model.name(child)} about "
                        f"its pin while node {self.model.name(parent)} turns; hold all of its rotations"
                    )
            elif self._linear[6 * child + 3 + k] >= 0:
                turn = Step(number=self._unknown(turn=True), axis=np.eye(3)[k], carrier=parent)
                steps = [*steps, turn]
        return steps


class Places:
    """How the unknowns of a frame move pairs of nodes, and what forces and stiffness of such pairs add to them.

    Attributes
    ----------
    numbers : ndarray of int, shape (p, c)
        Of the unknowns that move each pair; ``size`` for none.
    """

    def __init__(self, chain: KinematicChain, pairs: NDArray[np.int64], size: int) -> None:
        self.size, self.nodes = size, pairs
        depth = max((len(steps) for steps in chain.nodes), default=0)
        own = np.full((len(chain.nodes) + 1, 3 + depth), size)  # the last row is that of the ground, -1
        own[:-1, :3] = np.where(chain.translations >= 0, chain.translations, size)
        for node, steps in enumerate(chain.nodes):
            own[node, 3 : 3 + len(steps)] = [step.number for step in steps]
        self.numbers = own[pairs].reshape(len(pairs), 2 * own.shape[1])
        self._flat = (self.numbers[:, :, None] * (size + 1) + self.numbers[:, None]).ravel()
        self._depth = depth

    def matrices(self, axes: Floats) -> Floats:
        """Return how the unknowns move the nodes.

        Parameters
        ----------
        axes : ndarray, shape (k, 3)
            Present axes of the unknowns.

        Returns
        -------
        ndarray, shape (p, c, 12)
            Displacements and spins of both nodes for each unknown.
        """
        padded = np.vstack([axes, np.zeros((self.size + 1 - len(axes), 3))])
        width = 3 + self._depth
        found = np.zeros((len(self.numbers), 2 * width, 12))
        for end in range(2):
            found[:, end * width : end * width + 3, 6 * end : 6 * end + 3] = np.eye(3)
            turns = slice(end * width + 3, (end + 1) * width)
            found[:, turns, 6 * end + 3 : 6 * end + 6] = padded[self.numbers[:, turns]]
        return found

    def gathered(self, values: Floats) -> Floats:
        """Return the sums over all pairs of what each adds to its unknowns.

        Parameters
        ----------
        values : ndarray, shape (p, c) or (p, c, c)
            Forces, or stiffness.

        Returns
        -------
        ndarray, shape (size,) or (size, size)
            Sums.
        """
        size = self.size
        if values.ndim == 2:
            return np.asarray(np.bincount(self.numbers.ravel(), values.ravel(), size + 1)[:size], dtype=np.float64)
        found = np.bincount(self._flat, values.ravel(), (size + 1) ** 2)
        return np.asarray(found.reshape(size + 1, size + 1)[:size, :size], dtype=np.float64)


def rotations_of(vectors: Floats) -> Floats:
    """Return the rotation matrices of rotation vectors, by Rodrigues' formula.

    Parameters
    ----------
    vectors : ndarray, shape (n, 3)
        [rad].

    Returns
    -------
    ndarray, shape (n, 3, 3)
    """
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    x, y, z = vectors.T
    o = np.zeros_like(x)
    skew = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)
    # np.sinc(t) is sin(πt)/(πt); (1 - cos a)/a² is half the square of sin(a/2)/(a/2).
    half = np.sinc(angle / (2.0 * np.pi))
    return np.asarray(np.eye(3) + np.sinc(angle / np.pi) * skew + 0.5 * half**2 * (skew @ skew))


def changes_of(rotations: Floats) -> Floats:
    """Return rotation matrices less the unit matrix, however small the turns are.

    With the antisymmetric part W = sin t N of a turn by t, R - 1 is W + W²/(1 + cos t). The diagonal of R has lost the
    second term where t² is below its rounding. From a right angle on nothing cancels.

    Parameters
    ----------
    rotations : ndarray, shape (..., 3, 3)

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    cosine = (np.trace(rotations, axis1=-2, axis2=-1)[..., None, None] - 1.0) / 2.0
    skew = (rotations - rotations.swapaxes(-1, -2)) / 2.0
    small = skew + skew @ skew / (1.0 + np.maximum(cosine, 0.0))
    return np.where(cosine > 0.0, small, rotations - np.eye(3))
