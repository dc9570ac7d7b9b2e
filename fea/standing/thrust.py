"""Thrust along pins: what would push them out of their holes, and links off them."""

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.sought import sought
from alula.fea.common.source import COUPLES, distinct
from alula.fea.standing.joint_forces import JointForces
from alula.loads.statics.statics import Reactions

_ROUNDING = 1e-6
"""Share of the largest joint force below which thrust is rounding; hinges of pins that tilt are soft, and not free."""


def thrusts(forces: JointForces, deformed: Reactions | None = None) -> dict[str, Band]:
    """Return the force along every pin, with all that the stiffness of links and the sharing of couples leave open.

    A link in layers whose pins lie on either side of it, at the distance L, bears the couple P (e1 + e2) of a force P
    along it, e1 and e2 off its mid-plane. Where its pins tilt in its neighbours, thrusts P (e1 + e2)/L balance it.

    Parameters
    ----------
    forces : JointForces
        In the undeformed pose, where the ways of sharing are known.
    deformed : Reactions, optional
        On the deformed shape where that counts; the ways of sharing change it by as much as in the undeformed pose.

    Returns
    -------
    dict of str to Band
        Revolute joint that is not bonded -> size of the force along z [N]; none where there is no thrust beyond
        rounding.
    """
    tight, linkage = forces.on_tight_pins.joints, forces.reactions.pose.linkage
    plain = forces.reactions.joints if deformed is None else tight
    shown = forces.reactions.joints if deformed is None else deformed.joints
    largest = max((joint.magnitude for joint in shown.values()), default=0.0)
    sources = distinct(forces.sources, COUPLES if forces.sharings else ())
    found = {}
    for name, joint in linkage.joints.items():
        if not joint.pivots:
            continue
        value, own = float(shown[name].wrench[2]), float(plain[name].wrench[2])
        steps = np.array(
            [float(one.reactions.joints[name].wrench[2] - tight[name].wrench[2]) for one in forces.open_by]
        )
        shared = [float(one.joints[name].wrench[2]) - own for one in forces.sharings]
        less, more = sought([0.0, *shared])
        low = value + float(np.minimum(steps, 0.0).sum()) + less
        high = value + float(np.maximum(steps, 0.0).sum()) + more
        ends = sorted((abs(low), abs(high)))
        if ends[1] > _ROUNDING * largest:
            least = 0.0 if low <= 0.0 <= high else ends[0]
            found[name] = Band(value=abs(value), low=min(least, abs(value)), high=ends[1], sources=sources)
    return found
