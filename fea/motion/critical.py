"""Where a link fatigues first: among all nodes, the one at which the largest cycle of a motion harms most."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.motion.fatigue import equivalent_peak, signed_stress
from alula.fea.superposition.peaks import ModeMeasures, signed_bounds
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material

Real = NDArray[np.float64]

_BLOCK = 128


def critical_nodes(modes: ModeMeasures, combinations: Sequence[Real], material: Material) -> list[tuple[int, Real]]:
    """Return the node that fatigues first, for each of several motions.

    The largest cycle of a node goes from its smallest to its largest signed stress. A node is left out if the cycle
    between bounds on these harms no more than the cycle of one already found.

    Parameters
    ----------
    modes : ModeMeasures
    combinations : sequence of ndarray, shape (m, n)
        Of the modes at the n poses of each motion.
    material : Material
        With fatigue data.

    Returns
    -------
    list of tuple of (int, ndarray, shape (n,))
        The node, and the history of its signed stress [MPa].
    """
    return [_critical(modes, combination, material) for combination in combinations]


def _critical(modes: ModeMeasures, combination: Real, material: Material) -> tuple[int, Real]:
    stress = modes.stress
    bound = _largest_harm(*signed_bounds(modes, combination, brittle=material.brittle), material)
    order = np.argsort(-bound)
    best, node, history = _most_harmed(stress, order[:_BLOCK], combination, material)
    for start in range(_BLOCK, len(order), _BLOCK):
        block = order[start : start + _BLOCK]
        block = block[bound[block] > best]
        if not len(block):
            break
        harm, worst, signed = _most_harmed(stress, block, combination, material)
        if harm > best:
            best, node, history = harm, worst, signed
    return node, history


def _largest_harm(low: Real, high: Real, material: Material) -> Real:
    """Return what no cycle between two signed stresses (k,) exceeds in harm: a wider cycle does no less.

    By Goodman's line that holds up to the ultimate strength, beyond which nothing is said.
    """
    assert material.fatigue is not None
    cycles = np.column_stack([high - low, (high + low) / 2.0, np.ones_like(high)])
    harm = equivalent_peak(cycles, material.fatigue, material.ultimate_strength)
    return harm if material.ultimate_strength is None else np.where(high >= material.ultimate_strength, np.inf, harm)


def _most_harmed(
    stress: Real, nodes: NDArray[np.int64], combination: Real, material: Material
) -> tuple[float, int, Real]:
    """Harm, number and signed history of that of these nodes whose largest cycle harms most."""
    assert material.fatigue is not None
    k, m = len(nodes), stress.shape[2]
    sigma = (stress[nodes].reshape(6 * k, m) @ combination).reshape(k, 6, -1).swapaxes(1, 2)
    signed = signed_stress(sigma, brittle=material.brittle)
    low, high = signed.min(axis=1), signed.max(axis=1)
    cycles = np.column_stack([high - low, (high + low) / 2.0, np.ones(k)])
    harm = equivalent_peak(cycles, material.fatigue, material.ultimate_strength)
    worst = first_largest(harm)
    return float(harm[worst]), int(nodes[worst]), signed[worst]
