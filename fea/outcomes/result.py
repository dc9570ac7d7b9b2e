"""The records that a check hands to the reports."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.theory import BeamCheck, CantileverCheck
from alula.fea.common.band import Band
from alula.fea.common.change import VerdictChange
from alula.fea.common.reason import Reason
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.found import Found
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.outcomes.opinion import SecondOpinion
from alula.fea.outcomes.pins import PinStress
from alula.fea.outcomes.unchecked import caveats
from alula.fea.refine.discretisation import Discretisation
from alula.fea.refine.link_buckling import SolidBuckling
from alula.fea.solid.solution import SolidCase, SolidSolution
from alula.fea.solid.stress import StressField
from alula.fea.standing.joint_forces import JointForces, WayToHold
from alula.fea.vibration.over_motion import CaseFrequencies
from alula.geometry.linkage.motion import Motion
from alula.geometry.linkage.pose import Pose
from alula.geometry.materials.material import stress_measure
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.sources.published_statics import StaticsAudit
from alula.loads.states.case_motion import AirRange
from alula.loads.states.clearance import Clearance
from alula.loads.states.drive_work import DriveWork
from alula.loads.states.extent import Extent
from alula.loads.states.standing import Standing
from alula.loads.states.weighed import Weighed
from alula.loads.statics.statics import Reactions
from alula.loads.text.caveat import Caveat

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class VariantPeak:
    """Peaks of the solid model under one way to model what is not known; NaN where a peak has no limit.

    Attributes
    ----------
    span : int
        Loaded angle of the pin holes [degrees].
    transfer : str or None
        "eye-faces" or "bore-shear"; None on a link without drive torque.
    von_mises, principal : float
        Largest von Mises and largest principal stress [MPa].
    displacement : float
        The largest [mm].
    """

    span: int
    transfer: str | None
    von_mises: float
    principal: float
    displacement: float

    @property
    def title(self) -> str:
        """Name for people."""
        return f"pin pressure over {self.span}°" + (f", torque by {self.transfer}" if self.transfer else "")


@dataclass(frozen=True, kw_only=True)
class SectionComparison:
    """Hand calculation against the solid model at one section.

    Attributes
    ----------
    x : float
        Station in the link's frame [mm].
    kind : {"bending", "axial"}
        Extreme-fibre bending stress, or N/A.
    hand, solid : float
        [MPa]
    difference : float
        (solid - hand) over the link's largest hand stress of that kind.
    """

    x: float
    kind: str
    hand: float
    solid: float
    difference: float


@dataclass(frozen=True, kw_only=True)
class LinkResult:
    """What one load case does to one link, whichever model the numbers come from.

    Attributes
    ----------
    link : str
    von_mises_max, principal_max : Band
        Largest von Mises and largest principal stress [MPa].
    safety_factor : Band
        Strength over the stress that the material names.
    displacement_max : Band
        Relative to the line through the link's first and last pin, or that turns with its only bore [mm].
    location : ndarray, shape (3,)
        Place of the largest decisive stress in the link's frame [mm].
    beam : BeamCheck
        The hand calculation by beam theory.
    brittle : bool
        True where the largest principal stress decides, False where von Mises stress does.
    notes : tuple of Reason or str
        What the reader must know about these numbers.
    decided_by : {"beam", "solid", ""}
        Model that decided the link under all load cases; "" where a model was forced that may not decide.
    why : Reason or str
        Why that model.
    layers : LayerStress or None
        Of a printed link whose layers are checked, by its solid.
    """

    fidelity: ClassVar[str]
    """The model that the numbers come from."""
    link: str
    von_mises_max: Band
    principal_max: Band
    safety_factor: Band
    displacement_max: Band
    location: NDArray[np.float64]
    beam: BeamCheck
    brittle: bool
    notes: tuple[Reason | str, ...]
    decided_by: str
    why: Reason | str
    layers: LayerStress | None = None

    @property
    def decisive(self) -> Band:
        """The stress that the safety factor is counted from [MPa]."""
        return self.principal_max if self.brittle else self.von_mises_max

    @property
    def measure(self) -> str:
        """What that stress is called."""
        return stress_measure(brittle=self.brittle)

    @property
    def model(self) -> str:
        """The model that decided, else the one that the numbers come from."""
        return self.decided_by or self.fidelity

    @property
    def severity(self) -> float:
        """By which the worst load case is found: the least lower end of the safety factor; one without comes first."""
        return -math.inf if self.safety_factor.unknowable else self.safety_factor.low


@dataclass(frozen=True, kw_only=True)
class HandResult(LinkResult):
    """A link by hand calculation.

    Attributes
    ----------
    next_cost : Reason or None
        What a solid model would have cost; "" where it was not weighed.
    """

    fidelity = "beam"
    next_cost: Reason | None


@dataclass(frozen=True, kw_only=True)
class SolidResult(LinkResult):
    """A link by its solid model.

    Attributes
    ----------
    solution : SolidSolution
        Of all load cases of the link.
    governing_case : SolidCase
        The variant of this load case that the values come from: its displacement field.
    stress : StressField
        Recovered from that field.
    variants : tuple of VariantPeak
        Peaks of every variant of this load case.
    governing : VariantPeak
        Of the variant that the values come from.
    comparisons : tuple of SectionComparison
        Hand calculation against this model, section by section.
    discretisation : Discretisation
        The error that the meshes leave.
    buckling : SolidBuckling or None
        The factors on this load case at which it buckles; None where beams stand for the link.
    """

    fidelity = "solid"
    solution: SolidSolution
    governing_case: SolidCase
    stress: StressField
    variants: tuple[VariantPeak, ...]
    governing: VariantPeak
    comparisons: tuple[SectionComparison, ...]
    discretisation: Discretisation
    buckling: SolidBuckling | None = None

    @property
    def elements(self) -> int:
        """Number of tetrahedra."""
        return len(self.solution.space.cells)

    @property
    def unknowns(self) -> int:
        """Number of unknown displacements."""
        return self.solution.space.unknowns


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageNumbers:
    """Numbers of the linkage as a whole under a load case; each is computed once it is asked for.

    Attributes
    ----------
    case : Case
    moved : LargeDisplacement
    forces : JointForces
        In the undeformed pose.
    largest : callable
        Returns the largest displacement of any place [mm], and that place for people.
    """

    case: Case
    moved: LargeDisplacement
    forces: JointForces
    largest: Callable[[], tuple[Band, Reason | str]]

    @property
    def limit_load(self) -> Band:
        """Factor on all loads at which the linkage gives way."""
        return self.moved.limit_load

    @cached_property
    def displacement_and_place(self) -> tuple[Band, Reason | str]:
        """The largest displacement [mm], and its place for people; "" where it is not known."""
        return self.largest()

    @property
    def displacement(self) -> Band:
        """Largest displacement of any place of the linkage [mm]."""
        return self.displacement_and_place[0]

    @property
    def where(self) -> Reason | str:
        """The place that moves most; "" where it is not known."""
        return self.displacement_and_place[1]

    @property
    def dead_point_distance(self) -> float | None:
        """Of the pose from a dead point of the driven link, 0 there; None where nothing is driven."""
        drive = self.case.pinned_drive
        return None if drive is None or drive.idle else drive.dead_point_distance(self.forces.reactions.pose)


@dataclass(frozen=True, kw_only=True)
class LoadCaseResult:
    """One load case.

    Attributes
    ----------
    name : str
    forces : JointForces
        In the undeformed pose, with the model that gave them.
    large_displacement : LargeDisplacement
        Whether the undeformed pose is good enough, and what holds on the deformed shape if not.
    links : mapping of str to LinkResult
        Each a ``HandResult`` or a ``SolidResult``.
    pins : mapping of str to PinStress
        Of every joint whose pin a check asks for.
    ways_to_hold : tuple of WayToHold
        Displacement of the point that the case names, for every way to hold the linkage.
    linkage : LinkageNumbers
        Limit-load factor, largest displacement and distance to a dead point.
    standing : Standing
        What holds the pose, and its springs and stops.
    checks : tuple of CheckOutcome
    work : DriveWork or None
        The drive with and without friction; None where no joint has any.
    loads : tuple of Load
        All that acts on the links, friction included.
    found : tuple of Found
        What checks of eyes, notches, walls, contacts, connections, fatigue and collapse found besides what they judge.
    """

    name: str
    forces: JointForces
    large_displacement: LargeDisplacement
    links: Mapping[str, LinkResult]
    pins: Mapping[str, PinStress]
    ways_to_hold: tuple[WayToHold, ...]
    linkage: LinkageNumbers
    standing: Standing
    checks: tuple[CheckOutcome, ...]
    work: DriveWork | None = None
    loads: tuple[Load, ...] = ()
    found: tuple[Found[Any], ...] = ()

    def found_of(self, kind: type[T]) -> tuple[Found[T], ...]:
        """Return what checks found of one kind.

        Parameters
        ----------
        kind : type
            Of the numbers.

        Returns
        -------
        tuple of Found
        """
        return tuple(one for one in self.found if isinstance(one.numbers, kind))

    def of_links(self, kind: type[T]) -> dict[str, T]:
        """Return what checks found of one kind, where that is one for each link.

        Parameters
        ----------
        kind : type
            Of the numbers.

        Returns
        -------
        dict of str to object
            By link.
        """
        return {one.subject.name: one.numbers for one in self.found_of(kind)}

    @property
    def reactions(self) -> Reactions:
        """Joint reactions in the undeformed pose."""
        return self.forces.reactions

    @property
    def gives_way(self) -> bool:
        """True where the linkage as a whole does not hold the load, so that no link passes."""
        return any(check.gives_way for check in self.checks) or self.large_displacement.gives_way


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """Everything that ``alula check`` found out.

    Attributes
    ----------
    name : str
        What the case was called on the command line.
    fidelity : str
        The model that was asked for.
    case : Case
    pose : Pose
    clearance : Clearance or None
        The gaps between links over the motion, or in the pose; None where no layers are stated.
    mass : Weighed or None
        What the linkage weighs; None where no part was weighed.
    size : Extent or None
        The box about it; None where no outlines were made.
    load_cases : mapping of str to LoadCaseResult
    hand : mapping of str to CantileverCheck
        The case's own hand calculations.
    audit : StaticsAudit or None
        Of the published statics, where the case has one.
    verdict : Verdict
        Over all checks.
    timings : mapping of str to float
        Stage -> seconds.
    warnings : tuple of Reason or str
        One sentence each.
    second_opinions : tuple of SecondOpinion
        CalculiX beside our solid models, where it was asked for.
    frequencies : CaseFrequencies or None
        Natural frequencies, where a check asks for them.
    kept : tuple of 2 int
        How many meshes and solutions were kept from earlier checks, and how many there are; zeros where none are kept.
    changes : tuple of VerdictChange
        What would change the verdict of the check that decides. This and what follows is what a report tells besides;
        ``alula.fea.findings.of_check`` finds it, and a check by itself leaves it out.
    motion : Motion or None
        Of the case; None without one, and where the linkage does not get along it.
    in_air : AirRange or None
        The motion of the load cases with air; None without any, and where it cannot be moved.
    harmonic : Reason or None
        Which harmonic of the drive comes nearest to a natural frequency that no check asks for, as
        ``alula.fea.vibration.harmonics.nearest_harmonic`` says.
    date : datetime
        When it was found, in UTC.
    """

    name: str
    fidelity: str
    case: Case
    pose: Pose
    clearance: Clearance | None
    mass: Weighed | None
    size: Extent | None
    load_cases: Mapping[str, LoadCaseResult]
    hand: Mapping[str, CantileverCheck]
    audit: StaticsAudit | None
    verdict: Verdict
    timings: Mapping[str, float]
    warnings: tuple[Reason | str, ...]
    second_opinions: tuple[SecondOpinion, ...] = ()
    frequencies: CaseFrequencies | None = None
    kept: tuple[int, int] = (0, 0)
    changes: tuple[VerdictChange, ...] = ()
    motion: Motion | None = None
    in_air: AirRange | None = None
    harmonic: Reason | None = None
    date: datetime = field(default_factory=lambda: datetime.now(UTC), compare=False)

    @cached_property
    def caveats(self) -> tuple[Caveat, ...]:
        """What a reader of the verdict must know besides."""
        return caveats(self.case, harmonic=self.harmonic)

    def governing(self, link: str) -> LoadCaseResult:
        """Return the load case with the lowest end of a link's safety factor, or with an unknown one.

        Parameters
        ----------
        link : str
            Its name.

        Returns
        -------
        LoadCaseResult
        """
        return min(self.load_cases.values(), key=lambda case: case.links[link].severity)

    @property
    def frames(self) -> Mapping[str, LargeDisplacement]:
        """Load case -> what became of its frame in large displacement."""
        return {name: found.large_displacement for name, found in self.load_cases.items()}
