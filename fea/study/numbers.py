"""What a variant hands to the store: the outcome of each check and the main numbers, in plain values."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Subject, Verdict, overall
from alula.fea.motion.envelope_result import EnvelopeResult
from alula.fea.motion.linkage_history import LinkageOverMotion, asked_over_motion, limit_load_outcomes
from alula.fea.outcomes.result import CheckResult, LinkageNumbers
from alula.fea.whole.outcomes import whole_numbers, whole_outcomes
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.dead_point_reach import least_dead_point_distance, way_to_dead_point
from alula.loads.states.masses import part_masses, rough_masses
from alula.loads.statics.effort import DriveEffort
from alula.loads.statics.rounding import without_rounding

State = Literal["done", "refused", "crashed"]
Weighs = bool | Literal["rough"]
LINKED = str(LINKAGE)
DRIVING = "the drive"
"""Whose torque or force has a sense of its own: small is what is small in size."""
DEAD_POINT = "distance to a dead point"


@dataclass(frozen=True, kw_only=True)
class VariantNumber:
    """One number of a variant, with its band, and what it was held against.

    Attributes
    ----------
    check : str
        Name of the check; "" for a number that nothing is asked of.
    subject : str
        Such as ``AE``, ``pin A``, ``the linkage``.
    load_case : str
        "" where the number belongs to none.
    quantity : str
        Such as ``safety factor``, ``mass``.
    unit : str
        "1" for a pure number.
    value, low, high : float
        NaN where nothing stands for it; the ends also where the band covers no error of the model.
    limit : float
        NaN without check.
    verdict : Verdict or None
        None without check, and of a check that is not applicable.
    """

    check: str = ""
    subject: str
    load_case: str = ""
    quantity: str
    unit: str
    value: float
    low: float
    high: float
    limit: float = math.nan
    verdict: Verdict | None = None

    @classmethod
    def exact(cls, quantity: str, unit: str, value: float, subject: str, load_case: str = "") -> "VariantNumber":
        """Return a number without band that nothing is asked of.

        Parameters
        ----------
        quantity, unit : str
        value : float
        subject : str
        load_case : str, optional

        Returns
        -------
        VariantNumber
        """
        return cls.banded(quantity, unit, Band.exact(value), subject, load_case)

    @classmethod
    def banded(cls, quantity: str, unit: str, band: Band, subject: str, load_case: str = "") -> "VariantNumber":
        """Return a number with its band that nothing is asked of.

        Parameters
        ----------
        quantity, unit : str
        band : Band
        subject : str
        load_case : str, optional

        Returns
        -------
        VariantNumber
        """
        low, high = float(band.told.low), float(band.told.high)
        return cls(
            quantity=quantity, unit=unit, value=float(band.value), low=low, high=high, subject=subject,
            load_case=load_case,
        )  # fmt: skip

    @property
    def band(self) -> Band:
        """The number with its band, whose sources are not kept."""
        without = "not kept" if math.isnan(self.low) else ""
        return Band(value=self.value, low=self.low, high=self.high, without=without)

    @classmethod
    def of(cls, outcome: CheckOutcome) -> "VariantNumber":
        """Return a check's outcome.

        Parameters
        ----------
        outcome : CheckOutcome

        Returns
        -------
        VariantNumber
        """
        about, unit = str(outcome.subject), outcome.unit or "1"
        found = cls.banded(outcome.quantity.value, unit, outcome.value, about, outcome.load_case)
        verdict = outcome.verdict if outcome.applies else None
        return replace(found, check=outcome.name, limit=float(outcome.limit), verdict=verdict)


@dataclass(frozen=True, kw_only=True)
class VariantResult:
    """What became of one variant.

    Attributes
    ----------
    state : {"done", "refused", "crashed"}
        "refused" where the case's own rules forbid it, "crashed" where no answer came.
    verdict : Verdict or None
        Of all checks; None where nothing was checked.
    sentence : str
        Why it was refused or crashed.
    seconds, processor : float
        Wall and processor time of the process that computed it [s], without those of its mesher.
    numbers : tuple of VariantNumber
    """

    state: State
    verdict: Verdict | None = None
    sentence: str = ""
    seconds: float = 0.0
    processor: float = 0.0
    numbers: tuple[VariantNumber, ...] = ()


def of_check(result: CheckResult, *, weighs: Weighs) -> tuple[Verdict, tuple[VariantNumber, ...]]:
    """Return verdict and numbers of a check.

    Parameters
    ----------
    result : CheckResult
    weighs : bool or "rough"
        Whether the links are weighed; "rough" by length and section.

    Returns
    -------
    Verdict
    tuple of VariantNumber
    """
    found: list[VariantNumber] = []
    for name, load_case in result.load_cases.items():
        found += map(VariantNumber.of, load_case.checks)
        reactions = without_rounding(load_case.large_displacement.reactions or load_case.forces.reactions)
        largest = max((joint.magnitude for joint in reactions.joints.values()), default=0.0)
        drive = reactions.drive
        effort = DriveEffort.TORQUE if drive is None else drive.effort(result.case.linkage)
        driving = reactions.driving[effort is DriveEffort.FORCE]
        found.append(VariantNumber.exact(f"drive {effort.word}", effort.unit, driving, DRIVING, name))
        found.append(VariantNumber.exact("largest joint force", "N", largest, LINKED, name))
        found += _of_linkage(load_case.linkage, name)
    distances = [load_case.linkage.dead_point_distance for load_case in result.load_cases.values()]
    if known := [distance for distance in distances if distance is not None]:
        found.append(VariantNumber.exact(DEAD_POINT, "1", min(known), LINKED))
    return result.verdict, (*found, *_masses(result.case, weighs=weighs))


def of_envelope(result: EnvelopeResult, *, weighs: Weighs) -> tuple[Verdict, tuple[VariantNumber, ...]]:
    """Return verdict and numbers of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    weighs : bool or "rough"
        Whether the links are weighed; "rough" by length and section.

    Returns
    -------
    Verdict
    tuple of VariantNumber
    """
    linkage = (number for name, over in result.linkage.items() for number in _of_linkage(over, name))
    found = (*map(VariantNumber.of, result.checks), *_of_motion(result.moved), *linkage)
    return result.verdict, (*found, *_masses(result.case, weighs=weighs))


def of_motion(result: CaseMotion, *, weighs: Weighs) -> tuple[Verdict | None, tuple[VariantNumber, ...]]:
    """Return numbers of a motion, with a verdict where a motor or the limit load is checked.

    Parameters
    ----------
    result : CaseMotion
    weighs : bool or "rough"
        Whether the links are weighed; "rough" by length and section.

    Returns
    -------
    Verdict or None
    tuple of VariantNumber
    """
    case = result.case
    whole = [outcome for outcomes in whole_outcomes(whole_numbers(case)).values() for outcome in outcomes]
    linkage = asked_over_motion(result)
    checked = [*whole, *limit_load_outcomes(result, linkage)]
    verdict = overall(outcome.verdict for outcome in checked) if checked else None
    frames = (number for name, over in linkage.items() for number in _of_linkage(over, name))
    own = (*_of_motion(result), *frames, *_masses(case, weighs=weighs))
    return verdict, (*map(VariantNumber.of, checked), *own)


def _of_linkage(found: LinkageNumbers | LinkageOverMotion, load_case: str) -> Iterator[VariantNumber]:
    """By what factor the loads may grow, and how far the linkage moves."""
    yield VariantNumber.banded(Quantity.LIMIT_LOAD.value, "1", found.limit_load, LINKED, load_case)
    yield VariantNumber.banded("largest displacement", "mm", found.displacement, LINKED, load_case)


def _of_motion(moved: CaseMotion) -> Iterator[VariantNumber]:
    """Largest drive torque and joint force, how far every link swings, and the figures of a flapping wing."""
    name, unit = moved.effort.word, moved.effort.unit
    for load_case, torque in moved.torque.items():
        yield VariantNumber.exact(f"largest drive {name}", unit, _largest(torque), moved.drive.link, load_case)
    for load_case, forces in moved.forces.items():
        largest = max((_largest(np.hypot(f[..., 0], f[..., 1])) for f in forces.forces.values()), default=0.0)
        yield VariantNumber.exact("largest joint force", "N", largest, LINKED, load_case)
    for link in moved.case.linkage.links:
        if link != moved.case.linkage.ground:
            yield VariantNumber.exact("swing", "deg", math.degrees(float(np.ptp(moved.motion.angle(link)))), link)
    yield VariantNumber.exact("dead points", "1", len(moved.dead_points), moved.drive.link)
    yield VariantNumber.exact(DEAD_POINT, "1", least_dead_point_distance(moved), LINKED)
    way = way_to_dead_point(moved)
    measure = moved.motion.coordinate.measure
    yield VariantNumber.exact(f"{measure.word} to a dead point", measure.unit, float(measure.told(way)), LINKED)
    if moved.case.flapping_wing is not None:
        wing = moved.case.flapping_wing.wing(moved.case.linkage)
        figures = {"": wing.metrics(), ", as published": wing.published_metrics()}
        for which, metrics in figures.items():
            for figure in ("phase_lag", "oscillation", "asymmetry"):
                value = math.degrees(getattr(metrics, figure))
                yield VariantNumber.exact(figure.replace("_", " ") + which, "deg", value, LINKED)


def _largest(values: object) -> float:
    """The greatest size; NaN where no pose has one."""
    sizes = np.abs(np.asarray(values, dtype=float))
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else math.nan


def _masses(case: Case, *, weighs: Weighs) -> Iterable[VariantNumber]:
    if not weighs:
        return ()
    rough = weighs == "rough"
    found = rough_masses(case) if rough else {link: mass.mass for link, mass in part_masses(case).items()}
    pins = {str(Subject.pin(joint)): pin.mass for joint, pin in pin_masses(case).items()}
    masses: Mapping[str, float] = {name: 1e6 * mass for name, mass in (found | pins).items()}
    numbers = [VariantNumber.exact("mass", "g", mass, link) for link, mass in masses.items()]
    numbers.append(VariantNumber.exact("mass", "g", sum(masses.values()), LINKED))
    return [replace(number, low=math.nan, high=math.nan) for number in numbers] if rough else numbers
