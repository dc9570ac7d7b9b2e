"""The records that a check hands to the reports."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.beam.theory import BeamCheck, CantileverCheck
from fea.common.band import Band
from fea.common.verdict import CheckOutcome, Verdict
from fea.frame.joint_forces import Held, JointForces
from fea.frame.large_displacement import LargeDisplacement
from fea.outcomes.opinion import SecondOpinion
from fea.outcomes.pins import PinStress
from fea.refine.discretisation import Discretisation
from fea.solid.solution import SolidCase, SolidSolution
from fea.solid.stress import StressField
from geometry.linkage.pose import Pose
from geometry.parts.material import stress_measure
from loads.case.case import Case
from loads.sources.published_statics import StaticsAudit
from loads.statics.statics import Reactions


@dataclass(frozen=True, kw_only=True)
class VariantPeak:
    """Peaks of the solid model under one way to model what is not known.

    span       loaded angle of the pin holes [degrees]
    transfer   "eye-faces" or "bore-shear"; None on a link without drive torque
    von_mises, principal   largest von Mises and largest principal stress [MPa]
    displacement           largest displacement [mm]
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

    x           station in the link's frame [mm]
    kind        "bending" (extreme-fibre bending stress) or "axial" (N/A)
    hand, solid [MPa]
    difference  (solid - hand) over the link's largest hand stress of that kind
    """

    x: float
    kind: str
    hand: float
    solid: float
    difference: float


@dataclass(frozen=True, kw_only=True)
class LinkResult:
    """What one load case does to one link.

    fidelity           "solid" or "beam": the model that the numbers come from
    von_mises_max      [MPa]; ``principal_max`` the largest principal stress [MPa]
    safety_factor      strength over the stress that the material names
    displacement_max   relative to the line through the link's first and last pin, or that turns with its only bore [mm]
    location           (3,) place of the largest decisive stress in the link's frame [mm]
    elements, unknowns size of the solid model; None when no solid ran
    beam               the hand calculation
    solid              the solid solutions of all load cases; None when no solid ran
    variants           the peaks of every variant of this load case; empty when no solid ran
    governing          the variant that ``value`` comes from; with its displacement field
                       (``solid_case``) and recovered stress (``stress``) for pictures and files
    comparisons        hand against solid, section by section
    notes              what the reader must know about this link's numbers
    brittle            True where the largest principal stress decides, False where von Mises stress does
    discretisation     the error that the meshes leave; None when no solid ran
    decided_by         model that decided: "beam" or "solid"; "" where a model was forced that may not decide;
                       ``why`` for people
    next_cost          what a solid would have cost; "" where one ran
    """

    link: str
    fidelity: str
    von_mises_max: Band
    principal_max: Band
    safety_factor: Band
    displacement_max: Band
    location: NDArray[np.float64]
    elements: int | None
    unknowns: int | None
    beam: BeamCheck
    solid: SolidSolution | None
    variants: tuple[VariantPeak, ...]
    governing: VariantPeak | None
    solid_case: SolidCase | None
    stress: StressField | None
    comparisons: tuple[SectionComparison, ...]
    notes: tuple[str, ...]
    brittle: bool
    discretisation: Discretisation | None = None
    decided_by: str = ""
    why: str = ""
    next_cost: str = ""

    @property
    def decisive(self) -> Band:
        """The stress that the safety factor is counted from [MPa]."""
        return self.principal_max if self.brittle else self.von_mises_max

    @property
    def measure(self) -> str:
        """What that stress is called."""
        return stress_measure(brittle=self.brittle)

    @property
    def severity(self) -> float:
        """By which the worst load case is found: the least lower end of the safety factor; one without comes first."""
        return -math.inf if self.safety_factor.unknowable else self.safety_factor.low


@dataclass(frozen=True, kw_only=True)
class LoadCaseResult:
    """One load case.

    forces              joint forces in the undeformed pose, and which model gave them
    large_displacement  whether the undeformed pose is good enough, and what holds on the deformed shape if not
    pins                joint -> stresses of its pin, where a check asks for them
    ways_to_hold        displacement of the point that the case names, for every way to hold the linkage
    """

    name: str
    forces: JointForces
    large_displacement: LargeDisplacement
    links: Mapping[str, LinkResult]
    pins: Mapping[str, PinStress]
    ways_to_hold: tuple[Held, ...]
    checks: tuple[CheckOutcome, ...]

    @property
    def reactions(self) -> Reactions:
        """Joint reactions in the undeformed pose."""
        return self.forces.reactions


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """Everything that ``alula check`` found out.

    name            what the case was called on the command line
    hand            the case's own hand calculations
    audit           of the published statics, where the case has one
    timings         stage -> seconds
    warnings        one sentence each
    second_opinions CalculiX beside our solid models, where it was asked for
    """

    name: str
    case: Case
    pose: Pose
    load_cases: Mapping[str, LoadCaseResult]
    hand: Mapping[str, CantileverCheck]
    audit: StaticsAudit | None
    verdict: Verdict
    timings: Mapping[str, float]
    warnings: tuple[str, ...]
    second_opinions: tuple[SecondOpinion, ...] = ()
