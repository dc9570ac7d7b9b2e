"""Whether it would help to state how pins sit in their holes: asked of the checks that the sharing of couples opens.

Fits are recommended only where they would decide what is open: the states of pins that a running fit leaves are sought,
and take the place of all states in the band. Where none decides, the joint is told whose fit narrows the band most.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.doubts.force_doubt import sharing_answers
from alula.fea.links.link_by_hand import HandStates
from alula.fea.pins.states import running, unstated
from alula.fea.standing.joint_forces import JointForces
from alula.loads.case.case import Case
from alula.loads.records.applied import Load

TELLING = 1.05
"""Growth of a link's stress by the sharing of couples above which it is told of, where a check is open."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedCouples:
    """What the sharing of couples leaves open under one load case.

    Attributes
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    loads : sequence of Load
        That act on the links.
    grown : bool
        As of ``alula.fea.doubts.force_doubt.sharing_doubt``.
    by_hand : mapping of str to Scatter
        Link -> what the ways of sharing make of its stress by hand.
    told : mapping of str to Scatter
        Link -> what they make of it in its band.
    checks : sequence of CheckOutcome
    """

    case: Case
    load_case: str
    forces: JointForces
    loads: Sequence[Load]
    grown: bool
    by_hand: Mapping[str, Scatter]
    told: Mapping[str, Scatter]
    checks: Sequence[CheckOutcome]

    def open_checks(self, link: str) -> list[CheckOutcome]:
        """Return the checks of a link's strength that are undecided since their band holds the limit.

        Parameters
        ----------
        link : str

        Returns
        -------
        list of CheckOutcome
        """
        strength = (Quantity.SAFETY_FACTOR, Quantity.LAYERS)
        own = (one for one in self.checks if one.link == link and one.quantity in strength)
        return [one for one in own if one.verdict is Verdict.UNDECIDED and _open(one, one.value)]

    def decided_by(self, link: str, joints: tuple[str, ...]) -> bool:
        """Return whether all of a link's checks would be decided with running fits stated.

        Parameters
        ----------
        link : str
        joints : tuple of str
            Whose pins run in holes of which nothing is stated.

        Returns
        -------
        bool
            A quick search that says no is enough for it; one that says yes is followed by a whole one.
        """
        return all(self._decides(link, self.left(link, joints, whole=whole)) for whole in (False, True))

    def _decides(self, link: str, left: Scatter) -> bool:
        known, every = self.told[link], self.by_hand.get(link, Scatter())
        if known.high == math.inf:  # nothing acts on it as stated
            return False
        # The band may hold what solids make of all states; of those that are left, hand calculation tells their part.
        low = 1.0 - (1.0 - known.low) * _part(1.0 - left.low, 1.0 - every.low)
        high = 1.0 + (known.high - 1.0) * _part(left.high - 1.0, every.high - 1.0)
        lower = low / known.low if known.low > 0.0 else 1.0
        return all(_decided(one, lower, high / known.high) for one in self.open_checks(link))

    def left(self, link: str, joints: tuple[str, ...], *, whole: bool = False) -> Scatter:
        """Return what pins leave of a link's stress by hand with running fits stated.

        Parameters
        ----------
        link, joints
            As of ``decided_by``.
        whole : bool, optional
            Search anew, in place of from the ends that all fits leave.

        Returns
        -------
        Scatter
        """
        forces = self._stated(joints, whole)
        answers = sharing_answers(self.case, self.load_case, link, forces, self.loads, grown=self.grown)
        (least, *low), (most, *high) = HandStates(self.case, link, answers.every).peaks.tolist()
        return Scatter(low=min(low) / least, high=max(high) / most) if least > 0.0 else Scatter()

    @cached_property
    def _stated(self) -> Callable[[tuple[str, ...], bool], JointForces]:
        """The joint forces as they stand, and the states that running fits of joints leave; the same for all links."""
        pins = self.forces.pins
        assert pins is not None

        @cache
        def stated(joints: tuple[str, ...], whole: bool) -> JointForces:
            return replace(self.forces, pins=running(self.case, pins, joints, like=None if whole else pins))

        return stated


def _part(left: float, every: float) -> float:
    return min(left / every, 1.0) if every > 0.0 else 1.0


def _open(check: CheckOutcome, value: Band) -> bool:
    return check.quantity.sense.verdict(value, check.limit) is Verdict.UNDECIDED


def _decided(check: CheckOutcome, low: float, high: float) -> bool:
    """Whether a check is decided with the ends of its stress times these factors; factors go with one over it."""
    if check.value.unknowable:
        return False
    value = check.value.value
    band = replace(check.value, low=min(check.value.low / high, value), high=max(check.value.high / low, value))
    return not _open(check, band)


def tight_pin_warnings(load_cases: Sequence[SharedCouples]) -> list[Reason]:
    """Return once of each link whose strength the sharing of couples between layers leaves open what would tell.

    Parameters
    ----------
    load_cases : sequence of SharedCouples

    Returns
    -------
    list of Reason
    """
    found: dict[str, list[SharedCouples]] = {}
    for one in load_cases:
        for link, growth in one.told.items():
            if one.open_checks(link) and growth.high > TELLING:
                found.setdefault(link, []).append(one)
    told = []
    for link, cases in found.items():
        names, most = [one.load_case for one in cases], max(one.told[link].high for one in cases)
        kind = "couples_of_layers" if len(names) == 1 else "couples_of_layers_at_most"
        told.append(under_load_cases(names, reason(kind, link=link, times=most, helps=_helps(cases, link))))
    return told


def _helps(cases: Sequence[SharedCouples], link: str) -> Reason:
    """Return the least statement that decides a link's checks, else the one that narrows them most."""
    first = cases[0]
    assert first.forces.pins is not None
    open_joints = unstated(first.case, first.forces.pins)
    own = tuple(name for name in open_joints if link in first.case.joints[name].links)
    for joints in dict.fromkeys([*((name,) for name in own), own, open_joints]):
        if joints and all(one.decided_by(link, joints) for one in cases):
            return reason("fits_decide", joints=list(joints))
    if not own:
        return reason("narrower_fits")
    widths = {name: max(one.left(link, (name,)).high for one in cases) for name in own}
    return reason("fit_narrows_most", joint=min(own, key=lambda name: widths[name]))
