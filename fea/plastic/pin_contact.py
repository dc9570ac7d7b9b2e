"""Pins that press on the walls of their holes as contact says, while a body flows.

A pin is rigid, fits, does not rub and does not tilt: two displacements of its own, to which its force belongs. The wall
resists what it would overlap with the pin, by a stiffness of E/d for each unit of its area, and follows no pin that
leaves it. That is a convex energy too, so that a path (``alula.fea.plastic.load_path``) finds its states the same way;
the load that a body bears is free of the stiffness, as it is of E.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.fea.elements.space import UpperHalf
from alula.fea.solvers.solve import Factor

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class PinContact:
    """The walls of all pins.

    Attributes
    ----------
    nodes, pins : ndarray of int, shape (k,)
        Of the mesh, and the number of the pin at each.
    normals : ndarray, shape (k, 3)
        Unit vectors from the pin into the wall, in the plane.
    stiffness : ndarray, shape (k,)
        [N/mm]
    forces : ndarray, shape (p, 2)
        Of the pins on their walls [N].
    """

    nodes: NDArray[np.int64]
    pins: NDArray[np.int64]
    normals: Real
    stiffness: Real
    forces: Real

    @classmethod
    def of(cls, bores: Sequence[tuple[SurfaceQuadrature, PinLoad]], count: int, E: float) -> "PinContact":
        """Return the walls of pins.

        Parameters
        ----------
        bores : sequence of (SurfaceQuadrature, PinLoad)
            Hole and load of each pin at one pose.
        count : int
            Nodes of the mesh.
        E : float
            Of the wall [MPa].

        Returns
        -------
        PinContact
        """
        into = [-bore.load_vector(bore.normals, count).reshape(-1, 3) * [1.0, 1.0, 0.0] for bore, _ in bores]
        areas = [np.linalg.norm(one, axis=1) for one in into]
        at = [np.flatnonzero(area > 1e-9 * area.max()) for area in areas]
        area = np.concatenate([one[nodes] for one, nodes in zip(areas, at, strict=True)])
        return cls(
            nodes=np.concatenate(at),
            pins=np.repeat(np.arange(len(at)), [len(nodes) for nodes in at]),
            normals=np.concatenate([one[nodes] for one, nodes in zip(into, at, strict=True)]) / area[:, None],
            stiffness=area * E / np.repeat([pin.diameter for _, pin in bores], [len(nodes) for nodes in at]),
            forces=np.array([pin.wrench[0, :2] for _, pin in bores]),
        )

    def upper(self, half: UpperHalf) -> "PinContact":
        """Return those of the upper half of a body that is its own image.

        Parameters
        ----------
        half : UpperHalf

        Returns
        -------
        PinContact
        """
        number = np.full(max(half.nodes.max(), half.images.max()) + 1, -1)
        number[half.nodes] = np.arange(len(half.nodes))
        own = number[self.nodes]
        kept = own >= 0
        share = np.where(half.on_plane[own[kept]], 0.5, 1.0)
        return PinContact(
            nodes=own[kept],
            pins=self.pins[kept],
            normals=self.normals[kept],
            stiffness=self.stiffness[kept] * share,
            forces=self.forces / 2.0,
        )

    def overlap(self, u: Real, moved: Real) -> Real:
        """Return by how much walls would overlap with their pins.

        Parameters
        ----------
        u : ndarray, shape (3n,)
            Displacements of the body [mm].
        moved : ndarray, shape (2p,)
            Of the pins [mm].

        Returns
        -------
        ndarray, shape (k,)
            [mm]; negative where they part.
        """
        pin = moved.reshape(-1, 2)[self.pins]
        return np.asarray(((pin - u.reshape(-1, 3)[self.nodes, :2]) * self.normals[:, :2]).sum(axis=1))

    def resist(self, u: Real, moved: Real) -> tuple[Real, Real]:
        """Return the derivatives of the energy of contact.

        Parameters
        ----------
        u, moved : ndarray
            As of ``overlap``.

        Returns
        -------
        tuple of (ndarray, ndarray), shape (3n,) and (2p,)
            By the displacements of the body and of the pins [N].
        """
        push = (self.stiffness * np.maximum(self.overlap(u, moved), 0.0))[:, None] * self.normals
        body, pins = np.zeros((len(u) // 3, 3)), np.zeros((len(self.forces), 2))
        np.add.at(body, self.nodes, -push)
        np.add.at(pins, self.pins, push[:, :2])
        return body.ravel(), pins.ravel()

    def stiffen(self, K: SymmetricBlockMatrix, closed: NDArray[np.bool_], free: NDArray[np.bool_]) -> tuple[Real, Real]:
        """Add the stiffness of walls in contact, and return what couples them to their pins.

        Parameters
        ----------
        K : SymmetricBlockMatrix
            Of the body; changed.
        closed : ndarray of bool, shape (k,)
            Which walls are in contact.
        free : ndarray of bool, shape (3n,)
            Unknowns that are not fixed.

        Returns
        -------
        tuple of (ndarray, ndarray), shape (3n, 2p) and (2p, 2p)
            [N/mm]
        """
        each = np.where(closed, self.stiffness, 0.0)[:, None, None] * self.normals[:, :, None] * self.normals[:, None]
        np.add.at(K.blocks, K.indptr[self.nodes], each)
        count = len(self.forces)
        coupled, own = np.zeros((len(free) // 3, 3, count, 2)), np.zeros((count, 2, count, 2))
        for pin in range(count):
            here = self.pins == pin
            coupled[self.nodes[here], :, pin] = -each[here, :, :2]  # a wall has each of its nodes once
            own[pin, :, pin] = each[here, :2, :2].sum(axis=0)
        return coupled.reshape(-1, 2 * count) * free[:, None], own.reshape(2 * count, 2 * count)


@dataclass(frozen=True, kw_only=True, eq=False)
class Bordered:
    """A factorised stiffness with the pins as a border.

    Attributes
    ----------
    factor : Factor
        Of the body's own.
    coupled : ndarray, shape (3n, 2p)
    own : ndarray, shape (2p, 2p)
    """

    factor: Factor
    coupled: Real
    own: Real

    def solve(self, rhs: Real) -> Real:
        """Return the solution.

        Parameters
        ----------
        rhs : ndarray, shape (3n + 2p,) or (3n + 2p, r)

        Returns
        -------
        ndarray
            As ``rhs``.
        """
        sides, count = rhs.reshape(len(rhs), -1), len(self.coupled)
        solved = self.factor.solve(np.column_stack([self.coupled, sides[:count]]))
        border, body = solved[:, : len(self.own)], solved[:, len(self.own) :]
        pins = np.linalg.solve(self.own - self.coupled.T @ border, sides[count:] - self.coupled.T @ body)
        return np.vstack([body - border @ pins, pins]).reshape(rhs.shape)
