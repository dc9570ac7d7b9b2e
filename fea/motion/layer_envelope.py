"""Layers of a printed link over a motion: the least safety factor of every load case, and their fatigue."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, fatigue_scatter, layer_scatter
from alula.fea.common.source import Source, SourceKind, distinct, pin_sources
from alula.fea.judging.layers import in_any_direction
from alula.fea.motion.envelope_result import LayerEnvelope, LayerFatigue, LoadCaseEnvelope, VariantCurve
from alula.fea.motion.layer_fatigue import LayerCycle, critical_layer
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.outcomes.fatigue import closed_history, life_scatter, not_closed, strength_at
from alula.fea.outcomes.limits import may_lie_in_any_direction
from alula.fea.refine.link_series import STRESS
from alula.fea.superposition.link_measure import StatePeaks
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Fatigue
from alula.loads.case.case import Case

Real = NDArray[np.float64]
ESTIMATED = Source(kind=SourceKind.DISCRETISATION, detail=reason("fourfold_estimate_of_layers"))


def layer_envelopes(
    motion: LinkMotion, scatter: Mapping[str, Scatter], repetitions: float | None = None
) -> dict[str, LayerEnvelope]:
    """Return the layers of a link over a motion under every load case.

    Parameters
    ----------
    motion : LinkMotion
        The link, solved on its finest mesh, with layers.
    scatter : mapping of str to Scatter
        Load case -> that of its loads.
    repetitions : float, optional
        Of the motion that are wanted.

    Returns
    -------
    dict of str to LayerEnvelope
    """
    peaks = motion.measure.peaks("layers")
    lacking = _lacking(motion, repetitions)
    known = motion.material.fatigue_across_layers is not None and not lacking
    found = {}
    for name, curves in motion.curves.items():
        load = scatter.get(name, Scatter())
        fatigue = _fatigue(motion, curves, load, repetitions) if known else None
        own = _over_motion(motion, curves, peaks, load)
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
    peaks, count, found = motion.measure.peaks(STRESS[brittle]), int(motion.evaluated.sum()), []
    for curve in curves:
        number = curve.first + first_largest(peaks.value[curve.first : curve.first + count])
        peak = max(float(peaks.value[number]), 0.0)
        found.append(motion.measure.ends(STRESS[brittle], number, int(peaks.node[number]), peak)[1])
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


def _over_motion(motion: LinkMotion, curves: Sequence[VariantCurve], peaks: StatePeaks, load: Scatter) -> LayerEnvelope:
    layers, value, count = motion.measure.sides[0][0], peaks.value, int(motion.evaluated.sum())
    numbers = [curve.first + first_largest(value[curve.first : curve.first + count]) for curve in curves]
    ends = [motion.measure.ends("layers", number, int(peaks.node[number]), float(value[number])) for number in numbers]
    own = [i for i, curve in enumerate(curves) if curve.transfer in (None, motion.stated)]
    governing = own[first_largest([value[numbers[i]] for i in own])]
    curve, worst = curves[governing], numbers[governing]
    stress = Band(
        value=float(value[worst]),
        low=min(low for low, _ in ends),
        high=max(high for _, high in ends),
        sources=(*pin_sources(driven=curve.transfer is not None), ESTIMATED),
    )
    factor = layer_scatter(motion.material).times(load.inverse).on(stress.inverse(layers.across))
    at = motion.measure.solved.space.nodes[peaks.node[worst]] * (1.0, 1.0, -1.0 if peaks.image[worst] else 1.0)
    return LayerEnvelope(
        safety_factor=factor if layers.between is not None else replace(factor, low=0.0),
        pose=int(np.flatnonzero(motion.evaluated)[worst - curve.first]),
        location=at,
        fatigue=None,
        no_fatigue=None,
    )


def _fatigue(
    motion: LinkMotion, curves: Sequence[VariantCurve], load: Scatter, repetitions: float | None
) -> LayerFatigue:
    """Return the fatigue of the layers under a load case, at the critical node of the variant that governs."""
    data, layers = motion.material.fatigue_across_layers, motion.measure.sides[0][0]
    assert data is not None
    own, stresses, lives, scatter = [], [], [], fatigue_scatter(data)
    for curve in curves:
        cycle, at, factors = _critical(motion, data, curve)
        every = (1.0, 1.0), (factors[0] * load.low, scatter.high), (factors[1] * load.high, scatter.low)
        ends = [
            (cycle.stress(data, layers.across, f), cycle.repetitions(data, layers.across, f, by)) for f, by in every
        ]
        stresses += [stress for stress, _ in ends]
        lives += [life for _, life in ends if life is not None]
        if curve.transfer in (None, motion.stated):
            own.append((*ends[0], cycle, at, curve))
    stress, life, cycle, at, curve = max(own, key=lambda one: one[0])
    sources = distinct(pin_sources(driven=curve.transfer is not None), (ESTIMATED,), load.sources)
    wanted = data.cycles if repetitions is None else repetitions
    share = 0.0 if layers.between is None else layers.between / layers.across
    strength = strength_at(data, wanted if repetitions is None else wanted * max(cycle.count, 1.0))
    return LayerFatigue(
        location=at,
        tension=cycle.tension,
        shear=(share * cycle.shear[0], share * cycle.shear[1]),
        stress=Band.around(stress, tuple(stresses), *sources),
        wanted=wanted,
        strength=None if strength is None else min(strength, layers.across),
        repetitions=None
        if life is None
        else Band.around(life, tuple(lives), *distinct(sources, life_scatter(data).told)),
    )


def _critical(motion: LinkMotion, data: Fatigue, curve: VariantCurve) -> tuple[LayerCycle, Real, tuple[float, float]]:
    """Return the worst cycle of a variant, its place, and by which factors its stress may be off."""
    solved, sides = motion.measure.solved, motion.measure.sides
    part = solved.combination[:, curve.first : curve.first + int(motion.evaluated.sum())]
    found = []
    for one, sign in sides:
        number, traction = critical_layer(solved.stress, part, one, data)
        closed = np.array([closed_history(row, returns=motion.returns) for row in traction])
        found.append((LayerCycle.of(closed), int(solved.nodes[number]), sign, traction))
    cycle, node, sign, traction = max(found, key=lambda one: one[0].stress(data, sides[0][0].across))
    size = np.linalg.norm(traction, axis=0)
    pose = first_largest(size)
    at, stress = solved.space.nodes[node] * (1.0, 1.0, sign), float(size[pose])
    if stress == 0.0:
        return cycle, at, (1.0, 1.0)
    low, high = motion.measure.ends("layers", curve.first + pose, node, stress)
    return cycle, at, (low / stress, high / stress)
