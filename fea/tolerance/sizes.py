"""What toleranced sizes change: the links that they shape are solved as solids at two ends, and numbers interpolated.

At each end the check is made anew, with the masses, solids and unit solutions of that size. The logarithm of each
number of a sample, under that sample's loads, follows a parabola through low end, nominal value and high end. So do the
ends of its band, which therefore is that of a direct check at these three sizes.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from alula.fea.check.run import check_case
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine
from alula.fea.refine.refinement import Effort
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.tolerance.states import Reach, States
from alula.fea.tolerance.told import SolvedCheck, Told
from alula.geometry.base.errors import AlulaError, CannotRunError
from alula.loads.case.case import Case
from alula.loads.case.toleranced import Variable
from alula.loads.records.applied import PartMass
from alula.loads.records.check_spec import PermanentSetCheck, PlasticCollapseCheck
from alula.loads.text.explain import printable

Real = NDArray[np.float64]

WIDE = 0.1
"""Least distance of the ends from the nominal value, as a share of it. Peaks on two meshes differ by some percent: ends
closer to each other would turn that into a slope. A parabola in the logarithm of a cubic power errs by 0.04 % here."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SizeEnd:
    """A case with another size.

    Attributes
    ----------
    case : Case
    masses : mapping of str to PartMass
    frames : mapping of str to LargeDisplacement
        Load case -> its frame in large displacement.
    """

    case: Case
    masses: Mapping[str, PartMass]
    frames: Mapping[str, LargeDisplacement]


@dataclass(frozen=True, kw_only=True, eq=False)
class SizeEnds:
    """The two ends of a size between which its numbers are interpolated.

    Attributes
    ----------
    variable : Variable
    column : int
        Of the samples.
    reach : float
        Distance of the ends from the nominal value [mm]: the tolerance, at least ``WIDE`` where the case allows that.
    low, high : SizeEnd
    links, joints : frozenset of str
        Links whose bodies change, and joints whose pins or eyes do.
    """

    variable: Variable
    column: int
    reach: float
    low: SizeEnd
    high: SizeEnd
    links: frozenset[str]
    joints: frozenset[str]

    @property
    def masses(self) -> Reach:
        """Masses at the ends, as samples are weighed."""
        return self.reach, self.low.masses, self.high.masses


def size_ends(case: Case, variables: Sequence[Variable], name: str = "") -> tuple[SizeEnds, ...]:
    """Return the ends of every toleranced size.

    Parameters
    ----------
    case : Case
        As it was read.
    variables : sequence of Variable
    name : str, optional
        Path or built-in name of the case, for companion files.

    Returns
    -------
    tuple of SizeEnds

    Raises
    ------
    CannotRunError
        For a size whose ends break a rule of the case, give way, or change no link.
    """
    return tuple(_ends(case, v, column, name) for column, v in enumerate(variables) if v.kind == "size")


def _ends(case: Case, variable: Variable, column: int, name: str) -> SizeEnds:
    entry = f"tolerances.{printable(variable.tolerance)}"
    reach = max(variable.half, WIDE * variable.nominal)
    while True:
        try:
            low, high = (_end(case, variable, way * reach, name) for way in (-1.0, 1.0))
            break
        except AlulaError as error:
            if reach == variable.half:
                text = f"{entry}: {error}; state a smaller tolerance, or vary it with alula study"
                raise type(error)(text) from None
            reach = variable.half  # only the least distance breaks a rule
    links = {x for x in case.checked_links if any(end.case.body(x) != case.body(x) for end in (low, high))}
    joints = {
        joint
        for joint, record in case.joints.items()
        if links & set(record.links) or low.case.joints[joint].pin_diameter != record.pin_diameter
    }
    if not links and not joints:
        raise CannotRunError(f"{entry}: no link and no pin of the linkage has this size; tolerance another one")
    return SizeEnds(
        variable=variable,
        column=column,
        reach=reach,
        low=low,
        high=high,
        links=frozenset(links),
        joints=frozenset(joints),
    )


def _end(case: Case, variable: Variable, by: float, name: str) -> SizeEnd:
    value = f"{variable.nominal + by!r} mm"
    try:
        there = case.with_values({variable.tolerance: value})
        statics = solve_case_statics(there, name)
        there = statics.case
    except AlulaError as error:
        raise type(error)(f"at {variable.nominal + by:.4g} mm, {error}") from None
    frames = {n: examine(there, n, forces, statics.loads[n]) for n, forces in statics.forces.items()}
    if any(frame.gives_way for frame in frames.values()):
        raise CannotRunError(f"at {variable.nominal + by:.4g} mm the linkage gives way")
    return SizeEnd(case=there, masses=statics.masses, frames=frames)


@dataclass(frozen=True, kw_only=True, eq=False)
class SizedCheck:
    """The nominal check at both ends of a size.

    Attributes
    ----------
    ends : SizeEnds
    low, high : SolvedCheck
    """

    ends: SizeEnds
    low: SolvedCheck
    high: SolvedCheck

    def change(self, states: States, deviations: Real) -> "SizeChange":
        """Return what the size changes in a block of samples.

        Parameters
        ----------
        states : States
        deviations : ndarray, shape (n, d)
            Of the samples that have an equilibrium.

        Returns
        -------
        SizeChange
        """
        low, high = (Told(check=end, states=states, deviations=deviations) for end in (self.low, self.high))
        return SizeChange(ends=self.ends, t=deviations[:, self.ends.column] / self.ends.reach, low=low, high=high)


def sized_check(
    base: SolvedCheck,
    pilots: Real,
    ends: SizeEnds,
    *,
    effort: Effort | None = None,
    threads: int,
    progress: Callable[[str], None] = lambda message: None,
) -> SizedCheck:
    """Check a case at both ends of a size, and solve the unit loads of the links that it shapes.

    Parameters
    ----------
    base : SolvedCheck
        Nominal.
    pilots : ndarray, shape (k, d)
        Deviations, zero in the first.
    ends : SizeEnds
    effort : Effort, optional
        Of the checks.
    threads : int
    progress : callable
        Called with a sentence before every stage that may take long.

    Returns
    -------
    SizedCheck
    """

    def solved(end: SizeEnd, by: float) -> SolvedCheck:
        progress(f"{ends.variable.tolerance} at {ends.variable.nominal + by:.4g} mm")
        case = end.case
        paths = PlasticCollapseCheck | PermanentSetCheck
        kept = {name: check for name, check in case.checks.items() if not isinstance(check, paths)}
        result = check_case(
            case.model_copy(update={"checks": kept}),  # samples do not cover plastic paths, which take long
            name=base.result.name,
            fidelity="solid",
            threads=threads,
            effort=effort,
            frames=end.frames,
            only=ends.links,
            progress=progress,
        )
        rows = pilots.copy()
        rows[0, ends.column] = by
        sampler = replace(base.sampler, case=end.case, masses=end.masses)
        return SolvedCheck.of(result, sampler, rows, links=ends.links, reference=base, threads=threads)

    return SizedCheck(ends=ends, low=solved(ends.low, -ends.reach), high=solved(ends.high, ends.reach))


@dataclass(frozen=True, kw_only=True, eq=False)
class SizeChange:
    """What a size changes in n samples.

    Attributes
    ----------
    ends : SizeEnds
    t : ndarray, shape (n,)
        Its deviation, -1 and 1 at the ends.
    low, high : Told
        What the samples' loads do at the ends.
    """

    ends: SizeEnds
    t: Real
    low: Told
    high: Told

    def logarithms(self, outcome: CheckOutcome, bands: Real) -> tuple[Real, Real] | None:
        """Return the logarithms of an outcome's numbers at the ends over the nominal ones.

        Parameters
        ----------
        outcome : CheckOutcome
            Nominal.
        bands : ndarray, shape (3, n)
            At the nominal size.

        Returns
        -------
        tuple of 2 ndarray, shape (3, n), or None
            None where the size does not touch the outcome; NaN where an end does not tell, or has no limit.
        """
        subject = outcome.subject
        touched = {"link": self.ends.links, "pin": self.ends.joints}.get(subject.kind, frozenset((subject.name,)))
        if subject.name not in touched:
            return None
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = [np.log(self._at(end, outcome, bands) / bands) for end in (self.low, self.high)]
        low, high = (np.where(np.isfinite(log), log, np.nan) for log in logs)
        return low, high

    @staticmethod
    def _at(end: Told, outcome: CheckOutcome, bands: Real) -> Real:
        if outcome.quantity is Quantity.DISPLACEMENT:
            return end.bands(outcome)  # over the nominal work of unit loads
        own = next((o for o in end.check.result.load_cases[outcome.load_case].checks if _same(o, outcome)), None)
        return np.full(bands.shape, np.nan) if own is None else end.bands(own)


def _same(one: CheckOutcome, other: CheckOutcome) -> bool:
    return (one.name, one.subject, one.quantity) == (other.name, other.subject, other.quantity)


def resized(outcome: CheckOutcome, bands: Real, changes: Sequence[SizeChange]) -> Real:
    """Return the numbers of an outcome at the sizes of n samples.

    Bands are widened by the difference between the parabola and the chords through the same three points, and for
    every two sizes by the most that a product of both would add if their parabolas come from one function of a sum of
    both, whose mixed derivative is the geometric mean of their second ones.

    Parameters
    ----------
    outcome : CheckOutcome
        Nominal.
    bands : ndarray, shape (3, n)
        Value, low and high end at the nominal sizes.
    changes : sequence of SizeChange

    Returns
    -------
    ndarray, shape (3, n)
        NaN where an end does not tell.
    """
    sums, off, curved = np.zeros(bands.shape), np.zeros(bands.shape), []
    for t, low, high in _touching(outcome, bands, changes):
        parabola = 0.5 * t * (high - low) + 0.5 * t**2 * (high + low)
        sums += parabola
        off += np.abs(parabola - np.where(t > 0.0, t * high, -t * low))
        curved.append(np.sqrt(np.abs(high + low)) * np.abs(t))
    off += sum((one * other for one, other in combinations(curved, 2)), np.zeros(bands.shape))
    known = np.isfinite(bands) & (bands > 0.0)
    with np.errstate(invalid="ignore", over="ignore"):
        value, low, high = bands * np.where(known, np.exp(sums + np.array([[0.0], [-1.0], [1.0]]) * off), 1.0)
    return np.array([value, np.minimum(low, value), np.maximum(high, value)])


def _touching(outcome: CheckOutcome, bands: Real, changes: Sequence[SizeChange]) -> Iterator[tuple[Real, Real, Real]]:
    for change in changes:
        found = change.logarithms(outcome, bands)
        if found is not None:
            yield change.t, *found
