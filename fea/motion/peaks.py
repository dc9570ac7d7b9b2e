"""Largest stress of a link under each of many loads, found among all nodes from the stresses of a few modes.

The von Mises stress is the length of five numbers that are linear in the stress. For N loads these are matrix
products, taken in blocks. The length is a norm, hence at most the sum of the modes' own von Mises stresses times the
size of their coefficients. Nodes that by this bound reach the peak under no load are left out beforehand. The largest
principal stress is at most the mean stress plus 2/3 of the von Mises stress, so few tensors need their eigenvalues.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.solid.stress import principal

Real = NDArray[np.float64]

_BLOCK = 1_000_000
"""Numbers in a block of products: 8 MB."""
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Peaks:
    """Largest stress of all nodes under each of N loads.

    Attributes
    ----------
    value : ndarray, shape (N,)
        [MPa]
    node : ndarray of int, shape (N,)
        Where it is.
    """

    value: Real
    node: NDArray[np.int64]


def deviator(stress: Real) -> Real:
    """Return five numbers, linear in the stress, whose length is the von Mises stress.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].

    Returns
    -------
    ndarray, shape (nodes, 5, m)
        [MPa]
    """
    xx, yy, zz, xy, yz, xz = np.moveaxis(stress, 1, 0)
    root = np.sqrt(3.0)
    return np.stack([root / 2.0 * (xx - yy), (xx + yy) / 2.0 - zz, root * xy, root * yz, root * xz], axis=1)


def von_mises_peaks(stress: Real, combination: Real) -> Peaks:
    """Return the largest von Mises stress under each load.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Of m modes at the nodes [MPa].
    combination : ndarray, shape (m, N)
        Of the modes under N loads.

    Returns
    -------
    Peaks
    """
    parts = deviator(stress)
    nodes = _candidates(parts, combination)
    count = combination.shape[1]
    value, node = np.full(count, -1.0), np.zeros(count, dtype=np.int64)
    step = max(1, _BLOCK // (5 * count))
    for start in range(0, len(nodes), step):
        block = nodes[start : start + step]
        square = _squares(parts[block], combination)
        best = np.argmax(square, axis=0)
        found = np.take_along_axis(square, best[None], axis=0)[0]
        better = found > value
        value[better], node[better] = found[better], block[best[better]]
    return Peaks(value=np.sqrt(value), node=node)


def _squares(parts: Real, combination: Real) -> Real:
    """Squared von Mises stresses (nodes, N)."""
    k, five, m = parts.shape
    products = (parts.reshape(k * five, m) @ combination).reshape(k, five, -1)
    return np.asarray(np.einsum("kin,kin->kn", products, products))


def _candidates(parts: Real, combination: Real) -> NDArray[np.int64]:
    """Nodes that may hold the peak under some load, the most stressed first."""
    own = mode_sizes(parts)
    size = np.abs(combination)
    order = np.argsort(-(own @ size.max(axis=1)))
    sample = order[: max(1, len(order) // 200)]
    reached = np.sqrt(_squares(parts[sample], combination).max(axis=0)) * (1.0 - _ROUNDING)
    keep = np.zeros(len(order), dtype=np.bool_)
    step = max(1, _BLOCK // combination.shape[1])
    for start in range(0, len(order), step):
        block = order[start : start + step]
        keep[start : start + step] = (own[block] @ size >= reached).any(axis=1)
    return np.asarray(order[keep])


def principal_peaks(stress: Real, combination: Real) -> Peaks:
    """Return the largest principal stress under each load.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Of m modes at the nodes [MPa].
    combination : ndarray, shape (m, N)
        Of the modes under N loads.

    Returns
    -------
    Peaks
    """
    count = combination.shape[1]
    hot = von_mises_peaks(stress, combination).node
    value = principal(np.einsum("nim,mn->ni", stress[hot], combination))[:, 0]
    node = hot.copy()
    step = max(1, _BLOCK // (6 * count))
    for start in range(0, len(stress), step):
        block = stress[start : start + step]
        k, six, m = block.shape
        sigma = (block.reshape(k * six, m) @ combination).reshape(k, six, count)
        mean = sigma[:, :3].mean(axis=1)
        bound = mean + 2.0 / 3.0 * np.sqrt(np.einsum("kin,kin->kn", *2 * (deviator(sigma),)))
        at, load = np.nonzero(bound > value)
        if not len(at):
            continue
        first = principal(sigma[at, :, load])[:, 0]
        order = np.argsort(first)
        # Later entries of a load overwrite earlier ones, so that the largest stands.
        best, where = np.full(count, -np.inf), np.zeros(count, dtype=np.int64)
        best[load[order]], where[load[order]] = first[order], start + at[order]
        better = best > value
        value[better], node[better] = best[better], where[better]
    return Peaks(value=value, node=node)


def size_parts(stress: Real, *, whole: bool) -> Real:
    """Return numbers, linear in the stress, whose length over k is the size of the stress.

    Parameters
    ----------
    stress : ndarray, shape (nodes, 6, m)
        Components [MPa].
    whole : bool
        True for the Frobenius norm, which no principal stress exceeds, as size; False for the von Mises stress.

    Returns
    -------
    ndarray, shape (nodes, k, m)
        [MPa]
    """
    if not whole:
        return deviator(stress)
    return np.asarray(stress * np.sqrt([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])[:, None])


def mode_sizes(parts: Real) -> Real:
    """Return the size of the stress of each mode by itself.

    Parameters
    ----------
    parts : ndarray, shape (nodes, k, m)
        From ``size_parts`` [MPa].

    Returns
    -------
    ndarray, shape (nodes, m)
        [MPa]
    """
    return np.asarray(np.sqrt(np.einsum("kim,kim->km", parts, parts)))


def largest_sizes(parts: Real, combination: Real) -> Real:
    """Return the largest size that the stress of each node has under any load.

    Parameters
    ----------
    parts : ndarray, shape (nodes, k, m)
        Of m modes, from ``size_parts`` [MPa].
    combination : ndarray, shape (m, N)
        Of the modes under N loads.

    Returns
    -------
    ndarray, shape (nodes,)
        [MPa]
    """
    found = np.empty(len(parts))
    step = max(1, _BLOCK // (parts.shape[1] * combination.shape[1]))
    for start in range(0, len(parts), step):
        found[start : start + step] = _squares(parts[start : start + step], combination).max(axis=1)
    return np.sqrt(found)
