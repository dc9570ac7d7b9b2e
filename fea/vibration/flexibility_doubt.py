"""What natural frequencies may be since the flexibility of links is in doubt.

Material and shape leave the flexibility F of every beam between two ends: the modulus by the range that its material
states, and what the frame of plain beams does not know of eyes, bores and holes by the bounds of
``alula.fea.frame.displacement_band``. With all of them at one end together no frequency is beyond that of this end
(Rayleigh: Courant & Hilbert, Methods of Mathematical Physics, vol. 1, 1953, section VI.2: a system that gives more has
no frequency higher).

The compliance of the linkage in its own modes is 1/λ; a further flexibility dF adds qᵢ dF qⱼ/(λᵢ λⱼ) with the forces q
of the modes (virtual work). The eigenvalues of that small matrix are the new 1/λ: exactly where equilibrium alone gives
the forces, else to first order in dF, as displacements have it; and but for the modes that are left out, which
``BASIS`` makes negligible.

Near buckling little of λ is left of a large stiffness, and what is soft takes more than that from it. So where the
forces' own part G of the modes' stiffness is given, E = Λ - G is that of the material, dF makes E (E + Q)⁻¹ E of it
with Q = qᵀ dF q, and the eigenvalues of E (E + Q)⁻¹ E + G are the new λ: without forces the same.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import flexibility
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, compliance_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.frame.displacement_band import STIFFEST, Zone, give_of_links
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel
from alula.fea.frame.system import natural_deformations, natural_flexibility, to_ends
from alula.fea.nonlinear.large_displacement import blind_link
from alula.fea.vibration.modes import NaturalModes, frequency
from alula.loads.case.case import Case

Floats = NDArray[np.float64]
_PLAIN = np.ones(6)
_RIGID = 1e-12
"""Stiffness, over the largest of all modes, below which nothing is strained."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Change:
    """By what compliance in modes changes at both ends of a cause."""

    less: Floats
    more: Floats


def stiffest(case: Case, frame: LinkageFrame, model: FrameModel, parents: NDArray[np.int64]) -> Floats:
    """Return the natural stiffness of every element where modulus, eyes, bores and holes make it stiffest.

    With it no frequency is beyond what the doubt leaves, exactly and not to first order: what is held by more than
    equilibrium needs, such as a beam between two built-in eyes, gains more than that.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        Of the linkage, or of one of its links.
    model : FrameModel
        Of the frame with divided beams.
    parents : ndarray of int, shape (m,)
        Element of the frame that each one is part of.

    Returns
    -------
    ndarray, shape (m, 6, 6)
    """
    known = FlexibilityDoubt(case, frame, model, parents)
    found = [natural_flexibility(e.section, e.young, e.poisson, model.length(i)) for i, e in enumerate(model.elements)]
    for i, (plain, low, _), scatter in known.doubtful():
        found[i] = scatter.low * (low + STIFFEST * plain)  # eyes may leave nothing of it
    return np.asarray(np.linalg.inv(np.array(found)))


def _width(ends: tuple[float, float], causes: int) -> float:
    low, high = ends
    return high / low if causes == 1 and low > 0.0 else math.nan


def _ends(found: NaturalModes, change: _Change, pressed: Floats | None) -> list[tuple[float, float]]:
    """Least and largest frequency of every mode."""
    if pressed is not None:
        least, largest = (
            [frequency(value) for value in _pressed(found, q, pressed)] for q in (change.more, change.less)
        )
        return list(zip(least, largest, strict=True))
    least, largest = (
        [frequency(1.0 / mu - found.shift) if mu > 0.0 else math.inf for mu in _sorted(found, more)]
        for more in (change.more, change.less)
    )
    return list(zip(least, largest, strict=True))


def _sorted(found: NaturalModes, change: Floats) -> Floats:
    compliance = 1.0 / (found.values + found.shift)
    mu = np.linalg.eigvalsh(np.diag(compliance) + change * np.outer(compliance, compliance))
    return np.asarray(mu[::-1])


def _pressed(found: NaturalModes, change: Floats, pressed: Floats) -> Floats:
    """λ with a further flexibility, of modes of which the forces in the frame make a part of the stiffness."""
    elastic = np.diag(found.values) - pressed
    size, own = np.linalg.eigh(elastic + change)
    strained = size > _RIGID * size[-1]
    along = own[:, strained].T @ elastic
    return np.asarray(np.linalg.eigvalsh(along.T @ (along / size[strained, None]) + pressed))


class FlexibilityDoubt:
    """What the flexibility of a frame's beams and bores may be; with hinges in the holes of its pins it is the same.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        Of the linkage, or of one of its links.
    model : FrameModel
        Of the frame with divided beams.
    parents : ndarray of int, shape (m,)
        Element of the frame that each one is part of.
    """

    def __init__(self, case: Case, frame: LinkageFrame, model: FrameModel, parents: NDArray[np.int64]) -> None:
        self.case, self.frame, self.model, self.parents = case, frame, model, parents
        self.zones, self.bores = give_of_links(case, frame)
        self.links: Mapping[str, Scatter] = {
            link: compliance_scatter(case.material_of(link)) for link in case.bending_links
        }
        self.pins = {
            i: compliance_scatter(case.all_materials[case.joints[name].pin_material])
            for name, i in frame.pin_beams.items()
            if not frame.model.elements[i].rigid
        }

    @cached_property
    def _elements(self) -> tuple[Floats, Floats]:
        """Natural deformations by the motion of both ends (m, 6, 12), and natural flexibilities (m, 6, 6)."""
        lengths = [self.model.length(i) for i in range(len(self.model.elements))]
        known = list(zip(self.model.elements, lengths, strict=True))
        return (
            np.array([natural_deformations(length) @ to_ends(self.model, i) for i, length in enumerate(lengths)]),
            np.array([natural_flexibility(e.section, e.young, e.poisson, length) for e, length in known]),
        )

    @cached_property
    def _given(self) -> tuple[NDArray[np.int64], Floats]:
        """Elements in doubt, and what their natural flexibility may be beside itself (2, 3, d, 6, 6).

        Less and more, by the moduli alone, by eyes and holes alone, and by both together.
        """
        numbers, found = [], []
        for i, (F, low, high), scatter in self.doubtful():
            numbers.append(i)
            ends = ((low, scatter.low), (high, scatter.high))
            found.append([[factor * F - F, eyes - F, factor * eyes - F] for eyes, factor in ends])
        return np.array(numbers, dtype=np.int64), np.array(found).reshape(-1, 2, 3, 6, 6).transpose(1, 2, 0, 3, 4)

    def bands(
        self, model: FrameModel, found: NaturalModes, shapes: Floats, count: int, pressed: Floats | None = None
    ) -> list[Band]:
        """Return the frequencies of the lowest modes with their bands.

        Parameters
        ----------
        model : FrameModel
            The one with divided beams, or that with hinges.
        found : NaturalModes
            More than are asked for.
        shapes : ndarray, shape (c, n, 6)
            Motions of the nodes, of unit modal mass.
        count : int
            Frequencies that are asked for.
        pressed : ndarray, shape (c, c), optional
            Part of the modes' stiffness that the forces in the frame make [rad²/s²]; where it is left out, all of it is
            taken to be the material's.

        Returns
        -------
        list of Band
            [Hz]
        """
        values = [frequency(value) for value in found.values[:count]]
        links = list(dict.fromkeys(beam.link for beam in self.frame.beams.values()))
        blind = blind_link(self.case, links)
        if blind:
            why = reason("frame_is_blind", link=blind, rigid=False)
            return [Band(value=value, low=0.0, high=math.inf, without=why) for value in values]
        modulus, eyes, both = self._changes(model, shapes)
        ends = [_ends(found, change, pressed) for change in (modulus, eyes, both)]
        scatters = [compliance_scatter(self.case.material_of(link)) for link in links]
        ranges = distinct(*(one.sources for one in scatters))
        bands = []
        for k, value in enumerate(values):
            own, plain, (low, high) = (one[k] for one in ends)
            sources = [Source(kind=one.kind, detail=one.detail, width=_width(own, len(ranges))) for one in ranges]
            sources.append(Source(kind=SourceKind.EYES, width=_width(plain, 1)))
            bands.append(Band(value=value, low=min(low, value), high=max(high, value), sources=tuple(sources)))
        return bands

    def _changes(self, model: FrameModel, shapes: Floats) -> tuple[_Change, _Change, _Change]:
        """By the moduli alone, by eyes, bores and holes alone, and by both together."""
        c, (B, F) = len(shapes), self._elements
        nodes = np.array([e.nodes for e in model.elements], dtype=np.int64)
        ends = shapes[:, nodes].reshape(c, -1, 12).transpose(1, 2, 0)
        natural = np.linalg.solve(F, B @ ends)
        on_links = ~np.isin(self.parents, list(self.frame.pin_beams.values()))
        at_nodes = np.zeros((len(model.nodes), 6, c))
        np.add.at(at_nodes, nodes[on_links], (B.swapaxes(1, 2) @ natural)[on_links].reshape(-1, 2, 6, c))
        numbers, changed = self._given
        q = natural[numbers]
        less, more = (q.swapaxes(1, 2) @ changed @ q).sum(axis=2)
        for link, node, give in self.bores:
            w, factor = at_nodes[node], self.links[link].high
            sunk = w.T @ (give[:, None] * w)
            more[1] += sunk
            more[2] += factor * sunk
        first, second, third = (_Change(less=a, more=b) for a, b in zip(less, more, strict=True))
        return first, second, third

    def doubtful(self) -> Iterator[tuple[int, tuple[Floats, Floats, Floats], Scatter]]:
        """Yield the elements of links and pins: natural flexibilities, plain, least and most, and what 1/E may be."""
        passed: dict[int, float] = {}
        for i, parent in enumerate(map(int, self.parents)):
            start, end = passed.get(parent, 0.0), passed.get(parent, 0.0) + self.model.length(i)
            passed[parent] = end
            scatter = self._scatter(parent)
            if scatter is not None:
                whole = (Zone(start=0.0, end=math.inf, least=_PLAIN, most=_PLAIN),)
                yield i, _flexibilities(self.model, i, self.zones.get(parent, whole), start, end), scatter

    def _scatter(self, parent: int) -> Scatter | None:
        if parent in self.frame.beams:
            return self.links[self.frame.beams[parent].link]
        return self.pins.get(parent)


def _flexibilities(
    model: FrameModel, i: int, zones: tuple[Zone, ...], start: float, end: float
) -> tuple[Floats, Floats, Floats]:
    """Natural flexibility (6, 6) of an element: plain, the least and the largest; its ends along the whole beam."""
    e, length = model.elements[i], model.length(i)
    flexible = flexibility(e.section, e.young, e.poisson)
    found = np.zeros((3, 6, 6))
    for zone in zones:
        low, high = max(zone.start, start) - start, min(zone.end, end) - start
        if high <= low:
            continue
        terms = _terms(low / length, high / length, length)
        for row, factor in enumerate((_PLAIN, zone.least, zone.most)):
            found[row] += np.einsum("k,kab->ab", flexible * factor, terms)
    return found[0], found[1], found[2]


def _terms(low: float, high: float, length: float) -> Floats:
    """(6, 6, 6) ∫ bᵀ b dx over a part of a beam for each of N, V_y, V_z, T, M_y, M_z, which are b q."""
    found, size = np.zeros((6, 6, 6)), (high - low) * length
    found[0, 0, 0] = found[3, 5, 5] = size
    for shear, moment, first in ((1, 5, 1), (2, 4, 3)):
        rows = slice(first, first + 2)
        found[shear, rows, rows] = size / length**2
        a, b = ((1.0 - low) ** 3 - (1.0 - high) ** 3) / 3.0, (high**3 - low**3) / 3.0
        mixed = (high**2 - low**2) / 2.0 - b
        found[moment, rows, rows] = length * np.array([[a, -mixed], [-mixed, b]])
    return found
