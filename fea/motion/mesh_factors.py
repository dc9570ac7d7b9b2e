"""How far the peaks of a motion on one mesh may be from their limits, by the meshes of its worst pose."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import Source
from alula.fea.motion.envelope_result import VariantCurve
from alula.fea.refine.discretisation import Discretisation, discretisation_source, judged
from alula.fea.refine.link_series import STRESS
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.tractions.traction import Transfer
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material
from alula.loads.records.bearing import Span

Real = NDArray[np.float64]

ONE_MESH = reason("error_of_one_mesh_unknown")
AGREEMENT = 5e-3
"""Relative accuracy of the peak of a pose by unit loads, compared with a direct solution."""


class MeshFactors:
    """How far the finest mesh's peak of every variant may be from its limit, as factors on its stress."""

    def __init__(self) -> None:
        self.factors: dict[tuple[Span, Transfer | None], tuple[float, float]] = {}
        self.discretisation: Discretisation | None = None
        self.sources: tuple[Source, ...] = ()
        self.without: Reason | str = ONE_MESH
        self._refined: dict[tuple[Span, Transfer | None], float] = {}
        self._size = math.inf

    @classmethod
    def of(cls, refined: RefinedSolid | None, load_case: str, material: Material) -> "MeshFactors":
        """Return the factors of a load case.

        Parameters
        ----------
        refined : RefinedSolid or None
            The series of meshes; None where there is one mesh alone.
        load_case : str
        material : Material

        Returns
        -------
        MeshFactors
        """
        found = cls()
        if refined is None:
            return found
        numbers = [n for n, case in enumerate(refined.solution.cases) if case.load == load_case]
        judgements = [judged(refined, number, STRESS[material.brittle]) for number in numbers]
        found.discretisation = min(judgements, key=lambda d: (d.known, -d.stress.index))
        source = discretisation_source(found.discretisation.stress, sharp_edges=refined.sharp_edges)
        found.sources, found.without = (replace(source, detail=reason("at_worst_pose", found=source.detail)),), ""
        for number, judgement in zip(numbers, judgements, strict=True):
            case, precise, series = refined.solution.cases[number], refined.precision[number], judgement.stress
            key = case.span, case.transfer
            found._refined[key] = max(series.value, found._refined.get(key, 0.0))  # the worse plate of a pair
            found._size = min(found._size, series.sizes[0])
            if judgement.known and series.value > 0.0:
                measure = STRESS[material.brittle]
                ends = precise.low(measure) / series.value, precise.high(measure) / series.value
                others = found.factors.get(key, ends)
                found.factors[key] = min(ends[0], others[0]), max(ends[1], others[1])
        return found

    def was_not_refined_for(self, variant: VariantCurve) -> bool:
        """Return True where the motion's peak exceeds that of the pose that the meshes were refined for.

        Parameters
        ----------
        variant : VariantCurve

        Returns
        -------
        bool
        """
        refined = self._refined.get((variant.span, variant.transfer), np.inf)
        return variant.peak > (1.0 + AGREEMENT) * refined

    def holds_at(self, variant: VariantCurve, nodes: Real, node: int) -> bool:
        """Return True for a node near the peak that the meshes were refined for, within an element of the first mesh.

        Parameters
        ----------
        variant : VariantCurve
        nodes : ndarray, shape (nodes, 3)
            Of the mesh [mm].
        node : int

        Returns
        -------
        bool
        """
        if self.was_not_refined_for(variant):
            return False
        peak = int(variant.node[first_largest(variant.stress)])
        return bool(np.linalg.norm(nodes[node] - nodes[peak]) <= self._size)

    def of_variant(self, variant: VariantCurve) -> tuple[float, float]:
        """Return the factors on the stress of a variant: its own, else its span's without torque, else the widest.

        Parameters
        ----------
        variant : VariantCurve

        Returns
        -------
        tuple of (float, float)
            The low and the high one.
        """
        for key in ((variant.span, variant.transfer), (variant.span, None)):
            if key in self.factors:
                return self.factors[key]
        lows, highs = zip(*self.factors.values(), strict=True) if self.factors else ((1.0,), (1.0,))
        return min(lows), max(highs)
