"""The numbers of all checks in n samples: those of the nominal check (``told``), times what toleranced sizes change."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.outcomes.pins import between_layers, torque_through
from alula.fea.outcomes.result import CheckResult
from alula.fea.refine.refinement import Effort
from alula.fea.tolerance.sizes import SizedCheck, SizeEnds, resized, sized_check
from alula.fea.tolerance.states import Sampler, States
from alula.fea.tolerance.told import PEAKS, SolvedCheck, Told
from alula.loads.case.case import Case
from alula.loads.case.layers import joints_of_pin
from alula.loads.records.check_spec import PinCheck

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Numbers:
    """The numbers of all outcomes in N samples; NaN in samples without equilibrium.

    Attributes
    ----------
    apart, dead : ndarray of bool, shape (N,)
        Samples that do not assemble, and those at a dead point of the drive.
    short : ndarray, shape (N,)
        By how much the branches of the former end before the pose [rad, mm]; NaN where no dead point ends them.
    value, low, high : ndarray, shape (outcomes, N)
    torque : ndarray, shape (load cases, N)
        Of the drive, or its force [N mm, N].
    pressed : frozenset of str
        Links that some sample compresses, whose buckling no outcome tells.
    """

    apart: NDArray[np.bool_]
    dead: NDArray[np.bool_]
    short: Real
    value: Real
    low: Real
    high: Real
    torque: Real
    pressed: frozenset[str]

    @classmethod
    def joined(cls, parts: Sequence["Numbers"]) -> "Numbers":
        """Return the numbers of several blocks of samples as one.

        Parameters
        ----------
        parts : sequence of Numbers

        Returns
        -------
        Numbers
        """
        arrays = {
            name: np.concatenate([getattr(part, name) for part in parts], axis=-1)
            for name in ("apart", "dead", "short", "value", "low", "high", "torque")
        }
        return cls(**arrays, pressed=frozenset().union(*(part.pressed for part in parts)))


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledCheck:
    """A check, ready for samples.

    Attributes
    ----------
    base : SolvedCheck
        Nominal.
    outcomes : tuple of CheckOutcome
        Nominal, those that samples are told of.
    sizes : tuple of SizedCheck
        What toleranced sizes change.
    """

    base: SolvedCheck
    outcomes: tuple[CheckOutcome, ...]
    sizes: tuple[SizedCheck, ...] = ()

    @property
    def result(self) -> CheckResult:
        """The nominal check."""
        return self.base.result

    @property
    def nominal(self) -> States:
        """Pose and statics without deviations, as the samples have them."""
        return self.base.nominal

    @classmethod
    def of(
        cls,
        result: CheckResult,
        sampler: Sampler,
        pilots: Real,
        *,
        ends: Sequence[SizeEnds] = (),
        effort: Effort | None = None,
        threads: int,
        progress: Callable[[str], None] = lambda message: None,
    ) -> "SampledCheck":
        """Solve what the samples need.

        Parameters
        ----------
        result : CheckResult
            Nominal, with solids.
        sampler : Sampler
        pilots : ndarray, shape (k, d)
            Deviations, zero in the first; corners among them.
        ends : sequence of SizeEnds, optional
            Of toleranced sizes.
        effort : Effort, optional
            Of the checks at these ends.
        threads : int
        progress : callable
            Called with a sentence before every stage that may take long.

        Returns
        -------
        SampledCheck
        """
        case = result.case
        base = SolvedCheck.of(result, sampler, pilots, links=case.checked_links, threads=threads)
        every = [one for r in result.load_cases.values() for one in r.checks]
        return cls(
            base=base,
            outcomes=tuple(o for o in every if covered(case, o)),
            sizes=tuple(
                sized_check(base, pilots, one, effort=effort, threads=threads, progress=progress) for one in ends
            ),
        )

    def numbers(self, deviations: Real) -> Numbers:
        """Return the numbers of samples.

        Parameters
        ----------
        deviations : ndarray, shape (N, d)

        Returns
        -------
        Numbers
        """
        states = self.base.sampler.states(deviations)
        good, own = states.good, deviations[states.good]
        found = np.full((3, len(self.outcomes), len(deviations)), np.nan)
        told = Told(check=self.base, states=states, deviations=own)
        if good.any():
            changes = [size.change(states, own) for size in self.sizes]
            for number, outcome in enumerate(self.outcomes):
                found[:, number, good] = resized(outcome, told.bands(outcome), changes)
        torque = np.full((len(states.forces), len(deviations)), np.nan)
        for row, forces in enumerate(states.forces.values()):
            torque[row, good] = forces.drive_torque + forces.drive_force
        return Numbers(
            apart=states.apart,
            dead=states.dead,
            short=states.short,
            value=found[0],
            low=found[1],
            high=found[2],
            torque=torque,
            pressed=told.pressed() if good.any() else frozenset(),
        )


def covered(case: Case, outcome: CheckOutcome) -> bool:
    """Return True for an outcome whose number follows from statics and unit solutions.

    That of a pin of several joints between layers does not: it is in no proportion to the force of one joint, and
    samples have no couples. Nor does that of a pin through which a torque may go.

    Parameters
    ----------
    case : Case
    outcome : CheckOutcome

    Returns
    -------
    bool
    """
    if outcome.quantity is Quantity.BUCKLING_FACTOR:
        return outcome.subject.kind == "link" and case.part_of(outcome.subject.name).is_beam  # others buckle as solids
    if outcome.subject.kind == "pin" and isinstance(case.all_checks[outcome.name], PinCheck):
        joint = outcome.subject.name
        alone = len(joints_of_pin(case, joint)) == 1 or not between_layers(case, joint)
        return alone and not torque_through(case, joint, 1.0, 1.0)
    known = (Quantity.SAFETY_FACTOR, Quantity.SUSTAINED_STRESS, *PEAKS, Quantity.DISPLACEMENT)
    return outcome.quantity in known
