"""Where a link fatigues first: among all nodes, the one at which the largest cycle of a motion harms most."""

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.fatigue import equivalent_peak, signed_stress
from alula.fea.superposition.peaks import ModeMeasures, signed_bounds
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Material

Real = NDArray[np.float64]

_BLOCK = 128


def critical_node(modes: ModeMeasures, stress: Real, combination: Real, material: Material) -> tuple[int, Real]:
    """Return the node that fatigues first over a motion.

    The largest cycle of a node goes from its smallest to its largest signed stress. A node is left out if the cycle
    between bounds on these harms no more than the cycle of one already found.

    Parameters
    ----------
    modes : ModeMeasures
        Of the largest principal or the von Mises stress, as the material breaks.
    stress : ndarray, shape (nodes, 6, m)
        Components of the modes [MPa].
    combination : ndarray, shape (m, n)
        Of the modes at the n poses.
    material : Material
        With fatigue data.

    Returns
    -------
    tuple of (int, ndarray, shape (n,))
        The node, and the history of its signed stress [MPa].
    """
    bound = _largest_harm(*signed_bounds(modes, combination), material)
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
