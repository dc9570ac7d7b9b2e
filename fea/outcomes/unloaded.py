"""Load cases under which nothing acts inside any link: a check that nothing was asked of is undecided, not passed.

Opposed forces at different points of one link act inside it, forces that cancel at one point do not. What is left of
a sum by rounding is no load; it is measured against what is stated.
"""

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.loads.acting.acting import loads_of
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.case.case import Case
from alula.loads.records.applied import LineLoad, load_size, wrench_size
from alula.loads.records.check_spec import SafetyFactorCheck
from alula.loads.states.actions import lasting, stated_loads

Real = NDArray[np.float64]

SHARE = 1e-8
"""Share of the stated loads below which a force is rounding: 16 digits, of which a near dead point costs 6, and on the
deformed shape what its equilibrium is iterated to, 1e-9 of the loads at each joint."""


def acts(loads: LinkLoads, size: float, length: float) -> bool:
    """Return True if anything but rounding acts on a link, at any of the poses.

    Parameters
    ----------
    loads : LinkLoads
        On the link, at one pose or at n.
    size : float
        Of the stated loads [N], beside which rounding is rounding.
    length : float
        By which moments are divided [mm].

    Returns
    -------
    bool
    """
    force = loads.inertia
    if force is not None and any(
        np.any(values) for values in (force.specific_force, force.angular_acceleration, force.angular_speed_squared)
    ):
        return True
    found = [wrench_size(wrench, length) for _, wrench in loads.wrenches]
    found += [float(np.max(np.abs(couple.torque))) / length for couple in loads.couples]
    return max([*found, _spread(loads.lines)], default=0.0) > SHARE * size


def without_rounding(loads: LinkLoads, size: float, length: float) -> LinkLoads:
    """Return the loads on a link, with zeros for what is but rounding: as loads these would not balance.

    Parameters
    ----------
    loads : LinkLoads
    size : float
        Of the loads that the load case states [N].
    length : float
        By which moments are divided [mm].

    Returns
    -------
    LinkLoads
    """
    if acts(loads, size, length):
        return loads
    nothing = loads.with_wrenches(np.zeros_like(wrench) for _, wrench in loads.wrenches)
    return replace(nothing, couples=(), lines=(), inertia=None)


def _spread(lines: Sequence[LineLoad]) -> float:
    """Return the largest force [N] that spread loads leave between two neighbouring ends, added where they overlap."""
    stations = sorted({x for line in lines for x in (line.start, line.end)})
    largest = 0.0
    for start, end in itertools.pairwise(stations):
        over = [line for line in lines if line.start <= start and end <= line.end]
        for x in (start, end):
            shares = [(x - line.start) / (line.end - line.start) for line in over]
            total = sum(((1.0 - s) * q.at_start + s * q.at_end for s, q in zip(shares, over, strict=True)), np.zeros(3))
            largest = max(largest, (end - start) * float(np.linalg.norm(total, axis=-1).max()))
    return largest


def nothing_acts(title: str, size: float) -> Reason:
    """Say why the checks of a load case decide nothing.

    Parameters
    ----------
    title : str
        The load case.
    size : float
        Of the loads that it states [N].

    Returns
    -------
    Reason
    """
    return reason("nothing_acts", load_case=title, why=reason("loads_cancel" if size else "states_no_load"))


def undecided(
    outcomes: Iterable[CheckOutcome], title: str, size: float, joints: Mapping[str, float]
) -> Iterator[CheckOutcome]:
    """Yield the outcomes of a load case under which nothing acts inside any link, undecided.

    Pins and motors keep theirs where a joint bears a force, and so does what no load changes.

    Parameters
    ----------
    outcomes : iterable of CheckOutcome
    title : str
        The load case.
    size : float
        Of the loads that it states [N].
    joints : mapping of str to float
        Joint -> the force that it bears [N].

    Yields
    ------
    CheckOutcome
    """
    bearing = {name for name, force in joints.items() if force > SHARE * size}
    for outcome in outcomes:
        borne = outcome.subject.kind in ("pin", "joint") and outcome.subject.name in bearing
        moved = outcome.quantity is Quantity.DRIVE_POWER and bearing
        if borne or moved or outcome.quantity.unloaded:
            yield outcome
        else:
            yield outcome.left_open(nothing_acts(title, size))


def unloaded_links(case: Case, title: str) -> Iterator[CheckOutcome]:
    """Yield an outcome without value for every safety factor that an envelope would judge under an idle load case.

    Parameters
    ----------
    case : Case
    title : str
        The load case.

    Yields
    ------
    CheckOutcome
    """
    yield from (one.outcome(title, Band.unknown()) for one in asked(case, SafetyFactorCheck))


def stated_size(case: Case, title: str) -> float:
    """Return ``load_size`` of what a load case states, and of springs and load lines in the stated pose.

    Of loads that change over a cycle it is the largest.

    Parameters
    ----------
    case : Case
    title : str
        The load case.

    Returns
    -------
    float
        [N]
    """
    load_case, place, found = case.load_cases[title], case.stated_pose.placement, list[float]()
    for one in (load_case, *load_case.rows):
        posed = loads_of((*map(ForceOnLine, one.load_lines), *lasting(case)), place)
        found.append(load_size((*stated_loads(case, one), *posed), case.linkage.longest))
    return max(found)
