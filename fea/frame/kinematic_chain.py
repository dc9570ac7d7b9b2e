"""Finite rotations of the nodes of a frame: who turns with whom, and about which axes.

Tied nodes form trees. The rotation of a tied node is that of its parent, followed by a turn about the pin's axis,
which the parent carries along. Virtual spins of a node are so the sum of the spins of its chain of steps, each about
its present axis. Displacements are shared or are not, apart from that: a slider turns with what carries it and moves by
itself.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.frame.model import DOFS, FrameModel
from fea.frame.system import FrameSystem
from geometry.base.errors import CannotRunError

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


def present_axes(steps: list[Step], rotations: Floats) -> Floats:
    """Return the present axes of the steps of a chain.

    Parameters
    ----------
    steps : list of Step
        Of a chain.
    rotations : ndarray, shape (n, 3, 3)
        Of the nodes.

    Returns
    -------
    ndarray, shape (k, 3)
        Axes.
    """
    return np.array([s.axis if s.carrier is None else rotations[s.carrier] @ s.axis for s in steps]).reshape(-1, 3)


def turned(steps: list[Step], axes: Floats, increments: Floats, rotation: Floats) -> Floats:
    """Return the rotation at the end of a chain after its steps' increments; free turns first, then the pins.

    Parameters
    ----------
    steps : list of Step
        Of a chain.
    axes : ndarray, shape (k, 3)
        Of these steps.
    increments : ndarray
        Of all unknowns [rad].
    rotation : ndarray, shape (3, 3)
        Before.

    Returns
    -------
    ndarray, shape (3, 3)
        Rotation after.
    """
    from scipy.spatial.transform import Rotation

    spins: list[Floats] = []
    for step, axis in zip(steps, axes, strict=True):
        spin = axis * increments[step.number]
        if step.carrier is None and spins:
            spins[0] = spins[0] + spin
        else:
            spins.append(spin)
    for spin in reversed(spins):
        rotation = Rotation.from_rotvec(spin).as_matrix() @ rotation
    return rotation
