"""One link on successive meshes: what is kept of each, and how precise the finest one's numbers are."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.refine.convergence import LEAST_RATIO, GridConvergence, grid_convergence
from alula.fea.refine.error_estimate import energy_factor, relative_error
from alula.fea.refine.level import Level
from alula.fea.refine.singular import ON_EDGE, SharpPeak, edge_distance, loaded_edge, sharp_peak
from alula.fea.refine.target_sizes import LocalGoal
from alula.geometry.meshing.mesh import ReentrantEdge
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW

CHORD = 2.0
"""Relative error of a bending stiffness over that of the volume, on a mesh whose straight sides cut corners."""
NOT_RESOLVED = 0.3
"""Relative error in the energy norm above which nothing is said: estimates and orders are asymptotic. Curved elements
25 diameters long left a tube 55 % too stiff, where a band of the estimate (0.53, hence 28 %) would have missed it."""
AROUND = 1.5
"""Radius about a peak, in sizes of the first mesh, in which a series measures its sizes and the next mesh is finer."""


Measure = Literal["von_mises", "principal", "layers"]
"""A nodal stress, named as in ``CaseFigures``."""
STRESS: dict[bool, Measure] = {True: "principal", False: "von_mises"}
"""The stress that decides all links of a material, by whether it is brittle."""
PeakQuantity = Measure | Literal["displacement"]
Unreliable = Literal["", "coarse", "edge"]


@dataclass(frozen=True, kw_only=True)
class Eye:
    """The disc about a pin within which its pressure rules, drawn out along a slot.

    Attributes
    ----------
    x : float
        Of the centre [mm].
    y : float
        Of the centre [mm].
    radius : float
        Of the disc [mm].
    slot : float
        Length along x by which the disc is drawn out [mm].
    """

    x: float
    y: float
    radius: float
    slot: float = 0.0

    def holds(self, nodes: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return whether points lie in it.

        Parameters
        ----------
        nodes : ndarray, shape (n, 3)
            Points [mm].

        Returns
        -------
        ndarray of bool, shape (n,)
            Whether each lies in the disc.
        """
        along = np.maximum(np.abs(nodes[:, 0] - self.x) - self.slot / 2.0, 0.0)
        return np.asarray(np.hypot(along, nodes[:, 1] - self.y) <= self.radius)


@dataclass(frozen=True, kw_only=True, eq=False)
class CasePrecision:
    """How far the numbers of one solved case are from their limits on ever finer meshes.

    Attributes
    ----------
    von_mises : GridConvergence
        Series of the largest von Mises stress.
    principal : GridConvergence
        Series of the largest principal stress.
    displacement : GridConvergence
        Series of the largest displacement.
    edge : GridConvergence or None
        The stress where a sharp edge bears most; None without an edge that bears much.
    sharp : SharpPeak or None
        The singular peak that the case has there; None where there is none.
    unreliable : Doubt
        Why there is no band: "coarse" where the mesh resolves nothing; "edge" where a sharp edge bears much and the
        meshes do not tell yet whether its stress has a limit, which leaves displacements alone.
    layers : GridConvergence or None
        Series of the largest stress on the layers; None where none are checked.
    in_contact : dict of Quantity to float
        Quantity -> largest stress in the eyes [MPa], with what contact adds to the narrow pressure's; 0 under the wide
        one.
    """

    von_mises: GridConvergence
    principal: GridConvergence
    displacement: GridConvergence
    edge: GridConvergence | None
    sharp: SharpPeak | None
    unreliable: Unreliable
    in_contact: Mapping[PeakQuantity, float]
    layers: GridConvergence | None = None

    def series(self, quantity: PeakQuantity) -> GridConvergence:
        """Return the series of a quantity.

        Parameters
        ----------
        quantity : Quantity
            Which number.

        Returns
        -------
        GridConvergence
            Its series.
        """
        found: GridConvergence = getattr(self, quantity)
        return found

    def known(self, quantity: PeakQuantity) -> bool:
        """Return whether a number stands for the quantity.

        Parameters
        ----------
        quantity : Quantity
            Which number.

        Returns
        -------
        bool
            False where no number stands for it.
        """
        if self.unreliable == "coarse" or self.series(quantity).kind == "growing":
            return False
        return quantity == "displacement" or (self.sharp is None and self.unreliable == "")

    def low(self, quantity: PeakQuantity) -> float:
        """Return the lower end of the band, not below zero.

        Parameters
        ----------
        quantity : Quantity
            Which number.

        Returns
        -------
        float
            Lower end; -inf where the number is unknown [MPa, mm].
        """
        return max(self.series(quantity).low, 0.0) if self.known(quantity) else -math.inf

    def high(self, quantity: PeakQuantity) -> float:
        """Return the upper end of the band: of the meshes and, for what an eye bears, of pin contact on top.

        Parameters
        ----------
        quantity : Quantity
            Which number.

        Returns
        -------
        float
            Upper end; inf where the number is unknown [MPa, mm].
        """
        if not self.known(quantity):
            return math.inf
        series = self.series(quantity)
        contact = self.in_contact.get(quantity, 0.0)
        return max(series.high, contact * series.high / series.value if series.value > 0.0 else 0.0)


def precision(
    levels: Sequence[Level], edges: Sequence[ReentrantEdge], *, section: float, eyes: Sequence[Eye]
) -> tuple[CasePrecision, ...]:
    """Judge every case on the meshes so far.

    Parameters
    ----------
    levels : sequence of Level
        The meshes so far, coarse to fine.
    edges : sequence of ReentrantEdge
        Re-entrant edges of the body.
    section : float
        Smaller dimension of the link's section [mm].
    eyes : sequence of Eye
        Of its pins.

    Returns
    -------
    tuple of CasePrecision
        One per case.
    """
    return tuple(_case(levels, number, edges, section, eyes) for number in range(len(levels[-1].figures)))


def energy_errors(levels: Sequence[Level]) -> tuple[float, ...]:
    """Return the worst case's relative error in the energy norm on each mesh, by estimates and energies so far.

    Parameters
    ----------
    levels : sequence of Level
        The meshes so far, coarse to fine.

    Returns
    -------
    tuple of float
        One per mesh.
    """
    return tuple(
        max(_energy_error(levels, number, end) for number in range(len(levels[-1].figures)))
        for end in range(1, len(levels) + 1)
    )


def _energy_error(levels: Sequence[Level], number: int, end: int) -> float:
    """Relative error of a case on mesh ``end``; the factor of the first mesh is that of the first two."""
    figures = [level.figures[number] for level in levels]
    known = figures[: max(2, end)]
    factor = energy_factor([f.estimate.total for f in known], [f.energy for f in known])
    estimate = figures[end - 1].estimate
    return relative_error((factor or 1.0) * estimate.total, estimate.energy_norm)


def goals(
    levels: Sequence[Level],
    allowed: float,
    *,
    measure: Measure,
    edges: Sequence[ReentrantEdge],
    section: float,
    ratios: Sequence[float],
) -> list[LocalGoal]:
    """Return the peaks of the deciding stress that the next mesh is to resolve.

    Parameters
    ----------
    levels : sequence of Level
        The meshes so far, coarse to fine.
    allowed : float
        Estimate over peak that is aimed at.
    measure : Measure
        A stress that decides.
    edges : sequence of ReentrantEdge
        Re-entrant edges of the link.
    section : float
        Smaller dimension of the link's section [mm].
    ratios : sequence of float
        Of the sizes about each case's peak, last mesh over next one.

    Returns
    -------
    list of LocalGoal
        The peaks, and sharp edges that bear much stress, so that their growth shows.
    """
    found, level = [], levels[-1]
    for figures, ratio in zip(level.figures, ratios, strict=True):
        stress = getattr(figures, measure)
        edge = loaded_edge(edges, level.nodes, figures.von_mises, section)
        nodes = {int(np.argmax(stress))} | ({edge[1]} if edge else set())
        found += [
            LocalGoal(
                location=level.nodes[node],
                value=float(stress[node]),
                stress=stress[level.cells].max(axis=1),
                estimate=figures.sensitivity(measure) * figures.estimate.stress,
                allowed=allowed,
                ratio=ratio,
                radius=AROUND * levels[0].size(level.nodes[node]),
            )
            for node in nodes
            if stress[node] > 0.0
        ]
    return found


def _case(
    levels: Sequence[Level], number: int, edges: Sequence[ReentrantEdge], section: float, eyes: Sequence[Eye]
) -> CasePrecision:
    last = levels[-1]
    stresses = [level.figures[number].von_mises for level in levels]
    found = loaded_edge(edges, last.nodes, stresses[-1], section)
    edge_series = sharp = None

    def series(nodal: Sequence[NDArray[np.float64]], node: int, measure: Measure = "von_mises") -> GridConvergence:
        on_edge = bool(edges) and edge_distance(edges, last.nodes[[node]]).min() <= ON_EDGE * section
        sensitivity = last.figures[number].sensitivity(measure)
        return _series(levels, number, nodal, node, sharp=on_edge, sensitivity=sensitivity)

    if found is not None:
        edge, node = found
        edge_series = series(stresses, node)
        sharp = sharp_peak(
            edge,
            edges,
            place=last.nodes[node],
            **_at_maximum(levels, stresses, node),
            nodes=last.nodes,
            von_mises=stresses[-1],
            section=section,
        )
    principal = [level.figures[number].principal for level in levels]
    layers = [stress for level in levels if (stress := level.figures[number].layers) is not None]
    return CasePrecision(
        von_mises=series(stresses, int(np.argmax(stresses[-1]))),
        principal=series(principal, int(np.argmax(principal[-1]))),
        displacement=_displacement(levels, number),
        edge=edge_series,
        sharp=sharp,
        unreliable=_unreliable(levels, number, edge_series),
        in_contact=_in_contact(last, number, eyes),
        layers=series(layers, int(np.argmax(layers[-1])), "layers") if layers else None,
    )


def _unreliable(levels: Sequence[Level], number: int, edge: GridConvergence | None) -> Unreliable:
    # What the energies take off the estimate may be chance; what they add counts.
    if max(_energy_error(levels, number, len(levels)), levels[-1].figures[number].estimate.relative) > NOT_RESOLVED:
        return "coarse"
    return "edge" if edge is not None and edge.kind in ("one mesh", "two meshes", "growing") else ""


def _in_contact(level: Level, number: int, eyes: Sequence[Eye]) -> dict[PeakQuantity, float]:
    """Largest stresses in the eyes over what contact leaves of them, under the narrow pressure."""
    figures = level.figures[number]
    if figures.span != NARROW.span or not eyes:
        return {}
    inside = np.any([eye.holds(level.nodes) for eye in eyes], axis=0)
    measures: tuple[tuple[Measure, NDArray[np.float64] | None], ...] = (
        ("von_mises", figures.von_mises),
        ("principal", figures.principal),
        ("layers", figures.layers),
    )
    share = 1.0 - CONTACT_SHORTFALL
    return {measure: float(stress[inside].max()) / share for measure, stress in measures if stress is not None}


def _series(
    levels: Sequence[Level],
    number: int,
    nodal: Sequence[NDArray[np.float64]],
    node: int,
    *,
    sharp: bool,
    sensitivity: float,
) -> GridConvergence:
    """Series of a nodal stress about a node of the finest mesh; ``sharp`` where that lies on a re-entrant edge.

    It may miss ``sensitivity`` times what the estimate says.
    """
    last = levels[-1]
    place = last.nodes[node]
    radius = levels[0].size(place)
    chosen = _falling([level.size(place, AROUND * radius) for level in levels])
    values = [float(nodal[i][levels[i].around(nodal[i], place, radius)]) for i, _ in chosen]
    error = float(last.figures[number].estimate.stress[(last.cells == node).any(axis=1)].max())
    missing = sensitivity * error + CHORD * last.chord * abs(values[-1])
    return grid_convergence([size for _, size in chosen], values, estimate=missing, sharp=sharp)


def _at_maximum(levels: Sequence[Level], nodal: Sequence[NDArray[np.float64]], node: int) -> dict[str, list[float]]:
    """Largest values about a node of the finest mesh, and the sizes of the elements just there."""
    place = levels[-1].nodes[node]
    radius = levels[0].size(place)
    nodes = [level.around(values, place, radius) for level, values in zip(levels, nodal, strict=True)]
    return {
        "sizes": [level.size(level.nodes[number]) for level, number in zip(levels, nodes, strict=True)],
        "values": [float(values[number]) for values, number in zip(nodal, nodes, strict=True)],
    }


def _displacement(levels: Sequence[Level], number: int) -> GridConvergence:
    """Series of the largest displacement; η² of the energy is missing, hence of the displacement; it counts twice.

    Where the energies find more error than the estimate, theirs counts.
    """
    chosen = _falling([level.mean_size for level in levels])
    last = levels[-1].figures[number]
    error = max(last.estimate.relative, _energy_error(levels, number, len(levels)))
    missing = 2.0 * error**2 + CHORD * levels[-1].chord
    return grid_convergence(
        [size for _, size in chosen],
        [levels[i].figures[number].displacement for i, _ in chosen],
        estimate=missing * last.displacement,
    )


def _falling(sizes: Sequence[float]) -> list[tuple[int, float]]:
    """Levels, up to the finest, whose sizes are far enough apart to count in a series."""
    chosen = [(len(sizes) - 1, sizes[-1])]
    for number in range(len(sizes) - 2, -1, -1):
        if sizes[number] >= LEAST_RATIO * chosen[0][1]:
            chosen.insert(0, (number, sizes[number]))
    return chosen
