"""The whole check of a case: pose, statics, beams, solids, bands, verdict."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce

from pydantic_core import PydanticCustomError

from alula.fea.beam.theory import CantileverCheck, uniform_cantilever
from alula.fea.check.deciding import BY_HAND, Deciding, Progress, decided_by_hand
from alula.fea.check.judged_case import judged
from alula.fea.check.load_case import LoadCaseByHand
from alula.fea.check.solid_frame import with_solids
from alula.fea.common.clock import Clock
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.threads import bounded_run
from alula.fea.common.verdict import overall
from alula.fea.doubts.air_doubt import air_doubt, air_warnings
from alula.fea.doubts.friction_doubt import friction_doubt, friction_warnings
from alula.fea.doubts.other_case import on_shape
from alula.fea.doubts.play_doubt import play_warnings, shaken
from alula.fea.doubts.tight_pins import tight_pin_warnings
from alula.fea.judging.linkage_numbers import left_stops
from alula.fea.links.fidelity import DecidedLink, Decision
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine
from alula.fea.outcomes.result import CheckResult, LinkResult
from alula.fea.outcomes.unchecked import unusual_materials
from alula.fea.outcomes.unloaded import nothing_acts
from alula.fea.refine.refinement import START, Effort, RefinedSolid
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.fea.standing.joint_forces import LAYERED_FRAME
from alula.fea.whole.layer_gaps import layer_gap_outcomes
from alula.fea.whole.outcomes import WholeNumbers, whole_numbers, whole_outcomes
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import PartKind
from alula.geometry.keeping.kept import tally
from alula.geometry.linkage.pose import NEAR_DEAD_POINT
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case import Case
from alula.loads.text.explain import printable
from alula.loads.text.shares import parse_accuracy

Watch = Callable[["WatchedLink"], None]
FIDELITIES = ("auto", "beam", "frame", "solid")


@dataclass(frozen=True, kw_only=True)
class WatchedLink:
    """A link whose solid is begun, or whose meshes have ended.

    Attributes
    ----------
    link : str
    results : mapping of str to LinkResult
        Load case -> its result, with what causes make by hand in its bands; empty where it is begun.
    kept : bool
        True where all its solutions were kept from earlier checks.
    """

    link: str
    results: Mapping[str, LinkResult] = field(default_factory=dict)
    kept: bool = False


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
    watch: Watch | None = None,
    linear: bool = False,
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
    watch : callable, optional
        Called with every link whose solid is begun, and with what was found as its meshes end, before all is judged.
    linear : bool, optional
        True for what linear theory says by hand of the loads as stated, which takes a tenth of the time: what ``bare``
        leaves out is left out, and so are large displacement, buckling of the linkage and its limit load. Bands leave
        out play, air, friction, pins that tilt or stand otherwise in their holes, and what grows faster than the load.
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
        raise CaseError(f"fidelity: '{printable(fidelity)}' is unknown; choose one of {', '.join(FIDELITIES)}")
    clock, before = Clock(), tally()
    statics = solve_case_statics(case, name)
    case = statics.case
    clock("pose and statics")
    whole = WholeNumbers(case=case)
    bare, fidelity = bare or linear, "beam" if linear else fidelity
    if linear:
        plain = {x: replace(one, pins=None, play=None) for x, one in statics.forces.items()}
        statics = replace(statics, forces=plain)
    if not bare:
        whole = whole_numbers(case, statics.pose, solids=fidelity not in BY_HAND, threads=threads)
    clock("the linkage as a whole")
    moved = frames or {
        x: examine(statics.standing[x].case, x, forces, statics.loads[x], linear=linear)
        for x, forces in statics.forces.items()
    }
    doubts = {
        x: [found for doubt in (() if linear else (air_doubt, friction_doubt)) if (found := doubt(statics, x, one))]
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
    by_hand = {
        x: LoadCaseByHand.as_stated(statics, x, what)
        if linear
        else LoadCaseByHand.of(statics, x, what, doubts[x], told)
        for x, what in moved.items()
    }
    clock("hand calculations")
    deciding = Deciding(
        case=case,
        load_cases=list(by_hand.values()),
        fidelity=fidelity,
        effort=effort or effort_of(case),
        start=start,
        first=first,
        only=only,
        threads=threads,
        progress=progress,
        watch=lambda link, solid: watch and watch(_watched(link, solid, by_hand)),
    )
    decided = deciding.decided()
    if fidelity not in BY_HAND:
        clock("solid models")
    solved = deciding.solved(decided)
    results = {x: one.links(decided, solved[x]) for x, one in by_hand.items()}
    collapses = deciding.collapses(results, solved)
    if collapses:
        clock("plastic paths")
    outlines = None if whole.clearance is None else whole.clearance.assembly
    of_whole = dict.fromkeys(by_hand, ()) if linear else whole_outcomes(whole)
    load_cases = {
        x: judged(
            one,
            decided,
            solved[x],
            results[x],
            collapses.get(x, {}),
            (*of_whole[x], *layer_gap_outcomes(one.case, x, moved[x], outlines)),
        )
        for x, one in by_hand.items()
    }
    clock("stress")
    warnings: tuple[Reason | str, ...] = ()
    if not bare:
        warnings = (
            *(nothing_acts(load_case, one.size) for load_case, one in by_hand.items() if one.idle),
            *tight_pin_warnings([one.couples(solved[x], load_cases[x].checks) for x, one in by_hand.items()]),
            *_warnings(case, statics, moved),
            *play_warnings(moved, statics.forces),
            *air_warnings(moved),
            *friction_warnings(moved),
        )
    return CheckResult(
        name=name,
        fidelity=fidelity,
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
        kept=(tally()[0] - before[0], tally()[1] - before[1]),
        warnings=warnings,
    )


def _watched(link: str, solid: RefinedSolid | None, load_cases: Mapping[str, LoadCaseByHand]) -> WatchedLink:
    if solid is None:
        return WatchedLink(link=link)
    decided = DecidedLink(decision=Decision(model="solid", why="", next_cost=None), solid=solid)
    results = {x: one.link(link, decided if one.acts_on(link) else None) for x, one in load_cases.items()}
    return WatchedLink(link=link, results=results, kept=solid.kept)


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
        found[x] = LoadCaseByHand.as_stated(statics, x, moved)
    every = list(found.values())
    decided = decided_by_hand(statics.case, every, statics.case.checked_links)
    return {x: one.links(decided) for x, one in found.items()}


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
