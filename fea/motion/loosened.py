"""Links with play of pins over a motion: by how much their stress, and the forces of joints, may differ by it.

Each link is looked at in two poses: that in which most acts on it, and that in which most may act with play, by the
first-order ends of its joint forces at all poses. There it is calculated by hand as a check of one pose does
(``fea.check.play_doubt``), and the larger stress of both, over that without play, widens its bands.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.beam.cut_free import link_loads
from fea.check.force_doubt import measures
from fea.check.play_doubt import play_doubt
from fea.common.scatter import Scatter
from fea.common.source import distinct, play_source
from fea.motion.layered import forces_at
from geometry.base.errors import CaseError
from loads.records.applied import chosen
from loads.states.case_motion import CaseMotion
from loads.states.loose_motion import LooseMotion, loose_motion


def loosened(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> dict[tuple[str, str], Scatter]:
    """Return what play makes of the greatest stress of links over a motion.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of tuple of 2 str to Scatter
        (load case, link) -> by what it may differ; empty without play.

    Raises
    ------
    CaseError
        Where play may take the linkage through a dead point at a pose that counts.
    """
    loose = loose_motion(moved)
    if loose is None:
        return {}
    _refuse_dead_points(loose, evaluated)
    return {(n, link): _link(loose, n, link, evaluated) for n in moved.loads for link in moved.case.checked_links}


def _refuse_dead_points(loose: LooseMotion, evaluated: NDArray[np.bool_]) -> None:
    through = np.flatnonzero(loose.passes & evaluated)
    if through.size:
        motion, drive = loose.moved.motion, loose.moved.drive
        at = f"{float(motion.told(motion.angles[through[0]])):.5g} {motion.unit}"
        joint = max(loose.clearances, key=lambda name: loose.clearances[name])
        raise CaseError(
            f"joints.{joint}.clearance: with {loose.clearances[joint]:g} mm play may take the linkage through a dead "
            f"point of the driven link {drive.link} at {motion.coordinate} = {at}, where joint forces have no end; "
            "state less play, shorten the motion, or allow less growth of the drive torque"
        )


def joint_growth(moved: CaseMotion, load_case: str, joint: str, evaluated: NDArray[np.bool_]) -> Scatter:
    """Return what play makes of a joint's greatest force over a motion, to first order.

    Parameters
    ----------
    moved : CaseMotion
    load_case, joint : str
        Their names.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    Scatter
        On its force without play.
    """
    loose = loose_motion(moved)
    force = np.linalg.norm(moved.forces[load_case].forces[joint], axis=1)[evaluated]
    if loose is None or not force.max() > 0.0:
        return Scatter()
    slack = loose.slack(load_case, f"force {joint}")[evaluated]
    low, high = (float((force + sign * slack).max() / force.max()) for sign in (-1.0, 1.0))
    return Scatter(low=max(low, 0.0), high=high, sources=(play_source(loose.clearances),))


def _link(loose: LooseMotion, load_case: str, link: str, evaluated: NDArray[np.bool_]) -> Scatter:
    moved, case = loose.moved, loose.moved.case
    body, pins = case.body(link), case.linkage.joints_of(link)
    size = link_loads(load_case, link, body, moved.forces[load_case], moved.loads[load_case]).size(case.linkage.longest)
    reach = size + sum(loose.slack(load_case, f"force {joint}") for joint in pins)
    first, second = (int(np.argmax(np.where(evaluated, of, -np.inf))) for of in (size, reach))
    found = {pose: _at(loose, load_case, link, pose) for pose in (first, second)}
    (plain, own), (other, far) = found[first], found[second]
    if not plain > 0.0:
        return Scatter()
    sources = distinct(own.sources, far.sources) or (play_source(loose.clearances),)
    return Scatter(low=own.low, high=max(own.high, far.high * other / plain), sources=sources)


def _at(loose: LooseMotion, load_case: str, link: str, pose: int) -> tuple[float, Scatter]:
    """Stress of a link by hand at a pose without play, and what play makes of it."""
    moved, case = loose.moved, loose.moved.case
    loads = [chosen(load, pose) for load in moved.loads[load_case]]
    forces = replace(forces_at(moved, load_case, pose), play=loose.play(load_case, pose))
    doubt = play_doubt(case, load_case, forces, loads, links=(link,)).stress.get(link, Scatter())
    return measures(case, link, link_loads(load_case, link, case.body(link), forces.reactions, loads))[0], doubt
