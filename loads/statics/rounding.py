"""What is rounding in the solution of an equilibrium: told to people as zero."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]

_ROUNDING = 1e-9
"""Share of the solution's size below which a component is taken for rounding."""


def size_of(reactions: Reactions) -> Real:
    """Return the size of the forces and moments of a solution, beside which a component may be rounding.

    Parameters
    ----------
    reactions : Reactions

    Returns
    -------
    array (6,)
        Of Fx, Fy, Fz [N] and Mx, My, Mz [N mm]: a force times the longest link is a moment.
    """
    arm = reactions.pose.linkage.longest
    wrenches = np.abs([joint.wrench for joint in reactions.joints.values()]).reshape(-1, 6)
    forces, moments = wrenches[:, :3].max(initial=0.0), wrenches[:, 3:].max(initial=0.0)
    force = max(forces, moments / arm, abs(reactions.drive_torque) / arm, abs(reactions.drive_force))
    return np.array([force] * 3 + [force * arm] * 3)


def rounded(wrench: Real, size: Real) -> Real:
    """Return a wrench with zero for what is rounding.

    Parameters
    ----------
    wrench, size : array (..., 6)
        [N, N mm]

    Returns
    -------
    array (..., 6)
    """
    return np.where(np.abs(wrench) <= _ROUNDING * size, 0.0, wrench)


def without_rounding(reactions: Reactions) -> Reactions:
    """Return joint reactions and drive with zero for what is rounding beside the largest of them.

    Parameters
    ----------
    reactions : Reactions

    Returns
    -------
    Reactions
        With the same equations and unknowns.
    """
    size = size_of(reactions)
    drive = rounded(np.array([reactions.drive_force, 0.0, 0.0, 0.0, 0.0, reactions.drive_torque]), size)
    return replace(
        reactions,
        joints={name: replace(joint, wrench=rounded(joint.wrench, size)) for name, joint in reactions.joints.items()},
        drive_force=float(drive[0]),
        drive_torque=float(drive[5]),
    )
