"""The records of an envelope: curves over the motion, the worst of them, fatigue, verdict."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.common.band import Band
from fea.common.verdict import CheckOutcome, Verdict
from fea.motion.fatigue import FatigueLife
from fea.refine.discretisation import Discretisation
from fea.solid.stress import StressField
from fea.solid.traction import Transfer
from loads.case.case import Case
from loads.records.bearing import Span
from loads.states.case_motion import CaseMotion
from loads.statics.statics import Drive

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class VariantCurve:
    """The decisive stress over the motion under one model of pin pressure and one of torque transfer.

    stress    (n,) largest of all nodes at each pose [MPa]; NaN where the pose was left out
    node      (n,) where; -1 where the pose was left out
    first     number of its first load in the link's ``UnitSolutions``
    """

    span: Span
    transfer: Transfer | None
    stress: Real
    node: NDArray[np.int64]
    first: int

    @property
    def peak(self) -> float:
        """Largest stress of the motion [MPa]."""
        return float(np.nanmax(self.stress))


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkFatigue:
    """Fatigue of a link under one load case, the motion repeated for ever.

    location     (3,) of the critical node in the link's frame [mm]
    history      (n,) its signed stress over the motion [MPa]
    life         of the variant that governs
    stress       band of the equivalent peak stress [MPa]
    wanted       repetitions that are asked for
    strength     peak stress borne for as many cycles [MPa]; None where the card does not tell
    repetitions  band of the life; None where the card has no exponent
    """

    location: Real
    history: Real
    life: FatigueLife
    stress: Band
    wanted: float
    strength: float | None
    repetitions: Band | None


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCaseEnvelope:
    """A link over the motion under one load case.

    value, low, high  (n,) decisive stress at each pose and its band [MPa]; NaN where the pose was left out
    stress, safety_factor  of the worst pose, with their bands over the whole motion
    pose, location    when and where: number of the pose, place (3,) in the link's frame [mm]
    discretisation    what the meshes leave open, judged at the worst pose of the first mesh; None for one mesh alone
    """

    name: str
    variants: tuple[VariantCurve, ...]
    governing: VariantCurve
    value: Real
    low: Real
    high: Real
    stress: Band
    safety_factor: Band
    pose: int
    location: Real
    fatigue: LinkFatigue | None
    discretisation: Discretisation | None

    @property
    def known(self) -> bool:
        """False where the peak has no limit, so that no safety factor stands for it."""
        return self.discretisation is None or self.discretisation.known

    @property
    def severity(self) -> tuple[bool, float, float]:
        """By which the worst load case is found: the least of these."""
        return self.known, self.safety_factor.low, self.safety_factor.value


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkEnvelope:
    """A link over the motion under every load case that loads it.

    measure   the decisive stress: "von Mises" or "largest principal"
    strength  what it is set against [MPa]
    units, modes  unit loads, and solutions that span the motion's loads
    solver, solver_reason, solver_error  name, why it was chosen, largest relative error of a solution (energy norm)
    field, displacement  stress and displacements (nodes, 3) [mm] of the worst pose under the worst load case
    no_fatigue  why there is no fatigue calculation; empty where there is one
    """

    link: str
    measure: str
    strength: float
    load_cases: Mapping[str, LoadCaseEnvelope]
    elements: int
    unknowns: int
    units: int
    modes: int
    solver: str
    solver_reason: str
    solver_error: float
    reaction: float
    imbalance: float
    field: StressField
    displacement: Real
    no_fatigue: str
    notes: tuple[str, ...]

    @property
    def worst(self) -> LoadCaseEnvelope:
        """The load case with the least safety factor, by the low end of its band; one without any comes first."""
        return min(self.load_cases.values(), key=lambda found: found.severity)


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvelopeResult:
    """The envelope of a case.

    angles       (n,) of the motion's coordinate [rad]
    drive_angles (n,) of the driven link [rad]
    evaluated    (n,) False where a pose was left out
    idle         links on which nothing acts
    checks       outcome of every check, for every link and load case
    """

    name: str
    case: Case
    moved: CaseMotion
    drive: Drive
    angles: Real
    drive_angles: Real
    evaluated: NDArray[np.bool_]
    links: Mapping[str, LinkEnvelope]
    idle: tuple[str, ...]
    checks: tuple[CheckOutcome, ...]
    verdict: Verdict
    warnings: tuple[str, ...]
    timings: Mapping[str, float]
