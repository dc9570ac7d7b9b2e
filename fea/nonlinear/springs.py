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
            if spring.turns:
                moment = spring.stiffness * _turned(spring, rotations)
                found[:, 5] = moment, -moment
            else:
                found[:, :2] = -spring.pull(_moved(spring, displacements), factor)[1]
            yield spring, found

    def tangent(self, displacements: Floats, axes: Floats, factor: float) -> Floats:
        """Return the derivative of what they resist by the unknowns, but for what moments gain about pins.

        Parameters
        ----------
        displacements : ndarray, shape (n, 3)
            Of the nodes [mm].
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
            if spring.turns:
                way = np.zeros(self.chain.count)
                for node, sense in zip(spring.nodes, (-1.0, 1.0), strict=True):
                    if node is not None:
                        numbers = [step.number for step in self.chain.nodes[node]]
                        np.add.at(way, numbers, sense * (axes[numbers] @ ABOUT_Z))
                found += spring.stiffness * np.outer(way, way)
            else:
                stiffness = spring.pull(_moved(spring, displacements), factor)[2]
                rows = [[-1, -1] if n is None else self.chain.translations[n][:2] for n in spring.nodes]
                places = np.array(rows, dtype=np.int64).ravel()
                free = np.flatnonzero(places >= 0)
                np.add.at(found, np.ix_(places[free], places[free]), stiffness[np.ix_(free, free)])
        return found


def _moved(spring: FrameSpring, displacements: Floats) -> Floats:
    return np.array([np.zeros(2) if node is None else displacements[node, :2] for node in spring.nodes])


def _turned(spring: FrameSpring, rotations: Floats) -> float:
    first, second = (0.0 if node is None else turn_about_z(rotations[node]) for node in spring.nodes)
    return second - first
