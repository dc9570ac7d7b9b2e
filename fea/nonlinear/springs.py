"""What the springs of a frame add to its equilibrium on the deformed shape, beside their forces as it stands."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.spring import FrameSpring, turn_about_z
from alula.fea.nonlinear.kinematic_chain import KinematicChain

Floats = NDArray[np.float64]
ABOUT_Z = np.array([0.0, 0.0, 1.0])


class SpringForces:
    """Springs on the nodes of a frame.

    Parameters
    ----------
    springs : sequence of FrameSpring
    chain : KinematicChain
        The unknowns of the frame.
    """

    def __init__(self, springs: Sequence[FrameSpring], chain: KinematicChain) -> None:
        self.springs, self.chain = springs, chain

    def changes(self, displacements: Floats, rotations: Floats, factor: float) -> Iterator[tuple[FrameSpring, Floats]]:
        """Yield every spring with what it does to its points more than as the frame stands.

        Parameters
        ----------
        displacements : ndarray, shape (n, 3)
            Of the nodes [mm].
        rotations : ndarray, shape (n, 3, 3)
            Of the nodes.
        factor : float
            Share of the loads.

        Yields
        ------
        tuple of FrameSpring and ndarray, shape (k, 6)
            Wrenches on its k points, global axes [N, N mm].
        """
        for spring in self.springs:
            found = np.zeros((len(spring.nodes), 6))
            found[:, [0, 1, 5]] = -spring.resists(*_moved(spring, displacements, rotations), factor)[0]
            yield spring, found

    def tangent(self, displacements: Floats, rotations: Floats, axes: Floats, factor: float) -> Floats:
        """Return the derivative of what they resist by the unknowns, but for what moments gain about pins.

        Parameters
        ----------
        displacements : ndarray, shape (n, 3)
            Of the nodes [mm].
        rotations : ndarray, shape (n, 3, 3)
            Of the nodes.
        axes : ndarray, shape (count, 3)
            Present axes of the unknowns.
        factor : float
            Share of the loads.

        Returns
        -------
        ndarray, shape (count, count)
        """
        found = np.zeros((self.chain.count, self.chain.count))
        for spring in self.springs:
            ways = self._ways(spring, axes)
            found += ways.T @ spring.resists(*_moved(spring, displacements, rotations), factor)[1] @ ways
        return found

    def _ways(self, spring: FrameSpring, axes: Floats) -> Floats:
        """Return the derivatives (3 k, count) of ux, uy and rotation of a spring's ends by the unknowns."""
        found = np.zeros((len(spring.nodes), 3, self.chain.count))
        for way, node in zip(found, spring.nodes, strict=True):
            if node is not None:
                for axis, number in enumerate(self.chain.translations[node][:2]):
                    if number >= 0:
                        way[axis, number] = 1.0
                numbers = [step.number for step in self.chain.nodes[node]]
                np.add.at(way[2], numbers, axes[numbers] @ ABOUT_Z)
        return found.reshape(-1, self.chain.count)


def _moved(spring: FrameSpring, displacements: Floats, rotations: Floats) -> tuple[Floats, Floats]:
    """Return displacements (k, 2) and turns (k,) of a spring's ends."""
    moved = [np.zeros(2) if node is None else displacements[node, :2] for node in spring.nodes]
    turns = [0.0 if node is None else turn_about_z(rotations[node]) for node in spring.nodes]
    return np.array(moved), np.array(turns)
