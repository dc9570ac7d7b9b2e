"""The whole motion of a case: the least safety factor of each link over all poses and load cases, where and when."""

import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import copy_context
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.at_temperature import as_known
from alula.fea.check.run import effort_of
from alula.fea.common.clock import Clock
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, load_scatter
from alula.fea.common.threads import bounded, bounded_run
from alula.fea.common.verdict import CheckOutcome, overall
from alula.fea.doubts.narrow_holes import narrow_holes
from alula.fea.elements.space import DisplacementSpace, displacement_space
from alula.fea.judging.linkage import unless_it_gives_way
from alula.fea.links.clamp_edge import CLAMP_SCATTER
from alula.fea.links.link_by_hand import HandStates
from alula.fea.links.solid_result import link_task
from alula.fea.motion.buckling_history import with_second_order
from alula.fea.motion.envelope_outcomes import FOLLOWED, column_outcomes, envelope_outcomes
from alula.fea.motion.envelope_result import EnvelopeResult, LinkEnvelope
from alula.fea.motion.layer_envelope import built_in_any_direction, layer_envelopes
from alula.fea.motion.layered import with_couples
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import limit_load_outcomes, linkage_outcomes, over_motion
from alula.fea.motion.loosened import loosened, motion_growth, otherwise
from alula.fea.outcomes.limits import layers_of
from alula.fea.outcomes.unchecked import unusual_materials
from alula.fea.outcomes.unloaded import acts, nothing_acts, stated_size, undecided, unloaded_links
from alula.fea.refine.link_series import STRESS, Measure
from alula.fea.refine.refinement import START, Effort, refine_links
from alula.fea.solid.solution import require_compressible
from alula.fea.superposition.solid_shares import solid_shares
from alula.fea.whole.outcomes import KINDS, unloaded_outcomes, whole_numbers
from alula.fea.whole.rubbed_motion import rubbed_motion, work_between
from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError
from alula.geometry.bodies.body import clamped_end
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case import Case
from alula.loads.case.forks import of_pair
from alula.loads.states.case_motion import CaseMotion

Real = NDArray[np.float64]
Progress = Callable[[str], None]

TORQUE_GROWTH = 20.0
"""Poses near a dead point are left out if their drive torque exceeds that at the best leverage by this factor."""


class _Envelope:
    """A case over its motion, with the loads on every loaded link, one record per load case."""

    def __init__(self, moved: CaseMotion, evaluated: NDArray[np.bool_], threads: int, progress: Progress) -> None:
        layered = with_couples(moved, evaluated)
        self.moved, self.ways, self.pins = layered.moved, layered.ways, layered.pins
        self.evaluated, self.threads, self.progress = evaluated, threads, progress
        moved, case = self.moved, self.moved.case
        self.sizes = {load_case: stated_size(case, load_case) for load_case in case.load_cases}
        self.loaded: dict[str, tuple[LinkLoads, ...]] = {}
        for link in case.checked_links:
            found = tuple(
                with_second_order(case, link, history, evaluated)
                for history in link_histories(moved, link)
                if acts(history.chosen(evaluated), self.sizes[history.name], case.linkage.longest)
            )
            if found:
                self.loaded[link] = found
        self.grown = motion_growth(moved, self.loaded, evaluated)
        bent = {(load_case, link): one for load_case, of in self.grown.items() for link, one in of.stress.items()}
        # What the edge of a clamp adds counts for the link's largest stress, wherever that is.
        held = [link for link in self.loaded if clamped_end(case.body(link)) is not None]
        edges = {(history.name, link): CLAMP_SCATTER for link in held for history in self.loaded[link]}
        self.shares: dict[tuple[str, str], Scatter] = {}
        stress = narrow_holes(case).stress
        holes = {(history.name, link): own for link, own in stress.items() for history in self.loaded.get(link, ())}
        for doubt in (holes, loosened(moved, evaluated), otherwise(moved, evaluated), bent, edges):
            self.uneven = dict(self.shares)  # in the end without ``edges``
            for key, scatter in doubt.items():
                self.shares[key] = self.shares.get(key, Scatter()).times(scatter)
        self.ended = threading.Event()

    @property
    def idle(self) -> tuple[str, ...]:
        """Load cases under which nothing acts on any link."""
        acting = {history.name for found in self.loaded.values() for history in found}
        return tuple(load_case for load_case in self.sizes if load_case not in acting)

    def solved(self, start: MeshSettings, effort: Effort, repetitions: float | None) -> dict[str, LinkEnvelope]:
        """Solve all links, as many side by side as there may be threads, each by libraries with one thread."""
        begun = time.perf_counter()
        with bounded(1, children=self.threads), ThreadPoolExecutor(max_workers=self.threads) as pool:
            found = {
                link: pool.submit(copy_context().run, self._link, link, start, effort, begun, repetitions)
                for link in self.loaded
            }
            try:
                return {link: envelope.result() for link, envelope in found.items()}
            except BaseException:
                self.ended.set()
                pool.shutdown(wait=False, cancel_futures=True)
                raise

    def _link(
        self, link: str, start: MeshSettings, effort: Effort, begun: float, repetitions: float | None
    ) -> LinkEnvelope:
        """Solve one link: the worst poses on a first mesh, finer ones for those, the whole motion on the finest."""
        case, poses = self.moved.case, int(self.evaluated.sum())
        self._tell(f"Meshing {link} ...")
        with _naming(link):
            mesh = mesh_body(case.body(link), start)
            self._tell(f"Finding the worst poses of {link}: {len(mesh.cells)} elements, {poses} poses ...")
            motion = self._motion(link, displacement_space(mesh))
            worst = motion.worst_poses
            task = link_task(case, link, [history.chosen(worst[history.name]) for history in self.loaded[link]])
            task = replace(task, layers=None, layer_limits=())  # these have the estimate of one mesh
            require_compressible(task.nu)
        left = replace(effort, time_limit=max(0.0, effort.time_limit - (time.perf_counter() - begun)))
        refined = refine_links({link: task}, start, left, first={link: mesh}, progress=self._tell)[link]
        with _naming(link):
            if len(refined.meshes) > 1:
                space = refined.solution.space
                self._tell(f"Solving {link} over the motion: {len(space.cells)} elements, {poses} poses ...")
                motion = self._motion(link, space)
            shared, layered = {}, replace(task, layers=motion.measure.link.layers)
            for load_case in dict.fromkeys(history.name for history in self.loaded[link]):
                if (load_case, link) in self.ways:
                    couples = [self.ways[load_case, link]]
                    [shared[load_case]] = solid_shares(layered, refined, couples, threads=1)

            def scatter(quantity: Measure) -> dict[str, Scatter]:
                return {
                    load_case: load_scatter(case, load_case)
                    .times(self.shares.get((load_case, link), Scatter()))
                    .times(shared.get(load_case, {}).get(quantity, Scatter()))
                    for load_case in case.load_cases
                }

            own = scatter(STRESS[task.brittle])
            found = motion.envelope(repetitions=repetitions, refined=refined, scatter=own)
            every = {x: built_in_any_direction(case, motion, one, own[x]) for x, one in found.load_cases.items()}
            found = replace(found, notes=(*of_pair(case, link), *found.notes), load_cases=every)
            if layered.layers is None or not found.worst.known:
                return found
            return replace(found, layers=layer_envelopes(motion, scatter("layers"), repetitions))

    def _growth(self, load_case: str, link: str) -> Scatter:
        """Return by what the stress of a link may differ by hand, but for the scatter of loads and edges of clamps."""
        found = self.uneven.get((load_case, link), Scatter())
        answers = self.ways.get((load_case, link))
        if answers is None:
            return found
        stated, *others = HandStates(self.moved.case, link, answers.every).stress.tolist()
        return found.times(answers.stress(stated, others))

    def _tell(self, message: str) -> None:
        """Report progress; ends the work on a link once another has failed or the run was interrupted."""
        if self.ended.is_set():
            raise CannotRunError("interrupted")
        self.progress(message)

    def _motion(self, link: str, space: DisplacementSpace) -> LinkMotion:
        """Solve one link over the motion on one mesh."""
        case = self.moved.case
        return LinkMotion(
            space,
            link=link,
            body=case.body(link),
            material=case.material_of(link),
            histories=self.loaded[link],
            evaluated=self.evaluated,
            stated=case.torque_transfer,
            returns=self.moved.motion.returns or self.moved.motion.instants is not None,
            layers=layers_of(case, link),
            blocks={name: load_case.blocks for name, load_case in case.load_cases.items()},
        )

    def outcomes(self, links: Mapping[str, LinkEnvelope], *, lasting: bool = False) -> list[CheckOutcome]:
        """Return the outcome of every check; undecided under load cases that load no link."""
        moved, evaluated = self.moved, self.evaluated
        checks = envelope_outcomes(
            moved,
            links,
            evaluated,
            self.grown,
            loaded=self.loaded,
            stressed=self._growth,
            pins=self.pins,
            lasting=lasting,
        )
        checks += column_outcomes(moved, self.loaded, evaluated, self.grown)
        checks = unless_it_gives_way([*checks, *linkage_outcomes(moved, evaluated)])
        for load_case in self.idle:
            joints = moved.forces[load_case].forces
            forces = {name: np.linalg.norm(f[evaluated], axis=1).max() for name, f in joints.items()}
            own = [*(check for check in checks if check.load_case == load_case), *unloaded_links(moved.case, load_case)]
            checks = [check for check in checks if check.load_case != load_case]
            checks += undecided(own, load_case, self.sizes[load_case], forces)
        return checks


@bounded_run
def envelope_case(
    case: Case,
    *,
    name: str = "",
    threads: int = 2,
    repetitions: float | None = None,
    growth: float = TORQUE_GROWTH,
    effort: Effort | None = None,
    progress: Progress = lambda message: None,
) -> EnvelopeResult:
    """Check every link of a case over its motion, under every load case.

    On a first, coarse mesh the worst pose of every link and load case is found. For these poses the meshes are refined
    as in a check. The finest mesh then serves the whole motion, with the relative error found at the worst pose. Links
    are solved side by side.

    Parameters
    ----------
    case : Case
    name : str, optional
        Path or built-in name of the case, for the report.
    threads : int, optional
    repetitions : float, optional
        Of the motion that are wanted, for fatigue; those of the conditions when left out, else the card's.
    growth : float, optional
        Of the drive torque towards a dead point; poses beyond it are left out.
    effort : Effort, optional
        Accuracy of the solid models and what it may cost; by default what the case says.
    progress : callable
        Called with a sentence before every stage that may take long.

    Returns
    -------
    EnvelopeResult

    Raises
    ------
    CaseError
        For a case without motion, drive or part, and for repetitions that are not a number of at least 1.
    CannotRunError
        Where a stage fails.
    """
    clock = Clock()
    repetitions = case.conditions.cycles if repetitions is None else repetitions
    _require(case, repetitions)
    moved = rubbed_motion(case)
    case = moved.case
    if moved.locks:
        raise CaseError(f"{moved.locks[0]}; shorten the motion, state less friction, or another direction or drive")
    whole = whole_numbers(case, threads=threads)
    evaluated = _some_poses(moved, growth)
    over = _Envelope(moved, evaluated, threads, progress)
    moved = over.moved
    clock("motion")
    start = replace(START, curved=case.solid.curved).scaled(case.solid.mesh_size)
    links = over.solved(start, effort or effort_of(case), repetitions)
    clock("solids")
    checks = over.outcomes(links, lasting=repetitions is not None)
    linkage = over_motion(moved, evaluated)
    checks += [*limit_load_outcomes(moved, linkage), *unloaded_outcomes(whole)]
    checks = [*as_known(case, checks)]
    clock("frames")
    idle = [nothing_acts(load_case, over.sizes[load_case]) for load_case in over.idle]
    return EnvelopeResult(
        name=name,
        case=case,
        moved=moved,
        drive=moved.held,
        angles=moved.motion.angles,
        drive_angles=moved.motion.angles if moved.held is None else moved.motion.angle(moved.held.link),
        evaluated=evaluated,
        links=links,
        idle=tuple(link for link in case.checked_links if link not in over.loaded),
        linkage=linkage,
        work={load_case: work_between(moved, load_case) for load_case in moved.rubbing},
        clearance=whole.clearance,
        checks=tuple(checks),
        verdict=overall(check.verdict for check in checks),
        warnings=(*idle, *_warnings(case, moved, evaluated, growth)),
        timings=clock.stages,
    )


@contextmanager
def _naming(link: str) -> Iterator[None]:
    """Begin what is said of an error with the link's name."""
    try:
        yield
    except AlulaError as error:
        raise type(error)(f"{link}: {error}") from None


def _some_poses(moved: CaseMotion, growth: float) -> NDArray[np.bool_]:
    evaluated = evaluated_poses(moved, growth)
    if not evaluated.any():
        raise CannotRunError(
            f"envelope: no pose is left, since the drive torque grows beyond {growth:g} times everywhere; drive "
            "another link or allow a larger growth"
        )
    return evaluated


def _require(case: Case, repetitions: float | None) -> None:
    """Refuse what no envelope is drawn for."""
    if repetitions is not None and not (math.isfinite(repetitions) and repetitions >= 1.0):
        raise CaseError(f"repetitions: they are {repetitions:g}, but must be a number of at least 1; state how many")
    if not case.checked_links:
        raise CaseError("envelope: no moving link has a part, so there is no stress; give a link a part")
    if case.motion is not None and case.motion.travel is not None:
        raise CaseError(
            "motion.travel: an envelope is drawn over the direction of a link, not over a slider's travel; state the "
            "range of a link, or look at the forces with alula motion"
        )


def evaluated_poses(moved: CaseMotion, growth: float = TORQUE_GROWTH) -> NDArray[np.bool_]:
    """Return the poses that count.

    Near a dead point of the driven link the drive torque grows as one over the leverage. Where the motion has such a
    point, poses with a leverage below the best one over ``growth`` are left out. In any motion, poses that no drive
    torque balances are left out.

    Parameters
    ----------
    moved : CaseMotion
        At n poses.
    growth : float, optional
        Of the drive torque towards a dead point.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    good = np.ones(len(moved.motion.angles), dtype=np.bool_)
    for solved in moved.forces.values():
        good &= np.isfinite(solved.drive_torque)
        if moved.dead_points:
            good &= solved.leverage * growth >= solved.leverage.max()
    return good


def _warnings(case: Case, moved: CaseMotion, evaluated: NDArray[np.bool_], growth: float) -> list[Reason | str]:
    found: list[Reason | str] = [*unusual_materials(case)]
    left_out = int(np.count_nonzero(~evaluated))
    if moved.dead_points:
        found.append(
            reason(
                "poses_near_dead_point",
                link=moved.drive.link,
                angles=tuple(math.degrees(angle) for angle in moved.dead_points),
                coordinate=moved.motion.coordinate.name,
                left_out=left_out,
                poses=len(evaluated),
                growth=growth,
            )
        )
    elif left_out:
        found.append(reason("poses_without_balance", left_out=left_out, poses=len(evaluated)))
    others = [name for name, check in case.all_checks.items() if not isinstance(check, (*FOLLOWED, *KINDS))]
    if others:
        found.append(reason("not_checked_over_motion", checks=others))
    if case.large_displacement != "off":
        found.append(reason("rigid_in_motion"))
    return found
