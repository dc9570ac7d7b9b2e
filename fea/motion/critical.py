"""Where a link fatigues first: among all nodes, the one at which the largest cycle of a motion harms most."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fea.motion.fatigue import equivalent_peak, signed_stress
from fea.motion.peaks import mode_sizes, size_bounds, size_parts
from geometry.parts.material import Fatigue, Material

Real = NDArray[np.float64]

_BLOCK = 128


def critical_nodes(stress: Real, combinations: Sequence[Real], material: Material) -> list[tuple[int, Real]]:
    """Return the node that fatigues first, for each of several motions.

    The largest cycle of a node goes from its smallest to its largest signed stress. No cycle of signed stresses up to
    some size harms more than the reversed cycle of that size. By this bound a node is left out if it harms less than
    one already found.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Of m modes [MPa].
    combinations : sequence of ndarray, shape (m, n)
        Of the modes at the n poses of each motion.
    material : Material
        With fatigue data.

    Returns
    -------
    list of tuple of (int, ndarray, shape (n,))
        The node, and the history of its signed stress [MPa].
    """
    parts = size_parts(stress, whole=material.brittle)
    own = mode_sizes(parts)
    return [_critical(stress, parts, own, combination, material) for combination in combinations]


def _critical(stress: Real, parts: Real, own: Real, combination: Real, material: Material) -> tuple[int, Real]:
    fatigue, ultimate = material.fatigue, material.ultimate_strength
    assert fatigue is not None
    size = size_bounds(parts, own, combination)
    order = np.argsort(-size)
    best, node, history = _most_harmed(stress, order[:_BLOCK], combination, material)
    for start in range(_BLOCK, len(order), _BLOCK):
        block = order[start : start + _BLOCK]
        block = block[_may_harm(size[block], best, fatigue, ultimate)]
        if not len(block):
            break
        harm, worst, signed = _most_harmed(stress, block, combination, material)
        if harm > best:
            best, node, history = harm, worst, signed
    return node, history


def _may_harm(size: Real, best: float, fatigue: Fatigue, ultimate: float | None) -> NDArray[np.bool_]:
    """Whether reversed cycles of so large stresses (k,) harm more than ``best``."""
    cycles = np.column_stack([2.0 * size, np.zeros_like(size), np.ones_like(size)])
    may = equivalent_peak(cycles, fatigue, ultimate) > best
    return may if ultimate is None else may | (size >= ultimate)


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
    worst = int(np.argmax(harm))
    return float(harm[worst]), int(nodes[worst]), signed[worst]
