"""One load case by hand: what acts on every link cut free, its hand calculation, and what is out of proportion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce

from alula.fea.check.known_stiffness import as_stiff_as_may_be
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import distinct
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.doubts.causes import COUPLES, Cause, Stated, causes_of
from alula.fea.doubts.force_doubt import rim_doubt
from alula.fea.doubts.load_growth import Growths, growths
from alula.fea.doubts.narrow_holes import narrow_holes
from alula.fea.doubts.other_case import Doubt, OtherCase, Plates, widened
from alula.fea.doubts.play_doubt import play_at_joint
from alula.fea.doubts.tight_pins import SharedCouples
from alula.fea.judging.link_result import by_hand_shares, link_result, open_ranges, together_shares, worse_plate
from alula.fea.judging.linkage import linkage_outcomes
from alula.fea.judging.linkage_numbers import limit_load_outcomes, linkage_numbers
from alula.fea.judging.loading import Demand
from alula.fea.links.fidelity import DecidedLink
from alula.fea.links.link_by_hand import LinkByHand, every_plate_by_hand
from alula.fea.links.second_order import NEGLIGIBLE
from alula.fea.links.solid_result import link_task
from alula.fea.nonlinear.large_displacement import LargeDisplacement, with_growth
from alula.fea.outcomes.result import LinkResult
from alula.fea.outcomes.unloaded import acts
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.link_series import STRESS
from alula.fea.refine.refinement import RefinedSolid
from alula.fea.standing.case_statics import CaseStatics
from alula.fea.standing.joint_forces import JointForces
from alula.fea.superposition.link_answers import LinkAnswers
from alula.fea.superposition.solid_shares import Shares, solid_shares
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import turned_by_drive
from alula.loads.records.applied import load_size

SolvedAnswers = Mapping[str, Shares]
"""Cause -> what it makes of the numbers of a link on its solid."""
LESS_BY_SOLID = 3.0
"""How much less the sharing of couples may change the stress of a solid than by hand: by 2.71 at most of 26 ends of
links drawn at random."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCaseByHand:
    """One load case by hand: what acts on every link cut free, its hand calculation, and what is out of proportion.

    Attributes
    ----------
    case : Case
        As it stands under the load case.
    statics : CaseStatics
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of its frame.
    plates : mapping of str to sequence of tuple of (LinkLoads, LinkByHand)
        One of every link; of a pair whose plates bear differently both, first the worse one by hand.
    size : float
        Of all that acts [N], beside which a load is none.
    growth : Growths
        What grows beyond the load alone.
    causes : sequence of Cause
        What leaves the loads on links open.
    """

    case: Case
    statics: CaseStatics
    load_case: str
    moved: LargeDisplacement
    plates: Mapping[str, Sequence[tuple[LinkLoads, LinkByHand]]]
    size: float
    growth: Growths = field(default_factory=Growths)
    causes: Sequence[Cause] = ()

    @classmethod
    def as_stated(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "LoadCaseByHand":
        """Return a load case without what is out of proportion.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of its frame.

        Returns
        -------
        LoadCaseByHand
        """
        case, loads = statics.standing[load_case].case, statics.loads[load_case]
        reactions = statics.reactions[load_case]
        moved = with_growth(case, load_case, moved, loads)
        return cls(
            case=case,
            statics=statics,
            load_case=load_case,
            moved=moved,
            plates=every_plate_by_hand(case, load_case, moved, reactions, loads),
            size=load_size(loads, case.linkage.longest),
        )

    @classmethod
    def of(
        cls,
        statics: CaseStatics,
        load_case: str,
        moved: LargeDisplacement,
        doubts: Sequence[Doubt],
        told: Sequence[str] | None = None,
    ) -> "LoadCaseByHand":
        """Return a load case with what is out of proportion.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of its frame.
        doubts : sequence of Doubt
            Of its air and friction.
        told : sequence of str, optional
            As of ``check_case``.

        Returns
        -------
        LoadCaseByHand
        """
        found = cls.as_stated(statics, load_case, moved)
        case, loads, moved = found.case, statics.loads[load_case], found.moved
        hands = {link: plates[0][1] for link, plates in found.plates.items()}
        growth = growths(case, load_case, statics.pose, loads, moved, statics.reactions[load_case], hands)
        stated = Stated(
            case=case,
            load_case=load_case,
            forces=found.forces,
            shared=found.shared_forces,
            loads=loads,
            grown=found.bent,
            links=told,
        )
        growth = growth.times(rim_doubt(case, load_case, moved, stated.shared, loads, told)).times(narrow_holes(case))
        return replace(found, growth=growth, causes=(*causes_of(stated), *doubts))

    @property
    def bent(self) -> bool:
        """True where what acts on links holds their bending on free pins already, which ``cut_link`` adds."""
        return self.moved.state in ("off", "unknown")

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Those of its causes that change what acts: air and friction."""
        return tuple(one for one in self.causes if isinstance(one, Doubt))

    @cached_property
    def shared(self) -> Growths:
        """What the ways of sharing couples between layers make by hand."""
        return next((cause.growths for cause in self.causes if cause.name == COUPLES), Growths())

    @cached_property
    def uneven(self) -> Growths:
        """What grows beyond the load alone, with all causes but the sharing of couples."""
        return reduce(Growths.times, (one.growths for one in self.causes if one.name != COUPLES), self.growth)

    @cached_property
    def grown(self) -> Growths:
        """The same of causes that do not tell of columns themselves."""
        others = (one for one in self.causes if one.name != COUPLES and not one.of_columns)
        return reduce(Growths.times, (one.growths for one in others), self.growth)

    def acts_on(self, link: str) -> bool:
        """Return True if anything acts on a link.

        Parameters
        ----------
        link : str

        Returns
        -------
        bool
        """
        return acts(self.cut[link], self.size, self.case.linkage.longest)

    @cached_property
    def cut(self) -> Mapping[str, LinkLoads]:
        """What acts on every link, or on its worse plate."""
        return {link: found[0][0] for link, found in self.plates.items()}

    @property
    def idle(self) -> bool:
        """True where nothing acts on any link."""
        return bool(self.cut) and not any(map(self.acts_on, self.cut))

    @property
    def free(self) -> Mapping[str, LinkLoads]:
        """Loads of every link cut free; empty where equilibrium alone does not give the joint forces."""
        return self.cut if self.forces.by_equilibrium else {}

    @property
    def lost(self) -> bool:
        """True where the linkage gives way whatever the solids of its links may tell."""
        return any(one.gives_way for one in self._whole(self.moved))

    def _whole(self, moved: LargeDisplacement) -> list[CheckOutcome]:
        """Return what becomes of the linkage as a whole, with its doubts."""
        beams = {link: hand.check for link, ((_, hand), *_) in self.plates.items()}
        found = linkage_outcomes(self.load_case, moved, beams)
        return [reduce(lambda one, doubt: doubt.on_buckling(one), self.doubts, one) for one in found]

    @property
    def solids_may_hold_it(self) -> bool:
        """True where the stiffness of the links' solids could change a verdict on the linkage as a whole."""

        def verdicts(moved: LargeDisplacement) -> list[Verdict]:
            linkage = linkage_numbers(self.case, self.load_case, moved, self.forces)
            limits = limit_load_outcomes(self.case, self.load_case, linkage)
            return [one.verdict for one in (*self._whole(moved), *limits)]

        return bool(self.moved.blind) or verdicts(as_stiff_as_may_be(self.moved)) != verdicts(self.moved)

    def open_ranges(
        self, link: str, solved: SolvedAnswers | None = None, *, of_solid: bool = False
    ) -> dict[str, OpenRanges]:
        """Return within what numbers a link's checks are open whatever its meshes tell.

        Parameters
        ----------
        link : str
        solved : SolvedAnswers, optional
            What causes make of the link as a solid; by default what they make by hand.
        of_solid : bool, optional
            Where no solid has told: less what the sharing of couples may make less of it.

        Returns
        -------
        dict of str to OpenRanges
            By the name of its loads.
        """
        if solved is None:
            by_hand, uneven, less = by_hand_shares(self.shared, link), self.uneven, LESS_BY_SOLID if of_solid else 1.0
            shares: Shares = {
                x: replace(one, low=min(less * one.low, 1.0), high=max(one.high / less, 1.0))
                for x, one in by_hand.items()
            }
        else:
            shares, uneven = together_shares(solved), self.growth
        found = open_ranges(self.case, link, self.load_case, uneven, shares)
        return {loads.name: found for loads, _ in self.plates[link]}

    def others(self, link: str) -> list[LinkByHand]:
        """Return the hand calculations of a link, or of its plates, in other air and with other friction.

        Parameters
        ----------
        link : str

        Returns
        -------
        list of LinkByHand
        """
        return [own for doubt in self.doubts for one in doubt.cause.others for _, own in one.plates[link]]

    def columns(self, link: str) -> Plates:
        """Return the plates of a link of which the slenderest is judged as a column.

        Parameters
        ----------
        link : str

        Returns
        -------
        sequence of tuple of (LinkLoads, LinkByHand)
        """
        found: Plates = self.plates[link]
        for doubt in self.doubts:
            found = doubt.slenderest(self.case, link, found)
        return found

    @property
    def forces(self) -> JointForces:
        """Joint forces."""
        return self.statics.forces[self.load_case]

    @property
    def shared_forces(self) -> JointForces:
        """Joint forces of the numbers that the ways of sharing couples change: on the deformed shape of tight pins."""
        return self.forces if self.moved.reactions is None else self.forces.beside_tight_pins

    def links(
        self, decided: Mapping[str, DecidedLink], solved: Mapping[str, SolvedAnswers] | None = None
    ) -> dict[str, LinkResult]:
        """Return the results of links; of a pair, that of its worse plate.

        Parameters
        ----------
        decided : mapping of str to DecidedLink
            Of every link on which something acts.
        solved : mapping of str to SolvedAnswers, optional
            What causes make of links that are solids; of any other what they make by hand stands.

        Returns
        -------
        dict of str to LinkResult
        """
        return {link: self.link(link, decided.get(link), (solved or {}).get(link)) for link in self.plates}

    def link(self, link: str, decided: DecidedLink | None, solved: SolvedAnswers | None = None) -> LinkResult:
        """Return the result of a link; of a pair, that of its worse plate.

        Parameters
        ----------
        link : str
        decided : DecidedLink or None
            None where nothing acts on it.
        solved : SolvedAnswers, optional
            As of ``links``.

        Returns
        -------
        LinkResult
        """
        uneven, shares = self.doubts_on(link, solved)
        own = self.case, link, self.load_case
        return worse_plate(
            [link_result(*own, hand, decided, uneven, shares, name=loads.name) for loads, hand in self.plates[link]]
        )

    def with_growth(self, outcome: CheckOutcome) -> CheckOutcome:
        """Return the buckling factor of a link with what its compression may be in its band.

        What play makes of it is known; of all else what its joint forces may be, over the largest.

        Parameters
        ----------
        outcome : CheckOutcome

        Returns
        -------
        CheckOutcome
        """
        link = outcome.subject.name
        joints, grown = self.forces.reactions.joints, self.grown.joints
        every, spread = self.case.linkage.joints_of(link), self.uneven.columns.get(link, Scatter())
        own, largest = [x for x in every if x in grown], max((joints[x].magnitude for x in every), default=0.0)
        if own and largest > 0.0:
            # A joint that bears next to nothing may bear a thousand times as much, which is little to its link.
            parts = {x: min(joints[x].magnitude / (NEGLIGIBLE * largest), 1.0) for x in own}
            low, high = (min(part * (grown[x].low - 1.0) for x, part in parts.items()),
                         max(part * (grown[x].high - 1.0) for x, part in parts.items()))  # fmt: skip
            sources = distinct(*(grown[name].sources for name in own))
            spread = spread.times(Scatter(low=max(1.0 + low, 0.0), high=1.0 + high, sources=sources))
        return widened(outcome, spread)

    def growth_through(self, joint: str, demand: Demand) -> Scatter:
        """Return how all that goes through a joint grows beside scattered loads.

        Parameters
        ----------
        joint : str
        demand : callable
            What goes through it over what is borne.

        Returns
        -------
        Scatter
        """

        def of(other: OtherCase) -> float:
            return float(demand(other.case, other.reactions.joints[joint].wrench, other.reactions.driving[0]))

        driven = turned_by_drive(self.case, joint)
        growth = self.grown.through(joint).times(play_at_joint(self.forces.play, joint, driven=driven))
        for doubt in self.doubts:
            growth = growth.times(doubt.cause.scatter(doubt.stated, of))
        return growth

    def answers(self, link: str) -> dict[str, LinkAnswers]:
        """Return what may act on a link in place of what is stated.

        Parameters
        ----------
        link : str

        Returns
        -------
        dict of str to LinkAnswers
            By the name of the cause.
        """
        return {cause.name: cause.answers(link) for cause in self.causes}

    def solid_answers(self, link: str, solid: RefinedSolid, threads: int | None) -> SolvedAnswers | None:
        """Return what causes make of a link on its solid, each answer by itself.

        Parameters
        ----------
        link : str
        solid : RefinedSolid
        threads : int or None

        Returns
        -------
        SolvedAnswers or None
            None where it is not solved, and where nothing is in doubt.
        """
        names = {one.load for one in solid.solution.cases}
        causes = self.answers(link) if self.acts_on(link) else {}
        if not causes or not all(cut.name in names for cut, _ in self.plates[link]):
            return None
        task = link_task(self.case, link, next(iter(causes.values())).stated)
        return dict(zip(causes, solid_shares(task, solid, list(causes.values()), threads=threads), strict=True))

    def couples(self, solved: Mapping[str, SolvedAnswers], checks: Sequence[CheckOutcome]) -> SharedCouples:
        """Return what the sharing of couples leaves open of links' strength.

        Parameters
        ----------
        solved : mapping of str to SolvedAnswers
            By link.
        checks : sequence of CheckOutcome

        Returns
        -------
        SharedCouples
        """
        known = {link: shares["couples"] for link, shares in solved.items() if "couples" in shares}
        decisive = {link: STRESS[self.case.material_of(link).brittle] for link in known}
        return SharedCouples(
            case=self.case,
            load_case=self.load_case,
            forces=self.shared_forces,
            loads=self.statics.loads[self.load_case],
            grown=self.bent,
            by_hand=self.shared.stress,
            told={**self.shared.stress, **{link: shares[decisive[link]] for link, shares in known.items()}},
            checks=checks,
        )

    def doubts_on(self, link: str, known: SolvedAnswers | None) -> tuple[Growths, Shares]:
        """Return what leaves the loads of a link open: on its solid where causes were solved there, else by hand.

        Parameters
        ----------
        link : str
        known : SolvedAnswers or None
            None where it is no solid.

        Returns
        -------
        tuple of (Growths, Shares)
        """
        if known is None:
            return self.uneven, by_hand_shares(self.shared, link)
        return self.growth, together_shares(known)
