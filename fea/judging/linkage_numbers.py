"""The linkage as a whole under a load case, in numbers with bands: its limit-load factor and largest displacement."""

from collections.abc import Iterator, Mapping
from functools import partial

import numpy as np

from alula.fea.asked.asked import Asked, asked
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason, together, under_load_cases
from alula.fea.common.verdict import CheckOutcome
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.point_displacement import PointDisplacement
from alula.fea.outcomes.point_shares import LoadedLinkage
from alula.fea.outcomes.result import LinkageNumbers, LinkResult
from alula.fea.standing.case_statics import CaseStatics
from alula.fea.standing.joint_forces import JointForces
from alula.loads.case.case import Case
from alula.loads.records.check_spec import LimitLoadCheck

NEARLY = 0.8
"""Share of the frame's largest displacement from which on a point may be the one that moves most."""


def linkage_numbers(
    case: Case,
    load_case: str,
    moved: LargeDisplacement,
    forces: JointForces,
    links: Mapping[str, LinkResult] | None = None,
    free: Mapping[str, LinkLoads] | None = None,
) -> LinkageNumbers:
    """Return the numbers of the linkage as a whole.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it.
    forces : JointForces
        In the undeformed pose.
    links : mapping of str to LinkResult, optional
        Whose solids tell how far points move, where these were solved; the frame alone when left out.
    free : mapping of str to LinkLoads, optional
        Loads of every link cut free; empty where equilibrium alone does not give the joint forces.

    Returns
    -------
    LinkageNumbers
    """
    links, free = links or {}, free or {}
    loaded = LoadedLinkage(case=case, load_case=load_case, moved=moved, links=links, free=free, forces=forces)
    return LinkageNumbers(case=case, moved=moved, forces=forces, largest=partial(_largest, loaded))


def limit_load_outcomes(case: Case, load_case: str, linkage: LinkageNumbers) -> Iterator[CheckOutcome]:
    """Yield the outcome of every check of the limit load in a pose.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    linkage : LinkageNumbers
        Of the load case.

    Yields
    ------
    CheckOutcome
    """
    for one in asked(case, LimitLoadCheck):
        yield limit_load_outcome(one, load_case, linkage.limit_load)


def limit_load_outcome(one: Asked, load_case: str, factor: Band, where: Reason | None = None) -> CheckOutcome:
    """Return the outcome of a check of the limit load.

    Parameters
    ----------
    one : Asked
    load_case : str
        Its name.
    factor : Band
        Of one pose, or the least of a motion.
    where : Reason, optional
        In which poses.

    Returns
    -------
    CheckOutcome
    """
    found = one.outcome(load_case, factor)
    return found.because(together(factor.without if factor.unknowable else found.reason, where))


def _largest(loaded: LoadedLinkage) -> tuple[Band, Reason | str]:
    """Largest displacement of any place [mm], and that place."""
    moved, forces = loaded.moved, loaded.forces
    sizes = {key: float(np.linalg.norm(d)) for key, d in moved.points.items()}
    if not sizes or moved.frame is None or moved.solution is None:
        return Band.unknown(moved.reason), ""
    places = {tuple(np.round(moved.points[key], 9)): key for key in sizes}  # the two links at a pin move alike
    most, bands = max(sizes.values()), {}
    for link, point in places.values():
        if (forces is not None and forces.play is not None) or sizes[link, point] >= NEARLY * most:
            told = PointDisplacement.at(loaded, link, point)
            if told.why:
                return Band.unknown(told.why), ""
            bands[link, point] = told.value
    link, point = max(bands, key=lambda key: bands[key].value)
    found, where = Band.largest(list(bands.values())), f"{point} of {link}"
    linear = max(float(np.linalg.norm(moved.solution.displacements[node, :3])) for node in moved.frame.points.values())
    if moved.linear > (1.0 + 1e-6) * linear > 0.0:  # between points, where stations of the links tell
        return found.times(moved.linear / linear), moved.where
    return found, where


def left_stops(statics: CaseStatics, moved: Mapping[str, LargeDisplacement]) -> Iterator[Reason]:
    """Yield a reason for every load case whose stop would have to pull on the deformed shape.

    Parameters
    ----------
    statics : CaseStatics
    moved : mapping of str to LargeDisplacement
        Load case -> what became of it.

    Yields
    ------
    Reason
    """
    for load_case, what in moved.items():
        standing, reactions = statics.standing[load_case], what.reactions
        if not standing.stop or reactions is None or reactions.drive is None:
            continue
        linkage, effort = reactions.pose.linkage, float(reactions.effort)
        if effort * reactions.drive.sign(linkage) * standing.contact < 0.0:
            unit = reactions.drive.effort(linkage).unit
            yield under_load_cases(
                [load_case], reason("leaves_stop", stop=standing.stop, effort=abs(effort), unit=unit)
            )
