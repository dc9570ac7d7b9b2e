"""Whether it would help to state in which links pins are tight: asked of the checks that the sharing of couples opens.

Entries ``tight_in`` are recommended only where some would decide what is open, and these are told: the ways of sharing
that they leave are solved, and take the place of all ways in the band.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.doubts.force_doubt import sharing_doubt
from alula.fea.frame.joint_forces import JointForces
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

    def decided_by(self, link: str, tight: Mapping[str, tuple[str, ...]] | None) -> bool:
        """Return whether all of a link's checks would be decided with pins stated tight.

        Parameters
        ----------
        link : str
        tight : mapping of str to tuple of str, or None
            Joint -> its entry ``tight_in``; None for pins that tilt nowhere.

        Returns
        -------
        bool
        """
        known, every = self.told[link], self.by_hand.get(link, Scatter())
        left = Scatter() if tight is None else self._left(tight, link)
        # The band may hold what solids make of all ways; of those that are left, hand calculation tells their part.
        low = 1.0 - (1.0 - known.low) * _part(1.0 - left.low, 1.0 - every.low)
        high = 1.0 + (known.high - 1.0) * _part(left.high - 1.0, every.high - 1.0)
        lower = low / known.low if known.low > 0.0 else 1.0
        return all(_decided(one, lower, high / known.high) for one in self.open_checks(link))

    def _left(self, tight: Mapping[str, tuple[str, ...]], link: str) -> Scatter:
        """What the ways of sharing that are left make of the stress of a link."""
        forces = self._stated(tuple(sorted(tight.items())))
        doubt = sharing_doubt(self.case, self.load_case, forces, self.loads, grown=self.grown, links=[link])
        return doubt.stress.get(link, Scatter())

    @cached_property
    def _stated(self) -> Callable[[tuple[tuple[str, tuple[str, ...]], ...]], JointForces]:
        """The joint forces with pins stated tight; the same for all links."""
        frame = self.forces.frame
        assert frame is not None
        linkage = frame.pose.linkage

        @cache
        def stated(tight: tuple[tuple[str, tuple[str, ...]], ...]) -> JointForces:
            said = dict(tight)
            joints = {n: j.model_copy(update={"tight_in": said.get(n, j.tight_in)}) for n, j in linkage.joints.items()}
            pose = replace(frame.pose, linkage=replace(linkage, joints=joints))
            return replace(self.forces, frame=replace(frame, pose=pose))

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
        words = reason("no_tight_pins_decide")
        if all(one.decided_by(link, None) for one in cases):
            helps = (said for said, tight in _statements(cases[0].case, link)
                     if all(one.decided_by(link, tight) for one in cases))  # fmt: skip
            words = next(helps, words)
        kind = "couples_of_layers" if len(names) == 1 else "couples_of_layers_at_most"
        told.append(under_load_cases(names, reason(kind, link=link, times=most, helps=words)))
    return told


def _statements(case: Case, link: str) -> Iterator[tuple[Reason, dict[str, tuple[str, ...]]]]:
    """Yield what may be stated of pins, the least first: as a reason, and joint by joint."""
    joints = case.linkage.joints
    unknown = [n for n, joint in joints.items() if joint.pivots and case.linkage.rise(n) != 0.0 and not joint.tight_in]
    own = [name for name in unknown if link in joints[name].links]
    for names, kind, which in (
        (own, "tight_in_both_decides", slice(2)),
        (unknown, "tight_in_first_decides", slice(1)),
        (unknown, "tight_in_second_decides", slice(1, 2)),
        (unknown, "tight_in_both_decides", slice(2)),
    ):
        if names:
            yield (
                reason(kind, joints=names),
                {name: tuple(joints[name].links)[which] for name in names},
            )
