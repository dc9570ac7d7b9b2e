"""One link over a motion: stress of every pose and load case from unit loads, its peaks, bands and fatigue."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind, distinct, pin_sources
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import LineReference
from alula.fea.motion.along import stress_along
from alula.fea.motion.critical import critical_node
from alula.fea.motion.envelope_result import LinkEnvelope, LoadCaseEnvelope, VariantCurve
from alula.fea.motion.mesh_factors import MeshFactors
from alula.fea.outcomes.fatigue import (
    NOTCH,
    FatigueLife,
    LinkFatigue,
    closed_history,
    fatigue_life,
    missing_data,
    not_closed,
    notch_factors,
    signed_stress,
)
from alula.fea.refine.link_series import STRESS
from alula.fea.refine.link_task import ElasticLink
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import IMBALANCE_LIMIT, REACTION_LIMIT
from alula.fea.superposition.link_measure import LinkMeasure
from alula.fea.superposition.unit_solutions import UnitSolutions
from alula.fea.tractions.traction import Transfer
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material, stress_measure
from alula.geometry.parts.part import Body
from alula.loads.records.load_case import Block

Real = NDArray[np.float64]

ELSEWHERE, FATIGUE_ELSEWHERE = (
    Source(kind=SourceKind.DISCRETISATION, detail=reason(kind))
    for kind in ("fourfold_estimate_of_pose", "fourfold_estimate_of_fatigue")
)


def _balanced(solved: UnitSolutions) -> None:
    """Refuse loads that do not balance and supports that react."""
    for what, values, limit in (
        ("the loads leave a resultant", solved.imbalance, IMBALANCE_LIMIT),
        ("the supports of the free body react", solved.reaction, REACTION_LIMIT),
    ):
        if not values.max() <= limit:
            raise CannotRunError(
                f"{what} of {values.max():.2%} of the load (at most {limit:.1%}): load and stress do not balance"
            )


class LinkMotion:
    """A link solved over a motion, on one mesh.

    Parameters
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    link : str
    body : Body
    material : Material
    histories : sequence of LinkLoads
        Its loads over the motion, one record per load case.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    stated : Transfer
        How the drive torque enters, by the case; the other way stands in the band.
    returns : bool
        True where the last pose is the first again, or goes on to it; else the motion goes there and back.
    layers : Layers, optional
        Of a printed part.
    blocks : mapping of str to sequence of Block, optional
        Load case -> how often which poses follow each other; all of them once where left out.

    Attributes
    ----------
    measure : LinkMeasure
        Of all loads of all variants.
    curves : dict of str to list of VariantCurve
        Load case -> peaks of its variants.

    Raises
    ------
    CannotRunError
        For loads that do not balance, supports that react, or a failing solver.
    """

    def __init__(
        self,
        space: DisplacementSpace,
        *,
        link: str,
        body: Body,
        material: Material,
        histories: Sequence[LinkLoads],
        evaluated: NDArray[np.bool_],
        stated: Transfer,
        returns: bool,
        layers: Layers | None = None,
        blocks: Mapping[str, Sequence[Block]] | None = None,
    ) -> None:
        self.blocks = blocks or {}
        self.link, self.body, self.material, self.evaluated = link, body, material, evaluated
        self.stated, self.returns = stated, returns
        chosen = [history.chosen(evaluated) for history in histories]
        self.measure = LinkMeasure.of_units(ElasticLink.of(body, material, layers), space, chosen)
        _balanced(self.measure.solved)
        peaks = self.measure.peaks(STRESS[material.brittle])
        self.curves: dict[str, list[VariantCurve]] = {history.name: [] for history in chosen}
        for variant in self.measure.variants:
            stress, node = np.full(len(evaluated), np.nan), np.full(len(evaluated), -1)
            stress[evaluated], node[evaluated] = peaks.value[variant.loads], peaks.node[variant.loads]
            curve = VariantCurve(
                span=variant.law.span, transfer=variant.transfer, stress=stress, node=node, first=variant.loads.start
            )
            self.curves[chosen[variant.record].name].append(curve)

    @property
    def worst_poses(self) -> dict[str, int]:
        """Number of the pose with the largest peak, for every load case."""
        governing = {name: self._governing(variants) for name, variants in self.curves.items()}
        return {name: first_largest(variant.stress) for name, variant in governing.items()}

    def envelope(
        self,
        *,
        repetitions: float | None = None,
        refined: RefinedSolid | None = None,
        scatter: Mapping[str, Scatter] | None = None,
    ) -> LinkEnvelope:
        """Return the envelopes of all load cases, in bands.

        Parameters
        ----------
        repetitions : float, optional
            Of the motion that are wanted.
        refined : RefinedSolid, optional
            The series of meshes that ended with this one, solved at the worst pose: for the bands.
        scatter : mapping of str to Scatter, optional
            Load case -> that of its loads.

        Returns
        -------
        LinkEnvelope
        """
        solved, material, space = self.measure.solved, self.material, self.measure.solved.space
        lacking = missing_data(material) or not_closed(self.evaluated)
        found = {}
        for name, curves in self.curves.items():
            series, load = MeshFactors.of(refined, name, material), (scatter or {}).get(name, Scatter())
            own = self._estimated(self._by_meshes(name, curves, series), series)
            own = _scattered(own, material, load)
            if own.known:
                own = replace(own, along=stress_along(self.measure, own.governing, self.evaluated))
            if not lacking and own.known:
                own = replace(own, fatigue=self._fatigue(own, series, load, repetitions))
            found[name] = own
        worst = min(found.values(), key=lambda load_case: load_case.severity)
        number = self.load(worst.governing, worst.pose)
        return LinkEnvelope(
            link=self.link,
            measure=stress_measure(brittle=material.brittle),
            strength=material.allowable,
            load_cases=found,
            elements=len(space.cells),
            unknowns=space.unknowns,
            units=solved.projection.shape[1],
            modes=len(solved.combination),
            solver=solved.solver,
            solver_reason=solved.solver_reason,
            solver_error=solved.solver_error,
            reaction=float(solved.reaction.max()),
            imbalance=float(solved.imbalance.max()),
            field=self.measure.field(number),
            displacement=LineReference(space, self.measure.link.line).relative(solved.field(number)),
            no_fatigue=lacking,
            notes=() if refined is None else refined.solution.notes,
            layers={},
        )

    def _governing(self, variants: Sequence[VariantCurve]) -> VariantCurve:
        """The variant of the largest peak, of those with the stated transfer."""
        return max((v for v in variants if v.transfer in (None, self.stated)), key=lambda v: v.peak)

    def _by_meshes(self, name: str, variants: Sequence[VariantCurve], series: MeshFactors) -> LoadCaseEnvelope:
        """Return the envelope in bands by the meshes of the worst pose."""
        own = [v for v in variants if v.transfer in (None, self.stated)]
        governing = self._governing(variants)
        pose = first_largest(governing.stress)
        value = np.array([v.stress for v in own]).max(axis=0)
        # Under compression the ends of a band change places. Compression does not break a brittle part, so 0 is least.
        ends = np.array([factor * v.stress for v in variants for factor in series.of_variant(v)])
        low, high = np.minimum(ends.min(axis=0), value), np.maximum(ends.max(axis=0), value)
        if series.discretisation is not None and not series.discretisation.known:
            value = low = high = np.full_like(value, np.nan)
        if series.discretisation is None or series.discretisation.known:
            peak = Band(
                value=max(governing.peak, 0.0),
                low=max(min(f * v.peak for v in variants for f in (*series.of_variant(v), 1.0)), 0.0),
                high=max(float(np.nanmax(high)), 0.0),
                sources=(*_sources(governing), *series.sources),
                without=series.without,
            )
        else:
            peak = Band.unknown(reason("peak_without_limit"))
        return LoadCaseEnvelope(
            name=name,
            variants=tuple(variants),
            governing=governing,
            value=value,
            low=low,
            high=high,
            stress=peak,
            safety_factor=peak.inverse(self.material.allowable),
            pose=pose,
            location=self.measure.solved.space.nodes[governing.node[pose]].copy(),
            fatigue=None,
            discretisation=series.discretisation,
        )

    def _estimated(self, load_case: LoadCaseEnvelope, series: MeshFactors) -> LoadCaseEnvelope:
        """Return the envelope; a peak that no mesh was refined for gets a band by the estimate on this mesh alone."""
        if not load_case.known or not series.was_not_refined_for(load_case.governing):
            return load_case
        governing, pose, peak = load_case.governing, load_case.pose, load_case.stress
        low_end, high_end = self.measure.ends(
            STRESS[self.material.brittle], self.load(governing, pose), int(governing.node[pose]), peak.value
        )
        peak = Band(
            value=peak.value,
            low=min(peak.low, low_end),
            high=max(peak.high, high_end),
            sources=(*peak.sources, ELSEWHERE),
        )
        low, high = load_case.low.copy(), load_case.high.copy()
        low[pose], high[pose] = min(low[pose], peak.low), max(high[pose], peak.high)
        factor = peak.inverse(self.material.allowable)
        return replace(load_case, stress=peak, safety_factor=factor, low=low, high=high)

    def load(self, variant: VariantCurve, pose: int) -> int:
        """Return the number of a load among the solutions' combinations.

        Parameters
        ----------
        variant : VariantCurve
        pose : int
            Its number; one that counts.

        Returns
        -------
        int
        """
        return variant.first + int(np.count_nonzero(self.evaluated[:pose]))

    def _fatigue(
        self, load_case: LoadCaseEnvelope, series: MeshFactors, load: Scatter, repetitions: float | None
    ) -> LinkFatigue:
        """Return the fatigue under a load case, at the critical node of the variant that governs.

        Of blocks of poses each has a node that its largest cycle harms most; that counts which all blocks harm most.
        """
        assert self.material.fatigue is not None
        every, found, meshes, count = list[FatigueLife](), [], list(series.sources), int(self.evaluated.sum())
        solved, blocks = self.measure.solved, self.blocks.get(load_case.name, ())
        least, most = notch_factors(self.body, solved.space.nodes[solved.nodes], self.material.fatigue)
        stress = solved.stress if (most == 1.0).all() else most[:, None, None] * solved.stress
        for variant in load_case.variants:
            part = solved.combination[:, variant.first : variant.first + count]
            lives = []
            for states in [block.states for block in blocks] or [tuple(range(count))]:
                number, _ = critical_node(self.measure.decisive, stress, part[:, list(states)], self.material)
                history = signed_stress((stress[number] @ part).T, brittle=self.material.brittle)
                closed = closed_history(history, returns=self.returns)
                lives.append((fatigue_life(closed, self.material, blocks), number, history, closed))
            life, number, history, closed = max(lives, key=lambda one: _harm(one[0]))
            node, notch = int(solved.nodes[number]), float(least[number] / most[number])
            factors = series.of_variant(variant)
            if series.discretisation is not None and not series.holds_at(variant, solved.space.nodes, node):
                factors = self._fatigue_factors(variant, node, history / most[number])
                meshes.append(FATIGUE_ELSEWHERE)
            if notch < 1.0:
                meshes.append(NOTCH)
            ends = (factors[0] * load.low * notch, factors[1] * load.high)
            every += [life, *(fatigue_life(factor * closed, self.material, blocks) for factor in ends)]
            if variant.transfer in (None, self.stated):
                found.append((life, node, history, float(most[number])))
        life, node, history, share = max(found, key=lambda f: f[0].stress)
        sources = distinct(_sources(load_case.governing), tuple(meshes), load.sources)
        place, material = solved.space.nodes[node].copy(), self.material
        return LinkFatigue.of(
            every, life, history, place, sources, material=material, repetitions=repetitions, notch=share
        )

    def _fatigue_factors(self, variant: VariantCurve, node: int, history: Real) -> tuple[float, float]:
        """Factors for a node that no mesh was refined for, by the estimate beside it in its worst pose."""
        pose = first_largest(np.abs(history))
        stress = abs(float(history[pose]))
        if stress == 0.0:
            return 1.0, 1.0
        low, high = self.measure.ends(STRESS[self.material.brittle], variant.first + pose, node, stress)
        return low / stress, high / stress


def _harm(life: FatigueLife) -> tuple[float, float]:
    """Miner's sum of a repetition, and the stress of its worst cycle where that is alike or not known."""
    harm = 0.0 if life.repetitions is None else 1.0 / life.repetitions if life.repetitions > 0.0 else math.inf
    return harm, life.stress


def _scattered(load_case: LoadCaseEnvelope, material: Material, load: Scatter) -> LoadCaseEnvelope:
    """Return the envelope with the scatter of load and strength in its bands."""
    stress = load.on(load_case.stress)
    return replace(
        load_case,
        stress=stress,
        safety_factor=strength_scatter(material).on(stress.inverse(material.allowable)),
        # Stress is negative under compression, so the larger load gives its lower end.
        low=np.minimum(load.low * load_case.low, load.high * load_case.low),
        high=np.maximum(load.low * load_case.high, load.high * load_case.high),
    )


def _sources(governing: VariantCurve) -> tuple[Source, ...]:
    return pin_sources(driven=governing.transfer is not None)
