"""True peaks of the drawn links: far finer meshes than a series has, under the same loads, extrapolated.

A first mesh, finer wherever the stress comes near its peak, tells where that is; two more are 3.2 and 4.8 times as
fine there as the first of a series, whatever an error estimate says. The peak is recovered in four ways: averages at
the nodes, and polynomials through the 40 or 60 (quadratic) or 100 (cubic) integration points next to a node. Each is
extrapolated with order 2. The truth is their mean, and its error their standard deviation, since each alone scatters
by a per cent or two from mesh to mesh. (A filleted rod in bending, quadratic through 40 points, at 2.2, 3.2, 4, 4.8,
6 and 7.2 times: 18.59, 20.04, 20.47, 20.91, 21.05, 21.23 MPa, which is 21.5 less 14 to 16 over the square.) Peaks of
flat links are those of an independent code (``benchmarks.coverage_plane``).
"""

from collections.abc import Iterator
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from alula.fea.refine.refinement import START
from alula.fea.refine.target_sizes import next_sizes
from alula.fea.solid.solution import SolidSolution, solve_solid
from alula.fea.solid.stress import StressField, extreme_principal, stress_field, von_mises
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from benchmarks.coverage_parts import YOUNG, Drawn

FIRST, FINER = 2.2, (3.2, 4.8)
"""Times as fine at the peaks as the first mesh of a series."""
MAY_HOLD, HOT = 0.75, 0.85
"""Share of a peak from which on a place may hold it: on a series' first mesh, and on this one's."""
ELSEWHERE = 1.1
ORDER = 2.0
FITS = ((40, 2), (60, 2), (100, 3))
"""Points and degree of polynomials."""
CANDIDATES, NEAR = 40, 0.93
"""Nodes that are tried, and the share of the peak that they must have."""


def solved(link: Drawn, settings: MeshSettings) -> SolidSolution:
    """Solve the link on one mesh."""
    pins = link.body.pins
    return solve_solid(
        mesh_body(link.body, settings),
        E=YOUNG,
        nu=link.nu,
        density=1e-9,
        loads=[link.loads],
        line=(f"bore:{pins[0].name}", f"bore:{pins[-1].name}"),
        threads=1,
    )


def truths(link: Drawn) -> list[list[float]]:
    """Return value and error of the deciding stress for every variant of pin pressure and torque transfer."""
    first = _finer(link, solved(link, START), MAY_HOLD, FIRST)
    found = []
    for finer in FINER:
        solution = _finer(link, first, HOT, finer / FIRST)
        found.append(np.array([_peaks(field, link.brittle) for field in _fields(solution)]))
    limits = found[1] + (found[1] - found[0]) / ((FINER[1] / FINER[0]) ** ORDER - 1.0)
    return [[_short(several.mean()), _short(several.std(ddof=1))] for several in limits]


def _finer(link: Drawn, solution: SolidSolution, share: float, finer: float) -> SolidSolution:
    """Solve on a mesh that is so many times as fine wherever a variant's stress reaches that share of its peak."""
    stresses = [_measure(field.nodal, link.brittle) for field in _fields(solution)]
    highest = np.max([stress / stress.max() for stress in stresses], axis=0)
    hot = highest[solution.space.cells].max(axis=1) >= share
    points, sizes = next_sizes(solution.space, [np.where(hot, finer, ELSEWHERE)], ())
    return solved(link, MeshSettings(turn_elements=START.turn_elements, size_points=points, size_values=sizes))


def _fields(solution: SolidSolution) -> Iterator[StressField]:
    for case in solution.cases:
        yield stress_field(solution.space, case.displacement, E=solution.E, nu=solution.nu)


def _measure(sigma: NDArray[np.float64], brittle: bool) -> NDArray[np.float64]:
    return extreme_principal(sigma)[0] if brittle else von_mises(sigma)


def _peaks(field: StressField, brittle: bool) -> list[float]:
    """Largest stress by averages at nodes, and by each fit about the nodes whose averages come near the peak."""
    nodal = _measure(field.nodal, brittle)
    order = np.argsort(nodal)[::-1][:CANDIDATES]
    places = field.space.nodes[order[nodal[order] >= NEAR * nodal.max()]]
    points, stress = field.points.reshape(-1, 3), field.at_points.reshape(-1, 6)
    tree, found = cKDTree(points), [float(nodal.max())]
    for count, degree in FITS:
        distance, near = tree.query(places, count)
        fitted = []
        for place, size, chosen in zip(places, distance[:, -1], near, strict=True):
            terms = _monomials((points[chosen] - place) / size, degree)
            fitted.append(np.linalg.lstsq(terms, stress[chosen], rcond=None)[0][0])
        found.append(float(_measure(np.array(fitted), brittle).max()))
    return found


def _monomials(x: NDArray[np.float64], degree: int) -> NDArray[np.float64]:
    """All products of up to so many coordinates (n, 3), the constant first."""
    chosen = (c for d in range(degree + 1) for c in combinations_with_replacement(range(3), d))
    return np.column_stack([x[:, list(c)].prod(axis=1) for c in chosen])


def _short(value: float) -> float:
    return float(f"{value:.6g}")
