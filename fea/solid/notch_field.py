"""Stress ahead of notches in a brittle solid: at a depth, its mean along a line, and over the loaded volume.

From a place of the surface the line runs where the largest principal stress falls most, in the plane that this stress
opens: at a smooth place inwards along the normal, at the rim of a hole along its face. Where it would leave the solid
beside a rim it takes the steepest of some directions that stay in it. Where stress is even or falls straight, as in
bending, or no line stays in the solid, the surface stress stands.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.elasticity import basis_at
from alula.fea.elements.space import DisplacementSpace
from alula.fea.solid.stress import PAIRS, StressField, extreme_principal
from alula.geometry.materials.brittle_notch import NotchStrength

Real = NDArray[np.float64]
Nodes = NDArray[np.int64]

EVEN = 0.01
"""Change over a line, relative to the stress where it begins, below which stress is even, or falls straight."""
WALL = np.array([2.0, 3.0, 4.0, 6.0, 8.0])
"""Depths over the length of a line at which the rest of the wall is looked at: the first must lie in the solid."""
OUTSIDE = 0.02
"""Share of an element by which a point may lie beyond it: chords of curved sides, and lines along a face."""
FITTED = 40
"""Nodes to which a parabola is fitted for the slope of a stress: some two layers of quadratic elements about a node."""
_NEAR, _FAR = 24, 200
"""Elements, by their centres, in which a point is looked for, first and again where it is in none: sizes may differ."""
_TRIED = 4
"""Of these, the likeliest by their corners, whose curved shape is looked at."""
SPACING = 0.25
"""Edge of cubes, over the critical distance, in each of which the most stressed place alone is looked at."""
_BATCH = 64
_AROUND = np.arange(12) * np.pi / 6.0
"""Directions that are tried where the steepest one leaves the solid, the first along the face it leaves [rad]."""
_STEPS = 3
"""Of Newton's method to the point of a curved element; the first one is exact in a straight one."""
_U, _W = (lambda points: ((points[0] + 1.0) / 2.0, points[1] / 2.0))(np.polynomial.legendre.leggauss(8))


def line_depths(distance: float) -> tuple[Real, Real]:
    """Return points of a line of 2 L from a notch, and weights of the mean along it.

    With r = 2 L u² Gauss's rule in u has the mean of a crack's 1/√r exactly.

    Parameters
    ----------
    distance : float
        L [mm].

    Returns
    -------
    tuple of 2 ndarray, shape (8,)
        Depths [mm] and weights, of sum 1.
    """
    return 2.0 * distance * _U**2, 2.0 * _U * _W


@dataclass(frozen=True, kw_only=True, eq=False)
class NotchStress:
    """Stress ahead of the place where a notch comes nearest to breaking, by one method.

    Attributes
    ----------
    node : int
        Of the surface, from which the line begins.
    surface : float
        There [MPa].
    ahead : float
        At L/2, or the mean over 2 L [MPa]; the surface stress where the line does not count.
    plain : float
        What the surface would have without a notch: stress at the end of the line and in the wall behind it, in a
        straight line back to the surface [MPa].
    use : float
        Share of the strength that is used up.
    elements : ndarray of int
        In which the stress was taken.
    counts : bool
        False where stress is even or falls straight, or no line stays in the solid.
    """

    node: int
    surface: float
    ahead: float
    plain: float
    use: float
    elements: Nodes
    counts: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class NotchField:
    """The stress of one solution, at any point.

    Attributes
    ----------
    field : StressField
    """

    field: StressField

    @cached_property
    def surface(self) -> Real:
        """Largest principal stress (n,) at all nodes [MPa]."""
        return extreme_principal(self.field.nodal)[0]

    def _places(self, apart: float) -> Nodes:
        """Return nodes of the surface in tension, the most stressed first, one in each cube of some edge [mm]."""
        nodes = np.unique(self.field.space.boundary)
        nodes = nodes[np.argsort(-self.surface[nodes], kind="stable")]
        nodes = nodes[self.surface[nodes] > 0.0]
        _, first = np.unique(np.floor(self.field.space.nodes[nodes] / apart), axis=0, return_index=True)
        return np.asarray(nodes[np.sort(first)])

    @cached_property
    def _finder(self) -> Callable[[Real], tuple[Nodes, Real]]:
        return element_finder(self.field.space)

    @cached_property
    def _nodes_near(self) -> Callable[[int], Nodes]:
        from scipy.spatial import cKDTree

        nodes = self.field.space.nodes
        tree, count = cKDTree(nodes), min(FITTED, len(nodes))
        return lambda node: np.asarray(tree.query(nodes[node], k=count)[1])

    def at(self, points: Real) -> tuple[Real, Nodes]:
        """Return the stress at points.

        Parameters
        ----------
        points : ndarray, shape (k, 3)
            [mm]

        Returns
        -------
        tuple of 2 ndarray
            Components (k, 6) [MPa], NaN outside, and the elements (k,), -1 outside.
        """
        element, place = self._finder(points)
        inside = element >= 0
        found = np.full((len(points), 6), np.nan)
        phi, _ = basis_at(self.field.space, place[inside].T)
        nodal = self.field.nodal[self.field.space.cells[element[inside]]]
        found[inside] = np.einsum("kb,kbi->ki", phi, nodal)
        return found, element

    @cached_property
    def _slopes(self) -> dict[int, Real]:
        return {}

    def fall(self, node: int) -> Real:
        """Return how the largest principal stress falls from a node of the surface: along this, and so much a length.

        Parameters
        ----------
        node : int

        Returns
        -------
        ndarray, shape (3,)
            In the plane that the stress opens [MPa/mm].
        """
        if node not in self._slopes:
            space, near = self.field.space, self._nodes_near(node)
            offset = space.nodes[near] - space.nodes[node]
            terms = np.column_stack([offset, *(offset[:, i] * offset[:, j] for i, j in PAIRS)])
            slope = np.linalg.lstsq(terms, self.surface[near] - self.surface[node], rcond=None)[0][:3]
            plane = self._axes(node)[:, :2]
            self._slopes[node] = -plane @ (plane.T @ slope)
        return self._slopes[node]

    def _axes(self, node: int) -> Real:
        """Return the directions (3, 3) of the principal stresses of a node, that of the largest last."""
        tensor = np.empty((3, 3))
        for (i, j), value in zip(PAIRS, self.field.nodal[node], strict=True):
            tensor[i, j] = tensor[j, i] = value
        return np.asarray(np.linalg.eigh(tensor)[1])

    def _across(self, node: int) -> Real:
        """Return two unit vectors (2, 3) across the pull at a node: where stress falls without leaving, and beside.

        What leads out of a face there is taken off, and what leads less than 30° into it: a thin plate soon ends.
        """
        space, axes, way = self.field.space, self._axes(node), self.fall(node)
        steep = np.linalg.norm(way)
        faces = space.nodes[space.boundary[(space.boundary == node).any(axis=1), :3]]
        for normal in np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]):
            out = normal / np.linalg.norm(normal)
            if way @ out > -steep / 2.0:
                way = way - way @ out * out
        way = axes[:, :2] @ (axes[:, :2].T @ way)
        size = np.linalg.norm(way)
        first = way / size if size > 0.0 else axes[:, 0]
        return np.array([first, np.cross(axes[:, 2], first)])

    def _along(self, nodes: Nodes, ways: Real, depths: Real) -> tuple[Real, Real, Nodes]:
        """Return stress, that in the direction of its largest at the node, and elements (k, d) along lines."""
        points = self.field.space.nodes[nodes][:, None] + depths[None, :, None] * ways[:, None]
        components, element = self.at(points.reshape(-1, 3))
        components = components.reshape(len(nodes), -1, 6)
        pulled = np.array([self._axes(int(node))[:, 2] for node in nodes])
        shares = np.column_stack([(1.0 if i == j else 2.0) * pulled[:, i] * pulled[:, j] for i, j in PAIRS])
        own = np.einsum("kdi,ki->kd", components, shares)
        return extreme_principal(components)[0], own, element.reshape(len(nodes), -1)

    def _turned(self, nodes: Nodes, depths: Real, weights: Real) -> tuple[Real, Real, Nodes]:
        """Return what ``_along`` does, along the steepest of some directions that stay in the solid, if any does."""
        around = np.column_stack([np.cos(_AROUND), np.sin(_AROUND)])
        ways = np.array([around @ self._across(int(node)) for node in nodes]).reshape(-1, 3)
        stress, own, element = self._along(np.repeat(nodes, len(around)), ways, depths)
        stays = (element[:, : len(weights) + 3] >= 0).all(axis=1)
        mean = np.where(stays, stress[:, 1 : len(weights) + 1] @ weights, np.inf).reshape(-1, len(around))
        best = np.argmin(mean, axis=1) + len(around) * np.arange(len(nodes))
        return stress[best], own[best], element[best]

    def worst(self, strength: NotchStrength) -> tuple[NotchStress, NotchStress] | None:
        """Return where the surface comes nearest to breaking, by the point and by the line method.

        A place uses up the larger of two shares: of the inherent strength by what is ahead of it, and of the tensile
        strength by what a plain section would have, straight through the end of the line and the wall behind it.
        Places are looked at all over the surface where its stress is larger than what was found.

        Parameters
        ----------
        strength : NotchStrength

        Returns
        -------
        tuple of 2 NotchStress, or None
            None where nothing is in tension.
        """
        length = 2.0 * strength.distance
        depths, weights = line_depths(strength.distance)
        depths = np.concatenate([[strength.distance / 2.0], depths, [length], length * WALL])
        end = len(weights) + 1
        best, weaker = list[NotchStress](), min(strength.inherent, strength.ultimate)
        places = self._places(SPACING * strength.distance)
        for first in range(0, len(places), _BATCH):
            nodes = places[first : first + _BATCH]
            if best and self.surface[nodes[0]] / weaker <= min(one.use for one in best):
                break
            falls = np.array([self.fall(int(node)) for node in nodes])
            steep = np.linalg.norm(falls, axis=1)
            even = steep * length <= EVEN * self.surface[nodes]
            ways = falls / np.where(even, np.inf, steep)[:, None]
            stress, own, element = self._along(nodes, ways, depths)
            left = np.flatnonzero((element[:, : end + 2] < 0).any(axis=1))
            if len(left):
                stress[left], own[left], element[left] = self._turned(nodes[left], depths, weights)
            inside = np.logical_and.accumulate(element >= 0, axis=1).sum(axis=1)
            last = np.maximum(inside - 1, end + 1)
            fall = own[:, end] - own[np.arange(len(nodes)), last]
            plain = stress[:, end] + np.maximum(fall, 0.0) / (depths[last] / length - 1.0)
            counts = ~even & (inside > end + 1) & (plain < (1.0 - EVEN) * self.surface[nodes])
            for k, node in enumerate(nodes):
                used = element[k, [*range(end + 1), last[k]]]
                every = [
                    self._place(int(node), float(ahead), float(plain[k]), used, strength, bool(counts[k]))
                    for ahead in (stress[k, 0], weights @ stress[k, 1:end])
                ]
                best = [max(pair, key=lambda one: one.use) for pair in zip(best or every, every, strict=True)]
        return (best[0], best[1]) if best else None

    def _place(
        self, node: int, ahead: float, plain: float, elements: Nodes, strength: NotchStrength, counts: bool
    ) -> NotchStress:
        surface = float(self.surface[node])
        if not counts:
            beside = np.flatnonzero((self.field.space.cells == node).any(axis=1))
            use, ahead, plain, elements = surface / strength.ultimate, surface, surface, beside
        else:
            use = max(ahead / strength.inherent, plain / strength.ultimate)
        return NotchStress(
            node=node, surface=surface, ahead=ahead, plain=plain, use=use, elements=np.unique(elements), counts=counts
        )

    def effective_volume(self, modulus: float) -> float:
        """Return the volume that, evenly under the largest stress, breaks as often: ∫ (σ1/max σ1)^m dV.

        Parameters
        ----------
        modulus : float
            Weibull's m.

        Returns
        -------
        float
            [mm³]

        References
        ----------
        Weibull, A statistical theory of the strength of materials, 1939: σ_a/σ_b = (V_b/V_a)^(1/m).
        """
        share = np.maximum(extreme_principal(self.field.at_points)[0], 0.0) / self.surface.max()
        return float((self.field.weights * share**modulus).sum())


def element_finder(space: DisplacementSpace) -> Callable[[Real], tuple[Nodes, Real]]:
    """Return a function that finds points in the elements of a mesh.

    Parameters
    ----------
    space : DisplacementSpace

    Returns
    -------
    callable
        Points (k, 3) [mm] -> elements (k,), -1 where a point is in none, and places (k, 3) in the unit tetrahedron.
    """
    from scipy.spatial import cKDTree

    corners = space.nodes[space.cells[:, :4]]
    tree = cKDTree(corners.mean(axis=1))
    straight = np.linalg.inv((corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1))

    def among(points: Real, count: int) -> tuple[Nodes, Real]:
        near = tree.query(points, k=min(count, len(corners)))[1].reshape(len(points), -1)
        place = np.einsum("knij,knj->kni", straight[near], points[:, None] - corners[near, 0])
        if space.order == 2:
            few = np.argsort(-_margin(place), axis=1)[:, :_TRIED]
            near, place = np.take_along_axis(near, few, axis=1), np.take_along_axis(place, few[..., None], axis=1)
            k, n = np.nonzero(space.curved[near])
            nodes, at = space.nodes[space.cells[near[k, n]]], place[k, n]
            for _ in range(_STEPS):
                phi, gradient = basis_at(space, at.T)
                gap = points[k] - np.einsum("kb,kbi->ki", phi, nodes)
                at = at + np.linalg.solve(np.einsum("kbj,kbi->kij", gradient, nodes), gap[..., None])[..., 0]
            place[k, n] = at
        best = np.argmax(_margin(place), axis=1)[:, None]
        place = np.take_along_axis(place, best[..., None], axis=1)[:, 0]
        element = np.take_along_axis(near, best, axis=1)[:, 0]
        return np.where(_margin(place) >= -OUTSIDE, element, -1), place

    def find(points: Real) -> tuple[Nodes, Real]:
        element, place = among(points, _NEAR)
        lost = element < 0
        if lost.any():
            element[lost], place[lost] = among(points[lost], _FAR)
        return element, place

    return find


def _margin(place: Real) -> Real:
    """Least barycentric coordinate of places (..., 3): negative outside."""
    return np.asarray(np.minimum(place.min(axis=-1), 1.0 - place.sum(axis=-1)))
