"""What doubt about the links' stiffness makes of joint forces, and of the stress that follows from them.

Each cause changes a joint force, and a link's stress by hand calculation, by some share of it. To first order these
shares add up, each upwards or downwards; all causes are taken at their worst together.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from fea.beam.cut_free import link_loads
from fea.check.link_by_hand import link_by_hand
from fea.check.load_growth import LEAST, Growths
from fea.common.link_loads import LinkLoads
from fea.common.scatter import Scatter
from fea.common.source import Source
from fea.frame.joint_forces import JointForces
from loads.case.case import Case
from loads.records.applied import Load


def force_doubt(case: Case, load_case: str, forces: JointForces, loads: Sequence[Load]) -> Growths:
    """Return by how much stress, displacement and joint forces may differ since the links' stiffness is in doubt.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    loads : sequence of Load
        That act on the links.

    Returns
    -------
    Growths
        Empty where the forces do not depend on the links' stiffness, or the frame has no condensed solids.
    """
    changes, sources = forces.open_by, forces.sources
    if not changes:
        return Growths()
    stress, displacement = {}, {}
    for link in case.checked_links:
        body = case.body(link)
        every = (forces.reactions, *(change.reactions for change in changes))
        plain, *others = (
            _measures(case, link, link_loads(load_case, link, body, reactions, loads)) for reactions in every
        )
        stress[link] = _around(plain[0], (one[0] for one in others), sources)
        displacement[link] = _around(plain[1], (one[1] for one in others), sources)
    joints = {}
    for name, joint in forces.reactions.joints.items():
        along = joint.force / (joint.magnitude or 1.0)
        found = (float(along @ change.reactions.joints[name].force) for change in changes)
        joints[name] = _around(joint.magnitude, found, sources)
    return Growths(stress=_open(stress), displacement=_open(displacement), joints=_open(joints))


def _measures(case: Case, link: str, loads: LinkLoads) -> tuple[float, float]:
    """Stress and displacement by hand; the largest pin force for both of a link for which no beam stands."""
    hand = link_by_hand(case, link, loads)
    if hand.check.without:
        largest = max(float(np.linalg.norm(pin.wrench[:3])) for pin in loads.pins)
        return largest, largest
    return hand.worst[1].equivalent, hand.displacement


def _around(value: float, changed: Iterable[float], sources: tuple[Source, ...]) -> Scatter:
    """Least and largest factor on a value, with what it becomes by each cause alone."""
    steps = np.array([one - value for one in changed]) / (value or np.inf)
    low, high = float(np.minimum(steps, 0.0).sum()), float(np.maximum(steps, 0.0).sum())
    return Scatter(low=max(1.0 + low, 0.0), high=1.0 + high, sources=sources)


def _open(found: Mapping[str, Scatter]) -> dict[str, Scatter]:
    return {name: one for name, one in found.items() if one.high - one.low > LEAST}
