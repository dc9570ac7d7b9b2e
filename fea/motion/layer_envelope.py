"""Layers of a printed link over a motion: the least safety factor of every load case."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.scatter import Scatter, layer_scatter
from fea.common.source import Source, SourceKind, pin_sources
from fea.motion.envelope_result import LayerEnvelope, VariantCurve
from fea.motion.link_envelope import LinkMotion
from fea.solid.layers import Layers
from fea.superposition.peaks import ModeMeasures, largest_stress
from loads.records.bearing import CONTACT_SHORTFALL, NARROW

Real = NDArray[np.float64]
ESTIMATED = Source(
    kind=SourceKind.DISCRETISATION, detail="fourfold estimate on one mesh, since none was refined for layers"
)


def layer_envelopes(motion: LinkMotion, layers: Layers, scatter: Mapping[str, Scatter]) -> dict[str, LayerEnvelope]:
    """Return the layers of a link over a motion under every load case.

    Parameters
    ----------
    motion : LinkMotion
        The link, solved on its finest mesh.
    layers : Layers
    scatter : mapping of str to Scatter
        Load case -> that of its loads.

    Returns
    -------
    dict of str to LayerEnvelope
    """
    value, place, upper = _peaks(motion, layers)
    return {
        name: _over_motion(motion, layers, curves, value, place, upper, scatter.get(name, Scatter()))
        for name, curves in motion.curves.items()
    }


def _peaks(motion: LinkMotion, layers: Layers) -> tuple[Real, NDArray[np.int64], NDArray[np.bool_]]:
    """Return the largest stress on layers under each of the solutions' loads, its node, and whether z ≥ 0 there.

    Where the upper half of the link tells all, the lower one has the same stress on mirrored layers.
    """
    solved = motion.solved
    halved = len(solved.nodes) < len(solved.space.nodes)
    sides = [
        largest_stress(ModeMeasures.of(solved.stress, one), solved.combination, brittle=False, layers=one)
        for one in ((layers, layers.mirrored) if halved else (layers,))
    ]
    values = np.array([side.value for side in sides])
    best = np.argmax(values, axis=0)
    nodes = np.array([solved.nodes[side.node] for side in sides])
    return values.max(axis=0), np.take_along_axis(nodes, best[None], axis=0)[0], best == 0


def _over_motion(
    motion: LinkMotion,
    layers: Layers,
    curves: Sequence[VariantCurve],
    value: Real,
    place: NDArray[np.int64],
    upper: NDArray[np.bool_],
    load: Scatter,
) -> LayerEnvelope:
    count = int(motion.evaluated.sum())
    peaks = {}
    for curve in curves:
        number = curve.first + int(np.argmax(value[curve.first : curve.first + count]))
        error = layers.sensitivity * motion.local_error(number, int(place[number]))
        contact = 1.0 - CONTACT_SHORTFALL if curve.span == NARROW.span else 1.0
        peak = float(value[number])
        peaks[number] = peak, max(peak - error, 0.0), (peak + error) / contact, curve
    own = [number for number, (*_, curve) in peaks.items() if curve.transfer in (None, motion.stated)]
    worst = max(own, key=lambda number: value[number])
    curve = peaks[worst][-1]
    stress = Band(
        value=float(value[worst]),
        low=min(low for _, low, _, _ in peaks.values()),
        high=max(high for _, _, high, _ in peaks.values()),
        sources=(*pin_sources(driven=curve.transfer is not None), ESTIMATED),
    )
    factor = layer_scatter(motion.material).times(load.inverse).on(stress.inverse(layers.across))
    at = motion.solved.space.nodes[place[worst]] * (1.0, 1.0, 1.0 if upper[worst] else -1.0)
    return LayerEnvelope(
        safety_factor=factor if layers.between is not None else replace(factor, low=0.0),
        pose=int(np.flatnonzero(motion.evaluated)[worst - curve.first]),
        location=at,
    )
