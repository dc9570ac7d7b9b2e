"""What a kind of check knows of the loads in a pose or over a motion, and what it makes of them.

``alula.fea.check.kinds`` lists the kinds. A check of a pose (``alula.fea.check``) and an envelope
(``alula.fea.motion``) each say what acts, in their own way; a kind judges it in one way.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome
from alula.fea.doubts.load_growth import Growths
from alula.fea.links.fidelity import DecidedLink
from alula.fea.links.link_by_hand import LinkByHand
from alula.fea.outcomes.result import LinkResult
from alula.fea.plastic.link_collapse import LinkCollapse
from alula.fea.superposition.solid_shares import Shares
from alula.loads.case.case import Case
from alula.loads.statics.statics import Equilibrium

Real = NDArray[np.float64]
Collapse = LinkCollapse | Reason | str
"""Of a link; why it is not known, where it is not."""
Demand = Callable[[Case, Real, Any], Real]
"""Of a case, of what a joint's first link does to its second, and of the torque of the drive."""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """What a check makes of one subject.

    Attributes
    ----------
    outcome : CheckOutcome
    numbers : tuple
        What it found besides, as ``alula.fea.outcomes.found.Found`` holds it.
    """

    outcome: CheckOutcome
    numbers: tuple[Any, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Loading:
    """What acts on the links and joints of a linkage in a pose under a load case.

    Attributes
    ----------
    case : Case
    load_case : str
        Its name.
    ways : callable
        Returns joint forces in all ways in which pins may share couples, first those that stand.
    loads, hands : callable
        Of a link: what acts on it, and its hand calculation; of a pair one of each plate.
    others : callable
        Of a link, to its hand calculations in other air and with other friction.
    joint_growth, link_growth : callable
        Of a joint, to how its force grows beside scattered loads (``alula.fea.doubts.load_growth``); of a link, to how
        its stress by hand does.
    growth_through : callable
        Of a joint and the demand on it, to how all that goes through it grows beside scattered loads.
    """

    case: Case
    load_case: str
    ways: Callable[[], Sequence[Equilibrium]]
    loads: Callable[[str], Sequence[LinkLoads]]
    hands: Callable[[str], Sequence[LinkByHand]]
    others: Callable[[str], Sequence[LinkByHand]]
    joint_growth: Callable[[str], Scatter]
    link_growth: Callable[[str], Scatter]
    growth_through: Callable[[str, Demand], Scatter]

    def wrenches(self, joint: str) -> list[Real]:
        """Return what a joint's first link does to its second, about the point of the second, in all ways.

        Parameters
        ----------
        joint : str

        Returns
        -------
        list of ndarray, shape (6,)
            [N, N mm]
        """
        return [way.joints[joint].wrench for way in self.ways()]


@dataclass(frozen=True, kw_only=True)
class OverMotion(Loading):
    """The same at the n poses of a motion: wrenches (n, 6), loads of n poses, growth of what is worst over them.

    Attributes
    ----------
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    at : callable
        Of the number of a pose, to what acts there.
    pin_growth : callable
        Of a joint, to how the stress of its pin grows beside scattered loads.
    most_growth : callable
        Of a joint, to the high end of how its force may grow at each pose (n,).
    """

    evaluated: NDArray[np.bool_]
    at: Callable[[int], "OverMotion"]
    pin_growth: Callable[[str], Scatter]
    most_growth: Callable[[str], NDArray[np.float64]]


@dataclass(frozen=True, kw_only=True)
class SolvedLinks(Loading):
    """The same in a pose, with what is known of links on their solids.

    Attributes
    ----------
    links : mapping of str to LinkResult
    decided : mapping of str to DecidedLink
        The links with a model that decides, of which some are solids.
    collapses : mapping of str to (LinkCollapse or Reason or str)
        By link; of those that are left out no solid was solved.
    acts_on : callable
        Of a link, to whether anything acts on it.
    doubts : callable
        Of a link, to what leaves its loads open, as ``alula.fea.judging.link_result.spread`` takes it.
    beside_one_force : Reason or None
        Why joint forces are not in proportion to one force alone; None where they are.
    """

    links: Mapping[str, LinkResult]
    decided: Mapping[str, DecidedLink]
    collapses: Mapping[str, Collapse]
    acts_on: Callable[[str], bool]
    doubts: Callable[[str], tuple[Growths, Shares]]
    beside_one_force: Reason | None = None


@dataclass(frozen=True, kw_only=True)
class ByHand:
    """A kind of check that is judged from loads alone, in a pose and over a motion alike.

    Attributes
    ----------
    judge : callable
        Returns what it makes of one subject in a pose.
    least : callable
        Returns by what its subject bears more at each pose of a motion, but for a constant: it is judged at that pose
        where this is least. ndarray, shape (n,).
    """

    judge: Callable[[Loading, Asked], Judged]
    least: Callable[[OverMotion, Asked], Real]


OnSolids = Callable[[SolvedLinks, Asked], Judged]
"""A kind of check that is judged on links as solids, in a pose alone."""
