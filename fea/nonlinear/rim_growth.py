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
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.nonlinear.on_rims import Condensed, divided
from alula.fea.nonlinear.stability import COARSE_SUBDIVISIONS
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
    """

    links: Mapping[str, Scatter] = field(default_factory=dict)
    pins: Mapping[str, Scatter] = field(default_factory=dict)


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
    if plain is None or None in pressed:
        return _told(owners, np.zeros(len(owners)), np.full(len(owners), np.inf))
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
        found.append((largest(parts), largest(parts + ends.unit * more[ends.rows])))
    (tight, *small), (tight_grown, *grown) = zip(*found, strict=True)
    # What pins make of stresses in small motions has its own band; over its ends those on the deformed shape go.
    plainly = np.divide(tight, tight_grown, out=np.ones_like(tight), where=tight_grown > 0.0)
    low, high = (
        np.divide(plainly * end(grown, axis=0), least, out=np.ones_like(least), where=least > 0.0)
        for end in (np.min, np.max)
        for least in (end(small, axis=0),)
    )
    return _told(owners, low, high)


def _told(owners: Sequence[tuple[str, str]], low: Floats, high: Floats) -> RimGrowth:
    found: dict[str, dict[str, Scatter]] = {"link": {}, "pin": {}}
    for (kind, name), least, most in zip(owners, low.tolist(), high.tolist(), strict=True):
        found[kind][name] = Scatter(low=min(least, 1.0), high=max(most, 1.0), sources=(SOURCE,))
    return RimGrowth(links=found["link"], pins=found["pin"])


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
