"""Links with play of pins, or in other air, over a motion: by how much their stress and joint forces may differ.

With play each link is looked at in two poses: that in which most acts on it, and that in which most may act with play,
by the first-order ends of its joint forces at all poses. There it is calculated by hand as a check of one pose does
(``fea.check.play_doubt``), and the larger stress of both, over that without play, widens its bands.

So does the range of C_N of wings that flap: a link is calculated by hand at its worst poses with the stated C_N and
with either end of the range, and its largest stress of each is compared, as in a check (``fea.check.air_doubt``).
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.beam.cut_free import link_loads
from fea.check.air_doubt import air_scatter
from fea.check.force_doubt import measures
from fea.check.play_doubt import play_doubt
from fea.common.air_range import air_range
from fea.common.scatter import Scatter
from fea.common.source import distinct, play_source
from fea.motion.buckling_history import factors_over_motion
from fea.motion.layered import forces_at
from fea.motion.link_history import link_histories
from geometry.base.errors import CaseError
from geometry.base.ties import first_largest
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


def in_other_air(moved: CaseMotion, evaluated: NDArray[np.bool_]) -> dict[tuple[str, str], Scatter]:
    """Return what the range of C_N makes of the greatest stress of links over a motion.

    Parameters
    ----------
    moved : CaseMotion
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    dict of tuple of 2 str to Scatter
        (load case, link) -> by what it may differ; empty without a range.
    """

    def stress(one: CaseMotion, load_case: str, link: str, poses: set[int]) -> float:
        return max(_hand(one, load_case, link, pose) for pose in poses)

    found = {}
    for load_case, airs in _airs(moved).items():
        for link in moved.case.checked_links:
            poses = {first_largest(np.where(evaluated, _size(one, load_case, link), -np.inf)) for _, one in airs}
            numbers = [(c, stress(one, load_case, link, poses)) for c, one in airs]
            found[load_case, link] = _spread(numbers)
    return found


def column_growth(moved: CaseMotion, load_case: str, link: str, evaluated: NDArray[np.bool_]) -> Scatter:
    """Return what the range of C_N makes of the inverse of a link's least buckling factor over a motion.

    Parameters
    ----------
    moved : CaseMotion
    load_case, link : str
        Their names.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    Scatter
    """

    def inverse(one: CaseMotion) -> float:
        histories = [history for history in link_histories(one, link) if history.name == load_case]
        return max(
            float(1.0 / factors_over_motion(one.case, link, h).value[evaluated].min(initial=np.inf)) for h in histories
        )

    airs = _airs(moved).get(load_case, [])
    return _spread([(c, inverse(one)) for c, one in airs]) if airs else Scatter()


def _airs(moved: CaseMotion) -> dict[str, list[tuple[float, CaseMotion]]]:
    """Load case -> motions at the stated C_N and at the ends of its range; those with a range alone."""
    airs, found = air_range(moved), {}
    for name, load_case in moved.case.load_cases.items():
        air = load_case.flapping
        if air is not None and airs is not None and (ends := airs.at(name)):
            found[name] = [(air.normal_coefficient, moved), *zip(air.ends, ends, strict=True)]
    return found


def _spread(numbers: list[tuple[float, float]]) -> Scatter:
    stated, *others = numbers
    ends = [c for c, _ in others]
    return air_scatter(stated, dict(others), (min(ends), max(ends)))


def _size(moved: CaseMotion, load_case: str, link: str) -> NDArray[np.float64]:
    """Size of all that acts on a link at every pose."""
    case = moved.case
    loads = link_loads(load_case, link, case.body(link), moved.forces[load_case], moved.loads[load_case])
    return np.asarray(loads.size(case.linkage.longest))


def _hand(moved: CaseMotion, load_case: str, link: str, pose: int) -> float:
    """Stress of a link by hand at a pose."""
    case, loads = moved.case, [chosen(load, pose) for load in moved.loads[load_case]]
    forces = forces_at(moved, load_case, pose)
    return measures(case, link, link_loads(load_case, link, case.body(link), forces.reactions, loads))[0]


def joint_growth(moved: CaseMotion, load_case: str, joint: str, evaluated: NDArray[np.bool_]) -> Scatter:
    """Return what play and the range of C_N make of a joint's greatest force over a motion, play to first order.

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
        On its force without play, at the stated C_N.
    """
    loose = loose_motion(moved)

    def sizes(one: CaseMotion) -> NDArray[np.float64]:
        return np.asarray(np.linalg.norm(one.forces[load_case].forces[joint], axis=1)[evaluated])

    force, airs = sizes(moved), _airs(moved).get(load_case, [])
    air = _spread([(c, float(sizes(one).max())) for c, one in airs]) if airs else Scatter()
    if loose is None or not force.max() > 0.0:
        return air
    slack = loose.slack(load_case, f"force {joint}")[evaluated]
    low, high = (float((force + sign * slack).max() / force.max()) for sign in (-1.0, 1.0))
    return Scatter(low=max(low, 0.0), high=high, sources=(play_source(loose.clearances),)).times(air)


def _link(loose: LooseMotion, load_case: str, link: str, evaluated: NDArray[np.bool_]) -> Scatter:
    moved, case = loose.moved, loose.moved.case
    pins = case.linkage.joints_of(link)
    size = _size(moved, load_case, link)
    reach = size + sum(loose.slack(load_case, f"force {joint}") for joint in pins)
    first, second = (first_largest(np.where(evaluated, of, -np.inf)) for of in (size, reach))
    found = {pose: _at(loose, load_case, link, pose) for pose in (first, second)}
    (plain, own), (other, far) = found[first], found[second]
    if not plain > 0.0:
        return Scatter()
    sources = distinct(own.sources, far.sources) or (play_source(loose.clearances),)
    return Scatter(low=own.low, high=max(own.high, far.high * other / plain), sources=sources)


def _at(loose: LooseMotion, load_case: str, link: str, pose: int) -> tuple[float, Scatter]:
    """Stress of a link by hand at a pose without play, and what play makes of it."""
    moved = loose.moved
    loads = [chosen(load, pose) for load in moved.loads[load_case]]
    forces = replace(forces_at(moved, load_case, pose), play=loose.play(load_case, pose))
    doubt = play_doubt(moved.case, load_case, forces, loads, links=(link,)).stress.get(link, Scatter())
    return _hand(moved, load_case, link, pose), doubt
