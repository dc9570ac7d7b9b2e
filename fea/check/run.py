"""The whole check of a case: pose, statics, beams, solids, bands, verdict."""

import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce

from pydantic_core import PydanticCustomError

from alula.fea.asked.asked import Asked, asked, asked_of, asks
from alula.fea.asked.at_temperature import as_known
from alula.fea.beam.theory import BeamCheck, CantileverCheck, uniform_cantilever
from alula.fea.buckling.buckling import buckling_outcomes
from alula.fea.check.known_stiffness import as_stiff_as_may_be, with_known_stiffness
from alula.fea.check.point_solids import decide_point
from alula.fea.check.solid_frame import with_solids
from alula.fea.common.clock import Clock
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter, load_scatter
from alula.fea.common.source import distinct
from alula.fea.common.threads import bounded_run
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict, overall
from alula.fea.doubts.air_doubt import air_doubt, air_warnings
from alula.fea.doubts.force_doubt import sharing_answers, sharing_doubt, stiffness_answers, stiffness_doubt
from alula.fea.doubts.friction_doubt import friction_doubt, friction_warnings
from alula.fea.doubts.load_growth import Growths, growths
from alula.fea.doubts.other_case import Doubt, OtherCase, Plates, on_shape, widened
from alula.fea.doubts.play_doubt import play_answers, play_at_joint, play_doubt, play_warnings, shaken
from alula.fea.doubts.tight_pins import SharedCouples, tight_pin_warnings
from alula.fea.judging.bearing import bearing_outcome
from alula.fea.judging.connections import connection_factors, connection_outcome, least_factor, transmitted
from alula.fea.judging.eyes import eye_factors, eye_outcome, with_sharing
from alula.fea.judging.fatigue import pose_outcomes, pulsating
from alula.fea.judging.judge import outcomes
from alula.fea.judging.line_contact import contact_of, contact_outcome
from alula.fea.judging.link_result import by_hand_shares, link_result, open_ranges, together_shares, worse_plate
from alula.fea.judging.linkage import linkage_outcomes, unless_it_gives_way
from alula.fea.judging.linkage_numbers import left_stops, limit_load_outcomes, linkage_numbers
from alula.fea.judging.notches import notch_outcomes
from alula.fea.judging.plastic_collapse import Found, collapse_outcomes, find_collapses, needs_path
from alula.fea.judging.solid_buckling import solid_buckling_outcomes
from alula.fea.judging.walls import wall_factors, wall_outcome
from alula.fea.links.fidelity import DecidedLink, by_hand, decide
from alula.fea.links.link_by_hand import LinkByHand, cut_link, plates_by_hand, slenderest
from alula.fea.links.second_order import NEGLIGIBLE
from alula.fea.links.solid_result import link_task
from alula.fea.modes.connection_modes import ConnectionFactors
from alula.fea.modes.eye_modes import EyeFactors
from alula.fea.modes.line_contact import LineContact
from alula.fea.modes.wall_modes import WallFactor
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine, with_growth
from alula.fea.outcomes.fatigue import LinkFatigue
from alula.fea.outcomes.pins import PinStress, shared_stress, twist_of, twisted
from alula.fea.outcomes.point_displacement import meshes_to_refine
from alula.fea.outcomes.result import CheckResult, LinkResult, LoadCaseResult
from alula.fea.outcomes.unchecked import unusual_materials
from alula.fea.outcomes.unloaded import acts, load_size, nothing_acts, undecided
from alula.fea.plastic.link_collapse import LinkCollapse
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.link_series import STRESS
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import START, Effort, RefinedSolid
from alula.fea.solid.solution import SolidSolution, require_compressible
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics, with_ends
from alula.fea.standing.joint_forces import LAYERED_FRAME, JointForces, ways_to_hold
from alula.fea.superposition.link_answers import LinkAnswers
from alula.fea.superposition.solid_shares import Shares, solid_shares
from alula.fea.whole.layer_gaps import layer_gap_outcomes
from alula.fea.whole.outcomes import WholeNumbers, whole_numbers, whole_outcomes
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import PartKind
from alula.geometry.linkage.pose import NEAR_DEAD_POINT
from alula.geometry.meshing.mesh import MeshSettings
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case import Case
from alula.loads.case.connection_rules import turned_by_drive
from alula.loads.records.check_spec import (
    BearingCheck,
    ConnectionCheck,
    DisplacementCheck,
    EyeCheck,
    FatigueCheck,
    LineContactCheck,
    PinCheck,
    PlasticCollapseCheck,
    WallCheck,
)
from alula.loads.statics.statics import Reactions
from alula.loads.text.shares import parse_accuracy

Progress = Callable[[str], None]
FIDELITIES = ("auto", "beam", "frame", "solid")
BY_HAND = ("beam", "frame")
SolvedAnswers = Mapping[str, Shares]
"""Cause -> what it makes of the numbers of a link on its solid."""
LESS_BY_SOLID = 1.5
"""By what the sharing of couples may lower the stress of a solid less than that by hand: the owl wing has 1.39."""
POINT_ROUNDS = 4
"""At most, in which links are solved or refined for the displacement of a point."""


def effort_of(
    case: Case,
    accuracy: str | None = None,
    *,
    max_unknowns: int = Effort.max_unknowns,
    time_limit: float = Effort.time_limit,
) -> Effort:
    """Return what a check may cost.

    Parameters
    ----------
    case : Case
    accuracy : str, optional
        Such as ``"5 %"``; by default what the case says, else that of ``Effort``.
    max_unknowns : int
        Largest system that is solved to reach the accuracy.
    time_limit : float
        After it no further mesh is begun [s].

    Returns
    -------
    Effort

    Raises
    ------
    CaseError
        For a text that is no accuracy.
    """
    try:
        stated = case.solid.accuracy if accuracy is None else parse_accuracy(accuracy)
    except PydanticCustomError as error:
        raise CaseError(f"accuracy: it is '{accuracy}', but {error.message()}") from None
    effort = Effort(max_unknowns=max_unknowns, time_limit=time_limit)
    return effort if stated is None else replace(effort, accuracy=stated, stated=True)


@dataclass(frozen=True, kw_only=True)
class _LoadCase:
    """One load case by hand: what acts on every link cut free, its hand calculation, and what is out of proportion.

    ``plates`` has one of every link; of a pair whose plates bear differently both, first the worse one by hand.
    ``shared`` is what the ways of sharing couples between layers make by hand, and ``uneven`` all else; ``grown`` is
    ``uneven`` without play and ``doubts``, and ``growth`` what grows beyond the load alone.
    """

    case: Case
    statics: CaseStatics
    load_case: str
    moved: LargeDisplacement
    plates: Mapping[str, Sequence[tuple[LinkLoads, LinkByHand]]]
    size: float
    growth: Growths = field(default_factory=Growths)
    grown: Growths = field(default_factory=Growths)
    uneven: Growths = field(default_factory=Growths)
    shared: Growths = field(default_factory=Growths)
    doubts: Sequence[Doubt] = ()

    @classmethod
    def as_stated(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "_LoadCase":
        """Return a load case without what is out of proportion."""
        case, loads = statics.standing[load_case].case, statics.loads[load_case]
        reactions = statics.reactions[load_case]
        moved = with_growth(case, load_case, moved, loads)
        return cls(
            case=case,
            statics=statics,
            load_case=load_case,
            moved=moved,
            plates={
                link: plates_by_hand(case, link, cut_link(case, link, load_case, moved, reactions, loads))
                for link in case.checked_links
            },
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
    ) -> "_LoadCase":
        found = cls.as_stated(statics, load_case, moved)
        case, loads, moved = found.case, statics.loads[load_case], found.moved
        hands = {link: plates[0][1] for link, plates in found.plates.items()}
        forces = found.forces
        growth = growths(case, load_case, statics.pose, loads, moved, statics.reactions[load_case], hands)
        grown = growth.times(stiffness_doubt(case, load_case, forces, loads))
        uneven = grown.times(play_doubt(case, load_case, forces, loads, told))
        for doubt in doubts:
            uneven = uneven.times(doubt.growths)
        return replace(
            found,
            growth=growth,
            grown=grown,
            uneven=uneven,
            shared=sharing_doubt(case, load_case, forces, loads, grown=_grown(moved), links=told),
            doubts=doubts,
        )

    def acts_on(self, link: str) -> bool:
        """Return True if anything acts on a link."""
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

    def open_ranges(self, link: str, solved: SolvedAnswers | None = None) -> dict[str, OpenRanges]:
        """Return within what numbers a link's checks are open whatever its meshes tell, by the name of its loads.

        ``solved`` is what causes make of the link as a solid; by default what they make by hand, less what the solid
        may take off the sharing of couples.
        """
        if solved is None:
            by_hand, uneven = by_hand_shares(self.shared, link), self.uneven
            shares: Shares = {x: replace(one, low=min(LESS_BY_SOLID * one.low, 1.0)) for x, one in by_hand.items()}
        else:
            shares, uneven = together_shares(solved), self.growth
        found = open_ranges(self.case, link, self.load_case, uneven, shares)
        return {loads.name: found for loads, _ in self.plates[link]}

    def _columns(self, link: str) -> Plates:
        """Return the plates of a link of which the slenderest is judged as a column."""
        found: Plates = self.plates[link]
        for doubt in self.doubts:
            found = doubt.slenderest(self.case, link, found)
        return found

    @property
    def forces(self) -> JointForces:
        """Joint forces."""
        return self.statics.forces[self.load_case]

    def links(
        self, decided: Mapping[str, DecidedLink], solved: Mapping[str, SolvedAnswers] | None = None
    ) -> dict[str, LinkResult]:
        """Return the results of links; of a pair, that of its worse plate.

        ``solved`` is what causes make of links that are solids; of any other what they make by hand stands.
        """
        found = {}
        for link, plates in self.plates.items():
            own = self.case, link, self.load_case
            uneven, shares = self._doubts_on(link, (solved or {}).get(link))
            found[link] = worse_plate(
                [link_result(*own, hand, decided.get(link), uneven, shares, name=loads.name) for loads, hand in plates]
            )
        return found

    def _with_growth(self, outcome: CheckOutcome) -> CheckOutcome:
        """Return the buckling factor of a link with what its compression may be in its band.

        What play makes of it is known; of all else what its joint forces may be, over the largest.
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

    def answers(self, link: str) -> dict[str, LinkAnswers]:
        """Return what may act on a link in place of what is stated, by the name of the cause."""
        case, load_case, forces, loads = self.case, self.load_case, self.forces, self.statics.loads[self.load_case]
        own = case, load_case, link, forces, loads
        found = {"couples": sharing_answers(*own, grown=_grown(self.moved))} if forces.sharings else {}
        if forces.open_by:
            found["stiffness"] = stiffness_answers(*own)
        play = play_answers(*own)
        if play is not None:
            found["play"] = play
        return found | {str(doubt.cause.source.kind): doubt.answers(link) for doubt in self.doubts}

    def solid_answers(self, link: str, solid: RefinedSolid, threads: int | None) -> SolvedAnswers | None:
        """Return what causes make of a link on its solid, each answer by itself; None where it is not solved."""
        names = {one.load for one in solid.solution.cases}
        causes = self.answers(link) if self.acts_on(link) else {}
        if not causes or not all(cut.name in names for cut, _ in self.plates[link]):
            return None
        task = link_task(self.case, link, next(iter(causes.values())).stated)
        return dict(zip(causes, solid_shares(task, solid, list(causes.values()), threads=threads), strict=True))

    def couples(self, solved: Mapping[str, SolvedAnswers], checks: Sequence[CheckOutcome]) -> SharedCouples:
        """Return what the sharing of couples leaves open of links' strength."""
        known = {link: shares["couples"] for link, shares in solved.items() if "couples" in shares}
        decisive = {link: STRESS[self.case.material_of(link).brittle] for link in known}
        return SharedCouples(
            case=self.case,
            load_case=self.load_case,
            forces=self.forces,
            loads=self.statics.loads[self.load_case],
            grown=_grown(self.moved),
            by_hand=self.shared.stress,
            told={**self.shared.stress, **{link: shares[decisive[link]] for link, shares in known.items()}},
            checks=checks,
        )

    def _doubts_on(self, link: str, known: SolvedAnswers | None) -> tuple[Growths, Shares]:
        """Return what leaves the loads of a link open: on its solid where causes were solved there, else by hand."""
        if known is None:
            return self.uneven, by_hand_shares(self.shared, link)
        return self.growth, together_shares(known)

    def judged(
        self,
        decided: Mapping[str, DecidedLink],
        solved: Mapping[str, SolvedAnswers],
        whole: Sequence[CheckOutcome],
        collapses: Mapping[str, Found],
    ) -> LoadCaseResult:
        """Return the result, with the outcomes of the linkage as a whole after those of links and joints."""
        case, load_case, links = self.case, self.load_case, self.links(decided, solved)
        moved = with_known_stiffness(case, self.moved, self.forces, links, self.cut)
        reactions = moved.reactions or self.statics.reactions[load_case]
        pins = _pins(case, reactions, self.forces)
        in_plane = {x: one for x, one in self.shared.joints.items() if case.linkage.rise(x) == 0.0}
        pinned = self.uneven.times(Growths(joints=in_plane)).joints  # ``pins`` and bearing hold the sharing of others
        linkage = linkage_numbers(case, load_case, moved, self.forces, links, self.free)
        columns = {x: slenderest(case, x, self._columns(x)) for x in self.plates}
        solids = {x: found for x, found in links.items() if self.acts_on(x)}
        buckling = (
            *buckling_outcomes(case, load_case, columns, moved),
            *solid_buckling_outcomes(case, load_case, solids),
        )
        eyes, contacts, connections = self._eyes(reactions), self._contacts(reactions), self._connections(reactions)
        walls = self._walls()

        def doubts(link: str) -> tuple[Growths, Shares]:
            return self._doubts_on(link, solved.get(link))

        notches = [
            *notch_outcomes(
                case,
                load_case,
                lambda x: [(loads.name, hand) for loads, hand in self.plates[x]],
                decided,
                links,
                self.acts_on,
                doubts,
            )
        ]
        scattered = load_scatter(case, load_case).high
        pressing = {x: scattered * joint.magnitude for x, joint in reactions.joints.items()}
        lasting = {x: pulsating(case, x, links[x]) for x in asked_of(case, FatigueCheck)}
        every = (
            *outcomes(case, load_case, links, pins, moved, self.free, pinned, self.forces),
            *_bearing(case, load_case, reactions, self.forces, self.uneven.joints),
            *(eye_outcome(load_case, one, found) for one, found in eyes),
            *(wall_outcome(load_case, one, found) for one, found in walls),
            *(contact_outcome(load_case, one, found) for one, found in contacts),
            *(connection_outcome(load_case, one, found) for one, found in connections),
            *(self._with_growth(one) for one in buckling),
            *limit_load_outcomes(case, load_case, linkage),
            *collapse_outcomes(case, load_case, collapses, links, self.acts_on, doubts),
            *(outcome for outcome, _ in notches),
            *pose_outcomes(case, load_case, links, lasting, self.acts_on, pressing),
            *whole,
        )
        found = [reduce(lambda one, doubt: doubt.on_buckling(one), self.doubts, outcome) for outcome in every]
        checks: Iterable[CheckOutcome] = unless_it_gives_way(found, {load_case} if moved.gives_way else ())
        small = moved.state == "small" and self.forces.by_equilibrium
        checks = as_known(case, checks, stiff=small)
        if self.idle:
            borne = {name: joint.magnitude for name, joint in reactions.joints.items()}
            checks = undecided(checks, load_case, self.size, borne)
        return LoadCaseResult(
            name=load_case,
            forces=self.forces,
            large_displacement=moved,
            links=links,
            pins=pins,
            ways_to_hold=ways_to_hold(case, self.statics.pose, self.statics.loads[load_case]),
            linkage=linkage,
            standing=self.statics.standing[load_case],
            checks=tuple(checks),
            work=with_ends(self.statics, load_case),
            loads=tuple(self.statics.loads[load_case]),
            eyes=tuple(eye for _, found in eyes for eye in found),
            notches=tuple(notch for _, notch in notches if notch is not None),
            fatigue={x: found for x, found in lasting.items() if isinstance(found, LinkFatigue)},
            walls=tuple(mode for _, found in walls for mode in found),
            contacts=tuple(found for _, found in contacts),
            connections=tuple(found for _, found in connections),
            collapses={x: found for x, found in collapses.items() if isinstance(found, LinkCollapse)},
        )

    def _eyes(self, reactions: Reactions) -> list[tuple[Asked, tuple[EyeFactors, ...]]]:
        """Return the checks that ask for eyes, each with those of its link."""
        found, ways = [], (reactions, *self.forces.sharings)
        for one in asked(self.case, EyeCheck):
            link = one.subject.name
            growth = with_sharing(self.case, link, self.uneven.joints, ways)
            plates = [loads for loads, _ in self.plates[link]]
            found.append((one, tuple(eye_factors(self.case, self.load_case, one, plates, growth))))
        return found

    def _walls(self) -> list[tuple[Asked, tuple[WallFactor, ...]]]:
        """Return the checks that ask for thin walls, each with the modes of its link."""
        found, grown = [], self.uneven.times(self.shared).stress
        for one in asked(self.case, WallCheck):
            beams = [hand.check for _, hand in self.plates[one.subject.name]]
            growth = grown.get(one.subject.name, Scatter())
            found.append((one, tuple(wall_factors(self.case, self.load_case, one, beams, growth))))
        return found

    def _contacts(self, reactions: Reactions) -> list[tuple[Asked, LineContact]]:
        """Return the checks that ask for pins in slots, each with its contact."""
        found, ways = [], (reactions, *self.forces.sharings)
        for one in asked(self.case, LineContactCheck):
            joint = one.subject.name
            wrenches = [way.joints[joint].wrench for way in ways]
            found.append((one, contact_of(self.case, self.load_case, one, wrenches, self.uneven.joints.get(joint))))
        return found

    def _connections(self, reactions: Reactions) -> list[tuple[Asked, ConnectionFactors]]:
        """Return the checks that ask for connections, each with its factors."""
        found, ways = [], (reactions, *self.forces.sharings)
        for one in asked(self.case, ConnectionCheck):
            check, joint = one.check, one.subject.name
            assert isinstance(check, ConnectionCheck)
            through = [transmitted(self.case, check, way.joints[joint].wrench, way.driving[0]) for way in ways]

            def demand(other: OtherCase, check: ConnectionCheck = check) -> float:
                reactions = other.reactions
                load = transmitted(other.case, check, reactions.joints[check.joint].wrench, reactions.driving[0])
                return 1.0 / float(least_factor(other.case, check, load))

            driven = turned_by_drive(self.case, joint)
            growth = self.grown.through(joint).times(play_at_joint(self.forces.play, joint, driven=driven))
            for doubt in self.doubts:
                growth = growth.times(doubt.cause.scatter(doubt.stated, demand))
            found.append((one, connection_factors(self.case, self.load_case, one, through, growth)))
        return found


class _SolidAnswers:
    """What causes make of links on their solids; once for the finest mesh of each link."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str], tuple[SolidSolution, SolvedAnswers | None]] = {}

    def of(self, one: _LoadCase, link: str, solid: RefinedSolid, threads: int | None = None) -> SolvedAnswers | None:
        """Return it of a link under a load case; None where nothing is in doubt."""
        key = one.load_case, link
        if key not in self._known or self._known[key][0] is not solid.solution:
            self._known[key] = solid.solution, one.solid_answers(link, solid, threads)
        return self._known[key][1]


@bounded_run
def check_case(
    case: Case,
    *,
    name: str = "",
    fidelity: str = "auto",
    threads: int = 2,
    effort: Effort | None = None,
    frames: Mapping[str, LargeDisplacement] | None = None,
    only: Collection[str] | None = None,
    bare: bool = False,
    told: Sequence[str] | None = None,
    progress: Progress = lambda message: None,
) -> CheckResult:
    """Check a case: every link under every load case, against every check.

    Parameters
    ----------
    case : Case
    name : str, optional
        Path or built-in name of the case, for companion files and the report.
    fidelity : {"auto", "beam", "frame", "solid"}
        "auto" takes the cheapest model that decides each link (``alula.fea.links.fidelity``). The others take one model
        for all links. "beam" is hand calculation alone; a link without calibrated bands gets no verdict. "frame" means
        the same: a frame is solved wherever joint forces need one.
    threads : int, optional
    effort : Effort, optional
        Accuracy of solid models and what it may cost; by default what the case says.
    frames : mapping of str to LargeDisplacement, optional
        Those of an earlier check of the very same case, which are solved anew otherwise.
    only : collection of str, optional
        Links that the model is wanted for; the others, and points, are left to beam theory. All when left out.
    bare : bool, optional
        True where only the load cases are wanted, of a case without checks of the linkage's gaps, mass, size, motor and
        frequencies: these numbers and all warnings are left out.
    told : sequence of str, optional
        Links by hand whose bands are wanted; those of others leave out that pins may tilt and stand otherwise in their
        holes. All when left out.
    progress : callable
        Called with a sentence before every stage that may take long.

    Returns
    -------
    CheckResult

    Raises
    ------
    CaseError
        For a wrong case.
    CannotRunError
        Where a stage fails.
    """
    if fidelity not in FIDELITIES:
        raise CaseError(f"fidelity: '{fidelity}' is unknown; choose one of {', '.join(FIDELITIES)}")
    clock = Clock()
    statics = solve_case_statics(case, name)
    case = statics.case
    clock("pose and statics")
    whole = WholeNumbers(case=case)
    if not bare:
        whole = whole_numbers(case, statics.pose, solids=fidelity not in BY_HAND, threads=threads)
    clock("the linkage as a whole")
    moved = frames or {
        load_case: examine(statics.standing[load_case].case, load_case, forces, statics.loads[load_case])
        for load_case, forces in statics.forces.items()
    }
    doubts = {
        x: [found for doubt in (air_doubt, friction_doubt) if (found := doubt(statics, x, one))]
        for x, one in moved.items()
    }
    moved = {
        x: reduce(on_shape, doubts[x], shaken(statics.standing[x].case, x, statics.forces[x], one))
        for x, one in moved.items()
    }
    clock("frames")
    start = replace(START, curved=case.solid.curved).scaled(case.solid.mesh_size)
    first: Mapping[str, TaggedMesh] = {}
    if fidelity not in BY_HAND:
        statics, first = with_solids(statics, moved, start, always=fidelity == "solid", threads=threads)
        clock("frames of solids")
    by_load_case = {x: _LoadCase.of(statics, x, what, doubts[x], told) for x, what in moved.items()}
    clock("hand calculations")
    shared, begun = _SolidAnswers(), time.perf_counter()
    decided = _decided(
        case, list(by_load_case.values()), fidelity, effort, start, first, only, threads, shared, progress
    )
    if fidelity not in BY_HAND:
        clock("solid models")
    outlines = None if whole.clearance is None else whole.clearance.assembly
    judged = {
        x: (*own, *layer_gap_outcomes(by_load_case[x].case, x, moved[x], outlines))
        for x, own in whole_outcomes(whole).items()
    }
    solved = {
        load_case: {
            link: answers
            for link, what in decided.items()
            if what.solid is not None and (answers := shared.of(one, link, what.solid, threads)) is not None
        }
        for load_case, one in by_load_case.items()
    }
    collapses: Mapping[str, Mapping[str, Found]] = {}
    if fidelity not in BY_HAND and asks(case, PlasticCollapseCheck):
        results = {x: one.links(decided, solved[x]) for x, one in by_load_case.items()}
        acting = {
            x: {
                link: [cut for cut, _ in plates]
                for link, plates in one.plates.items()
                if one.acts_on(link)
                and (only is None or link in only)
                and (fidelity == "solid" or needs_path(case, x, link, results[x][link]))
            }
            for x, one in by_load_case.items()
        }
        left = max((effort or effort_of(case)).time_limit - (time.perf_counter() - begun), 0.0)
        collapses = find_collapses(case, acting, start, first, time_limit=left, threads=threads, progress=progress)
        clock("plastic collapse")
    load_cases = {x: one.judged(decided, solved[x], judged[x], collapses.get(x, {})) for x, one in by_load_case.items()}
    clock("stress")
    warnings: tuple[Reason | str, ...] = ()
    if not bare:
        warnings = (
            *(nothing_acts(load_case, one.size) for load_case, one in by_load_case.items() if one.idle),
            *tight_pin_warnings([one.couples(solved[x], load_cases[x].checks) for x, one in by_load_case.items()]),
            *_warnings(case, statics, moved),
            *play_warnings(moved, statics.forces),
            *air_warnings(moved),
            *friction_warnings(moved),
        )
    return CheckResult(
        name=name,
        case=case,
        pose=statics.pose,
        clearance=whole.clearance,
        mass=whole.mass,
        size=whole.size,
        frequencies=whole.frequencies,
        load_cases=load_cases,
        hand=hand_calculations(case),
        audit=statics.audit,
        verdict=overall(check.verdict for result in load_cases.values() for check in result.checks),
        timings=clock.stages,
        warnings=warnings,
    )


def links_by_hand(
    statics: CaseStatics, frames: Mapping[str, LargeDisplacement] | None = None
) -> dict[str, dict[str, LinkResult]]:
    """Return the numbers of links by hand as stated: their bands leave out play, air, friction, and pins that tilt.

    Parameters
    ----------
    statics : CaseStatics
    frames : mapping of str to LargeDisplacement, optional
        As for ``check_case``.

    Returns
    -------
    dict of str to dict of str to LinkResult
        Load case -> link -> its numbers.
    """
    found = {}
    for x, forces in statics.forces.items():
        moved = frames[x] if frames else examine(statics.standing[x].case, x, forces, statics.loads[x])
        found[x] = _LoadCase.as_stated(statics, x, moved)
    every = list(found.values())
    decided = _decided_by_hand(statics.case, every, statics.case.checked_links)
    return {x: one.links(decided) for x, one in found.items()}


def _tasks(
    case: Case, load_cases: Sequence[_LoadCase], links: Sequence[str]
) -> tuple[dict[str, LinkTask], dict[str, dict[str, BeamCheck]]]:
    """Return what is to be decided of every link on which something acts, and its hand calculations by their loads."""
    loaded = {link: [cut for one in load_cases if one.acts_on(link) for cut, _ in one.plates[link]] for link in links}
    tasks = {link: link_task(case, link, loads) for link, loads in loaded.items() if loads}
    beams = {link: {cut.name: hand.check for one in load_cases for cut, hand in one.plates[link]} for link in tasks}
    return tasks, beams


def _decided_by_hand(case: Case, load_cases: Sequence[_LoadCase], links: Sequence[str]) -> dict[str, DecidedLink]:
    tasks, beams = _tasks(case, load_cases, links)
    return {link: by_hand(task, beams[link]) for link, task in tasks.items()}


def _decided(
    case: Case,
    load_cases: Sequence[_LoadCase],
    fidelity: str,
    effort: Effort | None,
    start: MeshSettings,
    first: Mapping[str, TaggedMesh],
    only: Collection[str] | None,
    threads: int,
    shared: _SolidAnswers,
    progress: Progress,
) -> dict[str, DecidedLink]:
    """Decide every link on which something acts, by the model that was asked for."""
    wanted_links = [link for link in case.checked_links if only is None or link in only]
    if fidelity in BY_HAND:
        return _decided_by_hand(case, load_cases, wanted_links)
    tasks, beams = _tasks(case, load_cases, wanted_links)
    if fidelity == "solid":
        for task in tasks.values():
            require_compressible(task.nu)  # before the first mesh
    effort, begun = effort or effort_of(case), time.perf_counter()
    alone = fidelity == "auto" and not effort.stated
    given_up = {one.load_case for one in load_cases if alone and one.lost}
    held = [one for one in load_cases if one.load_case not in given_up]
    lost = {
        cut.name for one in load_cases if one.load_case in given_up for found in one.plates.values() for cut, _ in found
    }
    firm = [one for one in held if alone and not one.solids_may_hold_it]

    def ranges(link: str, solid: RefinedSolid | None = None) -> dict[str, OpenRanges]:
        solved = [None if solid is None else shared.of(one, link, solid) for one in firm]
        each = [one.open_ranges(link, known) for one, known in zip(firm, solved, strict=True)]
        return {name: found for every in each for name, found in every.items()}

    tasks = {link: replace(task, open_ranges=ranges(link)) for link, task in tasks.items()}
    decided = decide(
        tasks,
        beams,
        start,
        effort,
        fidelity=fidelity,
        first=first,
        lost=lost,
        threads=threads,
        told=ranges,
        progress=progress,
    )
    tasks = {link: task.without(lost) for link, task in tasks.items()}
    for _ in range(POINT_ROUNDS if only is None else 0):
        wanted = _wanted(held, decided)
        left = max(effort.time_limit - (time.perf_counter() - begun), 0.0)
        spent = replace(effort, time_limit=left)
        closer = decide_point(decided, tasks, wanted, start, spent, threads=threads, progress=progress)
        if not closer:
            break
        decided |= closer
    return decided


def _wanted(load_cases: Sequence[_LoadCase], decided: Mapping[str, DecidedLink]) -> dict[str, float]:
    """Return the error of displacements that links must keep to for the checks of points, the least of all."""
    found: dict[str, float] = {}
    for one in load_cases:
        if any(asked(one.case, DisplacementCheck, quantity=Quantity.DISPLACEMENT)):
            wanted = meshes_to_refine(one.case, one.load_case, one.moved, one.links(decided), one.free, one.forces)
            found |= {link: min(error, found.get(link, math.inf)) for link, error in wanted.items()}
    return found


def _grown(moved: LargeDisplacement) -> bool:
    """Return whether what acts on links holds their bending on free pins already, which ``cut_link`` adds."""
    return moved.state in ("off", "unknown")


def _pins(case: Case, reactions: Reactions, forces: JointForces) -> dict[str, PinStress]:
    """Stresses of the pins that a check asks for."""
    found = {}
    for joint in asked_of(case, PinCheck):
        reaction = reactions.joints[joint]
        twist = twist_of(case, joint, float(reaction.wrench[5]), float(reactions.drive_torque))
        found[joint] = twisted(case, joint, shared_stress(case, joint, reaction, forces), twist)
    return found


def _bearing(
    case: Case, load_case: str, reactions: Reactions, forces: JointForces, growth: Mapping[str, Scatter]
) -> Iterator[CheckOutcome]:
    """Outcomes of the checks that ask for bearing."""
    for one in asked(case, BearingCheck):
        joint, ways = one.subject.name, (reactions, *forces.sharings)
        every = [way.joints[joint].wrench for way in ways]
        yield bearing_outcome(case, load_case, one, every, growth.get(joint))


def hand_calculations(case: Case) -> dict[str, CantileverCheck]:
    """Return the calculations by hand that a case states, by their names; they need nothing that is solved.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict of str to CantileverCheck
    """
    return {calculation: _cantilever(case, calculation) for calculation in case.hand_calculations}


def _cantilever(case: Case, calculation: str) -> CantileverCheck:
    hand = case.hand_calculations[calculation]
    part = case.parts[hand.part]
    assert isinstance(part, PartKind)  # ``check_rules`` refuses imported ones
    strength = case.all_materials[part.material].allowable
    return uniform_cantilever(hand.load, hand.length, part.section, strength)


def _warnings(case: Case, statics: CaseStatics, moved: Mapping[str, LargeDisplacement]) -> list[Reason | str]:
    found: list[Reason | str] = [*unusual_materials(case)]
    by_frame = {
        load_case: (forces.model, forces.reason)
        for load_case, forces in statics.forces.items()
        if not forces.by_equilibrium and forces.model != LAYERED_FRAME
    }
    for model, because in dict.fromkeys(by_frame.values()):
        names = [load_case for load_case, found_by in by_frame.items() if found_by == (model, because)]
        found.append(under_load_cases(names, reason("forces_of_frame", why=because, model=model)))
    for why in dict.fromkeys(what.reason for what in moved.values() if what.state != "small"):
        names = [load_case for load_case, what in moved.items() if what.reason == why]
        found.append(under_load_cases(names, why))
    found += left_stops(statics, moved)
    found += [
        under_load_cases([load_case], sentence)
        for load_case in case.load_cases
        for air in case.air_forces(load_case)
        for sentence in air.warnings
    ]
    pose, near = statics.pose, dict[Reason, float]()
    if pose.coordinate is not None:
        near[reason("pose_coordinate", link=pose.coordinate.name)] = pose.dead_point_distance(pose.coordinate)
    for reactions in statics.reactions.values():
        if reactions.drive is not None and not reactions.drive.idle:
            near[reason("held_link", held=reactions.drive.held)] = reactions.drive.dead_point_distance(pose)
    for what, distance in near.items():
        if distance < NEAR_DEAD_POINT:
            found.append(reason("close_to_dead_point", of=what, distance=distance))
    return found
