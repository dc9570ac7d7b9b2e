"""What pins in their holes make of growth: on rims, links bear more on the deformed shape than with pressed pins.

Frames that deform have tight pins (``alula.fea.nonlinear.large_displacement``). Each state of the pins is solved once
more with the geometric stiffness K_g of its own forces: where they stand then is the least of the same programme
(``alula.fea.pins.programme``) with K + λ K_g of the frame, condensed to the rims. Its matrix may have negative
eigenvalues, as forces drive pins away from where they stand, up to their rims: it is parted into one without and the
rest, whose slope is taken where pins stand, again and again (the concave-convex procedure: Yuille & Rangarajan, Neural
Computation 15, 2003; the energy falls in each step).

Growth on running pins over that on tight ones is what the bands of tight growth leave out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.nonlinear.on_rims import Condensed, divided
from alula.fea.nonlinear.stability import COARSE_SUBDIVISIONS
from alula.fea.pins.holes import Hole
from alula.fea.pins.programme import least_in_discs
from alula.fea.pins.states import LEAST_RADIUS, PinStates

Floats = NDArray[np.float64]

SOURCE = Source(kind=SourceKind.GROWTH, detail=reason("growth_on_rims"))
SETTLED = 1e-3
"""Share of the widest disc by which a step moves pins that have settled."""
CLOSE = 1e-8
"""Residual at which forces are known to 1e-6."""
MOST_STEPS = 50
"""Of pins that settle; those of five drawn linkages and two built-in cases took 5 to 14."""


@dataclass(frozen=True, kw_only=True)
class RimGrowth:
    """What pins in their holes make of stresses on the deformed shape, beside what tight pins make of them.

    Attributes
    ----------
    links : mapping of str to Scatter
        Link with a beam -> of its stress.
    pins : mapping of str to Scatter
        Joint -> of the stress of its pin.
    farther : Farther
        How much farther nodes move.
    """

    links: Mapping[str, Scatter]
    pins: Mapping[str, Scatter]
    farther: "Farther"


@dataclass(frozen=True, kw_only=True, eq=False)
class Farther:
    """Where nodes stand on the deformed shape with pins in their holes, beside the growth of tight pins.

    In a state whose forces have the geometric stiffness K_g a node moves by u(K_g) + R(K_g) v, with v in the discs.
    Bands hold u(K_g of tight pins) + R(0) v; beyond these are at most

        |u(K_g) - u(K_g of tight pins)| + Σ r_i |R_i(K_g) - R_i(0)|,

    with the largest that a unit shift at rim i makes of the node, in any direction.

    Attributes
    ----------
    nodes : mapping of int to int
        Node of the frame -> its row below.
    holes : tuple of Hole
    tight : ndarray, shape (n, s)
        The first term, of each of s states [mm].
    by_rims : ndarray, shape (n, s, h, 2)
        |R_i(K_g) - R_i(0)| of the lower and the upper rim of each hole.
    rests : ndarray, shape (n, s, 3)
        R(K_g) v where pins rest [mm].
    """

    nodes: Mapping[int, int]
    holes: tuple[Hole, ...]
    tight: Floats
    by_rims: Floats
    rests: Floats

    def most(self, node: int, radii: Mapping[tuple[str, str], float]) -> float:
        """Return how much farther a node moves at most, in any places of the pins.

        Parameters
        ----------
        node : int
        radii : mapping of (str, str) to float
            Joint and link -> radius of the discs at both rims of the hole [mm].

        Returns
        -------
        float
            [mm]; infinite where nothing is known, since the frame is unstable by linear theory.
        """
        row, r = self.nodes[node], [max(radii.get((x, h.link), 0.0) for x in h.joints) for h in self.holes]
        return float((self.tight[row] + self.by_rims[row].sum(axis=2) @ np.array(r)).max())

    def least(self, node: int, elastic: Sequence[Floats]) -> float:
        """Return how far a node moves at least, where pins rest.

        Parameters
        ----------
        node : int
        elastic : sequence of ndarray, shape (3,)
            What it may move with tight pins [mm].

        Returns
        -------
        float
            [mm]; 0 where nothing is known.
        """
        row = self.nodes[node]
        moved = [np.linalg.norm(one + self.rests[row], axis=1) - self.tight[row] for one in elastic]
        return max(float(np.min(moved)), 0.0)


@lru_cache(maxsize=64)
def rim_growth(pins: PinStates, factor: float) -> RimGrowth:
    """Return what pins in their holes make of stresses on the deformed shape.

    Parameters
    ----------
    pins : PinStates
    factor : float
        Largest load over modulus, over what it is.

    Returns
    -------
    RimGrowth
        From 0 to infinity where the frame is unstable by linear theory: nothing is known of it then.
    """
    path = divided(pins, COARSE_SUBDIVISIONS)
    rims, plain, ends = path.rims, path.condensed(), path.rims.beam_ends
    radii, stood = pins.standing
    stood = np.vstack([np.zeros(stood.shape[1]), stood])  # first with tight pins
    pressed = [path.condensed(rims.solved.solved(rims.opened @ v), factor) for v in stood]
    owners = tuple(dict.fromkeys(ends.owners))
    nodes = sorted(set(rims.frame.points.values()))
    numbers = {node: row for row, node in enumerate(nodes)}
    if plain is None or None in pressed:
        lost = Farther(
            nodes=numbers,
            holes=rims.holes,
            tight=np.full((len(nodes), 1), np.inf),
            by_rims=np.zeros((len(nodes), 1, len(rims.holes), 2)),
            rests=np.zeros((len(nodes), 1, 3)),
        )
        return _told(owners, np.zeros(len(owners)), np.full(len(owners), np.inf), lost)
    every = [one for one in pressed if one is not None]
    stand = np.vstack([stood[:1], _settled(every[1:], np.maximum(radii, LEAST_RADIUS), pins.radii.ties, stood[1:])])
    of_owners = np.array([[one == other for other in ends.owners] for one in owners])

    def largest(parts: Floats) -> Floats:
        """Stress of each link and pin."""
        return np.asarray(np.where(of_owners, ends.stresses(parts), 0.0).max(axis=1))

    found = list[tuple[Floats, Floats]]()
    for one, before, after in zip(every, stood, stand, strict=True):
        more = path.natural_forces(one.moved(after) - plain.moved(before), after - before)
        parts = ends.tight + ends.by_rims @ before
        found.append((largest(parts), largest(parts + ends.parts(more.reshape(-1, 6)))))
    (tight, *small), (tight_grown, *grown) = zip(*found, strict=True)
    # What pins make of stresses in small motions has its own band; over its ends those on the deformed shape go.
    plainly = np.divide(tight, tight_grown, out=np.ones_like(tight), where=tight_grown > 0.0)
    low, high = (
        np.divide(plainly * end(grown, axis=0), least, out=np.ones_like(least), where=least > 0.0)
        for end in (np.min, np.max)
        for least in (end(small, axis=0),)
    )
    first, pinned, *others = (
        path.at_nodes(np.column_stack([one.tight, one.by_rims]), nodes) for one in (plain, *every)
    )
    more = np.array(others)
    tight = factor * np.linalg.norm((more - pinned)[..., 0], axis=2).T
    rests = np.einsum("snik,sk->nsi", more[..., 1:], stand[1:])
    by_rims = (more - first)[..., 1:].reshape(len(others), len(nodes), 3, len(rims.holes), 2, 2)  # hole, rim, x and y
    by_rims = np.linalg.norm(by_rims.transpose(1, 0, 3, 4, 2, 5), ord=2, axis=(-2, -1))
    farther = Farther(nodes=numbers, holes=rims.holes, tight=tight, by_rims=by_rims, rests=rests)
    return _told(owners, low, high, farther)


def _told(owners: Sequence[tuple[str, str]], low: Floats, high: Floats, farther: Farther) -> RimGrowth:
    found: dict[str, dict[str, Scatter]] = {"link": {}, "pin": {}}
    for (kind, name), least, most in zip(owners, low.tolist(), high.tolist(), strict=True):
        found[kind][name] = Scatter(low=min(least, 1.0), high=max(most, 1.0), sources=(SOURCE,))
    return RimGrowth(links=found["link"], pins=found["pin"], farther=farther)


def _settled(pressed: Sequence[Condensed], radii: Floats, ties: NDArray[np.int64], v: Floats) -> Floats:
    """Where pins (n, 4 h) stand with the forces of the deformed shape, from where they stand without."""
    values, ways = np.linalg.eigh(np.array([one.K for one in pressed]))
    held, driven = ((ways * np.maximum(s * values, 0.0)[:, None]) @ ways.swapaxes(1, 2) for s in (1.0, -1.0))
    g = np.array([one.g for one in pressed])
    for _ in range(MOST_STEPS):
        last, v = v, least_in_discs(held, g + (driven @ v[:, :, None])[:, :, 0], radii, CLOSE, ties).v
        if np.abs(v - last).max(initial=0.0) <= SETTLED * radii.max(initial=0.0):
            break
    return v
