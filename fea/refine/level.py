"""What is kept of a link's solution on one mesh."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.elements.space import UpperHalf, upper_half
from alula.fea.refine.error_estimate import ErrorEstimate, estimate_error
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import SolidCase, SolidSolution
from alula.fea.solid.stress import COMPONENTS, extreme_principal, stress_field
from alula.loads.records.bearing import Span

_EDGE = (6.0 * np.sqrt(2.0)) ** (1.0 / 3.0)  # edge of a regular tetrahedron over the cube root of its volume
_NEIGHBOURS = 8


@dataclass(frozen=True, kw_only=True, eq=False)
class CaseFigures:
    """One case on one mesh.

    Attributes
    ----------
    von_mises, principal : ndarray
        Nodal stresses (n,) [MPa].
    estimate : ErrorEstimate
        Of the error of its stress.
    energy : float
        Strain energy [N mm].
    displacement : float
        The largest [mm].
    span : Span
        Of the pins' pressure [degrees].
    layers : ndarray or None
        Nodal stress (n,) that is set against the strength across the layers [MPa]; None where none are checked.
    layer_sensitivity : float
        Largest ratio of what that stress misses to the estimate.
    """

    von_mises: NDArray[np.float64]
    principal: NDArray[np.float64]
    estimate: ErrorEstimate
    energy: float
    displacement: float
    span: Span
    layers: NDArray[np.float64] | None = None
    layer_sensitivity: float = 1.0

    def sensitivity(self, measure: str) -> float:
        """Return how much more than the estimate a stress may miss.

        Parameters
        ----------
        measure : str
            Name of its field.

        Returns
        -------
        float
            A factor; 1 but on layers.
        """
        return self.layer_sensitivity if measure == "layers" else 1.0


@dataclass(frozen=True, kw_only=True, eq=False)
class Level:
    """What is kept of one mesh.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Of the mesh [mm].
    cells : ndarray of int, shape (m, b)
        Their numbers in each element.
    centres : ndarray, shape (m, 3)
        Of the elements [mm].
    volumes : ndarray, shape (m,)
        Of the elements [mm³].
    chord : float
        Relative difference of volume between mesh and geometry.
    figures : tuple of CaseFigures
        Of every case, in the order of the solution's cases.
    """

    nodes: NDArray[np.float64]
    cells: NDArray[np.int64]
    centres: NDArray[np.float64]
    volumes: NDArray[np.float64]
    chord: float
    figures: tuple[CaseFigures, ...]

    def size(self, place: NDArray[np.float64], radius: float = 0.0) -> float:
        """Return the mean edge of the elements within a radius of a place, at least of the nearest few.

        Parameters
        ----------
        place : ndarray, shape (3,)
            Point [mm].
        radius : float, optional
            About the place [mm].

        Returns
        -------
        float
            Mean edge [mm].
        """
        distance = np.linalg.norm(self.centres - place, axis=1)
        near = distance <= max(radius, float(np.partition(distance, _NEIGHBOURS)[_NEIGHBOURS]))
        return float(_EDGE * np.cbrt(self.volumes[near].mean()))

    @property
    def mean_size(self) -> float:
        """Element edge [mm] of the mean volume."""
        return float(_EDGE * np.cbrt(self.volumes.mean()))

    def around(self, nodal: NDArray[np.float64], place: NDArray[np.float64], radius: float) -> int:
        """Return the node of the largest value within a radius of a place, at least the nearest node.

        Parameters
        ----------
        nodal : ndarray, shape (n,)
            Values at the nodes.
        place : ndarray, shape (3,)
            Point [mm].
        radius : float
            About the place [mm].

        Returns
        -------
        int
            Number of the node.
        """
        distance = np.linalg.norm(self.nodes - place, axis=1)
        return int(np.argmax(np.where(distance <= max(radius, float(distance.min())), nodal, -np.inf)))


def level_of(solution: SolidSolution, volume: float, layers: Layers | None = None) -> Level:
    """Condense a solution on one mesh of a body.

    Parameters
    ----------
    solution : SolidSolution
        On one mesh.
    volume : float
        Of the body itself [mm³].
    layers : Layers, optional
        Of a printed part.

    Returns
    -------
    Level
        What is kept of the mesh.
    """
    space, half = solution.space, upper_half(solution.space)
    found = [_figures(solution, case, half if case.symmetric else None, layers) for case in solution.cases]
    volumes = found[0][1]
    return Level(
        nodes=space.nodes,
        cells=space.cells,
        centres=space.nodes[space.cells[:, :4]].mean(axis=1),
        volumes=volumes,
        chord=abs(float(volumes.sum()) / volume - 1.0),
        figures=tuple(figures for figures, _ in found),
    )


def _figures(
    solution: SolidSolution, case: SolidCase, half: UpperHalf | None, layers: Layers | None
) -> tuple[CaseFigures, NDArray[np.float64]]:
    """Figures of a case and the volumes of the elements, from the upper half alone where one is given.

    Symmetric displacements have the same stress in an element and in its image, but for the sign of yz and xz, and both
    meet at a node on the plane, whose average thus has none of these two.
    """
    space, moved = solution.space, case.displacement
    if half is not None:
        space, moved = half.space, moved[half.nodes]
    field = stress_field(space, moved, E=solution.E, nu=solution.nu)
    if half is not None:
        field.nodal[half.on_plane, COMPONENTS.index("yz") :] = 0.0
    stress, estimate = field.von_mises, estimate_error(field, moved, E=solution.E, nu=solution.nu)
    tension, volumes = extreme_principal(field.nodal)[0], field.weights.sum(axis=1)
    across = None if layers is None else layers.stress(field.nodal)
    if half is not None:
        if layers is not None and across is not None:
            across = half.both_nodes(across, layers.mirrored.stress(field.nodal))
        stress, tension, volumes = half.both_nodes(stress), half.both_nodes(tension), np.tile(volumes, 2)
        estimate = ErrorEstimate(
            energy=np.tile(estimate.energy, 2),
            stress=np.tile(estimate.stress, 2),
            energy_norm=math.sqrt(2.0) * estimate.energy_norm,
        )
    figures = CaseFigures(
        von_mises=stress,
        principal=tension,
        estimate=estimate,
        energy=case.strain_energy,
        displacement=case.displacement_max,
        span=case.span,
        layers=across,
        layer_sensitivity=1.0 if layers is None else layers.sensitivity,
    )
    return figures, volumes
