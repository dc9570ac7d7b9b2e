"""Load cases under which nothing acts inside any link: a check that nothing was asked of is undecided, not passed.

Opposed forces at different points of one link act inside it, forces that cancel at one point do not. What is left of
a sum by rounding is no load; it is measured against what is stated.
"""

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.link_loads import LineLoad, LinkLoads
from fea.common.verdict import CheckOutcome, Quantity, Subject
from fea.outcomes.limits import least_safety_factor
from loads.case.case import Case
from loads.records.applied import BodyForce, Load, PointLoad
from loads.records.check_spec import SafetyFactorCheck
from loads.states.actions import stated_loads

Real = NDArray[np.float64]

SHARE = 1e-9
"""Share of the stated loads below which a force is rounding: 16 digits, of which a near dead point costs 6."""


def load_size(loads: Iterable[Load], length: float) -> float:
    """Return the largest of the loads' sizes but for weight and inertia, which act inside their link anyway.

    Parameters
    ----------
    loads : iterable of Load
    length : float
        By which moments are divided [mm].

    Returns
    -------
    float
        [N]
    """
    sizes = [0.0]
    for load in loads:
        if isinstance(load, PointLoad):
            sizes.append(_size(load.wrench, length))
        elif not isinstance(load, BodyForce):
            most = max(float(np.linalg.norm(end)) for end in (load.at_start, load.at_end))
            sizes.append(most * (load.end - load.start))
    return max(sizes)


def acts(loads: LinkLoads, size: float, length: float) -> bool:
    """Return True if anything but rounding acts on a link.

    Parameters
    ----------
    loads : LinkLoads
    size : float
        Of the loads that the load case states [N].
    length : float
        By which moments are divided [mm].

    Returns
    -------
    bool
    """
    inert = (np.any(b.specific_force) or b.angular_speed or b.angular_acceleration for b in loads.bodies)
    wrenches = [p.wrench for p in loads.pins] + [e.wrench for e in loads.ends]
    found = [_size(wrench, length) for wrench in wrenches] + [abs(c.torque) / length for c in loads.couples]
    return any(inert) or max([*found, _spread(loads.lines)], default=0.0) > SHARE * size


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
    pins = tuple(replace(pin, wrench=np.zeros(6)) for pin in loads.pins)
    ends = tuple(replace(end, wrench=np.zeros(6)) for end in loads.ends)
    return LinkLoads(name=loads.name, pins=pins, ends=ends)


def _size(wrench: Real, length: float) -> float:
    return max(float(np.linalg.norm(wrench[:3])), float(np.linalg.norm(wrench[3:])) / length)


def _spread(lines: Sequence[LineLoad]) -> float:
    """Return the largest force [N] that spread loads leave between two neighbouring ends, added where they overlap."""
    ends = sorted({x for line in lines for x in (line.first, line.last)})
    largest = 0.0
    for start, end in itertools.pairwise(ends):
        total = np.zeros((2, 3))
        for line in lines:
            if line.first <= start and end <= line.last:
                for row, x in enumerate((start, end)):
                    share = (x - line.first) / (line.last - line.first)
                    total[row] += (1.0 - share) * line.intensity[0] + share * line.intensity[1]
        largest = max(largest, (end - start) * float(np.linalg.norm(total, axis=1).max()))
    return largest


def nothing_acts(title: str, size: float) -> str:
    """Say why the checks of a load case decide nothing.

    Parameters
    ----------
    title : str
        The load case.
    size : float
        Of the loads that it states [N].

    Returns
    -------
    str
    """
    why = "its loads cancel where they act, or pass by every link with a part" if size else "it states no load"
    return f"nothing acts inside any link under load case '{title}' ({why}), so its checks cannot decide; add a load"


def undecided(
    outcomes: Iterable[CheckOutcome], title: str, size: float, joints: Mapping[str, float]
) -> Iterator[CheckOutcome]:
    """Yield the outcomes of a load case under which nothing acts inside any link, undecided.

    Pins and motors keep theirs where a joint bears a force.

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
        borne = outcome.subject.kind == "pin" and outcome.subject.name in bearing
        if borne or (outcome.quantity is Quantity.DRIVE_POWER and bearing):
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
    for name, check in case.all_checks.items():
        if not isinstance(check, SafetyFactorCheck):
            continue
        for link in check.links or case.checked_links:
            limit = least_safety_factor(name, check.minimum, case.material_of(link), link)
            yield CheckOutcome.of(name, Subject.link(link), title, Quantity.SAFETY_FACTOR, Band.unknown(), limit)


def stated_size(case: Case, title: str) -> float:
    """Return ``load_size`` of what a load case states, whatever the pose.

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
    stated = stated_loads(case, case.load_cases[title], {})
    return load_size((one.load for one in stated), case.linkage.longest)
