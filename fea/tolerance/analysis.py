"""Samples of a case's tolerances, and what their numbers say."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from alula.fea.check.run import check_case
from alula.fea.common.clock import Clock
from alula.fea.common.reason import Reason, reason
from alula.fea.common.threads import bounded_run
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine
from alula.fea.outcomes.result import CheckResult
from alula.fea.refine.refinement import Effort
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.fea.standing.rubbing import presses_of
from alula.fea.tolerance.numbers import Numbers, SampledCheck, covered
from alula.fea.tolerance.result import Probability, ToleranceNumber, ToleranceResult, WorstCorner
from alula.fea.tolerance.sizes import size_ends
from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.loads.case.case import Case
from alula.loads.case.toleranced import Variable, toleranced
from alula.loads.states.actions import needs_masses
from alula.loads.states.masses import part_masses
from alula.loads.statics.effort import DriveEffort

Real = NDArray[np.float64]

SAMPLES = 100_000
_BLOCK = 10_000
_PILOTS = 40
"""Of samples at random, and as many corners."""
_LEAST_SHARE = 0.02
_SOBOL = 2048
"""Most base samples of the Sobol' indices."""
_CONVERGED = 1.2
"""Largest total index that rounding of the sample explains; beyond it a few samples make all of the variance."""


@bounded_run
def tolerance_case(
    case: Case,
    *,
    name: str = "",
    samples: int = SAMPLES,
    seed: int = 0,
    threads: int = 2,
    effort: Effort | None = None,
    progress: Callable[[str], None] = lambda message: None,
) -> ToleranceResult:
    """Check a case as solids, and sample its tolerances.

    Parameters
    ----------
    case : Case
        With tolerances.
    name : str, optional
        Path or built-in name of the case.
    samples, seed : int, optional
    threads : int, optional
    effort : Effort, optional
        Of the nominal check.
    progress : callable
        Called with a sentence before every stage that may take long.

    Returns
    -------
    ToleranceResult

    Raises
    ------
    CaseError
        For a case without tolerances, and for less than 100 samples.
    CannotRunError
        Where joint forces do not follow from equilibrium, or the linkage gives way.
    """
    variables = _asked(case, samples)
    clock = Clock()
    statics = solve_case_statics(case, name)
    stated, case = case, statics.case
    frames = {
        load_case: examine(case, load_case, forces, statics.loads[load_case])
        for load_case, forces in statics.forces.items()
    }
    _require(statics, frames)
    ends = size_ends(stated, variables, name)
    result = check_case(
        case, name=name, fidelity="solid", threads=threads, effort=effort, frames=frames, progress=progress
    )
    clock("nominal check")
    masses = part_masses(case) if needs_masses(case) else {}
    reaches = {one.variable.tolerance: one.masses for one in ends} if masses else {}
    plane = case.in_one_plane() if case.layered else case
    presses = {x: presses_of(case, forces) for x, forces in statics.forces.items()}
    sampler = Sampler(
        case=plane, pose=plane.solve_pose(), masses=masses, variables=variables, reaches=reaches, presses=presses
    )
    rng = np.random.default_rng(seed)
    progress("unit solutions of the links")
    pilots = _pilots(variables, rng)
    check = SampledCheck.of(result, sampler, pilots, ends=ends, effort=effort, threads=threads, progress=progress)
    clock("unit solutions")
    progress(f"{samples:,} samples")
    deviations = _drawn(variables, samples, rng)
    found = _in_blocks(check, deviations)
    clock("samples")
    groups = tuple(dict.fromkeys(variable.tolerance for variable in variables))
    first, total = _indices(check, variables, groups, deviations, found)
    clock("Sobol' indices")
    numbers = _numbers(check, found, first, total)
    left_out = _left_out(result)
    certain, possible = map(np.logical_and.reduce, zip(*_counted(check, found), strict=True))
    return ToleranceResult(
        nominal=result,
        tolerances=groups,
        samples=samples,
        seed=seed,
        deviations=deviations,
        numbers=numbers,
        apart=Probability.of(found.apart),
        dead=Probability.of(found.dead),
        certain=Probability.of(certain),
        possible=Probability.of(possible),
        corner=_corner(check, variables, numbers, deviations),
        left_out=left_out,
        notes=_notes(result, found, left_out),
        timings=clock.stages,
    )


def _asked(case: Case, samples: int) -> tuple[Variable, ...]:
    variables = toleranced(case)
    if not variables:
        raise CaseError('tolerances: the case states none; add for example [tolerances] with pins = "0.2 mm"')
    if not 100 <= samples <= 10_000_000:
        raise CaseError(f"samples: there are {samples}, but there must be from 100 to 10000000; choose another number")
    return variables


def _require(statics: CaseStatics, frames: Mapping[str, LargeDisplacement]) -> None:
    """Refuse what statics of pinned links do not tell, before any solid is solved."""
    clamped = [name for name, joint in statics.case.joints.items() if joint.clamp_length is not None]
    if clamped:
        raise CannotRunError(
            f"tolerances: joint {clamped[0]} is clamped, and how the place of a clamp deviates is not covered; vary "
            "entries with alula study"
        )
    for name, forces in statics.forces.items():
        if not forces.by_equilibrium:
            raise CannotRunError(
                f"tolerances: under load case {name} the joint forces are those of a {forces.model} and do not follow "
                "from equilibrium alone, which is not covered; vary entries with alula study"
            )
        if statics.standing[name].case is not statics.case:
            raise CannotRunError(
                f"tolerances: under load case {name} the linkage stands where all that acts on it balances or where a "
                "stop holds it, so samples would stand elsewhere, which is not covered; vary entries with alula study"
            )
        if frames[name].gives_way:
            raise CannotRunError(
                f"tolerances: the linkage gives way under load case {name} without any deviation, so the samples have "
                "no equilibrium to look at; make the nominal case hold first"
            )


def _drawn(variables: Sequence[Variable], count: int, rng: np.random.Generator) -> Real:
    """Return independent samples (count, d)."""
    found = np.empty((count, len(variables)))
    for column, variable in zip(found.T, variables, strict=True):
        if variable.distribution == "uniform":
            column[:] = variable.half * rng.uniform(-1.0, 1.0, count)
        elif variable.distribution == "normal":
            column[:] = variable.half / 3.0 * rng.standard_normal(count)
        else:
            column[:] = variable.half * rng.choice([-1.0, 1.0], count)
        if variable.kind in ("material", "load"):
            np.maximum(column, _LEAST_SHARE - 1.0, out=column)  # the tail of a normal distribution
    return found


def _pilots(variables: Sequence[Variable], rng: np.random.Generator) -> Real:
    """Return the nominal sample, some at random and some corners."""
    half = np.array([variable.half for variable in variables])
    corners = half * rng.choice([-1.0, 1.0], (_PILOTS, len(half)))
    return np.vstack([np.zeros(len(half)), _drawn(variables, _PILOTS, rng), corners])


def _in_blocks(check: SampledCheck, deviations: Real) -> Numbers:
    return Numbers.joined([check.numbers(deviations[i : i + _BLOCK]) for i in range(0, len(deviations), _BLOCK)])


def _indices(
    check: SampledCheck, variables: Sequence[Variable], groups: Sequence[str], deviations: Real, found: Numbers
) -> tuple[Real, Real]:
    """Return first-order and total Sobol' indices (outputs, tolerances) of all values and torques.

    The first samples serve as both base samples of Saltelli's scheme (``scipy.stats.sobol_indices``); each tolerance
    adds a third one, whose columns of the tolerance come from the second.
    """
    from scipy.stats import sobol_indices

    n = 2 ** int(np.log2(max(2, min(_SOBOL, len(deviations) // (2 * len(groups)), len(deviations) // 2))))
    A, B = deviations[:n], deviations[n : 2 * n]
    mixed = []
    for group in groups:
        own = np.array([variable.tolerance == group for variable in variables])
        mixed.append(np.where(own, B, A))
    third = _in_blocks(check, np.vstack(mixed))
    base = _used(check, found)
    f_A, f_B = base[:, :n], base[:, n : 2 * n]
    f_AB = _used(check, third).reshape(len(base), len(groups), n)
    first, total = np.full((2, len(base), len(groups)), np.nan)
    for row in range(len(base)):
        known = np.flatnonzero(np.isfinite(f_A[row]) & np.isfinite(f_B[row]) & np.isfinite(f_AB[row]).all(axis=0))
        known = known[: 2 ** int(np.log2(max(len(known), 1)))]  # as the estimator wants it
        a, b, ab = f_A[row, known], f_B[row, known], f_AB[row][:, known]
        if len(known) < 16 or not np.ptp(a) > 1e-9 * np.abs(a).max():
            continue
        if len(groups) == 1:
            first[row] = total[row] = 1.0  # all variance is its own
            continue
        answer = sobol_indices(
            func={"f_A": a[None], "f_B": b[None], "f_AB": ab[:, None]}, n=len(a), method="saltelli_2010"
        )
        if answer.total_order.max() <= _CONVERGED:
            first[row], total[row] = answer.first_order.ravel(), answer.total_order.ravel()
    return first, total


def _used(check: SampledCheck, found: Numbers) -> Real:
    """Return the shares of their limits that values use up, which stay finite, and torques."""
    at_least = np.array([outcome.at_least for outcome in check.outcomes], dtype=np.bool_)
    with np.errstate(divide="ignore"):
        used = np.where(at_least[:, None], 1.0 / found.value, found.value)
    return np.vstack([used, found.torque])


def _counted(check: SampledCheck, found: Numbers) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.bool_]]]:
    """Yield which samples stand, and for each outcome which pass it for certain, and which possibly."""
    stands = ~(found.apart | found.dead)
    yield stands, stands
    for outcome, low, high in zip(check.outcomes, found.low, found.high, strict=True):
        sense = outcome.quantity.sense
        kept, missed = sense.sides(low, high, outcome.limit)
        # Some are left open whatever their band says, such as layers without strength in shear.
        left_open = outcome.verdict is not sense.verdict(outcome.value, outcome.limit)
        yield stands & kept & (not left_open), stands & ~np.asarray(missed)


def _numbers(check: SampledCheck, found: Numbers, first: Real, total: Real) -> tuple[ToleranceNumber, ...]:
    """Return the numbers of the checks, then the drive's torque under each load case."""
    numbers, (_, *counted) = list[ToleranceNumber](), _counted(check, found)
    for row, (outcome, (certain, possible)) in enumerate(zip(check.outcomes, counted, strict=True)):
        numbers.append(
            ToleranceNumber(
                check=outcome.name,
                subject=str(outcome.subject),
                load_case=outcome.load_case,
                quantity=outcome.quantity.value,
                unit=outcome.unit or "1",
                limit=outcome.limit,
                at_least=outcome.at_least,
                nominal=(outcome.value.value, outcome.value.low, outcome.value.high),
                values=found.value[row],
                low=found.low[row],
                high=found.high[row],
                certain=Probability.of(certain),
                possible=Probability.of(possible),
                first=first[row],
                total=total[row],
            )
        )
    drive = check.result.case.pinned_drive
    effort = DriveEffort.TORQUE if drive is None else drive.effort(check.result.case.linkage)
    for row, (load_case, forces) in enumerate(check.nominal.forces.items() if drive is not None else ()):
        torque = float(forces.drive_torque[0] + forces.drive_force[0])
        at = len(check.outcomes) + row
        numbers.append(
            ToleranceNumber(
                subject="the drive",
                load_case=load_case,
                quantity=f"drive {effort.word}",
                unit=effort.unit,
                nominal=(torque, torque, torque),
                values=found.torque[row],
                low=found.torque[row],
                high=found.torque[row],
                first=first[at],
                total=total[at],
            )
        )
    return tuple(numbers)


def _corner(
    check: SampledCheck, variables: Sequence[Variable], numbers: Sequence[ToleranceNumber], deviations: Real
) -> WorstCorner | None:
    """Return the corner that is worst for the check closest to its limit, by the signs of its slopes."""
    asked = [i for i, number in enumerate(numbers) if np.isfinite(number.closeness)]
    if not asked:
        return None
    worst = max(asked, key=lambda i: numbers[i].closeness)
    number, half = numbers[worst], np.array([variable.half for variable in variables])
    known = np.isfinite(number.values)
    if known.sum() < 2:
        return None
    values = number.values[known]
    slopes = (deviations[known] - deviations[known].mean(axis=0)).T @ (values - values.mean())
    corner = half * np.where(slopes > 0.0, 1.0, -1.0) * (-1.0 if number.at_least else 1.0)
    there = check.numbers(corner[None])
    found: dict[str, tuple[float, ...]] = {}
    for variable, deviation in zip(variables, corner.tolist(), strict=True):
        found[variable.tolerance] = (*found.get(variable.tolerance, ()), deviation)
    value, low, high = (float(ends[worst, 0]) for ends in (there.value, there.low, there.high))
    return WorstCorner(number=worst, value=value, low=low, high=high, deviations=found)


def _left_out(result: CheckResult) -> tuple[Reason, ...]:
    """Return the checks that the samples do not cover, with their nominal verdicts."""
    every = [
        one for load_case in result.load_cases.values() for one in load_case.checks if not covered(result.case, one)
    ]
    return tuple(
        dict.fromkeys(
            reason("check_left_out", name=one.name, subject=one.subject.long, verdict=one.verdict.value)
            for one in every
        )
    )


def _notes(result: CheckResult, found: Numbers, left_out: Sequence[Reason]) -> tuple[Reason, ...]:
    notes = []
    if left_out:
        notes.append(reason("samples_do_not_cover", checks=left_out))
    bent = [name for name, r in result.load_cases.items() if r.large_displacement.followed]
    if bent:
        notes.append(reason("samples_in_undeformed_pose", load_cases=bent))
    if result.case.layered:
        notes.append(reason("nominal_couples_of_layers"))
    if found.pressed:
        notes.append(reason("some_samples_compress", links=sorted(found.pressed)))
    return (*notes, *_fallen(result, found))


def _fallen(result: CheckResult, found: Numbers) -> Iterator[Reason]:
    """Tell how many samples have no equilibrium, and why."""
    ended, coordinate = np.isfinite(found.short), result.pose.coordinate or Coordinate("")
    by = np.max(found.short[ended], initial=0.0) * float(coordinate.measure.told(1.0))
    for which, what in (
        (ended, reason("cannot_stand_in_pose", coordinate=coordinate.name, by=by, unit=coordinate.measure.unit)),
        (found.apart & ~ended, reason("do_not_assemble")),
        (found.dead, reason("at_dead_point_of_drive")),
    ):
        if which.any():
            yield reason("samples_fail", count=int(which.sum()), samples=len(which), why=what)
