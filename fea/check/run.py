"""The whole check of a case: pose, statics, beams, solids, bands, verdict."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from pydantic_core import PydanticCustomError

from fea.beam.theory import CantileverCheck, uniform_cantilever
from fea.check.fidelity import DecidedLink, HandBands, by_hand, decide
from fea.check.link_by_hand import LinkByHand, cut_link, link_by_hand
from fea.check.load_growth import Growths, growths
from fea.check.solid_result import link_task, solid_result
from fea.common.band import Band
from fea.common.scatter import Scatter, compliance_scatter, load_scatter, strength_scatter
from fea.common.threads import bounded_run
from fea.common.verdict import CheckOutcome, overall
from fea.frame.joint_forces import PINNED_STATICS, JointForces, joint_forces, ways_to_hold
from fea.frame.large_displacement import LargeDisplacement, examine
from fea.outcomes.bearing import bearing_outcome
from fea.outcomes.buckling import buckling_outcomes
from fea.outcomes.judge import outcomes
from fea.outcomes.motor import limit_outcomes, motor_outcomes
from fea.outcomes.pins import PinStress, stress_at
from fea.outcomes.result import CheckResult, LinkResult, LoadCaseResult
from fea.outcomes.unchecked import unusual_materials
from fea.outcomes.unloaded import acts, load_size, nothing_acts, undecided
from fea.refine.refinement import START, Effort
from fea.solid.solution import require_compressible
from geometry.base.errors import CaseError
from geometry.linkage.pose import NEAR_DEAD_POINT, Pose
from geometry.parts.material import Material
from loads.case.case import Case
from loads.case.case_file import read_companion
from loads.records.applied import Load
from loads.records.check_spec import BearingCheck, MotorCheck, PinCheck
from loads.sources.published_statics import StaticsAudit, audit
from loads.states.actions import PartMass, needs_masses
from loads.states.inertia import acting_loads
from loads.states.masses import part_mass
from loads.statics.statics import Reactions
from loads.text.accuracy import parse_accuracy

Progress = Callable[[str], None]
FIDELITIES = ("auto", "beam", "frame", "solid")
BEAM_ALONE = "beam theory without stress concentration"


@dataclass(frozen=True, kw_only=True)
class CaseStatics:
    """Pose, loads and reactions of every load case of a case."""

    case: Case
    pose: Pose
    loads: Mapping[str, tuple[Load, ...]]
    forces: Mapping[str, JointForces]
    masses: Mapping[str, PartMass]
    audit: StaticsAudit | None

    @property
    def reactions(self) -> Mapping[str, Reactions]:
        """Joint reactions of every load case, in the undeformed pose."""
        return {title: forces.reactions for title, forces in self.forces.items()}


@dataclass
class _Clock:
    """Seconds that each stage took."""

    stages: dict[str, float] = field(default_factory=dict)
    last: float = field(default_factory=time.perf_counter)

    def __call__(self, stage: str) -> None:
        now = time.perf_counter()
        self.stages[stage] = self.stages.get(stage, 0.0) + now - self.last
        self.last = now


def effort_of(
    case: Case,
    accuracy: str | None = None,
    *,
    max_unknowns: int = Effort.max_unknowns,
    time_limit: float = Effort.time_limit,
) -> Effort:
    """Return what a check may cost: the stated ``accuracy`` such as ``"5 %"``, else the case's, else the default.

    Raises ``CaseError`` for an accuracy that is none.
    """
    try:
        stated = case.solid.accuracy if accuracy is None else parse_accuracy(accuracy)
    except PydanticCustomError as error:
        raise CaseError(f"accuracy: it is '{accuracy}', but {error.message()}") from None
    effort = Effort(max_unknowns=max_unknowns, time_limit=time_limit)
    return effort if stated is None else replace(effort, accuracy=stated, stated=True)


def solve_case_statics(case: Case, name: str = "") -> CaseStatics:
    """Solve pose and statics of every load case; ``name`` is the path or built-in name of the case.

    Raises ``CaseError`` for a pose that cannot be assembled or has no single equilibrium.
    """
    pose = case.solve_pose()
    masses = {}
    if needs_masses(case):
        for link in case.checked_links:
            masses[link] = part_mass(case, link)
    loads = {title: acting_loads(case, load_case, pose, masses) for title, load_case in case.load_cases.items()}
    forces = {title: joint_forces(case, pose, loads[title]) for title in loads}
    found = None
    if case.published_statics is not None:
        published = case.published_statics
        found = audit(
            published,
            read_companion(name, published.exact),
            read_companion(name, published.printed),
            pose,
            next(iter(loads.values())),
        )
    return CaseStatics(case=case, pose=pose, loads=loads, forces=forces, masses=masses, audit=found)


@bounded_run
def check_case(
    case: Case,
    *,
    name: str = "",
    fidelity: str = "auto",
    threads: int = 2,
    effort: Effort | None = None,
    progress: Progress = lambda message: None,
) -> CheckResult:
    """Check a case: every link under every load case, against every check.

    name       path or built-in name of the case, for companion files and the report
    fidelity   "auto" for the cheapest model that decides each link (``fea.check.fidelity``), or one for all of them:
               "solid", "beam" for hand calculation alone, in calibrated bands where there are any and else without
               verdict; "frame" is another name of "beam", since a frame gives joint forces where they need one
    effort     accuracy of solid models and what it may cost, by default what the case says
    progress   called with a sentence before every stage that may take long

    Raises ``CaseError`` for a wrong case and ``CannotRunError`` where a stage fails.
    """
    if fidelity not in FIDELITIES:
        raise CaseError(f"fidelity: '{fidelity}' is unknown; choose one of {', '.join(FIDELITIES)}")
    clock = _Clock()
    statics = solve_case_statics(case, name)
    clock("pose and statics")
    moved = {
        title: examine(case, title, forces, statics.loads[title], statics.masses)
        for title, forces in statics.forces.items()
    }
    clock("frames")
    sizes = {title: load_size(loads, case.linkage.longest) for title, loads in statics.loads.items()}
    cut = {
        link: tuple(
            cut_link(case, link, title, what, statics.reactions[title], statics.loads[title], statics.masses)
            for title, what in moved.items()
        )
        for link in case.checked_links
    }
    beams = {link: tuple(link_by_hand(case, link, loads, statics.masses) for loads in cut[link]) for link in cut}
    uneven = {
        title: growths(
            case,
            title,
            statics.pose,
            statics.loads[title],
            statics.masses,
            moved[title],
            statics.reactions[title],
            {link: beams[link][i] for link in cut},
        )
        for i, title in enumerate(moved)
    }
    clock("hand calculations")
    decided: dict[str, DecidedLink] = {}
    loaded = {link: [x for x in loads if acts(x, sizes[x.name], case.linkage.longest)] for link, loads in cut.items()}
    idle = set(sizes) - {loads.name for acting in loaded.values() for loads in acting} if cut else set()
    tasks = {link: link_task(case, link, loads) for link, loads in loaded.items() if loads}
    checked = {
        link: {loads.name: beam.check for loads, beam in zip(cut[link], beams[link], strict=True)} for link in cut
    }
    if fidelity in ("beam", "frame"):
        decided = {link: by_hand(task, checked[link]) for link, task in tasks.items()}
    else:
        if fidelity == "solid":
            for task in tasks.values():
                require_compressible(task.nu)  # before the first mesh
        start = replace(START, curved=case.solid.curved).scaled(case.solid.mesh_size)
        decided = decide(
            tasks,
            checked,
            start,
            effort or effort_of(case),
            fidelity=fidelity,
            threads=threads,
            progress=progress,
        )
        clock("solid models")
    motors = [(n, check) for n, check in case.checks.items() if isinstance(check, MotorCheck)]
    powers = [motor_outcomes(case, n, check) for n, check in motors]
    limits = [limit_outcomes(case, n, check) for n, check in motors]
    load_cases = {}
    for i, (title, forces) in enumerate(statics.forces.items()):
        links = {
            link: _scattered(
                case, title, _link_result(case, link, title, beams[link][i], decided.get(link)), uneven[title]
            )
            for link in cut
        }
        reactions = moved[title].reactions or forces.reactions
        pins = _pins(case, reactions)
        checks: Iterable[CheckOutcome] = (
            *outcomes(case, title, links, pins, moved[title], uneven[title].joints),
            *_bearing(case, title, reactions, uneven[title]),
            *buckling_outcomes(case, title, {link: beams[link][i].check for link in cut}, moved[title]),
            *(found[title] for found in powers if title in found),
            *(outcome for found in limits for outcome in found.get(title, ())),
        )
        if title in idle:
            joints = {name: joint.magnitude for name, joint in reactions.joints.items()}
            checks = undecided(checks, title, sizes[title], joints)
        load_cases[title] = LoadCaseResult(
            name=title,
            forces=forces,
            large_displacement=moved[title],
            links=links,
            pins=pins,
            ways_to_hold=ways_to_hold(case, statics.pose, statics.loads[title]),
            checks=tuple(checks),
        )
    clock("stress")
    return CheckResult(
        name=name,
        case=case,
        pose=statics.pose,
        load_cases=load_cases,
        hand={title: _cantilever(case, title) for title in case.hand_calculations},
        audit=statics.audit,
        verdict=overall(check.verdict for result in load_cases.values() for check in result.checks),
        timings=clock.stages,
        warnings=(
            *(nothing_acts(title, sizes[title]) for title in load_cases if title in idle),
            *_warnings(case, statics, moved),
        ),
    )


def _link_result(case: Case, link: str, title: str, beam: LinkByHand, decided: DecidedLink | None) -> LinkResult:
    material = case.material_of(link)
    result = _beam_result(link, material, beam)
    if decided is None:
        return replace(result, decided_by="beam", why="nothing acts on it")
    decision = decided.decision
    found = None if decided.solid is None else solid_result(case, link, title, beam.check, decided.solid)
    if found is not None:
        result = replace(found, notes=(*found.notes, *beam.remarks))
    elif decided.solid is None and title in decided.hands and not decided.hands[title].outside:
        result = _calibrated(result, material, decided.hands[title])
    return replace(result, decided_by=decision.model, why=decision.why, next_cost=decision.next_cost)


def _scattered(case: Case, title: str, result: LinkResult, uneven: Growths) -> LinkResult:
    """Return a result with the stated scatter of load, strength and modulus in its bands."""
    material = case.material_of(result.link)
    load = load_scatter(case, title).times(uneven.stress.get(result.link, Scatter()))
    bent = load_scatter(case, title).times(uneven.displacement.get(result.link, Scatter()))
    return replace(
        result,
        von_mises_max=load.on(result.von_mises_max),
        principal_max=load.on(result.principal_max),
        safety_factor=strength_scatter(material).times(load.inverse).on(result.safety_factor),
        displacement_max=compliance_scatter(material).times(bent).on(result.displacement_max),
    )


def _calibrated(result: LinkResult, material: Material, hand: HandBands) -> LinkResult:
    """Return a result by beam theory with the bands that solid models gave it."""
    worst = max(hand.spots, key=lambda row: (row.principal if material.brittle else row.von_mises).high)
    return replace(
        result,
        von_mises_max=hand.von_mises,
        principal_max=hand.principal,
        safety_factor=hand.deciding(brittle=material.brittle).inverse(material.allowable),
        displacement_max=hand.displacement,
        location=np.array([worst.spot.x, 0.0, 0.0]),
        notes=(),
    )


def _beam_result(link: str, material: Material, beam: LinkByHand) -> LinkResult:
    x, worst = beam.worst
    stress = Band.exact(worst.equivalent, BEAM_ALONE)
    principal = Band.exact(max(worst.axial + worst.bending, worst.bending - worst.axial, 0.0), BEAM_ALONE)
    return LinkResult(
        link=link,
        fidelity="beam",
        von_mises_max=stress,
        principal_max=principal,
        safety_factor=(principal if material.brittle else stress).inverse(material.allowable),
        displacement_max=Band.exact(beam.displacement, BEAM_ALONE),
        location=np.array([x, 0.0, 0.0]),
        elements=None,
        unknowns=None,
        beam=beam.check,
        solid=None,
        variants=(),
        governing=None,
        solid_case=None,
        stress=None,
        comparisons=(),
        notes=(
            "nothing acts on this link in this load case"
            if worst.equivalent == 0.0
            else "beam theory alone: stress concentration at eyes and holes is not in these numbers",
            *beam.remarks,
        ),
        brittle=material.brittle,
    )


def _pins(case: Case, reactions: Reactions) -> dict[str, PinStress]:
    """Stresses of the pins that a check asks for."""
    checks = [check for check in case.all_checks.values() if isinstance(check, PinCheck)]
    asked = dict.fromkeys(joint for check in checks for joint in check.joints or case.pinned_joints)
    return {joint: stress_at(case, joint, reactions.joints[joint]) for joint in asked}


def _bearing(case: Case, title: str, reactions: Reactions, uneven: Growths) -> Iterator[CheckOutcome]:
    """Outcomes of the checks that ask for bearing."""
    for name, check in case.checks.items():
        if isinstance(check, BearingCheck):
            for joint in check.joints or case.bearing_joints:
                force = float(np.hypot(*reactions.joints[joint].wrench[:2]))
                yield bearing_outcome(case, title, name, check, joint, force, uneven.joints.get(joint))


def _cantilever(case: Case, title: str) -> CantileverCheck:
    hand = case.hand_calculations[title]
    part = case.parts[hand.part]
    strength = case.all_materials[part.material].allowable
    return uniform_cantilever(hand.load, hand.length, part.section, strength)


def _warnings(case: Case, statics: CaseStatics, moved: Mapping[str, LargeDisplacement]) -> list[str]:
    found = unusual_materials(case)
    for model, reason in dict.fromkeys((f.model, f.reason) for f in statics.forces.values()):
        if model != PINNED_STATICS:
            titles = [title for title, f in statics.forces.items() if (f.model, f.reason) == (model, reason)]
            found.append(f"load case {', '.join(titles)}: {reason}, so the joint forces are those of a {model}")
    said = dict.fromkeys(what.sentence for what in moved.values() if what.state != "small")
    for sentence in said:
        titles = [title for title, what in moved.items() if what.sentence == sentence]
        found.append(f"load case {', '.join(titles)}: {sentence}")
    found += [
        f"load case {title}: {sentence}"
        for title in case.load_cases
        for air in case.air_forces(title)
        for sentence in air.warnings
    ]
    pose, drive, near = statics.pose, case.pinned_drive, {}
    if pose.coordinate is not None:
        named = f"the pose coordinate {pose.coordinate}"
        near[named] = pose.dead_point_distance(pose.coordinate, slides=pose.slides)
    if drive is not None:
        near[f"the driven link {drive.link}"] = drive.dead_point_distance(pose)
    for what, distance in near.items():
        if distance < NEAR_DEAD_POINT:
            found.append(
                f"the pose is close to a dead point of {what} (smallest singular value {distance:.2g}): "
                "small errors of length and angle change the joint forces much"
            )
    return found
