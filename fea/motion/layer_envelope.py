"""Layers of a printed link over a motion: the least safety factor of every load case, and their fatigue."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, layer_scatter
from alula.fea.common.source import Source, SourceKind, distinct, pin_sources
from alula.fea.judging.layers import in_any_direction, may_lie_in_any_direction
from alula.fea.motion.envelope_result import LayerEnvelope, LayerFatigue, LoadCaseEnvelope, VariantCurve
from alula.fea.motion.fatigue import closed_history, not_closed, strength_at
from alula.fea.motion.layer_fatigue import LayerCycle, critical_layer
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.solid.layers import Layers
from alula.fea.superposition.peaks import ModeMeasures, largest_stress
from alula.geometry.base.ties import first_largest
from alula.loads.case.case import Case
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW

Real = NDArray[np.float64]
ESTIMATED = Source(kind=SourceKind.DISCRETISATION, detail=reason("fourfold_estimate_of_layers"))


def layer_envelopes(
    motion: LinkMotion, layers: Layers, scatter: Mapping[str, Scatter], repetitions: float | None = None
) -> dict[str, LayerEnvelope]:
    """Return the layers of a link over a motion under every load case.

    Parameters
    ----------
    motion : LinkMotion
        The link, solved on its finest mesh.
    layers : Layers
    scatter : mapping of str to Scatter
        Load case -> that of its loads.
    repetitions : float, optional
        Of the motion that are wanted.

    Returns
    -------
    dict of str to LayerEnvelope
    """
    value, place, upper = _peaks(motion, layers)
    lacking = _lacking(motion, repetitions)
    known = motion.material.fatigue_across_layers is not None and not lacking
    found = {}
    for name, curves in motion.curves.items():
        load = scatter.get(name, Scatter())
        fatigue = _fatigue(motion, layers, curves, load, repetitions) if known else None
        own = _over_motion(motion, layers, curves, value, place, upper, load)
        found[name] = replace(own, fatigue=fatigue, no_fatigue=lacking)
    return found


def built_in_any_direction(
    case: Case, motion: LinkMotion, envelope: LoadCaseEnvelope, load: Scatter
) -> LoadCaseEnvelope:
    """Return the envelope of a load case with the safety factor of all directions of building, where none is stated.

    Parameters
    ----------
    case : Case
    motion : LinkMotion
        The link, solved on its finest mesh.
    envelope : LoadCaseEnvelope
        Along the layers, with all scatter.
    load : Scatter
        Of the loads.

    Returns
    -------
    LoadCaseEnvelope
    """
    if not envelope.known or not may_lie_in_any_direction(case, motion.link):
        return envelope
    brittle = motion.material.brittle
    other = Band.exact(load.high * _largest(motion, envelope.variants, brittle=not brittle))
    principal, von_mises = (envelope.stress, other) if brittle else (other, envelope.stress)
    factor = in_any_direction(case, motion.link, envelope.safety_factor, principal, von_mises)
    return replace(envelope, safety_factor=factor)


def _largest(motion: LinkMotion, curves: Sequence[VariantCurve], *, brittle: bool) -> float:
    """Return the upper end of the largest stress of a load case, by the fourfold estimate on one mesh [MPa]."""
    peaks = largest_stress(motion.solved.measures, motion.solved.combination, brittle=brittle)
    count, found = int(motion.evaluated.sum()), []
    for curve in curves:
        number = curve.first + first_largest(peaks.value[curve.first : curve.first + count])
        error = motion.local_error(number, int(motion.solved.nodes[peaks.node[number]]))
        contact = 1.0 - CONTACT_SHORTFALL if curve.span == NARROW.span else 1.0
        found.append((max(float(peaks.value[number]), 0.0) + error) / contact)
    return max(found)


def _lacking(motion: LinkMotion, repetitions: float | None) -> Reason | None:
    """Return why there is no fatigue of layers; None where there is one, or none is asked for.

    It is asked for where repetitions are stated, or the card has fatigue data of either kind.
    """
    material = motion.material
    if material.fatigue_across_layers is not None:
        return not_closed(motion.evaluated)
    if repetitions is None and material.fatigue is None:
        return None
    return reason("no_fatigue_data_of_layers", material=material.title)


def _peaks(motion: LinkMotion, layers: Layers) -> tuple[Real, NDArray[np.int64], NDArray[np.bool_]]:
    """Return the largest stress on layers under each of the solutions' loads, its node, and whether z ≥ 0 there.

    Where the upper half of the link tells all, the lower one has the same stress on mirrored layers.
    """
    solved = motion.solved
    sides = [
        largest_stress(ModeMeasures.of(solved.stress, one), solved.combination, brittle=False, layers=one)
        for one, _ in _sides(motion, layers)
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
        number = curve.first + first_largest(value[curve.first : curve.first + count])
        error = layers.sensitivity * motion.local_error(number, int(place[number]))
        contact = 1.0 - CONTACT_SHORTFALL if curve.span == NARROW.span else 1.0
        peak = float(value[number])
        peaks[number] = peak, max(peak - error, 0.0), (peak + error) / contact, curve
    own = [number for number, (*_, curve) in peaks.items() if curve.transfer in (None, motion.stated)]
    worst = own[first_largest([value[number] for number in own])]
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
        fatigue=None,
        no_fatigue=None,
    )


def _fatigue(
    motion: LinkMotion, layers: Layers, curves: Sequence[VariantCurve], load: Scatter, repetitions: float | None
) -> LayerFatigue:
    """Return the fatigue of the layers under a load case, at the critical node of the variant that governs."""
    data = motion.material.fatigue_across_layers
    assert data is not None
    own, stresses, lives = [], [], []
    for curve in curves:
        cycle, at, factors = _critical(motion, layers, curve)
        ends = [(cycle.stress(data, layers.across, f), cycle.repetitions(data, layers.across, f))
                for f in (1.0, factors[0] * load.low, factors[1] * load.high)]  # fmt: skip
        stresses += [stress for stress, _ in ends]
        lives += [life for _, life in ends if life is not None]
        if curve.transfer in (None, motion.stated):
            own.append((*ends[0], cycle, at, curve))
    stress, life, cycle, at, curve = max(own, key=lambda one: one[0])
    sources = distinct(pin_sources(driven=curve.transfer is not None), (ESTIMATED,), load.sources)
    wanted = data.cycles if repetitions is None else repetitions
    share = 0.0 if layers.between is None else layers.between / layers.across
    return LayerFatigue(
        location=at,
        tension=cycle.tension,
        shear=(share * cycle.shear[0], share * cycle.shear[1]),
        stress=Band.around(stress, tuple(stresses), *sources),
        wanted=wanted,
        strength=strength_at(data, wanted),
        repetitions=None if life is None else Band.around(life, tuple(lives), *sources),
    )


def _critical(motion: LinkMotion, layers: Layers, curve: VariantCurve) -> tuple[LayerCycle, Real, tuple[float, float]]:
    """Return the worst cycle of a variant, its place, and by which factors its stress may be off."""
    solved, data = motion.solved, motion.material.fatigue_across_layers
    assert data is not None
    part = solved.combination[:, curve.first : curve.first + int(motion.evaluated.sum())]
    found = []
    for one, sign in _sides(motion, layers):
        number, traction = critical_layer(solved.stress, part, one, data)
        closed = np.array([closed_history(row, returns=motion.returns) for row in traction])
        found.append((LayerCycle.of(closed), int(solved.nodes[number]), sign, traction))
    cycle, node, sign, traction = max(found, key=lambda one: one[0].stress(data, layers.across))
    size = np.linalg.norm(traction, axis=0)
    pose = first_largest(size)
    if size[pose] == 0.0:
        return cycle, solved.space.nodes[node] * (1.0, 1.0, sign), (1.0, 1.0)
    error = layers.sensitivity * motion.local_error(curve.first + pose, node) / float(size[pose])
    contact = 1.0 - CONTACT_SHORTFALL if curve.span == NARROW.span else 1.0
    return cycle, solved.space.nodes[node] * (1.0, 1.0, sign), (max(1.0 - error, 0.0), (1.0 + error) / contact)


def _sides(motion: LinkMotion, layers: Layers) -> list[tuple[Layers, float]]:
    """Layers that the solved nodes have, and the sign of z: where the upper half tells all, those of its image too."""
    halved = len(motion.solved.nodes) < len(motion.solved.space.nodes)
    return [(layers, 1.0), (layers.mirrored, -1.0)] if halved else [(layers, 1.0)]
