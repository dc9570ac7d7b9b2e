"""Where a link fatigues first: the node at which the largest cycle of a motion harms most, found among all nodes."""

import numpy as np
from numpy.typing import NDArray

from fea.fatigue import equivalent_peak, signed_stress
from fea.peaks import largest_sizes
from geometry.material import Material

Real = NDArray[np.float64]

_BLOCK = 128


def critical_node(stress: Real, combination: Real, material: Material) -> tuple[int, Real]:
    """Return the node and the history (n,) of its signed stress [MPa].

    stress       (nodes, 6, m) of the modes [MPa]
    combination  (m, n) of the modes at the poses

    The largest cycle of a node goes from its smallest to its largest signed stress. Nodes are taken in the
    order of the largest size that their stress reaches, until none of the rest could harm as much: no cycle
    of signed stresses up to that size harms more than the reversed one.
    """
    fatigue, ultimate = material.fatigue, material.ultimate_strength
    assert fatigue is not None
    size = largest_sizes(stress, combination, whole=material.brittle)
    order = np.argsort(-size)
    best, node, history = -np.inf, int(order[0]), np.zeros(combination.shape[1])
    for start in range(0, len(order), _BLOCK):
        block = order[start : start + _BLOCK]
        top = float(size[block[0]])
        bound = equivalent_peak(np.array([[2.0 * top, 0.0, 1.0]]), fatigue, ultimate)[0]
        if best >= bound and (ultimate is None or top < ultimate):
            break
        sigma = np.einsum("nim,mp->npi", stress[block], combination, optimize=True)
        signed = signed_stress(sigma, brittle=material.brittle)
        low, high = signed.min(axis=1), signed.max(axis=1)
        harm = equivalent_peak(
            np.column_stack([high - low, (high + low) / 2.0, np.ones(len(block))]), fatigue, ultimate
        )
        worst = int(np.argmax(harm))
        if harm[worst] > best:
            best, node, history = float(harm[worst]), int(block[worst]), signed[worst]
    return node, history
