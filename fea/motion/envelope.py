"""The whole motion of a case: the least safety factor of each link over all poses and load cases, where and when."""

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.check.run import effort_of
from fea.check.solid_result import link_task
from fea.common.scatter import load_scatter
from fea.common.threads import bounded_run
from fea.common.verdict import overall
from fea.motion.buckling_history import with_second_order
from fea.motion.envelope_outcomes import FOLLOWED, column_outcomes, envelope_outcomes
from fea.motion.envelope_result import EnvelopeResult, LinkEnvelope
from fea.motion.link_envelope import link_envelope
from fea.motion.link_history import link_histories
from fea.motion.linkage_history import linkage_outcomes
from fea.outcomes.linkage import unless_it_gives_way
from fea.outcomes.unchecked import unusual_materials
from fea.outcomes.unloaded import acts, nothing_acts, stated_size, undecided, unloaded_links
from fea.refine.refinement import START, Effort, refine_links
from fea.solid.solution import require_compressible
from fea.solid.space import DisplacementSpace, displacement_space
from geometry.base.errors import AlulaError, CannotRunError, CaseError
from geometry.meshing.mesh import mesh_bodies
from loads.case.case import Case
from loads.states.case_motion import CaseMotion, solve_case_motion

Real = NDArray[np.float64]
Progress = Callable[[str], None]

TORQUE_GROWTH = 20.0
"""Of the drive torque towards a dead point, beside that at the best leverage, beyond which poses are left out."""


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

    name         path or built-in name of the case, for the report
    repetitions  of the motion that are wanted, for fatigue; the cycles of the material's card when left out
    growth       of the drive torque towards a dead point, beyond which poses are left out
    effort       accuracy of the solid models and what it may cost, by default what the case says

    On a first, coarse mesh the worst pose of every link and load case is found. There the meshes are refined as
    a check would; the finest one then serves the whole motion, with the relative error found at the worst pose.

    Raises ``CaseError`` for a case without motion, drive or part and for repetitions that are no number of at least 1,
    ``CannotRunError`` where a stage fails.
    """
    begin = time.perf_counter()
    if repetitions is not None and not (math.isfinite(repetitions) and repetitions >= 1.0):
        raise CaseError(f"repetitions: they are {repetitions:g}, but must be a number of at least 1; state how many")
    if not case.checked_links:
        raise CaseError("envelope: no moving link has a part, so there is no stress; give a link a part")
    if case.motion is not None and case.motion.travel is not None:
        raise CaseError(
            "motion.travel: an envelope is drawn over the direction of a link, not over a slider's travel; state the "
            "range of a link, or look at the forces with alula motion"
        )
    moved = solve_case_motion(case)
    evaluated = evaluated_poses(moved, growth)
    if not evaluated.any():
        raise CannotRunError(
            f"envelope: no pose is left, since the drive torque grows beyond {growth:g} times everywhere; drive "
            "another link or allow a larger growth"
        )
    sizes = {title: stated_size(case, title) for title in case.load_cases}
    length = case.linkage.longest
    histories = {
        link: tuple(h for h in link_histories(moved, link) if acts(h.chosen(evaluated), sizes[h.name], length))
        for link in case.checked_links
    }
    loaded = {
        link: tuple(with_second_order(case, link, history, evaluated) for history in found)
        for link, found in histories.items()
        if found
    }
    timings = {"motion": time.perf_counter() - begin}

    def over_motion(link: str, space: DisplacementSpace, **options: Any) -> LinkEnvelope:
        try:
            return link_envelope(
                space,
                link=link,
                body=case.body(link),
                material=case.material_of(link),
                histories=loaded[link],
                evaluated=evaluated,
                stated=case.drive.transfer if case.drive else None,
                returns=moved.motion.returns,
                scatter={title: load_scatter(case, title) for title in case.load_cases},
                threads=threads,
                **options,
            )
        except AlulaError as error:
            raise type(error)(f"{link}: {error}") from None

    begin = time.perf_counter()
    start = replace(START, curved=case.solid.curved).scaled(case.solid.mesh_size)
    progress(f"Meshing {len(loaded)} links ...")
    meshes = mesh_bodies({link: case.body(link) for link in loaded}, start)
    timings["meshing"], begin = time.perf_counter() - begin, time.perf_counter()
    tasks = {}
    for link, found in loaded.items():
        progress(f"Finding the worst poses of {link} ...")
        first = over_motion(link, displacement_space(meshes[link]), fatigue=False)
        at_worst = [h.chosen(first.load_cases[h.name].pose) for h in found]
        tasks[link] = link_task(case, link, at_worst)
        require_compressible(tasks[link].nu)
    timings["worst poses"], begin = time.perf_counter() - begin, time.perf_counter()
    refined = refine_links(tasks, start, effort or effort_of(case), threads=threads, progress=progress)
    timings["refinement"], begin = time.perf_counter() - begin, time.perf_counter()
    links = {}
    for link, solid in refined.items():
        space = solid.solution.space
        progress(f"Solving {link} over the motion: {len(space.cells)} elements, {int(evaluated.sum())} poses ...")
        links[link] = over_motion(link, space, repetitions=repetitions, refined=solid, notes=solid.solution.notes)
    timings["motion of the solids"] = time.perf_counter() - begin
    checks = [*envelope_outcomes(moved, links, evaluated), *column_outcomes(moved, loaded, evaluated)]
    checks = unless_it_gives_way([*checks, *linkage_outcomes(moved, evaluated)])
    idle = set(case.load_cases) - {history.name for found in loaded.values() for history in found}
    for title in (title for title in case.load_cases if title in idle):
        forces = {name: np.linalg.norm(f[evaluated], axis=1).max() for name, f in moved.forces[title].forces.items()}
        of_idle = [*(check for check in checks if check.load_case == title), *unloaded_links(case, title)]
        checks = [check for check in checks if check.load_case != title]
        checks += undecided(of_idle, title, sizes[title], forces)
    return EnvelopeResult(
        name=name,
        case=case,
        moved=moved,
        drive=moved.drive,
        angles=moved.motion.angles,
        drive_angles=moved.motion.angle(moved.drive.link),
        evaluated=evaluated,
        links=links,
        idle=tuple(link for link in histories if link not in loaded),
        checks=tuple(checks),
        verdict=overall(check.verdict for check in checks),
        warnings=(
            *(nothing_acts(title, sizes[title]) for title in case.load_cases if title in idle),
            *_warnings(case, moved, evaluated, growth),
        ),
        timings=timings,
    )


def evaluated_poses(moved: CaseMotion, growth: float = TORQUE_GROWTH) -> NDArray[np.bool_]:
    """Poses (n,) whose stress means something.

    Near a dead point of the driven link the torque that a load asks for grows as one over the leverage.
    Where the motion holds such a point, poses are left out whose leverage is less than one ``growth``-th of
    the best one; and in any motion those at which there is no torque at all.
    """
    good = np.ones(len(moved.motion.angles), dtype=np.bool_)
    for solved in moved.forces.values():
        good &= np.isfinite(solved.drive_torque)
        if moved.dead_points:
            good &= solved.leverage * growth >= solved.leverage.max()
    return good


def _warnings(case: Case, moved: CaseMotion, evaluated: NDArray[np.bool_], growth: float) -> list[str]:
    found = unusual_materials(case)
    left_out = int(np.count_nonzero(~evaluated))
    if moved.dead_points:
        at = ", ".join(f"{math.degrees(angle):.2f}" for angle in moved.dead_points)
        found.append(
            f"the driven link {moved.drive.link} has a dead point at {at} deg of {moved.motion.coordinate}; "
            f"{left_out} of {len(evaluated)} poses are left out, where the drive torque is more than {growth:g} times "
            "that at the best leverage"
        )
    elif left_out:
        found.append(f"{left_out} of {len(evaluated)} poses are left out, since no drive torque balances them")
    others = [name for name, check in case.all_checks.items() if not isinstance(check, FOLLOWED)]
    if others:
        found.append(f"checks {', '.join(others)} concern single poses or the motor: use alula check for them")
    if case.large_displacement != "off":
        found.append("links are rigid in the motion: equilibrium is that of the undeformed linkage")
    return found
