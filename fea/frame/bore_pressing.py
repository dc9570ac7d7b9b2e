"""What the couples of pins press on the walls of their bores, beside the joint forces, as far as friction feels it."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from fea.outcomes.pins import eyes
from geometry.base.errors import CaseError
from loads.case.case import Case
from loads.case.joint_rules import rubbing_joints
from loads.records.applied import shifted
from loads.statics.friction import Presses
from loads.statics.pressing import pressing

Real = NDArray[np.float64]

NOTHING = 1e-9
"""Force of a joint, over the largest, below which its bore counts as pressed by nothing."""


def bore_presses(case: Case, wrenches: Mapping[str, Real]) -> dict[str, Real]:
    """Return what presses on the walls of bores over their forces.

    A pin turns in the link in which it is not tight. Where that is not stated, the bore counts on which more presses.

    Parameters
    ----------
    case : Case
    wrenches : mapping of str to array (n, 6)
        Joint -> what its first link does to its second, about the second's point [N, N mm].

    Returns
    -------
    dict of str to array (n,)
        Joint -> that ratio, at least 1; without joints whose pins bear no couple, and those of links without parts.
    """
    found: dict[str, Real] = {}
    least = NOTHING * max(float(np.abs(wrench[:, :2]).max(initial=0.0)) for wrench in wrenches.values())
    for name in rubbing_joints(case):
        joint = case.joints[name]
        if joint.type != "revolute":
            continue
        try:
            rings = eyes(case, name)
        except CaseError:
            continue
        second = wrenches[name]
        first = shifted(second, np.array([0.0, 0.0, case.linkage.rise(name)]))
        size = np.hypot(second[:, 0], second[:, 1])
        ratios = [
            pressing(wrench[:, 0] + 1j * wrench[:, 1], wrench[:, 3] + 1j * wrench[:, 4], ring)
            / np.where(size > least, size, np.inf)
            for link, ring, wrench in zip(joint.links, rings, (first, second), strict=True)
            if link != joint.tight_in
        ]
        ratio = np.where(size > least, np.max(ratios, axis=0), 1.0)
        if np.any(ratio > 1.0):
            found[name] = ratio
    return found


def largest(every: Iterable[Presses]) -> dict[str, Real]:
    """Return the largest ratio of every bore.

    Parameters
    ----------
    every : iterable of mapping of str to array (n,)
        From ``bore_presses``.

    Returns
    -------
    dict of str to array (n,)
    """
    found: dict[str, Real] = {}
    for one in every:
        for name, ratio in one.items():
            found[name] = np.maximum(ratio, found.get(name, 1.0))
    return found
