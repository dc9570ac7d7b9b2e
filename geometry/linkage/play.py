"""How far the links of a linkage move by the play of its pins.

The two points of a joint with play c stand apart by an offset anywhere in a circle of radius c/2; of a pin in a slot,
by up to c/2 to either side of it. With the closure r(q, o) = 0 of the unknowns q and offsets o, and one unknown held,

    dq/do = -(dr/dq)^-1 dr/do

so that to first order every joint adds the image of its circle, an ellipse, to where a point may be. The extreme in a
direction u is the sum of c/2 |gradient of u · P by the offset| over the joints (Innocenti, Kinematic clearance
sensitivity analysis of spatial structures with revolute joints, J. Mech. Des. 124, 2002, has the same by virtual work).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.ties import first_largest
from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose_record import CLOSED

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_ITERATIONS = 12
_TARGET = 1e-13
_LARGEST_STEP = 0.5
_DIRECTIONS = np.exp(1j * np.radians(np.arange(0.0, 360.0, 0.5)))
"""In which extremes are sought; between two of them an extreme is 1e-5 larger."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reach:
    """Where a vector may end that varies by play: its nominal value and an ellipse by every joint, to first order.

    Attributes
    ----------
    joints : tuple of str
        Joints with play.
    axes : complex array (joints, 2)
        Conjugate half axes of every joint's ellipse, x + iy; the second is zero for a pin in a slot.
    """

    joints: tuple[str, ...]
    axes: Complex

    def support(self, direction: Complex) -> Real:
        """Return how far the vector may go in directions.

        Parameters
        ----------
        direction : complex array (n,)
            Unit vectors.

        Returns
        -------
        array (n,)
        """
        along = (np.conj(direction)[:, None, None] * self.axes).real
        return np.asarray(np.sqrt((along**2).sum(axis=-1)).sum(axis=-1))

    def largest(self, nominal: complex = 0.0) -> float:
        """Return the largest size that the vector may have.

        Parameters
        ----------
        nominal : complex, optional
            Its value without play.

        Returns
        -------
        float
        """
        return float(np.max(self._extents(nominal)))

    def least(self, nominal: complex) -> float:
        """Return the least size that the vector may have.

        Parameters
        ----------
        nominal : complex
            Its value without play.

        Returns
        -------
        float
        """
        beyond = (np.conj(_DIRECTIONS) * nominal).real - self._supports
        return max(0.0, float(np.max(beyond)))

    def _extents(self, nominal: complex) -> Real:
        return np.asarray((np.conj(_DIRECTIONS) * nominal).real + self._supports)

    @cached_property
    def _supports(self) -> Real:
        return self.support(_DIRECTIONS)

    def shares(self, nominal: complex = 0.0) -> dict[str, Real]:
        """Return what every joint does where the vector is largest.

        Parameters
        ----------
        nominal : complex, optional
            Its value without play.

        Returns
        -------
        dict of str to array (2,)
            Joint -> shares of its two half axes, together of size 1 (zeros where it adds nothing).
        """
        direction = _DIRECTIONS[first_largest(self._extents(nominal))]
        along: Real = (np.conj(direction) * self.axes).real
        sizes = np.linalg.norm(along, axis=-1, keepdims=True)
        shares = np.divide(along, sizes, out=np.zeros_like(along), where=sizes > 0.0)
        return dict(zip(self.joints, shares, strict=True))


@dataclass(frozen=True, kw_only=True, eq=False)
class LooseJoints:
    """The joints with play of a linkage at one pose, or at n of them.

    Attributes
    ----------
    place : Placement
        Where the links stand without play.
    radii : mapping of str to float
        Joint -> half of its play [mm].
    held : array (k, unknowns)
        Combinations of unknowns that stay, such as that of the drive.
    """

    place: Placement
    radii: Mapping[str, float]
    held: Real

    def directions(self, name: str) -> tuple[complex, ...]:
        """Return the unit offsets of a joint: x and y, or across its slot in the frame of the first link.

        Parameters
        ----------
        name : str
            Of the joint.

        Returns
        -------
        tuple of complex
        """
        joint = self.place.linkage.joints[name]
        return (complex(1j * np.exp(1j * joint.direction)),) if joint.slides else (1.0, 1j)

    @cached_property
    def _sizes(self) -> Real:
        moving, closure = len(self.place.linkage.moving), self.place.closure
        return np.array([1.0] * moving + [self.place.linkage.longest] * len(closure.slots))

    def _matrix(self, closure: LoopClosure, q: Real) -> Real:
        """Jacobian (..., equations, unknowns) without dimensions, with the rows that hold the linkage."""
        found = closure.jacobian(q) * (self._sizes / closure.linkage.longest)
        rows = np.broadcast_to(self.held * self._sizes, (*q.shape[:-1], *self.held.shape))
        return np.concatenate([found, rows], axis=-2)

    def _sign(self, matrix: Real) -> Real:
        """Sign (...) of the determinant: 0 of matrices that are singular, 1 of those that are not square."""
        square = matrix.shape[-1] == matrix.shape[-2]
        return np.asarray(np.linalg.slogdet(matrix)[0] if square else np.ones(matrix.shape[:-2]))

    def _solved(self, matrix: Real, right: Real) -> Real:
        if matrix.shape[-1] != matrix.shape[-2]:
            return np.asarray((np.linalg.pinv(matrix, rcond=1e-12) @ right[..., None])[..., 0]) * self._sizes
        return np.linalg.solve(matrix, right[..., None])[..., 0] * self._sizes

    def _right(self, gaps: Real, off: Real) -> Real:
        return np.concatenate([gaps / self.place.linkage.longest, off], axis=-1)

    @cached_property
    def rates(self) -> Mapping[str, tuple[Complex, ...]]:
        """Joint -> derivative (..., points) of every point of ``closure.point_names`` by each of its offsets."""
        place, closure = self.place, self.place.closure
        matrix, by_unknowns = self._plain, closure.point_rates(place.q)
        found = {}
        for name in self.radii:
            each = []
            for direction in self.directions(name):
                gaps, points = closure.loosened(place.q, name, direction)
                turned = self._solved(matrix, self._right(-gaps, np.zeros((*place.shape, len(self.held)))))
                each.append(points + (by_unknowns @ turned[..., None])[..., 0])
            found[name] = tuple(each)
        return found

    def reach(self, link: str, point: str) -> Reach:
        """Return where a point may be, about its place without play; of one pose.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        Reach
            [mm]
        """
        number = self.place.closure.point_names.index((link, point))
        return self.reach_of({name: tuple(rate[number] for rate in rates) for name, rates in self.rates.items()})

    def reach_of(self, rates: Mapping[str, tuple[Complex, ...]]) -> Reach:
        """Return where a vector may end.

        Parameters
        ----------
        rates : mapping of str to tuple of complex
            Joint -> derivative by each of its offsets [1/mm].

        Returns
        -------
        Reach
            In the unit of the vector.
        """
        axes = np.zeros((len(self.radii), 2), dtype=complex)
        for i, (name, radius) in enumerate(self.radii.items()):
            axes[i, : len(rates[name])] = radius * np.array(rates[name])
        return Reach(joints=tuple(self.radii), axes=axes)

    def outline(self, link: str, point: str) -> Complex:
        """Return the outline of where a point may be, about its place without play, to first order.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        complex array (..., directions)
            x + iy of the places that lie furthest in each of ``_DIRECTIONS`` [mm].
        """
        number = self.place.closure.point_names.index((link, point))
        found = np.zeros((*self.place.shape, len(_DIRECTIONS)), dtype=complex)
        for name, radius in self.radii.items():
            rates = np.stack([rate[..., number, None] for rate in self.rates[name]])
            along = (np.conj(_DIRECTIONS) * rates).real
            size = np.sqrt((along**2).sum(axis=0))
            found += radius * (rates * np.divide(along, size, out=np.zeros_like(along), where=size > 0.0)).sum(axis=0)
        return found

    def spread(self, link: str, point: str, displacement: complex = 0.0) -> tuple[float, float]:
        """Return how far a point may stand at the least and at the most from its place without load and play.

        Parameters
        ----------
        link, point : str
            Their names.
        displacement : complex, optional
            By all else but play [mm].

        Returns
        -------
        tuple of (float, float)
            [mm]; the larger end is infinite where the linkage does not close there.
        """
        reach = self.reach(link, point)
        least, most = reach.least(displacement), reach.largest(displacement)
        both = {name: np.outer([1.0, -1.0], share) for name, share in reach.shares(displacement).items()}
        place, closed = self.moved(self.offsets(both))  # without displacement both are alike to first order alone
        if not closed.all():
            return least, np.inf
        solved = place.position(link, point) - self.place.position(link, point)
        return least, max(most, *np.abs(displacement + solved).tolist())

    def offsets(self, shares: Mapping[str, Real]) -> dict[str, Complex]:
        """Return offsets of joints from shares of half of their play.

        Parameters
        ----------
        shares : mapping of str to array (..., 1 or 2)
            Joint -> its shares in each of ``directions``.

        Returns
        -------
        dict of str to complex array (...)
            [mm]
        """
        along = {name: np.array(self.directions(name)) for name in shares}
        return {name: self.radii[name] * (x[..., : len(along[name])] @ along[name]) for name, x in shares.items()}

    def at_rims(self, slopes: Mapping[str, Real]) -> dict[str, Complex]:
        """Return offsets by half of their play along slopes.

        Parameters
        ----------
        slopes : mapping of str to array (..., 1 or 2)
            Joint -> slopes in each of ``directions``.

        Returns
        -------
        dict of str to complex array (...)
            [mm]; none at a joint without slope.
        """
        sizes = {name: np.linalg.norm(slope, axis=-1, keepdims=True) for name, slope in slopes.items()}
        return self.offsets({n: slope / np.where(sizes[n] > 0.0, sizes[n], 1.0) for n, slope in slopes.items()})

    @property
    def ways(self) -> tuple[tuple[str, int], ...]:
        """Joint and number of its direction for each of the k ways in which one joint may stand off."""
        return tuple((name, i) for name in self.radii for i in range(len(self.directions(name))))

    def one_by_one(self, sizes: Mapping[str, float]) -> dict[str, Complex]:
        """Return offsets of one joint at a time, in each of ``ways`` to one side and to the other.

        Parameters
        ----------
        sizes : mapping of str to float
            Joint -> size of its offset [mm].

        Returns
        -------
        dict of str to complex array (2 k,)
            [mm]
        """
        found = {}
        for name in self.radii:
            along = [self.directions(at)[i] if at == name else 0.0 for at, i in self.ways]
            found[name] = sizes[name] * np.outer(along, [1.0, -1.0]).ravel()
        return found

    def moved(self, offsets: Mapping[str, complex | Complex]) -> tuple[Placement, NDArray[np.bool_]]:
        """Assemble the linkage with the points of its joints apart.

        Parameters
        ----------
        offsets : mapping of str to complex or complex array (...)
            As ``LoopClosure.offsets`` [mm]; of shapes that go with that of the poses, as (k, 1) with (n,).

        Returns
        -------
        tuple of (Placement, bool array (...))
            Where the links stand then, at rest; and where that is so: elsewhere the linkage does not close on its
            branch, since a dead point lies on the way.
        """
        place = self.place
        shape = np.broadcast_shapes(place.shape, *map(np.shape, offsets.values()))
        closure = LoopClosure(place.linkage, offsets={n: np.broadcast_to(o, shape)[()] for n, o in offsets.items()})
        q = np.broadcast_to(place.q, (*shape, closure.unknowns)).copy()
        for _ in range(_ITERATIONS):
            gaps, off = closure.residual(q), (place.q - q) @ self.held.T
            if max(np.abs(gaps).max(initial=0.0) / place.linkage.longest, np.abs(off).max(initial=0.0)) <= _TARGET:
                break
            matrix = self._matrix(closure, q)
            regular = (self._sign(matrix) != 0.0)[..., None]  # states at a dead point stay there
            matrix = np.where(regular[..., None], matrix, np.eye(*matrix.shape[-2:]))
            step = np.where(regular, self._solved(matrix, self._right(-gaps, off)) / self._sizes, 0.0)
            q = q + np.clip(np.nan_to_num(step), -_LARGEST_STEP, _LARGEST_STEP) * self._sizes
        closed = np.abs(closure.residual(q)).max(axis=-1, initial=0.0) <= CLOSED * place.linkage.longest
        rows = None if place.rows is None else np.broadcast_to(place.rows, shape)
        same_branch = self._sign(self._matrix(closure, q)) == self._sign(self._plain)
        return Placement(closure=closure, q=q, rows=rows, among=place.whole.q), closed & same_branch

    @cached_property
    def _plain(self) -> Real:
        """The matrix without play."""
        return self._matrix(self.place.closure, self.place.q)
